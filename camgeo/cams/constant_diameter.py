"""Cams whose pitch curve has constant diameters through the shaft: a frame with two opposite rollers holds them.

From the motion over one half turn (Shu and Wu 2012, reference 11): r(t) + r(t + 180) = 2 Rp + S(180).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, cast

import numpy as np

from camgeo.cams.family import UNDERCUT, Cam, Family, Follower, GrownError, Intent, Undercut
from camgeo.cams.guided import GuidedCam
from camgeo.cams.half_turn import MOTION, HalfTurnCam, check_half_turn
from camgeo.schema.fields import Table, length
from kin.law.contacts import Roller, opposite

if TYPE_CHECKING:
    from camgeo.cams.motion import MotionAsked
    from camgeo.curve import moving_frame
    from camgeo.curve.moving_frame import Displacement
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class ConstantDiameterCam(HalfTurnCam, GuidedCam):
    """A cam between two opposite rollers of one frame, from the motion over one half turn."""

    kind: ClassVar[str] = "constant-diameter"
    gain: ClassVar[float | None] = None
    offers: ClassVar[frozenset[str]] = GuidedCam.offers | {"rolling"}
    base_radius: float
    roller_radius: float
    motion: MotionAsked
    undercut: Undercut

    @property
    def touch_radius(self) -> float:
        """Radius of both rollers, mm."""
        return self.roller_radius

    @property
    def guide(self) -> moving_frame.Translating:
        """Through the shaft."""
        from camgeo.curve import moving_frame

        return moving_frame.Translating(self.base_radius + self.roller_radius)

    def intent(self) -> Intent:
        """The displacement of the first roller over a whole turn."""
        from camgeo.curve.moving_frame import Displacement
        from kin.law.sources.motion import opposed

        return Displacement.of(opposed(self.half_turn()))

    def follower(self, intent: Intent, *, framed: bool) -> Follower:  # noqa: ARG002
        """A frame with two rollers."""
        contacts = opposite(Roller(self.roller_radius), self.apart(intent), self.guide.foot)
        return Follower("roller yoke", contacts, ("constant-diameter", "pressure-angle"), "form-closure")

    def apart(self, intent: Intent) -> float:
        """Distance of the rollers' centres, mm."""
        s = cast("Displacement", intent).derivatives(np.array([0.0, math.pi]), 0)[0]
        return 2.0 * (self.base_radius + self.roller_radius) + float(s.sum())

    def grown(self, out: float, scale: float) -> Cam:
        """Smaller rollers on the same pitch curve."""
        if not self.roller_radius > out:
            raise GrownError("the roller's radius", self.roller_radius)
        base, radius = scale * (self.base_radius + out), scale * (self.roller_radius - out)
        return replace(self, base_radius=base, roller_radius=radius)


TABLE = Table(
    (
        length("base_radius", "radius of the base circle", required=True),
        length("roller_radius", "radius of both rollers", required=True),
        MOTION,
        UNDERCUT,
    ),
)


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the half turn."""
    check_half_turn(cam, reader, "two opposite rollers")


def build(cam: Values, mm: float) -> Cam:  # noqa: ARG001
    """Make the cam of values in which there is no fault."""
    undercut = cam.get("undercut", "refuse")
    return ConstantDiameterCam(cam["base_radius"], cam["roller_radius"], cam["motion"], undercut)


FAMILY = Family(ConstantDiameterCam, TABLE, build, check)
