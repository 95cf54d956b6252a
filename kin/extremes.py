"""True extremes of a piecewise smooth function, from its values and two derivatives: not sampled.

On each interval the cubic through both end values and slopes stands for the function. How far it strays is read from
the second derivatives it does not use: with f'''' steady the cubic misses them by h^2 f''''/12 and the function by at
most h^4 f''''/384, a factor h^2/32. Intervals are halved until that estimate, doubled, is below the resolution, or
until they cannot hold the extreme.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.arcs import Array, Indices

MOST_HALVINGS = 48


@dataclass(frozen=True)
class Extremes:
    """Greatest and least value, where, and in which of the intervals; nan and -1 where there was nothing to look at."""

    greatest: float
    greatest_at: float
    greatest_index: int
    least: float
    least_at: float
    least_index: int

    @property
    def worst(self) -> tuple[float, float]:
        """Greatest absolute value and where."""
        if abs(self.least) > abs(self.greatest):
            return abs(self.least), self.least_at
        return abs(self.greatest), self.greatest_at

    @property
    def span(self) -> float:
        """Range."""
        return self.greatest - self.least


def extremes(
    low: Array,
    high: Array,
    at_low: Array,
    at_high: Array,
    evaluate: Callable[[Array, Indices], Array],
    *,
    resolution: float,
) -> Extremes:
    """Extremes of f over m intervals [low, high], each (m,), f smooth inside each.

    `at_low` and `at_high` (3, m) are f, f', f'' at the ends, one-sided into the interval; `evaluate(x, interval)`
    gives the same rows at points inside, `interval` (k,) being the interval each x comes from. Values are good to
    `resolution`, as far as f'''' does not swing within an interval; halving costs grow as resolution ** -1/4.
    """
    owner = np.arange(len(low))
    best = (-np.inf, np.nan, -1)
    worst = (np.inf, np.nan, -1)
    for halving in range(MOST_HALVINGS):
        if not len(low):
            break
        top, top_at, bottom, bottom_at, doubt = _cubic(low, high, at_low, at_high)
        # An extreme between the ends counts once the cubic is trusted; before, only the ends do.
        trusted = (doubt <= resolution) | (halving == MOST_HALVINGS - 1)
        for f, x in ((at_low[0], low), (at_high[0], high), (np.where(trusted, top, -np.inf), top_at)):
            best = _better(best, f, x, owner, 1.0)
        for f, x in ((at_low[0], low), (at_high[0], high), (np.where(trusted, bottom, np.inf), bottom_at)):
            worst = _better(worst, f, x, owner, -1.0)
        # Sixteen times the estimate covers an f'''' that swings, or a break of f'' nobody declared.
        open_ = ~trusted & ((top + 16.0 * doubt > best[0]) | (bottom - 16.0 * doubt < worst[0]))
        low, high, at_low, at_high, owner = low[open_], high[open_], at_low[:, open_], at_high[:, open_], owner[open_]
        middle = 0.5 * (low + high)
        at_middle = evaluate(middle, owner) if len(low) else at_low
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        at_low, at_high = np.concatenate([at_low, at_middle], axis=1), np.concatenate([at_middle, at_high], axis=1)
        owner = np.concatenate([owner, owner])
    return Extremes(*best, *worst)


def _better(
    best: tuple[float, float, int], f: Array, x: Array, owner: Indices, sign: float
) -> tuple[float, float, int]:
    i = int(np.argmax(sign * f))
    return (float(f[i]), float(x[i]), int(owner[i])) if sign * f[i] > sign * best[0] else best


def _cubic(low: Array, high: Array, at_low: Array, at_high: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Greatest value of each cubic and where, least value and where, and the doubt about both."""
    h = high - low
    f, g = at_low[0], h * at_low[1]
    rise, slope = at_high[0] - f, h * at_high[1]
    c, d = 3.0 * rise - 2.0 * g - slope, g + slope - 2.0 * rise
    doubt = np.maximum(np.abs(2.0 * c - h * h * at_low[2]), np.abs(2.0 * c + 6.0 * d - h * h * at_high[2])) / 16.0
    # f' = g + 2 c x + 3 d x^2; both roots in the form that does not cancel
    root = np.sqrt(np.maximum(c * c - 3.0 * d * g, 0.0))
    q = -(c + np.copysign(root, c))
    top, top_at = np.maximum(f, at_high[0]), np.where(rise > 0, 1.0, 0.0)
    bottom, bottom_at = np.minimum(f, at_high[0]), np.where(rise > 0, 0.0, 1.0)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for x in (g / q, q / (3.0 * d)):
            inside = (x > 0.0) & (x < 1.0)
            y = np.where(inside, x, 0.0)
            value = f + y * (g + y * (c + y * d))
            top, top_at = np.where(value > top, value, top), np.where(value > top, y, top_at)
            bottom, bottom_at = np.where(value < bottom, value, bottom), np.where(value < bottom, y, bottom_at)
    return top, low + h * top_at, bottom, low + h * bottom_at, doubt
