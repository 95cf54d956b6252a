"""Panel of a budget on the page, and its plot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.budget.outcome import motion_unit, outcome_of
from camgeo.capabilities.budget.panel import panel
from camgeo.capabilities.budget.section import sums_over_turn
from camgeo.report.extension import Page
from camgeo.report.page.followers import SHAFT
from camgeo.report.plot import Plot, Series

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def _plots(recipe: Recipe, design: Design) -> Sequence[Plot]:
    """Plot of both sums of errors over the turn at the worst contact, with the permitted error.

    Empty without a budget, and for a linkage that does not turn.
    """
    budgeted = outcome_of(recipe, design)
    if budgeted is None:
        return ()
    sums, (scale, unit) = sums_over_turn(recipe, budgeted, SHAFT), motion_unit(recipe)
    rows = (Series("worst", sums["worst"]), Series("rss", sums["rss"]))
    limits = ((scale * budgeted.budget.permitted, "permitted"),)
    return (Plot("Budget", unit, rows, limits=limits, axis="error", holds=(0.0,)),)


ANSWERS = Page(panel=panel, plots=_plots)
