"""Figures of a cylindrical cam from the intended motion alone, by which the judge's flanks and rollers are tested.

`side` is -1 for a lower flank and 1 for an upper one, `clearance` makes its roller larger. Places are shaft angles,
rad. Extremes are those of smooth functions between the law's cells (`kin.numeric.extrema`), with derivatives from jets.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from capabilities.cylindrical.kin.meshing import regularity_jet

from kin.cylindrical.frame import On, place_jets, pressure_jet, rates
from kin.cylindrical.gauge import gauges_of
from kin.cylindrical.play import ACROSS, ROUNDS, exact_play, least_across, room_of
from kin.numeric.angles import TURN
from kin.numeric.extrema import extremes_over

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.cylindrical.follower import DrumFollower
    from kin.cylindrical.intent import DrumIntent
    from kin.law.contacts import Side
    from kin.numeric.arrays import Array
    from kin.numeric.elementary import Jet

ANGLES = 1440  # of a turn, from which a figure without derivatives is looked for
CORNERED = 13  # of one for a corner
SECANTS = 60  # steps to a zero, at most


class At(NamedTuple):
    """A value and the shaft angle at which it is reached, rad."""

    value: float
    at: float


class Angles(NamedTuple):
    """Greatest and least pressure angle, rad, at a place along the roller: above 0 where the cam drives a rise."""

    greatest: At
    least: At


class Undercut(NamedTuple):
    """Where a flank is undercut, and what of the line of contact is left.

    below   mm from the cam's axis, along the roller: nearer to the axis the flank is undercut somewhere; 0: nowhere
            from the floor outwards
    at      shaft angle, rad, at which undercut reaches out so far; nan: nowhere
    length  length of the line of contact, mm, that is left at that angle: from there, or from the roller's inner end,
            to its outer end or to where the blank ends the contact; without undercut the least of all angles
    share   of what the line would be there without undercut
    """

    below: float
    at: float
    length: float
    share: float


class Forces(NamedTuple):
    """Greatest contact force, N, and greatest and least torque on the cam, N mm, under a load along the motion."""

    contact: At
    torque: At
    back: At


class Thickness(NamedTuple):
    """Least thickness of a rib along z, mm, at a distance `radius`, mm, from the axis; `at` of its upper roller."""

    value: float
    at: float
    radius: float


class Plays(NamedTuple):
    """Least and greatest free travel along z, mm, or of an arm, rad, over all shaft angles."""

    least: At
    most: At


def _extremes(follower: DrumFollower, figure: Callable[[Array, int], Jet]) -> tuple[At, At]:
    found = extremes_over(follower.cells, figure)
    return At(found.least, found.least_at), At(found.greatest, found.greatest_at)


def slopes(follower: DrumFollower) -> tuple[At, At]:
    """Least and greatest slope S', mm or rad per rad."""
    return _extremes(follower, lambda theta, side: rates(follower, theta, 2, side).slope)


def pressure_angles(follower: DrumFollower, rho: float, side: Side = -1) -> Angles:
    """Greatest and least pressure angle at the place rho, mm, along the roller, over all shaft angles."""
    on = On(side)
    found = _extremes(follower, lambda theta, own: pressure_jet(follower, rates(follower, theta, 2, own), rho, on))
    return Angles(found[1], found[0])


def outer_contact(
    follower: DrumFollower, radius: float, clearance: float = 0.0, side: Side = -1, beside: float = 0.0
) -> At:
    """Least place along the roller, mm, at which a blank of `radius`, mm, ends the contact, over all shaft angles."""
    on = On(side, clearance, beside)
    return _extremes(follower, lambda theta, own: place_jets(follower, rates(follower, theta, 2, own), radius, on)[0])[
        0
    ]


def least_regularity(
    follower: DrumFollower, rho: float, side: Side = -1, clearance: float = 0.0, beside: float = 0.0
) -> At:
    """Least regularity D of a flank, mm, at a place along the roller, over all shaft angles."""
    on = On(side, clearance, beside)

    def figure(theta: Array, knot_side: int) -> Jet:
        return regularity_jet(follower, rates(follower, theta, 2, knot_side), rho, on)

    return _extremes(follower, figure)[0]


