"""What is missing of a flank where it changes from one part of it to another, as an undercut that is cut off has it.

There the angle of the worst place jumps along an edge, and strips of one angle do not follow the flank. Triangles are
judged by the best of their corners' angles instead, and halved where that does not settle them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.cylindrical.edges import Peak
from kin.cylindrical.grid import FINE
from kin.numeric.arrays import paired

if TYPE_CHECKING:
    from kin.cylindrical.faces import Body
    from kin.cylindrical.roller import Gauge, Worst
    from kin.numeric.arrays import Array, Indices, Mask

PARTINGS = 24  # of a triangle, at most
MOST = 100_000  # triangles that may stay open
FAR = 3.0  # times the tolerance: what is so far off need not be known more closely


def triangles_at(body: Body, own: Mask, torn: tuple[Indices, Indices]) -> Indices:
    """Corners (n, 3) of those of the marked triangles (t,) that lie along some edges, given by their ends."""
    size = len(body.points)
    codes = np.sort(paired(np.minimum(*torn), np.maximum(*torn), size))
    corners = body.corners[own]
    beside = np.zeros(len(corners), dtype=np.bool_)
    for k in range(3):
        a, b = corners[:, k], corners[:, k - 2]
        beside |= np.isin(paired(np.minimum(a, b), np.maximum(a, b), size), codes)
    return corners[beside]


def missing(gauge: Gauge, points: Array, theta: Array, known: Peak, tolerance: float) -> Peak:
    """Greatest distance of a flank's surface into the metal, mm, with that of triangles along torn edges.

    They are given by their corners (n, 3, 3) and the worst angles of these (n, 3); `known` is the distance of all
    others. Bounds are sharp to a share of the tolerance, mm, where that can be had.
    """
    value, at, bound = known.value, known.at, known.value + known.remainder
    for parting in range(PARTINGS + 1):
        bounds = np.min([_farthest(gauge, points, theta[:, k]) for k in range(3)], axis=0)
        open_ = bounds > value + FINE * tolerance
        bound = max(bound, float(bounds[~open_].max(initial=bound)))
        if not open_.any():
            break
        if parting == PARTINGS or value > FAR * tolerance or np.count_nonzero(open_) > MOST:
            bound = max(bound, float(bounds.max()))
            break
        points, theta, worst = _halved(gauge, points[open_], theta[open_])
        best = int(np.argmax(worst.distance))
        if worst.distance[best] > value:
            value, at = float(worst.distance[best]), float(worst.theta[best])
    return Peak(value, at, max(bound - value, 0.0))


def _farthest(gauge: Gauge, points: Array, theta: Array) -> Array:
    """Greatest distance (n,) of triangles' corners (n, 3, 3) from the roller at one angle of each (n,), mm."""
    farthest: Array = gauge.away(points.reshape(-1, 3), np.repeat(theta, 3)).reshape(-1, 3).max(axis=1)
    return farthest


def _halved(gauge: Gauge, points: Array, theta: Array) -> tuple[Array, Array, Worst]:
    """Both halves of each of the triangles (n, 3, 3), with their corners' angles, and the middles they are parted at.

    The side that is parted is the longest one seen along the roller: how long it is beside that costs nothing.
    """
    rows = np.arange(len(points))
    ways = np.roll(points, -1, axis=1) - points
    along = ways[..., 0] * np.cos(theta[:, :1]) + ways[..., 1] * np.sin(theta[:, :1])
    first = np.argmax(np.einsum("nkx,nkx->nk", ways, ways) - along**2, axis=1)
    last = (first + 1) % 3
    middle = 0.5 * (points[rows, first] + points[rows, last])
    worst = gauge.worst(middle, theta[rows, first])
    halves, angles = [], []
    for corner in (first, last):
        half, own = points.copy(), theta.copy()
        half[rows, corner], own[rows, corner] = middle, worst.theta
        halves.append(half)
        angles.append(own)
    return np.concatenate(halves), np.concatenate(angles), worst
