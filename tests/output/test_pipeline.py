"""Every shipped recipe from its text to judged files, and what a run does when something is wrong.

Holds: camgeo.output.job, camgeo.output.skipped, camgeo.registry.root, camgeo.recipe.export.
"""

from __future__ import annotations

import hashlib
import json
import math
import re
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from importlib.util import find_spec
from typing import TYPE_CHECKING
from unittest import mock

import numpy as np
import pytest
from support.cases import few
from support.heavy import ezdxf
from support.places import SHIPPED as RECIPES

from camgeo.common.clock import Clock
from camgeo.output import pipeline
from camgeo.recipe.export import FileRequest
from camgeo.recipe.loading import load, read
from camgeo.report.document import finite
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from camgeo.synthesis.expected_checks import foreseen
from kin.numeric.limits import SPLINE_ERROR

if TYPE_CHECKING:
    from pathlib import Path

UNDERCUT = b"""\
cam: {kind: support, p: 10 + 2*cos(3*t)%s}
part: {thickness: 5}
export: {tolerance: 0.001, files: [dxf, stl]}
"""


def names(report: dict) -> list[str]:
    return [check["name"] for check in report["checks"]]


def failed(report: dict) -> set[str]:
    return {check["name"] for check in report["checks"] if not check["ok"]}


def test_there_are_recipes() -> None:
    assert len(RECIPES) >= 17


@pytest.mark.thin(36)
@pytest.mark.parametrize("path", few(RECIPES, 3, first=1), ids=lambda path: path.stem)
def test_every_shipped_recipe_exports_and_passes(path: Path, tmp_path: Path) -> None:
    recipe = load(path)
    if any(file.kind == "step" for file in recipe.export.files):
        pytest.importorskip("OCP", reason="a STEP is written by the extra `step`")
    outcome = pipeline.export(recipe, tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    folder = tmp_path / recipe.name
    assert outcome.folder == folder
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert report == finite(outcome.report)  # what is infinite is null
    assert sorted(entry.name for entry in folder.iterdir()) == sorted(
        ["report.json", *(file["path"] for file in report["files"])]
    )
    bent = "pitch-radius" if recipe.cam.touch.radius else "radius-of-curvature"
    motion = {"motion"} if recipe.cam.undercut == "refuse" else set()  # a trimmed contour has no limit of it
    assert {bent, "undercut-local", "contour", "wall"} | motion <= set(names(report))
    several = {"surface", "sense"}  # surfaces, and limits from both sides, have a check each, which is foreseen as one
    at_lifts = {"limit:duration": "detail"}  # a limit at several lifts has a check for each, which is in words
    each = Counter(
        (check["name"], check.get("file"), *map(check.get, sorted(several)), check.get(at_lifts.get(check["name"])))
        for check in report["checks"]
    )
    of_all = any(request.variant for request in recipe.export.files)
    assert of_all or set(each.values()) == {1}
    made = Counter({(name, file) for name, file, *_ in each})
    told = Counter((item.name, item.file) for item in foreseen(recipe))
    if of_all:  # how many bodies there are is not foreseen
        assert not told - made
    else:
        assert {name for name, _ in told - made} == {"motion"} - motion
        assert not made - told
    for file in report["files"]:
        data = (folder / file["path"]).read_bytes()
        assert file["bytes"] == len(data)
        assert file["sha256"] == hashlib.sha256(data).hexdigest()
        if file["kind"] in {"csv", "glb", "html"} or file.get("body") not in {None, "assembly"}:
            continue  # no contour of the cam
        assert 0.0 <= file["geometry_error"] <= file["tolerance"]
        # The judge measures no more than was proved, but for rounding.
        seen = SPLINE_ERROR if file.get("as") == "spline" else 1e-11  # splines are measured as arcs
        for surface in file.get("surfaces", [file]):
            assert surface["measured_error"] <= file["geometry_error"] * (1 + 1e-9) + seen
            motion = surface["motion"]
            assert motion["rms"] <= motion["max"]
            assert 0.0 <= motion["at_deg"] < 360.0


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-9, 1e-10])
def test_rollers_feel_a_spline_as_finely_as_it_is_drawn(tolerance: float) -> None:
    text = "{kind: double-roller, ratio: 2, arm: 55, roller_radius: 7, delta: {cos: {1: 130}, sin: {1: 60, 3: -14}}}"
    files = f"{{tolerance: {tolerance}, files: [{{dxf: {{as: spline}}}}]}}"
    outcome = pipeline.check(read(f"cam: {text}\nexport: {files}\nverify: {{angles: 360}}\n".encode(), "fine.yaml"))
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    motion = next(check for check in outcome.report["checks"] if check["name"] == "motion")
    assert motion["value"] <= 2.0 * motion["limit"]


