"""The function of least mean square jerk within bounds, against its kernel, its conditions, and other functions."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.heavy import optimize

from kin.law.sources import least_jerk
from kin.law.sources.least_jerk import (
    Bounds,
    CrowdedError,
    Curve,
    FunctionSpace,
    LowerLimit,
    Touch,
    curve_through,
    excess_of_bounds,
    least,
    nearest_parabola,
    pulls,
)

TURN = 2 * math.pi
FREE = (None, None)


def bounds(x, s, reading):
    x, s = np.asarray(x, dtype=float), np.asarray(s, dtype=float)
    reading = np.broadcast_to(reading, x.shape).astype(float)
    return Bounds(x, s - reading, s + reading, reading, np.arange(len(x)))


def round_kernel(x, t):
    """Reproducing kernel of the integral of S'''^2 over a turn, by its Fourier series (Wahba 1990, chapter 2)."""
    k = np.arange(1, 400)
    return (np.cos(np.subtract.outer(x, t)[..., None] * k) / (math.pi * k**6)).sum(axis=-1)


def by_kernel(x, lo, hi):
    """The least integral of S'''^2 of functions with values from lo to hi, as a least-squares problem in the values."""
    inverse = np.linalg.inv(round_kernel(x, x))
    one = inverse.sum(axis=1)
    energy = inverse - np.outer(one, one) / one.sum()  # less the constant that costs nothing
    values, vectors = np.linalg.eigh(energy)
    root = np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T
    return 2.0 * optimize.lsq_linear(root, np.zeros(len(x)), (lo, hi), tol=1e-15, max_iter=1000).cost


@pytest.mark.thin(2)
@pytest.mark.parametrize("reading", [0.02, 0.2, 0.6])
def test_the_integral_is_that_of_the_kernel(reading):
    x = np.arange(12) * TURN / 12 + 0.03 * np.sin(7.0 * np.arange(12))
    s = 3 - 3 * np.cos(x) + 0.4 * np.sin(5 * x)
    found = least(FunctionSpace(0.0, TURN), bounds(x, s, reading))
    assert found.square == pytest.approx(by_kernel(x, s - reading, s + reading), rel=1e-6)


def by_free_kernel(x, lo, hi):
    """The same of functions with free ends, by the kernel |x - t|^5 of the sixth derivative (Wahba 1990, chapter 2)."""
    kernel = -(np.abs(np.subtract.outer(x, x)) ** 5) / (2.0 * math.factorial(5))
    across = np.linalg.qr(np.vander(x, 3), mode="complete")[0][:, 3:]  # less the parabolas that cost nothing
    energy = across @ np.linalg.inv(across.T @ kernel @ across) @ across.T
    values, vectors = np.linalg.eigh(energy)
    root = np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T
    return 2.0 * optimize.lsq_linear(root, np.zeros(len(x)), (lo, hi), tol=1e-15, max_iter=1000).cost


@pytest.mark.thin(2)
@pytest.mark.parametrize("reading", [0.002, 0.02, 0.2])
def test_with_free_ends_the_integral_is_that_of_their_kernel(reading):
    x = np.linspace(0.0, 3.0, 13) + 0.03 * np.sin(7.0 * np.arange(13))
    s = 2.0 * x - np.exp(-x) + 0.3 * np.sin(3 * x)
    space = FunctionSpace(-0.5, 3.5, FREE)
    found = least(space, bounds(x, s, reading))
    assert found.square == pytest.approx(by_free_kernel(x, s - reading, s + reading), rel=1e-6)
    conditions(found, space, bounds(x, s, reading))
    # towards the ends of the space it goes on as a parabola
    for end, beyond in ((found.x[0], space.begin), (found.x[-1], space.end)):
        u = np.linspace(end, beyond, 5)
        fit = np.polyfit(u - end, found.curve(u), 2)
        assert np.polyval(fit, u - end) == pytest.approx(found.curve(u), abs=1e-12)


@settings(max_examples=examples(40), deadline=None)
@given(seed=st.integers(0, 10**6), count=st.integers(4, 40), share=st.floats(0.0, 3.0))
@pytest.mark.parametrize("stretch", [1.0, 250.0])
def test_a_parabola_is_found_where_one_keeps_the_bounds_and_none_else(seed, count, share, stretch):
    """Against linear programming: the least miss of any parabola."""
    rng = np.random.default_rng(seed)
    x = np.cumsum(rng.uniform(0.01, 0.2, count)) * stretch
    s = np.polyval(rng.normal(size=3), x / stretch) + 0.01 * share * rng.uniform(-1, 1, count)
    limits = bounds(x, s, 0.01 * rng.uniform(0.5, 1.5, count))
    space = FunctionSpace(float(x[0]), float(x[-1]), FREE)
    found = nearest_parabola(space, limits)
    powers = np.vander((x - x[0]) / (x[-1] - x[0]), 3)
    # least m with lo - m unit <= p(x) <= hi + m unit
    sides = np.block([[powers, -limits.unit[:, None]], [-powers, -limits.unit[:, None]]])
    miss = optimize.linprog([0, 0, 0, 1], sides, np.append(limits.hi, -limits.lo), bounds=[(None, None)] * 4).fun
    if miss > 1e-4:
        assert isinstance(found, Touch)
        at = found.which
        pull, _ = pulls(space, x[at], np.where(found.upper, limits.hi[at], limits.lo[at]))
        assert (pull * np.where(found.upper, -1.0, 1.0) > 0).all()
    elif miss < -1e-4:
        excess, _ = excess_of_bounds(found, limits)
        assert excess.max() == pytest.approx(miss, abs=1e-5)
        assert found.square(space.begin, space.end) == pytest.approx(0.0, abs=1e-20)


@pytest.mark.parametrize("rest", [(None, 0.4), (0.4, None)])
@pytest.mark.parametrize("count", [0, 1, 2, 9, 80])
def test_one_end_may_be_free_and_the_other_at_rest(rest, count):
    """The spline keeps to its values and both ends, is C4, and its fifth derivative jumps by the multipliers."""
    rng = np.random.default_rng(count)
    x = np.sort(rng.uniform(0.1, 1.9, count)) if count < 80 else np.linspace(0.1, 1.9, count)
    s = 0.4 + (2.0 - x if rest[0] is None else x) ** 3 * np.cos(x)
    space = FunctionSpace(0.0, 2.0, rest)
    curve = curve_through(space, x, s)
    assert curve(x) == pytest.approx(s, abs=1e-12)
    at_rest, free = (2.0, 0.0) if rest[0] is None else (0.0, 2.0)
    assert [float(curve(np.array([at_rest]), k)[0]) for k in range(3)] == pytest.approx([0.4, 0, 0], abs=1e-8)
    assert float(curve(np.array([free]), 3)[0]) == 0.0
    pull, square = pulls(space, x, s)
    assert curve.square(0.0, 2.0) == pytest.approx(square, rel=1e-8, abs=1e-20)
    size = np.abs(pull).max(initial=1.0)
    *jumps, last = (curve(x, k) - curve(x - 1e-9, k) for k in range(6))
    assert all(np.abs(jump).max(initial=0.0) <= 1e-6 * size for jump in jumps)
    assert -last == pytest.approx(pull, rel=1e-5, abs=1e-6 * size)


def conditions(found, space, limits):
    """Bounds are kept, multipliers have their signs, and vanish where no bound is touched."""
    miss, _ = excess_of_bounds(found.curve, limits)
    assert miss.max() <= 1e-5
    assert (found.pull * np.where(found.upper, -1.0, 1.0) > 0).all()
    assert found.curve(found.x) == pytest.approx(found.values, abs=1e-9 * np.abs(found.values).max())
    again, square = pulls(space, found.x, found.values)
    assert again == pytest.approx(found.pull)
    assert found.curve.square(space.begin, space.end) == pytest.approx(square, rel=1e-6)
    if space.rest is None:
        assert abs(found.pull.sum()) <= 1e-6 * np.abs(found.pull).sum()


@settings(max_examples=examples(60), deadline=None)
@given(
    seed=st.integers(0, 10**6),
    count=st.integers(5, 60),
    places=st.integers(0, 5),
    stroke=st.floats(0.5, 40),
    rest=st.booleans(),
)
def test_the_conditions_of_a_least_hold(seed, count, places, stroke, rest):
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(0.05, TURN - 0.05, count))
    x = x[np.append(True, np.diff(x) > 1e-3)]
    s = np.round(stroke * (0.5 - 0.5 * np.cos(x) + 0.1 * np.sin(4 * x + seed)), places)
    space = FunctionSpace(0.0, TURN, (0.0, 0.0) if rest else None)
    limits = bounds(x, s, 0.5 * 10.0**-places)
    found = least(space, limits)
    if found is None:
        assert limits.lo.max() <= limits.hi.min()
    else:
        conditions(found, space, limits)


@pytest.mark.slow
@pytest.mark.parametrize("rest", [None, (0.3, -0.2), FREE, (None, -0.2)])
@pytest.mark.parametrize("count", [69, 70, 71, 72, 73, 95, 96, 97, 120, 241, 700])
def test_equations_in_blocks_have_the_solution_of_all_at_once(count, rest, monkeypatch):
    rng = np.random.default_rng(count)
    x = (np.arange(count) + rng.uniform(0.1, 0.9, count)) * TURN / count
    s = np.cos(x) + 0.01 * rng.uniform(-1.0, 1.0, count)
    space = FunctionSpace(0.0, TURN, rest)
    pull, square = pulls(space, x, s)
    curve = curve_through(space, x, s)
    least_jerk._blocks.cache_clear()
    monkeypatch.setattr(least_jerk, "_BLOCK", 10**6)
    whole, again = pulls(space, x, s), curve_through(space, x, s)
    least_jerk._blocks.cache_clear()
    assert pull == pytest.approx(whole[0], rel=1e-9, abs=1e-9 * np.abs(whole[0]).max())
    assert square == pytest.approx(whole[1], rel=1e-10)
    theta = np.linspace(0.0, TURN, 999)
    for order in range(4):
        other = again(theta, order)
        assert curve(theta, order) == pytest.approx(other, abs=1e-9 * np.abs(other).max())


def test_no_other_function_within_the_bounds_has_less():
    """Splines through other values within the bounds, and with other knots."""
    rng = np.random.default_rng(3)
    x = np.arange(40) * TURN / 40
    s = np.round(4 - 4 * np.cos(x) + 0.5 * np.cos(3 * x), 1)
    space, limits = FunctionSpace(0.0, TURN), bounds(x, s, 0.05)
    found = least(space, limits)
    for _ in range(50):
        other = curve_through(space, x, s + rng.uniform(-0.05, 0.05, 40))
        assert other.square(0.0, TURN) > found.square
        mixed = curve_through(space, x, 0.99 * found.curve(x) + 0.01 * (s + rng.uniform(-0.05, 0.05, 40)))
        assert mixed.square(0.0, TURN) > found.square


def test_where_the_search_begins_makes_no_difference():
    x = np.arange(180) * TURN / 180
    s = np.round(5 - 5 * np.cos(x) + 0.7 * np.sin(4 * x), 3)
    space, limits = FunctionSpace(0.0, TURN), bounds(x, s, 0.0005)
    plain = least(space, limits)
    wide = least(space, bounds(x, s, 0.05))
    again = least(space, limits, wide.touch)
    assert again.square == pytest.approx(plain.square, rel=1e-9)
    theta = np.linspace(0, TURN, 500)
    assert again.curve(theta, 2) == pytest.approx(plain.curve(theta, 2), abs=1e-5)


def test_many_bounds_are_the_same_as_all_at_once(monkeypatch):
    x = np.arange(900) * TURN / 900
    s = np.round(5 - 5 * np.cos(x) + 0.7 * np.abs(np.sin(x)) ** 3, 3)
    space, limits = FunctionSpace(0.0, TURN), bounds(x, s, 0.0005)
    plain = least(space, limits)
    monkeypatch.setattr("kin.law.sources.least_jerk._FEW", 100)
    few = least(space, limits)
    assert few.square == pytest.approx(plain.square, rel=1e-9)
    assert excess_of_bounds(few.curve, limits)[0].max() <= 1e-5


@pytest.mark.thin(2)
@pytest.mark.parametrize("count", [3_000, 120_000])
def test_a_search_among_noise_ends_before_it_touches_a_thousand_bounds(count, monkeypatch):
    knots = []
    third = least_jerk._spline
    monkeypatch.setattr(least_jerk, "_spline", lambda space, x, s: knots.append(len(x)) or third(space, x, s))
    monkeypatch.setattr(least_jerk, "_MOST_WORK", 0.02 * least_jerk._MOST_WORK)
    noise = np.random.default_rng(1).uniform(0.0, 10.0, count)
    with pytest.raises(CrowdedError):
        least(FunctionSpace(0.0, TURN), bounds(np.arange(count) * TURN / count, noise, 0.1))
    assert max(knots) < 1000
    assert sum(k**3 for k in knots) <= least_jerk._MOST_WORK


def test_a_solve_of_too_many_knots_is_not_begun():
    x = np.arange(20_000) * TURN / 20_000
    limits = bounds(x, np.cos(x), 1e-9)
    with pytest.raises(CrowdedError):
        least(FunctionSpace(0.0, TURN), limits, Touch(np.arange(20_000), np.zeros(20_000, dtype=bool)))


def test_a_hundred_thousand_rounded_bounds_take_a_hundredth_of_the_work(monkeypatch):
    monkeypatch.setattr(least_jerk, "_MOST_WORK", 0.01 * least_jerk._MOST_WORK)
    x = np.arange(100_000) * TURN / 100_000
    assert len(least(FunctionSpace(0.0, TURN), bounds(x, np.round(5 - 5 * np.cos(x), 3), 0.0005)).x) < 200


def test_a_function_above_a_floor_touches_it_and_costs_more():
    x = np.arange(24) * TURN / 24
    s = np.where(np.abs(x - math.pi) < 1.0, 5.0, 0.0)
    space, limits = FunctionSpace(0.0, TURN), bounds(x, s, 0.001)
    free, held = least(space, limits), least(space, limits, limit=LowerLimit(0.0, 1e-9))
    assert free.curve.lowest()[1] < -0.3
    assert held.curve.lowest()[1] >= -1e-9
    assert held.square > free.square
    assert (held.row < 0).any()


def test_a_constant_has_no_least():
    x = np.arange(6.0)
    assert least(FunctionSpace(0.0, TURN), bounds(x, [1.0, 1.2, 0.9, 1.1, 1.0, 1.0], 0.2)) is None


def test_between_two_rests_it_is_the_polynomial_345_without_bounds():
    found = least(FunctionSpace(1.0, 3.0, (2.0, 6.0)), bounds([2.0], [4.0], 1.0))
    u = np.linspace(0.0, 1.0, 11)
    assert found.curve(1.0 + 2.0 * u) == pytest.approx(2.0 + 4.0 * u**3 * (10.0 - 15.0 * u + 6.0 * u * u))
    assert found.square == pytest.approx(16.0 * 720.0 / 2.0**5)
    assert found.curve.peak(1.0, 3.0) == pytest.approx(4.0 * 5.7735 / 4.0, rel=1e-4)


def test_jumps_of_the_fifth_derivative_are_the_multipliers():
    x = np.array([0.2, 1.1, 2.0, 3.3, 4.9])
    s = np.array([0.0, 2.0, 3.0, 1.0, 0.5])
    curve = curve_through(FunctionSpace(0.0, TURN), x, s)
    fifth = 120.0 * curve.coefficients[5] / curve.widths**5
    jumps = fifth - np.roll(fifth, 1)
    assert pulls(FunctionSpace(0.0, TURN), x, s)[0] == pytest.approx(-jumps)
    for order in range(5):
        ends = [curve(np.array([place - 1e-9, place + 1e-9]), order) for place in x]
        assert all(abs(b - a) < 1e-5 * max(1.0, abs(a)) for a, b in ends)


def test_the_peak_of_a_curve_is_its_greatest_second_derivative():
    """Of pieces whose second derivatives are cubics, parabolas and lines, against many samples."""
    rng = np.random.default_rng(3)
    rows = rng.normal(size=(6, 40))
    rows[5, 10:] = rows[4, 25:] = 0.0
    for k in range(40):
        curve = Curve(np.zeros(1), np.array([rng.uniform(0.3, 2.0)]), rows[:, k : k + 1], 0.0)
        x = np.linspace(0.0, curve.widths[0], 2001)
        sampled = float(np.abs(curve(x, 2)).max())
        assert sampled * (1.0 - 1e-12) <= curve.peak(0.0, x[-1]) <= sampled * 1.00001 + 1e-5
