"""Contours as DXF drawings: one closed entity on CUT, the bore on BORE, everything else on REFERENCE.

Holes stand on HOLES, a timing mark on MARK where it is cut and on ENGRAVE where it is engraved, a cutter's path on
TOOLPATH.

ezdxf provides the frame of the drawing, which CAD systems are particular about. Coordinates are written with as many
digits as give back the same double. Nothing in the file depends on when, where or by whom it was written.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.files.errors import demand_package
from camgeo.fit.pieces import BSpline, Outline, Polygon
from camgeo.formats.drawings import drawing_format, drawing_making
from camgeo.schema.fields import Field, Kind
from kin.numeric.records import dataclass
from kin.read.home import prepare_home

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from ezdxf.document import Drawing
    from ezdxf.entities.dxfgfx import DXFGraphic
    from ezdxf.layouts.layout import Modelspace
    from numpy.typing import NDArray

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.fit.bound import Box
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.reader import Reader, Values
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check

VERSION = "R2010"  # unless a recipe gives another
VERSIONS = {"R12": "AC1009", "R2000": "AC1015", "R2010": "AC1024", "R2013": "AC1027"}
UNITS = {1.0: ("mm", 4, 1), 25.4: ("inch", 1, 0)}  # mm a unit: name, $INSUNITS, $MEASUREMENT
APPLICATION = "CAMGEO"  # under this name each entity of the reference carries what it is, as extended data

_REFERENCE = "REFERENCE"
_COLOURS = {"CUT": 7, "BORE": 5, _REFERENCE: 8}
_MORE_COLOURS = {
    "HOLES": 5,
    "MARK": 1,
    "ENGRAVE": 3,
    "TOOLPATH": 4,
    "GROOVE_INNER": 7,
    "GROOVE_OUTER": 7,
    "GROOVE": 7,
}  # of layers that are only there when something is on them
_CENTRE_LINE = (22.0, 14.0, -3.0, 2.0, -3.0)  # mm: length of the pattern, then dash, gap, dash, gap
_DATE = 2451544.5  # 2000-01-01 as a Julian date, in place of the times of writing
_GUID = "{00000000-0000-0000-0000-000000000000}"
_COMMENT = 250  # characters; R12 readers may stop at 255


@dataclass(frozen=True)
class ReferenceCircle:
    """A circle of the reference, such as the prime circle: centre and radius in mm."""

    name: str
    centre: tuple[float, float]
    radius: float


@dataclass(frozen=True)
class Point:
    """A point of the reference, such as the shaft's centre, in mm."""

    name: str
    at: tuple[float, float]


@dataclass(frozen=True)
class Trace:
    """A closed curve of the reference, such as the pitch curve."""

    name: str
    outline: Outline


@dataclass(frozen=True, eq=False)
class ReferenceLine:
    """A line of the reference through points (n, 2), mm, such as that of a moving point; it may cross itself."""

    name: str
    points: Array


Reference = ReferenceCircle | Point | Trace | ReferenceLine


def write_dxf(
    path: Path,
    outlines: Sequence[LayerOutline],
    *,
    reference: Sequence[Reference] = (),
    mm: float = 1.0,
    version: str = VERSION,
    name: str = "",
    about: str = "",
    remarks: Sequence[str] = (),
    annotate: Callable[[Modelspace], Box] | None = None,
) -> None:
    """Write what is cut or engraved, with reference geometry, as a DXF drawing with the shaft at the origin.

    A polygon becomes one closed LWPOLYLINE, arcs one with bulges (in R12 a POLYLINE), a B-spline a SPLINE by its
    control points and knots, a circle a CIRCLE. All lengths are given in mm; the drawing's unit is `mm` mm long (1.0 or
    25.4), stated in the header and, since R12 has no such header, in a comment on top. `$EXTMIN` and `$EXTMAX` are the
    exact extremes of all that is drawn. `name`, `about` and `remarks` go into comments. `annotate` draws further
    contents on layers of its own and returns their extremes in drawing units.

    Nothing is drawn twice: shapes of the reference that coincide become one entity with all their names.

    Raises ValueError for another version or unit, for a spline in R12, for a contour that comes twice through a point,
    and for a circle or a span without extent; ModuleNotFoundError without ezdxf, OSError where the file cannot be
    written.
    """
    if version not in VERSIONS:
        raise ValueError(f"DXF version must be one of {', '.join(VERSIONS)}, not {version!r}")
    if mm not in UNITS:
        raise ValueError(f"a drawing unit must be 1.0 or 25.4 mm, not {mm!r}")
    unit, insunits, measurement = UNITS[mm]

    prepare_home()
    from ezdxf.document import Drawing  # ezdxf.new() warns whenever it makes an R12 drawing
    from ezdxf.enums import InsertUnits

    drawing = Drawing.new(VERSIONS[version])
    _set_layers(drawing, mm, {layered.layer for layered in outlines})
    space = drawing.modelspace()
    boxes = [_draw_layer(space, layered, mm) for layered in outlines] + _draw_reference(space, reference, mm)
    if annotate is not None:
        boxes.append(annotate(space))
    corners = np.array(boxes)
    low, high = corners[:, :2].min(axis=0).tolist(), corners[:, 2:].max(axis=0).tolist()
    drawing.set_modelspace_vport(
        1.1 * max(high[0] - low[0], high[1] - low[1]), (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]))
    )
    header = {
        "$EXTMIN": (*low, 0.0), "$EXTMAX": (*high, 0.0), "$LIMMIN": low, "$LIMMAX": high,
        "$PDMODE": 2,  # points show as crosses
        "$TDCREATE": _DATE, "$TDUPDATE": _DATE,
    }  # fmt: skip
    if version != "R12":
        space.units = InsertUnits(insunits)
        header |= {
            "$INSUNITS": insunits, "$MEASUREMENT": measurement,
            "$TDUCREATE": _DATE, "$TDUUPDATE": _DATE, "$FINGERPRINTGUID": _GUID, "$VERSIONGUID": _GUID,
        }  # fmt: skip
    comments = [f"camgeo units: {unit}", *(_comment(text) for text in (name, about, *remarks) if text)]
    _save(path, drawing, header, comments)


