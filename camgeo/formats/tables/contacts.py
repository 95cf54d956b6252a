"""The table of contacts: what the motion table has and the contacts of the exact cam beside it.

Places are those of the drawing, mirrored where the drawing is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.formats.extension import Table
from camgeo.formats.tables.motion import motion_columns
from camgeo.formats.tables.tabled import table_maker
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.formats.tables.tabled import Columns
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

NOTHING = 1e-14  # of the cam's size: rounding about a coordinate that is 0


def contact_table(
    recipe: Recipe, design: Design, motion: tuple[tuple[str, ...], Array]
) -> tuple[tuple[str, ...], Array]:
    """Column names and rows (angles + 1, k): the columns of the motion table, then four of each contact.

    `motion` has names and rows of the motion table, over equal steps of the shaft. The columns of a contact are the
    radius of curvature of the metal, below 0 in a hollow and nan where it is straight, the pressure angle in degrees,
    above 0 where the cam pushes the follower out, and x and y of the place of contact; lengths are in the recipe's
    unit. All are nan where a trimmed cam is not touched. At a break the radius is that after it, at the end of the turn
    that before it. Raises ValueError where a failed check prevents the contour.
    """
    from camgeo.curve.measures import touched

    names, rows = motion
    if not design.contours:
        raise ValueError(f"{recipe.name}: there is no contour to be touched")
    columns = dict(zip(names, rows.T, strict=True))
    # at a break the frame after it counts, at the last row, the end of the turn, the frame before it
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
        frame = contour.sample(t, side)
        # the radius of curvature is speed by turn, both by the contour's parameter; a straight place has none
        with np.errstate(divide="ignore"):
            radius = surface.side * frame.speed / np.where(frame.turn == 0.0, np.nan, frame.turn)
        x, y = np.where(np.abs(frame.point) < NOTHING * contour.size, 0.0, frame.point).T / recipe.mm
        own_columns = {
            f"{name}radius_of_curvature_{unit}": radius / recipe.mm,
            f"{name}pressure_angle_deg": np.degrees(surface.pressure(t)),
            f"{name}x_{unit}": x,
            f"{name}y_{unit}": sense * y,
        }
        away = ~touched(contour, t)
        columns |= (
            {key: np.where(away, np.nan, column) for key, column in own_columns.items()} if away.any() else own_columns
        )
    return tuple(columns), np.column_stack(list(columns.values()))


def _columns(job: Job, request: FileRequest) -> Columns:
    return contact_table(job.recipe.in_units_of(request), job.design, motion_columns(job, request))


FORM = Table(
    name="contacts", surfaces=2, discs=2, make=table_maker("contacts", _columns, gaps=True)
)  # nan: not touched
