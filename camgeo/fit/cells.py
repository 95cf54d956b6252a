"""Cells of a grid over shaft angles and depth: the number of rows that needs the fewest, and where columns lie."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.rounding import upward
from camgeo.fit.nodes import ToleranceError

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

MOST_CELLS = 1_000_000
COARSER = 1.2  # times the tolerance that the number of cells calls for, in a remedy
MORE = 1.5  # times the fewest cells so far, from which on more rows are not tried


def fewest_cells(widest: Callable[[int], Array], places: Array, most_rows: int, tolerance: float) -> tuple[int, Array]:
    """Number of rows that needs the fewest cells, and the greatest widths of its columns (n,) between places (n + 1,).

    `widest` gives these widths for a number of rows; 0 where no column is narrow enough. Places and widths are rad.
    Raises ToleranceError where the tolerance, mm, takes too many cells.
    """
    best: tuple[float, int, Array] | None = None
    count = 1
    while count <= most_rows:
        step = widest(count)
        if step.min() > 0.0:
            cells = count * float(np.sum(np.diff(places) / step))
            if best is None or cells < best[0]:
                best = cells, count, step
            elif cells > MORE * best[0]:
                break
        count += max(1, count // 8)
    if best is None or best[0] > MOST_CELLS:
        raise too_many(tolerance, math.inf if best is None else best[0])
    return best[1], best[2]


def columns(knots: Array, places: Array, widths: Array) -> Array:
    """Columns, rising from knot to knot, whose distances are about the widths (n,) between places (n + 1,)."""
    along = np.concatenate([[0.0], np.cumsum(np.diff(places) / widths)])
    found = []
    for k, (low, high) in enumerate(pairwise(np.interp(knots, places, along).tolist())):
        count = max(1, math.ceil(high - low))
        found.append(np.append(knots[k], np.interp(np.linspace(low, high, count + 1)[1:-1], along, places)))
    return np.append(np.concatenate(found), knots[-1])


def too_many(tolerance: float, cells: float) -> ToleranceError:
    """Error for a tolerance, mm, that takes so many cells; infinite where no number of them keeps it."""
    least = tolerance * (4.0 if math.isinf(cells) else COARSER * max(cells / MOST_CELLS, 1.0))
    problem = f"a flank within {tolerance:.3g} mm would take too many triangles"
    return ToleranceError(f"{problem}; give at least {upward(least, 3)} mm", least)
