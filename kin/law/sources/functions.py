"""Functions of which motions are made, in jet arithmetic; each is exact at the ends where it rests."""

from __future__ import annotations

from functools import partial
from math import comb, fsum
from typing import TYPE_CHECKING

from kin.law.segment import Alike
from kin.numeric.elementary import cos, sin
from kin.numeric.jet import horner
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Series, Stretch
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class Sines:
    """Sum of a (k u - sin k u) over the terms (k, a): at rest at u = 0 to the last bit."""

    terms: tuple[tuple[float, float], ...]

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind."""
        total = u.constant(0.0)
        for k, a in self.terms:
            angle = u * k
            total = total + (angle - sin(angle)) * a
        return total


@dataclass(frozen=True)
class Cosines:
    """Sum of square u**2 and of a (1 - cos k u) over the terms (k, a)."""

    terms: tuple[tuple[float, float], ...]
    square: float = 0.0

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind."""
        total = u * u * self.square if self.square else u.constant(0.0)
        for k, a in self.terms:
            total = total + (1.0 - cos(u * k)) * a
        return total


@dataclass(frozen=True)
class RiseFall:
    """64 u**3 (1 - u)**3: up and down again, velocity and acceleration 0 at both ends (3-4-5-6)."""

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind: 1 at the middle."""
        return (u * (1.0 - u)) ** 3.0 * 64.0


@dataclass(frozen=True)
class TwoPoint:
    """Polynomial of degree 2 m + 1 by its derivatives 0..m at u = 0 and 1.

    s = (1 - u)**(m + 1) P(u) + u**(m + 1) Q(1 - u), P and Q of degree m (Hermite's two-point form), so that both
    ends have their derivatives to the last bit. `first` and `last` are the coefficients of P and Q.
    """

    first: tuple[float, ...]
    last: tuple[float, ...]

    @staticmethod
    def of(start: Sequence[float], end: Sequence[float]) -> TwoPoint:
        """Make the polynomial from its derivatives 0..m by u, `start` at u = 0 and `end` at u = 1."""
        turned = [-x if k % 2 else x for k, x in enumerate(end)]
        return TwoPoint(_over_power(start), _over_power(turned))

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind."""
        v, power = 1.0 - u, float(len(self.first))
        return v**power * horner(self.first, u) + u**power * horner(self.last, v)


def _over_power(derivatives: Sequence[float]) -> tuple[float, ...]:
    """Taylor coefficients to order m of f(u)/(1 - u)**(m + 1), from the derivatives of f at 0."""
    from fractions import Fraction

    m = len(derivatives) - 1
    taylor, factorial = [], 1
    for k, value in enumerate(derivatives):
        factorial *= k or 1
        taylor.append(Fraction(value) / factorial)
    return tuple(float(sum(taylor[i] * comb(m + k - i, m) for i in range(k + 1))) for k in range(m + 1))


@dataclass(frozen=True)
class Flank(Alike):
    """v**5 Q(1 - v): a lobe's flank up to its nose, v = 1, with derivatives 0..4 that vanish at v = 0."""

    coefficients: tuple[float, ...]

    @staticmethod
    def of(
        powers: Sequence[int], top: float = 1.0, foot: float = 0.0, slope: float = 0.0
    ) -> tuple[Flank, tuple[float, ...]]:
        """Make the flank of the lobe top + sum of C_k u**k, u = 1 - v, less foot + slope v, from its five powers k.

        The powers rise, from 2 or above. Returns the flank and the five coefficients C_k, in the order of the powers.
        Value and four derivatives of the flank vanish at v = 0. With l_k Lagrange's polynomials over the powers, C_k is
        (foot - top + slope) l_k(0) - slope l_k(1), which gives the sums of C_k, k C_k, k (k - 1) C_k ... that the
        conditions at u = 1 need. The division by (1 - u)**5 is done in exact fractions, so that nothing cancels near
        u = 1.
        """
        from fractions import Fraction

        above, rate = Fraction(top) - Fraction(foot), Fraction(slope)
        full = [Fraction(0)] * (powers[-1] + 1)
        full[0], full[1] = above - rate, rate
        for k in powers:
            at_0, at_1 = Fraction(1), Fraction(1)
            for other in powers:
                if other != k:
                    at_0 *= Fraction(other, other - k)
                    at_1 *= Fraction(other - 1, other - k)
            full[k] = (rate - above) * at_0 - rate * at_1
        indices = [i for i, value in enumerate(full) if value]
        quotient = [
            sum((full[i] * comb(m - i + 4, 4) for i in indices if i <= m), Fraction(0)) for m in range(powers[-1] - 4)
        ]
        return Flank(tuple(map(float, quotient))), tuple(float(full[k]) for k in powers)

    @staticmethod
    def mixed(flanks: Sequence[Flank], weights: Sequence[float]) -> Flank:
        """The sum of flanks, each times its weight, one for each flank."""
        longest = max(len(flank.coefficients) for flank in flanks)
        padded = [(*flank.coefficients, *(0.0,) * (longest - len(flank.coefficients))) for flank in flanks]
        columns = zip(*padded, strict=True)
        return Flank(tuple(fsum(w * c for w, c in zip(weights, column, strict=True)) for column in columns))

    @property
    def kind(self) -> tuple[str, int]:
        """Key of flanks whose Q have as many coefficients."""
        return "flank", len(self.coefficients)

    @property
    def numbers(self) -> tuple[float, ...]:
        """Coefficients of Q."""
        return self.coefficients

    def together(self, rows: Array) -> Stretch:
        """Give one function for n flanks: column i of `rows` (k, n) has the coefficients for point or interval i."""
        return partial(_flank, rows)

    def __call__(self, v: Series, /) -> Series:
        """Displacement, a series of v's own kind: 1 at the nose."""
        return _flank(self.coefficients, v)


def _flank(coefficients: Sequence[float] | Array, v: Series) -> Series:
    return v**5.0 * horner(coefficients, 1.0 - v)


@dataclass(frozen=True)
class RampedFlank:
    """A flank that begins at a displacement with a velocity: foot + slope v + v**5 Q(1 - v)."""

    foot: float
    slope: float
    flank: Flank

    def __call__(self, v: Series, /) -> Series:
        """Displacement, a series of v's own kind: `foot` at v = 0."""
        return self.flank(v) + v * self.slope + self.foot


@dataclass(frozen=True)
class FromRest:
    """2 u**3 - u**4: from rest to a constant velocity, both without acceleration; 1 at u = 1."""

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind."""
        return u**3.0 * (2.0 - u)
