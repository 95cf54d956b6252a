"""Plain parts as binary STL: a contour with its bore, extruded from z = 0 to the thickness, always in millimetres.

An STL holds single-precision numbers, so each vertex moves when it is written, at 50 mm by up to 2.7e-6 mm. The fit
must leave room for that: `fit_tolerance` says how much is left, or refuses.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.triangulate import disc, ring
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.pieces import Bound, Polygon

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.files.triangulate import Array, Triangles

# Least tolerance that is accepted, in worst displacements of a vertex. The quarter that is left to the fit makes the
# sagitta over two edges (8 e) twice the displacement, which rounding cannot turn into a dent.
_LEAST = 1.25
_HEADER = 80  # bytes; must not begin with "solid", by which readers tell the text form
_RECORD = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])


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
    thickness: float,
    tolerance: float,
    about: str = "",
) -> StlFacts:
    """Write a polygon, with a round bore of this diameter about the origin, as a closed solid; lengths in mm.

    The bore is a polygon that straddles its circle; both loops keep within `tolerance` of what is meant after their
    rounding to single precision. Every edge belongs to two triangles, which run along it opposite ways. O(n log n) for
    a contour that runs once round the shaft; see `camgeo.files.triangulate`.

    Raises ToleranceError where the tolerance cannot be held, RegionError where the contour is not simple or the bore
    reaches it, ValueError for a bore or thickness that is not positive; OSError as the file system does.
    """
    for what, value in (("bore", bore), ("thickness", thickness)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{what} must be > 0, not {value!r}")
    outer, moved = _rounded(polygon.vertices)
    kept = np.any(outer != np.roll(outer, 1, axis=0), axis=1)
    outer = outer[kept]
    bound = polygon.bound.widened(moved)
    _check("the contour", bound.worst, tolerance)
    _check("the thickness", abs(float(np.float32(thickness)) - thickness), tolerance)

    if bore is None:
        loops, triangles, bore_bound = [outer], disc(outer), None
    else:
        circle, straddle = bore_polygon(bore, fit_tolerance(tolerance, 0.5 * bore))
        inner, inner_moved = _rounded(circle)
        moved = max(moved, inner_moved)
        bore_bound = Bound(straddle, straddle).widened(inner_moved)
        _check("the bore", bore_bound.worst, tolerance)
        loops, triangles = [outer, inner[::-1]], ring(outer, inner)
        # the hole's loop as its wall runs, clockwise, has its vertices numbered from the last
        n, m = len(outer), len(inner)
        triangles = np.where(triangles < n, triangles, 2 * n + m - 1 - triangles)

    records = _solid(loops, triangles, thickness)
    header = f"camgeo: binary STL in mm, z upwards. {about}".encode("ascii", "replace")[:_HEADER].ljust(_HEADER)
    with path.open("wb") as stream:
        stream.write(header)
        stream.write(len(records).to_bytes(4, "little"))
        records.tofile(stream)
    return StlFacts(
        len(records), len(outer), len(loops[1]) if bore is not None else 0, int(np.count_nonzero(~kept)), moved,
        bound, bore_bound,
    )  # fmt: skip


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


def _rounded(points: Array) -> tuple[Array, float]:
    """Points in single precision, held as doubles and without negative zeros, and the farthest that one moved."""
    single: Array = points.astype(np.float32).astype(np.float64) + 0.0
    return single, float(np.hypot(*(single - points).T).max())


def _check(what: str, deviation: float, tolerance: float) -> None:
    if not deviation <= tolerance:
        raise ToleranceError(
            f"STL: {what} would be off by {deviation:.6g} mm in single precision, more than {tolerance:.6g} mm",
            deviation,
        )


def _solid(loops: list[Array], triangles: Triangles, thickness: float) -> np.ndarray[tuple[int], np.dtype[np.void]]:
    """STL records of the prism over `triangles`, whose walls stand on the loops; the solid lies left of each loop."""
    corners = np.concatenate(loops)
    n, faces = len(corners), len(triangles)
    table = np.zeros((2 * n, 3), dtype=np.float32)
    table[:n, :2] = table[n:, :2] = corners
    table[n:, 2] = thickness
    here = np.arange(n)
    following = np.concatenate([np.roll(part, -1) for part in np.split(here, [len(loops[0])]) if part.size])

    index = np.empty((2 * faces + 2 * n, 3), dtype=np.intp)
    index[:faces] = triangles[:, ::-1]
    index[faces : 2 * faces] = triangles + n
    walls = index[2 * faces :]
    walls[:n] = np.column_stack((here, following, following + n))
    walls[n:] = np.column_stack((here, following + n, here + n))

    step = corners[following] - corners
    outward = np.column_stack((step[:, 1], -step[:, 0])) / np.hypot(step[:, 0], step[:, 1])[:, None]
    records = np.zeros(len(index), dtype=_RECORD)
    normal = records["normal"]
    normal[:faces, 2] = -1.0
    normal[faces : 2 * faces, 2] = 1.0
    normal[2 * faces : 2 * faces + n, :2] = normal[2 * faces + n :, :2] = outward
    records["vertices"] = np.take(table, index, axis=0)  # four times as fast as table[index]
    return records
