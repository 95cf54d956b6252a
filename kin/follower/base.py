"""What every follower offers: its contacts on guides, its intended motion, and the rule by which its play is judged.

A follower is its contacts (`kin.law.contacts`) and its motion. The formulas of each pair of guide and touch have their
own module: a flat face on a line of travel `kin.follower.flat`, on an arm `kin.follower.faces_on_arm`, a roller on
either `kin.follower.roller`. All other code uses a follower by the methods below, whatever its kind.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np

from kin.follower.drive import Shifted
from kin.follower.rests import dwells_of_law, dwells_of_transmission
from kin.law.contacts import METRE
from kin.numeric.lengths import span_words
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.contour.contour import Contour
    from kin.follower.drive import Excitation
    from kin.follower.envelope import Envelope
    from kin.follower.laws import ByLaw, Swing
    from kin.follower.motion_error import Judged, Play
    from kin.follower.tracking import IntendedLaw
    from kin.law.contacts import Contact, Guide, Touch, Unit
    from kin.law.piecewise import Piecewise
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

Rests = tuple[tuple[float, float], ...]


class IntendedMotion(Protocol):
    """An intended motion over the shaft angle, such as a `Lift`, a `Piecewise` or a `kin.follower.laws.Swing`."""

    @property
    def breaks(self) -> Array:
        """Shaft angles (m,), rad, of one turn, where a second or higher derivative may jump; not all in [0, 2 pi)."""

    def derivatives(self, phi: Array, order: int, side: int = 1) -> Array:
        """Position, mm or rad, and its derivatives by the shaft angle at angles phi (n,): (order + 1, n).

        At a break the derivatives are limits from the right, or from the left (side -1).
        """


@dataclass(frozen=True)
class Closure:
    """Rule by which the play of a follower held from two sides is judged.

    limit    greatest play or interference, mm or degrees, of a contour within a tolerance, mm, of the exact one
    name     name of the check on play and interference
    tight    name of a second check, on interference alone; None without one
    breadth  breadth of a frame, mm, where the contour's breadth is reported in place of the play; else None
    lever    permitted play, mm or degrees, per mm or degree of permitted motion error; None where the contour's
             tolerance alone sets the play
    radius   radius of the rollers, mm, with which a limit is compared to see whether it is loose; None where the
             stroke of the follower serves
    """

    limit: Callable[[float], float]
    name: str = "form-closure"
    tight: str | None = None
    breadth: float | None = None
    lever: float | None = None
    radius: float | None = None

    def detail(self, play: Play) -> str:
        """Words of the check on a play: the range of the contour's breadth where `breadth` is given, else of play."""
        if self.breadth is not None:
            return f"breadth {span_words(self.breadth - play.most, self.breadth - play.least)}"
        sampled = ", sampled" if play.extremes == "sampled" else ""
        span = f"{play.least:.3g} to {play.most:.3g} {play.unit}"
        span = span_words(play.least, play.most, ".3g") if play.unit == "mm" else span
        return f"backlash from {span}{sampled}"


