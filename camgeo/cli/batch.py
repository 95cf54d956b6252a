"""Runs of the recipes of one call, one after another or several at once: reports, messages, exit statuses."""

from __future__ import annotations

import time
from collections import Counter
from contextlib import closing, suppress
from dataclasses import asdict
from functools import partial
from os.path import realpath
from typing import TYPE_CHECKING

from camgeo.cli.exit_status import SURROUNDINGS, WRONG, of_run
from camgeo.cli.progress import Progress
from camgeo.common import workers
from camgeo.common.terminal import escaped
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from camgeo.api.report import Report
    from camgeo.recipe.recipe import Order
    from camgeo.schema.errors import RecipeError

PAYS = 4.0  # processor seconds of remaining work from which processes pay that have to import everything
FORKED = 1.0  # processor seconds of remaining work from which forked processes pay, which have the imports already
IMPORTS = 1.0  # processor seconds that are subtracted from the first recipe for its imports


@dataclass(frozen=True)
class BatchTask:
    """Work on each recipe: files of the kinds `only`, empty for all, are written into the folder `out`.

    With `out` None the recipe is only checked.
    """

    out: Path | None
    only: tuple[str, ...] = ()


@dataclass(frozen=True)
class Result:
    """Outcome of one recipe: its report, None where a fault prevented it; a message for standard error; exit status.

    The message is empty without a fault and without a file left out. `errors` are the faults of the recipe in it.
    """

    report: Report | None
    message: str
    status: int
    errors: tuple[RecipeError, ...] = ()


def results(recipes: Sequence[Order], task: BatchTask, jobs: int | None) -> Iterator[Result]:
    """Result of each recipe, in order; the first recipe is run in this process.

    The others are run in `jobs` processes, by default one for each core, as soon as the remaining work is worth them.
    """
    started = time.process_time()
    warm = 0.0  # processor time when the first recipe had imported what they need
    for number, recipe in enumerate(recipes):
        spent = time.process_time()
        seconds_each = (spent - warm) / (number - 1) if number > 1 else max(spent - started - IMPORTS, 0.0)
        remaining = recipes[number:]
        count = workers.needed(workers.available() if jobs is None else jobs, len(remaining))
        fork = workers.may_fork()
        if count > 1 and number and seconds_each * len(remaining) > (FORKED if fork else PAYS):
            yield from _in_parallel(remaining, task, count, fork=fork)
            return
        yield result(recipe, task, Progress(recipe.name))
        warm = warm if number else time.process_time()


def _in_parallel(recipes: Sequence[Order], task: BatchTask, count: int, *, fork: bool) -> Iterator[Result]:
    """Result of each recipe, in order, from `count` processes."""
    progress = Progress(f"{len(recipes)} recipes")

    def waiting(number: int) -> None:
        progress(f"{number} of {len(recipes)} done")

    made: dict[int, Result] = {}
    due = 0
    with closing(
        workers.at_once(partial(_numbered, task), enumerate(recipes), count, fork=fork, waiting=waiting)
    ) as ends:
        try:
            for (number, recipe), outcome in ends:
                made[number] = _killed(recipe, task) if isinstance(outcome, workers.Killed) else outcome
                progress.clear()
                while due in made:
                    yield made.pop(due)
                    due += 1
        finally:
            progress.clear()


def _numbered(task: BatchTask, numbered: tuple[int, Order]) -> Result:
    """Result of one recipe, which comes with its number."""
    return result(numbered[1], task)


def _killed(recipe: Order, task: BatchTask) -> Result:
    """Result of a recipe whose process was killed; what the process left in the output folder is cleared away."""
    from camgeo.common.errors import SurroundingsError
    from camgeo.output.output_folder import RunFolder

    if task.out is not None:
        with suppress(SurroundingsError), RunFolder(task.out, recipe.name):
            pass
    return Result(None, f"camgeo: {recipe.name}: {workers.KILLED.format('this recipe')}", SURROUNDINGS)


def result(recipe: Order, task: BatchTask, progress: Progress | None = None) -> Result:
    """Result of one recipe.

    A faulty recipe, a disk that refuses and a missing package become its message and status, and raise nothing.
    """
    from camgeo.api import run
    from camgeo.common.errors import SurroundingsError
    from camgeo.schema.errors import RecipeErrors

    try:
        if task.out is None:
            report = run.check(recipe, progress=progress)
        else:
            report = run.export(recipe, task.out, only=task.only, progress=progress)
    except RecipeErrors as errors:
        return Result(None, str(errors), WRONG, errors.errors)
    except (SurroundingsError, OSError) as error:
        return Result(None, f"camgeo: {recipe.name}: {error}", SURROUNDINGS)
    finally:
        if progress is not None:
            progress.clear()
    left_out = "\n".join(f"camgeo: {recipe.name}: {name} is left out: {why}" for name, why in report.missing.items())
    return Result(report, left_out, of_run(ok=report.ok, left_out=bool(left_out)))


def folder_conflicts(recipes: Sequence[Order]) -> list[str]:
    """Messages on recipes that would write into the same folder: a file named twice, or else a name used twice.

    Empty without such recipes.
    """
    paths = [realpath(recipe.path) for recipe in recipes]
    first = {path: i for i, path in reversed(list(enumerate(paths)))}
    repeated = [recipe for i, recipe in enumerate(recipes) if first[paths[i]] != i]
    if repeated:
        text = "the same recipe is named twice in this call; name it once"
        return [f"{escaped(str(recipe.path))}: {text}" for recipe in repeated]
    uses = Counter(recipe.name.casefold() for recipe in recipes)
    twice = [recipe for recipe in recipes if uses[recipe.name.casefold()] > 1]
    text = "the name {} is used by several recipes of this call; give each its own `name:`"
    return [f"{escaped(str(recipe.path))}: {text.format(recipe.name)}" for recipe in twice]


def failed_entry(recipe: str, message: str, errors: Sequence[RecipeError]) -> dict[str, object]:
    """Entry in place of a report for a recipe that has none, with its errors, else the message as the only one.

    `recipe` is its name or its path.
    """
    return {"recipe": recipe, "ok": False, "errors": [asdict(error) for error in errors] or [{"problem": message}]}
