"""Following a contour: the motion that it gives a follower, for programs and for the command `camgeo follow`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, overload

from camgeo.capabilities.follow.extension import OTHER_INPUTS
from camgeo.capabilities.follow.followed import Followed
from camgeo.capabilities.follow.follower import TRACKS, describe_follower
from camgeo.capabilities.follow.outline import Reading, read_outline
from camgeo.common.arguments import demand_type, number_of, path_of, short_repr, text_of, tuple_of, whole_of
from camgeo.common.errors import CallError, with_packages
from camgeo.common.rounding import upward
from camgeo.common.terminal import escaped
from camgeo.common.units import UNIT_MM
from camgeo.schema.fields import MOST
from kin.follower.measured import measured
from kin.follower.motion_error import ContactError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from os import PathLike

    from camgeo.capabilities.follow.extension import FollowedOver, OtherInputs
    from camgeo.capabilities.follow.follower import FollowerDescription, Track
    from camgeo.common.units import Units
    from kin.follower.measured import MeasuredMotion

READING = 0.01  # mm: default tolerance of dwells about their level, and of a recipe's motion about the rows
STEPS = 720  # of a turn by default
LEAST_STEPS, MOST_STEPS = 36, 100_000
MOST_TURN = 360
LENGTHS = 2  # coordinates of a place


@overload
def follow(
    file: str | PathLike[str],
    *,
    roller: float | None = None,
    shoe: float | None = None,
    flat: bool = False,
    width: float | None = None,
    offset: float = 0.0,
    arm: tuple[float, ...] | float | None = None,
    leading: bool = False,
    yoke: bool = False,
    track: Track = "external",
    units: Units | None = None,
    gap: float | None = None,
    across: Literal["arc", "chord"] | None = None,
    mirror: Literal["x", "y"] | None = None,
    turn: float = 0.0,
    body: int | str | None = None,
    at: tuple[float, float] = (0.0, 0.0),
    rotation: Literal["cw", "ccw"] = "cw",
    reading: float = READING,
    steps: int = STEPS,
) -> Followed: ...
@overload  # needs: cylindrical
def follow(file: str | PathLike[str], *, drum: str, **of_drums: Any) -> FollowedOver: ...  # noqa: ANN401 # needs: cylindrical
@overload  # needs: linear
def follow(file: str | PathLike[str], *, linear: tuple[float, ...], **of_plates: Any) -> FollowedOver: ...  # noqa: ANN401 # needs: linear
@with_packages()
def follow(
    file: str | PathLike[str],
    *,
    roller: float | None = None,
    shoe: float | None = None,
    flat: bool = False,
    width: float | None = None,
    offset: float = 0.0,
    arm: tuple[float, ...] | float | None = None,
    leading: bool = False,
    yoke: bool = False,
    track: Track = "external",
    units: Units | None = None,
    gap: float | None = None,
    across: Literal["arc", "chord"] | None = None,
    mirror: Literal["x", "y"] | None = None,
    turn: float = 0.0,
    body: int | str | None = None,
    at: tuple[float, float] = (0.0, 0.0),
    rotation: Literal["cw", "ccw"] = "cw",
    reading: float = READING,
    steps: int = STEPS,
    **other: object,
) -> Followed | FollowedOver:
    """Motion of a follower that runs on the contour of a drawing or a solid; lengths in mm.

    The follower has a `roller` or a curved `shoe` of a radius, a roller of 0 being a knife edge, or is `flat`, perhaps
    of a `width` that is centred on the stem's axis. It is led on a line of travel that passes the shaft at `offset`, or
    on an `arm`: the distance of its pivot from the shaft, and with a round touch the length. The arm trails, or is
    `leading`. A `yoke` has a second contact opposite. By its `track` a roller runs in the opening of a ring
    ("internal") or in a "groove", where its motion is that on the inner flank. The shaft is `at` a place of the file
    and turns by `rotation`; the follower is along x at shaft angle 0. `units` is the unit of a file that states none.
    Ends of a drawing within `gap` are joined, by default those that the file's digits or its size explain. `across`
    closes a contour that is open, by an arc about the shaft or a chord. The contour is mirrored in the axis `mirror`
    through the shaft, then turned counter-clockwise by `turn`, degrees. Of a solid with several bodies `body` is the
    number, from 1, or the name of one. A dwell is within `reading` of its level. The motion is given at `steps` equal
    steps of a turn, from 36 to 100,000.

    Cams that are no discs have arguments of their own (`other`): docs/follow.md lists them.

    Raises CallError for a file that cannot be read or has no such contour, for arguments that are wrong or do not go
    together, where the follower does not meet the contour or its contact leaves a face of `width`, and for a roller
    that no groove holds; SurroundingsError for a package that is missing, TypeError for an argument that is
    unknown or of a wrong type.
    """
    # arguments are checked first
    path = path_of("file", file)
    for name, value in (("flat", flat), ("leading", leading), ("yoke", yoke)):
        demand_type(name, value, bool, "a bool")
    lengths = {"roller": roller, "shoe": shoe, "width": width}
    touch = {name: None if value is None else number_of(name, value) for name, value in lengths.items()}
    text_of("track", track, tuple(TRACKS), "a track")
    beside = number_of("offset", offset)
    led = tuple_of("arm", () if arm is None else arm if isinstance(arm, tuple) else (arm,))
    if units is not None:
        text_of("units", units, tuple(UNIT_MM), "a unit")
    text_of("rotation", rotation, ("cw", "ccw"), "a rotation")
    place = tuple_of("at", at)
    if len(place) != LENGTHS or not all(math.isfinite(value) and abs(value) <= MOST for value in place):
        raise CallError("at is the place of the shaft in the file: two lengths in mm, x and y")
    bridged = None if gap is None else number_of("gap", gap)
    if bridged is not None and not 0.0 < bridged <= MOST:
        raise CallError(f"a gap is a length above 0, not {short_repr(gap)}")
    if across is not None:
        text_of("across", across, ("arc", "chord"), "a way to close a contour")
    if mirror is not None:
        text_of("mirror", mirror, ("x", "y"), "an axis")
    if body is not None and not isinstance(body, str):
        whole_of("body", body)
    turned = number_of("turn", turn)
    if not abs(turned) <= MOST_TURN:
        raise CallError(f"a contour is turned by at most {MOST_TURN} degrees, not {short_repr(turn)}")
    level, count = number_of("reading", reading), whole_of("steps", steps)
    if not 0.0 < level <= MOST:
        raise CallError(f"a reading is a length above 0, not {short_repr(reading)}")
    if not LEAST_STEPS <= count <= MOST_STEPS:
        raise CallError(f"a turn is looked at in {LEAST_STEPS} to {MOST_STEPS} steps, not {short_repr(steps)}")
    given: dict[str, object] = {
        "flat": flat,
        "leading": leading,
        "yoke": yoke,
        "track": track,
        **touch,
        "offset": beside,
    }
    if (answers := _of_other(other)) is not None and answers.follow is not None:
        from argparse import Namespace

        if count != STEPS:
            raise CallError("steps are of discs: leave steps out")
        given |= {"file": path, "arm": led or None, "units": units, "gap": bridged, "across": across, "mirror": mirror}
        given |= {"turn": turned, "body": body, "at": place, "rotation": rotation, "reading": level}
        unset = dict(answers.alone.values())
        return answers.follow(Namespace(**given, **{**unset, **other}))
    follower = describe_follower(**touch, flat=flat, offset=beside, arm=led, leading=leading, yoke=yoke, track=track)
    # the contour, and the follower by contact on it
    unit = None if units is None else UNIT_MM[units]
    asked = Reading(
        unit,
        (place[0], place[1]),
        track,
        bridged,
        across,
        mirror,
        math.radians(turned),
        mirrored=rotation == "ccw",
        body=body,
    )
    outline = read_outline(path, asked)
    try:
        motion = measured(outline.contour, follower.contacts, count, follower.side, outline.outer)
    except ContactError as error:
        remedy = "give the machine's offset or arm, and its shaft by at"
        raise CallError(f"{escaped(str(path))}: {error}; {remedy}") from error
    _require_on_face(escaped(str(path)), motion, width)
    _require_groove(escaped(str(path)), motion, follower)
    return Followed(path, follower, rotation, (place[0], place[1]), unit, level, asked, outline, motion)


def _require_on_face(name: str, motion: MeasuredMotion, width: float | None) -> None:
    """Raise CallError where the contact leaves a face of a width that is centred on the stem's axis."""
    if width is None or motion.travel is None:
        return
    low, high = motion.travel
    needed = 2.0 * max(abs(low), abs(high))
    if needed > width:
        raise CallError(
            f"{name}: the contact leaves the face: it runs from {low:.6g} to {high:.6g} mm along it; give width "
            f"{upward(needed)} or more, or leave it out"
        )


