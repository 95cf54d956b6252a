"""Disc cams for one follower: roller, knife edge, curved shoe or flat face, on a stem or on an arm; and in a ring."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, cast

from camgeo.cams.faced import FacedCam
from camgeo.cams.family import UNDERCUT, Cam, Family, Follower, GrownError, Intent, Undercut, Unit
from camgeo.cams.guided import GuidedCam
from camgeo.cams.motion import MotionAsked, check_whole_turn, motion_field
from camgeo.cams.position import ArmPosition, LiftPosition, Position
from camgeo.cams.sizing import SIZING, Sizing, demand_kept, size_arm, size_face, size_stem
from camgeo.common.rounding import upward
from camgeo.recipe.schema.fields import Field, Form, Kind, Table, coordinate, length
from camgeo.recipe.schema.json_schema import one_of_schema
from camgeo.recipe.schema.reader import kind_of
from camgeo.recipe.schema.yaml_source import Mapping as Written
from camgeo.recipe.schema.yaml_source import entries

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.curve.disc import StraightFace, SwingingFace
    from camgeo.curve.moving_frame import Displacement, Oscillating, Translating
    from camgeo.recipe.schema.reader import Reader, Values
    from camgeo.recipe.schema.yaml_source import Node
    from kin.follower.follower import Follower as Judged
    from kin.law.joints import Joint
    from kin.law.sources.motion import Motion

Side: TypeAlias = Literal["trailing", "leading"]
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

    gain: ClassVar[float | None] = None
    radius: float = 0.0
    track: Track = "external"

    @property
    def touch_radius(self) -> float:
        """Radius of the roller or shoe, mm."""
        return self.radius

    @property
    def roller_field(self) -> str:
        """A curved shoe is no roller."""
        return "shoe radius" if self.touch == "shoe" else super().roller_field

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
        if not self.radius > out:
            raise GrownError("the roller's radius", self.radius)
        base, radius = self.base_radius + self.metal * out, self.radius - out
        return {"base_radius": scale * base, "radius": scale * radius}


@dataclass(frozen=True, kw_only=True)
class TranslatingRoundCam(RoundCam):
    """The follower's centre moves along a line that passes the shaft at `offset`, mm."""

    offers: ClassVar[frozenset[str]] = RoundCam.offers | {"stem"}
    offset: float = 0.0

    @property
    def guide(self) -> Translating:
        """The line of travel."""
        from camgeo.curve.moving_frame import Translating

        return Translating.on(self.prime, self.offset)

    def sized(self, asked: Sizing, given: Mapping[str, float]) -> DiscCam:
        """The least cam that keeps what is asked."""
        return size_stem(self, asked, given)

    def _found(self, mm: float) -> str:
        return f", with offset {self.offset / mm:.9g}"

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:  # noqa: ARG002
        """One roller on a stem."""
        from kin.follower import follower, guide

        law = cast("Displacement", intent).law(self.guide.foot)
        return follower.Roller(guide.Translating(self.offset), self.radius, law, self.metal < 0)

    def grown(self, out: float, scale: float) -> Cam:
        """A smaller roller on the same pitch curve."""
        return replace(self, **self._resized(out, scale), offset=scale * self.offset)


@dataclass(frozen=True, kw_only=True)
class OscillatingRoundCam(_Arm, RoundCam):
    """The follower's centre swings at `length` about the pivot."""

    offers: ClassVar[frozenset[str]] = RoundCam.offers | {"arm"}
    length: float

    @property
    def guide(self) -> Oscillating:
        """The arm."""
        from camgeo.curve.moving_frame import Oscillating

        return Oscillating.on(self.prime, self.pivot, self.length, self.sense)

    def sized(self, asked: Sizing, given: Mapping[str, float]) -> DiscCam:
        """The least cam that keeps what is asked."""
        return size_arm(self, asked, given)

    def _found(self, mm: float) -> str:
        return f", with pivot {self.pivot / mm:.9g}"

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:  # noqa: ARG002
        """One roller on an arm."""
        from kin.follower import follower, guide

        law = cast("Displacement", intent).law(self.guide.rest)
        side = guide.TRAILING if self.sense > 0 else guide.LEADING
        return follower.Roller(guide.Arm(self.length, self.pivot, side), self.radius, law, self.metal < 0)

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

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:  # noqa: ARG002
        """A face on a stem."""
        from kin.follower import follower
        from kin.law.support_function import Lift

        lift = Lift(cast("Displacement", intent).law(self.base_radius / math.cos(self.tilt)))
        return follower.TiltedFace(lift, self.tilt) if self.tilt else follower.FlatFace(lift)

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

    def judged(self, intent: Intent, breadth: float | None, face: float) -> Judged:  # noqa: ARG002
        """A face on an arm."""
        from kin.follower import follower, guide

        motion = cast("Displacement", intent)
        rest = math.asin((self.base_radius + self.nearer) / self.pivot)
        side = guide.TRAILING if self.sense > 0 else guide.LEADING
        return follower.SwingingFace(self.pivot, self.nearer, motion.law(rest), side)

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
_PIVOT = length("pivot", "distance of the arm's pivot from the shaft")
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
        length("base_radius", "radius of the cam's own circle at displacement 0, or of a ring's opening"),
        SIZING,
        Field("follower", Kind.OWN, "what follows the cam, on a stem or an arm", required=True, form=FOLLOWER),
        Field(
            "track",
            Kind.CHOICE,
            "which side of the metal is followed: internal is the opening of a ring",
            default="external",
            choices=("external", "internal"),
        ),
        motion_field("motion", Kind.STROKE, "motion over one turn, 360 degrees", whole_turn=True, required=True),
        UNDERCUT,
    ),
    alternatives=(("base_radius", ()), ("sizing", ())),
    later=("conjugate", "groove"),
)


