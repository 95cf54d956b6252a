"""Least sizes of disc cams for given pressure angles or a given radius of curvature.

A pressure angle bounds where the shaft may lie, seen from the follower: half planes, one for every shaft angle. For a
stem the worst of each kind is one number; for an arm the nearest point to the roller's lowest place is sought, and the
worst half planes are added until none is broken by more than rounding (cutting planes; J. E. Kelley, SIAM J. 8, 1960).
Each size found is a lower bound of what would do, and does, up to rounding.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curvature import least_radius, roots
from camgeo.curve.curve import Curve
from camgeo.curve.disc import face_shape
from camgeo.curve.extremes import greatest, least
from camgeo.curve.moving_frame import Oscillating, Translating
from camgeo.curve.rates import cut, stretches
from kin.law.programme import IntentError
from kin.numeric import elementary
from kin.numeric.elementary import Jet

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Shape, Side
    from camgeo.curve.disc import Face
    from camgeo.curve.moving_frame import Displacement
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array

_CUTS = 60  # pairs of cutting planes
_BROKEN = 1e-12  # of the arm's length: what is left of a broken half plane
_FEASIBLE = 1e-11  # likewise, of the corners that are tried
_DOUBLINGS = 30  # of a size, before it is given up
_PRECISE = 1e-13  # of a size


def _demand_angles(rising: float, falling: float) -> None:
    for name, angle in (("at_most", rising), ("on_return", falling)):
        if not 0.0 < angle < 0.5 * math.pi:
            raise IntentError(
                f"a pressure angle to keep below lies between 0 and 90 degrees, not {math.degrees(angle):.6g}",
                f"sizing.pressure-angle.{name}",
            )


def stem_needs(motion: Displacement, rising: float, falling: float) -> tuple[float, float]:
    """A_r and A_f, mm: ``d + e cot alpha_r >= A_r`` and ``d - e cot alpha_f >= A_f`` keep both limits (rad)."""
    _demand_angles(rising, falling)

    def need(cotangent: float) -> float:
        def figure(tau: Series, side: Side = 1) -> Series:
            s = motion.on(tau, side)
            v = s.derivative()
            return v * cotangent - cut(s, v.order)

        found = greatest(figure, stretches(motion))
        return found.value

    return need(1.0 / math.tan(rising)), need(-1.0 / math.tan(falling))


def least_stem(motion: Displacement, rising: float, falling: float, offset: float | None = None) -> Translating:
    """Stem with the least prime circle that keeps the pressure angle (rad) on the rise and on the return.

    The best offset is found, or the given one kept. The foot d is positive whatever the motion.
    """
    up, down = stem_needs(motion, rising, falling)
    a, b = 1.0 / math.tan(rising), 1.0 / math.tan(falling)
    if offset is not None:
        return Translating(_positive(max(up - offset * a, down + offset * b)), offset)
    for need, angle, sign, other in ((up, rising, 1.0, b), (down, falling, -1.0, a)):
        # foot of the perpendicular from the shaft on one limit's edge, if the other limit is kept there
        d, e = need * math.sin(angle) ** 2, sign * need * math.sin(angle) * math.cos(angle)
        if d - sign * other * e >= (down if sign > 0 else up):
            return Translating(_positive(d), e)
    e = (up - down) / (a + b)
    return Translating(_positive(up - e * a), e)


def _positive(foot: float) -> float:
    if not foot > 0.0:
        raise IntentError("a motion that stands still needs no pressure angle; give a base radius", "sizing")
    return foot


def least_arm(motion: Displacement, length: float, side: int, rising: float, falling: float) -> Oscillating:
    """Arm of a length, mm, with the pivot that gives the least prime circle within both pressure angles (rad).

    Raises IntentError where no pivot keeps them.
    """
    _demand_angles(rising, falling)
    ahead, behind = (rising, falling) if side > 0 else (falling, rising)

    def planes(tau: Series, at: Side = 1) -> list[tuple[Series, Series, Series]]:
        """Rows (x, y, c) of the half planes ``x X + y Y >= c``."""
        s = motion.on(tau, at)
        pace = (s.derivative() * float(side) + 1.0) * length
        s = cut(s, pace.order)
        first, second = s - ahead, s + behind
        return [
            (elementary.cos(first), -elementary.sin(first), pace * math.cos(ahead)),
            (-elementary.cos(second), elementary.sin(second), pace * -math.cos(behind)),
        ]

    rows = np.empty((0, 3))
    shaft = np.array([length, 0.0])
    for _ in range(_CUTS):
        worst, added = 0.0, []
        for kind in (0, 1):

            def broken(tau: Series, at: Side = 1, kind: int = kind, shaft: Array = shaft) -> Series:
                x, y, c = planes(tau, at)[kind]
                return c - x * float(shaft[0]) - y * float(shaft[1])

            found = greatest(broken, stretches(motion))
            worst = max(worst, found.value)
            added.append([float(row.c[0, 0]) for row in planes(Jet.variable(found.at, 1))[kind]])
        if worst <= _BROKEN * length:
            break
        rows = np.vstack([rows, added])
        to, before = np.array([length, 0.0]), shaft
        shaft = _nearest(rows, to, _FEASIBLE * length)
        if bool((shaft == before).all()):  # a corner that breaks a plane at hand, and was let pass
            shaft = _nearest(rows, to, 0.5 * _BROKEN * length)
    else:
        raise IntentError("the least prime circle of the arm was not found", "sizing")
    x, y = shaft
    return Oscillating(math.hypot(x, y), length, math.atan2(y, x), side)


def _nearest(rows: Array, to: Array, slack: float) -> Array:
    """Point nearest to a given one (2,) in the meet of half planes, rows (m, 3); IntentError where that is empty."""
    normals, level = rows[:, :2], rows[:, 2]
    feet = to + np.maximum(level - normals @ to, 0.0)[:, None] * normals
    i, j = np.triu_indices(len(rows), 1)
    determinant = normals[i, 0] * normals[j, 1] - normals[i, 1] * normals[j, 0]
    i, j, determinant = (part[np.abs(determinant) > 0.0] for part in (i, j, determinant))
    corners = np.column_stack(
        [
            (level[i] * normals[j, 1] - level[j] * normals[i, 1]) / determinant,
            (normals[i, 0] * level[j] - normals[j, 0] * level[i]) / determinant,
        ]
    )
    points = np.concatenate([feet, corners])
    kept = points[(points @ normals.T >= level - slack).all(axis=1)]
    if not kept.size:
        raise IntentError(
            "no pivot keeps the pressure angles with this arm; a smaller swing, a longer rise or wider limits do",
            "sizing.pressure-angle",
        )
    nearest: Array = kept[np.argmin(np.hypot(*(kept - to).T))]
    return nearest


def least_face(face: Face, radius: float) -> float:
    """Least base radius, mm, at which a flat face's cam has no radius of curvature below the one given.

    The radius of curvature grows as the base does; an oscillating face keeps its place and moves its offset.
    """
    return face.base + radius - least_radius(Curve.whole(face_shape(face)))[0]


def least_prime(shape: Callable[[float], Shape], radius: float, start: float) -> float:
    """Prime circle from `start` on, mm, at which the pitch curve's least convex radius comes up to `radius`.

    `shape` makes the pitch curve of a prime circle. What lies just below the size found is too sharp.
    """

    def short(prime: Array) -> Array:
        found = [least_radius(Curve.whole(shape(float(p))))[0] - radius for p in prime]
        return np.array(found)

    low = np.array([start])
    if short(low)[0] >= 0.0:
        return start
    high = 2.0 * low
    for _ in range(_DOUBLINGS):
        if short(high)[0] >= 0.0:
            break
        low, high = high, 2.0 * high
    else:
        raise IntentError(f"no prime circle up to {high[0]:.6g} mm gives a radius of {radius:.6g} mm", "sizing")
    return float(roots(short, low, high, (short(low), short(high)), _PRECISE)[0])


def face_needed(face: Face) -> tuple[float, float]:
    """Least and greatest place of contact along a flat face, mm."""
    over = stretches(face)
    return least(face.contact, over).value, greatest(face.contact, over).value


def tappet_radius(face: Face, axial_offset: float = 0.0) -> float:
    """Radius of a round tappet that the contact never leaves, its axis beside the cam's plane by an offset, mm."""
    return math.hypot(max(abs(place) for place in face_needed(face)), axial_offset)
