"""Cubic splines of given end slopes: their slopes and coefficients against a system solved with 50 digits."""

from __future__ import annotations

from itertools import pairwise

import mpmath
import numpy as np
import pytest

from kin.numeric.cubics import coefficients, spline_slopes
from kin.numeric.quintics import polynomial

X = np.array([0.0, 0.3, 0.35, 1.0, 2.5, 2.9])
Y = np.array([1.0, -2.0, 0.5, 0.25, 4.0, 4.0])


def test_slopes_are_those_of_the_spline_whose_second_derivative_is_continuous() -> None:
    """Second derivatives M solve h M + 2 (h + k) M + k M = 6 (d - c), rows of the ends with the slopes given."""
    first, last, n = -3.0, 7.0, len(X)
    with mpmath.workdps(50):
        h = [mpmath.mpf(b) - mpmath.mpf(a) for a, b in pairwise(X)]
        d = [(mpmath.mpf(b) - mpmath.mpf(a)) / w for a, b, w in zip(Y[:-1], Y[1:], h, strict=True)]
        matrix, right = mpmath.zeros(n), mpmath.zeros(n, 1)
        matrix[0, 0], matrix[0, 1], right[0] = 2 * h[0], h[0], 6 * (d[0] - first)
        matrix[n - 1, n - 1], matrix[n - 1, n - 2], right[n - 1] = 2 * h[-1], h[-1], 6 * (last - d[-1])
        for i in range(1, n - 1):
            matrix[i, i - 1], matrix[i, i], matrix[i, i + 1] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
            right[i] = 6 * (d[i] - d[i - 1])
        bend = mpmath.lu_solve(matrix, right)
        slopes = [d[i] - h[i] * (2 * bend[i] + bend[i + 1]) / 6 for i in range(n - 1)]
    found = spline_slopes(X, Y, first, last)
    assert found == pytest.approx([*map(float, slopes), last], rel=1e-13)
    width = np.diff(X)
    c = coefficients(np.stack([Y, found])[:, :-1], np.stack([Y, found])[:, 1:], width)
    begins, ends = (polynomial(c, width, at * width, 2) for at in (0.0, 1.0))
    assert ends[:, :-1] == pytest.approx(begins[:, 1:], abs=1e-10)
    assert begins[2] == pytest.approx([float(value) for value in bend[:-1]], rel=1e-12)


def test_two_points_are_one_cubic() -> None:
    assert spline_slopes(np.array([0.0, 2.0]), np.array([1.0, 5.0]), 3.0, -1.0).tolist() == [3.0, -1.0]
