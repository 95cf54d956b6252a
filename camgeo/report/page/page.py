"""The page as one HTML file: template, style and script from this folder, drawing, tables and data from a recipe."""

from __future__ import annotations

import json
import math
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.registry import registry
from camgeo.report.document import finite
from camgeo.report.failure import headline
from camgeo.report.page import looks, svg, tables
from camgeo.report.page.asset import asset
from camgeo.report.page.pack import packed
from camgeo.report.page.scene import STEPS

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Order, Recipe
    from camgeo.report.page.content import Content
    from camgeo.report.page.curves import Plot
    from camgeo.report.page.scene import Body

RELOAD = "<!-- reload -->"  # where a page that is watched gets the script that reloads it
LOCAL = "connect-src 'none'"  # a page may connect to nothing; one that is watched to where it came from


def page(recipe: Recipe, content: Content, report: dict[str, Any]) -> str:
    """Return the page of a recipe from what it shows and what the report says."""
    shown = scene(recipe, content, report)
    parts = {
        "note": escape(shown.pop("note")),
        "facts": tables.facts(report),
        "drawing": shown.pop("drawing"),
        "checks": tables.checks(report),
        "files": tables.written(report),
        "linkage": tables.linkage(report),
        "panels": tables.preload(report) + _panels(recipe, report),
        "skipped": tables.skipped(report),
        "recipe": escape(recipe.text),
        "script": asset("page.js"),
        "data": encoded(shown),
    }
    return head(recipe, report) + _filled("page.html", parts)


def _panels(recipe: Recipe, report: dict[str, Any]) -> str:
    """Return what the capabilities of a recipe show of its report."""
    return "".join(capability.panel(report) for capability in registry.in_order(recipe.uses))


def head(recipe: Order, report: dict[str, Any], more: str = "") -> str:
    """Return what any page begins with: what it may load, its style with `more` rules, name, verdict and note."""
    ok = report["ok"]
    parts = {
        "title": escape(recipe.name),
        "about": escape(recipe.about),
        "verdict": "every check holds" if ok else tables.failing(report["checks"]),
        "state": "ok" if ok else "failed",
        "style": asset("drawing.css") + looks.rules() + asset("page.css") + more,
    }
    return _filled("head.html", parts)


def _filled(name: str, parts: dict[str, str]) -> str:
    """Return a file of this folder with its {{parts}} in their places."""
    first, *rest = asset(name).split("{{")
    text = [first]
    for piece in rest:
        part, _, after = piece.partition("}}")
        text += [parts[part], after]
    return "".join(text)


def encoded(values: object) -> str:
    """Return plain data as JSON that may stand within a script element."""
    text = json.dumps(finite(values), separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("<", "\\u003c")


def scene(recipe: Recipe, content: Content, report: dict[str, Any]) -> dict[str, Any]:
    """Return all that the script draws, as plain data; angles in degrees, lengths in the recipe's unit.

    `drawing` is the mechanism at shaft angle 0 as SVG, the group of body k with the id `body-k`, and `bodies` how each
    moves: rows of x, y and angle at equal steps of a turn, packed (`camgeo.report.page.pack`). `marks` are the places
    on the contour, in the axes of the cam, where checks of `report` fail and remarks are made.
    """
    view = svg.View.of(content.scene)
    extent = max(view.width, view.height) / view.scale
    return {
        "name": recipe.name,
        "note": content.scene.note,
        "drawing": svg.moving(content.scene),
        "marks": _marks(content, report),
        "unit": "in" if recipe.units == "inch" else "mm",
        "sense": -1 if recipe.rotation == "cw" else 1,
        "steps": STEPS,
        "view": [view.scale, view.x, view.y, svg.BESIDE],
        "bodies": [_pose(body, extent) for body in content.scene.bodies],
        "plots": [_plot(plot) for plot in content.plots],
        "rests": [[rest.start, rest.length, rest.name] for rest in content.rests],
        "relative": packed(np.degrees(content.relative)),
        "linked": any(plot.over == "relative" for plot in content.plots),
        "contours": {
            name: [packed(row) for row in (*traced.point.T, *traced.normal.T)]
            for name, traced in content.contours.items()
        },
        "errors": [
            {
                "file": ", ".join(filter(None, (error.name, error.surface))),
                "surface": error.surface,
                "low": packed(error.low),
                "high": packed(error.high),
                "tolerance": float(f"{error.tolerance:.6g}"),
            }
            for error in content.errors
        ],
    }


def _marks(content: Content, report: dict[str, Any]) -> list[dict[str, Any]]:
    """Return where on a contour checks of the design fail and remarks are made; those of no surface on the first."""
    found = [(check, "failed") for check in report["checks"] if not check["ok"] and "file" not in check]
    found += [(remark, "remark") for remark in report["remarks"]]
    marks = []
    for entry, kind in found:
        if entry["at_deg"] is None:
            continue
        first = next(iter(content.contours))
        x, y = (
            content.contours[entry.get("surface", first)]
            .point[round(entry["at_deg"] / 360.0 * STEPS - 0.5) % STEPS]
            .tolist()
        )
        text = entry.get("sentence") or headline(entry)
        marks.append({"name": entry["name"], "kind": kind, "at_deg": entry["at_deg"], "x": x, "y": y, "text": text})
    return marks


def _pose(body: Body, extent: float) -> list[dict[str, Any]]:
    """Return x, y and angle of a body; a small movement is reported as finely as a large one."""
    x, y, angle = body.pose.T
    rows = [packed(row, _fine(row, extent)) for row in (x, y)]
    return [*rows, packed(np.degrees(angle), _fine(np.degrees(angle), 90.0))]


def _fine(row: np.ndarray[Any, np.dtype[np.float64]], extent: float) -> float:
    spread = float(np.ptp(row))
    return min(extent, spread) if spread > 0.0 else extent


def _plot(plot: Plot) -> dict[str, Any]:
    entry: dict[str, Any] = {
        "title": plot.title,
        "unit": plot.unit,
        "series": [{"name": series.name, **packed(series.values)} for series in plot.series],
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
