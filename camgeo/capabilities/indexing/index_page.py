"""The page of an indexing cam: the turret turns before the blank; curves of its motion, pressure angles, figures."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.indexing.tables import motion_table
from camgeo.recipe.figures import PRESSURE_ANGLE
from camgeo.report.page import tables
from camgeo.report.page.page import picture, plotted
from camgeo.report.page.scene import STEPS, FilledShape, MovingBody, Scene, pivot, poses, still
from camgeo.report.plot import Plot, Series
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.design import IndexDesign

JOINT = 0.016  # of the blank's width and length together: size of a joint


def scene(design: IndexDesign, step: int = 0) -> Scene:  # noqa: ARG001 - the blank looks alike at all steps
    """The blank of the cam, and its turret over the turn, in the recipe's unit."""
    recipe = design.recipe
    drawn = recipe.turret.drawn(recipe.roller, recipe.stops, recipe.sense)
    theta = np.linspace(0.0, TURN, STEPS + 1)
    psi = recipe.start + design.law.derivatives(theta, 0)[0]
    x, z = drawn.centre
    size = JOINT * 2.0 * float(np.abs(drawn.blank.points).max())
    turned = poses(x, z, psi if drawn.way > 0 else math.pi - psi)
    rollers = tuple(FilledShape("roller", (ring,), "roller") for ring in drawn.rollers)
    bodies = (
        MovingBody("cam", "cam", (FilledShape("metal", (drawn.blank,), "blank of the cam"),), still()),
        MovingBody("turret", "follower", (FilledShape("follower", (drawn.hub,), "turret"),), turned),
        MovingBody("rollers", "follower", rollers, turned),
        pivot("pivot", x, z, size, "T"),
    )
    way = "clockwise" if recipe.rotation == "cw" else "counter-clockwise"
    note = f"seen along the turret's axis, the cam without its track; it turns {way}, seen from above"
    return Scene(bodies, note).scaled(1.0 / recipe.mm)


@lru_cache(maxsize=1)
def drawn(design: IndexDesign) -> dict[str, Any]:
    """Data of the page's script that show the cam's blank and its turret, and turn this; the last are kept."""
    turn = np.linspace(0.0, TURN, STEPS + 1)
    return picture(design.recipe, scene(design), turn, -1 if design.recipe.rotation == "cw" else 1)


def script(design: IndexDesign) -> dict[str, Any]:
    """All data of the page's script."""
    rests = [[math.degrees(rest.begin), math.degrees(rest.end - rest.begin), "dwell"] for rest in design.motion.rests]
    plots = [plotted(plot) for plot in _plots(design)]
    return {**drawn(design), "marks": [], "plots": plots, "rests": rests, "linked": False, "contours": {}, "errors": []}


def panels(report: dict[str, Any]) -> str:
    """Return the HTML of the figures."""
    rows = []
    for entry in report["indexing"]["figures"]:
        at = f"{entry['at']:.2f}°" if "at" in entry else ""
        value = entry["value"]
        shown = tables.number(value) if value is not None and math.isfinite(value) else tables.NONE
        rows.append(tables.named_row(entry["name"], shown, entry["unit"], at))
    return f"<section><h2>Figures</h2>{tables.html_table('Figures', ('figure', 'value', 'unit', 'at'), rows)}</section>"


def _plots(design: IndexDesign) -> list[Plot]:
    """Angle of the turret and its derivatives, and pressure angles of the best placed rollers."""
    _, rows = motion_table(design, np.linspace(0.0, TURN, STEPS + 1))
    _, angle, velocity, acceleration, lower, upper = rows.T
    shown = (("turret", "", angle), ("velocity", "/rad", velocity), ("acceleration", "/rad²", acceleration))
    plots = [Plot(name.capitalize(), f"°{per}", (Series(name, values),), dwells=True) for name, per, values in shown]
    bounds = [b.at_most for b in design.recipe.limits if b.figure == PRESSURE_ANGLE and b.at_most is not None]
    lines = tuple((sign * math.degrees(value), "limit" if sign > 0 else "") for value in bounds for sign in (1.0, -1.0))
    note = "in the middle of the best placed roller's line; above 0 where the cam drives the turret on"
    both = Series("lower flank", lower), Series("upper flank", upper)
    return [*plots, Plot("Pressure angle", "°", both, limits=lines, dwells=True, note=note)]
