"""Psi over the polar angle t, by the routes of Wunderlich 1984 (W) that prescribe the pitch curve.

lam/mu is the ratio pi/alpha, l the arm, mm; `kin.law.transmission` makes laws of them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.segment import Harmonics, Series, summed
from kin.numeric import interval
from kin.numeric.elementary import BallJet, Jet, acos, asin, cos, sin, sqrt
from kin.numeric.interval import Ball
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.formula.expression import Expression


@dataclass(frozen=True)
class FromDelta:
    """psi = -asin(D/l^2) (W 5.10, 4.4), whose slope is -D'/sqrt((l^2 - D)(l^2 + D)); `delta` is D, `square` l^2, mm^2.

    Near |D| = l^2 an arcsine keeps half the digits. For a series of cosines the two factors are formed without
    cancellation, as margin + sum of 2 a sin^2(k t/2) and margin + sum of 2 a cos^2(k t/2), margin = l^2 - sum of a.
    """

    delta: Harmonics
    square: float

    def scaled(self, scale: float) -> FromDelta:
        """Give the law for arms `scale` times as long."""
        area, delta = scale * scale, self.delta
        terms = tuple((k, area * a, area * b) for k, a, b in delta.terms)
        return FromDelta(Harmonics(area * delta.mean, terms), area * self.square)

    def __call__(self, t: Series, /) -> Series:
        """Give psi over the polar angle t."""
        value = self.delta(t)
        near, far = self.factors(t, value)
        if isinstance(t, Jet):
            product = Jet((near * far).c[: max(t.order, 1)])
            angle = -np.arctan2(value.c[0], np.sqrt(product.c[0]))
            if not t.order:
                return Jet(angle[None])
            return (-value.derivative() * product**-0.5).integral(angle)
        start = -interval.asin(value.rows[0] / self.square)
        if not t.order:
            return BallJet(start.mid[None], start.rad[None])
        return (-value.derivative() * near.lower() ** -0.5 * far.lower() ** -0.5).integral(start)

    def factors(self, t: Series, value: Series) -> tuple[Series, Series]:
        """Give l^2 - D and l^2 + D at the polar angle t; `value` is D there."""
        if any(b for _, _, b in self.delta.terms):
            return self.square - value, self.square + value
        sense = math.copysign(1.0, math.fsum(a for _, a, _ in self.delta.terms))
        near, far = self._factors(t, value, sense)
        return (near, far) if sense > 0 else (far, near)

    def _factors(self, t: Series, value: Series, sense: float) -> tuple[Series, Series]:
        """Give l^2 - D and l^2 + D of cosines alone; of -D where `sense` is -1, which makes D positive at t = 0."""
        terms: list[tuple[int, float]] = [(k, sense * a) for k, a, _ in self.delta.terms]
        margin = math.fsum([self.square, *(-a for _, a in terms)])
        # only the values need care: the derivatives are those of D
        if isinstance(t, Jet):
            rows = np.stack([-sense * value.c, sense * value.c])
            k, a = np.array(terms).T[:, :, None]
            rows[0, 0] = margin + (2 * a * np.sin(t.c[0] * (k / 2)) ** 2).sum(axis=0)
            rows[1, 0] = margin + (2 * a * np.cos(t.c[0] * (k / 2)) ** 2).sum(axis=0)
            return Jet(rows[0]), Jet(rows[1])
        k, a = np.array(terms).T
        n = t.mid.shape[1]
        half = Ball(np.tile(t.mid[0], k.size), np.tile(t.rad[0], k.size)) * np.repeat(k / 2, n)
        factors = []
        for sign, wave in zip((-sense, sense), interval.sin_cos(half), strict=True):
            parts = wave**2 * np.repeat(2 * a, n)
            least = summed(BallJet(parts.mid[None], parts.rad[None]), n) + margin
            later = (value * sign).rows[1:]
            factors.append(BallJet(np.vstack([least.mid, later.mid]), np.vstack([least.rad, later.rad])))
        return factors[0], factors[1]


@dataclass(frozen=True)
class DeltaDistance:
    """r = a sqrt(l^2 + D) + b sqrt(l^2 - D), mm, a and b functions of alpha (W 5.10), without the detour over psi.

    Near |D| = l^2 psi leaps, and the rounding of an angle goes into r'' as many times over; for lambda/mu = 2/1 r is
    smooth there, as b = 0.
    """

    law: FromDelta
    alpha: float

    def __call__(self, t: Series, /) -> Series:
        """Give r over the polar angle t."""
        less, more = self.law.factors(t, self.law.delta(t))
        slant = math.pi / 4 - self.alpha / 2
        a, b = math.sqrt(2) * math.cos(slant), math.sqrt(2) * math.sin(slant)
        total = sqrt(more) * a
        return total + sqrt(less) * b if b else total


def steepness(terms: Sequence[tuple[int, float, float]]) -> Harmonics:
    """Give 4 D^2 + D'^2 as a Fourier series, from the terms (k, a, b) of D, a cos(k t) + b sin(k t), in rising k."""
    top = terms[-1][0]
    wave = np.zeros(2 * top + 1, dtype=complex)
    for k, a, b in terms:
        wave[top + k], wave[top - k] = complex(a, -b) / 2, complex(a, b) / 2
    slope = wave * 1j * np.arange(-top, top + 1)
    total = 4 * np.convolve(wave, wave) + np.convolve(slope, slope)
    upper = total[2 * top + 1 :]
    harmonics = [(k, 2 * float(c.real), -2 * float(c.imag)) for k, c in enumerate(upper, start=1)]
    return Harmonics(float(total[2 * top].real), tuple(term for term in harmonics if term[1] or term[2]))


