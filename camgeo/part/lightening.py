"""Round holes that lighten the disc, placed where there is room."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.part.feature import Feature, FeatureCheck, Placed, angle, count, optional
from camgeo.schema.fields import length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.part.feature import Callout, Circle, SheetView, Site
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class Lightening:
    """Round holes that are placed where there is room, `wall`, mm, from every edge.

    Their number is `ring`, of equal holes at equal angles from the direction `start`, rad, or at most `largest`, each
    the largest that still fits. `least` is the least diameter, mm; None for twice the wall.
    """

    wall: float
    ring: int | None = None
    largest: int | None = None
    least: float | None = None
    start: float = 0.0


def _check(part: Values, reader: Reader) -> None:
    lightening = part["lightening"]
    if "largest" in lightening and "start" in lightening:
        reader.fault_at("part.lightening.start", "needs a ring", None, "leave it out")


def _place(lightening: Lightening, site: Site) -> Placed:
    """Holes between the contour and the openings that are there, and the check of their number."""
    from camgeo.part.largest_holes import Space, largest, ring
    from camgeo.part.shapes import disc
    from kin.numeric.check import Check
    from kin.numeric.lengths import UNIT, length_words

    space = Space(site.looks, site.openings, lightening.wall, site.edge)
    least = 2.0 * lightening.wall if lightening.least is None else lightening.least
    if lightening.ring is not None:
        wanted = enough = lightening.ring
        circles = ring(space, wanted, lightening.start, least)
    else:
        wanted, enough = lightening.largest or 0, 1
        circles = largest(space, wanted, least)
    holes = [disc(f"lightening hole {k + 1}", "HOLES", centre, 0.5 * d) for k, (centre, d) in enumerate(circles)]
    across = [diameter for _, diameter in circles]
    sizes = f", {length_words(min(across))} to {length_words(max(across))} {UNIT} across" if across else ""
    area = 0.25 * math.pi * sum(d * d for d in across)
    detail = (
        f"{len(holes)} of {wanted} holes{sizes}, {length_words(lightening.wall)} {UNIT} from every edge, "
        f"{length_words(area, '.4g', 2)} {UNIT}^2"
    )
    ok = len(holes) >= enough
    return Placed(holes, Check(FEATURE.name, ok, len(holes), enough, "holes", None, "at_least", detail=detail))


def _callouts(lightening: Lightening, view: SheetView) -> list[Callout]:
    holes = view.named("lightening hole")
    if holes and lightening.ring is not None:
        first = f"first at {view.degrees(lightening.start)}"
        return [view.holes(holes, first), view.circle("hole circle", 2.0 * math.hypot(*holes[0][0]))]
    equal: dict[str, list[Circle]] = {}
    for hole in holes:
        equal.setdefault(view.number(2.0 * hole[1]), []).append(hole)
    return [
        view.holes(group, *(f"at X{view.number(x)} Y{view.number(y)}" for (x, y), _ in group))
        for group in equal.values()
    ]


FEATURE = Feature(
    Lightening,
    optional(
        "lightening",
        "round holes placed where there is room",
        count("ring", "that many equal holes at equal angles about the shaft", least=2),
        count("largest", "up to that many holes, each the largest that still fits"),
        length("wall", "wall left to every edge", required=True),
        length("least", "least diameter of a hole", default="twice the wall"),
        angle("start", "direction of the first hole of a ring"),
        alternatives=("ring", "largest"),
    ),
    of_ring=False,
    holes=True,
    check=_check,
    place=_place,
    judged=FeatureCheck("lightening", "holes", exact=True, files="none"),
    callouts=_callouts,
)
