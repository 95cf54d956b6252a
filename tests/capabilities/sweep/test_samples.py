"""Samples of a cam's motion, and which numbers of a recipe act on them linearly."""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.capabilities.sweep.samples import Template, sample_cam
from camgeo.recipe.loading import load_text

TEXT = """
cam: {kind: disc, base_radius: BASE, follower: {kind: roller, radius: 9},
  motion: [{rise: RISE, over: OVER, law: cycloidal}, {dwell: 60}, {to: 0, over: 120, law: cycloidal}, {dwell: LAST}]}
"""


def cam(base: float = 40.0, rise: float = 20.0, over: float = 120.0):
    text = TEXT.replace("BASE", str(base)).replace("RISE", str(rise)).replace("OVER", str(over))
    text = text.replace("LAST", str(180.0 - over))
    return load_text(text, "a.yaml").cam


def test_a_cycloidal_rise_by_shares_of_its_piece() -> None:
    sample = sample_cam(cam(), 360)
    assert sample.sizes["base"] == 40.0
    assert sample.sizes["radius"] == 9.0
    assert np.degrees(sample.widths) == pytest.approx([120.0, 60.0, 120.0, 60.0])
    cells = sample.counts[0]
    assert 120 <= cells <= 121
    share = np.arange(cells + 1) / cells
    turn = 2.0 * np.pi
    rise, rate = sample.rows[:2, : cells + 1]
    assert rise == pytest.approx(20.0 * (share - np.sin(turn * share) / turn), abs=1e-12)
    assert rate == pytest.approx(20.0 * (1.0 - np.cos(turn * share)), abs=1e-12)  # by the share


def test_numbers_that_act_linearly_only_shift_the_samples() -> None:
    def sample(numbers, counts):
        return sample_cam(cam(*numbers), 120, counts)

    low, high = np.array([30.0, 10.0, 100.0]), np.array([50.0, 30.0, 130.0])
    template = Template.fit(sample, low, high)
    assert template is not None
    assert template.resampled == ()
    assert sorted(template.slopes) == [0, 1, 2]  # an angle changes the width of its piece alone
    ((rows, motion),) = template.sample_designs(np.array([[33.0, 12.0, 110.0]]))
    assert rows.tolist() == [0]
    assert motion.sizes["base"] == pytest.approx(33.0)
    exact = sample_cam(cam(33.0, 12.0, 110.0), 120, template.centre_cam.counts)
    width = np.repeat(exact.widths, np.array(exact.counts) + 1)
    for order in range(4):
        assert motion.rows[order, 0] == pytest.approx(exact.rows[order] / width**order, abs=1e-9)
