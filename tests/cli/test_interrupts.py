"""Ctrl-C at any moment: status 130, one line on standard error, no traceback, nothing left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from typing import TYPE_CHECKING

import pytest
from support.places import RECIPES

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals are sent to a process group")
RECIPE = """\
cam: {kind: support, p: 25 + 2*cos(3*t)}
part: {thickness: 8, bore: 10}
export: {tolerance: 0.00001, files: [dxf, stl, 3mf, svg]}
"""
# says when interrupts are heard: Python's own start, before, is not the command's
UP = """
from camgeo import __main__ as entry
from camgeo.cli import batch
batch.PAYS = batch.FORKED = -1.0  # processes from the second recipe on
listen = entry._Interrupts.listen
def up(self):
    listen(self)
    print("up", flush=True)
entry._Interrupts.listen = up
entry.main()
"""


SWALLOWED = """
import os, signal, weakref
import camgeo.cli.main as cli
def schema(_):
    class Gone: pass
    gone = Gone()
    said = weakref.ref(gone, lambda _: os.kill(os.getpid(), signal.SIGINT))
    del gone
    return 0
cli._schema = schema
"""
SWALLOWED_TWICE = (
    """
import os, signal, threading
timer = threading.Timer
def while_it_is_swallowed(delay, call):
    threading.Timer = timer
    os.kill(os.getpid(), signal.SIGINT)
    return timer(delay, call)
threading.Timer = while_it_is_swallowed
"""
    + SWALLOWED
)
TURNED = """
import os, signal
import camgeo.cli.main as cli
def schema(_):
    try:
        os.kill(os.getpid(), signal.SIGINT)
    except KeyboardInterrupt:
        raise ImportError("could not import module datetime") from None
cli._schema = schema
"""


def recipes(folder: Path, count: int) -> list[str]:
    paths = [folder / f"cam-{i}.yaml" for i in range(count)]
    for path in paths:
        path.write_text(RECIPE, encoding="utf-8")
    return [str(path) for path in paths]


def interrupted(arguments: list[str], delay: float, times: int = 1) -> tuple[int, str]:
    """Status and standard error of a command whose whole group is interrupted so many seconds after it is up."""
    with subprocess.Popen(
        [sys.executable, "-c", UP, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "up\n"
        time.sleep(delay)
        for _ in range(times):
            os.killpg(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=60)
    return process.returncode, said


def assert_quiet(found: tuple[int, str]) -> None:
    assert found == (130, "camgeo: interrupted\n")


@pytest.mark.thin(4)
@pytest.mark.parametrize("times", [1, 2])
@pytest.mark.parametrize("delay", [0.0, 0.03, 0.3])
def test_several_recipes(tmp_path: Path, delay: float, times: int) -> None:
    out = tmp_path / "out"
    assert_quiet(interrupted(["export", *recipes(tmp_path, 12), "--jobs", "3", "--out", str(out)], delay, times))
    left = [] if not out.exists() else [path.name for path in out.iterdir() if path.name.startswith(".")]
    assert left == []


@pytest.mark.slow
@pytest.mark.parametrize("jobs", ["1", "3"])
def test_several_recipes_at_any_moment(tmp_path: Path, jobs: str) -> None:
    paths = recipes(tmp_path, 20)
    for step in range(20):
        assert_quiet(interrupted(["check", *paths, "--jobs", jobs], 0.04 * step))


# needs: sweep
@pytest.mark.slow
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_sweep(tmp_path: Path, jobs: str) -> None:
    path = tmp_path / "many.yaml"
    path.write_text((RECIPES / "sweep-four-bar.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    status, said = interrupted(["sweep", str(path), "--out", str(tmp_path / "out"), "--jobs", jobs], 0.4)
    assert status == 130
    assert said.count("\n") == 1
    assert "interrupted" in said


@pytest.mark.slow
@pytest.mark.parametrize(
    "late",
    [
        "import atexit, os, signal; atexit.register(lambda: os.kill(os.getpid(), signal.SIGINT))",
        # swallowed by a callback, as those of compiled libraries do; the run would go on to its end
        SWALLOWED,
        SWALLOWED_TWICE,  # the repeated one comes while the first is not yet put aside, as on a busy machine
        TURNED,  # into an error, as numpy does where its import is interrupted
    ],
)
def test_an_interrupt_that_would_be_lost(late: str) -> None:
    code = f"{late}\nfrom camgeo.__main__ import main\nmain()"
    done = subprocess.run(
        [sys.executable, "-c", code, "schema"], capture_output=True, text=True, encoding="utf-8", check=False
    )
    assert (done.returncode, done.stderr) == (130, "camgeo: interrupted\n")


def test_a_worker_stops_where_that_falls_into_a_callback() -> None:
    code = """
import os, signal, time, weakref
from multiprocessing import Pipe
from camgeo.common import workers
run = Pipe()
workers._be_a_worker(run[0], None, None)
def work(_):
    class Gone: pass
    gone = Gone()
    said = weakref.ref(gone, lambda _: os.kill(os.getpid(), signal.SIGINT))
    workers._State.over = True
    del gone
    for _ in range(600):
        time.sleep(0.1)
    return "went on"
print(workers._work_on(work, 0))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "None\n", "")


@pytest.mark.slow
def test_ignored_interrupts_stay_ignored(tmp_path: Path) -> None:
    """As `nohup` and a shell's background ask."""
    code = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)\n" + UP
    with subprocess.Popen(
        [sys.executable, "-c", code, "check", *recipes(tmp_path, 1)], stdout=subprocess.PIPE, start_new_session=True
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(0.2)
        os.killpg(process.pid, signal.SIGINT)
        process.communicate(timeout=60)
    assert process.returncode == 0
