"""Prisms as meshes: outlines and what is cut out of them, extruded from z = 0 to the thickness, in millimetres.

Each vertex moves when it is written (`camgeo.files.precision`), and the fit must leave room for that.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import radius_of, steps_along
from camgeo.files.mesh import Mesh, MeshFacts
from camgeo.files.triangulate import region
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline, Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.files.precision import Precision
    from camgeo.files.triangulate import Triangles
    from kin.numeric.arrays import Array

_WORDS = {"BORE": "the bore", "CUT": "the outline"}  # what outlines on layers are called in errors


def extruded_mesh(
    outlines: Sequence[LayerOutline], *, thickness: float, tolerance: float, precision: Precision
) -> tuple[Mesh, MeshFacts]:
    """Closed solid within the first outline and outside all others, which lie in it, and facts on it; lengths in mm.

    A polygon is a fitted contour. A circle becomes a polygon that straddles it; arcs of other outlines become chords
    between points of them. All loops, rounded to `precision`, are within `tolerance` of the exact outlines. Every edge
    belongs to two triangles, which run along it in opposite directions. O(n log n) for a contour that runs once round
    the shaft with a bore alone.

    Raises ToleranceError where the tolerance cannot be held, RegionError where an outline is not simple or reaches
    another, ValueError for a thickness that is not positive, TypeError for a spline.
    """
    if not (math.isfinite(thickness) and thickness > 0.0):
        raise ValueError(f"thickness must be > 0, not {thickness!r}")
    precision.within("the thickness", abs(precision.number(thickness) - thickness), tolerance)
    loops, facts = _round_all(outlines, tolerance, precision)
    return _wall(*_turned(loops), precision.number(thickness)), facts


def pocketed_mesh(
    outlines: Sequence[LayerOutline], *, depth: float, thickness: float, tolerance: float, precision: Precision
) -> tuple[Mesh, MeshFacts]:
    """Closed solid within the first outline, with a pocket between its two contours, and facts on it; lengths in mm.

    The contours are the two polygons among the outlines; the pocket reaches from the top face to `depth`. All other
    outlines are holes through the solid and lie within the inner contour or beyond the outer one. Raises ToleranceError
    where the tolerance cannot be held in the precision, RegionError where outlines cross, ValueError for more or fewer
    polygons than two, TypeError for a spline.
    """
    for name, height in (("the thickness", thickness), ("the floor", thickness - depth)):
        precision.within(name, abs(precision.number(height) - height), tolerance)
    loops, facts = _round_all(outlines, tolerance, precision)
    # loops by their numbers: the two contours, and the holes within the inner or beyond the outer one
    flanks = [k for k, layered in enumerate(outlines) if isinstance(layered.outline, Polygon)]
    inner, outer = sorted(flanks, key=lambda k: float(np.hypot(*loops[k].T).max()))
    holes = [k for k in range(1, len(loops)) if k not in flanks]
    within = [k for k in holes if _encloses(loops[inner], loops[k][0])]
    beyond = [k for k in holes if k not in within]
    # each loop has its points twice, at the lower and at the upper end of its wall; a contour's begins on the floor
    floor, top = precision.number(thickness - depth), precision.number(thickness)
    sizes = np.array([len(loop) for loop in loops])
    first = np.cumsum(sizes) - sizes
    count = int(sizes.sum())
    plane = np.concatenate(loops)
    points = np.zeros((2 * count, 3))
    points[:count, :2] = points[count:, :2] = plane
    points[count:, 2] = top
    for k in flanks:
        points[first[k] : first[k] + sizes[k], 2] = floor

    def sheet(bound: int, cut: Sequence[int], *, up: bool, high: bool) -> Triangles:
        number = np.concatenate([first[k] + np.arange(sizes[k]) for k in (bound, *cut)]) + (count if high else 0)
        triangles: Triangles = number[region(loops[bound], [loops[k] for k in cut])]
        return triangles if up else triangles[:, ::-1]

    def wall(k: int) -> Triangles:
        lower = first[k] + np.arange(sizes[k])
        following = np.roll(lower, -1)
        triangles = np.concatenate(
            (
                np.column_stack((lower, following, following + count)),
                np.column_stack((lower, following + count, lower + count)),
            )
        )
        return triangles if k in {0, inner} else triangles[:, ::-1]

    triangles = np.concatenate(
        [
            sheet(0, holes, up=False, high=False),
            sheet(outer, [inner], up=True, high=False),
            sheet(0, [outer, *beyond], up=True, high=True),
            sheet(inner, within, up=True, high=True),
            *(wall(k) for k in range(len(loops))),
        ]
    )
    return Mesh(points, triangles), facts


def _encloses(loop: Array, point: Array) -> bool:
    """Whether a loop (n, 2) winds about a point (2,)."""
    x, y = (np.vstack((loop, loop[:1])) - point).T
    around = np.unwrap(np.arctan2(y, x))
    return bool(abs(around[-1] - around[0]) > math.pi)


def _round_all(
    outlines: Sequence[LayerOutline], tolerance: float, precision: Precision
) -> tuple[list[Array], MeshFacts]:
    """Loops of outlines (n, 2) as written, mm, and the facts of the mesh that they give.

    Raises ToleranceError where a loop is not within the tolerance after rounding, TypeError for a spline.
    """
    loops, moved, vertices, bound = [], 0.0, 0, EXACT
    for layer, outline, _ in outlines:
        if isinstance(outline, Polygon):
            loop, shift = rounded_contour(outline, precision)
            bound = bound.wider(outline.bound.widened(shift))
            precision.within("the contour", bound.worst, tolerance)
            vertices += len(loop)
        elif isinstance(outline, ArcSpline):
            loop, _, shift = rounded_loop(outline, tolerance, precision, _WORDS.get(layer, "a hole"))
        else:
            raise TypeError("a prism has no splines")
        loops.append(loop)
        moved = max(moved, shift)
    return loops, MeshFacts(vertices, moved, bound)


def rounded_contour(polygon: Polygon, precision: Precision) -> tuple[Array, float]:
    """Vertices (n, 2) of a polygon as written, without repetitions, and their greatest shift, mm."""
    outer, moved = precision.rounded(polygon.vertices)
    return outer[np.any(outer != np.roll(outer, 1, axis=0), axis=1)], moved


def _turned(loops: list[Array]) -> tuple[list[Array], Triangles]:
    """Loops as their walls run, all but the first clockwise, and the triangles between them."""
    outer, *inners = loops
    triangles = region(outer, inners)
    # a loop that is turned has its vertices numbered from the last
    first = np.cumsum([len(outer), *map(len, inners)])
    number = np.arange(first[-1])
    for low, high in pairwise(first.tolist()):
        number[low:high] = number[low:high][::-1]
    return [outer, *(inner[::-1] for inner in inners)], number[triangles]


def rounded_loop(
    hole: ArcSpline, tolerance: float, precision: Precision, noun: str = "a hole"
) -> tuple[Array, float, float]:
    """Vertices (n, 2) of a hole's polygon as written, its greatest error, and the greatest shift of a vertex, mm.

    Raises ToleranceError where the error is more than the tolerance; `noun` names the hole in it.
    """
    polygon, error = loop_polygon(hole, precision.fit_tolerance(tolerance, float(np.abs(hole.box()).max())))
    inner, moved = precision.rounded(polygon)
    precision.within(noun, error + moved, tolerance)
    return inner, error + moved, moved


def loop_polygon(outline: ArcSpline, tolerance: float) -> tuple[Array, float]:
    """Vertices (n, 2) of a polygon within `tolerance` of a closed outline, and its greatest distance from it, mm.

    A full circle, two halves, is straddled; any other outline keeps its points, and its arcs become chords between
    points of them.
    """
    if (circle := outline.circle) is not None:
        polygon, error = bore_polygon(2.0 * circle[1], tolerance)
        return polygon + circle[0], error
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


def _wall(loops: list[Array], triangles: Triangles, thickness: float) -> Mesh:
    """Prism over `triangles`, whose walls stand on the loops; the solid lies left of each loop."""
    corners = np.concatenate(loops)
    n, faces = len(corners), len(triangles)
    points = np.zeros((2 * n, 3))
    points[:n, :2] = points[n:, :2] = corners
    points[n:, 2] = thickness
    lower = np.arange(n)
    parts = np.split(lower, np.cumsum([len(loop) for loop in loops])[:-1])
    following = np.concatenate([np.roll(part, -1) for part in parts])

    index = np.empty((2 * faces + 2 * n, 3), dtype=np.intp)
    index[:faces] = triangles[:, ::-1]
    index[faces : 2 * faces] = triangles + n
    walls = index[2 * faces :]
    walls[:n] = np.column_stack((lower, following, following + n))
    walls[n:] = np.column_stack((lower, following + n, lower + n))
    return Mesh(points, index)
