"""Feet: grids with their breaks, climbs to the nearest maximum, and integrals of what has corners."""

import math

import numpy as np
import pytest

from kin.numeric.angles import TURN
from kin.numeric.feet import FINE_STEP, WITHIN, climb, equal_steps, grid, turn_quadrature


def test_steps_are_equal_and_the_turn_is_left_out():
    assert equal_steps(4).tolist() == [0.0, 0.25 * TURN, 0.5 * TURN, 0.75 * TURN]


def test_a_grid_has_the_breaks_and_parts_of_short_stretches():
    breaks = np.array([1.0, 1.01, -1.0])
    angles = grid(breaks, 8)
    assert np.all(np.diff(angles) > 0.0)
    assert angles[0] == 0.0
    assert angles[-1] < TURN
    assert set(np.mod(breaks, TURN)) <= set(angles.tolist())
    assert np.count_nonzero((angles > 1.0) & (angles < 1.01)) == WITHIN - 1


def test_a_climb_ends_at_the_maximum_uphill():
    """cos 2 x has maxima at 0 and pi: from either side of a quarter turn it goes to its own."""

    def slopes(x, _which):
        return np.cos(2 * x), -2 * np.sin(2 * x), 4 * np.cos(2 * x)

    x, step, f, slope, bend = climb(slopes, np.array([1.5, 1.7, 0.1]), np.empty(0))
    assert np.abs(step).max() <= FINE_STEP
    assert x + step == pytest.approx([0.0, math.pi, 0.0], abs=1e-14)
    assert f == pytest.approx([1.0, 1.0, 1.0], abs=1e-9)
    assert slope == pytest.approx(-2 * np.sin(2 * x))
    assert bend == pytest.approx(4 * np.cos(2 * x))


def test_an_integral_over_a_turn_minds_corners():
    angle, weight = turn_quadrature(np.array([0.5 * math.pi, 1.5 * math.pi]))
    assert float(weight @ np.abs(np.cos(angle))) == pytest.approx(4.0, abs=1e-13)
    assert weight.sum() == pytest.approx(TURN, abs=1e-13)
