"""Milling programs: what they leave, by a simulation of its own; what the reader refuses; planted faults.

Holds: camgeo.capabilities.milling.checks, camgeo.capabilities.milling.format, camgeo.capabilities.milling.keys,
camgeo.capabilities.milling.program, kin.judge.cuts.
"""

import math
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.heavy import shapely
from support.milled import swept

from camgeo.capabilities.milling.milling import milling_intent
from camgeo.cli.main import main
from camgeo.files.gcode import places, rounding
from camgeo.machining.toolpath import depths
from camgeo.output import pipeline
from camgeo.recipe.loading import read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.expected_checks import Foreseen, foreseen
from kin.contour.nearest import signed_distance
from kin.judge.intent import Limits, Milling
from kin.judge.milling import milled
from kin.judge.verify import verify
from kin.read.errors import ReadError
from kin.read.gcode import ARC_MM, CENTRES, read_gcode

SUPPORT = "cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [3, 2]}\n"
ROLLER = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n"
DEEP = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 4, delta: {cos: {1: 1500}}}\n"
SHU_WU = """\
cam: {kind: constant-breadth, base_radius: 40, motion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]}
"""
TRIMMED = "cam: {kind: support, p: 25 + 4*cos(3*t), undercut: trim}\n"
PLAIN = "{thickness: 6, bore: 10}"
FEATURED = "{thickness: 6, bore: 10, keyway: {width: 3, depth: 1.4}, bolts: {count: 3, circle: 34, hole: 8, start: 20}}"


def recipe_of(*, cam=SUPPORT, part=PLAIN, top="", cutter=6, more="", safe=5):
    milling = f"manufacture: {{cutter: {cutter}, feed: 400, plunge: 100, spindle: 12000, depth_of_cut: 2.5, "
    body = f"{top}name: c\n{cam}part: {part}\nexport: {{files: [gcode]}}\nverify: {{angles: 90}}\n"
    return read(f"{body}{milling}safe_height: {safe}{more}}}\n".encode(), Path("c.yaml"))


def made(folder, **asked):
    """Recipe, the checks by name, and the program's path."""
    recipe = recipe_of(**asked)
    outcome = pipeline.export(recipe, folder)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    return recipe, outcome, outcome.folder / "c.ngc"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("cam", "more", "top"),
    few(
        [
            (SUPPORT, "", ""),
            (ROLLER, ", direction: conventional, allowance: 0.3", "rotation: ccw\n"),
            (SHU_WU, ", start: 100, lead_in: 2, allowance: 1.2", ""),
            (TRIMMED, ", allowance: 0.2", ""),
        ],
        2,
    ),
)
def test_what_is_left_of_a_sheet(tmp_path, cam, more, top):
    recipe, _, path = made(tmp_path, cam=cam, more=f", holes: true{more}", top=top)
    contour = designed(recipe).only_surface.contour
    t = np.concatenate([np.linspace(run.low, run.high, 4001)[:-1] for run in contour.runs])
    sign = -1.0 if top else 1.0
    bore = shapely.Point(0.0, 0.0).buffer(5.0, quad_segs=500)
    exact = shapely.Polygon(contour.sample(t).point * [1.0, sign]).difference(bore)
    bottom, left = swept(path, 3.0)
    assert bottom == -6.0
    (part,) = [one for one in left if one.intersects(exact)]
    assert part.symmetric_difference(exact).area < 2.5e-3 * exact.length
    apart = shapely.distance(exact.exterior, shapely.points(np.array(part.exterior.coords)))
    assert apart.max() < 1.6e-3
    assert len(part.interiors) == 1


def test_a_slot_is_left_and_the_program_says_so(tmp_path):
    slotted = "{thickness: 6, bore: 10, slot: {length: 14, width: 8, circle: 34}}"
    _, outcome, path = made(tmp_path, part=slotted, more=", holes: true")
    assert "(not milled: slot, not a round hole)" in path.read_text(encoding="utf-8").splitlines()
    assert "holes" not in [check["name"] for check in outcome.report["checks"] if check.get("file") == "c.ngc"]


