"""The exact flank of a drum in closed form: where a roller touches it, how it bends, where it is undercut.

A point of the roller's axis at rho moves, seen from the cam, by V = rho e_t + S' k per radian. The normal of contact is
square to it and to the axis: with w = hypot(rho, S'), sin a = S'/w and cos a = rho/w,

    n = -sin a e_t + cos a k,    flank = rho e_r + (level + S) k + side R n,

side -1 below the roller and 1 above it (equation of meshing; Litvin, Gear Geometry). Both partial derivatives of the
flank are square to n and span

    D = w - side R rho S''/w^2 - R^2 S'^2/w^3,

above 0 where the flank is regular; the curvature of flank against roller across the line of contact is
w (1 + (R sin a/w)^2)/(R D).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.elementary import Jet, sqrt

if TYPE_CHECKING:
    from kin.cylindrical.follower import DrumFollower
    from kin.law.contacts import Side
    from kin.law.piecewise import Side as KnotSide
    from kin.numeric.arrays import Array


class Rates(NamedTuple):
    """Lift, mm, and two derivatives by the shaft angle, per rad and rad^2, as jets of it."""

    lift: Jet
    slope: Jet
    bend: Jet


def rates(follower: DrumFollower, theta: Array, order: int = 0, knot_side: KnotSide = 1) -> Rates:
    """Lift and derivatives at angles (n,), rad, with further derivatives up to `order`; at a knot from one side."""
    lift = follower.law.on(Jet.variable(theta, order + 2), knot_side)
    slope = lift.derivative()
    return Rates(Jet(lift.c[: order + 1]), Jet(slope.c[: order + 1]), slope.derivative())


def regularity_jet(rows: Rates, rho: float, radius: float, side: Side) -> Jet:
    """Regularity D, mm, of a flank of a roller of `radius`, mm, at the place rho, mm, along it."""
    square = rows.slope * rows.slope + rho * rho
    w = sqrt(square)
    return w - rows.bend * (side * radius * rho) / square - rows.slope * rows.slope * radius**2 / (square * w)


def contact_angles(follower: DrumFollower, theta: Array, rho: Array | float) -> Array:
    """Contact angle (n,), rad, at shaft angles (n,), rad, and places along the roller, mm: tan a = S'/rho."""
    angles: Array = np.arctan2(rates(follower, theta).slope.c[0], rho)
    return angles


def regularity(
    follower: DrumFollower, theta: Array, rho: Array | float, side: Side = -1, clearance: float = 0.0
) -> Array:
    """Regularity D (n,), mm, of a flank at shaft angles, rad, and places along the roller, mm: undercut below 0."""
    _, slope, bend = (jet.c[0] for jet in rates(follower, theta))
    radius, w = follower.radius + clearance, np.hypot(rho, slope)
    values: Array = w - side * radius * rho * bend / w**2 - (radius * slope) ** 2 / w**3
    return values


def relative_curvature(
    follower: DrumFollower, theta: Array, rho: Array | float, side: Side = -1, clearance: float = 0.0
) -> Array:
    """Curvature of flank against roller across the line of contact (n,), 1/mm, for the pressure of a line contact."""
    slope, radius = rates(follower, theta).slope.c[0], follower.radius + clearance
    w = np.hypot(rho, slope)
    spread = w * (1.0 + (radius * slope / w**2) ** 2)
    curvature: Array = spread / (radius * regularity(follower, theta, rho, side, clearance))
    return curvature


def flank_points(
    follower: DrumFollower, theta: Array, rho: Array | float, side: Side = -1, clearance: float = 0.0
) -> Array:
    """Points (n, 3), mm, that the roller touches at shaft angles, rad, and places along it, mm: untrimmed envelope."""
    lift, slope, _ = (jet.c[0] for jet in rates(follower, theta))
    w, out = np.hypot(rho, slope), side * (follower.radius + clearance)
    across, up = -out * slope / w, out * rho / w
    sine, cosine = np.sin(theta), np.cos(theta)
    return np.stack([rho * cosine - across * sine, rho * sine + across * cosine, follower.level + lift + up], axis=-1)


def along_roller(slope: Array | float, radius: float, roller: float) -> Array:
    """Places (n,), mm, along a roller at which it touches a flank on a cylinder of `radius`, mm, at slopes (n,)."""
    square = np.square(slope)
    root = np.sqrt((radius**2 + square) ** 2 - 4.0 * square * roller**2)
    place: Array = np.sqrt(0.5 * (radius**2 - square + root))
    return place


def on_cylinder(
    follower: DrumFollower, theta: Array, radius: float, side: Side = -1, clearance: float = 0.0
) -> tuple[Array, Array, Array]:
    """Place along the roller, mm, polar angle, rad, and height, mm, (n,) each, of the flank on a cylinder.

    They are touched by the roller at shaft angles (n,), rad; raises ValueError for a radius below the roller's.
    """
    roller = follower.radius + clearance
    if radius < roller:
        raise ValueError(f"a roller of {roller:.6g} mm touches nothing on a cylinder of {radius:.6g} mm")
    lift, slope, _ = (jet.c[0] for jet in rates(follower, theta))
    rho = along_roller(slope, radius, roller)
    w = np.hypot(rho, slope)
    phi = theta + np.arctan2(-side * roller * slope / w, rho)
    return rho, phi, follower.level + lift + side * roller * rho / w
