"""A whole sweep: chunks computed and gathered, the best designs certified and polished, the files put in place."""

from __future__ import annotations

import os
import time
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from camgeo.capabilities.sweep.cams import REASONS
from camgeo.capabilities.sweep.certify import certify, slack
from camgeo.capabilities.sweep.chunks import Job, chunks_of, compute, gather_chunks
from camgeo.capabilities.sweep.engines import spread
from camgeo.capabilities.sweep.figures import compute_figures
from camgeo.capabilities.sweep.outputs import PICTURES, REPORT, TABLES, Best, outputs, recipe_text
from camgeo.capabilities.sweep.refine import PolishError, polish
from camgeo.capabilities.sweep.task import Task
from camgeo.common.errors import BusyError, SurroundingsError
from camgeo.output.output_folder import Family, RunFolder
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from camgeo.capabilities.sweep.chunks import Compute, Listener, Work
    from camgeo.capabilities.sweep.engines import Engine
    from camgeo.capabilities.sweep.gather import Selection
    from kin.numeric.arrays import Array

FILES = Family(REPORT, ("sweep.", "sweep-", "best-"), "sweep-")
_WAIT = 30.0  # seconds for another run of the recipe to have put its files in place, which takes it milliseconds
_PAUSE = 0.05  # seconds until the next attempt
_SAME_DISTANCE = 0.05  # of an axis's range: designs nearer than that in every value, once polished, count as one


Values: TypeAlias = dict[str, float]
Polish: TypeAlias = "Callable[[Task, Values], tuple[Values, Values]]"
"""Values and figures, mm and degrees, of a design as good or better that breaks no limit; raises PolishError."""
Measure: TypeAlias = "Callable[[Task, Array], Mapping[str, Array]]"
"""All figures (m,) of designs with values (m, axes), in mm and degrees: also what the search went without."""


@dataclass(frozen=True)
class Procedures:
    """Functions that compute the figures of designs, all those of a few, and polish one; words for the reason codes."""

    compute: Compute
    measure: Measure
    polish: Polish
    reasons: Sequence[str]


COMPUTING = Procedures(compute_figures, Task.measure, polish, REASONS)


@dataclass(frozen=True)
class Outcome:
    """Report of a sweep, the folder of its files, `<name>.rejected` where no design is kept, and what the run did."""

    report: dict[str, Any]
    folder: Path
    work: Work


def search(
    task: Task,
    out: Path,
    engine: Engine,
    procedures: Procedures | None = None,
    *,
    fresh: bool = False,
    listener: Listener | None = None,
) -> Outcome:
    """Run the sweep of a recipe, by COMPUTING or other procedures, and write its files below `out`.

    Raises RecipeErrors for a recipe whose sweep cannot be cut out; ModuleNotFoundError, EngineError, VersionsError and
    SurroundingsError for what is missing around the run; OSError for a disk that refuses.
    """
    started = time.perf_counter()
    procedures = procedures or COMPUTING
    require_packages(task, engine)
    first = Best(1, 0, False, _by_path(task, task.plan.values(0, 1)[0]), {})
    recipe_text(task, first)  # at once rather than in the end, if it cannot be written
    require_free_names(task, out)
    job = Job(task.plan, task.scene(task.figures), procedures.compute)
    chunks = chunks_of(job, out / task.recipe.name)
    work = compute(job, chunks, engine, fresh=fresh, listener=listener)
    selection = gather_chunks(job, chunks, task.ranking, slack if task.screened else None)
    if task.screened:
        selection = _certify(task, selection, engine, listener)
    best = best_designs(task, selection, procedures, engine, listener)
    run = {
        "engine": str(engine),
        "key": job.key,
        "chunks": task.plan.chunks,
        "designs_computed": work.computed,
        "designs_found": work.reused,
        "chunks_damaged": work.damaged,
        "computing_seconds": round(work.seconds, 3),
        "designs_per_second": round(work.computed / work.seconds, 1) if work.computed else None,
        "seconds": round(time.perf_counter() - started, 3),
    }
    files, report = outputs(task, selection, best, run, procedures.reasons)
    return Outcome(report, place_files(out, task.recipe.name, files, accepted=bool(best)), work)


def require_packages(task: Task, engine: Engine) -> None:
    """Raise ModuleNotFoundError for a package without which the sweep would stop halfway."""
    for name, needed in (
        ("scipy", task.sweep.method == "sobol" or task.sweep.refine),
        ("distributed", engine.scheduler is not None),
    ):
        if needed and find_spec(name) is None:
            raise ModuleNotFoundError(name=name)


