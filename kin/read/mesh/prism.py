"""Whether walls of a mesh stand upright: to the bit, or to the rounding of the numbers that the file holds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.distinct import distinct
from kin.read.mesh.mesh import plan_welded, weld, welded

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices
    from kin.read.mesh.mesh import Mesh

    Corners = NDArray[np.float32] | NDArray[np.float64]

SINGLE, DOUBLE = 2.0**-24, 2.0**-53  # greatest relative error of a number rounded to either precision
FEW_DIGITS = 9  # tell any number of single precision; more are written of doubles
SPLITS = 16  # passes in which places are separated; two or three will do for a part


class Outline(NamedTuple):
    """Points (n, 2), mm, and directed edges by point numbers, start (k,) and end (k,), the solid on their left."""

    points: Array
    start: Indices
    end: Indices


class Upright(NamedTuple):
    """A welded mesh, whether it is a prism, and the bottom's outline of a prism with corners at two heights alone."""

    mesh: Mesh
    prism: bool
    outline: Outline | None


class Evened(NamedTuple):
    """Triangles (t, 3, 3) whose corners have been moved by no more than `by` mm, as seen from above, and in height."""

    corners: Array
    by: float


class Walls(NamedTuple):
    """Triangles that lean (k, 4), and those that rounding explains (k, 4).

    `leaning` has their least and greatest height and reach from the axis, mm, and mm that they go inward per mm of
    height; `slivers` the same three, and the mm by which they lean.
    """

    leaning: Array
    slivers: Array


def walls(mesh: Mesh, apart: float) -> Walls:
    """Part the triangles that are neither level nor upright into walls that lean, and slivers that rounding explains.

    Slivers are no wider than `apart`, mm, as seen from above. A place where two sections differ lies, as seen from
    above, within a triangle between them that is not upright. So where none leans the sections are the same but for
    slivers, whose area in all is no more than `apart` along the mean section; if it is more, all are taken to lean.
    """
    # twice the areas of triangles as seen from the side and from above; width is the area over the longest side
    x, y, upward = mesh.area_vectors
    across, plan_area = np.hypot(x, y), np.abs(upward)
    corners = mesh.points[mesh.corners]
    low, high = corners[:, :, 2].min(axis=1), corners[:, :, 2].max(axis=1)
    side = np.roll(corners, -1, axis=1)[:, :, :2] - corners[:, :, :2]
    width = plan_area / np.maximum(np.hypot(side[:, :, 0], side[:, :, 1]).max(axis=1), np.finfo(float).tiny)
    lean = (low < high) & (plan_area > 0.0)
    sliver = lean & (width <= apart)
    if float(plan_area[sliver].sum()) * float(np.ptp(mesh.points[:, 2])) > apart * float(across.sum()):
        sliver[:] = False
    reach = np.hypot(corners[:, :, 0], corners[:, :, 1]).max(axis=1)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        inward = upward / across
    return Walls(
        np.column_stack([low, high, reach, inward])[lean & ~sliver], np.column_stack([low, high, reach, width])[sliver]
    )


def upright(corners: Corners) -> Upright:
    """Weld triangles (t, 3, 3), mm, that are not all at one height, and find whether they are a prism, bit for bit."""
    z = corners[:, :, 2]
    z_min, z_max = float(z.min()), float(z.max())
    if bool(((z == z_min) | (z == z_max)).all()):
        mesh = plan_welded(corners, z_min, z_max)
        outline = _outline(mesh)
        return Upright(mesh, outline is not None, outline)
    mesh = welded(corners)
    return Upright(mesh, _walls_upright(mesh, z_min, z_max), None)


def _outline(mesh: Mesh) -> Outline | None:
    """Return the outline of the bottom if a mesh between two levels, by `plan_welded`, is a prism; None if it is not.

    In a prism there are triangles between the levels; each stands upright, with two corners as seen from above; and
    their edges at the bottom are the same as their edges at the top, the other way round.
    """
    high, plan = (mesh.corners & 1).astype(bool), mesh.corners >> 1
    above = np.count_nonzero(high, axis=1)
    wall = plan[(above == 1) | (above == 2)]
    if not len(wall):
        return None
    a, b, c = wall.T
    if not bool(((a == b) ^ (b == c) ^ (c == a)).all()):
        return None
    edges = []
    for many, lone in ((1, True), (2, False)):
        rows = np.flatnonzero(above == many)
        apex = (high[rows] == lone).argmax(axis=1)
        edges.append((plan[rows, (apex + 1) % 3], plan[rows, (apex + 2) % 3]))
    (start, end), (top_start, top_end) = edges
    if not np.array_equal(np.sort(mesh.code(start, end)), np.sort(mesh.code(top_end, top_start))):
        return None
    return Outline(mesh.points[::2, :2], start, end)


