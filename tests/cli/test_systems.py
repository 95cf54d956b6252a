"""What Windows and macOS do otherwise, as far as it can be simulated here: links, open files, locks, processes."""

from __future__ import annotations

import json
import math
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from support.places import TESTS
from support.sets import NAME, export

from camgeo.cli import batch
from camgeo.cli.main import main
from camgeo.common import system, workers
from camgeo.common.errors import BusyError, SurroundingsError
from camgeo.output.output_folder import RunFolder

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

GOOD = "cam: {kind: support, p: 25 + 2*cos(3*t)}\nexport: {tolerance: 0.01, files: [dxf]}\n"


def generation(out: Path) -> int:
    return json.loads((out / NAME / "report.json").read_text(encoding="utf-8"))["generation"]


def test_a_system_that_has_no_link_to_a_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise NotImplementedError("link: follow_symlinks unavailable on this platform")

    monkeypatch.setattr(os, "link", refuse)
    for number in (1, 2):
        export(tmp_path, number)
        assert generation(tmp_path) == number


class Held:
    """A file that a program holds open: so many renames over it and removals of it are refused."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, name: str, times: int) -> None:
        self.left = times
        for step in ("replace", "unlink", "rename"):
            monkeypatch.setattr(os, step, self.refusing(getattr(os, step), name))
        monkeypatch.setattr(system, "WINDOWS", True)
        monkeypatch.setattr(system, "_PAUSES", (0.0, 0.0, 0.0))

    def refusing(self, real, name):
        def step(path, *more, **options):
            if self.left and name in {Path(part).name for part in (path, *more)} and Path(path).parent.name != ".old":
                self.left -= 1
                raise PermissionError(13, "The process cannot access the file because it is being used", str(path))
            return real(path, *more, **options)

        return step


def test_a_file_held_open_for_a_moment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    export(tmp_path, 1)
    held = Held(monkeypatch, "cam.dxf", 3)
    export(tmp_path, 2)
    assert held.left == 0
    assert generation(tmp_path) == 2


def test_a_file_held_open_for_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    export(tmp_path, 1)
    with monkeypatch.context() as patch:
        Held(patch, "cam.dxf", 10**6)
        with pytest.raises(SurroundingsError, match=r"open, close it there and run the command again|will try again"):
            export(tmp_path, 2)
    assert generation(tmp_path) == 1
    export(tmp_path, 3)
    assert generation(tmp_path) == 3
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


def test_an_open_lock_cannot_be_removed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Windows removes no file that is open: the lock is closed first, so that none stays behind."""
    opened: set[int] = set()
    real_open, real_close, real_unlink = os.open, os.close, os.unlink

    def open_(path, *more, **options):
        number = real_open(path, *more, **options)
        if str(path).endswith(".lock"):
            opened.add(number)
        return number

    def close(number):
        opened.discard(number)
        real_close(number)

    def unlink(path, *more, **options):
        if str(path).endswith(".lock") and opened:
            raise PermissionError(13, "in use", str(path))
        real_unlink(path, *more, **options)

    for name, step in (("open", open_), ("close", close), ("unlink", unlink)):
        monkeypatch.setattr(os, name, step)
    monkeypatch.setattr(system, "WINDOWS", True)
    export(tmp_path, 1)
    assert [path.name for path in tmp_path.iterdir()] == [NAME]