def test_the_report_and_the_header(tmp_path):
    _, outcome, path = made(tmp_path, part=FEATURED, more=", holes: true", top="about: for (you)\n")
    (file,) = outcome.report["files"]
    assert (file["path"], file["kind"]) == ("c.ngc", "gcode")
    assert file["geometry_error"] <= 0.001
    assert file["measured_error"] <= file["geometry_error"]
    assert file["motion"]["max"] <= 0.001
    names = [check["name"] for check in outcome.report["checks"] if check.get("file") == "c.ngc"]
    assert names == [
        *(
            "cutter-reach",
            "units",
            "closed",
            "cutter",
            "arcs",
            "rapid",
            "depth",
            "direction",
            "entry",
            "gouge",
            "holes",
            "contour",
            "motion",
        ),
        *("constant-breadth", "breadth-max"),
    ]
    reach = next(check for check in outcome.report["checks"] if check["name"] == "cutter-reach")
    assert (reach["ok"], reach["detail"]) == (True, "no hollow")
    assert path.read_text().splitlines()[:16] == [
        "(c)",
        "(for [you])",
        "(units: mm)",
        "(cutter: diameter 6)",
        "(tolerance: 0.001)",
        "(zero: the shaft, top of the stock; thickness 6)",
        "(climb milling, spindle clockwise)",
        "(not milled: bore, not a round hole)",
        "G21",
        "G17 G90 G94",
        "G40 G49 G80",
        "G0 Z5.00000",
        "S12000 M3",
        "(bolt hole 1, pass 1 of 3)",
        *path.read_text().splitlines()[14:16],
    ]
    assert path.read_text().endswith("G0 Z5.00000\nM5\nM30\n")


@pytest.mark.slow
def test_the_same_bytes_twice_and_mirrored(tmp_path):
    _, _, one = made(tmp_path / "a")
    _, _, two = made(tmp_path / "b")
    assert one.read_bytes() == two.read_bytes()
    _, _, mirrored = made(tmp_path / "c", top="rotation: ccw\n")

    def places(path):
        return {(float(x), float(y)) for x, y in re.findall(r"X(\S+) Y(\S+)", path.read_text())}

    ways = {(x, -y) for x, y in places(mirrored)}
    assert len(places(one) & ways) >= len(ways) - 2, "all but the ends of the arcs of entry and exit"


def test_inches(tmp_path):
    cam = "cam: {kind: support, p: 1 + 0.08*cos(3*t)}\n"
    body = f"units: inch\nname: c\n{cam}part: {{thickness: 0.25}}\nexport: {{tolerance: 0.0001, files: [gcode]}}\n"
    body += "manufacture: {cutter: 1/4, feed: 20, plunge: 5, spindle: 9000, depth_of_cut: 0.1, safe_height: 0.2}\n"
    recipe = read(body.encode(), Path("c.yaml"))
    outcome = pipeline.export(recipe, tmp_path)
    assert outcome.ok
    text = (outcome.folder / "c.ngc").read_text()
    assert "\nG20\n" in text
    assert "(cutter: diameter 0.25)" in text
    bottom, parts = swept(outcome.folder / "c.ngc", 3.175)
    assert bottom == pytest.approx(-6.35)
    assert parts[0].area == pytest.approx(np.pi * (25.4**2 - 4 * (0.08 * 25.4) ** 2), rel=1e-4)


@pytest.mark.slow
def test_a_program_in_inches_of_a_coarse_tolerance_can_be_read(tmp_path):
    text = (
        "units: inch\ncam: {kind: disc, base_radius: 24.5, follower: {kind: roller, radius: 8, offset: -1.45},\n"
        "  motion: [{rise: 20, over: 90, law: modified-sine}, {dwell: 30},\n"
        "    {return: 20, over: 90, law: cycloidal}, {dwell: 150}]}\n"
        "part: {thickness: 10, bore: 12}\nexport: {tolerance: 0.1, files: [gcode]}\nverify: {angles: 120}\n"
        "manufacture: {cutter: 200, feed: 10, plunge: 10, spindle: 1000, depth_of_cut: 2, safe_height: 2}\n"
    )
    (tmp_path / "c.yaml").write_text(text, encoding="utf-8")
    assert main(["export", str(tmp_path / "c.yaml"), "--out", str(tmp_path / "out")]) == 0


