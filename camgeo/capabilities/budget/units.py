"""Units of a budget's report: lengths in the recipe's unit, angles in degrees."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.budget.words import WORDS
from camgeo.measures.units import UNIT_NAMES
from camgeo.recipe.linkage import output_slides

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

DEGREES = (math.degrees(1.0), "deg")


def turns(recipe: Recipe) -> bool:
    """Whether the errors of a recipe are angles: of a follower that swings, of an output that turns."""
    if recipe.linkage is not None:
        return not output_slides(recipe.linkage)
    return recipe.cam.arrangement.unit == "deg"


def motion_unit(recipe: Recipe) -> tuple[float, str]:
    """Unit of errors of the motion, as a factor of mm or rad, and its name."""
    return DEGREES if turns(recipe) else (1.0 / recipe.mm, UNIT_NAMES[recipe.units])


def size_unit(recipe: Recipe, name: str) -> tuple[float, str]:
    """Unit of a dimension's tolerance, as a factor of mm or rad, and its name."""
    return DEGREES if WORDS[name].angle else (1.0 / recipe.mm, UNIT_NAMES[recipe.units])
