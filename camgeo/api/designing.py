"""From a recipe to its design: of one cam, or of a camshaft with all of its cams."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias, overload

from camgeo.api.design import Design
from camgeo.api.loading import order_of
from camgeo.api.log import staged, tell_checks
from camgeo.common.clock import Clock
from camgeo.recipe.recipe import Recipe
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from os import PathLike

    from camgeo.api.camshaft import CamshaftDesign
    from camgeo.api.loading import OrderSource
    from camgeo.recipe.camshaft import CamshaftRecipe

Designed: TypeAlias = "Design | Any"
"""A Design, or a CamshaftDesign: that is Any to a type checker, as what a path leads to is seen when it is read."""


@overload
def design(recipe: Recipe) -> Design: ...


@overload
def design(recipe: CamshaftRecipe) -> CamshaftDesign: ...


@overload
def design(recipe: str | PathLike[str]) -> Designed: ...


def design(recipe: OrderSource) -> Designed:
    """Design the cam of a recipe, or all cams of a camshaft: no file is made, and no contour fitted.

    A camshaft has a CamshaftDesign. Raises RecipeErrors where there is no such motion or curve. A check that fails
    raises nothing: see `Design.ok`.
    """
    recipe = order_of(recipe)
    result: Design | CamshaftDesign
    if isinstance(recipe, Recipe):
        result = Design(recipe, designed(recipe, Clock(staged(recipe))))
    else:
        from camgeo.api import camshaft

        result = camshaft.designed(recipe)
    tell_checks(recipe.name, result.checks)
    return result
