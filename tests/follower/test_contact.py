"""First contact of a roller: closed forms, and brute force on distances by shapely."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.camfiles import arcs_through, circle_points, roller_points, support_points
from support.cases import examples
from support.heavy import shapely

from kin.contour.arcs import unit
from kin.contour.contour import Contour
from kin.contour.dilated import dilated
from kin.contour.nearest import nearest, signed_distance
from kin.follower.contact import Search, angles_of, shortened, within_reach
from kin.follower.guide import Arm
from kin.law.contacts import LEADING, TRAILING

PHI = np.arange(40) * 2 * np.pi / 40 + 0.0137
FEW = PHI[::3]


def contact_by_bisection(points, radius, arm, phi):
    """Distance from the shaft of the roller's centre: swing in from outside until the distance is the radius."""
    polygon = shapely.Polygon(points)
    lean = np.linspace(np.pi, 0.0, 1501)[:-1]
    out = []
    for angle in phi:
        centres = arm.centre(np.full_like(lean, angle), lean)
        free = shapely.distance(polygon, shapely.points(centres)) > radius
        first = int(np.argmin(free))
        assert free[0]
        assert not free.all()
        low, high = lean[first], lean[first - 1]
        for _ in range(44):
            middle = 0.5 * (low + high)
            centre = arm.centre(np.array([angle]), np.array([middle]))
            if shapely.distance(polygon, shapely.Point(centre[0])) > radius:
                high = middle
            else:
                low = middle
        out.append(np.hypot(*arm.centre(np.array([angle]), np.array([high]))[0]))
    return np.array(out)


def contact(points, radius, arm, phi, bulges=None):
    contour = Contour.from_bulges(points, np.zeros(len(points)) if bulges is None else bulges)
    return Search.of(dilated(contour.as_arcs()[0], radius), arm).first(phi)[0]


@pytest.mark.parametrize("side", [TRAILING, LEADING])
@pytest.mark.parametrize(("length", "pivot"), [(60.0, 60.0), (50.0, 75.0), (75.0, 50.0)])
def test_eccentric_circle_of_two_arcs_in_closed_form(side, length, pivot):
    """A circle of 30 mm about (6, 2): pivot, its centre and the roller's make a triangle of known sides."""
    centre, size, radius = np.array([6.0, 2.0]), 30.0, 8.0
    arm = Arm(length, pivot, side)
    r = contact(centre + np.array([[size, 0], [-size, 0]]), radius, arm, PHI, np.ones(2))
    to_centre = centre - pivot * unit(PHI)
    d = np.hypot(*to_centre.T)
    at_pivot = np.arccos((d**2 + length**2 - (size + radius) ** 2) / (2 * d * length))
    direction = np.arctan2(to_centre[:, 1], to_centre[:, 0]) + side * at_pivot
    expected = pivot * unit(PHI) + length * unit(direction)
    assert r == pytest.approx(np.hypot(*expected.T), abs=1e-12)
    assert arm.centre(PHI, arm.position(r)) == pytest.approx(expected, abs=1e-11)
    assert np.cos(arm.shaft_angle(expected) - PHI) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.thin(3)
@pytest.mark.parametrize("side", [TRAILING, LEADING])
@pytest.mark.parametrize(
    "points",
    [
        pytest.param(circle_points(5) * 30 + [4, 3], id="pentagon"),
        pytest.param(support_points(60), id="60 edges"),
        pytest.param(roller_points(90, (4, 3, 60.0, {1: 625.0}), 8.0), id="hollow"),
        pytest.param(np.array([[30, -30], [30, 30], [10, 5], [-30, 30], [-30, -30.0]]), id="deep notch"),
        pytest.param(np.array([[30, -30], [30, 30], [2, 30], [0, 0], [-2, 30], [-30, 30], [-30, -30.0]]), id="slit"),
    ],
)
def test_polygons_against_bisection_of_shapely_distances(points, side):
    arm = Arm(60.0, 60.0, side)
    assert contact(points, 8.0, arm, FEW) == pytest.approx(contact_by_bisection(points, 8.0, arm, FEW), abs=1e-9)


