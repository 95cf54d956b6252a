"""Piecewise functions: folding, sides at knots, enclosures over knots."""

import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Constant, Harmonics
from kin.numeric.elementary import BallJet, DomainError, Jet, log, sin

TURN = 2 * math.pi
SLACK = 8e-15  # a ball's ends are rounded outwards


@dataclass(frozen=True)
class Fenced:
    """scale sin(t) that may not be asked beyond its stretch by more than `slack`."""

    low: float
    high: float
    scale: float
    slack: float = 0.0

    def __call__(self, t):
        lower, upper = (t.c[0], t.c[0]) if isinstance(t, Jet) else t.rows[0].bounds()
        assert (lower >= self.low - self.slack).all()
        assert (upper <= self.high + self.slack).all()
        return sin(t) * self.scale


def rectified(begin=0.0, slack=0.0):
    """abs(sin t) for points, its arches fenced; begins at a multiple of pi."""
    knots = begin + np.array([0.0, math.pi, TURN])
    sense = 1.0 if round(begin / math.pi) % 2 == 0 else -1.0
    arches = [Fenced(knots[i], knots[i + 1], sense * (-1) ** i, slack) for i in (0, 1)]
    return Piecewise(knots, tuple(arches), TURN)


def test_sides_at_a_knot():
    f = rectified()
    assert f.derivatives(math.pi, 1, 1)[1, 0] == pytest.approx(1, abs=1e-15)
    assert f.derivatives(math.pi, 1, -1)[1, 0] == pytest.approx(-1, abs=1e-15)


@pytest.mark.thin(4)
@pytest.mark.parametrize("turns", [-1000, -3, -1, 0, 1, 2, 1000])
@pytest.mark.parametrize("ulps", [-3, 0, 3])
@pytest.mark.parametrize("knot", [0.0, math.pi])
def test_what_is_within_a_few_ulps_of_a_knot_takes_the_side_asked_for(turns, ulps, knot):
    t = knot + turns * TURN
    t += ulps * np.spacing(max(abs(t), TURN))
    f = rectified()
    slopes = [f.derivatives(t, 1, side)[1, 0] for side in (1, -1)]
    assert slopes == pytest.approx([1, -1], abs=1e-15)


def test_just_below_the_period_is_the_last_stretch_and_not_zero():
    f = rectified()
    for t in (TURN - 1e-12, -1e-12):
        assert f.locate(np.array([t]))[0][0] == 1
    assert f.locate(np.array([-1e-300]), 1)[0][0] == 0
    assert f.locate(np.array([-1e-300]), -1)[0][0] == 1
    assert f.locate(np.array([-1e-300]), -1)[1][0] == TURN


@settings(deadline=None)
@given(st.floats(-50, 50), st.sampled_from([1, -1]), st.sampled_from([0.0, -math.pi, 3 * math.pi]))
def test_points_stay_inside_their_stretch(t, side, begin):
    value, slope = rectified(begin).derivatives(t, 1, side)[:, 0]
    assert value == pytest.approx(abs(math.sin(t)), abs=1e-13)
    assert abs(slope) == pytest.approx(abs(math.cos(t)), abs=1e-13)


@settings(deadline=None)
@given(st.floats(-20, 20), st.floats(0, 15), st.floats(0, 1))
def test_an_enclosure_holds_every_value_inside(lower, width, share):
    upper = lower + width
    f = rectified(slack=SLACK)
    mid, rad = f.enclosure(lower, upper, 3)
    inside = min(max(lower + share * width, lower), upper)
    for side in (1, -1):
        if lower + 1e-14 < inside < upper - 1e-14:
            assert (np.abs(f.derivatives(inside, 3, side) - mid) <= rad + 1e-15).all()


def test_an_enclosure_takes_both_sides_of_a_knot_inside_and_one_at_an_end():
    f = rectified(slack=SLACK)
    mid, rad = f.enclosure(np.array([3.0, 3.0, math.pi, 3.1]), np.array([3.2, math.pi, 3.2, 10.0]), 1)
    low, high = mid[1] - rad[1], mid[1] + rad[1]
    assert (low[0], high[0]) == pytest.approx((-1, 1))
    assert (low[1], high[1]) == pytest.approx((-1, math.cos(3.0)))
    assert (low[2], high[2]) == pytest.approx((-math.cos(3.2), 1))
    assert (low[3], high[3]) == pytest.approx((-1, 1))


def test_an_enclosure_at_a_knot_holds_both_limits():
    mid, rad = rectified(slack=SLACK).enclosure(math.pi, math.pi, 1)
    assert mid[1, 0] - rad[1, 0] <= -1 < 1 <= mid[1, 0] + rad[1, 0]


