"""Functions of one variable in jet arithmetic, of which stretches of piecewise functions are made.

One function object serves points (`kin.numeric.elementary.Jet`: exact derivatives) and intervals
(`kin.numeric.elementary.BallJet`: proved enclosures).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import partial
from typing import TYPE_CHECKING, Protocol, TypeVar

import numpy as np

from kin.numeric.elementary import BallJet, Jet, cos, sin
from kin.numeric.jet import horner
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

Series = TypeVar("Series", Jet, BallJet)
_MANY = 4  # harmonics: the terms of more are enclosed together


class Stretch(Protocol):
    """A function of one variable in jet arithmetic."""

    def __call__(self, t: Series, /) -> Series:
        """Apply the function to a jet or ball jet."""


class Harmonic(ABC):
    """A stretch mean + x cos t + y sin t; such stretches are evaluated together."""

    @property
    @abstractmethod
    def first_harmonic(self) -> tuple[float, float, float]:
        """Coefficients (mean, x, y) of mean + x cos t + y sin t."""


class Alike(ABC):
    """A stretch that a few numbers describe; stretches of one kind are evaluated together."""

    @property
    @abstractmethod
    def kind(self) -> tuple[str, int]:
        """Key of the stretches that can be evaluated together: a name and a number."""

    @property
    @abstractmethod
    def numbers(self) -> tuple[float, ...]:
        """Numbers that describe the stretch, as many for all of one kind: a column of `together`."""

    @abstractmethod
    def together(self, rows: Array) -> Stretch:
        """Give one function for n stretches of this kind: column i of `rows` (k, n) applies to point or interval i."""


@dataclass(frozen=True)
class Constant(Harmonic):
    """A constant function."""

    value: float

    @property
    def first_harmonic(self) -> tuple[float, float, float]:
        """Coefficients (value, 0, 0)."""
        return self.value, 0.0, 0.0

    def __call__(self, t: Series, /) -> Series:
        """Give the value, constant over t."""
        return t.constant(self.value)


@dataclass(frozen=True)
class AffineStretch:
    """offset + scale f((t - start)/width): a function moved and stretched along both axes."""

    function: Stretch
    offset: float = 0.0
    scale: float = 1.0
    start: float = 0.0
    width: float = 1.0

    @staticmethod
    def of(
        function: Stretch, *, offset: float = 0.0, scale: float = 1.0, start: float = 0.0, width: float = 1.0
    ) -> AffineStretch:
        """Give offset + scale f((t - start)/width); a function that is moved already gets one movement, not two."""
        if not isinstance(function, AffineStretch):
            return AffineStretch(function, offset, scale, start, width)
        return AffineStretch(
            function.function,
            offset + scale * function.offset,
            scale * function.scale,
            start + width * function.start,
            width * function.width,
        )

    def __call__(self, t: Series, /) -> Series:
        """Apply the moved function."""
        x = t - self.start if self.start else t
        value = self.function(x * (1 / self.width) if self.width != 1 else x)
        if self.scale == -1:
            value = -value
        elif self.scale != 1:
            value = value * self.scale
        return value + self.offset if self.offset else value


def moved(
    function: Stretch, *, offset: float = 0.0, scale: float = 1.0, start: float = 0.0, width: float = 1.0
) -> Stretch:
    """Give offset + scale f((t - start)/width); a constant stays a constant."""
    if isinstance(function, Constant):
        return Constant(offset + scale * function.value)
    return AffineStretch.of(function, offset=offset, scale=scale, start=start, width=width)


@dataclass(frozen=True)
class Power(Alike):
    """Sum of coefficient[k] u**k by Horner's scheme."""

    coefficients: tuple[float, ...]

    @property
    def kind(self) -> tuple[str, int]:
        """Key of polynomials with as many coefficients."""
        return "power", len(self.coefficients)

    @property
    def numbers(self) -> tuple[float, ...]:
        """Coefficients of the polynomial."""
        return self.coefficients

    def together(self, rows: Array) -> Stretch:
        """Give one function for n polynomials: column i of `rows` (k, n) is for point or interval i."""
        return partial(horner, rows)

    def __call__(self, u: Series, /) -> Series:
        """Value of the polynomial, a series of u's own kind."""
        return horner(self.coefficients, u)


@dataclass(frozen=True)
class Harmonics:
    """mean + sum of a cos(k t) + b sin(k t) over the terms (k, a, b), k a whole number."""

    mean: float
    terms: tuple[tuple[int, float, float], ...]

    def __call__(self, t: Series, /) -> Series:
        """Value of the sum, a series of t's own kind."""
        if isinstance(t, Jet) and len(self.terms) > 0 and not t.c[2:].any():
            return self._at_points(t)
        if isinstance(t, BallJet) and len(self.terms) > _MANY:
            return self._on_intervals(t)
        total = t.constant(self.mean)
        for k, a, b in self.terms:
            angle = t * float(k) if k > 1 else t
            if a:
                total = total + cos(angle) * a
            if b:
                total = total + sin(angle) * b
        return total

    def _at_points(self, t: Jet) -> Jet:
        """Sum the series of t = t0 + t1 x: all terms at once, as d/dt turns (sin, cos) and multiplies by k.

        `even` and `odd` (terms, n) are the terms and their first derivatives over k.
        """
        k, a, b = np.array(self.terms)[:, :, None].transpose(1, 0, 2)
        sine, cosine = np.sin(k * t.c[0]), np.cos(k * t.c[0])
        even, odd = a * cosine + b * sine, b * cosine - a * sine
        c = np.empty_like(t.c)
        c[0] = self.mean + even.sum(axis=0)
        power, scale = k, 1.0
        for order in range(1, len(c)):
            scale = scale * t.c[1] / order
            c[order] = (power * (odd if order % 2 else even)).sum(axis=0) * (scale if order % 4 < 2 else -scale)
            power = power * k
        return Jet(c)

    def _on_intervals(self, t: BallJet) -> BallJet:
        """Sum the series over intervals (n,): all terms side by side, added up in pairs."""
        k, a, b = np.array(self.terms)[:, :, None].transpose(1, 0, 2)
        order, n = t.mid.shape
        side = (order, len(k) * n)
        wide = [np.broadcast_to(rows[:, None, :], (order, len(k), n)).reshape(side) for rows in (t.mid, t.rad)]
        angle = BallJet(*wide) * np.repeat(k, n)
        total = summed(cos(angle) * np.repeat(a, n) + sin(angle) * np.repeat(b, n), n)
        return total + self.mean if self.mean else total


def summed(terms: BallJet, n: int) -> BallJet:
    """Sum, over n intervals, of terms that stand side by side (order + 1, terms * n): added in pairs of halves."""
    while (count := terms.mid.shape[1] // n) > 1:
        half = count // 2 * n
        parts = slice(half), slice(half, 2 * half), slice(2 * half, None)
        first, second, odd = (BallJet(terms.mid[:, part], terms.rad[:, part]) for part in parts)
        terms = first + second
        terms = BallJet(np.hstack([terms.mid, odd.mid]), np.hstack([terms.rad, odd.rad]))
    return terms
