"""The contour that undercut leaves, against closed forms, shapely's erosion and the convex hull of the dual curve."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.heavy import shapely
from support.programmes import Segment, law, programme
from support.shapes import PEAR, STAR, Moved, booth, waves

from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.curve.support import SupportShape
from camgeo.curve.undercut.causes import UndercutError, causes
from camgeo.curve.undercut.self_intersection import all_breaks
from camgeo.curve.undercut.trim import remains, trimmed
from camgeo.curve.wunderlich import PitchShape
from camgeo.fit.arcs import fit_arcs
from camgeo.fit.polygon import fit_polygon
from camgeo.fit.spline import fit_spline
from kin.law.support_function import lift_constant_breadth, lift_from_fourier, lift_reuleaux
from kin.law.transmission import from_law

TURN = 2.0 * math.pi


def flat(mean, cos, sin=None, pivot=(0.0, 0.0)):
    return Curve.whole(SupportShape(lift_from_fourier(mean, cos, sin or {}, pivot)))


def roller(shape, e):
    return Curve.whole(Parallel(shape, e))


def breadth(base, name):
    motion = [Segment("rise", math.radians(120), 20.0, law(name)), Segment("dwell", math.radians(60))]
    return Curve.whole(SupportShape(lift_constant_breadth(base, programme(motion, math.pi))))


def outline(curve, count=6000):
    """Fine polygon (n, 2) through the runs, each corner once."""
    points = []
    for run in curve.runs:
        steps = max(30, math.ceil(count * (run.high - run.low) / TURN))
        points.append(curve.sample(np.linspace(run.low, run.high, steps)[:-1]).point)
    return np.concatenate(points)


def area(curve):
    """Half the integral of (c.N) sigma over the runs, by Gauss's rule: exact to rounding."""
    x, w = np.polynomial.legendre.leggauss(24)
    total = 0.0
    for run in curve.runs:
        for low, high in run.stretches:
            knots = np.linspace(low, high, max(2, math.ceil((high - low) / 0.1)))
            half = 0.5 * np.diff(knots)[:, None]
            at = curve.sample((0.5 * (knots[1:] + knots[:-1])[:, None] + half * x).ravel())
            total += 0.5 * np.sum((half * w).ravel() * at.speed * np.sum(at.point * at.normal, axis=1))
    return total


def check_chain(whole, curve):
    """Runs meet, run forward, turn left in their corners, list the breaks inside them, and go once round the shaft."""
    for run, following in zip(curve.runs, curve.runs[1:] + curve.runs[:1], strict=True):
        end, start = curve.sample(np.array([run.high]), -1), curve.sample(np.array([following.low]), 1)
        assert end.point[0] == pytest.approx(start.point[0], abs=1e-12 * np.abs(end.point).max() + 1e-13)
        turn = end.tangent[0, 0] * start.tangent[0, 1] - end.tangent[0, 1] * start.tangent[0, 0]
        assert turn > 0.0
        assert run.low < run.high
        assert not run.closed
        assert run.breaks == tuple(all_breaks(whole, run.low, run.high))
        assert (curve.sample(np.linspace(run.low, run.high, 50)[1:-1]).speed > 0.0).all()
    lows = [run.low for run in curve.runs]
    assert lows == sorted(lows)
    assert curve.runs[-1].high - curve.runs[0].low <= TURN
    assert all(a.high < b.low for a, b in zip(curve.runs, curve.runs[1:], strict=False))
    polygon = shapely.Polygon(outline(curve))
    assert polygon.is_valid
    assert polygon.exterior.is_ccw
    assert polygon.contains(shapely.Point(0.0, 0.0))