def test_an_enclosure_is_tight_on_the_stretches_it_touches():
    knots = np.array([0.0, 1.0, 2.0, 3.0])
    f = Piecewise(knots, (Constant(1.0), Constant(2.0), Constant(5.0)), 3.0)
    mid, rad = f.enclosure(np.array([0.5, 0.5, 1.5, 2.5, -0.5]), np.array([0.9, 1.5, 2.5, 3.5, 40.0]), 0)
    assert (mid - rad)[0] == pytest.approx([1, 1, 2, 1, 1])
    assert (mid + rad)[0] == pytest.approx([1, 2, 5, 5, 5])


def test_an_enclosure_of_an_unbounded_argument_says_what_the_whole_turn_does():
    f = rectified(slack=SLACK)
    unknown = BallJet(np.zeros((1, 1)), np.full((1, 1), math.inf))
    low, high = f.on(unknown).bounds()
    assert (low[0, 0], high[0, 0]) == pytest.approx((-1e-15, 1), abs=1e-13)


def test_a_function_of_a_jet_follows_the_chain_rule():
    f = rectified()
    t = np.array([0.3, 2.0, 4.0, 7.0])
    twice = f.on(Jet.variable(t, 2) * 2.0).derivatives()
    at = f.derivatives(2 * t, 2)
    np.testing.assert_allclose(twice, at * np.array([1.0, 2.0, 4.0])[:, None], atol=1e-14)


def test_without_a_period_the_ends_are_the_ends():
    f = Piecewise(np.array([0.0, 1.0, 2.0]), (Constant(1.0), Constant(2.0)))
    assert f.derivatives(np.array([0.0, 1.0, 2.0]), 0, 1)[0].tolist() == [1, 2, 2]
    assert f.derivatives(np.array([0.0, 1.0, 2.0]), 0, -1)[0].tolist() == [1, 1, 2]
    assert f.breaks.tolist() == [1.0]
    for outside in (-1e-9, 2 + 1e-9):
        with pytest.raises(ValueError, match=r"outside 0\.0 to 2\.0"):
            f.derivatives(outside, 0)
        with pytest.raises(ValueError, match=r"outside 0\.0 to 2\.0"):
            f.enclosure(min(outside, 1.0), max(outside, 1.0), 0)
    with pytest.raises(ValueError, match="not finite"):
        f.locate(np.array([math.nan]))


def test_breaks_are_folded_and_a_smooth_seam_is_none():
    knots = np.array([-1.0, 1.0, TURN - 1.0])
    functions = (Constant(1.0), Constant(2.0))
    assert Piecewise(knots, functions, TURN).breaks.tolist() == [1.0, TURN - 1.0]
    assert Piecewise(knots, functions, TURN, smooth_seam=True).breaks.tolist() == [1.0]
    at, jump = Piecewise(knots, functions, TURN).jumps(1)
    assert at.tolist() == [1.0, TURN - 1.0]
    assert jump.tolist() == [[1.0, -1.0], [0.0, 0.0]]


@pytest.mark.parametrize(
    ("knots", "count", "period"),
    [
        ([0.0, 1.0], 2, None),
        ([0.0], 0, None),
        ([0.0, 0.0], 1, None),
        ([1.0, 0.0], 1, None),
        ([0.0, math.inf], 1, None),
        ([0.0, 1.0], 1, 2.0),
    ],
)
def test_unsound_descriptions_are_refused(knots, count, period):
    with pytest.raises(ValueError, match=r"functions cannot lie|must be finite and rise|the period is"):
        Piecewise(np.array(knots), (Constant(0.0),) * count, period)


def test_a_domain_error_names_the_points_as_given():
    f = Piecewise(np.array([-1.0, 0.5, 1.0]), (log, Constant(0.0)))
    with pytest.raises(DomainError) as caught:
        f.derivatives(np.array([0.7, 0.2, -0.5, 0.8, -0.2]), 1)
    assert caught.value.indices.tolist() == [2, 4]


def test_moved_and_stretched():
    f = AffineStretch(Harmonics(0.5, ((1, 0.0, 2.0), (3, 1.0, 0.0))), offset=10.0, scale=-2.0, start=0.3, width=-1.5)
    t = np.linspace(-2, 2, 7)
    x = (t - 0.3) / -1.5
    value = 10 - 2 * (0.5 + 2 * np.sin(x) + np.cos(3 * x))
    slope = -2 * (2 * np.cos(x) - 3 * np.sin(3 * x)) / -1.5
    np.testing.assert_allclose(f(Jet.variable(t, 1)).derivatives(), [value, slope], atol=1e-13)
