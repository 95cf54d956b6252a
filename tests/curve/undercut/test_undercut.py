"""Undercut: where, how deep and at what value it ends, against closed forms and brute force."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import shapely
from support.programmes import Segment, law, programme
from support.shapes import PEAR, STAR, Moved, booth, waves

from camgeo.curve.curvature import least_radius
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.curve.support import SupportShape
from camgeo.curve.undercut.bottleneck import rolling_radius
from camgeo.curve.undercut.causes import UndercutError, causes
from camgeo.curve.undercut.pairs import Pitch
from camgeo.curve.undercut.trim import trimmed
from camgeo.curve.undercut.undercut import undercuts
from camgeo.recipe.loading import load_text
from kin.law.support_function import lift_constant_breadth, lift_from_fourier, lift_reuleaux

TURN = 2.0 * math.pi


def flat(mean, cos, sin=None):
    return Curve.whole(SupportShape(lift_from_fourier(mean, cos, sin or {})))


def roller(shape, e):
    return Curve.whole(Parallel(shape, e))


def breadth(base, name):
    motion = [Segment("rise", math.radians(120), 20.0, law(name)), Segment("dwell", math.radians(60))]
    return Curve.whole(SupportShape(lift_constant_breadth(base, programme(motion, math.pi))))


def within(t, found, margin=0.0):
    return any((t - u.start + margin) % TURN <= u.end - u.start + 2.0 * margin for u in found)


def lost_motion(shape, at, count=20_000):
    """p less the support function of what the half planes leave, at directions `at`."""
    t = np.linspace(0.0, TURN, count, endpoint=False)
    frame = shape.sample(np.concatenate([t, at]))
    p = np.sum(frame.point * frame.normal, axis=1)
    hull = np.array(shapely.MultiPoint(frame.normal[:count] / p[:count, None]).convex_hull.exterior.coords)[:-1]
    a, b = hull, np.roll(hull, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    corners = np.column_stack([b[:, 1] - a[:, 1], a[:, 0] - b[:, 0]]) / cross[:, None]
    return p[count:] - (corners @ frame.normal[count:].T).max(axis=0)


@pytest.mark.parametrize(
    "curve",
    [
        flat(25.0, {3: 2.0}),
        flat(9.0, {3: 1.0}),
        breadth(40.0, "modified-sine"),
        Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 5.0))),
        Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 0.0))),
        roller(booth(60.0, 58.0), 15.0),
        roller(PEAR, 13.9),
        roller(STAR, 3.8),
    ],
)
def test_sound_contours_have_none(curve):
    assert undercuts(curve) == ()


def test_cusps_of_one_harmonic():
    found = undercuts(flat(15.0, {3: 2.0}))
    assert len(found) == 3
    for k, u in enumerate(found):
        crest = TURN / 3.0 * (k + 1)
        assert u.kind == "local"
        assert u.at == pytest.approx(crest, abs=1e-6)
        assert u.free_at == pytest.approx(1.0, abs=1e-13)  # rho = a - 16 at the crest
        assert 0.5 * (u.start + u.end) == pytest.approx(crest, abs=1e-12)
        # the corner lies on the crest's axis at q = p + p' cot: the follower hangs free by p(crest) - q
        x = u.end - crest
        corner = (15.0 + 2.0 * math.cos(3 * x)) * math.cos(x) + 6.0 * math.sin(3 * x) * math.sin(x)
        assert u.depth == pytest.approx(17.0 - corner, abs=1e-12)


@pytest.mark.thin(4)
@pytest.mark.parametrize("margin", [1e-3, 1e-6, 1e-9, 1e-11])
def test_depth_follows_its_law_however_small(margin):
    # sigma = 36 (t^2 - d^2), 36 d^2 = margin: the depth is 3/4 36 d^4 = margin^2 / 48, far below rounding
    for u in undercuts(flat(8.0 - margin, {3: 1.0})):
        assert u.free_at == pytest.approx(margin, rel=1e-3)
        assert u.depth == pytest.approx(margin**2 / 48.0, rel=max(margin, 1e-3))


@pytest.mark.slow
@pytest.mark.thin(3)
@pytest.mark.parametrize(("base", "name"), [(5.0, "parabolic"), (1.0, "modified-sine"), (1.0, "harmonic")])
def test_depth_is_the_lost_motion_of_a_flat_face(base, name):
    curve = breadth(base, name)
    found = undercuts(curve)
    assert len(found) == 2
    for u in found:
        lost = lost_motion(curve.shape, np.linspace(u.start, u.end, 4001))
        assert u.depth == pytest.approx(lost.max(), abs=2e-6)
        assert np.abs(lost[[0, -1]]).max() < 1e-5
        assert lost[1:-1].min() > -1e-6


def test_the_smallest_base_radius():
    growth = max(u.free_at for u in undercuts(breadth(5.0, "modified-sine")))
    assert undercuts(breadth(5.0 + growth + 1e-9, "modified-sine")) == ()
    assert len(undercuts(breadth(5.0 + growth - 1e-9, "modified-sine"))) == 2


@given(
    st.floats(1.0, 30.0),
    st.lists(st.tuples(st.integers(2, 8), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)), min_size=1, max_size=3),
)
@settings(deadline=None, max_examples=examples(20))
def test_growing_by_free_at_just_frees_a_flat_face(mean, terms):
    cos = {k: 8.0 * x / k**1.5 for k, x, _ in terms}
    sin = {k: 8.0 * y / k**1.5 for k, _, y in terms}
    curve = flat(mean, cos, sin)
    at = curve.sample(np.linspace(0.0, TURN, 721))
    assume(abs(np.sum(at.point * at.normal, axis=1).min()) > 1e-3)  # else what is left may be one point
    found = undercuts(curve)
    least = least_radius(curve)[0]
    assert bool(found) == (least < -1e-12)
    if found:
        growth = max(u.free_at for u in found)
        assert growth == pytest.approx(-least, abs=1e-10)
        assert undercuts(flat(mean + growth * (1.0 + 1e-9) + 1e-9, cos, sin)) == ()
        assert not_passed_over(flat(mean + growth * (1.0 - 1e-9) - 1e-9, cos, sin))


def not_passed_over(curve):
    """Whether undercut is found, or refused for the one reason that may hold a part in 1e9 below freedom."""
    try:
        return bool(undercuts(curve))
    except UndercutError as error:
        return "cannot be separated" in str(error)


def test_eight_swallowtails_below_rounding_are_told_apart():
    """Their extent is below what points can tell; speed times tangent over each of them still does."""
    k, mean = 8, 16.414588076454564
    cos, sin = ({k: 8.0 * x / k**1.5} for x in (-0.7434620764152178, -0.966418004796425))
    growth = max(u.free_at for u in undercuts(flat(mean, cos, sin)))
    lack = growth * 1e-9 + 1e-9
    found = undercuts(flat(mean + growth * (1.0 - 1e-9) - 1e-9, cos, sin))
    assert len(found) == k
    bend = k * k * (mean + growth)  # of rho about its least value
    for cut in found:
        assert cut.free_at == pytest.approx(lack, rel=1e-5)
        # rho = bend x^2/2 - lack about the middle: the tail reaches (sqrt 3 - 1)/2 of the reversal beyond its ends
        assert cut.end - cut.start == pytest.approx(2.0 * np.sqrt(6.0 * lack / bend), rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("e", [4.0, 5.0, 8.0])
def test_lobes_too_sharp_for_the_roller(e):
    found = undercuts(roller(STAR, e))
    assert [u.kind for u in found] == ["local"] * len(found)
    t = np.linspace(0.0, TURN, 4001)
    frame = STAR.sample(t)
    tight = (frame.turn > 0.0) & (frame.speed < e * frame.turn)
    for u in found:
        at = STAR.sample(np.array([u.at]))
        assert at.speed[0] / at.turn[0] == pytest.approx(u.free_at, rel=1e-13)
    assert all(within(x, found) for x in t[tight])
    # contact is lost just where the rolling disc would be larger than is free
    reach = rolling_radius(Pitch.of(roller(STAR, e)), t, t + 1e-4).min(axis=1)
    assert [within(x, found, -2e-3) for x in t[reach > 1.001 * e]].count(True) == 0
    assert all(within(x, found, 2e-3) for x in t[reach < 0.999 * e])


@pytest.mark.slow
def test_the_largest_roller_for_a_star():
    largest = min(u.free_at for u in undercuts(roller(STAR, 8.0)))
    assert largest == pytest.approx(least_radius(Curve.whole(STAR))[0], rel=1e-14)
    assert undercuts(roller(STAR, largest * (1.0 - 1e-9))) == ()
    assert len(undercuts(roller(STAR, largest * (1.0 + 1e-9)))) >= 1


@pytest.mark.slow
def test_depth_of_a_roller_is_how_far_it_hangs_free():
    e = 8.0
    curve = roller(STAR, e)
    kept = np.concatenate([curve.sample(np.linspace(r.low, r.high, 400)).point for r in trimmed(curve).runs])
    for u in undercuts(curve):
        apart = STAR.sample(np.linspace(u.start, u.end, 2001)).point[:, None] - kept
        assert u.depth == pytest.approx(np.hypot(apart[..., 0], apart[..., 1]).min(axis=1).max() - e, abs=1e-5)


@pytest.mark.thin(6)
@pytest.mark.parametrize("excess", [1e-9, 1e-6, 1e-3, 0.1, 0.5])
def test_the_neck_of_booths_lemniscate(excess):
    # m^2/l^2 = 0.9: the waist is sqrt(0.2) l, the ends have a radius of 60.06 mm
    waist = 60.0 * math.sqrt(0.2)
    shape = booth(60.0, 60.0 * math.sqrt(0.9))
    assert undercuts(roller(shape, waist * (1.0 - excess))) == ()
    found = undercuts(roller(shape, waist * (1.0 + excess)))
    assert [u.kind for u in found] == ["global", "global"]
    assert [u.at for u in found] == pytest.approx([0.5 * math.pi, 1.5 * math.pi], abs=1e-6)
    for u in found:
        assert u.free_at == pytest.approx(waist, rel=1e-12)
        assert u.start < u.at < u.end
        assert 0.5 * (u.start + u.end) == pytest.approx(u.at, abs=1e-5)
        assert 0.0 <= u.depth < excess * waist


def test_contact_lost_at_a_neck_of_a_lemniscate():
    # symmetric: a position is lost where the contour has crossed the y axis
    shape = booth(60.0, 60.0 * math.sqrt(0.9))
    first, second = undercuts(roller(shape, 40.0))
    corners = roller(shape, 40.0).sample(np.array([first.start, first.end, second.start, second.end])).point
    assert corners[:, 1] == pytest.approx([0.0] * 4, abs=1e-12)
    assert corners[0] == pytest.approx(corners[3], abs=1e-12)
    assert corners[1] == pytest.approx(corners[2], abs=1e-12)


@pytest.mark.thin(2)
@pytest.mark.parametrize("e", [14.0, 16.0, 18.0])
def test_a_neck_off_the_axis_of_symmetry(e):
    found = undercuts(roller(PEAR, e))
    assert [u.kind for u in found] == ["global", "global"]
    frame = PEAR.sample(np.array([u.at for u in found]))
    assert np.hypot(*(frame.point[0] - frame.point[1])) == pytest.approx(2.0 * found[0].free_at, rel=1e-13)


@pytest.mark.slow
def test_both_kinds_at_once():
    found = undercuts(roller(PEAR, 19.0))
    assert [u.kind for u in found] == ["local", "global"]
    assert found[0].start == found[1].start
    assert found[0].free_at == pytest.approx(least_radius(Curve.whole(PEAR))[0], rel=1e-13)
    assert found[1].free_at < found[0].free_at < 19.0
    smallest = min(u.free_at for u in found)
    assert undercuts(roller(PEAR, smallest * (1.0 - 1e-9))) == ()


def test_a_neck_is_reported_beside_sharper_lobes():
    # r = 20 + 10 cos 2t + 2 cos 6t: the waist is 16 mm wide, the ends have the radius 32^2/(32 + 4 * 28) = 7.11 mm
    found = undercuts(roller(waves(20.0, (2, 10.0, 0.0), (6, 2.0, 0.0)), 8.2))
    assert [u.kind for u in found] == ["local", "global", "local", "local"] * 2
    assert [u.free_at for u in found if u.kind == "global"] == pytest.approx([8.0, 8.0], rel=1e-13)
    assert min(u.free_at for u in found) == pytest.approx(1024.0 / 144.0, rel=1e-13)


@given(
    st.lists(st.tuples(st.integers(2, 6), st.floats(-1.0, 1.0), st.floats(0.0, 6.28)), min_size=1, max_size=3),
    st.floats(2.0, 18.0),
)
@settings(deadline=None, max_examples=examples(40))
def test_the_largest_roller_is_the_least_over_all_pairs(terms, e):
    shape = waves(30.0, *((k, 10.0 * a / k, b) for k, a, b in terms))
    t = np.linspace(0.0, TURN, 700, endpoint=False)
    reach = rolling_radius(Pitch.of(roller(shape, e)), t, t)
    np.fill_diagonal(reach, np.inf)
    seen = reach.min()
    assume(abs(seen - e) > 0.02 * e)
    found = undercuts(roller(shape, e))
    assert bool(found) == (seen < e)
    if found:
        assert min(u.free_at for u in found) == pytest.approx(seen, rel=0.02)


@pytest.mark.slow
def test_nothing_left():
    for u in undercuts(roller(STAR, 15.0)) + undercuts(flat(1.0, {3: 2.0})):
        assert u.depth == math.inf
        assert u.end - u.start == pytest.approx(TURN)
    assert undercuts(flat(1.0, {3: 2.0}))[0].free_at == pytest.approx(15.0)
    with pytest.raises(UndercutError):
        trimmed(flat(1.0, {3: 2.0}))


@pytest.mark.slow
def test_where_the_shaft_is_does_not_matter():
    here, there = undercuts(roller(STAR, 8.0)), undercuts(roller(Moved(STAR, (3.0, 2.0)), 8.0))
    assert [u.depth for u in there] == pytest.approx([u.depth for u in here], abs=1e-11)
    assert [u.start for u in there] == pytest.approx([u.start for u in here], abs=1e-12)


def test_necks_wider_than_the_sharpest_place_count_for_nothing_where_that_is_undercut():
    """The waist of this lemniscate, sqrt(250) = 15.811 to either side, is above its least radius, 15.783."""
    shape = booth(15.0, 10.0)
    assert least_radius(Curve.whole(shape))[0] == pytest.approx(15.783, abs=1e-3)
    found = causes(roller(shape, 24.0))
    assert len(found.reversals) == 2
    assert found.necks == ()


def test_parts_of_a_turn_that_are_alike_are_undercut_alike():
    """A motion that repeats three times: each part has the same stretch, a third of a turn on."""
    segments = "[{rise: 9, over: 30, law: cycloidal}, {return: 9, over: 30, law: cycloidal}, {dwell: 60}]"
    cam = f"{{kind: disc, base_radius: 20, motion: {{repeat: 3, segments: {segments}}}}}"
    recipe = f"cam: {cam[:-1]}, undercut: trim, follower: {{kind: roller, radius: 17}}}}"
    (surface,) = load_text(recipe, "cam.yaml").cam.exact().surfaces
    found = undercuts(surface.curve)
    assert surface.curve.shape.repeats == len(found) == 3
    for k in (1, 2):
        later, first = found[k], found[0]
        assert [later.start, later.end, later.at] == pytest.approx(
            [place + k * TURN / 3.0 for place in (first.start, first.end, first.at)], abs=1e-9
        )
        assert later.depth == pytest.approx(first.depth, rel=1e-9)
