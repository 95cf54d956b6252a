"""Conjugate discs: a second contact of the same stem or arm on a disc of its own, which drives the follower back.

The second roller stands `apart` from the first with the shaft between them, the second arm of a bell crank at that
angle from the first, a second face opposite it (Wunderlich 1971, section 1, the "second cam integral with the first").
Its own position is what the first one's leaves of that, so that on its own disc it is a follower as any: on a stem half
a turn on, with the offset on the other side; on an arm that leads where the first one trails.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.common.rounding import upward
from camgeo.schema.fields import MOST, Field, Kind, length, mapping
from kin.law.contacts import LEADING, TRAILING, Contact, Flat, Oscillating, Translating
from kin.law.programme import IntentError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values
    from kin.law.contacts import Guide, Touch

FIRST, SECOND = "disc 1", "disc 2"
"""Names of the two surfaces."""


@dataclass(frozen=True)
class Conjugate:
    """The second contact: its touch, how far `apart` it stands, mm or rad, the length of its arm and the gap, mm."""

    touch: Touch
    apart: float
    length: float | None = None
    gap: float = 0.0

    def contacts(self, first: Contact[Guide, Touch]) -> tuple[Contact[Guide, Touch], ...]:
        """Both contacts of the follower."""
        guide, datum = first.guide, self.apart - first.datum
        if isinstance(guide, Translating):
            turned = Contact(Translating(-guide.offset), self.touch, datum, -1, turned=math.pi, surface=SECOND)
            return replace(first, surface=FIRST), turned
        side = LEADING if guide.side == TRAILING else TRAILING
        arm = Oscillating(guide.pivot, side, self.length)
        return replace(first, surface=FIRST), Contact(arm, self.touch, datum, -1, surface=SECOND)

    def demand(self, first: Contact[Guide, Touch], greatest: float) -> None:
        """Raise IntentError where disc 2 has no base circle at the follower's greatest displacement, mm or rad."""
        _, second = self.contacts(first)
        radius, guide = self.touch.radius, second.guide
        if isinstance(guide, Translating):
            # where the roller's centre passes the shaft nearer than its radius no contour is left
            nearest = 0.0 if isinstance(self.touch, Flat) else math.sqrt(max(radius**2 - guide.offset**2, 0.0))
            if not second.datum - greatest > nearest:
                least = first.datum + greatest + nearest
                raise IntentError(
                    f"disc 2 would have no base circle at the greatest displacement; a distance above "
                    f"{upward(least)} mm leaves one",
                    "conjugate.distance",
                )
            return
        nearest = _swing(guide.pivot, guide.arm, radius)
        if not second.datum - greatest > nearest:
            least = math.degrees(first.datum + greatest + nearest)
            raise IntentError(
                f"disc 2 would have no base circle at the greatest displacement; an angle above {upward(least)} "
                "degrees leaves one",
                "conjugate.angle",
            )

    def scaled(self, touch: Touch, scale: float, wider: float = 0.0) -> Conjugate:
        """The pair drawn larger, with another touch; two faces are `wider` apart before, mm."""
        if self.length is None:
            return Conjugate(touch, scale * (self.apart + wider), None, scale * self.gap)
        return Conjugate(touch, self.apart, scale * self.length, scale * self.gap)


def _swing(pivot: float, arm: float, radius: float) -> float:
    """Angle at the pivot, rad, at which an arm's end is a radius from the shaft; 0 where it never is."""
    cosine = (pivot**2 + arm**2 - radius**2) / (2.0 * pivot * arm)
    return math.acos(cosine) if cosine < 1.0 else 0.0


# --- in a recipe ------------------------------------------------------------------------------------------------------

CONJUGATE = mapping(
    "conjugate",
    "a second disc on the same shaft, whose contact on the same stem or arm drives the follower back",
    length("radius", "radius of the second roller or shoe", default="that of the follower"),
    length("distance", "on a stem, between the rollers' centres with the shaft between them, or between the faces"),
    length("length", "of the second arm of a bell crank, from the pivot to the roller's centre"),
    Field("angle", Kind.ANGLE, "at the pivot between both arms, the shaft's line within it", above=0, at_most=359),
    Field("gap", Kind.LENGTH, "from the top face of disc 1 to disc 2 above it", default="0", at_least=0, at_most=MOST),
)


def check_conjugate(cam: Values, reader: Reader) -> None:
    """Note what does not go with a second disc, and what it lacks."""
    follower, here = cam.get("follower", {}), "cam.conjugate"
    kind, arm, given = follower.get("kind", "roller"), "arm" in follower, cam["conjugate"]
    if "track" in cam and cam["track"] != "external":
        reader.fault_at("cam.track", "conjugate discs are followed from outside", None, "leave it out, or conjugate")
        return
    if kind == "knife-edge" or (kind == "flat" and arm):
        remedy = "give a roller, or leave conjugate out"
        what = "a knife edge" if kind == "knife-edge" else "a flat face on an arm"
        reader.fault_at("cam.follower.kind", f"{what} has no conjugate disc", None, remedy)
        return
    if kind == "flat" and follower.get("tilt", 0.0):
        reader.fault_at("cam.follower.tilt", "two faces on conjugate discs stand across the stem", None, "leave it out")
    wanted = {"length", "angle"} if arm else {"distance"}
    for name in ("distance", "length", "angle"):
        if name in wanted and name not in given and f"{here}.{name}" not in reader.marks:
            reader.fault(reader.marks[here], f"{here}.{name}", "missing", None, _WANTED[name])
        elif name in given and name not in wanted:
            held = "an arm" if arm else "a stem"
            reader.fault_at(f"{here}.{name}", f"does not belong to {held}", None, "leave it out")
    if kind == "flat" and "radius" in given:
        reader.fault_at(f"{here}.radius", "a flat face has none", None, "leave it out")


_WANTED = {
    "distance": "give a length above 0, from one contact to the other with the shaft between them",
    "length": "give a length above 0, of the second arm",
    "angle": "give an angle in degrees, at the pivot between both arms",
}


def conjugate_of(values: Values, touch: Touch) -> Conjugate:
    """Make the second contact of values in which there is no fault; its touch is like the first one."""
    if "radius" in values:
        touch = replace(touch, radius=values["radius"])
    apart = values["angle"] if "angle" in values else values["distance"]
    return Conjugate(touch, apart, values.get("length"), values.get("gap", 0.0))
