"""Programs for milling machines: the cutter's path along the contour, judged by what the cutter leaves; RS-274."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.formats.options import RECIPE_UNITS, TOLERANCE
from camgeo.recipe.machining import check_milling, check_slight
from camgeo.registry.formats import Format
from camgeo.schema.fields import Table

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.output.job import Job, Made
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.reader import Reader, Values
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent


def _check(file: Values, values: Values, reader: Reader) -> None:
    check_slight(values, reader)
    check_milling(file["path"], reader)


def _make(job: Job, request: FileRequest, path: Path) -> Made:
    from camgeo.output.gcode import make_gcode

    return make_gcode(job, request, path)


def _intent(recipe: Recipe, design: Design) -> PartIntent:
    """Give the part as it is milled; raises RecipeErrors for a recipe that does not say how."""
    from camgeo.curve.curve import CurveError
    from camgeo.machining.milling import milling_intent

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


FORMAT = Format(
    name="gcode",
    suffix="ngc",
    options=Table((RECIPE_UNITS, TOLERANCE)),
    check=_check,
    part=False,
    by_disc=True,
    make=_make,
    intent=_intent,
)
