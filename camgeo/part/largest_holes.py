"""Search for lightening holes: the largest circles that keep a wall from every edge, or a ring of them.

The space round a point is its distance from the nearest edge. It is computed on a grid, and climbed from the best
places; a hole's diameter then follows from the exact distances of its centre, rounded down. So a wall is kept exactly,
while "largest" means the largest that the search found.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.part.walls import distance_inside
from kin.contour.arcs import Arcs
from kin.contour.nearest import signed_distance

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.part.shapes import Opening
    from camgeo.part.walls import Looks
    from kin.numeric.arrays import Array

GRID = 37  # points of the grid in each direction
STARTS = 12  # places from which the search climbs
CENTRE, DIAMETER = 0.01, 0.1  # mm: steps of centres and diameters
RINGS = 400  # radii of a ring that are tried
SHORT = 0.25  # of the step of a climb: the short step, tried beside the long one
SHRINK = 0.125  # factor of the step of a climb where neither step leads higher
FAR = 1e-9  # mm: covers the rounding of a bound on a distance


Circles = list[tuple[tuple[float, float], float]]
"""Centres and diameters of holes, mm."""


class Space:
    """Free space for round holes within a contour, beside the openings `there`; it shrinks as holes are added.

    `wall`, mm, is left to every edge; `edge`, mm, is what a chamfer takes along the contour.
    """

    def __init__(self, looks: Looks, there: Sequence[Opening], wall: float, edge: float) -> None:
        self.looks, self.wall, self.edge = looks, wall, edge
        self.shapes = [opening for opening in there if opening.circle is None]
        self.discs = [(*opening.circle[0], opening.circle[1]) for opening in there if opening.circle is not None]
        self.ring = looks.first.point
        step = np.roll(self.ring, -1, axis=0) - self.ring
        length = np.hypot(step[:, 0], step[:, 1])
        kept = length > 0.0
        tangent = step[kept] / length[kept, None]
        self.polygon = Arcs(self.ring[kept], tangent, np.zeros(int(kept.sum())), length[kept])

    def about(self, points: Array) -> Array:
        """Radius (n,), mm, that a hole about points (n, 2), mm, can have; negative where none fits.

        The contour is taken as a polygon.
        """
        return self.left(points, self.inside(points))

    def inside(self, points: Array) -> Array:
        """Distance (n,), mm, of points (n, 2) inside the contour, taken as a polygon, less its chamfer."""
        return -signed_distance(self.polygon, points) - self.edge

    def left(self, points: Array, inside: Array) -> Array:
        """Radius (n,), mm, that a hole about points (n, 2) can have between contour and openings, less the wall.

        `inside` (n,) is the distance of the points inside the contour, mm.
        """
        least = inside.copy()
        for x, y, radius in self.discs:
            least = np.minimum(least, np.hypot(points[:, 0] - x, points[:, 1] - y) - radius)
        for shape in self.shapes:
            away = np.hypot(*(points - shape.middle).T) - shape.radius - FAR
            near = np.flatnonzero(away < least)
            if near.size:
                least[near] = np.minimum(least[near], signed_distance(shape.chain, points[near]))
        return least - self.wall

    def exactly(self, centre: tuple[float, float]) -> float:
        """Radius, mm, that a hole about one centre (x, y) can have by the exact contour; negative where none fits."""
        inside, _ = distance_inside(self.looks, centre)
        return float(self.left(np.array([centre]), np.array([inside - self.edge]))[0])

    def fill(self, centre: tuple[float, float], diameter: float) -> None:
        """Add a hole of a diameter about a centre (x, y), mm, so that later ones keep their wall from it."""
        self.discs.append((*centre, 0.5 * diameter))


def _down(value: float, step: float) -> float:
    return round(step * math.floor(value / step + 1e-9), 9)


def largest(space: Space, count: int, least: float) -> Circles:
    """Centres and diameters, mm, of at most `count` holes, each the largest that still fits after those before it.

    None has a diameter below `least`, mm; fewer come back where no such hole fits.
    """
    circles: Circles = []
    low, high = space.ring.min(axis=0), space.ring.max(axis=0)
    x, y = (np.linspace(a, b, GRID) for a, b in zip(low.tolist(), high.tolist(), strict=True))
    grid = np.column_stack([part.ravel() for part in np.meshgrid(x, y)])
    inside = space.inside(grid)
    # points without space are left out once: space only shrinks
    free = space.left(grid, inside) > 0.0
    grid, inside = grid[free], inside[free]
    pitch = float((high - low).max()) / (GRID - 1)
    for _ in range(count):
        if not grid.size:
            break
        radius = space.left(grid, inside)
        best = _climbed(space, grid[np.argsort(-radius, kind="stable")[:STARTS]], pitch)
        centre = (round(best[0] / CENTRE) * CENTRE, round(best[1] / CENTRE) * CENTRE)
        centre = (round(centre[0], 9), round(centre[1], 9))
        diameter = _down(2.0 * space.exactly(centre), DIAMETER)
        if diameter < least:
            break
        circles.append((centre, diameter))
        space.fill(centre, diameter)
    return circles


def _climbed(space: Space, points: Array, step: float) -> tuple[float, float]:
    """Best place (x, y), mm, that climbs of the space from points (n, 2) reach.

    They climb by long and short steps in eight directions; `step`, mm, is the first long step. The array of points is
    overwritten.
    """
    turns = np.arange(16) * 0.25 * np.pi
    share = np.repeat([1.0, SHORT], 8)
    ways = share[:, None] * np.column_stack([np.cos(turns), np.sin(turns)])
    height, steps = space.about(points), np.full(len(points), step)
    while (left := np.flatnonzero(steps > 0.2 * CENTRE)).size:
        tried = points[left, None, :] + steps[left, None, None] * ways
        heights = space.about(tried.reshape(-1, 2)).reshape(left.size, -1)
        best = np.arange(left.size), heights.argmax(axis=1)
        better = heights[best] > height[left]
        moved = left[better]
        points[moved], height[moved] = tried[best][better], heights[best][better]
        steps[moved] *= share[best[1][better]]
        steps[left[~better]] *= SHRINK
    x, y = points[int(np.argmax(height))].tolist()
    return x, y


def ring(space: Space, count: int, start: float, least: float) -> Circles:
    """Centres and diameter of `count` equal holes at equal angles, on the circle on which they are largest.

    The first is at the angle `start`, rad. Empty where their diameter would be below `least`, mm.
    """
    angle = start + 2.0 * np.pi * np.arange(count) / count
    u = np.column_stack([np.cos(angle), np.sin(angle)])
    reach = float(np.hypot(space.ring[:, 0], space.ring[:, 1]).max())
    between = math.sin(math.pi / count)

    def size(radii: Array) -> Array:
        about = space.about((radii[:, None, None] * u).reshape(-1, 2)).reshape(len(radii), count).min(axis=1)
        equal: Array = np.minimum(about, radii * between - 0.5 * space.wall)
        return equal

    # the best radius of the circle, looked for four times over a range that narrows about it
    low, high = 0.0, reach
    for _ in range(4):
        radii = np.linspace(low, high, RINGS)
        best = int(np.argmax(size(radii)))
        low, high = float(radii[max(best - 1, 0)]), float(radii[min(best + 1, RINGS - 1)])
    radius = round(round(float(radii[best]) / CENTRE) * CENTRE, 9)
    centres = [(radius * float(x), radius * float(y)) for x, y in u]
    fits = min([*(space.exactly(centre) for centre in centres), radius * between - 0.5 * space.wall])
    diameter = _down(2.0 * fits, DIAMETER)
    if diameter < least:
        return []
    return [(centre, diameter) for centre in centres]
