"""Ears clipped in numpy: regions of chance are covered once by triangles that turn left, on their own vertices."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import shapely

from camgeo.files.ears import clip_ears
from camgeo.files.errors import RegionError
from camgeo.files.sides import sides
from camgeo.files.triangulate import clip_region

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kin.numeric.arrays import Array


@pytest.fixture(scope="module")
def alone() -> Iterator[None]:
    """No manifold3d, as in a browser."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "manifold3d", None)
        yield


def loops_of(shape: object) -> list[list[Array]]:
    """Loops of each polygon that a shape of shapely has, counter-clockwise, the outermost first."""
    polygons = [part for part in shapely.get_parts(shape) if part.area > 0.0]
    found = []
    for polygon in polygons:
        turned = shapely.geometry.polygon.orient(polygon)
        inners = [np.array(inner.coords)[-2::-1] for inner in turned.interiors]
        found.append([np.array(turned.exterior.coords)[:-1], *inners])
    return found


def area(loop: Array) -> float:
    return 0.5 * float(np.sum(loop[:, 0] * np.roll(loop[:, 1], -1) - np.roll(loop[:, 0], -1) * loop[:, 1]))


def assert_covered(loops: list[Array]) -> None:
    """`clipped` raises where the edges of the triangles are not those of the loops; the rest is held here."""
    triangles = clip_region(loops[0], loops[1:])
    points = np.concatenate(loops)
    a, b, c = (points[corner] for corner in triangles.T)
    assert (sides(a, b, c) > 0).all()
    assert len(triangles) == len(points) + 2 * (len(loops) - 1) - 2
    doubled = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    assert 0.5 * doubled.sum() == pytest.approx(area(loops[0]) - sum(map(area, loops[1:])), rel=1e-9)


boxes = st.tuples(st.integers(0, 20), st.integers(0, 20), st.integers(1, 6), st.integers(1, 6))
discs = st.tuples(st.integers(0, 20), st.integers(0, 20), st.floats(1.0, 5.0), st.integers(1, 24))


@pytest.mark.usefixtures("alone")
@settings(max_examples=examples(60))
@given(st.lists(boxes, min_size=1, max_size=40), st.booleans())
def test_corners_and_holes_in_line(shapes: list[tuple[int, int, int, int]], halved: bool) -> None:
    """Boxes on a grid: vertices in line with others, with edges and with one another's holes."""
    union = shapely.union_all([shapely.box(x, y, x + w, y + h) for x, y, w, h in shapes])
    for loops in loops_of(union):
        if len(np.unique(np.concatenate(loops), axis=0)) < sum(map(len, loops)):
            continue  # two loops that touch at a corner are refused, by whatever clips
        assert_covered([with_middles(loop) for loop in loops] if halved else loops)


def with_middles(loop: Array) -> Array:
    """Give the loop with a vertex more in the middle of each edge."""
    return np.stack((loop, 0.5 * (loop + np.roll(loop, -1, axis=0))), axis=1).reshape(-1, 2)


@pytest.mark.usefixtures("alone")
@settings(max_examples=examples(60))
@given(st.lists(discs, min_size=2, max_size=30))
def test_round_walls(shapes: list[tuple[int, int, float, int]]) -> None:
    """Circles with others cut out of them: hollows, necks, islands."""
    circles = [shapely.Point(x, y).buffer(r, n) for x, y, r, n in shapes]
    whole = shapely.Point(10.0, 10.0).buffer(20.0, 90)
    for shape in (shapely.union_all(circles), whole.difference(shapely.union_all(circles))):
        for loops in loops_of(shape):
            if len(np.unique(np.concatenate(loops), axis=0)) == sum(map(len, loops)):
                assert_covered(loops)


@pytest.mark.usefixtures("alone")
@pytest.mark.parametrize("count", [3, 4, 5, 6, 97, pytest.param(1500, marks=pytest.mark.slow)])
def test_holes_on_a_circle_in_a_lobed_contour(count: int) -> None:
    angle = 2.0 * math.pi * np.arange(10 * count) / (10 * count)
    reach = 30.0 + 5.0 * np.cos(3.0 * angle)
    outer = np.column_stack((reach * np.cos(angle), reach * np.sin(angle)))
    turn = 2.0 * math.pi * np.arange(count) / count
    circle = np.column_stack((np.cos(turn), np.sin(turn)))
    middles = [12.0 * np.array([math.cos(k), math.sin(k)]) for k in 2.0 * math.pi * np.arange(6) / 6]
    assert_covered([outer, 4.0 * circle, *(middle + 2.0 * circle for middle in middles)])


def square(x: float, y: float, side: float) -> Array:
    return np.array([[x, y], [x + side, y], [x + side, y + side], [x, y + side]])


@pytest.mark.usefixtures("alone")
@pytest.mark.parametrize(
    "loops",
    [
        [np.array([[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]])],  # it crosses itself
        [square(0.0, 0.0, 4.0), square(3.0, 1.0, 2.0)],  # a hole reaches the contour
        [square(0.0, 0.0, 4.0), square(5.0, 1.0, 2.0)],  # and one lies beside it
        [square(0.0, 0.0, 9.0), square(1.0, 1.0, 3.0), square(2.0, 2.0, 3.0)],  # two holes meet
        [square(0.0, 0.0, 9.0), square(1.0, 1.0, 5.0), square(2.0, 2.0, 2.0)],  # one lies in another
    ],
)
def test_what_is_no_region_is_refused(loops: list[Array]) -> None:
    with pytest.raises(RegionError, match="touches or crosses itself"):
        clip_region(loops[0], loops[1:])


def test_an_ear_with_a_vertex_on_its_rim_is_none() -> None:
    """From a square with a vertex on one side the ear over that side would leave a flat way."""
    points = np.array([[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 4.0]])
    found = {frozenset(triangle) for triangle in clip_ears(points, [np.arange(4)]).tolist()}
    assert found == {frozenset({0, 1, 3}), frozenset({1, 2, 3})}
