"""The chunks of a sweep gathered: counts, the best designs in order, and the cells of its map.

Chunks are read one at a time in the order of their designs, so memory does not grow with the sweep, and the outcome
does not depend on how they were computed.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from numpy.typing import NDArray

    from camgeo.capabilities.sweep.keys import Axis
    from camgeo.capabilities.sweep.plan import Plan
    from camgeo.recipe.limits import Limit
    from kin.numeric.arrays import Array, Mask

MOST_ROWS = 100_000  # of the table; the best ones
_MOST_VALUES = 200  # of an axis that get a cell each; more share cells
_MOST_CELLS = 120  # along an axis of a map
_MOST_CELLS_CURVE = 1000  # of a sweep over one variable
_DESIGNS_A_CELL = 6  # on average, where values are not listed

REASON = "reason"  # beside the figures: the code of why a design has none, 0 where it has
NONE, STUCK, OUTSIDE, KEPT = 0, 1, 2, 3  # state of a cell: no design, none turns, none keeps the limits, one kept


@dataclass(frozen=True)
class Ranking:
    """The limits that designs must keep, and their order: by the figure `rank`, the greatest first if `most`."""

    rank: str
    most: bool
    limits: tuple[Limit, ...] = ()

    def held(self, limit: Limit, figures: Mapping[str, Array], slack: float = 0.0) -> Mask:
        """Mask (m,) of the designs that keep a limit, its bounds widened by `slack`; nan keeps none.

        `figures` (m,) are by name; `slack` is in the unit of the figure.
        """
        least = -np.inf if limit.at_least is None else limit.at_least - slack
        most = np.inf if limit.at_most is None else limit.at_most + slack
        return (figures[limit.figure] >= least) & (figures[limit.figure] <= most)

    def miss(self, limit: Limit, figures: Mapping[str, Array]) -> Array:
        """Excess (m,) of the limited figure beyond its bounds, 0 within them and for nan; `figures` (m,) are by name.

        The excess is a share of the bound's magnitude, or in the figure's own unit where the bound is 0.
        """
        figure = figures[limit.figure]
        excess = np.zeros_like(figure)
        for bound, sign in ((limit.at_least, -1.0), (limit.at_most, 1.0)):
            if bound is not None:
                excess = np.fmax(excess, sign * (figure - bound) / (abs(bound) or 1.0))
        return excess

    def nearest(self, figures: Mapping[str, Array], rows: Mask) -> tuple[int, Limit, float]:
        """Row that misses the limits by least, the limit that it misses most, and the excess beyond that limit.

        `figures` (m,) are by name, `rows` (m,) is a mask of the rows that count. The excess is measured by `miss`.
        """
        misses = np.array([self.miss(limit, figures) for limit in self.limits])
        row = int(np.argmin(np.where(rows, misses.max(axis=0), np.inf)))
        worst = int(np.argmax(misses[:, row]))
        return row, self.limits[worst], float(misses[worst, row])

    def score(self, figures: Mapping[str, Array]) -> Array:
        """The ranking's figure (m,), negative if the least is best, so that a greater score is better."""
        return figures[self.rank] if self.most else -figures[self.rank]


@dataclass(frozen=True)
class Counts:
    """Numbers of designs: all; those without figures, which do not turn; those that break a limit; those kept.

    `reasons` are pairs of a reason's code and the number of designs without figures for it, `failing` pairs of a
    limit's figure and the number of designs that break it.
    """

    computed: int
    not_turning: int
    reasons: tuple[tuple[int, int], ...]
    failing: tuple[tuple[str, int], ...]
    kept: int


@dataclass(frozen=True)
class Nearest:
    """The design that misses the limits by least where none keeps them, and the limit that it misses by most.

    The design has the `index` and the `values` (axes,), in the recipe's units; `value` is its figure that `limit`
    limits, in mm or degrees.
    """

    index: int
    values: Array
    limit: Limit
    value: float


@dataclass(frozen=True)
class Certificate:
    """Number of designs whose exact figures keep the limits, numbers of rejected ones, and errors of the estimates.

    `rejected` is by the reason: a word of REASONS, or the figure of the limit that is broken. `errors` has for each
    figure the greatest error, in degrees or as a share of the value.
    """

    designs: int = 0
    rejected: dict[str, int] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Selection:
    """The best designs of a sweep, best first, at most MOST_ROWS, with counts and cells of all.

    `index` (n,) is the index in the plan, `values` (n, axes) are in the recipe's units, `figures` (n,) by name in mm
    and degrees. Where figures are estimates, the first `certificate.designs` rows have exact ones. `nearest` is None
    where a design is kept, or none turns.
    """

    counts: Counts
    index: NDArray[np.int64]
    values: Array
    figures: dict[str, Array]
    cells: BestByCell
    nearest: Nearest | None = None
    certificate: Certificate | None = None

    @property
    def rows(self) -> int:
        """Number of designs in the table, n."""
        return len(self.index)


