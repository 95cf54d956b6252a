"""Where a mechanism binds or turns back, on margins and rates that are known functions."""

import math

import numpy as np
import pytest

from kin.linkage.mobility import mobility
from kin.numeric.angles import TURN

NONE = np.zeros(0)


def test_a_mechanism_that_turns_has_its_margin_and_its_least_rate():
    mobile = mobility(
        [lambda t: np.stack([2.0 + np.cos(t), 5.0 - np.sin(t)])], lambda t: 1.0 - 0.25 * np.sin(t), np.sin, NONE, 10.0
    )
    assert mobile.turns
    assert (mobile.loop, mobile.binds, mobile.reverses) == (0, (), ())
    assert mobile.margin == pytest.approx(1.0)
    assert mobile.margin_at == pytest.approx(math.pi, abs=1e-6)
    assert (mobile.least_rate, mobile.rate_at) == pytest.approx((0.75, 0.5 * math.pi), abs=1e-6)
    assert mobile.nearest[0] == pytest.approx((math.pi, 0.5 * math.pi), abs=1e-6)


def test_a_loop_that_binds_does_so_over_a_span_which_may_run_through_zero():
    mobile = mobility([lambda t: (0.5 - np.cos(t))[None]], np.cos, np.ones_like, NONE, 1.0)
    (span,) = mobile.binds
    assert span == pytest.approx((TURN - math.pi / 3, TURN + math.pi / 3), abs=1e-9)
    assert mobile.margin == pytest.approx(-0.5)
    assert (mobile.turns, mobile.reverses) == (False, ())
    assert math.isnan(mobile.least_rate)


def test_a_shaft_turns_back_where_its_rate_is_below_zero():
    mobile = mobility([lambda t: np.ones((1, len(t)))], lambda t: 0.5 + np.cos(t), np.cos, NONE, 1.0)
    (span,) = mobile.reverses
    assert span == pytest.approx((2 * math.pi / 3, 4 * math.pi / 3), abs=1e-9)
    assert mobile.least_rate == pytest.approx(-0.5)
    assert not mobile.turns


def test_the_second_loop_counts_where_it_is_nearer():
    loops = [lambda t: 3.0 + np.cos(t)[None], lambda t: 1.5 + np.sin(t)[None]]
    mobile = mobility(loops, np.ones_like, np.cos, NONE, 1.0)
    assert mobile.loop == 1
    assert mobile.margin == pytest.approx(0.5)
    assert len(mobile.nearest) == 2
