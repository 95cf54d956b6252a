"""A radial hole for a set screw, from the hub's outside into the bore."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.part.bore import width_of
from camgeo.part.feature import Callout, Feature, FeatureCheck, angle, check_below, narrowed, optional
from camgeo.schema.fields import length
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from camgeo.part.body import Body
    from camgeo.part.feature import Boss, SheetView
    from camgeo.part.walls import Looks, Possible
    from camgeo.schema.reader import Reader, Values
    from kin.read.layers import CrossHole


@dataclass(frozen=True)
class SetScrew:
    """Radial hole from the hub's outside into the bore, in direction `at`, rad; lengths in mm.

    `height` is the height of its axis above the face of the disc; None for half the height of the hub.
    """

    diameter: float
    at: float = 0.0
    height: float | None = None


def _check(part: Values, reader: Reader) -> None:
    screw, hub, path = part["set_screw"], part.get("hub", {}), "part.set_screw.diameter"
    width, word = width_of(part)
    if width is not None:
        check_below(reader, path, screw.get("diameter"), width, f"the bore's {word}")
    if "height" in hub:
        check_below(reader, path, screw.get("diameter"), hub["height"], "the hub's height")
        check_below(reader, "part.set_screw.height", screw.get("height"), hub["height"], "the hub's height")


def _cross(screw: SetScrew, boss: Boss, thickness: float) -> CrossHole:
    """Radial hole of the screw, in the boss above the disc, or in the boss below where there is none above."""
    from kin.read.layers import CrossHole

    beyond = 0.5 * (boss.above or boss.below) if screw.height is None else screw.height
    return CrossHole("set screw", screw.at, screw.diameter, thickness + beyond if boss.above else -beyond)


def _walls(screw: SetScrew, body: Body, _surfaces: Sequence[Looks]) -> Iterator[Possible]:
    """Walls between the screw's hole, both faces of the hub, and the holes through the hub."""
    from camgeo.part.shapes import Opening, strip
    from camgeo.part.walls import NOWHERE, Gap, known, outside_gap

    boss = body.boss
    if boss is None or body.thickness is None:
        return
    hole = _cross(screw, boss, body.thickness)
    beyond = hole.z - body.thickness if boss.above else -hole.z
    radius = 0.5 * screw.diameter
    along = Opening(hole.name, "HOLES", strip(0.5 * boss.diameter, screw.diameter, screw.at))
    for opening in body.openings:
        if opening.name != "bore" and boss.holds(opening):
            yield known(hole.name, opening.name, outside_gap(opening.chain, along.chain))
    yield known(hole.name, "the disc's face", Gap(beyond - radius, NOWHERE))
    yield known(hole.name, "the hub's face", Gap((boss.above or boss.below) - beyond - radius, NOWHERE))


def _grown(screw: SetScrew, out: float, scale: float) -> SetScrew:
    height = None if screw.height is None else scale * screw.height
    return replace(screw, diameter=narrowed(screw.diameter, out, scale), height=height)


def _callouts(screw: SetScrew, view: SheetView) -> tuple[Callout, ...]:
    boss = view.part.boss
    if boss is None:
        return ()
    note = f"at {view.degrees(screw.at)}, {view.number(screw.height or 0.5 * (boss.above or boss.below))} up"
    text, radius, at = f"Ø{view.number(screw.diameter)} set screw", 0.5 * boss.diameter, view.direction(screw.at)
    return (Callout(text, (note,), points=((radius * math.cos(at), radius * math.sin(at)),)),)


FEATURE = Feature(
    SetScrew,
    optional(
        "set_screw",
        "hole for a set screw, through the hub",
        length("diameter", "diameter of the radial hole from the hub's outside into the bore", required=True),
        angle("at", "direction of the hole"),
        length("height", "height of its axis above the face of the disc", default="half the hub"),
    ),
    needs=(("hub", "its hole goes through the hub"), ("bore", "its hole leads into the bore")),
    of_ring=False,
    of_pair=False,
    check=_check,
    cross=_cross,
    walls=_walls,
    judged=FeatureCheck("set-screw"),
    grown=_grown,
    mirrored=lambda screw: replace(screw, at=-screw.at),
    remark=lambda screw, mm: f"set screw: radial hole through the hub, diameter {screw.diameter / mm:.9g}",
    unmilled="it runs across the shaft",
    callouts=_callouts,
)
