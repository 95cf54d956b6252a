# needs: sweep
"""Estimates of a train's figures for many cams at once, by hand."""

import math
from pathlib import Path

import numpy as np
import pytest

from camgeo.capabilities.dynamics.sweep import ANSWERS
from camgeo.recipe.loading import read

TEXT = """\
cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 10}, motion: {formula: 6*(1 - cos(t))}}
dynamics: {mass: 1, rpm: 300, preload: 100, guide: {overhang: 20, length: 40, friction: 0.1}}
export: {tolerance: 0.01, files: [dxf]}
"""


class Cams:
    """Two cams, whose pressure angles have these tangents; lifts 6 and 7 times 1 - cos t."""

    recipe = read(TEXT.encode(), Path("train.yaml"))
    slope = np.array([[0.1, 0.5, -0.9], [0.2, -0.4, 0.1]])
    lean = np.array([0.0, 0.3])

    def most(self, rows):
        return rows.max(axis=1)

    def peak(self, order, speed=1.0):
        return np.array([6.0, 7.0]) * speed**order


def test_peaks_are_at_the_trains_speed():
    w = 300.0 * math.pi / 30.0
    for order, name in enumerate(("peak-velocity-at-speed", "peak-acceleration-at-speed", "peak-jerk-at-speed"), 1):
        assert ANSWERS.estimates[name].of(Cams()) == pytest.approx(np.array([6.0, 7.0]) * w**order)


def test_the_margin_is_left_by_the_steeper_of_rise_and_rest():
    margin = ANSWERS.estimates["jam-margin"].of(Cams())
    jam = math.degrees(math.atan(5.0))  # 40/(0.1 (2*20 + 40))
    assert margin == pytest.approx([jam - math.degrees(math.atan(0.5)), jam - math.degrees(math.atan(0.3))])
