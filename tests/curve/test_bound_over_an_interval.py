"""The bound of a figure over an interval by values and slopes, of parabolas whose greatest value is known.

Holds: camgeo.curve.extremes.
"""

from __future__ import annotations

import numpy as np
import pytest

from camgeo.curve.extremes import _most, _Seen


def bound(
    width: float, top: float, bend: tuple[float, float], slopes: tuple[float, float], beyond: float = 9.0
) -> float:
    """Of -(bend/2) (x - top)^2 over [-width/2, width/2], its second derivative and slope known between two figures."""
    low, high = np.array([-0.5 * width]), np.array([0.5 * width])
    steep = -bend[0]
    places = np.array([low, high, low])
    rows = np.array([-0.5 * steep * (places - top) ** 2, -steep * (places - top)])
    below, above = (np.array([[0.0], [slope], [second]]) for slope, second in zip(slopes, bend, strict=True))
    above[0] = beyond
    return float(_most(_Seen(low, high, np.ones(1), rows[:, :2], below, above), rows)[0])


def test_a_top_inside_is_bounded_by_the_bend() -> None:
    """Over a width w the figure is above its greater end by -f'' w^2/8 at the most: here exactly, as the top is 0."""
    for width in (0.5, 3.0):
        assert bound(width, 0.0, (-2.0, 1.0), (-9.0, 9.0)) == pytest.approx(0.0, abs=1e-12)
    # of a top off the middle it is more than it takes: -(0.75)^2 + 2/8
    assert bound(1.0, 0.25, (-2.0, 1.0), (-9.0, 9.0)) == pytest.approx(-0.0625 + 0.25, abs=1e-12)


def test_where_the_slope_keeps_its_sign_an_end_is_highest() -> None:
    assert bound(1.0, 2.0, (-2.0, 1.0), (0.0, 9.0)) == pytest.approx(-2.25, abs=1e-12)
    assert bound(1.0, -2.0, (-2.0, 1.0), (-9.0, 0.0)) == pytest.approx(-2.25, abs=1e-12)


def test_a_bend_that_keeps_its_sign_bounds_from_each_place() -> None:
    """Where f'' <= -m nothing is above a place by more than f'^2/(2 m); and nothing is above what is known besides."""
    assert bound(1.0, 0.25, (-2.0, -2.0), (-9.0, 9.0)) == pytest.approx(0.0, abs=1e-9)
    assert bound(1.0, 0.25, (-8.0, -2.0), (-9.0, 9.0)) == pytest.approx(4.0 * (-0.0625 + 0.25), abs=1e-9)
    assert bound(1.0, 0.25, (-2.0, 1.0), (-9.0, 9.0), beyond=0.125) == 0.125


def test_what_is_not_known_is_bounded_by_nothing() -> None:
    assert bound(1.0, 0.0, (np.nan, np.nan), (-9.0, 9.0), beyond=np.nan) == np.inf
