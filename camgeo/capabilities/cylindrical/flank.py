"""The exact flank of a cylindrical cam, in closed form: what one roller leaves, and where it is on any cylinder.

The cam stands still, its axis is z, and the roller's axis runs round it parallel to e_r(theta), at places (y, z) along
e_t and z that its guide gives (`camgeo.capabilities.cylindrical.guide`); rho is the coordinate along it. A roller of a
taper d has the radius R(rho) = R + (rho - at) tan d. Normals at rho meet its axis at rho* = rho + R tan d, and those of
contact are square to the motion of the axis there, -y e_r + (rho* + y') e_t + z' k (F. L. Litvin, Gear Geometry and
Applied Theory, 1994, equation of meshing). With A = rho* + y' and w = hypot(A, z') that is solved by

    a = atan2(z', A) + side asin(y tan d/w),
    p = rho e_r + q e_t + (z + side R cos a) k,     q = y - side R sin a

For a cylinder whose axis is a radius (y = 0, d = 0) sin a = z'/w and cos a = rho/w, and the flank on the cylinder r is
explicit:

    w^2 = ((r^2 + z'^2) + sqrt((r^2 - z'^2)^2 + 4 z'^2 (r^2 - R^2)))/2,     sin f = q/r,  phi = theta + f

else rho is found by Newton's method from rho^2 + q^2 = r^2. p_theta x p_rho = D n; the flank is regular where D > 0.
With M = w sqrt(1 - (y tan d/w)^2) and the derivatives a_1 by theta and a_2 = -sin a/(M cos^2 d) by rho of a

    D cos d = M - R tan d cos a - side R (a_1 + q a_2)
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.curve.curve import CurveError
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.guide import Guide
    from kin.law.piecewise import Piecewise, Side
    from kin.numeric.arrays import Array, Indices

NEWTON, SETTLED = 60, 1e-13  # steps, and the share of a radius by which the last one moves


class Contact(NamedTuple):
    """Points of a flank, arrays of one shape: where a roller touches it, and how.

    rho        distance along the roller's axis from the cam's, mm
    r, phi, z  cylindrical coordinates of the point, mm and rad
    angle      angle a of the contact's normal against the cam's axis, about that of the roller, rad
    regular    D, mm: below 0 the flank turns back, and is undercut
    """

    rho: Array
    r: Array
    phi: Array
    z: Array
    angle: Array
    regular: Array


class Pose(NamedTuple):
    """Places y and z of the roller's axis with two derivatives by the shaft angle, mm (n,) each; `lean` of its way.

    `lean` is the angle of the way of the roller against the cam's axis, towards -e_t, rad.
    """

    y: Array
    y1: Array
    y2: Array
    z: Array
    z1: Array
    z2: Array
    lean: Array

    def at(self, index: Indices) -> Pose:
        """Poses of some of the angles."""
        return Pose(*(part[index] for part in self))


class _Touch(NamedTuple):
    """Contact at places along the roller: its radius there, A, z', w, sin and cos of a - a0, and of a."""

    radius: Array
    along: Array
    up: Array
    w: Array
    shift: Array
    beside: Array
    sine: Array
    cosine: Array


