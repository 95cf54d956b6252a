"""The page of a camshaft: when its lobes lift, how they stand, what was checked; one HTML file without scripts."""

from __future__ import annotations

import re
from html import escape
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.camshaft.diagrams import page_diagrams
from camgeo.capabilities.camshaft.svg import SHEET
from camgeo.measures.units import UNIT_NAMES
from camgeo.report.page import tables
from camgeo.report.page.page import RELOAD, head

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe

LOBES = {
    "name": "lobe",
    "recipe": "recipe",
    "at_deg": "turned by",
    "zero_deg": "begins at",
    "from": "from z",
    "to": "to z",
    "lift": "lift of events",
    "opens_deg": "opens",
    "closes_deg": "closes",
    "centre_deg": "centre",
    "duration_deg": "duration",
    "opens_crank_deg": "opens, crank",
    "closes_crank_deg": "closes, crank",
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
LENGTHS = {"from", "to", "lift"}  # other numbers of these tables are degrees, but for cylinders
# the place of a check is a button where a page can turn the shaft there
TURNING = re.compile(r"<button[^>]*>(.*?)</button>", re.DOTALL)


def page(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], report: dict[str, Any]) -> str:
    """Return the HTML page of a camshaft, from its lobes and its report."""
    section = report["camshaft"]
    figures = [f"<section><figure>{diagram}</figure></section>" for diagram in page_diagrams(recipe, lobes)]
    parts = [f'{head(recipe, report, SHEET)}</header>\n<main>\n<div class="diagrams">', *figures, "</div>"]
    parts.append(_section(f"Lobes: {UNIT_NAMES[recipe.units]} and degrees of the cam", _table(section["lobes"], LOBES)))
    if section.get("cylinders"):
        parts.append(_section("Valve events, crank degrees", _table(section["cylinders"], CYLINDERS)))
    parts += [
        _section("Checks", TURNING.sub(r"\1", tables.checks(report))),
        _section("Files", tables.file_table(report)),
    ]
    source = f"<details><summary>Recipe</summary><pre>{escape(recipe.text)}</pre></details>"
    parts.append(f'<section class="tables">{source}</section>')
    return "\n".join([*parts, f"</main>\n{RELOAD}\n</body>\n</html>\n"])


def _section(title: str, body: str) -> str:
    return f'<section class="tables"><h2>{escape(title)}</h2>{body}</section>'


def _table(entries: Sequence[dict[str, Any]], heads: dict[str, str]) -> str:
    known = [key for key in heads if any(key in entry for entry in entries)]
    cells = "".join(f'<th scope="col">{escape(heads[key])}</th>' for key in known)
    rows = ("".join(f'<td class="number">{_cell(key, entry.get(key))}</td>' for key in known) for entry in entries)
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    return f'<div class="wide"><table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table></div>'


def _cell(key: str, value: str | float | None) -> str:
    if value is None or isinstance(value, str) or key == "cylinder":
        return tables.NONE if value is None else escape(str(value))
    return tables.number(value) if key in LENGTHS else tables.degrees(value)
