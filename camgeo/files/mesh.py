"""Closed surfaces of triangles, before they are a file of any format."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.errors import RegionError
from kin.numeric.arrays import paired
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.files.precision import Precision
    from camgeo.files.triangulate import Triangles
    from camgeo.fit.bound import Bound
    from kin.numeric.arrays import Array, Indices


@dataclass(frozen=True, eq=False)
class Mesh:
    """A solid's surface: points (v, 3), mm, and triangles (t, 3), counter-clockwise seen from outside."""

    points: Array
    triangles: Triangles

    @property
    def area_vectors(self) -> Array:
        """Twice the area of each triangle times its outward normal, mm^2, (t, 3)."""
        a, b, c = (np.take(self.points, corner, axis=0).T for corner in self.triangles.T)
        (ux, uy, uz), (vx, vy, vz) = b - a, c - a
        return np.column_stack((uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx))

    @property
    def volume(self) -> float:
        """Enclosed volume, mm^3, by the divergence theorem."""
        return float(np.sum(self.points[self.triangles[:, 0]] * self.area_vectors)) / 6.0


class Building:
    """Points and triangles of a body under construction, with the greatest shift of a point by rounding, mm."""

    def __init__(self, precision: Precision) -> None:
        """Points are rounded to the `precision` of a file."""
        self.precision = precision
        self.points: list[Array] = []
        self.triangles: list[Triangles] = []
        self.count, self.moved = 0, 0.0

    def add(self, points: Array) -> Indices:
        """Numbers of new points (n, 3), rounded as the file has them."""
        if not len(points):
            return np.zeros(0, dtype=np.intp)
        rounded, moved = self.precision.rounded(points)
        self.moved = max(self.moved, moved)
        self.points.append(rounded)
        self.count += len(points)
        return np.arange(self.count - len(points), self.count)

    def mesh(self, noun: str, *, mirrored: bool) -> Mesh:
        """The mesh, `mirrored` (y -> -y) on demand; RegionError, with the `noun`, for a triangle without area."""
        points, triangles = np.concatenate(self.points), np.concatenate(self.triangles)
        if mirrored:
            points = points * np.array([1.0, -1.0, 1.0]) + 0.0
            triangles = triangles[:, ::-1]
        mesh = Mesh(points, triangles)
        if not bool(mesh.area_vectors.any(axis=1).all()):
            raise RegionError(f"a triangle of the {noun} has no area in {self.precision.name}")
        return mesh


@dataclass(frozen=True, eq=False)
class Item:
    """A named mesh and its place (4, 3): the images of the three axes, and of the origin, mm.

    None leaves the mesh in its own axes.
    """

    name: str
    mesh: Mesh
    place: Array | None = None


@dataclass(frozen=True)
class MeshFacts:
    """Facts on the contours in a mesh: their number of `vertices`, and the `bound` of their distance from exact ones.

    `displacement` is the greatest distance, mm, by which rounding moved a vertex of any outline; `bound` includes it.
    """

    vertices: int
    displacement: float
    bound: Bound


def closed_mesh(points: Array, triangles: Triangles, precision: Precision) -> Mesh:
    """Mesh of points (v, 3), mm, rounded here and without duplicates, checked to be closed.

    Triangles with corners that rounding merges are left out: their neighbours then meet. Raises RegionError where the
    mesh is not closed or a triangle has no area.
    """
    points, _ = precision.rounded(points)
    points, number = np.unique(points, axis=0, return_inverse=True)
    corners = number.reshape(-1)[triangles]
    a, b, c = corners.T
    corners = corners[(a != b) & (b != c) & (c != a)]
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    way, back = (np.sort(paired(*ends, len(points))) for ends in ((start, end), (end, start)))
    if not np.array_equal(way, back) or bool((way[1:] == way[:-1]).any()):
        raise RegionError(f"the solid does not close in {precision.name}")
    mesh = Mesh(points, corners)
    if not bool(mesh.area_vectors.any(axis=1).all()):
        raise RegionError(f"a triangle of the solid has no area in {precision.name}")
    return mesh
