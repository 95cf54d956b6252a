"""Events of a made motion: where it passes a lift, how long it is above it, its greatest lift and velocity.

Lifts are counted from the follower's mean lowest position on the metal as it was made, since an indicator or the lash
is set there. An error E of the motion moves a crossing by -E/S', so that every event is, about where it is, a weighted
sum of errors: its uncertainty is that of the sum, whose parts go together (`Errors.influence`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.follower.base import IntendedMotion
    from kin.made.motion import Errors, Influence
    from kin.numeric.arrays import Array

STEPS = 40  # of Newton's method
STILL = 1e-12  # rad: the search ends at a smaller step
FAR = 0.5  # rad: a crossing farther from the intended one is not the same
RESTS = 1e-9  # of the stroke: within this of its lowest position the follower rests
NEIGHBOURS = np.arange(-1, 3)  # places of the errors between which they are interpolated


class Estimate(NamedTuple):
    """A figure of the made and of the intended motion, mm or rad, and the influence of errors on it."""

    made: float
    intended: float
    influence: Influence


class Above(NamedTuple):
    """A made motion above a lift: shaft angles, rad, at which it opens and closes, their difference and middle."""

    opening: Estimate
    closing: Estimate
    duration: Estimate
    centre: Estimate


@dataclass(frozen=True, eq=False)
class MadeMotion:
    """An intended motion, mm or rad over the shaft angle, and the errors of the made motion, at equal steps."""

    motion: IntendedMotion
    errors: Errors

    @property
    def _resting(self) -> Array:
        """Weights (n,) of the mean error where the follower is at its lowest."""
        position = self.errors.intended[0]
        rests = position - position.min() <= RESTS * max(float(np.ptp(position)), np.finfo(float).tiny)
        weights: Array = rests / rests.sum()
        return weights

    def _weights(self, angle: float) -> tuple[Array, float]:
        """Weights (n,) of the error at a shaft angle less that at rest, and the error's derivative there, by rad."""
        count = len(self.errors.shaft)
        step = TURN / count
        place = (angle - self.errors.shaft[0]) / step
        first = int(np.floor(place))
        u = place - first
        a, b, c, d = u + 1.0, u, u - 1.0, u - 2.0  # Lagrange's cubic through four neighbours
        values = np.array([-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0])
        index = (first + NEIGHBOURS) % count
        weights = -self._resting
        np.add.at(weights, index, values)
        rate = float(self.errors.rows[1][index] @ values)
        return weights, rate

    def _intended(self, angle: float) -> tuple[float, float]:
        """Intended position, mm or rad, and velocity by rad of the shaft, at a shaft angle, rad."""
        position, velocity, *_ = self.motion.derivatives(np.array([np.mod(angle, TURN)]), 1)[:, 0].tolist()
        return position, velocity

    def above(self, opening: float, closing: float) -> Above | None:
        """Opening, closing, duration and centre of the made motion above a lift; None where it does not pass that lift.

        The intended motion has this lift at the shaft angles `opening` and `closing`, rad, `closing` the greater.
        """
        places, sums = [], []
        for angle in (opening, closing):
            crossed = self._crossing(angle)
            if crossed is None:
                return None
            places.append(crossed[0])
            sums.append(crossed[1])
        (made_o, made_c), (first, last) = places, sums
        influence = self.errors.influence
        return Above(
            Estimate(made_o, opening, influence(first)),
            Estimate(made_c, closing, influence(last)),
            Estimate(made_c - made_o, closing - opening, influence(last - first)),
            Estimate(0.5 * (made_o + made_c), 0.5 * (opening + closing), influence(0.5 * (first + last))),
        )

    def _crossing(self, nominal: float) -> tuple[float, Array] | None:
        """Shaft angle, rad, of the made motion at the lift that the intended one has at `nominal`, and weights (n,).

        The weights are those of the errors in the angle. None where no crossing is found near.
        """
        level, _ = self._intended(nominal)
        angle = nominal
        for _ in range(STEPS):
            position, velocity = self._intended(angle)
            weights, rate = self._weights(angle)
            slope = velocity + rate
            if not abs(slope) > 0.0:
                return None
            step = (position + float(weights @ self.errors.rows[0]) - level) / slope
            angle -= step
            if not abs(angle - nominal) < FAR:
                return None
            if abs(step) < STILL:
                return angle, -weights / slope
        return None

    def highest(self, place: float) -> Estimate:
        """Estimate of the greatest lift, mm or rad; `place`, rad of shaft, is where the intended motion has it."""
        weights, _ = self._weights(place)
        intended = self._intended(place)[0] - float(self.errors.intended[0].min())
        return Estimate(intended + float(weights @ self.errors.rows[0]), intended, self.errors.influence(weights))

    @property
    def lifts(self) -> tuple[Array, Array]:
        """Lift, mm or rad, velocity and acceleration by rad of the shaft, as made and as intended, (3, n) each.

        They are at the shaft angles of the errors. The acceleration as made is nan about breaks of the motion.
        """
        intended = self.errors.intended.copy()
        intended[0] -= intended[0].min()
        made = intended + self.errors.rows
        made[0] -= float(self._resting @ self.errors.rows[0])
        return made, intended
