"""Cams for a roller, shoe or knife edge on a guide: the path of its centre, the parallel contour, and advice.

The pitch curve is `camgeo.curve.moving_frame.CentreShape`, its parameter the shaft angle.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from camgeo.cams.family import Advice, Cam, Circle, ExactCam, GrownError
from camgeo.cams.surface import Surface
from camgeo.common.rounding import downward, upward
from camgeo.curve.curve import Curve
from camgeo.curve.parallel import Parallel
from camgeo.motions.position import ArmPosition, LiftPosition, Position
from kin.law.contacts import KnifeEdge, Roller, Shoe, Translating
from kin.law.normalised import IntentError
from kin.numeric.records import dataclass, field, replace

if TYPE_CHECKING:
    from camgeo.cams.follower import Follower
    from camgeo.curve import moving_frame
    from camgeo.curve.curve import Side as Before
    from camgeo.curve.extremes import ShaftFigure
    from camgeo.curve.moving_frame import CentreShape, Displacement
    from camgeo.curve.rates import Series
    from kin.law.contacts import Contact, Guide, Side, Touch
    from kin.law.joints import DerivativeJump
    from kin.law.piecewise import Piecewise

LARGER_BASE = "a larger base radius"
SMALLER_STROKE = "a smaller stroke, or the same over a wider angle"
MARGIN = 1e-3  # rad: sizes are reported rounded, and where two limits meet rounding breaks one


@dataclass(frozen=True)
class RoundAdvice(Advice):
    """Advice for a round touch on `cam`: a smaller radius on the same pitch curve."""

    cam: GuidedCam

    @property
    def radius(self) -> float:
        """Radius of the roller or shoe, mm; 0 for a knife edge."""
        return self.cam.touch.radius

    def free_of_undercut(self, free_at: float, mm: float) -> str:
        """Words for a radius below `free_at`, mm, on the same pitch curve, or that no radius is proved."""
        if not free_at / mm > 0.0:
            return f"no {self.radius_field} is proved to be free of it"
        return f"a {self.radius_field} below {downward(free_at / mm)}{self.same_pitch(mm)} would be free of it"

    def rounder(self, value: float, limit: float, unit: str) -> str:  # noqa: ARG002 - the protocol's
        """Words for a radius below `value`, the pitch curve's least, on that curve; empty unless it is above 0."""
        mm = 25.4 if unit == "in" else 1.0
        return f"a {self.radius_field} below {downward(value)} {unit}{self.same_pitch(mm)}" if value > 0.0 else ""

    def same_pitch(self, mm: float) -> str:
        """Words for the base radius that keeps the prime circle with another radius of the touch."""
        word = "less" if self.cam.side > 0 else "and"
        return f" with a base radius of {self.cam.centre_guide.prime / mm:.12g} {word} that radius"

    @property
    def most_radius(self) -> float:
        """Radius of the prime circle, mm; infinite for a ring."""
        return self.cam.centre_guide.prime if self.cam.side > 0 else math.inf


class Flank(NamedTuple):
    """A surface beside a centre's path, at its gauge's radius, mm, with its metal inside (`side` 1) or outside (-1).

    `layer` is its layer in drawings, `depth` its depth from the top face, mm, None through the whole thickness, `disc`
    the number of its disc, from 0.
    """

    name: str
    side: Side
    radius: float
    layer: str = "CUT"
    depth: float | None = None
    disc: int = 0


