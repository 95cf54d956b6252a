"""A curve as a polygon that straddles it: as much outside at the vertices as inside between them (THEORY section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.deviation import Chain, Deviation, chain_deviation
from camgeo.fit.nodes import TRIES, Density, ToleranceError, check_count, check_precision, reshared
from camgeo.fit.pieces import Bound, Polygon

if TYPE_CHECKING:
    from camgeo.curve import Array, Curve, Frame, Run

USABLE = 0.9995  # of the tolerance; the rest covers rounding and the second order at the vertices
BALANCED = 1e-3  # of the tolerance: how far the two sides may differ before the vertices are moved once more
ROUNDS = 4  # of sharing the nodes anew; the imbalance falls by an order of magnitude in each


def polygon_density(frame: Frame) -> Array:
    """Edges for each unit of parameter at a tolerance of 1 mm: ``sqrt(|kappa|/16) ds/dt``."""
    density: Array = np.sqrt(np.abs(frame.turn * frame.speed)) / 4.0
    return density


def least_vertices(curve: Curve, tolerance: float) -> float:
    """Leading-order count of a straddling polygon: integral of ``sqrt(|kappa|/(16 e)) ds`` (THEORY section 3)."""
    stretches = [(float(a), float(b)) for run in curve.runs for a, b in run.stretches]
    total = sum(Density(curve, a, b, polygon_density).total for a, b in stretches)
    return total / math.sqrt(tolerance)


@dataclass(frozen=True)
class _Edges:
    """Edges of one run: nodes (n + 1,), vertices (n + 1, 2), how they lie, and the part of edges each break cuts."""

    nodes: Array
    vertices: Array
    sine: float
    deviation: Deviation


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
    """Vertices of one run, its end included, and how far they lie outward and inward of the curve."""
    densities = [Density(curve, float(a), float(b), polygon_density) for a, b in run.stretches]
    needed = sum(density.total for density in densities) / math.sqrt(tolerance)
    check_count(needed, "straight edges", tolerance)
    least = 3 if run.closed else 1
    count = max(least, math.ceil(needed - 1e-6))
    best = math.inf
    for _ in range(TRIES):
        nodes = _joined(densities, count)
        edges, load = _shared(curve, run, nodes, tolerance)
        if edges is None:
            count *= 2
            continue
        # the greatest sagitta, halved, is how far the vertices stand out
        shift = min(0.5 * load, tolerance)
        edges = _edges(curve, run, edges.nodes, shift, tolerance)
        top, bottom = float(edges.deviation.outside.max()), -float(edges.deviation.inside.min())
        if run.closed and math.isfinite(top + bottom) and bottom > 0.0 and abs(top - bottom) > BALANCED * tolerance:
            shift = min(shift * (top + bottom) / (2.0 * bottom), tolerance)
            edges = _edges(curve, run, edges.nodes, shift, tolerance)
        lateral = shift * edges.sine
        top = math.hypot(max(float(edges.deviation.outside.max()), 0.0), lateral)
        bottom = math.hypot(max(-float(edges.deviation.inside.min()), 0.0), lateral)
        reached = max(top, bottom)
        best = min(best, reached)
        if reached <= tolerance:
            return edges.vertices, bottom, top
        grown = math.ceil(count * math.sqrt(reached / tolerance)) if math.isfinite(reached) else 2 * count
        count = max(count + 1, min(grown, count + max(2, count // 50)) if reached < 1.2 * tolerance else grown)
    raise ToleranceError(f"a polygon within {tolerance:.3g} mm was not reached; the best was {best:.3g} mm", best)


def _joined(densities: list[Density], count: int) -> Array:
    """`count` equal shares of all stretches together; breaks are not made nodes."""
    fine = [density.grid() for density in densities]
    t = np.concatenate([fine[0][0], *(g[0][1:] for g in fine[1:])])
    base = np.cumsum([0.0, *(density.total for density in densities[:-1])])
    total = np.concatenate([fine[0][1], *(g[1][1:] + b for g, b in zip(fine[1:], base[1:], strict=True))])
    nodes: Array = np.interp(np.linspace(0.0, total[-1], count + 1), total, t)
    nodes[0], nodes[-1] = t[0], t[-1]
    return nodes


def _shared(curve: Curve, run: Run, nodes: Array, tolerance: float) -> tuple[_Edges | None, float]:
    """Nodes shared anew until the edges' sagittas are alike; the edges, and the greatest sagitta seen."""
    best: tuple[_Edges | None, float] = (None, math.inf)
    for turn in range(ROUNDS):
        edges = _edges(curve, run, nodes, tolerance, math.inf)
        seen = edges.deviation
        load = np.maximum(seen.seen_high, -seen.seen_low - 2.0 * tolerance) + tolerance
        top = float(load.max())
        if top < best[1]:
            best = (edges, top)
        if turn == ROUNDS - 1 or not math.isfinite(top) or top <= 1.002 * float(np.mean(load)):
            break
        nodes = reshared(nodes, load, 2.0)
    return best


def _edges(curve: Curve, run: Run, nodes: Array, shift: float, tolerance: float) -> _Edges:
    """Edges between nodes moved by `shift` to the convex side, and their deviation over each edge.

    An edge across a break of the curve is judged on both sides of it.
    """
    at = curve.sample(nodes)
    if run.closed:
        at.point[-1] = at.point[0]
    away = np.where(at.turn >= 0.0, shift, -shift)
    if run.closed:
        away[-1] = away[0]
    else:
        away[[0, -1]] = 0.0
    normal = at.normal
    if run.closed:
        normal[-1] = normal[0]
    vertices = at.point + away[:, None] * normal
    chord = np.diff(vertices, axis=0)
    tangent = chord / np.hypot(chord[:, 0], chord[:, 1])[:, None]
    sine = max(
        float(np.abs(np.sum(tangent * normal[:-1], axis=1)).max()),
        float(np.abs(np.sum(tangent * normal[1:], axis=1)).max()),
    )
    cuts = np.array([b for b in run.breaks if not np.any(nodes == b)])
    low = np.sort(np.concatenate([nodes[:-1], cuts]))
    high = np.append(low[1:], nodes[-1])
    edge = np.clip(np.searchsorted(nodes, low, side="right") - 1, 0, nodes.size - 2)
    chain = Chain(vertices[:-1][edge], tangent[edge], np.zeros(low.size), low, high)
    found = chain_deviation(curve, chain, tolerance, nodes=2 if math.isinf(tolerance) else 4)
    if cuts.size:
        first = np.searchsorted(edge, np.arange(nodes.size - 1))
        found = Deviation(
            np.minimum.reduceat(found.inside, first),
            np.maximum.reduceat(found.outside, first),
            np.minimum.reduceat(found.seen_low, first),
            np.maximum.reduceat(found.seen_high, first),
        )
    return _Edges(nodes, vertices, sine, found)
