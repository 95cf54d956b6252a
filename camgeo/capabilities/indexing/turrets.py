"""How a turret leads a roller's axis about its cam, with the derivatives of it, and what lies where in its cam.

Vectors are in the frame (e_r, e_t, k) that turns about the cam's axis with the shaft angle theta.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.indexing.intent import Form
    from kin.numeric.arrays import Array


LESS = 0.999  # of a greatest length, in a remedy


class Axis(NamedTuple):
    """Axes of rollers, the points o + rho u: o and the unit vector u (n, 3), and two derivatives by theta, mm and rad.

    `lead` (n, 3) is the unit vector along which the turret moves a roller where it rises.
    """

    o: Array
    o1: Array
    o2: Array
    u: Array
    u1: Array
    u2: Array
    lead: Array


def _vector(x: Array | float, y: Array | float, z: Array | float, like: Array) -> Array:
    return np.stack([np.broadcast_to(part, like.shape) for part in (x, y, z)], axis=-1)


@dataclass(frozen=True)
class Turret(ABC):
    """A turret whose axis stands at a `height`, mm, over the cam's lower face."""

    turn: ClassVar[int]  # of the normal: turn u x c' points up along it
    about: ClassVar[str]  # whose axis the layers are about
    height: float

    @abstractmethod
    def axis(self, rows: Array) -> Axis:
        """Axes of rollers at values (3, n) of their angle on the turret, rad, and two derivatives by theta."""

    @abstractmethod
    def lever(self, rho: Array) -> Array:
        """Distance from the turret's axis, mm, at which a force at rho, mm, along a roller works; of one shape."""

    @abstractmethod
    def place(self, points: Array) -> tuple[Array, Array]:
        """Layer w, mm, and height h, mm or rad, of points (n, 3), mm."""

    @abstractmethod
    def outward(self, points: Array, along: Array) -> Array:
        """Derivative (n,) of the layer w along vectors (n, 3) at points (n, 3)."""

    @abstractmethod
    def across(self, w: Array, h: Array) -> Array:
        """Area below a height h in a layer w by the radian of the polar angle, mm^2, up to a constant of the layer."""

    @abstractmethod
    def thickness(self, w: float, h: Array) -> Array:
        """Length, mm, of differences h of heights in a layer w, mm."""

    @abstractmethod
    def ends(self, w: float, length: float) -> tuple[float, float]:
        """Heights h, in a layer w, mm, of the lower face and of the upper one, `length`, mm, above it."""

    @abstractmethod
    def spanned(self, radius: float, blank: float, length: float) -> tuple[float, float]:
        """Angles, rad, between which a roller of a radius, mm, touches a cam of a `length`, mm.

        They are nan where a roller never leaves it at an end.
        """

    @abstractmethod
    def misled(
        self, radius: float, inner: float, layers: tuple[float, float], length: float, shown: Callable[[float], str]
    ) -> tuple[str, str, str] | None:
        """Field, problem and remedy where rollers do not leave the cam at its ends, or meet it on their way back.

        The rollers have a radius and begin at `inner`; the track lies between two layers, all mm. `shown` writes a
        length, mm, in the recipe's unit. None where there is no such problem.
        """

    @abstractmethod
    def whole(self, blank: float, length: float) -> float:
        """Volume, mm^3, of a blank of a layer and a length, mm."""

    @abstractmethod
    def intended(self, radius: float, depth: float) -> Form:
        """The form in kin's words, of a blank of a radius with a track of a depth, mm."""