@dataclass(frozen=True, eq=False)
class Flank:
    """The flank of a roller of a radius, mm, below it (`side` -1) or above it (1).

    `law` is S, mm or rad, over the shaft angle, rad; `guide` leads the roller's axis by it. `taper` is the half angle
    of a conical roller, rad, which has its radius at the distance `at` along its axis, mm.
    """

    law: Piecewise
    guide: Guide
    radius: float
    side: int
    taper: float = 0.0
    at: float = 0.0

    @property
    def period(self) -> float:
        """Shaft angle, rad, after which the flank is touched where it was: that of a turn or of several."""
        return self.law.period or TURN

    @property
    def level(self) -> float:
        """Height of the roller's axis at S = 0, mm."""
        return self.guide.height(0.0)

    @cached_property
    def slope(self) -> float:
        """Tangent of the taper."""
        return math.tan(self.taper)

    @property
    def radial(self) -> bool:
        """Whether the roller is a cylinder whose axis is a radius of the drum: its rows on cylinders are explicit."""
        return self.taper == 0.0 and self.guide.radial

    def size(self, rho: Array | float) -> Array:
        """Radius of the roller, mm, at distances rho along its axis."""
        return np.asarray(self.radius + (rho - self.at) * self.slope)

    def pose(self, theta: Array, at: Side = 1) -> Pose:
        """Where the roller's axis is at shaft angles (n,), and how it moves; at a break of one side."""
        return self.led(self.law.derivatives(theta, 2, at))

    def led(self, rows: Array) -> Pose:
        """Where the roller's axis is at values (3, n) of S, S' and S''."""
        y, z = self.guide.place(rows)
        return Pose(y[0], y[1], y[2], z[0], z[1], z[2], self.guide.lean(rows[0]))

    def _touch(self, pose: Pose, rho: Array) -> _Touch:
        radius = self.size(rho)
        along = rho + radius * self.slope + pose.y1
        w = np.hypot(along, pose.z1)
        shift = self.side * pose.y * self.slope / w
        beside = np.sqrt(1.0 - shift * shift)
        sine, cosine = (pose.z1 * beside + along * shift) / w, (along * beside - pose.z1 * shift) / w
        return _Touch(radius, along, pose.z1, w, shift, beside, sine, cosine)

    def along(self, theta: Array, rho: Array, at: Side = 1) -> Contact:
        """Contacts at shaft angles theta and distances rho along the roller's axis, both (n,)."""
        return self._contact(theta, self.pose(theta, at), rho)

    def _contact(self, theta: Array, pose: Pose, rho: Array) -> Contact:
        touch = self._touch(pose, rho)
        q = pose.y - self.side * touch.radius * touch.sine
        phi = theta + np.arctan2(q, rho)
        z = pose.z + self.side * touch.radius * touch.cosine
        angle = np.arctan2(touch.sine * touch.w, touch.cosine * touch.w)
        return Contact(rho, np.hypot(rho, q), phi, z, angle, self.regularity(pose, rho))

    def resting(self, lift: float, r: float) -> float:
        """Height of the flank, mm, on the cylinder r, mm, where the follower rests at a lift, mm or rad."""
        pose = self.led(np.array([[lift], [0.0], [0.0]]))
        return float(self._contact(np.zeros(1), pose, self.reached(pose, r)).z[0])

    def on(self, theta: Array, r: Array | float, at: Side = 1) -> Contact:
        """Contacts at shaft angles theta (n,) on the cylinder of the radius r, mm.

        It is at least the roller's, and that with the distance of its axis from a radius. Raises CurveError where
        nothing is found.
        """
        pose = self.pose(theta, at)
        return self._contact(theta, pose, self.reached(pose, r))

    def polar(self, theta: Array, r: float) -> Array:
        """Polar angles (n,), rad, of contacts at shaft angles theta (n,) on the cylinder r, mm; raises as `on` does."""
        pose = self.pose(theta)
        rho = self.reached(pose, r)
        touch = self._touch(pose, rho)
        return np.asarray(theta + np.arctan2(pose.y - self.side * touch.radius * touch.sine, rho))

    def radii(self, pose: Pose, rho: Array) -> Array:
        """Radii of the cylinders (n,), mm, touched at poses and distances rho along the roller's axis, both (n,)."""
        touch = self._touch(pose, rho)
        return np.asarray(np.hypot(rho, pose.y - self.side * touch.radius * touch.sine))

    def reached(self, pose: Pose, r: Array | float) -> Array:
        """Distance along the roller's axis, mm (n,), at which the cylinder r is touched at poses; as `on` raises."""
        r = np.broadcast_to(np.asarray(r, dtype=float), pose.y.shape)
        if self.radial:
            return distance(r, pose.z1, self.radius)
        rho = r
        for _ in range(NEWTON):
            touch = self._touch(pose, rho)
            q = pose.y - self.side * touch.radius * touch.sine
            step = (rho * rho + q * q - r * r) / (2.0 * self._outward(touch, rho, q))
            rho = np.maximum(rho - step, 0.5 * rho)
            if not (np.abs(step) > SETTLED * r).any():
                return rho
        raise CurveError("the roller does not touch a cylinder about the axis at one place", 0.0)

    def _outward(self, touch: _Touch, rho: Array, q: Array) -> Array:
        """Half the derivative of r^2 by rho (n,): rho + q q_2."""
        turn = self._turn(touch)
        found: Array = rho - self.side * q * (self.slope * touch.sine + touch.radius * touch.cosine * turn)
        return found

    def _turn(self, touch: _Touch) -> Array:
        """Derivative of the contact's angle by rho (n,), rad/mm."""
        found: Array = -(1.0 + self.slope**2) * touch.sine / (touch.w * touch.beside)
        return found

    def pressure(self, theta: Array, rho: Array, at: Side = 1) -> Array:
        """Pressure angle (n,), rad, between the contact force, seen along the roller, and the way of its axis.

        It is taken at distances rho along the roller, mm, and above 0 where the cam drives a rise.
        """
        return self.steepness(self.pose(theta, at), rho)

    def steepness(self, pose: Pose, rho: Array) -> Array:
        """Pressure angle (n,), rad, at poses and distances rho along the roller."""
        touch = self._touch(pose, rho)
        return np.asarray(np.arctan2(touch.sine * touch.w, touch.cosine * touch.w) + pose.lean)

    def normal(self, contact: Contact, theta: Array) -> Array:
        """Normals (n, 3) of the metal, outwards, at contacts at shaft angles theta (n,)."""
        sine, cosine = np.sin(contact.angle), np.cos(contact.angle)
        across = -self.side * np.column_stack([sine * np.sin(theta), -sine * np.cos(theta), cosine])
        if self.taper == 0.0:
            return across
        outward = np.column_stack([np.cos(theta), np.sin(theta), np.zeros_like(theta)])
        return math.cos(self.taper) * across + math.sin(self.taper) * outward

    def sweep(self, contact: Contact, theta: Array) -> Array:
        """Derivative of the polar angle by the shaft angle on a cylinder (n,): D cos d cos a/(rho + q q_2)."""
        pose = self.pose(theta)
        touch = self._touch(pose, contact.rho)
        q = pose.y - self.side * touch.radius * touch.sine
        share = math.cos(self.taper) * touch.cosine / self._outward(touch, contact.rho, q)
        return np.asarray(contact.regular * share)

    def curvature(self, theta: Array, rho: Array, at: Side = 1) -> Array:
        """Sum of both bodies' curvatures across the line of contact of a regular flank, 1/mm (n,).

        It is M (1 + (R sin a/(M cos d))^2)/(R D).
        """
        return self.bent(self.pose(theta, at), rho)

    def bent(self, pose: Pose, rho: Array) -> Array:
        """`curvature` at poses and distances rho along the roller, of shapes that go together."""
        touch = self._touch(pose, rho)
        m = touch.w * touch.beside
        part = 1.0 + (touch.radius * touch.sine / (m * math.cos(self.taper))) ** 2
        return np.asarray(m * part / (touch.radius * self.regularity(pose, rho)))

    def regularity(self, pose: Pose, rho: Array) -> Array:
        """D, mm, at poses and distances rho along the roller, of shapes that go together."""
        radius, slope = self.size(rho), self.slope
        along = rho + radius * slope + pose.y1
        square = along * along + pose.z1 * pose.z1
        w = np.sqrt(square)
        shift = self.side * pose.y * slope / w
        beside = np.sqrt(1.0 - shift * shift)
        # w cos a and w sin a
        cosine, sine = along * beside - pose.z1 * shift, pose.z1 * beside + along * shift
        reach, spread = self.side * radius, 1.0 + slope * slope
        bend = reach * cosine * pose.z2 - reach * (sine * pose.y2 - self.side * slope * pose.y1 * w)
        turn = reach * pose.y * sine * w - reach * reach * sine * sine
        plain = w * beside - radius * slope * cosine / w - bend / (square * beside)
        return np.asarray((plain + spread * turn / (square * beside * w)) * math.sqrt(spread))


def distance(r: Array, v: Array, radius: float) -> Array:
    """Distance rho along a roller on a radius, mm (n,), at which it touches the cylinder r where z' is v, mm (n,)."""
    apart = (r - v) * (r + v)
    root = np.sqrt(apart * apart + 4.0 * v * v * (r - radius) * (r + radius))
    # of the two forms of the same root the one that does not cancel
    steep = 2.0 * v * v * (r - radius) * (r + radius) / np.where(apart < 0.0, root - apart, 1.0)
    return np.asarray(np.sqrt(np.where(apart < 0.0, steep, 0.5 * (apart + root))))
