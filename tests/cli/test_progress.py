"""What is said of a run as it goes on."""

from __future__ import annotations

import os
import signal
import threading
import time
from typing import TYPE_CHECKING

import pytest

from camgeo.cli import progress
from camgeo.cli.main import main
from camgeo.cli.progress import Progress

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def patient() -> None:
    """Seconds are those of the product here."""


def test_a_stage_that_takes_long_is_said_as_it_goes_on(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Progress("cam")
    monkeypatch.setattr(progress, "LONG", 3600.0)  # however slow the machine is
    run("fit arcs")
    monkeypatch.setattr(progress, "LONG", 0.2)
    run("judge dxf")
    deadline = time.monotonic() + 20.0
    said = ""
    while not said and time.monotonic() < deadline:
        time.sleep(0.02)
        said = capsys.readouterr().err
    monkeypatch.setattr(progress, "LONG", 3600.0)
    run("table")
    run.clear()
    assert said == "cam: judge dxf ...\n"
    assert capsys.readouterr().err == ""


def test_short_stages_of_a_long_run_are_said_from_time_to_time(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As of a camshaft of many lobes, each of which takes little: at 0, 4, 8, .. s a stage, a line after each 10 s."""
    now = 0.0
    monkeypatch.setattr(time, "perf_counter", lambda: now)
    run = Progress("shaft")
    for number in range(9):
        now = 4.0 * number
        run(f"lobe {number}")
    run.clear()
    assert capsys.readouterr().err == "shaft: lobe 3 ...\nshaft: lobe 6 ...\n"


@pytest.mark.slow
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


def test_an_interrupt_as_the_timer_starts_is_the_run_s_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """Clearing up after it must not fail: `threading` waits for no thread whose start did not come to its end."""
    run = Progress("cam")
    started = threading.Thread.start

    def interrupted(thread: threading.Thread) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        started(thread)

    monkeypatch.setattr(threading.Thread, "start", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run("fit arcs")
    run.clear()
