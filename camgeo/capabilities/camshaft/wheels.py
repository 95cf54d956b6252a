"""Degree wheels of an engine: one turn of the camshaft with all its lobes, one turn of the crank for a cylinder."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.camshaft.diagram import WIDTH, arc, drawn, kind, line, on_wheel, sheet, text
from camgeo.capabilities.camshaft.events import DEAD_CENTRES, crank_after, event_words, signed
from camgeo.capabilities.camshaft.tables import event_lift
from camgeo.measures.units import UNIT_NAMES

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.capabilities.camshaft.events import Event
    from camgeo.capabilities.camshaft.keys import CamshaftRecipe, Engine
    from camgeo.capabilities.camshaft.lobes import PlacedLobe

RING = 14.0  # px of a lobe's ring: the least that shows the number of its cylinder
INNER = 60.0  # px: radius within the rings
ROW = 17.0  # px of a line of words
APART = 14.0  # px between the words of two events on one side
OUTER, RIM = 138.0, 150.0  # px of the crank's wheel: the outer ring's middle, and the scale


def opened(lobes: Sequence[PlacedLobe], engine: Engine) -> dict[int, dict[str, Event]]:
    """Return the events of each cylinder's valves, `intake` before `exhaust`, cylinders in the order of firing."""
    events = {(lobe.lobe.cylinder, lobe.lobe.valve): lobe.event(lobe.event_lift(engine)) for lobe in lobes}
    rows = {
        cylinder: {valve: event for valve in DEAD_CENTRES if (event := events.get((cylinder, valve))) is not None}
        for cylinder in engine.firing
    }
    return {cylinder: row for cylinder, row in rows.items() if row}


def crank_wheels(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], engine: Engine) -> list[str]:
    """Return a wheel of one turn of the crank, 360 degrees, for each cylinder; of cylinders alike one.

    Events are counted from the dead centres of the cylinder itself. Its four strokes are two turns: the exhaust opens
    about the lower dead centre, both valves move about the upper one.
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
    """Return the wheel of cylinders; an event is a valve, and crank degrees at which it opens and for how long."""
    named = f"cylinder{'s' * (len(cylinders) > 1)} {', '.join(map(str, cylinders))}"
    lift = f"{engine.lift / recipe.mm:.4g} {UNIT_NAMES[recipe.units]}{' of the valve' if engine.at_valve else ''}"
    middle = 0.5 * WIDTH, 262.0
    parts = [
        text(14.0, 24.0, f"{recipe.name}: one turn of the crank", size=15.0),
        text(14.0, 42.0, f"{named}: crank degrees, clockwise, at a lift of {lift}"),
        f'<circle cx="{middle[0]:g}" cy="{middle[1]:g}" r="{RIM:g}" {drawn("faint")}/>',
    ]
    for degree in range(0, 360, 10):
        ends = on_wheel(middle, RIM - (6.0 if degree % 30 else 10.0), degree), on_wheel(middle, RIM, degree)
        parts.append(line("faint" if degree % 90 else "ink", *ends[0], *ends[1]))
        if degree % 30 == 0:
            place = on_wheel(middle, 76.0, degree)
            parts.append(text(place[0], place[1] + 3.5, f"{degree}", size=10.0, anchor="middle"))
    parts.append(text(middle[0], middle[1] - RIM - 8.0, "TDC", anchor="middle"))
    parts.append(text(middle[0], middle[1] + RIM + 18.0, "BDC", anchor="middle"))
    labels, inside = [], []
    for rank, (valve, opens, lasts) in enumerate(events):
        radius = OUTER - 24.0 * rank - 10.0
        parts.append(arc(middle, radius, opens % 360.0, lasts, drawn(valve, 16.0)))
        for angle, words in zip((opens, opens + lasts), event_words(valve, opens, lasts), strict=True):
            parts.append(line(valve, *on_wheel(middle, radius - 8.0, angle), *on_wheel(middle, RIM + 8.0, angle)))
            x, y = on_wheel(middle, RIM + 14.0, angle)
            labels.append((y, x, words, valve))
        inside.append((f"{valve} {lasts:.1f}°", valve))
    for right in (False, True):
        last = -math.inf
        for y, x, words, valve in sorted(label for label in labels if (label[1] > middle[0]) == right):
            last = max(y, last + APART)
            parts.append(text(x, last + 4.0, words, size=11.0, anchor="start" if right else "end", colour=valve))
    spans = {valve: (opens, opens + lasts) for valve, opens, lasts in events}
    inside += [(words, "ink") for words in _overlap(spans, 1.0)]
    for row, (words, colour) in enumerate(inside):
        y = middle[1] + ROW * (row - 0.5 * len(inside) + 0.75)
        parts.append(text(middle[0], y, words, size=11.0, anchor="middle", colour=colour))
    return sheet(middle[1] + RIM + 34.0, f"{recipe.name}: valve events of {named} over one turn of the crank", parts)


def cam_wheel(recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], engine: Engine) -> str:
    """Return a wheel of one turn of the camshaft, 360 cam degrees, with a ring for each lobe, and its events below.

    It begins at the firing dead centre of the first cylinder in the order.
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
    for rank, lobe in enumerate(lobes):
        radius, name = outer - step * (rank + 0.5), kind(lobe.lobe.valve)
        parts.append(f'<circle cx="{middle[0]:g}" cy="{middle[1]:g}" r="{radius:.2f}" {drawn("faint")}/>')
        event = lobe.event(event_lift(recipe, lobe))
        if event is None:
            continue
        parts.append(arc(middle, radius, event.opens, event.duration, drawn(name, min(0.78 * step, 14.0))))
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
        open_at = {valve: (2.0 * event.opens, 2.0 * event.closes) for valve, event in events.items()}
        cells = [f"{cylinder}", *spans, *_overlap(open_at, 0.5)]
        parts += [text(x, y, words, size=11.0) for x, words in zip(columns, cells, strict=False)]
    for lobe in lobes:
        event = lobe.event(event_lift(recipe, lobe))
        if lobe.lobe.cylinder is None and event is not None:
            y += ROW
            words = f"{lobe.lobe.name}: {_span(event)}"
            parts += [text(14.0, y, words, size=11.0, colour="other")]
    return sheet(y + 16.0, f"{recipe.name}: valve timing over one turn of the camshaft", parts, side)


def _span(event: Event) -> str:
    return f"{event.opens:.1f}–{event.closes:.1f}° ({event.duration:.1f}°)"


def _overlap(spans: Mapping[str, tuple[float, float]], scale: float) -> list[str]:
    """Say for how long both valves are open, by where each opens and closes, crank degrees; nothing of one alone.

    `scale` is how many of the shown degrees one of the crank is. Below 0 neither is open for so long.
    """
    if len(spans) < len(DEAD_CENTRES):
        return []
    long = scale * signed(spans["exhaust"][1] - spans["intake"][0])
    return [f"overlap {long:.1f}°".replace("-", "−")]
