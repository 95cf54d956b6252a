"""Causes of deviations: planted ones are named with their values, noise names none."""

from __future__ import annotations

import numpy as np
import pytest
from support.disc_followers import FOLLOWERS

from kin.made.causes import causes, correlated_groups, shift_of
from kin.made.points import SurfacePoints
from kin.made.smooth import fit

T = np.arange(720) * np.pi / 360.0
FOLLOWER = FOLLOWERS["roller, offset"]
FRAME = FOLLOWER.envelope.frames(T)
MOMENT = FRAME.points[:, 0] * FRAME.normals[:, 1] - FRAME.points[:, 1] * FRAME.normals[:, 0]
TURN = np.radians(0.05)


def found(e, follower=FOLLOWER, noise=0.001):
    frame = follower.envelope.frames(T)
    places = frame.points + (e + noise * np.random.default_rng(3).normal(size=720))[:, None] * frame.normals
    deviations = SurfacePoints(follower, 1, places).deviations
    return {cause.names: cause for cause in causes([deviations], [fit(deviations.parameter, deviations.e)])}


PLANTED = {
    ("turned",): (TURN * MOMENT, TURN),
    ("shifted along x",): (0.02 * FRAME.normals[:, 0], 0.02),
    ("shifted along y",): (-0.02 * FRAME.normals[:, 1], -0.02),
    ("size",): (0.0 * T - 0.01, -0.01),
    ("waves",): (0.005 * np.cos(9 * T), 0.005),
}


@pytest.mark.parametrize("names", list(PLANTED))
def test_a_planted_cause_is_named_alone(names):
    e, value = PLANTED[names]
    told = found(e)
    assert set(told) == {names}
    assert told[names].value == pytest.approx(value, abs=max(told[names].uncertainty, 0.05 * abs(value)))
    assert told[names].waves == (9 if names == ("waves",) else None)


def test_several_are_told_from_one_another():
    told = found(TURN * MOMENT + 0.02 * FRAME.normals[:, 0] + 0.01 + 0.004 * np.cos(11 * T))
    assert set(told) == {("turned",), ("shifted along x",), ("size",), ("waves",)}
    for names, value in ((("turned",), TURN), (("shifted along x",), 0.02), (("size",), 0.01), (("waves",), 0.004)):
        assert abs(told[names].value - value) <= told[names].uncertainty + 2e-5


def test_a_shift_beside_turn_and_size_is_that_of_the_metal():
    e = TURN * MOMENT + FRAME.normals @ [0.02, -0.03] + 0.01
    deviations = SurfacePoints(FOLLOWER, 1, FRAME.points + e[:, None] * FRAME.normals).deviations
    shift, covariance = shift_of([deviations], [fit(deviations.parameter, deviations.e)])
    assert shift == pytest.approx([0.02, -0.03], abs=1e-5)
    assert covariance.shape == (2, 2)


def test_what_a_shift_leaves_to_second_order_is_no_local_fault():
    """Points without noise, moved as a whole: the linear fit leaves some nanometres."""
    deviations = SurfacePoints(FOLLOWER, 1, FRAME.points + np.array([0.02, -0.03])).deviations
    told = causes([deviations], [fit(deviations.parameter, deviations.e)])
    assert not any(cause.fault for cause in told)


def test_a_local_fault_comes_first():
    told = found(0.02 * np.exp(-0.5 * ((T - 1.0) / 0.08) ** 2))
    first = next(iter(told.values()))
    assert first.names == ("local",)
    assert first.fault.at == pytest.approx(1.0, abs=0.02)


def test_noise_has_no_cause():
    assert found(0.0 * T) == {}


@pytest.mark.parametrize(
    ("pairs", "groups"),
    [([], [[0], [1], [2]]), ([(0, 2)], [[1], [0, 2]]), ([(0, 2), (1, 2)], [[0, 1, 2]]), ([(0, 1)], [[0, 1], [2]])],
)
def test_a_chain_of_correlations_is_one_group(pairs, groups):
    correlation = np.eye(3)
    for i, j in pairs:
        correlation[i, j] = correlation[j, i] = -0.97
    assert correlated_groups(correlation) == groups