def _walls_upright(mesh: Mesh, z_min: float, z_max: float) -> bool:
    """Whether each triangle lies in the bottom, in the top, or upright: a closed mesh of these is a prism."""
    z = mesh.points[:, 2][mesh.corners]
    lid = (z == z_min).all(axis=1) | (z == z_max).all(axis=1)
    _, _, seen_from_above = mesh.area_vectors
    return bool((lid | (seen_from_above == 0.0)).all()) and sum(mesh.edge_faults) == 0


def evened(corners: Corners) -> Evened | None:
    """Bring corners of triangles (t, 3, 3), mm, together that only rounding holds apart; None where walls lean or step.

    Corners that belong above one another differ by twice the `rounding` of either at most, along x and along y; so do
    the heights of the corners of a face. Each place is moved to the middle of its corners. Walls lean where a place is
    wider than that; a level face between bottom and top is a step.
    """
    apart = 2.0 * rounding(corners)
    distinct_corners, numbers = weld(corners.reshape(-1, 3))
    points, numbers = distinct_corners.astype(np.float64), numbers.reshape(-1, 3)
    moved = points.copy()
    z = moved[:, 2]
    bottom, top = z <= z.min() + apart, z >= z.max() - apart
    level = np.ptp(z[numbers], axis=1) <= apart
    lids = bottom[numbers].all(axis=1) | top[numbers].all(axis=1)
    if bool((bottom & top).any()) or bool((level & ~lids).any()):
        return None
    z[bottom], z[top] = z.min(), z.max()
    place = _places(points[:, :2], apart)
    order = np.argsort(place, kind="stable")
    heads = np.flatnonzero(np.diff(place[order], prepend=-1))
    for axis in (0, 1):
        column = points[order, axis]
        low, high = np.minimum.reduceat(column, heads), np.maximum.reduceat(column, heads)
        if bool((high - low > apart).any()):
            return None
        moved[:, axis] = (0.5 * (low + high))[place]
    x, y, height = np.abs(moved - points).T
    return Evened(moved[numbers], float(max(np.hypot(x, y).max(), height.max())))


def _places(points: Array, apart: float) -> Indices:
    """Numbers (n,), from 0, of the places of points (n, 2): groups without a gap above `apart`, mm, along x or y."""
    place = np.zeros(len(points), dtype=np.intp)
    count = [0, 0]
    for turn in range(SPLITS):
        column = points[:, turn % 2]
        order = np.lexsort((column, place))
        new = (np.diff(column[order], prepend=-np.inf) > apart) | (np.diff(place[order], prepend=-1) != 0)
        place[order] = np.cumsum(new) - 1
        places = int(place[order[-1]]) + 1
        if places == count[0] == count[1]:
            break
        count = [count[1], places]
    return place


def rounding(corners: Corners) -> float:
    """How far a coordinate of triangles (t, 3, 3) may be from the true one by rounding, mm.

    A number is written to half a unit of its last place, u: of single precision in a binary file, else of its last
    decimal. A program that turns a part about the shaft reads x and y, off by u each, and works out x cos a - y sin a.
    That brings in (|cos a| + |sin a|) u <= 1.42 u; the rounding of the cosine and the sine, and of both products,
    each a share eps of numbers whose sizes sum up to no more than 1.42 times the greatest coordinate m; and u once
    more when the difference is rounded and written:

        (1 + sqrt 2) u + 2 sqrt 2 eps m.

    To write again or to shift takes less. Text of nine digits or fewer may come from a program that computes in single
    precision, and so may more digits if every number is one of single precision to within them.
    """
    largest = float(np.abs(corners).max())
    if corners.dtype.itemsize == 4:
        eps, half = SINGLE, SINGLE * largest
    else:
        values = distinct(np.abs(corners).ravel())
        digits = max(map(_digits, values.tolist()))
        half = 0.5 * 10.0 ** (math.floor(math.log10(largest)) + 1 - digits)
        single = digits <= FEW_DIGITS or bool((np.abs(values - values.astype(np.float32)) <= half).all())
        eps = SINGLE if single else DOUBLE
        half = max(half, eps * largest)
    return (1.0 + math.sqrt(2.0)) * half + 2.0 * math.sqrt(2.0) * eps * largest


def _digits(value: float) -> int:
    """Number of significant decimals in the shortest text that reads back as this double."""
    return len(repr(value).partition("e")[0].replace(".", "").strip("0"))
