"""Arms: Wunderlich's with two rollers under the cam, and a rigid pair of flat faces round it; rollers on pins.

An arm with rollers lies between base and cam, its rollers in the plane of the cam above it. So its pivot may be under
the cam, as in W Figure 5, and no bracket has to reach over the cam. An arm's origin is its pivot.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.assembly import GROUND, Assembly, BodyFit, Member, Plate
from camgeo.capabilities.mechanism.poses import Turning, rocking_place
from camgeo.capabilities.mechanism.shaft import CLIP_COLOUR, base, bearing, least_pad_radius, shaft_fits, shaft_members
from camgeo.capabilities.mechanism.shapes import bar, box, disc, eye, pin, retainer, transformed
from camgeo.capabilities.mechanism.sizes import LINE, THIN, BodyError, require_thickness
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.mechanism.assembly import Place
    from camgeo.capabilities.mechanism.shaft import Drive
    from camgeo.capabilities.mechanism.shapes import Point
    from camgeo.synthesis.view import View
    from kin.law.contacts import Flat, Oscillating, Roller

ARM_COLOUR, ROLLER_COLOUR = "#4f8f5f", "#8a6fb0"
PLACES = 720  # of a turn, at which contacts are taken
SIDES = ((-1.0, "a"), (1.0, "b"))


@dataclass(frozen=True)
class ArmHeights:
    """Heights z, mm: the carrier of a foot from `low` to `high`, the cam's disc, and the body that touches the cam."""

    low: float
    high: float
    cam_low: float
    cam_high: float
    touch_low: float
    touch_high: float

    @staticmethod
    def over_base(drive: Drive) -> ArmHeights:
        """Heights with the carrier over the base and the cam over both; with a groove the carrier is over the cam.

        Raises BodyError for a groove too shallow for a roller.
        """
        s, disk = drive.sizes, drive.disk
        if disk.pocket is not None:
            require_thickness("cam.track.groove.depth", disk.pocket, s.gap + LINE)
            cam_low = s.plate + s.gap - disk.bottom
            cam_high = cam_low + disk.thickness
            low = cam_high + s.gap
            return ArmHeights(low, low + s.link, cam_low, cam_high, cam_high - disk.pocket + s.gap, cam_high)
        low = s.plate + s.gap
        high = low + s.link
        cam_low = max(high + s.gap, s.plate + s.gap - disk.bottom)
        cam_high = cam_low + disk.thickness
        return ArmHeights(low, high, cam_low, cam_high, cam_low, cam_high)


@dataclass(frozen=True)
class Foot:
    """The part of a follower in the plane of the cam, in the axes of the carrier to which it belongs.

    The carrier ends at `end`, mm. `plates` are one piece with the carrier; `members` are roller and retainer on it;
    `touches` is the name of the body that touches the cam.
    """

    end: Point
    plates: tuple[Plate, ...]
    touches: str
    members: tuple[Member, ...] = ()


def roller_foot(
    centre: Point,
    radius: float,
    carrier: tuple[str, Place],
    drive: Drive,
    *,
    names: tuple[str, str] = ("roller", "roller"),
) -> Foot:
    """A roller of its nominal `radius` on its pin at `centre`, mm, in the axes of the carrier.

    `carrier` is the name and the place of the body that has the pin; `names` are the roller's name and the ending of
    its retainer's. In a groove the roller is under the carrier, without retainer. Raises BodyError for a groove too
    shallow for a roller.
    """
    s, z = drive.sizes, ArmHeights.over_base(drive)
    (group, place), (name, clip_name) = carrier, names
    wheel = Plate(disc(radius, *centre), (eye(s, *centre),), z.touch_low, z.touch_high)
    roller = Member(name, (wheel,), name, place, ROLLER_COLOUR)
    if drive.disk.pocket is not None:
        return Foot(centre, (Plate(disc(0.5 * s.pin, *centre), (), z.touch_low, z.low),), name, (roller,))
    clip = Member(f"retainer-{clip_name}", retainer(s, centre, z.cam_high), group, place, CLIP_COLOUR)
    return Foot(centre, pin(s, centre, z.high, z.cam_low, z.cam_high), name, (roller, clip))


def double_roller(view: View[Oscillating, Roller], drive: Drive) -> Assembly:
    """Bodies of a double roller on an arm."""
    away, alpha = view.guide.pivot, view.contacts[0].apart
    place = rocking_place(view.design.motion, away)
    ends = [(away * math.cos(side * alpha), away * math.sin(side * alpha)) for side, _ in SIDES]
    feet = [
        roller_foot(end, view.touch.radius, ("arm", place), drive, names=(f"roller-{name}", name))
        for end, (_, name) in zip(ends, SIDES, strict=True)
    ]
    return arm_assembly(place, away, feet, drive)


def overlap(away: float, drive: Drive) -> float:
    """Overlap of the cam's circle and the retainer of a pivot `away` mm from the shaft, mm; 0 or less if apart."""
    s = drive.sizes
    return drive.reach - (away - max(0.5 * s.bar, s.boss) - s.space)


