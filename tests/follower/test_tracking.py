"""Greatest motion error of rollers: over all shaft angles, against brute force of another kind than the code's."""

from typing import Any

import numpy as np
import pytest
from support import followers
from support.brute_disc import peak
from support.camfiles import arcs_through, write_dxf
from support.cases import few
from support.intent import part_of
from support.programmes import Segment, law, programme

import kin.follower.roller
from kin.contour.arcs import unit
from kin.contour.contour import Contour
from kin.follower.guide import Arm, Line
from kin.follower.laws import ByLaw, Swing
from kin.follower.tracking import bounds_of_error
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.law.contacts import LEADING, TRAILING
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Constant
from kin.law.support_function import lift_from_fourier
from kin.law.transmission import from_delta, from_law
from kin.numeric.errors import UnsettledError

PHI = np.arange(360) * 2 * np.pi / 360


def through(envelope, count, arcs=False):
    """Polygon, or chain of arcs of alternate curvature, through points of an exact contour."""
    points = envelope.points(np.arange(count) * 2 * np.pi / count)
    return Contour.from_bulges(*arcs_through(points)) if arcs else Contour.from_vertices(points)


def distance(points, contour):
    """Distance of points (n, 2) from a polygon: every edge by itself."""
    start = contour.vertices
    edge = np.roll(start, -1, axis=0) - start
    gap = points[:, None] - start[None]
    share = np.clip(np.einsum("nmc,mc->nm", gap, edge) / np.einsum("mc,mc->m", edge, edge), 0.0, 1.0)
    away = gap - share[:, :, None] * edge
    return np.sqrt(np.einsum("nmc,nmc->nm", away, away).min(axis=1))


def positions(contour, roller, phi, about, reach):
    """Positions of a roller on a polygon, by bisection of its distance between `about` -+ `reach` (n,)."""
    guide, radius = roller.guides[0], roller.radius
    low, high = about - reach, about + reach
    assert (distance(guide.centre(phi, high), contour) > radius).all()
    for _ in range(40):
        middle = 0.5 * (low + high)
        free = distance(guide.centre(phi, middle), contour) > radius
        low, high = np.where(free, low, middle), np.where(free, middle, high)
    return 0.5 * (low + high)


def rising(stroke, base, names=("cycloidal", "polynomial-345")):
    """A law over the turn from `base` on: rise, dwell, return, dwell."""
    found = programme(
        [
            Segment("rise", np.radians(110), stroke, law(names[0])),
            Segment("dwell", np.radians(60)),
            Segment("return", np.radians(130), stroke, law(names[1])),
            Segment("dwell", np.radians(60)),
        ],
        2 * np.pi,
    ).motion
    return Piecewise(found.knots, tuple(AffineStretch(f, base) for f in found.functions), 2 * np.pi)


def proved(motion, reached, scale):
    """The bound is above what brute force reaches, and hardly."""
    assert motion.extremes == "true"
    assert scale * reached <= motion.bound * (1 + 1e-9)
    assert motion.bound <= (1 + 1e-5) * scale * reached
    assert motion.max == pytest.approx(scale * reached, rel=1e-6)


GUIDES: dict[str, tuple[Any, float, float]] = {
    "trailing arm": (Arm(50.0, 75.0, TRAILING), 0.5, np.radians(15.0)),
    "leading arm": (Arm(60.0, 60.0, LEADING), 0.8, np.radians(12.0)),
    "line of travel": (Line(0.0), 35.0, 8.0),
    "line of travel, offset": (Line(7.0), 35.0, 8.0),
    "line of travel, offset to the other side": (Line(-7.0), 35.0, 8.0),
}


@pytest.mark.slow
@pytest.mark.parametrize("count", few([60, 140]))
@pytest.mark.parametrize("name", GUIDES)
def test_single_rollers_on_polygons_against_bisected_distances(name, count):
    guide, base, stroke = GUIDES[name]
    roller = followers.roller(guide, 8.0, rising(stroke, base))
    assert roller.envelope.regular
    contour = through(roller.envelope, count)
    motion = roller.judge(contour, PHI).motion
    reach = 0.2 * stroke

    def error(phi):
        meant = roller.intended(phi)
        return positions(contour, roller, phi, meant, reach) - meant

    some = PHI[::7] + 0.003
    assert followers.resting(roller, contour, some) - roller.intended(some) == pytest.approx(error(some), abs=1e-9)
    assert motion.unit == ("mm" if isinstance(guide, Line) else "deg")
    proved(motion, peak(error, 3000), 1.0 if motion.unit == "mm" else 180 / np.pi)


