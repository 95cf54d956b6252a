"""Followers by contact: closed forms, brute force with plain numpy, and limits that hold and are reached."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import followers
from support.camfiles import arcs_through, circle_points, roller_points, support_points
from support.cases import examples, few
from support.programmes import Segment, law, programme

from kin.contour.arcs import unit
from kin.contour.contour import Contour
from kin.follower.guide import Arm
from kin.follower.motion_error import ContactError
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.law.support_function import lift_constant_breadth, lift_from_fourier, lift_hypocycloid, lift_reuleaux
from kin.law.transmission import from_arc, from_delta, from_law

PHI = np.arange(360) * 2 * np.pi / 360
DENSE = np.arange(100_000) * 2 * np.pi / 100_000
SHU_WU = programme(
    [Segment("rise", np.radians(120), 20.0, law("modified-sine")), Segment("dwell", np.radians(60))], np.pi
)
TWO_SEGMENTS = programme(
    [
        Segment("rise", np.radians(15), np.radians(4), law("cycloidal")),
        Segment("dwell", np.radians(10)),
        Segment("return", np.radians(20), np.radians(4), law("cycloidal")),
    ],
    np.radians(45),
)
BOOTH = (2, 1, 60.0, {1: 900.0})
HOLLOW = (4, 3, 60.0, {1: 625.0})


def polygon(points):
    return Contour.from_vertices(points)


def through(envelope, count):
    """Polygon through points of an exact contour."""
    return polygon(envelope.points(np.arange(count) * 2 * np.pi / count))


def reach(points, theta):
    """Support function of a polygon, by looking at every corner."""
    return np.concatenate([(part @ points.T).max(axis=1) for part in np.array_split(unit(theta), 50)])


# --- flat faces -------------------------------------------------------------------------------------------------------


def test_eccentric_circle_lifts_a_flat_face_by_a_cosine():
    """A circle of R = 20 about (5, 0), of two arcs: q = R + 5 cos theta exactly."""
    contour = Contour.from_bulges(np.array([[25.0, 0.0], [-15.0, 0.0]]), np.ones(2))
    face = followers.flat_face(lift_from_fourier(20.0, {1: 5.0}, {}))
    assert followers.resting(face, contour, PHI) == pytest.approx(20.0 + 5.0 * np.cos(PHI), abs=1e-13)
    motion = face.judge(contour, PHI).motion
    assert motion.max < 1e-13
    assert motion.unit == "mm"


def test_wrong_eccentricity_has_a_known_error():
    """Made with 5.1 where 5 is meant, and R too large by 0.02: error 0.02 + 0.1 cos theta."""
    contour = Contour.from_bulges(np.array([[25.12, 0.0], [-14.92, 0.0]]), np.ones(2))
    motion = followers.flat_face(lift_from_fourier(20.0, {1: 5.0}, {})).judge(contour, PHI).motion
    assert motion.max == pytest.approx(0.12, abs=1e-12)
    assert motion.at_deg == pytest.approx(0.0, abs=1e-4)
    assert motion.rms == pytest.approx(np.sqrt(0.02**2 + 0.1**2 / 2), abs=1e-12)
    assert motion.step_deg == 1.0
    # the steepest chord of the cosine over one degree, centred on 90 degrees; the given angles are whole degrees
    chord = 0.1 * (np.cos(np.radians(89.0)) - np.cos(np.radians(90.0)))
    assert motion.increment == pytest.approx(chord, rel=1e-4)


@pytest.mark.parametrize("sides", [3, 4, 7, 31])
def test_regular_polygon_where_the_given_angles_miss_the_worst(sides):
    """Inscribed in a circle: worst error R (1 - cos(pi/n)) at the edges' normals, which no given angle hits."""
    contour = polygon(30.0 * circle_points(sides, offset=0.123))
    motion = followers.flat_face(lift_from_fourier(30.0, {}, {})).judge(contour, PHI[::60]).motion
    assert motion.max == pytest.approx(30.0 * (1 - np.cos(np.pi / sides)), abs=1e-12)
    normals = (np.degrees((np.arange(sides) + 0.623) * 2 * np.pi / sides)) % 360
    assert np.abs(normals - motion.at_deg).min() < 1e-9


