"""A part's body in the words of the file writers: what is cut on a drawing, and what a solid is made of."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.files.dxf import Circle, Cutout

if TYPE_CHECKING:
    from camgeo.files.mesh import Mesh, MeshFacts
    from camgeo.files.precision import Precision
    from camgeo.files.solid import Solid
    from camgeo.fit.pieces import Polygon
    from camgeo.synthesis.part.body import Body


def cutouts(body: Body) -> list[Cutout]:
    """What a drawing cuts or engraves besides the contour, each on its layer; the outline of a ring first."""
    outer = [] if body.outer is None else [Cutout("CUT", Circle("outline", (0.0, 0.0), 0.5 * body.outer))]
    return outer + [
        Cutout(
            opening.layer,
            opening.outline if opening.circle is None else Circle(opening.name, *opening.circle),
        )
        for opening in body.openings
    ]


def remarks(body: Body, mm: float) -> list[str]:
    """What a drawing does not show: told in its comments, in drawing units of `mm` mm."""
    found = []
    if body.hub is not None:
        hub = body.hub
        found.append(f"camgeo hub: diameter {hub.diameter / mm:.9g}, height {hub.height / mm:.9g}, side {hub.side}")
    if body.screw is not None:
        found.append(f"camgeo set screw: radial hole through the hub, diameter {body.screw.diameter / mm:.9g}")
    if body.chamfer is not None:
        found.append(f"camgeo chamfer: {body.chamfer / mm:.9g} at 45 degrees, both edges of CUT")
    found += [
        f"camgeo {opening.name}: {opening.depth / mm:.9g} deep"
        for opening in body.openings
        if opening.depth is not None
    ]
    return found


def part_mesh(polygon: Polygon, body: Body, *, tolerance: float, precision: Precision) -> tuple[Mesh, MeshFacts]:
    """Mesh of a body round a polygon: a prism, or prisms joined by manifold3d.

    Raises as `extruded` and `joined` do.
    """
    if body.thickness is None:
        raise ValueError("a solid needs a thickness")
    if body.prism:
        from camgeo.files.prism import extruded

        outlines = [opening.outline for opening in body.openings]
        return extruded(
            polygon,
            holes=outlines,
            thickness=body.thickness,
            outer=body.outer,
            tolerance=tolerance,
            precision=precision,
        )
    from camgeo.files.solid import joined

    return joined(polygon, solid_of(body), tolerance=tolerance, precision=precision)


def solid_of(body: Body) -> Solid:
    """What a body is made of, round whatever outline its contour is given; raises ValueError without a thickness."""
    from camgeo.files.solid import Cut, Drill, Solid

    if body.thickness is None:
        raise ValueError("a solid needs a thickness")
    cuts = [
        Cut(opening.outline, body.bottom if opening.depth is None else body.thickness - opening.depth, top)
        for opening in body.openings
        for top in (body.top if opening.depth is None else body.thickness,)
    ]
    drill = None
    if body.screw is not None and body.hub is not None and body.screw_height is not None:
        # a flat or a keyway meets the hole's sides no flatter than the circle does
        slope = math.sqrt(1.0 - min(body.screw.diameter / body.bore, 1.0) ** 2) if body.bore else 1.0
        drill = Drill(body.screw.at, body.screw.diameter, body.screw_height, 0.5 * body.hub.diameter + 1.0, slope)
    hub = None if body.hub is None else body.hub.diameter
    return Solid(body.thickness, body.bottom, body.top, hub, body.chamfer, cuts, drill, body.outer)
