"""Checks of the intent: greatest slope, pressure angle and closing, also where a short stretch alone decides."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.programmes import Segment, law, programme

from camgeo.cams.double_roller import DoubleRollerCam
from camgeo.cams.pairs import DeltaRoute, ExactPair
from camgeo.checks.declared import CLOSING, PRESSURE, RATIO
from camgeo.synthesis.checks import greatest, motion_checks
from kin.law.transmission import from_delta, from_law

CAM = DoubleRollerCam(2, 1, 60.0, 1.0, DeltaRoute((), ()), "refuse")  # whose own law is not asked for


def test_a_rise_between_two_looks_is_not_overlooked():
    """1e-5 degrees in 0.01: a cycloidal rise is twice as steep as the mean in its middle."""
    degree = math.pi / 180.0
    steps = [
        Segment(way, 0.01 * degree, 1e-5 * degree, law("cycloidal"))
        if way != "dwell"
        else Segment("dwell", (90.0 / 7.0 - 0.01) * degree)
        for way in ("rise", "dwell", "return", "dwell")
    ]
    motion = from_law(7, 5, 60.0, programme(steps, math.pi / 7.0))
    closing, steep, pressed = motion_checks(ExactPair(CAM, motion))
    assert [closing.name, steep.name, pressed.name] == [CLOSING.name, RATIO.name, PRESSURE.name]
    assert steep.value == pytest.approx(2e-3, rel=2e-3)
    assert 0.0 < closing.value < 1e-13
    flat = from_law(7, 5, 60.0, programme([Segment("dwell", math.pi / 7.0)], math.pi / 7.0))
    worst = []
    for one in (motion, flat):
        worst += [check.value for check in motion_checks(ExactPair(CAM, one)) if check.name == PRESSURE.name]
    assert worst[0] > worst[1] + 0.1


@pytest.mark.thin(2)
@pytest.mark.parametrize(("lam", "mu", "arm", "wave"), [(4, 3, 60.0, 625.0), (2, 1, 40.0, 1584.0)])
def test_pressure_angle_at_its_very_maximum(lam, mu, arm, wave):
    """Against a fine grid of r and r' written out: the normal's slope to the ray, less the arm's."""
    motion = from_delta(lam, mu, arm, {1: wave}, {})
    *_, found = (check.value for check in motion_checks(ExactPair(CAM, motion)))
    t = np.linspace(0.0, 2.0 * np.pi / lam, 400_001)
    d, slope = wave * np.cos(lam * t), -lam * wave * np.sin(lam * t)
    psi, psi1 = -np.arcsin(d / arm**2), -slope / np.sqrt(arm**4 - d**2)
    half = 0.5 * (psi + math.pi * mu / lam)
    r, r1 = 2.0 * arm * np.cos(half), -arm * np.sin(half) * psi1
    # the pivot stands `half` ahead of the ray, the arm leaves the ray by the same angle on the other side
    normal = np.arctan2(-r1, r)
    seen = np.degrees(np.abs(np.arcsin(np.abs(np.cos(normal + half))))).max()
    assert found == pytest.approx(seen, abs=1e-8)


@pytest.mark.parametrize("level", [20.0, 0.0, -20.0])
def test_the_greatest_value_is_found_above_and_below_zero(level: float) -> None:
    t = np.linspace(0.0, 2.0 * math.pi, 720, endpoint=False)
    ((value, at),) = greatest(lambda u: (level - 5.0 * np.cos(u - 2.0))[None], t)
    assert value == pytest.approx(level + 5.0, abs=1e-9)
    assert at == pytest.approx(2.0 + math.pi, abs=1e-4)
