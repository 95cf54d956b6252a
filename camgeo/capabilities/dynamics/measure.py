"""Values of the figures of a follower train, in mm, degrees and SI, with the shaft angles of their places."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.dynamics.declared import LEAST_BACKLASH
from camgeo.capabilities.dynamics.figures import AT_SPEED, COIL_BIND, FIGURES, JAM_MARGIN, OPEN_LOAD, SEAT_LOAD
from camgeo.capabilities.dynamics.guide import jam_angle
from camgeo.capabilities.dynamics.keys import Dynamics
from camgeo.capabilities.dynamics.moved_train import greatest_travel, moved_body
from camgeo.measures.figures import figure_of_check, motion_figures
from camgeo.measures.measured import Measured
from camgeo.recipe.figures import PEAKS
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from camgeo.capabilities.dynamics.keys import Coil
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.check import Check

ORDERS = {name: order for order, name in enumerate(AT_SPEED, 1)}


def measure(recipe: Recipe, design: Design, names: Sequence[str], speeds: Mapping[str, float]) -> dict[str, Measured]:
    """Measure the named figures of the exact cam and its follower train; figures that the recipe lacks are left out.

    `speeds` has the speed, turns a minute, of figures in time whose limit states one; others are at the train's speed,
    or at 0 without dynamics. If any figure of forces is named, all are measured. Raises RecipeErrors for a load without
    a finite value, a contact that nothing holds on the cam, preloaded contacts that wedge the stem, and a linkage that
    does not turn right round.
    """
    train, figures = recipe.of(Dynamics), dict[str, Measured]()
    timed = [name for name in names if name in ORDERS]
    if timed and design.driven is None:
        peaks = motion_figures(design, max(ORDERS[name] for name in timed))
        for name in timed:
            rpm = speeds.get(name) or (0.0 if train is None else train.rpm)
            figures[name] = _in_time(peaks[PEAKS[ORDERS[name] - 1]], name, rpm)
    if JAM_MARGIN in names and train is not None and train.guide is not None:
        value, limit, at = jam_angle(design.exact, train.guide)
        figures[JAM_MARGIN] = Measured(limit - value, "deg", at)
    coils = [name for name in names if name in _OF_COIL]
    if coils and train is not None and train.spring is not None:
        lift = motion_figures(design, 0)["swing"].value or 0.0
        if train.spring.on_body and (body := moved_body(recipe, design)) is not None:
            lift = greatest_travel(body, lift)
        for name in coils:
            figures[name] = _OF_COIL[name](train.spring, lift)
    if not {*names} <= {*ORDERS, JAM_MARGIN, *_OF_COIL}:
        from camgeo.capabilities.dynamics.force_figures import figures_of

        figures |= figures_of(recipe, design)
    return figures


_OF_COIL: dict[str, Callable[[Coil, float], Measured]] = {
    SEAT_LOAD: lambda coil, _: Measured(coil.preload, "N"),
    OPEN_LOAD: lambda coil, lift: Measured(coil.load(lift), "N"),
    COIL_BIND: lambda coil, lift: Measured(coil.left(lift), "mm"),
}


def _in_time(figure: Measured, name: str, rpm: float) -> Measured:
    """Convert a derivative by the shaft angle, rad, to a derivative by time, s, for a shaft that turns evenly."""
    unit = figure.unit.partition("/")[0] + FIGURES[name].per
    value = None if figure.value is None else figure.value * (rpm * TURN / 60.0) ** ORDERS[name]
    return Measured(value, unit, figure.at_deg, figure.detail)


def of_runs(section: Mapping[str, Any], checks: Sequence[Check]) -> dict[str, dict[str | None, Measured]]:
    """Figures of the runs of an elastic train, by name and by the file's name, None for the intended motion.

    `section` is the report's section `dynamics`, `checks` are those of the runs. A force without a steady state, and a
    backlash that could not be judged, have no value.
    """
    names = [name for name, figure in FIGURES.items() if figure.of == "run" and name != LEAST_BACKLASH.name]
    figures = {name: {_file(run): _of_run(name, run, section) for run in section["runs"]} for name in names}
    left = {check.file: figure_of_check(check) for check in checks if check.name == LEAST_BACKLASH.name}
    return {**figures, LEAST_BACKLASH.name: left}


def _file(run: Mapping[str, Any]) -> str | None:
    return None if run["from"] == "intended" else str(run["from"])


def _of_run(name: str, run: Mapping[str, Any], section: Mapping[str, Any]) -> Measured:
    kind, steady = name.partition("-")[0], run.get("steady") or {}
    value, at = steady.get(f"{kind}_force"), steady.get(f"{kind}_at_deg")
    return Measured(value, section["force_unit"], at, "" if value is not None else "there is no steady state")
