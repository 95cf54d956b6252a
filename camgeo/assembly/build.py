"""The printable bodies of a recipe's mechanism, of whichever kind it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from camgeo.assembly.shaft import Drive, disk_of, shaft_of
from camgeo.assembly.sizes import sizes_of
from camgeo.recipe.assembly import MechanismAsked
from camgeo.recipe.cam import DoubleRollerCam, FlatPairCam
from kin.contour.contour import Contour
from kin.contour.region import farthest

if TYPE_CHECKING:
    from camgeo.assembly.assembly import Assembly
    from camgeo.fit.pieces import ArcSpline
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission


def assembly_of(recipe: Recipe, design: Design, contour: ArcSpline) -> Assembly:
    """Make the bodies round a cam's contour, as drawn for a shaft that turns clockwise.

    Raises BodyError where one of them cannot be made.
    """
    part = recipe.part
    cam, reach = recipe.cam, _reach_of(contour)
    roller = cam.roller_radius if isinstance(cam, DoubleRollerCam) else None
    s = sizes_of(recipe.mechanism or MechanismAsked(), reach, part.bore or 0.0, roller)
    drive = Drive(disk_of(part, design.body, contour), reach, shaft_of(part, s), s)
    if isinstance(cam, DoubleRollerCam):
        from camgeo.assembly.roller import double_roller

        return double_roller(cast("Transmission", design.intent), cam.roller_radius, drive)
    if isinstance(cam, FlatPairCam):
        from camgeo.assembly.roller import flat_pair

        return flat_pair(cast("Transmission", design.intent), drive)
    if design.driven is not None:
        from camgeo.assembly.linked import linked

        return linked(design.driven.mechanism, drive)
    from camgeo.assembly.yoke import flat_face, yoke

    lift = cast("Lift", design.intent)  # the kind of cam decides the kind of intent
    if design.yoke_breadth is None:
        return flat_face(lift, drive)
    return yoke(lift, design.yoke_breadth, drive)


def _reach_of(contour: ArcSpline) -> float:
    """How far a cam whose contour is drawn by arcs reaches from the shaft, mm: no less than it does."""
    arcs, _ = Contour.from_bulges(contour.points, contour.bulges).as_arcs()
    return float(farthest(arcs, np.zeros((len(arcs), 2))).max()) + contour.bound.worst
