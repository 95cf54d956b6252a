"""Record of budgets: the key `budget`, figures, a section of the report, a panel and a plot of the page, a starter."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.budget.dimensions import PROFILE
from camgeo.capabilities.budget.keys import Budget, build_budget, check_budget, fields
from camgeo.measures.measured import Measured
from camgeo.recipe.figures import DesignFigure, Need
from camgeo.registry.capability import Capability, Results
from camgeo.schema.fields import Kind
from kin.numeric.angles import degrees

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.capabilities.budget.outcome import BudgetOutcome
    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.recipe.starter import Starter
    from camgeo.report.page.curves import Plot
    from camgeo.synthesis.design import Design

WORST, RSS = "budget-worst", "budget-rss"
OF_BUDGET = Need("a budget", lambda _, paths: "budget" in paths)
FIGURES = {
    WORST: DesignFigure(
        "greatest error of follower or output, in the worst case of the budget", Kind.MOTION, "least", OF_BUDGET
    ),
    RSS: DesignFigure("the same as root of the sum of squares", Kind.MOTION, "least", OF_BUDGET),
}


def _outcome(recipe: Recipe, design: Design) -> BudgetOutcome | None:
    """The outcome of a recipe's budget; None without a budget, and for a linkage that does not turn."""
    from camgeo.capabilities.budget.outcome import outcome

    budget = recipe.of(Budget)
    moves = design.driven is None or design.driven.turns
    return outcome(recipe, design, budget) if budget is not None and moves else None


def _measure(
    recipe: Recipe, design: Design, names: Sequence[str], _speeds: Mapping[str, float]
) -> Mapping[str, Measured]:
    from camgeo.capabilities.budget.outcome import error_unit

    budgeted, unit = _outcome(recipe, design), error_unit(recipe)
    if budgeted is None:
        why = "budget is not given" if recipe.of(Budget) is None else "the mechanism does not turn"
        return {name: Measured(None, "mm", detail=why) for name in names}
    sums = {WORST: budgeted.sums["worst"], RSS: budgeted.sums["rss"]}
    scale = math.degrees(1.0) if unit == "deg" else 1.0
    return {name: Measured(scale * sums[name].value, unit, degrees(sums[name].at)) for name in names}


def _examine(recipe: Recipe, design: Design, _files: Sequence[FileResult], clock: Clock) -> Results:
    from camgeo.capabilities.budget.section import section

    with clock.stage("budget"):
        budgeted = _outcome(recipe, design)
        return Results() if budgeted is None else Results({"budget": section(recipe, budgeted)})


def _panel(report: dict[str, Any]) -> str:
    from camgeo.capabilities.budget.panel import panel

    return panel(report)


def _plots(recipe: Recipe, design: Design) -> Sequence[Plot]:
    """Plot of both sums of errors over the turn at the worst contact, with the permitted error.

    Empty without a budget, and for a linkage that does not turn.
    """
    from camgeo.capabilities.budget.outcome import motion_unit
    from camgeo.capabilities.budget.section import sums_over_turn
    from camgeo.report.page.curves import Plot, Series
    from camgeo.report.page.followers import SHAFT

    budgeted = _outcome(recipe, design)
    if budgeted is None:
        return ()
    sums, (scale, unit) = sums_over_turn(recipe, budgeted, SHAFT), motion_unit(recipe)
    rows = (Series("worst", sums["worst"]), Series("rss", sums["rss"]))
    limits = ((scale * budgeted.budget.permitted, "permitted"),)
    return (Plot("Budget", unit, rows, limits=limits, axis="error", holds=(0.0,)),)


def _profile(recipe: Recipe) -> tuple[str, float] | None:
    """Field and width, mm, of the contour's tolerance zone: twice the profile's plus and minus.

    None where the recipe does not state it.
    """
    budget = recipe.of(Budget)
    stated = None if budget is None else dict(budget.tolerances).get(PROFILE)
    return None if stated is None else (f"budget.tolerances.{PROFILE}", 2.0 * stated)


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