@dataclass(frozen=True)
class FromArc:
    """psi = 2 acos(r/2l) - alpha for the circular arc through (R, 0), (R, delta) polar, symmetric about its bisector.

    With x = t - delta/2 and the centre at `centre` on the bisector, r = centre cos x +- sqrt(radius^2 - centre^2 sin^2
    x), or `power` over the other root where the two terms would cancel. `arm` is l; lengths in mm, `power` in mm^2.
    """

    arm: float
    alpha: float
    delta: float
    centre: float
    radius: float
    power: float
    convex: bool

    def __call__(self, t: Series, /) -> Series:
        """Give psi over the polar angle t."""
        return acos(self.distance(t) / (2 * self.arm)) * 2.0 - self.alpha

    def distance(self, t: Series) -> Series:
        """Distance r of the arc from the shaft, mm, at the polar angle t."""
        x = t - self.delta / 2
        along = cos(x) * self.centre
        root = sqrt(self.radius**2 - sin(x) ** 2 * self.centre**2)
        if self.convex and self.centre >= 0:
            return along + root
        larger = root - along if self.convex else along + root
        return self.power / larger


@dataclass(frozen=True)
class FromLeaf:
    """Psi = 2 asin(|OQ|/2l), with |OQ| given by `leaf` over x = (t - start)/delta (W section 5).

    |OQ|/2l is the leaf's value times `scale`: its unit, mm, over 2 l.
    """

    leaf: Expression
    scale: float
    start: float
    delta: float

    def __call__(self, t: Series, /) -> Series:
        """Give psi over the polar angle t."""
        distance: Series = self.leaf.on((t - self.start) / self.delta)
        return asin(distance * self.scale) * 2.0


@dataclass(frozen=True)
class FromExpression:
    """Psi from a formula over the polar angle t: -asin(D/l^2) (W 5.10) or, where `is_distance`, 2 acos(r/2l) - alpha.

    D/l^2, or r/2l with the polar radius r of the pitch curve (W 4.10), is the formula's value times `scale`: its unit,
    mm^2 or mm, over l^2 or 2 l.
    """

    formula: Expression
    scale: float
    alpha: float
    is_distance: bool

    def __call__(self, t: Series, /) -> Series:
        """Give psi over the polar angle t."""
        value: Series = self.formula.on(t) * self.scale
        return acos(value) * 2.0 - self.alpha if self.is_distance else -asin(value)
