"""Least error of a cubic span: how closely a polynomial cubic follows a smooth curve, to leading order.

A plane cubic has eight coefficients, two of which only set its parameter: six numbers are free, and it meets a curve
six times. Write the curve as ``y = f2 x^2 + f3 x^3 + ...`` over its tangent and the cubic as
``x = t + a t^2 + b t^3, y = f2 t^2 + (2 f2 a + f3) t^3``: it agrees to the third order whatever a and b are, to the
fifth where they satisfy two equations, and then misses the curve by ``-c t^6`` (de Boor, Höllig and Sabin, High
accuracy geometric Hermite interpolation, CAGD 4, 1987). Eliminating b leaves a cubic equation for a with one or three
real roots; the root with the least miss counts.

Over a span of length h whose ends lie off the curve so that its error is equal to both sides, with tangents parallel
to the curve's, the miss is ``c (h/2)^6 (z (z - 1)^2 - 2/27)``, z = (2 s/h)^2: 2/27 to either side, c h^6/864. No spline
with a continuous tangent has a smaller error (docs/theory.md 3).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.nodes import Density
from kin.numeric.elementary import Jet
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve
    from kin.numeric.arrays import Array

ORDER = 6.0  # power of a span's length with which its error falls
LEAST = 864.0  # the least error of a span of length h is c h^6/864
STEPS_PER_CELL = 4  # of the curve; the density is taken in their middles
VANISHING = 1e-14  # relative: a leading coefficient below is rounding
REAL = 1e-6  # relative: roots with a smaller imaginary part are a double root, split by rounding


@dataclass(frozen=True)
class NearestCubic:
    """The cubics nearest to a curve at n places, all (n,).

    `miss` is the coefficient c, 1/mm^5, positive where the cubic lies outside a convex curve; `lean` is the coefficient
    a, 1/mm: where it is positive the cubic's speed rises, and the arc length ``t + a t^2`` gains on its parameter t.
    Where terms are not finite the miss is nan and the lean 0.
    """

    miss: Array
    lean: Array


def nearest_cubic(speed: Array, turn: Array) -> NearestCubic:
    """Miss and lean of the cubics nearest to a curve at n places, by Taylor coefficients (5, n) of speed, mm, and turn.

    Raises DomainError where the speed is 0, or so small that terms overflow.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        f = _heights(speed, turn)
        # lengths in units of the curve's own, so that coefficients are about 1
        k = np.arange(1.0, 6.0)[:, None]
        scale = np.maximum((np.abs(f) ** (1.0 / k)).max(axis=0), 1e-300)
        f = f / scale**k
        known = np.isfinite(f).all(axis=0)
        lean = _roots(np.where(known, f, 0.0))
        f2, f3, f4, f5, f6 = f[:, :, None]
        # b by least squares of both equations, as either may be empty
        p, q = 2.0 * f2, 2.0 * f2 * lean + 3.0 * f3
        first = f2 * lean**2 + 3.0 * f3 * lean + f4
        second = 3.0 * f3 * lean**2 + 4.0 * f4 * lean + f5
        b = -(p * first + q * second) / np.maximum(p * p + q * q, 1e-300)
        miss = f2 * b**2 + f3 * (lean**3 + 6.0 * lean * b) + f4 * (6.0 * lean**2 + 4.0 * b) + 5.0 * f5 * lean + f6
        least = np.argmin(np.where(np.isnan(miss), np.inf, np.abs(miss)), axis=1)[:, None]
        chosen, leaning = (np.take_along_axis(rows, least, axis=1)[:, 0] for rows in (miss, lean))
        return NearestCubic(np.where(known, chosen * scale**5, np.nan), np.where(known, leaning * scale, 0.0))


