# needs: dynamics
"""Forces, pressures and float speed in the motion of a made part, as the dynamics of its recipe have them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from support.measured import RECIPES, disc, measured, nothing, surfaces

import camgeo

RPM, MASS, PRELOAD, RATE = 900.0, 0.4, 60.0, 9000.0
TRAIN = f"mass: {MASS}, rpm: {RPM:.0f}, preload: {PRELOAD:.0f}, rate: {RATE:.0f}, width: 10, material: steel"
WAVES, HIGH = 6, 0.02  # of a form: under a flat face it is the error of the motion


def judged(folder, text, deviation, noise=0.0):
    recipe, files = measured(folder, text, deviation, noise)
    return camgeo.verify(recipe, *files, probe_error=0.001)["made"]


def figures(section):
    return {figure["name"]: figure for figure in section["figures"]}


def by_hand(text, error):
    """Force, pressure and float speed of a flat face on a stem over the shaft angle, its motion off by an error."""
    ((_, _, surface),) = surfaces(text)
    phi = np.radians(np.arange(360.0) + 0.5)
    distance, _, acceleration = surface.gauge.motion.derivatives(phi, 2)[:3] + error(phi)
    shift = distance - 40.0
    omega = 2.0 * math.pi * RPM / 60.0
    held = PRELOAD + RATE * shift / 1e3
    force = MASS * omega**2 * acceleration / 1e3 + held
    radius = 40.0 + shift + acceleration
    compliance = 2.0 * (1.0 - 0.3**2) / 206_000.0
    pressure = np.sqrt(np.maximum(force, 0.0) / (radius * math.pi * 10.0 * compliance))
    falling = acceleration < 0.0
    speed = np.sqrt(held[falling] / (MASS * -acceleration[falling] / 1e3)) * 30.0 / math.pi
    return {
        "contact force": force.max(),
        "pressure": pressure.max(),
        "least contact force": force.min(),
        "float speed": speed.min(),
    }


def test_figures_are_those_of_the_motion_on_the_metal(tmp_path):
    text = f"{disc('kind: flat')}\ndynamics: {{{TRAIN}}}\n"
    found = figures(judged(tmp_path, text, lambda t: HIGH * np.cos(WAVES * t)))
    wave = np.array([[HIGH], [HIGH * WAVES], [HIGH * WAVES**2]])

    def error(phi):
        return wave * np.array([np.cos(WAVES * phi), -np.sin(WAVES * phi), -np.cos(WAVES * phi)])

    made, intended = by_hand(text, error), by_hand(text, lambda phi: np.zeros((3, len(phi))))
    assert set(found) == set(made)
    for name, figure in found.items():
        assert figure["intended"] == pytest.approx(intended[name], rel=1e-9), name
        assert figure["made"] == pytest.approx(made[name], rel=1e-3), name
        assert abs(made[name] / intended[name] - 1.0) > 0.0015, name  # the wave is felt


def test_uncertainties_cover_the_noise(tmp_path):
    text = f"{disc('kind: roller, radius: 10')}\ndynamics: {{{TRAIN}}}\n"
    for figure in judged(tmp_path, text, nothing, noise=0.0005)["figures"]:
        assert abs(figure["made"] - figure["intended"]) <= 2.0 * figure["uncertainty"] + 1e-9 * figure["made"]
        assert 0.0 < figure["uncertainty"] < 0.01 * figure["made"]


def test_two_contacts_have_a_force_each(tmp_path):
    text = f"{RECIPES['groove']}\ndynamics: {{mass: 0.4, rpm: 600, width: 10, material: steel}}\n"
    section = judged(tmp_path, text, nothing)
    names = {f"{figure}, {flank}" for figure in ("contact force", "pressure") for flank in ("inner", "outer")}
    assert set(figures(section)) == names


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (
            "dynamics: {mass: 0.4, rpm: 600, preload: 60, stiffness: 1e7}",
            "of an elastic train no forces on the made part",
        ),
        (
            "dynamics: {mass: 0.4, rpm: 600, preload: 60, stiffness: 1e7, width: 10, material: steel}",
            "an elastic train is not followed on it",
        ),
    ],
)
def test_what_is_not_found_is_said(more, told, tmp_path):
    section = judged(tmp_path, f"{disc('kind: roller, radius: 10')}\n{more}\n", nothing)
    assert any(told in remark for remark in section["remarks"])


def test_without_dynamics_there_are_none(tmp_path):
    assert "figures" not in judged(tmp_path, disc("kind: roller, radius: 10"), nothing)
