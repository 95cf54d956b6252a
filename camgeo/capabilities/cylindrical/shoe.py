"""A shoe in place of a roller: a boat that turns on a pin square to the drum, and bridges the gaps at crossings.

As wide as its groove, it is led as a roller of that diameter, R its radius. Its sides are two arcs from tip to tip:
with the length L their radius is (L^2/4 + R^2)/(2 R).

At a bend whose path has the radius P, unrolled, the wall outside has the radius P + R, and is touched by the middle of
the shoe. There both lie beside one another as far as the side is bent no less than the wall, which is as far as the
tips lie within the wall, (L/2)^2 + P^2 <= (P + R)^2. A clearance j is on the upper flank. With it outside, at a bend
that opens downwards, the tips have to lie within P + R + j; with it inside the shoe gives way by j:

    L^2/4 <= (R + j)(2 P + R + j),      L^2/4 <= (R + j)(2 P + R - j)

P on the cylinder rho is (rho^2 + S'^2)^(3/2)/(rho |S''|); where S' = 0 that is rho^2/|S''|, so that it is sought at
either end of the shoe. A gap that is longer than the shoe lets it turn into the other track, or drop out of its own.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.common.rounding import downward, upward
from camgeo.output.refusals import demand_flanks
from kin.cylindrical.follower import DrumFollower
from kin.cylindrical.shoe import longest_shoe

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.crossings import Crossing
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from kin.numeric.arrays import Array

ROOM = 1e-4  # of a length by which a shoe in a remedy is longer or shorter than the bound
SECOND = 0.1  # of what a tolerance adds to a gap, in a remedy, for what is not of first order
EASED = "give more lift a turn, a wider reversal, or a narrower shoe"  # which makes gaps shorter and bends wider
TOLD = 3  # crossings that an error names


class Bend(NamedTuple):
    """The bend that takes the shortest shoe: greatest length of it, mm, its shaft angle, rad, and its radius, mm."""

    length: float
    at: float
    radius: float


def angle_of(design: DrumDesign, crossing: Crossing) -> float:
    """Angle between two tracks, rad, at that end of the shoe where they are nearer to one another's direction."""
    flank = design.flanks["lower"]
    return min((crossing.angle(flank, r) for r in design.recipe.bearing), key=lambda angle: abs(math.sin(angle)))


def longest(design: DrumDesign) -> Bend:
    """The bend that takes the shortest shoe."""
    radius, j = design.recipe.roller.radius, design.recipe.track.clearance

    def bent(theta: Array, rho: float, sign: float) -> Array:
        """Curvature of the path to one side on a cylinder, 1/mm, on that side of a break where it is greater."""
        found = []
        for side in (-1, 1):
            _, v, a = design.law.derivatives(theta, 2, side)
            found.append(sign * a * rho / (rho * rho + v * v) ** 1.5)
        return np.asarray(np.max(found, axis=0))

    bends = []
    breaks = np.asarray(design.law.breaks, dtype=np.float64)
    for rho in design.recipe.bearing:
        for sign in (-1.0, 1.0):
            worst, at = design.greatest(lambda theta, rho=rho, sign=sign: bent(theta, rho, sign))  # type: ignore[misc]
            if breaks.size:
                there = bent(breaks, rho, sign)
                worst, at = max((worst, at), (float(there.max()), float(breaks[there.argmax()])))
            if worst > 0.0:
                reach = (radius + j) * (2.0 / worst + radius - sign * j)
                bends.append(Bend(2.0 * math.sqrt(reach), at, 1.0 / worst))
    return min(bends, default=Bend(math.inf, 0.0, math.inf))


def play(design: DrumDesign) -> tuple[float, Crossing]:
    """Greatest play, mm, to either side, of a shoe in the middle of a gap, and the crossing."""
    roller = design.recipe.roller
    widths = roller.half_width(0.5 * np.array(design.gaps)).tolist()
    found = [(roller.radius - half, -each.first, each) for half, each in zip(widths, design.crossings, strict=True)]
    value, _, crossing = max(found, key=lambda each: each[:2])
    return value, crossing


