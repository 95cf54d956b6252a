"""Meshes of a groove with a hub below and an engraved mark: closed, judged in layers, each told when it is missing."""

import math
from pathlib import Path

import pytest
from support.heavy import Heavy

from camgeo.output import pipeline
from camgeo.recipe.loading import read

trimesh = Heavy("trimesh")

HUB = ", hub: {diameter: 28, height: 9, side: bottom}, set_screw: {diameter: 4, at: 90}"
MARK = ", mark: {as: engrave, width: 1.2, length: 5, depth: 0.8}"
GROOVE = """
name: g
cam:
  kind: disc
  base_radius: 28
  follower: {kind: roller, radius: 7}
  track: {groove: {clearance: 0.04, depth: 6}}
  motion: [{rise: 12, over: 180, law: cycloidal}, {return: 12, over: 180, law: cycloidal}]
part: {bore: 14, thickness: 11, outer: 124PART}
export: {tolerance: 0.002, files: [KIND]}
verify: {angles: 90}
"""


def exported(folder, part, kind="stl"):
    recipe = read(GROOVE.replace("PART", part).replace("KIND", kind).encode(), Path("g.yaml"))
    outcome = pipeline.export(recipe, folder)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    return recipe, outcome.folder / f"g.{kind}"


@pytest.mark.costly("a part with a text, in each format of solids")
def test_a_hub_below_and_a_mark(tmp_path):
    recipe, path = exported(tmp_path / "all", HUB + MARK)
    _, plain = exported(tmp_path / "plain", "")
    mesh, without = trimesh.load(path), trimesh.load(plain)
    assert mesh.is_watertight
    assert mesh.bounds[:, 2] == pytest.approx([-9.0, 11.0], abs=1e-5)
    hub = math.pi * 9.0 * (14.0**2 - 7.0**2) - math.pi * 4.0 * (14.0 - 7.0)  # less the screw's hole, about
    mark = 0.8 * (1.2 * 3.8 + math.pi * 0.36)
    assert mesh.volume - without.volume == pytest.approx(hub - mark, abs=12.0)
    failed = {check["name"] for check in pipeline.judge_files(recipe, [plain])["checks"] if not check["ok"]}
    assert failed == {"readable"} or failed >= {"hub", "mark"}


@pytest.mark.slow
@pytest.mark.parametrize(("part", "other"), [(HUB, HUB.replace("height: 9", "height: 9.1")), (MARK, ""), ("", MARK)])
@pytest.mark.parametrize("kind", ["stl", "3mf"])
def test_what_differs_is_told(part, other, kind, tmp_path):
    recipe, _ = exported(tmp_path / "meant", part, kind)
    _, path = exported(tmp_path / "other", other, kind)
    failed = {check["name"] for check in pipeline.judge_files(recipe, [path])["checks"] if not check["ok"]}
    assert failed & {"hub", "mark", "thickness", "readable", "bore", "holes"}
