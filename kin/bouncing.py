"""A follower train that loses contact, flies, and meets a face again: event after event, each stretch in closed form.

The train is in one of three states: on the lower face, on the upper one, or free. In each the equation of motion is
linear, and solved exactly (`kin.response`); what is searched for are the instants at which the state changes.

    contact ends    where its force would fall below 0, which with damping is before the contact's spring is slack
    contact begins  where the spring is compressed and its force, damping included, above 0

Meeting a face at speed v with damping c, the force begins at c v: Kelvin's and Voigt's contact has that step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kin.dynamics import DynamicsError, Running, Train
from kin.peaks import beside, narrowed
from kin.response import Response, Samples, response

if TYPE_CHECKING:
    from kin.drive import Drive

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

TURN = 2.0 * math.pi
FREE, LOWER, UPPER = 0, 1, -1

_LEVEL = 1e-12  # of the greatest force in sight: within this a force is 0
_FIRST_WINDOW, _MOST_WINDOW = 4, 256  # stretches looked at together
_GRID = 17  # points of a search, each of which narrows it so many times
_ROUNDS = 15
_NEAR = 0.05  # of the range within a window: extremes as near to an event are looked at closer
_MOST_NEAR = 24
_MOST_EVENTS = 20_000
_SETTLED = 1e-9


class Turn(NamedTuple):
    """One turn: greatest and least contact force with shaft angles, meetings, and what was lost of contact.

    `least` is 0 where contact was lost. `impacts` counts the meetings with a face, `velocity` (m/s or rad/s) is the
    greatest at one, and `free` the shaft angle spent without contact, radians.
    """

    greatest: float
    greatest_at: float
    least: float
    least_at: float
    impacts: int
    velocity: float
    velocity_at: float
    free: float


class State(NamedTuple):
    """Contact, and z and z' over the face that bears; over the lower face where none does. By radian of shaft."""

    contact: int
    z: float
    v: float


@dataclass(frozen=True)
class Course:
    """Turns in order from the start, the state at the end, and whether the last turn repeats the one before."""

    turns: tuple[Turn, ...]
    end: State
    settled: bool


def course(
    train: Train, faces: tuple[Drive, Drive | None], rpm: float, turns: int, start: State | None = None
) -> Course:
    """Follow a train over at most `turns` turns, until one repeats the one before.

    `faces` are the drives below and above, on common knots, in SI; without one above the preload alone keeps the train
    down. It begins at rest, x' = 0, at shaft angle 0: on the lower face with its spring as at rest, or halfway between
    the faces. Raises DynamicsError where the faces leave no play, or contact changes more than 20 000 times a turn.
    """
    return _Course(train.at(rpm), faces).run(turns, start)


def least_gap(lower: Drive, upper: Drive) -> tuple[float, float]:
    """Least distance from the lower to the upper face, at the best of nine angles a stretch, and where."""
    every = np.repeat(np.arange(len(lower)), 9)
    phi = lower.knots[every] + np.tile(np.linspace(0.0, 2.0, 9), len(lower)) * lower.half[every]
    gap = upper.rows(every, phi)[0] - lower.rows(every, phi)[0]
    worst = int(np.argmin(gap))
    return float(gap[worst]), float(phi[worst])