@pytest.mark.slow
def test_the_proof_leaves_less_than_a_fine_tolerance_permits() -> None:
    """The file is written, so that it must be judged: over 82,000 stretches stay open within a tolerance of 1e-10 mm.

    On an arm of 60 mm it permits at least 1e-10/60 rad.
    """
    text = "{kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}"
    files = "{tolerance: 1e-10, files: [{dxf: {as: spline}}]}"
    outcome = pipeline.check(read(f"cam: {text}\nexport: {files}\n".encode(), "fine.yaml"))
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    motion = outcome.report["files"][0]["motion"]
    assert motion["remainder"] <= 0.1 * math.degrees(1e-10 / 60.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arc", "tolerance"),
    [("3, arm: 29.5775, arc: {radius: 54.9153}", 2.172e-4), ("7/5, arm: 34.7435, arc: {radius: 55.2848}", 5.166e-4)],
)
def test_a_pair_whose_breaks_are_off_by_rounding_is_judged(arc: str, tolerance: float) -> None:
    export = f"{{tolerance: {tolerance}, files: [{{dxf: {{as: spline}}}}]}}"
    text = f"cam: {{kind: flat-pair, ratio: {arc}}}\nexport: {export}\n"
    outcome = pipeline.check(read(text.encode(), "pair.yaml"))
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]


@pytest.mark.slow
@pytest.mark.parametrize("name", few(["as-figure-2a", "w-booth", "reuleaux-nine"], 3))
def test_the_same_recipe_gives_the_same_bytes(name: str, tmp_path: Path) -> None:
    recipe = load(RECIPES[0].with_name(f"{name}.yaml"))
    first = pipeline.export(recipe, tmp_path / "a")
    second = pipeline.export(recipe, tmp_path / "b")
    assert first.folder is not None
    assert second.folder is not None
    files = [entry for entry in first.folder.iterdir() if entry.name != "report.json"]
    assert files
    for entry in files:
        assert entry.read_bytes() == (second.folder / entry.name).read_bytes()
    for report in (first.report, second.report):
        report.pop("stages")
    assert first.report == second.report


@pytest.mark.slow
def test_counter_clockwise_mirrors_drawing_and_keeps_motion(tmp_path: Path) -> None:
    recipe = load(RECIPES[0].with_name("as-figure-2d.yaml"))
    other = replace(recipe, rotation="ccw", name="other")
    here, there = (pipeline.export(r, tmp_path) for r in (recipe, other))
    assert here.ok
    assert there.ok
    table = [(tmp_path / name / f"{name}.csv").read_bytes() for name in (recipe.name, "other")]
    assert table[0] == table[1]
    # a file drawn for the one rotation is wrong for the other
    report = pipeline.judge_files(other, [tmp_path / recipe.name / f"{recipe.name}.dxf"])
    assert {"contour", "motion"} <= failed(report)


def test_undercut_is_refused_with_angle_depth_and_remedy(tmp_path: Path) -> None:
    recipe = read(UNDERCUT % b"", "sharp.yaml")
    outcome = pipeline.export(recipe, tmp_path)
    assert not outcome.ok
    found = {check["name"]: check for check in outcome.report["checks"]}
    assert found["radius-of-curvature"]["value"] == pytest.approx(-6.0, abs=1e-9)
    assert not found["undercut-local"]["ok"]
    assert found["undercut-local"]["value"] > 0.1
    assert "a p larger by more than 6 would have no undercut" in found["undercut-local"]["detail"]
    assert not (tmp_path / "sharp").exists()
    rejected = tmp_path / "sharp.rejected"
    assert json.loads((rejected / "report.json").read_text(encoding="utf-8"))["ok"] is False
    assert [entry.name for entry in rejected.iterdir()] == ["report.json"]


