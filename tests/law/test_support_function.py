"""Lifts: published figures, closed forms, derivatives against mpmath, and what must be refused."""

import math
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.programmes import Segment, law, programme

from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula
from kin.law.normalised import IntentError, polynomial_law
from kin.law.sources.laws import NAMES, named
from kin.law.support_function import lift_constant_breadth, lift_from_fourier, lift_hypocycloid, lift_reuleaux

TURN = 2 * math.pi
TEAR = "the contact would jump along the face, and the contour tear open"
GRID = np.linspace(0, TURN, 3601)
ANGLES = st.floats(-10, 10)
# AS eq. 7 with a = 4, k = 3, c = 23, and Figure 2 a-d
AYGAHOGLU = {
    "1": "4*cos(3*t/2)**2 + 23",
    "2a": "sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25",
    "2b": "2*cos(2*t)**2*sin(t)**3 + 25",
    "2c": "2*sin(pi*cos(t))*cos(pi*sin(t)) + 25",
    "2d": "sin(2*t)*cos(3*t) + cos(3*t) + 25",
}


def rho(lift, t, side=1):
    p = lift.derivatives(t, 2, side)
    return p[0] + p[2]


def contour(lift, t):
    """AS eqs. 2, 3."""
    p = lift.derivatives(t, 1)
    return np.stack((p[0] * np.cos(t) - p[1] * np.sin(t), p[0] * np.sin(t) + p[1] * np.cos(t)))


def degrees(segments):
    return programme(segments, math.pi)


def rise(stroke, over, name="modified-sine"):
    return Segment("rise", math.radians(over), stroke, law(name))


def dwell(over):
    return Segment("dwell", math.radians(over))


def shu_wu():
    return lift_constant_breadth(40.0, degrees([rise(20.0, 120), dwell(60)]))


def lifts():
    """One lift of every kind."""
    return [
        shu_wu(),
        lift_constant_breadth(40.0, degrees([dwell(20), rise(12.0, 130, "cycloidal"), dwell(30)])),
        lift_reuleaux(3, 50, 5, (3.0, -2.0)),
        lift_reuleaux(7, 50, 0),
        lift_hypocycloid(3, 2.0, 50.0, (16.0, 7.5)),
        lift_from_fourier(25.0, {3: 2.0, 1: 0.5}, {5: 0.1}, (18.0, 8.5)),
        lift_from_formula(Formula(AYGAHOGLU["2c"]), (16.0, 7.5), 25.4),
        lift_from_formula(Formula("25 + max(0, sin(t))**3"), (1.0, 2.0)),
    ]


# --- constant breadth from a programme (Shu and Wu) ---


def test_worked_example_of_shu_and_wu():
    lift = shu_wu()
    t = np.linspace(0, TURN, 72001)
    peaks = np.abs(lift.derivatives(t, 3)).max(axis=1)
    assert peaks[1:3] == pytest.approx([16.80297, 25.20446], abs=5e-6)
    assert peaks[3] == pytest.approx(151.2268, abs=5e-5)
    assert rho(lift, t).min() == pytest.approx(34.27910, abs=5e-6)
    assert rho(lift, t).max() == pytest.approx(65.72090, abs=5e-6)
    assert lift.datum == 40
    assert np.degrees(lift.breaks) == pytest.approx([0, 15, 105, 120, 180, 195, 285, 300], abs=1e-12)
    assert lift.steady.tolist() == [False, False, False, True] * 2
    assert lift.radius[[3, 7]].tolist() == [60.0, 40.0]


def test_peaks_of_the_worked_example_in_closed_form():
    t = np.linspace(0, math.pi, 72001)
    s = shu_wu().derivatives(t, 3)
    beta, ca = 2 * math.pi / 3, 4 * math.pi**2 / (math.pi + 4)
    true = [20 * ca / math.pi / beta, 20 * ca / beta**2, 20 * 4 * math.pi * ca / beta**3]
    assert np.abs(s).max(axis=1)[1:] == pytest.approx(true, rel=1e-9)