@pytest.mark.slow
def test_hollow_arcs_one_of_them_too_tight_for_the_roller():
    """Hollow arcs of 12 mm and of 3 mm: the second is bridged, the roller rests on its edges."""
    vertices = np.array([[30, -30], [30, 30], [12, 30], [-12, 30], [-24, 30], [-30, 30], [-30, -30.0]])
    bulges = np.array([0, 0, -1.0, 0, 0, 0, 0])  # hollow half circle of 12 mm on top
    bulges[4] = -1.0  # and of 3 mm
    fine = Contour.from_bulges(vertices, bulges).sample(400)  # chords 12 (pi/800)^2/2 = 1e-4 mm off the arc at most
    arm = Arm(60.0, 60.0, TRAILING)
    bridging = np.array([-27.0, 30.0 + np.sqrt(8.0**2 - 3.0**2)])  # at rest on both edges of the small one
    phi = arm.shaft_angle(np.array([bridging]))[0] + np.array([-0.3, -0.05, -0.01, 0.0, 0.01, 0.05, 0.3, 0.9])
    r = contact(vertices, 8.0, arm, phi, bulges)
    assert r[3] == pytest.approx(np.hypot(*bridging), abs=1e-12)
    assert r == pytest.approx(contact_by_bisection(fine, 8.0, arm, phi), abs=3e-4)


