"""A curve as a polygon that straddles it: as much outside at the vertices as inside between them (docs/theory.md 3).

Vertices stand off the curve by the tolerance, on its convex side. The curve is divided at its breaks, where a vertex
stands, and at its inflections, which one edge crosses; in each part the fewest edges that hold are made equally high.
"""

from __future__ import annotations

import math
from itertools import accumulate, pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.rounding import upward
from camgeo.fit.edges import ProvedEdges, Sagittas, node_frames, place_edges, prove_edges, sagittas
from camgeo.fit.inflection import REACH, crossings, inflections, reaches
from camgeo.fit.nodes import Density, ToleranceError, check_count, check_precision, reshare, rounding
from camgeo.fit.pieces import Bound, Polygon
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve, Frame, SmoothRun
    from kin.numeric.arrays import Array

USABLE = 0.9995  # of the tolerance; the rest covers the second order at the vertices
BALANCED = 1e-3  # of the tolerance: with a greater difference between the sides vertices are moved once more
AIMS = (1.0, 0.998, 0.995, 0.99, 0.97, 0.9, 0.6, 0.3, 0.1)  # parts of the tolerance aimed at until it is proved
TRIES = 24  # of placing nodes for one aim
ROUNDS = 5  # of levelling the edges of a part before it takes more edges
SHORTENINGS = 3  # of edges across inflections after a proof, before less is aimed at
SHORTENED = 1.05  # least factor by which an edge that a proof rejects is made shorter
FREE_TRIES = 4  # counts tried with edges across the breaks
LEVELLINGS = 16  # steps for each count
FULL = 0.93  # of the tolerance: where less is used, fewer edges across the breaks are sought
SLIGHT = 1.0  # shares: a shorter stretch between two inflections is not worth two crossings
STRAIGHT = 1e-3  # shares: an end of a run that bends less is as good as straight
CROSSING = 0.9995  # of the tolerance: aim of an edge across an inflection; the rest covers its proof
GRID = 2.0  # times the reach by the density: an edge across an inflection that reaches farther begins with its cubic
CROSSING_SHARE = 0.45  # of a part between two inflections that one crossing may take
EXACT = 1.0 + 1e-9  # times a limit, for rounding
SEEN = 1.03  # times the limit, up to which the samples of an edge across an inflection may overrate it


def polygon_density(frame: Frame) -> Array:
    """Edges per unit of the parameter at a tolerance of 1 mm (k,): ``sqrt(|kappa|/16) ds/dt``."""
    density: Array = np.sqrt(np.abs(frame.turn * frame.speed)) / 4.0
    return density


def least_vertices(curve: Curve, tolerance: float) -> float:
    """Leading-order count of a straddling polygon within a tolerance e, mm: integral of ``sqrt(|kappa|/(16 e)) ds``.

    Raises CurveError where the curve runs backwards.
    """
    total = sum(part.total for run in curve.runs for part in Density.of(curve, run.stretches, polygon_density))
    return total / math.sqrt(tolerance)


@dataclass()
class _Part:
    """A part of a run between fixed nodes: `nodes` (n + 1,) and the side `sense` of its vertices, 1 outside, -1 inside.

    `crossed` says whether an edge follows the part across an inflection; `least` is the fewest edges not yet known to
    fail, `tried` counts the tries to level the edges.
    """

    nodes: Array
    sense: float
    crossed: bool
    least: int = 1
    tried: int = 0

    @property
    def count(self) -> int:
        """Number of edges of the part."""
        return int(self.nodes.size - 1)


def fit_polygon(curve: Curve, tolerance: float) -> Polygon:
    """Polygon within `tolerance` mm of a curve, vertices as far outside as the edges' middles are inside.

    Its bound is proved. The number of vertices grows as tolerance^(-1/2) and stays within about 1 % of the
    leading-order least, one more for each break. Raises ToleranceError where the tolerance is below rounding, needs too
    many vertices, or is not reached; CurveError where the curve runs backwards.
    """
    size = curve.size
    check_precision(size, tolerance)
    usable = min(USABLE * tolerance, tolerance - rounding(size))
    parts, outward, inward = [], 0.0, 0.0
    for run in curve.runs:
        edges = _fit_run(curve, run, usable, tolerance)
        parts.append(edges.vertices[:-1])
        out, into = edges.extremes
        outward, inward = max(outward, out), max(inward, into)
    return Polygon(np.concatenate(parts), Bound(outward, inward).widened(rounding(size)))


