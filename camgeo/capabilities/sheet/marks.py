"""What a page is made of: lines, circles, texts and dimensions, in mm of paper from its lower left corner."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from camgeo.capabilities.sheet.lettering import SMALL, width
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array

Point: TypeAlias = tuple[float, float]
Anchor: TypeAlias = Literal["left", "middle", "right"]
Layer: TypeAlias = Literal["", "FRAME", "VIEW", "HATCH", "CENTRE", "DIM", "TEXT", "TABLE"]
Pattern: TypeAlias = Literal["", "dashed", "chain", "phantom"]
PLANE, BORDER, THICK, THIN = 1.0, 0.7, 0.5, 0.25  # mm: widths of lines, ISO 128-2
ARROW, SLENDER = 2.5, 0.4  # mm: length of an arrow, half its width
RAISED = 1.2  # mm: baseline of a dimension's text from its line, clear of the arrows
GAP, BEYOND = 1.0, 1.5  # mm: of an extension line from the part, and what it stands out beyond the dimension line
TICK, TALL = 3.5, 7.5  # mm: heights of a surface symbol's strokes for letters of 2.5 mm, ISO 21920-1
SLOPE = math.tan(math.radians(60.0))  # of these strokes
LETTERS, BELOW = 1.0, 0.3  # of a text's height: what it reaches above and below its baseline


@dataclass(frozen=True, eq=False)
class LineMark:
    """A line through points (n, 2), mm; a DXF leaves out the layer "", whose lines it has already as outlines."""

    points: Array
    weight: float = THIN
    layer: Layer = "DIM"
    pattern: Pattern = ""
    closed: bool = False
    filled: bool = False


@dataclass(frozen=True)
class CircleMark:
    """A circle, mm; `weight` is the width of its line, mm, `pattern` its pattern of dashes, solid by default."""

    centre: Point
    radius: float
    weight: float = THIN
    layer: Layer = "CENTRE"
    pattern: Pattern = ""


@dataclass(frozen=True)
class Text:
    """A text on its baseline at a point; `turned` by a quarter turn, it is read from the right."""

    at: Point
    text: str
    height: float = SMALL
    anchor: Anchor = "left"
    layer: Layer = "TEXT"
    turned: bool = False

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Least x and y, then greatest x and y of the text, mm of paper."""
        long = width(self.text, self.height)
        start = {"left": 0.0, "middle": -0.5 * long, "right": -long}[self.anchor]
        low, high = -BELOW * self.height, LETTERS * self.height
        x, y = self.at
        if self.turned:
            return x - high, y + start, x - low, y + start + long
        return x + start, y + low, x + start + long, y + high


@dataclass(frozen=True, eq=False)
class Dimension:
    """A dimension between two points of a view, along a direction (degrees), or across a circle (None).

    `base` is a point of the dimension line; `value` is the length on the part, mm. `lines` and `text` draw the
    dimension; a leader is a mark of its own.
    """

    first: Point
    second: Point
    base: Point
    value: float
    text: Text
    lines: tuple[LineMark, ...]
    direction: float | None = None


Mark: TypeAlias = LineMark | CircleMark | Text | Dimension


@dataclass(frozen=True)
class Page:
    """Page of a size, mm, with the marks that stand on it."""

    name: str
    width: float
    height: float
    marks: list[Mark] = field(default_factory=list)

    def line(self, *points: Point, weight: float = THIN, layer: Layer = "DIM", pattern: Pattern = "") -> None:
        """Add an open line through points, mm."""
        self.marks.append(LineMark(np.array(points), weight, layer, pattern))

    def box(self, corner: Point, wide: float, high: float, weight: float = THIN, layer: Layer = "DIM") -> None:
        """Add a rectangle `wide` by `high` mm from its lower left corner; `weight` is the width of its line, mm."""
        x, y = corner
        corners = np.array([(x, y), (x + wide, y), (x + wide, y + high), (x, y + high)])
        self.marks.append(LineMark(corners, weight, layer, closed=True))

    def text(
        self,
        at: Point,
        text: str,
        height: float = SMALL,
        anchor: Anchor = "left",
        layer: Layer = "TEXT",
        *,
        turned: bool = False,
    ) -> None:
        """Add a text with its baseline at a point, mm, capitals `height` mm high; nothing for an empty text."""
        if text:
            self.marks.append(Text(at, text, height, anchor, layer, turned))

    @property
    def texts(self) -> list[Text]:
        """All texts of the page, texts of dimensions among them."""
        marks = (mark.text if isinstance(mark, Dimension) else mark for mark in self.marks)
        return [mark for mark in marks if isinstance(mark, Text)]


