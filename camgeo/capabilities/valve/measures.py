"""Figures and motion of a valve, and its section of the report."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.valve.measure import measure, measure_at
from camgeo.capabilities.valve.section import section
from camgeo.capabilities.valve.train import valve_of
from camgeo.measures.extension import Measures, Results

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def _examine(recipe: Recipe, design: Design, _files: Sequence[FileResult], clock: Clock) -> Results:
    with clock.stage("valve"):
        made = section(recipe, design)
    return Results() if made is None else Results({"valve": made})


ANSWERS = Measures(
    measure=lambda recipe, design, names, _: measure(recipe, design, names),
    measure_at=measure_at,
    moved=valve_of,
    examine=_examine,
)
