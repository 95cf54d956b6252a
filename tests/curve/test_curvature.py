"""The least radius and the reversals, against closed forms and a multiprecision oracle."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.programmes import Segment, law, programme
from support.shapes import booth

from camgeo.curve.backwards import Backwards
from camgeo.curve.curvature import LOOSE, Reversal, enclosed_least_radius, least_radius, reversals, roots
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.curve.support import SupportShape
from camgeo.curve.wunderlich import PitchShape
from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula
from kin.law.support_function import lift_constant_breadth, lift_from_fourier, lift_reuleaux
from kin.law.transmission import from_arc


def flat(mean, cos, sin=None):
    return Curve.whole(SupportShape(lift_from_fourier(mean, cos, sin or {})))


def breadth(base, name):
    """SW section 5 on another base radius: 20 mm in 120 degrees, dwell 60."""
    motion = [Segment("rise", math.radians(120), 20.0, law(name)), Segment("dwell", math.radians(60))]
    return Curve.whole(SupportShape(lift_constant_breadth(base, programme(motion, math.pi))))


@given(st.floats(1.0, 100.0), st.floats(1e-9, 1.0), st.integers(2, 40))
@settings(deadline=None, max_examples=examples(40))
def test_one_harmonic_has_its_least_radius_at_the_crest(mean, share, k):
    b = share * mean / (k * k - 1)
    value, at = least_radius(flat(mean, {k: b}))
    assert value == pytest.approx(mean - b * (k * k - 1), abs=1e-13 * mean)
    if share > 1e-3:
        assert math.cos(k * at) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("k", range(3))
def test_several_harmonics_agree_with_mpmath(k):
    cos, sin = [({3: 2.0, 7: 0.05}, {5: 0.1}), ({2: 1.0}, {3: 1.0, 11: 0.02}), ({5: 0.3, 6: 0.3, 7: 0.3}, {})][k]

    def radius(t, order=0):
        turn = mpmath.pi / 2 * order
        terms = [(n, a, 0) for n, a in cos.items()] + [(n, a, -mpmath.pi / 2) for n, a in sin.items()]
        series = sum(a * (1 - n * n) * mpmath.mpf(n) ** order * mpmath.cos(n * t + b + turn) for n, a, b in terms)
        return series + (25 if order == 0 else 0)

    grid = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    slopes = [float(radius(mpmath.mpf(t), 1)) for t in grid]
    starts = [i for i in range(400) if slopes[i - 1] < 0 <= slopes[i]]
    exact = min(
        radius(mpmath.findroot(lambda t: radius(t, 1), (grid[i] - 2 * np.pi / 400, grid[i]), solver="anderson"))
        for i in starts
    )
    value, _ = least_radius(flat(25.0, cos, sin))
    assert value == pytest.approx(float(exact), rel=1e-13)


@pytest.mark.parametrize("m2", [300.0, 1200.0, 1800.0, 2880.0])
def test_booths_lemniscate_is_bent_most_at_its_ends(m2):
    # at t = 0: r r'' = -4 m^2, kappa = (r^2 + 4 m^2)/r^3
    r2 = 2.0 * (3600.0 + m2)
    value, at = least_radius(Curve.whole(booth(60.0, math.sqrt(m2))))
    assert value == pytest.approx(r2**1.5 / (r2 + 4.0 * m2), rel=1e-13)
    assert math.sin(at) == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("e", [8.0, 45.0, 70.0])
def test_a_parallel_curve_has_so_much_less(e):
    shape = booth(60.0, 40.0)
    value, _ = least_radius(Curve.whole(shape))
    inside, _ = least_radius(Curve.whole(Parallel(shape, e)))
    assert inside == pytest.approx(value - e, abs=1e-12)


def test_concave_stretches_do_not_count():
    # at the waist the curve is hollow with the radius -r^3/(4 m^2 - r^2), far below 0
    value, _ = least_radius(Curve.whole(booth(60.0, math.sqrt(2880.0))))
    assert value > 59.0


@pytest.mark.parametrize("share", [1e-4, 0.01, 0.3])
def test_a_hollow_run_through_the_other_way_is_proved_however_little_it_turns(share):
    # as the cutter sees it; the turn is far below 1 where the hollow is shallow, and the proof wants finer intervals
    m2 = 1200.0 * (1.0 + share)
    r2 = 2.0 * (3600.0 - m2)
    value, _ = least_radius(Curve.whole(Backwards(booth(60.0, math.sqrt(m2)))))
    assert value == pytest.approx(r2**1.5 / (4.0 * m2 - r2), rel=1e-10)


def test_one_sided_limits_at_a_jump_count():
    # parabolic, rb + S + S'' with S = h/2 and S'' = -4 h/beta^2 just after mid-stroke
    value, at = least_radius(breadth(5.0, "parabolic"))
    assert value == pytest.approx(5.0 + 10.0 - 80.0 / math.radians(120) ** 2, abs=1e-13)
    assert at == pytest.approx(math.radians(60), abs=1e-12)


@pytest.mark.parametrize("rounding", [5.0, 0.01])
def test_a_rounded_corner_is_the_least_radius(rounding):
    value, _ = least_radius(Curve.whole(SupportShape(lift_reuleaux(5, 50.0, rounding))))
    assert value == pytest.approx(rounding, abs=1e-14)


@pytest.mark.parametrize("e", [8.0, 30.0, 80.0])
def test_a_circular_first_arc(e):
    # W Figure 5: the pitch curve begins with an arc of 75 mm, run along at a changing speed
    pitch = Curve.whole(PitchShape(from_arc(3, 1, 60.0, 75.0, "convex")))
    least, at = least_radius(pitch)
    inside, _ = least_radius(Curve.whole(Parallel(pitch.shape, e)))
    assert inside == pytest.approx(least - e, abs=1e-11)
    frame = pitch.sample(np.array([at]))
    assert frame.speed[0] / frame.turn[0] == pytest.approx(least, rel=1e-12)
    dense = pitch.sample(np.linspace(0.0, 2.0 * np.pi, 20_001))
    assert least <= (dense.speed / dense.turn)[dense.turn > 0.0].min() + 1e-12


@pytest.mark.parametrize("radius", [4.0, 10.0])
def test_an_arc_too_tight_for_the_roller(radius):
    # a convex arc of the pitch curve that turns inside out still counts, and a hollow one of that sign does not
    base = SupportShape(lift_reuleaux(3, 50.0, radius))
    value, at = least_radius(Curve.whole(Parallel(base, 12.0)))
    assert value == pytest.approx(radius - 12.0, abs=1e-13)
    assert base.sample(np.array([at])).speed[0] == pytest.approx(radius)


@pytest.mark.parametrize("place", [0.1, 2.345, 5.0])
def test_a_narrow_dip_is_not_missed(place):
    # rho falls from 20 by 22 within a few thousandths of a radian, the curve's other 6.28 are a circle
    bell = f"20 + 2.2e-4*exp(1e5*(cos(t - {place}) - 1))"
    curve = Curve.whole(SupportShape(lift_from_formula(Formula(bell))))
    value, at = least_radius(curve)
    assert value == pytest.approx(20.0 + 2.2e-4 - 22.0, abs=1e-9)
    assert at == pytest.approx(place, abs=1e-7)
    (found,) = reversals(curve)
    assert found.start < place < found.end < found.start + 0.01


@given(st.floats(-12.0, -1.0), st.sampled_from([2, 3, 5, 8]), st.floats(0.1, 50.0))
@settings(deadline=None, max_examples=examples(40))
def test_margins_are_decided_on_both_sides(exponent, k, b):
    size = b * (k * k - 1)
    margin = 10.0**exponent * size
    sound, backwards = flat(size + margin, {k: b}), flat(size - margin, {k: b})
    assert least_radius(sound)[0] > 0.0
    assert reversals(sound) == ()
    assert least_radius(backwards)[0] < 0.0
    found = reversals(backwards)
    assert len(found) == k
    half = math.asin(math.sqrt(margin / size / 2.0)) * 2.0 / k  # cos k t = 1 - margin/size
    for i, r in enumerate(found):
        assert not r.still
        assert r.end - r.start == pytest.approx(2.0 * half, rel=1e-2 if exponent < -11 else 2e-3)
        crest = 2.0 * math.pi / k * (i + 1)
        assert 0.5 * (r.start + r.end) == pytest.approx(crest, abs=1e-4 * half)


def test_ends_of_a_reversal_are_roots_to_the_last_digits():
    for found, crest in zip(reversals(flat(7.0, {3: 1.0})), (1, 2, 3), strict=True):
        half = math.acos(7.0 / 8.0) / 3.0
        assert found.start == pytest.approx(crest * 2 * math.pi / 3 - half, abs=4e-15)
        assert found.end == pytest.approx(crest * 2 * math.pi / 3 + half, abs=4e-15)


def test_a_reversal_may_begin_at_a_jump():
    first, _ = reversals(breadth(5.0, "parabolic"))
    assert first.start == math.radians(60)
    assert not first.still


def test_a_corner_stands_still_and_does_not_run_backwards():
    found = reversals(Curve.whole(SupportShape(lift_reuleaux(3, 50.0, 0.0))))
    assert [r.still for r in found] == [True] * 3
    assert [r.end - r.start for r in found] == pytest.approx([math.pi / 3] * 3)


@pytest.mark.slow
def test_a_roller_as_large_as_an_arc_leaves_it_one_point():
    shape = Parallel(PitchShape(from_arc(3, 1, 60.0, 75.0, "convex")), 75.0)
    found = reversals(Curve.whole(shape))
    still = [r for r in found if r.still]
    assert len(still) == 3
    assert all(r.start in shape.breaks for r in still)


def test_all_backwards_is_one_reversal():
    shape = SupportShape(lift_from_fourier(-3.0, {3: 0.1}, {}))
    assert reversals(Curve.whole(shape)) == (Reversal(0.0, 2.0 * math.pi, still=False),)


@pytest.mark.slow
def test_lobes_that_are_almost_circles_are_enclosed():
    """Booth's lemniscate next to its fold: an enclosure where a sharp proof would divide without end, told as such."""
    thin = 1e-6
    curve = Curve.whole(booth(60.0, 60.0 * math.sqrt(1.0 - thin)))
    found = enclosed_least_radius(curve)
    assert 0.0 < found.excess <= 1.01 * LOOSE * 120.0
    assert least_radius(curve)[0] == found.radius - found.excess
    with mpmath.workdps(40):

        def radius(t):
            r, slope, bend = mpmath.taylor(
                lambda x: 60 * mpmath.sqrt(2 * (1 + (1 - mpmath.mpf(thin)) * mpmath.cos(2 * x))), t, 2
            )
            return (r**2 + slope**2) ** 1.5 / (r**2 + 2 * slope**2 - 2 * r * bend)

        seen = float(min(radius(mpmath.mpf(t)) for t in np.linspace(0.0, 1.5, 31)))
    assert found.radius - found.excess <= seen
    assert found.radius == pytest.approx(seen, abs=1e-12 * 120.0)


