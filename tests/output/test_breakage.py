"""Recipes and calls that once ended in a traceback or a wrong word: each has an answer, and says it."""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.cases import few

from camgeo.cli import batch
from camgeo.cli.exit_status import SURROUNDINGS, WRONG
from camgeo.cli.main import main
from camgeo.common import workers
from camgeo.output import pipeline
from camgeo.output.output_folder import RunFolder

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

FILES = "export: {tolerance: 0.001, files: [dxf, stl]}\n"


def exported(folder: Path, recipe: str, *more: str) -> int:
    path = folder / "tried.yaml"
    path.write_text(recipe, encoding="utf-8")
    return main(["export", str(path), "--out", str(folder / "out"), *more])


@pytest.mark.slow
def test_shaft_on_the_contour_has_no_base_circle(tmp_path: Path) -> None:
    assert exported(tmp_path, "cam: {kind: support, p: '25', shaft: [25, 0]}\npart: {thickness: 8}\n" + FILES) == 0


@pytest.mark.thin(2)
@pytest.mark.parametrize("undercut", ["refuse", "trim"])
@pytest.mark.parametrize("p", ["8 + cos(3*t)", "0*t"])
def test_a_radius_of_curvature_that_is_just_0_fails_its_check(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], p: str, undercut: str
) -> None:
    recipe = f"cam: {{kind: support, p: {p}, undercut: {undercut}}}\npart: {{thickness: 8}}\n"
    assert exported(tmp_path, recipe + FILES) == 1
    assert "radius-of-curvature: 0 mm, more than 0 needed" in capsys.readouterr().out


def test_a_wall_thinner_than_the_tolerance_is_refused_at_the_bore(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recipe = "cam: {kind: support, p: 25 + sin(3*t)}\npart: {thickness: 8, bore: 47.999}\n"
    assert exported(tmp_path, recipe + FILES) == 2
    assert "part.bore: within the tolerance, the bore reaches the contour" in capsys.readouterr().err


def test_an_impossible_stl_is_refused_before_anything_is_fitted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fitted(*_: object) -> None:
        pytest.fail("fitted what cannot be written")

    monkeypatch.setattr("camgeo.fit.cache._fit", fitted)
    recipe = "cam: {kind: support, p: 25 + sin(3*t)}\npart: {thickness: 8}\n"
    assert exported(tmp_path, recipe + FILES, "--tolerance", "1e-9") == 2
    assert "single precision" in capsys.readouterr().err


@pytest.mark.slow
def test_a_flat_pair_is_not_told_to_enlarge_a_base_radius(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert exported(tmp_path, "cam: {kind: flat-pair, ratio: 3, arm: 60, delta: {cos: {1: 2340}}}\n") == 1
    said = capsys.readouterr().out
    assert "a smaller swing would have no undercut" in said
    assert "base radius" not in said


def test_undercut_that_parts_the_metal_keeps_its_figures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recipe = "cam: {kind: double-roller, ratio: 2, arm: 40, roller_radius: 20, delta: {cos: {1: 1440}}, undercut: trim}"
    assert exported(tmp_path, recipe + "\n") == 1
    said = capsys.readouterr().out
    assert "undercut-global: " in said
    assert "a roller radius below 17.8885 would have no undercut; trimming is not possible: " in said
    assert "undercut-local" not in said


def test_a_step_too_small_for_nine_digits_is_told_as_a_step(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert exported(tmp_path, "cam: {kind: support, p: 25 + 1e-9*t}\n") == 2
    assert "p jumps by 6.28e-09 mm at 0 degrees" in capsys.readouterr().err


@pytest.mark.parametrize("tolerance", ["0", "-1", "nan", "inf", "1e300", "thin"])
def test_a_tolerance_that_is_none_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], tolerance: str
) -> None:
    with pytest.raises(SystemExit) as left:
        exported(tmp_path, "cam: {kind: support, p: '25'}\n", f"--tolerance={tolerance}")
    assert left.value.code == WRONG
    assert f"a length above 0 and up to 2000000 is expected, not {tolerance}" in capsys.readouterr().err


@pytest.mark.parametrize("jobs", ["0", "-3", "two", "1.5"])
def test_a_number_of_processes_that_is_none_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], jobs: str
) -> None:
    with pytest.raises(SystemExit) as left:
        exported(tmp_path, "cam: {kind: support, p: '25'}\n", f"--jobs={jobs}")
    assert left.value.code == WRONG
    assert f"a whole number from 1, not {jobs}" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="closes streams as a POSIX shell does")
