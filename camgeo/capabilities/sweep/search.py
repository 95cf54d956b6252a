"""A whole sweep: chunks computed and gathered, the best designs certified and polished, the files put in place."""

from __future__ import annotations

import os
import time
from collections import Counter
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from camgeo.capabilities.sweep.cams import REASONS
from camgeo.capabilities.sweep.chunks import SweepJob, chunks_of, compute, gather_chunks
from camgeo.capabilities.sweep.earlier import decisive, earlier, remember
from camgeo.capabilities.sweep.engines import spread
from camgeo.capabilities.sweep.figures import compute_figures
from camgeo.capabilities.sweep.gather import Certificate, Nearest
from camgeo.capabilities.sweep.outputs import PICTURES, REPORT, TABLES, Best, outputs, recipe_text
from camgeo.capabilities.sweep.refine import PolishError, polish
from camgeo.capabilities.sweep.screen import allowance, error_of, slack
from camgeo.capabilities.sweep.task import SweepTask
from camgeo.common.errors import BusyError, SurroundingsError
from camgeo.output.output_folder import Family, RunFolder
from camgeo.report.document import as_json
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from camgeo.capabilities.sweep.chunks import Compute, Listener, Work
    from camgeo.capabilities.sweep.engines import Workers
    from camgeo.capabilities.sweep.gather import Selection
    from kin.numeric.arrays import Array, Indices

FILES = Family(REPORT, ("sweep.", "sweep-", "best-"), "sweep-")
_WAIT = 30.0  # seconds for another run of the recipe to have put its files in place, which takes it milliseconds
_PAUSE = 0.05  # seconds until the next attempt
_SAME_DISTANCE = 0.05  # of an axis's range: designs nearer than that in every value, once polished, count as one


Values: TypeAlias = dict[str, float]
Polish: TypeAlias = "Callable[[SweepTask, Values], tuple[Values, Values]]"
"""Values and figures, mm and degrees, of a design as good or better that breaks no limit.

Raises PolishError for a design that cannot be polished.
"""
Measure: TypeAlias = "Callable[[SweepTask, Array], Mapping[str, Array]]"
"""All figures (m,) of designs with values (m, axes), in mm and degrees: also what the search went without."""


@dataclass(frozen=True)
class Procedures:
    """Functions of a search: `compute` of a chunk's figures, `measure` of all figures of some designs, `polish` of one.

    `reasons` are words for the codes of why a design has no figures.
    """

    compute: Compute
    measure: Measure
    polish: Polish
    reasons: Sequence[str]


COMPUTING = Procedures(compute_figures, SweepTask.measure, polish, REASONS)


@dataclass(frozen=True)
class SweepOutcome:
    """Report of a sweep, the folder of its files, `<name>.rejected` where no design is kept, and what the run did."""

    report: dict[str, Any]
    folder: Path
    work: Work


def search(
    task: SweepTask,
    out: Path,
    engine: Workers,
    procedures: Procedures | None = None,
    *,
    fresh: bool = False,
    listener: Listener | None = None,
) -> SweepOutcome:
    """Run the sweep of a recipe, by COMPUTING or other procedures, and write its files below `out`.

    With `fresh`, chunks of earlier runs are computed again. `listener` is called with the progress. Raises RecipeErrors
    for a recipe whose sweep cannot be cut out, ModuleNotFoundError for a missing package, EngineError for workers or a
    scheduler that are missing or lost, VersionsError for workers of other versions, SurroundingsError for a file in the
    way, or where another run of the recipe holds its folder for over 30 s, OSError where the disk refuses.
    """
    started = time.perf_counter()
    procedures = procedures or COMPUTING
    require_packages(task, engine)
    first = Best(1, 0, False, _by_path(task, task.plan.values(0, 1)[0]), {})
    recipe_text(task, first)  # at once rather than in the end, if it cannot be written
    require_free_names(task, out)
    job = SweepJob(task.plan, task.scene(task.figures), procedures.compute)
    chunks = chunks_of(job, out / task.recipe.name)
    work = compute(job, chunks, engine, fresh=fresh, listener=listener)
    decided = decisive(task, job.key) if procedures is COMPUTING else ""
    found = earlier(chunks.folder, out / task.recipe.name, REPORT, decided) if not work.computed else None
    if found is None:
        selection = gather_chunks(job, chunks, task.ranking, slack if task.screened else None)
        if task.screened:
            selection = certify(task, selection, engine, listener)
        best = best_designs(task, selection, procedures, engine, listener)
        found = outputs(task, selection, best, procedures.reasons)
        if best and decided:
            remember(chunks.folder, decided, found[1])
    files, report = found
    report["run"] = {
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
    files[REPORT] = as_json(report).encode()
    return SweepOutcome(report, place_files(out, task.recipe.name, files, accepted=bool(report["best"])), work)


def require_packages(task: SweepTask, engine: Workers) -> None:
    """Raise ModuleNotFoundError for a package without which the sweep would stop halfway."""
    for name, needed in (
        ("scipy", task.sweep.method == "sobol" or task.sweep.refine),
        ("distributed", engine.scheduler is not None),
    ):
        if needed and find_spec(name) is None:
            raise ModuleNotFoundError(name=name)


def require_free_names(task: SweepTask, out: Path) -> None:
    """Raise SurroundingsError where a file of the user bears a name that the sweep will write.

    So the sweep stops at once, not in the end.
    """
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
    task: SweepTask, selection: Selection, procedures: Procedures, engine: Workers, listener: Listener | None = None
) -> list[Best]:
    """The best designs with all their figures, best first, at most as many as the sweep keeps.

    If the sweep refines, designs that lie apart are polished; of polished ones that lie near to each other the best is
    kept. Raises EngineError where a process is killed.
    """
    # rows with exact figures; polishing starts from rows that lie apart, as near ones lead to one place
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


