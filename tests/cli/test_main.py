"""The command line: exit status, what is printed where, what is left on disk.

Holds: camgeo.cli.exit_status, camgeo.common.errors, camgeo.recipe.loading.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
from support.cases import few
from support.starters import OF_CAMS

from camgeo.cli.main import main
from camgeo.recipe.starter import STARTERS, starter
from camgeo.registry import registry

if TYPE_CHECKING:
    from pathlib import Path

GOOD = """\
cam: {kind: support, p: 25 + 2*cos(3*t)}
part: {thickness: 8, bore: 10}
export: {tolerance: 0.01, files: [dxf, stl]}
"""


@pytest.fixture
def good(tmp_path: Path) -> Path:
    path = tmp_path / "good.yaml"
    path.write_text(GOOD, encoding="utf-8")
    return path


def test_export_says_one_line_and_exits_0(good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(good), "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr()
    assert said.out.startswith("good: ok  dxf ")
    assert said.out.count("\n") == 1
    assert said.err == ""
    assert {p.name for p in (tmp_path / "out" / "good").iterdir()} == {"good.dxf", "good.stl", "report.json"}


def test_json_is_the_reports(good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(good), "--out", str(tmp_path / "out"), "--json"]) == 0
    (report,) = json.loads(capsys.readouterr().out)
    assert report == json.loads((tmp_path / "out" / "good" / "report.json").read_text(encoding="utf-8"))


def test_check_writes_nothing(good: Path, tmp_path: Path) -> None:
    before = sorted(tmp_path.rglob("*"))
    assert main(["check", str(good), "-v"]) == 0
    assert sorted(tmp_path.rglob("*")) == before


def test_only_keeps_the_other_files_and_marks_them_stale(good: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["export", str(good), "--out", str(out)]) == 0
    stl = (out / "good" / "good.stl").read_bytes()
    assert main(["export", str(good), "--out", str(out), "--only", "dxf", "--tolerance", "0.1"]) == 0
    report = json.loads((out / "good" / "report.json").read_text(encoding="utf-8"))
    assert [file["path"] for file in report["files"] if file.get("stale")] == ["good.stl"]
    assert (out / "good" / "good.stl").read_bytes() == stl
    assert report["tolerance"] == pytest.approx(0.1)


@pytest.mark.slow
def test_a_users_own_file_stays(good: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["export", str(good), "--out", str(out)]) == 0
    (out / "good" / "notes.txt").write_text("mine", encoding="utf-8")
    assert main(["export", str(good), "--out", str(out)]) == 0
    assert (out / "good" / "notes.txt").read_text(encoding="utf-8") == "mine"


@pytest.mark.slow
def test_a_typo_exits_2_with_its_place_and_leaves_the_last_set(
    good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["export", str(good), "--out", str(out)]) == 0
    before = {p.name: p.read_bytes() for p in (out / "good").iterdir()}
    good.write_text(GOOD.replace("tolerance", "tolerence"), encoding="utf-8")
    capsys.readouterr()
    assert main(["export", str(good), "--out", str(out)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert f"{good}:3:" in said.err
    assert "tolerance" in said.err
    assert "Traceback" not in said.err
    assert {p.name: p.read_bytes() for p in (out / "good").iterdir()} == before
    assert sorted(p.name for p in out.iterdir() if not p.name.startswith(".")) == ["good"]


def test_undercut_exits_1_and_keeps_the_last_good_set(good: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert main(["export", str(good), "--out", str(out)]) == 0
    before = {p.name: p.read_bytes() for p in (out / "good").iterdir()}
    good.write_text(GOOD.replace("25 +", "15 +"), encoding="utf-8")
    assert main(["export", str(good), "--out", str(out)]) == 1
    assert {p.name: p.read_bytes() for p in (out / "good").iterdir()} == before
    assert (out / "good.rejected" / "report.json").is_file()


@pytest.mark.parametrize("verbose", [[], ["-v"]])
def test_a_failing_run_says_what_helps_and_where_its_files_are(
    good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], verbose: list[str]
) -> None:
    """A face that is too narrow; as wide as the remedy says, it will do."""
    out = tmp_path / "out"
    good.write_text(
        "cam: {kind: disc, base_radius: 20, follower: {kind: flat, width: 4},\n"
        "  motion: [{rise: 6, over: 180, law: cycloidal}, {return: 6, over: 180, law: cycloidal}]}\n"
        "export: {files: [csv]}\n",
        encoding="utf-8",
    )
    assert main(["export", str(good), "--out", str(out), *verbose]) == 1
    told = capsys.readouterr().out.splitlines()
    (remedy,) = [line for line in told if line.startswith("  remedy for face-width: ")]
    assert remedy.endswith(f" mm or more ({good}:1:66)")
    assert f"  the files of this run are in {out / 'good'}.rejected; {out / 'good'} is left as it was" in told
    assert told[-1 if verbose else 0].startswith("good: FAILED")
    assert (out / "good.rejected" / "good.csv").is_file()
    wide = re.search(r"width of ([0-9.]+) mm", remedy)
    assert wide is not None
    good.write_text(good.read_text(encoding="utf-8").replace("width: 4", f"width: {wide[1]}"), encoding="utf-8")
    assert main(["export", str(good), "--out", str(out)]) == 0
    assert "rejected" not in capsys.readouterr().out


def test_two_recipes_of_one_name_are_an_error(good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = tmp_path / "deeper" / "good.yaml"
    other.parent.mkdir()
    other.write_text(GOOD, encoding="utf-8")
    assert main(["export", str(good), str(other), "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err.splitlines()
    assert [line.split(": ")[1] for line in said] == [str(good), str(other)]
    assert all("the name good is used by several recipes" in line for line in said)
    assert not (tmp_path / "out").exists()


def test_several_recipes_run_in_order_and_the_highest_status_counts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = []
    for name, mean in (("a", 25), ("b", 15), ("c", 30), ("d", 26)):
        path = tmp_path / f"{name}.yaml"
        path.write_text(GOOD.replace("25", str(mean)), encoding="utf-8")
        paths.append(str(path))
    assert main(["export", *paths, "--out", str(tmp_path / "out"), "--jobs", "2"]) == 1
    lines = [line for line in capsys.readouterr().out.splitlines() if not line.startswith(" ")]
    assert [line.split(":")[0] for line in lines] == ["a", "b", "c", "d"]


def test_verify_judges_a_file_and_says_what_is_wrong(
    good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["export", str(good), "--out", str(out)]) == 0
    dxf = out / "good" / "good.dxf"
    assert main(["verify", str(good), str(dxf), str(out / "good" / "good.stl")]) == 0
    other = tmp_path / "other.yaml"
    other.write_text(GOOD.replace("2*cos", "2.05*cos"), encoding="utf-8")
    capsys.readouterr()
    assert main(["verify", str(other), str(dxf)]) == 1
    assert "motion" in capsys.readouterr().out
    assert main(["verify", str(good), str(tmp_path / "nothing.dxf")]) == 2
    assert main(["verify", str(good), str(good)]) == 2


@pytest.mark.thin(12)
@pytest.mark.parametrize("kind", few(OF_CAMS, 3))
def test_new_gives_a_recipe_that_passes(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"my-{kind}.yaml"
    assert main(["new", kind, str(path)]) == 0
    assert main(["check", str(path)]) == 0, kind
    assert main(["new", kind, str(path)]) == 2


def test_new_names_the_kinds_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    """Each with a line of words; a kind of cam with several starters has those of its own."""
    assert main(["new", "plumbus"]) == 2
    assert "support" in capsys.readouterr().err
    assert main(["new", "Square"]) == 2  # a word that stands beside some of them
    assert capsys.readouterr().err.endswith("there is reuleaux, four-bar, inverted-slider-crank and slider-crank\n")
    assert main(["new"]) == 0
    rows = [line.split(None, 1) for line in capsys.readouterr().out.splitlines()]
    assert {*OF_CAMS} <= {name for name, _ in rows}
    assert all(len(words) > 20 and words.endswith(".") for _, words in rows)
    assert main(["new", "disc"]) == 0
    discs = [line.split(None, 1) for line in capsys.readouterr().out.splitlines()]
    assert discs == [row for row in rows if row[0] in STARTERS and STARTERS[row[0]].kind == "disc"]
    assert len(discs) >= 10


def test_a_kind_of_several_starters_is_no_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "disc", str(tmp_path / "cam.yaml")]) == 2
    assert "no starter for 'disc'; there is disc-roller, toy, disc-flat, " in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_dash_is_the_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "disc-flat", "-"]) == 0
    assert capsys.readouterr().out == starter("disc-flat")
    assert not list(tmp_path.iterdir())


# needs: camshaft
@pytest.mark.slow
def test_a_camshaft_to_start_from_and_its_lobe(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The title of the starter says how to make the recipe of its lobes."""
    monkeypatch.chdir(tmp_path)
    assert main(["new", "camshaft", "shaft.yaml"]) == 0
    (words,) = re.findall("`camgeo ([^`]+)`", starter("camshaft"))
    assert main(words.split()) == 0
    assert main(["check", "shaft.yaml"]) == 0


