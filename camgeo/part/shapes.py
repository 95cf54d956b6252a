"""Closed outlines of lines and arcs for what is cut into a part: circles, keyed bores, flats, polygons, slots.

In the cam's axes, mm, counter-clockwise. A circle is two halves, and keeps its centre and radius for drawing.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline
from kin.contour.contour import Contour
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.numeric.arrays import Array

QUARTER = 1e-14  # rad: an angle this near to a quarter turn is one, rounded
Layer = Literal["CUT", "BORE", "HOLES", "MARK", "ENGRAVE"]


@dataclass(frozen=True, eq=False)
class Opening:
    """One closed outline cut into the part: through everything, or `depth` mm into the upper face of the disc.

    `layer` is the layer of a drawing; `circle` is the centre and radius of a round opening, mm, None for any other.
    `island` is whether it lies in the metal within the inner of two surfaces.
    """

    name: str
    layer: Layer
    outline: ArcSpline
    circle: tuple[tuple[float, float], float] | None = None
    depth: float | None = None
    island: bool = False

    def mirrored(self) -> Opening:
        """Opening mirrored about the x axis."""
        circle = self.circle and ((self.circle[0][0], -self.circle[0][1]), self.circle[1])
        return Opening(self.name, self.layer, self.outline.mirrored(), circle, self.depth, self.island)

    @cached_property
    def chain(self) -> Arcs:
        """The outline as lines and arcs of at most half a turn."""
        return Contour.from_bulges(self.outline.points, self.outline.bulges).as_arcs()[0]

    @cached_property
    def middle(self) -> tuple[float, float]:
        """Middle (x, y) of the bounding box, mm."""
        x_min, y_min, x_max, y_max = self.outline.box()
        return 0.5 * (x_min + x_max), 0.5 * (y_min + y_max)

    @cached_property
    def reach(self) -> float:
        """Upper bound of the distance of the outline's points from `middle`, mm: half the box's diagonal."""
        x_min, y_min, x_max, y_max = self.outline.box()
        return 0.5 * math.hypot(x_max - x_min, y_max - y_min)

    @property
    def radius(self) -> float:
        """Radius, mm, of a circle about `middle` that encloses the opening."""
        return self.reach if self.circle is None else self.circle[1]


def disc(name: str, layer: Layer, centre: tuple[float, float], radius: float) -> Opening:
    """Round opening of a radius about a centre (x, y), mm, through everything."""
    x, y = centre
    points = np.array([[x + radius, y], [x - radius, y]])
    return Opening(name, layer, ArcSpline(points, np.ones(2), EXACT), (centre, radius))


def hole_at(name: str, circle: float, diameter: float, angle: float) -> Opening:
    """Round hole whose centre lies on a circle of a diameter about the shaft, mm, at an angle, rad."""
    return disc(name, "HOLES", polar(0.5 * circle, angle), 0.5 * diameter)


def keyed(radius: float, width: float, depth: float, angle: float) -> ArcSpline:
    """Circle of a radius, mm, about the origin with a keyway; its bottom is `depth` beyond the circle (DIN 6885 t2).

    `angle`, rad, is the direction of the keyway's middle. Raises ValueError for a keyway wider than the circle.
    """
    half = 0.5 * width
    bottom, corner = radius + depth, math.sqrt(radius * radius - half * half)
    sweep = 2.0 * (math.pi - math.asin(half / radius))
    points = np.array([[corner, half], [corner, -half], [bottom, -half], [bottom, half]])
    return ArcSpline(_turned(points, angle), np.array([math.tan(0.25 * sweep), 0.0, 0.0, 0.0]), EXACT)


def flattened(radius: float, across: float, angle: float) -> ArcSpline:
    """Circle of a radius, mm, about the origin with a flat, `across` mm from the opposite side of the circle.

    The flat's normal points to `angle`, rad. Raises ValueError where `across` is not between 0 and the diameter.
    """
    height = across - radius
    half = math.sqrt(radius * radius - height * height)
    sweep = 2.0 * (math.pi - math.acos(height / radius))
    points = np.array([[height, half], [height, -half]])
    return ArcSpline(_turned(points, angle), np.array([math.tan(0.25 * sweep), 0.0]), EXACT)


def polygonal(sides: int, across: float, normal: float) -> ArcSpline:
    """Regular polygon about the origin, `across` mm over flats; one flat's normal points to `normal`, rad."""
    corner = 0.5 * across / math.cos(math.pi / sides)
    angle = normal + (2.0 * np.arange(sides) - 1.0) * math.pi / sides
    points = corner * np.column_stack([np.cos(angle), np.sin(angle)])
    return ArcSpline(points, np.zeros(sides), EXACT)


def slot(inner: float, outer: float, width: float) -> ArcSpline:
    """Slot of this width, mm, with round ends along the x axis, which reach to the radii `inner` and `outer`, mm."""
    half = 0.5 * width
    points = np.array([[inner + half, -half], [outer - half, -half], [outer - half, half], [inner + half, half]])
    return ArcSpline(points, np.array([0.0, 1.0, 0.0, 1.0]), EXACT)


def slot_across(radius: float, length: float, width: float, angle: float) -> ArcSpline:
    """Slot with round ends, `length` over them, mm, square to the ray at `angle`, rad, its middle at `radius`."""
    half, end = 0.5 * width, 0.5 * (length - width)
    points = np.array([[radius + half, -end], [radius + half, end], [radius - half, end], [radius - half, -end]])
    return ArcSpline(_turned(points, angle), np.array([0.0, 1.0, 0.0, 1.0]), EXACT)


def slot_at(middle: tuple[float, float], length: float, width: float, angle: float) -> ArcSpline:
    """Slot with round ends about a middle (x, y), `length` over them, mm, its length in a direction, rad."""
    half, end = 0.5 * width, 0.5 * (length - width)
    points = np.array([[-end, -half], [end, -half], [end, half], [-end, half]])
    return ArcSpline(_turned(points, angle) + np.array(middle), np.array([0.0, 1.0, 0.0, 1.0]), EXACT)


def strip(reach: float, width: float, angle: float) -> ArcSpline:
    """Rectangle of this width, mm, along the ray at `angle`, rad, from the origin to the radius `reach`."""
    half = 0.5 * width
    points = np.array([[0.0, -half], [reach, -half], [reach, half], [0.0, half]])
    return ArcSpline(_turned(points, angle), np.zeros(4), EXACT)


def polar(radius: float, angle: float) -> tuple[float, float]:
    """Point (x, y) at a radius, mm, and an angle, rad; exact on the axes."""
    c, s = _direction(angle)
    return radius * c + 0.0, radius * s + 0.0


def _turned(points: Array, angle: float) -> Array:
    """Turn points (n, 2) about the origin; by nothing or quarter turns exactly."""
    c, s = _direction(angle)
    turned: Array = points @ np.array([[c, s], [-s, c]])
    return turned


def _direction(angle: float) -> tuple[float, float]:
    """Cosine and sine, exact at quarter turns."""
    quarters = round(angle / (0.5 * math.pi))
    if abs(angle - quarters * 0.5 * math.pi) < QUARTER:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[quarters % 4]
    return math.cos(angle), math.sin(angle)
