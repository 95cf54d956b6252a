"""Printable bodies as meshes, and their places: laid out flat for printing, standing in the mechanism, moving in it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from camgeo.files.errors import RegionError
from camgeo.files.prism import rounded_contour, rounded_loop
from camgeo.files.solid import BEYOND, manifold, mesh_of_body, prism
from camgeo.fit.pieces import Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.mechanism.assembly import PrintBody
    from camgeo.files.mesh import Mesh
    from camgeo.files.precision import Precision
    from camgeo.fit.pieces import ArcSpline
    from kin.numeric.arrays import Array

    Outline: TypeAlias = ArcSpline | Polygon

GAP = 5.0  # mm between bodies laid out for printing
_STEP = 100.0  # steps a mm, in whole numbers of which bodies are placed on the plate
_LARGER = 1.001  # times the area of the lowest face: below this ratio a body is not turned over
_SHAPE = 1.4  # about the width of the filled plate over its depth


def body_mesh(body: PrintBody, *, tolerance: float, precision: Precision) -> tuple[Mesh, float]:
    """Closed mesh of a body's joined plates, in the body's axes, and the greatest error of its walls, mm.

    Errors are at most `tolerance`, mm. Raises ToleranceError where that cannot be held with numbers of this precision;
    RegionError, with the body's name, where an outline is not simple, the plates are not connected, or the rounded mesh
    does not close.
    """
    try:
        return _join(body, tolerance, precision)
    except RegionError as error:
        raise RegionError(f"{body.name}: {error}") from error


def _join(body: PrintBody, tolerance: float, precision: Precision) -> tuple[Mesh, float]:
    """Closed mesh of a body's joined plates, and the greatest error of its walls, mm.

    Raises ToleranceError where the tolerance cannot be held in the precision, RegionError where an outline is not
    simple, the plates are not connected, or the rounded mesh does not close.
    """
    joined: Any = None
    worst = 0.0
    # heights are rounded to the precision too
    for plate in body.plates:
        for height in (plate.low, plate.high):
            precision.within(f"{body.name}: a height", abs(precision.number(height) - height), tolerance)
    # each stack of equal outlines is one prism less its holes, cut a little beyond the faces that they reach
    for stack in _stacks([(plate.outline, plate.low, plate.high) for plate in body.plates]):
        plates = [body.plates[k] for k in stack]
        low, high = plates[0].low, plates[-1].high
        outer, off = _loop(plates[0].outline, tolerance, precision)
        slab = manifold(*prism(outer, low, high, precision))
        worst = max(worst, off)
        holes = [(hole, plate.low, plate.high) for plate in plates for hole in plate.holes]
        for through in _stacks(holes):
            (hole, foot, _), (_, _, top) = holes[through[0]], holes[through[-1]]
            inner, off = _loop(hole, tolerance, precision)
            foot, top = foot - BEYOND if foot == low else foot, top + BEYOND if top == high else top
            slab -= manifold(*prism(inner, foot, top, precision))
            worst = max(worst, off)
        joined = slab if joined is None else joined + slab
    pieces = len(joined.decompose())
    if pieces != 1:
        raise RegionError(f"its plates make {pieces} separate bodies, where one is expected")
    mesh, merged = mesh_of_body(joined, precision)
    precision.within(f"{body.name}: an outline", worst + merged, tolerance)
    return mesh, worst + merged


def _stacks(walls: Sequence[tuple[Outline, float, float]]) -> list[list[int]]:
    """Indices of walls (outline, lower z, upper z) in lists, upward; each has equal outlines directly above each other.

    Each list is made as one prism: separate levels would round corners separately and leave slivers.
    """
    stacks: list[list[int]] = []
    for k in sorted(range(len(walls)), key=lambda k: walls[k][1]):
        outline, low, _ = walls[k]
        below = (stack for stack in stacks if walls[stack[-1]][2] == low and _equal(walls[stack[-1]][0], outline))
        stack = next(below, None)
        if stack is None:
            stacks.append([k])
        else:
            stack.append(k)
    return stacks


def _equal(outline: Outline, other: Outline) -> bool:
    """Whether two outlines have the same vertices and bulges; a polygon equals itself alone."""
    if isinstance(outline, Polygon) or isinstance(other, Polygon):
        return outline is other
    return np.array_equal(outline.points, other.points) and np.array_equal(outline.bulges, other.bulges)


def _loop(outline: Outline, tolerance: float, precision: Precision) -> tuple[Array, float]:
    """Rounded vertices (n, 2) of an outline, and its greatest error with the rounding, mm."""
    if isinstance(outline, Polygon):
        loop, moved = rounded_contour(outline, precision)
        off = outline.bound.widened(moved).worst
        precision.within("an outline", off, tolerance)
        return loop, off
    loop, off, _ = rounded_loop(outline, tolerance, precision)
    return loop, off


def pose_matrix(pose: Array) -> Array:
    """Matrix (4, 3) of a body at a `pose` (3,), x, y and angle, mm and rad: images of the axes, then of the origin."""
    x, y, angle = pose.tolist()
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0], [x, y, 0.0]])


def layout(meshes: Sequence[Mesh], gap: float = GAP) -> list[Array]:
    """Matrices (4, 3), one for each mesh in the order given, that lay bodies on the plate z = 0, at positive x and y.

    Bodies lie in rows along x, at least `gap` mm apart; those that are longest in y fill the first rows. Each body lies
    on the larger of its lowest and highest faces, and is turned over for the highest. A matrix has the images of the
    axes, then of the origin, mm.
    """
    ways = [print_pose(mesh) for mesh in meshes]
    # boxes of the bodies as they lie, filled row by row up to a width
    boxes = []
    for mesh, (turn, _) in zip(meshes, ways, strict=True):
        turned = mesh.points @ turn
        boxes.append((turned.min(axis=0), turned.max(axis=0)))
    sizes = np.array([high - low for low, high in boxes])[:, :2] + gap
    wide = max(float(sizes[:, 0].max()), math.sqrt(_SHAPE * float(np.sum(sizes[:, 0] * sizes[:, 1]))))
    corners = np.zeros((len(meshes), 2))
    x, y, depth = gap, gap, 0.0
    for k in sorted(range(len(meshes)), key=lambda k: (-sizes[k, 1], k)):
        if x > gap and x + sizes[k, 0] > wide + gap:
            x, y, depth = gap, y + depth, 0.0
        corners[k] = x, y
        x, depth = x + sizes[k, 0], max(depth, float(sizes[k, 1]))
    places = []
    for (turn, lift), (low, _), corner in zip(ways, boxes, corners, strict=True):
        across = np.ceil(_STEP * (corner - low[:2])) / _STEP
        places.append(np.vstack([turn, [*across, lift[2]]]))
    return places


def print_pose(mesh: Mesh) -> tuple[Array, Array]:
    """Rotation (3, 3) and shift (3,), mm, that lay a body on z = 0, on the larger of its lowest and highest faces."""
    z, upward = mesh.points[:, 2], mesh.area_vectors[:, 2]
    top, bottom = ((z == level)[mesh.triangles].all(axis=1) for level in (z.max(), z.min()))
    if float(upward[top].sum()) > -_LARGER * float(upward[bottom].sum()):
        return np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, float(z.max())])
    return np.eye(3), np.array([0.0, 0.0, -float(z.min())])


def mirror(body: PrintBody) -> PrintBody:
    """The body and its motion mirrored in the plane y = 0."""
    plates = tuple(
        replace(plate, outline=plate.outline.mirrored(), holes=tuple(hole.mirrored() for hole in plate.holes))
        for plate in body.plates
    )
    return replace(body, plates=plates, pose=body.pose * [1.0, -1.0, -1.0])