def require_free_names(task: Task, out: Path) -> None:
    """Raise SurroundingsError for a user's file in the place of one of the sweep: at once, not in the end."""
    folder = out / task.recipe.name
    if not folder.exists():
        return
    try:
        with RunFolder(out, task.recipe.name, FILES) as run:
            ours = {*run.kept_names(), REPORT}
    except BusyError:
        return  # another run puts its files in place; the end will show
    best = (f"best-{place}.yaml" for place in range(1, min(task.sweep.keep, task.plan.count) + 1))
    for name in (*TABLES, *PICTURES, *best):
        if name not in ours and os.path.lexists(folder / name):
            raise SurroundingsError("is in the way, and no report lists it as replaceable", folder / name)


def best_designs(
    task: Task, selection: Selection, procedures: Procedures, engine: Engine, listener: Listener | None = None
) -> list[Best]:
    """The best designs with all their figures, best first.

    If the sweep refines, those that lie apart are polished; of polished ones that lie near to each other the best is
    kept.
    """
    rows = selection.rows if selection.certificate is None else selection.certificate.designs
    places = list(range(rows))
    if task.sweep.refine:
        left, places = np.arange(rows), []
        while len(left) and len(places) < task.sweep.keep:
            places.append(int(left[0]))
            left = left[task.are_apart(selection.values[left], selection.values[left[0]])]
    designs = [
        Best(
            number,
            int(selection.index[place]),
            False,
            _by_path(task, selection.values[place]),
            {name: float(values[place]) for name, values in selection.figures.items()},
        )
        for number, place in enumerate(places[: task.sweep.keep], 1)
    ]
    if not task.sweep.refine:
        return _with_all_figures(task, designs, procedures.measure)
    polished = _polish_all(task, designs, procedures.polish, engine, listener)
    polished = _with_all_figures(task, polished, procedures.measure)
    sign = -1.0 if task.ranking.most else 1.0
    polished.sort(key=lambda design: (sign * design.figures[task.sweep.rank], design.place))
    best: list[Best] = []
    for design in polished:
        if not any(_are_same(task, design, better) for better in best):
            best.append(replace(design, place=len(best) + 1))
    return best


def _with_all_figures(task: Task, designs: list[Best], measure: Measure) -> list[Best]:
    """The designs, with the figures that the search did not compute."""
    if all(set(task.all_figures) <= set(design.figures) for design in designs):
        return designs
    columns = measure(task, np.array([list(design.values.values()) for design in designs]))
    return [
        replace(design, figures={**{name: float(columns[name][i]) for name in columns}, **design.figures})
        for i, design in enumerate(designs)
    ]


def _certify(task: Task, selection: Selection, engine: Engine, listener: Listener | None) -> Selection:
    """The selection with certified designs in front, which lie apart where they are to be polished."""
    started = time.perf_counter()

    def progress(count: int) -> None:
        if listener is not None:
            listener("designs worked out", count, task.sweep.keep, time.perf_counter() - started)

    return certify(task, selection, partial(spread, count=engine.processes), progress)


def _polish_all(
    task: Task, designs: list[Best], polish: Polish, engine: Engine, listener: Listener | None
) -> list[Best]:
    """Each design polished, in the same order; several at once where that saves time."""
    started = time.perf_counter()
    if listener is not None:
        listener("polished", 0, len(designs), 0.0)
    polished: dict[int, Best] = {}
    for design, result in spread(partial(_polish, polish, task), designs, min(engine.processes, len(designs))):
        polished[design.place] = result
        if listener is not None:
            listener("polished", len(polished), len(designs), time.perf_counter() - started)
    return [polished[design.place] for design in designs]


def _polish(polish: Polish, task: Task, design: Best) -> Best:
    """The design polished, or as it was, with the reason why it cannot be."""
    try:
        values, figures = polish(task, design.values)
    except PolishError as error:
        return replace(design, why=str(error))
    return replace(design, polished=values != design.values, values=values, figures=figures)


def _by_path(task: Task, row: Any) -> dict[str, float]:  # noqa: ANN401 - a row of an array
    """Values of a design by the paths of their fields."""
    return {axis.path: float(value) for axis, value in zip(task.plan.axes, row, strict=True)}


def _are_same(task: Task, design: Best, other: Best) -> bool:
    """Whether two designs lie so near to each other that they count as one."""
    return all(
        abs(design.values[axis.path] - other.values[axis.path]) <= _SAME_DISTANCE * axis.range
        for axis in task.plan.axes
    )


def place_files(out: Path, name: str, files: dict[str, bytes], *, accepted: bool) -> Path:
    """Write all files at once, in the folder of the recipe if accepted, else in that of rejected ones; return it."""
    give_up = time.monotonic() + _WAIT
    while True:
        try:
            with RunFolder(out, name, FILES) as run:
                for file, data in files.items():
                    (run.folder / file).write_bytes(data)
                names = [file for file in files if file != REPORT]
                return run.commit(names) if accepted else run.reject(names)
        except BusyError:
            if time.monotonic() > give_up:
                raise
            time.sleep(_PAUSE)
