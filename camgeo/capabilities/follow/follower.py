"""The follower of a call: its contacts, its description in words, and its keys in a recipe."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias

from camgeo.common.errors import CallError
from camgeo.schema.fields import MOST
from kin.law.contacts import LEADING, TRAILING, Contact, Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.contacts import Guide, Side, Touch

Track: TypeAlias = Literal["external", "internal", "groove"]
TRACKS: dict[Track, str] = {"external": "", "internal": ", inside a ring", "groove": ", in a groove"}
LENGTHS = 2  # numbers of an arm at most: distance of its pivot, and its own length


@dataclass(frozen=True)
class FollowerDescription:
    """A follower: its touch and its guide, lengths in mm.

    track  external: it runs on the outside of the metal; internal: in the opening of a ring; groove: between two flanks
    yoke   whether a second contact stands opposite, in one frame with the first
    """

    touch: Touch
    guide: Guide
    track: Track = "external"
    yoke: bool = False

    @property
    def flat(self) -> bool:
        """Whether the touch is a flat face."""
        return isinstance(self.touch, Flat)

    @property
    def arm(self) -> Oscillating | None:
        """The arm; None on a stem."""
        return self.guide if isinstance(self.guide, Oscillating) else None

    @property
    def offset(self) -> float:
        """Distance of its line of travel from the shaft, mm, above 0 on the side from which the contour comes.

        It is 0 on an arm.
        """
        return self.guide.offset if isinstance(self.guide, Translating) else 0.0

    @property
    def side(self) -> Side:
        """Side of the contour on which the metal lies: 1 inside, or -1 outside a ring's opening."""
        return -1 if self.track == "internal" else 1

    @property
    def motion_to_mm(self) -> float:
        """Factor from the motion's unit to mm at the touch: 1 on a stem, else the arm's length or pivot distance."""
        return 1.0 if self.arm is None else self.arm.length or self.arm.pivot

    @property
    def contacts(self) -> tuple[Contact[Guide, Touch], ...]:
        """The contact, and for a yoke the opposite one."""
        first = Contact(self.guide, self.touch)
        second = Contact(self.guide, self.touch, sense=-1, turned=math.pi)
        return (first, second) if self.yoke else (first,)

    @property
    def words(self) -> str:
        """The follower in words, for one line of text."""
        radius = f" of radius {self.touch.radius:.6g} mm" if self.touch.radius else ""
        touch = f"{self.touch.word}{radius}"
        if self.yoke:
            return f"yoke, {touch}"
        if self.arm is None:
            offset = f", offset {self.offset:.6g} mm" if self.offset else ""
            return f"{touch} on a stem{offset}{TRACKS[self.track]}"
        length = "" if self.arm.length is None else f" of {self.arm.length:.6g} mm"
        side = "leading" if self.arm.side == LEADING else "trailing"
        return f"{touch} on a {side} arm{length}, pivot at {self.arm.pivot:.6g} mm{TRACKS[self.track]}"

    def base_radius(self, position: float) -> float:
        """Radius, mm, of the circle about the shaft that the follower touches at a position, mm or rad."""
        inward = self.side * self.touch.radius
        if self.arm is None:
            return position if self.flat else math.hypot(position, self.offset) - inward
        pivot, length = self.arm.pivot, self.arm.length
        if length is None:
            return pivot * math.sin(position)
        return math.sqrt(pivot**2 + length**2 - 2.0 * pivot * length * math.cos(position)) - inward

    @property
    def keys(self) -> str:
        """Value of `cam.follower` in a recipe of kind disc, on one line of YAML."""
        keys = [f"kind: {KINDS[self.touch.word]}"]
        if self.touch.radius:
            keys.append(f"radius: {self.touch.radius!r}")
        if isinstance(self.touch, Flat) and self.touch.width is not None:
            keys.append(f"width: {self.touch.width!r}")
        if self.offset:
            keys.append(f"offset: {self.offset!r}")
        if self.arm is not None:
            length = "" if self.arm.length is None else f"length: {self.arm.length!r}, "
            side = "leading" if self.arm.side == LEADING else "trailing"
            keys.append(f"arm: {{{length}pivot: {self.arm.pivot!r}, side: {side}}}")
        return f"{{{', '.join(keys)}}}"


