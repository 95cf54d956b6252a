"""Progress of a command on the terminal's last line."""

from __future__ import annotations

import sys
import threading
import time

from camgeo.common.terminal import complain, escaped, whisper

PATIENCE = 1.0  # seconds before progress is shown
LONG = 10.0  # seconds after which a stage gets a line where there is no terminal


class Progress:
    """Shows the stage of a command on the terminal's last line, once the command takes more than a second.

    Without a terminal, a stage that takes more than `LONG` gets a line of its own; with `every`, a stage gets a line
    where that many seconds have passed since the last line. A timer thread writes: `clear` has to be called before the
    process is forked.
    """

    def __init__(self, name: str, every: float | None = None) -> None:
        self._name = name
        self._interval = every
        self._last_line_at = time.perf_counter()
        self._start = time.perf_counter()
        self._shown = False
        self._timer: threading.Timer | None = None

    def __call__(self, stage: str) -> None:
        """Show a stage in place of the last one."""
        self._stop()
        passed = time.perf_counter() - self._start
        if sys.stderr.isatty() and passed > PATIENCE:
            self._overwrite_line(stage)
        elif self._interval is None:
            wait, write = (PATIENCE - passed, self._overwrite_line) if sys.stderr.isatty() else (LONG, self._write_line)
            self._timer = threading.Timer(wait, write, (stage,))
            self._timer.daemon = True
            self._timer.start()
        elif not sys.stderr.isatty() and time.perf_counter() - self._last_line_at >= self._interval:
            self._last_line_at = time.perf_counter()
            complain(f"{self._name}: {stage}")

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
        complain(f"{self._name}: {stage} takes more than {LONG:g} s ...")

    def _stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer.join()
            self._timer = None
