"""The shaft speed at which a follower under a preload spring first loses contact.

The least contact force of the steady state is followed from a speed at which it is safe, upwards. With little damping
it dips wherever a multiple of the shaft's speed meets the natural frequency, so the steps resolve those: in terms of
the damped frequency in turns of the shaft, b, half a unit where its peaks are narrow (each whole number, and between),
a quarter where they overlap, more where a free motion does not last from one rise to the next. Over wide ranges of high
b no dip can reach 0; they are passed over by a bound that knows no phase.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from kin.chebyshev import evaluated
from kin.dynamics import DynamicsError, Train, periodic, steady
from kin.instants import SpentError, Work, crossing
from kin.response import Samples

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kin.drive import Drive
    from kin.oscillator import Oscillator
    from kin.peaks import Figure
    from kin.response import Response

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

MOST_WORK = 15_000_000  # places that a search looks at, which bounds it to some seconds

TURN = 2.0 * math.pi

_LADDER = 1.08  # ratio of the speeds at which the bound is taken
_EACH = 50  # places that a stretch costs to solve
_SWINGS, _IN_SWING = 16, 17  # swings looked at on a stretch, and places in each
_IN_PART = 33  # places on a stretch of at most some swings
_MISSED = 0.02  # of the range of the force: these miss less of a dip
_STRIDE = 1.02  # ratio of the speeds at which a surely floating one is looked for
_RESOLUTION = 1e-11
_CORNER = 1e-9  # of the greatest velocity: a lesser leap is a tangent's rounding
_GOLDEN = 16  # steps towards the bottom of a dip
_DOUBT = 0.05  # of the preload
_NARROW, _BROAD = 0.25, 3.0  # damping ratio times b: half width of a peak
_LEAST_RATIO = 0.5  # natural frequency in turns of the shaft, below which nobody asks


@dataclass(frozen=True)
class FloatSpeed:
    """Where float begins.

    rpm       least speed at which the contact force of the steady state falls to 0; None where that is not reached
              while the natural frequency is above half the shaft's
    at        shaft angle at which contact is lost there, radians
    rigid_rpm the same for a follower without compliance; None where it never floats, and where the motion has corners
    between   where the search was given up: a speed up to which contact holds at all that were looked at, and one that
              floats, or None where none was found either
    """

    rpm: float | None
    at: float | None
    rigid_rpm: float | None
    between: tuple[float, float | None] | None = None


def float_speed(train: Train, drive: Drive, *, most: int = MOST_WORK) -> FloatSpeed:
    """Find the speed at which float begins, to 1e-11 of itself; without preload or damping raises DynamicsError.

    (Without damping every speed at which a harmonic of the drive resonates floats, and these have no least one.) A
    search that has looked at `most` places ends, with the speeds between which float begins.
    """
    if train.preload <= 0.0:
        raise DynamicsError("without preload contact is lost at any speed")
    if train.damping <= 0.0:
        raise DynamicsError("without damping contact is lost wherever a harmonic resonates, at however low a speed")
    rigid = _rigid(train, drive)
    force = _Force(train, drive, Work(most))
    passed: list[tuple[float, tuple[float, float]]] = []  # up to three speeds, each with its floor and least force
    low, high = 0.0, None
    try:
        for rpm in _speeds(train, drive):
            passed = [*passed[-2:], (rpm, force.both(rpm))]
            high = _dip(force, train, passed, 0) or _dip(force, train, passed, 1)
            if high is not None:
                low = passed[-3][0]
                break
            if passed[-1][1][1] < 0.0:
                low, high = passed[-2][0] if len(passed) > 1 else rpm / _LADDER, rpm
                while force.least(low) < 0.0:
                    low /= _LADDER
                break
        if high is None:
            return FloatSpeed(None, None, rigid)
        begins = crossing(force.least, low, high, 0.0, force.work, room=_RESOLUTION)
    except SpentError:
        low = low or (passed[0][0] if passed else _safe(train, drive))
        return FloatSpeed(None, None, rigid, (low, high or _floats(train, drive, low)))
    return FloatSpeed(begins, steady(train, drive, begins).force.least_at, rigid)


def _floats(train: Train, drive: Drive, rpm: float) -> float | None:
    """A speed above another that is sure to float, from looks at single swings; None where none is found."""
    force, last = _Force(train, drive, Work(MOST_WORK)), _last(train)
    try:
        while rpm < last:
            rpm *= _STRIDE
            if force.sure(rpm) < 0.0:
                return rpm
    except SpentError:
        return None
    return None


def _dip(force: _Force, train: Train, passed: list[tuple[float, tuple[float, float]]], which: int) -> float | None:
    """A speed that floats between the first and the last of three of which the middle one is lowest.

    `which` of a speed's two figures is gone by, see `_Force.both`.
    """
    if len(passed) < 3:
        return None
    (low, before), (_, middle), (high, after) = ((rpm, figures[which]) for rpm, figures in passed)
    # a dip is no deeper below its samples than it is deep at them
    if not before >= middle <= after or middle > max(before, after) - middle + _DOUBT * train.preload:
        return None
    share = 0.5 * (3.0 - math.sqrt(5.0))
    left, right = low + share * (high - low), high - share * (high - low)
    at_left, at_right = force.both(left), force.both(right)
    for _ in range(_GOLDEN):
        for rpm, figures in ((left, at_left), (right, at_right)):
            if figures[1] < 0.0:
                return rpm
        if at_left[which] < at_right[which]:
            high, right, at_right = right, left, at_left
            left = low + share * (high - low)
            at_left = force.both(left)
        else:
            low, left, at_left = left, right, at_right
            right = high - share * (high - low)
            at_right = force.both(right)
    return None


class _Force:
    """The least contact force of the steady state over the shaft's speed: its sign is exact, its value may bound it."""

    def __init__(self, train: Train, drive: Drive, work: Work) -> None:
        self.train, self.drive, self.work = train, drive, work

    def least(self, rpm: float) -> float:
        """The least force, or what has its sign; see `both`."""
        return self.both(rpm)[1]

    def both(self, rpm: float) -> tuple[float, float]:
        """A floor that knows no phase of the free motion, and so has few bottoms; the least force, close to 0 exactly.

        Where the second is far above 0 it may be a floor too, and where it is below a value at samples.
        """
        found, starts, figure, held = self._held(rpm)
        quick = self._seen(found, starts, figure, np.flatnonzero(~found.slow))
        floor = min(float(held[found.slow].min(initial=math.inf)), quick[0])
        doubt = _DOUBT * self.train.preload
        low = np.flatnonzero(held <= doubt)
        above = float(held[held > doubt].min(initial=math.inf))
        if not len(low):
            return floor, above
        slow = self._seen(found, starts, figure, low[found.slow[low]])
        least, most = min(quick[0], slow[0]), max(quick[1], slow[1])
        if least < 0.0 or (least > _MISSED * (most - least) and not found.slow[low].any()):
            return floor, min(least, above)
        self.work.take(2 * int(found.swings(starts, low)[1].sum()))
        return floor, min(figure.peaks(starts, low).least, above)

    def sure(self, rpm: float) -> float:
        """What the least force cannot be above."""
        found, starts, figure, held = self._held(rpm)
        return self._seen(found, starts, figure, np.flatnonzero(held <= 0.0))[0]

    def _held(self, rpm: float) -> tuple[Response, Array, Figure, Array]:
        """The steady state's response, states at all starts, force, and a bound (m,) of that on each stretch.

        With `held` above 0 contact lasts, whatever the phase. Where p is slow that is p's force less what is left of
        the free motion's; elsewhere, where a stretch lasts a swing or so, it is below 0: unknown.
        """
        running = self.train.at(rpm)
        found = running.response(self.drive)
        starts = found.starts(periodic(running, found), 0, len(found))
        figure = running.force(found)
        self.work.take(_EACH * len(found))
        held = np.full(len(found), -math.inf)
        oscillator = found.oscillator
        if oscillator.swings:
            rung = oscillator.bound(starts - found.ends[0].T)
            slow = found.slow
            driven = _driven(figure)[slow]
            driven = np.minimum(driven[:, :-1], driven[:, 1:])
            fade = np.exp(-oscillator.decay * 2.0 * found.half[slow, None] * np.linspace(0.0, 1.0, 33)[:-1])
            gain = _gain(self.train, running.speed, oscillator)
            held[slow] = (driven - gain * rung[slow, None] * fade).min(axis=1)
        return found, starts, figure, held

    def _seen(self, found: Response, starts: Array, figure: Figure, stretches: Indices) -> tuple[float, float]:
        """Least and greatest force at samples of the given stretches; of a slow one, swings at some places in it."""
        if not len(stretches):
            return math.inf, -math.inf
        slow, other = stretches[found.slow[stretches]], stretches[~found.slow[stretches]]
        width = 2.0 * found.half[slow, None]
        swing = np.minimum(TURN / max(found.oscillator.split, 1e-300), width / _SWINGS)
        begin = width * np.arange(_SWINGS) / _SWINGS
        time = (begin[:, :, None] + swing[:, :, None] * np.linspace(0.0, 1.0, _IN_SWING)).ravel()
        whole = (2.0 * found.half[other, None] * np.linspace(0.0, 1.0, _IN_PART)).ravel()
        each = np.concatenate([np.repeat(slow, _SWINGS * _IN_SWING), np.repeat(other, _IN_PART)])
        self.work.take(len(each))
        force = figure.at(starts, Samples(each, np.concatenate([time, whole])))
        return float(force.min()), float(force.max())