@settings(deadline=None)
@given(st.sampled_from(NAMES[1:]), st.floats(1, 40), st.floats(30, 150), st.floats(0.05, 0.9), ANGLES)
def test_opposite_faces_keep_their_distance(name, stroke, over, share, t):
    rest = 180 - over
    segments = [dwell(share * rest), rise(stroke, over, name), dwell(rest - share * rest)]
    lift = lift_constant_breadth(60.0, degrees(segments))
    p = lift.derivatives(np.array([t, t + math.pi]), 3)
    assert p[0].sum() == pytest.approx(120 + stroke, rel=1e-14)
    assert np.abs(p[1:].sum(axis=1)).max() <= 1e-9 * np.abs(p).max()
    assert lift.derivatives(0.0, 0)[0, 0] == pytest.approx(60, rel=1e-15)
    assert lift.derivatives(math.pi, 0)[0, 0] == pytest.approx(60 + stroke, rel=1e-15)


def test_a_dwell_over_the_joint_is_one_stretch():
    lift = lift_constant_breadth(40.0, degrees([dwell(30), rise(20.0, 120, "cycloidal"), dwell(30)]))
    assert np.degrees(lift.breaks) == pytest.approx([30, 150, 210, 330], abs=1e-12)
    assert lift.radius[[1, 3]].tolist() == [60.0, 40.0]
    assert lift.steady.tolist() == [False, True, False, True]
    mid, rad = lift.radius_enclosure(np.radians([331.0, 151.0]), np.radians([389.0, 209.0]), 2)
    assert mid[0] == pytest.approx([40, 60])
    assert rad[0].max() < 1e-12
    assert not mid[1:].any()
    assert not rad[1:].any()


def test_a_programme_that_comes_back_swings_about_the_base_radius():
    up = rise(20.0, 90, "cycloidal")
    lift = lift_constant_breadth(40.0, degrees([up, Segment("return", up.over, 20.0, up.law)]))
    p = lift.derivatives(GRID, 0)[0]
    assert (p.min(), p.max()) == pytest.approx((20, 60))
    assert p + lift.derivatives(GRID + math.pi, 0)[0] == pytest.approx(80, rel=1e-14)


def test_a_programme_may_begin_and_end_in_motion_if_the_halves_join():
    balanced = polynomial_law([0, 1, 2, -2])  # s' = 1 and -1 at the ends, s'' = 4 and -8
    ends_moving = polynomial_law([0, 1, 3, -3])  # s' = 1 and -2
    lift = lift_constant_breadth(40.0, degrees([Segment("rise", math.pi, 10.0, balanced)]))
    assert np.abs(lift.law.jumps(1)[1]).max() < 1e-13
    assert lift.law.jumps(2)[1][2] == pytest.approx([(4 - 8) * 10 / math.pi**2, (-4 + 8) * 10 / math.pi**2])
    with pytest.raises(IntentError) as caught:
        lift_constant_breadth(40.0, degrees([Segment("rise", math.pi, 10.0, ends_moving)]))
    assert caught.value.message == (
        "the motion does not join over the half turn: S' is 3.18309886 mm/rad at 0 degrees, so it must be -3.18309886 "
        "at 180, where it is -6.36619772; the contour would tear open by 3.1831 mm"
    )
    assert (caught.value.field, caught.value.at_deg) == ("motion", 180.0)


def test_a_jump_of_velocity_inside_a_programme_is_refused_with_its_angle():
    ramp = Segment("rise", math.radians(60), 6.0, polynomial_law([0, 1]))
    with pytest.raises(IntentError) as caught:
        lift_constant_breadth(40.0, degrees([dwell(40), ramp, dwell(80)]))
    assert caught.value.at_deg == pytest.approx(40)
    assert caught.value.message == f"p' jumps from 0 to 5.72957795 mm/rad at 40 degrees: {TEAR}"


def test_a_step_of_acceleration_is_a_break_and_no_fault():
    lift = lift_constant_breadth(40.0, degrees([rise(10.0, 120, "parabolic"), dwell(60)]))
    at, jump = lift.law.jumps(2)
    a = 4 * 10.0 / math.radians(120) ** 2
    assert np.degrees(at) == pytest.approx([0, 60, 120, 180, 240, 300], abs=1e-12)
    assert jump[2] == pytest.approx([a, -2 * a, a, -a, 2 * a, -a])
    assert np.abs(jump[:2]).max() < 1e-13


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("base", "segments", "field"),
    [
        (0.0, [rise(20.0, 180)], "base_radius"),
        (math.nan, [rise(20.0, 180)], "base_radius"),
        (5.0, [Segment("return", math.pi, 10.0, named("cycloidal"))], "motion"),
    ],
)
def test_no_cam_is_left(base, segments, field):
    with pytest.raises(IntentError) as caught:
        lift_constant_breadth(base, degrees(segments))
    assert caught.value.field == field


