"""A part's body as file writers need it: the outlines cut on a drawing, and the pieces of a solid."""

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
    """The fitted contours, one for each surface of a design in its order, each on the layer of its surface."""
    return [LayerOutline(made.surface.layer, outline) for made, outline in zip(design.surfaces, fitted, strict=True)]


def rim_of(body: Body) -> list[LayerOutline]:
    """The round outline about the contours of a ring or a groove, alone in a list; an empty list without one."""
    return [LayerOutline(rim.layer, rim.outline, rim.circle) for rim in (body.rim,) if rim is not None]


def openings_of(body: Body) -> list[LayerOutline]:
    """Outlines of a body's openings, cut or engraved, in its order, each on its layer."""
    return [LayerOutline(opening.layer, opening.outline, opening.circle) for opening in body.openings]


def remarks(body: Body, mm: float) -> list[str]:
    """Comments for a drawing on what it does not show of features, such as depths; lengths in units of `mm` mm."""
    features = with_records(body.features)
    lines = [f"camgeo {feature.remark(value, mm)}" for feature, value in features if feature.remark is not None]
    lines += [
        f"camgeo {opening.name}: {opening.depth / mm:.9g} deep"
        for opening in body.openings
        if opening.depth is not None
    ]
    return lines


def needs_booleans(body: Body) -> bool:
    """Whether the mesh of a body needs solids to be joined or cut.

    A prism needs none, nor does a disc with a pocket on which nothing stands and nothing is engraved.
    """
    return not (body.prism or (body.pocket is not None and _plain(body)))


def _plain(body: Body) -> bool:
    """Whether nothing stands on a disc, and nothing is engraved."""
    return body.boss is None and all(opening.depth is None for opening in body.openings)


def part_mesh(
    outlines: Sequence[LayerOutline], body: Body, *, tolerance: float, precision: Precision
) -> tuple[Mesh, MeshFacts]:
    """Mesh of a body within a tolerance, mm, and facts on it: a prism, or prisms joined by manifold3d.

    `outlines` are the outermost one, further contours, then the openings of the body in its order; `precision` is that
    of the file. Raises ToleranceError where the tolerance cannot be held in the precision, RegionError where outlines
    cross or a chamfer is too wide, ModuleNotFoundError where manifold3d is needed and missing, ValueError without a
    thickness, TypeError for a spline, and for an outermost outline that is no polygon where prisms are joined.
    """
    if body.thickness is None:
        raise ValueError("a solid needs a thickness")
    if body.prism:
        from camgeo.files.prism import extruded_mesh

        return extruded_mesh(outlines, thickness=body.thickness, tolerance=tolerance, precision=precision)
    if body.pocket is not None:
        from camgeo.files.prism import pocketed_mesh

        # where solids are joined or cut in any case, the openings are cut then, each to its depth
        plain = _plain(body)
        extruded = outlines if plain else outlines[: len(outlines) - len(body.openings)]
        mesh, facts = pocketed_mesh(
            extruded, depth=body.pocket, thickness=body.thickness, tolerance=tolerance, precision=precision
        )
        if plain:
            return mesh, facts
        from camgeo.files.solid import completed_mesh, manifold

        disc = manifold(mesh.points, mesh.triangles)
        return completed_mesh(disc, facts, solid_of(body), tolerance=tolerance, precision=precision)
    # without a pocket the outermost outline is extruded, and all else is joined to it or cut out of it
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
        # length: from the shaft to 1 mm beyond the boss; slant: sine of the least angle at which the hole's sides meet
        # the bore's circle, which a flat or a keyway makes no smaller
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
