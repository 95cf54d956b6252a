"""Flat faces on an arm: a single one, and a pair of them that swings about one pivot.

A face at distance f within the line through the pivot C that is parallel to it touches a contour of support function q
at its normal t where q(t) + f = C cos(t - phi): on either side of the pivot at one shaft angle phi.

The errors below are extremes over all shaft angles, found stretch by stretch between the breaks of the contour's
support function and those of the intent.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kin.follower.base import Closure, OfLaw, OfTransmission
from kin.follower.drive import OfArmFace
from kin.follower.envelope import FacePitch, FlatEnvelope, Outset, PairSupport
from kin.follower.motion_error import ContactError, Judged, Play, motion_error, with_steps
from kin.follower.projection import FINE_STEP, across, grid
from kin.follower.rests import dwell_angles
from kin.follower.support import Bearing, bearing_of
from kin.law.contacts import Flat, Oscillating
from kin.numeric.angles import TURN, degrees
from kin.numeric.distinct import distinct
from kin.numeric.errors import UnsettledError
from kin.numeric.extrema import Extremes, extremes
from kin.numeric.newton import zeros

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.follower.envelope import SupportLaw
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.numeric.arrays import Array, Indices

RESOLUTION_ANGLE = 1e-13  # rad
MOST_STEPS = 60
BESIDE = 1e-12  # rad: so near to a break the derivatives may be those of its other side, by rounding
SETTLED = 1e-8  # rad: after a Newton step below this the next is lost in rounding, also where f'' jumps


@dataclass(frozen=True)
class ArmFace:
    """A flat face on an arm, its pivot at the distance `pivot` from the shaft, mm, its normal at t in the cam frame.

    It stands `out` mm farther out than the line through the pivot that is parallel to it. `side` is 1 where the face
    trails the pivot, phi = t + acos(q/pivot), and -1 where it leads it.
    """

    pivot: float
    side: Side
    out: float = 0.0

    @staticmethod
    def of(contact: Contact[Guide, Touch]) -> ArmFace:
        """Take the face of a contact's record."""
        if not (isinstance(contact.guide, Oscillating) and isinstance(contact.touch, Flat)):
            raise TypeError("a flat face on an arm has a pivot")
        return ArmFace(contact.guide.pivot, contact.guide.side, -contact.touch.nearer)

    def bearing(self, contour: Contour) -> Bearing:
        """Where a contour bears all round; ContactError if the face's contact reaches the pivot."""
        bearing = replace(bearing_of(contour), back=self.out)
        nodes = np.append(bearing.breaks, bearing.breaks[:1] + TURN)
        _, *ends = bearing.between(nodes)
        for at, q in zip((nodes[:-1], nodes[1:]), ends, strict=True):
            square = self.pivot**2 - q[0] ** 2
            out = ~((square > 0.0) & (np.sqrt(np.maximum(square, 0.0)) > self.side * q[1]))
            if out.any():
                raise ContactError("the contour reaches the pivot", float(at[int(np.argmax(out))]))
        return bearing

    def shaft(self, theta: Array, q: Array) -> Array:
        """Shaft angle and derivatives by the normal's direction theta, (k, n), from q less `out` and its own (k, n)."""
        w = q / self.pivot
        sine = np.sqrt((1.0 - w[0]) * (1.0 + w[0]))
        rows = [theta + self.side * np.arctan2(sine, w[0])]
        if len(q) > 1:
            rows.append(1.0 - self.side * w[1] / sine)
            rows.append(-self.side * (w[2] * sine * sine + w[0] * w[1] * w[1]) / sine**3)
        return np.stack(rows)

    def starts(self, bearing: Bearing) -> Array:
        """Shaft angle at which each stretch of the contour begins to bear on the face, rising (m,).

        It rises with theta as long as the contact stays on its side of the pivot.
        """
        q = bearing.derivatives(bearing.breaks, np.arange(len(bearing.breaks)))
        start: Array = self.shaft(bearing.breaks, q)[0]
        return start

    def touch(self, bearing: Bearing, phi: Array, middle: Array | None = None) -> Array:
        """Face normal theta and its two derivatives by phi (3, n), for the face held in contact.

        `middle` (n,) are shaft angles that tell which stretch is meant where phi is the end of one.
        """
        start = self.starts(bearing)
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
            return self.shaft(theta, bearing.derivatives(theta, stretch))

        def over(theta: Array) -> tuple[Array, Array]:
            value, slope, _ = shaft(theta)
            return value - reduced, slope

        theta = zeros(over, low, high, theta, SETTLED)
        _, slope, bend = shaft(theta)
        return np.stack([theta + turns * TURN, 1.0 / slope, -bend / slope**3])

    def leeway(self, support: SupportLaw, tolerance: float, theta: Array) -> Array:
        """Swing, radians (n,), that a shift of a contour by `tolerance` gives the face, to second order.

        `support` is the contour's less `out`. That is e over the distance from pivot to contact, and the next term.
        """
        r, slope, bend = support.derivatives(theta, 2)
        distance = np.sqrt(self.pivot**2 - r * r) - self.side * slope
        if (distance <= 0.0).any():
            raise ContactError("the intended contact reaches the pivot", float(theta[int(np.argmin(distance))]))
        first = tolerance / distance
        swing: Array = first + 0.5 * np.abs(r + bend) / distance * first**2
        return swing


