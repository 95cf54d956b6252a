"""Placings of measured points: the turn and the shift by which metal fits its contour, minimax or by least squares.

Deviations e of metal turned by kap counter-clockwise and shifted by v are, to first order, kap g + v.N + form, with
N the metal's outward normal and g = N.(iP). The default of ISO 1101 and ISO 5459 is the placing of least max|e - A x|
(minimax, Chebyshev): a linear programme, solved here by exchange on its dual. There weights of at most k + 1 points for
k unknowns, at least 0 and 1 in sum, balance every column of A; the sum of their deviations, each with its sign, bounds
max|e - A x| from below whatever x is: equality certifies the placing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

ILL = 0.05  # least singular value of columns of unit size, over sqrt n: below, unknowns cannot be told apart
MOST_EXCHANGES = 2000  # a guard against endless search
PATIENCE = 60  # exchanges without gain, after which the first eligible point enters (Bland's rule ends every cycle)
CERTIFIED = 1e-12  # share of the greatest deviation by which minimax and its lower bound may differ


@dataclass(frozen=True, eq=False)
class Minimax:
    """The placing of least greatest deviation.

    x (k,)              unknowns, rad and mm as the columns of A are
    value               greatest |e - A x|, mm
    touching (m,)       indices of the points that hold it there, rising
    multipliers (m,)    their weights, at least 0 and 1 in sum
    certificate         lower bound by these weights, mm: as great as `value`
    """

    x: Array
    value: float
    touching: Indices
    multipliers: Array
    certificate: float


def minimax(columns: Array, e: Array) -> Minimax:
    """Least greatest |e - A x| over x, of columns A (n, k), k at most 3, and deviations e (n,).

    Raises UnsettledError where the multipliers do not certify it, or the search does not end, by rounding alone.
    """
    count, k = columns.shape
    scale = np.maximum(np.abs(columns).max(axis=0, initial=0.0), np.finfo(float).tiny)
    a = columns / scale
    size = max(float(np.abs(e).max()), np.finfo(float).tiny)
    target = e / size
    # basis: k artificial unit columns, and the greatest deviation; an artificial one costs more than any point gains
    first = int(np.argmax(np.abs(target)))
    signs = np.where(target < 0.0, -1.0, 1.0)
    basis = [*range(count, count + k), first]
    sign = [*(-np.sign(a[first] * signs[first]) + (a[first] == 0.0)), signs[first]]
    artificial = -1e6

    def column(index: int, s: float) -> Array:
        if index >= count:
            unit = np.zeros(k + 1)
            unit[index - count] = s
            return unit
        return np.append(s * a[index], 1.0)

    # exchanges of the simplex method: the point of greatest excess enters, the one whose weight comes to 0 leaves
    best, stalled = -np.inf, 0
    for _ in range(MOST_EXCHANGES):
        matrix = np.column_stack([column(i, s) for i, s in zip(basis, sign, strict=True)])
        cost = np.array([artificial if i >= count else s * target[i] for i, s in zip(basis, sign, strict=True)])
        weights = np.linalg.solve(matrix, np.append(np.zeros(k), 1.0))
        dual = np.linalg.solve(matrix.T, cost)
        x, h = dual[:k], dual[k]
        off = target - a @ x
        excess = np.abs(off) - h
        reached = float(cost @ weights)
        stalled = 0 if reached > best + 1e-15 else stalled + 1
        best = max(best, reached)
        if excess.max() <= CERTIFIED and all(i < count or w <= CERTIFIED for i, w in zip(basis, weights, strict=True)):
            break
        enter = int(np.argmax(excess)) if stalled < PATIENCE else int(np.flatnonzero(excess > CERTIFIED)[0])
        s = -1.0 if off[enter] < 0.0 else 1.0
        change = np.asarray(np.linalg.solve(matrix, column(enter, s)), dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(change > 1e-12, np.maximum(weights, 0.0) / change, np.inf)
        leaving = np.flatnonzero(ratio <= ratio.min() * (1.0 + 1e-12) + 1e-300)
        leave = max(leaving.tolist(), key=lambda j: (basis[j] >= count, change[j] if stalled < PATIENCE else -basis[j]))
        basis[leave], sign[leave] = enter, s
    else:
        raise UnsettledError(f"the minimax placing was not found in {MOST_EXCHANGES} exchanges")
    # the result in mm, certified by the weights of the points in the basis
    held = [j for j in range(k + 1) if basis[j] < count]
    points = np.array([basis[j] for j in held], dtype=np.intp)
    multipliers = np.maximum(weights[held], 0.0)
    value = size * float(np.abs(off).max())
    signed = np.array([sign[j] for j in held])
    certificate = float(multipliers @ (signed * e[points]))
    if not certificate >= value - 1e-9 * size:
        raise UnsettledError(f"the minimax placing is proved to {certificate:.3g} of {value:.3g} mm alone")
    order = np.argsort(points)
    return Minimax(size * x / scale, value, points[order], multipliers[order], certificate)


def least_squares(columns: Array, e: Array) -> Array:
    """Unknowns x (k,) at which the sum of (e - A x)^2 is least, by columns A (n, k) and deviations e (n,)."""
    return np.asarray(np.linalg.lstsq(columns, e, rcond=None)[0], dtype=np.float64)


def interval(column: Array, e: Array, value: float) -> tuple[float, float]:
    """Least and greatest x of the interval in which all |e - x column| (n,) <= `value`, mm; x in rad for a turn.

    Where there is no such x, the least comes out above the greatest.
    """
    limit = value * (1.0 + 1e-12)
    felt = np.abs(column) > 1e-9 * np.abs(column).max()
    ends = np.stack([e[felt] - limit, e[felt] + limit]) / column[felt]
    return float(ends.min(axis=0).max()), float(ends.max(axis=0).min())


def conditions(columns: Array) -> Array:
    """Singular values (k,) of columns (n, k) over sqrt n, falling."""
    return np.asarray(np.linalg.svd(columns, compute_uv=False) / np.sqrt(len(columns)), dtype=np.float64)
