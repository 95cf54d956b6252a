"""New files of a command, which never replace a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.common.errors import CallError, SurroundingsError
from camgeo.common.terminal import escaped

if TYPE_CHECKING:
    from collections.abc import Mapping


def demand_new(names: Mapping[str, str | None]) -> None:
    """Raise CallError for names of files that exist already or are given twice; a name of None is left out.

    Names are by what writes the file, such as `--page`.
    """
    writers = {writer: name for writer, name in names.items() if name is not None}
    file_names = [*writers.values()]
    existing = [name for name in file_names if Path(name).exists()]
    if existing:
        raise CallError(*(f"{escaped(name)} exists already and is left as it is" for name in existing))
    by_path: dict[Path, list[str]] = {}
    for writer, name in writers.items():
        by_path.setdefault(Path(name).resolve(), []).append(writer)
    for both in by_path.values():
        if len(both) > 1:
            problem = f"{escaped(writers[both[0]])} would be written twice, by {' and by '.join(both)}"
            raise CallError(f"{problem}: give each file a name of its own")


def write_new(texts: Mapping[str, str]) -> None:
    """Write new files, each with the text under its name: all or none of them.

    Raises CallError for a file that exists, SurroundingsError where the file system refuses.
    """
    paths: list[Path] = []
    try:
        for name, text in texts.items():
            with open(name, "x", encoding="utf-8", newline="\n") as stream:  # noqa: PTH123 - pathlib has no mode "x" on 3.11
                paths.append(Path(name))
                stream.write(text)
    except OSError as error:
        for path in paths:
            path.unlink(missing_ok=True)
        if isinstance(error, FileExistsError):
            raise CallError(f"{escaped(name)} exists already and is left as it is") from None
        raise SurroundingsError(error.strerror or str(error), Path(name)) from error
