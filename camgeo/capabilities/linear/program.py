"""Milling programs of a plate: round its outline or within its groove, and round holes that are wide enough."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.linear.design import in_recipe
from camgeo.capabilities.linear.flank import convex_radius
from camgeo.capabilities.linear.plate import as_drawn, openings
from camgeo.capabilities.linear.verdicts import judged_program
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.files.gcode import Cutting, places, plain, rounding, write_gcode
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.pieces import ArcSpline
from camgeo.machining.cutter import CutterPath
from camgeo.machining.toolpath import begun_at, circle, led, passes, plunged
from camgeo.measures.file_result import FileResult
from camgeo.output.own_kind import Made
from kin.judge.intent import Milling

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.capabilities.linear.job import Job
    from camgeo.files.gcode import ClosedPath, Pass
    from camgeo.fit.pieces import Outline
    from camgeo.part.shapes import Opening
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.machining import Manufacture
    from kin.linear.verdict import PlateVerdict

FEATURE = "contour"
LEAST_ROOM = 1e-2  # mm: a hole that is wider than the cutter by less than twice this is not milled
NARROWEST = 2e-2  # mm: width of a path within a groove, below which the cutter would run back on itself
MOST_PASSES = 2000
DOWN = -0.5 * math.pi


def make_program(job: Job, request: FileRequest, path: Path) -> Made[PlateVerdict]:
    """Fit, write, read back and judge a program.

    Raises RecipeErrors for a cutter that does not come into the hollows of the flank, or does not clear the groove, for
    too many passes, and where the tolerance cannot be held; OSError where it cannot be written.
    """
    design, recipe = job.design, job.design.recipe
    mill, thickness = recipe.manufacture, recipe.plate.thickness
    if mill is None or thickness is None or not (mill.feed and mill.plunge and mill.spindle and mill.safe_height):
        raise recipe.error("manufacture", "a program needs feed, plunge, spindle, depth_of_cut and safe_height")
    depth = thickness if recipe.groove is None else recipe.groove.depth or thickness
    cut = mill.depth_of_cut or depth
    if depth / cut > MOST_PASSES:
        remedy = f"give at least {depth / MOST_PASSES / recipe.mm:.6g} {recipe.units}"
        raise recipe.error("manufacture.depth_of_cut", f"makes more than {MOST_PASSES} passes", None, remedy)
    mm = 25.4 if request.unit_for(recipe.units) == "inch" else 1.0
    count = places(job.tolerance(request), mm, [min(cut, depth), mill.safe_height, mill.lead])
    within = job.tolerance(request) - rounding(count, mm)
    with job.clock.stage("cutter path"):
        loop = _contour(design, mill, within) if recipe.groove is None else _pocket(design, mill, within)
    bored, unmade = _round_holes(design, mill)
    features = [(hole.name, _hole(hole, mill, thickness)) for hole in bored]
    features.append((FEATURE, passes([], [_lap(loop, mill, recipe.groove is None)], mill, depth)))
    remarks = [
        recipe.name,
        recipe.about,
        f"units: {'inch' if mm != 1.0 else 'mm'}",
        f"cutter: diameter {plain(mill.cutter / mm)}",
        f"tolerance: {plain(job.tolerance(request) / mm)}",
        f"zero: the guide at input 0 and the lower edge, top of the stock; thickness {plain(thickness / mm)}",
        f"{mill.direction} milling, spindle clockwise",
        *(f"not milled: {name}, {why}" for name, why in unmade),
    ]
    with job.clock.stage(f"write {request.kind}"):
        cutting = Cutting(mill.feed, mill.plunge, mill.spindle, mill.safe_height)
        write_gcode(path, features, cutting, remarks=[text for text in remarks if text], count=count, mm=mm)
    milling = Milling(mill.radius, depth, cut, mill.direction == "climb", outline=recipe.groove is None)
    with job.clock.stage(f"judge {request.kind}"):
        verdict, checks = judged_program(design, path, milling, job.tolerance(request), {hole.name for hole in bored})
    bound = loop.bound.widened(rounding(count, mm))
    file = FileResult(path, request, job.tolerance(request), loop.count, bound, units=mm)
    return Made(file, checks, verdict)


def _arcs(outline: Outline) -> ArcSpline:
    if not isinstance(outline, ArcSpline):
        raise TypeError("a path is made of arcs")
    return outline


def _contour(design: LinearDesign, mill: Manufacture, tolerance: float) -> ArcSpline:
    """Path of the cutter's centre round the plate, as drawn; about its corners the cutter swings."""
    recipe = design.recipe
    hollow = convex_radius(design.path, -1)[0] + design.lower.distance
    if not mill.radius < hollow:
        problem = f"the cutter does not come into the hollow of the flank, whose radius is {hollow / recipe.mm:.6g}"
        remedy = f"give less than {2.0 * hollow / recipe.mm:.4g} {recipe.units}"
        raise recipe.error("manufacture.cutter", in_recipe(recipe, problem), None, remedy)
    beside = Curve(Parallel(design.outline.shape, -mill.radius), design.outline.runs)
    return _arcs(as_drawn(design, CutterPath(beside, mill.radius, corners=True).arcs(tolerance)))


