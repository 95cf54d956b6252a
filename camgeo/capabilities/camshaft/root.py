"""Functions of recipes of camshafts, for commands and the library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.api.root import Root
from camgeo.registry.root import Reading

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.library import CamshaftDesign
    from camgeo.output.extension import FileCall
    from camgeo.output.pipeline import Outcome
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.yaml_source import Source
    from camgeo.synthesis.expected_checks import Foreseen


def _table() -> FieldTable:
    from camgeo.capabilities.camshaft.keys import SHAFT

    return SHAFT


def _read(source: Source, path: Path) -> CamshaftRecipe:
    from camgeo.capabilities.camshaft.keys import read_camshaft

    return read_camshaft(source, path)


def _design(recipe: CamshaftRecipe) -> CamshaftDesign:
    from camgeo.capabilities.camshaft.library import designed

    return designed(recipe)


def _export(recipe: CamshaftRecipe, out: Path, only: tuple[str, ...], progress: Callable[[str], None]) -> Outcome:
    from camgeo.capabilities.camshaft import pipeline

    return pipeline.export(recipe, out, only=only, progress=progress)


def _check(recipe: CamshaftRecipe, progress: Callable[[str], None]) -> Outcome:
    from camgeo.capabilities.camshaft import pipeline

    return pipeline.check(recipe, progress=progress)


def _judge(
    recipe: CamshaftRecipe, paths: list[Path], tolerance: float | None, units: float | None, _gap: float | None
) -> dict[str, Any]:
    """Report on solids; a gap is one between ends in a drawing, and drawings are refused."""
    from camgeo.capabilities.camshaft import pipeline

    return pipeline.judged(recipe, paths, tolerance=tolerance, units=units)


def _claimed(recipe: CamshaftRecipe, name: str, call: FileCall) -> dict[str, Any]:
    from camgeo.capabilities.camshaft import pipeline

    return pipeline.judged_by(recipe, name, call)


def _explain(check: dict[str, Any], _: dict[str, Any], recipe: CamshaftRecipe, shown: str | None) -> str:
    from camgeo.capabilities.camshaft.library import failure_text

    return failure_text(check, recipe, shown)


def _foresee(recipe: CamshaftRecipe) -> tuple[Foreseen, ...]:
    from camgeo.capabilities.camshaft.lobes import foresee

    return foresee(recipe)


READING = Reading(table=_table, read=_read, noun="camshaft", instead="the recipe of a lobe")
ROOT = Root(
    design=_design,
    export=_export,
    check=_check,
    judge=_judge,
    claimed=_claimed,
    explain=_explain,
    foresee=_foresee,
)
