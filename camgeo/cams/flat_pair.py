"""Single-disk cams that work a rigid pair of flat faces about one pivot (Wunderlich 1984, section 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Literal, cast

from camgeo.cams.family import (
    Cam,
    Circle,
    Family,
    Follower,
    Intent,
    Profile,
    Undercut,
    Unit,
)
from camgeo.cams.pairs import PairCam, Route, build_route, check, pair_table
from camgeo.cams.position import Position, SwingPosition
from camgeo.curve.curve import Curve
from kin.law.contacts import Flat, on_one_arm

if TYPE_CHECKING:
    from camgeo.schema.reader import Values
    from kin.law.transmission import Transmission


@dataclass(frozen=True)
class FlatPairCam(PairCam):
    """A single disk that works a rigid pair of flat faces, its pivot at 2 arm from the shaft (Wunderlich, 5)."""

    kind: ClassVar[str] = "flat-pair"
    offers: ClassVar[frozenset[str]] = frozenset({"swings"})
    backlash_unit: ClassVar[Unit] = "deg"
    swing_of: ClassVar[Literal["arm", "pair"]] = "pair"
    lam: int
    mu: int
    arm: float
    route: Route
    undercut: Undercut

    def position(self, intent: Intent) -> Position:
        """The pair's own swing psi/2."""
        return SwingPosition(cast("Transmission", intent), 0.5)

    def profile(self, intent: Intent) -> Profile:
        """The curve with an isoptic circle (W section 5)."""
        from camgeo.curve.wunderlich import FlatPairShape
        from kin.law.transmission import Transmission

        if not isinstance(intent, Transmission):
            raise TypeError("a lift is no motion of a double follower")
        whole = Curve.whole(FlatPairShape(intent))
        return Profile(whole, whole, 0.0)

    def follower(self, intent: Intent, *, framed: bool) -> Follower:  # noqa: ARG002
        """Two faces whose lines pass through their pivot."""
        half = 0.5 * cast("Transmission", intent).alpha
        contacts = on_one_arm(2.0 * self.arm, None, Flat(), 0.5 * math.pi, half)
        return Follower("flat pair", contacts, ("closing-equation", "velocity-ratio"), "form-closure")

    def free_of_undercut(self, free_at: float, mm: float) -> str:  # noqa: ARG002
        """A smaller swing: r + const closes no pair, so there is no base radius to enlarge."""
        return f"{self.less_swing(mm)} would have no undercut"

    def rounder(self, value: float, limit: float, unit: str) -> str:  # noqa: ARG002
        """Nothing that is known to help."""
        return ""

    def circles(self) -> tuple[Circle, ...]:
        """The pivot's."""
        return (Circle("pivot circle", 2.0 * self.arm),)

    def grown(self, out: float, scale: float) -> Cam:  # noqa: ARG002
        """The same pair farther away."""
        return replace(self, arm=scale * self.arm)

    def face_beyond(self, out: float, scale: float) -> float:
        """By what the metal has grown."""
        return scale * out


TABLE = pair_table("swing of the pair, psi/2, over 180/lambda degrees of shaft angle from 0", ())


def build(cam: Values, mm: float) -> Cam:
    """Make the cam of values in which there is no fault."""
    lam, mu = cam["ratio"]
    return FlatPairCam(lam, mu, cam["arm"], build_route(cam, mm), cam.get("undercut", "refuse"))


FAMILY = Family(FlatPairCam, TABLE, build, check)
