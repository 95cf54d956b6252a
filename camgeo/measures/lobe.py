"""Figures of a lobe at a stated lift, in the words of engine people: duration, lobe centre, ramp velocity, lift area.

All come from the shaft angles at which the lift has that value. The motion is followed by polynomials of which no
crossing is missed (`kin.numeric.monotone`). Cam degrees are half the crank's.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.measures.extension import MEASURES
from camgeo.measures.measured import Measured
from camgeo.recipe.figures import DURATION, FIGURES, LIFT_AREA, LOBE_CENTRE, RAMP_VELOCITY
from kin.numeric.angles import TURN, degrees
from kin.numeric.errors import CamgeoError
from kin.numeric.monotone import RoughError, between, cells, pieces
from kin.numeric.quadrature import gauss

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.family import ExactCam
    from camgeo.measures.extension import MovedBody
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.arrays import Array
    from kin.numeric.monotone import MonotonePieces

CRANK = 2.0  # turns of the crank for one of the cam
NODES, WEIGHTS = gauss(12)
SHARE = 1e-12  # of the greatest lift, within which the lift is approximated
ROUNDING = 1e-12  # rad, of a place at the turn's end
_TWO = 2  # places, both ends of a turn or of a rest
PARTS = 8  # of each stretch between breaks and crossings, over which the area is integrated


class LobeEvent(NamedTuple):
    """A lobe above a lift, mm: shaft angles, rad, at which it rises through it and falls again; closing > opening."""

    lift: float
    opening: float
    closing: float

    @property
    def duration(self) -> float:
        """Duration from opening to closing, crank degrees: two per degree of the cam."""
        return CRANK * math.degrees(self.closing - self.opening)

    @property
    def centre(self) -> float:
        """Middle of the crossings, cam degrees from 0 to less than 360."""
        return degrees(0.5 * (self.opening + self.closing) % TURN)


class EventError(CamgeoError, ValueError):
    """A lift that a lobe does not cross exactly once on each flank, or a motion too rough to tell."""


@lru_cache(maxsize=16)
def event_of(exact: ExactCam, lift: float) -> LobeEvent:
    """Crossings of a `lift`, mm above the lowest position.

    Raises EventError unless the lobe crosses it once upwards and once downwards, and for too abrupt a motion.
    """
    crossings = _crossings(lift_pieces(exact), lift)
    events = events_of(exact, lift)
    if len(crossings) != _TWO or len(events) != 1:
        raise EventError(f"the lift passes {lift:.6g} mm {len(crossings)} times in a turn")
    return events[0]


@lru_cache(maxsize=16)
def events_of(exact: ExactCam, lift: float) -> tuple[LobeEvent, ...]:
    """Every stretch of a turn above a `lift`, mm above the lowest position; in order, none or any number.

    A motion that only touches the lift has two stretches there. Raises EventError for too abrupt a motion.
    """
    pieces = lift_pieces(exact)
    level = pieces.least()[0] + lift
    crossings = _crossings(pieces, lift).tolist()
    if not crossings:
        return ()
    events = []
    for begin, end in pairwise([*crossings, crossings[0] + TURN]):
        middle = np.array([0.5 * (begin + end) % TURN])
        if float(exact.motion.by_parameter(middle, 0)[0, 0]) > level + (pieces.noise if lift == 0.0 else 0.0):
            events.append(LobeEvent(lift, begin, end))
    return _off_rests(events, exact) if lift == 0.0 else tuple(events)


def _off_rests(events: list[LobeEvent], exact: ExactCam) -> tuple[LobeEvent, ...]:
    """Events at lift 0, with their ends moved to the ends of the lowest dwells, near which the lift is rounding."""
    breaks = np.concatenate([exact.breaks + turns * TURN for turns in (0.0, 1.0, 2.0)])
    openings, closings = ([getattr(event, end) for event in events] for end in ("opening", "closing"))
    for k, closing in enumerate(closings):
        following = (k + 1) % len(events)
        turned = TURN if following == 0 else 0.0
        rest = breaks[(breaks >= closing - ROUNDING) & (breaks <= events[following].opening + turned + ROUNDING)]
        if len(rest) >= _TWO and np.ptp(rest) > ROUNDING:
            closings[k], openings[following] = float(rest.min()), float(rest.max()) - turned
    return tuple(LobeEvent(0.0, *ends) for ends in zip(openings, closings, strict=True))


def _crossings(pieces: MonotonePieces, lift: float) -> Array:
    """Places at which a `lift` above the lowest position is crossed, rad, ascending; of a dwell on it both ends.

    0 and the whole turn are one place, given once: as the whole turn where a dwell on the level begins there, not at
    all within such a dwell, else as 0.
    """
    level = pieces.least()[0] + lift
    places = pieces.crossings(level)
    if len(places) < _TWO or places[0] > 0.0 or places[-1] < TURN:
        return places
    middles = np.array([0.5 * places[1], 0.5 * (places[-2] + TURN)])
    values = pieces.at(np.searchsorted(pieces.x, middles, side="right") - 1, middles)
    rests_after, rests_before = (np.abs(values - level) <= pieces.noise).tolist()
    return places[int(rests_after) : len(places) - int(rests_before or not rests_after)]


@lru_cache(maxsize=16)
def lift_pieces(exact: ExactCam) -> MonotonePieces:
    """The follower's position over a turn, mm or rad, in monotone pieces; EventError for too abrupt a motion."""
    position, turn = exact.motion, between(0.0, TURN, exact.breaks.tolist())
    try:
        return pieces(cells(lambda t: position.by_parameter(t, 0), turn, share=SHARE))
    except RoughError as error:
        raise EventError("the motion changes too abruptly to be resolved") from error


