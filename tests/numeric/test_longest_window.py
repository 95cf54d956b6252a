"""Dwells: against a sweep of two pointers over dense samples, and on functions whose dwells are known."""

import math
from collections import deque
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from support.cases import examples

from kin.numeric.longest_window import Window, _Family, dwells, longest_of_each

TURN = 2 * math.pi
SAMPLES = 3000


def wave(cos, sin):
    k = np.arange(1, len(cos) + 1)[:, None]
    return lambda x, _order: (np.array(cos) @ np.cos(k * x) + np.array(sin) @ np.sin(k * x))[None]


def through(points, period=TURN):
    """The polyline through points (x, f), which begin at 0 and close at the period."""
    x, y = np.array(points, dtype=float).T
    assert x[0] == 0
    assert x[-1] == period
    return lambda at, _order: np.interp(at, x, y)[None]


def spread(f, a, b, period=TURN, corners=()):
    """Range over [a, b], from below: of samples, and of corners, which may be a period on."""
    corners = np.array([corner + k * period for corner in corners for k in (-1, 0, 1, 2)])
    at = np.concatenate([np.linspace(a, b, 10001), corners[(corners > a) & (corners < b)]])
    y = f(np.mod(at, period), 0)[0]
    return y.max() - y.min()


def sampled(f, band, period=TURN):
    """Length of the longest window from each of the samples, in steps."""
    y = f(np.arange(SAMPLES) * (period / SAMPLES), 0)[0]
    if y.max() - y.min() <= band:
        return np.full(SAMPLES, SAMPLES)
    y = np.concatenate([y, y])
    tops, bottoms, begin = deque(), deque(), 0
    length = np.zeros(SAMPLES, dtype=int)
    for j in range(2 * SAMPLES):
        while tops and y[tops[-1]] <= y[j]:
            tops.pop()
        tops.append(j)
        while bottoms and y[bottoms[-1]] >= y[j]:
            bottoms.pop()
        bottoms.append(j)
        while y[tops[0]] - y[bottoms[0]] > band:
            if begin < SAMPLES:
                length[begin] = j - 1 - begin
            begin += 1
            for ends in (tops, bottoms):
                if ends[0] < begin:
                    ends.popleft()
    return np.minimum(length, SAMPLES)


def overlap(one, begin, length, period):
    forth, back = (begin - one.start) % period, (one.start - begin) % period
    return forth < one.length or back < length


def judged(f, found, band, period=TURN, corners=()):
    """Every window is of the band, apart from the others, longer than the next, and locally longest."""
    lengths = [w.length for w in found]
    assert all(a >= b - 1e-9 * period for a, b in pairwise(lengths))
    for w in found:
        assert 0 <= w.start < period
        assert 0 < w.length <= period
        assert w.end == w.start + w.length
        assert band - 1e-5 * (1 + band) < spread(f, w.start, w.end, period, corners) + (w.length == period) * band
        assert spread(f, w.start, w.end, period, corners) <= band + 1e-9
        for other in found:
            if other is not w:
                forth = (other.start - w.start) % period
                assert w.length - 1e-9 <= forth <= period - other.length + 1e-9
        if w.length == period:
            assert len(found) == 1
            continue
        assert w.greatest - w.least == pytest.approx(band, rel=1e-12)
        at_ends = f(np.mod([w.start, w.end], period), 0)[0]
        assert np.minimum(np.abs(at_ends - w.least), np.abs(at_ends - w.greatest)).max() < 1e-9
        more = 1e-5 * period
        ends = np.array([[w.start], [w.end]])
        to_corner = np.abs((ends - np.array(corners) + 0.5 * period) % period - 0.5 * period).min(initial=np.inf)
        for shift in (-1e-3, -1e-5, 0.0, 1e-5, 1e-3):
            if shift and 1e-9 * period < to_corner < abs(shift) + more:
                continue  # on a straight flank all windows are alike up to its corner, where longer ones may begin
            assert spread(f, w.start + shift, w.end + shift + more, period, corners) > band - 1e-5 * (1 + band)
            assert spread(f, w.start + shift - more, w.end + shift, period, corners) > band - 1e-5 * (1 + band)