def test_digits_follow_the_tolerance():
    assert (places(0.001, 1.0), places(0.01, 1.0), places(1e-6, 1.0), places(1.0, 1.0)) == (5, 4, 8, 3)
    assert places(0.0254, 25.4) == 5
    # the radii at both ends of an arc differ by no more than controllers take, in inches too
    assert [math.sqrt(2) * mm * 10.0 ** -places(3.0, mm) < ARC_MM for mm in (1.0, 25.4)] == [True, True]
    for tolerance in (0.001, 0.0023, 0.04):
        assert rounding(places(tolerance, 1.0), 1.0) <= 0.05 * tolerance
    assert depths(6.0, 2.5) == [-2.0, -4.0, -6.0]
    assert depths(6.0, 2.0) == [-2.0, -4.0, -6.0]
    assert depths(6.0, 8.0) == [-6.0]


def test_digits_follow_what_lies_close_together():
    assert places(0.1, 1.0) == places(0.1, 1.0, [5.0, 0.6]) == 3
    assert places(0.1, 1.0, [5.0, 0.1]) == 4
    assert places(0.001, 1.0, [0.1]) == places(0.001, 1.0)
    assert places(0.1, 25.4, [1e-6 * 25.4]) == 9


SLIGHT = {
    "feed: 400": ("feed: 0.0015", r"F0\.0015"),
    "plunge: 100": ("plunge: 0.001234567", r"F0\.00123457"),
    "spindle: 12000": ("spindle: 0.0012", r"S0\.0012 "),
    "cutter: 6": ("cutter: 0.00001", r"diameter 0\.00001\)"),
    "depth_of_cut: 2.5": ("depth_of_cut: 0.0301", r"Z-0\.0300"),
    "safe_height: 5": ("safe_height: 0.00001", r"Z0\.00001"),
    "safe_height: 5}": ("safe_height: 5, lead_in: 0.00002, allowance: 0.0001, holes: true}", r"X27\.00012"),
}


