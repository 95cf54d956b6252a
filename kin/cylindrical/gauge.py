"""The gauges of a drum: a roller without ends for each of its flanks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kin.cylindrical.led_gauge import LedGauge
from kin.cylindrical.lifts import Lifts
from kin.cylindrical.roller import Gauge

if TYPE_CHECKING:
    from kin.cylindrical.intent import DrumIntent
    from kin.law.contacts import Side


def gauges_of(drum: DrumIntent) -> tuple[Gauge, ...]:
    """The gauges of a drum's flanks, the lower one first."""
    own, track = drum.follower, drum.track
    lifts = Lifts(own.law, own.turns)
    floor = drum.floor

    def gauge(side: Side) -> Gauge:
        name, beside = ("lower" if side < 0 else "upper"), track.beside(side)
        common = (name, side, own.radius + track.larger(side), own.level + beside, own.inner, own.outer, lifts, floor)
        if own.arm is None and not own.offset and not own.taper:
            return Gauge(*common)
        return LedGauge(*common, own.guide(beside), own.growth, own.at or 0.0, drum.radius)

    return tuple(gauge(side) for side in track.sides)
