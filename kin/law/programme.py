"""The oldest motion laws, polynomial laws, and the error of a motion that no cam can have.

A normalised law s(u) leads from s(0) = 0 to s(1) = 1. The standard ones are symmetric, s(u) + s(1 - u) = 1; those of
several runs are written as one half and its image. Names and peaks: H. A. Rothbart, Cam Design Handbook, chapters 2
and 3. The constants of the "modified" laws follow here from their accelerations and s(1) = 1.
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
from kin.numeric.jet import finite, horner
from kin.numeric.records import dataclass, replace
from kin.numeric.taylor import sine_rows

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from kin.numeric.arrays import Array


_END_TOLERANCE = 1e-12  # of a polynomial law at u = 0 and 1


class IntentError(CamgeoError, ValueError):
    """An intended motion that no cam can have, with the reason and the figure.

    `field` is the path of the faulty field below the recipe's `cam`; `at_deg` the shaft angle, degrees, if there is
    one.
    """

    def __init__(self, message: str, field: str, at_deg: float | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.field = field
        self.at_deg = at_deg


@dataclass(frozen=True)
class Peaks:
    """Largest absolute velocity, acceleration and jerk of a law, for unit stroke over unit interval from rest to rest.

    `acceleration` is infinite where the velocity steps, `jerk` where velocity or acceleration does, at the ends too.
    """

    velocity: float
    acceleration: float
    jerk: float


@dataclass(frozen=True)
class Law:
    """A normalised motion law s(u) on [0, 1] with its peaks.

    A return runs the law backwards, s(1 - u), which for a symmetric law is 1 - s(u). A law that is not symmetric, or
    may not be, is marked `reverses`.
    """

    name: str
    motion: Piecewise
    peaks: Peaks
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
        """Key of pieces whose acceleration has one shape."""
        return self.shape, 0

    @property
    def numbers(self) -> tuple[float, ...]:
        """Numbers start, s, v, rate, and the factor of the displacement that the acceleration adds to s + v x."""
        return self.start, self.s, self.v, self.rate, self.peak / (self.rate**2 if self.rate else 2.0)

    def together(self, rows: Array) -> Stretch:
        """Give one function for n pieces of one shape, a column of `rows` each."""
        return _Accelerated(self.shape, tuple(rows))

    def __call__(self, u: Series, /) -> Series:
        """Displacement, a series of u's own kind."""
        return self.together(np.array(self.numbers)[:, None])(u)


@dataclass(frozen=True, eq=False)
class _Accelerated:
    """Displacements of pieces of one shape by their five numbers (n,), each at its own point or interval."""

    shape: Literal["sin", "cos", "flat"]
    rows: tuple[Array, ...]

    def __call__(self, u: Series, /) -> Series:
        """Displacement of each piece, a series of u's own kind."""
        start, s, v, rate, scale = self.rows
        if isinstance(u, Jet) and u.order and not u.c[2:].any():
            return self._at_points(u)
        x = u - start if start.any() else u
        if self.shape == "flat":
            return (x * scale + v) * x + s
        angle = x * rate
        wave = angle - sin(angle) if self.shape == "sin" else 1.0 - cos(angle)  # at rest at the start, to the last bit
        path = wave * scale
        if v.any():
            path = path + x * v
        return path + s if s.any() else path

    def _at_points(self, u: Jet) -> Jet:
        """Give each displacement where u is a linear series: the same digits, by less arithmetic."""
        start, s, v, rate, scale = self.rows
        with np.errstate(all="ignore"):
            x, slope, order = u.c[0] - start, u.c[1], u.order
            out = np.zeros_like(u.c)
            if self.shape == "flat":
                path = x * scale + v
                out[0], out[1] = path * x + s, path * slope + slope * scale * x
                out[2:3] = slope * scale * slope
                return finite(out, "overflow")
            # Taylor rows of the sine or cosine, times powers of the pace, then the straight run
            angle, pace = x * rate, slope * rate
            sine, cosine = np.sin(angle), np.cos(angle)
            out -= sine_rows(sine, cosine, order) if self.shape == "sin" else sine_rows(cosine, -sine, order)
            power = pace
            for k in range(1, order + 1):
                out[k] *= power
                power = power * pace
            if self.shape == "sin":
                out[0] += angle
                out[1] += pace
            else:
                out[0] += 1.0
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


