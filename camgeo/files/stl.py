"""Prisms as binary STL: a contour with its bore and holes, extruded from z = 0 to the thickness, always in millimetres.

An STL holds single-precision numbers, so each vertex moves when it is written, at 50 mm by up to 2.7e-6 mm. The fit
must leave room for that: `fit_tolerance` says how much is left, or refuses.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.triangulate import disc, region, ring
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.pieces import Bound, Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.files.triangulate import Array, Triangles
    from camgeo.fit.pieces import ArcSpline

    Records = np.ndarray[tuple[int], np.dtype[np.void]]

# Least tolerance that is accepted, in worst displacements of a vertex. The quarter that is left to the fit makes the
# sagitta over two edges (8 e) twice the displacement, which rounding cannot turn into a dent.
_LEAST = 1.25
_HEADER = 80  # bytes; must not begin with "solid", by which readers tell the text form
RECORD = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])


@dataclass(frozen=True)
class StlFacts:
    """What an STL file holds and how far it is from what was meant.

    `vertices` and `bore_vertices` count the corners of the two loops; `dropped` vertices of the contour fell together
    with their neighbours in single precision, which leaves the drawn line as it is. `displacement` is the farthest
    that rounding moved a vertex; `bound` is the contour's bound and `bore_bound` the bore's, both with it, in mm.
    """

    triangles: int
    vertices: int
    bore_vertices: int
    dropped: int
    displacement: float
    bound: Bound
    bore_bound: Bound | None


def single_precision_bound(size: float) -> float:
    """Farthest in mm that rounding to single precision moves a point with coordinates up to `size` mm."""
    return math.sqrt(0.5) * float(np.spacing(np.float32(abs(size))))


def fit_tolerance(tolerance: float, size: float) -> float:
    """Return what an STL's tolerance leaves to the fit of a polygon with coordinates up to `size` mm.

    Raises ToleranceError, with the least tolerance that can be held, where too little is left.
    """
    moved = single_precision_bound(size + tolerance)
    if not tolerance >= _LEAST * moved:
        # a tolerance of the refused size no longer widens the contour, the least one does
        least = _LEAST * single_precision_bound(size + 2.0 * _LEAST * single_precision_bound(size))
        raise ToleranceError(
            f"an STL of a contour that reaches {size:.6g} mm from the shaft cannot hold {tolerance:.3g} mm: rounding "
            f"to single precision alone moves points by {moved:.3g} mm; at least {least:.3g} mm",
            least,
        )
    return tolerance - moved


def write_stl(
    path: Path,
    polygon: Polygon,
    *,
    bore: float | None = None,
    holes: Sequence[ArcSpline] = (),
    thickness: float,
    tolerance: float,
    about: str = "",
) -> StlFacts:
    """Write a polygon, with a round bore of this diameter about the origin or with holes, as a closed solid; in mm.

    The bore is a polygon that straddles its circle, and so is each round hole; arcs of other holes are chords between
    points of them. All loops keep within `tolerance` of what is meant after their rounding to single precision. Every
    edge belongs to two triangles, which run along it opposite ways. O(n log n) for a contour that runs once round the
    shaft with a bore alone; see `camgeo.files.triangulate`.

    Raises ToleranceError where the tolerance cannot be held, RegionError where the contour is not simple or the bore
    reaches it, ValueError for a bore or thickness that is not positive; OSError as the file system does.
    """
    for what, value in (("bore", bore), ("thickness", thickness)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{what} must be > 0, not {value!r}")
    outer, moved = rounded(polygon.vertices)
    kept = np.any(outer != np.roll(outer, 1, axis=0), axis=1)
    outer = outer[kept]
    bound = polygon.bound.widened(moved)
    within("the contour", bound.worst, tolerance)
    within("the thickness", abs(float(np.float32(thickness)) - thickness), tolerance)

    if holes:
        if bore is not None:
            raise ValueError("a bore beside other holes is one of them")
        loops, triangles, off, hole_moved = _with_holes(outer, holes, tolerance)
        moved, bore_bound = max(moved, hole_moved), Bound(off, off)
    elif bore is None:
        loops, triangles, bore_bound = [outer], disc(outer), None
    else:
        circle, straddle = bore_polygon(bore, fit_tolerance(tolerance, 0.5 * bore))
        inner, inner_moved = rounded(circle)
        moved = max(moved, inner_moved)
        bore_bound = Bound(straddle, straddle).widened(inner_moved)
        within("the bore", bore_bound.worst, tolerance)
        loops, triangles = [outer, inner[::-1]], ring(outer, inner)
        # the hole's loop as its wall runs, clockwise, has its vertices numbered from the last
        n, m = len(outer), len(inner)
        triangles = np.where(triangles < n, triangles, 2 * n + m - 1 - triangles)

    records = _solid(loops, triangles, thickness)
    save(path, records, about)
    return StlFacts(
        len(records), len(outer), len(loops[1]) if len(loops) > 1 else 0, int(np.count_nonzero(~kept)), moved,
        bound, bore_bound,
    )  # fmt: skip


def _with_holes(
    outer: Array, holes: Sequence[ArcSpline], tolerance: float
) -> tuple[list[Array], Triangles, float, float]:
    """Loops and triangles of a rounded loop with holes, how far the holes are off, and the farthest a vertex moved."""
    inners, off, moved = [], 0.0, 0.0
    for hole in holes:
        inner, inner_off, inner_moved = rounded_loop(hole, tolerance)
        inners.append(inner)
        off, moved = max(off, inner_off), max(moved, inner_moved)
    triangles = region(outer, inners)
    # the holes' loops as their walls run, clockwise, have their vertices numbered from the last
    first = np.cumsum([len(outer), *map(len, inners)])
    number = np.arange(first[-1])
    for low, high in pairwise(first.tolist()):
        number[low:high] = number[low:high][::-1]
    return [outer, *(inner[::-1] for inner in inners)], number[triangles], off, moved


def rounded_loop(hole: ArcSpline, tolerance: float) -> tuple[Array, float, float]:
    """Vertices (n, 2) in single precision of a hole's polygon, how far it is off in all, and how far a vertex moved.

    Raises ToleranceError where that is more than the tolerance.
    """
    polygon, off = loop_polygon(hole, fit_tolerance(tolerance, float(np.abs(hole.box()).max())))
    inner, moved = rounded(polygon)
    within("a hole", off + moved, tolerance)
    return inner, off + moved, moved


def save(path: Path, records: Records, about: str) -> None:
    """Write records as a binary STL file."""
    header = f"camgeo: binary STL in mm, z upwards. {about}".encode("ascii", "replace")[:_HEADER].ljust(_HEADER)
    with path.open("wb") as stream:
        stream.write(header)
        stream.write(len(records).to_bytes(4, "little"))
        records.tofile(stream)


def loop_polygon(outline: ArcSpline, tolerance: float) -> tuple[Array, float]:
    """Vertices (n, 2) of a polygon within `tolerance` of a closed outline, and how far it is off, mm.

    A full circle, two halves, is straddled; any other keeps its points, and its arcs are chords between points of them.
    """
    points, bulges = outline.points, outline.bulges
    ends = np.roll(points, -1, axis=0)
    if len(points) == 2 and bool((bulges == 1.0).all()):
        chord = ends[0] - points[0]
        polygon, off = bore_polygon(float(np.hypot(*chord)), tolerance)
        return polygon + 0.5 * (points[0] + points[1]), off
    rows, worst = [], 0.0
    for start, end, bulge in zip(points, ends, bulges.tolist(), strict=True):
        sweep = 4.0 * math.atan(bulge)
        chord = end - start
        length = float(np.hypot(*chord))
        count = 1
        if bulge != 0.0:
            radius = 0.5 * length / abs(math.sin(0.5 * sweep))
            # the sagitta of a chord over the angle a is 2 r sin(a/4)^2
            count = math.ceil(abs(sweep) / (4.0 * math.asin(min(math.sqrt(0.5 * tolerance / radius), 0.5))))
            worst = max(worst, 2.0 * radius * math.sin(0.25 * sweep / count) ** 2)
        # from the start along chords of the arc: nothing is lost where the centre is far away
        part = sweep * np.arange(count) / count
        heading = math.atan2(chord[1], chord[0]) - 0.5 * sweep + 0.5 * part
        share = np.sin(0.5 * part) / math.sin(0.5 * sweep) if sweep else np.zeros(1)
        rows.append(start + (length * share)[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]))
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


def rounded(points: Array) -> tuple[Array, float]:
    """Points in single precision, held as doubles and without negative zeros, and the farthest that one moved."""
    single: Array = points.astype(np.float32).astype(np.float64) + 0.0
    return single, float(np.hypot(*(single - points).T).max())


def within(what: str, deviation: float, tolerance: float) -> None:
    """Raise ToleranceError for a deviation, in mm, above the tolerance or not a number."""
    if not deviation <= tolerance:
        raise ToleranceError(
            f"STL: {what} would be off by {deviation:.6g} mm in single precision, more than {tolerance:.6g} mm",
            deviation,
        )


def _solid(loops: list[Array], triangles: Triangles, thickness: float) -> Records:
    """STL records of the prism over `triangles`, whose walls stand on the loops; the solid lies left of each loop."""
    corners = np.concatenate(loops)
    n, faces = len(corners), len(triangles)
    table = np.zeros((2 * n, 3), dtype=np.float32)
    table[:n, :2] = table[n:, :2] = corners
    table[n:, 2] = thickness
    here = np.arange(n)
    parts = np.split(here, np.cumsum([len(loop) for loop in loops])[:-1])
    following = np.concatenate([np.roll(part, -1) for part in parts])

    index = np.empty((2 * faces + 2 * n, 3), dtype=np.intp)
    index[:faces] = triangles[:, ::-1]
    index[faces : 2 * faces] = triangles + n
    walls = index[2 * faces :]
    walls[:n] = np.column_stack((here, following, following + n))
    walls[n:] = np.column_stack((here, following + n, here + n))

    step = corners[following] - corners
    outward = np.column_stack((step[:, 1], -step[:, 0])) / np.hypot(step[:, 0], step[:, 1])[:, None]
    records = np.zeros(len(index), dtype=RECORD)
    normal = records["normal"]
    normal[:faces, 2] = -1.0
    normal[faces : 2 * faces, 2] = 1.0
    normal[2 * faces : 2 * faces + n, :2] = normal[2 * faces + n :, :2] = outward
    records["vertices"] = np.take(table, index, axis=0)  # four times as fast as table[index]
    return records
