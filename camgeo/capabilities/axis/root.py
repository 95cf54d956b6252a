"""Functions of recipes of an axis, for commands and the library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.api.root import Root
from camgeo.registry.root import Reading

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.capabilities.axis.keys import AxisRecipe
    from camgeo.capabilities.axis.library import Axis
    from camgeo.output.extension import FileCall
    from camgeo.output.pipeline import Outcome
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.yaml_source import Source
    from camgeo.synthesis.expected_checks import Foreseen


def _table() -> FieldTable:
    from camgeo.capabilities.axis.keys import RECIPE

    return RECIPE


def _read(source: Source, path: Path) -> AxisRecipe:
    from camgeo.capabilities.axis.reading import read_axis

    return read_axis(source, path)


def _design(recipe: AxisRecipe) -> Axis:
    from camgeo.capabilities.axis.library import axis_of

    return axis_of(recipe)


def _export(recipe: AxisRecipe, out: Path, only: tuple[str, ...], progress: Callable[[str], None]) -> Outcome:
    from camgeo.capabilities.axis import pipeline

    return pipeline.export(recipe, out, only=only, progress=progress)


def _check(recipe: AxisRecipe, progress: Callable[[str], None]) -> Outcome:
    from camgeo.capabilities.axis import pipeline

    return pipeline.check(recipe, progress=progress)


def _judge(
    recipe: AxisRecipe, paths: list[Path], tolerance: float | None, units: float | None, gap: float | None
) -> dict[str, Any]:
    from camgeo.capabilities.axis import pipeline

    return pipeline.judged(recipe, paths, tolerance, units, gap)


def _show(
    recipe: AxisRecipe, paths: list[Path], tolerance: float | None, units: float | None, gap: float | None
) -> tuple[dict[str, Any], str]:
    from camgeo.capabilities.axis import pipeline

    return pipeline.judged_and_shown(recipe, paths, tolerance, units, gap)


def _claimed(recipe: AxisRecipe, name: str, _call: FileCall) -> dict[str, Any]:
    problem = f"{name.replace('_', ' ')} judges files of disc cams"
    raise recipe.error("axis", problem, None, "give verify a table for a drive")


def _explain(check: dict[str, Any], _: dict[str, Any], recipe: AxisRecipe, shown: str | None) -> str:
    from camgeo.capabilities.axis.library import failure_text

    return failure_text(check, recipe, shown)


def _foresee(recipe: AxisRecipe) -> tuple[Foreseen, ...]:
    from camgeo.capabilities.axis.library import foreseen

    return foreseen(recipe)


READING = Reading(table=_table, read=_read, noun="motion of an axis", instead="the recipe of a disc cam")
ROOT = Root(
    design=_design,
    export=_export,
    check=_check,
    judge=_judge,
    claimed=_claimed,
    show=_show,
    explain=_explain,
    foresee=_foresee,
)
