"""Grids of shaft angles and radii whose triangles keep a flank within a tolerance, proved cell by cell."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.bends import bends
from camgeo.curve.curve import CurveError
from camgeo.fit.cells import columns as columns_at
from camgeo.fit.cells import fewest_cells
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.bends import Bends
    from camgeo.capabilities.cylindrical.flank import Flank
    from kin.numeric.arrays import Array

LOOKS = 360  # parts of a turn, and
BLOCKS = 8  # of the depth, over each of which second derivatives are bounded
SPLITS = 6  # rounds by which a place without a bound is halved
MOST_ROWS = 4000
NONE = np.zeros(0)
SAME = 1e-12  # rad: shaft angles so near are one
SAME_ROW = 1e-6  # mm: so are rows


@dataclass(frozen=True, eq=False)
class Grid:
    """Shaft angles (n,), rising over one period, and radii (m,), rising, mm, and the proved distance of its triangles.

    The last angle is a period beyond the first one.
    """

    theta: Array
    r: Array
    off: float


def sag(radius: float, angle: Array | float) -> Array:
    """Distance, mm, of a chord over an angle, rad, from its circle of a radius, mm."""
    return np.asarray(2.0 * radius * np.sin(0.25 * np.asarray(angle)) ** 2)


def widest(radius: float, tolerance: float) -> float:
    """Angle, rad, whose chord is within a tolerance of a circle of a radius, mm; at most a sixth of a turn."""
    return min(4.0 * math.asin(math.sqrt(min(0.5 * tolerance / radius, 0.5))), TURN / 6.0)


def breaks_of(flank: Flank) -> Array:
    """Shaft angles (b + 1,), rad, between which the motion has no break: a period, rising."""
    inner = np.asarray(flank.law.breaks, dtype=np.float64)
    start = float(inner[0]) if inner.size else 0.0
    return np.append(inner if inner.size else np.zeros(1), start + flank.period)


def parts_between(knots: Array, count: int) -> Array:
    """Shaft angles (n + 1,), rad, from the first knot to the last, `count` equal steps to a turn, and all knots."""
    steps = round(count * (knots[-1] - knots[0]) / TURN)
    return np.unique(np.concatenate([np.linspace(knots[0], knots[-1], steps + 1), knots]))


def bends_over(flank: Flank, knots: Array, low: float, high: float) -> tuple[Array, Bends]:
    """Places (n + 1,), rad, and bounds of second derivatives (n,) between neighbours, from radius `low` to `high`, mm.

    The `knots` are among the places. Raises CurveError where no bound is found.
    """
    look = parts_between(knots, LOOKS)
    look = look[np.append(np.diff(look) > SAME, True)]
    edges = np.linspace(low, high, BLOCKS + 1)
    for _ in range(SPLITS):
        n = look.size - 1
        cells = bends(
            flank,
            (np.tile(look[:-1], BLOCKS), np.tile(look[1:], BLOCKS)),
            (np.repeat(edges[:-1], n), np.repeat(edges[1:], n)),
        ).most(BLOCKS)
        wide = ~np.isfinite(cells.whole).all(axis=0)
        if not wide.any():
            return look, cells
        look = np.sort(np.concatenate([look, 0.5 * (look[:-1] + look[1:])[wide]]))
    raise CurveError("a flank bends so sharply that no grid of it is proved", float(look[:-1][wide][0]))


def grid_of(
    flank: Flank, ends: tuple[float, float], tolerance: float, rows: Array = NONE, columns: Array = NONE
) -> Grid:
    """Grid whose triangles are within a tolerance of a regular flank between the radii `ends`, mm.

    Its edges on both cylinders are within the tolerance of them, too. `rows` are radii and `columns` shaft angles that
    it has at least. Raises ToleranceError where it would have too many cells, CurveError where no bound is found.
    """
    low, high = ends
    knots = breaks_of(flank)
    knots = np.unique(np.concatenate([knots, knots[0] + np.mod(columns - knots[0], flank.period)]))
    knots = knots[np.append(np.diff(knots) > SAME, True)]
    look, found = bends_over(flank, knots, low, high)
    turn = widest(high, tolerance) / found.sweep

    def step_of(count: int) -> Array:
        return np.minimum(found.step((high - low) / count, tolerance), turn)

    count, step = fewest_cells(step_of, look, MOST_ROWS, tolerance)
    r = np.linspace(low, high, count + 1)
    r = np.unique(np.concatenate([r, rows]))
    r = r[np.append(True, np.diff(r) > SAME_ROW)]
    theta = columns_at(knots, look, step)
    while True:  # between places of unlike steps a column may be too wide
        h1, cells = np.diff(theta), _touched(look, found, theta)
        off = np.maximum(cells.off(h1, (high - low) / count), sag(high, np.minimum(cells.sweep * h1, math.pi)))
        wide = off > tolerance
        if not wide.any():
            return Grid(theta, r, float(off.max()))
        theta = np.sort(np.concatenate([theta, 0.5 * (theta[:-1] + theta[1:])[wide]]))


def _touched(look: Array, found: Bends, theta: Array) -> Bends:
    """Bounds over the columns between neighbours of theta (m + 1,), from those between neighbours of `look`."""
    first = np.searchsorted(look, theta[:-1] + SAME, side="right") - 1
    last = np.searchsorted(look, theta[1:] - SAME, side="left") - 1
    cells = found.at(first)
    for between in range(1, int((last - first).max(initial=0)) + 1):
        cells = cells.joined(found.at(np.minimum(first + between, last)))
    return cells
