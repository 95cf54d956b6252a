"""What would help a groove: remedies of undercut on either flank, tried; a size that both flanks obey.

Holds: camgeo.cams.sizing.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from camgeo.output.pipeline import export
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed

GROOVE = """
cam:
  kind: disc
  SIZE
  follower: {kind: roller, radius: RADIUSARM}
  track: {groove: {clearance: 0.05}}
  motion: [{rise: RISE, over: 50, law: LAW}, {dwell: 80}, {return: RISE, over: 50, law: LAW}, {dwell: 180}]
"""


def recipe_of(size, radius, arm="", rise=20, law="cycloidal"):
    text = GROOVE
    for key, value in {"SIZE": size, "RADIUS": radius, "ARM": arm, "RISE": rise, "LAW": law}.items():
        text = text.replace(key, str(value))
    return read(text.encode(), Path("g.yaml"))


def undercut(recipe):
    """Surfaces that are undercut, and what the checks say."""
    failed = [check for check in designed(recipe).checks if "undercut" in check.name and not check.ok]
    return {check.surface: check.detail for check in failed}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("base", "radius", "flank"),
    [(16, 26, "outer"), pytest.param(20, 22, "inner", marks=pytest.mark.slow)],
)
def test_the_roller_that_is_told_frees_either_flank(base, radius, flank):
    found = undercut(recipe_of(f"base_radius: {base}", radius))
    assert flank in found
    told = r"a roller radius below ([0-9.]+) with a base radius of ([0-9.]+) less that radius would be free of it"
    most, prime = map(float, re.search(told, found[flank]).groups())
    assert prime == base + radius
    free = math.nextafter(most, 0.0)
    assert flank not in undercut(recipe_of(f"base_radius: {prime - free!r}", repr(free)))
    wider = 1.02 * most + (0.05 if flank == "outer" else 0.1)
    assert flank in undercut(recipe_of(f"base_radius: {prime - wider!r}", repr(wider)))


SIZED = {
    "a stem by its inner flank": ("", 8, "", 20, "inner"),
    "an arm by its outer flank": ("pressure-angle: {at_most: 45}, ", 10, ", arm: {length: 80}", 15, "outer"),
}


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", SIZED)
def test_a_size_obeys_both_flanks(name):
    """Least radii of the metal from 3600 points: the path bends outward at the inner flank, inward at the outer one."""
    angles, least, arm, rise, bound = SIZED[name]
    law = "modified-sine" if arm else "cycloidal"
    recipe = recipe_of(f"sizing: {{{angles}radius-of-curvature: {{at_least: {least}}}}}", 8, arm, rise, law)
    inner, outer = designed(recipe).exact.surfaces
    path = inner.base.sample(np.linspace(0.0, 2.0 * math.pi, 3601))
    bend = path.turn / path.speed
    radii = {"inner": 1.0 / bend.max() - inner.radius, "outer": -1.0 / bend.min() - outer.radius}
    assert radii[bound] == pytest.approx(least, rel=1e-3)
    assert min(radii.values()) > least * (1.0 - 1e-9)
    assert "radius-of-curvature at" in recipe.cam.advice.chosen_size(designed(recipe).exact, 1.0)


def remarks(folder, clearance, tolerance):
    text = GROOVE.replace("clearance: 0.05", f"clearance: {clearance}, depth: 3").replace("SIZE", "base_radius: 40")
    text = text.replace("RADIUSARM", "8").replace("RISE", "14").replace("LAW", "cycloidal")
    text += f"part: {{thickness: 6, outer: 150}}\nexport: {{tolerance: {tolerance}, files: [stl]}}\n"
    outcome = export(read(text.encode(), Path("g.yaml")), folder)
    assert outcome.ok
    return {remark["name"]: remark for remark in outcome.report["remarks"]}


@pytest.mark.slow
def test_a_tolerance_that_takes_the_play_is_remarked_on(tmp_path):
    said = remarks(tmp_path, 0.005, 0.04)["no-play"]
    assert said["value"] < 0.0
    assert "a tolerance below 0.0025 leaves it play" in said["sentence"]
    assert "no-play" not in remarks(tmp_path, 0.005, 0.00249)


@pytest.mark.slow
def test_a_sized_groove_is_freed_by_what_is_told():
    recipe = recipe_of("sizing: {pressure-angle: {at_most: 60}}", 14)
    found = undercut(recipe)
    assert found
    told = re.search(r"(radius-of-curvature: {at_least: [0-9.]+}) under sizing would", next(iter(found.values())))
    assert not undercut(recipe_of(f"sizing: {{pressure-angle: {{at_most: 60}}, {told[1]}}}", 14))
