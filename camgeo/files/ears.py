"""Triangles of a plane region by clipping its ears, many at a time, in numpy alone.

Holes are first joined to the loop around them, each by a bridge from its rightmost vertex (Eberly 2002, Triangulation
by Ear Clipping, section 5). The region then lies left of one way, which runs along each bridge twice. A vertex is an
ear if the way turns left there, and no vertex at which it does not lies in the triangle with both neighbours, rim
included.
Ears that are not neighbours do not overlap (Meisters 1975), so those of a round are cut together.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.sides import sides

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Indices, Mask

FREE, UNKNOWN = -1, -2  # in place of the vertex that blocks an ear: none does, or it is not tested yet
MOST_PAIRS = 1 << 20  # of ears and vertices that are looked at together: 100 MB


def clip_ears(points: Array, loops: Sequence[Indices]) -> Indices:
    """Triangles (t, 3), counter-clockwise, of the region left of loops of distinct points (n, 2), the outermost first.

    Triangles and loops are indices of points; a loop has its points in their order. Where loops cross or touch, the
    triangles may not cover the region: the caller has to compare their edges with the loops.
    """
    way = _bridge_holes(points, loops)
    place = points[way]
    turn = np.zeros(len(way), dtype=np.intp)
    blocker = np.full(len(way), UNKNOWN)
    remaining = changed = np.arange(len(way))
    cut: list[Indices] = []
    # a round: test the ears whose neighbours or blockers have changed, then cut those that are free and no neighbours
    while remaining.size > 2:
        before, after = np.empty((2, len(way)), dtype=np.intp)
        before[remaining], after[remaining] = np.roll(remaining, 1), np.roll(remaining, -1)
        turn[changed] = sides(place[before[changed]], place[changed], place[after[changed]])
        blocker[changed] = UNKNOWN
        blocked = remaining[blocker[remaining] >= 0]
        blocker[blocked[turn[blocker[blocked]] > 0]] = UNKNOWN  # what was in the way is cut, or has become an ear's tip
        tips = remaining[turn[remaining] > 0]
        untested = tips[blocker[tips] == UNKNOWN]
        triangles = np.stack((before[untested], untested, after[untested]), axis=1)
        blocker[untested] = _blockers(way, place, triangles, remaining[turn[remaining] <= 0])
        chosen = alternate((turn[remaining] > 0) & (blocker[remaining] == FREE), remaining.size - 2)
        clipped = remaining[chosen]
        cut.append(way[np.stack((before[clipped], clipped, after[clipped]), axis=1)])
        if not clipped.size:  # the way may run back on itself from a vertex: its two neighbours are the same point
            spikes = remaining[way[before[remaining]] == way[after[remaining]]]
            if not spikes.size:
                break
            clipped = np.array([spikes[0], after[spikes[0]]])
        turn[clipped] = 1  # ears that they blocked are looked at again
        stays = np.isin(remaining, clipped, invert=True)
        beside = stays & (np.roll(~stays, 1) | np.roll(~stays, -1))
        remaining, changed = remaining[stays], remaining[beside]
    return np.concatenate(cut)


def alternate(ear: Mask, most: int) -> Mask:
    """Every second ear of each run of ears (n,) round a way, `most` in all.

    Where every vertex is an ear, the run starts anywhere.
    """
    start = int(np.argmin(ear))
    turned = np.roll(ear, -start)
    place = np.arange(ear.size)
    since = place - np.maximum.accumulate(np.where(turned, 0, place))
    chosen: Mask = np.roll(turned & (since % 2 == 1), start)
    chosen[np.flatnonzero(chosen)[most:]] = False
    return chosen


def _blockers(way: Indices, place: Array, ears: Indices, others: Indices) -> Indices:
    """Index of a vertex among `others` that lies in each triangle (t, 3) or on its rim, FREE where none does."""
    blocker = np.full(len(ears), FREE)
    others = others[np.argsort(place[others, 0])]
    x, y = place[others].T
    low, high = place[ears].min(axis=1), place[ears].max(axis=1)
    first, last = np.searchsorted(x, low[:, 0], "left"), np.searchsorted(x, high[:, 0], "right")
    ends = np.cumsum(last - first)
    # vertices within the x range of each ear, as many ears at a time as memory bears, then those within its rim
    begin = 0
    while begin < len(ears):
        end = max(begin + 1, int(np.searchsorted(ends, ends[begin] + MOST_PAIRS)))
        count = (last - first)[begin:end]
        ear = np.repeat(np.arange(begin, end), count)
        other = np.arange(len(ear)) - np.repeat(np.cumsum(count) - count, count) + first[ear]
        near = (y[other] >= low[ear, 1]) & (y[other] <= high[ear, 1])
        ear, other = ear[near], others[other[near]]
        apart = (way[ears[ear]] != way[other][:, None]).all(axis=1)
        ear, other = ear[apart], other[apart]
        for k in range(3):
            within = sides(place[ears[ear, k]], place[ears[ear, (k + 1) % 3]], place[other]) >= 0
            ear, other = ear[within], other[within]
        blocker[ear] = other
        begin = end
    return blocker


def _bridge_holes(points: Array, loops: Sequence[Indices]) -> Indices:
    """Indices of a single path along the outermost loop, to each hole, along it, and back.

    A hole that no bridge reaches is left out.
    """
    way, *holes = loops
    for hole in sorted(holes, key=lambda hole: -points[hole, 0].max()):
        start = int(np.argmax(points[hole, 0]))
        place = _visible(points, way, int(hole[start]))
        if place is not None:
            way = np.concatenate((way[: place + 1], np.roll(hole, -start), hole[[start]], way[place:]))
    return way


def _visible(points: Array, way: Indices, start: int) -> int | None:
    """Place on the way of the nearest vertex to the right that a bridge from point `start` reaches; None without."""
    begin, places = points[start], points[way]
    before, after = np.roll(places, 1, axis=0), np.roll(places, -1, axis=0)
    right = np.flatnonzero(places[:, 0] > begin[0])
    nearest: list[int] = right[np.argsort(np.hypot(*(places[right] - begin).T))].tolist()
    for place in nearest:
        end = places[place]
        left_of = _side(before[place], end, begin), _side(end, after[place], begin)
        inside = (min if _side(before[place], end, after[place]) > 0 else max)(left_of) > 0
        if inside and not _is_crossed(
            begin, end, places, after, (way != way[place]) & (np.roll(way, -1) != way[place])
        ):
            return place
    return None


def _side(a: Array, b: Array, c: Array) -> int:
    return int(sides(a[None], b[None], c[None])[0])


def _is_crossed(begin: Array, end: Array, a: Array, b: Array, among: Mask) -> bool:
    """Whether a segment meets a segment from a to b (n, 2); of these only those in the mask `among` (n,) count."""
    low, high = np.minimum(begin, end), np.maximum(begin, end)
    near = among & (np.maximum(a, b) >= low).all(axis=1) & (np.minimum(a, b) <= high).all(axis=1)
    a, b = a[near], b[near]
    first, second = np.broadcast_to(begin, a.shape), np.broadcast_to(end, a.shape)
    astride = sides(first, second, a) * sides(first, second, b) <= 0
    return bool((astride & (sides(a, b, first) * sides(a, b, second) <= 0)).any())
