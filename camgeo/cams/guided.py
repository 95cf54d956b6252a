"""What cams for a roller, shoe or knife edge on a guide have in common: the path of its centre, a parallel, advice.

The pitch curve is `camgeo.curve.moving_frame.CentreShape`, its parameter the shaft angle.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from camgeo.cams.family import Advice, Cam, Circle, ExactCam, Surface
from camgeo.cams.position import Position, position_of
from camgeo.common.rounding import downward, upward
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from kin.law.contacts import Roller, Translating
from kin.law.programme import IntentError
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.cams.family import Follower
    from camgeo.curve import moving_frame
    from camgeo.curve.curve import Side as Before
    from camgeo.curve.extremes import Figure
    from camgeo.curve.moving_frame import CentreShape, Displacement
    from camgeo.curve.rates import Series
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.law.joints import Joint
    from kin.law.piecewise import Piecewise

LARGER_BASE = "a larger base radius, a smaller stroke, or the same over a wider angle"
_MARGIN = 1e-3  # rad: sizes are reported rounded, and where two limits meet rounding breaks one


@dataclass(frozen=True)
class RoundAdvice(Advice):
    """Of a round touch: a smaller radius on the same pitch curve."""

    cam: GuidedCam

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """A smaller roller on the same pitch curve."""
        if not free_at / mm > 0.0:
            return f"no {self.radius_field} is proved to be free of it"
        return f"a {self.radius_field} below {downward(free_at / mm)}{self.same_pitch(mm)} would be free of it"

    def rounder(self, value: float, limit: float, unit: str) -> str:  # noqa: ARG002
        """A smaller roller on the same pitch curve."""
        mm = 25.4 if unit == "in" else 1.0
        return f"a {self.radius_field} below {downward(value)} {unit}{self.same_pitch(mm)}" if value > 0.0 else ""

    def same_pitch(self, mm: float) -> str:
        """The base radius that leaves the prime circle as it is."""
        word = "less" if self.cam.side > 0 else "and"
        return f" with a base radius of {self.cam.led.prime / mm:.12g} {word} that radius"

    @property
    def most_radius(self) -> float:
        """That of the prime circle, of a cam within it."""
        return self.cam.led.prime if self.cam.side > 0 else math.inf


class Flank(NamedTuple):
    """A surface beside a centre's path: its name, the side of its metal, what radius judges it, where it stands.

    That is the layer of drawings, its depth from the top face, mm, and the rank of its disc.
    """

    name: str
    side: Side
    radius: float
    layer: str = "CUT"
    depth: float | None = None
    disc: int = 0


class GuidedCam(Cam):
    """A cam whose follower's centre is led along a line or about a pivot."""

    base_radius: float

    @property
    def flanks(self) -> tuple[Flank, ...]:
        """Every surface that the follower touches, in the order of its contacts."""
        return (Flank("", self.side, self.touch.radius),)

    @property
    @abstractmethod
    def led(self) -> moving_frame.Guide:
        """How the centre is led; raises IntentError where the guide does not reach the prime circle."""

    @abstractmethod
    def joints(self) -> tuple[Joint, ...]:
        """Where derivatives of the motion that a recipe gives jump."""

    @abstractmethod
    def follower(self, law: Displacement) -> Follower:
        """The follower that a motion calls for."""

    @property
    def gap(self) -> float:
        """Axial gap between its discs, mm."""
        return 0.0

    def demand(self, law: Displacement) -> None:
        """Raise IntentError where another contact than the first could not be led through a motion."""

    @abstractmethod
    def resized(self, base: float, pivot: float | None = None) -> GuidedCam:
        """The cam with another base radius, and of an arm another distance of the pivot, mm."""

    @abstractmethod
    def grown(self, out: float, scale: float) -> GuidedCam:
        """The cam with a smaller touch on the same pitch curve, scaled; raises GrownError where it would be nothing."""

    def circles(self) -> tuple[Circle, ...]:
        """The base circle, and the prime circle."""
        circles = [Circle("base circle", self.base_radius)]
        if self.touch.radius:
            circles.append(Circle("prime circle", self.led.prime))
        return tuple(circles)


def led_by(contact: Contact[Guide, Touch]) -> moving_frame.Guide:
    """How the centre of a round touch is led, by the displacement of its own position."""
    from camgeo.curve import moving_frame

    guide = contact.guide
    if isinstance(guide, Translating):
        return moving_frame.Translating(contact.zero, guide.offset, contact.turned)
    return moving_frame.Oscillating(guide.pivot, guide.arm, contact.zero, guide.side)