def _require_groove(name: str, motion: MeasuredMotion, follower: FollowerDescription) -> None:
    """Raise CallError where a roller's play between two flanks, or its overlap with them, exceeds its diameter."""
    if follower.track != "groove" or motion.apart is None:
        return
    low, high = (follower.motion_to_mm * value for value in motion.apart)
    if max(-low, high) > 2.0 * follower.touch.radius:
        raise CallError(
            f"{name}: no groove for this roller, whose play between the two outermost contours round the shaft would "
            f"be {low:.6g} to {high:.6g} mm: leave track out, or give another roller"
        )


def _of_other(other: Mapping[str, object]) -> OtherInputs | None:
    """Answers of the capability whose cams are asked for by arguments beside those of discs; None without any.

    Raises TypeError for an argument that nothing knows, CallError for one that goes with another, and for arguments of
    two kinds of cams.
    """
    every = [answers for name in OTHER_INPUTS.answering() if (answers := OTHER_INPUTS[name]).option] if other else []
    found = [answers for answers in every if other.get(answers.option) is not None]
    for name in other:
        owners = [answers for answers in every if name in {answers.option, *dict(answers.alone.values())}]
        if not owners:
            raise TypeError(f"follow() got an unexpected keyword argument {name!r}")
        if name != owners[0].option and owners[0] not in found:
            raise CallError(f"{name} goes with {owners[0].option}: give both, or leave {name} out")
    if len(found) > 1:
        raise CallError(f"a cam is of one kind: give {' or '.join(answers.option for answers in found)}, not both")
    return found[0] if found else None
