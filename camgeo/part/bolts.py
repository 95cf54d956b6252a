"""A bolt circle: equal round holes at equal angles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.part.feature import Feature, angle, check_below, count, optional
from camgeo.schema.fields import length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.part.feature import Callout, SheetView
    from camgeo.part.shapes import Opening
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class Bolts:
    """Bolt circle of equal round holes at equal angles, the first in direction `start`, rad.

    `circle` is the diameter of the circle through their centres, `hole` that of each hole, mm.
    """

    count: int
    circle: float
    hole: float
    start: float = 0.0


def _check(part: Values, reader: Reader) -> None:
    bolts = part["bolts"]
    if bolts.keys() >= {"count", "circle", "hole"} and bolts["count"] > 1:
        apart = bolts["circle"] * math.sin(math.pi / bolts["count"])
        check_below(reader, "part.bolts.hole", bolts["hole"], apart, "the distance between two of them")


def _openings(bolts: Bolts) -> list[Opening]:
    from camgeo.part.shapes import hole_at

    angles = (bolts.start + 2.0 * math.pi * k / bolts.count for k in range(bolts.count))
    return [hole_at(f"bolt hole {k + 1}", bolts.circle, bolts.hole, at) for k, at in enumerate(angles)]


def _callouts(bolts: Bolts, view: SheetView) -> tuple[Callout, ...]:
    first = f"first at {view.degrees(bolts.start)}"
    return view.holes(view.named("bolt hole"), first), view.circle("bolt circle", bolts.circle)


FEATURE = Feature(
    Bolts,
    optional(
        "bolts",
        "bolt circle",
        count("count", "number of holes", required=True),
        length("circle", "diameter of the circle about the shaft that their centres lie on", required=True),
        length("hole", "diameter of each hole", required=True),
        angle("start", "direction of the first hole"),
    ),
    holes=True,
    check=_check,
    openings=_openings,
    round=("bolt hole", "part.bolts.hole"),
    callouts=_callouts,
)
