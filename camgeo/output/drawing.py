"""Drawings: the contour as arcs, a spline or a polyline, with what is cut inside it; DXF and SVG."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING

from camgeo.files.layer_outline import LayerOutline
from camgeo.files.precision import converted
from camgeo.fit.bound import Bound
from camgeo.output import part_geometry
from camgeo.output.job import Made
from camgeo.output.part_geometry import contours_of, openings_of, rim_of
from kin.judge.check import about

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.fit.pieces import Outline
    from camgeo.formats.dxf import Reference
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from kin.judge.check import Check

COARSE = 1e-2  # mm: tolerance of the pitch curve drawn for reference, which nothing is cut by


def make_drawing(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit, write, read back and judge one drawing."""
    own = request.units not in {None, job.recipe.units}

    def moved(outline: Outline) -> float:
        return converted(outline) if own else 0.0

    with job.refusals(request):
        contours = job.outlines_written(request.as_ or "polyline", job.tolerance(request), moved)
        checks, tool = _tool_path(job, request)
        with job.clock.stage(f"write {request.kind}"):
            _write(job, contours, request, path, tool)
    bound = reduce(Bound.wider, (outline.bound.widened(moved(outline)) for outline in contours))
    made = job.judged(request, path, bound, sum(outline.count for outline in contours))
    return Made(made.files, (*(about(check, path.name) for check in checks), *made.checks))


def _tool_path(job: Job, request: FileRequest) -> tuple[list[Check], list[LayerOutline]]:
    """The path of the cutter's centre where a DXF is to show it, and whether the cutter reaches everything."""
    asked = job.recipe.manufacture
    if asked is None or not asked.layer or request.kind != "dxf" or request.compensation is not None:
        return [], []
    from camgeo.machining.milling import path_arcs, reach_checks

    with job.clock.stage("cutter path"):
        reached = reach_checks(job.recipe, job.design)
        paths = [path_arcs(job.recipe, path, job.tolerance(request)) for _, path in reached if path is not None]
    drawn = [arcs.mirrored() if job.recipe.rotation == "ccw" else arcs for arcs in paths]
    return [check for check, _ in reached], [LayerOutline("TOOLPATH", arcs) for arcs in drawn]


def _write(job: Job, contours: Sequence[Outline], request: FileRequest, path: Path, tool: list[LayerOutline]) -> None:
    recipe, body = job.recipe.told_for(request), job.body
    outlines = [*contours_of(job.design, contours), *rim_of(body), *openings_of(body)]
    remarks = part_geometry.remarks(body, recipe.mm)
    if request.kind == "svg":
        from camgeo.formats.svg import write_svg

        write_svg(path, outlines, remarks=remarks, mm=recipe.mm, name=recipe.name, about=recipe.about)
        return
    from camgeo.formats.dxf import write_dxf

    write_dxf(
        path,
        [*outlines, *tool],
        remarks=remarks,
        reference=_reference(job, job.tolerance(request)),
        mm=recipe.mm,
        version=request.version or "R2010",
        name=recipe.name,
        about=recipe.about,
    )


def _reference(job: Job, tolerance: float) -> list[Reference]:
    """Centre, base or prime circle, the pitch curve, and paths of points of links: to look at, not to cut."""
    from camgeo.fit.arcs import fit_arcs
    from camgeo.formats.dxf import Circle, Line, Point, Trace
    from camgeo.synthesis.part.walls import Looks, distance_inside

    recipe, exact = job.recipe, job.design.exact
    pitches = {id(surface.base): surface for surface, _ in job.design.contours}.values()
    found: list[Reference] = [Point("shaft", (0.0, 0.0))]
    if recipe.part.hub is not None:
        found.append(Circle("hub", (0.0, 0.0), 0.5 * recipe.part.hub.diameter))
    for surface in pitches:
        for name, radius in exact.circles(surface.name):
            if radius is not None:
                found.append(Circle(name, (0.0, 0.0), radius))
                continue
            least = abs(distance_inside(Looks.of(surface.base), (0.0, 0.0))[0])
            if least > recipe.export.tolerance:  # the shaft may stand on the contour itself
                found.append(Circle(name, (0.0, 0.0), least))
            if surface.radius:
                pitch = fit_arcs(surface.base, COARSE)
                found.append(Trace("pitch curve", pitch.mirrored() if recipe.rotation == "ccw" else pitch))
    if recipe.linkage is not None and recipe.linkage.traces:
        from camgeo.synthesis.traces import trace_lines

        found += [Line(name, points) for name, points in trace_lines(recipe, job.design, tolerance)]
    return found
