"""A curve as a polygon that straddles it: as much outside at the vertices as inside between them (THEORY section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.deviation import Chain, Deviation, chain_deviation
from camgeo.fit.nodes import TRIES, Density, ToleranceError, check_count, check_precision, reshared
from camgeo.fit.pieces import Bound, Polygon

if TYPE_CHECKING:
    from camgeo.curve import Array, Curve, Frame, Run

USABLE = 0.9995  # of the tolerance; the rest covers rounding and the second order at the vertices
BALANCED = 1e-3  # of the tolerance: how far the two sides may differ before the vertices are moved once more
ROUNDS = 3  # of sharing the nodes anew before there are more of them
# What part of the tolerance to aim at, and whether by proved or, quicker, by seen sagittas, until the proof holds it all.
PARTS = ((1.0, False), (0.996, True), (0.98, True), (0.9, True), (0.6, True), (0.3, True))
ACROSS = 0.8  # shares on each side of an inflection that one edge can cover; the limit is sqrt(24)/6
FULL = 0.93  # of the tolerance used is enough; below it fewer edges are looked for


def polygon_density(frame: Frame) -> Array:
    """Edges for each unit of parameter at a tolerance of 1 mm: ``sqrt(|kappa|/16) ds/dt``."""
    density: Array = np.sqrt(np.abs(frame.turn * frame.speed)) / 4.0
    return density


def least_vertices(curve: Curve, tolerance: float) -> float:
    """Leading-order count of a straddling polygon: integral of ``sqrt(|kappa|/(16 e)) ds`` (THEORY section 3)."""
    stretches = [(float(a), float(b)) for run in curve.runs for a, b in run.stretches]
    total = sum(Density.of(curve, a, b, polygon_density).total for a, b in stretches)
    return total / math.sqrt(tolerance)


@dataclass(frozen=True)
class _Edges:
    """Edges of one run: nodes (n + 1,), vertices (n + 1, 2), and how they lie.

    Vertices stand `outward` and `inward` of the curve at most; `overhang` is how far the curve can reach past the ends
    of the edge that belongs to it; `bend` (n,) is 1 for an edge of a convex stretch, -1 for a concave one, 0 across an
    inflection; `load` is the greatest sagitta found.
    """

    nodes: Array
    vertices: Array
    outward: float
    inward: float
    overhang: float
    bend: Array
    deviation: Deviation
    load: float = math.inf

    @property
    def extremes(self) -> tuple[float, float]:
        """Farthest that the edges are proved to lie outward and inward of the curve, and the curve of them."""
        outward = max(self.outward, math.hypot(-min(float(self.deviation.inside.min()), 0.0), self.overhang))
        inward = max(self.inward, math.hypot(max(float(self.deviation.outside.max()), 0.0), self.overhang))
        return outward, inward


def fit_polygon(curve: Curve, tolerance: float) -> Polygon:
    """Polygon within `tolerance` mm of a curve, vertices as far outside as the edges' middles are inside.

    The bound is proved by `chain_deviation`. The number of vertices grows as tolerance^(-1/2) and stays within about
    1 % of the leading-order least. Raises ToleranceError where the tolerance is below rounding, needs too many
    vertices, or is not reached.
    """
    stretches = [(float(a), float(b)) for run in curve.runs for a, b in run.stretches]
    size = float(np.abs(curve.sample(np.array([a for a, _ in stretches])).point).max())
    check_precision(size, tolerance)
    parts, outward, inward = [], 0.0, 0.0
    for run in curve.runs:
        vertices, out, into = _fit_run(curve, run, USABLE * tolerance)
        parts.append(vertices[:-1])
        outward, inward = max(outward, out), max(inward, into)
    return Polygon(np.concatenate(parts), Bound(outward, inward).widened(4.0 * math.ulp(size)))


def _fit_run(curve: Curve, run: Run, tolerance: float) -> tuple[Array, float, float]:
    """Vertices of one run, its end included, and how far they lie outward and inward of the curve.

    First with a vertex at every break, which costs at most one edge a break more than the least. Where the stretches
    take so few edges that rounding their numbers up wastes part of the tolerance, fewer edges that run across the
    breaks are tried as well.
    """
    densities = [Density.of(curve, float(a), float(b), polygon_density) for a, b in run.stretches]
    needed = sum(density.total for density in densities) / math.sqrt(tolerance)
    check_count(needed, "straight edges", tolerance)
    best = math.inf
    for part, proved in PARTS:
        edges = _shared(curve, run, densities, part * tolerance, proved=proved)
        if edges is None:
            break
        # the greatest sagitta, halved, is how far the vertices stand out
        shift = min(0.5 * edges.load, tolerance)
        placed = _edges(curve, run, edges.nodes, shift, tolerance)
        outward, inward = placed.extremes
        if run.closed and math.isfinite(outward + inward) and abs(outward - inward) > BALANCED * tolerance:
            shift = min(shift * (outward + inward) / (2.0 * outward), tolerance)
            placed = _edges(curve, run, edges.nodes, shift, tolerance)
            outward, inward = placed.extremes
        best = min(best, max(outward, inward))
        if best <= tolerance:
            return placed.vertices, outward, inward
    raise ToleranceError(f"a polygon within {tolerance:.3g} mm was not reached; the best was {best:.3g} mm", best)


def _shared(
    curve: Curve, run: Run, densities: list[Density], tolerance: float, *, proved: bool
) -> _Edges | None:
    """Fewest edges found whose sagittas stay within twice the tolerance."""
    least = 3 if run.closed else 1
    edges = _settled(curve, run, densities, tolerance, least, math.inf, proved=proved)
    if edges is not None and len(densities) > 1 and edges.load < FULL * 2.0 * tolerance:
        whole = [Density.joined(densities)]
        free = _settled(curve, run, whole, tolerance, least, edges.nodes.size - 2, proved=proved)
        return free or edges
    return edges


def _settled(
    curve: Curve, run: Run, groups: list[Density], tolerance: float, least: int, most: float, *, proved: bool
) -> _Edges | None:
    """Fewest nodes, shared within each group, that keep every sagitta within twice the tolerance.

    None where more than `most` edges would be needed.
    """
    allowed = 2.0 * tolerance * (1.0 + 1e-12)
    parts, links = _first_nodes(curve, groups, math.sqrt(tolerance), least)
    shared = [0] * len(parts)
    for _ in range(TRIES):
        nodes, owner = _chained(parts)
        if nodes.size - 1 > most:
            return None
        edges = _edges(curve, run, nodes, tolerance, tolerance if proved else math.inf)
        found = edges.deviation
        high, low = (found.outside, found.inside) if proved else (found.seen_high, found.seen_low)
        # what lies beyond the vertices' own side; across an inflection both sides count
        worst = np.maximum(high, -low)
        load = np.where(edges.bend > 0, high, np.where(edges.bend < 0, -low, worst)) + tolerance
        load = np.where(worst > tolerance * (1.0 + 1e-12), np.maximum(load, worst + tolerance), load)
        load[~np.isfinite(found.inside) | ~np.isfinite(found.outside)] = np.inf
        top = float(load.max())
        if top <= allowed:
            return replace(edges, load=top)
        for i, part in enumerate(parts):
            mine = load[owner == i]
            if mine.size and float(mine.max()) > allowed:
                parts[i], shared[i] = _denser(part, mine, 2.0 * tolerance, shared[i])
                check_count(parts[i].size, "straight edges", tolerance)
        for i, at in links.items():
            over = float(load[(owner == -1) & (nodes[:-1] == parts[i][-1])].max(initial=0.0))
            if over > allowed:
                # the error of an edge across an inflection grows as the cube of its length
                share = 0.99 * (2.0 * tolerance / over) ** (1.0 / 3.0) if math.isfinite(over) else 0.5
                parts[i][-1] = at + share * (parts[i][-1] - at)
                parts[i + 1][0] = at + share * (parts[i + 1][0] - at)
    return None


def _first_nodes(
    curve: Curve, groups: list[Density], root: float, least: int
) -> tuple[list[Array], dict[int, float]]:
    """Nodes in equal shares of each group, cut at inflections; `links` holds the inflection after each part.

    The edge that runs across an inflection covers `ACROSS` shares on each side of it: there the curve is a cubic, and
    the line that best fits a cubic does so over k' a^3 = 24 e (Chebyshev's polynomial of degree 3).
    """
    parts: list[Array] = []
    links: dict[int, float] = {}
    total = sum(group.total for group in groups) / root
    scale = min(1.0, total / least)
    seams = _flips(curve, groups)
    for number, group in enumerate(groups):
        cuts = _inflections(curve, group)
        ends = [0.0, *(float(np.interp(cut, group.t, group.sum)) / root for cut in cuts), group.total / root]
        starts_across, ends_across = seams[number], seams[number + 1]
        for i, (begin, end) in enumerate(pairwise(ends)):
            before = ACROSS if i > 0 or starts_across else 0.0
            after = ACROSS if i < len(cuts) or ends_across else 0.0
            count = max(1, math.ceil((end - begin) / scale - before - after - 1e-6))
            share = (end - begin) / (count + before + after)
            part = group.at((begin + share * (before + np.arange(count + 1))) * root)
            if i == 0 and not starts_across:
                part[0] = group.t[0]
            if i == len(cuts) and not ends_across:
                part[-1] = group.t[-1]
            if after:
                links[len(parts)] = cuts[i] if i < len(cuts) else float(group.t[-1])
            parts.append(part)
    return parts, links


def _flips(curve: Curve, groups: list[Density]) -> list[bool]:
    """Whether a convex and a concave stretch meet at the beginning of each group, and at the end of the last: never."""
    at = np.array([group.t[0] for group in groups[1:]])
    if not at.size:
        return [False, False]
    before, after = curve.sample(at, -1).turn, curve.sample(at, 1).turn
    return [False, *(bool(flip) for flip in (before >= 0.0) != (after >= 0.0)), False]


def _inflections(curve: Curve, group: Density) -> list[float]:
    """Parameters inside a group at which the turn changes its sign, by bisection."""
    inner = group.t[1:-1]
    positive = curve.sample(inner).turn >= 0.0
    found = np.flatnonzero(positive[1:] != positive[:-1])
    low, high, sense = inner[found], inner[found + 1], positive[found]
    for _ in range(40):
        middle = 0.5 * (low + high)
        same = (curve.sample(middle).turn >= 0.0) == sense
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return [float(x) for x in 0.5 * (low + high)]


def _chained(parts: list[Array]) -> tuple[Array, Array]:
    """All nodes in order, and for each edge the part it belongs to, -1 for one that links two parts."""
    pieces, owner = [parts[0]], [np.zeros(parts[0].size - 1, dtype=np.int64)]
    for i, part in enumerate(parts[1:], start=1):
        if part[0] == parts[i - 1][-1]:
            pieces.append(part[1:])
        else:
            pieces.append(part)
            owner.append(np.array([-1]))
        owner.append(np.full(part.size - 1, i))
    return np.concatenate(pieces), np.concatenate(owner)


def _denser(nodes: Array, load: Array, allowed: float, shared: int) -> tuple[Array, int]:
    """Nodes for the next try: shared anew while the mean load is within what is allowed, then more of them."""
    if not np.isfinite(load).all():
        wild = ~np.isfinite(load)
        return np.sort(np.append(nodes, 0.5 * (nodes[:-1] + nodes[1:])[wild])), 0
    mean = float(np.mean(np.sqrt(load))) ** 2
    if mean <= allowed and shared < ROUNDS:
        return reshared(nodes, load, 2.0), shared + 1
    count = nodes.size - 1
    more = max(count + 1, math.ceil(count * math.sqrt(mean / allowed)))
    total = np.concatenate([[0.0], np.cumsum(np.sqrt(load))])
    spread: Array = np.interp(np.linspace(0.0, total[-1], more + 1), total, nodes)
    spread[0], spread[-1] = nodes[0], nodes[-1]
    return spread, 0


def _edges(curve: Curve, run: Run, nodes: Array, shift: float, tolerance: float) -> _Edges:
    """Edges between nodes moved by `shift` to the convex side, and their deviation over each edge.

    An edge across a break of the curve is judged on both sides of it.
    """
    at = curve.sample(nodes[:-1])
    last = at if run.closed else curve.sample(nodes[-1:], -1)
    normal = np.append(at.normal, last.normal[:1], axis=0)
    away = np.append(np.where(at.turn >= 0.0, shift, -shift), 0.0)
    away[-1] = away[0]
    if not run.closed:
        away[[0, -1]] = 0.0
    vertices = np.append(at.point, last.point[:1], axis=0) + away[:, None] * normal
    chord = np.diff(vertices, axis=0)
    tangent = chord / np.hypot(chord[:, 0], chord[:, 1])[:, None]
    # A vertex stands on the normal of its node. Where the curve bends the same way at both ends of an edge, the nodes'
    # feet on the edge lie within it; elsewhere part of the curve is nearest to the vertex itself.
    behind = -away[:-1] * np.sum(tangent * normal[:-1], axis=1)
    beyond = away[1:] * np.sum(tangent * normal[1:], axis=1)
    overhang = -min(0.0, float(behind.min()), float(beyond.min()))
    cuts = np.array([b for b in run.breaks if not np.any(nodes == b)])
    low = np.sort(np.concatenate([nodes[:-1], cuts]))
    high = np.append(low[1:], nodes[-1])
    edge = np.clip(np.searchsorted(nodes, low, side="right") - 1, 0, nodes.size - 2)
    chain = Chain(vertices[:-1][edge], tangent[edge], np.zeros(low.size), low, high)
    found = chain_deviation(curve, chain, tolerance, 4)
    if cuts.size:
        first = np.searchsorted(edge, np.arange(nodes.size - 1))
        found = Deviation(
            np.minimum.reduceat(found.inside, first),
            np.maximum.reduceat(found.outside, first),
            np.minimum.reduceat(found.seen_low, first),
            np.maximum.reduceat(found.seen_high, first),
        )
    outward, inward = max(0.0, float(away.max())), max(0.0, -float(away.min()))
    sense = np.where(at.turn >= 0.0, 1.0, -1.0)
    sense = np.append(sense, sense[0] if run.closed else math.copysign(1.0, float(last.turn[0])))
    bend = 0.5 * (sense[:-1] + sense[1:])
    return _Edges(nodes, vertices, outward, inward, overhang, bend, found)
