"""A search among designs from a program, as `camgeo sweep` runs it from a terminal."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from camgeo.api.check import Figure, Figures
from camgeo.api.loading import recipe_of
from camgeo.api.log import library_log
from camgeo.common.arguments import demand_callable, demand_type, path_of, short_repr, whole_of
from camgeo.common.errors import CallError, SurroundingsError
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from os import PathLike
    from pathlib import Path

    from camgeo.api.json_value import JSON
    from camgeo.api.loading import RecipeSource
    from camgeo.recipe.recipe import Recipe


@dataclass(frozen=True)
class Candidate:
    """One of the best designs of a search: its recipe, the values that the search varied, and its figures.

    `values` are by the paths of the recipe's fields and in its units, `figures` by name. `polished` says whether the
    values were improved beyond the designs of the search. `path` is the file of the recipe.
    """

    recipe: Recipe
    values: Mapping[str, float | str]
    figures: Figures
    polished: bool
    path: Path


@dataclass(frozen=True, eq=False)
class Search(Mapping[str, "JSON"]):
    """Outcome of a search; as a mapping the content of sweep.json: `dict(search)`, `search["counts"]`.

    `path` is the folder of its files, `<name>.rejected` where no design keeps the limits.
    """

    recipe: Recipe
    path: Path
    _document: dict[str, Any] = field(repr=False)

    @property
    def ok(self) -> bool:
        """Whether a design keeps all limits."""
        return bool(self._document["ok"])

    @cached_property
    def best(self) -> tuple[Candidate, ...]:
        """The best designs, best first; empty where no design keeps the limits.

        Their recipes are read when this is first used; raises RecipeErrors where a file is gone or has faults.
        """
        from camgeo.recipe.loading import load

        units = {name: figure["unit"] for name, figure in self._document["figures"].items()}
        return tuple(
            Candidate(
                load(self.path / entry["file"]),
                dict(entry["values"]),
                Figures({name: Figure(value, units[name]) for name, value in entry["figures"].items()}),
                entry["polished"],
                self.path / entry["file"],
            )
            for entry in self._document["best"]
        )

    def __getitem__(self, key: str) -> JSON:
        value: JSON = copy.deepcopy(self._document[key])
        return value

    def __iter__(self) -> Iterator[str]:
        return iter(self._document)

    def __len__(self) -> int:
        return len(self._document)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.recipe.name!r}, {'ok' if self.ok else 'FAILED'}, {str(self.path)!r})"

    def __str__(self) -> str:
        """The best design, or why there is none, in one line."""
        from camgeo.capabilities.sweep.command import summary

        return summary(self._document, self.path)


def search(
    recipe: RecipeSource,
    out: str | PathLike[str],
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    fresh: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Search:
    """Search the designs that a recipe's `sweep` spans; the best become recipes in the folder `out`/<name>.

    `jobs` is the greatest number of processes at once, by default one for each core; `scheduler` the address of a Dask
    scheduler in their place. What earlier runs computed is used again unless `fresh` is true. `progress` is called with
    lines such as "64 of 825 designs" and "the scheduler at tcp://host:8786 has no workers yet". Where no design keeps
    the limits, `ok` of the result is False and the files are in `out`/<name>.rejected. Raises RecipeErrors where the
    recipe has faults, no sweep or one that cannot be run, SurroundingsError where the disk refuses, a package is
    missing or a scheduler fails, CallError for a number of processes below 1 or a path that no file can have, TypeError
    for arguments of other types.
    """
    from camgeo.capabilities.sweep.chunks import EngineError
    from camgeo.capabilities.sweep.command import missing_package
    from camgeo.capabilities.sweep.engines import Workers
    from camgeo.capabilities.sweep.search import search as run_search
    from camgeo.capabilities.sweep.task import SweepTask

    recipe, folder = recipe_of(recipe), path_of("out", out)
    demand_callable("progress", progress)
    demand_type("fresh", fresh, bool, "a bool")
    if scheduler is not None:
        demand_type("scheduler", scheduler, str, "a str")
    if jobs is not None and (jobs := whole_of("jobs", jobs)) < 1:
        raise CallError(f"jobs is a number of processes from 1, not {short_repr(jobs)}")

    def listener(what: str, count: int, total: int, _seconds: float) -> None:
        if progress is not None:
            progress(f"{count:,} of {total:,} {what}")

    try:
        task = SweepTask.from_recipe(recipe)
        outcome = run_search(task, folder, Workers(jobs, scheduler, progress), fresh=fresh, listener=listener)
    except ModuleNotFoundError as error:
        raise SurroundingsError(missing_package(error), folder) from error
    except EngineError as error:
        raise SurroundingsError(str(error), folder) from error
    except OSError as error:
        raise SurroundingsError(f"cannot be written: {error.strerror or error}", folder) from error
    result = Search(recipe, outcome.folder, outcome.report)
    if log := library_log():
        log.info("%s", result)
    return result
