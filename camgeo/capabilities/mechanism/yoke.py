"""A cam that moves a plate along x: a yoke of two flat faces, or one flat face that gravity or a spring holds on it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.assembly import Assembly, Fit, Member
from camgeo.capabilities.mechanism.body import Plate
from camgeo.capabilities.mechanism.guide import guide, guide_length, half_width
from camgeo.capabilities.mechanism.poses import Turning, lifted
from camgeo.capabilities.mechanism.shaft import base, base_radius, bearing, shaft_fits, turned
from camgeo.capabilities.mechanism.shapes import box, moved
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.mechanism.shaft import Drive
    from camgeo.synthesis.view import View
    from kin.law.contacts import Flat, Translating

LOOKS = 720  # angles at which extents are looked up; a stem runs on beyond them by more than a sample misses
SHAFT = TURN * np.arange(LOOKS) / LOOKS
FOLLOWER_COLOUR = "#4f8f5f"
LOOSE = "gravity or a spring holds the follower on the cam: one flat face does not"


def yoke(view: View[Translating, Flat], drive: Drive) -> Assembly:
    """Return the mechanism of a yoke.

    The yoke's own x is measured from the intended place of face 1; each face stands half the clearance farther out.
    """
    s, disk, breadth = drive.sizes, drive.disk, view.contacts[1].datum
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    p = view.travel(SHAFT)[0]
    least, most = float(p.min()), float(p.max())
    right, left = s.gap_each_side + s.wall, -breadth - s.gap_each_side - s.wall
    tall = drive.reach + s.space
    run = guide_length(s) + s.space
    # the stems reach through their guides where the yoke is farthest from them
    first, last = most + right + s.space, least + left - s.space
    ends = first + run - least, last - run - most
    frame = Plate(
        box(left, -tall - s.wall, right, tall + s.wall),
        (box(-breadth - s.gap_each_side, -tall, s.gap_each_side, tall),),
        low,
        high,
    )
    half = 0.5 * s.bar
    boxes = (box(right, -half, ends[0], half), box(ends[1], -half, left, half))
    stems = [Plate(outline, (), low, high) for outline in boxes]
    follower = Member("yoke", (frame, *stems), "yoke", lifted(view.design.motion), FOLLOWER_COLOUR)
    held = [Fit("the yoke's faces about the cam", s.clearance)]
    guides = [("right", first), ("left", last - guide_length(s))]
    return guided([follower], guides, (low, high), low, drive, fits=held)


def face_on_stem(view: View[Translating, Flat], drive: Drive) -> Assembly:
    """Return a flat face on a stem, exact and without clearance: something has to hold it on the cam.

    The face crosses the stem's middle in the origin; its normal is turned by its tilt.
    """
    s, disk, tilt, line = drive.sizes, drive.disk, view.touch.tilt, view.guide.offset
    x = view.datum + view.travel(SHAFT)[0]
    contact, margin = view.place(SHAFT), 0.5 * s.bar
    face = float(contact.min()) - margin, float(contact.max()) + margin
    if view.touch.width is not None:
        face = -0.5 * view.touch.width, 0.5 * view.touch.width
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    half = 0.5 * s.bar
    plate = moved(box(0.0, face[0], s.wall, face[1]), 0.0, 0.0, tilt)
    first = max(float(x.max()) + float(plate.box()[2]), drive.reach if tilt or line else 0.0) + s.space
    end = first + guide_length(s) + s.space - float(x.min())
    # of a tilted one the stem begins within the plate, behind the face
    lean = half * abs(math.tan(tilt))
    begin = max(lean, s.wall / math.cos(tilt) - lean)
    plates = Plate(plate, (), low, high), Plate(box(begin, -half, end, half), (), low, high)
    follower = Member("follower", plates, "follower", lifted(view.design.motion, view.datum, line), FOLLOWER_COLOUR)
    touching = frozenset({frozenset({"cam", follower.name})})
    return guided(
        [follower], [("right", first)], (low, high), low, drive, touching=touching, remarks=(LOOSE,), line=line
    )


def guided(
    moving: Sequence[Member],
    guides: Sequence[tuple[str, float]],
    stem: tuple[float, float],
    cam_low: float,
    drive: Drive,
    *,
    fits: Sequence[Fit] = (),
    touching: frozenset[frozenset[str]] = frozenset(),
    remarks: tuple[str, ...] = (),
    line: float = 0.0,
) -> Assembly:
    """Return the whole of it: the base under guides that start at some x, their caps, the shaft.

    `stem` is from where to where in height the stem is, its middle the `line` at that y; `fits` are of what moves.
    """
    s, disk = drive.sizes, drive.disk
    plates: list[Plate] = []
    caps: list[Member] = []
    ends = [0.0]
    for name, start in guides:
        found, cap = guide(f"cap-{name}", start, *stem, s, line=line)
        plates += found
        caps.append(cap)
        ends += [start, start + guide_length(s)]
    about, wide = base_radius(drive), half_width(s)
    half = max(wide, about)
    low, high = min(line - wide, -about), max(line + wide, about)
    pad = box(min(*ends, -half), low, max(*ends, half), high)
    ground = base((*bearing(drive, [pad], cam_low + disk.bottom - s.gap), *plates))
    members = (*moving, ground, *caps)
    every = (
        *fits,
        *shaft_fits(drive),
        Fit("stem in its guide", s.clearance),
        Fit("cap on its pegs", s.press, pressed=True),
    )
    return Assembly((*turned(drive, cam_low, Turning(), members), *members), every, s, touching, remarks)
