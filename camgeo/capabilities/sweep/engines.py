"""Computing chunks in this process, in several on this machine, or by the workers of a Dask scheduler.

Results are iterators over (chunk number, bytes of its file), in any order. A worker gets its next chunk only when it is
about to be free, so a sweep that is stopped early wastes little.
"""

from __future__ import annotations

import time
from contextlib import closing, contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from camgeo.capabilities.sweep.chunks import EngineError, VersionsError, result, versions
from camgeo.common import workers
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence

    from camgeo.capabilities.sweep.chunks import Results, SweepJob


T = TypeVar("T")
R = TypeVar("R")

_TRIAL = 0.5  # seconds of work after which it is clear how long the rest takes
_WORTHWHILE = 2.0  # seconds of remaining work from which more processes save time
_TIMEOUT = 10.0  # seconds for a scheduler to answer
_NO_ADDRESS = "is not the address of a Dask scheduler, such as tcp://host:8786"
_LOGGERS = frozenset({"distributed", "tornado", "asyncio"})  # which print errors that are raised here in plain words
_MOST_KILLED = 4  # items: where so many kill their process the others will too
_MOST_TIMEOUTS = 2  # in a row, until the scheduler's first worker comes


@dataclass(frozen=True)
class Workers:
    """Who computes chunks: the scheduler at an address, else at most `jobs` processes, by default one a core.

    `waiting` is called with words on what a scheduler lacks, again and again while it waits.
    """

    jobs: int | None = None
    scheduler: str | None = None
    waiting: Callable[[str], None] | None = None

    def results(self, job: SweepJob, numbers: Sequence[int]) -> Results:
        """Pairs of a chunk's number, of those in `numbers`, and the bytes of its file, as they are done.

        Iterating raises EngineError where a chunk kills its process, or a scheduler or its workers are missing or lost,
        VersionsError for workers of other versions, ModuleNotFoundError for a missing package.
        """
        if self.scheduler is not None:
            return dask(job, numbers, self.scheduler, self.waiting)
        return spread(partial(result, job, key=job.key), numbers, self.processes)

    def __str__(self) -> str:
        if self.scheduler is not None:
            return f"dask at {self.scheduler}"
        if self.jobs is None:
            return "as many processes as pay"
        return "1 process" if self.jobs == 1 else f"up to {self.jobs} processes"

    @property
    def processes(self) -> int:
        """Greatest number of processes on this machine, also with a scheduler, for the work after the chunks."""
        return self.jobs or workers.available()


def in_processes(function: Callable[[T], R], items: Iterable[T], count: int) -> Generator[tuple[T, R], None, None]:
    """Pairs of an item and the function's result, in the order of their ends, computed in `count` processes.

    The function must be defined in a module, not inside another. Iterating raises EngineError where items killed the
    process that worked on them alone: in the end, or after _MOST_KILLED of them; and whatever the function raises.
    """
    killed = 0
    with closing(workers.at_once(function, items, count)) as ends:
        for item, found in ends:
            if isinstance(found, workers.Killed):
                killed += 1
            else:
                yield item, found
            if killed == _MOST_KILLED:
                break
    if killed:
        raise EngineError(workers.KILLED.format("it"))


def spread(function: Callable[[T], R], items: Sequence[T], count: int) -> Generator[tuple[T, R], None, None]:
    """Pairs of an item and the function's result: one after another here, or from `count` processes.

    Processes are started once the items done show that the remaining ones would take over 2 s. Iterating raises
    EngineError where an item kills its process, and whatever the function raises.
    """
    started = time.perf_counter()
    for done, item in enumerate(items):
        spent = time.perf_counter() - started
        if count > 1 and done and spent > _TRIAL and spent / done * (len(items) - done) > _WORTHWHILE:
            yield from in_processes(function, items[done:], count)
            return
        yield item, function(item)


