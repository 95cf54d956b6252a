"""What the dynamics of a follower train add: a key, checks and figures, two sections, panels, plots, a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.dynamics.figures import FIGURES
from camgeo.capabilities.dynamics.keys import Dynamics, build, check, fields
from camgeo.registry.capability import Capability, Results

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.cams.family import ExactCam
    from camgeo.cams.surface import Surface
    from camgeo.checks.declared import Declared
    from camgeo.common.clock import Clock
    from camgeo.curve.curve import Curve
    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.measures.remarks import RuleRemark
    from camgeo.recipe.recipe import Recipe
    from camgeo.registry.capability import Estimate, MadeFigures, MadeMotion
    from camgeo.registry.formats import Form
    from camgeo.report.page.curves import Plot
    from camgeo.synthesis.design import Design
    from kin.judge.check import Check


def _speed(recipe: Recipe) -> float | None:
    train = recipe.of(Dynamics)
    return None if train is None else train.rpm


def _measure(
    recipe: Recipe, design: Design, names: Sequence[str], speeds: Mapping[str, float]
) -> Mapping[str, Measured]:
    from camgeo.capabilities.dynamics.measure import measure

    return measure(recipe, design, names, speeds)


def _on_metal(recipe: Recipe, design: Design, motion: MadeMotion) -> MadeFigures:
    from camgeo.capabilities.dynamics.on_metal import figures_on_metal

    return figures_on_metal(recipe, design, motion)


def _estimates() -> Mapping[str, Estimate]:
    from camgeo.capabilities.dynamics.estimates import ESTIMATES

    return ESTIMATES


def _checks() -> Sequence[Declared]:
    from camgeo.capabilities.dynamics.checks import CHECKS

    return CHECKS


def _exact(recipe: Recipe, exact: ExactCam, _contours: Sequence[tuple[Surface, Curve]]) -> Sequence[Check]:
    from camgeo.capabilities.dynamics.guide import guide_checks

    return guide_checks(recipe, exact)


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
        from camgeo.capabilities.dynamics.measure import of_runs

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


def _remedy(recipe: Recipe, figure: str, value: float, bound: float) -> str:
    from camgeo.capabilities.dynamics.remedies import of_limit

    return of_limit(recipe, figure, value, bound)


def _lost(recipe: Recipe, design: Design) -> Sequence[RuleRemark]:
    """Remark on the preloaded contact that is lost at the lowest speed, if that is at most the train's; else empty."""
    from camgeo.capabilities.dynamics.running_forces import running_of
    from camgeo.measures.remarks import RuleRemark

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


def _panel(report: dict[str, Any]) -> str:
    from camgeo.capabilities.dynamics.panel import panel

    return panel(report)


def _plots(recipe: Recipe, design: Design) -> Sequence[Plot]:
    from camgeo.capabilities.dynamics.plots import plots

    return plots(recipe, design)


def _tables() -> Mapping[str, Form]:
    from camgeo.capabilities.dynamics.table import FORM

    return {FORM.name: FORM}


CAPABILITY = Capability(
    fields=fields,
    check=check,
    build=build,
    speed=_speed,
    figures=FIGURES,
    measure=_measure,
    on_metal=_on_metal,
    estimates=_estimates,
    checks=_checks,
    exact=_exact,
    examine=_examine,
    remedy=_remedy,
    remarks={"pivot-clearance": _lost},
    panel=_panel,
    plots=_plots,
    tables=_tables,
)
