"""Figures of a follower train, its sections of the report, and a remark."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.measure import measure, of_runs
from camgeo.measures.extension import Measures, Results
from camgeo.measures.rule_remark import RuleRemark

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.common.clock import Clock
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.check import Check


def _examine(recipe: Recipe, design: Design, files: Sequence[FileResult], clock: Clock) -> Results:
    """Dynamics of an elastic train as intended and with the cam of each file, and forces of a rigid follower."""
    from camgeo.capabilities.dynamics.force_figures import rigid_forces

    train, sections = recipe.of(Dynamics), dict[str, Any]()
    checks: Sequence[Check] = ()
    runs: Mapping[str, Mapping[str | None, Measured]] = {}
    if train is None:
        return Results()
    if train.stiffness is not None:
        from camgeo.capabilities.dynamics.elastic import dynamics_of

        with clock.stage("dynamics"):
            section, checks = dynamics_of(recipe, design, files)
        sections["dynamics"], runs = section, of_runs(section, checks)
    with clock.stage("forces"):
        forces = rigid_forces(recipe, design)
    if forces is not None:
        sections["forces"] = forces.section
        if train.stiffness is None:  # float and what is lost of an elastic train are judged by its own run
            checks = [*checks, *forces.checks]
    return Results(sections, checks, runs)


def _lost(recipe: Recipe, design: Design) -> Sequence[RuleRemark]:
    """Remark on the preloaded contact that is lost at the lowest speed, if that is at most the train's; else empty."""
    from camgeo.capabilities.dynamics.running_forces import running_of

    if design.exact.preload is None:
        return []
    running = running_of(recipe, design)
    if running is None or running.jam_deg is not None:
        return []
    losses = [(loss.rpm, loss) for loss in running.lost_rpm() if loss.rpm is not None]
    if not losses or min(losses)[0] > running.train.rpm:
        return []
    rpm, loss = min(losses)
    begins = f"from {rpm:.6g} rpm" if rpm > 0.0 else "by its load alone"
    remark = f"the preload does not hold {loss.contact} at {running.train.rpm:.6g} rpm: it is lost {begins}"
    return [RuleRemark("lost-contact", rpm, running.train.rpm, "rpm", remark, loss.at_deg)]


ANSWERS = Measures(measure=measure, examine=_examine, remarks={"pivot-clearance": _lost})
