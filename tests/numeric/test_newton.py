"""Newton's method inside brackets: where it converges, where it does not, and where there is nothing to find."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kin.numeric.errors import UnsettledError
from kin.numeric.newton import FREE, HALVINGS, zeros

ENDS = np.array([-1.0]), np.array([2.0])


@given(st.floats(-1.0, 2.0), st.floats(-1.0, 2.0), st.floats(0.1, 50.0))
def test_smooth_zeros_are_found_to_rounding(root: float, start: float, steep: float) -> None:
    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.arctan(steep * (x - root)), steep / (1.0 + (steep * (x - root)) ** 2)

    found = zeros(function, *ENDS, np.array([start]), 1e-9)
    inside = min(root + 1.0, 2.0 - root) > 1e-6  # at an end rounding may lead beyond it
    assert found[0] == pytest.approx(root, abs=1e-15 if inside else 1e-9)


def test_where_newton_creeps_brackets_are_halved() -> None:
    """Newton's steps towards a zero of multiplicity 29 are each a 29th of what is left: some 600 would be needed."""
    root, looks = 0.3, []

    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        looks.append(float(x[0]))
        return (x - root) ** 29, 29.0 * (x - root) ** 28

    assert zeros(function, *ENDS, np.array([1.9]), 1e-9)[0] == pytest.approx(root, abs=1e-9)
    assert FREE < len(looks) < FREE + 40


@pytest.mark.parametrize("slope", [-1.0, 0.0, 1e-3, np.inf, -np.inf, np.nan])
def test_a_slope_that_misleads_costs_steps_alone(slope: float) -> None:
    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return np.cbrt(x - 0.3), np.full_like(x, slope)

    assert zeros(function, *ENDS, np.array([0.0]), 1e-15)[0] == pytest.approx(0.3, abs=1e-15)


def test_each_zero_is_found_as_if_it_were_alone() -> None:
    power = np.array([1.0, 3.0, 21.0])

    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        of = power if x.size > 1 else power[:1]
        return np.sinh(x - 0.3) ** of, of * np.sinh(x - 0.3) ** (of - 1.0) * np.cosh(x - 0.3)

    together = zeros(function, np.full(3, -1.0), np.full(3, 2.0), np.full(3, 1.5), 1e-9)
    assert together == pytest.approx(0.3, abs=1e-9)
    assert together[0] == zeros(function, *ENDS, np.array([1.5]), 1e-9)[0]


@pytest.mark.parametrize(("shift", "end"), [(5.0, 2.0), (-5.0, -1.0)])
def test_without_a_zero_the_nearer_end_is_found(shift: float, end: float) -> None:
    found = zeros(lambda x: (x - shift, np.ones_like(x)), *ENDS, np.array([0.2]), 1e-12)
    assert found[0] == pytest.approx(end, abs=2e-12)


def test_a_zero_at_the_start_ends_the_search() -> None:
    assert zeros(lambda x: (x - 0.5, 0.0 * x), *ENDS, np.array([0.5]), 1e-12)[0] == 0.5


def test_a_zero_that_is_not_told_closely_enough_is_refused() -> None:
    """About 0 numbers grow ever closer, and Newton's steps towards a zero of multiplicity 7 creep."""
    with pytest.raises(UnsettledError, match=rf"1 zeros were not found in {FREE + HALVINGS} steps") as caught:
        zeros(lambda x: (x**7, 7.0 * x**6), *ENDS, np.array([1.9]), 1e-30)
    assert caught.value.at == pytest.approx(0.0, abs=1e-17)


def test_what_is_not_a_number_is_refused() -> None:
    with pytest.raises(UnsettledError, match="1 zeros were not found") as caught:
        zeros(lambda x: (np.where(x > 0.0, np.nan, x - 0.1), np.ones_like(x)), *ENDS, np.array([1.5]), 1e-9)
    assert caught.value.at is not None
