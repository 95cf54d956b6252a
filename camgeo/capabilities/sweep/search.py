"""A whole sweep: every chunk, what they come to, the best polished and written out, the files in their place."""

from __future__ import annotations

import os
import time
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from camgeo.capabilities.sweep.certify import certified, slack
from camgeo.capabilities.sweep.engines import spread
from camgeo.capabilities.sweep.job import Job
from camgeo.capabilities.sweep.outputs import PICTURES, REPORT, TABLES, outputs
from camgeo.capabilities.sweep.recipes import Best, recipe_text
from camgeo.capabilities.sweep.refine import PolishError
from camgeo.capabilities.sweep.run import chunks_of, compute, gathered
from camgeo.common.errors import BusyError, SurroundingsError
from camgeo.output.output_folder import Family, RunFolder
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.ask import Ask
    from camgeo.capabilities.sweep.gather import Floats, Gathered
    from camgeo.capabilities.sweep.job import Compute
    from camgeo.capabilities.sweep.run import How, Listener, Work

FILES = Family(REPORT, ("sweep.", "sweep-", "best-"), "sweep-")
_WAIT = 30.0  # seconds for another run of the recipe to have put its files in place, which takes it milliseconds
_AGAIN = 0.05
_NEAR = 0.15  # of an axis's range in every value: polishing would lead designs nearer than that to one place
_APART = 0.05  # of an axis's range: designs nearer than that in every value, once polished, count as one


Values: TypeAlias = dict[str, float]
Polish: TypeAlias = "Callable[[Ask, Values], tuple[Values, Values]]"
"""Values and figures, mm and degrees, of a design as good or better that breaks no limit; raises PolishError."""
Measure: TypeAlias = "Callable[[Ask, Floats], Mapping[str, Floats]]"
"""All figures (m,) of designs with values (m, axes), in mm and degrees: also what the search went without."""


@dataclass(frozen=True)
class Means:
    """What computes the figures of designs, all those of a few, what polishes; the words for why one has none."""

    compute: Compute
    measure: Measure
    polish: Polish
    reasons: Sequence[str] = ()


@dataclass(frozen=True)
class Outcome:
    """What came of a sweep: its report, and the folder of its files, a rejected one where no design is kept."""

    report: dict[str, Any]
    folder: Path
    work: Work


def search(
    ask: Ask, out: Path, how: How, means: Means, *, fresh: bool = False, listener: Listener | None = None
) -> Outcome:
    """Run the sweep of a recipe.

    Raises RecipeErrors for a recipe whose sweep cannot be cut out; ModuleNotFoundError, EngineError, VersionsError and
    SurroundingsError for what is missing around the run; OSError for a disk that refuses.
    """
    started = time.perf_counter()
    demand_extras(ask, how)
    recipe_text(ask, Best(1, 0, False, _by_path(ask, ask.plan.values(0, 1)[0]), {}))  # told now if it cannot be written
    demand_room(ask, out)
    job = Job(ask.plan, ask.scene(ask.figures), means.compute)
    chunks = chunks_of(job, out / ask.recipe.name)
    work = compute(job, chunks, how, fresh=fresh, listener=listener)
    found = gathered(job, chunks, ask.ranking, slack if ask.screened else None)
    if ask.screened:
        found = _certified(ask, found, how, listener)
    best = best_of(ask, found, means, how, listener)
    run = {
        "engine": str(how),
        "key": job.key,
        "chunks": ask.plan.chunks,
        "designs_computed": work.computed,
        "designs_found": work.reused,
        "chunks_damaged": work.damaged,
        "computing_seconds": round(work.seconds, 3),
        "designs_per_second": round(work.computed / work.seconds, 1) if work.computed else None,
        "seconds": round(time.perf_counter() - started, 3),
    }
    files, report = outputs(ask, found, best, run, means.reasons)
    return Outcome(report, put(out, ask.recipe.name, files, accepted=bool(best)), work)


def demand_extras(ask: Ask, how: How) -> None:
    """Raise ModuleNotFoundError for a package without which the sweep would come to a halt halfway."""
    needed = []
    if ask.sweep.method == "sobol" or ask.sweep.refine:
        needed.append("scipy")
    if how.scheduler is not None:
        needed.append("distributed")
    for name in needed:
        if find_spec(name) is None:
            raise ModuleNotFoundError(name=name)


def demand_room(ask: Ask, out: Path) -> None:
    """Raise SurroundingsError for a file of the user's where one of the sweep would go: told now, not in the end."""
    folder = out / ask.recipe.name
    if not folder.exists():
        return
    try:
        with RunFolder(out, ask.recipe.name, FILES) as run:
            ours = {*run.kept(), REPORT}
    except BusyError:
        return  # a run that is putting its files in place; the end will tell
    best = (f"best-{place}.yaml" for place in range(1, min(ask.sweep.keep, ask.plan.count) + 1))
    for name in (*TABLES, *PICTURES, *best):
        if name not in ours and os.path.lexists(folder / name):
            raise SurroundingsError("is in the way, and no report lists it as replaceable", folder / name)


