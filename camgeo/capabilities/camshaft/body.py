"""The solid of a camshaft: round stretches and lobes, each turned to its angle; a mesh, or exact surfaces."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from camgeo.curve.ring import steps_along
from camgeo.files.errors import RegionError
from camgeo.fit.bound import Bound
from camgeo.fit.pieces import ArcSpline, Polygon

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe
    from camgeo.files.mesh import Mesh
    from camgeo.files.precision import Precision
    from camgeo.fit.cache import Fits
    from kin.numeric.arrays import Array

LOOKS = 4  # places on each arc at which it is looked at
SAME = 1e-9  # mm, and of bulges: outlines as near as this are one
BEYOND = 1.0  # mm by which what cuts reaches out of what is cut
_Outline = TypeVar("_Outline", Polygon, ArcSpline)


def _placed(outline: _Outline, angle: float, rotation: str) -> _Outline:
    """Turn an outline counter-clockwise, and mirror the drawing where the shaft turns that way."""
    turned = outline.turned(angle)
    return turned.mirrored() if rotation == "ccw" else turned


def camshaft_mesh(
    recipe: CamshaftRecipe,
    lobes: Sequence[PlacedLobe],
    fits: Callable[[PlacedLobe], Fits],
    *,
    tolerance: float,
    precision: Precision,
) -> tuple[Mesh, Bound, int]:
    """Closed, oriented mesh of the whole shaft, the bound of its contours (mm), and how many edges the lobes have.

    `fits` gives the fits of a lobe's contour; `tolerance`, mm, covers fit and rounding to the file's `precision`.
    Raises ToleranceError where the tolerance cannot be held in the precision, RegionError where the mesh does not
    close.
    """
    from camgeo.files.prism import bore_polygon, rounded_contour
    from camgeo.files.solid import manifold, mesh_of_body, prism

    size = max(
        [lobe.contour.size for lobe in lobes if lobe.contour is not None] + [bar.diameter for bar in recipe.bars]
    )
    fine = precision.fit_tolerance(tolerance, 1.01 * size)

    def cylinder(diameter: float, low: float, high: float) -> Any:  # noqa: ANN401 - manifold3d has no types
        polygon, _ = bore_polygon(diameter, fine)
        return manifold(*prism(precision.rounded(polygon)[0], low, high, precision))

    shaft, *journals = recipe.bars
    placed = [(part.low, part.high) for part in recipe.bars] + [(part.low, part.high) for part in recipe.lobes]
    # z is written as numbers of the file, so each height may be rounded by no more than the tolerance
    for height in {z for ends in placed for z in ends}:
        precision.within("a height", abs(precision.number(height) - height), tolerance)
    body = cylinder(shaft.diameter, shaft.low, shaft.high)
    for bar in journals:
        body += cylinder(bar.diameter, bar.low, bar.high)
    bound, edges = Bound(0.0, 0.0), 0
    for lobe in lobes:
        polygon = _placed(fits(lobe).within("polyline", fine), lobe.at, recipe.rotation)
        loop, moved = rounded_contour(polygon, precision)
        bound, edges = bound.wider(polygon.bound.widened(moved)), edges + len(loop)
        precision.within("the contour", bound.worst, tolerance)
        body += manifold(*prism(loop, lobe.lobe.low, lobe.lobe.high, precision))
    if recipe.bore is not None:
        body -= cylinder(recipe.bore, shaft.low - BEYOND, shaft.high + BEYOND)
    mesh, merged = mesh_of_body(body, precision)
    bound = bound.widened(merged)
    precision.within("the contour", bound.worst, tolerance)
    return mesh, bound, edges


def camshaft_outlines(
    recipe: CamshaftRecipe, lobes: Sequence[PlacedLobe], fits: Callable[[PlacedLobe], Fits], tolerance: float
) -> tuple[list[tuple[ArcSpline, float, float]], Bound, int]:
    """Stretches of the shaft from below, each a chain of arcs from z to z, mm; bound and arcs of the lobes' contours.

    `fits` gives the fits of a lobe's contour, each within `tolerance`, mm. Raises ToleranceError where a fit cannot
    hold it, RegionError where outlines that meet at a height cross.
    """
    bound, count = Bound(0.0, 0.0), 0
    shaft, *journals = recipe.bars
    parts: list[tuple[ArcSpline, float, float]] = []
    for lobe in lobes:
        outline = _placed(fits(lobe).within("arcs", tolerance), lobe.at, recipe.rotation)
        bound, count = bound.wider(outline.bound), count + outline.count
        parts.append((outline, lobe.lobe.low, lobe.lobe.high))
    parts += [(circle(bar.diameter), bar.low, bar.high) for bar in journals]
    # between neighbouring heights the shaft has one outline: of the lobe or journal there, else its own circle
    levels = sorted({shaft.low, shaft.high, *(z for _, low, high in parts for z in (low, high))})
    stretches: list[tuple[ArcSpline, float, float]] = []
    for low, high in pairwise(levels):
        own = next((outline for outline, a, b in parts if a <= low and high <= b), circle(shaft.diameter))
        if stretches and _same(stretches[-1][0], own):  # there is no face between the two
            stretches[-1] = (*stretches[-1][:2], high)
        else:
            stretches.append((own, low, high))
    # two outlines do not cross if one lies within the other's least radius
    for (below, _, z), (above, _, _) in pairwise(stretches):
        least, most = zip(*(_reach(outline) for outline in (below, above)), strict=True)
        if least[0] < most[1] - SAME and least[1] < most[0] - SAME:
            message = f"the outlines that meet at z = {z:.9g} mm cross one another, which a STEP of it does not hold"
            raise RegionError(f"{message}; leave a gap between them, or give stl or 3mf")
    return stretches, bound, count


def _same(first: ArcSpline, other: ArcSpline) -> bool:
    """Whether two outlines are equal, but for the rounding of the angles by which they are turned."""
    return first.points.shape == other.points.shape and bool(
        np.abs(first.points - other.points).max() <= SAME and np.abs(first.bulges - other.bulges).max() <= SAME
    )


def _reach(outline: ArcSpline) -> tuple[float, float]:
    """Least and greatest distance from the shaft's axis, mm, of an outline's ends and places along its arcs."""
    distance = np.hypot(*_along(outline).T)
    return float(distance.min()), float(distance.max())


def _along(outline: ArcSpline) -> Array:
    """Points on every piece of an outline, mm (n, 2)."""
    starts, ends = outline.points, np.roll(outline.points, -1, axis=0)
    pieces = zip(starts, ends, outline.bulges.tolist(), strict=True)
    return np.concatenate([steps_along(start, end, bulge, LOOKS) for start, end, bulge in pieces])


def circle(diameter: float) -> ArcSpline:
    """Circle about the shaft's axis, of a diameter in mm, as two arcs."""
    radius = 0.5 * diameter
    return ArcSpline(np.array([[radius, 0.0], [-radius, 0.0]]), np.ones(2), Bound(0.0, 0.0))
