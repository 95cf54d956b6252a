"""The valve in the report and on the page: its lift, events, velocity and acceleration."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.capabilities.valve.figures import SEATING
from camgeo.capabilities.valve.measure import EVENTS, extremes, greatest_lift, measure_at, valve_event
from camgeo.capabilities.valve.train import ORDER, valve_of
from camgeo.measures.lobe import EventError, event_of
from camgeo.report.page.curves import per
from camgeo.report.page.followers import SHAFT
from camgeo.report.page.tables import html_table, number
from camgeo.report.plot import Plot, Series
from kin.numeric.angles import TURN, degrees

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.valve.train import Valve
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

TAPPET = {"in": (0.006, 0.05, 0.2), "mm": (0.1, 1.0)}  # usual lifts of the tappet at which cards give durations
TITLES = ("Valve lift", "Valve velocity", "Valve acceleration")


def section(recipe: Recipe, design: Design) -> dict[str, Any] | None:
    """Section `valve` of the report; None without a valve.

    Lift and lash are in the recipe's unit, events in degrees of the cam, durations in degrees of the crank, peaks by
    rad of the cam. Raises RecipeErrors for a table of ratios that does not fit the tappet's lift (`valve_of`),
    EventError for a motion too rough to follow.
    """
    valve = valve_of(recipe, design)
    if valve is None:
        return None
    unit, mm = "in" if recipe.units == "inch" else "mm", recipe.mm
    lifts = dict.fromkeys([0.0, EVENTS, *(limit.lift for limit in recipe.limits if limit.figure == "valve-duration")])
    entry: dict[str, Any] = {
        "ratio": valve.ratios[0][1] if len(valve.ratios) == 1 else [[x / mm, ratio] for x, ratio in valve.ratios],
        "lash": valve.lash / mm,
        "lift": greatest_lift(valve, design) / mm,
        "unit": unit,
        "events": [_event(valve, design, lift, mm) for lift in lifts],
        "tappet": [_tappet_event(design, lift, mm) for lift in TAPPET[unit]],
    }
    seating = measure_at(recipe, design, SEATING, 0.0)
    if seating.value is not None:
        entry["seating"] = {"value": seating.value / mm, "unit": f"{unit}/deg", "at_deg": seating.at_deg}
    try:
        peaks = extremes(valve, design)
    except EventError:
        return entry
    for k, (name, power) in enumerate((("velocity", "/rad"), ("acceleration", "/rad^2")), 1):
        entry[name] = {"max": peaks[k].value / mm, "unit": unit + power, "at_deg": peaks[k].at_deg}
    return entry


def _tappet_event(design: Design, lift: float, mm: float) -> dict[str, Any]:
    """Report entry of a lift of the tappet, in the recipe's unit of `mm` mm: its duration, crank degrees, and centre.

    Both are None where the tappet does not cross the lift just twice.
    """
    try:
        event = event_of(design.exact, lift * mm)
    except EventError:
        return {"lift": lift, "duration_crank_deg": None, "centre_deg": None}
    return {"lift": lift, "duration_crank_deg": event.duration, "centre_deg": event.centre}


def _event(valve: Valve, design: Design, lift: float, mm: float) -> dict[str, Any]:
    """Report entry of a lift: opening, closing and centre, cam degrees, and duration, crank degrees.

    All are None where the valve does not cross the lift just twice. `mm` is the recipe's unit.
    """
    lifts: dict[str, Any] = {"lift": lift / mm, "tappet_lift": valve.follower_lift(lift) / mm}
    try:
        event = valve_event(valve, design, lift)
    except EventError:
        return {**lifts, "opens_deg": None, "closes_deg": None, "centre_deg": None, "duration_crank_deg": None}
    opens, closes = (degrees(angle % TURN) for angle in (event.opening, event.closing))
    return {
        **lifts,
        "opens_deg": opens,
        "closes_deg": closes,
        "centre_deg": event.centre,
        "duration_crank_deg": event.duration,
    }


def panel(report: dict[str, Any]) -> str:
    """HTML section of the page on the valve, empty where the report has no valve."""
    entry = report.get("valve")
    if entry is None:
        return ""
    unit = entry["unit"]
    ratio = number(entry["ratio"]) if isinstance(entry["ratio"], float) else "by a table"
    text = f"Lift {number(entry['lift'])} {unit}, at a ratio {ratio} and a lash of {number(entry['lash'])} {unit}."
    peaks = [
        f"greatest {name} {number(entry[name]['max'])} {entry[name]['unit']} at {number(entry[name]['at_deg'])}°"
        for name in ("velocity", "acceleration")
        if name in entry
    ]
    cells = [
        [number(row[key]) for key in ("lift", "tappet_lift", "opens_deg", "closes_deg", "duration_crank_deg")]
        for row in entry["events"]
    ]
    rows = ["<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in cells]
    heads = (f"valve lift, {unit}", f"tappet lift, {unit}", "opens, cam °", "closes, cam °", "duration, crank °")
    text += f" While it is open: {', '.join(peaks)}." if peaks else ""
    durations = [
        f"{number(row['duration_crank_deg'])} crank degrees at {number(row['lift'])} {unit}"
        for row in entry["tappet"]
        if row["duration_crank_deg"] is not None
    ]
    text += f" The tappet is lifted for {', '.join(durations)}." if durations else ""
    table = html_table("Valve events", heads, rows)
    return f'<section aria-labelledby="valve-head"><h2 id="valve-head">Valve</h2><p>{text}</p>{table}</section>'


def plots(recipe: Recipe, design: Design) -> Sequence[Plot]:
    """Plots of lift, velocity and acceleration of the valve over the turn, in the recipe's unit.

    Derivatives are by radian of the cam, or by second where the recipe gives the shaft's speed. Empty without a valve.
    Raises RecipeErrors for a table of ratios that does not fit the tappet's lift (`valve_of`), EventError for a table
    with a motion too rough to follow.
    """
    valve = valve_of(recipe, design)
    if valve is None:
        return ()
    rows = valve.rows(design.motion.rows(SHAFT, ORDER)) / recipe.mm
    unit, drawn = "in" if recipe.units == "inch" else "mm", []
    for order, title in enumerate(TITLES):
        factor, power, note = per(recipe, order) if order else (1.0, "", "")
        series = (Series(title.lower(), factor * rows[order]),)
        drawn.append(Plot(title, unit + power, series, note=note, axis=title.split()[1], holds=(0.0,)))
    return drawn
