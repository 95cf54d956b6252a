"""The polar table: the contour of the exact cam over its polar angle.

Places are those of the drawing, mirrored where the drawing is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import table_maker
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve
    from camgeo.formats.tables.tabled import Columns
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from kin.numeric.arrays import Array


def polar_table(recipe: Recipe, contour: Curve) -> tuple[tuple[str, ...], Array]:
    """Column names and rows (angles + 1, 2): polar angle, degrees in equal steps, and the contour's radius there.

    The radius, the distance from the shaft, is in the recipe's unit. Raises StarError where a ray from the shaft may
    cross the contour more than once or not at all.
    """
    from camgeo.curve.measures import polar_radius

    count = recipe.verify.angles
    angles = np.linspace(0.0, TURN, count + 1)[:-1]
    radius = polar_radius(contour, -angles if recipe.rotation == "ccw" else angles) / recipe.mm
    unit = "in" if recipe.units == "inch" else "mm"
    rows = np.column_stack([np.linspace(0.0, 360.0, count + 1), np.append(radius, radius[0])])
    return ("polar_deg", f"radius_{unit}"), rows


def _columns(job: Job, request: FileRequest) -> Columns:
    from camgeo.curve.measures import StarError

    try:
        (fit,) = job.fits
        return polar_table(job.recipe.in_units_of(request), fit.contour)
    except StarError as error:
        field_path, remedy = f"{job.field(request)}.csv.as", "give `as: inspection`, whose rows are places of contact"
        raise job.recipe.error(field_path, str(error), "'polar'", remedy) from error


FORM = Table(name="polar", make=table_maker("polar", _columns))
