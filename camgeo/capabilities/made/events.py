"""Events of a made cam as engines have them: lift, velocity and durations at stated lifts, made against intended.

The lifts are those of the recipe's limits that state one, for the follower or for what it moves, such as a valve. Where
something is moved, the lifts at which its own figures are usually taken are added, and on a shaft the lift of the
shaft's events. A limit on a figure of a capability applies to what that capability moves.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camgeo.measures.extension import MEASURES
from camgeo.measures.lobe import CRANK, EventError, event_of, lift_pieces
from camgeo.measures.units import report_unit
from camgeo.recipe.extension import KEYS
from camgeo.recipe.figures import FIGURES
from kin.follower.recognised import COVERAGE
from kin.made.events import MadeMotion

if TYPE_CHECKING:
    from camgeo.capabilities.made.made_part import PartMade
    from camgeo.capabilities.made.options import PointOptions
    from camgeo.measures.extension import MovedBody
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.made.events import Estimate
    from kin.numeric.arrays import Array


ANGLES, DURATION = ("opens_deg", "closes_deg", "centre_deg"), "duration_crank_deg"


class StatedLift(NamedTuple):
    """A lift at which there are events.

    `lift` is the stated lift, mm or rad, of the body `moved`, or of the follower where that is None. `follower` is the
    follower's lift at the same time, mm or rad.
    """

    moved: MovedBody | None
    lift: float
    follower: float


def stated_lifts(recipe: Recipe, design: Design, events: float | None = None) -> list[StatedLift]:
    """Lifts above 0 at which a recipe has figures, and `events`, the lift of a shaft's events, mm; each once.

    Lifts of the follower come first, then those of moved bodies, each rising.
    """
    moved = {name: MEASURES[name].moved(recipe, design) for name in recipe.uses}
    lifts: list[tuple[MovedBody | None, float]] = []
    for limit in recipe.limits:
        if FIGURES[limit.figure].at_lift is not None:
            owner = FIGURES.owner(limit.figure)
            lifts.append((moved.get(owner) if owner else None, limit.lift))
    for name, own in moved.items():
        if own is not None:
            usual = (figure.at_lift for figure in KEYS[name].figures.values())
            lifts += [(own, lift) for lift in usual if lift is not None]
    lifts += [] if events is None else [(None, events)]
    rows = [StatedLift(own, lift, lift if own is None else own.follower_lift(lift)) for own, lift in lifts]
    return sorted({row for row in rows if row.follower > 0.0}, key=lambda row: (row.moved is not None, row.lift))


def events_section(
    recipe: Recipe,
    design: Design,
    result: PartMade,
    options: PointOptions,
    shaft: tuple[float | None, float] = (None, 0.0),
) -> dict[str, Any]:
    """Section of the report under the key `events`: greatest lift and velocity, and the angles of each stated lift.

    Empty where no lift is stated. `result` is the part as made. `shaft` has the lift of a shaft's events, mm or None,
    and the shaft angle, rad, at which the lobe's motion begins.
    """
    events, zero = shaft
    lifts = stated_lifts(recipe, design, events)
    if not lifts:
        return {}
    motion = MadeMotion(result.surfaces[0].gauge.motion, result.motion)
    highest = motion.highest(lift_pieces(design.exact).greatest()[1])
    scale, unit = report_unit(recipe, result.motion_unit)
    entry: dict[str, Any] = {}
    for moved in dict.fromkeys([None, *(row.moved for row in lifts)]):
        entry[_name(moved)] = {
            "lift": _greatest_lift(moved, highest, options, scale) | {"unit": unit},
            "velocity": _greatest_velocity(moved, motion, scale) | {"unit": f"{unit}/rad"},
        }
    entry["above"] = [
        {"of": _name(row.moved), "lift": scale * row.lift, "unit": unit, **_above(row, motion, design, options, zero)}
        for row in lifts
    ]
    return {"events": entry}


def _name(moved: MovedBody | None) -> str:
    return "follower" if moved is None else moved.name


def _row(scale: float, made: float, intended: float, uncertainty: float) -> dict[str, Any]:
    """A figure as made and as intended, and its expanded uncertainty, each times a scale."""
    return {"made": scale * made, "intended": scale * intended, "uncertainty": scale * uncertainty}


def _greatest_lift(moved: MovedBody | None, highest: Estimate, options: PointOptions, scale: float) -> dict[str, Any]:
    made, intended = (_moving(moved, np.array([[lift], [1.0], [0.0]])) for lift in highest[:2])
    ratio = float(made[1, 0])  # velocity of the moved body over that of the follower
    return _row(scale, float(made[0, 0]), float(intended[0, 0]), ratio * options.expanded(highest.influence))


def _greatest_velocity(moved: MovedBody | None, motion: MadeMotion, scale: float) -> dict[str, Any]:
    rows, intended = motion.lifts
    velocity = np.abs(_moving(moved, rows)[1])
    at = int(np.argmax(velocity))
    ratio = float(_moving(moved, np.array([[rows[0, at]], [1.0], [0.0]]))[1, 0])
    uncertain = COVERAGE * ratio * float(motion.errors.sds[1, at])
    return _row(scale, float(velocity[at]), float(np.abs(_moving(moved, intended)[1]).max()), uncertain)


def _moving(moved: MovedBody | None, rows: Array) -> Array:
    """Lift, velocity and acceleration (3, n) of a moved body, from those of the follower; by rad of the shaft."""
    return rows if moved is None else moved.rows(rows)


def _above(row: StatedLift, motion: MadeMotion, design: Design, options: PointOptions, zero: float) -> dict[str, Any]:
    """Angles at which a lift is crossed, degrees of the shaft, and the duration, degrees of the crank.

    Each entry has the made and the intended value and the expanded uncertainty. All are None where the lift is not
    crossed once upwards and once downwards. `zero` is the shaft angle, rad, at which the lobe's motion begins.
    """
    try:
        event = event_of(design.exact, row.follower)
    except EventError:
        above = None
    else:
        above = motion.above(event.opening, event.closing)
    if above is None:
        return dict.fromkeys((*ANGLES, DURATION))
    entry: dict[str, Any] = {}
    for name, crossing in zip(ANGLES, (above.opening, above.closing, above.centre), strict=True):
        intended = math.degrees(crossing.intended + zero) % 360.0
        uncertain = math.degrees(math.hypot(options.expanded(crossing.influence), options.axes_turn))
        entry[name] = _row(1.0, intended + math.degrees(crossing.made - crossing.intended), intended, uncertain)
    crank = math.degrees(CRANK)
    duration = above.duration
    entry[DURATION] = _row(crank, duration.made, duration.intended, options.expanded(duration.influence))
    return entry
