"""One sweep from its plan to its files: chunks, by any engine; what they come to; the best polished; the outputs.

What a sweep comes to depends on its job alone. The chunks it has are those on disk, whoever computed them and when, and
everything behind them is computed here from those chunks in their order.
"""

from __future__ import annotations

import time
from contextlib import closing
from typing import TYPE_CHECKING, TypeAlias

from camgeo.capabilities.sweep import engines
from camgeo.capabilities.sweep.gather import gather
from camgeo.capabilities.sweep.job import Job, result
from camgeo.capabilities.sweep.store import ChunkError, Chunks
from camgeo.common import workers
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.gather import Gathered, Ranking
    from camgeo.recipe.limits import Limit

# hears how far a sweep is: what is counted, how many are done, of how many, and the seconds they took
Listener: TypeAlias = "Callable[[str, int, int, float], None]"

FOLDER = "sweep"  # of a recipe's output folder, with a folder for each job in it
_SHORT = 16  # digits of the key that name the folder


@dataclass(frozen=True)
class How:
    """Who computes: the scheduler at an address, else so many processes at most, else as many as there are cores."""

    jobs: int | None = None
    scheduler: str | None = None

    def results(self, job: Job, numbers: Sequence[int]) -> engines.Results:
        """Chunks as they land."""
        if self.scheduler is not None:
            return engines.dask(job, numbers, self.scheduler)
        return engines.here(job, numbers, self.processes)

    def __str__(self) -> str:
        if self.scheduler is not None:
            return f"dask at {self.scheduler}"
        if self.jobs is None:
            return "as many processes as pay"
        return "1 process" if self.jobs == 1 else f"up to {self.jobs} processes"

    @property
    def processes(self) -> int:
        """Processes of this machine for what is left to do here in the end."""
        return self.jobs or workers.available()


@dataclass(frozen=True)
class Work:
    """What this run did: designs computed and found on disk, chunk files that were damaged, and seconds spent."""

    computed: int
    reused: int
    damaged: int
    seconds: float


def chunks_of(job: Job, folder: Path) -> Chunks:
    """Where the chunks of a job are kept, below the output folder of its recipe."""
    key = job.key
    return Chunks(folder / FOLDER / key[:_SHORT], key, job.plan)


def compute(job: Job, chunks: Chunks, how: How, *, fresh: bool = False, listener: Listener | None = None) -> Work:
    """Compute every chunk that is not on disk, each written as it lands.

    Raises what the engine raises, and OSError; what has landed by then stays.
    """
    chunks.open(fresh=fresh)
    missing, damaged = chunks.sort_out()
    started = time.perf_counter()
    sizes = {number: last - first for number in missing for first, last in (job.plan.span(number),)}
    wanted, done = sum(sizes.values()), 0
    if missing:
        with closing(how.results(job, missing)) as results:
            for number, data in results:
                chunks.write(number, data)
                done += sizes[number]
                if listener is not None:
                    listener("designs", done, wanted, time.perf_counter() - started)
    return Work(done, job.plan.count - wanted, damaged, time.perf_counter() - started)


def gathered(job: Job, chunks: Chunks, ranking: Ranking, slack: Callable[[Limit], float] | None = None) -> Gathered:
    """What the chunks come to. One that was spoilt or taken away meanwhile is computed again."""
    return gather(job.plan, ranking, (_figures(job, chunks, number) for number in range(job.plan.chunks)), slack)


def _figures(job: Job, chunks: Chunks, number: int) -> Mapping[str, NDArray[np.float64]]:
    try:
        figures = chunks.read(number)
    except ChunkError:
        figures = None
    if figures is None:
        chunks.write(number, result(job, number, chunks.key))
        figures = chunks.read(number)
    if figures is None:
        raise FileNotFoundError(2, "a chunk was taken away as soon as it was written", str(chunks.path(number)))
    return figures
