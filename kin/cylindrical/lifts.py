"""The intended lift over its period as a row of cubics, for many angles at once; proved bounds of its derivatives."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.law.bounds import cubic_cells, cubics_between
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.law.piecewise import Piecewise
    from kin.numeric.arrays import Array, Indices

NEAR = 1e-10  # mm: cubics are proved to be so near the law
BINS = 2048  # parts of a turn, of each of which the greatest second derivative is known
VELOCITY = 1e-9  # mm per rad: a jump of the velocity below this is rounding


@dataclass(frozen=True, eq=False)
class Lifts:
    """A law, mm over rad, whose period is so many turns, with its cubics.

    Raises UnsettledError, when asked, for one too rough.
    """

    law: Piecewise
    turns: int = 1

    @property
    def period(self) -> float:
        """Angle, rad, after which the lift repeats."""
        return TURN * self.turns

    @property
    def span(self) -> tuple[float, float]:
        """Angles, rad, between which there is all of the motion: a period from 0."""
        return 0.0, self.period

    @property
    def breaks(self) -> Array:
        """Angles (k,) of the span at which a derivative may jump."""
        return np.asarray(np.mod(self.law.breaks, self.period))

    def enclosure(self, lower: Array, upper: Array, order: int) -> tuple[Array, Array]:
        """Balls mid +- rad (order + 1, n) of the lift and its derivatives between angles (n,), rad, of the span."""
        return self.law.enclosure(lower, upper, order)

    def repeats(self, turns: int) -> bool:
        """Whether the roller is in the same place after so many whole turns."""
        return turns % self.turns == 0

    def degrees(self, angle: float) -> float:
        """An angle, rad, as degrees of the period, from 0 up to 360 for each of its turns."""
        return degrees_over(angle, self.turns)

    @property
    def parts(self) -> int:
        """Number of equal parts of the period, of each of which the greatest derivatives are known."""
        return BINS * self.turns

    def part(self, theta: Array) -> Indices:
        """Number (n,) of the part of the period that angles (n,), rad, lie in."""
        return np.floor(theta * (BINS / TURN)).astype(np.intp) % self.parts

    @cached_property
    def round(self) -> Piecewise:
        """The law over any number of turns."""
        return self.law if self.law.period is not None else replace(self.law, period=self.period)

    @cached_property
    def nodes(self) -> Array:
        """Angles (m + 1,), rad, over the period from 0, between which the law is all but a cubic."""
        return cubic_cells(self.law, self.law.breaks, NEAR, (0.0, self.period))

    @cached_property
    def _cubics(self) -> Array:
        """Coefficients (4, m) of the cubics through value and slope at both ends of each cell."""
        return cubics_between(self.law, self.nodes)

    def at(self, theta: Array) -> tuple[Array, Array, Array]:
        """Lift, mm, its slope and bend (n,) each, per rad and rad^2, at angles (n,), rad, of any turn."""
        folded = theta - self.period * np.floor(theta / self.period)
        cell = np.minimum(np.searchsorted(self.nodes, folded, side="right") - 1, len(self.nodes) - 2)
        x = folded - self.nodes[cell]
        a, b, c, d = (row[cell] for row in self._cubics)
        return a + x * (b + x * (c + x * d)), b + x * (2.0 * c + 3.0 * x * d), 2.0 * c + 6.0 * x * d

    @cached_property
    def enclosed(self) -> tuple[Array, Array]:
        """Lower and upper bounds (3, m) of lift, slope and bend over the cells."""
        mid, rad = self.law.enclosure(self.nodes[:-1], self.nodes[1:], 2)
        return mid - rad, mid + rad

    @cached_property
    def steepest(self) -> float:
        """Upper bound of the magnitude of the slope, mm per rad."""
        low, high = self.enclosed
        return float(max(-low[1].min(), high[1].max()))

    @cached_property
    def stroke(self) -> float:
        """Greatest less least lift, mm, as far as the cells' ends tell it."""
        return float(np.ptp(self._cubics[0]))

    @cached_property
    def corners(self) -> Array:
        """Angles (k,), rad, at which the velocity jumps."""
        if not len(self.law.breaks):
            return np.empty(0)
        at, jumps = self.law.jumps(1)
        corners: Array = at[np.abs(jumps[1]) > VELOCITY]
        return corners

    @cached_property
    def jump(self) -> float:
        """Greatest jump of the velocity, mm per rad."""
        return float(np.abs(self.law.jumps(1)[1][1]).max()) if len(self.corners) else 0.0

    def bends(self, side: int) -> Array:
        """Upper bounds (p,) of side times the bend, mm per rad^2, over each part of the period, beside its corners."""
        return self._greatest(side, 2)

    def bends_near(self, side: int, reach: float) -> Array:
        """Bounds (p,) as of `bends`, over parts longer by `reach`, rad, at both ends; infinite at jumps of velocity."""
        bins = self.bends(side)
        bins[self.part(self.corners)] = np.inf
        return widened(bins, reach)

    def highest_near(self, side: int, reach: float) -> Array:
        """Upper bounds (p,) of side times the lift, mm, over parts that are longer by `reach`, rad, at both ends."""
        return widened(self._greatest(side, 0), reach)

    def _greatest(self, side: int, order: int) -> Array:
        """Upper bounds (p,) of side times a derivative over each part of the period."""
        low, high = self.enclosed
        row = high[order] if side > 0 else -low[order]
        width = TURN / BINS
        first = np.minimum(np.floor(self.nodes[:-1] / width).astype(np.intp), self.parts - 1)
        last = np.minimum(np.floor(self.nodes[1:] / width).astype(np.intp), self.parts - 1)
        bins = np.full(self.parts, -np.inf)
        for step in range(int((last - first).max()) + 1):
            np.maximum.at(bins, np.minimum(first + step, last), row)
        return bins


def degrees_over(angle: float, turns: int) -> float:
    """An angle, rad, as degrees from 0 up to 360 for each of so many turns."""
    whole = 360.0 * turns
    turned = math.degrees(angle) % whole
    return 0.0 if turned >= whole else turned


def widened(bins: Array, reach: float) -> Array:
    """Greatest value within `reach`, rad, of each part of a period, from values of the parts (p,), BINS a turn."""
    more = min(int(reach * (BINS / TURN)) + 1, BINS // 2 - 1)
    padded = np.concatenate([bins[-more:], bins, bins[:more]])
    return np.asarray(np.lib.stride_tricks.sliding_window_view(padded, 2 * more + 1).max(axis=1))
