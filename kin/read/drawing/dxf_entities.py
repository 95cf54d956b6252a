"""DXF entities as numbers, in the plane and unit of the drawing: lines and arcs as rows, all else as Bezier pieces.

Readers of entities raise UnfitError for numbers that are missing, not finite or too large, and those of arcs, polylines
and ellipses for an extrusion that is not along z.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from kin.contour.bezier import Beziers
from kin.read.drawing.digits import Written
from kin.read.drawing.shapes import Shape, UnfitError, check, check_degree, check_spline, shape

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

# Entities that are never cut: they are listed, not refused.
NOTES = frozenset(
    {
        "TEXT", "MTEXT", "ATTDEF", "ATTRIB", "DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "LEADER",
        "MULTILEADER", "TOLERANCE", "ACAD_TABLE", "POINT", "VIEWPORT", "XLINE", "RAY",
    }
)  # fmt: skip
# What a machine may engrave, and what is no edge all the same.
FILLS = frozenset({"HATCH", "SOLID", "TRACE", "IMAGE", "WIPEOUT", "OLE2FRAME"})
FRAME = 16  # flag of a vertex that only controls a curve
# Slope, and relative size, that is still rounding.
LEVEL = 1e-9


def shape_of(entity: Any) -> Shape:  # noqa: ANN401  ezdxf's entities declare their attributes while they run
    """Return the numbers of an entity of CURVES. Raises UnfitError if it is damaged or not in the drawing's plane."""
    return CURVES[entity.dxftype()](entity)


def written(entity: Any, drawn: Shape, scale: float) -> Written:  # noqa: ANN401
    """Return the numbers of an entity as its file shows them; `scale` is that of the blocks round it."""
    dxf = entity.dxf
    if len(drawn.arcs):
        x, y, radius = drawn.arcs[0, :3].tolist()
        angles = [dxf.start_angle, dxf.end_angle] if entity.dxftype() == "ARC" else []
        return Written([x, y, radius], angles, radius, math.radians(1.0), scale)
    if entity.dxftype() == "ELLIPSE":
        lengths = [*tuple(dxf.center)[:2], *tuple(dxf.major_axis)[:2]]
        angles = [dxf.ratio, dxf.start_param, dxf.end_param]
        return Written(lengths, angles, math.hypot(*lengths[2:]), 1.0, scale)
    if drawn.beziers.count:
        return Written([value for point in entity.control_points for value in tuple(point)[:2]], scale=scale)
    return Written(drawn.chords[:, :4].ravel().tolist(), scale=scale)


def needs(entity: Any, *attributes: str) -> None:  # noqa: ANN401
    """Raise UnfitError for an entity whose file leaves out one of `attributes`, which ezdxf would fill in."""
    for name in attributes:
        if not entity.dxf.hasattr(name):
            raise UnfitError("syntax", f"its {name.replace('_', ' ')} is missing")


def facing(entity: Any) -> float:  # noqa: ANN401
    """+1 for an entity seen from above; -1 for one extruded along -z, whose own x axis is turned round.

    Raises UnfitError for any other extrusion.
    """
    x, y, z = entity.dxf.get("extrusion", (0.0, 0.0, 1.0))
    if not max(abs(x), abs(y)) <= LEVEL * abs(z):
        raise UnfitError("unsupported", f"it lies in a plane of its own, with the extrusion ({x:g}, {y:g}, {z:g})")
    return 1.0 if z > 0.0 else -1.0


def line(entity: Any) -> Shape:  # noqa: ANN401
    """Return the shape of a LINE."""
    needs(entity, "start", "end")
    (x, y, z), (x2, y2, z2) = entity.dxf.start, entity.dxf.end
    return shape(chords=(x, y, x2, y2, 0.0), heights=(z, z2))


def arc(entity: Any) -> Shape:  # noqa: ANN401
    """Return the shape of an ARC, counter-clockwise from start angle to end angle; equal angles make a full circle."""
    needs(entity, "center", "radius", "start_angle", "end_angle")
    first, last = entity.dxf.start_angle, entity.dxf.end_angle
    check(np.array([first, last]))
    begin, sweep = np.radians(first), np.radians(np.mod(last - first, 360.0))
    return circular(entity, [begin], sweep) if sweep > 0.0 else circular(entity, [begin, begin + np.pi], np.pi)


def circle(entity: Any) -> Shape:  # noqa: ANN401
    """Return the shape of a CIRCLE: two half circles."""
    needs(entity, "center", "radius")
    return circular(entity, [0.0, np.pi], np.pi)


