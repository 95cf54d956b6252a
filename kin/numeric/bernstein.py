"""Polynomials on [0, 1] by their Bernstein coefficients, many at a time: values, products, parts, roots."""

from __future__ import annotations

from functools import lru_cache
from math import comb
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.newton import zeros

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array

# Roots closer to an end than this are taken for the end itself.
END_MARGIN = 1e-12
# An interval this narrow whose coefficients still change sign more than once is taken to hold a touching root.
TOUCHING = 1e-9
# Newton's steps double their digits: after one this short the next would be below rounding.
SETTLED = 1e-12
# Below the spacing of floating-point numbers next to 1.
NARROWEST = 2e-16


def values(coefficients: Array, t: Array) -> Array:
    """Values of Bernstein polynomials: coefficients (n, k+1, ...), t (n,) in [0, 1] -> (n, ...); exact at both ends.

    By Horner's rule in t/(1 - t) or its inverse, whichever is at most 1 (Schumaker and Volk, CAGD 3, 1986): the cost
    grows with k, not with its square, and the rounding is that of de Casteljau's scheme within a factor of two.
    """
    rows, _, near, ratio = _turned(coefficients, t)
    k = len(rows) - 1
    value = rows[k]
    # the binomials are symmetric
    for i, share in zip(range(k - 1, -1, -1), binomials(k)[1:], strict=True):
        value = value * ratio + share * rows[i]
    value = value * near**k
    out: Array = value.transpose(-1, *range(value.ndim - 1))
    return out


def values_and_slopes(coefficients: Array, t: Array) -> tuple[Array, Array]:
    """Values and derivatives by t, (n,) each, of Bernstein polynomials: coefficients (n, k+1), k >= 1, and t (n,).

    The values are those of `values`; slopes are good to some k roundings of the greatest coefficient.
    """
    rows, late, near, ratio = _turned(coefficients, t)
    k = len(rows) - 1
    value, slope = rows[k], np.zeros(len(t))
    for i, share in zip(range(k - 1, -1, -1), binomials(k)[1:], strict=True):
        slope = slope * ratio + value
        value = value * ratio + share * rows[i]
    power = near ** (k - 1)
    slope = power * (slope / near - k * value)
    return value * near**k, np.where(late, -slope, slope)


def _turned(coefficients: Array, t: Array) -> tuple[Array, NDArray[np.bool_], Array, Array]:
    """Coefficients (k+1, ..., n) from the end that is nearer to t, whether that is the last, 1 - s and s/(1 - s).

    s (n,) is the distance from there.
    """
    rows = coefficients.transpose(*range(1, coefficients.ndim), 0)  # the loops of numpy run along the polynomials
    late = t > 0.5
    if bool(late.any()):
        rows = np.where(late, rows[::-1], rows)
    away = np.where(late, 1.0 - t, t)
    near = 1.0 - away
    return rows, late, near, away / near


@lru_cache
def binomials(k: int) -> tuple[float, ...]:
    """Binomial coefficients "k choose i" for i from 0 to k."""
    return tuple(float(comb(k, i)) for i in range(k + 1))


@lru_cache
def shares(j: int, k: int) -> Array:
    """Weights (j+1, k+1) of f_i g_m in the Bernstein coefficient i + m of a product of degrees j and k."""
    i, m = np.arange(j + 1)[:, None], np.arange(k + 1)
    shares: Array = np.outer(binomials(j), binomials(k)) / np.array(binomials(j + k))[i + m]
    shares.flags.writeable = False
    return shares


def bernstein_product(f: Array, g: Array) -> Array:
    """Bernstein coefficients of products, f (n, j+1) and g (n, k+1) -> (n, j+k+1)."""
    j, k = f.shape[1] - 1, g.shape[1] - 1
    if j > k:
        f, g, j, k = g, f, k, j
    first, second = np.ascontiguousarray(f.T), np.ascontiguousarray(g.T)
    out = np.zeros((j + k + 1, f.shape[0]))
    for i, weights in enumerate(shares(j, k)):
        out[i : i + k + 1] += first[i] * (second * weights[:, None])
    return out.T


def cross_product(f: Array, g: Array) -> Array:
    """Bernstein coefficients (n, j+k+1) of cross products of plane vectors, f (n, j+1, 2) and g (n, k+1, 2)."""
    return bernstein_product(f[:, :, 0], g[:, :, 1]) - bernstein_product(f[:, :, 1], g[:, :, 0])


def derivative(coefficients: Array) -> Array:
    """Bernstein coefficients (n, k, ...) of derivatives, from (n, k+1, ...)."""
    differences: Array = (coefficients.shape[1] - 1) * np.diff(coefficients, axis=1)
    return differences