@pytest.mark.slow
def test_no_enclosure_is_wide_where_the_sign_is_in_doubt():
    """A roller as large as those circles but for a few parts in 1e10: proved sharply, or not at all."""
    pitch = booth(60.0, 60.0 * math.sqrt(1.0 - 1e-3))
    least = least_radius(Curve.whole(pitch))[0]
    for share in (-1e-10, 1e-10):
        found = enclosed_least_radius(Curve.whole(Parallel(pitch, least * (1.0 + share))))
        assert found.excess == 0.0
        assert found.radius == pytest.approx(-share * least, rel=0.05)


@given(st.floats(1e-15, 0.5), st.integers(1, 40), st.booleans(), st.floats(-9.0, 9.0))
@example(1e-12, 2, False, 0.0)
@example(1e-12, 20, True, 0.0)
@settings(deadline=None)
def test_roots_are_enclosed_however_flat_the_function(low, power, turned, shift):
    """u^k = a: steps of the false position from the flat end are far smaller than the way to the root."""
    root = low ** (1.0 / power)

    def f(x):
        u = shift + 1.0 - x if turned else x - shift
        return u**power - low

    ends = np.array([shift]), np.array([shift + 1.0])
    found = roots(f, *ends, (f(ends[0]), f(ends[1])), 1e-12)[0]
    assert (shift + 1.0 - found if turned else found - shift) == pytest.approx(
        root, abs=1e-12 + 1e-14 * abs(shift) + 1e-9 * root
    )
