"""The part of a recipe as geometry: its openings, boss, cross holes and chamfer, in the cam's axes and mm."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.curve.curvature import least_radius
from camgeo.part.feature import Site
from camgeo.part.features import boss_of, edge_of, with_records
from camgeo.part.shapes import Opening, disc, polygonal
from camgeo.part.walls import distance_inside
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.part.feature import Boss
    from camgeo.part.part import Part
    from camgeo.part.walls import Looks
    from kin.numeric.check import Check
    from kin.read.layers import CrossHole


@dataclass(frozen=True)
class Body:
    """A part without its contour; lengths in mm.

    `openings` begin with the bore; `bore` is its diameter, or its width across flats; `features` are the values that
    the recipe gives. `least_radius` is the contour's least radius of curvature where it is convex, infinite without a
    chamfer. `outer` is the diameter of the round outline of a ring, whose contour is an opening too, or of the blank of
    a groove; None for a disc, whose contour is its outline. `pocket` is the depth
    of the recess between two surfaces, None where it goes through or there is none. `checks` are those of features that
    are placed here.
    """

    thickness: float | None
    openings: tuple[Opening, ...]
    bore: float | None = None
    features: tuple[object, ...] = ()
    least_radius: float = math.inf
    outer: float | None = None
    pocket: float | None = None
    checks: tuple[Check, ...] = ()

    @property
    def boss(self) -> Boss | None:
        """Boss about the shaft; None without one."""
        return boss_of(self.features)

    @property
    def edge(self) -> float:
        """Chamfer of 45 degrees along both edges of the contour, mm; 0 without one."""
        return edge_of(self.features)

    @property
    def cross_holes(self) -> tuple[CrossHole, ...]:
        """Radial holes through the boss, in kin's words; none without a boss or a thickness."""
        boss, thickness = self.boss, self.thickness
        if boss is None or thickness is None:
            return ()
        features = with_records(self.features)
        return tuple(feature.cross(value, boss, thickness) for feature, value in features if feature.cross is not None)

    @property
    def rim(self) -> Opening | None:
        """The round outline of a ring or of the blank of a groove; None for a disc whose contour is its outline."""
        return None if self.outer is None else disc("outline", "CUT", (0.0, 0.0), 0.5 * self.outer)

    @property
    def fineness(self) -> float:
        """Share of a tolerance within which a polygon must be fitted so that its chamfer's inner edge keeps it too.

        Let e be the greatest distance of the polygon from the contour, r the radius of curvature and b half the turn at
        a corner, so that 4 e = r b^2. The parallel at the distance c is off by e and, to first order, by up to
        c b^2/2 r/(r - c) = 2 e c/(r - c) more: by e (r + c)/(r - c).
        """
        share = self.edge / self.least_radius
        return (1.0 - share) / (1.0 + share)

    @property
    def prism(self) -> bool:
        """Whether every section of the part is the same."""
        engraved = any(opening.depth is not None for opening in self.openings)
        return self.boss is None and not self.edge and self.pocket is None and not engraved

    @property
    def bottom(self) -> float:
        """Lowest z, mm: 0 without a boss below the disc."""
        return 0.0 if self.boss is None else -self.boss.below + 0.0

    @property
    def top(self) -> float:
        """Greatest z, mm: that of the disc, or of a boss above it."""
        return (self.thickness or 0.0) + (0.0 if self.boss is None else self.boss.above)

    def mirrored(self) -> Body:
        """Body mirrored about the x axis, as for a shaft that turns the other way."""
        features = tuple(
            value if feature.mirrored is None else feature.mirrored(value)
            for feature, value in with_records(self.features)
        )
        return replace(self, openings=tuple(opening.mirrored() for opening in self.openings), features=features)


def body_of(part: Part, looks: Looks, pocket: float | None = None) -> Body:
    """Body of a recipe's part round a contour; features without a stated place are placed here.

    `pocket` is the depth, mm, of the recess between two surfaces, None where there is none. Raises CurveError where the
    sharpest place of a contour that is to be chamfered cannot be proved.
    """
    # a feature is placed between the openings before it and the boss
    openings = [*bore_of(part), *part.openings]
    checks: list[Check] = []
    standing = [] if part.boss is None else [part.boss.circle]
    for feature, value in with_records(part.features):
        if feature.place is not None:
            placed = feature.place(value, Site(looks, [*openings, *standing], part.wall, part.edge))
            openings += placed.openings
            checks += [] if placed.check is None else [placed.check]
    if pocket is not None:
        openings = [replace(opening, island=distance_inside(looks, opening.middle)[0] > 0.0) for opening in openings]
    radius = least_radius(looks.contour)[0] if part.edge else math.inf
    return Body(part.thickness, tuple(openings), part.bore, part.features, radius, part.outer, pocket, tuple(checks))


def bore_of(part: Part) -> list[Opening]:
    """The bore, shaped by a feature such as a keyway, alone in a list; empty for a part without one."""
    if part.bore is None:
        return []
    if part.sides:
        return [Opening("bore", "BORE", polygonal(part.sides, part.bore, part.bore_at))]
    for feature, value in with_records(part.features):
        if feature.bore is not None:
            return [Opening("bore", "BORE", feature.bore(value, 0.5 * part.bore))]
    return [disc("bore", "BORE", (0.0, 0.0), 0.5 * part.bore)]