@pytest.mark.thin(8)
@pytest.mark.parametrize("usual", few(SLIGHT, 2))
@pytest.mark.parametrize("tolerance", [0.001, 0.1])
def test_slight_figures_do_not_round_away(tmp_path, usual, tolerance):
    slight, written = SLIGHT[usual]
    milling = "manufacture: {cutter: 6, feed: 400, plunge: 100, spindle: 12000, depth_of_cut: 2.5, safe_height: 5}\n"
    assert usual in milling
    body = f"name: c\n{SUPPORT}part: {PLAIN}\nexport: {{tolerance: {tolerance}, files: [gcode]}}\n"
    recipe = read(f"{body}{milling.replace(usual, slight)}".encode(), Path("c.yaml"))
    outcome = pipeline.export(recipe, tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    text = (outcome.folder / "c.ngc").read_text()
    assert re.search(written, text)
    program = read_gcode(outcome.folder / "c.ngc")
    asked = recipe.manufacture
    assert {round(move.feed, 8) for move in program.moves if not move.rapid} == {asked.feed, round(asked.plunge, 8)}
    assert max(move.end[2] for move in program.moves) == asked.safe_height
    heights = sorted({move.end[2] for move in program.moves if not move.rapid}, reverse=True)
    assert heights == pytest.approx(depths(6.0, asked.depth_of_cut), abs=0.0021 * asked.depth_of_cut)
    if asked.allowance is not None:
        ends = {move.end[:2] for move in program.moves if move.end[2] == -6.0}
        assert len(ends) > 20, "a rough path beside the fine one"


@pytest.mark.parametrize("tiny", ["feed: 0.0004", "plunge: 1e-9", "spindle: 0.0001", "safe_height: 1e-9"])
def test_figures_that_no_program_tells_are_refused(tiny):
    key = tiny.partition(":")[0]
    milling = {"cutter": 6, "feed": 400, "plunge": 100, "spindle": 12000, "depth_of_cut": 2.5, "safe_height": 5}
    given = ", ".join(f"{name}: {value}" for name, value in milling.items() if name != key)
    body = f"{SUPPORT}part: {PLAIN}\nexport: {{files: [gcode]}}\nmanufacture: {{{given}, {tiny}}}\n"
    with pytest.raises(
        RecipeErrors, match=rf"manufacture\.{key}: too little for a program, given .*; give at least"
    ) as caught:
        read(body.encode(), Path("c.yaml"))
    assert len(caught.value.errors) == 1


def test_a_part_that_is_too_thin_for_a_program_is_refused():
    with pytest.raises(
        RecipeErrors, match=r"part.thickness: too little for a program, given 1e-09 mm; give at least 1e-06"
    ):
        recipe_of(part="{thickness: 1e-9, bore: 10}")


@pytest.mark.slow
def test_metal_that_no_cutter_reaches(tmp_path):
    outcome = pipeline.check(recipe_of(cam=DEEP, cutter=20))
    assert not outcome.ok
    (reach,) = [check for check in outcome.report["checks"] if not check["ok"]]
    assert reach["name"] == "cutter-reach"
    assert reach["value"] == pytest.approx(3.446656, abs=1e-6)
    assert 21 < reach["at_deg"] < 42, "the first of four hollows that are alike"
    assert "a cutter 10.1877 mm across would reach all" in reach["detail"]
    assert outcome.report["files"] == []
    _, outcome, _ = made(tmp_path, cam=DEEP, cutter=20, more=", unreached: 3.5")
    checks = {check["name"]: check for check in outcome.report["checks"]}
    assert checks["cutter-reach"]["ok"]
    assert "3.45 mm outside" in checks["contour"]["detail"]
    assert checks["contour"]["value"] < 0.001
    assert "motion" not in checks, "reported, not judged"


HUBBED = "{thickness: 6, bore: 10, hub: {diameter: 20, height: 12%s}, chamfer: 0.5, mark: {as: engrave}, "
HUBBED += "set_screw: {diameter: 3}, dowel: {circle: 34, hole: 7, at: 90}}"


@pytest.mark.parametrize("safe", [5, 12])
def test_rapid_moves_below_the_top_of_a_hub_are_refused(safe):
    with pytest.raises(RecipeErrors) as caught:
        recipe_of(part=HUBBED % "", more=", holes: true", safe=safe)
    (slip,) = caught.value.errors
    what = f"manufacture.safe_height: not above the hub's top, given {safe} mm; give more than 12 mm"
    assert what in str(slip)


def test_a_depth_of_cut_without_end_of_passes_is_refused():
    recipe = recipe_of()
    slight = replace(recipe, manufacture=replace(recipe.manufacture, depth_of_cut=1e-5))
    with pytest.raises(
        RecipeErrors, match=r"depth_of_cut: makes \d+ passes, more than 2000, given 1e-05 mm; give at least"
    ):
        pipeline.check(slight)


@pytest.mark.thin(3)
@pytest.mark.parametrize(("side", "safe"), [("top", 13), ("both", 12.5), ("bottom", 5)])
def test_a_hub_stays_and_what_is_not_milled_is_named(tmp_path, side, safe):
    part = HUBBED % f", side: {side}"
    recipe, outcome, path = made(tmp_path, part=part, more=", holes: true", safe=safe)
    named = [line for line in path.read_text().splitlines() if line.startswith("(not milled")]
    assert [line[13:].partition(",")[0] for line in named] == ["mark", "bore", "hub", "set screw", "chamfer"]
    assert "(not milled: bore, within the hub, which is higher than the disc)" in named
    skipped = {item["what"]: item["why"] for item in outcome.report["skipped"]}
    assert skipped["hub"].startswith("not milled: the stock comes with it")
    assert {"mark", "bore", "chamfer", "set screw"} <= skipped.keys()
    low = [move for move in read_gcode(path).moves if min(move.start[2], move.end[2]) < 12.0]
    near = [np.hypot(*move.end[:2]) for move in low]
    assert min(near) > 10.0 + 3.0, "the dowel's hole is beside the hub"
    told = [check["name"] for check in outcome.report["checks"] if check.get("file") == "c.ngc"]
    assert "holes" in told
    assert "bore" not in told
    assert sorted(told) == sorted(one.name for one in foreseen(recipe) if one.file == "c.ngc")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "check"),
    [
        ("(contour, pass 1", "G0 X0 Y0 Z5\n(contour, pass 1", "rapid"),
        ("(contour, pass 1", "G1 Z5 F100\nG1 X0 Y0\nG1 Z13\n(contour, pass 1", "gouge"),
    ],
)
def test_moves_into_a_hub_are_caught(tmp_path, old, new, check):
    recipe, _, path = made(tmp_path, part=HUBBED % "", more=", holes: true", safe=13)
    text = path.read_text()
    path.write_text(text.replace(old, new, 1))
    verdict = verify(path, milling_intent(recipe, designed(recipe)), 12, Limits(0.001))
    (bad,) = [one for one in verdict.checks if not one.ok]
    assert bad.name == check
    assert "into the hub" in bad.detail


