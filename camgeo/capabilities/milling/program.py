"""Programs for milling machines: the cutter's path along the contour, and round holes that are wide enough."""

from __future__ import annotations

import math
from functools import reduce
from typing import TYPE_CHECKING

from camgeo.capabilities.milling.milling import few_passes, milled_holes, pocket_of, unmilled
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.files.gcode import Cutting, places, plain, rounding, write_gcode
from camgeo.fit.bound import Bound
from camgeo.fit.cache import Fits
from camgeo.fit.pieces import ArcSpline
from camgeo.machining.cutter import CutterPath
from camgeo.machining.reach import cutter_paths, path_arcs, reach_checks
from camgeo.machining.toolpath import (
    begun_at,
    bend_at_begin,
    circle,
    depths,
    led,
    passes,
    plunged,
    side_by_side,
)
from camgeo.output.job import MadeFiles
from kin.numeric.check import about
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.milling.milling import RoundHole
    from camgeo.files.gcode import ClosedPath, Pass
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.machining import Manufacture
    from kin.law.contacts import Side

FEATURE = "contour"
ROUGH = 0.1  # of the allowance, or of what a rough path leaves, within which it runs
ONE = 0.2  # of the tolerance: two paths no farther apart are milled as one path in their middle
LEAD = 0.4  # greatest share of the distance between two paths that the ways in and out take
LEAST_LEAD = 1e-2  # mm: radius of a way in below which there is none