def complete(f, found, band, most, period=TURN):
    """The longest is found, and none is missing where the sampled length has a clear peak."""
    length = sampled(f, band, period) * (period / SAMPLES)
    step = period / SAMPLES
    assert length.max() - 0.5 * step <= found[0].length <= length.max() + 2.01 * step
    if len(found) == most:
        return
    for i in np.flatnonzero(length > 10 * step):
        left, right = length[np.arange(i - 60, i) % SAMPLES], length[np.arange(i + 1, i + 61) % SAMPLES]
        lower = length[i] - 4 * step
        if length[i] < max(left.max(), right.max()) or left.min() > lower or right.min() > lower:
            continue
        # flat peaks are only found to many steps, and one that meets a longer dwell is none
        near = [w for w in found if overlap(w, (i - 40) * step, length[i] + 80 * step, period)]
        assert near, (i * step, length[i])


coefficients = st.lists(st.floats(-1, 1), min_size=1, max_size=6)


@pytest.mark.slow
@settings(max_examples=examples(50))
@given(coefficients, coefficients, st.floats(-3, 0.7))
def test_random_waves(cos, sin, exponent):
    size = min(len(cos), len(sin))
    cos, sin = cos[:size], sin[:size]
    assume(max(map(abs, cos + sin)) > 1e-3)
    f, band = wave(cos, sin), 10**exponent
    found = dwells(f, [], band, most=20)
    judged(f, found, band)
    complete(f, found, band, 20)


@pytest.mark.slow
@settings(max_examples=examples(60))
@given(
    st.lists(st.tuples(st.floats(0.05, 1), st.integers(-4, 4)), min_size=3, max_size=9),
    st.floats(-2, 1),
)
@example([(1.0, 0), (0.5, 0), (0.5, 0), (0.05078125, 2), (1.0, -2)], 0.0)
@example([(1, 0), (1, 0), (1, 4), (0.25, 0), (0.05078125, 1), (1, -4), (1, 0), (1, 1), (1, -1)], 0.0)
def test_random_polylines_with_corners_and_rests(steps, exponent):
    """Values on a grid, so that plateaus, equal extremes and equal slopes are common."""
    x = np.concatenate([[0.0], np.cumsum([step for step, _ in steps])])
    x = np.round(x * (SAMPLES / x[-1])) * (TURN / SAMPLES)  # the samples below meet every corner
    x[-1] = TURN
    y = np.array([*(0.25 * value for _, value in steps), 0.25 * steps[0][1]])
    f, band = through(np.stack([x, y], axis=1)), 10**exponent
    found = dwells(f, x[1:-1], band, most=30)
    judged(f, found, band, corners=x)
    complete(f, found, band, 30)


def test_a_sine_dwells_about_its_extremes_and_then_where_it_is_steepest():
    band = 0.01
    found = dwells(lambda x, _: np.sin(x)[None], [], band)
    half = math.acos(1 - band)
    assert [w.length for w in found[:2]] == pytest.approx([2 * half] * 2, abs=1e-11)
    assert [w.start for w in found[:2]] == pytest.approx([math.pi / 2 - half, 3 * math.pi / 2 - half], abs=1e-11)
    assert (found[0].greatest, found[1].least) == pytest.approx((1.0, -1.0), abs=1e-15)
    # at the steepest place the window is the shortest there is about it, not a dwell
    assert len(found) == 2


