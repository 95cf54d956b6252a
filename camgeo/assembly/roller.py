"""Wunderlich's followers: an arm with two rollers under the cam, and a rigid pair of flat faces round it.

The arm lies between base and cam, its rollers stand up into the plane of the cam: so its pivot may stand under the
cam, as in W Figure 5, and no bracket has to reach over it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.assembly.assembly import GROUND, Assembly, Fit, Member
from camgeo.assembly.body import Plate
from camgeo.assembly.poses import Turning, swinging
from camgeo.assembly.shaft import CLIP_COLOUR, base, base_radius, bearing, shaft_fits, turned
from camgeo.assembly.shapes import bar, box, disc, eye, moved, pin, retainer
from camgeo.assembly.sizes import THIN, BodyError
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.assembly.shaft import Drive
    from kin.law.transmission import Transmission

ARM_COLOUR, ROLLER_COLOUR = "#4f8f5f", "#8a6fb0"
LOOKS = 720
SIDES = ((-1.0, "a"), (1.0, "b"))


def double_roller(law: Transmission, radius: float, drive: Drive) -> Assembly:
    """Return the mechanism of a double roller.

    The rollers have their nominal radius and touch the cam.
    """
    s, disk, reach = drive.sizes, drive.disk, drive.reach
    low = s.plate + s.gap
    high = low + s.link
    cam_low = max(high + s.gap, s.plate + s.gap - disk.bottom)
    cam_high = cam_low + disk.thickness
    ends = [(law.arm * math.cos(side * law.alpha), law.arm * math.sin(side * law.alpha)) for side, _ in SIDES]
    place, pivot = swinging(law, law.arm), (law.arm, 0.0)
    plates = [Plate(bar((0.0, 0.0), end, s.bar), (eye(s),), low, high) for end in ends]
    rollers = []
    for end, (_, name) in zip(ends, SIDES, strict=True):
        plates += pin(s, end, high, cam_low, cam_high)
        wheel = Plate(disc(radius, *end), (eye(s, *end),), cam_low, cam_high)
        rollers.append(Member(f"roller-{name}", (wheel,), f"roller-{name}", place, ROLLER_COLOUR))
        rollers.append(Member(f"retainer-{name}", retainer(s, end, cam_high), "arm", place, CLIP_COLOUR))
    # where the cam passes over the pivot there is no room for a retainer, and no need: the cam lies on the arm
    covered = law.arm - max(0.5 * s.bar, s.boss) - s.space < reach
    held = [] if covered else [Member("retainer-pivot", retainer(s, pivot, high), GROUND, colour=CLIP_COLOUR)]
    width = max(2.0 * base_radius(drive), reach)
    foot = bearing(drive, [bar((0.0, 0.0), pivot, width)], cam_low + disk.bottom - s.gap)
    ground = base((*foot, *pin(s, pivot, s.plate, low, high, crowned=not covered)))
    members = (Member("arm", tuple(plates), "arm", place, ARM_COLOUR), *rollers, ground, *held)
    fits = (
        *shaft_fits(drive),
        Fit("arm on the pivot", s.clearance),
        Fit("rollers on their pins", s.clearance),
        Fit("retainers on pins", s.press, pressed=True),
    )
    touching = frozenset(frozenset({"cam", f"roller-{name}"}) for _, name in SIDES)
    remarks = ("the cam passes over the pivot: it keeps the arm on its pin, which has no retainer",) if covered else ()
    return Assembly((*turned(drive, cam_low, Turning(), members), *members), fits, s, touching, remarks)


def flat_pair(law: Transmission, drive: Drive) -> Assembly:
    """Return the mechanism of a rigid pair of flat faces, each half the clearance away from the cam.

    Raises BodyError where the cam passes so near to the pivot that there is no room for its hub.
    """
    from kin.follower.envelope import PairSupport

    s, disk, reach = drive.sizes, drive.disk, drive.reach
    away, half = 2.0 * law.arm, 0.5 * law.alpha
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    hub, inner = min(s.bar, away - reach - s.space), 0.5 * s.hole + THIN
    if hub < inner + THIN:
        most = 2.0 * (away - reach - s.space - 2.0 * THIN) - s.clearance
        remedy = "give at most {most}" if most >= 1.0 else "give a cam with less swing"
        message = "the cam passes {near} from the pivot: no room for its hub"
        raise BodyError("mechanism.pin", message, remedy, near=away - reach, most=most)
    support, phi = PairSupport(law), TURN * np.arange(LOOKS) / LOOKS
    swing = 0.5 * law.psi_of_shaft(phi, 0)[0]
    plates = [Plate(disc(hub), (eye(s),), low, high)]
    for side, _ in SIDES:
        q, slope = support.derivatives(phi + side * half - swing, 1)
        direction = side * half - swing
        c, n = np.cos(direction), np.sin(direction)
        lever = np.hypot(q * c - slope * n - away, q * n + slope * c)  # of the contact about the pivot
        along = side * (half + 0.5 * math.pi)
        y0, y1 = sorted((-side * s.gap_each_side, -side * (s.gap_each_side + s.bar)))
        plates.append(Plate(moved(box(inner, y0, float(lever.max()) + s.bar, y1), 0.0, 0.0, along), (), low, high))
    place, pivot = swinging(law, away, 0.5), (away, 0.0)
    pair = Member("pair", tuple(plates), "pair", place, ARM_COLOUR)
    width = max(2.0 * base_radius(drive), reach)
    foot = bearing(drive, [bar((0.0, 0.0), pivot, width)], low + disk.bottom - s.gap)
    ground = base((*foot, *pin(s, pivot, s.plate, low, high)))
    members = (pair, ground, Member("retainer-pivot", retainer(s, pivot, high), GROUND, colour=CLIP_COLOUR))
    fits = (
        Fit("the pair's faces about the cam", s.clearance),
        *shaft_fits(drive),
        Fit("pair on the pivot", s.clearance),
        Fit("retainer on the pivot", s.press, pressed=True),
    )
    return Assembly((*turned(drive, low, Turning(), members), *members), fits, s)
