"""Inverses by a table and Newton's method: to rounding, in few evaluations, and at the ends."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kin.numeric.elementary import Jet, sinh
from kin.numeric.inverse import Inverse


@given(st.floats(0.1, 0.99), st.floats(0.0, 6.283))
def test_an_inverse_is_good_to_rounding(bend: float, place: float) -> None:
    """y = x - bend sin x, Kepler's equation."""
    inverse = Inverse(lambda x: (x - bend * np.sin(x), 1.0 - bend * np.cos(x)), np.linspace(0.0, 2.0 * np.pi, 257))
    assert inverse(np.array([place - bend * np.sin(place)]))[0] == pytest.approx(
        place, abs=1e-15 + 1e-15 / (1.0 - bend)
    )


def test_a_smooth_inverse_takes_a_table_and_one_more_evaluation() -> None:
    sizes = []

    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sizes.append(x.size)
        return np.sinh(x), np.cosh(x)

    inverse = Inverse(function, np.linspace(-1.0, 1.0, 257))
    value = np.linspace(-1.0, 1.0, 100)
    assert inverse(value) == pytest.approx(np.arcsinh(value), abs=2e-16)
    assert inverse(value[:7]) == pytest.approx(np.arcsinh(value[:7]), abs=2e-16)
    assert sizes == [257, 100, 7]


def test_beyond_the_places_their_end_is_given() -> None:
    inverse = Inverse(lambda x: (x**3 + x, 3.0 * x**2 + 1.0), np.linspace(1.0, 2.0, 17))
    assert inverse(np.array([-5.0, 2.0, 10.0, 11.0])).tolist() == [1.0, 1.0, 2.0, 2.0]


def test_a_series_over_the_inverse_takes_one_evaluation() -> None:
    """x over sinh x: its derivatives by mpmath, and nothing is evaluated but the table and the series itself."""
    sizes = []

    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sizes.append(x.size)
        return np.sinh(x), np.cosh(x)

    def pair(x: Jet) -> tuple[Jet, Jet]:
        sizes.append(x.order)
        return x, sinh(x)

    inverse = Inverse(function, np.linspace(-1.0, 1.0, 257))
    value = np.linspace(-1.1, 1.1, 12)
    found = inverse.series(pair, value, 3)
    assert sizes == [257, 4]
    for column, at in enumerate(value.tolist()):
        with mp.workdps(40):
            assert found[:, column] == pytest.approx([float(c) for c in mp.taylor(mp.asinh, at, 3)], abs=4e-16)


def test_a_series_where_no_derivative_more_exists() -> None:
    """y = x + x^2.5 / 2 has two derivatives at 0: x over y is y - y^2.5 / 2 there, and no third one is asked for."""

    def pair(x: Jet) -> tuple[Jet, Jet]:
        return x, x + x**2.5 * 0.5

    inverse = Inverse(lambda x: (x + 0.5 * x**2.5, 1.0 + 1.25 * x**1.5), np.linspace(0.0, 1.0, 257))
    found = inverse.series(pair, np.array([0.0, 1.5]), 2)
    assert found[:, 0].tolist() == [0.0, 1.0, 0.0]
    # x' = 1/y', x'' = -y''/y'^3, with y' = 9/4 and y'' = 15/8 at 1
    assert found[:, 1] == pytest.approx([1.0, 4.0 / 9.0, -0.5 * 1.875 / 2.25**3], rel=1e-15)


def test_a_series_close_to_a_singular_place_keeps_its_digits() -> None:
    """Near 0 the second derivative of x over y = x + x^2.5 / 2 goes with the root: no step along a series is taken."""

    def pair(x: Jet) -> tuple[Jet, Jet]:
        return x, x + x**2.5 * 0.5

    inverse = Inverse(lambda x: (x + 0.5 * x**2.5, 1.0 + 1.25 * x**1.5), np.linspace(0.0, 1.0, 257))
    value = np.array([1e-9, 1e-6, 1e-4, 2e-3, 0.4])
    found = inverse.series(pair, value, 2)
    with mp.workdps(40):
        for column, at in enumerate(value.tolist()):
            x = mp.findroot(lambda x, at=at: x + x ** mp.mpf(2.5) / 2 - mp.mpf(at), mp.mpf(at))
            rise, bend = 1 + mp.mpf(5) / 4 * x ** mp.mpf(1.5), mp.mpf(15) / 8 * mp.sqrt(x)
            assert found[:, column] == pytest.approx([float(x), float(1 / rise), float(-bend / rise**3 / 2)], rel=1e-14)
