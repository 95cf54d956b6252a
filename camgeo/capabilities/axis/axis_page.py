"""The page of an axis: what moves, and position, velocity, acceleration and jerk in time over a turn of the master."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camgeo.curve.ring import bar, box, disc
from camgeo.measures.units import UNIT_NAMES, report_unit
from camgeo.report.page import svg, tables
from camgeo.report.page.page import filled, picture, plotted
from camgeo.report.page.scene import STEPS, FilledShape, MovingBody, Scene, SceneInput, block, pivot, poses, still
from camgeo.report.plot import Plot, Series
from kin.numeric.angles import TURN
from kin.read.drive_tables import SLAVES, read_drive
from kin.read.errors import ReadError

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.capabilities.axis.design import AxisDesign

RADIUS = 40.0  # of the drawn table, of any unit: an axis has no size of its own
NAMES = ("Position", "Velocity", "Acceleration", "Jerk")
POWERS = ("", "/s", "/s²", "/s³")
BETWEEN = 16  # places to a step of the page at which the error of a table is looked at


class JudgedTable(NamedTuple):
    """A table for a drive that was judged: its path, its tolerance, mm or rad, and the unit, mm, of one without."""

    path: Path
    within: float
    mm: float


def page(design: AxisDesign, report: dict[str, Any], tables_judged: Sequence[JudgedTable] = ()) -> str:
    """Return the HTML of the page, from the motion and the report, with the error of each of `tables_judged`."""
    data = {
        **picture(design.recipe, scene(design), np.linspace(0.0, TURN, STEPS + 1), 1),
        "marks": [],
        "plots": [plotted(plot) for plot in (*_plots(design), *_errors(design, tables_judged))],
        "rests": [
            [math.degrees(rest.begin), math.degrees(rest.end - rest.begin), "dwell"] for rest in design.motion.rests
        ],
        "linked": False,
        "contours": {},
        "errors": [],
    }
    return filled(design.recipe, data, report, panels=tables.figures(report["axis"]["figures"], "at_deg", "°"))


def drawing(design: AxisDesign) -> str:
    """Return the axis at the beginning of its cycle as SVG."""
    return svg.moving(scene(design))


def scene(design: AxisDesign) -> Scene:
    """A carriage on its rail, or a table that turns, in the recipe's unit."""
    recipe = design.recipe
    s = design.in_time(np.linspace(0.0, TURN, STEPS + 1), 0)[0]
    goes_on = "; the next cycle begins where this one ends" if recipe.index else ""
    note = f"a turn of the master takes {recipe.cycle:.6g} s{goes_on}"
    over = SceneInput("master's angle", "master", "°", 360, closed=True, key="deg", pace="rpm")
    return Scene(tuple(_table(np.radians(s)) if recipe.swings else _carriage(s)), note, over)


def _table(angle: Any) -> list[MovingBody]:  # noqa: ANN401 - an array
    size = 0.08 * RADIUS
    hand = FilledShape("timing mark", (bar((0.25 * RADIUS, 0.0), (0.9 * RADIUS, 0.0), 0.5 * size),), "hand")
    plate = FilledShape("metal", (disc(0.0, 0.0, RADIUS),), "table")
    return [MovingBody("table", "cam", (plate, hand), poses(0.0, 0.0, angle)), pivot("axis", 0.0, 0.0, size)]


def _carriage(s: Any) -> list[MovingBody]:  # noqa: ANN401 - an array
    low, high = float(s.min()), float(s.max())
    size = 0.12 * (high - low) or 1.0  # of an axis that stands
    rail = FilledShape("fixed", (box(low - 1.5 * size, -0.9 * size, high + 1.5 * size, -0.5 * size),), "rail")
    return [
        MovingBody("rail", "ground", (rail,), still()),
        MovingBody("carriage", "follower", (block(2.0 * size, size, "carriage"),), poses(s, 0.0, 0.0)),
    ]


def _plots(design: AxisDesign) -> list[Plot]:
    """Position and its derivatives in time over a turn of the master, with the limits of the recipe."""
    recipe = design.recipe
    rows = design.in_time(np.linspace(0.0, TURN, STEPS + 1), 3)
    unit = "°" if recipe.swings else UNIT_NAMES[recipe.units]
    most = {bound.figure: bound.at_most / recipe.scale for bound in recipe.limits}
    plots = []
    for name, per, row in zip(NAMES, POWERS, rows, strict=True):
        limit = most.get(name.lower())
        limits = () if limit is None else ((limit, "limit"), (-limit, ""))
        plots.append(Plot(name, f"{unit}{per}", (Series(name.lower(), row),), limits=limits, dwells=True))
    return plots


def _errors(design: AxisDesign, judged: Sequence[JudgedTable]) -> list[Plot]:
    """Error of the position that a controller makes of each table over a turn; none of a table that is not readable."""
    factor, unit = report_unit(design.recipe, design.unit)
    shown = "°" if design.recipe.swings else UNIT_NAMES[design.recipe.units]
    count = STEPS * BETWEEN
    angle = np.linspace(0.0, TURN, count + 1)
    plots = []
    for path, within, mm in judged:
        try:
            rows = read_drive(path, SLAVES["slave_deg"] if unit == "deg" else mm).rows
        except ReadError:
            continue  # the check `readable` says why
        off = factor * (rows.rows(angle, 0)[0] - design.driven(within).rows(angle, 0)[0])
        # beside each step the worst of what lies nearer to it than to another one
        near = np.pad(off, BETWEEN // 2, mode="edge")[:-1].reshape(STEPS + 1, BETWEEN)
        worst = np.take_along_axis(near, np.abs(near).argmax(axis=1)[:, None], axis=1)[:, 0]
        limit = factor * within
        series, limits = (Series("error", worst),), ((limit, "tolerance"), (-limit, ""))
        plots.append(
            Plot(
                f"Error of {path.name}", shown, series, limits=limits, dwells=True, axis="error", holds=(limit, -limit)
            )
        )
    return plots
