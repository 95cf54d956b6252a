"""Exact places over the shaft angle of what turns, slides and swings by itself; linkages have `linked_places`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.motions.position import Position
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class Turning:
    """The place of the cam and its shaft: turned clockwise by the shaft angle from the angle `start`."""

    start: float = 0.0

    def __call__(self, phi: Array, order: int) -> Array:
        """Give x, y and angle with their derivatives."""
        found = np.zeros((3, order + 1, len(phi)))
        found[2, 0] = self.start - phi
        if order:
            found[2, 1] = -1.0
        return found


def swinging(motion: Position, away: float) -> Place:
    """Give the place of an arm about a pivot `away` from the shaft, turned clockwise as the follower swings."""

    def place(phi: Array, order: int) -> Array:
        found = np.zeros((3, order + 1, len(phi)))
        found[0, 0] = away
        found[2] = -motion.travel(phi, order)
        return found

    return place


def lifted(motion: Position, foot: float = 0.0, y: float = 0.0) -> Place:
    """Give the place of a stem that moves along x on a line at y: its origin stands at `foot` at position 0."""

    def place(phi: Array, order: int) -> Array:
        found = np.zeros((3, order + 1, len(phi)))
        found[0] = motion.travel(phi, order)
        found[0, 0] += foot
        found[1, 0] = y
        return found

    return place


def swung(motion: Position, away: float, rest: float, side: int) -> Place:
    """Give the place of an arm about a pivot `away` from the shaft, its x from there to what touches the cam.

    `rest` is its angle to the line from pivot to shaft at displacement 0; `side` is +1 trailing, -1 leading.
    """

    def place(phi: Array, order: int) -> Array:
        found = np.zeros((3, order + 1, len(phi)))
        found[0, 0] = away
        found[2] = side * motion.travel(phi, order)
        found[2, 0] += math.pi + side * rest
        return found

    return place
