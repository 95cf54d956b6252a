"""The speed at which float begins."""

import math

import numpy as np
import pytest
from support.cases import few
from support.drives import Harmonic, Still
from support.dynamics_oracle import Cycloid
from support.trains import stiff

from kin.dynamics.drive import drives
from kin.dynamics.separation import float_speed
from kin.dynamics.train import DynamicsError, Train, steady

TURN = 2.0 * math.pi


@pytest.mark.thin(6)
@pytest.mark.parametrize("zeta", few([0.01, 0.3, 0.9, 1.0, 2.0], 2))
@pytest.mark.parametrize("order", [1, 3])
def test_float_of_a_harmonic_drive_begins_where_its_amplitude_reaches_the_preload(order, zeta):
    mass, stiffness, preload, size = 0.4, 2e5, 150.0, 2e-3
    damping = 2.0 * zeta * math.sqrt(stiffness * mass)
    train = Train(mass, damping, stiffness, preload)
    (drive,) = drives([Harmonic(order, size)])
    found = float_speed(train, drive)

    def force(rpm):
        w = order * rpm * TURN / 60.0
        return abs((stiffness + 1j * damping * w) * mass * w * w / (stiffness + 1j * damping * w - mass * w * w)) * size

    assert found.rpm is not None
    assert force(found.rpm) == pytest.approx(preload, rel=1e-8)
    assert all(force(share * found.rpm) < preload for share in np.linspace(0.01, 0.9999, 200))
    rigid = math.sqrt(preload / (mass * size)) / order * 60.0 / TURN
    assert found.rigid_rpm == pytest.approx(rigid, rel=1e-14)


@pytest.mark.slow
def test_float_of_a_rise_is_found_in_its_first_dip():
    """Rigid at 1092 rpm; the least force over the speed has dips, and the first to reach 0 counts."""
    train = Train(0.4, 20.0, 2e5, 150.0)
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    found = float_speed(train, drive)
    assert found.rpm is not None
    assert found.rigid_rpm == pytest.approx(1092.55, abs=0.1)
    assert steady(train, drive, found.rpm).force.least == pytest.approx(0.0, abs=1e-6)
    assert steady(train, drive, 1.0001 * found.rpm).force.least < 0.0
    below = [steady(train, drive, rpm).force.least for rpm in np.linspace(600.0, 0.9999 * found.rpm, 200)]
    assert min(below) > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ratio", "zeta"),
    [
        (3.3, 1e-3),
        (30.3, 1e-4),
        (300.3, 1e-4),
        (1e4, 1e-4),
        (1e4, 1e-3),
        (1e3, 1e-5),
        (1e5, 1e-6),
        (55.0, 0.95),
        (2e3, 2.0),
    ],
)
def test_no_dip_below_the_speed_at_which_float_begins_is_passed_over(ratio, zeta):
    """At resonances, beside them, between them, and at random speeds contact holds right up to that speed."""
    train = stiff(ratio, zeta, preload=150.0)
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    begins = float_speed(train, drive).rpm
    assert begins is not None
    assert abs(steady(train, drive, begins).force.least) < 1e-7 * train.preload
    assert steady(train, drive, begins * (1.0 + 1e-9)).force.least < 0.0
    share = math.sqrt(max(1.0 - zeta**2, 0.0)) or 1.0
    whole = math.ceil(share * train.ratio(begins)) + np.arange(6)
    near = np.concatenate([whole + 0.3 * zeta * whole * side for side in (-1.0, 0.0, 1.0)] + [whole + 0.5])
    at = train.natural * share / near * 60.0 / TURN
    rng = np.random.default_rng(3)
    at = np.concatenate([at, begins * (1.0 - 10.0 ** rng.uniform(-9.0, -0.5, 15))])
    at = at[at < begins * (1.0 - 1e-10)]
    assert min(steady(train, drive, rpm).force.least for rpm in at) > 0.0


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize(("ratio", "zeta"), [(1e3 + 0.3, 1e-5), (1e5 + 0.3, 1e-6)])
def test_a_search_that_takes_too_much_says_between_which_speeds_float_begins(ratio, zeta):
    train = stiff(ratio, zeta, preload=150.0)
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    found = float_speed(train, drive, most=200_000)
    assert (found.rpm, found.at) == (None, None)
    low, high = found.between
    assert 0.0 < low < high
    assert steady(train, drive, low).force.least > 0.0
    assert steady(train, drive, high).force.least < 0.0


def test_the_speed_that_floats_is_looked_for_at_resonances_below_it():
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    train = stiff(1e5, 1e-8, preload=150.0)
    low, high = float_speed(train, drive, most=200_000).between
    assert steady(train, drive, high).force.least < 0.0
    assert high / low < 1.1


@pytest.mark.thin(2)
@pytest.mark.parametrize(("ratio", "zeta"), [(1.3, 1.0), (123.3, 0.03), (1e3 + 0.3, 0.01), (1e5 + 0.3, 0.01)])
def test_ordinary_and_stiff_trains_are_settled_within_the_budget(ratio, zeta):
    train = stiff(ratio, zeta, preload=150.0)
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    found = float_speed(train, drive)
    assert found.between is None
    if found.rpm is not None:
        assert abs(steady(train, drive, found.rpm).force.least) < 1e-6 * train.preload
        assert steady(train, drive, 1.0001 * found.rpm).force.least < 0.0


@pytest.mark.parametrize(("ratio", "zeta", "most"), [(60.0, 0.05, 38_000), (25.0, 0.1, 25_000), (55.0, 0.95, 45_000)])
def test_a_damped_train_takes_few_places(ratio, zeta, most):
    """A bound with each kick's own age, and of the integral of what is left over, proves wide ranges at once.

    Twice the speed is tried until that is not sure once.
    """
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    train = stiff(ratio, zeta, preload=150.0)
    found = float_speed(train, drive)
    assert found.places < most
    beside = [steady(train, drive, found.rpm * (1.0 + share)).force.least for share in (-2e-11, 2e-11)]
    assert beside[0] > 0.0 > beside[1]


@pytest.mark.parametrize(
    ("damping", "preload", "message"), [(0.0, 1.0, "without damping contact is lost"), (1.0, 0.0, "without preload")]
)
def test_where_float_has_no_least_speed(damping, preload, message):
    (drive,) = drives([Harmonic(1, 1e-3)])
    with pytest.raises(DynamicsError, match=message):
        float_speed(Train(1.0, damping, 1e5, preload), drive)


def test_a_drive_that_never_falls_away_never_floats():
    found = float_speed(Train(1.0, 10.0, 1e5, 10.0), drives([Still(0.1)])[0])
    assert (found.rpm, found.at, found.rigid_rpm) == (None, None, None)
