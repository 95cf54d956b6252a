"""`camgeo sweep`: exit status, what is printed where, interruption, missing extras."""

from __future__ import annotations

import errno
import json
import os
import pty
import re
import signal
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import pytest
from support.cases import few
from support.places import TESTS
from support.sweepers import FOUR_BAR, PROCEDURES

from camgeo.capabilities.sweep import command as sweep
from camgeo.capabilities.sweep import search
from camgeo.cli import progress as terminal
from camgeo.cli.main import main
from camgeo.cli.progress import Progress

FIRST = "dwell 49.7 deg, dwell-relative 24.85 deg, margin 3.83333 mm"
RUN = """\
import sys
from support.sweepers import PROCEDURES
from camgeo.cli.main import main
from camgeo.cli.progress import Progress
from camgeo.capabilities.sweep import search
if __name__ == "__main__":
    search.COMPUTING = PROCEDURES
    sys.exit(main(sys.argv[1:]))
"""


@pytest.fixture(autouse=True)
def stand_in(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "COMPUTING", PROCEDURES)


def written(folder: Path, *, comment="", margin=1.0, rank="dwell", refine="false", old="", new="") -> Path:
    path = folder / "four-bar.yaml"
    text = FOUR_BAR.format(comment=comment, margin=margin, rank=rank, refine=refine)
    assert old in text
    path.write_text(text.replace(old, new) if old else text, encoding="utf-8")
    return path


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_what_was_found_is_said_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["sweep", str(written(tmp_path)), "--out", str(out)]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert said.out.startswith("four-bar: dwell 49.7 deg, the best of ")
    assert said.out.endswith(f" a second; {out / 'four-bar'}\n")
    assert said.out.count("\n") == 1


@pytest.mark.usefixtures("no_pictures")
@pytest.mark.slow
def test_verbose_tells_counts_and_designs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", str(written(tmp_path)), "--out", str(tmp_path / "out"), "-v"]) == 0
    said = capsys.readouterr().out
    assert " do not turn (binds " in said
    assert " break the limit of margin" in said
    assert f"  best-1.yaml: cam.shaft[0] 15.8333, linkage.rocker 95\n    {FIRST}\n" in said


