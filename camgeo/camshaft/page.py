"""The page of a camshaft: when its lobes lift, how they stand, what was checked; one HTML file without scripts."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING, Any

from camgeo.camshaft.timing import bars, timing
from camgeo.report.page import looks, tables
from camgeo.report.page.asset import asset

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.camshaft.lobes import PlacedLobe
    from camgeo.recipe.camshaft import CamshaftRecipe

LOBES = {
    "name": "lobe",
    "recipe": "recipe",
    "at_deg": "turned by, deg",
    "zero_deg": "begins at, deg",
    "from": "from z",
    "to": "to z",
    "lift": "lift of events",
    "opens_deg": "opens, deg",
    "closes_deg": "closes, deg",
    "centre_deg": "centre, deg",
    "duration_deg": "duration, deg",
    "opens_crank_deg": "opens, crank deg",
    "closes_crank_deg": "closes, crank deg",
}
CYLINDERS = {
    "cylinder": "cylinder",
    "intake_opens": "IVO BTDC",
    "intake_closes": "IVC ABDC",
    "exhaust_opens": "EVO BBDC",
    "exhaust_closes": "EVC ATDC",
    "overlap": "overlap",
    "separation": "LSA, cam deg",
}
HEAD = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<meta name="generator" content="camgeo">
<link rel="icon" href="data:,">
"""
FITTING = "figure svg { max-width: 100%; height: auto }"
# the place of a check is a button where a page can turn the shaft there
TURNING = re.compile(r"<button[^>]*>(.*?)</button>", re.DOTALL)


def page(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], report: dict[str, Any]) -> str:
    """Return the page of a camshaft from its lobes and what the report says."""
    section, holds = report["camshaft"], report["ok"]
    verdict = "every check holds" if holds else tables.failing(report["checks"])
    drawings = [timing(recipe, lobes)] + ([bars(recipe, lobes)] if recipe.engine is not None else [])
    style = asset("drawing.css") + looks.rules() + asset("page.css") + FITTING
    text = escape(recipe.text)
    parts = [f"{HEAD}<title>{escape(recipe.name)} – camgeo</title>", f"<style>\n{style}</style>\n</head>\n<body>"]
    parts += [
        f"<header>\n<h1>{escape(recipe.name)}</h1>",
        f'<span class="verdict {"ok" if holds else "failed"}">{verdict}</span>',
    ]
    parts += [f'<p class="about">{escape(recipe.about)}</p>\n</header>\n<main>']
    parts += [f"<figure>{drawing}</figure>" for drawing in drawings]
    parts.append(_section("Lobes", _table(section["lobes"], LOBES)))
    if section.get("cylinders"):
        parts.append(_section("Valve events, crank degrees", _table(section["cylinders"], CYLINDERS)))
    parts += [_section("Checks", TURNING.sub(r"\1", tables.checks(report))), _section("Files", tables.written(report))]
    parts.append(f'<section class="tables"><details><summary>Recipe</summary><pre>{text}</pre></details></section>')
    return "\n".join([*parts, "</main>\n</body>\n</html>\n"])


def _section(title: str, body: str) -> str:
    return f'<section class="tables"><h2>{escape(title)}</h2>{body}</section>'


def _table(entries: Sequence[dict[str, Any]], heads: dict[str, str]) -> str:
    known = [key for key in heads if any(key in entry for entry in entries)]
    head = "".join(f'<th scope="col">{escape(heads[key])}</th>' for key in known)
    rows = ("".join(f'<td class="number">{_cell(entry.get(key))}</td>' for key in known) for entry in entries)
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def _cell(value: object) -> str:
    return tables.NONE if value is None else f"{value:.6g}" if isinstance(value, float) else escape(str(value))
