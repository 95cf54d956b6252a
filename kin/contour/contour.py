"""A closed contour of lines, circular arcs and Bezier pieces, as read from a file: support function and measures.

Counter-clockwise, in mm. Nothing is assumed of its shape: the support function is the exact maximum over all points of
the contour, also of a dented or spoilt one.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs, cross, dot, unit
from kin.contour.hull import convex_hull, is_convex_polygon
from kin.contour.nearest import nearest
from kin.contour.pieces import ARC, BEZIER, LINE, NormalRanges, Pieces, wrapped
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, fields, replace

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

__all__ = ["ARC", "BEZIER", "LINE", "Box", "Contour", "Support"]

# Pairs of piece and angle that are worked on at a time, which bounds the memory a hostile contour can ask for.
PAIRS_AT_ONCE = 1_000_000
# Greatest distance at which arcs stand in for a spline where only arcs will do: mm, but no more and no less than these
# shares of the contour's extent.
ARC_TOLERANCE = 1e-9
MOST_SHARE = 2e-11
ARC_SHARE = 1e-12
# Of the extent: the distance within which the rough arcs stand for a spline; they only sort near places from far ones.
ROUGH_SHARE = 1e-4
# Factor by which the arcs at hand may be finer than a tolerance and still serve for it.
ALIKE = 4.0
# Rounding of a tangent's angle, in units of the machine's precision times extent over chord.
ANGLE_ROUNDING = 16.0
# Normals that are closer than this, radians, are one.
NORMAL_ROUNDING = 1e-12
# Directions, besides the pieces' own, between which a dented contour is searched for lines that touch it twice.
PROBES = 720
# Of an interval between two directions: the distance from its ends at which the contacts are compared.
INSET = 1e-6
# Halvings of the interval in which the farthest piece changes: more than a number has bits.
HALVINGS = 60


class Support(NamedTuple):
    """q (k,) = max over the contour of x.u(theta), mm, the point x (k, 2) that reaches it, and its piece (k,).

    u(theta) is the unit vector at the angle theta.
    """

    q: Array
    point: Array
    piece: Indices


class Box(NamedTuple):
    """Box with sides parallel to the axes: least and greatest x and y, mm."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float


