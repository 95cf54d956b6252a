"""Closed outlines of a plate: stretches of flanks, straight edges and corners, as one curve that fits take."""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import Bounds, Curve, Frame, Shape, SmoothRun
from kin.numeric.elementary import Jet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.curve.curve import Side
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array, Indices

CORNER = 1e-9  # rad: a smaller turn between two parts is rounding, and they run on smoothly


@dataclass(frozen=True)
class Straight:
    """A straight stretch between two points (2,), mm; its parameter is the length from the first."""

    start: tuple[float, float]
    end: tuple[float, float]

    @property
    def period(self) -> float:
        """Length, mm."""
        return math.dist(self.start, self.end)

    @property
    def breaks(self) -> Array:
        """Its beginning alone."""
        return np.zeros(1)

    @property
    def repeats(self) -> int:
        """1, as it is no part of a turn."""
        return 1

    @property
    def steady(self) -> Array:
        """Speed 1 and turn 0 (1, 2)."""
        return np.array([[1.0, 0.0]])

    @property
    def radii(self) -> Array:
        """Radius of curvature (1,): infinite."""
        return np.array([np.inf])

    def sample(self, t: Array, side: Side = 1) -> Frame:  # noqa: ARG002 - the protocol's
        """Frame at lengths t (n,), mm, from the first point."""
        first, chord = np.array(self.start), np.subtract(self.end, self.start)
        share = (t / self.period)[:, None]
        # by either end, so that both are met exactly
        point = np.where(share < 0.5, first + share * chord, np.array(self.end) - (1.0 - share) * chord)
        zero = np.zeros_like(t)
        tangent = np.broadcast_to(chord / self.period, (t.size, 2))
        return Frame(point, tangent, np.ones_like(t), zero, zero, zero)

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:  # noqa: ARG002 - the protocol's
        """Taylor coefficients (order + 1, n) of speed and turn."""
        speed = np.zeros((order + 1, t.size))
        speed[0] = 1.0
        return speed, np.zeros_like(speed)

    def bounds(self, low: Array, high: Array) -> Bounds:  # noqa: ARG002 - the protocol's
        """Bounds over intervals (n,)."""
        one, zero = np.ones_like(low), np.zeros_like(low)
        return Bounds(one, one, zero, zero, zero, zero, zero, zero)

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:  # noqa: ARG002 - the protocol's
        """Speed and turn as series."""
        return tau.constant(1.0), tau.constant(0.0)


@dataclass(frozen=True)
class Round:
    """An arc about a centre, mm, from a direction, rad; its parameter is the angle, counter-clockwise for `sense` 1."""

    centre: tuple[float, float]
    radius: float
    begin: float
    sense: int = 1

    @property
    def period(self) -> float:
        """A whole turn, rad."""
        return 2.0 * math.pi

    @property
    def breaks(self) -> Array:
        """Its beginning alone."""
        return np.zeros(1)

    @property
    def repeats(self) -> int:
        """1, as it is one arc."""
        return 1

    @property
    def steady(self) -> Array:
        """Speed and turn (1, 2)."""
        return np.array([[self.radius, float(self.sense)]])

    @property
    def radii(self) -> Array:
        """Signed radius of curvature (1,), mm."""
        return np.array([self.sense * self.radius])

    def sample(self, t: Array, side: Side = 1) -> Frame:  # noqa: ARG002 - the protocol's
        """Frame at angles t (n,), rad, from its beginning."""
        angle = self.begin + self.sense * t
        out = np.column_stack([np.cos(angle), np.sin(angle)])
        one, zero = np.ones_like(t), np.zeros_like(t)
        tangent = self.sense * np.column_stack([-out[:, 1], out[:, 0]])
        point = np.array(self.centre) + self.radius * out
        return Frame(point, tangent, self.radius * one, self.sense * one, zero, zero)

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:  # noqa: ARG002 - the protocol's
        """Taylor coefficients (order + 1, n) of speed and turn."""
        speed, turn = np.zeros((2, order + 1, t.size))
        speed[0], turn[0] = self.radius, self.sense
        return speed, turn

    def bounds(self, low: Array, high: Array) -> Bounds:  # noqa: ARG002 - the protocol's
        """Bounds over intervals (n,)."""
        one, zero = np.ones_like(low), np.zeros_like(low)
        speed, turn = self.radius * one, self.sense * one
        return Bounds(speed, speed, turn, turn, zero, zero, zero, zero)

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:  # noqa: ARG002 - the protocol's
        """Speed and turn as series."""
        return tau.constant(self.radius), tau.constant(float(self.sense))


@dataclass(frozen=True)
class Part:
    """A part of an outline: a shape over its parameters from `low` to `high`."""

    shape: Shape
    low: float
    high: float

    @cached_property
    def ends(self) -> Frame:
        """Frames at both ends, from inside."""
        return self.shape.sample(np.array([self.low, self.high]), np.array([1, -1]))

    @cached_property
    def inner(self) -> Array:
        """Breaks of the shape between the ends (k,), rising; it goes on with its period."""
        breaks, period = np.asarray(self.shape.breaks, dtype=np.float64), self.shape.period
        first, last = math.floor(self.low / period) - 1, math.ceil(self.high / period) + 1
        every = (breaks + period * np.arange(first, last + 1)[:, None]).ravel()
        near = 1e-12 * (abs(self.low) + abs(self.high) + period)
        return np.sort(every[(every > self.low + near) & (every < self.high - near)])

    def table(self, name: str) -> Array:
        """Rows of `steady` or `radii` for each of its stretches (k + 1, ...)."""
        rows: Array = getattr(self.shape, name)
        knots = np.concatenate([[self.low], self.inner, [self.high]])
        middle = 0.5 * (knots[1:] + knots[:-1]) % self.shape.period
        breaks = np.asarray(self.shape.breaks, dtype=np.float64)
        chosen: Array = rows[(np.searchsorted(breaks, middle, side="right") - 1) % max(breaks.size, 1)]
        return chosen