@pytest.mark.parametrize("name", GUIDES)
def test_what_a_guide_tells_of_its_derivatives(name):
    """position' = 2 a/S and phi' = (c + 2 a m/S)/u along a line, against differences; S^2 and m with their slopes."""
    guide, base, _ = GUIDES[name]
    start, along, h = guide.centre(np.array([0.7]), np.array([base])), unit(np.array([1.9])), 1e-4
    points = start + np.array([[-h], [0.0], [h]]) * along
    r = np.hypot(*points.T)
    place, phi = guide.position(r), guide.shaft_angle(points)
    a, c, u = points[1] @ along[0], points[1, 0] * along[0, 1] - points[1, 1] * along[0, 0], r[1:2] ** 2
    size, m = np.sqrt(guide.square(u)), guide.moment(u)
    assert (place[2] - place[0]) / (2 * h) == pytest.approx((2 * a / size)[0], rel=1e-7)
    assert (phi[2] - phi[0]) / (2 * h) == pytest.approx(((c + 2 * a * m / size) / u)[0], rel=1e-7)
    d = 1e-3 * u
    assert (guide.square(u + d) - guide.square(u - d)) / (2 * d) == pytest.approx(guide.square_slope(u), rel=1e-9)
    assert (guide.square_slope(u + d) - guide.square_slope(u - d)) / (2 * d) == pytest.approx(guide.square_bend)
    assert (guide.moment(u + d) - guide.moment(u - d)) / (2 * d) == pytest.approx(guide.moment_slope)
    assert np.arctan2(points[:, 1], points[:, 0]) - phi == pytest.approx(guide.lead(r), abs=1e-12)


def dense(follower, contour, count):
    return peak(lambda phi: followers.resting(follower, contour, phi) - follower.intended(phi), count)


NAMES = ["cycloidal", "polynomial-345", "polynomial-4567", "modified-sine", "harmonic"]


@pytest.mark.thin(16)
@pytest.mark.parametrize("seed", range(8))
def test_random_double_rollers_against_dense_contacts(seed):
    rng = np.random.default_rng(seed)
    lam, mu = [(3, 1), (4, 1), (4, 3), (5, 3), (2, 1)][rng.integers(5)]
    delta, stroke = np.pi / lam, np.radians(rng.uniform(1.0, 6.0)) * 3.0 / lam
    rise, dwell = rng.uniform(0.3, 0.5), rng.uniform(0.05, 0.2)
    segments = [
        Segment("rise", rise * delta, stroke, law(rng.choice(NAMES))),
        Segment("dwell", dwell * delta),
        Segment("return", delta * (1.0 - rise - dwell), stroke, law(rng.choice(NAMES))),
    ]
    transmission, radius = from_law(lam, mu, 60.0, programme(segments, delta)), rng.uniform(2.0, 9.0)
    while not (follower := followers.double_roller(transmission, radius)).envelope.regular:
        radius *= 0.7
    contour = through(follower.envelope, 2 * rng.integers(20, 200), arcs=bool(seed % 2))
    motion = follower.judge(contour, PHI).motion
    proved(motion, np.degrees(dense(follower, contour, 12_000)), 1.0)


def inch():
    """An inch cam whose greatest error lies well between the shaft angles that are looked at."""
    delta = np.pi / 4
    segments = [
        Segment("rise", np.radians(20.0), np.radians(4.0), law("polynomial-345")),
        Segment("dwell", np.radians(5.0)),
        Segment("return", np.radians(20.0), np.radians(4.0), law("polynomial-4567")),
    ]
    return followers.double_roller(from_law(4, 3, 25.4 * 2.5, programme(segments, delta)), 25.4 * 0.3)


