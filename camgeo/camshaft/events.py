"""When lobes lift: crossings of a lift, lobe centres, and an engine's valve events.

A lobe's centre is the middle between the two crossings of a lift, never its peak; events are told in crank degrees,
twice the camshaft's.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from camgeo.measures.lobe import EventError, event_of

if TYPE_CHECKING:
    from camgeo.cams.family import ExactCam

CRANK = 720.0  # degrees of one turn of the camshaft


class Event(NamedTuple):
    """When a lobe lifts its follower beyond a lift: shaft angles, degrees from 0 to below 360, and how long."""

    opens: float
    closes: float
    centre: float
    duration: float  # of the shaft


class Valves(NamedTuple):
    """An engine's events at a lift, crank degrees before or after dead centre; the lobes' separation in cam degrees."""

    intake_opens: float
    intake_closes: float
    exhaust_opens: float
    exhaust_closes: float
    overlap: float
    separation: float


def event(exact: ExactCam, zero: float, lift: float) -> Event | None:
    """When a lobe whose motion begins at `zero`, rad, is beyond a lift; None where it is not just once a turn."""
    try:
        crossed = event_of(exact, lift)
    except EventError:
        return None
    opens, closes = (math.degrees(angle + zero) for angle in (crossed.opening, crossed.closing))
    return Event(opens % 360.0, closes % 360.0, 0.5 * (opens + closes) % 360.0, closes - opens)


def valves_of(intake: Event, exhaust: Event, fires: float) -> Valves:
    """Events of a cylinder that fires at a crank angle, degrees, by those of its two lobes."""
    # crank degrees after the cylinder's own firing dead centre; 360 is the dead centre of the overlap
    opens, closes = _crank(intake.opens, fires), _crank(intake.closes, fires)
    opened, closed = _crank(exhaust.opens, fires), _crank(exhaust.closes, fires)
    after = _crank(intake.centre, fires) - 360.0
    before = 360.0 - _crank(exhaust.centre, fires)
    return Valves(
        _signed(360.0 - opens),
        _signed(closes - 540.0),
        _signed(180.0 - opened),
        _signed(closed - 360.0),
        _signed(closed - opens),
        0.5 * (after + before),
    )


def _crank(cam: float, fires: float) -> float:
    """Crank degrees in [0, 720) after a firing dead centre at which the camshaft stands at an angle, degrees."""
    return (2.0 * cam - fires) % CRANK


def _signed(crank: float) -> float:
    """The same angle from -360 to below 360."""
    return (crank + 360.0) % CRANK - 360.0
