"""Parts with a hub, a chamfer, a set screw or an engraved mark as binary STL, made of prisms by manifold3d.

Every outline is a polygon in single precision before bodies are joined, and planes are horizontal or vertical, so that
almost all corners of the result are numbers that an STL holds; only where a set screw's hole meets a round wall are new
ones rounded. manifold3d computes in double precision. What it returns is checked once more as it is written.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.files.missing import MissingExtraError
from camgeo.files.stl import RECORD, StlFacts, bore_polygon, fit_tolerance, rounded, rounded_loop, save, within
from camgeo.files.triangulate import RegionError, disc
from camgeo.fit.pieces import Bound, Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.files.stl import Records
    from camgeo.files.triangulate import Array, Triangles
    from camgeo.fit.pieces import ArcSpline

BEYOND = 1.0  # mm by which what cuts reaches out of what is cut


@dataclass(frozen=True)
class Cut:
    """A closed outline cut from z `low` to `high`, mm."""

    outline: ArcSpline
    low: float
    high: float


@dataclass(frozen=True)
class Drill:
    """A radial hole of this diameter in direction `at`, its axis at z, from the shaft out to `reach`.

    `slope` is the sine of the least angle at which its sides meet the bore.
    """

    at: float
    diameter: float
    z: float
    reach: float
    slope: float = 1.0


@dataclass(frozen=True)
class Solid:
    """A disc from z = 0 to `thickness` with a round hub from `low` to `high` and what is cut out of both; mm."""

    thickness: float
    low: float
    high: float
    hub: float | None
    chamfer: float | None
    cuts: Sequence[Cut]
    drill: Drill | None


def write_solid(path: Path, polygon: Polygon, solid: Solid, *, tolerance: float, about: str = "") -> StlFacts:
    """Write the solid over a polygon as a closed, oriented mesh; see the module.

    With a chamfer the polygon is taken to be fitted finely enough that its parallel inside is within the tolerance too.
    Raises MissingExtraError without manifold3d, ToleranceError where the tolerance cannot be held in single precision,
    RegionError where an outline is not simple or the chamfer too wide for the contour; OSError as the file system does.
    """
    try:
        import manifold3d
    except ImportError as error:
        message = "a hub, a chamfer, a set screw and an engraved mark need manifold3d: pip install 'camgeo[solid]'"
        raise MissingExtraError(message) from error

    outer, moved = rounded(polygon.vertices)
    kept = np.any(outer != np.roll(outer, 1, axis=0), axis=1)
    outer = outer[kept]
    bound = polygon.bound.widened(moved)
    within("the contour", bound.worst, tolerance)
    for height in (solid.thickness, solid.low, solid.high, solid.chamfer or 0.0):
        within("a height", abs(float(np.float32(height)) - height), tolerance)

    def body(mesh: tuple[Array, Triangles]) -> Any:  # noqa: ANN401 - manifold3d has no types
        points, triangles = mesh
        made = manifold3d.Manifold(manifold3d.Mesh64(points, triangles.astype(np.uint64)))
        if made.status() != manifold3d.Error.NoError:
            raise RegionError(f"a body is not sound: {made.status().name}")
        return made

    # a corner between two walls that are off by e each is off by up to 2 e over the sine of its angle
    fine = tolerance if solid.drill is None else 0.5 * tolerance * solid.drill.slope
    part = body(_disc(outer, solid.thickness, solid.chamfer))
    off = 0.0
    if solid.hub is not None:
        circle, straddle = bore_polygon(solid.hub, fit_tolerance(fine, 0.5 * solid.hub))
        ring, ring_moved = rounded(circle)
        off, moved = max(off, straddle + ring_moved), max(moved, ring_moved)
        # the hub begins inside the disc, so that no two faces lie on each other
        low = solid.low if solid.low < 0.0 else 0.5 * solid.thickness
        high = solid.high if solid.high > solid.thickness else 0.5 * solid.thickness
        part += body(prism(ring, low, high))
    for cut in solid.cuts:
        loop, loop_off, loop_moved = rounded_loop(
            cut.outline, fine if cut.high > solid.thickness or cut.low < 0.0 else tolerance
        )
        off, moved = max(off, loop_off), max(moved, loop_moved)
        low = cut.low - BEYOND if cut.low <= solid.low else cut.low
        part -= body(prism(loop, low, cut.high + BEYOND))
    if solid.drill is not None:
        part -= body(_drill(solid.drill, fine))
    mesh = part.to_mesh64()
    triangles = np.asarray(mesh.tri_verts, dtype=np.int64)
    points, _ = rounded(np.asarray(mesh.vert_properties, dtype=np.float64)[:, :3])
    records = _records(points, triangles)
    save(path, records, about)
    return StlFacts(len(records), len(outer), 0, int(np.count_nonzero(~kept)), moved, bound, Bound(off, off))


def prism(loop: Array, low: float, high: float) -> tuple[Array, Triangles]:
    """Points (2 n, 3) and triangles of the prism over a counter-clockwise loop (n, 2)."""
    return _stacked([(loop, low), (loop, high)], disc(loop))


def _disc(outer: Array, thickness: float, chamfer: float | None) -> tuple[Array, Triangles]:
    """The disc over a rounded contour, its edges chamfered by parallels of the polygon itself: every facet is plane."""
    if chamfer is None:
        return prism(outer, 0.0, thickness)
    inner, _ = rounded(inset(outer, chamfer))
    layers = [(inner, 0.0), (outer, chamfer), (outer, thickness - chamfer), (inner, thickness)]
    return _stacked(layers, disc(inner))


def inset(loop: Array, distance: float) -> Array:
    """Polygon whose edges lie `distance` inside those of a counter-clockwise loop (n, 2), vertex for vertex.

    Raises RegionError where an edge would vanish.
    """
    edge = np.roll(loop, -1, axis=0) - loop
    along = edge / np.hypot(edge[:, 0], edge[:, 1])[:, None]
    outward = np.column_stack([along[:, 1], -along[:, 0]])
    before = np.roll(outward, 1, axis=0)
    share = 1.0 + np.sum(outward * before, axis=1)
    moved: Array = loop - distance * (outward + before) / share[:, None]
    step = np.roll(moved, -1, axis=0) - moved
    if bool((np.sum(step * along, axis=1) <= 0.0).any()):
        raise RegionError(f"the contour is too sharp for a chamfer of {distance:.6g} mm")
    return moved


def _stacked(layers: list[tuple[Array, float]], lid: Triangles) -> tuple[Array, Triangles]:
    """Body between loops of equally many vertices at rising heights; `lid` triangulates the first and the last."""
    n = len(layers[0][0])
    points = np.concatenate([np.column_stack([loop, np.full(n, float(np.float32(z)))]) for loop, z in layers])
    here = np.arange(n)
    following = np.roll(here, -1)
    faces = [lid[:, ::-1], lid + (len(layers) - 1) * n]
    for k in range(len(layers) - 1):
        a, b = k * n, (k + 1) * n
        faces.append(np.column_stack((here + a, following + a, following + b)))
        faces.append(np.column_stack((here + a, following + b, here + b)))
    return points, np.concatenate(faces)


def _drill(drill: Drill, tolerance: float) -> tuple[Array, Triangles]:
    """Cylinder along a radius, from the shaft outward: a prism over its circle, laid down."""
    circle, _ = bore_polygon(drill.diameter, fit_tolerance(tolerance, drill.reach))
    points, triangles = prism(circle.astype(np.float32).astype(np.float64), 0.0, 1.0)
    across, up, along = points[:, 0], points[:, 1], drill.reach * points[:, 2]
    c, s = math.cos(drill.at), math.sin(drill.at)
    # across to the left of the radius, up, along it: a right-handed turn of the prism's own axes
    return np.column_stack([along * c - across * s, along * s + across * c, up + drill.z]), triangles


def _records(points: Array, triangles: Triangles) -> Records:
    """STL records of a mesh whose points (n, 3) are in single precision.

    Triangles whose corners rounding has made one are left out: their neighbours then meet. Raises RegionError where
    what is left is not closed or a triangle has no area.
    """
    points, number = np.unique(points, axis=0, return_inverse=True)
    corners = number.reshape(-1)[triangles]
    a, b, c = corners.T
    corners = corners[(a != b) & (b != c) & (c != a)]
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    way, back = np.sort(start * len(points) + end), np.sort(end * len(points) + start)
    if not np.array_equal(way, back) or bool((way[1:] == way[:-1]).any()):
        raise RegionError("the solid does not close in single precision")
    corner = points[corners]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    size = np.sqrt(np.sum(normal * normal, axis=1))
    if bool((size == 0.0).any()):
        raise RegionError("a triangle of the solid has no area in single precision")
    records = np.zeros(len(corners), dtype=RECORD)
    records["normal"] = normal / size[:, None]
    records["vertices"] = corner
    return records
