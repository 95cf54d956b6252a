"""The motion that a made part will make, by contact on its metal, against the intended one, with its uncertainty.

Velocity and acceleration errors are derivatives by the shaft angle of the error itself, by five-point differences:
their step is a share of the smoothing's span, so that nothing of that is lost, and far above rounding.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import turned
from kin.follower.frame_contact import CENTRED, QUARTER, WAYS, driven
from kin.follower.recognised import COVERAGE
from kin.made.local_faults import within
from kin.made.metal import Metal
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.follower.base import Follower
    from kin.law.contacts import Side
    from kin.linkage.mechanism import Mechanism
    from kin.made.local_faults import LocalFault
    from kin.made.smooth import Smooth
    from kin.numeric.arrays import Array, Mask

STEP_SHARE, MOST_STEP = 0.05, 2e-3  # of a span, and rad: the step of the differences
OFFSETS = (-2.0, -1.0, 0.0, 1.0, 2.0)  # steps; weights of the first and second derivative follow
FIRST = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
SECOND = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / 12.0
BESIDE = 3.0  # steps about a break of the motion, where differences mix both sides
STEPS = 24  # of Gauss and Newton's method
STILL = 1e-13  # rad
UNEXPLAINED = 0.25  # share of the square of an error: a cause that explains it leaves less
RAISED = 1e-4  # mm by which metal is raised for the gain of the motion


class Felt(NamedTuple):
    """A contact with the metal at n shaft angles: the motion's error is `gain` (n,) times the deviation of `curve`.

    The deviation is at `places` (n,), parameters in rad; `normals` (n, 2) are the metal's outward normals there.
    """

    curve: Smooth
    places: Array
    gain: Array
    normals: Array


class Influence(NamedTuple):
    """Uncertainties of a weighted sum of a motion's errors, in its unit.

    sd            standard deviation by the noise of the points
    worst         what a mm of metal adds, with its sign the worst at every place
    shifted (2,)  what a mm of shift of the metal adds, along x and along y
    """

    sd: float
    worst: float
    shifted: Array


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of a motion at shaft angles (n,), with their standard deviations; mm or rad, derivatives by rad.

    shaft (n,)       shaft angles, rad
    rows (3, n)      error, its velocity and its acceleration, which is nan about breaks of the motion, where it jumps
    sds (3, n)       standard deviations by the noise of the points
    gain (n,)        change of the position per mm more of metal
    intended (3, n)  the intended position, velocity and acceleration
    felt             contacts with the metal, of which the error is the sum
    sound (n,)       whether the metal that is touched has no local fault
    """

    shaft: Array
    rows: Array
    sds: Array
    gain: Array
    intended: Array
    felt: tuple[Felt, ...]
    sound: Mask

    @property
    def offset(self) -> float:
        """Mean error over the turn, mm or rad: assembly sets it to 0."""
        return float(self.rows[0].mean())

    @property
    def remaining(self) -> Array:
        """Error less the offset (n,), mm or rad."""
        remaining: Array = self.rows[0] - self.offset
        return remaining

    @property
    def phase(self) -> tuple[float, Array]:
        """Turn of the metal, rad ccw as drawn, that explains most of the error, and the remaining error (n,).

        The turn is that of the sound metal, without local faults, which remain.
        """
        turn, remaining = self._least_squares_turn(0.0)
        square = float(remaining @ remaining)
        if square > UNEXPLAINED * float(self.remaining @ self.remaining):  # a turn of many degrees
            made = np.fft.rfft(self.intended[0] + self.rows[0])
            likeness = np.fft.irfft(made * np.conj(np.fft.rfft(self.intended[0])), len(self.shaft))
            other = self._least_squares_turn(math.remainder(int(np.argmax(likeness)) * TURN / len(self.shaft), TURN))
            if float(other[1] @ other[1]) < UNEXPLAINED * square:
                return other
        return turn, remaining

    def _least_squares_turn(self, turn: float) -> tuple[float, Array]:
        """Turn of least squares near `turn`, rad, and the remaining error (n,) less its mean: Gauss and Newton."""
        made = self.intended[0] + self.rows[0]
        for _ in range(STEPS):
            position, velocity = self._intended(self.shaft - turn)
            column, remaining = self._without_mean(velocity), made - position
            square = float(column @ column)
            step = float(column @ remaining) / square if square > 0.0 else 0.0
            turn += step
            if abs(step) < STILL:
                break
        remaining = made - self._intended(self.shaft - turn)[0]
        return turn, remaining - remaining.mean()

    def _intended(self, shaft: Array) -> tuple[Array, Array]:
        """Intended position and velocity at shaft angles (n,), by Hermite's cubics between the known angles."""
        step = TURN / len(self.shaft)
        place = np.mod((shaft - self.shaft[0]) / step, len(self.shaft))
        first = np.minimum(place.astype(np.intp), len(self.shaft) - 1)
        u, then = place - first, (first + 1) % len(self.shaft)
        (a, b), (p, q) = self.intended[0][[first, then]], step * self.intended[1][[first, then]]
        c, d = 3.0 * (b - a) - 2.0 * p - q, 2.0 * (a - b) + p + q
        return a + u * (p + u * (c + u * d)), (p + u * (2.0 * c + 3.0 * u * d)) / step

    @property
    def phase_weights(self) -> Array:
        """Weights (n,) of the errors in the turn of least squares, rad per mm or rad; all 0 without motion."""
        column = self._without_mean(self.intended[1])
        square = float(column @ column)
        weights: Array = column / square if square > 0.0 else np.zeros_like(column)
        return weights

    def _without_mean(self, velocity: Array) -> Array:
        """What a turn of a rad makes of the position (n,), by velocities (n,), less its mean; 0 on faulty metal."""
        column: Array = np.where(self.sound, velocity[self.sound].mean() - velocity, 0.0)
        return column

    def influence(self, weights: Array) -> Influence:
        """Uncertainties of the sum of the errors times weights (n,)."""
        shares = [(felt, weights * felt.gain) for felt in self.felt]
        sd = math.sqrt(sum(felt.curve.deviation_of_sum(felt.places, share) ** 2 for felt, share in shares))
        shifted: Array = np.sum([share @ felt.normals for felt, share in shares], axis=0)
        return Influence(sd, float(sum(np.abs(share).sum() for _, share in shares)), shifted)

    def uncertainty(self, systematic: Array | float = 0.0) -> Array:
        """Expanded uncertainty (k = 2) of the error (n,); `systematic` is one of the metal common to all, mm."""
        expanded: Array = np.hypot(COVERAGE * self.sds[0], np.abs(self.gain) * systematic)
        return expanded

    @property
    def peak_acceleration(self) -> tuple[float, float]:
        """Greatest |acceleration|, mm or rad by rad^2 of shaft, that the part gives, and the greatest intended one."""
        acceleration = self.intended[2] + self.rows[2]
        intended = self.intended[2][np.isfinite(acceleration)]
        return float(np.nanmax(np.abs(acceleration))), float(np.abs(intended).max())


