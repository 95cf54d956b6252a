"""What the page shows of a budget: its sums, its dimensions, and their shares of the worst case over the turn."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.budget.text import TITLES
from camgeo.report.page.tables import html_table, named_row, number, place_button

if TYPE_CHECKING:
    from collections.abc import Sequence

WIDE, HIGH, LEFT, FOOT = 720, 220, 44, 22  # size of the picture, and of its scales on the left and below, px
TURN = 360  # degrees
HUES = (210, 18, 140, 275, 45, 330, 180, 90)  # degrees of colour, in the order of the dimensions


def panel(report: dict[str, Any]) -> str:
    """HTML section on the budget of errors, from a report as plain data; empty where the report has no budget."""
    entry = report.get("budget")
    if entry is None:
        return ""
    # two tables: the sums with their limit, and a row for each dimension
    unit, permitted = escape(entry["unit"]), number(entry["permitted"])
    sums = [
        named_row(
            TITLES[kind],
            f"{number(entry[kind]['value'])} {unit}",
            place_button(entry[kind]["at_deg"], "shaft"),
            f"≤ {permitted} {unit}" if kind == entry["sum"] else "–",
        )
        for kind in TITLES
    ]
    rows = [
        named_row(
            escape(row["name"]),
            f"{'radius ' if row['radius'] else '± '}{number(row['tolerance'])} {escape(row['unit'])}",
            f"{number(row['influence'])} {escape(row['influence_unit'])}",
            f"{row['share']:.1%}",
        )
        for row in entry["dimensions"]
    ]
    head = '<section aria-labelledby="budget-head"><h2 id="budget-head">Budget of errors</h2>'
    state = "is kept" if entry["kept"] else "is not kept"
    words = f"<p>What is permitted, {permitted} {unit}, {state} by the {TITLES[entry['sum']]}.</p>"
    dimensions = html_table("Budget", ("dimension", "tolerance", "influence there", "share"), rows)
    totals = html_table("Sums", ("sum", "value", "at", "limit"), sums)
    return f"{head}{words}{totals}{dimensions}{_shares(entry)}</section>"


def _shares(entry: dict[str, Any]) -> str:
    """HTML of the worst case over the turn: dimensions as stacked areas, the permitted error as a dashed line."""
    turn = entry["over_turn"]
    angles = np.array([*turn["at_deg"], turn["at_deg"][0] + TURN])
    rows = {name: np.array([*values, values[0]]) for name, values in turn["worst"].items()}
    whole = np.sum([*rows.values()], axis=0)
    # the scale ends 8 % above the greatest sum, or above the permitted error unless the areas would be too low to read
    top = 1.08 * max(float(whole.max()), entry["permitted"] if entry["permitted"] < 3.0 * whole.max() else 0.0)

    def across(angle: Sequence[float]) -> list[float]:
        return [LEFT + (WIDE - LEFT) * (a - angles[0]) / TURN for a in angle]

    def upright(value: Sequence[float]) -> list[float]:
        return [(HIGH - FOOT) * (1.0 - v / top) for v in value]

    # areas from below, with a legend; more dimensions than hues repeat them lighter
    below, shapes, names = np.zeros(len(angles)), [], []
    for i, (name, row) in enumerate(rows.items()):
        fill = f"hsl({HUES[i % len(HUES)]} 55% {58 if i < len(HUES) else 72}%)"
        x = across([*angles, *angles[::-1]])
        y = upright([*(below + row), *below[::-1]])
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
        shapes.append(f'<polygon points="{points}" fill="{fill}"><title>{escape(name)}</title></polygon>')
        names.append(f'<span style="white-space:nowrap"><span style="color:{fill}">■</span> {escape(name)}</span>')
        below = below + row
    (line,) = upright([entry["permitted"]])
    if line >= 0.0:
        shapes.append(f'<path d="M{LEFT} {line:.1f}H{WIDE}" stroke="var(--bad)" stroke-dasharray="5 4" fill="none"/>')
    # scales: error on the left, shaft angle below
    scale = [(0.0, "0"), (top / 1.08, f"{top / 1.08:.3g}")]
    texts = [f'<text x="{LEFT - 6}" y="{upright([v])[0] + 4:.1f}" text-anchor="end">{t}</text>' for v, t in scale]
    texts += [
        f'<text x="{across([angles[0] + a])[0]:.1f}" y="{HIGH - 6}" text-anchor="middle">{a}°</text>'
        for a in range(90, TURN, 90)
    ]
    picture = (
        f'<svg viewBox="0 0 {WIDE} {HIGH}" role="img" aria-label="shares of the worst case over the shaft angle" '
        f'style="width:100%;max-width:{WIDE}px;display:block" font-size="11" fill="currentColor">'
        f"{''.join(shapes)}{''.join(texts)}</svg>"
    )
    words = f"Worst case over the shaft angle, {escape(entry['unit'])}, one dimension on the other:"
    return f"<p>{words} {' '.join(names)}</p>{picture}"
