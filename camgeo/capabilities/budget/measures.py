"""Figures of a budget, and its section of the report."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.budget.keys import Budget
from camgeo.capabilities.budget.outcome import error_unit, outcome_of
from camgeo.capabilities.budget.recipe import RSS, WORST
from camgeo.capabilities.budget.section import section
from camgeo.measures.extension import Measures, Results
from camgeo.measures.measured import Measured
from kin.numeric.angles import degrees

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def _measure(
    recipe: Recipe, design: Design, names: Sequence[str], _speeds: Mapping[str, float]
) -> Mapping[str, Measured]:
    budgeted, unit = outcome_of(recipe, design), error_unit(recipe)
    if budgeted is None:
        why = "budget is not given" if recipe.of(Budget) is None else "the mechanism does not turn"
        return {name: Measured(None, "mm", detail=why) for name in names}
    sums = {WORST: budgeted.sums["worst"], RSS: budgeted.sums["rss"]}
    scale = math.degrees(1.0) if unit == "deg" else 1.0
    return {name: Measured(scale * sums[name].value, unit, degrees(sums[name].at)) for name in names}


def _examine(recipe: Recipe, design: Design, _files: Sequence[FileResult], clock: Clock) -> Results:
    with clock.stage("budget"):
        budgeted = outcome_of(recipe, design)
        return Results() if budgeted is None else Results({"budget": section(recipe, budgeted)})


ANSWERS = Measures(measure=_measure, examine=_examine)
