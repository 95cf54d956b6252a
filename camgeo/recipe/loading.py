"""From a recipe's file to a `Recipe`, or to all of its faults."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from camgeo.recipe.recipe import load_text, read
from camgeo.schema.errors import DeprecatedKeyWarning, RecipeError, RecipeErrors
from camgeo.schema.file_bytes import bytes_of
from camgeo.schema.scalars import Complaint
from camgeo.schema.yaml_source import MAX_BYTES

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.recipe import Recipe

__all__ = ["announced", "load", "load_silent", "load_text", "read"]


def load(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file, and warn of former names in it, which `load_silent` does not.

    Raises RecipeErrors with all its faults, also where the file does not exist; warns by DeprecatedKeyWarning.
    """
    return announced(load_silent(path))


def announced(recipe: Recipe) -> Recipe:
    """Warn of the former names in a recipe, a DeprecatedKeyWarning for each, and give the recipe back."""
    for notice in recipe.notices:
        warnings.warn(str(notice), DeprecatedKeyWarning, stacklevel=3)
    return recipe


def load_silent(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file, whose `notices` are left to the caller; raises RecipeErrors as `load` does."""
    if not str(path):
        raise RecipeErrors([RecipeError("''", 0, 0, "", "an empty name of a file", None, "give the path of a recipe")])
    try:
        data = bytes_of(path, MAX_BYTES, "recipe")
    except Complaint as complaint:
        raise RecipeErrors([RecipeError(str(path), 0, 0, "", complaint.problem, None, complaint.remedy)]) from None
    return read(data, path)
