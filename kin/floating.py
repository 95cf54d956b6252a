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
from kin.dynamics import DynamicsError, Train, steady

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kin.drive import Drive
    from kin.response import Response

Array = NDArray[np.float64]

TURN = 2.0 * math.pi

_LADDER = 1.08  # ratio of the speeds at which the bound is taken
_EACH = 50  # places on a stretch, and what it costs besides
_MOST_PLACES = 10_000_000  # at which forces are taken in all, which bounds the search to some seconds
_HALVINGS = 48
_RESOLUTION = 1e-11
_CORNER = 1e-9  # of the greatest velocity: a lesser leap is a tangent's rounding
_GOLDEN = 16  # steps towards the bottom of a dip
_DOUBT = 0.05  # of the preload
_MISSED = 0.02  # of the range of the force: samples of it miss less of a dip
_NARROW, _BROAD = 0.25, 3.0  # damping ratio times b: half width of a peak
_LEAST_RATIO = 0.5  # natural frequency in turns of the shaft, below which nobody asks


@dataclass(frozen=True)
class FloatSpeed:
    """Where float begins.

    rpm       least speed at which the contact force of the steady state falls to 0; None where that is not reached
              while the natural frequency is above half the shaft's
    at        shaft angle at which contact is lost there, radians
    rigid_rpm the same for a follower without compliance; None where it never floats, and where the motion has corners
    """

    rpm: float | None
    at: float | None
    rigid_rpm: float | None


def float_speed(train: Train, drive: Drive) -> FloatSpeed:
    """Find the speed at which float begins, to 1e-11 of itself; without preload or damping raises DynamicsError.

    (Without damping every speed at which a harmonic of the drive resonates floats, and these have no least one.)
    """
    if train.preload <= 0.0:
        raise DynamicsError("without preload contact is lost at any speed")
    if train.damping <= 0.0:
        raise DynamicsError("without damping contact is lost wherever a harmonic resonates, at however low a speed")
    rigid = _rigid(train, drive)
    passed: list[tuple[float, float]] = []  # up to three speeds, each with its least force
    for rpm in _speeds(train, drive):
        passed = [*passed[-2:], (rpm, _least(train, drive, rpm))]
        dip = _dip(train, drive, passed)
        if dip is not None:
            return _begins(train, drive, passed[-3][0], dip, rigid)
        if passed[-1][1] < 0.0:
            low = passed[-2][0] if len(passed) > 1 else rpm / _LADDER
            while _least(train, drive, low) < 0.0:
                low /= _LADDER
            return _begins(train, drive, low, rpm, rigid)
    return FloatSpeed(None, None, rigid)


def _dip(train: Train, drive: Drive, passed: list[tuple[float, float]]) -> float | None:
    """A speed that floats between the first and the last of three of which the middle one has the least force."""
    if len(passed) < 3 or not passed[0][1] >= passed[1][1] <= passed[2][1]:
        return None
    low, high = passed[0][0], passed[2][0]
    # a dip is no deeper below its samples than it is deep at them
    if passed[1][1] > max(passed[0][1], passed[2][1]) - passed[1][1] + _DOUBT * train.preload:
        return None
    share = 0.5 * (3.0 - math.sqrt(5.0))
    left, right = low + share * (high - low), high - share * (high - low)
    at_left, at_right = _least(train, drive, left), _least(train, drive, right)
    for _ in range(_GOLDEN):
        if min(at_left, at_right) < 0.0:
            return left if at_left < 0.0 else right
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = low + share * (high - low)
            at_left = _least(train, drive, left)
        else:
            low, left, at_left = left, right, at_right
            right = high - share * (high - low)
            at_right = _least(train, drive, right)
    return None


def _begins(train: Train, drive: Drive, low: float, high: float, rigid: float | None) -> FloatSpeed:
    """Halve between a speed that holds and one that floats."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if _least(train, drive, middle) < 0.0:
            high = middle
        else:
            low = middle
        if high - low <= _RESOLUTION * high:
            break
    return FloatSpeed(high, steady(train, drive, high).force.least_at, rigid)


def _least(train: Train, drive: Drive, rpm: float) -> float:
    """Least contact force of the steady state: exact where it is close to 0, else at samples."""
    force = steady(train, drive, rpm, rough=True).force
    if force.least < 0.0 or force.least > _MISSED * (force.greatest - force.least):
        return force.least
    return steady(train, drive, rpm).force.least


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


def _speeds(train: Train, drive: Drive) -> Iterator[float]:
    """Speeds to look at, rising; DynamicsError where they are too many."""
    places = 0.0
    rpm = _safe(train, drive)
    last = train.natural / _LEAST_RATIO * 60.0 / TURN
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
            places += _EACH * len(drive) + 4.0 * TURN * b
            if places > _MOST_PLACES:
                raise DynamicsError(
                    f"float has not begun at {rpm:.6g} rpm, and the search ends there: a train so stiff with so little "
                    "damping has too many resonances"
                )
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
    figure = running.force(found)
    every = np.repeat(np.arange(len(found)), 33)
    x = np.tile(np.linspace(-1.0, 1.0, 33), len(found))
    slow = evaluated(figure.series, every, x).reshape(-1, 33).min(axis=1)
    # |k z + c z'| of a free motion, with z' = lambda z
    root = complex(-oscillator.decay, oscillator.split)
    gain = abs(train.stiffness + train.damping * running.speed * root)
    return float((slow - gain * np.array(sizes)).min())


def _kicks(found: Response) -> Array:
    """Size of the free motion that each knot adds: p's own leap there, and the drive's corner."""
    at_start, at_end = found.ends
    leap = np.roll(at_end, 1, axis=0) - at_start
    leap[:, 1] -= found.drive.jumps
    kicks: Array = found.oscillator.bound(leap.T)
    return kicks
