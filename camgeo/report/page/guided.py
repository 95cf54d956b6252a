"""Scenes of the followers that are led on a stem or an arm: roller, knife edge, shoe, flat face, frame of two rollers.

The part that touches the cam has axes of its own: x along the travel, the origin at the roller's centre, or where a
flat face meets the axis of its stem. Stem or arm is one body, the touching part another. Lengths are in mm, angles in
rad; `size` is the size of a joint, by which parts are scaled.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.ring import Ring, bar, box, disc
from camgeo.report.page.followers import SHAFT, contact, guide
from camgeo.report.page.scene import FilledShape, MovingBody, pin, pivot, poses
from kin.law.contacts import Roller, Shoe
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.surface import Surface
    from camgeo.synthesis.view import Round
    from kin.law import contacts
    from kin.law.contacts import Contact, Oscillating
    from kin.numeric.arrays import Array

WIDTH = 1.9  # of an arm, in sizes of a joint
HALF_STEM = 1.3
THICK = 2.2  # of a face or a shoe
MARGIN = 2.0  # of a face or a shoe beyond the contact


@dataclass(frozen=True, eq=False)
class Touch:
    """Part of a follower that touches the cam, in axes with x along the travel.

    `foot` is the x at which its stem or arm begins, `ahead` the greatest x of its shapes, `within` the length of the
    contact's normal that they cover.
    """

    name: str
    shapes: tuple[FilledShape, ...]
    foot: float = 0.0
    ahead: float = 0.0
    within: float = 0.0


def touch_of(touch: Round, angle: Array, size: float, suffix: str = "") -> Touch:
    """Return a roller, a shoe as wide as pressure angles (n,) need, or a knife edge; `suffix` ends the name."""
    match touch:
        case Roller(radius=radius):
            return roller(radius, size, f"roller{suffix}")
        case Shoe(radius=radius):
            return replace(shoe(radius, angle, size), name=f"shoe{suffix}")
    return knife_edge(size)


def roller(radius: float, size: float, name: str = "roller") -> Touch:
    """Return a roller on its pin."""
    shapes = (FilledShape("roller", (disc(0.0, 0.0, radius),), name), pin(min(size, 0.8 * radius)))
    return Touch(name, shapes, ahead=radius, within=radius)


def knife_edge(size: float) -> Touch:
    """Return a stem's end as a wedge of 60 degrees."""
    tall, half = math.sqrt(3.0) * HALF_STEM * size, HALF_STEM * size
    wedge = Ring.through([(0.0, 0.0), (tall, -half), (1.4 * tall, -half), (1.4 * tall, half), (tall, half)])
    return Touch("knife edge", (FilledShape("follower", (wedge,), "knife edge"),), 1.2 * tall, 1.4 * tall)


def shoe(radius: float, angle: Array, size: float) -> Touch:
    """Return a shoe: the arc that is touched at pressure angles (n,), and a margin at either end."""
    beyond = MARGIN * size / radius
    most = 0.5 * math.pi
    high = min(max(float(angle.max()), 0.0) + beyond, most)
    low = max(min(float(angle.min()), 0.0) - beyond, -most)
    # a pressure angle above 0 is touched ahead of the travel line
    upper, lower = (complex(-math.cos(a), math.sin(a)) * radius for a in (high, low))
    back = max(upper.real, lower.real) + THICK * size
    points = np.array([(upper.real, upper.imag), (lower.real, lower.imag), (back, lower.imag), (back, upper.imag)])
    outline = Ring(points, np.array([math.tan(0.25 * (high - low)), 0.0, 0.0, 0.0]))
    return Touch("shoe", (FilledShape("follower", (outline,), "shoe"),), back - 0.5 * THICK * size, back)


def face(tilt: float, low: float, high: float, size: float) -> Touch:
    """Return a flat face from `low` to `high` along it, its normal turned by `tilt` from the travel."""
    c, s = math.cos(tilt), math.sin(tilt)
    corners = np.array([(0.0, low), (0.0, high), (THICK * size, high), (THICK * size, low)])
    outline = Ring.through(corners @ np.array([[c, s], [-s, c]]))
    foot = (HALF_STEM * abs(math.tan(tilt)) + 0.5 * THICK / c) * size
    return Touch(
        "flat face", (FilledShape("follower", (outline,), "flat face"),), foot, float(outline.points[:, 0].max())
    )


