"""Bounds of an intended motion's derivatives over ranges: against dense samples, and what jumps at a knot."""

from __future__ import annotations

import numpy as np
import pytest

from kin.follower.steepness import steepness_of_law, steepness_of_transmission
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.law.support_function import lift_from_fourier
from kin.law.transmission import from_delta

TURN = 2.0 * np.pi
LIFT = lift_from_fourier(40.0, {2: 3.0, 5: 0.2}, {3: 0.4}).law
WIDTHS = (1e-3, 0.1, 1.0, 5.0)


@pytest.mark.parametrize("width", WIDTHS)
def test_no_sample_of_a_range_exceeds_its_bounds(width: float) -> None:
    low = np.linspace(-1.0, 7.0, 23)
    bounds = steepness_of_law(LIFT).over(low, low + width)
    within = low[:, None] + width * np.linspace(0.0, 1.0, 101)
    seen = np.abs(LIFT.derivatives(within.ravel(), 3)[1:]).reshape(3, len(low), -1).max(axis=2)
    assert (seen <= bounds * (1.0 + 1e-12)).all()
    assert (bounds <= 1.1 * np.abs(LIFT.derivatives(np.linspace(0.0, TURN, 4001), 3)[1:]).max(axis=1)[:, None]).all()


def test_the_derivative_after_one_that_jumps_has_no_bound_across_the_jump() -> None:
    wave = LIFT.functions[0]
    there = float(LIFT.derivatives(np.array([2.0]), 0)[0, 0])
    law = Piecewise(np.array([0.0, 2.0, TURN]), (wave, Constant(there)), TURN)
    first, second, third = steepness_of_law(law).over(np.array([1.0, 1.9, 2.5]), np.array([1.5, 2.1, 2.6])).T
    assert np.isfinite(first).all()
    assert np.isfinite(second[0])
    assert np.isinf(second[1:]).all()
    assert third == pytest.approx(0.0, abs=1e-12)


def test_a_smooth_swing_is_bounded_all_round() -> None:
    transmission = from_delta(2, 1, 40.0, {1: 400.0}, {})
    phi = np.linspace(0.0, TURN, 2001)
    bounds = steepness_of_transmission(transmission).over(np.array([0.0]), np.array([TURN]))[:, 0]
    seen = np.abs(transmission.psi_of_shaft(phi, 3)[1:]).max(axis=1)
    assert (seen <= bounds * (1.0 + 1e-9)).all()
    assert (bounds <= 1.5 * seen).all()
