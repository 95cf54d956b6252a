"""Clearance of moving bodies over a turn: closed forms, narrow windows, brute force by shapely, cams from files."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.heavy import shapely
from support.motions import Formula
from support.places import RECIPES

import kin.contour.region
import kin.mechanism.clearance
from kin.contour.arcs import turned
from kin.contour.contour import Contour
from kin.mechanism.clearance import Mover, Slab, clearances
from kin.mechanism.distance import Encounter, Relative, rates, see
from kin.mechanism.pose import Sampled, Still, Turning
from kin.mechanism.sweep import swept_box
from kin.numeric import elementary
from kin.read.files import read_drawing


def disc(x, y, r):
    return Contour.from_bulges(np.array([[x - r, y], [x + r, y]], dtype=float), np.array([1.0, 1.0]))


def box(x0, y0, x1, y1):
    return Contour.from_vertices(np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float))


def mover(name, outer, motion, holes=(), *, low=0.0, high=1.0):
    return Mover(name, (Slab(outer, tuple(holes), low, high),), motion)


def only(*movers, **options):
    (found,) = clearances(movers, **options)
    assert found.proved <= found.least
    return found


WALL = box(10, -50, 12, 50)


def test_disc_turning_about_an_eccentric_centre_near_a_wall():
    found = only(mover("disc", disc(3, 0, 5), Turning(1.0, angle=-0.7)), mover("wall", WALL, Still()))
    assert found.least == pytest.approx(2.0, abs=2e-3)
    assert 1.997 <= found.proved <= 2.0
    # 3 (1 - cos) off by 0.002 at the most
    assert found.at_deg == pytest.approx(math.degrees(0.7), abs=2.1)
    assert found.place == pytest.approx((9.0, 0.0), abs=0.1)
    assert found.slack == 0.0
    assert found.holds
    assert not found.collides


def test_disc_turning_about_its_own_centre_costs_no_search():
    found = only(mover("disc", disc(0, 0, 5), Turning(1.0, x=1.0)), mover("wall", WALL, Still()))
    assert found.least == pytest.approx(4.0, abs=1e-9)
    assert found.proved == pytest.approx(4.0, abs=1e-9)
    assert found.evaluations <= 128


@pytest.mark.parametrize(("radius", "least"), [(8.0, -1.0), (7.0, 0.0), (6.999, 0.001)])
def test_touching_and_overlapping(radius, least):
    found = only(mover("disc", disc(3, 0, radius), Turning(-2.0)), mover("wall", WALL, Still()))
    assert found.least == pytest.approx(least, abs=1.1e-3)
    assert found.proved <= least + 1e-9
    assert found.proved >= found.least - max(1e-3, -0.05 * found.least) - 1e-9


def test_bar_turning_past_a_pin():
    bar = box(-2, -2, 40, 2)
    corner = math.hypot(40, 2)
    found = only(mover("bar", bar, Turning(1.0)), mover("pin", disc(corner + 2.3, 0, 2), Still()))
    assert found.least == pytest.approx(0.3, abs=1e-3)
    assert found.proved <= 0.3 + 1e-9
    found = only(mover("bar", bar, Turning(1.0)), mover("pin", disc(20, 20, 2), Still()))
    # the pin goes right through the bar: the middle line of the bar is 2 mm inside it
    assert found.least == pytest.approx(-2.0, rel=0.05)
    assert found.collides


def test_bars_that_turn_against_each_other():
    """Two crosses of half length 10 at a distance of 19, geared one to one: half a right angle apart they pass."""

    def cross(width):
        half = 0.5 * width
        corners = []
        for k in range(4):
            c, s = round(math.cos(k * math.pi / 2)), round(math.sin(k * math.pi / 2))
            corners += [(c * x - s * y, s * x + c * y) for x, y in ((half, -half), (10, -half), (10, half))]
        return Contour.from_vertices(np.array(corners, dtype=float))

    one = mover("one", cross(1.0), Turning(1.0))
    meshed = only(one, mover("other", cross(1.0), Turning(-1.0, x=19.0, angle=math.pi / 4)))
    clashing = only(one, mover("other", cross(1.0), Turning(-1.0, x=19.0)))
    assert meshed.least > 1.0
    assert meshed.proved > 1.0
    assert clashing.least < -0.4


def test_pin_inside_a_hole_keeps_from_its_edge_only():
    plate = mover("plate", box(-20, -20, 20, 20), Still(), [disc(0.3, 0, 2.5)])
    found = only(mover("pin", disc(0, 0, 2), Turning(3.0)), plate)
    assert found.least == pytest.approx(0.2, abs=1e-9)
    assert only(mover("pin", disc(0, 0, 1), Turning(3.0)), mover("plate", box(-9, -9, 9, 9), Still())).least < -7.9


def test_bodies_that_overlap_wholly_do_not_pass_for_touching():
    assert only(mover("a", disc(0, 0, 2), Still()), mover("b", disc(0, 0, 2), Still())).least < -1.8


def test_thin_rings_that_overlap_are_no_deeper_in_one_another_than_they_are_wide():
    """The point kept inside a ring of 0.03 mm was outside it, and 0.066 mm deep in the other ring."""
    thin = mover("thin", disc(0, 0, 50), Still(), [disc(0, 0, 49.97)])
    found = only(thin, mover("wide", disc(0, 0, 60), Still(), [disc(0, 0, 49.99)]))
    assert found.least == pytest.approx(-0.01, abs=1e-3)


def test_narrow_window_that_sampling_would_miss():
    """A thin needle meets a pin within less than a hundredth of a degree, midway between two of 3600 samples."""
    centre, thickness, radius = math.radians(123.45), 1e-4, 0.02
    needle = mover("needle", box(0, -0.5 * thickness, 300, 0.5 * thickness), Turning(1.0))
    pin = mover("pin", disc(299 * math.cos(centre), 299 * math.sin(centre), radius), Still())
    window = 2.0 * (radius + 0.5 * thickness) / 299
    assert math.degrees(window) < 0.01
    samples = np.arange(3600) * 2 * np.pi / 3600
    assert np.abs(samples - centre).min() > 10 * window / 2
    found = only(needle, pin)
    assert found.least == pytest.approx(-radius, abs=2e-3)
    assert found.at_deg == pytest.approx(123.45, abs=0.005)
    assert found.collides


def test_heights():
    wall = mover("wall", box(2, -50, 12, 50), Still(), low=1.0, high=2.0)
    assert clearances([mover("disc", disc(3, 0, 5), Turning(1.0)), wall]) == []
    (close,) = clearances([mover("disc", disc(3, 0, 5), Turning(1.0)), wall], axial=0.1)
    assert close.least < 0.0
    stacked = Mover("stack", (Slab(disc(3, 0, 5), (), 0, 1), Slab(disc(3, 0, 1), (), 1, 2)), Turning(1.0))
    (upper,) = clearances([stacked, mover("wall", box(5, -50, 12, 50), Still(), low=1.0, high=2.0)])
    assert upper.least == pytest.approx(1.0, abs=2e-3)


def test_what_moves_as_one_is_looked_at_once():
    poses = Formula(lambda t: (elementary.cos(t), elementary.sin(t), 0.3 * elementary.sin(t))).over(
        np.linspace(0, 2 * np.pi, 181), np.zeros(181)
    )
    for motion in (Still(), Turning(2.0), Sampled(poses.pose)):
        found = only(mover("a", disc(0, 0, 2), motion), mover("b", disc(7, 0, 2), motion))
        assert found.least == pytest.approx(3.0, abs=1e-12)
        assert found.evaluations == 1


@pytest.mark.slow
def test_pairs_that_are_left_out():
    bodies = [
        mover("pin", disc(0, 0, 2.001), Turning(3.0)),
        mover("plate", box(-9, -9, 9, 9), Still(), [disc(0, 0, 2)]),
    ]
    tight = only(*bodies)
    assert tight.least == pytest.approx(-0.001, abs=1e-4)
    assert tight.collides
    assert not tight.holds
    assert clearances(bodies, [frozenset({"plate", "pin"})]) == []
    with pytest.raises(ValueError, match="unknown pair of bodies: pin and sky"):
        clearances(bodies, [frozenset({"pin", "sky"})])
    with pytest.raises(ValueError, match="one name"):
        clearances([bodies[0], bodies[0]])
    with pytest.raises(ValueError, match="no height"):
        Slab(disc(0, 0, 1), (), 1.0, 1.0)


@pytest.mark.slow
def test_sliding_contact_is_found_as_such():
    """An eccentric disc lifts a tappet's round end: they touch throughout, and slide."""

    def lift(t):
        c = 2.0 * elementary.cos(t)
        return 0.0, elementary.sqrt(13.0**2 - c * c) + 2.0 * elementary.sin(t), 0.0

    tappet = mover("tappet", disc(0, 0, 3), Formula(lift))
    cam = mover("cam", disc(2, 0, 10), Turning(1.0))
    found = only(cam, tappet, accuracy=0.01)
    assert found.least == pytest.approx(0.0, abs=1e-4)
    assert found.proved == pytest.approx(0.0, abs=0.02)
    near = mover("tappet", disc(0, 0, 3.05), Formula(lift))
    assert only(cam, near, accuracy=0.01).collides


