"""A part's body in the words of the file writers: what is cut on a drawing, and what a solid is made of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.files.layer_outline import LayerOutline
from camgeo.fit.pieces import Polygon
from camgeo.part.features import with_records

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from camgeo.files.mesh import Mesh, MeshFacts
    from camgeo.files.precision import Precision
    from camgeo.files.solid import Solid
    from camgeo.fit.pieces import Outline
    from camgeo.part.body import Body
    from camgeo.synthesis.design import Design


def contours_of(design: Design, fitted: Iterable[Outline]) -> list[LayerOutline]:
    """The contours of a design's surfaces as they are fitted, each on its layer."""
    return [LayerOutline(made.surface.layer, outline) for made, outline in zip(design.surfaces, fitted, strict=True)]


def rim_of(body: Body) -> list[LayerOutline]:
    """The round outline about the contours of a ring; none of a disc."""
    return [LayerOutline(rim.layer, rim.outline, rim.circle) for rim in (body.rim,) if rim is not None]


def openings_of(body: Body) -> list[LayerOutline]:
    """Outlines that are cut or engraved besides the contours, each on its layer."""
    return [LayerOutline(opening.layer, opening.outline, opening.circle) for opening in body.openings]


def remarks(body: Body, mm: float) -> list[str]:
    """Comments for a drawing on features that it does not show, such as depths; lengths in units of `mm` mm."""
    features = with_records(body.features)
    lines = [f"camgeo {feature.remark(value, mm)}" for feature, value in features if feature.remark is not None]
    lines += [
        f"camgeo {opening.name}: {opening.depth / mm:.9g} deep"
        for opening in body.openings
        if opening.depth is not None
    ]
    return lines


def needs_booleans(body: Body) -> bool:
    """Whether the mesh of a body is joined and cut of several solids: it is no prism, nor one with a pocket alone."""
    return not (body.prism or (body.pocket is not None and _plain(body)))


def _plain(body: Body) -> bool:
    """Whether nothing stands on a disc, and nothing is engraved."""
    return body.boss is None and all(opening.depth is None for opening in body.openings)


def part_mesh(
    outlines: Sequence[LayerOutline], body: Body, *, tolerance: float, precision: Precision
) -> tuple[Mesh, MeshFacts]:
    """Mesh of a body in its outlines, outermost first: a prism, or prisms joined by manifold3d.

    Raises ToleranceError where the tolerance cannot be held in the precision, RegionError where outlines cross or a
    chamfer is too wide, ValueError without a thickness, TypeError for an outermost outline that is no polygon.
    """
    if body.thickness is None:
        raise ValueError("a solid needs a thickness")
    if body.prism:
        from camgeo.files.prism import extruded_mesh

        return extruded_mesh(outlines, thickness=body.thickness, tolerance=tolerance, precision=precision)
    if body.pocket is not None:
        from camgeo.files.prism import pocketed_mesh

        plain = _plain(body)
        kept = outlines if plain else outlines[: len(outlines) - len(body.openings)]
        mesh, facts = pocketed_mesh(
            kept, depth=body.pocket, thickness=body.thickness, tolerance=tolerance, precision=precision
        )
        if plain:
            return mesh, facts
        from camgeo.files.solid import completed_mesh, manifold

        disc = manifold(mesh.points, mesh.triangles)
        return completed_mesh(disc, facts, solid_of(body), tolerance=tolerance, precision=precision)
    from camgeo.files.solid import joined_mesh

    polygon = outlines[0].outline
    if not isinstance(polygon, Polygon):
        raise TypeError("a solid is made of a polygon")
    return joined_mesh(polygon, solid_of(body), tolerance=tolerance, precision=precision)


def solid_of(body: Body) -> Solid:
    """Boss, chamfer, cuts and drills of a body, for a solid of any outline; raises ValueError without a thickness."""
    from camgeo.files.solid import Cut, Drill, Solid

    if body.thickness is None:
        raise ValueError("a solid needs a thickness")
    cuts = [
        Cut(
            opening.outline,
            body.bottom if opening.depth is None else body.thickness - opening.depth,
            top,
            opening.island,
        )
        for opening in body.openings
        for top in (body.top if opening.depth is None else body.thickness,)
    ]
    boss = None if body.boss is None else body.boss.diameter
    drills = [
        # a flat or a keyway meets the hole's sides no flatter than the circle does
        Drill(
            hole.at,
            hole.diameter,
            hole.z,
            0.5 * (boss or 0.0) + 1.0,
            math.sqrt(1.0 - min(hole.diameter / body.bore, 1.0) ** 2) if body.bore else 1.0,
        )
        for hole in body.cross_holes
    ]
    floor = None if body.pocket is None else body.thickness - body.pocket
    return Solid(body.thickness, body.bottom, body.top, boss, body.edge, cuts, drills, floor)
