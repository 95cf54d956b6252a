"""Pitch curves of disc cams: one moving frame for every roller, knife edge and curved shoe.

The cam stands still and the follower runs round it by the shaft angle theta. The roller's centre travels in the
direction tau, at the distance b from the shaft along it, mm; a is its velocity less the eccentricity of the travel
line, mm,

    N = E(tau) (b - i a)/sigma,  T = i N,  sigma = hypot(a, b),  omega = tau' + (b' a - a' b)/sigma^2,

E(t) = exp(i t), N the outward normal. tan alpha = a/b is the pressure angle, above 0 where the cam drives a rise.
All divisors are sigma, which is above 0 as long as b is. An oscillating arm of length L about a pivot at the distance
C, s = 1 trailing and -1 leading, is a translating follower of momentary eccentricity s (C cos psi - L).
"""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias, cast

import numpy as np

from camgeo.curve.curve import Bounds, Frame, columns
from camgeo.curve.rates import MotionShape, SourceT, cut
from kin.law.normalised import IntentError, first_harmonic
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Constant
from kin.numeric import elementary
from kin.numeric.elementary import Jet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.law.segment import Stretch
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array, Mask

TURN = 2.0 * math.pi
MOST_KEPT = 8  # sets of intervals whose bounds are kept


@dataclass(frozen=True, eq=False)
class Displacement:
    """Displacement S over the whole turn, mm or rad: the periodic motion `over`, `repeats` times a turn.

    `range` is the least and the greatest S.
    """

    over: Piecewise
    repeats: int
    range: tuple[float, float]

    @staticmethod
    def of(motion: Motion) -> Displacement:
        """Displacement of a motion that repeats, over a whole turn or an equal part of one.

        Raises IntentError unless S and S' join all round, ValueError for a motion over another angle, or with another
        `around` than 1, which does not repeat.
        """
        repeats = round(TURN / motion.total)
        if not (motion.around == 1 and repeats >= 1 and abs(repeats * motion.total - TURN) <= 1e-9):
            raise ValueError(f"a motion over {motion.total!r} rad does not go round a turn")
        return Displacement(motion.periodic(), repeats, motion.range)

    @cached_property
    def breaks(self) -> Array:
        """Angles (m,) in [0, 2 pi), rising, at which a derivative of S may jump."""
        parts = np.arange(self.repeats) * (TURN / self.repeats)
        return np.sort((self.over.breaks[None, :] + parts[:, None]).ravel())

    @cached_property
    def functions(self) -> tuple[Stretch, ...]:
        """Function of each stretch between breaks; a single one without breaks."""
        begin = self.over.breaks if len(self.over.breaks) else self.over.knots[:1]
        index, _ = self.over.locate(begin, 1)
        part = tuple(self.over.functions[i] for i in index)
        return part * self.repeats if len(self.over.breaks) else part

    @property
    def steady(self) -> Mask:
        """Whether each stretch (m,) is a dwell."""
        return np.array([isinstance(f, Constant) for f in self.functions])

    def law(self, offset: float = 0.0, scale: float = 1.0) -> Piecewise:
        """The motion offset + scale S over a whole turn, by pieces."""
        over = self.over
        knots = [over.knots[:1], *(over.knots[1:] + i * TURN / self.repeats for i in range(self.repeats))]
        functions = [
            _transform(f, offset, scale, i * TURN / self.repeats) for i in range(self.repeats) for f in over.functions
        ]
        return Piecewise(np.concatenate(knots), tuple(functions), TURN, over.smooth_seam and self.repeats == 1)

    def scaled(self, scale: float) -> Displacement:
        """The motion with S multiplied by `scale`."""
        functions = tuple(_transform(f, 0.0, scale, 0.0) for f in self.over.functions)
        over = Piecewise(self.over.knots, functions, self.over.period, self.over.smooth_seam)
        low, high = sorted(scale * end for end in self.range)
        return Displacement(over, self.repeats, (low, high))

    @property
    def rounding(self) -> float:
        """Rounding error of S and S' through a recipe's own formula, mm or rad; 0 without one."""
        return self.over.rounding

    @property
    def eccentric(self) -> Mask:
        """Whether S + S'' is constant on each stretch (m,): a dwell, or the harmonic law over a half turn."""
        harmonic = [isinstance(f, AffineStretch) and first_harmonic(f) is not None for f in self.functions]
        mask: Mask = self.steady | np.array(harmonic)
        return mask

    def on(self, tau: Series, side: Side = 1) -> Series:
        """S, mm or rad, at jets of the shaft angle; at breaks the limit from above (side 1) or below (-1)."""
        return self.over.on(tau, side)

    def derivatives(self, theta: Array, order: int, side: Side = 1) -> Array:
        """S, mm or rad, and its derivatives by the shaft angle at theta (n,), rad: (order + 1, n)."""
        return self.over.derivatives(theta, order, side)


