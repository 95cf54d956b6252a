"""Flat faces on an arm: a pair of them that swings about one pivot.

The errors below are extremes over all shaft angles, found stretch by stretch between the breaks of the contour's
support function and those of the intent.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.follower.base import Closure, Contact, Follower, Rests, Swing
from kin.follower.drive import OfPair
from kin.follower.envelope import FlatEnvelope, Outset, PairSupport
from kin.follower.guide import LEADING, TRAILING, Arm
from kin.follower.motion_error import ContactError, Judged, Play, motion_error, with_steps
from kin.follower.projection import FINE_STEP, across, grid
from kin.follower.rests import dwell_angles, dwells_of_transmission
from kin.follower.support import Bearing, bearing_of
from kin.numeric.angles import TURN, degrees
from kin.numeric.distinct import distinct
from kin.numeric.errors import UnsettledError
from kin.numeric.extrema import Extremes, extremes
from kin.numeric.newton import zeros

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array, Indices

RESOLUTION_ANGLE = 1e-13  # rad
MOST_STEPS = 60
BESIDE = 1e-12  # rad: so near to a break the derivatives may be those of its other side, by rounding
SETTLED = 1e-8  # rad: after a Newton step below this the next is lost in rounding, also where f'' jumps


@dataclass(frozen=True, eq=False)
class FlatPair(Follower):
    """W's pair of flat faces that include pi - alpha and meet in a pivot at distance 2 l from the shaft (W section 5).

    The pair swings by psi/2; the normal of face A stands at t, that of face B at t + alpha, in the cam frame. Positions
    are swings in radians, clockwise positive; error figures are in degrees. Faces that stand `face` mm farther out pass
    the pivot at that distance, and their cam is the parallel curve.
    """

    transmission: Transmission
    face: float = 0.0

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Face A, which keeps the swing below, and face B."""
        arm = self.transmission.arm
        return Contact(Arm(arm, self._pivot, TRAILING), TRAILING), Contact(Arm(arm, self._pivot, LEADING), LEADING)

    @cached_property
    def motion(self) -> Swing:
        """Half of psi over the shaft angle."""
        return Swing(self.transmission, 0.5)

    @property
    def rests(self) -> Rests:
        """Dwells of psi."""
        return tuple(dwells_of_transmission(self.transmission))

    @property
    def closure(self) -> Closure:
        """The angle by which the faces stand wider than they need."""
        return Closure(self.play_limit)

    @cached_property
    def support(self) -> PairSupport:
        """Distance of the lines through the pivot along the faces: that of the exact contour, less `face`."""
        return PairSupport(self.transmission)

    @cached_property
    def envelope(self) -> FlatEnvelope:
        """The exact contour; its parameter is the direction of face A's normal."""
        return FlatEnvelope(Outset(self.support, self.face) if self.face else self.support)

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle at which face A touches the envelope's point of that parameter (n,)."""
        phi: Array = _shaft(parameter, self.support.derivatives(parameter, 0), self._pivot, 1.0)[0]
        return phi

    def contact(self, contour: Contour, phi: Array) -> Array:
        """Swing, radians (2, n): with face A resting on the contour, and with face B.

        ContactError if the contour reaches the pivot.
        """
        return self._swings(self.held(contour), phi)

    def drives(self, contour: Contour) -> list[OfPair]:
        """Swing of each face away from the cam, as it rests on the contour. ContactError if that reaches the pivot."""
        bearing = self.held(contour)
        return [OfPair(self, bearing, side) for side in (1, -1)]

    def _swings(self, bearing: Bearing, phi: Array) -> Array:
        half = 0.5 * self.transmission.alpha
        return np.stack([phi - side * half - self.touch(bearing, phi, side)[0] for side in (1, -1)])

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error of either face and the play between them; extremes over the whole turn."""
        bearing = self.held(contour)
        found = [self._error_extremes(bearing, side) for side in (1, -1)]
        worst = max((extreme.worst for extreme in found), key=lambda pair: pair[0])
        angle = with_steps(phi)
        errors = self._swings(bearing, angle) - self.intended(angle)
        flatness = [float(np.ptp(self._swings(bearing, x), axis=1).max()) for x in dwell_angles(self.rests, phi)]
        return Judged(motion_error(worst, errors, max(flatness, default=None), "deg"), self._play(bearing))

    def motion_limit(self, tolerance: float) -> float:
        """Greatest swing, degrees, that a shift of the contour by `tolerance` gives a face.

        That is e over the distance from pivot to contact, the largest over the turn, and the term of second order.
        """
        return float(np.degrees(max(self._leeway(tolerance, side)[1].max() for side in (1.0, -1.0))))

    def play_limit(self, tolerance: float) -> float:
        """Greatest play, degrees, from such shifts at both faces."""
        theta, near = self._leeway(tolerance, 1.0)
        _, far = self._leeway(tolerance, -1.0, theta + self.transmission.alpha)
        return float(np.degrees((near + far).max()))

    @property
    def _pivot(self) -> float:
        return 2.0 * self.transmission.arm

    def _leeway(self, tolerance: float, side: float, theta: Array | None = None) -> tuple[Array, Array]:
        theta = grid(self.support.breaks) if theta is None else theta
        r, slope, bend = self.support.derivatives(theta, 2)
        distance = np.sqrt(self._pivot**2 - r * r) - side * slope
        if (distance <= 0.0).any():
            raise ContactError("the intended contact reaches the pivot", float(theta[int(np.argmin(distance))]))
        first: Array = tolerance / distance
        return theta, first + 0.5 * np.abs(r + bend) / distance * first**2

    def held(self, contour: Contour) -> Bearing:
        """Where a contour bears all round; ContactError if it reaches the pivot."""
        bearing = replace(bearing_of(contour), back=self.face)
        q = bearing.derivatives(bearing.breaks, np.arange(len(bearing.breaks)))
        out = np.hypot(q[0], q[1]) >= self._pivot
        if out.any():
            raise ContactError("the contour reaches the pivot", float(bearing.breaks[int(np.argmax(out))]))
        return bearing

    def starts(self, bearing: Bearing, side: int) -> Array:
        """Shaft angle at which each stretch of the contour begins to bear on the face of that side, rising (m,).

        phi = theta + side acos(q/2l) rises with theta as long as the contour stays within the pivot's circle.
        """
        q = bearing.derivatives(bearing.breaks, np.arange(len(bearing.breaks)))
        start: Array = _shaft(bearing.breaks, q, self._pivot, side)[0]
        return start

    def touch(self, bearing: Bearing, phi: Array, side: int, middle: Array | None = None) -> Array:
        """Face normal theta and its two derivatives by phi (3, n), for the face of that side held in contact.

        `middle` (n,) are shaft angles that tell which stretch is meant where phi is the end of one.
        """
        start = self.starts(bearing, side)
        turns = np.floor(((phi if middle is None else middle) - start[0]) / TURN)
        reduced = phi - turns * TURN
        within = np.maximum(reduced if middle is None else middle - turns * TURN, start[0])
        stretch = np.searchsorted(start, within, side="right") - 1
        low = bearing.breaks[stretch]
        high = np.append(bearing.breaks[1:], bearing.breaks[0] + TURN)[stretch]
        width = np.diff(start, append=start[0] + TURN)[stretch]
        share = np.where(width > 0.0, (reduced - start[stretch]) / np.where(width > 0.0, width, 1.0), 0.0)
        theta = low + np.clip(share, 0.0, 1.0) * (high - low)

        def shaft(theta: Array) -> Array:
            return _shaft(theta, bearing.derivatives(theta, stretch), self._pivot, side)

        def over(theta: Array) -> tuple[Array, Array]:
            value, slope, _ = shaft(theta)
            return value - reduced, slope

        theta = zeros(over, low, high, theta, SETTLED)
        _, slope, bend = shaft(theta)
        return np.stack([theta + turns * TURN, 1.0 / slope, -bend / slope**3])

    def _error_extremes(self, bearing: Bearing, side: int) -> Extremes:
        """Extremes of the swing error with the face of that side in contact; found over theta, told over phi.

        At face normal theta the measured shaft angle is phi_q(theta); intended is the normal t with phi_r(t) = phi_q,
        and the swing is off by t - theta.
        """
        nodes = bearing.nodes(0.0, TURN, self.support.breaks)
        stretch, q_low, q_high = bearing.between(nodes)

        def intended(theta: Array) -> Array:
            return _shaft(theta, self.support.derivatives(theta, 2), self._pivot, side)

        def error(theta: Array, q: Array, there: Array) -> Array:
            value, slope, bend = _shaft(theta, q, self._pivot, side)
            t, step, there = theta.copy(), np.empty_like(theta), there.copy()
            todo = np.arange(len(theta))
            for _ in range(MOST_STEPS):
                first = (value[todo] - there[0, todo]) / there[1, todo]
                step[todo] = first - 0.5 * there[2, todo] / there[1, todo] * first * first
                size = np.abs(step[todo])
                beside = np.copysign(BESIDE, step[todo])
                beyond = across(self.support.breaks, t[todo] - beside, step[todo] + 2.0 * beside) & (size > SETTLED)
                todo = todo[(size > FINE_STEP) | beyond]
                if not len(todo):
                    break
                t[todo] += np.clip(step[todo], -0.2, 0.2)
                there[:, todo] = intended(t[todo])
            else:
                left = float(np.abs(step[todo]).max())
                raise UnsettledError(f"a normal was not found in {MOST_STEPS} steps; {left:.3g} rad are left")
            rate = slope / (there[1] + there[2] * step)
            return np.stack([t - theta + step, rate - 1.0, (bend - there[2] * rate**2) / there[1]])

        def inside(theta: Array, of: Indices) -> Array:
            return error(theta, bearing.derivatives(theta, stretch[of]), intended(theta))

        there, low, high = intended(nodes), nodes[:-1], nodes[1:]
        at_low, at_high = error(low, q_low, there[:, :-1]), error(high, q_high, there[:, 1:])
        fine = RESOLUTION_ANGLE + 4.0 * self.transmission.rounding / self.transmission.arm
        found = extremes(low, high, at_low, at_high, inside, resolution=fine)

        def shaft(theta: float) -> float:
            at = np.array([theta])
            return float(_shaft(at, bearing.derivatives(at, bearing.find(at))[:1], self._pivot, side)[0, 0])

        return replace(found, greatest_at=shaft(found.greatest_at), least_at=shaft(found.least_at))

    def _play(self, bearing: Bearing) -> Play:
        ends = np.concatenate([self.starts(bearing, side) for side in (1, -1)])
        nodes = distinct(np.concatenate([[0.0], np.mod(ends, TURN), [TURN]]))
        low, high = nodes[:-1], nodes[1:]
        middle = 0.5 * (low + high)

        def play(phi: Array, of: Indices) -> Array:
            wide = self.touch(bearing, phi, -1, middle[of]) - self.touch(bearing, phi, 1, middle[of])
            wide[0] -= self.transmission.alpha
            return wide

        every = np.arange(len(low))
        found = extremes(low, high, play(low, every), play(high, every), play, resolution=RESOLUTION_ANGLE)
        return Play(
            float(np.degrees(found.least)),
            degrees(found.least_at),
            float(np.degrees(found.greatest)),
            degrees(found.greatest_at),
            "deg",
        )


def _shaft(theta: Array, q: Array, pivot: float, side: float) -> Array:
    """Shaft angle phi = theta + side acos(q/pivot) and derivatives by theta, (k, n), from q and its own (k, n)."""
    w = q / pivot
    sine = np.sqrt((1.0 - w[0]) * (1.0 + w[0]))
    rows = [theta + side * np.arctan2(sine, w[0])]
    if len(q) > 1:
        rows.append(1.0 - side * w[1] / sine)
        rows.append(-side * (w[2] * sine * sine + w[0] * w[1] * w[1]) / sine**3)
    return np.stack(rows)