def variant(node: Node) -> type[Cam]:
    """Give the class of a cam as written, by its follower."""
    follower = entries(node).get("follower") if isinstance(node, Written) else None
    arm = isinstance(follower, Written) and "arm" in entries(follower)
    return _class(kind_of(follower, FOLLOWERS), arm=arm)


def _class(kind: str, *, arm: bool) -> type[DiscCam]:
    return _ARMS.get(kind, OscillatingRoundCam) if arm else _STEMS.get(kind, TranslatingRoundCam)


_STEMS: dict[str, type[DiscCam]] = {"roller": TranslatingRollerCam, "flat": TranslatingFaceCam}
_ARMS: dict[str, type[DiscCam]] = {"roller": OscillatingRollerCam, "flat": OscillatingFaceCam}


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the turn, and keys that do not go with an arm or a flat face; find a size."""
    if "motion" in cam:
        check_whole_turn(cam["motion"], "cam.motion", reader)
    follower = cam.get("follower", {})
    arm = follower.get("arm")
    for key in ("offset", "tilt", "width"):
        if arm is not None and key in follower:
            reader.fault_at(f"cam.follower.{key}", "belongs to a stem, not to an arm", None, "leave it out")
    if cam.get("track") == "internal" and follower.get("kind") in {"knife-edge", "shoe", "flat"}:
        reader.fault_at("cam.track", "a ring is followed by a roller", "internal", "give a roller, or leave track out")
    if cam.get("track") == "internal" and "radius-of-curvature" in cam.get("sizing", {}):
        # it is that of the pitch curve's convex places, where the metal of a ring is hollow
        remedy = "give pressure-angle alone, or base_radius in place of sizing"
        reader.fault_at("cam.sizing.radius-of-curvature", "does not size a ring", None, remedy)
    if arm is not None and "pivot" not in arm and "sizing" not in cam and "cam.follower.arm.pivot" not in reader.marks:
        wanted = "give a length above 0, its distance from the shaft, or sizing in place of base_radius"
        reader.fault(reader.marks["cam.follower.arm"], "cam.follower.arm.pivot", "missing", None, wanted)
    if "sizing" in cam and not reader.errors:
        _size(cam, reader)


def _size(cam: Values, reader: Reader) -> None:
    """Find the least size and put it among the values."""
    from kin.law.programme import IntentError

    asked, follower = Sizing.of(cam["sizing"]), cam["follower"]
    if asked == Sizing():
        reader.fault_at("cam.sizing", "no limit is given", None, "give pressure-angle, radius-of-curvature or both")
        return
    start = build({**cam, "base_radius": 1.0, "follower": _placed(follower)}, reader.mm)
    try:
        found = start.sized(asked, {**follower, **follower.get("arm", {})})
        demand_kept(found, asked)
    except IntentError as error:
        path = f"cam.{error.field}"
        remedy = "" if error.field.startswith("motion") else "give base_radius instead"  # no size mends a motion
        reader.fault_at(path if path in reader.marks else "cam.sizing", error.message, None, remedy)
        return
    cam["sized"] = replace(found, sizing=asked)


def _placed(follower: Values) -> Values:
    """The follower with some pivot, where it has an arm and none is given."""
    arm = follower.get("arm")
    return follower if arm is None else {**follower, "arm": {"pivot": arm.get("length", 1.0), **arm}}


def build(cam: Values, mm: float) -> DiscCam:  # noqa: ARG001
    """Make the cam of values in which there is no fault."""
    if "sized" in cam:
        sized: DiscCam = cam["sized"]
        return sized
    follower: Values = dict(cam["follower"])
    kind, arm = follower.pop("kind"), follower.pop("arm", None)
    common: Values = {
        "base_radius": cam["base_radius"],
        "motion": cam["motion"],
        "undercut": cam.get("undercut", "refuse"),
        "touch": {"flat": "flat face", "knife-edge": "knife edge"}.get(kind, kind),
    }
    if arm is not None:
        common |= {"side": "trailing", **arm}
    if kind != "flat":
        common["track"] = cam.get("track", "external")
    elif arm is not None:
        common["nearer"] = common.pop("face", 0.0)
    return _class(kind, arm=arm is not None)(**common, **follower)


FAMILY = Family(TranslatingRoundCam, TABLE, build, check, variant)
