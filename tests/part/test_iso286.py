"""Tolerance classes of bores and keyways: widths by the formula of ISO 286-1, ends of ranges, what lies beyond."""

import math

import pytest

from camgeo.part.iso286 import HOLES, KEYWAYS, UPPER_ENDS, deviations


def test_widths_follow_from_the_standard_tolerances():
    """IT7 and IT9 are 16 and 40 times the unit of tolerance, rounded as the standard rounds."""
    ends = (1.0, *UPPER_ENDS)
    for i in range(len(UPPER_ENDS)):
        size = math.sqrt(ends[i] * ends[i + 1]) if i else math.sqrt(3.0)
        unit = 0.45 * size ** (1 / 3) + 0.001 * size
        low, high = HOLES["H7"][i]
        assert low == 0
        assert abs(high - 16 * unit) < 1.6, i
        for name in KEYWAYS:
            low, high = KEYWAYS[name][i]
            assert abs(high - low - 40 * unit) < 3.4, (name, i)


def test_a_range_holds_up_to_its_end():
    assert deviations(HOLES["H7"], 18.0) == pytest.approx((0.0, 0.018))
    assert deviations(HOLES["H7"], 18.01) == pytest.approx((0.0, 0.021))
    assert deviations(KEYWAYS["P9"], 10.0) == pytest.approx((-0.051, -0.015))
    for size in (0.0, 120.01):
        with pytest.raises(ValueError, match="reaches to 120 mm"):
            deviations(HOLES["H7"], size)
