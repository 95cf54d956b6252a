"""Exact places over the shaft angle: of bodies that turn, slide or swing, and of the links of a linkage.

A place is a function of shaft angles (n,), rad, and an order. It gives x, y and angle of a body's axes with derivatives
by the shaft angle up to the order, (3, order + 1, n), mm and rad, for a shaft that turns clockwise.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.motions.position import Position
    from kin.linkage.chain import Solved
    from kin.linkage.links import Link
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class Turning:
    """Place of the cam and its shaft: turned clockwise by the shaft angle from the angle `start`, rad."""

    start: float = 0.0

    def __call__(self, phi: Array, order: int) -> Array:
        """x, y and angle with derivatives up to `order`, (3, order + 1, n), at shaft angles phi (n,), rad."""
        rows = np.zeros((3, order + 1, len(phi)))
        rows[2, 0] = self.start - phi
        if order:
            rows[2, 1] = -1.0
        return rows


def rocking_place(motion: Position, pivot: float) -> Place:
    """Place of an arm about a pivot at x = `pivot`, mm, that turns clockwise by the position of the motion, rad."""

    def place(phi: Array, order: int) -> Array:
        rows = np.zeros((3, order + 1, len(phi)))
        rows[0, 0] = pivot
        rows[2] = -motion.travel(phi, order)
        return rows

    return place


def stem_place(motion: Position, start: float = 0.0, y: float = 0.0) -> Place:
    """Place of a stem that moves along x on a line at `y`, mm; its origin is at x = `start` at position 0."""

    def place(phi: Array, order: int) -> Array:
        rows = np.zeros((3, order + 1, len(phi)))
        rows[0] = motion.travel(phi, order)
        rows[0, 0] += start
        rows[1, 0] = y
        return rows

    return place


def arm_place(motion: Position, pivot: float, rest: float, side: int) -> Place:
    """Place of an arm about a pivot at x = `pivot`, mm, with its x axis towards the contact.

    `rest` is the angle, rad, between the arm at position 0 and the line from pivot to shaft; `side` is 1 for a trailing
    arm, -1 for a leading one.
    """

    def place(phi: Array, order: int) -> Array:
        rows = np.zeros((3, order + 1, len(phi)))
        rows[0, 0] = pivot
        rows[2] = side * motion.travel(phi, order)
        rows[2, 0] += math.pi + side * rest
        return rows

    return place


@dataclass(frozen=True, eq=False)
class Links:
    """Places of the links of a mechanism that turns right round; loop 0 is the linkage's, loop k the k-th dyad's."""

    mechanism: Mechanism

    def place(self, pose: Callable[[Solved], Link]) -> Place:
        """Place of the axes of the link that `pose` picks from the solved positions; angle 0 for a point."""
        mechanism = self.mechanism

        def place(phi: Array, order: int) -> Array:
            motion = mechanism.at(mechanism.relative(phi), order)
            link = pose(motion.solved)
            x, y = link.origin
            angle = x.constant(0.0) if link.direction is None else link.direction
            rows: Array = np.stack([motion.over_shaft(row.derivatives()) for row in (x, y, angle)])
            return rows

        return place

    def frame(self) -> Place:
        """Place of the square frame: origin in its middle, x along u(theta_3)."""
        return self.place(self.mechanism.chain.frame)

    def output(self, loop: int) -> Place:
        """Place of the link that a loop drives."""
        return self.place(self.mechanism.chain.output(loop).pose)

    def rod(self, loop: int) -> Place:
        """Place of the bar PQ of the dyad of a loop, from 1: origin P, x towards Q."""
        return self.place(lambda solved: self.mechanism.chain.rod(solved, loop - 1))

    def joint(self, loop: int, name: str) -> Place:
        """Place of the joint `name` of a loop, such as D, P or Q: x along the line on which its block slides."""
        return self.place(lambda solved: self.mechanism.chain.joints(solved, loop)[name].place)
