"""Cams whose pitch curve has constant diameters through the shaft: a frame with two opposite rollers holds them.

From the motion over one half turn (Shu and Wu 2012, reference 11): r(t) + r(t + 180) = 2 Rp + S(180).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from camgeo.cams.family import UNDERCUT, Cam, ExactCam, Family, GrownError, Preload, Undercut
from camgeo.cams.follower import Follower
from camgeo.cams.guided import LARGER_BASE, SMALLER_STROKE, ExactGuided, GuidedCam, RoundAdvice
from camgeo.cams.preload import PRELOAD, build_preload, with_preload
from camgeo.motions.half_turn import BY_MOTION, MOTION, HalfTurnCam, check_half_turn
from camgeo.schema.fields import FieldTable, length
from kin.law.contacts import Arrangement, Roller, Translating, opposite
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.guided import Holding
    from camgeo.curve import moving_frame
    from camgeo.curve.moving_frame import Displacement
    from camgeo.motions.motion import MotionSource
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class ConstantDiameterCam(HalfTurnCam, GuidedCam):
    """A cam between two opposite rollers of one frame, from the motion over one half turn; radii in mm."""

    kind: ClassVar[str] = "constant-diameter"
    base_radius: float
    roller_radius: float
    motion: MotionSource
    undercut: Undercut
    preload: Preload | None = None

    @property
    def arrangement(self) -> Arrangement:
        """Two rollers on a line through the shaft."""
        return Arrangement(Translating, Roller, 2)

    @property
    def touch(self) -> Roller:
        """The touch of both rollers."""
        return Roller(self.roller_radius)

    @property
    def advice(self) -> RoundAdvice:
        """Advice for a round touch."""
        return RoundAdvice(self, larger=LARGER_BASE, less_steep=SMALLER_STROKE)

    @property
    def centre_guide(self) -> moving_frame.Translating:
        """Guide of the first roller's centre: a line through the shaft."""
        from camgeo.curve import moving_frame

        return moving_frame.Translating(self.base_radius + self.roller_radius)

    def exact(self, *, framed: bool = False) -> ExactCam:  # noqa: ARG002 - the protocol's
        """The cam with the displacement of the first roller over a whole turn, and its preload.

        Raises IntentError for a motion whose velocities do not meet, and for a preload that leaves nothing of the
        rollers.
        """
        from camgeo.curve.moving_frame import Displacement
        from kin.law.sources.motion import opposed

        return with_preload(ExactGuided(self, Displacement.of(opposed(self.half_turn))), self.preload)

    def follower(self, law: Displacement) -> Follower:
        """A frame with two rollers, their centres as far apart as the pitch curve's diameter."""
        s = law.derivatives(np.array([0.0, math.pi]), 0)[0]
        apart = 2.0 * (self.base_radius + self.roller_radius) + float(s.sum())
        contacts = opposite(self.touch, apart, self.centre_guide.foot)
        return Follower("roller yoke", contacts, ("constant-diameter", "pressure-angle"), "form-closure")

    def resized(  # it has no arm
        self,
        base: float,
        pivot: float | None = None,  # noqa: ARG002 - the protocol's
        holding: Holding | None = None,  # noqa: ARG002 - the protocol's
    ) -> ConstantDiameterCam:
        """Copy with the base radius `base`, mm; pivot and holding are of no effect."""
        return replace(self, base_radius=base)

    def grow(self, out: float, scale: float) -> ConstantDiameterCam:
        """Copy with rollers smaller by `out` mm on the same pitch curve, then all lengths times `scale`.

        Raises GrownError where nothing of the rollers is left.
        """
        if not self.roller_radius > out:
            raise GrownError("the roller's radius", self.roller_radius)
        base, radius = scale * (self.base_radius + out), scale * (self.roller_radius - out)
        return replace(self, base_radius=base, roller_radius=radius)


TABLE = FieldTable(
    (
        length("base_radius", "radius of the base circle", required=True),
        length("roller_radius", "radius of both rollers", required=True),
        MOTION,
        UNDERCUT,
        PRELOAD,
    )
)


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the half turn."""
    check_half_turn(cam, reader, "two opposite rollers")


def build(cam: Values, mm: float) -> Cam:  # noqa: ARG001 - as all cams' build
    """Build the cam from values of a recipe in which no fault was noted; `mm` is the recipe's unit of length, mm."""
    undercut, preload = cam.get("undercut", "refuse"), build_preload(cam)
    return ConstantDiameterCam(cam["base_radius"], cam["roller_radius"], cam["motion"], undercut, preload)


FAMILY = Family(ConstantDiameterCam.kind, Arrangement(Translating, Roller, 2), TABLE, build, check, BY_MOTION)
