"""Figures in remedies are rounded to the side on which the remedy is true, but for their own rounding."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from camgeo.common.rounding import NOISE, downward, upward


@pytest.mark.parametrize(
    ("value", "up", "down"),
    [(1.2345671, "1.23457", "1.23456"), (6.000000000000001, "6", "6"), (5.9999999999, "6", "6"), (0.1, "0.1", "0.1")],
)
def test_known_figures(value, up, down):
    assert (upward(value), downward(value)) == (up, down)


@given(st.floats(1e-9, 1e9))
def test_a_remedy_holds(value):
    assert float(downward(value)) <= value * (1.0 + 2.0 * NOISE)
    assert float(upward(value)) >= value * (1.0 - 2.0 * NOISE)
    assert float(upward(value)) - float(downward(value)) <= 2.1e-5 * value
