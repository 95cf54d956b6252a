"""The motion of a followed contour as the segments of a recipe: dwells, and strokes by the laws that fit them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.motions.recognised import STROKES_BEGIN, Recognised, roundest
from kin.follower.recognised import WholeTurn, recognised
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.capabilities.follow.follower import FollowerDescription
    from camgeo.schema.change import Value
    from kin.follower.measured import MeasuredMotion
    from kin.follower.recognised import Programme

ROUND = 0.25  # of the reading, by which round numbers may move the motion
LEAST = 1e-9  # mm or rad: nothing is known better
FITTED = 180  # positions of a turn to which laws are fitted: more cost more, and tell hardly more
ROUNDS = 30  # of the secant by which a position is found; it settles in a few


class Laws(NamedTuple):
    """A motion as segments: `rows`, or None and `why` there are none, in words.

    `base` is the base radius at displacement 0, mm. `lines` are text on each stroke, and `off` is the greatest distance
    of the segments from the motion, mm or degrees. `begin` is the shaft angle, degrees, at which a turn of the motion
    would have to begin for segments, None where that would not help.
    """

    rows: list[Value] | None
    base: float = math.nan
    lines: tuple[str, ...] = ()
    off: float = math.nan
    why: str = ""
    begin: float | None = None


def laws_of(motion: MeasuredMotion, follower: FollowerDescription, reading: float, facets: float) -> Laws:
    """Segments that keep within the `reading` of a motion over a whole turn, as round as that lets them be.

    `reading`, and `facets`, by which the positions of a polygon may be off, are in the motion's unit, mm or rad.
    """
    position = motion.rows[0]
    turn = WholeTurn(position, facets / 3.0)
    # laws are fitted to a part of the positions, and held to all of them
    part = replace(turn, position=position[:: _stride(len(position))])
    programme = recognised(part, reading, motion.unit) if np.ptp(position) > 2.0 * reading else None
    if programme is None:
        return Laws(None, why="there are no strokes between dwells or turning points")
    programme = programme.written(turn, programme.boundaries, programme.levels)
    scale = 1.0 if motion.unit == "mm" else math.degrees(1.0)
    # as round as the facets or a share of the reading let them be; else as the residuals say
    error = max(facets, ROUND * reading)
    angles, levels = programme.uncertainty
    open_ = np.maximum(angles, error * programme.hidden.boundaries), np.maximum(levels, error)
    why = ""
    for told, most in (
        (replace(programme, uncertainty=open_), min(programme.greatest + error, reading)),
        (programme, reading),
    ):
        base, moved = _base(told, follower)
        found = Recognised(turn, told, most - abs(moved), scale, motion.unit)
        rows, why = found.segments()
        if rows is not None:
            lines = Recognised(turn, programme, reading, scale, motion.unit).lines()
            return Laws(rows, base, tuple(lines), scale * max(found.left + abs(moved), LEAST))
    begin = _beginning(motion, programme, reading) if why == STROKES_BEGIN else None
    return Laws(None, why=why, begin=begin)


def _stride(count: int) -> int:
    """The greatest divisor of a number of positions that leaves FITTED of them or more."""
    return next(stride for stride in range(max(count // FITTED, 1), 0, -1) if count % stride == 0)


def _base(programme: Programme, follower: FollowerDescription) -> tuple[float, float]:
    """Base radius, mm, as round as the lowest level is known; and how far it moves the position, mm or rad."""
    lowest = int(programme.levels.argmin())
    level, unsure = float(programme.levels[lowest]), float(programme.uncertainty[1][lowest])
    radius = follower.base_radius(level)
    base = roundest(radius, max(abs(follower.base_radius(level + unsure) - radius), LEAST))
    # the position at that radius, by the secant
    last, here = level + max(unsure, LEAST), level
    for _ in range(ROUNDS):
        slope = follower.base_radius(here) - follower.base_radius(last)
        if slope == 0.0:
            break
        last, here = here, here - (follower.base_radius(here) - base) * (here - last) / slope
    return base, here - level


def _beginning(motion: MeasuredMotion, programme: Programme, reading: float) -> float:
    """Shaft angle, degrees, at which a turn of the motion begins best: amid its first dwell, else between strokes."""
    rests = motion.dwells(reading)
    if rests:
        return round(math.degrees(0.5 * (rests[0].begin + rests[0].end)))
    return math.degrees(float(programme.boundaries[0]))
