"""How far a mesh is from the outline of a bore, seen along the axis."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.contour.arcs import Arcs
from kin.contour.holes import farthest
from kin.contour.nearest import nearest

if TYPE_CHECKING:
    from kin.contour.holes import Hole
    from kin.numeric.arrays import Array, Indices

FINE = 1e-2  # of the tolerance, to which edges are measured


def corners_off_bore(bore: Hole, points: Array, blank: float) -> Array:
    """Distances (n,), mm, of corners (n, 3), mm, from the outline of a bore in a blank of a radius, mm, seen along z.

    They are infinite for corners that are nearer to the blank than to any part of the bore.
    """
    r, reach = np.hypot(points[:, 0], points[:, 1]), float(np.abs(bore.contour.box).max()) * math.sqrt(2.0)
    near = r <= reach + 0.5 * (blank - reach)
    off = np.full(len(r), np.inf)
    off[near] = _off(bore, points[near, :2])
    return off


def inside_off_bore(bore: Hole, triangles: Array) -> Array:
    """Greatest distances (t,), mm, of middles of sides and of triangles (t, 3, 3), mm, from the outline of a bore."""
    off = _off(bore, middles(triangles[..., :2]).reshape(-1, 2))
    return np.asarray(off.reshape(-1, 4).max(axis=1, initial=0.0))


def middles(triangles: Array) -> Array:
    """Middles (t, 4, k) of the sides and of the whole of triangles (t, 3, k)."""
    sides = 0.5 * (triangles + np.roll(triangles, -1, axis=1))
    return np.concatenate([sides, triangles.mean(axis=1, keepdims=True)], axis=1)


def _off(bore: Hole, points: Array) -> Array:
    """Distances (n,), mm, of points (n, 2), mm, from the outline of a bore; many may be the same."""
    distinct, number = _once(points)
    off: Array = nearest(bore.contour.as_arcs()[0], distinct)[1][number]
    return off


def edges_off_bore(bore: Hole, start: Array, last: Array, tolerance: float) -> float:
    """Greatest distance, mm, of edges by their ends (n, 2), mm, from the outline of a bore.

    It is found to within FINE of the tolerance, mm. Edges along the axis have no length here and count nothing.
    """
    back = (start[:, 0] > last[:, 0]) | ((start[:, 0] == last[:, 0]) & (start[:, 1] > last[:, 1]))
    pairs = np.where(back[:, None], np.hstack([last, start]), np.hstack([start, last]))
    pairs, _ = _once(pairs[(pairs[:, :2] != pairs[:, 2:]).any(axis=1)])
    if not len(pairs):
        return 0.0
    way = pairs[:, 2:] - pairs[:, :2]
    length = np.hypot(way[:, 0], way[:, 1])
    lines = Arcs(pairs[:, :2], way / length[:, None], np.zeros(len(length)), length)
    outline = bore.contour.as_arcs()[0]
    return farthest(lines, outline, float(np.abs(outline.curvature).max()), FINE * tolerance)


def _once(rows: Array) -> tuple[Array, Indices]:
    """Rows (k, m) each once, and the number among them of each of the rows (n, m)."""
    order = np.lexsort(rows.T)
    rising = rows[order]
    new = np.ones(len(rows), dtype=np.bool_)
    new[1:] = (rising[1:] != rising[:-1]).any(axis=1)
    number = np.empty(len(rows), dtype=np.intp)
    number[order] = np.cumsum(new) - 1
    return rising[new], number
