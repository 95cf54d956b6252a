"""Contours against closed forms; every shape again reversed, mirrored, and from every start."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import interpolate

from kin.contour.arcs import unit
from kin.contour.bezier import Beziers
from kin.contour.biarc import arcs_along
from kin.contour.contour import ARC, BEZIER, LINE, Contour
from kin.contour.hull import convex_hull
from kin.contour.nearest import nearest
from kin.contour.pieces import Pieces, wrapped
from kin.follower.support import bearing_of
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Callable

ANGLES = np.linspace(-1.0, 12.0, 2003)


def turning(beziers: Beziers) -> Pieces:
    return Pieces.from_unrolled(beziers.unrolled().pieces)


@dataclass(frozen=True)
class Known:
    """A contour whose support function, area and perimeter are known."""

    contour: Contour
    p: Callable[[np.ndarray], np.ndarray]
    area: float
    length: float
    convex: bool = True


def eccentric_circle(arcs: int) -> Known:
    centre, radius = np.array([3.0, -1.5]), 25.0
    angles = 0.3 + np.sort(np.random.default_rng(arcs).random(arcs)) * 2.0 * np.pi if arcs > 2 else np.array([0.3, 2.9])
    sweeps = np.mod(np.roll(angles, -1) - angles, 2.0 * np.pi)
    return Known(
        Contour.from_bulges(centre + radius * unit(angles), np.tan(sweeps / 4.0)),
        lambda t: unit(t) @ centre + radius,
        np.pi * radius**2,
        2.0 * np.pi * radius,
    )


def square() -> Known:
    corners = np.array([[10.0, -10.0], [10.0, 10.0], [-10.0, 10.0], [-10.0, -10.0]])
    return Known(Contour.from_vertices(corners), lambda t: 10.0 * (np.abs(np.cos(t)) + np.abs(np.sin(t))), 400.0, 80.0)


def stadium() -> Known:
    corners = np.array([[20.0, -8.0], [20.0, 8.0], [-20.0, 8.0], [-20.0, -8.0]])
    contour = Contour.from_bulges(corners, np.array([1.0, 0.0, 1.0, 0.0]))
    area, length = 40.0 * 16.0 + 64.0 * np.pi, 80.0 + 16.0 * np.pi
    return Known(contour, lambda t: 8.0 + 20.0 * np.abs(np.cos(t)), area, length)


def rounded_reuleaux() -> Known:
    """Breadth 50, corners rounded by 5: arcs of 5 and of 45 by turns, all of 60 degrees."""
    breadth, r = 50.0, 5.0
    side = breadth - 2.0 * r
    towards = np.pi / 2.0 + np.arange(3) * 2.0 * np.pi / 3.0
    corners = side / np.sqrt(3.0) * unit(towards)

    def p(t: np.ndarray) -> np.ndarray:
        reach = unit(t) @ corners.T
        off = np.abs(wrapped(t[:, None] - towards))
        return np.where(off.min(axis=1) <= np.pi / 6.0, reach.max(axis=1), reach.min(axis=1) + side) + r

    # the small arc about corner k spans the normals towards[k] -+ 30 degrees; the large one about k is opposite
    ends = [corners[k] + r * unit(np.array(towards[k] + s * np.pi / 6.0)) for k in range(3) for s in (-1.0, 1.0)]
    contour = Contour.from_bulges(np.array(ends), np.full(6, np.tan(np.pi / 12.0)))
    inner = (np.pi - np.sqrt(3.0)) / 2.0 * side**2
    return Known(contour, p, inner + np.pi * side * r + np.pi * r**2, np.pi * breadth)


def ellipse(a: float = 30.0, b: float = 12.0, turn: float = 0.4) -> Known:
    centre = np.array([2.0, 1.0])
    pieces = Beziers.from_ellipse(
        centre, a * unit(np.array(turn)), b * unit(np.array(turn + np.pi / 2.0)), 0.0, 2.0 * np.pi
    )
    return Known(
        Contour.from_pieces(turning(pieces)),
        lambda t: unit(t) @ centre + np.hypot(a * np.cos(t - turn), b * np.sin(t - turn)),
        np.pi * a * b,
        float(4 * a * mpmath.ellipe(1.0 - (b / a) ** 2)),
    )


def mixed() -> Known:
    """A D: a straight back, half an ellipse in front."""
    bow = turning(Beziers.from_ellipse(np.zeros(2), np.array([0.0, -10.0]), np.array([20.0, 0.0]), 0.0, np.pi))
    back = Pieces.from_chords(np.array([[0.0, 10.0]]), np.array([[0.0, -10.0]]), np.zeros(1))
    return Known(
        Contour.from_pieces(Pieces.joined([bow, back])),
        lambda t: np.where(np.cos(t) > 0.0, np.hypot(20.0 * np.cos(t), 10.0 * np.sin(t)), 10.0 * np.abs(np.sin(t))),
        100.0 * np.pi,
        20.0 + float(2 * 20 * mpmath.ellipe(0.75)),
    )


KNOWN = {
    "circle of 2 arcs": eccentric_circle(2),
    "circle of 3 arcs": eccentric_circle(3),
    "circle of 7 arcs": eccentric_circle(7),
    "square": square(),
    "stadium": stadium(),
    "rounded Reuleaux": rounded_reuleaux(),
    "ellipse": ellipse(),
    "D": mixed(),
}


def from_start(contour: Contour, first: int) -> Contour:
    return Contour.from_pieces(contour.take(np.roll(np.arange(len(contour)), -first)))


def variants(contour: Contour) -> list[Contour]:
    turns = [from_start(contour, k) for k in range(len(contour))]
    return turns + [c.reversed() for c in turns]


@pytest.mark.thin(3)
@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN.keys())
def test_support_function_is_the_closed_form(known: Known) -> None:
    for contour in variants(known.contour):
        q, point, piece = contour.support(ANGLES)
        np.testing.assert_allclose(q, known.p(ANGLES), rtol=0.0, atol=5e-14)
        np.testing.assert_allclose((point * unit(ANGLES)).sum(axis=1), q, rtol=0.0, atol=5e-14)
        assert piece.min() >= 0
        assert piece.max() < len(contour)


@pytest.mark.thin(4)
@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN.keys())
def test_the_contact_lies_on_the_piece_that_is_named(known: Known) -> None:
    _, point, piece = known.contour.support(ANGLES)
    for k in np.unique(piece):
        alone = known.contour.take(np.array([k]))
        there = point[piece == k]
        closed = Contour.from_pieces(Pieces.joined([alone, alone.turned_round()]))
        assert closed.distance(there).max() < 2e-9


@pytest.mark.thin(3)
@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN.keys())
def test_measures(known: Known) -> None:
    directions = np.arange(4) * np.pi / 2.0
    x_max, y_max, x_min, y_min = known.p(directions) * (1, 1, -1, -1)
    for contour in variants(known.contour):
        assert abs(contour.area) == pytest.approx(known.area, rel=1e-14)
        assert contour.length == pytest.approx(known.length, rel=1e-14)
        assert tuple(contour.box) == pytest.approx((x_min, y_min, x_max, y_max), abs=1e-13)
        clockwise = contour.area < 0.0
        assert contour.turning == (-1 if clockwise else 1)
        assert contour.is_convex == (not clockwise)


@pytest.mark.thin(3)
@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN.keys())
def test_mirrored_and_scaled(known: Known) -> None:
    mirrored = known.contour.mirrored()
    np.testing.assert_allclose(mirrored.support(ANGLES).q, known.p(-ANGLES), rtol=0.0, atol=5e-14)
    assert mirrored.area == pytest.approx(known.area, rel=1e-14)
    assert mirrored.is_convex
    inches = known.contour.scaled(1.0 / 25.4)
    np.testing.assert_allclose(inches.support(ANGLES).q * 25.4, known.p(ANGLES), rtol=0.0, atol=5e-14)


@pytest.mark.parametrize("known", KNOWN.values(), ids=KNOWN.keys())
def test_between_its_break_normals_the_support_function_is_smooth(known: Known) -> None:
    """q'' + q is then a radius of curvature: by differences, in the middle of each interval, none is infinite."""
    breaks = known.contour.normals
    assert (np.diff(breaks) > 0.0).all()
    assert breaks[0] >= 0.0
    assert breaks[-1] < 2.0 * np.pi
    width = np.diff(breaks, append=breaks[0] + 2.0 * np.pi)
    h = width[width > 1e-3] / 2.1
    middle = breaks[width > 1e-3] + width[width > 1e-3] / 2.0
    q = [known.contour.support(middle + s * h).q for s in (-1.0, -0.5, 0.5, 1.0)]
    slopes = [(q[1] - q[0]) / h * 2.0, (q[3] - q[2]) / h * 2.0]
    assert (np.abs(slopes[1] - slopes[0]) < 200.0 * h).all()


def test_break_normals_of_a_square_and_a_stadium() -> None:
    np.testing.assert_allclose(square().contour.normals, np.arange(4) * np.pi / 2.0, atol=1e-15)
    np.testing.assert_allclose(stadium().contour.normals, [np.pi / 2.0, 3.0 * np.pi / 2.0], atol=1e-15)


def test_break_normals_of_a_dented_contour_hold_the_line_that_touches_twice() -> None:
    """Two discs of different size side by side, a waist between them: bitangent at acos(-(R - r)/distance) or so."""
    big, small, apart = 20.0, 10.0, 40.0
    lean = np.arccos((big - small) / apart)
    # waist: straight pieces between points well inside the bitangents
    a, b = 0.6, 0.6
    corners = np.array([big * unit(np.array(a)), big * unit(np.array(-a))])
    other = np.array([apart, 0.0]) + small * unit(np.array([np.pi + b, np.pi - b]))
    points = np.array([corners[0], corners[1], other[0], other[1]])
    bulges = np.tan(np.array([2.0 * np.pi - 2.0 * a, 0.0, 2.0 * np.pi - 2.0 * b, 0.0]) / 4.0)
    contour = Contour.from_bulges(points, bulges)
    assert not contour.is_convex
    gaps = np.abs(wrapped(contour.normals[:, None] - np.array([lean, -lean])))
    assert gaps.min(axis=0).max() < 1e-9
    q = contour.support(ANGLES).q
    np.testing.assert_allclose(q, np.maximum(big, apart * np.cos(ANGLES) + small), atol=5e-14)


@st.composite
def lumpy(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and bulges of a ragged closed contour, convex hardly ever."""
    n = draw(st.integers(3, 12))
    finite = st.floats(-30.0, 30.0, allow_nan=False, width=32)
    points = draw(st.lists(st.tuples(finite, finite), min_size=n, max_size=n, unique=True))
    bulges = draw(st.lists(st.floats(-1.5, 1.5, allow_nan=False, width=32), min_size=n, max_size=n))
    return np.array(points, dtype=float), np.array(bulges, dtype=float)