def _pocket(design: LinearDesign, mill: Manufacture, tolerance: float) -> ArcSpline:
    """Path of the cutter's centre within the groove, as drawn, round which it clears all of it."""
    recipe, groove = design.recipe, design.recipe.groove
    if groove is None:
        raise ValueError(recipe.name)
    wide = 2.0 * recipe.follower.radius + groove.clearance
    least, most = 0.5 * wide, wide - NARROWEST
    if not least <= mill.cutter <= most:
        remedy = f"give {least / recipe.mm:.6g} to {most / recipe.mm:.6g} {recipe.units}"
        problem = f"does not clear a groove {wide / recipe.mm:.6g} {recipe.units} wide on one round"
        raise recipe.error("manufacture.cutter", problem, f"{mill.cutter / recipe.mm:.6g} {recipe.units}", remedy)
    return _arcs(as_drawn(design, fit_arcs(design.groove_within(mill.radius), tolerance)))


def _lap(path: ArcSpline, mill: Manufacture, outside: bool) -> ClosedPath:
    """A round on the path, with ways in and out from outside the plate; in a groove the cutter comes down on it."""
    clockwise = (mill.direction == "climb") == outside
    if not outside:
        return plunged(path, clockwise=clockwise)
    return led(begun_at(path, DOWN), mill.lead, side=1, clockwise=clockwise)


def _round_holes(design: LinearDesign, mill: Manufacture) -> tuple[list[Opening], list[tuple[str, str]]]:
    """Holes that the cutter goes round, as drawn, and pairs of the name of what is not milled, and the reason."""
    recipe, wide, others = design.recipe, [], list[tuple[str, str]]()
    for opening in openings(recipe, drawn=True):
        if opening.circle is None or opening.depth is not None:
            others.append((opening.name, "not a round hole" if opening.depth is None else "engraved"))
        elif not mill.holes:
            others.append((opening.name, "manufacture.holes is not true"))
        elif recipe.groove is not None:
            others.append((opening.name, "the program mills the groove alone"))
        elif opening.circle[1] < mill.radius + LEAST_ROOM:
            others.append((opening.name, "not wider than the cutter"))
        else:
            wide.append(opening)
    if recipe.plate.chamfer:
        others.append(("chamfer", "the cutter cuts straight down"))
    if recipe.groove is not None:
        others.append(("outline", "the stock comes with it"))
    return wide, others


def _hole(hole: Opening, mill: Manufacture, depth: float) -> list[Pass]:
    if hole.circle is None:
        raise ValueError(hole.name)
    centre, radius = hole.circle
    reach = radius - mill.radius
    path = circle(centre, reach, DOWN)
    lap = led(path, min(mill.lead, 0.5 * reach), side=-1, clockwise=mill.direction != "climb")
    return passes([], [lap], mill, depth)
