"""Every law of the catalogue: published peaks, mpmath's derivatives of its textbook formula, ends, bounds."""

import math
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.law.normalised import IntentError
from kin.law.sources.functions import TwoPoint
from kin.law.sources.laws import _MEMBERS, NAMES, named, scca, sines, split
from kin.law.sources.peaks import peaks
from kin.numeric.elementary import Jet

INF = math.inf

# Peaks (velocity, acceleration, jerk) for unit stroke over unit interval, with the places printed.
# N: R. L. Norton, Cam Design and Manufacturing Handbook, chapter 3 (double dwell) and 4 (SCCA).
# R: H. A. Rothbart, Cam Design Handbook, chapters 2 and 3. F: Freudenstein 1960. G: Gutman 1961, as R prints it.
PUBLISHED = {
    "constant-velocity": ("R", "1.000", "", ""),
    "parabolic": ("N", "2.000", "4.000", ""),
    "harmonic": ("N", "1.571", "4.935", ""),
    "cycloidal": ("N", "2.000", "6.283", "39.478"),
    "modified-trapezoid": ("N", "2.000", "4.888", "61.426"),
    "modified-sine": ("N", "1.760", "5.528", "69.466"),
    "modified-constant-velocity": ("R", "1.28", "8.01", "201.4"),
    "polynomial-345": ("N", "1.875", "5.77", "60.0"),
    "polynomial-4567": ("N", "2.188", "7.51", "52.5"),
    "scca-20": ("N", "1.53", "6.0", ""),
    "scca-33": ("N", "1.40", "6.62", ""),
    "scca-66": ("N", "1.17", "11.0", ""),
    "cycloidal-cv50": ("R", "1.33", "8.38", "105.28"),
    "double-harmonic": ("R", "2.04", "9.87", ""),
    "trapezoid": ("R", "2.0", "5.33", "42.67"),
    "sine-squared": ("R", "2.0", "8.0", "50.27"),
    "polynomial-23": ("R", "1.5", "6.0", ""),
    "cubic": ("R", "3.0", "12.0", ""),
    "freudenstein-13": ("F", "2.0", "5.39", ""),
    "freudenstein-135": ("F", "2.0", "5.06", ""),
    "gutman-13": ("G", "2.0", "5.13", ""),
}
ASYMMETRIC = {"double-harmonic"}
SHARES = st.floats(0.02, 0.9)


def textbook(name, u):
    """s(u) in mpmath as handbooks print it; the second half of laws in two halves by symmetry."""
    u, pi = mp.mpf(u), mp.pi
    if name in {"cubic", "sine-squared", "trapezoid"} and u > mp.mpf(1) / 2:
        return 1 - textbook(name, 1 - u)
    match name:
        case "constant-velocity":
            return u
        case "double-harmonic":
            return (1 - mp.cos(pi * u)) / 2 - (1 - mp.cos(2 * pi * u)) / 8
        case "cubic":
            return 4 * u**3
        case "polynomial-23":
            return 3 * u**2 - 2 * u**3
        case "sine-squared":
            return 2 * u**2 - mp.sin(2 * pi * u) ** 2 / (2 * pi**2)
        case "freudenstein-13":
            return u - 27 / (56 * pi) * (mp.sin(2 * pi * u) + mp.sin(6 * pi * u) / 81)
        case "freudenstein-135":
            series = mp.sin(2 * pi * u) + mp.sin(6 * pi * u) / 54 + mp.sin(10 * pi * u) / 1250
            return u - 1125 / (2384 * pi) * series
        case "gutman-13":
            return u - 15 / (32 * pi) * mp.sin(2 * pi * u) - mp.sin(6 * pi * u) / (96 * pi)
        case "trapezoid":  # jerk 128/3 over the first eighth, then constant 16/3, then jerk -128/3
            j, b = mp.mpf(128) / 3, mp.mpf(1) / 8
            if u <= b:
                return j * u**3 / 6
            x = min(u, 3 * b) - b
            v, s = j * b**2 / 2, j * b**3 / 6
            s, v = s + v * x + j * b * x**2 / 2, v + j * b * x
            if u <= 3 * b:
                return s
            x = u - 3 * b
            return s + v * x + j * b * x**2 / 2 - j * x**3 / 6
    raise AssertionError(name)


WRITTEN = sorted(set(NAMES) - set(_MEMBERS) - {"polynomial-345", "polynomial-4567"})


def test_every_law_has_its_published_peaks():
    assert set(PUBLISHED) == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_peaks_are_the_published_ones(name):
    law = named(name)
    tops = peaks(law.motion)
    ours = tops.velocity, tops.acceleration, tops.jerk
    for figure, text in zip(ours, PUBLISHED[name][1:], strict=True):
        if text:
            places = len(text.partition(".")[2])
            assert figure == pytest.approx(float(text), abs=0.5001 * 10.0**-places)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", NAMES)
