"""Jets against mpmath's Taylor series at 50 digits; ball jets must hold the same series at every point inside them.

Holds: kin.numeric.taylor.
"""

from __future__ import annotations

import math
import pickle

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.numeric.elementary import (
    BallJet,
    DomainError,
    Jet,
    abs_,
    acos,
    asin,
    atan,
    atan2,
    cbrt,
    cos,
    cosh,
    exp,
    hypot,
    log,
    maximum,
    minimum,
    sign,
    sin,
    sinh,
    sqrt,
    tan,
    tanh,
)
from kin.numeric.interval import Ball

ORDER = 8


def mp_cbrt(x: mpmath.mpf) -> mpmath.mpf:
    return mpmath.sign(x) * mpmath.cbrt(abs(x))


# name: (in jets, in mpmath, interval, error allowed in ulp of the largest coefficient)
FUNCTIONS = {
    "sin": (sin, mpmath.sin, (-7, 7), 4),
    "cos": (cos, mpmath.cos, (-7, 7), 4),
    "sin of a line": (lambda t: sin(3 * t + 1), lambda t: mpmath.sin(3 * t + 1), (-7, 7), 60),
    "tan": (tan, mpmath.tan, (-1.4, 1.4), 40),
    "asin": (asin, mpmath.asin, (-0.99, 0.99), 40),
    "acos": (acos, mpmath.acos, (-0.99, 0.99), 40),
    "atan": (atan, mpmath.atan, (-9, 9), 20),
    "sinh": (sinh, mpmath.sinh, (-3, 3), 4),
    "cosh": (cosh, mpmath.cosh, (-3, 3), 4),
    "tanh": (tanh, mpmath.tanh, (-3, 3), 20),
    "exp": (exp, mpmath.exp, (-3, 3), 4),
    "log": (log, mpmath.log, (0.01, 9), 8),
    "sqrt": (sqrt, mpmath.sqrt, (0.01, 9), 8),
    "cbrt": (cbrt, mp_cbrt, (0.01, 9), 8),
    "cbrt of a negative": (cbrt, mp_cbrt, (-9, -0.01), 8),
    "square": (lambda t: t**2, lambda t: t**2, (-5, 5), 4),
    "cube": (lambda t: t**3, lambda t: t**3, (-5, 5), 4),
    "twentieth": (lambda t: t**20, lambda t: t**20, (-2, 2), 8),
    "reciprocal square": (lambda t: t**-2, lambda t: t**-2, (-5, -0.5), 8),
    "broken power": (lambda t: t**-2.5, lambda t: t ** mpmath.mpf(-2.5), (0.1, 5), 8),
    "tenth root": (lambda t: t**0.1, lambda t: t ** mpmath.mpf(0.1), (0.1, 5), 8),
    "power of a constant": (lambda t: 2**t, lambda t: mpmath.mpf(2) ** t, (-3, 3), 20),
    "power of itself": (lambda t: t**t, lambda t: t**t, (0.5, 4), 60),
    "quotient": (lambda t: (t + 1) / (2 + t * t), lambda t: (t + 1) / (2 + t * t), (-3, 3), 40),
    "reciprocal": (lambda t: 1 / (3 - t), lambda t: 1 / (3 - t), (-3, 2), 20),
    "sin of a square": (lambda t: sin(t * t - 1), lambda t: mpmath.sin(t * t - 1), (-3, 3), 100),
    "exp of sin": (lambda t: exp(sin(2 * t)), lambda t: mpmath.exp(mpmath.sin(2 * t)), (-3, 3), 100),
    "root of a sum": (lambda t: sqrt(2 + cos(3 * t)), lambda t: mpmath.sqrt(2 + mpmath.cos(3 * t)), (-3, 3), 200),
    "angle": (
        lambda t: atan2(2 + sin(t), cos(2 * t) - 0.5),
        lambda t: mpmath.atan2(2 + mpmath.sin(t), mpmath.cos(2 * t) - 0.5),
        (-3, 3),
        200,
    ),
    "length": (
        lambda t: hypot(2 + sin(t), cos(2 * t)),
        lambda t: mpmath.sqrt((2 + mpmath.sin(t)) ** 2 + mpmath.cos(2 * t) ** 2),
        (-3, 3),
        200,
    ),
    "cam 2a": (
        lambda t: 25 + sin(3 * t) + 13 / 15 * sin(3 * t) * cos(2 * t),
        lambda t: 25 + mpmath.sin(3 * t) + mpmath.mpf(13) / 15 * mpmath.sin(3 * t) * mpmath.cos(2 * t),
        (0, 6.28),
        100,
    ),
}


