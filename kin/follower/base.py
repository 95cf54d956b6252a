"""What every follower answers: contacts on guides, the motion it is meant to make, and what its play is judged by.

A follower is its contacts (`kin.law.contacts`) and its motion. What depends on the pair of guide and touch is a file of
formulas: a flat face on a line of travel `kin.follower.flat`, on an arm `kin.follower.faces_on_arm`, a roller on either
`kin.follower.roller`. All others ask a follower by the names below, and never of what kind it is.
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
    """An intended motion over the shaft angle; `Lift`, `Piecewise` and `kin.follower.laws.Swing` are."""

    @property
    def breaks(self) -> Array:
        """Shaft angles in [0, 2 pi) where the second derivative may jump."""

    def derivatives(self, phi: Array, order: int, side: int = 1) -> Array:
        """Position, mm or radians, and its derivatives at shaft angles phi (n,): (order + 1, n).

        At a break they are those from the right, or from the left (side -1).
        """


@dataclass(frozen=True)
class Closure:
    """Rule by which the play of a follower held from two sides is judged.

    limit    greatest play or interference of a contour within a tolerance of the exact one
    name     of the check on both, play and interference
    tight    name of a check on interference alone; None for none
    breadth  of a frame, mm: what is reported is how broad the contour is; None where play is
    lever    play that is permitted for a permitted motion error of 1, mm or degrees; None where the tolerance sets it
    radius   of the rollers, mm, beside which a play is small; None of a play that is an angle
    """

    limit: Callable[[float], float]
    name: str = "form-closure"
    tight: str | None = None
    breadth: float | None = None
    lever: float | None = None
    radius: float | None = None

    def detail(self, play: Play) -> str:
        """Words of the check on a play: the range of the contour's breadth for a frame, else that of the backlash."""
        if self.breadth is not None:
            return f"breadth {span_words(self.breadth - play.most, self.breadth - play.least)}"
        sampled = ", sampled" if play.extremes == "sampled" else ""
        span = f"{play.least:.3g} to {play.most:.3g} {play.unit}"
        span = span_words(play.least, play.most, ".3g") if play.unit == "mm" else span
        return f"backlash from {span}{sampled}"