@dataclass(frozen=True)
class Joined:
    """Parts one after another as one closed curve, its parameter counted on from part to part."""

    parts: tuple[Part, ...]

    @cached_property
    def begins(self) -> Array:
        """Parameters at which the parts begin, and the end of the last (n + 1,)."""
        return np.concatenate([[0.0], np.cumsum([part.high - part.low for part in self.parts])])

    @property
    def period(self) -> float:
        """Length of the parameter."""
        return float(self.begins[-1])

    @cached_property
    def breaks(self) -> Array:
        """Parameters (m,), rising from 0, at which a part begins or breaks."""
        rows = [
            begin + np.concatenate([[0.0], part.inner - part.low])
            for begin, part in zip(self.begins, self.parts, strict=False)
        ]
        return np.concatenate(rows)

    @property
    def repeats(self) -> int:
        """1, as its parts are all different."""
        return 1

    @cached_property
    def steady(self) -> Array:
        """Speed and turn of each stretch (m, 2), nan unless both are constant."""
        return np.concatenate([part.table("steady") for part in self.parts])

    @cached_property
    def radii(self) -> Array:
        """Signed radii of the stretches that are circular arcs, mm, nan of the others (m,)."""
        return np.concatenate([part.table("radii") for part in self.parts])

    def _owners(self, t: Array, side: Side) -> tuple[Array, Indices, Indices]:
        """Own parameters (n,), numbers of their parts (n,), and sides (n,)."""
        sides = np.broadcast_to(np.asarray(side, dtype=np.intp), t.shape)
        turn = np.where(sides > 0, np.floor(t / self.period), np.ceil(t / self.period) - 1.0)
        t = t - turn * self.period
        above = np.searchsorted(self.begins, t, side="right") - 1
        below = np.searchsorted(self.begins, t, side="left") - 1
        owner = np.clip(np.where(sides > 0, above, below), 0, len(self.parts) - 1)
        low = np.array([part.low for part in self.parts])
        high = np.array([part.high for part in self.parts])
        own = np.clip(low[owner] + (t - self.begins[owner]), low[owner], high[owner])
        # the end of a part is met exactly
        return np.where(t == self.begins[owner + 1], high[owner], own), owner, sides

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,); where parts meet that of the part above (side 1) or below (side -1)."""
        own, owner, sides = self._owners(np.asarray(t, dtype=np.float64), side)
        rows = [np.empty((t.size, 2)), np.empty((t.size, 2)), *np.empty((4, t.size))]
        for number in np.unique(owner):
            here = owner == number
            frame = self.parts[number].shape.sample(own[here], sides[here])
            for row, value in zip(rows, frame.rows, strict=True):
                row[here] = value
        return Frame(*rows)

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed and turn."""
        own, owner, sides = self._owners(np.asarray(t, dtype=np.float64), side)
        speed, turn = np.empty((order + 1, t.size)), np.empty((order + 1, t.size))
        for number in np.unique(owner):
            here = owner == number
            speed[:, here], turn[:, here] = self.parts[number].shape.series(own[here], order, sides[here])
        return speed, turn

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Speed and turn as series at jets of the parameter, which all lie in one part."""
        value = tau.c[0] if isinstance(tau, Jet) else tau.mid[0]
        own, owner, sides = self._owners(np.asarray(value), side)
        number = int(owner.ravel()[0])
        return self.parts[number].shape.rates(tau + (own - value), sides)

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over intervals [low, high] (n,), each within one part."""
        owner = np.clip(np.searchsorted(self.begins, 0.5 * (low + high), side="right") - 1, 0, len(self.parts) - 1)
        rows = np.empty((8, low.size))
        for number in np.unique(owner):
            here, part = owner == number, self.parts[number]
            moved = part.low - self.begins[number]
            first, last = np.maximum(low[here] + moved, part.low), np.minimum(high[here] + moved, part.high)
            rows[:, here] = part.shape.bounds(first, last).rows()
        return Bounds(*rows)


def joined(parts: Sequence[Part]) -> Curve:
    """Closed curve of parts, each of which begins where the one before ends, mm; it has corners where they turn.

    Raises ValueError for parts that begin elsewhere than at a corner where there are corners.
    """
    shape = Joined(tuple(parts))
    ends = [part.ends.tangent for part in parts]
    corner = [float(np.hypot(*(ends[i][0] - ends[i - 1][1]))) > CORNER for i in range(len(parts))]
    if not any(corner):
        return Curve(shape, (SmoothRun(0.0, shape.period, tuple(shape.breaks[1:].tolist()), closed=True),))
    if not corner[0]:
        raise ValueError("an outline begins at a corner")
    starts = [float(shape.begins[i]) for i in range(len(parts)) if corner[i]] + [shape.period]
    runs = []
    for low, high in pairwise(starts):
        inside = shape.breaks[(shape.breaks > low) & (shape.breaks < high)]
        runs.append(SmoothRun(low, high, tuple(inside.tolist()), closed=False))
    return Curve(shape, tuple(runs))