def best_of(ask: Ask, designs: Gathered, means: Means, how: How, listener: Listener | None = None) -> list[Best]:
    """The best designs with all their figures.

    If the sweep says so it is the best that lie apart, polished, of those that then lie near to each other the best.
    """
    rows = designs.rows if designs.certificate is None else designs.certificate.designs
    places = _apart(ask, designs, rows) if ask.sweep.refine else range(min(ask.sweep.keep, rows))
    plain = [
        Best(
            number,
            int(designs.index[place]),
            False,
            _by_path(ask, designs.values[place]),
            {name: float(values[place]) for name, values in designs.figures.items()},
        )
        for number, place in enumerate(places, 1)
    ]
    if not ask.sweep.refine:
        return _measured(ask, plain, means.measure)
    polished = _measured(ask, _polished(ask, plain, means.polish, how, listener), means.measure)
    polished.sort(key=lambda design: _order(ask, design))
    best: list[Best] = []
    for design in polished:
        if not any(_same(ask, design, other) for other in best):
            best.append(replace(design, place=len(best) + 1))
    return best


def _measured(ask: Ask, plain: list[Best], measure: Measure) -> list[Best]:
    """Designs with the figures that the search went without."""
    if all(set(ask.all_figures) <= set(design.figures) for design in plain):
        return plain
    found = measure(ask, np.array([list(design.values.values()) for design in plain]))
    return [
        replace(design, figures={**{name: float(found[name][i]) for name in found}, **design.figures})
        for i, design in enumerate(plain)
    ]


def _order(ask: Ask, design: Best) -> tuple[float, int]:
    figure = design.figures[ask.sweep.rank]
    return (-figure if ask.ranking.most else figure), design.place


def _apart(ask: Ask, designs: Gathered, rows: int) -> list[int]:
    """Places in the table of the best designs, of so many, from which polishing is likely to lead to different ones."""
    left = np.arange(rows)
    places: list[int] = []
    while len(left) and len(places) < ask.sweep.keep:
        places.append(int(left[0]))
        left = left[_far(ask, designs.values[left], designs.values[left[0]])]
    return places


def _far(ask: Ask, values: Floats, start: Floats) -> NDArray[np.bool_]:
    """Which designs (n, axes) polishing leads elsewhere than a start (axes,)."""
    ranges = np.array([axis.range or 1.0 for axis in ask.plan.axes])
    far: NDArray[np.bool_] = np.abs((values - start) / ranges).max(axis=1) > _NEAR
    return far


def _certified(ask: Ask, gathered: Gathered, how: How, listener: Listener | None) -> Gathered:
    """The table with the designs that hold exactly in front; starts of polishing lie apart."""
    started = time.perf_counter()

    def apart(values: Floats, design: Floats) -> NDArray[np.bool_]:
        return _far(ask, values, design) if ask.sweep.refine else np.ones(len(values), dtype=np.bool_)

    def tell(count: int) -> None:
        if listener is not None:
            listener("designs worked out", count, ask.sweep.keep, time.perf_counter() - started)

    return certified(ask, gathered, partial(spread, count=how.processes), apart, tell)


def _polished(ask: Ask, plain: list[Best], polish: Polish, how: How, listener: Listener | None) -> list[Best]:
    """Each design polished, several at once where there are processes for it; in the same order."""
    started = time.perf_counter()
    if listener is not None:
        listener("polished", 0, len(plain), 0.0)
    done: dict[int, Best] = {}
    for design, result in spread(partial(_polish, polish, ask), plain, min(how.processes, len(plain))):
        done[design.place] = result
        if listener is not None:
            listener("polished", len(done), len(plain), time.perf_counter() - started)
    return [done[design.place] for design in plain]


def _polish(polish: Polish, ask: Ask, design: Best) -> Best:
    try:
        values, figures = polish(ask, design.values)
    except PolishError as error:
        return replace(design, why=str(error))
    return replace(design, polished=values != design.values, values=values, figures=figures)


def _by_path(ask: Ask, row: Any) -> dict[str, float]:  # noqa: ANN401 - a row of an array
    return {axis.path: float(value) for axis, value in zip(ask.plan.axes, row, strict=True)}


def _same(ask: Ask, design: Best, other: Best) -> bool:
    """Whether two designs lie so near to each other that they count as one."""
    return all(abs(design.values[axis.path] - other.values[axis.path]) <= _APART * axis.range for axis in ask.plan.axes)


def put(out: Path, name: str, files: dict[str, bytes], *, accepted: bool) -> Path:
    """Put all files in their place at once, or, where no design was kept, beside it as rejected."""
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
            time.sleep(_AGAIN)
