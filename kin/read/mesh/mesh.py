"""Triangle meshes as they come out of files: numbers of text forms, corners welded, edges matched, faults counted."""

from __future__ import annotations

from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np

from kin.numeric.arrays import paired
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

Real = TypeVar("Real", bound=np.floating)

# Odd multipliers that spread bits over a word of 64 (from the golden ratio, and from SplitMix64), and a shift to match.
SPREAD, SPREAD_AGAIN = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xBF58476D1CE4E5B9)
FOLD = np.uint64(31)


class WordError(CamgeoError, ValueError):
    """A word that is no number, by its place among the words, from 0."""

    def __init__(self, place: int) -> None:
        super().__init__(f"word {place} is no number")
        self.place = place


class EdgeFaults(NamedTuple):
    """Counts of edges with one triangle only, with more than two, and with two that run along it the same way."""

    open: int
    crowded: int
    misdirected: int


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles by corner numbers (t, 3), counter-clockwise seen from outside, and the corners' places (v, 3), mm."""

    points: Array
    corners: Indices

    def code(self, a: Indices, b: Indices) -> NDArray[np.int64]:
        """One number (k,) for each ordered pair of corners a (k,), b (k,), the same for equal pairs."""
        return paired(a, b, len(self.points))

    @cached_property
    def edges(self) -> tuple[Indices, Indices]:
        """Start and end corners of the directed edges, three to a triangle, (3t,) each."""
        a, b, c = self.corners.T
        return np.concatenate([a, b, c]), np.concatenate([b, c, a])

    @cached_property
    def edge_faults(self) -> EdgeFaults:
        """Counts of edges that do not belong to exactly two triangles in opposite directions."""
        start, end = self.edges
        way = start < end
        codes = 2 * np.where(way, self.code(start, end), self.code(end, start)) + way  # the edge, and the way along it
        codes.sort()
        first, second = codes[0 : 2 * (len(codes) // 2) : 2], codes[1::2]
        all_paired = len(codes) % 2 == 0 and bool((first + 1 == second).all() and (first % 2 == 0).all())
        if all_paired and bool((first[1:] != first[:-1]).all()):
            return EdgeFaults(0, 0, 0)
        codes = codes[codes // 2 % (len(self.points) + 1) != 0]  # a corner joined to itself is no edge
        _, place, count = np.unique(codes // 2, return_index=True, return_counts=True)
        upward = np.add.reduceat(codes % 2, place)
        single, many, same_way = count == 1, count > 2, (count == 2) & (upward != 1)
        return EdgeFaults(*(int(np.count_nonzero(fault)) for fault in (single, many, same_way)))

    @cached_property
    def bodies(self) -> Indices:
        """Number of the body that each triangle belongs to (t,), from 0: triangles that share corners are one body."""
        return _joined(self.corners, len(self.points))

    @cached_property
    def shells(self) -> Indices:
        """Number of the shell that each triangle belongs to (t,), from 0: triangles that share an edge are one shell.

        Bodies that touch at a corner alone are several shells.
        """
        start, end = self.edges
        codes, numbers = np.unique(self.code(np.minimum(start, end), np.maximum(start, end)), return_inverse=True)
        return _joined(numbers.reshape(3, -1).T, len(codes))

    @cached_property
    def area_vectors(self) -> tuple[Array, Array, Array]:
        """Components of twice the area of each triangle times its normal, mm^2, 3 x (t,)."""
        (ax, bx, cx), (ay, by, cy), (az, bz, cz) = (column[self.corners].T for column in self.points.T)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx

    @cached_property
    def degenerate(self) -> int:
        """Number of triangles without area."""
        x, y, z = self.area_vectors
        return int(np.count_nonzero((x == 0.0) & (y == 0.0) & (z == 0.0)))

    @cached_property
    def volume(self) -> float:
        """Signed volume, mm^3, by the divergence theorem about the box's middle; positive if the mesh faces outward."""
        first = self.corners[:, 0]
        columns = [column - (column.min() + column.max()) / 2.0 for column in self.points.T]
        return float(sum(c[first] @ area for c, area in zip(columns, self.area_vectors, strict=True))) / 6.0

    @property
    def faults(self) -> tuple[str, ...]:
        """Faults in words, with their numbers: a closed, oriented mesh that faces outward has none."""
        return fault_words(self.edge_faults, self.degenerate, self.duplicate, self.volume)

    @cached_property
    def duplicate(self) -> int:
        """Number of triangles with the same corners, in any order, as a triangle before."""
        mixed = self.corners.astype(np.uint64) * SPREAD
        mixed = (mixed ^ (mixed >> FOLD)) * SPREAD_AGAIN
        sums = np.sort(mixed[:, 0] + mixed[:, 1] + mixed[:, 2])  # the same in whatever order
        if bool((sums[1:] != sums[:-1]).all()):
            return 0
        rising = np.sort(self.corners, axis=1)
        rising = rising[np.lexsort(rising.T)]
        return int(np.count_nonzero((rising[1:] == rising[:-1]).all(axis=1)))


def fault_words(edges: EdgeFaults, degenerate: int, duplicate: int, volume: float) -> tuple[str, ...]:
    """Faults of a mesh in words, by their numbers and its volume, mm^3; none for a closed mesh that faces outward."""
    counts = {
        "edges with one triangle": edges.open,
        "edges with more than two triangles": edges.crowded,
        "edges between triangles that face opposite sides": edges.misdirected,
        "triangles without area": degenerate,
        "triangles drawn twice": duplicate,
    }
    faults = [f"{number} {kind}" for kind, number in counts.items() if number]
    if not volume > 0.0:
        faults.append(f"the volume is {volume:.6g} mm^3: the triangles face inward")
    return tuple(faults)


def _joined(shared: Indices, count: int) -> Indices:
    """Numbers (t,), from 0, of groups of triangles that share something, each by its three of `count` things (t, 3)."""
    least = np.arange(count)  # the least thing that each is known to hang together with
    while True:
        roots = least[shared]
        low = roots.min(axis=1)
        if bool((roots == low[:, None]).all()):
            break
        np.minimum.at(least, roots.ravel(), np.repeat(low, 3))
        while not np.array_equal(further := least[least], least):
            least = further
    # the least thing of a group is that of all its triangles by now
    numbers: Indices = np.unique(low, return_inverse=True)[1]
    return numbers


def doubles(words: NDArray[np.bytes_]) -> Array:
    """Numbers (n,) of the words (n,) of a file in text form; raises WordError with the first word that is no number."""
    if b"_" not in words.tobytes():  # Python reads 1_0 as 10
        with suppress(ValueError):
            return words.astype(np.float64)
    raise WordError(next(place for place, word in enumerate(words.tolist()) if not _is_number(word)))


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return b"_" not in word


def welded(corners: NDArray[Real]) -> Mesh:
    """Return the mesh of triangles (t, 3, 3), mm: corners are one where their places are the same, bit for bit."""
    points, numbers = weld(corners.reshape(-1, 3))
    return Mesh(points.astype(np.float64), numbers.reshape(-1, 3))


def plan_welded(corners: NDArray[Real], bottom: float, top: float) -> Mesh:
    """Return the mesh of triangles (t, 3, 3), mm, whose corners all lie at the height `bottom` or `top`.

    Corners are one where they are the same bit for bit as seen from above, at the same height; corner 2k lies at the
    bottom and corner 2k + 1 at the top of the same place.
    """
    plan, numbers = weld(corners[:, :, :2].reshape(-1, 2))
    points = np.empty((2 * len(plan), 3))
    points[:, :2] = np.repeat(plan, 2, axis=0)
    points[::2, 2], points[1::2, 2] = bottom, top
    return Mesh(points, 2 * numbers.reshape(-1, 3) + (corners[:, :, 2] == top))


def weld(points: NDArray[Real]) -> tuple[NDArray[Real], Indices]:
    """Distinct points (k, m) among points (n, m), bit for bit, and for each point its number among them (n,)."""
    columns = [column + points.dtype.type(0.0) for column in points.T]  # -0.0 becomes 0.0
    if points.dtype.itemsize == 4 and len(columns) == 2:
        x, y = (c.view(np.uint32).astype(np.uint64) for c in columns)
        key = (x << np.uint64(32)) | y
        order = np.argsort(key)
        key = key[order]
        differs = key[1:] != key[:-1]
    else:
        order = hashed_order(columns)
        differs = np.zeros(len(points) - 1, dtype=bool)
        for column in columns:
            rising = column[order]
            differs |= rising[1:] != rising[:-1]
    new = np.concatenate([[True], differs])
    numbers = np.empty(len(points), dtype=np.intp)
    numbers[order] = np.cumsum(new) - 1
    first = order[new]
    return np.stack([column[first] for column in columns], axis=1), numbers


def hashed_order(columns: list[NDArray[Real]]) -> Indices:
    """Find an order (n,) in which equal points stand together; `columns` are their coordinates (n,) along each axis."""
    mixed = np.zeros(len(columns[0]), dtype=np.uint64)
    for column in columns:
        bits = column.view(np.uint32 if column.dtype.itemsize == 4 else np.uint64).astype(np.uint64)
        mixed = ((mixed ^ (mixed >> FOLD)) * SPREAD) ^ (bits * SPREAD_AGAIN)
    mixed = (mixed ^ (mixed >> FOLD)) * SPREAD
    order = np.argsort(mixed)
    rising = mixed[order]
    same_hash = rising[1:] == rising[:-1]
    for column in columns:
        at = column[order]
        if bool((same_hash & (at[1:] != at[:-1])).any()):  # two places of one hash, once in millions of files
            return np.lexsort(columns)
    return order
