"""Results of chunks on disk: written as they land, whole or not at all, and checked when they are read.

A chunk's file ends with the checksum of all before it and opens with whose chunk it is, so a torn one, a changed one
and one of another sweep all count as not there. What is no regular file is never opened, and refused. Any number of
runs may write the same folder at once: what they write under one name is the same to the byte, and a rename puts it
there.
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
from camgeo.common.system import patient
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.plan import Plan

_MAGIC = b"camgeo sweep chunk 1\n"
_LEFT_OVER = 3600.0  # seconds after which a file still unfinished is a killed run's; writing one takes milliseconds
_MOST_BYTES = 1 << 24  # of a chunk's file: its designs with a hundred figures and more take less
_CHUNK = re.compile(r"chunk-[0-9]{7}\.bin")
_UNFINISHED = re.compile(r"\.chunk-[0-9]{7}\.[0-9]+\.part")


class ChunkError(CamgeoError, ValueError):
    """Bytes that are not the result of the chunk they are taken for."""


def encode(key: str, first: int, last: int, figures: Mapping[str, NDArray[np.float64]]) -> bytes:
    """A chunk's file: a line of JSON, the figures' arrays one after another, little-endian, and a SHA-256."""
    for name, values in figures.items():
        if values.shape != (last - first,) or values.dtype != np.float64:
            raise ValueError(f"{name} of designs {first} to {last}: {values.shape} of {values.dtype}")
    header = {"key": key, "first": first, "last": last, "figures": list(figures)}
    parts = [
        _MAGIC,
        json.dumps(header).encode() + b"\n",
        *(values.astype("<f8").tobytes() for values in figures.values()),
    ]
    body = b"".join(parts)
    return body + hashlib.sha256(body).digest()


def decode(data: bytes, key: str, first: int, last: int) -> dict[str, NDArray[np.float64]]:
    """Arrays (last - first,) by figure; raises ChunkError where the bytes are torn or belong elsewhere."""
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
    """The chunks of one sweep in the folder of its key."""

    folder: Path
    key: str
    plan: Plan

    def open(self, *, fresh: bool = False) -> None:
        """Make the folder, clear away what killed runs left unfinished, and, where `fresh`, every chunk.

        Raises SurroundingsError where something else stands in the place of a folder, or of a chunk's file.
        """
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except (FileExistsError, NotADirectoryError):
            raise _in_the_way(self.folder) from None
        for number in range(self.plan.chunks):
            _regular(self.path(number))
        for path in self.folder.iterdir():
            # another run may be clearing away, or finishing, the same file
            with suppress(FileNotFoundError):
                if (fresh and _CHUNK.fullmatch(path.name)) or (
                    _UNFINISHED.fullmatch(path.name)
                    and time.time() - path.lstat().st_mtime > _LEFT_OVER
                    and not path.is_dir()
                ):
                    path.unlink()

    def path(self, number: int) -> Path:
        """File of a chunk."""
        return self.folder / f"chunk-{number:07d}.bin"

    def read(self, number: int) -> dict[str, NDArray[np.float64]] | None:
        """Figures of a chunk, or None where there is no file; raises ChunkError where there is a bad one.

        Raises SurroundingsError where something else than a file stands there.
        """
        if not _regular(self.path(number)):
            return None
        try:
            with self.path(number).open("rb") as stream:
                data = stream.read(_MOST_BYTES)
        except FileNotFoundError:
            return None
        return decode(data, self.key, *self.plan.span(number))

    def sort_out(self) -> tuple[list[int], int]:
        """Numbers of the chunks still to be computed, and how many bad files were removed among them."""
        missing, bad = [], 0
        for number in range(self.plan.chunks):
            try:
                if self.read(number) is None:
                    missing.append(number)
            except ChunkError:
                bad += 1
                self.path(number).unlink(missing_ok=True)
                missing.append(number)
        return missing, bad

    def write(self, number: int, data: bytes) -> None:
        """Put a chunk in its place; raises ChunkError for bytes that are not its result, before anything is written."""
        decode(data, self.key, *self.plan.span(number))
        part = self.folder / f".chunk-{number:07d}.{os.getpid()}.part"
        try:
            part.write_bytes(data)
            patient(lambda: part.replace(self.path(number)))
        except BaseException:
            part.unlink(missing_ok=True)
            raise


def _regular(path: Path) -> bool:
    """Whether there is a file; raises SurroundingsError for what is none: a pipe waits, a device may have no end."""
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        return False
    if stat.S_ISREG(mode):
        return True
    kind = "a folder" if stat.S_ISDIR(mode) else "a pipe or a device"
    raise SurroundingsError(f"{kind}, where the sweep keeps a file of its results: move it or remove it", path)


def _in_the_way(folder: Path) -> SurroundingsError:
    """What stands where a folder, or one above it, is to be made."""
    place = next(path for path in reversed((folder, *folder.parents)) if os.path.lexists(path) and not path.is_dir())
    return SurroundingsError("not a folder, where the sweep keeps its results: move it or remove it", place)
