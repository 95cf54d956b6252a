"""Worked cases of general disc cams by the judge alone: the exact contour from the follower, and contact on a fit.

What a case prints of curves is held elsewhere; here its points and areas come from the intended motion of each
follower, and a contour of another making moves it within its proved bound.
"""

import math

import numpy as np
import pytest
from support import followers
from support.disc_followers import (
    CURVES,
    FOLLOWERS,
    contour,
    fitted,
    on_arm,
    on_face,
    on_stem,
    raised,
)
from support.discs import AREAS, DEGREE, M02, M07, M15, POINTS, TURN, segments

from camgeo.cams.least_size import least_arm, least_stem
from camgeo.curve.curve import Curve
from camgeo.curve.disc import StraightFace, face_shape
from camgeo.curve.moving_frame import CentreShape, Displacement, Translating
from camgeo.curve.parallel import Parallel
from camgeo.curve.undercut.trim import trimmed
from kin.contour.contour import Contour
from kin.follower import guide
from kin.follower.deviation import deviation
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.law.sources.lobe import lobe
from kin.law.sources.ring import Samples
from kin.law.sources.table import from_table
from kin.law.support_function import Lift, lift_from_fourier

NINE = 1.01e-9
PHI = TURN / 360 * np.arange(360)


def parameter(follower, theta):
    """Parameter of the envelope that is touched at shaft angles theta, by bisection on what the follower tells."""
    low, high = theta - 2.0, theta + 2.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        early = follower.shaft_angle(middle) < theta
        low, high = np.where(early, middle, low), np.where(early, high, middle)
    return 0.5 * (low + high)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", POINTS)
def test_the_exact_contour_of_a_case(name):
    follower = FOLLOWERS[name]
    theta = DEGREE * np.array(list(POINTS[name]), dtype=float)
    found = follower.envelope.points(parameter(follower, theta))
    assert found == pytest.approx(np.array(list(POINTS[name].values())), abs=NINE)
    if name in AREAS:
        assert follower.envelope.area_and_perimeter()[0] == pytest.approx(AREAS[name], abs=NINE)


@pytest.mark.thin(32)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-7])
@pytest.mark.parametrize("name", CURVES)
def test_contact_on_a_fit_keeps_the_intent(name, tolerance):
    holds(FOLLOWERS[name], contour(name, tolerance), tolerance)


def holds(follower, made, tolerance):
    """A contour of another making, within the tolerance, moves the follower within the limit that this implies."""
    found = follower.judge(made, PHI).motion
    assert found.extremes == "true"
    assert found.bound <= follower.motion_limit(tolerance) * (1.0 + 1e-6)
    assert deviation(made, follower.envelope).worst[0] <= tolerance * (1.0 + 1e-6)


def test_d13_matched():
    s = Displacement.of(
        segments((6, 40, 5), (18, 60, "constant-velocity"), (6, 40, 5), (40,), (-30, 120, "polynomial-345"), (60,))
    )
    follower = on_stem(s, 60.0, 0.0, 10.0)
    found = follower.envelope.points(np.array([20.0, 70.0]) * DEGREE)
    assert found == pytest.approx(np.array([[47.657108427, 18.827461984], [20.218549394, 62.081535258]]), abs=NINE)
    holds(follower, fitted(Parallel(CentreShape(s, Translating.on(60.0)), 10.0), 1e-6), 1e-6)


@pytest.mark.slow
def test_d14_valve():
    s = Displacement.of(lobe(8.0, 68 * DEGREE, (2, 8, 14, 20, 26)))
    tappet, roller = on_face(s, 18.0), on_stem(s, 27.0, 0.0, 9.0)
    at = np.array([0.0, 20.0, 45.0]) * DEGREE
    assert roller.envelope.points(at) == pytest.approx(
        np.array([[26.0, 0.0], [24.072694423, 6.706515286], [16.971749157, 12.181623197]]), abs=NINE
    )
    _, rho = tappet.envelope.radii()
    assert rho.min() == pytest.approx(3.816408204, abs=1e-5)  # looked at in 4096 places
    assert rho.max() == pytest.approx(66.003869437, abs=1e-3)
    holds(tappet, fitted(face_shape(StraightFace(s, 18.0)), 1e-6), 1e-6)
    holds(roller, fitted(Parallel(CentreShape(s, Translating.on(27.0)), 9.0), 1e-6), 1e-6)


@pytest.mark.slow
def test_d15_undercut():
    """The trimmed contour loses the lift that is printed, where it is printed; no more of it is lost to the fit."""
    follower = on_stem(M15, 26.0, 0.0, 18.0)
    assert not follower.envelope.regular
    made = fitted(trimmed(Curve.whole(Parallel(CentreShape(M15, Translating.on(26.0)), 18.0))), 1e-8)
    found = follower.judge(made, PHI).motion
    assert found.max == pytest.approx(0.517693640, abs=2e-8)
    assert min(abs(found.at_deg - 45.8265), abs(found.at_deg - 84.1735)) < 1e-2
    lost = followers.resting(follower, made, np.radians([45.8265, 84.1735])) - follower.intended(
        np.radians([45.8265, 84.1735])
    )
    assert lost == pytest.approx([-0.517693640] * 2, abs=2e-8)
    assert deviation(made, follower.envelope).worst[0] < 1e-7


