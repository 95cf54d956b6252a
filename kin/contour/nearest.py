"""Distance from many points to a chain of many pieces, by chords of runs of pieces and the runs' height over them."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from kin.contour.arcs import dot, nearest_on, radial, right
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.contour.arcs import Arcs
    from kin.numeric.arrays import Array, Indices

    Places = NDArray[np.complex128]

RUN = 8  # pieces under one chord, and chords under one of the next level
BLOCK = 1024  # points at a time
FEW_PAIRS = 1024  # pairs of a point and a piece: up to these all are measured
MOST_PAIRS = 200_000  # pairs of a point and a run; where more remain, fewer points are taken at a time
# Of the greatest coordinate: the amount by which bounds are widened, so that every equally near piece is measured.
ROUNDING = 1e-13


def nearest(arcs: Arcs, points: Array) -> tuple[Indices, Array]:
    """Return the index of the piece nearest to each of the points (m, 2), and the unsigned distance, (m,) each; exact.

    Of pieces equally near it is the first. Pieces may turn by at most half a turn and are best in the order of a chain,
    where neighbours lie together. Cost grows as m log n.
    """
    piece, _, distance = _foot(arcs, points)
    return piece, distance


def _foot(arcs: Arcs, points: Array) -> tuple[Indices, Array, Array]:
    """The piece nearest to each of the points (m, 2), the foot's arc length on it, and the distance, (m,) each."""
    if len(arcs) * len(points) <= FEW_PAIRS:
        shape = len(points), len(arcs)
        every = arcs.take(np.tile(np.arange(shape[1]), shape[0]))
        s, distance = (row.reshape(shape) for row in nearest_on(every, np.repeat(points, shape[1], axis=0)))
        piece = distance.argmin(axis=1)
        chosen = np.arange(shape[0]), piece
        return piece, s[chosen], distance[chosen]
    if arcs not in _CHORDS:
        _CHORDS[arcs] = _levels(arcs)
    levels = _CHORDS[arcs]
    size = max(float(np.abs(arcs.start).max()), float(np.abs(points).max(initial=0.0)))
    slack = ROUNDING * size
    blocks = [_nearest(arcs, levels, points[first : first + BLOCK], slack) for first in range(0, len(points), BLOCK)]
    return _joined(blocks)


def _nearest(arcs: Arcs, levels: list[_Chords], points: Array, slack: float) -> tuple[Indices, Array, Array]:
    """The results of `_foot` for a block of points: from the longest runs down, those too far away are dropped.

    `query` and `run` (k,) are the pairs of a point and a run still open, sorted by points.
    """
    count = len(levels[-1].start)
    query, run = np.repeat(np.arange(len(points)), count), np.tile(np.arange(count), len(points))
    place, best = _places(points), np.full(len(points), np.inf)
    for depth in range(len(levels) - 1, -1, -1):
        nearer, reach = levels[depth].bounds(run, place[query])
        best = np.minimum(best, np.minimum.reduceat(reach, _first_of_each(query)))
        near = nearer <= (best + slack)[query]
        query, run = query[near], run[near]
        if len(query) > MOST_PAIRS // RUN and len(points) > 1:
            half = len(points) // 2
            return _joined([_nearest(arcs, levels, part, slack) for part in (points[:half], points[half:])])
        if depth:
            run = (run[:, None] * RUN + np.arange(RUN)).ravel()
            query = np.repeat(query, RUN)
            real = run < len(levels[depth - 1].start)
            query, run = query[real], run[real]
    s, distance = nearest_on(arcs.take(run), points[query])
    best = np.minimum.reduceat(distance, _first_of_each(query))
    chosen = np.flatnonzero(distance == best[query])
    chosen = chosen[_first_of_each(query[chosen])]
    return run[chosen], s[chosen], distance[chosen]


def _joined(blocks: list[tuple[Indices, Array, Array]]) -> tuple[Indices, Array, Array]:
    if len(blocks) == 1:
        return blocks[0]
    piece, s, distance = zip(*blocks, strict=True)
    return np.concatenate(piece), np.concatenate(s), np.concatenate(distance)


