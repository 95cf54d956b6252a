"""Sets of all bodies through the whole pipeline: what is reported, what fails, what is refused."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from camgeo.cli.main import main
from camgeo.output import pipeline
from camgeo.recipe.loading import load_text
from camgeo.report.failure import failure
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.expected_checks import foreseen

if TYPE_CHECKING:
    from pathlib import Path

YOKE = """\
cam: {kind: support, fourier: {mean: 20, cos: {3: 1}}, shaft: [6, 0]}
part: {thickness: 5, bore: {square: 6}}
export: {tolerance: 0.02, files: [{stl: {parts: all}}]}
verify: {angles: 24}
"""
FOUR_BAR = """\
cam: {kind: support, fourier: {mean: 25, cos: {3: 2.9}}, shaft: [14.8, 0]}
linkage: {kind: four-bar, ground: 79.28, coupler: 61.85, rocker: 60}
part: {thickness: 8, bore: 9}
export: {tolerance: 0.02, files: [{stl: {parts: all}}]}
verify: {angles: 24}
"""


def faults(text: str) -> list[str]:
    with pytest.raises(RecipeErrors) as caught:
        pipeline.check(load_text(text, "set.yaml"))
    return [str(error) for error in caught.value.errors]


@pytest.fixture(scope="module")
def yoke(tmp_path_factory: pytest.TempPathFactory) -> pipeline.Outcome:
    return pipeline.export(load_text(YOKE, "yoke.yaml"), tmp_path_factory.mktemp("out"))


@pytest.mark.slow
def test_a_set_is_complete_and_every_body_is_judged(yoke: pipeline.Outcome) -> None:
    assert yoke.ok, [check for check in yoke.report["checks"] if not check["ok"]]
    bodies = ["cam", "shaft", "retainer-shaft", "yoke", "base", "cap-right", "cap-left"]
    assert [file["path"] for file in yoke.report["files"]] == [f"yoke-{body}.stl" for body in bodies]
    checks = yoke.report["checks"]
    for body in bodies:
        assert {"watertight", "thickness"} <= {
            check["name"] for check in checks if check.get("file") == f"yoke-{body}.stl"
        }
    (clearance,) = [check for check in checks if check["name"] == "clearance"]
    assert clearance["value"] == 0.2
    assert "the yoke's faces about the cam 0.2" in clearance["detail"]
    assert "retainer on the shaft -0.1" in clearance["detail"]
    pairs = {check["detail"]: check for check in checks if check["name"] == "collision"}
    assert {"cam and yoke", "yoke and base", "shaft and base", "shaft and yoke"} <= set(pairs)
    assert 0.0 < pairs["cam and yoke"]["value"] <= 0.1
    assert pairs["cam and yoke"]["at_deg"] is not None


def test_the_faces_of_the_yoke_in_its_file_are_the_breadth_and_the_clearance_apart(yoke: pipeline.Outcome) -> None:
    import trimesh

    assert yoke.folder is not None
    solid = trimesh.load(yoke.folder / "yoke-yoke.stl")
    assert solid.is_watertight
    section = solid.section(plane_origin=[0.0, 0.0, 0.5 * solid.bounds[:, 2].sum()], plane_normal=[0.0, 0.0, 1.0])
    inner = min(section.discrete, key=lambda loop: np.ptp(loop[:, 0]))
    assert np.ptp(inner[:, 0]) == pytest.approx(40.2, abs=1e-5)
    # a body lies flat on z = 0
    assert solid.bounds[0, 2] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.slow
def test_counter_clockwise_and_inch_are_the_same_bodies(tmp_path: Path, yoke: pipeline.Outcome) -> None:
    import trimesh

    inch = YOKE
    for key, mm in (("mean: ", 20), ("{3: ", 1), ("[", 6), ("thickness: ", 5), ("square: ", 6), ("tolerance: ", 0.02)):
        assert f"{key}{mm}" in inch
        inch = inch.replace(f"{key}{mm}", f"{key}{mm / 25.4!r}")
    outcome = pipeline.export(load_text(f"units: inch\nrotation: ccw\n{inch}", "yoke.yaml"), tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    assert yoke.folder is not None
    assert outcome.folder is not None
    for body in ("cam", "shaft", "yoke", "base"):
        here, there = (trimesh.load(folder / f"yoke-{body}.stl") for folder in (yoke.folder, outcome.folder))
        assert there.volume == pytest.approx(here.volume, rel=1e-3)


@pytest.mark.slow
def test_a_collision_fails_the_set_and_tells_who_where_and_when(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "wide.yaml"
    path.write_text(f"{FOUR_BAR}mechanism: {{wall: 22, pin: 4, bar: 10}}\n", encoding="utf-8")
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 1
    told = "".join(capsys.readouterr())
    assert "frame and base interfere, near (" in told
    assert "collision" in told
    assert "deg" in told
    assert not (tmp_path / "out" / "wide").exists()
    assert (tmp_path / "out" / "wide.rejected" / "wide-frame.stl").exists()


@pytest.mark.slow
def test_bodies_that_meet_are_kept_apart_by_smaller_sizes() -> None:
    """Those that the recipe gives are named, by the check and by a limit of the same; and smaller they do not meet."""
    text = f"{FOUR_BAR}limits: {{collision: {{at_least: 0.01}}}}\nmechanism: {{wall: 22, pin: 4, bar: 10}}\n"
    recipe, words = load_text(text, "wide.yaml"), "smaller mechanism.wall, mechanism.bar and mechanism.pin"
    report = pipeline.check(recipe).report
    failed = {check["name"]: check for check in report["checks"] if not check["ok"]}
    assert set(failed) == {"collision", "limit:collision"}
    assert f"remedy   {words}\n" in failure(failed["collision"], report, recipe)
    assert failed["limit:collision"]["detail"] == f"{words} would satisfy it"
    slimmer_sizes = text.replace("wall: 22, pin: 4, bar: 10", "wall: 6, pin: 3.5, bar: 8")
    assert pipeline.check(load_text(slimmer_sizes, "slim.yaml")).ok


@pytest.mark.slow
def test_the_same_recipe_gives_the_same_bytes(tmp_path: Path, yoke: pipeline.Outcome) -> None:
    again = pipeline.export(load_text(YOKE, "yoke.yaml"), tmp_path)
    assert yoke.folder is not None
    assert again.folder is not None
    for file in yoke.report["files"]:
        assert (again.folder / file["path"]).read_bytes() == (yoke.folder / file["path"]).read_bytes()
    assert again.report["checks"] == yoke.report["checks"]


def test_without_parts_all_the_mechanism_is_skipped_and_told() -> None:
    outcome = pipeline.check(load_text(YOKE.replace("{stl: {parts: all}}", "csv"), "yoke.yaml"))
    assert {"what": "mechanism", "why": "no file is requested with parts: all"} in [
        {"what": entry["what"], "why": entry["why"]} for entry in outcome.report["skipped"]
    ]


def test_what_does_not_turn_has_no_set() -> None:
    outcome = pipeline.check(load_text(FOUR_BAR.replace("rocker: 60", "rocker: 8"), "binds.yaml"))
    assert not outcome.ok
    assert outcome.report["files"] == []
    assert "mechanism" in {entry["what"] for entry in outcome.report["skipped"]}


def test_the_checks_of_a_set_are_foreseen() -> None:
    names = [check.name for check in foreseen(load_text(YOKE, "yoke.yaml"))]
    assert {"clearance", "collision"} <= set(names)
    assert "collision" not in [check.name for check in foreseen(load_text(YOKE.replace(": {parts: all}", ": {}"), "y"))]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("bore: {square: 6}", "wall: 1", "a mechanism needs a bore for its shaft; give part.bore, such as {hexagon"),
        ("thickness: 5, ", "", "stl needs a thickness; give part.thickness, or leave stl out"),
        ("bore: {square: 6}", "bore: 1.5", "part.bore: leaves a journal"),
        ("verify:", "mechanism: {clearence: 0.2}\nverify:", "mechanism.clearence: unknown key"),
        ("verify:", "mechanism: {clearance: 0}\nverify:", "mechanism.clearance: not above 0"),
        ("verify:", "mechanism: {bar: 2}\nverify:", "mechanism.bar: too narrow for the hole of a pin; give at least"),
        ("verify:", "mechanism: {plate: 1}\nverify:", "mechanism.plate: too thin for the sink"),
        ("parts: all", "parts: some", "give cam or all"),
        (
            "verify:",
            "mechanism: {knob: 7}\nverify:",
            "mechanism.knob: does not reach beyond the bore; give at least 8.8 mm",
        ),
        (
            "0.02",
            "0.05",
            "export.tolerance: two facing bodies, each within 0.05 mm, may come 0.1 mm nearer",
        ),
        ("{parts: all}", "{parts: all, tolerance: 0.05}", "export.files[0]: two facing bodies"),
        ("verify:", "mechanism: {clearance: 1.0e-6}\nverify:", "mechanism.clearance: 1e-06 mm is finer than bodies"),
        (
            "verify:",
            "mechanism: {link: 0.1}\nverify:",
            "mechanism.link: 0.1 mm is too thin to be printed",
        ),
        ("thickness: 5", "thickness: 0.2", "part.thickness: 0.2 mm is too thin to be printed"),
        ("{square: 6}", "10, flat: {across: 9.9}", "part.flat.across: the shaft slips in it"),
        ("{square: 6}", "10, keyway: {width: 1.1, depth: 0.2}", "part.keyway.depth: the shaft slips in it"),
        ("{square: 6}", "10, keyway: {width: 0.9, depth: 2}", "part.keyway.width: leaves a key of 0.7 mm on the shaft"),
        ("{square: 6}}", "{hexagon: 8}}\nmechanism: {clearance: 1.2}", "part.bore: the shaft slips in it"),
    ],
)
def test_slips_are_told_at_their_field(old: str, new: str, message: str) -> None:
    assert old in YOKE
    told = faults(YOKE.replace(old, new))
    assert any(message in line for line in told), told


@pytest.mark.slow
def test_a_cam_far_from_its_shaft_has_a_yoke_that_reaches_round_it(tmp_path: Path) -> None:
    """Greatest distance from the shaft between the ends of the curve's cells."""
    text = "cam: {kind: support, fourier: {mean: 25}, shaft: [10, 0]}\n" + YOKE.split("\n", 1)[1]
    outcome = pipeline.export(load_text(text, "far.yaml"), tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]


