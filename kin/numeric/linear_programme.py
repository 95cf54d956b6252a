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
    """Least value, the variables (n,), and by how much the rows are missed at best: 0 where there is such a point."""

    value: float
    x: Array
    missed: float


def minimise(cost: Array, rows: Array, right: Array, enough: float = 1e-10) -> Optimum:
    """Minimise cost (n,) times x, x >= 0, with rows (m, n) times x = right (m,).

    Rows are expected to be of size 1. `missed` is the least sum of what the rows are missed by; where it is above
    `enough`, the value is infinite and x is the point that misses by it. The cost must have a least value.
    """
    count, size = rows.shape
    sign = np.where(right < 0.0, -1.0, 1.0)
    table = np.hstack([rows * sign[:, None], np.eye(count), (right * sign)[:, None]])
    basis = np.arange(size, size + count)
    alone = np.flatnonzero((table[:, :size] != 0.0).sum(axis=0) == 1)
    for column in alone:  # a slack of a row that it may stand for, so that the row needs no artificial variable
        row = int(np.argmax(table[:, column]))
        if table[row, column] == 1.0 and basis[row] >= size:
            basis[row] = column
    whole = table.copy()
    artificial = basis >= size
    first = -table[artificial].sum(axis=0)
    first[size : size + count] = 0.0
    _pivot(table, first, basis, size)
    missed = max(-float(first[-1]), 0.0)
    if missed > enough:  # perhaps by what the rounding of all pivots has left alone: the table is worked out anew
        table, *_ = np.linalg.lstsq(whole[:, basis], whole, rcond=None)
        first = -table[basis >= size].sum(axis=0)
        first[size : size + count] = 0.0
        _pivot(table, first, basis, size)
        missed = max(-float(first[-1]), 0.0)
    if missed > enough:
        return Optimum(np.inf, _point(rows, right, basis, size), missed)
    costs = np.concatenate([cost, np.zeros(count + 1)])
    second = costs - costs[basis] @ table
    _pivot(table, second, basis, size)
    x = _point(rows, right, basis, size)
    missed = float(np.abs(rows @ x - right).sum())
    return Optimum(float(cost @ x), x, 0.0) if missed <= enough else Optimum(np.inf, x, missed)


def _pivot(table: Array, costs: Array, basis: Indices, size: int) -> None:
    """Exchange columns below `size` for those of the basis while the costs fall; all three change in place."""
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
        others = table[:, enter].copy()
        others[leave] = 0.0
        table -= others[:, None] * table[leave]
        costs -= costs[enter] * table[leave]
        basis[leave] = enter


def _point(rows: Array, right: Array, basis: Indices, size: int) -> Array:
    """The variables of a basis, worked out of the rows as they were given, so that no pivot's rounding is left."""
    x = np.zeros(size)
    used = basis[basis < size]
    solved, *_ = np.linalg.lstsq(rows[:, used], right, rcond=None)
    x[used] = np.maximum(solved, 0.0)
    return x
