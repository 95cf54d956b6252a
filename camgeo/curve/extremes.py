"""Greatest and least values of a figure over a whole turn, found and proved.

A figure is a function in jet arithmetic: at points it has its exact derivatives, over intervals enclosures of them. On
an interval of width w no value lies above the greater end by more than ``max(0, -f'') w^2/8``; where f' keeps its sign
none lies above it at all. Where f'' <= -m < 0 no value lies above ``f(x) + f'(x)^2/(2 m)``, x being any place of the
interval: at the top itself the bound is exact. Intervals that may still hold more than the best value found are
divided.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from kin.numeric.elementary import BallJet, Jet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array, Indices

CELLS = 16  # of each stretch, at first
PARTS, TOGETHER = 4, 64  # parts of an undecided interval, or of all undecided intervals together if those are few
LEVELS = 24  # divisions, each into four parts at least: far below the rounding of a parameter
MOST = 20_000  # undecided intervals; with more the search ends, and their bound is given as excess
SHARPNESS = 1e-13  # of the figure's size: an interval that may hold more by less is decided
NEWTON = 5  # steps, which double the digits of a top from a few
NOISE = 1e-9  # of a figure, or of 1: an excess below it is rounding
ROUNDING = 1e-14  # of the figure and its slope: the error of a slope
ORDER = 4  # of the variable: a figure may use up two derivatives and still have two


class ShaftFigure(Protocol):
    """A figure over the shaft angle, as a jet or ball jet.

    At a break it is the limit from above (side 1) or from below (side -1).
    """

    def __call__(self, tau: Series, side: Side = 1, /) -> Series:
        """The figure at jets or ball jets `tau` of the shaft angle, up to two orders fewer."""
        ...


@dataclass(frozen=True)
class Extreme:
    """The extreme value of a figure, its parameter `at`, and a bound of the `excess` of any other value over it.

    For a least value the excess bounds how far another value may lie below it.
    """

    value: float
    at: float
    excess: float

    @property
    def slack(self) -> float:
        """`excess` where it is more than rounding, else 0; in the figure's unit."""
        return self.excess if self.excess > NOISE * max(abs(self.value), 1.0) else 0.0


def least(figure: ShaftFigure, stretches: Array) -> Extreme:
    """Least value of a figure over stretches (m, 2), none of which spans a break."""
    (lowest,) = _highest(figure, stretches, -1)
    return Extreme(-lowest.value, lowest.at, lowest.excess)


def both(figure: ShaftFigure, stretches: Array) -> tuple[Extreme, Extreme]:
    """Least and greatest value of a figure over stretches (m, 2), none of which spans a break."""
    lowest, highest = _highest(figure, stretches, -1, 1)
    return Extreme(-lowest.value, lowest.at, lowest.excess), highest


def surely_positive(figure: ShaftFigure, stretches: Array) -> bool:
    """Whether bounds over a few intervals of stretches (m, 2) prove a figure above 0; cheaper than `least`.

    False proves nothing.
    """
    below, _ = figure(BallJet.variable(*subdivide(stretches[:, 0], stretches[:, 1], CELLS), ORDER)).bounds()
    return bool((below[0] > 0.0).all())  # not where a bound is nan


def greatest(figure: ShaftFigure, stretches: Array) -> Extreme:
    """Greatest value of a figure over stretches (m, 2), none of which spans a break; limits at breaks count too."""
    return _highest(figure, stretches, 1)[0]


class _Seen(NamedTuple):
    """Intervals (n,), the figure's derivatives (order + 1, 2, n) at their low and high ends, bounds over them.

    All are of the figure times `sense` (n,), 1 or -1.
    """

    low: Array
    high: Array
    sense: Array
    rows: Array
    below: Array
    above: Array

    @staticmethod
    def of(figure: ShaftFigure, low: Array, high: Array, sense: Array) -> _Seen:
        """Evaluate at the ends of intervals (n,), and bound over them."""
        rows = figure(Jet.variable(np.concatenate([low, high]), ORDER), np.repeat([1, -1], low.size)).derivatives()
        below, above = figure(BallJet.variable(low, high, ORDER)).bounds()
        rows = rows.reshape(-1, 2, low.size) * sense
        return _Seen(low, high, sense, rows, np.where(sense > 0, below, -above), np.where(sense > 0, above, -below))

    def times(self, sense: int) -> _Seen:
        """The intervals for the figure times a sense, 1 or -1."""
        if sense > 0:
            return self
        return _Seen(self.low, self.high, -self.sense, -self.rows, -self.above, -self.below)


