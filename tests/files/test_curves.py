"""Parallels and measures of arc splines for the kernel of STEP: closed forms, and what has none."""

import math

import numpy as np
import pytest

from camgeo.files.curves import inset, measures, misfit
from camgeo.files.errors import RegionError
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline
from camgeo.part.shapes import slot

STADIUM = slot(5.0, 15.0, 4.0)


def test_the_parallel_of_a_stadium_is_a_stadium():
    inner = inset(STADIUM, 0.5)
    assert inner.area == pytest.approx(3.0 * 6.0 + math.pi * 1.5**2)
    assert inner.box() == pytest.approx((5.5, -1.5, 14.5, 1.5))
    assert inner.bulges.tolist() == STADIUM.bulges.tolist()


def test_a_parallel_as_deep_as_an_arc_is_refused():
    with pytest.raises(RegionError, match="sharper than the chamfer of 2 mm: give less than 2 mm"):
        inset(STADIUM, 2.0)


SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])


def test_lines_meet_in_a_corner_of_the_parallel_too():
    inner = inset(ArcSpline(SQUARE, np.zeros(4), EXACT), 0.5)
    assert inner.points.tolist() == [[0.5, 0.5], [3.5, 0.5], [3.5, 3.5], [0.5, 3.5]]
    with pytest.raises(RegionError, match="nothing is left of an edge within a chamfer of 2 mm"):
        inset(ArcSpline(SQUARE, np.zeros(4), EXACT), 2.0)


def test_a_corner_at_an_arc_has_no_parallel():
    bulged = ArcSpline(SQUARE, np.array([0.2, 0.0, 0.0, 0.0]), EXACT)
    with pytest.raises(RegionError, match=r"the arcs meet at .* degrees, where no chamfer runs"):
        inset(bulged, 0.5)


def test_chord_and_radius_of_lines_and_arcs():
    length, radius, flat = measures(STADIUM)
    assert length == pytest.approx([6.0, 4.0, 6.0, 4.0])
    assert radius == pytest.approx([0.0, 2.0, 0.0, 2.0])
    assert flat.tolist() == [True, False, True, False]


def test_an_arc_that_is_taken_for_a_line_is_off_by_its_height():
    bulge = 1e-8
    outline = ArcSpline(np.array([[0.0, 0.0], [10.0, 0.0], [5.0, 8.0]]), np.array([bulge, 0.0, 0.0]), EXACT)
    assert misfit(outline) == pytest.approx(0.5 * 10.0 * bulge, rel=1e-6)
