"""What drives a follower train: intended motions and contours by contact, and faults of a contour that make it ring."""

import math

import numpy as np
import pytest
from support import followers
from support.integrated import integrated
from support.programmes import Segment, law, programme

from kin.contour.contour import Contour
from kin.contour.dilated import dilated
from kin.dynamics.drive import drives
from kin.dynamics.excitation import intended_faces, measured_faces
from kin.dynamics.train import Train, steady
from kin.follower.flat import OfFace
from kin.follower.guide import Arm, Line
from kin.follower.roller import DoubleRoller, OfRoller
from kin.follower.support import bearing_of
from kin.law.contacts import LEADING, TRAILING
from kin.law.support_function import lift_constant_breadth, lift_from_fourier, lift_reuleaux
from kin.law.transmission import from_delta

TURN = 2.0 * math.pi
PHI = np.linspace(0.011, 6.27, 97)
PAIR = from_delta(2, 1, 30.0, {1: 252.0}, {})
ROLLERS = from_delta(4, 3, 60.0, {1: 625.0}, {})


def constant_breadth():
    rise = (Segment("rise", math.radians(120.0), 20.0, law("cycloidal")), Segment("dwell", math.radians(60.0)))
    return lift_constant_breadth(40.0, programme(rise, math.pi))


def polygon_of(lift, count):
    """Points of the contour at equal steps of the normal."""
    t = TURN / count * np.arange(count)
    p, slope = lift.derivatives(t, 1)
    x = p * np.cos(t) - slope * np.sin(t), p * np.sin(t) + slope * np.cos(t)
    return Contour.from_vertices(np.stack(x, axis=-1))


def consistent(motion, phi=PHI, step=1e-4):
    """Velocity and acceleration against central differences of the position, fourth order."""
    steps = [motion.rows(phi + k * step) for k in (-2, -1, 0, 1, 2)]
    slope = (steps[0][:2] - 8 * steps[1][:2] + 8 * steps[3][:2] - steps[4][:2]) / (12 * step)
    near = np.abs(np.mod(phi[:, None] - motion.breaks + np.pi, TURN) - np.pi).min(axis=1, initial=np.inf) < 4 * step
    size = np.abs(steps[2]).max(axis=1)[1:, None]
    assert (~near).sum() > 20
    assert np.abs((slope - steps[2][1:]) / size)[:, ~near].max() < 1e-7


def circle_about(x, y, radius, count=12):
    t = TURN / count * np.arange(count)
    points = np.stack([x + radius * np.cos(t), y + radius * np.sin(t)], axis=-1)
    return Contour.from_bulges(points, np.full(count, math.tan(TURN / count / 4.0)))


# --- motions ----------------------------------------------------------------------------------------------------------


def test_derivatives_of_every_motion():
    consistent(intended_faces(followers.flat_face(constant_breadth()), None).lower)
    consistent(intended_faces(followers.double_roller(ROLLERS, 8.0), None).lower)
    consistent(OfFace(bearing_of(polygon_of(lift_from_fourier(25.0, {3: 1.5}, {}), 60))), step=1e-5)
    pair = followers.flat_pair(PAIR)
    contour = Contour.from_vertices(pair.envelope.points(TURN / 80 * np.arange(80)))
    for drive in pair.drives(contour):
        consistent(drive, step=1e-5)
    eccentric = circle_about(3.0, 2.0, 20.0)
    for side in (TRAILING, LEADING):
        consistent(OfRoller(dilated(eccentric.as_arcs()[0], 5.0), Arm(40.0, 50.0, side)))