def make_gcode(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    """Fit, write, read back and judge one program; none is made where the cutter does not reach all it must.

    Raises RecipeErrors without `manufacture`, for a value that the program needs and the recipe lacks, for so slight a
    depth of cut that there are too many passes, and where the tolerance cannot be held.
    """
    recipe, manufacture = job.recipe, job.recipe.manufacture
    if manufacture is None:
        raise recipe.error("manufacture", "gcode needs manufacture")
    few_passes(recipe, recipe.part.thickness)
    with job.refusals(request), job.clock.stage("cutter path"):
        checks = tuple(about(check, path.name) for check, _ in reach_checks(recipe, job.design))
    if not all(check.ok for check in checks):
        return MadeFiles((), checks)
    mm = recipe.in_units_of(request).mm
    with job.refusals(request):
        places_apart, mill = _told_apart(job, manufacture), _contour if pocket_of(job.design) is None else _pocket
        count = places(job.tolerance(request), mm, places_apart)
        steps, fine = mill(job, manufacture, job.tolerance(request) - rounding(count, mm))
        with job.clock.stage("write gcode"):
            _write(job, request, path, [*_holes(job, manufacture), (FEATURE, steps)], count)
    bound = reduce(Bound.wider, (outline.bound for outline in fine)).widened(rounding(count, mm))
    made = job.judge(request, path, bound, sum(outline.count for outline in fine))
    return MadeFiles(made.files, (*checks, *made.checks))


def _told_apart(job: Job, manufacture: Manufacture) -> list[float]:
    """Differences between heights and paths of the program, mm, which its decimals must show."""
    pocket, thickness = pocket_of(job.design), job.recipe.part.thickness or 0.0
    step = -max(depths(depth, manufacture.depth_of_cut or math.inf)[0] for depth in (pocket or thickness, thickness))
    holes, _ = milled_holes(job.recipe, job.design)
    lead = min([manufacture.lead, *(0.5 * (hole.radius - manufacture.radius) for hole in holes)])
    return [length for length in (step, manufacture.safe_height, manufacture.allowance, lead) if length]


def _outline(job: Job, path: CutterPath, tolerance: float) -> ArcSpline:
    """Path of the cutter as arcs within `tolerance` mm; the bound includes the rounding of the part's formulas."""
    unsure = max(fit.unsure for fit in job.fits)

    def fit_curve(curve: Curve, within: float) -> ArcSpline:
        outline = Fits(curve, job.clock, unsure).within("arcs", within)
        if not isinstance(outline, ArcSpline):
            raise TypeError("a path is made of arcs")
        return outline

    return path_arcs(job.recipe, path, tolerance, fit_curve)


def _contour(job: Job, manufacture: Manufacture, tolerance: float) -> tuple[list[Pass], list[ArcSpline]]:
    """Passes along the contour, round a disc or within a ring, and the path, in a list, that makes the contour."""
    thickness, (surface, _) = job.recipe.part.thickness, job.design.contours[0]
    if thickness is None:
        raise job.recipe.error("part.thickness", "gcode needs a thickness")
    (path,) = cutter_paths(job.recipe, job.design)
    fine, rough = _outline(job, path, tolerance), list[ArcSpline]()
    if manufacture.allowance is not None:
        (path,) = cutter_paths(job.recipe, job.design, manufacture.allowance)
        rough = [_outline(job, path, ROUGH * manufacture.allowance)]
    loops = [_lap(job, manufacture, outline, surface.side) for outline in (*rough, fine)]
    return passes(loops[:-1], loops[-1:], manufacture, thickness), [fine]


def _lap(job: Job, manufacture: Manufacture, path: ArcSpline, side: Side, room: float = math.inf) -> ClosedPath:
    """A path along a surface, with ways in and out within the free distance `room`, mm.

    Where that distance is too small the path has none, and the cutter comes down on it.
    """
    begun = begun_at(path, manufacture.start)
    drawn = begun.mirrored() if job.recipe.rotation == "ccw" else begun
    clockwise = (manufacture.direction == "climb") == (side > 0)
    if LEAD * room < LEAST_LEAD:
        return plunged(drawn, clockwise=clockwise)
    lead = manufacture.lead if side > 0 else min(manufacture.lead, 0.5 * bend_at_begin(drawn))
    return led(drawn, min(lead, LEAD * room), side=side, clockwise=clockwise)


def _pocket(job: Job, manufacture: Manufacture, tolerance: float) -> tuple[list[Pass], list[ArcSpline]]:
    """Passes between two surfaces, down the middle first and along both last, and the paths along the surfaces.

    Where both paths coincide within the tolerance, a path in the middle makes both surfaces.
    """
    (inner, _), (outer, _) = job.design.contours
    pitch, radius, depth = inner.base.shape, manufacture.radius, pocket_of(job.design)
    if depth is None:
        raise job.recipe.error("cam.track.groove.depth", "gcode needs the depth of the groove")
    # distances of the cutter's centre from the pitch curve, mm, outward positive
    least, greatest = radius - inner.radius, outer.radius - radius
    play = greatest - least

    def path_at(offset: float, within: float) -> ArcSpline:
        return _outline(job, CutterPath(Curve.whole(Parallel(pitch, -offset)), radius), within)

    flanks = cutter_paths(job.recipe, job.design)
    if play <= ONE * tolerance and not any(path.lost for path in flanks):
        middle = path_at(0.5 * (least + greatest), tolerance - 0.5 * max(play, 0.0))
        fine = [replace(middle, bound=middle.bound.widened(0.5 * max(play, 0.0)))]
        return passes([], [_lap(job, manufacture, middle, inner.side, 0.0)], manufacture, depth), fine
    # paths side by side clear the middle; each runs in the sense of the nearer surface
    offsets = side_by_side(least, greatest, radius, manufacture.allowance or 0.0)
    if not manufacture.allowance and len(offsets) > 1:
        del offsets[-2:]  # the flanks' own
    few_passes(job.recipe, depth, len(offsets) + len(flanks))
    rough = [
        path_at(offset, max(tolerance, ROUGH * min(offset - least, greatest - offset, radius))) for offset in offsets
    ]
    fine = [_outline(job, path, tolerance) for path in flanks]
    sides = [(inner if offset - least < greatest - offset else outer).side for offset in offsets]
    roughing = [_lap(job, manufacture, path, side, 0.0) for path, side in zip(rough, sides, strict=True)]
    finishing = [_lap(job, manufacture, path, each.side, play) for path, each in zip(fine, (inner, outer), strict=True)]
    return passes(roughing, finishing, manufacture, depth), fine


def _holes(job: Job, manufacture: Manufacture) -> list[tuple[str, list[Pass]]]:
    """Passes of the holes that are milled, by name."""
    holes, _ = milled_holes(job.recipe, job.design)
    return [(hole.name, _hole(job, manufacture, hole)) for hole in holes]


def _hole(job: Job, manufacture: Manufacture, hole: RoundHole) -> list[Pass]:
    sign = -1.0 if job.recipe.rotation == "ccw" else 1.0
    (x, y), reach = hole.centre, hole.radius - manufacture.radius

    def loop(radius: float) -> ClosedPath:
        path = circle((x, sign * y), radius, sign * manufacture.start)
        return led(path, min(manufacture.lead, 0.5 * radius), side=-1, clockwise=manufacture.direction != "climb")

    left = reach - (manufacture.allowance or 0.0)
    rough = [] if manufacture.allowance is None or left <= 0.5 * manufacture.allowance else [loop(left)]
    return passes(rough, [loop(reach)], manufacture, job.recipe.part.thickness or 0.0)


def _write(job: Job, request: FileRequest, path: Path, features: list[tuple[str, list[Pass]]], count: int) -> None:
    recipe, manufacture = job.recipe, job.recipe.manufacture
    if manufacture is None or not (
        manufacture.feed and manufacture.plunge and manufacture.spindle and manufacture.safe_height
    ):
        raise recipe.error("manufacture", "gcode needs feed, plunge, spindle, depth_of_cut and safe_height")
    in_units = recipe.in_units_of(request)
    mm = in_units.mm
    top = "top of the stock" if recipe.part.boss is None else "upper face of the disc"
    remarks = [
        recipe.name,
        recipe.about,
        f"units: {in_units.units}",
        f"cutter: diameter {plain(manufacture.cutter / mm)}",
        f"tolerance: {plain(job.tolerance(request) / mm)}",
        f"zero: the shaft, {top}; thickness {plain((recipe.part.thickness or 0.0) / mm)}",
        f"{manufacture.direction} milling, spindle clockwise",
        *(f"not milled: {name}, {why}" for name, why in unmilled(recipe, job.design)),
    ]
    cutting = Cutting(manufacture.feed, manufacture.plunge, manufacture.spindle, manufacture.safe_height)
    write_gcode(path, features, cutting, remarks=[text for text in remarks if text], count=count, mm=mm)
