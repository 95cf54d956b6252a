"""The two forms of indexing cams: where a point is in a turret's axes, and how far it is from a roller's axis.

Lengths are in mm, angles in radians. z is the cam's axis, and heights are over the turret's centre. The cam stands
still and the turret runs round it by the shaft angle theta, counter-clockwise seen from +z. e_r and e_t are the
directions of the radius and of the turning at theta. A point is at x along e_r, at y along e_t, and at a height z.

The turret's plane is square to the turret's axis. In it the point has the coordinates (u, v), in which a roller at the
angle psi is in the direction (cos psi, sin psi). s is the point's distance from the turret's axis, and d its polar
angle in that plane less psi.

`depth_of` counts the layers of both forms alike: 0 on the blank and growing into the metal, to `depth` on the floor.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

import numpy as np

from kin.numeric.records import dataclass
from kin.turned.guide import Swing

if TYPE_CHECKING:
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array

STEPS = 6  # of Newton's method
NEAR = 1e-9  # mm, to which it leads


class Form(Protocol):
    """Protocol of a form of cam, barrel or globoid; arrays are (n,) unless said otherwise, mm and rad."""

    @property
    def radius(self) -> float:
        """Radius of the blank, mm; of a globoid that of its throat."""

    @property
    def depth(self) -> float:
        """Depth of the track below the blank, mm."""

    @property
    def lever(self) -> float:
        """Distance from the turret's axis at which a flank carries at most, mm."""

    @property
    def inwards(self) -> int:
        """1 where the depth rises with the place along a roller, -1 where it falls."""

    def developed(self, radius: float) -> float:
        """Depth of the cylinder of a radius, mm; raises ValueError for a form whose layers are no cylinders."""

    def guide(self, height: float, start: float) -> Swing:
        """The turret as an arm that leads a roller from the angle `start`, rad; its centre is at `height`, mm.

        Raises ValueError for rollers that do not keep their direction.
        """

    def demand(self, stops: int, roller: float, ends: tuple[float, float]) -> None:
        """Raise ValueError for a turret that such a form cannot have; `ends` are the heights of both faces."""

    def depth_of(self, r: Array, z: Array) -> Array:
        """Depth below the blank of points at a distance r from the cam's axis and a height z."""

    def rims(self, depth: float, z: Array) -> Array:
        """Distance from the cam's axis of the layer of a depth, at heights z."""

    def plane(self, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
        """Coordinates u, v in the turret's plane."""

    def beside(self, y: Array, u: Array, v: Array, psi: Array) -> tuple[Array, Array]:
        """Place of a point beside a roller's axis at the angle psi, in two coordinates square to it, mm."""

    def touch(self, s: Array, y: Array, radius: Array) -> Array:
        """Angle |d| at which a roller of a radius touches the point; nan where it passes by."""

    def slope(self, s: Array, d: Array) -> Array:
        """Derivative of the squared distance by |d|."""

    def along(self, x: Array, s: Array, d: Array) -> Array:
        """Place of the point along the roller's axis, as the roller's ends are given."""

    def across(self, way: Array, sine: Array, cosine: Array, psi: Array) -> Array:
        """Squared lengths of ways (n, 3) square to an axis at the angle psi, at theta by its sine and cosine."""

    def turning(self, slope: float) -> float:
        """How fast an axis turns at most, per rad of theta, with so fast a turret."""

    def window(self, r: Array, z: Array, reach: float) -> tuple[Array, Array]:
        """Least and greatest polar angle less theta at which an axis may come within reach."""

    def bends(self, slope: Array, curve: Array, near: tuple[float, float, float]) -> Array:
        """Upper bounds of the second derivative of the squared distance by theta, over steps of it.

        `near` is the reach, mm, within which an axis comes in a step, the step, rad, and the greatest r of a point, mm.
        """

    def costs(self, rho: Array, turret: tuple[Array, Array], radius: float) -> tuple[Array, Array, Array]:
        """What an error of 1 mm at places along rollers costs, rad, and the depth and the height at which they touch.

        `turret` is a roller's angle and its slope, `radius` that of the roller, below 0 for what it touches below it.
        """

    def depth_at(self, place: float) -> float:
        """Depth of the layer that a roller reaches at a place along it, if it is level and on a radius of the cam."""

    def deepest(self, place: float, radius: float) -> float:
        """Depth of the deepest place of the flat end of a roller of a radius, at a place along it."""

    def bent(self, ways: Array, places: Array) -> tuple[Array, Array]:
        """How far the depth may be above and below that of a plane, mm (t,), on triangles.

        `ways` are their sides, (3, t, 3), and `places` (t, 3) their middles, heights over the turret's centre.
        """

    def swept(self, depth: Array, ahead: Array, psi: Array, reach: tuple[float, int]) -> Array:
        """Height at which a roller at an angle psi leaves a layer at a polar angle that is `ahead` of its own.

        `reach` is the roller's radius and the side, 1 above it. Heights are mm, of a globoid angles about the turret's
        axis; nan where the roller does not meet the layer there.
        """

    def faces(self, depth: Array, ends: tuple[float, float]) -> tuple[Array, Array]:
        """Heights, as `swept` has them, of both faces in layers."""

    def measure(self, depth: Array, height: Array) -> Array:
        """Antiderivative by the height of volume per depth and polar angle."""

    def core(self, ends: tuple[float, float]) -> float:
        """Volume below the floor without a bore, mm^3."""


def spread(ways: Array) -> Array:
    """Greatest sum of the products of two weights of corners times the squared side between them, mm^2 (t,).

    Squared sides are (3, t). It is the squared radius of the least circle about a triangle with such sides: by so much,
    times a second derivative and halved, a function may be off its plane through the corners.
    """
    ways = np.sort(ways, axis=0)
    a, b, c = ways
    twice = np.maximum(2.0 * (a * b + b * c + c * a) - (a * a + b * b + c * c), 1e-300)
    return np.asarray(np.where(c >= a + b, 0.25 * c, a * b * c / twice))


@dataclass(frozen=True)
class Barrel:
    """A barrel of a `radius`, mm, with a track of a `depth`, mm, for rollers that are parallel to a radius of the cam.

    The turret's axis is parallel to that radius, at `offset`, mm, along e_t; the rollers' axes are `pitch`, mm, from
    it, at y = offset - sense pitch cos psi. `sense` is 1 trailing, -1 leading.
    """

    radius: float
    depth: float
    offset: float
    pitch: float
    sense: Side = 1

    @property
    def lever(self) -> float:
        """A flank bears on rollers at the pitch radius."""
        return self.pitch

    @property
    def inwards(self) -> int:
        """-1: places along a roller are counted from the cam's axis."""
        return -1

    def developed(self, radius: float) -> float:
        """Depth of a cylinder below the blank."""
        return self.radius - radius

    def guide(self, height: float, start: float) -> Swing:
        """An arm as long as the pitch radius."""
        return Swing(self.pitch, self.offset, height, self.sense, start)

    def demand(self, stops: int, roller: float, _ends: tuple[float, float]) -> None:
        """Raise ValueError where the rollers on the turret overlap."""
        if 2.0 * self.pitch * math.sin(math.pi / stops) <= 2.0 * roller:
            raise ValueError("neighbouring rollers overlap")

    def depth_of(self, r: Array, z: Array) -> Array:
        """Depth of points below the blank's cylinder."""
        return np.asarray(self.radius - r + 0.0 * z)

    def rims(self, depth: float, z: Array) -> Array:
        """Radius of the cylinder of a depth."""
        return np.asarray(self.radius - depth + 0.0 * z)

    def plane(self, _x: Array, y: Array, z: Array) -> tuple[Array, Array]:
        """Coordinates in the plane of e_t and z, which is square to the rollers."""
        return self.sense * (self.offset - y), z

    def beside(self, _y: Array, u: Array, v: Array, psi: Array) -> tuple[Array, Array]:
        """Place from a roller's axis, which is a point of the turret's plane."""
        return u - self.pitch * np.cos(psi), v - self.pitch * np.sin(psi)

    def touch(self, s: Array, _y: Array, radius: Array) -> Array:
        """Angle of touch, by the law of cosines."""
        half = (radius**2 - (s - self.pitch) ** 2) / (4.0 * self.pitch * s)
        with np.errstate(invalid="ignore"):
            angle: Array = 2.0 * np.arcsin(np.sqrt(half))
        return angle

    def slope(self, s: Array, d: Array) -> Array:
        """Derivative of the squared distance, by the law of cosines."""
        return np.asarray(2.0 * self.pitch * s * np.sin(d))

    def along(self, x: Array, _s: Array, _d: Array) -> Array:
        """Distance along e_r from the cam's axis."""
        return x

    def across(self, way: Array, sine: Array, cosine: Array, _psi: Array) -> Array:
        """Squared lengths square to e_r, along which all rollers point."""
        over = way[:, 1] * cosine - way[:, 0] * sine
        return np.asarray(over**2 + way[:, 2] ** 2)

    def turning(self, _slope: float) -> float:
        """1: axes turn with e_r."""
        return 1.0

    def window(self, r: Array, z: Array, reach: float) -> tuple[Array, Array]:
        """Angles at which a height crosses the circle of the axes, on the turret's far side too if that is in reach."""
        most = np.sqrt(np.maximum((self.pitch + reach) ** 2 - z**2, 0.0))
        least = np.sqrt(np.maximum((self.pitch - reach) ** 2 - z**2, 0.0))
        least = np.where(abs(self.offset) + least <= r, -most, least)
        one, other = self.offset - self.sense * most, self.offset - self.sense * least
        share = [np.clip(y / np.maximum(r, 1e-9), -1.0, 1.0) for y in (one, other)]
        return np.arcsin(np.minimum(*share)), np.arcsin(np.maximum(*share))

    def bends(self, slope: Array, curve: Array, near: tuple[float, float, float]) -> Array:
        """Bounds of 2 |q' - c'|^2 + 2 (q - c).(q'' - c''), with q the point and c the axis."""
        reach, step, r = near
        fast = r + self.pitch * slope
        far = reach + fast * step
        return np.asarray(2.0 * fast**2 + 2.0 * far * (r + self.pitch * (curve + slope**2)))

    def costs(self, rho: Array, turret: tuple[Array, Array], radius: float) -> tuple[Array, Array, Array]:
        """Costs by the pressure angle, whose tangent is (l psi' + sense rho sin psi)/(rho cos psi)."""
        psi, slope = turret
        alpha = np.arctan2(self.pitch * slope + self.sense * rho * np.sin(psi), rho * np.cos(psi))
        leaning = alpha - self.sense * psi
        y = self.offset - self.sense * self.pitch * np.cos(psi) - radius * np.sin(leaning)
        height = self.pitch * np.sin(psi) + radius * np.cos(leaning)
        return 1.0 / (self.pitch * np.abs(np.cos(alpha))), self.depth_of(np.hypot(rho, y), height), height

    def depth_at(self, place: float) -> float:
        """Below the blank's radius."""
        return self.radius - place

    def deepest(self, place: float, _radius: float) -> float:
        """A flat end is nearest to the cam's axis where a radius of the cam meets it."""
        return self.depth_at(place)

    def bent(self, ways: Array, places: Array) -> tuple[Array, Array]:
        """Depth above that of a plane alone: chords across the axis run below the cylinder."""
        return 0.5 * spread(_round(ways, places)[0]), np.zeros(len(places))

    def swept(self, depth: Array, ahead: Array, psi: Array, reach: tuple[float, int]) -> Array:
        """Height by Pythagoras in the turret's plane, where a point of the cylinder stays at its u."""
        radius, side = reach
        u, _ = self.plane(ahead, (self.radius - depth) * np.sin(ahead), ahead)
        with np.errstate(invalid="ignore"):
            height: Array = self.pitch * np.sin(psi) + side * np.sqrt(radius**2 - (u - self.pitch * np.cos(psi)) ** 2)
        return height

    def faces(self, depth: Array, ends: tuple[float, float]) -> tuple[Array, Array]:
        """Heights of the faces, which are level."""
        return np.full_like(depth, ends[0]), np.full_like(depth, ends[1])

    def measure(self, depth: Array, height: Array) -> Array:
        """Area of a cylinder per polar angle, below a height."""
        return np.asarray((self.radius - depth) * height)

    def core(self, ends: tuple[float, float]) -> float:
        """Volume of a cylinder."""
        return math.pi * (self.radius - self.depth) ** 2 * (ends[1] - ends[0])


@dataclass(frozen=True)
class Globoid:
    """A globoid, whose turret has radial rollers about an axis square to the cam's and `distance`, mm, from it.

    `radius`, mm, is that of the blank's throat about the turret's axis, `depth`, mm, goes from there away from the
    turret. Rollers are rays from the turret's axis; their places rho are distances from it.
    """

    radius: float
    depth: float
    distance: float

    @property
    def lever(self) -> float:
        """A flank bears at most at the floor's distance from the turret's axis."""
        return self.radius + self.depth

    @property
    def inwards(self) -> int:
        """1: places along a roller are counted from the turret's axis."""
        return 1

    def developed(self, _radius: float) -> float:
        """Raise ValueError: a torus does not unroll."""
        raise ValueError("a globoid has no development")

    def guide(self, _height: float, _start: float) -> Swing:
        """Raise ValueError: radial rollers turn with the turret."""
        raise ValueError("the rollers of a globoid do not keep their direction")

    def demand(self, stops: int, roller: float, ends: tuple[float, float]) -> None:
        """Raise ValueError where rollers overlap in the throat, or the throat is no longer there at the ends."""
        apart = self.radius * math.sin(min(2.0 * math.pi / stops, 0.5 * math.pi))
        if apart <= 1.25 * roller or self.radius * math.sin(math.pi / stops) <= roller:
            raise ValueError("neighbouring rollers overlap")
        if max(abs(end) for end in ends) >= self.radius:
            raise ValueError("the cam is longer than its throat is wide")
        if self.radius + self.depth >= self.distance:
            raise ValueError("the floor reaches the axis of the cam")

    def depth_of(self, r: Array, z: Array) -> Array:
        """Distance of points from the circle of the turning turret's centre, less the throat's radius."""
        return np.asarray(np.hypot(self.distance - r, z) - self.radius)

    def rims(self, depth: float, z: Array) -> Array:
        """Distance from the cam's axis of a layer, which is a torus."""
        wide = self.radius + depth
        return np.asarray(self.distance - np.sqrt(np.maximum(wide**2 - z**2, 0.0)))

    def plane(self, x: Array, _y: Array, z: Array) -> tuple[Array, Array]:
        """Coordinates in the plane of e_r and z, in which the rollers lie."""
        return self.distance - x, z

    def beside(self, y: Array, u: Array, v: Array, psi: Array) -> tuple[Array, Array]:
        """Place from a roller's axis, which is a line of the turret's plane through its centre."""
        return y, u * np.sin(psi) - v * np.cos(psi)

    def touch(self, s: Array, y: Array, radius: Array) -> Array:
        """Angle of touch of the section of a roller at the point's distance from the turret's plane."""
        with np.errstate(invalid="ignore"):
            angle: Array = np.arcsin(np.sqrt(radius**2 - y**2) / s)
        return angle

    def slope(self, s: Array, d: Array) -> Array:
        """Derivative of the squared distance."""
        return np.asarray(s**2 * np.sin(2.0 * d))

    def along(self, _x: Array, s: Array, d: Array) -> Array:
        """Distance from the turret's axis along the roller."""
        return np.asarray(s * np.cos(d))

    def across(self, way: Array, sine: Array, cosine: Array, psi: Array) -> Array:
        """Squared lengths square to an axis, which lies along -cos psi e_r + sin psi k."""
        out, over = way[:, 0] * cosine + way[:, 1] * sine, way[:, 1] * cosine - way[:, 0] * sine
        return np.asarray(over**2 + (out * np.sin(psi) + way[:, 2] * np.cos(psi)) ** 2)

    def turning(self, slope: float) -> float:
        """Axes turn with e_r, and on the turret."""
        return math.hypot(1.0, slope)

    def window(self, r: Array, _z: Array, reach: float) -> tuple[Array, Array]:
        """Angles within reach of the turret's plane, in which all axes lie."""
        wide = np.arcsin(np.clip(reach / np.maximum(r, 1e-9), 0.0, 1.0))
        return -wide, wide

    def bends(self, slope: Array, curve: Array, near: tuple[float, float, float]) -> Array:
        """Bounds of 2 (y'^2 + y y'' + x'^2 + x x''), with y across the turret's plane and x within it.

        x = u sin psi - v cos psi, and x' = u' sin psi + rho psi', with u' = -y. Likewise
        x'' = u'' sin psi + 2 u' cos psi psi' + rho psi'' - x psi'^2, where u'' is the point's distance along e_r.
        """
        reach, step, r = near
        beside = reach + r * step
        far = self.radius + 1.1 * self.depth + r - math.sqrt(max(r**2 - beside**2, 0.0))
        wide = reach + (r + beside + far * slope) * step
        within = (wide + far * slope) ** 2 + wide * (r + 2.0 * wide * slope + far * curve + wide * slope**2)
        return np.asarray(2.0 * (r**2 + wide**2 + within))

    def costs(self, rho: Array, turret: tuple[Array, Array], radius: float) -> tuple[Array, Array, Array]:
        """Costs by the pressure angle, whose tangent is rho psi'/(C - rho cos psi)."""
        psi, slope = turret
        alpha = np.arctan2(rho * slope, self.distance - rho * np.cos(psi))
        up = radius * np.cos(alpha)
        out = self.distance - rho * np.cos(psi) + up * np.sin(psi)
        height = rho * np.sin(psi) + up * np.cos(psi)
        r = np.hypot(out, radius * np.sin(alpha))
        return 1.0 / (rho * np.cos(alpha)), self.depth_of(r, height), height

    def depth_at(self, place: float) -> float:
        """Beyond the throat's radius."""
        return place - self.radius

    def deepest(self, place: float, radius: float) -> float:
        """The rim of a flat end is farther from the turret's axis than its middle."""
        return math.hypot(place, radius) - self.radius

    def bent(self, ways: Array, places: Array) -> tuple[Array, Array]:
        """Depth above and below that of a plane: chords round the cam's axis run deeper, those along the throat not."""
        over, r = _round(ways, places)
        wide = np.hypot(self.distance - np.hypot(places[:, 0], places[:, 1]), places[:, 2])
        longest = np.sqrt((ways**2).sum(axis=2)).max(axis=0)
        along = np.maximum((ways**2).sum(axis=2) - over * r, 0.0) + longest**4 / np.maximum(wide - longest, 1e-9) ** 2
        return 0.5 * spread(over), 0.5 * spread(along) / np.maximum(wide - longest, 1e-9)

    def swept(self, depth: Array, ahead: Array, psi: Array, reach: tuple[float, int]) -> Array:
        """Angle by Newton's method along the circle of the layer, from a place straight above the roller."""
        radius, side = reach
        wide = self.radius + depth
        found = np.full_like(psi, np.nan)
        given = np.isfinite(psi)
        one, other = (np.broadcast_to(row, found.shape)[given] for row in (np.sin(ahead), np.cos(ahead)))
        psi = psi[given]
        height = psi + side * np.arcsin(radius / wide)
        sine, cosine = np.sin(psi), np.cos(psi)
        for _ in range(STEPS):
            up, out = wide * np.sin(height), wide * np.cos(height)
            y, x = (self.distance - out) * one, (self.distance - (self.distance - out) * other) * sine - up * cosine
            rate = 2.0 * (y * up * one - x * (up * other * sine + out * cosine))
            with np.errstate(divide="ignore", invalid="ignore"):
                height = height - np.clip((y * y + x * x - radius**2) / rate, -0.1, 0.1)
        off = np.abs(y * y + x * x - radius**2)
        met = (off < NEAR * radius) & (np.abs(y) < radius) & (side * -x > 0.0)
        found[given] = np.where(met, height, np.nan)
        return found

    def faces(self, depth: Array, ends: tuple[float, float]) -> tuple[Array, Array]:
        """Angles at which the circle of a layer meets them."""
        wide = self.radius + depth
        return np.arcsin(ends[0] / wide), np.arcsin(ends[1] / wide)

    def measure(self, depth: Array, height: Array) -> Array:
        """Area of a torus per polar angle, below an angle."""
        wide = self.radius + depth
        return np.asarray(wide * (self.distance * height - wide * np.sin(height)))

    def core(self, ends: tuple[float, float]) -> float:
        """Volume within a torus, by the squares of distances from the cam's axis."""
        wide, c = self.radius + self.depth, self.distance
        heights = np.array(ends)
        root = np.sqrt(wide**2 - heights**2)
        low, high = (
            (c**2 + wide**2) * heights - heights**3 / 3.0 - c * (heights * root + wide**2 * np.arcsin(heights / wide))
        )
        return math.pi * float(high - low)


def _round(ways: Array, places: Array) -> tuple[Array, Array]:
    """Squares of sides (3, t) round the cam's axis, over the least distance from it, mm, and that distance (t,)."""
    r = np.hypot(places[:, 0], places[:, 1])
    level = np.hypot(ways[..., 0], ways[..., 1])
    least = np.maximum(r - level.max(axis=0), 1e-9)
    over = np.abs(ways[..., 1] * places[:, 0] - ways[..., 0] * places[:, 1]) / np.maximum(r, 1e-9)
    turned = level.max(axis=0) / least * level
    return np.minimum(over + turned, level) ** 2 / least, least
