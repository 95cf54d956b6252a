"""A cam that moves a plate along x: a yoke of two flat faces, or one flat face that gravity or a spring holds on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.assembly.assembly import Assembly, Fit, Member
from camgeo.assembly.body import Plate
from camgeo.assembly.guide import guide, guide_length, half_width
from camgeo.assembly.poses import Turning, sliding
from camgeo.assembly.shaft import base, base_radius, bearing, shaft_fits, turned
from camgeo.assembly.shapes import box
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.assembly.shaft import Drive
    from kin.law.support_function import Lift

LOOKS = 720  # angles at which extents are looked up; a stem runs on beyond them by more than a sample misses
FOLLOWER_COLOUR = "#4f8f5f"


def yoke(lift: Lift, breadth: float, drive: Drive) -> Assembly:
    """Return the mechanism of a yoke.

    The yoke's own x is measured from the intended place of face 1; each face stands half the clearance farther out.
    """
    s, disk = drive.sizes, drive.disk
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    p = lift.derivatives(TURN * np.arange(LOOKS) / LOOKS, 0)[0]
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
    follower = Member("yoke", (frame, *stems), "yoke", sliding(lift), FOLLOWER_COLOUR)
    return _guided(follower, [("right", first), ("left", last - guide_length(s))], drive, low, held=True)


def flat_face(lift: Lift, drive: Drive) -> Assembly:
    """Return the mechanism of a single flat face, exact and without clearance: something has to hold it on the cam."""
    s, disk = drive.sizes, drive.disk
    low = s.plate + s.gap - disk.bottom
    high = low + disk.thickness
    p, slope = lift.derivatives(TURN * np.arange(LOOKS) / LOOKS, 1)
    least, most = float(p.min()), float(p.max())
    tall = float(np.abs(slope).max()) + 0.5 * s.bar
    first = most + s.wall + s.space
    end = first + guide_length(s) + s.space - least
    half = 0.5 * s.bar
    plates = Plate(box(0.0, -tall, s.wall, tall), (), low, high), Plate(box(s.wall, -half, end, half), (), low, high)
    follower = Member("follower", plates, "follower", sliding(lift), FOLLOWER_COLOUR)
    return _guided(follower, [("right", first)], drive, low, held=False)


def _guided(follower: Member, guides: list[tuple[str, float]], drive: Drive, low: float, *, held: bool) -> Assembly:
    """Return the whole of it: the base under guides that start at some x, their caps, the shaft."""
    s, disk = drive.sizes, drive.disk
    high = low + disk.thickness
    fits = [*shaft_fits(drive), Fit("stem in its guide", s.clearance), Fit("cap on its pegs", s.press, pressed=True)]
    touching: frozenset[frozenset[str]] = frozenset()
    remarks: tuple[str, ...] = ()
    if held:
        fits.insert(0, Fit("the yoke's faces about the cam", s.clearance))
    else:
        touching = frozenset({frozenset({"cam", follower.name})})
        remarks = ("gravity or a spring holds the follower on the cam: one flat face does not",)
    plates: list[Plate] = []
    caps: list[Member] = []
    ends = [0.0]
    for name, start in guides:
        found, cap = guide(f"cap-{name}", start, low, high, s)
        plates += found
        caps.append(cap)
        ends += [start, start + guide_length(s)]
    half = max(half_width(s), base_radius(drive))
    pad = box(min(*ends, -half), -half, max(*ends, half), half)
    ground = base((*bearing(drive, [pad], low + disk.bottom - s.gap), *plates))
    members = (follower, ground, *caps)
    return Assembly((*turned(drive, low, Turning(), members), *members), tuple(fits), s, touching, remarks)
