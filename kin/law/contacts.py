"""What touches a cam, as data: guides, touches, contacts, arrangements; one record for making a cam and judging it.

Lengths are mm, angles radians. The frame runs round the standing cam by the shaft angle, and a guide stands in it: a
line of travel along its x axis, or a pivot on that axis. A contact's own position on its guide grows away from the
shaft: the distance along the line from the foot of the shaft, or the angle at the pivot between the line to the shaft
and the arm, which of a flat face is its own parallel through the pivot.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, Generic, Literal, TypeAlias, TypeVar

from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

Side: TypeAlias = Literal[-1, 1]
Unit: TypeAlias = Literal["mm", "deg"]
METRE = 1e-3  # a millimetre in metres
TRAILING: Side = 1
LEADING: Side = -1


@dataclass(frozen=True)
class Translating:
    """A line of travel that passes the shaft at `offset`, mm, positive on the side from which the surface comes."""

    offset: float = 0.0
    unit: ClassVar[Unit] = "mm"
    word: ClassVar[str] = "translating"


@dataclass(frozen=True)
class Oscillating:
    """An arm about a pivot `pivot` mm from the shaft; `length`, mm, to the touch's centre, None for a flat face.

    `side` is TRAILING where the cam is touched clockwise of the pivot as drawn, LEADING where it is on the other side.
    """

    pivot: float
    side: Side = TRAILING
    length: float | None = None
    unit: ClassVar[Unit] = "deg"
    word: ClassVar[str] = "oscillating"

    @property
    def arm(self) -> float:
        """Length of the arm of a round touch, mm; raises ValueError for the arm of a flat face, which has none."""
        if self.length is None:
            raise ValueError("the arm of a round touch has a length")
        return self.length


@dataclass(frozen=True)
class Roller:
    """A roller on a pin, which the cam turns; `radius` in mm."""

    radius: float
    word: ClassVar[str] = "roller"
    centred: ClassVar[bool] = True


@dataclass(frozen=True)
class KnifeEdge:
    """Touch of a knife edge: a point."""

    radius: ClassVar[float] = 0.0
    word: ClassVar[str] = "knife edge"
    centred: ClassVar[bool] = True


@dataclass(frozen=True)
class Shoe:
    """A curved shoe that slides on the cam; `radius` in mm."""

    radius: float
    word: ClassVar[str] = "shoe"
    centred: ClassVar[bool] = True


@dataclass(frozen=True)
class Flat:
    """A flat face, along an arm, or on a line of travel with its normal `tilt`, rad, ahead of the line.

    `width`, mm, is centred on the stem's axis, None for a face as wide as it needs to be. A face on an arm is `nearer`,
    mm, to the shaft than its parallel through the pivot.
    """

    tilt: float = 0.0
    width: float | None = None
    nearer: float = 0.0
    radius: ClassVar[float] = 0.0
    word: ClassVar[str] = "flat face"
    centred: ClassVar[bool] = False


Guide: TypeAlias = Translating | Oscillating
Touch: TypeAlias = Roller | KnifeEdge | Shoe | Flat
G_co = TypeVar("G_co", bound=Guide, covariant=True)
T_co = TypeVar("T_co", bound=Touch, covariant=True)
TouchT = TypeVar("TouchT", bound=Touch)


@dataclass(frozen=True)
class Contact(Generic[G_co, T_co]):
    """One touch of a follower, which at shaft angle phi is where its guide stands at phi + turned.

    Its own position is datum - apart + sense * the follower's position: a sense of 1 pushes the follower towards
    greater positions, -1 towards lesser ones. `datum` is its own position at the follower's zero (foot, rest or level
    in a recipe), from which `apart` is taken where two contacts share a guide; both in mm or rad. `surface` is the name
    of the surface that is touched, empty where the cam has one.
    """

    guide: G_co
    touch: T_co
    datum: float = 0.0
    sense: Side = 1
    apart: float = 0.0
    turned: float = 0.0
    surface: str = ""

    @property
    def zero(self) -> float:
        """Own position, mm or rad, of the contact where the follower's position is 0."""
        return self.datum - self.apart

    def position(self, own: Array) -> Array:
        """Position of the follower (n,), mm or rad, at the contact's own position (n,): the inverse of `own`."""
        position: Array = self.sense * (own - self.datum + self.apart)
        return position

    def own(self, position: Array) -> Array:
        """Own position of the contact (n,), mm or rad, at the follower's position (n,): zero + sense * position."""
        own: Array = self.zero + self.sense * position
        return own

    def away_from(self, side: Side) -> Contact[G_co, T_co]:
        """Give the contact with its own position counted away from metal inside (1) or outside (-1) the contour."""
        sense: Side = 1 if self.sense == side else -1
        return replace(self, datum=side * self.datum, apart=side * self.apart, sense=sense)

    @property
    def place(self) -> Contact[Guide, Touch]:
        """Contact with the touch and the surface left out: equal for two contacts of one roller on two surfaces."""
        return Contact(self.guide, KnifeEdge(), self.datum, self.sense, self.apart, self.turned)

    def raised(self, by: float) -> Contact[G_co, T_co]:
        """Give the contact for follower's positions that count from a zero lower by `by`, mm or rad."""
        return replace(self, datum=self.datum - self.sense * by)