def dual_body(shape, count=20_000):
    """Intersection of the half planes x.u <= p, from the convex hull of the dual points u/p."""
    at = shape.sample(np.linspace(0.0, TURN, count, endpoint=False))
    dual = at.normal / np.sum(at.point * at.normal, axis=1)[:, None]
    hull = np.array(shapely.MultiPoint(dual).convex_hull.exterior.coords)[:-1]
    a, b = hull, np.roll(hull, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return shapely.Polygon(np.column_stack([b[:, 1] - a[:, 1], a[:, 0] - b[:, 0]]) / cross[:, None])


def eroded(shape, e, count=20_000):
    pitch = shapely.Polygon(shape.sample(np.linspace(0.0, TURN, count, endpoint=False)).point)
    return pitch.buffer(-e, quad_segs=256)


def check_same(curve, body, within):
    assert isinstance(body, shapely.Polygon)
    assert area(curve) == pytest.approx(body.area, abs=within * body.length)
    assert shapely.Polygon(outline(curve)).hausdorff_distance(body) < 3.0 * within


def test_a_sound_curve_is_returned_as_it_is():
    for curve in (flat(25.0, {3: 2.0}), roller(booth(60.0, 30.0), 8.0), flat(8.0 + 1e-9, {3: 1.0})):
        assert trimmed(curve) is curve


@pytest.mark.parametrize("a", [15.9, 15.0, 10.0, 4.0, 2.1])
def test_three_corners_in_closed_form(a):
    # p = a + 2 cos 3t: the corners lie on the axes of symmetry, where p sin t + p' cos t = 0
    corner = mpmath.findroot(
        lambda t: ((a + 2 * mpmath.cos(3 * t)) * mpmath.sin(t) - 6 * mpmath.sin(3 * t) * mpmath.cos(t)) / t**3,
        (mpmath.acos(mpmath.mpf(a) / 16) / 3, mpmath.mpf(1.05)),
        solver="anderson",
    )
    whole = flat(a, {3: 2.0})
    curve = trimmed(whole)
    check_chain(whole, curve)
    assert [run.low for run in curve.runs] == pytest.approx(
        [float(corner) + k * TURN / 3 for k in (1, 2, 3)], abs=1e-12
    )
    assert [run.high for run in curve.runs] == pytest.approx(
        [float(-corner) + k * TURN / 3 for k in (2, 3, 4)], abs=1e-12
    )


@given(
    st.floats(12.0, 30.0),
    st.lists(st.tuples(st.integers(2, 8), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)), min_size=1, max_size=3),
)
@settings(deadline=None, max_examples=examples(40))
def test_flat_faces_leave_the_body_of_their_half_planes(mean, terms):
    cos = {k: 8.0 * x / k**1.5 for k, x, _ in terms}
    sin = {k: 8.0 * y / k**1.5 for k, _, y in terms}
    whole = flat(mean, cos, sin)
    p = whole.sample(np.linspace(0.0, TURN, 500))
    assume(np.sum(p.point * p.normal, axis=1).min() > 1.0)
    curve = trimmed(whole)
    assert area(curve) == pytest.approx(dual_body(whole.shape, 8000).area, rel=1e-5)
    if curve is not whole:
        check_chain(whole, curve)


@pytest.mark.slow
@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("mean", "cos", "sin", "backwards", "left"),
    [
        (16.0, {5: 2.5}, {8: 0.7}, 6, 5),
        (15.0, {5: 2.3}, {8: 2.4}, 8, 7),
        (12.0, {3: 2.5}, {8: 0.3}, 5, 4),
    ],
)
def test_swallowtails_that_run_into_each_other(mean, cos, sin, backwards, left):
    # a stretch between two reversals is cut away whole, by those beyond them
    whole = flat(mean, cos, sin)
    assert len(causes(whole).reversals) == backwards
    curve = trimmed(whole)
    assert len(curve.runs) == left
    check_chain(whole, curve)
    check_same(curve, dual_body(whole.shape), 2e-5)


@pytest.mark.slow
@pytest.mark.parametrize("name", few(["parabolic", "harmonic", "modified-sine", "polynomial-345"], 4))
def test_curvature_that_jumps(name):
    whole = breadth(1.0, name)
    curve = trimmed(whole)
    check_chain(whole, curve)
    check_same(curve, dual_body(whole.shape), 2e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("shape", "e"), [(STAR, e) for e in (4.0, 5.0, 8.0, 12.0)])
def test_rollers_leave_the_eroded_body(shape, e):
    whole = roller(shape, e)
    curve = trimmed(whole)
    check_chain(whole, curve)
    check_same(curve, eroded(shape, e), 2e-4)


@pytest.mark.slow
@pytest.mark.thin(3)
@pytest.mark.parametrize("e", [19.0, 19.3, 19.6])
def test_a_bulb_too_small_for_the_roller_goes_with_its_neck(e):
    # both the bulb's end and the neck are too tight: one stretch is lost, and one corner left
    whole = roller(PEAR, e)
    why = causes(whole)
    assert len(why.reversals) == len(why.necks) == 1
    curve = trimmed(whole)
    assert len(curve.runs) == 1
    assert not curve.closed
    check_chain(whole, curve)
    check_same(curve, eroded(PEAR, e), 1e-3)