@dataclass(frozen=True)
class Spin:
    """Turns of a roller per turn of the shaft; on the inner side of a ring it turns the other way round."""

    pitch: CentreShape
    radius: float
    sense: float

    def __call__(self, tau: Series, side: Before = 1) -> Series:
        """Over jets of the shaft angle."""
        return self.pitch.spin(tau, side, self.radius, self.sense)


@dataclass(frozen=True, eq=False)
class ExactLed(ExactCam):
    """Such a cam by the displacement of its follower, whatever touches it."""

    cam: GuidedCam
    law: Displacement

    @cached_property
    def follower(self) -> Follower:
        """As the family has it."""
        return self.cam.follower(self.law)

    @cached_property
    def motion(self) -> Position:
        """The displacement."""
        return position_of(self.follower.contacts[0].guide, self.law)

    @cached_property
    def judged_law(self) -> Piecewise:
        """The displacement."""
        return self.law.law()

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Those that the recipe gives."""
        return self.cam.joints()

    @property
    def gap(self) -> float:
        """As the recipe gives it."""
        return self.cam.gap

    def grown(self, out: float, scale: float) -> ExactCam:
        """The same pitch curve, or a face farther out; a lift is scaled with the drawing, a swing is not."""
        law = self.law.scaled(scale) if self.cam.arrangement.unit == "mm" else self.law
        return replace(self, cam=self.cam.grown(out, scale), law=law)


@dataclass(frozen=True, eq=False)
class ExactGuided(ExactLed):
    """Under a touch that is round about a centre."""

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """The centre's path, and the contours within it by the radius (around it, of a ring and of an outer flank).

        A knife edge's contour is the parallel at 0: it may be hollow, which a flat face's own contour may not.
        """
        from camgeo.curve.moving_frame import CentreShape

        self.cam.demand(self.law)
        contacts = {contact.surface: contact for contact in reversed(self.follower.contacts)}
        paths: dict[Contact[Guide, Touch], tuple[CentreShape, Curve]] = {}  # one for a roller between two flanks
        surfaces = []
        for flank in self.cam.flanks:
            contact = contacts[flank.name]
            if contact.place not in paths:
                pitch = CentreShape(self.law if contact.sense > 0 else self.law.scaled(-1.0), led_by(contact))
                paths[contact.place] = pitch, Curve.whole(pitch)
            surfaces.append(self._surface(*paths[contact.place], contact, flank))
        return tuple(surfaces)

    def _surface(self, pitch: CentreShape, path: Curve, contact: Contact[Guide, Touch], flank: Flank) -> Surface:
        name, side, radius, layer, depth, disc = flank
        series: dict[str, Figure] = {"slope": pitch.slope}
        touch = self.follower.running(contact)
        if isinstance(touch, Roller):
            series["spin"] = Spin(pitch, touch.radius, float(side))
        curve = Curve.whole(Parallel(pitch, side * radius))
        return Surface(path, curve, radius, side, pitch.pressure_angle, None, series, name, disc, layer, depth)

    def less_pressure(self, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:
        """The least base radius on this stem; for this length of arm that with the pivot's distance."""
        from camgeo.cams.least_size import least_arm, least_stem

        guide, pivot = self.follower.contacts[0].guide, ""
        if isinstance(guide, Translating):
            prime = least_stem(self.law, rising, falling, guide.offset).prime
        else:
            try:
                arm = least_arm(self.law, guide.arm, guide.side, rising - _MARGIN, falling - _MARGIN)
            except IntentError:
                return None
            prime, pivot = arm.prime, f"{arm.pivot / mm:.6g}"
        base = (prime - self.cam.side * self.cam.touch.radius) / mm
        if base <= 0.0:
            return None
        size = upward(base)
        told = f"a base radius of {size}{pivot and f' with a pivot at {pivot}'}"
        return told, self.cam.resized(float(size) * mm, float(pivot) * mm if pivot else None)

    def rounder_pitch(self, radius: float, mm: float) -> str:  # noqa: ARG002 - the least radius is found anew
        """The base radius at which the roller is half of the pitch curve's least convex radius."""
        from camgeo.cams.least_size import least_prime
        from camgeo.curve.moving_frame import CentreShape

        if not isinstance(self.cam.touch, Roller):
            return ""
        law, guide, roller = self.law, self.cam.led, self.cam.touch.radius
        try:
            prime = least_prime(lambda p: CentreShape(law, guide.resized(p)), 2.0 * roller, guide.prime)
        except IntentError:
            return ""
        return f"a base radius of {upward((prime - self.cam.side * roller) / mm)}"
