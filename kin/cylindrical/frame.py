"""The exact flank of a drum in closed form: the points where a roller touches it.

A point at rho on the roller's axis, which is at (y, z), moves seen from the cam by V = -y e_r + (rho + y') e_t + z' k
per radian. There the roller has the radius R, which grows by g = tan delta along it. A normal of contact is square to V
and to the cone (equation of meshing; Litvin, Gear Geometry): with A = rho + y' + R g, w = hypot(A, z') and
n = -sin a e_t + cos a k,

    A sin a - z' cos a = side y g,    flank = rho e_r + y e_t + z k + side R n,

side -1 below the roller and 1 above it; on a cylinder, or with y = 0, sin a = z'/w and cos a = A/w.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.elementary import Jet, atan2, sqrt

if TYPE_CHECKING:
    from kin.cylindrical.follower import DrumFollower
    from kin.law.contacts import Side
    from kin.law.piecewise import Side as KnotSide
    from kin.numeric.arrays import Array
    from kin.turned.guide import Axis

STEPS = 60  # of the fixed point that finds a place along the roller, at most
SETTLED = 1e-15  # of a radius


class Rates(NamedTuple):
    """Lift, mm or rad, and two derivatives by the shaft angle, per rad and rad^2, as jets of it."""

    lift: Jet
    slope: Jet
    bend: Jet


class On(NamedTuple):
    """A flank by its side, -1 below the roller and 1 above it, by how much that is larger, and how far beside, mm."""

    side: Side = -1
    clearance: float = 0.0
    beside: float = 0.0


class Contact(NamedTuple):
    """A roller on a flank: its axis, its radius, mm, and sine and cosine of the contact angle, as jets."""

    axis: Axis[Jet]
    radius: Jet
    sine: Jet
    cosine: Jet


def rates(follower: DrumFollower, theta: Array, order: int = 0, knot_side: KnotSide = 1) -> Rates:
    """Lift and derivatives at angles (n,), rad, with further derivatives up to `order`; at a knot from one side."""
    lift = follower.law.on(Jet.variable(theta, order + 2), knot_side)
    slope = lift.derivative()
    return Rates(Jet(lift.c[: order + 1]), Jet(slope.c[: order + 1]), slope.derivative())


def contact(follower: DrumFollower, rows: Rates, rho: Array | float | Jet, on: On) -> Contact:
    """Contact of a follower's roller at places rho, mm, along it."""
    growth, axis = follower.growth, follower.guide(on.beside).jets(*rows)
    radius = 0.0 * rows.lift + follower.radius_at(rho, on.clearance)
    along = axis.y1 + radius * growth + rho
    square = along * along + axis.z1 * axis.z1
    lean = axis.y * (on.side * growth)
    h = sqrt(square - lean * lean)
    return Contact(axis, radius, (lean * along + axis.z1 * h) / square, (along * h - lean * axis.z1) / square)


def pressure_jet(follower: DrumFollower, rows: Rates, rho: float, on: On) -> Jet:
    """Pressure angle, rad: of the normal, seen along the roller, against its path; above 0 where a rise is driven."""
    found, still = contact(follower, rows, rho, on), 0.0 * rows.lift
    way = follower.guide(on.beside).jets(rows.lift, still + 1.0, still)
    return atan2(found.sine * way.z1 + found.cosine * way.y1, found.cosine * way.z1 - found.sine * way.y1)


def flank_points(
    follower: DrumFollower, theta: Array, rho: Array | float, side: Side = -1, clearance: float = 0.0
) -> Array:
    """Points (n, 3), mm, that the roller touches at shaft angles, rad, and places along it, mm: untrimmed envelope."""
    across, up = (
        jet.c[0] for jet in _touched(contact(follower, rates(follower, theta), rho, On(side, clearance)), side)
    )
    sine, cosine = np.sin(theta), np.cos(theta)
    return np.stack([rho * cosine - across * sine, rho * sine + across * cosine, up], axis=-1)


def _touched(found: Contact, side: Side) -> tuple[Jet, Jet]:
    """Where the roller touches, across and up, mm."""
    return found.axis.y - found.radius * found.sine * side, found.axis.z + found.radius * found.cosine * side


def place_jets(follower: DrumFollower, rows: Rates, radius: float, on: On) -> tuple[Jet, Jet, Jet]:
    """Place along the roller, mm, and that of the contact across and up, mm, of the flank on a cylinder.

    Raises ValueError for a radius that the roller does not reach.
    """
    rho = 0.0 * rows.lift + radius
    for _ in range(STEPS):
        found = contact(follower, rows, rho, on)
        across, up = _touched(found, on.side)
        square, roller = radius**2 - across * across, float(np.max(found.radius.c[0]))
        if radius < roller or (square.c[0] < 0.0).any():
            raise ValueError(f"a roller of {roller:.6g} mm touches nothing on a cylinder of {radius:.6g} mm")
        before, rho = rho, sqrt(square)
        if float(np.abs(rho.c - before.c).max(initial=0.0)) <= SETTLED * radius:
            break
    return rho, across, up


def on_cylinder(
    follower: DrumFollower, theta: Array, radius: float, side: Side = -1, clearance: float = 0.0
) -> tuple[Array, Array, Array]:
    """Place along the roller, mm, polar angle, rad, and height, mm, (n,) each, of the flank on a cylinder.

    They are touched by the roller at shaft angles (n,), rad; raises ValueError for a radius that it does not reach.
    """
    rho, across, up = (jet.c[0] for jet in place_jets(follower, rates(follower, theta), radius, On(side, clearance)))
    return rho, theta + np.arctan2(across, rho), up
