"""Disc cams for one follower: roller, knife edge, curved shoe or flat face, on a stem or on an arm; and in a ring."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, cast

from camgeo.cams.faced import FacedCam
from camgeo.cams.family import UNDERCUT, Cam, Family, Follower, GrownError, Intent, Undercut, Unit
from camgeo.cams.guided import GuidedCam
from camgeo.cams.motion import MotionSegment, build_motion, check_filled, motion_field, programme_of
from camgeo.cams.position import ArmPosition, LiftPosition, Position
from camgeo.recipe.schema.fields import Field, Form, Kind, Table, coordinate, length
from camgeo.recipe.schema.json_schema import one_of_schema
from camgeo.recipe.schema.reader import kind_of
from camgeo.recipe.schema.yaml_source import Mapping, entries

if TYPE_CHECKING:
    from camgeo.curve.disc import StraightFace, SwingingFace
    from camgeo.curve.moving_frame import Displacement, Oscillating, Translating
    from camgeo.recipe.schema.reader import Reader, Values
    from camgeo.recipe.schema.yaml_source import Node
    from kin.follower.follower import Follower as Judged

Side: TypeAlias = Literal["trailing", "leading"]
Track: TypeAlias = Literal["external", "internal"]
_WHY = "the follower is back where it began after one turn"


@dataclass(frozen=True, kw_only=True)
class DiscCam(Cam):
    """Size and motion of a disc cam."""

    kind: ClassVar[str] = "disc"
    guided: ClassVar[str] = "translating"
    base_radius: float
    motion: tuple[MotionSegment, ...]
    undercut: Undercut
    touch: str

    checks: ClassVar[tuple[str, ...]] = ("pressure-angle",)

    def intent(self) -> Intent:
        """The displacement over a whole turn, 0 where it is lowest."""
        from camgeo.curve.moving_frame import Displacement

        motion = programme_of(self.motion, 2.0 * math.pi, "motion", around=1)
        motion.demand_joined("motion", "mm" if self.unit == "mm" else "rad")
        return Displacement.of(motion.from_lowest())

    def follower(self, intent: Intent, *, framed: bool) -> Follower:  # noqa: ARG002
        """One contact, which a spring or gravity holds on the cam."""
        return Follower(f"{self.guided} {self.touch}", self.checks)


@dataclass(frozen=True, kw_only=True)
class _Arm:
    """An arm about a pivot at a distance from the shaft, mm."""

    guided: ClassVar[str] = "oscillating"
    unit: ClassVar[Unit] = "deg"
    gain: ClassVar[float | None] = None
    pivot: float
    side: Side

    @property
    def sense(self) -> int:
        """+1 trailing: the follower is touched clockwise of the pivot as drawn; -1 leading."""
        return 1 if self.side == "trailing" else -1


@dataclass(frozen=True, kw_only=True)
class RoundCam(DiscCam, GuidedCam):
    """A disc cam for a roller, a curved shoe of that radius or, of radius 0, a knife edge."""

    offers: ClassVar[frozenset[str]] = frozenset({"roller"})
    gain: ClassVar[float | None] = None
    radius: float = 0.0
    track: Track = "external"

    @property
    def touch_radius(self) -> float:
        """Radius of the roller or shoe, mm."""
        return self.radius

    @property
    def metal(self) -> int:
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
        if not self.radius > self.metal * out:
            raise GrownError("the roller's radius", self.radius)
        base, radius = self.base_radius + self.metal * out, self.radius - self.metal * out
        return {"base_radius": scale * base, "radius": scale * radius}


@dataclass(frozen=True, kw_only=True)
class TranslatingRoundCam(RoundCam):
    """The follower's centre moves along a line that passes the shaft at `offset`, mm."""

    offset: float = 0.0

    @property
    def guide(self) -> Translating:
        """The line of travel."""
        from camgeo.curve.moving_frame import Translating

        return Translating.on(self.prime, self.offset)

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:  # noqa: ARG002
        """One roller on a stem."""
        from kin.follower import follower, guide

        law = cast("Displacement", intent).law(self.guide.foot)
        return follower.Roller(guide.Translating(self.offset), self.radius, law)

    def grown(self, out: float, scale: float) -> Cam:
        """A smaller roller on the same pitch curve."""
        return replace(self, **self._resized(out, scale), offset=scale * self.offset)


