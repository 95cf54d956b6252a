"""Entries of a report for kin's verdicts on the flanks of a file, for kinds of cams with recipes of their own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from camgeo.measures.units import in_units

if TYPE_CHECKING:
    from camgeo.recipe.recipe import Order
    from kin.law.motion_error import MotionError, Play
    from kin.turned.verdict import TurnedVerdict


def error_entry(
    recipe: Order, measured_error: float | None, motion: MotionError | None, at_unit: str
) -> dict[str, Any]:
    """Entry for a flank whose contour is off by `measured_error`, mm; places of its motion are in `at_unit`."""
    off = None if measured_error is None else measured_error / recipe.mm
    if motion is None:
        return {"measured_error": off, "motion": None}
    entry: dict[str, Any] = {}
    for key in ("max", "least", "most", "rms", "remainder"):
        entry[key], unit = in_units(recipe, getattr(motion, key), motion.unit)
    at, at_unit = in_units(recipe, motion.at, at_unit)
    entry |= {"unit": unit, "at": at, "at_unit": at_unit, "extremes": motion.extremes}
    return {"measured_error": off, "motion": entry}


def play_entry(recipe: Order, play: Play | None, at_unit: str) -> dict[str, Any]:
    """Entry `play` for that between a lower and an upper flank, with places in `at_unit`; none without play."""
    if play is None:
        return {}
    (least, unit), (most, _) = in_units(recipe, play.least, play.unit), in_units(recipe, play.most, play.unit)
    min_at, max_at = (in_units(recipe, at, at_unit)[0] for at in (play.least_at, play.most_at))
    places = {"min_at": min_at, "max_at": max_at}
    return {"play": [{"between": ["lower", "upper"], "min": least, "max": most, "unit": unit, **places}]}


def turned_rows(recipe: Order, verdict: TurnedVerdict, *, named: bool = False) -> dict[str, Any]:
    """Entries of a file of a turning body: what was measured on each of its flanks, and the play between two.

    A single flank stands without its name, unless flanks are `named`.
    """
    rows = [
        {"name": flank.name, **error_entry(recipe, flank.measured_error, flank.motion, "deg")}
        for flank in verdict.flanks
    ]
    entry: dict[str, Any] = {"surfaces": rows} if rows else {}
    if len(rows) == 1 and not named:
        entry = {key: value for key, value in rows[0].items() if key != "name"}
    return entry | play_entry(recipe, verdict.play, "deg")
