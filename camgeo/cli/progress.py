"""What is being done, on a terminal's last line."""

from __future__ import annotations

import sys
import time

from camgeo.common.terminal import complain, escaped, whisper

PATIENCE = 1.0  # seconds before progress is shown


class Progress:
    """What is being done, on a terminal's last line, once it takes more than a second.

    With `every`, seconds, it is said elsewhere too, a line each time that so long has passed.
    """

    def __init__(self, name: str, every: float | None = None) -> None:
        self._name = name
        self._every = every
        self._said = time.perf_counter()
        self._start = time.perf_counter()
        self._shown = False

    def __call__(self, stage: str) -> None:
        """Show a stage in place of the last one."""
        if sys.stderr.isatty() and time.perf_counter() - self._start > PATIENCE:
            whisper(f"\r\x1b[K{escaped(self._name)}: {stage} ...")
            self._shown = True
        elif self._every is not None and not sys.stderr.isatty() and time.perf_counter() - self._said >= self._every:
            self._said = time.perf_counter()
            complain(f"{self._name}: {stage}")

    def clear(self) -> None:
        """Take the line away again."""
        if self._shown:
            whisper("\r\x1b[K")
            self._shown = False
