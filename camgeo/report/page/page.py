"""The page as one HTML file: template, style and script from this folder, drawing, tables and data from a recipe."""

from __future__ import annotations

import json
import math
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.report.document import finite
from camgeo.report.extension import PAGE
from camgeo.report.failure import headline
from camgeo.report.page import looks, svg, tables
from camgeo.report.page.asset import asset
from camgeo.report.page.scene import STEPS, digits_for

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Order, Recipe
    from camgeo.report.page.content import Content
    from camgeo.report.page.scene import MovingBody, Scene
    from camgeo.report.plot import Plot
    from kin.numeric.arrays import Array

RELOAD = "<!-- reload -->"  # where a page that is watched gets the script that reloads it
WHOLE = 2.0**52  # of a script's numbers, up to which differences of whole ones are exact
SHARE = 1e-5  # of its range: to this a row of numbers is rounded
LOCAL = "connect-src 'none'"  # a page may connect to nothing; one that is watched to where it came from


def page(recipe: Recipe, content: Content, report: dict[str, Any]) -> str:
    """Return the HTML of a recipe's page, complete in one file."""
    data = scene(recipe, content, report)
    panels = "".join(answers.panel(report) for answers in PAGE.of(recipe.uses))
    return filled(recipe, data, report, linkage=tables.linkage(report), panels=tables.preload(report) + panels)


def filled(
    recipe: Order,
    data: dict[str, Any],
    report: dict[str, Any],
    *,
    linkage: str = "",
    panels: str = "",
    style: str = "",
    code: str = "",
) -> str:
    """Return the HTML of a page with the data of its script, as `scene` gives them, and with further panels.

    `style` has further rules, `code` the functions of players that the data name.
    """
    parts = {
        "note": escape(data.pop("note")),
        "facts": tables.facts(report, recipe.input_words),
        "drawing": data.pop("drawing"),
        "checks": tables.checks(report),
        "files": tables.file_table(report),
        "linkage": linkage,
        "panels": panels,
        "skipped": tables.skipped_list(report),
        "recipe": escape(recipe.text),
        "script": asset("page.js") + code,
        "data": script_json(data),
    }
    return head(recipe, report, style) + _fill("page.html", parts)


def head(recipe: Order, report: dict[str, Any], more: str = "") -> str:
    """Return the HTML with which a page begins: what it may load, its style, name, remark and verdict.

    `more` has further rules of style.
    """
    ok = report["ok"]
    parts = {
        "title": escape(recipe.name),
        "about": escape(recipe.about),
        "verdict": "every check holds" if ok else tables.failing_count(report["checks"]),
        "state": "ok" if ok else "failed",
        "style": asset("drawing.css") + looks.rules() + asset("page.css") + more,
    }
    return _fill("head.html", parts)


def _fill(name: str, parts: dict[str, str]) -> str:
    """Return a file of this folder with its {{parts}} in their places."""
    first, *pieces = asset(name).split("{{")
    text = [first]
    for piece in pieces:
        part, _, after = piece.partition("}}")
        text += [parts[part], after]
    return "".join(text)