def test_peaks_are_reached_and_not_passed(name):
    law = named(name)
    u = np.concatenate([np.linspace(a, b, 20001) for a, b in pairwise(law.motion.knots)])
    reached = np.abs(law.motion.derivatives(u, 3)).max(axis=1)[1:]
    tops = peaks(law.motion)
    told = np.array([tops.velocity, tops.acceleration, tops.jerk])
    finite = np.isfinite(told)
    assert reached[finite] == pytest.approx(told[finite], rel=1e-7)
    assert (reached <= told * (1 + 1e-13)).all()


@pytest.mark.parametrize("name", list(_MEMBERS))
def test_shares_of_a_named_member_give_the_named_law(name):
    assert scca(*_MEMBERS[name]) is named(name)


@pytest.mark.parametrize("name", WRITTEN)
def test_derivatives_to_the_fourth_are_those_of_the_textbook_formula(name):
    motion = named(name).motion
    rng = np.random.default_rng(3)
    with mp.workdps(50):
        for a, b in pairwise(motion.knots):
            for u in rng.uniform(a + 0.05 * (b - a), b - 0.05 * (b - a), 4):
                ours = motion.derivatives(u, 4)[:, 0]
                true = [float(mp.diff(lambda x: textbook(name, x), mp.mpf(u), k)) for k in range(5)]
                scale = [(10 * math.pi) ** k for k in range(5)]
                assert (np.abs(ours - true) <= 1e-14 * np.array(scale)).all()


@pytest.mark.parametrize("name", NAMES)
def test_ends_are_exact_and_joints_smooth(name):
    law = named(name)
    start, end = law.motion.derivatives(0.0, 2)[:, 0], law.motion.derivatives(1.0, 2, -1)[:, 0]
    assert start[0] == 0
    assert end[0] == pytest.approx(1, abs=2.3e-16)
    if name != "constant-velocity":
        assert start[1] == pytest.approx(0, abs=1e-15)
        assert end[1] == pytest.approx(0, abs=1e-15)
    if math.isfinite(peaks(law.motion).jerk):
        assert start[2] == pytest.approx(0, abs=1e-14)
        assert end[2] == pytest.approx(0, abs=1e-14)
    jump = np.abs(law.motion.jumps(2)[1]).max(axis=1, initial=0.0)
    assert jump[0] < 1e-15
    assert jump[1] < 1e-14
    assert jump[2] < 1e-13 or name in {"parabolic", "cubic"}


@given(name=st.sampled_from(NAMES), u=st.floats(0, 1))
def test_laws_are_antisymmetric_about_the_middle(name, u):
    motion = named(name).motion
    total = float(motion.derivatives(u, 0)[0, 0] + motion.derivatives(1 - u, 0)[0, 0])
    if name in ASYMMETRIC:
        assert total == pytest.approx(1 - (1 - math.cos(2 * math.pi * u)) / 4, abs=1e-14)
    else:
        assert total == pytest.approx(1, abs=1e-15)


@given(name=st.sampled_from(NAMES), low=st.floats(0, 1), width=st.floats(0, 0.3))
def test_bounds_enclose_dense_samples(name, low, width):
    motion = named(name).motion
    high = min(low + width, 1.0)
    mid, rad = motion.enclosure(low, high, 4)
    u = np.linspace(low, high, 61)
    for side in (1, -1):
        inner = motion.derivatives(u[1:-1], 4, side) if high > low else motion.derivatives(u, 4, side)
        assert (np.abs(inner - mid) <= rad + 1e-13 * (1 + np.abs(inner))).all()


def closed_form(b, c, x):
    """Norton's Ca, Cv, Cj with the share x of constant velocity."""
    d = 1 - b - c
    ca = 4 * math.pi**2 / ((math.pi**2 - 8) * (b**2 - d**2) - 2 * math.pi * (math.pi - 2) * b + math.pi**2)
    cv = ca * ((b + d) / math.pi + c / 2)
    v = cv / (1 + x * (cv - 1))
    return v, v * ca / (cv * (1 - x)), v / cv * math.pi * ca / min(b, d) / (1 - x) ** 2


@settings(max_examples=examples(40))
@given(b=SHARES, share=SHARES, x=st.one_of(st.just(0.0), st.floats(0.01, 0.9)))
def test_any_member_has_nortons_peaks_and_joins(b, share, x):
    c = (1 - b) * share
    law = scca(b, c, x)
    v, a, j = closed_form(b, c, x)
    found = peaks(law.motion)
    assert (found.velocity, found.acceleration, found.jerk) == pytest.approx((v, a, j), rel=1e-9)
    end = law.motion.derivatives(1.0, 2, -1)[:, 0]
    assert end == pytest.approx([1, 0, 0], abs=1e-9)
    assert np.abs(law.motion.jumps(2)[1]).max() < 1e-9 * a
    # the second half is the image of the first; the middle at constant velocity has its share
    middle = law.motion.derivatives(0.5, 1)[:, 0]
    assert middle == pytest.approx([0.5, v], rel=1e-12)


