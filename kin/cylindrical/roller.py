"""A roller without ends on one flank of a drum: how far points of the metal stand into it, at their worst angle.

Of a point at the polar angle phi, the radius r and the height z, and of the roller at the shaft angle theta, let

    y = r sin(phi - theta), X = r cos(phi - theta)   across the roller's axis, and along it
    v = side (level + S(theta) - z)                  below 0 where the point is on the metal's side of that axis.

The roller has to give way by F = v + sqrt(R^2 - y^2) along z. Its greatest value over theta is the height of the point
over the exact flank, since that is the envelope of all rollers; it is reached where y X/sqrt(R^2 - y^2) = -side S', so
that |y| <= R sin a, tan a the steepest slope over X. The distance from the flank is the least of hypot(y, v) - R over
theta, above 0 inside the metal: rollers larger by d have an envelope d away. Positions alone make both.

F is concave in theta where side S'' < (X^2 - y^2)/R, and has one peak then; elsewhere peaks are sought by cells.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from kin.cylindrical.lifts import widened
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass
from kin.turned.guide import Slide

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.lifts import Lifts
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.turned.guide import Axis, Guide

Along = TypeVar("Along", float, "Array")

STEPS = 12  # of Newton's method at most
SETTLED = 1e-10  # rad: after a step below this the next would be rounding
WITHIN = 0.999  # of the roller's radius, within which a point is looked at
CELLS = 16  # about a point, where peaks are sought by cells
SMALL, NOTHING = 2e-3, 1e-12  # rad: half a cell that holds one peak at most, and one of which nothing is left
BESIDE = 0.05  # rad to both sides of a polar angle, for which a bound of F holds


class Stand(NamedTuple):
    """How points stand to a roller at given angles, (n,) each: F, mm, its slope, per rad; y, X and v, mm."""

    gives: Array
    slope: Array
    y: Array
    along: Array
    v: Array


class Near(NamedTuple):
    """Points near their worst angles: F, mm, its slope, per rad, the distance from the flank, and X, mm; nan: no F."""

    height: Array
    rate: Array
    distance: Array
    along: Array


class Held(NamedTuple):
    """How points stand to a roller: F, mm, nan where it does not reach them, their distance from it, and X, mm."""

    gives: Array
    away: Array
    along: Array


class Place(NamedTuple):
    """Points by polar angle, rad, radius and height, mm."""

    phi: Array
    r: Array
    z: Array

    def take(self, which: Indices) -> Place:
        """Some of the points."""
        return Place(*(row[which] for row in self))


class Worst(NamedTuple):
    """Points at their worst angles theta, rad: height over the exact flank, and distance from it into the metal.

    `bend` bounds the curvature of F over theta there, mm per rad^2: F falls at least so fast. It is 0 where nothing is
    known.
    """

    theta: Array
    height: Array
    distance: Array
    bend: Array


class Leaning(NamedTuple):
    """Sine and cosine of a contact's angle a against z, towards -e_t, and h = cos a A + sin a z', mm."""

    sine: Array
    cosine: Array
    h: Array


@dataclass(frozen=True, eq=False)
class Gauge:
    """A roller of `radius`, mm, on a flank on its `side`, its axis at `level` above z = 0 at lift 0.

    name          of the flank: lower or upper
    inner, outer  where it begins and ends along its axis, mm, which counts for the motion alone
    lifts         the intended motion
    floor         radius down to which the flank reaches, mm
    """

    name: str
    side: Side
    radius: float
    level: float
    inner: float
    outer: float
    lifts: Lifts
    floor: float

    @property
    def led(self) -> Guide:
        """What leads the roller's axis."""
        return Slide(0.0, self.level)

    @property
    def spread(self) -> float:
        """How fast the roller's radius grows along its axis."""
        return 0.0

    @property
    def ends(self) -> tuple[float, float]:
        """No ends along z: the whole flank is within the drum."""
        return -math.inf, math.inf

    def size(self, along: Along) -> Along:
        """Radius of the roller, mm, at places along it, mm."""
        return self.radius + 0.0 * along

    def leaning(self, axis: Axis[Array], along: Array) -> Leaning:
        """Where the roller touches at places along it, mm: A sin a - z' cos a = side y g, A = along + y' + R g."""
        growth, size = self.spread, self.size(along)
        ahead, lag = along + size * growth + axis.y1, self.side * growth * axis.y
        square = ahead**2 + axis.z1**2
        h = np.sqrt(square - lag**2)
        return Leaning((lag * ahead + axis.z1 * h) / square, (ahead * h - lag * axis.z1) / square, h)

    @property
    def lever(self) -> float:
        """Travel of the roller's axis, mm, for one of the motion."""
        return 1.0

    @property
    def reach(self) -> float:
        """Upper bound of |y| at which the roller touches anything, mm."""
        return self.radius

    @property
    def largest(self) -> float:
        """Greatest radius of the roller, mm, up to the blank's."""
        return self.radius

    @property
    def smallest(self) -> float:
        """Least radius of the roller, mm, from the floor outwards."""
        return self.radius

    @cached_property
    def fastest(self) -> float:
        """How fast F of a point may bend at its worst angle, mm per rad^2."""
        bend = max(float(self.lifts.bends(side).max()) for side in (-1, 1))
        fastest: float = self.outer**2 * self.radius**2 / (self.radius**2 - self.widest**2) ** 1.5 + bend
        return fastest

    def demand_bounded(self) -> None:
        """Raise UnsettledError for a roller of which nothing is bounded: a straight one always is."""

    def by_error(self, error: float) -> float:
        """Travel, mm, by which a flank that is off by an error, mm, moves the roller at most: at its inner end."""
        return error * math.hypot(1.0, self.lifts.steepest / self.inner)

    def by_line(self, error: float, radius: float) -> float:
        """Travel, mm, by which an error, mm, of a line on a cylinder moves the roller at most, if no other holds it."""
        return error * math.hypot(1.0, self.lifts.steepest / radius)

    def line_bend(self, radius: float, climb: float) -> float:  # noqa: ARG002 - how a line climbs changes nothing here
        """How fast F may bend along a line on a cylinder that climbs `climb` mm per rad, mm per rad^2 round it."""
        nearest = math.sqrt(max(radius**2 - self.radius**2, (0.1 * radius) ** 2))
        widest = self.radius * math.sin(math.atan2(self.lifts.steepest, nearest))
        bend: float = radius**2 * self.radius**2 / (self.radius**2 - widest**2) ** 1.5
        return bend

    def off_line(self, worst: Worst, points: Array, radius: float) -> Array:  # noqa: ARG002 - the height says it
        """Distance (n,) of points (n, 3), mm, at their worst angles, from the flank's line unrolled at a radius, mm."""
        # on the cylinder the exact flank rises by the lift's own slope
        off: Array = np.abs(worst.height) / np.hypot(1.0, self.lifts.at(worst.theta)[1] / radius)
        return off

    @cached_property
    def widest(self) -> float:
        """Upper bound of |y| at contact, mm, anywhere from the floor outwards."""
        return self.radius * math.sin(math.atan2(self.lifts.steepest, self.shortest))

    @cached_property
    def shortest(self) -> float:
        """Lower bound of X at contact, mm."""
        return math.sqrt(max(self.floor**2 - self.radius**2, (0.1 * self.floor) ** 2))

    @cached_property
    def _bends(self) -> Array:
        # a peak is where |y| is at most so wide, and F need be concave no farther away
        return self.lifts.bends_near(self.side, math.asin(min(1.0, self.widest / self.floor)))

    def least_bend(self, phi: Array, r: Array) -> Array:
        """Lower bound (n,) of how fast F of points falls on both sides of its peak, mm per rad^2; below 0: unknown."""
        bends: Array = (r * r - 2.0 * self.widest**2) / self.radius - self._bends[self.lifts.part(phi)]
        return bends

    @cached_property
    def _rooms(self) -> Array:
        highest = self.lifts.highest_near(self.side, math.asin(min(1.0, self.radius / self.floor)) + BESIDE)
        return highest + self.side * self.level + self.radius

    def most(self, phi: Array, z: Array) -> Array:
        """Upper bound (n,) of F, mm, of points at polar angles within BESIDE, rad, of phi (n,), at heights z (n,)."""
        most: Array = self._rooms[self.lifts.part(phi)] - self.side * z
        return most

    def beyond(self, place: Place) -> Array:
        """Height (n,), mm, of points over the roller's axis as it passes over them, away from the metal."""
        beyond: Array = self.side * (self.axis(place.phi) - place.z)
        return beyond

    def surface(self, phi: Array, r: Array) -> Array:
        """Height (n,), mm, of the exact flank at polar angles and radii (n,)."""
        points = np.stack([r * np.cos(phi), r * np.sin(phi), np.zeros_like(r)], axis=-1)
        height: Array = self.side * self.worst(points, phi).height
        return height

    def aside(self, theta: Array) -> Array:
        """Place across, y (n,), mm, of the roller's axis at angles (n,), rad."""
        return np.zeros_like(theta)

    def axis(self, theta: Array) -> Array:
        """Height (n,) of the roller's axis at angles (n,), rad."""
        return self.level + self.lifts.at(theta)[0]

    def stand(self, points: Array, theta: Array) -> Stand:
        """How points (n, 3) stand to the roller at angles (n,), rad; F is nan where it does not reach them."""
        lift, slope, _ = self.lifts.at(theta)
        sine, cosine = np.sin(theta), np.cos(theta)
        px, py, pz = points.T
        y, along = py * cosine - px * sine, px * cosine + py * sine
        v = self.side * (self.level + lift - pz)
        with np.errstate(invalid="ignore", divide="ignore"):
            depth = np.sqrt(self.radius**2 - y * y)
            return Stand(v + depth, y * along / depth + self.side * slope, y, along, v)

    def _across(self, points: Sequence[Array], lift: Array, sine: Array, cosine: Array) -> tuple[Array, Array, Array]:
        """y, X and v (n,) of points, three columns (n,), at angles of known sine and cosine."""
        px, py, pz = points
        v = self.side * (self.level + lift - pz)
        return py * cosine - px * sine, px * cosine + py * sine, v

    def near(self, points: Sequence[Array], rows: tuple[Array, Array, Array], sine: Array, cosine: Array) -> Near:
        """Points, three columns (n,), at angles near their worst, with lift, slope and bend there."""
        lift, slope, bend = rows
        y, along, v = self._across(points, lift, sine, cosine)
        slope = self.side * slope
        with np.errstate(invalid="ignore", divide="ignore"):
            depth = np.sqrt(self.radius**2 - y * y)
            rate = y * along / depth + slope
        curve = along**2 - y**2 + slope**2 + v * self.side * bend
        square = y * y + v * v - (v * slope - y * along) ** 2 / np.where(curve > 0.0, curve, np.inf)
        gives = v + depth
        return Near(gives, rate, self._stepped(gives, square), along)

    def held(self, points: Sequence[Array], lift: Array, sine: Array, cosine: Array) -> Held:
        """Points, three columns (n,), at angles with a lift."""
        y, along, v = self._across(points, lift, sine, cosine)
        square = y * y
        with np.errstate(invalid="ignore"):
            gives = v + np.sqrt(self.radius**2 - square)
        return Held(gives, np.sqrt(square + v * v) - self.radius, along)

    def away(self, points: Array, theta: Array) -> Array:
        """Distance (n,), mm, of points (n, 3) from the roller at angles (n,), rad."""
        return self.held(list(points.T), self.lifts.at(theta)[0], np.sin(theta), np.cos(theta)).away

    def bounds(self, across: Array, up: Array, along: Array, least: Array) -> tuple[Array, Array]:  # noqa: ARG002 - a cylinder is the same all along
        """How fast F and the distance may bend over parts of edges (n,), times the squares of their lengths, mm.

        At any of the worst angles between a part's ends these are so far `across`, `up` and `along` from each other;
        `least` is the lesser of their distances from the flank.
        """
        radius = self.radius
        most = self.widest + across
        with np.errstate(invalid="ignore", divide="ignore"):
            bend = across**2 * radius**2 / np.maximum(radius**2 - most**2, 0.0) ** 1.5
        bend = np.where(most < radius, bend, np.inf)
        nearest = np.maximum(radius + least - 0.125 * (across + np.abs(up)), 0.5 * radius)
        return bend, (across**2 + up**2) / nearest

    def close_bounds(
        self,
        ends: Array,  # noqa: ARG002 - those above are close
        theta: Array,  # noqa: ARG002
        sizes: tuple[Array, Array, Array],
        least: Array,
    ) -> tuple[Array, Array]:
        """Bounds as of `bounds`, of parts with ends (n, 2, 3) and worst angles (n, 2); `sizes` as it takes them."""
        return self.bounds(*sizes, least)

    def greatest(self, ends: tuple[Array, Array], shares: tuple[Array, Array], at: tuple[Array, Array, Array]) -> Array:
        """Greatest F (n,) on lines between places (n, 3), between two shares, at lifts, sines and cosines (n,) each.

        It is -inf where the roller reaches nothing of a line.
        """
        share, there = self.best_within(ends, shares, *at)
        points = ends[0] + share[:, None] * (ends[1] - ends[0])
        gives = self.held(list(points.T), *at).gives
        # at the end of its reach the roller's flank is upright, and rounding decides
        v = self._across(list(points.T), *at)[2]
        return np.where(there, np.where(np.isfinite(gives), gives, v), -np.inf)

    def best_within(
        self, ends: tuple[Array, Array], shares: tuple[Array, Array], lift: Array, sine: Array, cosine: Array
    ) -> tuple[Array, Mask]:
        """Share (n,) of lines between places (n, 3) at which F is greatest, between two shares, and if there is one."""
        (y, _, v), (y1, _, v1) = (self._across(list(own.T), lift, sine, cosine) for own in ends)
        return best_share(self.radius, (y, y1), (v, v1), shares)

    def worst(self, points: Array, about: Array | None = None) -> Worst:
        """Points (n, 3) at their worst angles; of points within the roller's reach of the cam's axis nothing is known.

        The distance is good where it is small beside the radius. Where the motion repeats after several turns, the
        angle is sought within half a turn of `about` (n,), rad.
        """
        phi, r = self.polar(points, about), np.hypot(points[:, 0], points[:, 1])
        place = Place(phi, r, points[:, 2])
        bend = self.least_bend(phi, r)
        theta = self._climbed(self._guessed(phi, r), place)
        many = np.flatnonzero((bend <= 0.0) & (r > self.reach))
        if len(many):
            theta[many] = self._sought(place.take(many))
        stand = self.stand(points, theta)
        return Worst(theta, stand.gives, self._distance(theta, stand), np.maximum(bend, 0.0))

    @staticmethod
    def polar(points: Array, about: Array | None = None) -> Array:
        """Polar angles (n,), rad, of points (n, 3), in the turn that brings them nearest to angles `about` (n,)."""
        phi: Array = np.arctan2(points[:, 1], points[:, 0])
        return phi if about is None else phi + TURN * np.round((about - phi) / TURN)

    def peaked(self, points: Array, about: Array | None = None) -> Array:
        """Angles (n,), rad, near a peak of F of points (n, 3), of several near any; `about` (n,) as of `worst`."""
        place = Place(self.polar(points, about), np.hypot(points[:, 0], points[:, 1]), points[:, 2])
        return self._climbed(self._guessed(place.phi, place.r), place)

    def _distance(self, theta: Array, stand: Stand) -> Array:
        """Distance (n,), mm, of points from the flank, into the metal, near angles where F is greatest.

        Where two parts of a flank meet it is that from the part which F finds, no less than from the other.
        """
        # one step of Newton's method on (y^2 + v^2)/2, which the angle of F's peak is close to
        _, slope, bend = self.lifts.at(theta)
        _, _, y, along, v = stand
        rate = -y * along + v * self.side * slope
        curve = along**2 - y**2 + slope**2 + v * self.side * bend
        square = y * y + v * v - np.where(curve > 0.0, rate**2 / np.where(curve > 0.0, curve, 1.0), 0.0)
        return self._stepped(stand.gives, square)

    def _stepped(self, gives: Array, square: Array) -> Array:
        """Distance (n,), mm, of points with F from the flank, by the square of that from the roller's axis.

        A step of Newton's method is too long where a point lies far below the flank. As no flank is steeper than the
        lift at the least X, such a point is so far from it at least.
        """
        distance: Array = np.sqrt(np.maximum(square, 0.0)) - self.radius
        least = -gives / math.hypot(1.0, self.lifts.steepest / self.shortest)
        return np.where(gives < 0.0, np.maximum(distance, least), distance)

    def _guessed(self, phi: Array, r: Array) -> Array:
        """Angle (n,), rad, near a peak of F: where the roller touches with the slope of the lift there."""
        theta = phi
        for _ in range(3):
            slope = self.lifts.at(theta)[1]
            share = self.side * self.radius * slope / (np.hypot(slope, r) * r)
            theta = phi + np.arcsin(np.clip(share, -WITHIN, WITHIN))
        return theta

    def _climbed(self, start: Array, place: Place) -> Array:
        """Angle (n,) of the peak of F near `start`, rad; it does not depend on the height of a point."""
        (phi, r, _), side, radius = place, self.side, self.radius
        theta, open_ = start.copy(), np.arange(len(phi))
        for _ in range(STEPS):
            own, lead = r[open_], phi[open_]
            _, slope, bend = self.lifts.at(theta[open_])
            turn = lead - theta[open_]
            y, along = own * np.sin(turn), own * np.cos(turn)
            most = np.minimum(WITHIN * radius, own)
            y = np.clip(y, -most, most)
            depth = np.sqrt(radius**2 - y * y)
            rate = y * along / depth + side * slope
            fall = (along**2 * radius**2 - (y * depth) ** 2) / depth**3 - side * bend
            step = np.where(fall > 0.0, rate / np.where(fall > 0.0, fall, 1.0), 0.0)
            after = np.arcsin(np.clip(y / own, -1.0, 1.0)) - step
            reach = np.arcsin(np.minimum(WITHIN * radius / own, 1.0))
            moved = lead - np.clip(after, -reach, reach)
            going = np.abs(moved - theta[open_]) > SETTLED
            theta[open_] = moved
            open_ = open_[going]
            if not len(open_):
                break
        return theta

    def _risen(self, theta: Array, place: Place) -> tuple[Array, Array]:
        """F of points at z = 0, and its slope, (n,) each, at angles (n,), rad; -inf out of the roller's reach."""
        (phi, r, _), (lift, slope, _) = place, self.lifts.at(theta)
        y, along = r * np.sin(phi - theta), r * np.cos(phi - theta)
        with np.errstate(invalid="ignore", divide="ignore"):
            depth = np.sqrt(self.radius**2 - y * y)
            gives = self.side * (self.level + lift) + depth
            return np.where(np.isfinite(gives), gives, -np.inf), y * along / depth + self.side * slope

    def _sought(self, place: Place) -> Array:
        """Angle (n,) of the highest peak of F among several, by cells that may still hold it.

        Small cells that may are climbed from, and those about a jump of the velocity are parted on.
        """
        phi, r, _ = place
        reach = np.arcsin(np.minimum(min(1.02 * self.widest, WITHIN * self.reach) / r, 1.0))
        shares = (np.arange(CELLS) + 0.5) / (0.5 * CELLS) - 1.0
        own, half = np.repeat(np.arange(len(phi)), CELLS), np.repeat(reach / CELLS, CELLS)
        theta = (phi[:, None] + reach[:, None] * shares).ravel()
        best, at = np.full(len(phi), -np.inf), phi.copy()

        def reached(own: Indices, theta: Array) -> tuple[Array, Array]:
            value, slope = self._risen(theta, place.take(own))
            np.maximum.at(best, own, value)
            won = np.flatnonzero(value == best[own])
            at[own[won]] = theta[won]
            return value, slope

        while len(own):
            value, slope = reached(own, theta)
            cornered = self._cornered(theta, half)
            with np.errstate(invalid="ignore"):
                bound = value + np.abs(slope) * half + 0.5 * self._curving(theta, half) * half**2
            bound += np.where(cornered, self.lever * self.lifts.jump * half, 0.0)
            there = place.take(own)
            kept = ~(bound <= best[own]) & ~self._unreached(theta, half, there)
            single = ~cornered & self._single(theta, half, there)
            open_ = kept & np.where(cornered, half > NOTHING, ~single & (half > SMALL))
            small = np.flatnonzero(kept & ~open_ & _highest(own, theta, half, (value, slope), single))
            reached(own[small], self._climbed(theta[small], place.take(own[small])))
            # in the order of the angles of each point, so that cells which touch stay neighbours
            own, theta, half = own[open_], theta[open_], half[open_]
            theta = np.stack([theta - 0.5 * half, theta + 0.5 * half], axis=1).ravel()
            own, half = np.repeat(own, 2), np.repeat(0.5 * half, 2)
        return at

    def _unreached(self, theta: Array, half: Array, place: Place) -> Mask:  # noqa: ARG002 - all are within its reach
        """Whether the roller reaches points nowhere in cells (n,) about angles."""
        return np.zeros(len(theta), dtype=np.bool_)

    def _single(self, theta: Array, half: Array, place: Place) -> Mask:  # noqa: ARG002 - small cells alone do here
        """Whether F of points has one peak at most in cells (n,) about angles, beside corners of the lift."""
        return np.zeros(len(theta), dtype=np.bool_)

    def _curving(self, theta: Array, half: Array) -> Array:
        """Upper bound (n,) of the second derivative of F over cells about angles, beside corners of the lift."""
        bends = widened(self._own_bends, float(half.max(initial=0.0)))
        return np.maximum(bends + self._hollow, 0.0)[self.lifts.part(theta)]

    @cached_property
    def _own_bends(self) -> Array:
        return self.lever * self.lifts.bends(self.side)

    @cached_property
    def _hollow(self) -> float:
        """Upper bound of the second derivative of sqrt(R^2 - y^2), mm per rad^2: 0 as long as |y| < X."""
        if self.shortest > self.widest:
            return 0.0
        return self.widest**2 / math.sqrt(self.radius**2 - self.widest**2)

    def _cornered(self, theta: Array, half: Array) -> Mask:
        held = np.zeros(len(theta), dtype=np.bool_)
        period = self.lifts.period
        for corner in self.lifts.corners:
            held |= np.abs((theta - corner + 0.5 * period) % period - 0.5 * period) <= half
        return held


