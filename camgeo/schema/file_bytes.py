"""Files that a recipe or a call names: what is no file is refused, no pipe is waited for, no large file read whole."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.schema.scalars import Complaint

if TYPE_CHECKING:
    from os import PathLike


FOLDER = "a folder"


def path_fault(path: str | PathLike[str]) -> str:
    """Reason why a path leads to no file, in a few words such as `a folder`; empty where it does."""
    try:
        mode = Path(path).stat().st_mode
    except FileNotFoundError:
        return "the file does not exist"
    except OSError as error:  # a name too long, a folder without permission
        return f"cannot be read: {error.strerror or error}"
    except ValueError:  # a null character
        return "not the name of a file"
    if stat.S_ISDIR(mode):
        return FOLDER
    return "" if stat.S_ISREG(mode) else "a pipe, a socket or a device, not a file"  # whose reader waits, perhaps


def read_bytes(path: str | PathLike[str], most: int, noun: str) -> bytes:
    """Bytes of a file, of a longer one the first `most` + 1; `noun` names the content of the file in messages.

    Raises Complaint where the path leads to no file, and for a file that cannot be read.
    """
    if fault := path_fault(path):
        raise Complaint(fault, f"save the {noun} as a file" if fault.endswith("not a file") else "")
    try:
        with Path(path).open("rb") as stream:
            return stream.read(most + 1)
    except OSError as error:
        raise Complaint(f"cannot be read: {error.strerror or error}") from None