@dataclass(frozen=True, eq=False)
class SwingingFace(OfLaw):
    """A flat face on an arm about a pivot at distance C from the shaft, f mm nearer the cam than its parallel.

    Its position, of which `law` is the intended one over the shaft angle, is the angle psi between the face and the
    line from pivot to shaft, radians, which grows as the face is lifted: its distance from the shaft is C sin psi - f.
    """

    @cached_property
    def face(self) -> ArmFace:
        """The face."""
        return ArmFace.of(self.contacts[0])

    @property
    def lever(self) -> float:
        """How far from the pivot the face is touched at the shaft's zero, about."""
        return self.face.pivot * float(np.cos(self.intended(np.zeros(1))[0]))

    @cached_property
    def support(self) -> PairSupport:
        """Distance of the line through the pivot along the face: that of the exact contour, and f."""
        return PairSupport(FacePitch(self.law, self.face.pivot, self.face.side))

    @cached_property
    def envelope(self) -> FlatEnvelope:
        """The exact contour; its parameter is the direction of the face's normal."""
        return FlatEnvelope(Outset(self.support, self.face.out))

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle at which the face touches the envelope's point of that parameter (n,)."""
        phi: Array = self.face.shaft(parameter, self.support.derivatives(parameter, 0))[0]
        return phi

    def contact(self, contour: Contour, phi: Array) -> Array:
        """Angle psi, radians (n,), with the face resting on the contour. ContactError if that reaches the pivot."""
        psi: Array = self._psi(self.face.bearing(contour), phi)[0]
        return psi

    def drives(self, contour: Contour) -> list[OfArmFace]:
        """Angle psi of the face as it rests on the contour. ContactError if that reaches the pivot."""
        return [OfArmFace(self.face, self.face.bearing(contour), 0.5 * np.pi)]

    def _psi(self, bearing: Bearing, phi: Array, middle: Array | None = None) -> Array:
        """Psi and two derivatives by phi, (3, n); `middle` as in `ArmFace.touch`."""
        rows = self.face.touch(bearing, phi, middle)
        rows[0] -= phi
        rows[1] -= 1.0
        psi: Array = self.face.side * rows
        psi[0] += 0.5 * np.pi
        return psi

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error; its extremes over the whole turn."""
        bearing = self.face.bearing(contour)
        worst = self._error_extremes(bearing).worst
        angle = with_steps(phi)
        errors = self._psi(bearing, angle)[0] - self.intended(angle)
        flatness = [float(np.ptp(self._psi(bearing, x)[0])) for x in dwell_angles(self.rests, phi)]
        return Judged(motion_error(worst, errors, max(flatness, default=None), "deg"), None)

    def _error_extremes(self, bearing: Bearing) -> Extremes:
        """Extremes of the error over the shaft angle, between the passages of the contact and the law's breaks."""
        starts = np.mod(self.face.starts(bearing), TURN)
        nodes = distinct(np.concatenate([[0.0], starts, self.law.breaks, [TURN]]))
        low, high = nodes[:-1], nodes[1:]
        middle = 0.5 * (low + high)

        def error(phi: Array, of: Indices, side: Side = 1) -> Array:
            return self._psi(bearing, phi, middle[of]) - self.law.derivatives(phi, 2, side)

        every = np.arange(len(low))
        return extremes(low, high, error(low, every), error(high, every, -1), error, resolution=RESOLUTION_ANGLE)

    def motion_limit(self, tolerance: float) -> float:
        """Greatest swing, degrees, that a shift of the contour by `tolerance` gives the face."""
        phi = grid(self.law.breaks)
        psi = self.intended(phi)
        if (psi >= 0.5 * np.pi).any():
            raise ContactError("the intended contact reaches the pivot", float(phi[int(np.argmax(psi))]))
        return float(np.degrees(self.face.leeway(self.support, tolerance, grid(self.support.breaks)).max()))

    def direct_limit(self, tolerance: float) -> float:
        """The same, degrees, at the pivot's distance."""
        return float(np.degrees(tolerance / self.face.pivot))


