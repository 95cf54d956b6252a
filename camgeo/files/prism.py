"""Prisms as meshes: a contour with its bore and holes, extruded from z = 0 to the thickness, in millimetres.

Each vertex moves when it is written (`camgeo.files.precision`), and the fit must leave room for that.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import radius_of, steps_along
from camgeo.files.mesh import Mesh, MeshFacts
from camgeo.files.triangulate import disc, region, ring
from camgeo.fit.pieces import Bound, Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.files.precision import Precision
    from camgeo.files.triangulate import Triangles
    from camgeo.fit.pieces import ArcSpline
    from kin.numeric.arrays import Array


def extruded(
    polygon: Polygon,
    *,
    bore: float | None = None,
    holes: Sequence[ArcSpline] = (),
    thickness: float,
    outer: float | None = None,
    tolerance: float,
    precision: Precision,
) -> tuple[Mesh, MeshFacts]:
    """Closed solid over a polygon with a round bore of this diameter about the origin or with holes; in mm.

    With `outer` it is a ring of that diameter, and the polygon its opening.

    The bore is a polygon that straddles its circle, and so is each round hole; arcs of other holes are chords between
    points of them. All loops keep within `tolerance` of what is meant after their rounding to `precision`. Every edge
    belongs to two triangles, which run along it opposite ways. O(n log n) for a contour that runs once round the
    shaft with a bore alone; see `camgeo.files.triangulate`.

    Raises ToleranceError where the tolerance cannot be held, RegionError where the contour is not simple or the bore
    reaches it, ValueError for a bore or thickness that is not positive.
    """
    for what, value in (("bore", bore), ("outer", outer), ("thickness", thickness)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{what} must be > 0, not {value!r}")
    contour, moved, dropped = rounded_contour(polygon, precision)
    bound = polygon.bound.widened(moved)
    precision.within("the contour", bound.worst, tolerance)
    precision.within("the thickness", abs(precision.number(thickness) - thickness), tolerance)

    if bore is not None and (holes or outer is not None):
        raise ValueError("a bore beside other holes is one of them")
    if outer is not None:
        rim, off, rim_moved = _circle("the outline", outer, tolerance, precision)
        loops, triangles, hole_off, hole_moved = _with_holes(rim, holes, tolerance, precision, opening=contour)
        off = max(off, hole_off)
        moved, bore_bound = max(moved, rim_moved, hole_moved), Bound(off, off)
    elif holes:
        loops, triangles, off, hole_moved = _with_holes(contour, holes, tolerance, precision)
        moved, bore_bound = max(moved, hole_moved), Bound(off, off)
    elif bore is None:
        loops, triangles, bore_bound = [contour], disc(contour), None
    else:
        inner, off, inner_moved = _circle("the bore", bore, tolerance, precision)
        moved, bore_bound = max(moved, inner_moved), Bound(off, off)
        loops, triangles = [contour, inner[::-1]], ring(contour, inner)
        # the hole's loop as its wall runs, clockwise, has its vertices numbered from the last
        n, m = len(contour), len(inner)
        triangles = np.where(triangles < n, triangles, 2 * n + m - 1 - triangles)

    mesh = _standing(loops, triangles, precision.number(thickness))
    inner_count = len(loops[1]) if len(loops) > 1 else 0
    return mesh, MeshFacts(len(mesh.triangles), len(contour), inner_count, dropped, moved, bound, bore_bound)


def _circle(what: str, diameter: float, tolerance: float, precision: Precision) -> tuple[Array, float, float]:
    """Vertices (n, 2) as written of a circle's polygon, how far it is off in all, and how far a vertex moved."""
    circle, straddle = bore_polygon(diameter, precision.fit_tolerance(tolerance, 0.5 * diameter))
    rounded, moved = precision.rounded(circle)
    precision.within(what, straddle + moved, tolerance)
    return rounded, straddle + moved, moved


def rounded_contour(polygon: Polygon, precision: Precision) -> tuple[Array, float, int]:
    """Vertices (n, 2) of a polygon as written, each unlike the one before, how far one moved, how many fell away."""
    outer, moved = precision.rounded(polygon.vertices)
    kept = np.any(outer != np.roll(outer, 1, axis=0), axis=1)
    return outer[kept], moved, int(np.count_nonzero(~kept))


