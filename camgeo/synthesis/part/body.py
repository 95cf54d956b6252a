"""The part of a recipe as geometry: its openings, hub, set screw and chamfer, in the cam's axes and mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.curve.curvature import least_radius
from camgeo.synthesis.part.shapes import Opening, disc, flattened, keyed, polar, polygonal, slot
from camgeo.synthesis.part.walls import contour_gap, distance_inside
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.fit.pieces import ArcSpline
    from camgeo.recipe.part import Hub, Mark, Part, SetScrew
    from camgeo.synthesis.part.lightening import Placed
    from camgeo.synthesis.part.shapes import Layer
    from camgeo.synthesis.part.walls import Looks

STEP = 0.01  # mm: what is placed automatically is placed on whole steps
TRIES = 200  # of moving the mark inward
MARGIN = 1e-9  # mm: rounding of a wall that is just held


@dataclass(frozen=True)
class Unmarked:
    """A mark without room: the greatest of its shape that has some, or the wall, mm, that leaves some to it."""

    mark: Mark
    fits: Mark | None = None
    wall: float = 0.0


@dataclass(frozen=True)
class Body:
    """A part without its contour.

    `openings` from the bore outward; `bore` is its diameter or width; `hub` and `screw` as the recipe has them, None
    without. `placed` says how many lightening holes were asked for and found. `least_radius` is the contour's, mm,
    where it is convex. `outer` is the diameter of a ring, of which the contour is an opening too; None for a disc.
    `unmarked` is a mark that has no room. `pocket` is the depth of what lies between two surfaces, None where that goes
    through or there is none.
    """

    thickness: float | None
    openings: tuple[Opening, ...]
    bore: float | None = None
    hub: Hub | None = None
    screw: SetScrew | None = None
    chamfer: float | None = None
    placed: Placed | None = None
    least_radius: float = math.inf
    outer: float | None = None
    unmarked: Unmarked | None = None
    pocket: float | None = None

    @property
    def rim(self) -> Opening | None:
        """The round outline of a ring; None for a disc, whose contour it is."""
        return None if self.outer is None else disc("outline", "CUT", (0.0, 0.0), 0.5 * self.outer)

    @property
    def fineness(self) -> float:
        """Share of a tolerance within which a polygon must be fitted so that its chamfer's inner edge keeps it too.

        Let f be the polygon's distance from the contour, e at most, and b half its turn at a corner, 4 e = r b^2 for a
        radius of curvature r. Its parallel at the distance c is off by f and by up to c b^2/2 r/(r - c) = 2 e c/(r - c)
        more, to first order.
        """
        share = (self.chamfer or 0.0) / self.least_radius
        return (1.0 - share) / (1.0 + share)

    @property
    def prism(self) -> bool:
        """Whether every section of the part is the same."""
        engraved = any(opening.depth is not None for opening in self.openings)
        return self.hub is None and self.chamfer is None and self.pocket is None and not engraved

    @property
    def bottom(self) -> float:
        """Lowest z, mm: 0 without a hub below the disc."""
        return -self.hub.height if self.hub is not None and self.hub.side != "top" else 0.0

    @property
    def top(self) -> float:
        """Greatest z, mm."""
        above = self.hub.height if self.hub is not None and self.hub.side != "bottom" else 0.0
        return (self.thickness or 0.0) + above

    @property
    def screw_height(self) -> float | None:
        """Height z of the set screw's axis: in the upper hub where there are two; None without one."""
        if self.screw is None or self.hub is None:
            return None
        beyond = 0.5 * self.hub.height if self.screw.height is None else self.screw.height
        return -beyond if self.hub.side == "bottom" else (self.thickness or 0.0) + beyond

    def mirrored(self) -> Body:
        """Mirror about the x axis."""
        screw = None if self.screw is None else replace(self.screw, at=-self.screw.at)
        return replace(self, openings=tuple(opening.mirrored() for opening in self.openings), screw=screw)