@pytest.mark.parametrize(("closed", "status"), few([(">&-", 0), ("2>&-", 0), (">&- 2>&-", 0)], 3))
def test_closed_streams_change_nothing(tmp_path: Path, closed: str, status: int) -> None:
    (tmp_path / "round.yaml").write_text("cam: {kind: support, p: '25'}\n", encoding="utf-8")
    call = f"'{sys.executable}' -m camgeo.cli.main export round.yaml {closed}"
    done = subprocess.run(["sh", "-c", call], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (status, "")
    assert (tmp_path / "out" / "round" / "round.dxf").exists()


@pytest.mark.slow
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a device that is always full")  # noqa: PTH110
def test_a_full_disk_under_the_output_is_the_surroundings() -> None:
    with open("/dev/full", "w", encoding="utf-8") as full:  # noqa: PTH123
        call = [sys.executable, "-m", "camgeo", "schema"]
        done = subprocess.run(call, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == SURROUNDINGS
    assert done.stderr == "camgeo: the output cannot be written: No space left on device\n"


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="limits a process as a POSIX shell does")
@pytest.mark.parametrize("kind", few(["stl", "3mf", "dxf", "glb"], 2))
def test_a_file_that_does_not_fit_is_told_in_the_words_of_the_system(tmp_path: Path, kind: str) -> None:
    """Not in those of numpy, which counts the items that it has written."""
    cam = "cam: {kind: support, p: 25 + cos(3*t)}\npart: {thickness: 8}\n"
    (tmp_path / "cam.yaml").write_text(f"{cam}export: {{tolerance: 1e-5, files: [{kind}]}}\n", encoding="utf-8")
    # -B: compiled modules would not fit either, and stay behind
    call = f"ulimit -f 4; '{sys.executable}' -B -m camgeo.cli.main export cam.yaml"
    done = subprocess.run(["sh", "-c", call], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == SURROUNDINGS
    assert done.stderr.endswith(": File too large\n")
    assert not (tmp_path / "out" / "cam").exists()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the killed function reaches the workers by fork")
def test_a_killed_process_is_told_for_each_recipe(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = [tmp_path / f"{name}.yaml" for name in ("here", "one", "two")]
    for path in paths:
        path.write_text("cam: {kind: support, p: '25'}\n", encoding="utf-8")
    here, check = os.getpid(), pipeline.check
    monkeypatch.setattr(pipeline, "check", lambda *a, **k: check(*a, **k) if os.getpid() == here else os._exit(9))
    monkeypatch.setattr(batch, "FORKED", -1.0)
    monkeypatch.setattr(workers, "may_fork", lambda: True)
    assert main(["check", *map(str, paths), "--jobs", "2"]) == SURROUNDINGS
    said = capsys.readouterr().err.splitlines()
    assert [line.split(": ")[:2] for line in said] == [["camgeo", "one"], ["camgeo", "two"]]
    assert all("a process was killed" in line for line in said)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the killed function reaches the workers by fork")
def test_the_recipes_beside_a_killed_one_are_made_and_nothing_partial_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """`twice` always kills its process as its files are written, `once` only the first time."""
    names = ["here", "a", "once", "b", "twice", "c"]
    for name in names:
        text = "cam: {kind: support, p: '25'}\nexport: {tolerance: 0.1, files: [csv]}\n"
        (tmp_path / f"{name}.yaml").write_text(text, encoding="utf-8")
    commit, mark, out = RunFolder.commit, tmp_path / "mark", tmp_path / "out"

    def killed(run: RunFolder, names: Iterable[str], *, keep: Iterable[str] = ()) -> Path:
        if "twice" in run.folder.name or ("once" in run.folder.name and not mark.exists()):
            mark.touch()
            os._exit(9)
        return commit(run, names, keep=keep)

    monkeypatch.setattr(RunFolder, "commit", killed)
    monkeypatch.setattr(batch, "FORKED", -1.0)
    monkeypatch.setattr(workers, "may_fork", lambda: True)
    paths = [str(tmp_path / f"{name}.yaml") for name in names]
    assert main(["export", *paths, "--jobs", "2", "--out", str(out)]) == SURROUNDINGS
    said = capsys.readouterr()
    assert [line.partition(":")[0] for line in said.out.splitlines()] == ["here", "a", "once", "b", "c"]
    assert said.err.startswith("camgeo: twice: a process was killed before this recipe was done")
    assert mark.exists()
    assert sorted(path.name for path in out.iterdir()) == ["a", "b", "c", "here", "once"]


@pytest.mark.slow
def test_a_spline_of_many_metres_is_judged_as_finely_as_rounding_allows(tmp_path):
    path = tmp_path / "big.yaml"
    path.write_text(
        "cam: {kind: flat-pair, ratio: 2, arm: 100000, delta: {cos: {1: 1.0e9}}}\n"
        "part: {thickness: 5}\nexport: {tolerance: 1, files: [{dxf: {as: spline}}]}\n",
        encoding="utf-8",
    )
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 0


@pytest.mark.parametrize("formula", ["1e308 + cos(3*t)", "1e100 + cos(3*t)", "2000001 + cos(3*t)"])
def test_a_formula_beyond_any_cam_is_refused_with_its_figure(tmp_path, capsys, formula):
    path = tmp_path / "big.yaml"
    path.write_text(f"cam: {{kind: support, p: {formula}}}\npart: {{bore: 10}}\n", encoding="utf-8")
    assert main(["check", str(path)]) == 2
    assert "big.yaml:1:25: cam.p: p reaches " in capsys.readouterr().err
