"""The dynamics of a run: sections of the report, checks, figures of each run of an elastic train."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.registry.capability import Results

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.check import Check


def examine(recipe: Recipe, design: Design, files: Sequence[FileResult], clock: Clock) -> Results:
    """Find the dynamics of an elastic train with each file that shows the cam, and the forces of a rigid one."""
    train, sections = recipe.of(Dynamics), dict[str, Any]()
    checks: Sequence[Check] = ()
    runs: Mapping[str, Mapping[str | None, Measured]] = {}
    if train is None:
        return Results()
    if train.stiffness is not None:
        from camgeo.capabilities.dynamics.elastic import dynamics_of
        from camgeo.capabilities.dynamics.measure import of_runs

        with clock.stage("dynamics"):
            results = dynamics_of(recipe, design, files)
        sections["dynamics"], checks = results.section, results.checks
        runs = of_runs(results.section, checks)
    from camgeo.capabilities.dynamics.force_figures import found_forces

    with clock.stage("forces"):
        forces = found_forces(recipe, design)
    if forces is not None:
        sections["forces"] = forces.section
        if train.stiffness is None:  # float and what is lost of an elastic train are judged by its own run
            checks = [*checks, *forces.checks]
    return Results(sections, checks, runs)
