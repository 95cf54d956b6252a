"""Disc cams: a roller, a shoe or a flat face on a stem or an arm, and the frame of two opposite rollers.

Stem, arm and frame lie between base and cam, with rollers and shoes in the plane of the cam above them; a flat face and
its arm lie in that plane. A groove opens upward, and the roller in it is below its carrier. A stem's axes have x along
its travel. An arm's axes have x from the pivot to the roller's centre; the centre moves along y on a trailing arm,
along -y on a leading one.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.arms import (
    ARM_COLOUR,
    ArmHeights,
    Foot,
    arm_assembly,
    overlap,
    pivoted_assembly,
    roller_fits,
    roller_foot,
)
from camgeo.capabilities.mechanism.assembly import Assembly, BodyFit, Member, Plate
from camgeo.capabilities.mechanism.guide import guide_length, guided_assembly
from camgeo.capabilities.mechanism.poses import arm_place, stem_place
from camgeo.capabilities.mechanism.shapes import bar, box, disc, eye, transformed
from camgeo.capabilities.mechanism.sizes import THIN, BodyError
from camgeo.capabilities.mechanism.yoke import SHAFT
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

    FootMaker: TypeAlias = Callable[[Point, float, tuple[str, Place], Drive], Foot]
    """Point of the carrier, direction of travel there, rad, the carrier's name and place, to the foot there."""

STEM = "stem"
NO_RETAINER = "the floor of the groove keeps the roller on its pin, which has no retainer"
SPRING = "gravity or a spring holds the follower on the cam: it touches it from one side"


def foot_maker(view: View[Guide, Round]) -> FootMaker:
    """Function that makes a foot with the view's roller or shoe; raises BodyError for a knife edge."""
    match view.touch:
        case Roller(radius=radius):
            return lambda centre, _, carrier, drive: roller_foot(centre, radius, carrier, drive)
        case Shoe(radius=radius):
            return shoe_maker(radius, view.pressure(SHAFT))
    message, remedy = "a knife edge is not printed", "give a roller or a shoe, or leave parts: all out"
    raise BodyError("cam.follower", message, remedy)


def shoe_maker(radius: float, angle: Array) -> FootMaker:
    """Function that makes a foot with a shoe of a `radius`, mm.

    The shoe has the arc that the pressure angles `angle` (n,), rad, use, with a margin, and at least a bar's width.
    """

    def make(centre: Point, ahead: float, carrier: tuple[str, Place], drive: Drive) -> Foot:
        s, z = drive.sizes, ArmHeights.over_base(drive)
        # ends of the arc, rad from the direction of travel, at most a half circle
        most = 0.5 * math.pi
        bar_half = math.asin(min(1.0, 0.5 * s.bar / radius))
        margin = s.space / radius
        high = min(max(float(angle.max()) + margin, bar_half), most)
        low = max(min(float(angle.min()) - margin, -bar_half), -most)
        # the arc faces the shaft, at -x; a straight back closes the outline, a bar's width behind its ends
        x = -radius * np.cos([high, low])
        y = radius * np.sin([high, low])
        back = float(x.max()) + s.bar
        points = np.column_stack([np.append(x, [back, back]), np.append(y, [y[1], y[0]])])
        outline = ArcSpline(points, np.array([math.tan(0.25 * (high - low)), 0.0, 0.0, 0.0]), EXACT)
        behind = back - 0.5 * s.bar
        end = (centre[0] + behind * math.cos(ahead), centre[1] + behind * math.sin(ahead))
        return Foot(end, (Plate(transformed(outline, *centre, ahead), (), z.high, z.cam_high),), carrier[0])

    return make


