"""Bodies of a linkage under construction, one above another: levels, posts, rails, and links that carry others."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.mechanism.assembly import GROUND, BodyFit, Member, Plate
from camgeo.capabilities.mechanism.shaft import CLIP_COLOUR
from camgeo.capabilities.mechanism.shapes import bar, bars, box, pin, retainer, transformed
from camgeo.capabilities.mechanism.sizes import BodyError
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.capabilities.mechanism.poses import Links
    from camgeo.capabilities.mechanism.shapes import Point
    from camgeo.capabilities.mechanism.sizes import Sizes
    from camgeo.fit.pieces import ArcSpline
    from kin.numeric.arrays import Array

PLACES = 720  # of a turn, at which extents of a body's motion are sampled
BLOCK = 1.5  # length of a block or slide, in widths
FRAME_COLOUR, ROCKER_COLOUR, BLOCK_COLOUR = "#4f8f5f", "#8a6fb0", "#b0566a"


@dataclass()
class Carrier:
    """A moving body under construction, between z = `low` and `high`; mm.

    `origin` is the origin of the link's axes, and `holes` are middles of holes for pins, both in the body's axes. Bars
    that are added leave the holes free.
    """

    name: str
    plates: list[Plate]
    place: Place
    low: float
    high: float
    colour: str = ROCKER_COLOUR
    origin: Point = (0.0, 0.0)
    holes: tuple[Point, ...] = ()

    def extend(self, point: Point, s: Sizes, field_path: str) -> Point:
        """Add a bar from the link's origin to a point in the link's axes, mm; return the point in the body's axes.

        Raises BodyError, at the recipe's field `field_path`, where the bar would cut a hole.
        """
        end = (self.origin[0] + point[0], self.origin[1] + point[1])
        try:
            self.plates += bars(s, [(self.origin, end)], self.holes, self.low, self.high)
        except ValueError as error:
            raise BodyError(field_path, str(error), "move the point, or give a smaller mechanism.bar") from error
        return end


class Mount(NamedTuple):
    """A point of a carrier, in the body's axes, to which another body is attached."""

    carrier: Carrier
    point: Point

    def add_pin(self, site: BodyStack, name: str, low: float, high: float) -> None:
        """Add a pin at the mount for a body `name` between z = `low` and `high`, mm, and its retainer to `site`."""
        self.carrier.plates += pin(site.s, self.point, self.carrier.high, low, high)
        site.add_retainer(name, self.carrier.name, self.point, high, self.carrier.place)


@dataclass()
class BodyStack:
    """Bodies of a linkage under construction, one above another; mm.

    `next_low` is the z at which the next body may begin, `width` the width of the base plate's arms. `members` are
    bodies that are not extended, such as retainers; `ground` are plates on the base, `pads` outlines of the base.
    """

    s: Sizes
    links: Links
    next_low: float
    width: float
    carriers: list[Carrier] = field(default_factory=list)
    members: list[Member] = field(default_factory=list)
    ground: list[Plate] = field(default_factory=list)
    pads: list[ArcSpline] = field(default_factory=list)
    fits: list[BodyFit] = field(default_factory=list)

    def level(self) -> tuple[float, float]:
        """Take the next level: z of a link's lower and upper face, mm; the level above it clears its retainers."""
        low = self.next_low
        high = low + self.s.link
        self.next_low = high + 2.0 * self.s.gap + self.s.clip
        return low, high

    def add(self, carrier: Carrier) -> Carrier:
        """Add a moving body, and return it."""
        self.carriers.append(carrier)
        return carrier

    def all_members(self) -> tuple[Member, ...]:
        """All bodies but cam, shaft, the shaft's retainer and base."""
        moving = (Member(c.name, tuple(c.plates), c.name, c.place, c.colour) for c in self.carriers)
        return (*moving, *self.members)

    def add_retainer(
        self, name: str, group: str, centre: Point, high: float, place: Place | None = None, *, radius: float = 0.0
    ) -> None:
        """Add the retainer on a pin at `centre` of the body `group`, above a body that ends at z = `high`, mm.

        The pin moves with `place`, None at rest; `radius`, mm, is the retainer's least.
        """
        plates = retainer(self.s, centre, high, radius=radius)
        self.members.append(Member(f"retainer-{name}", plates, group, place, CLIP_COLOUR))

    def add_post(self, name: str, centre: Point, low: float, high: float, *, radius: float = 0.0) -> None:
        """Add a pivot on the base at `centre` for a body between z = `low` and `high`, mm, with retainer and base arm.

        `radius`, mm, is the retainer's least.
        """
        self.ground += pin(self.s, centre, self.s.plate, low, high)
        self.pads.append(bar((0.0, 0.0), centre, self.width))
        self.add_retainer(name, GROUND, centre, high, radius=radius)

    def sample(self, place: Place) -> Array:
        """Positions x, y and angle (PLACES, 3) of a body at equal steps of a turn, mm and rad."""
        poses: Array = place(TURN * np.arange(PLACES) / PLACES, 0)[:, 0].T
        return poses

    def add_rails(self, place: Place, point: Point, angle: float) -> None:
        """Add two rails on the base for a slide with a `place`, on a line through `point`, mm, at `angle`, rad.

        The rails reach over the slide's travel; a pad under them is joined to the base.
        """
        s = self.s
        x, y = (self.sample(place)[:, :2] - point).T
        along = x * np.cos(angle) + y * np.sin(angle)
        margin = 0.5 * BLOCK * s.bar + s.space
        first, last = float(along.min()) - margin, float(along.max()) + margin
        inner = 0.5 * s.bar + s.gap_each_side
        outer = inner + s.wall
        for side in (-1.0, 1.0):
            y0, y1 = sorted((side * inner, side * outer))
            rail = transformed(box(first, y0, last, y1), *point, angle)
            self.ground.append(Plate(rail, (), s.plate, s.plate + s.gap + s.link))
        self.ground.append(Plate(transformed(box(first, -outer, last, outer), *point, angle), (), 0.0, s.plate))
        middle = 0.5 * (first + last)
        centre = (point[0] + middle * float(np.cos(angle)), point[1] + middle * float(np.sin(angle)))
        self.pads.append(bar((0.0, 0.0), centre, self.width))

    def slide(self, low: float, high: float) -> list[Plate]:
        """Plates of a slide on the base, with a pin in its middle for a body between z = `low` and `high`, mm."""
        s = self.s
        foot = s.plate + s.gap
        body = Plate(block(s), (), foot, foot + s.link)
        return [body, *pin(s, (0.0, 0.0), foot + s.link, low, high)]


def block(s: Sizes) -> ArcSpline:
    """Outline of a block about its origin, mm."""
    half = 0.5 * BLOCK * s.bar
    return box(-half, -0.5 * s.bar, half, 0.5 * s.bar)


def slotted_bar(first: float, last: float, y: float, s: Sizes) -> tuple[ArcSpline, ArcSpline]:
    """Outlines of a bar along x about y, and of its slot for a block whose middle runs from x = `first` to `last`."""
    margin = 0.5 * BLOCK * s.bar + s.space
    inner = 0.5 * s.bar + s.gap_each_side
    slot = box(first - margin, y - inner, last + margin, y + inner)
    margin, outer = margin + s.wall, inner + s.wall
    return box(first - margin, y - outer, last + margin, y + outer), slot
