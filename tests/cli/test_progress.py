"""What is said of a run as it goes on."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest

from camgeo.cli import progress
from camgeo.cli.main import main
from camgeo.cli.progress import Progress

if TYPE_CHECKING:
    from pathlib import Path


def test_a_stage_that_takes_long_is_said_as_it_goes_on(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(progress, "LONG", 0.2)
    run = Progress("cam")
    run("fit arcs")
    run("judge dxf")
    deadline = time.monotonic() + 20.0
    said = ""
    while not said and time.monotonic() < deadline:
        time.sleep(0.02)
        said = capsys.readouterr().err
    run("table")
    run.clear()
    assert said == "cam: judge dxf takes more than 0.2 s ...\n"
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("command", ["export", "check", "verify"])
def test_runs_of_many_angles_say_what_they_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    recipe = tmp_path / "cam.yaml"
    recipe.write_text("cam: {kind: support, p: 25 + cos(3*t)}\nverify: {angles: 20000}\n")
    assert main(["export", str(recipe), "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(progress, "LONG", 0.0)
    files = (
        [str(tmp_path / "cam" / "cam.dxf")] if command == "verify" else ["--out", str(tmp_path)] * (command == "export")
    )
    assert main([command, str(recipe), *files]) == 0
    assert "cam: judge" in capsys.readouterr().err