@pytest.mark.slow
def test_undercut_trimmed_on_request_tells_the_lost_motion(tmp_path: Path) -> None:
    recipe = read(UNDERCUT % b", undercut: trim", "sharp.yaml")
    outcome = pipeline.export(recipe, tmp_path)
    found = {check["name"]: check for check in outcome.report["checks"] if "file" not in check}
    assert "trimmed" in found["undercut-local"]["detail"]
    depth = found["undercut-local"]["value"]
    for file in outcome.report["files"]:
        # what the follower drops by is what the trimmed metal no longer gives
        assert file["motion"]["max"] == pytest.approx(depth, abs=0.003)
        assert file["geometry_error"] <= 0.001
    assert outcome.ok


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b"cam: {kind: support, p: 25 + t}", "p does not close: p is off by 6.28318531 mm"),
        (b"cam: {kind: support, p: 25 + sin(t/2)}", "p does not close"),
        (b"cam: {kind: support, p: 25 + log(cos(t))}", "does not exist"),
        (
            b"cam: {kind: constant-breadth, base_radius: 9, motion: [{rise: 9, over: 180, law: {polynomial: [0, 1]}}]}",
            "does not join over the half turn",
        ),
        (b"cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 2000}}}", "below 1"),
    ],
)
def test_what_cannot_be_is_refused_with_place_and_reason(text: bytes, words: str, tmp_path: Path) -> None:
    recipe = read(text + b"\npart: {thickness: 5}\nexport: {tolerance: 0.001, files: [dxf]}\n", "bad.yaml")
    with pytest.raises(RecipeErrors) as caught:
        pipeline.export(recipe, tmp_path)
    (error,) = caught.value.errors
    assert words in error.problem
    assert error.line == 1
    assert error.path.startswith("cam.")
    assert not (tmp_path / "bad").exists()


def test_tolerance_that_single_precision_cannot_hold_is_refused_with_the_figure(tmp_path: Path) -> None:
    recipe = load(RECIPES[0].with_name("shu-wu.yaml"))
    recipe = replace(recipe, export=replace(recipe.export, tolerance=1e-6))
    with pytest.raises(RecipeErrors, match="single precision") as caught:
        pipeline.export(recipe, tmp_path)
    assert "at least" in str(caught.value)
    assert not (tmp_path / "shu-wu").exists()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["stl", "dxf"])
def test_a_file_alone_imports_nothing_of_what_it_does_not_ask_for(kind: str, tmp_path: Path) -> None:
    code = (
        "import sys; from pathlib import Path; from dataclasses import replace\n"
        "from camgeo.output import pipeline; from camgeo.recipe.loading import load\n"
        f"r = load({str(RECIPES[0])!r})\n"
        f"r = replace(r, export=replace(r.export, files=tuple(f for f in r.export.files if f.kind == {kind!r})))\n"
        f"assert pipeline.export(r, Path({str(tmp_path)!r})).ok\n"
        "heavy = {'shapely', 'trimesh', 'scipy', 'matplotlib', 'pydantic', 'multiprocessing'}\n"
        # the triangles of a part with a bore are clipped by manifold3d
        f"heavy |= {{'ezdxf', 'xml'}} if {kind!r} == 'stl' else {{'manifold3d'}}\n"
        "heavy |= {'OCP', 'zipfile'}\n"
        "heavy |= {f'kin.{name}' for name in ('mechanism', 'dynamics', 'linkage.mechanism', 'judge.milling')}\n"
        "heavy |= {f'kin.read.{kind}' for kind in ('mesh.threemf', 'gcode', 'step.step', 'drawing.svg')}\n"
        "heavy |= {f'camgeo.{name}' for name in ('capabilities.mechanism.making', 'report.page')}\n"
        # every run reads the labels of capabilities; their modules are for recipes that use them
        "heavy |= {name for name in sys.modules if name.startswith('camgeo.capabilities.') and name.count('.') > 2}\n"
        f"heavy.add('camgeo.output.drawing' if {kind!r} == 'stl' else 'camgeo.output.solid')\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


UNUSED = {
    "camgeo": "cli.laws cli.report cli.watch machining report.page schema.edit",
    "camgeo.formats": "glb ply step tables.contacts tables.polar",
    "camgeo.cams": "constant_diameter disc disc_cams double_roller flat_pair guided pairs sizing support",
    "camgeo.part": "largest_holes",
    "camgeo.synthesis": "linkage motion_table view",
    "kin": "mechanism dynamics follower.faces_on_arm follower.roller judge.milling law.transmission linkage",
    "kin.law": "formula.formula frame_swing reuleaux routes transmission_law",
    "kin.read": "drawing.svg gcode mesh.threemf step",
}
OF_DXF = "camgeo.fit.arcs camgeo.output.drawing ezdxf kin.read.drawing.dxf"
OF_STL = "camgeo.fit.polygon camgeo.output.solid kin.judge.volume kin.read.mesh.stl"


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "own", "other"), [("stl", OF_STL, OF_DXF), ("dxf", OF_DXF, OF_STL)])
def test_a_command_imports_its_scene_alone(kind: str, own: str, other: str, tmp_path: Path) -> None:
    recipe = RECIPES[0].with_name("shu-wu.yaml")
    words = ["export", str(recipe), "--only", kind, "--out", str(tmp_path)]
    code = f"import sys; from camgeo.cli.main import main; assert main({words!r}) == 0; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    modules = set(done.stdout.split())
    unused = {f"{room}.{name}" for room, names in UNUSED.items() for name in names.split()}
    assert all(find_spec(name) for name in unused)
    assert {*own.split(), "camgeo.cams.constant_breadth"} <= modules
    assert not modules & {*unused, *other.split()}
    assert [name for name in modules if name.startswith("camgeo.capabilities.") and name.count(".") > 2] == []


