"""Taylor coefficients: their products, quotients and compositions, and those of the elementary functions.

Coefficients stand in rows, one row for each order, over n points or n balls. A function f of a series g is f's own
coefficients at g[0], composed with the rest of g by Horner's scheme: exact algebra, nothing but f's coefficients to
bound when the points are balls.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from kin.numeric.arrays import Array
from kin.numeric.interval import Ball

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

Row = TypeVar("Row", Array, Ball)


@lru_cache(maxsize=64)
def factorials(order: int) -> Array:
    """Return k! as a column (order + 1, 1), not to be written to; exact in double up to 22!."""
    column = np.array([float(math.factorial(k)) for k in range(order + 1)])[:, None]
    column.setflags(write=False)
    return column


def product(a: Array, b: Array) -> Array:
    """Return the Cauchy product (m, n) of coefficients a and b (m, n), cut off at the same order."""
    out: Array = a[0] * b
    for i in range(1, len(a)):
        out[i:] += a[i] * b[:-i]
    return out


def quotient(a: Array, b: Array) -> Array:
    """Taylor coefficients (m, n) of a/b, from those of a and b (m, n), by long division; b[0] must not be 0."""
    out, remainder = np.empty_like(a), a.copy()
    for k in range(len(a)):
        out[k] = remainder[k] / b[0]
        remainder[k + 1 :] -= out[k] * b[1 : len(a) - k]
    return out


def ball_product(a: Ball, b: Ball) -> Ball:
    """Return the truncated Cauchy product of ball coefficients (m, n); rows that are exactly 0 stay so."""
    with np.errstate(all="ignore"):
        size, p, q = len(a.mid), np.abs(a.mid), np.abs(b.mid)
        sizes = np.array([p + a.rad, q + b.rad])
        # Each sum of products is off by at most (size + 1) half ulps of the sum of magnitudes.
        unit = 2.0**-52 * (size + 2)
        # Three products in one: of the midpoints, and the two that make the radius.
        left, right = np.empty((2, size, 3, *p.shape[1:]))
        left[:, 0], left[:, 1], left[:, 2] = a.mid, p, a.rad
        right[:, 0], right[:, 1], right[:, 2] = b.mid, b.rad + unit * q, sizes[1]
        product_rows = product(left, right)
        mid, rad = product_rows[:, 0], (product_rows[:, 1] + product_rows[:, 2]) * (1 + 4 * unit)
        # Products that underflow are allowed for in the rows from `low` to `high`, those that need not be exactly 0.
        live = np.any(sizes, axis=2)
        if live.any(axis=1).all():
            low, high = live.argmax(axis=1).sum(), 2 * size - 1 - live[:, ::-1].argmax(axis=1).sum()
            rad[low:high] += 64 * np.minimum(sizes.max(axis=1).min(axis=0), 1e-300)
        if not np.isfinite(rad).all():  # a ball beyond all numbers is the whole line
            sound = np.isfinite(rad)
            mid, rad = np.where(sound, mid, 0.0), np.where(sound, rad, np.inf)
        return Ball(mid, rad)


def compose(outer: Array, inner: Array) -> Array:
    """Coefficients (m, n) of f(g), from the coefficients `outer` (m, n) of f at g[0] and `inner` (m, n) of g."""
    size = len(inner)
    if not inner[2:].any():
        out = outer.copy()
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
    """Enclose the Taylor coefficients (m, n) of f(g).

    `outer` (m, n) encloses the coefficients of f over the balls g[0], `inner` (m, n) the coefficients of g.
    """
    size = len(inner.mid)
    if not inner.mid[2:].any() and not inner.rad[2:].any():
        return outer * inner[1].powers(size) if size > 1 else outer
    mid, rad = outer.mid[-1:], outer.rad[-1:]
    for k in range(size - 2, -1, -1):
        more = ball_product(Ball(mid, rad), inner[1 : size - k])
        mid, rad = np.vstack((outer.mid[k], more.mid)), np.vstack((outer.rad[k], more.rad))
    return Ball(mid, rad)


def stack(rows: list[Row]) -> Row:
    """One array (m, n) of m rows (n,), of numbers or of balls."""
    if isinstance(rows[0], Ball):
        return Ball(np.array([row.mid for row in rows]), np.array([row.rad for row in rows]))
    return np.array(rows)


# Taylor coefficients of the elementary functions at x (n,), (order + 1, n); one text for numbers and for balls.


@lru_cache(maxsize=256)
def binomials(numerator: float, order: int, denominator: int = 1) -> tuple[float, ...]:
    """Binomial coefficients "numerator/denominator choose k" for k from 0 to `order`, each the nearest double."""
    from fractions import Fraction

    exponent, value, coefficients = Fraction(numerator) / denominator, Fraction(1), []
    for k in range(order + 1):
        coefficients.append(float(value))
        value = value * (exponent - k) / (k + 1)
    return tuple(coefficients)


def power_rows(x: Row, exponent: float, order: int) -> Row:
    """Taylor coefficients (order + 1, n) of x**exponent; a whole exponent from 0 up leaves exact zeros above itself."""
    if isinstance(x, Ball):
        left, off, factors = _power_columns(exponent, order)
        mid, rad = np.zeros((2, order + 1, *x.mid.shape))
        powers = x**left * factors if off is None else x**left * x**off * factors
        mid[: len(left)], rad[: len(left)] = powers.mid, powers.rad
        return Ball(mid, rad)
    rows = []
    if exponent < 0 or exponent == 0.5:
        value, inverse = np.sqrt(x) if exponent == 0.5 else x**exponent, 1.0 / x
        for binomial in binomials(exponent, order):
            rows.append(value * binomial)
            value = value * inverse
        return np.array(rows)
    for k, binomial in enumerate(binomials(exponent, order)):
        if binomial == 0:
            rows.append(x * 0.0)
        elif _exact(exponent, k):
            rows.append(x ** (exponent - k) * binomial)
        else:
            rows.append(x**exponent * x**-k * binomial)
    return np.array(rows)


@lru_cache(maxsize=256)
def _power_columns(exponent: float, order: int) -> tuple[Array, Array | None, Array]:
    """Exponents, those of a second factor where one exponent would be rounded, and binomials: columns, down to a 0."""
    factors = [factor for factor in binomials(exponent, order) if factor]
    left, k = np.full((len(factors), 1), float(exponent)), np.arange(len(factors), dtype=float)[:, None]
    exact = all(_exact(exponent, i) for i in range(len(factors)))
    return (left - k, None, np.array(factors)[:, None]) if exact else (left, -k, np.array(factors)[:, None])


def _exact(exponent: float, k: int) -> bool:
    """Whether exponent - k is a double."""
    return math.fsum((exponent, -k, k - exponent)) == 0.0


def polynomial_rows(coefficients: Sequence[float] | Array, x: Ball, order: int) -> Ball:
    """Taylor coefficients (order + 1, n) over balls x (n,) of polynomials by their coefficients (k,) or (k, n).

    Coefficients stand lowest first. Row i is the sum of binom(i + p, i) a_(i + p) x**p, all rows by Horner's scheme at
    once, which encloses no wider than the scheme on series does; rows above the degree are exactly 0.
    """
    a = np.array(coefficients, dtype=float).reshape(len(coefficients), -1)
    factors, place = _shifts(len(a), min(order, len(a) - 1))
    m, r, whole = x.mid, x.rad, np.abs(x.mid) + x.rad
    mid, rad = np.zeros((2, order + 1, len(m)))
    rows = factors * a[place]  # (power, row, n), each off by half an ulp of the coefficient, and half of its own
    with np.errstate(all="ignore"):
        # 2 ulps of the sum and of what is added cover the roundings of a step, the last factor those of the radius
        off, total = 2.0 * 2.0**-52 * np.abs(rows), rows[-1]
        size, radius = np.abs(total), off[-1]
        for row, row_off in zip(rows[-2::-1], off[-2::-1], strict=True):
            radius = size * r + radius * whole
            total = total * m + row
            size = np.abs(total)
            radius += size * (2.0 * 2.0**-52) + row_off
        # what underflows on the way grows no more than powers do
        lost = np.where(rows[1:].any(axis=0), np.minimum(whole, 1e-300) * np.maximum(whole, 1.0) ** len(a), 0.0)
        radius = (radius + 64.0 * lost) * (1.0 + 8.0 * len(a) * 2.0**-52)
        sound = np.isfinite(radius)
    mid[: len(total)], rad[: len(total)] = np.where(sound, total, 0.0), np.where(sound, radius, np.inf)
    return Ball(mid, rad)


@lru_cache(maxsize=64)
def _shifts(count: int, order: int) -> tuple[Array, NDArray[np.intp]]:
    """Binomials binom(i + p, i) (count, order + 1, 1), 0 beyond `count` coefficients, and places i + p, clipped."""
    power, row = np.arange(count)[:, None], np.arange(order + 1)
    binomial = [[float(math.comb(i + p, i)) if i + p < count else 0.0 for i in range(order + 1)] for p in range(count)]
    return np.array(binomial)[:, :, None], np.minimum(power + row, count - 1)


def led(rows: Row, value: Row) -> Row:
    """Return the rows, changed in place, with `value` as the first of them."""
    if isinstance(rows, Ball) and isinstance(value, Ball):
        rows.mid[0], rows.rad[0] = value.mid, value.rad
    else:
        rows[0] = value
    return rows


def sine_rows(s: Row, c: Row, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of sin, from sin and cos."""
    cycle = [s, c, -s, -c]
    return stack([cycle[k % 4] for k in range(order + 1)]) / factorials(order)