@pytest.mark.slow
@given(lumpy())
@settings(max_examples=examples(150), deadline=None)
def test_support_bounds_every_point_and_is_reached(shape: tuple[np.ndarray, np.ndarray]) -> None:
    contour = Contour.from_bulges(*shape)
    theta = np.linspace(0.0, 2.0 * np.pi, 91)
    q, point, _ = contour.support(theta)
    reach = (contour.sample(40) @ unit(theta).T).max(axis=0)
    assert (q >= reach - 1e-12).all()
    longest = contour.lengths.max() / 40.0
    assert (q <= reach + longest).all()
    assert contour.distance(point).max() < 1e-9


@given(lumpy(), st.integers(0, 11))
@settings(max_examples=examples(150), deadline=None)
def test_support_does_not_depend_on_how_the_contour_is_cut_or_run_through(
    shape: tuple[np.ndarray, np.ndarray], first: int
) -> None:
    points, bulges = shape
    contour = Contour.from_bulges(points, bulges)
    theta = np.linspace(0.0, 2.0 * np.pi, 73)
    q = contour.support(theta).q
    n = len(points)
    middles = contour.points(np.arange(n), np.full(n, 0.5))
    cut_bulges = np.repeat(np.tan(np.arctan(bulges) / 2.0), 2)
    cut = Contour.from_bulges(np.stack([points, middles], axis=1).reshape(-1, 2), cut_bulges)
    for other in (cut, contour.reversed(), from_start(contour, first % n)):
        np.testing.assert_allclose(other.support(theta).q, q, rtol=0.0, atol=1e-11)
        assert abs(other.area) == pytest.approx(abs(contour.area), abs=1e-9)
        assert other.length == pytest.approx(contour.length)


