"""Grooves through recipe and file: a worked case, brute-force contact on either flank, and files with a fault.

The case is d09 of the sheet on disc cams: a roller of 9 mm on a stem, the outer flank wider by 0.03 mm.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from support import brute_disc
from support.heavy import ezdxf
from support.kernel import kernel

from camgeo.output.pipeline import export, judge_files
from camgeo.recipe.loading import read
from camgeo.report.failure import failure
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended, permitted
from kin.judge.verify import verify

STEM = """
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9, offset: 6}
  track: {groove: {clearance: CLEARANCE}}
  motion:
    - {rise: 24, over: 100, law: polynomial-4567}
    - {dwell: 40}
    - {return: 24, over: 140, law: polynomial-4567}
    - {dwell: 80}
part: {bore: 20PART}
export: {tolerance: 0.0001, files: [dxf, svg]}
"""
ARM = STEM.replace("base_radius: 36", "base_radius: 34").replace(
    "radius: 9, offset: 6", "radius: 8, arm: {length: 65, pivot: 80, side: SIDE}"
)
TOLERANCE = 1e-4
LAYERS = {"inner": "GROOVE_INNER", "outer": "GROOVE_OUTER"}


def text(template=STEM, clearance=0.03, *, part="", side="trailing"):
    return template.replace("CLEARANCE", repr(clearance)).replace("PART", part).replace("SIDE", side)


def recipe_of(*args, **kwargs):
    return read(text(*args, **kwargs).encode(), Path("groove.yaml"))


@pytest.fixture(scope="module")
def stem(tmp_path_factory):
    """The recipe of the case and its DXF."""
    recipe = recipe_of()
    outcome = export(recipe, tmp_path_factory.mktemp("stem"))
    assert outcome.ok
    return recipe, outcome.folder / "groove.dxf"


def test_the_exact_flanks_of_the_case():
    inner, outer = designed(recipe_of()).exact.surfaces
    points = {0: (35.678564994, 4.8), 50: (23.761892812, 43.134247072), 250: (-9.239931968, -35.941595478)}
    found = inner.curve.sample(np.radians(list(points))).point
    assert found == pytest.approx(np.array(list(points.values())), abs=1.01e-9)
    assert outer.curve.sample(np.radians([50.0])).point[0] == pytest.approx((39.833566830, 51.306284409), abs=1.01e-9)
    for surface in (inner, outer):
        low, high = surface.extremes("slope")
        assert math.degrees(math.atan(high.value)) == pytest.approx(23.350919174, abs=1e-8)
        assert math.degrees(math.atan(low.value)) == pytest.approx(-26.435982798, abs=1e-8)
        assert math.degrees(low.at) == pytest.approx(217.01549, abs=1e-5)


@pytest.mark.slow
def test_the_play_of_the_case_from_its_file(stem):
    """Within what two contours off by the tolerance make of it."""
    recipe, path = stem
    verdict = verify(path, intended(recipe, designed(recipe)), 360, permitted(recipe, TOLERANCE))
    (closure,) = verdict.closures
    assert verdict.ok
    off = 2.0 * TOLERANCE / math.cos(math.radians(26.436))
    assert closure.play.most == pytest.approx(0.033501312, abs=off)
    assert closure.play.most_at_deg == pytest.approx(217.0166, abs=5.0)
    assert closure.play.least == pytest.approx(0.03, abs=off)
    assert max(abs(closure.gauges.least), abs(closure.gauges.most)) < off


@pytest.mark.slow
def test_the_play_is_reported_and_limited(tmp_path):
    """By what is left to the roller itself, not to the rollers that fill the groove."""
    report = export(
        read((text() + "limits: {backlash: {at_most: 0.0336}}\n").encode(), Path("g.yaml")), tmp_path
    ).report
    assert report["ok"]
    for file in report["files"]:
        (play,) = file["play"]
        assert (play["between"], play["unit"]) == (["inner", "outer"], "mm")
        assert play["max"] == pytest.approx(0.033501312, abs=2.3e-4)
    (limit, _) = [check for check in report["checks"] if check["name"] == "limit:backlash"]
    assert limit["value"] == pytest.approx(play["max"], rel=1e-12)
    tight = export(read((text() + "limits: {backlash: {at_most: 0.0334}}\n").encode(), Path("g.yaml")), tmp_path)
    assert {check["name"] for check in tight.report["checks"] if not check["ok"]} == {"limit:backlash"}


@pytest.mark.slow
@pytest.mark.parametrize("clearance", [1.0, 0.03, 1e-6, 0.0])
@pytest.mark.parametrize("held", ["stem", "trailing", "leading"])
def test_brute_force_on_either_flank(held, clearance, tmp_path):
    recipe = recipe_of(STEM if held == "stem" else ARM, clearance, side=held)
    outcome = export(recipe, tmp_path, only=("dxf",))
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    exact = designed(recipe).exact
    prime, radius = recipe.cam.prime, recipe.cam.touch.radius
    theta = np.radians(np.arange(0.0, 360.0, 7.5))
    meant = exact.motion.rows(theta, 0)[0]
    place = {}
    for name, gauge in (("inner", radius), ("outer", radius + clearance), ("stopped", radius)):
        ring = name != "inner"
        touching = touched(held, gauge, ring=ring)
        flank = brute_disc.polygon(outcome.folder / "groove.dxf", layer=LAYERS.get(name, "GROOVE_OUTER"))
        base = prime + (gauge if ring else -gauge)
        place[name] = np.array([touching.place(flank, angle, base) for angle in theta]) - touching.rest(base)
    pressure = exact.surfaces[0].pressure(theta)
    lever = np.cos(pressure) * (1.0 if held == "stem" else 65.0)
    for name in ("inner", "outer"):
        assert np.abs((place[name] - meant) * lever).max() < 1.1e-4
    play = (place["stopped"] - place["inner"]) * lever
    assert play == pytest.approx(np.full(len(theta), clearance), abs=2.2e-4 + 2e-2 * clearance)


def touched(held, radius, *, ring):
    """The follower as brute force knows it."""
    if held == "stem":
        return brute_disc.Touching("roller", radius, offset=6.0, ring=ring)
    sense = 1 if held == "trailing" else -1
    return brute_disc.Touching("roller", radius, pivot=80.0, length=65.0, sense=sense, ring=ring)


def swapped(flanks):
    for name, flank in flanks.items():
        flank.dxf.layer = LAYERS["outer" if name == "inner" else "inner"]


def without_outer(flanks):
    flanks["outer"].doc.modelspace().delete_entity(flanks["outer"])


def without_inner(flanks):
    flanks["inner"].doc.modelspace().delete_entity(flanks["inner"])


def outer_as_inner(flanks):
    flanks["outer"].set_points(flanks["inner"].get_points("xyb"), format="xyb")


def outer_moved(flanks):
    flanks["outer"].set_points([(x + 3e-4, y, b) for x, y, b in flanks["outer"].get_points("xyb")], format="xyb")


def inner_scaled(flanks):
    points = [(x * (1.0 + 1e-5), y * (1.0 + 1e-5), b) for x, y, b in flanks["inner"].get_points("xyb")]
    flanks["inner"].set_points(points, format="xyb")


def mirrored(flanks):
    for flank in flanks.values():
        flank.set_points([(x, -y, -b) for x, y, b in flank.get_points("xyb")], format="xyb")


FAULTS = {
    swapped: {("contour", "inner"), ("contour", "outer"), ("form-closure", None)},
    without_inner: {("readable", None)},
    without_outer: {("readable", None)},
    outer_as_inner: {("readable", None)},
    outer_moved: {("contour", "outer"), ("motion", "outer"), ("form-closure", None)},
    inner_scaled: {("contour", "inner"), ("motion", "inner")},
    mirrored: {("contour", "inner"), ("contour", "outer"), ("motion", "inner"), ("motion", "outer")},
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_refused(fault, stem, tmp_path):
    recipe, path = stem
    assert failed(recipe, path) == set()
    drawing = ezdxf.readfile(path)
    entities = {entity.dxf.layer: entity for entity in drawing.modelspace()}
    fault({name: entities[layer] for name, layer in LAYERS.items()})
    drawing.saveas(tmp_path / "spoilt.dxf")
    assert failed(recipe, tmp_path / "spoilt.dxf") >= FAULTS[fault]


@pytest.mark.slow
@pytest.mark.parametrize("clearance", [0.0, 0.0302, -0.03])
def test_the_file_of_another_clearance_is_refused(clearance, stem, tmp_path):
    """0: the outer flank with the inner's offset; of the wrong sign: a groove that its roller does not fill up to."""
    recipe, _ = stem
    other = recipe_of(clearance=abs(clearance))
    if clearance < 0.0:
        other = recipe_of(clearance=0.0).replace("cam.follower.radius", 9.0 + clearance)
    path = export(other, tmp_path, only=("dxf",)).folder / "groove.dxf"
    assert failed(recipe, path) >= {("contour", "outer"), ("motion", "outer"), ("form-closure", None)}


