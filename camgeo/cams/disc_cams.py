"""Size and motion of disc cams by their follower: roller, knife edge, curved shoe or flat face, on a stem or an arm."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, cast

from camgeo.cams.faced import FacedCam
from camgeo.cams.family import Cam, Follower, GrownError, Intent, Undercut, Unit
from camgeo.cams.guided import GuidedCam
from camgeo.cams.position import ArmPosition, LiftPosition, Position
from camgeo.cams.sizing import size_arm, size_face, size_stem
from camgeo.common.rounding import upward
from kin.law.contacts import LEADING, TRAILING, Contact, Flat, KnifeEdge, Oscillating, Roller, Shoe, Translating

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.cams.motion import MotionAsked
    from camgeo.cams.sizing import Sizing
    from camgeo.curve import moving_frame
    from camgeo.curve.disc import StraightFace, SwingingFace
    from camgeo.curve.moving_frame import Displacement
    from kin.law.contacts import Guide, Side, Touch
    from kin.law.joints import Joint
    from kin.law.sources.motion import Motion

ArmSide: TypeAlias = Literal["trailing", "leading"]
Track: TypeAlias = Literal["external", "internal"]
_MARGIN = 1e-3  # rad: sizes are reported rounded, and where two limits meet rounding breaks one


@dataclass(frozen=True, kw_only=True)
class DiscCam(Cam):
    """Size and motion of a disc cam."""

    kind: ClassVar[str] = "disc"
    guided: ClassVar[str] = "translating"
    base_radius: float
    motion: MotionAsked
    undercut: Undercut
    touch: str
    sizing: Sizing | None = None

    checks: ClassVar[tuple[str, ...]] = ("pressure-angle",)

    def intent(self) -> Intent:
        """The displacement over a whole turn, 0 where it is lowest."""
        from camgeo.curve.moving_frame import Displacement

        return Displacement.of(self._turn().demand_joined("motion", "mm" if self.unit == "mm" else "rad"))

    def _turn(self) -> Motion:
        return self.motion.motion(2.0 * math.pi, "motion", 1)

    def joints(self, intent: Intent) -> tuple[Joint, ...]:  # noqa: ARG002
        """Those of the turn, or of the part of it that repeats."""
        return self._turn().joints

    def found(self, mm: float) -> str:
        """What sizing found, in words; empty where a base radius was given."""
        return "" if self.sizing is None else f"the base radius found is {self.base_radius / mm:.9g}{self._found(mm)}"

    def _found(self, mm: float) -> str:  # noqa: ARG002
        return ""

    def sized(self, asked: Sizing, given: Mapping[str, float]) -> DiscCam:  # noqa: ARG002
        """The cam of the least size that keeps what is asked; `given` are the follower's keys in the recipe.

        Raises IntentError where there is none.
        """
        from kin.law.programme import IntentError

        raise IntentError("the size of a cam for a flat face on an arm is not found", "sizing")

    def follower(self, intent: Intent, *, framed: bool) -> Follower:  # noqa: ARG002
        """One contact, which a spring or gravity holds on the cam."""
        return Follower(f"{self.guided} {self.touch}", (self.contact,), self.checks)

    @property
    @abstractmethod
    def contact(self) -> Contact[Guide, Touch]:
        """How the cam is touched."""


@dataclass(frozen=True, kw_only=True)
class _Arm:
    """An arm about a pivot at a distance from the shaft, mm."""

    guided: ClassVar[str] = "oscillating"
    unit: ClassVar[Unit] = "deg"
    gain: ClassVar[float | None] = None
    pivot: float
    side: ArmSide

    @property
    def sense(self) -> Side:
        """+1 trailing: the follower is touched clockwise of the pivot as drawn; -1 leading."""
        return TRAILING if self.side == "trailing" else LEADING


@dataclass(frozen=True, kw_only=True)
class RoundCam(DiscCam, GuidedCam):
    """A disc cam for a roller, a curved shoe of that radius or, of radius 0, a knife edge."""

    gain: ClassVar[float | None] = None
    radius: float = 0.0
    track: Track = "external"

    @property
    def touch_radius(self) -> float:
        """Radius of the roller or shoe, mm."""
        return self.radius

    @property
    def round(self) -> Roller | Shoe | KnifeEdge:
        """What touches the cam."""
        return KnifeEdge() if not self.radius else (Shoe if self.touch == "shoe" else Roller)(self.radius)

    @property
    def roller_field(self) -> str:
        """A curved shoe is no roller."""
        return "shoe radius" if self.touch == "shoe" else super().roller_field

    @property
    def metal(self) -> Side:
        """-1 where the cam is the opening of a ring."""
        return 1 if self.track == "external" else -1

    @property
    def prime(self) -> float:
        """Radius of the prime circle, mm; raises IntentError where the roller does not fit the opening."""
        from kin.law.programme import IntentError

        prime = self.base_radius + self.metal * self.radius
        if not prime > 0.0:
            raise IntentError(
                "the roller does not fit the opening: its radius is not below the base radius", "follower"
            )
        return prime

    def _resized(self, out: float, scale: float) -> dict[str, Any]:
        """Base radius and radius for a smaller roller on the same pitch curve, scaled."""
        if out > 0.0 and not self.radius > out:  # a knife edge can become a roller, and be scaled
            raise GrownError(f"the {self.roller_field}" if self.touch == "shoe" else "the roller's radius", self.radius)
        base, radius = self.base_radius + self.metal * out, self.radius - out
        return {"base_radius": scale * base, "radius": scale * radius}


@dataclass(frozen=True, kw_only=True)
class TranslatingRoundCam(RoundCam):
    """The follower's centre moves along a line that passes the shaft at `offset`, mm."""

    offers: ClassVar[frozenset[str]] = RoundCam.offers | {"stem"}
    offset: float = 0.0

    @property
    def guide(self) -> moving_frame.Translating:
        """The line of travel."""
        from camgeo.curve import moving_frame

        return moving_frame.Translating.on(self.prime, self.offset)

    def sized(self, asked: Sizing, given: Mapping[str, float]) -> DiscCam:
        """The least cam that keeps what is asked."""
        return size_stem(self, asked, given)

    def _found(self, mm: float) -> str:
        return f", with offset {self.offset / mm:.9g}"

    @property
    def contact(self) -> Contact[Guide, Touch]:
        """On the stem, from the foot of the shaft."""
        return Contact(Translating(self.offset), self.round, self.guide.foot)

    def grown(self, out: float, scale: float) -> Cam:
        """A smaller roller on the same pitch curve."""
        return replace(self, **self._resized(out, scale), offset=scale * self.offset)


