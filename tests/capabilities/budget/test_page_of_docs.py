"""The split of docs/budget.md, from the question to a confirmed drawing, as the page prints it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import ezdxf
import pytest
from support.places import ROOT

from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.costly("the commands of the page as they stand there")
def test_the_page_shows_what_the_command_prints(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (ROOT / "docs" / "budget.md").read_text(encoding="utf-8")
    recipe, *_ = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    shown, *_ = re.findall(r"```text\n\$ camgeo budget cam.yaml\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cam.yaml").write_text(recipe, encoding="utf-8")
    assert main(["budget", "cam.yaml"]) == 0
    assert capsys.readouterr().out == shown


# needs: sheet
@pytest.mark.slow
def test_the_split_goes_on_to_a_drawing_that_is_confirmed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each command that the page shows prints what the page shows; the drawing asks for what was found."""
    page = (ROOT / "docs" / "budget.md").read_text(encoding="utf-8").split("## From the question to the drawing")[1]
    recipe, *_ = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    shown, *_ = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cam.yaml").write_text(recipe, encoding="utf-8")
    steps = re.findall(r"^\$ camgeo (.*)\n((?:(?!\$).*\n)*)", shown, re.MULTILINE)
    assert [words.split()[0] for words, _ in steps] == ["export", "budget", "verify"]
    for words, output in steps:
        assert main(words.split()) == 0
        assert capsys.readouterr().out == output
    texts = [entity.dxf.text for entity in ezdxf.readfile("out/cam/cam-sheet.dxf").modelspace().query("TEXT")]
    assert {"0.022", "A", "C-35"} <= set(texts)