@dataclass(frozen=True, eq=False)
class FlatPair(OfTransmission):
    """W's pair of flat faces that include pi - alpha and meet in a pivot at distance 2 l from the shaft (W section 5).

    The pair swings by psi/2; the normal of face A stands at t, that of face B at t + alpha, in the cam frame. Positions
    are swings in radians, clockwise positive; error figures are in degrees. Faces that stand farther out pass the pivot
    at that distance, and their cam is the parallel curve. Face A keeps the swing below. The faces' own positions count
    from where they stand at no swing.
    """

    share: ClassVar[float] = 0.5

    @cached_property
    def faces(self) -> tuple[ArmFace, ArmFace]:
        """Face A and face B."""
        a, b = self.contacts
        return ArmFace.of(a), ArmFace.of(b)

    @property
    def lever(self) -> float:
        """About how far from the pivot the faces are touched, mm: the law's arm l."""
        return self.transmission.arm

    @property
    def closure(self) -> Closure:
        """The angle by which the faces stand wider than they need."""
        return Closure(self.play_limit, lever=2.0)

    @cached_property
    def support(self) -> PairSupport:
        """Distance of the lines through the pivot along the faces: that of the contour, less what they stand out."""
        return PairSupport(self.transmission)

    @cached_property
    def envelope(self) -> FlatEnvelope:
        """The exact contour; its parameter is the direction of face A's normal."""
        out = self.faces[0].out
        return FlatEnvelope(Outset(self.support, out) if out else self.support)

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle at which face A touches the envelope's point of that parameter (n,)."""
        phi: Array = self.faces[0].shaft(parameter, self.support.derivatives(parameter, 0))[0]
        return phi

    def contact(self, contour: Contour, phi: Array) -> Array:
        """Swing, radians (2, n): with face A resting on the contour, and with face B.

        ContactError if the contour reaches the pivot.
        """
        return self._swings(self.bearing(contour), phi)

    def drives(self, contour: Contour) -> list[OfArmFace]:
        """Swing of each face away from the cam, as it rests on the contour. ContactError if that reaches the pivot."""
        bearing = self.bearing(contour)
        return [OfArmFace(face, bearing, one.apart) for face, one in zip(self.faces, self.contacts, strict=True)]

    def _swings(self, bearing: Bearing, phi: Array) -> Array:
        # own position is apart + side * (normal - phi), and side is less the sense
        swings = [
            phi + one.sense * (one.apart - one.zero) - face.touch(bearing, phi)[0]
            for face, one in zip(self.faces, self.contacts, strict=True)
        ]
        return np.stack(swings)

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error of either face and the play between them; extremes over the whole turn."""
        bearing = self.bearing(contour)
        found = [self._error_extremes(bearing, face) for face in self.faces]
        worst = max((extreme.worst for extreme in found), key=lambda pair: pair[0])
        angle = with_steps(phi)
        errors = self._swings(bearing, angle) - self.intended(angle)
        flatness = [float(np.ptp(self._swings(bearing, x), axis=1).max()) for x in dwell_angles(self.rests, phi)]
        return Judged(motion_error(worst, errors, max(flatness, default=None), "deg"), self._play(bearing))

    def motion_limit(self, tolerance: float) -> float:
        """Greatest swing, degrees, that a shift of the contour by `tolerance` gives a face."""
        theta = grid(self.support.breaks)
        return float(np.degrees(max(face.leeway(self.support, tolerance, theta).max() for face in self.faces)))

    def direct_limit(self, tolerance: float) -> float:
        """The same, degrees, at the pivot's distance."""
        return float(np.degrees(tolerance / self.faces[0].pivot))

    def play_limit(self, tolerance: float) -> float:
        """Greatest play, degrees, from such shifts at both faces."""
        a, b = self.faces
        theta = grid(self.support.breaks)
        far = b.leeway(self.support, tolerance, theta + self.transmission.alpha)
        return float(np.degrees((a.leeway(self.support, tolerance, theta) + far).max()))

    def bearing(self, contour: Contour) -> Bearing:
        """Where a contour bears all round; ContactError if it reaches the pivot."""
        for one in self.faces:
            bearing = one.bearing(contour)
        return bearing

    def _error_extremes(self, bearing: Bearing, face: ArmFace) -> Extremes:
        """Extremes of the swing error with that face in contact; found over theta, told over phi.

        At face normal theta the measured shaft angle is phi_q(theta); intended is the normal t with phi_r(t) = phi_q,
        and the swing is off by t - theta.
        """
        nodes = bearing.nodes(0.0, TURN, self.support.breaks)
        stretch, q_low, q_high = bearing.between(nodes)

        def intended(theta: Array) -> Array:
            return face.shaft(theta, self.support.derivatives(theta, 2))

        def error(theta: Array, q: Array, there: Array) -> Array:
            value, slope, bend = face.shaft(theta, q)
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
            return float(face.shaft(at, bearing.derivatives(at, bearing.find(at))[:1])[0, 0])

        return replace(found, greatest_at=shaft(found.greatest_at), least_at=shaft(found.least_at))

    def _play(self, bearing: Bearing) -> Play:
        a, b = self.faces
        ends = np.concatenate([a.starts(bearing), b.starts(bearing)])
        nodes = distinct(np.concatenate([[0.0], np.mod(ends, TURN), [TURN]]))
        low, high = nodes[:-1], nodes[1:]
        middle = 0.5 * (low + high)

        def play(phi: Array, of: Indices) -> Array:
            wide = b.touch(bearing, phi, middle[of]) - a.touch(bearing, phi, middle[of])
            wide[0] -= self.contacts[0].apart + self.contacts[1].apart
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
