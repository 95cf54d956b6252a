"""The motions that drive a follower train: as intended, or as a file's contour gives them by contact.

Every motion is in SI, metres or radians, and pushes towards greater positions. A follower that is held from two sides
has two: the one that pushes it up, and the one that keeps it below, see `kin.dynamics.impacts`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import cross, dot, left, right, unit
from kin.follower.contact import dilated, first_contact
from kin.follower.flat import dwells
from kin.follower.follower import DoubleRoller, FlatFace, FlatPair, Follower, Roller, Yoke
from kin.follower.guide import LEADING, TRAILING, Arm
from kin.follower.motion_error import ContactError
from kin.follower.support import bearing_of
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.contour.contour import Contour
    from kin.dynamics.drive import Motion
    from kin.follower.guide import Side
    from kin.follower.support import Bearing
    from kin.law.piecewise import Piecewise
    from kin.law.support_function import Lift
    from kin.law.transmission import Transmission
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array, Indices


METRE = 1e-3  # a millimetre in metres
SPLINE_ERROR = 1e-7  # mm, within which arcs stand in for a spline that a roller runs on
_INSET = 1e-6  # how far within an interval between two angles it is looked for the piece that is met there
_HALVINGS = 60  # of an interval, more than a number has bits: a passage is found to its last places


class Faces(NamedTuple):
    """What holds a follower: `lower` pushes it up; `upper` keeps it below, or is None where a spring does."""

    lower: Motion
    upper: Motion | None


@dataclass(frozen=True, eq=False)
class Moved:
    """sign * motion + offset."""

    motion: Motion
    sign: float = 1.0
    offset: float = 0.0

    @property
    def breaks(self) -> Array:
        """As the motion's."""
        return self.motion.breaks

    @property
    def corners(self) -> Array:
        """As the motion's."""
        return self.motion.corners

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        rows = self.sign * self.motion.rows(phi)
        rows[0] += self.offset
        return rows


class _Smooth:
    """A motion without corners."""

    @property
    def corners(self) -> Array:
        """None."""
        return np.empty(0)


@dataclass(frozen=True, eq=False)
class OfLift(_Smooth):
    """A flat face's intended distance from the shaft. Lifts have no corners."""

    lift: Lift

    @property
    def breaks(self) -> Array:
        """Jumps of the acceleration or of its derivatives."""
        return self.lift.breaks

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        rows: Array = METRE * self.lift.derivatives(phi, 2)
        return rows


@dataclass(frozen=True, eq=False)
class OfLaw(_Smooth):
    """A roller's intended lean over the shaft angle."""

    law: Piecewise

    @property
    def breaks(self) -> Array:
        """Jumps of the acceleration or of its derivatives."""
        return self.law.breaks

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        return self.law.derivatives(phi, 2)


@dataclass(frozen=True, eq=False)
class OfTransmission(_Smooth):
    """The intended swing of a double follower, `share` times psi over the shaft angle."""

    transmission: Transmission
    share: float = 1.0

    @cached_property
    def breaks(self) -> Array:
        """Shaft angles of the law's breaks."""
        phi: Array = self.transmission.at(self.transmission.breaks, 0)[0][0]
        return phi

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        rows: Array = self.share * self.transmission.psi_of_shaft(phi, 2)
        return rows


@dataclass(frozen=True, eq=False)
class OfFace:
    """Distance at which a flat face rests on a contour, its normal `turned` ahead of the shaft angle.

    Between two breaks it is that of one corner or one circle: q = R + C.u(theta), q'' = R - q.
    """

    bearing: Bearing
    turned: float = 0.0

    @property
    def breaks(self) -> Array:
        """Where the contact passes from piece to piece."""
        return np.mod(self.bearing.breaks - self.turned, TURN)

    @property
    def corners(self) -> Array:
        """Anywhere: over an edge the contact leaps from end to end."""
        return self.breaks

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        theta = phi + self.turned
        rows: Array = METRE * self.bearing.derivatives(theta, self.bearing.find(theta))
        return rows


