"""A cylindrical cam as bodies to be drawn: the drum, seen along the roller's axis, and the roller that it moves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.figures import carried_from, outer_end
from camgeo.capabilities.cylindrical.guide import Arm
from camgeo.capabilities.cylindrical.shells import far, near, rims, shells
from camgeo.curve.ring import Ring, bar, box, disc
from camgeo.report.page.scene import CONTACTS, SHAFT, STEPS, FilledShape, MovingBody, Scene, pin, pivot, poses, still

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe, Roller
    from camgeo.capabilities.cylindrical.flank import Flank
    from camgeo.capabilities.cylindrical.shells import Shell
    from camgeo.report.page.scene import SceneInput
    from kin.numeric.arrays import Array

DRUM = "drum"  # the kind of the body that a page draws anew at each angle
LINES = STEPS // 2  # parts of a turn at which lines of contact are known
JOINT = 0.016  # of the drum's diameter and length together: size of a joint
ARC = 12  # chords of an arc of contact


def scene(design: DrumDesign, step: int = 0, of: list[Shell] | None = None) -> Scene:
    """The drum as it stands at a step of the turn, and its follower over the turn, in the recipe's unit.

    `of` are the shells of the drum, which are computed by default.
    """
    recipe = design.recipe
    theta = np.linspace(0.0, recipe.period, STEPS + 1)
    size = JOINT * (2.0 * recipe.radius + recipe.height)
    shapes = drum_shapes(design, of or shells(design), design.recipe.sense * float(theta[step]))
    guide = recipe.guide
    follower = _arm(design, guide, theta, size) if isinstance(guide, Arm) else _carriage(design, theta, size)
    bodies = [MovingBody("drum", DRUM, tuple(shapes), still()), *follower]
    for name, flank in design.flanks.items():
        arc = FilledShape("contact line", (_arc(design, name, step),))
        bodies.append(MovingBody(f"contact {name}", CONTACTS, (arc,), poses(*seen_axis(design, flank, theta), 0.0)))
    way = "clockwise" if recipe.rotation == "cw" else "counter-clockwise"
    note = f"seen along the roller's axis; the drum turns {way}, seen from above"
    return Scene(tuple(bodies), note, input_of(recipe)).scaled(1.0 / recipe.mm)


def input_of(recipe: DrumRecipe) -> SceneInput:
    """Shaft angle over the turns after which the motion repeats."""
    whole = 360 * recipe.turns
    return SHAFT if recipe.turns == 1 else SHAFT._replace(most=whole, pace=f"times {recipe.turns} turns a minute")


def drum_shapes(design: DrumDesign, of: list[Shell], turn: float) -> list[FilledShape]:
    """Shapes of the drum from the hindmost to the foremost, with the polar angle `turn`, rad, towards the viewer."""
    recipe = design.recipe
    core = FilledShape("fixed", (box(-recipe.floor, 0.0, recipe.floor, recipe.height),), "floor of the track")
    walls = [_shape("wall", far(each, turn, recipe.floor)) for each in reversed(of)]
    walls += [core, *(_shape("wall", near(each, turn)) for each in of[:-1])]
    return [*walls, _shape("wall", rims(of, turn)), _shape("metal", near(of[-1], turn), "blank")]


def _shape(role: str, outlines: list[Array], name: str = "") -> FilledShape:
    return FilledShape(role, tuple(Ring.through(outline) for outline in outlines), name)


def rollers(design: DrumDesign) -> list[Flank]:
    """A flank of each roller, from the lowest at lift 0."""
    return sorted({flank.guide: flank for flank in design.flanks.values()}.values(), key=lambda flank: flank.level)


def seen_axis(design: DrumDesign, flank: Flank, theta: Array) -> tuple[Array, Array]:
    """Places to the right and up, mm (n,) each, of the axis of a flank's roller at shaft angles (n,)."""
    pose = flank.pose(theta)
    return design.recipe.sense * pose.y, pose.z


def _roller(design: DrumDesign, x: float, y: float) -> FilledShape:
    """The roller's outer end about a place, or the shoe."""
    if design.recipe.roller.shoe is not None:
        return FilledShape("roller", (Ring.through(outline(design.recipe.roller) + np.array([x, y])),), "shoe")
    roller = design.recipe.roller
    return FilledShape("roller", (disc(x, y, roller.size(roller.outer)),), "roller")


def outline(roller: Roller) -> Array:
    """Outline (n, 2) of a shoe about its pin, mm, along x."""
    x = 0.5 * (roller.shoe or 0.0) * np.linspace(-1.0, 1.0, 2 * ARC + 1)
    upper = np.column_stack([x, roller.half_width(x)])
    return np.concatenate([upper[::-1], upper[1:-1] * (1.0, -1.0)])