@pytest.mark.slow
def test_laws_and_schema(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["laws"]) == 0
    assert "modified-sine" in capsys.readouterr().out
    assert main(["laws", "--json"]) == 0
    peaks = {row["law"]: row for row in json.loads(capsys.readouterr().out)}
    assert peaks["modified-constant-velocity"]["velocity"] == pytest.approx(1.275258, abs=1e-6)
    assert peaks["parabolic"]["jerk"] is None
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out)["required"] == ["cam"]


# needs: camshaft
def test_schema_of_a_camshaft(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", "camshaft"]) == 0
    shaft = json.loads(capsys.readouterr().out)
    assert shaft["required"] == ["camshaft"]
    assert set(shaft["properties"]["camshaft"]["properties"]) == {"shaft", "journals", "lobes", "engine"}


def test_a_call_without_a_command_says_where_they_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main([])
    said = capsys.readouterr().err
    assert left.value.code == 2
    assert "camgeo --help lists them, camgeo new" in said
    assert main(["new"]) == 0
    assert "disc-roller" in capsys.readouterr().out


@pytest.mark.thin(2)
@pytest.mark.parametrize("arguments", [[], ["export"], ["dance"], ["export", "x.yaml", "--tolerance", "-1"]])
def test_a_wrong_call_exits_2(arguments: list[str]) -> None:
    done = subprocess.run([sys.executable, "-m", "camgeo", *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


def test_an_output_that_is_no_folder_exits_3(good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    blocked = tmp_path / "blocked"
    blocked.write_text("a file", encoding="utf-8")
    assert main(["export", str(good), "--out", str(blocked)]) == 3
    assert "blocked" in capsys.readouterr().err


def test_only_of_what_the_recipe_does_not_list_exits_2(
    good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", str(good), "--out", str(tmp_path / "out"), "--only", "csv"]) == 2
    assert f"{good}:3:" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_verify_says_what_is_wrong_with_what_is_no_file(
    good: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    missing = tmp_path / "none.dxf"
    assert main(["verify", str(good), str(tmp_path), str(missing)]) == 2
    assert capsys.readouterr().err.splitlines() == [
        f"camgeo: {tmp_path}: a folder; name the files in it",
        f"camgeo: {missing}: the file does not exist",
    ]


def test_the_module_is_the_command() -> None:
    call = subprocess.run(
        [sys.executable, "-m", "camgeo", "new", "nothing"], capture_output=True, text=True, check=False
    )
    assert call.returncode == 2
    assert call.stderr.startswith("camgeo: no starter for 'nothing'; there is disc-roller, toy, ")


ADDED = [command for label in registry.labels().values() for command in label.commands]
EMPTY = {
    "export, out": ["export", "{recipe}", "--out", ""],
    "check, out": ["check", "{recipe}", "--out", ""],
    "report, out": ["report", "{recipe}", "--out", ""],
    # needs: study
    "study, out": ["study", "{recipe}", "--out", ""],
    # needs: sweep
    "sweep, out": ["sweep", "{recipe}", "--out", ""],
    # needs: sweep
    "sweep, scheduler": ["sweep", "{recipe}", "--scheduler", ""],
    "verify, file": ["verify", "{recipe}", ""],
    "new, file": ["new", "support", ""],
    "laws, picture": ["laws", "--picture", ""],
    **{command: [command, ""] for command in ("export", "check", "report", *ADDED)},
    "verify": ["verify", "", "x.dxf"],
    "watch": ["export", "--watch", ""],
}


@pytest.mark.parametrize("call", EMPTY.values(), ids=EMPTY.keys())
def test_an_empty_name_is_a_wrong_call(
    call: list[str], good: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(good.parent)
    try:
        status: object = main([argument.format(recipe=good) for argument in call])
    except SystemExit as ended:
        status = ended.code
    assert status == 2
    assert "an empty name" in capsys.readouterr().err.splitlines()[-1]
    assert [path.name for path in good.parent.iterdir()] == ["good.yaml"]


def test_a_starter_that_is_misspelled_names_the_near_one(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "disc-rollr"]) == 2
    assert capsys.readouterr().err == "camgeo: no starter for 'disc-rollr'; did you mean disc-roller?\n"


UNDERSCORED = [
    ["report", "r.yaml", "--at"],
    ["study", "r.yaml", "--patience"],  # needs: study
]


@pytest.mark.parametrize("call", UNDERSCORED)
def test_digits_with_an_underscore_are_no_number(call: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main([*call, "1_0"])
    assert ended.value.code == 2
    assert "a number of" in capsys.readouterr().err
