"""A round hub about the shaft, on one side of the disc or on both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from camgeo.common.rounding import upward
from camgeo.part.bore import LEAST_SIZE, diameter_of
from camgeo.part.feature import Boss, Feature, FeatureCheck, Refusal, optional, size_words
from camgeo.schema.fields import Field, Kind, length
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from camgeo.part.body import Body
    from camgeo.part.walls import Looks, Possible
    from camgeo.schema.reader import Reader, Values


@dataclass(frozen=True)
class Hub:
    """Round hub about the shaft: `height` mm beyond the face of the disc, on one side or on both."""

    diameter: float
    height: float
    side: Literal["top", "bottom", "both"] = "top"


def _check(part: Values, reader: Reader) -> None:
    bore, diameter = diameter_of(part), part["hub"].get("diameter")
    if bore is None or diameter is None or diameter > bore + 2.0 * LEAST_SIZE:
        return
    problem = "not above the bore" if diameter <= bore else "no wall round the bore"
    remedy = f"give more than {upward((bore + 2.0 * LEAST_SIZE) / reader.mm)} {reader.units}"
    reader.fault_at("part.hub.diameter", problem, size_words(diameter, reader), remedy)


def _boss(hub: Hub) -> Boss:
    above = 0.0 if hub.side == "bottom" else hub.height
    return Boss("hub", hub.diameter, above, 0.0 if hub.side == "top" else hub.height)


def _walls(hub: Hub, body: Body, surfaces: Sequence[Looks]) -> Iterator[Possible]:
    """Walls between the hub and all else; a hole may pass beside the hub or through it."""
    from camgeo.part.walls import inside_gap, known, outside_gap, to_surface

    boss = _boss(hub)
    circle = boss.circle
    yield to_surface(circle, body, surfaces)
    for opening in body.openings:
        within = opening.name == "bore" or boss.holds(opening)
        gap = (inside_gap if within else outside_gap)(opening.chain, circle.chain)
        yield known(opening.name, boss.name, gap)


def _grown(hub: Hub, out: float, scale: float) -> Hub:
    return replace(hub, diameter=scale * (hub.diameter + 2.0 * out), height=scale * hub.height)


FEATURE = Feature(
    Hub,
    optional(
        "hub",
        "hub about the shaft",
        length("diameter", "diameter of the hub", required=True),
        length("height", "height beyond the face of the disc", required=True),
        Field(
            "side",
            Kind.CHOICE,
            "which side of the disc: top is the side that the drawing shows",
            default="top",
            choices=("top", "bottom", "both"),
        ),
    ),
    needs=(("thickness", "a hub stands on the disc"),),
    of_ring=False,
    of_pair=False,
    grooved=Refusal(
        "a groove is milled from the top face",
        "leave it out, or give it side: bottom",
        unless=lambda keys: bool(keys.get("side", "top") == "bottom"),
    ),
    walled=True,
    check=_check,
    boss=_boss,
    walls=_walls,
    round=("hub", "part.hub.diameter"),
    judged=FeatureCheck("hub"),
    grown=_grown,
    steadies="a wider or a higher part.hub",
    remark=lambda hub, mm: f"hub: diameter {hub.diameter / mm:.9g}, height {hub.height / mm:.9g}, side {hub.side}",
    unmilled="the stock comes with it, its disc as thick as part.thickness",
)
