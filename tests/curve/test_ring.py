"""Arcs by their bulges: radius, centre and points along them, against the circle itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from camgeo.curve.ring import ArcChain, centre_of, radius_of, steps_along


@pytest.mark.parametrize("sweep", [0.3, -0.3, math.pi, -math.pi, 5.0, -5.0])
def test_an_arc_is_told_by_its_ends_and_its_bulge(sweep: float) -> None:
    middle, radius, angle = np.array([3.0, -2.0]), 7.0, 0.4 + sweep * np.arange(6) / 5
    points = middle + radius * np.column_stack([np.cos(angle), np.sin(angle)])
    start, end, bulge = points[0], points[-1], math.tan(0.25 * sweep)
    assert radius_of(math.dist(start, end), bulge) == pytest.approx(radius, rel=1e-14)
    assert centre_of(start, end, bulge) == pytest.approx(middle, abs=1e-13)
    assert steps_along(start, end, bulge, 5) == pytest.approx(points[:-1], abs=1e-13)


def test_points_of_a_line_and_of_an_arc_with_a_distant_centre_lie_in_equal_steps() -> None:
    start, end = np.array([1.0, 2.0]), np.array([5.0, 2.0])
    assert steps_along(start, end, 0.0, 4).tolist() == [[1.0, 2.0], [2.0, 2.0], [3.0, 2.0], [4.0, 2.0]]
    # the sagitta is half of chord times bulge, and the arc lies to the right of its chord
    assert 2.0 - steps_along(start, end, 1e-9, 2)[1, 1] == pytest.approx(2e-9, rel=1e-6)


def test_two_halves_are_a_circle_and_nothing_else_is() -> None:
    points = np.array([[4.0, 1.0], [0.0, 1.0]])
    assert ArcChain(points, np.ones(2)).circle == ((2.0, 1.0), 2.0)
    assert ArcChain(points, np.array([1.0, 0.9])).circle is None
    assert [bulge for _, _, bulge in ArcChain(points, np.array([1.0, 0.9])).pieces()] == [1.0, 0.9]
