"""A follower between two flanks, one of which is made too wide, and the uncertainty of its points, worked by hand."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from support.measured import RECIPES, measured

import camgeo
from camgeo.capabilities.made.made_part import _uncertain
from camgeo.capabilities.made.options import PointOptions


def test_too_much_metal_on_the_inner_flank_of_a_groove(tmp_path):
    """It takes so much play, over the cosine of the pressure angle, and moves the roller out by half of that."""
    recipe, files = measured(tmp_path, RECIPES["groove"], lambda t: np.full_like(t, 0.02), count=360)
    made = camgeo.verify(recipe, *files)["made"]
    # 8 mm down over 140 degrees, 6 mm off the axis, a pitch curve of 50 mm: tan = (s' - 6)/(sqrt(50^2 - 6^2) + s)
    u, over = np.linspace(0.0, 1.0, 10_001), math.radians(140.0)
    s = 8.0 * (1.0 - u + np.sin(2.0 * np.pi * u) / (2.0 * np.pi))
    slope = -8.0 / over * (1.0 - np.cos(2.0 * np.pi * u))
    steepest = float(np.hypot(1.0, (slope - 6.0) / (math.sqrt(50.0**2 - 6.0**2) + s)).max())
    assert made["play"]["least"] == pytest.approx(-0.02 * steepest, abs=2e-6)
    assert made["play"]["most"] == pytest.approx(-0.02, abs=2e-6)  # where the rise crosses the line of travel
    offset, error = made["motion"]["offset"], made["motion"]["error"]["max"]
    assert 0.01 < offset < 0.0103
    assert offset + error == pytest.approx(0.01 * steepest, abs=1e-6)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (PointOptions(), [0.012, 0.012, 0.012]),  # twice the scatter
        (PointOptions(error=0.003), [0.003, 0.003, 0.003]),
        (PointOptions(error=0.003, axes=(0.004, 0.0)), [0.005, 0.005, 0.005]),
        (PointOptions(error=0.003, axes=(0.004, 0.0012)), [0.005, 0.013, 0.013]),
        (PointOptions(axes=(0.0, 0.0005)), [0.012, 0.013, 0.013]),
    ],
)
def test_the_uncertainty_of_a_point_has_its_own_and_that_of_the_axes(options, expected):
    """Root sums of squares; a turn of the axes moves a point along its normal by the moment of the normal."""
    deviations = SimpleNamespace(e=np.zeros(3), moment=np.array([0.0, 10.0, -10.0]))
    surface = SimpleNamespace(
        measured=SimpleNamespace(deviations=deviations), fit=SimpleNamespace(curve=SimpleNamespace(sigma=0.006))
    )
    assert _uncertain(surface, options) == pytest.approx(expected, rel=1e-12)
