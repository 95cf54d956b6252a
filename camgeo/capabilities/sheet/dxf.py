"""Pages as annotation of a DXF drawing: the contour stands 1 : 1 about the origin, the pages are scaled round it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.sheet.lettering import SMALL
from camgeo.capabilities.sheet.marks import ARROW, BEYOND, GAP, CircleMark, Dimension, LineMark, Text

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ezdxf.layouts.base import BaseLayout
    from ezdxf.layouts.layout import Modelspace

    from camgeo.capabilities.sheet.marks import Mark, Page, Point
    from camgeo.fit.bound import Box

COLOURS = {"FRAME": 8, "VIEW": 7, "HATCH": 8, "CENTRE": 8, "DIM": 3, "TEXT": 2, "TABLE": 2}
STYLE = "SHEET"
FONT = "DejaVuSans.ttf"
APART = 20.0  # mm of paper between pages
LINEAR, DIAMETRIC, USER_PLACED = 32, 35, 128  # types of dimensions, which have a block of their own
MIDDLE_CENTRE = 5
PATTERNS = {"": "BYLAYER", "dashed": "DASHED", "chain": "CENTER", "phantom": "PHANTOM"}


def annotation(pages: Sequence[Page], origin: Point, scale: float) -> Callable[[Modelspace], Box]:
    """Function that draws pages side by side in a modelspace, and returns their bounds (x0, y0, x1, y1), mm.

    Lengths of paper are divided by `scale`; `origin`, mm on the first page, comes to the origin of the drawing.
    """

    def annotate(space: Modelspace) -> Box:
        _prepare(space, scale)
        x, low, high = 0.0, 0.0, 0.0
        for page in pages:
            _Pen(space, x - origin[0], -origin[1], scale).draw(page.marks)
            x += page.width + APART
            high = max(high, page.height)
        shift = np.array(origin)
        ends = (np.array([[0.0, low], [x - APART, high]]) - shift) / scale
        (x0, y0), (x1, y1) = ends.tolist()
        return x0, y0, x1, y1

    return annotate


def _prepare(space: Modelspace, scale: float) -> None:
    """Add layers, line types, the style of texts, and the style of dimensions, in mm with arrows."""
    document = space.doc
    document.linetypes.add("DASHED", [4.5 / scale, 3.0 / scale, -1.5 / scale], description="Dashed _ _ _")
    phantom = [part / scale for part in (13.5, 8.0, -1.5, 0.5, -1.5, 0.5, -1.5)]
    document.linetypes.add("PHANTOM", phantom, description="Phantom ____ _ _ ____ _ _")
    for layer, colour in COLOURS.items():
        document.layers.add(layer, color=colour)
    document.styles.add(STYLE, font=FONT)
    style = document.dimstyles.add(STYLE)
    style.update_dxf_attribs(
        {
            "dimtxsty": STYLE, "dimtxt": SMALL, "dimasz": ARROW, "dimexo": GAP, "dimexe": BEYOND, "dimgap": 0.8,
            "dimscale": 1.0 / scale, "dimlfac": 1.0, "dimtad": 1, "dimdec": 4, "dimzin": 8, "dimdsep": ord("."),
            "dimtih": 0, "dimtoh": 0,
        }
    )  # fmt: skip


class _Pen:
    """Draws marks of a page, shifted by (x, y), mm of paper, and divided by the scale."""

    def __init__(self, space: BaseLayout, x: float, y: float, scale: float) -> None:
        self._space, self._x, self._y, self._scale = space, x, y, scale

    def draw(self, marks: Sequence[Mark]) -> None:
        """Draw marks; lines on the layer "" are left out, as they stand in the drawing already."""
        for mark in marks:
            match mark:
                case LineMark() if mark.layer:
                    self._line(self._space, mark)
                case CircleMark():
                    attributes = {
                        "layer": mark.layer,
                        "linetype": PATTERNS[mark.pattern],
                        "lineweight": _hundredths(mark.weight),
                    }
                    self._space.add_circle(self._at(mark.centre), mark.radius / self._scale, attributes)
                case Text():
                    self._text(self._space, mark)
                case Dimension():
                    self._dimension(mark)

    def _at(self, point: Point) -> Point:
        return (point[0] + self._x) / self._scale, (point[1] + self._y) / self._scale

    def _line(self, layout: BaseLayout, line: LineMark) -> None:
        points = [self._at((x, y)) for x, y in line.points.tolist()]
        attributes = {"layer": line.layer, "linetype": PATTERNS[line.pattern], "lineweight": _hundredths(line.weight)}
        if line.filled:
            layout.add_solid([points[0], points[1], points[2]], {"layer": line.layer})
        elif len(points) == 2:
            layout.add_line(points[0], points[1], attributes)
        else:
            layout.add_lwpolyline(points, close=line.closed, dxfattribs=attributes)

    def _text(self, layout: BaseLayout, text: Text) -> None:
        from ezdxf.enums import TextEntityAlignment as Align

        place = {"left": Align.LEFT, "middle": Align.CENTER, "right": Align.RIGHT}[text.anchor]
        attributes = {"layer": text.layer, "style": STYLE, "rotation": 90.0 if text.turned else 0.0}
        entity = layout.add_text(text.text, height=text.height / self._scale, dxfattribs=attributes)
        entity.set_placement(self._at(text.at), align=place)

    def _dimension(self, dimension: Dimension) -> None:
        """Add a dimension with the block that shows it; a CAD system that draws it anew takes its points."""
        document = self._space.doc
        block = document.blocks.new_anonymous_block(type_char="D")
        for line in dimension.lines:
            self._line(block, line)
        self._text(block, dimension.text)
        x0, y0, x1, y1 = dimension.text.box
        first, second, base = map(self._at, (dimension.first, dimension.second, dimension.base))
        attributes = {
            "layer": "DIM",
            "dimstyle": STYLE,
            "geometry": block.name,
            "text": dimension.text.text,
            "text_midpoint": self._at((0.5 * (x0 + x1), 0.5 * (y0 + y1))),
            "attachment_point": MIDDLE_CENTRE,
        }
        if dimension.direction is None:
            own = {"dimtype": DIAMETRIC | USER_PLACED, "defpoint": second, "defpoint4": first}
        else:
            own = {
                "dimtype": LINEAR | USER_PLACED,
                "defpoint": base,
                "defpoint2": first,
                "defpoint3": second,
                "angle": dimension.direction,
            }
        entity = self._space.new_entity("DIMENSION", {**attributes, **own, "actual_measurement": dimension.value})
        entity.dxf.discard("insert")


def _hundredths(weight: float) -> int:
    return {1.0: 100, 0.7: 70, 0.5: 50}.get(weight, 25)