@given(
    st.lists(st.tuples(st.integers(2, 6), st.floats(-1.0, 1.0), st.floats(0.0, 6.28)), min_size=1, max_size=3),
    st.floats(2.0, 18.0),
)
@settings(deadline=None, max_examples=examples(40))
def test_any_star_is_eroded_or_refused(terms, e):
    shape = waves(30.0, *((k, 10.0 * a / k, b) for k, a, b in terms))
    whole = roller(shape, e)
    body = eroded(shape, e, 6000)
    # leave out what hangs by a thread or is about to vanish
    assume(eroded(shape, e + 0.02, 6000).geom_type == eroded(shape, e - 0.02, 6000).geom_type)
    if isinstance(body, shapely.MultiPolygon) or body.area < 1.0 or not body.contains(shapely.Point(0, 0)):
        with pytest.raises(UndercutError):
            trimmed(whole)
        return
    curve = trimmed(whole)
    assert area(curve) == pytest.approx(body.area, abs=2e-3 * body.length)


@pytest.mark.thin(2)
@pytest.mark.parametrize("e", [8.0, 10.0, 12.0])
def test_no_contact_cuts_into_what_is_left(e):
    curve = trimmed(roller(STAR, e))
    t = np.linspace(0.0, TURN, 3000)
    pitch = STAR.sample(t).point
    apart = outline(curve, 1000)[:, None] - pitch[None]
    assert np.hypot(apart[..., 0], apart[..., 1]).min() > e - 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("e", [0.5, 20.0])
def test_rises_that_turn_the_tangent_within_a_hair(e):
    """A thousandth of a degree over a hundredth: the contour of a large roller swings to and fro by millimetres."""
    rise = [Segment(way, math.radians(0.01), math.radians(0.001), law("cycloidal")) for way in ("rise", "return")]
    rest = Segment("dwell", math.pi / 6.0 - math.radians(0.01))
    pitch = PitchShape(from_law(3, 1, 60.0, programme([rise[0], rest, rise[1], rest], math.pi / 3.0)))
    whole = Curve.whole(Parallel(pitch, e))
    what = remains(whole, causes(whole))
    assert len(what.lost) == 12
    assert what.pieces == 1
    centres = pitch.sample(np.array(whole.runs[0].breaks)).point
    fine = np.concatenate([np.linspace(a, b, 4001) for a, b in whole.runs[0].stretches])
    path = np.concatenate([centres, pitch.sample(fine).point])
    for lost in what.lost:
        distance = np.hypot(*(path - lost.corners[0]).T)
        # both rollers that make the corner touch it, no other comes nearer
        assert distance.min() == pytest.approx(e, abs=2e-7)
        ends = pitch.sample(np.array([lost.start, lost.end])).point
        assert np.hypot(*(ends - lost.corners[0]).T) == pytest.approx([e, e], abs=1e-12)
        assert 0.0 < lost.depth < 0.0011  # no more than the rise


@pytest.mark.slow
def test_corners_of_radius_zero_are_corners():
    whole = Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 0.0, (3.0, 1.0))))
    curve = trimmed(whole)
    check_chain(whole, curve)
    assert area(curve) == pytest.approx(0.5 * (math.pi - math.sqrt(3.0)) * 2500.0, rel=1e-13)


@pytest.mark.thin(3)
@pytest.mark.parametrize("margin", [1e-5, 1e-8, 1e-11])
def test_what_is_lost_in_rounding_is_trimmed_all_the_same(margin):
    whole = flat(8.0 - margin, {3: 1.0}, pivot=(1.0, 0.5))
    curve = trimmed(whole)
    assert len(curve.runs) == 3
    assert sum(run.high - run.low for run in curve.runs) == pytest.approx(
        TURN - 6.0 * math.sqrt(3.0) * math.acos(1.0 - margin / 8.0) / 3.0, abs=1e-3 * math.sqrt(margin)
    )


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("curve", "message"),
    [
        (roller(PEAR, 15.0), "the undercut divides the metal into 2 pieces"),
        (roller(booth(60.0, 58.0), 45.0), "the undercut divides the metal into 2 pieces"),
        (roller(PEAR, 21.0), "the shaft lies outside of what the undercut leaves"),
        (flat(10.0, {3: 2.0}, pivot=(-9.0, 0.0)), "the shaft lies outside of what the undercut leaves"),
        (roller(STAR, 14.0), "the undercut leaves nothing of the contour"),
        (flat(1.0, {3: 2.0}), "the undercut leaves nothing of the contour"),
    ],
)
def test_what_cannot_be_trimmed_is_refused(curve, message):
    with pytest.raises(UndercutError) as caught:
        trimmed(curve)
    assert str(caught.value) == message
    assert caught.value.parameter is not None


def test_only_convex_faces():
    with pytest.raises(ValueError, match="a flat face cannot touch the concave part near parameter"):
        trimmed(Curve.whole(STAR))


def test_a_neck_leaves_two_corners_and_two_pieces():
    curve = roller(PEAR, 15.0)
    what = remains(curve, causes(curve))
    assert what.pieces == 2
    assert [lost.corners.shape for lost in what.lost] == [(2, 2), (2, 2)]
    body = eroded(PEAR, 15.0)
    assert len(body.geoms) == 2
    for corner in what.corners:
        assert body.boundary.distance(shapely.Point(corner.point)) < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("shift", [0.0, 1.0, 2.5, 4.0])
