"""What a valve adds: a key, a starter, figures, a section of the report, a panel and plots of the page, a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.valve.figures import FIGURES
from camgeo.capabilities.valve.keys import build, check, fields
from camgeo.registry.capability import Capability, Results

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.recipe.recipe import Recipe
    from camgeo.recipe.starter import Starter
    from camgeo.registry.capability import MovedBody
    from camgeo.registry.formats import Form
    from camgeo.report.page.curves import Plot
    from camgeo.synthesis.design import Design


def _measure(
    recipe: Recipe, design: Design, names: Sequence[str], _speeds: Mapping[str, float]
) -> Mapping[str, Measured]:
    from camgeo.capabilities.valve.measure import measure

    return measure(recipe, design, names)


def _measure_at(recipe: Recipe, design: Design, name: str, lift: float) -> Measured:
    from camgeo.capabilities.valve.measure import measure_at

    return measure_at(recipe, design, name, lift)


def _moved(recipe: Recipe, design: Design) -> MovedBody | None:
    from camgeo.capabilities.valve.train import valve_of

    return valve_of(recipe, design)


def _examine(recipe: Recipe, design: Design, _files: Sequence[FileResult], clock: Clock) -> Results:
    from camgeo.capabilities.valve.section import section

    with clock.stage("valve"):
        made = section(recipe, design)
    return Results() if made is None else Results({"valve": made})


def _panel(report: dict[str, Any]) -> str:
    from camgeo.capabilities.valve.section import panel

    return panel(report)


def _plots(recipe: Recipe, design: Design) -> Sequence[Plot]:
    from camgeo.capabilities.valve.section import plots

    return plots(recipe, design)


def _starters() -> Mapping[str, Starter]:
    from camgeo.capabilities.valve.starter import STARTERS

    return STARTERS


def _tables() -> Mapping[str, Form]:
    from camgeo.capabilities.valve.table import FORM

    return {FORM.name: FORM}


CAPABILITY = Capability(
    fields=fields,
    check=check,
    build=build,
    starters=_starters,
    figures=FIGURES,
    measure=_measure,
    measure_at=_measure_at,
    moved=_moved,
    examine=_examine,
    panel=_panel,
    plots=_plots,
    tables=_tables,
)
