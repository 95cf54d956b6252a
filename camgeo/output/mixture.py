"""Files and reports of one folder that do not belong together, found by the reports' checksums.

No file system replaces several files in one step. A run that is killed between its commit and its last rename leaves
new files beside the old report until the next run of that name completes it (`camgeo.output.output_folder`). Files are
also changed by hand.
"""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

from camgeo.common.terminal import escaped
from camgeo.output.output_folder import REJECTED
from camgeo.registry import registry

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

REPORTS = ("report.json", "page.json")


def mixtures(folder: Path, names: Collection[str] = ()) -> list[str]:
    """Messages, one for each report in a folder of which a listed file is missing or has another checksum.

    With `names` of files, only reports that list any of them are looked at. A file that is no report of camgeo, or
    cannot be read, gives no message.
    """
    messages = []
    for name in (*REPORTS, *(name for label in registry.labels().values() for name in label.reports)):
        sums = _sums(folder / name)
        if names and not any(file_name in sums for file_name in names):
            continue
        changed = [file_name for file_name, checksum in sums.items() if _sum(folder / file_name) != checksum]
        if changed:
            files = ", ".join(escaped(file_name) for file_name in changed)
            phrase = "are not the files" if len(changed) > 1 else "is not the file"
            place = escaped(str(folder / name))
            messages.append(f"{place}: {files} {phrase} that it lists: {_why(folder)}; export again")
    return messages


def _why(folder: Path) -> str:
    """Words for the cause of a mixture: a run that was cut off leaves its private folder beside the output folder."""
    name = folder.name.removesuffix(REJECTED)
    try:
        beside = [path.name for path in folder.absolute().parent.iterdir() if path.name.startswith(f".{name}.")]
    except OSError:
        beside = []
    cut_off = any(private.endswith(("swap", "undo")) for private in beside)
    return "a run was killed between two sets of files" if cut_off else "changed since, or of another run"


def _sums(report: Path) -> dict[str, str]:
    """Checksums that a report lists, by file name; empty for a file that is no report or cannot be read."""
    try:
        if not report.is_file():
            return {}
        entries = json.loads(report.read_bytes())["files"]
        return {
            entry["path"]: entry["sha256"]
            for entry in entries
            if "sha256" in entry and isinstance(entry["path"], str) and not set(entry["path"]) & set("/\\\0")
        }
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return {}


def _sum(path: Path) -> str:
    """SHA-256 checksum of a file, in hexadecimal; empty where no file can be read."""
    try:
        if not path.is_file():
            return ""
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return ""
