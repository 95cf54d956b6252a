"""Errors that any package may raise: a call that makes no sense, and surroundings that refuse."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.common.terminal import escaped
from kin.numeric.errors import CamgeoError

if TYPE_CHECKING:
    from collections.abc import Iterator

DISTRIBUTIONS = {"yaml": "PyYAML"}  # packages that are installed by another name than they are imported by


class CallError(CamgeoError, ValueError):
    """A call cannot be carried out: a path without a file, an unknown form; `faults` has a line for each fault."""

    def __init__(self, *faults: str) -> None:
        super().__init__(*faults)
        self.faults = faults

    def __str__(self) -> str:
        """Text with a line for each fault."""
        return "\n".join(self.faults)


class SurroundingsError(CamgeoError):
    """Surroundings of a run are missing or refuse: the disk, a permission, a package.

    `path` is the file or folder concerned; it begins the message.
    """

    def __init__(self, message: str, path: Path) -> None:
        super().__init__(f"{escaped(str(path))}: {message}")
        self.path = path


class BusyError(SurroundingsError):
    """Another run of the same name is at work; `path` is its folder."""


@contextmanager
def with_packages() -> Iterator[None]:
    """Context or decorator that turns a ModuleNotFoundError into a SurroundingsError.

    Its message has the command that installs the package.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        name = (error.name or "").partition(".")[0]
        text = f"the package {name} is missing: pip install {DISTRIBUTIONS.get(name, name)}"
        raise SurroundingsError(text, Path(sys.prefix)) from error