@pytest.mark.slow
def test_a_limit_below_the_true_error_and_above_the_samples_is_broken(tmp_path, monkeypatch):
    follower = inch()
    path = write_dxf(tmp_path / "cam.dxf", follower.envelope.points(np.arange(301) * 2 * np.pi / 301))
    few = np.arange(24) * 2 * np.pi / 24
    intent, contour = part_of(follower, bore=10.0), through(follower.envelope, 301)
    true = follower.judge(contour, few).motion
    monkeypatch.setattr(kin.follower.roller, "MOST_PIECES", 0)
    low = follower.judge(contour, few).motion
    assert (low.extremes, low.remainder) == ("sampled", pytest.approx(0.02 * low.max))
    assert low.max < true.max
    limits = Limits(1.0, motion=1.01 * low.max, play=10.0)
    told = {check.name: check for check in verify(path, intent, 24, limits).checks}["motion"]
    assert not told.ok, "the allowance of 2 % is held against the limit as well"
    assert told.detail.startswith("sampled; ")
    monkeypatch.undo()
    limits = Limits(1.0, motion=0.5 * (low.max + true.max), play=10.0)
    told = {check.name: check for check in verify(path, intent, 24, limits).checks}["motion"]
    assert not told.ok
    assert told.value == true.bound
    assert told.detail == f"true within {true.remainder:.2g} deg"
    limits = Limits(1.0, motion=1.002 * true.max, play=10.0)
    assert {check.name: check for check in verify(path, intent, 24, limits).checks}["motion"].ok


def test_few_shaft_angles_give_the_same_error_as_many():
    follower = inch()
    contour = through(follower.envelope, 301)
    few, many = (follower.judge(contour, PHI[::step]).motion for step in (120, 1))
    assert few.max == pytest.approx(many.max, rel=1e-5)
    assert max(few.max, many.max) <= min(few.bound, many.bound)


@pytest.mark.slow
def test_a_short_spike_between_the_samples_is_found():
    follower = inch()
    points = follower.envelope.points(np.arange(2000) * 2 * np.pi / 2000)
    points[777] *= 1.0005
    contour = Contour.from_vertices(points)
    motion = follower.judge(contour, PHI[::90]).motion
    proved(motion, np.degrees(dense(follower, contour, 60_000)), 1.0)


@pytest.mark.parametrize(
    "intended",
    [
        ByLaw(rising(0.2, 0.5)),
        ByLaw(rising(0.2, 0.5, ("harmonic", "parabolic"))),
        Swing(inch().transmission),
        Swing(from_delta(4, 3, 60.0, {1: 625.0}, {})),
    ],
)
def test_bounds_of_a_law_hold_and_are_near(intended):
    rng = np.random.default_rng(5)
    low = rng.uniform(-7.0, 14.0, 300)
    high = low + rng.uniform(0.0, 1.0, 300) ** 6 * 3.0
    bound = intended.steepest(low, high)
    inside = low + (high - low) * np.linspace(0.0, 1.0, 33)[:, None]
    rows = intended.rows(inside.ravel()).reshape(3, 33, 300)
    reached = np.abs(rows[1:]).max(axis=1)
    assert (reached <= bound[:2] * (1 + 1e-9) + 1e-12).all()
    third = np.abs(np.diff(rows[2], axis=0)).max(axis=0) * 32
    assert (third <= bound[2] * (high - low) * (1 + 1e-6) + 1e-9).all()
    everywhere = intended.steepest(np.zeros(1), np.full(1, 7.0))[:, 0]
    dense = np.abs(intended.rows(np.linspace(0.0, 2 * np.pi, 20_001))[1:]).max(axis=1)
    assert (everywhere[:2] <= 2.0 * dense).all()


def test_rows_of_a_swing_are_those_of_the_transmission():
    transmission = inch().transmission
    phi = np.concatenate([np.linspace(-9.0, 9.0, 5000), transmission.at(transmission.breaks, 0)[0][0]])
    rows, exact = Swing(transmission).rows(phi), transmission.psi_of_shaft(phi, 2)
    assert rows[0] == pytest.approx(exact[0], abs=1e-14)
    assert rows[1] == pytest.approx(exact[1], abs=1e-10)
    assert rows[2] == pytest.approx(exact[2], abs=1e-6)


