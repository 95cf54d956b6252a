"""Taylor coefficients: their products, quotients and compositions, and those of the elementary functions.

Coefficients stand in rows, one row for each order, over n points or n balls. A function f of a series g is f's own
coefficients at g[0], composed with the rest of g by Horner's scheme: exact algebra, nothing but f's coefficients to
bound when the points are balls.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import lru_cache
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from kin.ball import Ball

Array = NDArray[np.float64]
Row = TypeVar("Row", Array, Ball)


def factorials(order: int) -> Array:
    """Return k! as a column (order + 1, 1); exact in double up to 22!."""
    return np.array([float(math.factorial(k)) for k in range(order + 1)])[:, None]


def product(a: Array, b: Array) -> Array:
    """Return the truncated Cauchy product of coefficients (m, n)."""
    out: Array = a[0] * b
    for i in range(1, len(a)):
        out[i:] += a[i] * b[:-i]
    return out


def quotient(a: Array, b: Array) -> Array:
    """Coefficients of a/b, by long division."""
    out, rest = np.empty_like(a), a.copy()
    for k in range(len(a)):
        out[k] = rest[k] / b[0]
        rest[k + 1 :] -= out[k] * b[1 : len(a) - k]
    return out


def ball_product(a: Ball, b: Ball) -> Ball:
    """Return the truncated Cauchy product of ball coefficients (m, n); rows that are exactly 0 stay so."""
    with np.errstate(all="ignore"):
        size, p, q = len(a.mid), np.abs(a.mid), np.abs(b.mid)
        big, large = p + a.rad, q + b.rad
        left, right = (np.flatnonzero(rows.any(axis=1)) for rows in (big, large))
        mid = product(a.mid, b.mid)
        # Each sum of products is off by at most (size + 1) half ulps of the sum of magnitudes.
        unit = 2.0**-52 * (size + 2)
        rad = (product(p, b.rad + unit * q) + product(a.rad, large)) * (1 + 4 * unit)
        if len(left) and len(right):
            some = slice(left[0] + right[0], left[-1] + right[-1] + 1)
            rad[some] += 64 * np.minimum(np.minimum(big.max(axis=0), large.max(axis=0)), 1e-300)
        if not np.isfinite(rad).all():
            sound = np.isfinite(rad)
            mid, rad = np.where(sound, mid, 0.0), np.where(sound, rad, np.inf)
        return Ball(mid, rad)


def compose(outer: list[Array], inner: Array) -> Array:
    """Coefficients of f(g) from those of f at g[0], one row each, and those of g (m, n)."""
    size = len(inner)
    if not inner[2:].any():
        out = np.array(outer)
        scale = np.ones(inner.shape[1])
        for k in range(1, size):
            scale = scale * inner[1]
            out[k] *= scale
        return out
    out = outer[-1][None]
    for k in range(size - 2, -1, -1):
        longer = np.zeros((size - k, inner.shape[1]))
        longer[1:] = product(out, inner[1 : size - k])
        longer[0] = outer[k]
        out = longer
    return out


def compose_balls(outer: Ball, inner: Ball) -> Ball:
    """Compose balls; outer (m, n) encloses the coefficients of f over the balls g[0]."""
    size = len(inner.mid)
    if not inner.mid[2:].any() and not inner.rad[2:].any():
        return outer * inner[1].powers(size) if size > 1 else outer
    mid, rad = outer.mid[-1:], outer.rad[-1:]
    for k in range(size - 2, -1, -1):
        more = ball_product(Ball(mid, rad), inner[1 : size - k])
        mid, rad = np.vstack((outer.mid[k], more.mid)), np.vstack((outer.rad[k], more.rad))
    return Ball(mid, rad)


def stack(rows: list[Ball]) -> Ball:
    """One ball array (m, n) of m rows (n,)."""
    return Ball(np.stack([row.mid for row in rows]), np.stack([row.rad for row in rows]))


# Taylor coefficients of the elementary functions at x, one row for each order; one text for numbers and for balls.


@lru_cache(maxsize=256)
def binomials(exponent: Fraction, order: int) -> tuple[float, ...]:
    """Binomial coefficients of a rational exponent, each the nearest double."""
    value, found = Fraction(1), []
    for k in range(order + 1):
        found.append(float(value))
        value = value * (exponent - k) / (k + 1)
    return tuple(found)


def power_rows(x: Row, exponent: float, order: int) -> list[Row]:
    """x**exponent; a whole exponent from 0 up leaves exact zeros above itself."""
    rows = []
    if not isinstance(x, Ball) and (exponent < 0 or exponent == 0.5):
        value, inverse = np.sqrt(x) if exponent == 0.5 else x**exponent, 1.0 / x
        for binomial in binomials(Fraction(exponent), order):
            rows.append(value * binomial)
            value = value * inverse
        return rows
    for k, binomial in enumerate(binomials(Fraction(exponent), order)):
        if binomial == 0:
            rows.append(x * 0.0)
        elif Fraction(exponent - k) == Fraction(exponent) - k:
            rows.append(x ** (exponent - k) * binomial)
        else:
            rows.append(x**exponent * x**-k * binomial)
    return rows


def sine_rows(s: Row, c: Row, order: int) -> list[Row]:
    """Those of sin, from sin and cos."""
    cycle = [s, c, -s, -c]
    return [cycle[k % 4] / math.factorial(k) for k in range(order + 1)]


def sinh_rows(s: Row, c: Row, order: int) -> list[Row]:
    """Those of sinh, from sinh and cosh."""
    return [(c if k % 2 else s) / math.factorial(k) for k in range(order + 1)]


def exp_rows(value: Row, order: int) -> list[Row]:
    """Those of exp, from its value."""
    return [value / math.factorial(k) for k in range(order + 1)]


def log_rows(x: Row, value: Row, order: int) -> list[Row]:
    """Those of log, from its value at x."""
    return [value] + [x**-k / (k if k % 2 else -k) for k in range(1, order + 1)]


def cbrt_rows(x: Row, value: Row, order: int) -> list[Row]:
    """Those of the cube root, from its value at x of either sign."""
    factors = binomials(Fraction(1, 3), order)
    return [value] + [value * x**-k * factors[k] for k in range(1, order + 1)]


def tan_rows(value: Row, sense: float, order: int) -> list[Row]:
    """Those of tan (sense 1) and tanh (sense -1), from the value: y' = 1 + sense y^2."""
    rows = [value]
    if order:
        rows.append(value**2 * sense + 1.0)
    for k in range(1, order):
        square = rows[0] * rows[k]
        for j in range(1, k + 1):
            square = square + rows[j] * rows[k - j]
        rows.append(square * sense / (k + 1))
    return rows


