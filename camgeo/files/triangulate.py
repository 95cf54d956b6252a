"""Plane regions as triangles on their own vertices: no vertex added, none left out, so neighbours always match.

Coordinates are the numbers that the file will hold, as doubles; the side of a line on which a point lies is decided
exactly for any doubles.

Why checking the sense of each triangle is enough: the triangles are joined by their edges, and the edges left over are
the region's boundary. If every triangle runs counter-clockwise, the map of this sheet into the plane turns nowhere
over, and each point of the plane is covered as often as the boundary winds about it: once inside, not at all outside.
A loop that winds twice about some point, as one does that overlaps itself, may get triangles too: the judge finds where
the contour of a file crosses itself.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.ears import alternate, clip_ears
from camgeo.files.errors import RegionError
from camgeo.files.sides import sides
from kin.numeric.arrays import paired

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Indices

    Triangles = Indices


_TURNS = 10  # of edges for each flat triangle: more go round in circles


def ring(outer: Array, inner: Array) -> Triangles:
    """Triangles (n + m, 3), counter-clockwise, between two counter-clockwise loops, outer (n, 2) and inner (m, 2).

    Indices below n are of `outer`, the rest of `inner`. Where both loops run once round the origin without turning
    back, they are merged in the order of their edges' angles, in O((n + m) log m). Other contours take `clip_region`.
    Raises RegionError where the inner loop does not lie strictly inside the outer one or a loop is not simple.
    """
    if star_shaped(outer) and star_shaped(inner):
        merged = _merge(outer, inner)
        points = np.concatenate((outer, inner))
        if _all_positive(points, merged):
            return merged
    return clip_region(outer, [inner])


def region(outer: Array, inners: Sequence[Array]) -> Triangles:
    """Triangles, counter-clockwise, of a loop (n, 2) with any number of holes (m, 2) in it; all counter-clockwise.

    Indices count through the loop and the holes in their order. A loop alone goes to `disc`, one hole to `ring`, more
    to `clip_region`. Raises RegionError where a loop is not simple or a hole reaches another.
    """
    if len(inners) < 2:
        return ring(outer, inners[0]) if len(inners) else disc(outer)
    return clip_region(outer, inners)


def disc(outer: Array) -> Triangles:
    """Triangles (n - 2, 3), counter-clockwise, of the region inside a counter-clockwise loop (n, 2).

    From a loop that runs once round the middle of its vertices, ears are cut in rounds, as many at a time as are not
    neighbours: an ear that leaves the middle inside leaves the rest star-shaped. A convex loop takes O(log n) rounds, a
    hollow takes one for each two of its vertices. The rest that no round can cut, and any other loop, goes to
    `clip_region`. Raises RegionError where the loop is not simple.
    """
    centre: Array = outer.mean(axis=0)
    cut, remaining = _cut_rounds(outer, centre) if star_shaped(outer, centre) else ([], np.arange(len(outer)))
    return np.concatenate([*cut, remaining[clip_region(outer[remaining])]])


def star_shaped(loop: Array, centre: Array | None = None) -> bool:
    """Whether a loop (n, 2) runs exactly once counter-clockwise round a centre, never turning back.

    The centre is by default the origin.
    """
    about = np.zeros(2) if centre is None else centre
    following = np.roll(loop, -1, axis=0)
    if not bool(np.all(sides(np.broadcast_to(about, loop.shape), loop, following) > 0)):
        return False
    # each edge turns by less than half a turn, so whole turns are counted where the angle passes the negative x axis
    return int(np.count_nonzero((loop[:, 1] >= about[1]) & (following[:, 1] < about[1]))) == 1


def clip_region(outer: Array, inners: Sequence[Array] = ()) -> Triangles:
    """Triangles, counter-clockwise, of any simple loop (n, 2) with any holes (m, 2); all counter-clockwise.

    The ears are clipped by manifold3d, on these very doubles, and where that is not installed by `clip_ears`.
    manifold3d takes vertices in line for ears, and leaves flat triangles where holes line up: `_without_flat` makes
    them part of their neighbours. Indices count through the loop and the holes in their order. Raises RegionError where
    a loop is not simple, or a hole does not lie strictly inside or reaches another.
    """
    points = np.concatenate((outer, *inners))
    loops = np.split(np.arange(len(points)), np.cumsum([len(outer), *map(len, inners)])[:-1])
    ways = [loops[0], *(loop[::-1] for loop in loops[1:])]  # the metal lies left of each
    if len(np.unique(points, axis=0)) == len(points):
        triangles = _without_flat(points, _ears(points, ways))
        if triangles is not None and _bounded(triangles, ways):
            return triangles
    reached = ("", "the bore reaches the contour, or ", "a hole reaches another or the contour, or ")[
        min(len(inners), 2)
    ]
    raise RegionError(f"{reached}the contour touches or crosses itself")


def _all_positive(points: Array, triangles: Triangles) -> bool:
    a, b, c = (np.take(points, corner, axis=0) for corner in triangles.T)
    return bool(np.all(sides(a, b, c) > 0))


def _merge(outer: Array, inner: Array) -> Triangles:
    """Join two loops about the origin: each edge to the vertex of the other loop in the direction of its middle.

    The edges of both are put in the order of the angle of their middles; going round in that order, an edge of a loop
    is joined to the vertex then reached on the other loop.
    """
    n, m = len(outer), len(inner)
    middles = [_angles(loop + np.roll(loop, -1, axis=0)) for loop in (outer, inner)]
    firsts = [int(np.argmin(angle)) for angle in middles]
    # edge k in this order starts at vertex first + k, which is the vertex reached until its middle is passed
    sorted_outer, sorted_inner = (np.roll(angle, -first) for angle, first in zip(middles, firsts, strict=True))
    o, q = np.arange(n), np.arange(m)
    on_inner = (firsts[1] + np.searchsorted(sorted_inner, sorted_outer, side="left")) % m
    on_outer = (firsts[0] + np.searchsorted(sorted_outer, sorted_inner, side="right")) % n
    from_outer = np.column_stack(((firsts[0] + o) % n, (firsts[0] + o + 1) % n, n + on_inner))
    from_inner = np.column_stack((n + (firsts[1] + q + 1) % m, n + (firsts[1] + q) % m, on_outer))
    return np.concatenate((from_outer, from_inner))


def _angles(points: Array) -> Array:
    angle: Array = np.arctan2(points[:, 1], points[:, 0])
    return angle


def _cut_rounds(loop: Array, centre: Array) -> tuple[list[Triangles], Indices]:
    """Ears cut off a star-shaped loop until three vertices remain or no ear does, and the remaining vertices."""
    remaining = np.arange(len(loop))
    cut: list[Triangles] = []
    while remaining.size > 3:
        before, after = np.roll(remaining, 1), np.roll(remaining, -1)
        a, b, c = loop[before], loop[remaining], loop[after]
        ear = (sides(a, b, c) > 0) & (sides(np.broadcast_to(centre, a.shape), a, c) > 0)
        chosen = alternate(ear, remaining.size - 3)
        if not chosen.any():
            break
        cut.append(np.column_stack((before, remaining, after))[chosen])
        remaining = remaining[~chosen]
    return cut, remaining


def _ears(points: Array, ways: list[Indices]) -> Triangles:
    """Triangles of the region left of loops: by manifold3d, some of them flat; by numpy where that is not installed."""
    if len(points) == 3:
        return ways[0][[[2, 0, 1]]]
    try:
        import manifold3d
    except ModuleNotFoundError:
        return clip_ears(points, ways)
    corners = manifold3d.triangulate([points[way] for way in ways], 0.0)
    return np.concatenate(ways)[np.asarray(corners, dtype=np.intp).reshape(-1, 3)]


def _without_flat(points: Array, triangles: Triangles) -> Triangles | None:
    """Triangles of the same region that all run counter-clockwise, where some are flat or turned over; None without.

    The longest edge of a flat triangle passes through its third corner. There it is cut, and with it the neighbour over
    that edge: two triangles become two others. Where the neighbour is flat as well, other flat triangles come first.
    """
    flat = deque(np.flatnonzero(sides(*(points[corner] for corner in triangles.T)) <= 0).tolist())
    if not flat:
        return triangles
    corners = triangles.tolist()
    owner = {edge: k for k, triangle in enumerate(corners) for edge in _edges(triangle)}
    waiting = 0
    for _ in range(_TURNS * len(flat)):
        k = flat.popleft()
        a, b, c = _longest_last(points, corners[k])
        beside = owner.get((a, c))
        if beside is None or beside == k:
            return None  # the boundary passes through a vertex, or turns over
        if beside in flat and waiting < len(flat):
            flat.append(k)
            waiting += 1
            continue
        waiting = 0
        (d,) = set(corners[beside]) - {a, c}
        corners[k], corners[beside] = [a, b, d], [b, c, d]
        for place in (k, beside):
            owner.update(dict.fromkeys(_edges(corners[place]), place))
            x, y, z = (points[[corner]] for corner in corners[place])
            if sides(x, y, z)[0] <= 0 and place not in flat:
                flat.append(place)
        if not flat:
            return np.array(corners, dtype=np.intp)
    return None


def _edges(triangle: list[int]) -> list[tuple[int, int]]:
    a, b, c = triangle
    return [(a, b), (b, c), (c, a)]


def _longest_last(points: Array, triangle: list[int]) -> list[int]:
    """The corners of a triangle in their order, its longest edge from the last to the first."""
    places = points[triangle]
    first = (int(np.argmax(np.hypot(*(np.roll(places, -1, axis=0) - places).T))) + 1) % 3
    return triangle[first:] + triangle[:first]


def _bounded(triangles: Triangles, ways: list[Indices]) -> bool:
    """Whether no directed edge of triangles occurs twice, and edges without a reverse are the edges of the loops."""
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    size = sum(map(len, ways))
    edges, backs = np.sort(paired(start, end, size)), paired(end, start, size)
    rim = np.concatenate([paired(way, np.roll(way, -1), size) for way in ways])
    return bool((edges[1:] > edges[:-1]).all()) and np.array_equal(np.setdiff1d(edges, backs), np.sort(rim))
