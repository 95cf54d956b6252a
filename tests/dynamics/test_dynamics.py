"""The linear train against closed forms at 60 digits: propagator, response, steady state, residual vibration."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.drives import Harmonic, Saw
from support.dynamics_oracle import Cycloid, Oracle, harmonic

from kin.dynamics.drive import Drive, DriveError, drives
from kin.dynamics.oscillator import Oscillator
from kin.dynamics.peaks import ResponseFigure
from kin.dynamics.response import Forcing, Samples, StiffnessError, response
from kin.dynamics.train import DynamicsError, Train, steady
from kin.numeric.chebyshev import DEGREE, DERIVATIVE, INTEGRAL, NODES, evaluated, fitted

TURN = 2.0 * math.pi
RATIOS = (1.25, 3.3, 10.3, 97.3, 1000.5, 1e4 + 0.3, 1e5 + 0.3)
DAMPINGS = (0.0, 1e-3, 0.1, 0.7, 1.0 - 1e-12, 1.0, 1.0 + 1e-9, 2.0)


def answer(oscillator, drive, phi):
    """Steady z and z' at angles phi."""
    found = response(oscillator, drive, Forcing())
    starts = found.starts(found.periodic(), 0, len(found))
    stretch = np.clip(np.searchsorted(found.drive.knots, phi, side="right") - 1, 0, len(found) - 1)
    return found.states(starts, Samples(stretch, phi - found.drive.knots[stretch]))


def oscillator(r, zeta):
    return Oscillator(zeta * r, r * r)


# --- series -----------------------------------------------------------------------------------------------------------


def test_a_polynomial_of_the_degree_is_its_own_series():
    rng = np.random.default_rng(1)
    power = rng.normal(size=9)
    series = fitted(np.polynomial.polynomial.polyval(NODES, power))
    assert series[:9] == pytest.approx(np.polynomial.chebyshev.poly2cheb(power), abs=1e-14)
    assert np.abs(series[9:]).max() < 1e-14


@pytest.mark.parametrize("count", [7, 5000])  # either way of summing
def test_values_derivative_and_integral_of_an_exponential(count):
    x = np.linspace(-1.0, 1.0, count)
    series = fitted(np.exp(NODES))[None]
    row = np.zeros(count, dtype=np.intp)
    assert evaluated(series, row, x) == pytest.approx(np.exp(x), rel=1e-14)
    assert evaluated(series @ DERIVATIVE.T, row, x) == pytest.approx(np.exp(x), abs=1e-11)
    assert evaluated(series @ INTEGRAL.T, row, x) == pytest.approx(np.exp(x) - np.exp(-1.0), abs=1e-14)


def test_the_degree_holds_four_radians():
    series = fitted(np.cos(4.0 * NODES))
    assert np.abs(series[-2:]).max() < 1e-15
    assert np.abs(fitted(np.cos(16.0 * NODES))[-2:]).max() > 1e-4


# --- the free motion --------------------------------------------------------------------------------------------------


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
    there = free.moved(free.moved(start, np.array([one])), np.array([two]))
    assert np.abs(there - free.moved(start, np.array([one + two]))).max() <= 1e-12 * (1.0 + r) * (1.0 + r * (one + two))


def test_a_free_mass_moves_straight_on():
    assert Oscillator(0.0, 0.0).moved(np.array([[2.0], [3.0]]), np.array([4.0])).tolist() == [[14.0], [3.0]]


@pytest.mark.parametrize("zeta", [0.0, 0.01, 0.5, 1.0, 3.0])
def test_the_bound_of_a_free_motion_holds_and_is_reached_where_it_swings(zeta):
    free = oscillator(7.0, zeta)
    rng = np.random.default_rng(2)
    for state in rng.normal(size=(20, 2, 1)) * np.array([[1.0], [7.0]]):
        z = free.moved(np.repeat(state, 4000, axis=1), np.linspace(0.0, 5.0, 4000))[0]
        bound = float(free.bound(state)[0])
        assert np.abs(z).max() <= bound * (1.0 + 1e-12)
        if zeta == 0.0:
            assert np.abs(z).max() > 0.999 * bound


@pytest.mark.parametrize("figures", [(-1.0, 1.0), (0.0, -1.0), (math.nan, 1.0), (0.0, math.inf)])
def test_an_oscillator_has_finite_figures(figures):
    with pytest.raises(ValueError, match="finite"):
        Oscillator(*figures)


# --- response ---------------------------------------------------------------------------------------------------------


