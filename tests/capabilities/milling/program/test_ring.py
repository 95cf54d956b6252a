"""Programs that mill the opening of a ring: what they leave, how far a cutter reaches, planted faults."""

import math
import re
from dataclasses import replace
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.entities import LWPolyline
from support.cases import few
from support.heavy import Heavy, shapely
from support.milled import swept

from camgeo.capabilities.milling.milling import milling_intent
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.files.gcode import Cutting, Pass, write_gcode
from camgeo.fit.arcs import fit_arcs
from camgeo.machining.toolpath import begun_at, led
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.report.failure import remedy
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.expected_checks import foreseen
from kin.contour.contour import Contour
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.read.files import read_drawing
from kin.read.gcode import read_gcode

spatial = Heavy("scipy.spatial")

CAM = (
    "cam:\n  kind: disc\n  base_radius: 60\n  track: internal\n  follower: {kind: roller, radius: 9}\n"
    "  motion: [{rise: 12, over: 120, law: cycloidal}, {dwell: 60}, {return: 12, over: 120, law: cycloidal}, "
    "{dwell: 60}]\n"
)
PART = "{thickness: 8, outer: 170, bolts: {count: 6, circle: 158, hole: 7}}"
MILLING = "feed: 600, plunge: 120, spindle: 8000, depth_of_cut: 3, safe_height: 5"
TRIMMED = CAM.replace("60\n", "30\n", 1).replace("over: 120", "over: 50", 1).replace("{dwell: 60}]", "{dwell: 130}]")
TRIMMED += "  undercut: trim\n"


def recipe_of(cutter=6, more="", *, cam=CAM, part=PART, top="", files="gcode"):
    body = f"{top}name: c\n{cam}part: {part}\nexport: {{tolerance: 0.001, files: [{files}]}}\n"
    body += f"verify: {{angles: 90}}\nmanufacture: {{cutter: {cutter}, {MILLING}{more}}}\n"
    return read(body.encode(), Path("c.yaml"))


def made(folder, *args, **asked):
    """The recipe, its outcome and the program's path."""
    recipe = recipe_of(*args, **asked)
    outcome = pipeline.export(recipe, folder)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    return recipe, outcome, outcome.folder / "c.ngc"


def exact_opening(recipe, sign=1.0, count=8001):
    contour = designed(recipe).only_surface.contour
    t = np.concatenate([np.linspace(run.low, run.high, count)[:-1] for run in contour.runs])
    return shapely.Polygon(contour.sample(t).point * [1.0, sign])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("asked", "sign"),
    few(
        [
            ({}, 1.0),
            ({"more": ", direction: conventional, allowance: 0.3, start: 100", "top": "rotation: ccw\n"}, -1.0),
            ({"cutter": 30, "more": ", allowance: 1"}, 1.0),  # wider than the roller
            ({"cutter": 7, "cam": TRIMMED, "part": "{thickness: 8, outer: 170}"}, 1.0),
        ],
        2,
    ),
)
def test_what_is_left_of_a_sheet(tmp_path, asked, sign):
    recipe, _, path = made(tmp_path, **asked)
    exact = exact_opening(recipe, sign)
    bottom, left = swept(path, recipe.manufacture.radius)
    assert bottom == -8.0
    slug, sheet = left
    assert slug.within(exact), "the middle falls out"
    (opening,) = sheet.interiors
    opening = shapely.Polygon(opening)
    assert opening.symmetric_difference(exact).area < 2.5e-3 * exact.length
    assert shapely.distance(exact.exterior, shapely.points(np.array(opening.exterior.coords))).max() < 2.6e-3


def test_the_track_alone_is_cut_and_what_is_not_is_named(tmp_path):
    recipe, outcome, path = made(tmp_path)
    told = [check["name"] for check in outcome.report["checks"] if check.get("file") == "c.ngc"]
    assert "outer" not in told
    assert sorted(told) == sorted(one.name for one in foreseen(recipe) if one.file == "c.ngc")
    assert "(not milled: outline, the stock comes with it, a disc 170 across)" in path.read_text().splitlines()
    skipped = {item["what"]: item["why"] for item in outcome.report["skipped"]}
    assert skipped["outline"].startswith("not milled: the stock comes with it")
    reach = next(check for check in outcome.report["checks"] if check["name"] == "cutter-reach")
    assert reach["detail"] == "least hollow radius 57.2262 mm at 85.7874 deg"
    farthest = max(np.hypot(*move.end[:2]) for move in read_gcode(path).moves)
    assert farthest == pytest.approx(72.0 - 3.0, abs=1e-3), "the cutter stays in the opening"


