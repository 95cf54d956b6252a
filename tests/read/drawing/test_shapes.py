"""Entities as numbers: maps of the plane, and B-splines that do not fit together."""

import math

import numpy as np
import pytest

from kin.read.drawing.shapes import Affine, UnfitError, check_degree, check_spline, shape


def test_maps_follow_one_another():
    turned = Affine(e=10.0).after(Affine.rotation(90.0)).after(Affine(a=2.0, d=2.0))
    assert turned.at(1.0, 0.0) == pytest.approx((10.0, 2.0))
    assert turned.scale_and_sense() == pytest.approx((2.0, 1.0))
    assert Affine(d=-3.0, a=3.0).scale_and_sense() == (3.0, -1.0)


def test_a_moved_arc_is_where_its_points_are():
    arc = shape(arcs=(1.0, 2.0, 3.0, 0.0, 0.5 * math.pi), heights=4.0)
    moved = Affine(a=-2.0, d=2.0, e=5.0).moved(arc, rise=1.0, scale=-1.0)
    x, y, radius, first, sweep = moved.arcs[0]
    assert (x, y, radius, sweep) == pytest.approx((3.0, 4.0, 6.0, -0.5 * math.pi))
    assert (x + radius * math.cos(first), y + radius * math.sin(first)) == pytest.approx((-3.0, 4.0))
    assert moved.heights.tolist() == [-3.0]


def test_a_map_that_makes_ellipses_of_circles_makes_curves_of_arcs():
    """Every point of them is where the map has it, an arc's ends and middle, and a line beside it stays straight."""
    wide = Affine(a=2.0, c=0.5, e=1.0)
    assert wide.moved(shape(chords=(0, 0, 1, 1, 0), heights=0.0)).chords.tolist() == [[1, 0, 3.5, 1, 0]]
    arcs = wide.moved(shape(arcs=(0, 0, 1, 0, 0.5 * math.pi), heights=0.0))
    mixed = wide.moved(shape(chords=[(1, 0, 0, 1, math.tan(math.pi / 8)), (0, 1, -1, 1, 0)], heights=0.0))
    share, half = np.array([0.0, 0.5, 1.0]), math.sqrt(0.5)
    circle = [wide.at(1.0, 0.0), wide.at(half, half), wide.at(0.0, 1.0)]
    for curves in (arcs.beziers, mixed.beziers):
        np.testing.assert_allclose(curves.point(np.zeros(3, dtype=int), share), circle, atol=1e-12)
    line = [wide.at(0.0, 1.0), wide.at(-0.5, 1.0), wide.at(-1.0, 1.0)]
    np.testing.assert_allclose(mixed.beziers.point(np.ones(3, dtype=int), share), line, atol=1e-12)


KNOTS = [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]


@pytest.mark.parametrize(
    ("knots", "weight", "message"),
    [
        (KNOTS, [1.0, 1.0, 1.0, 1.0], None),
        (KNOTS[1:], [1.0, 1.0, 1.0, 1.0], "4 control points, 6 knots, 4 weights, degree 2"),
        (KNOTS, [1.0, 1.0, 1.0], "4 control points, 7 knots, 3 weights, degree 2"),
        ([0, 0, 0, 1, 0.5, 2, 2], [1.0, 1.0, 1.0, 1.0], "its knots fall or span nothing"),
        ([0, 0, 0, 0, 0, 0, 0], [1.0, 1.0, 1.0, 1.0], "its knots fall or span nothing"),
        (KNOTS, [1.0, 0.0, 1.0, 1.0], "its weights are not all positive and of one order"),
        (KNOTS, [1.0, 1.0, 1.0, 2e6], "its weights are not all positive and of one order"),
    ],
)
def test_splines_whose_numbers_do_not_fit(knots, weight, message):
    if message is None:
        check_spline(2, np.array(knots), np.array(weight), 4)
        return
    with pytest.raises(UnfitError) as caught:
        check_spline(2, np.array(knots, dtype=float), np.array(weight), 4)
    assert message in caught.value.args[1]


def test_a_spline_that_is_torn_apart():
    with pytest.raises(UnfitError, match="a knot repeated too often tears it apart"):
        check_spline(1, np.array([0.0, 0.0, 1.0, 1.0, 2.0, 2.0]), np.ones(4), 4)


@pytest.mark.parametrize("degree", [0, 26])
def test_degrees_that_are_not_read(degree):
    with pytest.raises(UnfitError, match=f"it is of degree {degree}; up to 25 is read"):
        check_degree(degree)
    check_degree(25)
