"""Where the parts of a motion meet, and which of its derivatives jump there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.lengths import Words, input_words
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable

    from kin.numeric.arrays import Array

ORDERS = 3  # displacement, velocity, acceleration and jerk are compared at the joints
_JOIN = 1e-9  # of the greatest value of a derivative: a jump below this is rounding
_NAMES = ("S", "S'", "S''", "S'''")


@dataclass(frozen=True)
class DerivativeJump:
    """An angle `at`, rad, at which derivatives jump; of each that jumps (order, limit before, limit after)."""

    at: float
    jumps: tuple[tuple[int, float, float], ...]

    def said(self, unit: str = "mm", per: str = "rad") -> str:
        """Marked words for the jumps, lowest derivative first: limits in `unit`, over `per` of the input, and place."""
        units = (unit, f"{unit}/{per}", f"{unit}/{per}^2", f"{unit}/{per}^3")
        parts = [f"{_NAMES[k]} jumps from {a:.6g} to {b:.6g} {units[k]}" for k, a, b in self.jumps]
        return Words(f"{' and '.join(parts)} at {input_words(self.at)}")

    def scaled(self, by: float) -> DerivativeJump:
        """The jump with displacements multiplied by `by`, as for another unit."""
        return DerivativeJump(self.at, tuple((k, a * by, b * by) for k, a, b in self.jumps))


def joints_of(meetings: Iterable[tuple[float, Array, Array]], size: Array) -> tuple[DerivativeJump, ...]:
    """Give the jumps among meetings, each an angle, rad, and the derivatives 0 to 3 before and after it, (4,) each.

    `size` (4,) is the greatest absolute value of each derivative: a jump below 1e-9 of it is rounding.
    """

    def without_rounding(value: Array, k: int) -> float:
        return float(value[k]) if abs(value[k]) > _JOIN * size[k] else 0.0  # a value that is rounding alone is 0

    joints = []
    for at, before, after in meetings:
        jumps = np.flatnonzero(np.abs(after - before) > _JOIN * size)
        if len(jumps):
            limits = ((k, without_rounding(before, k), without_rounding(after, k)) for k in jumps.tolist())
            joints.append(DerivativeJump(at, tuple(limits)))
    return tuple(joints)
