"""Programs for milling machines: the cutter's path along the contour, and round holes that are wide enough."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.fit.cache import Fits
from camgeo.fit.pieces import ArcSpline
from camgeo.machining.gcode import Cutting, places, plain, rounding, write_gcode
from camgeo.machining.milling import clear_of_hub, few_passes, milled_holes, path_arcs, path_of, reach_check, unmilled
from camgeo.machining.toolpath import begun_at, bend_at_begin, circle, depths, led, passes
from camgeo.output.job import Made
from kin.judge.check import about

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.curve.curve import Curve
    from camgeo.machining.cutter import CutterPath
    from camgeo.machining.milling import RoundHole
    from camgeo.machining.toolpath import Loop, Pass
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.machining import Manufacture

FEATURE = "contour"
ROUGH = 0.1  # of the allowance, within which the passes run that leave it


def make_gcode(job: Job, request: FileRequest, path: Path) -> Made:
    """Fit, write, read back and judge one program; none is made for a cutter that does not reach all it must."""
    recipe, asked = job.recipe, job.recipe.manufacture
    if asked is None:
        raise recipe.error("manufacture", "gcode needs manufacture")
    clear_of_hub(recipe)
    few_passes(recipe)
    with job.refusals(request), job.clock.stage("cutter path"):
        check, _ = reach_check(recipe, job.design)
    check = about(check, path.name)
    if not check.ok:
        return Made((), (check,))
    mm = recipe.told_for(request).mm
    count = places(job.tolerance(request), mm, _told_apart(job, asked))
    with job.refusals(request):
        fine = _outline(job, path_of(recipe, job.design), job.tolerance(request) - rounding(count, mm))
        rough = None
        if asked.allowance is not None:
            rough = _outline(job, path_of(recipe, job.design, asked.allowance), ROUGH * asked.allowance)
        with job.clock.stage("write gcode"):
            features = [*_holes(job, asked), (FEATURE, _round(job, asked, rough, fine))]
            _write(job, request, path, features, count)
    bound = fine.bound.widened(rounding(count, mm))
    made = job.judged(request, path, bound, fine.count)
    return Made(made.files, (check, *made.checks))


def _told_apart(job: Job, asked: Manufacture) -> list[float]:
    """Lengths by which places of the program lie apart, mm."""
    step = -depths(job.recipe.part.thickness or 0.0, asked.depth_of_cut or math.inf)[0]
    found, _ = milled_holes(job.recipe, job.design)
    lead = min([asked.lead, *(0.5 * (hole.radius - asked.radius) for hole in found)])
    return [length for length in (step, asked.safe_height, asked.allowance, lead) if length]


def _outline(job: Job, path: CutterPath, tolerance: float) -> ArcSpline:
    """The cutter's path as arcs, which share the part's precautions against a formula that rounds."""
    unsure = max(fit.unsure for fit in job.fits)

    def fitted(curve: Curve, within: float) -> ArcSpline:
        outline = Fits(curve, job.clock, unsure).within("arcs", within)
        if not isinstance(outline, ArcSpline):
            raise TypeError("a path is made of arcs")
        return outline

    return path_arcs(job.recipe, path, tolerance, fitted)


def _round(job: Job, asked: Manufacture, rough: ArcSpline | None, fine: ArcSpline) -> list[Pass]:
    """Passes along the contour: round a disc, within a ring."""
    thickness = job.recipe.part.thickness
    if thickness is None:
        raise job.recipe.error("part.thickness", "gcode needs a thickness")
    side = job.design.only_surface.surface.side

    def loop(path: ArcSpline) -> Loop:
        begun = begun_at(path, asked.start)
        drawn = begun.mirrored() if job.recipe.rotation == "ccw" else begun
        lead = asked.lead if side > 0 else min(asked.lead, 0.5 * bend_at_begin(drawn))
        return led(drawn, lead, side=side, clockwise=(asked.direction == "climb") == (side > 0))

    return passes(None if rough is None else loop(rough), loop(fine), asked, thickness)


def _holes(job: Job, asked: Manufacture) -> list[tuple[str, list[Pass]]]:
    """Passes of the holes that are milled, by name."""
    found, _ = milled_holes(job.recipe, job.design)
    return [(hole.name, _hole(job, asked, hole)) for hole in found]


def _hole(job: Job, asked: Manufacture, hole: RoundHole) -> list[Pass]:
    sign = -1.0 if job.recipe.rotation == "ccw" else 1.0
    (x, y), reach = hole.centre, hole.radius - asked.radius

    def loop(radius: float) -> Loop:
        path = circle((x, sign * y), radius, sign * asked.start)
        return led(path, min(asked.lead, 0.5 * radius), side=-1, clockwise=asked.direction != "climb")

    left = reach - (asked.allowance or 0.0)
    rough = None if asked.allowance is None or left <= 0.5 * asked.allowance else loop(left)
    return passes(rough, loop(reach), asked, job.recipe.part.thickness or 0.0)


def _write(job: Job, request: FileRequest, path: Path, features: list[tuple[str, list[Pass]]], count: int) -> None:
    recipe, asked = job.recipe, job.recipe.manufacture
    if asked is None or not (asked.feed and asked.plunge and asked.spindle and asked.safe_height):
        raise recipe.error("manufacture", "gcode needs feed, plunge, spindle, depth_of_cut and safe_height")
    told = recipe.told_for(request)
    mm = told.mm
    top = "top of the stock" if recipe.part.hub is None else "upper face of the disc"
    remarks = [
        recipe.name,
        recipe.about,
        f"units: {told.units}",
        f"cutter: diameter {plain(asked.cutter / mm)}",
        f"tolerance: {plain(job.tolerance(request) / mm)}",
        f"zero: the shaft, {top}; thickness {plain((recipe.part.thickness or 0.0) / mm)}",
        f"{asked.direction} milling, spindle clockwise",
        *(f"not milled: {name}, {why}" for name, why in unmilled(recipe, job.design)),
    ]
    cutting = Cutting(asked.feed, asked.plunge, asked.spindle, asked.safe_height)
    write_gcode(path, features, cutting, remarks=[text for text in remarks if text], count=count, mm=mm)