def test_a_contour_that_follows_the_law_exactly_has_no_error():
    """A circle about the shaft and a law that stands still: the remainder is rounding."""
    circle = Contour.from_bulges(np.array([[30.0, 0.0], [-30.0, 0.0]]), np.ones(2))
    still = Piecewise(np.array([0.0, 2 * np.pi]), (Constant(38.0),), 2 * np.pi, smooth_seam=True)
    motion = followers.roller(Line(0.0), 8.0, still).judge(circle, PHI).motion
    assert motion.extremes == "true"
    assert motion.bound < 1e-10


def frame(radius=8.0):
    """Two opposite rollers on a pitch curve of constant diameters, r = 40 + 3 cos 3 theta + 0.4 sin 5 theta."""
    return followers.roller_yoke(radius, lift_from_fourier(40.0, {3: 3.0}, {5: 0.4}).law, 80.0)


@pytest.mark.slow
@pytest.mark.parametrize("count", few([50, 131]))
def test_opposite_rollers_on_polygons_against_bisected_distances(count):
    yoke = frame()
    contour = through(yoke.envelope, count)
    one = followers.roller(Line(0.0), 8.0, yoke.law)

    def each(phi):
        """Distance of either centre from the shaft, (2, n)."""
        return [positions(contour, one, angle, yoke.intended(angle), 1.5) for angle in (phi, phi + np.pi)]

    some = PHI[::7] + 0.003
    near, far = each(some)
    assert followers.resting(yoke, contour, some) == pytest.approx(np.stack([near, 80.0 - far]), abs=1e-9)
    judged = yoke.judge(contour, PHI)
    proved(judged.motion, peak(lambda phi: each(phi)[0] - yoke.intended(phi), 2000), 1.0)
    play = judged.play
    assert play is not None
    assert (play.unit, play.extremes) == ("mm", "sampled")
    looked = np.arange(3000) * np.pi / 3000
    gap = 80.0 - sum(each(looked))
    assert play.most == pytest.approx(gap.max(), rel=2e-3)
    assert play.least == pytest.approx(gap.min(), abs=2e-3 * gap.max())
    for at, value in ((play.least_at_deg, play.least), (play.most_at_deg, play.most)):
        assert 80.0 - sum(each(np.radians([at]))) == pytest.approx(value, abs=1e-9)


@pytest.mark.slow
def test_the_limits_of_opposite_rollers_hold_on_parallel_contours_and_are_sharp():
    """All metal too much, or too little. At pressure angles of 15 degrees 0.3 mm do more than the first order says."""
    yoke, reached = frame(), []
    tolerance = 0.3 + 2e-5  # the polygon's own
    for offset in (0.3, -0.3):
        judged = yoke.judge(through(frame(8.0 - offset).envelope, 6000), PHI)
        play = -judged.play.least if offset > 0 else judged.play.most
        for found, limit in ((judged.motion.max, yoke.motion_limit), (play, yoke.closure.limit)):
            assert 0.99 * limit(tolerance) < found <= limit(tolerance)
        reached.append(judged.motion.max)
    r, slope = yoke.motion.derivatives(np.arange(3600) * 2 * np.pi / 3600, 1)
    assert max(reached) > 1.0001 * tolerance * np.hypot(1.0, slope / r).max()


