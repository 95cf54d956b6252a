"""Disc cams: a roller, a shoe or a flat face on a stem or an arm, and the frame of two opposite rollers.

Stem, arm and frame lie between base and cam, rollers and shoes stand up into the plane of the cam; a flat face lies
in that plane with all that leads it. Into a groove, which opens upward, the roller hangs from above. The axes of what
leads have their x along the travel of a stem, and from the pivot to the roller's centre on an arm, whose travel is
`side` times y.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.assembly import Assembly, Fit, Member
from camgeo.capabilities.mechanism.body import Plate
from camgeo.capabilities.mechanism.guide import guide_length
from camgeo.capabilities.mechanism.poses import lifted, swung
from camgeo.capabilities.mechanism.roller import ARM_COLOUR, Foot, Levels, arm, covered, pivoted, roller_fits, rolling
from camgeo.capabilities.mechanism.shapes import bar, box, disc, eye, moved
from camgeo.capabilities.mechanism.sizes import THIN, BodyError
from camgeo.capabilities.mechanism.yoke import SHAFT, guided
from camgeo.fit.bound import EXACT
from camgeo.fit.pieces import ArcSpline
from kin.law.contacts import Roller, Shoe

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.capabilities.mechanism.shaft import Drive
    from camgeo.capabilities.mechanism.shapes import Point
    from camgeo.synthesis.view import Round, View
    from kin.law.contacts import Flat, Guide, Oscillating, Translating
    from kin.numeric.arrays import Array

    Stand: TypeAlias = Callable[[Point, float, tuple[str, Place], Drive], Foot]
    """A point of the carrier, the direction of travel there, the carrier's name and place: what stands there."""

STEM = "stem"
KEPT = "the floor of the groove keeps the roller on its pin, which has no retainer"
SPRING = "gravity or a spring holds the follower on the cam: it touches it from one side"


def stood(view: View[Guide, Round]) -> Stand:
    """What stands up into the plane of the cam: a roller, or a shoe. Raises BodyError for a knife edge."""
    match view.touch:
        case Roller(radius=radius):
            return roller(radius)
        case Shoe(radius=radius):
            return shoe(radius, view.pressure(SHAFT))
    message, remedy = "a knife edge is not printed", "give a roller or a shoe, or leave parts: all out"
    raise BodyError("cam.follower", message, remedy)


def roller(radius: float) -> Stand:
    """Stand a roller of a radius up."""
    return lambda centre, _, carrier, drive: rolling(centre, radius, carrier, drive)


def shoe(radius: float, angle: Array) -> Stand:
    """Stand a shoe up: the arc of a radius that pressure angles (n,) use, and as much beyond that a bar fits behind."""

    def stand(centre: Point, ahead: float, carrier: tuple[str, Place], drive: Drive) -> Foot:
        s, z = drive.sizes, Levels.of(drive)
        most = 0.5 * math.pi
        wide = math.asin(min(1.0, 0.5 * s.bar / radius))
        beyond = s.space / radius
        high = min(max(float(angle.max()) + beyond, wide), most)
        low = max(min(float(angle.min()) - beyond, -wide), -most)
        x = -radius * np.cos([high, low])
        y = radius * np.sin([high, low])
        back = float(x.max()) + s.bar
        points = np.column_stack([np.append(x, [back, back]), np.append(y, [y[1], y[0]])])
        outline = ArcSpline(points, np.array([math.tan(0.25 * (high - low)), 0.0, 0.0, 0.0]), EXACT)
        foot = back - 0.5 * s.bar
        at = (centre[0] + foot * math.cos(ahead), centre[1] + foot * math.sin(ahead))
        return Foot(at, (Plate(moved(outline, *centre, ahead), (), z.high, z.cam_high),), carrier[0])

    return stand


def on_stem(view: View[Translating, Round], drive: Drive) -> Assembly:
    """Return the mechanism of a roller or a shoe on a stem."""
    s, z, line = drive.sizes, Levels.of(drive), view.guide.offset
    place = lifted(view.design.motion, view.datum, line)
    x = view.datum + view.travel(SHAFT)[0]
    foot = stood(view)((0.0, 0.0), 0.0, (STEM, place), drive)
    running = roller_fits([foot], drive, clipped=len(foot.members) > 1) if foot.members else []
    first = max(float(x.max()) + _beyond(foot), drive.reach) + s.space
    end = first + guide_length(s) + s.space - float(x.min())
    stem = Plate(bar((foot.at[0], 0.0), (end, 0.0), s.bar), (), z.low, z.high)
    members = [Member(STEM, (stem, *foot.plates), STEM, place, ARM_COLOUR), *foot.members]
    return guided(
        members,
        [("right", first)],
        (z.low, z.high),
        z.cam_low,
        drive,
        fits=(*_groove_fits(view), *running),
        touching=frozenset({frozenset({"cam", foot.touches})}),
        remarks=_held(view),
        line=line,
    )


def _held(view: View[Guide, Round]) -> tuple[str, ...]:
    """What holds the follower on the cam, where no body shows it."""
    return (SPRING,) if len(view.contacts) == 1 else (KEPT,)


def _groove_fits(view: View[Guide, Round]) -> list[Fit]:
    """That of a roller between two flanks, whose gauges differ by it."""
    first, *others = view.contacts
    return [Fit("roller in the groove", other.touch.radius - first.touch.radius) for other in others]


