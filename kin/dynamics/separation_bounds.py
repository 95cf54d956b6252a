"""Whether contact holds under a preload spring over a range of shaft speeds, by bounds on the least contact force.

On each stretch the steady state is z = q + h, where q is known and smooth over the speed: the slow polynomial solution,
or g/r^2 or so. h is what kicks leave: the leaps of q and q' at the knots, those of the drive's velocity, and what q
leaves of g. With w = exp(lambda 2 pi), lambda = -a + ib, and kicks c_j,

    h(phi) = Re of (sum of c_j exp(lambda (phi - phi_j)) over the last turn) / (1 - w)

so over b no phase in the sum moves by more than 2 pi, or pi to either side of the middle one: whatever the damping,
its size is known between two speeds from those there, but for (width pi)^2/8 times the sum of the moduli. 1 - w has a
closed form. So a resonance, however narrow, is not passed over. Where a turn leaves little of a kick, the sum is over
all kicks, faded: |d2/db2 exp(lambda t)| = t^2 exp(-at), each kick at its own age t. What goes with a power of the speed
alone, q and the size of the kicks, is allowed for with the fourth (a leap of s'' gives a force that goes with the
square, one of s''' with the third). Near critical damping and beyond there is no resonance, and all follows from how h
fades.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.dynamics.response import ResponsePlaces
from kin.dynamics.train import periodic
from kin.numeric.angles import TURN
from kin.numeric.chebyshev import AT_START, DERIVATIVE, ORDERS, polynomials
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.dynamics.drive import Drive
    from kin.dynamics.events import Work
    from kin.dynamics.oscillator import Oscillator
    from kin.dynamics.train import Train
    from kin.numeric.arrays import Array, Indices


PARTS = 32  # windows of a stretch
_EACH = 50  # places that a stretch costs to solve
_STEP = 0.25  # radians of free motion between samples
_POWER = math.sqrt(20.0)  # p (p + 1) of second derivatives: kicks grow with the power p = 4 of the speed at most
_PART = 8.0  # radians of free motion in a stretch that is not slow, at most: its kicks' own phase
_WINDOW = 2.0 / PARTS  # half widths of a stretch
_GRID = np.linspace(-1.0, 1.0, PARTS + 1)
_ON_GRID = polynomials(_GRID)
_AGES = np.linspace(0.0, 2.0, 9)  # half widths of a stretch, between which ages are bounded
_BLUNT = 0.9  # damping ratio from which a free motion is bounded as one that does not swing
_SUMS, _APART = (
    np.where(orders % 2.0, np.inf, orders) for orders in (ORDERS[:, None] + ORDERS, ORDERS[:, None] - ORDERS)
)
_SQUARED = 1.0 / (1.0 - _SUMS**2) + 1.0 / (1.0 - _APART**2)  # integrals of the products of two Chebyshev polynomials
_CURVED = ORDERS**2 * (ORDERS**2 - 1.0) / 3.0  # greatest second derivative of each Chebyshev polynomial


class Look:
    """Steady state of a train at one shaft speed, with proved lower bounds of its contact force, N or N m.

    Symbols q, h and b, and the kicks, are defined on top of the module; the response has m stretches. Figures that take
    places to find raise SpentError beyond what `work` permits.
    """

    def __init__(self, train: Train, drive: Drive, rpm: float, work: Work) -> None:
        self.train, self.rpm, self.work = train, rpm, work
        self._running = running = train.at(rpm)
        self.response = response = running.response(drive)
        work.take(_EACH * len(response))
        self.oscillator: Oscillator = response.oscillator
        self.b = train.ratio(rpm)  # natural frequency in turns of the shaft
        self._figure = running.force(response)
        self.swings = train.damping_ratio < _BLUNT
        self.fading = self.oscillator.fading if self.swings else 0.5 * self.oscillator.fading
        self.gain = self._gain()
        q, rate, left = self._particular(running.forcing.series(response.drive))
        slow = response.slow[:, None]
        self._q, self._rate = np.where(slow, response.p, q), np.where(slow, response.v, rate)
        size_of_rate = self._size(np.array([[0.0], [1.0]]))[0]
        self.inner = np.where(response.slow, 0.0, left * size_of_rate)

    def _particular(self, g: Array) -> tuple[Array, Array, Array]:
        """Series of a q that a push g moves and of q', (m, DEGREE + 1) each, and a bound (m,) of what q leaves of g.

        q is g/r^2, or g/r^2 - 2 a g'/r^4 if that leaves less. It leaves g - (q'' + 2 a q' + r^2 q), of whose modulus
        the integral over each stretch is bounded.
        """
        a, square, half = self.oscillator.decay, self.oscillator.square, self.response.half[:, None]
        first = g @ DERIVATIVE.T / half
        second = first @ DERIVATIVE.T / half
        third = second @ DERIVATIVE.T / half
        drag = 2.0 * a / square
        plain = self._integral(second / square + drag * first)
        dragged = self._integral((1.0 - 2.0 * a * drag) / square * second - drag / square * third)
        if float(plain.sum()) <= float(dragged.sum()):
            return g / square, first / square, plain
        return (g - drag * first) / square, (first - drag * second) / square, dragged

    def _integral(self, series: Array) -> Array:
        """Bound (m,) of the integral of a series' modulus over each stretch, from that of its square (Schwarz)."""
        integral: Array = self.response.half * np.sqrt(2.0 * np.maximum((series @ _SQUARED * series).sum(axis=1), 0.0))
        return integral

    def _size(self, states: Array) -> Array:
        """Bound (n,) of |k z + c z'| over all later times, by `gain`, from states (2, n); it fades with `fading`."""
        oscillator = self.oscillator
        if self.swings:
            return oscillator.bound(states)
        # z = E z0 + S (v0 + rate z0), with S at most t exp(-gt) and exp(-gt)/2b
        gentle, b, z, v = oscillator.fading, oscillator.split, *states
        rate = oscillator.decay if oscillator.swings else oscillator.decay + b
        longest = 2.0 / (math.e * gentle)
        if not oscillator.swings and b > 0.0:
            longest = min(longest, 0.5 / b)
        longest = max(longest, 1.0 / rate)
        # z' = -r^2 S z0 + S' v0
        drag = self.train.damping * self._running.speed / self.gain
        size: Array = np.abs(z) + longest * np.abs(v + rate * z)
        size += drag * (oscillator.square * longest * np.abs(z) + 1.25 * np.abs(v))
        return size

    def _gain(self) -> float:
        """Stiffness against free motion: |k + c lambda| where it swings."""
        k, c = self.train.stiffness, self.train.damping * self._running.speed
        a, b = self.oscillator.decay, self.oscillator.split
        return abs(k + c * complex(-a, b)) if self.swings else k

    @cached_property
    def leaps(self) -> Array:
        """Sizes (m,) of the kicks at the starts of the stretches; those on the stretches themselves are `inner`."""
        start = np.stack([self._q @ AT_START, self._rate @ AT_START])
        end = np.roll(np.stack([self._q.sum(axis=1), self._rate.sum(axis=1)]), 1, axis=1)
        leap = end - start
        leap[1] -= self.response.drive.jumps
        return self._size(leap)

    @cached_property
    def _series(self) -> Array:
        """Series of the force that goes with q."""
        series: Array = -self.train.stiffness * self._q - self.train.damping * self._running.speed * self._rate
        return series

    @cached_property
    def inertial(self) -> float:
        """Upper bound over the turn of |force that goes with q - force of the preload spring at x = s|, N or N m."""
        series = self._series - self.train.rate * self.response.drive.position
        series[:, 0] -= self.train.preload
        return float(np.abs(series).sum(axis=1).max())

    @cached_property
    def least_driven(self) -> Array:
        """Lower bound (m, 32) of the force that goes with q, on the windows of each stretch."""
        series = self._series
        at = series @ _ON_GRID
        sag = _WINDOW**2 / 8.0 * np.abs(series) @ _CURVED
        lowest: Array = np.minimum(at[:, :-1], at[:, 1:]) - sag[:, None]
        return lowest

    def moments(self, decay: float) -> Array:
        """Sums (3, m) of size * age^k, k = 0, 1, 2, of all kicks up to and at the start of each stretch; ages in rad.

        Their sizes fade by `decay` per rad. A kick on a stretch itself has the age of the stretch, and has not faded
        before its end.
        """
        widths = np.diff(self.response.drive.knots).tolist()
        kicks = list(zip(self.leaps.tolist(), self.inner.tolist(), widths, strict=True))
        left, leaving = math.exp(-decay * TURN), -math.expm1(-decay * TURN) or 1e-300
        size = first = second = 0.0
        sums: list[tuple[float, float, float]] = []
        for _ in range(2):  # the first turn begins from rest, the second from what all turns before it leave
            sums.clear()
            for leap, inner, width in kicks:
                size += leap
                sums.append((size, first, second))
                share = math.exp(-decay * width)
                second = share * (second + width * (2.0 * first + width * size)) + width**2 * inner
                first = share * (first + width * size) + width * inner
                size = share * size + inner
            size /= leaving
            first = (first + TURN * left * size) / leaving
            second = (second + TURN * left * (2.0 * first + TURN * size)) / leaving
        return np.array(sums).T

    @cached_property
    def ages(self) -> Array:
        """Sums (3, m) of size * age^k, k = 0, 1, 2, of all kicks, whose sizes fade by `fading`: see `moments`."""
        return self.moments(self.fading)

    @cached_property
    def turn(self) -> Array:
        """Sums (m,) of the sizes of the last turn's kicks, as faded at the start of each stretch."""
        turn: Array = -math.expm1(-TURN * self.fading) * self.ages[0]
        return turn

    @cached_property
    def states(self) -> Array:
        """States (z, z') (2, m) at the starts of all stretches.

        Raises DynamicsError where none is found that repeats each turn, as at resonance without damping.
        """
        return self.response.starts(periodic(self._running, self.response), 0, len(self.response))

    @cached_property
    def rung(self) -> Array:
        """Size (m,) of the free motion h at the start of each stretch."""
        start = np.stack([self._q @ AT_START, self._rate @ AT_START])
        return self._size(self.states - start)

    def lower_bound(self, rung: Array, driven: Array) -> Array:
        """Lower bounds of the contact force, N or N m, on 32 windows of each of the m stretches (m, 32).

        `rung` (m,) is the size of the free motion h at the start of each stretch, `driven` (m, 32) a lower bound of the
        force that belongs to q.
        """
        fade = np.exp(-self.fading * 2.0 * self.response.half[:, None] * np.arange(PARTS) / PARTS)
        least: Array = driven - self.gain * (rung[:, None] * fade + self.inner[:, None])
        return least

    @cached_property
    def surely(self) -> float:
        """Lower bound of the contact force over the turn, N or N m, whatever the phases of the kicks.

        It holds at this speed and at all lower ones.
        """
        return float(self.lower_bound(self.ages[0], self.least_driven).min())

    @cached_property
    def _forces(self) -> Array:
        """Contact force (m, 33), N or N m, at the ends of the windows of each stretch."""
        return self._figure.together(self.states, _GRID, _ON_GRID)

    @cached_property
    def lowest(self) -> Array:
        """Lower bounds of the contact force at this speed, N or N m, on 32 windows of each stretch (m, 32)."""
        response, oscillator = self.response, self.oscillator
        free = self.states - response.ends[0].T
        bend = -2.0 * oscillator.decay * free[1] - oscillator.square * free[0]
        bends = np.stack([bend, -2.0 * oscillator.decay * bend - oscillator.square * free[1]])
        sag = np.abs(self._figure.series) @ _CURVED + self.gain * self._size(bends) * response.half**2
        lowest: Array = np.minimum(self._forces[:, :-1], self._forces[:, 1:]) - (_WINDOW**2 / 8.0 * sag)[:, None]
        if response.slow.any():  # a window of theirs may hold many swings
            lowest[response.slow] = self.lower_bound(self._size(free), self.least_driven)[response.slow]
        return lowest

    @cached_property
    def seen(self) -> float:
        """Least contact force, N or N m, at the ends of the windows: `reached` is no greater, and hardly less."""
        return float(self._forces.min())

    @cached_property
    def least(self) -> float:
        """Least contact force over the turn, N or N m: a proved bound if above 0, else a force that is reached."""
        lowest = float(self.lowest.min())
        return lowest if lowest > 0.0 else self.reached

    @cached_property
    def reached(self) -> float:
        """Least contact force over the turn, N or N m, by samples and closer looks: a force that is reached."""
        windows = np.flatnonzero(self.lowest.ravel() <= self.seen)
        return self._figure.least(self.states, self._samples(windows))

    def _samples(self, windows: Indices) -> ResponsePlaces:
        """Places on windows (n,), rising numbers over all stretches, with a little more to either side."""
        stretch, part = np.divmod(windows, PARTS)
        begins = np.flatnonzero(np.diff(windows, prepend=-2) != 1)
        begins = np.union1d(begins, np.flatnonzero(np.diff(stretch, prepend=-1)))
        ends = np.append(begins[1:], len(windows)) - 1
        owner = stretch[begins]
        width = 2.0 * self.response.half[owner]
        step = np.minimum(width / PARTS, _STEP / self.oscillator.fast)
        low = np.maximum(width * part[begins] / PARTS - 4.0 * step, 0.0)
        high = np.minimum(width * (part[ends] + 1) / PARTS + 4.0 * step, width)
        count = np.ceil((high - low) / step).astype(np.intp) + 1
        self.work.take(2 * int(count.sum()))
        run = np.repeat(np.arange(len(owner)), count)
        number = np.arange(len(run)) - np.repeat(np.cumsum(count) - count, count)
        time = low[run] + (high - low)[run] * number / (count[run] - 1)
        return ResponsePlaces(owner[run], time)


