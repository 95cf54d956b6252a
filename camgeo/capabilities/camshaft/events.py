"""When lobes lift: crossings of a lift, lobe centres, an engine's valve events, and the stretches of a machine's chart.

A lobe's centre is the middle between the two crossings of a lift, never its peak; events are stated in crank degrees,
twice the camshaft's.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from camgeo.measures.lobe import EventError, event_of, lift_pieces
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.cams.family import ExactCam

WAVE = 1e-3  # of the stroke: a rise or a return by less counts as a dwell
# crank degrees after a cylinder's firing dead centre of those from which its valves' opening and closing are counted
DEAD_CENTRES = {"intake": ((360.0, "TDC"), (540.0, "BDC")), "exhaust": ((180.0, "BDC"), (360.0, "TDC"))}
CYCLE = 720.0  # crank degrees of one turn of the camshaft
Phase: TypeAlias = Literal["rise", "dwell", "return"]


class Event(NamedTuple):
    """Stretch of a turn in which a lobe lifts its follower beyond a lift.

    `opens`, `closes` and `centre` are shaft angles, degrees from 0 to below 360; the duration is in degrees of the
    shaft.
    """

    opens: float
    closes: float
    centre: float
    duration: float  # of the shaft


class Stretch(NamedTuple):
    """A phase of a follower's motion, from shaft angle `begin`, degrees from 0 to below 360, to `end` beyond it."""

    phase: Phase
    begin: float
    end: float


class Valves(NamedTuple):
    """Events of a cylinder's valves at a lift, crank degrees.

    The intake opens before top and closes after bottom dead centre, the exhaust opens before bottom and closes after
    top; negative values lie on the other side. The overlap is below 0 where both valves are shut between. `separation`
    is the angle between the lobes' centres, cam degrees.
    """

    intake_opens: float
    intake_closes: float
    exhaust_opens: float
    exhaust_closes: float
    overlap: float
    separation: float


def event(exact: ExactCam, zero: float, lift: float) -> Event | None:
    """Event of a lobe at a lift, mm or rad, with its motion begun at shaft angle `zero`, rad.

    None where the follower is not beyond the lift in exactly one stretch of a turn, or its motion is too rough to tell.
    """
    try:
        crossed = event_of(exact, lift)
    except EventError:
        return None
    opens, closes = (math.degrees(angle + zero) for angle in (crossed.opening, crossed.closing))
    return Event(opens % 360.0, closes % 360.0, 0.5 * (opens + closes) % 360.0, closes - opens)


def stretches(exact: ExactCam, zero: float) -> tuple[Stretch, ...]:
    """Rises, dwells and returns of a lobe whose motion begins at `zero`, rad, in their order round the turn.

    They follow from the motion, whatever its source: successive segments in one direction are one stretch, and waves
    below a thousandth of the stroke are a dwell. The result is empty for a motion too rough to be followed.
    """
    try:
        followed = lift_pieces(exact)
    except EventError:
        return ()
    x, level = followed.x, followed.values[:-1]
    middle = 0.5 * (x[:-1] + x[1:])
    phases = np.where(exact.motion.by_parameter(middle, 1)[1] > 0.0, "rise", "return")
    for begin, end in {rest for gauge in exact.gauges.values() for rest in gauge.rests}:
        phases[np.mod(middle - begin, TURN) < end - begin] = "dwell"
    first = np.flatnonzero(phases != np.roll(phases, 1))
    if first.size:  # waves, such as a measured base circle has
        flat = np.abs(level[np.roll(first, -1)] - level[first]) < WAVE * np.ptp(level)
        runs = np.repeat(np.where(flat, "dwell", phases[first]), np.diff(first, append=first[0] + len(phases)))
        phases = np.roll(runs, first[0])
        first = np.flatnonzero(phases != np.roll(phases, 1))
    if not first.size:
        return (Stretch(phases[0], 0.0, 360.0),)
    begins = np.round(np.degrees(x[first] + zero), 9)  # so that one at 360 is at 0
    ends = np.append(begins[1:], begins[0] + 360.0)
    rows = zip(phases[first].tolist(), (begins % 360.0).tolist(), (ends - begins).tolist(), strict=True)
    return tuple(Stretch(phase, begin, begin + length) for phase, begin, length in rows)


def event_words(valve: str, opens: float, lasts: float) -> tuple[str, str]:
    """Name a valve's opening and closing by its dead centres, crank degrees: `IVO 9.8° ATDC`, `IVC 30.2° ABDC`.

    `valve` is intake or exhaust. `opens` is counted from the cylinder's firing dead centre, `lasts` is the duration;
    both are crank degrees.
    """
    words = []
    for name, degrees, (dead, letters) in zip(("O", "C"), (opens, opens + lasts), DEAD_CENTRES[valve], strict=True):
        after = signed(degrees - dead)
        words.append(f"{valve[0].upper()}V{name} {abs(after):.1f}° {'A' if after > 0.0 else 'B'}{letters}")
    return words[0], words[1]


def valves_of(intake: Event, exhaust: Event, fires: float) -> Valves:
    """Events of a cylinder that fires at the crank angle `fires`, degrees, from the events of its two lobes."""
    # crank degrees after the cylinder's own firing dead centre; 360 is the dead centre of the overlap
    opens, closes = crank_after(intake.opens, fires), crank_after(intake.closes, fires)
    opened, closed = crank_after(exhaust.opens, fires), crank_after(exhaust.closes, fires)
    after = crank_after(intake.centre, fires) - 360.0
    before = 360.0 - crank_after(exhaust.centre, fires)
    return Valves(
        signed(360.0 - opens),
        signed(closes - 540.0),
        signed(180.0 - opened),
        signed(closed - 360.0),
        signed(closed - opens),
        0.5 * (after + before),
    )


def crank_after(cam: float, fires: float) -> float:
    """Crank degrees, in [0, 720), after the firing dead centre `fires` when the camshaft stands at `cam` degrees."""
    return (2.0 * cam - fires) % CYCLE


def signed(crank: float) -> float:
    """A crank angle, degrees, as the same place from -360 to below 360."""
    return (crank + 360.0) % CYCLE - 360.0
