"""Outlines of bodies: discs, boxes and bars, closed and counter-clockwise; pins and retainers. All in mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.assembly import Plate
from camgeo.curve import ring
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.mechanism.sizes import Sizes

Point = tuple[float, float]


def _outline(ring: ring.Ring) -> ArcSpline:
    return ArcSpline(ring.points, ring.bulges, EXACT)


def disc(radius: float, x: float = 0.0, y: float = 0.0) -> ArcSpline:
    """A circle of a radius about (x, y), mm, as arcs."""
    return _outline(ring.disc(x, y, radius))


def box(x0: float, y0: float, x1: float, y1: float) -> ArcSpline:
    """A rectangle from its lower left corner (x0, y0) to its upper right corner (x1, y1), mm."""
    return _outline(ring.box(x0, y0, x1, y1))


def bar(a: Point, b: Point, width: float) -> ArcSpline:
    """A bar of a width with round ends about the points a and b, mm; a disc where these are the same."""
    return _outline(ring.bar(a, b, width))


def transformed(outline: ArcSpline, x: float, y: float, angle: float) -> ArcSpline:
    """The outline turned about the origin by an angle, rad, counter-clockwise, then shifted by x and y, mm."""
    c, s = math.cos(angle), math.sin(angle)
    return ArcSpline(outline.points @ np.array([[c, s], [-s, c]]) + (x, y), outline.bulges, outline.bound)


def eye(s: Sizes, x: float = 0.0, y: float = 0.0) -> ArcSpline:
    """Outline of a hole, with running clearance, for a pin at (x, y), mm."""
    return disc(0.5 * s.hole, x, y)


def bars(s: Sizes, ends: Sequence[tuple[Point, Point]], holes: Sequence[Point], low: float, high: float) -> list[Plate]:
    """A plate from z = `low` to `high`, mm, for a bar between each pair of `ends`, with the pin holes that lie in it.

    `holes` are middles of holes. Raises ValueError where a bar would close a part of a hole.
    """
    plates = []
    for a, b in ends:
        inside = []
        for hole in holes:
            distance = _segment_distance(hole, a, b)
            if distance <= 0.5 * (s.bar - s.hole):
                inside.append(eye(s, *hole))
            elif distance < 0.5 * (s.bar + s.hole):
                raise ValueError("the bar to it cuts a pin's hole")
        plates.append(Plate(bar(a, b, s.bar), tuple(inside), low, high))
    return plates


def _segment_distance(point: Point, a: Point, b: Point) -> float:
    """Distance of a point from the line segment from a to b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    px, py = point[0] - a[0], point[1] - a[1]
    length = dx * dx + dy * dy
    share = min(max((px * dx + py * dy) / length, 0.0), 1.0) if length else 0.0
    return math.hypot(px - share * dx, py - share * dy)


def pin(s: Sizes, place: Point, foot: float, low: float, high: float, *, crowned: bool = True) -> tuple[Plate, ...]:
    """Plates of a pin that stands at `place` on z = `foot`, for a body between z = `low` and `high`; mm.

    The body rests on a wider shoulder, if there is height for one. A `crowned` pin reaches through the retainer above
    the body; other pins end with the body.
    """
    x, y = place
    shoulder = low - s.gap
    plates = [Plate(disc(0.5 * s.pin, x, y), (), max(foot, shoulder), high + s.gap + s.clip if crowned else high)]
    if shoulder - foot > 0.5 * s.gap:
        plates.insert(0, Plate(disc(s.boss, x, y), (), foot, shoulder))
    else:
        plates[0] = Plate(plates[0].outline, (), foot, plates[0].high)
    return tuple(plates)


def retainer(
    s: Sizes, place: Point, high: float, diameter: float | None = None, radius: float = 0.0
) -> tuple[Plate, ...]:
    """The plate of a disc pressed on a pin at `place`, above a body that ends at z = `high`; mm.

    `diameter` is the pin's, that of all pins if None. The disc is as wide as a bar, so that it passes wherever the
    bar's end does, and wider where the pin's wall or the least `radius` needs it.
    """
    x, y = place
    across = s.pin if diameter is None else diameter
    radius = max(0.5 * s.bar, 0.5 * across + s.wall, radius)
    low = high + s.gap
    return (Plate(disc(radius, x, y), (disc(0.5 * (across - s.press), x, y),), low, low + s.clip),)