def dask(job: SweepJob, numbers: Sequence[int], address: str, waiting: Callable[[str], None] | None = None) -> Results:
    """Pairs of a chunk's number, of those in `numbers`, and the bytes of its file, from the workers of Dask.

    The workers of the scheduler at `address` need camgeo, and no shared disk; `waiting` is called with words on those
    that it lacks. Iterating raises ModuleNotFoundError
    without the package distributed, VersionsError for workers of other versions, and EngineError where the scheduler
    does not answer or goes away, has no workers or some without camgeo, or a chunk kills its workers again and again.
    """
    from distributed import wait

    if waiting is not None:
        waiting(f"the scheduler at {address} is asked")
    wait_for: Callable[..., Any] = wait
    with _quiet(), _connected(address) as client:
        _require_versions(client.run(versions, job.plan, on_error="return"), versions(job.plan))
        key, left = job.key, list(reversed(numbers))
        running: dict[Any, int] = {}
        timeouts = 0
        while left or running:
            if waiting is not None and not client.nthreads():
                waiting(f"the scheduler at {address} has no workers yet")
            places = workers.AHEAD * max(1, sum(client.nthreads().values())) - len(running)
            for _ in range(min(places, len(left))):
                number = left.pop()
                # not pure: a result is kept on our disk and nowhere else
                running[client.submit(result, job, number, key, pure=False)] = number
            try:
                with client.as_current():  # `wait` needs it; set for this thread alone
                    done = wait_for(list(running), timeout=_TIMEOUT, return_when="FIRST_COMPLETED").done
            except TimeoutError:
                timeouts = 0 if client.nthreads() else timeouts + 1
                if timeouts >= _MOST_TIMEOUTS:
                    raise EngineError(f"the scheduler at {address} has no workers") from None
                continue
            for future in done:
                yield running.pop(future), future.result()


def _require_versions(workers: Mapping[str, dict[str, str] | Exception], ours: dict[str, str]) -> None:
    """Raise VersionsError for workers of other versions, EngineError for those without camgeo: else chunks are lost."""
    for worker, theirs in workers.items():
        if isinstance(theirs, Exception):
            raise EngineError(f"the worker at {worker} cannot run camgeo: {theirs}")
        if theirs != ours:
            text, own = (", ".join(f"{name} {version}" for name, version in pack.items()) for pack in (theirs, ours))
            raise VersionsError(f"a worker has other versions than this run: {worker} has {text}, this run {own}")


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep distributed from printing lines of its own: errors that stop the run are raised."""
    import logging

    loggers = [logging.getLogger(name) for name in logging.root.manager.loggerDict if name.split(".")[0] in _LOGGERS]
    before = [logger.disabled for logger in loggers]
    for logger in loggers:
        logger.disabled = True
    try:
        yield
    finally:
        for logger, disabled in zip(loggers, before, strict=True):
            logger.disabled = disabled


@contextmanager
def _connected(address: str) -> Iterator[Any]:
    """A client of the scheduler, closed in the end; the scheduler then drops the chunks it still had.

    Raises EngineError in place of Dask's errors for a lost scheduler, or a chunk that kills its workers.
    """
    from concurrent.futures import CancelledError

    from distributed import Client
    from distributed.scheduler import KilledWorker

    connect: Callable[..., Any] = Client
    _require_scheduler(address)  # first: a client without a scheduler takes half a minute to fail, or for ever
    try:
        client = connect(address, timeout=_TIMEOUT, set_as_default=False)
    except OSError as error:
        raise EngineError(f"the server at {address} is not a Dask scheduler") from error
    with client:
        try:
            yield client
        except (CancelledError, OSError) as error:
            raise EngineError(f"the connection to the scheduler at {address} was lost") from error
        except KilledWorker as error:
            raise EngineError(f"workers of {address} were killed before their chunk was done") from error


def _require_scheduler(address: str) -> None:
    """Raise EngineError unless a scheduler listens at the address, such as tcp://host:8786."""
    import asyncio
    import socket
    import struct

    from distributed.comm import get_address_host_port

    host_and_port: Callable[[str], tuple[str, int]] = get_address_host_port
    try:
        socket.create_connection(host_and_port(address), _TIMEOUT).close()  # `rpc` would try again for so long
    except ValueError as error:
        raise EngineError(f"{address} {_NO_ADDRESS}") from error
    except OSError as error:
        why = f": {error.strerror}" if error.strerror else ""
        raise EngineError(f"no Dask scheduler answers at {address}{why}") from error
    try:
        kind = asyncio.run(asyncio.wait_for(_node_type(address), _TIMEOUT))
    except TimeoutError:
        text = f"the server at {address} does not answer as a Dask scheduler does: no answer in {_TIMEOUT:g} s"
        raise EngineError(text) from None
    except (MemoryError, struct.error):  # its first bytes were read as a length
        raise EngineError(f"the server at {address} speaks another protocol than a Dask scheduler") from None
    except (OSError, ValueError) as error:
        raise EngineError(f"the server at {address} is not a Dask scheduler") from error
    if kind != "Scheduler":
        raise EngineError(f"the server at {address} is not a Dask scheduler, but a {kind}")


async def _node_type(address: str) -> str:
    """Type of a node of Dask, in its own words: Scheduler, Worker, Nanny."""
    from distributed import rpc

    connect: Callable[..., Any] = rpc
    async with connect(address, timeout=_TIMEOUT) as node:
        return str((await node.identity())["type"])