def on_stem(view: View[Translating, Round], drive: Drive) -> Assembly:
    """Bodies of a roller or a shoe on a stem; raises BodyError for a knife edge, and too shallow a groove."""
    s, z, line = drive.sizes, ArmHeights.over_base(drive), view.guide.offset
    place = stem_place(view.design.motion, view.datum, line)
    x = view.datum + view.travel(SHAFT)[0]
    foot = foot_maker(view)((0.0, 0.0), 0.0, (STEM, place), drive)
    # a roller has a retainer as second member, but none in a groove
    running = roller_fits([foot], drive, clipped=len(foot.members) > 1) if foot.members else []
    # x at which the guide begins, clear of foot and cam, and the stem's end in its own axes, beyond the guide at the
    # lowest position
    first = max(float(x.max()) + _greatest_x(foot), drive.reach) + s.space
    end = first + guide_length(s) + s.space - float(x.min())
    stem = Plate(bar((foot.end[0], 0.0), (end, 0.0), s.bar), (), z.low, z.high)
    members = [Member(STEM, (stem, *foot.plates), STEM, place, ARM_COLOUR), *foot.members]
    return guided_assembly(
        members,
        [("right", first)],
        (z.low, z.high),
        z.cam_low,
        drive,
        fits=(*_groove_fits(view), *running),
        touching=frozenset({frozenset({"cam", foot.touches})}),
        remarks=_contact_remarks(view),
        line=line,
    )


def _contact_remarks(view: View[Guide, Round]) -> tuple[str, ...]:
    """Remark on the spring, or the groove, that keeps follower and roller in place, as no body shows it."""
    return (SPRING,) if len(view.contacts) == 1 else (NO_RETAINER,)


def _groove_fits(view: View[Guide, Round]) -> list[BodyFit]:
    """Fit of a roller in a groove: the touches of both flanks differ in radius by its clearance; empty without."""
    first, *others = view.contacts
    return [BodyFit("roller in the groove", other.touch.radius - first.touch.radius) for other in others]


def _greatest_x(*feet: Foot) -> float:
    """Greatest x of feet and of the bodies on them, mm, in their carrier's axes."""
    plates = [plate for foot in feet for plate in (*foot.plates, *(p for m in foot.members for p in m.plates))]
    return max(float(plate.outline.box()[2]) for plate in plates)


def on_arm(view: View[Oscillating, Round], drive: Drive) -> Assembly:
    """Bodies of a roller or a shoe on an arm.

    Raises BodyError for a knife edge, too shallow a groove, and where the cam reaches over the pivot.
    """
    make_foot, lever = foot_maker(view), view.guide
    _require_clear_pivot(lever.pivot, drive)
    place = arm_place(view.design.motion, lever.pivot, view.datum, lever.side)
    foot = make_foot((lever.arm, 0.0), 0.5 * math.pi * lever.side, ("arm", place), drive)
    return arm_assembly(place, lever.pivot, [foot], drive, _contact_remarks(view), fits=_groove_fits(view))


def _require_clear_pivot(pivot: float, drive: Drive) -> None:
    """Raise BodyError where the cam reaches over the retainer of the pivot, which is `pivot` mm from the shaft."""
    excess = overlap(pivot, drive)
    if excess > 0.0:
        message = "the cam reaches {reach} from the shaft: no room for the arm's pivot at {pivot}"
        remedy = "give a pivot at {least} or more, with an arm to suit"
        field = "cam.follower.arm.pivot"
        raise BodyError(field, message, remedy, reach=drive.reach, pivot=pivot, least=pivot + excess)


