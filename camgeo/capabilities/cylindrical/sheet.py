"""A flank as points on a grid, rows on cylinders; where it is undercut, cut to what all rollers leave."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.bends import bends
from camgeo.capabilities.cylindrical.grid import grid_of
from camgeo.capabilities.cylindrical.undercut import cut_at
from camgeo.fit.nodes import ToleranceError
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.flank import Flank
    from camgeo.capabilities.cylindrical.grid import Grid
    from camgeo.capabilities.cylindrical.undercut import Cut, Tip
    from kin.numeric.arrays import Array, Indices, Mask


FOR_CELLS = 0.8  # of a tolerance: cells at the edge of a cut are wider by SNAP, and the edge is off itself
SNAP = 0.1  # of a column: a place so near the edge of a cut becomes a point of it
FIRST_ROWS = 12  # on which a cut is known at first
MORE_ROWS, LESS, ROUNDS = 1.5, 0.7, 8  # times as many rows, and times FOR_CELLS, in each further round
NEAR_TIP = 1e-6  # of the depth of a cut: rows so near its tip are not cut


@dataclass(frozen=True, eq=False)
class Sheet:
    """Points (k, 3) of a flank, mm, and the index of each place of its grid (rows, columns); rows rise in radius.

    Along a row the polar angle rises, and the last column is joined to the first. `off` is the bound, mm, of the
    distance of its triangles from the flank.
    """

    points: Array
    at: Indices
    off: float


def whole_sheet(flank: Flank, low: float, high: float, tolerance: float) -> Sheet:
    """Sheet of a flank that is regular from radius `low` to `high`, mm; raises ToleranceError as `grid_of` does."""
    grid = grid_of(flank, (low, high), tolerance)
    theta, r = np.meshgrid(grid.theta[:-1], grid.r)
    points = points_of(flank, theta.ravel(), r.ravel())
    return Sheet(points, np.arange(points.shape[0]).reshape(r.shape), grid.off)


def cut_sheet(flank: Flank, low: float, high: float, tolerance: float, tips: Sequence[Tip]) -> Sheet:
    """Sheet of a flank of which all rollers together leave less, from the tips of its undercuts inwards.

    The bound of its triangles is proved; how far the edge of a cut is off between two rows is measured half way. Raises
    ToleranceError where it cannot be held, CutError where two undercuts reach into one another.
    """
    count, share = FIRST_ROWS, FOR_CELLS
    for _ in range(ROUNDS):
        rows = [tip.r - (tip.r - low) * (1.0 - np.arange(count + 1) / count) ** 2 for tip in tips]
        at = np.array([tip.at for tip in tips])
        grid = grid_of(flank, (low, high), share * tolerance, np.concatenate(rows), at)
        below = [grid.r[grid.r < tip.r - NEAR_TIP * (tip.r - low)] for tip in tips]
        cuts = [cut_at(flank, tip, r) for tip, r in zip(tips, below, strict=True)]
        sheet = _trimmed(flank, grid, cuts)
        off = sheet.off + max(_edge_off(flank, cut) for cut in cuts)
        if off <= tolerance:
            return Sheet(sheet.points, sheet.at, off)
        count, share = math.ceil(MORE_ROWS * count), share * LESS
    raise ToleranceError(f"a flank that is cut short is not within {tolerance:.3g} mm", 2.0 * off)


def points_of(flank: Flank, theta: Array, r: Array) -> Array:
    """Points (n, 3) of a flank, mm, at shaft angles and on cylinders (n,)."""
    phi, z = flank.on(theta, r)[2:4]
    return np.column_stack([r * np.cos(phi), r * np.sin(phi), z])


def _trimmed(flank: Flank, grid: Grid, cuts: Sequence[Cut]) -> Sheet:
    """The points of a grid outside all cuts, and the edges of these in place of the points within."""
    theta = grid.theta[:-1]
    width = np.minimum(np.diff(grid.theta), np.roll(np.diff(grid.theta), 1))
    at = np.arange(grid.r.size * theta.size).reshape(grid.r.size, theta.size)
    early, late = np.tile(theta, (grid.r.size, 1)), np.tile(theta, (grid.r.size, 1))
    edges, count = [], at.size
    for cut in cuts:
        offset = np.mod(theta - cut.tip.at + math.pi, TURN) - math.pi
        first, last = cut.first - cut.tip.at, cut.last - cut.tip.at
        for k in range(cut.r.size):
            within = (offset > first[k] - SNAP * width) & (offset < last[k] + SNAP * width)
            if not within.any():
                within[np.argmin(np.abs(offset - 0.5 * (first[k] + last[k])))] = True
            at[k, within] = count + k
            early[k, within], late[k, within] = (theta - offset)[within] + first[k], (theta - offset)[within] + last[k]
        edges.append(points_of(flank, cut.first, cut.r))
        count += cut.r.size
    radius, angle = np.meshgrid(grid.r, theta, indexing="ij")
    points = np.concatenate([points_of(flank, angle.ravel(), radius.ravel()), *edges])
    used, number = np.unique(at, return_inverse=True)
    off = max(grid.off, _cells_off(flank, grid, (early, late), at >= grid.r.size * theta.size))
    return Sheet(points[used], number.reshape(at.shape), off)


def _cells_off(flank: Flank, grid: Grid, ends: tuple[Array, Array], cut: Mask) -> float:
    """Bound, mm, of cells with a corner on the edge of a cut, whose shaft angle may be taken on either side of it."""
    near = _corners(cut.astype(np.float64)).any(axis=0)
    if not near.any():
        return 0.0
    lows, highs = [], []
    for end in ends:
        corners = _corners(end)[:, near]
        around = corners[0] + np.mod(corners - corners[0] + math.pi, TURN) - math.pi
        lows.append(around.min(axis=0))
        highs.append(around.max(axis=0))
    early = highs[0] - lows[0] < highs[1] - lows[1]
    low, high = np.where(early, *lows), np.where(early, *highs)
    inner, outer = (np.broadcast_to(part[:, None], near.shape)[near] for part in (grid.r[:-1], grid.r[1:]))
    return float(bends(flank, (low, high), (inner, outer)).off(high - low, outer - inner).max())


def _corners(values: Array) -> Array:
    """Values at the four corners of each cell (4, rows - 1, columns), the last column joined to the first."""
    beside = np.roll(values, -1, axis=1)
    return np.stack([values[:-1], values[1:], beside[:-1], beside[1:]])


def _edge_off(flank: Flank, cut: Cut) -> float:
    """Distance, mm, of the edge of a cut half way between two rows from the chord between them."""
    r = np.append(cut.r, cut.tip.r)
    ends = points_of(flank, np.append(cut.first, cut.tip.at), r)
    middle = cut_at(flank, cut.tip, 0.5 * (r[:-1] + r[1:]))
    return off_chords(ends, points_of(flank, middle.first, middle.r))


def off_chords(ends: Array, between: Array) -> float:
    """Greatest distance, mm, of points (n, 3) from the lines between neighbours of others (n + 1, 3)."""
    chord = ends[1:] - ends[:-1]
    share = np.sum((between - ends[:-1]) * chord, axis=1) / np.sum(chord * chord, axis=1)
    return float(np.sqrt(np.sum((between - ends[:-1] - share[:, None] * chord) ** 2, axis=1)).max())
