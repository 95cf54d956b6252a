"""Motion laws of the library against their closed forms."""

import math

import numpy as np
import pytest

import camgeo

LAWS = camgeo.laws()


def test_a_cycloid_has_its_peaks_and_derivatives():
    law = LAWS["cycloidal"]
    assert (law.velocity, law.acceleration, law.jerk) == pytest.approx((2.0, 2.0 * math.pi, 4.0 * math.pi**2))
    u = np.array([[0.0, 0.25], [0.5, 1.0]])
    assert law(u) == pytest.approx(u - np.sin(2.0 * math.pi * u) / (2.0 * math.pi))
    assert law(u, derivative=2) == pytest.approx(2.0 * math.pi * np.sin(2.0 * math.pi * u), abs=1e-12)
    assert law(0.5) == pytest.approx(0.5)
    assert isinstance(law(0.5), float)


def test_a_parabola_steps_in_acceleration():
    law = LAWS["parabolic"]
    assert (law.velocity, law.acceleration, law.jerk) == (2.0, 4.0, math.inf)
    assert (law(0.5, derivative=2), law(1.0, derivative=2)) == (-4.0, -4.0)


@pytest.mark.parametrize("u", [-0.01, 1.01, [0.5, 2.0]])
def test_there_is_none_outside_a_segment(u):
    with pytest.raises(camgeo.CallError, match="from 0 to 1"):
        LAWS["cycloidal"](u)


def test_derivatives_end_with_the_jerk():
    with pytest.raises(camgeo.CallError, match="order 0 to 3, not 4"):
        LAWS["cycloidal"](0.5, derivative=4)
