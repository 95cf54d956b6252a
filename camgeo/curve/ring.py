"""Chains of lines and arcs, the arithmetic of a bulge, and plane outlines: discs, boxes, bars.

The bulge of a piece is the tangent of a quarter of the angle that it turns through, positive counter-clockwise, 0 for a
line. Coordinates and radii are in one unit of length, mm for parts.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from kin.numeric.arrays import Array


FLAT = 0.02  # rad: an arc is flattened in steps of this turn at the most


MIRROR = np.array([1.0, -1.0])
Number = TypeVar("Number", float, "Array")


def radius_of(length: Number, bulge: Number) -> Number:
    """Radius of arcs, in the unit of `length`, from their chords' lengths and their bulges, none of them 0."""
    return length * (1.0 + bulge * bulge) / (4.0 * abs(bulge))


def centre_of(start: Array, end: Array, bulge: float) -> Array:
    """Centre (2,) of an arc from `start` to `end` (2,) with a bulge, not 0.

    It lies left of the chord where the arc turns left by less than half a turn.
    """
    chord = end - start
    centre: Array = 0.5 * (start + end) + np.array([-chord[1], chord[0]]) * ((1.0 - bulge * bulge) / (4.0 * bulge))
    return centre


def steps_along(start: Array, end: Array, bulge: float, count: int) -> Array:
    """Points (count, 2) of a piece in equal steps, the start first, the end left out.

    `bulge` is the piece's. Points are placed by chords from the start: no digits are lost where the centre is far away.
    """
    chord, sweep, share = end - start, 4.0 * math.atan(bulge), np.arange(count) / count
    part = sweep * share
    heading = math.atan2(chord[1], chord[0]) - 0.5 * sweep + 0.5 * part
    length = math.hypot(*chord.tolist()) * (np.sin(0.5 * part) / math.sin(0.5 * sweep) if sweep else share)
    points: Array = start + length[:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
    return points


@dataclass(frozen=True, eq=False)
class ArcChain:
    """Lines and arcs through points (n, 2) and back to the first; `bulges` (n,) of the piece after each point."""

    points: Array
    bulges: Array

    @property
    def chords(self) -> Array:
        """Chord vector of each piece (n, 2), from its start to its end."""
        chords: Array = np.roll(self.points, -1, axis=0) - self.points
        return chords

    @property
    def circle(self) -> tuple[tuple[float, float], float] | None:
        """Centre (x, y) and radius of a chain of two counter-clockwise half circles; None for any other chain."""
        if len(self.points) != 2 or not bool((self.bulges == 1.0).all()):
            return None
        x, y = (0.5 * (self.points[0] + self.points[1])).tolist()
        return (x, y), 0.5 * math.hypot(*(self.points[1] - self.points[0]).tolist())

    def pieces(self) -> Iterator[tuple[Array, Array, float]]:
        """Start (2,), end (2,) and bulge of each piece, in order."""
        return zip(self.points, np.roll(self.points, -1, axis=0), self.bulges.tolist(), strict=True)


@dataclass(frozen=True, eq=False)
class Ring(ArcChain):
    """A chain that is drawn; where it is not `closed`, the piece from the last point to the first is left out."""

    closed: bool = True

    @staticmethod
    def through(points: Sequence[tuple[float, float]] | Array, *, closed: bool = True) -> Ring:
        """Ring of straight lines through points (n, 2), back to the first if `closed`."""
        vertices = np.asarray(points, dtype=np.float64)
        return Ring(vertices, np.zeros(len(vertices)), closed)

    def scaled(self, factor: float) -> Ring:
        """Ring enlarged by a factor about the origin."""
        return replace(self, points=factor * self.points)

    def mirrored(self) -> Ring:
        """Ring mirrored about the x axis."""
        return replace(self, points=self.points * MIRROR, bulges=-self.bulges)

    def flattened(self) -> Array:
        """Points (m, 2) along the ring, arcs in steps of `FLAT`; a closed ring ends in its first point."""
        count = len(self.points) - (not self.closed)
        start, bulge = self.points[:count], self.bulges[:count]
        chord, sweep = self.chords[:count], 4.0 * np.arctan(bulge)
        steps = np.maximum(1, np.ceil(np.abs(sweep) / FLAT)).astype(np.intp)
        piece = np.repeat(np.arange(count), steps)
        share = (np.arange(len(piece)) - np.repeat(np.cumsum(steps) - steps, steps)) / steps[piece]
        # along chords from the start, as in `steps_along`
        half = 0.5 * sweep[piece]
        heading = (np.arctan2(chord[:, 1], chord[:, 0]) - 0.5 * sweep)[piece] + share * half
        along = np.divide(np.sin(share * half), np.sin(half), out=share.copy(), where=half != 0.0)
        length = np.hypot(chord[:, 0], chord[:, 1])[piece] * along
        points = start[piece] + length[:, None] * np.column_stack((np.cos(heading), np.sin(heading)))
        return np.concatenate((points, self.points[:1] if self.closed else self.points[-1:]))

    def path(self, digits: int) -> str:
        """The ring as the data of an SVG path, its coordinates with `digits` decimals."""
        x, y = (_text(column, digits) for column in self.points.T)
        text = [f"M{x[0]} {y[0]}"]
        count = len(self.points)
        for i in range(count if self.closed else count - 1):
            j, bulge = (i + 1) % count, float(self.bulges[i])
            if bulge:
                radius = f"{radius_of(math.hypot(*(self.points[j] - self.points[i])), bulge):.{digits}f}"
                flags = f"{int(abs(bulge) > 1.0)} {int(bulge > 0.0)}"
                text.append(f"A{radius} {radius} 0 {flags} {x[j]} {y[j]}")
            elif j:
                text.append(f"L{x[j]} {y[j]}")
        return "".join([*text, "Z"] if self.closed else text)


def _text(values: Array, digits: int) -> list[str]:
    return [f"{value:.{digits}f}".rstrip("0").rstrip(".") if digits else f"{value:.0f}" for value in values + 0.0]


def disc(x: float, y: float, radius: float) -> Ring:
    """Circle of a radius about (x, y), mm, as a closed ring of two arcs."""
    return Ring(np.array([[x - radius, y], [x + radius, y]]), np.ones(2))


def box(x0: float, y0: float, x1: float, y1: float) -> Ring:
    """A rectangle with the opposite corners (x0, y0) and (x1, y1)."""
    return Ring.through([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def bar(a: tuple[float, float], b: tuple[float, float], width: float) -> Ring:
    """A bar of a width with round ends about two points (x, y); a disc where the points coincide."""
    (ax, ay), (bx, by) = a, b
    length = math.hypot(bx - ax, by - ay)
    if length < 1e-9 * width:
        return disc(ax, ay, 0.5 * width)
    nx, ny = -0.5 * width * (by - ay) / length, 0.5 * width * (bx - ax) / length
    points = [(ax - nx, ay - ny), (bx - nx, by - ny), (bx + nx, by + ny), (ax + nx, ay + ny)]
    return Ring(np.array(points), np.array([0.0, 1.0, 0.0, 1.0]))
