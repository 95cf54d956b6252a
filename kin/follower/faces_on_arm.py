"""Flat faces on an arm: a single one, and a pair of them that swings about one pivot.

A face at distance f within the line through the pivot C that is parallel to it touches a contour of support function q
at its normal t where q(t) + f = C cos(t - phi): on either side of the pivot at one shaft angle phi.

The errors below are extremes over all shaft angles, found stretch by stretch between the breaks of the contour's
support function and those of the intent.
"""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from kin.contour.arcs import dot
from kin.follower.base import Closure, Moved, OfLaw, OfTransmission
from kin.follower.envelope import ArmPitch, FlatEnvelope, support_rows
from kin.follower.flat import NEAR, TRAVEL_STEPS
from kin.follower.motion_error import ContactError, Judged, Play, motion_error, with_steps
from kin.follower.rests import dwell_angles
from kin.follower.support import FlatContacts, bearing_of
from kin.law.bounds import cubic_cells
from kin.law.contacts import Flat, Oscillating
from kin.numeric.angles import TURN, degrees
from kin.numeric.distinct import distinct
from kin.numeric.extrema import Extremes, extremes
from kin.numeric.feet import grid
from kin.numeric.newton import zeros
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.follower.envelope import FacePitch
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array, Indices

RESOLUTION_ANGLE = 1e-13  # rad, also where the swing of a pair is steep over the shaft angle
FINE_ANGLE = 2e-14  # rad, of a single face, which is steep nowhere
SETTLED = 1e-8  # rad: after a Newton step below this the next is lost in rounding, also where f'' jumps


@dataclass(frozen=True)
class ArmFace:
    """A flat face on an arm, its pivot at the distance `pivot` from the shaft, mm, its normal at t in the cam frame.

    It stands `out` mm farther out than the line through the pivot that is parallel to it; q is the contour's support
    function less `out`. `side` is 1 where the face trails the pivot, phi = t + acos(q/pivot), and -1 where it leads it.
    """

    pivot: float
    side: Side
    out: float = 0.0

    @staticmethod
    def of(contact: Contact[Guide, Touch]) -> ArmFace:
        """Make the formulas of a face on an arm from its contact; raises TypeError for any other contact."""
        if not (isinstance(contact.guide, Oscillating) and isinstance(contact.touch, Flat)):
            raise TypeError("a flat face on an arm has a pivot")
        return ArmFace(contact.guide.pivot, contact.guide.side, -contact.touch.nearer)

    def bearing(self, contour: Contour) -> FlatContacts:
        """Contacts of a contour with the face all round, their support function less `out`.

        Raises ContactError if the face's contact reaches the pivot.
        """
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
        """Shaft angle, rad, and two derivatives by the normal's direction theta (n,): (3, n); from rows (3, n) of q."""
        w, slope, bend = q / self.pivot
        sine = np.sqrt((1.0 - w) * (1.0 + w))
        angle = theta + self.side * np.arctan2(sine, w)
        rates = 1.0 - self.side * slope / sine, -self.side * (bend * sine * sine + w * slope * slope) / sine**3
        return np.stack([angle, *rates])

    def starts(self, bearing: FlatContacts) -> Array:
        """Shaft angles (m,), rad, rising, at which each stretch of the contour begins to bear on the face.

        The angle rises with theta as long as the contact stays on its side of the pivot.
        """
        q = bearing.derivatives(bearing.breaks, np.arange(len(bearing.breaks)))
        start: Array = self.shaft(bearing.breaks, q)[0]
        return start

    def touch(self, bearing: FlatContacts, phi: Array, middle: Array | None = None) -> Array:
        """Direction theta of the face's normal, rad, and two derivatives by phi (3, n), with the face held in contact.

        For angles phi (n,), rad, at ends of stretches `middle` (n,), rad, are shaft angles within the stretch to be
        taken. Raises UnsettledError where a contact is not found.
        """
        start = self.starts(bearing)
        turns = np.floor(((phi if middle is None else middle) - start[0]) / TURN)
        reduced = phi - turns * TURN  # in the turn that begins with the first stretch
        # the stretch that holds `middle`, or without it phi itself
        within = np.maximum(reduced if middle is None else middle - turns * TURN, start[0])
        stretch = np.searchsorted(start, within, side="right") - 1
        low = bearing.breaks[stretch]
        high = np.append(bearing.breaks[1:], bearing.breaks[0] + TURN)[stretch]
        width = np.diff(start, append=start[0] + TURN)[stretch]
        share = np.where(width > 0.0, (reduced - start[stretch]) / np.where(width > 0.0, width, 1.0), 0.0)
        # first guess: as far along the normals of the stretch as along its shaft angles
        theta = low + np.clip(share, 0.0, 1.0) * (high - low)

        def shaft(theta: Array) -> Array:
            return self.shaft(theta, bearing.derivatives(theta, stretch))

        def over(theta: Array) -> tuple[Array, Array]:
            value, slope, _ = shaft(theta)
            return value - reduced, slope

        theta = zeros(over, low, high, theta, SETTLED)
        _, slope, bend = shaft(theta)
        return np.stack([theta + turns * TURN, 1.0 / slope, -bend / slope**3])

    def leeway(self, support: Array, phi: Array, tolerance: float) -> Array:
        """Swing, radians (n,), that a shift of a contour by `tolerance` e, mm, gives the face, to second order.

        `support` (3, n) is q with two derivatives at the places touched at shaft angles phi (n,). The first order is e
        over the distance from pivot to contact. Raises ContactError where the intended contact reaches the pivot.
        """
        r, slope, bend = support
        distance = np.sqrt(self.pivot**2 - r * r) - self.side * slope
        if (distance <= 0.0).any():
            raise ContactError("the intended contact reaches the pivot", float(phi[int(np.argmin(distance))]))
        first = tolerance / distance
        swing: Array = first + 0.5 * np.abs(r + bend) / distance * first**2
        return swing