@dataclass(frozen=True)
class Holding:
    """Way in which a follower is held on its cam; in this class a spring or gravity holds it on one surface.

    `closure` names the check of the play between two surfaces, empty for one surface; `discs` is the number of discs on
    the shaft, `gap` the axial gap between them, mm; `trims` says whether undercut may be cut off.
    """

    closure: ClassVar[str] = ""
    discs: ClassVar[int] = 1
    trims: ClassVar[bool] = True
    gap: float = field(default=0.0, kw_only=True)

    @property
    def larger(self) -> str:
        """Words for the size that lowers the pressure angle when it grows."""
        return LARGER_BASE

    @property
    def beside(self) -> str:
        """Words for what must grow with the base radius under a flat face; empty where nothing must."""
        return ""

    @property
    def second_arm(self) -> tuple[float, float] | None:
        """Length of the second arm of a bell crank, mm, and the angle between both, rad; None without one."""
        return None

    def follower_name(self, name: str) -> str:
        """The follower's name in reports; `name` names its guide and touch."""
        return name

    def flanks(self, touch: Touch, side: Side) -> tuple[Flank, ...]:
        """Every surface that the follower touches; on the first one the metal lies on `side` of the contour."""
        return (Flank("", side, touch.radius),)

    def contacts(self, first: Contact[Guide, Touch]) -> tuple[Contact[Guide, Touch], ...]:
        """Every contact of the follower, one on each surface; `first` is the contact of a follower with one."""
        return (first,)

    def demand(self, first: Contact[Guide, Touch], greatest: float) -> None:
        """Raise IntentError where a second contact cannot follow to the greatest displacement, mm or rad."""

    def grow(self, out: float, scale: float, *, flat: bool) -> Holding:  # noqa: ARG002 - the protocol's
        """The holding for metal grown by `out` mm, then all lengths times `scale`; `flat` for flat faces.

        Raises GrownError where nothing of a second touch is left.
        """
        return self

    def advice(self, cam: GuidedCam, own: Advice) -> Advice:  # noqa: ARG002 - the protocol's
        """Advice for all surfaces; `own` is the advice for a cam with one contact."""
        return own

    def circles(self, surface: str, own: tuple[Circle, ...]) -> tuple[Circle, ...]:  # noqa: ARG002 - the protocol's
        """Reference circles of the disc with the surface of this name; `own` are the circles for one contact."""
        return own

    def least_stem(
        self, law: Displacement, angles: tuple[float, float], offset: float | None
    ) -> moving_frame.Translating:
        """Stem with the least prime circle that keeps `angles`, on the rise and on the return, rad, on every surface.

        An `offset`, mm, is kept; for None the best is found. Raises IntentError for a motion that stands still, and for
        an angle that is not between 0 and 90 degrees.
        """
        from camgeo.cams.least_size import least_stem

        return least_stem(law, *angles, offset)

    def gentler_size(
        self, exact: ExactGuided, rising: float, falling: float, mm: float
    ) -> tuple[str, GuidedCam] | None:
        """A size in words and the cam of that size, with pressure angles within both limits; None if unknown.

        The limits are `rising` on the rise and `falling` on the return, rad. On a stem the size is the base radius, for
        its own offset; on an arm the base radius and the pivot's distance, for its own length.
        """
        from camgeo.cams.least_size import least_arm, least_stem

        cam, guide = exact.cam, exact.follower.contacts[0].guide
        if isinstance(guide, Translating):
            return base_size(cam, least_stem(exact.law, rising, falling, guide.offset).prime, mm)
        try:
            arm = least_arm(exact.law, guide.arm, guide.side, rising - MARGIN, falling - MARGIN)
        except IntentError:
            return None
        return base_size(cam, arm.prime, mm, arm.pivot)

    def rounder(self, surface: str, exact: ExactGuided, mm: float) -> str:  # noqa: ARG002 - the protocol's
        """Words for the base radius at which the roller is half the pitch curve's least convex radius; else empty."""
        cam, roller = exact.cam, exact.cam.touch.radius
        prime = least_prime_for_roller(exact.law, cam.centre_guide, roller)
        return "" if prime is None else f"a base radius of {upward((prime - cam.side * roller) / mm)}"


def shrink_touch(touch: Touch, out: float, scale: float) -> Touch:
    """A round touch with its radius less by `out` mm, then times `scale`; a knife edge at radius 0.

    Raises GrownError where `out` is above 0 and not below the radius.
    """
    radius, kind = touch.radius, Shoe if isinstance(touch, Shoe) else Roller
    if out > 0.0 and not radius > out:  # a knife edge can become a roller, and be scaled
        raise GrownError("the shoe radius" if kind is Shoe else "the roller's radius", radius)
    remaining = scale * (radius - out)
    return kind(remaining) if remaining else KnifeEdge()


