"""Linear programmes of few rows and many columns, by the simplex method in two phases.

G. B. Dantzig, Linear Programming and Extensions, 1963, chapters 5 and 9; against cycling the pivots fall back on
R. G. Bland, New finite pivoting rules for the simplex method, 1977.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

_ZERO = 1e-11  # of rows scaled to 1: a reduced cost below this is rounding
_PIVOT = 1e-8  # and an entry below this no pivot: it would blow up what rounding has left
_STEEP = 1e-4  # and an artificial variable that stands at 0 leaves by no smaller one
_STEPS = 400  # pivots by the steepest cost before Bland's rule takes over
_MOST = 5000  # pivots in all; a programme of a hundred rows takes some hundred


class Optimum(NamedTuple):
    """Least value, the variables (n,), and the least sum of errors of the rows, 0 where a point fulfils them.

    `multipliers` y (m,) are the solution of the dual programme: y times `right` is the least value, and no column costs
    less than y times it. Where the rows cannot be met, y times `right` is the least sum of errors, and y times a column
    is nowhere above 0; where only rounding keeps a point of least value from meeting them, y is that of the cost. Both
    hold but for the rounding of the pivots.
    """

    value: float
    x: Array
    missed: float
    multipliers: Array


def minimise(cost: Array, rows: Array, right: Array, enough: float = 1e-10) -> Optimum:
    """Minimise cost (n,) times x, x >= 0, with rows (m, n) times x = right (m,).

    Rows are expected to be of size 1. Where the errors of the rows sum to more than `enough` at every x, the value is
    infinite, `missed` is the least sum and x the point that has it. The cost must have a least value.
    """
    count, size = rows.shape
    # phase 1: an artificial variable for each row without a slack; their sum is made least
    sign = np.where(right < 0.0, -1.0, 1.0)
    table = np.hstack([rows * sign[:, None], np.eye(count), (right * sign)[:, None]])
    basis = np.arange(size, size + count)
    single_entries = np.flatnonzero((table[:, :size] != 0.0).sum(axis=0) == 1)
    # a slack of a row may stand for it, so that the row needs no artificial variable
    for column in single_entries:
        row = int(np.argmax(table[:, column]))
        if table[row, column] == 1.0 and basis[row] >= size:
            basis[row] = column
    whole = table.copy()
    artificial = basis >= size
    # the costs of the artificial variables, less those of the basis; they cost 1, and 0 where a slack stands for them
    artificial_costs = -table[artificial].sum(axis=0)
    artificial_costs[size : size + count] += artificial
    _pivot(table, artificial_costs, basis, size)
    missed = max(-float(artificial_costs[-1]), 0.0)
    if missed > enough:  # perhaps only by the rounding of all pivots: the table is worked out anew
        table = np.linalg.pinv(whole[:, basis]) @ whole
        artificial_costs = -table[basis >= size].sum(axis=0)
        artificial_costs[size : size + count] += artificial
        _pivot(table, artificial_costs, basis, size)
        missed = max(-float(artificial_costs[-1]), 0.0)
    if missed > enough:
        multipliers = sign * (artificial - artificial_costs[size : size + count])
        return Optimum(np.inf, _point(rows, right, basis, size), missed, multipliers)
    # phase 2: the cost itself from there
    costs = np.concatenate([cost, np.zeros(count + 1)])
    reduced_costs = costs - costs[basis] @ table
    _pivot(table, reduced_costs, basis, size)
    x = _point(rows, right, basis, size)
    missed = float(np.abs(rows @ x - right).sum())
    multipliers = -sign * reduced_costs[size : size + count]
    if missed > enough:
        return Optimum(np.inf, x, missed, multipliers)
    return Optimum(float(cost @ x), x, 0.0, multipliers)


def _pivot(table: Array, costs: Array, basis: Indices, size: int) -> None:
    """Bring columns below `size` into the basis while the costs fall; table, costs and basis change in place."""
    for step in range(_MOST):
        open_ = costs[:size]
        enter = int(np.argmin(open_)) if step < _STEPS else int(np.argmax(open_ < -_ZERO))
        if open_[enter] >= -_ZERO:
            return
        column, right = table[:, enter], table[:, -1]
        up = column > _PIVOT
        # an artificial variable that stands at 0 leaves first, whichever way it would be moved
        up |= (basis >= size) & (np.abs(column) > _STEEP) & (right <= 10.0 * _ZERO)
        if not up.any():
            return
        ratio = np.full(len(basis), np.inf)
        ratio[up] = np.maximum(right[up], 0.0) / np.abs(column[up])
        near = np.flatnonzero(ratio <= ratio.min() + _ZERO)
        leave = int(near[np.argmax(np.abs(column[near]))]) if step < _STEPS else int(near[np.argmin(basis[near])])
        table[leave] /= table[leave, enter]
        factors = table[:, enter].copy()
        factors[leave] = 0.0
        table -= factors[:, None] * table[leave]
        costs -= costs[enter] * table[leave]
        basis[leave] = enter


def _point(rows: Array, right: Array, basis: Indices, size: int) -> Array:
    """The variables of a basis, solved from the rows as they were given, so that no pivot's rounding is left."""
    x = np.zeros(size)
    used = basis[basis < size]
    solved, *_ = np.linalg.lstsq(rows[:, used], right, rcond=None)
    x[used] = np.maximum(solved, 0.0)
    return x