@dataclass(frozen=True, eq=False)
class OfArmFace:
    """Swing of a flat face on an arm, away from the cam, as it rests on a contour.

    The swing is `datum`, rad, where the face's normal points from the shaft to the pivot.
    """

    face: ArmFace
    bearing: FlatContacts
    datum: float
    smooth: ClassVar[bool] = False

    @cached_property
    def breaks(self) -> Array:
        """Shaft angles (m,), rad, at which the contact passes from one piece of the contour to the next."""
        return np.mod(self.face.starts(self.bearing), TURN)

    def rows(self, phi: Array) -> Array:
        """Position, rad, and two derivatives by the shaft angle, (3, n), at angles phi (n,), rad, not at breaks."""
        rows = self.face.touch(self.bearing, phi)
        rows[0] += self.face.side * self.datum - phi
        rows[1] -= 1.0
        away: Array = self.face.side * rows
        return away


class _OnArm(Moved):
    """Flat faces on arms about one pivot.

    The own position of a face, rad, is its level less the angle between its normal and the line from shaft to pivot.
    """

    @cached_property
    def faces(self) -> tuple[ArmFace, ...]:
        """Formulas of the face of each contact."""
        return tuple(ArmFace.of(contact) for contact in self.contacts)

    @property
    @abstractmethod
    def pitch(self) -> FacePitch:
        """Intended line through the pivot along the first face."""

    @property
    @abstractmethod
    def levels(self) -> tuple[float, ...]:
        """Own position, rad, of each face where its normal points along the line from shaft to pivot."""

    @property
    @abstractmethod
    def resolution(self) -> float:
        """Resolution, rad, to which extremes of the error are found."""

    @property
    @abstractmethod
    def cells(self) -> Array:
        """Shaft angles (m,), rad, that divide the turn into cells; in each a cubic follows the intended motion."""

    @cached_property
    def envelope(self) -> FlatEnvelope:
        """The exact contour, over the parameter of the pitch."""
        return FlatEnvelope(self.pitch, self.faces[0].out)

    def bearing(self, contour: Contour) -> FlatContacts:
        """Contacts of a contour with the faces all round; ContactError if one of them reaches the pivot."""
        for face in self.faces:
            bearing = face.bearing(contour)
        return bearing

    def drives(self, contour: Contour) -> list[OfArmFace]:
        """Swing of each face away from the cam as it rests on the contour; ContactError if that reaches the pivot."""
        bearing = self.bearing(contour)
        return [OfArmFace(face, bearing, level) for face, level in zip(self.faces, self.levels, strict=True)]

    def pressed(self, contour: Contour, phi: Array) -> tuple[Array, Array]:
        """Pressure angle, rad, at face 1 and radius of curvature of the contour there, mm, (n,) each, at phi (n,)."""
        bearing, face = self.bearing(contour), self.faces[0]
        theta = face.touch(bearing, phi)[0]
        q, slope, bend = bearing.derivatives(theta, bearing.find(theta))
        along = np.sqrt(face.pivot**2 - q * q) - face.side * slope
        return -face.side * np.arctan2(face.out, along), q + face.out + bend

    def touching(self, points: Array, normals: Array) -> list[tuple[Array, Array]]:
        """Shaft angle and position, rad, (n,) each, with each face on metal at points and outward normals (n, 2)."""
        direction = np.arctan2(normals[:, 1], normals[:, 0])
        touches = []
        for face, contact, level in zip(self.faces, self.contacts, self.levels, strict=True):
            w = (dot(points, normals) - face.out) / face.pivot
            with np.errstate(invalid="ignore"):
                swing = face.side * np.arccos(w)
            touches.append(
                (direction + swing, contact.sense * (level - contact.zero) - contact.sense * face.side * swing)
            )
        return touches

    def _rows(self, bearing: FlatContacts, i: int, phi: Array, middle: Array | None = None) -> Array:
        """Position, rad, and two derivatives by phi, (3, n), at phi (n,), rad, with face i resting on a contour.

        For angles phi at ends of stretches `middle` (n,) are shaft angles within the stretch to be taken.
        """
        face, contact = self.faces[i], self.contacts[i]
        rows = face.touch(bearing, phi, middle)
        rows[0] -= phi
        rows[1] -= 1.0
        position: Array = contact.sense * face.side * rows
        position[0] += contact.sense * (self.levels[i] - contact.zero)
        return position

    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error, the worst of all faces, and the play between two; extremes over the whole turn."""
        bearing, numbers = self.bearing(contour), range(len(self.faces))
        worst = max((self._error_extremes(bearing, i).worst for i in numbers), key=lambda pair: pair[0])

        def positions(angle: Array) -> Array:
            return np.stack([self._rows(bearing, i, angle)[0] for i in numbers])

        angle = with_steps(phi)
        errors = positions(angle) - self.course.rows(angle)[0]
        flatness = [float(np.ptp(positions(x), axis=1).max()) for x in dwell_angles(self.rests, phi)]
        motion = motion_error(worst, errors, max(flatness, default=None), "deg")
        return Judged(motion, self._play(bearing) if len(self.faces) > 1 else None)

    def _error_extremes(self, bearing: FlatContacts, i: int) -> Extremes:
        """Extremes of the error of face i over the shaft angle, between its passages and the breaks of the motion."""
        breaks = np.mod(self.motion.breaks, TURN)
        nodes, middle = _stretches(np.concatenate([self.faces[i].starts(bearing), breaks, self.cells]))

        def error(phi: Array, interval: Indices) -> Array:
            return self._rows(bearing, i, phi, middle[interval]) - self.course.rows(phi)

        # a break at 0 stands at either end
        intended, jumps = self.course.rows(nodes), np.isin(nodes, (*breaks, 0.0, TURN) if len(breaks) else ())

        def error_at(ends: slice, side: Side) -> Array:
            rows, phi, at = intended[:, ends].copy(), nodes[ends], jumps[ends]
            if at.any():
                rows[:, at] = self.motion.derivatives(phi[at], 2, side)
            return self._rows(bearing, i, phi, middle) - rows

        at_low, at_high = error_at(slice(None, -1), 1), error_at(slice(1, None), -1)
        return extremes(nodes[:-1], nodes[1:], at_low, at_high, error, resolution=self.resolution)

    def _play(self, bearing: FlatContacts) -> Play:
        """Play, degrees: the swing with face A at rest on the contour less the swing with face B at rest on it."""
        starts = [face.starts(bearing) for face in self.faces]
        nodes, middle = _stretches(np.concatenate(starts))

        def play(phi: Array, interval: Indices) -> Array:
            a, b = (self._rows(bearing, i, phi, middle[interval]) for i in (0, 1))
            return a - b

        every, low, high = np.arange(len(middle)), nodes[:-1], nodes[1:]
        ends = extremes(low, high, play(low, every), play(high, every), play, resolution=RESOLUTION_ANGLE)
        least, most = (float(np.degrees(value)) for value in (ends.least, ends.greatest))
        return Play(least, degrees(ends.least_at), most, degrees(ends.greatest_at), "deg")

    @cached_property
    def _touched(self) -> tuple[Array, Array]:
        """Intended support function less `out` with two derivatives (3, n), and shaft angles (n,) of A's contact."""
        return self._touched_at(grid(self.breaks))

    def _touched_at(self, tau: Array) -> tuple[Array, Array]:
        """Intended support function less `out` with two derivatives (3, n), and shaft angles, at parameters tau."""
        return support_rows(self.pitch, tau)[0], self.shaft_angle(tau)

    def motion_limit(self, tolerance: float) -> float:
        """Greatest swing, degrees, that a shift of the contour by `tolerance`, mm, gives a face.

        Raises ContactError where the intended contact reaches the pivot.
        """
        return float(np.degrees(max(face.leeway(*self._touched, tolerance).max() for face in self.faces)))

    def direct_limit(self, tolerance: float) -> float:
        """Swing error, degrees, of a contour off by `tolerance`, mm, the contact as far from the pivot as the shaft."""
        return float(np.degrees(tolerance / self.faces[0].pivot))


