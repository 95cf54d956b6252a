"""Looks at one speed, and what is proved of the range between two."""

import math

import numpy as np
import pytest
from support.dynamics_oracle import Cycloid
from support.trains import stiff

from kin.dynamics.drive import drives
from kin.dynamics.events import Work
from kin.dynamics.separation_bounds import Look, Range
from kin.dynamics.train import steady

TURN = 2.0 * math.pi


def test_the_least_force_of_a_look_is_that_of_the_steady_state():
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    rng = np.random.default_rng(4)
    for _ in range(20):
        train = stiff(10.0 ** rng.uniform(0.3, 2.0), 10.0 ** rng.uniform(-3.0, -0.1), preload=300.0)
        rpm = rng.uniform(300.0, 900.0)
        force, look = steady(train, drive, rpm).force, Look(train, drive, rpm, Work(10**6))
        assert look.reached == pytest.approx(force.least, abs=1e-12 * force.greatest)
        assert look.lowest.min() <= force.least + 1e-12 * force.greatest
        assert look.lowest.min() >= force.least - 0.1 * force.greatest


def test_ages_of_kicks_are_sums_over_all_turns():
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    look = Look(stiff(12.3, 0.05, preload=300.0), drive, 500.0, Work(10**6))
    knots, fading = look.response.drive.knots, look.fading
    for i in (0, 3, len(look.response) - 1):
        sums = np.zeros(3)
        for turn in range(60):
            since, ends = knots[i] - knots[:-1] + turn * TURN, knots[i] - knots[1:] + turn * TURN
            for size, decay in ((look.leaps, since), (look.inner, ends)):
                past = decay > -1e-12
                sums += [(size * np.exp(-fading * decay) * since**k)[past].sum() for k in range(3)]
        assert look.ages[:, i] == pytest.approx(sums, rel=1e-9)


@pytest.mark.slow
def test_what_is_said_of_a_range_holds_inside_it():
    """Force at speeds between two looks, at all resonances and damping: never below the bound from both ends."""
    (drive,) = drives([Cycloid(math.radians(120.0), 20e-3)])
    rng = np.random.default_rng(5)
    tight = 0.0
    for _ in range(40):
        train = stiff(10.0 ** rng.uniform(0.2, 4.0), 10.0 ** rng.uniform(-4.0, 0.6), preload=300.0)
        rpm = rng.uniform(200.0, 1200.0)
        b = train.ratio(rpm)
        other = b / (b - min(10.0 ** rng.uniform(-3.0, 1.0), 0.3 * b)) * rpm
        part = Range(*(Look(train, drive, speed, Work(10**9)) for speed in (rpm, other)))
        inside = np.concatenate([rng.uniform(rpm, other, 12), np.linspace(rpm, other, 4)])
        found = [steady(train, drive, speed).force for speed in inside]
        least = min(force.least for force in found)
        size = max(force.greatest for force in found)
        at_ends = min(part.low.reached, part.high.reached)
        assert at_ends >= min(part.low.least, part.high.least) - 1e-9 * size
        bound = max(part.by_size, at_ends - part.between, part.high.surely)
        if part.low.least > 0.0 and part.high.least > 0.0:
            assert least >= bound - 1e-9 * size
            tight = max(tight, bound / least) if least > 0.0 else tight
    assert tight > 0.9  # the bound says something