@dataclass(frozen=True, kw_only=True)
class OscillatingRoundCam(_Arm, RoundCam):
    """The follower's centre swings at `length` about the pivot."""

    offers: ClassVar[frozenset[str]] = RoundCam.offers | {"arm"}
    length: float

    @property
    def guide(self) -> moving_frame.Oscillating:
        """The arm."""
        from camgeo.curve import moving_frame

        return moving_frame.Oscillating.on(self.prime, self.pivot, self.length, self.sense)

    def sized(self, asked: Sizing, given: Mapping[str, float]) -> DiscCam:
        """The least cam that keeps what is asked."""
        return size_arm(self, asked, given)

    def _found(self, mm: float) -> str:
        return f", with pivot {self.pivot / mm:.9g}"

    @property
    def contact(self) -> Contact[Guide, Touch]:
        """On the arm, from its rest."""
        return Contact(Oscillating(self.pivot, self.sense, self.length), self.round, self.guide.rest)

    def less_pressure(self, intent: Intent, rising: float, falling: float, mm: float) -> tuple[str, Cam] | None:
        """The least base radius for this length of arm, with the pivot's distance."""
        from camgeo.curve.sizing import least_arm
        from kin.law.programme import IntentError

        law = cast("Displacement", intent)
        try:
            found = least_arm(law, self.length, self.sense, rising - _MARGIN, falling - _MARGIN)
        except IntentError:
            return None
        base = (found.prime - self.metal * self.radius) / mm
        if base <= 0.0:
            return None
        size, pivot = upward(base), f"{found.pivot / mm:.6g}"
        other = replace(self, base_radius=float(size) * mm, pivot=float(pivot) * mm)
        return f"a base radius of {size} with a pivot at {pivot}", other

    def grown(self, out: float, scale: float) -> Cam:
        """A smaller roller on the same pitch curve."""
        return replace(self, **self._resized(out, scale), pivot=scale * self.pivot, length=scale * self.length)


