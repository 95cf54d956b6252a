"""The path of a follower's centre over the standing plate of a linear cam: its guide, and one moving frame.

The axes are those of a plate that travels to the right: the follower runs to -x, y points away from the plate. A plate
that travels to the left is the mirror image (x -> -x). With the guide's direction E(tau), the travel u, mm, and
tan alpha = a/b,

    stem  c = (-u, foot) + S E(tau),        tau = 90 deg + lean,      a = S' + sin(lean),         b = cos(lean)
    arm   c = (s l cos psi - u, h + l sin psi),  tau = 90 deg + s psi,  a = l S' + s sin psi,   b = cos psi

where psi = rest + S, and the frame is that of `camgeo.curve.moving_frame`: c' = a E(tau) + i b E(tau).
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from camgeo.curve.moving_frame import FramedShape
from camgeo.curve.rates import cut
from kin.law.segment import Constant
from kin.numeric import elementary
from kin.numeric.elementary import BallJet, Jet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.law.piecewise import Piecewise
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array, Mask

QUARTER = 0.5 * math.pi
STRAIGHT = 1e-14  # change of S' over a stretch that is rounding


@dataclass(frozen=True, eq=False)
class Travel:
    """Displacement S over a travel u from 0 to `total`, mm; S is mm, or rad on an arm.

    An endless motion is periodic, and `total` is its period.
    """

    over: Piecewise
    total: float
    range: tuple[float, float]

    @staticmethod
    def of(motion: Motion, *, endless: bool) -> Travel:
        """Travel of a motion; raises IntentError for an endless one that does not join."""
        return Travel(motion.periodic() if endless else motion.motion, motion.total, motion.range)

    @cached_property
    def breaks(self) -> Array:
        """Places (m,) in [0, total), rising, the first at 0, at which a derivative may jump."""
        inner = np.asarray(self.over.breaks, dtype=np.float64)
        places: Array = np.concatenate([[0.0], inner[(inner > 0.0) & (inner < self.total)]])
        return places

    @property
    def repeats(self) -> int:
        """Number of equal parts: 1, as parts that repeat are moved on, not turned."""
        return 1

    @property
    def middles(self) -> Array:
        """Middles (m,) of the stretches between breaks, mm."""
        middles: Array = 0.5 * (self.breaks + np.append(self.breaks[1:], self.total))
        return middles

    @cached_property
    def steady(self) -> Mask:
        """Whether each stretch (m,) is a dwell, exactly."""
        index, _ = self.over.locate(self.middles, 1)
        return np.array([isinstance(self.over.functions[i], Constant) for i in np.atleast_1d(index)])

    @cached_property
    def even(self) -> Mask:
        """Whether S' is constant on each stretch (m,), up to rounding, as by a constant velocity."""
        ends = np.append(self.breaks[1:], self.total)
        rows = np.stack(self.over.on(BallJet.variable(self.breaks, ends, 2)).bounds())
        bend, slope = (np.abs(rows[:, k]).max(axis=0) for k in (2, 1))
        mask: Mask = self.steady | (bend * (ends - self.breaks) <= STRAIGHT * np.maximum(slope, 1.0))
        return mask

    def on(self, tau: Series, side: Side = 1) -> Series:
        """S, mm or rad, at jets of the travel; at breaks the limit from above (side 1) or below (-1)."""
        return self.over.on(tau, side)

    def derivatives(self, u: Array, order: int, side: Side = 1) -> Array:
        """S, mm or rad, and its derivatives by the travel at u (n,), mm: (order + 1, n)."""
        return self.over.derivatives(u, order, side)


@dataclass(frozen=True)
class Stem:
    """A straight guide through (0, foot) at travel 0, mm; it leans by `lean`, rad, against what eases the rise.

    A recipe's lean, which eases the rise, is the negative of it.
    """

    foot: float
    lean: float = 0.0

    def place(self, u: Array, s: Array) -> tuple[Array, Array]:
        """Centre as complex numbers, mm (n,), and direction of the guide, rad (n,), at travel u and S, mm (n,)."""
        sine, cosine = math.sin(self.lean), math.cos(self.lean)
        return -(u + sine * s) + 1j * (self.foot + cosine * s), np.full_like(u, QUARTER + self.lean)

    def rows(self, s: Array) -> tuple[Array, Array, Array]:
        """Terms b (3, n), a (3, n), tau' (2, n) of the frame with derivatives, from S and its derivatives (4, n)."""
        b, a = np.zeros_like(s[:3]), s[1:].copy()
        b[0] = math.cos(self.lean)
        a[0] += math.sin(self.lean)
        return b, a, np.zeros_like(s[:2])

    def frame(self, s: Series) -> tuple[Series, Series, Series | float]:
        """Terms b, a and tau' of the frame as series: of the order of S, one less and one less."""
        return s.constant(math.cos(self.lean)), s.derivative() + math.sin(self.lean), 0.0

    def aside(self, s: Series) -> Series:
        """Place along the travel ahead of u, mm, at S."""
        return s * math.sin(self.lean)

    @property
    def unit(self) -> str:
        """Unit of S in reports."""
        return "mm"

    @property
    def reach(self) -> float:
        """Length, mm, by which S is multiplied to a path of the centre."""
        return 1.0