def _transform(function: Stretch, offset: float, scale: float, start: float) -> Stretch:
    if isinstance(function, Constant):
        return Constant(offset + scale * function.value)
    return AffineStretch.of(function, offset=offset, scale=scale, start=start)


@dataclass(frozen=True)
class Translating:
    """A stem whose line passes the shaft at `offset` e, mm, above 0 on the side from which the surface comes.

    The centre is at d + S along the line, `foot` d, mm, with d^2 = Rp^2 - e^2. The line stands `turned` ahead of the
    shaft angle, rad.
    """

    foot: float
    offset: float = 0.0
    turned: float = 0.0

    @staticmethod
    def on(prime: float, offset: float = 0.0) -> Translating:
        """Guide with a prime circle of radius `prime` and an offset, mm; raises IntentError if the line misses it."""
        if not (math.isfinite(prime) and abs(offset) < prime):
            raise IntentError(
                f"the offset, {offset:.6g} mm, must be below the prime circle's radius, {prime:.6g} mm",
                "follower.offset",
            )
        return Translating(math.sqrt((prime - offset) * (prime + offset)), offset)

    @property
    def prime(self) -> float:
        """Radius of the prime circle, mm: the centre's distance from the shaft at S = 0."""
        return math.hypot(self.foot, self.offset)

    @property
    def datum(self) -> float:
        """Position on the line at S = 0, mm from the foot of the shaft."""
        return self.foot

    def demand(self, least: float, greatest: float) -> None:  # noqa: ARG002 - the protocol's
        """Raise IntentError where the centre would come down to the shaft at the least displacement, mm."""
        if not self.foot + least > 0.0:
            raise IntentError(
                f"the roller's centre would come down to the shaft: {self.foot + least:.6g} mm along its line",
                "base_radius",
            )

    def place(self, theta: Array, s: Array) -> tuple[Array, Array]:
        """Centre as complex numbers, mm (n,), and direction of travel, rad (n,), at shaft angles and S (n,)."""
        travel = theta + self.turned if self.turned else theta
        return np.exp(1j * travel) * (self.foot + s + 1j * self.offset), travel

    def rows(self, s: Array) -> tuple[Array, Array, Array]:
        """Terms of the moving frame at S, mm: b (3, n), a (3, n), mm, and tau' (2, n), with derivatives by theta.

        `s` (4, n) is S with its first three derivatives. b, a and tau' are defined at the head of this module.
        """
        b, a, rate = s[:3].copy(), s[1:].copy(), np.zeros_like(s[:2])
        b[0] += self.foot
        a[0] -= self.offset
        rate[0] = 1.0
        return b, a, rate

    def frame(self, s: Series) -> tuple[Series, Series, Series | float]:
        """Terms b, mm, a, mm, and tau' of the moving frame as series: of the order of S, one less and one less.

        b, a and tau' are defined at the head of this module.
        """
        return s + self.foot, s.derivative() - self.offset, 1.0

    def resized(self, prime: float) -> Translating:
        """Copy of the guide with a prime circle of another radius, mm; the offset stays.

        Raises IntentError where the stem's line misses the circle.
        """
        return Translating.on(prime, self.offset)

    def with_shaft(self, along: Array | float, across: Array | float) -> Translating:
        """Guide on the same line with the shaft elsewhere.

        At rest at S = 0 the frame's b is `along` and its a is -`across`, mm, as the head of this module defines both.
        """
        return Translating(cast("float", along), cast("float", across))


