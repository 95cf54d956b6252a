"""Checks of the intent and of the exact curve, before any file: what would be wrong however well it were written."""

from __future__ import annotations

import math
from dataclasses import replace
from operator import itemgetter
from typing import TYPE_CHECKING

import numpy as np

from camgeo.cams.flat_faced import SAME_BREADTH, spread
from camgeo.checks.declared import DIAMETER, FACE_WIDTH, PRESSURE, TRAVEL, WHEEL
from kin.numeric.angles import degrees
from kin.numeric.check import Check

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from camgeo.cams.family import ExactCam, Proof
    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.recipe.recipe import Recipe
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array

ZOOMS, ZOOM = 5, 32  # refinements about the worst sample, and parts into which each divides the interval
SAME = 1e-12  # of the greatest value: samples within this share of it count as equal


def motion_checks(exact: ExactCam) -> list[Check]:
    """Checks of the intended motion that the follower names, in its order: one for each surface, or one of the law."""
    proofs, checks = exact.proofs, []
    for name in exact.follower.checks:
        if name in proofs:
            checks.append(_proved(name, proofs[name]()))
        else:
            checks += [replace(MADE[name](exact, surface), surface=surface.name) for surface in exact.surfaces]
    return checks


def _proved(name: str, proof: Proof) -> Check:
    return Check(name, proof.ok, proof.value, proof.limit, proof.unit, proof.at_deg)


def _face_length(exact: ExactCam, surface: Surface) -> Check:
    """Check of the travel of contact along a flat face, mm; it reports the length and sets no limit."""
    if (proved := surface.extremes("contact")) is not None:
        least, most = proved
        further = max(proved, key=lambda bound: abs(bound.value))
        return Check(TRAVEL.name, True, most.value - least.value, None, "mm", degrees(further.at), "at_least")
    place = surface.place
    if place is None:
        raise TypeError("no contact travels along a face")
    t = spread(exact.breaks, 2.0 * math.pi)
    # the greatest of -place and of place, with their angles: the sum of the values is the travel
    low, high = greatest(lambda u: np.array([-1.0, 1.0])[:, None] * place(u), t)
    return Check(TRAVEL.name, True, low[0] + high[0], None, "mm", degrees(max(low, high)[1]), "at_least")


def _pressure_angle(exact: ExactCam, surface: Surface) -> Check:
    """Greatest angle between the contact normal and the direction in which the follower moves, degrees.

    At 90 degrees the cam cannot drive.
    """
    if (proved := surface.extremes("slope")) is not None:
        worst = max(proved, key=lambda bound: abs(bound.value))
        value, at = math.degrees(math.atan(abs(worst.value) + worst.slack)), worst.at
        return Check(PRESSURE.name, value < 90.0, value, 90.0, "deg", degrees(at))
    ((value, at),) = greatest(
        lambda t: np.degrees(np.abs(surface.pressure(t)))[None], spread(exact.breaks, 2.0 * math.pi)
    )
    return Check(PRESSURE.name, value < 90.0, value, 90.0, "deg", exact.motion.shaft_deg(at))


def _constant_diameter(exact: ExactCam, surface: Surface) -> Check:
    """Constancy of the pitch curve's diameters through the shaft, for two opposite rollers."""
    t = spread(np.mod(exact.breaks, math.pi), math.pi)
    near, far = (np.hypot(*surface.base.sample(t + by).point.T) for by in (0.0, math.pi))
    diameter = near + far
    mean = 0.5 * float(diameter.max() + diameter.min())
    off = np.abs(diameter - mean)
    worst, limit = int(np.argmax(off)), SAME_BREADTH * mean
    return Check(DIAMETER.name, bool(off[worst] <= limit), float(off[worst]), limit, "mm", degrees(float(t[worst])))


def _face_width(exact: ExactCam, surface: Surface) -> Check:
    """Whether the contact stays on the face, whose width is centred on the stem's axis."""
    value, at = needed_width(surface)
    width = exact.follower.width
    return Check(FACE_WIDTH.name, width is None or value <= width, value, width, "mm", at)


def needed_width(surface: Surface) -> tuple[float, float]:
    """Least width of a face, centred on the stem's axis, that the contact does not leave, mm, and its angle, degrees.

    Raises TypeError for a surface whose places of contact are no series, as a yoke's, or that no flat face touches.
    """
    proved = surface.extremes("contact")
    if proved is None:
        raise TypeError("no contact travels along a face")
    worst = max(proved, key=lambda bound: abs(bound.value))
    return 2.0 * (abs(worst.value) + worst.slack), degrees(worst.at)


def wheel_checks(recipe: Recipe, exact: ExactCam, contours: Iterable[tuple[Surface, Curve]]) -> list[Check]:
    """Check of each surface on the grinding wheel: the contour's least hollow radius must be at least the wheel's, mm.

    Empty where the recipe has no wheel. Raises CurveError where the proof of a radius does not end.
    """
    checks: list[Check] = []
    wheel = recipe.wheel
    if wheel is None:
        return checks
    for surface, contour in contours:
        radius, place = hollow_radius(surface.side, contour)
        at_deg = None if math.isinf(radius) else exact.motion.shaft_deg(place)
        detail, name = "the contour has no hollow" if math.isinf(radius) else "", surface.name
        check = Check(WHEEL.name, radius >= wheel, radius, wheel, "mm", at_deg, "at_least", detail=detail, surface=name)
        checks.append(check)
    return checks


def hollow_radius(side: Side, contour: Curve) -> tuple[float, float]:
    """Least radius of the metal's hollows, mm, infinite without a hollow, and the contour's parameter there.

    `side` is 1 for metal inside the contour, -1 for metal outside. Raises CurveError where the proof does not end.
    """
    from camgeo.curve.backwards import least_hollow
    from camgeo.curve.curvature import least_radius

    return least_hollow(contour) if side > 0 else least_radius(contour)


def greatest(function: Callable[[Array], Array], t: Array) -> list[tuple[float, float]]:
    """Greatest value of each of k continuous functions of period 2 pi, with its argument: sampled, then refined.

    `function` gives values (k, n) at arguments (n,); `t` (n,) are the samples. Of samples that are
    equal but for rounding the first counts.
    """
    around = np.concatenate([t[-1:] - 2.0 * math.pi, t, t[:1] + 2.0 * math.pi])
    best, ranges = [], []
    for seen in function(t):
        worst = int(np.argmax(seen >= seen.max() - SAME * abs(seen.max())))
        best.append((float(seen[worst]), float(t[worst])))
        ranges.append((float(around[worst]), float(around[worst + 2])))
    for _ in range(ZOOMS):
        near = [np.linspace(low, high, ZOOM + 1) for low, high in ranges]
        rows = function(np.concatenate(near)).reshape(len(near), len(near), -1)
        for i, (low, high) in enumerate(ranges):
            worst = int(np.argmax(rows[i, i]))
            at = float(near[i][worst])
            best[i] = max(best[i], (float(rows[i, i, worst]), at), key=itemgetter(0))
            step = (high - low) / ZOOM
            ranges[i] = max(low, at - step), min(high, at + step)
    return best


MADE: dict[str, Callable[[ExactCam, Surface], Check]] = {
    DIAMETER.name: _constant_diameter,
    TRAVEL.name: _face_length,
    FACE_WIDTH.name: _face_width,
    PRESSURE.name: _pressure_angle,
}
"""How each check of a surface under its follower is made that hangs on no law; the others are its proofs."""