@pytest.mark.thin(2)
@pytest.mark.parametrize(("direction", "sense"), [("climb", 1.0), ("conventional", -1.0)])
def test_a_cutter_that_climbs_goes_counter_clockwise_in_a_ring(tmp_path, direction, sense):
    _, _, path = made(tmp_path, more=f", direction: {direction}")
    points = np.array([move.end[:2] for move in read_gcode(path).moves if not move.rapid and move.end[2] == -8.0])
    x, y = points.T
    assert np.sign(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) == sense


def test_holes_larger_than_the_opening(tmp_path):
    """The track is what goes round the shaft, whatever is larger."""
    cam = (
        CAM.replace("base_radius: 60", "base_radius: 34")
        .replace("rise: 12", "rise: 3")
        .replace("return: 12", "return: 3")
    )
    part = "{thickness: 8, outer: 320, bolts: {count: 2, circle: 200, hole: 90}}"
    _, outcome, _ = made(tmp_path, more=", holes: true", cam=cam, part=part)
    (file,) = outcome.report["files"]
    assert file["area"] < math.pi * 40**2


def unreached(recipe, count=10_000):
    """How deep metal is left, by all places of the cutter's centre that are far enough from all the contour."""
    radius, contour = recipe.manufacture.radius, designed(recipe).only_surface.contour
    frame = contour.sample(2 * math.pi * np.arange(count) / count)
    centre = frame.point - radius * frame.normal
    free = spatial.cKDTree(frame.point).query(centre)[0] > radius - 1e-7
    return float((spatial.cKDTree(centre[free]).query(frame.point)[0] - radius).max())


@pytest.mark.slow
@pytest.mark.parametrize("across", few([118, 116]))
def test_hollows_that_a_cutter_does_not_reach(tmp_path, across):
    recipe = recipe_of(across)
    checks = {check["name"]: check for check in pipeline.check(recipe).report["checks"]}
    left = unreached(recipe)
    assert left > 0.01
    reach = checks["cutter-reach"]
    assert not reach["ok"]
    assert reach["value"] == pytest.approx(left, abs=1e-3)
    free = float(re.search(r"a cutter (\S+) mm across would reach all", reach["detail"])[1])
    assert pipeline.check(recipe_of(free - 1e-3)).ok
    _, outcome, _ = made(tmp_path, across, f", unreached: {reach['value'] + 1e-6}")
    contour = next(check for check in outcome.report["checks"] if check["name"] == "contour")
    assert contour["value"] < 0.001
    assert f"{reach['value']:.3g} mm inside" in contour["detail"]


@pytest.mark.slow
def test_another_way_in_where_the_path_has_a_corner():
    """Where a hollow is not reached the path turns in a corner, which is no place to come to it."""
    text = ", unreached: 1, start: {}"
    recipe = recipe_of(118, text.format(-86))
    outcome = pipeline.check(recipe)
    failed = [check for check in outcome.report["checks"] if not check["ok"]]
    assert "gouge" in {check["name"] for check in failed} <= {"entry", "gouge"}
    for check in failed:
        told = remedy(check, outcome.report, recipe)
        assert told == "another manufacture.start, or a smaller manufacture.lead_in"
    assert pipeline.check(recipe_of(118, text.format(0))).ok


@pytest.mark.slow
@pytest.mark.thin(4)
@pytest.mark.parametrize("more", ["", ", layer: true"])
def test_a_cutter_of_the_radius_of_a_dwell_is_refused(more):
    """Its centre would stay in a point while the contour turns."""
    files = "dxf" if more else "gcode"
    with pytest.raises(RecipeErrors, match=r"manufacture\.cutter: .*given 120 mm; give one a little") as caught:
        pipeline.check(recipe_of(120, f", unreached: 1{more}", files=files))
    assert len(caught.value.errors) == 1
    for across in (119.99, 120.01):
        checks = pipeline.check(recipe_of(across, f", unreached: 1{more}", files=files)).report["checks"]
        assert {check["name"] for check in checks if not check["ok"]} <= {"entry", "gouge"}


def test_a_trimmed_ring_takes_no_wider_cutter_than_its_roller():
    checks = pipeline.check(recipe_of(19, cam=TRIMMED, part="{thickness: 8, outer: 170}")).report["checks"]
    (failed,) = (check for check in checks if not check["ok"])
    assert "takes a cutter no wider than its roller, 18 mm" in failed["detail"]


