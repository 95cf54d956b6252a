"""The free motion of an oscillator, at 60 digits and in closed form."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.dynamics_oracle import Oracle
from support.trains import moved, oscillator

from kin.dynamics.oscillator import Oscillator

TURN = 2.0 * math.pi
RATIOS = (1.25, 3.3, 10.3, 97.3, 1000.5, 1e4 + 0.3, 1e5 + 0.3)
DAMPINGS = (0.0, 1e-3, 0.1, 0.7, 1.0 - 1e-12, 1.0, 1.0 + 1e-9, 2.0)


@pytest.mark.thin(5)
@pytest.mark.parametrize("zeta", [*DAMPINGS, 9.0])
@pytest.mark.parametrize("t", [0.0, 1e-9, 0.01, 1.0, TURN])
@pytest.mark.parametrize("r", [1e-3, 1.0, 30.5, 1e5])
def test_the_propagator_at_sixty_digits(r, zeta, t):
    got = oscillator(r, zeta).propagator(np.array([t]))
    oracle = Oracle(r, zeta)
    for (z, v), zz, vz in (((1.0, 0.0), got.zz, got.vz), ((0.0, 1.0), got.zv, got.vv)):
        at_z, at_v = (float(x) for x in oracle.free(z, v, t))
        phase = 1e-14 + 4e-16 * r * t  # the angle r t is rounded, whatever one does
        size = max(abs(at_z), abs(at_v) / r)
        assert zz[0] == pytest.approx(at_z, rel=2e-14 * (1.0 + r * t), abs=phase * size)
        assert vz[0] == pytest.approx(at_v, rel=2e-14 * (1.0 + r * t), abs=phase * size * r)


@settings(max_examples=examples(100))
@given(
    st.tuples(st.floats(1e-3, 1e4), st.floats(0.0, 5.0)),
    st.tuples(st.floats(0.0, 0.1), st.floats(0.0, 0.1)),
    st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)),
)
def test_times_add_up(figures, times, state):
    (r, zeta), (one, two), (z, v) = figures, times, state
    free = oscillator(r, zeta)
    start = np.array([[z], [v * r]])
    there = moved(free, moved(free, start, np.array([one])), np.array([two]))
    at_once = moved(free, start, np.array([one + two]))
    assert np.abs(there - at_once).max() <= 1e-12 * (1.0 + r) * (1.0 + r * (one + two))


def test_a_free_mass_moves_straight_on():
    assert moved(Oscillator(0.0, 0.0), np.array([[2.0], [3.0]]), np.array([4.0])).tolist() == [[14.0], [3.0]]


@pytest.mark.parametrize("zeta", [0.0, 0.01, 0.5, 1.0, 3.0])
def test_the_bound_of_a_free_motion_holds_and_is_reached_where_it_swings(zeta):
    free = oscillator(7.0, zeta)
    rng = np.random.default_rng(2)
    for state in rng.normal(size=(20, 2, 1)) * np.array([[1.0], [7.0]]):
        z = moved(free, np.repeat(state, 4000, axis=1), np.linspace(0.0, 5.0, 4000))[0]
        bound = float(free.bound(state)[0])
        assert np.abs(z).max() <= bound * (1.0 + 1e-12)
        if zeta == 0.0:
            assert np.abs(z).max() > 0.999 * bound


@pytest.mark.parametrize("figures", [(-1.0, 1.0), (0.0, -1.0), (math.nan, 1.0), (0.0, math.inf)])
def test_an_oscillator_has_finite_figures(figures):
    with pytest.raises(ValueError, match="finite"):
        Oscillator(*figures)
