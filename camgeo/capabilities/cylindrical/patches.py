"""Flanks of a groove that crosses itself, as sheets between their crossings that share the corners' edges.

A track lacks each wall between two corners (`camgeo.capabilities.cylindrical.crossings`), which are lines from the
floor to the blank. What is left between two of them is a patch, whose grid has its rows on the same cylinders as all
others, and whose first and last column lie on such lines. Between a line and the first upright column the columns go
over from one to the other, so that a cell takes up more shaft angle there; the bound of a cell holds wherever its
corners lie in it. A break of the acceleration has to be a column, so that none may lie beneath a line.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from camgeo.capabilities.cylindrical.bends import bends
from camgeo.capabilities.cylindrical.crossings import lost_of
from camgeo.capabilities.cylindrical.grid import SAME, grid_of
from camgeo.capabilities.cylindrical.sheet import off_chords, points_of
from camgeo.curve.curve import CurveError
from camgeo.fit.nodes import ToleranceError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.cylindrical.crossings import Corner, Crossing, Lost
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.flank import Flank
    from camgeo.capabilities.cylindrical.grid import Grid
    from kin.numeric.arrays import Array

At: TypeAlias = "tuple[Corner, int]"
"""A corner, and which of its flanks is meant."""

GUARD = 0.5  # of a column, least width of a cell beside a line
ROUNDS, MORE_ROWS = 7, 1.5  # of finer rows, and how many times as many there are in each
FINER = (1, 2, 3, 4)  # times as many columns beside a line
BESIDE = 1e-3  # rad to either side of an edge, where a break would leave a sliver
STEP_SEEN = 1e-9  # of the acceleration's range: a smaller step is none


class Patch(NamedTuple):
    """A stretch of a flank: shaft angles (rows, columns), rad, and the corners at its first and its last column."""

    name: str
    theta: Array
    begin: Corner
    end: Corner


@dataclass(frozen=True, eq=False)
class Patches:
    """All patches of both flanks on the same radii (rows,), mm, rising; `off` bounds the distance of all triangles."""

    r: Array
    patches: tuple[Patch, ...]
    off: float


def kept_between(lost: Sequence[Lost], r: float, period: float) -> list[tuple[float, float]]:
    """Stretches of shaft angles, rad, that a flank keeps on a cylinder r, mm, each from the end of a lost one on.

    Raises CurveError where what two crossings take away overlaps.
    """
    if not lost:
        return [(0.0, period)]
    radius = np.array([r])
    over = [each.over(radius) for each in lost]
    cut = sorted((float(first[0]) % period, float(last[0] - first[0])) for first, last in over)
    found = []
    for (first, width), (following, _) in zip(cut, [*cut[1:], (cut[0][0] + period, 0.0)], strict=True):
        if not (width > 0.0 and first + width < following):
            raise CurveError("crossings of the groove reach into one another", first)
        found.append((first + width, following))
    return found


def demand_smooth(design: DrumDesign) -> None:
    """Raise CurveError where the acceleration jumps on a corner's line, between floor and blank."""
    law, period = design.law, design.recipe.period
    knots = np.asarray(law.breaks, dtype=np.float64)
    jump = np.abs(law.derivatives(knots, 2, 1)[2] - law.derivatives(knots, 2, -1)[2])
    knots = knots[jump > STEP_SEEN * max(float(np.abs(law.derivatives(knots, 2, 1)[2]).max(initial=0.0)), 1.0)]
    for corner in corners_of(design.crossings):
        for line in (corner.first, corner.second):
            low, high = float(line.min()) - BESIDE, float(line.max()) + BESIDE
            under = np.mod(knots - low, period) < high - low
            if under.any():
                raise CurveError("the acceleration jumps on the edge of a crossing", float(knots[np.argmax(under)]))


def patches_of(design: DrumDesign, tolerance: float) -> Patches:
    """The patches of a groove that crosses itself, whose triangles are proved to lie within a tolerance, mm.

    The distance of an edge between two flanks from its own, which is measured half way between rows, is within it, too.
    Raises ToleranceError where it cannot be held.
    """
    ends = design.recipe.floor, design.recipe.radius
    rows = np.linspace(*ends, 2)
    for _ in range(ROUNDS):
        for flank in design.flanks.values():
            rows = np.union1d(rows, grid_of(flank, ends, tolerance, rows).r)
        grids = {name: grid_of(flank, ends, tolerance, rows) for name, flank in design.flanks.items()}
        found = _cut(design, grids, rows, tolerance)
        off = max(_edges_off(design, rows), *(grid.off for grid in grids.values()))
        if found is not None and off <= tolerance:
            patches, beside = found
            return Patches(rows, patches, max(off, beside))
        rows = np.linspace(*ends, math.ceil(MORE_ROWS * rows.size) + 1)
    raise ToleranceError(f"flanks that cross are not within {tolerance:.3g} mm", 2.0 * max(off, tolerance))


