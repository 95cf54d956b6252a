"""From a recipe to its design: of one cam, or of all cams of a recipe of another kind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias, overload

from camgeo.api.loading import order_of
from camgeo.api.log import log_failures
from camgeo.api.root import root_of
from camgeo.common.errors import with_packages

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.api.design import Design
    from camgeo.api.loading import OrderSource
    from camgeo.recipe.recipe import Order, Recipe

Designed: TypeAlias = "Design | Any"
"""A Design, or what a recipe of another kind has: Any to a type checker, as what a path leads to is seen when read."""


@overload
def design(recipe: Recipe) -> Design: ...


@overload
def design(recipe: Order | str | PathLike[str]) -> Designed: ...


@with_packages()
def design(recipe: OrderSource) -> Designed:
    """Design the cam of a recipe, or all cams of a recipe of another kind; no file is made, and no contour fitted.

    `recipe` is a recipe or the path of its file. A check that fails raises nothing: `ok` of the design is False then.
    Raises RecipeErrors for faults of the file and where there is no such motion or curve, CallError for a path that no
    file can have, SurroundingsError where a package is missing, TypeError for neither a recipe nor a path.
    """
    recipe = order_of(recipe)
    result = root_of(recipe).design(recipe)
    log_failures(recipe.name, result.checks)
    return result
