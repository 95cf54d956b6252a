"""When lobes lift, drawn: a degree wheel for an engine, bars over the shaft's angle else; SVG with literal colours."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.camshaft.lobes import lifts
from camgeo.camshaft.tables import event_lift
from camgeo.files.markup import one_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.camshaft.events import Phase, Stretch
    from camgeo.camshaft.lobes import PlacedLobe
    from camgeo.recipe.camshaft import CamshaftRecipe

INK, FAINT, PAPER = "#1d2733", "#c3cad3", "#ffffff"
COLOURS = {"intake": "#2f6fb2", "exhaust": "#c2562d", "": "#4a7d3c"}
SHADES: dict[Phase, float] = {"rise": 0.55, "dwell": 0.08, "return": 0.3}
WIDTH, TOP, LEFT, RIGHT = 860.0, 52.0, 150.0, 24.0
ROW, CURVE, BAR = 62.0, 36.0, 16.0  # of a lobe: its row, in it the height of its curve and of its bars
RING = 16.0  # of a lobe of an engine: the least that shows the number of its cylinder
LETTER = 6.3  # greatest width of a letter of a bar's label
FONT = 'font-family="DejaVu Sans, Arial, sans-serif"'


def timing(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> str:
    """Return the diagram as an SVG text."""
    return _wheel(recipe, lobes) if recipe.engine is not None else bars(recipe, lobes)


def _text(x: float, y: float, words: str, *, size: float = 13.0, anchor: str = "start", colour: str = INK) -> str:
    return (
        f'<text x="{x:.2f}" y="{y:.2f}" font-size="{size:g}" text-anchor="{anchor}" fill="{colour}" {FONT}>'
        f"{one_line(words)}</text>"
    )


def _page(width: float, height: float, title: str, parts: Sequence[str]) -> str:
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
        f'viewBox="0 0 {width:g} {height:g}"><title>{one_line(title)}</title>'
        f'<rect width="{width:g}" height="{height:g}" fill="{PAPER}"/>'
    )
    return "\n".join([head, *parts, "</svg>"]) + "\n"


def bars(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> str:
    """Return a row for each lobe: its lift over the shaft's angle, below it a bar for each rise, dwell and return.

    What passes 360 degrees is split there. Of an engine a line besides shows where a lobe is beyond the lift of events.
    """
    span, base = WIDTH - LEFT - RIGHT, TOP + ROW * len(lobes)
    parts = [_text(LEFT, 28.0, f"{recipe.name}: lifts over the shaft's angle", size=16.0)]
    for degree in range(0, 361, 30):
        x = LEFT + span * degree / 360.0
        parts.append(f'<line x1="{x:.2f}" y1="48" x2="{x:.2f}" y2="{base:.2f}" stroke="{FAINT}" stroke-width="1"/>')
        parts.append(_text(x, base + 18.0, f"{degree}", size=12.0, anchor="middle"))
    parts.append(_text(LEFT + 0.5 * span, base + 35.0, "shaft angle, degrees", size=12.0, anchor="middle"))
    angle = np.arange(0.0, 360.5, 0.5)
    for number, (lobe, lift) in enumerate(zip(lobes, lifts(lobes, np.radians(angle)), strict=True)):
        top = TOP + ROW * number
        foot = top + CURVE
        share = (lift - lift.min()) / max(float(np.ptp(lift)), 1e-12)
        points = " ".join(
            f"{LEFT + span * a / 360.0:.2f},{foot - (CURVE - 6.0) * v:.2f}"
            for a, v in zip(angle.tolist(), share.tolist(), strict=True)
        )
        colour = COLOURS[lobe.lobe.valve]
        parts.append(
            f'<polygon points="{LEFT:.2f},{foot:.2f} {points} {LEFT + span:.2f},{foot:.2f}" fill="{colour}" '
            f'fill-opacity="0.25" stroke="{colour}" stroke-width="1.5"/>'
        )
        for stretch in lobe.stretches:
            parts += _bar(stretch, foot, colour, lobe.lobe.name)
        event = lobe.event(event_lift(recipe, lobe)) if recipe.engine is not None else None
        for low, high in [] if event is None else _split(event.opens, event.opens + event.duration):
            x, width = LEFT + span * low / 360.0, span * (high - low) / 360.0
            parts.append(
                f'<rect x="{x:.2f}" y="{foot + BAR + 2.0:.2f}" width="{width:.2f}" height="3" fill="{colour}"/>'
            )
        parts.append(_text(LEFT - 10.0, foot - 4.0, lobe.lobe.name, anchor="end"))
    return _page(WIDTH, base + 40.0, f"{recipe.name}: timing", parts)


def _bar(stretch: Stretch, y: float, colour: str, name: str) -> list[str]:
    """The bar of a stretch, in two where it passes 360 degrees, each with as much of its label as it has room for."""
    span, parts = WIDTH - LEFT - RIGHT, []
    label = f"{stretch.phase} {round(stretch.begin, 3):.4g}–{round(_end(stretch.end), 3):.4g}"
    for low, high in _split(stretch.begin, stretch.end):
        x, width = LEFT + span * low / 360.0, span * (high - low) / 360.0
        parts.append(
            f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{BAR:g}" fill="{colour}" '
            f'fill-opacity="{SHADES[stretch.phase]:g}" stroke="{colour}" stroke-width="1">'
            f"<title>{one_line(name)}: {label} degrees</title></rect>"
        )
        words = next((words for words in (label, stretch.phase) if LETTER * len(words) + 6.0 <= width), "")
        if words:
            parts.append(_text(x + 0.5 * width, y + BAR - 4.5, words, size=11.0, anchor="middle"))
    return parts


def _end(degrees: float) -> float:
    """The end of a stretch as a reading of the shaft: 360 stays."""
    return degrees if degrees <= 360.0 else degrees - 360.0


def _split(begin: float, end: float) -> list[tuple[float, float]]:
    """A stretch of degrees, in two where it passes 360."""
    return [(begin, end)] if end <= 360.0 else [(begin, 360.0), (0.0, end - 360.0)]


def _wheel(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> str:
    """A ring for each lobe on a wheel of 720 crank degrees, clockwise from the first cylinder's firing dead centre."""
    inner = 90.0
    outer = inner + max(160.0, RING * len(lobes))
    middle, step = outer + 110.0, (outer - inner) / len(lobes)
    parts = [
        _text(
            20.0, 28.0, f"{recipe.name}: crank degrees after firing dead centre of cylinder {_first(recipe)}", size=16.0
        )
    ]
    for degree in range(0, 720, 30):
        a = math.radians(0.5 * degree)
        x, y = math.sin(a), -math.cos(a)
        strong = degree % 180 == 0
        parts.append(
            f'<line x1="{middle + inner * x:.2f}" y1="{middle + inner * y:.2f}" x2="{middle + (outer + 8) * x:.2f}" '
            f'y2="{middle + (outer + 8) * y:.2f}" stroke="{INK if strong else FAINT}" stroke-width="1"/>'
        )
        told = f"{degree}" + ({0: " TDC", 180: " BDC", 360: " TDC", 540: " BDC"}.get(degree, ""))
        anchor = "middle" if abs(x) < 0.2 else "start" if x > 0.0 else "end"
        parts.append(_text(middle + (outer + 20) * x, middle + (outer + 20) * y + 4.0, told, size=12.0, anchor=anchor))
    for number, lobe in enumerate(lobes):
        radius = outer - step * (number + 0.5)
        colour = COLOURS[lobe.lobe.valve]
        parts.append(
            f'<circle cx="{middle:g}" cy="{middle:g}" r="{radius:.2f}" fill="none" stroke="{FAINT}" stroke-width="1"/>'
        )
        found = lobe.event(event_lift(recipe, lobe))
        if found is None:
            continue
        start, sweep = math.radians(found.opens), math.radians(found.duration)
        ends = [(middle + radius * math.sin(a), middle - radius * math.cos(a)) for a in (start, start + sweep)]
        large = 1 if sweep > math.pi else 0
        (x0, y0), (x1, y1) = ends
        parts.append(
            f'<path d="M {x0:.2f} {y0:.2f} A {radius:.2f} {radius:.2f} 0 {large} 1 {x1:.2f} {y1:.2f}" fill="none" '
            f'stroke="{colour}" stroke-width="{min(0.75 * step, 14.0):.2f}"/>'
        )
        a = start + 0.5 * sweep
        if lobe.lobe.cylinder is not None:
            x, y = middle + radius * math.sin(a), middle - radius * math.cos(a)
            size_told = min(11.0, 0.6 * step)
            parts.append(
                _text(x, y + 0.36 * size_told, f"{lobe.lobe.cylinder}", size=size_told, anchor="middle", colour=PAPER)
            )
    for k, (valve, words) in enumerate((("intake", "intake"), ("exhaust", "exhaust"), ("", "other lobe"))):
        if any(lobe.lobe.valve == valve for lobe in lobes):
            parts.append(
                f'<rect x="20" y="{2.0 * middle - 70.0 + 20.0 * k:g}" width="14" height="12" fill="{COLOURS[valve]}"/>'
            )
            parts.append(_text(42.0, 2.0 * middle - 59.0 + 20.0 * k, words, size=12.0))
    return _page(2.0 * middle, 2.0 * middle, f"{recipe.name}: valve timing", parts)


def _first(recipe: CamshaftRecipe) -> int:
    if recipe.engine is None:
        raise ValueError("a wheel is of an engine")
    return next(iter(recipe.engine.firing))