def test_a_nearly_straight_arc_loses_no_digits() -> None:
    """Radius 1e9 mm: q by way of the centre would be off by 1e-7 mm."""
    start, end, bulge = (30.0, -10.0), (30.0, 10.0), 1e-8
    contour = Contour.from_bulges(np.array([start, end, (-30.0, 0.0)]), np.array([bulge, 0.0, 0.0]))
    assert contour.radius[0] == pytest.approx(5e8)
    with mpmath.workdps(50):
        b = mpmath.mpf(bulge)
        radius = 10 * (1 + b**2) / (2 * b)
        centre = 30 - 10 * (1 - b**2) / (2 * b)
        for share in (-0.9, -0.3, 0.0, 0.5):
            theta = float(2 * mpmath.atan(b)) * share
            exact = centre * mpmath.cos(theta) + radius
            assert abs(contour.support(np.array([theta])).q[0] - exact) < 8e-15
        sweep = 4 * mpmath.atan(b)
        bow = radius**2 * (sweep - mpmath.sin(sweep)) / 2
    assert contour.area - 600.0 == pytest.approx(float(bow), rel=1e-6)


def test_the_reach_of_full_turns_and_of_many_angles_at_once() -> None:
    known = eccentric_circle(3)
    far = np.array([1e4, -7e3, 0.0])
    np.testing.assert_allclose(known.contour.support(far).q, known.p(far), atol=1e-10)
    assert known.contour.support(np.zeros(0)).q.shape == (0,)


