"""A cam that moves a plate along x: a yoke of two flat faces, or one flat face that gravity or a spring holds on it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.mechanism.assembly import Assembly, BodyFit, Member, Plate
from camgeo.capabilities.mechanism.guide import guide_length, guided_assembly
from camgeo.capabilities.mechanism.poses import stem_place
from camgeo.capabilities.mechanism.shapes import box, transformed
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.shaft import Drive
    from camgeo.synthesis.view import View
    from kin.law.contacts import Flat, Translating

PLACES = 720  # of a turn, at which extents are taken; stems are longer by more than samples miss
SHAFT = TURN * np.arange(PLACES) / PLACES
FOLLOWER_COLOUR = "#4f8f5f"
LOOSE = "gravity or a spring holds the follower on the cam: one flat face does not"


def yoke(view: View[Translating, Flat], drive: Drive) -> Assembly:
    """Bodies of a yoke of two flat faces, with a stem at either end.

    The yoke's axes have x = 0 in the nominal face 1; each face is half the clearance farther out.
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
    follower = Member("yoke", (frame, *stems), "yoke", stem_place(view.design.motion), FOLLOWER_COLOUR)
    faces = [BodyFit("the yoke's faces about the cam", s.clearance)]
    guides = [("right", first), ("left", last - guide_length(s))]
    return guided_assembly([follower], guides, (low, high), low, drive, fits=faces)


def face_on_stem(view: View[Translating, Flat], drive: Drive) -> Assembly:
    """Bodies of a flat face on a stem, without clearance: gravity or a spring keeps the face on the cam.

    The face crosses the stem's middle line in the origin of the follower's axes; its normal is turned by its tilt.
    """
    s, disk, tilt, line = drive.sizes, drive.disk, view.touch.tilt, view.guide.offset
    x = view.datum + view.travel(SHAFT)[0]
    contact, margin = view.place(SHAFT), 0.5 * s.bar
    face = float(contact.min()) - margin, float(contact.max()) + margin
    if view.touch.width is not None:
        face = -0.5 * view.touch.width, 0.5 * view.touch.width
    # the face as a plate of a wall's thickness, as long as the contact travels, and the guide clear of it
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    half = 0.5 * s.bar
    plate = transformed(box(0.0, face[0], s.wall, face[1]), 0.0, 0.0, tilt)
    first = max(float(x.max()) + float(plate.box()[2]), drive.reach if tilt or line else 0.0) + s.space
    end = first + guide_length(s) + s.space - float(x.min())
    # behind a tilted face the stem begins within the plate
    lean = half * abs(math.tan(tilt))
    begin = max(lean, s.wall / math.cos(tilt) - lean)
    plates = Plate(plate, (), low, high), Plate(box(begin, -half, end, half), (), low, high)
    follower = Member("follower", plates, "follower", stem_place(view.design.motion, view.datum, line), FOLLOWER_COLOUR)
    touching = frozenset({frozenset({"cam", follower.name})})
    return guided_assembly(
        [follower], [("right", first)], (low, high), low, drive, touching=touching, remarks=(LOOSE,), line=line
    )
