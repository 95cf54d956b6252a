"""A roller that any guide leads, a cylinder or a cone, without ends on one flank of a drum.

Of a point at y across the roller's axis, X along it and the height z, F is how far the roller has to give way, mm along
the path of its axis: that between its place and the one at which it touches the point (`kin.turned.guide`). While
the shaft turns by d theta the point moves by (-X d theta, 0) across, so that with a, n, T and u as they stand there

    F' = side lever S' + (X n_y + y g)/cos a
    F'' = side lever S'' - ((t^2 + R bend (n.e) u^2)/R - y n_y + X g)/cos a,    t = (X T_z + y g (n x T))/cos a

where the roller's radius grows by g along it. Along a straight edge, seen at one angle, what moves by p across and up
and by x along has F'' = -(t^2 + R bend (n.e) u^2)/(R cos a), t = (p x T - g x (n x T))/cos a. The distance from the
flank is the least of (hypot(y - y_0, z - z_0) - R) cos delta over theta.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.lifts import widened
from kin.cylindrical.roller import BESIDE, WITHIN, Gauge, Held, Near, Place, Stand
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.roller import Along, Worst
    from kin.numeric.arrays import Array, Mask
    from kin.turned.guide import Axis, Guide, Touch

OFF = 0.1  # of the roller's radius: bounds hold for points that are no farther from the flank
UPRIGHT = 1.5  # rad: no bound is had where normals may lean more against the roller's path
GUESSES = 4
ROOM, LOOKS = 1.5, 17  # of a radius to both sides of the axis, and points of a line there, where a line may be touched
STEPS, SETTLED = 16, 1e-10  # of Newton's method, and the step, rad, after which the next would be rounding
ABOUT = 65  # angles about a point, at which rollers are looked at
LEVEL = 1e-9  # mm: steps of a height below this end them
FLOOR = 0.1  # of a radius: X at contact is looked at no nearer to the axis


class _Over(NamedTuple):
    """Bounds of the guide over the law's cells (m,): y0, mm, T across and up, and the slope times the lever, mm."""

    aside: tuple[Array, Array]
    ty: tuple[Array, Array]
    tz: tuple[Array, Array]
    slope: tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class LedGauge(Gauge):
    """A roller led by a guide, on a flank; it has its `radius` at the place `at` and grows by `growth` along its axis.

    guide  what leads its axis
    rim    radius of the blank, mm, which no contact is beyond
    """

    guide: Guide
    growth: float
    at: float
    rim: float

    def demand_bounded(self) -> None:
        """Raise UnsettledError for a roller that goes so far aside, or leans so much, that nothing of it is bounded."""
        if self.reach >= self.floor:
            raise UnsettledError(
                f"the roller reaches {self.reach:.6g} mm aside, and the flank {self.floor:.6g} mm inwards"
            )
        if self._lean >= UPRIGHT:
            raise UnsettledError("somewhere the flank's normal may be square to the roller's path")

    def size(self, along: Along) -> Along:
        """Radius of the roller, mm, at places along it, mm."""
        return self.radius + (along - self.at) * self.growth

    @property
    def led(self) -> Guide:
        """What leads the roller's axis."""
        return self.guide

    @property
    def spread(self) -> float:
        """How fast the roller's radius grows along its axis."""
        return self.growth

    @property
    def lever(self) -> float:
        """Travel of the roller's axis, mm, for one of the motion."""
        return self.guide.lever

    @cached_property
    def _upright(self) -> float:
        """Cosine of the taper: a distance square to the axis is so much longer than one from the cone."""
        return 1.0 / math.hypot(1.0, self.growth)

    # --- bounds over all shaft angles ---------------------------------------------------------------------------------

    @cached_property
    def _over(self) -> _Over:
        low, high = self.lifts.enclosed
        more = OFF * self.radius / self.guide.lever * (self.guide.bend > 0.0)
        aside, ty, tz = self.guide.enclosed(low[0] - more, high[0] + more)
        return _Over(aside, ty, tz, (self.guide.lever * low[1], self.guide.lever * high[1]))

    @cached_property
    def _aside(self) -> float:
        return float(max(np.abs(own).max() for own in self._over.aside))

    @cached_property
    def largest(self) -> float:
        """Greatest radius of the roller, mm, up to the rim."""
        return float(self.size(max(self.rim, self.outer)))

    @cached_property
    def smallest(self) -> float:
        """Least radius of the roller, mm, from the floor outwards."""
        return float(self.size(self.shortest))

    @cached_property
    def reach(self) -> float:
        """Upper bound of |y| at which the roller touches anything, mm."""
        return self._aside + self.largest

    @cached_property
    def shortest(self) -> float:
        """Lower bound of X at contact, mm."""
        return self._nearest(self.floor)

    def _leaning(self, along: float) -> tuple[float, float]:
        """Upper bounds, rad, of how much normals of contact lean against the path, and against z, from X on, mm."""
        over = self._over
        if float(over.tz[0].min()) <= 0.0:
            return math.pi, math.pi
        near, far = along + self.growth * self.size(along), self.rim + self.growth * self.largest
        slope, ty, tz = over.slope, over.ty, over.tz
        steep = [own / (x * up) for own in slope for x in (near, far) for up in tz]
        most = max(
            float((np.maximum.reduce(steep) + np.maximum(ty[1] / tz[0], ty[1] / tz[1])).max()),
            float(-(np.minimum.reduce(steep) + np.minimum(ty[0] / tz[0], ty[0] / tz[1])).min()),
        )
        shifts = np.minimum.reduce([own * each for own in slope for each in ty])
        reach = near + shifts
        if float(reach.min()) <= 0.0:
            return math.pi, math.pi
        rise = float((np.maximum(np.abs(slope[0]), np.abs(slope[1])) * tz[1] / reach).max())
        coned = math.asin(min(1.0, self._aside * self.growth / (near * float(tz[0].min()))))
        return math.atan(most) + coned, math.atan(rise) + coned

    @cached_property
    def _lean(self) -> float:
        return self._leaning(self.shortest)[0]

    @cached_property
    def _least_cosine(self) -> float:
        return max(math.cos(min(self._lean, UPRIGHT)), 0.0)

    @cached_property
    def widest(self) -> float:
        """Upper bound of |y| at contact, mm, anywhere from the floor outwards."""
        return self._aside + self.largest * math.sin(min(self._leaning(self.shortest)[1], 0.5 * math.pi))

    @cached_property
    def _sideways(self) -> float:
        """Upper bound of |n_y| at contact."""
        return math.sin(min(self._leaning(self.shortest)[1], 0.5 * math.pi))

    @cached_property
    def _bent(self) -> float:
        """Upper bound of lever |S''|, mm per rad^2."""
        return self.lever * max(float(self.lifts.bends(side).max()) for side in (-1, 1))

    @cached_property
    def _turns(self) -> float:
        """Upper bound of how far T turns against the point, per rad of the shaft."""
        return 1.0 + self.lifts.steepest * self.lever * self.guide.bend

    @cached_property
    def fastest(self) -> float:
        """How fast F of a point may bend at its worst angle, mm per rad^2."""
        sine, cosine = math.sin(self._lean), self._least_cosine
        far = max(self.outer, self.rim)
        t = (far + self.widest * self.growth * sine) / cosine
        u = (far * self._sideways + self.widest * self.growth) / cosine
        fall = t**2 / self.smallest + self.guide.bend * sine * u**2 + self.widest * self._sideways + far * self.growth
        return fall / cosine + self._bent

    def by_error(self, error: float) -> float:
        """Travel, mm, by which a flank that is off by an error, mm, moves the roller at most: at its inner end."""
        return error / (self._upright * max(math.cos(min(self._leaning(self.inner)[0], UPRIGHT)), 1e-9))

    def by_line(self, error: float, radius: float) -> float:
        """Travel, mm, by which an error, mm, of a line on a cylinder moves the roller at most, if no other holds it."""
        return error / (self._upright * max(math.cos(min(self._leaning(self._nearest(radius))[0], UPRIGHT)), 1e-9))

    def _nearest(self, radius: float) -> float:
        """Lower bound of X, mm, at which a cylinder is touched."""
        return math.sqrt(max(radius**2 - self.reach**2, (FLOOR * radius) ** 2))

    def line_bend(self, radius: float, climb: float) -> float:
        """How fast F may bend along a line on a cylinder that climbs `climb` mm per rad, mm per rad^2 round it."""
        lean, across = self._leaning(self._nearest(radius))
        sine, cosine = math.sin(min(lean, UPRIGHT)), max(math.cos(min(lean, UPRIGHT)), 1e-9)
        t = u = math.hypot(radius, climb) + self.growth * radius
        bend = (t**2 / self.smallest + self.guide.bend * sine * u**2) / cosine**3
        return bend + (self.reach * math.sin(min(across, 0.5 * math.pi)) + radius * self.growth) / cosine

    def off_line(self, worst: Worst, points: Array, radius: float) -> Array:
        """Distance (n,) of points (n, 3), mm, at their worst angles, from the flank's line unrolled at a radius, mm."""
        lift = self.lifts.at(worst.theta)[0]
        y, along, touch = self._touch(list(points.T), lift, np.sin(worst.theta), np.cos(worst.theta))
        # the part of the flank's normal that lies in the cylinder
        round_ = (self.growth * y + touch.ny * along) / radius
        off: Array = np.abs(worst.distance) / (self._upright * np.hypot(round_, touch.nz))
        return off

    @cached_property
    def _bends(self) -> Array:
        reach = math.asin(min(1.0, self.widest / self.floor))
        return self.lever * self.lifts.bends_near(self.side, reach)

    def least_bend(self, phi: Array, r: Array) -> Array:
        """Lower bound (n,) of how fast F of points falls on both sides of its peak, mm per rad^2; below 0: unknown."""
        bends: Array = self._falling(r) - self._bends[self.lifts.part(phi)]
        return bends

    def _falling(self, r: Array) -> Array:
        """Lower bound (n,) of how fast F of points falls about its peak, mm per rad^2, without the lift's own bend."""
        sine, cosine = math.sin(min(self._lean, UPRIGHT)), self._least_cosine
        along = np.sqrt(np.maximum(r * r - self.widest**2, 0.0))
        t = np.maximum(along * float(self._over.tz[0].min()) - self.widest * self.growth * sine, 0.0)
        u = r * self._sideways + self.widest * self.growth
        fall = t**2 / self.size(r) - self.guide.bend * sine * u**2
        # F bends by fall/cos^3 - lost/cos of the lean, which is least without any where fall is not small
        lost = self.widest * self._sideways
        least = np.where(fall > 0.0, fall, fall / cosine**3) - lost / cosine
        fall = np.where(3.0 * fall > lost, fall - lost, least)
        falling: Array = fall + along * self.growth
        return falling

    def _unreached(self, theta: Array, half: Array, place: Place) -> Mask:
        """Whether the roller reaches points nowhere in cells (n,) about angles."""
        turn = place.phi - theta
        beyond = self.guide.beyond((place.r * np.sin(turn), place.z), self.size(place.r * np.cos(turn)))
        unreached: Mask = beyond > place.r * math.hypot(1.0, self.growth) * half
        return unreached

    def _single(self, theta: Array, half: Array, place: Place) -> Mask:
        """Whether F of points has one peak at most in cells (n,) about angles, beside corners of the lift."""
        bends = widened(self._own_bends, float(half.max(initial=0.0)))
        single: Mask = self._falling(place.r) > bends[self.lifts.part(theta)]
        return single

    @cached_property
    def _hollow(self) -> float:
        """Upper bound of the second derivative of F without that of the lift, mm per rad^2."""
        t = self.shortest * float(self._over.tz[0].min()) - self.reach * self.growth
        lost = self.reach + self.guide.bend * (self.rim + self.reach * self.growth) ** 2
        if t > 0.0 and t**2 / self.largest > lost:
            return 0.0
        return lost / max(math.sqrt(1.0 - WITHIN**2), self._least_cosine) ** 3

    # --- points -------------------------------------------------------------------------------------------------------

    @cached_property
    def _rooms(self) -> Array:
        reach = math.asin(min(1.0, self.reach / self.floor)) + BESIDE
        highest = self.side * self.lifts.highest_near(self.side, reach)
        up = self.guide.axis(highest, np.zeros_like(highest), np.zeros_like(highest)).z
        rooms: Array = self.side * up + self.largest
        return rooms

    def _axis(self, theta: Array) -> Axis[Array]:
        return self.guide.axis(*self.lifts.at(theta))

    def aside(self, theta: Array) -> Array:
        """Place across, y (n,), mm, of the roller's axis at angles (n,), rad."""
        return self._axis(theta).y

    def axis(self, theta: Array) -> Array:
        """Height (n,) of the roller's axis at angles (n,), rad."""
        height: Array = self._axis(theta).z
        return height

    def beyond(self, place: Place) -> Array:
        """Height (n,), mm, of points over the roller's axis as it passes over them, away from the metal."""
        theta = place.phi
        for _ in range(GUESSES):
            axis = self._axis(theta)
            theta = place.phi - np.arcsin(np.clip(axis.y / np.maximum(place.r, 1e-300), -1.0, 1.0))
        beyond: Array = self.side * (axis.z - place.z)
        return beyond

    def surface(self, phi: Array, r: Array) -> Array:
        """Height (n,), mm, of the exact flank at polar angles and radii (n,)."""
        x, y = r * np.cos(phi), r * np.sin(phi)
        theta, z = self._guessed(phi, r), np.full(len(r), np.nan)
        # the rollers that touch near the flank touch it near there: each step squares what the height is off
        for step in range(3 * GUESSES):
            axis = self._axis(theta)
            along, across = x * np.cos(theta) + y * np.sin(theta), y * np.cos(theta) - x * np.sin(theta) - axis.y
            size = self.size(along)
            before, z = z, axis.z + self.side * np.sqrt(np.maximum(size * size - across * across, 0.0))
            if float(np.abs(z - before).max(initial=0.0)) <= LEVEL:
                break
            if step == 0:
                theta = self.worst(np.stack([x, y, z], axis=-1), phi).theta
            else:
                theta = self._climbed(theta, Place(phi, r, z))
        return z

    def _touch(self, points: Sequence[Array], lift: Array, sine: Array, cosine: Array) -> tuple[Array, Array, Touch]:
        px, py, pz = points
        y, along = py * cosine - px * sine, px * cosine + py * sine
        return y, along, self.guide.touching((y, pz), lift, self.size(along), self.side)

    def _rate(self, y: Array, along: Array, touch: Touch, slope: Array) -> tuple[Array, Array]:
        """F' and cos a (n,) of points where the roller touches them."""
        cosine = self.side * (touch.ny * touch.ty + touch.nz * touch.tz)
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.side * self.lever * slope + (along * touch.ny + y * self.growth) / cosine, cosine

    def near(self, points: Sequence[Array], rows: tuple[Array, Array, Array], sine: Array, cosine: Array) -> Near:
        """Points, three columns (n,), at angles near their worst, with lift, slope and bend there."""
        y, along, touch = self._touch(points, rows[0], sine, cosine)
        rate = self._rate(y, along, touch, rows[1])[0]
        return Near(touch.gives, rate, self._least_away(y, along, points[2], self.guide.axis(*rows)), along)

    def _least_away(self, y: Array, along: Array, z: Array, axis: Axis[Array]) -> Array:
        """Distance (n,), mm, of points from the flank, close to their worst angles, by a step of Newton's method."""
        across, up = y - axis.y, z - axis.z
        moved, risen = -along - axis.y1, -axis.z1
        far = np.hypot(across, up)
        rate = (across * moved + up * risen) / far
        curve = (moved**2 + risen**2 - across * (y + axis.y2) - up * axis.z2 - rate**2) / far + along * self.growth
        rate -= y * self.growth
        off = far - self.size(along) - 0.5 * rate**2 / np.where(curve > 0.0, curve, np.inf)
        distance: Array = off * self._upright
        return distance

    def held(self, points: Sequence[Array], lift: Array, sine: Array, cosine: Array) -> Held:
        """Points, three columns (n,), at angles with a lift."""
        y, along, touch = self._touch(points, lift, sine, cosine)
        still = np.zeros_like(lift)
        axis = self.guide.axis(lift, still, still)
        away = (np.hypot(y - axis.y, points[2] - axis.z) - self.size(along)) * self._upright
        return Held(touch.gives, away, along)

    def stand(self, points: Array, theta: Array) -> Stand:
        """How points (n, 3) stand to the roller at angles (n,), rad; F is nan where it does not reach them."""
        lift, slope, _ = self.lifts.at(theta)
        y, along, touch = self._touch(list(points.T), lift, np.sin(theta), np.cos(theta))
        return Stand(
            touch.gives, self._rate(y, along, touch, slope)[0], y, along, self.side * (self.axis(theta) - points[:, 2])
        )

    def worst(self, points: Array, about: Array | None = None) -> Worst:
        """Points (n, 3) at their worst angles; the height is -inf where an arm is too short to touch them."""
        found = super().worst(points, about)
        return found._replace(height=np.where(np.isnan(found.height), -np.inf, found.height))

    def _distance(self, theta: Array, stand: Stand) -> Array:
        axis = self._axis(theta)
        return self._least_away(stand.y, stand.along, axis.z - self.side * stand.v, axis)

    def _guessed(self, phi: Array, r: Array) -> Array:
        """Angle (n,), rad, near a peak of F: where the roller touches at the radius of the point."""
        theta, size = phi, self.size(r)
        for _ in range(GUESSES):
            axis = self._axis(theta)
            along = r + size * self.growth + axis.y1
            lean = np.arctan2(axis.z1, along) + self.side * axis.y * self.growth / np.maximum(along, 1e-300)
            share = (axis.y - self.side * size * np.sin(lean)) / np.maximum(r, 1e-300)
            theta = phi - np.arcsin(np.clip(share, -WITHIN, WITHIN))
        return theta

    def _climbed(self, start: Array, place: Place) -> Array:
        """Angle (n,) of the peak of F near `start`, rad."""
        theta, open_ = start.copy(), np.arange(len(start))
        for _ in range(STEPS):
            phi, r, z = place.take(open_)
            lift, slope, bend = self.lifts.at(theta[open_])
            turn = phi - theta[open_]
            y, along = r * np.sin(turn), r * np.cos(turn)
            size = self.size(along)
            touch = self.guide.touching((y, z), lift, size, self.side)
            rate, cosine = self._rate(y, along, touch, slope)
            u = -self.side * (along * touch.ny + y * self.growth) / cosine
            t = (along + u * touch.ty) ** 2 + (u * touch.tz) ** 2 - (y * self.growth) ** 2
            lean = self.guide.sense * (touch.nz * touch.ty - touch.ny * touch.tz)
            fall = (t / size + self.guide.bend * lean * u * u - y * touch.ny + along * self.growth) / cosine
            fall -= self.side * self.lever * bend
            step = np.where(fall > 0.0, rate / np.where(fall > 0.0, fall, 1.0), 0.0)
            # it stays within the roller's reach; where that is lost, it goes to the axis
            axis = self.guide.axis(lift, slope, bend)
            most = WITHIN * size
            step = np.where(np.isfinite(step), step, (y - axis.y) / np.maximum(along, size))
            after = np.clip(y - axis.y - along * step, -most, most) + axis.y
            moved = phi - np.arcsin(np.clip(after / np.maximum(r, 1e-300), -1.0, 1.0))
            small = np.abs(step) * along < 0.1 * size
            moved = np.where(small & (np.abs(y - axis.y - along * step) < most), theta[open_] + step, moved)
            going = np.abs(moved - theta[open_]) > SETTLED
            theta[open_] = moved
            open_ = open_[going]
            if not len(open_):
                break
        return theta

    def _risen(self, theta: Array, place: Place) -> tuple[Array, Array]:
        """F of points and its slope, (n,) each, at angles (n,), rad; -inf out of the roller's reach."""
        points = np.stack([place.r * np.cos(place.phi), place.r * np.sin(place.phi), place.z], axis=-1)
        stand = self.stand(points, theta)
        return np.where(np.isfinite(stand.gives), stand.gives, -np.inf), stand.slope

    # --- edges --------------------------------------------------------------------------------------------------------

    def bounds(self, across: Array, up: Array, along: Array, least: Array) -> tuple[Array, Array]:
        """How fast F and the distance may bend over parts of edges (n,), times the squares of their lengths, mm."""
        up = np.abs(up)
        sideways = float(max(np.abs(own).max() for own in self._over.ty))
        p, more = across + up * sideways, along * self.growth
        lean = self._lean + 1.5 * (p + 2.0 * more) / (self._least_cosine * self.smallest)
        sine, cosine = np.sin(np.minimum(lean, UPRIGHT)), np.cos(np.minimum(lean, UPRIGHT))
        bend = self._bend(p + more * sine, across * sideways + up + p * sine + more, (sine, cosine), self.smallest)
        return np.where(lean < UPRIGHT, bend, np.inf), self._round(across, up, least)

    def _bend(self, t: Array, u: Array, lean: tuple[Array, Array], size: Array | float) -> Array:
        """How fast F may bend, for what is moved by `t` and `u` times cos a, by sine and cosine of the greatest a."""
        sine, cosine = lean
        with np.errstate(invalid="ignore", divide="ignore"):
            bend: Array = (t**2 / size + self.guide.bend * sine * u**2) / cosine**3
        return bend

    def _round(self, across: Array, up: Array, least: Array) -> Array:
        nearest = np.maximum(self.smallest + least - 0.125 * (across + up), 0.5 * self.smallest)
        bend: Array = (across**2 + up**2) / nearest
        return bend

    def close_bounds(
        self, ends: Array, theta: Array, sizes: tuple[Array, Array, Array], least: Array
    ) -> tuple[Array, Array]:
        """Bounds as of `bounds`, of parts with ends (n, 2, 3) and worst angles (n, 2); `sizes` as it takes them."""
        across, up, along = sizes[0], np.abs(sizes[1]), sizes[2]
        way = ends[:, 1] - ends[:, 0]
        length = np.hypot(across, up)
        half = 0.5 * self.lifts.period
        turned = np.abs(np.remainder(theta[:, 1] - theta[:, 0] + half, 2.0 * half) - half)
        worst = np.zeros(len(ends))
        for k in (0, 1):
            sine, cosine = np.sin(theta[:, k]), np.cos(theta[:, k])
            lift = self.lifts.at(theta[:, k])[0]
            _, place, touch = self._touch(list(ends[:, k].T), lift, sine, cosine)
            dy, dx, dz = way[:, 1] * cosine - way[:, 0] * sine, way[:, 0] * cosine + way[:, 1] * sine, way[:, 2]
            leaning = np.abs(touch.ny * touch.tz - touch.nz * touch.ty)
            upright = self.side * (touch.ny * touch.ty + touch.nz * touch.tz)
            more = np.abs(dx) + along * self._turns * turned
            grown = more * self.growth
            size = np.minimum(self.size(place), self.size(place + dx)) - grown * turned
            t = np.abs(dy * touch.tz - dz * touch.ty - self.growth * dx * (touch.ny * touch.tz - touch.nz * touch.ty))
            # by how much normals may turn: with the shaft, along the roller, and at one angle along the part
            with np.errstate(invalid="ignore", divide="ignore"):
                shaft = (self._turns + self._normals) * turned
                margin = shaft + more / self.shortest + (t / upright + grown) / (size * upright)
                t += length * self._turns * turned + grown * margin
                u = np.abs(dy * touch.ty + dz * touch.tz) * upright + t + length * margin + grown
                lean = np.minimum(leaning + margin, 1.0), upright - margin
                bend = self._bend(t, u, lean, size)
            worst = np.maximum(worst, np.where((lean[1] > 0.05) & (size > 0.0), bend, np.inf))
        stuck = np.flatnonzero(worst == np.inf)
        worst[stuck[self._deep(ends[stuck, 0], theta[stuck, 0]) > np.hypot(length, along)[stuck]]] = 0.0
        return worst, self._round(across, up, least)

    def _deep(self, points: Array, about: Array) -> Array:
        """Lower bound (n,) of the distance, mm, of points (n, 3) from all rollers: deep ones are in no roller's way."""
        r, phi = np.hypot(points[:, 0], points[:, 1]), self.polar(points, about)
        reach = np.arcsin(np.minimum(self.reach / np.maximum(r, self.reach), 1.0))
        deep = np.full(len(r), np.inf)
        for share in np.linspace(-1.0, 1.0, ABOUT):
            deep = np.minimum(deep, self.away(points, phi + share * reach))
        fast = self.rim + self.lever * self.lifts.steepest
        deeper: Array = deep - fast * reach / (ABOUT - 1)
        return deeper

    @cached_property
    def _normals(self) -> float:
        """Upper bound of how far a normal of contact turns, per rad of the shaft."""
        slope = self.lever * self.lifts.steepest
        along = self.shortest * self._least_cosine
        return (self._bent + slope**2 * self.guide.bend + self.growth * slope) / along

    def greatest(self, ends: tuple[Array, Array], shares: tuple[Array, Array], at: tuple[Array, Array, Array]) -> Array:
        """Greatest F (n,) on lines between places (n, 3), between two shares, at lifts, sines and cosines (n,) each.

        It is -inf where the roller reaches nothing of a line. Along a line F is all but a parabola, whose peak Newton's
        method finds from the best of some points.
        """
        (lift, sine, cosine), way = at, ends[1] - ends[0]
        still = np.zeros_like(lift)
        axis = self.guide.axis(lift, still, still)
        start = ends[0][:, 1] * cosine - ends[0][:, 0] * sine - axis.y
        dy, dx, dz = way[:, 1] * cosine - way[:, 0] * sine, way[:, 0] * cosine + way[:, 1] * sine, way[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = [(sense * ROOM * self.largest - start) / dy for sense in (-1.0, 1.0)]
        level = dy == 0.0
        low = np.where(level, shares[0], np.maximum(shares[0], np.minimum(*reach)))
        high = np.where(level, shares[1], np.minimum(shares[1], np.maximum(*reach)))

        def looked(share: Array) -> tuple[Array, Array]:
            """F at shares of the lines, and the step to where it is level."""
            points = ends[0] + share[:, None] * way
            _, place, touch = self._touch(list(points.T), lift, sine, cosine)
            with np.errstate(divide="ignore", invalid="ignore"):
                upright = self.side * (touch.ny * touch.ty + touch.nz * touch.tz)
                slope = -(dy * touch.ny + dz * touch.nz - self.growth * dx) / upright
                u, size = -self.side * slope, self.size(place)
                t = (dy - u * touch.ty) ** 2 + (dz - u * touch.tz) ** 2 - (self.growth * dx) ** 2
                lean = self.guide.sense * (touch.nz * touch.ty - touch.ny * touch.tz)
                step = slope * size * upright / (t + size * self.guide.bend * lean * u * u)
            return np.where(np.isfinite(touch.gives), touch.gives, -np.inf), step

        best, share = np.full(len(lift), -np.inf), low
        for part in np.linspace(0.0, 1.0, LOOKS):
            own = low + part * (high - low)
            gives = looked(own)[0]
            share = np.where(gives > best, own, share)
            best = np.maximum(best, gives)
        for _ in range(GUESSES):
            step = looked(share)[1]
            share = np.clip(share + np.where(np.isfinite(step), step, 0.0), low, np.maximum(low, high))
        return np.where(low <= high, np.maximum(best, looked(share)[0]), -np.inf)

    def best_within(
        self, ends: tuple[Array, Array], shares: tuple[Array, Array], lift: Array, sine: Array, cosine: Array
    ) -> tuple[Array, Mask]:
        """Share (n,) of lines between places (n, 3) at which F is greatest, between two shares, and if it is anywhere.

        It is that of the parabola through both ends and the middle, or the best of these.
        """
        low, high = shares
        at = [low, 0.5 * (low + high), high]
        values = []
        for share in at:
            points = ends[0] + share[:, None] * (ends[1] - ends[0])
            gives = self.held(list(points.T), lift, sine, cosine).gives
            values.append(np.where(np.isfinite(gives), gives, -np.inf))
        with np.errstate(invalid="ignore", divide="ignore"):
            hollow = values[0] - 2.0 * values[1] + values[2]
            vertex = 0.25 * (values[0] - values[2]) / hollow + 0.5
        inner = (hollow < 0.0) & (vertex > 0.0) & (vertex < 1.0)
        best = np.argmax(np.stack(values), axis=0)
        share = np.where(inner, low + np.where(inner, vertex, 0.0) * (high - low), np.choose(best, at))
        return share, (low <= high) & (np.maximum.reduce(values) > -np.inf)
