"""The bytes of a file that a recipe or a call names: no pipe is waited for, and no large file is read whole."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.schema.scalars import Complaint

if TYPE_CHECKING:
    from os import PathLike


def read_bytes(path: str | PathLike[str], most: int, noun: str) -> bytes:
    """Bytes of a file, of a longer one the first `most` + 1; `noun` names the content of the file in messages.

    Raises Complaint for a file that does not exist or cannot be read, and for a pipe or a device.
    """
    try:
        mode = Path(path).stat().st_mode
        waits = not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))  # its reader, for ever perhaps
        if not waits:
            with Path(path).open("rb") as stream:
                return stream.read(most + 1)
    except FileNotFoundError:
        raise Complaint("the file does not exist") from None
    except OSError as error:
        raise Complaint(f"cannot be read: {error.strerror or error}") from None
    except ValueError:  # a null character
        raise Complaint("not the name of a file") from None
    raise Complaint("a pipe or a device, not a file", f"save the {noun} as a file")
