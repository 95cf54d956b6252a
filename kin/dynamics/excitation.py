"""The motions that drive a follower train: as intended, or as a file's contour gives them by contact.

Every motion is in SI, metres or radians, and pushes towards greater positions. A follower that is held from two sides
has two motions: of the face that pushes it up, and of the face that keeps it below.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from kin.follower.drive import Shifted
from kin.law.contacts import METRE
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.follower.base import Follower
    from kin.follower.drive import Excitation
    from kin.linkage.mechanism import Mechanism
    from kin.numeric.arrays import Array


class Faces(NamedTuple):
    """Faces that hold a follower: `lower` pushes it up, `upper` pushes it down; None with a spring in its place."""

    lower: Excitation
    upper: Excitation | None


@dataclass(frozen=True, eq=False)
class Intended:
    """Intended motion of a follower as an excitation, smooth between its breaks."""

    follower: Follower
    smooth: ClassVar[bool] = True

    @property
    def breaks(self) -> Array:
        """Shaft angles (m,), rad, at which the acceleration or one of its derivatives may jump."""
        return self.follower.motion.breaks

    def rows(self, phi: Array) -> Array:
        """Position and two derivatives by the shaft angle, (3, n), at shaft angles phi (n,): m or rad."""
        return self.follower.si * self.follower.motion.derivatives(phi, 2)


@dataclass(frozen=True, eq=False)
class OfMechanism:
    """Intended output of a mechanism over its shaft angle, as an excitation."""

    mechanism: Mechanism
    smooth: ClassVar[bool] = True

    @property
    def _unit(self) -> float:
        return METRE if self.mechanism.unit == "mm" else 1.0

    @cached_property
    def breaks(self) -> Array:
        """Shaft angles, rad (m,), of the lift's breaks at either face that drives the frame."""
        shaft: Array = self.mechanism.at(self.mechanism.breaks, 0).shaft[0]
        return shaft

    def rows(self, phi: Array) -> Array:
        """Output and two derivatives by the shaft angle, (3, n), at shaft angles phi (n,): m or rad."""
        at = self.mechanism.at(self.mechanism.relative(phi), 2)
        rows: Array = self._unit * at.over_shaft(at.output)
        return rows


def intended_faces(follower: Follower, play: float | None) -> Faces:
    """Faces of the intended motion: one under a spring where `play` is None, else two, `play` apart, m or rad.

    With a spring a double follower rests on its first face or roller.
    """
    motion: Excitation = Intended(follower)
    if play is None:
        first = follower.contacts[0].sense
        return Faces(motion if first > 0 else Shifted(motion, -1.0), None)
    return Faces(motion, Shifted(motion, 1.0, play))


def measured_faces(follower: Follower, contour: Contour, play: float | None) -> Faces:
    """Faces of the motion that a file's contour gives by contact: one under a spring where `play` is None, else two.

    `play`, m or rad, is that of the intended contour: a contour that is too large takes from it. Flat faces follow
    every piece as it is; under a roller splines are arcs. Raises ContactError where the follower finds no contact,
    ValueError for play with a follower of one contact.
    """
    contacts = follower.contacts
    if play is not None and len(contacts) == 1:
        raise ValueError("a follower of one contact has no backlash")
    rests = follower.resting(contour)
    if play is None:
        # it counts away from the cam, whichever way the follower's position counts; both are 0 at the same place
        return Faces(replace(rests[0], sign=1.0, offset=contacts[0].sense * rests[0].offset), None)
    # one contact pushes it up, the other keeps it below
    lower, upper = sorted(rests, key=lambda rest: -rest.sign)
    return Faces(lower, replace(upper, offset=upper.offset + play))