ROLLER = """\
cam:
  kind: disc
  base_radius: 26
  follower: {kind: roller, radius: 8, offset: 6}
  motion: [{dwell: 60}, {rise: 14, over: 100, law: modified-sine}, {dwell: 60}, {return: 14, over: 140, law: cycloidal}]
part: {thickness: 6, bore: {hexagon: 8}}
export: {tolerance: 0.02, files: [{stl: {parts: all}}]}
verify: {angles: 24}
"""


@pytest.mark.slow
def test_the_set_of_a_roller_on_a_stem_is_complete_and_nothing_meets(tmp_path: Path) -> None:
    outcome = pipeline.export(load_text(ROLLER, "roller.yaml"), tmp_path)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]
    bodies = ["cam", "shaft", "retainer-shaft", "stem", "roller", "retainer-roller", "base", "cap-right"]
    assert [file["path"] for file in outcome.report["files"]] == [f"roller-{body}.stl" for body in bodies]
    (clearance,) = [check for check in outcome.report["checks"] if check["name"] == "clearance"]
    assert "gravity or a spring holds the follower on the cam" in clearance["detail"]
    pairs = {check["detail"] for check in outcome.report["checks"] if check["name"] == "collision"}
    assert {"cam and stem", "stem and base", "roller and cap-right"} <= pairs
    assert "cam and roller" not in pairs  # they touch: that is held against the cam's own file


def test_a_disc_cam_whose_bodies_are_not_made_is_told_at_its_field() -> None:
    (told,) = faults(ROLLER.replace("kind: roller, radius: 8", "kind: knife-edge"))
    assert told == (
        "set.yaml:4:13: cam.follower: a knife edge is not printed; give a roller or a shoe, or leave parts: all out"
    )
