"""Inverses by a table and Newton's method: to rounding, in few evaluations, and at the ends."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

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
