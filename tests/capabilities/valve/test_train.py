"""The lift of a valve by that of its tappet."""

import numpy as np
import pytest

from camgeo.capabilities.valve.train import Valve


def test_ratio_and_lash_of_a_constant_rocker():
    valve = Valve(((0.0, 1.5),), 0.3)
    rows = valve.rows(np.array([[0.1, 2.0], [3.0, 3.0], [4.0, 4.0]]))
    assert rows[:, 0].tolist() == [0.0, 0.0, 0.0]  # on its seat
    assert rows[:, 1] == pytest.approx([2.7, 4.5, 6.0])
    assert valve.follower_lift(2.7) == pytest.approx(2.0)


def test_derivatives_of_a_rocker_by_a_table_are_its_slopes():
    valve = Valve(((0.0, 1.4), (3.0, 1.5), (6.0, 1.58), (10.0, 1.6)), 0.2)
    t, h = np.linspace(0.5, 9.5, 40), 1e-5
    places = valve.travel(t)
    beside = [valve.travel(t + step)[0] for step in (-h, h)]
    assert places[1] == pytest.approx((beside[1] - beside[0]) / (2.0 * h), rel=1e-8)
    assert places[2] == pytest.approx((valve.travel(t + h)[1] - valve.travel(t - h)[1]) / (2.0 * h), abs=1e-8)
    lift = valve.follower_lift(5.0)
    assert valve.travel(np.array([lift]))[0, 0] - 0.2 == pytest.approx(5.0, abs=1e-12)
