"""The damped oscillator z'' + 2 a z' + r^2 z = 0 in closed form, whatever the damping and however long the time.

Every form here is a sum of terms of one sign, or a difference that is small only where the motion itself passes through
zero: no cosh overflows, nothing cancels near critical damping, and the return after a period keeps its digits close to
resonance. Time and rates may be in any unit; the dynamics of a cam take radians of shaft angle.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array


class Propagator(NamedTuple):
    """Matrix that takes a state (z, z') over a time: z = zz z0 + zv v0, z' = vz z0 + vv v0; each entry (n,)."""

    zz: Array
    zv: Array
    vz: Array
    vv: Array


@dataclass(frozen=True)
class Oscillator:
    """Oscillator z'' + 2 a z' + r^2 z = 0 of the `decay` a and the `square` r^2; with 0 and 0 it is a free mass.

    Raises ValueError for figures below 0 or not finite.
    """

    decay: float
    square: float

    def __post_init__(self) -> None:
        if not (0.0 <= self.decay < math.inf and 0.0 <= self.square < math.inf):
            raise ValueError(f"decay {self.decay!r} and squared frequency {self.square!r} must be finite, 0 or above")

    @cached_property
    def natural(self) -> float:
        """Undamped natural frequency r, radians per unit of time."""
        return math.sqrt(self.square)

    @cached_property
    def swings(self) -> bool:
        """Whether it is underdamped."""
        return self.decay < self.natural

    @cached_property
    def split(self) -> float:
        """Damped frequency if it swings, else half the difference of the two rates of decay; rad per unit of time."""
        return math.sqrt(abs(self.natural - self.decay) * (self.natural + self.decay))

    @cached_property
    def fast(self) -> float:
        """Greater modulus of the two roots of lambda^2 + 2 a lambda + r^2 = 0, per unit of time."""
        return self.natural if self.swings else self.decay + self.split

    @cached_property
    def slow(self) -> float:
        """Lesser modulus of the two roots of lambda^2 + 2 a lambda + r^2 = 0, per unit of time."""
        return self.natural if self.swings else self._gentle

    @cached_property
    def fading(self) -> float:
        """Rate of decay, per unit of time, of the slower part of a free motion; 0 without damping."""
        return self.decay if self.swings else self._gentle

    @cached_property
    def _gentle(self) -> float:
        # a - sqrt(a^2 - r^2), which would cancel
        return self.square / (self.decay + self.split) if self.square else 0.0

    @property
    def weights(self) -> tuple[float, float]:
        """Numbers p and q, per unit of time, by which the two motions C and S of `basis` make the propagator.

        It is zz = C + p S, zv = S, vz = -r^2 S, vv = C - q S.
        """
        if self.swings:
            return self.decay, self.decay
        return self.decay + self.split, self._gentle if self.split else self.decay

    def basis(self, time: Array) -> tuple[Array, Array]:
        """Values (n,) of two motions C and S at times (n,), 0 or above, of which every free motion is a combination.

        Underdamped, e^(-at) cos bt and e^(-at) sin(bt)/b; else e^(-(a + b) t) and e^(-at) sinh(bt)/b; b is `split`.
        """
        a, b = self.decay, self.split
        if self.swings:
            fade, phase = np.exp(-a * time), b * time
            return fade * np.cos(phase), fade * np.sin(phase) / b
        x = 2.0 * b * time
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(x > 0.0, -np.expm1(-x) / np.where(x > 0.0, x, 1.0), 1.0)
        return np.exp(-(a + b) * time), np.exp(-self._gentle * time) * time * share

    def basis_at(self, time: float) -> tuple[float, float]:
        """Values of the motions C and S of `basis` at one time, 0 or above, as plain floats: searches call it often."""
        a, b = self.decay, self.split
        if self.swings:
            fade, phase = math.exp(-a * time), b * time
            return fade * math.cos(phase), fade * math.sin(phase) / b
        x = 2.0 * b * time
        share = -math.expm1(-x) / x if x > 0.0 else 1.0
        return math.exp(-(a + b) * time), math.exp(-self._gentle * time) * time * share

    def propagator(self, time: Array) -> Propagator:
        """Propagator over times (n,), 0 or above: the matrix that takes a state to the state after that time."""
        cosine, sine = self.basis(time)
        p, q = self.weights
        return Propagator(cosine + p * sine, sine, -self.square * sine, cosine - q * sine)

    def factors(self, states: Array, z: float, v: float) -> tuple[Array, Array]:
        """Factors (n,) of C and S of `basis` in the figure z * place + v * rate of free motions from states (2, n)."""
        p, q = self.weights
        place, rate = states
        return z * place + v * rate, z * (p * place + rate) - v * (self.square * place + q * rate)

    def bound(self, states: Array) -> Array:
        """Bound (n,) of |z| over all later times, from states (2, n); it decays with `fading` where it swings."""
        z, v = states
        b = self.split
        if self.swings:
            ever: Array = np.hypot(z, (v + self.decay * z) / b)
            return ever
        # z = E z0 + S (v0 + (a + b) z0), with E at most 1 and S at most 1/(a + b)
        with np.errstate(divide="ignore", invalid="ignore"):
            rate = self.decay + b
            later: Array = np.abs(z) + (np.abs(v + rate * z) / rate if rate else np.where(v == 0.0, 0.0, np.inf))
        return later

    @property
    def amplification(self) -> float:
        """Greatest |r^2 z| that a force of modulus at most 1 can ever drive up: the integral of |r^2 kernel|.

        It is coth(pi a/(2 b)) for an oscillator that swings, infinite without damping, and 1 for any other.
        """
        if not self.swings:
            return 1.0
        x = 0.5 * math.pi * self.decay / self.split
        return 1.0 / math.tanh(x) if x > 0.0 else math.inf

    @property
    def detuning(self) -> float:
        """|1 - e^(lambda T)| of the root that comes closest to 0, with T one turn: 0 at resonance without damping."""
        if not self.swings:
            return -math.expm1(-self._gentle * TURN)
        left = math.expm1(-self.decay * TURN)
        return math.hypot(left, 2.0 * math.exp(-0.5 * self.decay * TURN) * _sine_of_half_turns(self.split))

    def periodic(self, gained: Array) -> Array:
        """State y (2,) that returns after a turn: (1 - Phi) y = `gained` (2,), the end of a turn that begins at rest.

        Phi is the propagator over a turn.

        Raises ValueError where `detuning` is 0.
        """
        a, b = self.decay, self.split
        zz, zv, vz, vv = (float(part[0]) for part in self.propagator(np.array([TURN])))
        if self.swings:
            determinant = self.detuning**2
        else:
            determinant = math.expm1(-self._gentle * TURN) * math.expm1(-(a + b) * TURN)
        if determinant == 0.0:
            raise ValueError("a turn brings every free motion back to itself")
        z, v = gained
        return np.array([(1.0 - vv) * z + zv * v, vz * z + (1.0 - zz) * v]) / determinant


@dataclass(frozen=True)
class Free:
    """The free motion from a state (z, v) at the time `since`: a sum of the motions C and S of `Oscillator.basis`."""

    oscillator: Oscillator
    since: float
    z: float
    v: float

    def summed(self, z: float, v: float) -> tuple[float, float]:
        """Factors of C and S in the figure z * place + v * rate."""
        p, q = self.oscillator.weights
        sine_factor = z * (p * self.z + self.v) + v * (-self.oscillator.square * self.z - q * self.v)
        return z * self.z + v * self.v, sine_factor

    def after(self, time: float) -> tuple[float, float]:
        """State (z, z') at a time, counted as `since` is and no earlier."""
        cosine, sine = self.oscillator.basis_at(time - self.since)
        (a, b), (c, d) = self.summed(1.0, 0.0), self.summed(0.0, 1.0)
        return a * cosine + b * sine, c * cosine + d * sine


def _sine_of_half_turns(x: float) -> float:
    """sin(pi x), with x reduced by whole turns without rounding."""
    return math.sin(math.pi * (x - 2.0 * round(0.5 * x)))
