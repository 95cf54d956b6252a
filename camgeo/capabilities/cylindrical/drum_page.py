"""The page of a cylindrical cam: the drum turns under its follower, development, pressure angles, curves, figures."""

from __future__ import annotations

import math
from functools import lru_cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.cylindrical.charts import (
    development,
    flat_axis,
    flat_scale,
    legend,
    limits,
    pressure_map,
)
from camgeo.capabilities.cylindrical.figures import contact_length
from camgeo.capabilities.cylindrical.shells import FACE, PLACES, RIM, shells
from camgeo.capabilities.cylindrical.turning import LINES, rollers, scene, slope, touched
from camgeo.measures.units import UNIT_NAMES
from camgeo.report.page import tables
from camgeo.report.page.asset import asset
from camgeo.report.page.chart import FIELD, LEFT, TOP
from camgeo.report.page.page import pack_numbers, picture, plotted
from camgeo.report.page.scene import STEPS
from camgeo.report.plot import Plot, Series

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.shells import Shell
    from camgeo.output.own_kind import Made


def looks() -> tuple[str, str]:
    """CSS of the charts, and JavaScript of the player that turns the drum."""
    return asset("chart.css") + _asset("drum.css"), _asset("drum.js")


def panels(design: DrumDesign, report: dict[str, Any]) -> str:
    """Return the HTML of development, map and figures."""
    return (
        f'<div class="charts-and-figures">{_charts(design)}{tables.figures(report["drum"]["figures"], "at", "°")}</div>'
    )


@lru_cache(maxsize=1)
def drawn(design: DrumDesign) -> dict[str, Any]:
    """Data of the page's script that show the drum and its follower, and turn them; the last are kept."""
    of = shells(design)
    seen = scene(design, of=of)
    turn = np.linspace(0.0, design.recipe.period, STEPS + 1)
    shown = picture(design.recipe, seen, turn, -1 if design.recipe.rotation == "cw" else 1)
    return {**shown, "player": {"name": "playDrum", "data": _played(design, of, seen.digits)}}


def script(design: DrumDesign, _: Sequence[Made[Any]] = ()) -> dict[str, Any]:
    """All data of the page's script."""
    return {
        **drawn(design),
        "marks": [],
        "plots": [plotted(plot) for plot in _plots(design)],
        "rests": [
            [math.degrees(rest.begin), math.degrees(rest.end - rest.begin), "dwell"] for rest in design.motion.rests
        ],
        "linked": False,
        "contours": {},
        "errors": [],
    }


def _asset(name: str) -> str:
    return (files("camgeo.capabilities.cylindrical") / name).read_text("utf-8")


def _charts(design: DrumDesign) -> str:
    """Return development and map, side by side where there is room."""
    note = " ".join(legend(design))
    limit = "Above the limit the colour is that of a failed check. " if limits(design) else ""
    lost = "Violet: lost to undercut. " if design.recipe.shortens else ""
    told = f"Magnitude along the roller's line of contact; the ring is at its greatest. {limit}{lost}".strip()
    return (
        '<section aria-labelledby="charts-head"><h2 id="charts-head">Development and pressure angle</h2>'
        f'<div class="charts"><figure><h3>Development</h3>{development(design)}<figcaption>{note}</figcaption></figure>'
        f"<figure><h3>Pressure angle</h3>{pressure_map(design)}<figcaption>{told}</figcaption></figure></div></section>"
    )


def _played(design: DrumDesign, of: Sequence[Shell], digits: int) -> dict[str, Any]:
    """Return the data of the drum's player in the recipe's unit; `digits` are those of the drawing's coordinates."""
    recipe = design.recipe
    mm = recipe.mm
    theta = np.linspace(0.0, recipe.period, LINES + 1)
    boat = {"turn": pack_numbers(np.degrees(slope(design, theta)))} if recipe.roller.shoe is not None else {}
    return {
        "turns": recipe.turns,
        "sense": design.recipe.sense,
        "digits": digits,
        "places": PLACES,
        "parts": LINES,
        "face": FACE,
        "rim": RIM,
        "core": recipe.floor / mm,
        "shells": [
            {
                "radius": each.radius / mm,
                "bands": [[pack_numbers(z / mm, recipe.height / mm) for z in band] for band in each.bands],
            }
            for each in of
        ],
        "lines": [
            {
                "low": pack_numbers(ends.low),
                "high": pack_numbers(ends.high),
                "near": pack_numbers(ends.near / mm),
                "far": pack_numbers(ends.far / mm),
            }
            for ends in (touched(design, name) for name in design.flanks)
        ],
        "rollers": [
            {"beside": pack_numbers(beside), "z": pack_numbers(z / mm), **boat}
            for beside, z in (flat_axis(design, flank, theta) for flank in rollers(design))
        ],
        "flat": [flat_scale(design) * mm, FIELD, flat_scale(design) * recipe.height, LEFT, TOP],
        "map": [LEFT, FIELD],
    }


def _plots(design: DrumDesign) -> list[Plot]:
    """Lift and its derivatives, pressure angle at both ends of contact, and the length of the line of contact."""
    recipe = design.recipe
    theta = np.linspace(0.0, recipe.period, STEPS + 1)
    unit = UNIT_NAMES[recipe.units]
    rows = design.law.derivatives(theta, 2)
    rows = np.degrees(rows) if recipe.swings else rows / recipe.mm
    shown = "°" if recipe.swings else unit
    names = ("swing" if recipe.swings else "lift", ""), ("velocity", "/rad"), ("acceleration", "/rad²")
    plots = [
        Plot(name.capitalize(), f"{shown}{per}", (Series(name, rows[k]),), dwells=True)
        for k, (name, per) in enumerate(names)
    ]
    flank, *_ = design.flanks.values()
    ends = {"inner end": recipe.roller.inner, "outer end": recipe.roller.outer}
    angles = tuple(
        Series(name, np.degrees(flank.pressure(theta, np.full_like(theta, rho)))) for name, rho in ends.items()
    )
    lines = tuple((sign * value, "limit" if sign > 0 else "") for value in limits(design) for sign in (1.0, -1.0))
    note = "at both ends of the roller; above 0 where the drum drives a rise"
    plots.append(Plot("Pressure angle", "°", angles, limits=lines, dwells=True, note=note))
    lengths = tuple(
        Series(name, np.maximum(contact_length(design, name, theta), 0.0) / recipe.mm) for name in design.flanks
    )
    plots.append(Plot("Line of contact", unit, lengths, dwells=True, axis="length", holds=(0.0,)))
    return plots