def series(exact, t: float) -> list[mpmath.mpf]:
    return mpmath.taylor(exact, mpmath.mpf(t), ORDER)


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_coefficient_is_right(name: str) -> None:
    function, exact, (least, greatest), ulps = FUNCTIONS[name]
    t = np.random.default_rng(3).uniform(least, greatest, 12)
    found = function(Jet.variable(t, ORDER)).c
    for i, point in enumerate(t):
        true = series(exact, point)
        size = max(abs(c) for c in true)
        assert max(abs(mpmath.mpf(a) - b) for a, b in zip(found[:, i], true, strict=True)) <= ulps * 2.0**-53 * size


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_ball_jet_holds_the_series_of_every_point_inside(name: str) -> None:
    function, exact, (least, greatest), _ = FUNCTIONS[name]
    rng = np.random.default_rng(4)
    t, width = rng.uniform(least, greatest, 10), 10.0 ** rng.uniform(-9, -0.5, 10)
    lower = np.clip(t - width * rng.random(10), least, t)
    upper = np.clip(lower + width, t, greatest)
    lower[0] = upper[0] = t[0]
    found = function(BallJet.variable(lower, upper, ORDER))
    low, high = found.bounds()
    assert np.isfinite(found.rad[:, width < 1e-3]).all()
    for i, point in enumerate(t):
        for k, c in enumerate(series(exact, point)):
            assert abs(c - mpmath.mpf(found.mid[k, i])) <= found.rad[k, i]
            assert low[k, i] <= c * math.factorial(k) <= high[k, i]


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_balls_shrink_with_the_interval(name: str) -> None:
    """The radius goes to what half the interval times the next derivative asks for, but for a factor."""
    function, _, (least, greatest), _ = FUNCTIONS[name]
    middle = 0.3 * least + 0.7 * greatest
    width = np.array([1e-3, 1e-5, 1e-7])
    rad = function(BallJet.variable(middle - width / 2, middle + width / 2, ORDER - 1)).rad
    true = np.abs(function(Jet.variable(middle, ORDER)).c[1:, 0]) * np.arange(1, ORDER + 1)
    assert (rad[:, 1] <= 0.0101 * rad[:, 0] + 1e-9).all()
    assert (rad[:, 2] <= 0.0101 * rad[:, 1] + 1e-9).all()
    # Dependency between the operands costs a factor; it is that of the coarsest functions here.
    assert (rad[:, 0] <= 60 * width[0] * (true + np.max(true))).all()


@given(st.floats(-20, 20), st.floats(1e-6, 3), st.integers(-5, 5), st.floats(-3, 3))
def test_over_a_line_sine_and_cosine_have_their_true_ranges_in_every_derivative(
    start: float, width: float, factor: int, shift: float
) -> None:
    balls = BallJet.variable(start, start + width, ORDER)
    t = np.linspace(start, start + width, 2001)
    for function in (sin, cos):
        low, high = function(balls * factor + shift).bounds()
        true = function(Jet.variable(t, ORDER) * factor + shift).derivatives()
        size = float(abs(factor)) ** np.arange(ORDER + 1)
        rough = 0.2 * (width * factor / 2000) ** 2 + 1e-12  # what 2001 points can miss of a range, and rounding
        assert (low[:, 0] >= true.min(axis=1) - size * rough).all()
        assert (high[:, 0] <= true.max(axis=1) + size * rough).all()
        assert (low[:, 0] <= true.min(axis=1) + size * 1e-12).all()
        assert (high[:, 0] >= true.max(axis=1) - size * 1e-12).all()
        assert (high[:, 0] <= size * (1 + 1e-13)).all()