@dataclass(frozen=True)
class Arm:
    """An arm of a length about a pivot at a height over the lower edge, mm; it is at `rest`, rad, at S = 0.

    `side` is 1 for a trailing arm, which drags its roller, -1 for a leading one.
    """

    length: float
    height: float
    rest: float
    side: int

    def place(self, u: Array, s: Array) -> tuple[Array, Array]:
        """Centre as complex numbers, mm (n,), and direction of its motion, rad (n,), at travel u, mm, and S, rad."""
        psi = self.rest + s
        across, up = self.side * self.length * np.cos(psi), self.length * np.sin(psi)
        return across - u + 1j * (self.height + up), QUARTER + self.side * psi

    def rows(self, s: Array) -> tuple[Array, Array, Array]:
        """Terms b (3, n), a (3, n), tau' (2, n) of the frame with derivatives, from S and its derivatives (4, n)."""
        sine, cosine = np.sin(self.rest + s[0]), np.cos(self.rest + s[0])
        _, v, w, _ = s
        b = np.stack([cosine, -sine * v, -cosine * v * v - sine * w])
        a = self.length * s[1:] + self.side * np.stack([sine, cosine * v, cosine * w - sine * v * v])
        return b, a, self.side * s[1:3]

    def frame(self, s: Series) -> tuple[Series, Series, Series | float]:
        """Terms b, a and tau' of the frame as series: of the order of S, one less and one less."""
        psi, slope = s + self.rest, s.derivative()
        a = slope * self.length + elementary.sin(cut(psi, slope.order)) * float(self.side)
        return elementary.cos(psi), a, slope * float(self.side)

    def aside(self, s: Series) -> Series:
        """Place along the travel ahead of u, mm, at S."""
        return elementary.cos(s + self.rest) * (-self.side * self.length)

    @property
    def unit(self) -> str:
        """Unit of S in reports."""
        return "deg"

    @property
    def reach(self) -> float:
        """Length, mm, by which S is multiplied to a path of the centre."""
        return self.length


Guide: TypeAlias = Stem | Arm
"""Guide of the follower's centre."""


@dataclass(frozen=True)
class CentrePath(FramedShape[Travel]):
    """Path of a follower's centre over the standing plate, over the travel; a knife edge's is the contour itself."""

    guide: Guide

    @property
    def period(self) -> float:
        """Length of the travel, mm: the curve is open there, or goes on."""
        return self.law.total

    @cached_property
    def steady(self) -> Array:
        """Speed and turn, 1 and rad/mm, of each stretch (m, 2) on which the path is straight; else nan.

        It is where the follower dwells, and where a stem moves at a constant velocity.
        """
        out = np.full((self._straight.size, 2), np.nan)
        out[self._straight, 0] = self.sample(self.law.middles[self._straight]).speed
        out[self._straight, 1] = 0.0
        return out

    @cached_property
    def _straight(self) -> Mask:
        return self.law.even if isinstance(self.guide, Stem) else self.law.steady

    @property
    def radii(self) -> Array:
        """Radii, mm, of the stretches that are circular arcs (m,): infinite of straight ones, else nan."""
        return np.where(self._straight, np.inf, np.nan)

    def figures(self, tau: Series, side: Side = 1) -> tuple[Series, ...]:
        """S, in a tuple of one, at jets of the travel."""
        return (self.law.on(tau, side),)

    def frame(self, figures: tuple[Series, ...]) -> tuple[Series, Series, Series | float]:
        """Terms b, a and tau' of the frame as series from the figure S."""
        return self.guide.frame(figures[0])

    def rows(self, t: Array, side: Side) -> tuple[Array, Array, Array, Array, Array]:
        """Centre, mm, as complex numbers, direction of the guide, rad, and b, a, tau' with derivatives, at t (n,)."""
        s = self.law.derivatives(t, 3, side)
        return (*self.guide.place(t, s[0]), *self.guide.rows(s))

    def slope(self, tau: Series, side: Side = 1) -> Series:
        """Tangent of the pressure angle as a series: above 0 where the plate drives a rise."""
        b, a, _ = self.guide.frame(self.law.on(tau, side))
        return a / cut(b, a.order)

    def pressure_angle(self, u: Array, side: Side = 1) -> Array:
        """Pressure angle, rad (n,), at the travel u (n,), mm: above 0 where the plate drives a rise."""
        angle: Array = np.arctan(self.slope(Jet.variable(u, 1), side).c[0])
        return angle
