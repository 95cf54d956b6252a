"""`camgeo laws`: every law with its peaks; pictures on request."""

import json
import sys
import xml.etree.ElementTree as ET

import pytest

from camgeo.cli.main import main
from kin.law.sources.laws import NAMES, named
from kin.law.sources.peaks import peaks

SVG = "{http://www.w3.org/2000/svg}"


def test_every_law_is_listed_with_its_peaks(capsys):
    assert main(["laws"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines[1 : 1 + len(NAMES)]] == list(NAMES)
    (line,) = [line for line in lines if line.startswith("gutman-13")]
    assert line.split()[1:4] == ["2.000000", "5.130199", "59.2176"]
    assert main(["laws", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["law"] for row in rows] == list(NAMES)
    by = {row["law"]: row for row in rows}
    assert by["freudenstein-135"]["acceleration"] == peaks(named("freudenstein-135").motion).acceleration
    assert by["constant-velocity"]["acceleration"] is None


def test_laws_by_name(capsys):
    assert main(["laws", "cubic", "trapezoid"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 5
    assert main(["laws", "trapezium"]) == 2
    assert "no law is called 'trapezium'; did you mean trapezoid?" in capsys.readouterr().err


@pytest.mark.slow
def test_a_picture_shows_each_law_with_four_curves(tmp_path, capsys):
    path = tmp_path / "laws.svg"
    assert main(["laws", "--picture", str(path)]) == 0
    root = ET.parse(path).getroot()
    frames = root.findall(f"{SVG}g")
    assert [frame.findtext(f"{SVG}text") for frame in frames] == list(NAMES)
    for frame, name in zip(frames, NAMES, strict=True):
        curves = [path for path in frame.findall(f"{SVG}path") if path.find(f"{SVG}title") is not None]
        assert [path.findtext(f"{SVG}title") for path in curves] == ["jerk", "acceleration", "velocity", "displacement"]
        # a stretch each, so that no jump is drawn slanted
        assert all(path.get("d").count("M") == len(named(name).motion.functions) for path in curves)
        assert curves[3].get("d").startswith("M0.00 95.00L")
        assert curves[3].get("d").endswith("220.00 30.00")
    first = path.read_bytes()
    assert main(["laws", "--picture", str(path)]) == 0
    assert path.read_bytes() == first
    capsys.readouterr()


@pytest.mark.slow
def test_a_picture_by_matplotlib(tmp_path):
    pytest.importorskip("matplotlib")
    path = tmp_path / "laws.png"
    assert main(["laws", "cycloidal", "--picture", str(path)]) == 0
    assert path.read_bytes().startswith(b"\x89PNG")


def test_pictures_that_cannot_be(tmp_path, capsys, monkeypatch):
    assert main(["laws", "--picture", str(tmp_path / "laws.gif")]) == 2
    assert "a picture is .svg or .png" in capsys.readouterr().err
    assert main(["laws", "--picture", str(tmp_path / "none" / "laws.svg")]) == 3
    assert "No such file or directory" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["laws", "--picture", str(tmp_path / "laws.png")]) == 3
    assert "the package matplotlib is missing: pip install '.[picture]' in a clone of camgeo" in capsys.readouterr().err