def _heights(speed: Array, turn: Array) -> Array:
    """Coefficients f2 to f6 (5, n) of the curve over its tangent, from its curvature k and derivatives by length."""
    slowness = Jet(speed) ** -1
    row = Jet(turn) * slowness
    k = [row.c[0]]
    while row.order:
        row = row.derivative()
        row = row * Jet(slowness.c[: row.order + 1])
        k.append(row.c[0])
    return np.stack(
        [
            k[0] / 2.0,
            k[1] / 6.0,
            (k[2] + 3.0 * k[0] ** 3) / 24.0,
            (k[3] + 19.0 * k[0] ** 2 * k[1]) / 120.0,
            (k[4] + 48.0 * k[0] * k[1] ** 2 + 34.0 * k[0] ** 2 * k[2] + 45.0 * k[0] ** 5) / 720.0,
        ]
    )


def _roots(f: Array) -> Array:
    """Real roots (n, 3) of the equation for a; nan in place of complex ones."""
    f2, f3, f4, f5, _ = f
    rows = np.stack([-2.0 * f2**2, -3.0 * f2 * f3, 6.0 * f2 * f4 - 9.0 * f3**2, 2.0 * f2 * f5 - 3.0 * f3 * f4], axis=1)
    size = np.abs(rows).max(axis=1, initial=0.0)
    least = VANISHING * np.where(size > 0.0, size, 1.0)
    lead = np.where(np.abs(rows[:, 0]) < least, -least, rows[:, 0])
    companion = np.zeros((len(lead), 3, 3))
    companion[:, 0] = -rows[:, 1:] / lead[:, None]
    companion[:, 1, 0] = companion[:, 2, 1] = 1.0
    roots = np.linalg.eigvals(companion)
    real: Array = np.where(np.abs(roots.imag) <= REAL * (1.0 + np.abs(roots)), roots.real, np.nan)
    return real


@dataclass(frozen=True)
class SpanDensity:
    """Density of spans along each stretch.

    `side` is the side to which the nearest cubic misses everywhere, 1 outside, -1 inside; 0 where the side changes.
    """

    densities: list[Density]
    side: float

    @property
    def totals(self) -> Array:
        """Least number of spans of each stretch (m,) at a tolerance of 1 mm, which grows as tolerance^(-1/6)."""
        return np.array([density.total for density in self.densities])


def span_density(curve: Curve, stretches: Array) -> SpanDensity:
    """Integral of (|c|/864)^(1/6) ds over each stretch (m, 2), none of which spans a break.

    c, 1/mm^5, is the coefficient of the nearest cubic's miss. The integral is the least number of spans at a tolerance
    of 1 mm, to leading order. Raises DomainError where the curve stands still.
    """
    # equal steps of each cell of the curve, cut off at the stretch's ends, and the midpoint rule over them
    cells, edges = curve.cells, []
    for low, high in stretches:
        first = int(np.searchsorted(cells.low, low, side="right")) - 1
        last = int(np.searchsorted(cells.high, high, side="left"))
        ends = np.clip(np.append(cells.low[first : last + 1], high), low, high)
        inner = ends[:-1, None] + np.diff(ends)[:, None] * np.arange(STEPS_PER_CELL) / STEPS_PER_CELL
        edges.append(np.append(inner.ravel(), high))
    middle = np.concatenate([0.5 * (part[:-1] + part[1:]) for part in edges])
    speed, turn = curve.shape.series(middle, 4)
    miss = np.nan_to_num(nearest_cubic(speed, turn).miss, nan=0.0, posinf=0.0, neginf=0.0)
    value = (np.abs(miss) / LEAST) ** (1.0 / ORDER) * np.abs(speed[0])
    densities, begin = [], 0
    for part in edges:
        width, rows = np.diff(part), slice(begin, begin + part.size - 1)
        begin = rows.stop
        total = np.concatenate([[0.0], np.cumsum(value[rows] * width)])
        densities.append(Density(part, total, float(np.abs(turn[0, rows] * width).sum())))
    sides = np.sign(miss)
    return SpanDensity(densities, float(sides[0]) if (sides == sides[0]).all() else 0.0)
