"""Lightening holes placed where there is room: the largest circles that keep a wall from every edge, or a ring of them.

The room round a point is its distance to the nearest edge. It is looked at on a grid and climbed from the best places;
a hole's diameter then follows from the exact distances of its centre, rounded down. So a wall is kept exactly, while
"largest" means the best that the search found.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.synthesis.part.shapes import Opening, disc
from camgeo.synthesis.part.walls import distance_inside
from kin.contour.arcs import Arcs
from kin.contour.nearest import signed_distance
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.recipe.part import Lightening
    from camgeo.synthesis.part.walls import Looks
    from kin.numeric.arrays import Array

GRID = 49  # points of the search each way
STARTS = 12  # places from which the room is climbed
CENTRE, DIAMETER = 0.01, 0.1  # mm: steps of centres and diameters
RINGS = 400  # radii of a ring that are tried
SHRINK = 0.5  # of the step of a climb that finds nothing better
FAR = 1e-9  # mm: covers the rounding of a bound on a distance


@dataclass(frozen=True)
class Placed:
    """How many lightening holes were asked for and placed, and their diameters, mm."""

    asked: int
    diameters: tuple[float, ...]
    wall: float
    exactly: bool

    @property
    def area(self) -> float:
        """Area taken away, mm^2."""
        return 0.25 * math.pi * sum(d * d for d in self.diameters)


def lightened(lightening: Lightening, looks: Looks, there: list[Opening], edge: float) -> tuple[list[Opening], Placed]:
    """Holes in a contour round openings and hub that are there, `edge` more from the contour for its chamfer."""
    room = _Room(looks, there, lightening.wall, edge)
    least = 2.0 * lightening.wall if lightening.least is None else lightening.least
    if lightening.ring is not None:
        found = _ring(room, lightening.ring, lightening.start, least)
    else:
        found = _largest(room, lightening.largest or 0, least)
    asked = lightening.ring or lightening.largest or 0
    holes = [disc(f"lightening hole {k + 1}", "HOLES", centre, 0.5 * d) for k, (centre, d) in enumerate(found)]
    return holes, Placed(asked, tuple(d for _, d in found), lightening.wall, lightening.ring is not None)


Found = list[tuple[tuple[float, float], float]]


class _Room:
    """The radius that a hole about a point can have; grows fuller as holes are added."""

    def __init__(self, looks: Looks, there: list[Opening], wall: float, edge: float) -> None:
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
        """Radius (n,) about points (n, 2), the contour taken as a polygon; negative where there is none."""
        return self.left(points, self.inside(points))

    def inside(self, points: Array) -> Array:
        """Distance of points (n, 2) inside the contour, taken as a polygon, less its chamfer (n,)."""
        return -signed_distance(self.polygon, points) - self.edge

    def left(self, points: Array, inside: Array) -> Array:
        """Radius (n,) that openings, too, leave about points (n, 2) so far inside the contour."""
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
        """The same about one point by the exact contour."""
        inside, _ = distance_inside(self.looks, centre)
        return float(self.left(np.array([centre]), np.array([inside - self.edge]))[0])

    def fill(self, centre: tuple[float, float], diameter: float) -> None:
        """Take the room of a hole."""
        self.discs.append((*centre, 0.5 * diameter))


def _down(value: float, step: float) -> float:
    return round(step * math.floor(value / step + 1e-9), 9)


def _largest(room: _Room, count: int, least: float) -> Found:
    """One after the other the largest circle that still fits."""
    found: Found = []
    low, high = room.ring.min(axis=0), room.ring.max(axis=0)
    x, y = (np.linspace(a, b, GRID) for a, b in zip(low.tolist(), high.tolist(), strict=True))
    grid = np.column_stack([part.ravel() for part in np.meshgrid(x, y)])
    inside = room.inside(grid)
    roomy = room.left(grid, inside) > 0.0
    grid, inside = grid[roomy], inside[roomy]
    pitch = float((high - low).max()) / (GRID - 1)
    for _ in range(count):
        if not grid.size:
            break
        radius = room.left(grid, inside)
        best = _climbed(room, grid[np.argsort(-radius, kind="stable")[:STARTS]], pitch)
        centre = (round(best[0] / CENTRE) * CENTRE, round(best[1] / CENTRE) * CENTRE)
        centre = (round(centre[0], 9), round(centre[1], 9))
        diameter = _down(2.0 * room.exactly(centre), DIAMETER)
        if diameter < least or diameter <= 0.0:
            break
        found.append((centre, diameter))
        room.fill(centre, diameter)
    return found


def _climbed(room: _Room, points: Array, step: float) -> tuple[float, float]:
    """Climb the room from points (n, 2) in eight directions, each by its own steps; the best place reached."""
    turns = np.arange(8) * 0.25 * np.pi
    ways = np.column_stack([np.cos(turns), np.sin(turns)])
    height, steps = room.about(points), np.full(len(points), step)
    while (left := np.flatnonzero(steps > 0.2 * CENTRE)).size:
        tried = points[left, None, :] + steps[left, None, None] * ways
        heights = room.about(tried.reshape(-1, 2)).reshape(left.size, -1)
        best = np.arange(left.size), heights.argmax(axis=1)
        better = heights[best] > height[left]
        moved = left[better]
        points[moved], height[moved] = tried[best][better], heights[best][better]
        steps[left[~better]] *= SHRINK
    x, y = points[int(np.argmax(height))].tolist()
    return x, y


def _ring(room: _Room, count: int, start: float, least: float) -> Found:
    """Equal holes at equal angles, on the circle on which they are largest."""
    angle = start + 2.0 * np.pi * np.arange(count) / count
    u = np.column_stack([np.cos(angle), np.sin(angle)])
    reach = float(np.hypot(room.ring[:, 0], room.ring[:, 1]).max())
    between = math.sin(math.pi / count)

    def size(radii: Array) -> Array:
        about = room.about((radii[:, None, None] * u).reshape(-1, 2)).reshape(len(radii), count).min(axis=1)
        equal: Array = np.minimum(about, radii * between - 0.5 * room.wall)
        return equal

    low, high = 0.0, reach
    for _ in range(4):
        radii = np.linspace(low, high, RINGS)
        best = int(np.argmax(size(radii)))
        low, high = float(radii[max(best - 1, 0)]), float(radii[min(best + 1, RINGS - 1)])
    radius = round(round(float(radii[best]) / CENTRE) * CENTRE, 9)
    centres = [(radius * float(x), radius * float(y)) for x, y in u]
    fits = min([*(room.exactly(centre) for centre in centres), radius * between - 0.5 * room.wall])
    diameter = _down(2.0 * fits, DIAMETER)
    if diameter < least or diameter <= 0.0:
        return []
    return [(centre, diameter) for centre in centres]
