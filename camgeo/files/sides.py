"""On which side of a line a point lies, decided exactly for any doubles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices


def sides(a: Array, b: Array, c: Array) -> Indices:
    """Exact side of line a b on which c lies, (n,): 1 left, -1 right, 0 on it. Points (n, 2).

    The determinant is evaluated in doubles; where rounding could turn its sign (Shewchuk 1997, bound A of orient2d,
    taken three times as wide), it is evaluated in fractions.
    """
    left = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1])
    right = (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    determinant = left - right
    for i in np.flatnonzero(np.abs(determinant) <= 1e-15 * (np.abs(left) + np.abs(right))):
        from fractions import Fraction

        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, point[i].tolist()) for point in (a, b, c))
        first, second = (bx - ax) * (cy - ay), (by - ay) * (cx - ax)
        determinant[i] = (first > second) - (first < second)
    sign: Indices = np.sign(determinant).astype(np.intp)
    return sign
