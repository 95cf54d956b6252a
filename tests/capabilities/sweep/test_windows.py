"""Windows of samples within a band: against two pointers and all windows; ends against `longest_window`."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.scanned import scanned

from camgeo.capabilities.sweep.linkages import angles
from camgeo.capabilities.sweep.windows import (
    Ends,
    Samples,
    _crossing,
    _Cubic,
    cell_bounds,
    greatest,
    least,
    longest_windows,
    window_ends,
    window_lengths,
)
from kin.numeric.longest_window import dwells

TURN = 2 * math.pi


def waves(seed, m, n):
    """Random smooth functions with their slopes, and a rising abscissa with its rate; (m, n) each."""
    rng = np.random.default_rng(seed)
    t = angles(n)
    size, phase = rng.normal(size=(6, m, 1)), rng.uniform(0, TURN, size=(6, m, 1))
    f = sum(size[k - 1] / k**2 * np.cos(k * t + phase[k - 1]) for k in range(1, 6))
    g = sum(-size[k - 1] / k * np.sin(k * t + phase[k - 1]) for k in range(1, 6))
    swing, at = 0.4 * rng.random((m, 1)), rng.uniform(0, TURN, (m, 1))
    return (f, g), (t + swing * np.sin(t + at), 1 + swing * np.cos(t + at))


def sampled(f, x):
    return Samples(f[0], *cell_bounds(*f), np.stack([x[0], np.broadcast_to(angles(f[0].shape[1]), x[0].shape)]))


@pytest.mark.slow
@pytest.mark.parametrize("n", [24, 60, 360])
@pytest.mark.parametrize("band", [1e-9, 0.003, 0.2, 2.0, 50.0])
def test_the_windows_are_those_of_two_pointers(n, band):
    samples = sampled(*waves(n, 60, n))
    found, (start, cells) = longest_windows(samples, band), scanned(samples, band)
    assert np.array_equal(found.start, start)
    assert np.array_equal(found.cells, cells)


@settings(deadline=None, max_examples=examples(60))
@given(st.data())
def test_they_are_so_for_values_with_many_ties(data):
    n = data.draw(st.sampled_from([4, 8, 24]))
    rows = data.draw(st.lists(st.lists(st.integers(-3, 3), min_size=n, max_size=n), min_size=1, max_size=4))
    value = np.array(rows, dtype=float)
    after = np.roll(value, -1, axis=1)
    steps = np.array(data.draw(st.lists(st.integers(1, 5), min_size=n, max_size=n)), dtype=float)
    x = np.broadcast_to((np.cumsum(steps) - steps) * TURN / steps.sum(), value.shape)
    samples = Samples(value, np.minimum(value, after), np.maximum(value, after), np.stack([x, angles(n) + 0 * x]))
    band = data.draw(st.sampled_from([0.5, 1.0, 2.0, 2.5, 6.0]))
    found = longest_windows(samples, band)
    start, cells = scanned(samples, band)
    assert np.array_equal(found.start, start)
    assert np.array_equal(found.cells, cells)


def reach_of_all(samples, band, row, k):
    """Greatest reach of any window that no further cell fits into, tried one after another."""
    value, low, high, x = samples.value[row], samples.low[row], samples.high[row], samples.abscissae[k, row]
    n = len(value)

    def fits(i, c):
        if c == 0:
            return True
        cells = np.arange(i, i + c) % n
        return high[cells].max() - low[cells].min() <= band

    best, at = -1.0, None
    for i in range(n):
        c = max(c for c in range(n + 1) if fits(i, c))
        if c == n:
            return 0, n
        if fits(i - 1, c + 1):
            continue
        cells = np.arange(i, i + c) % n
        bottom = min(value[i], low[cells].min()) if c else value[i]
        top = max(value[i], high[cells].max()) if c else value[i]
        parts, sides = [], []
        for node, other in ((i, i - 1), (i + c, i + c + 1)):
            inside, outside = value[node % n], value[other % n]
            share, side = 1.0, 0
            if outside > bottom + band:
                share, side = (bottom + band - inside) / (outside - inside), 1
            elif outside < top - band:
                share, side = (inside - (top - band)) / (inside - outside), -1
            gap = abs((x[other % n] + TURN * (other // n)) - (x[node % n] + TURN * (node // n)))
            parts.append(share * gap)
            sides.append(side)
        inner = x[(i + c) % n] + TURN * ((i + c) // n) - x[i]
        reach = inner + (max(parts) if sides[0] * sides[1] < 0 else sum(parts))
        if reach > best + 1e-12:
            best, at = reach, (i, c)
    return at


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("band", [0.01, 0.1, 0.6, 30.0])
def test_no_window_reaches_farther(band):
    samples = sampled(*waves(5, 12, 40))
    found = longest_windows(samples, band)
    for k in (0, 1):
        for row in range(12):
            assert (found.start[k, row], found.cells[k, row]) == reach_of_all(samples, band, row, k)


def test_a_constant_is_one_window():
    flat = np.full((2, 24), 3.0)
    found = longest_windows(Samples(flat, flat, flat, (angles(24) + 0 * flat)[None]), 1e-9)
    assert (found.cells == 24).all()
    none = flat[:0]
    assert longest_windows(Samples(none, none, none, none[None]), 1.0).start.shape == (1, 0)


def lengths_of(wave, band):
    f, x = wave
    samples = sampled(f, x)
    found = longest_windows(samples, band)
    theta = np.broadcast_to(angles(f[0].shape[1]), f[0].shape)
    over = (x, (theta, np.ones_like(theta)))
    bounds = samples.low, samples.high
    return [window_lengths(window_ends((found.start[k], found.cells[k]), f, over[k], bounds), band) for k in (0, 1)]


def exact(seed, m, row):
    """One of `waves` as a function of the angle, derivatives up to the first."""
    rng = np.random.default_rng(seed)
    size, phase = rng.normal(size=(6, m, 1))[:, row, 0], rng.uniform(0, TURN, size=(6, m, 1))[:, row, 0]

    def f(t, order):
        k = np.arange(1, 6)[:, None]
        angle = k * t + phase[:5, None]
        each = size[:5, None] / k**2
        turned = [np.cos(angle), -k * np.sin(angle), -(k**2) * np.cos(angle), k**3 * np.sin(angle)]
        return np.stack([(each * turned[i]).sum(axis=0) for i in range(order + 1)])

    return f


@pytest.mark.slow
@pytest.mark.thin(3)
@pytest.mark.parametrize("band", [0.003, 0.05, 0.4])
def test_lengths_are_those_of_kin(band):
    m = 12
    wanted = [dwells(exact(3, m, row), [], band)[0].length for row in range(m)]
    for n, tolerance in ((360, 5e-7), (720, 3e-8), (1440, 2e-9)):
        _, relative = lengths_of(waves(3, m, n), band)
        assert np.abs(relative - wanted).max() < tolerance


def test_the_error_falls_with_the_fourth_power_of_the_step():
    m = 40
    coarse, fine, finest = (lengths_of(waves(8, m, n), 0.02)[0] for n in (180, 360, 1440))
    ratio = np.median(np.abs(coarse - finest)) / np.median(np.abs(fine - finest))
    assert 8 < ratio < 32


@pytest.mark.slow
def test_a_window_over_the_shaft_is_not_the_one_over_the_relative_angle():
    over_shaft, relative = lengths_of(waves(2, 30, 360), 0.02)
    assert np.abs(over_shaft - relative).max() > 0.05
    assert ((over_shaft > 0) & (over_shaft < TURN)).all()


def test_parts_and_joins_of_ends_are_inverse():
    f, x = waves(4, 9, 60)
    samples = sampled(f, x)
    found = longest_windows(samples, 0.1)
    whole = window_ends((found.start[0], found.cells[0]), f, x, (samples.low, samples.high))
    halves = [whole.part(np.arange(9) < 4), whole.part(np.arange(9) >= 4)]
    for one, other in zip(whole, Ends.concatenate(halves), strict=True):
        assert np.array_equal(one, other)


def test_bounds_of_cells_hold_the_function():
    (f, g), _ = waves(6, 20, 90)
    dense, _ = waves(6, 20, 90 * 32)
    low, high = cell_bounds(f, g)
    after = np.concatenate([dense[0][:, 1:], dense[0][:, :1]], axis=1).reshape(20, 90, 32)
    inside = np.concatenate([f[:, :, None], after], axis=2)
    assert np.abs(low - inside.min(axis=2)).max() < 1e-5
    assert np.abs(high - inside.max(axis=2)).max() < 1e-5


@pytest.mark.slow
def test_where_cubics_pass_a_level():
    """Every hundredth of such cubics takes more steps than all are given together."""
    rng = np.random.default_rng(8)
    size = 10.0 ** rng.uniform(-3.0, 3.0, (4, 200_000))
    every = _Cubic(*(rng.standard_normal(size.shape) * size))
    slopes = np.stack([every.slope(x) for x in np.linspace(0.0, 1.0, 65)])
    for sense, monotone in ((1, (slopes > 0.0).all(axis=0)), (-1, (slopes < 0.0).all(axis=0))):
        cubic = _Cubic(*(row[monotone] for row in every))
        count = np.count_nonzero(monotone)
        x = rng.uniform(0.0, 1.0, count)
        found = _crossing(cubic, np.full(count, sense, dtype=np.int8), cubic(x), np.zeros(count), np.ones(count))
        rise = np.abs(cubic(np.ones(count)) - cubic.f)
        assert (np.abs(cubic(found) - cubic(x)) < 1e-12 * (rise + np.abs(cubic.f))).all()


def test_extremes_between_samples():
    (f, _), _ = waves(7, 20, 360)
    dense = waves(7, 20, 36_000)[0][0]
    for extreme, of in ((greatest, np.max), (least, np.min)):
        assert np.abs(extreme(f, True) - of(dense, axis=1)).max() < 5e-6
        assert np.array_equal(extreme(f, False), of(f, axis=1))
    flat = np.full((1, 8), 2.0)
    assert greatest(flat, True) == least(flat, True) == 2.0
