"""Cams between two opposite contacts of one frame: the motion over one half turn gives the other.

Shu and Wu 2012: S(t + 180) = S(180) - S(t), since the contacts are a fixed distance apart.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

from camgeo.motions.by_motion import ByMotion
from camgeo.motions.inputs import WHOLE_PART
from camgeo.motions.motion import MotionSource, check_filled, motion_field
from camgeo.schema.fields import Kind

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values
    from kin.law.joints import DerivativeJump
    from kin.law.sources.motion import Kept, Motion

MOTION = motion_field(
    "motion", Kind.LENGTH, "motion over one half turn, 180 degrees; the other half follows from it", required=True
)
SWING = motion_field(
    "swing",
    Kind.ANGLE,
    "swing of the frame over the shaft angle, in its sense, under a linkage of kind inverted-slider-crank",
    over=WHOLE_PART,
)
BY_MOTION = ByMotion(
    motion="motion",
    base="base_radius",
    instead=("swing",),
    still=("motion", [{"rise": 0.01, "over": 180.0, "law": "cycloidal"}]),
    opposed=True,
)


class HalfTurnCam:
    """A cam whose motion is given over one half turn."""

    motion: MotionSource

    @property
    def stated_motion(self) -> MotionSource:
        """Motion as the recipe has it."""
        return self.motion

    @property
    def motion_span(self) -> float:
        """Shaft angle over which the recipe gives the motion: half a turn, rad."""
        return math.pi

    @cached_property
    def half_turn(self) -> Motion:
        """The motion over the half turn; the other half follows, falling. IntentError where it cannot be made."""
        return self.motion.motion(math.pi, "motion", -1)

    def joints(self) -> tuple[DerivativeJump, ...]:
        """Jumps of derivatives in the half turn's motion; the other half has the same with the opposite sign."""
        return self.half_turn.joints

    def kept(self) -> Kept | None:
        """Record of how the half turn's motion keeps the rows of its table, mm; None without a table or cam card.

        It has the greatest distance from a row, the row's line, and remarks.
        """
        return self.half_turn.kept


def check_half_turn(cam: Values, reader: Reader, holding: str) -> None:
    """Note segments that do not fill the half turn; `holding` names the two contacts."""
    why = f"{holding} hold the cam, so the other half turn's motion follows: S(t + 180) = S(180) - S(t)"
    if "motion" in cam:
        check_filled(cam["motion"], "cam.motion", math.pi, "one half turn, 180 degrees", reader, why=why)
