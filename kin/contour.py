"""A closed contour of lines, circular arcs and Bezier pieces, as read from a file: support function, area, length.

Counter-clockwise, in mm, as structure of arrays. Nothing is assumed of its shape: the support function is the exact
maximum over all points of the contour, also of a dented or spoilt one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kin.arcs import Arcs, Array, Indices, cross, dot, unit
from kin.bezier import Beziers
from kin.hull import convex_hull, is_convex_polygon

__all__ = ["ARC", "BEZIER", "LINE", "Box", "Contour", "NormalRanges", "Support"]

LINE, ARC, BEZIER = 0, 1, 2

TURN = 2.0 * np.pi
# A bulge below this bends its chord by less than the rounding of the chord's own length.
STRAIGHT_BULGE = 1e-18
# Pairs of piece and angle that are worked on at a time, which bounds the memory a hostile contour can ask for.
PAIRS_AT_ONCE = 1_000_000


class Support(NamedTuple):
    """q (k,) = max over the contour of x.u(theta), the point (k, 2) and the piece (k,) that reach it."""

    q: Array
    point: Array
    piece: Indices


class Box(NamedTuple):
    """Least and greatest coordinates, mm."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float


class NormalRanges(NamedTuple):
    """The curved pieces (their indices, (c,)) and where each one can be farthest: normals from `low` over `width`, (c,).

    `low` in [0, 2 pi). Each normal in the range belongs to one point of the piece, the farthest of its own circle or bow.
    """

    piece: Indices
    low: Array
    width: Array


