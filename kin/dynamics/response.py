"""The exact response of a damped oscillator to a drive: z'' + 2 a z' + r^2 z = g, stretch by stretch.

z = x - s is the follower's place relative to the cam, so g = -s'' - kappa s - f and nothing of s itself is lost in
rounding where the train is stiff. On each stretch z = p + h: p is a polynomial that depends on the drive alone, h the
free motion that takes up the difference to the state at the start, known in closed form. A jump of s' is one of z'.

p is found in one of two ways.

slow      where a stretch lasts long against the free motion: the polynomial solution itself, by back substitution in
          1 + (2 a/r^2) d + (1/r^2) d^2, whose matrix over Chebyshev coefficients is upper triangular with diagonal 1.
at rest   elsewhere, on parts of at most LONGEST radians of free motion to each side: the solution with p = p' = 0 at
          the start, from the integral equation for p'' (Greengard 1991), which is well conditioned.

Neither has a time step: their number is that of the drive's stretches, times a bounded number of parts.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.dynamics.oscillator import Free
from kin.numeric.chebyshev import AT_START, DEGREE, DERIVATIVE, INTEGRAL, degrees, value
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.dynamics.drive import Drive
    from kin.dynamics.oscillator import Oscillator
    from kin.numeric.arrays import Array, Indices


LONGEST = 4.0  # radians of free motion in half a stretch, see kin.numeric.chebyshev
_ROOM = 0.25  # times the degree squared: half a stretch's radians from which the slow solution loses no digits
_LEAST_SLOW = 8.0
_NOISE = 2e-16  # coefficients below this share of the greatest are rounding
_MOST_PARTS = 100_000
_PASSES = 2
_STEP = 0.25  # radians of free motion between samples
_SAMPLES = 33  # of a stretch, at least
_SILENT = 1e-11  # a free motion below this share of all else is not sampled for


class StiffnessError(CamgeoError, ValueError):
    """A response that needs too many parts: damping so strong that one rate of decay lies far below the other."""


class ResponsePlaces(NamedTuple):
    """Places in time order: stretch (n,) and time since its start (n,), rad of shaft."""

    stretch: Indices
    time: Array


@dataclass(frozen=True, eq=False)
class Forcing:
    """g = -s'' - kappa s - f: `kappa` is k_p/(m W^2) by the preload spring's rate, `constant` f = F/(m W^2)."""

    kappa: float = 0.0
    constant: float = 0.0

    def series(self, drive: Drive) -> Array:
        """Chebyshev series (m, DEGREE + 1) of g over the drive's stretches, by radian of shaft squared."""
        series: Array = -drive.acceleration
        if self.kappa:
            series = series - self.kappa * drive.position
        series[:, 0] -= self.constant
        return series


