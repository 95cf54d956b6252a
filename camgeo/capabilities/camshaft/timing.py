"""When lobes lift over the shaft's angle, drawn: their curves, and a bar for each rise, dwell and return; SVG."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.camshaft.diagram import LETTER, WIDTH, both, filled, kind, line, sheet, text
from camgeo.capabilities.camshaft.lobes import lifts
from camgeo.capabilities.camshaft.tables import event_lift
from camgeo.files.markup import one_line
from camgeo.measures.units import UNIT_NAMES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.camshaft.events import Phase, Stretch
    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe

SHADES: dict[Phase, float] = {"rise": 0.55, "dwell": 0.08, "return": 0.3}
TOP, LEFT, RIGHT = 44.0, 16.0, 18.0
ROW, NAME, CURVE, BAR = 68.0, 18.0, 26.0, 16.0  # of a lobe: its row, in it its name, its curve and its bars


def bars(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> str:
    """Return a row for each lobe: its lift over the shaft's angle, below it a bar for each rise, dwell and return.

    What passes 360 degrees is split there. Of an engine a line besides shows where a lobe is beyond the lift of events.
    """
    span, base = WIDTH - LEFT - RIGHT, TOP + ROW * len(lobes)
    parts = [text(LEFT, 24.0, f"{recipe.name}: lifts over the shaft's angle", size=15.0)]
    for degree in range(0, 361, 30):
        x = LEFT + span * degree / 360.0
        parts.append(line("faint", x, TOP - 4.0, x, base))
        parts.append(text(x, base + 15.0, f"{degree}", size=11.0, anchor="middle"))
    parts.append(text(LEFT + 0.5 * span, base + 31.0, "shaft angle, degrees of the cam", anchor="middle"))
    angle = np.arange(0.0, 360.5, 0.5)
    for number, (lobe, lift) in enumerate(zip(lobes, lifts(lobes, np.radians(angle)), strict=True)):
        top = TOP + ROW * number
        foot = top + NAME + CURVE
        share = (lift - lift.min()) / max(float(np.ptp(lift)), 1e-12)
        points = " ".join(
            f"{LEFT + span * a / 360.0:.2f},{foot - (CURVE - 2.0) * v:.2f}"
            for a, v in zip(angle.tolist(), share.tolist(), strict=True)
        )
        colour, look = kind(lobe.lobe.valve), both(kind(lobe.lobe.valve), 0.25, 1.5)
        parts.append(f'<polygon points="{LEFT:.2f},{foot:.2f} {points} {LEFT + span:.2f},{foot:.2f}" {look}/>')
        for stretch in lobe.stretches:
            parts += _bar(stretch, foot, colour, lobe.lobe.name)
        event = lobe.event(event_lift(recipe, lobe)) if recipe.engine is not None else None
        for low, high in [] if event is None else _split(event.opens, event.opens + event.duration):
            x, width = LEFT + span * low / 360.0, span * (high - low) / 360.0
            parts.append(
                f'<rect x="{x:.2f}" y="{foot + BAR + 2.0:.2f}" width="{width:.2f}" height="3" {filled(colour)}/>'
            )
        unit, scale = (
            (" deg", math.degrees(1.0))
            if lobe.lobe.recipe.cam.arrangement.unit == "deg"
            else (f" {UNIT_NAMES[recipe.units]}", 1.0 / recipe.mm)
        )
        name = f"{lobe.lobe.name}: lift 0 to {scale * float(np.ptp(lift)):.4g}{unit}"
        parts.append(text(LEFT, top + NAME - 4.0, name))
    return sheet(base + 40.0, f"{recipe.name}: timing", parts)


def _bar(stretch: Stretch, y: float, colour: str, name: str) -> list[str]:
    """The bar of a stretch, in two where it passes 360 degrees, each with as much of its label as it has room for."""
    span, parts = WIDTH - LEFT - RIGHT, []
    span_words = f"{round(stretch.begin, 3):.4g}–{round(_end(stretch.end), 3):.4g}"
    label = f"{stretch.phase} {span_words}"
    for low, high in _split(stretch.begin, stretch.end):
        x, width = LEFT + span * low / 360.0, span * (high - low) / 360.0
        parts.append(
            f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{BAR:g}" '
            f"{both(colour, SHADES[stretch.phase])}>"
            f"<title>{one_line(name)}: {label} degrees</title></rect>"
        )
        words = next((words for words in (label, span_words) if LETTER * len(words) + 6.0 <= width), "")
        if words:
            parts.append(text(x + 0.5 * width, y + BAR - 4.5, words, size=10.5, anchor="middle"))
    return parts


def _end(degrees: float) -> float:
    """The end of a stretch as a reading of the shaft: 360 stays."""
    return degrees if degrees <= 360.0 else degrees - 360.0


def _split(begin: float, end: float) -> list[tuple[float, float]]:
    """A stretch of degrees, in two where it passes 360."""
    return [(begin, end)] if end <= 360.0 else [(begin, 360.0), (0.0, end - 360.0)]
