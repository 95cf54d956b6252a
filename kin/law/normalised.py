"""Normalised motion laws, what they are built from, and the error of a motion that no cam can have.

A normalised law s(u) leads from s(0) = 0 to s(1) = 1. A symmetric one, s(u) + s(1 - u) = 1, of several runs is written
as one half and its image.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Alike, Series, Stretch
from kin.numeric.elementary import Jet, cos, sin
from kin.numeric.errors import CamgeoError
from kin.numeric.jet import chosen, finite, horner
from kin.numeric.lengths import FIRST, Words
from kin.numeric.records import dataclass
from kin.numeric.taylor import sine_rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array


_END_TOLERANCE = 1e-12  # of a polynomial law at u = 0 and 1


class IntentError(CamgeoError, ValueError):
    """An intended motion that no cam can have, with the reason and the figure.

    `field` is the path of the faulty field below the recipe's `cam`; `at` the input at the fault in
    `at_unit`, such as the shaft angle, if there is one.
    """

    def __init__(self, message: str, field: str, at: float | None = None, at_unit: str = "deg") -> None:
        self.message = Words(message) if FIRST in message else message
        super().__init__(self.message)
        self.field = field
        self.at = at
        self.at_unit = at_unit

    @property
    def at_deg(self) -> float | None:
        """Shaft angle of the fault, degrees; None without one, or where the input is no angle."""
        return self.at if self.at_unit == "deg" else None


@dataclass(frozen=True)
class Law:
    """A normalised motion law s(u) on [0, 1].

    A return runs the law backwards, s(1 - u), which for a symmetric law is 1 - s(u). A law that is not symmetric, or
    may not be, is marked `reverses`.
    """

    name: str
    motion: Piecewise
    reverses: bool = False

    def derivatives(self, u: float | Array, order: int, side: int = 1) -> Array:
        """Give s and its derivatives by u, (order + 1, n), at u (n,); at a knot the right limit, or left (side -1).

        Raises ValueError for u outside [0, 1].
        """
        return self.motion.derivatives(u, order, side)


@dataclass(frozen=True)
class Polynomial:
    """Sum of coefficient[k] (u - centre)**k, by Horner's scheme."""

    coefficients: tuple[float, ...]
    centre: float = 0.0

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind."""
        return horner(self.coefficients, u - self.centre if self.centre else u)


@dataclass(frozen=True)
class AcceleratedPiece(Alike):
    """Displacement from `s` with velocity `v` at `start`, under an acceleration of one `shape`.

    With x = u - start the acceleration is peak sin(rate x), peak cos(rate x) or, flat, peak.
    """

    start: float
    s: float
    v: float
    peak: float
    rate: float
    shape: Literal["sin", "cos", "flat"]

    @property
    def kind(self) -> tuple[str, int]:
        """Key of pieces that are evaluated together: waves, or flat ones."""
        return "flat" if self.shape == "flat" else "wave", 0

    @property
    def numbers(self) -> tuple[float, ...]:
        """Numbers start, s, v, rate, the factor of what the acceleration adds to s + v x, and 1 for a sine, else 0."""
        scale = self.peak / (self.rate**2 if self.rate else 2.0)
        return self.start, self.s, self.v, self.rate, scale, float(self.shape == "sin")

    def together(self, rows: Array) -> Stretch:
        """Give one function for n pieces of one kind, a column of `rows` each."""
        return _Accelerated(self.shape == "flat", tuple(rows))

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind."""
        return self.together(np.array(self.numbers)[:, None])(u)


