"""New files beside an old report are reported by `verify` and `check`: after a kill, or by hand."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from camgeo.cli.main import main
from camgeo.output.mixture import mixtures

RECIPE = "cam: {kind: support, p: 25 + 2*cos(3*t)}\nexport: {tolerance: 0.01, files: [dxf, csv]}\n"
# an export that is killed as it puts the report in its place, when all other files are
KILLED = """
import os, sys
from pathlib import Path
from camgeo.output import output_folder as store
move = store._move
def killed(source, target):
    if target.name == "report.json":
        os._exit(9)
    move(source, target)
store._move = killed
from camgeo.cli.main import main
main(sys.argv[1:])
"""


@pytest.fixture
def recipe(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "cam.yaml"
    path.write_text(RECIPE, encoding="utf-8")
    assert main(["export", "cam.yaml"]) == 0
    return path


def said_of(capsys: pytest.CaptureFixture[str], *call: str) -> str:
    assert main(list(call)) == 0
    return capsys.readouterr().err


@pytest.mark.slow
def test_killed_before_the_last_rename(recipe: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert said_of(capsys, "verify", "cam.yaml", "out/cam/cam.dxf") == ""
    assert said_of(capsys, "check", "cam.yaml") == ""
    recipe.write_text(RECIPE.replace("2*cos", "2.1*cos"), encoding="utf-8")
    done = subprocess.run([sys.executable, "-c", KILLED, "export", "cam.yaml"], check=False)
    assert done.returncode == 9
    report = Path("out/cam/report.json")
    told = (
        f"{report}: cam.dxf, cam.csv are not the files that it lists: a run was killed between two sets of files; "
        "export again"
    )
    for call in (["verify", "cam.yaml", "out/cam/cam.dxf"], ["check", "cam.yaml"], ["check", "cam.yaml", "--json"]):
        assert main(call) == 0  # the verdict is of the file
        said = capsys.readouterr()
        assert said.err == f"camgeo: {told}\n"
    assert json.loads(said.out)[0]["mixed"] == [told]
    assert main(["export", "cam.yaml"]) == 0  # the remedy
    assert said_of(capsys, "verify", "cam.yaml", "out/cam/cam.dxf") == ""
    assert said_of(capsys, "check", "cam.yaml") == ""


@pytest.mark.slow
def test_changed_or_taken_away_by_hand(recipe: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = recipe.parent / "out" / "cam" / "cam.csv"
    table.write_text("mine\n", encoding="utf-8")
    why = "is not the file that it lists: changed since, or of another run; export again"
    assert said_of(capsys, "check", "cam.yaml") == f"camgeo: out/cam/report.json: cam.csv {why}\n"
    table.unlink()
    assert said_of(capsys, "check", "cam.yaml", "--out", "out").endswith(f"cam.csv {why}\n")
    assert said_of(capsys, "check", "cam.yaml", "--out", "elsewhere") == ""


def test_what_is_no_more_as_its_report_lists_it_is_told_where_a_file_beside_it_is_judged(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "cam.yaml").write_text(RECIPE.replace("[dxf, csv]", "[dxf, svg]"), encoding="utf-8")
    path, folder = str(tmp_path / "cam.yaml"), tmp_path / "out" / "cam"
    assert main(["export", path, "--out", str(tmp_path / "out")]) == 0
    capsys.readouterr()
    assert said_of(capsys, "verify", path, str(folder / "cam.dxf")) == ""
    drawing = folder / "cam.svg"
    drawing.write_text(drawing.read_text("utf-8") + "\n", encoding="utf-8")
    told = said_of(capsys, "verify", path, str(folder / "cam.dxf"))
    assert told.startswith(f"camgeo: {folder}/report.json: cam.svg is not the file that it lists")
    (folder / "mine.dxf").write_bytes((folder / "cam.dxf").read_bytes())  # of which the report says nothing
    assert said_of(capsys, "verify", path, str(folder / "mine.dxf")) == ""


# needs: study
@pytest.mark.slow
def test_studies_and_pages_too(recipe: Path) -> None:
    pytest.importorskip("matplotlib")
    assert main(["study", "cam.yaml", "--form", "arcs", "--patience", "0.001"]) == 0
    assert main(["report", "cam.yaml"]) == 0
    folder = recipe.parent / "out" / "cam"
    assert mixtures(folder) == []
    for name in ("study.png", "page.html"):
        (folder / name).write_bytes(b"other")
    assert [told.split(": ")[1].split()[0] for told in mixtures(folder)] == ["page.html", "study.png"]
    assert mixtures(folder, ["cam.dxf"]) == []


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        '{"files": 3}',
        '{"files": [{"path": 3, "sha256": "x"}]}',
        '{"files": [{"path": "../x", "sha256": ""}]}',
    ],
)
def test_what_is_no_report_says_nothing(tmp_path: Path, text: str) -> None:
    (tmp_path / "report.json").write_text(text, encoding="utf-8")
    assert mixtures(tmp_path) == []
    assert mixtures(tmp_path / "nowhere") == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "report.json")
    os.mkfifo(tmp_path / "cam.dxf")
    assert mixtures(tmp_path) == []
    (tmp_path / "page.json").write_text('{"files": [{"path": "cam.dxf", "sha256": "x"}]}', encoding="utf-8")
    assert len(mixtures(tmp_path)) == 1