def signed_distance(chain: Arcs, points: Array) -> Array:
    """Distance of points (m, 2) from a closed counter-clockwise chain, mm (m,), positive outside, negative inside."""
    return feet(chain, points)[0]


def feet(chain: Arcs, points: Array) -> tuple[Array, Array]:
    """Distance of points (m, 2) from a closed counter-clockwise chain, mm (m,), and the chain's nearest points (m, 2).

    The distance is positive outside and negative inside.
    """
    piece, s, distance = _foot(chain, points)
    own = chain.take(piece)
    side = radial(own, points)
    at_start, at_end = s <= 0.0, s >= own.length
    corner = np.flatnonzero(at_start | at_end)
    if corner.size:  # there the side of one piece may mislead; the two normals together do not
        before = chain.take((piece - at_start)[corner])
        after = chain.take(((piece + at_end) % len(chain))[corner])
        side[corner] = dot(points[corner] - after.start, right(before.end_tangents) + right(after.tangent))
    return np.copysign(distance, side), own.points(s)


def _first_of_each(sorted_index: Indices) -> Indices:
    return np.flatnonzero(np.concatenate([[True], sorted_index[1:] != sorted_index[:-1]]))


@dataclass(frozen=True)
class _Chords:
    """Chords of n runs of pieces from `start` over `length` along `heading`, all (n,), places as complex numbers.

    No point of a run is farther than `sagitta` (n,) from its chord.
    """

    start: Places
    heading: Places
    length: Array
    sagitta: Array

    @staticmethod
    def between(start: Places, end: Places, sagitta: Array) -> _Chords:
        """Chords by their ends; one whose ends coincide has length 0 and heading 1."""
        length = np.abs(end - start)
        closed = length == 0.0
        return _Chords(start, np.where(closed, 1.0, (end - start) / np.where(closed, 1.0, length)), length, sagitta)

    def bounds(self, run: Indices, place: Places) -> tuple[Array, Array]:
        """Lower and upper bounds (m,), (m,) of the distance of places (m,) from runs (m,)."""
        length = self.length[run]
        offset = (place - self.start[run]) * self.heading[run].conj()
        along, across = offset.real, offset.imag**2
        beyond = along - length
        outside = np.maximum(np.maximum(-along, beyond), 0.0)
        # the ends of a chord lie on its run: the nearer one gives the upper bound
        reach = np.sqrt(np.minimum(along**2, beyond**2) + across)
        return np.sqrt(outside**2 + across) - self.sagitta[run], reach


def _places(points: Array) -> Places:
    return points[:, 0] + 1j * points[:, 1]


_CHORDS: WeakKeyDictionary[Arcs, list[_Chords]] = WeakKeyDictionary()  # of each chain, while it is in use


def _levels(arcs: Arcs) -> list[_Chords]:
    """Chords of runs of 1, RUN, RUN^2, ... pieces, finest level first."""
    start, end = _places(arcs.start), _places(arcs.ends)
    quarter = 0.25 * np.abs(arcs.curvature) * arcs.length
    sagitta = 0.5 * arcs.length * np.sin(quarter) * np.sinc(quarter / np.pi)
    levels = [_Chords.between(start, end, sagitta)]
    while len(start) > 2 * RUN:
        heads = np.arange(0, len(start), RUN)
        owner = np.arange(len(start)) // RUN
        whole = _Chords.between(start[heads], end[np.append(heads[1:], len(end)) - 1], np.zeros(len(heads)))
        # a point of a shorter chord is farthest from the longer one at an end
        off = np.maximum(whole.bounds(owner, start)[0], whole.bounds(owner, end)[0])
        sagitta = np.maximum.reduceat(off + sagitta, heads)
        levels.append(replace(whole, sagitta=sagitta))
        start, end = start[heads], end[np.append(heads[1:], len(end)) - 1]
    return levels
