"""Intended drums: all that the judge of cylindrical cams takes beside the file itself and permitted errors.

A drum reaches from z = 0 to its length, from its bore to its radius. Its track is cut from the radius inwards, by its
depth, down to the floor, which is a cylinder about the axis. Lower flanks have the metal below and hold a roller from
below; upper flanks have it above. The flanks are those of rollers without ends: they reach from the floor to the radius
of the blank, however long the roller is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.contour.nearest import nearest
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.holes import Hole
    from kin.cylindrical.follower import DrumFollower
    from kin.law.contacts import Side


class Track:
    """A track: `clearance` enlarges the roller of its upper flank, `distance` is that of two rollers' axes, mm."""

    depth: float | None
    clearance: float = 0.0
    distance: float = 0.0

    @property
    def sides(self) -> tuple[Side, ...]:
        """Sides of the roller on which the flanks lie, the lower flank first: -1 below it, 1 above."""
        return (-1, 1)

    def beside(self, side: Side) -> float:
        """Height, mm, of the roller of the flank on a side above the middle between both rollers; 0 of one roller."""
        return -0.5 * side * self.distance

    def larger(self, side: Side) -> float:
        """By how much, mm, the roller of a flank on its side is larger than the drum's own."""
        return self.clearance if side > 0 else 0.0


@dataclass(frozen=True)
class Groove(Track):
    """A groove of a `depth`, mm, between two flanks, for one roller.

    The lower flank is that of the roller, the upper flank that of a roller larger by `clearance`, mm, on the same axis,
    of a cone in its radius at all places along it.
    """

    depth: float
    clearance: float = 0.0


@dataclass(frozen=True)
class Rib(Track):
    """A rib of a `depth`, mm, between two rollers whose axes are a `distance`, mm, apart along z, or square to an arm.

    Its upper face is the lower flank of the roller at distance/2 above the level, its lower face the upper flank of
    that at distance/2 below. Beside the rib the drum is turned down by the depth, over its whole length.
    """

    depth: float
    distance: float


@dataclass(frozen=True)
class End(Track):
    """An end cam: one flank, on which a spring holds the roller.

    facing  "top": the metal is below, the flank takes the place of the upper end; "bottom": the metal is above
    depth   mm, to which the flank reaches inwards; within the drum goes on from z = 0 to its length. None: to the bore
    """

    facing: Literal["top", "bottom"] = "top"
    depth: float | None = None

    @property
    def sides(self) -> tuple[Side, ...]:
        """Side of the roller on which the one flank lies: -1 below it, 1 above."""
        return (-1,) if self.facing == "top" else (1,)


@dataclass(frozen=True, eq=False)
class DrumIntent:
    """Intended cylindrical cam in a file.

    follower   the roller and its motion; its unit, mm or deg, is that of positions and play in a verdict
    track      groove, rib or end
    radius     of the blank, mm
    length     of the blank along z, mm; of an end cam that of what lies within its flank
    bore       the opening along the axis, keyway included, mm, as if not mirrored; None for a drum without one
    shortened  an undercut is cut off: what is lost is told; else an undercut drum has no exact flank and is refused
    mirrored   the file is mirrored, y -> -y (rotation ccw), bore too
    mm         mm in a unit of a development's DXF (solids are always in mm)

    Raises ValueError for a motion of several turns, and for a shoe, on anything but a groove.
    """

    follower: DrumFollower
    track: Track
    radius: float
    length: float
    bore: Hole | None = None
    shortened: bool = False
    mirrored: bool = False
    mm: float = 1.0

    def __post_init__(self) -> None:
        if not isinstance(self.track, Groove) and (self.follower.turns > 1 or self.follower.shoe is not None):
            raise ValueError("motions of several turns, and shoes, are led by a groove")

    @property
    def floor(self) -> float:
        """Radius, mm, down to which the flanks reach: that of the floor, or of the bore's nearest point, 0 without."""
        if self.track.depth is not None:
            return self.radius - self.track.depth
        if self.bore is None:
            return 0.0
        return float(nearest(self.bore.contour.as_arcs()[0], np.zeros((1, 2)))[1][0])
