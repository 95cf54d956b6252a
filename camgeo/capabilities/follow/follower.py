"""The follower that a call describes: one contact, or two opposite ones, and the keys of a recipe that describe it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.common.errors import CallError
from camgeo.schema.fields import MOST
from kin.law.contacts import LEADING, TRAILING, Contact, Flat, KnifeEdge, Oscillating, Roller, Translating
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.contacts import Guide, Touch


@dataclass(frozen=True)
class FollowerAsked:
    """A follower in the words of a call; lengths in mm.

    roller   radius of its roller, 0 for a knife edge; None for a flat face
    offset   of its line of travel from the shaft, above 0 on the side from which the surface comes
    pivot    distance of its arm's pivot from the shaft; None on a stem
    length   of its arm to the roller's centre; None of a flat face
    leading  whether the arm leads, where it trails else
    yoke     whether a second contact stands opposite, in one frame with the first
    """

    roller: float | None
    offset: float = 0.0
    pivot: float | None = None
    length: float | None = None
    leading: bool = False
    yoke: bool = False

    def demand_sound(self) -> None:
        """Raise CallError with all that does not go together."""
        flat, arm = self.roller is None, self.pivot is not None
        faults = []
        for name, value in (
            ("roller", self.roller),
            ("offset", self.offset),
            ("arm", self.pivot),
            ("arm", self.length),
        ):
            if value is not None and not (math.isfinite(value) and abs(value) <= MOST):
                faults.append(f"{name} is a length of at most {MOST:.10g} mm, not {value!r}")
        if self.roller is not None and not self.roller >= 0.0:
            faults.append(f"a roller has a radius of 0 or above, not {self.roller!r}; 0 is a knife edge")
        if self.pivot is not None and not self.pivot > 0.0:
            faults.append(f"an arm's pivot stands at a distance above 0 from the shaft, not {self.pivot!r}")
        if arm and not flat and not (self.length is not None and self.length > 0.0):
            faults.append("an arm with a roller has a length: give arm as pivot distance and length, 80,65")
        if arm and flat and self.length is not None:
            faults.append("an arm with a flat face has no length: give arm as the pivot's distance alone")
        if arm and self.offset:
            faults.append("an arm has no offset: leave one of them out")
        if self.leading and not arm:
            faults.append("only an arm leads: leave leading out, or give arm")
        if self.yoke and (arm or self.offset):
            faults.append("a yoke travels on a line through the shaft: leave arm and offset out")
        if faults:
            raise CallError(*faults)

    @property
    def guide(self) -> Guide:
        """Line of travel or arm."""
        if self.pivot is None:
            return Translating(self.offset)
        return Oscillating(self.pivot, LEADING if self.leading else TRAILING, self.length)

    @property
    def touch(self) -> Touch:
        """Roller, knife edge or flat face."""
        if self.roller is None:
            return Flat()
        return Roller(self.roller) if self.roller else KnifeEdge()

    @property
    def contacts(self) -> tuple[Contact[Guide, Touch], ...]:
        """The contact, and of a yoke the opposite one."""
        first = Contact(self.guide, self.touch)
        second = Contact(self.guide, self.touch, sense=-1, turned=math.pi)
        return (first, second) if self.yoke else (first,)

    @property
    def words(self) -> str:
        """What it is called in a line of text."""
        touch = {None: "flat face", 0.0: "knife edge"}.get(self.roller, f"roller of radius {self.roller or 0.0:.6g} mm")
        if self.yoke:
            return f"yoke, {touch}"
        if self.pivot is None:
            return f"{touch} on a stem" + (f", offset {self.offset:.6g} mm" if self.offset else "")
        long = "" if self.length is None else f" of {self.length:.6g} mm"
        return f"{touch} on a {'leading' if self.leading else 'trailing'} arm{long}, pivot at {self.pivot:.6g} mm"

    def base_radius(self, least: float) -> float:
        """Base radius, mm, of the cam on which it stands at a least position, mm or rad."""
        radius = self.roller or 0.0
        if self.pivot is None:
            return least if self.roller is None else math.hypot(least, self.offset) - radius
        if self.length is None:
            return self.pivot * math.sin(least)
        far = self.pivot**2 + self.length**2 - 2.0 * self.pivot * self.length * math.cos(least)
        return math.sqrt(far) - radius

    @property
    def keys(self) -> str:
        """What a recipe has below `cam.follower`, on one line."""
        kind = {None: "kind: flat", 0.0: "kind: knife-edge"}.get(self.roller, f"kind: roller, radius: {self.roller!r}")
        if self.pivot is None:
            return f"{{{kind}, offset: {self.offset!r}}}" if self.offset else f"{{{kind}}}"
        long = "" if self.length is None else f"length: {self.length!r}, "
        side = "leading" if self.leading else "trailing"
        return f"{{{kind}, arm: {{{long}pivot: {self.pivot!r}, side: {side}}}}}"
