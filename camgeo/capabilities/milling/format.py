"""Programs for milling machines: the cutter's path along the contour, judged by what the cutter leaves; RS-274."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.milling.keys import check_boss, check_milling, check_slight
from camgeo.checks.extension import Holes
from camgeo.formats.options import RECIPE_UNITS, TOLERANCE
from camgeo.output.extension import Making
from camgeo.registry.formats import Format
from camgeo.schema.fields import FieldTable
from camgeo.synthesis.intent import FileIntent

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job, MadeFiles
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.machining import Manufacture
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent


def _check(file: Values, values: Values, reader: Reader) -> None:
    check_slight(values, reader)
    check_boss(values, reader)
    check_milling(file["path"], reader)


def _make(job: Job, request: FileRequest, path: Path) -> MadeFiles:
    from camgeo.capabilities.milling.program import make_gcode

    return make_gcode(job, request, path)


def _intent(recipe: Recipe, design: Design) -> PartIntent:
    """Intent by which a program is judged: the part as it is milled.

    Raises RecipeErrors without `manufacture` or a thickness, and where the exact contour or the cutter's path fails.
    """
    from camgeo.capabilities.milling.milling import milling_intent
    from camgeo.curve.curve import CurveError

    if recipe.manufacture is None:
        raise recipe.error("manufacture", "missing", None, "give manufacture: a program is judged by its cutter")
    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "missing", None, "give part.thickness: a program is judged by its depth")
    if not design.contours:
        raise recipe.error("cam", "a check of the exact contour fails, so nothing can be milled")
    try:
        return milling_intent(recipe, design)
    except CurveError as error:
        raise recipe.error("manufacture.cutter", str(error)) from error


def _unmade(recipe: Recipe, design: Design) -> list[tuple[str, str]]:
    from camgeo.capabilities.milling.milling import unmilled

    if recipe.manufacture is None:
        return []
    left = dict.fromkeys(each for single in design.single for each in unmilled(recipe, single))
    return [(name, f"not milled: {why}") for name, why in left]


def _bored(recipe: Recipe) -> bool:
    """Whether the bore is a round one that is milled."""
    part, milling = recipe.part, recipe.manufacture
    if part.bore is None or milling is None or not milling.holes or not part.round_bore or part.boss is not None:
        return False
    return part.bore >= _least_hole(milling)


def _drilled(recipe: Recipe) -> bool:
    """Whether holes other than the bore are milled; lightening holes do not count, as they are placed later."""
    part, milling = recipe.part, recipe.manufacture
    if milling is None or not milling.holes:
        return False
    reach, least = 0.0 if part.boss is None else 0.5 * part.boss.diameter, 0.5 * _least_hole(milling)
    circles = [opening.circle for opening in part.openings if opening.circle is not None]
    return any(math.hypot(*centre) >= reach and radius >= least for centre, radius in circles)


def _least_hole(manufacture: Manufacture) -> float:
    """Least diameter of a hole that the cutter goes round, mm."""
    from camgeo.capabilities.milling.milling import LEAST_ROOM

    return manufacture.cutter + 2.0 * LEAST_ROOM


FORMAT = Format(
    name="gcode",
    suffix="ngc",
    options=FieldTable((RECIPE_UNITS, TOLERANCE)),
    check=_check,
    part=False,
    by_disc=True,
)
HOLES = Holes(bored=_bored, drilled=_drilled)
INTENT = FileIntent(_intent)
MAKING = Making(make=_make, unmade=_unmade)
