"""Cams between two opposite contacts: one half turn gives the other."""

from pathlib import Path

import numpy as np
import pytest

from camgeo.motions.half_turn import HalfTurnCam
from camgeo.recipe.loading import load_text
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed

TEXT = """\
cam:
  kind: constant-breadth
  base_radius: 40
  motion: [{{rise: 20, over: {over}, law: cycloidal}}, {{dwell: 60}}]
export: {{tolerance: 0.01, files: [dxf]}}
"""


def test_the_other_half_turn_goes_back_as_the_first_goes_out():
    recipe = load_text(TEXT.format(over=120), Path("case.yaml"))
    theta = np.radians([0.0, 30.0, 60.0, 100.0, 150.0])
    rows = designed(recipe).motion.rows(theta, 1)
    back = designed(recipe).motion.rows(theta + np.pi, 1)
    assert rows[0, 2] == pytest.approx(10.0, abs=1e-12)
    assert back[0] == pytest.approx(20.0 - rows[0], abs=1e-12)
    assert back[1] == pytest.approx(-rows[1], abs=1e-12)
    cam = recipe.cam
    assert isinstance(cam, HalfTurnCam)
    assert cam.motion_span == pytest.approx(np.pi)
    assert cam.kept() is None
    assert len(cam.joints()) == 2  # the rise's two ends, each at rest


def test_a_half_turn_is_filled():
    with pytest.raises(RecipeErrors, match=r"let them cover one half turn, 180 degrees"):
        load_text(TEXT.format(over=100), Path("case.yaml"))
