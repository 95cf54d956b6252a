"""Polynomials on [0, 1] by their Bernstein coefficients, many at a time: values, products, parts, roots."""

from __future__ import annotations

from math import comb
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.arcs import Array

__all__ = ["bernstein_product", "halves", "restrict", "rising_root", "roots", "values"]

# Roots closer to an end than this are taken for the end itself.
END_MARGIN = 1e-12
# An interval this narrow whose coefficients still change sign more than once holds a touching root, for our purposes.
TOUCHING = 1e-9
# Newton's steps double their digits: after one this short the next would be below rounding.
SETTLED = 1e-12
# Enough for bisection alone, should Newton's steps never fall inside the bracket.
BISECTIONS = 60
# Below the spacing of floating-point numbers next to 1.
NARROWEST = 2e-16


def values(coefficients: Array, t: Array) -> Array:
    """Values of Bernstein polynomials by de Casteljau: coefficients (n, k+1, ...), t (n,) -> (n, ...)."""
    s = t.reshape(t.shape + (1,) * (coefficients.ndim - 1))
    b = coefficients
    while b.shape[1] > 1:
        b = b[:, :-1] * (1.0 - s) + b[:, 1:] * s
    return b[:, 0]


def bernstein_product(f: Array, g: Array) -> Array:
    """Bernstein coefficients of products, f (n, j+1) and g (n, k+1) -> (n, j+k+1)."""
    j, k = f.shape[1] - 1, g.shape[1] - 1
    out = np.zeros((f.shape[0], j + k + 1))
    for i in range(j + 1):
        weights = np.array([comb(j, i) * comb(k, m) / comb(j + k, i + m) for m in range(k + 1)])
        out[:, i : i + k + 1] += f[:, i : i + 1] * (g * weights)
    return out


def halves(coefficients: Array) -> tuple[Array, Array]:
    """Coefficients (n, k+1, ...) over [0, 1/2] and over [1/2, 1]."""
    k = coefficients.shape[1]
    left, right = np.empty_like(coefficients), np.empty_like(coefficients)
    b = coefficients
    for level in range(k):
        left[:, level] = b[:, 0]
        right[:, k - 1 - level] = b[:, -1]
        b = (b[:, :-1] + b[:, 1:]) / 2.0
    return left, right


def restrict(coefficients: Array, a: Array, b: Array) -> Array:
    """Coefficients (n, k+1, ...) over the intervals [a, b] (n,) instead of [0, 1]."""
    shape = (a.size,) + (1,) * (coefficients.ndim - 1)
    right = coefficients.copy()
    s = a.reshape(shape)
    for level in range(1, coefficients.shape[1]):  # what lies right of a
        right[:, :-level] = right[:, :-level] * (1.0 - s) + right[:, 1 : right.shape[1] - level + 1] * s
    with np.errstate(invalid="ignore", divide="ignore"):
        s = np.where(a < 1.0, (b - a) / (1.0 - a), 0.0).reshape(shape)
    left = right.copy()
    for level in range(1, coefficients.shape[1]):  # and of that, what lies left of b
        left[:, level:] = left[:, level - 1 : -1] * (1.0 - s) + left[:, level:] * s
    return left


def rising_root(coefficients: Array) -> Array:
    """Where polynomials (n, k+1) that rise through zero at most once do so: t (n,), 0 or 1 where they do not.

    Newton's steps, kept inside a shrinking bracket.
    """
    n, k = len(coefficients), coefficients.shape[1] - 1
    slope = k * np.diff(coefficients, axis=1) if k else np.zeros((n, 1))
    low, high = np.zeros(n), np.ones(n)
    with np.errstate(invalid="ignore", divide="ignore"):
        t = coefficients[:, 0] / (coefficients[:, 0] - coefficients[:, -1])
    t = np.where((t > 0.0) & (t < 1.0), t, 0.5)
    for _ in range(BISECTIONS):
        g = values(coefficients, t)
        low, high = np.where(g < 0.0, t, low), np.where(g < 0.0, high, t)
        with np.errstate(invalid="ignore", divide="ignore"):
            following = t - g / values(slope, t)
        inside = (following >= low) & (following <= high)
        following = np.where(inside, following, (low + high) / 2.0)
        moved = np.abs(following - t)
        t = following
        if not bool((moved > SETTLED).any()):
            break
    return t


def roots(coefficients: Array) -> list[float]:
    """Where a Bernstein polynomial (k+1,) changes sign inside (0, 1), rising; a touching root may be listed too.

    The number of sign changes of the coefficients bounds the number of roots (variation diminishing): none or one is
    decided at once, more are halved.
    """
    found: list[float] = []
    stack = [(coefficients, 0.0, 1.0)]
    while stack:
        c, a, b = stack.pop()
        signs = np.sign(c[c != 0.0])
        changes = int(np.count_nonzero(signs[1:] != signs[:-1]))
        if changes == 0:
            continue
        if b - a < NARROWEST or (changes > 1 and b - a < TOUCHING):
            found.append((a + b) / 2.0)
            continue
        left, right = halves(c[None])
        if left[0, -1] == 0.0:
            found.append((a + b) / 2.0)
        stack.append((right[0], (a + b) / 2.0, b))
        stack.append((left[0], a, (a + b) / 2.0))
    return sorted({t for t in found if END_MARGIN < t < 1.0 - END_MARGIN})