KINDS = {Roller.word: "roller", KnifeEdge.word: "knife-edge", Shoe.word: "shoe", Flat.word: "flat"}


def describe_follower(
    *,
    roller: float | None,
    shoe: float | None,
    flat: bool,
    width: float | None,
    offset: float,
    arm: tuple[float, ...],
    leading: bool,
    yoke: bool,
    track: Track,
) -> FollowerDescription:
    """Follower of a call's arguments, lengths in mm.

    `roller` and `shoe` are radii, a roller of 0 a knife edge; `flat` is a face, of a `width` or None. `offset` is that
    of the line of travel. `arm` is empty on a stem, else the distance of its pivot, and with a round touch its length;
    `leading` is whether it leads. `yoke` is whether a second contact stands opposite. Raises CallError for values that
    are no such lengths, and for arguments that do not go together.
    """
    touches = (roller is not None) + (shoe is not None) + flat
    if touches != 1:
        raise CallError(
            "a follower has a roller, of radius 0 for a knife edge, or a shoe, or is flat: give one of them, such as "
            "--roller 9, --shoe 60 or --flat"
        )
    # faults of single values, then of arguments together
    lengths = {"roller": roller, "shoe": shoe, "width": width, "offset": offset} | {
        f"arm[{i}]": value for i, value in enumerate(arm)
    }
    faults = [
        f"{name.partition('[')[0]} is a length of at most {MOST:.10g} mm, not {value!r}"
        for name, value in lengths.items()
        if value is not None and not (math.isfinite(value) and abs(value) <= MOST)
    ]
    if roller is not None and roller < 0.0:
        faults.append(f"a roller has a radius of 0 or above, not {roller!r}; 0 is a knife edge")
    if shoe is not None and shoe <= 0.0:
        faults.append(f"a shoe has a radius above 0, not {shoe!r}; a knife edge is a roller of radius 0")
    if width is not None and width <= 0.0:
        faults.append(f"a face has a width above 0, not {width!r}")
    if width is not None and (not flat or arm):
        faults.append("only a flat face on a line of travel has a width: leave width out, or give flat without an arm")
    if len(arm) > LENGTHS:
        faults.append("arm is the distance of its pivot from the shaft, and the length of an arm with a round touch")
    if any(value <= 0.0 for value in arm):
        faults.append(f"an arm's pivot and length are lengths above 0, not {', '.join(map(repr, arm))}")
    if arm and flat and len(arm) == LENGTHS:
        faults.append("an arm with a flat face has no length: give arm as the pivot's distance alone")
    if arm and not flat and len(arm) < LENGTHS:
        faults.append("an arm with a round touch has a length: give arm as pivot distance and length, 80,65")
    if arm and offset:
        faults.append("an arm has no offset: leave one of them out")
    if leading and not arm:
        faults.append("only an arm leads: leave leading out, or give arm")
    if yoke and (arm or offset):
        faults.append("a yoke travels on a line through the shaft: leave arm and offset out")
    if track != "external" and (yoke or not roller):
        faults.append(f"{TRACKS[track][2:]} a roller runs: give roller above 0, without yoke, or leave track out")
    if faults:
        raise CallError(*faults)
    if flat:
        touch: Touch = Flat(width=width)
    elif shoe is not None:
        touch = Shoe(shoe)
    else:
        touch = Roller(roller) if roller else KnifeEdge()
    guide: Guide = Translating(offset)
    if arm:
        guide = Oscillating(arm[0], LEADING if leading else TRAILING, None if flat else arm[1])
    return FollowerDescription(touch, guide, track, yoke)
