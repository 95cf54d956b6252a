"""A guide for a stem: two blocks with pegs, and a cap with holes for these, of stated sizes."""

from __future__ import annotations

import pytest
from support.printed import SIZES, corners

from camgeo.capabilities.mechanism.guide import guide, guide_length, half_width


def test_two_blocks_leave_half_the_clearance_on_either_side_of_the_stem():
    plates, cap = guide("cap", 40.0, 12.0, 17.0, SIZES, line=2.0)
    assert (guide_length(SIZES), half_width(SIZES)) == pytest.approx((16.0, 12.1))
    foot, right, *_ = plates
    left = plates[4]
    assert corners(foot.outline) == pytest.approx([40.0, -10.1, 56.0, 14.1])
    assert (foot.low, foot.high) == pytest.approx((6.0, 11.6))
    assert corners(right.outline) == pytest.approx([40.0, -10.1, 56.0, -2.1])
    assert corners(left.outline) == pytest.approx([40.0, 6.1, 56.0, 14.1])
    assert [right.low, right.high, left.low, left.high] == pytest.approx([6.0, 17.4] * 2)
    (lid,) = cap.plates
    assert (lid.low, lid.high) == pytest.approx((17.4, 19.4))
    assert len(lid.holes) == 4


def test_a_stem_just_above_the_base_has_no_foot_below_it():
    plates, _ = guide("cap", 40.0, 6.4, 11.4, SIZES)
    assert len(plates) == 6  # two blocks with two pegs each
