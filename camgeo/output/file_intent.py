"""Intents by which kin judges each kind of file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.curve.curve import CurveError
from camgeo.synthesis.intent import INTENTS, closures_between
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.recipe.machining import Compensation
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.intent import PartIntent, ShaftIntent


def shaft_of_file(
    recipe: Recipe, design: Design, kind: str, compensation: Compensation | None = None, field: str = "export.files"
) -> ShaftIntent:
    """Intent of the files of the format `kind`, whose discs may differ from the nominal ones by a compensation.

    Each file holds one disc or all. Raises RecipeErrors at `field`, the request's path in the recipe, where the
    compensation leaves nothing of a roller or of an opening, an alteration is refused, or the altered contour cannot be
    made or proved; RecipeErrors elsewhere for an entry that the recipe lacks, such as `manufacture` for a program, and
    where the cutter of a program or the roller of a lift table cannot follow the contour; CurveError where it cannot be
    proved what that roller reaches, KeyError for an unknown format.
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
    """Intent of a file of the format `kind` that shows the one disc of `design`.

    Raises ValueError for a design of several discs, RecipeErrors for an entry that the recipe lacks, KeyError for an
    unknown format.
    """
    return INTENTS[kind].of(recipe, design)