def test_a_roller_on_an_eccentric_is_a_four_bar():
    """Lean of the arm by the law of cosines, differentiated by hand nowhere: a dense Fourier series stands in."""
    e, radius, arm, pivot = 6.0, 25.0, 40.0, 55.0
    roller = OfRoller(dilated(circle_about(e, 0.0, radius - 5.0).as_arcs()[0], 5.0), Arm(arm, pivot, TRAILING))
    count = 512
    phi = TURN / count * (np.arange(count) + 0.37)
    distance = np.hypot(pivot * np.cos(phi) - e, pivot * np.sin(phi))
    # at the pivot: from the shaft to the centre, and from the centre to the roller
    toward = np.arctan2(e * np.sin(phi), pivot - e * np.cos(phi))
    across = np.arccos((arm**2 + distance**2 - radius**2) / (2.0 * arm * distance))
    lean = across - toward if np.abs(across - toward - roller.rows(phi)[0]).max() < 1e-9 else across + toward
    series, k = np.fft.rfft(lean), np.arange(count // 2 + 1)
    rows = np.stack([np.fft.irfft(series * (1j * k) ** order, count) for order in range(3)])
    got = roller.rows(phi)
    assert got[0] == pytest.approx(rows[0], abs=1e-12)
    assert got[1] == pytest.approx(rows[1], abs=1e-11)
    assert got[2] == pytest.approx(rows[2], abs=1e-9)


@pytest.mark.parametrize("offset", [0.0, 7.0, -7.0])
def test_a_translating_roller_on_an_eccentric_is_a_slider_crank(offset):
    """Its travel in closed form, differentiated by Fourier series; and on a polygon, against differences."""
    e, radius = 6.0, 25.0
    roller = OfRoller(dilated(circle_about(e, 0.0, radius - 5.0).as_arcs()[0], 5.0), Line(offset))
    count = 512
    phi = TURN / count * (np.arange(count) + 0.37)
    # the circle's centre lies e cos phi along the line of travel, and -e sin phi towards its left
    travel = 1e-3 * (e * np.cos(phi) + np.sqrt(radius**2 - (offset + e * np.sin(phi)) ** 2))
    series, k = np.fft.rfft(travel), np.arange(count // 2 + 1)
    got = roller.rows(phi)
    for order, tight in ((0, 1e-15), (1, 1e-13), (2, 1e-11)):
        assert got[order] == pytest.approx(np.fft.irfft(series * (1j * k) ** order, count), abs=tight)
    follower = followers.roller(Line(offset), 5.0, lift_from_fourier(25.0, {2: 1.5}, {}).law)
    polygon = Contour.from_vertices(follower.envelope.points(TURN / 60 * np.arange(60)))
    faces = measured_faces(follower, polygon, None)
    assert faces.upper is None
    consistent(faces.lower, step=1e-5)
    meant = intended_faces(follower, None).lower
    assert faces.lower.rows(PHI)[0] == pytest.approx(meant.rows(PHI)[0], abs=5e-5)
    assert meant.rows(PHI)[0] == pytest.approx(1e-3 * follower.intended(PHI), abs=1e-16)


def test_opposite_rollers_hold_a_frame_from_both_sides():
    lift = lift_from_fourier(40.0, {3: 2.0}, {}, (1.0, 2.0))
    follower = followers.roller_yoke(8.0, lift.law, 80.0)
    contour = Contour.from_vertices(follower.envelope.points(TURN / 300 * np.arange(300)))
    lower, upper = measured_faces(follower, contour, 2e-5)
    assert upper is not None
    consistent(lower, step=1e-5)
    consistent(upper, step=1e-5)
    near, below = followers.resting(follower, contour, PHI)
    assert lower.rows(PHI)[0] == pytest.approx(1e-3 * near, abs=1e-15)
    assert upper.rows(PHI)[0] == pytest.approx(1e-3 * below + 2e-5, abs=1e-15)
    exact = intended_faces(follower, 2e-5)
    assert exact.upper is not None
    assert exact.upper.rows(PHI)[0] - exact.lower.rows(PHI)[0] == pytest.approx(2e-5, abs=1e-15)
    assert follower.moved_by(0.05) == pytest.approx(5e-5)


def test_a_circle_drives_a_face_as_its_closed_form():
    contour = circle_about(4.0, 0.0, 30.0, 7)
    (drive,) = drives([OfFace(bearing_of(contour))])
    train, rpm = Train(0.4, 20.0, 2e5, 150.0), 700.0
    w = rpm * TURN / 60.0
    amplitude = abs((2e5 + 20j * w) * 0.4 * w * w / (2e5 + 20j * w - 0.4 * w * w)) * 4e-3
    force = steady(train, drive, rpm).force
    assert force.greatest == pytest.approx(150.0 + amplitude, rel=1e-9)
    assert force.least == pytest.approx(150.0 - amplitude, rel=1e-9)


def test_arcs_that_are_the_cam_drive_as_intended():
    lift = lift_reuleaux(3, 50.0, 5.0, (3.0, 1.0))
    begin = lift.law.knots[:-1]
    p, slope = lift.derivatives(begin, 1, 1)
    points = p * np.exp(1j * begin) + slope * 1j * np.exp(1j * begin)
    bulges = np.tan(np.diff(lift.law.knots) / 4.0)
    contour = Contour.from_bulges(np.stack([points.real, points.imag], axis=-1), bulges)
    train = Train(0.4, 20.0, 2e6, 300.0)
    found = [
        steady(train, drives([faces.lower])[0], 300.0).force
        for faces in (
            intended_faces(followers.flat_face(lift), None),
            measured_faces(followers.flat_face(lift), contour, None),
        )
    ]
    assert found[1].greatest == pytest.approx(found[0].greatest, rel=1e-9)
    assert found[1].least == pytest.approx(found[0].least, rel=1e-9)


def test_play_is_what_the_contour_leaves_of_it():
    lift = lift_from_fourier(25.0, {3: 1.5}, {}, (4.0, 1.0))
    follower = followers.yoke(lift, 50.0)
    contour = polygon_of(lift, 400)
    lower, upper = measured_faces(follower, contour, 2e-5)
    near, far = contour.support(PHI).q, contour.support(PHI + np.pi).q
    assert upper is not None
    gap = upper.rows(PHI)[0] - lower.rows(PHI)[0]
    assert gap == pytest.approx(1e-3 * (50.0 - near - far) + 2e-5, abs=1e-15)
    exact = intended_faces(follower, 2e-5)
    assert exact.upper is not None
    assert exact.upper.rows(PHI)[0] - exact.lower.rows(PHI)[0] == pytest.approx(2e-5, abs=1e-15)


@pytest.mark.parametrize("follower", [followers.flat_pair(PAIR), followers.double_roller(ROLLERS, 8.0)])
def test_double_followers_are_held_from_below_and_above(follower):
    faces = intended_faces(follower, 1e-3)
    assert faces.upper is not None
    assert faces.upper.rows(PHI)[0] - faces.lower.rows(PHI)[0] == pytest.approx(1e-3, abs=1e-15)
    psi = ROLLERS.psi_of_shaft(PHI, 0)[0] if isinstance(follower, DoubleRoller) else 0.5 * PAIR.psi_of_shaft(PHI, 0)[0]
    assert faces.lower.rows(PHI)[0] == pytest.approx(psi, abs=1e-14)
    assert intended_faces(follower, None).lower.rows(PHI)[0] == pytest.approx(-psi, abs=1e-14)


@pytest.mark.parametrize(
    "follower",
    [
        followers.flat_face(lift_from_fourier(25.0, {2: 1.5}, {})),
        followers.roller(Arm(40.0, 50.0), 5.0, constant_breadth().law),
    ],
)
def test_one_face_has_no_play(follower):
    with pytest.raises(ValueError, match="has no backlash"):
        measured_faces(follower, circle_about(0.0, 0.0, 20.0), 1e-5)


def test_rests_are_the_dwells():
    (one, two) = followers.yoke(constant_breadth(), 100.0).rests
    assert np.degrees(one) == pytest.approx([120.0, 180.0])
    assert np.degrees(two) == pytest.approx([300.0, 360.0])
    assert followers.flat_pair(PAIR).rests == ()


# --- planted faults ---------------------------------------------------------------------------------------------------


def stepped(step):
    """A circle of radius 40 mm about the shaft that stands out by `step` over 80 degrees."""
    t = np.radians([0.0, 40.0, 80.0, 80.0, 150.0, 220.0, 290.0])
    radius = np.array([40.0 + step, 40.0 + step, 40.0 + step, 40.0, 40.0, 40.0, 40.0])
    points = np.stack([radius * np.cos(t), radius * np.sin(t)], axis=-1)
    ends = np.append(points, [[40.0, 0.0]], axis=0)
    turns = np.radians([40.0, 40.0, 0.0, 70.0, 70.0, 70.0, 70.0, 0.0])
    return Contour.from_bulges(ends, np.tan(turns / 4.0))


def test_a_step_of_a_hundredth_rings_on_in_the_dwell_behind_it():
    train, rpm = Train(0.4, 40.0, 2e5, 2000.0), 600.0
    follower = followers.flat_face(lift_from_fourier(40.0, {}, {}))
    rest = (math.radians(100.0), math.radians(340.0))
    residual, forces = [], []
    for contour in (circle_about(0.0, 0.0, 40.0), stepped(0.01), stepped(0.005)):
        (drive,) = drives([measured_faces(follower, contour, None).lower], rest)
        found = steady(train, drive, rpm, [rest])
        residual.append(1e3 * found.residual[0].amplitude)
        forces.append(found.force.greatest - 2000.0)
    assert residual[0] < 1e-10
    assert forces[0] < 1e-7
    assert 0.004 < residual[1] < 0.016
    assert residual[2] < residual[1]
    assert forces[1] > 1.0


@pytest.mark.slow
def test_a_step_rings_as_an_implicit_solver_says():
    pytest.importorskip("scipy")
    train, rpm = Train(0.4, 40.0, 2e5, 2000.0), 600.0
    follower = followers.flat_face(lift_from_fourier(40.0, {}, {}))
    motion = measured_faces(follower, stepped(0.01), None).lower
    (drive,) = drives([motion])
    found = steady(train, drive, rpm)
    places = np.linspace(0.0, TURN, 1500)
    other = integrated(train, (motion, None), rpm, places, found.state, rtol=1e-9, bonded=True)
    assert other.states[0, -1] == pytest.approx(found.state[0], rel=1e-7)
    assert np.abs(other.force.max() - found.force.greatest) < 1e-2 * (found.force.greatest - 2000.0)


def test_flats_of_a_coarse_polygon_shake_the_follower():
    lift = constant_breadth()
    train, rpm = Train(0.4, 20.0, 2e5, 400.0), 600.0
    spread = []
    for count in (24, 96, 384):
        (drive,) = drives([measured_faces(followers.flat_face(lift), polygon_of(lift, count), None).lower])
        spread.append(steady(train, drive, rpm).force)
    exact = steady(train, drives([intended_faces(followers.flat_face(lift), None).lower])[0], rpm).force
    off = [abs(force.greatest - exact.greatest) for force in spread]
    assert off[0] > 5.0 * off[1] > 25.0 * off[2] > 0.0
