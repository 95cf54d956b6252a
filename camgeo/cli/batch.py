"""The recipes of one call, one after another or several at once; of each its report, a message, an exit status."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

from camgeo.cli.exit_status import FAILED, OK, SURROUNDINGS, WRONG
from camgeo.cli.progress import Progress
from camgeo.common import workers
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from camgeo.api.report import Report
    from camgeo.recipe.recipe import Order
    from camgeo.schema.errors import RecipeError

PAYS = 4.0  # processor seconds of remaining work from which more processes pay that import all anew
FORKED = 1.0  # and those that are forked with all that is imported
IMPORTS = 1.0  # processor seconds of the first recipe that its imports may take


@dataclass(frozen=True)
class Task:
    """What is done with each recipe: files of the kinds `only`, or of all, into `out`; without `out` only checks."""

    out: Path | None
    only: tuple[str, ...] = ()


@dataclass(frozen=True)
class Result:
    """What became of one recipe: its report, None where it came to none; a message for standard error; the status.

    `errors` are the faults of the recipe, of which the message is made.
    """

    report: Report | None
    message: str
    status: int
    errors: tuple[RecipeError, ...] = ()


def results(recipes: Sequence[Order], task: Task, jobs: int | None) -> Iterator[Result]:
    """Give the result of each recipe in their order; it begins here.

    It goes on with `jobs` processes, or with one for each core, where what is left pays for starting them.
    """
    started = time.process_time()
    warm = 0.0  # processor time when the first recipe had imported what they need
    for done, recipe in enumerate(recipes):
        spent = time.process_time()
        each = (spent - warm) / (done - 1) if done > 1 else max(spent - started - IMPORTS, 0.0)
        left = recipes[done:]
        count = workers.needed(workers.available() if jobs is None else jobs, len(left))
        fork = workers.alone()
        if count > 1 and done and each * len(left) > (FORKED if fork else PAYS):
            yield from _at_once(left, task, count, fork=fork)
            return
        yield result(recipe, task, Progress(recipe.name))
        warm = warm if done else time.process_time()


def _at_once(recipes: Sequence[Order], task: Task, count: int, *, fork: bool) -> Iterator[Result]:
    """Give the result of each recipe in their order, `count` at once."""
    from concurrent.futures.process import BrokenProcessPool

    progress = Progress(f"{len(recipes)} recipes")
    with workers.pool(count, fork=fork) as pool:
        try:
            futures = [pool.submit(partial(result, task=task), recipe) for recipe in recipes]
            for number, future in enumerate(futures):
                progress(f"{number} of {len(futures)} done")
                try:
                    found = future.result()
                except BrokenProcessPool:
                    # one process was killed, and takes with it what the others had in hand
                    text = f"camgeo: {recipes[number].name}: {workers.KILLED.format('this recipe')}"
                    found = Result(None, text, SURROUNDINGS)
                progress.clear()
                yield found
        finally:
            progress.clear()


def result(recipe: Order, task: Task, progress: Progress | None = None) -> Result:
    """Run one recipe; a wrong recipe, the disk and a missing package are reported in the result, not raised."""
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
    return Result(report, left_out, FAILED if not report.ok else SURROUNDINGS if left_out else OK)