def test_a_lock_that_a_killed_run_left(tmp_path: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from camgeo.output.output_folder import RunFolder\n"
        f"with RunFolder(Path(sys.argv[1]), {NAME!r}): print('held', flush=True); time.sleep(60)"
    )
    with subprocess.Popen([sys.executable, "-c", code, str(tmp_path)], stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(BusyError), RunFolder(tmp_path, NAME):
            pass
        holder.kill()
    assert (tmp_path / f".{NAME}.lock").exists()
    export(tmp_path, 1)
    assert generation(tmp_path) == 1
    assert [path.name for path in tmp_path.iterdir()] == [NAME]


@pytest.mark.parametrize(
    ("platform", "wanted", "items", "started"),
    [("linux", 150, 2, 2), ("linux", 150, 150, 150), ("win32", 150, 150, 61), ("linux", 2, 9, 2), ("linux", 4, 0, 1)],
)
def test_no_more_processes_than_there_is_work_for(
    platform: str, wanted: int, items: int, started: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "platform", platform)
    assert workers.needed(wanted, items) == started


@pytest.mark.thin(2)
@pytest.mark.parametrize("method", ["as it is", "spawn"])
def test_two_more_recipes_take_two_processes(method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from concurrent.futures import ProcessPoolExecutor

    made = []
    begin = ProcessPoolExecutor.__init__

    def counted(self, count, context, *more):
        made.append((count, context.get_start_method()))
        begin(self, count, context, *more)

    monkeypatch.setattr(ProcessPoolExecutor, "__init__", counted)
    if method == "spawn":  # as on Windows
        monkeypatch.setattr(multiprocessing, "get_all_start_methods", lambda: ["spawn"])
        monkeypatch.setattr(workers, "FORKS", False)
    monkeypatch.setattr(batch, "PAYS", -1.0)
    monkeypatch.setattr(batch, "FORKED", -1.0)
    paths = [tmp_path / "a.yaml", tmp_path / "b.yaml", tmp_path / "c.yaml"]  # the first is made here
    for path in paths:
        path.write_text(GOOD, encoding="utf-8")
    assert main(["export", *map(str, paths), "--jobs", "150", "--out", str(tmp_path / "out")]) == 0
    assert [count for count, _ in made] == [2]
    assert method != "spawn" or made[0][1] == "spawn"


@pytest.mark.thin(2)
@pytest.mark.parametrize("jobs", [[], ["--jobs", "3"]])
@pytest.mark.parametrize("pays", [math.inf, 0.0])
def test_recipes_are_made_here_until_more_processes_pay(
    jobs: list[str], pays: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    counts = []
    begin = workers.pool

    def counted(count: int, *, fork: bool) -> AbstractContextManager[workers.Pool]:
        counts.append(count)
        assert not fork
        return begin(count, fork=fork)

    monkeypatch.setattr(workers, "may_fork", lambda: False)
    monkeypatch.setattr(workers, "pool", counted)
    monkeypatch.setattr(workers, "available", lambda: 2)
    monkeypatch.setattr(batch, "PAYS", pays)
    paths = [tmp_path / f"{name}.yaml" for name in "abcde"]
    for path in paths:
        path.write_text(GOOD, encoding="utf-8")
    assert main(["export", *map(str, paths), *jobs, "--out", str(tmp_path / "out")]) == 0
    assert [line.partition(":")[0] for line in capsys.readouterr().out.splitlines()] == list("abcde")
    assert counts == ([] if pays else [3 if jobs else 2])


def double(number: int) -> int:
    return 2 * number


def forever(path: str) -> None:
    Path(path).write_text(str(os.getpid()), encoding="utf-8")
    try:
        while True:
            time.sleep(0.01)
    finally:
        Path(path).unlink()


@pytest.mark.slow
def test_work_under_spawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(multiprocessing, "get_all_start_methods", lambda: ["spawn"])
    assert dict(workers.at_once(double, range(5), 150)) == {number: 2 * number for number in range(5)}


@pytest.mark.thin(4)
@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("ended", [signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize("fork", ["True", "False"])
def test_workers_end_with_their_run_and_clear_up(tmp_path: Path, ended: signal.Signals, fork: str) -> None:
    marks = [tmp_path / "a", tmp_path / "b"]
    code = (
        "import sys\nsys.path[:0] = sys.argv[1:3]\n"
        "from camgeo.common import workers\nfrom test_systems import forever\n"
        "if __name__ == '__main__':\n"
        f"  with workers.pool(2, fork={fork}) as pool:\n"
        "    [pool.submit(forever, path) for path in sys.argv[3:]][0].result()\n"
    )
    script = tmp_path / "run.py"
    script.write_text(code, encoding="utf-8")
    with subprocess.Popen([sys.executable, str(script), str(TESTS), str(TESTS / "cli"), *map(str, marks)]) as run:
        until(lambda: all(mark.exists() and mark.read_text(encoding="utf-8") for mark in marks))
        run.send_signal(ended)
    until(lambda: not any(mark.exists() for mark in marks))


def until(true) -> None:
    for _ in range(3000):
        if true():
            return
        time.sleep(0.01)
    pytest.fail("it did not come to that")


@pytest.mark.skipif(sys.platform == "win32", reason="signals of threads")
def test_an_interrupt_that_another_thread_takes_is_put_off_as_well() -> None:
    """Threads of a linear algebra library do not block it, and Python tells the main thread."""
    done = threading.Event()
    thread = threading.Thread(target=done.wait)
    thread.start()
    reached = []

    def steps() -> None:
        with system.uninterrupted():
            signal.pthread_kill(thread.ident, signal.SIGINT)
            for _ in range(100):
                time.sleep(0.001)
            reached.append(True)

    try:
        with pytest.raises(KeyboardInterrupt):
            steps()
    finally:
        done.set()
        thread.join()
    assert reached
