"""Angles over the period of a motion, equally far apart, with all that a roller does at them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array

FINE = 0.05  # of the tolerance: what angles between two of the grid may cost
LEAST, MOST = 720, 65_536  # angles of the grid, of each turn


@dataclass(frozen=True, eq=False)
class Grid:
    """Angles k w (n,), rad, over the period, with the lift, mm, slope and bend, sine and cosine at them.

    The rows of `after` are lift, sine and cosine midway to the next.
    """

    width: float
    lift: Array
    slope: Array
    bend: Array
    sine: Array
    cosine: Array
    after: Array

    @staticmethod
    def of(gauge: Gauge, count: int) -> Grid:
        """So many angles over the period."""
        width = gauge.lifts.period / count
        at = width * np.arange(count, dtype=np.float64)
        after = at + 0.5 * width
        midway = np.stack([gauge.lifts.at(after)[0], np.sin(after), np.cos(after)])
        return Grid(width, *gauge.lifts.at(at), np.sin(at), np.cos(at), midway)

    def __len__(self) -> int:
        return len(self.lift)


def angles_for(gauges: Sequence[Gauge], tolerance: float) -> int:
    """How many angles the grid needs: between two of them a point holds a roller to a share of the tolerance, mm."""
    count = LEAST
    for gauge in gauges:
        count = max(count, math.ceil(TURN / math.sqrt(8.0 * FINE * tolerance / gauge.fastest)))
    return min(count, MOST) * gauges[0].lifts.turns
