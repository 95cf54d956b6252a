"""What systems do differently where files are concerned: locks, and files that a program holds open."""

from __future__ import annotations

import os
import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

WINDOWS = sys.platform == "win32"
_PAUSES = (0.01, 0.03, 0.1, 0.3, 1.0)  # seconds before another try where Windows refuses, for a virus scanner say


def patient(step: Callable[[], object]) -> None:
    """Take a step that renames or removes; on Windows again for a while, as it leaves alone what a program has open."""
    for pause in _PAUSES if WINDOWS else ():
        try:
            step()
        except PermissionError:
            time.sleep(pause)
        else:
            return
    step()


def locked(path: Path) -> int | None:
    """Open and lock a file, and return it; None where another process holds it.

    The holder removes the file in the end. So a lock counts only if the path still leads to the file that was locked.
    One that a killed process left behind is held by nobody.
    """
    while True:
        lock = os.open(path, os.O_CREAT | os.O_RDWR | getattr(os, "O_NOFOLLOW", 0), 0o666)
        try:
            if not _taken(lock):
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
    """Remove a lock's file while it is held, then let go of it.

    The other way round on Windows, which removes no file that is open, here or in another run that waits for nothing.
    """
    if WINDOWS:
        os.close(lock)
    with suppress(OSError):  # a file that stays behind locks nothing
        path.unlink()
    if not WINDOWS:
        os.close(lock)


def _taken(lock: int) -> bool:
    """Lock an open file until it is closed or the process ends; False where another one has it."""
    if sys.platform == "win32":
        try:
            msvcrt.locking(lock, msvcrt.LK_NBLCK, 1)
        except PermissionError:
            return False
        return True
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
