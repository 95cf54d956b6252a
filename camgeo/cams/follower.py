"""The follower of a cam, by its contacts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from kin.law.contacts import Arrangement, Flat, Translating
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.contacts import Contact, Guide, Side, Touch


@dataclass(frozen=True)
class Follower:
    """A follower: its name in reports, its contacts, the checks of its intended motion in their order.

    `closure` names the check of the play or interference that a file leaves a follower held from both sides; it is
    empty for a follower held by a spring or gravity.
    """

    name: str
    contacts: tuple[Contact[Guide, Touch], ...]
    checks: tuple[str, ...]
    closure: str = ""

    @property
    def arrangement(self) -> Arrangement:
        """Classes of guide and touch, number of places at which the follower touches, number of discs.

        A roller between two flanks of a groove touches at one place.
        """
        first = self.contacts[0]
        places, surfaces = {contact.place for contact in self.contacts}, {contact.surface for contact in self.contacts}
        return Arrangement(type(first.guide), type(first.touch), len(places), min(len(places), len(surfaces)))

    def sense(self, surface: str) -> Side:
        """Sense in which the surface of this name pushes the follower: out, 1, or back, -1.

        Raises StopIteration for a name that no contact has.
        """
        return next(contact.sense for contact in self.contacts if contact.surface == surface)

    def running(self, contact: Contact[Guide, Touch]) -> Touch:
        """The real touch at the place of a contact of this follower, whose own touch may be a wider gauge."""
        return next(first.touch for first in self.contacts if first.place == contact.place)

    @property
    def width(self) -> float | None:
        """Width of a flat face, mm, centred on the axis of its stem; None without a width and for a round touch."""
        touch = self.contacts[0].touch
        return touch.width if isinstance(touch, Flat) else None

    @property
    def lean(self) -> float:
        """Tangent of the pressure angle at which a round touch on an eccentric stem begins to rise; 0 on an arm."""
        first = self.contacts[0]
        return abs(first.guide.offset) / first.datum if isinstance(first.guide, Translating) and first.datum else 0.0

    @property
    def pivot(self) -> float:
        """Distance of an arm's pivot from the shaft, mm; infinite for a stem."""
        guide = self.contacts[0].guide
        return math.inf if isinstance(guide, Translating) else guide.pivot

    @property
    def offset(self) -> float:
        """Eccentricity of a stem's line of travel, mm, above 0 where the surface comes from; 0 for an arm."""
        guide = self.contacts[0].guide
        return guide.offset if isinstance(guide, Translating) else 0.0

    @property
    def breadth(self) -> float | None:
        """Distance between the two parallel faces of a yoke, mm; None for other followers.

        For faces on conjugate discs it is the distance of the second face from the shaft at displacement 0.
        """
        *_, last = self.contacts
        return last.datum if last.sense < 0 and isinstance(last.touch, Flat) and last.guide.unit == "mm" else None
