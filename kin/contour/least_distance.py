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

LOOKS = 40  # halvings of a path


def least_distance(arcs: Arcs, chain: Arcs, side: float, radius: float, tolerance: float) -> tuple[float, Array]:
    """Least signed distance, mm, of a path `arcs` from a closed counter-clockwise chain, and its place (2,).

    `side` is 1 for a path outside, -1 for one inside; the distance is negative on the wrong side. From `radius`, mm, on
    it may be too large: such a path keeps clear. A path that does not meet the chain is measured piece against piece,
    in closed form: one that runs beside it would have to be halved without end. Where it meets the chain, the distance
    is found to a hundredth of `tolerance`, mm, or of radius less distance, whichever is greater.
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
    """Least distance of pieces from a chain, where below `reach`, and its place (2,); else infinite and any place."""
    grown = [(low - reach, high + reach) for low, high in boxes(arcs)]
    best, place = np.inf, arcs.start[0]
    for i, j in overlapping(grown, boxes(chain), mirrored=False):
        first, second = arcs.take(i), chain.take(j)
        away = first.points(0.5 * first.length) - second.points(0.5 * second.length)
        near = np.hypot(away[:, 0], away[:, 1]) - 0.5 * (first.length + second.length) < min(best, reach)
        if near.any():
            apart = gaps(first.take(near), second.take(near))
            k = int(np.argmin(apart.distance))
            if apart.distance[k] < best:
                best, place = float(apart.distance[k]), apart.first[k]
    return best, place


def _deepest(arcs: Arcs, chain: Arcs, side: float, radius: float, tolerance: float) -> tuple[float, Array]:
    """Least signed distance of a path that meets the chain or lies beyond it, and its place (2,).

    A piece is halved only if a point of it can come nearer than the nearest so far, and than the radius, by a hundredth
    of the tolerance or of the depth. Where pieces are left after all halvings, their lower bound is the result.
    """
    best, place, lower = np.inf, arcs.start[0], np.inf
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
        lower = float(bound.min())
        arcs = arcs.take(near)
        arcs, _ = arcs.cut(np.full(len(arcs), 2, dtype=np.intp))
    return min(best, lower), place