@pytest.mark.slow
def test_a_frame_of_rollers_tells_its_dwells_and_how_flat_they_are():
    """Rise, dwell, and the same downwards: half a turn on the other roller does what the first did."""
    half = [Segment("rise", np.radians(110), 8.0, law("cycloidal")), Segment("dwell", np.radians(70))]
    back = [Segment("return", np.radians(110), 8.0, law("cycloidal")), Segment("dwell", np.radians(70))]
    found = programme(half + back, 2 * np.pi).motion
    yoke = followers.roller_yoke(
        8.0, Piecewise(found.knots, tuple(AffineStretch(f, 36.0) for f in found.functions), 2 * np.pi), 80.0
    )
    assert yoke.motion.derivatives(PHI, 0)[0] + yoke.motion.derivatives(PHI + np.pi, 0)[0] == pytest.approx(80.0)
    assert np.degrees(yoke.rests) == pytest.approx(np.array([[110.0, 180.0], [290.0, 360.0]]))
    contour = through(yoke.envelope, 240)
    phi = np.radians(np.linspace(110.0, 180.0, 4001))
    range_ = np.ptp(positions(contour, followers.roller(Line(0.0), 8.0, yoke.law), phi, yoke.intended(phi), 0.5))
    flat = yoke.judge(contour, np.arange(3600) * 2 * np.pi / 3600).motion.dwell_flatness
    assert flat == pytest.approx(range_, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("vertex", [0, 1, 1500, 1999])
@pytest.mark.parametrize("depth", [0.02, -0.02])
def test_a_dent_or_spike_of_one_vertex_is_proved(vertex, depth):
    """Over a dent the roller changes over from corner to corner, each of which hides the end of the other."""
    follower = inch()
    points = follower.envelope.points(np.arange(2000) * 2 * np.pi / 2000)
    points[vertex] *= 1.0 - depth / np.hypot(*points[vertex])
    contour = Contour.from_vertices(points)
    proved(follower.judge(contour, PHI).motion, np.degrees(dense(follower, contour, 20_000)), 1.0)


@pytest.mark.slow
def test_what_is_not_proved_is_looked_at_closely(monkeypatch):
    def unsettled(*_):
        raise UnsettledError("not proved")

    monkeypatch.setattr(kin.follower.roller, "greatest_error", unsettled)
    follower = inch()
    for seed in range(3):
        points = follower.envelope.points(np.arange(300) * 2 * np.pi / 300)
        points[np.random.default_rng(seed).integers(0, 300, 5)] *= 1.0 - 4e-4
        contour = Contour.from_vertices(points)
        motion = follower.judge(contour, PHI[::7]).motion
        assert motion.extremes == "sampled"
        assert motion.max == pytest.approx(np.degrees(dense(follower, contour, 20_000)), rel=1e-4)


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("scale", [1.0 - 4e-4, 1.0 + 4e-4])
def test_a_dent_or_spike_in_a_very_fine_polygon_is_not_lost_between_samples(scale):
    follower = inch()
    points = follower.envelope.points(np.arange(25_000) * 2 * np.pi / 25_000)
    points[8333] *= scale
    contour = Contour.from_vertices(points)
    motion = follower.judge(contour, PHI[::3]).motion
    assert motion.extremes == "sampled"
    reached = np.degrees(dense(follower, contour, 40_000))
    assert motion.max == pytest.approx(reached, rel=0.02)
    assert reached <= motion.bound


def test_an_error_is_bounded_and_reached_at_the_place_that_is_told():
    """Of cubics over spans: the bound holds, and the error reached is one of the cubic, no less than the middle's."""
    rng = np.random.default_rng(8)
    f, slope, bend, third = rng.normal(size=(4, 60))
    half = rng.uniform(0.2, 2.0, 60)
    inner = 0.7 * half
    s = half * np.linspace(-1.0, 1.0, 401)[:, None]

    def cubic(at):
        return f + at * (slope + at * (0.5 * bend + at * third / 6.0))

    most = np.abs(slope + s * (bend + 0.5 * s * third)).max(axis=0), np.abs(bend + s * third).max(axis=0), np.abs(third)
    bound, reached, where = bounds_of_error(np.stack([f, slope, bend]), most, half, inner)
    assert (bound >= cubic(s).max(axis=0) - 1e-12).all()
    assert (np.abs(where) <= inner).all()
    assert (reached >= f).all()
    assert (reached <= cubic(where) + 1e-12).all()
    # of parabolas both are the greatest value within the inner part
    most = most[0] + half * np.abs(third) * half, np.abs(bend), np.zeros(60)
    bound, reached, where = bounds_of_error(np.stack([f, slope, bend]), most, inner, inner)
    s = inner * np.linspace(-1.0, 1.0, 4001)[:, None]
    greatest = (f + s * (slope + 0.5 * s * bend)).max(axis=0)
    assert reached == pytest.approx(greatest, abs=1e-6)
    assert bound == pytest.approx(reached, abs=1e-12)
