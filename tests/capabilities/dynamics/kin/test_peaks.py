"""Extremes of a force over a turn."""

import math

import numpy as np
import pytest
from support.dynamics_oracle import Cycloid
from support.trains import stiff

from kin.dynamics.drive import drives
from kin.dynamics.response import ResponsePlaces
from kin.dynamics.train import steady

TURN = 2.0 * math.pi


@pytest.mark.thin(6)
@pytest.mark.parametrize("r", [5.3, 60.3, 2000.3, 1e5 + 0.3])
@pytest.mark.parametrize("zeta", [0.0, 0.02, 1.5])
def test_extremes_are_those_of_a_dense_sampling(r, zeta):
    motion = Cycloid(1.2, 1e-2)
    (drive,) = drives([motion])
    train = stiff(r, zeta, rpm=600.0, preload=100.0, mass=0.5)
    found = steady(train, drive, 600.0)
    response_ = found.response
    rng = np.random.default_rng(3)
    phi = rng.uniform(0.0, TURN, 40_000)
    stretch = np.clip(np.searchsorted(response_.drive.knots, phi, side="right") - 1, 0, len(response_) - 1)
    at = ResponsePlaces(stretch, phi - response_.drive.knots[stretch])
    force = train.at(600.0).force(response_).at(found.starts, at)
    spread = force.max() - force.min()
    assert force.max() <= found.force.greatest + 1e-11 * spread
    assert force.min() >= found.force.least - 1e-11 * spread
    assert found.force.greatest - force.max() < 1e-3 * spread