def test_an_exponent_less_a_whole_number_is_not_rounded() -> None:
    """0.1 - 1 is no double; so far from 1 its rounding is worth a hundred ulp."""
    t = mpmath.mpf(1e-100)
    found = BallJet.variable(1e-100, 1e-100, 3) ** 0.1
    for k in range(4):
        true = mpmath.binomial(mpmath.mpf(0.1), k) * t ** (mpmath.mpf(0.1) - k)
        assert abs(true - mpmath.mpf(found.mid[k, 0])) <= found.rad[k, 0] <= 1e-13 * abs(true)


jets = st.lists(st.floats(-3, 3), min_size=5, max_size=5).map(lambda c: Jet(np.array(c)[:, None]))


@given(jets, jets, jets)
def test_arithmetic_obeys_its_laws(a: Jet, b: Jet, c: Jet) -> None:
    def same(x: Jet, y: Jet) -> None:
        np.testing.assert_allclose(x.c, y.c, rtol=0, atol=1e-11)

    d = b + (5 - b.c[0])  # far from zero
    same(a * (b + c), a * b + a * c)
    same((a * b) * c, a * (b * c))
    same((a / d) * d, a)
    same(a - b, -(b - a))
    same(a / 4, a * 0.25)
    same(sin(a) ** 2 + cos(a) ** 2, a.constant(1.0))
    same(d**3, d * d * d)
    same(exp(log(d)), d)
    same(sqrt(d) * sqrt(d), d)
    same(cbrt(d) ** 3, d)
    same(tan(a / 4), sin(a / 4) / cos(a / 4))
    same((a * b).derivative(), Jet(a.c[:-1]) * b.derivative() + Jet(b.c[:-1]) * a.derivative())
    same(a.derivative().integral(a.c[0]), a)


@given(
    st.lists(st.floats(-2, 2), min_size=4, max_size=4),
    st.lists(st.sampled_from([0.0, 1e-9, 0.1, 1.0]), min_size=4, max_size=4),
    st.lists(st.floats(-1, 1), min_size=8, max_size=8),
)
def test_ball_products_hold_the_products_of_all_that_is_inside(mid: list, rad: list, place: list) -> None:
    balls = BallJet(np.array(mid)[:, None], np.array(rad)[:, None])
    a = [mpmath.mpf(m) + mpmath.mpf(r) * mpmath.mpf(p) for m, r, p in zip(mid, rad, place[:4], strict=True)]
    b = [mpmath.mpf(m) + mpmath.mpf(r) * mpmath.mpf(p) for m, r, p in zip(mid, rad, place[4:], strict=True)]
    found = balls * balls
    for k in range(4):
        true = mpmath.fsum(a[j] * b[k - j] for j in range(k + 1))
        assert abs(true - mpmath.mpf(found.mid[k, 0])) <= found.rad[k, 0]


def test_underflow_is_covered() -> None:
    tiny = BallJet.variable(1e-200, 1e-200, 1) * BallJet.variable(1e-200, 1e-200, 1)
    assert tiny.mid[0, 0] == 0
    assert tiny.rad[0, 0] > 0
    zero = BallJet.variable(1.0, 2.0, 3).constant(0.0) * BallJet.variable(1.0, 2.0, 3)
    assert zero.rows.zero.all()