# --- planted faults ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    recipe, _, path = made(tmp_path_factory.mktemp("sound"), more=", holes: true, allowance: 0.4")
    return recipe, path.read_text()


def failures(program, folder, change):
    recipe, text = program
    path = folder / "c.ngc"
    path.write_text(change(text))
    assert path.read_text() != text
    verdict = verify(path, milling_intent(recipe, designed(recipe)), 90, Limits(0.001))
    return {check.name for check in verdict.checks if not check.ok}, verdict


def last_pass(text):
    """The text before the last pass, and that pass."""
    place = text.rindex("(contour, pass")
    return text[:place], text[place:]


def in_last_pass(change):
    def changed(text):
        before, after = last_pass(text)
        return before + change(after)

    return changed


def nth(pattern, number, new):
    """Replace the match of that number."""

    def changed(text):
        found = list(re.finditer(pattern, text))[number]
        return text[: found.start()] + new(found) + text[found.end() :]

    return changed


def moved(by):
    """The end of the eighth arc of the last pass moved along x, the centre of the next one with it."""

    def changed(text):
        return nth(r"X(\S+)", 8, lambda m: f"X{float(m[1]) + by:.5f}")(text)

    return in_last_pass(changed)


@pytest.mark.slow
def test_a_pass_a_micron_beside_another_costs_no_more(program, tmp_path, monkeypatch):
    """A path that runs beside the edge is measured piece against piece, and is not cut into ever smaller ones."""
    asked = []

    def counted(chain, points):
        asked.append(len(points))
        return signed_distance(chain, points)

    monkeypatch.setattr("kin.contour.least_distance.signed_distance", counted)

    def shifted(by):  # a centre of the first pass moved, within what controls take
        return nth(r"I(\S+) J", 12, lambda m: f"I{float(m[1]) + by:.5f} J")

    assert failures(program, tmp_path, shifted(-0.0004))[0] == set()
    gouges = {
        by: next(c for c in failures(program, tmp_path, shifted(by))[1].checks if c.name == "gouge").value
        for by in (0.0004, -0.0004)
    }
    assert max(asked) < 1000
    assert max(gouges.values()) < 0.0004


def straight_in(text):
    return nth(r"G3 (X\S+ Y\S+) I\S+ J\S+", 0, lambda m: f"G1 {m[1]}")(text)


def into_the_metal_and_back(match):
    """A cut a tenth of a millimetre deep, of moves each of which is shorter than what is left out of a parallel."""
    x, y = float(match[1]), float(match[2])
    deep = [1.0 - 4e-5 * k / math.hypot(x, y) for k in (*range(1, 2500), *range(2499, -1, -1))]
    return match[0] + "".join(f"G1 X{share * x:.5f} Y{share * y:.5f}\n" for share in deep)


