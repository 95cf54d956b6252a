"""Parts with a boss, chamfered edges, cross holes or engravings as meshes, made of prisms by manifold3d.

Every outline is a polygon of numbers that the file holds before bodies are joined, and planes are horizontal or
vertical, so that almost all corners of the result are such numbers; only where a cross hole meets a round wall
are new ones rounded. manifold3d computes in double precision. What it returns is checked once more after rounding.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.files.errors import RegionError, demand_package
from camgeo.files.mesh import MeshFacts, closed_mesh
from camgeo.files.prism import bore_polygon, rounded_contour, rounded_loop
from camgeo.files.triangulate import disc
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.files.mesh import Mesh
    from camgeo.files.precision import Precision
    from camgeo.files.triangulate import Triangles
    from camgeo.fit.pieces import ArcSpline, Polygon
    from kin.numeric.arrays import Array

BEYOND = 1.0  # mm by which a cutting prism reaches out of the body, so that no two faces lie on each other


@dataclass(frozen=True)
class Cut:
    """A closed outline cut from z `low` to `high`, mm.

    `island` is whether it lies within the inner contour about a pocket.
    """

    outline: ArcSpline
    low: float
    high: float
    island: bool = False


@dataclass(frozen=True)
class Drill:
    """A radial hole in direction `at`, rad, its axis at z, from the shaft out to `reach`; lengths in mm.

    `slope` is the sine of the least angle at which its sides meet the bore.
    """

    at: float
    diameter: float
    z: float
    reach: float
    slope: float = 1.0


@dataclass(frozen=True)
class Solid:
    """A disc from z = 0 to `thickness` with a round boss from `low` to `high` and what is cut out of both; mm.

    `boss` is the diameter, None without one; `chamfer` the height of the chamfer along both edges of the outline, 0 for
    none. `floor` is the z of the floor of a pocket between two contours, None without one.
    """

    thickness: float
    low: float
    high: float
    boss: float | None
    chamfer: float
    cuts: Sequence[Cut]
    drills: Sequence[Drill] = ()
    floor: float | None = None


def joined_mesh(polygon: Polygon, solid: Solid, *, tolerance: float, precision: Precision) -> tuple[Mesh, MeshFacts]:
    """Closed, oriented mesh, mm, of the solid over a polygon, and facts on it.

    With a chamfer the polygon has to be fitted so finely that its parallel inside is within the tolerance too. Raises
    ToleranceError where the tolerance cannot be held in the precision, RegionError where an outline is not simple or
    the chamfer too wide for the contour.
    """
    outer, moved = rounded_contour(polygon, precision)
    bound = polygon.bound.widened(moved)
    precision.within("the contour", bound.worst, tolerance)
    part = manifold(*_disc(outer, solid.thickness, solid.chamfer, precision))
    facts = MeshFacts(len(outer), moved, bound)
    return completed_mesh(part, facts, solid, tolerance=tolerance, precision=precision)


def completed_mesh(
    part: Any,  # noqa: ANN401 - manifold3d has no types
    facts: MeshFacts,
    solid: Solid,
    *,
    tolerance: float,
    precision: Precision,
) -> tuple[Mesh, MeshFacts]:
    """Closed, oriented mesh, mm, of a disc with its boss joined to it and its openings cut out, and facts on it.

    `part` is the disc as a body of manifold3d, `facts` are those on the disc. Raises ToleranceError where the tolerance
    cannot be held in the precision, RegionError where a body is not sound.
    """
    moved, bound = facts.displacement, facts.bound
    for height in (solid.thickness, solid.low, solid.high, solid.chamfer):
        precision.within("a height", abs(precision.number(height) - height), tolerance)

    # a corner between two walls that are off by e each is off by up to 2 e over the sine of its angle
    fine = min((0.5 * tolerance * drill.slope for drill in solid.drills), default=tolerance)
    if solid.boss is not None:
        circle, _ = bore_polygon(solid.boss, precision.fit_tolerance(fine, 0.5 * solid.boss))
        ring, ring_moved = precision.rounded(circle)
        moved = max(moved, ring_moved)
        # the boss begins inside the disc, so that no two faces lie on each other
        low = solid.low if solid.low < 0.0 else 0.5 * solid.thickness
        high = solid.high if solid.high > solid.thickness else 0.5 * solid.thickness
        part += manifold(*prism(ring, low, high, precision))
    for cut in solid.cuts:
        loop, _, loop_moved = rounded_loop(
            cut.outline, fine if cut.high > solid.thickness or cut.low < 0.0 else tolerance, precision
        )
        moved = max(moved, loop_moved)
        low = cut.low - BEYOND if cut.low <= solid.low else cut.low
        part -= manifold(*prism(loop, low, cut.high + BEYOND, precision))
    for drill in solid.drills:
        part -= manifold(*_drill(drill, fine, precision))
    # slivers that had to be closed move walls of the contour and of openings alike
    mesh, merged = mesh_of_body(part, precision)
    bound = bound.widened(merged)
    precision.within("the contour", bound.worst, tolerance)
    return mesh, replace(facts, displacement=moved + merged, bound=bound)


def need_booleans() -> None:
    """Raise MissingExtraError where manifold3d is not installed, which joins and cuts solids."""
    demand_package("manifold3d", "this part needs solids to be joined and cut")


def manifold(points: Array, triangles: Triangles) -> Any:  # noqa: ANN401 - manifold3d has no types
    """The manifold3d body of points (v, 3) and triangles (t, 3); raises RegionError where it is not sound."""
    import manifold3d

    body = manifold3d.Manifold(manifold3d.Mesh64(points, triangles.astype(np.uint64)))
    if body.status() != manifold3d.Error.NoError:
        raise RegionError(f"a body is not valid: {body.status().name}")
    return body


def mesh_of_body(part: Any, precision: Precision) -> tuple[Mesh, float]:  # noqa: ANN401 - manifold3d has no types
    """Mesh of a manifold3d body, and the distance, mm, that its walls were moved to close it: 0 but for slivers.

    Where walls cross at a slant, corners may lie so close that rounding makes them one, which leaves a gap. Edges that
    short are then made points before rounding. Raises RegionError where the mesh does not close even so.
    """
    points, triangles = _arrays(part)
    try:
        return closed_mesh(points, triangles, precision), 0.0
    except RegionError:
        apart = 2.0 * precision.spacing(float(np.abs(points).max()))
        return closed_mesh(*_arrays(part.simplify(apart)), precision), apart


def _arrays(part: Any) -> tuple[Array, Triangles]:  # noqa: ANN401 - manifold3d has no types
    mesh = part.to_mesh64()
    points = np.asarray(mesh.vert_properties, dtype=np.float64)[:, :3]
    return points, np.asarray(mesh.tri_verts, dtype=np.intp)


def prism(loop: Array, low: float, high: float, precision: Precision) -> tuple[Array, Triangles]:
    """Points (2 n, 3) and triangles of the closed prism from z `low` to `high` over a counter-clockwise loop (n, 2).

    The loop has to be rounded to `precision`; the heights are rounded here. Raises RegionError for a loop that is not
    simple.
    """
    return _stack([(loop, low), (loop, high)], disc(loop), precision)


def _disc(outer: Array, thickness: float, chamfer: float, precision: Precision) -> tuple[Array, Triangles]:
    """The disc over a rounded contour, its edges chamfered by parallels of the polygon itself: every facet is plane."""
    if not chamfer:
        return prism(outer, 0.0, thickness, precision)
    inner, _ = precision.rounded(inset(outer, chamfer))
    layers = [(inner, 0.0), (outer, chamfer), (outer, thickness - chamfer), (inner, thickness)]
    return _stack(layers, disc(inner), precision)


def inset(loop: Array, distance: float) -> Array:
    """Polygon (n, 2) whose edges lie `distance` inside those of a counter-clockwise loop (n, 2), vertex for vertex; mm.

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


