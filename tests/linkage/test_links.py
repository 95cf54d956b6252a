"""Moving links: points in the fixed axes, directions of bars."""

import math

import numpy as np
import pytest

from kin.linkage.links import Link, bar, pivot, rocker
from kin.numeric.elementary import Jet


def test_a_point_of_a_turning_link_moves_across_its_arm():
    angle = Jet.variable(np.array([0.5 * math.pi]), 1)
    x, y = rocker((3.0, 4.0), angle).point(2.0, 1.0)
    # (2, 1) turned by a quarter is (-1, 2), and moves at (-2, -1) by rad
    assert [x.c[0, 0], y.c[0, 0]] == pytest.approx([2.0, 6.0], abs=1e-15)
    assert [x.c[1, 0], y.c[1, 0]] == pytest.approx([-2.0, -1.0], abs=1e-15)


def test_a_link_without_direction_keeps_its_axes():
    one = Jet(np.ones((1, 1)))
    x, y = Link((one, one * 2.0), None).point(5.0, -1.0)
    assert [x.c[0, 0], y.c[0, 0]] == [6.0, 1.0]


def test_the_x_axis_of_a_bar_points_at_its_other_joint():
    p, q = ((Jet(np.array([[a]])), Jet(np.array([[b]]))) for a, b in ((1.0, 1.0), (0.0, 0.0)))
    link = bar(p, q)
    assert link.direction.c[0, 0] == pytest.approx(-0.75 * math.pi, abs=1e-15)
    x, y = link.point(math.sqrt(2.0), 0.0)
    assert [x.c[0, 0], y.c[0, 0]] == pytest.approx([0.0, 0.0], abs=1e-15)


def test_a_pivot_stands_still():
    joint = pivot((3.0, 4.0), Jet.variable(np.array([0.1, 0.2]), 2))
    assert joint.kind == "pivot"
    assert [row.c.tolist() for row in joint.place.origin] == [[[v, v], [0, 0], [0, 0]] for v in (3.0, 4.0)]
