"""Bodies of linkages one above another: levels, blocks and slots, rails and posts, of stated sizes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.printed import SIZES, corners

from camgeo.capabilities.mechanism.body_stack import BodyStack, block, slotted_bar
from camgeo.capabilities.mechanism.poses import Turning


def test_a_block_is_half_as_long_again_as_wide():
    assert corners(block(SIZES)) == pytest.approx([-6.0, -4.0, 6.0, 4.0])


def test_a_slot_lets_its_block_run_and_leaves_walls():
    bar, slot = slotted_bar(-5.0, 7.0, 1.0, SIZES)
    # half a block and 1 mm beyond either end, half the clearance beside it, then 3 mm of wall
    assert corners(slot) == pytest.approx([-12.0, -3.1, 14.0, 5.1])
    assert corners(bar) == pytest.approx([-15.0, -6.1, 17.0, 8.1])


def test_links_lie_above_the_retainers_of_those_below():
    site = BodyStack(SIZES, None, 10.0, 12.0)
    assert site.level() == (10.0, 15.0)
    assert site.level() == pytest.approx((17.8, 22.8))


def test_rails_hold_a_slide_between_them():
    site = BodyStack(SIZES, None, 10.0, 12.0)

    def place(phi, _order):
        return np.stack([20.0 + 5.0 * np.cos(phi), 0.0 * phi, 0.0 * phi])[:, None]

    site.add_rails(place, (0.0, 0.0), 0.0)
    lower, upper, foot = (corners(plate.outline) for plate in site.ground)
    assert lower == pytest.approx([8.0, -7.1, 32.0, -4.1])
    assert upper == pytest.approx([8.0, 4.1, 32.0, 7.1])
    assert foot == pytest.approx([8.0, -7.1, 32.0, 7.1])
    assert [plate.low for plate in site.ground] == [6.0, 6.0, 0.0]
    assert [plate.high for plate in site.ground] == pytest.approx([11.4, 11.4, 6.0])


def test_a_cam_turns_clockwise():
    pose = Turning(0.5)(np.array([0.0, 0.25 * math.pi]), 1)
    assert pose[:, 0].T.tolist() == [[0.0, 0.0, 0.5], [0.0, 0.0, 0.5 - 0.25 * math.pi]]
    assert pose[2, 1].tolist() == [-1.0, -1.0]
