"""Cams of constant breadth between two parallel faces, from the motion over one half turn (Shu and Wu 2012)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.family import UNDERCUT, Cam, Circle, Family, Intent, Undercut
from camgeo.cams.flat_faced import FlatFacedCam
from camgeo.cams.half_turn import MOTION, HalfTurnCam, check_half_turn
from camgeo.recipe.schema.fields import Table, length

if TYPE_CHECKING:
    from camgeo.cams.motion import MotionAsked
    from camgeo.recipe.schema.reader import Reader, Values


@dataclass(frozen=True)
class ConstantBreadthCam(HalfTurnCam, FlatFacedCam):
    """A cam between two parallel faces, from the motion over one half turn (Shu and Wu)."""

    kind: ClassVar[str] = "constant-breadth"
    offers: ClassVar[frozenset[str]] = frozenset({"face", "plate"})
    always_in_a_yoke: ClassVar[bool] = True
    base_radius: float
    motion: MotionAsked
    undercut: Undercut

    def intent(self) -> Intent:
        """The lift of the first face over a whole turn (SW eqs. 2 to 4)."""
        from kin.law.support_function import lift_constant_breadth

        return lift_constant_breadth(self.base_radius, self.half_turn())

    @property
    def size_field(self) -> tuple[str, float]:
        """The base radius."""
        return "base radius", 1.0

    def circles(self) -> tuple[Circle, ...]:
        """The base circle as it was given, which a dwell away from it does not touch."""
        return (Circle("base circle", self.base_radius),)

    def grown(self, out: float, scale: float) -> Cam:
        """A larger base circle."""
        return replace(self, base_radius=scale * (self.base_radius + out))


TABLE = Table(
    (
        length("base_radius", "radius of the base circle", required=True),
        MOTION,
        UNDERCUT,
    ),
)


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the half turn."""
    check_half_turn(cam, reader, "two parallel faces")


def build(cam: Values, mm: float) -> Cam:  # noqa: ARG001
    """Make the cam of values in which there is no fault."""
    return ConstantBreadthCam(cam["base_radius"], cam["motion"], cam.get("undercut", "refuse"))


FAMILY = Family(ConstantBreadthCam, TABLE, build, check)