def test_a_programme_of_another_angle_is_the_callers_fault():
    with pytest.raises(ValueError, match="not the half turn"):
        lift_constant_breadth(40.0, programme([Segment("dwell", 3.0)], 3.0))


# --- shapes ---


@pytest.mark.thin(2)
@pytest.mark.parametrize("sides", [3, 5, 7, 9])
def test_reuleaux_polygons_are_arcs_about_their_corners(sides):
    breadth, rounding = 50.0, 4.0
    lift = lift_reuleaux(sides, breadth, rounding)
    circumradius = (breadth - 2 * rounding) / (2 * math.cos(math.pi / (2 * sides)))
    corners = circumradius * np.exp(2j * np.pi * np.arange(sides) / sides)
    assert lift.radius.tolist() == pytest.approx([breadth - rounding, rounding] * sides)
    assert lift.steady.all()
    assert lift.breaks == pytest.approx((2 * np.arange(2 * sides) + 1) * math.pi / (2 * sides))
    # the curve at distance `rounding` from the intersection of discs of the sharp breadth about the corners
    points = contour(lift, GRID)
    inner = (points[0] - rounding * np.cos(GRID)) + 1j * (points[1] - rounding * np.sin(GRID))
    farthest = np.abs(inner[:, None] - corners[None, :]).max(axis=1)
    assert farthest == pytest.approx(breadth - 2 * rounding, rel=1e-14)
    assert lift.derivatives(GRID, 0)[0] + lift.derivatives(GRID + math.pi, 0)[0] == pytest.approx(breadth, rel=1e-14)


def test_area_of_the_reuleaux_triangle():
    lift = lift_reuleaux(3, 1.0, 0.0)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    knots = lift.law.knots
    area = 0.0
    for a, b in pairwise(knots):
        t = 0.5 * (a + b) + 0.5 * (b - a) * nodes
        p = lift.derivatives(t, 1)
        area += 0.5 * (b - a) * weights @ (0.5 * (p[0] ** 2 - p[1] ** 2))
    assert area == pytest.approx((math.pi - math.sqrt(3)) / 2, rel=1e-13)  # Blaschke, Lebesgue


def test_a_reuleaux_polygon_rounded_by_half_its_breadth_is_a_circle():
    lift = lift_reuleaux(5, 50.0, 25.0, (3.0, 4.0))
    assert lift.breaks.tolist() == []
    assert lift.radius.tolist() == [25.0]
    assert lift.derivatives(GRID, 0)[0] == pytest.approx(25 - 3 * np.cos(GRID) - 4 * np.sin(GRID), rel=1e-14)


@pytest.mark.parametrize(
    ("sides", "rounding", "message"),
    [
        (4, 5.0, "a Reuleaux polygon has an odd number of sides, 3 or more, not 4"),
        (1, 5.0, "a Reuleaux polygon has an odd number of sides, 3 or more, not 1"),
        (3, 25.1, "the rounding must lie between 0 and half the breadth, 25 mm; it is 25.1 mm"),
        (3, -1.0, "the rounding must lie between 0 and half the breadth, 25 mm; it is -1 mm"),
    ],
)
def test_reuleaux_polygons_that_are_none(sides, rounding, message):
    with pytest.raises(IntentError) as caught:
        lift_reuleaux(sides, 50.0, rounding)
    assert caught.value.message == message


@pytest.mark.thin(2)
@pytest.mark.parametrize("cusps", [3, 5])
def test_hypocycloid_is_parallel_to_one(cusps):
    lift = lift_hypocycloid(cusps, 2.0, 200.0)
    points = contour(lift, GRID)
    inner = points - 100 * np.stack((np.cos(GRID), np.sin(GRID)))
    # fixed circle of radius cusps a, rolling circle (cusps - 1) a/2, a the inscribed circle's radius
    big, small = cusps * 2.0, (cusps - 1) * 2.0 / 2
    turn = np.linspace(0, TURN * (cusps - 1) / 2, 40001)
    path = (big - small) * np.exp(1j * turn) + small * np.exp(-1j * (big - small) / small * turn)
    assert np.abs(path).max() == pytest.approx(big)
    assert np.abs(path).min() == pytest.approx(2.0, rel=1e-6)
    support = (path[None, :] * np.exp(-1j * (GRID[::100, None]))).real
    tangent_to_it = np.abs(support - lift.derivatives(GRID[::100], 0)[0][:, None] + 100).min(axis=1)
    assert tangent_to_it.max() < 1e-3
    assert np.hypot(*inner).max() == pytest.approx(big, rel=1e-5)


