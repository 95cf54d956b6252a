"""The pytest plugin, in projects of its own: what becomes an item, what a failure says, what is left alone."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
from support.places import RECIPES

from camgeo import testing
from camgeo.capabilities.second_opinion import opinion as second_opinion  # needs: second_opinion
from camgeo.output import pipeline
from camgeo.pytest_plugin import CheckItem
from camgeo.recipe.loading import load
from camgeo.synthesis.expected_checks import Foreseen, foreseen

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Pytester = pytest.Pytester

INI = "[pytest]\ncamgeo_recipes = cams/*.yaml\n"
SMALL = "cam: {kind: support, p: 9 + cos(3*t)}\nexport: {tolerance: 0.01, files: [dxf]}\n"
UNDERCUT = SMALL.replace("9 +", "7 +")
OF_DXF = ["units", "closed", "contour", "motion", "constant-breadth", "breadth-max"]
EXACT = ["radius-of-curvature", "undercut-local", "constant-breadth", "contact-travel"]
ITEMS = ["recipe", *EXACT, *(f"{name}[small.dxf]" for name in OF_DXF)]
BOGUS = {"name": "new-check", "ok": False, "value": 2.0, "limit": 1.0, "unit": "mm", "sense": "at_most", "at_deg": 5.0}


@pytest.fixture(scope="module", autouse=True)
def _all_is_imported(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Import here what a run imports: pytester takes modules that come in during a session out again."""
    path = tmp_path_factory.mktemp("warm") / "warm.yaml"
    path.write_text(SMALL.replace("[dxf]", "[dxf, csv]") + "verify: {motion_error: 0.001}\n")
    with pytest.raises(AssertionError):
        testing.assert_recipe(path)
    pipeline.export(load(path), path.parent / "out")
    second_opinion.demand_libraries(load(path))  # needs: second_opinion
    path.write_text(UNDERCUT)
    with pytest.raises(AssertionError):
        testing.assert_recipe(path)


@pytest.fixture
def project(pytester: Pytester, monkeypatch: pytest.MonkeyPatch) -> Pytester:
    """A project that names its recipes, with one recipe that holds; no line of its results is cut."""
    monkeypatch.setenv("COLUMNS", "200")
    pytester.makeini(INI)
    add(pytester, "small", SMALL)
    return pytester


def add(pytester: Pytester, name: str, text: str, folder: str = "cams") -> Path:
    path = pytester.path / folder / f"{name}.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def run(pytester: Pytester, *arguments: str) -> pytest.RunResult:
    """Run in this process, with no other plugin installed here: each of them would be set up anew every time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
        return pytester.runpytest_inprocess("-p", "camgeo.pytest_plugin", *arguments)


def collected(pytester: Pytester, *arguments: str) -> list[str]:
    result = run(pytester, "--collect-only", "-q", *arguments)
    return [line for line in result.outlines if "::" in line]


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Names of the recipes that the pipeline has been run for, in order."""
    runs: list[str] = []
    check = pipeline.check

    def counting(recipe: Any, **_: Any) -> pipeline.Outcome:
        runs.append(recipe.name)
        return check(recipe)

    monkeypatch.setattr(pipeline, "check", counting)
    return runs


def spoil(monkeypatch: pytest.MonkeyPatch, change: Callable[[list[dict[str, Any]]], list[dict[str, Any]]]) -> None:
    """Have the report's checks changed."""
    check = pipeline.check

    def spoilt(recipe: Any, **_: Any) -> pipeline.Outcome:
        report = check(recipe).report
        report["checks"] = change(report["checks"])
        return pipeline.Outcome(report, all(c["ok"] for c in report["checks"]), None)

    monkeypatch.setattr(pipeline, "check", spoilt)


# --- what becomes an item ---------------------------------------------------------------------------------------------


def test_each_check_is_an_item(project: Pytester) -> None:
    assert collected(project) == [f"cams/small.yaml::{name}" for name in ITEMS]
    result = run(project, "-v")
    result.assert_outcomes(passed=len(ITEMS))
    result.stdout.fnmatch_lines(["camgeo: 1 recipe", "cams/small.yaml::motion[[]small.dxf[]] PASSED*"])


