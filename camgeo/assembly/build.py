"""The printable bodies of a recipe's mechanism, of whichever kind it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from camgeo.assembly.shaft import Drive, disk_of, shaft_of
from camgeo.assembly.sizes import BodyError, sizes_of
from camgeo.recipe.assembly import MechanismAsked
from kin.contour.contour import Contour
from kin.contour.region import farthest

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.assembly.assembly import Assembly
    from camgeo.assembly.guided import Stand
    from camgeo.cams.constant_diameter import ConstantDiameterCam
    from camgeo.cams.disc_cams import OscillatingFaceCam, OscillatingRoundCam, TranslatingFaceCam, TranslatingRoundCam
    from camgeo.curve.moving_frame import Displacement
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
    made = MADE[design.follower.name]
    roller = recipe.cam.touch_radius if made.rollers else None
    s = sizes_of(recipe.mechanism or MechanismAsked(), reach, part.bore or 0.0, roller, made.rollers)
    drive = Drive(disk_of(part, design.body, contour), reach, shaft_of(part, s), s)
    return made.bodies(recipe, design, drive)


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


def _round(recipe: Recipe, design: Design) -> Stand:
    """What stands up into the plane of the cam: a roller, or a shoe."""
    from camgeo.assembly import guided

    radius = recipe.cam.touch_radius
    if MADE[design.follower.name].rollers:
        return guided.roller(radius)
    return guided.shoe(radius, recipe.cam.pressure_angle(design.intent, design.profile)(guided.SHAFT))


def _on_stem(recipe: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.guided import on_stem

    line = cast("TranslatingRoundCam", recipe.cam).guide
    return on_stem(cast("Displacement", design.intent), line, _round(recipe, design), drive)


def _on_arm(recipe: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.guided import on_arm

    lever = cast("OscillatingRoundCam", recipe.cam).guide
    return on_arm(cast("Displacement", design.intent), lever, _round(recipe, design), drive)


def _roller_frame(recipe: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.guided import roller_frame

    cam = cast("ConstantDiameterCam", recipe.cam)
    motion = cast("Displacement", design.intent)
    return roller_frame(motion, cam.guide.foot, cam.apart(motion), cam.touch_radius, drive)


def _face_on_stem(recipe: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.guided import SHAFT
    from camgeo.assembly.poses import lifted
    from camgeo.assembly.yoke import face_on_stem

    cam, motion = cast("TranslatingFaceCam", recipe.cam), cast("Displacement", design.intent)
    face = cam.face(motion)
    contact = cam.contact_place(motion, design.profile)(SHAFT)
    margin = 0.5 * drive.sizes.bar
    extent = float(contact.min()) - margin, float(contact.max()) + margin
    if cam.width is not None:
        extent = -0.5 * cam.width, 0.5 * cam.width
    x = face.level + motion.derivatives(SHAFT, 0)[0]
    return face_on_stem(lifted(motion, face.level, cam.offset), x, extent, drive, tilt=cam.tilt, line=cam.offset)


def _face_on_arm(recipe: Recipe, design: Design, drive: Drive) -> Assembly:
    from camgeo.assembly.guided import SHAFT, face_on_arm

    cam, motion = cast("OscillatingFaceCam", recipe.cam), cast("Displacement", design.intent)
    face = cam.face(motion)
    return face_on_arm(face, cam.contact_place(motion, design.profile)(SHAFT), drive)


def _knife_edge(_: Recipe, __: Design, ___: Drive) -> Assembly:
    message, remedy = "a knife edge is not printed", "give a roller or a shoe, or leave parts: all out"
    raise BodyError("cam.follower", message, remedy)


class _Made(NamedTuple):
    """How the bodies of a follower are made, and where the recipe gives the radius of its rollers, if it has any."""

    bodies: Callable[[Recipe, Design, Drive], Assembly]
    rollers: str = ""


MADE: dict[str, _Made] = {
    "double roller": _Made(_double_roller, "cam.roller_radius"),
    "flat pair": _Made(_flat_pair),
    "square frame": _Made(_linked),
    "yoke": _Made(_yoke),
    "flat face": _Made(_flat_face),
    "roller yoke": _Made(_roller_frame, "cam.roller_radius"),
    "translating roller": _Made(_on_stem, "cam.follower.radius"),
    "translating shoe": _Made(_on_stem),
    "translating flat face": _Made(_face_on_stem),
    "translating knife edge": _Made(_knife_edge),
    "oscillating roller": _Made(_on_arm, "cam.follower.radius"),
    "oscillating shoe": _Made(_on_arm),
    "oscillating flat face": _Made(_face_on_arm),
    "oscillating knife edge": _Made(_knife_edge),
}
"""Which bodies each follower takes."""


def _reach_of(contour: ArcSpline) -> float:
    """How far a cam whose contour is drawn by arcs reaches from the shaft, mm: no less than it does."""
    arcs, _ = Contour.from_bulges(contour.points, contour.bulges).as_arcs()
    return float(farthest(arcs, np.zeros((len(arcs), 2))).max()) + contour.bound.worst