def _draw_layer(space: Modelspace, layered: LayerOutline, mm: float) -> Box:
    """Add an outline on its layer; returns its extremes in drawing units."""
    if layered.circle is None:
        return _draw_outline(space, layered.outline, mm, layered.layer)[1]
    return _draw_circle(space, ReferenceCircle(layered.layer, *layered.circle), mm, layered.layer)[1]


def _draw_reference(space: Modelspace, reference: Sequence[Reference], mm: float) -> list[Box]:
    """Add the reference geometry, each shape with its names; returns the extremes of each shape in drawing units."""
    boxes = []
    for item, names in _distinct(reference):
        if isinstance(item, ReferenceCircle):
            entity, box = _draw_circle(space, item, mm, _REFERENCE)
        elif isinstance(item, Point):
            x, y = item.at[0] / mm, item.at[1] / mm
            entity, box = space.add_point((x, y), {"layer": _REFERENCE}), (x, y, x, y)
        elif isinstance(item, ReferenceLine):
            entity, box = _draw_path(space, item.points / mm)
        else:
            entity, box = _draw_outline(space, item.outline, mm, _REFERENCE)
        entity.set_xdata(APPLICATION, [(1000, _comment(label)) for label in names])
        boxes.append(box)
    return boxes


def _save(path: Path, drawing: Drawing, header: dict[str, object], comments: list[str]) -> None:
    """Write a drawing as `Drawing.saveas` of ezdxf does, but with this header: ezdxf would put the time into it."""
    from ezdxf.document import CREATED_BY_EZDXF, WRITTEN_BY_EZDXF
    from ezdxf.lldxf.tagwriter import TagWriter

    drawing.commit_pending_changes()
    drawing.update_all()
    _order_classes(drawing)
    drawing.header["$HANDSEED"] = str(drawing.entitydb.handles)
    for key, value in header.items():
        drawing.header[key] = value
    about_ezdxf = drawing.ezdxf_metadata()
    for key in (CREATED_BY_EZDXF, WRITTEN_BY_EZDXF):
        about_ezdxf[key] = "ezdxf"
    with path.open("w", encoding=drawing.output_encoding, errors="dxfreplace", newline="\n") as stream:
        for comment in comments:
            stream.write(f"999\n{comment}\n")
        drawing.export_sections(TagWriter(stream, drawing.dxfversion, write_handles=True))


def _order_classes(drawing: Drawing) -> None:
    """Put the classes of entities in use into one order: ezdxf takes them from a set, whose order differs by run."""
    from ezdxf.sections.classes import REQ_R2004, REQUIRED_CLASSES

    always = REQUIRED_CLASSES.get(drawing.dxfversion, REQ_R2004)
    classes = drawing.classes.classes
    for name in sorted((name for name in classes if name[0] not in always), reverse=True):
        classes[name] = classes.pop(name)