ORBIT = Formula(lambda t: (12.0 * elementary.cos(t), 3.0 * elementary.sin(t), 2.0 * t))


def sampled(motion, steps, *, known=False):
    phi = np.linspace(0.0, 2.0 * np.pi, steps + 1)
    course = motion.over(phi, np.zeros(steps + 1))
    return Sampled(course.pose, course.rate if known else None)


@pytest.mark.parametrize("known", [False, True])
def test_sampled_motion_tells_how_far_it_may_be_off(known):
    phi = np.linspace(0.0, 2.0 * np.pi, 5001)
    for steps in (36, 90, 360):
        motion = sampled(ORBIT, steps, known=known)
        off = motion.over(phi, 0.0 * phi).pose - ORBIT.over(phi, 0.0 * phi).pose
        assert np.hypot(off[:, 0], off[:, 1]).max() <= motion.slack[0] * 1.001 + 1e-12
        assert motion.slack[0] < 1e4 / steps**4
    # an acceleration that jumps
    t = np.linspace(0.0, 2.0 * np.pi, 91)
    rise = np.maximum(np.sin(t - 0.01), 0.0)
    pose = np.stack([rise**2, 0.0 * t, 0.0 * t], axis=1)
    rate = np.stack([2.0 * rise * np.cos(t - 0.01), 0.0 * t, 0.0 * t], axis=1)
    kink = Sampled(pose, rate if known else None)
    off = kink.over(phi, 0.0 * phi).pose[:, 0] - np.maximum(np.sin(phi - 0.01), 0.0) ** 2
    assert np.abs(off).max() <= kink.slack[0]