@dataclass(frozen=True, eq=False)
class _Accelerated:
    """Displacements of pieces of one kind by their six numbers (n,), each at its own point or interval."""

    flat: bool
    rows: tuple[Array, ...]

    def __call__(self, u: Series, /) -> Series:
        """Displacement of each piece, a series of u's own kind."""
        start, s, v, rate, scale, of_sine = self.rows
        if isinstance(u, Jet) and u.order and not u.c[2:].any():
            return self._at_points(u)
        x = u - start if start.any() else u
        if self.flat:
            return (x * scale + v) * x + s
        angle, sines = x * rate, of_sine > 0.0
        if sines.all():
            wave = angle - sin(angle)  # at rest at the start, to the last bit
        elif not sines.any():
            wave = 1.0 - cos(angle)
        else:
            wave = chosen(sines, angle - sin(angle), 1.0 - cos(angle))
        path = wave * scale
        if v.any():
            path = path + x * v
        return path + s if s.any() else path

    def _at_points(self, u: Jet) -> Jet:
        """Give each displacement where u is a linear series: the same digits, by less arithmetic."""
        start, s, v, rate, scale, of_sine = self.rows
        with np.errstate(all="ignore"):
            x, slope, order = u.c[0] - start, u.c[1], u.order
            out = np.zeros_like(u.c)
            if self.flat:
                path = x * scale + v
                out[0], out[1] = path * x + s, path * slope + slope * scale * x
                out[2:3] = slope * scale * slope
                return finite(out, "overflow")
            # Taylor rows of the sine or cosine, times powers of the pace, then the straight run
            angle, pace, sines = x * rate, slope * rate, of_sine > 0.0
            sine, cosine = np.sin(angle), np.cos(angle)
            out -= sine_rows(np.where(sines, sine, cosine), np.where(sines, cosine, -sine), order)
            power = pace
            for k in range(1, order + 1):
                out[k] *= power
                power = power * pace
            out[0] += np.where(sines, angle, 1.0)
            out[1] += np.where(sines, pace, 0.0)
            out *= scale
            out[0] += x * v
            out[0] += s
            out[1] += slope * v
            return finite(out, "overflow")


def first_harmonic(stretch: AffineStretch) -> tuple[float, float, float] | None:
    """Mean and coefficients of cos t and sin t of a stretch that has no other terms; None for any other stretch.

    Such a stretch is the harmonic law over a half turn: an eccentric, whose radius of curvature is constant.
    """
    run = stretch.function
    if not (isinstance(run, AcceleratedPiece) and run.shape == "cos" and run.start == run.s == run.v == 0.0):
        return None
    if abs(run.rate / abs(stretch.width) - 1.0) > 4.0 * 2.0**-52:
        return None
    half = stretch.scale * run.peak / run.rate**2
    return stretch.offset + half, -half * math.cos(stretch.start), -half * math.sin(stretch.start)


def mirrored(function: Stretch) -> Stretch:
    """1 - f(1 - u): the other half of a symmetric law."""
    return AffineStretch(function, offset=1.0, scale=-1.0, start=1.0, width=-1.0)


def symmetric(
    knots: Sequence[float], runs: Sequence[tuple[float, float, Literal["sin", "cos", "flat"]]], centre: bool
) -> Piecewise:
    """Build a symmetric law from the accelerations (peak, rate, shape) of its first half, run i between two knots.

    Each run begins with the displacement and velocity at which the run before ends. `knots` begin at 0 and end at 1/2;
    with `centre` the last run is its own image and ends as far beyond 1/2 as it begins before.
    """
    half: list[Stretch] = []
    s = v = 0.0
    for (begin, end), (peak, rate, shape) in zip(pairwise(knots), runs, strict=True):
        run = AcceleratedPiece(begin, s, v, peak, rate, shape)
        half.append(run)
        (s,), (v,) = run(Jet.variable(end, 1)).c
    images = [mirrored(function) for function in reversed(half[:-1] if centre else half)]
    first = knots[:-1] if centre else knots
    return Piecewise(np.array([*first, *(1 - u for u in reversed(knots[:-1]))]), (*half, *images))


def polynomial_law(coefficients: Sequence[float], field: str = "motion") -> Law:
    """Make the law c0 + c1 u + c2 u**2 + ... from its coefficients.

    Raises IntentError, at `field`, for no coefficients, one that is not finite, or a law that does not lead from 0 to 1
    within 1e-12. It need not rest at its ends.
    """
    values = tuple(float(c) for c in coefficients)
    if not values or not np.isfinite(values).all():
        raise IntentError("a polynomial law needs finite coefficients c0, c1, ... of u", field)
    start, end = values[0], math.fsum(values)
    if abs(start) > _END_TOLERANCE or abs(end - 1) > _END_TOLERANCE:
        raise IntentError(
            f"a polynomial law must lead from 0 to 1; this one leads from s(0) = {start:.12g} to s(1) = {end:.12g}",
            field,
        )
    return Law(f"polynomial {list(values)}", Piecewise(np.array([0.0, 1.0]), (Polynomial(values),)), reverses=True)
