"""The motion table: the intended motion over the shaft angle, for a person or a controller to read."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from camgeo.motions.position import Position
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array

ORDER = 3


def motion_table(recipe: Recipe, position: Position) -> tuple[tuple[str, ...], Array]:
    """Column names, and rows (angles + 1, 5): shaft angle, position and its derivatives by radian of shaft.

    A plate's lift is in the recipe's unit, the distance from the shaft less its datum; a follower that swings is in
    degrees, a flat pair by its own swing psi/2. At a break the derivatives are those that follow, at the end of the
    turn those that precede.
    """
    count = recipe.verify.angles
    phi = np.linspace(0.0, 2.0 * np.pi, count + 1)
    rows = position.turn(phi, ORDER)
    name, scale = position.column(recipe.units), position.factor(recipe.mm)
    table = np.column_stack([np.linspace(0.0, 360.0, count + 1), *(rows * scale)])
    return ("shaft_deg", name, "velocity", "acceleration", "jerk"), table
