"""DXF entities as numbers: arcs of ellipses from above and below, bulges, and what is no part of a plane contour."""

import math

import ezdxf
import numpy as np
import pytest

from kin.read.drawing.dxf_entities import shape_of
from kin.read.drawing.shapes import UnfitError

SPACE = ezdxf.new().modelspace()
BELOW = {"extrusion": (0, 0, -1)}


def ends(beziers):
    return [*beziers.control[0, 0].tolist(), *beziers.control[-1, -1].tolist()]


@pytest.mark.parametrize(("attributes", "side"), [({}, 1.0), (BELOW, -1.0)])
def test_an_arc_of_an_ellipse_runs_from_its_major_to_its_minor_axis(attributes, side):
    """In world coordinates, its minor axis a quarter turn on from the major one as seen along the extrusion."""
    entity = SPACE.add_ellipse((1, 2, 3), (4, 0, 0), 0.5, 0.0, 0.5 * math.pi, dxfattribs=attributes)
    shape = shape_of(entity)
    assert ends(shape.beziers) == pytest.approx([5.0, 2.0, 1.0, 2.0 + 2.0 * side])
    assert shape.heights.tolist() == [3.0]
    (middle,) = shape.beziers.point(np.array([0]), np.array([0.5]))
    assert middle.tolist() == pytest.approx([1.0 + 4.0 * math.sqrt(0.5), 2.0 + 2.0 * math.sqrt(0.5) * side])


@pytest.mark.parametrize(("attributes", "side"), [({}, 1.0), (BELOW, -1.0)])
def test_an_arc_seen_from_below_is_mirrored(attributes, side):
    entity = SPACE.add_arc((1, 2, 3), 4, 30, 120, dxfattribs=attributes)
    (x, y, radius, first, sweep) = shape_of(entity).arcs[0].tolist()
    assert (x, y, radius, sweep) == pytest.approx((side, 2.0, 4.0, side * 0.5 * math.pi))
    begin = math.radians(30.0)
    assert (math.cos(first), math.sin(first)) == pytest.approx((side * math.cos(begin), math.sin(begin)))


def test_a_closed_polyline_comes_back_with_its_bulges():
    entity = SPACE.add_lwpolyline([(0, 0, 1), (2, 0, 0), (2, 3, -0.5)], format="xyb", close=True)
    assert shape_of(entity).chords.tolist() == [[0, 0, 2, 0, 1], [2, 0, 2, 3, 0], [2, 3, 0, 0, -0.5]]


@pytest.mark.parametrize(
    ("entity", "message"),
    [
        (SPACE.add_circle((0, 0), 0), "its radius is 0"),
        (SPACE.add_circle((0, 0), 1, dxfattribs={"extrusion": (1, 0, 0)}), "it lies in a plane of its own"),
        (SPACE.add_lwpolyline([(0, 0)]), "a polyline of 1 vertices"),
        (SPACE.add_ellipse((0, 0), (1, 0, 1), 0.5), "its axes are not those of an ellipse in the drawing's plane"),
        (SPACE.add_spline([(0, 0), (1, 1), (2, 0)]), "a spline of fit points alone has no definite shape"),
    ],
)
def test_what_is_no_part_of_a_plane_contour_is_refused(entity, message):
    with pytest.raises(UnfitError) as caught:
        shape_of(entity)
    assert caught.value.args[1].startswith(message)
