"""Parallels of chains of lines and arcs: closed forms, and shapely's buffers."""

import numpy as np
import pytest
from support.heavy import shapely

from camgeo.part.shapes import flattened, keyed, polygonal, slot
from kin.contour.contour import Contour
from kin.contour.offset import TightError, chain_of, parallel

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
L_SHAPE = np.array([[0.0, 0.0], [20.0, 0.0], [20.0, 8.0], [8.0, 8.0], [8.0, 20.0], [0.0, 20.0]])


def buffered(contour, distance, join="round"):
    ring = shapely.Polygon(contour.sample(400))
    style = {"round": "round", "mitre": "mitre"}[join]
    return ring.buffer(-distance, quad_segs=400, join_style=style, mitre_limit=100.0)


def test_a_square_inside_and_outside():
    chain = chain_of(SQUARE, np.zeros(4))
    inside = parallel(chain, 2.0, 1e-9)
    assert inside.area == pytest.approx(36.0, abs=1e-12)
    assert len(inside) == 4
    outside = parallel(chain, -2.0, 1e-9)
    assert outside.area == pytest.approx(100 + 80 + 4 * np.pi, abs=1e-12)
    assert len(outside) == 8


def test_a_circle_and_back():
    circle = Contour.from_bulges(np.array([[5.0, 0.0], [-5.0, 0.0]]), np.ones(2))
    inside = parallel(circle.as_arcs()[0], 2.0, 1e-9)
    assert inside.area == pytest.approx(9 * np.pi)
    back = parallel(inside.as_arcs()[0], -2.0, 1e-9)
    assert back.area == pytest.approx(25 * np.pi)
    with pytest.raises(TightError, match=r"turns too sharply for its parallel at 6 mm, near \(5, 0\)"):
        parallel(circle.as_arcs()[0], 6.0, 1e-9)


def test_the_arc_about_a_corner_shrinks_to_it():
    """A parallel outside and back gives the corners again, also where rounding leaves an arc a little too small."""
    chain = chain_of(SQUARE, np.zeros(4))
    outside = parallel(chain, -3.0, 1e-9)
    for off in (0.0, 1e-7, -1e-7):
        back = parallel(outside.as_arcs()[0], 3.0 + off, 1e-6)
        assert len(back) == 4
        assert np.abs(np.sort(back.vertices, axis=0) - np.sort(SQUARE, axis=0)).max() <= 1.1 * abs(off) + 1e-12


def test_a_spike_of_pieces_each_too_short_to_count():
    """Pieces are left out if what they make together is short, not each by itself; over the seam too."""
    steps = 0.04 * np.arange(26)
    spike = np.concatenate(
        [np.column_stack([np.full(26, 5.0), steps]), np.column_stack([np.full(25, 5.02), steps[:0:-1]])]
    )
    points = np.concatenate([SQUARE[:1], spike, SQUARE[1:]])
    for shift in (0, 20):
        with pytest.raises(TightError):
            parallel(chain_of(np.roll(points, shift, axis=0), np.zeros(len(points))), 2.0, 0.05)
    few = np.concatenate([SQUARE[:1], [[5.0, 0.0], [5.01, 0.0], [5.02, 0.0], [5.03, 0.0]], SQUARE[1:]])
    assert len(parallel(chain_of(few, np.zeros(8)), 2.0, 0.05)) == 5


@pytest.mark.thin(6)
@pytest.mark.parametrize("distance", [0.7, -0.7, 1.3, -2.5])
@pytest.mark.parametrize(
    "shape",
    [
        (L_SHAPE, np.zeros(6)),
        (L_SHAPE, np.array([0.0, 0.2, 0.0, -0.3, 0.0, 0.1])),
        (keyed(10.0, 4.0, 2.5, 0.3), None),
        (flattened(8.0, 14.0, 1.0), None),
        (polygonal(6, 12.0, 0.2), None),
        (slot(3.0, 15.0, 6.0), None),
    ],
)
def test_against_buffers(shape, distance):
    outline, bulges = shape
    points, bulges = (outline.points, outline.bulges) if bulges is None else (outline, bulges)
    contour = Contour.from_bulges(points, bulges)
    found = parallel(contour.as_arcs()[0], distance, 1e-9)
    meant = buffered(contour, distance)
    assert found.area == pytest.approx(meant.area, rel=1e-4)  # shapely simplifies what it buffers
    ring = shapely.Polygon(found.sample(100))
    assert ring.symmetric_difference(meant).area < 1e-4 * meant.area
    assert ring.is_valid


def test_joints_that_do_not_quite_agree_stay_one_point():
    points = np.array([[25.0, 0.0], [0.0, 25.0], [-25.0, 0.0], [0.0, -25.0]])
    quarter = np.tan(np.pi / 8)
    rng = np.random.default_rng(5)
    chain = chain_of(points + rng.normal(0.0, 1e-6, (4, 2)), np.full(4, quarter))
    found = parallel(chain, 3.0, 5e-5)
    assert len(found) == 4
    assert np.hypot(*found.sample(50).T) == pytest.approx(22.0, abs=1e-5)


def test_a_piece_that_is_swallowed_is_told():
    notch = [[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [11.0, 10.0], [11.0, 9.0], [9.0, 9.0], [9.0, 10.0], [0.0, 10.0]]
    with pytest.raises(TightError):
        parallel(chain_of(np.array(notch), np.zeros(8)), -1.5, 1e-9)
