"""The convex hull of a set of points, for sets of 1e5 and more: whole passes on arrays, then a short repair."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import cross

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices

# A pass over the whole chain pays while it removes more than this share of the points that are left.
WORTHWHILE_SHARE = 0.02


def is_convex_polygon(points: Array) -> bool:
    """Whether the closed polygon (n, 2) is strictly convex, counter-clockwise and goes round once."""
    if points.shape[0] < 3:
        return False
    edge = np.roll(points, -1, axis=0) - points
    turn = cross(edge, np.roll(edge, -1, axis=0))
    if not bool((turn > 0.0).all()):
        return False
    # Turning left everywhere, it goes round as often as its edges begin to rise.
    upward = (edge[:, 1] > 0.0) | ((edge[:, 1] == 0.0) & (edge[:, 0] > 0.0))
    return bool(np.count_nonzero(upward & ~np.roll(upward, 1)) == 1)


def convex_hull(points: Array) -> Indices:
    """Indices (h,) of the hull's corners among points (n, 2), counter-clockwise from the leftmost; no three in line.

    Fewer than three distinct points are all returned. Andrew's monotone chain. A point on or inside the chord of its
    neighbours in the sorted chain is no corner, so all such points may go at once: whole passes as long as they pay,
    then point by point from where the last pass stopped.
    """
    order = np.lexsort((points[:, 1], points[:, 0]))
    same = np.concatenate([[False], (points[order[1:]] == points[order[:-1]]).all(axis=1)])
    distinct: Indices = order[~same]
    if distinct.size < 3:
        return distinct
    return np.concatenate([chain(points, distinct)[:-1], chain(points, distinct[::-1])[:-1]])


def chain(points: Array, order: Indices) -> Indices:
    """Indices, out of the sorted `order` (m,) of points (n, 2), that remain once each right turn is dropped.

    The chain through them turns left at every inner point: it is one half of the convex hull.
    """
    kept: Indices = order
    while kept.size > 2:
        p = points[kept]
        edge = np.diff(p, axis=0)
        keep = np.ones(kept.size, dtype=bool)
        keep[1:-1] = cross(edge[:-1], edge[1:]) > 0.0
        gone = kept.size - int(np.count_nonzero(keep))
        if gone == 0:
            return kept
        kept = kept[keep]
        if gone < WORTHWHILE_SHARE * kept.size:
            return repaired(points, kept)
    return kept


def repaired(points: Array, order: Indices) -> Indices:
    """Indices out of `order` (m,) that remain once each right turn is dropped, point by point.

    It suits the few right turns that whole passes leave: after each dropped point its neighbours are looked at again.
    """
    p = points[order]
    edge = np.diff(p, axis=0)
    wrong = np.flatnonzero(cross(edge[:-1], edge[1:]) <= 0.0) + 1
    if not wrong.size:
        return order
    x, y = p[:, 0].tolist(), p[:, 1].tolist()
    last = order.size - 1
    before, after = list(range(-1, last)), list(range(1, last + 2))
    alive = [True] * (last + 1)
    stack = wrong[::-1].tolist()
    while stack:
        i = stack.pop()
        if not alive[i] or i in (0, last):
            continue
        j, k = before[i], after[i]
        if (x[i] - x[j]) * (y[k] - y[i]) - (y[i] - y[j]) * (x[k] - x[i]) <= 0.0:
            alive[i] = False
            after[j], before[k] = k, j
            stack += (k, j)
    kept: Indices = order[np.array(alive)]
    return kept