@pytest.mark.parametrize("cusps", [-3, 0, 1, 2, 4])
def test_hypocycloids_of_constant_breadth_have_an_odd_number_of_cusps(cusps):
    with pytest.raises(IntentError, match=f"3 or more, not {cusps}"):
        lift_hypocycloid(cusps, 2.0, 50.0)


def test_rabinowitz_curve():
    """S. Rabinowitz, A polynomial curve of constant width (1997): p = 9 + cos 3t and its equation of degree 8."""
    for lift in (lift_from_formula(Formula("9 + cos(3*t)")), lift_hypocycloid(3, 1.0, 18.0)):
        x, y = contour(lift, GRID)
        r2, q = x * x + y * y, x * x - 3 * y * y
        value = r2**4 - 45 * r2**3 - 41283 * r2**2 + 7950960 * r2 + 16 * q**3 + 48 * r2 * q**2
        value += x * q * (16 * r2**2 - 5544 * r2 + 266382) - 373248000
        assert np.abs(value).max() < 1e-14 * 373248000 * 100
        p = lift.derivatives(GRID[:-1], 1)
        step = TURN / (len(GRID) - 1)
        assert p[0].sum() * step == pytest.approx(18 * math.pi, rel=1e-13)  # Barbier
        assert 0.5 * (p[0] ** 2 - p[1] ** 2).sum() * step == pytest.approx(77 * math.pi, rel=1e-13)
        assert (rho(lift, GRID).min(), rho(lift, GRID).max()) == pytest.approx((1, 17), rel=1e-13)


@settings(deadline=None)
@given(st.dictionaries(st.integers(1, 9), st.floats(-2, 2), max_size=4), st.floats(-20, 20), st.floats(-20, 20), ANGLES)
def test_fourier_series_are_their_formulas(cos, x, y, t):
    sin = {k: a / 2 for k, a in cos.items()}
    lift = lift_from_fourier(25.0, cos, sin, (x, y))
    text = "25" + "".join(f" + {a!r}*cos({k}*t) + {a / 2!r}*sin({k}*t)" for k, a in cos.items())
    same = lift_from_formula(Formula(text), (x, y))
    np.testing.assert_allclose(lift.derivatives(t, 4), same.derivatives(t, 4), atol=1e-10)


def test_the_first_harmonic_alone_is_a_circle_about_another_shaft():
    lift = lift_from_fourier(25.0, {1: 3.0}, {1: -4.0}, (1.0, 1.0))
    assert lift.radius.tolist() == [25.0]
    x, y = contour(lift, GRID)
    assert np.hypot(x - 2, y + 5) == pytest.approx(25, rel=1e-14)


def test_harmonics_count_from_one():
    with pytest.raises(IntentError) as caught:
        lift_from_fourier(25.0, {3: 1.0}, {0: 1.0})
    assert caught.value.message == "harmonics count from 1, not 0 (the constant term is mean)"
    assert caught.value.field == "fourier.sin"


# --- the shaft ---


@settings(deadline=None)
@given(st.sampled_from(sorted(AYGAHOGLU)), st.floats(-20, 20), st.floats(-20, 20), ANGLES)
def test_moving_the_shaft_moves_the_contour_and_leaves_rho(figure, x, y, t):
    still = lift_from_formula(Formula(AYGAHOGLU[figure]))
    moved = lift_from_formula(Formula(AYGAHOGLU[figure]), (x, y))
    t = np.array([t])
    np.testing.assert_allclose(contour(moved, t), contour(still, t) - np.array([[x], [y]]), atol=1e-12)
    np.testing.assert_allclose(rho(moved, t), rho(still, t), atol=1e-12)


# --- formulas ---

MP = {
    "1": lambda t: 4 * mp.cos(3 * t / 2) ** 2 + 23,
    "2a": lambda t: mp.sin(3 * t) + mp.mpf(13) / 15 * mp.sin(3 * t) * mp.cos(2 * t) + 25,
    "2b": lambda t: 2 * mp.cos(2 * t) ** 2 * mp.sin(t) ** 3 + 25,
    "2c": lambda t: 2 * mp.sin(mp.pi * mp.cos(t)) * mp.cos(mp.pi * mp.sin(t)) + 25,
    "2d": lambda t: mp.sin(2 * t) * mp.cos(3 * t) + mp.cos(3 * t) + 25,
}


