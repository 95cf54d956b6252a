"""Results of chunks on disk: written as they land, whole or not at all, and checked when they are read.

A chunk's file begins with its key and designs and ends with a checksum, so a truncated one, a changed one and one of
another sweep all count as missing. What is no regular file is refused, never opened. Any number of runs may write the
same folder at once: under one name they write the same bytes, put there by a rename.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import stat
import time
from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.errors import SurroundingsError
from camgeo.common.system import retry
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from camgeo.capabilities.sweep.plan import Plan
    from kin.numeric.arrays import Array

_MAGIC = b"camgeo sweep chunk 1\n"
_ABANDONED = 3600.0  # seconds after which a file still unfinished is a killed run's; writing one takes milliseconds
_MOST_BYTES = 1 << 24  # of a chunk's file: its designs with a hundred figures and more take less
_CHUNK = re.compile(r"chunk-[0-9]{7}\.bin")
_UNFINISHED = re.compile(r"\.chunk-[0-9]{7}\.[0-9]+\.part")


class ChunkError(CamgeoError, ValueError):
    """The bytes of a file are not the result of its chunk."""


def encode(key: str, first: int, last: int, figures: Mapping[str, Array]) -> bytes:
    """Bytes of a chunk's file: a line of JSON, the figures (last - first,) as little-endian float64, and a SHA-256.

    Raises ValueError for figures of another shape or type.
    """
    for name, values in figures.items():
        if values.shape != (last - first,) or values.dtype != np.float64:
            raise ValueError(f"{name} of designs {first} to {last}: {values.shape} of {values.dtype}")
    header = {"key": key, "first": first, "last": last, "figures": list(figures)}
    payload = b"".join(values.astype("<f8").tobytes() for values in figures.values())
    body = _MAGIC + json.dumps(header).encode() + b"\n" + payload
    return body + hashlib.sha256(body).digest()


def decode(data: bytes, key: str, first: int, last: int) -> dict[str, Array]:
    """Figures (last - first,) by name; raises ChunkError for damaged bytes, and those of another chunk or sweep."""
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
        """Make the folder; remove files that killed runs left unfinished, and, where `fresh`, every chunk.

        Raises SurroundingsError where something else is in the place of a folder, or of a chunk's file.
        """
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except (FileExistsError, NotADirectoryError):
            blocked = (self.folder, *self.folder.parents)
            place = next(path for path in reversed(blocked) if os.path.lexists(path) and not path.is_dir())
            problem = "not a folder, where the sweep keeps its results: move it or remove it"
            raise SurroundingsError(problem, place) from None
        for number in range(self.plan.chunks):
            _is_regular_file(self.path(number))
        for path in self.folder.iterdir():
            # another run may be clearing away, or finishing, the same file
            with suppress(FileNotFoundError):
                if (fresh and _CHUNK.fullmatch(path.name)) or (
                    _UNFINISHED.fullmatch(path.name)
                    and time.time() - path.lstat().st_mtime > _ABANDONED
                    and not path.is_dir()
                ):
                    path.unlink()

    def path(self, number: int) -> Path:
        """File of a chunk."""
        return self.folder / f"chunk-{number:07d}.bin"

    def read(self, number: int) -> dict[str, Array] | None:
        """Figures (m,) of a chunk by name, or None without a file.

        Raises ChunkError for a damaged file, SurroundingsError for what is no regular file.
        """
        if not _is_regular_file(self.path(number)):
            return None
        try:
            with self.path(number).open("rb") as stream:
                data = stream.read(_MOST_BYTES)
        except FileNotFoundError:
            return None
        return decode(data, self.key, *self.plan.span(number))

    def missing_chunks(self) -> tuple[list[int], int]:
        """Numbers of the chunks still to be computed, and how many of them had damaged files, which are removed."""
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
        """Write the file of a chunk, whole or not at all; raises ChunkError for bytes that are not its result."""
        decode(data, self.key, *self.plan.span(number))
        part = self.folder / f".chunk-{number:07d}.{os.getpid()}.part"
        try:
            part.write_bytes(data)
            retry(lambda: part.replace(self.path(number)))
        except BaseException:
            part.unlink(missing_ok=True)
            raise


def _is_regular_file(path: Path) -> bool:
    """Whether there is a file; raises SurroundingsError for another thing: a pipe waits, a device may have no end."""
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        return False
    if stat.S_ISREG(mode):
        return True
    kind = "a folder" if stat.S_ISDIR(mode) else "a pipe or a device"
    raise SurroundingsError(f"{kind}, where the sweep keeps a file of its results: move it or remove it", path)
