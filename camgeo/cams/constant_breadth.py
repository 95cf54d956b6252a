"""Cams of constant breadth between two parallel faces, from the motion over one half turn (Shu and Wu 2012)."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.family import UNDERCUT, Cam, Circle, Family, Preload, Undercut
from camgeo.cams.flat_faced import FlatFacedCam, SizeAdvice
from camgeo.cams.preload import PRELOAD, build_preload
from camgeo.motions.half_turn import BY_MOTION, MOTION, SWING, HalfTurnCam, check_half_turn
from camgeo.motions.motion import FormulaMotion
from camgeo.schema.fields import FieldTable, length
from kin.law.contacts import Arrangement, Flat, Translating
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.motions.motion import MotionSource
    from camgeo.schema.reader import Reader, Values
    from kin.law.frame_swing import FrameSwing
    from kin.law.joints import DerivativeJump
    from kin.law.sources.motion import Kept, Motion
    from kin.law.support_function import Lift

ROUNDED = 1e-9  # rad, by which segments may miss their angle (as in kin.law.sources.programme)


@dataclass(frozen=True)
class SlidingFrame:
    """Links of the inverted slider-crank on which the square frame slides, mm.

    `ground` is the distance of the fixed pivots, `rocker` the rocker's length less the offset of the slide's line;
    `side` is 1 for the open assembly, -1 for the crossed one.
    """

    ground: float
    rocker: float
    side: float


@dataclass(frozen=True)
class ConstantBreadthCam(HalfTurnCam, FlatFacedCam):
    """A cam between two parallel faces, from the motion over one half turn (Shu and Wu).

    With `swings` the motion is the swing of the frame over the shaft angle, rad, and the lift follows from `frame`.
    """

    kind: ClassVar[str] = "constant-breadth"
    always_in_a_yoke: ClassVar[bool] = True
    base_radius: float
    motion: MotionSource
    undercut: Undercut
    swings: bool = False
    frame: SlidingFrame | None = None
    preload: Preload | None = None

    def lift(self) -> Lift:
        """The lift of the first face over a whole turn, mm (SW eqs. 2 to 4).

        Raises IntentError for a motion that no such cam has, and TypeError for a swing without `frame`.
        """
        from kin.law.support_function import lift_constant_breadth

        return lift_constant_breadth(self.base_radius, self.half_turn, "swing" if self.swings else "motion")

    @cached_property
    def half_turn(self) -> Motion:
        """The lift over the half turn of the shaft; for a swing over half a turn of the angle between cam and frame."""
        return super().half_turn if self.frame_swing is None else self.frame_swing.half_turn

    def joints(self) -> tuple[DerivativeJump, ...]:
        """Joints of the half turn's motion, mm, or of the swing over the shaft angle, rad."""
        return super().joints() if self.frame_swing is None else self.frame_swing.joints

    def kept(self) -> Kept | None:
        """Record of how the half turn's motion, mm, or the swing, rad, keeps the rows of its table; None without one.

        It has the greatest distance from a row, the row's line, and remarks.
        """
        return super().kept() if self.frame_swing is None else self.frame_swing.motion.kept

    @property
    def by_linkage(self) -> bool:
        """Whether the links shape the cam: the recipe gives the swing of the frame, not the lift."""
        return self.swings

    def in_frame(self, ground: float, rocker: float, side: float) -> Cam:
        """Copy with the links that its frame slides on; the cam itself where the recipe gives the lift.

        `ground` is the distance of the fixed pivots and `rocker` the rocker's length less the offset of the slide's
        line, mm; `side` is 1 for the open assembly, -1 for the crossed one.
        """
        return replace(self, frame=SlidingFrame(ground, rocker, side)) if self.swings else self

    @cached_property
    def frame_swing(self) -> FrameSwing | None:
        """The law of the swing, over the shaft angles that its source gives; None without a swing.

        Raises TypeError for a swing without `frame`, and IntentError for a swing that no cam drives.
        """
        if not self.swings:
            return None
        from kin.law.frame_swing import frame_swing

        if self.frame is None:
            raise TypeError("a frame swings in a linkage")
        return frame_swing(self._swing(), self.frame.ground, self.frame.rocker, self.frame.side)

    def _swing(self) -> Motion:
        """Motion of the swing over the shaft angle that its source gives, half a turn if it gives none.

        Segments that cover half a turn plus the rise, but for rounding, are made anew to fill exactly that angle.
        """
        from kin.law.frame_swing import span_of

        source, last = self.motion, self.motion.last
        if isinstance(source, FormulaMotion):
            last = span_of(source.text, source.scale)
        motion = source.motion(math.pi if last is None else last, "swing", None)
        if source.covered is not None and abs(rise := float(motion.at_end(0)[0])) < math.pi:
            total = math.pi + rise
            # fractions of degrees add up to all but rounding
            if abs(total - source.covered) <= ROUNDED:
                motion = source.motion(total, "swing", None)
        return motion

    @property
    def advice(self) -> SizeAdvice:
        """Advice: a larger base radius."""
        return SizeAdvice(gain=1.0)

    def circles(self) -> tuple[Circle, ...]:
        """The base circle of the recipe; the contour need not touch it."""
        return (Circle("base circle", self.base_radius),)

    def grow(self, out: float, scale: float) -> ConstantBreadthCam:
        """Copy with a base radius larger by `out` mm, then multiplied by `scale`: drawings show no other length."""
        return replace(self, base_radius=scale * (self.base_radius + out))


TABLE = FieldTable(
    (
        length("base_radius", "radius of the base circle", required=True),
        replace(MOTION, required=False),
        SWING,
        UNDERCUT,
        PRELOAD,
    ),
    alternatives=(("motion", ()), ("swing", ())),
)


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the half turn."""
    check_half_turn(cam, reader, "two parallel faces")


def build(cam: Values, mm: float) -> Cam:  # noqa: ARG001 - as all cams' build
    """Build the cam from values of a recipe in which no fault was noted; `mm` is the recipe's unit of length, mm."""
    undercut: Undercut = cam.get("undercut", "refuse")
    motion = cam["swing" if "swing" in cam else "motion"]
    return ConstantBreadthCam(cam["base_radius"], motion, undercut, "swing" in cam, preload=build_preload(cam))


FAMILY = Family(ConstantBreadthCam.kind, Arrangement(Translating, Flat, 2), TABLE, build, check, BY_MOTION)
