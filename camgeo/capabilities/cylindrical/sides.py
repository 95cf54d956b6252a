"""Faces of a cylinder about the axis between lines on it that cross nowhere: those of metal, or of a groove.

The cylinder is parted along two lines, opposite one another. On either of them what is wanted and what is not follow
one another from the lower end to the upper one, so that every other stretch between two vertices is an edge. An edge
has what is wanted on its left, as seen from outside, and within a half one edge leaves each vertex: so loops follow. A
loop that runs counter-clockwise bounds a face, one that runs clockwise is a hole in it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.files.errors import RegionError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from camgeo.files.brep import Shape
    from kin.numeric.arrays import Array

ON_CUT = 1e-8  # rad: a vertex so near a line that parts the cylinder lies on it
CROSSED = "the lines on a cylinder of the drum cross"


class _Arc(NamedTuple):
    """An edge from one vertex to another, by their numbers, in the sense of its loop; places (n, 2), rad and mm."""

    edge: Shape
    start: int
    end: int
    places: Array


class Sides:
    """Faces of a cylinder of a radius, mm, which is parted at the polar angle `cut`, rad, and opposite to it."""

    def __init__(self, radius: float, cut: float) -> None:
        self.radius, self.cut = radius, cut
        self.vertices: list[Shape] = []
        self.at: list[tuple[float, float]] = []  # angle behind the cut, up to a turn, and height
        self.arcs: tuple[list[_Arc], list[_Arc]] = ([], [])

    def add(self, edge: Shape, ends: tuple[Shape, Shape], points: Array, *, forward: bool) -> None:
        """Add an edge along rising polar angles between two vertices, through or close by points (n, 3), mm.

        `forward` where what is wanted lies on its left.
        """
        angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
        half = int((0.5 * (angle[0] + angle[-1]) - self.cut) % TURN // (0.5 * TURN))
        middle = self.cut + 0.5 * TURN * (half + 0.5)
        angle += TURN * np.round((middle - 0.5 * (angle[0] + angle[-1])) / TURN)
        places = np.column_stack([angle, points[:, 2]])
        start, end = self._number(ends[0], places[0]), self._number(ends[1], places[-1])
        arc = _Arc(edge, start, end, places) if forward else _Arc(edge.Reversed(), end, start, places[::-1])
        self.arcs[half].append(arc)

    def _number(self, vertex: Shape, place: Array) -> int:
        for number, other in enumerate(self.vertices):
            if other.IsSame(vertex):
                return number
        self.vertices.append(vertex)
        behind = (float(place[0]) - self.cut) % TURN
        self.at.append((0.0 if TURN - behind < ON_CUT else behind, float(place[1])))
        return len(self.vertices) - 1

    def faces(self) -> Iterator[tuple[float, list[Shape], list[list[Shape]]]]:
        """For each face the polar angle of the middle of its half, rad, its edges, and those of its holes.

        Edges are in the sense of their loops, with the face on their left. Raises RegionError for lines that cross.
        """
        uprights = [self._uprights(k) for k in (0, 1)]
        for half, arcs in enumerate(self.arcs):
            left, right = uprights[half], uprights[1 - half]
            ways = [self._upright(edge.Reversed(), pair[::-1], half) for edge, pair in left]
            ways += [self._upright(edge, pair, half + 1) for edge, pair in right]
            loops = _loops([*arcs, *ways])
            outer = [loop for loop in loops if _area(loop) > 0.0]
            holes: list[list[list[Shape]]] = [[] for _ in outer]
            for loop in loops:
                if _area(loop) <= 0.0:
                    inside = [k for k, other in enumerate(outer) if _holds(other, loop[0].places[0])]
                    if len(inside) != 1:
                        raise RegionError(CROSSED)
                    holes[inside[0]].append([arc.edge for arc in loop])
            middle = self.cut + 0.5 * TURN * (half + 0.5)
            for loop, within in zip(outer, holes, strict=True):
                yield middle, [arc.edge for arc in loop], within

    def _uprights(self, number: int) -> list[tuple[Shape, tuple[int, int]]]:
        """Edges along a line that parts the cylinder, with their vertices, the lower one first."""
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge

        on = [k for k, (angle, _) in enumerate(self.at) if abs(angle - 0.5 * TURN * number) < ON_CUT]
        on.sort(key=lambda k: self.at[k][1])
        if len(on) % 2:
            raise RegionError(CROSSED)
        pairs = zip(on[::2], on[1::2], strict=True)
        return [(BRepBuilderAPI_MakeEdge(self.vertices[a], self.vertices[b]).Edge(), (a, b)) for a, b in pairs]

    def _upright(self, edge: Shape, pair: tuple[int, int], halves: int) -> _Arc:
        places = [(self.cut + 0.5 * TURN * halves, self.at[k][1]) for k in pair]
        return _Arc(edge, *pair, np.array(places))


def _loops(arcs: Sequence[_Arc]) -> list[list[_Arc]]:
    """Edges as loops; raises RegionError where not one edge leaves each vertex and one comes to it."""
    leaving = {arc.start: arc for arc in arcs}
    if len(leaving) != len(arcs) or leaving.keys() != {arc.end for arc in arcs}:
        raise RegionError(CROSSED)
    loops = []
    while leaving:
        loop = [leaving.pop(next(iter(leaving)))]
        while loop[-1].end != loop[0].start:
            loop.append(leaving.pop(loop[-1].end))
        loops.append(loop)
    return loops


def _area(loop: Sequence[_Arc]) -> float:
    """Area, rad mm, on the left of a loop."""
    x, y = np.concatenate([arc.places for arc in loop]).T
    return 0.5 * float(x @ np.roll(y, -1) - np.roll(x, -1) @ y)


def _holds(loop: Sequence[_Arc], place: Array) -> bool:
    """Whether a place lies within a loop: the loop passes above it an odd number of times."""
    x, y = np.concatenate([arc.places for arc in loop]).T
    x1, y1 = np.roll(x, -1), np.roll(y, -1)
    over = (x > place[0]) != (x1 > place[0])
    share = np.where(over, (place[0] - x) / np.where(over, x1 - x, 1.0), 0.0)
    return int(np.count_nonzero(over & (y + share * (y1 - y) > place[1]))) % 2 == 1


def widest_gap(phi: Array) -> float:
    """An angle, rad, that together with the one opposite is as far as can be from angles phi (n,), rad."""
    at = np.sort(np.mod(phi, 0.5 * TURN))
    gaps = np.diff(np.append(at, at[0] + math.pi))
    k = int(np.argmax(gaps))
    return float(at[k] + 0.5 * gaps[k])