@dataclass(frozen=True)
class Range:
    """A range of shaft speeds, from looks at its lower and its upper end."""

    low: Look
    high: Look

    @property
    def width(self) -> float:
        """Difference of the natural frequency, cycles per turn of the shaft, between the lower and the upper speed."""
        return self.low.b - self.high.b

    @property
    def sure(self) -> bool:
        """Whether contact is proved to hold at all speeds of the range, whatever the phases of the kicks."""
        return self.high.surely > 0.0

    @property
    def holds(self) -> bool:
        """Whether contact is proved to hold at all speeds of the range, by the looks at both ends."""
        if min(self.low.least, self.high.least) > self.between or self.by_size > 0.0:
            return True
        if not min(self.low.seen, self.high.seen) > self.between:
            return False
        return min(self.low.reached, self.high.reached) > self.between

    @cached_property
    def detuning(self) -> float:
        """Lower bound of |1 - w| over the range, w = exp(lambda 2 pi) the factor of a turn, for a train that swings."""
        low, high = self.low.oscillator, self.high.oscillator
        sine = 0.0
        if math.floor(low.split) < high.split:
            sine = min(abs(math.sin(math.pi * (b - round(b)))) for b in (low.split, high.split))
        left = math.exp(-TURN * low.decay)
        return math.hypot(math.expm1(-TURN * high.decay), 2.0 * math.sqrt(left) * sine)

    @cached_property
    def by_size(self) -> float:
        """Lower bound of the contact force at all speeds between, N or N m, by the size of h alone.

        It is -inf for a train without resonance.
        """
        low, high = self.low, self.high
        if not high.swings:
            return -math.inf
        sizes, driven = high.rung * high.oscillator.detuning, high.least_driven
        growth, power = self.width * (math.pi + _POWER / high.b), self.width * _POWER / high.b
        if np.array_equal(low.response.slow, high.response.slow):
            sizes = np.maximum(sizes, low.gain / high.gain * low.rung * low.oscillator.detuning)
            driven = np.minimum(driven, low.least_driven)
            growth, power = growth**2 / 8.0, power**2 / 4.0
        return (
            float(high.lower_bound((sizes + growth * high.turn) / self.detuning, driven).min()) - power * high.inertial
        )

    @cached_property
    def between(self) -> float:
        """Greatest drop, N or N m, of the force at any angle and speed between, below the lesser of both ends."""
        high = self.high
        power = _POWER / high.b
        if high.swings:
            # derivatives of exp(lambda t) by b, whose modulus is at most t exp(-at): each kick at its own age
            fade = np.exp(-high.fading * high.response.half[:, None] * _AGES[:-1])
            time = high.response.half[:, None] * _AGES[1:] + power
            size, first, second = high.ages[:, :, None]
            aged = fade * (second + time * (2.0 * first + time * size)) + high.inner[:, None] * time**2
            # of a turn's kicks, by derivatives of exp(lambda t)/(1 - w)
            share = math.exp(-TURN * high.fading) / self.detuning
            rate = (TURN + power) ** 2 * (1.0 + share) * (1.0 + 2.0 * share)
            curved = min(float(aged.max()), float((high.turn + high.inner).max()) / self.detuning * rate)
        else:
            # lambda goes with b, and t^2 exp(-gt/4) is at most (8/eg)^2
            scale = 8.0 / (math.e * high.b) + _PART / high.b + power
            curved = float((high.moments(0.5 * high.fading)[0] + high.inner).max()) * scale**2
        return self.width**2 / 8.0 * (high.gain * curved + 2.0 * power**2 * high.inertial)