def test_slopes_balance_about_a_flat_place_of_a_monotone_stretch():
    """f = x + sin x, folded back over the other half of the period."""
    period = 4 * math.pi

    def f(x, _order):
        y = np.where(x <= period / 2, x, period - x)
        return (y + np.sin(y))[None]

    band = 0.02
    first = dwells(f, [period / 2], band, period)[:2]
    # about pi: f(pi + h) - f(pi - h) = 2 (h - sin h)
    low, high = 0.0, 1.0
    for _ in range(100):
        h = 0.5 * (low + high)
        low, high = (h, high) if 2 * (h - math.sin(h)) < band else (low, h)
    assert sorted(w.start for w in first) == pytest.approx([math.pi - h, 3 * math.pi - h], abs=1e-9)
    assert [w.length for w in first] == pytest.approx([2 * h, 2 * h], abs=1e-10)
    assert first[0].least == pytest.approx(math.pi - band / 2, abs=1e-9)


@pytest.mark.slow
def test_an_interior_wiggle_smaller_than_the_band_is_within_the_dwell_and_a_larger_one_divides_it():
    """sin x + sin(3 x)/9, flat to the fourth order at pi/2, with a wiggle 0.02 high."""
    f = wave([0] * 20, [1.0, 0, 1 / 9, *[0] * 16, 0.01])
    inside, outside = dwells(f, [], 0.03), dwells(f, [], 0.015)
    judged(f, inside, 0.03)
    judged(f, outside, 0.015)
    assert inside[0].length > 1.0
    assert outside[0].length < 0.35


def test_a_constant_output_is_one_dwell_of_a_whole_period():
    assert dwells(lambda x, _: np.full((1, len(x)), 3.0), [1.0], 1e-3) == (Window(0.0, TURN, 3.0, 3.0),)
    (whole,) = dwells(lambda x, _: 0.4999 * np.sin(3 * x)[None], [], 1.0)
    assert whole.length == TURN
    assert (whole.least, whole.greatest) == pytest.approx((-0.4999, 0.4999), abs=1e-12)


def test_a_band_that_is_exactly_the_range_is_a_whole_period():
    (whole,) = dwells(lambda x, _: 0.05 * np.sin(x)[None], [], 0.1)
    assert whole.length == TURN


def test_a_wiggle_of_exactly_the_band():
    """A plateau with a ripple from edge to edge of the band is one dwell, not several."""

    def f(x, _order):
        off = x - math.pi
        ripple = 0.05 * np.sin(4 * math.pi * off)
        return np.where(np.abs(off) <= 1.0, ripple, 0.3 * (np.abs(off) - 1.0))[None]

    found = dwells(f, [math.pi - 1, math.pi + 1], 0.1)
    judged(f, found, 0.1)
    # and on either side up to where the slope of 0.3 has risen from 0 to the edge at 0.05
    assert found[0].start == pytest.approx(math.pi - 1 - 0.05 / 0.3, abs=1e-9)
    assert found[0].length == pytest.approx(2.0 + 2 * 0.05 / 0.3, abs=1e-9)


def test_a_valley_and_a_plateau_that_differ_by_exactly_the_band_are_one_window():
    """Extremes and ends to 15 digits by mpmath; the nodes are some 1e-13 off them."""
    cos, sin = [0.35, 0.31, -0.99, 0.02, 0.45, 0.52], [0.41, 0.77, 0.51, 0.84, -0.17, -0.93]
    (longest,) = dwells(wave(cos, sin), [], 0.15436937015341767, most=1)
    assert longest.length == pytest.approx(0.439430292512221, abs=1e-9)
    assert longest.start == pytest.approx(TURN - 0.0917996456136898, abs=1e-9)


def test_a_rest_between_two_rises_is_found_with_the_faster_neighbour_left_out():
    """0 to 1 at slope 1, rest, 1 to 2 at slope 2: the band is best spent on the slower side."""
    f = through([(0, 0), (1, 1), (2, 1), (2.5, 2), (TURN, 0)])
    (first, *_rest) = dwells(f, [1, 2, 2.5], 0.1)
    assert (first.start, first.length) == pytest.approx((0.9, 1.1), abs=1e-12)
    assert (first.least, first.greatest) == pytest.approx((0.9, 1.0), abs=1e-12)


