"""Sweeps of recipes that leave an angle open: each design finds its own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import camgeo

if TYPE_CHECKING:
    from pathlib import Path

TEXT = """
cam:
  kind: disc
  base_radius: 40
  follower: {kind: flat}
  motion: [{rise: 12, over: 150, law: cycloidal}, {return: 12, over: least, law: modified-sine}, {dwell: rest}]
limits: {radius-of-curvature: {at_least: 10}}
sweep: {vary: {cam.base_radius: {from: 40, to: 50, steps: 2}}, rank: peak-acceleration}
"""


@pytest.mark.slow
def test_each_design_of_a_sweep_finds_its_own_angle(tmp_path: Path) -> None:
    recipe = camgeo.load(TEXT)
    best = camgeo.search(recipe, tmp_path).best
    angles = [camgeo.load(recipe.replace("cam.base_radius", base).text).settled.least.degrees for base in (40, 50)]
    assert angles[0] > angles[1]
    assert [design.recipe.settled.least.degrees for design in best] == angles