def failed(recipe, path):
    return {(check["name"], check.get("surface")) for check in judge_files(recipe, [path])["checks"] if not check["ok"]}


def test_the_blank_stands_on_cut(tmp_path):
    recipe = recipe_of(part=", outer: 180")
    outcome = export(recipe, tmp_path, only=("dxf",))
    assert outcome.ok
    drawing = ezdxf.readfile(outcome.folder / "groove.dxf").modelspace()
    layers = [entity.dxf.layer for entity in drawing if entity.dxf.layer != "REFERENCE"]
    assert sorted(layers) == ["BORE", "CUT", "GROOVE_INNER", "GROOVE_OUTER"]
    assert {check["name"] for check in outcome.report["checks"]} >= {"outer", "wall"}


@pytest.mark.slow
def test_a_blank_that_the_groove_breaks_through_is_refused(tmp_path):
    recipe = recipe_of(part=", outer: 150")
    outcome = export(recipe, tmp_path)
    assert not outcome.ok
    (wall,) = [check for check in outcome.report["checks"] if not check["ok"]]
    assert wall["name"] == "wall"
    assert wall["detail"].startswith("outer opening and outline")
    told = failure(wall, outcome.report, recipe)
    more = re.search(r"a part.outer larger by more than ([0-9.]+) mm", told)
    assert export(recipe_of(part=f", outer: {150 + 1.001 * float(more[1])}"), tmp_path).ok