LOBE = "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 8}, motion: {formula: 5*(1 - cos(t))}}\n"
SHAFT = "camshaft: {shaft: {diameter: 22, to: 30}, lobes: [{recipe: ../lobe.yaml, at: 0, z: 10, length: 10}]}\n"


# needs: camshaft
@pytest.mark.slow
def test_each_check_of_a_camshaft_is_an_item(project: Pytester) -> None:
    """One for all lobes; what fails is told by the lobe, and placed at it in the recipe of the shaft."""
    add(project, "lobe", LOBE, ".")
    add(project, "shaft", SHAFT + "export: {tolerance: 0.01, files: [svg]}\n")
    shown = collected(project)
    assert "cams/shaft.yaml::recipe" in shown
    assert "cams/shaft.yaml::pressure-angle" in shown
    assert "cams/shaft.yaml::shaft" in shown
    run(project).assert_outcomes(passed=len(shown))
    add(project, "shaft", SHAFT.replace("22", "62"))
    result = run(project, "cams/shaft.yaml")
    result.assert_outcomes(failed=1, passed=5, skipped=8)
    result.stdout.fnmatch_lines(
        ["shaft, lobe: 30 mm, at least 31 mm allowed", "*recipe   cams/shaft.yaml:1:* camshaft.lobes[[]0[]].recipe"]
    )
    assert "camgeo/" not in result.stdout.str().replace(str(project.path), "")


# needs: second_opinion
@pytest.mark.slow
def test_a_second_opinion_adds_its_rows(project: Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = [f"{name}[small.stl]" for name in ("shapely:valid", "shapely:area", "shapely:distance")]
    meshes = ("trimesh:watertight", "trimesh:winding", "trimesh:bodies", "trimesh:volume", "manifold3d:status")
    text = SMALL.replace("[dxf]", "[stl]").replace("export", "part: {thickness: 5}\nexport")
    add(project, "small", text)
    project.makeini(INI + "camgeo_second_opinion = true\n")
    shown = [line.partition("::")[2] for line in collected(project)]
    assert [name for name in shown if ":" in name] == [*rows, *(f"{name}[small.stl]" for name in meshes)]
    run(project).assert_outcomes(passed=len(shown))
    monkeypatch.setattr(second_opinion, "MOST_TRIANGLES", 10)
    result = run(project, "-rs")
    result.assert_outcomes(passed=len(shown) - len(meshes), skipped=len(meshes))
    result.stdout.fnmatch_lines(["SKIPPED*triangles are more than 10*"])
    assert not any(":" in line.partition("::")[2] for line in collected(project, "-o", "camgeo_second_opinion=false"))


NO_PLATES = """\
cam: {kind: support, p: 30 + 3*cos(2*t)}
part: {thickness: 5}
export: {tolerance: 0.01, files: [{dxf: {as: spline}}, {dxf: {as: polyline}}, stl, csv]}
"""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["shu-wu", "rabinowitz", "reuleaux-nine", "w-booth", "w-ellipse", None])
def test_the_checks_of_a_run_are_foreseen(name: str | None, tmp_path: Path) -> None:
    path = RECIPES / f"{name}.yaml" if name else tmp_path / "flat.yaml"
    if name is None:
        path.write_text(NO_PLATES)
    recipe = load(path)
    made = [Foreseen(check["name"], check.get("file")) for check in pipeline.check(recipe).report["checks"]]
    assert sorted(map(str, foreseen(recipe))) == sorted(map(str, made))


# needs: milling
MILLED = """\
cam: {{kind: support, p: 30 + 2*cos(2*t)}}
part: {{thickness: 5, {part}}}
export: {{tolerance: 0.01, files: [gcode, dxf]}}
verify: {{angles: 360}}
manufacture: {{cutter: 6, feed: 400, plunge: 100, spindle: 9000, depth_of_cut: 5, safe_height: 5, {holes}}}
"""


