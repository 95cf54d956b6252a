"""The chunks of a sweep: computed by any engine, kept on disk, and gathered in their order.

The outcome of a sweep depends on its job alone, not on who computed its chunks, or when.
"""

from __future__ import annotations

import time
from contextlib import closing
from functools import partial
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

    from camgeo.capabilities.sweep.gather import Ranking, Selection
    from camgeo.recipe.limits import Limit
    from kin.numeric.arrays import Array

# called with what is counted, how many are done, of how many, and the seconds they took
Listener: TypeAlias = "Callable[[str, int, int, float], None]"

FOLDER = "sweep"  # of a recipe's output folder, with a folder for each job in it
_SHORT = 16  # digits of the key that name the folder


@dataclass(frozen=True)
class Engine:
    """Who computes chunks: the scheduler at an address, else at most `jobs` processes, by default one a core."""

    jobs: int | None = None
    scheduler: str | None = None

    def results(self, job: Job, numbers: Sequence[int]) -> engines.Results:
        """Numbers of chunks and bytes of their files, as they are done."""
        if self.scheduler is not None:
            return engines.dask(job, numbers, self.scheduler)
        return engines.spread(partial(result, job, key=job.key), numbers, self.processes)

    def __str__(self) -> str:
        if self.scheduler is not None:
            return f"dask at {self.scheduler}"
        if self.jobs is None:
            return "as many processes as pay"
        return "1 process" if self.jobs == 1 else f"up to {self.jobs} processes"

    @property
    def processes(self) -> int:
        """Greatest number of processes on this machine, also for the work after the chunks."""
        return self.jobs or workers.available()


@dataclass(frozen=True)
class Work:
    """Counts of a run: designs computed, designs reused from disk, damaged chunk files, and seconds spent."""

    computed: int
    reused: int
    damaged: int
    seconds: float


def chunks_of(job: Job, folder: Path) -> Chunks:
    """Chunks of a job, in a folder named by its key below the output folder of its recipe."""
    key = job.key
    return Chunks(folder / FOLDER / key[:_SHORT], key, job.plan)


def compute(job: Job, chunks: Chunks, engine: Engine, *, fresh: bool = False, listener: Listener | None = None) -> Work:
    """Compute every chunk that is not on disk, or all where `fresh`; each is written as soon as it is done.

    Raises what the engine raises, and OSError; chunks written by then stay.
    """
    chunks.open(fresh=fresh)
    missing, damaged = chunks.missing_chunks()
    started = time.perf_counter()
    sizes = {number: last - first for number in missing for first, last in (job.plan.span(number),)}
    total, done = sum(sizes.values()), 0
    if missing:
        with closing(engine.results(job, missing)) as results:
            for number, data in results:
                chunks.write(number, data)
                done += sizes[number]
                if listener is not None:
                    listener("designs", done, total, time.perf_counter() - started)
    return Work(done, job.plan.count - total, damaged, time.perf_counter() - started)


def gather_chunks(
    job: Job, chunks: Chunks, ranking: Ranking, slack: Callable[[Limit], float] | None = None
) -> Selection:
    """The designs that a ranking selects, see `gather`. Chunks damaged or removed meanwhile are computed again."""
    return gather(job.plan, ranking, (_figures(job, chunks, number) for number in range(job.plan.chunks)), slack)


def _figures(job: Job, chunks: Chunks, number: int) -> Mapping[str, Array]:
    """Figures (m,) by name of the designs of a chunk."""
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