@dataclass(frozen=True)
class BarrelTurret(Turret):
    """A turret with rollers parallel to its axis at the distance `pitch`, mm, from it.

    Its axis is parallel to a radius of the cam, at the distance `offset`, mm, along e_t from it. `side` is 1 for a
    trailing turret, -1 for a leading one: the roller stands at offset - side pitch cos psi.
    """

    turn: ClassVar[int] = 1
    about: ClassVar[str] = "the cam"
    pitch: float
    offset: float
    side: int

    def beside(self, psi: Array) -> Array:
        """Distance (n,), mm, of a roller's axis from the cam's along e_t, at angles (n,), rad."""
        return np.asarray(self.offset - self.side * self.pitch * np.cos(psi))

    def axis(self, rows: Array) -> Axis:
        """Axes parallel to e_r."""
        psi, rate, bend = rows
        sine, cosine, l, s = np.sin(psi), np.cos(psi), self.pitch, self.side  # noqa: E741 - as in the formulas
        y, z = self.beside(psi), self.height + l * sine
        y1, z1 = s * l * sine * rate, l * cosine * rate
        y2 = s * l * (cosine * rate * rate + sine * bend)
        z2 = l * (cosine * bend - sine * rate * rate)
        return Axis(
            _vector(0.0, y, z, psi),
            _vector(-y, y1, z1, psi),
            _vector(-2.0 * y1, y2 - y, z2, psi),
            _vector(1.0, 0.0, 0.0, psi),
            _vector(0.0, 1.0, 0.0, psi),
            _vector(-1.0, 0.0, 0.0, psi),
            _vector(0.0, s * sine, cosine, psi),
        )

    def lever(self, rho: Array) -> Array:
        """The pitch radius."""
        return np.full_like(rho, self.pitch)

    def place(self, points: Array) -> tuple[Array, Array]:
        """Radius about the cam's axis, and height over the lower face."""
        return np.hypot(points[..., 0], points[..., 1]), points[..., 2]

    def outward(self, points: Array, along: Array) -> Array:
        """Derivative of the radius."""
        found: Array = np.sum(points[..., :2] * along[..., :2], axis=-1) / np.hypot(points[..., 0], points[..., 1])
        return found

    def across(self, w: Array, h: Array) -> Array:
        """Area of a cylinder."""
        return np.asarray(w * h)

    def thickness(self, w: float, h: Array) -> Array:  # noqa: ARG002 - of a globoid it matters
        """Length along the cam's axis."""
        return h

    def ends(self, w: float, length: float) -> tuple[float, float]:  # noqa: ARG002
        """Heights of the faces."""
        return 0.0, length

    def spanned(self, radius: float, blank: float, length: float) -> tuple[float, float]:  # noqa: ARG002
        """Angles at which a whole roller is beyond either face."""
        low, high = -self.height - radius, length - self.height + radius
        if not max(-low, high) < self.pitch:
            return math.nan, math.nan
        return math.asin(low / self.pitch), math.asin(high / self.pitch)

    def misled(
        self, radius: float, inner: float, layers: tuple[float, float], length: float, shown: Callable[[float], str]
    ) -> tuple[str, str, str] | None:
        """Problem of rollers that turn back within the cam, stand far off its radius, or meet it behind the turret."""
        floor, blank = layers
        room, away = LESS * floor, self.side * self.offset
        ends = self.spanned(radius, blank, length)
        near = self.pitch - away  # how far the roller in the middle stands off a radius
        if not abs(near) < room:
            low, high = self.pitch - room, self.pitch + room
            sides = sorted((self.side * low, self.side * high))
            problem = f"the roller's axis stands {shown(abs(near))} off a radius of the cam, past the floor's edge"
            return "cam.barrel.offset", problem, f"give one between {shown(sides[0])} and {shown(sides[1])}"
        farthest = (away - room) / self.pitch  # the least cosine up to which a roller may be led
        steepest = math.acos(max(farthest, 0.0)) if farthest < 1.0 else 0.0
        if not max(-ends[0], ends[1]) < steepest:  # nor where it is nan
            most = 2.0 * (self.pitch * math.sin(steepest) - radius)
            problem = "the rollers stand past the floor's edge before they leave the cam at its ends"
            serves = f"give less than {shown(most * LESS)}, with the turret's axis in the middle of it"
            return "part.length", problem, f"{serves}, or a larger turret.radius" if most > 0.0 else "give a smaller roller"
        behind = away + self.pitch * math.cos(max(-ends[0], ends[1])) - radius
        if not behind > math.sqrt(max(blank * blank - inner * inner, 0.0)):
            problem = "the rollers meet the cam on their way back, behind the turret's axis"
            return "cam.turret.radius", problem, "give a larger one with an offset that is larger by as much"
        return None

    def whole(self, blank: float, length: float) -> float:
        """Volume of a cylinder."""
        return math.pi * blank * blank * length

    def intended(self, radius: float, depth: float) -> Form:
        """Kin's barrel."""
        from kin.indexing.intent import Barrel

        return Barrel(radius, depth, self.offset, self.pitch, self.side)