@dataclass(frozen=True, eq=False)
class Contour(Pieces):
    """Pieces end to end, closed: end[i] is start[i+1], the last end the first start, within the reader's gap.

    A reader gives it counter-clockwise; every measure takes either sense, and only `is_convex` and the signs of `area`,
    `turning`, `turns` and `joints` depend on it. `arcs_within` is the greatest distance, mm, of the arcs that stand for
    splines by default; None for 1e-9 mm, but from 1e-12 to 2e-11 of the extent (the greatest coordinate).
    """

    arcs_within: float | None = None

    @staticmethod
    def from_pieces(pieces: Pieces) -> Contour:
        """Return the contour of `pieces`, which follow one another (checked where they are chained, not here)."""
        return Contour(**{f.name: getattr(pieces, f.name) for f in fields(pieces)})

    @staticmethod
    def from_vertices(vertices: Array) -> Contour:
        """Return the closed polygon through vertices (n, 2), mm."""
        return Contour.from_bulges(vertices, np.zeros(len(vertices)))

    @staticmethod
    def from_bulges(vertices: Array, bulges: Array) -> Contour:
        """Return lines and arcs from vertex to vertex (n, 2), mm, and back to the first, with bulges (n,).

        A bulge is tan(sweep/4) of the piece that starts at its vertex: 0 of a line, positive counter-clockwise.
        """
        start = np.asarray(vertices, dtype=np.float64)
        end = np.roll(start, -1, axis=0)
        return Contour.from_pieces(Pieces.from_chords(start, end, np.asarray(bulges, dtype=np.float64)))

    def reversed(self) -> Contour:
        """Return the same contour run through the other way."""
        return Contour.from_pieces(self.take(np.arange(len(self))[::-1]).turned_round())

    def mirrored(self) -> Contour:
        """Return the mirror image in the x axis, run through the other way so that its sense stays."""
        return Contour.from_pieces(self.reflected()).reversed()

    def scaled(self, factor: float) -> Contour:
        """Return the contour enlarged about the origin by a positive factor."""
        return Contour.from_pieces(self.enlarged(factor))

    def moved(self, x: float, y: float) -> Contour:
        """Return the contour moved by a distance along x and along y, mm."""
        return Contour.from_pieces(self.shifted(x, y))

    def turned(self, angle: float) -> Contour:
        """Return the contour turned counter-clockwise about the origin by an angle, rad."""
        return Contour.from_pieces(self.rotated(angle))

    @cached_property
    def vertices(self) -> Array:
        """Ends of all pieces in order: the starts (n, 2), or starts and ends by turns (2n, 2) if they do not meet."""
        if np.array_equal(self.end[:-1], self.start[1:]) and np.array_equal(self.end[-1:], self.start[:1]):
            return self.start
        return np.stack([self.start, self.end], axis=1).reshape(-1, 2)

    @cached_property
    def hull(self) -> Indices:
        """Corners of the convex hull of the `vertices`, counter-clockwise: indices (h,) into them."""
        if is_convex_polygon(self.vertices):
            return np.arange(len(self.vertices))
        return convex_hull(self.vertices)

    @cached_property
    def hull_edges(self) -> tuple[Array, Indices]:
        """Angles (h,) of the hull edges' normals, rising in [0, 2 pi), and the vertex (h,) that ends each edge."""
        corners = self.hull
        if corners.size < 2:
            return np.zeros(corners.size), corners
        following = np.roll(corners, -1)
        edge = self.vertices[following] - self.vertices[corners]
        normal = np.mod(np.arctan2(-edge[:, 0], edge[:, 1]), TURN)
        order = np.argsort(normal, kind="stable")
        return normal[order], following[order]

    def support(self, theta: Array) -> Support:
        """Support function at angles theta (k,), rad: exact over every point of the contour.

        The farthest vertex is found on the convex hull by bisection; each curved piece is tried at the angles within
        its own range of normals. Cost grows as n + k log n for a contour that goes round once.
        """
        theta = np.asarray(theta, dtype=np.float64).reshape(-1)
        u = unit(theta)
        reduced = np.mod(theta, TURN)
        normals, corners = self.hull_edges
        place = np.searchsorted(normals, reduced, side="right") - 1
        # Rounding of the normals can miss by a corner where edges are nearly in line.
        near = corners[(place[:, None] + np.array([0, -1, 1])) % corners.size]
        reach = np.einsum("kjc,kc->kj", self.vertices[near], u)
        best = reach.argmax(axis=1)
        rows = np.arange(theta.size)
        vertex = near[rows, best]
        support = Support(reach[rows, best], self.vertices[vertex], vertex * len(self) // len(self.vertices))
        ranges = self.normal_ranges
        if ranges.piece.size and theta.size:
            order = np.argsort(reduced, kind="stable")
            for tried, at in paired(ranges, reduced[order]):
                self._raise(support, ranges.piece[tried], order[at], reduced, u)
        return support

    def _raise(self, support: Support, tried: Indices, numbers: Indices, theta: Array, u: Array) -> None:
        """Write pieces `tried` into `support` where they reach farther, each at the angle with the index in `numbers`.

        theta (k,) in [0, 2 pi) and u (k, 2) are all angles of `support` and their unit vectors.
        """
        q, point, piece = support
        is_arc = self.kind[tried] == ARC
        arc, a = tried[is_arc], numbers[is_arc]
        half = (theta[a] - self.angle[arc]) / 2.0
        # From the start of the arc, not from its centre: nothing is lost where the centre is far away.
        value, share = np.empty(tried.size), np.zeros(tried.size)
        value[is_arc] = dot(self.start[arc], u[a]) + 2.0 * self.radius[arc] * np.sin(half) ** 2
        if not is_arc.all():
            bow, b = self.curve[tried[~is_arc]], numbers[~is_arc]
            share[~is_arc] = self.beziers.farthest(bow, theta[b])
            value[~is_arc] = dot(self.beziers.point(bow, share[~is_arc]), u[b])
        ahead = np.flatnonzero(value > q[numbers])
        np.maximum.at(q, numbers[ahead], value[ahead])
        won = ahead[value[ahead] == q[numbers[ahead]]]
        piece[numbers[won]] = tried[won]
        arc, bow = won[is_arc[won]], won[~is_arc[won]]
        point[numbers[arc]] = self.arc_points(tried[arc], theta[numbers[arc]] - self.angle[tried[arc]])
        if bow.size:
            point[numbers[bow]] = self.beziers.point(self.curve[tried[bow]], share[bow])

    @cached_property
    def normals(self) -> Array:
        """Angles (m,) in [0, 2 pi) at which the support function changes its form, rising.

        For a convex contour these are the normals at both ends of each piece. Else they are the normals of hull edges
        and of ends of curved pieces that are farthest there, and the normals of lines that touch the contour twice.
        Between two of them one corner, arc or Bezier piece is the farthest throughout; one that is farthest over less
        than half a degree, between two such lines, may be overlooked. Neighbours differ by more than rounding.
        """
        if self.is_convex:
            return apart(np.concatenate(self.directions) - np.pi / 2.0)
        normals, corners = self.hull_edges
        ranges = self.normal_ranges
        if not ranges.piece.size:
            return apart(normals)
        # The ends of a range belong to the ends of its piece, in an order that depends on the sense of turning.
        leftward = (self.turns[ranges.piece] >= 0.0)[:, None]
        first, last = self.start[ranges.piece], self.end[ranges.piece]
        low_end, high_end = np.where(leftward, first, last), np.where(leftward, last, first)
        point = np.concatenate([self.vertices[corners], low_end, high_end])
        theta = np.concatenate([normals, ranges.low, ranges.low + ranges.width])
        rounding = 64.0 * np.finfo(float).eps * float(np.abs(self.vertices).max())
        active = theta[dot(point, unit(theta)) >= self.support(theta).q - rounding]
        probes = apart(np.concatenate([theta, np.arange(PROBES) * (TURN / PROBES)]))
        return apart(np.concatenate([active, self._switches(probes)]))

    def _switches(self, theta: Array) -> Array:
        """Angles at which the farthest piece changes, unordered: between neighbours of theta (k,), and at theta itself.

        theta rises. Between two of its angles a change is found by bisection to the last bits.
        """
        width = np.diff(theta, append=theta[0] + TURN)
        wide = width > 4.0 * np.finfo(float).eps / INSET
        low, high = (theta + INSET * width)[wide], (theta + (1.0 - INSET) * width)[wide]
        piece, last = self.support(low).piece, self.support(high).piece
        # an arc whose end lies beside it, by a file's rounding, is not quite the farthest where the next one takes over
        at = theta[wide][piece != np.roll(last, 1)]
        leaps = piece != last
        low, high, piece = low[leaps], high[leaps], piece[leaps]
        for _ in range(HALVINGS):
            middle = (low + high) / 2.0
            same = self.support(middle).piece == piece
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        angles: Array = np.mod(np.concatenate([low, at]), TURN)
        return angles

    @cached_property
    def area(self) -> float:
        """Signed area, mm^2, positive if counter-clockwise: exact, for rational pieces to rounding (Green)."""
        v = self.vertices - self.vertices.mean(axis=0)
        polygon = float(np.sum(cross(v, np.roll(v, -1, axis=0)))) / 2.0
        arc = self.kind == ARC
        bows = float(np.sum(self.radius[arc] ** 2 * less_sine(self.sweep[arc]))) / 2.0
        return polygon + bows + self.beziers.area_over_chords()

    @cached_property
    def length(self) -> float:
        """Perimeter, mm."""
        return float(self.lengths.sum())

    @cached_property
    def box(self) -> Box:
        """Exact bounding box, mm, of whole arcs and Bezier pieces, not only of their ends."""
        point = self.support(np.array([0.0, 0.5, 1.0, 1.5]) * np.pi).point
        return Box(float(point[2, 0]), float(point[3, 1]), float(point[0, 0]), float(point[1, 1]))

    @cached_property
    def joints(self) -> Array:
        """Turn of the tangent (n,), rad in [-pi, pi), from the end of the piece before to the start of each piece."""
        first, last = self.directions
        return wrapped(first - np.roll(last, 1))

    @cached_property
    def turning(self) -> int:
        """Number of turns of the tangent: 1 for a simple counter-clockwise contour, -1 for a clockwise one."""
        return round(float(self.turns.sum() + self.joints.sum()) / TURN)

    @cached_property
    def is_convex(self) -> bool:
        """Whether the contour turns left throughout, and once, up to the rounding of the tangents' angles."""
        extent = float(np.abs(self.vertices).max())
        chord = np.hypot(*(self.end - self.start).T)
        share = np.divide(extent, chord, out=np.zeros(len(self)), where=chord > 0.0)
        noise = ANGLE_ROUNDING * np.finfo(float).eps * (TURN + share)
        left_pieces = bool((self.turns >= -noise).all())
        left_joints = bool((self.joints >= -noise - np.roll(noise, 1)).all())
        return left_pieces and left_joints and self.turning == 1

    def sample(self, per_piece: int) -> Array:
        """Points (n * per_piece, 2) in order, the starts among them, evenly by length or Bezier parameter."""
        piece = np.repeat(np.arange(len(self)), per_piece)
        share = np.tile(np.arange(per_piece) / per_piece, len(self))
        return self.points(piece, share)

    def as_arcs(self, tolerance: float | None = None) -> tuple[Arcs, Indices]:
        """Lines and arcs in order, each turning by at most half a turn, and the index of the piece of each (k,).

        Lines and arcs are exact. Bezier pieces are replaced by smooth chains of arcs, proved to lie within `tolerance`
        mm; by default within `spread`. Cost grows as tolerance^(-1/3). Raises ValueError for a tolerance below
        rounding.
        """
        # the arcs of the default are kept: they serve where they are not many more than the tolerance needs
        usual = self._arc_tolerance
        if tolerance is None or not self.beziers.count or usual <= tolerance <= ALIKE * usual:
            return self._usual_arcs
        return self._arcs_within(tolerance)

    @cached_property
    def rough(self) -> tuple[Arcs, float]:
        """Few lines and arcs in order, and their greatest distance from the contour, mm: 0 without Bezier pieces."""
        off = ROUGH_SHARE * float(np.abs(self.vertices).max()) if self.beziers.count else 0.0
        return self.as_arcs(off)[0], off

    def within(self, tolerance: float | None) -> Contour:
        """Return the contour with `arcs_within` set to `tolerance`, mm or None; itself without Bezier pieces."""
        return replace(self, arcs_within=tolerance) if self.beziers.count and tolerance != self.arcs_within else self

    @property
    def is_spline(self) -> bool:
        """Whether the contour consists of polynomial Bezier pieces alone, in the order of the rows of `beziers`."""
        every = np.array_equal(self.curve, np.arange(self.beziers.count))
        return every and not self.beziers.rational

    @property
    def spread(self) -> float:
        """Greatest distance, mm, from the splines of the arcs that stand for them by default; 0 without splines."""
        return self._arc_tolerance if self.beziers.count else 0.0

    @property
    def _arc_tolerance(self) -> float:
        """`arcs_within`, mm, or the distance that None stands for."""
        if self.arcs_within is not None:
            return self.arcs_within
        extent = float(np.abs(self.vertices).max())
        return max(ARC_SHARE * extent, min(ARC_TOLERANCE, MOST_SHARE * extent))

    @cached_property
    def _usual_arcs(self) -> tuple[Arcs, Indices]:
        return self._arcs_within(self._arc_tolerance) if self.beziers.count else self.plain

    @cached_property
    def plain(self) -> tuple[Arcs, Indices]:
        """Lines and arcs without Bezier pieces, in order, each of at most half a turn, and the piece of each (k,)."""
        first, _ = self.directions
        size = np.where(self.kind == ARC, self.radius, 1.0)
        curvature = np.where(self.kind == ARC, np.copysign(1.0, self.sweep) / size, 0.0)
        plain = np.flatnonzero(self.kind != BEZIER)
        lengths = np.hypot(*(self.end - self.start).T)
        lengths = np.where(self.kind == ARC, self.radius * np.abs(self.sweep), lengths)
        arcs = Arcs(self.start[plain], unit(first[plain]), curvature[plain], lengths[plain])
        arcs, part = arcs.cut(1 + (np.abs(self.sweep[plain]) > np.pi).astype(np.intp))
        return arcs, plain[part]

    def _arcs_within(self, tolerance: float) -> tuple[Arcs, Indices]:
        from kin.contour.biarc import arcs_along

        arcs, owner = self.plain
        bows, row = arcs_along(self.beziers, tolerance)
        piece_of_row = np.empty(self.beziers.count, dtype=np.intp)
        bow = np.flatnonzero(self.kind == BEZIER)
        piece_of_row[self.curve[bow]] = bow
        owner = np.concatenate([owner, piece_of_row[row]])
        order = np.argsort(owner, kind="stable")
        return arcs.joined(bows).take(order), owner[order]

    def distance(self, points: Array, tolerance: float | None = None) -> Array:
        """Unsigned distance of points (k, 2) from the contour, mm (k,).

        It is exact from lines and arcs, and within `tolerance`, mm, by default within `spread`, from Bezier pieces.
        Raises ValueError for a tolerance below rounding.
        """
        _, distance = nearest(self.as_arcs(tolerance)[0], np.asarray(points, dtype=np.float64))
        return distance


def apart(theta: Array) -> Array:
    """Return angles theta (k,), rad, brought to [0, 2 pi), rising; angles that only rounding parts are given once."""
    reduced = np.mod(theta, TURN)
    rising = np.sort(np.where(reduced < TURN, reduced, 0.0))
    return rising[np.diff(rising, prepend=-1.0) > NORMAL_ROUNDING]


def less_sine(x: Array) -> Array:
    """Return x - sin x (n,), to full relative precision for small x too."""
    x2 = x * x
    series = x * x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0))))
    return np.where(np.abs(x) < 0.25, series, x - np.sin(x))


def paired(ranges: NormalRanges, theta: Array) -> list[tuple[Indices, Indices]]:
    """All pairs of a range and an angle within it, as batches of indices of ranges and of angles.

    theta (k,), rad, rises in [0, 2 pi).
    """
    ring = np.concatenate([theta, theta + TURN])
    first = np.searchsorted(ring, ranges.low, side="left")
    count = np.minimum(np.searchsorted(ring, ranges.low + ranges.width, side="right") - first, theta.size)
    # ranges in batches of so many pairs
    used = np.flatnonzero(count > 0)
    total = np.cumsum(count[used])
    batches = []
    begin = 0
    while begin < used.size:
        done = total[begin - 1] if begin else 0
        stop = max(begin + 1, int(np.searchsorted(total, done + PAIRS_AT_ONCE, side="right")))
        chosen = used[begin:stop]
        rows = np.repeat(chosen, count[chosen])
        offset = np.arange(rows.size) - np.repeat(total[begin:stop] - count[chosen] - done, count[chosen])
        batches.append((rows, (first[rows] + offset) % theta.size))
        begin = stop
    return batches