def _highest(figure: ShaftFigure, stretches: Array, *senses: int) -> list[Extreme]:
    """Greatest values of the figure times each of the senses, 1 or -1, in their order, in one search for all."""
    low, high = subdivide(stretches[:, 0], stretches[:, 1], CELLS)
    first = _Seen.of(figure, low, high, np.ones(low.size))
    seen = _Seen(*(np.concatenate(parts, axis=-1) for parts in zip(*map(first.times, senses), strict=True)))
    best, place, size = dict.fromkeys(senses, -np.inf), dict.fromkeys(senses, float(low[0])), dict.fromkeys(senses, 0.0)
    extremes: dict[int, Extreme] = {}
    # values at ends and tops, bounds over the intervals, and a division of those that the bounds leave open
    for level in range(LEVELS):
        tops, rows = _with_tops(figure, seen)
        reach = _most(seen, rows)
        open_ = np.zeros(seen.low.size, dtype=bool)
        # for each sense the best value, and the intervals that may still hold more
        for sense in senses:
            own = np.flatnonzero(seen.sense == sense)
            if not own.size:
                continue
            size[sense] = max(size[sense], float(np.abs(seen.rows[0][:, own]).max()))
            places, values = np.concatenate([seen.low[own], seen.high[own], tops[own]]), rows[0][:, own].ravel()
            top = int(np.argmax(values))
            if values[top] > best[sense]:
                best[sense], place[sense] = float(values[top]), float(places[top])
            undecided = own[~(reach[own] <= best[sense] + SHARPNESS * size[sense])]
            if not undecided.size:
                extremes[sense] = Extreme(best[sense], place[sense], SHARPNESS * size[sense])
            elif undecided.size > MOST or level == LEVELS - 1:
                extremes[sense] = Extreme(best[sense], place[sense], float(reach[undecided].max()) - best[sense])
            else:
                open_[undecided] = True
        if not open_.any():
            break
        low, high, owner = subdivide_undecided(seen.low[open_], seen.high[open_])
        seen = _Seen.of(figure, low, high, seen.sense[open_][owner])
    return [extremes[sense] for sense in senses]


def subdivide(low: Array, high: Array, parts: int) -> tuple[Array, Array]:
    """Low and high ends (n * parts,) of intervals from `low` to `high` (n,), each divided into equal parts."""
    share = np.linspace(0.0, 1.0, parts + 1)
    knots = low[:, None] * (1.0 - share) + high[:, None] * share
    return knots[:, :-1].ravel(), knots[:, 1:].ravel()


def subdivide_undecided(low: Array, high: Array) -> tuple[Array, Array, Indices]:
    """Low and high ends (m,) of the parts of undecided intervals (n,), and the index of each part's interval (m,)."""
    parts = max(PARTS, TOGETHER // low.size)
    return *subdivide(low, high, parts), np.repeat(np.arange(low.size), parts)


def _with_tops(figure: ShaftFigure, seen: _Seen) -> tuple[Array, Array]:
    """Tops (n,) that Newton's method finds inside the intervals; value and slope at low end, high end, top: (2, 3, n).

    Where the slope does not fall through 0 between the ends, the low end is given for the top.
    """
    at_ends = seen.rows[:2]
    tops, values = seen.low.copy(), np.concatenate([at_ends, at_ends[:, :1]], axis=1)
    near = np.flatnonzero((at_ends[1, 0] > 0.0) & (at_ends[1, 1] < 0.0))
    if near.size:
        a, b, sense = seen.low[near], seen.high[near], seen.sense[near]
        x = 0.5 * (a + b)
        for _ in range(NEWTON):
            previous = x
            _, slope, bend = figure(Jet.variable(x, ORDER)).derivatives()[:3] * sense
            step = np.divide(slope, bend, out=np.zeros_like(slope), where=bend < 0.0)
            x = np.minimum(np.maximum(x - step, a), b)
            if (x == previous).all():
                break
        tops[near] = x
        values[:, 2, near] = figure(Jet.variable(x, ORDER)).derivatives()[:2] * sense
    return tops, values


def _most(seen: _Seen, rows: Array) -> Array:
    """Upper bound of the figure over each interval (n,), of value and slope at three places (2, 3, n)."""
    below, above = seen.below, seen.above
    # above the ends by max(0, -f'') w^2/8 at the most, not at all where f' keeps its sign
    top = rows[0, :2].max(axis=0)
    width = seen.high - seen.low
    dip = np.where((below[1] >= 0.0) | (above[1] <= 0.0), 0.0, np.maximum(-below[2], 0.0) * width**2 / 8.0)
    reach: Array = np.fmin(top + dip, above[0])
    # where f'' <= -m: above each of the three values by f'^2/(2 m) at the most
    slope = np.abs(rows[1]) + ROUNDING * np.abs(rows).max(axis=(0, 1))
    arch = np.divide(0.5 * slope**2, -above[2], out=np.full_like(slope, np.inf), where=above[2] < 0.0)
    reach = np.fmin(reach, np.fmin.reduce(rows[0] + arch, axis=0))
    return np.where(np.isnan(reach), np.inf, reach)
