"""Where the parts of a motion meet, and which of its derivatives jump there."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from kin.numeric.arrays import Array

ORDERS = 3  # displacement, velocity, acceleration and jerk are held together at the joints
_JOIN = 1e-9  # of the greatest value of a derivative: a jump below this is rounding
_NAMES = ("S", "S'", "S''", "S'''")


@dataclass(frozen=True)
class DerivativeJump:
    """An angle (rad) at which derivatives jump: for each that does its order, and the limits before and after."""

    at: float
    jumps: tuple[tuple[int, float, float], ...]

    def said(self, unit: str = "mm") -> str:
        """Say what jumps, lowest derivative first, by how much, and where."""
        per = ("", "/rad", "/rad^2", "/rad^3")
        parts = [f"{_NAMES[k]} jumps from {a:.6g} to {b:.6g} {unit}{per[k]}" for k, a, b in self.jumps]
        return f"{' and '.join(parts)} at {math.degrees(self.at):.6g} degrees"

    def scaled(self, by: float) -> DerivativeJump:
        """The joint with displacements times `by`: in another unit."""
        return DerivativeJump(self.at, tuple((k, a * by, b * by) for k, a, b in self.jumps))


def joints_of(meetings: Iterable[tuple[float, Array, Array]], size: Array) -> tuple[DerivativeJump, ...]:
    """Give the joints among angles (rad) with the derivatives 0 to `ORDERS` before and after each, (ORDERS + 1,).

    `size` has the greatest value of each derivative.
    """

    def without_rounding(value: Array, k: int) -> float:
        return float(value[k]) if abs(value[k]) > _JOIN * size[k] else 0.0  # what rounding leaves of a rest is 0

    joints = []
    for at, before, after in meetings:
        jumps = np.flatnonzero(np.abs(after - before) > _JOIN * size)
        if len(jumps):
            limits = ((k, without_rounding(before, k), without_rounding(after, k)) for k in jumps.tolist())
            joints.append(DerivativeJump(at, tuple(limits)))
    return tuple(joints)