def slope(design: DrumDesign, theta: Array) -> Array:
    """Slope of the track to the right of the viewer at shaft angles (n,), rad, in the middle of a shoe."""
    roller = design.recipe.roller
    middle = 0.5 * (roller.inner + roller.outer)
    return np.asarray(design.recipe.sense * np.arctan2(design.law.derivatives(theta, 1)[1], middle))


def _arm(design: DrumDesign, guide: Arm, theta: Array, size: float) -> list[MovingBody]:
    """Rollers on their arm, and its pivot; the arm's own x leads from the pivot to the roller."""
    way = -design.recipe.sense * guide.side
    psi = guide.start + design.law.derivatives(theta, 0)[0]
    x = design.recipe.sense * guide.y
    pose = poses(x, guide.z, psi if way > 0.0 else math.pi - psi)
    half = 0.5 * design.recipe.track.distance
    places = [(guide.length, way * side * half) for side in (-1.0, 1.0)] if half else [(guide.length, 0.0)]
    shape = [bar((0.0, 0.0), (guide.length, 0.0), 1.4 * size)]
    shape += [bar(places[0], places[-1], 1.4 * size)] if half else []
    return [
        MovingBody("rollers", "follower", tuple(_roller(design, *place) for place in places), pose),
        MovingBody("arm", "follower", tuple(FilledShape("follower", (each,), "arm") for each in shape), pose),
        MovingBody("pins", "follower", tuple(pin(size, *place) for place in places), pose),
        pivot("pivot", x, guide.z, size, "P"),
    ]


def _carriage(design: DrumDesign, theta: Array, size: float) -> list[MovingBody]:
    """Rollers, and the carriage with its rail beside the drum."""
    recipe, heights = design.recipe, [flank.level for flank in rollers(design)]
    lift = design.law.derivatives(theta, 0)[0]
    low, high = heights[0], heights[-1]
    x = float(seen_axis(design, rollers(design)[0], theta[:1])[0][0])
    beside, half = recipe.radius + 3.5 * size, 1.6 * size
    rail = box(beside - 0.6 * size, low - 4.0 * size, beside + 0.6 * size, high + float(lift.max()) + 4.0 * size)
    carriage = [bar((x, z), (beside, z), 1.1 * size) for z in heights]
    block = box(beside - half, low - 2.4 * size, beside + half, high + 2.4 * size)
    ends = tuple(_roller(design, x, z) for z in heights)
    pose = poses(0.0, lift, 0.0)
    if recipe.roller.shoe is not None:
        turned = MovingBody(
            "shoe", "follower", (_roller(design, 0.0, 0.0),), poses(x, low + lift, slope(design, theta))
        )
        pinned = MovingBody("rollers", "follower", (pin(size, x, low),), pose)
    else:
        turned = MovingBody("rollers", "follower", (*ends, *(pin(size, x, z) for z in heights)), pose)
        pinned = None
    return [
        MovingBody("rail", "ground", (FilledShape("fixed", (rail,), "rail"),), still()),
        turned,
        *([] if pinned is None else [pinned]),
        MovingBody(
            "carriage",
            "follower",
            (*(FilledShape("follower", (each,), "carriage") for each in carriage), FilledShape("follower", (block,))),
            pose,
        ),
    ]


class Touched(NamedTuple):
    """Both ends of a line of contact over the turn (LINES + 1,) each.

    low, high  angles about the roller's axis, rad; nan where nothing carries
    near, far  distances from that axis, mm, below 0 of a lower flank
    """

    low: Array
    high: Array
    near: Array
    far: Array


def touched(design: DrumDesign, name: str) -> Touched:
    """Both ends of the line along which a flank carries the roller."""
    flank, theta = design.flanks[name], np.linspace(0.0, design.recipe.period, LINES + 1)
    ends = carried_from(design, name, theta), outer_end(design, name, theta)
    carries = ends[0] < ends[1]
    low, high = (np.where(carries, flank.along(theta, rho).angle, np.nan) for rho in ends)
    return Touched(low, high, *(flank.side * flank.size(rho) for rho in ends))


def _arc(design: DrumDesign, name: str, step: int) -> Ring:
    """The line of contact as it shows on the roller's end, from the roller's axis."""
    low, high, near_end, far_end = (rows[step * LINES // STEPS] for rows in touched(design, name))
    angle, reach = np.linspace(low, high, ARC + 1), np.linspace(near_end, far_end, ARC + 1)
    if not np.isfinite(low):
        angle, reach = np.zeros(2), np.full(2, near_end)
    points = np.column_stack([-design.recipe.sense * reach * np.sin(angle), reach * np.cos(angle)])
    return Ring.through(points, closed=False)
