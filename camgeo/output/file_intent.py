"""What kin is given of each kind of file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.curve.curve import CurveError
from camgeo.synthesis.intent import intended

if TYPE_CHECKING:
    from camgeo.recipe.machining import Compensation
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent


def intent_of_file(
    recipe: Recipe, design: Design, kind: str, by: Compensation | None = None, field: str = "export.files"
) -> PartIntent:
    """What kin is given of a file of some kind, whose part may be made different `by` something.

    Raises RecipeErrors for a program of which the recipe knows nothing, and as `compensated` does.
    """
    if len(design.discs) > 1:
        raise recipe.error(field, f"files of a cam of {len(design.discs)} discs are not judged", None, "")
    if by is not None:
        from camgeo.machining.compensation import compensated

        try:
            made = compensated(recipe, design, by, field)
        except CurveError as error:
            raise recipe.error(field, str(error)) from error
        return intended(made.recipe, made.design)
    if kind != "gcode":
        return intended(recipe, design)
    if recipe.manufacture is None:
        raise recipe.error("manufacture", "missing", None, "give manufacture: a program is judged by its cutter")
    if recipe.part.thickness is None:
        raise recipe.error("part.thickness", "missing", None, "give part.thickness: a program is judged by its depth")
    if not design.contours:
        raise recipe.error("cam", "a check of the exact contour fails, so nothing can be milled")
    from camgeo.machining.milling import milling_intent

    try:
        return milling_intent(recipe, design)
    except CurveError as error:
        raise recipe.error("manufacture.cutter", str(error)) from error
