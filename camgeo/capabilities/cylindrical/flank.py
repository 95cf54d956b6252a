"""The exact flank of a cylindrical cam, in closed form: what one roller leaves, and where it is on any cylinder.

The cam stands still, its axis is z, and the roller's axis runs round it along e_r(theta) at the height level + S. At
the distance rho from the cam's axis, with v = S' and w = hypot(rho, v), the roller touches the flank along its normal

    n = -sin a e_t + cos a k,     sin a = v/w,  cos a = rho/w,
    p = rho e_r + (level + S) k + side R n

as the normals of the roller there must be square to the motion of its axis, rho e_t + v k (F. L. Litvin, Gear Geometry
and Applied Theory, 1994, equation of meshing). On the cylinder r the same flank is explicit:

    w^2 = ((r^2 + v^2) + sqrt((r^2 - v^2)^2 + 4 v^2 (r^2 - R^2)))/2,     sin f = -side R sin a/r,  phi = theta + f

p_theta x p_rho = D n; the flank is regular where D > 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Piecewise, Side
    from kin.numeric.arrays import Array


class Contact(NamedTuple):
    """Points of a flank, arrays of one shape: where a roller touches it, and how.

    rho        distance along the roller's axis from the cam's, mm
    r, phi, z  cylindrical coordinates of the point, mm and rad
    angle      pressure angle, rad: above 0 where the cam drives a rise
    regular    D, mm: below 0 the flank turns back, and is undercut
    """

    rho: Array
    r: Array
    phi: Array
    z: Array
    angle: Array
    regular: Array


@dataclass(frozen=True, eq=False)
class Flank:
    """The flank of a roller of a radius, mm, below it (`side` -1) or above it (1).

    `law` is S, mm, over the shaft angle, rad; `level` is the height of the roller's axis at S = 0, mm.
    """

    law: Piecewise
    level: float
    radius: float
    side: int

    def along(self, theta: Array, rho: Array, at: Side = 1) -> Contact:
        """Contacts at shaft angles theta and distances rho along the roller's axis, both (n,)."""
        s, v, bend = self.law.derivatives(theta, 2, at)
        w = np.hypot(rho, v)
        sine, cosine = v / w, rho / w
        r = np.hypot(rho, self.radius * sine)
        phi = theta + np.arctan2(-self.side * self.radius * sine, rho)
        z = self.level + s + self.side * self.radius * cosine
        return Contact(rho, r, phi, z, np.arctan2(v, rho), regularity(rho, v, bend, self.side * self.radius))

    def on(self, theta: Array, r: Array | float, at: Side = 1) -> Contact:
        """Contacts at shaft angles theta (n,) on the cylinder of the radius r, mm, at least the roller's."""
        v = self.law.derivatives(theta, 1, at)[1]
        return self.along(theta, distance(np.broadcast_to(np.asarray(r, dtype=float), v.shape), v, self.radius), at)

    def normal(self, contact: Contact, theta: Array) -> Array:
        """Normals (n, 3) of the metal, outwards, at contacts at shaft angles theta (n,)."""
        sine, cosine = np.sin(contact.angle), np.cos(contact.angle)
        return -self.side * np.column_stack([sine * np.sin(theta), -sine * np.cos(theta), cosine])

    def sweep(self, contact: Contact) -> Array:
        """Derivative of the polar angle by the shaft angle on a cylinder (n,): D w/(w^2 - R^2 sin^2 a)."""
        w = contact.rho / np.cos(contact.angle)
        return np.asarray(contact.regular * w / (w * w - (self.radius * np.sin(contact.angle)) ** 2))

    def curvature(self, theta: Array, rho: Array, at: Side = 1) -> Array:
        """Sum of both bodies' curvatures across the line of contact of a regular flank, 1/mm (n,).

        It is w (1 + (R sin a/w)^2)/(R D).
        """
        _, v, bend = self.law.derivatives(theta, 2, at)
        w = np.hypot(rho, v)
        part = 1.0 + (self.radius * v / (w * w)) ** 2
        return np.asarray(w * part / (self.radius * regularity(rho, v, bend, self.side * self.radius)))


def distance(r: Array, v: Array, radius: float) -> Array:
    """Distance rho along the roller's axis, mm (n,), at which the cylinder r is touched where S' is v, both mm (n,)."""
    apart = (r - v) * (r + v)
    root = np.sqrt(apart * apart + 4.0 * v * v * (r - radius) * (r + radius))
    # of the two forms of the same root the one that does not cancel
    steep = 2.0 * v * v * (r - radius) * (r + radius) / np.where(apart < 0.0, root - apart, 1.0)
    return np.asarray(np.sqrt(np.where(apart < 0.0, steep, 0.5 * (apart + root))))


def regularity(rho: Array, v: Array, bend: Array, reach: float) -> Array:
    """D, mm (n,), of a flank `reach` mm above the roller's axis, from rho, S' and S'' (n,).

    D = w - reach rho S''/w^2 - reach^2 S'^2/w^3, w^2 = rho^2 + S'^2.
    """
    square = rho * rho + v * v
    w = np.sqrt(square)
    return np.asarray(w - reach * rho * bend / square - reach * reach * v * v / (square * w))