def test_a_dwell_runs_through_zero():
    f = wave([1.0], [0.0])
    found = dwells(f, [], 0.1)
    half = math.acos(0.9)
    assert {round(w.start, 9) for w in found[:2]} == {round(TURN - half, 9), round(math.pi - half, 9)}
    through_zero = max(found, key=lambda w: w.start)
    assert through_zero.end == pytest.approx(TURN + half, abs=1e-10)


def test_another_period_and_breaks_given_beyond_it():
    f = through([(0, 0), (1, 1), (2, 0.5), (3, 0)], period=3)
    found = dwells(f, [4.0, -1.0], 0.2, period=3)
    judged(f, found, 0.2, 3, corners=(1, 2, 3))
    assert found[0].start == pytest.approx(1 - 0.2, abs=1e-12)
    assert found[0].length == pytest.approx(0.2 + 0.4, abs=1e-12)


def test_as_many_as_are_asked_for():
    f = wave([0, 0, 0, 1.0], [0] * 4)
    assert len(dwells(f, [], 0.01, most=3)) == 3
    found = dwells(f, [], 0.01)
    assert len(found) == 8
    assert [w.length for w in found] == pytest.approx([2 * math.acos(0.99) / 4] * 8, abs=1e-10)
    assert found[0].start < found[1].start, "of equals the one that begins first"


def test_a_uniform_ramp_has_windows_of_one_length():
    f = through([(0, 0), (3, 3), (TURN, 0)])
    found = dwells(f, [3], 0.3, most=40)
    judged(f, found, 0.3, corners=(3, TURN))
    assert found[0].length == pytest.approx(0.3 + 0.3 * (TURN - 3) / 3, abs=1e-10)


def test_values_are_never_asked_for_at_a_jump_of_the_slope_while_cells_are_made():
    asked = []

    def f(x, order):
        assert order == 0
        asked.append(x)
        return np.abs(np.sin(x))[None]

    dwells(f, [0.0, math.pi], 0.01)
    assert not np.isin(asked[0], [0.0, math.pi, TURN]).any()


def test_an_output_that_jumps_is_refused():
    with pytest.raises(ValueError, match=r"jumps by 0\.5 at 6\.28"):
        dwells(lambda x, _: (0.5 * x / TURN)[None], [], 0.01)
    with pytest.raises(ValueError, match=r"jumps by 2 at 3"):
        dwells(lambda x, _: np.where(x < 3, 1.0, -1.0)[None], [3.0, 0.0], 0.01)


@pytest.mark.parametrize("band", [0.0, -1.0, math.nan, math.inf, 1e-16])
def test_bands_that_cannot_be(band):
    with pytest.raises(ValueError, match="band"):
        dwells(lambda x, _: np.sin(x)[None], [], band)


@pytest.mark.slow
def test_a_band_close_to_rounding_is_still_resolved():
    f, band = wave([1.0, 0.2], [0.3, 0.0]), 1e-10
    found = dwells(f, [], band)
    judged(f, found, band)
    assert found[0].length > 1e-5


@pytest.mark.parametrize("power", [1, 3, 9, 15])
def test_slopes_that_hardly_differ_are_balanced_nevertheless(power):
    class Flat(_Family):
        def ends(self, a):
            return a, np.maximum(0.3 - a, 0.0) ** power, np.maximum(a - 0.3, 0.0) ** power

    search = SimpleNamespace(period=1.0)
    family = Flat(search, *(np.zeros(1, dtype=dtype) for dtype in (int, int, bool)))
    at = np.array([0.0]), np.array([0.9])
    before, after = np.array([0.3**power]), np.array([-(0.6**power)])
    assert family.refined(*at, before, after)[0] == pytest.approx(0.3, abs=3e-12)