@dataclass(frozen=True)
class Oscillating:
    """An arm of a length about a pivot at a distance from the shaft, mm.

    psi = rest + S, rad, is its angle to the line from pivot to shaft. `side` is 1 for a trailing arm (the roller
    clockwise of the pivot as drawn), -1 for a leading one.
    """

    pivot: float
    length: float
    rest: float
    side: int

    @staticmethod
    def on(prime: float, pivot: float, length: float, side: int) -> Oscillating:
        """Guide with a prime circle of radius `prime`, lengths in mm; raises IntentError unless the arm reaches it."""
        if not abs(pivot - length) < prime < pivot + length:
            raise IntentError(
                f"an arm of {length:.6g} mm about a pivot at {pivot:.6g} mm does not reach a prime circle of "
                f"{prime:.6g} mm: it reaches {abs(pivot - length):.6g} to {pivot + length:.6g} mm",
                "follower.arm",
            )
        # half-angle formula: keeps its digits near a stretched or folded arm
        low, high = (prime - pivot + length) * (prime + pivot - length), (pivot + length - prime)
        rest = 2.0 * math.atan2(math.sqrt(low), math.sqrt(high * (pivot + length + prime)))
        return Oscillating(pivot, length, rest, side)

    @property
    def prime(self) -> float:
        """Radius of the prime circle, mm."""
        return math.hypot(self.pivot * math.cos(self.rest) - self.length, self.pivot * math.sin(self.rest))

    @property
    def datum(self) -> float:
        """Angle of the arm to the line from pivot to shaft at S = 0, rad."""
        return self.rest

    def demand(self, least: float, greatest: float) -> None:
        """Raise IntentError where the arm would point at the shaft or away from it between two displacements, rad."""
        low, high = self.rest + least, self.rest + greatest
        if not (low > 0.0 and high < math.pi):
            raise IntentError(
                f"the arm swings from {math.degrees(low):.6g} to {math.degrees(high):.6g} degrees to the line from "
                "pivot to shaft; only angles between 0 and 180 can be driven",
                "follower.arm",
            )

    def place(self, theta: Array, s: Array) -> tuple[Array, Array]:
        """Centre as complex numbers, mm (n,), and direction of travel, rad (n,), at shaft angles and S (n,)."""
        psi = self.rest + s
        centre = np.exp(1j * theta) * (self.pivot - self.length * np.exp(1j * self.side * psi))
        return centre, theta + self.side * (psi - 0.5 * math.pi)

    def rows(self, s: Array) -> tuple[Array, Array, Array]:
        """Terms of the moving frame at S, rad: b (3, n), a (3, n), mm, and tau' (2, n), with derivatives by theta.

        `s` (4, n) is S with its first three derivatives. b, a and tau' are defined at the head of this module.
        """
        sine, cosine = self.pivot * np.sin(self.rest + s[0]), self.pivot * np.cos(self.rest + s[0])
        _, v, w, j = s
        b = np.stack([sine, cosine * v, cosine * w - sine * v * v])
        a = np.stack(
            [
                self.length * v - self.side * (cosine - self.length),
                self.length * w + self.side * sine * v,
                self.length * j + self.side * (b[1] * v + sine * w),
            ]
        )
        return b, a, np.stack([1.0 + self.side * v, self.side * w])

    def frame(self, s: Series) -> tuple[Series, Series, Series | float]:
        """Terms b, mm, a, mm, and tau' of the moving frame as series: of the order of S, one less and one less.

        b, a and tau' are defined at the head of this module.
        """
        psi, side = s + self.rest, float(self.side)
        slope = s.derivative()
        lean = elementary.cos(cut(psi, slope.order)) * self.pivot - self.length
        return elementary.sin(psi) * self.pivot, slope * self.length - lean * side, slope * side + 1.0

    def resized(self, prime: float) -> Oscillating:
        """Copy of the guide with a prime circle of another radius, mm; pivot and arm stay.

        Raises IntentError where the arm does not reach the circle.
        """
        return Oscillating.on(prime, self.pivot, self.length, self.side)

    def with_shaft(self, along: Array | float, across: Array | float) -> Oscillating:
        """Guide with the same arm and pivot and the shaft elsewhere.

        At rest at S = 0 the frame's b is `along` and its a is -`across`, mm; the head of this module defines both.
        """
        x = self.length + self.side * across
        return Oscillating(
            cast("float", np.hypot(x, along)), self.length, cast("float", np.arctan2(along, x)), self.side
        )


Guide: TypeAlias = Translating | Oscillating
"""Guide of a roller's centre: its place, its direction of travel, and the frame's b, a and tau'."""


