"""Triangles of blank and floor: a band in one layer between two lines, along both of which the polar angle rises.

The points of both lines are passed in the order of the polar angle. Behind them lie triangles, before them a front:
points from the last one of the lower line to the last one of the upper one. A new point becomes an end of the front,
and every corner beside it that is a triangle is cut off at once. What then spans too much of the layer is divided:
edges that no line has are halved, until each is short enough.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.files.errors import RegionError
from kin.numeric.arrays import paired

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array, Indices

CROSSED = "two lines in a layer of the cam cross"
SHARP = 1e-2  # sine of a corner of one line below which it is cut off at the end alone
FLAT = 1e-9  # sine of a corner that is none
ROUNDS = 60
APART = 0.7  # of what a triangle may span: lines between two lines, and their points
THIN = 0.25  # of the height that a triangle may span: nearer lines have common angles
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

    def cut(least: float, *, start: bool) -> None:
        while len(front) > 2:
            a, b, c = (front[1], front[0], front[2]) if start else (front[-3], front[-1], front[-2])
            alike = (a in below) == (b in below) == (c in below)
            if not sharpest(a, b, c) > (least if alike else FLAT):
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
    phi, h, lines = _between(phi, h, lower, upper, wide)
    found = [band(phi * scale[0], h * scale[1], low, high) for low, high in pairwise(lines)]
    triangles = np.concatenate(found)
    if triangles.shape[0] != sum(low.size + high.size - 4 for low, high in pairwise(lines)):
        raise RegionError(CROSSED)
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


def _between(
    phi: Array, h: Array, lower: Indices, upper: Indices, wide: tuple[float, float]
) -> tuple[Array, Array, list[Indices]]:
    """Polar angles and heights with those of lines between two lines, and the lines, rising.

    Neighbours are nowhere farther apart than a share of the height `wide`. Where two lines come near to one another, a
    line between them has a point at each of theirs, so that it crosses none.
    """
    x, y = [phi[each] for each in (lower, upper)], [h[each] for each in (lower, upper)]
    at = np.unique(np.concatenate(x))
    gap = np.interp(at, x[1], y[1]) - np.interp(at, x[0], y[0])
    if not float(gap.max()) > APART * wide[1]:
        return phi, h, [lower, upper]
    count = max(2, math.ceil((at[-1] - at[0]) / (APART * wide[0])))
    even = np.linspace(at[0], at[-1], count + 1)[1:-1]
    near = at[1:-1][gap[1:-1] < THIN * wide[1]]
    own = np.unique(np.concatenate([even, near]))
    own = own[np.append(np.diff(own) > SAME, True)]
    up = 0.5 * (np.interp(own, x[0], y[0]) + np.interp(own, x[1], y[1]))
    middle = np.concatenate([lower[:1], phi.size + np.arange(own.size), lower[-1:]])
    phi, h = np.concatenate([phi, own]), np.concatenate([h, up])
    phi, h, below = _between(phi, h, lower, middle, wide)
    phi, h, above = _between(phi, h, middle, upper, wide)
    return phi, h, [*below, *above[1:]]


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
