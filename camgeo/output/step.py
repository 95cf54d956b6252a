"""Solids of the cam with exact surfaces, for CAD systems; STEP."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.files.brep import need_kernel
from camgeo.fit.pieces import Polygon

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.files.solid import Solid
    from camgeo.output.job import Job, Made
    from camgeo.recipe.export import FileRequest


def make_step(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit, write, read back and judge one STEP file; without the kernel nothing is fitted."""
    from camgeo.files.step import write_step, written_off

    recipe, tolerance = job.recipe.told_for(request), job.tolerance(request)
    with job.refusals(request):
        need_kernel()
        form = request.as_ or "arcs"
        outline = job.outline_written(form, tolerance, lambda found: written_off(found, recipe.units))
        if isinstance(outline, Polygon):
            raise TypeError("a STEP file has no polygons")
        with job.clock.stage("write step"):
            bound = write_step(
                path,
                outline,
                _solid(job),
                tolerance=tolerance,
                units=recipe.units,
                name=recipe.name,
                about=recipe.about,
            )
    return job.judged(request, path, bound, outline.count)


def _solid(job: Job) -> Solid:
    """What the part is made of round its contour, mirrored as the recipe has it."""
    recipe, body = job.recipe, job.design.body
    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "a solid needs a thickness")
    if body is not None:
        from camgeo.output.part_geometry import solid_of

        return solid_of(body.mirrored() if recipe.rotation == "ccw" else body)
    from camgeo.files.solid import Cut, Solid
    from camgeo.synthesis.part.shapes import disc

    bore, thickness = recipe.part.bore, recipe.part.thickness
    round_bore = [] if bore is None else [disc("bore", "BORE", (0.0, 0.0), 0.5 * bore).outline]
    cuts = [Cut(outline, 0.0, thickness) for outline in round_bore]
    return Solid(thickness, 0.0, thickness, None, None, cuts, None)
