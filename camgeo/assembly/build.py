"""The printable bodies of a recipe's mechanism, of whichever kind it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from camgeo.assembly.shaft import Drive, disk_of, shaft_of
from camgeo.assembly.sizes import sizes_of
from camgeo.recipe.assembly import MechanismAsked
from kin.contour.contour import Contour
from kin.contour.region import farthest

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.assembly.assembly import Assembly
    from camgeo.fit.pieces import ArcSpline
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from camgeo.synthesis.linkage import Driven
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission


def assembly_of(recipe: Recipe, design: Design, contour: ArcSpline) -> Assembly:
    """Make the bodies round a cam's contour, as drawn for a shaft that turns clockwise.

    Raises BodyError where one of them cannot be made.
    """
    part = recipe.part
    reach = _reach_of(contour)
    s = sizes_of(recipe.mechanism or MechanismAsked(), reach, part.bore or 0.0, recipe.cam.touch_radius or None)
    drive = Drive(disk_of(part, design.body, contour), reach, shaft_of(part, s), s)
    return MADE[design.follower.name](recipe, design, drive)


def _double_roller(recipe: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.roller import double_roller

    return double_roller(cast("Transmission", design.intent), recipe.cam.touch_radius, drive)


def _flat_pair(_: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.roller import flat_pair

    return flat_pair(cast("Transmission", design.intent), drive)


def _linked(_: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.linked import linked

    return linked(cast("Driven", design.driven).mechanism, drive)


def _yoke(_: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.yoke import yoke

    return yoke(cast("Lift", design.intent), cast("float", design.yoke_breadth), drive)


def _flat_face(_: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.yoke import flat_face

    return flat_face(cast("Lift", design.intent), drive)


MADE: dict[str, Callable[[Recipe, Design, Drive], Assembly]] = {
    "double roller": _double_roller,
    "flat pair": _flat_pair,
    "square frame": _linked,
    "yoke": _yoke,
    "flat face": _flat_face,
}
"""Which bodies each follower takes."""


def _reach_of(contour: ArcSpline) -> float:
    """How far a cam whose contour is drawn by arcs reaches from the shaft, mm: no less than it does."""
    arcs, _ = Contour.from_bulges(contour.points, contour.bulges).as_arcs()
    return float(farthest(arcs, np.zeros((len(arcs), 2))).max()) + contour.bound.worst
