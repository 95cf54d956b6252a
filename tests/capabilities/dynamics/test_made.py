# needs: made
"""Figures of a train on a made part: what a known error of the motion changes."""

import math
from pathlib import Path

import numpy as np
import pytest
from support.places import ROOT

from camgeo.capabilities.dynamics.made import ELASTIC_SPEED, LINKAGE, figures_on_metal
from camgeo.capabilities.made.extension import MadeMotion
from camgeo.recipe.loading import load, read
from camgeo.synthesis.design import designed

TEXT = """\
cam:
  kind: disc
  base_radius: 40
  follower: {kind: roller, radius: 10}
  motion: {formula: 6*(1 - cos(t))}
dynamics: {mass: 2, rpm: 300, preload: 100 BESIDE}
export: {tolerance: 0.01, files: [dxf]}
"""
SHAFT = np.linspace(0.0, 2.0 * math.pi, 720, endpoint=False)


def made(wave, beside=""):
    """Figures by name of a train whose follower moves by `wave` mm times cos t too much."""
    recipe = read(TEXT.replace(" BESIDE", beside).encode(), Path("metal.yaml"))
    errors = wave * np.stack([np.cos(SHAFT), -np.sin(SHAFT), -np.cos(SHAFT)])
    motion = MadeMotion(SHAFT, errors, np.zeros((3, len(SHAFT))), lambda weights: 0.01 * float(np.abs(weights).max()))
    given = figures_on_metal(recipe, designed(recipe), motion)
    return {figure.name: figure for figure in given.figures}, tuple(given.remarks)


@pytest.mark.parametrize("wave", [0.0, 0.5])
def test_the_float_speed_of_a_rigid_follower(wave):
    """S = 6 - (6 - wave) cos t: m W^2 (6 - wave) reaches the preload at the top."""
    figures, _ = made(wave)
    speed = figures["float speed"]
    for value, size in ((speed.intended, 6.0), (speed.made, 6.0 - wave)):
        assert value == pytest.approx(math.sqrt(100.0 / (2.0 * 1e-3 * size)) * 30.0 / math.pi, rel=1e-9)
    assert speed.uncertainty == 0.0
    assert speed.at_deg == pytest.approx(180.0)


def test_the_force_of_an_elastic_train_is_that_of_its_wave():
    figures, remarks = made(0.5, ", stiffness: 1.0e5, damping: 100")
    assert remarks == (ELASTIC_SPEED,)
    w = 300.0 * math.pi / 30.0
    link = 1e5 + 100j * w
    size = abs(link * -2.0 * w * w / (link - 2.0 * w * w)) * 1e-3  # N by mm of a wave, a turn
    force = figures["contact force, elastic"]
    assert force.intended == pytest.approx(100.0 + 6.0 * size, rel=1e-4)
    assert force.made == pytest.approx(100.0 + 5.5 * size, rel=1e-4)
    assert force.uncertainty > 0.0


def test_under_a_linkage_nothing_is_said_but_why():
    recipe = load(ROOT / "recipes" / "frame-forces.yaml")
    assert figures_on_metal(recipe, designed(recipe), None).remarks == (LINKAGE,)