def _fit_run(curve: Curve, run: SmoothRun, tolerance: float, full: float) -> ProvedEdges:
    """Edges of one run, proved to lie within the tolerance; `full` is the tolerance before rounding was taken off.

    Both are mm. Raises ToleranceError where no such edges are found.
    """
    densities = Density.of(curve, run.stretches, polygon_density)
    needed = sum(density.total for density in densities) / math.sqrt(tolerance)
    check_count(needed, "straight edges", full, 2.0, lost=full - tolerance)
    bends, sense = inflections(curve, densities, tolerance)
    best = math.inf
    # ever less of the tolerance is aimed at, until the proof holds
    for aim in AIMS:
        goal = aim * tolerance
        parts, height = _settle(curve, run, _parts(curve, run, densities, bends, sense=sense, tolerance=goal), goal)
        if len(densities) > 1 and height < FULL * goal:
            parts, height = _across_breaks(curve, run, densities, parts, goal) or (parts, height)
        edges = _balance(curve, run, parts, min(height, goal), tolerance)
        for _ in range(SHORTENINGS):
            if not _shorten_failing(parts, edges, tolerance):
                break
            parts, height = _settle(curve, run, parts, goal)
            edges = _balance(curve, run, parts, min(height, goal), tolerance)
        best = min(best, max(edges.extremes))
        if best <= tolerance:
            return edges
    raise ToleranceError(f"a polygon within {full:.3g} mm was not reached; the best was {upward(best, 3)} mm", best)


def _balance(curve: Curve, run: SmoothRun, parts: list[_Part], shift: float, tolerance: float) -> ProvedEdges:
    """Proved edges with vertices off by `shift`, mm.

    In a closed run without inflections the vertices are moved once more where one side is used more than the other.
    """
    nodes, sides = _chain(parts)
    frames = node_frames(curve, run, nodes)
    edges = prove_edges(curve, place_edges(frames, run, nodes, shift * sides), tolerance)
    outward, inward = edges.extremes
    level = run.closed and bool((sides == sides[0]).all())
    if level and math.isfinite(outward + inward) and abs(outward - inward) > BALANCED * tolerance:
        shift = 0.5 * (outward + inward)
        moved = prove_edges(curve, place_edges(frames, run, nodes, shift * sides), tolerance)
        if max(moved.extremes) < max(outward, inward):
            return moved
    return edges