def test_the_origin_of_the_parameter_does_not_matter(shift):
    turned = waves(20.0, (5, 5.0, 5 * shift), (2, 2.0, np.pi / 2 + 2 * shift))
    straight, about = trimmed(roller(STAR, 8.0)), trimmed(roller(turned, 8.0))
    ends = sorted((run.low - shift) % TURN for run in about.runs)
    assert ends == pytest.approx(sorted(run.low % TURN for run in straight.runs), abs=1e-11)
    assert area(about) == pytest.approx(area(straight), rel=1e-12)


CASES = {
    "wave": flat(15.0, {3: 2.0}),
    "deep": flat(10.0, {3: 2.0}),
    "hair": flat(8.0 - 1e-9, {3: 1.0}),
    "jumps": breadth(5.0, "parabolic"),
    "corners": Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 0.0))),
    "star": roller(STAR, 8.0),
    "pear": roller(PEAR, 19.0),
}


def distance(curve, points):
    """Distance of points (n, 2) from a chain: Newton's method in each half of each run, from the nearest of many."""
    least = np.full(len(points), np.inf)
    for run in curve.runs:
        middle = 0.5 * (run.low + run.high)
        for low, high, side in ((run.low, middle, 1), (middle, run.high, -1)):
            t = np.linspace(low, high, 150)
            apart = points[:, None] - curve.sample(t).point
            t = t[np.argmin(np.einsum("nmi,nmi->nm", apart, apart), axis=1)]
            for _ in range(20):
                at = curve.sample(t, side)
                apart = points - at.point
                along, across = np.sum(apart * at.tangent, axis=1), np.sum(apart * at.normal, axis=1)
                t = np.clip(t + along / np.maximum(at.speed + at.turn * across, 0.5 * at.speed), low, high)
            least = np.minimum(least, np.hypot(*(points - curve.sample(t).point).T))
    return least


def on_arcs(arcs, count=12):
    """Points on every arc (m, 2), from the sagitta so that nearly straight ones keep their digits."""
    start, end = arcs.points, np.roll(arcs.points, -1, axis=0)
    chord, half = end - start, 2.0 * np.arctan(arcs.bulges)
    right = np.column_stack([chord[:, 1], -chord[:, 0]])
    s = np.linspace(-1.0, 1.0, count)[:, None]
    bent = np.abs(half) > 1e-9
    sine = np.sin(np.where(bent, half, 1.0))
    along = np.where(bent, np.sin(s * half) / sine, s)
    away = np.where(bent, (np.cos(s * half) - np.cos(half)) / sine, 0.0)
    return (0.5 * (start + end) + 0.5 * along[..., None] * chord + 0.5 * away[..., None] * right).reshape(-1, 2)


def on_edges(polygon, count=8):
    u = np.linspace(0.0, 1.0, count)[:, None, None]
    v = polygon.vertices
    return (v + u * (np.roll(v, -1, axis=0) - v)).reshape(-1, 2)


def on_spans(spline, count=24):
    u = np.linspace(0.0, 1.0, count)[:, None, None]
    p = spline.beziers()
    bezier = (1 - u) ** 3 * p[:, 0] + 3 * u * (1 - u) ** 2 * p[:, 1] + 3 * u**2 * (1 - u) * p[:, 2] + u**3 * p[:, 3]
    return bezier.reshape(-1, 2)


FITS: dict[str, tuple[Any, Any]] = {
    "polygon": (fit_polygon, on_edges),
    "arcs": (fit_arcs, on_arcs),
    "spline": (fit_spline, on_spans),
}


@pytest.mark.thin(20)
@pytest.mark.parametrize("form", few(FITS, 3))
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_fits_keep_the_corners_and_their_promise(case, form, tolerance):
    curve = trimmed(CASES[case])
    fit, on = FITS[form]
    fitted = fit(curve, tolerance)
    assert fitted.bound.worst <= tolerance
    points = on(fitted)
    assert distance(curve, points).max() <= fitted.bound.worst + 1e-11
    for corner in curve.sample(np.array([run.low for run in curve.runs])).point:
        assert np.hypot(*(points - corner).T).min() < 1e-11


@pytest.mark.slow
def test_a_moved_shaft_moves_nothing_else():
    whole, moved = roller(STAR, 8.0), roller(Moved(STAR, (2.0, -1.0)), 8.0)
    assert [r.low for r in trimmed(whole).runs] == pytest.approx([r.low for r in trimmed(moved).runs], abs=1e-12)
