"""A flat region ready to be measured against another: short pieces in its own axes, normals, corners, a point inside.

Distances between lines and arcs are exact. The distance from a point to a region is signed, negative inside.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs, dot, left, nearest_on, radial, right, turned
from kin.contour.intersections import common_points
from kin.contour.nearest import nearest
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array, Indices

SPLINE_TOLERANCE = 1e-5  # mm, at which arcs stand in for a spline
MOST_TURN = 0.25  # rad, greatest turn of a piece
PARTS = 8  # a piece is no longer than the region's extent over this
SMOOTH = 0.02  # rad; a joint that turns by less is no corner but widens the normals of both its pieces
STRAIGHT = 1e6  # times a piece's length: a radius from which on its centre is of no use
GRID = 24  # points along each side of the grid on which a point inside is looked for
# Of a region's extent: from what its width may be where the grid misses it down to the rounding of its coordinates.
HALVINGS = (5, 40)


@dataclass(frozen=True, eq=False)
class Region:
    """The inside of an outer contour less its holes, as n features: pieces, then corners, then a point inside.

    arcs        the features (n): material on the left of pieces; corners and the point are pieces without length
    boundary    number of features that lie on the boundary: all but the last
    pieces      number of features that are pieces
    middle      (n, 2), and `reach` (n,) half the length: the feature lies within `reach` of its middle
    normal      (n, 2) outward unit normal at the middle, and `fan` (n,) by how far, rad, other normals differ from it
    centre      (n, 2), and `off` (n,): every line along a normal passes within `off` mm of it; inf without a centre
    widened     (pieces,) the part of a piece's `fan`, rad, that is the turn of a smooth joint at one of its ends
    at_start    (n, 2) sum of the outward normals on both sides of the start, and `at_end` of the end
    """

    arcs: Arcs
    boundary: int
    pieces: int
    middle: Array
    reach: Array
    normal: Array
    fan: Array
    centre: Array
    off: Array
    widened: Array
    at_start: Array
    at_end: Array

    @staticmethod
    def of(outer: Contour, holes: Sequence[Contour] = ()) -> Region:
        """Return the region inside `outer` and outside the holes; the sense of each contour does not matter."""
        chains = [_chain(outer, outward=True), *(_chain(hole, outward=False) for hole in holes)]
        box = outer.vertices.max(axis=0) - outer.vertices.min(axis=0)
        longest = float(np.hypot(box[0], box[1])) / PARTS
        fine = [_cut(chain, longest) for chain in chains]
        turns = np.concatenate([chain.turns() for chain in fine])
        ends = np.concatenate([np.roll(chain.turns(), -1) for chain in fine])
        before = np.concatenate([right(np.roll(chain.end_tangents, 1, axis=0)) for chain in fine])
        after = np.concatenate([right(np.roll(chain.tangent, -1, axis=0)) for chain in fine])
        arcs = fine[0]
        for chain in fine[1:]:
            arcs = arcs.joined(chain)
        at_start, at_end = before + right(arcs.tangent), right(arcs.end_tangents) + after
        widened = np.maximum(*(np.where(np.abs(t) <= SMOOTH, np.abs(t), 0.0) for t in (turns, ends)))
        corner = np.flatnonzero(np.abs(turns) > SMOOTH)
        rim = _region(arcs, widened, _Points(arcs.start[corner], at_start[corner]), at_start, at_end)
        inside = _Points(
            np.vstack([arcs.start[corner], rim.inner_point]), np.vstack([at_start[corner], np.zeros((1, 2))])
        )
        return replace(_region(arcs, widened, inside, at_start, at_end), boundary=rim.boundary)

    @cached_property
    def finer(self) -> Region:
        """The region with each piece k cut into two of half its length, 2 k and 2 k + 1."""
        n = self.pieces
        fine, _ = self.chain.cut(np.full(n, 2))
        straight, widened = right(fine.tangent), np.repeat(self.widened, 2)
        # the joint between both halves is smooth
        middle = 2.0 * straight[1::2]
        at_start = np.stack([self.at_start[:n], middle], axis=1).reshape(-1, 2)
        at_end = np.stack([middle, self.at_end[:n]], axis=1).reshape(-1, 2)
        dots = np.arange(n, len(self.reach))
        points = _Points(self.middle[dots], self.at_start[dots])
        return replace(_region(fine, widened, points, at_start, at_end), boundary=self.boundary + n)

    @cached_property
    def chain(self) -> Arcs:
        """Pieces of the boundary in order, without its corners and the point inside."""
        return self.arcs.take(np.arange(self.pieces))

    @cached_property
    def inner_point(self) -> Array:
        """A point (2,) inside the region: the deepest of a grid of 24 by 24 over it.

        In a region so thin that the grid misses it, it is the deepest of the points that lie 1/32 of the region's
        extent, 1/64 and so on inwards of pieces' middles: at about a quarter of the region's width there, or deeper.
        """
        low, high = self.chain.start.min(axis=0), self.chain.start.max(axis=0)
        share = (np.arange(GRID) + 0.5) / GRID
        x, y = np.meshgrid(*(low[k] + share * (high[k] - low[k]) for k in (0, 1)))
        points = np.column_stack([x.ravel(), y.ravel()])
        depth = self.signed(points)
        if not float(depth.min()) < 0.0:
            some = np.unique(np.linspace(0, self.pieces - 1, GRID * GRID).astype(np.intp))
            inwards = float((high - low).max()) * 0.5 ** np.arange(*HALVINGS)
            points = (self.middle[some] - inwards[:, None, None] * self.normal[some]).reshape(-1, 2)
            depth = self.signed(points)
        point: Array = points[int(np.argmin(depth))]
        return point

    @cached_property
    def disc(self) -> tuple[Array, float]:
        """Centre (2,) and radius, mm, of a disc that holds the region."""
        low, high = self.chain.start.min(axis=0), self.chain.start.max(axis=0)
        centre: Array = 0.5 * (low + high)
        gap = self.middle - centre
        return centre, float((np.hypot(gap[:, 0], gap[:, 1]) + self.reach).max())

    def signed(self, points: Array) -> Array:
        """Distance of points (m, 2) from the region, negative inside: (m,)."""
        return self.nearest(points)[1]

    def nearest(self, points: Array) -> tuple[Indices, Array]:
        """Return the index of the piece nearest to each point (m, 2), and the distance, negative inside: (m,) each."""
        piece, distance = nearest(self.chain, points)
        return piece, np.copysign(distance, self.side(piece, points))

    def no_deeper(self, arcs: Arcs, piece: Indices) -> Array:
        """Lower bounds (k,) of the signed distance from the region over all points of `arcs` (k).

        Each is had from one `piece` (k,) of the boundary: no point is deeper than it is far from that piece. Along a
        straight line the distance from a straight piece is greatest at an end; an arc is off its chord by no more than
        its length squared times an eighth of its curvature.
        """
        own = self.arcs.take(piece)
        first, away = nearest_on(own, arcs.start)
        last, away_last = nearest_on(own, arcs.ends)
        bow = np.abs(own.curvature) * (last - first) ** 2 + np.abs(arcs.curvature) * arcs.length**2
        bound: Array = -np.maximum(away, away_last) - 0.125 * bow
        return bound

    def side(self, feature: Indices, points: Array) -> Array:
        """Signs of points (m, 2) as numbers (m,), by the feature (m,) nearest to each: positive outside the region.

        Their size has no meaning. At a corner the sum of the normals of both pieces that meet there decides.
        """
        arcs = self.arcs.take(feature)
        s, _ = nearest_on(arcs, points)
        side = radial(arcs, points)
        first, last = s <= 0.0, s >= arcs.length
        side = np.where(last, dot(points - arcs.ends, self.at_end[feature]), side)
        return np.where(first, dot(points - arcs.start, self.at_start[feature]), side)


def _chain(contour: Contour, *, outward: bool) -> Arcs:
    ordered = contour if (contour.area > 0.0) == outward else contour.reversed()
    arcs, _ = ordered.as_arcs(SPLINE_TOLERANCE if contour.beziers.count else None)
    return arcs.take(arcs.length > 0.0)


def _cut(chain: Arcs, longest: float) -> Arcs:
    parts = np.maximum(chain.length / longest, np.abs(chain.curvature) * chain.length / MOST_TURN)
    fine, _ = chain.cut(np.maximum(np.ceil(parts), 1.0).astype(np.intp))
    return fine


class _Points(NamedTuple):
    """Features without length (m, 2), and the sum of the outward normals there (m, 2)."""

    place: Array
    normal: Array


def _region(arcs: Arcs, widened: Array, points: _Points, at_start: Array, at_end: Array) -> Region:
    """Region of pieces `arcs` (n), whose smooth joints widen their normals by `widened` (n,), rad, and of points."""
    m, n = len(points.place), len(arcs)
    dots = Arcs(points.place, np.tile([1.0, 0.0], (m, 1)), np.zeros(m), np.zeros(m))
    k, length = arcs.curvature, arcs.length
    round_ = np.abs(k) * STRAIGHT * length > 1.0
    radius = np.where(round_, 1.0 / np.where(round_, k, 1.0), 0.0)
    away = np.where(round_, np.abs(radius) * np.sin(widened), np.inf)
    return Region(
        arcs=arcs.joined(dots),
        boundary=n + m,
        pieces=n,
        middle=np.vstack([arcs.points(0.5 * length), points.place]),
        reach=np.concatenate([0.5 * length, np.zeros(m)]),
        normal=np.vstack([right(arcs.tangents(0.5 * length)), np.tile([1.0, 0.0], (m, 1))]),
        fan=np.concatenate([0.5 * np.abs(k) * length + widened, np.full(m, np.pi)]),
        centre=np.vstack([arcs.start + radius[:, None] * left(arcs.tangent), points.place]),
        off=np.concatenate([away, np.zeros(m)]),
        widened=widened,
        at_start=np.vstack([at_start, points.normal]),
        at_end=np.vstack([at_end, points.normal]),
    )


class Gaps(NamedTuple):
    """Distance (k,) of pairs of pieces, 0 where they meet, and the nearest points (k, 2) on each."""

    distance: Array
    first: Array
    second: Array


def gaps(first: Arcs, second: Arcs) -> Gaps:
    """Distances of pieces of `first` from those of `second`, pair by pair, none of more than half a turn; exact.

    Unless they cross, the least distance is at an end of one piece, or along a common normal: through the centre of the
    more curved piece and square to the other.
    """
    ends, feet = _ends(first, second)
    bent = np.flatnonzero((first.curvature != 0.0) | (second.curvature != 0.0))
    swapped = np.abs(first.curvature[bent]) < np.abs(second.curvature[bent])
    inner, outer = first.take(bent), second.take(bent)
    inner, outer = _chosen(swapped, outer, inner), _chosen(swapped, inner, outer)
    from_foot, foot = _along_normal(inner, outer)
    opposite = outer.points(nearest_on(outer, foot)[0])
    nearer = from_foot < ends.distance[bent]
    at, swapped = bent[nearer], swapped[nearer, None]
    ends.distance[at] = from_foot[nearer]
    ends.first[at] = np.where(swapped, opposite[nearer], foot[nearer])
    ends.second[at] = np.where(swapped, foot[nearer], opposite[nearer])
    # pieces whose discs overlap may cross
    gap = first.points(0.5 * first.length) - second.points(0.5 * second.length)
    close = np.flatnonzero((ends.distance > 0.0) & (np.hypot(gap[:, 0], gap[:, 1]) <= feet))
    if len(close):
        shared = common_points(first.take(close), second.take(close), *(np.arange(len(close)),) * 2)
        at = close[shared.pair]
        ends.distance[at] = 0.0
        ends.first[at] = ends.second[at] = shared.point
    return ends


def _ends(first: Arcs, second: Arcs) -> tuple[Gaps, Array]:
    """Least distance from an end of either piece to the other, and half the length of both together (k,)."""
    n = len(first)
    best = Gaps(np.full(n, np.inf), np.empty((n, 2)), np.empty((n, 2)))
    for end, target, own in (
        (first.start, second, True),
        (first.ends, second, True),
        (second.start, first, False),
        (second.ends, first, False),
    ):
        s, distance = nearest_on(target, end)
        nearer = distance < best.distance
        foot = target.take(nearer).points(s[nearer])
        best.distance[nearer] = distance[nearer]
        best.first[nearer] = end[nearer] if own else foot
        best.second[nearer] = foot if own else end[nearer]
    return best, 0.5 * (first.length + second.length)


def _along_normal(inner: Arcs, outer: Arcs) -> tuple[Array, Array]:
    """Distance from `outer` of the point of each `inner` arc on the normal of `outer` through its centre; the point."""
    k = inner.curvature
    centre = inner.start + left(inner.tangent) / k[:, None]
    # towards the centre of `outer`, times its curvature: a line needs no case of its own
    towards = outer.curvature[:, None] * (outer.start - centre) - right(outer.tangent)
    size = np.hypot(towards[:, 0], towards[:, 1])
    middle = inner.points(0.5 * inner.length) - centre
    with np.errstate(divide="ignore", invalid="ignore"):
        sign = np.where(dot(towards, middle) < 0.0, -1.0, 1.0) / (size * np.abs(k))
    aim = centre + np.where(size > 0.0, sign, 0.0)[:, None] * towards
    foot = inner.points(nearest_on(inner, aim)[0])
    return nearest_on(outer, foot)[1], foot


def _chosen(condition: NDArray[np.bool_], pieces: Arcs, other: Arcs) -> Arcs:
    wide = condition[:, None]
    return Arcs(
        np.where(wide, pieces.start, other.start),
        np.where(wide, pieces.tangent, other.tangent),
        np.where(condition, pieces.curvature, other.curvature),
        np.where(condition, pieces.length, other.length),
    )


def farthest(arcs: Arcs, point: Array) -> Array:
    """Greatest distance (n,) of each piece from a point (n, 2); exact for pieces of less than half a turn."""
    ends = np.maximum(np.hypot(*(arcs.start - point).T), np.hypot(*(arcs.ends - point).T))
    k = arcs.curvature
    bent = np.flatnonzero(k != 0.0)
    inner = arcs.take(bent)
    centre = inner.start + left(inner.tangent) / inner.curvature[:, None]
    gap = centre - point[bent]
    size = np.hypot(gap[:, 0], gap[:, 1])
    aim = centre + gap * (1.0 / (np.abs(inner.curvature) * np.where(size > 0.0, size, 1.0)))[:, None]
    foot = inner.points(nearest_on(inner, aim)[0])
    reach: Array = ends.copy()
    reach[bent] = np.maximum(ends[bent], np.hypot(*(foot - point[bent]).T))
    return reach


def moved(arcs: Arcs, place: Array, angle: Array) -> Arcs:
    """Pieces turned by angles (n,) about the origin and then moved by `place` (n, 2)."""
    return Arcs(turned(arcs.start, angle) + place, turned(arcs.tangent, angle), arcs.curvature, arcs.length)