def script_json(values: object) -> str:
    """Return plain data as JSON that is safe within a script element; nan and infinities become null."""
    text = json.dumps(finite(values), separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("<", "\\u003c")


def scene(recipe: Recipe, content: Content, report: dict[str, Any]) -> dict[str, Any]:
    """Return the data of the page's script; angles in degrees, lengths in the recipe's unit.

    `drawing` is the mechanism at shaft angle 0 as SVG, in which the group of body k has the id `body-k`; `bodies` has
    the motion of each body: rows of x, y and angle at equal steps of a turn, packed by `pack_numbers`. `marks` are the
    places on the contour, in the axes of the cam, of failed checks and remarks of `report`.
    """
    return {
        **picture(recipe, content.scene, content.relative, -1 if recipe.rotation == "cw" else 1),
        "marks": _marks(content, report),
        "plots": [plotted(plot) for plot in content.plots],
        "rests": [[rest.start, rest.length, rest.name] for rest in content.rests],
        "linked": any(plot.over == "relative" for plot in content.plots),
        "contours": {
            name: [pack_numbers(row) for row in (*traced.point.T, *traced.normal.T)]
            for name, traced in content.contours.items()
        },
        "errors": [
            {
                "file": ", ".join(filter(None, (error.name, error.surface))),
                "surface": error.surface,
                "low": pack_numbers(error.low),
                "high": pack_numbers(error.high),
                "tolerance": float(f"{error.tolerance:.6g}"),
            }
            for error in content.errors
        ],
    }


def picture(recipe: Order, drawn: Scene, relative: Array, sense: int) -> dict[str, Any]:
    """Return those entries of `scene` that show and move the mechanism.

    `relative` (STEPS + 1,) is the angle between cam and frame, rad; `sense` is -1 where a cam turns clockwise, else 1.
    """
    view = svg.Viewport.of(drawn)
    extent = max(view.width, view.height) / view.scale
    return {
        "name": recipe.name,
        "note": drawn.note,
        "drawing": svg.moving(drawn),
        "unit": "in" if recipe.units == "inch" else "mm",
        "sense": sense,
        "steps": STEPS,
        "input": drawn.input_._asdict(),
        "relative": pack_numbers(np.degrees(relative)),
        "view": [view.scale, view.x, view.y, svg.BESIDE],
        "bodies": [_pose(body, extent) for body in drawn.bodies],
    }


def _marks(content: Content, report: dict[str, Any]) -> list[dict[str, Any]]:
    """Return marks for failed checks of the design and remarks; those without a surface are on the first contour."""
    entries = [(check, "failed") for check in report["checks"] if not check["ok"] and "file" not in check]
    entries += [(remark, "remark") for remark in report["remarks"]]
    marks = []
    for entry, kind in entries:
        if entry.get("at_deg") is None:
            continue
        contour = content.contours[entry.get("surface", next(iter(content.contours)))]
        x, y = contour.at(entry["at_deg"])
        text = entry.get("sentence") or headline(entry)
        marks.append({"name": entry["name"], "kind": kind, "at_deg": entry["at_deg"], "x": x, "y": y, "text": text})
    return marks


def _pose(body: MovingBody, extent: float) -> list[dict[str, Any]]:
    """Return x, y and angle of a body, packed; a small movement is rounded as finely as a large one."""
    x, y, angle = body.pose.T
    rows = [pack_numbers(row, _fine(row, extent)) for row in (x, y)]
    return [*rows, pack_numbers(np.degrees(angle), _fine(np.degrees(angle), 90.0))]


def _fine(row: np.ndarray[Any, np.dtype[np.float64]], extent: float) -> float:
    spread = float(np.ptp(row))
    return min(extent, spread) if spread > 0.0 else extent


def plotted(plot: Plot) -> dict[str, Any]:
    """Return the data of a plot for the page's script."""
    entry: dict[str, Any] = {
        "title": plot.title,
        "unit": plot.unit,
        "series": [{"name": series.name, **pack_numbers(series.values)} for series in plot.series],
        "limits": [[value, name] for value, name in plot.limits if math.isfinite(value)],
        "note": plot.note,
        "axis": plot.axis or plot.title.lower(),
        "holds": list(plot.holds),
    }
    if plot.over == "relative":
        entry["over"] = "relative"
    if plot.dwells:
        entry["rests"] = 1
    return entry


def pack_numbers(values: Array, extent: float | None = None) -> dict[str, Any]:
    """Return values (n,) as `{"d": digits, "v": [first, step, step, ...]}` in units of the last digit.

    They are rounded to `SHARE` of `extent`, by default of their range, but to no more than sixteen digits. A row with
    values that are not finite is `{"n": [...]}`, with null in their places; an empty row `{"n": []}`, a constant row
    `{"c": value}`.
    """
    good = values[np.isfinite(values)]
    spread = float(np.ptp(good)) if good.size else 0.0
    extent = spread if extent is None else extent
    largest = float(np.abs(good).max(initial=0.0))
    if good.size == values.size and spread <= 1e-13 * largest:
        return {"c": float(f"{values[0]:.12g}")} if values.size else {"n": []}
    digits = digits_for(extent, SHARE)
    if good.size < values.size:
        return {"n": [round(v, digits) if np.isfinite(v) else None for v in values.tolist()]}
    if largest > WHOLE / 10.0**digits:
        digits = math.floor(math.log10(WHOLE) - math.log10(largest))
    whole = np.round(values * 10.0**digits).astype(np.int64)
    return {"d": digits, "v": [int(whole[0]), *np.diff(whole).tolist()]}