def undercut(drum: DrumIntent, side: Side = -1) -> Undercut:
    """Where a drum's flank is undercut, from its floor outwards, and the length of contact that is left."""
    follower = drum.follower
    clearance, beside = drum.track.larger(side), drum.track.beside(side)

    def least(rho: float) -> At:
        return least_regularity(follower, rho, side, clearance, beside)

    low, high = max(drum.floor, 0.1 * drum.radius), drum.radius
    inner = least(low)
    if inner.value > 0.0:
        end = outer_contact(follower, drum.radius, clearance, side, beside).value
        return Undercut(0.0, math.nan, min(follower.outer, end) - follower.inner, 1.0)
    below = _rising_zero(lambda rho: least(rho).value, low, high)
    at = least(below).at
    rows, on = rates(follower, np.array([at])), On(side, clearance, beside)
    end = float(place_jets(follower, rows, drum.radius, on)[0].c[0, 0])
    whole = min(follower.outer, end) - follower.inner
    left = max(whole - max(below - follower.inner, 0.0), 0.0)
    return Undercut(below, at, left, left / whole)


def _rising_zero(function: Callable[[float], float], low: float, high: float) -> float:
    """Zero of a function that is below 0 at `low`, by the secant method kept in a bracket; `high` if it stays below."""
    below, above = function(low), function(high)
    if above <= 0.0:
        return high
    kept = 0
    for _ in range(SECANTS):
        middle = high - above * (high - low) / (above - below)
        value = function(middle)
        if value <= 0.0:
            low, below = middle, value
            above *= 0.5 if kept < 0 else 1.0
            kept = -1
        else:
            high, above = middle, value
            below *= 0.5 if kept > 0 else 1.0
            kept = 1
        if abs(value) <= 1e-13 * high or high - low <= 1e-13 * high:
            return middle
    return 0.5 * (low + high)


def lost_alone(drum: DrumIntent, radius: float, theta: Array, side: Side = -1) -> Array:
    """Motion lost (n,), mm, at angles (n,), rad, if the flank carried the roller on one cylinder, mm, alone.

    There the flank is what rollers at all angles leave; 0 where it is not undercut.
    """
    (gauge,) = (one for one in gauges_of(drum) if one.side == side)
    return least_across(lambda y: room_of(gauge, gauge, theta, y, (math.inf, radius)), gauge, theta, CORNERED)[1]


def rib_thickness(drum: DrumIntent) -> Thickness:
    """Least thickness of a rib along z between its floor and the blank; raises ValueError for another track."""
    if not drum.track.distance:
        raise ValueError("the track is no rib")
    upper, lower = gauges_of(drum)
    best = Thickness(math.inf, math.nan, math.nan)
    for radius in (drum.floor, drum.radius):

        def thick(phi: Array, radius: float = radius) -> Array:
            far = np.full(len(phi), radius)
            return upper.surface(phi, far) - lower.surface(phi, far)

        phi = _least_place(thick, TURN)
        (height,) = upper.surface(np.array([phi]), np.array([radius]))
        point = np.array([[radius * math.cos(phi), radius * math.sin(phi), height]])
        value = float(thick(np.array([phi]))[0])
        if value < best.value:
            best = Thickness(value, float(upper.worst(point).theta[0]) % TURN, radius)
    return best


def _least_place(function: Callable[[Array], Array], period: float, angles: int = ANGLES) -> float:
    """Angle, rad, at which a function of angles (n,) of a period is least, by ever closer grids."""
    width = TURN / angles
    at = width * np.arange(round(period / width), dtype=np.float64)
    for _ in range(ROUNDS):
        best = float(at[int(np.argmin(function(at)))])
        at = best + width * np.linspace(-1.0, 1.0, ACROSS)
        width /= 0.25 * ACROSS
    return best


def plays(drum: DrumIntent) -> Plays:
    """Least and greatest play of the follower between exact flanks over all shaft angles, as if no turns crossed."""
    period = drum.follower.period
    least = _least_place(lambda theta: exact_play(drum, theta), period, ANGLES // 4)
    most = _least_place(lambda theta: -exact_play(drum, theta), period, ANGLES // 4)
    return Plays(*(At(float(exact_play(drum, np.array([at]))[0]), at % period) for at in (least, most)))


def forces(follower: DrumFollower, load: float, rho: float, side: Side = -1) -> Forces:
    """Forces under a `load` along the motion, N or, on an arm, N mm, all of it carried at the place rho, mm.

    The contact force is N = load/(lever cos a cos delta), the torque load S'.
    """
    least, greatest = slopes(follower)
    angle = max(pressure_angles(follower, rho, side), key=lambda angle: abs(angle.value))
    along = follower.guide().lever * math.cos(angle.value) * math.cos(follower.taper)
    return Forces(At(load / along, angle.at), At(load * greatest.value, greatest.at), At(load * least.value, least.at))
