"""Processes that work for a run: how many there are, how they ignore interrupts, and how they end with the run.

An interrupt at the terminal reaches every process of a run. Only the run itself heeds it: it closes a pipe to its
workers, and each of them then ends its work as if it were interrupted, clearing up behind itself.
"""

from __future__ import annotations

import os
import sys
from collections import deque
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar, cast

from camgeo.common.system import uninterrupted

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Iterator
    from concurrent.futures import Future, ProcessPoolExecutor
    from multiprocessing.connection import Connection
    from types import FrameType

T = TypeVar("T")
R = TypeVar("R")

AHEAD = 2  # items submitted for each worker: one at work, one waiting
MOST_ON_WINDOWS = 61  # processes that one wait of Windows can wait for, less two
_TO_CLEAR_UP = 2.0  # seconds after which a worker whose run is over ends in any case
FORKS = sys.platform == "linux"  # macOS forks too, but its libraries fail in a forked process
KILLED = (
    "a process was killed before {} was done, and another as it worked on it alone, perhaps for lack of memory; "
    "free some and call again"
)


class Killed:
    """In place of a result: two processes were killed that worked on the item alone."""


class _OverError(BaseException):
    """The run is over: the result of a worker is not needed."""


class _State:
    """State of a worker's process: whether it is at work on an item, and whether its run is over."""

    busy = False
    over = False


class Pool:
    """Processes of one run; made by `pool`."""

    def __init__(self, executor: ProcessPoolExecutor) -> None:
        self._executor = executor

    def submit(self, function: Callable[[T], R], item: T) -> Future[R]:
        """Future of a function of a module called with an item in a worker.

        Raises BrokenProcessPool where a process was killed.
        """
        with uninterrupted():  # this may start processes
            return self._executor.submit(cast("Callable[[T], R]", partial(_work_on, function)), item)


def available() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def may_fork() -> bool:
    """Whether this process may be forked: on Linux, with no thread beside this one, not even of a library."""
    return FORKS and len(list(Path("/proc/self/task").iterdir())) == 1


def needed(processes: int, items: int) -> int:
    """Number of processes to start: `processes`, but no more than items or than the system allows; at least 1."""
    return max(1, min(processes, items, MOST_ON_WINDOWS if sys.platform == "win32" else processes))


@contextmanager
def pool(workers: int, *, fork: bool = False) -> Iterator[Pool]:
    """Context of worker processes for a run; left by an exception, it abandons work in progress.

    With `fork` the workers begin with all that this process has imported, on a system that forks safely. Temporary
    folders of workers are removed in the end, also of those that were killed.
    """
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    from kin.read.home import prepare_home

    prepare_home()  # once, and not by each process
    # not fork in general: this process may have threads, of a linear algebra library or a compiler
    clean = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"
    method = "fork" if fork and FORKS else clean
    context = multiprocessing.get_context(method)
    if method == "forkserver":
        _start_server()
    theirs, ours = context.Pipe(duplex=False)
    inherited = ours if method == "fork" else None
    with (
        _folder() as folder,
        theirs,
        ours,
        ProcessPoolExecutor(workers, context, _be_a_worker, (theirs, inherited, folder)) as executor,
    ):
        try:
            yield Pool(executor)
        except BaseException:
            ours.close()  # nobody waits for what is still at work
            raise
        finally:
            # waited for, since a pool that is still ending when the interpreter exits may print a traceback
            executor.shutdown(cancel_futures=True)


