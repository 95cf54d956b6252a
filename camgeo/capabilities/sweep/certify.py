"""Certifying designs selected by estimates: each is computed exactly, and the next one where it fails."""

from __future__ import annotations

from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.sweep.cams import REASONS
from camgeo.capabilities.sweep.gather import Certificate, Nearest
from camgeo.capabilities.sweep.screen import estimates
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from camgeo.capabilities.sweep.gather import Selection
    from camgeo.capabilities.sweep.task import Task
    from camgeo.recipe.limits import Limit
    from kin.numeric.arrays import Indices

    Spread = Callable[[Callable[[int], "ExactDesign"], Sequence[int]], Iterable[tuple[int, "ExactDesign"]]]

_SAFETY = 2.0  # times the greatest error measured: estimates that miss a bound by less are computed exactly too


class ExactDesign(NamedTuple):
    """Exact figures of a design, mm and degrees; why it is rejected: of REASONS, or the figure of a limit."""

    figures: dict[str, float]
    fault: str


def _allowance(name: str, value: float) -> float:
    """Greatest error, in the figure's unit, to be expected of an estimate near a value."""
    estimate = estimates().get(name)
    if estimate is None or estimate.error is None:
        return 0.0
    return _SAFETY * estimate.error * (1.0 if estimate.in_degrees else abs(value))


def slack(limit: Limit) -> float:
    """Amount, in the figure's unit, by which estimates may miss a limit while the exact figure may keep it."""
    return max(_allowance(limit.figure, bound) for bound in (limit.at_least, limit.at_most) if bound is not None)


def error_of(name: str, estimate: float, exact: float) -> float:
    """Error of an estimate, at least 0: in degrees of an angle, else as a share of the exact value."""
    if estimate == exact or np.isnan(estimate):
        return 0.0
    return abs(estimate - exact) / (1.0 if estimates()[name].in_degrees else max(abs(exact), 1e-300))


def certify(
    task: Task,
    selection: Selection,
    spread: Spread,
    progress: Callable[[int], None],
) -> Selection:
    """The selection with certified designs in front: their exact figures keep the limits.

    Designs are computed exactly in the order of their estimates, until as many are certified as the sweep keeps. Then
    at most as many more are computed: those whose estimate, but for its possible error, is as good as the worst
    certified one. Where the sweep refines, only designs that lie apart are certified. Where no design is within the
    limits the nearest one is computed. `progress` is called with the number certified.
    """
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
        for place, design in sorted(spread(partial(_compute_exactly, task, selection), batch.tolist())):
            exact_designs[place] = design
            if not design.fault and task.are_apart(selection.values[places], selection.values[place]).all():
                places.append(place)
                left = left[task.are_apart(selection.values[left], selection.values[place])]
                progress(min(len(places), task.sweep.keep))
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


def _next_candidate(task: Task, selection: Selection, left: Indices, kept: Sequence[Mapping[str, float]]) -> Indices:
    """First of the places left whose estimate may beat the last design that the sweep keeps; empty without one."""
    rank, sign = task.ranking.rank, 1.0 if task.ranking.most else -1.0
    worst = sorted(sign * figures[rank] for figures in kept)[-task.sweep.keep]
    better = task.ranking.score(selection.figures)[left] >= worst - _allowance(rank, worst)
    first: Indices = left[better][:1]
    return first


def _compute_exactly(task: Task, selection: Selection, place: int) -> ExactDesign:
    """Exact design at a place of the selection."""
    computed = task.exact_figures(selection.values[[place]])
    if computed.reason[0]:
        return ExactDesign({}, REASONS[computed.reason[0]])
    figures = {name: computed.figures[name] for name in selection.figures}
    broken = [limit.figure for limit in task.ranking.limits if not task.ranking.held(limit, figures)[0]]
    return ExactDesign({name: float(column[0]) for name, column in figures.items()}, broken[0] if broken else "")


def _nearest(task: Task, selection: Selection, exact_designs: Mapping[int, ExactDesign]) -> Nearest | None:
    """The exact design that misses the limits by least, where all of them were rejected.

    It is the nearest of the estimates where no exact design has figures.
    """
    places = [place for place, design in exact_designs.items() if design.figures]
    if not places or not task.ranking.limits:
        return selection.nearest
    figures = {name: np.array([exact_designs[place].figures[name] for place in places]) for name in selection.figures}
    row, worst, _ = task.ranking.nearest(figures, np.ones(len(places), dtype=np.bool_))
    place = places[row]
    return Nearest(int(selection.index[place]), selection.values[place], worst, float(figures[worst.figure][row]))


def _reorder(
    task: Task, selection: Selection, exact_designs: Mapping[int, ExactDesign], places: Sequence[int]
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