def _highest(own: Indices, theta: Array, half: Array, found: tuple[Array, Array], single: Mask) -> Mask:
    """Cells (n,) that may hold the peak of the run of cells that they are in; a cell that is not `single` is a run.

    Cells are those of points `own` (n,) about angles, rising for each point, with F and its slope in `found`. In a run
    of cells that touch, each with one peak at most and level nowhere else, F rises towards one peak: that is in the
    cell whose middle is highest, or in the next one uphill.
    """
    value, slope = found
    sound = single & np.isfinite(value)
    joined = sound[1:] & sound[:-1] & (own[1:] == own[:-1]) & (theta[1:] - theta[:-1] < 3.0 * half[1:])
    heads = np.flatnonzero(np.concatenate([[True], ~joined]))
    run = np.cumsum(np.concatenate([[0], ~joined]))
    highest: Mask = value >= np.maximum.reduceat(value, heads)[run]
    uphill = highest.copy()
    uphill[1:] |= joined & highest[:-1] & (slope[:-1] >= 0.0)
    uphill[:-1] |= joined & highest[1:] & (slope[1:] <= 0.0)
    return uphill


def best_share(
    radius: float, y: tuple[Array, Array], v: tuple[Array, Array], shares: tuple[Array, Array]
) -> tuple[Array, Mask]:
    """Share (n,) of segments at which F is greatest, from the first to the last of two shares of each, and if any is.

    A segment goes from y[0], v[0] to y[1], v[1], (n,) each. On it F = v + sqrt(R^2 - y^2) is greatest at one of its
    ends or where y = R dv/hypot(dy, dv), with the sign of dy.
    """
    dy, dv = y[1] - y[0], v[1] - v[0]
    low, high = shares
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = [(sense * radius - y[0]) / dy for sense in (-1.0, 1.0)]
        flat = dy == 0.0
        low = np.where(flat, low, np.maximum(low, np.minimum(*reach)))
        high = np.where(flat, high, np.minimum(high, np.maximum(*reach)))
        there = (low <= high) & (~flat | (np.abs(y[0]) <= radius))
        best = (radius * dv * np.sign(dy) / np.hypot(dy, dv) - y[0]) / dy
        best = np.where(flat, np.where(dv > 0.0, high, low), best)
    return np.clip(best, low, high), there