def test_an_arc_of_more_than_half_a_turn() -> None:
    contour = Contour.from_bulges(np.array([[0.0, -6.0], [0.0, 6.0]]), np.array([3.0, 0.0]))
    radius, x = 10.0, 8.0
    assert contour.radius[0] == pytest.approx(radius)
    assert contour.box.x_max == pytest.approx(x + radius)
    chain, owner = contour.as_arcs()
    assert owner.tolist() == [0, 0, 1]
    assert (np.abs(chain.curvature * chain.length) <= np.pi).all()


def test_kinds_and_joints() -> None:
    d = mixed().contour
    assert [int(k) for k in np.unique(d.kind)] == [LINE, BEZIER]
    assert (eccentric_circle(3).contour.kind == ARC).all()
    np.testing.assert_allclose(np.sort(d.joints)[-2:], [np.pi / 2.0, np.pi / 2.0], atol=1e-12)
    np.testing.assert_allclose(np.sort(d.joints)[:-2], 0.0, atol=1e-12)


def test_ends_that_do_not_meet_are_all_counted() -> None:
    square_with_gap = np.array([[10.0, -10.0], [10.0, 10.0], [-10.0, 10.0], [-10.0, -10.0]])
    ends = np.roll(square_with_gap, -1, axis=0) + np.array([0.0, 1e-3])
    contour = Contour.from_pieces(Pieces.from_chords(square_with_gap, ends, np.zeros(4)))
    assert contour.vertices.shape == (8, 2)
    q, _, piece = contour.support(np.array([np.pi / 2.0, 0.1]))
    assert q[0] == pytest.approx(10.001, abs=1e-12)
    assert piece[1] in {0, 1}


# --- convex hull


@given(st.lists(st.tuples(st.integers(-6, 6), st.integers(-6, 6)), min_size=1, max_size=60))
@settings(max_examples=examples(300), deadline=None)
def test_hull_of_points_on_a_grid(points: list[tuple[int, int]]) -> None:
    shapely = pytest.importorskip("shapely")
    given_points = np.array(points, dtype=float)
    corners = given_points[convex_hull(given_points)]
    hull = shapely.MultiPoint(points).convex_hull
    if hull.geom_type != "Polygon":
        assert len(corners) <= 2
        assert shapely.MultiPoint(corners).convex_hull.equals(hull)
        return
    assert len(corners) == len(hull.exterior.coords) - 1
    ring = shapely.Polygon(corners)
    assert ring.equals(hull)
    assert ring.exterior.is_ccw


