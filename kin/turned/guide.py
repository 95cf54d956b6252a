"""What leads a roller's axis: a slide along the cam's axis, or an arm. Where the axis is, and where a roller touches.

Both are seen along the roller's axis, y across and z up. The follower's position q is mm on a slide, rad on an arm; the
roller's centre moves by `lever` mm along its path for one of it, in the direction T, and the path bends by `bend` 1/mm.

A roller of radius R that touches a point on its `side` has its centre at C(q), the point at C + R n. From the square of
that distance follows, for a point that moves by (dy, dz) while the radius there grows by dR, with p = (dy, dz) and
cos a = side n.T,

    lever q' = side (p.n - dR)/cos a = u
    -side lever q'' = -((p - u T)^2 - dR^2 + R bend (n.e) u^2)/(R cos a) + (p'.n - d2R)/cos a

where e is T turned back by a right angle on a trailing arm, which points from the pivot to the roller.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeAlias, TypeVar

import numpy as np

from kin.numeric.arrays import Array
from kin.numeric.elementary import Ball, BallJet, Jet, cos, sin
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from typing import ClassVar

    from kin.law.contacts import Side

    Bounds = tuple[Array, Array]

Number = TypeVar("Number", Array, Jet, Ball, BallJet)
Enclosed = TypeVar("Enclosed", Jet, Ball, BallJet)
QUARTER = 0.5 * math.pi


class Axis(NamedTuple, Generic[Number]):
    """A roller's axis across and up, mm, with two derivatives by the shaft angle, (n,) each, jets or balls."""

    y: Number
    z: Number
    y1: Number
    z1: Number
    y2: Number
    z2: Number


class Touch(NamedTuple):
    """A roller that touches points (n,): how far it is kept from its place, mm along its path; n and T.

    It is nan where it touches at no position.
    """

    gives: Array
    ny: Array
    nz: Array
    ty: Array
    tz: Array


@dataclass(frozen=True)
class Slide:
    """A slide along z: the roller's axis is at y = `offset` and z = `level` + lift, mm."""

    offset: float
    level: float
    lever: ClassVar[float] = 1.0
    bend: ClassVar[float] = 0.0
    sense: ClassVar[float] = 0.0

    def axis(self, lift: Array, slope: Array, bend: Array) -> Axis[Array]:
        """The roller's axis at lifts with their derivatives, (n,) each."""
        return self.jets(lift, slope, bend)

    def jets(self, lift: Number, slope: Number, bend: Number) -> Axis[Number]:
        """The roller's axis at lifts with their derivatives, as jets or balls."""
        still = 0.0 * lift
        return Axis(still + self.offset, lift + self.level, still, slope, still, bend)

    def above(self, z: Array, lift: Array) -> Array:
        """Heights (n,), mm, of places at z over the roller's axis at lifts (n,)."""
        return z - self.level - lift

    def enclosed(self, low: Array, high: Array) -> tuple[Bounds, Bounds, Bounds]:  # noqa: ARG002 - nothing depends on them
        """Bounds of the axis's y, mm, and of T across and up, over lifts from low to high (m,)."""
        still = np.zeros_like(low)
        return (still + self.offset,) * 2, (still, still), (still + 1.0,) * 2

    def beyond(self, place: tuple[Array, Array], radius: Array) -> Array:
        """By how much points at places y and z (n,), mm, are out of the way of rollers of radii (n,); below 0: none."""
        beyond: Array = np.abs(place[0] - self.offset) - radius
        return beyond

    def touching(self, place: tuple[Array, Array], lift: Array, radius: Array, side: Side) -> Touch:
        """Rollers of radii (n,) on points at places y and z (n,), by intended lifts (n,)."""
        y, z = place
        ny = (y - self.offset) / radius
        with np.errstate(invalid="ignore"):
            nz = side * np.sqrt(1.0 - ny * ny)
        gives = side * (self.level + lift - z) + radius * np.abs(nz)
        return Touch(gives, ny, nz, np.zeros_like(y), np.ones_like(y))