# needs: milling
@pytest.mark.thin(8)
@pytest.mark.parametrize("holes", ["holes: true", "holes: false"])
@pytest.mark.parametrize(
    "part",
    [
        "bore: 10",
        "bore: 6",
        "bore: 10, keyway: din6885",
        "bolts: {count: 3, circle: 40, hole: 5}, dowel: {circle: 40, hole: 8, at: 60}",
        "bore: 6, bolts: {count: 3, circle: 40, hole: 5}",
        "bore: 10, hub: {diameter: 20, height: 4}, bolts: {count: 3, circle: 40, hole: 8}",
        "hub: {diameter: 30, height: 4}, bolts: {count: 3, circle: 20, hole: 8}",
    ],
)
def test_the_checks_of_a_milled_part_are_foreseen(part: str, holes: str, tmp_path: Path) -> None:
    path = tmp_path / "milled.yaml"
    path.write_text(MILLED.format(part=part, holes=holes))
    recipe = load(path)
    made = [Foreseen(check["name"], check.get("file")) for check in pipeline.check(recipe).report["checks"]]
    assert sorted(map(str, foreseen(recipe))) == sorted(map(str, made))


@pytest.mark.slow
def test_a_recipe_runs_once_and_not_before_its_first_item(project: Pytester, counted: list[str]) -> None:
    add(project, "tiny", SMALL)
    assert len(collected(project)) == 2 * len(ITEMS)
    assert counted == []
    run(project).assert_outcomes(passed=2 * len(ITEMS))
    assert counted == ["small", "tiny"]
    counted.clear()
    run(project, "-k", "tiny and motion").assert_outcomes(passed=1, deselected=2 * len(ITEMS) - 1)
    assert counted == ["tiny"]


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("pytest.ini", INI),
        ("tox.ini", INI),
        ("setup.cfg", INI.replace("[pytest]", "[tool:pytest]")),
        ("pyproject.toml", '[tool.pytest.ini_options]\ncamgeo_recipes = "cams/small.yaml"\n'),
        ("pyproject.toml", '[tool.pytest.ini_options]\ncamgeo_recipes = ["cams/*.yaml", "cams/small.yaml"]\n'),
    ],
)
def test_the_line_may_stand_in_any_configuration(pytester: Pytester, file: str, text: str) -> None:
    add(pytester, "small", SMALL)
    (pytester.path / file).write_text(text)
    assert collected(pytester) == [f"cams/small.yaml::{name}" for name in ITEMS]


