"""Designs as recipes of their own: numbers and words put in at their paths."""

from __future__ import annotations

import math

import numpy as np
import pytest

from camgeo.capabilities.sweep.cams import FINE, IMPOSSIBLE, UNDERCUT
from camgeo.capabilities.sweep.single_designs import evaluate, recipe_with, text_with
from camgeo.recipe.loading import load_text

TEXT = """
cam: {kind: disc, base_radius: 40, follower: {kind: roller, radius: 9},
  motion: [{rise: 20, over: 60, law: cycloidal}, {dwell: 120}, {to: 0, over: 180, law: cycloidal}]}
sweep: {vary: {'cam.motion[0].law': [cycloidal, harmonic], cam.base_radius: [5, 50]}, rank: size}
"""


def test_words_go_in_by_their_index_and_numbers_as_they_are() -> None:
    recipe = load_text(TEXT, "a.yaml")
    text = text_with(recipe, {"cam.motion[0].law": 1.0, "cam.base_radius": 50.0})
    assert text.startswith("\ncam: {kind: disc, base_radius: 50, follower")
    assert "{rise: 20, over: 60, law: harmonic}, {dwell: 120}, {to: 0, over: 180, law: cycloidal}" in text
    cam = recipe_with(recipe, ["cam.base_radius"], [50.0]).cam
    assert next(circle.radius for circle in cam.circles()) == 50.0


def test_a_design_has_its_figures_or_a_reason() -> None:
    recipe = load_text(TEXT, "a.yaml")
    values = np.array([[50.0], [1.0], [-1.0]])
    figures, faults = evaluate(recipe, ["cam.base_radius"], values, ("size", "pressure-angle"))
    assert faults.tolist() == [FINE, UNDERCUT, IMPOSSIBLE]
    assert figures["size"][0] == pytest.approx(70.0)  # base circle and rise
    # the slope of the cycloidal rise over the distance of the roller's centre
    share, width = np.linspace(0.0, 1.0, 100_001), math.pi / 3.0
    lift = 20.0 * (share - np.sin(math.tau * share) / math.tau)
    rate = 20.0 / width * (1.0 - np.cos(math.tau * share))
    assert figures["pressure-angle"][0] == pytest.approx(np.degrees(np.arctan(rate / (59.0 + lift))).max(), abs=1e-6)
    assert np.isnan(figures["size"][1:]).all()
