"""Camshafts from a recipe to files and a verdict, imported where a recipe is of one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.api.errors import CallError
from camgeo.camshaft import pipeline

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.output.pipeline import Outcome
    from camgeo.recipe.camshaft import CamshaftRecipe


def made(
    recipe: CamshaftRecipe,
    out: Path | None,
    only: tuple[str, ...],
    told: Callable[[str], None],
    *,
    second_opinion: bool,
) -> Outcome:
    """Write and judge a camshaft's files below `out`, or without one keep none of them."""
    _demand_none(second_opinion=second_opinion)
    if out is None:
        return pipeline.check(recipe, progress=told)
    return pipeline.export(recipe, out, only=only, progress=told)


def judged(
    recipe: CamshaftRecipe, paths: list[Path], tolerance: float | None, units: float | None, *, second_opinion: bool
) -> dict[str, Any]:
    """Report on solids held against a camshaft's recipe, lengths in mm."""
    _demand_none(second_opinion=second_opinion)
    return pipeline.judged(recipe, paths, tolerance=tolerance, units=units)


def _demand_none(*, second_opinion: bool) -> None:
    if second_opinion:
        raise CallError("second_opinion looks at files of one cam: leave it out for a camshaft")