def test_no_second_counts_twice() -> None:
    heard: list[str] = []
    clock = Clock(heard.append)
    with mock.patch("time.perf_counter", side_effect=[0.0, 1.0, 3.0, 4.0, 8.0, 10.0]), clock.stage("outer"):
        with clock.stage("first"):
            pass
        with clock.stage("second"):
            pass
    assert heard == ["outer", "first", "second"]
    assert clock.stages == [("first", 2.0), ("second", 4.0), ("outer", 4.0)]


def test_skipped_stages_are_listed_with_the_reason(tmp_path: Path) -> None:
    recipe = load(RECIPES[0].with_name("shu-wu.yaml"))
    recipe = replace(recipe, part=replace(recipe.part, bore=None))
    report = pipeline.export(recipe, tmp_path, only=("dxf",)).report
    skipped = {item["what"]: item["why"] for item in report["skipped"]}
    assert skipped["stl"] == "left out by --only"
    assert "bore" in skipped
    assert not any(stage["name"].endswith("stl") for stage in report["stages"])


def test_a_bore_through_the_contour_is_a_failed_check_and_no_file(tmp_path: Path) -> None:
    recipe = load(RECIPES[0].with_name("shu-wu.yaml"))
    recipe = replace(recipe, part=replace(recipe.part, bore=90.0))
    outcome = pipeline.export(recipe, tmp_path)
    assert failed(outcome.report) == {"wall"}
    assert outcome.report["files"] == []
    assert outcome.report["checks"][-1]["detail"] == "bore and contour"


def test_a_shaft_beside_the_contour_is_told_as_that(tmp_path: Path) -> None:
    text = b"cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [100, 0]}\npart: {bore: 10}\n"
    outcome = pipeline.export(read(text, "beside.yaml"), tmp_path)
    assert failed(outcome.report) == {"wall"}
    assert outcome.report["checks"][-1]["detail"] == "the shaft lies outside the contour"