def _set_layers(drawing: Drawing, mm: float, more: set[str]) -> None:
    drawing.appids.add(APPLICATION)
    drawing.linetypes.add("CENTER", [length / mm for length in _CENTRE_LINE], description="Center ____ _ ____ _ ____")
    for layer, colour in (_COLOURS | {name: colour for name, colour in _MORE_COLOURS.items() if name in more}).items():
        drawing.layers.add(layer, color=colour, linetype="CENTER" if layer == _REFERENCE else "Continuous")


def _draw_outline(space: Modelspace, outline: Outline, mm: float, layer: str) -> tuple[DXFGraphic, Box]:
    """Add a closed contour; returns the entity and its extremes in drawing units."""
    x_min, y_min, x_max, y_max = outline.box()
    box = (x_min / mm, y_min / mm, x_max / mm, y_max / mm)
    if isinstance(outline, BSpline):
        return _draw_spline(space, outline, mm, layer), box
    if isinstance(outline, Polygon):
        points, bulges = outline.vertices / mm, np.zeros(len(outline.vertices))
    else:
        points, bulges = outline.points / mm, outline.bulges
    _check_points(points)
    if space.dxfversion == VERSIONS["R12"]:
        rows = np.column_stack((points, bulges)).tolist()
        return space.add_polyline2d(rows, format="xyb", close=True, dxfattribs={"layer": layer}), box
    entity = space.add_lwpolyline([], close=True, dxfattribs={"layer": layer})
    # all vertices at once as x, y, start and end width, bulge: append() copies the array for every vertex
    entity.lwpoints.values = np.column_stack((points, np.zeros((len(points), 2)), bulges))
    return entity, box


def draw_line(space: Modelspace, layer: str, colour: int, points: Array) -> Box:
    """Add an open line (n, 2), in drawing units, on a layer that may be new, of an AutoCAD colour; its extremes."""
    layers = space.doc.layers if space.doc is not None else None
    if layers is not None and layer not in layers:
        layers.add(layer, color=colour)
    entity = space.add_lwpolyline([], dxfattribs={"layer": layer})
    entity.lwpoints.values = np.column_stack((points, np.zeros((len(points), 3))))
    return (*points.min(axis=0).tolist(), *points.max(axis=0).tolist())


def _draw_path(space: Modelspace, points: Array) -> tuple[DXFGraphic, Box]:
    """Add an open line for reference, in drawing units; returns the entity and its extremes."""
    (x0, y0), (x1, y1) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    attributes = {"layer": _REFERENCE}
    if space.dxfversion == VERSIONS["R12"]:
        return space.add_polyline2d(points.tolist(), dxfattribs=attributes), (x0, y0, x1, y1)
    entity = space.add_lwpolyline([], dxfattribs=attributes)
    entity.lwpoints.values = np.column_stack((points, np.zeros((len(points), 3))))
    return entity, (x0, y0, x1, y1)


def _draw_spline(space: Modelspace, spline: BSpline, mm: float, layer: str) -> DXFGraphic:
    if space.dxfversion == VERSIONS["R12"]:
        raise ValueError("DXF R12 has no splines; export arcs or a polyline, or a later version")
    short = np.flatnonzero(np.all(np.ptp(spline.beziers() / mm, axis=1) == 0.0, axis=1))
    if short.size:
        raise ValueError(f"span {short[0]} of the spline has no length")
    entity = space.add_spline(degree=spline.degree, dxfattribs={"layer": layer})
    entity.control_points = np.column_stack((spline.control / mm, np.zeros(len(spline.control))))
    entity.knots = spline.knots.tolist()
    entity.dxf.flags = entity.CLOSED | (0 if spline.clamped else entity.PERIODIC)
    return entity


def _draw_circle(space: Modelspace, circle: ReferenceCircle, mm: float, layer: str) -> tuple[DXFGraphic, Box]:
    x, y, r = circle.centre[0] / mm, circle.centre[1] / mm, circle.radius / mm
    if not r > 0.0:
        raise ValueError(f"{circle.name}: radius must be > 0, not {circle.radius!r}")
    return space.add_circle((x, y), r, {"layer": layer}), (x - r, y - r, x + r, y + r)


def _check_points(points: Array) -> None:
    """Raise ValueError for a contour that comes twice through a point, as one with a piece drawn twice does."""
    place: NDArray[np.complex128] = np.ascontiguousarray(points).view(np.complex128)[:, 0]
    order = np.sort(place)
    twice = np.flatnonzero(order[1:] == order[:-1])
    if twice.size:
        repeated = complex(order[twice[0]])
        raise ValueError(f"the contour comes twice through ({repeated.real!r}, {repeated.imag!r})")


