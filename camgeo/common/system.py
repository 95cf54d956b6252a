"""Differences between systems: locks, second names of a file, files that a program holds open, interrupts.

Python in a browser is the platform `emscripten`: one process on a file system of its own, without locks and links.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path
    from types import FrameType

if sys.platform == "win32":
    import msvcrt
elif sys.platform != "emscripten":
    import fcntl

WINDOWS = sys.platform == "win32"
# seconds before each new try where Windows refuses, as a virus scanner may have the file open
_PAUSES = (0.01, 0.03, 0.1, 0.3, 1.0)


def retry(step: Callable[[], object]) -> None:
    """Call a function that renames or removes a file; on Windows several times, as a program may have the file open.

    Raises what the last call raises.
    """
    for pause in _PAUSES if WINDOWS else ():
        try:
            step()
        except PermissionError:
            time.sleep(pause)
        else:
            return
    step()


def lock_file(path: Path) -> int | None:
    """Descriptor of a file that is created, opened and locked; None where another process holds the lock.

    The holder removes the file in the end. So a lock counts only if the path still leads to the file that was locked. A
    file that a killed process left behind is not locked. Raises OSError where the file cannot be opened.
    """
    while True:
        lock = os.open(path, os.O_CREAT | os.O_RDWR | getattr(os, "O_NOFOLLOW", 0), 0o666)
        try:
            if not _take_lock(lock):
                os.close(lock)
                return None
            if os.path.samestat(os.fstat(lock), path.stat()):
                return lock
        except FileNotFoundError:  # removed by its last holder after it was opened here
            os.close(lock)
        except BaseException:
            os.close(lock)
            raise
        else:
            os.close(lock)  # and another one is there already


def unlock(lock: int, path: Path) -> None:
    """Remove the locked file, then close its descriptor `lock`, which ends the lock.

    On Windows the descriptor is closed first, as that system removes no open file.
    """
    if WINDOWS:
        os.close(lock)
    with suppress(OSError):  # a file that stays behind locks nothing
        path.unlink()
    if not WINDOWS:
        os.close(lock)


def link_file(source: Path, target: Path) -> None:
    """Link a file under a second name, or copy it where the system or file system has no hard links.

    A symbolic link is linked or copied as such. Raises OSError where the file cannot be copied either.
    """
    if sys.platform != "emscripten":
        with suppress(OSError, NotImplementedError):  # the second where a system knows no link to a link
            os.link(source, target, follow_symlinks=False)
            return
    import shutil

    shutil.copy2(source, target, follow_symlinks=False)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Context to whose end an interrupt is delayed; processes started within it block interrupts, but on Windows.

    Blocking alone is not enough here: a thread of a library may take the signal, which Python passes to the main
    thread.
    """
    came: list[tuple[int, FrameType | None]] = []
    main = threading.current_thread() is threading.main_thread()
    before = signal.getsignal(signal.SIGINT)
    if main and callable(before):
        signal.signal(signal.SIGINT, lambda number, frame: came.append((number, frame)))
    try:
        if sys.platform == "win32":
            yield
        else:
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            try:
                yield
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    finally:
        if main and callable(before):
            signal.signal(signal.SIGINT, before)
    if came and callable(before):
        before(*came[0])


def _take_lock(lock: int) -> bool:
    """Whether an open file was locked, until it is closed or the process ends; False where another process has it."""
    if sys.platform == "win32":
        try:
            msvcrt.locking(lock, msvcrt.LK_NBLCK, 1)
        except PermissionError:
            return False
        return True
    if sys.platform == "emscripten":
        return True  # no other process sees the file
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