@pytest.mark.thin(8)
@pytest.mark.parametrize("order", [1, 3, 17])
@pytest.mark.parametrize("zeta", DAMPINGS)
@pytest.mark.parametrize("r", RATIOS)
def test_a_harmonic_drive_to_nine_digits_and_more(r, zeta, order):
    (drive,) = drives([Harmonic(order)])
    phi = np.linspace(0.05, 6.2, 23)
    got = answer(oscillator(r, zeta), drive, phi)
    want = np.array([[float(x) for x in harmonic(r, zeta, order, angle)] for angle in phi]).T
    size = order**2 / abs(r**2 - order**2 + 2j * zeta * r * order)
    assert np.abs(got[0] - want[0]).max() <= 1e-11 * size
    assert np.abs(got[1] - want[1]).max() <= 1e-9 * size * order
    # the contact force, which is all that counts: r^2 z + 2 zeta r z'
    force = r * r * (got[0] - want[0]) + 2.0 * zeta * r * (got[1] - want[1])
    assert np.abs(force).max() <= 1e-10 * size * abs(r * r + 2j * zeta * r * order)


@pytest.mark.parametrize("r", [1.0 + 1e-6, 3.0, 3.0 - 1e-5])
def test_close_to_resonance(r):
    (drive,) = drives([Harmonic(3)])
    zeta = 1e-4
    phi = np.linspace(0.05, 6.2, 23)
    got = answer(oscillator(r, zeta), drive, phi)[0]
    want = np.array([float(harmonic(r, zeta, 3, angle)[0]) for angle in phi])
    assert np.abs(got - want).max() <= 1e-10 * np.abs(want).max()


@pytest.mark.thin(3)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 1.0, 2.0])
@pytest.mark.parametrize("r", [1.25, 11.3, 350.3, 1e4 + 0.3, 1e5 + 0.3])
def test_a_cycloidal_rise_and_what_rings_on_in_the_dwell(r, zeta):
    motion = Cycloid(math.radians(100.0), 2.0)
    (drive,) = drives([motion])
    found = response(oscillator(r, zeta), drive, Forcing())
    starts = found.starts(found.periodic(), 0, len(found))
    oracle = Oracle(r, zeta)
    z, v = oracle.periodic(motion.pieces())
    at = 0.0
    scale = 2.0 * TURN / motion.beta**2 / r**2  # greatest -s''/r^2
    for terms, duration in motion.pieces():
        for share in (0.0, 0.31, 0.77):
            phi = at + share * float(duration)
            i = found.drive.find(phi)
            got = found.states(starts, Samples(np.array([i]), np.array([phi - found.drive.knots[i]])))
            want = oracle.run(z, v, terms, share * duration)
            assert abs(float(got[0, 0] - want[0])) <= 1e-10 * max(scale, abs(float(want[0])))
        if not terms and zeta == 0.0:  # the amplitude in the dwell is r times smaller, and right by itself
            inside = np.flatnonzero(
                (found.drive.knots[:-1] >= at - 1e-9) & (found.drive.knots[1:] <= at + duration + 1e-9)
            )
            amplitude = float(((z**2 + (v / r) ** 2) ** 0.5).real)
            peaks = ResponseFigure.of(found, 1.0, 0.0).peaks(starts, inside)
            if r * float(duration) > TURN:
                assert peaks.greatest == pytest.approx(amplitude, rel=1e-9)
                assert -peaks.least == pytest.approx(amplitude, rel=1e-9)
        z, v = oracle.run(z, v, terms, duration)
        at += float(duration)


@pytest.mark.parametrize("zeta", [0.01, 1.0, 2.0])
@pytest.mark.parametrize("r", [1.25, 50.3, 1e5 + 0.3])
def test_a_corner_of_the_drive_is_a_blow(r, zeta):
    (drive,) = drives([Saw()])
    assert drive.jumps[drive.find(0.0)] == pytest.approx(2.0, rel=1e-14)
    assert drive.jumps[drive.find(np.pi)] == pytest.approx(-2.0, rel=1e-14)
    assert np.count_nonzero(drive.jumps) == 2
    # half a turn on it is the same with the other sign: Phi y = -(y + (0, 2))
    oracle = Oracle(r, zeta)
    (a, c), (b, d) = oracle.free(1, 0, math.pi), oracle.free(0, 1, math.pi)
    det = (1 + a) * (1 + d) - b * c
    after = (2 * b / det, -2 * (1 + a) / det)  # (1 + Phi) y = (0, -2)
    got = answer(oscillator(r, zeta), drive, np.array([1e-3, 0.7, 2.0]))
    for place, z_got in zip((1e-3, 0.7, 2.0), got[0], strict=True):
        z, _ = oracle.free(after[0], after[1], place)
        assert abs(z_got - float(z)) <= 1e-10 * max(abs(float(z)), 2.0 / r * math.exp(-zeta * r * place))


