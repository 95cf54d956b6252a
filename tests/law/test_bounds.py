"""Proved bounds over stretches: what holds is proved, what does not is placed."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from kin.law.bounds import cubic_cells, highest, unbounded, undecided
from kin.law.piecewise import Piecewise
from kin.law.segment import AffineStretch, Constant
from kin.numeric.angles import TURN
from kin.numeric.elementary import sin


class Counted:
    """A function that counts the intervals it is asked about."""

    def __init__(self, function):
        self.function = function
        self.asked = 0

    def __call__(self, t):
        self.asked += len(t.mid[0])
        return self.function(t)


@pytest.mark.thin(2)
@pytest.mark.parametrize("margin", [1e-1, 1e-4, 1e-8, 1e-12])
def test_a_maximum_just_below_a_limit_is_proved_at_little_cost(margin):
    counted = Counted(lambda t: sin(t) + t * 0.0)
    wave = Counted(lambda t: sin(t * 3.0) * sin(t * 3.0) + sin(t * 3.0 + math.pi / 2) ** 2)  # 1, which balls cannot see
    assert undecided(counted, 0.0, 3.0, {0: (-math.inf, 1 + margin)}) is None
    assert undecided(wave, 0.0, 3.0, {0: (0.0, 1 + max(margin, 1e-8))}) is None
    assert counted.asked < 1000
    assert wave.asked < 400000


@pytest.mark.parametrize("margin", [0.0, 1e-12, 1e-4, 0.5])
def test_a_limit_that_is_reached_is_refused_where_it_is(margin):
    found = undecided(sin, 0.0, 3.0, {0: (-math.inf, 1 - margin)})
    assert found is not None
    k, at = found
    assert k == 0
    assert math.sin(at) >= 1 - margin - 1e-9


def test_each_derivative_has_limits_of_its_own():
    limits = {0: (-2.0, 2.0), 1: (-1.5, 2.9)}
    assert undecided(lambda t: sin(t * 3.0), 0.0, 1.0, limits) == pytest.approx((1, 0.0), abs=0.2)
    assert undecided(lambda t: sin(t * 3.0), 0.3, 0.6, limits) is None
    assert undecided(lambda t: sin(t * 3.0) * 3.0, 0.3, 0.6, limits)[0] == 0
    assert undecided(lambda t: sin(t * 3.0), 0.3, 1.0, {1: (-1.5, 2.9)})[1] > 0.6


def test_poles_are_unbounded_and_placed():
    assert unbounded(lambda t: 1 / (t - 1.0), 0.0, 0.999, 2) is None
    assert unbounded(lambda t: 1 / (t - 1.0), 0.0, 1.5, 2) == pytest.approx(1.0, abs=1e-9)
    assert unbounded(lambda t: t**0.5, 0.0, 1.0, 1) == pytest.approx(0.0, abs=1e-9)


def test_highest_is_found_by_weight_and_side():
    law = Piecewise(np.array([0.0, 2.0, 4.0]), (sin, AffineStretch(sin, scale=3.0, start=2.0)))
    assert highest(law, [1.0, 1.0], 0)[0] == pytest.approx(2 + math.pi / 2, abs=1e-7)
    assert highest(law, [1.0, 1.0], 0)[1] == pytest.approx(3.0, rel=1e-15)
    assert highest(law, [1.0, 0.1], 0)[0] == pytest.approx(math.pi / 2, abs=1e-7)
    assert highest(law, [1.0, 0.1], 0)[1] == pytest.approx(1.0, rel=1e-15)
    assert highest(law, [1.0, 1.0], 1) == (2.0, 3.0)
    falling = Piecewise(np.array([0.0, 1.0, 2.0]), (AffineStretch(Constant(1.0)), Constant(0.5)))
    assert highest(falling, [1.0, 4.0], 0)[1] == 2.0


def test_cells_of_a_cubic_are_halved_several_times_at_once():
    asked = []

    def enclosure(low, _high, order):
        asked.append(len(low))
        assert order == 4
        return np.zeros((5, len(low))), np.ones((5, len(low)))

    # of width h a cubic strays by h^4/384: 256 cells to the turn by 1e-9
    cells = cubic_cells(SimpleNamespace(enclosure=enclosure), np.zeros(0), 1e-9)
    assert cells == pytest.approx(np.linspace(0.0, TURN, 257), abs=1e-12)
    assert asked == [16, 128, 256]


def test_several_stretches_are_decided_together():
    """t^2 stays below 4 on [0, 1] and [1, 1.9], and does not on [1, 2.1]; its slope 2 t is below 4 on the same."""
    begin = np.array([0.0, 1.0])
    assert undecided(lambda t: t * t, begin, np.array([1.0, 1.9]), {0: (-1.0, 4.0), 1: (-1.0, 4.0)}) is None
    blame, at = undecided(lambda t: t * t, begin, np.array([1.0, 2.1]), {0: (-1.0, 4.0)})
    assert blame == 0
    assert 1.9 < at <= 2.1
