# needs: mechanism
"""Motions of bodies by formulas, of which clearances are known in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kin.mechanism.pose import PoseCourse
from kin.numeric.elementary import BallJet, Jet

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.numeric.arrays import Array

    Coordinate = Jet | BallJet | float


@dataclass(frozen=True, eq=False)
class Formula:
    """A motion by formulas: x, y and angle of the shaft angle, written with the functions of `kin.numeric.elementary`.

    `function` is called with a `Jet` and with a `BallJet` of the shaft angle; what it returns may be plain numbers
    where nothing moves. Its rates are enclosed by ball arithmetic.
    """

    function: Callable[[Jet | BallJet], tuple[Coordinate, Coordinate, Coordinate]]

    slack = (0.0, 0.0)

    def over(self, phi: Array, half: Array) -> PoseCourse:
        """Give the course over intervals; ValueError where the rates cannot be bounded."""
        point, stretch = Jet.variable(phi, 0), BallJet.variable(phi - half, phi + half, 1)
        columns = [c if isinstance(c, Jet) else point.constant(_number(c)) for c in self.function(point)]
        bounds = [
            (c if isinstance(c, BallJet) else stretch.constant(_number(c))).bounds() for c in self.function(stretch)
        ]
        low, high = (np.stack([b[side][1] for b in bounds], axis=1) for side in (0, 1))
        if not (np.isfinite(low).all() and np.isfinite(high).all()):
            raise ValueError(
                "the rates of a motion cannot be bounded over an interval: its formula may have a pole there"
            )
        return PoseCourse(np.stack([c.c[0] for c in columns], axis=1), 0.5 * (low + high), 0.5 * (high - low))


def _number(value: Coordinate) -> float:
    if isinstance(value, (Jet, BallJet)):
        raise TypeError("a coordinate of a motion is of another kind than its argument")
    return float(value)
