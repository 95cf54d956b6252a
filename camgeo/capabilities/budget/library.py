"""A budget from a program, as `camgeo budget` works it out from a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.budget.keys import Budget
from camgeo.capabilities.budget.outcome import outcome, section
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe


def budget(recipe: Recipe) -> dict[str, Any]:
    """The budget of a recipe as plain data, in the recipe's unit and degrees; docs/budget.md names its keys.

    `ok` is whether it is kept. Raises RecipeErrors for a recipe without a budget, for one of whose tolerances nothing
    is left for a free one, and for a linkage that does not turn.
    """
    stated = recipe.of(Budget)
    if stated is None:
        remedy = "give budget: {permitted: 0.05, tolerances: {profile: 0.01}}"
        raise recipe.error("", "there is no budget", None, remedy)
    design = designed(recipe)
    if design.driven is not None and not design.driven.turns:
        raise recipe.error("linkage", "the mechanism does not turn, and its output has no error", None, "see check")
    found = outcome(recipe, design, stated)
    entry = section(recipe, found)
    return {"recipe": recipe.name, "units": recipe.units, "ok": entry["kept"], **entry}