def test_where_one_rate_lies_far_below_the_other_it_is_told_what_that_costs():
    (drive,) = drives([Harmonic(17)])
    with pytest.raises(StiffnessError, match="parts of a turn are needed"):
        response(oscillator(3e6, 3e4), drive, Forcing())


def test_nothing_depends_on_the_stiffness_but_what_should():
    """The number of parts is bounded however stiff the train: no time step follows it."""
    (drive,) = drives([Harmonic(3)])
    counts = [len(response(oscillator(r, 0.1), drive, Forcing())) for r in (1.3, 10.3, 100.3, 1e3, 1e4, 1e5, 1e7)]
    assert max(counts) < 60 * len(drive)
    assert counts[-1] == counts[-2] == counts[-3] == len(drive)


# --- drives -----------------------------------------------------------------------------------------------------------


class Cusp:
    """|sin|^1.5, whose acceleration has no bound at a place that is not declared."""

    breaks = np.empty(0)
    smooth = True

    def rows(self, phi):
        w = np.sin(phi - 1.0)
        c = np.cos(phi - 1.0)
        a = np.abs(w)
        return np.stack([a**1.5, 1.5 * a**0.5 * np.sign(w) * c, 0.75 * a**-0.5 * c * c - 1.5 * a**1.5])


def test_an_undeclared_cusp_is_refused_with_its_place():
    with pytest.raises(DriveError, match=r"not better near (57\.3|237\.3|57\.2|237\.2)"):
        drives([Cusp()])


def test_a_split_drive_is_the_same_motion():
    (drive,) = drives([Harmonic(5), Cycloid(1.0, 1.0)][:1], also=[0.123])
    parts = np.arange(len(drive)) % 4 + 1
    cut = drive.split(parts)
    assert len(cut) == parts.sum()
    phi = np.linspace(0.001, 6.28, 301)
    rows = [d.rows(np.array([d.find(x) for x in phi]), phi) for d in (drive, cut)]
    assert np.abs(rows[0] - rows[1]).max() < 1e-12
    assert 0.123 in drive.knots
    assert 0.123 in cut.knots
    scaled = cut.scaled(3.0)
    assert isinstance(scaled, Drive)
    assert scaled.acceleration == pytest.approx(3.0 * cut.acceleration)


def test_series_reach_the_degree():
    assert NODES.shape == (DEGREE + 1,)
    (drive,) = drives([Harmonic(3)])
    assert drive.position.shape == (len(drive), DEGREE + 1)


# --- steady state -----------------------------------------------------------------------------------------------------


def train_of(r, zeta, rpm=600.0, preload=100.0, rate=0.0):
    natural = r * rpm * TURN / 60.0
    stiffness = 0.5 * natural**2
    return Train(0.5, 2.0 * zeta * 0.5 * natural, stiffness - rate, preload, rate)


def test_force_of_a_harmonic_drive_in_newtons():
    train, rpm, size = Train(0.4, 20.0, 2e5, 150.0), 600.0, 1e-3
    (drive,) = drives([Harmonic(2, size)])
    found = steady(train, drive, rpm)
    w = 2.0 * rpm * TURN / 60.0
    amplitude = abs((2e5 + 20j * w) * 0.4 * w * w / (2e5 + 20j * w - 0.4 * w * w)) * size
    assert found.force.greatest == pytest.approx(150.0 + amplitude, rel=1e-12)
    assert found.force.least == pytest.approx(150.0 - amplitude, rel=1e-12)
    assert found.holds
    assert train.ratio(rpm) == pytest.approx(math.sqrt(2e5 / 0.4) / (rpm * TURN / 60.0))


def test_a_rate_of_the_preload_spring_adds_its_force_and_its_stiffness():
    plain, sprung = Train(0.4, 20.0, 2e5, 150.0), Train(0.4, 20.0, 2e5, 150.0, 3e3)
    (drive,) = drives([Harmonic(1, 1e-2)])
    rpm = 1e-3  # so slowly that nothing moves
    assert steady(plain, drive, rpm).force.greatest == pytest.approx(150.0, rel=1e-9)
    force = steady(sprung, drive, rpm).force
    # the contact spring gives way too: k/(k + k_p) of the force of a rigid follower
    assert force.greatest == pytest.approx((150.0 + 3e3 * 1e-2) * 2e5 / 2.03e5, rel=1e-9)
    assert force.least == pytest.approx((150.0 - 3e3 * 1e-2) * 2e5 / 2.03e5, rel=1e-9)


