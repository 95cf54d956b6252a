"""A mechanism as bodies to be drawn: each has its shapes in its own axes, and its place over its input, such as a turn.

This module is independent of cams and followers. A page moves the bodies, a picture draws them once, of the same
shapes.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.curve.ring import Ring, box, disc
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

STEPS = 720  # places of a turn; between them a page interpolates
CONTACTS = "contacts"  # the kind of bodies that show where the cam is touched, and its normal
OVERLAYS = "overlays"  # the kind of bodies that a recipe asks for beside the mechanism
SEEN = 24  # a body's extent is taken from every so many places


@dataclass(frozen=True, eq=False)
class FilledShape:
    """Rings filled together by the even-odd rule; `role` is a word of `looks.LOOKS`, by which the shape is coloured."""

    role: str
    rings: tuple[Ring, ...]
    name: str = ""


@dataclass(frozen=True, eq=False)
class Letter:
    """A letter beside a point (x, y) of a body."""

    text: str
    x: float
    y: float


@dataclass(frozen=True, eq=False)
class MovingBody:
    """Shapes that move as one: `pose` (STEPS + 1, 3), or (1, 3) of a fixed body, has x, y and angle, rad.

    `kind` groups bodies that a page shows and hides together. The shapes of an `upright` body are not mirrored with the
    scene, only its place.
    """

    name: str
    kind: str
    shapes: tuple[FilledShape, ...]
    pose: Array
    labels: tuple[Letter, ...] = ()
    upright: bool = False

    def at(self, step: int) -> tuple[float, float, float]:
        """Return x, y and angle, rad, at a step of the turn, 0 to STEPS."""
        x, y, angle = self.pose[step if len(self.pose) > 1 else 0].tolist()
        return x, y, angle

    def placed(self, points: Array, step: int) -> Array:
        """Return points (n, 2) of the body's own axes in the scene's axes at a step."""
        x, y, angle = self.at(step)
        c, s = math.cos(angle), math.sin(angle)
        placed: Array = points @ np.array([[c, s], [-s, c]]) + (x, y)
        return placed


class SceneInput(NamedTuple):
    """Input over which bodies move, from 0 to `most` in `unit`: a turn, or a travel to and fro.

    `name` and `noun` are words for it, `key` names it in the page's address, `pace` is the unit of its speed. After a
    `closed` input the bodies stand where they began, and go on.
    """

    name: str
    noun: str
    unit: str
    most: float
    closed: bool
    key: str
    pace: str


SHAFT = SceneInput("shaft angle", "shaft", "°", 360, closed=True, key="deg", pace="rpm")


@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies from the hindmost to the foremost, in mm until they are scaled, and a note below the drawing.

    The poses of the bodies are at equal steps of `input_`.
    """

    bodies: tuple[MovingBody, ...]
    note: str = ""
    input_: SceneInput = SHAFT

    def step_at(self, at: float) -> int:
        """Return the step nearest to a place of the input, in its unit."""
        return round(at / self.input_.most * STEPS)

    def scaled(self, factor: float) -> Scene:
        """Return the scene with all lengths times `factor`, for another unit."""
        return replace(self, bodies=tuple(_enlarged(body, factor) for body in self.bodies))

    def mirrored(self) -> Scene:
        """Scene mirrored about the x axis: the same mechanism with a shaft that turns the other way."""
        return replace(self, bodies=tuple(map(_reflected, self.bodies)))

    @cached_property
    def box(self) -> tuple[float, float, float, float]:
        """Least x and y and greatest x and y of all bodies but the forces over the turn, with a margin of 3 %.

        They are in the scene's unit of length; every `SEEN`-th pose of the turn is looked at.
        """
        low, high = np.full(2, np.inf), np.full(2, -np.inf)
        for body in self.bodies:
            if body.kind == "forces":
                continue  # their lines reach far beyond the mechanism
            u, v = np.concatenate([ring.flattened() for shape in body.shapes for ring in shape.rings]).T
            x, y, angle = body.pose[::SEEN].T[:, :, None]
            c, s = np.cos(angle), np.sin(angle)
            placed = u * c - v * s + x, u * s + v * c + y
            low = np.minimum(low, [part.min() for part in placed])
            high = np.maximum(high, [part.max() for part in placed])
        margin = 0.03 * float((high - low).max())
        return (*(low - margin).tolist(), *(high + margin).tolist())

    @property
    def digits(self) -> int:
        """Decimal digits that a coordinate needs for a drawing: a hundred-thousandth of its size."""
        x0, y0, x1, y1 = self.box
        return digits_for(max(x1 - x0, y1 - y0), 1e-5)


