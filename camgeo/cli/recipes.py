"""Recipes of one command: conflicts of their folders, and entries of recipes without a report."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

from camgeo.common.terminal import escaped

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.recipe.recipe import Order
    from camgeo.schema.errors import RecipeError


def folder_conflicts(recipes: Sequence[Order]) -> list[str]:
    """Faults of recipes that would write into the same folder: a file named twice, or a name used twice."""
    paths = [recipe.path.resolve() for recipe in recipes]
    again = [recipe for i, recipe in enumerate(recipes) if paths[i] in paths[:i]]
    if again:
        text = "the same recipe is named twice in this call; name it once"
        return [f"{escaped(str(recipe.path))}: {text}" for recipe in again]
    names = [recipe.name.casefold() for recipe in recipes]
    twice = [recipe for recipe in recipes if names.count(recipe.name.casefold()) > 1]
    text = "the name {} is used by several recipes of this call; give each its own `name:`"
    return [f"{escaped(str(recipe.path))}: {text.format(recipe.name)}" for recipe in twice]


def failed_entry(recipe: str, message: str, errors: Sequence[RecipeError]) -> dict[str, object]:
    """Entry in place of a report for a recipe that has none, with its errors."""
    return {"recipe": recipe, "ok": False, "errors": [asdict(error) for error in errors] or [{"problem": message}]}
