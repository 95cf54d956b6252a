"""A fitted contour in plain numbers: lines, arcs and splines for a script of a CAD program to build from."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, TypeAlias, overload

import numpy as np

from camgeo.curve.ring import centre_of, radius_of, steps_along
from camgeo.fit.pieces import ArcSpline, Polygon
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from camgeo.fit.pieces import Outline
    from kin.numeric.arrays import Array

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
        return _points(steps_along(np.array(self.start), np.array(self.end), math.tan(0.25 * self.sweep), 2))[1]


@dataclass(frozen=True)
class Spline:
    """A B-spline from `start` to `end`: control points (x, y) in mm, and degree + 1 more knots than control points.

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
    """Edges of a closed contour, counter-clockwise, each beginning where the one before ends; mm.

    It is proved that no point of them lies farther than `outward` outside or `inward` inside of the exact contour.
    `area`, mm^2, is the enclosed area.
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
        """Edges of a fitted outline: lines, lines and arcs, or one spline."""
        if isinstance(outline, Polygon):
            corners = _points(outline.vertices)
            edges: tuple[Edge, ...] = tuple(
                itertools.starmap(Line, zip(corners, (*corners[1:], corners[0]), strict=True))
            )
        elif isinstance(outline, ArcSpline):
            edges = tuple(itertools.starmap(_piece, outline.pieces()))
        else:
            start = _points(outline.beziers()[:1, 0])[0]
            knots = tuple(outline.knots.tolist())
            edges = (Spline(start, start, outline.degree, _points(outline.control), knots),)
        return Edges(edges, outline.bound.outward, outline.bound.inward, outline.area)


def _points(rows: Iterable[Iterable[float]]) -> tuple[Point, ...]:
    return tuple((float(x), float(y)) for x, y in rows)


def _piece(start: Array, end: Array, bulge: float) -> Edge:
    """An arc from its bulge, or a line."""
    if bulge == 0.0:
        return Line(*_points((start, end)))
    a, b, centre = _points((start, end, centre_of(start, end, bulge)))
    return Arc(a, b, centre, radius_of(math.dist(a, b), bulge), 4.0 * math.atan(bulge))
