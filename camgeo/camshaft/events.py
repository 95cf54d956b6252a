"""When lobes lift: crossings of a lift, lobe centres, and an engine's valve events.

A lobe's centre is the middle between the two crossings of a lift, never its peak; events are told in crank degrees,
twice the camshaft's.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from camgeo.cams.position import Position

TURN = 2.0 * math.pi
CRANK = 720.0  # degrees of one turn of the camshaft
LOOKS = 3600  # shaft angles at which crossings are looked for
STEPS = 60  # of bisection, to rounding


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


def crossings(motion: Position, lift: float) -> tuple[float, float] | None:
    """Shaft angles, rad, at which a follower passes a lift on its rise and then on its return.

    None where it does not do so exactly once each; both are in [0, 2 turns), the return after the rise.
    """
    angle = np.arange(LOOKS) * TURN / LOOKS
    above = motion.rows(angle, 0)[0] > lift
    rises, falls = np.flatnonzero(~above & np.roll(above, -1)), np.flatnonzero(above & ~np.roll(above, -1))
    if len(rises) != 1 or len(falls) != 1:
        return None
    step = TURN / LOOKS
    up = _settled(motion, lift, float(angle[rises[0]]), step, sign=1.0)
    down = _settled(motion, lift, float(angle[falls[0]]), step, sign=-1.0)
    return up, down if down > up else down + TURN


def _settled(motion: Position, lift: float, low: float, step: float, *, sign: float) -> float:
    """Bisect for the place where a rising (sign 1) or falling follower passes the lift."""
    high = low + step
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        value = float(motion.rows(np.array([middle % TURN]), 0)[0, 0])
        if sign * (value - lift) > 0.0:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def centre(motion: Position, lift: float) -> float | None:
    """Shaft angle, rad, midway between the two crossings of a lift; None where there are not two."""
    ends = crossings(motion, lift)
    return None if ends is None else 0.5 * sum(ends)


def event(motion: Position, at: float, lift: float) -> Event | None:
    """When a lobe turned by `at`, rad, lifts its follower beyond a lift; None where it does not do so once a turn."""
    ends = crossings(motion, lift)
    if ends is None:
        return None
    opens, closes = (math.degrees(end + at) for end in ends)
    middle = 0.5 * (opens + closes)
    return Event(opens % 360.0, closes % 360.0, middle % 360.0, closes - opens)


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