class TranslatingRollerCam(TranslatingRoundCam):
    """A roller on a stem, which the cam turns."""

    offers: ClassVar[frozenset[str]] = TranslatingRoundCam.offers | {"rolling"}


class OscillatingRollerCam(OscillatingRoundCam):
    """A roller on an arm, which the cam turns."""

    offers: ClassVar[frozenset[str]] = OscillatingRoundCam.offers | {"rolling"}


@dataclass(frozen=True, kw_only=True)
class TranslatingFaceCam(DiscCam, FacedCam):
    """A flat face on a stem at `offset`, mm, its normal turned ahead of the travel by `tilt`, rad."""

    checks: ClassVar[tuple[str, ...]] = ("pressure-angle", "contact-travel")
    offers: ClassVar[frozenset[str]] = FacedCam.offers | {"stem-face"}
    gain: ClassVar[float | None] = None
    tilt: float = 0.0
    offset: float = 0.0
    width: float | None = None

    def follower(self, intent: Intent, *, framed: bool) -> Follower:
        """One face; where its width is given, the contact must stay on it."""
        made = super().follower(intent, framed=framed)
        return made if self.width is None else replace(made, checks=(*made.checks, "face-width"))

    def position(self, intent: Intent) -> Position:
        """The lift."""
        return LiftPosition(cast("Displacement", intent))

    def face(self, motion: Displacement) -> StraightFace:
        """The face."""
        from camgeo.curve.disc import StraightFace

        return StraightFace(motion, self.base_radius, self.tilt, self.offset)

    def sized(self, asked: Sizing, given: Mapping[str, float]) -> DiscCam:
        """The least cam that keeps what is asked."""
        return size_face(self, asked, given)

    @property
    def contact(self) -> Contact[Guide, Touch]:
        """Across the stem, from where the face crosses its axis."""
        level = (self.base_radius - self.offset * math.sin(self.tilt)) / math.cos(self.tilt)
        return Contact(Translating(self.offset), Flat(self.tilt, self.width), level)

    def grown(self, out: float, scale: float) -> Cam:
        """A larger base circle."""
        base, offset = scale * (self.base_radius + out), scale * self.offset
        return replace(self, base_radius=base, offset=offset, width=None if self.width is None else scale * self.width)


@dataclass(frozen=True, kw_only=True)
class OscillatingFaceCam(_Arm, DiscCam, FacedCam):
    """A flat face on an arm, `face` mm nearer the shaft than its parallel through the pivot."""

    checks: ClassVar[tuple[str, ...]] = ("pressure-angle", "contact-travel")
    offers: ClassVar[frozenset[str]] = FacedCam.offers | {"arm"}
    nearer: float = 0.0

    def larger(self, by: float, unit: str = "") -> str:
        """A larger base radius about the same rest: the face moves out with it."""
        return f"{super().larger(by, unit)} with arm.face smaller by as much"

    def position(self, intent: Intent) -> Position:
        """The swing."""
        return ArmPosition(cast("Displacement", intent), arm=self.pivot)

    def face(self, motion: Displacement) -> SwingingFace:
        """The face."""
        from camgeo.curve.disc import SwingingFace

        return SwingingFace.on(motion, self.base_radius, self.pivot, self.nearer, self.sense)

    @property
    def contact(self) -> Contact[Guide, Touch]:
        """Along the arm, from its rest."""
        rest = math.asin((self.base_radius + self.nearer) / self.pivot)
        return Contact(Oscillating(self.pivot, self.sense), Flat(nearer=self.nearer), rest)

    def grown(self, out: float, scale: float) -> Cam:
        """The same swing of a face that stands farther out on its arm."""
        base, nearer = scale * (self.base_radius + out), scale * (self.nearer - out)
        return replace(self, base_radius=base, nearer=nearer, pivot=scale * self.pivot)