def _distinct(reference: Sequence[Reference]) -> list[tuple[Reference, list[str]]]:
    """Distinct shapes of the reference, each with all its names: a prime circle may be the pivots' circle as well."""
    shapes: dict[tuple[float, ...] | int, tuple[Reference, list[str]]] = {}
    for item in reference:
        key: tuple[float, ...] | int
        if isinstance(item, ReferenceCircle):
            key = (*item.centre, item.radius)
        elif isinstance(item, Point):
            key = item.at
        else:
            key = id(item.points) if isinstance(item, ReferenceLine) else id(item.outline)
        shapes.setdefault(key, (item, []))[1].append(item.name)
    return list(shapes.values())


def _comment(text: str) -> str:
    """Return the text as one line that any reader takes."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())[:_COMMENT]


# --- its files --------------------------------------------------------------------------------------------------------

COARSE = 1e-2  # mm: tolerance of the pitch curve drawn for reference, which nothing is cut by


def _draw(
    job: Job, request: FileRequest, path: Path, outlines: list[LayerOutline], remarks: list[str]
) -> Sequence[Check]:
    recipe = job.recipe.in_units_of(request)
    checks, tool = _tool_path(job, request)
    with job.clock.stage("write dxf"):
        write_dxf(
            path,
            [*outlines, *tool],
            remarks=remarks,
            reference=_reference(job, job.tolerance(request)),
            mm=recipe.mm,
            version=request.own.get("version", VERSION),
            name=recipe.name,
            about=recipe.about,
        )
    return checks


def _tool_path(job: Job, request: FileRequest) -> tuple[list[Check], list[LayerOutline]]:
    """Checks that the cutter reaches the whole contour, and the paths of its centre; empty where none is shown."""
    manufacture = job.recipe.manufacture
    if manufacture is None or not manufacture.layer or request.compensation is not None:
        return [], []
    from camgeo.files.layer_outline import LayerOutline
    from camgeo.machining.reach import path_arcs, reach_checks

    with job.clock.stage("cutter path"):
        reached = reach_checks(job.recipe, job.design)
        paths = [path_arcs(job.recipe, path, job.tolerance(request)) for _, path in reached if path is not None]
    outlines = [arcs.mirrored() if job.recipe.rotation == "ccw" else arcs for arcs in paths]
    return [check for check, _ in reached], [LayerOutline("TOOLPATH", arcs) for arcs in outlines]


def _reference(job: Job, tolerance: float) -> list[Reference]:
    """Reference geometry of a drawing: centre, base or prime circle, the pitch curve, paths of points of links."""
    from camgeo.fit.arcs import fit_arcs
    from camgeo.part.walls import Looks, distance_inside

    recipe, exact = job.recipe, job.design.exact
    pitches = {id(surface.base): surface for surface, _ in job.design.contours}.values()
    shapes: list[Reference] = [Point("shaft", (0.0, 0.0))]
    boss = recipe.part.boss
    if boss is not None:
        shapes.append(ReferenceCircle(boss.name, (0.0, 0.0), 0.5 * boss.diameter))
    for surface in pitches:
        for name, radius in exact.circles(surface.name):
            if radius is not None:
                shapes.append(ReferenceCircle(name, (0.0, 0.0), radius))
                continue
            least = abs(distance_inside(Looks.of(surface.base), (0.0, 0.0))[0])
            if least > recipe.export.tolerance:  # the shaft may stand on the contour itself
                shapes.append(ReferenceCircle(name, (0.0, 0.0), least))
            if surface.radius:
                pitch = fit_arcs(surface.base, COARSE)
                shapes.append(Trace("pitch curve", pitch.mirrored() if recipe.rotation == "ccw" else pitch))
    if recipe.linkage is not None and recipe.linkage.traces:
        from camgeo.synthesis.traces import trace_lines

        shapes += [ReferenceLine(name, points) for name, points in trace_lines(recipe, job.design, tolerance)]
    return shapes


def _foresee(_job: Job, _request: FileRequest) -> None:
    demand_package("ezdxf", "a DXF file needs ezdxf")


def _check(file: Values, _: Values, reader: Reader) -> None:
    if file.get("as") == "spline" and file.get("version") == "R12":
        remedy = "give arcs or polyline, or a later version"
        reader.fault_at(f"{file['path']}.dxf.as", "R12 has no splines", "'spline'", remedy)


FORMAT = drawing_format(
    "dxf",
    Field(
        "version",
        Kind.CHOICE,
        "version of the format; R12 has no splines",
        default=VERSION,
        choices=tuple(VERSIONS),
    ),
    path=True,
    check=_check,
)
MAKING = drawing_making(_draw, _foresee)
