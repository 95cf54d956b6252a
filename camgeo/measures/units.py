"""Figures in the unit of a recipe."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Order, Recipe

UNIT_NAMES = {"mm": "mm", "inch": "in"}


def in_units(recipe: Order, value: float | None, unit: str) -> tuple[float | None, str]:
    """A figure in mm, mm^2, mm^3 or mm by radian in the recipe's unit, with that unit's name; other units stay."""
    name = UNIT_NAMES[recipe.units]
    power = {"mm": 1, "mm^2": 2, "mm^3": 3}.get(unit.replace("/", " ").partition(" ")[0])
    if power is None:
        return value, unit
    return (None if value is None else value / recipe.mm**power), name + unit[2:]


def of_displacements(recipe: Recipe) -> tuple[float, str]:
    """Factor and unit in which the follower's displacements are reported: the recipe's, or degrees."""
    swings = recipe.cam.arrangement.unit == "deg" or recipe.cam.by_linkage
    return (math.degrees(1.0), "deg") if swings else (1.0 / recipe.mm, UNIT_NAMES[recipe.units])