FAULTS = {
    "a cut of tiny moves": (
        in_last_pass(nth(r"G2 X(\S+) Y(\S+) .*\n", 6, into_the_metal_and_back)),
        {"closed", "gouge"},
    ),
    "an arc's direction": (in_last_pass(nth(r"G2 (X\S+ Y\S+ I)", 6, lambda m: f"G3 {m[1]}")), {"contour", "closed"}),
    "an end moved by a hundredth": (moved(0.01), {"readable", "contour"}),
    "all x moved by a hundredth": (
        lambda text: re.sub(r"X(\S+)", lambda m: f"X{float(m[1]) + 0.01:.5f}", text),
        {"contour", "motion", "bore"},
    ),
    "a unit": (lambda text: text.replace("G21", "G20"), {"units", "contour", "cutter", "depth"}),
    "a missing pass": (
        lambda text: re.sub(r"\(contour, pass 2 of 4\).*?(?=\(contour, pass 3)", "", text, flags=re.DOTALL),
        {"depth"},
    ),
    "a pass elsewhere": (
        lambda text: re.sub(
            r"\(contour, pass 2 of 4\).*?(?=\(contour, pass 3)",
            "G0 X60 Y0\nG1 Z-4 F100\nG1 X61\nG1 Y1\nG1 X60\nG1 Y0\nG0 Z5\n",
            text,
            flags=re.DOTALL,
        ),
        {"depth", "bore"},
    ),
    "a last pass too high": (in_last_pass(lambda text: text.replace("Z-6.00000", "Z-5.90000")), {"depth"}),
    "no last pass": (lambda text: last_pass(text)[0] + "M5\nM30\n", {"contour", "motion"}),
    "a rapid move through the part": (
        in_last_pass(lambda text: text.replace("G0 Z5.00000", "G0 X0.00000 Y0.00000\nG0 Z5.00000")),
        {"rapid"},
    ),
    "a rapid move down": (in_last_pass(lambda text: text.replace("G1 Z-6", "G0 Z-6")), {"rapid"}),
    "a way in through the part": (
        in_last_pass(lambda text: straight_in(nth(r"G0 X\S+ Y\S+", 0, lambda _: "G0 X0 Y0")(text))),
        {"gouge", "entry"},
    ),
    "a way in on the wrong side of its circle": (in_last_pass(nth("G3 X", 0, lambda _: "G2 X")), {"entry"}),
    "a pass through the part": (
        lambda text: text.replace(
            "(contour, pass 1 of 4)", "G0 X0 Y0\nG1 Z-1 F100\nG1 X5\nG1 Y5\nG1 X0\nG1 Y0\nG0 Z5.0"
        ),
        {"gouge", "direction", "bore", "depth"},
    ),
    "another cutter named": (lambda text: text.replace("diameter 6)", "diameter 6.1)"), {"cutter"}),
}


@pytest.mark.thin(12)
@pytest.mark.parametrize("fault", FAULTS)
def test_planted_faults(program, tmp_path, fault):
    change, expected = FAULTS[fault]
    found, verdict = failures(program, tmp_path, change)
    assert found, fault
    assert found & expected, (fault, found, [check for check in verdict.checks if not check.ok])


def test_a_program_for_another_cutter_or_direction(program, tmp_path):
    _, text = program
    (tmp_path / "c.ngc").write_text(text)
    other = recipe_of(
        cutter=6.02,
        more=", holes: true, allowance: 0.4, direction: conventional",
    )
    verdict = verify(tmp_path / "c.ngc", milling_intent(other, designed(other)), 90, Limits(0.001))
    assert {"cutter", "direction", "contour", "motion"} <= {check.name for check in verdict.checks if not check.ok}


def test_from_the_command_line(program, tmp_path, capsys):
    _, text = program
    body = "name: c\n" + SUPPORT + f"part: {PLAIN}\nexport: {{files: [gcode]}}\nverify: {{angles: 90}}\n"
    body += "manufacture: {cutter: 6, feed: 400, plunge: 100, spindle: 12000, depth_of_cut: 2.5, safe_height: 5, "
    (tmp_path / "c.yaml").write_text(body + "holes: true, allowance: 0.4}\n")
    (tmp_path / "c.ngc").write_text(text)
    assert main(["verify", str(tmp_path / "c.yaml"), str(tmp_path / "c.ngc")]) == 0
    (tmp_path / "c.ngc").write_text(text.replace("Z-6.00000", "Z-5.00000"))
    assert main(["verify", str(tmp_path / "c.yaml"), str(tmp_path / "c.ngc")]) == 1
    assert "depth" in capsys.readouterr().out
    (tmp_path / "bare.yaml").write_text("name: c\n" + SUPPORT + f"part: {PLAIN}\n")
    assert main(["verify", str(tmp_path / "bare.yaml"), str(tmp_path / "c.ngc")]) == 2
    assert "manufacture" in capsys.readouterr().err


# --- the reader -------------------------------------------------------------------------------------------------------

HEAD = "G21 G17 G90 G94\nG0 Z5\nS9000 M3\nG0 X0 Y0\nG1 Z-1 F100\n"
TAIL = "G0 Z5\nM5\nM30\n"


def reading(folder, body):
    path = folder / "x.ngc"
    path.write_text(body)
    return read_gcode(path)


