"""Distance from many points to a chain of many pieces, by bounding discs over runs of pieces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import dot, nearest_on, radial, right

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.numeric.arrays import Array, Indices

RUN = 8  # pieces under one disc, discs under the next


def nearest(arcs: Arcs, points: Array) -> tuple[Indices, Array]:
    """Return the piece nearest to each of the points (m, 2), and the distance, (m,) each; exact.

    `arcs` is best in the order of a chain, where neighbours lie together. Cost grows as m log n.
    """
    levels = _discs(arcs)
    query = np.repeat(np.arange(len(points)), len(levels[-1][0]))
    block = np.tile(np.arange(len(levels[-1][0])), len(points))
    for depth in range(len(levels) - 1, -1, -1):
        centre, radius = levels[depth]
        gap = points[query] - centre[block]
        # each disc's centre lies on the chain, so the distance to it is a distance to the chain
        reach = np.sqrt(dot(gap, gap))
        best = np.minimum.reduceat(reach, _first_of_each(query))
        near = reach - radius[block] <= best[query]
        query, block = query[near], block[near]
        if depth:
            count = len(levels[depth - 1][0])
            block = (block[:, None] * RUN + np.arange(RUN)).ravel()
            query = np.repeat(query, RUN)
            real = block < count
            query, block = query[real], block[real]
    _, distance = nearest_on(arcs.take(block), points[query])
    best = np.minimum.reduceat(distance, _first_of_each(query))
    chosen = np.flatnonzero(distance == best[query])
    chosen = chosen[_first_of_each(query[chosen])]
    return block[chosen], distance[chosen]


def signed_distance(chain: Arcs, points: Array) -> Array:
    """Distance of points (m, 2) from a closed counter-clockwise chain, positive outside: (m,)."""
    piece, distance = nearest(chain, points)
    here = chain.take(piece)
    s, _ = nearest_on(here, points)
    side = radial(here, points)
    at_start, at_end = s <= 0.0, s >= here.length
    # At a corner the side of one piece may mislead; the two normals together do not.
    before = chain.take(np.where(at_start, piece - 1, piece))
    after = chain.take(np.where(at_end, (piece + 1) % len(chain), piece))
    corner = at_start | at_end
    bisector = right(before.end_tangents) + right(after.tangent)
    side = np.where(corner, dot(points - after.start, bisector), side)
    return np.copysign(distance, side)


def _first_of_each(sorted_index: Indices) -> Indices:
    return np.flatnonzero(np.concatenate([[True], sorted_index[1:] != sorted_index[:-1]]))


def _discs(arcs: Arcs) -> list[tuple[Array, Array]]:
    """Discs that hold runs of 1, RUN, RUN^2, ... pieces, their centres on the chain: finest level first."""
    centre = arcs.points(0.5 * arcs.length)
    radius = 0.5 * arcs.length
    levels = [(centre, radius)]
    while len(centre) > 2 * RUN:
        heads = np.arange(0, len(centre), RUN)
        middle = np.minimum(heads + RUN // 2, len(centre) - 1)
        gap = centre - np.repeat(centre[middle], RUN, axis=0)[: len(centre)]
        radius = np.maximum.reduceat(np.hypot(gap[:, 0], gap[:, 1]) + radius, heads)
        centre = centre[middle]
        levels.append((centre, radius))
    return levels