@dataclass(frozen=True, eq=False)
class MadePlay:
    """Play `gap` (n,) of a follower between opposite contacts at shaft angles (n,), rad, and its standard deviations.

    It is in mm or rad, below 0 where the contacts interfere. `gain` (n,) is its change per mm of metal, with the sign
    the worst at either contact, `shifted` (n,) that per mm of shift of the metal in the worst direction.
    """

    shaft: Array
    gap: Array
    sds: Array
    gain: Array
    shifted: Array

    def uncertainty(self, error: float = 0.0, shift: float = 0.0) -> Array:
        """Expanded uncertainty (k = 2) of the gap (n,), by that of the metal and of its shift, mm."""
        expanded: Array = np.sqrt((COVERAGE * self.sds) ** 2 + (self.gain * error) ** 2 + (self.shifted * shift) ** 2)
        return expanded


def metal_of(follower: Follower, side: Side, curve: Smooth) -> Metal:
    """Metal off the exact contour by a smoothed deviation, mm, above 0 for too much metal.

    `side` is 1 for metal inside the contour, -1 outside.
    """
    return Metal.of(follower, side, lambda t: curve.rows(t, 1), curve.spans)


def step_of(curve: Smooth) -> float:
    """Step, rad of shaft, of the differences by which the derivatives of a curve's effect on the motion are taken."""
    return min(STEP_SHARE * TURN / curve.spans, MOST_STEP)