def atan_rows(x: Row, value: Row, order: int) -> list[Row]:
    """Those of atan, from its value at x: (1 + x^2) y' = 1, differentiated."""
    slope = (x**2 + 1.0) ** -1
    rows = [value, slope]
    for k in range(1, order):
        # With d_k = (k + 1) y_(k+1):  (1 + x^2) d_k + 2 x d_(k-1) + d_(k-2) = 0.
        before = x * rows[k] * (2 * k)
        if k > 1:
            before = before + rows[k - 1] * (k - 1)
        rows.append(-before * slope / (k + 1))
    return rows[: order + 1]


def asin_rows(x: Row, value: Row, order: int) -> list[Row]:
    """Those of asin, from its value at x: (1 - x^2) y'' = x y', differentiated."""
    room = (1.0 - x) * (1.0 + x)
    slope = room**-1
    rows = [value, room**-0.5]
    for k in range(order - 1):
        # With d_k = (k + 1) y_(k+1):  (k + 1)(1 - x^2) d_(k+1) = (2 k + 1) x d_k + k d_(k-1).
        rise = x * rows[k + 1] * ((2 * k + 1) * (k + 1))
        if k:
            rise = rise + rows[k] * (k * k)
        rows.append(rise * slope / ((k + 1) * (k + 2)))
    return rows[: order + 1]