def _duration(event: LobeEvent, _: ExactCam) -> Measured:
    return Measured(event.duration, "deg", degrees(event.opening % TURN))


def _centre(event: LobeEvent, _: ExactCam) -> Measured:
    return Measured(event.centre, "deg", event.centre)


def _ramp_velocity(event: LobeEvent, exact: ExactCam) -> Measured:
    """The greater speed of both crossings, mm a cam degree; at a break the speed on the side of the dwell."""
    opening, closing = np.array([event.opening % TURN]), np.array([event.closing % TURN])
    rates = exact.motion.rows(opening, 1, -1)[1], exact.motion.rows(closing, 1, 1)[1]
    rate, parameter = max((abs(float(rates[0][0])), event.opening), (abs(float(rates[1][0])), event.closing))
    return Measured(math.radians(rate), "mm/deg", degrees(parameter % TURN))


def _area(event: LobeEvent, exact: ExactCam) -> Measured:
    """Area between the lobe and the event's lift from crossing to crossing, mm times cam degrees."""
    breaks = [parameter + turns * TURN for parameter in exact.breaks.tolist() for turns in (0.0, 1.0)]
    places = between(event.opening, event.closing, sorted(breaks))
    return Measured(math.degrees(_integral(exact, places, event.lift)), "mm deg")


def _integral(exact: ExactCam, places: Array, lift: float) -> float:
    """Integral of the lift less `lift` over `places`, rad, which include the breaks; mm times rad."""
    share = np.linspace(0.0, 1.0, PARTS, endpoint=False)
    knots = np.append((places[:-1, None] + np.diff(places)[:, None] * share).ravel(), places[-1])
    half = 0.5 * np.diff(knots)
    t = 0.5 * (knots[1:] + knots[:-1])[:, None] + half[:, None] * NODES
    s = exact.motion.rows(np.mod(t.ravel(), TURN), 0)[0].reshape(t.shape) - lift
    return float((s @ WEIGHTS) @ half)


_FIGURES: dict[str, Callable[[LobeEvent, ExactCam], Measured]] = {
    DURATION: _duration,
    LOBE_CENTRE: _centre,
    RAMP_VELOCITY: _ramp_velocity,
    LIFT_AREA: _area,
}
_UNITS = {DURATION: "deg", LOBE_CENTRE: "deg", RAMP_VELOCITY: "mm/deg", LIFT_AREA: "mm deg"}


def lobe_figure(name: str, exact: ExactCam, lift: float) -> Measured:
    """Figure of a lobe at a `lift`, mm above the lowest position.

    Without a value where the lift is not crossed just twice, or the motion is too abrupt to tell. The lift area at 0 is
    that of the whole turn, and always has a value. Raises KeyError for a name of no figure of lobes.
    """
    if name == LIFT_AREA and lift == 0.0:
        turn = between(0.0, TURN, exact.breaks.tolist())
        return Measured(math.degrees(_integral(exact, turn, 0.0)), _UNITS[name])
    try:
        event = event_of(exact, lift)
    except EventError as error:
        return Measured(None, _UNITS[name], detail=str(error))
    return _FIGURES[name](event, exact)


def figure_at(recipe: Recipe, design: Design, name: str, lift: float) -> Measured:
    """Figure of the lobe, or of a body that it moves, such as a valve, at a lift of that lobe or body, mm.

    A capability measures the figures that it declares. A figure may have no value, with the reason as its detail.
    Raises KeyError for a name of no figure, and for a figure of the core that is not of a lobe; RecipeErrors and
    EventError for a body whose motion cannot be told, as `moved_by` does.
    """
    owner = FIGURES.owner(name)
    if owner:
        return MEASURES[owner].measure_at(recipe, design, name, lift)
    return lobe_figure(name, design.exact, lift)


def moved_by(recipe: Recipe, design: Design) -> MovedBody | None:
    """Motion of a body that the follower moves, such as a valve; None where the recipe has none.

    Raises RecipeErrors where the follower cannot move it, as by a table of ratios that ends below its lift, EventError
    where the follower's motion is too rough to tell.
    """
    motions = (answers.moved(recipe, design) for answers in MEASURES.of(recipe.uses))
    return next((moved for moved in motions if moved is not None), None)
