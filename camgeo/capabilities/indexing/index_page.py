"""The page of an indexing cam: the cam turns beside its turret, development, curves of its motion, figures."""

from __future__ import annotations

import math
from functools import lru_cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.indexing.charts import PARTS, development, legend, rollers, scale
from camgeo.capabilities.indexing.engaged import Engaged
from camgeo.capabilities.indexing.ribs import PLACES, RISE, UPRIGHT, layers
from camgeo.capabilities.indexing.tables import motion_table
from camgeo.capabilities.indexing.turning import scene, shares, touched
from camgeo.recipe.figures import PRESSURE_ANGLE
from camgeo.report.page import tables
from camgeo.report.page.asset import asset
from camgeo.report.page.chart import FIELD, LEFT, TOP
from camgeo.report.page.page import pack_numbers, picture, plotted
from camgeo.report.page.scene import STEPS
from camgeo.report.plot import Plot, Series
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.ribs import Layer
    from camgeo.output.own_kind import Made


def looks() -> tuple[str, str]:
    """CSS of the chart, and JavaScript of the player that turns the cam."""
    return asset("chart.css") + _asset("index.css"), _asset("index.js")


@lru_cache(maxsize=1)
def drawn(design: IndexDesign) -> dict[str, Any]:
    """Data of the page's script that show the cam and its turret, and turn them; the last are kept."""
    of = layers(design)
    seen = scene(design, of=of)
    turn = np.linspace(0.0, TURN, STEPS + 1)
    shown = picture(design.recipe, seen, turn, -1 if design.recipe.rotation == "cw" else 1)
    return {**shown, "player": {"name": "playIndexer", "data": _played(design, of, seen.digits)}}


def script(design: IndexDesign, _: Sequence[Made[Any]] = ()) -> dict[str, Any]:
    """All data of the page's script."""
    rests = [[math.degrees(rest.begin), math.degrees(rest.end - rest.begin), "dwell"] for rest in design.motion.rests]
    plots = [plotted(plot) for plot in _plots(design)]
    return {**drawn(design), "marks": [], "plots": plots, "rests": rests, "linked": False, "contours": {}, "errors": []}


def panels(design: IndexDesign, report: dict[str, Any]) -> str:
    """Return the HTML of the development, which a barrel has, and of the figures."""
    figures = tables.figures(report["indexing"]["figures"], "at", "°")
    return f'<div class="charts-and-figures">{_charts(design)}{figures}</div>'


def _asset(name: str) -> str:
    return (files("camgeo.capabilities.indexing") / name).read_text("utf-8")


def _charts(design: IndexDesign) -> str:
    if not design.recipe.turret.unrolls:
        return ""
    return (
        '<section aria-labelledby="charts-head"><h2 id="charts-head">Development</h2><div class="charts">'
        f"<figure>{development(design)}<figcaption>{legend(design)}</figcaption></figure></div></section>"
    )


def _played(design: IndexDesign, of: list[Layer], digits: int) -> dict[str, Any]:
    """Return the data of the cam's player in the recipe's unit; `digits` are those of the drawing's coordinates."""
    recipe, mm = design.recipe, design.recipe.mm
    length = recipe.length / mm
    unrolled = recipe.turret.unrolls
    return {
        "sense": recipe.sense,
        "facing": recipe.turret.facing,
        "digits": digits,
        "places": PLACES,
        "rise": RISE,
        "upright": UPRIGHT,
        "parts": PARTS,
        "length": length,
        "layers": [
            {
                "radius": pack_numbers(each.radius / mm, length),
                "share": share,
                "first": each.first,
                "last": each.first + each.bottom.size - 1,
                "bottom": pack_numbers(each.bottom / mm, length),
                "top": pack_numbers(each.top / mm, length),
            }
            for each, share in zip(of, shares(of), strict=True)
        ],
        "rollers": [
            {"beside": pack_numbers(beside), "z": pack_numbers(z / mm)}
            for beside, z in (rollers(design, np.linspace(0.0, TURN, PARTS + 1)) if unrolled else [])
        ],
        "contacts": [
            [
                [pack_numbers(ends[:, k, i, j] / mm, length) for i in (0, 1) for j in (0, 1)]
                for k in range(ends.shape[1])
            ]
            for ends in (touched(design, name, np.linspace(0.0, TURN, PARTS + 1)) for name in design.flanks)
        ],
        "flat": [scale(design) * mm, FIELD, scale(design) * recipe.length, LEFT, TOP],
    }


def _plots(design: IndexDesign) -> list[Plot]:
    """Angle of the turret and its derivatives, pressure angles of the best placed rollers, and rollers engaged."""
    theta = np.linspace(0.0, TURN, STEPS + 1)
    _, rows = motion_table(design, theta)
    _, angle, velocity, acceleration, lower, upper = rows.T
    shown = (("turret", "", angle), ("velocity", "/rad", velocity), ("acceleration", "/rad²", acceleration))
    plots = [Plot(name.capitalize(), f"°{per}", (Series(name, values),), dwells=True) for name, per, values in shown]
    bounds = [b.at_most for b in design.recipe.limits if b.figure == PRESSURE_ANGLE and b.at_most is not None]
    lines = tuple((sign * math.degrees(value), "limit" if sign > 0 else "") for value in bounds for sign in (1.0, -1.0))
    note = "in the middle of the best placed roller's line; above 0 where the cam drives the turret on"
    both = Series("lower flank", lower), Series("upper flank", upper)
    plots.append(Plot("Pressure angle", "°", both, limits=lines, dwells=True, note=note))
    counts = tuple(
        Series(f"{name} flank", Engaged(design, name, theta).bears.sum(axis=1).astype(float)) for name in design.flanks
    )
    note = "on which each flank bears at once"
    return [*plots, Plot("Rollers engaged", "", counts, dwells=True, axis="rollers", holds=(0.0,), note=note)]