@pytest.mark.slow
def test_undercut_of_a_flank_is_named_and_its_remedy_helps(tmp_path):
    """The outer flank's gauge is wider: what frees it is a roller smaller by the clearance too."""
    steep = text(clearance=1.0).replace("over: 100", "over: 40").replace("dwell: 80", "dwell: 140")
    recipe = read(steep.replace("radius: 9", "radius: 40").encode(), Path("groove.yaml"))
    undercut = [check for check in export(recipe, tmp_path).report["checks"] if not check["ok"]]
    assert {check["surface"] for check in undercut} >= {"outer"}
    radii = []
    for check in undercut:
        if not check["name"].startswith("undercut"):
            continue
        told = re.search(r"a roller radius below ([0-9.]+) with a base radius of ([0-9.]+) less", check["detail"])
        radii.append((float(told[1]), float(told[2])))
        assert "trim" not in check["detail"]
    radius, prime = min(radii)
    free = recipe.replace({"cam.follower.radius": 0.9999 * radius, "cam.base_radius": prime - 0.9999 * radius})
    assert not [check for check in designed(free).checks if check.name.startswith("undercut") and not check.ok]


SOLID = """
rotation: ccw
cam:
  kind: disc
  base_radius: 38
  follower: {kind: roller, radius: 8, arm: {length: 65, pivot: 80, side: leading}}
  track: {groove: {clearance: 0.05, depth: 5}}
  motion: {repeat: 2, segments: [{rise: 10, over: 60, law: cycloidal}, {dwell: 40}, {return: 10, over: 80, law: cubic}]}
part: {thickness: 9, bore: 14, keyway: din6885, outer: 200, bolts: {count: 4, circle: 40, hole: 5},
  dowel: {circle: 180, at: 30, hole: 6}}
export: {tolerance: 0.002, files: [stl, 3mf]}
"""


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["stl", "3mf", pytest.param("step", marks=kernel)])
def test_a_solid_has_the_pocket(kind, tmp_path):
    """Its volume by closed forms; a groove that is 1e-3 mm too shallow, or too wide, is refused."""
    recipe = read(SOLID.replace("[stl, 3mf]", f"[{kind}]").encode(), Path("groove.yaml"))
    outcome = export(recipe, tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    names = {(check["name"], check.get("surface")) for check in outcome.report["checks"]}
    assert names >= {
        ("volume", None),
        ("thickness", None),
        ("motion", "inner"),
        ("motion", "outer"),
        ("form-closure", None),
    }
    path = outcome.folder / f"groove.{kind}"
    for changed, check in (("depth: 4.997", ("thickness", None)), ("depth: 5.003", ("thickness", None))):
        other = read(SOLID.replace("depth: 5", changed).encode(), Path("groove.yaml"))
        assert check in failed(other, path)
    wider = read(SOLID.replace("clearance: 0.05", "clearance: 0.045").encode(), Path("groove.yaml"))
    assert failed(wider, path) >= {("contour", "outer"), ("motion", "outer")}


@pytest.mark.slow
@kernel
@pytest.mark.parametrize("form", ["arcs", "spline"])
def test_a_step_solid_has_a_hub_below_and_a_mark(form, tmp_path):
    hub = "hub: {diameter: 25, height: 8, side: bottom}, mark: {as: engrave, width: 1, length: 4}"
    text = SOLID.replace("thickness: 9,", f"thickness: 9, {hub},").replace("[stl, 3mf]", f"[{{step: {{as: {form}}}}}]")
    outcome = export(read(text.encode(), Path("groove.yaml")), tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    assert {check["name"] for check in outcome.report["checks"]} >= {"hub", "mark", "holes", "bore", "volume"}


def test_a_thin_floor_is_a_wall():
    shallow = SOLID.replace("depth: 5", "depth: 8").replace("keyway: din6885", "keyway: din6885, wall: 1.5")
    (wall,) = [check for check in designed(read(shallow.encode(), Path("groove.yaml"))).checks if not check.ok]
    assert (wall.name, wall.value) == ("wall", 1.0)
    assert wall.detail.startswith("groove and the lower face")