@dataclass(frozen=True, eq=False)
class Follower(ABC):
    """A follower; positions and motions are in mm or radians, error figures and limits in mm or degrees.

    One contact is held on the cam by a spring, two hold the follower from both sides. Here their own positions count
    away from the metal, and the follower's from where contact 1 would reach the shaft or the line to it.
    """

    contacts: tuple[Contact[Guide, Touch], ...]

    @property
    @abstractmethod
    def motion(self) -> IntendedMotion:
        """Intended motion over the shaft angle, mm or rad."""

    @property
    @abstractmethod
    def rests(self) -> Rests:
        """Dwells of the intended motion: from, to, as shaft angles in radians, to > from."""

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
        """Shaft angle (n,), rad, at which the point of the envelope at a parameter (n,) is touched."""
        return parameter

    @property
    def si(self) -> float:
        """Metres in a millimetre, or 1 for a position in radians."""
        return METRE if self.unit == "mm" else 1.0

    def moved_by(self, length: float) -> float:
        """Travel, m or rad, of the follower, about, as its contact moves by `length`, mm."""
        return METRE * length if self.unit == "mm" else length / self.lever

    @property
    def lever(self) -> float:
        """Distance of the contact from the arm's pivot, about, mm; infinite on a line of travel."""
        return math.inf

    @abstractmethod
    def drives(self, contour: Contour) -> Sequence[Excitation]:
        """Own position of each contact over the shaft angle as it rests on a contour, m or rad."""

    @abstractmethod
    def pressed(self, contour: Contour, phi: Array) -> tuple[Array, Array]:
        """Pressure angle at contact 1 and the contour's radius of curvature there, (n,) each, at shaft angles phi (n,).

        The angle, rad, is that from the contour's outward normal counter-clockwise to the way in which the touch
        travels outwards: above 0 where the cam drives a rise. The radius, mm, is 0 at a corner, negative in a hollow
        and infinite on a line.
        """

    def contact_travel(self, contour: Contour) -> tuple[float, float] | None:  # noqa: ARG002
        """Least and greatest place of contact 1 along a flat face over the turn, mm; None of a round touch.

        On a line of travel it counts from the stem's axis, above 0 ahead of it; on an arm from the pivot's foot on the
        face.
        """
        return None

    @abstractmethod
    def touching(self, points: Array, normals: Array) -> list[tuple[Array, Array]]:
        """Shaft angle and the follower's position (n,) with each contact touching metal at points (n, 2), mm.

        `normals` (n, 2) are outward of the contour; angles and positions are radians or mm, nan out of reach.
        """

    def resting(self, contour: Contour) -> list[Shifted]:
        """Drives of the follower's position, m or rad, one for each of its contacts as it rests on a contour alone."""
        each = zip(self.contacts, self.drives(contour), strict=True)
        return [
            Shifted(drive, float(contact.sense), -contact.sense * self.si * contact.zero) for contact, drive in each
        ]

    @abstractmethod
    def judge(self, contour: Contour, phi: Array) -> Judged:
        """Motion error and play; rms and increments are from the shaft angles phi (n,).

        ContactError where the follower finds no contact.
        """

    @abstractmethod
    def motion_limit(self, tolerance: float) -> float:
        """Greatest motion error, mm or degrees, of a contour within `tolerance` of the exact one."""

    def direct_limit(self, tolerance: float) -> float:
        """Greatest motion error, mm or degrees, of a contour within `tolerance`, mm, at a pressure angle of 0.

        On a flat face of an arm it is that at the greatest distance from the pivot.
        """
        return math.degrees(self.moved_by(tolerance)) if self.unit == "deg" else tolerance


@dataclass(frozen=True, eq=False)
class Moved(Follower):
    """A follower on a guide or an arm, whose intended motion runs over a parameter that its envelope shares."""

    @property
    @abstractmethod
    def course(self) -> IntendedLaw:
        """The intended motion over the shaft angle, as contact is followed along it."""

    @property
    @abstractmethod
    def breaks(self) -> Array:
        """Parameters in [0, 2 pi) at which the second derivative may jump, rising."""

    @abstractmethod
    def over(self, parameter: Array) -> tuple[Array, Array]:
        """Shaft angle and position with two derivatives by the parameter, (3, n) each."""


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
        """Law with proved bounds of its derivatives, along which contact is followed."""
        from kin.follower.laws import ByLaw

        return ByLaw(self.law)

    @cached_property
    def rests(self) -> Rests:
        """Dwells of the law."""
        return tuple(dwells_of_law(self.law))

    @property
    def breaks(self) -> Array:
        """Breaks of the law (k,), rad."""
        return self.law.breaks

    def over(self, parameter: Array) -> tuple[Array, Array]:
        """Shaft angle and position, with two derivatives by the parameter: (3, n) each."""
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
        """Swing over the shaft angle with proved bounds of its derivatives, along which contact is followed."""
        return self.motion

    @cached_property
    def rests(self) -> Rests:
        """Dwells of psi over the shaft angle."""
        return tuple(dwells_of_transmission(self.transmission))

    @property
    def breaks(self) -> Array:
        """Breaks of the transmission (k,), rad."""
        return self.transmission.breaks

    def over(self, parameter: Array) -> tuple[Array, Array]:
        """Shaft angle and swing, with two derivatives by the parameter: (3, n) each."""
        phi, psi = self.transmission.at(parameter, 2)
        return phi, self.share * psi

    def shaft_angle(self, parameter: Array) -> Array:
        """Shaft angle at which contact A touches the envelope's point of that parameter (n,)."""
        phi: Array = self.transmission.at(parameter, 0)[0][0]
        return phi