def _parts(
    curve: Curve, run: SmoothRun, densities: list[Density], bends: Array, *, sense: float, tolerance: float
) -> list[_Part]:
    """Parts between breaks and inflections `bends` (k,), with nodes in equal shares of the density.

    `sense` is the sign of the turn before the first inflection.
    """
    # edges across inflections, first by the density, then by their cubics
    root = math.sqrt(tolerance)
    whole = Density.join(densities)
    bends, sense = _worthwhile_bends(bends, sense, whole, root, closed=run.closed)
    share = np.array([whole.share(float(t)) for t in bends]) / root
    reach = CROSSING_SHARE * np.diff(np.concatenate([[0.0], share, [whole.total / root]]))
    low = whole.parameters_at(root * (share - np.minimum(REACH, reach[:-1])))
    high = whole.parameters_at(root * (share + np.minimum(REACH, reach[1:])))
    if bends.size:
        # the grid of the density may be far wider than an edge
        before, after = reaches(curve, bends, run, tolerance)
        least, most = whole.parameters_at(root * (share - reach[:-1])), whole.parameters_at(root * (share + reach[1:]))
        low = np.where(before > GRID * (bends - low), np.maximum(bends - before, least), low)
        high = np.where(after > GRID * (high - bends), np.minimum(bends + after, most), high)
    edge = crossings(curve, bends, low, high, CROSSING * tolerance)
    # an edge that would reach beyond the run's own end keeps to the guess, which does not
    low = np.where(edge.low > run.low, edge.low, low)
    high = np.where(edge.high < run.high, edge.high, high)
    overlap = np.append(high[:-1] >= low[1:], False) if bends.size else np.zeros(0, dtype=bool)
    for i in np.flatnonzero(overlap):
        # two crossings that meet leave one edge between them
        gap = share[i + 1] - share[i]
        high[i], low[i + 1] = whole.parameters_at(root * (share[i] + gap * np.array([0.4, 0.6])))
    # ends of parts: where one part ends, where the next begins, and -1 where its vertices change sides
    ends: list[tuple[float, float, float]] = [(run.low, run.low, 1.0)]
    ends += [(float(a), float(b), -1.0) for a, b in zip(low, high, strict=True)]
    for place in run.breaks:
        if not ((low <= place) & (place <= high)).any():
            ends.append((place, place, 1.0))
    ends.append((run.high, run.high, 1.0))
    ends.sort()
    parts = []
    for (_, begin, _), (end, _, flip) in pairwise(ends):
        first, last = whole.share(begin), whole.share(end)
        nodes = whole.parameters_at(np.linspace(first, last, max(1, math.ceil((last - first) / root - 0.05)) + 1))
        nodes[0], nodes[-1] = begin, end
        parts.append(_Part(nodes, sense, flip < 0.0))
        sense *= flip
    # a closed polygon has three edges at least
    if run.closed and (missing := 3 - sum(part.count + part.crossed for part in parts)) > 0:
        first_part, count = parts[0], parts[0].count + missing
        nodes = np.linspace(first_part.nodes[0], first_part.nodes[-1], count + 1)
        parts[0] = _Part(nodes, first_part.sense, first_part.crossed, count)
    return parts


def _worthwhile_bends(bends: Array, sense: float, whole: Density, root: float, *, closed: bool) -> tuple[Array, float]:
    """Inflections without the pairs that enclose less than `SLIGHT` shares, and the sense before the first.

    Those between which and an end of an open run the curve is straight go too. `root` is the square root of the
    tolerance.
    """
    share = [whole.share(float(bend)) / root for bend in bends]
    remaining = [float(bend) for bend in bends]
    if not closed:
        while remaining and share[0] < STRAIGHT:
            del remaining[0], share[0]
            sense = -sense
        while remaining and whole.total / root - share[-1] < STRAIGHT:
            del remaining[-1], share[-1]
    while len(remaining) > 1:
        between = np.diff(share)
        least = int(np.argmin(between))
        around = share[0] + whole.total / root - share[-1]
        if closed and around < min(SLIGHT, between[least]):
            del remaining[0], share[0], remaining[-1], share[-1]
            sense = -sense
        elif between[least] < SLIGHT:
            del remaining[least : least + 2], share[least : least + 2]
        else:
            break
    return np.array(remaining), sense


def _chain(parts: list[_Part]) -> tuple[Array, Array]:
    """All nodes in order, and the side of each node's vertex; parts without a crossing between share a node."""
    nodes, sides = [parts[0].nodes], [np.full(parts[0].nodes.size, parts[0].sense)]
    for before, part in pairwise(parts):
        skip = 0 if before.crossed else 1
        nodes.append(part.nodes[skip:])
        sides.append(np.full(part.nodes.size - skip, part.sense))
    return np.concatenate(nodes), np.concatenate(sides)


