"""Motion laws against published peaks and textbook formulas; motion programmes."""

import math
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.programmes import Segment, law, programme

from kin.law.normalised import AcceleratedPiece, IntentError, polynomial_law
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch
from kin.law.sources.laws import named
from kin.law.sources.peaks import peaks
from kin.numeric.elementary import BallJet, Jet

# Rothbart, Cam Design Handbook (2004), chapters 2, 3: peak velocity, acceleration, jerk for unit stroke and interval.
PUBLISHED = {
    "parabolic": (2.0, 4.0, math.inf),
    "harmonic": (math.pi / 2, math.pi**2 / 2, math.inf),
    "cycloidal": (2.0, 2 * math.pi, 4 * math.pi**2),
    "modified-trapezoid": (2.0, 8 * math.pi / (math.pi + 2), 32 * math.pi**2 / (math.pi + 2)),
    "modified-sine": (
        4 * math.pi / (math.pi + 4),
        4 * math.pi**2 / (math.pi + 4),
        16 * math.pi**3 / (math.pi + 4),
    ),
    "polynomial-345": (1.875, 10 / math.sqrt(3), 60.0),
    "polynomial-4567": (2.1875, 7.513188, 52.5),
    "modified-constant-velocity": (1.275258, 8.012683, 201.3807),
}
DECIMALS = {"polynomial-4567": 6, "modified-constant-velocity": 4}  # printed with so many; the others are closed forms

NAMES = st.sampled_from(sorted(PUBLISHED))
UNIT = st.floats(0, 1)


def textbook(name, u):
    """s(u) in mpmath, each law's own formula as handbooks print it; the second half of long ones by symmetry."""
    u = mp.mpf(u)
    pi, half = mp.pi, mp.mpf(1) / 2
    mirrored = {"parabolic", "modified-trapezoid", "modified-constant-velocity"}
    if name in mirrored and u > half:
        return 1 - textbook(name, 1 - u)
    match name:
        case "parabolic":
            return 2 * u**2
        case "harmonic":
            return (1 - mp.cos(pi * u)) / 2
        case "cycloidal":
            return u - mp.sin(2 * pi * u) / (2 * pi)
        case "modified-sine":
            if u < mp.mpf(1) / 8:
                return (pi * u - mp.sin(4 * pi * u) / 4) / (4 + pi)
            if u < mp.mpf(7) / 8:
                return (2 + pi * u - mp.mpf(9) / 4 * mp.sin(4 * pi * u / 3 + pi / 3)) / (4 + pi)
            return (4 + pi * u - mp.sin(4 * pi * u) / 4) / (4 + pi)
        case "modified-trapezoid":
            if u < mp.mpf(1) / 8:
                return (2 * u - mp.sin(4 * pi * u) / (2 * pi)) / (2 + pi)
            if u < mp.mpf(3) / 8:
                return (4 * pi * u**2 + (2 - pi) * u + pi / 16 - 1 / (2 * pi)) / (2 + pi)
            return (2 * (1 + pi) * u - mp.sin(4 * pi * u - pi) / (2 * pi) - pi / 2) / (2 + pi)
        case "modified-constant-velocity":
            # quarter sine over 1/16, quarter cosine over 3/16, then constant velocity to the middle
            a = 16 * pi**2 / (5 * pi + 4)
            if u < mp.mpf(1) / 16:
                return a / (8 * pi) * (u - mp.sin(8 * pi * u) / (8 * pi))
            x = u - mp.mpf(1) / 16
            begin = a / (8 * pi) * (mp.mpf(1) / 16 - 1 / (8 * pi))
            if u < mp.mpf(1) / 4:
                k = 8 * pi / 3
                return begin + a / (8 * pi) * x + a / k**2 * (1 - mp.cos(k * x))
            return half + a / (2 * pi) * (u - half)
        case "polynomial-345":
            return 10 * u**3 - 15 * u**4 + 6 * u**5
        case "polynomial-4567":
            return 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7
    raise AssertionError(name)


