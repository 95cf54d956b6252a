"""Contacts of disc followers against brute force, what is proved of them, their limits and what drives a train."""

import numpy as np
import pytest
import shapely
from support import followers
from support.brute_disc import peak
from support.camfiles import arcs_through
from support.cases import few
from support.disc_followers import FOLLOWERS, contour, fitted, on_arm, on_stem
from support.discs import M02, M07, M15, displaced

from camgeo.curve.backwards import least_hollow
from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Curve
from camgeo.curve.moving_frame import CentreShape, Oscillating
from camgeo.curve.moving_frame import Translating as Stem
from camgeo.curve.parallel import Parallel
from kin.contour.contour import Contour
from kin.follower.deviation import deviation
from kin.follower.guide import Arm, Line
from kin.follower.motion_error import ContactError
from kin.law.contacts import LEADING, METRE, TRAILING
from kin.law.piecewise import Piecewise
from kin.law.segment import Constant
from kin.law.support_function import lift_from_fourier

TURN = 2.0 * np.pi
PHI = TURN / 90 * np.arange(90) + 0.01
STILL = Piecewise(np.array([0.0, TURN]), (Constant(1.0),), TURN, smooth_seam=True)
SEEDS = few(range(12), 4)


def unit(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def ragged(seed, mean=40.0, count=40, rough=0.15):
    """A star-shaped polygon about the shaft, hollows and all."""
    rng = np.random.default_rng(seed)
    r = mean * (1.0 + rough * rng.uniform(-1.0, 1.0, count) * rng.uniform(0.2, 1.0))
    return r[:, None] * unit(TURN / count * np.arange(count))


def law(seed, mean, size):
    """A random motion of three harmonics."""
    rng = np.random.default_rng(seed)
    terms = {k: tuple(size / k**2 * rng.uniform(-1.0, 1.0, 2)) for k in (1, 2, 3)}
    return lift_from_fourier(mean, {k: a for k, (a, _) in terms.items()}, {k: b for k, (_, b) in terms.items()})


def bisected(free, clear, stopped):
    """Position (n,) at which `free` changes between positions that are clear and that are not, (n,) each."""
    for _ in range(60):
        middle = 0.5 * (clear + stopped)
        here = free(middle)
        clear, stopped = np.where(here, middle, clear), np.where(here, stopped, middle)
    return 0.5 * (clear + stopped)


def first_stop(free, start, end, steps=1200):
    """First position (n,) on the way from start to end that is not free."""
    way = start + (end - start) / steps * np.arange(steps + 1)[:, None] * np.ones(len(PHI))
    stopped = ~np.stack([free(row) for row in way])
    assert stopped.any(axis=0).all()
    first = stopped.argmax(axis=0)
    assert (first > 0).all()
    at = np.arange(len(PHI))
    return bisected(free, way[first - 1, at], way[first, at])


def roller_free(points, guide, radius, inside):
    """Whether a roller clears a polygon's metal: brute force by shapely's distances."""
    polygon = shapely.Polygon(points)

    def free(position):
        centre = shapely.points(guide.centre(PHI, position))
        apart = shapely.distance(polygon.exterior, centre)
        within = shapely.contains(polygon, centre)
        return (within if inside else ~within) & (apart >= radius)

    return free


GUIDES = {
    "in line": (Line(), 0.0, 90.0),
    "offset": (Line(9.0), 0.0, 90.0),
    "trailing": (Arm(65.0, 80.0, TRAILING), 0.0, 1.4),
    "leading": (Arm(65.0, 80.0, LEADING), 0.0, 1.4),
}


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("name", GUIDES)
def test_ring_contact_is_the_first_touch_on_the_way_out(name, seed):
    guide, start, end = GUIDES[name]
    points = ragged(seed, mean=60.0)
    for radius in (0.0, 4.0, 25.0):
        found = followers.resting(followers.roller(guide, radius, STILL, side=-1), Contour.from_vertices(points), PHI)
        expected = first_stop(roller_free(points, guide, radius, inside=True), start, end)
        assert found == pytest.approx(expected, abs=1e-6 if radius else 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", GUIDES)
def test_knife_edge_and_shoe_contact_on_the_way_in(name, seed):
    guide, start, end = GUIDES[name]
    points = ragged(seed)
    found = followers.resting(followers.roller(guide, 0.0, STILL), Contour.from_vertices(points), PHI)
    expected = first_stop(roller_free(points, guide, 0.0, inside=False), end, start)
    assert found == pytest.approx(expected, abs=1e-9)
    if isinstance(guide, Line):
        shoe = followers.resting(followers.roller(guide, 600.0, STILL), Contour.from_vertices(points), PHI)
        share = np.arange(400)[:, None, None] / 400
        edges = (points + share * (np.roll(points, -1, axis=0) - points)).reshape(-1, 2)
        along, across = edges @ unit(PHI).T, edges @ unit(PHI + 0.5 * np.pi).T - guide.offset
        assert shoe == pytest.approx((along + np.sqrt(600.0**2 - across**2)).max(axis=0), abs=1e-6)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("tilt", [-0.4, 0.15])
def test_tilted_face_contact_is_that_of_the_farthest_corner(tilt, seed):
    points = ragged(seed)
    found = followers.resting(followers.flat_face(law(seed, 40.0, 3.0), tilt), Contour.from_vertices(points), PHI)
    normal, travel = unit(PHI + tilt), unit(PHI)
    # the face's line through each corner meets the line of travel at
    reached = (points @ normal.T) / (travel * normal).sum(axis=1)
    assert found == pytest.approx(reached.max(axis=0), abs=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("side", [TRAILING, LEADING])
@pytest.mark.parametrize("offset", [10.0, -8.0])
def test_swinging_face_contact_by_bisection(side, offset, seed):
    points = ragged(seed, rough=0.08)
    face = followers.swinging_face(100.0, offset, law(seed, 0.5, 0.05).law, side)
    found = followers.resting(face, Contour.from_vertices(points), PHI)

    pivot = 100.0 * unit(PHI)

    def free(psi):
        """Whether no corner lies beyond the face, `offset` nearer the shaft than its parallel through the pivot."""
        along = -unit(PHI + side * psi)
        outward = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        outward *= np.sign((outward * pivot).sum(axis=1))[:, None]
        return (outward * pivot).sum(axis=1) - offset >= (points @ outward.T).max(axis=0)

    expected = bisected(free, np.full(len(PHI), 1.2), np.full(len(PHI), 0.02))
    assert found == pytest.approx(expected, abs=1e-12)


# --- what is proved ---------------------------------------------------------------------------------------------------


def spoilt(follower, seed, count=160, size=2e-3):
    """Points near the exact contour, each off by itself."""
    rng = np.random.default_rng(seed)
    tau = TURN / count * np.arange(count)
    points = follower.envelope.points(tau)
    return points + size * rng.uniform(-1.0, 1.0, points.shape)


@pytest.mark.thin(8)
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", [name for name in FOLLOWERS if name != "shoe, trailing arm"])
def test_the_greatest_error_is_proved_over_all_angles(name, seed):
    follower = FOLLOWERS[name]
    points = spoilt(follower, seed)
    made = Contour.from_vertices(points) if seed % 2 else Contour.from_bulges(*arcs_through(points))
    judged = follower.judge(made, PHI).motion
    scale = 180.0 / np.pi if follower.unit == "deg" else 1.0
    seen = scale * peak(lambda phi: followers.resting(follower, made, phi) - follower.intended(phi), 20_000)
    assert judged.extremes == "true"
    assert seen <= judged.bound * (1.0 + 1e-9)
    assert seen >= judged.max * (1.0 - 1e-5)
    assert judged.remainder <= 2e-6 * judged.max
    at = np.array([np.radians(judged.at_deg)])
    there = scale * np.abs(followers.resting(follower, made, at) - follower.intended(at))[0]
    assert there == pytest.approx(judged.max, rel=1e-6)


@pytest.mark.thin(8)
@pytest.mark.parametrize("distance", [1e-3, -1e-3])
@pytest.mark.parametrize("name", FOLLOWERS)
def test_the_limit_holds_on_parallel_contours_and_is_sharp(name, distance):
    follower = FOLLOWERS[name]
    tau = TURN / 6000 * np.arange(6000)
    made = Contour.from_bulges(*arcs_through(follower.envelope.inset(distance).points(tau)))
    error = follower.judge(made, PHI).motion.max
    limit = follower.motion_limit(1e-3)
    assert error <= limit * (1.0 + 2e-5)
    assert error >= limit * (1.0 - 2e-3)
    found = deviation(made, follower.envelope)
    assert found.worst[0] == pytest.approx(1e-3, rel=1e-4)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", FOLLOWERS)
def test_dwells_are_told_and_how_flat_they_are(name):
    follower = FOLLOWERS[name]
    judged = follower.judge(contour(name), PHI).motion
    assert (judged.dwell_flatness is None) == (name == "knife edge")
    if judged.dwell_flatness is not None:  # a dwell is a circle about the shaft, which a file of arcs holds
        assert judged.dwell_flatness < 1e-12


@pytest.mark.parametrize("radius", [1e3, 1e4, 1e5, 1e6])
def test_a_shoe_as_flat_as_a_face_is_judged_like_one(radius):
    """A large shoe's contour is still told from the exact one, though its pitch curve is far away."""
    face = lift_from_fourier(radius + 40.0, {2: 1.5}, {3: 0.2})
    shoe = followers.roller(Line(), radius, face.law)
    tau = TURN / 2000 * np.arange(2000)
    made = Contour.from_bulges(*arcs_through(shoe.envelope.points(tau)))
    assert shoe.judge(made, PHI).motion.max < 1e-6
    assert deviation(made, shoe.envelope).worst[0] < 1e-6


# --- refused ----------------------------------------------------------------------------------------------------------


def test_a_face_whose_contact_reaches_the_pivot_is_told():
    face = followers.swinging_face(100.0, 10.0, law(1, 0.5, 0.05).law)
    with pytest.raises(ContactError, match="reaches the pivot"):
        followers.resting(face, Contour.from_vertices(ragged(2, mean=95.0)), PHI)
    steep = followers.swinging_face(40.0, 2.0, lift_from_fourier(1.4, {1: 0.2}, {}).law)
    with pytest.raises(ContactError, match="intended contact reaches the pivot"):
        steep.motion_limit(1e-3)


# --- drives -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", few(FOLLOWERS, 8))
def test_what_drives_a_train_is_the_contact_and_its_derivatives(name):
    follower = FOLLOWERS[name]
    points = spoilt(follower, 1, count=60)
    made = Contour.from_bulges(*arcs_through(points))
    (drive,), (one,) = follower.drives(made), follower.contacts
    far = PHI[np.abs(np.subtract.outer(PHI, np.concatenate([drive.breaks, drive.breaks - TURN]))).min(axis=1) > 2e-4]
    rows = drive.rows(far)
    si = METRE if follower.unit == "mm" else 1.0
    assert one.position(rows[0] / si) == pytest.approx(followers.resting(follower, made, far), abs=1e-11)
    step = 1e-4
    for k in range(2):
        slope = (drive.rows(far + step)[k] - drive.rows(far - step)[k]) / (2.0 * step)
        assert slope == pytest.approx(rows[k + 1], rel=1e-5, abs=1e-6 * np.abs(rows[k + 1]).max())


# --- at the edge ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("offset", [43.0, -44.0, 44.9])
def test_an_eccentricity_near_the_prime_radius_is_proved(offset):
    made = fitted(Parallel(CentreShape(M02, Stem.on(45.0, offset)), 9.0), 1e-5)
    proved(on_stem(M02, 45.0, offset, 9.0), made, 1e-5)


@pytest.mark.thin(2)
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("prime", [17.0, 15.2])
def test_an_arm_that_comes_near_to_pointing_at_the_shaft_is_proved(prime, side):
    sized = Oscillating.on(prime, 80.0, 65.0, side)
    assert np.degrees(sized.rest) < 7.0
    proved(on_arm(M07, sized, 3.0), fitted(Parallel(CentreShape(M07, sized), 3.0), 1e-5), 1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("side", [1, -1])
def test_a_pivot_inside_the_disc_and_an_arm_stretched_out(side):
    inside = Oscillating.on(42.0, 30.0, 65.0, side)
    proved(on_arm(M07, inside, 8.0), fitted(Parallel(CentreShape(M07, inside), 8.0), 1e-5), 1e-5)
    stretched = Oscillating(80.0, 65.0, np.radians(158.9), side)
    proved(on_arm(M07, stretched, 3.0), fitted(Parallel(CentreShape(M07, stretched), 3.0), 1e-5), 1e-5)


@pytest.mark.thin(2)
@pytest.mark.parametrize("gap", [1e-3, 1e-9])
def test_a_roller_a_hair_above_undercut(gap):
    shape = CentreShape(M15, Stem.on(26.0))
    radius = least_radius(Curve.whole(shape))[0] - gap
    proved(on_stem(M15, 26.0, 0.0, radius), fitted(Parallel(shape, radius), 1e-5), 1e-5)
    hollow = displaced((20, 40, "cycloidal"), (10,), (-20, 40, "cycloidal"), (270,))
    shape = CentreShape(hollow, Stem.on(50.0))
    radius = least_hollow(Curve.whole(shape))[0] - gap
    ring = on_stem(hollow, 50.0, 0.0, radius, side=-1)
    proved(ring, fitted(Parallel(shape, -radius), 1e-5), 1e-5)


def proved(follower, made, tolerance):
    motion = follower.judge(made, PHI).motion
    assert motion.extremes == "true"
    assert motion.bound <= follower.motion_limit(tolerance) * (1.0 + 1e-3)
    assert deviation(made, follower.envelope).worst[0] <= tolerance


@pytest.mark.thin(4)
@pytest.mark.parametrize("width", [1.0, 0.1, 0.01])
def test_a_rise_of_a_hundredth_of_a_degree_is_measured_as_any_other(width):
    """A wall almost along the line of travel: contact is found everywhere, limit and deviation are still right."""
    steep = displaced((20, width, "cycloidal"), (10,), (-20, width, "cycloidal"), (350 - 2 * width,))
    shape = CentreShape(steep, Stem.on(30.0))
    follower, made = on_stem(steep, 30.0, 0.0, 0.0), fitted(shape, 1e-5)
    u = TURN * np.linspace(0.0, 1.0, 10_001)
    slope = 20.0 / np.radians(width) * (1.0 - np.cos(u)) / (30.0 + 20.0 / TURN * (u - np.sin(u)))
    assert follower.motion_limit(1e-9) == pytest.approx(1e-9 * np.hypot(1.0, slope).max(), rel=2e-3)
    assert follower.judge(made, PHI).motion.max < 1.01 * follower.motion_limit(1e-5)
    found = deviation(made, follower.envelope)
    dense = np.radians(width * np.linspace(0.0, 1.0, 20_001))
    apart = np.abs(made.distance(shape.sample(dense).point)).max()
    assert apart <= found.worst[0] * (1.0 + 1e-6)
    assert found.worst[0] <= 1e-5
