"""Sets of files that are judged together, and the disc of the cam that each file holds.

The end of a file's name gives its disc, `-1` or `-2`; other files of a kind that holds one disc take the free discs in
their order. A set has files of one kind with the same requirement.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from camgeo.registry.formats import FORMATS
from kin.numeric.records import dataclass, field
from kin.read.files import kind_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe


@dataclass(frozen=True)
class Requirement:
    """Kind of files, the recipe's request that lists them, None where none does, and their tolerance, mm."""

    kind: str
    request: FileRequest | None
    tolerance: float


@dataclass(frozen=True)
class FileSet:
    """Files that are judged together: what is required of them, and the stem of their names without a disc's number.

    `files` has (place in the call, path, disc) of each file; place and disc count from 0, a disc of None is all discs.
    """

    requirement: Requirement
    stem: str
    files: list[tuple[int, Path, int | None]] = field(default_factory=list)

    @property
    def discs(self) -> set[int | None]:
        """Discs that the files hold, counted from 0; None among them for a file with all discs."""
        return {disc for _, _, disc in self.files}


def sets_of(recipe: Recipe, paths: Sequence[Path], tolerance: float | None) -> list[FileSet]:
    """Sets of files of any origin: one file, or files of different discs of one cam, at most one for each disc.

    `tolerance`, mm, replaces the recipe's; None keeps it. Raises ValueError for an unknown suffix.
    """
    count, sets = recipe.cam.arrangement.discs, list[FileSet]()
    for place, path in enumerate(paths):
        kind, request = kind_of(path), recipe.request_of(path.name)
        within = ((request and request.tolerance) or recipe.export.tolerance) if tolerance is None else tolerance
        requirement = Requirement(kind, request, within)
        stem, disc = _disc_of(recipe, path, request, count)
        if count == 1 or (disc is None and not FORMATS[kind].by_disc):
            sets.append(FileSet(requirement, stem, [(place, path, 0 if count == 1 else None)]))
            continue
        # a file joins a set that still lacks its disc, best one of the same stem; else it begins a set
        open_sets = [
            file_set
            for file_set in sets
            if file_set.requirement == requirement and None not in file_set.discs and len(file_set.files) < count
        ]
        fitting = [file_set for file_set in open_sets if disc is None or disc not in file_set.discs]
        chosen = next((file_set for file_set in fitting if file_set.stem == stem), next(iter(fitting), None))
        if chosen is None:
            chosen = FileSet(requirement, stem)
            sets.append(chosen)
        rank = min(set(range(count)) - chosen.discs) if disc is None else disc
        chosen.files.append((place, path, rank))
    return sets


def _disc_of(recipe: Recipe, path: Path, request: FileRequest | None, count: int) -> tuple[str, int | None]:
    """Stem of a name without the end for the disc, and that disc, counted from 0 (`-1` is 0); None without such an end.

    `count` is the number of discs. A name that the recipe gives to its one file of all discs has no such end.
    """
    match = re.fullmatch(r"(.+)-([1-9])", path.stem)
    whole = request is not None and recipe.filenames(request) == (path.name,)
    if match is None or whole or int(match[2]) > count:
        return path.stem, None
    return match[1], int(match[2]) - 1