def gather(
    plan: Plan,
    ranking: Ranking,
    chunks: Iterable[Mapping[str, Array]],
    slack: Callable[[Limit], float] | None = None,
) -> Selection:
    """Select the best designs, at most MOST_ROWS, best first.

    The chunks, in order of the index, have figures (m,) by name. `slack` gives for a limit an amount in the figure's
    unit: a design is listed if it misses no limit by more; without `slack`, if it keeps all limits. Raises ValueError
    unless the chunks have the figures of all designs of the plan.
    """
    cells = BestByCell(plan, most=ranking.most)
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
        # a design with a figure that is nan counts as one that does not turn
        turns: Mask = np.logical_not(np.isnan(table).any(axis=1))
        kept_here, listed = turns.copy(), turns.copy()
        for limit in ranking.limits:
            within = ranking.held(limit, figures)
            failing[limit.figure] += int((turns & ~within).sum())
            kept_here &= within
            listed &= within if slack is None else ranking.held(limit, figures, slack(limit))
        # the nearest design is of interest only while none is kept
        if not (kept or kept_here.any()) and turns.any():
            row, worst, miss = ranking.nearest(figures, turns)
            if miss < missed:
                missed = miss
                nearest = Nearest(first + row, values[row], worst, float(figures[worst.figure][row]))
        stuck += int((~turns).sum())
        if REASON in figures:
            reasons.update(figures[REASON][~turns].astype(int).tolist())
        kept += int(kept_here.sum())
        score = ranking.score(figures)
        cells.paint(values, score, np.where(kept_here, KEPT, np.where(turns, OUTSIDE, STUCK)).astype(np.uint8))
        index = np.arange(first, last)
        parts.append(_Rows(index[listed], score[listed], values[listed], table[listed]))
        # worse rows are dropped now and then, so that memory is bounded
        waiting += len(parts[-1].index)
        if waiting > 2 * MOST_ROWS:
            parts = [_Rows.best(parts)]
            waiting = len(parts[0].index)
        first = last
    if first != plan.count:
        raise ValueError(f"{first} designs of {plan.count}")
    rows = _Rows.best(parts)
    return Selection(
        Counts(first, stuck, tuple(sorted(reasons.items())), tuple(failing.items()), kept),
        rows.index,
        rows.values,
        {name: rows.table[:, i] for i, name in enumerate(names)},
        cells,
        None if kept else nearest,
    )


@dataclass(frozen=True)
class _Rows:
    """Designs listed so far: index and score (n,), values (n, axes), all figures (n, figures)."""

    index: NDArray[np.int64]
    score: Array
    values: Array
    table: Array

    @staticmethod
    def best(parts: list[_Rows]) -> _Rows:
        """The best rows of several parts, at most MOST_ROWS, best first, ties by index."""
        index = np.concatenate([part.index for part in parts])
        score = np.concatenate([part.score for part in parts])
        order = np.lexsort((index, -score))[:MOST_ROWS]
        values = np.concatenate([part.values for part in parts])[order]
        return _Rows(index[order], score[order], values, np.concatenate([part.table for part in parts])[order])


class BestByCell:
    """The best design in each cell over the first one or two axes of a plan; designs are added by `paint`.

    `edges` and `centres` have, for each axis, the ends and centres of its cells. `state` (cells of axis 1, of axis 2 or
    1) has NONE, STUCK, OUTSIDE or KEPT. `most` says that the greatest figure is the best.
    """

    def __init__(self, plan: Plan, *, most: bool) -> None:
        self.axes = plan.axes[:2]
        ranges = [axis for axis in self.axes if not axis.values]
        greatest = _MOST_CELLS_CURVE if len(plan.axes) == 1 else _MOST_CELLS
        count = int((plan.count / _DESIGNS_A_CELL) ** (1.0 / max(len(ranges), 1)))
        self._grids = [_AxisCells(axis, min(max(count, 8), greatest)) for axis in self.axes]
        self.edges = tuple(grid.edges for grid in self._grids)
        self.centres = tuple(grid.centres for grid in self._grids)
        shape = [grid.count for grid in self._grids] + [1] * (2 - len(self._grids))
        self._most = most
        self._score = np.full(shape, -np.inf)
        self.state = np.zeros(shape, np.uint8)

    def paint(self, values: Array, score: Array, state: NDArray[np.uint8]) -> None:
        """Add designs with values (m, axes), scores (m,) and states (m,)."""
        cell = np.zeros(len(values), np.int64)
        for i, grid in enumerate(self._grids):
            cell = cell * grid.count + grid.cell(values[:, i])
        np.maximum.at(self.state.reshape(-1), cell, state)
        kept = state == KEPT
        np.maximum.at(self._score.reshape(-1), cell[kept], score[kept])

    @property
    def best(self) -> Array:
        """The ranking's figure of the best design, in the shape of `state`; nan where no design is kept."""
        return np.where(self.state == KEPT, self._score if self._most else -self._score, np.nan)


class _AxisCells:
    """Cells along an axis: one for each value where there are few, else equal ones, `count` of them for a range."""

    def __init__(self, axis: Axis, count: int) -> None:
        values = np.unique(axis.values)
        if 0 < len(values) <= _MOST_VALUES:
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
            self.edges = np.linspace(low, high, (count if len(values) == 0 else _MOST_VALUES) + 1)
            self.centres = (self.edges[1:] + self.edges[:-1]) / 2.0
        self.count = len(self.centres)

    def cell(self, values: Array) -> NDArray[np.int64]:
        """Number of the cell of each value (m,)."""
        return np.searchsorted(self.edges[1:-1], values, side="right").astype(np.int64)