def on_stem(touch: Touch, x: Array, y: float, reach: float, size: float) -> list[MovingBody]:
    """Return the follower on a stem at places x (n,) of a line at y, with its guide beyond the cam.

    `reach` is the cam's greatest radius.
    """
    half, run = HALF_STEM * size, 4.5 * size
    start = max(float(x.max()) + touch.ahead, reach) + size
    length = start + run + 2.0 * size - float(x.min())
    stem = FilledShape("follower", (box(touch.foot, -half, length, half),), "stem")
    return [
        MovingBody("stem", "follower", (stem,), poses(x, y, 0.0)),
        MovingBody(touch.name, "follower", touch.shapes, poses(x, y, 0.0)),
        guide(start, run, half, size, y),
    ]


def on_arm(
    touch: Touch,
    contact: Contact[Oscillating, contacts.Touch],
    s: Array,
    origin: tuple[float, float],
    size: float,
    *,
    short: float = 0.0,
) -> list[MovingBody]:
    """Return the follower on an arm at swings s (n,) from the start of the motion, and its pivot.

    The arm's own x leads from the pivot to the touching part, whose travel is along `side` times y. `origin` is the
    origin of the touching part's axes in those of the arm. The arm is drawn to a place `short` nearer the pivot.
    """
    arm = contact.guide
    angle = math.pi + arm.side * (contact.datum + s)
    (x, y), c, n = origin, np.cos(angle), np.sin(angle)
    end = (x - short, y + arm.side * touch.foot)
    shape = FilledShape("follower", (bar((0.0, 0.0), end, WIDTH * size),), "arm")
    placed = poses(arm.pivot + x * c - y * n, x * n + y * c, angle + 0.5 * math.pi * arm.side)
    return [
        MovingBody("arm", "follower", (shape,), poses(arm.pivot, 0.0, angle)),
        MovingBody(touch.name, "follower", touch.shapes, placed),
        pivot("pivot", arm.pivot, 0.0, size, "P", angle=0.0),
    ]


def contact_body(
    surface: Surface, name: str, size: float, roller_radius: float = 0.0, *, ahead: float = 0.0
) -> MovingBody:
    """Return the contact at each shaft angle, with an arrow in the direction of the push: inwards for a ring.

    The line of the follower stands `ahead` counter-clockwise of the x axis. The arrow is longer by `roller_radius`.
    """
    frame = surface.curve.sample(np.mod(SHAFT + ahead, TURN))
    back = np.exp(-1j * SHAFT)
    point, normal = ((row[:, 0] + 1j * row[:, 1]) * back for row in (frame.point, frame.normal))
    push = normal if surface.side > 0 else -normal
    direction = np.unwrap(np.angle(push))
    return contact(name, point.real, point.imag, direction, size, within=roller_radius)


def roller_frame(
    touches: tuple[Touch, Touch],
    x: Array,
    apart: float,
    hole: float,
    size: float,
    *,
    y: float = 0.0,
    facing: float = 0.0,
) -> list[MovingBody]:
    """Return a slotted frame with a touching part at x (n,) of a line at y, another `apart` behind it, and its guide.

    The slot clears a shaft of the radius `hole`. The second part is turned by `facing`.
    """
    first, second = touches
    # the slot clears the shaft over the whole travel; the frame is broad enough for it and for the stem
    inner = max(hole, 1.2 * size) + 0.6 * size
    width = 2.0 * (inner + abs(y) + HALF_STEM * size)
    slot = bar((-float(x.max()), 0.0 - y), (-float(x.min()), 0.0 - y), 2.0 * inner)
    frame = FilledShape("follower", (bar((-apart, 0.0), (0.0, 0.0), width), slot), "roller yoke")
    # the guide stands beyond the frame in its outermost place
    half, run = HALF_STEM * size, 4.5 * size
    beyond = max(first.ahead, 0.5 * width)
    start = float(x.max()) + beyond + size
    stem = FilledShape("follower", (box(0.5 * width, -half, start + run + 2.0 * size - float(x.min()), half),), "stem")
    moving = poses(x, y, 0.0)
    return [
        MovingBody("roller yoke", "follower", (frame, stem), moving),
        MovingBody(first.name, "follower", first.shapes, moving),
        MovingBody(second.name, "follower", second.shapes, poses(x - apart, y, facing)),
        guide(start, run, half, size, y),
    ]
