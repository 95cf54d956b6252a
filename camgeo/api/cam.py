"""Functions of recipes of one cam, for commands and the library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.api.root import Root
from camgeo.api.shown import ShownCam
from camgeo.output import pipeline

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.api.design import Design
    from camgeo.output.pipeline import Outcome
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.expected_checks import Foreseen


def _design(recipe: Recipe) -> Design:
    from camgeo.api.design import Design
    from camgeo.api.log import stage_reporter
    from camgeo.common.clock import Clock
    from camgeo.synthesis.design import designed

    return Design(recipe, designed(recipe, Clock(stage_reporter(recipe))))


def _export(recipe: Recipe, out: Path, only: tuple[str, ...], progress: Callable[[str], None]) -> Outcome:
    return pipeline.export(recipe, out, only=only, progress=progress)


def _check(recipe: Recipe, progress: Callable[[str], None]) -> Outcome:
    return pipeline.check(recipe, progress=progress)


def _explain(check: dict[str, Any], report: dict[str, Any], recipe: Recipe, file_name: str | None) -> str:
    from camgeo.report.failure import failure

    return failure(check, report, recipe, file_name)


def _foresee(recipe: Recipe) -> tuple[Foreseen, ...]:
    """Checks that a run of the recipe will make; empty where its motion does not exist."""
    from camgeo.synthesis.expected_checks import foreseen
    from kin.law.normalised import IntentError

    try:
        return foreseen(recipe)
    except IntentError:
        return ()


ROOT = Root(
    design=_design,
    export=_export,
    check=_check,
    judge=pipeline.judge_files,
    claimed=pipeline.judge_claimed,
    show=pipeline.judge_and_show,
    explain=_explain,
    foresee=_foresee,
    shown=ShownCam,
)
