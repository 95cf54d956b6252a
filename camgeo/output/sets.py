"""Which of the files that are given to be judged go together, and which disc of the cam each of them holds.

A file tells its disc by the end of its name, `-1` or `-2`; others of a kind that holds one disc are taken in the order
in which they are given. Files go together that are of one kind and are held to the same.
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
class Held:
    """What files are held to: the request that they may be of, and the tolerance, mm."""

    kind: str
    asked: FileRequest | None
    tolerance: float


@dataclass(frozen=True)
class FileSet:
    """Files that go together, by their places among those given, each with its disc, counted from 0; None for all."""

    held: Held
    stem: str
    files: list[tuple[int, Path, int | None]] = field(default_factory=list)

    @property
    def discs(self) -> set[int | None]:
        """The discs that are there."""
        return {disc for _, _, disc in self.files}


def sets_of(recipe: Recipe, paths: Sequence[Path], tolerance: float | None) -> list[FileSet]:
    """Sort files of any origin into sets; `tolerance`, mm, takes the place of that of the recipe."""
    count, sets = recipe.cam.arrangement.discs, list[FileSet]()
    for place, path in enumerate(paths):
        kind, asked = kind_of(path), recipe.request_of(path.name)
        within = ((asked and asked.tolerance) or recipe.export.tolerance) if tolerance is None else tolerance
        held = Held(kind, asked, within)
        stem, disc = _disc_of(recipe, path, asked, count)
        if count == 1 or (disc is None and not FORMATS[kind].by_disc):
            sets.append(FileSet(held, stem, [(place, path, 0 if count == 1 else None)]))
            continue
        open_sets = [one for one in sets if one.held == held and None not in one.discs and len(one.files) < count]
        fitting = [one for one in open_sets if disc is None or disc not in one.discs]
        chosen = next((one for one in fitting if one.stem == stem), next(iter(fitting), None))
        if chosen is None:
            chosen = FileSet(held, stem)
            sets.append(chosen)
        rank = min(set(range(count)) - chosen.discs) if disc is None else disc
        chosen.files.append((place, path, rank))
    return sets


def _disc_of(recipe: Recipe, path: Path, request: FileRequest | None, count: int) -> tuple[str, int | None]:
    """The stem of a name without the end that tells the disc, and that disc; None where it tells none."""
    told = re.fullmatch(r"(.+)-([1-9])", path.stem)
    whole = request is not None and recipe.filenames(request) == (path.name,)
    if told is None or whole or int(told[2]) > count:
        return path.stem, None
    return told[1], int(told[2]) - 1
