"""Regions: the point that is kept inside, however thin they are."""

from __future__ import annotations

import numpy as np
import pytest

from kin.contour.arcs import Arcs
from kin.contour.contour import Contour
from kin.contour.region import Region


def circle(radius: float) -> Contour:
    return Contour.from_bulges(np.array([[radius, 0.0], [-radius, 0.0]]), np.ones(2))


@pytest.mark.thin(3)
@pytest.mark.parametrize("width", [20.0, 1.0, 0.03, 1e-4, 1e-7])
def test_the_point_inside_a_ring_is_inside_however_thin_the_ring_is(width):
    """A grid of 24 by 24 points misses a ring of 0.03 mm."""
    region = Region.of(circle(50.0), [circle(50.0 - width)])
    x, y = region.inner_point
    assert 50.0 - 0.9 * width < np.hypot(x, y) < 50.0 - 0.1 * width


def test_the_point_inside_a_thin_bar_is_inside():
    c, s = np.cos(0.3), np.sin(0.3)
    corners = np.array([[0.0, 0.0], [80.0, 0.0], [80.0, 1e-3], [0.0, 1e-3]]) @ np.array([[c, s], [-s, c]])
    region = Region.of(Contour.from_vertices(corners))
    depth = float(region.signed(region.inner_point[None])[0])
    assert -0.5e-3 <= depth <= -0.25e-3 * (1.0 - 1e-6)


def test_no_point_of_an_arc_is_deeper_than_its_bound():
    """Of arcs at random in and about a disc with a hole; along a line beside a straight piece the bound is met."""
    rng, region = np.random.default_rng(5), Region.of(circle(50.0), [circle(20.0)])
    count = 60
    angle, length = rng.uniform(0.0, 2.0 * np.pi, count), rng.uniform(0.1, 6.0, count)
    tangent = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    arcs = Arcs(rng.uniform(-50.0, 50.0, (count, 2)), tangent, rng.uniform(-0.1, 0.1, count), length)
    inside = np.stack([arcs.points(share * length) for share in np.linspace(0.0, 1.0, 9)])
    least = region.signed(inside.reshape(-1, 2)).reshape(9, count).min(axis=0)
    for piece in range(region.pieces):
        assert (region.no_deeper(arcs, np.full(count, piece)) <= least + 1e-9).all()
    square = Region.of(Contour.from_vertices(np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])))
    line = Arcs(np.array([[4.0, 1.0]]), np.array([[1.0, 0.0]]), np.zeros(1), np.ones(1))
    bounds = [float(square.no_deeper(line, np.array([piece]))[0]) for piece in range(4)]
    assert max(bounds) == pytest.approx(-1.0)