def circular(entity: Any, angles: list[float], sweep: float) -> Shape:  # noqa: ANN401
    """Arcs of the entity's circle over `sweep`, rad, one from each of `angles`, rad.

    Raises UnfitError without a radius above 0 too.
    """
    side = facing(entity)
    (x, y, z), radius = entity.dxf.center, entity.dxf.radius
    if not radius > 0.0:
        raise UnfitError("range", f"its radius is {radius:g}")
    begins = angles if side > 0.0 else [np.pi - a for a in angles]
    return shape(arcs=[(side * x, y, radius, a, side * sweep) for a in begins], heights=side * z)


def lwpolyline(entity: Any) -> Shape:  # noqa: ANN401
    """Return the shape of an LWPOLYLINE."""
    rows = np.asarray(entity.lwpoints.values, dtype=np.float64).reshape(-1, 5)
    return polyline_of(entity, rows[:, :2], rows[:, 4], entity.closed, entity.dxf.elevation)


def polyline(entity: Any) -> Shape:  # noqa: ANN401
    """Chords of a POLYLINE, as R12 draws contours, and as others do in space at one height.

    A curve that was fitted to it is drawn by its own vertices; those of its frame are none. Raises UnfitError for a
    mesh.
    """
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        raise UnfitError("unsupported", "it is a mesh")
    vertices = [vertex for vertex in entity.vertices if not vertex.dxf.flags & FRAME]
    for vertex in vertices:
        needs(vertex, "location")
    places = np.array([tuple(v.dxf.location) for v in vertices], dtype=np.float64).reshape(-1, 3)
    bulges = np.array([v.dxf.get("bulge", 0.0) for v in vertices], dtype=np.float64)
    return polyline_of(entity, places[:, :2], bulges, entity.is_closed, places[:, 2])


def polyline_of(entity: Any, points: Array, bulges: Array, closed: bool, heights: Any) -> Shape:  # noqa: ANN401
    """Chords between points (n, 2) with bulges (n,), back to the first if closed; UnfitError for fewer than two."""
    side = facing(entity)
    if len(points) < 2:
        raise UnfitError("syntax", f"a polyline of {len(points)} vertices")
    points = points * np.array([side, 1.0])
    rows = np.column_stack([points, np.roll(points, -1, axis=0), side * bulges])
    return shape(chords=rows if closed else rows[:-1], heights=side * np.asarray(heights))


def ellipse(entity: Any) -> Shape:  # noqa: ANN401
    """Rational quadratic pieces that are exactly an ELLIPSE or an arc of one; raises UnfitError for unsound axes."""
    needs(entity, "center", "major_axis", "ratio")
    side = facing(entity)
    centre, major = np.array(tuple(entity.dxf.center)), np.array(tuple(entity.dxf.major_axis))
    ratio = entity.dxf.ratio
    first, last = entity.dxf.get("start_param", 0.0), entity.dxf.get("end_param", 2.0 * np.pi)
    check(centre, major, np.array([first, last, ratio]))
    size = float(np.hypot(major[0], major[1]))
    if not (ratio > 0.0 and abs(major[2]) <= LEVEL * size and size > 0.0):
        raise UnfitError("unsupported", "its axes are not those of an ellipse in the drawing's plane")
    minor = side * ratio * np.array([-major[1], major[0]])
    span = np.mod(last - first, 2.0 * np.pi)
    if span < LEVEL or span > 2.0 * np.pi - LEVEL:
        span = 2.0 * np.pi
    pieces = Beziers.from_ellipse(centre[:2], major[:2], minor, first, first + span)
    return shape(beziers=pieces, heights=centre[2])


def spline(entity: Any) -> Shape:  # noqa: ANN401
    """Bezier pieces, one a span, of a SPLINE by its control points, knots and weights.

    Raises UnfitError for a spline of fit points alone, and for unsound numbers.
    """
    control = np.array([tuple(p) for p in entity.control_points], dtype=np.float64).reshape(-1, 3)
    knots, count, degree = np.array(entity.knots, dtype=np.float64), len(control), int(entity.dxf.degree)
    weight = np.array(entity.weights, dtype=np.float64) if len(entity.weights) else np.ones(count)
    if not count:
        raise UnfitError(
            "unsupported",
            "a spline of fit points alone has no definite shape; save it with control points, or as a polyline",
        )
    check(control, knots, weight)
    check_degree(degree)
    check_spline(degree, knots, weight, count)
    pieces = Beziers.from_spline(degree, knots, control[:, :2], weight / weight[0])
    return shape(beziers=pieces, heights=control[:, 2])


CURVES: dict[str, Callable[[Any], Shape]] = {
    "LINE": line,
    "ARC": arc,
    "CIRCLE": circle,
    "LWPOLYLINE": lwpolyline,
    "POLYLINE": polyline,
    "SPLINE": spline,
    "ELLIPSE": ellipse,
}