def test_sampled_rates_hold_over_intervals():
    motion = sampled(ORBIT, 36)
    rng = np.random.default_rng(4)
    phi, half = rng.uniform(0.0, 2 * np.pi, 300), 10.0 ** rng.uniform(-3, 0, 300)
    course = motion.over(phi, half)
    for share in np.linspace(-1, 1, 21):
        inside = motion.over(phi + share * half, 0.0 * half)
        assert (np.abs(inside.rate - course.rate) <= course.spread + 1e-9).all()


def test_sampled_motion_refuses_what_it_cannot_hold():
    good = sampled(ORBIT, 36).pose
    with pytest.raises(ValueError, match="8 steps or more"):
        Sampled(good[:5])
    with pytest.raises(ValueError, match="as many as its poses"):
        Sampled(good, good[:-1])
    with pytest.raises(ValueError, match="not the first"):
        Sampled(good[:-1])
    jumping = good.copy()
    jumping[:, 2] = np.mod(jumping[:, 2], 2 * np.pi)
    with pytest.raises(ValueError, match="jumps"):
        Sampled(jumping)
    with pytest.raises(ValueError, match="cannot be bounded"):
        Formula(lambda t: (1.0 / (t - 1.0), 0.0, 0.0)).over(np.array([1.01]), np.array([0.1]))


def star(rng, corners, least, most, place=(0.0, 0.0)):
    angle = np.sort(rng.random(corners) * 0.6 + np.arange(corners)) * 2 * np.pi / corners
    radius = rng.uniform(least, most, corners)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1) + np.array(place)
    return Contour.from_bulges(points, rng.choice([0.0, 0.1, -0.1, 0.2], corners))


