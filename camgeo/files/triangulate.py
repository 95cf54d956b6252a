"""Plane regions as triangles on their own vertices: no vertex added, none left out, so neighbours always match.

Coordinates are the numbers that the file will hold, as doubles; the side of a line on which a point lies is decided
exactly for any doubles.

Why checking the sense of each triangle is enough: the triangles of `ring` and `clip` are joined by their edges, and
the edges left over are the region's boundary by construction. If every triangle runs counter-clockwise, the map of
this sheet into the plane turns nowhere over, and each point of the plane is covered as often as the boundary winds
about it: once inside, not at all outside.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.errors import KinError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array

    Triangles = NDArray[np.int64]


class RegionError(KinError, ValueError):
    """A region that has no triangles: its boundary touches or crosses itself, or a hole reaches its edge."""


def sides(a: Array, b: Array, c: Array) -> NDArray[np.int64]:
    """Exact side of line a b on which c lies, (n,): 1 left, -1 right, 0 on it. Points (n, 2).

    The determinant is evaluated in doubles; where rounding could turn its sign (Shewchuk 1997, bound A of orient2d,
    taken three times as wide), it is evaluated in fractions.
    """
    left = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1])
    right = (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    determinant = left - right
    for i in np.flatnonzero(np.abs(determinant) <= 1e-15 * (np.abs(left) + np.abs(right))):
        (ax, ay), (bx, by), (cx, cy) = (map(Fraction, point[i].tolist()) for point in (a, b, c))
        first, second = (bx - ax) * (cy - ay), (by - ay) * (cx - ax)
        determinant[i] = (first > second) - (first < second)
    sign: NDArray[np.int64] = np.sign(determinant).astype(np.int64)
    return sign


def ring(outer: Array, inner: Array) -> Triangles:
    """Triangles (n + m, 3), counter-clockwise, between two counter-clockwise loops, outer (n, 2) and inner (m, 2).

    Indices below n are of `outer`, the rest of `inner`. Where both loops run once round the origin without turning
    back, they are merged in the order of their edges' angles, in O((n + m) log m). Other contours take `clip`. Raises
    RegionError where the inner loop does not lie strictly inside the outer one or a loop is not simple.
    """
    if star_shaped(outer) and star_shaped(inner):
        merged = _merge(outer, inner)
        points = np.concatenate((outer, inner))
        if _all_positive(points, merged):
            return merged
    return clip(outer, inner)


def region(outer: Array, inners: Sequence[Array]) -> Triangles:
    """Triangles, counter-clockwise, of a loop (n, 2) with several holes (m, 2) in it; all counter-clockwise.

    Indices count through the loop and the holes in their order. One hole goes to `ring`; more are bridged to the loop
    one after the other, and its ears clipped. Raises RegionError where a loop is not simple or a hole reaches another.
    """
    if len(inners) < 2:
        return ring(outer, inners[0]) if len(inners) else disc(outer)
    points = np.concatenate((outer, *inners))
    chain = _bridged(points, [len(outer), *map(len, inners)])
    triangles = None if chain is None else _clip_ears(points, chain)
    if triangles is None or not _all_positive(points, triangles):
        raise RegionError("a hole reaches another or the contour, or the contour touches or crosses itself")
    return triangles


def disc(outer: Array) -> Triangles:
    """Triangles (n - 2, 3), counter-clockwise, of the region inside a counter-clockwise loop (n, 2).

    From a loop that runs once round the middle of its vertices, ears are cut in rounds, as many at a time as are not
    neighbours: an ear that leaves the middle inside leaves the rest star-shaped. A convex loop takes O(log n) rounds,
    a hollow takes one for each two of its vertices. What no round can cut goes to `clip`, and so do
    other contours. Raises RegionError where the loop is not simple.
    """
    centre: Array = outer.mean(axis=0)
    cut, left = _cut_rounds(outer, centre) if star_shaped(outer, centre) else ([], np.arange(len(outer)))
    return np.concatenate([*cut, left[clip(outer[left])]])


def star_shaped(loop: Array, centre: Array | None = None) -> bool:
    """Whether a loop (n, 2) runs exactly once counter-clockwise round a centre (the origin), never turning back."""
    about = np.zeros(2) if centre is None else centre
    following = np.roll(loop, -1, axis=0)
    if not bool(np.all(sides(np.broadcast_to(about, loop.shape), loop, following) > 0)):
        return False
    # each edge turns by less than half a turn, so whole turns are counted where the angle passes the negative x axis
    return int(np.count_nonzero((loop[:, 1] >= about[1]) & (following[:, 1] < about[1]))) == 1


def clip(outer: Array, inner: Array | None = None) -> Triangles:
    """Triangles, counter-clockwise, of any simple loop (n, 2), with one hole (m, 2) bridged to it if given.

    Ear clipping, each ear tested against all reflex vertices at once: O(n) numpy calls, each over the reflex vertices.
    Both loops counter-clockwise, indices as in `ring`. Raises RegionError where no ear is left: a loop is not simple,
    or the hole does not lie strictly inside.
    """
    if inner is None:
        points = outer
        chain: NDArray[np.int64] | None = np.arange(len(outer))
    else:
        points = np.concatenate((outer, inner))
        chain = _bridged(points, [len(outer), len(inner)])
    triangles = None if chain is None else _clip_ears(points, chain)
    if triangles is None or not _all_positive(points, triangles):
        reached = "the bore reaches the contour, or " if inner is not None else ""
        raise RegionError(f"{reached}the contour touches or crosses itself")
    return triangles


def _all_positive(points: Array, triangles: Triangles) -> bool:
    a, b, c = (np.take(points, corner, axis=0) for corner in triangles.T)
    return bool(np.all(sides(a, b, c) > 0))


def _merge(outer: Array, inner: Array) -> Triangles:
    """Join two loops about the origin: each edge to the vertex of the other loop that its middle looks at.

    The edges of both are put in the order of the angle of their middles; going round in that order, an edge of one
    loop is joined to the vertex then reached on the other.
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