@pytest.mark.thin(6)
@pytest.mark.parametrize("r", [5.3, 60.3, 2000.3, 1e5 + 0.3])
@pytest.mark.parametrize("zeta", [0.0, 0.02, 1.5])
def test_extremes_are_those_of_a_dense_sampling(r, zeta):
    motion = Cycloid(1.2, 1e-2)
    (drive,) = drives([motion])
    train = train_of(r, zeta)
    found = steady(train, drive, 600.0)
    response_ = found.response
    rng = np.random.default_rng(3)
    phi = rng.uniform(0.0, TURN, 40_000)
    stretch = np.clip(np.searchsorted(response_.drive.knots, phi, side="right") - 1, 0, len(response_) - 1)
    at = Samples(stretch, phi - response_.drive.knots[stretch])
    force = train.at(600.0).force(response_).at(found.starts, at)
    spread = force.max() - force.min()
    assert force.max() <= found.force.greatest + 1e-11 * spread
    assert force.min() >= found.force.least - 1e-11 * spread
    assert found.force.greatest - force.max() < 1e-3 * spread


@pytest.mark.parametrize("zeta", [0.0, 0.02, 0.4])
@pytest.mark.parametrize("r", [5.3, 60.3, 2e4])
def test_samples_are_in_order_and_as_close_as_what_rings_asks_for(r, zeta):
    (drive,) = drives([Cycloid(1.2, 1e-2)])
    found = response(oscillator(r, zeta), drive, Forcing())
    starts = found.starts(np.array([1e-3, 0.0]), 0, len(found))
    every = np.arange(len(found))
    lasting, _ = found.swings(starts, every)
    at = found.samples(starts, every)
    assert (np.diff(at.stretch) >= 0).all()
    assert (lasting > 0.0).any() or r < 1e4
    assert not lasting[~found.slow].any()  # there free motion is one with p, which its own samples show
    assert found.step * r <= 0.25  # 25 in a swing: a parabola through three is right to a part in a thousand
    for i in every.tolist():
        width, time = 2.0 * found.half[i], at.time[at.stretch == i]
        assert (time[0], time[-1]) == (0.0, pytest.approx(width, rel=1e-15))
        assert (np.diff(time) >= 0.0).all()
        assert np.diff(time).max() <= width / 32 * (1.0 + 1e-12)
        if lasting[i]:
            rings = np.append(time[time <= lasting[i]], lasting[i])
            assert np.diff(rings).max() <= found.step
            left = abs(found.rung(starts, Samples(np.array([i]), lasting[i : i + 1]))[0, 0])
            assert lasting[i] == width or left <= 2e-11 * (1e-3 + np.abs(found.p).sum(axis=1).max())


def test_residual_vibration_of_an_undamped_train_is_its_free_amplitude():
    motion, r = Cycloid(math.radians(100.0), 1e-2), 20.3
    (drive,) = drives([motion])
    train = train_of(r, 0.0)
    rests = [(motion.beta, math.pi), (math.pi + motion.beta, TURN)]
    found = steady(train, drive, 600.0, rests)
    oracle = Oracle(r, 0)
    z, v = oracle.periodic(motion.pieces())
    z, v = oracle.run(z, v, *motion.pieces()[0])
    amplitude = float((z**2 + (v / r) ** 2) ** 0.5)
    assert found.residual[0].amplitude == pytest.approx(amplitude, rel=1e-9)
    assert found.residual[1].amplitude == pytest.approx(amplitude, rel=1e-9)


@pytest.mark.parametrize("r", [1.0, 2.0, 117.0])
def test_resonance_without_damping_has_no_steady_state(r):
    train = train_of(r, 0.0)
    (drive,) = drives([Harmonic(3)])
    with pytest.raises(DynamicsError, match=f"the natural frequency is {r:.0f}"):
        steady(train, drive, 600.0)
    assert steady(train_of(r, 1e-6), drive, 600.0).force.greatest > 0.0


@pytest.mark.parametrize(
    ("figures", "message"),
    [
        ((0.0, 1.0, 1.0), "mass must be above 0, not 0.0"),
        ((1.0, -1.0, 1.0), "damping must be 0 or above, not -1.0"),
        ((1.0, 1.0, math.nan), "stiffness must be above 0, not nan"),
        ((1.0, 1.0, 1.0, -2.0), "preload must be 0 or above, not -2.0"),
        ((1.0, 1.0, 1.0, 0.0, -2.0), "rate must be 0 or above, not -2.0"),
        ((1.0, 21.0, 1.0), "the damping is 10.5 times critical"),
    ],
)
def test_what_is_no_train(figures, message):
    with pytest.raises(DynamicsError, match=message):
        Train(*figures)


@pytest.mark.parametrize("rpm", [0.0, -3.0, math.inf, math.nan])
def test_what_is_no_speed(rpm):
    with pytest.raises(DynamicsError, match="shaft speed"):
        Train(1.0, 1.0, 1.0).at(rpm)