def body_of(part: Part, looks: Looks, pocket: float | None = None) -> Body:
    """Make the part of a recipe round a contour; what places itself looks for its place here.

    Raises CurveError where the sharpest place of a contour that is to be chamfered cannot be proved.
    """
    openings = [*_shaft(part), *_drilled(part)]
    hub = None if part.hub is None else disc("hub", "HOLES", (0.0, 0.0), 0.5 * part.hub.diameter)
    edge = part.chamfer or 0.0
    mark = None if part.mark is None else _marked(part.mark, looks, part.wall, edge)
    if isinstance(mark, Opening):
        openings.append(mark)
    placed = None
    if part.lightening is not None:
        from camgeo.synthesis.part.lightening import lightened

        there = openings if hub is None else [*openings, hub]
        found, placed = lightened(part.lightening, looks, there, edge)
        openings += found
    if pocket is not None:
        openings = [replace(one, island=distance_inside(looks, one.middle)[0] > 0.0) for one in openings]
    radius = math.inf if part.chamfer is None else least_radius(looks.contour)[0]
    shaft = (part.bore, part.hub, part.set_screw)
    unmarked = mark if isinstance(mark, Unmarked) else None
    return Body(part.thickness, tuple(openings), *shaft, part.chamfer, placed, radius, part.outer, unmarked, pocket)


def _shaft(part: Part) -> list[Opening]:
    """The bore, with its keyway or flat."""
    if part.bore is None:
        return []
    radius = 0.5 * part.bore
    outline: ArcSpline
    if part.sides:
        outline = polygonal(part.sides, part.bore, part.bore_at)
    elif part.keyway is not None:
        outline = keyed(radius, part.keyway.width, part.keyway.depth, part.keyway.at)
    elif part.flat is not None:
        outline = flattened(radius, part.flat.across, part.flat.at)
    else:
        return [disc("bore", "BORE", (0.0, 0.0), radius)]
    return [Opening("bore", "BORE", outline)]


def _drilled(part: Part) -> list[Opening]:
    """Bolt holes and the dowel's."""
    found = []
    if part.bolts is not None:
        for k in range(part.bolts.count):
            angle = part.bolts.start + 2.0 * math.pi * k / part.bolts.count
            found.append(_round(f"bolt hole {k + 1}", part.bolts.circle, part.bolts.hole, angle))
    if part.dowel is not None:
        found.append(_round("dowel hole", part.dowel.circle, part.dowel.hole, part.dowel.at))
    return found


def _round(name: str, circle: float, hole: float, angle: float) -> Opening:
    return disc(name, "HOLES", polar(0.5 * circle, angle), 0.5 * hole)


def _marked(mark: Mark, looks: Looks, wall: float | None, edge: float) -> Opening | Unmarked:
    """The mark where it is asked for, or as far out on the ray as the wall lets it; else what would have room."""
    placed = _placed(mark, looks, wall, edge)
    if placed is not None:
        return placed
    # of the same shape, but longer than wide
    shape = mark if mark.width < mark.length else replace(mark, length=2.0 * mark.width)

    def scaled(share: float) -> Mark:
        return replace(shape, width=share * shape.width, length=share * shape.length)

    share = _greatest(lambda share: _placed(scaled(share), looks, wall, edge) is not None)
    if share > 0.0:
        return Unmarked(mark, scaled(share))
    if wall is None:
        return Unmarked(mark)
    return Unmarked(mark, wall=wall * _greatest(lambda share: _placed(mark, looks, share * wall, edge) is not None))


def _greatest(fits: Callable[[float], bool]) -> float:
    """Greatest share of 1 that fits, to a thousandth of 1 and on the safe side; 0 if none does, 1 if that does."""
    low, high = (1.0, 1.0) if fits(1.0) else (0.0, 1.0)
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def _placed(mark: Mark, looks: Looks, room: float | None, edge: float) -> Opening | None:
    """The mark, with this wall or its own width between it and the contour; None without room."""
    depth = mark.depth if mark.kind == "engrave" else None
    layer: Layer = "ENGRAVE" if mark.kind == "engrave" else "MARK"
    wall = (room or mark.width) + edge

    def at(outer: float) -> Opening:
        return Opening("mark", layer, slot(outer - mark.length, outer, mark.width), depth=depth)

    def lacking(outer: float) -> float:
        return wall - MARGIN - contour_gap(looks, at(outer).chain).wall

    if mark.width >= mark.length:
        return None  # no slot
    if mark.radius is not None:
        return at(mark.radius)
    outer = looks.contour.size
    for _ in range(TRIES):  # no point of the slot comes nearer to the contour than by what it is moved
        inside, _ = distance_inside(looks, (outer - 0.5 * mark.width, 0.0))
        want = wall + 0.5 * mark.width - inside
        if want <= MARGIN:
            break
        outer -= want
        if outer <= 0.0:
            return None  # nowhere on the ray
    outer = STEP * math.floor(outer / STEP)
    while (lack := lacking(outer)) > 0.0:  # its sides are nearer than its end
        if outer <= mark.length:
            return None
        outer = STEP * round(outer / STEP - max(1.0, math.floor(lack / STEP)))
    return at(outer)
