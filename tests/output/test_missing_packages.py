"""Files that a missing package would make: left out beforehand, named, and the rest is one set."""

from __future__ import annotations

import json
import sys
from typing import TYPE_CHECKING

import pytest

import camgeo
from camgeo.cli.exit_status import FAILED, OK, SURROUNDINGS
from camgeo.cli.main import main
from camgeo.registry.formats import FORMATS

if TYPE_CHECKING:
    from pathlib import Path

HUBBED = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 10, hub: {diameter: 18, height: 4}}\n"
PLAIN = (
    "cam: {kind: support, p: 25 + 2*cos(3*t)}\n"
    "part: {thickness: 8, bore: 10, keyway: {width: 3, depth: 1.4}, lightening: {ring: 5, wall: 2}}\n"
)
SOLIDS = "this part needs solids to be joined and cut: pip install manifold3d"
MESHES = [name for name, record in FORMATS.items() if record.mesh]
NAMES = {"stl": "manifold3d", "step": "OCP", "dxf": "ezdxf"}


@pytest.fixture
def bare(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("manifold3d", "OCP"):
        monkeypatch.setitem(sys.modules, name, None)


def written(folder: Path, text: str, files: str) -> Path:
    path = folder / "cam.yaml"
    path.write_text(f"{text}export: {{tolerance: 0.01, files: [{files}]}}\nverify: {{angles: 360}}\n", encoding="utf-8")
    return path


@pytest.mark.usefixtures("bare")
def test_the_rest_is_judged_and_placed(tmp_path, capsys):
    path = written(tmp_path, HUBBED, f"dxf, {', '.join(MESHES)}, step, html")
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == SURROUNDINGS
    said = capsys.readouterr()
    assert said.out.startswith("cam: ok  dxf")
    lines = [f"camgeo: cam: cam.{kind} is left out: {SOLIDS}" for kind in MESHES]
    told = [line for line in said.err.splitlines() if line.startswith("camgeo: ")]  # beside the stages of a slow run
    assert told[: len(lines)] == lines
    assert told[len(lines)].startswith("camgeo: cam: cam.step is left out: a STEP file needs Open CASCADE")
    assert sorted(file.name for file in (tmp_path / "out/cam").iterdir()) == ["cam.dxf", "cam.html", "report.json"]
    report = json.loads((tmp_path / "out/cam/report.json").read_text("utf-8"))
    assert report["ok"]
    assert report["skipped"][0] == {"what": "cam.stl", "why": SOLIDS, "missing": True}
    assert "cam.stl" in (tmp_path / "out/cam/cam.html").read_text("utf-8")


@pytest.mark.usefixtures("bare")
def test_a_file_that_fails_rejects_the_set_all_the_same(tmp_path):
    path = written(tmp_path, HUBBED, "dxf, stl")
    path.write_text(path.read_text("utf-8") + "limits: {size: {at_most: 10}}\n", encoding="utf-8")
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == FAILED
    assert [folder.name for folder in (tmp_path / "out").iterdir()] == ["cam.rejected"]


@pytest.mark.thin(2)
@pytest.mark.usefixtures("bare")
@pytest.mark.parametrize("command", ["export", "check"])
def test_where_no_file_can_be_made_nothing_is_written(tmp_path, capsys, command):
    path = written(tmp_path, HUBBED, "stl, step")
    assert main([command, str(path), "--out", str(tmp_path / "out")]) == SURROUNDINGS
    assert capsys.readouterr().err == f"camgeo: cam: {path}: {SOLIDS}\n"
    assert not (tmp_path / "out/cam").exists()


@pytest.mark.slow
@pytest.mark.usefixtures("bare")
def test_a_plain_part_needs_no_solids(tmp_path, capsys):
    """Nor do a keyway and holes."""
    path = written(tmp_path, PLAIN, ", ".join(MESHES))
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == OK, capsys.readouterr()
    report = json.loads((tmp_path / "out/cam/report.json").read_text("utf-8"))
    assert {check["name"] for check in report["checks"]} >= {"watertight", "holes", "volume"}


# needs: mechanism
@pytest.mark.usefixtures("bare")
def test_a_set_to_print_needs_them(tmp_path, capsys):
    path = tmp_path / "cam.yaml"
    path.write_text(camgeo.load("recipes/print-yoke.yaml").text, encoding="utf-8")
    assert main(["check", str(path)]) == SURROUNDINGS
    assert SOLIDS in capsys.readouterr().err


@pytest.mark.thin(2)
@pytest.mark.parametrize("kind", NAMES)
def test_the_library_says_why(tmp_path, monkeypatch, kind):
    monkeypatch.setitem(sys.modules, NAMES[kind], None)
    report = camgeo.export(written(tmp_path, HUBBED, f"svg, {kind}"), tmp_path / "out")
    assert report.ok
    assert list(report.missing) == [f"cam.{kind}"]
    assert [file.name for file in report.files] == ["cam.svg"]


def test_a_reader_that_is_missing_is_an_error_of_the_surroundings(tmp_path, monkeypatch):
    path = written(tmp_path, HUBBED, "dxf")
    report = camgeo.export(path, tmp_path / "out")
    for name in [name for name in sys.modules if name.partition(".")[0] == "ezdxf"]:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(camgeo.SurroundingsError, match="the package ezdxf is missing: pip install ezdxf"):
        camgeo.verify(path, report.path / "cam.dxf")