@dataclass(frozen=True)
class FramedShape(MotionShape[SourceT]):
    """Path of a point by the figures b, a and tau' of its moving frame, over the parameter of a motion."""

    @abstractmethod
    def frame(self, figures: tuple[Series, ...]) -> tuple[Series, Series, Series | float]:
        """Terms b, mm, a, mm, and tau' of the moving frame as series, from the motion's figures."""

    @abstractmethod
    def rows(self, t: Array, side: Side) -> tuple[Array, Array, Array, Array, Array]:
        """Point, mm, as complex numbers (n,), tau, rad (n,), and b, a, mm (3, n), tau' (2, n) with derivatives.

        They are at parameters t (n,), and the derivatives are by the parameter.
        """

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,), rad; at a break the limit from above (side 1) or from below (side -1)."""
        centre, travel, b, a, rate = self.rows(t, side)
        # sigma and omega of the head of this module, with first derivatives
        speed = np.hypot(a[0], b[0])
        square = speed * speed
        along = a[0] * a[1] + b[0] * b[1]
        bend = (b[1] * a[0] - a[1] * b[0]) / square
        turn_slope = rate[1] + (b[2] * a[0] - a[2] * b[0] - 2.0 * along * bend) / square
        tangent = np.exp(1j * travel) * (a[0] + 1j * b[0]) / speed
        return Frame(
            columns(centre.real, centre.imag),
            columns(tangent.real, tangent.imag),
            speed,
            rate[0] + bend,
            along / speed,
            turn_slope,
        )

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds of speed, turn and their derivatives over intervals [low, high] (n,).

        Bounds are kept for parallels of the curve, which are bounded over the same intervals.
        """
        key = low.tobytes(), high.tobytes()
        if key not in self._bounds:
            if len(self._bounds) == MOST_KEPT:
                self._bounds.clear()
            self._bounds[key] = super().bounds(low, high)
        return self._bounds[key]

    @cached_property
    def _bounds(self) -> dict[tuple[bytes, bytes], Bounds]:
        return {}

    def rates_of(self, figures: tuple[Series, ...]) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, from the motion's figures, two orders fewer."""
        b, a, rate = self.frame(figures)
        a_slope = a.derivative()
        order = a_slope.order
        b_slope, a, b = cut(b.derivative(), order), cut(a, order), cut(b, order)
        square = a**2 + b**2
        bend = (b_slope * a - a_slope * b) * square**-1
        return elementary.sqrt(square), bend + (rate if isinstance(rate, float) else cut(rate, order))


@dataclass(frozen=True)
class CentreShape(FramedShape[Displacement]):
    """Path of a roller's centre round the standing cam, over the shaft angle; a knife edge's is the contour itself."""

    guide: Guide

    def __post_init__(self) -> None:
        self.guide.demand(*self.law.range)

    def figures(self, tau: Series, side: Side = 1) -> tuple[Series, ...]:
        """S, in a tuple of one, at jets of the shaft angle."""
        return (self.law.on(tau, side),)

    def frame(self, figures: tuple[Series, ...]) -> tuple[Series, Series, Series | float]:
        """Terms b, mm, a, mm, and tau' of the frame as series from the figure S: b of its order, others of one less."""
        return self.guide.frame(figures[0])

    def rows(self, t: Array, side: Side) -> tuple[Array, Array, Array, Array, Array]:
        """Point, mm, as complex numbers (n,), tau, rad (n,), and b, a, mm (3, n), tau' (2, n) with derivatives.

        They are at shaft angles t (n,), rad, and the derivatives are by the shaft angle.
        """
        s = self.law.derivatives(t, 3, side)
        return (*self.guide.place(t, s[0]), *self.guide.rows(s))

    def slope(self, tau: Series, side: Side = 1) -> Series:
        """Tangent of the pressure angle, a/b, as a series at jets of the shaft angle."""
        b, a, _ = self.guide.frame(self.law.on(tau, side))
        return a / cut(b, a.order)

    def spin(self, tau: Series, side: Side, radius: float, sense: float) -> Series:
        """Turns of a roller of a radius R, mm, per turn of the shaft, as a series at jets of the shaft angle.

        They are sigma/R - tau', with `sense` -1, in a ring, -sigma/R - tau'.
        """
        b, a, rate = self.guide.frame(self.law.on(tau, side))
        speed = elementary.sqrt(a**2 + cut(b, a.order) ** 2)
        return speed * (sense / radius) - rate

    def pressure_angle(self, theta: Array, side: Side = 1) -> Array:
        """Pressure angle, rad (n,), at shaft angles (n,), rad: above 0 where the cam drives a rise."""
        angle: Array = np.arctan(self.slope(Jet.variable(theta, 1), side).c[0])
        return angle