@dataclass(frozen=True)
class Swing:
    """An arm: the roller's axis at y = offset - sense length cos psi, z = pivot + length sin psi, psi = angle + lift.

    Lifts are rad. `sense` is 1 trailing, -1 leading.
    """

    length: float
    offset: float
    pivot: float
    sense: float
    angle: float

    @property
    def lever(self) -> float:
        """The arm's length, mm per rad."""
        return self.length

    @property
    def bend(self) -> float:
        """Curvature of the roller's path, 1/mm."""
        return 1.0 / self.length

    def axis(self, lift: Array, slope: Array, bend: Array) -> Axis[Array]:
        """The roller's axis at lifts with their derivatives, (n,) each."""
        psi = lift + self.angle
        return self._turned(np.cos(psi), np.sin(psi), slope, bend)

    def above(self, z: Array, lift: Array) -> Array:
        """Heights (n,), mm, of places at z over the roller's axis at lifts (n,)."""
        above: Array = z - self.pivot - self.length * np.sin(self.angle + lift)
        return above

    def jets(self, lift: Enclosed, slope: Enclosed, bend: Enclosed) -> Axis[Enclosed]:
        """The roller's axis at lifts with their derivatives, as jets or balls."""
        psi = lift + self.angle
        return self._turned(cos(psi), sin(psi), slope, bend)

    def _turned(self, cosine: Number, sine: Number, slope: Number, bend: Number) -> Axis[Number]:
        along, up = cosine * self.length, sine * self.length
        square = slope * slope
        return Axis(
            self.offset - along * self.sense,
            up + self.pivot,
            up * slope * self.sense,
            along * slope,
            (along * square + up * bend) * self.sense,
            along * bend - up * square,
        )

    def enclosed(self, low: Array, high: Array) -> tuple[Bounds, Bounds, Bounds]:
        """Bounds of the axis's y, mm, and of T across and up, over lifts from low to high (m,).

        T's bound up is below 0 where the arm may be square to the slide it stands for.
        """
        first, last = self.angle + low, self.angle + high
        level = (first <= 0.0) & (last >= 0.0)
        up = np.where(level, 1.0, np.maximum(np.cos(first), np.cos(last)))
        least = np.where((first > -QUARTER) & (last < QUARTER), np.minimum(np.cos(first), np.cos(last)), -1.0)
        across = self.sense * np.sin(first), self.sense * np.sin(last)
        aside = self.offset - self.sense * self.length * least, self.offset - self.sense * self.length * up
        return _sorted(*aside), _sorted(*across), (least, up)

    def beyond(self, place: tuple[Array, Array], radius: Array) -> Array:
        """By how much points at places y and z (n,), mm, are out of the way of rollers of radii (n,); below 0: none."""
        beyond: Array = np.abs(np.hypot(place[0] - self.offset, place[1] - self.pivot) - self.length) - radius
        return beyond

    def touching(self, place: tuple[Array, Array], lift: Array, radius: Array, side: Side) -> Touch:
        """Rollers of radii (n,) on points at places y and z (n,), by intended lifts (n,)."""
        x, z = self.sense * (self.offset - place[0]), place[1] - self.pivot
        square, length = x * x + z * z, self.length
        # the triangle of pivot, point and the roller's centre, whose angle at the pivot is what lies between them
        along = (length**2 + square - radius * radius) / (2.0 * length)
        with np.errstate(invalid="ignore", divide="ignore"):
            off = np.sqrt(square - along * along)
            cosine, sine = (x * along + side * z * off) / square, (z * along - side * x * off) / square
        ny, nz = self.sense * (length * cosine - x) / radius, (z - length * sine) / radius
        psi = self.angle + lift
        c, s = np.cos(psi), np.sin(psi)
        gives = side * length * np.arctan2(s * cosine - c * sine, c * cosine + s * sine)
        return Touch(gives, ny, nz, self.sense * sine, cosine)


def _sorted(one: Array, other: Array) -> Bounds:
    return np.minimum(one, other), np.maximum(one, other)


Guide: TypeAlias = Slide | Swing
