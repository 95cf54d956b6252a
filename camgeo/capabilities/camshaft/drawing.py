"""A camshaft drawn: from the side, where lobes and journals stand, and from its upper end, how lobes are turned."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.camshaft.svg import WIDTH, colour_of, edged, line, sheet, stroked, text
from camgeo.measures.units import UNIT_NAMES
from camgeo.report.page.outline import exact

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe
    from kin.numeric.arrays import Array

LEFT, TOP = 34.0, 44.0  # px beside and above the drawing
LETTER = 6.2  # px: width of a letter of 11 px
TALL = 150.0  # px: the most that the shaft's diameter takes
ROUND = 105.0  # px: the radius of the view from the end


def shaft_drawing(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> str:
    """Return both views as an SVG text, to scale, at a shaft angle of 0 and as the recipe turns the shaft.

    From the side z runs to the right and the drawings' x upwards; from the end x runs to the right.
    """
    contours = [_turned(recipe, lobe) for lobe in lobes]
    shaft = recipe.bars[0]
    reach = max(0.5 * max(bar.diameter for bar in recipe.bars), *(float(np.hypot(*c.T).max()) for c in contours))
    scale = min((WIDTH - LEFT - 14.0) / (shaft.high - shaft.low), TALL / (2.0 * reach))
    labels = [(0.5 * (bar.low + bar.high), bar.name, "ink") for bar in recipe.bars[1:]]
    labels += [(0.5 * (lobe.lobe.low + lobe.lobe.high), lobe.lobe.name, colour_of(lobe.lobe.valve)) for lobe in lobes]
    names = LETTER * max(len(name) for _, name, _ in labels) + 8.0
    left = max(LEFT, 0.5 * (WIDTH - scale * (shaft.high - shaft.low)))
    axis = TOP + names + scale * reach
    parts = [text(14.0, 24.0, f"{recipe.name}: the shaft, to scale", size=15.0)]

    def along(z: float) -> float:
        return left + scale * (z - shaft.low)

    def box(low: float, high: float, lower: float, upper: float, look: str) -> str:
        place = f'x="{along(low):.2f}" y="{axis - scale * upper:.2f}" width="{scale * (high - low):.2f}"'
        return f'<rect {place} height="{scale * (upper - lower):.2f}" {look}/>'

    # the view from the side: bars, lobes as wide as their contours, the bore, names above and an axis of z below
    parts += [
        box(bar.low, bar.high, -0.5 * bar.diameter, 0.5 * bar.diameter, edged("ink", 0.12)) for bar in recipe.bars
    ]
    for lobe, contour in zip(lobes, contours, strict=True):
        look = edged(colour_of(lobe.lobe.valve), 0.45)
        parts.append(box(lobe.lobe.low, lobe.lobe.high, contour[:, 0].min(), contour[:, 0].max(), look))
    if recipe.bore is not None:
        ends = (along(shaft.low), along(shaft.high))
        for side in (-0.5, 0.5):
            y = axis + side * scale * recipe.bore
            parts.append(line("ink", ends[0], y, ends[1], y, width=0.8, dashes="5 3"))
    parts.append(line("ink", left - 8.0, axis, along(shaft.high) + 8.0, axis, width=0.8, dashes="12 3 2 3"))
    for z, name, colour in labels:
        x = along(z) + 4.0
        parts.append(text(x, TOP + names - 6.0, name, size=11.0, colour=colour, turned=-90.0))
    foot = axis + scale * reach + 10.0
    unit = UNIT_NAMES[recipe.units]
    for z in _ticks(shaft.low / recipe.mm, shaft.high / recipe.mm):
        x = along(z * recipe.mm)
        parts += [line("ink", x, foot, x, foot + 5.0), text(x, foot + 17.0, f"{z:g}", size=11.0, anchor="middle")]
    parts += [line("ink", along(shaft.low), foot, along(shaft.high), foot)]
    parts.append(text(0.5 * (along(shaft.low) + along(shaft.high)), foot + 33.0, f"z, {unit}", anchor="middle"))
    parts += _from_the_end(recipe, lobes, contours, (0.5 * WIDTH, foot + 66.0 + ROUND), reach)
    return sheet(foot + 66.0 + 2.0 * ROUND + 44.0, f"{recipe.name}: drawing of the shaft", parts)


def _from_the_end(
    recipe: CamshaftRecipe,
    lobes: Sequence[PlacedLobe],
    contours: Sequence[Array],
    middle: tuple[float, float],
    reach: float,
) -> list[str]:
    """Return the lobes one behind another about the shaft's axis, each named once where its nose points."""
    scale, (x, y) = ROUND / reach, middle
    parts = [f'<circle cx="{x:g}" cy="{y:g}" r="{0.5 * scale * recipe.bars[0].diameter:.2f}" {edged("ink", 0.12)}/>']
    noses: dict[int, list[str]] = {}
    for lobe, contour in zip(lobes, contours, strict=True):
        points = " ".join(f"{x + scale * px:.2f},{y - scale * py:.2f}" for px, py in contour.tolist())
        parts.append(f'<polygon points="{points}" {edged(colour_of(lobe.lobe.valve), 0.08, 1.2)}/>')
        nose = contour[int(np.argmax(np.hypot(*contour.T)))]
        short = lobe.lobe.name if lobe.lobe.cylinder is None else f"{lobe.lobe.cylinder} {lobe.lobe.valve}"
        noses.setdefault(round(math.degrees(math.atan2(nose[1], nose[0]))), []).append(short)
    if recipe.bore is not None:
        parts.append(f'<circle cx="{x:g}" cy="{y:g}" r="{0.5 * scale * recipe.bore:.2f}" {stroked("ink")}/>')
    parts += [line("ink", x - 6.0, y, x + 6.0, y, width=0.8), line("ink", x, y - 6.0, x, y + 6.0, width=0.8)]
    for degrees, names in noses.items():
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        anchor = "middle" if abs(c) < 0.3 else "start" if c > 0.0 else "end"
        parts.append(
            text(x + (ROUND + 10.0) * c, y - (ROUND + 14.0) * s + 4.0, ", ".join(names), size=11.0, anchor=anchor)
        )
    turns = "clockwise" if recipe.rotation == "cw" else "counter-clockwise"
    words = f"seen from its upper end at a shaft angle of 0; it turns {turns}"
    parts.append(text(x, y + ROUND + 36.0, words, size=11.0, anchor="middle"))
    return parts


def _turned(recipe: CamshaftRecipe, lobe: PlacedLobe) -> Array:
    """Return the contour of a lobe, mm (n, 2), as it stands on the shaft; the intended one where it cannot be made."""
    surface = lobe.design.only_surface
    ring = exact(surface.surface.curve, whole=True) if surface.contour is None else exact(surface.contour)
    c, s = math.cos(lobe.at), math.sin(lobe.at)
    # every fourth point is enough for a drawing
    points: Array = ring.points[::4] @ np.array([[c, s], [-s, c]])
    return points * (1.0, -1.0) if recipe.rotation == "ccw" else points


def _ticks(low: float, high: float) -> list[float]:
    """Return the tick marks of an axis between two ends: multiples of 1, 2 or 5 times a power of ten, at most nine."""
    rough = (high - low) / 8.0
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(many * power for many in (1.0, 2.0, 5.0, 10.0) if many * power >= 0.999 * rough)
    return [step * k for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]
