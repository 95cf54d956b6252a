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
    from camgeo.formats.step import StepBody, write_step, written_off

    recipe, tolerance = job.recipe.told_for(request), job.tolerance(request)
    with job.refusals(request):
        need_kernel()
        form = request.as_ or "arcs"
        discs = job.design.discs
        names = [disc.name if len(discs) > 1 else "" for disc in discs]
        drawn = [
            one.outlines_written(form, tolerance, lambda fit: written_off(fit, recipe.units)) for one in job.single
        ]
        with job.clock.stage("write step"):
            if recipe.part.thickness is None:
                raise recipe.error("part.thickness", "a solid needs a thickness")
            bodies = [
                StepBody([*rim_of(one.body), *contours_of(one.design, contours)], solid_of(one.body), name, disc.z)
                for one, contours, name, disc in zip(job.single, drawn, names, discs, strict=True)
            ]
            bound = write_step(
                path,
                bodies,
                tolerance=tolerance,
                units=recipe.units,
                name=recipe.name,
                about=recipe.about,
            )
    judged = job.judged if len(discs) == 1 else job.judged_together
    return judged(request, path, bound, sum(outline.count for contours in drawn for outline in contours))
