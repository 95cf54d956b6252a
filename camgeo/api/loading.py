"""Recipes from wherever they come: a file, a text, a mapping."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from camgeo.recipe.loading import announced, load_silent, load_text
from camgeo.recipe.schema.change import written

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.recipe import Recipe
    from camgeo.recipe.schema.change import Value

NAME = "recipe"  # of what has no file


def load(source: str | PathLike[str] | Mapping[str, Value]) -> Recipe:
    """Read a recipe from a file, from YAML text or from a mapping of the same keys.

    A `str` with a line break in it is a text, any other the path of a file. A recipe that is no file and gives no
    `name` is called recipe. Raises RecipeErrors, which tells every fault with line, column and remedy;
    warns by DeprecatedKeyWarning of each former name.
    """
    if isinstance(source, Mapping):
        return announced(load_text(written(source, NAME), NAME))
    if isinstance(source, str) and ("\n" in source or "\r" in source):
        return announced(load_text(source, NAME))
    return announced(load_silent(source))