@contextmanager
def _folder() -> Iterator[str | None]:
    """Context of a temporary folder that is removed in the end; None where none can be made."""
    import shutil
    import tempfile

    try:
        folder = tempfile.mkdtemp(prefix="camgeo-")
    except OSError:
        yield None  # who needs one says so
        return
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def at_once(
    function: Callable[[T], R],
    items: Iterable[T],
    workers: int,
    *,
    fork: bool = False,
    waiting: Callable[[int], None] = lambda _: None,
) -> Generator[tuple[T, R | Killed], None, None]:
    """Pairs of an item and the function's result, in the order in which they end.

    At most `workers` processes work at once; the function has to stand in a module. Where a process is killed, the
    items that were at work are tried again, each alone, and the others go on in new processes. An item is told as
    killed once two processes have died that worked on it alone: a death in company may be that of another item.
    `fork` is that of `pool`, as long as this process may be forked; `waiting` is called with the number of items done
    before each wait. Raises what the function raises.
    """
    from concurrent.futures import FIRST_COMPLETED, wait
    from concurrent.futures.process import BrokenProcessPool

    left, due, done = deque(items), deque[tuple[T, int]](), 0  # due: with the number of deaths of an item alone
    while left or due:
        queue, deaths = left, 0
        if due:
            item, deaths = due.popleft()
            queue = deque([item])
        count = needed(workers, len(queue))
        running: dict[Future[R], T] = {}
        try:
            with pool(count, fork=fork and may_fork()) as processes:
                while queue or running:
                    while queue and len(running) < AHEAD * count:
                        running[processes.submit(function, queue[0])] = queue[0]
                        queue.popleft()
                    waiting(done)
                    for future in wait(running, return_when=FIRST_COMPLETED).done:
                        result = future.result()
                        done += 1
                        yield running.pop(future), result
            continue
        except BrokenProcessPool:
            lost = []
        for future, item in running.items():
            if future.cancelled() or isinstance(future.exception(), BrokenProcessPool):
                lost.append(item)
            else:
                done += 1
                yield item, future.result()
        if not lost and queue:  # processes that do not even start
            lost = [queue.popleft()]
        for item in lost[:count]:  # processes take items in their order: the first ones were at work
            if count == 1 and deaths:
                done += 1
                yield item, Killed()
            else:
                due.append((item, int(count == 1)))
        left.extendleft(reversed(lost[count:]))


def _start_server() -> None:
    """Start the process from which workers are forked; like them it ignores interrupts."""
    from multiprocessing import forkserver, resource_tracker

    resource_tracker.ensure_running()  # first: it blocks interrupts by itself, and unblocks them here afterwards
    with uninterrupted():
        forkserver.ensure_running()


def _be_a_worker(run: Connection, inherited: Connection | None, folder: str | None) -> None:
    """Let this process ignore interrupts, and end with the run that started it.

    `run` is a pipe that is closed when the run ends or abandons its workers; `inherited` is its other end, which a
    forked process has too. Temporary folders are made in `folder`, which the run removes; None for the system's.
    """
    import signal
    import tempfile
    import threading
    import time
    from _thread import interrupt_main
    from multiprocessing.connection import wait

    if inherited is not None:
        inherited.close()
    signal.signal(signal.SIGINT, _interrupt)
    sys.unraisablehook = _stop_again
    tempfile.tempdir = folder or tempfile.tempdir

    def watch() -> None:
        wait([run])
        _State.over = True
        interrupt_main()
        time.sleep(_TO_CLEAR_UP)
        with suppress(OSError):
            if folder is not None:  # the run may have been killed
                Path(folder).rmdir()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    """Signal handler of a worker: end its work if the run is over; ignore an interrupt from the terminal."""
    if _State.over and _State.busy:
        _State.busy = False
        raise _OverError


def _stop_again(unraisable: sys.UnraisableHookArgs) -> None:
    """Hook for exceptions that cannot be raised: interrupt a worker again whose interrupt fell into a callback."""
    if not isinstance(unraisable.exc_value, _OverError):
        sys.__unraisablehook__(unraisable)
        return
    import threading
    from _thread import interrupt_main

    _State.busy = True
    timer = threading.Timer(0.01, interrupt_main)  # not here: it would fall into this same callback
    timer.daemon = True
    timer.start()


def _work_on(function: Callable[[T], R], item: T) -> R | None:
    """Result of the function for one item; None once the run is over."""
    if _State.over:
        return None
    try:
        _State.busy = True
        return function(item)
    except _OverError:
        return None
    finally:
        _State.busy = False
