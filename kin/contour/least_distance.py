"""How deep a cutter's path comes into an edge that it is to leave: its least distance from a chain of arcs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.contour.intersections import boxes, overlapping
from kin.contour.nearest import signed_distance
from kin.contour.region import gaps

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.numeric.arrays import Array

LOOKS = 40  # halvings of a path that is held against a contour


def least_distance(arcs: Arcs, chain: Arcs, side: float, radius: float, tolerance: float) -> tuple[float, Array]:
    """Least distance of a path outside (side 1) or inside (-1) a chain, and where; sharp below the radius.

    A path that keeps clear of the chain is measured piece against piece, in closed form: one that runs beside it would
    have to be halved without end. Of one that meets it the depth is found within a hundredth.
    """
    arcs, chain = _bent_little(arcs), _bent_little(chain)
    middle = arcs.points(0.5 * arcs.length)
    distance = side * signed_distance(chain, middle)
    low = int(np.argmin(distance))
    best, place = float(distance[low]), middle[low]
    near = distance - 0.5 * arcs.length < min(best, radius)
    if best <= 0.0:
        return _deepest(arcs.take(near), chain, side, radius, tolerance)
    beside, where = _beside(arcs.take(near), chain, min(best, radius)) if near.any() else (np.inf, place)
    if beside == 0.0:
        return _deepest(arcs.take(near), chain, side, radius, tolerance)
    return (beside, where) if beside < best else (best, place)


def _bent_little(arcs: Arcs) -> Arcs:
    """The pieces cut so that none turns by more than a quarter of a turn."""
    turn = np.abs(arcs.curvature) * arcs.length
    return arcs.cut(np.maximum(np.ceil(turn / (0.5 * np.pi)), 1.0).astype(np.intp))[0]


def _beside(arcs: Arcs, chain: Arcs, reach: float) -> tuple[float, Array]:
    """Least distance below `reach` of pieces from a chain, and where; infinite without any."""
    grown = [(low - reach, high + reach) for low, high in boxes(arcs)]
    best, place = np.inf, arcs.start[0]
    for i, j in overlapping(grown, boxes(chain), mirrored=False):
        first, other = arcs.take(i), chain.take(j)
        away = first.points(0.5 * first.length) - other.points(0.5 * other.length)
        near = np.hypot(away[:, 0], away[:, 1]) - 0.5 * (first.length + other.length) < min(best, reach)
        if near.any():
            apart = gaps(first.take(near), other.take(near))
            k = int(np.argmin(apart.distance))
            if apart.distance[k] < best:
                best, place = float(apart.distance[k]), apart.first[k]
    return best, place


def _deepest(arcs: Arcs, chain: Arcs, side: float, radius: float, tolerance: float) -> tuple[float, Array]:
    """Least distance of a path that meets the chain or lies beyond it, and where.

    A piece no point of which can come nearer than the nearest found, or than the radius, by a hundredth of the
    tolerance or of the depth needs no closer look. Where some still do after all looks, the least is what they cannot
    come below.
    """
    best, place, floor = np.inf, arcs.start[0], np.inf
    for _ in range(LOOKS):
        middle = arcs.points(0.5 * arcs.length)
        distance = side * signed_distance(chain, middle)
        low = int(np.argmin(distance))
        if distance[low] < best:
            best, place = float(distance[low]), middle[low]
        bound = distance - 0.5 * arcs.length
        near = bound < min(best, radius) - 0.01 * max(tolerance, radius - best)
        if not near.any():
            return best, place
        floor = float(bound.min())
        arcs = arcs.take(near)
        arcs, _ = arcs.cut(np.full(len(arcs), 2, dtype=np.intp))
    return min(best, floor), place