def arm_assembly(
    place: Place,
    away: float,
    feet: Sequence[Foot],
    drive: Drive,
    remarks: tuple[str, ...] = (),
    *,
    fits: Sequence[BodyFit] = (),
) -> Assembly:
    """All bodies of a mechanism with an arm: cam, shaft, base, arm with its feet, and retainers.

    The arm moves with `place` about a pivot `away` mm from the shaft; feet are in the arm's axes. `fits` are the fits
    of the feet on the cam, `remarks` sentences on what bodies do not show. Raises BodyError for a groove too shallow
    for a roller.
    """
    s, z, pivot = drive.sizes, ArmHeights.over_base(drive), (away, 0.0)
    plates = [Plate(bar((0.0, 0.0), foot.end, s.bar), (eye(s),), z.low, z.high) for foot in feet]
    plates += [plate for foot in feet for plate in foot.plates]
    running = [member for foot in feet for member in foot.members]
    # a cam that passes over the pivot lies on the arm, in the place of a retainer
    under = overlap(away, drive) > 0.0
    clips = [] if under else [Member("retainer-pivot", retainer(s, pivot, z.high), GROUND, colour=CLIP_COLOUR)]
    width = max(2.0 * least_pad_radius(drive), drive.reach)
    base_plates = bearing(drive, [bar((0.0, 0.0), pivot, width)], z.cam_low + drive.disk.bottom - s.gap)
    ground = base((*base_plates, *pin(s, pivot, s.plate, z.low, z.high, crowned=not under)))
    members = (Member("arm", tuple(plates), "arm", place, ARM_COLOUR), *running, ground, *clips)
    every = (*fits, *shaft_fits(drive), BodyFit("arm on the pivot", s.clearance), *roller_fits(feet, drive))
    touching = frozenset(frozenset({"cam", foot.touches}) for foot in feet)
    if under:
        remarks = ("the cam passes over the pivot: it keeps the arm on its pin, which has no retainer", *remarks)
    return Assembly((*shaft_members(drive, z.cam_low, Turning(), members), *members), every, s, touching, remarks)


def roller_fits(feet: Sequence[Foot], drive: Drive, *, clipped: bool = True) -> list[BodyFit]:
    """Fits of rollers, if any of the feet has one, and of retainers, if the assembly has any (`clipped`)."""
    s = drive.sizes
    running = [BodyFit("rollers on their pins", s.clearance)] if any(foot.members for foot in feet) else []
    return [*running, BodyFit("retainers on pins", s.press, pressed=True)] if clipped else running


def flat_pair(view: View[Oscillating, Flat], drive: Drive) -> Assembly:
    """Bodies of a rigid pair of flat faces, each half the clearance away from the cam.

    Raises BodyError where the cam passes so near to the pivot that its hub does not fit.
    """
    s, disk, reach = drive.sizes, drive.disk, drive.reach
    away, half = view.guide.pivot, view.contacts[0].apart
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    hub, inner = min(s.bar, away - reach - s.space), 0.5 * s.hole + THIN
    if hub < inner + THIN:
        most = 2.0 * (away - reach - s.space - 2.0 * THIN) - s.clearance
        remedy = "give at most {most}" if most >= 1.0 else "give a cam with less swing"
        message = "the cam passes {near} from the pivot: no room for its hub"
        raise BodyError("mechanism.pin", message, remedy, near=away - reach, most=most)
    plates = [Plate(disc(hub), (eye(s),), low, high)]
    for (side, _), contacts in zip(SIDES, view.contact_points_fixed(TURN * np.arange(PLACES) / PLACES), strict=True):
        lever = np.abs(contacts - away)  # distances of the contact from the pivot
        along = side * (half + 0.5 * math.pi)
        y0, y1 = sorted((-side * s.gap_each_side, -side * (s.gap_each_side + s.bar)))
        plates.append(
            Plate(transformed(box(inner, y0, float(lever.max()) + s.bar, y1), 0.0, 0.0, along), (), low, high)
        )
    pair = Member("pair", tuple(plates), "pair", rocking_place(view.design.motion, away), ARM_COLOUR)
    return pivoted_assembly(
        pair, away, (low, high), drive, fits=(BodyFit("the pair's faces about the cam", s.clearance),)
    )


def pivoted_assembly(
    follower: Member,
    away: float,
    heights: tuple[float, float],
    drive: Drive,
    *,
    fits: tuple[BodyFit, ...] = (),
    touching: frozenset[frozenset[str]] = frozenset(),
    remarks: tuple[str, ...] = (),
) -> Assembly:
    """All bodies of a mechanism whose follower is in the plane of the cam, about a pivot `away` mm from the shaft.

    `heights` are z of the lower and upper face of the cam's disc and the follower, mm; `fits` are the follower's fits
    on the cam, `touching` pairs of names that touch by design, `remarks` sentences on what bodies do not show.
    """
    s, pivot, (low, high) = drive.sizes, (away, 0.0), heights
    pads = [bar((0.0, 0.0), pivot, max(2.0 * least_pad_radius(drive), drive.reach))]
    ground = base((*bearing(drive, pads, low + drive.disk.bottom - s.gap), *pin(s, pivot, s.plate, low, high)))
    members = (follower, ground, Member("retainer-pivot", retainer(s, pivot, high), GROUND, colour=CLIP_COLOUR))
    every = (
        *fits,
        *shaft_fits(drive),
        BodyFit(f"{follower.name} on the pivot", s.clearance),
        BodyFit("retainer on the pivot", s.press, pressed=True),
    )
    return Assembly((*shaft_members(drive, low, Turning(), members), *members), every, s, touching, remarks)
