"""docs/tour.md: its lines run one after another, and print what stands behind them; the files it names are there."""

from __future__ import annotations

import re
import shutil
from typing import TYPE_CHECKING

from support.places import RECIPES, ROOT

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

TEXT = (ROOT / "docs" / "tour.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


def test_each_line_prints_what_stands_behind_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "recipes").mkdir()
    shutil.copy(RECIPES / "disc-roller.yaml", tmp_path / "recipes")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in BLOCKS:
        exec(compile(block, "tour.md", "exec"), names)
    said = [line for block in BLOCKS for line in re.findall(r"^print\(.*\)  # (.*)$", block, re.MULTILINE)]
    assert capsys.readouterr().out.splitlines() == said
    assert len(said) == 8


def test_the_eight_objects_stand_where_the_page_says() -> None:
    assert [int(number) for number in re.findall(r"^\*\*(\d)\. ", TEXT, re.MULTILINE)] == list(range(1, 9))
    places = re.findall(r"`((?:camgeo|kin)/[\w/.]*)`", TEXT)
    assert len(places) >= 8
    assert [place for place in places if not (ROOT / place).exists()] == []