def base_size(cam: GuidedCam, prime: float, mm: float, pivot: float | None = None) -> tuple[str, GuidedCam] | None:
    """Words for the base radius that gives a prime circle of radius `prime`, mm, and the cam of that size.

    `pivot` is the distance of an arm's pivot from the shaft, mm, if it changes too. None where no base radius above 0
    gives that circle.
    """
    base = (prime - cam.side * cam.touch.radius) / mm
    if base <= 0.0:
        return None
    size, pivot_words = upward(base), "" if pivot is None else f"{pivot / mm:.6g}"
    words = f"a base radius of {size}{pivot_words and f' with a pivot at {pivot_words}'}"
    return words, cam.resized(float(size) * mm, float(pivot_words) * mm if pivot_words else None)


def least_prime_for_roller(law: Displacement, guide: moving_frame.Guide, roller: float) -> float | None:
    """Least radius of the prime circle, mm, from the guide's own on, that is large enough for a roller, or None.

    A circle is large enough where the roller's radius, mm, is at most half the pitch curve's least convex radius.
    """
    from camgeo.cams.least_size import least_prime
    from camgeo.curve.moving_frame import CentreShape

    try:
        return least_prime(lambda p: CentreShape(law, guide.resized(p)), 2.0 * roller, guide.prime)
    except IntentError:
        return None


class GuidedCam(Cam):
    """A cam whose follower's centre moves along a line or about a pivot."""

    base_radius: float

    @property
    @abstractmethod
    def centre_guide(self) -> moving_frame.Guide:
        """Guide of the touch's centre.

        Raises IntentError where the guide does not reach the prime circle, or the roller does not fit a ring's opening.
        """

    @abstractmethod
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Angles at which derivatives of the recipe's motion jump."""

    @abstractmethod
    def follower(self, law: Displacement) -> Follower:
        """The follower for a motion."""

    @property
    def holding(self) -> Holding:
        """Way in which the follower is held on the cam: by a spring or gravity, unless overridden."""
        return Holding()

    @abstractmethod
    def resized(self, base: float, pivot: float | None = None, holding: Holding | None = None) -> GuidedCam:
        """Copy with the base radius `base`, mm, and, unless None, the distance of an arm's pivot, mm, and a holding."""

    @abstractmethod
    def grow(self, out: float, scale: float) -> GuidedCam:
        """Copy with a touch smaller by `out` mm on the same pitch curve, then all lengths times `scale`.

        Raises GrownError where nothing of the touch is left.
        """

    def circles(self) -> tuple[Circle, ...]:
        """The base circle, and the prime circle of a roller or shoe."""
        circles = [Circle("base circle", self.base_radius)]
        if self.touch.radius:
            circles.append(Circle("prime circle", self.centre_guide.prime))
        return tuple(circles)


def centre_guide_of(contact: Contact[Guide, Touch]) -> moving_frame.Guide:
    """Guide of the centre of a contact's round touch; its displacement 0 is the contact's.

    Raises ValueError for a flat face on an arm.
    """
    from camgeo.curve import moving_frame

    guide = contact.guide
    if isinstance(guide, Translating):
        return moving_frame.Translating(contact.zero, guide.offset, contact.turned)
    return moving_frame.Oscillating(guide.pivot, guide.arm, contact.zero, guide.side)


@dataclass(frozen=True)
class Spin:
    """Turns of a roller per turn of the shaft; `radius` in mm, `sense` 1 for metal inside the contour, -1 outside."""

    pitch: CentreShape
    radius: float
    sense: float

    def __call__(self, tau: Series, side: Before = 1) -> Series:
        """Turns per turn of the shaft at jets of the shaft angle; `side` decides at breaks."""
        return self.pitch.spin(tau, side, self.radius, self.sense)


