"""Chebyshev series of one degree on many intervals at once: coefficients, values, derivative and integral.

A row of coefficients (DEGREE + 1,) belongs to x in [-1, 1]. The degree is such that exp(4 i x) is held to rounding:
its coefficients are Bessel's J_k(4), and J_25(4) is below 1e-17.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

DEGREE = 24
_COUNT = DEGREE + 1
ORDERS: Array = np.arange(_COUNT, dtype=np.float64)
"""0 to DEGREE: the series' value at x = cos t is their sum with cos(ORDERS t)."""
_FEW = 100  # values, from which Clenshaw's recurrence is quicker than cosines
_ANGLES = np.pi * (np.arange(_COUNT) + 0.5) / _COUNT

NODES: Array = np.cos(_ANGLES)
"""Points of the first kind (DEGREE + 1,), all of them inside the interval."""


def _coefficients() -> Array:
    matrix: Array = 2.0 / _COUNT * np.cos(np.arange(_COUNT)[:, None] * _ANGLES)
    matrix[0] *= 0.5
    return matrix


def _derivative() -> Array:
    """c'_k = 2 (sum of j c_j over j = k + 1, k + 3, ...), halved for k = 0."""
    k, j = np.arange(_COUNT)[:, None], np.arange(_COUNT)
    matrix = np.where((j > k) & ((j - k) % 2 == 1), 2.0 * j, 0.0)
    matrix[0] *= 0.5
    return matrix


def _integral() -> Array:
    """Integral from -1: of T_k it is T_{k+1}/(2k + 2) - T_{k-1}/(2k - 2) and a constant; beyond DEGREE cut off."""
    matrix = np.zeros((_COUNT + 1, _COUNT))
    matrix[1, 0] = 1.0
    matrix[2, 1] = 0.25
    for k in range(2, _COUNT):
        matrix[k + 1, k] = 0.5 / (k + 1)
        matrix[k - 1, k] = -0.5 / (k - 1)
    signs = np.where(np.arange(_COUNT + 1) % 2, -1.0, 1.0)
    matrix[0] = -(signs[1:] @ matrix[1:])
    return matrix[:-1]


_TO_COEFFICIENTS = _coefficients()
DERIVATIVE: Array = _derivative()
"""Matrix that takes coefficients to those of the derivative by x: strictly upper triangular."""
INTEGRAL: Array = _integral()
"""Matrix that takes coefficients to those of the integral from -1 to x."""
AT_START: Array = np.where(np.arange(_COUNT) % 2, -1.0, 1.0)
"""Weights of the coefficients in the value at x = -1; at x = 1 all are 1."""


def fitted(values: Array) -> Array:
    """Coefficients (..., DEGREE + 1) of the series through values at NODES (..., DEGREE + 1)."""
    coefficients: Array = values @ _TO_COEFFICIENTS.T
    return coefficients


def evaluated(coefficients: Array, row: Indices, x: Array) -> Array:
    """Values (n,) at x (n,) in [-1, 1] of the series in the rows (n,) of `coefficients` (m, DEGREE + 1).

    A few values are sums of cosines, which save calls; many are by Clenshaw's recurrence, which saves work. Where all
    rows have the same x, `together` is quicker.
    """
    value: Array
    if len(x) <= _FEW:
        angle = np.arccos(np.minimum(np.maximum(x, -1.0), 1.0))
        value = np.einsum("nk,nk->n", coefficients[row], np.cos(angle[:, None] * ORDERS))
        return value
    used = np.flatnonzero(coefficients.any(axis=0))
    columns = np.ascontiguousarray(coefficients.T)
    ahead, further = np.zeros_like(x), np.zeros_like(x)
    twice = 2.0 * x
    for k in range(int(used[-1]) if len(used) else 0, 0, -1):
        ahead, further = columns[k][row] + twice * ahead - further, ahead
    value = columns[0][row] + x * ahead - further
    return value


def together(coefficients: Array, x: Array) -> Array:
    """Values (..., n) of all rows of `coefficients` (..., DEGREE + 1) at the same x (n,) in [-1, 1]."""
    values: Array = coefficients @ polynomials(x)
    return values


def polynomials(x: Array) -> Array:
    """Chebyshev polynomials (DEGREE + 1, n) at x (n,) in [-1, 1]."""
    values: Array = np.cos(ORDERS[:, None] * np.arccos(np.minimum(np.maximum(x, -1.0), 1.0)))
    return values


def split(coefficients: Array, parts: int) -> Array:
    """Coefficients (..., parts, DEGREE + 1) of the series on equal parts of the interval, from (..., DEGREE + 1)."""
    x = (2.0 * np.arange(parts)[:, None] + 1.0 + NODES) / parts - 1.0
    return fitted(together(coefficients, x.ravel()).reshape(*coefficients.shape[:-1], parts, _COUNT))


def value(coefficients: list[float], x: float) -> float:
    """Value of one series at one x in [-1, 1] in plain floats, by Clenshaw's recurrence."""
    ahead = further = 0.0
    twice = 2.0 * x
    for k in range(len(coefficients) - 1, 0, -1):
        ahead, further = coefficients[k] + twice * ahead - further, ahead
    return coefficients[0] + x * ahead - further


def degrees(coefficients: Array, floor: float) -> Indices:
    """Highest degree (m,) at which a coefficient of each row (m, DEGREE + 1) exceeds `floor` in size; 0 without any."""
    above = np.abs(coefficients) > floor
    highest: Indices = np.where(above.any(axis=1), DEGREE - np.argmax(above[:, ::-1], axis=1), 0)
    return highest