def _cut_rounds(loop: Array, centre: Array) -> tuple[list[Triangles], NDArray[np.int64]]:
    """Cut ears off a star-shaped loop until three vertices are left or none can go; returns them and what is left."""
    left = np.arange(len(loop))
    cut: list[Triangles] = []
    while left.size > 3:
        before, after = np.roll(left, 1), np.roll(left, -1)
        a, b, c = loop[before], loop[left], loop[after]
        ear = (sides(a, b, c) > 0) & (sides(np.broadcast_to(centre, a.shape), a, c) > 0)
        # every other one of each run of ears; a run that closes on itself starts anywhere
        start = int(np.argmin(ear))
        turned = np.roll(ear, -start)
        place = np.arange(left.size)
        since = place - np.maximum.accumulate(np.where(turned, 0, place))
        chosen = turned & (since % 2 == 1)
        chosen = np.roll(chosen, start)
        chosen[np.flatnonzero(chosen)[left.size - 3 :]] = False
        if not chosen.any():
            break
        cut.append(np.column_stack((before, left, after))[chosen])
        left = left[~chosen]
    return cut, left


def _bridged(points: Array, counts: list[int]) -> NDArray[np.int64] | None:
    """One chain of vertex indices round the first loop and, over bridges and back, clockwise round all others.

    Each hole's vertex farthest right is joined to the nearest vertex of the chain that it sees, holes farther right
    first: what it sees to its right is then of the chain, so each sees one if no hole reaches another. None if one
    sees none.
    """
    first = np.cumsum([0, *counts[:-1]])
    following = np.concatenate([start + np.roll(np.arange(n), -1) for start, n in zip(first, counts, strict=True)])
    start, end = np.arange(len(points)), following
    chain = np.arange(counts[0])
    rightmost = [int(f + np.argmax(points[f : f + n, 0])) for f, n in zip(first[1:], counts[1:], strict=True)]
    for hole in sorted(range(len(rightmost)), key=lambda k: (-points[rightmost[k], 0], k)):
        q, low, n = rightmost[hole], int(first[hole + 1]), counts[hole + 1]
        place = _seen_from(points, q, chain, (start, end))
        if place is None:
            return None
        p = int(chain[place])
        round_hole = low + (q - low - np.arange(n + 1)) % n
        chain = np.concatenate((chain[: place + 1], round_hole, chain[place:]))
        start, end = np.append(start, p), np.append(end, q)
    return chain