def _driven(figure: Figure) -> Array:
    """A figure's driven part at 33 places of each stretch, (m, 33)."""
    count = len(figure.series)
    every = np.repeat(np.arange(count), 33)
    return evaluated(figure.series, every, np.tile(np.linspace(-1.0, 1.0, 33), count)).reshape(count, 33)


def _gain(train: Train, speed: float, oscillator: Oscillator) -> float:
    """Greatest |k z + c z'| of a free motion by its greatest |z|, from z' = lambda z."""
    return abs(train.stiffness + train.damping * speed * complex(-oscillator.decay, oscillator.split))


def _rigid(train: Train, drive: Drive) -> float | None:
    """Speed at which F + k_p s + m W^2 s'' first falls to 0, on a grid of 33 points a stretch; None with corners."""
    if (np.abs(drive.jumps) > _CORNER * float(np.abs(drive.velocity).sum(axis=1).max())).any():
        return None
    every = np.repeat(np.arange(len(drive)), 33)
    phi = drive.knots[every] + np.tile(np.linspace(0.0, 2.0, 33), len(drive)) * drive.half[every]
    position, _, bend = drive.rows(every, phi)
    falling = bend < 0.0
    if not falling.any():
        return None
    held = np.maximum(train.preload + train.rate * position[falling], 0.0)
    return float(np.sqrt((held / (-train.mass * bend[falling])).min())) * 60.0 / TURN


