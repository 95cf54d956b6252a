"""Who computes the chunks: this process, several on this machine, or the workers of a Dask scheduler.

Each engine is an iterator over (chunk, bytes of its file), in whatever order they land. It hands a worker its next
chunk only when it is about to come free, so an end that comes early wastes little.
"""

from __future__ import annotations

import time
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

from camgeo.capabilities.sweep.job import VersionsError, result, versions
from camgeo.common import workers
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence

    from camgeo.capabilities.sweep.job import Job

Results: TypeAlias = "Generator[tuple[int, bytes], None, None]"

T = TypeVar("T")
R = TypeVar("R")

_TRIED = 0.5  # seconds of work after which it is clear how long the rest takes
_PAYS = 2.0  # seconds of remaining work from which more processes pay
_PATIENCE = 10.0  # seconds for a scheduler to answer
_NO_ADDRESS = "is not the address of a Dask scheduler, such as tcp://host:8786"
_CHATTY = frozenset({"distributed", "tornado", "asyncio"})  # whose loggers print what is said here in our words
_WORKERLESS = 6  # times as long for its first worker to come


class EngineError(CamgeoError):
    """The chunks cannot be computed for want of something around the run; what has landed stays."""


def here(job: Job, numbers: Sequence[int], count: int) -> Results:
    """Compute chunks on this machine, in `count` processes where they pay."""
    return spread(partial(result, job, key=job.key), numbers, count)


def at_once(function: Callable[[T], R], items: Iterable[T], count: int) -> Generator[tuple[T, R], None, None]:
    """Give each item, as it is done, with what a function of a module makes of it, `count` at once.

    Raises EngineError where a process is killed.
    """
    from concurrent.futures.process import BrokenProcessPool

    try:
        yield from workers.at_once(function, items, count)
    except BrokenProcessPool as error:
        raise EngineError(workers.KILLED.format("it")) from error


def spread(function: Callable[[T], R], items: Sequence[T], count: int) -> Generator[tuple[T, R], None, None]:
    """Give each item with what a function makes of it: one after another here, and `count` at once where that pays.

    It pays where what is left takes longer than starting processes, by the time of what is done.
    """
    started = time.perf_counter()
    for done, item in enumerate(items):
        spent = time.perf_counter() - started
        if count > 1 and done and spent > _TRIED and spent / done * (len(items) - done) > _PAYS:
            yield from at_once(function, items[done:], count)
            return
        yield item, function(item)


def dask(job: Job, numbers: Sequence[int], address: str) -> Results:
    """Let the workers of the Dask scheduler at `address` compute; they need camgeo, and no shared disk.

    Raises ModuleNotFoundError without the package distributed, VersionsError for workers of other versions, and
    EngineError where the scheduler does not answer or goes away, has no workers or such without camgeo, or a chunk is
    lost again and again.
    """
    from distributed import Client, wait

    first_of: Callable[..., Any] = wait
    with _quiet(), _connected(Client, address) as client, _lost(address):
        _demand_versions(client.run(versions, job.plan, on_error="return"), versions(job.plan))
        key, left = job.key, list(reversed(numbers))
        running: dict[Any, int] = {}
        alone = 0
        while left or running:
            room = workers.AHEAD * max(1, sum(client.nthreads().values())) - len(running)
            for _ in range(min(room, len(left))):
                number = left.pop()
                # not pure: a result is kept on our disk and nowhere else
                running[client.submit(result, job, number, key, pure=False)] = number
            try:
                with client.as_current():  # `wait` asks for it, and it is no business of other threads
                    done = first_of(list(running), timeout=_PATIENCE, return_when="FIRST_COMPLETED").done
            except TimeoutError:
                alone = 0 if client.nthreads() else alone + 1
                if alone >= _WORKERLESS:
                    raise EngineError(f"the scheduler at {address} has no workers") from None
                continue
            for future in done:
                yield running.pop(future), future.result()


def _demand_versions(workers: Mapping[str, dict[str, str] | Exception], ours: dict[str, str]) -> None:
    """Refuse workers of other versions, and those without camgeo, which the first chunk would end without a word."""
    for worker, theirs in workers.items():
        if isinstance(theirs, Exception):
            raise EngineError(f"the worker at {worker} cannot run camgeo: {theirs}")
        if theirs != ours:
            text, own = (", ".join(f"{name} {version}" for name, version in each.items()) for each in (theirs, ours))
            raise VersionsError(f"a worker has other versions than this run: {worker} has {text}, this run {own}")


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep distributed from printing lines of its own: whatever stops the run is raised."""
    import logging

    loggers = [logging.getLogger(name) for name in logging.root.manager.loggerDict if name.split(".")[0] in _CHATTY]
    before = [logger.disabled for logger in loggers]
    for logger in loggers:
        logger.disabled = True
    try:
        yield
    finally:
        for logger, disabled in zip(loggers, before, strict=True):
            logger.disabled = disabled


@contextmanager
def _connected(client: Any, address: str) -> Iterator[Any]:  # noqa: ANN401 - distributed has no types
    """A client of the scheduler, closed in the end; what it still had in hand is then dropped by the scheduler."""
    _heard(address)  # first: a client that finds nobody takes half a minute to say so, or for ever
    try:
        opened = client(address, timeout=_PATIENCE, set_as_default=False)
    except OSError as error:
        raise EngineError(f"the server at {address} is not a Dask scheduler") from error
    with opened:
        yield opened


def _heard(address: str) -> None:
    """Make sure that a scheduler listens at an address such as tcp://host:8786; raises EngineError otherwise."""
    import asyncio
    import socket
    import struct

    from distributed.comm import get_address_host_port

    parted: Callable[[str], tuple[str, int]] = get_address_host_port
    try:
        socket.create_connection(parted(address), _PATIENCE).close()  # at once: `rpc` tries again until its time is up
    except ValueError as error:
        raise EngineError(f"{address} {_NO_ADDRESS}") from error
    except OSError as error:
        why = f": {error.strerror}" if error.strerror else ""
        raise EngineError(f"no Dask scheduler answers at {address}{why}") from error
    try:
        kind = asyncio.run(asyncio.wait_for(_kind_of(address), _PATIENCE))
    except TimeoutError:
        text = f"the server at {address} does not answer as a Dask scheduler does: no answer in {_PATIENCE:g} s"
        raise EngineError(text) from None
    except (MemoryError, struct.error):  # its first bytes were read as a length
        raise EngineError(f"the server at {address} speaks another protocol than a Dask scheduler") from None
    except (OSError, ValueError) as error:
        raise EngineError(f"the server at {address} is not a Dask scheduler") from error
    if kind != "Scheduler":
        raise EngineError(f"the server at {address} is not a Dask scheduler, but a {kind}")


async def _kind_of(address: str) -> str:
    """What a node of Dask calls itself: Scheduler, Worker, Nanny."""
    from distributed import rpc

    reach: Callable[..., Any] = rpc
    async with reach(address, timeout=_PATIENCE) as node:
        return str((await node.identity())["type"])


@contextmanager
def _lost(address: str) -> Iterator[None]:
    """Say in our words that the scheduler went away, or that its workers die of a chunk."""
    from concurrent.futures import CancelledError

    from distributed.scheduler import KilledWorker

    try:
        yield
    except (CancelledError, OSError) as error:
        raise EngineError(f"the connection to the scheduler at {address} was lost") from error
    except KilledWorker as error:
        raise EngineError(f"workers of {address} were killed before their chunk was done") from error
