"""Intents by which kin judges the files of a linear cam, and its verdicts in the report's terms."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.linear.keys import GROOVE_LAYER
from camgeo.capabilities.linear.narrowed import narrowed
from camgeo.capabilities.linear.plate import body_of, openings
from camgeo.checks.declared import READABLE
from camgeo.measures.flanks import error_entry, play_entry
from camgeo.part.as_intent import holes_of, layers_of
from kin.contour.holes import Hole
from kin.linear.follower import Arm, LinearFollower, Stem
from kin.linear.intent import Ends, Groove, PlateIntent
from kin.linear.judge import judge_chains, verify
from kin.linear.verdict import PlateVerdict
from kin.numeric.check import about, failed
from kin.numeric.limits import Limits
from kin.numeric.records import replace
from kin.read.errors import ReadError
from kin.read.files import read_drawing

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.capabilities.linear.keys import LinearRecipe
    from camgeo.part.body import Body
    from camgeo.recipe.export import FileRequest
    from kin.judge.intent import Milling
    from kin.linear.verdict import FlankVerdict
    from kin.numeric.check import Check
    from kin.read.layers import Layer


def follower_of(design: LinearDesign) -> LinearFollower:
    """Follower of the intended plate, by which kin judges files."""
    recipe = design.recipe
    arm = recipe.follower.arm
    guide: Arm | Stem
    if arm is None:
        guide = Stem(-recipe.follower.lean)
    else:
        guide = Arm(arm.length, arm.pivot, 1 if arm.side == "trailing" else -1)
    return LinearFollower(guide, recipe.follower.radius, recipe.pitch, design.path.law.over)


def intended(design: LinearDesign, mm: float, *, solid: bool) -> PlateIntent:
    """Intended plate by which kin judges files, in the axes of one that travels to the left.

    `mm` is the length of a drawing's unit, mm; `solid` asks for the layers of a solid too.
    """
    recipe = design.recipe
    ends, groove = recipe.ends, recipe.groove
    body = body_of(design, None)
    mirrored = recipe.travel == "right"
    if mirrored:
        left = replace(recipe, travel="left")
        body = replace(body, openings=openings(left, drawn=True))
    outline = None
    if groove is not None:
        right, far, height = design.box
        corners = ((-right, 0.0), (-far, 0.0), (-far, height), (-right, height))
        outline = Hole("outline", "contour", corners, (0.0,) * 4)
    return PlateIntent(
        follower_of(design),
        None if ends is None else Ends(ends.overrun, ends.tangent),
        recipe.periods,
        None if groove is None else Groove(groove.clearance, GROOVE_LAYER, groove.depth if solid else None),
        outline,
        bool(recipe.trims and design.lower.lost),
        mirrored,
        mm,
        holes_of(body),
        thickness=recipe.plate.thickness if solid else None,
        layers=_layers(recipe, layers_of(body), outline) if solid else (),
    )


def _layers(recipe: LinearRecipe, layers: tuple[Layer, ...], outline: Hole | None) -> tuple[Layer, ...]:
    """Layers of a solid: below the floor of a groove those of the whole plate; none of a plain plate."""
    groove, thickness = recipe.groove, recipe.plate.thickness
    if groove is None or groove.depth is None or thickness is None:
        return layers if len(layers) > 1 else ()
    floor, found = thickness - groove.depth, []
    for layer in layers:
        if layer.low < floor < layer.high:
            found += [replace(layer, high=floor, outline=outline), replace(layer, low=floor)]
        else:
            found.append(replace(layer, outline=outline) if layer.high <= floor else layer)
    return tuple(found)


def limits_of(recipe: LinearRecipe, tolerance: float, gap: float | None = None) -> Limits:
    """Permitted errors of files; `tolerance` and `gap` in mm."""
    motion = recipe.verify.motion_error
    if motion is not None and recipe.swings:
        motion = math.degrees(motion)
    return Limits(tolerance, motion, gap=gap)


def judged_file(
    design: LinearDesign,
    path: Path,
    request: FileRequest | None,
    tolerance: float,
    *,
    units: float | None = None,
    gap: float | None = None,
) -> PlateVerdict:
    """Kin's verdict on a file; `units` is mm in the unit of a file that states none."""
    from kin.read.formats import format_of

    recipe = design.recipe
    if request is not None and request.compensation is not None:
        return _judged_grown(design, path, request.compensation.out, tolerance)
    unit = 25.4 if recipe.units == "inch" else 1.0
    record = format_of(path)
    if request is not None:
        unit = 25.4 if request.unit_for(recipe.units) == "inch" else 1.0
    unstated = units if units is not None or record.units else unit
    plate = intended(design, unit, solid=record.contents == "solid")
    return verify(path, plate, limits_of(recipe, tolerance, gap), unstated)


