"""Extremes of a motion over a turn, on rows that are known functions of the relative angle."""

import math

import numpy as np
import pytest

from kin.linkage.extremes import Quantities, figures
from kin.numeric.angles import TURN


def rows(theta):
    sine, cosine = np.sin(theta), np.cos(theta)
    return Quantities(
        output=0.3 * sine,
        velocity_relative=0.3 * cosine,
        acceleration_relative=-0.3 * sine,
        velocity=0.6 * cosine,
        acceleration=-0.2 - 0.3 * sine,
        frame=0.1 * cosine,
        transmission_sine=0.8 + 0.1 * sine,
        transmission_cosine=0.5 + 0.1 * cosine,
        force_sine=cosine,
        force_cosine=sine,
        offset=2.0 * cosine - 1.0,
    )


def test_extremes_dead_centres_and_their_places():
    made = figures(rows, lambda theta: theta + 0.1, np.zeros(0))
    assert (made.greatest.value, made.greatest.relative) == pytest.approx((0.3, 0.5 * math.pi), abs=1e-6)
    assert (made.least.value, made.swing) == pytest.approx((-0.3, 0.6), abs=1e-12)
    assert made.greatest.shaft == pytest.approx(0.5 * math.pi + 0.1, abs=1e-6)
    # the greatest absolute value, with its sign
    assert (made.acceleration.value, made.acceleration.relative) == pytest.approx((-0.5, 0.5 * math.pi), abs=1e-6)
    assert abs(made.velocity.value) == pytest.approx(0.6)
    assert (made.frame_least.value, made.frame_greatest.value) == pytest.approx((-0.1, 0.1), abs=1e-12)
    # nearest to 0: the sine at 3/4 of a turn, 0.7 beside 0.5; the cosine at half a turn, 0.8 beside 0.4; a sine of 0
    assert made.transmission_least.value == pytest.approx(math.atan2(0.7, 0.5), abs=1e-9)
    assert made.transmission_greatest.value == pytest.approx(math.atan2(0.8, 0.4), abs=1e-9)
    assert made.force_least.value == pytest.approx(0.0, abs=1e-9)
    # 2 cos = 1
    assert [place.relative for place in made.dead_centres] == pytest.approx([TURN / 6, 5 * TURN / 6], abs=1e-9)


def test_a_dead_centre_at_zero_counts_once():
    made = figures(lambda t: rows(t)._replace(offset=np.sin(t)), lambda theta: theta, np.zeros(0))
    assert [place.relative for place in made.dead_centres] == pytest.approx([0.0, math.pi], abs=1e-9)