class _Course:
    """The three responses, and the search for events in them."""

    def __init__(self, running: Running, faces: tuple[Drive, Drive | None]) -> None:
        self.running = running
        self.lower, self.upper = faces
        if self.upper is not None:
            least, at = least_gap(self.lower, self.upper)
            if least <= 0.0:
                where = math.degrees(at) % 360.0
                raise DynamicsError(f"no play is left at {where:.6g} degrees: {least:.3g} m or rad")
        self.found = {
            LOWER: running.response(self.lower),
            FREE: response(running.loose, self.lower, running.forcing),
        }
        if self.upper is not None:
            self.found[UPPER] = running.response(self.upper)
        self.k = running.train.stiffness
        self.c = running.train.damping * running.speed
        scale = running.inertia * float(np.abs(self.lower.acceleration).sum(axis=1).max())
        self.level = _LEVEL * (scale + running.train.preload)

    def run(self, turns: int, start: State | None) -> Course:
        state = start or self._rest()
        done: list[Turn] = []
        for _ in range(turns):
            turn, after = self._turn(state)
            done.append(turn)
            settled = after.contact == state.contact and self._alike(state, after)
            state = after
            if settled:
                return Course(tuple(done), state, settled=True)
        return Course(tuple(done), state, settled=False)

    def _rest(self) -> State:
        first = np.array([0])
        position, velocity, _ = self.lower.rows(first, np.zeros(1))[:, 0]
        # before the jump at 0, which belongs to the first stretch
        velocity -= self.lower.jumps[0]
        if self.upper is None:
            return State(LOWER, self.running.static(position), -velocity)
        above = self.upper.rows(first, np.zeros(1))[0, 0]
        return State(FREE, 0.5 * (above - position), -velocity)

    def _alike(self, one: State, other: State) -> bool:
        natural = self.running.bound.natural
        size = max(abs(one.z), abs(one.v) / natural, abs(other.z), abs(other.v) / natural)
        return math.hypot(one.z - other.z, (one.v - other.v) / natural) <= _SETTLED * size

    def _turn(self, state: State) -> tuple[Turn, State]:
        log = _Log()
        contact, place, time = state.contact, 0, 0.0
        current = np.array([state.z, state.v - self.found[contact].drive.jumps[0]])
        # a state that has just begun may not end at once by rounding, but a jump may end it
        for _ in range(_MOST_EVENTS):
            here = self.found[contact]
            event, place, time, current = self._stretches(contact, place, time, current, log)
            if event is None:
                return log.turn(), State(contact, float(current[0]), float(current[1]))
            phi = float(here.drive.knots[place]) + time
            current = self._over(current, contact, event, phi)
            if event != FREE:
                speed = -event * float(current[1]) * self.running.speed
                log.meet(speed, phi)
                log.force(event * -(self.k * current[0] + self.c * current[1]), phi)
            contact = event
            drive = self.found[contact].drive
            place = min(int(np.searchsorted(drive.knots, phi, side="right")) - 1, len(drive) - 1)
            time = phi - float(drive.knots[place])
        raise DynamicsError(f"contact changes more than {_MOST_EVENTS} times in a turn")

    def _gap(self, phi: Array) -> Array:
        """Upper less lower face, and the rate of that, (2, n)."""
        if self.upper is None:
            raise DynamicsError("there is no upper face")
        at = np.clip(np.searchsorted(self.lower.knots, phi, side="right") - 1, 0, len(self.lower) - 1)
        gap: Array = (self.upper.rows(at, phi) - self.lower.rows(at, phi))[:2]
        return gap

    def _over(self, current: Array, before: int, after: int, phi: float) -> Array:
        """The state over the face that counts after an event."""
        if UPPER not in (before, after):
            return current
        gap = self._gap(np.array([phi]))[:, 0]
        return current - gap if after == UPPER else current + gap

    def _stretches(
        self, contact: int, place: int, time: float, current: Array, log: _Log
    ) -> tuple[int | None, int, float, Array]:
        """Run on to the next event, or to the end of the turn (None): the state that begins, stretch, time, state."""
        here = self.found[contact]
        window = _FIRST_WINDOW
        while True:
            count = min(window, len(here) - place)
            starts, since = np.zeros((2, len(here))), np.zeros(len(here))
            starts[:, place], since[place] = current, time
            after = here.after(place, time, current)
            if count > 1:
                starts[:, place + 1 : place + count] = here.starts(after, place + 1, count - 1)
                after = here.end(after, place + 1, count - 1)
            at = here.samples(starts, np.arange(place, place + count), since)
            view = _View(self, contact, here, starts, since)
            found = view.first(at)
            view.tell(at, found, log)
            if found is not None:
                event, stretch, when = found
                one = Samples(np.array([stretch]), np.array([when]))
                return event, stretch, when, here.states(starts, one, since)[:, 0]
            place += count
            if place == len(here):
                return None, place, 0.0, after
            current, time = after - np.array([0.0, here.drive.jumps[place]]), 0.0
            window = min(2 * window, _MOST_WINDOW)


