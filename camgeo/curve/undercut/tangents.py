"""Directions of a curve's tangent over any stretch of it: proved ranges, in a table."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from kin.numeric.arrays import Array

STEP = 0.03  # rad: cells over which the tangent may turn by more are divided
MOST_PARTS = 256  # of one cell
ROUNDING = 1e-9  # rad: far above the rounding of the sum of all changes of direction
RIGHT, STRAIGHT = 0.5 * math.pi - ROUNDING, math.pi - ROUNDING


@dataclass(frozen=True)
class TangentDirections:
    """Directions of the tangent over two turns of a closed curve, for the stretches between `knots` (m + 1,).

    `low` and `high` (levels, m), rad, bound the direction over 1, 2, 4, ... stretches from each on; `hollow` and
    `bulging` (m + 1,) count the stretches before each knot that are not proved convex, and not proved concave.
    """

    knots: Array
    low: Array
    high: Array
    hollow: NDArray[np.intp]
    bulging: NDArray[np.intp]

    @staticmethod
    def of(curve: Curve) -> TangentDirections:
        """Table of a whole closed curve, from its cells' proved bounds of the turn."""
        # cells divided so that the tangent turns by no more than about `STEP` over each part
        cells = curve.cells
        width = cells.high - cells.low
        steep = np.maximum(np.abs(cells.rows[2]), np.abs(cells.rows[3]))
        parts = np.clip(np.ceil(steep * width / STEP), 1, MOST_PARTS).astype(np.intp)
        owner = np.repeat(np.arange(parts.size), parts)
        share = np.concatenate([np.arange(n) / n for n in parts.tolist()])
        low = cells.low[owner] + share * width[owner]
        tangent = curve.sample(low).tangent
        after = np.roll(tangent, -1, axis=0)
        cross = tangent[:, 0] * after[:, 1] - tangent[:, 1] * after[:, 0]
        change = np.arctan2(cross, np.sum(tangent * after, axis=1))
        turning = (steep / parts * width)[owner]
        convex, concave = cells.rows[2, owner] >= 0.0, cells.rows[3, owner] <= 0.0
        # between two knots the tangent may swing out and back, unless it keeps its sense of turning
        slack = np.where(convex | concave, 0.0, 0.5 * np.maximum(turning - np.abs(change), 0.0))
        slack[turning >= math.pi] = np.inf  # the change itself is not known
        theta = np.concatenate([[0.0], np.cumsum(np.tile(change, 2))])
        slack = np.tile(slack, 2)
        least = np.minimum(theta[:-1], theta[1:]) - slack
        most = np.maximum(theta[:-1], theta[1:]) + slack
        period = curve.shape.period
        knots = np.concatenate([low, low + period, [low[0] + 2.0 * period]])
        return TangentDirections(
            knots, _doubled(np.minimum, least), _doubled(np.maximum, most), _before(~convex), _before(~concave)
        )

    def near(self, start: Array, end: Array) -> NDArray[np.bool_]:
        """Whether stretches from `start` to `end` (n,), start < end, turn by a right angle at most.

        Stretches that are convex or concave throughout may turn by half a turn.
        """
        # the range over many stretches is that of two overlapping runs of 2^level stretches
        first = np.clip(np.searchsorted(self.knots, start, side="right") - 1, 0, self.low.shape[1] - 1)
        last = np.clip(np.searchsorted(self.knots, end, side="left"), first + 1, self.low.shape[1])
        level = np.frexp(last - first)[1] - 1
        second = last - (1 << level)
        span = np.maximum(self.high[level, first], self.high[level, second]) - np.minimum(
            self.low[level, first], self.low[level, second]
        )
        one_way = (self.hollow[first] == self.hollow[last]) | (self.bulging[first] == self.bulging[last])
        is_near: NDArray[np.bool_] = (span <= RIGHT) | (one_way & (span <= STRAIGHT))
        return is_near


def _before(flags: NDArray[np.bool_]) -> NDArray[np.intp]:
    return np.concatenate([[0], np.cumsum(np.tile(flags, 2))])


def _doubled(worst: np.ufunc, values: Array) -> Array:
    """Extremes of 1, 2, 4, ... values from each on (levels, m), by `worst`, minimum or maximum."""
    rows = [values]
    while 2 << (len(rows) - 1) <= values.size:
        step = 1 << (len(rows) - 1)
        row = rows[-1].copy()
        row[:-step] = worst(rows[-1][:-step], rows[-1][step:])
        rows.append(row)
    return np.stack(rows)
