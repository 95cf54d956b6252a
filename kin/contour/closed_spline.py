"""The closed spline that a CAD system puts through points: cubic, with continuous curvature, over chord lengths.

C. de Boor, A Practical Guide to Splines, chapters 4 and 16: lengths of the chords between points as knots.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


def closed_spline(points: Array) -> Array:
    """Give control points (n, 4, 2) of the cubic Bezier pieces of the closed spline through points (n, 2).

    Piece i runs from point i to the next. There must be four points or more, no two neighbours alike.
    """
    chords = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    slopes = _slopes(points, chords)
    end, turned = np.roll(points, -1, axis=0), np.roll(slopes, -1, axis=0)
    third = chords[:, None] / 3.0
    return np.stack([points, points + third * slopes, end - third * turned, end], axis=1)


def _slopes(points: Array, chords: Array) -> Array:
    """Derivatives m (n, 2) of the closed spline by the chord length at each point: a cyclic tridiagonal system.

    Row i is m[i-1]/h[i-1] + 2 m[i] (1/h[i-1] + 1/h[i]) + m[i+1]/h[i] = 3 (d[i-1]/h[i-1] + d[i]/h[i]), where h are the
    lengths of the chords and d their slopes. Unknowns 1 to n - 1 are solved for as functions of unknown 0; row 0 then
    gives unknown 0.
    """
    before = np.roll(chords, 1)
    d = (np.roll(points, -1, axis=0) - points) / chords[:, None]
    right = 3.0 * (np.roll(d, 1, axis=0) / before[:, None] + d / chords[:, None])
    low, middle, high = 1.0 / before, 2.0 * (1.0 / before + 1.0 / chords), 1.0 / chords
    count = len(points)
    # unknown 0 is taken to the right: columns 0 and 1 are the plain right side, column 2 the share of unknown 0
    sides = np.zeros((count, 3))
    sides[:, :2] = right
    sides[1, 2] -= low[1]
    sides[-1, 2] -= high[-1]
    # forward elimination of rows 2 to n - 1, then back substitution down to row 1
    factors = np.zeros(count)
    rows = sides.tolist()
    pivot = middle.tolist()
    for i in range(2, count):
        factors[i] = low[i] / pivot[i - 1]
        pivot[i] -= factors[i] * high[i - 1]
        rows[i] = [a - factors[i] * b for a, b in zip(rows[i], rows[i - 1], strict=True)]
    solved = [[0.0, 0.0, 0.0]] * count
    solved[-1] = [value / pivot[-1] for value in rows[-1]]
    for i in range(count - 2, 0, -1):
        solved[i] = [(a - high[i] * b) / pivot[i] for a, b in zip(rows[i], solved[i + 1], strict=True)]
    # row 0 with m[1] and m[n-1] as functions of m[0]
    table = np.array(solved)
    first = right[0] - low[0] * table[-1, :2] - high[0] * table[1, :2]
    first /= middle[0] + low[0] * table[-1, 2] + high[0] * table[1, 2]
    slopes: Array = table[:, :2] + table[:, 2:] * first
    slopes[0] = first
    return slopes
