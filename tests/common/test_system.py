"""What Windows and macOS do otherwise, as far as it can be simulated here: links, open files, locks, interrupts."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from support.sets import NAME, export

from camgeo.common import system
from camgeo.common.errors import BusyError, SurroundingsError
from camgeo.output.output_folder import RunFolder


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


@pytest.mark.skipif(sys.platform == "win32", reason="signals of threads")
def test_an_interrupt_that_another_thread_takes_is_put_off_as_well() -> None:
    """Threads of a linear algebra library do not block it, and Python tells the main thread."""
    done = threading.Event()
    thread = threading.Thread(target=done.wait)
    thread.start()
    taken, told = socket.socketpair()
    told.setblocking(False)
    before = signal.set_wakeup_fd(told.fileno())
    reached = []

    def steps() -> None:
        with system.uninterrupted():
            signal.pthread_kill(thread.ident, signal.SIGINT)
            reached.append(taken.recv(1))  # once the thread has it

    try:
        with pytest.raises(KeyboardInterrupt):
            steps()
    finally:
        signal.set_wakeup_fd(before)
        done.set()
        thread.join()
        taken.close()
        told.close()
    assert reached == [bytes([signal.SIGINT])]
