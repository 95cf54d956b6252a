"""Balls hold every value they should (mpmath, 40 digits), are tight where that is cheap, and say what they cannot."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.numeric import interval
from kin.numeric.interval import Ball

moderate = st.floats(-50, 50)
anything = st.floats(allow_nan=False, allow_infinity=False)
widths = st.sampled_from([0.0, 1e-15, 1e-9, 1e-3, 0.3, 4.0])
parts = st.floats(0, 1)


def sine(x):
    return interval.sin_cos(x)[0]


def cosine(x):
    return interval.sin_cos(x)[1]


FUNCTIONS = {  # name: (balls, mpmath, where the function is defined)
    "sin": (sine, mpmath.sin, (-1e4, 1e4)),
    "cos": (cosine, mpmath.cos, (-1e4, 1e4)),
    "tan": (interval.tan, mpmath.tan, (-1.55, 1.55)),
    "asin": (interval.asin, mpmath.asin, (-1, 1)),
    "acos": (interval.acos, mpmath.acos, (-1, 1)),
    "atan": (interval.atan, mpmath.atan, (-1e6, 1e6)),
    "sinh": (interval.sinh, mpmath.sinh, (-700, 700)),
    "cosh": (interval.cosh, mpmath.cosh, (-700, 700)),
    "tanh": (interval.tanh, mpmath.tanh, (-30, 30)),
    "exp": (interval.exp, mpmath.exp, (-600, 700)),
    "log": (interval.log, mpmath.log, (1e-300, 1e300)),
    "sqrt": (interval.sqrt, mpmath.sqrt, (0, 1e300)),
    "cbrt": (interval.cbrt, lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x)), (-1e300, 1e300)),
    "absolute": (interval.absolute, abs, (-1e300, 1e300)),
}


def between(lower: float, upper: float) -> Ball:
    return Ball.between(np.array([lower]), np.array([upper]))


def holds(found: Ball, value: mpmath.mpf) -> bool:
    """Both in the ball and between its bounds, in exact arithmetic."""
    lower, upper = found.bounds()
    distance = abs(value - mpmath.mpf(float(found.mid[0])))
    return bool(distance <= mpmath.mpf(float(found.rad[0])) and lower[0] <= value <= upper[0])


def inside(lower: float, upper: float, part: float) -> float:
    return min(max(lower + part * (upper - lower), lower), upper)


intervals = st.builds(lambda a, w, part: (a, a + w, inside(a, a + w, part)), moderate, widths, parts)
Interval = tuple[float, float, float]  # two ends and a number between them


@given(anything, anything)
def test_a_ball_between_two_ends_holds_both_and_little_more(a: float, b: float) -> None:
    lower, upper = min(a, b), max(a, b)
    found = between(lower, upper)
    assert holds(found, mpmath.mpf(lower))
    assert holds(found, mpmath.mpf(upper))
    if upper - lower < 1e308:
        low, high = found.bounds()
        slack = 1e-14 * max(abs(lower), abs(upper)) + 1e-320
        assert lower - slack <= low[0] <= high[0] <= upper + slack


@given(intervals, intervals)
@example((1e-200, 1e-200, 1e-200), (1e-200, 1e-200, 1e-200))
@example((3e-310, 3e-310, 3e-310), (0.3, 0.3, 0.3))
def test_arithmetic_holds_every_result(one: Interval, other: Interval) -> None:
    x, y, b = between(*one[:2]), between(*other[:2]), other[0]
    p, q = mpmath.mpf(one[2]), mpmath.mpf(other[2])
    assert holds(x + y, p + q)
    assert holds(x - y, p - q)
    assert holds(x * y, p * q)
    assert holds(x * b, p * mpmath.mpf(b))
    assert holds(x + b, p + mpmath.mpf(b))
    assert holds(b - x, mpmath.mpf(b) - p)
    if q != 0:
        assert holds(x / y, p / q)
        assert holds(1.0 / y, 1 / q)
    if b != 0:
        assert holds(x / b, p / mpmath.mpf(b))


@given(st.fractions(-100, 100), moderate, widths, parts)
def test_a_plain_number_stands_for_the_real_number_it_is_nearest_to(written, a: float, wa: float, pa: float) -> None:
    x, p = between(a, a + wa), mpmath.mpf(inside(a, a + wa, pa))
    real = mpmath.mpf(written.numerator) / written.denominator
    assert holds(x * float(written), p * real)
    assert holds(x + float(written), p + real)
    if written:
        assert holds(x / float(written), p / real)


@given(st.sampled_from([-7, -2, -1, 0, 1, 2, 3, 5, 12, 199, 0.5, -0.5, 1.5, 1 / 3]), moderate, widths, parts)
@example(2, -1e-200, 2e-200, 0.3)
def test_powers_hold_every_result(exponent: float, a: float, wa: float, part: float) -> None:
    if exponent != int(exponent):
        a = abs(a)
    found, p = between(a, a + wa) ** exponent, mpmath.mpf(inside(a, a + wa, part))
    if p == 0 and exponent < 0:
        assert found.rad[0] == math.inf
    else:
        assert holds(found, p ** mpmath.mpf(exponent) if exponent else mpmath.mpf(1))


@given(moderate, widths, parts)
def test_a_table_of_powers_holds_every_result(a: float, wa: float, part: float) -> None:
    table, p = between(a, a + wa).powers(7), mpmath.mpf(inside(a, a + wa, part))
    assert all(holds(table[k], p**k) for k in range(7))


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", FUNCTIONS)
@given(parts, widths, parts)
@settings(max_examples=examples(60))
def test_functions_hold_every_value(name: str, place: float, width: float, part: float) -> None:
    function, exact, (least, greatest) = FUNCTIONS[name]
    a = inside(least, greatest, place)
    b = min(a + width, greatest)
    assert holds(function(between(a, b)), exact(mpmath.mpf(inside(a, b, part))))


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_of_single_numbers_are_off_by_less_than_they_are_allowed(name: str) -> None:
    """The allowance of 8 ulp is an assumption on numpy; this measures it (about 0.5 ulp is usual)."""
    function, exact, (least, greatest) = FUNCTIONS[name]
    rng = np.random.default_rng(5)
    x = np.concatenate((rng.uniform(least, greatest, 200), rng.uniform(max(least, -3), min(greatest, 3), 200)))
    found = function(Ball.exact(x))
    for mid, rad, value in zip(found.mid, found.rad, x, strict=True):
        true = exact(mpmath.mpf(value))
        assert abs(mpmath.mpf(mid) - true) <= 0.5 * rad or rad == 0
        assert rad <= 40 * 2.0**-53 * abs(float(true)) + 1e-299


@pytest.mark.thin(2)
@pytest.mark.parametrize("quarter", range(4))
def test_extrema_are_not_missed_where_the_turns_of_a_large_angle_are_rounded(quarter: int) -> None:
    """Intervals that only just reach over a maximum or minimum, near 1e15 where a turn is known to 0.1 at best."""
    extremes = [(mpmath.mpf(quarter) / 4 + turn) * 2 * mpmath.pi for turn in range(10**14, 10**14 + 200)]
    lower = np.array([float(x) - 0.25 for x in extremes])
    upper = np.array([float(x) + 0.25 for x in extremes])
    for edges in ((lower, np.array([float(x) for x in extremes])), (np.array([float(x) for x in extremes]), upper)):
        x = Ball.between(*edges)
        found = (cosine if quarter % 2 == 0 else sine)(x)
        sign = 1 if quarter < 2 else -1
        for i, (true, a, b) in enumerate(zip(extremes, *edges, strict=True)):
            if a <= true <= b:
                assert holds(found[i : i + 1], mpmath.mpf(sign))


@given(intervals, intervals)
@example((-1.0, 1.0, 0.5), (-3.0, -2.0, -2.5))
@example((0.0, 0.0, 0.0), (-3.0, -3.0, -3.0))
@example((5e-324, 5e-324, 5e-324), (4.0, 4.0, 4.0))
def test_angles_hold_every_value(y: Interval, x: Interval) -> None:
    found = interval.atan2(between(*y[:2]), between(*x[:2]))
    assert holds(found, mpmath.atan2(mpmath.mpf(y[2]), mpmath.mpf(x[2])))


@pytest.mark.parametrize(
    ("found", "lower", "upper"),
    [
        (sine(between(0.5, 2.0)), math.sin(0.5), 1.0),
        (sine(between(-2.0, 4.0)), -1.0, 1.0),
        (sine(between(4.0, 5.0)), -1.0, math.sin(4.0)),
        (sine(between(4.5, 4.9)), -1.0, math.sin(4.5)),
        (cosine(between(-0.25, 0.5)), math.cos(0.5), 1.0),
        (cosine(between(3.0, 3.5)), -1.0, math.cos(3.5)),
        (cosine(between(1.0, 2.0)), math.cos(2.0), math.cos(1.0)),
        (between(-2.0, 1.0) ** 2, 0.0, 4.0),
        (between(-2.0, 1.0) ** 3, -8.0, 1.0),
        (between(2.0, 4.0) ** -1, 0.25, 0.5),
        (between(-4.0, -2.0) ** -2, 1 / 16, 0.25),
        (interval.cosh(between(-1.0, 0.5)), 1.0, math.cosh(1.0)),
        (interval.absolute(between(-1.0, 3.0)), 0.0, 3.0),
        (interval.tan(between(2.0, 2.5)), math.tan(2.0), math.tan(2.5)),
        (interval.atan2(between(1.0, 2.0), between(-1.0, 1.0)), math.pi / 4, 3 * math.pi / 4),
        (interval.atan2(between(-1.0, 1.0), between(1.0, 2.0)), -math.pi / 4, math.pi / 4),
        (interval.hull(between(0.0, 1.0), between(3.0, 4.0)), 0.0, 4.0),
    ],
)
def test_ranges_are_the_true_ones(found: Ball, lower: float, upper: float) -> None:
    low, high = found.bounds()
    assert low[0] == pytest.approx(lower, rel=1e-14, abs=1e-15)
    assert high[0] == pytest.approx(upper, rel=1e-14, abs=1e-15)


def test_the_values_of_sine_and_even_powers_stay_in_their_range() -> None:
    for function in (sine, cosine):
        low, high = function(between(-1e9, 1e9)).bounds()
        assert low[0] == pytest.approx(-1, abs=1e-15)
        assert high[0] == pytest.approx(1, abs=1e-15)
    assert (between(-3.0, 2.0) ** 2).bounds()[0][0] == 0
    assert interval.sqrt(between(-3.0, 2.0) ** 2).bounds()[0][0] == 0
    assert interval.exp(between(-2000.0, 1.0)).bounds()[0][0] == 0


@pytest.mark.parametrize(
    "found",
    [
        between(-1.0, 1.0) ** -1,
        between(0.0, 1.0) ** -2,
        between(-1.0, 1.0) ** 0.5,
        interval.log(between(0.0, 1.0)),
        interval.sqrt(between(-1e-300, 1.0)),
        interval.asin(between(0.5, 1.0000001)),
        interval.acos(between(-2.0, 0.0)),
        interval.tan(between(1.5, 1.6)),
        interval.tan(between(0.0, 4.0)),
        interval.exp(between(0.0, 1000.0)),
        between(1e200, 2e200) * between(1e200, 2e200),
        between(1.0, 2.0) + Ball(np.zeros(1), np.array([math.inf])),
        interval.log(Ball(np.zeros(1), np.array([math.inf]))),
        Ball.between(np.array([-math.inf]), np.array([1.0])),
        Ball.exact(np.full((1,), math.nan)),
    ],
)
def test_what_cannot_be_enclosed_is_unknown(found: Ball) -> None:
    assert found.rad[0] == math.inf
    assert found.mid[0] == 0
    assert not found.positive[0]
    assert not found.negative[0]


def test_sine_and_angle_are_known_even_of_the_unknown() -> None:
    unknown = Ball(np.zeros(1), np.array([math.inf]))
    assert sine(unknown).rad[0] == pytest.approx(1, abs=1e-15)
    assert holds(interval.atan2(unknown, unknown), mpmath.pi)


def test_exact_numbers_stay_exact_where_nothing_is_rounded() -> None:
    zero, x = Ball.exact(np.full((1,), 0.0)), between(1.0, 2.0)
    assert (zero * x).zero.all()
    assert (x * 0.0).zero.all()
    assert (zero + zero).zero.all()
    assert not (x - x).zero.any()
    one = x**0
    assert one.mid[0] == 1
    assert one.rad[0] == 0
    assert [edge[0] for edge in between(2.0, 2.0).bounds()] == [2.0, 2.0]


def test_signs_are_certain_or_not_given() -> None:
    balls = Ball.between(np.array([-1.0, -1.0, 0.0, 1e-9, 0.0]), np.array([-0.5, 1.0, 1.0, 1.0, 0.0]))
    assert balls.positive.tolist() == [False, False, False, True, False]
    assert balls.negative.tolist() == [True, False, False, False, False]
    assert balls.zero.tolist() == [False, False, False, False, True]