@dataclass(frozen=True, eq=False)
class OfPair:
    """Swing of a flat pair with the face of one side resting on a contour."""

    pair: FlatPair
    bearing: Bearing
    side: int

    @cached_property
    def breaks(self) -> Array:
        """Where the contact passes from piece to piece."""
        return np.mod(self.pair.starts(self.bearing, self.side), TURN)

    @property
    def corners(self) -> Array:
        """Anywhere, as for a face."""
        return self.breaks

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        rows = -self.pair.touch(self.bearing, phi, self.side)
        rows[0] += phi - 0.5 * self.side * self.pair.transmission.alpha
        rows[1] += 1.0
        return rows


@dataclass(frozen=True, eq=False)
class OfRoller:
    """Lean of an arm whose roller rests on a contour; `obstacle` is what the roller's centre cannot enter.

    With X on a piece of curvature k and tangent t, X' = w t and X'' = w' t + w^2 k left(t), and the arm's length stays:
    w and w' follow from (X - P)^2 = l^2, and the lean's derivatives from those of X - P.
    """

    obstacle: Arcs
    arm: Arm

    @cached_property
    def breaks(self) -> Array:
        """Where the roller passes from piece to piece; two passages within a millionth of an interval may be lost."""
        ends = self.arm.shaft_angle(np.concatenate([self.obstacle.start, self.obstacle.ends]))
        ends = np.unique(np.mod(ends[np.isfinite(ends)], TURN))
        width = np.diff(ends, append=ends[:1] + TURN)
        ends, width = ends[width > 1e-12], width[width > 1e-12]
        low, high = ends + _INSET * width, ends + (1.0 - _INSET) * width
        piece = self._met(low)[1]
        leaps = piece != self._met(high)[1]
        low, high, piece = low[leaps], high[leaps], piece[leaps]
        for _ in range(_HALVINGS if len(low) else 0):
            middle = 0.5 * (low + high)
            same = self._met(middle)[1] == piece
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return np.sort(np.mod(np.concatenate([ends, low]), TURN))

    @property
    def corners(self) -> Array:
        """Anywhere: a roller may rest in a hollow."""
        return self.breaks

    def _met(self, phi: Array) -> tuple[Array, Indices]:
        r, piece = first_contact(self.obstacle, self.arm, phi)
        if (piece < 0).any():
            raise ContactError("the roller does not touch the contour", float(phi[int(np.argmin(piece))]))
        return r, piece

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        arm, side = self.arm, self.arm.side
        r, piece = self._met(phi)
        met = self.obstacle.take(piece)
        lean = arm.position(r)
        x = arm.centre(phi, lean)
        outward = right(met.tangent) + met.curvature[:, None] * (x - met.start)
        tangent = left(outward / np.hypot(outward[:, 0], outward[:, 1])[:, None])
        pivot = arm.pivot * unit(phi)
        pivot_rate, pivot_bend = left(pivot), -pivot
        d = x - pivot
        along = dot(d, tangent)
        w = dot(d, pivot_rate) / along
        rate = w[:, None] * tangent - pivot_rate
        hollow = (w**2 * met.curvature)[:, None] * left(tangent) - pivot_bend
        bend = hollow - ((dot(d, hollow) + dot(rate, rate)) / along)[:, None] * tangent
        square = arm.length**2
        return np.stack([lean, side * (1.0 - cross(d, rate) / square), -side * cross(d, bend) / square])


