"""Forms of an indexing cam: where its layers lie, and how a roller runs past it.

The cam stands still, its axis is z; the turret runs round it by the shaft angle theta. e_r, e_t and k are the axes of
the cam's cylindrical frame at theta, and psi is the angle of a roller on the turret. Along a roller g points to rising
rho, and m is square to it and to e_t:

    barrel    g = e_r, m = k;   axis rho e_r + y e_t + z k,   y = offset - s l cos psi,   z = H + l sin psi
    globoid   g = -cos psi e_r + sin psi k, m = sin psi e_r + cos psi k;   axis C e_r + H k + rho g

By the radian of theta a point of the axis moves against the cam by A e_t + B m, and by `slip` along g. The equation of
meshing is solved in `camgeo.capabilities.indexing.flank`.

    barrel    A = rho + y',         B = z',         slip = -y
    globoid   A = C - rho cos psi,  B = rho psi',   slip = 0

A layer of a barrel is a cylinder about the cam's axis, of one radius; one of a globoid is a torus about it, of one
distance w from the circle of the radius C at the height H. On it stand the polar angle phi and a height h: z of a
barrel, mm; of a globoid the angle on the turret, rad. Numbers are arrays or balls (`kin.numeric.interval`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from camgeo.fit.facets import BESIDE
from kin.numeric.interval import Ball, atan2, sin_cos
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from typing import Literal

    from kin.numeric.arrays import Array, Indices

QUARTER = 0.5 * math.pi
LEAST_ROLLER = 0.01  # of a barrel's radius or a globoid's distance: the time of a proof grows with its inverse
WIDEST = math.pi / 3.0  # polar angle that a triangle may span, however coarse
LESS = 0.95  # times the span of a triangle that is too wide
Number: TypeAlias = Any
"""An array, or balls."""
Vector: TypeAlias = tuple[Number, Number, Number]
"""Parts of a vector along e_r, e_t and k, or along g, tau and n, each an array or balls."""


def directed(a: Number, b: Number, inverse: Number) -> tuple[Number, Number]:
    """Sine and cosine of the angle of (a, b), whose length has an inverse; balls no wider than that angle has them."""
    return sin_cos(atan2(b, a)) if isinstance(a, Ball) else (b * inverse, a * inverse)


def _arcsine(share: float) -> float:
    """Angle of a sine, rad; a quarter turn where it is beyond 1."""
    return math.asin(min(max(share, -1.0), 1.0))


def length_of(a: Number, b: Number) -> Number:
    """Length of (a, b), of arrays or balls."""
    square = a**2 + b**2
    if isinstance(square, Ball):  # which rounding may have led below 0
        low, high = square.bounds()
        return Ball.between(np.maximum(low, 0.0), high) ** 0.5
    return square**0.5


class Speed(NamedTuple):
    """How an axis moves: A and B, mm, with derivatives by theta (1) and by rho (2) up to the second."""

    a: Number
    a1: Number
    a2: Number
    a11: Number
    a12: Number
    b: Number
    b1: Number
    b2: Number
    b11: Number
    b12: Number


class Pose(NamedTuple):
    """A turret at shaft angles: sine and cosine of psi, and its first three derivatives by the shaft angle, (n,)."""

    sine: Number
    cosine: Number
    rate: Number
    second: Number
    third: Number

    def of(self, index: Indices) -> Pose:
        """The turret at some of the shaft angles."""
        return Pose(*(part[index] for part in self))

    @staticmethod
    def at(rows: Number, start: float) -> Pose:
        """The turret whose roller stands at `start`, rad, where S is 0, from rows (4, n) of S, rad, or of balls."""
        psi = rows[0] + start
        sine, cosine = sin_cos(psi) if isinstance(psi, Ball) else (np.sin(psi), np.cos(psi))
        return Pose(sine, cosine, rows[1], rows[2], rows[3])

    @staticmethod
    def standing(psi: Array) -> Pose:
        """The turret as if it stood still, with a roller at angles (n,), rad."""
        return Pose(np.sin(psi), np.cos(psi), *np.zeros((3, psi.size)))


@dataclass(frozen=True)
class Barrel:
    """A barrel, mm: radius of the blank, depth of the track, offset, pitch radius and height of the turret; length.

    `side` is 1 where the barrel's surface runs from the turret's axis to the contact (trailing), -1 where it runs the
    other way (leading).
    """

    radius: float
    depth: float
    offset: float
    pitch: float
    side: Literal[-1, 1]
    height: float
    length: float

    @property
    def blank(self) -> float:
        """Layer of the blank, mm."""
        return self.radius

    @property
    def floor(self) -> float:
        """Layer of the track's floor, mm."""
        return self.radius - self.depth

    @property
    def least_roller(self) -> float:
        """Least radius of a roller, mm."""
        return LEAST_ROLLER * self.radius

    def speed(self, pose: Pose, rho: Number) -> Speed:
        """How the roller's axis moves at distances rho along it."""
        sine, cosine, p1, p2, p3 = pose
        reach, side = self.pitch, float(self.side)
        cube = p1 * p1 * p1
        y1, z1 = sine * p1 * (side * reach), cosine * p1 * reach
        y2 = (cosine * p1 * p1 + sine * p2) * (side * reach)
        z2 = (cosine * p2 - sine * p1 * p1) * reach
        y3 = (cosine * p1 * p2 * 3.0 - sine * cube + sine * p3) * (side * reach)
        z3 = (cosine * p3 - sine * p1 * p2 * 3.0 - cosine * cube) * reach
        nothing = rho * 0.0
        return Speed(rho + y1, y2, nothing + 1.0, y3, nothing, z1, z2, nothing, z3, nothing)

    def slip(self, pose: Pose, rho: Number) -> tuple[Number, Number]:
        """Speed of the axis along itself, mm per rad, and its derivative by theta."""
        return (
            rho * 0.0 - self._beside(pose),
            pose.sine * pose.rate * (-self.side * self.pitch),
        )

    def _beside(self, pose: Pose) -> Number:
        return pose.cosine * (-self.side * self.pitch) + self.offset

    def tilt(self, pose: Pose) -> tuple[Number, Number]:
        """How fast the normal turns with the frame beyond the turn of its own angle, and that by theta: nothing."""
        return pose.sine * 0.0, pose.sine * 0.0

    def twist(self, pose: Pose, sine: Number, cosine: Number) -> Number:
        """Part along g of the derivative of tau by theta, for the contact's angle by sine and cosine."""
        return cosine * -1.0 + (pose.sine + sine) * 0.0

    def axes(self, pose: Pose, sine: Number, cosine: Number) -> tuple[Vector, Vector, Vector]:
        """Vectors g, tau and n along e_r, e_t and k, for the contact's angle by sine and cosine."""
        nothing = sine * 0.0 + pose.sine * 0.0
        one = nothing + 1.0
        return (one, nothing, nothing), (nothing, cosine, sine), (nothing, sine * -1.0, cosine)

    def axis(self, pose: Pose, rho: Number) -> Vector:
        """Places of the roller's axis along e_r, e_t and k, mm."""
        return rho, rho * 0.0 + self._beside(pose), pose.sine * self.pitch + self.height + rho * 0.0

    def lean(self, psi: Array) -> Array:
        """Angle of the roller's way against m, towards -e_t, rad (n,)."""
        return np.asarray(self.side * psi)

    def lever(self, rho: Array) -> Array:
        """Distance of a contact from the turret's axis, mm (n,), at distances rho along the roller."""
        return np.full_like(rho, self.pitch)

    def layer(self, place: Vector) -> tuple[Number, Vector]:
        """Layers of places along e_r, e_t and k, mm (n,), and the unit normals of these, towards greater w."""
        x, y, z = place
        r = length_of(x, y)
        inverse = r**-1
        return r, (x * inverse, y * inverse, z * 0.0)

    def height_of(self, place: Vector) -> Array:
        """Heights h (n,) of places along e_r, e_t and k."""
        return np.asarray(place[2])

    def points(self, phi: Array, h: Array, w: Array | float) -> Array:
        """Points (n, 3), mm, at polar angles and heights (n,) in layers w, mm."""
        return np.column_stack([w * np.cos(phi), w * np.sin(phi), h])

    def chart(self, points: Array) -> tuple[Array, Array, Array]:
        """Polar angle, height and layer, (n,) each, of points (n, 3), mm."""
        x, y, z = points.T
        return np.arctan2(y, x), z, np.hypot(x, y)

    def ends(self, w: Array | float) -> tuple[Array, Array]:
        """Heights h of the lower and of the upper end face in layers w, mm."""
        low = np.zeros_like(np.asarray(w, dtype=float))
        return low, low + self.length

    def unit(self, w: float) -> float:
        """Length, mm, of a unit of h in a layer w, mm."""
        del w
        return 1.0

    def beside(self, w: float, z: Array) -> Array:
        """Distances from the cam's axis, mm (n,), of a layer w, mm, at heights over the lower face, mm (n,)."""
        return np.full_like(z, w)

    def rim(self, w: float) -> float:
        """Greatest distance from the cam's axis, mm, of a layer w, mm, between the end faces."""
        return w

    def reach(self, radius: float) -> tuple[float, float]:
        """Least and greatest distance rho, mm, at which a roller of a radius may touch the metal above the floor."""
        del radius
        return 0.0, self.radius

    def spanned(self, radius: float) -> tuple[float, float]:
        """Angles on the turret, rad, between which a roller of a radius, mm, touches the cam; a quarter turn at most.

        Beyond them the whole roller is past an end face.
        """
        low, high = (-self.height - radius) / self.pitch, (self.length - self.height + radius) / self.pitch
        return _arcsine(low), _arcsine(high)

    @property
    def core(self) -> float:
        """Radius, mm, of what is left within the floor where that is thinnest: the floor's own."""
        return self.floor

    @property
    def volume(self) -> float:
        """Volume, mm^3, of the blank: a cylinder."""
        return math.pi * self.radius * self.radius * self.length

    def area(self, w: float, h: Array) -> Array:
        """Area, mm^2 by the radian of the polar angle (n,), below heights h in a layer w, mm, but for a constant."""
        return np.asarray(w * h)

    def off(self, w: float, turn: Array, h: Array) -> Array:
        """Bound, mm (n,), of the distance from a layer of triangles that span a polar angle, rad, and a height (n,)."""
        del h
        return np.asarray(2.0 * w * np.sin(0.25 * np.minimum(turn, math.pi)) ** 2)

    def widest(self, w: float, tolerance: float) -> tuple[float, float]:
        """Polar angle, rad, and height that triangles in a layer may span within a tolerance, mm."""
        return min(4.0 * math.asin(math.sqrt(min(0.5 * tolerance / w, 0.5))), WIDEST), math.inf


