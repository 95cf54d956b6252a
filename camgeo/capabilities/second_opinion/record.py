"""Record of the second opinion: its checks, and the functions that a run with its option calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.registry.capability import Capability

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.checks.declared import Declared
    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.capability import Results
    from camgeo.synthesis.design import Design
    from kin.judge.check import Check


def _checks() -> Sequence[Declared]:
    from camgeo.capabilities.second_opinion.checks import SECOND_OPINIONS

    return SECOND_OPINIONS


def _demand(recipe: Recipe) -> None:
    from camgeo.capabilities.second_opinion.opinion import demand_libraries

    demand_libraries(recipe)


def _look(
    recipe: Recipe, design: Design, files: Sequence[FileResult], checks: Sequence[Check], clock: Clock
) -> Results:
    from camgeo.capabilities.second_opinion.opinion import look

    return look(recipe, design, files, checks, clock)


CAPABILITY = Capability(checks=_checks, demand=_demand, look=_look)
