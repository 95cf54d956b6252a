"""Solids of the cam with exact surfaces, for CAD systems; STEP."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.files.brep import need_kernel
from camgeo.output.part_geometry import contours_of, rim_of, solid_of

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job, Made
    from camgeo.recipe.export import FileRequest


def make_step(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit, write, read back and judge one STEP file; without the kernel nothing is fitted."""
    from camgeo.files.step import write_step, written_off

    recipe, tolerance = job.recipe.told_for(request), job.tolerance(request)
    with job.refusals(request):
        need_kernel()
        form = request.as_ or "arcs"
        contours = job.outlines_written(form, tolerance, lambda found: written_off(found, recipe.units))
        with job.clock.stage("write step"):
            if recipe.part.thickness is None:
                raise recipe.error("part.thickness", "a solid needs a thickness")
            bound = write_step(
                path,
                [*rim_of(job.body), *contours_of(job.design, contours)],
                solid_of(job.body),
                tolerance=tolerance,
                units=recipe.units,
                name=recipe.name,
                about=recipe.about,
            )
    return job.judged(request, path, bound, sum(outline.count for outline in contours))