def test_polygons_of_ever_more_edges_converge_on_the_arcs():
    points = roller_points(400, (3, 1, 60.0, {1: 400.0}), 8.0)
    start, bulges = arcs_through(points)
    arm = Arm(60.0, 60.0, TRAILING)
    exact = contact(start, 8.0, arm, PHI, bulges)
    errors = []
    for count in (200, 400, 800):
        contour = Contour.from_bulges(start, bulges).sample(count // 200)
        errors.append(np.abs(contact(contour, 8.0, arm, PHI) - exact).max())
    assert errors[0] > 3.5 * errors[1] > 3.5 * 3.5 * errors[2] > 0


def test_nothing_is_met_far_away():
    r, piece = Search.of(dilated(Contour.from_vertices(circle_points(6)).as_arcs()[0], 2.0), Arm(20.0, 60.0)).first(PHI)
    assert np.isnan(r).all()
    assert (piece == -1).all()


def test_the_piece_met_is_the_one_that_touches():
    points = support_points(80)
    chain, _ = Contour.from_vertices(points).as_arcs()
    obstacle = dilated(chain, 8.0)
    arm = Arm(60.0, 60.0, LEADING)
    r, piece = Search.of(obstacle, arm).first(PHI)
    centre = arm.centre(PHI, arm.position(r))
    _, distance = nearest(chain, centre)
    assert distance == pytest.approx(8.0, abs=1e-12)
    touched = obstacle.take(piece)
    own = np.array([nearest(touched.take(np.array([k])), centre[k : k + 1])[1][0] for k in range(len(PHI))])
    assert own == pytest.approx(0.0, abs=1e-9)


def test_order_and_turns_of_the_angles_do_not_matter():
    points = support_points(50)
    arm = Arm(60.0, 60.0, TRAILING)
    shuffled = np.random.default_rng(7).permutation(len(PHI))
    r = contact(points, 8.0, arm, PHI)
    again = contact(points, 8.0, arm, PHI[shuffled] + 2 * np.pi * np.arange(-20, 20))
    assert again == pytest.approx(r[shuffled], abs=1e-11)
    for start in (1, 17):
        assert contact(np.roll(points, start, axis=0), 8.0, arm, PHI) == pytest.approx(r, abs=1e-12)


@given(st.integers(3, 40), st.integers(0, 2**32 - 1), st.floats(0.05, 1.0))
@settings(max_examples=examples(40), deadline=None)
def test_distances_to_ragged_polygons_against_shapely(count, seed, roughness):
    rng = np.random.default_rng(seed)
    points = circle_points(count) * (20.0 * (1.0 - roughness * rng.random((count, 1)) * 0.9))
    polygon = shapely.Polygon(points)
    chain, _ = Contour.from_vertices(points).as_arcs()
    probes = rng.uniform(-25, 25, (200, 2))
    inside = shapely.contains_xy(polygon, *probes.T)
    expected = shapely.distance(polygon.exterior, shapely.points(probes)) * np.where(inside, -1, 1)
    assert signed_distance(chain, probes) == pytest.approx(expected, abs=1e-9)


def test_distance_to_arcs_in_closed_form():
    """Two half circles of 10 mm about (3, 0), and a probe on every side."""
    chain, _ = Contour.from_bulges(np.array([[13.0, 0], [-7.0, 0]]), np.ones(2)).as_arcs()
    probes = np.random.default_rng(3).uniform(-20, 20, (300, 2))
    assert signed_distance(chain, probes) == pytest.approx(np.hypot(probes[:, 0] - 3, probes[:, 1]) - 10, abs=1e-12)


def test_a_contour_through_the_shaft_and_one_at_the_end_of_the_reach():
    """Pieces at r = 0, where the polar angle is any, and at r = 2 l, where the arm lies stretched out."""
    wedge = np.array([[0.0, 0.0], [40.0, -10.0], [40.0, 10.0]])
    arm = Arm(60.0, 60.0, TRAILING)
    assert contact(wedge, 8.0, arm, FEW) == pytest.approx(contact_by_bisection(wedge, 8.0, arm, FEW), abs=1e-9)
    rim = Contour.from_bulges(112.0 * np.array([[1.0, 0.0], [-1.0, 0.0]]), np.ones(2))
    r, _ = Search.of(dilated(rim.as_arcs()[0], 8.0), arm).first(PHI)
    assert r == pytest.approx(120.0, abs=1e-6)
    assert arm.position(r) == pytest.approx(np.pi, abs=1e-6)
    assert arm.position(np.array([120.0 + 1e-9, 120.0])) == pytest.approx(np.pi, abs=1e-12)


@pytest.mark.parametrize("size", [2e-5, 2e4])
@pytest.mark.parametrize("side", [TRAILING, LEADING])
def test_contact_of_a_cam_of_a_micrometre_and_of_a_kilometre(side, size):
    """Everything scales: no length is compared with one of its own, on a polygon as on arcs."""
    rng = np.random.default_rng(5)
    points = 25.0 * unit(np.arange(23) * 2 * np.pi / 23) + rng.uniform(-0.5, 0.5, (23, 2))
    bulges = rng.uniform(-0.02, 0.1, 23)
    arm, phi = Arm(60.0, 70.0, side), np.linspace(0.0, 2 * np.pi, 500)
    usual = contact(points, 6.0, arm, phi, bulges)
    scaled = contact(size * points, size * 6.0, Arm(size * 60.0, size * 70.0, side), phi, bulges)
    assert np.isfinite(usual).all()
    np.testing.assert_allclose(scaled / size, usual, rtol=1e-11)


@given(length=st.floats(20.0, 3e4), pivot=st.floats(30.0, 200.0), lift=st.floats(0.0, 0.9), count=st.integers(12, 60))
@settings(max_examples=examples(60), deadline=None)
def test_intervals_hold_the_angles_of_all_points(length: float, pivot: float, lift: float, count: int) -> None:
    """Every point of a contour that rises and falls within an arm's reach is met within its piece's interval."""
    arm = Arm(length, pivot)
    least, most = arm.reach()
    t = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    r = 0.5 * (least + most) + lift * 0.5 * (most - least) * np.sin(3.0 * t)
    chain = Contour.from_vertices(np.column_stack([r * np.cos(t), r * np.sin(t)])).as_arcs()[0]
    pieces, _ = shortened(dilated(chain, 1e-3 * (most - least)), arm)
    slack = arm.slack(float(most))
    middle, reach = angles_of(pieces, arm, slack)
    within = within_reach(pieces, arm, slack)
    for share in (0.0, 0.1, 0.37, 0.5, 0.8, 1.0):
        points = pieces.points(share * pieces.length)
        away = np.hypot(*points.T)
        inside = (away > least) & (away < most)
        assert within[inside].all()
        off = np.angle(np.exp(1j * (np.arctan2(points[:, 1], points[:, 0]) - arm.lead(away) - middle)))
        assert (np.abs(off) <= reach + 1e-9)[inside].all()


@pytest.mark.parametrize("length", [60.0, 1e4, 3e4])
def test_pairs_to_search_are_few_with_any_arm(length: float) -> None:
    """Intervals of all pieces together cover the turn a few times over, however many and however long the arm."""
    arm = Arm(length, 80.0)
    t = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)
    r = abs(length - 80.0) + 60.0 + 20.0 * np.cos(t)
    chain = Contour.from_vertices(np.column_stack([r * np.cos(t), r * np.sin(t)])).as_arcs()[0]
    pieces, _ = shortened(dilated(chain, 5.0), arm)
    _, reach = angles_of(pieces, arm, arm.slack(float(r.max())))
    assert 2.0 * reach.sum() < 20.0 * np.pi