@dataclass(frozen=True, eq=False)
class Follower(ABC):
    """A follower; positions and motions are in mm or radians, error figures and limits in mm or degrees.

    One contact is held on the cam by a spring, two hold the follower from both sides. A contact's own position counts
    away from the metal. The follower's position is 0 where contact 1 would reach the shaft or, on an arm, the line to
    the shaft; the swing of two contacts on one arm is 0 in their mean position.
    """

    contacts: tuple[Contact[Guide, Touch], ...]

    @property
    @abstractmethod
    def motion(self) -> IntendedMotion:
        """Intended motion over the shaft angle, mm or rad."""

    @property
    @abstractmethod
    def rests(self) -> Rests:
        """Dwells of the intended motion, each a pair of shaft angles (from, to), rad, to > from."""

    @property
    @abstractmethod
    def envelope(self) -> Envelope:
        """Exact contour of the cam: the envelope of the roller or face."""

    @property
    def closure(self) -> Closure | None:
        """Rule by which the follower's play is judged; None for a follower with one contact, which has no play."""
        return None

    @property
    def unit(self) -> Unit:
        """Unit of motion errors: deg for a follower that swings, else mm."""
        return self.contacts[0].guide.unit

    def intended(self, phi: Array) -> Array:
        """Intended position (n,), mm or rad, at shaft angles phi (n,), rad."""
        position: Array = self.motion.derivatives(phi, 0)[0]
        return position

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angles (n,), rad, at which contact 1 touches the points of the envelope at parameters (n,)."""
        return parameter

    @property
    def si(self) -> float:
        """Metres in a millimetre, or 1 for a position in radians."""
        return METRE if self.unit == "mm" else 1.0

    def moved_by(self, length: float) -> float:
        """Approximate travel, m or rad, of the follower as its contact moves by `length`, mm."""
        return METRE * length if self.unit == "mm" else length / self.lever

    @property
    def lever(self) -> float:
        """Approximate distance of the contact from the arm's pivot, mm; infinite on a line of travel."""
        return math.inf

    @abstractmethod
    def drives(self, contour: Contour) -> Sequence[Excitation]:
        """Own position of each contact, m or rad, over the shaft angle as it rests on a contour.

        Raises ContactError where the contour reaches the pivot of a face's arm. The drive of a roller raises it when it
        is evaluated at an angle at which the roller touches nothing.
        """

    @abstractmethod
    def pressed(self, contour: Contour, phi: Array) -> tuple[Array, Array]:
        """Pressure angle at contact 1 and the contour's radius of curvature there, (n,) each, at shaft angles phi (n,).

        The angle, rad, counts counter-clockwise from the normal out of the metal to the way in which the touch moves
        away from the metal: of a round touch whose line of travel passes through the shaft it is above 0 where the
        touch moves outwards. The radius, mm, is 0 at a corner, negative in a hollow and infinite on a line. Raises
        ContactError where contact 1 finds no contact.
        """

    def contact_travel(self, contour: Contour) -> tuple[float, float] | None:  # noqa: ARG002 - the protocol's
        """Least and greatest place of contact 1 along a flat face over the turn, mm.

        None for round touches and for two faces on one arm. On a line of travel the place counts from the stem's axis,
        above 0 ahead of the axis; on an arm from the foot of the pivot on the face. Raises ContactError where the
        contour reaches the pivot.
        """
        return None

    @abstractmethod
    def touching(self, points: Array, normals: Array) -> list[tuple[Array, Array]]:
        """For each contact, shaft angles and follower's positions (n,) at which it touches metal at points (n, 2), mm.

        `normals` (n, 2) are the contour's outward unit normals there. Angles are rad, nan out of reach; positions are
        mm or rad.
        """

    def resting(self, contour: Contour) -> list[Shifted]:
        """Drives of the follower's position, m or rad: one for each contact, as that alone rests on a contour.

        Raises ContactError where the contour reaches the pivot of a face's arm.
        """
        each = zip(self.contacts, self.drives(contour), strict=True)
        return [
            Shifted(drive, float(contact.sense), -contact.sense * self.si * contact.zero) for contact, drive in each
        ]

    @abstractmethod
    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error and play; rms and increments are from the shaft angles phi (n,), rad.

        Raises ContactError where the follower finds no contact, and UnsettledError where rounding hides the extremes of
        a flat face's error.
        """

    @abstractmethod
    def motion_limit(self, tolerance: float) -> float:
        """Greatest motion error, mm or degrees, of a contour within `tolerance`, mm, of the exact one.

        Raises ContactError where the intended contact reaches an arm's pivot or a pressure angle is 90 degrees.
        """

    def direct_limit(self, tolerance: float) -> float:
        """Greatest motion error, mm or degrees, of a contour within `tolerance`, mm, at a pressure angle of 0.

        On a flat face of an arm the contact counts as far from the pivot as the shaft is.
        """
        return math.degrees(self.moved_by(tolerance)) if self.unit == "deg" else tolerance


@dataclass(frozen=True, eq=False)
class Moved(Follower):
    """A follower whose intended motion is given over the parameter of its envelope."""

    @property
    @abstractmethod
    def course(self) -> IntendedLaw:
        """Intended motion over the shaft angle, with proved bounds of its derivatives."""

    @property
    @abstractmethod
    def breaks(self) -> Array:
        """Parameters (k,) in [0, 2 pi) at which the second derivative may jump, rising."""

    @abstractmethod
    def over(self, parameter: Array) -> tuple[Array, Array]:
        """Shaft angle, rad, and position, mm or rad, with two derivatives by the parameter (n,): (3, n) each."""


@dataclass(frozen=True, eq=False)
class OfLaw(Moved):
    """A follower whose intended motion is a law over the shaft angle, which is the parameter."""

    law: Piecewise

    @property
    def motion(self) -> Piecewise:
        """Intended motion: the law over the shaft angle."""
        return self.law

    @cached_property
    def course(self) -> ByLaw:
        """Law over the shaft angle with proved bounds of its derivatives."""
        from kin.follower.laws import ByLaw

        return ByLaw(self.law)

    @cached_property
    def rests(self) -> Rests:
        """Dwells of the law, each a pair of shaft angles (from, to), rad."""
        return tuple(dwells_of_law(self.law))

    @property
    def breaks(self) -> Array:
        """Breaks of the law (k,), rad."""
        return self.law.breaks

    def over(self, parameter: Array) -> tuple[Array, Array]:
        """Shaft angle, which is the parameter (n,), and position, with two derivatives by it: (3, n) each."""
        angle = np.stack([parameter, np.ones_like(parameter), np.zeros_like(parameter)])
        return angle, self.law.derivatives(parameter, 2)


@dataclass(frozen=True, eq=False)
class OfTransmission(Moved):
    """A double follower whose intended motion is the swing of a transmission, `share` times psi, over its parameter."""

    share: ClassVar[float] = 1.0
    transmission: Transmission

    @cached_property
    def motion(self) -> Swing:
        """Intended motion: the swing psi over the shaft angle, rad."""
        from kin.follower.laws import Swing

        return Swing(self.transmission, self.share)

    @property
    def course(self) -> Swing:
        """Swing over the shaft angle with proved bounds of its derivatives."""
        return self.motion

    @cached_property
    def rests(self) -> Rests:
        """Dwells of psi, each a pair of shaft angles (from, to), rad."""
        return tuple(dwells_of_transmission(self.transmission))

    @property
    def breaks(self) -> Array:
        """Breaks of the transmission (k,), rad."""
        return self.transmission.breaks

    def over(self, parameter: Array) -> tuple[Array, Array]:
        """Shaft angle and swing, rad, with two derivatives by the parameter (n,): (3, n) each."""
        phi, psi = self.transmission.at(parameter, 2)
        return phi, self.share * psi

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angles (n,), rad, at which contact A touches the envelope's points at parameters (n,)."""
        phi: Array = self.transmission.at(parameter, 0)[0][0]
        return phi
