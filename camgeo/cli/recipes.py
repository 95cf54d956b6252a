"""A recipe for a command: read from its file, with a line on standard error for each former name in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.common.terminal import complain
from camgeo.recipe.loading import load_silent

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.recipe import Recipe


def load(path: str | PathLike[str]) -> Recipe:
    """Read a recipe, and say which former names it has; raises RecipeErrors as `camgeo.recipe.loading` does."""
    recipe = load_silent(path)
    for notice in recipe.notices:
        complain(str(notice))
    return recipe
