"""Which contours go round the shaft: circles, polygons and arcs, against distances and winding numbers."""

from __future__ import annotations

import numpy as np
import pytest

from kin.contour.about import circle_about, goes_round, tracks
from kin.contour.arcs import unit
from kin.contour.contour import Contour
from kin.contour.pieces import Pieces

TURN = 2.0 * np.pi


def circle(centre: np.ndarray, radius: float, begin: float, sweep: float = TURN) -> Contour:
    """A circle of one piece."""
    one = (np.array([value]) for value in (radius, begin, sweep))
    return Contour.from_pieces(Pieces.from_arcs(centre[None], *one))


@pytest.mark.parametrize("degrees", [0.0, 11.25, 100.0])
@pytest.mark.parametrize("sweep", [TURN, -TURN])
def test_a_circle_of_one_piece_goes_round_what_is_inside_it(degrees, sweep):
    """By chords of 16 points a circle of 50 mm left out a shaft 49.5 mm from its centre."""
    centre = -unit(np.radians(degrees))
    for distance in (0.0, 20.0, 49.5, 49.9999):
        assert goes_round(circle(distance * centre, 50.0, 0.0, sweep))
    for distance in (50.0001, 50.5, 80.0):
        assert not goes_round(circle(distance * centre, 50.0, 0.0, sweep))


@pytest.mark.slow
def test_arcs_that_bulge_out_and_in_go_round_as_a_polygon_through_many_of_their_points():
    rng = np.random.default_rng(5)
    both = set()
    for _ in range(100):
        count = int(rng.integers(3, 7))
        angle = np.sort(rng.uniform(0.0, TURN, count))
        corners = unit(angle) * rng.uniform(5.0, 12.0, (count, 1)) + rng.uniform(-9.0, 9.0, 2)
        contour = Contour.from_bulges(corners, rng.uniform(-1.2, 1.2, count))
        points = contour.sample(2000)
        if np.hypot(*points.T).min() < 0.02:
            continue
        swept = np.angle(np.exp(1j * np.diff(np.angle(points @ [1.0, 1j]), append=np.angle(points[0] @ [1.0, 1j]))))
        both.add(inside := bool(abs(swept.sum()) > np.pi))
        assert goes_round(contour) == inside
        assert goes_round(contour.reversed()) == inside
    assert both == {False, True}


def test_a_follower_runs_on_what_is_no_circle_about_the_shaft():
    square = Contour.from_vertices(20.0 * unit(np.arange(4) * TURN / 4.0))
    bore, aside = circle(np.zeros(2), 5.0, 0.0), circle(np.array([12.0, 0.0]), 2.0, 0.0)
    assert circle_about(bore) == pytest.approx(10.0)
    assert circle_about(square) is None
    assert tracks([bore, aside, square]) == [square]
    assert tracks([aside, bore]) == [bore]
    assert tracks([aside]) == []
