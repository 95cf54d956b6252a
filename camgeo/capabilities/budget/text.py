"""A budget as text: the verdict, a line a dimension, what is left, and the parts that were simulated."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.budget.dimensions import CONTOUR
from camgeo.capabilities.budget.outcome import SUMS
from camgeo.common.rounding import downward
from camgeo.report.document import align

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Recipe

TITLES = {"worst": "worst case", "rss": "root sum of squares"}
HEAD = ("dimension", "plus and minus", "influence", "share")


def table(recipe: Recipe, entry: dict[str, Any]) -> str:
    """Text of several lines on a budget, from the plain data `entry` that `library.budget` returns."""
    unit, kind = entry["unit"], entry["sum"]
    chosen, other = entry[kind], "rss" if kind == "worst" else "worst"
    verdict = f"{recipe.name}: {entry['permitted']:.6g} {unit} {'kept' if entry['kept'] else 'NOT KEPT'}"
    lines = [f"{verdict} by {TITLES[kind]}: {_place(chosen)}; by {TITLES[other]} {_place(entry[other])}"]
    if not entry["kept"]:
        largest = max(chosen["shares"], key=lambda name: chosen["shares"][name])
        lines.append(f"  {largest} takes most of it, {chosen['shares'][largest]:.0%}")
    rows = [HEAD, *map(_row, entry["dimensions"])]
    if CONTOUR in entry["worst"]["shares"]:
        share = entry["worst"]["shares"][CONTOUR]
        rows.append((CONTOUR, f"{share * entry['worst']['value']:.4g} {unit}", "", f"{share:.1%}"))
    lines += [f"  {line}" for line in align(rows).splitlines()]
    if "left" in entry:
        left = entry["left"]
        lines.append(f"  left for {left['name']}: {downward(left['least'])} {left['unit']} at {left['at_deg']:.4g} deg")
    if "play" in entry:
        play = entry["play"]
        limit = "" if play["limit"] is None else f", {play['limit']:.6g} permitted"
        lines.append(f"  play from {play['min']:.4g} to {play['max']:.4g} {unit}{limit}")
    if "velocity" in entry:
        rates = entry["velocity"]
        sums = " and ".join(f"by {TITLES[kind]} {_place(rates[kind])}" for kind in SUMS)
        lines.append(f"  velocity, with {rates['waves']} waves of the profile: {sums}")
    return "\n".join([*lines, *_simulated(entry.get("parts"))])


def _row(row: dict[str, Any]) -> tuple[str, ...]:
    """Cells of a dimension, in the order of `HEAD`; a tolerance that was free is rounded down."""
    free = row["free"] and row["tolerance"] > 0.0
    size = downward(row["tolerance"]) if free else f"{row['tolerance']:.6g}"
    return (
        row["name"] + (" (found)" if row["free"] else ""),
        f"{'radius ' if row['radius'] else ''}{size} {row['unit']}",
        f"{row['influence']:.4g} {row['influence_unit']}",
        f"{row['share']:.1%}",
    )


def _simulated(parts: dict[str, Any] | None) -> list[str]:
    """Lines on the simulated parts; none without a simulation."""
    if parts is None:
        return []
    if "why" in parts:
        return [f"  no parts were simulated: {parts['why']}"]
    worst, unit = parts["worst"], parts["unit"]
    agrees = "agrees" if worst["agrees"] else "does not agree"
    where = f" on {' and '.join(parts['files'])}" if parts["files"] else ""
    kept, greatest = f"{parts['within']:.2%} keep it", f"the greatest error is {parts['greatest']:.4g} {unit}"
    deviation = f"standard deviation at {worst['at_deg']:.4g} deg {worst['sd']:.4g} {unit}"
    return [
        f"  of {parts['runs']:,} parts by contact{where} {kept}, {greatest}",
        f"  {deviation}, which {agrees} with {worst['foreseen']:.4g} by the influences",
    ]


def _place(sum_: dict[str, Any]) -> str:
    """Value of a sum, with its unit, and the shaft angle."""
    return f"{sum_['value']:.4g} {sum_['unit']} at {sum_['at_deg']:.4g} deg"