@pytest.mark.slow
def test_a_file_is_verified_to_its_own_tolerance(tmp_path: Path) -> None:
    recipe = load(RECIPES[0].with_name("as-figure-2b.yaml"))
    assert recipe.export.files[0].tolerance == pytest.approx(0.005)
    assert pipeline.export(recipe, tmp_path).ok
    folder = tmp_path / recipe.name
    report = pipeline.judge_files(recipe, [folder / f"{recipe.name}.dxf", folder / f"{recipe.name}.stl"])
    assert report["ok"]
    assert [file["tolerance"] for file in report["files"]] == pytest.approx([0.005, 0.01])


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", ["reuleaux", "reuleaux-nine", "as-figure-13-1", "w-figure-9"])
def test_the_circle_drawn_for_reference_is_the_largest_about_the_shaft(name: str, tmp_path: Path) -> None:
    recipe = load(RECIPES[0].parent / f"{name}.yaml")
    drawing = replace(recipe.export, files=(FileRequest("dxf", "arcs"),))
    outcome = pipeline.export(replace(recipe, export=drawing), tmp_path)
    assert outcome.folder is not None
    shapes = ezdxf.readfile(outcome.folder / f"{recipe.name}.dxf").query('CIRCLE[layer=="REFERENCE"]')
    base = designed(recipe).only_surface.surface.base
    points = base.sample(np.linspace(base.cells.low.min(), base.cells.high.max(), 100_001)).point
    assert shapes[0].dxf.radius * recipe.mm == pytest.approx(np.hypot(*points.T).min(), abs=1e-6)


@pytest.mark.slow
def test_a_file_of_the_recipes_own_name_is_judged_by_its_own_tolerance(tmp_path: Path) -> None:
    files = b"[dxf, {stl: {tolerance: 0.02}}]"
    recipe = read(UNDERCUT.replace(b"10 + ", b"25 + ").replace(b"[dxf, stl]", files) % b"", "own.yaml")
    folder = pipeline.export(recipe, tmp_path).folder
    assert folder is not None
    other = folder.rename(tmp_path / "sent") / "other.stl"
    other.write_bytes((other.parent / "own.stl").read_bytes())
    report = pipeline.judge_files(recipe, [other.parent / "own.dxf", other.parent / "own.stl", other])
    assert [file["tolerance"] for file in report["files"]] == [0.001, 0.02, 0.001]
    assert {"contour", "motion"} <= failed(report)
    assert not pipeline.judge_files(recipe, [other.parent / "own.stl"], tolerance=0.001)["ok"]
    assert pipeline.judge_files(recipe, [other], tolerance=0.02)["ok"]
    assert {check["file"] for check in report["checks"] if not check["ok"]} == {"other.stl"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("clearance", "rounding", "breadth", "told"),
    [
        (0.2, 0.2001, 50, "a reuleaux.rounding larger by more than 0.2 would"),
        (
            40,
            40.0001,
            80.001,
            "a reuleaux.rounding larger by more than 40 and a reuleaux.breadth of more than 80 would",
        ),
    ],
)
def test_what_would_free_a_reduced_reuleaux_polygon_of_undercut(
    clearance: float, rounding: float, breadth: float, told: str
) -> None:
    text = "cam: {kind: support, reuleaux: {sides: 5, breadth: %s, rounding: %s}}\n"
    text += "export: {files: [{dxf: {clearance: %s}}]}"
    refused = pipeline.check(read((text % (50, 0, clearance)).encode(), "c.yaml"))
    (undercut,) = (x for x in refused.report["checks"] if x["name"] == "undercut-local" and x.get("file"))
    assert told in undercut["detail"]
    assert pipeline.check(read((text % (breadth, rounding, clearance)).encode(), "c.yaml")).ok


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "tolerance"), [pytest.param("dxf", "1e-13", marks=pytest.mark.slow), ("glb", "1e-9")])
def test_a_refused_tolerance_names_one_that_is_held_in_either_unit(kind: str, tolerance: str) -> None:
    def tried(tolerance: str) -> str:
        text = f"part: {{thickness: 0.2}}\nexport: {{tolerance: {tolerance}, files: [{kind}]}}\n"
        text = f"units: inch\ncam: {{kind: support, p: 2.4 + 0.004*cos(3*t)}}\n{text}"
        try:
            report = pipeline.check(read(text.encode(), "cam.yaml")).report
        except RecipeErrors as errors:
            return str(errors)
        return "ok" if report["ok"] else str(report["checks"])

    refused = re.search(r"at least (\S+) mm; (\S+) mm are (\S+) in$", tried(tolerance))
    assert refused
    least, again, inches = refused.groups()
    assert least == again
    assert tried(inches) == tried(f"{least} mm") == "ok"
