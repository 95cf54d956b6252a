"""Plane outlines of lines and arcs: discs, boxes, bars."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array


FLAT = 0.02  # rad: an arc is measured and flattened in steps of about this


MIRROR = np.array([1.0, -1.0])


@dataclass(frozen=True, eq=False)
class Ring:
    """Lines and arcs through points (n, 2); bulge (n,) = tan(sweep/4) of the piece that follows each point."""

    points: Array
    bulges: Array
    closed: bool = True

    @staticmethod
    def through(points: Sequence[tuple[float, float]] | Array, *, closed: bool = True) -> Ring:
        """Return straight lines through points."""
        at = np.asarray(points, dtype=np.float64)
        return Ring(at, np.zeros(len(at)), closed)

    def scaled(self, factor: float) -> Ring:
        """Return the ring enlarged about the origin."""
        return replace(self, points=factor * self.points)

    def mirrored(self) -> Ring:
        """Return its image in the x axis."""
        return replace(self, points=self.points * MIRROR, bulges=-self.bulges)

    def flattened(self) -> Array:
        """Return points (m, 2) along it, arcs in steps of `FLAT`; the first is repeated at the end if it is closed."""
        end = np.roll(self.points, -1, axis=0)
        pieces = list(zip(self.points, end, self.bulges, strict=True))
        pieces = pieces if self.closed else pieces[:-1]
        found = [_along(a, b, float(bulge)) for a, b, bulge in pieces]
        return np.concatenate([*found, self.points[:1] if self.closed else self.points[-1:]])

    def path(self, digits: int) -> str:
        """Return the ring as the data of an SVG path, coordinates rounded to so many digits."""
        x, y = (_text(column, digits) for column in self.points.T)
        text = [f"M{x[0]} {y[0]}"]
        count = len(self.points)
        for i in range(count if self.closed else count - 1):
            j, bulge = (i + 1) % count, float(self.bulges[i])
            if bulge:
                chord = math.hypot(*(self.points[j] - self.points[i]))
                radius = f"{chord * (1.0 + bulge * bulge) / (4.0 * abs(bulge)):.{digits}f}"
                flags = f"{int(abs(bulge) > 1.0)} {int(bulge > 0.0)}"
                text.append(f"A{radius} {radius} 0 {flags} {x[j]} {y[j]}")
            elif j:
                text.append(f"L{x[j]} {y[j]}")
        return "".join([*text, "Z"] if self.closed else text)


def _along(a: Array, b: Array, bulge: float) -> Array:
    """Points (m, 2) of a piece without its end."""
    sweep = 4.0 * math.atan(bulge)
    share = np.arange(max(1, math.ceil(abs(sweep) / FLAT))) / max(1, math.ceil(abs(sweep) / FLAT))
    if not bulge:
        return a[None, :]
    half, middle = 0.5 * (b - a), 0.5 * (a + b)
    centre = middle + np.array([-half[1], half[0]]) * (1.0 - bulge * bulge) / (2.0 * bulge)
    angle = sweep * share
    ray = a - centre
    c, s = np.cos(angle), np.sin(angle)
    points: Array = centre + np.column_stack([ray[0] * c - ray[1] * s, ray[0] * s + ray[1] * c])
    return points


def _text(values: Array, digits: int) -> list[str]:
    return [f"{value:.{digits}f}".rstrip("0").rstrip(".") if digits else f"{value:.0f}" for value in values + 0.0]


def disc(x: float, y: float, radius: float) -> Ring:
    """Return a circle."""
    return Ring(np.array([[x - radius, y], [x + radius, y]]), np.ones(2))


def box(x0: float, y0: float, x1: float, y1: float) -> Ring:
    """Return a rectangle."""
    return Ring.through([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def bar(a: tuple[float, float], b: tuple[float, float], width: float) -> Ring:
    """Return a bar with round ends about two points; a disc where these are one."""
    (ax, ay), (bx, by) = a, b
    length = math.hypot(bx - ax, by - ay)
    if length < 1e-9 * width:
        return disc(ax, ay, 0.5 * width)
    nx, ny = -0.5 * width * (by - ay) / length, 0.5 * width * (bx - ax) / length
    points = [(ax - nx, ay - ny), (bx - nx, by - ny), (bx + nx, by + ny), (ax + nx, ay + ny)]
    return Ring(np.array(points), np.array([0.0, 1.0, 0.0, 1.0]))