@pytest.mark.parametrize("name", sorted(PUBLISHED))
def test_peaks_are_the_published_ones(name):
    tops = peaks(named(name).motion)
    ours = (tops.velocity, tops.acceleration, tops.jerk)
    if name in DECIMALS:
        assert ours == pytest.approx(PUBLISHED[name], abs=0.5000001 * 10.0 ** -DECIMALS[name])
    else:
        assert ours == pytest.approx(PUBLISHED[name], rel=4e-16)


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", sorted(PUBLISHED))
def test_every_derivative_is_that_of_the_textbook_formula(name):
    motion = named(name).motion
    rng = np.random.default_rng(4)
    with mp.workdps(60):
        for a, b in pairwise(motion.knots):
            for u in rng.uniform(a + 0.05 * (b - a), b - 0.05 * (b - a), 4):
                ours = motion.derivatives(u, 5)[:, 0]
                true = [float(mp.diff(lambda x: textbook(name, x), mp.mpf(u), k)) for k in range(6)]
                scale = [1.0] + [max(1.0, (8 * math.pi) ** k) for k in range(1, 6)]
                assert ours == pytest.approx(true, abs=4e-15 * max(scale), rel=1e-13)
                assert np.abs(ours - true)[:4] / scale[:4] == pytest.approx(np.zeros(4), abs=4e-15)


@pytest.mark.parametrize("name", sorted(PUBLISHED))
def test_ends_are_met_and_at_rest(name):
    motion = named(name).motion
    start, end = motion.derivatives(0.0, 1)[:, 0], motion.derivatives(1.0, 1, -1)[:, 0]
    assert start.tolist() == [0.0, 0.0]
    assert end == pytest.approx([1.0, 0.0], abs=2e-16)


@pytest.mark.parametrize("name", sorted(PUBLISHED))
def test_displacement_velocity_and_acceleration_join(name):
    law = named(name)
    _, jump = law.motion.jumps(2)
    joined = 2 if name == "parabolic" else 3  # the parabolic law steps from 4 to -4
    tops = peaks(law.motion)
    assert (np.abs(jump[:joined]) <= 4e-16 * np.array([1.0, tops.velocity, tops.acceleration])[:joined, None]).all()
    if name == "parabolic":
        assert jump[2].tolist() == [-8.0]


@settings(deadline=None)
@given(NAMES, UNIT, UNIT)
def test_laws_rise(name, a, b):
    s = named(name).derivatives(np.array(sorted((a, b))), 0)[0]
    assert -3e-16 <= s[0] <= s[1] + 1e-15
    assert s[1] <= 1 + 4e-16


def test_a_polynomial_law_is_the_one_of_its_coefficients():
    ours, standard = polynomial_law([0, 0, 0, 10, -15, 6]), named("polynomial-345")
    u = np.linspace(0, 1, 11)
    np.testing.assert_allclose(ours.derivatives(u, 4), standard.derivatives(u, 4), atol=1e-12)
    tops = peaks(ours.motion)
    assert tops.velocity == pytest.approx(15 / 8, rel=1e-14)
    assert tops.acceleration == pytest.approx(10 / math.sqrt(3), rel=1e-14)
    assert tops.jerk == pytest.approx(60, rel=1e-12)


def test_a_polynomial_law_that_starts_or_stops_short_of_rest_has_infinite_peaks():
    ramp = peaks(polynomial_law([0, 1]).motion)
    assert (ramp.velocity, ramp.acceleration, ramp.jerk) == (1, math.inf, math.inf)
    cubic = peaks(polynomial_law([0, 0, 3, -2]).motion)  # rest, but the acceleration steps to 6
    assert (cubic.velocity, cubic.acceleration, cubic.jerk) == (1.5, 6, math.inf)


