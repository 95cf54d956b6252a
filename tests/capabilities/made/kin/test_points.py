"""Points of a ball, whose centre an instrument gives: on waves of the metal, a worked case."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from support.disc_followers import FOLLOWERS

from kin.contour.arcs import left
from kin.made.points import Profile, SurfacePoints

BALL = 2.0
AT = np.radians([20.0, 50.0, 123.0, 200.0])
ALONG = [0.0324287008, -0.0492274898, -0.0432324470, 0.0323319216]
BY_NORMAL = [0.0327142566883, -0.0492143751563, -0.0431629714763, 0.0325228131895]
BY_NORMAL_AT = [20.04327336, 50.00851122, 123.0157727, 200.0288006]
"""Of the place where the ball touches, by 40 digits: where the metal's normal through it meets the nominal one."""


def resting(at):
    """Centre of a ball that comes along the nominal normal until it touches the waves, and where it touches."""
    envelope = FOLLOWERS["roller, offset"].envelope
    frame = envelope.frames(np.array([at]))
    point, normal = frame.points[0], frame.normals[0]
    low, high = at - 0.2, at + 0.2
    for _ in range(6):
        t = np.linspace(low, high, 4001)
        metal = envelope.frames(t)
        places = metal.points + (0.05 * np.sin(20.0 * t))[:, None] * metal.normals
        away = places - point
        across = away @ left(normal[None])[0]
        height = away @ normal + np.sqrt(np.maximum(BALL**2 - across**2, 0.0))
        best = int(np.argmax(height))
        low, high = t[max(best - 2, 0)], t[min(best + 2, 4000)]
    return point + height[best] * normal, places[best]


def test_balls_read_the_waves_as_they_touch_them():
    follower = FOLLOWERS["roller, offset"]
    centres, touched = (np.array(each) for each in zip(*(resting(at) for at in AT), strict=True))
    assert SurfacePoints(follower, 1, centres, BALL).deviations.e == pytest.approx(ALONG, abs=1e-9)
    normals = (centres - touched) / BALL
    found = SurfacePoints(follower, 1, centres, BALL, normals).deviations
    assert found.e == pytest.approx(0.05 * np.sin(20.0 * found.parameter), abs=1e-9)
    assert found.e == pytest.approx(BY_NORMAL, abs=5e-9)  # the place of a maximum is known to half the digits
    assert np.mod(np.degrees(found.parameter), 360.0) == pytest.approx(BY_NORMAL_AT, abs=1e-6)


@pytest.mark.parametrize("rounding", [-1e-12, 0.0, 1e-12])
def test_of_places_that_a_placing_makes_equal_the_first_with_too_much_metal_is_the_worst(rounding):
    """Which of them is greater by rounding depends on the processor."""
    parts = ([0.001, -0.011 * (1.0 + rounding)], [0.011, 0.011 * (1.0 + rounding), 0.002])
    deviations = tuple(SimpleNamespace(e=np.array(part)) for part in parts)
    assert Profile("bore", "g", None, deviations, None, None, None).worst == 2
    assert Profile("bore", "", None, deviations[:1], None, None, None).worst == 1
