"""The motion table: the intended motion over the shaft angle, for a person or a controller to read."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from camgeo.motions.position import Position
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array

ORDER = 3  # of the highest derivative, the jerk


def motion_table(recipe: Recipe, position: Position) -> tuple[tuple[str, ...], Array]:
    """Names of 5 columns, and rows (angles + 1, 5) over `verify.angles` equal steps of a turn of the shaft, both ends.

    Columns are the shaft angle, degrees, the follower's position, and velocity, acceleration and jerk, which are its
    derivatives by radian of the shaft. The position is a lift above its datum in the recipe's unit of length, or a
    swing about a pivot in degrees, of a flat pair the swing of the whole pair, half the angle psi of its law.
    Derivatives are in the same unit per rad, rad^2 and rad^3; at a break they are those that follow, at the end of the
    turn those that precede.
    """
    count = recipe.verify.angles
    shaft = np.linspace(0.0, 2.0 * np.pi, count + 1)
    rows = position.turn(shaft, ORDER)
    name, scale = position.column(recipe.units), position.factor(recipe.mm)
    table = np.column_stack([np.linspace(0.0, 360.0, count + 1), *(rows * scale)])
    return ("shaft_deg", name, "velocity", "acceleration", "jerk"), table