@dataclass(frozen=True, eq=False)
class _View:
    """A run of stretches in one state of contact, and what happens there."""

    course: _Course
    contact: int
    found: Response
    starts: Array
    since: Array

    def _level(self, at: Samples) -> tuple[Array, Array]:
        """For each place: how far the state is from ending, below 0 where it has ended; and the state that begins."""
        z, v = self.found.states(self.starts, at, self.since)
        k, c = self.course.k, self.course.c
        if self.contact != FREE:
            force = -self.contact * (k * z + c * v)
            return force, np.full(len(z), FREE)
        lower = np.minimum(-k * z, -k * z - c * v)
        if self.course.upper is None:
            return -lower, np.full(len(z), LOWER)
        gap, rate = self.course._gap(self.found.drive.knots[at.stretch] + at.time)  # noqa: SLF001 - one module
        over = k * (z - gap)
        upper = np.minimum(over, over + c * (v - rate))
        return -np.maximum(lower, upper), np.where(lower > upper, LOWER, UPPER)

    def first(self, at: Samples) -> tuple[int, int, float] | None:
        """First event among places in order: the state that begins, the stretch and the time in it."""
        level, kind = self._level(at)
        self.__dict__["seen"] = level
        limit = -self.course.level
        ended = level < limit
        # where it has only just begun, rounding may stand on either side of 0
        begun = np.flatnonzero(ended)
        until = int(begun[0]) if len(begun) else len(level)
        for low, high in self._near(at, level, until):
            hit = self._search(at, low, high, limit)
            if hit is not None:
                return hit
        if until == len(level):
            return None
        same = until > 0 and at.stretch[until] == at.stretch[until - 1]
        if not same:
            return int(kind[until]), int(at.stretch[until]), float(at.time[until])
        hit = self._search(at, until - 1, until, limit)
        return hit or (int(kind[until]), int(at.stretch[until]), float(at.time[until]))

    def _near(self, at: Samples, level: Array, until: int) -> list[tuple[int, int]]:
        """Neighbours, in one stretch, of the places before `until` where the state all but ends."""
        places = np.arange(until)
        before, after = beside(at.stretch, places)
        low = (level[places] <= level[before]) & (level[places] <= level[after]) & (after < until) & (places > 0)
        low &= level[places] < _NEAR * (np.ptp(level) + self.course.level)
        places = places[low]
        places = np.sort(places[np.argsort(level[places], kind="stable")[:_MOST_NEAR]])
        return list(zip(before[places].tolist(), after[places].tolist(), strict=True))

    def _search(self, at: Samples, low: int, high: int, limit: float) -> tuple[int, int, float] | None:
        """First event between two places of one stretch, by narrowing from both sides; None where there is none."""
        stretch = int(at.stretch[low])
        begin, end = float(at.time[low]), float(at.time[high])
        hit: tuple[int, int, float] | None = None
        for _ in range(_ROUNDS):
            time = np.linspace(begin, end, _GRID)
            level, kind = self._level(Samples(np.full(_GRID, stretch), time))
            ended = np.flatnonzero(level[1:] < limit) + 1
            if len(ended):
                j = int(ended[0])
                hit = int(kind[j]), stretch, float(time[j])
                begin, end = float(time[j - 1]), float(time[j])
            elif hit is None:  # a dip: look closer about its lowest point
                j = int(np.argmin(level))
                begin, end = float(time[max(j - 1, 0)]), float(time[min(j + 1, _GRID - 1)])
            if end - begin <= 4.0 * np.spacing(end):
                break
        return hit

    def tell(self, at: Samples, found: tuple[int, int, float] | None, log: _Log) -> None:
        """Note the extremes of the contact force, and the time without contact, up to an event."""
        knots = self.found.drive.knots
        phi = knots[at.stretch] + at.time
        end = float(phi[-1]) if found is None else float(knots[found[1]]) + found[2]
        if self.contact == FREE:
            log.free += end - float(phi[0])
            log.force(0.0, float(phi[0]))
            return
        force: Array = self.__dict__["seen"]
        inside = np.flatnonzero(phi <= end)
        if not len(inside):
            return
        force = force[: inside[-1] + 1]
        for sign, best in ((1.0, log.greatest), (-1.0, -log.least)):
            least = max(best, float((sign * force).max())) - _NEAR * float(np.ptp(force))
            near = np.flatnonzero(sign * force >= least)
            before, after = beside(at.stretch[: len(force)], near)
            peak = (sign * force[near] >= sign * force[before]) & (sign * force[near] >= sign * force[after])
            if not peak.any():
                continue
            stretch = at.stretch[near[peak]]
            high = np.minimum(at.time[after[peak]], end - knots[stretch])
            values, time = narrowed(lambda x: self._level(x)[0], stretch, (at.time[before[peak]], high), sign)
            i = int(np.argmax(sign * values))
            log.force(float(values[i]), float(knots[stretch[i]] + time[i]))


class _Log:
    """What a turn has shown so far."""

    def __init__(self) -> None:
        self.greatest, self.greatest_at = -math.inf, 0.0
        self.least, self.least_at = math.inf, 0.0
        self.impacts, self.velocity, self.velocity_at = 0, 0.0, 0.0
        self.free = 0.0

    def force(self, value: float, phi: float) -> None:
        """Note a contact force."""
        value = max(value, 0.0)
        if value > self.greatest:
            self.greatest, self.greatest_at = value, phi
        if value < self.least:
            self.least, self.least_at = value, phi

    def meet(self, speed: float, phi: float) -> None:
        """Note a meeting with a face."""
        self.impacts += 1
        if speed > self.velocity:
            self.velocity, self.velocity_at = speed, phi

    def turn(self) -> Turn:
        """Sum up."""
        return Turn(
            self.greatest,
            self.greatest_at,
            self.least,
            self.least_at,
            self.impacts,
            self.velocity,
            self.velocity_at,
            self.free,
        )