@dataclass(frozen=True, eq=False)
class Contour:
    """n pieces end to end; piece i runs from start[i] to end[i], and end[i] is start[i+1] within the reader's gap.

    kind (n,)       LINE, ARC or BEZIER
    start, end      (n, 2) mm
    centre          (n, 2) mm, radius (n,) mm, angle (n,) polar angle of the start seen from the centre, sweep (n,)
                    signed, |sweep| <= 2 pi: of the arcs; zero elsewhere
    curve (n,)      row of a Bezier piece in `beziers`; -1 elsewhere
    beziers         the Bezier pieces, each turning one way by less than pi
    """

    kind: NDArray[np.uint8]
    start: Array
    end: Array
    centre: Array
    radius: Array
    angle: Array
    sweep: Array
    curve: Indices
    beziers: Beziers

    @staticmethod
    def from_vertices(vertices: Array) -> Contour:
        """The closed polygon through vertices (n, 2)."""
        return Contour.from_bulges(vertices, np.zeros(vertices.shape[0]))

    @staticmethod
    def from_bulges(vertices: Array, bulges: Array) -> Contour:
        """Lines and arcs between vertices (n, 2) in turn and back to the first; bulge (n,) = tan(sweep/4) of what follows."""
        start = np.asarray(vertices, dtype=np.float64)
        return Contour.from_chords(start, np.roll(start, -1, axis=0), np.asarray(bulges, dtype=np.float64))

    @staticmethod
    def from_chords(start: Array, end: Array, bulge: Array) -> Contour:
        """Lines and arcs from start (n, 2) to end (n, 2) with bulges (n,)."""
        n = start.shape[0]
        arc = np.abs(bulge) > STRAIGHT_BULGE
        b = np.where(arc, bulge, 1.0)
        chord = end - start
        length = np.hypot(chord[:, 0], chord[:, 1])
        across = np.stack([-chord[:, 1], chord[:, 0]], axis=1)
        centre = (start + end) / 2.0 + across * ((1.0 - b * b) / (4.0 * b))[:, None]
        sweep = 4.0 * np.arctan(bulge)
        angle = np.arctan2(chord[:, 1], chord[:, 0]) - sweep / 2.0 - np.copysign(np.pi / 2.0, bulge)
        return Contour(
            kind=np.where(arc, ARC, LINE).astype(np.uint8),
            start=start,
            end=end,
            centre=np.where(arc[:, None], centre, 0.0),
            radius=np.where(arc, length * (1.0 + b * b) / (4.0 * np.abs(b)), 0.0),
            angle=np.where(arc, angle, 0.0),
            sweep=np.where(arc, sweep, 0.0),
            curve=np.full(n, -1, dtype=np.intp),
            beziers=Beziers.empty(),
        )

    def __len__(self) -> int:
        return self.kind.shape[0]

    @cached_property
    def vertices(self) -> Array:
        """Ends of all pieces in order: the starts (n, 2), or starts and ends alternating (2n, 2) where ends do not meet."""
        if np.array_equal(self.end[:-1], self.start[1:]) and np.array_equal(self.end[-1:], self.start[:1]):
            return self.start
        return np.stack([self.start, self.end], axis=1).reshape(-1, 2)

    @cached_property
    def hull(self) -> Indices:
        """Corners of the convex hull of the `vertices`, counter-clockwise: indices (h,) into them."""
        if is_convex_polygon(self.vertices):
            return np.arange(self.vertices.shape[0])
        return convex_hull(self.vertices)

    @cached_property
    def hull_edges(self) -> tuple[Array, Indices]:
        """Normals (h,) of the hull's edges, rising in [0, 2 pi), and the vertex (h,) at the end of each edge."""
        corners = self.hull
        if corners.size < 2:
            return np.zeros(corners.size), corners
        following = np.roll(corners, -1)
        edge = self.vertices[following] - self.vertices[corners]
        normal = np.mod(np.arctan2(-edge[:, 0], edge[:, 1]), TURN)
        order = np.argsort(normal, kind="stable")
        return normal[order], following[order]

    @cached_property
    def normal_ranges(self) -> NormalRanges:
        """The normals at which each curved piece can be the farthest."""
        arcs = np.flatnonzero(self.kind == ARC)
        sweep = self.sweep[arcs]
        low = self.angle[arcs] + np.minimum(sweep, 0.0)
        piece, width = arcs, np.abs(sweep)
        if self.beziers.count:
            curved = np.flatnonzero(self.kind == BEZIER)
            first, last = (a[self.curve[curved]] for a in self.beziers.directions)
            turn = np.mod(last - first + np.pi, TURN) - np.pi
            # Turning left the outward normal lies right of the tangent; turning right, the bow bulges to the left.
            low = np.concatenate([low, np.where(turn >= 0.0, first - np.pi / 2.0, last + np.pi / 2.0)])
            piece = np.concatenate([piece, curved])
            width = np.concatenate([width, np.abs(turn)])
        return NormalRanges(piece, np.mod(low, TURN), width)

    def support(self, theta: Array) -> Support:
        """The support function at angles theta (k,): q, contact point and piece, exact over every point of the contour.

        Among vertices the farthest is found on their convex hull by bisection; each curved piece is tried at the angles
        within its own range of normals. Cost grows as n + k log n for a contour that goes round once.
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
        q, point = reach[rows, best], self.vertices[vertex]
        piece = vertex if self.vertices.shape[0] == len(self) else vertex // 2
        ranges = self.normal_ranges
        if ranges.piece.size and theta.size:
            order = np.argsort(reduced, kind="stable")
            for tried, at in paired(ranges, reduced[order]):
                self.raise_support(q, point, piece, ranges.piece[tried], order[at], reduced, u)
        return Support(q, point, piece)

    def raise_support(self, q: Array, point: Array, piece: Indices, tried: Indices, at: Indices, theta: Array, u: Array) -> None:
        """Let pieces `tried` compete at angles number `at`, and write where they reach farther into q, point, piece."""
        is_arc = self.kind[tried] == ARC
        arc, a = tried[is_arc], at[is_arc]
        half = (theta[a] - self.angle[arc]) / 2.0
        # From the start of the arc, not from its centre: nothing is lost where the centre is far away.
        value = np.empty(tried.size)
        value[is_arc] = dot(self.start[arc], u[a]) + 2.0 * self.radius[arc] * np.sin(half) ** 2
        t = np.zeros(tried.size)
        if not is_arc.all():
            bow, b = self.curve[tried[~is_arc]], at[~is_arc]
            t[~is_arc] = self.beziers.farthest(bow, theta[b])
            value[~is_arc] = dot(self.beziers.point(bow, t[~is_arc]), u[b])
        ahead = value > q[at]
        np.maximum.at(q, at[ahead], value[ahead])
        won = np.flatnonzero(ahead)
        won = won[value[won] == q[at[won]]]
        piece[at[won]] = tried[won]
        arc, a = won[is_arc[won]], at[won[is_arc[won]]]
        point[a] = self.arc_points(tried[arc], theta[a] - self.angle[tried[arc]])
        bow = won[~is_arc[won]]
        if bow.size:
            point[at[bow]] = self.beziers.point(self.curve[tried[bow]], t[bow])

    def arc_points(self, pieces: Indices, turn: Array) -> Array:
        """Points (k, 2) of arcs, `turn` (k,) radians on from their starts, counter-clockwise positive."""
        half = turn / 2.0
        middle = self.angle[pieces] + half
        along = np.stack([-np.sin(middle), np.cos(middle)], axis=1)
        return self.start[pieces] + (2.0 * self.radius[pieces] * np.sin(half))[:, None] * along

    @cached_property
    def area(self) -> float:
        """Signed area, mm^2: Green's theorem, closed forms on lines, arcs and polynomial pieces (rational: quadrature)."""
        origin = self.vertices.mean(axis=0)
        v = self.vertices - origin
        polygon = float(np.sum(cross(v, np.roll(v, -1, axis=0)))) / 2.0
        arc = self.kind == ARC
        bows = float(np.sum(self.radius[arc] ** 2 * less_sine(self.sweep[arc]))) / 2.0
        return polygon + bows + self.beziers.area_over_chords()


def less_sine(x: Array) -> Array:
    """X - sin x, (n,), to full relative precision for small x too."""
    x2 = x * x
    series = x * x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0))))
    return np.where(np.abs(x) < 0.25, series, x - np.sin(x))


def paired(ranges: NormalRanges, theta: Array) -> list[tuple[Indices, Indices]]:
    """All pairs of a range and an angle within it, theta (k,) rising in [0, 2 pi): batches of (range, angle) numbers."""
    ring = np.concatenate([theta, theta + TURN])
    first = np.searchsorted(ring, ranges.low, side="left")
    count = np.minimum(np.searchsorted(ring, ranges.low + ranges.width, side="right") - first, theta.size)
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