@pytest.mark.slow
def test_a_member_is_the_integral_of_its_acceleration():
    law, (b, c, x) = scca(0.3, 0.25, 0.2), (0.3, 0.25, 0.2)
    _, peak, _ = closed_form(b, c, x)
    half, d = 0.4, 0.45

    def acceleration(u):
        if u > 0.5:
            return -acceleration(1 - u)
        t = u / half
        if t >= 1:
            return 0.0
        if t < b:
            return peak * math.sin(math.pi * t / (2 * b))
        return peak if t < b + c else peak * math.cos(math.pi * (t - b - c) / (2 * d))

    for u in (0.05, 0.17, 0.3, 0.39, 0.5, 0.77, 0.95):
        assert law.motion.derivatives(u, 2)[2, 0] == pytest.approx(acceleration(u), rel=1e-12, abs=1e-12)
        breaks = [k for k in law.motion.knots.tolist() if k < u] + [u]
        path = mp.quad(lambda t, u=u: (u - t) * acceleration(float(t)), breaks)
        assert law.motion.derivatives(u, 0)[0, 0] == pytest.approx(float(path), abs=1e-13)


@pytest.mark.parametrize(
    ("shares", "message", "field"),
    [
        ((1.2, 0.0, 0.0), "`sine` is a share: 0, or 1e-06 to 1, not 1.2", "law.sine"),
        ((0.7, 0.5, 0.0), "`sine` and `constant` together are at most 1, not 1.2", "law"),
        ((0.25, 0.0, 1.0), "with `velocity: 1` nothing accelerates; the law is `constant-velocity`", "law.velocity"),
        ((0.25, -0.1, 0.0), "`constant` is a share: 0, or 1e-06 to 1, not -0.1", "law.constant"),
    ],
)
def test_shares_out_of_bounds_are_refused(shares, message, field):
    with pytest.raises(IntentError) as caught:
        scca(*shares)
    assert (caught.value.message, caught.value.field) == (message, field)


@given(name=st.sampled_from(sorted(set(NAMES) - ASYMMETRIC)), share=st.floats(0.05, 0.95))
def test_a_split_law_joins_and_keeps_its_velocity(name, share):
    law, whole = split(named(name), share), named(name)
    left, right = law.motion.derivatives(share, 1, -1)[:, 0], law.motion.derivatives(share, 1)[:, 0]
    assert left == pytest.approx(right, abs=1e-13)
    assert left[0] == pytest.approx(share, abs=1e-14)
    assert left[1] == pytest.approx(float(whole.motion.derivatives(0.5, 1)[1, 0]), rel=1e-13)
    assert law.motion.derivatives(1.0, 0, -1)[0, 0] == pytest.approx(1, abs=1e-15)
    u = np.linspace(0.01, 0.99, 7)
    first = law.motion.derivatives(u * share, 2)
    assert first[2] == pytest.approx(whole.motion.derivatives(u / 2, 2)[2] / (2 * share), rel=1e-8, abs=1e-9)


def test_a_law_that_is_not_symmetric_is_not_split():
    with pytest.raises(IntentError, match="double-harmonic is not symmetric"):
        split(named("double-harmonic"), 0.4)
    with pytest.raises(IntentError, match=r"`split` lies between 0.01 and 0.99, not 1"):
        split(named("cycloidal"), 1.0)


def test_harmonics_with_free_weights():
    assert peaks(sines({1: 1.0}, "one").motion).acceleration == pytest.approx(2 * math.pi, rel=1e-15)
    law = sines({1: 0.9, 2: 0.06, 3: 0.04}, "three")
    assert law.motion.derivatives(1.0, 2, -1)[:, 0] == pytest.approx([1, 0, 0], abs=1e-14)


@settings(max_examples=examples(40))
@given(st.lists(st.floats(-5, 5), min_size=6, max_size=6))
def test_polynomials_take_their_values_at_both_ends(values):
    start, end = values[:3], values[3:]
    polynomial = TwoPoint.of((0.0, *start), (1.0, *end))
    assert polynomial(Jet.variable(0.0, 3)).derivatives()[:, 0].tolist() == pytest.approx([0, *start], abs=1e-13)
    assert polynomial(Jet.variable(1.0, 3)).derivatives()[:, 0].tolist() == pytest.approx([1, *end], abs=1e-13)
    # degree 7: the eighth derivative is none
    assert np.abs(polynomial(Jet.variable(np.linspace(0, 1, 5), 8)).derivatives()[8]).max() < 1e-7


def test_boundary_values_at_rest_are_the_named_polynomials():
    u = np.linspace(0, 1, 33)
    for name, zeros in (("polynomial-23", 1), ("polynomial-345", 2), ("polynomial-4567", 3)):
        rest = (0.0,) * zeros
        polynomial = TwoPoint.of((0.0, *rest), (1.0, *rest))
        assert polynomial(Jet.variable(u, 2)).derivatives() == pytest.approx(
            named(name).motion.derivatives(u, 2), abs=1e-13
        )


def test_an_unknown_law_is_refused_with_the_nearest():
    with pytest.raises(IntentError, match=r"no law is called 'gutmann-13'; did you mean gutman-13\? \(laws: constant"):
        named("gutmann-13")
