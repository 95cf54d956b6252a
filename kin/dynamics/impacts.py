"""A follower train that loses contact, flies, and meets a face again: event after event, each stretch in closed form.

The train is in one of three states: on the lower face, on the upper one, or free. In each the equation of motion is
linear, and solved exactly (`kin.dynamics.response`); what is searched for are the instants at which the state changes
(`kin.dynamics.events`, `kin.dynamics.flight`).

    contact ends    where its force would fall below 0, which with damping is before the contact's spring is slack
    contact begins  where the spring is compressed and its force, damping included, above 0

Meeting a face at speed v with damping c, the force begins at c v: Kelvin's and Voigt's contact has that step.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.dynamics.cycle import ContactSamples, Log, Turn
from kin.dynamics.drive import lowest
from kin.dynamics.events import FREE, LOWER, UPPER, Driven, Pressed, SpentError, Work, dips, first, windows
from kin.dynamics.flight import Flight, Path
from kin.dynamics.peaks import ResponseFigure
from kin.dynamics.response import Response, ResponsePlaces, response
from kin.dynamics.train import DynamicsError, Running, Train
from kin.numeric.arrays import Array
from kin.numeric.chebyshev import AT_START, DERIVATIVE, evaluated
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.dynamics.drive import Drive
    from kin.dynamics.oscillator import Free


MOST_WORK = 6_000_000  # places that a course looks at, which bounds it to some seconds

_LEVEL = 1e-12  # of the greatest force in sight: within this a force is 0
_ALONE = 3  # stretches after an event that are looked along one by one
_FIRST_WINDOW, _MOST_WINDOW = 8, 256  # stretches looked at together
_QUIET = 256  # samples for free motion beyond which a stretch is looked along by itself
_MOST_EVENTS = 20_000
_SETTLED = 1e-9

_Event = tuple[int, int, float, Array]  # the state that begins, stretch and time in it, z and z' there


class ContactState(NamedTuple):
    """Contact, FREE, LOWER or UPPER, and z, m or rad, and z' by radian of shaft, over the face that bears.

    In free flight they are over the lower face.
    """

    contact: int
    z: float
    v: float


@dataclass(frozen=True)
class Course:
    """Turns in order from the start, the state at the end of the last, and whether that turn repeats the one before.

    `stopped` is a text of where and why the course was given up, None where it was not; `places` is the number of
    places looked at.
    """

    turns: tuple[Turn, ...]
    end: ContactState
    settled: bool
    stopped: str | None
    places: int


def course(
    train: Train,
    faces: tuple[Drive, Drive | None],
    rpm: float,
    turns: int,
    start: ContactState | None = None,
    *,
    most: int = MOST_WORK,
) -> Course:
    """Follow a train over at most `turns` turns, until one repeats the one before.

    `faces` are the drives below and above, on common knots, in SI; without a face above the preload alone keeps the
    train down. Without a `start` it begins at rest, x' = 0, at shaft angle 0: on the lower face with its spring as at
    rest, or halfway between the faces. Where a turn has more than 20 000 changes of contact, or `most` places have been
    looked at, the course ends with the last whole turn, which may be none. Raises DynamicsError where the faces leave
    no play and for a speed `rpm` that is not above 0, StiffnessError for damping so strong that the response needs too
    many parts.
    """
    return _Course(train.at(rpm), faces, most).run(turns, start)


def least_gap(lower: Drive, upper: Drive) -> tuple[float, float]:
    """Least distance, m or rad, from lower to upper face over the turn, to rounding, and its shaft angle, rad."""
    return lowest(lower.knots, [upper.position - lower.position], lambda row: row[0])


class _Course:
    """The three responses, and the search for events in them."""

    def __init__(self, running: Running, faces: tuple[Drive, Drive | None], most: int) -> None:
        self.running = running
        self.lower, self.upper = faces
        self.responses = {
            LOWER: running.response(self.lower),
            FREE: response(running.loose, self.lower, running.forcing),
        }
        self.gap: Array | None = None
        if self.upper is not None:
            least, at = least_gap(self.lower, self.upper)
            if least <= 0.0:
                where = math.degrees(at) % 360.0
                raise DynamicsError(f"no backlash is left at {where:.6g} degrees: {least:.3g} m or rad")
            self.responses[UPPER] = running.response(self.upper)
            rows = (self.upper.position - self.lower.position, self.upper.velocity - self.lower.velocity)
            self.gap = np.stack(rows, axis=1)
        self.forces = {
            side: running.force(self.responses[side], side) for side in (LOWER, UPPER) if side in self.responses
        }
        self.contact = running.train.stiffness, running.train.damping * running.speed
        scale = running.inertia * float(np.abs(self.lower.acceleration).sum(axis=1).max())
        self.limit = -_LEVEL * (scale + running.train.preload)
        self.work = Work(most)

    def run(self, turns: int, start: ContactState | None) -> Course:
        state, settled = start or self._rest(), False
        done: list[Turn] = []
        while len(done) < turns and not settled:
            log = Log(self.work)
            try:
                after = self._turn(state, log)
            except SpentError:
                return Course(tuple(done), state, settled, self._reason(len(done), log), self.work.places)
            done.append(log.turn())
            settled = after.contact == state.contact and self._alike(state, after)
            state = after
        return Course(tuple(done), state, settled, None, self.work.places)

    def _reason(self, turns: int, log: Log) -> str:
        train, rpm = self.running.train, self.running.rpm
        return (
            f"followed from rest to {math.degrees(log.reached):.4g} degrees of turn {turns + 1} and no further: "
            f"{log.changes} changes of contact in that turn, {self.work.places} places looked at in all; with the "
            f"natural frequency {train.ratio(rpm):.4g} times the shaft's and {train.damping_ratio:.3g} times the "
            "critical damping; more damping, less stiffness or a faster shaft takes fewer"
        )

    def _rest(self) -> ContactState:
        position = float(self.lower.position[0] @ AT_START)
        # before the jump at 0, which belongs to the first stretch
        velocity = float(self.lower.velocity[0] @ AT_START - self.lower.jumps[0])
        if self.upper is None:
            return ContactState(LOWER, self.running.static(position), -velocity)
        return ContactState(FREE, 0.5 * float(self.upper.position[0] @ AT_START - position), -velocity)

    def _alike(self, state: ContactState, other: ContactState) -> bool:
        natural = self.running.bound.natural
        size = max(abs(state.z), abs(state.v) / natural, abs(other.z), abs(other.v) / natural)
        return bool(math.hypot(state.z - other.z, (state.v - other.v) / natural) <= _SETTLED * size)

    def _turn(self, state: ContactState, log: Log) -> ContactState:
        """Follow one turn, from contact to contact: the state at its end from that at its start.

        Both are before the jump of the face's velocity there. Raises SpentError for too many changes or places.
        """
        contact, place, time = state.contact, 0, 0.0
        current = np.array([state.z, state.v - self.responses[contact].drive.jumps[0]])
        while True:
            event = self._run_on(contact, place, time, current, log)
            if not isinstance(event, tuple):
                return ContactState(contact, float(event[0]), float(event[1]))
            begins, place, time, current = event
            phi = float(self.responses[contact].drive.knots[place]) + time
            current = self._relative_to_face(current, contact, begins, phi)
            log.changes += 1
            if log.changes > _MOST_EVENTS:
                raise SpentError
            if begins != FREE:
                k, c = self.contact
                log.meet(-begins * float(current[1]) * self.running.speed, phi)
                log.force(-begins * float(k * current[0] + c * current[1]), phi)
            contact = begins
            drive = self.responses[contact].drive
            place = drive.find(phi)
            time = phi - float(drive.knots[place])

    def _relative_to_face(self, current: Array, before: int, after: int, phi: float) -> Array:
        """The state (2,) over the face of the contact that begins, from that over the face of the contact before."""
        if UPPER not in (before, after):
            return current
        gap = self._gaps(np.array([phi]))[:, 0]
        return current - gap if after == UPPER else current + gap

    def _gaps(self, phi: Array) -> Array:
        """Upper less lower face, and its rate, (2, n), at phi (n,). Raises DynamicsError without an upper face."""
        if self.gap is None:
            raise DynamicsError("there is no upper face")
        at = np.clip(np.searchsorted(self.lower.knots, phi, side="right") - 1, 0, len(self.lower) - 1)
        x = (phi - self.lower.knots[at]) / self.lower.half[at] - 1.0
        return np.stack([evaluated(self.gap[:, row], at, x) for row in (0, 1)])

    def _pressed_face(self, contact: int, place: int, free: Free) -> Pressed:
        """The force of a face that bears on one stretch."""
        half = float(self.responses[contact].half[place])
        k, c = self.contact
        series = self.forces[contact].series[place]
        return Pressed(Driven(series, half), free, (-contact * k, -contact * c), self.limit)

    def _flight(self, place: int, free: Free) -> Flight:
        """A train without contact on one stretch."""
        here = self.responses[FREE]
        half = float(here.half[place])
        gap = None
        if self.gap is not None:
            begin = float(here.drive.knots[place])
            own = self.lower.find(begin + half)
            gap = Path(self.gap[own], float(self.lower.half[own]), begin - float(self.lower.knots[own]))
        return Flight(Path(np.stack([here.p[place], here.v[place]]), half), free, self.contact, gap, self.limit)

    def _run_on(self, contact: int, place: int, time: float, current: Array, log: Log) -> _Event | Array:
        """Run on to the next event, or to the end of the turn: the state (2,) there."""
        here = self.responses[contact]
        # The first stretches, and any of long swings, are run along one by one, the others in windows that double.
        # `current` is the state after the jump where a single stretch begins, before it where a window does.
        window, singly = _FIRST_WINDOW, _ALONE
        while True:
            event = self._run_along(contact, place, time, current, log)
            if isinstance(event, tuple):
                return event
            current, place, time = event, place + 1, 0.0
            if singly and place < len(here):
                singly -= 1
                current = current - np.array([0.0, here.drive.jumps[place]])
                continue
            while place < len(here):
                count = min(window, len(here) - place)
                starts, quiet = self._before_ringing(here, place, count, current)
                if not quiet:
                    current = starts[:, place]
                    break
                next_event = self._next_in(contact, starts, place, quiet, log)
                if next_event is not None:
                    return next_event
                current = here.end(current, place, quiet)
                place, window = place + quiet, min(2 * window, _MOST_WINDOW)
            if place == len(here):
                return current

    def _before_ringing(self, here: Response, place: int, count: int, before: Array) -> tuple[Array, int]:
        """States (2, m), filled in for the next `count` stretches, and how many of these come before long swings."""
        starts = np.zeros((2, len(here)))
        starts[:, place : place + count] = here.starts(before, place, count)
        fine = here.swings(starts, np.arange(place, place + count))[1]
        loud = np.flatnonzero(fine > _QUIET)
        return starts, int(loud[0]) if len(loud) else count

    def _run_along(self, contact: int, place: int, time: float, current: Array, log: Log) -> _Event | Array:
        """Run on along one stretch to the next event, or to its end: the state (2,) there."""
        here = self.responses[contact]
        free = here.free(place, time, current)
        end = 2.0 * float(here.half[place])
        if contact == FREE:
            flight, knot = self._flight(place, free), float(here.drive.knots[place])
            landed = flight.landed(time, end, self.work)
            log.fly(knot + time, knot + (end if landed is None else landed))
            if landed is not None:
                return flight.face(landed), place, landed, here.moved(place, free, landed)
            return here.moved(place, free, end)
        span = self._pressed_face(contact, place, free)
        bound = here.oscillator.bound(np.array([[free.z], [free.v]]))
        ringing = time + float(here.lasting(bound, np.array([place]))[0])
        for at in windows(time, end, ringing, here.step):
            self.work.take(len(at))
            level = span.at(at)
            hit = first(span, at, level, self.work)
            samples = ContactSamples(np.full(len(at), place), at, level, here.drive.knots)
            log.see(contact, samples, lambda _: span, None if hit is None else (place, hit))
            if hit is not None:
                return FREE, place, hit, here.moved(place, free, hit)
        return here.moved(place, free, end)

    def _next_in(self, contact: int, starts: Array, place: int, count: int, log: Log) -> _Event | None:
        """The next event in `count` whole stretches from `place` on, looked along at once; None without any.

        `starts` (2, m) are the states at their starts.
        """
        here = self.responses[contact]
        at = here.samples(starts, np.arange(place, place + count))
        self.work.take(len(at.time))
        if contact == FREE:
            return self._far(starts, at, log)
        level = self.forces[contact].at(starts, at)
        samples = ContactSamples(at.stretch, at.time, level, here.drive.knots)

        def span_of(stretch: int) -> Pressed:
            return self._pressed_face(contact, stretch, here.free(stretch, 0.0, starts[:, stretch]))

        doubtful = np.union1d(np.flatnonzero(level < self.limit), dips(level))
        for stretch in np.unique(at.stretch[doubtful]).tolist():
            inside = at.stretch == stretch
            hit = first(span_of(stretch), at.time[inside], level[inside], self.work)
            if hit is not None:
                log.see(contact, samples, span_of, (stretch, hit))
                state = here.moved(stretch, here.free(stretch, 0.0, starts[:, stretch]), hit)
                return FREE, stretch, hit, state
        log.see(contact, samples, span_of)
        return None

    def _far(self, starts: Array, samples: ResponsePlaces, log: Log) -> _Event | None:
        """The first meeting with a face in flight along whole stretches; None without any.

        Only stretches on which a face may be met between two samples are looked along.
        """
        here = self.responses[FREE]
        knots = here.drive.knots
        first_, last = int(samples.stretch[0]), int(samples.stretch[-1])
        begin = float(knots[first_])
        z = ResponseFigure.of(here, 1.0, 0.0).at(starts, samples)
        deep, bend = -z, self._bends(starts)
        if self.gap is not None:
            deep = np.maximum(deep, z - self._gaps(knots[samples.stretch] + samples.time)[0])
        # between two places a function is no more above both than this
        above = np.maximum(deep[:-1], deep[1:]) + bend[samples.stretch[1:]] * np.diff(samples.time) ** 2 / 8.0
        near = (above >= 0.0) & (samples.stretch[1:] == samples.stretch[:-1])
        for stretch in np.unique(samples.stretch[1:][near]).tolist():
            free = here.free(stretch, 0.0, starts[:, stretch])
            flight = self._flight(stretch, free)
            landed = flight.landed(0.0, 2.0 * float(here.half[stretch]), self.work)
            if landed is not None:
                log.fly(begin, float(knots[stretch]) + landed)
                return flight.face(landed), stretch, landed, here.moved(stretch, free, landed)
        log.fly(begin, float(knots[last + 1]))
        return None

    def _bends(self, starts: Array) -> Array:
        """Bound (m,) of the second derivative of the distance to either face in flight, on each stretch."""
        here, oscillator = self.responses[FREE], self.responses[FREE].oscillator
        if not oscillator.square:
            return self._driven_bends
        bends: Array = self._driven_bends + oscillator.square * oscillator.bound(starts - here.ends[0].T)
        return bends

    @cached_property
    def _driven_bends(self) -> Array:
        """Part (m,) of `_bends` that is not of the free motion."""
        here = self.responses[FREE]
        bounds: Array = np.abs(here.v @ DERIVATIVE.T).sum(axis=1) / here.half
        if self.gap is not None:
            bends = np.abs(self.gap[:, 1] @ DERIVATIVE.T).sum(axis=1) / self.lower.half
            middle = here.drive.knots[:-1] + here.half
            bounds = bounds + bends[np.searchsorted(self.lower.knots, middle, side="right") - 1]
        return bounds
