"""Errors of fits, writers and curves as those of the recipe that asked for a file."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from camgeo.common.rounding import downward, upward
from camgeo.curve.curve import CurveError
from camgeo.files.errors import RegionError
from camgeo.fit.nodes import ToleranceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Order
    from camgeo.schema.errors import RecipeErrors


@contextmanager
def refusals(recipe: Order, request: FileRequest, words: Callable[[str], str] = str) -> Iterator[None]:
    """Context that turns errors of a fit, a writer or a curve into those of the recipe.

    A tolerance that cannot be held is refused at the field that sets it; `words` gives a curve's message in the
    recipe's unit.
    """
    try:
        yield
    except ToleranceError as error:
        raise refusal(recipe, request, error) from error
    except RegionError as error:
        raise recipe.error("part" if "part" in recipe.marks else "cam", f"within the tolerance, {error}") from error
    except CurveError as error:
        raise recipe.error("cam", words(str(error))) from error


def demand_flanks(recipe: Order, request: FileRequest, depth: float) -> None:
    """Raise RecipeErrors for a solid within a tolerance above half the depth of its flanks, mm.

    In such a file the flanks may be missing.
    """
    tolerance, mm, units = recipe.tolerance(request), recipe.mm, recipe.units
    if request.format.solid and tolerance > 0.5 * depth:
        problem = f"the flanks are {depth / mm:.4g} {units} deep, too little for a solid so far off"
        remedy = f"give at most {downward(0.5 * depth / mm, 4)} {units}"
        raise recipe.error(recipe.tolerance_field(request), problem, f"{tolerance / mm:.9g} {units}", remedy)


def refusal(recipe: Order, request: FileRequest, error: ToleranceError) -> RecipeErrors:
    """Errors for a tolerance that cannot be held, at the field that sets it."""
    inches = f"{upward(error.reached, 3)} mm are {upward(error.reached / recipe.mm, 3)} in"
    return recipe.error(recipe.tolerance_field(request), str(error), None, inches if recipe.units == "inch" else "")