def test_modes_words_and_comments(tmp_path):
    body = "%\n(first) n10 g20 g90\nN20 G17G94 ; second\nG0 z.5\nS1e0 M3\n".replace("1e0", "1")
    body += "g0x1y2\nG1 Z-1 F10\nx2\nG91 Y-1\nG3 X1 I.5\nG90 G0 Z1\nM2\n%\n"
    program = reading(tmp_path, body)
    assert program.units_mm == 25.4
    assert program.comments == ("first", "second")
    ends = [tuple(round(v / 25.4, 9) for v in move.end) for move in program.moves]
    assert ends == [(1, 2, 0.5), (1, 2, -1), (2, 2, -1), (2, 1, -1), (3, 1, -1), (3, 1, 1)]
    arc = program.moves[4]
    assert arc.sweep == pytest.approx(np.pi)
    assert arc.centre == pytest.approx((2.5 * 25.4, 25.4))
    assert [move.rapid for move in program.moves] == [True, False, False, False, False, True]


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (HEAD + "G1 X10\nG41 D1\n" + TAIL, "line 7: G41 is not read"),
        (HEAD + "O100 CALL\n" + TAIL, "line 6: CALL is not read"),
        (HEAD + "#1=5\n" + TAIL, "line 6: #1=5 is not read"),
        (HEAD + "G2 X10 R5\n" + TAIL, f"line 6: R5 is not read, an arc by its radius; {CENTRES}"),
        (HEAD + "T1 M6\n" + TAIL, "line 6: M6 is not read"),
        (HEAD + "G2 X10 Y0 I4 J0\n" + TAIL, "line 6: the ends of the arc lie 4 and 6 mm from its centre"),
        (HEAD + "G2 X10 Y0\n" + TAIL, f"line 6: an arc has no centre I, J; {CENTRES}"),
        (HEAD + "G1 X10 I5\n" + TAIL, "line 6: a straight move has a centre"),
        (HEAD + "G2 X10 Z-2 I5\n" + TAIL, "line 6: an arc that climbs is not read"),
        (HEAD + "G0 G1 X3\n" + TAIL, "line 6: two words set the motion"),
        (HEAD + "G1 X3 X4\n" + TAIL, "line 6: X stands twice"),
        (HEAD + "G20\n" + TAIL, "line 6: the unit changes within the program"),
        (HEAD + "G1 X10\nG0 Z5\nM5\n", "the program does not end: there is no M30 or M2"),
        (HEAD + TAIL + "G0 X3\n", "line 9: stands after the end of the program"),
        ("G90\nG0 X3\nM30\n", "line 2: a length stands before G20 or G21"),
        ("G21\nG0 X3\nM30\n", "line 2: a coordinate stands before G0 to G3, and G90 or G91"),
        ("G21 G90\nG0 X3 Y0 Z5\nG1 X4\nM30\n", "line 3: a feed move without a feed F and a turning spindle M3"),
        ("G21 G90 M3\nM30\n", "line 1: M3 without a speed S"),
        ("G21 G91\nG0 X3\nM30\n", "line 2: X moves from an unknown place"),
        ("G21 G90 S1 M3 F10\nG1 X3\nM30\n", "line 2: a feed move from an unknown place"),
        ("G21 G90\nG0 X1e9\nM30\n", "line 2: E9 is not read"),
        ("M30\n", "the program makes no move"),
    ],
)
def test_what_is_not_read(tmp_path, body, message):
    with pytest.raises(ReadError) as caught:
        reading(tmp_path, body)
    assert caught.value.message == message


MILLING = Milling(3.0, 1.0, 2.0)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (HEAD + "G1 X10\nG1 Y10\n" + TAIL, "line 6: the path from (0, 0) does not close"),
        (HEAD + TAIL, "line 5 goes down where nothing is cut, which is not read"),
        (HEAD + "G1 X10 Z-2\n" + TAIL, "line 6 cuts along a slope, which is not read"),
        ("G21 G90\nG0 X0 Y0 Z5\nG0 X1\nM30\n", "the program cuts nothing below the top of the stock"),
    ],
)
def test_what_is_no_contour(tmp_path, body, message):
    with pytest.raises(ReadError) as caught:
        milled(reading(tmp_path, body), MILLING, 0.001)
    assert caught.value.message == message


