"""Recipes of a file, a text or a mapping."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias

from camgeo.common.arguments import demand_type, path_of
from camgeo.common.errors import with_packages
from camgeo.recipe.loading import load as load_file
from camgeo.recipe.loading import load_order, load_order_text
from camgeo.recipe.recipe import Order, Recipe

if TYPE_CHECKING:
    from camgeo.schema.change import Value

    RecipeSource: TypeAlias = Recipe | str | PathLike[str]
    OrderSource: TypeAlias = Order | str | PathLike[str]

Loaded: TypeAlias = "Recipe | Any"
"""A Recipe, or one of another kind, which is Any to a type checker: the kind is known when the file is read."""
NAME = "recipe"  # of a recipe without a file

OF_TEXT = ("\n", "\r", ": ")  # in a text, and in no path that is given as a `str`


@with_packages()
def load(source: str | PathLike[str] | Mapping[str, Value]) -> Loaded:
    """Read a recipe from a file, from YAML text or from a mapping of the same keys.

    A `str` with a line break or with `: ` is YAML text, any other is the path of a file. A recipe without a file and
    without `name` has the name `recipe`. Raises RecipeErrors with every fault, its line, column and remedy, also where
    the file does not exist; CallError for a path that no file can have, SurroundingsError where a package is missing,
    TypeError for another type.
    """
    demand_type("source", source, (str, PathLike, Mapping), "a path, YAML text or a mapping")
    if isinstance(source, Mapping):
        from camgeo.schema.change import yaml_text

        return load_order_text(yaml_text(source, NAME), NAME, NAME)
    if isinstance(source, str) and any(mark in source for mark in OF_TEXT):
        return load_order_text(source, NAME)
    return load_order(path_of("source", source))


def order_of(recipe: OrderSource) -> Order:
    """Recipe of any kind, read from its file if the argument is a path.

    Raises RecipeErrors where the file has faults or does not exist, CallError for a path that no file can have, and
    TypeError for neither a recipe nor a path.
    """
    if isinstance(recipe, (str, PathLike)):
        return load_order(path_of("recipe", recipe))
    demand_type("recipe", recipe, Order, "a Recipe or the path of one")
    return recipe


def recipe_of(recipe: RecipeSource) -> Recipe:
    """Recipe of one cam, read from its file if the argument is a path.

    Raises RecipeErrors where the file has faults, does not exist or is no recipe of one cam, CallError for a path that
    no file can have, and TypeError for neither a recipe nor a path.
    """
    demand_type("recipe", recipe, (Recipe, str, PathLike), "a Recipe or the path of one")
    return recipe if isinstance(recipe, Recipe) else load_file(path_of("recipe", recipe))
