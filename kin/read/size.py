"""How much of a file is read: of each format so many bytes, and so many pieces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.read.errors import ReadError
from kin.read.formats import FORMATS

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["MOST_PIECES", "contents", "demand_few_pieces", "oversize"]

MOST_PIECES = 1_000_000  # of the contours of a drawing: a polygon within 1e-9 mm may have more than half of that


def oversize(path: Path, kind: str) -> str:
    """Say that a file is larger than is read of its kind; empty where it is not. Raises OSError as `stat` does."""
    size, most = path.stat().st_size, FORMATS[kind].most
    return "" if size <= most else f"{size / 1e6:.4g} MB, and of a {kind} up to {most / 1e6:.4g} MB are read"


def demand_few_pieces(count: int, path: Path) -> None:
    """Raise ReadError for more pieces than the contours of a part have, before the work on each is begun."""
    if count > MOST_PIECES:
        raise ReadError("range", f"its contours have {count} pieces; up to {MOST_PIECES} are read", path)


def contents(path: Path, kind: str) -> bytes:
    """The bytes of a file; raises ReadError for a larger one before it is read, OSError as the file system does."""
    if problem := oversize(path, kind):
        raise ReadError("range", problem, path)
    return path.read_bytes()
