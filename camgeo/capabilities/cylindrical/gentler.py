"""Least drum radius, mm, and least stretch of the motion that keep a limit on the pressure angle of arms and cones."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.exact import moved
from camgeo.capabilities.cylindrical.figures import steepest_contacts
from camgeo.capabilities.cylindrical.grid import breaks_of, parts_between
from camgeo.common.rounding import downward, upward
from camgeo.recipe.figures import PRESSURE_ANGLE
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe
    from kin.numeric.arrays import Array

LOOKS = 1440  # shaft angles of a turn at which it is looked for
CLOSE, MOST = 1e-4, 64.0  # of what is found, as a share; times the drum's radius, or the motion's length, at most
ROOM = 1e-5  # of the tangent, by which it may be greater between two looks
STILL = 1e-9  # of the steepest slope, below which the follower rests


def gentler(recipe: DrumRecipe, limit: float) -> str:
    """Words of what keeps the pressure angle of a sound drum below a limit, rad; empty where nothing is found.

    The drum is larger by as much as its roller is farther out, its arm where it was. A longer motion has all its lifts
    more slowly, and rests for what is left of the turn; it is no remedy where nothing would be left.
    """
    design = moved(recipe)
    theta = parts_between(breaks_of(next(iter(design.flanks.values()))), LOOKS)
    lean = max(float(np.abs(flank.pose(theta).lean).max()) for flank in design.flanks.values())
    if lean >= limit:
        least = downward(math.degrees(limit), 4)
        return f"a swing that leaves the arm within {least} degrees of the plane across the drum's axis"
    within = math.atan((1.0 - ROOM) * math.tan(limit))
    more = _least(lambda by: _steepest(_larger(design, by * recipe.radius), theta, 1.0) <= within)
    remedies = []
    if more is not None:
        radius = upward((1.0 + more) * recipe.radius / recipe.mm, 5)
        if steepest_contacts(_larger(design, float(radius) * recipe.mm - recipe.radius))[PRESSURE_ANGLE][0] <= limit:
            remedies.append(f"a cam.radius of at least {radius} {recipe.units}, its roller as much farther out")
    longer = _least(lambda by: _steepest(design, theta, 1.0 + by) <= within)
    slope = np.abs(design.law.derivatives(theta, 1)[1])
    moving = float(np.mean(slope > STILL * slope.max()))
    if longer is not None and (1.0 + longer) * moving < 1.0:
        remedies.append(f"a motion {upward(1.0 + longer, 4)} times as long")
    return ", or ".join(remedies)


def _larger(design: DrumDesign, more: float) -> DrumDesign:
    """The drum with its blank and its roller farther out by so much, mm."""
    recipe, roller = design.recipe, design.recipe.roller
    at = roller.at + more if roller.taper else 0.0
    roller = replace(roller, inner=roller.inner + more, outer=roller.outer + more, at=at).resized(roller.radius)
    return replace(design, recipe=replace(recipe, radius=recipe.radius + more, roller=roller))


def _steepest(design: DrumDesign, theta: Array, longer: float) -> float:
    """Greatest pressure angle at shaft angles (n,), rad, at both ends of the line, of a motion so much longer."""
    recipe, found = design.recipe, 0.0
    rows = design.law.derivatives(theta, 2) / np.array([[1.0], [longer], [longer**2]])
    for flank in design.flanks.values():
        pose = flank.led(rows)
        ends = np.minimum(recipe.roller.outer, flank.reached(pose, recipe.radius))
        for rho in (np.full_like(theta, recipe.roller.inner), ends):
            found = max(found, float(np.abs(flank.steepness(pose, rho)).max()))
    return found


def _least(holds: Callable[[float], bool]) -> float | None:
    """Least share, to a part of it, from which on something holds; None where it does not up to `MOST`."""
    high = 0.125
    while not holds(high):
        high *= 2.0
        if high > MOST:
            return None
    low = 0.0
    while high - low > CLOSE * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high
