"""Self-crossings: planted ones of known depth and place, none where there are none, shapely as the oracle."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

import kin.contour.biarc
from kin.contour.arcs import unit
from kin.contour.bezier import Beziers
from kin.contour.closed_spline import closed_spline
from kin.contour.contour import Contour
from kin.contour.intersections import crossings, first_meeting, meetings
from kin.contour.pieces import Pieces


def circle(n: int, radius: float = 25.0, centre: tuple[float, float] = (0.0, 0.0)) -> tuple[np.ndarray, np.ndarray]:
    return np.array(centre) + radius * unit(np.arange(n) * 2.0 * np.pi / n), np.full(n, np.tan(np.pi / 2.0 / n))


def waves(amplitude: float, count: int, n: int = 2400) -> Contour:
    t = np.arange(n) * 2.0 * np.pi / n
    return Contour.from_vertices((25.0 + amplitude * np.cos(count * t))[:, None] * unit(t))


def turned(contour: Contour, first: int) -> Contour:
    return Contour.from_pieces(contour.take(np.roll(np.arange(len(contour)), -first)))


@pytest.mark.parametrize("n", [2, 3, 50])
def test_a_circle_has_none(n: int) -> None:
    contour = Contour.from_bulges(*circle(n))
    assert len(crossings(contour).point) == 0


def test_waves_have_no_crossing() -> None:
    contour = waves(0.5, 12)
    assert len(crossings(contour).point) == 0


def test_figures_of_eight_cross_once() -> None:
    lines = Contour.from_vertices(np.array([[-10.0, -5.0], [10.0, 5.0], [10.0, -5.0], [-10.0, 5.0]]))
    found = crossings(lines)
    np.testing.assert_allclose(found.point, [[0.0, 0.0]], atol=1e-14)
    assert sorted(found.piece[0].tolist()) == [0, 2]
    # two full circles but for the gaps through which they are joined crosswise
    points = np.array([[-1.0, 0.5], [-1.0, -0.5], [1.0, 0.5], [1.0, -0.5]])
    arcs = Contour.from_bulges(points, np.array([8.0, 0.0, -8.0, 0.0]))
    found = crossings(arcs)
    np.testing.assert_allclose(found.point, [[0.0, 0.0]], atol=1e-14)


def of_spline(points: np.ndarray, weight: float = 1.0) -> Contour:
    control = closed_spline(points)
    weights = np.ones(control.shape[:2])
    weights[:, 1:3] = weight
    return Contour.from_pieces(Pieces.from_unrolled(Beziers(control, weights).unrolled().pieces))


@pytest.mark.thin(2)
@pytest.mark.parametrize("weight", [1.0, 1.3])
def test_splines_are_seen_whole_by_their_own_polynomials(weight: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """No arcs are made for a wavy spline beside a bore that is far from it; those of one that crosses itself are."""
    t = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    wavy = of_spline((30.0 + 3.0 * np.cos(5.0 * t))[:, None] * unit(t), weight)
    assert not wavy.is_convex
    bore = Contour.from_bulges(np.array([[5.0, 0.0], [-5.0, 0.0]]), np.ones(2))
    rough = wavy.rough
    assert rough[1] == pytest.approx(1e-4 * 33.0, rel=0.1)
    monkeypatch.setattr(kin.contour.biarc, "arcs_along", None)
    assert len(crossings(wavy).point) == 0
    assert first_meeting([wavy, bore]) is None
    monkeypatch.undo()
    eight = of_spline(np.column_stack([30.0 * np.sin(t), 10.0 * np.sin(2.0 * t)]), weight)
    assert np.allclose(crossings(eight).point, 0.0, atol=1e-6)
    assert len(crossings(eight).point)


def test_arcs_that_cross_and_lines_that_cross_arcs() -> None:
    # a lens turned inside out: the second arc bulges through the first
    contour = Contour.from_bulges(
        np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 3.0], [0.0, 3.0]]), np.array([0.0, 0.0, -0.9, 0.0])
    )
    found = crossings(contour)
    assert len(found.point) == 2
    half = np.tan(2.0 * np.arctan(0.9))
    radius = 5.0 * (1.0 + 0.81) / 1.8
    centre = np.array([5.0, 3.0 + 5.0 / half]) if half else np.zeros(2)
    np.testing.assert_allclose(np.hypot(*(found.point - centre).T), radius, atol=1e-12)
    np.testing.assert_allclose(found.point[:, 1], 0.0, atol=1e-12)
    assert all(sorted(p) == [0, 2] for p in found.piece.tolist())


def test_touching_covering_and_spikes_are_found() -> None:
    touching = Contour.from_vertices(np.array([[0, 0], [10, 0], [10, 10], [5, 0], [0, 10]], dtype=float))
    found = crossings(touching)
    assert len(found.point) >= 1
    np.testing.assert_allclose(found.point, np.tile([5.0, 0.0], (len(found.point), 1)), atol=1e-12)
    spike = Contour.from_vertices(np.array([[0, 0], [10, 0], [10, 10], [10, 20], [10, 10.5], [0, 10]], dtype=float))
    assert len(crossings(spike).point) > 0
    twice = Contour.from_bulges(np.concatenate([circle(7)[0]] * 2), np.concatenate([circle(7)[1]] * 2))
    assert len(crossings(twice).point) > 0
    back = Contour.from_bulges(np.array([[-5.0, 0.0], [5.0, 0.0]]), np.array([1.0, -1.0]))
    assert len(crossings(back).point) > 0


def test_vertices_swapped_in_a_long_contour() -> None:
    points, _ = circle(3000)
    points[[700, 701]] = points[[701, 700]]
    found = crossings(Contour.from_vertices(points))
    assert len(found.point) == 1
    assert np.hypot(*(found.point[0] - points[700])) < 0.1


def test_a_long_contour_far_from_convex_without_a_crossing() -> None:
    """There and back along a spiral, 3 mm apart: no point sees it whole, so every piece is compared."""
    t = np.linspace(0.0, 6.0 * np.pi, 4000)
    out = (10.0 + 2.0 * t)[:, None] * unit(t)
    back = (13.0 + 2.0 * t[::-1])[:, None] * unit(t[::-1])
    contour = Contour.from_vertices(np.concatenate([out, back]))
    assert len(crossings(contour).point) == 0
    nearer = (10.0 + 2.0 * t + 4.0 * np.pi)[::-1, None] * unit(t[::-1])  # lies on the next turn of the first
    assert len(crossings(Contour.from_vertices(np.concatenate([out, nearer]))).point) > 0


@pytest.mark.slow
def test_a_scribble_is_told_in_bounded_time_and_memory() -> None:
    points = np.random.default_rng(1).random((3000, 2)) * 100.0
    assert len(crossings(Contour.from_vertices(points)).point) > 200


@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=3, max_size=14, unique=True))
@settings(max_examples=examples(300), deadline=None)
def test_polygons_on_a_grid_are_simple_when_shapely_says_so(points: list[tuple[int, int]]) -> None:
    shapely = pytest.importorskip("shapely")
    ring = shapely.LinearRing(points)
    contour = Contour.from_vertices(np.array(points, dtype=float))
    assert (len(crossings(contour).point) == 0) == ring.is_simple


@given(st.integers(0, 2**32 - 1), st.integers(3, 9))
@settings(max_examples=examples(100), deadline=None)
def test_every_crossing_lies_on_both_pieces(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    contour = Contour.from_bulges(rng.normal(size=(n, 2)) * 10.0, rng.uniform(-1.2, 1.2, n))
    found = crossings(contour)
    for point, pair in zip(found.point, found.piece, strict=True):
        for k in pair:
            alone = contour.take(np.array([k]))
            assert Contour.from_pieces(Pieces.joined([alone, alone.turned_round()])).distance(point[None])[0] < 3e-9


def test_meetings_of_two_contours() -> None:
    one = Contour.from_bulges(*circle(3))
    other = Contour.from_bulges(*circle(2, 10.0, (30.0, 0.0)))
    found = meetings(one, other)
    x = (625.0 - 100.0 + 900.0) / 60.0
    y = np.sqrt(625.0 - x * x)
    np.testing.assert_allclose(found.point[np.argsort(found.point[:, 1])], [[x, -y], [x, y]], atol=1e-12)
    assert len(meetings(one, Contour.from_bulges(*circle(2, 10.0))).point) == 0


def test_contours_of_a_kilometre_are_judged_with_a_precision_to_match() -> None:
    contour = Contour.from_bulges(*circle(50, 1e6))
    flipped = Contour.from_bulges(contour.start, np.where(np.arange(50) == 7, -1.0, 1.0) * np.tan(np.pi / 100.0))
    assert len(crossings(flipped).point) == 0
