"""Checks and remarks of the exact cam: figures in the report, walls, what a wrapped drawing costs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.figures import Search, bears, contact_length
from camgeo.capabilities.indexing.keys import LENGTH, RIB
from camgeo.measures.placed import figure_check
from camgeo.measures.rule_remark import RuleRemark, pressure_remarks, source_remarks
from camgeo.recipe.figures import LEAST_WALL, PRESSURE_ANGLE
from kin.numeric.check import Check
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.measures.placed import Figure

STEEP = 45.0  # degrees, by rule of thumb for a follower that swings
SHORTEST = 0.15  # of the length of a roller, on which one has to bear at least: the judge asks in layers
ROUNDING = 1e-9  # mm: a wall that is less by no more holds


def design_checks(design: IndexDesign, figures: Sequence[Figure]) -> list[Check]:
    """Checks that need no file; a figure that nothing limits is reported without a limit."""
    known = {figure.name: figure for figure in figures}
    checks = [figure_check(PRESSURE_ANGLE, known[PRESSURE_ANGLE], None, "at_most", at_unit="deg")]
    length = figure_check(LENGTH, known[LENGTH], _shortest(design), "at_least", at_unit="deg")
    if not length.ok:
        free = "no roller bears on a flank there, and the turret is free"
        why = free if not known[LENGTH].value > 0.0 else "a roller bears on a flank with little more than its rim there"
        length = replace(length, detail=f"{why}: {_longer(design)}")
    checks.append(length)
    checks.append(figure_check(RIB, known[RIB], 0.0, "at_least", at_unit="deg"))
    wall, where = min(walls(design))
    least = design.recipe.part.wall
    holds = wall > 0.0 if least is None else wall >= least - ROUNDING
    return [*checks, Check(LEAST_WALL, holds, wall, least or 0.0, "mm", sense="at_least", detail=where)]


def _shortest(design: IndexDesign) -> float:
    """Least length, mm, on which a roller has to bear."""
    inner, outer = design.bearing
    return SHORTEST * (outer - inner)


def _longer(design: IndexDesign) -> str:
    """Remedy for a line of contact that is too short: places `from` and `to` that serve, or more stops."""
    recipe = design.recipe
    inner, outer = recipe.turret.usual(recipe.roller.radius)
    if inner < outer and (inner < recipe.roller.inner or recipe.roller.outer < outer):
        fuller = design.rolled(min(inner, recipe.roller.inner), max(outer, recipe.roller.outer))
        if contact_length(Search(fuller)).value >= _shortest(fuller):
            shown = [f"{value / recipe.mm:.6g}" for value in (fuller.recipe.roller.inner, fuller.recipe.roller.outer)]
            return f"let it bear from {shown[0]} to {shown[1]} {recipe.units}, by turret.from and to"
    return "give more stops, or a longer cam"


def walls(design: IndexDesign) -> list[tuple[float, str]]:
    """Walls of a cam, mm, each with what it stands between; without a bore its core where that is thinnest."""
    core = design.recipe.form.core
    if design.bore is None:
        return [(2.0 * core, "across the core within the floor")]
    reach = float(np.hypot(*design.bore.outline.points.T).max())
    return [(core - reach, "between the bore and the floor")]


def remarks_on(design: IndexDesign, figures: Sequence[Figure]) -> tuple[RuleRemark, ...]:
    """Remarks on what is unusual."""
    recipe, known = design.recipe, {figure.name: figure for figure in figures}
    remarks = []
    steep = known[PRESSURE_ANGLE]
    limited = {bound.figure for bound in recipe.limits}
    if steep.value > STEEP and PRESSURE_ANGLE not in limited:
        sentence = f"the pressure angle of the best placed roller reaches {steep.value:.4g} degrees, {STEEP:g} is usual"
        remarks.append(RuleRemark(PRESSURE_ANGLE, steep.value, STEEP, "deg", sentence, steep.at))
    remarks += source_remarks(design.motion.kept)
    remarks += pressure_remarks(known.get("contact-pressure"), bears(design))
    return tuple(remarks)