def polygon(contour, holes=()):
    return shapely.Polygon(contour.sample(40), [hole.sample(40) for hole in holes])


def placed(shape, pose):
    from shapely import affinity

    return affinity.translate(affinity.rotate(shape, pose[2], origin=(0, 0), use_radians=True), pose[0], pose[1])


def brute(one, other):
    """Distance; below 0 by how deep a point of either boundary lies in the other."""
    if not one.intersects(other):
        return one.distance(other)
    deepest = 0.0
    for region, body in ((one, other), (other, one)):
        for ring in (body.exterior, *body.interiors):
            points = shapely.points(shapely.get_coordinates(ring.segmentize(0.3)))
            inside = shapely.contains(region, points)
            if inside.any():
                deepest = max(deepest, float(shapely.distance(region.boundary, points[inside]).max()))
    return -deepest


@pytest.mark.slow
@settings(max_examples=examples(6))
@given(st.integers(0, 100_000))
def test_against_brute_force(seed):
    rng = np.random.default_rng(seed)
    one, other = star(rng, 6, 4, 12), star(rng, 5, 3, 9, rng.uniform(-8, 8, 2))
    holes = (star(rng, 5, 1.0, 2.5),) if seed % 3 == 0 else ()
    first, second = polygon(one, holes), polygon(other)
    if not (first.is_valid and second.is_valid):
        return
    home = Turning(float(rng.choice([-1.0, 1.0, 2.0]))) if seed % 2 else Still()
    x, y, swing, turns = *rng.uniform(-25, 25, 2), rng.uniform(0, 6), float(rng.integers(-2, 3))
    exact = Formula(
        lambda t: (
            x + swing * elementary.cos(t),
            y + swing * elementary.sin(2.0 * t),
            0.3 * elementary.sin(t) + turns * t,
        )
    )
    body = sampled(exact, 360) if seed % 5 == 0 else exact
    found = only(mover("one", one, home, holes), mover("other", other, body))
    phi = np.append(np.arange(240) * np.pi / 120, math.radians(found.at_deg))
    poses = zip(home.over(phi, 0.0 * phi).pose, body.over(phi, 0.0 * phi).pose, strict=True)
    gap = np.array([brute(placed(first, p), placed(second, q)) for p, q in poses])
    chords = 0.02  # of the arcs, in the polygons
    accuracy = max(1e-3, 1e-3 * abs(found.least), -0.05 * found.least)
    assert found.proved <= gap.min() + chords
    assert found.least <= gap.min() + accuracy + chords
    assert found.least - found.proved <= accuracy + 1e-9
    if found.least > 0.0:
        assert gap[-1] == pytest.approx(found.least, abs=chords)


@pytest.mark.slow
@pytest.mark.parametrize(("parts", "finest", "few"), few([(24, 2, math.inf), (4, 0, 0), (8, 6, math.inf)], 3, first=1))
def test_how_finely_outlines_are_cut_decides_nothing_but_the_time(monkeypatch, parts, finest, few):
    def found():
        return [
            only(
                mover("one", star(np.random.default_rng(seed), 6, 4, 12), Turning(1.0)),
                mover("other", star(np.random.default_rng(seed + 1), 5, 3, 9, (x, 3)), Turning(-2.0, x=4.0)),
            )
            for seed, x in ((2, 19.0), (5, 12.0))
        ]

    usual = found()
    monkeypatch.setattr(kin.contour.region, "PARTS", parts)
    monkeypatch.setattr(kin.mechanism.clearance, "FINEST", finest)
    monkeypatch.setattr(kin.mechanism.clearance, "FEW", few)
    for one, other in zip(usual, found(), strict=True):
        accuracy = max(1e-3, -0.05 * one.least)
        assert other.least == pytest.approx(one.least, abs=accuracy)
        assert one.proved <= other.least
        assert other.proved <= one.least


