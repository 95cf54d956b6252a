"""Tables of the exact cam: what the motion table has and the contacts beside it, and the contour over its polar angle.

Places are those of the drawing, mirrored where the drawing is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.measures import polar_radius, touched
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

NOTHING = 1e-14  # of the cam's size: rounding about a coordinate that is 0


def contact_table(
    recipe: Recipe, design: Design, motion: tuple[tuple[str, ...], Array]
) -> tuple[tuple[str, ...], Array]:
    """Column names and rows (angles + 1, k): those of the motion table, then four of each contact.

    They are the radius of curvature of the metal, below 0 in a hollow and nan where it is straight, the pressure angle
    in degrees, above 0 where the cam pushes the follower out, and the place of contact. nan where a trimmed cam is not
    touched. At a break the radius is the one that follows, at the end of the turn the one that precedes.
    """
    names, rows = motion
    if not design.contours:
        raise ValueError(f"{recipe.name}: there is no contour to be touched")
    columns = dict(zip(names, rows.T, strict=True))
    shaft = np.linspace(0.0, TURN, len(rows))
    relative = shaft if design.driven is None else design.driven.mechanism.relative(shaft)
    side = np.where(np.arange(len(rows)) < len(rows) - 1, 1, -1)
    unit, sense = "in" if recipe.units == "inch" else "mm", -1.0 if recipe.rotation == "ccw" else 1.0
    touching = [
        (f"{surface.prefix}{label}", t, surface, contour)
        for label, t in design.motion.parameters(shaft, relative).items()
        for surface, contour in design.contours
    ]
    for name, t, surface, contour in touching:
        at = contour.sample(t, side)
        with np.errstate(divide="ignore"):
            radius = surface.side * at.speed / np.where(at.turn == 0.0, np.nan, at.turn)
        x, y = np.where(np.abs(at.point) < NOTHING * contour.size, 0.0, at.point).T / recipe.mm
        own = {
            f"{name}radius_of_curvature_{unit}": radius / recipe.mm,
            f"{name}pressure_angle_deg": np.degrees(surface.pressure(t)),
            f"{name}x_{unit}": x,
            f"{name}y_{unit}": sense * y,
        }
        away = ~touched(contour, t)
        columns |= {key: np.where(away, np.nan, column) for key, column in own.items()} if away.any() else own
    return tuple(columns), np.column_stack(list(columns.values()))


def polar_table(recipe: Recipe, contour: Curve) -> tuple[tuple[str, ...], Array]:
    """Column names and rows (angles + 1, 2): polar angle, in equal steps, and the contour's distance from the shaft.

    Raises StarError where a ray from the shaft may cross the contour more than once or not at all.
    """
    count = recipe.verify.angles
    angles = np.linspace(0.0, TURN, count + 1)[:-1]
    radius = polar_radius(contour, -angles if recipe.rotation == "ccw" else angles) / recipe.mm
    unit = "in" if recipe.units == "inch" else "mm"
    rows = np.column_stack([np.linspace(0.0, 360.0, count + 1), np.append(radius, radius[0])])
    return ("polar_deg", f"radius_{unit}"), rows