def _last(train: Train) -> float:
    """The speed beyond which nobody asks."""
    return train.natural / _LEAST_RATIO * 60.0 / TURN


def _speeds(train: Train, drive: Drive) -> Iterator[float]:
    """Speeds to look at, rising."""
    rpm = _safe(train, drive)
    last = _last(train)
    while rpm < last:
        if _bound(train, drive, rpm) > 0.0:
            yield rpm
            rpm *= _LADDER
            continue
        top = min(rpm * _LADDER, last)
        b = train.at(rpm).bound.split if train.damping_ratio < 1.0 else train.ratio(rpm)
        ratio = b * rpm  # b falls as the speed rises
        while rpm < top:
            yield rpm
            b = ratio / rpm
            width = train.damping_ratio * b
            if width < _NARROW:
                b = 0.5 * (math.ceil(2.0 * b - 1e-9) - 1.0)
            else:
                b -= 0.25 if width < _BROAD else 0.08 * width
            rpm = min(ratio / max(b, 1e-3), last)


def _safe(train: Train, drive: Drive) -> float:
    """A speed below which no steady state can float: by the integral of the modulus of what a force drives up."""
    zeta = train.damping_ratio
    bend = float(np.abs(drive.acceleration).sum(axis=1).max())
    kicks = float(np.abs(drive.jumps).sum())
    held = train.preload + train.rate * min(0.0, float(drive.position.sum(axis=1).min()))
    if held <= 0.0:
        raise DynamicsError("the preload spring is slack over a part of the turn")

    def driven(rpm: float) -> float:
        running = train.at(rpm)
        oscillator = running.bound
        gain = oscillator.amplification * (1.0 + 2.0 * zeta)
        lasting = -math.expm1(-TURN * oscillator.fading)
        return running.inertia * (gain * bend + (1.0 + 2.0 * zeta) * oscillator.natural * kicks / lasting)

    low, high = 1e-9, train.natural * 60.0
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if driven(middle) < held else (low, middle)
    return low


def _bound(train: Train, drive: Drive, rpm: float) -> float:
    """What the least contact force of the steady state cannot fall below, whatever the phases of its free motion."""
    running = train.at(rpm)
    found = running.response(drive)
    oscillator = found.oscillator
    if not oscillator.swings:
        return -math.inf
    kicks, fade = _kicks(found), np.exp(-oscillator.decay * np.diff(found.drive.knots))
    size = 0.0
    for _ in range(2):
        total, gained = 0.0, 1.0
        sizes = []
        for kick, left in zip(kicks.tolist(), fade.tolist(), strict=True):
            total += kick
            sizes.append(size * gained + total)
            total, gained = total * left, gained * left
        size = total / (1.0 - gained)
    gain = _gain(train, running.speed, oscillator)
    return float((_driven(running.force(found)).min(axis=1) - gain * np.array(sizes)).min())


def _kicks(found: Response) -> Array:
    """Size of the free motion that each knot adds: p's own leap there, and the drive's corner."""
    at_start, at_end = found.ends
    leap = np.roll(at_end, 1, axis=0) - at_start
    leap[:, 1] -= found.drive.jumps
    kicks: Array = found.oscillator.bound(leap.T)
    return kicks