def sinh_rows(s: Row, c: Row, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of sinh, from sinh and cosh."""
    return stack([c if k % 2 else s for k in range(order + 1)]) / factorials(order)


def exp_rows(value: Row, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of exp, from its value."""
    return value / factorials(order)


def log_rows(x: Row, value: Row, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of log, from its value at x."""
    return stack([value] + [x**-k / (k if k % 2 else -k) for k in range(1, order + 1)])


def cbrt_rows(x: Row, value: Row, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of the cube root, from its value at x of either sign."""
    factors = binomials(1.0, order, 3)
    return stack([value] + [value * x**-k * factors[k] for k in range(1, order + 1)])


def tan_rows(value: Row, sense: float, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of tan (sense 1), tanh (sense -1), from the value: y' = 1 + sense y^2."""
    rows = [value]
    if order:
        rows.append(value**2 * sense + 1.0)
    for k in range(1, order):
        square = rows[0] * rows[k]
        for j in range(1, k + 1):
            square = square + rows[j] * rows[k - j]
        rows.append(square * sense / (k + 1))
    return stack(rows)


def atan_rows(x: Row, value: Row, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of atan, from its value at x: (1 + x^2) y' = 1, differentiated."""
    slope = (x**2 + 1.0) ** -1
    rows = [value, slope]
    for k in range(1, order):
        # With d_k = (k + 1) y_(k+1):  (1 + x^2) d_k + 2 x d_(k-1) + d_(k-2) = 0.
        before = x * rows[k] * (2 * k)
        if k > 1:
            before = before + rows[k - 1] * (k - 1)
        rows.append(-before * slope / (k + 1))
    return stack(rows[: order + 1])


def asin_rows(x: Row, value: Row, order: int) -> Row:
    """Taylor coefficients (order + 1, ...) of asin, from its value at x: (1 - x^2) y'' = x y', differentiated."""
    complement = (1.0 - x) * (1.0 + x)
    slope = complement**-1
    rows = [value, complement**-0.5]
    for k in range(order - 1):
        # With d_k = (k + 1) y_(k+1):  (k + 1)(1 - x^2) d_(k+1) = (2 k + 1) x d_k + k d_(k-1).
        rise = x * rows[k + 1] * ((2 * k + 1) * (k + 1))
        if k:
            rise = rise + rows[k] * (k * k)
        rows.append(rise * slope / ((k + 1) * (k + 2)))
    return stack(rows[: order + 1])