def positions_about(metal: Metal, shaft: Array, step: float) -> tuple[Array, Array]:
    """Effect of the metal on each contact's position, mm or rad, and the parameters touched, (c, 5, n) each.

    They are at five shaft angles in steps about each of those given (n,). Raises ContactError where a contact finds no
    metal.
    """
    every = (shaft + step * np.array(OFFSETS)[:, None]).ravel()
    positions, places = metal.positions(every)
    shape = (len(positions), len(OFFSETS), -1)
    return (positions - metal.follower.intended(every)).reshape(shape), places.reshape(shape)


def derivatives_of(errors: Array, step: float) -> Array:
    """Value and two derivatives (c, 3, n) at the third of five values (c, 5, n) that are a `step`, rad, apart."""
    return np.stack([errors[:, 2], FIRST @ errors / step, SECOND @ errors / step**2], axis=1)


def contact_errors(
    follower: Follower,
    side: Side,
    curve: Smooth,
    shaft: Array,
    turned_by: float = 0.0,
    *,
    faults: Sequence[LocalFault] = (),
) -> list[Errors]:
    """Motion errors at shaft angles (n,), rad, by each contact, on metal turned by `turned_by`, rad, counter-clockwise.

    `side` is 1 for metal inside the contour, -1 outside; the metal lies off it by `curve`, mm, above 0 for too much
    metal; `faults` are its local ones. Raises ContactError where a contact finds no metal.
    """
    step, metal, angle = step_of(curve), metal_of(follower, side, curve), shaft - turned_by
    errors, places = positions_about(metal, angle, step)
    raised, lowered = (metal.raised(height).positions(angle)[0] for height in (RAISED, -RAISED))
    breaks = _beside(angle, follower.motion.breaks, BESIDE * step)
    intended = follower.motion.derivatives(shaft, 2)[:3]
    by_turn = follower.motion.derivatives(angle, 2)[:3] - intended
    breaks |= _beside(shaft, follower.motion.breaks, BESIDE * step)
    contacts = []
    for k, rows in enumerate(derivatives_of(errors, step) + by_turn):
        rows[2, breaks] = np.nan
        place = np.unwrap(places[k], axis=0, period=TURN)
        rate = np.abs(FIRST @ place / step)
        gain = (raised[k] - lowered[k]) / (2.0 * RAISED)
        sds = np.stack([np.abs(gain) * rate**q * curve.standard_deviations(place[2], q) for q in range(3)])
        normals = turned(side * follower.envelope.frames(place[2]).normals, np.array(turned_by))
        felt, sound = Felt(curve, place[2], gain, normals), ~within(faults, place[2])
        contacts.append(Errors(shaft, rows, sds, gain, intended, (felt,), sound))
    return contacts


def _beside(shaft: Array, breaks: Array, width: float) -> NDArray[np.bool_]:
    """Whether shaft angles (n,) lie within a `width`, rad, of a break."""
    if not len(breaks):
        return np.zeros(len(shaft), dtype=bool)
    ring = np.sort(np.mod(breaks, TURN))
    ring = np.concatenate([ring[-1:] - TURN, ring, ring[:1] + TURN])
    at = np.mod(shaft, TURN)
    after = np.clip(np.searchsorted(ring, at), 1, len(ring) - 1)
    near: NDArray[np.bool_] = np.minimum(at - ring[after - 1], ring[after] - at) <= width
    return near


def between(pushing: Errors, stopping: Errors) -> tuple[Errors, MadePlay]:
    """Motion midway between two opposite contacts, and their play; `pushing` bounds the position from below."""
    rows = 0.5 * (pushing.rows + stopping.rows)
    sds = 0.5 * np.hypot(pushing.sds, stopping.sds)
    gap = stopping.rows[0] - pushing.rows[0]
    gain = np.maximum(np.abs(pushing.gain), np.abs(stopping.gain))
    felt = tuple(half._replace(gain=0.5 * half.gain) for half in (*pushing.felt, *stopping.felt))
    middle = Errors(pushing.shaft, rows, sds, gain, pushing.intended, felt, pushing.sound & stopping.sound)
    either = np.abs(pushing.gain) + np.abs(stopping.gain)
    (push,), (stop,) = pushing.felt, stopping.felt
    shifted = np.linalg.norm(stop.gain[:, None] * stop.normals - push.gain[:, None] * push.normals, axis=1)
    return middle, MadePlay(pushing.shaft, gap, np.hypot(pushing.sds[0], stopping.sds[0]), either, shifted)


