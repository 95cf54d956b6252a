"""The exact contour and its feet: closed forms, brute force over dense samples, undercut included."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support import followers
from support.camfiles import circle_points, pitch_polar, roller_points, support_points
from support.cases import examples, few
from support.heavy import shapely, spatial
from support.programmes import Segment, law, programme

from kin.contour.arcs import unit
from kin.contour.contour import Contour
from kin.follower.deviation import convex_deviation, deviation
from kin.follower.envelope import FlatEnvelope, LiftPitch, RollerEnvelope, TransmissionPitch, support_rows
from kin.law.support_function import lift_constant_breadth, lift_from_fourier, lift_hypocycloid, lift_reuleaux
from kin.law.transmission import from_arc, from_delta, from_law

DENSE = np.linspace(0.0, 2 * np.pi, 40001)[:-1]
SHU_WU = programme(
    [Segment("rise", np.radians(120), 20.0, law("modified-sine")), Segment("dwell", np.radians(60))], np.pi
)
LIFTS = {
    "hypocycloid": lift_hypocycloid(3, 2.0, 50.0),
    "moved shaft": lift_hypocycloid(3, 2.0, 50.0, pivot=(18.0, 8.5)),
    "circle": lift_from_fourier(20.0, {1: 5.0}, {}),
    "rounded Reuleaux": lift_reuleaux(3, 50.0, 5.0),
    "sharp Reuleaux": lift_reuleaux(5, 50.0, 0.0),
    "Shu and Wu": lift_constant_breadth(40.0, SHU_WU),
    "undercut": lift_hypocycloid(3, 4.0, 50.0),  # rho = 25 - 32 cos 3t
}
PITCHES = {
    "Booth": (from_delta(2, 1, 60.0, {1: 900.0}, {}), 8.0),
    "hollow": (from_delta(4, 3, 60.0, {1: 625.0}, {}), 8.0),
    "arc": (from_arc(3, 1, 60.0, 70.0, "convex"), 8.0),
    "given law": (
        from_law(
            4,
            1,
            60.0,
            programme(
                [
                    Segment("rise", np.radians(20), np.radians(4), law("cycloidal")),
                    Segment("return", np.radians(25), np.radians(4), law("cycloidal")),
                ],
                np.radians(45),
            ),
        ),
        8.0,
    ),
    "undercut": (from_delta(4, 3, 60.0, {1: 625.0}, {}), 30.0),
}


def samples(envelope, count):
    """Points at equal steps of the parameter and at the ends of each stretch."""
    breaks = envelope.pitch.breaks
    t = np.unique(np.concatenate([np.arange(count) * 2 * np.pi / count, breaks, breaks - 1e-14]))
    return envelope.points(t)


def probes(points, spread, seed=5):
    rng = np.random.default_rng(seed)
    return points + rng.uniform(-spread, spread, points.shape)


@pytest.mark.slow
@pytest.mark.parametrize("name", LIFTS)
@pytest.mark.parametrize("spread", [1e-3, 2.0])
def test_excess_over_a_flat_face_is_the_greatest_reach_beyond_it(name, spread):
    lift = LIFTS[name]
    envelope = FlatEnvelope(LiftPitch(lift))
    assert envelope.regular == (name != "undercut")
    points = probes(samples(envelope, 150), spread)
    feet = envelope.feet(points)
    dense = points @ unit(DENSE).T - lift.derivatives(DENSE, 0)[0]
    # between two samples the reach is bent by less than |x - c| + rho
    bend = 120.0 * (DENSE[1] / 2) ** 2
    assert (feet.excess >= dense.max(axis=1) - 1e-12).all()
    assert (feet.excess <= dense.max(axis=1) + bend).all()
    at_foot = (points * unit(feet.parameter)).sum(axis=1) - lift.derivatives(feet.parameter, 0)[0]
    assert at_foot == pytest.approx(feet.excess, abs=1e-12)
    assert feet.normal == pytest.approx(unit(feet.parameter), abs=1e-15)


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", PITCHES)
@pytest.mark.parametrize("spread", [1e-3, 2.0])
def test_excess_over_a_roller_is_its_radius_less_the_distance_to_the_pitch_curve(name, spread):
    transmission, radius = PITCHES[name]
    envelope = RollerEnvelope(TransmissionPitch(transmission), radius)
    assert envelope.regular == (name != "undercut")
    points = probes(samples(envelope, 150), spread)
    feet = envelope.feet(points)
    r, t = transmission.pitch(DENSE, 0)
    pitch = shapely.Polygon(r[0][:, None] * unit(t[0]))
    inside = shapely.contains_xy(pitch, *points.T)
    expected = radius - np.where(inside, 1, -1) * shapely.distance(pitch.exterior, shapely.points(points))
    assert inside.any()
    assert feet.excess == pytest.approx(expected, abs=200.0 * (DENSE[1] / 2) ** 2)


def test_pitch_curve_in_polar_form_is_the_papers():
    transmission, radius = PITCHES["hollow"]
    own = samples(RollerEnvelope(TransmissionPitch(transmission), radius), 64)
    by_hand = roller_points(64, (4, 3, 60.0, {1: 625.0}), 8.0)
    near = shapely.distance(shapely.Polygon(own).exterior, shapely.points(by_hand))
    assert near == pytest.approx(0.0, abs=1e-12)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", [n for n in LIFTS if n != "undercut"])
def test_area_and_perimeter_of_a_flat_envelope(name):
    envelope = FlatEnvelope(LiftPitch(LIFTS[name]))
    fine = shapely.Polygon(samples(envelope, 200_000))
    area, perimeter = envelope.area_and_perimeter()
    assert area == pytest.approx(fine.area, rel=1e-9)
    assert perimeter == pytest.approx(fine.length, rel=1e-9)


def test_barbier_and_reuleaux_in_closed_form():
    area, perimeter = FlatEnvelope(LiftPitch(LIFTS["sharp Reuleaux"])).area_and_perimeter()
    assert perimeter == pytest.approx(np.pi * 50.0, rel=1e-14)
    area, _ = FlatEnvelope(LiftPitch(lift_reuleaux(3, 50.0, 0.0))).area_and_perimeter()
    assert area == pytest.approx((np.pi - np.sqrt(3.0)) / 2 * 50.0**2, rel=1e-14)
    area, _ = FlatEnvelope(LiftPitch(lift_hypocycloid(3, 2.0, 50.0))).area_and_perimeter()
    assert area == pytest.approx(np.pi * (25.0**2 - 4 * 2.0**2), rel=1e-14)  # pi (mean^2 - (k^2 - 1) a^2 / 2)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", [n for n in PITCHES if n != "undercut"])
def test_area_and_perimeter_of_a_roller_envelope(name):
    transmission, radius = PITCHES[name]
    envelope = RollerEnvelope(TransmissionPitch(transmission), radius)
    fine = shapely.Polygon(samples(envelope, 200_000))
    area, perimeter = envelope.area_and_perimeter()
    assert area == pytest.approx(fine.area, rel=1e-9)
    assert perimeter == pytest.approx(fine.length, rel=1e-9)


@pytest.mark.parametrize("name", ["Booth", "given law"])
def test_support_of_a_pair_is_the_polar_pitch_curve(name):
    """r(t) as a support function: value against W's closed form, slopes against the pitch curve's own direction."""
    transmission, _ = PITCHES[name]
    tau = np.linspace(0.05, 6.2, 400)
    (r, slope, bend), (t, _, _) = support_rows(transmission, tau)
    if name == "Booth":
        by_hand, slope_by_hand = pitch_polar(t, 2, 1, 60.0, {1: 900.0})
        assert r == pytest.approx(by_hand, abs=1e-12)
        assert slope == pytest.approx(slope_by_hand, abs=1e-11)
    alpha = transmission.alpha
    ahead, _ = support_rows(transmission, transmission.polar_parameter(t + alpha))
    # W 7.1 and its two derivatives: r^2 + s^2 - 2 r s cos alpha = 4 l^2 sin^2 alpha
    s, s1, s2 = ahead
    cosine = np.cos(alpha)
    assert r**2 + s**2 - 2 * r * s * cosine == pytest.approx(4 * 60.0**2 * np.sin(alpha) ** 2, rel=1e-13)
    assert r * slope + s * s1 - (slope * s + r * s1) * cosine == pytest.approx(0.0, abs=1e-9)
    second = slope**2 + r * bend + s1**2 + s * s2 - (bend * s + 2 * slope * s1 + r * s2) * cosine
    assert second == pytest.approx(0.0, abs=1e-7)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", ["hypocycloid", "rounded Reuleaux", "sharp Reuleaux", "Shu and Wu"])
@pytest.mark.parametrize("count", [8, 40, 500])
def test_deviation_of_convex_polygons_is_the_difference_of_support_functions(name, count):
    """For convex bodies the Hausdorff distance is max |p1 - p2| (docs/theory.md 2)."""
    lift = LIFTS[name]
    rng = np.random.default_rng(count)
    t = np.sort(rng.uniform(0, 2 * np.pi, count))
    p, slope = lift.derivatives(t, 1)
    points = p[:, None] * unit(t) + slope[:, None] * unit(t + np.pi / 2) * 1.0
    points = points[np.append(np.hypot(*np.diff(points, axis=0).T) > 1e-9, True)] * 1.0005
    contour = Contour.from_vertices(points)
    found = deviation(contour, FlatEnvelope(LiftPitch(lift)))
    theta = np.unique(np.concatenate([DENSE, contour.normals]))
    gap = contour.support(theta).q - lift.derivatives(theta, 0)[0]
    assert found.outside == pytest.approx(max(gap.max(), found.outside), abs=1e-6)
    assert found.outside >= gap.max() - 1e-11
    assert -gap.min() == pytest.approx(found.worst[0], rel=1e-5)
    assert (found.rounds, found.backwards) == (1, 0.0)
    reach = followers.flat_face(lift).judge(contour, DENSE[:10]).reach
    assert contour.is_convex
    assert convex_deviation(reach).worst[0] == pytest.approx(found.worst[0], rel=1e-5)
    assert reach.greatest == pytest.approx(found.outside, abs=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("name", few(["Booth", "hollow", "arc", "given law"], 2))
def test_deviation_from_a_roller_envelope_by_dense_distances(name):
    transmission, radius = PITCHES[name]
    envelope = RollerEnvelope(TransmissionPitch(transmission), radius)
    points = probes(samples(envelope, 60), 0.2)
    contour = Contour.from_vertices(points)
    found = deviation(contour, envelope)
    exact = samples(envelope, 400_000)
    sample = contour.sample(400)
    distance, _ = spatial.cKDTree(exact).query(sample)
    polygon = shapely.Polygon(exact)
    shapely.prepare(polygon)
    signed = np.where(shapely.contains_xy(polygon, *sample.T), -distance, distance)
    assert found.outside == pytest.approx(signed.max(), abs=2e-5)
    assert found.inside == pytest.approx(-signed.min(), abs=2e-5)
    assert found.rounds == 1
    # and from the exact contour to the file no point is farther
    back = shapely.distance(shapely.Polygon(points).exterior, shapely.points(samples(envelope, 4000)))
    assert back.max() <= found.worst[0] + 1e-9


def test_few_long_arcs_are_judged_between_their_ends():
    """A circle of 20.1 mm as two half circles, against 20 mm about a point 0.3 mm off: 0.1 +- 0.3."""
    lift = lift_from_fourier(20.0, {1: 0.3 * np.cos(1.0)}, {1: 0.3 * np.sin(1.0)})
    contour = Contour.from_bulges(np.array([[20.1, 0.0], [-20.1, 0.0]]), np.ones(2))
    found = deviation(contour, FlatEnvelope(LiftPitch(lift)))
    assert (found.outside, found.inside) == pytest.approx((0.4, 0.2), abs=1e-11)
    assert np.mod(found.outside_at, 2 * np.pi) == pytest.approx(1.0 + np.pi, abs=1e-5)
    assert found.inside_at == pytest.approx(1.0, abs=1e-5)


def test_contours_that_go_round_twice_or_turn_back_are_told():
    lift = lift_from_fourier(20.0, {}, {})
    twice = np.tile(circle_points(200) * 20.0, (2, 1))
    assert deviation(Contour.from_vertices(twice), FlatEnvelope(LiftPitch(lift))).rounds == 2
    points = circle_points(200) * 20.0
    swapped = points.copy()
    swapped[[50, 51]] = swapped[[51, 50]]
    found = deviation(Contour.from_vertices(swapped), FlatEnvelope(LiftPitch(lift)))
    assert found.rounds == 1
    assert found.backwards == pytest.approx(2 * 20.0 * np.sin(np.pi / 200), rel=1e-3)
    assert found.worst[0] < 0.03


@given(st.integers(0, 2**32 - 1))
@example(10750996)  # a dent about as deep as the edges hang anyway
@settings(max_examples=examples(30), deadline=None)
def test_one_dent_or_bump_anywhere_is_measured(seed):
    rng = np.random.default_rng(seed)
    lift = LIFTS["hypocycloid"]
    points = support_points(400, harmonics=((3, 2.0, 0.0),))
    k, depth = int(rng.integers(400)), float(rng.uniform(-0.5, 0.5))
    t = k * 2 * np.pi / 400
    points[k] += depth * unit(t)
    found = deviation(Contour.from_vertices(points), FlatEnvelope(LiftPitch(lift)))
    plain = 41.0 * (np.pi / 400) ** 2 / 2 * 1.001  # sagitta of the edges where rho = 41
    assert max(depth, 0.0) <= found.outside + 1e-12 <= max(depth, 0.0) + 1e-9
    assert max(-depth, 0.0) <= found.inside + 1e-12
    # an edge from a sound vertex to one of a dent d hangs d s + 4 plain s (1 - s) inside: most at its end, or before it
    dent = max(-depth, 0.0)
    hanging = dent if dent > 4.0 * plain else (dent + 4.0 * plain) ** 2 / (16.0 * plain)
    assert found.inside <= hanging + 1e-9
