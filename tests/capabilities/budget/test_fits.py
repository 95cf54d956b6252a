"""Fits of ISO 286 and of parallel keys: tables by formula, clearances, and their play in a budget."""

from __future__ import annotations

import math

import pytest
from support.budgets import budget

from camgeo.capabilities.budget.fits import SHAFTS, clearance, fit_of, key_clearance
from camgeo.part.iso286 import UPPER_ENDS


def test_classes_follow_from_the_standard_tolerances() -> None:
    """IT6 is 10 times the unit of tolerance, rounded as the standard rounds."""
    ends = (1.0, *UPPER_ENDS)
    for i in range(len(UPPER_ENDS)):
        size = math.sqrt(ends[i] * ends[i + 1]) if i else math.sqrt(3.0)
        unit = 0.45 * size ** (1 / 3) + 0.001 * size
        for name, ranges in SHAFTS.items():
            low, high = ranges[i]
            assert abs(high - low - 10 * unit) < 1.6, (name, i)


def test_clearances() -> None:
    assert clearance("H7", "h6", 20.0) == pytest.approx((0.0, 0.034))
    assert clearance("H7", "g6", 20.0) == pytest.approx((0.007, 0.041))
    assert clearance("H7", "k6", 18.0) == pytest.approx((-0.012, 0.017))
    # hub JS9 over a key of 6 mm: 15 + 30 um; P9 at most 18
    assert key_clearance("JS9", 6.0) == pytest.approx((-0.015, 0.045))
    assert key_clearance("P9", 6.0).most == pytest.approx(0.018)
    fit = fit_of(20.0, "H7", "h6", ("JS9", "P9"), 6.0)
    assert fit.bore == pytest.approx(0.017)
    assert fit.angle == pytest.approx((0.045 + 0.018) / 20.0)
    with pytest.raises(ValueError, match="120 mm"):
        clearance("H7", "h6", 121.0)


def test_a_fit_counts_as_bore_and_angle() -> None:
    value = dict(budget("tolerances: {profile: 0.01}, fit: h6, key: {hub: JS9, shaft: JS9}").tolerances)
    assert value["bore"] == pytest.approx(0.017)
    assert value["angle"] == pytest.approx(0.090 / 20.0)
