"""The exact flank of an indexing cam, in closed form: what one roller leaves, and where it is in any layer.

A point of a roller's axis moves against the cam by A e_t + B m (`camgeo.capabilities.indexing.forms`). The roller
leaves the places at which its normals are square to that motion (F. L. Litvin, Gear Geometry and Applied Theory, 1994,
equation of meshing). With w = hypot(A, B) and side -1 with the metal below, 1 with the metal above

    sin a = B/w,  cos a = A/w,   tau = cos a e_t + sin a m,   n = -sin a e_t + cos a m,   p = axis + side R n

The index 1 is a derivative by theta, 2 by rho. The frame g, tau, n turns by n_1 = T tau + G g, n_2 = -a_2 tau,
tau_1 = -T n + K g and g_1 = -K tau - G n, where T = tilt - a_1 and G = -w a_2. It follows that

    p_1 = P tau + Q g,  P = w + side R T,  Q = slip + side R G;     p_2 = g - side R a_2 tau

and |p_1 x p_2| = D with D = P + side R a_2 Q: the flank is regular where D > 0, and undercut where D < 0. The curvature
of flank and roller together across the line of contact is w (1 + (R a_2)^2)/(R D).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.indexing.forms import Number, Pose, directed, length_of
from camgeo.curve.curve import CurveError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.forms import Barrel, Globoid, Vector
    from camgeo.capabilities.indexing.law import IndexLaw
    from kin.law.piecewise import Side
    from kin.numeric.arrays import Array, Indices

NEWTON, SETTLED = 60, 1e-13  # steps, and the share of a layer by which the last one moves
THERE = 1e-6  # of a layer, by which the place that settles may miss it


class Contact(NamedTuple):
    """Points of a flank, arrays (n,): where a roller touches it, and how.

    rho      distance along the roller's axis, mm: from the cam's of a barrel, from the turret's of a globoid
    w        layer, mm
    phi, h   polar angle, rad, unrolled with the shaft angle, and height in the layer, mm or rad
    z        height over the lower face, mm
    angle    angle a of the contact, rad
    regular  D, mm: below 0 the flank turns back, and is undercut
    """

    rho: Array
    w: Array
    phi: Array
    h: Array
    z: Array
    angle: Array
    regular: Array

    def at(self, index: Indices) -> Contact:
        """Some of the points."""
        return Contact(*(part[index] for part in self))


class Touch(NamedTuple):
    """First derivatives at contacts, arrays or balls, by the letters of the docstring of this module."""

    sine: Number
    cosine: Number
    w: Number
    w1: Number
    w2: Number
    a1: Number
    a2: Number
    turn: Number  # T
    bend: Number  # G
    along: Number  # P
    beside: Number  # Q
    regular: Number  # D


@dataclass(frozen=True, eq=False)
class Flank:
    """The flank of a roller of a radius, mm, with the metal below it (`side` -1) or above it (1).

    `law` is S, rad, over any shaft angle, rad; the roller stands at `start`, rad, where S is 0. Its path is
    endless: other rollers of the turret are where it is whole turns of the cam further on.
    """

    form: Barrel | Globoid
    law: IndexLaw
    start: float
    radius: float
    side: int

    @property
    def name(self) -> str:
        """`lower` with the metal below the roller, `upper` with the metal above it."""
        return "lower" if self.side < 0 else "upper"

    def pose(self, theta: Array, at: Side = 1) -> Pose:
        """The turret at shaft angles (n,), rad; at a break of one side."""
        return Pose.at(self.law.derivatives(theta, 3, at), self.start)

    def psi(self, theta: Array) -> Array:
        """Angle of the roller on the turret, rad (n,)."""
        return np.asarray(self.law.derivatives(theta, 0)[0] + self.start)

    def touch(self, pose: Pose, rho: Number) -> Touch:
        """First derivatives at distances rho along the roller, of arrays or balls."""
        speed, reach = self.form.speed(pose, rho), self.side * self.radius
        w = length_of(speed.a, speed.b)
        inverse = w**-1
        sine, cosine = directed(speed.a, speed.b, inverse)
        w1, w2 = (cosine * a + sine * b for a, b in ((speed.a1, speed.b1), (speed.a2, speed.b2)))
        a1, a2 = ((cosine * b - sine * a) * inverse for a, b in ((speed.a1, speed.b1), (speed.a2, speed.b2)))
        turn, bend = self.form.tilt(pose)[0] - a1, w * a2 * -1.0
        along, beside = w + turn * reach, self.form.slip(pose, rho)[0] + bend * reach
        return Touch(sine, cosine, w, w1, w2, a1, a2, turn, bend, along, beside, along + a2 * beside * reach)

    def place(self, pose: Pose, rho: Number, sine: Number, cosine: Number) -> Vector:
        """Places of contacts along e_r, e_t and k, mm, of arrays or balls."""
        normal, reach = self.form.axes(pose, sine, cosine)[2], self.side * self.radius
        x, y, z = (at + part * reach for at, part in zip(self.form.axis(pose, rho), normal, strict=True))
        return x, y, z

    def outwards(self, pose: Pose, rho: Number, touch: Touch) -> tuple[Number, Vector]:
        """Layers of contacts, and the layers' unit normals along g, tau and n, of arrays or balls."""
        w, normal = self.form.layer(self.place(pose, rho, touch.sine, touch.cosine))
        axes = self.form.axes(pose, touch.sine, touch.cosine)
        g, tau, n = (sum(a * b for a, b in zip(axis, normal, strict=True)) for axis in axes)
        return w, (g, tau, n)

    def rising(self, touch: Touch, outwards: Vector) -> tuple[Number, Number]:
        """Derivatives of the layer by theta and by rho, of arrays or balls."""
        reach = self.side * self.radius
        by_theta = touch.along * outwards[1] + touch.beside * outwards[0]
        return by_theta, outwards[0] - touch.a2 * outwards[1] * reach

    def along(self, theta: Array, rho: Array, at: Side = 1) -> Contact:
        """Contacts at shaft angles theta and distances rho along the roller, both (n,)."""
        return self.contact(theta, self.pose(theta, at), rho)

    def contact(self, theta: Array, pose: Pose, rho: Array) -> Contact:
        """Contacts of a turret at shaft angles theta, at distances rho along the roller, both (n,)."""
        touch = self.touch(pose, rho)
        place = self.place(pose, rho, touch.sine, touch.cosine)
        phi = theta + np.arctan2(place[1], place[0])
        angle = np.arctan2(touch.sine, touch.cosine)
        layer = self.form.layer(place)[0]
        return Contact(rho, layer, phi, self.form.height_of(place), place[2], angle, touch.regular)

    def on(self, theta: Array, w: Array | float, at: Side = 1) -> Contact:
        """Contacts at shaft angles theta (n,) in layers w, mm; raises CurveError where a layer is not touched."""
        return self.touching(theta, self.pose(theta, at), w)

    def touching(self, theta: Array, pose: Pose, w: Array | float) -> Contact:
        """Contacts of a turret at shaft angles theta (n,) in layers w, mm; raises as `on` does."""
        rho = self.reached(pose, w)
        if not np.isfinite(rho).all():
            where = float(np.asarray(theta)[~np.isfinite(rho)][0])
            raise CurveError("the roller does not touch a layer of the cam", where)
        return self.contact(theta, pose, rho)

    def reached(self, pose: Pose, w: Array | float) -> Array:
        """Distance along the roller, mm (n,), at which layers w, mm, are touched; nan where they are not."""
        w = np.broadcast_to(np.asarray(w, dtype=float), pose.sine.shape)
        rho = w.copy()
        open_: Indices = np.arange(w.size)
        with np.errstate(all="ignore"):
            for _ in range(NEWTON):
                own, part, layer_of = rho[open_], pose.of(open_), w[open_]
                touch = self.touch(part, own)
                layer, outwards = self.outwards(part, own, touch)
                step = (layer - layer_of) / self.rising(touch, outwards)[1]
                step = np.where(np.isfinite(step), np.clip(step, -0.5 * own, 0.5 * own), 0.5 * own)
                settled = np.abs(step) <= SETTLED * layer_of
                # where no place is touched, rho may shrink to nothing and settle there
                rho[open_] = np.where(settled & ~(np.abs(layer - layer_of) < THERE * layer_of), np.nan, own - step)
                open_ = open_[~settled]
                if not open_.size:
                    break
        rho[open_] = np.nan
        return rho

    def pressure(self, theta: Array, rho: Array, at: Side = 1) -> Array:
        """Pressure angle (n,), rad, between the contact force, seen along the roller, and the way of its axis.

        It is taken at distances rho along the roller, mm, and above 0 where the cam drives the turret on.
        """
        pose = self.pose(theta, at)
        speed = self.form.speed(pose, rho)
        psi = self.law.derivatives(theta, 0, at)[0] + self.start
        return np.asarray(np.arctan2(speed.b, speed.a) + self.form.lean(psi))

    def curvature(self, theta: Array, rho: Array, at: Side = 1) -> Array:
        """Sum of both bodies' curvatures across the line of contact of a regular flank, 1/mm (n,)."""
        touch = self.touch(self.pose(theta, at), rho)
        part = 1.0 + (self.radius * touch.a2) ** 2
        return np.asarray(touch.w * part / (self.radius * touch.regular))
