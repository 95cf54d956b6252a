"""The mesh of one part of any shape: its triangles as a file holds them, welded and checked, without a section."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from kin.numeric.records import dataclass
from kin.read.bodies import MOST_BODIES, beside
from kin.read.errors import ReadError
from kin.read.mesh.mesh import Mesh, welded
from kin.read.mesh.prism import rounding

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from kin.numeric.arrays import Array, Indices
    from kin.read.mesh.prism import Corners

    Form = Literal["binary", "text", "3mf"]
    Box = tuple[Array, Array]

LARGEST = 1e7
"""Beyond this, mm, products of three coordinates have no digits left for a part."""


class Triangles(NamedTuple):
    """Corners of triangles (t, 3, 3) in a file's order and precision, its form, and the length of its unit, mm.

    Of a file that states a unit the corners are in mm; of one that states none they are in its unit, and `units_mm` is
    None.
    """

    corners: Corners
    form: Form
    units_mm: float | None = None


@dataclass(frozen=True, eq=False)
class CheckedMesh:
    """The mesh of one part, mm.

    mesh      corners are one where their places in the file are the same, bit for bit
    faults    in words: none where each edge has two triangles that run along it in opposite directions, each triangle
              has an area and is there once, and the volume is above 0
    rounding  mm by which a coordinate may be from the true one by the file's numbers; of a 3MF that states another unit
              than mm less, that of numbers with all digits that they have in mm
    form      "binary" or "text", or "3mf"
    units_mm  length of the file's unit, None where it states none
    """

    mesh: Mesh
    faults: tuple[str, ...]
    rounding: float
    form: Form
    units_mm: float | None


def checked(triangles: Triangles, path: Path, unit: float = 1.0) -> CheckedMesh:
    """Weld and check the triangles of one part, whose corners are in a `unit`, mm.

    A triangle has no area if that of its corners is 0, to the last bit. Whether the surface meets itself is not looked
    at. Raises ReadError for coordinates out of range, a flat part, and a mesh without a fault that is several bodies:
    apart, one within the other, or touching at a corner alone.
    """
    corners = triangles.corners
    ends(corners, path)
    mesh = welded(corners)
    if unit != 1.0:
        mesh = Mesh(unit * mesh.points, mesh.corners)  # welded before, so that the unit brings no corners together
    faults = mesh.faults
    if not faults and mesh.shells.any():
        raise several_bodies(boxes_of(mesh, mesh.shells), path)
    return CheckedMesh(mesh, faults, unit * rounding(corners), triangles.form, triangles.units_mm)


def ends(corners: Corners, path: Path) -> tuple[tuple[float, float], ...]:
    """Least and greatest coordinate of triangles (t, 3, 3) along each axis.

    Raises ReadError where a coordinate is not finite or beyond LARGEST in magnitude, and where a part is flat.
    """
    if not bool((np.abs(corners) <= LARGEST).all()):
        raise ReadError("range", "a coordinate is not finite or out of range", path)
    found = tuple((float(column.min()), float(column.max())) for column in np.moveaxis(corners, 2, 0))
    for axis, (least, greatest) in zip("xyz", found, strict=True):
        if least == greatest:
            raise ReadError("empty", f"the part is flat: all corners lie at {axis} = {least + 0.0:g}", path)
    return found


def boxes_of(mesh: Mesh, numbers: Indices) -> list[Box]:
    """Least and greatest coordinates (3,), mm, of each body; `numbers` (t,), from 0, are those of triangles' bodies."""
    order = np.argsort(numbers, kind="stable")
    heads = np.flatnonzero(np.diff(numbers[order], prepend=-1))
    corners = mesh.points[mesh.corners[order]]
    low, high = np.minimum.reduceat(corners.min(axis=1), heads), np.maximum.reduceat(corners.max(axis=1), heads)
    return list(zip(low, high, strict=True))


def several_bodies(boxes: Sequence[Box], path: Path) -> ReadError:
    """Make the error that names the largest of several bodies, by their boxes, mm."""
    largest = sorted(range(len(boxes)), key=lambda k: -float(np.prod(boxes[k][1] - boxes[k][0])))[:MOST_BODIES]
    return beside([(f"body {k + 1}", boxes[k]) for k in largest], len(boxes), path)