def _stretches(breaks: Array) -> tuple[Array, Array]:
    """Shaft angles (m + 1,) over a turn that breaks (n,) are among, and the middles (m,) between them."""
    nodes = distinct(np.concatenate([[0.0], np.mod(breaks, TURN), [TURN]]))
    return nodes, 0.5 * (nodes[:-1] + nodes[1:])


@dataclass(frozen=True, eq=False)
class SwingingFace(OfLaw, _OnArm):
    """A flat face on an arm about a pivot at distance C from the shaft, f mm nearer the cam than its pivot's parallel.

    Its position, of which `law` is the intended one over the shaft angle, is the angle psi between the face and the
    line from pivot to shaft, radians, which grows as the face is lifted: its distance from the shaft is C sin psi - f.
    """

    @property
    def levels(self) -> tuple[float, ...]:
        """A quarter turn, rad: the face then stands across the line from pivot to shaft."""
        return (0.5 * np.pi,)

    @property
    def resolution(self) -> float:
        """Resolution of the search, rad: the same at all angles."""
        return FINE_ANGLE

    @cached_property
    def cells(self) -> Array:
        """Shaft angles (m,), rad, between which cubics follow the law."""
        return cubic_cells(self.law, self.law.breaks, NEAR / self.faces[0].pivot)

    @property
    def lever(self) -> float:
        """Approximate distance, mm, of the contact from the pivot at shaft angle 0."""
        return self.faces[0].pivot * float(np.cos(self.intended(np.zeros(1))[0]))

    @property
    def pitch(self) -> ArmPitch:
        """The line through the pivot along the face, over the shaft angle."""
        return ArmPitch(self.law, self.faces[0].pivot, self.faces[0].side)

    def contact_travel(self, contour: Contour) -> tuple[float, float]:
        """Least and greatest place of contact along the face, mm from the pivot's foot on it.

        Raises ContactError where the contour reaches the pivot.
        """
        face = self.faces[0]
        q, slope, _ = face.bearing(contour).all_round(TRAVEL_STEPS)
        place = np.sqrt(face.pivot**2 - q**2) - face.side * slope
        return float(place.min()), float(place.max())

    def motion_limit(self, tolerance: float) -> float:
        """Greatest swing error, degrees, of a contour within `tolerance`, mm.

        Raises ContactError where the intended contact reaches the pivot.
        """
        phi = grid(self.law.breaks)
        psi = self.intended(phi)
        if (psi >= 0.5 * np.pi).any():
            raise ContactError("the intended contact reaches the pivot", float(phi[int(np.argmax(psi))]))
        return super().motion_limit(tolerance)


