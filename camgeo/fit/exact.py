"""Contours that are exactly rational B-splines: those whose support function is a trigonometric polynomial.

With p = sum of c_k exp(i k t), k from -n to n, the contour is the sum of (1 - k) c_k exp(i (k + 1) t) in the complex
plane, and cos and sin are rational in the tangent of a half angle. Over a quarter turn about tau let
``L(u) = (1 - u) exp(-i pi/8) + u exp(i pi/8)``: its angle runs from -pi/8 to pi/8, so ``exp(i (t - tau)) = L/conj L``
and every harmonic is a ratio of polynomials over the common denominator (L conj L)^(n + 1), of degree 2 (n + 1) in u.
The weights are that denominator's Bernstein coefficients, all positive. The spline is the contour itself; what is left
is the rounding of its control points and weights, which is bounded here.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.bound import Bound, FormError
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.rational import RationalSpline
from camgeo.fit.trigonometric import UNIT, polynomial_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from camgeo.fit.trigonometric import Polynomial

    Complex = NDArray[np.complex128]

MOST_DEGREE = 25
"""Highest degree that CAD systems take: AutoCAD and BricsCAD splines are of order 26 at most, Open CASCADE's of degree
25 (docs/recipe.md)."""
SPANS = 4  # quarter turns: weights from 1 down to about cos(45 degrees)^(n + 1), and extremes at joints
_SIXTEENTH = np.exp(1j * np.arange(16) * (math.pi / 8.0))


def fit_exact(curve: Curve, tolerance: float) -> RationalSpline:
    """Contour as the rational B-spline that it is; the bound covers all rounding up to the numbers that are written.

    Raises FormError where the support function is no trigonometric polynomial or the degree is above
    `MOST_DEGREE`, ToleranceError where rounding alone is more than the tolerance, mm.
    """
    spline = spline_of(polynomial_of(curve))
    if not spline.bound.worst <= tolerance:
        reached = spline.bound.worst
        raise ToleranceError(
            f"a tolerance of {tolerance:.3g} mm is below the rounding of an exact spline here, {reached:.3g} mm",
            reached,
        )
    return spline


def spline_of(p: Polynomial) -> RationalSpline:
    """Rational B-spline of the contour with a support function.

    Raises FormError where its degree is above `MOST_DEGREE`.
    """
    harmonics = _contour(p)
    n = max(abs(m) for m in harmonics)
    degree = 2 * n
    if degree > MOST_DEGREE:
        raise FormError(
            f"p has harmonics up to {p.order}, so the contour is a rational spline of degree {degree}; CAD systems "
            f"take degree {MOST_DEGREE} at most, harmonics up to {MOST_DEGREE // 2 - 1}"
        )
    weight = _basis(n, 0).real
    control = []
    for middle in range(1, 2 * SPANS, 2):  # of a quarter, in eighths of a turn
        height = sum(c * _SIXTEENTH[(2 * m * middle) % 16] * _basis(n, m) for m, (c, _) in harmonics.items())
        control.append(np.asarray(height) / weight)
    begin = [points[0] for points in control]
    rows = np.concatenate([[first, *points[1:-1]] for first, points in zip(begin, control, strict=True)] + [begin[:1]])
    weights = np.concatenate([*(weight[:-1] for _ in range(SPANS)), weight[-1:]])
    off = _rounding(harmonics, n) + p.rest + sum(error for _, error in harmonics.values())
    return RationalSpline(degree, np.column_stack([rows.real, rows.imag]), weights, Bound(off, off))


def _contour(p: Polynomial) -> dict[int, tuple[complex, float]]:
    """Coefficient of exp(i m t) in the contour, and how far it may be off, for each m; m = 0 and 1 in any case."""
    found: dict[int, tuple[complex, float]] = {0: (0.0j, 0.0), 1: (0.0j, 0.0)}
    for k in range(-p.order, p.order + 1):
        c = complex(p.coefficients[k]) if k >= 0 else complex(p.coefficients[-k]).conjugate()
        if k != 1:
            value = (1 - k) * c
            found[k + 1] = value, abs(1 - k) * float(p.error[abs(k)]) + 2.0 * UNIT * abs(value)
    return found


def _basis(n: int, m: int) -> Complex:
    """Bernstein coefficients (2 n + 1,) of L^(n + m) conj(L)^(n - m): of exp(i m t) times the common denominator."""
    a, b = n + m, n - m
    out = np.zeros(2 * n + 1, dtype=np.complex128)
    for i in range(a + 1):
        for j in range(b + 1):
            share = math.comb(a, i) * math.comb(b, j) / math.comb(2 * n, i + j)
            out[i + j] += share * _SIXTEENTH[(2 * i - a - 2 * j + b) % 16]
    return out


def _rounding(harmonics: dict[int, tuple[complex, float]], n: int) -> float:
    """Bound, mm, of what rounding does to the curve: of its Bernstein coefficients, control points and weights.

    A coefficient of the basis is a sum of at most 2 n + 1 terms whose sizes sum to one, each off by 6 units at most; a
    harmonic adds two products. Each enters the curve over the denominator, which is least in the middle of a span.
    """
    size = sum(abs(c) for c, _ in harmonics.values())
    units = (2 * n + 8) + len(harmonics) + 12  # numerator: basis, sum over harmonics, products and the quotient
    units += 2 * n + 8 + 2  # denominator, and the rounding of what is stored
    least = (0.5 * (1.0 + math.cos(math.pi / 4.0))) ** n
    return 1.01 * units * UNIT * size / least
