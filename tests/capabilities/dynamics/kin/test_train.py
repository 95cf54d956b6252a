"""Trains and their steady states: forces, residual vibration, and where there is none."""

import math

import pytest
from support.drives import Harmonic
from support.dynamics_oracle import Cycloid, Oracle
from support.trains import stiff

from kin.dynamics.drive import drives
from kin.dynamics.train import DynamicsError, Train, steady

TURN = 2.0 * math.pi


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


def test_residual_vibration_of_an_undamped_train_is_its_free_amplitude():
    motion, r = Cycloid(math.radians(100.0), 1e-2), 20.3
    (drive,) = drives([motion])
    train = stiff(r, 0.0, rpm=600.0, preload=100.0, mass=0.5)
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
    train = stiff(r, 0.0, rpm=600.0, preload=100.0, mass=0.5)
    (drive,) = drives([Harmonic(3)])
    with pytest.raises(DynamicsError, match=f"the natural frequency is {r:.0f}"):
        steady(train, drive, 600.0)
    assert steady(stiff(r, 1e-6, rpm=600.0, preload=100.0, mass=0.5), drive, 600.0).force.greatest > 0.0


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
