"""Single-disk cams that work a rigid pair of flat faces about one pivot (Wunderlich 1984, section 5)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar

from camgeo.cams.family import Cam, Circle, Family, Preload, Undercut
from camgeo.cams.follower import Follower
from camgeo.cams.pairs import PairAdvice, PairCam, Route, SwingOf, build_route, check, pair_table
from camgeo.cams.preload import build_preload
from camgeo.cams.surface import Surface
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.motions.by_motion import ByMotion
from kin.law.contacts import Arrangement, Flat, Oscillating, on_one_arm
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.schema.reader import Values
    from kin.law.transmission import Transmission

ARRANGEMENT = Arrangement(Oscillating, Flat, 2)


@dataclass(frozen=True)
class FacePairAdvice(PairAdvice):
    """Advice for two faces: a smaller swing, as no pair fits a cam with all radii enlarged alike."""

    def free_of_undercut(self, free_at: float, mm: float) -> str:  # noqa: ARG002 - the protocol's
        """Words for a smaller swing, without undercut."""
        return f"{self.less_swing(mm)} would have no undercut"

    def rounder(self, value: float, limit: float, unit: str) -> str:  # noqa: ARG002 - the protocol's
        """Empty: no remedy is known that gives a larger radius of curvature."""
        return ""


@dataclass(frozen=True)
class FlatPairCam(PairCam):
    """A single disk that works a rigid pair of flat faces, its pivot at 2 arm from the shaft (Wunderlich, 5)."""

    kind: ClassVar[str] = "flat-pair"
    swing_of: ClassVar[SwingOf] = "pair"
    arrangement: ClassVar[Arrangement] = ARRANGEMENT
    lam: int
    mu: int
    arm: float
    route: Route
    undercut: Undercut
    preload: Preload | None = None

    @property
    def touch(self) -> Flat:
        """The touch of both faces."""
        return Flat()

    @property
    def advice(self) -> FacePairAdvice:
        """Advice for the pair."""
        return FacePairAdvice(self)

    def follower(self, law: Transmission, out: float) -> Follower:
        """The follower: two faces whose lines pass the pivot at a distance of `out`, mm."""
        contacts = on_one_arm(2.0 * self.arm, None, Flat(nearer=-out), 0.5 * math.pi, 0.5 * law.alpha)
        return Follower("flat pair", contacts, self.law_checks, "form-closure")

    def surface(self, law: Transmission, out: float) -> Surface:
        """Surface of the disc: the curve with an isoptic circle (W 1984, section 5), or a parallel `out` mm outside."""
        from camgeo.curve.wunderlich import FlatPairShape

        whole = Curve.whole(FlatPairShape(law))
        return Surface(whole, Curve.whole(Parallel(whole.shape, -out)) if out else whole)

    def circles(self) -> tuple[Circle, ...]:
        """Reference circle of the pivot about the shaft, of radius 2 arm."""
        return (Circle("pivot circle", 2.0 * self.arm),)

    def grow(self, out: float, scale: float) -> FlatPairCam:  # noqa: ARG002 - the faces stand beside by it
        """Copy of the pair with its arm times `scale`; growth of the metal moves the faces of `ExactPair` alone."""
        return replace(self, arm=scale * self.arm)


TABLE = pair_table("swing of the pair, psi/2, over 180/lambda degrees of shaft angle from 0", ())


def build(cam: Values, mm: float) -> Cam:
    """Build the cam from values of a recipe in which no fault was noted; `mm` is the recipe's unit of length, mm."""
    lam, mu = cam["ratio"]
    undercut, preload = cam.get("undercut", "refuse"), build_preload(cam)
    return FlatPairCam(lam, mu, cam["arm"], build_route(cam, mm), undercut, preload)


BY_MOTION = ByMotion(motion="law", instead=("delta", "arc", "rosette"), still=("delta", {"cos": {"1": 0.001}}), lag=1.0)
FAMILY = Family(FlatPairCam.kind, ARRANGEMENT, TABLE, build, check, BY_MOTION)
