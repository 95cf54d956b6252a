"""Solids of the cam: a polygon extruded with what is cut out of it; STL."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.fit.nodes import ToleranceError
from camgeo.fit.pieces import Polygon

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.files.stl import StlFacts
    from camgeo.making.job import Job, Made
    from camgeo.recipe.model import FileRequest


def make_solid(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit, write, read back and judge one solid."""
    fine = aim(job, request)
    with job.refusals(request):
        polygon = job.outline("polyline", fine)
        if not isinstance(polygon, Polygon):
            raise TypeError("a solid is made of a polygon")
        with job.clock.stage(f"write {request.kind}"):
            facts = _write(job, polygon, path, job.tolerance(request))
    return job.judged(request, path, facts.bound, facts.vertices)


def aim(job: Job, request: FileRequest) -> float:
    """Tolerance left to the fit: what rounding to single precision and a chamfer leave of the file's.

    Raises RecipeErrors where that is nothing.
    """
    import numpy as np

    from camgeo.files.stl import fit_tolerance

    body = job.design.body
    size = float(np.abs(job.contour.sample(job.contour.cells.low).point).max())
    # between two samples the contour reaches a little farther
    try:
        return fit_tolerance(job.tolerance(request), 1.01 * size) * (body.fineness if body else 1.0)
    except ToleranceError as error:
        raise job.refused(request, error) from error


def _write(job: Job, polygon: Polygon, path: Path, tolerance: float) -> StlFacts:
    from camgeo.files.stl import write_stl

    recipe, body = job.recipe, job.design.body
    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "an STL needs a thickness")
    if body is not None:
        from camgeo.part.files import write_part

        drawn = body.mirrored() if recipe.rotation == "ccw" else body
        return write_part(path, polygon, drawn, tolerance=tolerance, about=recipe.name)
    return write_stl(
        path,
        polygon,
        bore=recipe.part.bore,
        thickness=recipe.part.thickness,
        tolerance=tolerance,
        about=recipe.name,
    )