def test_numbers_and_arrays_are_constants() -> None:
    t, shift = np.array([0.5, 1.0, 2.0]), np.array([1.0, 2.0, 3.0])
    x = Jet.variable(t, 2)
    np.testing.assert_array_equal((shift + x).c, [t + shift, [1, 1, 1], [0, 0, 0]])
    np.testing.assert_array_equal((shift - x).c, [shift - t, [-1, -1, -1], [0, 0, 0]])
    np.testing.assert_array_equal((shift * x).c, [shift * t, shift, [0, 0, 0]])
    np.testing.assert_allclose((shift / x).c, [shift / t, -shift / t**2, shift / t**3], rtol=1e-15)
    np.testing.assert_allclose((x / shift).c, [t / shift, 1 / shift, [0, 0, 0]], rtol=1e-15)
    balls = BallJet.variable(t, t, 2)
    for found, true in [(shift * balls, shift * x), (balls / shift, x / shift), (shift / balls, shift / x)]:
        np.testing.assert_allclose(found.mid, true.c, rtol=1e-14)
    np.testing.assert_array_equal((np.float64(2) * x).c, (x * 2).c)


def test_values_alone_need_no_jet() -> None:
    values = np.array([[0.25, 0.5], [0.75, 1.0]])
    np.testing.assert_array_equal(sin(values), np.sin(values))
    assert sqrt(2.25) == 1.5
    assert isinstance(sqrt(2.25), float)
    assert atan2(1.0, -1.0) == pytest.approx(3 * math.pi / 4)
    assert hypot(3.0, 4.0) == 5
    assert (abs_(-2.0), sign(-2.0), minimum(1.0, 2.0), maximum(1.0, 2.0)) == (2, -1, 1, 2)
    np.testing.assert_array_equal(abs_(np.array([-1.0, 2.0])), [1, 2])
    assert sin(Ball.exact(np.array([0.5]))).mid[0] == pytest.approx(math.sin(0.5))
    with pytest.raises(DomainError, match="log of a number that is not positive"):
        log(np.array([1.0, 0.0]))


def test_derivatives_carry_their_factorials() -> None:
    found = exp(Jet.variable(np.array([0.0, 1.0]), 5)).derivatives()
    np.testing.assert_allclose(found, np.tile([1, math.e], (6, 1)), rtol=1e-15)
    low, high = exp(BallJet.variable(0.0, 0.0, 5)).bounds()
    assert (low <= 1).all()
    assert (high >= 1).all()
    assert (high - low <= 1e-13).all()
    cubic = Jet.variable(2.0, 3) ** 3
    np.testing.assert_array_equal(cubic.derivatives()[:, 0], [8, 12, 12, 6])
    np.testing.assert_array_equal(cubic.derivative().derivatives()[:, 0], [12, 12, 6])


