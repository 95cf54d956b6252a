"""Edges of a STEP solid: where a leaning circle and a spline pass a height, and in which sense."""

import math

import numpy as np
import pytest

from kin.contour.bezier import Beziers
from kin.read.step.curves import Conic, Spline, StepEdge, Straight

# a circle of radius 2 about (0, 0, 5) in the plane through the y axis that rises by 60 degrees along x
U, V = np.array([1.0, 0.0, math.sqrt(3.0)]), np.array([0.0, 2.0, 0.0])
CENTRE = np.array([0.0, 0.0, 5.0])


def edge(curve, start=CENTRE, end=CENTRE):
    return StepEdge(1, start, end, curve)


@pytest.mark.parametrize("sweep", [2.0 * math.pi, -2.0 * math.pi])
def test_a_leaning_circle_passes_a_height_twice(sweep):
    height = 5.0 + math.sqrt(3.0) * math.cos(1.0)
    crossings = edge(Conic(CENTRE, U, V, 0.25, sweep)).crossings(height)
    expected = {True: -math.sin(1.0), False: math.sin(1.0)}  # it rises where t grows through -1
    assert len(crossings) == 2
    for place, rises in crossings:
        y = 2.0 * expected[rises if sweep > 0.0 else not rises]
        assert place.tolist() == pytest.approx([math.cos(1.0), y, height])
    assert edge(Conic(CENTRE, U, V, 0.25, sweep)).crossings(7.0) == []


def test_a_part_of_a_circle_passes_it_once():
    ((place, rises),) = edge(Conic(CENTRE, U, V, 0.0, math.pi)).crossings(5.0)
    assert (place.tolist(), rises) == (pytest.approx([0.0, 2.0, 5.0]), False)


def test_a_line_passes_a_height_once_and_ends_beside_it_are_a_misfit():
    line = edge(Straight(np.zeros(3), np.array([0.0, 0.6, 0.8])), np.zeros(3), np.array([0.1, 3.0, 4.0]))
    ((place, rises),) = line.crossings(1.0)
    assert (place.tolist(), rises) == (pytest.approx([0.025, 0.75, 1.0]), True)
    assert line.misfit == pytest.approx(0.1)


@pytest.mark.parametrize("back", [False, True])
def test_a_spline_rises_and_falls_through_a_height(back):
    """Its height is 4 t (1 - t): half at t = (1 -+ 1/sqrt 2)/2."""
    plan = Beziers(np.array([[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]]), np.ones((1, 3)))
    rise = Beziers(np.array([[[0.0, 0.0], [2.0, 0.0], [0.0, 0.0]]]), np.ones((1, 3)))
    first, second = edge(Spline(plan, rise, back)).crossings(0.5)
    assert (first[0].tolist(), first[1]) == (pytest.approx([1.0 - math.sqrt(0.5), 0.0, 0.5]), not back)
    assert (second[0].tolist(), second[1]) == (pytest.approx([1.0 + math.sqrt(0.5), 0.0, 0.5]), back)
