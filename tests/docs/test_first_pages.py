"""The pages that begin from nothing: their recipes and commands print what stands there, their faults are told so."""

import re
import shlex

import pytest
from support.places import ROOT

from camgeo.cli.main import main


def blocks(page):
    """Language and text of each fenced block."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return re.findall(r"^```(\w+)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def run(line, capsys):
    """Exit status of a command of camgeo, and all that it prints."""
    capsys.readouterr()
    status = main(shlex.split(line)[1:])
    told = capsys.readouterr()
    return status, told.out + told.err


def recipe_of(page):
    ((name, text),) = [(text.split()[1], text) for language, text in blocks(page) if language == "yaml"]
    return name, text


def test_the_first_cam_is_made_and_its_mistakes_are_told(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    name, text = recipe_of("first-cam.md")
    good, angle, wall = [text for language, text in blocks("first-cam.md") if language == "text"]
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert run(f"camgeo export {name}", capsys) == (0, good)
    assert sorted(path.name for path in (tmp_path / "out" / "first").iterdir()) == [
        "first.html",
        "first.stl",
        "first.svg",
        "report.json",
    ]
    for before, after, status, told in [("over: 120", "over: 1200", 2, angle), ("radius: 30", "radius: 3", 1, wall)]:
        (tmp_path / name).write_text(text.replace(before, after, 1), encoding="utf-8")
        assert run(f"camgeo export {name}", capsys) == (status, told)
    assert (tmp_path / "out" / "first.rejected").is_dir()
    assert (tmp_path / "out" / "first" / "first.stl").is_file()


def test_callipers_find_what_the_page_says(tmp_path, monkeypatch, capsys):
    """Between bore and rim, over the middle of each dwell, from the triangles of the solid."""
    from support.heavy import trimesh

    monkeypatch.chdir(tmp_path)
    name, text = recipe_of("first-cam.md")
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert run(f"camgeo export {name} --only stl", capsys)[0] == 0
    vertices = trimesh.load("out/first/first.stl").vertices
    radii = (vertices[:, 0] ** 2 + vertices[:, 1] ** 2) ** 0.5
    bore = radii[radii < 10].max()
    page = (ROOT / "docs" / "first-cam.md").read_text(encoding="utf-8")
    low, high = (float(width) for width in re.findall(r"is (\d+\.\d) mm", page))
    rim = radii[radii > 10]
    assert rim.min() - bore == pytest.approx(low, abs=0.03)
    assert rim.max() - bore == pytest.approx(high, abs=0.03)


def test_a_file_is_judged_as_the_page_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    name, text = recipe_of("judge.md")
    shown = [text for language, text in blocks("judge.md") if language == "text"]
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert run(f"camgeo export {name}", capsys)[0] == 0
    assert run(f"camgeo verify {name} out/job/job.dxf out/job/job.stl", capsys) == (0, shown[0])
    changed = text.replace("rise: 15", "rise: 15.1").replace("return: 15", "return: 15.1")
    (tmp_path / name).write_text(changed, encoding="utf-8")
    assert run(f"camgeo verify {name} out/job/job.dxf", capsys) == (1, shown[1])
    (tmp_path / name).write_text(text, encoding="utf-8")
    inch = run(f"camgeo verify {name} out/job/job.stl --units inch", capsys)
    assert inch[0] == 1
    assert "the exact one 25.4 times as large" in inch[1]


# needs: follow
def test_a_file_is_followed_as_the_page_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    name, text = recipe_of("judge.md")
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert run(f"camgeo export {name}", capsys)[0] == 0
    (line,) = [text for language, text in blocks("judge.md") if language == "sh" and "camgeo follow" in text]
    assert run(line, capsys) == (0, [text for language, text in blocks("judge.md") if language == "text"][2])
    assert run("camgeo check found.yaml", capsys)[0] == 0
