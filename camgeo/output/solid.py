"""Solids of the cam: a polygon extruded with what is cut out of it; STL and 3MF."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.fit.nodes import ToleranceError
from camgeo.output.part_geometry import contours_of, openings_of, part_mesh, rim_of

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.files.mesh import Mesh, MeshFacts
    from camgeo.files.precision import Precision
    from camgeo.output.job import Job, Made
    from camgeo.recipe.export import FileRequest


def make_solid(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit, write, read back and judge one solid."""
    mesh, facts = cam_mesh(job, request)
    mm = job.recipe.told_for(request).mm
    with job.clock.stage(f"write {request.kind}"):
        if request.kind == "stl":
            from camgeo.files.stl import write_stl

            write_stl(path, mesh, mm=mm, about=job.recipe.name)
        else:
            from camgeo.files.three_mf import Item, write_3mf

            write_3mf(path, [Item("cam", mesh)], title=job.recipe.name, mm=mm, about=job.recipe.about)
    return job.judged(request, path, facts.bound, facts.vertices)


def precision_of(job: Job, request: FileRequest) -> Precision:
    """The numbers that a request's file holds."""
    from camgeo.files.precision import DECIMALS, SINGLE

    numbers = DECIMALS if request.kind == "3mf" else SINGLE
    return numbers.in_units(job.recipe.told_for(request).mm)


def aim(job: Job, request: FileRequest) -> float:
    """Tolerance left to the fit: what rounding to the file's numbers and a chamfer leave of the file's.

    Raises RecipeErrors where that is nothing.
    """
    import numpy as np

    contours = (contour for _, contour in job.design.contours)
    size = max(float(np.abs(contour.sample(contour.cells.low).point).max()) for contour in contours)
    # between two samples the contour reaches a little farther
    try:
        fine = precision_of(job, request).fit_tolerance(job.tolerance(request), 1.01 * size)
    except ToleranceError as error:
        raise job.refused(request, error) from error
    return fine * job.body.fineness


def cam_mesh(job: Job, request: FileRequest) -> tuple[Mesh, MeshFacts]:
    """The cam with everything that its part has, within a request's tolerance and in its file's numbers.

    Raises RecipeErrors and SurroundingsError as `make` does.
    """
    recipe, tolerance, precision = job.recipe, job.tolerance(request), precision_of(job, request)
    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "a solid needs a thickness")
    fine = aim(job, request)
    with job.refusals(request):
        contours = contours_of(job.design, job.outlines("polyline", fine))
        outlines = [*rim_of(job.body), *contours, *openings_of(job.body)]
        with job.clock.stage(f"mesh {request.kind}"):
            return part_mesh(outlines, job.body, tolerance=tolerance, precision=precision)