@pytest.mark.slow
def test_hull_of_a_circle_with_one_point_pulled_out() -> None:
    """A thousand corners vanish behind it, one after the other: the part that whole passes do not finish."""
    shapely = pytest.importorskip("shapely")
    t = np.arange(20000) * 2.0 * np.pi / 20000
    points = 25.0 * unit(t)
    points[700] *= 1.0 + 1e-3
    corners = points[convex_hull(points)]
    hull = shapely.MultiPoint(points).convex_hull
    assert 19000 < len(corners) < 19900
    assert abs(shapely.Polygon(corners).area - hull.area) < 1e-9
    contour = Contour.from_vertices(points)
    theta = np.linspace(0.0, 6.28, 500)
    np.testing.assert_allclose(contour.support(theta).q, (points @ unit(theta).T).max(axis=0), atol=1e-14)


# --- Bezier pieces


def knots_of(rng: np.random.Generator, degree: int, count: int, *, clamped: bool) -> np.ndarray:
    inner = np.sort(rng.integers(1, 9, count + degree + 1).astype(float)) + np.arange(count + degree + 1) * 1e-3
    if clamped:
        inner[: degree + 1], inner[count:] = inner[degree], inner[count]
    return inner


@pytest.mark.thin(4)
@pytest.mark.parametrize("degree", range(1, 12))
@pytest.mark.parametrize("clamped", [True, False])
def test_spline_spans_are_the_spline(degree: int, clamped: bool) -> None:
    rng = np.random.default_rng(degree)
    count = degree + 6
    knots, control = knots_of(rng, degree, count, clamped=clamped), rng.normal(size=(count, 2)) * 20.0
    beziers = Beziers.from_spline(degree, knots, control, np.ones(count))
    domain = np.unique(knots[degree : count + 1])
    assert beziers.count == len(domain) - 1
    curve = interpolate.BSpline(knots, control, degree)
    for share in (0.0, 0.21, 0.5, 0.83, 1.0):
        at = domain[:-1] + share * np.diff(domain)
        points = beziers.point(np.arange(beziers.count), np.full(beziers.count, share))
        np.testing.assert_allclose(points, curve(at), atol=1e-10)


def test_rational_spline_circle() -> None:
    """The circle as nine control points with weights 1 and sqrt(1/2): exact."""
    h = np.sqrt(0.5)
    control = 25.0 * np.array(
        [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], dtype=float
    )
    weight = np.array([1, h, 1, h, 1, h, 1, h, 1])
    knots = np.array([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], dtype=float)
    contour = Contour.from_pieces(turning(Beziers.from_spline(2, knots, control, weight)))
    assert len(contour) == 4
    np.testing.assert_allclose(contour.support(ANGLES).q, 25.0, atol=2e-14)
    assert contour.area == pytest.approx(625.0 * np.pi, rel=1e-14)
    assert contour.length == pytest.approx(50.0 * np.pi, rel=1e-14)


@pytest.mark.parametrize("degree", range(1, 12))
def test_elevation_leaves_the_curve(degree: int) -> None:
    rng = np.random.default_rng(degree)
    low = Beziers(rng.normal(size=(5, degree + 1, 2)), rng.uniform(0.5, 2.0, (5, degree + 1)))
    high = low.elevated(12)
    rows, t = np.arange(5), np.full(5, 0.37)
    assert high.degree == 12
    np.testing.assert_allclose(high.point(rows, t), low.point(rows, t), atol=1e-14)


CURVES = {
    "S": [(0, 0), (10, 20), (20, -20), (30, 0)],
    "loop": [(0, 0), (40, 20), (-10, 20), (30, 0)],
    "cusp": [(0, 0), (30, 20), (0, 20), (30, 0)],
    "arch": [(0, 0), (5, 20), (20, 20), (25, 0)],
    "straight": [(0, 0), (5, 5), (20, 20), (25, 25)],
    "back and forth": [(0, 0), (40, 0), (-15, 0), (25, 0)],
    "end without derivative": [(0, 0), (0, 0), (20, 20), (25, 0)],
}


