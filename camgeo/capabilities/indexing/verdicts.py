"""Intents by which kin judges the files of an indexing cam, and its verdicts in the report's terms."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.indexing.development import developed
from camgeo.capabilities.indexing.keys import EXAMPLE, FILES, NO_PROGRAM, SOLID_OF_IT
from camgeo.common.units import UNIT_MM
from camgeo.formats.turned import developments_asked, program_asked
from camgeo.machining.turned import cutting_of
from camgeo.part.as_intent import holes_of
from camgeo.part.body import Body
from kin.indexing import intent
from kin.numeric.limits import Limits
from kin.read.formats import format_of

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.recipe.export import FileRequest
    from kin.turned.verdict import TurnedVerdict


def intended(design: IndexDesign, mm: float = 1.0) -> intent.IndexIntent:
    """Intended cam by which kin judges files; `mm` is the length of a drawing's unit, mm."""
    recipe, roller = design.recipe, design.recipe.roller
    bore = None if design.bore is None else holes_of(Body(recipe.length, (design.bore,)))[0]
    return intent.IndexIntent(
        recipe.turret.intended(),
        recipe.turret.height,
        recipe.length,
        design.motion.motion,
        recipe.start,
        recipe.stops,
        roller.radius,
        roller.inner,
        roller.outer,
        recipe.clearance,
        bore,
        mirrored=recipe.mirrored,
        mm=mm,
    )


def judged_file(
    design: IndexDesign,
    path: Path,
    request: FileRequest | None,
    tolerance: float,
    *,
    units: float | None = None,
    gap: float | None = None,  # noqa: ARG001 - lines of a development are not joined
) -> TurnedVerdict:
    """Kin's verdict on a file; `units` is mm in the unit of a file that states none.

    A drawing that the recipe does not request is compared with all developments that it does request, or else with the
    default one. Raises RecipeErrors for a drawing or a program of a globoid.
    """
    from kin.indexing.judge import verify

    recipe = design.recipe
    limits = Limits(tolerance, recipe.verify.motion_error)
    if format_of(path).contents == "program":
        return _judged_program(design, path, request, limits)
    stated = format_of(path).units
    if format_of(path).contents != "drawing":
        own = 1.0 if request is None else UNIT_MM[request.unit_for("mm")]
        return verify(path, intended(design), limits, None if stated else units or own)
    if not recipe.turret.unrolls:
        raise recipe.error(recipe.stated("cam.globoid"), "a globoid has no development", None, "give a solid of it")
    from kin.indexing.judge import verify_development

    asked = developments_asked(recipe, request, FILES)
    mm = UNIT_MM[asked[0].unit_for(recipe.units)]
    lines = {line.layer: line for each in asked for line in developed(design, each, mm)}
    return verify_development(path, intended(design, mm), list(lines.values()), limits, None if stated else units or mm)


def _judged_program(design: IndexDesign, path: Path, request: FileRequest | None, limits: Limits) -> TurnedVerdict:
    """Kin's verdict on a program; one that the recipe does not ask for is judged by the cutter of one that it does."""
    from kin.indexing.program import verify_program

    recipe = design.recipe
    if not recipe.turret.unrolls:
        raise recipe.error(recipe.stated("cam.globoid"), NO_PROGRAM, None, SOLID_OF_IT)
    asked = program_asked(recipe, request, EXAMPLE)
    return verify_program(path, intended(design), cutting_of(asked, recipe.form.depth), limits)
