"""The recipe of a cylindrical cam: its roller or shoe, how it is driven, and the drum; lengths in mm, angles in rad."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.recipe.recipe import SolidOrder
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from typing import ClassVar

    from camgeo.capabilities.cylindrical.guide import Guide
    from camgeo.capabilities.cylindrical.tracks import Track
    from camgeo.motions.motion import MotionSource
    from camgeo.part.part import Part
    from camgeo.recipe.figure_bounds import Bound
    from camgeo.recipe.materials import Material
    from kin.numeric.arrays import Array


@dataclass(frozen=True)
class Roller:
    """A roller that bears from `inner` to `outer` along its axis, from the cam's, mm.

    It has its radius, mm, at the distance `at`, mm; `taper` is its half angle, rad, 0 of a cylinder. `apex` says that
    the taper is that of a cone with its apex on the cam's axis, whatever its radius. A `shoe` of that length, mm, from
    tip to tip turns on a pin in place of the roller, whose radius is half its width; its sides are two arcs.
    """

    radius: float
    inner: float
    outer: float
    taper: float = 0.0
    at: float = 0.0
    apex: bool = False
    shoe: float | None = None

    @property
    def word(self) -> str:
        """Name of the follower in messages: roller, conical roller or shoe."""
        return "shoe" if self.shoe is not None else "conical roller" if self.taper else "roller"

    @property
    def side(self) -> float:
        """Radius of curvature of its sides, mm: that of the arcs of a shoe."""
        return self.radius if self.shoe is None else 0.5 * (0.25 * self.shoe**2 / self.radius + self.radius)

    def half_width(self, along: Array) -> Array:
        """Half the width (n,), mm, of a shoe at distances along it from its middle, mm; 0 beyond its tips."""
        side = self.side
        return np.maximum(np.sqrt(np.maximum(side * side - along * along, 0.0)) - (side - self.radius), 0.0)

    def resized(self, radius: float) -> Roller:
        """The roller of another radius, mm."""
        return replace(self, radius=radius, taper=math.atan(radius / self.at) if self.apex else self.taper)

    def size(self, rho: float) -> float:
        """Radius, mm, at a distance from the cam's axis, mm."""
        return self.radius + (rho - self.at) * math.tan(self.taper)


@dataclass(frozen=True)
class Drive:
    """Speed of the drum, rpm, load, N, and materials of drum and roller; None where not given.

    The load is along the cam's axis, or on an arm at its roller, square to the arm.
    """

    rpm: float | None = None
    load: float | None = None
    material: Material | None = None
    roller_material: Material | None = None


@dataclass(frozen=True)
class DrumRecipe(SolidOrder):
    """A recipe of a cylindrical cam; lengths in mm, angles in rad.

    `radius` is the blank's; `guide` leads the roller's axis, or the middle between the rollers of a rib, over the lower
    face, z = 0. The thickness of `part` is the drum's length. The motion repeats after so many `turns`.
    Measured flanks have a tolerance zone of the width `profile`, None without one.
    """

    root: ClassVar[str] = "cylindrical"

    radius: float
    track: Track
    roller: Roller
    guide: Guide
    motion: MotionSource
    part: Part
    undercut: Literal["refuse", "shorten"] = "refuse"
    drive: Drive = Drive()
    limits: tuple[Bound, ...] = ()
    turns: int = 1
    profile: float | None = None

    __repr__ = SolidOrder.__repr__

    @property
    def period(self) -> float:
        """Shaft angle, rad, after which the motion repeats."""
        return TURN * self.turns

    @property
    def level(self) -> float:
        """Height of the roller's axis at lift 0 over the lower face, mm; of a rib the middle between its rollers."""
        return self.guide.height(0.0)

    @property
    def follower_name(self) -> str:
        """Name of the follower in reports."""
        return f"{self.roller.word} on an arm" if self.swings else f"{self.roller.word} on a carriage along the axis"

    @property
    def swings(self) -> bool:
        """Whether the follower swings on an arm, by angles."""
        return self.guide.unit == "deg"

    @property
    def floor(self) -> float:
        """Radius of the floor of the track, mm."""
        return self.radius - self.track.depth

    @property
    def bearing(self) -> tuple[float, float]:
        """Distances from the axis, mm, between which the walls of a track lead."""
        return self.roller.inner, min(self.roller.outer, self.radius)

    @property
    def height(self) -> float:
        """Length of the drum along its axis, mm."""
        if self.part.thickness is None:
            raise ValueError(self.name)
        return self.part.thickness

    @property
    def shortens(self) -> bool:
        """Whether an undercut shortens the line of contact, in place of an error."""
        return self.undercut == "shorten"
