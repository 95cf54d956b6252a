"""Checks and remarks of the exact plate: figures in the report, limits of the recipe, what strikes the follower."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.linear.figures import bears
from camgeo.capabilities.linear.plate import chamfer_checks, wall_checks
from camgeo.checks.declared import LIMIT
from camgeo.measures.placed import Figure, figure_check, limit_checks
from camgeo.measures.rule_remark import RuleRemark, pressure_remarks, source_remarks
from camgeo.measures.units import in_units
from camgeo.recipe.figures import LEAST_WALL, PITCH_RADIUS, PRESSURE_ANGLE
from kin.numeric.check import Check
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.linear.design import LinearDesign

STILL = 1e-9  # slope at an end below which the follower is not struck
STEEP = 30.0  # degrees, by rule of thumb for a follower on a stem
STEEP_ARM = 45.0
UNDERCUT = "undercut"
SURFACES = ("", "lower", "upper")


def design_checks(design: LinearDesign, figures: Sequence[Figure]) -> list[Check]:
    """Checks that need no file; a figure that nothing limits is reported without a limit."""
    recipe = design.recipe
    checks = []
    for figure in figures:
        if figure.name == PRESSURE_ANGLE:
            checks.append(figure_check(figure.name, figure, None, "at_most", "mm"))
        elif figure.name.startswith(PITCH_RADIUS):
            name = figure.name.removeprefix(PITCH_RADIUS).removeprefix("-")
            flank = design.flanks[name]
            limit = abs(flank.distance)
            if not limit:
                continue
            lost = bool(recipe.trims and flank.lost)
            check = figure_check(PITCH_RADIUS, figure, None if lost else limit, "at_least", "mm")
            checks.append(Check(**{**vars(check), "surface": name, "detail": "trimmed" if lost else "", "ok": True}))
            depth = max((each.depth for each in flank.lost), default=0.0) * design.path.guide.reach if lost else 0.0
            checks.append(
                Check(
                    UNDERCUT, True, depth, None if lost else 0.0, "mm", surface=name, detail="trimmed" if lost else ""
                )
            )
    return [*checks, *chamfer_checks(design), *wall_checks(design)]


def limits_held(design: LinearDesign, figures: Sequence[Figure], checks: Sequence[Check]) -> list[Check]:
    """Checks of the figures that the recipe limits, those of the wall between two edges among them."""
    wall = next((check for check in checks if check.name == LEAST_WALL and check.value is not None), None)
    if wall is None or wall.value is None:
        return limit_checks(design.recipe.limits, figures, "mm", SURFACES)
    held = limit_checks(design.recipe.limits, [*figures, Figure(LEAST_WALL, wall.value, "mm")], "mm", SURFACES)
    return [replace(each, detail=wall.detail) if each.name == LIMIT + LEAST_WALL else each for each in held]


# --- remarks ----------------------------------------------------------------------------------------------------------


def remarks_on(design: LinearDesign, figures: Sequence[Figure]) -> tuple[RuleRemark, ...]:
    """Remarks on what is unusual: a steep contact, a follower that is struck where the drive reverses, a pressure."""
    recipe, known = design.recipe, {figure.name: figure for figure in figures}
    remarks = []
    steep, rule = known[PRESSURE_ANGLE], STEEP_ARM if recipe.swings else STEEP
    limited = {bound.figure for bound in recipe.limits}
    if steep.value > rule and PRESSURE_ANGLE not in limited and recipe.steepest is None:
        sentence = f"the pressure angle reaches {steep.value:.4g} degrees, where {rule:g} is usual"
        remarks.append(RuleRemark(PRESSURE_ANGLE, steep.value, rule, "deg", sentence, steep.at, "mm"))
    remarks += _struck(design)
    remarks += source_remarks(design.motion.kept)
    remarks += pressure_remarks(known.get("contact-pressure"), bears(design), "mm")
    return tuple(remarks)


def _struck(design: LinearDesign) -> list[RuleRemark]:
    """Remarks on ends at which a plate of constant speed reverses while the follower moves: its velocity jumps."""
    drive, recipe = design.recipe.drive, design.recipe
    if recipe.endless or drive.forth is None or drive.back is None:
        return []
    found = []
    slopes = design.path.law.derivatives(np.array([0.0, design.total]), 1, np.array([1, -1]))[1]
    for place, slope, where in ((0.0, slopes[0], "beginning"), (design.total, slopes[1], "end")):
        jump = abs(float(slope)) * (drive.forth + drive.back)
        if abs(slope) <= STILL:
            continue
        unit = f"{design.path.guide.unit}/s"
        value, shown = in_units(recipe, math.degrees(jump) if recipe.swings else jump, unit)
        sentence = (
            f"the plate reverses at constant speed at the {where} of the motion, where the follower moves: "
            f"its velocity jumps by {value:.4g} {shown}; a dwell there, or a crank, would end that"
        )
        found.append(
            RuleRemark("struck", math.degrees(jump) if recipe.swings else jump, 0.0, unit, sentence, place, "mm")
        )
    return found
