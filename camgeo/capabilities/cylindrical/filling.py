"""Triangles of blank and floor between lines on one cylinder, which all run round it the same way.

The points of the lines are passed in the order of the polar angle, as if a line along the axis went once round the
cylinder. On it intervals of metal and of groove follow one another from the lower face to the upper one. Each has a
front: points that triangles have not left behind, from the last one of its lower line to the last one of its upper
line. A new point becomes an end of the front, and every corner beside it that is a triangle is cut off at once, so that
triangles span hardly more angle than the edges of the lines. Where metal begins within a groove, the groove is parted
from the front's latest point; where it ends, the grooves on either side are one from there on.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.files.errors import RegionError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Indices

SAME = 1e-9  # rad: of points at one angle corners come first
WIDEST = 0.4817  # of the stretch without a corner, where the sweep begins: an odd share, at which no line has a point
CROSSED = "the lines on a cylinder of the drum cross"

Line = tuple[int, bool]  # its last point, and whether metal is above it


class Run(NamedTuple):
    """A line: numbers of its points by rising angles, whether it is closed, and whether metal lies above it."""

    points: Indices
    closed: bool
    under: bool


class Sweep:
    """Triangles on a cylinder between lines, from polar angles, rad, and heights, mm, of its points (k,).

    `metal` and `groove` have corners (m, 3) of triangles, counter-clockwise seen from outside. Raises RegionError where
    lines cross, or are so near to one another that no triangles fit between them.
    """

    def __init__(self, angle: Array, height: Array, runs: Sequence[Run]) -> None:
        self._z = height.tolist()
        self._found: tuple[list[tuple[int, int, int]], list[tuple[int, int, int]]] = ([], [])
        self._next: dict[Line, int] = {}
        self._into: dict[int, list[Line]] = {}
        self._out: dict[int, list[bool]] = {}
        for run in runs:
            points = run.points.tolist()
            following = [*points[1:], points[0]] if run.closed else points[1:]
            for a, b in zip(points, following, strict=False):
                self._next[a, run.under] = b
                self._into.setdefault(b, []).append((a, run.under))
                self._out.setdefault(a, []).append(run.under)
        corners = sorted({int(run.points[end]) for run in runs if not run.closed for end in (0, -1)})
        self._phi = np.mod(angle - _start(angle[corners]), TURN).tolist()
        self._at = list(self._phi)
        self._swept(corners)

    @property
    def metal(self) -> Indices:
        """Triangles of the metal."""
        return np.array(self._found[0], dtype=np.intp).reshape(-1, 3)

    @property
    def groove(self) -> Indices:
        """Triangles of the groove."""
        return np.array(self._found[1], dtype=np.intp).reshape(-1, 3)

    def _swept(self, corners: list[int]) -> None:
        begin = []
        for (a, under), b in self._next.items():
            if self._phi[b] < self._phi[a]:
                self._at[a] = self._phi[a] - TURN
                share = -self._at[a] / (self._phi[b] - self._at[a])
                begin.append((self._z[a] + share * (self._z[b] - self._z[a]), a, under))
        self._lines: list[Line] = [(a, under) for _, a, under in sorted(begin)]
        self._below = 0 if self._lines[0][1] else 1  # the blank begins with metal, the floor with the groove
        if any(under != (self._kind(i) == 0) for i, (_, under) in enumerate(self._lines)):
            raise RegionError(CROSSED)
        points = [a for a, _ in self._lines]
        self._fronts = [[a, b] for a, b in pairwise(points)]
        first = [list(front) for front in self._fronts]
        of_corner = set(corners)
        used = sorted(self._into.keys() | self._out.keys())
        for v in sorted(used, key=lambda v: (round(self._phi[v] / SAME), v not in of_corner)):
            self._at[v] = self._phi[v]
            came, goes = self._into.get(v, []), self._out.get(v, [])
            if len(came) == len(goes) == 1:
                self._advance(v, came[0], under=goes[0])
            elif not came:
                self._open(v)
            elif not goes:
                self._close(v, came)
            else:
                raise RegionError(CROSSED)
        if self._fronts != first:
            raise RegionError(CROSSED)

    def _kind(self, i: int) -> int:
        """Whether an interval, from below, is one of metal, 0, or of groove, 1."""
        return (i + self._below) % 2

    def _advance(self, v: int, came: Line, *, under: bool) -> None:
        """A line goes on to a point."""
        i = self._index(came)
        self._lines[i] = (v, under)
        if i > 0:
            self._join(i - 1, v, lower=False)
        if i < len(self._fronts):
            self._join(i, v, lower=True)

    def _open(self, v: int) -> None:
        """Metal begins within a groove."""
        i = sum(self._height(line, self._at[v]) < self._z[v] for line in self._lines) - 1
        if i < 0 or self._kind(i) == 0:
            raise RegionError(CROSSED)
        front = self._fronts[i]
        latest = max(range(len(front)), key=lambda k: self._at[front[k]])
        self._lines[i + 1 : i + 1] = [(v, True), (v, False)]
        self._fronts[i : i + 1] = [front[: latest + 1], [v, v], front[latest:]]
        self._join(i, v, lower=False)
        self._join(i + 2, v, lower=True)

    def _close(self, v: int, came: list[Line]) -> None:
        """Metal ends within a groove."""
        i = self._index(next(line for line in came if line[1]))
        if self._lines[i + 1] not in came:
            raise RegionError(CROSSED)
        self._join(i, v, lower=True)
        self._join(i, v, lower=False)
        if len(self._fronts[i]) > 2:
            raise RegionError(CROSSED)
        self._join(i - 1, v, lower=False)
        self._join(i + 1, v, lower=True)
        self._lines[i : i + 2] = []
        self._fronts[i - 1 : i + 2] = [self._fronts[i - 1] + self._fronts[i + 1][1:]]

    def _join(self, i: int, v: int, *, lower: bool) -> None:
        """A point becomes the end of a front on its lower line, or on its upper one."""
        front, found = self._fronts[i], self._found[self._kind(i)]
        if lower:
            front.insert(0, v)
        else:
            front.append(v)
        while len(front) > 2:
            a, b, c = (front[1], front[0], front[2]) if lower else (front[-3], front[-1], front[-2])
            if len({a, b, c}) == 3:
                if not self._turns_left(a, b, c):
                    return
                found.append((a, b, c))
            del front[1 if lower else -2]

    def _turns_left(self, a: int, b: int, c: int) -> bool:
        x, z = self._at, self._z
        return bool((x[b] - x[a]) * (z[c] - z[a]) - (x[c] - x[a]) * (z[b] - z[a]) > 0.0)

    def _index(self, line: Line) -> int:
        try:
            return self._lines.index(line)
        except ValueError:
            raise RegionError(CROSSED) from None

    def _height(self, line: Line, at: float) -> float:
        """Height, mm, of a line at an angle between its last point and the next one."""
        low, high = self._at[line[0]], self._phi[self._next[line]]
        high += TURN if high < low else 0.0
        a, b = self._z[line[0]], self._z[self._next[line]]
        return float(a + (at - low) / (high - low) * (b - a))


def _start(corners: Array) -> float:
    """An angle, rad, in the widest stretch without a corner."""
    if not corners.size:
        return WIDEST
    at = np.sort(np.mod(corners, TURN))
    gaps = np.diff(np.append(at, at[0] + TURN))
    k = int(np.argmax(gaps))
    return float(at[k] + WIDEST * gaps[k])
