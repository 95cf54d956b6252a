"""When lobes lift, drawn: curves and bars over the shaft's angle, and an engine's degree wheels; SVG.

A wheel shows one turn of the camshaft with all its lobes, or one turn of the crank for a cylinder.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.camshaft.drawing import shaft_drawing
from camgeo.capabilities.camshaft.events import DEAD_CENTRES, crank_after, event_words, signed
from camgeo.capabilities.camshaft.lobes import lifts
from camgeo.capabilities.camshaft.svg import (
    LETTER,
    WIDTH,
    arc,
    colour_of,
    edged,
    filled,
    line,
    on_wheel,
    sheet,
    stacked,
    stroked,
    text,
)
from camgeo.files.markup import one_line
from camgeo.measures.units import UNIT_NAMES, report_unit

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.capabilities.camshaft.events import Event, Phase, Stretch
    from camgeo.capabilities.camshaft.keys import CamshaftRecipe, Engine
    from camgeo.capabilities.camshaft.lobes import PlacedLobe

SHADES: dict[Phase, float] = {"rise": 0.55, "dwell": 0.08, "return": 0.3}
TOP, LEFT, RIGHT = 44.0, 16.0, 18.0  # px about the rows of lobes
LOBE, NAME, CURVE, BAR = 68.0, 18.0, 26.0, 16.0  # of a lobe: its row, in it its name, its curve and its bars
RING = 14.0  # px of a lobe's ring: the least that shows the number of its cylinder
INNER = 60.0  # px: radius within the rings
ROW = 17.0  # px of a line of words
APART = 14.0  # px between the words of two events on one side
OUTER, RIM = 138.0, 150.0  # px of the crank's wheel: the outer ring's middle, and the scale


def diagram(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], form: str | None) -> str:
    """Return the SVG of a form: `timing`, `bars`, `cam-wheel`, `crank-wheel` or `shaft`.

    `timing`, or None, is the wheel of the camshaft's turn for an engine, and bars for other shafts; wheels are of
    engines alone, and other shafts have bars in their place.
    """
    engine = recipe.engine
    if form == "shaft":
        return shaft_drawing(recipe, lobes)
    if form == "bars" or engine is None:
        return bars(recipe, lobes)
    return stacked(crank_wheels(recipe, lobes, engine)) if form == "crank-wheel" else cam_wheel(recipe, lobes, engine)


def page_diagrams(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> list[str]:
    """Return the diagrams of a page: of an engine its wheels first, then bars and the drawing of the shaft."""
    engine = recipe.engine
    wheels = [] if engine is None else [*crank_wheels(recipe, lobes, engine), cam_wheel(recipe, lobes, engine)]
    return [*wheels, bars(recipe, lobes), shaft_drawing(recipe, lobes)]


# --- over the shaft's angle -------------------------------------------------------------------------------------------


def bars(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe]) -> str:
    """Return an SVG, a row for each lobe: its lift over the shaft's angle, a bar for each rise, dwell and return.

    A bar that passes 360 degrees is split there. For an engine a line shows where the lobe is beyond the lift of
    events.
    """
    span, base = WIDTH - LEFT - RIGHT, TOP + LOBE * len(lobes)
    parts = [text(LEFT, 24.0, f"{recipe.name}: lifts over the shaft's angle", size=15.0)]
    for degree in range(0, 361, 30):
        x = LEFT + span * degree / 360.0
        parts.append(line("faint", x, TOP - 4.0, x, base))
        parts.append(text(x, base + 15.0, f"{degree}", size=11.0, anchor="middle"))
    parts.append(text(LEFT + 0.5 * span, base + 31.0, "shaft angle, degrees of the cam", anchor="middle"))
    # each row: the name, the lift as an area, bars of the phases, and a line for the event
    angle = np.arange(0.0, 360.5, 0.5)
    for number, (lobe, lift) in enumerate(zip(lobes, lifts(lobes, np.radians(angle)), strict=True)):
        top = TOP + LOBE * number
        foot = top + NAME + CURVE
        share = (lift - lift.min()) / max(float(np.ptp(lift)), 1e-12)
        points = " ".join(
            f"{LEFT + span * a / 360.0:.2f},{foot - (CURVE - 2.0) * v:.2f}"
            for a, v in zip(angle.tolist(), share.tolist(), strict=True)
        )
        colour, look = colour_of(lobe.lobe.valve), edged(colour_of(lobe.lobe.valve), 0.25, 1.5)
        parts.append(f'<polygon points="{LEFT:.2f},{foot:.2f} {points} {LEFT + span:.2f},{foot:.2f}" {look}/>')
        for stretch in lobe.stretches:
            parts += _bar(stretch, foot, colour, lobe.lobe.name)
        event = lobe.event(lobe.event_lift(recipe.engine)) if recipe.engine is not None else None
        for low, high in [] if event is None else _split(event.opens, event.opens + event.duration):
            x, width = LEFT + span * low / 360.0, span * (high - low) / 360.0
            parts.append(
                f'<rect x="{x:.2f}" y="{foot + BAR + 2.0:.2f}" width="{width:.2f}" height="3" {filled(colour)}/>'
            )
        scale, unit = report_unit(recipe, lobe.lobe.recipe.cam.arrangement.unit)
        name = f"{lobe.lobe.name}: lift 0 to {scale * float(np.ptp(lift)):.4g} {unit}"
        parts.append(text(LEFT, top + NAME - 4.0, name))
    return sheet(base + 40.0, f"{recipe.name}: timing", parts)


def _bar(stretch: Stretch, y: float, colour: str, name: str) -> list[str]:
    """The bar of a stretch, in two where it passes 360 degrees, each with as much of its label as fits."""
    span, parts = WIDTH - LEFT - RIGHT, []
    span_words = f"{round(stretch.begin, 3):.4g}–{round(_end(stretch.end), 3):.4g}"
    label = f"{stretch.phase} {span_words}"
    for low, high in _split(stretch.begin, stretch.end):
        x, width = LEFT + span * low / 360.0, span * (high - low) / 360.0
        parts.append(
            f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{BAR:g}" '
            f"{edged(colour, SHADES[stretch.phase])}>"
            f"<title>{one_line(name)}: {label} degrees</title></rect>"
        )
        words = next((words for words in (label, span_words) if LETTER * len(words) + 6.0 <= width), "")
        if words:
            parts.append(text(x + 0.5 * width, y + BAR - 4.5, words, size=10.5, anchor="middle"))
    return parts


def _end(degrees: float) -> float:
    """The end of a stretch, degrees up to 720, as a shaft angle up to 360, where 360 stays."""
    return degrees if degrees <= 360.0 else degrees - 360.0


def _split(begin: float, end: float) -> list[tuple[float, float]]:
    """A stretch of degrees, in two where it passes 360."""
    return [(begin, end)] if end <= 360.0 else [(begin, 360.0), (0.0, end - 360.0)]


# --- wheels -----------------------------------------------------------------------------------------------------------


def opened(lobes: Sequence[PlacedLobe], engine: Engine) -> dict[int, dict[str, Event]]:
    """Return the events by cylinder and valve, `intake` before `exhaust`, cylinders in the order of firing.

    A lobe that does not pass its event lift in one stretch is left out, as is a cylinder without events. Raises
    RecipeErrors and EventError as `PlacedLobe.event_lift` does.
    """
    events = {(lobe.lobe.cylinder, lobe.lobe.valve): lobe.event(lobe.event_lift(engine)) for lobe in lobes}
    rows = {
        cylinder: {valve: event for valve in DEAD_CENTRES if (event := events.get((cylinder, valve))) is not None}
        for cylinder in engine.firing
    }
    return {cylinder: row for cylinder, row in rows.items() if row}


def crank_wheels(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], engine: Engine) -> list[str]:
    """Return an SVG for each cylinder that has events: a wheel of one turn of the crank; cylinders alike share one.

    Events are counted from the dead centres of the cylinder itself. Its four strokes are two turns: the exhaust opens
    about the lower dead centre, both valves move about the upper one. Raises RecipeErrors and EventError as
    `PlacedLobe.event_lift` does.
    """
    alike: dict[tuple[tuple[str, float, float], ...], list[int]] = {}
    for cylinder, events in opened(lobes, engine).items():
        fires = math.degrees(engine.firing[cylinder])
        own = ((valve, crank_after(event.opens, fires), 2.0 * event.duration) for valve, event in events.items())
        key = tuple((valve, round(opens, 6), round(lasts, 6)) for valve, opens, lasts in own)
        alike.setdefault(key, []).append(cylinder)
    return [_crank_wheel(recipe, engine, own, cylinders) for own, cylinders in alike.items()]


def _crank_wheel(
    recipe: CamshaftRecipe, engine: Engine, events: Sequence[tuple[str, float, float]], cylinders: Sequence[int]
) -> str:
    """Return the wheel of cylinders alike; an event is (valve, opening, duration), crank degrees."""
    named = f"cylinder{'s' * (len(cylinders) > 1)} {', '.join(map(str, cylinders))}"
    lift = f"{engine.lift / recipe.mm:.4g} {UNIT_NAMES[recipe.units]}{' of the valve' if engine.at_valve else ''}"
    middle = 0.5 * WIDTH, 262.0
    parts = [
        text(14.0, 24.0, f"{recipe.name}: one turn of the crank", size=15.0),
        text(14.0, 42.0, f"{named}: crank degrees, clockwise, at a lift of {lift}"),
        f'<circle cx="{middle[0]:g}" cy="{middle[1]:g}" r="{RIM:g}" {stroked("faint")}/>',
    ]
    for degree in range(0, 360, 10):
        ends = on_wheel(middle, RIM - (6.0 if degree % 30 else 10.0), degree), on_wheel(middle, RIM, degree)
        parts.append(line("faint" if degree % 90 else "ink", *ends[0], *ends[1]))
        if degree % 30 == 0:
            place, words = on_wheel(middle, 76.0, degree), {0: "TDC", 180: "BDC"}.get(degree, f"{degree}")
            parts.append(text(place[0], place[1] + 3.5, words, size=10.0, anchor="middle"))
    # an arc for each valve, its opening and closing labelled outside the rim, its duration in the middle
    labels, inside = [], []
    for rank, (valve, opens, lasts) in enumerate(events):
        radius = OUTER - 24.0 * rank - 10.0
        parts.append(arc(middle, radius, opens % 360.0, lasts, stroked(valve, 16.0)))
        for angle, words in zip((opens, opens + lasts), event_words(valve, opens, lasts), strict=True):
            parts.append(line(valve, *on_wheel(middle, radius - 8.0, angle), *on_wheel(middle, RIM + 8.0, angle)))
            x, y = on_wheel(middle, RIM + 14.0, angle)
            labels.append((y, x, words, valve))
        inside.append((f"{valve} {lasts:.1f}°", valve))
    lowest = middle[1] + RIM
    for right in (False, True):
        side = [label for label in labels if (label[1] > middle[0]) == right]
        for y, (_, x, words, valve) in zip(_apart([label[0] for label in side], middle[1]), side, strict=True):
            parts.append(text(x, y + 4.0, words, size=11.0, anchor="start" if right else "end", colour=valve))
            lowest = max(lowest, y)
    spans = {valve: (opens, opens + lasts) for valve, opens, lasts in events}
    inside += [(words, "ink") for words in _overlap(spans, 1.0)]  # in crank degrees, as all of this wheel
    for row, (words, colour) in enumerate(inside):
        y = middle[1] + ROW * (row - 0.5 * len(inside) + 0.75)
        parts.append(text(middle[0], y, words, size=11.0, anchor="middle", colour=colour))
    return sheet(lowest + 34.0, f"{recipe.name}: valve events of {named} over one turn of the crank", parts)


def _apart(heights: Sequence[float], middle: float) -> list[float]:
    """Heights of labels beside a wheel, px, moved from its middle so that none covers another, nor the rim."""
    moved = list(heights)
    order = sorted(range(len(moved)), key=heights.__getitem__)
    upper = [k for k in order if heights[k] < middle]
    last = math.inf
    for k in reversed(upper):
        last = moved[k] = min(heights[k], last - APART)
    last = max((moved[k] for k in upper), default=-math.inf)
    for k in order[len(upper) :]:
        last = moved[k] = max(heights[k], last + APART)
    return moved


def cam_wheel(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], engine: Engine) -> str:
    """Return an SVG wheel of one turn of the camshaft, 360 degrees, with a ring for each lobe, and its events below.

    It begins at the firing dead centre of the first cylinder in the order. Raises RecipeErrors and EventError as
    `PlacedLobe.event_lift` does.
    """
    outer = INNER + max(100.0, RING * len(lobes))
    step, side = (outer - INNER) / len(lobes), max(WIDTH, 2.0 * (outer + 60.0))
    middle = 0.5 * side, outer + 92.0
    first = next(iter(engine.firing))
    parts = [
        text(14.0, 24.0, f"{recipe.name}: one turn of the camshaft", size=15.0),
        text(14.0, 42.0, f"cam degrees after the firing dead centre of cylinder {first}"),
    ]
    for degree in range(0, 360, 15):
        strong = degree % 90 == 0
        ends = on_wheel(middle, INNER, degree), on_wheel(middle, outer + 6.0, degree)
        parts.append(line("ink" if strong else "faint", *ends[0], *ends[1]))
        x, y = on_wheel(middle, outer + 20.0, degree)
        anchor = "middle" if abs(x - middle[0]) < 30.0 else "start" if x > middle[0] else "end"
        if degree % 30 == 0:
            parts.append(text(x, y + 4.0, f"{degree}", size=11.0, anchor=anchor))
    # a ring for each lobe, with an arc where it is beyond the lift of events
    for rank, lobe in enumerate(lobes):
        radius, name = outer - step * (rank + 0.5), colour_of(lobe.lobe.valve)
        parts.append(f'<circle cx="{middle[0]:g}" cy="{middle[1]:g}" r="{radius:.2f}" {stroked("faint")}/>')
        event = lobe.event(lobe.event_lift(recipe.engine))
        if event is None:
            continue
        parts.append(arc(middle, radius, event.opens, event.duration, stroked(name, min(0.78 * step, 14.0))))
        if lobe.lobe.cylinder is not None:
            x, y = on_wheel(middle, radius, event.opens + 0.5 * event.duration)
            size = min(11.0, 0.6 * step)
            parts.append(text(x, y + 0.36 * size, f"{lobe.lobe.cylinder}", size=size, anchor="middle", colour="ground"))
    return _listed(recipe, lobes, engine, parts, (side, middle[1] + outer + 50.0))


def _listed(
    recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], engine: Engine, parts: list[str], foot: tuple[float, float]
) -> str:
    """Return the wheel of the SVG `parts` with a row of events below it for each cylinder, and for each other lobe.

    `foot` is the wheel's width and the height from which the rows start, px.
    """
    side, y = foot
    columns = [14.0, 84.0, 232.0, 380.0]
    heads = zip(columns, ("cylinder", "intake", "exhaust"), ("ink", "intake", "exhaust"), strict=False)
    parts += [text(x, y, words, size=11.0, colour=colour) for x, words, colour in heads]
    for cylinder, events in opened(lobes, engine).items():
        y += ROW
        spans = [_span(events[valve]) if valve in events else "" for valve in DEAD_CENTRES]
        # in crank degrees; the overlap is shown in the camshaft's, half as many
        open_at = {valve: (2.0 * event.opens, 2.0 * event.closes) for valve, event in events.items()}
        cells = [f"{cylinder}", *spans, *_overlap(open_at, 0.5)]
        parts += [text(x, y, words, size=11.0) for x, words in zip(columns, cells, strict=False)]
    for lobe in lobes:
        event = lobe.event(lobe.event_lift(recipe.engine))
        if lobe.lobe.cylinder is None and event is not None:
            y += ROW
            words = f"{lobe.lobe.name}: {_span(event)}"
            parts += [text(14.0, y, words, size=11.0, colour="other")]
    return sheet(y + 16.0, f"{recipe.name}: valve timing over one turn of the camshaft", parts, side)


def _span(event: Event) -> str:
    return f"{event.opens:.1f}–{event.closes:.1f}° ({event.duration:.1f}°)"


def _overlap(spans: Mapping[str, tuple[float, float]], scale: float) -> list[str]:
    """Words for how long both valves are open, by where each opens and closes, crank degrees; none for one valve alone.

    `scale` is the number of shown degrees per crank degree. Below 0 the overlap is how long neither valve is open.
    """
    if len(spans) < len(DEAD_CENTRES):
        return []
    long = scale * signed(spans["exhaust"][1] - spans["intake"][0])
    return [f"overlap {long:.1f}°".replace("-", "−")]
