"""Disc cams for one follower in a recipe: keys, faults between them, and the cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.cams.conjugate import CONJUGATE, check_conjugate, conjugate_of
from camgeo.cams.disc_cams import DiscCam
from camgeo.cams.family import UNDERCUT, Family
from camgeo.cams.groove import TRACK, Groove
from camgeo.cams.guided import Holding
from camgeo.cams.preload import PRELOAD, build_preload
from camgeo.cams.sizing import SIZING, SizedDiscCam, Sizing, find_size
from camgeo.motions.by_motion import ByMotion
from camgeo.motions.inputs import TURN
from camgeo.motions.motion import check_whole_turn, motion_field
from camgeo.motions.segments import LEAST
from camgeo.schema.fields import Field, FieldTable, Kind, coordinate, length
from camgeo.schema.reader import kind_of
from camgeo.schema.readers import form_of_kinds
from camgeo.schema.yaml_source import Mapping as Written
from camgeo.schema.yaml_source import entries
from kin.law.contacts import (
    LEADING,
    TRAILING,
    Arrangement,
    Flat,
    Guide,
    KnifeEdge,
    Oscillating,
    Roller,
    Shoe,
    Touch,
    Translating,
)

if TYPE_CHECKING:
    from camgeo.schema.change import Value
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

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
    table=FieldTable((length("length", "from the pivot to the roller's centre", required=True), _PIVOT, _SIDE)),
)
_FACE_ARM = Field(
    "arm",
    Kind.TABLE,
    "an arm in place of a stem: the follower oscillates, and strokes are degrees",
    table=FieldTable(
        (
            _PIVOT,
            coordinate("face", "how much nearer the shaft than its parallel through the pivot", default="0"),
            _SIDE,
        )
    ),
)
_OFFSET = coordinate("offset", "eccentricity of the stem's line, above 0 on the side of the rise", default="0")

FOLLOWERS: dict[str, FieldTable] = {
    "roller": FieldTable((length("radius", "radius of the roller", required=True), _OFFSET, _ROUND_ARM)),
    "knife-edge": FieldTable((_OFFSET, _ROUND_ARM)),
    "shoe": FieldTable((length("radius", "radius of the curved shoe", required=True), _OFFSET, _ROUND_ARM)),
    "flat": FieldTable(
        (
            Field(
                "tilt", Kind.ANGLE, "turn of the face's normal ahead of travel", default="0", at_least=-80, at_most=80
            ),
            _OFFSET,
            length("width", "width of the face, centred on the stem's axis"),
            length("diameter", "diameter of a round tappet in place of a width"),
            coordinate("axial_offset", "how far its axis stands beside the middle of the lobe", default="0"),
            _FACE_ARM,
        )
    ),
}


ON_DISC_2 = (0.0, 1.0)  # shares of a preload: disc 2 alone grows
FOLLOWER = form_of_kinds("follower", FOLLOWERS, "follower of kind")

TABLE = FieldTable(
    (
        length("base_radius", "radius of the cam's own circle at displacement 0, or of a ring's opening"),
        SIZING,
        Field("follower", Kind.OWN, "what follows the cam, on a stem or an arm", required=True, form=FOLLOWER),
        TRACK,
        CONJUGATE,
        motion_field("motion", Kind.STROKE, "motion over one turn, 360 degrees", over=TURN, required=True),
        PRELOAD,
        UNDERCUT,
    ),
    alternatives=(("base_radius", ()), ("sizing", ())),
)


def variant(node: Node) -> Arrangement:
    """Arrangement of the cam at a node of the recipe: guide, touch and number of discs."""
    follower = entries(node).get("follower") if isinstance(node, Written) else None
    arm = isinstance(follower, Written) and "arm" in entries(follower)
    discs = 2 if isinstance(node, Written) and "conjugate" in entries(node) else 1
    touch = TOUCHES.get(kind_of(follower, FOLLOWERS), Roller)
    return Arrangement(Oscillating if arm else Translating, touch, discs, discs)


TOUCHES: dict[str, type[Touch]] = {"roller": Roller, "knife-edge": KnifeEdge, "shoe": Shoe, "flat": Flat}


def check(cam: Values, reader: Reader) -> None:
    """Note segments that do not fill the turn, and keys that contradict each other; find the size under `sizing`."""
    if "motion" in cam:
        check_whole_turn(cam["motion"], "cam.motion", reader)
        _check_open(cam, reader)
    follower = cam.get("follower", {})
    arm = follower.get("arm")
    for key in ("offset", "tilt", "width", "diameter", "axial_offset"):
        if arm is not None and key in follower:
            reader.fault_at(f"cam.follower.{key}", "belongs to a stem, not to an arm", None, "leave it out")
    if cam.get("track") == "internal" and follower.get("kind") in {"knife-edge", "shoe", "flat"}:
        reader.fault_at("cam.track", "a ring is followed by a roller", "internal", "give a roller, or leave track out")
    if cam.get("track") == "internal" and "radius-of-curvature" in cam.get("sizing", {}):
        # it is that of the pitch curve's convex places, where the metal of a ring is hollow
        remedy = "give pressure-angle alone, or base_radius in place of sizing"
        reader.fault_at("cam.sizing.radius-of-curvature", "does not size a ring", None, remedy)
    if arm is not None and "pivot" not in arm and "sizing" not in cam and "cam.follower.arm.pivot" not in reader.marks:
        remedy = "give a length above 0, its distance from the shaft, or sizing in place of base_radius"
        reader.fault(reader.marks["cam.follower.arm"], "cam.follower.arm.pivot", "missing", None, remedy)
    if "conjugate" in cam:
        check_conjugate(cam, reader)
    if "preload" in cam and "cam.conjugate" not in reader.marks:
        problem, remedy = "one contact alone is not preloaded", "give conjugate, or leave preload out"
        if isinstance(cam.get("track"), dict):
            problem, remedy = (
                "a roller in a groove needs clearance",
                "for preload take conjugate discs, or leave it out",
            )
        reader.fault_at("cam.preload", problem, None, remedy)
    if "sizing" in cam and not reader.errors:
        _size(cam, reader)


def _check_open(cam: Values, reader: Reader) -> None:
    """Note an open angle beside `sizing`, or without limits that bound it."""
    angles = cam["motion"].open
    if angles is None:
        return
    path = f"cam.motion{'.segments' if 'cam.motion.segments' in reader.marks else ''}[{angles.index(LEAST)}].over"
    if "sizing" in cam:
        remedy = "give base_radius in place of sizing, or an angle"
        reader.fault_at(path, "the size is found for angles that are given", LEAST, remedy)
    if "limits" not in reader.marks:
        reader.fault_at(
            path, "nothing bounds it", LEAST, "give limits, such as limits: {pressure-angle: {at_most: 30}}"
        )


def _size(cam: Values, reader: Reader) -> None:
    """Find the least size and put its cam among the values; note a fault where there is none."""
    from kin.law.normalised import IntentError

    follower = cam["follower"]
    sizing = Sizing.of(cam["sizing"], follower)
    if sizing.angles is None and sizing.radius is None:
        reader.fault_at("cam.sizing", "no limit is given", None, "give pressure-angle, radius-of-curvature or both")
        return
    start = SizedDiscCam(**_values({**cam, "base_radius": 1.0, "follower": _with_pivot(follower)}), sizing=sizing)
    try:
        cam["sized"] = find_size(start)
    except IntentError as error:
        path = f"cam.{error.field}"
        remedy = "" if error.field.startswith("motion") else "give base_radius instead"  # no size mends a motion
        if error.field.endswith(".pivot"):
            remedy = "leave it out, or give base_radius in place of sizing"
        if path.startswith("cam.conjugate"):  # which says what would do
            remedy = "or give base_radius instead"
        reader.fault_at(path if path in reader.marks else "cam.sizing", error.message, None, remedy)


def _with_pivot(follower: Values) -> Values:
    """The follower with a provisional pivot, where an arm lacks one."""
    arm = follower.get("arm")
    return follower if arm is None else {**follower, "arm": {"pivot": arm.get("length", 1.0), **arm}}


def build(cam: Values, mm: float) -> DiscCam:  # noqa: ARG001 - as all cams' build
    """Build the cam from values of a recipe in which no fault was noted; `mm` is the recipe's unit of length, mm."""
    if "sized" in cam:
        sized: DiscCam = cam["sized"]
        return sized
    return DiscCam(**_values(cam))