@pytest.mark.thin(6)
@pytest.mark.parametrize("control", CURVES.values(), ids=CURVES.keys())
@pytest.mark.parametrize("weights", [(1, 1, 1, 1), (1, 3, 0.5, 2)])
def test_unrolled_pieces_turn_one_way_and_their_support_is_that_of_the_curve(
    control: list[tuple[float, float]], weights: tuple[float, ...]
) -> None:
    whole = Beziers(np.array([control], dtype=float), np.array([weights], dtype=float))
    pieces, row = whole.unrolled()
    assert (row == 0).all()
    assert pieces.control[0, 0].tolist() == list(control[0])
    assert pieces.control[-1, -1].tolist() == list(control[-1])
    assert np.array_equal(pieces.control[1:, 0], pieces.control[:-1, -1])
    there_and_back = Contour.from_pieces(
        Pieces.joined([turning(whole), turning(whole).take(np.arange(pieces.count)[::-1]).turned_round()])
    )
    t = np.linspace(0.0, 1.0, 4001)
    points = whole.point(np.zeros(t.size, dtype=np.intp), t)
    theta = np.linspace(0.0, 2.0 * np.pi, 361)
    reach = (points @ unit(theta).T).max(axis=0)
    q = there_and_back.support(theta).q
    assert (q >= reach - 1e-12).all()
    assert (q <= reach + 1e-5).all()


def test_a_cut_into_halves_keeps_area_and_length() -> None:
    known = ellipse()
    beziers = known.contour.beziers
    rows = np.repeat(np.arange(beziers.count), 2)
    low = np.tile([0.0, 0.4], beziers.count)
    high = np.tile([0.4, 1.0], beziers.count)
    cut = Contour.from_pieces(turning(beziers.take(rows).part(low, high)))
    assert cut.area == pytest.approx(known.area, rel=1e-13)
    assert cut.length == pytest.approx(known.length, rel=1e-13)


# --- arcs that stand for splines


def rose(size: float = 1.0) -> Contour:
    """The cam of p = 25 + 2 cos 3t as a periodic quintic through 60 points; radius of curvature 9 to 41 mm."""

    t = np.linspace(0.0, 2.0 * np.pi, 61)
    p, slope = 25.0 + 2.0 * np.cos(3.0 * t), -6.0 * np.sin(3.0 * t)
    points = p[:, None] * unit(t) + slope[:, None] * unit(t + np.pi / 2.0)
    points *= size
    points[-1] = points[0]
    spline = interpolate.make_interp_spline(t, points, k=5, bc_type="periodic")
    beziers = Beziers.from_spline(5, spline.t, spline.c, np.ones(len(spline.c)))
    beziers.control[-1, -1] = beziers.control[0, 0]
    return Contour.from_pieces(turning(beziers))


@pytest.mark.thin(6)
@pytest.mark.parametrize("made", [rose, lambda: ellipse().contour], ids=["spline", "ellipse"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6, 1e-8])
def test_arcs_along_a_spline_keep_their_promise(made: Callable[[], Contour], tolerance: float) -> None:
    contour = made()
    chain, owner = contour.as_arcs(tolerance)
    assert (np.diff(owner) >= 0).all()
    assert (np.abs(chain.turns()) < 1e-10).all()
    np.testing.assert_allclose(chain.ends, np.roll(chain.start, -1, axis=0), atol=1e-12)
    off = contour.distance(contour.sample(60), tolerance)
    assert off.max() <= tolerance
    assert off.max() > 0.02 * tolerance
    back = contour.distance(chain.points(0.3 * chain.length), 1e-10)
    assert back.max() <= tolerance + 1e-10