@dataclass(frozen=True)
class Globoid:
    """A globoid: radius of the blank's throat about the turret's axis, depth of the track, distance of both axes.

    `height` is that of the turret's axis over the lower face, and `length` that of the cam, all in mm.
    """

    radius: float
    depth: float
    distance: float
    height: float
    length: float

    @property
    def blank(self) -> float:
        """Layer of the blank, mm."""
        return self.radius

    @property
    def floor(self) -> float:
        """Layer of the track's floor, mm."""
        return self.radius + self.depth

    @property
    def least_roller(self) -> float:
        """Least radius of a roller, mm."""
        return LEAST_ROLLER * self.distance

    def speed(self, pose: Pose, rho: Number) -> Speed:
        """How the roller's axis moves at distances rho along it."""
        sine, cosine, p1, p2, p3 = pose
        nothing = rho * 0.0
        return Speed(
            self.distance - rho * cosine,
            rho * sine * p1,
            nothing - cosine,
            rho * (cosine * p1 * p1 + sine * p2),
            nothing + sine * p1,
            rho * p1,
            rho * p2,
            nothing + p1,
            rho * p3,
            nothing + p2,
        )

    def slip(self, pose: Pose, rho: Number) -> tuple[Number, Number]:
        """Speed of the axis along itself, mm per rad, and its derivative by theta: none."""
        nothing = rho * 0.0 + pose.sine * 0.0
        return nothing, nothing

    def tilt(self, pose: Pose) -> tuple[Number, Number]:
        """How fast the normal turns with the frame beyond the turn of its own angle, and that by theta."""
        return pose.sine, pose.cosine * pose.rate

    def twist(self, pose: Pose, sine: Number, cosine: Number) -> Number:
        """Part along g of the derivative of tau by theta, for the contact's angle by sine and cosine."""
        return cosine * pose.cosine - pose.rate * sine

    def axes(self, pose: Pose, sine: Number, cosine: Number) -> tuple[Vector, Vector, Vector]:
        """Vectors g, tau and n along e_r, e_t and k, for the contact's angle by sine and cosine."""
        up, out = pose.sine, pose.cosine
        nothing = sine * 0.0 + up * 0.0
        return (
            (nothing - out, nothing, nothing + up),
            (sine * up, cosine + nothing, sine * out),
            (cosine * up, sine * -1.0 + nothing, cosine * out),
        )

    def axis(self, pose: Pose, rho: Number) -> Vector:
        """Places of the roller's axis along e_r, e_t and k, mm."""
        return self.distance - rho * pose.cosine, rho * 0.0, rho * pose.sine + self.height

    def lean(self, psi: Array) -> Array:
        """Angle of the roller's way against m, towards -e_t, rad (n,): none."""
        return np.zeros_like(psi)

    def lever(self, rho: Array) -> Array:
        """Distance of a contact from the turret's axis, mm (n,), at distances rho along the roller."""
        return rho

    def layer(self, place: Vector) -> tuple[Number, Vector]:
        """Layers of places along e_r, e_t and k, mm (n,), and the unit normals of these, towards greater w."""
        x, y, z = place
        r = length_of(x, y)
        inwards, up = self.distance - r, z - self.height
        w = length_of(inwards, up)
        inverse = w**-1
        cosine, turn = inwards * inverse * -1.0, r**-1
        return w, (cosine * x * turn, cosine * y * turn, up * inverse)

    def height_of(self, place: Vector) -> Array:
        """Heights h (n,) of places along e_r, e_t and k."""
        x, y, z = place
        return np.asarray(np.arctan2(z - self.height, self.distance - np.hypot(x, y)))

    def points(self, phi: Array, h: Array, w: Array | float) -> Array:
        """Points (n, 3), mm, at polar angles and heights (n,) in layers w, mm."""
        r = self.distance - w * np.cos(h)
        return np.column_stack([r * np.cos(phi), r * np.sin(phi), self.height + w * np.sin(h)])

    def chart(self, points: Array) -> tuple[Array, Array, Array]:
        """Polar angle, height and layer, (n,) each, of points (n, 3), mm."""
        x, y, z = points.T
        inwards, up = self.distance - np.hypot(x, y), z - self.height
        return np.arctan2(y, x), np.arctan2(up, inwards), np.hypot(inwards, up)

    def ends(self, w: Array | float) -> tuple[Array, Array]:
        """Heights h of the lower and of the upper end face in layers w, mm."""
        return np.arcsin(-self.height / np.asarray(w)), np.arcsin((self.length - self.height) / np.asarray(w))

    def unit(self, w: float) -> float:
        """Length, mm, of a unit of h in a layer w, mm."""
        return w

    def beside(self, w: float, z: Array) -> Array:
        """Distances from the cam's axis, mm (n,), of a layer w, mm, at heights over the lower face, mm (n,)."""
        return np.asarray(self.distance - np.sqrt(w * w - (z - self.height) ** 2))

    def rim(self, w: float) -> float:
        """Greatest distance from the cam's axis, mm, of a layer w, mm, between the end faces."""
        far = max(self.height, self.length - self.height)
        return self.distance - math.sqrt(max(w * w - far * far, 0.0))

    def reach(self, radius: float) -> tuple[float, float]:
        """Least and greatest distance rho, mm, at which a roller of a radius may touch the metal above the floor."""
        return max(self.radius - radius, 0.0), self.radius + self.depth + radius

    def spanned(self, radius: float) -> tuple[float, float]:
        """Angles on the turret, rad, between which a roller of a radius, mm, touches the cam; a quarter turn at most.

        Seen along the turret's axis, no metal lies nearer to it than the throat. So the angle between a point that a
        roller touches and the roller's axis is at most asin(radius/throat).
        """
        low, high = -self.height / self.radius, (self.length - self.height) / self.radius
        beside = _arcsine(radius / self.radius)
        return (
            max(_arcsine(low) - beside, -QUARTER),
            min(_arcsine(high) + beside, QUARTER),
        )

    @property
    def core(self) -> float:
        """Radius, mm, of what is left within the floor where that is thinnest: in the plane through both axes."""
        return self.distance - self.floor

    @property
    def volume(self) -> float:
        """Volume, mm^3, of the blank: between two planes, hollowed out by a torus."""
        blank, c = self.radius, self.distance

        def upto(z: float) -> float:
            root = math.sqrt(blank * blank - z * z)
            half = 0.5 * (z * root + blank * blank * math.asin(z / blank))
            return math.pi * ((c * c + blank * blank) * z - z**3 / 3.0 - 2.0 * c * half)

        return upto(self.length - self.height) - upto(-self.height)

    def area(self, w: float, h: Array) -> Array:
        """Area, mm^2 by the radian of the polar angle (n,), below heights h in a layer w, mm: w (C h - w sin h)."""
        return np.asarray(w * (self.distance * h - w * np.sin(h)))

    def off(self, w: float, turn: Array, h: Array) -> Array:
        """Bound, mm (n,), of the distance from a layer of triangles that span a polar angle, rad, and a height (n,).

        A torus is a saddle there: both parts of the second order are of opposite sense, and each is held by itself.
        """
        r, steep = self.rim(w), min(w, max(self.height, self.length - self.height))
        whole = (r * turn * turn + 2.0 * steep * turn * h + w * h * h) / 8.0
        plain = np.maximum(r * turn * turn, w * h * h) / 8.0
        return np.asarray(plain + BESIDE * (turn + h) * whole)

    def widest(self, w: float, tolerance: float) -> tuple[float, float]:
        """Polar angle, rad, and height that triangles in a layer may span within a tolerance, mm."""
        turn, h = (min(math.sqrt(8.0 * tolerance / size), WIDEST) for size in (self.rim(w), w))
        while float(self.off(w, np.array(turn), np.array(h))) > tolerance:
            turn, h = LESS * turn, LESS * h
        return turn, h