@dataclass(frozen=True, eq=False)
class ExactLed(ExactCam):
    """A guided cam with the displacement of its follower, for any touch."""

    cam: GuidedCam
    law: Displacement

    @cached_property
    def follower(self) -> Follower:
        """The follower for this motion."""
        return self.cam.follower(self.law)

    @cached_property
    def motion(self) -> Position:
        """Position along a stem or about an arm's pivot, from displacement 0."""
        guide = self.follower.contacts[0].guide
        if isinstance(guide, Translating):
            return LiftPosition(self.law)
        return ArmPosition(self.law, arm=guide.pivot if guide.length is None else guide.length)

    @cached_property
    def judged_law(self) -> Piecewise:
        """Displacement over the shaft angle, mm or rad, by which kin judges the files."""
        return self.law.law()

    @cached_property
    def joints(self) -> tuple[DerivativeJump, ...]:
        """Joints of the recipe's motion."""
        return self.cam.joints()

    def circles(self, surface: str) -> tuple[Circle, ...]:
        """Reference circles of the disc with a surface."""
        return self.cam.holding.circles(surface, self.cam.circles())

    @property
    def gap(self) -> float:
        """Axial gap between the discs, mm."""
        return self.cam.holding.gap

    @property
    def flanks(self) -> tuple[Flank, ...]:
        """Every surface of the cam; raises IntentError where a contact cannot follow the whole motion."""
        holding = self.cam.holding
        holding.demand(self.follower.contacts[0], self.law.range[1])
        return holding.flanks(self.cam.touch, self.cam.side)

    def grow(self, out: float, scale: float) -> ExactCam:
        """Cam with `out` mm more metal along the normal, then scaled by `scale`; a lift is scaled, a swing is not.

        Under a roller the pitch curve stays and the roller is smaller by `out`; a flat face stands `out` farther out.
        """
        law = self.law.scaled(scale) if self.cam.arrangement.unit == "mm" else self.law
        return replace(self, cam=self.cam.grow(out, scale), law=law)


@dataclass(frozen=True, eq=False)
class ExactGuided(ExactLed):
    """A guided cam under a touch that is round about a centre."""

    @cached_property
    def surfaces(self) -> tuple[Surface, ...]:
        """Surface of each flank: the pitch curve, and the contour parallel to it at the touch's radius.

        The contour lies within the pitch curve, for a ring and a groove's outer flank around it. A knife edge's contour
        is the parallel at 0, as it may be hollow.
        """
        from camgeo.curve.moving_frame import CentreShape

        contacts = {contact.surface: contact for contact in reversed(self.follower.contacts)}
        paths: dict[Contact[Guide, Touch], tuple[CentreShape, Curve]] = {}  # one for a roller between two flanks
        surfaces = []
        for flank in self.flanks:
            contact = contacts[flank.name]
            if contact.place not in paths:
                pitch = CentreShape(self.law if contact.sense > 0 else self.law.scaled(-1.0), centre_guide_of(contact))
                paths[contact.place] = pitch, Curve.whole(pitch)
            surfaces.append(self._surface(*paths[contact.place], contact, flank))
        return tuple(surfaces)

    def _surface(self, pitch: CentreShape, path: Curve, contact: Contact[Guide, Touch], flank: Flank) -> Surface:
        name, side, radius, layer, depth, disc = flank
        series: dict[str, ShaftFigure] = {"slope": pitch.slope}
        touch = self.follower.running(contact)
        if isinstance(touch, Roller):
            series["spin"] = Spin(pitch, touch.radius, float(side))
        curve = Curve.whole(Parallel(pitch, side * radius))
        return Surface(path, curve, radius, side, pitch.pressure_angle, None, series, name, disc, layer, depth)

    def less_pressure(self, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:
        """A size in words and the cam of that size, which keeps both limits, rad, everywhere; None if unknown."""
        return self.cam.holding.gentler_size(self, rising, falling, mm)

    def rounder_pitch(self, surface: str, mm: float) -> str:
        """Words for the size at which a roller is half the pitch curve's least convex radius; empty for no roller."""
        rolls = isinstance(self.cam.touch, Roller)
        return self.cam.holding.rounder(surface, self, mm) if rolls else ""
