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


YOKE = (
    "cam: {kind: constant-diameter, base_radius: 35, roller_radius: 10,"
    " motion: [{rise: 20, over: 180, law: cycloidal}],"
    " preload: {interference: 0.04, stiffness: [4e7, 2e7]}}\npart: {bore: 12}\nverify: {angles: 360}\n"
    "dynamics: {mass: 0.4, rpm: 300, width: 10, material: steel}\n"
)


PAIR = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {bore: 12}\nverify: {angles: 360}"


@pytest.mark.thin(2)
@pytest.mark.parametrize(("more", "share"), [(0.005, 1.25), (-0.008, 0.6), (-0.03, 0.0)])
def test_a_preload_is_what_the_metal_leaves(more, share, tmp_path):
    """Metal that is larger all round overlaps each roller by as much more: half the interference lies on either."""
    made = judged(tmp_path, YOKE, lambda t: np.full_like(t, more))
    found = figures(made)
    preload = found["least preload"]
    assert preload["made"] == pytest.approx(share * preload["intended"], rel=2e-4, abs=1e-9)
    assert not any("preload" in text for text in made["remarks"])
    first, second = (found[f"contact force, roller {letter}"] for letter in "AB")
    if share:  # neither is lost: inertia parts as the contacts yield, whatever the preload
        for force in (first, second):
            change = (share - 1.0) * preload["intended"]
            assert force["made"] - force["intended"] == pytest.approx(change, rel=0.05)  # over a lever below 1
    else:  # with clearance each bears inertia alone
        peak = 0.4 * (300.0 * math.pi / 30.0) ** 2 * 2.0 * math.pi * 0.020 / math.pi**2
        assert first["made"] == pytest.approx(peak, rel=0.03)
        assert second["made"] == pytest.approx(peak, rel=0.03)


def steady_by_steps(text, error, stiffness, damping):
    """Contact force of an elastic train under a flat face over a turn, by Runge and Kutta's rule from rest."""
    ((_, _, surface),) = surfaces(text)
    count, omega = 20_000, 2.0 * math.pi * RPM / 60.0
    phi = np.arange(2 * count) * (math.pi / count)
    rows = surface.gauge.motion.derivatives(phi, 1)[:2] + error(phi)[:2]
    place, speed = 1e-3 * (rows[0] - 40.0), 1e-3 * omega * rows[1]
    h = 2.0 * math.pi / count / omega

    def rate(x, v, i):
        force = stiffness * (place[i] - x) + damping * (speed[i] - v)
        return v, (force - PRELOAD - RATE * x) / MASS, force

    x, v = -PRELOAD / (stiffness + RATE), 0.0
    for _ in range(3):
        forces = []
        for k in range(count):
            i, j, e = 2 * k, 2 * k + 1, (2 * k + 2) % (2 * count)
            a, b, force = rate(x, v, i)
            c, d, _ = rate(x + 0.5 * h * a, v + 0.5 * h * b, j)
            f, g, _ = rate(x + 0.5 * h * c, v + 0.5 * h * d, j)
            p, q, _ = rate(x + h * f, v + h * g, e)
            x, v = x + h * (a + 2 * c + 2 * f + p) / 6.0, v + h * (b + 2 * d + 2 * g + q) / 6.0
            forces.append(force)
    return max(forces), min(forces)


@pytest.mark.slow
def test_an_elastic_train_follows_the_made_motion(tmp_path):
    stiffness, damping = 2e6, 180.0
    text = (
        f"{disc('kind: flat')}\ndynamics: {{mass: {MASS}, rpm: {RPM:.0f}, preload: {PRELOAD:.0f}, rate: {RATE:.0f},"
        f" stiffness: {stiffness}, damping: {damping}}}\n"
    )
    made = judged(tmp_path, text, lambda t: HIGH * np.cos(WAVES * t), noise=0.0005)
    found = figures(made)
    assert set(found) == {"contact force, elastic", "least contact force, elastic"}
    wave = np.array([[HIGH], [HIGH * WAVES], [HIGH * WAVES**2]])
    cases = {
        "made": lambda phi: wave * np.array([np.cos(WAVES * phi), -np.sin(WAVES * phi), -np.cos(WAVES * phi)]),
        "intended": lambda phi: np.zeros((3, len(phi))),
    }
    for key, error in cases.items():
        most, least = steady_by_steps(text, error, stiffness, damping)
        for name, value in (("contact force, elastic", most), ("least contact force, elastic", least)):
            near = 2.0 * found[name]["uncertainty"] if key == "made" else 0.0
            assert found[name][key] == pytest.approx(value, rel=2e-3, abs=near), (key, name)
    assert any("floats is not searched" in text for text in made["remarks"])


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("recipe", "told"),
    [
        (f"{disc('kind: roller, radius: 10')}\ndynamics: {{mass: 0.4, rpm: 600, preload: 60, stiffness: 1e7}}", ""),
        (
            f"{PAIR}\ndynamics: {{mass: 0.4, rpm: 600, backlash: 0.03, stiffness: 1e7, damping: 90}}",
            "impacts",
        ),
        (
            f"{PAIR}\ndynamics: {{mass: 0.4, rpm: 600, preload: 60, stiffness: 1e7}}",
            "two contacts under a",
        ),
    ],
)
def test_what_is_not_found_is_said(recipe, told, tmp_path):
    section = judged(tmp_path, f"{recipe}\n", nothing)
    if told:
        assert "figures" not in section
        assert any(told in remark for remark in section["remarks"])
    else:
        figure = figures(section)["contact force, elastic"]
        assert figure["made"] == pytest.approx(figure["intended"], rel=1e-6)


def test_without_dynamics_there_are_none(tmp_path):
    assert "figures" not in judged(tmp_path, disc("kind: roller, radius: 10"), nothing)
