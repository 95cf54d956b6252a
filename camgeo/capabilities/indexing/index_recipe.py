"""The recipe of an indexing cam: its blank, its turret, how it is driven; lengths in mm, angles in rad."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.recipe import SolidOrder
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from typing import ClassVar

    from camgeo.capabilities.indexing.forms import Barrel, Globoid
    from camgeo.capabilities.indexing.turrets import Roller, Turret
    from camgeo.motions.motion import MotionSource
    from camgeo.part.part import Part
    from camgeo.recipe.figure_bounds import Bound
    from camgeo.recipe.materials import Material


@dataclass(frozen=True)
class Drive:
    """Speed of the cam, rpm, load on the turret, N m, and materials of cam and rollers; None where not given.

    `inertia`, kg m^2, is that of the turret and of all that it carries, about its own axis.
    """

    rpm: float | None = None
    load: float | None = None
    inertia: float | None = None
    material: Material | None = None
    roller_material: Material | None = None


@dataclass(frozen=True)
class IndexRecipe(SolidOrder):
    """A recipe of an indexing cam; lengths in mm, angles in rad.

    `turret` leads `stops` equal rollers about the blank. One of them stands at the angle `start` where the motion
    begins. The roller of the upper flank is larger by `clearance`, smaller by a preload where that is below 0. The
    thickness of `part` is the cam's length.
    """

    root: ClassVar[str] = "indexing"

    turret: Turret
    roller: Roller
    stops: int
    start: float
    motion: MotionSource
    part: Part
    clearance: float = 0.0
    drive: Drive = Drive()
    limits: tuple[Bound, ...] = ()

    __repr__ = SolidOrder.__repr__

    @property
    def form(self) -> Barrel | Globoid:
        """The blank and its track."""
        return self.turret.form

    @property
    def advance(self) -> float:
        """Angle of the turret, rad, between one stop and the next: that between neighbouring rollers."""
        return TURN / self.stops

    @property
    def length(self) -> float:
        """Length of the cam along its axis, mm."""
        return self.form.length

    @property
    def layers(self) -> tuple[float, float]:
        """Layers of the floor and of the blank, mm, the smaller one first."""
        ends = self.form.floor, self.form.blank
        return min(ends), max(ends)

    @property
    def follower_name(self) -> str:
        """Name of the follower in reports."""
        return f"turret of {self.stops} rollers"
