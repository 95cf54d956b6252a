"""Where a groove of several turns crosses itself: there one turn has taken the wall of another.

A groove that closes after several turns round a drum crosses itself. Of each flank the line on which the roller touches
it is known in closed form (`kin.cylindrical.frame`), and so is how far a point of it lies outside what the roller takes
in the other turns (`kin.cylindrical.roller`): in the metal, or in the open. At some angles nothing of the line lies in
the metal. There no file can carry the roller, and the motion is judged beside these stretches.

A line counts as carried where some of its points lie MARGIN tolerances outside all other turns: within that distance
nothing but this flank bounds the metal, so that a surface within the tolerance cannot pass them by. Points that lie on
the flank of another turn as well, as in a dwell of more than a turn, are carried by it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.frame import flank_points, on_cylinder
from kin.cylindrical.roller import Place
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array, Mask

MARGIN = 2.0  # tolerances
ALIKE = 1e-6  # mm: turns whose flanks are so close are one there
OWN = 1e-6  # mm: a point so far within its own turn lies on an undercut
PLACES = 3  # along the roller
HALVINGS = 40  # of a step, in which a gap begins or ends
PARTS = 64  # of a gap, over which its length is summed


class Gap(NamedTuple):
    """A stretch without a wall: from and to a shaft angle, rad, and its length along the groove, mm."""

    low: float
    high: float
    length: float


def carried(drum: DrumIntent, gauges: tuple[Gauge, ...], gauge: Gauge, count: int, tolerance: float) -> Mask:
    """Whether (n,) a flank carries the roller at so many equal steps of the period, and half a step to both sides."""
    if gauge.lifts.turns == 1:
        return np.ones(count, dtype=np.bool_)
    theta = np.arange(count) * (gauge.lifts.period / count)
    held = np.zeros(count, dtype=np.bool_)
    inner, outer = gauge.inner, _outer(drum, gauge, theta)
    for share in np.linspace(0.0, 1.0, PLACES):
        open_ = np.flatnonzero(~held)
        room = _outside(drum, gauges, gauge, theta[open_], (inner + share * (outer - inner))[open_])
        held[open_] = _is_wall(room, MARGIN * tolerance)
    # its neighbours tell what lies between them
    return held & np.roll(held, 1) & np.roll(held, -1)


def gaps(
    drum: DrumIntent, gauges: tuple[Gauge, ...], gauge: Gauge, count: int, tolerance: float, rho: float
) -> list[Gap]:
    """Stretches in which a flank has no wall at the place rho, mm, along the roller, sought by so many angles.

    What lies within the tolerance of another turn counts as gone. Ends are met as closely as rounding lets them.
    """
    lifts = gauge.lifts
    if lifts.turns == 1:
        return []
    width = lifts.period / count
    theta = np.arange(count) * width
    ends = np.full(count, rho)

    def stands(at: Array) -> Mask:
        return _is_wall(_outside(drum, gauges, gauge, at, ends[: len(at)]), tolerance)

    wall = stands(theta)
    if not wall.any():
        return [Gap(0.0, lifts.period, math.inf)]
    first = np.flatnonzero(wall & ~np.roll(wall, -1))  # the last angle before a gap
    last = np.flatnonzero(wall & ~np.roll(wall, 1))
    if not len(first):
        return []
    last = last[(np.searchsorted(last, first, side="right")) % len(last)]
    low, high = theta[first], theta[last] + np.where(last <= first, lifts.period, 0.0)
    low, high = _met(stands, low, low + width), _met(stands, high, high - width)
    shares = (np.arange(PARTS) + 0.5) / PARTS
    at = low[:, None] + (high - low)[:, None] * shares
    speed = np.hypot(rho, gauge.lever * lifts.at(at.ravel())[1]).reshape(at.shape)
    lengths = (high - low) * speed.mean(axis=1)
    return [Gap(*row) for row in zip(low.tolist(), high.tolist(), lengths.tolist(), strict=True)]


def on_line(drum: DrumIntent, gauges: tuple[Gauge, ...], gauge: Gauge, theta: Array, radius: float) -> tuple[Array, Array]:
    """Polar angles (n,), rad, of a flank on a cylinder, mm, touched at angles (n,), and how far they lie outside, mm."""
    rho, phi, _ = on_cylinder(drum.follower, theta, radius, gauge.side, gauge.radius - drum.follower.radius)
    return phi, _outside(drum, gauges, gauge, theta, rho)


def _met(stands: object, wall: Array, gone: Array) -> Array:
    """Angles (n,), rad, at which a wall ends, between one where it stands and one where it is gone."""
    for _ in range(HALVINGS):
        middle = 0.5 * (wall + gone)
        there = stands(middle)  # type: ignore[operator]
        wall, gone = np.where(there, middle, wall), np.where(there, gone, middle)
    return wall


def _is_wall(room: Array, least: float) -> Mask:
    """Whether points (n,) that lie so far outside of all other turns, mm, are on a wall."""
    wall: Mask = (room >= least) | (np.abs(room) <= ALIKE)
    return wall


def _outer(drum: DrumIntent, gauge: Gauge, theta: Array) -> Array:
    """Places (n,), mm, along the roller at which a flank ends the contact: at its end, or at the blank."""
    rho = on_cylinder(drum.follower, theta, drum.radius, gauge.side, gauge.radius - drum.follower.radius)[0]
    return np.minimum(gauge.outer, rho)


def _outside(drum: DrumIntent, gauges: tuple[Gauge, ...], gauge: Gauge, theta: Array, rho: Array) -> Array:
    """How far (n,), mm, points of a flank lie outside what the rollers of all other turns take; below 0 within."""
    follower, lifts = drum.follower, gauge.lifts
    points = flank_points(follower, theta, rho, gauge.side, gauge.radius - follower.radius)
    room = np.full(len(theta), np.inf)
    if drum.shortened:
        own = gauge.worst(points, theta).height
        room = np.where(own <= OWN, room, -own)
    phi, r, z = gauge.polar(points, theta), np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    lower, upper = gauges
    for turn in range(1, lifts.turns):
        there = phi + TURN * turn
        above = lower.beyond(Place(there, r, z))
        # farther than this from the axis it lies outside at all angles at which the roller comes near
        size = gauge.largest * 1.1
        sweep = np.arcsin(np.minimum(1.0, (gauge.reach + 0.1 * size) / r))
        near = np.abs(above) <= size + gauge.lever * lifts.steepest * sweep
        for side, own in ((above <= 0.0, lower), (above > 0.0, upper)):
            which = np.flatnonzero(near & side)
            if len(which):
                distance = own.worst(points[which], there[which]).distance
                room[which] = np.minimum(room[which], distance)
    return room