@pytest.mark.slow
@pytest.mark.parametrize("top", few(["", "rotation: ccw\n"], 2))
def test_the_path_on_a_layer_of_its_own(tmp_path, top):
    recipe = recipe_of(top=top, more=", layer: true", files="dxf")
    outcome = pipeline.export(recipe, tmp_path)
    assert outcome.ok
    path = outcome.folder / "c.dxf"
    space = ezdxf.readfile(path).modelspace()
    (drawn,) = space.query("LWPOLYLINE[layer=='TOOLPATH']")
    assert isinstance(drawn, LWPolyline)
    rows = np.array(drawn.get_points("xyb"))
    drawing = read_drawing(path)
    opening = max(drawing.holes, key=lambda hole: hole.area)
    places = Contour.from_bulges(rows[:, :2], rows[:, 2]).sample(5)
    assert opening.distance(places) == pytest.approx(3.0, abs=2e-3)
    assert (np.hypot(*places.T) < 72.0 - 2.9).all()


# --- planted faults ---------------------------------------------------------------------------------------------------


def program(path, recipe, *, inward, turned=0.0, side=-1, lead=3.0):
    """One pass along the parallel of the contour `inward` of it, with ways in and out from one side."""
    pitch = designed(recipe).only_surface.surface.base.shape
    along = fit_arcs(Curve.whole(Parallel(pitch, inward - 9.0)), 2e-5)
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    along = replace(along, points=along.points @ np.array([[c, s], [-s, c]]))
    loop = led(begun_at(along, 0.0), lead, side=side, clockwise=False)
    write_gcode(path, [("contour", [Pass(-8.0, loop)])], Cutting(600, 120, 8000, 5), remarks=["c"], count=7, mm=1.0)


def failures(path, recipe):
    verdict = verify(path, milling_intent(recipe, designed(recipe)), 90, Limits(1e-4))
    return {check.name for check in verdict.checks if not check.ok}


@pytest.fixture(scope="module")
def whole():
    """A ring of which one pass cuts through."""
    return recipe_of(part="{thickness: 8, outer: 170}").replace("manufacture.depth_of_cut", 8)


MADE = {
    "none": ({"inward": 3.0}, set()),
    "the cutter's radius on the wrong side": ({"inward": -3.0}, {"contour", "motion"}),
    "no radius at all": ({"inward": 0.0}, {"contour", "motion"}),
    "a cutter one micrometre wider": ({"inward": 3.001}, {"contour", "motion"}),
    "turned": ({"inward": 3.0, "turned": 0.02}, {"contour", "motion"}),
    "a way in through the metal": ({"inward": 3.0, "side": 1}, {"gouge"}),
}


@pytest.mark.thin(6)
@pytest.mark.parametrize("fault", MADE)
def test_a_program_that_is_made_wrong(whole, tmp_path, fault):
    given, expected = MADE[fault]
    program(tmp_path / "c.ngc", whole, **given)
    assert failures(tmp_path / "c.ngc", whole) == expected


def nth(pattern, number, new):
    def changed(text):
        found = list(re.finditer(pattern, text))[number]
        return text[: found.start()] + new(found) + text[found.end() :]

    return changed


def shorter(text):
    """The path as far as it does not go round the shaft: what is milled lies beside it."""
    return re.sub(r"X(\S+)", lambda m: f"X{float(m[1]) + 200:.7f}", text)


SPOILT = {
    "an arc flipped": (nth(r"G3 (X\S+ Y\S+ I)", 12, lambda m: f"G2 {m[1]}"), {"closed"}),
    "a point moved by a micrometre": (nth(r"X(\S+)", 9, lambda m: f"X{float(m[1]) + 0.001:.7f}"), {"contour"}),
    "all moved by a micrometre": (
        lambda text: re.sub(r"X(\S+)", lambda m: f"X{float(m[1]) + 0.001:.7f}", text),
        {"contour", "motion"},
    ),
    "beside the shaft": (shorter, {"readable"}),
    "not deep enough": (lambda text: text.replace("Z-8.0000000", "Z-7.9000000"), {"depth"}),
    "fast through the metal": (lambda text: text.replace("G0 Z5", "G0 X80 Y0\nG0 Z5"), {"rapid"}),
}


@pytest.mark.thin(4)
@pytest.mark.parametrize("fault", SPOILT)
def test_a_program_that_is_spoilt(whole, tmp_path, fault):
    path = tmp_path / "c.ngc"
    program(path, whole, inward=3.0)
    change, expected = SPOILT[fault]
    before = path.read_text()
    path.write_text(change(before))
    assert path.read_text() != before
    found = failures(path, whole)
    assert expected <= found, found
