"""Figures in the unit of a recipe."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, overload

from camgeo.schema.quantity import FORCES, MOMENTS

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Order, Recipe

UNIT_NAMES = {"mm": "mm", "inch": "in"}
LBF = FORCES["N"] / FORCES["lbf"]
_POUNDS = {"N": ("lbf", LBF), "N m": ("lbf in", MOMENTS["Nm"] / MOMENTS["lbf*in"]), "N/mm^2": ("psi", LBF * 25.4**2)}


def pounds(units: str, unit: str) -> tuple[str, float] | None:
    """Imperial unit for a `unit` of N, N m or N/mm^2 in a recipe in inches, and the factor from `unit` to it.

    `units` are the recipe's, mm or inch. None for other units, and for recipes in mm.
    """
    return _POUNDS.get(unit) if units == "inch" else None


@overload
def in_pounds(units: str, value: float, unit: str) -> tuple[float, str]: ...
@overload
def in_pounds(units: str, value: float | None, unit: str) -> tuple[float | None, str]: ...
def in_pounds(units: str, value: float | None, unit: str) -> tuple[float | None, str]:
    """Value and unit of a force, a moment or a pressure, in lbf, lbf in or psi where a recipe's `units` are inches.

    Other figures, and figures of recipes in mm, come back unchanged. None stays None, but its unit changes as that of a
    value does.
    """
    imperial = pounds(units, unit)
    return (value, unit) if imperial is None else (None if value is None else value * imperial[1], imperial[0])


def in_units(recipe: Order, value: float | None, unit: str) -> tuple[float | None, str]:
    """Value and unit of a figure, in the recipe's unit where its unit begins with mm, mm^2 or mm^3; else unchanged."""
    name = UNIT_NAMES[recipe.units]
    power = {"mm": 1, "mm^2": 2, "mm^3": 3}.get(unit.replace("/", " ").partition(" ")[0])
    if power is None:
        return value, unit
    return (None if value is None else value / recipe.mm**power), name + unit[2:]


def displacement_unit(recipe: Recipe) -> tuple[float, str]:
    """Factor from mm or rad to the unit in which the follower's displacements are reported, and that unit."""
    swings = recipe.cam.arrangement.unit == "deg" or recipe.cam.by_linkage
    return report_unit(recipe, "deg" if swings else "mm")


def report_unit(recipe: Order, unit: str) -> tuple[float, str]:
    """Factor from mm to a recipe's unit, and that unit; where `unit` is deg, from rad to degrees, and deg."""
    return (math.degrees(1.0), "deg") if unit == "deg" else (1.0 / recipe.mm, UNIT_NAMES[recipe.units])
