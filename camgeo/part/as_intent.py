"""A part's body in kin's words: the openings and layers that a file will be held against."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from kin.contour.holes import Hole, round_hole
from kin.read.layers import Layer

if TYPE_CHECKING:
    from camgeo.part.body import Body
    from camgeo.part.shapes import Opening

KINDS = {"BORE": "bore", "HOLES": "holes", "MARK": "mark", "ENGRAVE": "mark"}


def holes_of(body: Body) -> tuple[Hole, ...]:
    """Record for kin of every opening, in the body's order and in the cam's axes."""
    return tuple(_hole(opening) for opening in body.openings)


def layers_of(body: Body) -> tuple[Layer, ...]:
    """Records for kin of the layers of the solid, from below; empty without a thickness."""
    thickness = body.thickness
    if thickness is None:
        return ()
    # a layer reaches from one height at which a section changes to the next: faces, chamfers, floors
    through = tuple(_hole(opening) for opening in body.openings if opening.depth is None)
    edge = body.edge
    heights = {0.0, thickness, edge, thickness - edge}
    floor = 0.0
    if body.pocket is not None and body.outer is not None:
        floor = thickness - body.pocket
        heights.add(floor)
    heights |= {thickness - opening.depth for opening in body.openings if opening.depth is not None}
    layers = []
    for low, high in pairwise(sorted(heights)):
        shallow = tuple(
            _hole(opening)
            for opening in body.openings
            if opening.depth is not None and thickness - opening.depth <= low
        )
        insets = (_inset(low, thickness, edge), _inset(high, thickness, edge))
        blank = round_hole("outline", "thickness", (0.0, 0.0), body.outer) if body.outer and high <= floor else None
        layers.append(Layer(low, high, (*through, *shallow), blank, insets))
    # the boss has layers of its own beyond the faces, with the holes that pass through it
    boss = body.boss
    if boss is not None:
        outline = round_hole(boss.name, "hub", (0.0, 0.0), boss.diameter)
        inside = tuple(_hole(opening) for opening in body.openings if boss.holds(opening))
        if body.bottom < 0.0:
            layers.insert(0, Layer(body.bottom, 0.0, inside, outline))
        if body.top > thickness:
            layers.append(Layer(thickness, body.top, inside, outline))
    return tuple(layers)


def _inset(z: float, thickness: float, chamfer: float) -> float:
    """Distance of the outline inside the contour at height z of a chamfered disc, mm; exactly 0 between chamfers."""
    upper = thickness - chamfer
    return max(chamfer - z, 0.0) if z <= upper else z - upper


def _hole(opening: Opening) -> Hole:
    points = tuple((float(x), float(y)) for x, y in opening.outline.points)
    bulges = tuple(float(b) for b in opening.outline.bulges)
    return Hole(opening.name, KINDS[opening.layer], points, bulges, opening.depth)