def twist(design: DrumDesign) -> tuple[float, float]:
    """Greatest play that a shoe needs as its track's slope is another at its inner end, mm, and the shaft angle, rad.

    The slope is S'/rho. With its middle along the mean direction the shoe stands aslant by d at either end, and reaches
    across the track as far as R + (s - R)(1 - cos d), s the radius of its sides.
    """
    roller = design.recipe.roller
    inner, outer = design.recipe.bearing

    def needed(theta: Array) -> Array:
        rate = design.law.derivatives(theta, 1)[1]
        half = 0.5 * (np.arctan2(rate, inner) - np.arctan2(rate, outer))
        return np.asarray(2.0 * (roller.side - roller.radius) * (1.0 - np.cos(half)))

    return design.greatest(needed)


def demand_led(design: DrumDesign) -> None:
    """Raise RecipeErrors for a roller that would drop into a crossing, and for a shoe too short or too long."""
    recipe, roller = design.recipe, design.recipe.roller
    gap, bend = max(design.gaps, default=0.0), longest(design)
    made = design.gap_in_files
    least, most = made + ROOM * gap + SECOND * (made - gap), (1.0 - ROOM) * min(bend.length, _accepted(design))
    short, long = upward(least / recipe.mm, 5), downward(most / recipe.mm, 5)
    shown, units = partial(_shown, mm=recipe.mm), recipe.units
    passes = (
        f"a shoe of at most {long} {units} passes the bend near {math.degrees(bend.at):.6g} degrees, "
        f"whose least radius is {shown(bend.radius)} {units}"
    )
    if design.crossings and (roller.shoe is None or not roller.shoe > made):
        for request in recipe.export.files:  # gaps in a coarse solid are long: its tolerance is at fault first
            demand_flanks(recipe, request, recipe.track.depth)
        problem = f"a wall of the groove is missing over {shown(gap)} {units} where its tracks cross, "
        if roller.shoe is not None and roller.shoe > gap:
            problem += f"{shown(made)} {units} in a solid within its tolerance, "
        problem += f"at {_places(design, gap)}"
        remedy = f"give a shoe of {short} {units} or longer"
        if roller.shoe is None:
            problem += ": a roller drops in"
            remedy += f": {{kind: shoe, width: {shown(2.0 * roller.radius)}, length: {short}}}"
        if not most > least:
            remedy = f"a shoe would need {short} {units}, but {passes}: {EASED}"
        raise design.error("cam.follower" if roller.shoe is None else "cam.follower.length", problem, remedy)
    if roller.shoe is not None and roller.shoe > bend.length:
        where = f"near {math.degrees(bend.at):.6g} degrees, whose radius is {shown(bend.radius)} {units}"
        remedy = f"give at most {long} {units}, or a wider bend there"
        if not most > max(least, 2.0 * roller.radius):
            remedy = "give a wider bend there, or a roller"
            if design.crossings:
                remedy = (
                    f"{passes}, but the gap of {shown(made)} {units} where tracks cross needs a longer one: {EASED}"
                )
        raise design.error("cam.follower.length", f"the shoe jams in the bend {where}", remedy)


def _accepted(design: DrumDesign) -> float:
    """Length, mm, of the longest shoe that the check of solids is known to accept, which knows no clearance."""
    recipe, roller = design.recipe, design.recipe.roller
    within = [recipe.tolerance(request) for request in recipe.export.files if request.format.solid]
    led = DrumFollower(roller.radius, roller.inner, roller.outer, recipe.level, design.law, turns=recipe.turns)
    return longest_shoe(led, min(within)) if within else math.inf


def _shown(value: float, mm: float) -> str:
    return f"{value / mm:.6g}"


def _places(design: DrumDesign, gap: float) -> str:
    """Shaft angles of the crossings, those with the longest gap first."""
    by_gap = [
        each
        for _, each in sorted(
            zip(design.gaps, design.crossings, strict=True), key=lambda pair: -round(pair[0] / gap, 6)
        )
    ]
    told = [f"{math.degrees(each.first):.6g} and {math.degrees(each.second):.6g}" for each in by_gap[:TOLD]]
    more = f", and {len(by_gap) - TOLD} more" if len(by_gap) > TOLD else ""
    return f"{'; '.join(told)} degrees of the shaft{more}"
