"""Contours as SVG drawings at true size: one closed path in the group CUT, what else is cut in groups of its own.

The groups have the names of a DXF's layers, and the numbers are those of a DXF: in drawing units, from the shaft, y
upwards by a transform. Reference geometry is left out, since many machines cut whatever a drawing shows.

SVG gives an arc by its ends, radius and flags, from which near half a turn nothing can be stated exactly: an error e of
the radius moves the arc by up to sqrt(2 r e). Every arc is cut into arcs of a quarter turn at most. Their half chord is
the radius times the sine of up to 45 degrees, and rounding of the numbers moves the arc by no more than a few roundings
of its size, some 1e-15 of it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import ArcChain, radius_of, steps_along
from camgeo.files.markup import number, one_line
from camgeo.fit.pieces import ArcSpline, BSpline, Outline, Polygon
from camgeo.formats.drawings import drawing_format, drawing_making
from camgeo.formats.dxf import UNITS

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from camgeo.files.layer_outline import LayerOutline
    from camgeo.fit.bound import Box
    from camgeo.output.job import Job
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array
    from kin.numeric.check import Check

_PAGE_UNIT = {"mm": "mm", "inch": "in"}
_COLOURS = {"CUT": "#000000", "BORE": "#0000ff", "HOLES": "#0000ff", "MARK": "#ff0000", "ENGRAVE": "#00aa00"}
_COLOURS |= dict.fromkeys(("GROOVE_INNER", "GROOVE_OUTER", "GROOVE"), _COLOURS["CUT"])
_MARGIN = 1.0  # mm round what is drawn
_PLACES = 100  # the page's corners lie on whole hundredths of a drawing unit
_HAIRLINE = 0.1  # mm
_QUARTER = 0.5 * math.pi


def write_svg(
    path: Path,
    outlines: Sequence[LayerOutline],
    *,
    mm: float = 1.0,
    name: str = "",
    about: str = "",
    remarks: Sequence[str] = (),
) -> None:
    """Write what is cut or engraved as an SVG whose user space has the shaft at its origin.

    A polygon becomes lines, arcs become arcs of a quarter turn at most, a cubic B-spline cubics. All lengths are in mm;
    a unit of the drawing is `mm` mm long (1.0 or 25.4), which the page's width and height and its viewBox state. `name`
    becomes the title; `about` and `remarks` the description.

    Raises ValueError for another unit, a spline that is not cubic, and a circle without extent; KeyError for a layer
    that is neither cut nor engraved, OSError where the file cannot be written.
    """
    if mm not in UNITS:
        raise ValueError(f"a drawing unit must be 1.0 or 25.4 mm, not {mm!r}")
    unit = UNITS[mm][0]
    shapes_of_layers: dict[str, list[str]] = {}
    for layered in outlines:
        text = _path(layered.outline, mm) if layered.circle is None else _circle(layered.layer, *layered.circle, mm)
        shapes_of_layers.setdefault(layered.layer, []).append(text)
    # the page is as large as all outlines with a margin, and its viewBox is in drawing units about the shaft
    low_x, low_y, wide, high = _page([_box(layered) for layered in outlines], mm)
    size = _PAGE_UNIT[unit]
    description = "; ".join(filter(None, (f"camgeo units: {unit}", about, *remarks)))
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"',
        f'  width="{wide}{size}" height="{high}{size}" viewBox="{low_x} {low_y} {wide} {high}">',
        f"<title>{one_line(name or 'cam')}</title>",
        f"<desc>{one_line(description)}</desc>",
        '<g transform="scale(1 -1)">',
    ]
    for layer, shapes in shapes_of_layers.items():
        style = f"fill:none;stroke:{_COLOURS[layer]};stroke-width:{number(round(_HAIRLINE / mm, 4))}"
        lines += [f'<g id="{layer}" inkscape:groupmode="layer" inkscape:label="{layer}" style="{style}">', *shapes]
        lines.append("</g>")
    lines += ["</g>", "</svg>", ""]
    path.write_bytes("\n".join(lines).encode("utf-8"))


def _box(layered: LayerOutline) -> Box:
    """Extremes of an outline, mm."""
    if layered.circle is None:
        return layered.outline.box()
    (x, y), r = layered.circle
    return x - r, y - r, x + r, y + r


def _page(boxes: Sequence[Box], mm: float) -> tuple[str, str, str, str]:
    """Texts of left, top, width and height of the page in drawing units, y downwards, as the viewBox has them."""
    margin = _MARGIN / mm
    x_low, y_low, x_high, y_high = zip(*boxes, strict=True)
    x_min, y_min, x_max, y_max = (value / mm for value in (min(x_low), min(y_low), max(x_high), max(y_high)))
    left, right = math.floor(_PLACES * (x_min - margin)), math.ceil(_PLACES * (x_max + margin))
    top, bottom = math.floor(_PLACES * (-y_max - margin)), math.ceil(_PLACES * (-y_min + margin))
    x, y, wide, high = (number(value / _PLACES) for value in (left, top, right - left, bottom - top))
    return x, y, wide, high


def _path(outline: Outline, mm: float) -> str:
    """Path element of one closed outline, in drawing units of `mm` mm.

    Raises ValueError for a spline that is not cubic.
    """
    match outline:
        case Polygon():
            first = outline.vertices[0] / mm
            pieces = [f"L{_numbers(point)}" for point in outline.vertices[1:] / mm]
        case ArcSpline():
            first, pieces = outline.points[0] / mm, _arcs(ArcChain(outline.points / mm, outline.bulges))
        case BSpline(degree=3):
            beziers = outline.beziers() / mm
            beziers[-1, -1] = beziers[0, 0]
            first, pieces = beziers[0, 0], [f"C{_numbers(row[1:].ravel())}" for row in beziers]
        case _:
            raise ValueError("an SVG holds lines, arcs and cubic splines; export one of these")
    data = "\n".join([f"M{_numbers(first)}", *pieces, "Z"])
    return f'<path d="{data}"/>'


def _arcs(chain: ArcChain) -> list[str]:
    """Lines and arcs of a chain, arcs of at most a quarter turn each."""
    commands = []
    for start, end, bulge in chain.pieces():
        if bulge == 0.0:
            commands.append(f"L{_numbers(end)}")
            continue
        radius = radius_of(math.dist(start, end), bulge)
        head = f"A{_numbers(np.array([radius, radius]))} 0 0 {int(bulge > 0.0)} "
        count = max(math.ceil(abs(4.0 * math.atan(bulge)) / _QUARTER), 1)
        commands += [head + _numbers(point) for point in (*steps_along(start, end, bulge, count)[1:], end)]
    return commands


def _circle(layer: str, centre: tuple[float, float], radius: float, mm: float) -> str:
    if not radius > 0.0:
        raise ValueError(f"{layer}: radius must be > 0, not {radius!r}")
    x, y, r = (number(value / mm) for value in (*centre, radius))
    return f'<circle cx="{x}" cy="{y}" r="{r}"/>'


def _numbers(values: Array) -> str:
    return " ".join(map(number, values.tolist()))


# --- its files --------------------------------------------------------------------------------------------------------


def _draw(
    job: Job, request: FileRequest, path: Path, outlines: list[LayerOutline], remarks: list[str]
) -> Sequence[Check]:
    recipe = job.recipe.in_units_of(request)
    with job.clock.stage("write svg"):
        write_svg(path, outlines, remarks=remarks, mm=recipe.mm, name=recipe.name, about=recipe.about)
    return ()


FORMAT = drawing_format("svg")
MAKING = drawing_making(_draw)