@dataclass(frozen=True, kw_only=True)
class OscillatingRoundCam(_Arm, RoundCam):
    """The follower's centre swings at `length` about the pivot."""

    length: float

    @property
    def guide(self) -> Oscillating:
        """The arm."""
        from camgeo.curve.moving_frame import Oscillating

        return Oscillating.on(self.prime, self.pivot, self.length, self.sense)

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:  # noqa: ARG002
        """One roller on an arm."""
        from kin.follower import follower, guide

        law = cast("Displacement", intent).law(self.guide.rest)
        side = guide.TRAILING if self.sense > 0 else guide.LEADING
        return follower.Roller(guide.Arm(self.length, self.pivot, side), self.radius, law)

    def grown(self, out: float, scale: float) -> Cam:
        """A smaller roller on the same pitch curve."""
        return replace(self, **self._resized(out, scale), pivot=scale * self.pivot, length=scale * self.length)


@dataclass(frozen=True, kw_only=True)
class TranslatingFaceCam(DiscCam, FacedCam):
    """A flat face on a stem at `offset`, mm, its normal turned ahead of the travel by `tilt`, rad."""

    checks: ClassVar[tuple[str, ...]] = ("pressure-angle", "face-length")
    gain: ClassVar[float | None] = None
    tilt: float = 0.0
    offset: float = 0.0
    width: float | None = None

    def position(self, intent: Intent) -> Position:
        """The lift."""
        return LiftPosition(cast("Displacement", intent))

    def face(self, motion: Displacement) -> StraightFace:
        """The face."""
        from camgeo.curve.disc import StraightFace

        return StraightFace(motion, self.base_radius, self.tilt, self.offset)

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:
        """A face on a stem."""
        raise NotImplementedError

    def grown(self, out: float, scale: float) -> Cam:
        """A larger base circle."""
        base, offset = scale * (self.base_radius + out), scale * self.offset
        return replace(self, base_radius=base, offset=offset, width=None if self.width is None else scale * self.width)


@dataclass(frozen=True, kw_only=True)
class OscillatingFaceCam(_Arm, DiscCam, FacedCam):
    """A flat face on an arm, `face` mm nearer the shaft than its parallel through the pivot."""

    checks: ClassVar[tuple[str, ...]] = ("pressure-angle", "face-length")
    nearer: float = 0.0

    def position(self, intent: Intent) -> Position:
        """The swing."""
        return ArmPosition(cast("Displacement", intent), arm=self.pivot)

    def face(self, motion: Displacement) -> SwingingFace:
        """The face."""
        from camgeo.curve.disc import SwingingFace

        return SwingingFace.on(motion, self.base_radius, self.pivot, self.nearer, self.sense)

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:
        """A face on an arm."""
        raise NotImplementedError

    def grown(self, out: float, scale: float) -> Cam:
        """The same swing of a face that stands farther out on its arm."""
        base, nearer = scale * (self.base_radius + out), scale * (self.nearer - out)
        return replace(self, base_radius=base, nearer=nearer, pivot=scale * self.pivot)


# --- recipe -----------------------------------------------------------------------------------------------------------

_SIDE = Field(
    "side",
    Kind.CHOICE,
    "trailing: the cam's surface runs from the pivot to the contact; leading: the other way",
    default="trailing",
    choices=("trailing", "leading"),
)
_PIVOT = length("pivot", "distance of the arm's pivot from the shaft", required=True)
_ROUND_ARM = Field(
    "arm",
    Kind.TABLE,
    "an arm in place of a stem: the follower oscillates, and strokes are degrees",
    table=Table((length("length", "from the pivot to the roller's centre", required=True), _PIVOT, _SIDE)),
)
_FACE_ARM = Field(
    "arm",
    Kind.TABLE,
    "an arm in place of a stem: the follower oscillates, and strokes are degrees",
    table=Table(
        (
            _PIVOT,
            coordinate("face", "how much nearer the shaft than its parallel through the pivot", default="0"),
            _SIDE,
        )
    ),
)
_OFFSET = coordinate("offset", "eccentricity of the stem's line, above 0 on the side of the rise", default="0")

