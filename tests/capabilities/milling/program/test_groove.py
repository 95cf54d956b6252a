"""Programs that mill a groove: what they leave, by which paths, and planted faults on either flank."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from support.cases import few
from support.heavy import shapely
from support.milled import swept

from camgeo.capabilities.milling.milling import milling_intent
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.files.gcode import Cutting, Pass, write_gcode
from camgeo.fit.arcs import fit_arcs
from camgeo.machining.toolpath import begun_at, led, plunged, side_by_side
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.expected_checks import foreseen
from kin.judge.intent import Limits
from kin.judge.verify import verify

STEM = """
name: c
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 9, offset: 6}
  track: {groove: {clearance: 0.03, depth: 5}}
  motion: [{rise: 20, over: 100, law: cycloidal}, {dwell: 40}, {return: 20, over: 140, law: cycloidal}, {dwell: 80}]
part: {thickness: 12PART}
verify: {angles: 90}
export: {tolerance: TOLERANCE, files: [FILES]}
manufacture: {cutter: CUTTER, feed: 600, plunge: 120, spindle: 8000, depth_of_cut: 2, safe_height: 5MORE}
"""
ARM = STEM.replace("offset: 6", "arm: {length: 70, pivot: 85}").replace("base_radius: 36", "base_radius: 34")


def recipe_of(cutter=6.0, more="", *, text=STEM, part="", top="", files="gcode", tolerance=1e-3):
    asked = {"CUTTER": repr(cutter), "MORE": more, "PART": part, "FILES": files, "TOLERANCE": repr(tolerance)}
    for key, value in asked.items():
        text = text.replace(key, value)
    return read(f"{top}{text}".encode(), Path("c.yaml"))


def made(folder, *args, **asked):
    recipe = recipe_of(*args, **asked)
    outcome = pipeline.export(recipe, folder)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    return recipe, outcome, outcome.folder / "c.ngc"


def exact_flanks(recipe, sign=1.0):
    t = np.linspace(0.0, 2.0 * math.pi, 8001)[:-1]
    return [shapely.Polygon(one.curve.sample(t).point * [1.0, sign]) for one in designed(recipe).exact.surfaces]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("asked", "sign", "paths"),
    few(
        [
            ({"cutter": 6.0}, 1.0, 5),  # three side by side, of which the outer two are the flanks', and two between
            ({"cutter": 18.03}, 1.0, 1),
            ({"cutter": 18.0}, 1.0, 3),
            ({"cutter": 9.0, "more": ", direction: conventional, allowance: 0.3, start: 100"}, 1.0, 5),
            ({"cutter": 3.0, "top": "rotation: ccw\n", "text": ARM}, -1.0, 9),
        ],
        2,
    ),
)
def test_what_is_left_between_the_flanks(tmp_path, asked, sign, paths):
    """By words taken apart and discs swept with shapely: the metal within the inner flank and round the outer one."""
    recipe, outcome, path = made(tmp_path, **asked)
    inner, outer = exact_flanks(recipe, sign)
    bottom, left = swept(path, recipe.manufacture.radius)
    assert bottom == -5.0
    island, sheet = left  # and nothing on the floor
    (opening,) = sheet.interiors
    for milled, exact in ((island, inner), (shapely.Polygon(opening), outer)):
        assert milled.symmetric_difference(exact).area < 2.5e-3 * exact.length
        assert shapely.distance(exact.exterior, shapely.points(np.array(milled.exterior.coords))).max() < 2.6e-3
    (file,) = outcome.report["files"]
    assert [one["name"] for one in file["surfaces"]] == ["inner", "outer"]
    assert file["geometry_error"] <= 1e-3
    told = {(check["name"], check.get("surface")) for check in outcome.report["checks"] if "file" in check}
    names = {name for name, _ in told}
    assert names == {one.name for one in foreseen(recipe) if one.file == "c.ngc"}
    assert told >= {("cutter-reach", "inner"), ("cutter-reach", "outer"), ("floor", None), ("form-closure", None)}
    lines = path.read_text().splitlines()
    assert "(not milled: outline, the stock comes with it)" in lines
    circuits = len([line for line in lines if line.startswith("(contour, pass")])
    assert circuits == (paths * 3 if not recipe.manufacture.allowance else (paths - 2) * 3 + 2)


def test_paths_lie_near_enough_and_end_on_the_flanks():
    assert side_by_side(-6.0, 6.03, 3.0, 0.0)[-2:] == pytest.approx([-6.0, 6.03])
    assert side_by_side(-6.0, 6.0, 3.0, 0.5)[-2:] == pytest.approx([-5.5, 5.5])
    assert side_by_side(-0.1, 0.1, 9.0, 0.1) == [0.0]
    for radius in (0.1, 1.0, 2.9):
        ways = sorted(side_by_side(-6.0, 6.0, radius, 0.0))
        assert np.diff(ways).max() <= 1.6 * radius + 1e-12
        assert 0.0 in ways


def test_a_groove_in_a_blank_with_holes_and_a_path_in_its_drawing(tmp_path):
    part = ", outer: 170, bore: 16, bolts: {count: 3, circle: 40, hole: 7}"
    _, outcome, path = made(tmp_path, 6.0, ", holes: true, layer: true", part=part, files="gcode, dxf", tolerance=0.02)
    text = path.read_text()
    assert "(not milled: outline, the stock comes with it, a disc 170 across)" in text
    assert text.count("Z-12.0") == 4 * 1  # the bore and three holes go through
    (dxf,) = (file for file in outcome.report["files"] if file["kind"] == "dxf")
    assert len(dxf["surfaces"]) == 2
    assert (outcome.folder / "c.dxf").read_text().count("TOOLPATH") > 2


@pytest.mark.parametrize(
    ("asked", "path", "problem"),
    [
        ({"cutter": 18.04}, "manufacture.cutter", "wider than the groove, given 18.04 mm; give 18.03 mm or less"),
        ({"text": STEM.replace(", depth: 5", "")}, "export.files[0]", "gcode needs the depth of the groove"),
        ({"cutter": 0.02}, "manufacture.depth_of_cut", "makes 2818 passes, more than 2000"),
    ],
)
def test_what_cannot_be_milled_is_refused(asked, path, problem):
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(recipe_of(**asked))
    (error,) = caught.value.errors
    assert error.path == path
    assert problem in str(error)


def test_the_widest_cutter_that_is_told_does():
    assert recipe_of(18.03).manufacture.cutter == 18.03


# --- planted faults ---------------------------------------------------------------------------------------------------

INNER, OUTER = -6.0, 6.03  # places of the paths of a cutter of 6 mm, outward from the pitch curve
SOUND = {0.0: 0, 3.0: 0, -3.0: 0, INNER: 1, OUTER: -1}  # by place: side of the metal, 0 of a path that makes no flank


@cache
def way(place):
    """The path at a place of the groove of `STEM`."""
    pitch = designed(recipe_of()).exact.surfaces[0].base.shape
    return begun_at(fit_arcs(Curve.whole(Parallel(pitch, -place)), 2e-5), 0.0)


def program(path, ways, *, depth=5.0, lead=2.0, turned=0.0, reversed_=(), shallow=(), named=6.0):
    steps = []
    for place, side in ways.items():
        along = way(place)
        c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
        along = type(along)(along.points @ np.array([[c, s], [-s, c]]), along.bulges, along.bound)
        clockwise = (side >= 0) != (place in reversed_)
        loop = led(along, lead, side=side, clockwise=clockwise) if side else plunged(along, clockwise=clockwise)
        steps.append(Pass(-depth + (0.1 if place in shallow else 0.0), loop))
    remarks = [f"cutter: diameter {named}"]
    write_gcode(path, [("contour", steps)], Cutting(600, 120, 8000, 5), remarks=remarks, count=7, mm=1.0)


def failures(path, recipe):
    verdict = verify(path, milling_intent(recipe, designed(recipe)), 90, Limits(1e-4))
    return {(check.name, check.surface) for check in verdict.checks if not check.ok}


@pytest.fixture(scope="module")
def deep():
    """A groove that one pass mills to its depth."""
    return recipe_of().replace("manufacture.depth_of_cut", 5)


def moved(place, by):
    """The sound paths with that of a flank moved outward."""
    return {(each + by if each == place else each): side for each, side in SOUND.items()}


def without(*places):
    return {place: side for place, side in SOUND.items() if place not in places}


def on(flank):
    return {("contour", flank), ("motion", flank), ("form-closure", "")}


MADE = {
    "none": ({"ways": SOUND}, set()),
    "the cutter's radius on the wrong side of the inner flank": (
        {"ways": moved(INNER, -6.0)}, on("inner") | {("depth", "")},
    ),
    "the cutter's radius on the wrong side of the outer flank": (
        {"ways": moved(OUTER, 6.0)}, on("outer") | {("depth", "")},
    ),
    "no radius at the inner flank": ({"ways": moved(INNER, -3.0)}, on("inner")),
    "the inner flank is not milled": ({"ways": without(INNER)}, on("inner")),
    "the outer flank is not milled": ({"ways": without(OUTER)}, on("outer")),
    "the outer flank with the inner's offset": ({"ways": moved(OUTER, -0.03)}, on("outer")),
    "a clearance of the wrong sign": ({"ways": moved(OUTER, -0.06)}, on("outer")),
    "a flank 3e-4 mm off": ({"ways": moved(INNER, -3e-4)}, on("inner")),
    "turned": ({"ways": SOUND, "turned": 0.02}, (on("inner") | on("outer")) - {("form-closure", "")}),
    "too shallow": ({"ways": SOUND, "depth": 4.9}, {("depth", "")}),
    "too deep": ({"ways": SOUND, "depth": 5.1}, {("depth", "")}),
    "one flank too shallow": ({"ways": SOUND, "shallow": (OUTER,)}, on("outer")),
    "another cutter": ({"ways": SOUND, "named": 6.0004}, {("cutter", "")}),
    "metal between two paths": ({"ways": without(3.0)}, {("contour", "inner")}),
    "paths that hardly meet": ({"ways": {0.05: 0, **without(0.0, 3.0)}}, {("floor", "")}),
    "no middle": ({"ways": without(0.0, 3.0, -3.0)}, {("contour", "inner")}),
    "a flank the wrong way round": ({"ways": SOUND, "reversed_": (OUTER,)}, {("direction", "")}),
    "a way in through the other flank": ({"ways": SOUND, "lead": 12.5}, {("gouge", "")}),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("fault", MADE)
def test_a_program_that_is_made_wrong(deep, tmp_path, fault):
    given, expected = MADE[fault]
    program(tmp_path / "c.ngc", **given)
    found = failures(tmp_path / "c.ngc", deep)
    assert expected <= found if expected else not found, found


@pytest.mark.slow
def test_a_program_for_another_cutter(tmp_path):
    """Made for 6.0004 mm and run with 6 mm: both flanks are off."""
    _, _, path = made(tmp_path, 6.0004, tolerance=1e-4)
    path.write_text(path.read_text().replace("diameter 6.0004", "diameter 6"))
    found = failures(path, recipe_of())
    assert {("contour", "inner"), ("contour", "outer")} <= found


@pytest.mark.slow
def test_a_pass_that_is_left_out(deep, tmp_path):
    """Without the middle a flank's path takes the whole depth at once."""
    path = tmp_path / "c.ngc"
    program(path, {INNER: 1, **without(INNER)})
    assert ("depth", "") in failures(path, deep.replace("manufacture.depth_of_cut", 2))


@pytest.mark.slow
@pytest.mark.parametrize("clearance", few(["1.0", "1.0e-6", "0"]))
@pytest.mark.parametrize("cutter", few([18.0, 5.0]))
def test_extremes_of_clearance(tmp_path, clearance, cutter):
    text = STEM.replace("clearance: 0.03", f"clearance: {clearance}")
    _, outcome, _ = made(tmp_path, cutter, text=text, tolerance=1e-4)
    (play,) = outcome.report["files"][0]["play"]
    assert play["min"] == pytest.approx(float(clearance), abs=2.5e-4)