@dataclass(frozen=True, eq=False)
class FlatPair(OfTransmission, _OnArm):
    """W's pair of flat faces that include pi - alpha and meet in a pivot at distance 2 l from the shaft (W section 5).

    The pair swings by psi/2; the normal of face A stands at t, that of face B at t + alpha, in the cam frame. Positions
    are swings in radians, clockwise positive; error figures are in degrees. Faces that stand farther out pass the pivot
    at that distance, and their cam is the parallel curve. Face A keeps the swing below. The faces' own positions count
    from where they stand at no swing.
    """

    share: ClassVar[float] = 0.5

    @property
    def levels(self) -> tuple[float, ...]:
        """Angle, rad, that each face's normal makes with the line from shaft to pivot where the swing is 0: alpha/2."""
        return tuple(contact.apart for contact in self.contacts)

    @property
    def resolution(self) -> float:
        """Greatest error, rad, that rounding of the search and of a recipe's own formula may feign."""
        return RESOLUTION_ANGLE + 4.0 * self.transmission.rounding / self.transmission.arm

    @property
    def lever(self) -> float:
        """Approximate distance, mm, of the contacts from the pivot: the law's arm l."""
        return self.transmission.arm

    @cached_property
    def cells(self) -> Array:
        """Shaft angles (m,), rad, at the ends of cells of the parameter, in each of which a cubic follows psi."""
        cells = cubic_cells(self.transmission.psi, self.breaks, NEAR / self.transmission.arm)
        phi: Array = self.transmission.at(cells, 0)[0][0]
        return phi

    @property
    def closure(self) -> Closure:
        """Rule for the backlash: the angle by which the faces stand wider apart than the contour needs."""
        return Closure(self.play_limit, lever=2.0)

    @property
    def pitch(self) -> Transmission:
        """Line through the pivot along face A: its distance r and direction t are those of W's polar pitch curve."""
        return self.transmission

    def play_limit(self, tolerance: float) -> float:
        """Greatest play or interference, degrees, of a contour that is off by `tolerance`, mm, at both faces.

        Raises ContactError where an intended contact reaches the pivot.
        """
        first, second = self.faces
        swing = first.leeway(*self._touched, tolerance) + second.leeway(*self._touched_ahead, tolerance)
        return float(np.degrees(swing.max()))

    @cached_property
    def _touched_ahead(self) -> tuple[Array, Array]:
        """Support rows (3, n) where face B touches as face A touches the grid; angles (n,) of A's contact there."""
        tau = grid(self.breaks)
        return self._touched_at(
            self.transmission.polar_parameter(self.pitch.pitch(tau, 0)[1][0] + self.transmission.alpha)
        )
