"""The printable bodies of a recipe's mechanism, of whichever kind it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism import guided, roller, yoke
from camgeo.capabilities.mechanism.keys import sizes_given
from camgeo.capabilities.mechanism.shaft import Drive, disk_of, shaft_of
from camgeo.capabilities.mechanism.sizes import sizes_of
from camgeo.synthesis.view import Drawer, entry, view_of
from kin.contour.contour import Contour
from kin.contour.region import farthest
from kin.law.contacts import Arrangement, Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.assembly import Assembly
    from camgeo.fit.pieces import ArcSpline
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def assembly_of(recipe: Recipe, design: Design, *contours: ArcSpline) -> Assembly:
    """Make the bodies round a cam's contours, one for each surface, as drawn for a shaft that turns clockwise.

    Raises BodyError where one of them cannot be made.
    """
    (disc,) = design.discs
    if disc.body is None:
        raise ValueError(f"{recipe.name}: there is no part to be made")
    part = recipe.part
    reach = max(map(_reach_of, contours)) if part.outer is None else 0.5 * part.outer
    arrangement, view = design.follower.arrangement, view_of(recipe, design)
    rolling = arrangement.touch is Roller
    field = "" if not rolling else "cam.follower.radius" if arrangement.contacts == 1 else "cam.roller_radius"
    radius = view.touch.radius if rolling else None
    s = sizes_of(sizes_given(recipe), reach, part.bore or 0.0, radius, field)
    drive = Drive(disk_of(part, disc.body, contours), reach, shaft_of(part, s), s)
    if design.driven is not None:
        from camgeo.capabilities.mechanism.linked import linked

        return linked(design.driven.mechanism, drive)
    return BODIES[arrangement](view, drive)


BODIES: dict[Arrangement, Drawer[[Drive], Assembly]] = dict(
    [
        entry(Translating, Roller, guided.on_stem),
        entry(Translating, Shoe, guided.on_stem),
        entry(Translating, KnifeEdge, guided.on_stem),
        entry(Translating, Flat, yoke.face_on_stem),
        entry(Translating, Flat, yoke.yoke, 2),
        entry(Translating, Roller, guided.roller_frame, 2),
        entry(Oscillating, Roller, guided.on_arm),
        entry(Oscillating, Shoe, guided.on_arm),
        entry(Oscillating, KnifeEdge, guided.on_arm),
        entry(Oscillating, Flat, guided.face_on_arm),
        entry(Oscillating, Roller, roller.double_roller, 2),
        entry(Oscillating, Flat, roller.flat_pair, 2),
    ]
)
"""Which bodies each follower takes; those of a linkage are `camgeo.capabilities.mechanism.linked`'s."""


def _reach_of(contour: ArcSpline) -> float:
    """How far a cam whose contour is drawn by arcs reaches from the shaft, mm: no less than it does."""
    arcs, _ = Contour.from_bulges(contour.points, contour.bulges).as_arcs()
    return float(farthest(arcs, np.zeros((len(arcs), 2))).max()) + contour.bound.worst
