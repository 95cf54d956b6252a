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

    from camgeo.camshaft.lobes import PlacedLobe
    from camgeo.recipe.camshaft import CamshaftRecipe

INK, FAINT, PAPER = "#1d2733", "#c3cad3", "#ffffff"
COLOURS = {"intake": "#2f6fb2", "exhaust": "#c2562d", "": "#4a7d3c"}
WIDTH, ROW, LEFT, RIGHT = 860.0, 46.0, 150.0, 24.0
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
    """Return a row for each lobe: its lift over the shaft's angle, and a bar where it is beyond the lift of events."""
    height = 64.0 + ROW * len(lobes) + 40.0
    span = WIDTH - LEFT - RIGHT
    base = 64.0 + ROW * len(lobes)
    parts = [_text(LEFT, 28.0, f"{recipe.name}: lifts over the shaft's angle", size=16.0)]
    for degree in range(0, 361, 30):
        x = LEFT + span * degree / 360.0
        parts.append(f'<line x1="{x:.2f}" y1="48" x2="{x:.2f}" y2="{base:.2f}" stroke="{FAINT}" stroke-width="1"/>')
        parts.append(_text(x, base + 18.0, f"{degree}", size=12.0, anchor="middle"))
    parts.append(_text(LEFT + 0.5 * span, base + 35.0, "shaft angle, degrees", size=12.0, anchor="middle"))
    angle = np.arange(0.0, 360.5, 0.5)
    for number, (lobe, lift) in enumerate(zip(lobes, lifts(lobes, np.radians(angle)), strict=True)):
        foot = 64.0 + ROW * (number + 1) - 6.0
        share = (lift - lift.min()) / max(float(np.ptp(lift)), 1e-12)
        points = " ".join(
            f"{LEFT + span * a / 360.0:.2f},{foot - (ROW - 14.0) * v:.2f}"
            for a, v in zip(angle.tolist(), share.tolist(), strict=True)
        )
        colour = COLOURS[lobe.lobe.valve]
        parts.append(
            f'<polygon points="{LEFT:.2f},{foot:.2f} {points} {LEFT + span:.2f},{foot:.2f}" fill="{colour}" '
            f'fill-opacity="0.25" stroke="{colour}" stroke-width="1.5"/>'
        )
        found = lobe.event(event_lift(recipe, lobe))
        for low, high in [] if found is None else _split(found.opens, found.duration):
            x = LEFT + span * low / 360.0
            width = span * (high - low) / 360.0
            parts.append(f'<rect x="{x:.2f}" y="{foot:.2f}" width="{width:.2f}" height="5" fill="{colour}"/>')
        parts.append(_text(LEFT - 10.0, foot - 8.0, lobe.lobe.name, anchor="end"))
    return _page(WIDTH, height, f"{recipe.name}: timing", parts)


def _split(opens: float, duration: float) -> list[tuple[float, float]]:
    """A stretch of degrees, in two where it passes 360."""
    closes = opens + duration
    return [(opens, closes)] if closes <= 360.0 else [(opens, 360.0), (0.0, closes - 360.0)]


def _wheel(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> str:
    """A ring for each lobe on a wheel of 720 crank degrees, clockwise from the first cylinder's firing dead centre."""
    size, middle = 720.0, 360.0
    outer, inner = 250.0, 90.0
    step = (outer - inner) / len(lobes)
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
            f'stroke="{colour}" stroke-width="{min(0.6 * step, 14.0):.2f}"/>'
        )
        a = start + 0.5 * sweep
        if lobe.lobe.cylinder is not None:
            x, y = middle + radius * math.sin(a), middle - radius * math.cos(a)
            size_told = min(11.0, 0.7 * step)
            parts.append(
                _text(x, y + 0.36 * size_told, f"{lobe.lobe.cylinder}", size=size_told, anchor="middle", colour=PAPER)
            )
    for k, (valve, words) in enumerate((("intake", "intake"), ("exhaust", "exhaust"), ("", "other lobe"))):
        if any(lobe.lobe.valve == valve for lobe in lobes):
            parts.append(f'<rect x="20" y="{650 + 20 * k}" width="14" height="12" fill="{COLOURS[valve]}"/>')
            parts.append(_text(42.0, 661.0 + 20 * k, words, size=12.0))
    return _page(size, 720.0, f"{recipe.name}: valve timing", parts)


def _first(recipe: CamshaftRecipe) -> int:
    if recipe.engine is None:
        raise ValueError("a wheel is of an engine")
    return next(iter(recipe.engine.firing))
