"""Limits that fail themselves, by check: what lies on them is no cam that works."""

from __future__ import annotations

import pytest

from camgeo.report.limit_words import is_strict


@pytest.mark.parametrize(
    ("name", "limit"), [("velocity-ratio", 1.0), ("pressure-angle", 90.0), ("mobility", 0.0), ("reversal", 0.0)]
)
def test_a_figure_on_such_a_limit_fails(name: str, limit: float) -> None:
    """A frame as fast as the shaft, a force square to the travel, a linkage that just closes or just turns back."""
    assert is_strict({"name": name, "limit": limit})
    assert not is_strict({"name": name, "limit": 1.25 * limit + 0.25})
    assert not is_strict({"name": name, "limit": 0.8 * limit - 0.25})