def _settle(curve: Curve, run: SmoothRun, parts: list[_Part], tolerance: float) -> tuple[list[_Part], float]:
    """Parts with the fewest edges whose sagittas keep within twice the tolerance, mm, and the vertices' offset, mm.

    The offset is half the greatest sagitta, or the tolerance where edges cross inflections.
    """
    allowed = 2.0 * tolerance
    noise = 0.5 * rounding(curve.size)
    height = math.inf
    # parts and crossings are improved until none changes
    for _ in range(TRIES):
        nodes, sides = _chain(parts)
        seen = sagittas(
            curve, place_edges(node_frames(curve, run, nodes), run, nodes, tolerance * sides), sides, tolerance
        )
        height = 0.5 * float(seen.load.max())
        busy = False
        first_edges = list(accumulate((part.count + part.crossed for part in parts), initial=0))
        for part, k in zip(parts, first_edges, strict=False):
            rows = slice(k, k + part.count)
            busy |= _improve(part, Sagittas(seen.load[rows], seen.by_low[rows], seen.by_high[rows]), allowed, noise)
        for (first, second), k in zip(pairwise(parts), first_edges[1:], strict=False):
            if first.crossed:
                over = float(seen.load[k - 1]) / allowed
                busy |= over > SEEN and _shorten(first, second, over)
        check_count(sum(part.count for part in parts), "straight edges", tolerance, 2.0)
        if not busy:
            break
    crossed = any(part.crossed for part in parts)
    return parts, tolerance if crossed else min(height, tolerance)


def _improve(part: _Part, samples: Sagittas, allowed: float, noise: float) -> bool:
    """Give a part better nodes; False where its edges are the fewest and no sagitta is above `allowed`, mm.

    Sagittas have a rounding error of `noise`, mm, which levelling does not remove.
    """
    # loads grow as the square of the length: the sum of the roots of their shares is the number of edges needed
    load = samples.load
    shares = float(np.sqrt(np.maximum(load, 0.0) / allowed).sum())
    best = max(part.least, math.ceil(shares - 1e-9))
    fits = float(load.max()) <= allowed * EXACT
    if fits and best >= part.count:
        return False
    if best < part.count and part.tried == 0:
        part.nodes = reshare(part.nodes, load, 2.0, best)
        part.tried = 1
    elif fits:
        return False
    elif best == part.count and part.tried < ROUNDS and float(load.max() - load.mean()) > noise:
        part.nodes = level_loads(part.nodes, load, samples.by_low, samples.by_high)
        part.tried += 1
    else:
        part.least = max(part.count + 1, math.ceil(shares * (1.0 + 0.5 * noise / allowed) - 1e-9))
        part.nodes = reshare(part.nodes, load, 2.0, part.least)
        part.tried = 1
    return True


def _shorten_failing(parts: list[_Part], edges: ProvedEdges, tolerance: float) -> bool:
    """Shorten edges across inflections whose proved height is above the tolerance, mm; False without such edges."""
    last = list(accumulate((part.count + part.crossed for part in parts), initial=-1))[1:]
    shorter = False
    for (first, second), k in zip(pairwise(parts), last, strict=False):
        if first.crossed and tolerance < edges.heights[k] < math.inf:
            # in proportion to its height, not to the height's cube root: the curve below is no cubic throughout
            shorter |= _shorten(first, second, max(float(edges.heights[k]) / tolerance, SHORTENED) ** 3)
    return shorter


def _shorten(first: _Part, second: _Part, over: float) -> bool:
    """Shorten the edge across an inflection between two parts, whose height is `over` times too much; always True.

    The height grows as the cube of the length.
    """
    low, high = first.nodes[-1], second.nodes[0]
    move = 0.5 * (1.0 - over ** (-1.0 / 3.0)) * (high - low)
    first.nodes, second.nodes = first.nodes.copy(), second.nodes.copy()
    first.nodes[-1], second.nodes[0] = low + move, high - move
    first.tried = second.tried = 0
    return True


