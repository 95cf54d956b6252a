"""Checks and remarks of the exact drum: figures in the report, walls, what a wrapped or an offset drawing costs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.checks import LENGTH, RIB
from camgeo.capabilities.cylindrical.crossings import wall_between
from camgeo.capabilities.cylindrical.development import radii
from camgeo.capabilities.cylindrical.figures import CONTACT_PRESSURE, at_angle, bears, steepest
from camgeo.capabilities.cylindrical.flank import distance
from camgeo.formats.turned import DEVELOPMENT
from camgeo.measures.placed import figure_check
from camgeo.measures.rule_remark import RuleRemark, pressure_remarks, source_remarks
from camgeo.measures.units import in_units
from camgeo.recipe.figures import LEAST_WALL, PRESSURE_ANGLE
from kin.numeric.check import Check, failed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.measures.placed import Figure

STEEP = 30.0  # degrees, by rule of thumb for a follower on a straight guide
STEEP_ARM = 45.0
ROUNDING = 1e-9  # mm: a wall that is less by no more holds


def design_checks(design: DrumDesign, figures: Sequence[Figure]) -> list[Check]:
    """Checks that need no file; a figure that nothing limits is reported without a limit."""
    known = {figure.name: figure for figure in figures}
    checks = [figure_check(PRESSURE_ANGLE, known[PRESSURE_ANGLE], None, "at_most", at_unit="deg")]
    length = figure_check(LENGTH, known[LENGTH], 0.0, "at_least", at_unit="deg")
    cut = "shortened by undercut" if any(design.tips.values()) else ""
    if known[LENGTH].value > 0.0:
        checks.append(Check(**{**vars(length), "detail": cut}))
    else:
        why = "the flank ends at the blank before the roller begins: give a smaller offset, or a smaller from"
        checks.append(Check(**{**vars(failed(LENGTH, why, unit="mm", limit=0.0)), "at": length.at}))
    if RIB in known:
        check = figure_check(RIB, known[RIB], 0.0, "at_least", at_unit="deg")
        holds = known[RIB].value > 0.0
        remedy = check.detail if holds else "give a larger cam.track.rib.distance, or a smaller roller"
        checks.append(Check(**{**vars(check), "ok": holds, "detail": remedy}))
    return [*checks, wall_check(design)]


def wall_check(design: DrumDesign) -> Check:
    """The thinnest wall of a drum against the least one of its recipe; what is missing is told with a remedy."""
    wall, where, remedy = min(walls(design))
    least = design.recipe.part.wall
    holds = wall > 0.0 if least is None else wall >= least - ROUNDING
    if not holds:
        lack, unit = in_units(design.recipe, (least or 0.0) - wall, "mm")
        where += f": {remedy.format(f'by more than {lack:.6g} {unit}')}"
    return Check(LEAST_WALL, holds, wall, least or 0.0, "mm", sense="at_least", detail=where)


def walls(design: DrumDesign) -> list[tuple[float, str, str]]:
    """Walls of a drum, mm, each with what it stands between and how it grows; without a bore those of the ends alone.

    The third of each is a remedy, in which braces stand for an amount such as `by more than 2 mm`.
    """
    recipe, track = design.recipe, design.recipe.track
    heights = "cam.pitch_height, cam.follower.arm.pivot" if recipe.swings else "cam.pitch_height"
    low, high = design.motion.range
    found = []
    for name, flank in design.flanks.items():
        if track.meets_lower_face(name):
            where = f"between the {track.noun} and the lower face"
            found.append((flank.resting(low, recipe.radius), where, f"raise {heights} and part.length {{}}"))
        else:
            wall = recipe.height - flank.resting(high, recipe.radius)
            found.append((wall, f"between the {track.noun} and the upper face", "raise part.length {}"))
    if recipe.turns > 1:
        between = min(wall_between(design.flanks, r)[0] for r in (recipe.floor, recipe.radius))
        if math.isfinite(between):
            found.append((between, "between neighbouring turns of the groove", "give more lift a turn"))
    if design.bore is not None:
        points = design.bore.outline.points
        reach = float(np.hypot(*points.T).max())
        found.append(
            (recipe.floor - reach, "between the bore and the floor", "raise cam.radius {}, or narrow the bore")
        )
    return found


# --- remarks ----------------------------------------------------------------------------------------------------------


def remarks_on(design: DrumDesign, figures: Sequence[Figure]) -> tuple[RuleRemark, ...]:
    """Remarks on what is unusual, and on what becomes of a development that is taken for more than it is."""
    recipe, known = design.recipe, {figure.name: figure for figure in figures}
    remarks = []
    steep, usual = known[PRESSURE_ANGLE], STEEP_ARM if recipe.swings else STEEP
    limited = {bound.figure for bound in recipe.limits}
    if steep.value > usual and PRESSURE_ANGLE not in limited:
        where = "" if recipe.swings else " at the roller's inner end"
        sentence = f"the pressure angle reaches {steep.value:.4g} degrees{where}, {usual:g} is usual"
        remarks.append(RuleRemark(PRESSURE_ANGLE, steep.value, usual, "deg", sentence, steep.at))
    remarks += source_remarks(design.motion.kept)
    remarks += pressure_remarks(known.get(CONTACT_PRESSURE, known.get(f"{CONTACT_PRESSURE}-middle")), bears(design))
    twist, track = known.get("shoe-twist"), recipe.track
    if twist is not None and twist.value > track.clearance:
        shown, unit = in_units(recipe, twist.value, "mm")
        sentence = f"the shoe needs {shown:.2g} {unit} of clearance, as its track is steeper at its inner end"
        remarks.append(RuleRemark("shoe-twist", twist.value, track.clearance, "mm", sentence, twist.at))
    chosen = [each for request in recipe.export.files if request.as_ == DEVELOPMENT for each in radii(design, request)]
    walls_at = dict.fromkeys(radius for radius, pitch in chosen if not pitch)
    remarks += [] if any(design.tips.values()) else [_wrapped(design, radius) for radius in walls_at]
    if all(flank.radial for flank in design.flanks.values()):  # no cutter with a radial axis follows another path
        remarks += [_offset(design, radius) for radius in dict.fromkeys(radius for radius, pitch in chosen if pitch)]
    return tuple(remarks)


def wrapped_off(design: DrumDesign, radius: float) -> tuple[float, float, float]:
    """By how much walls cut radially from a development of regular flanks are off along the axis, mm, and where.

    The places are the roller's inner end or the blank, mm, whichever is worse, and the shaft angle, rad.
    """
    found = []
    for name in design.flanks:
        for other in (max(design.recipe.roller.inner, design.recipe.floor), design.recipe.radius):

            def off(theta: np.ndarray, name: str = name, other: float = other) -> np.ndarray:
                flank = design.flanks[name]
                contact = flank.on(theta, other)
                return np.abs(flank.on(at_angle(flank, contact.phi, radius, theta), radius).z - contact.z)

            if abs(other - radius) > ROUNDING:
                found.append((*design.greatest(off), other))
    value, at, other = max(found, default=(0.0, 0.0, radius))
    return value, other, at


def offset_off(design: DrumDesign, radius: float) -> tuple[float, float]:
    """By how much a development's path, offset by the roller's radius on the same cylinder, is off, mm, and where.

    Square to the flank: E = r sin a asin(R sin a2/r) + R cos a cos a2 - R, tan a = S'/r, tan a2 = S'/rho(r); about
    R^3 sin^4 a/(6 r^2). It leaves a groove too narrow by twice that. The shaft angle is in rad.
    """
    v, at = steepest(design)
    roller = design.recipe.roller.radius
    rho = float(distance(np.array([radius]), np.array([v]), roller)[0])
    a, b = math.atan2(v, radius), math.atan2(v, rho)
    part = radius * math.sin(a) * math.asin(roller * math.sin(b) / radius)
    return part + roller * math.cos(a) * math.cos(b) - roller, at


def _wrapped(design: DrumDesign, radius: float) -> RuleRemark:
    value, other, at = wrapped_off(design, radius)
    shown, unit = in_units(design.recipe, value, "mm")
    mm = design.recipe.mm
    sentence = (
        f"the development at {radius / mm:.6g} {unit} is right at that radius alone: walls cut radially from it "
        f"would be off by {shown:.4g} {unit} along the axis at {other / mm:.6g} {unit}"
    )
    return RuleRemark("wrapped-wall", value, 0.0, "mm", sentence, math.degrees(at))


def _offset(design: DrumDesign, radius: float) -> RuleRemark:
    value, at = offset_off(design, radius)
    shown, unit = in_units(design.recipe, value, "mm")
    sentence = (
        f"the path at {radius / design.recipe.mm:.6g} {unit} leads a cutter of the roller's size: offset by its radius "
        f"on that cylinder it would leave each flank {shown:.3g} {unit} too much metal"
    )
    return RuleRemark("offset-path", value, 0.0, "mm", sentence, math.degrees(at))