def halves(coefficients: Array) -> tuple[Array, Array]:
    """Coefficients (n, k+1, ...) over [0, 1/2] and over [1/2, 1], from those over [0, 1]."""
    k = coefficients.shape[1]
    left, right = np.empty_like(coefficients), np.empty_like(coefficients)
    b = coefficients
    for level in range(k):
        left[:, level] = b[:, 0]
        right[:, k - 1 - level] = b[:, -1]
        b = (b[:, :-1] + b[:, 1:]) / 2.0
    return left, right


def split(coefficients: Array, share: Array) -> tuple[Array, Array]:
    """Coefficients (n, k+1, ...) over [0, share] and over [share, 1], from those over [0, 1]; `share` is (n,)."""
    rows = np.array(np.moveaxis(coefficients, 0, -1), order="C")
    left, back = np.empty_like(rows), 1.0 - share
    left[0] = rows[0]
    for level in range(1, len(rows)):
        rows[:-level] = rows[:-level] * back + rows[1 : len(rows) - level + 1] * share
        left[level] = rows[0]
    return np.ascontiguousarray(np.moveaxis(left, -1, 0)), np.ascontiguousarray(np.moveaxis(rows, -1, 0))


def restrict(coefficients: Array, a: Array, b: Array) -> Array:
    """Coefficients (n, k+1, ...) over the intervals [a, b], (n,) each, from those over [0, 1]; 0 <= a <= b <= 1."""
    rows = np.array(np.moveaxis(coefficients, 0, -1), order="C")
    for level in range(1, len(rows)):  # what lies right of a
        rows[:-level] = rows[:-level] * (1.0 - a) + rows[1 : len(rows) - level + 1] * a
    with np.errstate(invalid="ignore", divide="ignore"):
        s = np.where(a < 1.0, (b - a) / (1.0 - a), 0.0)
    for level in range(1, len(rows)):  # and of that, what lies left of b
        rows[level:] = rows[level - 1 : -1] * (1.0 - s) + rows[level:] * s
    out: Array = np.ascontiguousarray(np.moveaxis(rows, -1, 0))
    return out


def rising_root(coefficients: Array) -> Array:
    """Roots t (n,) in [0, 1] of polynomials (n, k+1) that rise through zero at most once.

    A polynomial that is 0 or above from the start gives 0, one that stays below gives 1. Good to `SETTLED`, mostly to
    rounding. Raises UnsettledError where a coefficient is not a number.
    """
    first, last = _first_sign(coefficients), _first_sign(coefficients[:, ::-1])
    root = np.where(first >= 0.0, 0.0, 1.0)
    inside = np.flatnonzero(~((first >= 0.0) | (last <= 0.0)))
    c, ends = coefficients[inside], (np.zeros(len(inside)), np.ones(len(inside)))
    with np.errstate(invalid="ignore", divide="ignore"):
        t = c[:, 0] / (c[:, 0] - c[:, -1])
    t = np.where((t > 0.0) & (t < 1.0), t, 0.5)
    root[inside] = zeros(lambda t: values_and_slopes(c, t), *ends, t, SETTLED)
    return root


def _first_sign(coefficients: Array) -> Array:
    """First coefficient of each row (n, k+1) that is not 0: its sign is that of the polynomial just behind 0, (n,)."""
    place = np.argmax(coefficients != 0.0, axis=1)
    sign: Array = coefficients[np.arange(len(coefficients)), place]
    return sign


def roots(coefficients: Array) -> list[float]:
    """Roots in (0, 1), rising, at which a Bernstein polynomial (k+1,) changes sign; a touching root may be listed too.

    Roots within END_MARGIN of 0 or 1 are left out. The number of sign changes of the coefficients bounds the number of
    roots (variation diminishing): an interval without any is left, others are halved.
    """
    places: list[float] = []
    stack = [(coefficients, 0.0, 1.0)]
    while stack:
        c, a, b = stack.pop()
        signs = np.sign(c[c != 0.0])
        changes = int(np.count_nonzero(signs[1:] != signs[:-1]))
        if changes == 0:
            continue
        if b - a < NARROWEST or (changes > 1 and b - a < TOUCHING):
            places.append((a + b) / 2.0)
            continue
        left, right = halves(c[None])
        if left[0, -1] == 0.0:
            places.append((a + b) / 2.0)
        stack.append((right[0], (a + b) / 2.0, b))
        stack.append((left[0], a, (a + b) / 2.0))
    return sorted({t for t in places if END_MARGIN < t < 1.0 - END_MARGIN})
