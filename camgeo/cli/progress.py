"""Progress of a command on the terminal's last line."""

from __future__ import annotations

import sys
import threading
import time

from camgeo.common.system import uninterrupted
from camgeo.common.terminal import complain, escaped, whisper

PATIENCE = 1.0  # seconds before progress is shown on a terminal
LONG = 10.0  # seconds after which there is a line where there is no terminal, and after each line the next


class Progress:
    """Shows the stage of a command on the terminal's last line, once the command takes more than a second.

    Without a terminal the stage gets a line of its own where `LONG` has passed since the beginning or the last line. A
    timer thread writes: `clear` has to be called before the process is forked.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._start = self._last_line_at = time.perf_counter()
        self._shown = False
        self._timer: threading.Timer | None = None

    def __call__(self, stage: str) -> None:
        """Show a stage in place of the last one."""
        self._stop()
        terminal = sys.stderr.isatty()
        due = self._start + PATIENCE if terminal else self._last_line_at + LONG
        wait, write = due - time.perf_counter(), self._overwrite_line if terminal else self._write_line
        if wait <= 0.0:
            write(stage)
            return
        with uninterrupted():  # a thread that is half started can be neither waited for nor told from one that is not
            timer = threading.Timer(wait, write, (stage,))
            timer.daemon = True
            timer.start()
            self._timer = timer

    def clear(self) -> None:
        """Stop the timer and erase the stage's line from the terminal."""
        self._stop()
        if self._shown:
            whisper("\r\x1b[K")
            self._shown = False

    def _overwrite_line(self, stage: str) -> None:
        self._shown = True
        whisper(f"\r\x1b[K{escaped(self._name)}: {stage} ...")

    def _write_line(self, stage: str) -> None:
        self._last_line_at = time.perf_counter()
        complain(f"{self._name}: {stage} ...")

    def _stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer.join()
            self._timer = None
