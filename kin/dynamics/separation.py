"""The shaft speed at which a follower under a preload spring first loses contact.

From a speed at which no steady state can float, upwards, ranges of speeds are either shown to hold by
`kin.dynamics.separation_bounds`, or halved; what is left of them at last, narrower than 1e-11, is where float begins.
So no dip of the least force over the speed is passed over, however narrow, and wide ranges cost a look or two.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from kin.dynamics.drive import lowest
from kin.dynamics.events import SpentError, Work, crossing
from kin.dynamics.separation_bounds import Look, Range
from kin.dynamics.train import DynamicsError, Train, steady
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.dynamics.drive import Drive


MOST_WORK = 6_000_000  # places that a search looks at, which bounds it to some seconds


_LADDER = 1.08  # ratio of the speeds of the widest range
_SURE_LADDER = 2.0  # the same up to a speed at which contact holds whatever the phases, as it does below it then
_CLOSE = 0.25  # in turns of the shaft: narrower ranges are cut as their ends' forces suggest
_LEAST_SHARE = 0.15  # of a wide range that is cut off at the end where the force is least
_STRIDE = 1.02  # ratio of the speeds at which a floating one is looked for
_BESIDE = 1e-9  # of a speed: so near a resonance, and not on it, where nothing may be steady
_RESOLUTION = 1e-11
_CORNER = 1e-9  # of the greatest velocity: a lesser leap is a tangent's rounding
_BISECTIONS = 30  # of the logarithm of a speed, which leave 1e-7 of it
_LEAST_RATIO = 0.5  # natural frequency in turns of the shaft, below which none is sought


@dataclass(frozen=True)
class FloatSpeed:
    """Shaft speed from which on contact is lost (float).

    rpm       least speed at which the contact force of the steady state falls to 0; None where that is not reached
              while the natural frequency is above half the shaft's, and where the search was given up
    at        shaft angle at which contact is lost there, radians; None without `rpm`
    rigid_rpm the same speed for a follower without compliance; None where it never floats or the motion has corners
    between   where the search was given up, else None: a speed, rpm, up to which contact holds, and a speed that
              floats, None where none was found
    places    number of places looked at
    """

    rpm: float | None
    at: float | None
    rigid_rpm: float | None
    between: tuple[float, float | None] | None
    places: int


def float_speed(train: Train, drive: Drive, *, most: int = MOST_WORK) -> FloatSpeed:
    """Find the speed at which float begins, to 1e-11 of itself.

    A search that has looked at `most` places ends, with the speeds between which float begins. Raises DynamicsError
    without preload, without damping (every speed at which a harmonic of the drive resonates floats then, and these have
    no least) and where the preload spring is slack over a part of the turn; StiffnessError for damping so strong that
    the response needs too many parts.
    """
    if train.preload <= 0.0:
        raise DynamicsError("without preload contact is lost at any speed")
    if train.damping <= 0.0:
        raise DynamicsError("without damping contact is lost wherever a harmonic resonates, at however low a speed")
    search = _Search(train, drive, Work(most))
    rigid = _rigid_float_rpm(train, drive)
    try:
        begins = search.run()
    except SpentError:
        floats = search.floats or _floats(train, drive, search.holds)
        if floats is not None:
            floats = _floats_below(train, drive, search.holds, floats)
        between = search.holds, floats
        return FloatSpeed(None, None, rigid, between, search.work.places)
    at = None if begins is None else steady(train, drive, begins).force.least_at
    return FloatSpeed(begins, at, rigid, None, search.work.places)


class _Search:
    """Search for the least speed that floats: contact holds up to `holds`, and is lost at `floats`, None if unknown."""

    def __init__(self, train: Train, drive: Drive, work: Work) -> None:
        self.train, self.drive, self.work = train, drive, work
        self.holds = _safe(train, drive)
        self.floats: float | None = None

    def run(self) -> float | None:
        """Least speed, rpm, at which contact is lost; None where it holds at all speeds looked at."""
        last, low = _last(self.train), self._look(self.holds)
        ladder = _SURE_LADDER if low.surely > 0.0 else _LADDER
        while low.rpm < last:
            high = self._look(min(low.rpm * ladder, last))
            if ladder > _LADDER and not high.surely > 0.0:  # nor will twice a higher speed be sure
                ladder = _LADDER
                high = self._look(min(low.rpm * ladder, last))
            begins = self._first(Range(low, high))
            if begins is not None:
                return begins
            low = high
        return None

    def _look(self, rpm: float) -> Look:
        return Look(self.train, self.drive, rpm, self.work)

    def _first(self, widest: Range) -> float | None:
        """The least speed in a range at which contact is lost."""
        left = [widest]
        while left:
            part = left.pop()
            if self._is_past(part):
                self.holds = part.high.rpm
                continue
            low, high = part.low, part.high
            if high.rpm - low.rpm <= _RESOLUTION * high.rpm:
                return high.rpm
            looks = [low, *self._cuts(part), high]
            left += [Range(*ends) for ends in pairwise(looks)][::-1]
        return None

    def _is_past(self, part: Range) -> bool:
        if part.sure:
            return True
        if part.high.least < 0.0:
            self.floats = min(part.high.rpm, self.floats or math.inf)
            return False
        return part.holds

    def _cuts(self, part: Range) -> list[Look]:
        """Looks within a range, rising: close to where it floats, or as far as can be shown from an end, or halfway.

        Halfway may be a resonance, or between two.
        """
        low, high = part.low, part.high
        middle = math.sqrt(low.rpm * high.rpm)
        if high.least < 0.0 < low.least and part.width < _CLOSE:
            looks = {low.rpm: low, high.rpm: high}

            def force(rpm: float) -> float:
                if rpm not in looks:
                    looks[rpm] = self._look(rpm)
                return looks[rpm].reached

            floats = crossing(force, low.rpm, high.rpm, 0.0, self.work, width=0.5 * _RESOLUTION)
            between = [looks[rpm] for rpm in sorted(looks) if low.rpm < rpm <= floats < high.rpm]
            return between or [self._look(middle)]
        share = 0.9 * math.sqrt(max(min(low.least, high.least), 0.0) / part.between)
        if share > (0.0 if part.width < _CLOSE else _LEAST_SHARE):
            share = min(share, 0.5)
            return [self._look(low.rpm + (share if low.least < high.least else 1.0 - share) * (high.rpm - low.rpm))]
        if part.width > 0.5 and high.swings:
            share = high.oscillator.split / high.b
            b = 0.5 * round(2.0 * share * self.train.ratio(middle)) / share
            if high.b + 0.1 < b < low.b - 0.1:
                middle = self.train.natural / b * 60.0 / TURN
        return [self._look(middle)]


def _floats(train: Train, drive: Drive, rpm: float) -> float | None:
    """A speed above `rpm` that floats; None where none is found."""
    work, last = Work(MOST_WORK // 6), _last(train)
    try:
        while rpm < last:
            rpm *= _STRIDE
            if Look(train, drive, rpm, work).least < 0.0:
                return rpm
    except SpentError:
        return None
    return None


def _floats_below(train: Train, drive: Drive, holds: float, floats: float) -> float:
    """A speed that floats, no greater than `floats`: by halving, as if all speeds above it floated at resonances."""
    work, low = Work(MOST_WORK // 6), holds
    try:
        while floats > _STRIDE * low:
            middle = math.sqrt(low * floats)
            tried = (rpm for rpm in _resonances(train, middle) if low < rpm < floats)
            floating = next((rpm for rpm in tried if Look(train, drive, rpm, work).least < 0.0), None)
            low, floats = (middle, floats) if floating is None else (low, floating)
    except SpentError:
        return floats
    return floats


def _resonances(train: Train, rpm: float) -> list[float]:
    """Speeds near another at which a harmonic resonates, of orders that a drive's symmetry is likely to leave.

    A cam of constant breadth has odd ones alone, one of three lobes multiples of 3, a rise of 120 degrees all others.
    """
    order = math.sqrt(max(1.0 - train.damping_ratio**2, 0.0)) * train.ratio(rpm)
    odd = max((step for step in (1, 3, 15, 105) if step <= 0.05 * order), default=1)
    orders = [odd * (2 * round(0.5 * (order / odd - 1.0)) + 1)] + [round(order) + i for i in (0, 1, -1, 2)]
    return [(1.0 + _BESIDE) * rpm * order / near for near in orders if near > 0]


def _rigid_float_rpm(train: Train, drive: Drive) -> float | None:
    """Speed, rpm, at which F + k_p s + m W^2 s'' first falls to 0, to rounding; None with corners, or without one.

    The spring's force F + k_p s is above 0 all round.
    """
    if (np.abs(drive.jumps) > _CORNER * float(np.abs(drive.velocity).sum(axis=1).max())).any():
        return None
    rows = drive.position, drive.acceleration
    share, _ = lowest(drive.knots, rows, lambda row: train.mass * row[1] / (train.preload + train.rate * row[0]))
    return 60.0 / (TURN * math.sqrt(-share)) if share < 0.0 else None


def _last(train: Train) -> float:
    """Speed, turns a minute, up to which the search goes."""
    return train.natural / _LEAST_RATIO * 60.0 / TURN


def _safe(train: Train, drive: Drive) -> float:
    """Speed, turns a minute, below which no steady state can float, by the integral of the modulus of the response.

    Raises DynamicsError where the preload spring is slack over a part of the turn.
    """
    zeta = train.damping_ratio
    bend = float(np.abs(drive.acceleration).sum(axis=1).max())
    kicks = float(np.abs(drive.jumps).sum())
    spring = train.preload
    if train.rate:
        spring += train.rate * min(0.0, lowest(drive.knots, [drive.position], lambda row: row[0])[0])
    if spring <= 0.0:
        raise DynamicsError("the preload spring is slack over a part of the turn")

    def driven(rpm: float) -> float:
        running = train.at(rpm)
        oscillator = running.bound
        gain = oscillator.amplification * (1.0 + 2.0 * zeta)
        lost = -math.expm1(-TURN * oscillator.fading)  # share of a kick's motion that a turn takes away
        return running.inertia * (gain * bend + (1.0 + 2.0 * zeta) * oscillator.natural * kicks / lost)

    low, high = 1e-9, train.natural * 60.0
    for _ in range(_BISECTIONS):  # `low` is safe after any number of them
        middle = math.sqrt(low * high)
        low, high = (middle, high) if driven(middle) < spring else (low, middle)
    return low