def eased_contact(contact: Contact[Guide, Touch], clearance: float) -> Contact[Guide, Touch]:
    """The contact of a gauge that stands off by `clearance`, mm, along its normal: metal grown by as much just fits it.

    Raises ValueError for a knife edge, and for a radius that is not above the clearance.
    """
    match contact.guide, contact.touch:
        case Oscillating(), Flat(nearer=nearer):
            return replace(contact, touch=replace(contact.touch, nearer=nearer - clearance))
        case Translating(), Flat(tilt=tilt):
            return replace(contact, datum=contact.datum + clearance / math.cos(tilt))
        case _, Roller(radius=radius) | Shoe(radius=radius) if radius > clearance:
            return replace(contact, touch=replace(contact.touch, radius=radius - clearance))
    raise ValueError(f"nothing is left of the {contact.touch.word}")


def opposite(touch: TouchT, apart: float, datum: float = 0.0) -> tuple[Contact[Translating, TouchT], ...]:
    """Two contacts of a frame on a line through the shaft, `apart` mm from each other, the second half a turn on.

    `datum`, mm, is that of the first; the second has apart - datum.
    """
    guide = Translating()
    return Contact(guide, touch, datum), Contact(guide, touch, apart - datum, -1, turned=math.pi)


def on_one_arm(
    pivot: float, length: float | None, touch: TouchT, datum: float, apart: float
) -> tuple[Contact[Oscillating, TouchT], ...]:
    """Contact A, which trails the pivot and limits the swing, and B, which leads the pivot and pushes the swing on.

    `pivot` and `length` are mm, None for faces; `datum` and `apart`, rad, are those of both contacts.
    """
    return (
        Contact(Oscillating(pivot, TRAILING, length), touch, datum, -1, apart),
        Contact(Oscillating(pivot, LEADING, length), touch, datum, 1, apart),
    )


@dataclass(frozen=True)
class Arrangement:
    """A recipe's follower before anything is computed: class of guide, class of touch, greatest number of contacts.

    `discs` is the number of discs that the contacts touch. Two contacts on one disc need a law that suits both; on two
    discs each follows the law of one contact.
    """

    guide: type[Guide]
    touch: type[Touch]
    contacts: int = 1
    discs: int = 1

    @property
    def unit(self) -> Unit:
        """Unit of the follower's position and of motion errors."""
        return self.guide.unit

    @property
    def backlash_unit(self) -> Unit:
        """Unit of the backlash of a follower held from both sides: deg for faces on arms, else mm."""
        return self.unit if self.touch is Flat else "mm"

    @property
    def offers(self) -> frozenset[str]:
        """Names of the properties that decide which figures and options the follower has.

        Contacts are counted on each disc: followers of a pair of discs have one, also where both are on one arm.

        swings          two contacts on one arm
        plate           two faces on a line of travel, as a linkage's frame has
        guided          neither `swings` nor `plate`: a stem or an arm of its own
        roller, face    a round touch; a flat touch (not two on an arm)
        rolling         a roller that the cam turns (not two on an arm)
        led             on a line of travel
        stem, arm       one round contact on a line of travel; one contact on an arm
        stem-face       one flat contact on a line of travel
        """
        stem, flat, two = self.guide is Translating, self.touch is Flat, self.contacts > self.discs
        swings, plate = two and not stem, two and stem and flat
        sides = {
            "swings": swings,
            "plate": plate,
            "guided": not (swings or plate),
            "roller": not flat,
            "rolling": self.touch is Roller and not swings,
            "led": stem,
            "stem": stem and not flat and not two,
            "arm": not stem and not two,
            "face": flat and not swings,
            "stem-face": stem and flat and not two,
        }
        return frozenset(name for name, holds in sides.items() if holds)