def _with_all_figures(task: SweepTask, designs: list[Best], measure: Measure) -> list[Best]:
    """The designs, with the figures added that the search did not compute."""
    if all(set(task.all_figures) <= set(design.figures) for design in designs):
        return designs
    columns = measure(task, np.array([list(design.values.values()) for design in designs]))
    return [
        replace(design, figures={**{name: float(columns[name][i]) for name in columns}, **design.figures})
        for i, design in enumerate(designs)
    ]


def _polish_all(
    task: SweepTask, designs: list[Best], polish: Polish, engine: Workers, listener: Listener | None
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


def _polish(polish: Polish, task: SweepTask, design: Best) -> Best:
    """The design polished, or as it was, with the reason why it cannot be."""
    try:
        values, figures = polish(task, design.values)
    except PolishError as error:
        return replace(design, why=str(error))
    return replace(design, polished=values != design.values, values=values, figures=figures)


def _by_path(task: SweepTask, row: Any) -> dict[str, float]:  # noqa: ANN401 - a row of an array
    """Values of a design by the paths of their fields."""
    return {axis.path: float(value) for axis, value in zip(task.plan.axes, row, strict=True)}


def _are_same(task: SweepTask, design: Best, other: Best) -> bool:
    """Whether two designs lie so near to each other in every value that they count as one."""
    return all(
        abs(design.values[axis.path] - other.values[axis.path]) <= _SAME_DISTANCE * axis.range
        for axis in task.plan.axes
    )


class ExactDesign(NamedTuple):
    """Exact figures of a design, mm and degrees, and why it is rejected.

    `fault` is a word of REASONS, without figures, or the figure of a limit that the design breaks; empty for none.
    """

    figures: dict[str, float]
    fault: str


def certify(task: SweepTask, selection: Selection, engine: Workers, listener: Listener | None) -> Selection:
    """The selection with certified designs in front: their exact figures keep the limits.

    Designs are computed exactly in the order of their estimates, until as many are certified as the sweep keeps. Then
    at most as many more are computed: those whose estimate, but for its possible error, is as good as the worst
    certified one. Where the sweep refines, only designs that lie apart are certified. Where no design is within the
    limits the nearest one is computed. `listener` is called with the number certified. Raises EngineError where a
    process is killed.
    """
    started = time.perf_counter()
    if not selection.rows and (near := selection.nearest) is not None:
        unknown = {name: np.full(1, np.nan) for name in selection.figures}
        selection = replace(selection, index=np.array([near.index]), values=near.values[None], figures=unknown)
    left: Indices = np.arange(selection.rows)
    spare, exact_designs = task.sweep.keep, dict[int, ExactDesign]()
    places: list[int] = []  # in the table, of the certified designs
    while len(left):
        batch = left[: task.sweep.keep - len(places)]
        if not len(batch) and spare:
            kept = [exact_designs[place].figures for place in places]
            batch, spare = _next_candidate(task, selection, left, kept), spare - 1
        if not len(batch):
            break
        left = np.setdiff1d(left, batch)
        compute_exactly = partial(_compute_exactly, task, selection)
        for place, design in sorted(spread(compute_exactly, batch.tolist(), engine.processes)):
            exact_designs[place] = design
            if not design.fault and task.are_apart(selection.values[places], selection.values[place]).all():
                places.append(place)
                left = left[task.are_apart(selection.values[left], selection.values[place])]
                if listener is not None:
                    count = min(len(places), task.sweep.keep)
                    listener("designs worked out", count, task.sweep.keep, time.perf_counter() - started)
    rejected = Counter(design.fault for design in exact_designs.values() if design.fault)
    errors = {
        name: max(
            (
                error_of(name, float(estimate[place]), design.figures[name])
                for place, design in exact_designs.items()
                if design.figures
            ),
            default=0.0,
        )
        for name, estimate in selection.figures.items()
    }
    certificate = Certificate(len(places), dict(sorted(rejected.items())), errors)
    nearest = None if places else _nearest(task, selection, exact_designs)
    return replace(_reorder(task, selection, exact_designs, places), nearest=nearest, certificate=certificate)


def _next_candidate(
    task: SweepTask, selection: Selection, left: Indices, kept: Sequence[Mapping[str, float]]
) -> Indices:
    """First of the places left whose estimate may beat the last design that the sweep keeps; empty without one."""
    rank, sign = task.ranking.rank, 1.0 if task.ranking.most else -1.0
    worst = sorted(sign * figures[rank] for figures in kept)[-task.sweep.keep]
    better = task.ranking.score(selection.figures)[left] >= worst - allowance(rank, worst)
    first: Indices = left[better][:1]
    return first


def _compute_exactly(task: SweepTask, selection: Selection, place: int) -> ExactDesign:
    """Exact design at a place of the selection."""
    computed = task.exact_figures(selection.values[[place]])
    if computed.reason[0]:
        return ExactDesign({}, REASONS[computed.reason[0]])
    figures = {name: computed.figures[name] for name in selection.figures}
    broken = [limit.figure for limit in task.ranking.limits if not task.ranking.held(limit, figures)[0]]
    return ExactDesign({name: float(column[0]) for name, column in figures.items()}, broken[0] if broken else "")


def _nearest(task: SweepTask, selection: Selection, exact_designs: Mapping[int, ExactDesign]) -> Nearest | None:
    """The exact design that misses the limits by least, where all were rejected.

    Where no exact design has figures it is the nearest by estimates, None without one.
    """
    places = [place for place, design in exact_designs.items() if design.figures]
    if not places or not task.ranking.limits:
        return selection.nearest
    figures = {name: np.array([exact_designs[place].figures[name] for place in places]) for name in selection.figures}
    row, worst, _ = task.ranking.nearest(figures, np.ones(len(places), dtype=np.bool_))
    place = places[row]
    return Nearest(int(selection.index[place]), selection.values[place], worst, float(figures[worst.figure][row]))


def _reorder(
    task: SweepTask, selection: Selection, exact_designs: Mapping[int, ExactDesign], places: Sequence[int]
) -> Selection:
    """The selection with certified designs first, best first, then others whose estimates keep the limits."""
    figures = {name: column.copy() for name, column in selection.figures.items()}
    inside = np.ones(selection.rows, dtype=np.bool_)
    for limit in task.ranking.limits:
        inside &= task.ranking.held(limit, selection.figures)
    for place in places:
        for name, value in exact_designs[place].figures.items():
            figures[name][place] = value
    score = task.ranking.score(figures)
    first = sorted(places, key=lambda place: (-score[place], selection.index[place]))
    faults = {place: design.fault for place, design in exact_designs.items()}
    others = [place for place in range(selection.rows) if (not faults[place] if place in faults else inside[place])]
    order = np.array([*first, *(place for place in others if place not in places)], dtype=np.int64)
    lost = sum(bool(inside[place]) for place, fault in faults.items() if fault)
    gained = sum(not inside[place] for place in places)
    return replace(
        selection,
        counts=replace(selection.counts, kept=selection.counts.kept - lost + gained),
        index=selection.index[order],
        values=selection.values[order],
        figures={name: column[order] for name, column in figures.items()},
    )


def place_files(out: Path, name: str, files: dict[str, bytes], *, accepted: bool) -> Path:
    """Write all files at once to the folder `name` below `out`, if not accepted to `name`.rejected; return the folder.

    `files` are contents by name. Raises BusyError where another run of the recipe holds the folder for over 30 s,
    SurroundingsError for a file in the way or a disk that refuses.
    """
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
