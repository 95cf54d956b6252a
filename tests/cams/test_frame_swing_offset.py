"""The swing of a frame whose joint stands off its mid-line: the output is the law, in either assembly."""

from __future__ import annotations

import math

import numpy as np
import pytest

from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed

CAM = """\
cam: {kind: constant-breadth, base_radius: 60, swing: [{rise: 20, over: 140, law: cycloidal}, {dwell: 60}]}
linkage: {kind: inverted-slider-crank, ground: 150, rocker: 20, joint_offset: OFFSET, assembly: ASSEMBLY}
"""


@pytest.mark.parametrize(("assembly", "offset"), [("open", "7"), ("crossed", "-5")])
def test_the_output_is_the_law(assembly: str, offset: str) -> None:
    """20 (u - sin(2 pi u)/2 pi) at u = 1/4 and 1/2, then the dwell."""
    driven = designed(load_text(CAM.replace("OFFSET", offset).replace("ASSEMBLY", assembly), "a.yaml")).driven
    assert driven is not None
    mechanism = driven.mechanism
    at = mechanism.at(mechanism.relative(np.radians([0.0, 35.0, 70.0, 140.0, 200.0])), 0).output[0]
    expected = [20.0 * (0.25 - 1.0 / (2.0 * math.pi)), 10.0, 20.0, 20.0]
    assert np.degrees(at[1:] - at[0]) == pytest.approx(expected, abs=1e-9)
