"""Straight edges along a curve: their vertices, the curve's height over them as sampled, and as proved."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curve import columns
from camgeo.fit.deviation import Chain, Deviation, chain_deviation
from kin.numeric.distinct import distinct
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve, Frame, SmoothRun
    from kin.numeric.arrays import Array

EVEN = 0.02  # relative change of curvature over an edge up to which one sample in the middle is enough
LOOKS = (1.0 / 6.0, 1.0 / 3.0, 2.0 / 3.0, 5.0 / 6.0)  # places of further samples on an edge


@dataclass(frozen=True)
class PlacedEdges:
    """Edges of one run between nodes (n + 1,), vertices (n + 1, 2) `away` (n + 1,) outside the curve on its normals.

    `tangent` (n, 2) is an edge's unit direction; `behind` and `beyond` (n,) are how far the feet of its first and its
    last node lie within the edge, mm, below 0 beyond its ends. `lean` (n, 2) is the speed of each end's vertex towards
    the edge's outer side as its node moves, mm per unit of the parameter. Pieces, which no break interrupts, run from
    `low` to `high` (m,) and belong to edge number `edge` (m,).
    """

    nodes: Array
    vertices: Array
    away: Array
    tangent: Array
    behind: Array
    beyond: Array
    lean: Array
    low: Array
    high: Array
    edge: NDArray[np.intp]


@dataclass(frozen=True)
class Sagittas:
    """Sampled sagitta of each edge over its vertices (n,), mm, and its derivatives by its two nodes' parameters."""

    load: Array
    by_low: Array
    by_high: Array


@dataclass(frozen=True)
class ProvedEdges:
    """Edges with their proved deviation.

    `outward` and `inward` are the greatest distances of vertices from their nodes, mm. `overhang`, mm, bounds how far
    the feet of the curve's points lie beyond the ends of their edge. `heights` (n,) is the greater deviation of each
    edge to either side, mm.
    """

    vertices: Array
    outward: float
    inward: float
    overhang: float
    deviation: Deviation
    heights: Array

    @property
    def extremes(self) -> tuple[float, float]:
        """Proved greatest distances, outward and inward, mm, between edges and curve, from either to the other.

        `deviation` bounds the distance of a curve's point whose foot lies on its edge, and of an edge's point between
        the feet of its nodes. The rest of an edge lies between a node's foot and its vertex, and is no farther from the
        node than the farther of the two. A foot beyond the edge's end is up to `overhang` from the end.
        """
        outward = max(self.outward, math.hypot(-min(float(self.deviation.inside.min()), 0.0), self.overhang))
        inward = max(self.inward, math.hypot(max(float(self.deviation.outside.max()), 0.0), self.overhang))
        return outward, inward


def node_frames(curve: Curve, run: SmoothRun, nodes: Array) -> Frame:
    """Frames at the nodes (n + 1,) of a run; the last frame of a closed run is the first frame again."""
    if not run.closed:
        return curve.sample(nodes, np.where(np.arange(nodes.size) < nodes.size - 1, 1, -1))
    frame = curve.sample(nodes[:-1])
    return frame.joined(frame.split(1)[0])


def place_edges(frame: Frame, run: SmoothRun, nodes: Array, away: Array) -> PlacedEdges:
    """Edges between vertices that stand `away` (n + 1,), mm, outside the curve on its normals at the nodes of a run.

    `away` is set to 0 where it points to the hollow side of the curve, and at both ends of an open run.
    """
    # in a slight hollow without edges across its inflections a vertex that stands off would add to the deviation
    away = np.where(away * frame.turn < 0.0, 0.0, away)
    away[-1] = away[0]
    if not run.closed:
        away[[0, -1]] = 0.0
    # a vertex moves with its node along the tangent, at the speed of the parallel curve
    normal, heading = frame.normal, frame.tangent
    pace = frame.speed + away * frame.turn
    vertices = frame.point + away[:, None] * normal
    chord = np.diff(vertices, axis=0)
    tangent = chord / np.hypot(chord[:, 0], chord[:, 1])[:, None]
    across = columns(tangent[:, 1], -tangent[:, 0])
    lean = columns(pace[:-1] * np.sum(heading[:-1] * across, axis=1), pace[1:] * np.sum(heading[1:] * across, axis=1))
    # nodes of a closed run may begin and end later than the run: pieces beyond its end are moved back by the period
    span = run.high - run.low
    breaks = np.array(run.breaks)
    cuts = breaks if nodes[-1] <= run.high else np.concatenate([breaks, [run.high], breaks + span])
    cuts = distinct(cuts[(cuts > nodes[0]) & (cuts < nodes[-1])])
    cuts = cuts[nodes[np.searchsorted(nodes, cuts)] != cuts]
    low = np.sort(np.concatenate([nodes[:-1], cuts]))
    high = np.append(low[1:], nodes[-1])
    edge = np.clip(np.searchsorted(nodes, low, side="right") - 1, 0, nodes.size - 2)
    late = low >= run.high
    low, high = np.where(late, np.maximum(low - span, run.low), low), np.where(late, high - span, high)
    behind = -away[:-1] * np.sum(tangent * normal[:-1], axis=1)
    beyond = away[1:] * np.sum(tangent * normal[1:], axis=1)
    return PlacedEdges(nodes, vertices, away, tangent, behind, beyond, lean, low, high, edge)


