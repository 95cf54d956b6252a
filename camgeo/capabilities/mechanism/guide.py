"""A guide on the base for a stem along x: two blocks with pegs, and a cap pressed on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism.assembly import GROUND, Assembly, BodyFit, Member, Plate
from camgeo.capabilities.mechanism.poses import Turning
from camgeo.capabilities.mechanism.shaft import (
    GROUND_COLOUR,
    base,
    bearing,
    least_pad_radius,
    shaft_fits,
    shaft_members,
)
from camgeo.capabilities.mechanism.shapes import box, disc

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.capabilities.mechanism.shaft import Drive
    from camgeo.capabilities.mechanism.sizes import Sizes

LENGTH = 2.0  # of a guide, in widths of its stem: a shorter one jams


def guide_length(s: Sizes) -> float:
    """Length of a guide, mm."""
    return LENGTH * s.bar


def half_width(s: Sizes) -> float:
    """Half the width of a guide with its two blocks, each with pegs, mm."""
    return 0.5 * s.bar + s.gap_each_side + s.bar


def guide(
    name: str, start: float, low: float, high: float, s: Sizes, *, line: float = 0.0
) -> tuple[tuple[Plate, ...], Member]:
    """Plates of a guide, and its cap with a `name`, for a stem from z = `low` to `high` about y = `line`; mm.

    The guide reaches from x = `start` over `guide_length`.
    """
    end, top = start + guide_length(s), high + s.gap
    inner, outer = 0.5 * s.bar + s.gap_each_side, half_width(s)
    plates, holes = [], []
    # a foot under a stem that is raised, then the blocks on both sides, each with two pegs for the cap
    if low - s.gap - s.plate > 0.5 * s.gap:
        plates.append(Plate(box(start, line - outer, end, line + outer), (), s.plate, low - s.gap))
    for side in (-1.0, 1.0):
        y0, y1 = sorted((line + side * inner, line + side * outer))
        plates.append(Plate(box(start, y0, end, y1), (), s.plate, top))
        for x in (start + 0.5 * s.bar, end - 0.5 * s.bar):
            y = 0.5 * (y0 + y1)
            plates.append(Plate(disc(0.5 * s.pin, x, y), (), top, top + s.clip))
            holes.append(disc(0.5 * (s.pin - s.press), x, y))
    cap = Plate(box(start, line - outer, end, line + outer), tuple(holes), top, top + s.clip)
    return tuple(plates), Member(name, (cap,), GROUND, colour=GROUND_COLOUR)


def guided_assembly(
    moving: Sequence[Member],
    guides: Sequence[tuple[str, float]],
    stem: tuple[float, float],
    cam_low: float,
    drive: Drive,
    *,
    fits: Sequence[BodyFit] = (),
    touching: frozenset[frozenset[str]] = frozenset(),
    remarks: tuple[str, ...] = (),
    line: float = 0.0,
) -> Assembly:
    """All bodies of a mechanism with a stem: cam, shaft, base with guides, their caps, and the `moving` bodies.

    `guides` has a name and the x at which it starts for each guide; `stem` has z of the stem's lower and upper face,
    its middle is at y = `line`; `cam_low` is z of the disc's lower face; all in mm. `fits` are the fits of the moving
    bodies, `touching` pairs of names that touch by design, `remarks` sentences on what bodies do not show.
    """
    s, disk = drive.sizes, drive.disk
    plates: list[Plate] = []
    caps: list[Member] = []
    ends = [0.0]
    for name, start in guides:
        blocks, cap = guide(f"cap-{name}", start, *stem, s, line=line)
        plates += blocks
        caps.append(cap)
        ends += [start, start + guide_length(s)]
    # one rectangular base plate under the bearing of the shaft and all guides
    radius, wide = least_pad_radius(drive), half_width(s)
    half = max(wide, radius)
    low, high = min(line - wide, -radius), max(line + wide, radius)
    pad = box(min(*ends, -half), low, max(*ends, half), high)
    ground = base((*bearing(drive, [pad], cam_low + disk.bottom - s.gap), *plates))
    members = (*moving, ground, *caps)
    every = (
        *fits,
        *shaft_fits(drive),
        BodyFit("stem in its guide", s.clearance),
        BodyFit("cap on its pegs", s.press, pressed=True),
    )
    return Assembly((*shaft_members(drive, cam_low, Turning(), members), *members), every, s, touching, remarks)
