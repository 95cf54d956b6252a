"""A part's body in kin's words: the openings, layers and radial holes that a file will be held against."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from camgeo.part.chamfer import inset
from kin.judge.holes import Hole, round_hole
from kin.judge.layers import CrossHole, Layer

if TYPE_CHECKING:
    from camgeo.part.body import Body
    from camgeo.part.shapes import Opening

KINDS = {"BORE": "bore", "HOLES": "holes", "MARK": "mark", "ENGRAVE": "mark"}


def holes_of(body: Body) -> tuple[Hole, ...]:
    """Record for kin of every opening, in the cam's axes."""
    return tuple(_hole(opening) for opening in body.openings)


def layers_of(body: Body) -> tuple[Layer, ...]:
    """Records for kin of the layers of the solid, from below; empty without a thickness."""
    thickness = body.thickness
    if thickness is None:
        return ()
    through = tuple(_hole(opening) for opening in body.openings if opening.depth is None)
    chamfer = body.chamfer or 0.0
    heights = {0.0, thickness}
    if chamfer:
        heights |= {chamfer, thickness - chamfer}
    floor = 0.0
    if body.pocket is not None and body.outer is not None:
        floor = thickness - body.pocket
        heights.add(floor)
    heights |= {thickness - opening.depth for opening in body.openings if opening.depth is not None}
    rising = sorted(heights)
    layers = []
    for low, high in pairwise(rising):
        shallow = tuple(
            _hole(opening)
            for opening in body.openings
            if opening.depth is not None and thickness - opening.depth <= low
        )
        insets = (inset(low, thickness, chamfer), inset(high, thickness, chamfer))
        blank = round_hole("outline", "thickness", (0.0, 0.0), body.outer) if body.outer and high <= floor else None
        layers.append(Layer(low, high, (*through, *shallow), blank, insets))
    hub = body.hub
    if hub is not None:
        outline = round_hole("hub", "hub", (0.0, 0.0), hub.diameter)
        inside = tuple(
            _hole(opening) for opening in body.openings if opening.depth is None and hub.holds(opening.middle)
        )
        if body.bottom < 0.0:
            layers.insert(0, Layer(body.bottom, 0.0, inside, outline))
        if body.top > thickness:
            layers.append(Layer(thickness, body.top, inside, outline))
    return tuple(layers)


def cross_holes_of(body: Body) -> tuple[CrossHole, ...]:
    """Record for kin of the set screw's radial hole, in a tuple; empty without one."""
    height = body.screw_height
    if body.screw is None or height is None:
        return ()
    return (CrossHole("set screw", body.screw.at, body.screw.diameter, height),)


def _hole(opening: Opening) -> Hole:
    points = tuple((float(x), float(y)) for x, y in opening.outline.points)
    bulges = tuple(float(b) for b in opening.outline.bulges)
    return Hole(opening.name, KINDS[opening.layer], points, bulges, opening.depth)
