"""Local faults: all of them are found where they stand, and bend no other cause and no phase.

Holds: kin.made.local_faults, kin.made.causes.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.cases import few
from support.disc_followers import FOLLOWERS

from kin.made.causes import causes, local_form
from kin.made.local_faults import LocalFault, local_faults
from kin.made.motion import contact_errors
from kin.made.points import SurfacePoints
from kin.made.smooth import fit
from kin.numeric.feet import equal_steps

T = equal_steps(720)
DEG = np.degrees(T)


def bump(height, at, width=2.5):
    """A fault of the shape of a normal distribution, mm, at degrees of the contour."""
    away = (DEG - at + 180.0) % 360.0 - 180.0
    return height * np.exp(-0.5 * (away / width) ** 2)


def of_part(e, turned=0.0, noise=0.001, seed=3, name="roller, offset"):
    """Deviations of points of a contour that is off by e (720,), mm, and turned, rad, and their smooth curve."""
    follower = FOLLOWERS[name]
    frame = follower.envelope.frames(T)
    off = e + noise * np.random.default_rng(seed).normal(size=len(T))
    places = (frame.points + off[:, None] * frame.normals) @ [[1.0], [1j]] * np.exp(1j * turned)
    deviations = SurfacePoints(follower, 1, np.hstack([places.real, places.imag])).deviations
    return follower, deviations, fit(deviations.parameter, deviations.e)


def named(*planted, **part):
    _, deviations, fitted = of_part(sum((bump(*one) for one in planted), np.zeros(720)), **part)
    return causes([deviations], [fitted])


@pytest.mark.parametrize(
    "planted",
    [
        ((60.0, 0.010), (150.0, -0.015), (250.0, 0.012)),
        ((60.0, 0.010), (200.0, -0.010)),
        ((60.0, 0.010), (72.0, 0.012), (200.0, -0.008)),  # two beside one another, and a valley between
        ((0.2, 0.010), (180.0, 0.010)),  # across the turn's zero
    ],
)
def test_every_fault_is_named_and_no_cause_besides(planted):
    found = named(*((height, at) for at, height in planted))
    assert {cause.names for cause in found} == {("local",)}
    assert len(found) == len(planted)
    for at, height in planted:
        (cause,) = [cause for cause in found if abs((math.degrees(cause.fault.at) - at + 180) % 360 - 180) < 2.0]
        assert cause.value == pytest.approx(height, abs=1.5 * cause.uncertainty)
        assert cause.fault.holds(np.radians([at, at + 20.0, at - 20.0])).tolist() == [True, False, False]


def test_faults_beside_other_causes_leave_these_as_they_are():
    turn = math.radians(0.1)
    found = named((0.020, 100.0), (-0.008, 300.0), turned=turn)
    (turned,) = [cause for cause in found if cause.names == ("turned",)]
    assert abs(turned.value - turn) < min(turned.uncertainty, 0.03 * turn)
    assert len(found) == 3


def test_a_flat_is_one_fault_and_half_a_turn_none():
    flat = np.where((DEG > 60.0) & (DEG < 85.0), -0.02, 0.0)  # its curve swings at either end
    _, deviations, fitted = of_part(flat)
    (cause,) = causes([deviations], [fitted])
    assert cause.names == ("local",)
    assert math.degrees(cause.fault.begin) == pytest.approx(60.0, abs=4.0)
    assert math.degrees(cause.fault.end) == pytest.approx(85.0, abs=4.0)
    # a fault of most of the turn is a form
    assert local_faults(np.where(DEG < 150.0, 0.01, 0.0), np.full(720, 1e-4), 72) == []
    assert len(local_faults(np.where(DEG < 100.0, 0.01, 0.0), np.full(720, 1e-4), 72)) == 1


def test_a_form_all_round_is_no_local_fault():
    form = 0.005 * np.cos(5 * T) + 0.004 * np.sin(4 * T) + 0.003 * np.cos(7 * T)
    found = causes(*([part] for part in of_part(form)[1:]))
    assert [(cause.names, cause.waves) for cause in found] == [(("waves",), 5), (("waves",), 4), (("waves",), 7)]
    assert [cause.value for cause in found] == pytest.approx([0.005, 0.004, 0.003], abs=2e-4)


@pytest.mark.parametrize("seed", few(range(20), 10))
def test_noise_alone_has_no_cause(seed):
    assert named(seed=seed) == []


@pytest.mark.slow
def test_the_turn_by_the_profile_and_the_phase_by_the_motion_agree():
    """Both with and without local faults, on parts of known turn; the uncertainty is that of 19 parts in 20."""
    shaft, turn = equal_steps(180) + math.pi / 180, math.radians(0.03)
    for planted in ([], [(0.010, 60.0), (-0.015, 150.0), (0.012, 250.0)]):
        held = 0
        for seed in range(4):
            e = sum((bump(*one) for one in planted), np.zeros(720))
            follower, deviations, fitted = of_part(e, turn, seed=seed)
            found = causes([deviations], [fitted])
            (turned,) = [cause for cause in found if cause.names == ("turned",)]
            faults = [cause.fault for cause in found if cause.fault is not None]
            assert len(faults) == len(planted)
            (errors,) = contact_errors(follower, 1, fitted.curve, shaft, faults=faults)
            phase, unsure = errors.phase[0], 2.0 * errors.influence(errors.phase_weights).sd
            assert abs(turned.value - phase) < math.hypot(turned.uncertainty, unsure)
            assert abs(turned.value - turn) < turned.uncertainty
            held += abs(phase - turn) < unsure
        assert held >= 3
    # with the faults counted it would be off by many times its uncertainty
    (bent,) = contact_errors(follower, 1, fitted.curve, shaft)
    assert abs(bent.phase[0] - turn) > 2.0 * unsure


def test_without_its_faults_a_curve_is_that_of_the_sound_metal():
    sound = 0.01 * np.cos(3 * T + 1.0) + 0.004
    _, deviations, fitted = of_part(sound + bump(0.015, 60.0) + bump(-0.012, 200.0))
    form = local_form(deviations, fitted)
    curve, faults = form.without(form.faults), form.faults
    assert sorted(round(math.degrees(fault.at), -1) for fault in faults) == [60.0, 200.0]
    assert np.abs(curve.rows(T)[0] - sound).max() < 0.0025
    assert np.abs(fitted.curve.rows(T)[0] - sound).max() > 0.012
    _, deviations, fitted = of_part(sound)
    assert local_form(deviations, fitted).without([]) is fitted.curve


def test_two_faults_may_be_one():
    def fault(at, width, height):
        return LocalFault(at, at - width, at + width, height, 1e-4)

    one = fault(0.1, 0.2, 0.01)
    assert one.alike(fault(0.15, 0.25, 0.015))
    assert one.alike(fault(0.1 + 2.0 * math.pi, 0.2, 0.01))  # a turn on
    assert not one.alike(fault(0.15, 0.25, -0.015))
    assert not one.alike(fault(0.15, 0.25, 0.021))
    assert not one.alike(fault(0.4, 0.2, 0.01))
    assert not one.alike(fault(0.1, 0.5, 0.01))