def digits_for(extent: float, share: float) -> int:
    """Decimal digits after the point that a share of an extent needs; at least 0."""
    return max(0, math.ceil(-math.log10(extent * share))) if extent > 0.0 else 0


def _enlarged(body: MovingBody, factor: float) -> MovingBody:
    shapes = tuple(replace(s, rings=tuple(ring.scaled(factor) for ring in s.rings)) for s in body.shapes)
    labels = tuple(replace(label, x=label.x * factor, y=label.y * factor) for label in body.labels)
    return replace(body, shapes=shapes, pose=body.pose * np.array([factor, factor, 1.0]), labels=labels)


def _reflected(body: MovingBody) -> MovingBody:
    pose = body.pose * np.array([1.0, -1.0, -1.0])
    if body.upright:
        return replace(body, pose=pose)
    shapes = tuple(replace(s, rings=tuple(ring.mirrored() for ring in s.rings)) for s in body.shapes)
    labels = tuple(replace(label, y=-label.y) for label in body.labels)
    return replace(body, shapes=shapes, pose=pose, labels=labels)


# --- parts of mechanisms ----------------------------------------------------------------------------------------------


def still(x: float = 0.0, y: float = 0.0, angle: float = 0.0) -> Array:
    """Return the pose (1, 3) of a body that does not move: x, y and angle, rad."""
    return np.array([[x, y, angle]])


def poses(x: Array | float, y: Array | float, angle: Array | float) -> Array:
    """Return poses (n, 3) of x, y and angle, each (n,) or constant."""
    return np.column_stack(np.broadcast_arrays(x, y, angle)).astype(np.float64)


def block(length: float, height: float, name: str = "") -> FilledShape:
    """Return a sliding block about its origin, `length` along x and `height` along y."""
    return FilledShape("block", (box(-0.5 * length, -0.5 * height, 0.5 * length, 0.5 * height),), name)


def pivot(name: str, x: float, y: float, size: float, letter: str = "", *, angle: float = -0.5 * math.pi) -> MovingBody:
    """Fixed pivot at (x, y), mm: a pin on a hatched foot that points in the direction `angle`, rad.

    `size`, mm, scales the symbol; `letter` stands beside it.
    """
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    foot = np.array([(0.0, 0.0), (1.9, -1.2), (1.9, 1.2)]) * size @ turn
    lines = [np.array([(1.9, -1.6), (1.9, 1.6)])]
    lines += [np.array([(1.9, y), (2.5, y - 0.6)]) for y in (-1.0, -0.2, 0.6, 1.4)]
    hatch = tuple(Ring.through(line * size @ turn, closed=False) for line in lines)
    shapes = (FilledShape("foot", (Ring.through(foot),)), FilledShape("hatch", hatch), pin(size))
    letters = (Letter(letter, 0.0, 0.0),) if letter else ()
    return MovingBody(name, "ground", shapes, still(x, y), letters, upright=True)


def pin(size: float, x: float = 0.0, y: float = 0.0) -> FilledShape:
    """Return the pin of a revolute joint at (x, y), a disc scaled by `size`."""
    return FilledShape("pin", (disc(x, y, 0.55 * size),))


def arrow(length: float, size: float, role: str = "force") -> tuple[FilledShape, ...]:
    """Return line, tip and foot dot of an arrow from the origin along x, `length` mm long.

    `size`, mm, scales tip and dot as it scales a joint.
    """
    head, half = 1.6 * size, 0.62 * size
    tip = Ring.through([(length, 0.0), (length - head, half), (length - head, -half)])
    shaft = Ring.through([(0.0, 0.0), (length - head, 0.0)], closed=False)
    return (
        FilledShape(role, (shaft,)),
        FilledShape(f"{role} tip", (tip,)),
        FilledShape(f"{role} dot", (disc(0.0, 0.0, 0.42 * size),)),
    )
