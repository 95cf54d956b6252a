"""The page of a camshaft: when its lobes lift, how they stand, what was checked; one HTML file without scripts."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING, Any

from camgeo.camshaft.timing import bars, timing
from camgeo.report.page import tables
from camgeo.report.page.page import head

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
# a drawing wider than its screen is moved aside, not made too small to be read
FITTING = """\
figure { margin: 0; overflow-x: auto; }
figure svg { display: block; min-width: 600px; max-width: 100%; height: auto; margin: auto; }
"""
# the place of a check is a button where a page can turn the shaft there
TURNING = re.compile(r"<button[^>]*>(.*?)</button>", re.DOTALL)


def page(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], report: dict[str, Any]) -> str:
    """Return the page of a camshaft from its lobes and what the report says."""
    section = report["camshaft"]
    drawings = [timing(recipe, lobes)] + ([bars(recipe, lobes)] if recipe.engine is not None else [])
    parts = [f"{head(recipe, report, FITTING)}</header>\n<main>"]
    parts += [f'<section class="tables"><figure>{drawing}</figure></section>' for drawing in drawings]
    parts.append(_section("Lobes", _table(section["lobes"], LOBES)))
    if section.get("cylinders"):
        parts.append(_section("Valve events, crank degrees", _table(section["cylinders"], CYLINDERS)))
    parts += [_section("Checks", TURNING.sub(r"\1", tables.checks(report))), _section("Files", tables.written(report))]
    source = f"<details><summary>Recipe</summary><pre>{escape(recipe.text)}</pre></details>"
    parts.append(f'<section class="tables">{source}</section>')
    return "\n".join([*parts, "</main>\n</body>\n</html>\n"])


def _section(title: str, body: str) -> str:
    return f'<section class="tables"><h2>{escape(title)}</h2>{body}</section>'


def _table(entries: Sequence[dict[str, Any]], heads: dict[str, str]) -> str:
    known = [key for key in heads if any(key in entry for entry in entries)]
    cells = "".join(f'<th scope="col">{escape(heads[key])}</th>' for key in known)
    rows = ("".join(f'<td class="number">{_cell(entry.get(key))}</td>' for key in known) for entry in entries)
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table></div>'


def _cell(value: object) -> str:
    return tables.NONE if value is None else f"{value:.6g}" if isinstance(value, float) else escape(str(value))