@pytest.mark.parametrize(
    ("coefficients", "message"),
    [
        ([0, 0.9], "a polynomial law must lead from 0 to 1; this one leads from s(0) = 0 to s(1) = 0.9"),
        ([0.1, 0.9], "a polynomial law must lead from 0 to 1; this one leads from s(0) = 0.1 to s(1) = 1"),
        ([0, 1 + 2e-12], "a polynomial law must lead from 0 to 1; this one leads from s(0) = 0 to s(1) = 1"),
        ([], "a polynomial law needs finite coefficients c0, c1, ... of u"),
        ([0, math.nan], "a polynomial law needs finite coefficients c0, c1, ... of u"),
    ],
)
def test_polynomial_laws_that_lead_elsewhere_are_refused(coefficients, message):
    with pytest.raises(IntentError) as caught:
        polynomial_law(coefficients, "motion[2].law")
    assert (caught.value.message, caught.value.field) == (message, "motion[2].law")


def test_the_end_tolerance_of_a_polynomial_law_is_1e_12():
    polynomial_law([0, 1 + 0.9e-12])
    with pytest.raises(IntentError):
        polynomial_law([0, 1 + 1.1e-12])


def degrees(value):
    return math.radians(value)


def test_a_programme_covers_its_angle_to_the_last_bit():
    made = programme(
        [Segment("rise", degrees(120), 20.0, law("modified-sine")), Segment("dwell", degrees(60))], math.pi
    )
    assert made.total == math.pi
    assert np.degrees(made.motion.knots) == pytest.approx([0, 15, 105, 120, 180], abs=1e-13)
    assert made.at_start(2).tolist() == [0, 0, 0]
    assert made.at_end(3).tolist() == [20, 0, 0, 0]
    # peak values of SW section 5 over 2 pi/3 rad
    t = np.linspace(0, degrees(120), 200001)
    reached = np.abs(made.motion.derivatives(t, 3)).max(axis=1)
    assert reached == pytest.approx([20, 16.80297, 25.20446, 151.2268], abs=5e-5)


def test_neighbouring_dwells_are_one_stretch():
    made = programme(
        [
            Segment("dwell", 0.5),
            Segment("dwell", 0.25),
            Segment("rise", 1.0, 3.0, law("cycloidal")),
            Segment("dwell", 0.25),
            Segment("return", 1.0, 3.0, law("harmonic")),
        ],
        3.0,
    )
    assert made.motion.knots.tolist() == [0, 0.75, 1.75, 2.0, 3.0]
    assert made.at_end(0)[0] == 0


def test_the_angles_may_miss_by_1e_9_rad_and_no_more():
    assert programme([Segment("dwell", math.pi - 0.9e-9)], math.pi).total == math.pi
    with pytest.raises(IntentError):
        programme([Segment("dwell", math.pi - 1.1e-9)], math.pi)


SEGMENTS = st.lists(
    st.one_of(
        st.builds(Segment, st.just("dwell"), st.floats(0.01, 2)),
        st.builds(Segment, st.sampled_from(["rise", "return"]), st.floats(0.01, 2), st.floats(0.1, 50), NAMES.map(law)),
    ),
    min_size=1,
    max_size=6,
)


@settings(deadline=None)
@given(SEGMENTS)
def test_programmes_join_and_end_where_their_strokes_add_up_to(segments):
    total = math.fsum(segment.over for segment in segments)
    made = programme(segments, total)
    sense = {"rise": 1.0, "return": -1.0, "dwell": 0.0}
    strokes = [sense[segment.kind] * segment.stroke for segment in segments]
    assert made.at_end(0)[0] == pytest.approx(math.fsum(strokes), abs=1e-12)
    _, jump = made.motion.jumps(1)
    sharpest = max(s.stroke / s.over**2 for s in segments)  # times the rounding of a knot, a velocity
    assert np.abs(jump[0]).max(initial=0) <= 1e-13 * (1 + sum(map(abs, strokes)))
    assert np.abs(jump[1]).max(initial=0) <= 1e-14 * (1 + made.total * sharpest)