def test_whole_powers_at_zero() -> None:
    zero = Jet.variable(0.0, 3)
    np.testing.assert_array_equal((zero**0).c[:, 0], [1, 0, 0, 0])
    np.testing.assert_array_equal((zero**1).c[:, 0], [0, 1, 0, 0])
    np.testing.assert_array_equal((zero**3).c[:, 0], [0, 0, 0, 1])
    np.testing.assert_array_equal((zero**199).c[:, 0], [0, 0, 0, 0])
    np.testing.assert_array_equal((zero**3.5).c[:, 0], [0, 0, 0, 0])
    np.testing.assert_allclose((Jet.variable(-2.0, 3) ** -1).c[:, 0], [-0.5, -0.25, -0.125, -0.0625])


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("operation", "words"),
    [
        (lambda t: 1 / (t - 2), "division by zero"),
        (lambda t: t / (t - 2), "division by zero"),
        (lambda t: t / np.array([1.0, 1.0, 0.0]), "division by zero"),
        (lambda t: (t - 2) ** -1, "division by zero"),
        (lambda t: log(2 - t), "log of a number that is not positive"),
        (lambda t: sqrt(1.5 - t), "sqrt of a negative number"),
        (lambda t: sqrt(2 - t), "derivative of sqrt at zero"),
        (lambda t: cbrt(2 - t), "derivative of cbrt at zero"),
        (lambda t: asin(t - 0.5), "asin of a number outside -1 to 1"),
        (lambda t: asin(t - 1), "derivative of asin at -1 or 1"),
        (lambda t: acos(t - 0.5), "acos of a number outside -1 to 1"),
        (lambda t: acos(1 - t), "derivative of acos at -1 or 1"),
        (lambda t: (1.5 - t) ** 0.5, "fractional power of a negative number"),
        (lambda t: (2 - t) ** 1.5, "derivative of a fractional power at zero"),
        (lambda t: (2 - t) ** t, "variable power of a number that is not positive"),
        (lambda t: atan2(t - 2, t - 2), "atan2 at the origin"),
        (lambda t: hypot(t - 2, t - 2), "derivative of sqrt at zero"),
        (lambda t: exp(t * 400), "overflow in exp"),
        (lambda t: sinh(t * 400), "overflow in sinh"),
        (lambda t: t ** (199) * 1e250, "overflow"),
        (lambda t: (t + 1e308 - 1) * np.array([1.0, 1.0, 2.0]), "overflow"),
        (lambda t: t + np.array([1.0, 1.0, np.inf]), "overflow"),
        (lambda t: t.constant(np.array([1.0, 1.0, np.nan])), "a number that is not finite"),
    ],
)
def test_leaving_the_domain_names_the_operation_and_the_points(operation, words: str) -> None:
    with pytest.raises(DomainError) as caught:
        operation(Jet.variable(np.array([0.0, 1.0, 2.0]) + np.array([1e-3, 0, 0]), 2))
    assert caught.value.operation == words
    assert caught.value.indices.tolist() == [2]
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value) == f"{words} (at 1 of the points, first at index 2)"


def test_values_exist_where_derivatives_do_not() -> None:
    zero = Jet.variable(0.0, 0)
    assert [float(f(zero).c[0, 0]) for f in (sqrt, cbrt, lambda t: hypot(t, t), lambda t: asin(t + 1))] == [
        0,
        0,
        0,
        math.pi / 2,
    ]


def test_infinite_variables_are_refused() -> None:
    with pytest.raises(DomainError, match="not finite"):
        Jet.variable(np.array([1.0, math.inf]), 1)
    with pytest.raises(ValueError, match="an interval ends before it begins"):
        BallJet.variable(1.0, 0.0, 1)
    with pytest.raises(ValueError, match="an end is not a number"):
        BallJet.variable(math.nan, 1.0, 1)


@pytest.mark.parametrize(
    "operation",
    [
        lambda t: 1 / t,
        lambda t: t / t,
        lambda t: t**-2,
        log,
        sqrt,
        cbrt,
        lambda t: t**1.5,
        lambda t: asin(t + 0.95),
        lambda t: tan(t + 1.5),
        lambda t: atan2(t, t - 1),
        lambda t: exp(t * 1e4) * exp(t * 1e4),
        lambda t: t**t,
    ],
)
def test_a_ball_that_leaves_the_domain_is_unknown_and_others_beside_it_are_not(operation) -> None:
    found = operation(BallJet.variable(np.array([-0.1, 0.01]), np.array([0.1, 0.02]), 3))
    assert np.isinf(found.rad[1:, 0]).all()
    assert (found.mid[np.isinf(found.rad)] == 0).all()
    assert np.isfinite(found.rad[:, 1]).all()
    low, high = found.bounds()
    assert low[1, 0] == -math.inf
    assert high[1, 0] == math.inf
    # The unknown stays unknown through what follows, and never turns into nan.
    after = (found * found + 1) / (3 + sin(found))
    assert not np.isnan(after.mid).any()
    assert not np.isnan(after.rad).any()
    assert np.isinf(after.rad[1:, 0]).all()