@dataclass(frozen=True, eq=False)
class Response:
    """Response z = p + h to a drive, already cut into m stretches as the oscillator needs it; states are (z, z').

    p, v (m, DEGREE + 1)  Chebyshev series of p and p'
    slow (m,)             whether p is the slow solution on a stretch, else it starts at rest
    """

    oscillator: Oscillator
    drive: Drive
    p: Array
    v: Array
    slow: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.p)

    @cached_property
    def half(self) -> Array:
        """Half widths of the stretches (m,), rad."""
        return self.drive.half

    @cached_property
    def _steps(self) -> tuple[Array, Array, Array]:
        """Per stretch: p and p' at its start (m, 2) and end (m, 2), and the propagator of the free motion (m, 4)."""
        at_start = np.stack([self.p @ AT_START, self.v @ AT_START], axis=1)
        at_end = np.stack([self.p.sum(axis=1), self.v.sum(axis=1)], axis=1)
        matrix = np.stack(self.oscillator.propagator(np.diff(self.drive.knots)), axis=1)
        return at_start, at_end, matrix

    @property
    def ends(self) -> tuple[Array, Array]:
        """Rows (p, p') (m, 2) at the starts of the stretches, then such rows (m, 2) at their ends."""
        return self._steps[:2]

    def starts(self, state: Array, first: int, count: int) -> Array:
        """States (2, count) at the starts of the stretches `first`, `first` + 1, ..., after the drive's jumps there.

        `state` (2,) is the state at the end of the stretch before, before the jump at the first.
        """
        return self._run(state, first, count)[0]

    def end(self, state: Array, first: int, count: int) -> Array:
        """State (2,) at the end of `count` stretches from `first` on; `state` (2,) is that before the first jump."""
        return self._run(state, first, count)[1]

    @cached_property
    def _plain_steps(self) -> list[tuple[list[float], list[float], list[float], float]]:
        """For each stretch the rows of `_steps`, and the drive's jump."""
        return list(zip(*(part.tolist() for part in (*self._steps, self.drive.jumps)), strict=True))

    def _run(self, state: Array, first: int, count: int) -> tuple[Array, Array]:
        z, v = float(state[0]), float(state[1])
        states = []
        for (p0, v0), (p1, v1), (zz, zv, vz, vv), jump in self._plain_steps[first : first + count]:
            v -= jump
            states.append((z, v))
            z, v = z - p0, v - v0
            z, v = p1 + zz * z + zv * v, v1 + vz * z + vv * v
        return np.array(states).T.reshape(2, -1), np.array([z, v])

    def free(self, stretch: int, time: float, state: Array) -> Free:
        """The free motion on a stretch from the state (2,) at a time, rad since its start."""
        p, v = self._driven(stretch, time)
        return Free(self.oscillator, time, float(state[0]) - p, float(state[1]) - v)

    def _driven(self, stretch: int, time: float) -> tuple[float, float]:
        x = time / self.half[stretch] - 1.0
        return value(self.p[stretch].tolist(), x), value(self.v[stretch].tolist(), x)

    def moved(self, stretch: int, free: Free, time: float) -> Array:
        """State (z, z') (2,) at a time, rad since the start of a stretch: free motion plus p."""
        p, v = self._driven(stretch, time)
        z, rate = free.after(time)
        return np.array([p + z, v + rate])

    def periodic(self) -> Array:
        """State (2,) at the start of a turn, before any jump there, that returns at its end; ValueError at resonance.

        The second pass starts where free motion is small already, so that its phase, good to r eps, does not limit the
        result.
        """
        state = np.zeros(2)
        for _ in range(_PASSES):
            state = state + self.oscillator.periodic(self.end(state, 0, len(self)) - state)
        return state

    def lasting(self, bound: Array, stretches: Indices) -> Array:
        """Time (n,), rad, after which a free motion of size `bound` (n,) on stretches (n,) has faded below notice.

        That is a fixed share of the greatest p plus the greatest bound of these stretches. The time is 0 where p is not
        the slow solution, and inf without damping.
        """
        size = _SILENT * (np.abs(self.p[stretches]).sum(axis=1).max(initial=0.0) + bound.max(initial=0.0))
        alive = self.slow[stretches] & (bound > size)
        times = np.where(alive, np.inf, 0.0)
        if self.oscillator.fading > 0.0:
            times[alive] = np.log(bound[alive] / size) / self.oscillator.fading
        return times

    @property
    def step(self) -> float:
        """Time, rad of shaft, between samples that show every swing of the free motion; infinite for no free motion."""
        return _STEP / self.oscillator.fast if self.oscillator.fast > 0.0 else np.inf

    def swings(self, starts: Array, stretches: Indices) -> tuple[Array, Indices]:
        """Time (n,), rad, for which free motion is sampled on stretches (n,), and how many samples (n,) that takes.

        `starts` (2, m) are the states at the starts of all stretches. These samples come on top of those that every
        stretch has; time and number are 0 where p is not the slow solution.
        """
        bound = self.oscillator.bound((starts - self._steps[0].T)[:, stretches])
        lasting = np.minimum(self.lasting(bound, stretches), 2.0 * self.half[stretches])
        fine = np.where(lasting > 0.0, np.ceil(lasting / self.step) + 1.0, 0.0).astype(np.intp)
        return lasting, fine

    def samples(self, starts: Array, stretches: Indices) -> ResponsePlaces:
        """Places that show every swing of z on stretches (n,), ends included, from states (2, m) at all starts."""
        width = 2.0 * self.half[stretches]
        lasting, fine = self.swings(starts, stretches)
        counts = fine + _SAMPLES
        owner = np.repeat(np.arange(len(stretches)), counts)
        number = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
        time = width[owner] * number / (_SAMPLES - 1)
        if fine.any():
            swinging = lasting[owner] * (number - _SAMPLES + 1) / (fine[owner] + 1.0)
            time = np.where(number < _SAMPLES, time, swinging)
            time = time[np.lexsort((time, owner))]
        return ResponsePlaces(stretches[owner], time)


