"""The contours of many cams from their sampled motions: the moving frame of a round touch, a face's support function.

Formulas as in `camgeo.curve.moving_frame`, `camgeo.curve.disc` and `camgeo.curve.support`, over arrays (m, n) of m
designs at n samples; lengths mm, angles rad. `sound` (m,) says which designs can be driven at all, where the exact
cam would raise IntentError.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from camgeo.capabilities.sweep.cams import EDGE

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Mask

_QUARTER = 0.5 * np.pi

Sizes: TypeAlias = "dict[str, Array]"


class Contours(NamedTuple):
    """m contours.

    slope     tangent of the pressure angle
    distance  of the contour from the shaft, squared, mm^2
    bend      curvature of the centre's path, 1/mm, for a round touch; None for a face
    radius    of curvature of the contour, mm, for a face; None for a round touch
    contact   place along a face, mm; None for a round touch
    spin      turns of a roller per turn of the shaft; None for a face and a point
    outside   (m,) whether the shaft lies outside
    lean      (m, 1) tangent of the pressure angle at which an eccentric stem begins to rise
    """

    sound: Mask
    slope: Array
    distance: Array
    bend: Array | None = None
    radius: Array | None = None
    contact: Array | None = None
    spin: Array | None = None
    outside: Mask | None = None
    lean: Array | None = None


def _centre_path(b: Array, a: Array, rates: tuple[Array, Array, Array | float]) -> tuple[Array, Array]:
    """Speed of the centre, mm/rad, and curvature of its path, 1/mm; `rates` are b', a' and tau'."""
    b1, a1, travel = rates
    square = a * a + b * b
    speed = np.sqrt(square)
    return speed, (travel + (b1 * a - a1 * b) / square) / speed


def _spin(sizes: Sizes, side: Side, speed: Array, travel: Array | float) -> Array | None:
    """Turns of a roller per turn of the shaft; None for a point."""
    return side * speed / sizes["radius"] - travel if (sizes["radius"] > 0.0).all() else None


def _stem(sizes: Sizes, side: Side, rows: Array) -> Contours:
    """Contours for a round touch on a stem: the centre at d + S along its line, d^2 = Rp^2 - e^2."""
    e, radius = sizes["offset"], side * sizes["radius"]
    prime = sizes["base"] + radius
    foot = np.sqrt(np.maximum((prime - e) * (prime + e), 0.0))
    b, a = foot + rows[0], rows[1] - e
    sound = ((prime > np.abs(e)) & (b.min(axis=1, keepdims=True) > 0.0))[:, 0]
    speed, bend = _centre_path(b, a, (rows[1], rows[2], 1.0))
    share = radius / speed
    distance = (b - share * b) ** 2 + (e + share * a) ** 2
    lean = np.abs(e) / np.maximum(foot, 1e-300)
    return Contours(sound, a / b, distance, bend, spin=_spin(sizes, side, speed, 1.0), lean=lean)


def _arm(sizes: Sizes, side: Side, rows: Array) -> Contours:
    """Contours for a round touch on an arm: psi = rest + S at the pivot, between the shaft and the arm."""
    pivot, length, sense, radius = sizes["pivot"], sizes["length"], sizes["side"], side * sizes["radius"]
    prime = sizes["base"] + radius
    low, high = (prime - pivot + length) * (prime + pivot - length), pivot + length - prime
    reached = (low > 0.0) & (high > 0.0) & (prime > 0.0)
    low, high = np.where(reached, low, 1.0), np.where(reached, high * (pivot + length + prime), 1.0)
    psi = 2.0 * np.arctan2(np.sqrt(low), np.sqrt(high)) + rows[0]
    sound = reached[:, 0] & (psi.min(axis=1) > 0.0) & (psi.max(axis=1) < np.pi)
    sine, cosine = np.sin(psi), np.cos(psi)
    b = pivot * sine
    a = length * rows[1] - sense * (pivot * cosine - length)
    travel = 1.0 + sense * rows[1]
    rates = pivot * cosine * rows[1], length * rows[2] + sense * b * rows[1], travel
    speed, bend = _centre_path(b, a, rates)
    # N = E(psi - 90 deg, in the arm's sense)(b - i a)/sigma, seen from the line to the pivot
    share = radius / speed
    x = pivot - length * cosine - share * (sine * b - sense * cosine * a)
    y = -sense * length * sine + share * (sine * a + sense * cosine * b)
    return Contours(sound, a / b, x * x + y * y, bend, spin=_spin(sizes, side, speed, travel))


def _stem_face(sizes: Sizes, side: Side, rows: Array) -> Contours:  # noqa: ARG001 - a table of one signature
    """Contours for a face on a stem, its normal turned ahead of travel by the tilt."""
    base, tilt, e = sizes["base"], sizes["tilt"], sizes["offset"]
    sine, cosine = np.sin(tilt), np.cos(tilt)
    p, q = base + cosine * rows[0], cosine * rows[1]
    level = (base - e * sine) / cosine
    contact = q + (rows[0] + level) * sine - e * cosine
    radius = base + cosine * (rows[0] + rows[2])
    sound = np.ones(len(p), dtype=np.bool_)
    slope = np.tan(tilt) + 0.0 * p
    return Contours(sound, slope, p * p + q * q, radius=radius, contact=contact)


def _arm_face(sizes: Sizes, side: Side, rows: Array) -> Contours:  # noqa: ARG001
    """Contours for a face on an arm, nearer the cam than its parallel through the pivot."""
    pivot, nearer, sense = sizes["pivot"], sizes["nearer"], sizes["side"]
    share = (sizes["base"] + nearer) / pivot
    reached = (share > 0.0) & (share < 1.0)
    psi = np.arcsin(np.where(reached, share, 0.5)) + rows[0]
    turn = 1.0 + sense * rows[1]
    sound = reached[:, 0] & (psi.min(axis=1) > 0.0) & (psi.max(axis=1) < _QUARTER) & (turn.min(axis=1) > 0.0)
    sine, cosine = pivot * np.sin(psi), pivot * np.cos(psi)
    p, q = sine - nearer, cosine * rows[1] / turn
    rate = (cosine * rows[2] - sine * rows[1] ** 2) / turn - q * sense * rows[2] / turn
    contact = cosine / turn
    return Contours(sound, nearer / contact, p * p + q * q, radius=p + rate / turn, contact=contact)


def plate(rows: Array) -> Contours:
    """Contours of plates by their support functions (p, p', p''), under a face at right angles to its travel."""
    p, q = rows[0], rows[1]
    outside = p.min(axis=1) < -EDGE * p.max(axis=1)
    sound = np.ones(len(p), dtype=np.bool_)
    return Contours(sound, 0.0 * p, p * p + q * q, radius=p + rows[2], contact=q, outside=outside)


GUIDED: dict[tuple[str, bool], Callable[[Sizes, Side, Array], Contours]] = {
    ("mm", True): _stem,
    ("deg", True): _arm,
    ("mm", False): _stem_face,
    ("deg", False): _arm_face,
}
"""Contours of guided followers, by the unit of the guide's motion and whether the touch is round."""
