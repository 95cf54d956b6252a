"""Edges in plain numbers: each begins where the one before ends, and together they enclose the outline's area."""

import math

import numpy as np
import pytest

from camgeo.api.edges import Arc, Edges, Line
from camgeo.fit.bound import EXACT, Bound
from camgeo.fit.pieces import Polygon
from camgeo.part.shapes import slot


def test_a_stadium_is_two_lines_and_two_half_circles():
    edges = Edges.of(slot(5.0, 15.0, 4.0))
    assert [type(edge) for edge in edges] == [Line, Arc, Line, Arc]
    assert [edge.end for edge in edges] == [edge.start for edge in (*edges[1:], edges[0])]
    arc = edges[1]
    assert (arc.center, arc.radius, arc.sweep) == (
        pytest.approx((13.0, 0.0)),
        pytest.approx(2.0),
        pytest.approx(math.pi),
    )
    assert arc.middle == pytest.approx((15.0, 0.0))
    assert edges.area == pytest.approx(24.0 + 4.0 * math.pi)
    assert (edges.bound, len(edges)) == (EXACT.worst, 4)


def test_a_polygon_is_lines_within_its_bound():
    square = Polygon(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]), Bound(0.1, 0.3))
    edges = Edges.of(square)
    assert edges[3] == Line((0.0, 2.0), (0.0, 0.0))
    assert (edges.outward, edges.inward, edges.bound, edges.area) == (0.1, 0.3, 0.3, 4.0)
