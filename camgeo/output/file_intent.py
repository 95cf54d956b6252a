"""Intents by which kin judges each kind of file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.curve.curve import CurveError
from camgeo.registry.formats import FORMATS
from camgeo.synthesis.intent import closures_between
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.recipe.machining import Compensation
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent, ShaftIntent


def shaft_of_file(
    recipe: Recipe, design: Design, kind: str, compensation: Compensation | None = None, field: str = "export.files"
) -> ShaftIntent:
    """Intent of the files of a kind, whose discs may differ from the nominal ones by a compensation.

    `field` is the path of the request in errors. Raises RecipeErrors for a program without `manufacture` in the recipe,
    and where by the compensation a roller or an opening would be nothing, or the contour cannot be altered or proved.
    """
    from kin.judge.intent import ShaftIntent

    if compensation is not None:
        from camgeo.machining.compensation import compensate

        try:
            compensated = compensate(recipe, design, compensation, field)
        except CurveError as error:
            raise recipe.error(field, str(error)) from error
        recipe, design = compensated.recipe, compensated.design
    if len(design.discs) == 1:
        return ShaftIntent((intent_of_file(recipe, design, kind),))
    parts = tuple(
        replace(intent_of_file(recipe, single, kind), name=disc.name)
        for single, disc in zip(design.single, design.discs, strict=True)
    )
    return ShaftIntent(parts, tuple(disc.z for disc in design.discs), closures_between(design))


def intent_of_file(recipe: Recipe, design: Design, kind: str) -> PartIntent:
    """Intent of a file with one disc; raises ValueError for several, RecipeErrors for what the recipe does not say."""
    return FORMATS[kind].intent(recipe, design)
