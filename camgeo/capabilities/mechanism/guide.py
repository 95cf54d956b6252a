"""A guide on the base for a stem along x: two blocks with pegs, and a cap pressed on them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism.assembly import GROUND, Member
from camgeo.capabilities.mechanism.body import Plate
from camgeo.capabilities.mechanism.shaft import GROUND_COLOUR
from camgeo.capabilities.mechanism.shapes import box, disc

if TYPE_CHECKING:
    from camgeo.capabilities.mechanism.sizes import Sizes

LENGTH = 2.0  # of a guide, in widths of its stem: a shorter one jams


def guide_length(s: Sizes) -> float:
    """Return the length of a guide."""
    return LENGTH * s.bar


def half_width(s: Sizes) -> float:
    """Half the width of a guide with its blocks: each holds a peg."""
    return 0.5 * s.bar + s.gap_each_side + s.bar


def guide(
    name: str, start: float, low: float, high: float, s: Sizes, *, line: float = 0.0
) -> tuple[tuple[Plate, ...], Member]:
    """Return the plates of a guide from x = `start`, and its cap, for a stem between z = `low` and `high`.

    The stem's middle is the `line` at that y.
    """
    end, top = start + guide_length(s), high + s.gap
    inner, outer = 0.5 * s.bar + s.gap_each_side, half_width(s)
    plates, holes = [], []
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
