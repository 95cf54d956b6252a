"""What budgets add: the key `budget`, figures, a section of the report, a panel and a plot of the page, a starter."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.budget.keys import Budget, build_budget, check_budget, fields
from camgeo.capabilities.budget.words import PROFILE
from camgeo.measures.measured import Measured
from camgeo.recipe.figures import Figure, Need
from camgeo.registry.capability import Capability, Results
from camgeo.schema.fields import Kind
from kin.numeric.angles import degrees

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.recipe.starter import Starter
    from camgeo.report.page.curves import Plot
    from camgeo.synthesis.design import Design

WORST, RSS = "budget-worst", "budget-rss"
OF_BUDGET = Need("a budget", lambda _, paths: "budget" in paths)
FIGURES = {
    WORST: Figure(
        "greatest error of follower or output, in the worst case of the budget", Kind.MOTION, "least", OF_BUDGET
    ),
    RSS: Figure("the same as root of the sum of squares", Kind.MOTION, "least", OF_BUDGET),
}


def _measure(
    recipe: Recipe, design: Design, names: Sequence[str], _speeds: Mapping[str, float]
) -> Mapping[str, Measured]:
    from camgeo.capabilities.budget.outcome import outcome, turns

    budget = recipe.of(Budget)
    if budget is None or not _can_move(design):
        why = "budget is not given" if budget is None else "the mechanism does not turn"
        return {name: Measured(None, "mm", detail=why) for name in names}
    sums = outcome(recipe, design, budget).sums
    values = {}
    for name in names:
        found = sums["worst" if name == WORST else "rss"]
        turned = turns(recipe)
        value = math.degrees(found.value) if turned else found.value
        values[name] = Measured(value, "deg" if turned else "mm", degrees(found.at))
    return values


def _can_move(design: Design) -> bool:
    return design.driven is None or design.driven.turns


def section_of(recipe: Recipe, design: Design) -> dict[str, Any] | None:
    """The report's section of a recipe's budget; None without one, and of a linkage that does not turn."""
    from camgeo.capabilities.budget.outcome import outcome, section

    budget = recipe.of(Budget)
    return None if budget is None or not _can_move(design) else section(recipe, outcome(recipe, design, budget))


def _examine(recipe: Recipe, design: Design, _files: Sequence[FileResult], clock: Clock) -> Results:
    with clock.stage("budget"):
        section = section_of(recipe, design)
    return Results() if section is None else Results({"budget": section})


def _panel(report: dict[str, Any]) -> str:
    from camgeo.capabilities.budget.panel import panel

    return panel(report)


def _plots(recipe: Recipe, design: Design) -> Sequence[Plot]:
    """Both sums over the turn, at the contact that is worst of all."""
    from camgeo.capabilities.budget.outcome import outcome, over_turn, told
    from camgeo.report.page.curves import Plot, Series
    from camgeo.report.page.followers import SHAFT

    budget = recipe.of(Budget)
    if budget is None or not _can_move(design):
        return ()
    sums = over_turn(recipe, outcome(recipe, design, budget), SHAFT)
    permitted, unit = told(recipe, budget.permitted)
    rows = (Series("worst", sums["worst"]), Series("rss", sums["rss"]))
    return (Plot("Budget", unit, rows, limits=((permitted, "permitted"),), axis="error", holds=(0.0,)),)


def _profile(recipe: Recipe) -> float | None:
    """Width of the zone of a contour that may be off by as much on either side; None where that is to be found."""
    budget = recipe.of(Budget)
    stated = None if budget is None else dict(budget.tolerances).get(PROFILE)
    return None if stated is None else 2.0 * stated


def _starters() -> Mapping[str, Starter]:
    from camgeo.capabilities.budget.starter import STARTERS

    return STARTERS


CAPABILITY = Capability(
    fields=fields,
    check=check_budget,
    build=build_budget,
    profile=_profile,
    starters=_starters,
    figures=FIGURES,
    measure=_measure,
    examine=_examine,
    panel=_panel,
    plots=_plots,
)