def test_across_the_cut_an_angle_is_known_to_a_turn() -> None:
    found = atan2(BallJet.variable(-0.1, 0.1, 2), BallJet.variable(-0.1, 0.1, 2).constant(-1.0))
    assert found.rad[0, 0] == pytest.approx(math.pi)
    assert np.isinf(found.rad[1:, 0]).all()
    beside = atan2(BallJet.variable(0.1, 0.2, 2), BallJet.variable(0.1, 0.2, 2).constant(-1.0))
    assert (beside.rad < 0.2).all()


def test_at_a_tie_a_jet_is_that_of_the_right_hand_side() -> None:
    t = Jet.variable(np.array([-1.0, 0.0, 1.0]), 2)
    np.testing.assert_array_equal(abs_(t).c, [[1, 0, 1], [-1, 1, 1], [0, 0, 0]])
    np.testing.assert_array_equal(abs_(-t).c, abs_(t).c)
    np.testing.assert_array_equal(sign(t).c, [[-1, 1, 1], [0, 0, 0], [0, 0, 0]])
    np.testing.assert_array_equal(sign(t * t).c[0], [1, 1, 1])
    np.testing.assert_array_equal(sign(t * 0.0).c[0], [0, 0, 0])
    np.testing.assert_array_equal(maximum(t, t * t).c, [[1, 0, 1], [-2, 1, 2], [1, 0, 1]])
    np.testing.assert_array_equal(minimum(t, t * t).c, [[-1, 0, 1], [1, 0, 1], [0, 1, 0]])


def test_a_switch_inside_a_ball_keeps_value_and_slope_and_no_more() -> None:
    t = BallJet.variable(np.array([-2.0, -1.0, 1.0]), np.array([-1.0, 3.0, 2.0]), 2)
    low, high = abs_(t).bounds()
    np.testing.assert_allclose(low[:2], [[1, 0, 1], [-1, -1, 1]], atol=1e-14)
    np.testing.assert_allclose(high[:2], [[2, 3, 2], [-1, 1, 1]], atol=1e-14)
    assert np.isinf(high[2]).tolist() == [False, True, False]
    low, high = sign(t).bounds()
    np.testing.assert_allclose([low[0], high[0]], [[-1, -1, 1], [-1, 1, 1]], atol=1e-14)
    assert np.isinf(high[1:, 1]).all()
    assert (high[1:, ::2] == 0).all()
    low, high = maximum(t, 1 - t).bounds()
    np.testing.assert_allclose([low[0], high[0]], [[2, -1, 1], [3, 3, 2]], atol=1e-14)
    np.testing.assert_allclose([low[1], high[1]], [[-1, -1, 1], [-1, 1, 1]], atol=1e-14)
    low, high = minimum(t, 1 - t).bounds()
    np.testing.assert_allclose([low[0], high[0]], [[-2, -2, -1], [-1, 2, 0]], atol=1e-14)
    assert (abs_(t * 0.0)).rows.zero.all()
    assert (sign(t * 0.0)).rows.zero.all()


@given(st.floats(-2, 2), st.floats(0, 2), st.floats(0, 1))
@settings(max_examples=examples(200))
def test_switches_hold_value_and_slope_of_every_point(lower: float, width: float, part: float) -> None:
    point = min(lower + part * width, lower + width)
    balls, jet = BallJet.variable(lower, lower + width, 2), Jet.variable(point, 2)
    for f in (
        lambda t: abs_(t**3 - t),
        lambda t: maximum(sin(t), t * t - 1),
        lambda t: minimum(t, t.constant(0.5)) * t,
        lambda t: sign(t - 0.3) * (t - 0.3),
        lambda t: hypot(t + 3, t),
    ):
        low, high = f(balls).bounds()
        true = f(jet).derivatives()[:, 0]
        assert (low[:, 0] - 1e-13 <= true).all()
        assert (true <= high[:, 0] + 1e-13).all()