def roller_frame(view: View[Translating, Roller], drive: Drive) -> Assembly:
    """Bodies of two opposite rollers in one frame with a stem at either end.

    Raises BodyError where the frame's slot round the shaft leaves no wall before the rollers' pins.
    """
    s, z, shaft = drive.sizes, ArmHeights.over_base(drive), drive.shaft
    foot, radius = view.datum, view.touch.radius
    apart = foot + view.contacts[1].datum
    place = stem_place(view.design.motion, foot)
    x = foot + view.travel(SHAFT)[0]
    least, most = float(x.min()), float(x.max())  # distances of the first roller's centre from the shaft
    # the base's boss is in the slot, and so is a hub below the disc
    boss = max(shaft.journal + s.gap_each_side + s.wall, drive.disk.hub if drive.disk.bottom < 0.0 else 0.0)
    half = boss + s.space
    wall = least - half - s.boss
    if wall < THIN:
        message = "the frame's slot round the shaft leaves no wall before the rollers' pins"
        remedy = "give a base radius larger by {such} or more, or a smaller bore or hub"
        raise BodyError("cam.base_radius", message, remedy, such=THIN - wall)
    ends = [(0.0, 0.0), (-apart, 0.0)]
    feet = [
        roller_foot(end, radius, ("frame", place), drive, names=(f"roller-{name}", name))
        for end, name in zip(ends, ("a", "b"), strict=True)
    ]
    # guides stand clear of the cam and of the frame at either end of its travel
    width = max(2.0 * (half + s.wall), s.bar)
    margin = max(_greatest_x(feet[0]), 0.5 * width)
    first = max(most + margin, drive.reach) + s.space
    last = -max(apart - least + margin, drive.reach) - s.space
    run = guide_length(s) + s.space
    slot = bar((-most, 0.0), (-least, 0.0), 2.0 * half)
    frame = Plate(bar(ends[1], ends[0], width), (slot,), z.low, z.high)
    # stems begin behind the rollers' pins, where the frame is still as wide as they are
    rise = 0.5 * s.bar
    stems = [
        Plate(box(0.0, -rise, first + run - least, rise), (), z.low, z.high),
        Plate(box(last - run - most, -rise, -apart, rise), (), z.low, z.high),
    ]
    plates = (frame, *stems, *(plate for foot in feet for plate in foot.plates))
    members = [Member("frame", plates, "frame", place, ARM_COLOUR), *(m for end in feet for m in end.members)]
    return guided_assembly(
        members,
        [("right", first), ("left", last - guide_length(s))],
        (z.low, z.high),
        z.cam_low,
        drive,
        fits=roller_fits(feet, drive),
        touching=frozenset(frozenset({"cam", end.touches}) for end in feet),
    )


def face_on_arm(view: View[Oscillating, Flat], drive: Drive) -> Assembly:
    """Bodies of a flat face on an arm.

    Raises BodyError where the cam reaches over the pivot, or the bar of the face would pass beside the pivot's hub.
    """
    s, disk, nearer, guide = drive.sizes, drive.disk, view.touch.nearer, view.guide
    _require_clear_pivot(guide.pivot, drive)
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    hub, inner = 0.5 * s.hole + max(s.wall, THIN), 0.5 * s.hole + THIN
    # the bar reaches from the face away from the cam, and outwards from `inner`, which clears the hole; the hub has to
    # reach beyond that. At the height `beside` it does by THIN, or by half its wall beyond `inner`. On the other side
    # of the pivot the bar has to lap over the hub by 0.4 of its own width. Remedies keep well within both bounds
    beside = math.sqrt(hub**2 - (inner + min(THIN, 0.5 * (hub - inner))) ** 2)
    if not -beside <= nearer < hub + 0.6 * s.bar:
        message = "the face passes {away} beside the pivot, and its bar beside the hub"
        remedy = "give at most {most}" if nearer > 0.0 else "give 0 or more"
        raise BodyError("cam.follower.arm.face", message, remedy, away=abs(nearer), most=hub + 0.5 * s.bar)
    y0, y1 = sorted(guide.side * (-nearer + y) for y in (0.0, s.bar))
    plates = (
        Plate(disc(hub), (eye(s),), low, high),
        Plate(box(inner, y0, float(view.place(SHAFT).max()) + s.bar, y1), (), low, high),
    )
    place = arm_place(view.design.motion, guide.pivot, view.datum, guide.side)
    follower = Member("follower", plates, "follower", place, ARM_COLOUR)
    touching = frozenset({frozenset({"cam", follower.name})})
    return pivoted_assembly(follower, guide.pivot, (low, high), drive, touching=touching, remarks=(SPRING,))