def _law(
    name: str,
    knots: Sequence[float],
    runs: Sequence[tuple[float, float, Literal["sin", "cos", "flat"]]],
    peaks: Peaks,
    *,
    centre: bool = True,
) -> Law:
    return Law(name, symmetric(knots, runs, centre), peaks)


def _standard_laws() -> dict[str, Law]:
    pi = math.pi
    trapezoid, sine, constant = 8 * pi / (pi + 2), 4 * pi**2 / (pi + 4), 16 * pi**2 / (5 * pi + 4)
    laws = [
        _law("parabolic", (0, 0.5), [(4.0, 0.0, "flat")], Peaks(2.0, 4.0, math.inf), centre=False),
        _law("harmonic", (0, 1), [(pi**2 / 2, pi, "cos")], Peaks(pi / 2, pi**2 / 2, math.inf)),
        _law("cycloidal", (0, 1), [(2 * pi, 2 * pi, "sin")], Peaks(2.0, 2 * pi, 4 * pi**2)),
        _law(
            "modified-trapezoid",
            (0, 1 / 8, 3 / 8, 5 / 8),
            [(trapezoid, 4 * pi, "sin"), (trapezoid, 0.0, "flat"), (trapezoid, 4 * pi, "cos")],
            Peaks(2.0, trapezoid, 4 * pi * trapezoid),
        ),
        _law(
            "modified-sine",
            (0, 1 / 8, 7 / 8),
            [(sine, 4 * pi, "sin"), (sine, 4 * pi / 3, "cos")],
            Peaks(sine / pi, sine, 4 * pi * sine),
        ),
        # Ramp of 1/16 + 3/16: velocity a/8pi + 3a/8pi = a/2pi, path (a/8pi)(1/4 + 1/pi); twice that path and half a
        # unit at a/2pi make 1, so a = 16 pi^2/(5 pi + 4).
        _law(
            "modified-constant-velocity",
            (0, 1 / 16, 1 / 4, 3 / 4),
            [(constant, 8 * pi, "sin"), (constant, 8 * pi / 3, "cos"), (0.0, 0.0, "flat")],
            Peaks(constant / (2 * pi), constant, 8 * pi * constant),
        ),
        # 10 u^3 - 15 u^4 + 6 u^5 and 35 u^4 - 84 u^5 + 70 u^6 - 20 u^7, about the middle: no cancellation at u = 1.
        _smooth("polynomial-345", (0.5, 15 / 8, 0, -5, 0, 6), 0.5, Peaks(15 / 8, 10 / math.sqrt(3), 60.0)),
        _smooth(
            "polynomial-4567",
            (0.5, 35 / 16, 0, -35 / 4, 0, 21, 0, -20),
            0.5,
            Peaks(35 / 16, 84 / math.sqrt(125), 52.5),
        ),
    ]
    return {law.name: law for law in laws}


def _smooth(name: str, coefficients: Sequence[float], centre: float, peaks: Peaks) -> Law:
    polynomial = Polynomial(tuple(map(float, coefficients)), centre)
    return Law(name, Piecewise(np.array([0.0, 1.0]), (polynomial,)), peaks)


def polynomial_law(coefficients: Sequence[float], field: str = "motion") -> Law:
    """Make the law c0 + c1 u + c2 u**2 + ... from its coefficients.

    Raises IntentError, at `field`, for no coefficients, one that is not finite, or a law that does not lead from 0 to 1
    within 1e-12. It need not rest at its ends: its peaks count the steps from and to rest there.
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
    law = _smooth(f"polynomial {list(values)}", values, 0.0, _polynomial_peaks(values))
    return replace(law, reverses=True)


def _polynomial_peaks(coefficients: tuple[float, ...]) -> Peaks:
    s = np.polynomial.Polynomial(coefficients)
    tops = []
    for k in (1, 2, 3):
        level = s.deriv(k)
        extrema = level.deriv().roots()
        real = extrema[np.abs(extrema.imag) <= 1e-9 * (1 + np.abs(extrema))].real
        u = np.concatenate(([0.0, 1.0], real[(real > 0) & (real < 1)]))
        tops.append(float(np.abs(level(u)).max()))
    ends = np.array([[abs(s.deriv(k)(u)) for u in (0.0, 1.0)] for k in (1, 2)]).max(axis=1)
    moving, pushed = ends > _END_TOLERANCE * np.array(tops[:2]).clip(min=1)
    velocity, acceleration, jerk = tops
    return Peaks(velocity, math.inf if moving else acceleration, math.inf if moving or pushed else jerk)


LAWS: Mapping[str, Law] = _standard_laws()
