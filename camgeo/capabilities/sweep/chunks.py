"""The chunks of a sweep: computed by any engine, kept on disk, and gathered in their order.

The outcome of a sweep depends on its job alone, not on who computed its chunks, or when. Results are written as they
land, whole or not at all, and checked when they are read. A chunk's file begins with its key and designs and ends with
a checksum, so a truncated one, a changed one and one of another sweep all count as missing. Any number of
runs may write the same folder at once: under one name they write the same bytes, put there by a rename.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import time
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing, suppress
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np

from camgeo.capabilities.sweep.gather import gather
from camgeo.common.errors import SurroundingsError
from camgeo.common.system import retry
from camgeo.version import __version__
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.sweep.gather import Ranking, Selection
    from camgeo.capabilities.sweep.plan import Plan
    from camgeo.recipe.limits import Limit
    from kin.numeric.arrays import Array

REVISION = 3  # raised with every change of a figure's values, as the version is with every release

FOLDER = "sweep"  # of a recipe's output folder, with a folder for each job in it
_SHORT = 16  # digits of the key that name the folder
_MAGIC = b"camgeo sweep chunk 1\n"
_ABANDONED = 3600.0  # seconds after which a file still unfinished is a killed run's; writing one takes milliseconds
_CHUNK = re.compile(r"chunk-[0-9]{7}\.bin")
_UNFINISHED = re.compile(r"\.chunk-[0-9]{7}\.[0-9]+\.part")

Compute = Callable[[Any, "Array"], Mapping[str, "Array"]]
Listener: TypeAlias = "Callable[[str, int, int, float], None]"
"""Called with what is counted, how many are done, of how many, and the seconds they took."""


Results: TypeAlias = Generator[tuple[int, bytes], None, None]


class EngineError(CamgeoError):
    """Workers or a scheduler are missing or lost, so that chunks cannot be computed; those written stay."""


class VersionsError(EngineError):
    """A worker has other versions than the run, or reads the recipe otherwise, and so would compute other figures."""


class ChunkError(CamgeoError, ValueError):
    """The bytes of a file are not the result of its chunk."""


@dataclass(frozen=True)
class SweepJob:
    """A plan, and how the figures of its designs are computed; it travels to any worker.

    `compute(scene, values (m, axes))` gives the figures of m designs, arrays (m,) of float64 by name; it is a function
    of a module, so that a worker finds it by name. `scene` is plain data, all of which some figure depends on.
    """

    plan: Plan
    scene: Any
    compute: Compute

    @property
    def key(self) -> str:
        """SHA-256 of the plan, the scene, the function's name, REVISION and the packages' versions, as 64 hex digits.

        Raises ModuleNotFoundError for a plan by Sobol's sequence without scipy.
        """
        parts = {
            "plan": repr(self.plan),
            "scene": repr(self.scene),
            "compute": f"{self.compute.__module__}.{self.compute.__qualname__}",
            "revision": REVISION,
            "versions": versions(self.plan),
        }
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def versions(plan: Plan) -> dict[str, str]:
    """Versions of the packages that figures depend on, by name; scipy's only where it makes the plan.

    Raises ModuleNotFoundError where the plan needs scipy and it is missing.
    """
    packages = {"camgeo": __version__, "numpy": np.__version__}
    if plan.method == "sobol":
        import scipy

        packages["scipy"] = scipy.__version__
    return packages


def result(job: SweepJob, number: int, key: str) -> bytes:
    """Bytes of the file of chunk `number`, computed in this process.

    Raises VersionsError where the job has another key here than `key`.
    """
    if job.key != key:
        packages = ", ".join(f"{name} {version}" for name, version in versions(job.plan).items())
        raise VersionsError(f"a worker has other versions than this run, or reads the recipe otherwise: {packages}")
    first, last = job.plan.span(number)
    return encode(key, first, last, job.compute(job.scene, job.plan.values(first, last)))


def encode(key: str, first: int, last: int, figures: Mapping[str, Array]) -> bytes:
    """Bytes of the file of a chunk that has the designs `first` to `last` - 1.

    They are a line that names the format, a line of JSON, the figures (last - first,) one after another as
    little-endian float64, and a SHA-256. Raises ValueError for figures of another shape or type.
    """
    for name, values in figures.items():
        if values.shape != (last - first,) or values.dtype != np.float64:
            raise ValueError(f"{name} of designs {first} to {last}: {values.shape} of {values.dtype}")
    header = {"key": key, "first": first, "last": last, "figures": list(figures)}
    payload = b"".join(values.astype("<f8").tobytes() for values in figures.values())
    body = _MAGIC + json.dumps(header).encode() + b"\n" + payload
    return body + hashlib.sha256(body).digest()


def decode(data: bytes, key: str, first: int, last: int) -> dict[str, Array]:
    """Figures (last - first,) by name from the bytes of a chunk's file.

    Raises ChunkError for damaged bytes, and for bytes of a sweep with another key or of a chunk with other designs.
    """
    body, checksum = data[:-32], data[-32:]
    if not body.startswith(_MAGIC) or hashlib.sha256(body).digest() != checksum:
        raise ChunkError("torn or changed")
    line, _, payload = body.removeprefix(_MAGIC).partition(b"\n")
    header = json.loads(line)
    if (header["key"], header["first"], header["last"]) != (key, first, last):
        raise ChunkError("of another sweep, or another chunk of this one")
    rows = np.frombuffer(payload, "<f8").reshape(len(header["figures"]), last - first)
    return {name: row.astype(np.float64) for name, row in zip(header["figures"], rows, strict=True)}


@dataclass(frozen=True)
class Chunks:
    """Files of the chunks of one sweep, in the folder of its key."""

    folder: Path
    key: str
    plan: Plan

    def open(self, *, fresh: bool = False) -> None:
        """Make the folder; remove unfinished files over an hour old, left by killed runs, and, if `fresh`, every chunk.

        Raises SurroundingsError where something else is in the place of a folder, OSError where the disk refuses.
        """
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except (FileExistsError, NotADirectoryError):
            blocked = (self.folder, *self.folder.parents)
            place = next(path for path in reversed(blocked) if os.path.lexists(path) and not path.is_dir())
            problem = "not a folder, where the sweep keeps its results: move it or remove it"
            raise SurroundingsError(problem, place) from None
        for path in self.folder.iterdir():
            # another run may be clearing away, or finishing, the same file
            with suppress(FileNotFoundError):
                if (fresh and _CHUNK.fullmatch(path.name)) or (
                    _UNFINISHED.fullmatch(path.name) and time.time() - path.lstat().st_mtime > _ABANDONED
                ):
                    path.unlink()

    def path(self, number: int) -> Path:
        """Path of the file of chunk `number`, counted from 0, whether or not it exists."""
        return self.folder / f"chunk-{number:07d}.bin"

    def read(self, number: int) -> dict[str, Array] | None:
        """Figures (m,) by name of the m designs of chunk `number`, or None without a file.

        Raises ChunkError for a damaged file, OSError where the disk refuses.
        """
        try:
            data = self.path(number).read_bytes()
        except FileNotFoundError:
            return None
        return decode(data, self.key, *self.plan.span(number))

    def missing_chunks(self) -> tuple[list[int], int]:
        """Numbers of the chunks still to be computed, and how many of them had damaged files, which are removed.

        Raises OSError where the disk refuses.
        """
        missing, damaged = [], 0
        for number in range(self.plan.chunks):
            try:
                if self.read(number) is None:
                    missing.append(number)
            except ChunkError:
                damaged += 1
                self.path(number).unlink(missing_ok=True)
                missing.append(number)
        return missing, damaged

    def write(self, number: int, data: bytes) -> None:
        """Write the file of chunk `number`, whole or not at all.

        Raises ChunkError for `data` that are not its result, OSError where the disk refuses.
        """
        decode(data, self.key, *self.plan.span(number))
        part = self.folder / f".chunk-{number:07d}.{os.getpid()}.part"
        try:
            part.write_bytes(data)
            retry(lambda: part.replace(self.path(number)))
        except BaseException:
            part.unlink(missing_ok=True)
            raise


def chunks_of(job: SweepJob, folder: Path) -> Chunks:
    """Chunks of a job; their folder, named by its key, lies below `folder`, the output folder of the recipe."""
    key = job.key
    return Chunks(folder / FOLDER / key[:_SHORT], key, job.plan)


@dataclass(frozen=True)
class Work:
    """Counts of a run: designs computed, designs reused from disk, damaged chunk files, and seconds spent."""

    computed: int
    reused: int
    damaged: int
    seconds: float


class Engine(Protocol):
    """What computes chunks, such as processes of this machine."""

    def results(self, job: SweepJob, numbers: Sequence[int]) -> Results:
        """Pairs of a chunk's number, of those in `numbers`, and the bytes of its file, as they are done."""


