"""Drawings: the contour as arcs, a spline or a polyline, with what is cut inside it; DXF and SVG."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.files.precision import converted
from camgeo.output.job import Made
from kin.judge.check import about

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.files.dxf import Cutout, Reference
    from camgeo.fit.pieces import Outline
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from kin.judge.check import Check

COARSE = 1e-2  # mm: tolerance of the pitch curve drawn for reference, which nothing is cut by


def make_drawing(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit, write, read back and judge one drawing."""
    with job.refusals(request):
        own = request.units not in {None, job.recipe.units}
        outline = job.outline_written(
            request.as_ or "polyline", job.tolerance(request), lambda found: converted(found) if own else 0.0
        )
        checks, tool = _tool_path(job, request)
        with job.clock.stage(f"write {request.kind}"):
            _write(job, outline, request, path, tool)
    bound = outline.bound.widened(converted(outline)) if own else outline.bound
    made = job.judged(request, path, bound, outline.count)
    return Made(made.files, (*(about(check, path.name) for check in checks), *made.checks))


def _tool_path(job: Job, request: FileRequest) -> tuple[list[Check], list[Cutout]]:
    """The path of the cutter's centre where a DXF is to show it, and whether the cutter reaches everything."""
    asked = job.recipe.manufacture
    if asked is None or not asked.layer or request.kind != "dxf" or request.compensation is not None:
        return [], []
    from camgeo.files.dxf import Cutout
    from camgeo.machining.milling import path_arcs, reach_check

    with job.clock.stage("cutter path"):
        check, path = reach_check(job.recipe, job.design)
        if path is None:
            return [check], []
        arcs = path_arcs(job.recipe, path, job.tolerance(request))
    return [check], [Cutout("TOOLPATH", arcs.mirrored() if job.recipe.rotation == "ccw" else arcs)]


def _write(job: Job, outline: Outline, request: FileRequest, path: Path, tool: list[Cutout]) -> None:
    recipe, design = job.recipe.told_for(request), job.design
    bore, cut, remarks = recipe.part.bore, [], []
    if design.body is not None:
        from camgeo.output import part_geometry

        body = design.body.mirrored() if recipe.rotation == "ccw" else design.body
        bore, cut, remarks = None, part_geometry.cutouts(body), part_geometry.remarks(body, recipe.mm)
    if request.kind == "svg":
        from camgeo.files.svg import write_svg

        write_svg(
            path,
            outline,
            bore=bore,
            cutouts=cut,
            remarks=remarks,
            mm=recipe.mm,
            name=recipe.name,
            about=recipe.about,
        )
        return
    from camgeo.files.dxf import write_dxf

    write_dxf(
        path,
        outline,
        bore=bore,
        cutouts=[*cut, *tool],
        remarks=remarks,
        reference=_reference(job),
        mm=recipe.mm,
        version=request.version or "R2010",
        name=recipe.name,
        about=recipe.about,
    )


def _reference(job: Job) -> list[Reference]:
    """Centre, base or prime circle, and the pitch curve: to look at, not to cut."""
    from camgeo.files.dxf import Circle, Point, Trace
    from camgeo.fit.arcs import fit_arcs
    from camgeo.synthesis.part.walls import Looks, distance_inside

    recipe, surface = job.recipe, job.design.surface
    cam = recipe.cam
    found: list[Reference] = [Point("shaft", (0.0, 0.0))]
    if recipe.part.hub is not None:
        found.append(Circle("hub", (0.0, 0.0), 0.5 * recipe.part.hub.diameter))
    for name, radius in cam.circles():
        if radius is not None:
            found.append(Circle(name, (0.0, 0.0), radius))
            continue
        least = abs(distance_inside(Looks.of(surface.base), (0.0, 0.0))[0])
        if least > recipe.export.tolerance:  # the shaft may stand on the contour itself
            found.append(Circle(name, (0.0, 0.0), least))
        if surface.radius:
            pitch = fit_arcs(surface.base, COARSE)
            found.append(Trace("pitch curve", pitch.mirrored() if recipe.rotation == "ccw" else pitch))
    return found