def _seen_from(
    points: Array, q: int, chain: NDArray[np.int64], edges: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> int | None:
    """Place in the chain of the nearest vertex that q sees past all edges, starts and ends; None if there is none.

    A vertex that bridges end in stands in the chain once for each sector between them: the place is that of the sector
    in which q is seen.
    """
    start, end = edges
    a, b = points[start], points[end]
    there = np.broadcast_to(points[q], a.shape)
    own_q = (start == q) | (end == q)
    at = points[chain]
    opens = _in_sector(np.roll(at, 1, axis=0), at, np.roll(at, -1, axis=0), points[q])
    distance = np.where(opens, np.hypot(*(at - points[q]).T), np.inf)
    for place in np.argsort(distance, kind="stable")[: np.count_nonzero(opens)]:
        p = int(chain[place])
        here = np.broadcast_to(points[p], a.shape)
        side_a, side_b = sides(there, here, a), sides(there, here, b)
        crosses = (side_a * side_b <= 0) & (sides(a, b, there) * sides(a, b, here) <= 0)
        own = own_q | (start == p) | (end == p)
        if not np.any(crosses & (~own | ((side_a == 0) & (side_b == 0)))):
            return int(place)
    return None


def _in_sector(before: Array, at: Array, after: Array, point: Array) -> NDArray[np.bool_]:
    """Whether a point is seen from corners (n, 2) strictly inside their sectors, left of the chain's two edges (n,)."""
    there = np.broadcast_to(point, at.shape)
    left_in, left_out = sides(before, at, there) > 0, sides(at, after, there) > 0
    return np.where(sides(before, at, after) > 0, left_in & left_out, left_in | left_out)


def _clip_ears(points: Array, chain: NDArray[np.int64]) -> Triangles | None:
    """Clip the ears of a chain of vertex indices, going round: len(chain) - 2 triangles, None if there is no ear."""
    size = len(chain)
    before, after = (np.arange(size) - 1) % size, (np.arange(size) + 1) % size
    at = points[chain]
    reflex = sides(at[before], at, at[after]) <= 0
    triangles = []
    k, stuck = 0, 0
    while size > 3:
        i, j = before[k], after[k]
        if not reflex[k] and not _holds(at, np.flatnonzero(reflex), (i, k, j)):
            triangles.append((chain[i], chain[k], chain[j]))
            after[i], before[j] = j, i
            size, stuck = size - 1, 0
            for corner in (i, j):
                one = at[[corner]]
                reflex[corner] = sides(at[[before[corner]]], one, at[[after[corner]]])[0] <= 0
            k = after[j]  # skipping one avoids fans of slivers
            continue
        k, stuck = j, stuck + 1
        if stuck > size:
            return None
    triangles.append((chain[before[k]], chain[k], chain[after[k]]))
    return np.array(triangles, dtype=np.int64)


def _holds(at: Array, others: NDArray[np.int64], corners: tuple[int, int, int]) -> bool:
    """Whether a triangle holds one of the other chain places, its edges included and its corners' own points not."""
    a, b, c = (at[corner] for corner in corners)
    candidates = at[others]
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    inside = np.all((candidates >= low) & (candidates <= high), axis=1)
    for corner in (a, b, c):
        inside &= np.any(candidates != corner, axis=1)
    found = candidates[inside]
    if not found.size:
        return False
    for start, end in ((a, b), (b, c), (c, a)):
        found = found[sides(np.broadcast_to(start, found.shape), np.broadcast_to(end, found.shape), found) >= 0]
    return bool(found.size)
