"""Where bodies of a linkage are put one above another: levels, posts, rails, and links that more hangs on."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.mechanism.assembly import GROUND, Fit, Member
from camgeo.capabilities.mechanism.body import Plate
from camgeo.capabilities.mechanism.shaft import CLIP_COLOUR
from camgeo.capabilities.mechanism.shapes import bar, bars, box, moved, pin, retainer
from camgeo.capabilities.mechanism.sizes import BodyError
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.capabilities.mechanism.link_poses import Links
    from camgeo.capabilities.mechanism.shapes import Point
    from camgeo.capabilities.mechanism.sizes import Sizes
    from camgeo.fit.pieces import ArcSpline
    from kin.numeric.arrays import Array

LOOKS = 720
BLOCK = 1.5  # length of a block or slide, in widths
FRAME_COLOUR, ROCKER_COLOUR, BLOCK_COLOUR = "#4f8f5f", "#8a6fb0", "#b0566a"


@dataclass()
class Carrier:
    """A moving body while it is put together: `origin` is that of the link's own axes in the body's.

    `holes` are those for pins, in the body's axes; what is added leaves them free.
    """

    name: str
    plates: list[Plate]
    place: Place
    low: float
    high: float
    colour: str = ROCKER_COLOUR
    origin: Point = (0.0, 0.0)
    holes: tuple[Point, ...] = ()

    def reach(self, point: Point, s: Sizes, field_path: str) -> Point:
        """Extend the body to a point of the link's axes, and give that in the body's. Raises BodyError."""
        x, y = self.origin
        at = (x + point[0], y + point[1])
        try:
            self.plates += bars(s, [(self.origin, at)], self.holes, self.low, self.high)
        except ValueError as error:
            raise BodyError(field_path, str(error), "move the point, or give a smaller mechanism.bar") from error
        return at


class Mount(NamedTuple):
    """A point of a carrier, in the body's axes, that something hangs on."""

    carrier: Carrier
    point: Point

    def hold(self, site: Site, name: str, low: float, high: float) -> None:
        """Stand a pin there that holds a body between `low` and `high`, with its retainer."""
        self.carrier.plates += pin(site.s, self.point, self.carrier.high, low, high)
        site.hold(name, self.carrier.name, self.point, high, self.carrier.place)


@dataclass()
class Site:
    """What is gathered while links are put one above another.

    `floor` is where the next one may begin, `width` that of the base plate's arms.
    """

    s: Sizes
    links: Links
    floor: float
    width: float
    carriers: list[Carrier] = field(default_factory=list)
    members: list[Member] = field(default_factory=list)
    ground: list[Plate] = field(default_factory=list)
    pads: list[ArcSpline] = field(default_factory=list)
    fits: list[Fit] = field(default_factory=list)

    def level(self) -> tuple[float, float]:
        """Take the next level for a link: its lower and upper face. The one above leaves room for retainers."""
        low = self.floor
        high = low + self.s.link
        self.floor = high + 2.0 * self.s.gap + self.s.clip
        return low, high

    def add(self, carrier: Carrier) -> Carrier:
        """Add a body that moves by itself, and that more may be added to."""
        self.carriers.append(carrier)
        return carrier

    def closed(self) -> tuple[Member, ...]:
        """All bodies but cam, shaft and base."""
        moving = (Member(c.name, tuple(c.plates), c.name, c.place, c.colour) for c in self.carriers)
        return (*moving, *self.members)

    def hold(
        self, name: str, group: str, centre: Point, high: float, place: Place | None = None, *, radius: float = 0.0
    ) -> None:
        """Add the retainer on a pin of a group, of this radius or more, above a body that ends at `high`."""
        plates = retainer(self.s, centre, high, radius=radius)
        self.members.append(Member(f"retainer-{name}", plates, group, place, CLIP_COLOUR))

    def post(self, name: str, centre: Point, low: float, high: float, *, radius: float = 0.0) -> None:
        """Stand a pivot on the base, with its retainer of this radius or more and its share of the base plate."""
        self.ground += pin(self.s, centre, self.s.plate, low, high)
        self.pads.append(bar((0.0, 0.0), centre, self.width))
        self.hold(name, GROUND, centre, high, radius=radius)

    def sampled(self, place: Place) -> Array:
        """Places (n, 3) of a body over a turn."""
        found: Array = place(TURN * np.arange(LOOKS) / LOOKS, 0)[:, 0].T
        return found

    def rails(self, place: Place, point: Point, angle: float) -> None:
        """Lay a guide of two rails on the base, for a slide on a line through a point."""
        s = self.s
        x, y = (self.sampled(place)[:, :2] - point).T
        along = x * np.cos(angle) + y * np.sin(angle)
        over = 0.5 * BLOCK * s.bar + s.space
        first, last = float(along.min()) - over, float(along.max()) + over
        inner = 0.5 * s.bar + s.gap_each_side
        outer = inner + s.wall
        for side in (-1.0, 1.0):
            y0, y1 = sorted((side * inner, side * outer))
            rail = moved(box(first, y0, last, y1), *point, angle)
            self.ground.append(Plate(rail, (), s.plate, s.plate + s.gap + s.link))
        self.ground.append(Plate(moved(box(first, -outer, last, outer), *point, angle), (), 0.0, s.plate))
        middle = 0.5 * (first + last)
        towards = (point[0] + middle * float(np.cos(angle)), point[1] + middle * float(np.sin(angle)))
        self.pads.append(bar((0.0, 0.0), towards, self.width))

    def slide(self, low: float, high: float) -> list[Plate]:
        """Plates of a slide on the base, with the pin that holds a body between `low` and `high`."""
        s = self.s
        foot = s.plate + s.gap
        body = Plate(block(s), (), foot, foot + s.link)
        return [body, *pin(s, (0.0, 0.0), foot + s.link, low, high)]


def block(s: Sizes) -> ArcSpline:
    """Outline of a block about its origin."""
    half = 0.5 * BLOCK * s.bar
    return box(-half, -0.5 * s.bar, half, 0.5 * s.bar)


def slotted(first: float, last: float, y: float, s: Sizes) -> tuple[ArcSpline, ArcSpline]:
    """Outline of a bar along x, and of its slot for a block whose middle runs from `first` to `last`."""
    over = 0.5 * BLOCK * s.bar + s.space
    inner = 0.5 * s.bar + s.gap_each_side
    slot = box(first - over, y - inner, last + over, y + inner)
    over, outer = over + s.wall, inner + s.wall
    return box(first - over, y - outer, last + over, y + outer), slot
