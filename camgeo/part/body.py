"""The part of a recipe as geometry: its openings, hub, set screw and chamfer, in the cam's axes and mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeVar

from camgeo.curve.curvature import least_radius
from camgeo.part.chamfer import Chamfer
from camgeo.part.feature import Site
from camgeo.part.features import with_records
from camgeo.part.hub import Hub
from camgeo.part.set_screw import SetScrew
from camgeo.part.shapes import Opening, disc, polygonal
from camgeo.part.walls import distance_inside
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.part.part import Part
    from camgeo.part.walls import Looks
    from kin.judge.check import Check

T = TypeVar("T")


@dataclass(frozen=True)
class Body:
    """A part without its contour; lengths in mm.

    `openings` are listed from the bore outward; `bore` is its diameter or width; `features` are as the recipe has them.
    `least_radius` is the contour's, where it is convex. `outer` is the diameter of a ring, of which the contour is an
    opening too; None for a disc. `pocket` is the depth of the recess between two surfaces, None where it goes through
    or there is none. `checks` are those of openings that sought their place.
    """

    thickness: float | None
    openings: tuple[Opening, ...]
    bore: float | None = None
    features: tuple[object, ...] = ()
    least_radius: float = math.inf
    outer: float | None = None
    pocket: float | None = None
    checks: tuple[Check, ...] = ()

    def of(self, kind: type[T]) -> T | None:
        """Give the feature of this class, None where the part has none."""
        return next((value for value in self.features if isinstance(value, kind)), None)

    @property
    def hub(self) -> Hub | None:
        """Hub of the part; None without one."""
        return self.of(Hub)

    @property
    def screw(self) -> SetScrew | None:
        """Set screw of the part; None without one."""
        return self.of(SetScrew)

    @property
    def chamfer(self) -> float | None:
        """Height of the chamfer, mm; None without one."""
        chamfer = self.of(Chamfer)
        return None if chamfer is None else chamfer.height

    @property
    def rim(self) -> Opening | None:
        """The round outline of a ring; None for a disc, whose contour it is."""
        return None if self.outer is None else disc("outline", "CUT", (0.0, 0.0), 0.5 * self.outer)

    @property
    def fineness(self) -> float:
        """Share of a tolerance within which a polygon must be fitted, so that a chamfer keeps it too."""
        chamfer = self.of(Chamfer)
        return 1.0 if chamfer is None else chamfer.fineness(self.least_radius)

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
        """Greatest z, mm: that of the disc, or of a hub above it."""
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
        """Body mirrored about the x axis."""
        features = tuple(
            replace(value, at=-value.at) if isinstance(value, SetScrew) else value for value in self.features
        )
        return replace(self, openings=tuple(opening.mirrored() for opening in self.openings), features=features)


def body_of(part: Part, looks: Looks, pocket: float | None = None) -> Body:
    """Make the part of a recipe round a contour; openings without a stated place are placed here.

    Raises CurveError where the sharpest place of a contour that is to be chamfered cannot be proved.
    """
    openings = [*_bore(part), *part.openings]
    checks: list[Check] = []
    hub, chamfer = part.of(Hub), part.of(Chamfer)
    standing = [] if hub is None else [disc("hub", "HOLES", (0.0, 0.0), 0.5 * hub.diameter)]
    edge = 0.0 if chamfer is None else chamfer.height
    for feature, value in with_records(part.features):
        if feature.place is not None:
            placed = feature.place(value, Site(looks, [*openings, *standing], part.wall, edge))
            openings += placed.openings
            checks += [] if placed.check is None else [placed.check]
    if pocket is not None:
        openings = [replace(each, island=distance_inside(looks, each.middle)[0] > 0.0) for each in openings]
    radius = math.inf if chamfer is None else least_radius(looks.contour)[0]
    return Body(part.thickness, tuple(openings), part.bore, part.features, radius, part.outer, pocket, tuple(checks))


def _bore(part: Part) -> list[Opening]:
    """The bore, with what shapes it; none of a part without one."""
    if part.bore is None:
        return []
    if part.sides:
        return [Opening("bore", "BORE", polygonal(part.sides, part.bore, part.bore_at))]
    for feature, value in with_records(part.features):
        if feature.bore is not None:
            return [Opening("bore", "BORE", feature.bore(value, 0.5 * part.bore))]
    return [disc("bore", "BORE", (0.0, 0.0), 0.5 * part.bore)]
