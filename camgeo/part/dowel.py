"""A dowel hole."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.part.feature import Feature, angle, optional
from camgeo.schema.fields import length
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.part.feature import Callout, SheetView
    from camgeo.part.shapes import Opening


@dataclass(frozen=True)
class Dowel:
    """Round hole of diameter `hole`, mm, its centre on a circle of diameter `circle`, mm, in direction `at`, rad."""

    circle: float
    hole: float
    at: float = 0.0


def _openings(dowel: Dowel) -> list[Opening]:
    from camgeo.part.shapes import hole_at

    return [hole_at("dowel hole", dowel.circle, dowel.hole, dowel.at)]


def _callouts(dowel: Dowel, view: SheetView) -> tuple[Callout, ...]:
    note = f"dowel at {view.degrees(dowel.at)}"
    return view.holes(view.named("dowel hole"), note), view.circle("dowel circle", dowel.circle)


FEATURE = Feature(
    Dowel,
    optional(
        "dowel",
        "dowel hole",
        length("circle", "diameter of the circle about the shaft that its centre lies on", required=True),
        length("hole", "diameter of the hole", required=True),
        angle("at", "direction of the hole"),
    ),
    locates=True,
    holes=True,
    openings=_openings,
    round=("dowel", "part.dowel.hole"),
    callouts=_callouts,
)
