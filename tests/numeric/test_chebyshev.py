"""Chebyshev series: values by every way of asking, and the same series on parts of the interval."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kin.numeric.chebyshev import DEGREE, DERIVATIVE, INTEGRAL, NODES, evaluated, fitted, split, together, value


@given(st.integers(1, 3000), st.integers(0, 2**32 - 1))
def test_values_are_those_of_numpy(count: int, seed: int) -> None:
    """Few places are asked by cosines, many by recurrence: both give the same."""
    rng = np.random.default_rng(seed)
    series, row, x = rng.normal(size=(4, DEGREE + 1)), rng.integers(0, 4, count), rng.uniform(-1.0, 1.0, count)
    expected = np.polynomial.chebyshev.chebval(x, series.T)
    assert np.abs(together(series, x) - expected).max() < 1e-12
    assert np.abs(evaluated(series, row, x) - expected[row, np.arange(count)]).max() < 1e-12
    assert value(series[0].tolist(), float(x[0])) == pytest.approx(expected[0, 0], abs=1e-12)


@given(st.integers(1, 40), st.integers(0, 2**32 - 1))
def test_on_parts_a_series_is_the_same_function(parts: int, seed: int) -> None:
    series = np.random.default_rng(seed).normal(size=(3, 2, DEGREE + 1))
    cut = split(series, parts)
    assert cut.shape == (3, 2, parts, DEGREE + 1)
    x = np.linspace(-1.0, 1.0, 7)
    for part in range(parts):
        whole = together(series, (2.0 * part + 1.0 + x) / parts - 1.0)
        assert np.abs(together(cut[:, :, part], x) - whole).max() < 1e-11


def test_a_polynomial_of_the_degree_is_its_own_series() -> None:
    rng = np.random.default_rng(1)
    power = rng.normal(size=9)
    series = fitted(np.polynomial.polynomial.polyval(NODES, power))
    assert series[:9] == pytest.approx(np.polynomial.chebyshev.poly2cheb(power), abs=1e-14)
    assert np.abs(series[9:]).max() < 1e-14


@pytest.mark.thin(2)
@pytest.mark.parametrize("count", [7, 5000])  # either way of summing
def test_values_derivative_and_integral_of_an_exponential(count: int) -> None:
    x = np.linspace(-1.0, 1.0, count)
    series = fitted(np.exp(NODES))[None]
    row = np.zeros(count, dtype=np.intp)
    assert evaluated(series, row, x) == pytest.approx(np.exp(x), rel=1e-14)
    assert evaluated(series @ DERIVATIVE.T, row, x) == pytest.approx(np.exp(x), abs=1e-11)
    assert evaluated(series @ INTEGRAL.T, row, x) == pytest.approx(np.exp(x) - np.exp(-1.0), abs=1e-14)


def test_the_degree_holds_four_radians() -> None:
    series = fitted(np.cos(4.0 * NODES))
    assert np.abs(series[-2:]).max() < 1e-15
    assert np.abs(fitted(np.cos(16.0 * NODES))[-2:]).max() > 1e-4