def counted(monkeypatch):
    """Numbers of windows whose ends are asked for, call by call."""
    counts, ends = [], _Family.ends

    def counting(family, a):
        counts.append(len(a))
        return ends(family, a)

    monkeypatch.setattr(_Family, "ends", counting)
    return counts


def test_flanks_along_which_the_slope_rises_or_falls_are_not_searched(monkeypatch):
    counts = counted(monkeypatch)

    def cycloidal(x, _order):
        u = np.where(x < np.pi, x, TURN - x) / np.pi
        return (u - np.sin(2 * np.pi * u) / (2 * np.pi))[None]

    top, bottom = dwells(cycloidal, [np.pi], 0.002)
    # near a rest s = (2 pi u)^3/(12 pi), and as far on either side of it
    length = 2 * np.pi * np.cbrt(6 * 0.002 / (2 * np.pi) ** 2)
    assert [top.length, bottom.length] == pytest.approx([length, length], rel=0.01)
    assert sum(counts) < 300  # each range of starts at both its ends, none of them halved


@pytest.mark.slow
def test_a_band_from_a_valley_to_a_rest_is_settled(monkeypatch):
    """Where f is flat at both ends no part of the slopes settles a range, which was halved without end."""
    calls, ends = [], _Family.ends

    def counting(family, a):
        calls.append(len(a))
        assert len(calls) < 500
        return ends(family, a)

    monkeypatch.setattr(_Family, "ends", counting)
    x, y = np.array([0.0, 1.6, 2.1, 3.8, TURN]), np.array([0.0, 4.0, -2.0, 0.0, 0.0]) / 7.0

    def f(at, _order):
        i = np.clip(np.searchsorted(x, at, side="right") - 1, 0, 3)
        return (y[i] + (y[i + 1] - y[i]) * (1.0 - np.cos(np.pi * (at - x[i]) / (x[i + 1] - x[i]))) / 2.0)[None]

    found = dwells(f, x, 2.0 / 7.0)
    # from where the fall comes through 0, two thirds of its stroke down, to the end of the rest
    start = 1.6 + 0.5 * math.acos(-1.0 / 3.0) / np.pi
    assert found[0].start == pytest.approx(start, abs=1e-6)
    assert found[0].end == pytest.approx(TURN, abs=1e-3)


def test_few_steps_balance_the_slopes(monkeypatch):
    counts = counted(monkeypatch)
    period = 4 * math.pi

    def f(x, _order):
        y = np.where(x <= period / 2, x, period - x)
        return (y + np.sin(y) + 0.05 * np.sin(2.0 * y + 0.4))[None]

    dwells(f, [period / 2], 0.02, period)
    assert 0 < sum(0 < count <= 2 for count in counts) <= 12


def test_the_longest_of_each_section_is_that_of_the_section_alone():
    """Three sections of a bent polyline, each followed by a roof far above the band."""
    x = np.array([0, 1, 2, 3, 3.5, 4, 5, 6, 7, 8, 8.5, 9, 10, 11, 12, 12.25, TURN * 2])
    y = np.array([0, 1, 0.9, 1.4, 20, 0, 0.1, 0.6, 0.5, 0.7, 21, 0, 0.4, 0.1, 0.3, 22, 0])
    edges = np.array([0.0, 4.0, 9.0, 2 * TURN])

    def bent(t, _order):
        return (np.interp(t, x, y) + 0.2 * np.sin(2.0 * t))[None]

    every = dwells(bent, x, 0.3, 2 * TURN, most=50)
    for low, high, longest in zip(edges[:-1], edges[1:], longest_of_each(bent, x, 0.3, edges), strict=True):
        alone = next(dwell for dwell in every if low < dwell.start + 0.5 * dwell.length < high)
        assert [longest.start, longest.length] == pytest.approx([alone.start, alone.length], abs=1e-9)
