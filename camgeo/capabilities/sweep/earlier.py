"""The files of an earlier run of the same sweep, which are not made again where nothing that decides them changed."""

from __future__ import annotations

import hashlib
import json
from importlib.util import find_spec
from typing import TYPE_CHECKING

from camgeo.report.document import as_json, file_entry

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.sweep.task import SweepTask
    from camgeo.checks.declaration import Entry

NOTE = "files.json"  # beside the chunks: what decided the files, and the digest of their report
OPTIONAL = ("scipy", "matplotlib", "pyarrow")  # packages without which files are left out


def decisive(task: SweepTask, key: str) -> str:
    """All that decides the files of a sweep: the recipe, the key of its chunks, and which packages there are."""
    return json.dumps([key, task.recipe.name, task.recipe.text, [find_spec(name) is not None for name in OPTIONAL]])


def remember(folder: Path, decided: str, report: Entry) -> None:
    """Note in the folder of the chunks what decided the files that a report without `run` lists.

    A report with a figure that JSON cannot hold is not noted.
    """
    text = as_json(report)
    if json.loads(text) == report:
        (folder / NOTE).write_text(json.dumps([_digest(decided), _digest(text)]), encoding="utf-8")


def earlier(folder: Path, place: Path, report_name: str, decided: str) -> tuple[dict[str, bytes], Entry] | None:
    """Contents of the files in `place` by name, and their report without `run`; None where anything differs."""
    try:
        note = json.loads((folder / NOTE).read_text(encoding="utf-8"))
        report = json.loads((place / report_name).read_text(encoding="utf-8"))
        del report["run"]
        if note != [_digest(decided), _digest(as_json(report))]:
            return None
        files = {entry["path"]: (place / entry["path"]).read_bytes() for entry in report["files"]}
    except (OSError, ValueError, LookupError, TypeError):
        return None
    return (files, report) if report["files"] == [file_entry(*file) for file in files.items()] else None


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