def sagittas(curve: Curve, edges: PlacedEdges, sides: Array, tolerance: float) -> Sagittas:
    """Sampled height of the curve over each edge, plus `tolerance`, mm, with derivatives by the edge's two nodes.

    They are not proved. `sides` (n + 1,) is 1 or -1 for the side on which a vertex stands off by `tolerance`. For an
    edge across an inflection, whose ends stand on different sides, both sides count. Derivatives are taken where the
    curve is highest over the edge (envelope theorem).
    """
    count = edges.nodes.size - 1
    width = edges.high - edges.low
    frame = curve.sample(edges.low + 0.5 * width)
    # one sample is enough where the curve is nearly a circle over the edge
    with np.errstate(divide="ignore", invalid="ignore"):
        change = width * (np.abs(frame.speed_slope / frame.speed) + np.abs(frame.turn_slope / frame.turn))
    uneven = np.flatnonzero(~(change < EVEN))
    piece, reach = np.arange(width.size), 0.5 * width
    if uneven.size:
        piece = np.append(piece, np.repeat(uneven, len(LOOKS)))
        t = edges.low[uneven, None] + width[uneven, None] * np.array(LOOKS)
        frame = frame.joined(curve.sample(t.ravel()))
        reach[uneven] /= len(LOOKS) + 1
        reach = reach[piece]
    edge = edges.edge[piece]
    sense = sides[:-1][edge]
    along = edges.tangent[edge]
    offset = frame.point - edges.vertices[:-1][edge]
    height = sense * (offset[:, 0] * along[:, 1] - offset[:, 1] * along[:, 0])
    slope = sense * (frame.tangent[:, 0] * along[:, 1] - frame.tangent[:, 1] * along[:, 0])
    # from each place to the top of the parabola there, but at most half way to the next place
    across = (sides[:-1] != sides[1:])[edge]
    bend = sense * frame.turn
    with np.errstate(divide="ignore", invalid="ignore"):
        move = np.where(across | (bend > 0.0), slope / bend, np.sign(slope) * np.inf)
    move = np.clip(np.where(np.isnan(move), 0.0, move), -reach, reach)
    top = height + frame.speed * (slope * move - 0.5 * bend * move**2)
    low = np.where(across | (top < -tolerance * (1.0 + 1e-9)), -top, -tolerance)
    load = np.maximum(top, low) + tolerance
    share = np.sum(offset * along, axis=1) + frame.speed * move
    chord = np.hypot(*(edges.vertices[1:] - edges.vertices[:-1]).T)
    # the highest sample of each edge, and its place along the edge
    order = np.lexsort((load, edge))
    last = np.searchsorted(edge[order], np.arange(count), side="right") - 1
    best = order[last]
    u = np.clip(share[best] / chord, 0.0, 1.0)
    side = sides[:-1]
    return Sagittas(load[best], -side * (1.0 - u) * edges.lean[:, 0], -side * u * edges.lean[:, 1])


def prove_edges(curve: Curve, edges: PlacedEdges, tolerance: float) -> ProvedEdges:
    """Edges with their proved deviation, its bounds sharp to a share of the `tolerance`, mm, as in `chain_deviation`.

    Of up to `deviation.FEW` pieces, bounds that alone exceed the tolerance are sharpened further.
    An edge across a break of the curve is proved on both sides of the break.
    """
    chain = Chain(
        edges.vertices[:-1][edges.edge], edges.tangent[edges.edge], np.zeros(edges.low.size), edges.low, edges.high
    )
    deviation = chain_deviation(curve, chain, tolerance, decide=True)
    overhang = -min(0.0, float(edges.behind.min()), float(edges.beyond.min()))
    outward, inward = max(0.0, float(edges.away.max())), max(0.0, -float(edges.away.min()))
    heights = np.zeros(edges.nodes.size - 1)
    np.maximum.at(heights, edges.edge, deviation.worst)
    return ProvedEdges(edges.vertices, outward, inward, overhang, deviation, heights)
