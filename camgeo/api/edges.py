"""A fitted contour in plain numbers: lines, arcs and splines for a script of a CAD program to build from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias, overload

from camgeo.fit.pieces import ArcSpline, BSpline, Polygon

if TYPE_CHECKING:
    from camgeo.fit.pieces import Outline

Form: TypeAlias = Literal["arcs", "spline", "polyline"]
FORMS = ("arcs", "spline", "polyline")
Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Line:
    """A straight edge; points (x, y) in mm."""

    start: Point
    end: Point


@dataclass(frozen=True)
class Arc:
    """An arc of a circle; points (x, y) and radius in mm. `sweep` is in radians, positive counter-clockwise."""

    start: Point
    end: Point
    center: Point
    radius: float
    sweep: float

    @property
    def middle(self) -> Point:
        """The point half way along, for CAD programs whose arcs go through three points."""
        (x0, y0), (x1, y1) = self.start, self.end
        bulge = math.tan(0.25 * self.sweep)  # from the chord, so that a distant centre costs no digits
        return 0.5 * (x0 + x1) + 0.5 * bulge * (y1 - y0), 0.5 * (y0 + y1) - 0.5 * bulge * (x1 - x0)


@dataclass(frozen=True)
class Spline:
    """A B-spline from `start` to `end`: control points (x, y) in mm, and degree + 1 more knots than those.

    The curve runs from knots[degree] to knots[-1 - degree]. The spline of a whole contour ends where it starts.
    """

    start: Point
    end: Point
    degree: int
    control: tuple[Point, ...]
    knots: tuple[float, ...]


Edge: TypeAlias = Line | Arc | Spline


@dataclass(frozen=True)
class Edges(Sequence[Edge]):
    """The edges of a closed contour, counter-clockwise, each beginning where the one before ends; mm.

    No point of them is proved to lie farther than `outward` outside or `inward` inside of the exact contour. `area`,
    mm^2, is what they enclose.
    """

    edges: tuple[Edge, ...]
    outward: float
    inward: float
    area: float

    @property
    def bound(self) -> float:
        """Proved greatest distance from the exact contour, mm."""
        return max(self.outward, self.inward)

    @overload
    def __getitem__(self, index: int) -> Edge: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Edge, ...]: ...

    def __getitem__(self, index: int | slice) -> Edge | tuple[Edge, ...]:
        return self.edges[index]

    def __len__(self) -> int:
        return len(self.edges)

    @staticmethod
    def of(outline: Outline) -> Edges:
        """Tell a fitted outline in plain numbers; a rational spline is not among them."""
        if isinstance(outline, Polygon):
            edges: tuple[Edge, ...] = tuple(Line(a, b) for a, b in _around(_points(outline.vertices.tolist())))
        elif isinstance(outline, ArcSpline):
            ends = _around(_points(outline.points.tolist()))
            edges = tuple(_piece(a, b, t) for (a, b), t in zip(ends, outline.bulges.tolist(), strict=True))
        elif isinstance(outline, BSpline):
            start = _points(outline.beziers()[:1, 0].tolist())[0]
            knots = tuple(outline.knots.tolist())
            edges = (Spline(start, start, outline.degree, _points(outline.control.tolist()), knots),)
        else:
            raise TypeError("a rational spline has weights, which no edge has")
        return Edges(edges, outline.bound.outward, outline.bound.inward, outline.area)


def _points(rows: list[list[float]]) -> tuple[Point, ...]:
    return tuple((x, y) for x, y in rows)


def _around(points: tuple[Point, ...]) -> list[tuple[Point, Point]]:
    return list(zip(points, (*points[1:], points[0]), strict=True))


def _piece(start: Point, end: Point, bulge: float) -> Edge:
    """An arc from its bulge, the tangent of a quarter of its sweep; a line where that is 0."""
    if bulge == 0.0:
        return Line(start, end)
    (x0, y0), (x1, y1) = start, end
    dx, dy = x1 - x0, y1 - y0
    # the centre lies on the left of the chord's middle where the arc turns left by less than half a turn
    off = 0.25 * (1.0 / bulge - bulge)
    center = (0.5 * (x0 + x1) - off * dy, 0.5 * (y0 + y1) + off * dx)
    radius = 0.25 * math.hypot(dx, dy) * (abs(bulge) + 1.0 / abs(bulge))
    return Arc(start, end, center, radius, 4.0 * math.atan(bulge))