@dataclass(frozen=True)
class GloboidTurret(Turret):
    """A turret with radial rollers, whose axis is square to the cam's at the distance `distance`, mm."""

    turn: ClassVar[int] = -1
    about: ClassVar[str] = "the turret"
    distance: float

    def axis(self, rows: Array) -> Axis:
        """Rays from the turret's centre."""
        psi, rate, bend = rows
        sine, cosine = np.sin(psi), np.cos(psi)
        up, down = sine * bend + cosine * rate * rate, cosine * bend - sine * rate * rate
        c = self.distance
        return Axis(
            _vector(c, 0.0, self.height, psi),
            _vector(0.0, c, 0.0, psi),
            _vector(-c, 0.0, 0.0, psi),
            _vector(-cosine, 0.0, sine, psi),
            _vector(sine * rate, -cosine, cosine * rate, psi),
            _vector(up + cosine, 2.0 * sine * rate, down, psi),
            _vector(sine, 0.0, cosine, psi),
        )

    def lever(self, rho: Array) -> Array:
        """The distance from the turret's axis itself."""
        return rho

    def place(self, points: Array) -> tuple[Array, Array]:
        """Distance from the turret's centre in the plane through the cam's axis, and angle there."""
        away, up = self.distance - np.hypot(points[..., 0], points[..., 1]), points[..., 2] - self.height
        return np.hypot(away, up), np.arctan2(up, away)

    def outward(self, points: Array, along: Array) -> Array:
        """Derivative of that distance."""
        r = np.hypot(points[..., 0], points[..., 1])
        away, up = self.distance - r, points[..., 2] - self.height
        inwards = np.sum(points[..., :2] * along[..., :2], axis=-1) / r
        found: Array = (up * along[..., 2] - away * inwards) / np.hypot(away, up)
        return found

    def across(self, w: Array, h: Array) -> Array:
        """Area of a torus: w (C h - w sin h)."""
        return np.asarray(w * (self.distance * h - w * np.sin(h)))

    def thickness(self, w: float, h: Array) -> Array:
        """Length of the arc."""
        return np.asarray(w * h)

    def ends(self, w: float, length: float) -> tuple[float, float]:
        """Angles at which the faces cut the torus."""
        return math.asin(-self.height / w), math.asin((length - self.height) / w)

    def spanned(self, radius: float, blank: float, length: float) -> tuple[float, float]:
        """Angles at which the near side of a whole roller is beyond either face."""
        reach, more = math.hypot(blank, radius), math.atan(radius / blank)
        return math.asin(-self.height / reach) - more, math.asin((length - self.height) / reach) + more

    def misled(
        self,
        radius: float,  # noqa: ARG002 - all matter for a barrel
        inner: float,  # noqa: ARG002
        layers: tuple[float, float],  # noqa: ARG002
        length: float,  # noqa: ARG002
        shown: Callable[[float], str],  # noqa: ARG002
    ) -> tuple[str, str, str] | None:
        """No problem: rollers leave a globoid outwards, and are far from it behind the turret's axis."""
        return None

    def whole(self, blank: float, length: float) -> float:
        """Volume of a body between two planes, hollowed out by a torus."""

        def upto(z: float) -> float:
            root = math.sqrt(blank * blank - z * z)
            half = 0.5 * (z * root + blank * blank * math.asin(z / blank))
            c = self.distance
            return math.pi * ((c * c + blank * blank) * z - z**3 / 3.0 - 2.0 * c * half)

        return upto(length - self.height) - upto(-self.height)

    def intended(self, radius: float, depth: float) -> Form:
        """Kin's globoid."""
        from kin.indexing.intent import Globoid

        return Globoid(radius, depth, self.distance)
