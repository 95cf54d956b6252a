"""Proved bounds of functions over stretches, by halving what is not decided yet."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kin.jet import BallJet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.piecewise import Piecewise, Stretch

Array = NDArray[np.float64]

_CELLS = 32  # a stretch is bounded in so many parts first
_HALVINGS = 40
_MOST_CELLS = 20000  # open at a time; more than a few mean that the answer is no


def bounds_of(function: Stretch, lower: Array, upper: Array, k: int) -> tuple[Array, Array]:
    """Prove bounds (n,) of the k-th derivative over [lower, upper]: Taylor's formula about the middle, or directly."""
    middle = 0.5 * (lower + upper)
    half = np.maximum(upper - middle, middle - lower) * (1 + 1e-12)
    low, high = function(BallJet.variable(lower, upper, k + 2)).bounds()
    near_low, near_high = function(BallJet.variable(middle, middle, k + 1)).bounds()
    with np.errstate(invalid="ignore"):  # inf - inf where nothing is known: the direct bound is taken
        bend = np.maximum(np.abs(low[k + 2]), np.abs(high[k + 2])) * half**2 * (0.5 + 1e-12)
        slope = np.maximum(np.abs(near_low[k + 1]), np.abs(near_high[k + 1])) * half * (1 + 1e-12)
        return np.fmax(low[k], near_low[k] - slope - bend), np.fmin(high[k], near_high[k] + slope + bend)


def undecided(function: Stretch, begin: float, end: float, k: int, below: float) -> float | None:
    """Prove that the k-th derivative stays below a limit over [begin, end]; else a place where that fails."""
    ends = np.linspace(begin, end, _CELLS + 1)
    lower, upper = ends[:-1], ends[1:]
    for _ in range(_HALVINGS):
        _, high = bounds_of(function, lower, upper, k)
        open_ = ~(high < below)
        if not open_.any():
            return None
        lower, upper = lower[open_], upper[open_]
        if len(lower) > _MOST_CELLS:
            break
        middle = 0.5 * (lower + upper)
        lower, upper = np.concatenate((lower, middle)), np.concatenate((middle, upper))
    return float(0.5 * (lower[0] + upper[0]))


def highest(law: Piecewise, weights: Sequence[float], k: int) -> tuple[float, float]:
    """Find where the k-th derivative, times a weight a stretch, is largest, and that value; by sampling, no proof."""
    best = (float(law.knots[0]), -math.inf)
    for weight, begin, end in zip(weights, law.knots[:-1], law.knots[1:], strict=True):
        low, high = begin, end
        for _ in range(8):
            points = np.linspace(low, high, 257)
            values = weight * np.append(law.derivatives(points[:-1], k, 1)[k], law.derivatives(points[-1:], k, -1)[k])
            top = int(np.argmax(values))
            if values[top] > best[1]:
                best = (float(points[top]), float(values[top]))
            low, high = points[max(top - 1, 0)], points[min(top + 1, 256)]
    return best
