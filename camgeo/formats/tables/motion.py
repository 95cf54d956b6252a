"""The motion table: positions and derivatives of the follower, or of a linkage's links, over the shaft angle."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.extension import Table
from camgeo.formats.tables.tabled import table_maker

if TYPE_CHECKING:
    from camgeo.formats.tables.tabled import Columns
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest


def motion_columns(job: Job, request: FileRequest) -> Columns:
    """Column names and rows (angles + 1, k) over equal steps of the shaft.

    Lengths are in the unit of the file, angles in degrees; derivatives are by rad of the shaft, unless the name of a
    column has another unit.
    """
    recipe = job.recipe.in_units_of(request)
    if job.design.driven is not None:
        from camgeo.synthesis import linkage

        return linkage.motion_table(recipe, job.design.driven.mechanism)
    from camgeo.synthesis.motion_table import motion_table

    return motion_table(recipe, job.design.motion)


FORM = Table(name="motion", surfaces=2, discs=2, make=table_maker("table", motion_columns))