def _stack(layers: list[tuple[Array, float]], lid: Triangles, precision: Precision) -> tuple[Array, Triangles]:
    """Body between loops of equally many vertices at rising heights; `lid` triangulates the first and the last."""
    n = len(layers[0][0])
    points = np.concatenate([np.column_stack([loop, np.full(n, precision.number(z))]) for loop, z in layers])
    lower = np.arange(n)
    following = np.roll(lower, -1)
    faces = [lid[:, ::-1], lid + (len(layers) - 1) * n]
    for k in range(len(layers) - 1):
        a, b = k * n, (k + 1) * n
        faces.append(np.column_stack((lower + a, following + a, following + b)))
        faces.append(np.column_stack((lower + a, following + b, lower + b)))
    return points, np.concatenate(faces)


def _drill(drill: Drill, tolerance: float, precision: Precision) -> tuple[Array, Triangles]:
    """Cylinder along a radius, from the shaft outward: a prism over its circle, laid down."""
    circle, _ = bore_polygon(drill.diameter, precision.fit_tolerance(tolerance, drill.reach))
    points, triangles = prism(precision.rounded(circle)[0], 0.0, 1.0, precision)
    across, up, along = points[:, 0], points[:, 1], drill.reach * points[:, 2]
    c, s = math.cos(drill.at), math.sin(drill.at)
    # across to the left of the radius, up, along it: a right-handed turn of the prism's own axes
    return np.column_stack([along * c - across * s, along * s + across * c, up + drill.z]), triangles