@pytest.mark.thin(3)
@pytest.mark.parametrize("share", [0.1, 0.3, 0.5, 0.7])
@pytest.mark.parametrize("count", [3, 7, 40])
@pytest.mark.parametrize("turn", [0.0, -1e-17, 1e-17, 0.4, np.pi / 2])
def test_points_on_straight_edges_change_nothing(count, turn, share):
    angle = turn - np.pi / 2 + 2 * np.pi * (np.arange(count) + 0.5) / count  # with an edge whose normal is about 0
    corners = 10 * unit(angle) + [1.0, 0.5]
    between = corners + share * (np.roll(corners, -1, axis=0) - corners)
    lift = lift_from_fourier(10.0, {}, {}, (0.0, 0.0))
    motion = [
        followers.flat_face(lift).judge(polygon(points), PHI).motion.max
        for points in (corners, np.stack([corners, between], axis=1).reshape(-1, 2))
    ]
    assert motion[1] == pytest.approx(motion[0], abs=1e-11)


def test_extremes_between_the_breaks_are_found():
    """Polygon with corners 0.01 mm outside a circle: the error is greatest at each corner's own direction."""
    contour = polygon(30.01 * circle_points(24, offset=0.37))
    motion = followers.flat_face(lift_from_fourier(30.0, {}, {})).judge(contour, PHI[::90]).motion
    inner = 30.0 - 30.01 * np.cos(np.pi / 24)
    assert motion.max == pytest.approx(max(0.01, inner), abs=1e-12)
    finer = (
        followers.flat_face(lift_from_fourier(30.0, {}, {}))
        .judge(polygon(30.3 * circle_points(24, offset=0.37)), PHI)
        .motion
    )
    assert finer.max == pytest.approx(0.3, abs=1e-12)
    assert (finer.at_deg / 15.0) % 1.0 == pytest.approx(0.37, abs=1e-6)


