"""Parts of a curve on which curvature rises or falls, and how arcs with free joints share them (docs/theory.md 3)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.curve.curve import Curve
    from kin.numeric.arrays import Array

CONSTANT = 124.7  # error of an arc of length s with free joints: |kappa'| s^3 / 124.7 (12 sqrt 108)
END = 0.687  # of an inner arc's length: the arc that touches the curve at its part's end, 3 (1.5/124.7)^(1/3)
ENDS = 2.0 * (1.0 - END)  # arcs that a part takes more than its integral
CROWDED = 2.0  # arcs to a step of the grid: a grid with more is too coarse to place arcs by
STEP = 2.0  # arcs to a step of a finer grid
FINER = 4  # times as many steps next to an extremum, where the density falls to 0 as a cube root


@dataclass(frozen=True)
class MonotonePart:
    """A part of a curve on which curvature rises (`rising` 1) or falls (-1).

    `share` (m,) is the integral of ``(|kappa'| / 124.7)^(1/3) ds`` up to the parameters `grid` (m,): the number of arcs
    at a tolerance of 1 mm.
    """

    grid: Array
    share: Array
    rising: float

    @property
    def total(self) -> float:
        """Number of arcs of the part at a tolerance of 1 mm, by the integral `share`."""
        return float(self.share[-1] - self.share[0])

    def count(self, tolerance: float) -> int:
        """Number of arcs that theory foresees within a tolerance, mm; two at least."""
        return max(2, math.ceil(self.total / math.cbrt(tolerance) + ENDS))

    def nodes(self, count: int) -> Array:
        """Parameters (count + 1,) of the joints of `count` arcs, the part's ends included."""
        place = np.concatenate([[0.0], END + np.arange(count - 1), [count - ENDS]])
        nodes: Array = np.interp(self.share[0] + place * (self.total / place[-1]), self.share, self.grid)
        nodes[0], nodes[-1] = self.grid[0], self.grid[-1]
        return nodes


def refine(curve: Curve, parts: Sequence[MonotonePart], tolerance: float) -> list[MonotonePart]:
    """Parts with a grid as fine as their arcs within a tolerance, mm, so that these begin near their final places.

    From a coarse grid thousands of arcs begin several arcs off, most where the density falls to 0 at an extremum of
    curvature, as the cube root of the distance: more than Newton's method corrects.
    """
    most = CROWDED * math.cbrt(tolerance)
    grids = {i: _grid(part, tolerance) for i, part in enumerate(parts) if float(np.diff(part.share).max()) > most}
    if not grids:
        return list(parts)
    frame = curve.sample(np.concatenate(list(grids.values())))
    slope = frame.turn_slope * frame.speed - frame.turn * frame.speed_slope
    density = np.cbrt(np.abs(slope) / CONSTANT)
    finer, begin = list(parts), 0
    for i, grid in grids.items():
        own = density[begin : begin + grid.size]
        begin += grid.size
        share = np.append(0.0, np.cumsum(0.5 * (own[1:] + own[:-1]) * np.diff(grid)))
        finer[i] = MonotonePart(grid, share, parts[i].rising)
    return finer


def _grid(part: MonotonePart, tolerance: float) -> Array:
    """Grid of a part with about `STEP` arcs to a step, its first and last steps closing in on the ends."""
    steps = np.maximum(1, np.ceil(np.diff(part.share) / (STEP * math.cbrt(tolerance)))).astype(np.intp)
    steps[[0, -1]] *= FINER
    first = np.repeat(np.cumsum(steps) - steps, steps)
    owner = np.repeat(np.arange(steps.size), steps)
    along = (np.arange(owner.size) - first) / steps[owner]
    # equal steps of the cube root of the distance from the end, with which the density grows there
    along[: steps[0]] **= 3
    along[along.size - steps[-1] :] = 1.0 - (1.0 - along[along.size - steps[-1] :]) ** 3
    width = np.diff(part.grid)
    return np.append(part.grid[owner] + width[owner] * along, part.grid[-1])