def _judged_grown(design: LinearDesign, path: Path, out: float, tolerance: float) -> PlateVerdict:
    """Kin's verdict on a drawing whose metal is larger by `out`, mm, all round: a roller smaller by that runs on it.

    Its lower edge lies `out` lower, so that the drawing is judged that much higher.
    """
    recipe = design.recipe
    plate = intended(design, 1.0, solid=False)
    roller = plate.follower
    smaller = replace(roller, radius=roller.radius - out, level=roller.level + out, guide=_raised(roller.guide, out))
    ends = None
    if recipe.ends is not None:
        u, side = np.array([0.0, design.total]), np.array([1, -1])
        before, after = design.path.sample(u, side).normal[:, 0] * out
        ends = Ends((recipe.ends.overrun[0] + out - before, recipe.ends.overrun[1] + out + after), recipe.ends.tangent)
    holes = holes_of(_narrowed_body(design, out))
    holes = tuple(replace(hole, points=tuple((x, y + out) for x, y in hole.points)) for hole in holes)
    through = tuple(hole for hole in holes if hole.depth is None)
    plate = replace(plate, follower=smaller, ends=ends, holes=through, mirrored=False)
    try:
        drawing = read_drawing(path, None, engraved=len(through) < len(holes), deepest=1)
    except ReadError as error:
        return PlateVerdict(path.suffix[1:], (failed(READABLE.name, error.message),)).about(path)
    chains = []
    for chain in drawing.chains:
        contour = chain.contour.mirrored().turned(math.pi) if recipe.travel == "right" else chain.contour
        chains.append(chain._replace(contour=contour.moved(0.0, out)))
    verdict = judge_chains(chains, plate, limits_of(recipe, tolerance), path.suffix[1:])
    return replace(verdict.about(path), units=drawing.units_mm)


def _raised(guide: Arm | Stem, by: float) -> Arm | Stem:
    return guide if isinstance(guide, Stem) else replace(guide, pivot=guide.pivot + by)


def _narrowed_body(design: LinearDesign, out: float) -> Body:
    """Body with openings smaller by `out`, mm, in the axes of a plate that travels to the left."""
    cut = openings(replace(design.recipe, travel="left"), drawn=True)
    return replace(body_of(design, None), openings=tuple(narrowed(opening, out) for opening in cut))


def judged_program(
    design: LinearDesign, path: Path, milling: Milling, tolerance: float, holes: set[str]
) -> tuple[PlateVerdict | None, tuple[Check, ...]]:
    """Kin's verdict on what a program leaves, and its checks with those of the program itself.

    `holes` are the names of those that it mills. There is no verdict where the program leaves no closed contour.
    """
    from kin.judge.milling import milled
    from kin.read.gcode import read_gcode

    plate = intended(design, 1.0, solid=False)
    plate = replace(plate, holes=tuple(hole for hole in plate.holes if hole.name in holes))
    if not milling.outline:
        plate = replace(plate, outline=None)
    try:
        done = milled(read_gcode(path), milling, tolerance)
    except ReadError as error:
        return None, (failed(READABLE.name, str(error)),)
    chains = [chain if milling.outline else chain._replace(layer=GROOVE_LAYER) for chain in done.chains]
    if plate.mirrored:
        chains = [chain._replace(contour=chain.contour.mirrored().turned(math.pi)) for chain in chains]
    verdict = judge_chains(chains, plate, limits_of(design.recipe, tolerance), "gcode")
    checks = (*done.checks, *verdict.checks)
    return verdict, tuple(about(check, path.name) for check in checks)


# --- in a report ------------------------------------------------------------------------------------------------------


def file_rows(recipe: LinearRecipe, verdict: PlateVerdict) -> dict[str, Any]:
    """Entries of a file in a report: what was measured on each of its flanks, and the play of a groove."""
    rows = [(flank.name, _flank(recipe, flank)) for flank in verdict.flanks]
    entry: dict[str, Any] = {"surfaces": [{"name": name, **row} for name, row in rows]} if rows else {}
    return (rows[0][1] if len(rows) == 1 else entry) | play_entry(recipe, verdict.play, "mm")


def _flank(recipe: LinearRecipe, flank: FlankVerdict) -> dict[str, Any]:
    reach = None if flank.reach is None else [length / recipe.mm for length in flank.reach]
    return {**error_entry(recipe, flank.measured_error, flank.motion, "mm"), "reach": reach}
