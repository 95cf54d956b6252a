"""Closing loops: sums and differences of squares without cancellation, triangles, refusals."""

import math

import numpy as np
import pytest

from kin.linkage.loop import BindingError, Triangle, Vector, demand_lengths, excess, excesses, longer, total
from kin.numeric.elementary import Jet


def test_a_sum_keeps_what_its_largest_terms_hide():
    assert total(1e16, 1.0, -1e16) == 1.0
    assert total(np.array([1e16, 1.0]), 1.0, np.array([-1e16, 2.0])).tolist() == [1.0, 4.0]


def test_the_sign_of_what_is_left_of_squares_is_right():
    """3-4-5 scaled by a third is not closed in doubles; with one ulp more or less of z the sign changes."""
    z = np.array([np.nextafter(5e8, 0.0), 5e8, np.nextafter(5e8, 1e9)])
    left = np.concatenate([excess((3e8,), (4e8,), (float(value),)) for value in z])
    assert np.sign(left).tolist() == [1.0, 0.0, -1.0]
    assert left[0] == pytest.approx(2.0 * 5e8 * (5e8 - z[0]), rel=1e-12)


def test_excesses_are_measured_from_both_limits():
    near, far = excesses((3.0,), (4.0,), 5.0, 1.0)
    assert (near.tolist(), far.tolist()) == ([25.0 - 16.0], [36.0 - 25.0])


def test_the_angles_of_a_right_triangle():
    x, y = Jet(np.array([[5.0]])), Jet(np.array([[0.0]]))
    triangle = Triangle.of(3.0, 4.0, Vector.of(x, y, (5.0,), (0.0,)))
    assert triangle.between.c[0, 0] == pytest.approx(0.5 * math.pi, abs=1e-15)
    assert triangle.beside.c[0, 0] == pytest.approx(math.atan2(4.0, 3.0), abs=1e-15)
    assert triangle.root.c[0, 0] == pytest.approx(24.0, rel=1e-15)  # four times the area


def test_sides_that_do_not_close_are_refused_with_the_gap():
    x, y = Jet(np.array([[5.0, 8.0]])), Jet(np.zeros((1, 2)))
    with pytest.raises(BindingError, match="do not reach each other by 1 mm") as caught:
        Triangle.of(3.0, 4.0, Vector.of(x, y, (x.c[0],), (y.c[0],)))
    assert caught.value.indices.tolist() == [1]


def test_a_length_over_an_offset_is_taken_without_cancellation():
    assert longer(np.array([25.0, 0.0]), np.array([16.0, 0.0]), 3.0).tolist() == [2.0, 0.0]
    close = longer(np.array([1.0]), np.array([2e-20]), 1.0)
    assert close[0] == pytest.approx(1e-20, rel=1e-12)


def test_lengths_are_above_zero_and_finite():
    with pytest.raises(ValueError, match=r"the rocker must be longer than 0, not 0\.0 mm"):
        demand_lengths("open", rocker=0.0)
