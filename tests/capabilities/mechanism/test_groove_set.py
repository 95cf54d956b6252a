"""Sets of cams with a groove: the roller hangs into it from above, on a stem or an arm that no spring holds."""

import math
from pathlib import Path

import numpy as np
import pytest
from support.heavy import Heavy, shapely

from camgeo.capabilities.mechanism.interference import collision_checks
from camgeo.capabilities.mechanism.making import build_assembly
from camgeo.fit.arcs import fit_arcs
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.contour.contour import Contour

trimesh = Heavy("trimesh")

STEM = """
cam:
  kind: disc
  base_radius: 24
  follower: {kind: roller, radius: 6}
  track: {groove: {clearance: 0.2, depth: 5}}
  motion: [{rise: 16, over: 110, law: modified-sine}, {dwell: 70}, {return: 16, over: 130, law: cycloidal}, {dwell: 50}]
part: {thickness: 9, bore: {hexagon: 8}, outer: 116}
export: {tolerance: 0.01, files: [{stl: {parts: all}}]}
verify: {angles: 60}
"""
ARM = STEM.replace("radius: 6}", "radius: 6, arm: {length: 68, pivot: 78}}")


def assembled(text):
    recipe = read(text.encode(), Path("set.yaml"))
    design = designed(recipe)
    contours = [fit_arcs(contour, 0.01) for _, contour in design.contours]
    return build_assembly(recipe, design, *contours)


@pytest.mark.thin(2)
@pytest.mark.parametrize(("text", "bodies"), [(STEM, 7), (ARM, 7)])
def test_nothing_meets_and_the_roller_stays_in_the_groove(text, bodies):
    assembly = assembled(text)
    assert len(assembly.members) == bodies
    clearance, *pairs = collision_checks(assembly)
    assert clearance.ok
    assert clearance.value == pytest.approx(0.2)
    assert "the floor of the groove keeps the roller on its pin" in clearance.detail
    assert "spring" not in clearance.detail
    assert all(check.ok for check in pairs), [check for check in pairs if not check.ok]
    members = {member.name: member for member in assembly.members}
    low, high = (
        (min(p.low for p in members[name].plates), max(p.high for p in members[name].plates))
        for name in ("cam", "roller")
    )
    floor = low[1] - 5.0
    assert floor < high[0] < floor + 1.0
    assert high[1] <= low[1]
    # by discs and polygons alone: what is left to the roller between the flanks is the groove's clearance
    sheet, island = members["cam"].plates[2], members["cam"].plates[1]
    inner, outer = (polygon(one) for one in (island.outline, sheet.holes[0]))
    cam, roller = members["cam"].poses(36), members["roller"].poses(36)
    wheel = polygon(members["roller"].plates[0].outline)
    for standing, running in zip(cam, roller, strict=True):
        centre = shapely.Point(placed(np.array([[wheel.centroid.x, wheel.centroid.y]]), running)[0])
        within, without = (
            centre.distance(shapely.Polygon(placed(np.array(one.exterior.coords), standing)).exterior)
            for one in (inner, outer)
        )
        assert within == pytest.approx(6.0, abs=0.03)
        assert without == pytest.approx(6.2, abs=0.03)


def polygon(outline):
    return shapely.Polygon(Contour.from_bulges(outline.points, outline.bulges).sample(40))


def placed(points, pose):
    x, y, angle = pose
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]]) + (x, y)


@pytest.mark.slow
@pytest.mark.parametrize(("text", "per_mm"), [(STEM, 1.0), (ARM, math.degrees(1.0 / 68.0))])
def test_every_body_is_written_and_judged(text, per_mm, tmp_path):
    outcome = pipeline.export(read(text.encode(), Path("set.yaml")), tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    cam = trimesh.load(outcome.folder / "set-cam.stl")
    roller = trimesh.load(outcome.folder / "set-roller.stl")
    assert cam.is_watertight
    assert roller.is_watertight
    assert roller.extents[2] == pytest.approx(4.6)
    play = next(file["play"] for file in outcome.report["files"] if file["path"] == "set-cam.stl")
    assert play[0]["min"] == pytest.approx(0.2 * per_mm, abs=0.021 * per_mm)


REFUSED = {
    "cam.track.groove.depth": (STEM, "depth: 5", "depth: 0.7", "too thin to be printed; give at least 0.8 mm"),
    "export.tolerance": (STEM, "0.2,", "0.03,", "or a cam.track.groove.clearance above 0.04 mm"),
    "cam.track.groove.clearance": (STEM, "0.2,", "0,", "finer than bodies are made; give at least 0.001 mm"),
    "cam.follower.arm.pivot": (
        ARM,
        "outer: 116",
        "outer: 160",
        "no room for the arm's pivot at 78 mm; give",
    ),
}


@pytest.mark.thin(2)
@pytest.mark.parametrize("path", REFUSED)
def test_what_cannot_be_printed_is_refused(path, tmp_path):
    text, before, after, told = REFUSED[path]
    assert before in text
    with pytest.raises(RecipeErrors) as caught:
        pipeline.export(read(text.replace(before, after).encode(), Path("set.yaml")), tmp_path)
    (error,) = caught.value.errors
    assert error.path == path
    assert told in str(error)