def level_loads(nodes: Array, load: Array, by_low: Array, by_high: Array) -> Array:
    """Nodes (n + 1,), ends kept, moved by one step of Newton's method towards equal loads (n,) of all edges.

    `by_low` and `by_high` (n,) are the derivatives of each load by the parameter of its first and second node. The step
    is cut so that no edge loses more than half of its interval. Where a load is not above 0, or does not grow with its
    edge at both nodes, nodes are moved by `reshare` instead.
    """
    if not bool((load > 0.0).all() and (by_low < 0.0).all() and (by_high > 0.0).all()):
        return reshare(nodes, load, 2.0)
    # roots of the loads, about proportional to the length:  root + by_low d + by_high d+ = level,  d and d+ the moves
    # of an edge's nodes, 0 at both ends; a recurrence, solved by its product and sum
    root = np.sqrt(load)
    by_low, by_high, load = 0.5 * by_low / root, 0.5 * by_high / root, root
    product = np.cumprod(-by_low / by_high)
    fixed = product * np.cumsum(-load / by_high / product)
    slope = product * np.cumsum(1.0 / by_high / product)
    move = np.concatenate([[0.0], fixed - slope * (fixed[-1] / slope[-1])])
    if not np.isfinite(move).all():
        return reshare(nodes, load, 2.0)
    move[-1] = 0.0
    width = np.diff(nodes)
    # no edge is shortened by more than half
    squeeze = float(np.max(-np.diff(move) / width, initial=0.0))
    moved: Array = nodes + move * min(1.0, 0.5 / squeeze if squeeze > 0.0 else 1.0)
    return moved


def _across_breaks(
    curve: Curve, run: SmoothRun, densities: list[Density], parts: list[_Part], tolerance: float
) -> tuple[list[_Part], float] | None:
    """Part with fewer edges, placed regardless of the breaks, and its vertices' offset, mm.

    Rounding up the count of each stretch wastes tolerance. None where no fewer edges hold, or inflections divide the
    curve.
    """
    if any(part.crossed for part in parts):
        return None
    whole = Density.join(densities)
    starts = [0.0]
    if run.closed:
        totals = np.array([density.total for density in densities])
        longest = int(np.argmax(totals))
        starts = [float(totals[:longest].sum() + 0.5 * totals[longest]), 0.0]
    # closed runs may begin in the middle of their longest stretch or at their own beginning
    most = sum(part.count for part in parts)
    least = max(3 if run.closed else 1, math.ceil(whole.total / math.sqrt(tolerance)))
    for count in range(least, min(most, least + FREE_TRIES)):
        for start in starts:
            share = start + np.linspace(0.0, whole.total, count + 1)
            over = share >= whole.total
            nodes = whole.parameters_at(np.where(over, share - whole.total, share)) + np.where(
                over, run.high - run.low, 0.0
            )
            nodes[-1] = nodes[0] + (run.high - run.low)
            level = _level(curve, run, nodes, parts[0].sense, tolerance)
            if level is not None:
                return [_Part(level[0], parts[0].sense, crossed=False)], level[1]
    return None


def _level(curve: Curve, run: SmoothRun, nodes: Array, sense: float, tolerance: float) -> tuple[Array, float] | None:
    """Nodes at which no sagitta exceeds twice the tolerance, mm, and half the greatest, mm; None where none are found.

    Newton's method on the edges' heights, which have corners where edges meet breaks: a step that does not make the
    heights more alike is shortened.
    """
    sides = np.full(nodes.size, sense)
    # full steps from the most even nodes so far, shorter ones after a step that made the loads less even
    best, spread, move, pace = nodes, math.inf, np.zeros_like(nodes), 1.0
    for _ in range(LEVELLINGS):
        seen = sagittas(
            curve, place_edges(node_frames(curve, run, nodes), run, nodes, tolerance * sides), sides, tolerance
        )
        top = float(seen.load.max())
        if top <= 2.0 * tolerance * EXACT:
            return nodes, 0.5 * top
        root = np.sqrt(np.maximum(seen.load, 0.0))
        unevenness = float(np.std(root) / np.mean(root))
        if unevenness < spread:
            best, spread = nodes, unevenness
            move = level_loads(nodes, seen.load, seen.by_low, seen.by_high) - nodes
            pace = min(1.0, 2.0 * pace)
        else:
            pace *= 0.3
        if spread < 1e-3 or pace < 1e-3:
            break
        nodes = best + pace * move
    return None
