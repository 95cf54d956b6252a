"""Values of a valve's figures, in mm and degrees, with their cam angles; lifts are of the valve."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.valve.figures import ACCELERATION, DURATION, FIGURES, LIFT, SEATING, VELOCITY
from camgeo.capabilities.valve.train import ORDER, tappet_lift, valve_of
from camgeo.measures.lobe import SHARE, EventError, event_of
from camgeo.measures.measured import ABRUPT, Measured
from kin.numeric.angles import TURN, degrees
from kin.numeric.monotone import RoughError, between, cells, pieces

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.valve.train import Valve
    from camgeo.measures.lobe import LobeEvent
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array

EVENTS = 1.0  # mm of valve lift, at which events are given beside those of its seat
_UNITS = {LIFT: "mm", DURATION: "deg", VELOCITY: "mm/rad", ACCELERATION: "mm/rad^2", SEATING: "mm/deg"}


class GreatestDerivative(NamedTuple):
    """Greatest magnitude of a derivative while the valve is open, mm/rad or mm/rad^2, and its cam angle, degrees."""

    value: float
    at_deg: float


def valve_event(valve: Valve, design: Design, lift: float) -> LobeEvent:
    """Stretch of a turn in which the valve is above a lift, mm: opening and closing as shaft angles, rad.

    The `lift` of the result is the tappet's there, mm. Raises EventError unless the valve crosses that lift once upward
    and once downward, and for a motion too rough to follow.
    """
    most = greatest_lift(valve, design)
    if lift > most or most == 0.0:
        lifted = f"lifts {most:.6g} mm" if most else f"never opens with a lash of {valve.lash:.6g} mm"
        raise EventError(f"the valve {lifted}, and is not above {lift:.6g} mm")
    return event_of(design.exact, valve.follower_lift(lift))


def extremes(valve: Valve, design: Design) -> dict[int, GreatestDerivative]:
    """Greatest magnitudes while the valve is open: under 1 the velocity, mm/rad of the cam, under 2 the acceleration.

    Raises EventError unless the valve opens and closes once in a turn, and for a motion too abrupt to be followed.
    """
    event, exact = valve_event(valve, design, 0.0), design.exact
    # position of the tappet at lift 0: `event.lift` is its lift where the valve opens
    datum = float(exact.motion.by_parameter(np.array([event.opening % TURN]), 0)[0, 0]) - event.lift

    def rows(t: Array) -> Array:
        tappet = exact.motion.by_parameter(np.mod(t, TURN), ORDER)
        tappet[0] -= datum
        travel = valve.travel(tappet[0])
        return np.array([travel[1] * tappet[1], travel[2] * tappet[1] ** 2 + travel[1] * tappet[2]])

    breaks = [at + turns * TURN for at in exact.breaks.tolist() for turns in (0.0, 1.0)]
    try:
        followed = cells(rows, between(event.opening, event.closing, breaks), share=SHARE)
    except RoughError as error:
        raise EventError(ABRUPT) from error
    # row k - 1 of `rows` is derivative k of the valve's lift by the cam angle
    peaks = {}
    for k in (1, 2):
        row = pieces(followed, k - 1)
        value, at = max(row.least(), row.greatest(), key=lambda place: abs(place[0]))
        peaks[k] = GreatestDerivative(abs(value), degrees(at % TURN))
    return peaks


def measure_at(recipe: Recipe, design: Design, name: str, lift: float) -> Measured:
    """Duration, crank degrees, or else seating velocity, mm per degree of the cam, at a lift of the valve, mm.

    The seating velocity is the greater of those with which the valve leaves that lift and comes back to it. The value
    is None where the recipe has no valve, or the valve does not cross the lift just twice.
    """
    valve = valve_of(recipe, design)
    if valve is None:
        return Measured(None, _UNITS[name], detail="valve is not given")
    try:
        event = valve_event(valve, design, lift)
    except EventError as error:
        return Measured(None, _UNITS[name], detail=str(error))
    if name == DURATION:
        return Measured(event.duration, "deg", degrees(event.opening % TURN))
    opening, closing = np.array([event.opening % TURN]), np.array([event.closing % TURN])
    motion, slope = design.exact.motion, valve.travel(np.array([valve.follower_lift(lift)]))[1, 0]
    # velocity of the tappet, mm/rad: after the opening, and before the closing
    tappet = motion.rows(opening, 1, 1)[1, 0], motion.rows(closing, 1, -1)[1, 0]
    # event[1:] are the angles of opening and closing
    rate, at = max((abs(float(slope * rate)), at) for rate, at in zip(tappet, event[1:], strict=True))
    return Measured(math.radians(rate), "mm/deg", degrees(at % TURN))


def measure(recipe: Recipe, design: Design, names: Sequence[str]) -> dict[str, Measured]:
    """Measure the figures `names` of a valve, by name; a value is None where the figure does not exist.

    A figure at a lift is measured at the lift of the recipe's first limit on it, else at its usual lift. Raises
    RecipeErrors for a table of ratios that does not fit the tappet's lift (`valve_of`), and EventError for a motion too
    rough to follow where the greatest lift is measured or the ratio has a table.
    """
    valve, figures = valve_of(recipe, design), dict[str, Measured]()
    for name in names:
        usual = FIGURES[name].at_lift
        if usual is not None:
            lift = next((limit.lift for limit in recipe.limits if limit.figure == name), usual)
            figures[name] = measure_at(recipe, design, name, lift)
        elif valve is None:
            figures[name] = Measured(None, _UNITS[name], detail="valve is not given")
        elif name == LIFT:
            figures[name] = Measured(greatest_lift(valve, design), "mm")
        else:
            figures[name] = _peak(valve, design, name)
    return figures


def greatest_lift(valve: Valve, design: Design) -> float:
    """Greatest lift of the valve, mm, 0 if it never opens; raises EventError for a motion too rough to follow."""
    most = tappet_lift(design)
    return max(float(valve.travel(np.array([most]))[0, 0]) - valve.lash, 0.0)


def _peak(valve: Valve, design: Design, name: str) -> Measured:
    try:
        peak = extremes(valve, design)[1 if name == VELOCITY else 2]
    except EventError as error:
        return Measured(None, _UNITS[name], detail=str(error))
    return Measured(peak.value, _UNITS[name], peak.at_deg)
