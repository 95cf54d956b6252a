"""Cams of constant breadth between two parallel faces, from the motion over one half turn (Shu and Wu 2012)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.family import (
    UNDERCUT,
    Cam,
    Circle,
    Family,
    Intent,
    Undercut,
)
from camgeo.cams.flat_faced import FlatFacedCam
from camgeo.cams.motion import MotionAsked, check_filled, motion_field
from camgeo.recipe.schema.fields import Kind, Table, length

if TYPE_CHECKING:
    from camgeo.recipe.schema.reader import Reader, Values
    from kin.law.joints import Joint
    from kin.law.sources.motion import Motion

_OTHER_HALF = "two parallel faces hold the cam, so the other half turn's motion follows: S(t + 180) = S(180) - S(t)"


@dataclass(frozen=True)
class ConstantBreadthCam(FlatFacedCam):
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

        return lift_constant_breadth(self.base_radius, self._half_turn())

    def _half_turn(self) -> Motion:
        return self.motion.motion(math.pi, "motion", -1)

    def joints(self, intent: Intent) -> tuple[Joint, ...]:  # noqa: ARG002
        """Those of the half turn; the other half has them too, turned round."""
        return self._half_turn().joints

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
        motion_field(
            "motion",
            Kind.LENGTH,
            "motion over one half turn, 180 degrees; the other half follows from it",
            required=True,
        ),
        UNDERCUT,
    ),
)


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the half turn."""
    if "motion" in cam:
        check_filled(cam["motion"], "cam.motion", math.pi, "one half turn, 180 degrees", reader, why=_OTHER_HALF)


def build(cam: Values, mm: float) -> Cam:  # noqa: ARG001
    """Make the cam of values in which there is no fault."""
    return ConstantBreadthCam(cam["base_radius"], cam["motion"], cam.get("undercut", "refuse"))


FAMILY = Family(ConstantBreadthCam, TABLE, build, check)
