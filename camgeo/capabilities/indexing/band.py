"""Triangles of blank and floor: a band in one layer between two lines, along both of which the polar angle rises.

The points of both lines are passed in the order of the polar angle. Behind them lie triangles, before them a front:
points from the last one of the lower line to the last one of the upper one. A new point becomes an end of the front,
and every corner beside it that is a triangle is cut off at once. What then spans too much of the layer is divided:
edges that no line has are halved, until each is short enough.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.files.errors import RegionError
from kin.numeric.arrays import paired, runs_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array, Indices

CROSSED = "two lines in a layer of the cam cross"
SHARP = 1e-2  # sine of a corner of one line that goes on, below which it is cut off at the end alone
FLAT = 1e-9  # sine of a corner that is none
ROUNDS = 60
APART = 0.7  # of the height that a triangle may span: lower bands are not divided into cells
THIN = 0.25  # of the height that a triangle may span: nearer lines have common angles
LESS = 1.0 - 1e-9  # of what a triangle may span: a cell, so that rounding does not have it divided
CLEAR = 0.5  # of a cell, between the cells and a line
SAME = 1e-12  # rad


class Filled(NamedTuple):
    """Triangles (t, 3), counter-clockwise over polar angle and height, and the places of points added (k,) each.

    The points of the lines are numbered first, in the order in which they were given, then those that were added.
    """

    triangles: Indices
    phi: Array
    h: Array


def band(x: Array, y: Array, lower: Indices, upper: Indices) -> Indices:
    """Triangles (t, 3) between two lines of points, numbers (n,) and (m,), which begin and end in common.

    x rises along both. Raises RegionError where the lines cross.
    """
    along, up = x.tolist(), y.tolist()
    low, high = lower.tolist(), upper.tolist()
    below = set(low)
    order = sorted(
        [(along[k], 0, place, k) for place, k in enumerate(low[1:-1])]
        + [(along[k], 1, place, k) for place, k in enumerate(high[1:-1])]
    )
    found: list[tuple[int, int, int]] = []
    front = [low[0]]

    def sharpest(a: int, b: int, c: int) -> float:
        sizes = [math.hypot(along[q] - along[p], up[q] - up[p]) for p, q in ((a, b), (b, c), (c, a))]
        turn = (along[b] - along[a]) * (up[c] - up[a]) - (along[c] - along[a]) * (up[b] - up[a])
        product = sizes[0] * sizes[1] * sizes[2]
        return turn * min(sizes) / product if product else 0.0

    def onwards(a: int, b: int, c: int) -> bool:
        ahead = (along[b] - along[a]) * (along[c] - along[b])
        return bool(ahead + (up[b] - up[a]) * (up[c] - up[b]) > 0.0)

    def cut(least: float, *, start: bool) -> None:
        while len(front) > 2:
            a, b, c = (front[1], front[0], front[2]) if start else (front[-3], front[-1], front[-2])
            alike = (a in below) == (b in below) == (c in below)
            if not sharpest(a, b, c) > (least if alike and onwards(*front[:3] if start else front[-3:]) else FLAT):
                return
            found.append((a, b, c))
            del front[1 if start else -2]

    for _, which, _, k in order:
        if which == 0:
            front.insert(0, k)
        else:
            front.append(k)
        cut(SHARP, start=which == 0)
    _close([*front, low[-1]], found, sharpest)
    return np.array(found, dtype=np.intp).reshape(-1, 3)


def _close(front: list[int], found: list[tuple[int, int, int]], sharpest: Callable[[int, int, int], float]) -> None:
    """Cut the corners of what is left, the widest first: a loop, clockwise, of a front and the lines' last point.

    `sharpest` gives the least sine of a triangle's corners, below 0 where it is turned over.
    """
    loop = list(reversed(front))
    while len(loop) > 2:
        best, at = FLAT, -1
        n = len(loop)
        for i in range(n):
            least = sharpest(loop[i - 1], loop[i], loop[(i + 1) % n])
            if least > best:
                best, at = least, i
        if at < 0:
            raise RegionError(CROSSED)
        found.append((loop[at - 1], loop[at], loop[(at + 1) % n]))
        del loop[at]


def filled(
    places: tuple[Array, Array], lower: Indices, upper: Indices, scale: tuple[float, float], wide: tuple[float, float]
) -> Filled:
    """The band between two lines of points at `places`: polar angles, rad, and heights (n,); as `band` raises.

    `scale` has the lengths of both units, mm. No edge but those of the lines spans more than `wide`.
    """
    (phi, h), known = places, places[0].size
    phi, h, lines, inner = _laid(phi, h, (lower, upper), wide)
    found = [band(phi * scale[0], h * scale[1], low, high) for low, high in lines]
    if sum(map(len, found)) != sum(low.size + high.size - 4 for low, high in lines):
        raise RegionError(CROSSED)
    triangles = np.concatenate([*found, inner])
    for _ in range(ROUNDS):
        start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
        low, high = np.minimum(start, end), np.maximum(start, end)
        key, first, back, count = np.unique(
            paired(low, high, phi.size), return_index=True, return_inverse=True, return_counts=True
        )
        a, b = low[first], high[first]
        long = (np.abs(phi[a] - phi[b]) > wide[0]) | (np.abs(h[a] - h[b]) > wide[1])
        long &= count == 2
        if not long.any():
            return Filled(triangles, phi[known:], h[known:])
        middle = np.full(key.size, -1, dtype=np.intp)
        middle[long] = phi.size + np.arange(np.count_nonzero(long))
        phi = np.concatenate([phi, 0.5 * (phi[a] + phi[b])[long]])
        h = np.concatenate([h, 0.5 * (h[a] + h[b])[long]])
        triangles = _divided(triangles, middle[back].reshape(-1, 3), phi / wide[0], h / wide[1])
    raise RegionError("a layer of the cam is not divided finely enough")


def _laid(
    phi: Array, h: Array, lines: tuple[Indices, Indices], wide: tuple[float, float]
) -> tuple[Array, Array, list[tuple[Indices, Indices]], Indices]:
    """Places with those of cells laid between two lines, the pairs of lines that are left to fill, and cells in halves.

    On a saddle right triangles along both of its curvatures are as large as triangles within a tolerance can be: their
    third sides run where it is straight. What is left lies below and above the cells; where these end, one line between
    the two goes on.
    """
    lower, upper = lines
    x, y = [phi[each] for each in lines], [h[each] for each in lines]
    at = np.unique(np.concatenate(x))
    gap = np.interp(at, x[1], y[1]) - np.interp(at, x[0], y[0])
    nothing = np.zeros((0, 3), dtype=np.intp)
    if not float(gap.max()) > APART * wide[1]:
        return phi, h, [lines], nothing
    size = LESS * wide[0], LESS * wide[1]
    count = max(2, math.floor((at[-1] - at[0]) / size[0]))
    even = at[0] + size[0] * np.arange(count + 1)
    rows = [_rows(even, x[0], y[0], size[1]), -_rows(even, x[1], -y[1], size[1])]
    blocks = _blocks(rows[0], rows[1])
    first, below, above, inner = phi.size, [lower[:1]], [lower[:1]], [nothing]
    begins = float(at[0])
    for block in [*blocks, None]:
        ends = float(at[-1]) if block is None else float(even[block.start])
        free = (at > begins) & (at < ends)
        own = at[free & (gap < THIN * wide[1])]
        # beside cells a place where a line has a point, so that the way there crosses none
        own = np.concatenate([own, even[(even > begins) & (even < ends)], at[free][:1], at[free][-1:]])
        own = np.unique(own)
        own = own[np.append(np.diff(own) > SAME, True)] if own.size else own
        between = first + np.arange(own.size)
        phi = np.concatenate([phi, own])
        h = np.concatenate([h, 0.5 * (np.interp(own, x[0], y[0]) + np.interp(own, x[1], y[1]))])
        first += own.size
        below.append(between)
        above.append(between)
        if block is None:
            break
        cells = _Cells(block.start, rows[0][block], rows[1][block], first)
        column, row = cells.places
        phi, h = np.concatenate([phi, even[column]]), np.concatenate([h, size[1] * row])
        first += column.size
        below.append(cells.under)
        above.append(cells.over)
        inner.append(cells.triangles)
        begins = float(even[block.stop])
    low, high = (np.concatenate([*line, lower[-1:]]) for line in (below, above))
    return phi, h, [(lower, low), (high, upper)], np.concatenate(inner)


def _rows(even: Array, x: Array, y: Array, size: float) -> Indices:
    """Numbers of the rows (n - 1,) that are by a part of one above a line over whole columns between angles (n,)."""
    values = np.interp(even, x, y)
    most = np.maximum(values[:-1], values[1:])
    own = np.searchsorted(even, x, side="right") - 1
    inside = (own >= 0) & (own < most.size)
    np.maximum.at(most, own[inside], y[inside])
    return np.asarray(np.ceil(most / size + CLEAR).astype(np.intp))


def _blocks(low: Indices, high: Indices) -> list[slice]:
    """Columns, from rows `low` to rows `high` (n,), that have cells and follow one another side by side."""
    found: list[slice] = []
    start, before = -1, -1
    for k, (a, b) in enumerate(zip(low.tolist(), high.tolist(), strict=True)):
        if start >= 0 and not min(b, int(high[before])) > max(a, int(low[before])):
            found.append(slice(start, k))
            start = -1
        elif start < 0 and b > a and not (found and found[-1].stop == k):  # so that two blocks have no side in common
            start = k
        before = k
    return [*found, slice(start, len(low))] if start >= 0 else found


class _Cells:
    """A block of cells: columns from the one numbered `start` on, each from a row `low` to a row `high` (n,).

    Its places are numbered from `first` on, up each side of a column, one side after the other.
    """

    def __init__(self, start: int, low: Indices, high: Indices, first: int) -> None:
        self.low, self.high = low.tolist(), high.tolist()
        self.start, self.first = start, first
        self.bottom = np.minimum(np.append(low, low[-1]), np.append(low[0], low))
        self.size = np.maximum(np.append(high, high[-1]), np.append(high[0], high)) - self.bottom + 1
        self.begin = first + np.cumsum(self.size) - self.size

    @property
    def places(self) -> tuple[Indices, Indices]:
        """Numbers of the side of a column and of the row, (m,) each."""
        own, more = runs_of(self.size)
        return self.start + own, self.bottom[own] + more

    def number(self, side: int, row: int) -> int:
        """Number of a place."""
        return int(self.begin[side] + row - self.bottom[side])

    @property
    def under(self) -> Indices:
        """The lower edge of the block, places (m,) from its lower left corner to its lower right one."""
        return np.array(self._edge(self.low), dtype=np.intp)

    @property
    def over(self) -> Indices:
        """All its other edges, places (m,) between the same corners."""
        n = len(self.low)
        up = [self.number(0, row) for row in range(self.low[0], self.high[0])]
        down = [self.number(n, row) for row in range(self.high[-1] - 1, self.low[-1] - 1, -1)]
        return np.array([*up, *self._edge(self.high), *down], dtype=np.intp)

    def _edge(self, rows: list[int]) -> list[int]:
        found = [self.number(0, rows[0])]
        for k, row in enumerate(rows):
            before = rows[k - 1] if k else row
            step = 1 if row > before else -1
            found += [self.number(k, each) for each in range(before + step, row + step, step) if row != before]
            found.append(self.number(k + 1, row))
        return found

    @property
    def triangles(self) -> Indices:
        """Both halves of each cell, (t, 3), counter-clockwise."""
        low, high = np.array(self.low), np.array(self.high)
        own, more = runs_of(high - low)
        row = low[own] + more
        a, b = (self.begin[side] + row - self.bottom[side] for side in (own, own + 1))
        return np.concatenate([np.column_stack([a, b, b + 1]), np.column_stack([a, b + 1, a + 1])])


def _divided(triangles: Indices, middle: Indices, x: Array, y: Array) -> Indices:
    """Triangles with the middles (t, 3) of some of their edges, -1 for none; edge k is that from corner k on."""
    count = np.count_nonzero(middle >= 0, axis=1)
    found = [triangles[count == 0]]
    for number in (1, 2, 3):
        own = np.flatnonzero(count == number)
        if not own.size:
            continue
        corner, mid = triangles[own], middle[own]
        # turned so that the first edge is halved; of two, that the third is not
        first = np.argmax(mid >= 0, axis=1) if number != 2 else (np.argmax(mid < 0, axis=1) + 1) % 3
        turn = (first[:, None] + np.arange(3)) % 3
        corner, mid = np.take_along_axis(corner, turn, axis=1), np.take_along_axis(mid, turn, axis=1)
        (a, b, c), (p, q, r) = corner.T, mid.T
        if number == 1:
            found += [np.column_stack([a, p, c]), np.column_stack([p, b, c])]
        elif number == 3:
            found += [np.column_stack(each) for each in ((a, p, r), (p, b, q), (r, q, c), (p, q, r))]
        else:
            found.append(np.column_stack([p, b, q]))
            # of the rest the shorter way across
            one = np.hypot(x[a] - x[q], y[a] - y[q]) <= np.hypot(x[p] - x[c], y[p] - y[c])
            found += [
                np.column_stack([a, p, np.where(one, q, c)]),
                np.column_stack([np.where(one, a, p), q, c]),
            ]
    return np.concatenate(found)
