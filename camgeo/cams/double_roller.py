"""Single-disk cams that work two rollers on one oscillating arm (Wunderlich 1984, sections 2 to 4)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from camgeo.cams.family import Cam, Circle, Family, GrownError, Preload, Undercut
from camgeo.cams.follower import Follower
from camgeo.cams.pairs import PairAdvice, PairCam, Route, SwingOf, build_route, check, pair_table
from camgeo.cams.preload import build_preload
from camgeo.cams.surface import Surface
from camgeo.common.rounding import downward
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.motions.by_motion import ByMotion
from camgeo.schema.fields import length
from kin.law.contacts import Arrangement, Oscillating, Roller, on_one_arm
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.schema.reader import Values
    from kin.law.transmission import Transmission
    from kin.numeric.arrays import Array

ARRANGEMENT = Arrangement(Oscillating, Roller, 2)


@dataclass(frozen=True)
class RollerPairAdvice(PairAdvice):
    """Advice for two rollers: smaller ones."""

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Words for a roller radius below `free_at`, mm, or that no radius is proved to have no undercut."""
        if not free_at / mm > 0.0:
            return "no roller radius is proved to have no undercut"
        return f"a roller radius below {downward(free_at / mm)} would have no undercut"

    def rounder(self, value: float, limit: float, unit: str) -> str:  # noqa: ARG002 - the protocol's
        """Words for a roller radius below `value`, the pitch curve's least; empty unless it is above 0."""
        return f"a roller radius below {downward(value)} {unit}" if value > 0.0 else ""


@dataclass(frozen=True)
class ArmPressure:
    """Pressure angle of a roller on an arm, without a sign; each of both rollers runs round the whole pitch curve."""

    law: Transmission
    base: Curve

    def __call__(self, t: Array) -> Array:
        """Angle between the normal and the path of the roller, 0 to pi/2 rad (n,), at parameters t (n,), rad."""
        # the pivot stands at shaft angle phi round the cam, an arm's length from the shaft
        frame, phi = self.base.sample(t), self.law.at(t, 0)[0][0]
        arm = frame.point - self.law.arm * np.column_stack([np.cos(phi), np.sin(phi)])
        arm /= np.hypot(arm[:, 0], arm[:, 1])[:, None]
        normal = frame.normal
        # the roller's path is at right angles to the arm
        across = np.abs(arm[:, 0] * normal[:, 1] - arm[:, 1] * normal[:, 0])
        angle: Array = np.arctan2(np.abs(np.sum(arm * normal, axis=1)), across)
        return angle


@dataclass(frozen=True)
class DoubleRollerCam(PairCam):
    """A single disk that works two rollers on one arm (Wunderlich); pi/alpha = lam/mu in lowest terms, mu odd."""

    kind: ClassVar[str] = "double-roller"
    swing_of: ClassVar[SwingOf] = "arm"
    arrangement: ClassVar[Arrangement] = ARRANGEMENT
    lam: int
    mu: int
    arm: float
    roller_radius: float
    route: Route
    undercut: Undercut
    preload: Preload | None = None

    @property
    def touch(self) -> Roller:
        """The touch of both rollers."""
        return Roller(self.roller_radius)

    @property
    def advice(self) -> RollerPairAdvice:
        """Advice, with the pressure angle of a cam without swing: 90 degrees less alpha/2, alpha = 180 mu/lambda."""
        return RollerPairAdvice(self, least_pressure_angle=90.0 * (1.0 - self.mu / self.lam))

    def follower(self, law: Transmission, out: float) -> Follower:  # noqa: ARG002 - the protocol's
        """The follower: two rollers on one arm, its pivot as far from the shaft as from the rollers."""
        checks = (*self.law_checks, "pressure-angle")
        contacts = on_one_arm(self.arm, self.arm, self.touch, math.pi, law.alpha)
        return Follower("double roller", contacts, checks, "form-closure")

    def surface(self, law: Transmission, out: float) -> Surface:  # noqa: ARG002 - the rollers are smaller by it
        """Surface of the disc: the pitch curve (W section 4), and the contour within it at the roller's radius."""
        from camgeo.curve.wunderlich import PitchShape

        pitch = PitchShape(law)
        base, curve = Curve.whole(pitch), Curve.whole(Parallel(pitch, self.roller_radius))
        return Surface(base, curve, self.roller_radius, pressure=ArmPressure(law, base))

    def circles(self) -> tuple[Circle, ...]:
        """The prime circle, at the pitch curve's least distance from the shaft, and the circle of the pivot."""
        return (Circle("prime circle"), Circle("pivot circle", self.arm))

    def grow(self, out: float, scale: float) -> DoubleRollerCam:
        """Copy with rollers smaller by `out` mm on the same pitch curve, then all lengths times `scale`.

        Raises GrownError where nothing of the rollers is left.
        """
        if not self.roller_radius > out:
            raise GrownError("the roller's radius", self.roller_radius)
        return replace(self, arm=scale * self.arm, roller_radius=scale * (self.roller_radius - out))


TABLE = pair_table(
    "swing psi of the follower, over 180/lambda degrees of shaft angle from psi = 0",
    (length("roller_radius", "radius of both rollers", required=True),),
)


def build(cam: Values, mm: float) -> Cam:
    """Build the cam from values of a recipe in which no fault was noted; `mm` is the recipe's unit of length, mm."""
    (lam, mu), undercut = cam["ratio"], cam.get("undercut", "refuse")
    route, preload = build_route(cam, mm), build_preload(cam)
    return DoubleRollerCam(lam, mu, cam["arm"], cam["roller_radius"], route, undercut, preload)


BY_MOTION = ByMotion(motion="law", instead=("delta", "arc", "rosette"), still=("delta", {"cos": {"1": 0.001}}))
FAMILY = Family(DoubleRollerCam.kind, ARRANGEMENT, TABLE, build, check, BY_MOTION)
