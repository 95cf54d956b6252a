"""A curve as a polygon that straddles it: as much outside at the vertices as inside between them (THEORY section 3).

Vertices stand off the curve by the tolerance, on its convex side. The curve is divided at its breaks, where a vertex
stands, and at its inflections, which one edge crosses; in each part as few edges as will do are made equally high.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.edges import Edges, look, placed, proved
from camgeo.fit.inflection import REACH, crossings, inflections
from camgeo.fit.nodes import Density, ToleranceError, check_count, check_precision, reshared, rounding
from camgeo.fit.pieces import Bound, Polygon

if TYPE_CHECKING:
    from camgeo.curve import Array, Curve, Frame, Run

USABLE = 0.9995  # of the tolerance; the rest covers the second order at the vertices
BALANCED = 1e-3  # of the tolerance: how far the two sides may differ before the vertices are moved once more
AIMS = (1.0, 0.998, 0.98, 0.9, 0.6, 0.3, 0.1)  # parts of the tolerance aimed at until the proof holds it all
TRIES = 24  # of placing nodes for one aim
ROUNDS = 5  # of levelling the edges of a part before there are more of them
FREE_TRIES = 4  # counts tried with edges across the breaks
FULL = 0.93  # of the tolerance used is enough; below it fewer edges are looked for
SLIGHT = 1.0  # shares: what bends the other way for less than this is not worth two crossings
CROSSING = 0.994  # of the tolerance: what an edge across an inflection aims at, the rest covers its proof
ROOM = 0.45  # of a part between two inflections that one crossing may take
EXACT = 1.0 + 1e-9


def polygon_density(frame: Frame) -> Array:
    """Edges for each unit of parameter at a tolerance of 1 mm: ``sqrt(|kappa|/16) ds/dt``."""
    density: Array = np.sqrt(np.abs(frame.turn * frame.speed)) / 4.0
    return density


def least_vertices(curve: Curve, tolerance: float) -> float:
    """Leading-order count of a straddling polygon: integral of ``sqrt(|kappa|/(16 e)) ds`` (THEORY section 3)."""
    total = sum(part.total for run in curve.runs for part in Density.of(curve, run.stretches, polygon_density))
    return total / math.sqrt(tolerance)


@dataclass
class _Part:
    """Nodes (n + 1,) between two fixed ones; `sense` is the side of the vertices; `crossed` if an edge leads on from it
    across an inflection; `least` is the fewest edges not yet known to fail, `tried` counts the tries to level them.
    """

    nodes: Array
    sense: float
    crossed: bool
    least: int = 1
    tried: int = 0

    @property
    def count(self) -> int:
        """Edges of the part."""
        return int(self.nodes.size - 1)


def fit_polygon(curve: Curve, tolerance: float) -> Polygon:
    """Polygon within `tolerance` mm of a curve, vertices as far outside as the edges' middles are inside.

    The bound is proved by `chain_deviation`. The number of vertices grows as tolerance^(-1/2) and stays within about
    1 % of the leading-order least, one more for each break. Raises ToleranceError where the tolerance is below
    rounding, needs too many vertices, or is not reached; CurveError where the curve runs backwards.
    """
    size = curve.size
    check_precision(size, tolerance)
    usable = min(USABLE * tolerance, tolerance - rounding(size))
    parts, outward, inward = [], 0.0, 0.0
    for run in curve.runs:
        edges = _fit_run(curve, run, usable)
        parts.append(edges.vertices[:-1])
        out, into = edges.extremes
        outward, inward = max(outward, out), max(inward, into)
    return Polygon(np.concatenate(parts), Bound(outward, inward).widened(rounding(size)))


def _fit_run(curve: Curve, run: Run, tolerance: float) -> Edges:
    """Edges of one run, proved to lie within the tolerance."""
    densities = Density.of(curve, run.stretches, polygon_density)
    needed = sum(density.total for density in densities) / math.sqrt(tolerance)
    check_count(needed, "straight edges", tolerance)
    bends, sense = inflections(curve, densities)
    best = math.inf
    for aim in AIMS:
        goal = aim * tolerance
        parts, height = _settled(curve, run, _parts(curve, run, densities, bends, sense, goal), goal)
        if len(densities) > 1 and height < FULL * goal:
            parts, height = _across_breaks(curve, run, Density.joined(densities), parts, goal) or (parts, height)
        edges = _balanced(curve, run, parts, min(height, goal), tolerance)
        best = min(best, max(edges.extremes))
        if best <= tolerance:
            return edges
    raise ToleranceError(f"a polygon within {tolerance:.3g} mm was not reached; the best was {best:.3g} mm", best)


def _balanced(curve: Curve, run: Run, parts: list[_Part], shift: float, tolerance: float) -> Edges:
    """Proved edges; moved once more where one side is used more than the other, which runs without corners allow."""
    nodes, _, sides = _chained(parts)
    edges = proved(curve, placed(curve, run, nodes, shift * sides), tolerance)
    outward, inward = edges.extremes
    level = run.closed and bool((sides == sides[0]).all())
    if level and math.isfinite(outward + inward) and abs(outward - inward) > BALANCED * tolerance:
        shift = min(0.5 * (outward + inward), tolerance)
        moved = proved(curve, placed(curve, run, nodes, shift * sides), tolerance)
        if max(moved.extremes) < max(outward, inward):
            return moved
    return edges


def _parts(
    curve: Curve, run: Run, densities: list[Density], bends: Array, sense: float, tolerance: float
) -> list[_Part]:
    """Parts between breaks and inflections, nodes in equal shares."""
    root = math.sqrt(tolerance)
    whole = Density.joined(densities)
    bends = _worthwhile(bends, whole, root)
    share = np.array([whole.share(float(t)) for t in bends]) / root
    room = ROOM * np.diff(np.concatenate([[0.0], share, [whole.total / root]]))
    low = whole.at(root * (share - np.minimum(REACH, room[:-1])))
    high = whole.at(root * (share + np.minimum(REACH, room[1:])))
    edge = crossings(curve, bends, low, high, CROSSING * tolerance)
    low, high = np.array(edge.low), np.array(edge.high)
    overlap = np.append(high[:-1] >= low[1:], False) if bends.size else np.zeros(0, dtype=bool)
    for i in np.flatnonzero(overlap):
        # two crossings that meet leave one edge between them
        high[i], low[i + 1] = whole.at(np.array([0.6, 0.4]) * share[i] * root + np.array([0.4, 0.6]) * share[i + 1] * root)
    ends: list[tuple[float, float, float]] = [(run.low, run.low, 1.0)]
    ends += [(float(a), float(b), -1.0) for a, b in zip(low, high, strict=True)]
    for at in run.breaks:
        if not ((low <= at) & (at <= high)).any():
            ends.append((at, at, 1.0))
    ends.append((run.high, run.high, 1.0))
    ends.sort()
    parts = []
    for (_, begin, _), (end, _, flip) in pairwise(ends):
        first, last = whole.share(begin), whole.share(end)
        nodes = whole.at(np.linspace(first, last, max(1, math.ceil((last - first) / root - 0.05)) + 1))
        nodes[0], nodes[-1] = begin, end
        parts.append(_Part(nodes, sense, flip < 0.0))
        sense *= flip
    if run.closed and (missing := 3 - sum(part.count + part.crossed for part in parts)) > 0:
        first_part = parts[0]
        count = first_part.count + missing
        parts[0] = _Part(np.linspace(first_part.nodes[0], first_part.nodes[-1], count + 1), first_part.sense,
                         first_part.crossed, count)
    return parts


def _worthwhile(bends: Array, whole: Density, root: float) -> Array:
    """Inflections without the pairs that enclose less than `SLIGHT` shares."""
    kept: list[float] = []
    for bend in bends:
        if kept and whole.share(float(bend)) - whole.share(kept[-1]) < SLIGHT * root:
            kept.pop()
        else:
            kept.append(float(bend))
    return np.array(kept)


def _chained(parts: list[_Part]) -> tuple[Array, Array, Array]:
    """All nodes in order, for each edge its part (-1 across an inflection), for each node the side of its vertex."""
    nodes, owner = [parts[0].nodes], [np.zeros(parts[0].count, dtype=np.int64)]
    sides = [np.full(parts[0].nodes.size, parts[0].sense)]
    for i, part in enumerate(parts[1:], start=1):
        skip = 0 if parts[i - 1].crossed else 1
        nodes.append(part.nodes[skip:])
        sides.append(np.full(part.nodes.size - skip, part.sense))
        if not skip:
            owner.append(np.array([-1]))
        owner.append(np.full(part.count, i))
    return np.concatenate(nodes), np.concatenate(owner), np.concatenate(sides)


def _settled(curve: Curve, run: Run, parts: list[_Part], tolerance: float) -> tuple[list[_Part], float]:
    """Parts with the fewest edges found whose sagittas keep within twice the tolerance, and half the greatest."""
    allowed = 2.0 * tolerance
    height = math.inf
    for _ in range(TRIES):
        nodes, owner, sides = _chained(parts)
        seen = look(curve, placed(curve, run, nodes, tolerance * sides), sides, tolerance)
        height = 0.5 * float(seen.load.max())
        busy = False
        for i, part in enumerate(parts):
            mine = owner == i
            busy |= _improve(part, seen.load[mine], seen.by_low[mine], seen.by_high[mine], allowed)
        check_count(sum(part.count for part in parts), "straight edges", tolerance)
        if not busy:
            break
    crossed = any(part.crossed for part in parts)
    return parts, tolerance if crossed else min(height, tolerance)


def _improve(part: _Part, load: Array, by_low: Array, by_high: Array, allowed: float) -> bool:
    """Give a part better nodes; False where it has the fewest edges and none is too high."""
    shares = float(np.sqrt(np.maximum(load, 0.0) / allowed).sum())
    best = max(part.least, math.ceil(shares - 1e-9))
    fits = float(load.max()) <= allowed * EXACT
    if fits and best >= part.count:
        return False
    if best < part.count and part.tried == 0:
        part.nodes = reshared(part.nodes, load, 2.0, best)
        part.tried = 1
    elif fits:
        return False
    elif best == part.count and part.tried < ROUNDS:
        part.nodes = levelled(part.nodes, load, by_low, by_high)
        part.tried += 1
    else:
        part.least = max(part.count + 1, best)
        part.nodes = reshared(part.nodes, load, 2.0, part.least)
        part.tried = 1
    return True


def levelled(nodes: Array, load: Array, by_low: Array, by_high: Array) -> Array:
    """Nodes (n + 1,), ends kept, moved by one step of Newton's method towards equal loads (n,) of all edges.

    `by_low` and `by_high` (n,) are the derivatives of each load by the parameter of its first and second node.
    """
    sound = bool((by_low < 0.0).all() and (by_high > 0.0).all())
    if not sound or float(load.max()) > 4.0 * float(load.min()):
        return reshared(nodes, load, 2.0)
    # load + by_low d + by_high d+ = level, from d = 0 to d = 0: a recurrence, solved by its product and sum
    product = np.cumprod(-by_low / by_high)
    fixed = product * np.cumsum(-load / by_high / product)
    slope = product * np.cumsum(1.0 / by_high / product)
    move = np.concatenate([[0.0], fixed - slope * (fixed[-1] / slope[-1])])
    if not np.isfinite(move).all():
        return reshared(nodes, load, 2.0)
    move[-1] = 0.0
    width = np.diff(nodes)
    squeeze = float(np.max(-np.diff(move) / width, initial=0.0))
    moved: Array = nodes + move * min(1.0, 0.5 / squeeze if squeeze > 0.0 else 1.0)
    return moved


def _across_breaks(
    curve: Curve, run: Run, whole: Density, parts: list[_Part], tolerance: float
) -> tuple[list[_Part], float] | None:
    """Fewer edges with no heed of the breaks, where rounding up the stretches' counts has wasted tolerance.

    None where that is not found, or inflections divide the curve.
    """
    if len({part.sense for part in parts}) > 1:
        return None
    most = sum(part.count for part in parts)
    start = max(3 if run.closed else 1, math.ceil(whole.total / math.sqrt(tolerance)))
    for count in range(start, min(most, start + FREE_TRIES)):
        free = _Part(whole.nodes(count), parts[0].sense, crossed=False, least=count)
        sides = np.full(count + 1, free.sense)
        for _ in range(3 * ROUNDS):
            seen = look(curve, placed(curve, run, free.nodes, tolerance * sides), sides, tolerance)
            if float(seen.load.max()) <= 2.0 * tolerance * EXACT:
                return [free], 0.5 * float(seen.load.max())
            free.nodes = levelled(free.nodes, seen.load, seen.by_low, seen.by_high)
    return None
