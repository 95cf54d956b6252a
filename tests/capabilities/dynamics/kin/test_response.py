"""Responses to drives against closed forms at 60 digits, and the samples that show them."""

import math

import numpy as np
import pytest
from support.drives import Harmonic, Saw
from support.dynamics_oracle import Cycloid, Oracle, harmonic
from support.trains import moved, oscillator, states

from kin.dynamics.drive import drives
from kin.dynamics.peaks import ResponseFigure
from kin.dynamics.response import Forcing, ResponsePlaces, StiffnessError, response

TURN = 2.0 * math.pi
RATIOS = (1.25, 3.3, 10.3, 97.3, 1000.5, 1e4 + 0.3, 1e5 + 0.3)
DAMPINGS = (0.0, 1e-3, 0.1, 0.7, 1.0 - 1e-12, 1.0, 1.0 + 1e-9, 2.0)


def answer(oscillator, drive, phi):
    """Steady z and z' at angles phi."""
    found = response(oscillator, drive, Forcing())
    starts = found.starts(found.periodic(), 0, len(found))
    stretch = np.clip(np.searchsorted(found.drive.knots, phi, side="right") - 1, 0, len(found) - 1)
    return states(found, starts, ResponsePlaces(stretch, phi - found.drive.knots[stretch]))


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
            got = states(found, starts, ResponsePlaces(np.array([i]), np.array([phi - found.drive.knots[i]])))
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
            begins = starts[:, i] - np.array([found.ends[0][i, 0], found.ends[0][i, 1]])
            left = abs(moved(found.oscillator, begins, lasting[i])[0])
            assert lasting[i] == width or left <= 2e-11 * (1e-3 + np.abs(found.p).sum(axis=1).max())


def test_what_does_not_move_is_at_rest_at_once():
    (drive,) = drives([Harmonic(3, 0.0)])
    for zeta in (0.0, 0.1):
        found = response(oscillator(1e4 + 0.3, zeta), drive, Forcing())
        every = np.arange(len(found))
        assert (found.lasting(np.zeros(len(found)), every) == 0.0).all()