@pytest.mark.slow
def test_d16_sizing():
    """The smallest cams that hold their pressure angles are cams: the limit tells the least angle's cosine."""
    stem = least_stem(M02, 30 * DEGREE, 45 * DEGREE)
    follower = on_stem(M02, stem.prime, stem.offset, 0.0)
    assert follower.motion_limit(1e-9) == pytest.approx(1e-9 / math.cos(45 * DEGREE), rel=1e-4)
    for side in (1, -1):
        sized = least_arm(M07, 65.0, side, 35 * DEGREE, 45 * DEGREE)
        arm = on_arm(M07, sized, 0.0)
        assert arm.motion_limit(1e-9) == pytest.approx(math.degrees(1e-9 / 65.0 / math.cos(45 * DEGREE)), rel=1e-4)
    holds(follower, fitted(CentreShape(M02, stem), 1e-6), 1e-6)


def test_d19_table():
    """A lift read to a micrometre by degrees: its smoothed motion is what a roller is held to."""
    exact = Displacement.of(lobe(8.0, 68 * DEGREE, (2, 8, 14, 20, 26)))
    theta = np.arange(360) * DEGREE
    rows = Samples(theta, np.round(exact.derivatives(theta, 0)[0], 3), np.arange(1, 361))
    smooth = Displacement.of(from_table(rows, 0.001))
    follower = on_stem(smooth, 27.0, 0.0, 9.0)
    (rest,) = follower.rests
    assert np.degrees(rest[1] - rest[0]) > 200.0
    made = fitted(Parallel(CentreShape(smooth, Translating.on(27.0)), 9.0), 1e-5)
    holds(follower, made, 1e-5)
    meant = on_stem(exact, 27.0, 0.0, 9.0).judge(made, PHI).motion
    assert 1e-5 < meant.max < 0.0015


# --- d18: shapes whose motion textbooks give in closed form -----------------------------------------------------------

STILL = raised(Piecewise(np.array([0.0, TURN]), (Constant(0.0),), TURN, smooth_seam=True), 1.0)


def circle(radius, x=0.0, y=0.0):
    return Contour.from_bulges(np.array([[x + radius, y], [x - radius, y]]), np.ones(2))


def test_d18_eccentrics():
    eccentric = circle(30.0, 10.0)
    flat = followers.flat_face(lift_from_fourier(30.0, {1: 10.0}, {}))
    assert followers.resting(flat, eccentric, PHI) == pytest.approx(30.0 + 10.0 * np.cos(PHI), abs=1e-13)
    assert flat.judge(eccentric, PHI).motion.max < 1e-12
    roller = followers.roller(guide.Line(), 12.0, STILL)
    expected = 10.0 * np.cos(PHI) + np.sqrt(42.0**2 - 100.0 * np.sin(PHI) ** 2)
    assert followers.resting(roller, eccentric, PHI) == pytest.approx(expected, abs=1e-12)


def test_d18_tangent_cam_and_arc_flank():
    """Base circle r1 = 20, its flanks tangents: a roller of r2 = 10 stands at (r1 + r2)/cos from the flank's normal."""
    base, wide = 20.0, 45.0 * DEGREE  # the flanks meet at base/cos 45
    x, y = base * math.cos(wide), base * math.sin(wide)
    quarter = math.tan((180 * DEGREE - wide) / 4)
    corners = np.array([[base / math.cos(wide), 0.0], [x, y], [-base, 0.0], [x, -y]])
    tangent = Contour.from_bulges(corners, np.array([0.0, quarter, quarter, 0.0]))
    roller = followers.roller(guide.Line(), 10.0, STILL)
    off = np.radians(np.linspace(-5.0, 18.0, 24))  # of the flank's normal, as long as the flank is touched
    off = off[off >= 0.0]
    assert followers.resting(roller, tangent, wide - off) == pytest.approx(30.0 / np.cos(off), abs=1e-12)
    # the flank an arc of 70 about a point 50 beyond the shaft: the face rises by (70 - r1)(1 - cos)
    x = 50.0
    arc = circle(70.0, -x)
    flank = followers.resting(followers.flat_face(Lift(STILL)), arc, off)
    assert flank == pytest.approx(base + (70.0 - base) * (1.0 - np.cos(off)), abs=1e-12)


def test_d18_harmonic_flat():
    """50 mm harmonic, flat, least radius 25: a circle of 50 about (-25, 0), its face 50 wide."""
    lift = lift_from_fourier(50.0, {1: -25.0}, {})
    follower = followers.flat_face(lift)
    assert follower.judge(circle(50.0, -25.0), PHI).motion.max < 1e-12
    assert np.ptp(lift.derivatives(PHI, 1)[1]) == pytest.approx(50.0, abs=1e-12)