FOLLOWERS: dict[str, Table] = {
    "roller": Table((length("radius", "radius of the roller", required=True), _OFFSET, _ROUND_ARM)),
    "knife-edge": Table((_OFFSET, _ROUND_ARM)),
    "shoe": Table((length("radius", "radius of the curved shoe", required=True), _OFFSET, _ROUND_ARM)),
    "flat": Table(
        (
            Field(
                "tilt",
                Kind.ANGLE,
                "turn of the face's normal ahead of travel",
                default="0",
                at_least=-80,
                at_most=80,
            ),
            _OFFSET,
            length("width", "width of the face, centred on the stem's axis"),
            _FACE_ARM,
        )
    ),
}


def _read_follower(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    return reader.one_of(field, node, path)


FOLLOWER = Form(
    "a follower",
    "a mapping with the kind of follower and its fields",
    _read_follower,
    lambda _: one_of_schema("follower", FOLLOWERS),
    tables=FOLLOWERS,
    group="follower of kind",
)

TABLE = Table(
    (
        length(
            "base_radius", "radius of the cam's own circle at displacement 0, or of a ring's opening", required=True
        ),
        Field("follower", Kind.OWN, "what follows the cam, on a stem or an arm", required=True, form=FOLLOWER),
        Field(
            "track",
            Kind.CHOICE,
            "which side of the metal is followed: internal is the opening of a ring",
            default="external",
            choices=("external", "internal"),
        ),
        replace(motion_field("motion", Kind.STROKE, "motion over one turn, 360 degrees"), required=True),
        UNDERCUT,
    ),
    later=("conjugate", "groove", "sizing"),
)


def variant(node: Node) -> type[Cam]:
    """Give the class of a cam as written, by its follower."""
    follower = entries(node).get("follower") if isinstance(node, Mapping) else None
    arm = isinstance(follower, Mapping) and "arm" in entries(follower)
    if kind_of(follower, FOLLOWERS) == "flat":
        return OscillatingFaceCam if arm else TranslatingFaceCam
    return OscillatingRoundCam if arm else TranslatingRoundCam


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the turn, and keys that do not go with an arm or a flat face."""
    if "motion" in cam:
        check_filled(cam["motion"], "cam.motion", 2.0 * math.pi, "one turn, 360 degrees", reader, why=_WHY)
    follower = cam.get("follower", {})
    for key in ("offset", "tilt", "width"):
        if "arm" in follower and key in follower:
            reader.fault_at(f"cam.follower.{key}", "belongs to a stem, not to an arm", None, "leave it out")
    if cam.get("track") == "internal" and follower.get("kind") in {"knife-edge", "shoe", "flat"}:
        reader.fault_at("cam.track", "a ring is followed by a roller", "internal", "give a roller, or leave track out")


def build(cam: Values, mm: float) -> Cam:
    """Make the cam of values in which there is no fault."""
    follower: Values = dict(cam["follower"])
    kind, arm = follower.pop("kind"), follower.pop("arm", None)
    stroke = mm if arm is None else math.pi / 180
    common: Values = {
        "base_radius": cam["base_radius"],
        "motion": build_motion(cam["motion"], stroke),
        "undercut": cam.get("undercut", "refuse"),
        "touch": {"flat": "flat face", "knife-edge": "knife edge"}.get(kind, kind),
    }
    if arm is not None:
        common |= {"side": "trailing", **arm}
    if kind == "flat":
        if arm is None:
            return TranslatingFaceCam(**common, **follower)
        common["nearer"] = common.pop("face", 0.0)
        return OscillatingFaceCam(**common)
    common["track"] = cam.get("track", "external")
    return TranslatingRoundCam(**common, **follower) if arm is None else OscillatingRoundCam(**common, **follower)


FAMILY = Family(TranslatingRoundCam, TABLE, build, check, variant)
