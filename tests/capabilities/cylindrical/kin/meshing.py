"""Contact angle, regularity and curvature of a drum's exact flank, from the contact in `kin.cylindrical.frame`.

In the words of that module, the derivatives

    a' = (-sin a y'' + cos a z'' + side y' g)/h    by the shaft angle,    h = cos a A + sin a z'
    a. = -sin a (1 + g^2)/h                        along the roller

follow both tangents of the flank. Their product along its normal is D, above 0 where the flank is regular: for a
cylinder with y = 0 it is w - side R rho S''/w^2 - R^2 S'^2/w^3, and the curvature of flank against roller across the
line of contact is w (1 + (R sin a/w)^2)/(R D). Shaft angles are (n,), rad, places along the roller mm.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.frame import On, contact, rates

if TYPE_CHECKING:
    from kin.cylindrical.follower import DrumFollower
    from kin.cylindrical.frame import Rates
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array
    from kin.numeric.elementary import Jet


class _Tangents(NamedTuple):
    """D, mm, the square of the tangent by the place along the roller, and how fast the roller leaves a point, mm."""

    product: Jet
    square: Jet
    leaving: Jet


def _tangents(follower: DrumFollower, rows: Rates, rho: Array | float, on: On) -> _Tangents:
    side, growth = on.side, follower.growth
    (y, _, y1, z1, y2, z2), radius, sine, cosine = contact(follower, rows, rho, on)
    h = cosine * (y1 + radius * growth + rho) + sine * z1
    place, more = y - radius * sine * side, 1.0 + growth**2
    turned = (cosine * z2 - sine * y2) * side + y1 * growth
    by_angle, by_place = turned * side / h * radius, sine / h * radius * -more
    # both tangents in (e_r, e_t, k); the cone's normal is that of contact, with -growth along e_r
    first = (-place, y1 - cosine * by_angle * side + rho, z1 - sine * by_angle * side)
    last = (-(sine * growth + cosine * by_place) * side, (cosine * growth - sine * by_place) * side)
    cross = (
        first[1] * last[1] - first[2] * last[0],
        first[2] - first[0] * last[1],
        first[0] * last[0] - first[1],
    )
    product = (cross[0] * (side * growth) + cross[1] * sine - cross[2] * cosine) / more**0.5
    leaving = h * (h - radius * cosine * growth) / radius - turned + sine * place * (side * more)
    return _Tangents(product, last[0] * last[0] + last[1] * last[1] + 1.0, leaving / more**0.5)


def regularity_jet(follower: DrumFollower, rows: Rates, rho: float, on: On) -> Jet:
    """Regularity D, mm, of a flank at the place rho, mm, along the roller."""
    return _tangents(follower, rows, rho, on).product


def contact_angles(follower: DrumFollower, theta: Array, rho: Array | float, side: Side = -1) -> Array:
    """Contact angles a (n,), rad."""
    found = contact(follower, rates(follower, theta), rho, On(side))
    angles: Array = np.arctan2(found.sine.c[0], found.cosine.c[0])
    return angles


def regularity(follower: DrumFollower, theta: Array, rho: Array | float, side: Side = -1) -> Array:
    """Regularity D (n,), mm: the flank is undercut where it is below 0."""
    values: Array = _tangents(follower, rates(follower, theta), rho, On(side)).product.c[0]
    return values


def relative_curvature(follower: DrumFollower, theta: Array, rho: Array | float, side: Side = -1) -> Array:
    """Curvature of flank against roller across the line of contact (n,), 1/mm.

    A line that moves on by D over the length of its tangent leaves half `leaving` between roller and flank behind.
    """
    found = _tangents(follower, rates(follower, theta), rho, On(side))
    curvature: Array = (found.leaving * found.square / (found.product * found.product)).c[0]
    return curvature