def _beyond(*feet: Foot) -> float:
    """How far feet reach along x in their carrier's axes."""
    plates = [plate for foot in feet for plate in (*foot.plates, *(p for m in foot.members for p in m.plates))]
    return max(float(plate.outline.box()[2]) for plate in plates)


def on_arm(view: View[Oscillating, Round], drive: Drive) -> Assembly:
    """Return the mechanism of a roller or a shoe on an arm. Raises BodyError where the cam reaches over the pivot."""
    stand, lever = stood(view), view.guide
    _clear(lever.pivot, drive)
    place = swung(view.design.motion, lever.pivot, view.datum, lever.side)
    foot = stand((lever.arm, 0.0), 0.5 * math.pi * lever.side, ("arm", place), drive)
    return arm(place, lever.pivot, [foot], drive, _held(view), fits=_groove_fits(view))


def _clear(pivot: float, drive: Drive) -> None:
    over = covered(pivot, drive)
    if over > 0.0:
        message = "the cam reaches {reach} from the shaft: no room for the arm's pivot at {pivot}"
        remedy = "give a pivot at {least} or more, with an arm to suit"
        field = "cam.follower.arm.pivot"
        raise BodyError(field, message, remedy, reach=drive.reach, pivot=pivot, least=pivot + over)


def roller_frame(view: View[Translating, Roller], drive: Drive) -> Assembly:
    """Return the mechanism of two opposite rollers in one frame.

    Raises BodyError where the slot round the shaft would run into their pins.
    """
    s, z, shaft = drive.sizes, Levels.of(drive), drive.shaft
    foot, radius = view.datum, view.touch.radius
    apart = foot + view.contacts[1].datum
    place = lifted(view.design.motion, foot)
    x = foot + view.travel(SHAFT)[0]
    least, most = float(x.min()), float(x.max())
    # the base's boss stands through the slot, and so does a hub below the disc
    about = max(shaft.journal + s.gap_each_side + s.wall, drive.disk.hub if drive.disk.bottom < 0.0 else 0.0)
    half = about + s.space
    room = least - half - s.boss
    if room < THIN:
        message = "the frame's slot round the shaft leaves no wall before the rollers' pins"
        remedy = "give a base radius larger by {such} or more, or a smaller bore or hub"
        raise BodyError("cam.base_radius", message, remedy, such=THIN - room)
    ends = [(0.0, 0.0), (-apart, 0.0)]
    feet = [
        rolling(end, radius, ("frame", place), drive, names=(f"roller-{name}", name))
        for end, name in zip(ends, ("a", "b"), strict=True)
    ]
    width = max(2.0 * (half + s.wall), s.bar)
    beyond = max(_beyond(feet[0]), 0.5 * width)
    first = max(most + beyond, drive.reach) + s.space
    last = -max(apart - least + beyond, drive.reach) - s.space
    run = guide_length(s) + s.space
    slot = bar((-most, 0.0), (-least, 0.0), 2.0 * half)
    frame = Plate(bar(ends[1], ends[0], width), (slot,), z.low, z.high)
    # stems begin behind the rollers' pins, where the frame is still as wide as they are
    rise = 0.5 * s.bar
    stems = [
        Plate(box(0.0, -rise, first + run - least, rise), (), z.low, z.high),
        Plate(box(last - run - most, -rise, -apart, rise), (), z.low, z.high),
    ]
    plates = (frame, *stems, *(plate for one in feet for plate in one.plates))
    members = [Member("frame", plates, "frame", place, ARM_COLOUR), *(m for one in feet for m in one.members)]
    return guided(
        members,
        [("right", first), ("left", last - guide_length(s))],
        (z.low, z.high),
        z.cam_low,
        drive,
        fits=roller_fits(feet, drive),
        touching=frozenset(frozenset({"cam", one.touches}) for one in feet),
    )


def face_on_arm(view: View[Oscillating, Flat], drive: Drive) -> Assembly:
    """Return the mechanism of a flat face on an arm.

    Raises BodyError where the cam leaves the hub no room, or the face passes beside the hub.
    """
    s, disk, nearer, arm_of = drive.sizes, drive.disk, view.touch.nearer, view.guide
    _clear(arm_of.pivot, drive)
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    hub, inner = 0.5 * s.hole + max(s.wall, THIN), 0.5 * s.hole + THIN
    if not -0.5 * s.bar < nearer < hub + 0.6 * s.bar:
        message = "the face passes {away} beside the pivot, and its bar beside the hub"
        remedy = "give at most {most}" if nearer > 0.0 else "give 0 or more"
        raise BodyError("cam.follower.arm.face", message, remedy, away=abs(nearer), most=hub + 0.5 * s.bar)
    y0, y1 = sorted(arm_of.side * (-nearer + y) for y in (0.0, s.bar))
    plates = (
        Plate(disc(hub), (eye(s),), low, high),
        Plate(box(inner, y0, float(view.place(SHAFT).max()) + s.bar, y1), (), low, high),
    )
    place = swung(view.design.motion, arm_of.pivot, view.datum, arm_of.side)
    follower = Member("follower", plates, "follower", place, ARM_COLOUR)
    touching = frozenset({frozenset({"cam", follower.name})})
    return pivoted(follower, arm_of.pivot, (low, high), drive, touching=touching, remarks=(SPRING,))
