"""Intents by which kin judges the files of a cylindrical cam, and its verdicts in the report's terms."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.cylindrical.development import developed
from camgeo.capabilities.cylindrical.keys import FILES
from camgeo.common.units import UNIT_MM
from camgeo.formats.turned import developments_asked, program_asked
from camgeo.machining.turned import cutting_of
from camgeo.part.as_intent import holes_of
from camgeo.part.body import Body
from kin.cylindrical import intent
from kin.cylindrical.follower import DrumFollower
from kin.cylindrical.judge import verify, verify_development
from kin.numeric.limits import Limits
from kin.read.formats import format_of

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.recipe.export import FileRequest
    from kin.turned.verdict import TurnedVerdict


def intended(design: DrumDesign, mm: float = 1.0) -> intent.DrumIntent:
    """Intended drum by which kin judges files; `mm` is the length of a drawing's unit, mm."""
    recipe, roller = design.recipe, design.recipe.roller
    led: dict[str, Any] = recipe.guide.intended()
    if roller.taper:
        led |= {"taper": roller.taper, "at": roller.at}
    if roller.shoe is not None:
        led["shoe"] = roller.shoe
    bore = None if design.bore is None else holes_of(Body(recipe.height, (design.bore,)))[0]
    return intent.DrumIntent(
        DrumFollower(roller.radius, roller.inner, roller.outer, recipe.level, design.law, turns=recipe.turns, **led),
        recipe.track.intended(),
        recipe.radius,
        recipe.height,
        bore,
        shortened=any(design.tips.values()),
        mirrored=recipe.mirrored,
        mm=mm,
    )


def judged_file(
    design: DrumDesign,
    path: Path,
    request: FileRequest | None,
    tolerance: float,
    *,
    units: float | None = None,
    gap: float | None = None,  # noqa: ARG001 - lines of a development are not joined
) -> TurnedVerdict:
    """Kin's verdict on a file; `units` is mm in the unit of a file that states none.

    A drawing that the recipe does not request is compared with all developments that it does request, or else with the
    default one.
    """
    recipe = design.recipe
    limits = Limits(tolerance, recipe.verify.motion_error)
    if format_of(path).contents == "program":
        return _judged_program(design, path, request, limits)
    stated = format_of(path).units
    if format_of(path).shell is not None:
        from kin.cylindrical.exact import verify_surfaces

        return verify_surfaces(path, intended(design), limits)
    if format_of(path).contents != "drawing":
        own = 1.0 if request is None else UNIT_MM[request.unit_for("mm")]
        return verify(path, intended(design), limits, None if stated else units or own)
    asked = developments_asked(recipe, request, FILES)
    mm = UNIT_MM[asked[0].unit_for(recipe.units)]
    lines = {line.layer: line for each in asked for line in developed(design, each, mm)}
    return verify_development(path, intended(design, mm), list(lines.values()), limits, None if stated else units or mm)


def _judged_program(design: DrumDesign, path: Path, request: FileRequest | None, limits: Limits) -> TurnedVerdict:
    """Kin's verdict on a program; one that the recipe does not ask for is judged by the cutter of one that it does."""
    from kin.cylindrical.program import verify_program

    recipe = design.recipe
    asked = program_asked(recipe, request, "axes: [X, A], cutter: 20, ...")
    return verify_program(path, intended(design), cutting_of(asked, recipe.track.depth), limits)