@pytest.mark.thin(2)
@pytest.mark.usefixtures("no_pictures")
@pytest.mark.parametrize(("margin", "status"), [(1.0, 3), (99.0, 1)])
def test_a_file_left_out_for_want_of_a_package_exits_3(
    margin: float,
    status: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def without(*_arguments: object) -> None:
        raise ModuleNotFoundError(name="pyarrow")

    monkeypatch.setattr("camgeo.capabilities.sweep.outputs.as_parquet", without)
    assert main(["sweep", str(written(tmp_path, margin=margin)), "--out", str(tmp_path / "out")]) == status
    why = "the package pyarrow is missing: pip install '.[sweep]' in a clone of camgeo"
    assert capsys.readouterr().err == f"camgeo: four-bar: without sweep.parquet: {why}\n"


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_json_is_the_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", str(written(tmp_path)), "--out", str(tmp_path / "out"), "--json"]) == 0
    report = json.loads((tmp_path / "out" / "four-bar" / "sweep.json").read_text(encoding="utf-8"))
    assert json.loads(capsys.readouterr().out) == report


@pytest.mark.slow
def test_limits_that_nothing_keeps_exit_1_and_say_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", str(written(tmp_path, margin=99.0)), "--out", str(tmp_path / "out")]) == 1
    said = capsys.readouterr().out
    assert said.startswith("four-bar: no design is within the limits, of 825 designs")
    assert "do not turn (binds " in said
    assert "break the limit of margin; nearest: cam.shaft[0] " in said
    assert re.search(r"linkage\.rocker \S+, with margin \S+ mm where at least 99 is required; ", said)
    assert said.endswith("four-bar.rejected\n")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "linkage.rocker: {from",
            "linkage.roker: {from",
            "unknown field, given 'linkage.roker'; did you mean linkage.rocker?",
        ),
        ("cam.shaft[0]", "cam.shaft[2]", "unknown field, given 'cam.shaft[2]'"),
        ("rank: dwell", "rank: dwel", "sweep.rank: "),
        ("margin: {", "margn: {", "sweep.limits.margn: unknown figure; did you mean margin?"),
        ("at_least:", "atleast:", "sweep.limits.margin.atleast: "),
        ("steps: 25", "step: 25", "step: "),
        ("dwell: {band: 0.1}\n", "", "sweep.rank: dwell needs dwell.band"),
    ],
)
def test_typing_errors_exit_2_and_are_placed(
    old: str, new: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, old=old, new=new)
    assert main(["sweep", str(path), "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr()
    assert message in said.err
    assert said.err.startswith(f"{path}:")
    assert said.out == ""
    assert not (tmp_path / "out").exists()


def test_a_recipe_without_a_sweep_exits_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "plain.yaml"
    path.write_text("cam: {kind: support, p: 20}\n", encoding="utf-8")
    assert main(["sweep", str(path)]) == 2
    assert "sweep: this recipe has no sweep; add what to vary" in capsys.readouterr().err


@pytest.mark.slow
def test_a_scheduler_that_does_not_answer_exits_3(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["sweep", str(written(tmp_path)), "--out", str(tmp_path / "out"), "--scheduler", "tcp://127.0.0.1:1"]
    assert main(arguments) == 3
    assert "four-bar: no Dask scheduler answers at tcp://127.0.0.1:1" in capsys.readouterr().err


def test_a_disk_that_refuses_exits_3(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "out").write_text("in the way")
    assert main(["sweep", str(written(tmp_path)), "--out", str(tmp_path / "out")]) == 3
    assert "four-bar: " in capsys.readouterr().err


def test_a_file_named_sweep_is_told_with_what_to_do(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out" / "four-bar"
    folder.mkdir(parents=True)
    (folder / "sweep").write_text("mine")
    assert main(["sweep", str(written(tmp_path)), "--out", str(tmp_path / "out")]) == 3
    advice = "not a folder, where the sweep keeps its results: move it or remove it"
    assert capsys.readouterr().err == f"camgeo: four-bar: {folder / 'sweep'}: {advice}\n"


def test_a_full_disk_is_told_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_path: Path, _data: bytes) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    path = written(tmp_path)
    monkeypatch.setattr(Path, "write_bytes", full)
    assert main(["sweep", str(path), "--out", str(tmp_path / "out")]) == 3
    said = capsys.readouterr().err
    assert said.startswith(f"camgeo: four-bar: {tmp_path / 'out' / 'four-bar'}: No space left on device; what was")


def test_a_users_file_in_the_way_exits_3_and_stays(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "out" / "four-bar"
    folder.mkdir(parents=True)
    (folder / "sweep.csv").write_text("mine")
    assert main(["sweep", str(written(tmp_path)), "--out", str(tmp_path / "out")]) == 3
    assert "is in the way, and no report lists it as replaceable" in capsys.readouterr().err
    assert (folder / "sweep.csv").read_text() == "mine"
    assert not (folder / "sweep.json").exists()


@pytest.mark.parametrize(
    ("package", "extra", "change", "options"),
    [
        ("scipy", "sweep", {"old": ", steps: 33}\n", "new": "}\n  method: sobol\n  count: 9\n"}, []),
        ("scipy", "sweep", {"refine": "true"}, []),
        ("distributed", "dask", {}, ["--scheduler", "tcp://127.0.0.1:1"]),
    ],
)
def test_a_missing_extra_exits_3_and_is_named_before_anything_is_computed(
    *,
    package: str,
    extra: str,
    change: dict[str, str],
    options: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(search, "find_spec", lambda name: None if name == package else find_spec(name))
    path = written(tmp_path, **change)
    if "sobol" in path.read_text():
        path.write_text(path.read_text().replace(", steps: 25", ""))
    assert main(["sweep", str(path), "--out", str(tmp_path / "out"), *options]) == 3
    expected = f"camgeo: four-bar: the package {package} is missing: pip install '.[{extra}]' in a clone of camgeo\n"
    assert capsys.readouterr().err == expected
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize("jobs", few(["1", "2"], 2))
def test_an_interrupted_sweep_exits_130_and_goes_on_later(jobs: str, tmp_path: Path) -> None:
    script = tmp_path / "run.py"
    script.write_text(RUN)
    out = tmp_path / "out"
    path = written(tmp_path, comment="seconds=0.1;")
    environment = {**os.environ, "PYTHONPATH": str(TESTS)}
    arguments = [sys.executable, str(script), "sweep", str(path), "--out", str(out), "--jobs", jobs]
    with subprocess.Popen(arguments, env=environment, stderr=subprocess.PIPE, text=True) as process:
        while not list(out.glob("four-bar/sweep/*/chunk-*.bin")) and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == ("camgeo: four-bar: interrupted; what was computed is kept; the same command continues from there\n")
    assert main(["sweep", str(path), "--out", str(out), "--jobs", "1"]) == 0
    run = json.loads((out / "four-bar" / "sweep.json").read_text(encoding="utf-8"))["run"]
    assert run["designs_found"] > 0
    assert run["designs_found"] + run["designs_computed"] == 825


@pytest.mark.slow
def test_progress_is_shown_on_a_terminal_and_taken_away_again(tmp_path: Path) -> None:
    script = tmp_path / "run.py"
    script.write_text(RUN)
    path = written(tmp_path, comment="seconds=0.15;")
    environment = {**os.environ, "PYTHONPATH": str(TESTS)}
    leader, follower = pty.openpty()
    arguments = [sys.executable, str(script), "sweep", str(path), "--out", str(tmp_path / "out"), "--jobs", "1"]
    assert subprocess.run(arguments, env=environment, stderr=follower, capture_output=False, check=True).returncode == 0
    os.close(follower)
    said = b""
    try:
        while part := os.read(leader, 65536):
            said += part
    except OSError:  # Linux says so where the other end is closed
        pass
    finally:
        os.close(leader)
    assert b"\x1b[Kfour-bar: 448 of 825 designs, " in said
    assert b" s left ..." in said
    assert said.endswith(b"\r\x1b[K")


def test_progress_is_said_in_lines_where_there_is_no_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for long, said in ((0.0, "four-bar: 448 of 825 designs ...\nfour-bar: 2 of 3 polished ...\n"), (1e6, "")):
        monkeypatch.setattr(terminal, "LONG", long)
        progress = Progress("four-bar")
        progress("448 of 825 designs")
        progress("2 of 3 polished")
        progress.clear()
        assert capsys.readouterr().err == said


@pytest.mark.slow
@pytest.mark.usefixtures("no_pictures")
def test_a_sweep_whose_standard_error_is_piped_says_how_far_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(terminal, "LONG", 0.0)
    assert main(["sweep", str(written(tmp_path)), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    assert "four-bar: 448 of 825 designs, " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.4, "0 s"), (89.0, "89 s"), (91.0, "2 min"), (5000.0, "83 min"), (12_000.0, "3 h 20 min")]
)
def test_the_time_left_is_as_coarse_as_it_is_uncertain(seconds: float, text: str) -> None:
    assert sweep.duration(seconds) == text


def test_jobs_and_a_scheduler_exclude_each_other(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main(["sweep", str(written(tmp_path)), "--jobs", "2", "--scheduler", "tcp://a:1"])
    assert stop.value.code == 2
    assert "not allowed with argument" in capsys.readouterr().err


def test_the_time_left_is_told_from_the_speed_so_far() -> None:
    told: list[str] = []
    tell = sweep._progress_listener(told.append)
    tell("designs", 0, 40_000, 0.0)
    tell("designs", 10_000, 40_000, 20.0)
    tell("chunks", 1, 4, 60.0)
    assert told == [
        "0 of 40,000 designs",
        "10,000 of 40,000 designs, 500 a second, 60 s left",
        "1 of 4 chunks, 3 min left",
    ]
