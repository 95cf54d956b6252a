"""The entry of the command line, also `python -m camgeo`: from here to the end an interrupt ends with status 130.

Nothing else is imported before interrupts are handled, as the imports take most of a short run; only an interrupt
during Python's own start is not. numpy starts with one thread, as nothing here multiplies large matrices and starting
threads takes longer than a small cam; a setting of the user stays, and so does the environment of a program that
imports the library. The garbage collector waits for many new objects: by default it searches the objects of the imports
again and again, those of ezdxf above all, and at the end all objects that are freed with the process anyway.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import time

TYPE_CHECKING = False  # in place of the name in `typing`, whose import takes as long as all imports above
if TYPE_CHECKING:
    from types import FrameType
    from typing import NoReturn

_THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")  # of numpy's BLAS
_COLLECT_AFTER = 300_000  # new objects; one recipe makes about a third as many
_IMPATIENT = 1.0  # seconds after which a second interrupt is a new one: a launcher may pass the same one on twice


class _Interrupts:
    """Interrupts of this process: the first raises KeyboardInterrupt, at the time `first`.

    A callback of a library may swallow it, or print it; it is raised again until it ends the run. While the run clears
    up, further interrupts are ignored for `_IMPATIENT` seconds; a later one ends the process at once, which loses
    nothing, as the next run clears up.
    """

    def __init__(self) -> None:
        self.first: float | None = None
        self.over = False  # at the end, where there is nothing left to interrupt
        self._again = False  # the first was swallowed
        self._reported = False

    def listen(self) -> None:
        """Handle interrupts in place of Python's handler, unless they are ignored (`nohup`, a shell's background)."""
        if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self._came)
            sys.unraisablehook = self._swallowed

    def _came(self, _number: int, frame: FrameType | None) -> None:
        now = time.monotonic()
        if self._again and self._is_swallowing(frame):
            self._repeat()
        elif self.first is None or self._again:
            self.first, self._again = now, False
            if not self.over:
                raise KeyboardInterrupt
            if self._reported:
                return  # the run is ending with it
            self.report()
            os._exit(130)  # what is raised in the interpreter's own way out is printed and lost
        elif now - self.first > _IMPATIENT:
            self.report()
            os._exit(130)

    def report(self) -> None:
        """Print that the run was interrupted, once: a swallowed interrupt may be raised again meanwhile."""
        if not self._reported:
            self._reported = True
            try:
                sys.stderr.write("camgeo: interrupted\n")
                sys.stderr.flush()
            except (OSError, ValueError, AttributeError, RuntimeError):
                return  # there is nobody to tell, or an interrupt came while it was told

    def _swallowed(self, unraisable: sys.UnraisableHookArgs) -> None:
        """Hook for exceptions that cannot be raised: repeat an interrupt that fell into such a callback."""
        if not isinstance(unraisable.exc_value, KeyboardInterrupt):
            sys.__unraisablehook__(unraisable)
        elif not self.over:
            self._again = True
            self._repeat()

    def _is_swallowing(self, frame: FrameType | None) -> bool:
        """Whether an interrupt in this frame would be lost once more, as the hook of the last one is still running."""
        while frame is not None and frame.f_code is not _Interrupts._swallowed.__code__:
            frame = frame.f_back
        return frame is not None

    def _repeat(self) -> None:
        """Interrupt the run again a little later: here the interrupt would fall into the same callback."""
        import threading
        from _thread import interrupt_main

        timer = threading.Timer(0.01, interrupt_main)
        timer.daemon = True
        timer.start()


def main() -> NoReturn:
    """Run the command of the process's arguments and leave with its exit status; 130 for any interrupt."""
    interrupts = _Interrupts()
    gc.set_threshold(_COLLECT_AFTER)
    if not any(name in os.environ for name in _THREADS):
        os.environ.update(dict.fromkeys(_THREADS, "1"))  # worker processes inherit it
    try:
        interrupts.listen()
        status = _status()
        interrupts.over = True
    except (KeyboardInterrupt, Exception) as end:
        # a compiled library that is being imported turns an interrupt into an error of its own
        if interrupts.first is None and not isinstance(end, KeyboardInterrupt):
            raise
        interrupts.over = True
        status = 130
        interrupts.report()
    if interrupts.first is not None and status != 130:  # a library kept it to itself
        status = 130
        interrupts.report()
    try:
        sys.stdout.flush()
    except (OSError, ValueError):
        from camgeo.common.terminal import silence

        silence("stdout")
        status = status or 3
    gc.freeze()  # else Python's way out, which loses nothing, takes a fifth of a run
    sys.exit(status)


def _status() -> int:
    from camgeo.cli.main import main as run

    try:
        return run()
    except SystemExit as end:  # of argparse
        return end.code if isinstance(end.code, int) else 0 if end.code is None else 1


if __name__ == "__main__":
    main()