def _cut(
    design: DrumDesign, grids: dict[str, Grid], rows: Array, tolerance: float
) -> tuple[tuple[Patch, ...], float] | None:
    """Patches and the bound of the cells beside edges, mm; None where more rows are needed."""
    made, most = [], 0.0
    for name, grid in grids.items():
        flank = design.flanks[name]
        for begin, end in kept_of(design.crossings, name, flank.period):
            first, last = lines_of((begin, end), rows, flank.period)
            for finer in FINER:
                theta = _columns(grid, flank, (first, last), finer)
                off = _cells_off(flank, theta, rows)
                if off <= tolerance:
                    break
            else:
                return None
            most = max(most, off)
            made.append(Patch(name, theta, begin[0], end[0]))
    return tuple(made), most


def kept_of(crossings: list[Crossing], name: str, period: float) -> list[tuple[At, At]]:
    """Corners between which a flank, `lower` or `upper`, is kept, each with which of its flanks it is, in order."""
    ordered = sorted(lost_of(crossings, name), key=lambda each: _angle(each.begin) % period)
    return [(each.end, ordered[(i + 1) % len(ordered)].begin) for i, each in enumerate(ordered)]


def _angle(at: At) -> float:
    corner, k = at
    return float((corner.first, corner.second)[k][0])


def lines_of(ends: tuple[At, At], rows: Array, period: float) -> tuple[Array, Array]:
    """Shaft angles, rad, of two corners' lines on a flank on rows (n,), the outermost of the first in the first period.

    The second line is the next one behind the first.
    """
    first, last = (corner.at(rows)[k] for corner, k in ends)
    first = first - period * math.floor(first[-1] / period)
    return first, last + period * math.ceil((first[-1] - last[-1]) / period)


def _columns(grid: Grid, flank: Flank, lines: tuple[Array, Array], finer: int) -> Array:
    """Shaft angles (rows, columns), rad, from one line to another: upright columns of the grid between the two.

    Those at breaks of the motion are among them however near they are to a line.
    """
    (first, last), period = lines, flank.period
    at = np.concatenate([grid.theta[:-1] + turn * period for turn in (-1, 0, 1, 2)])
    step = np.append(np.diff(at), at[1] - at[0])
    broken = np.abs(np.remainder(at[:, None] - flank.law.breaks + 0.5 * period, period) - 0.5 * period) < SAME
    room = np.where(broken.any(axis=1), 0.5 * BESIDE, GUARD * step)
    upright = at[(at > first.max() + room) & (at < last.min() - room)]
    if not upright.size:
        count = finer * max(2, math.ceil(float((last - first).max()) / float(step.min())))
        share = np.linspace(0.0, 1.0, min(count, 400) + 1)
        return first[:, None] * (1.0 - share) + last[:, None] * share
    parts = []
    for line, to in ((first, upright[0]), (last, upright[-1])):
        near = float(step[np.argmin(np.abs(at - to))])
        count = finer * max(1, math.ceil(float(np.abs(to - line).max()) / near))
        share = np.arange(count) / count
        parts.append(line[:, None] * (1.0 - share) + to * share)
    middle = np.broadcast_to(upright, (first.size, upright.size))
    return np.column_stack([parts[0], middle, parts[1][:, ::-1]])


def _cells_off(flank: Flank, theta: Array, rows: Array) -> float:
    """Bound, mm, of the triangles of all cells that are not upright, and of all others no wider than the grid's."""
    corners = np.stack([theta[:-1, :-1], theta[1:, :-1], theta[:-1, 1:], theta[1:, 1:]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    aslant = (theta[1:] != theta[:-1])[:, :-1] | (theta[1:] != theta[:-1])[:, 1:]
    inner, outer = (np.broadcast_to(part[:, None], low.shape) for part in (rows[:-1], rows[1:]))
    low, high, inner, outer = low[aslant], high[aslant], inner[aslant], outer[aslant]
    if not low.size:
        return 0.0
    return float(bends(flank, (low, high), (inner, outer)).off(high - low, outer - inner).max())


def _edges_off(design: DrumDesign, rows: Array) -> float:
    """Distance, mm, of corners' lines half way between two rows from the chord between them."""
    middle = 0.5 * (rows[:-1] + rows[1:])
    lines = [line_of(corner, rows) for corner in corners_of(design.crossings)]
    between = [line_of(corner, middle) for corner in corners_of(design.crossings)]
    return max((off_chords(*pair) for pair in zip(lines, between, strict=True)), default=0.0)


def line_of(corner: Corner, r: Array) -> Array:
    """Points (n, 3), mm, of a corner's line on cylinders of radii (n,), mm."""
    return points_of(corner.flanks[0], corner.at(r)[0], r)


def corners_of(crossings: Sequence[Crossing]) -> list[Corner]:
    """All corners."""
    return [corner for crossing in crossings for corner in crossing.corners.values()]