@pytest.mark.slow
def test_rate_bounds_the_change_of_the_distance():
    """Over many small intervals the distance at their ends is no lower than the bound says."""
    one = mover("one", star(np.random.default_rng(2), 6, 4, 12), Turning(1.0)).slabs[0].region
    other = mover("other", star(np.random.default_rng(3), 5, 3, 9, (12, 3)), Still()).slabs[0].region
    half = np.full(200, 0.01)
    phi = np.linspace(0.1, 6.0, 200)

    def met(at, width):
        return Encounter.of((one, other), Turning(1.0).over(at, width), ORBIT.over(at, width), width)

    meeting = met(phi, half)
    first = see(meeting, meeting.near(np.full(200, np.nan), 0.0 * half), 1e-6, whole=True)
    pairs = meeting.near(np.abs(first.value) + first.doubt, half)
    rate, _ = rates(meeting, pairs, np.zeros(200, dtype=bool))
    bound = np.maximum.reduceat(rate, np.searchsorted(pairs.cell, np.arange(200)))
    assert (bound < meeting.fastest).any()
    for side in (-1.0, -0.5, 0.5, 1.0):
        there = met(phi + side * half, half)
        value = see(there, there.near(np.full(200, np.nan), 0.0 * half), 1e-6, whole=True)
        slip = 0.02 * np.abs(np.minimum(first.value, value.value))
        assert (np.abs(value.value - first.value) <= np.abs(side) * half * bound + 2e-6 + 2.0 * slip).all()


def test_relative_velocities_hold_over_intervals():
    """A place in the home's axes, and a point of the body: velocities at any angle are within the bounds."""
    home = Formula(lambda t: (2.0 * elementary.sin(t), 1.0, 0.7 * t + elementary.cos(t)))
    rng = np.random.default_rng(8)
    phi, half, point = rng.uniform(0, 6, 400), 10.0 ** rng.uniform(-3, -0.5, 400), rng.uniform(-30, 30, (400, 2))
    every, still = np.arange(400), np.zeros(400)

    def at(angle, width):
        return Relative.of(home.over(angle, width), ORBIT.over(angle, width), width)

    middle = at(phi, half)
    velocity, off = middle.at(every, point)
    own, own_off = middle.along(every, point)
    in_body = turned(point - middle.place, -middle.angle)
    for share in np.linspace(-1.0, 1.0, 9):
        there = at(phi + share * half, still)
        assert (np.hypot(*(there.at(every, point)[0] - velocity).T) <= off + 1e-9).all()
        moved_to = turned(in_body, there.angle) + there.place
        assert (np.hypot(*(there.at(every, moved_to)[0] - own).T) <= own_off + 1e-9).all()


def test_swept_box():
    bar = mover("bar", box(-2, -2, 40, 2), Turning(1.0, x=3.0, y=4.0))
    corner = math.hypot(40, 2)
    found = swept_box(bar)
    exact = (3 - corner, 4 - corner, 3 + corner, 4 + corner)
    assert np.all(np.abs(np.array(found) - exact) <= 0.05)
    assert found.x_min <= exact[0]
    assert found.y_max >= exact[3]
    standing = mover("bar", box(-2, -2, 40, 2), Still(3.0, 4.0))
    assert swept_box(standing) == pytest.approx((1.0, 2.0, 43.0, 6.0))


@pytest.fixture(scope="module")
def cams(tmp_path_factory):
    from camgeo.cli.main import main

    folder = tmp_path_factory.mktemp("cams")
    names = ("w-figure-5", "w-figure-9")
    assert (
        main(["export", *(str(RECIPES / f"{name}.yaml") for name in names), "--only", "dxf", "--out", str(folder)]) == 0
    )
    found = {}
    for name in names:
        path = min((folder / name).glob("*.dxf"), key=lambda p: ("spline" in p.name, p.name))
        found[name] = read_drawing(path)
    return found


@pytest.mark.slow
def test_pivot_lies_inside_the_disc_of_figure_5_and_outside_that_of_figure_9(cams):
    """W 1984: the follower's pivot, 60 mm from the shaft, is covered by the disc of Figure 5; Figure 9's clears it."""
    pin = mover("pivot", disc(60, 0, 2.5), Still())
    gaps = {}
    for name, drawing in cams.items():
        gaps[name] = only(mover("cam", drawing.contour, Turning(-1.0), drawing.holes), pin)
    assert gaps["w-figure-5"].collides
    assert gaps["w-figure-5"].least < -2.5  # its centre too
    assert gaps["w-figure-9"].holds
    assert gaps["w-figure-9"].proved > 10.0