@given(st.integers(5, 60), st.integers(0, 2**32 - 1), st.floats(1e-4, 0.3))
@settings(max_examples=examples(30), deadline=None)
def test_ragged_polygons_against_every_corner_at_every_angle(count, seed, roughness):
    rng = np.random.default_rng(seed)
    points = support_points(count) * (1.0 + roughness * rng.uniform(-1, 1, (count, 1)))
    lift = lift_from_fourier(25.0, {3: 2.0}, {5: 0.3})
    judged = followers.yoke(lift, 50.0).judge(polygon(points), PHI)
    theta = DENSE[::5]
    q = reach(points, theta)
    error = q - lift.derivatives(theta, 0)[0]
    step = theta[1]
    assert judged.motion.max >= np.abs(error).max() - 1e-11
    assert judged.motion.max <= np.abs(error).max() + 60.0 * step  # slopes stay below 60 mm
    breadth = q + np.roll(q, len(q) // 2)
    assert 50.0 - judged.play.least >= breadth.max() - 1e-11
    assert 50.0 - judged.play.most <= breadth.min() + 1e-11
    assert 50.0 - judged.play.least <= breadth.max() + 120.0 * step
    coarse = reach(points, PHI) - lift.derivatives(PHI, 0)[0]
    assert judged.motion.rms == pytest.approx(np.sqrt(np.mean(coarse**2)), abs=1e-12)
    later = reach(points, PHI + np.radians(1)) - lift.derivatives(PHI + np.radians(1), 0)[0]
    assert judged.motion.increment == pytest.approx(np.abs(later - coarse).max(), abs=1e-12)


def rounded_reuleaux(breadth, rounding):
    """Six arcs about the corners of a triangle, as vertices and bulges; corners on the +x axis and 120 degrees on."""
    side = breadth - 2 * rounding
    corner = side / np.sqrt(3) * circle_points(3)
    # the small arc about corner k spans 60 degrees about the direction 120 k
    ends = [corner[k] + rounding * unit((4 * k + sign) * np.pi / 6) for k in range(3) for sign in (-1, 1)]
    return np.array(ends), np.full(6, np.tan(np.pi / 12))


def test_rounded_reuleaux_of_six_arcs_fills_its_yoke():
    contour = Contour.from_bulges(*rounded_reuleaux(50.0, 5.0))
    yoke = followers.yoke(lift_reuleaux(3, 50.0, 5.0), 50.0)
    judged = yoke.judge(contour, PHI)
    assert judged.motion.max < 1e-13
    assert judged.play.least == pytest.approx(0.0, abs=1e-13)
    assert judged.play.most == pytest.approx(0.0, abs=1e-13)
    by_first, by_second = followers.resting(yoke, contour, PHI)
    assert by_first == pytest.approx(yoke.intended(PHI), abs=1e-13)
    assert by_second == pytest.approx(yoke.intended(PHI), abs=1e-13)


def test_breadth_of_a_square_goes_from_side_to_diagonal():
    contour = polygon(np.array([[20.0, 20], [-20, 20], [-20, -20], [20, -20]]))
    play = followers.yoke(lift_from_fourier(25.0, {}, {}), 50.0).judge(contour, PHI).play
    assert play.least == pytest.approx(50.0 - 40.0 * np.sqrt(2), abs=1e-12)
    assert play.least_at_deg % 90 == pytest.approx(45.0, abs=1e-6)
    assert play.most == pytest.approx(10.0, abs=1e-12)
    assert play.most_at_deg % 90 == pytest.approx(0.0, abs=1e-9)


def test_dwell_flatness_is_the_sagitta_of_the_edges():
    """Shu and Wu's cam as a polygon: in the dwell at 60 mm an edge of 1 degree sags by 60 (1 - cos 0.5 deg)."""
    lift = lift_constant_breadth(40.0, SHU_WU)
    points = followers.flat_face(lift).envelope.points(np.radians(np.arange(360) + 0.2))
    motion = followers.flat_face(lift).judge(polygon(points), PHI).motion
    assert motion.dwell_flatness == pytest.approx(60.0 * (1 - np.cos(np.radians(0.5))), rel=1e-9)
    exact = Contour.from_bulges(*rounded_reuleaux(50.0, 5.0))
    assert followers.flat_face(lift_reuleaux(3, 50.0, 5.0)).judge(exact, PHI).motion.dwell_flatness is None
    circle = followers.flat_face(lift_from_fourier(20.0, {}, {})).judge(polygon(20.0 * circle_points(8)), PHI).motion
    assert circle.dwell_flatness == pytest.approx(20.0 * (1 - np.cos(np.pi / 8)), abs=1e-12)


@pytest.mark.parametrize("count", few([50, 400, 4000], 3))
def test_arcs_through_points_are_far_better_than_edges(count):
    points = support_points(count)
    lift = lift_from_fourier(25.0, {3: 2.0}, {5: 0.3})
    edges = followers.flat_face(lift).judge(polygon(points), PHI).motion.max
    arcs = followers.flat_face(lift).judge(Contour.from_bulges(*arcs_through(points)), PHI).motion.max
    theta = DENSE
    fine = np.abs(reach(points, theta[::20]) - lift.derivatives(theta[::20], 0)[0]).max()
    assert edges >= fine - 1e-11
    assert arcs < 20.0 / count * edges


def test_limits_of_flat_faces_are_the_tolerance_and_twice_it():
    lift = lift_hypocycloid(3, 2.0, 50.0)
    assert followers.flat_face(lift).motion_limit(0.003) == 0.003
    assert followers.yoke(lift, 50.0).motion_limit(0.003) == 0.003
    assert followers.yoke(lift, 50.0).play_limit(0.003) == 0.006


# --- the flat pair ----------------------------------------------------------------------------------------------------


def swings_by_hand(points, transmission, phi):
    """Swing of both faces of a pair on a polygon: the extreme directions in which the pivot sees its corners."""
    pivot = 2 * transmission.arm * unit(phi)
    seen = points[None] - pivot[:, None]
    inward = -unit(phi)[:, None]
    angle = np.arctan2(inward[..., 0] * seen[..., 1] - inward[..., 1] * seen[..., 0], (inward * seen).sum(axis=2))
    a = np.pi / 2 - angle.max(axis=1) - transmission.alpha / 2
    b = -np.pi / 2 - angle.min(axis=1) + transmission.alpha / 2
    return np.stack([a, b])


PAIRS = {
    "ellipse": from_delta(2, 1, 60.0, {1: 900.0}, {}),
    "three": from_delta(3, 1, 60.0, {1: 200.0}, {3: 10.0}),
    "given law": from_law(3, 1, 60.0, programme(
        [
            Segment("rise", np.radians(25), np.radians(2), law("cycloidal")),
            Segment("dwell", np.radians(5)),
            Segment("return", np.radians(30), np.radians(2), law("cycloidal")),
        ],
        np.radians(60),
    )),
}  # fmt: skip


@pytest.mark.thin(9)
@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("count", [9, 100, 2000])
def test_swings_of_a_pair_on_a_polygon_by_hand(name, count):
    pair = followers.flat_pair(PAIRS[name])
    assert pair.envelope.regular
    points = pair.envelope.points(np.arange(count) * 2 * np.pi / count + 0.01)
    contour = polygon(points)
    by_hand = swings_by_hand(points, PAIRS[name], PHI)
    assert followers.resting(pair, contour, PHI) == pytest.approx(by_hand, abs=1e-13)
    judged = pair.judge(contour, PHI)
    fine = DENSE[:: max(1, count // 4)]
    error = np.degrees(swings_by_hand(points, PAIRS[name], fine) - pair.intended(fine))
    play = error[0] - error[1]
    assert judged.motion.max >= np.abs(error).max() - 1e-11
    assert judged.play.least <= play.min() + 1e-11
    assert judged.play.most >= play.max() - 1e-11
    at = np.radians([judged.motion.at_deg, judged.play.most_at_deg])
    there = np.degrees(swings_by_hand(points, PAIRS[name], at) - pair.intended(at))
    assert np.abs(there[:, 0]).max() == pytest.approx(judged.motion.max, rel=1e-6)
    assert there[0, 1] - there[1, 1] == pytest.approx(judged.play.most, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("count", few([600, 1600], 2))
@pytest.mark.parametrize("out", [1e-4, -1e-4])
def test_errors_of_a_pair_are_settled_where_the_curvature_jumps(count, out):
    """The worst error, some 1e-6 rad, is at a break: the normal that is meant lies near, but on its other side."""
    transmission = from_arc(2, 1, 30.0, 47.0)
    pair = followers.flat_pair(transmission)
    t = np.arange(count) * 2 * np.pi / count
    points = pair.envelope.points(t) + out * unit(t)
    judged = pair.judge(polygon(points), PHI)
    phi = np.radians(judged.motion.at_deg + np.append(0.0, np.arange(0.0, 360.0, 0.05)))
    error = np.degrees(np.abs(swings_by_hand(points, transmission, phi) - pair.intended(phi)).max(axis=0))
    assert error[0] == pytest.approx(judged.motion.max, abs=1e-11)
    assert error.max() <= judged.motion.max + 1e-11


def test_an_ellipse_works_a_right_angled_pair():
    """Semi-axes a, b with a^2 + b^2 = (2 l)^2: its orthoptic circle is the pivot's; r^2 = 2 (l^2 + m^2 cos 2t)."""
    transmission = PAIRS["ellipse"]
    a, b = np.sqrt(2 * (60.0**2 + 900.0)), np.sqrt(2 * (60.0**2 - 900.0))
    assert np.hypot(a, b) == pytest.approx(120.0, abs=1e-12)
    t = np.arange(4000) * 2 * np.pi / 4000
    contour = Contour.from_bulges(*arcs_through(np.column_stack([a * np.cos(t), b * np.sin(t)])))
    judged = followers.flat_pair(transmission).judge(contour, PHI)
    assert judged.motion.max < 5e-8
    assert max(-judged.play.least, judged.play.most) < 5e-8


def test_a_contour_that_reaches_the_pivot_is_refused():
    with pytest.raises(ContactError, match="the contour reaches the pivot at"):
        followers.flat_pair(PAIRS["three"]).judge(polygon(130.0 * circle_points(12)), PHI)


def test_dwell_of_a_pair():
    pair = followers.flat_pair(PAIRS["given law"])
    contour = through(pair.envelope, 3000)
    flatness = pair.judge(contour, PHI).motion.dwell_flatness
    assert 0.0 < flatness < 2 * pair.judge(contour, PHI).motion.max
    assert followers.flat_pair(PAIRS["three"]).judge(contour, PHI).motion.dwell_flatness is None


# --- rollers ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("arm", "pivot"), [(60.0, 60.0), (50.0, 75.0)])
def test_roller_on_an_eccentric_circle(arm, pivot):
    """Circle of R = 30 about (4, 0); pivot, circle centre and roller centre make a triangle of known sides."""
    contour = Contour.from_bulges(np.array([[34.0, 0.0], [-26.0, 0.0]]), np.ones(2))
    flat = Piecewise(np.array([0.0, 2 * np.pi]), (Constant(1.0),), 2 * np.pi, smooth_seam=True)
    roller = followers.roller(Arm(arm, pivot), 8.0, flat)
    away = pivot - 4.0 * np.exp(-1j * PHI)  # from the circle's centre to the pivot, the pivot's direction made real
    expected = np.arccos((np.abs(away) ** 2 + arm**2 - 38.0**2) / (2 * np.abs(away) * arm)) + np.angle(away)
    assert followers.resting(roller, contour, PHI) == pytest.approx(expected, abs=1e-12)
    motion = roller.judge(contour, PHI).motion
    assert motion.max >= np.degrees(np.abs(expected - 1.0)).max() - 1e-9
    assert motion.rms == pytest.approx(np.degrees(np.sqrt(np.mean((expected - 1.0) ** 2))), abs=1e-10)


def test_roller_on_its_own_envelope():
    """The exact contour of a law over the shaft angle, by another arm than W's: it moves as the law says."""
    rise = programme(
        [
            Segment("rise", np.radians(120), np.radians(15), law("cycloidal")),
            Segment("dwell", np.radians(60)),
            Segment("return", np.radians(180), np.radians(15), law("cycloidal")),
        ],
        2 * np.pi,
    )
    motion = rise.motion
    functions = tuple(raised(f, np.radians(30)) for f in motion.functions)
    roller = followers.roller(Arm(50.0, 75.0), 8.0, Piecewise(motion.knots, functions, 2 * np.pi))
    assert roller.envelope.regular
    contour = through(roller.envelope, 20_000)
    judged = roller.judge(contour, PHI)
    assert judged.play is None
    assert judged.motion.max < 1e-5
    assert roller.intended(np.array([0.0, np.pi * 0.8])) == pytest.approx(np.radians([30.0, 45.0]), abs=1e-14)


def raised(function, offset):
    from kin.law.segment import AffineStretch

    return AffineStretch(function, offset)


DOUBLES = {
    "Booth": (from_delta(2, 1, 60.0, {1: 900.0}, {}), BOOTH),
    "hollow": (from_delta(4, 3, 60.0, {1: 625.0}, {}), HOLLOW),
    "arc": (from_arc(3, 1, 60.0, 70.0, "convex"), None),
    "given law": (from_law(4, 1, 60.0, TWO_SEGMENTS), None),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", few(DOUBLES, 2))
def test_double_roller_follows_ever_finer_polygons_ever_better(name):
    transmission, formula = DOUBLES[name]
    follower = followers.double_roller(transmission, 8.0)
    errors = []
    for count in (500, 1000, 2000):
        contour = polygon(roller_points(count, formula, 8.0)) if formula else through(follower.envelope, count)
        judged = follower.judge(contour, PHI)
        errors.append(judged.motion.max)
        chord = np.hypot(*(contour.end - contour.start).T).max()
        assert judged.motion.max <= follower.motion_limit(chord**2 / 8 / 3.0)
        assert max(-judged.play.least, judged.play.most) <= follower.play_limit(chord**2 / 8 / 3.0)
    assert errors[0] > 3 * errors[1] > 9 * errors[2] > 0


def test_swing_and_both_contacts_on_a_circle():
    """Concentric circle: both arms lean alike, psi by A and by B are opposite; too large by d: known interference."""
    transmission = from_delta(3, 1, 60.0, {}, {})  # psi = 0: a pitch circle of 2 l cos(alpha/2) = 60 sqrt 3
    follower = followers.double_roller(transmission, 8.0)
    pitch = 60.0 * np.sqrt(3.0)
    exact = Contour.from_bulges((pitch - 8.0) * np.array([[1.0, 0], [-1, 0]]), np.ones(2))
    judged = follower.judge(exact, PHI)
    assert judged.motion.max < 1e-12
    assert max(abs(judged.play.least), abs(judged.play.most)) < 1e-12
    larger = Contour.from_bulges((pitch - 7.9) * np.array([[1.0, 0], [-1, 0]]), np.ones(2))
    psi = 2 * np.arccos((pitch + 0.1) / 120.0) - np.pi / 3
    by_a, by_b = followers.resting(follower, larger, PHI)
    assert by_a == pytest.approx(psi, abs=1e-13)
    assert by_b == pytest.approx(-psi, abs=1e-13)
    judged = follower.judge(larger, PHI)
    assert judged.motion.max == pytest.approx(np.degrees(abs(psi)), abs=1e-11)
    # A is pushed out by psi, B pulled in by as much: its centre stands at 2 l cos((alpha - psi)/2)
    second = 120.0 * np.cos((np.pi / 3 - psi) / 2)
    assert judged.play.least == pytest.approx(second - (pitch - 7.9) - 8.0, abs=1e-12)


def test_dwell_of_a_double_roller():
    follower = followers.double_roller(DOUBLES["given law"][0], 8.0)
    motion = follower.judge(through(follower.envelope, 3000), PHI).motion
    assert 0.0 < motion.dwell_flatness < 2 * motion.max


def test_a_roller_that_meets_nothing():
    follower = followers.double_roller(DOUBLES["Booth"][0], 8.0)
    with pytest.raises(ContactError, match="the roller does not touch the contour at 0 degrees"):
        follower.judge(polygon(circle_points(8) + np.array([200.0, 0.0])), PHI)


@pytest.mark.slow
@pytest.mark.parametrize("name", few(DOUBLES, 4, first=1))
def test_limits_hold_and_are_reached_by_the_parallel_contours(name):
    """The exact contour moved outward and inward by e all round is the worst that e allows."""
    transmission, _ = DOUBLES[name]
    e = 0.05
    follower = followers.double_roller(transmission, 8.0)
    limit, play = follower.motion_limit(e), follower.play_limit(e)
    worst, gap = 0.0, 0.0
    for offset in (e, -e):
        contour = through(followers.double_roller(transmission, 8.0 - offset).envelope, 6000)
        judged = follower.judge(contour, PHI)
        worst = max(worst, judged.motion.max)
        gap = max(gap, -judged.play.least, judged.play.most)
    assert 0.99 * limit < worst < 1.001 * limit
    assert 0.95 * play < gap < 1.001 * play


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", PAIRS)
def test_limits_of_a_pair_hold_and_are_reached(name):
    e = 0.05
    pair = followers.flat_pair(PAIRS[name])
    tau = np.arange(6000) * 2 * np.pi / 6000
    exact, normal = pair.envelope.points(tau), unit(PAIRS[name].pitch(tau, 0)[1][0])
    worst, gap = 0.0, 0.0
    for offset in (e, -e):
        judged = pair.judge(polygon(exact + offset * normal), PHI)
        worst = max(worst, judged.motion.max)
        gap = max(gap, -judged.play.least, judged.play.most)
    assert 0.99 * pair.motion_limit(e) < worst < 1.001 * pair.motion_limit(e)
    assert 0.95 * pair.play_limit(e) < gap < 1.001 * pair.play_limit(e)


@pytest.mark.slow
def test_the_start_vertex_and_the_sense_of_writing_do_not_matter():
    points = roller_points(300, HOLLOW, 8.0)
    follower = followers.double_roller(DOUBLES["hollow"][0], 8.0)
    first = follower.judge(polygon(points), PHI)
    for start in (1, 150, 299):
        again = follower.judge(polygon(np.roll(points, start, axis=0)), PHI)
        assert again.motion.max == pytest.approx(first.motion.max, abs=1e-11)
        assert again.play.least == pytest.approx(first.play.least, abs=1e-11)


@given(st.integers(4, 30), st.integers(0, 2**32 - 1))
@settings(max_examples=examples(12), deadline=None)
def test_arcs_of_either_sense_under_a_flat_face_against_dense_points(count, seed):
    """Ragged contours of arcs, hollow ones among them: hull corners, arcs and lines that touch twice take turns."""
    rng = np.random.default_rng(seed)
    points = 25.0 * circle_points(count) * (1.0 + 0.1 * rng.uniform(-1, 1, (count, 1)))
    contour = Contour.from_bulges(points, rng.uniform(-0.1, 0.3, count))
    lift = lift_from_fourier(25.0, {3: 2.0}, {5: 0.3})
    motion = followers.flat_face(lift).judge(contour, PHI).motion
    theta = DENSE[::50]
    error = reach(contour.sample(400), theta) - lift.derivatives(theta, 0)[0]
    sag = (25.0 * 0.3 * 4 * np.pi / count / 400) ** 2
    assert motion.max >= np.abs(error).max() - 1e-11 - sag
    assert motion.max <= np.abs(error).max() + 80.0 * theta[1]
    assert motion.rms == pytest.approx(
        np.sqrt(np.mean((reach(contour.sample(400), PHI) - lift.derivatives(PHI, 0)[0]) ** 2)), abs=2e-3
    )