def response(oscillator: Oscillator, drive: Drive, forcing: Forcing) -> Response:
    """Cut the drive as the oscillator needs it and find p on every stretch.

    Raises StiffnessError where that takes more than 100 000 parts.
    """
    # the slow solution loses no digits where a stretch is long against the free motion and g is of low degree
    half = drive.half
    series = forcing.series(drive)
    noise = _NOISE * float(np.abs(series).max(initial=0.0))
    degree = degrees(series, noise)
    slow = oscillator.slow * half >= np.maximum(_LEAST_SLOW, _ROOM * degree**2)
    parts = np.where(slow, 1, np.ceil(oscillator.fast * half / LONGEST)).astype(np.int64)
    parts = np.maximum(parts, 1)
    if parts.sum() > _MOST_PARTS:
        raise StiffnessError(
            f"{int(parts.sum())} parts of a turn are needed: the rates of decay, {oscillator.slow:.3g} and "
            f"{oscillator.fast:.3g} by radian, lie too far apart"
        )
    parts = parts.astype(np.intp)
    drive = drive.split(parts)
    owner = np.repeat(np.arange(len(parts)), parts)
    slow = slow[owner]
    g = forcing.series(drive)
    half = drive.half
    p, v = np.zeros_like(g), np.zeros_like(g)
    g[slow] = np.where(np.abs(g[slow]) > noise, g[slow], 0.0)
    if slow.any():
        p[slow], v[slow] = _slow(oscillator, g[slow], half[slow])
    if not slow.all():
        p[~slow], v[~slow] = _from_rest(oscillator, g[~slow], half[~slow], owner[~slow])
    return Response(oscillator, drive, p, v, slow)


_EYE = np.eye(DEGREE + 1)
_INTEGRALS = np.stack([INTEGRAL, INTEGRAL @ INTEGRAL])


def _slow(oscillator: Oscillator, g: Array, half: Array) -> tuple[Array, Array]:
    """Series (k, DEGREE + 1) of the slow solution p and of p' for the forces g (k, DEGREE + 1); half widths (k,)."""
    first = (2.0 * oscillator.decay / oscillator.square / half)[:, None, None]
    second = (1.0 / oscillator.square / half**2)[:, None, None]
    matrix = _EYE + first * DERIVATIVE + second * (DERIVATIVE @ DERIVATIVE)
    p = np.asarray(np.linalg.solve(matrix, g[:, :, None] / oscillator.square)[:, :, 0], dtype=np.float64)
    v: Array = (p @ DERIVATIVE.T) / half[:, None]
    return p, v


def _from_rest(oscillator: Oscillator, g: Array, half: Array, owner: Indices) -> tuple[Array, Array]:
    """Series of the solution p and of p', both 0 at the start, for the forces g, (k, DEGREE + 1) each.

    `half` (k,) are half widths, alike for the parts of one `owner` (k,), rising, whose matrix they share.
    """
    first = np.flatnonzero(np.diff(owner, prepend=-1))
    scale = half[first]
    factors = np.stack([2.0 * oscillator.decay * scale, oscillator.square * scale**2], axis=1)
    matrix = _EYE + (factors @ _INTEGRALS.reshape(2, -1)).reshape(-1, *_EYE.shape)
    counts = np.diff(first, append=len(owner))
    bend = np.empty_like(g)
    for count in np.unique(counts).tolist():
        alike = counts == count
        rows = first[alike, None] + np.arange(count)
        bend[rows] = np.linalg.solve(matrix[alike], g[rows].swapaxes(1, 2)).swapaxes(1, 2)
    once, twice = _INTEGRALS
    p: Array = (bend @ twice.T) * half[:, None] ** 2
    v: Array = (bend @ once.T) * half[:, None]
    return p, v
