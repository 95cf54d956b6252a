"""`camgeo report` of several recipes, and what it leaves of earlier calls."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path

CAM = "cam: {{kind: support, p: {p}}}\nexport: {{tolerance: 0.01, files: [dxf]}}\nverify: {{angles: 24}}\n"


@pytest.fixture
def recipes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, p in {"sound": "25 + cos(3*t)", "sharp": "25 + 5*cos(3*t)", "wrong": "25 + t"}.items():
        (tmp_path / f"{name}.yaml").write_text(CAM.format(p=p))
    return tmp_path


def test_several_recipes_have_a_page_each(recipes: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", "sound.yaml", "sharp.yaml"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.partition("  ")[0] for line in lines] == ["sound: ok", "sharp: FAILED"]
    assert all((recipes / "out" / name / "page.html").is_file() for name in ("sound", "sharp"))
    assert main(["report", "--json", "sound.yaml", "wrong.yaml", "none.yaml"]) == 2
    told = capsys.readouterr()
    assert [entry["recipe"] for entry in json.loads(told.out)] == ["sound", "wrong.yaml", "none.yaml"]
    assert [entry["ok"] for entry in json.loads(told.out)] == [True, False, False]
    assert "wrong.yaml:1:" in told.err
    assert "none.yaml: the file does not exist" in told.err


def test_one_recipe_twice_is_refused(recipes: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", "sound.yaml", "./sound.yaml"]) == 2
    assert "named twice in this call" in capsys.readouterr().err
    assert not (recipes / "out").exists()


@pytest.mark.slow
def test_pictures_of_an_earlier_call_stay(recipes: Path) -> None:
    folder = recipes / "out" / "sound"
    assert main(["report", "sound.yaml", "--picture", "svg"]) == 0
    picture = (folder / "page.svg").read_bytes()
    for _ in range(2):
        assert main(["report", "sound.yaml"]) == 0
        assert (folder / "page.svg").read_bytes() == picture
    (page, kept) = json.loads((folder / "page.json").read_text())["files"]
    assert page["path"] == "page.html"
    assert kept == {"path": "page.svg", "stale": True}
    assert main(["report", "sound.yaml", "--picture", "svg", "--at", "60"]) == 0
    assert (folder / "page.svg").read_bytes() != picture