def compute(
    job: SweepJob, chunks: Chunks, engine: Engine, *, fresh: bool = False, listener: Listener | None = None
) -> Work:
    """Compute every chunk that is not on disk, or all if `fresh`, and return the counts of the run.

    Each chunk is written as soon as it is done, and `listener` is called with the number of designs. Raises EngineError
    where workers or a scheduler are missing or lost, VersionsError for workers of other versions, ModuleNotFoundError
    for a missing package, SurroundingsError where something else is in the place of a folder, OSError where the disk
    refuses; chunks written by then stay.
    """
    chunks.open(fresh=fresh)
    missing, damaged = chunks.missing_chunks()
    started = time.perf_counter()
    sizes = {number: last - first for number in missing for first, last in (job.plan.span(number),)}
    total, done = sum(sizes.values()), 0
    if missing:
        if listener is not None:
            listener("designs", 0, total, 0.0)
        with closing(engine.results(job, missing)) as results:
            for number, data in results:
                chunks.write(number, data)
                done += sizes[number]
                if listener is not None:
                    listener("designs", done, total, time.perf_counter() - started)
    return Work(done, job.plan.count - total, damaged, time.perf_counter() - started)


def gather_chunks(
    job: SweepJob, chunks: Chunks, ranking: Ranking, slack: Callable[[Limit], float] | None = None
) -> Selection:
    """The designs that a ranking selects, best first; they may miss a limit by its `slack`, in the figure's unit.

    Chunks damaged or removed meanwhile are computed again. Raises FileNotFoundError where one is removed as soon as it
    is written, OSError where the disk refuses.
    """
    return gather(job.plan, ranking, (_figures(job, chunks, number) for number in range(job.plan.chunks)), slack)


def _figures(job: SweepJob, chunks: Chunks, number: int) -> Mapping[str, Array]:
    """Figures (m,) by name of the designs of a chunk, which is computed again where its file is damaged or missing."""
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
