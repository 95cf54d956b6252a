"""One turn of a follower train that may lose contact: its record event by event, and the figures of the whole turn."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.dynamics.events import Span, Work, top
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array, Indices


_MOST_NEAR = 24  # samples beside which an extreme is looked for at once


class Turn(NamedTuple):
    """One turn: greatest and least contact force, N or N m, impacts, and loss of contact; shaft angles are in rad.

    `least` is 0 where contact was lost. `impacts` counts the meetings with a face, `velocity` (m/s or rad/s) is the
    greatest of them, 0 without any. `free` is the shaft angle spent without contact. `bore` are the faces, LOWER and
    UPPER, that bore the follower.
    """

    greatest: float
    greatest_at: float
    least: float
    least_at: float
    impacts: int
    velocity: float
    velocity_at: float
    free: float
    bore: frozenset[int]


@dataclass(frozen=True, eq=False)
class ContactSamples:
    """Samples of a state of contact in time order: stretch (n,), time since its start (n,), rad, and level (n,).

    The level is the contact force, N or N m: contact ends where it falls below 0. `knots` are the shaft angles, rad, at
    which the stretches begin.
    """

    stretch: Indices
    time: Array
    level: Array
    knots: Array

    def until(self, stretch: int, time: float) -> ContactSamples:
        """The samples up to a time on a stretch, rad since its start, with any sample at that time."""
        later = (self.stretch > stretch) | ((self.stretch == stretch) & (self.time > time))
        count = int(np.argmax(later)) if later.any() else len(later)
        return ContactSamples(self.stretch[:count], self.time[:count], self.level[:count], self.knots)

    def phi(self, i: int) -> float:
        """Shaft angle, rad, of sample i."""
        return float(self.knots[self.stretch[i]] + self.time[i])


class Log:
    """Record of one turn as it is worked out, up to the shaft angle `reached`, rad.

    `changes` counts changes of contact.
    """

    def __init__(self, work: Work) -> None:
        self._work = work
        self.reached, self.changes = 0.0, 0
        self._greatest, self._least = (-math.inf, 0.0), (math.inf, 0.0)  # forces, each with its shaft angle
        self._impacts, self._velocity = 0, (0.0, 0.0)  # the greatest velocity, with its shaft angle
        self._free = 0.0
        self._bore: set[int] = set()

    def see(
        self,
        contact: int,
        samples: ContactSamples,
        span_of: Callable[[int], Span],
        hit: tuple[int, float] | None = None,
    ) -> None:
        """Note the extremes of the force of a contact, LOWER or UPPER, over its samples.

        `span_of(stretch)` gives the force between samples. Contact ends at `hit`, stretch and time, or goes on. Raises
        SpentError beyond the places that the work permits.
        """
        end = float(samples.phi(-1) if hit is None else samples.knots[hit[0]] + hit[1])
        self.reached = end
        self._bore.add(contact)
        if hit is not None:
            samples = samples.until(*hit)
        self._extremes(1.0, samples, span_of, end)
        if self._least[0] > 0.0:
            self._extremes(-1.0, samples, span_of, end)

    def fly(self, begin: float, end: float) -> None:
        """Take in a flight without contact from shaft angle `begin` to `end`, rad."""
        self.reached = end
        self._free += end - begin
        self.force(0.0, begin)

    def _extremes(self, sign: float, samples: ContactSamples, span_of: Callable[[int], Span], end: float) -> None:
        level = sign * samples.level
        best = int(np.argmax(level))
        self.force(float(samples.level[best]), samples.phi(best))
        joined = samples.stretch[1:] == samples.stretch[:-1]
        step = np.diff(level)
        before = np.append(0.0, np.where(joined, step, 0.0))  # how much a sample is above the one before
        after = np.append(np.where(joined, -step, 0.0), 0.0)
        # the top of a parabola is above its highest of three samples by an eighth of the greater difference at most; a
        # half leaves room for what is no parabola
        known = sign * (self._greatest if sign > 0.0 else self._least)[0]
        apart = np.maximum(before, after)
        near = np.flatnonzero((before >= 0.0) & (after >= 0.0) & (level + 0.5 * apart > known) & (apart > 0.0))
        near = near[np.argsort(-level[near], kind="stable")[:_MOST_NEAR]]
        for i in near.tolist():
            stretch, time = int(samples.stretch[i]), float(samples.time[i])
            knot = float(samples.knots[stretch])
            low = float(samples.time[i - 1]) if i and joined[i - 1] else time
            high = max(time, end - knot) if i == len(joined) else float(samples.time[i + 1]) if joined[i] else time
            value, at = top(span_of(stretch), low, high, sign, self._work)
            self.force(value, knot + at)

    def force(self, value: float, phi: float) -> None:
        """Take in a contact force, N or N m, at the shaft angle phi, rad, for the turn's extremes.

        A force below 0 counts as 0.
        """
        value = max(value, 0.0)
        if value > self._greatest[0]:
            self._greatest = value, phi
        if value < self._least[0]:
            self._least = value, phi

    def meet(self, speed: float, phi: float) -> None:
        """Count an impact of the follower on a face, at a relative speed, m/s or rad/s, and shaft angle phi, rad."""
        self._impacts += 1
        if speed > self._velocity[0]:
            self._velocity = speed, phi

    def turn(self) -> Turn:
        """Result of the turn."""
        return Turn(*self._greatest, *self._least, self._impacts, *self._velocity, self._free, frozenset(self._bore))
