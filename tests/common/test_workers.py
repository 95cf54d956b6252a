"""Processes of a run: how many, started when they pay, and gone with the run that started them."""

from __future__ import annotations

import math
import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from support.places import TESTS

from camgeo.cli import batch
from camgeo.cli.main import main
from camgeo.common import workers

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

GOOD = "cam: {kind: support, p: 25 + 2*cos(3*t)}\nexport: {tolerance: 0.01, files: [dxf]}\n"


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


@pytest.mark.slow
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
    try:
        Path(path).write_text(str(os.getpid()), encoding="utf-8")  # from then on it may end at any moment
        while True:
            time.sleep(0.01)
    finally:
        Path(path).unlink()


def deadly(task: tuple[str, int]) -> int:
    """The number doubled; 3 kills its process always, 5 where it is the first time."""
    folder, number = task
    mark = Path(folder) / str(number)
    if number == 3 or (number == 5 and not mark.exists()):
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return 2 * number


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_what_kills_its_process_is_tried_alone_and_the_rest_goes_on(tmp_path: Path) -> None:
    left: list[int] = []
    items = [(str(tmp_path), number) for number in range(9)]
    made = {number: result for (_, number), result in workers.at_once(deadly, items, 2, fork=True, waiting=left.append)}
    assert isinstance(made.pop(3), workers.Killed)
    assert made == {number: 2 * number for number in (0, 1, 2, 4, 5, 6, 7, 8)}
    assert left == sorted(left)
    assert left[0] == 0


@pytest.mark.parametrize("count", [1, 2])
def test_an_item_is_told_as_killed_after_two_deaths_that_it_alone_can_have_caused(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The pool is played: two processes at work lose both items, and one alone dies as often as is said here."""
    deaths = {"once": 1, "always": 9, "never": 0}
    tried: list[list[str]] = []

    class Played:
        def __init__(self, size: int) -> None:
            self.size = size
            tried.append([])

        def submit(self, _function, item: str) -> Future[str]:
            tried[-1].append(item)
            future: Future[str] = Future()
            if self.size == 2 or deaths[item]:
                deaths[item] -= self.size == 1
                future.set_exception(BrokenProcessPool())
            else:
                future.set_result(item)
            return future

    monkeypatch.setattr(workers, "pool", lambda size, **_: nullcontext(Played(size)))
    made = dict(workers.at_once(str, ["once", "always"], count))
    assert made.pop("once") == "once"
    assert isinstance(made.pop("always"), workers.Killed)
    assert made == {}
    assert [items for items in tried if len(items) == 1].count(["always"]) == 2


def temporary(kill: bool) -> str:
    folder = tempfile.mkdtemp()
    if kill:
        os.kill(os.getpid(), signal.SIGKILL)
    return folder


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("kill", [True, False])
def test_temporary_folders_of_workers_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, kill: bool) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    ((_, folder),) = workers.at_once(temporary, [kill], 1, fork=True)
    assert isinstance(folder, workers.Killed) if kill else tmp_path in Path(str(folder)).parents
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_work_under_spawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(multiprocessing, "get_all_start_methods", lambda: ["spawn"])
    assert dict(workers.at_once(double, range(5), 150)) == {number: 2 * number for number in range(5)}


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("ended", [signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize("fork", ["True", "False"])
def test_workers_end_with_their_run_and_clear_up(tmp_path: Path, ended: signal.Signals, fork: str) -> None:
    marks = [tmp_path / "a", tmp_path / "b"]
    code = (
        "import sys\nsys.path[:0] = sys.argv[1:3]\n"
        "from camgeo.common import workers\nfrom test_workers import forever\n"
        "if __name__ == '__main__':\n"
        f"  with workers.pool(2, fork={fork}) as pool:\n"
        "    [pool.submit(forever, path) for path in sys.argv[3:]][0].result()\n"
    )
    script = tmp_path / "run.py"
    script.write_text(code, encoding="utf-8")
    with subprocess.Popen([sys.executable, str(script), str(TESTS), str(TESTS / "common"), *map(str, marks)]) as run:
        until(lambda: all(mark.exists() and mark.read_text(encoding="utf-8") for mark in marks))
        run.send_signal(ended)
    until(lambda: not any(mark.exists() for mark in marks))


def until(true) -> None:
    for _ in range(3000):
        if true():
            return
        time.sleep(0.01)
    pytest.fail("it did not come to that")
