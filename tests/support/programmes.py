"""Motions of a few segments, made as recipes make them."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from kin.law.sources import programme as sources
from kin.law.sources.laws import named as law

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.normalised import Law
    from kin.law.sources.motion import Motion

__all__ = ["Segment", "law", "programme"]


class Segment(NamedTuple):
    """A rise, a return or a dwell over an angle, rad, by a stroke above 0."""

    kind: str
    over: float
    stroke: float = 0.0
    law: Law | None = None


def programme(segments: Sequence[Segment], total: float) -> Motion:
    """The motion over a part of a turn, of which nothing is said beyond its end."""
    sense = {"rise": 1.0, "return": -1.0}
    steps = [
        sources.Dwell(one.over) if one.law is None else sources.Move(one.over, one.law, by=sense[one.kind] * one.stroke)
        for one in segments
    ]
    return sources.programme(steps, total, around=None)