@settings(deadline=None)
@given(SEGMENTS, st.floats(0, 1))
def test_programmes_are_their_laws(segments, share):
    ends = np.cumsum([0.0] + [segment.over for segment in segments])
    made = programme(segments, math.fsum(segment.over for segment in segments))
    t = share * made.total
    i = min(int(np.searchsorted(ends, t, side="right")) - 1, len(segments) - 1)
    level = sum({"rise": 1, "return": -1, "dwell": 0}[s.kind] * s.stroke for s in segments[:i])
    segment = segments[i]
    if segment.law is not None:
        u = min(max((t - ends[i]) / segment.over, 0.0), 1.0)
        level += (1 if segment.kind == "rise" else -1) * segment.stroke * segment.law.derivatives(u, 0)[0, 0]
    assert made.motion.derivatives(t, 0)[0, 0] == pytest.approx(level, abs=1e-11)


@pytest.mark.parametrize("shape", ["sin", "cos", "flat"])
def test_pieces_of_one_shape_together_are_what_each_is_alone(shape):
    pieces = [
        AcceleratedPiece(0.0, 0.0, 0.0, 3.0, 4.0, shape),
        AcceleratedPiece(1.25, 0.3, -0.7, 5.0, 2.0, shape),
        AcceleratedPiece(2.0, 0.0, 0.4, -1.5, 0.9, shape),
    ]
    members = [
        AffineStretch(piece, offset=k, scale=2.0 - k, start=0.1 * k, width=1.0 + k) for k, piece in enumerate(pieces)
    ]
    knots = np.arange(4.0)
    t = np.linspace(0.01, 2.99, 40)
    together, owner = Piecewise(knots, tuple(members)).derivatives(t, 4), t.astype(int)
    for k, member in enumerate(members):
        alone = Piecewise(knots[k : k + 2], (member,)).derivatives(t[owner == k], 4)
        assert np.array_equal(together[:, owner == k], alone)
        # against the same arithmetic on a jet that is not straight, and on intervals
        jet = member(Jet.variable(t[owner == k], 4) + 0.0 * Jet.variable(t[owner == k], 4) ** 2)
        assert jet.derivatives() == pytest.approx(alone, rel=1e-13, abs=1e-13)
        below, above = member(BallJet.variable(t[owner == k], t[owner == k], 4)).bounds()
        assert (below <= alone + 1e-13).all()
        assert (alone - 1e-13 <= above).all()


def test_sine_and_cosine_runs_are_evaluated_together_along_any_curve_and_over_intervals():
    """s + v x + p/r^2 (r x - sin r x) and s + v x + p/r^2 (1 - cos r x), composed with 0.2 + h + h^2/3, by mpmath."""
    runs = [AcceleratedPiece(0.0, 0.0, 0.0, 2.0, 3.0, "sin"), AcceleratedPiece(0.25, 0.1, 0.4, 2.0, 5.0, "cos")]
    motion = Piecewise(np.array([0.0, 0.25, 1.0]), tuple(runs))
    places, order = np.array([0.2, 0.6, 0.05, 0.9]), 4
    curve = np.zeros((order + 1, len(places)))
    curve[0], curve[1], curve[2] = places, 1.0, 1.0 / 3.0
    expected = np.empty_like(curve)
    with mp.workdps(40):
        for i, place in enumerate(places.tolist()):
            run = runs[int(place > 0.25)]
            rate, scale = mp.mpf(run.rate), mp.mpf(run.peak) / run.rate**2

            def path(h, place=place, run=run, rate=rate, scale=scale):
                x = place + h + h * h * mp.mpf(1.0 / 3.0) - run.start
                wave = rate * x - mp.sin(rate * x) if run.shape == "sin" else 1 - mp.cos(rate * x)
                return run.s + run.v * x + scale * wave

            expected[:, i] = [float(c) for c in mp.taylor(path, 0, order)]
    assert motion.on(Jet(curve)).c == pytest.approx(expected, rel=1e-13, abs=1e-15)
    low, high = motion.on(BallJet.variable(places - 1e-3, places + 1e-3, order)).bounds()
    inside = motion.derivatives(np.linspace(places - 1e-3, places + 1e-3, 21).ravel(), order).reshape(order + 1, 21, -1)
    assert (low[:, None] <= inside).all()
    assert (inside <= high[:, None]).all()
    assert (high - low <= 0.5 * np.abs(inside).max() + 1e-3).all()
