"""The first split of docs/budget.md, from the question to the profile of a drawing, as the page prints it."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from support.places import ROOT

from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


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
    # and what is left, rounded as a drawing has it, is kept
    (tmp_path / "cam.yaml").write_text(recipe.replace("profile: free", "profile: 0.012"), encoding="utf-8")
    assert main(["budget", "cam.yaml"]) == 0
