"""True extremes of a piecewise smooth function, from its values and two derivatives: not sampled.

On each interval the cubic through both end values and slopes stands for the function. How far it strays is read from
the second derivatives it does not use: with f'''' steady the cubic misses them by h^2 f''''/12 and the function by at
most h^4 f''''/384, a factor h^2/32. Intervals are halved until that estimate, doubled, is below the resolution, or
until they cannot hold the extreme.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices
    from kin.numeric.elementary import Jet

MOST_HALVINGS = 48
MOST_OPEN = 400_000  # intervals, beside eight times those given, that may stay undecided
PARTS = 4  # of a cell of a figure, from which its extremes are looked for: as many cost no more than few
FIGURES = 1e-13  # of the greatest value of a figure, to which its extremes are found
RESOLUTION = 2e-14  # as a share of a contour's extent: to this the extremes of a length are found (1e-12 mm of 50 mm)
BLOCK = 8192  # intervals at a time, so that their arrays stay in the cache


def resolution(points: Array) -> float:
    """Resolution of extremes of lengths, mm, on a contour through points (n, 2), mm, counted from the shaft."""
    return RESOLUTION * float(np.abs(points).max())


@dataclass(frozen=True)
class Extremes:
    """Greatest and least value, the x at which each is reached, and the index of its interval.

    Without intervals the values are -inf and inf, the places nan, the indices -1.
    """

    greatest: float
    greatest_at: float
    greatest_index: int
    least: float
    least_at: float
    least_index: int

    @property
    def worst(self) -> tuple[float, float]:
        """Greatest absolute value, and the x at which it is reached."""
        if abs(self.least) > abs(self.greatest):
            return abs(self.least), self.least_at
        return abs(self.greatest), self.greatest_at

    @property
    def worst_index(self) -> int:
        """Index of the interval in which the greatest absolute value is reached."""
        return self.least_index if abs(self.least) > abs(self.greatest) else self.greatest_index

    @property
    def span(self) -> float:
        """Greatest less least value."""
        return self.greatest - self.least


def extremes_over(cells: Array, figure: Callable[[Array, int], Jet]) -> Extremes:
    """Extremes of a figure over cells (m + 1,), within each of which it is smooth.

    `figure(x, side)` gives it as a jet of second order at points x (n,), at the cells' ends as its limit from the right
    or, with side -1, from the left. Raises UnsettledError where rounding makes it too rough.
    """
    ends = np.append(np.linspace(cells[:-1], cells[1:], PARTS + 1)[:-1].T.ravel(), cells[-1])
    low, high = ends[:-1], ends[1:]

    def inside(x: Array, _: Indices) -> Array:
        return figure(x, 1).derivatives()

    at_low, at_high = figure(low, 1).derivatives(), figure(high, -1).derivatives()
    size = max(float(np.abs(at_low[0]).max()), float(np.abs(at_high[0]).max()))
    return extremes(low, high, at_low, at_high, inside, resolution=FIGURES * max(size, 1e-3))


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
    gives the same rows (3, k) at points x (k,) inside, `interval` (k,) being the interval each x comes from. Values are
    good to `resolution`, as far as f'''' does not swing within an interval; halving costs grow as resolution ** -1/4.
    Raises UnsettledError where the resolution is not reached, as rounding makes f rougher than that.
    """
    most = 8 * len(low) + MOST_OPEN
    ends = Extremes(-np.inf, np.nan, -1, np.inf, np.nan, -1)
    owner = np.arange(len(low))
    # each round takes in all intervals, block by block, and halves those that may still hold an extreme
    for halving in range(MOST_HALVINGS + 1):
        parts = [slice(begin, begin + BLOCK) for begin in range(0, len(low), BLOCK)]
        doubtful = []
        for part in parts:
            block = _Block(low[part], high[part], at_low[:, part], at_high[:, part], owner[part])
            ends, open_ = _scan(ends, block, resolution)
            doubtful.append(open_)
        open_ = np.concatenate(doubtful) if doubtful else np.zeros(0, dtype=bool)
        if not open_.any():
            break
        if halving == MOST_HALVINGS or 2 * np.count_nonzero(open_) > most:
            raise UnsettledError(
                f"extremes cannot be resolved to {resolution:.3g}: rounding makes the function rougher"
            )
        low, high, at_low, at_high, owner = low[open_], high[open_], at_low[:, open_], at_high[:, open_], owner[open_]
        middle = 0.5 * (low + high)
        at_middle = evaluate(middle, owner)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        at_low, at_high = np.concatenate([at_low, at_middle], axis=1), np.concatenate([at_middle, at_high], axis=1)
        owner = np.concatenate([owner, owner])
    return ends


class _Block(NamedTuple):
    """Some of the intervals, with the number of the interval given that each is a part of."""

    low: Array
    high: Array
    at_low: Array
    at_high: Array
    owner: Indices


def _scan(extremes: Extremes, block: _Block, resolution: float) -> tuple[Extremes, NDArray[np.bool_]]:
    """Extremes with those of a block taken in, and which of its intervals to halve.

    Counted are the ends of the intervals, and the cubic's extremes between where it is trusted.
    """
    low, high, at_low, at_high, owner = block
    x, value, doubt = _cubic(high - low, at_low, at_high)
    trusted = doubt <= resolution
    values = np.stack([at_low[0], at_high[0], *np.where(trusted, value, at_low[0])])
    for i, of_greatest in ((int(values.argmax()), True), (int(values.argmin()), False)):
        which, k = divmod(i, len(low))
        share = (0.0, 1.0, *x[:, k])[which]
        at = float(high[k] if which == 1 else low[k] + share * (high[k] - low[k]))
        if of_greatest and values[which, k] > extremes.greatest:
            extremes = replace(extremes, greatest=float(values[which, k]), greatest_at=at, greatest_index=int(owner[k]))
        if not of_greatest and values[which, k] < extremes.least:
            extremes = replace(extremes, least=float(values[which, k]), least_at=at, least_index=int(owner[k]))
    if trusted.all():
        return extremes, ~trusted
    # Sixteen times the estimate covers an f''''' that swings, or a break of f''' nobody declared.
    top, bottom = np.maximum(values.max(axis=0), value.max(axis=0)), np.minimum(values.min(axis=0), value.min(axis=0))
    promising = (top + 16.0 * doubt > extremes.greatest) | (bottom - 16.0 * doubt < extremes.least)
    return extremes, ~trusted & promising


def _cubic(h: Array, at_low: Array, at_high: Array) -> tuple[Array, Array, Array]:
    """Each cubic's extremes inside its interval of width h (n,): share of the width (2, n), value (2, n), doubt (n,).

    The low end stands for an extreme that is not inside. The doubt is twice the estimate of the module's heading.
    """
    f, g = at_low[0], h * at_low[1]
    rise, slope = at_high[0] - f, h * at_high[1]
    c, d = 3.0 * rise - 2.0 * g - slope, g + slope - 2.0 * rise
    square = h * h
    doubt = np.maximum(np.abs(2.0 * c - square * at_low[2]), np.abs(2.0 * c + 6.0 * d - square * at_high[2])) / 16.0
    # f' = g + 2 c x + 3 d x^2; both roots in the form that does not cancel
    q = -(c + np.copysign(np.sqrt(np.maximum(c * c - 3.0 * d * g, 0.0)), c))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        x = np.stack([g / q, q / (3.0 * d)])
    x[~((x > 0.0) & (x < 1.0))] = 0.0
    return x, f + x * (g + x * (c + x * d)), doubt