def paired(follower: Follower, errors: Sequence[Errors]) -> tuple[Errors, MadePlay | None]:
    """Motion errors of a follower on one surface, from those by each contact, and its play; None for one contact."""
    if len(errors) == 1:
        return errors[0], None
    first, second = errors if follower.contacts[0].sense > 0 else (errors[1], errors[0])
    return between(first, second)


@dataclass(frozen=True, eq=False)
class OutputErrors:
    """Errors of a mechanism's output over the relative angle (n,): centred in its frame, and the worst way it may rest.

    shaft (n,)     shaft angle, rad
    centred (n,)   mm or rad
    worst (n,)     of greatest size among the ways in which the frame may rest, mm or rad
    sds (n,)       standard deviation of the centred one
    gain (n,)      its change per mm of metal, with the sign the worst at each face
    rate (n,)      derivative of the intended output by the shaft angle
    """

    shaft: Array
    centred: Array
    worst: Array
    sds: Array
    gain: Array
    rate: Array

    def uncertainty(self, systematic: float = 0.0, turn: float = 0.0) -> Array:
        """Expanded uncertainty (k = 2) of the output (n,), by that of the metal, mm, and of its turn, rad, besides."""
        expanded: Array = np.sqrt((COVERAGE * self.sds) ** 2 + (self.gain * systematic) ** 2 + (self.rate * turn) ** 2)
        return expanded


def output_errors(
    mechanism: Mechanism, follower: Follower, curve: Smooth, relative: Array, overlap: float = 0.0
) -> OutputErrors:
    """Errors of a linkage's output, rad or mm, with its square frame on the metal, at relative angles (n,).

    `overlap`, mm, is the intended interference at each face. Raises FrameError where the frame binds.
    """
    metal = metal_of(follower, 1, curve)
    ring = np.stack([metal.positions(relative + k * QUARTER)[0][0] - overlap for k in range(4)])

    def output(first: float, second: float, reach: Array) -> tuple[Array, Array]:
        s = first * reach[0] + (1.0 - first) * (mechanism.breadth - reach[2])
        s1 = second * reach[1] + (1.0 - second) * (mechanism.breadth - reach[3])
        shaft, position = driven(mechanism, relative, s[None], s1[None])[:, 0]
        off = position - mechanism.at(mechanism.relative(shaft), 0).output[0]
        return shaft, off - TURN * np.round(off / TURN) if mechanism.unit == "deg" else off

    shaft, centred = output(CENTRED.first, CENTRED.second, ring)
    ways = np.stack([output(way.first, way.second, ring)[1] for way in WAYS])
    worst = np.take_along_axis(ways, np.abs(ways).argmax(axis=0)[None], axis=0)[0]
    square, gain = np.zeros_like(centred), np.zeros_like(centred)
    for face in range(4):
        moved = ring.copy()
        moved[face] += RAISED
        own = np.abs(output(CENTRED.first, CENTRED.second, moved)[1] - centred) / RAISED
        square += (own * curve.standard_deviations(relative + face * QUARTER)) ** 2
        gain += own
    intended = mechanism.at(relative, 1)
    return OutputErrors(shaft, centred, worst, np.sqrt(square), gain, intended.output[1] / intended.shaft[1])


def least_fault(sigma: float, squares: float, places: int) -> float:
    """Least height, mm, of a fault that is found in 95 % of parts, where noise alone gives one in 5 %.

    `sigma` is the standard deviation of the noise, mm. `squares` is the sum of squares over the points of the fault's
    shape with peak 1, `places` the number of places at which such a fault is looked for.
    """
    from statistics import NormalDist

    normal = NormalDist()
    z = normal.inv_cdf(1.0 - 0.05 / (2.0 * max(places, 1)))
    return (z + normal.inv_cdf(0.95)) * sigma / math.sqrt(squares)
