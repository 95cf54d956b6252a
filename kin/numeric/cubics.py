"""Cubic splines with given slopes at both ends.

The spline through points whose second derivative is continuous: its slopes at the points solve a system with three
diagonals (C. de Boor, A Practical Guide to Splines, chapter 4), one row after another without pivots, since the middle
one dominates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


def spline_slopes(x: Array, y: Array, first: float, last: float) -> Array:
    """Slopes (n,) at points (x, y), (n,) each, x rising, of the spline through them with slopes `first` and `last`."""
    width = np.diff(x)
    slope = np.diff(y) / width
    weight = (1.0 / width).tolist()
    right = (3.0 * (slope[:-1] / width[:-1] + slope[1:] / width[1:])).tolist()
    ahead, value = [0.0], [first]
    for before, after, known in zip(weight[:-1], weight[1:], right, strict=True):
        pivot = 2.0 * (before + after) - before * ahead[-1]
        ahead.append(after / pivot)
        value.append((known - before * value[-1]) / pivot)
    slopes = [last]
    for share, known in zip(reversed(ahead[1:]), reversed(value[1:]), strict=True):
        slopes.append(known - share * slopes[-1])
    return np.array([first, *reversed(slopes)])


def coefficients(low: Array, high: Array, width: Array) -> Array:
    """Cubics' coefficients (4, n), lowest first, of powers of the share of the width (n,), from both ends.

    `low` and `high` (2, n) are f and f' at the ends.
    """
    f, slope, last = low[0], width * low[1], width * high[1]
    rise = high[0] - f
    return np.stack([f, slope, 3.0 * rise - 2.0 * slope - last, slope + last - 2.0 * rise])
