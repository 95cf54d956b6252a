"""The task of a recipe: units of figures and of axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from support.sweepers import PROCEDURES, task

from camgeo.capabilities.sweep.engines import Workers
from camgeo.capabilities.sweep.search import search
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.recipe.loading import read

if TYPE_CHECKING:
    from pathlib import Path


def test_axes_are_labelled_with_their_units() -> None:
    asked = task()
    assert [asked.axis_unit(axis.path) for axis in asked.plan.axes] == ["mm", "mm"]
    text = b"""\
cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: cycloidal}, {dwell: 60}]}
sweep: {vary: {'cam.motion[0].rise': [10, 20], 'cam.motion[0].over': [119, 120], cam.base_radius: [1, 2]}, rank: size}
"""
    asked = SweepTask.from_recipe(read(text, "a.yaml"))
    assert [asked.axis_unit(axis.path) for axis in asked.plan.axes] == ["mm", "deg", "mm"]


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.slow
def test_lengths_are_told_in_the_recipes_unit(tmp_path: Path) -> None:
    text = "units: inch\n" + task(margin=0.04).recipe.text
    inches = SweepTask.from_recipe(read(text.encode(), "x.yaml"))
    assert inches.ranking.limits[0].at_least == pytest.approx(0.04 * 25.4)
    report = search(inches, tmp_path, Workers(1), PROCEDURES).report
    first, limit = report["best"][0], report["sweep"]["limits"]["margin"]["at_least"]
    assert limit == pytest.approx(0.04)
    assert first["figures"]["margin"] == pytest.approx((first["values"]["cam.shaft[0]"] - 12.0) / 25.4)
    assert report["figures"]["margin"]["unit"] == "in"
    assert b"margin_in" in (tmp_path / "four-bar" / "sweep.csv").read_bytes()