@pytest.mark.thin(3)
@pytest.mark.parametrize("control", CURVES.values(), ids=CURVES.keys())
def test_arcs_along_curves_with_inflections_cusps_and_vanishing_derivatives(control: list[tuple[float, float]]) -> None:
    curve = Beziers(np.array([control], dtype=float), np.ones((1, 4)))
    chain, _ = arcs_along(curve.unrolled().pieces, 1e-7)
    t = np.linspace(0.0, 1.0, 2001)
    _, off = nearest(chain, curve.point(np.zeros(t.size, dtype=np.intp), t))
    assert off.max() <= 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("size", [2e-5, 2e4])
def test_arcs_along_a_spline_are_as_close_on_a_cam_of_a_micrometre(size: float) -> None:
    contour = rose(size)
    chain, _ = contour.as_arcs()
    extent = float(np.abs(contour.vertices).max())
    assert contour.distance(chain.ends, 1e-13 * extent).max() <= 2.1e-11 * extent
    off = contour.distance(chain.points(0.3 * chain.length), 1e-12 * extent)
    assert off.max() <= 2.3e-11 * extent


def test_arcs_finer_than_rounding_are_refused() -> None:
    with pytest.raises(ValueError, match="lost in rounding"):
        rose().as_arcs(1e-17)


def test_distance_from_lines_and_arcs_is_exact() -> None:
    rng = np.random.default_rng(5)
    points = rng.normal(size=(400, 2)) * 30.0
    circle = eccentric_circle(7)
    exact = np.abs(np.hypot(*(points - (3.0, -1.5)).T) - 25.0)
    np.testing.assert_allclose(circle.contour.distance(points), exact, atol=2e-14)
    x, y = np.abs(points).T
    outside = np.hypot(np.maximum(x - 10.0, 0.0), np.maximum(y - 10.0, 0.0))
    exact = np.where((x <= 10.0) & (y <= 10.0), 10.0 - np.maximum(x, y), outside)
    np.testing.assert_allclose(square().contour.distance(points), exact, atol=2e-14)


def test_a_hundred_thousand_pieces() -> None:
    """Only that it works at this size, with a memory that does not grow with pieces times angles."""
    n = 100_000
    t = np.arange(n) * 2.0 * np.pi / n
    points = np.array([3.0, 1.0]) + 25.0 * unit(t)
    contour = Contour.from_bulges(points, np.full(n, np.tan(np.pi / 2.0 / n)))
    theta = np.arange(3600) * np.pi / 1800.0
    np.testing.assert_allclose(contour.support(theta).q, 25.0 + unit(theta) @ (3.0, 1.0), atol=2e-14)
    assert contour.is_convex


@settings(max_examples=examples(40), deadline=None)
@given(seed=st.integers(0, 10_000), off=st.sampled_from([1e-13, 1e-12, 1e-11, 1e-9]))
def test_arcs_that_a_file_rounds_bear_one_after_the_other(seed, off):
    """Thirteen digits put an arc's end beside it by more than doubles do; no arc may bear in place of the next one."""
    rng = np.random.default_rng(seed)
    turn = np.sort(rng.uniform(0.0, TURN, 12))
    if np.diff(turn, append=turn[0] + TURN).max() > 1.5:
        turn = TURN * np.arange(12) / 12
    sweep = np.diff(turn, append=turn[0] + TURN)
    radius = rng.uniform(10.0, 40.0, 12)
    # opposite arcs alike: the chain closes
    turn, sweep = np.concatenate([0.5 * turn, 0.5 * turn + np.pi]), np.tile(0.5 * sweep, 2)
    radius = np.tile(radius, 2)
    step = radius[:, None] * (unit(turn + sweep) - unit(turn))
    start = np.cumsum(step, axis=0) - step
    start -= start.mean(axis=0)
    true = Contour.from_bulges(start, np.tan(0.25 * sweep))
    angle = true.angle + rng.uniform(-off, off, 24) / 30.0
    rounded = replace(true, radius=true.radius + rng.uniform(-off, off, 24), angle=angle)
    bearing = bearing_of(rounded)
    theta = rng.uniform(0.0, TURN, 500)
    q = bearing.derivatives(theta, bearing.find(theta))[0]
    assert np.abs(q - true.support(theta).q).max() < 20.0 * off + 1e-12
