"""Printable bodies as meshes, and their places: laid out flat for printing, standing in the mechanism, moving in it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from camgeo.files.errors import RegionError
from camgeo.files.prism import rounded_contour, rounded_loop
from camgeo.files.solid import BEYOND, manifold, meshed, prism
from camgeo.fit.pieces import Polygon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.mechanism.body import PrintBody
    from camgeo.files.mesh import Mesh
    from camgeo.files.precision import Precision
    from camgeo.fit.pieces import ArcSpline
    from kin.numeric.arrays import Array

    Outline: TypeAlias = ArcSpline | Polygon

GAP = 5.0  # mm between bodies that are laid out
_STEP = 100.0  # places on the plate are whole steps of 1/100 mm
_LARGER = 1.001  # a face is larger than another from this share on
_SHAPE = 1.4  # the plate is filled about this much wider than deep


def body_mesh(body: PrintBody, *, tolerance: float, precision: Precision) -> tuple[Mesh, float]:
    """Closed mesh of a body's plates, joined, in its own axes, and how far its walls are off, mm.

    Raises ToleranceError where the tolerance cannot be held in the precision; RegionError, with the body's name, where
    an outline is not simple, the plates do not hang together, or what is joined does not close once it is rounded.
    """
    try:
        return _joined(body, tolerance, precision)
    except RegionError as error:
        raise RegionError(f"{body.name}: {error}") from error


def _joined(body: PrintBody, tolerance: float, precision: Precision) -> tuple[Mesh, float]:
    joined: Any = None
    worst = 0.0
    for plate in body.plates:
        for height in (plate.low, plate.high):
            precision.within(f"{body.name}: a height", abs(precision.number(height) - height), tolerance)
    for storeys in _columns([(plate.outline, plate.low, plate.high) for plate in body.plates]):
        plates = [body.plates[k] for k in storeys]
        low, high = plates[0].low, plates[-1].high
        outer, off = _loop(plates[0].outline, tolerance, precision)
        slab = manifold(*prism(outer, low, high, precision))
        worst = max(worst, off)
        holes = [(hole, plate.low, plate.high) for plate in plates for hole in plate.holes]
        for through in _columns(holes):
            (hole, foot, _), (_, _, top) = holes[through[0]], holes[through[-1]]
            inner, off = _loop(hole, tolerance, precision)
            foot, top = foot - BEYOND if foot == low else foot, top + BEYOND if top == high else top
            slab -= manifold(*prism(inner, foot, top, precision))
            worst = max(worst, off)
        joined = slab if joined is None else joined + slab
    pieces = len(joined.decompose())
    if pieces != 1:
        raise RegionError(f"its plates make {pieces} separate bodies, where one is expected")
    mesh, merged = meshed(joined, precision)
    precision.within(f"{body.name}: an outline", worst + merged, tolerance)
    return mesh, worst + merged


def _columns(walls: Sequence[tuple[Outline, float, float]]) -> list[list[int]]:
    """Numbers of outlines from one height to another, upward, those of one shape that stand on each other together.

    Where walls cross, each storey's corners would be rounded in their own way: joined one above the other they leave
    slivers.
    """
    found: list[list[int]] = []
    for k in sorted(range(len(walls)), key=lambda k: walls[k][1]):
        outline, low, _ = walls[k]
        below = (column for column in found if walls[column[-1]][2] == low and _same(walls[column[-1]][0], outline))
        column = next(below, None)
        if column is None:
            found.append([k])
        else:
            column.append(k)
    return found


def _same(outline: Outline, other: Outline) -> bool:
    if isinstance(outline, Polygon) or isinstance(other, Polygon):
        return outline is other
    return np.array_equal(outline.points, other.points) and np.array_equal(outline.bulges, other.bulges)


def _loop(outline: Outline, tolerance: float, precision: Precision) -> tuple[Array, float]:
    """Rounded vertices (n, 2) of an outline, and how far it is off in all."""
    if isinstance(outline, Polygon):
        loop, moved, _ = rounded_contour(outline, precision)
        off = outline.bound.widened(moved).worst
        precision.within("an outline", off, tolerance)
        return loop, off
    loop, off, _ = rounded_loop(outline, tolerance, precision)
    return loop, off


def standing(pose: Array) -> Array:
    """Place (4, 3) of a body at x, y and angle: the images of the axes and of the origin."""
    x, y, angle = pose.tolist()
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0], [x, y, 0.0]])


def laid_out(meshes: Sequence[Mesh], gap: float = GAP) -> list[Array]:
    """Places (4, 3) that lay bodies on the plate z = 0 side by side, `gap` mm apart, all of it at positive x and y.

    Each lies on the larger of its lowest and highest faces, turned over if that is the highest. They are set in rows,
    the deepest first.
    """
    ways = [flat(mesh) for mesh in meshes]
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


def flat(mesh: Mesh) -> tuple[Array, Array]:
    """Turn (3, 3) and lift (3,) that lay a body on z = 0, on the larger of its lowest and highest faces."""
    z, upward = mesh.points[:, 2], mesh.area_vectors[:, 2]
    top, bottom = ((z == level)[mesh.triangles].all(axis=1) for level in (z.max(), z.min()))
    if float(upward[top].sum()) > -_LARGER * float(upward[bottom].sum()):
        return np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, float(z.max())])
    return np.eye(3), np.array([0.0, 0.0, -float(z.min())])


def mirrored(body: PrintBody) -> PrintBody:
    """Mirror a body and its motion about the x axis."""
    plates = tuple(
        replace(plate, outline=plate.outline.mirrored(), holes=tuple(hole.mirrored() for hole in plate.holes))
        for plate in body.plates
    )
    return replace(body, plates=plates, pose=body.pose * [1.0, -1.0, -1.0])