def _values(cam: Values) -> Values:
    """Fields of the cam, from values without fault."""
    follower: Values = dict(cam["follower"])
    arm = follower.get("arm")
    if arm is None:
        guide: Guide = Translating(follower.get("offset", 0.0))
    else:
        side = TRAILING if arm.get("side", "trailing") == "trailing" else LEADING
        guide = Oscillating(arm["pivot"], side, arm.get("length"))
    touch = _touch(follower, arm or {})
    return {
        "base_radius": cam["base_radius"],
        "guide": guide,
        "touch": touch,
        "motion": cam["motion"],
        "undercut": cam.get("undercut", "refuse"),
        "side": -1 if cam.get("track") == "internal" else 1,
        "holding": _holding(cam, touch),
        "beyond": follower.get("beyond", 0.0),
        "preload": build_preload(cam, ON_DISC_2),
    }


def _holding(cam: Values, touch: Touch) -> Holding:
    """Way in which the follower is held on the cam, from values without fault."""
    if "conjugate" in cam:
        return conjugate_of(cam["conjugate"], touch)
    track = cam.get("track")
    return Groove(**track["groove"]) if isinstance(track, dict) else Holding()


def _touch(follower: Values, arm: Values) -> Touch:
    match follower["kind"]:
        case "flat":
            return Flat(follower.get("tilt", 0.0), follower.get("width"), arm.get("face", 0.0))
        case "knife-edge":
            return KnifeEdge()
        case "shoe":
            return Shoe(follower["radius"])
    return Roller(follower["radius"])


_STILL: list[Value] = [{kind: 0.01, "over": 180.0, "law": "cycloidal"} for kind in ("rise", "return")]
BY_MOTION = ByMotion(motion="motion", base="base_radius", still=("motion", _STILL))
FAMILY = Family(DiscCam.kind, Arrangement(Translating, Roller), TABLE, build, check, BY_MOTION, variant)