@pytest.mark.thin(3)
@pytest.mark.parametrize("figure", sorted(AYGAHOGLU))
def test_derivatives_of_the_papers_curves(figure):
    lift = lift_from_formula(Formula(AYGAHOGLU[figure]))
    with mp.workdps(40):
        for t in (0.0, 0.7, 2.9, 4.4, 6.1):
            true = [float(mp.diff(MP[figure], mp.mpf(t), k)) for k in range(6)]
            assert lift.derivatives(t, 5)[:, 0] == pytest.approx(true, rel=1e-12, abs=1e-11)


@pytest.mark.thin(3)
@pytest.mark.parametrize("figure", sorted(AYGAHOGLU))
def test_the_papers_curves_have_breadth_50(figure):
    lift = lift_from_formula(Formula(AYGAHOGLU[figure]), (16.0, 7.5))
    assert lift.breaks.tolist() == []
    assert lift.derivatives(GRID, 0)[0] + lift.derivatives(GRID + math.pi, 0)[0] == pytest.approx(50, rel=1e-14)
    assert rho(lift, GRID).min() > 0


def test_a_scale_is_the_unit_of_the_formula_and_not_of_the_pivot():
    inches = lift_from_formula(Formula("1 + 0.08*cos(3*t)"), (5.0, 0.0), 25.4)
    assert inches.derivatives(0.0, 0)[0, 0] == pytest.approx(1.08 * 25.4 - 5)


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("text", "breaks", "radius"),
    [
        ("25 + abs(sin(t))**3", [0, 180], [math.nan, math.nan]),
        ("25 + abs(cos(t))**3", [90, 270], [math.nan, math.nan]),
        ("25 + max(0, sin(t))**3", [0, 180], [math.nan, 25]),
        ("25 + max(0, cos(t))**3", [90, 270], [25, math.nan]),
        ("25 + sin(t)*abs(sin(t))", [0, 180], [math.nan, math.nan]),
        ("min(30, 25 + cos(3*t))", [], [math.nan]),
        ("25 + max(0, sin(t))**9", [0, 180], [math.nan, 25]),
        ("25 + abs(1 - cos(t))", [], [math.nan]),
        ("25 + abs(sin(t/2))**3", [0], [math.nan]),
        ("25 + abs(cos(t/2))**3", [180], [math.nan]),
        ("25 + abs(cos(t/2 - 1))**3", [180 + math.degrees(2)], [math.nan]),
        ("25", [], [25]),
        ("25 + 0*t", [], [25]),
    ],
)
def test_switches_are_breaks_where_they_change_something(text, breaks, radius):
    lift = lift_from_formula(Formula(text))
    assert np.degrees(lift.breaks) == pytest.approx(breaks, abs=1e-12)
    assert lift.radius == pytest.approx(radius, nan_ok=True)


def test_one_sided_derivatives_at_a_switch():
    lift = lift_from_formula(Formula("25 + sin(t)*abs(sin(t))"), (3.0, 0.0))
    for t, sense in ((0.0, 1), (math.pi, -1), (TURN, 1)):
        right, left = (lift.derivatives(t, 2, side)[2, 0] - 3 * math.cos(t) for side in (1, -1))
        assert (right, left) == pytest.approx((2 * sense, -2 * sense), abs=1e-14)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("25 + t", "p does not close: p is off by 6.28318531 mm a full turn after 84.9845 degrees"),
        ("25 + sin(t/2)", "p does not close: p is off by -1.9999762 mm a full turn after 179.441 degrees"),
        ("25 + sin(t/2)**3", "p does not close: p is off by -1.99992861 mm a full turn after 179.441 degrees"),
        (
            "25 + abs(sin(t))",
            f"p' jumps from -1 to 1 mm/rad at 0 degrees: {TEAR}",
        ),
        (
            "25 + max(sin(t), cos(t))",
            f"p' jumps from -0.707106781 to 0.707106781 mm/rad at 45 degrees: {TEAR}",
        ),
        ("25 + sign(sin(t))", "p jumps from 24 to 26 mm at 0 degrees: the cam would have a step"),
        (
            "25 + atan2(sin(t), cos(t))",
            "p jumps from 28.1415927 to 21.8584073 mm at 180 degrees: the cam would have a step",
        ),
        (
            "25 + tan(t)",
            (
                "p, p' or p'' cannot be bounded near 90 degrees; a whole exponent is smooth where what it is put on "
                "vanishes, and a fraction of which both sides vanish has to be written out"
            ),
        ),
        (
            "25 + sqrt(1 - cos(t))",
            (
                "p or a derivative of it does not exist at 0 degrees: derivative of sqrt at zero; a whole exponent is "
                "smooth where what it is put on vanishes"
            ),
        ),
        ("25 + sqrt(sin(t))", "p does not exist at 222.492 degrees: sqrt of a negative number"),
    ],
)
def test_formulas_that_make_no_cam(text, message):
    with pytest.raises(IntentError) as caught:
        lift_from_formula(Formula(text))
    assert (caught.value.message, caught.value.field) == (message, "p")
    assert caught.value.at_deg is not None


