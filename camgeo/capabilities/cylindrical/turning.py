"""A cylindrical cam as bodies to be drawn: the drum, seen along the roller's axis, and the roller that it moves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.figures import carried_from, outer_end
from camgeo.capabilities.cylindrical.shells import far, near, rims, shells
from camgeo.curve.ring import Ring, bar, box, disc
from camgeo.report.page.scene import CONTACTS, STEPS, FilledShape, MovingBody, Scene, pin, poses, still

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.shells import Shell
    from kin.numeric.arrays import Array

DRUM = "drum"  # the kind of the body that a page draws anew at each angle
LINES = STEPS // 2  # parts of a turn at which lines of contact are known
JOINT = 0.016  # of the drum's diameter and length together: size of a joint
ARC = 12  # chords of an arc of contact


def sense(design: DrumDesign) -> float:
    """1 where the polar angle that faces the viewer rises with the shaft angle, else -1."""
    return 1.0 if design.recipe.rotation == "cw" else -1.0


def scene(design: DrumDesign, step: int = 0, of: list[Shell] | None = None) -> Scene:
    """The drum as it stands at a step of the turn, and its follower over the turn, in the recipe's unit.

    `of` are its shells, by default as they are made here.
    """
    recipe = design.recipe
    theta = np.linspace(0.0, 2.0 * math.pi, STEPS + 1)
    lift = design.law.derivatives(theta, 0)[0]
    size = JOINT * (2.0 * recipe.radius + recipe.height)
    shapes = drum_shapes(design, of or shells(design), sense(design) * float(theta[step]))
    bodies = [MovingBody("drum", DRUM, tuple(shapes), still()), *_follower(design, lift, size)]
    bodies += [
        MovingBody(
            f"contact {name}", CONTACTS, (FilledShape("contact line", (_arc(design, name, step),)),), poses(0, lift, 0)
        )
        for name in design.flanks
    ]
    way = "clockwise" if recipe.rotation == "cw" else "counter-clockwise"
    note = f"seen along the roller's axis; the drum turns {way}, seen from above"
    return Scene(tuple(bodies), note).scaled(1.0 / recipe.mm)


def drum_shapes(design: DrumDesign, of: list[Shell], turn: float) -> list[FilledShape]:
    """Shapes of the drum from the hindmost to the foremost, with the polar angle `turn`, rad, towards the viewer."""
    recipe = design.recipe
    core = FilledShape("fixed", (box(-recipe.floor, 0.0, recipe.floor, recipe.height),), "floor of the track")
    walls = [_shape("wall", far(each, turn, recipe.floor)) for each in reversed(of)]
    walls += [core, *(_shape("wall", near(each, turn)) for each in of[:-1])]
    return [*walls, _shape("wall", rims(of, turn)), _shape("metal", near(of[-1], turn), "blank")]


def _shape(role: str, outlines: list[Array], name: str = "") -> FilledShape:
    return FilledShape(role, tuple(Ring.through(outline) for outline in outlines), name)


def levels(design: DrumDesign) -> list[float]:
    """Heights of the axes of all rollers at lift 0, mm, from the lowest."""
    return sorted({flank.level for flank in design.flanks.values()})


def _follower(design: DrumDesign, lift: Array, size: float) -> list[MovingBody]:
    """Rollers, and the carriage with its rail beside the drum."""
    recipe, heights = design.recipe, levels(design)
    low, high = heights[0], heights[-1]
    beside, half = recipe.radius + 3.5 * size, 1.6 * size
    rail = box(beside - 0.6 * size, low - 4.0 * size, beside + 0.6 * size, high + float(lift.max()) + 4.0 * size)
    carriage = [bar((0.0, z), (beside, z), 1.1 * size) for z in heights]
    block = box(beside - half, low - 2.4 * size, beside + half, high + 2.4 * size)
    rollers = tuple(FilledShape("roller", (disc(0.0, z, recipe.roller.radius),), "roller") for z in heights)
    pose = poses(0.0, lift, 0.0)
    return [
        MovingBody("rail", "ground", (FilledShape("fixed", (rail,), "rail"),), still()),
        MovingBody("rollers", "follower", (*rollers, *(pin(size, 0.0, z) for z in heights)), pose),
        MovingBody(
            "carriage",
            "follower",
            (*(FilledShape("follower", (each,), "carriage") for each in carriage), FilledShape("follower", (block,))),
            pose,
        ),
    ]


def contact_angles(design: DrumDesign, name: str) -> tuple[Array, Array]:
    """Pressure angles, rad (LINES + 1,), at both ends of the line that carries; nan where nothing carries."""
    theta = np.linspace(0.0, 2.0 * math.pi, LINES + 1)
    begin, end = carried_from(design, name, theta), outer_end(design, name, theta)
    v = np.where(begin < end, design.law.derivatives(theta, 1)[1], np.nan)
    return np.arctan2(v, begin), np.arctan2(v, end)


def _arc(design: DrumDesign, name: str, step: int) -> Ring:
    """The line of contact as it shows on the roller's end, from the roller's place at lift 0."""
    flank = design.flanks[name]
    low, high = (rows[step * LINES // STEPS] for rows in contact_angles(design, name))
    angle = np.linspace(low, high, ARC + 1) if np.isfinite(low) else np.zeros(2)
    reach = flank.side * flank.radius
    points = np.column_stack([-sense(design) * reach * np.sin(angle), flank.level + reach * np.cos(angle)])
    return Ring.through(points, closed=False)