def _with_holes(
    outer: Array,
    holes: Sequence[ArcSpline],
    tolerance: float,
    precision: Precision,
    opening: Array | None = None,
) -> tuple[list[Array], Triangles, float, float]:
    """Loops and triangles of a rounded loop with holes, how far the holes are off, and the farthest a vertex moved.

    `opening` is a rounded hole besides, the first.
    """
    inners, off, moved = [] if opening is None else [opening], 0.0, 0.0
    for hole in holes:
        inner, inner_off, inner_moved = rounded_loop(hole, tolerance, precision)
        inners.append(inner)
        off, moved = max(off, inner_off), max(moved, inner_moved)
    triangles = region(outer, inners)
    # the holes' loops as their walls run, clockwise, have their vertices numbered from the last
    first = np.cumsum([len(outer), *map(len, inners)])
    number = np.arange(first[-1])
    for low, high in pairwise(first.tolist()):
        number[low:high] = number[low:high][::-1]
    return [outer, *(inner[::-1] for inner in inners)], number[triangles], off, moved


def rounded_loop(hole: ArcSpline, tolerance: float, precision: Precision) -> tuple[Array, float, float]:
    """Vertices (n, 2) as written of a hole's polygon, how far it is off in all, and how far a vertex moved.

    Raises ToleranceError where that is more than the tolerance.
    """
    polygon, off = loop_polygon(hole, precision.fit_tolerance(tolerance, float(np.abs(hole.box()).max())))
    inner, moved = precision.rounded(polygon)
    precision.within("a hole", off + moved, tolerance)
    return inner, off + moved, moved


def loop_polygon(outline: ArcSpline, tolerance: float) -> tuple[Array, float]:
    """Vertices (n, 2) of a polygon within `tolerance` of a closed outline, and how far it is off, mm.

    A full circle, two halves, is straddled; any other keeps its points, and its arcs are chords between points of them.
    """
    if (circle := outline.circle) is not None:
        polygon, off = bore_polygon(2.0 * circle[1], tolerance)
        return polygon + circle[0], off
    rows, worst = [], 0.0
    for start, end, bulge in outline.pieces():
        count = 1
        if bulge != 0.0:
            sweep, radius = 4.0 * math.atan(bulge), radius_of(math.dist(start, end), bulge)
            # the sagitta of a chord over the angle a is 2 r sin(a/4)^2
            count = math.ceil(abs(sweep) / (4.0 * math.asin(min(math.sqrt(0.5 * tolerance / radius), 0.5))))
            worst = max(worst, 2.0 * radius * math.sin(0.25 * sweep / count) ** 2)
        rows.append(steps_along(start, end, bulge, count))
    return np.concatenate(rows), worst


def bore_polygon(diameter: float, tolerance: float) -> tuple[Array, float]:
    """Vertices (n, 2) of a polygon that straddles a circle about the origin by equal amounts, and that amount in mm.

    Corners at R and middles of edges at R cos(pi/n) are the same distance e from the radius r:
    ``R = 2 r/(1 + cos(pi/n))`` and ``e = r tan^2(pi/(2 n))``. n is the least multiple of four that keeps e within the
    tolerance, and the polygon is the same after a quarter turn.
    """
    radius = 0.5 * diameter
    quarter = max(1, math.ceil(math.pi / (8.0 * math.atan(math.sqrt(tolerance / radius)))))
    n = 4 * quarter
    corner = 2.0 * radius / (1.0 + math.cos(math.pi / n))
    angle = np.arange(quarter) * (2.0 * math.pi / n)
    x, y = corner * np.cos(angle), corner * np.sin(angle)
    vertices = np.concatenate([np.column_stack(xy) for xy in ((x, y), (-y, x), (-x, -y), (y, -x))])
    return vertices, radius * math.tan(0.5 * math.pi / n) ** 2


def _standing(loops: list[Array], triangles: Triangles, thickness: float) -> Mesh:
    """Prism over `triangles`, whose walls stand on the loops; the solid lies left of each loop."""
    corners = np.concatenate(loops)
    n, faces = len(corners), len(triangles)
    points = np.zeros((2 * n, 3))
    points[:n, :2] = points[n:, :2] = corners
    points[n:, 2] = thickness
    here = np.arange(n)
    parts = np.split(here, np.cumsum([len(loop) for loop in loops])[:-1])
    following = np.concatenate([np.roll(part, -1) for part in parts])

    index = np.empty((2 * faces + 2 * n, 3), dtype=np.int64)
    index[:faces] = triangles[:, ::-1]
    index[faces : 2 * faces] = triangles + n
    walls = index[2 * faces :]
    walls[:n] = np.column_stack((here, following, following + n))
    walls[n:] = np.column_stack((here, following + n, here + n))
    return Mesh(points, index)
