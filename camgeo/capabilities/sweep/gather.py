"""The chunks of a sweep drawn together: counts, the best designs in order, and the cells of its map.

Chunks pass by one at a time in the order of their designs, so memory does not grow with the sweep and the outcome does
not depend on how they came about.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.plan import Axis, Plan
    from camgeo.recipe.limits import Limit

    Floats: TypeAlias = NDArray[np.float64]

MOST_ROWS = 100_000  # of the table; the best ones
_LISTED = 200  # values of an axis that get a cell each; more are put together
_FINEST = 120  # cells along an axis of a map
_FINEST_CURVE = 1000  # cells of a sweep over one variable
_FILLED = 6  # designs that a cell should hold where their places are drawn

REASON = "reason"  # beside the figures: the number of why a design has none, 0 where it has
NONE, STUCK, OUTSIDE, KEPT = 0, 1, 2, 3  # what became of a cell's best design


@dataclass(frozen=True)
class Ranking:
    """Which designs are kept, and which of two is the better one: by `rank`, then by index."""

    rank: str
    most: bool
    limits: tuple[Limit, ...] = ()

    def held(self, limit: Limit, figures: Mapping[str, Floats], slack: float = 0.0) -> NDArray[np.bool_]:
        """Where a limit's figure is within its bounds, or misses them by no more than a slack, (m,); nan is not."""
        least = -np.inf if limit.at_least is None else limit.at_least - slack
        most = np.inf if limit.at_most is None else limit.at_most + slack
        return (figures[limit.figure] >= least) & (figures[limit.figure] <= most)

    def miss(self, limit: Limit, figures: Mapping[str, Floats]) -> Floats:
        """By how much figures (m,) lie outside a limit, as a share of the bound they break; 0 within."""
        figure = figures[limit.figure]
        found = np.zeros_like(figure)
        for bound, past in ((limit.at_least, -1.0), (limit.at_most, 1.0)):
            if bound is not None:
                found = np.fmax(found, past * (figure - bound) / (abs(bound) or 1.0))
        return found

    def score(self, figures: Mapping[str, Floats]) -> Floats:
        """The figure of the ranking, turned so that more is better, (m,)."""
        return figures[self.rank] if self.most else -figures[self.rank]


@dataclass(frozen=True)
class Counts:
    """Designs of a sweep: all; those without figures, which do not turn; of the others how many break each limit; kept.

    `reasons` counts those that do not turn by the number of the reason, where reasons are given.
    """

    computed: int
    not_turning: int
    reasons: tuple[tuple[int, int], ...]
    failing: tuple[tuple[str, int], ...]
    kept: int


@dataclass(frozen=True)
class Nearest:
    """The design that is nearest to keeping all limits where none does, and the limit that it breaks by most.

    `index` of the design, its `values` (axes,) in the recipe's units; `value` of the limit's figure in mm or degrees.
    """

    index: int
    values: Floats
    limit: Limit
    value: float


@dataclass(frozen=True)
class Certificate:
    """What was worked out exactly: how many designs hold, why others fell, and how far the estimates were off.

    `off` has for each figure the greatest error, in degrees or as a share of the value.
    """

    designs: int = 0
    fell: dict[str, int] = field(default_factory=dict)
    off: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Cells:
    """The best design in each cell over one or two axes, whatever the others are.

    `edges` of the cells along each axis, one more than cells; `best` (cells of axis 1, of axis 2 or 1) the ranking's
    figure, nan where none is kept; `state` says why.
    """

    axes: tuple[Axis, ...]
    edges: tuple[Floats, ...]
    centres: tuple[Floats, ...]
    best: Floats
    state: NDArray[np.uint8]

    def scaled(self, factor: float) -> Cells:
        """The same with the figure in another unit."""
        return replace(self, best=self.best * factor)


@dataclass(frozen=True)
class Gathered:
    """Outcome of a sweep: counts, cells, and the best designs, best first, at most MOST_ROWS.

    index (n,); values (n, axes) in the recipe's units; figures (n,) each, in mm and degrees. Where these are estimates
    `certificate` says how many designs, in front, have exact ones all the same.
    """

    counts: Counts
    index: NDArray[np.int64]
    values: Floats
    figures: dict[str, Floats]
    cells: Cells
    nearest: Nearest | None = None
    certificate: Certificate | None = None

    @property
    def rows(self) -> int:
        """Designs in the table; fewer than are kept where the table is cut."""
        return len(self.index)


