"""From a recipe's file to a `Recipe`, or to all of its faults."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from camgeo.recipe.recipe import file_bytes, is_meant_as_a_camshaft, load_text, of_source, read
from camgeo.schema.errors import DeprecatedKeyWarning
from camgeo.schema.yaml_source import read_source

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.recipe.camshaft import CamshaftRecipe
    from camgeo.recipe.recipe import Order, Recipe

__all__ = ["announced", "load", "load_order", "load_silent", "load_text", "read"]


def load(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file, and warn of former names in it, which `load_silent` does not.

    Raises RecipeErrors with all its faults, also where the file does not exist; warns by DeprecatedKeyWarning.
    """
    return announced(load_silent(path))


O = TypeVar("O", bound="Order")


def announced(recipe: O) -> O:
    """Warn of the former names in a recipe, a DeprecatedKeyWarning for each, and give the recipe back."""
    for notice in recipe.notices:
        warnings.warn(str(notice), DeprecatedKeyWarning, stacklevel=3)
    return recipe


def load_silent(path: str | PathLike[str]) -> Recipe:
    """Read a recipe from a file, whose `notices` are left to the caller; raises RecipeErrors as `load` does."""
    return read(file_bytes(path), path)


def load_order(path: str | PathLike[str]) -> Recipe | CamshaftRecipe:
    """Read the recipe of a cam or of a camshaft, whichever the file holds; raises RecipeErrors as `load` does."""
    source = read_source(file_bytes(path), str(path))
    if is_meant_as_a_camshaft(source):
        from camgeo.recipe.camshaft import read_camshaft

        return read_camshaft(source, Path(path))
    return of_source(source, path)