@dataclass(frozen=True, eq=False)
class OfMechanism(_Smooth):
    """The intended output of a mechanism over its shaft angle."""

    mechanism: Mechanism

    @property
    def _unit(self) -> float:
        return METRE if self.mechanism.unit == "mm" else 1.0

    @cached_property
    def breaks(self) -> Array:
        """Shaft angles of the lift's breaks at either face that drives the frame."""
        shaft: Array = self.mechanism.at(self.mechanism.breaks, 0).shaft[0]
        return shaft

    def rows(self, phi: Array) -> Array:
        """See `kin.dynamics.drive.Motion`."""
        at = self.mechanism.at(self.mechanism.relative(phi), 2)
        rows: Array = self._unit * at.over_shaft(at.output)
        return rows


def rests(follower: Follower) -> tuple[tuple[float, float], ...]:
    """Dwells of a follower's intended motion: from, to, as shaft angles in radians, to > from."""
    if isinstance(follower, FlatFace | Yoke):
        return tuple(dwells(follower.lift))
    if isinstance(follower, Roller):
        return ()
    law = follower.transmission
    ends = law.breaks if len(law.breaks) else np.zeros(1)
    shaft = law.at(np.append(ends, ends[0] + TURN), 0)[0][0].tolist()
    return tuple((a, b) for a, b, steady in zip(shaft[:-1], shaft[1:], law.steady, strict=True) if steady)


def intended_faces(follower: Follower, play: float | None) -> Faces:
    """Drives of the intended motion: one face under a spring where `play` is None, else two, `play` apart.

    Play is in metres or radians. With a spring a double follower rests on its first face or roller.
    """
    motion: Motion
    if isinstance(follower, FlatFace | Yoke):
        motion = OfLift(follower.lift)
    elif isinstance(follower, Roller):
        motion = OfLaw(follower.law)
    else:
        motion = OfTransmission(follower.transmission, 0.5 if isinstance(follower, FlatPair) else 1.0)
        if play is None:
            return Faces(Moved(motion, -1.0), None)  # roller and face A hold psi from above
    return Faces(motion, None if play is None else Moved(motion, 1.0, play))


def measured_faces(follower: Follower, contour: Contour, play: float | None) -> Faces:
    """Drives of the motion that a file's contour gives by contact, as `intended_faces`.

    Flat faces feel every piece as it is; under a roller splines are arcs within SPLINE_ERROR. With play both sides are
    the contour's own: what it is too large takes from the play. ContactError where the
    follower finds no contact, ValueError for play with a follower that has one face.
    """
    if isinstance(follower, FlatFace | Yoke):
        bearing = bearing_of(contour)
        if play is None:
            return Faces(OfFace(bearing), None)
        if isinstance(follower, FlatFace):
            raise ValueError("a single face has no backlash")  # noqa: TRY004 - the play is at fault, not the type
        return Faces(OfFace(bearing), Moved(OfFace(bearing, math.pi), -1.0, METRE * follower.breadth + play))
    if isinstance(follower, FlatPair):
        bearing = follower.held(contour)
        a, b = OfPair(follower, bearing, 1), OfPair(follower, bearing, -1)
        return Faces(Moved(a, -1.0), None) if play is None else Faces(b, Moved(a, 1.0, play))
    obstacle = dilated(contour.as_arcs(SPLINE_ERROR)[0], follower.radius)
    if isinstance(follower, Roller):
        if play is not None:
            raise ValueError("a single roller has no backlash")
        if not isinstance(follower.guide, Arm):
            raise ValueError("the dynamics know rollers on arms only")  # noqa: TRY004 - the recipe is at fault
        return Faces(OfRoller(obstacle, follower.guide), None)
    first, second = (OfRoller(obstacle, _arm_of(follower, side)) for side in (TRAILING, LEADING))
    rest = math.pi - follower.transmission.alpha
    # psi = pi - lean - alpha with roller A in contact, lean - pi + alpha with B
    if play is None:
        return Faces(Moved(first, 1.0, -rest), None)
    return Faces(Moved(second, 1.0, -rest), Moved(first, -1.0, rest + play))


def _arm_of(follower: DoubleRoller, side: Side) -> Arm:
    return Arm(follower.transmission.arm, follower.transmission.arm, side)