def gather(
    plan: Plan,
    ranking: Ranking,
    chunks: Iterable[Mapping[str, Floats]],
    slack: Callable[[Limit], float] | None = None,
) -> Gathered:
    """Draw together the figures of all chunks, given in order; rows may miss limits by as much as `slack` says."""
    cells = _Canvas(plan)
    failing = dict.fromkeys((limit.figure for limit in ranking.limits), 0)
    stuck = kept = first = waiting = 0
    reasons: Counter[int] = Counter()
    nearest, missed = None, np.inf
    parts: list[_Rows] = []
    names: tuple[str, ...] = ()
    for figures in chunks:
        names = tuple(name for name in figures if name != REASON)
        table = np.stack([figures[name] for name in names], axis=1)
        last = first + len(table)
        values = plan.values(first, last)
        turns = ~np.isnan(table).any(axis=1)
        held, listed = turns.copy(), turns.copy()
        for limit in ranking.limits:
            fine = ranking.held(limit, figures)
            failing[limit.figure] += int((turns & ~fine).sum())
            held &= fine
            listed &= fine if slack is None else ranking.held(limit, figures, slack(limit))
        if not (kept or held.any()) and turns.any():
            misses = np.array([ranking.miss(limit, figures) for limit in ranking.limits])
            near = int(np.argmin(np.where(turns, misses.max(axis=0), np.inf)))
            if misses[:, near].max() < missed:
                worst = ranking.limits[int(np.argmax(misses[:, near]))]
                missed = float(misses[:, near].max())
                nearest = Nearest(first + near, values[near], worst, float(figures[worst.figure][near]))
        stuck += int((~turns).sum())
        if REASON in figures:
            reasons.update(figures[REASON][~turns].astype(int).tolist())
        kept += int(held.sum())
        score = ranking.score(figures)
        cells.paint(values, score, np.where(held, KEPT, np.where(turns, OUTSIDE, STUCK)).astype(np.uint8))
        index = np.arange(first, last)
        parts.append(_Rows(index[listed], score[listed], values[listed], table[listed]))
        waiting += len(parts[-1].index)
        if waiting > 2 * MOST_ROWS:
            parts = [_Rows.best(parts)]
            waiting = len(parts[0].index)
        first = last
    if first != plan.count:
        raise ValueError(f"{first} designs of {plan.count}")
    rows = _Rows.best(parts)
    return Gathered(
        Counts(first, stuck, tuple(sorted(reasons.items())), tuple(failing.items()), kept),
        rows.index,
        rows.values,
        {name: rows.table[:, i] for i, name in enumerate(names)},
        cells.finished(most=ranking.most),
        None if kept else nearest,
    )


@dataclass(frozen=True)
class _Rows:
    """Designs kept so far: index and score (n,), values (n, axes), all figures (n, figures)."""

    index: NDArray[np.int64]
    score: Floats
    values: Floats
    table: Floats

    @staticmethod
    def best(parts: list[_Rows]) -> _Rows:
        """The best of several, best first, ties by index."""
        index = np.concatenate([part.index for part in parts])
        score = np.concatenate([part.score for part in parts])
        order = np.lexsort((index, -score))[:MOST_ROWS]
        values = np.concatenate([part.values for part in parts])[order]
        return _Rows(index[order], score[order], values, np.concatenate([part.table for part in parts])[order])


class _Canvas:
    """Cells being painted chunk by chunk."""

    def __init__(self, plan: Plan) -> None:
        self._axes = plan.axes[:2]
        drawn = [axis for axis in self._axes if not axis.values]
        finest = _FINEST_CURVE if len(plan.axes) == 1 else _FINEST
        share = int((plan.count / _FILLED) ** (1.0 / max(len(drawn), 1)))
        self._grids = [_Cut(axis, min(max(share, 8), finest)) for axis in self._axes]
        shape = [grid.count for grid in self._grids] + [1] * (2 - len(self._grids))
        self._shape = (shape[0], shape[1])
        self._best = np.full(shape[0] * shape[1], -np.inf)
        self._state = np.zeros(shape[0] * shape[1], np.uint8)

    def paint(self, values: Floats, score: Floats, state: NDArray[np.uint8]) -> None:
        cell = np.zeros(len(values), np.int64)
        for i, grid in enumerate(self._grids):
            cell = cell * grid.count + grid.cell(values[:, i])
        np.maximum.at(self._state, cell, state)
        held = state == KEPT
        np.maximum.at(self._best, cell[held], score[held])

    def finished(self, *, most: bool) -> Cells:
        best = np.where(self._state == KEPT, self._best if most else -self._best, np.nan)
        return Cells(
            self._axes,
            tuple(grid.edges for grid in self._grids),
            tuple(grid.centres for grid in self._grids),
            best.reshape(self._shape),
            self._state.reshape(self._shape),
        )


class _Cut:
    """An axis cut into cells: one for each value where there are few, else equal ones."""

    def __init__(self, axis: Axis, count: int) -> None:
        values = np.unique(axis.values)
        if 0 < len(values) <= _LISTED:
            self.centres = values
            between = (values[1:] + values[:-1]) / 2.0
            if len(values) > 1:
                ends = values[0] - (between[0] - values[0]), values[-1] + (values[-1] - between[-1])
            else:
                reach = abs(values[0]) * 0.1 or 1.0
                ends = values[0] - reach, values[0] + reach
            self.edges = np.concatenate([[ends[0]], between, [ends[1]]])
        else:
            low, high = sorted((axis.low, axis.high))
            self.edges = np.linspace(low, high, (count if len(values) == 0 else _LISTED) + 1)
            self.centres = (self.edges[1:] + self.edges[:-1]) / 2.0
        self.count = len(self.centres)

    def cell(self, values: Floats) -> NDArray[np.int64]:
        return np.searchsorted(self.edges[1:-1], values, side="right").astype(np.int64)
