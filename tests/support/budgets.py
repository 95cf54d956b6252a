# needs: budget
"""Dimensions that a recipe's cam and linkage may have in a budget."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.budget.dimensions import dimension_names, traits

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe


def dimensions_of(recipe: Recipe) -> tuple[str, ...]:
    arrangement = recipe.cam.arrangement
    linkage = recipe.linkage.kind if recipe.linkage else ""
    return dimension_names(traits(arrangement.offers, arrangement.discs, linkage))