def test_figures_of_a_formula_in_inches_are_in_millimetres():
    with pytest.raises(IntentError, match=r"p is off by 159\.592907 mm"):
        lift_from_formula(Formula("1 + t"), scale=25.4)


def test_a_kink_a_millionth_high_is_still_seen():
    with pytest.raises(IntentError, match="p' jumps"):
        lift_from_formula(Formula("25 + 1e-8*abs(sin(t - 1))"))


def test_an_error_of_the_formula_keeps_its_words():
    with pytest.raises(IntentError, match="abs cannot be settled"):
        lift_from_formula(Formula("25 + abs(sin(2000*t))"))


# --- proofs ---


@pytest.mark.thin(3)
@pytest.mark.parametrize("i", range(len(lifts())))
def test_enclosures_hold(i):
    lift = lifts()[i]
    rng = np.random.default_rng(i)
    lower = rng.uniform(-7, 7, 400)
    upper = lower + 10.0 ** rng.uniform(-8, 1, 400)
    t = lower + rng.uniform(0.001, 0.999, 400) * (upper - lower)
    p = lift.derivatives(t, 4)
    noise = 1e-14 * np.abs(p).max(axis=1, keepdims=True)
    mid, rad = lift.law.enclosure(lower, upper, 4)
    assert (np.abs(p - mid) <= rad + noise).all()
    mid, rad = lift.radius_enclosure(lower, upper, 2)
    assert (np.abs(p[:3] + p[2:] - mid) <= rad + noise[2:] + noise[:3]).all()


def test_enclosures_shrink_with_the_interval():
    lift = lift_from_formula(Formula(AYGAHOGLU["2c"]), (16.0, 7.5))
    lower = np.linspace(0, 6, 50)
    widths = [lift.radius_enclosure(lower, lower + w, 0)[1].max() for w in (1e-2, 1e-4, 1e-6)]
    assert widths[1] < 1.1e-2 * widths[0]
    assert widths[2] < 1.1e-2 * widths[1]


def test_a_cusp_on_the_shaft_is_no_jump():
    """p, p' and p'' vanish at the seam: rounding of what they are the sum of is all that is left of them there."""
    size = 25.0 / (151 * 151 - 1)
    found = lift_from_fourier(25.0, {151: size}, {}, (25.0 + size, 0.0))
    assert np.abs(found.derivatives(0.0, 2)).max() < 1e-11


@pytest.mark.parametrize(
    ("text", "waves"),
    [
        ("25 + cos(20000*t)", "2e+04"),
        ("25 + cos(131072*t)", "1.31e+05"),  # alike at each of 2**17 equal steps
        ("25 + cos(3*t) + 1e-9*cos(9000*t)", "9e+03"),
        ("25 + 1e-9*cos(3000*cos(5000*t))", "9.59e+06"),
        ("25 + sin(1000*sin(1000*sin(1000*t)))", "4.02e+08"),
    ],
)
def test_more_waves_than_are_worked_out_are_counted_and_refused(text, waves):
    with pytest.raises(IntentError) as caught:
        lift_from_formula(Formula(text))
    assert caught.value.message == f"p has about {waves} waves in a turn; no more than 5000 are worked out"


@pytest.mark.parametrize(
    "text",
    ["25 + 1e-9*cos(5000*t)", "25 + 1e-4*exp(-1e5*sin(t/2)**2)", "25*sqrt(sin(t)**2 + cos(t)**2)", "0*t", "25"],
)
def test_few_waves_and_steep_or_rounded_ones_are_not_refused(text):
    assert lift_from_formula(Formula(text)).law.period == 2 * math.pi