def arrow(tip: Point, angle: float) -> LineMark:
    """Filled arrowhead with its tip at a point, pointing in a direction, rad."""
    c, s = math.cos(angle), math.sin(angle)
    x, y = tip
    back = (x - ARROW * c, y - ARROW * s)
    sides = [(back[0] - SLENDER * s, back[1] + SLENDER * c), (back[0] + SLENDER * s, back[1] - SLENDER * c)]
    return LineMark(np.array([tip, *sides]), closed=True, filled=True)


def across(
    first: Point, second: Point, base: float, value: float, text: str, *, upright: bool = False, before: bool = False
) -> Dimension:
    """Dimension between two points along x, its line at the height `base`; or `upright` along y, its line at x = base.

    `value` is the length on the part, mm. The text stands above the line; where it does not fit between the arrows, it
    stands beyond the line's end, or `before` its start.
    """
    k = 1 if upright else 0
    low, high = sorted((first, second), key=lambda point: point[k])
    a, b = low[k], high[k]
    long = width(text, SMALL)

    def at(along: float, off: float) -> Point:
        return (off, along) if upright else (along, off)

    # k is the axis measured along; extension lines, arrows from inside or outside, then the dimension line
    lines = []
    for point in (low, high):
        sense = math.copysign(1.0, base - point[1 - k])
        lines.append(_line(at(point[k], point[1 - k] + sense * GAP), at(point[k], base + sense * BEYOND)))
    inside = has_room(b - a)
    quarter = 0.5 * math.pi if upright else 0.0
    lines.append(arrow(at(a, base), quarter + (math.pi if inside else 0.0)))
    lines.append(arrow(at(b, base), quarter + (0.0 if inside else math.pi)))
    start, end = (a, b) if inside else (a - 2.0 * ARROW, b + 2.0 * ARROW)
    beyond, middle = text_beyond(b - a, text), 0.5 * (a + b)
    if beyond:
        middle = a - beyond + 0.5 * long if before else b + beyond - 0.5 * long
        start, end = min(start, middle - 0.5 * long), max(end, middle + 0.5 * long)
    lines.append(_line(at(start, base), at(end, base)))
    raised = base - RAISED if upright else base + RAISED
    label = Text(at(middle, raised), text, SMALL, "middle", "DIM", turned=upright)
    return Dimension(first, second, at(middle, base), value, label, tuple(lines), 90.0 if upright else 0.0)


def has_room(long: float) -> bool:
    """Whether both arrows fit within a dimension line `long` mm; else they point at it from outside."""
    return long >= 2.0 * ARROW + 1.0


def text_beyond(between: float, text: str) -> float:
    """Length of a text beyond the end of its dimension line, mm, for ends `between` mm apart.

    0 where it fits within.
    """
    inside, long = has_room(between), width(text, SMALL)
    if inside and long + 2.0 <= between:
        return 0.0
    return long + 1.0 + (0.0 if inside else 2.0 * ARROW)


def round_size(centre: Point, radius: float, label: Text, value: float) -> Dimension:
    """Diameter of a circle, written at a label to which a leader of its own leads.

    Its points lie level, so that a program which draws the dimension anew writes its text level too; within a circle
    too small for the text, such a program moves it away from the view.
    """
    (x, y) = centre
    return Dimension((x + radius, y), (x - radius, y), (x - radius, y), value, label, ())


def finish_width(text: str) -> float:
    """Width of a surface symbol with its text, mm."""
    return (TICK + TALL) / SLOPE + width(text, SMALL) + 2.0


def finish_symbol(start: Point, text: str, side: int) -> list[LineMark | Text]:
    """Symbol of ISO 21920-1 of a surface that is machined, on the line of a leader that begins at `start`.

    `text` is its roughness; the symbol stands on the left of the leader with `side` -1, on the right with 1.
    """
    long = finish_width(text)
    x, y = start[0] - (long if side < 0 else 0.0), start[1]
    foot, first, last = x + TICK / SLOPE, x, x + (TICK + TALL) / SLOPE
    return [
        _line((x, y), (x + long, y)),
        _line((first, y + TICK), (foot, y), (last, y + TALL), (x + long, y + TALL)),
        _line((first, y + TICK), (foot + TICK / SLOPE, y + TICK)),
        Text((last + 0.8, y + TALL - 1.0 - SMALL), text, SMALL, "left", "DIM"),
    ]


def _line(*points: Point) -> LineMark:
    return LineMark(np.array(points))


def shifted(points: Sequence[Point] | Array, scale: float, origin: Point) -> Array:
    """Points of the part (n, 2), mm, on the paper: times the scale, the shaft at `origin`."""
    placed: Array = np.asarray(points) * scale + np.array(origin)
    return placed