@pytest.mark.slow
def test_paths_are_relative_to_the_configuration_wherever_root_and_call_are(
    pytester: Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    add(pytester, "small", SMALL, "project/cams")
    ini = pytester.path / "project" / "pytest.ini"
    ini.write_text(INI)
    expected = [f"project/cams/small.yaml::{name}" for name in ITEMS]
    assert collected(pytester, "-c", str(ini), "--rootdir", str(pytester.path)) == expected
    (pytester.path / "project" / "cams" / "deep").mkdir()
    (pytester.path / "project" / "deep").mkdir()
    monkeypatch.chdir(pytester.path / "project" / "cams")  # below the root, pytest looks no further than here
    assert collected(pytester) == [f"cams/small.yaml::{name}" for name in ITEMS]
    monkeypatch.chdir(pytester.path / "project" / "deep")
    assert collected(pytester) == []
    assert len(collected(pytester, "../cams/small.yaml")) == len(ITEMS)


def test_recipes_may_lie_outside_the_root(pytester: Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    add(pytester, "small", SMALL, "shared")
    (pytester.path / "project").mkdir()
    (pytester.path / "project" / "pytest.ini").write_text("[pytest]\ncamgeo_recipes = ../shared/*.yaml\n")
    monkeypatch.chdir(pytester.path / "project")
    run(pytester).assert_outcomes(passed=len(ITEMS))


@pytest.mark.slow
def test_recipes_count_with_the_tests_where_testpaths_names_others(pytester: Pytester) -> None:
    pytester.makeini(INI + "testpaths = tests\n")
    add(pytester, "small", SMALL)
    add(pytester, "hidden", SMALL, ".cams")
    (pytester.path / "tests").mkdir()
    (pytester.path / "tests" / "test_own.py").write_text("def test_own(): pass\n")
    assert len(collected(pytester)) == len(ITEMS) + 1
    assert len(collected(pytester, "tests")) == 1
    assert len(collected(pytester, "--ignore", "cams")) == 1
    assert len(collected(pytester, "--ignore-glob", "*/small.*")) == 1
    assert len(collected(pytester, "-o", "camgeo_recipes=cams/small.yaml .cams/hidden.yaml")) == 2 * len(ITEMS) + 1


@pytest.mark.slow
def test_selection_works_as_anywhere(project: Pytester) -> None:
    motion = "cams/small.yaml::motion[small.dxf]"
    assert collected(project, motion) == [motion]
    assert collected(project, "cams/small.yaml") == [f"cams/small.yaml::{name}" for name in ITEMS]
    assert collected(project, "-k", "motion or travel") == ["cams/small.yaml::contact-travel", motion]
    assert collected(project, "--deselect", motion) == [f"cams/small.yaml::{n}" for n in ITEMS if "motion" not in n]
    assert len(collected(project, "-m", "camgeo", "--strict-markers")) == len(ITEMS)
    assert collected(project, "-m", "not camgeo") == []


def test_files_that_are_not_named_are_left_alone(project: Pytester) -> None:
    add(project, "other", "cam: [", "more")
    (project.path / "cams" / "notes.txt").write_text("no recipe")
    assert len(collected(project)) == len(ITEMS)


# --- what a failure says ----------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_a_failure_tells_figure_limit_place_and_remedy(project: Pytester) -> None:
    text = SMALL + "verify: {motion_error: 0.001}\n"
    path = add(project, "small", text)
    result = run(project)
    result.assert_outcomes(passed=len(ITEMS) - 1, failed=1)
    result.stdout.re_match_lines(
        [
            r"motion of small\.dxf: 0\.00\d+ mm, at most 0\.001 mm allowed, at \d+\.\d\d deg",
            r"  value    0\.00\d+ mm",
            r"  limit    at most 0\.001 mm",
            r"  at       \d+\.\d{4} deg of shaft angle",
            r"  file     small\.dxf",
            r"  remedy   a tolerance of 0\.001, or verify\.motion_error above 0\.00\d+",
            r"  recipe   cams/small\.yaml:3:24 verify\.motion_error",
            r"FAILED cams/small\.yaml::motion\[small\.dxf\] - .*motion of small\.dxf.*",
        ]
    )
    result.stdout.no_fnmatch_line("*Traceback*")
    result.stdout.no_fnmatch_line("*pytest_plugin.py*")
    # and each of the remedies does
    found = re.search(r"tolerance of (\S+), or verify.motion_error above (\S+)", result.stdout.str())
    assert found
    for better in (
        text.replace("tolerance: 0.01", f"tolerance: {found[1]}"),
        text.replace("error: 0.001", f"error: {1.001 * float(found[2])}"),
    ):
        path.write_text(better)
        run(project).assert_outcomes(passed=len(ITEMS))


FAULTY = """\
cam:
  kind: constant-breadth
  base_radis: 40
  motion:
    - {rise: 20, over: 120, law: modified-sin}
    - {dwell: 50}
"""


def test_a_faulty_recipe_is_one_item_with_every_fault(project: Pytester) -> None:
    add(project, "faulty", FAULTY)
    result = run(project, "-k", "faulty")
    result.assert_outcomes(failed=1, deselected=len(ITEMS))
    result.stdout.fnmatch_lines(
        [
            "cams/faulty.yaml:3:3: cam.base_radis: unknown key; did you mean base_radius?",
            "cams/faulty.yaml:5:34: cam.motion*law*'modified-sin'; did you mean modified-sine?",
            "FAILED cams/faulty.yaml::recipe - *",
        ]
    )
    result.stdout.no_fnmatch_line("*pytest_plugin.py*")


def test_a_motion_that_cannot_be_is_one_item(project: Pytester) -> None:
    add(project, "small", SMALL.replace("cos(3*t)", "cos(t/3)"))
    result = run(project)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["cams/small.yaml:1:*: cam.p: *"])


@pytest.mark.slow
def test_a_fault_found_on_the_way_fails_once_but_never_passes(project: Pytester) -> None:
    add(project, "small", SMALL.replace("0.01", "1.0e-14"))
    result = run(project, "-rs")
    result.assert_outcomes(failed=1, skipped=len(ITEMS) - 1)
    result.stdout.fnmatch_lines(["cams/small.yaml:2:*: export.tolerance: *", "*judged, see cams/small.yaml::recipe"])
    alone = run(project, "-k", "motion")
    alone.assert_outcomes(failed=1, deselected=len(ITEMS) - 1)
    alone.stdout.fnmatch_lines([r"motion*: not judged: cams/small.yaml:2:*: export.tolerance: *"])


@pytest.mark.slow
def test_undercut_is_told_where_it_is_and_all_else_waits(project: Pytester) -> None:
    add(project, "small", UNDERCUT)
    result = run(project)
    result.assert_outcomes(failed=2, passed=3, skipped=len(OF_DXF))
    result.stdout.fnmatch_lines(
        [
            "radius-of-curvature: -1 mm, more than 0 mm needed, at *",
            "  remedy   a p larger by more than 1 mm",
            "undercut-local: * mm, at most 0 mm allowed, at *",
            "  found    from * deg; * larger by more than 1 would have no undercut; or let * undercut: trim",
        ]
    )
    alone = run(project, "cams/small.yaml::motion[small.dxf]")
    alone.assert_outcomes(failed=1)
    alone.stdout.fnmatch_lines(["motion*: not judged: radius-of-curvature: -1 mm, more than 0 mm*"])


def test_what_trimming_leaves_unjudged_is_skipped_with_the_reason(project: Pytester) -> None:
    add(project, "small", UNDERCUT.replace("cos(3*t)", "cos(3*t), undercut: trim"))
    result = run(project, "-rs", "-k", "motion")
    result.assert_outcomes(skipped=1, deselected=len(ITEMS) - 1)
    result.stdout.fnmatch_lines(["SKIPPED*small.yaml: an undercut is trimmed*verify.motion_error*"])


def test_a_check_that_was_not_foreseen_fails_the_recipe_itself(
    project: Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    spoil(monkeypatch, lambda checks: [*checks, BOGUS])
    result = run(project)
    result.assert_outcomes(failed=1, passed=len(ITEMS) - 1)
    result.stdout.fnmatch_lines(
        ["new-check: 2 mm, at most 1 mm allowed, at 5.00 deg", "FAILED cams/small.yaml::recipe*"]
    )


def test_a_check_that_was_foreseen_and_not_made_fails(project: Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil(monkeypatch, lambda checks: [check for check in checks if check["name"] != "motion"])
    result = run(project)
    result.assert_outcomes(failed=1, passed=len(ITEMS) - 1)
    result.stdout.fnmatch_lines(["motion*small.dxf* is not among the checks that were made"])


def test_a_file_that_cannot_be_read_fails_once(project: Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    closed = BOGUS | {"name": "closed", "file": "small.dxf", "value": None, "at_deg": None, "detail": "a gap at (1, 2)"}
    spoil(monkeypatch, lambda checks: [*(check for check in checks if "file" not in check), closed])
    result = run(project)
    result.assert_outcomes(failed=1, passed=1 + len(EXACT), skipped=len(OF_DXF) - 1)
    result.stdout.fnmatch_lines(["closed of small.dxf: a gap at (1, 2)"])


@pytest.mark.slow
def test_an_error_of_the_program_is_met_once_and_told_with_its_own_traceback(
    project: Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[None] = []

    def broken(_: object, **__: Any) -> None:
        calls.append(None)
        raise ArithmeticError("no such luck")

    monkeypatch.setattr(pipeline, "check", broken)
    result = run(project)
    result.assert_outcomes(failed=len(ITEMS))
    result.stdout.fnmatch_lines(["*ArithmeticError: no such luck", "motion*: not judged: *: the run broke off*"])
    result.stdout.no_fnmatch_line("*runner.py*")
    assert len(calls) == 1


def test_a_disk_that_refuses_is_no_traceback(project: Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: object, **__: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pipeline, "check", full)
    result = run(project)
    # in another process there may be room: no item may rely on another one's failure
    result.assert_outcomes(failed=len(ITEMS))
    result.stdout.fnmatch_lines(["cams/small.yaml: *No space left on device", "motion*: not judged: *No space left*"])
    result.stdout.no_fnmatch_line("*pytest_plugin.py*")


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("cams/*.yml", "*camgeo_recipes: 'cams/[*].yml' matches no file*"),
        ("cams/small.yaml parts/cam.yaml", "*camgeo_recipes: 'parts/cam.yaml' matches no file*"),
        ("cams", "*camgeo_recipes: 'cams' names a folder;*"),
    ],
)
def test_a_pattern_that_matches_nothing_is_a_usage_error(project: Pytester, line: str, message: str) -> None:
    project.makeini(f"[pytest]\ncamgeo_recipes = {line}\n")
    result = run(project)
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines([message])
    assert run(project, "--help").ret == 0


def test_the_figures_are_in_the_junit_file(project: Pytester) -> None:
    run(project, "--junitxml", "out.xml", "-k", "motion")
    text = (project.path / "out.xml").read_text()
    assert '<property name="limit" value="0.01"' in text
    assert re.search(r'<property name="value" value="0\.00', text)


# --- files that are kept ----------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_files_can_be_kept(project: Pytester) -> None:
    add(project, "poor", SMALL + "verify: {motion_error: 0.001}\n")
    run(project, "--camgeo-out", "kept").assert_outcomes(passed=2 * len(ITEMS) - 1, failed=1)
    assert (project.path / "kept" / "small" / "small.dxf").is_file()
    assert (project.path / "kept" / "poor.rejected" / "report.json").is_file()


@pytest.mark.slow
def test_kept_files_of_two_recipes_do_not_share_a_folder(project: Pytester) -> None:
    add(project, "twin", "name: Small\n" + SMALL)
    run(project).assert_outcomes(passed=2 * len(ITEMS))
    result = run(project, "--camgeo-out", "kept")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["cams/twin.yaml: its files would go to the folder of cams/small.yaml*"])


def test_keeping_files_needs_recipes(pytester: Pytester) -> None:
    result = run(pytester, "--camgeo-out", "kept")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["*--camgeo-out: no recipes are named;*"])


# --- several processes ------------------------------------------------------------------------------------------------


def run_two(pytester: Pytester, *arguments: str) -> pytest.RunResult:
    """Run in two workers, again with no other plugins: importing them three times is most of the time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
        return pytester.runpytest_subprocess("-p", "xdist", "-p", "camgeo.pytest_plugin", "-n", "2", *arguments)


@pytest.mark.slow
def test_with_several_processes(project: Pytester) -> None:
    project.makeini(INI + "testpaths = nowhere cams/..\n")
    add(project, "poor", SMALL + "verify: {motion_error: 0.001}\n")
    result = run_two(project)
    result.assert_outcomes(passed=2 * len(ITEMS) - 1, failed=1)
    result.stdout.fnmatch_lines(["motion of poor.dxf: *", "  remedy   *"])


@pytest.mark.slow
def test_several_processes_do_not_write_one_folder(project: Pytester) -> None:
    result = run_two(project, "--camgeo-out", "kept")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["*give --dist loadfile"])
    together = run_two(project, "--strict-markers", "--dist", "loadfile", "--camgeo-out", "kept")
    together.assert_outcomes(passed=len(ITEMS))
    assert (project.path / "kept" / "small" / "small.dxf").is_file()


# --- projects that do not ask -----------------------------------------------------------------------------------------

NOTHING_LOADED = """\
import sys

def test_modules(request):
    manager = request.config.pluginmanager
    assert manager.has_plugin("camgeo.pytest_plugin") and not manager.has_plugin("camgeo-recipes")
    ours = {name for name in sys.modules if name.partition(".")[0] in ("camgeo", "kin")}
    labels = {name for name in ours if name.startswith(("camgeo.registry", "camgeo.capabilities"))}
    assert ours - labels == {"camgeo", "camgeo.pytest_plugin", "camgeo.version"}
    assert not any(name.count(".") > 2 for name in labels)
    heavy = ("numpy", "yaml", "ezdxf", "scipy", "shapely", "trimesh")
    assert not {name for name in heavy if name in sys.modules}
    assert "camgeo" not in "".join(request.config.getini("markers"))
"""


@pytest.mark.slow
def test_nothing_happens_where_nobody_asks(pytester: Pytester, monkeypatch: pytest.MonkeyPatch) -> None:
    # other people's plugins may import what they like
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    add(pytester, "small", SMALL, ".")
    pytester.makepyfile(NOTHING_LOADED)
    result = pytester.runpytest_subprocess("-p", "camgeo.pytest_plugin", "--strict-config", "--strict-markers")
    result.assert_outcomes(passed=1)
    result.stdout.no_fnmatch_line("camgeo:*")


@pytest.mark.slow
def test_installed_it_is_there_by_its_name(pytester: Pytester) -> None:
    pytester.makepyfile("def test_it(pytestconfig): assert pytestconfig.pluginmanager.has_plugin('camgeo')")
    pytester.runpytest_subprocess().assert_outcomes(passed=1)


@pytest.mark.slow
def test_it_can_be_switched_off(project: Pytester) -> None:
    project.makepyfile("def test_own(): pass")
    result = project.runpytest_subprocess("-p", "no:camgeo")
    result.assert_outcomes(passed=1, warnings=1)
    result.stdout.fnmatch_lines(["*Unknown config option: camgeo_recipes*"])


def test_keeping_files_needs_a_name(project: Pytester) -> None:
    result = run(project, "--camgeo-out", "")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["*--camgeo-out: an empty name*"])


def test_files_of_any_origin_are_verified_beside_their_recipe(project: Pytester) -> None:
    pipeline.export(load(project.path / "cams" / "small.yaml"), project.path / "out")
    drawing = project.path / "out" / "small" / "small.dxf"
    (project.path / "back.dxf").write_bytes(drawing.read_bytes())
    project.makeini(
        f"{INI}camgeo_verify =\n    cams/small.yaml back.dxf\n    cams/small.yaml back.dxf tolerance=0.0001\n"
    )
    result = run(project, "-k", "verify")
    result.assert_outcomes(passed=1, failed=1, deselected=len(ITEMS))
    result.stdout.fnmatch_lines(["*verify[[]back.dxf tolerance=0.0001]*", "*contour of back.dxf: 0.00*"])


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("cams/other.yaml back.dxf", "'cams/other.yaml' is not among the recipes of camgeo_recipes"),
        ("cams/small.yaml none.dxf", "no file *none.dxf"),
        ("cams/small.yaml", "no file is named"),
    ],
)
def test_a_line_of_files_that_leads_nowhere_is_a_usage_error(project: Pytester, line: str, told: str) -> None:
    project.makeini(f"{INI}camgeo_verify = {line}\n")
    result = run(project)
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines([f"*camgeo_verify: *{told}*"])


DXF, STL = Foreseen("motion", "c.dxf"), Foreseen("motion", "c.stl")
BLAMED = {"value": 2.0, "limit": 1.0, "unit": "mm", "sense": "at_most"}


@pytest.mark.parametrize(
    ("skipped", "checks", "told"),
    [
        ([{"what": "c.dxf", "why": "no package", "missing": True}], [], "motion[c.dxf]: not judged: no package"),
        # another file's, and one that is left out for no lack, are no reason
        ([{"what": "c.stl", "why": "no package", "missing": True}], [], "motion[c.dxf] is not among the checks"),
        ([{"what": "c.dxf", "why": "as asked"}], [], "motion[c.dxf] is not among the checks"),
        ([], [{"name": "readable", "ok": False, "file": "c.dxf", **BLAMED}], "not judged: readable"),
        ([], [{"name": "size", "ok": False, **BLAMED}], "not judged: size"),
        ([], [{"name": "readable", "ok": False, "file": "c.stl", **BLAMED}], "motion[c.dxf] is not among the checks"),
        ([], [{"name": "readable", "ok": True, "file": "c.dxf", **BLAMED}], "motion[c.dxf] is not among the checks"),
    ],
)
def test_the_reason_of_a_check_that_was_not_made(
    skipped: list[dict[str, Any]], checks: list[dict[str, Any]], told: str
) -> None:
    item = CheckItem.__new__(CheckItem)
    item.name, item.known = str(DXF), frozenset({DXF, STL})
    run: Any = SimpleNamespace(recipe=SimpleNamespace(trims=False), shown="c.yaml", selected=(), options=())
    item.run = run
    missing: Any = item._missing  # which never comes back
    with pytest.raises(pytest.fail.Exception) as failed:
        missing(DXF, {"skipped": skipped, "checks": checks})
    assert told in str(failed.value)
