"""Files that a command writes where the user says, and never over another one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.common.errors import CallError, SurroundingsError
from camgeo.common.terminal import escaped

if TYPE_CHECKING:
    from collections.abc import Mapping


def demand_new(*names: str | None) -> None:
    """Raise CallError for names that are taken or stand twice, before work is done for them; None names nothing."""
    wanted = [name for name in names if name is not None]
    taken = [name for name in wanted if Path(name).exists()]
    if taken:
        raise CallError(*(f"{escaped(name)} exists already and is left as it is" for name in taken))
    paths = [Path(name).resolve() for name in wanted]
    for name, path in zip(wanted, paths, strict=True):
        if paths.count(path) > 1:
            raise CallError(f"{escaped(name)} would be written twice: give each file a name of its own")


def write_new(texts: Mapping[str, str]) -> None:
    """Write texts by the names of their files, all or none.

    Raises CallError for a name that is taken, SurroundingsError where the disk refuses.
    """
    written: list[Path] = []
    try:
        for name, text in texts.items():
            with open(name, "x", encoding="utf-8", newline="\n") as stream:  # noqa: PTH123 - pathlib has no mode "x" on 3.11
                written.append(Path(name))
                stream.write(text)
    except OSError as error:
        for path in written:
            path.unlink(missing_ok=True)
        if isinstance(error, FileExistsError):
            raise CallError(f"{escaped(name)} exists already and is left as it is") from None
        raise SurroundingsError(error.strerror or str(error), Path(name)) from error
