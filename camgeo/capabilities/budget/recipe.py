"""Key `budget` of a recipe, and the figures that recipes limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.budget.dimensions import PROFILE
from camgeo.capabilities.budget.keys import build_budget, check_budget, fields
from camgeo.recipe.design_figure import DesignFigure, Need
from camgeo.recipe.extension import Keys
from camgeo.schema.fields import Kind

if TYPE_CHECKING:
    from camgeo.capabilities.budget.keys import Budget

WORST, RSS = "budget-worst", "budget-rss"
OF_BUDGET = Need("a budget", lambda _, paths: "budget" in paths)
FIGURES = {
    WORST: DesignFigure(
        "greatest error of follower or output, in the worst case of the budget", Kind.MOTION, "least", OF_BUDGET
    ),
    RSS: DesignFigure("the same as root of the sum of squares", Kind.MOTION, "least", OF_BUDGET),
}


def _profile(budget: Budget) -> tuple[str, float] | None:
    """Field and width, mm, of the contour's tolerance zone: twice the profile's plus and minus.

    None where the recipe does not state it.
    """
    stated = dict(budget.tolerances).get(PROFILE)
    return None if stated is None else (f"budget.tolerances.{PROFILE}", 2.0 * stated)


ANSWERS = Keys(fields=fields, check=check_budget, build=build_budget, profile=_profile, figures=FIGURES)
