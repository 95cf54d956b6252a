"""What cams for a roller, a knife edge or a curved shoe on a guide have in common: one moving frame draws them all.

The pitch curve is the path of the roller's centre round the standing cam (`camgeo.curve.moving_frame`), the contour
its parallel by the roller's radius.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, cast

from camgeo.cams.family import Cam, Circle, Profile
from camgeo.cams.position import ArmPosition, LiftPosition, Position
from camgeo.common.rounding import downward, upward
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from kin.law.programme import IntentError

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.family import Intent
    from camgeo.curve.extremes import Figure
    from camgeo.curve.moving_frame import CentreShape, Displacement, Oscillating, Translating
    from kin.law.piecewise import Piecewise
    from kin.numeric.arrays import Array

LARGER_BASE = "a larger base radius, a smaller stroke, or the same over a wider angle"


class GuidedCam(Cam):
    """A cam whose follower's centre is led along a line or about a pivot."""

    less_steep: ClassVar[str] = LARGER_BASE
    offers: ClassVar[frozenset[str]] = frozenset({"roller", "guided"})
    base_radius: float

    @property
    @abstractmethod
    def guide(self) -> Translating | Oscillating:
        """How the centre is led; raises IntentError where the guide does not reach the prime circle."""

    def position(self, intent: Intent) -> Position:
        """The displacement."""
        law = cast("Displacement", intent)
        return LiftPosition(law) if self.unit == "mm" else ArmPosition(law, arm=cast("Oscillating", self.guide).length)

    def profile(self, intent: Intent) -> Profile:
        """The centre's path, and the contour within it by the radius (around it, of a ring).

        A knife edge's contour is the parallel at 0: it may be hollow, which a flat face's own contour may not.
        """
        from camgeo.curve.moving_frame import CentreShape, Displacement

        if not isinstance(intent, Displacement):
            raise TypeError("a follower on a guide takes a displacement over the shaft angle")
        pitch = CentreShape(intent, self.guide)
        whole, radius = Curve.whole(pitch), self.metal * self.touch_radius
        return Profile(whole, Curve.whole(Parallel(pitch, radius)), radius)

    def law(self, intent: Intent) -> Piecewise:
        """The displacement."""
        return cast("Displacement", intent).law()

    def pressure_angle(self, intent: Intent, profile: Profile) -> Callable[[Array], Array]:  # noqa: ARG002
        """Between the contact's normal and the way of the centre."""
        return cast("CentreShape", profile.base.shape).pressure_angle

    def series(self, intent: Intent, profile: Profile) -> dict[str, Figure]:  # noqa: ARG002
        """Of the pressure angle, and of the roller."""
        pitch = cast("CentreShape", profile.base.shape)
        if "rolling" not in self.offers:
            return {"slope": pitch.slope}
        # on the inner side of a ring the roller turns the other way round
        radius, sense = self.touch_radius, float(self.metal)
        return {"slope": pitch.slope, "spin": lambda tau, side=1: pitch.spin(tau, side, radius, sense)}

    def less_pressure(self, intent: Intent, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:
        """The least base radius on this stem; a cam with an arm has words of its own."""
        from camgeo.curve.sizing import least_stem

        if self.unit != "mm":
            return None
        found = least_stem(cast("Displacement", intent), rising, falling, cast("Translating", self.guide).offset)
        base = (found.prime - self.metal * self.touch_radius) / mm
        if base <= 0.0:
            return None
        size = upward(base)
        return f"a base radius of {size}", replace(self, base_radius=float(size) * mm)  # type: ignore[type-var]

    def rounder_pitch(self, intent: Intent, radius: float, mm: float) -> str:  # noqa: ARG002
        """The base radius at which the roller is half of the pitch curve's least convex radius."""
        from camgeo.curve.moving_frame import CentreShape
        from camgeo.curve.sizing import least_prime

        if "rolling" not in self.offers:
            return ""
        law, guide = cast("Displacement", intent), self.guide
        try:
            prime = least_prime(lambda p: CentreShape(law, guide.resized(p)), 2.0 * self.touch_radius, guide.prime)
        except IntentError:
            return ""
        return f"a base radius of {upward((prime - self.metal * self.touch_radius) / mm)}"

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """A smaller roller on the same pitch curve."""
        if not free_at / mm > 0.0:
            return f"no {self.roller_field} is proved to be free of it"
        return f"a {self.roller_field} below {downward(free_at / mm)}{self.same_pitch(mm)} would be free of it"

    def rounder(self, value: float, limit: float, unit: str) -> str:  # noqa: ARG002
        """A smaller roller on the same pitch curve."""
        mm = 25.4 if unit == "in" else 1.0
        return f"a {self.roller_field} below {downward(value)} {unit}{self.same_pitch(mm)}" if value > 0.0 else ""

    def same_pitch(self, mm: float) -> str:
        """The base radius that leaves the prime circle as it is."""
        return f" with a base radius of {self.guide.prime / mm:.12g} {'less' if self.metal > 0 else 'and'} that radius"

    def circles(self) -> tuple[Circle, ...]:
        """The base circle, and the prime circle."""
        circles = [Circle("base circle", self.base_radius)]
        if self.touch_radius:
            circles.append(Circle("prime circle", self.guide.prime))
        return tuple(circles)

    def grown_intent(self, intent: Intent, out: float, scale: float) -> Intent:  # noqa: ARG002
        """The same pitch curve; a lift is scaled with the drawing, a swing is not."""
        law = cast("Displacement", intent)
        return law.scaled(scale) if self.unit == "mm" else law