def test_a_path_tighter_than_the_cutter(tmp_path):
    body = HEAD + "G3 X0 Y0 I2 J0\n" + TAIL
    with pytest.raises(ReadError, match=r"the cutter's path from line 6: the curve turns too sharply"):
        milled(reading(tmp_path, body), MILLING, 0.001)
    found = milled(reading(tmp_path, body.replace("I2", "I-20")), MILLING, 0.001)
    assert found.contour.area == pytest.approx(np.pi * 17.0**2, rel=1e-9)
    assert {check.name for check in found.checks if not check.ok} == {"direction"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("part", "more"),
    few([(PLAIN, ", holes: true"), (PLAIN, ""), (FEATURED, ", holes: true"), (FEATURED, ", layer: true")], 2),
)
def test_the_checks_are_foreseen(part, more):
    recipe = recipe_of(part=part, more=more)
    files = tuple(
        read(b"cam: {kind: support, p: 9}\nexport: {files: [dxf, {dxf: {kerf: 0.1}}]}", "c.yaml").export.files
    )
    recipe = replace(recipe, export=replace(recipe.export, files=(*recipe.export.files, *files)))
    checks = [(check["name"], check.get("file")) for check in pipeline.check(recipe).report["checks"]]
    assert sorted(map(str, foreseen(recipe))) == sorted(str(Foreseen(*check)) for check in checks)


@pytest.mark.skipif(shutil.which("rs274") is None, reason="LinuxCNC's interpreter rs274 is not installed")
@pytest.mark.parametrize("more", ["", ", holes: true, allowance: 0.3, direction: conventional"])
@pytest.mark.parametrize("units", ["", "units: inch\n"])
def test_linuxcnc_reads_the_same_moves(tmp_path, units, more):
    cam = "cam: {kind: support, p: 1 + 0.08*cos(3*t)}\n" if units else ROLLER
    part, cutter = ("{thickness: 6, bore: 0.9}", 0.7) if units else (PLAIN, 6)
    more = more.replace("0.3", "0.1") if units else more
    _, _, path = made(tmp_path, cam=cam, part=part, cutter=cutter, top=units, more=more)
    program = read_gcode(path)
    (tmp_path / "tool.tbl").write_text("")
    (tmp_path / "var").write_text("5161 0\n")
    command = [shutil.which("rs274"), "-t", "tool.tbl", "-v", "var", "-g", str(path)]
    told = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    theirs = []
    for name, numbers in re.findall(r"(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED)\((.*?)\)", told):
        row = [float(word) for word in numbers.split(",")]
        theirs.append((name, row[:3]) if name != "ARC_FEED" else (name, [*row[:2], row[5], *row[2:4], np.sign(row[4])]))
    ours = []
    for move in program.moves:
        name = "STRAIGHT_TRAVERSE" if move.rapid else "STRAIGHT_FEED" if move.centre is None else "ARC_FEED"
        bent = [] if move.centre is None else [*np.array(move.centre) / program.units_mm, np.sign(move.sweep)]
        ours.append((name, [*np.array(move.end) / program.units_mm, *bent]))
    assert [name for name, _ in theirs[1:]] == [name for name, _ in ours], "theirs begins with the way to a safe height"
    for (_, one), (_, other) in zip(theirs[1:], ours, strict=True):
        assert one == pytest.approx(other, abs=6e-5), "it tells four decimal places"


@settings(max_examples=examples(40), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_program_with_anything_changed_is_told_or_refused(program, tmp_path, data):
    recipe, text = program
    lines = text.split("\n")
    i = data.draw(st.integers(0, len(lines) - 1))
    match data.draw(st.integers(0, 3)):
        case 0:
            del lines[i]
        case 1:
            lines.insert(i, data.draw(st.sampled_from(lines)))
        case 2:
            lines[i] = data.draw(st.text(st.characters(max_codepoint=126), max_size=12))
        case _:
            value = data.draw(st.floats(-60, 60))
            lines[i] = re.sub(r"([XYZIJ])-?[0-9.]+", lambda m: f"{m[1]}{value:.5f}", lines[i], count=1)
    path = tmp_path / "c.ngc"
    path.write_text("\n".join(lines))
    verdict = verify(path, milling_intent(recipe, designed(recipe)), 12, Limits(0.001))
    assert verdict.checks
    assert all(check.ok or check.detail or check.value is not None for check in verdict.checks)
