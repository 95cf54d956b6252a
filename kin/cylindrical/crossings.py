"""Where a groove of several turns crosses itself: there one turn has taken the wall of another.

A groove that closes after several turns round a drum crosses itself. Of each flank the line on which the roller touches
it is known in closed form (`kin.cylindrical.frame`), and so is how far a point of it lies outside what the roller takes
in the other turns (`kin.cylindrical.roller`): in the metal, or in the open. At some angles nothing of the line lies in
the metal. There no file can carry the roller, and the motion is judged beside these stretches.

A line counts as carried where some of its points lie MARGIN tolerances outside all other turns: within that distance
nothing but this flank bounds the metal, so that a surface within the tolerance e cannot pass them by. At an edge where
two flanks meet at an angle b a surface that is within e of either may end e/sin(b/2) short of it. Points that lie on
the flank of another turn as well, as in a dwell of more than a turn, are carried by it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.frame import flank_points, on_cylinder
from kin.cylindrical.roller import Place
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.cylindrical.intent import DrumIntent
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array, Mask

MARGIN = 2.0  # tolerances
ALIKE = 1e-6  # mm: turns whose flanks are so close are one there
OWN = 1e-6  # mm: a point so far within its own turn lies on an undercut
PLACES = 3  # along the roller
LOOKS, LINE_LOOKS = 720, 4096  # angles of a turn, between which gaps, and places of a line, are looked for
ROOM = 1.1  # of the roller's radius, within which others are looked for
NEAR_END = 0.02  # of the roller's reach, by which places on cylinders lie within its ends: so does a line near by
HALVINGS = 20  # of a step, in which a gap begins or ends
PARTS = 64  # of a gap, over which its length is summed


class Gap(NamedTuple):
    """A stretch without a wall: from and to a shaft angle, rad, and its length along the groove, mm."""

    low: float
    high: float
    length: float


@dataclass(frozen=True, eq=False)
class Crossings:
    """The crossings of a drum's groove, whose flanks' gauges are given, in a file true to a tolerance, mm."""

    drum: DrumIntent
    gauges: tuple[Gauge, ...]
    tolerance: float

    def carried(self, gauge: Gauge, count: int, radii: Array | None = None) -> Mask:
        """Whether (n,) a flank carries the roller at so many equal steps of the period, and a step beside them.

        It does where it stands at some place along the roller, or on some of the cylinders of `radii` (m,), mm.
        """
        if gauge.lifts.turns == 1:
            return np.ones(count, dtype=np.bool_)
        theta: Array = np.arange(count) * np.float64(gauge.lifts.period / count)
        held = np.zeros(count, dtype=np.bool_)
        inner, outer = gauge.inner, np.minimum(gauge.outer, self._on(gauge, theta, self.drum.radius)[0])
        if radii is None:
            rows = inner + np.linspace(0.0, 1.0, PLACES)[:, None] * (outer - inner)
            within = np.ones(rows.shape, dtype=np.bool_)
        else:
            rows, room = np.stack([self._on(gauge, theta, r)[0] for r in radii.tolist()]), NEAR_END * gauge.reach
            within = (rows >= inner + room) & (rows <= outer - room)
        for rho, inside in zip(rows, within, strict=True):
            open_ = np.flatnonzero(inside & ~held)
            held[open_] = _is_wall(self._outside(gauge, theta[open_], rho[open_]), MARGIN * self.tolerance)
        # its neighbours tell what lies between them
        return held & np.roll(held, 1) & np.roll(held, -1)

    def gaps(self, gauge: Gauge, rho: float) -> list[Gap]:
        """Stretches in which a flank has no wall at the place rho, mm, along the roller.

        What lies within the tolerance of another turn counts as gone. Ends are met to a millionth of the step.
        """
        lifts = gauge.lifts
        if lifts.turns == 1:
            return []
        count = LOOKS * lifts.turns
        width = np.float64(lifts.period / count)
        theta: Array = np.arange(count) * width

        def stands(at: Array) -> Mask:
            return _is_wall(self._outside(gauge, at, np.full(len(at), rho)), self.tolerance)

        wall = stands(theta)
        if not wall.any():
            return [Gap(0.0, lifts.period, math.inf)]
        first = np.flatnonzero(wall & ~np.roll(wall, -1))  # the last angle before a gap
        last = np.flatnonzero(wall & ~np.roll(wall, 1))
        if not len(first):
            return []
        last = last[(np.searchsorted(last, first, side="right")) % len(last)]
        low, high = theta[first], theta[last] + np.where(last <= first, lifts.period, 0.0)
        ends = _met(stands, np.concatenate([low, high]), np.concatenate([low + width, high - width]))
        low, high = ends[: len(low)], ends[len(low) :]
        shares = (np.arange(PARTS) + 0.5) / PARTS
        at = low[:, None] + (high - low)[:, None] * shares
        speed = np.hypot(rho, gauge.lever * lifts.at(at.ravel())[1]).reshape(at.shape)
        lengths = (high - low) * speed.mean(axis=1)
        return [Gap(*row) for row in zip(low.tolist(), high.tolist(), lengths.tolist(), strict=True)]

    def standing(self, gauge: Gauge, radius: float) -> Array:
        """Polar angles (n,), rad, over the period, at which a flank surely stands on a cylinder, mm, of many there."""
        turns = gauge.lifts.turns
        theta: Array = np.arange(LINE_LOOKS * turns) * np.float64(TURN / LINE_LOOKS)
        rho, phi = self._on(gauge, theta, radius)
        return phi[_is_wall(self._outside(gauge, theta, rho), MARGIN * self.tolerance)]

    def _on(self, gauge: Gauge, theta: Array, radius: float) -> tuple[Array, Array]:
        """Places along the roller, mm, and polar angles (n,), rad, of a flank on a cylinder, touched at angles (n,)."""
        follower = self.drum.follower
        rho, phi, _ = on_cylinder(follower, theta, radius, gauge.side, gauge.radius - follower.radius)
        return rho, phi

    def _outside(self, gauge: Gauge, theta: Array, rho: Array) -> Array:
        """How far (n,), mm, points of a flank lie outside what the rollers of other turns take; below 0 within."""
        follower, lifts = self.drum.follower, gauge.lifts
        points = flank_points(follower, theta, rho, gauge.side, gauge.radius - follower.radius)
        room = np.full(len(theta), np.inf)
        if self.drum.shortened:
            over = gauge.worst(points, theta).height
            room = np.where(over <= OWN, room, -over)
        phi, r, z = gauge.polar(points, theta), np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        lower, upper = self.gauges
        # farther than this from its axis a roller that comes near leaves a point outside
        size = ROOM * gauge.largest
        sweep = np.arcsin(np.minimum(1.0, (gauge.reach + size - gauge.largest) / r))
        far = size + gauge.lever * lifts.steepest * sweep
        for turn in range(1, lifts.turns):
            there = phi + TURN * turn
            above = lower.beyond(Place(there, r, z))
            near = np.abs(above) <= far
            for side, other in ((above <= 0.0, lower), (above > 0.0, upper)):
                which = np.flatnonzero(near & side)
                if len(which):
                    distance = other.worst(points[which], there[which]).distance
                    room[which] = np.minimum(room[which], distance)
        return room


def _met(stands: Callable[[Array], Mask], wall: Array, gone: Array) -> Array:
    """Angles (n,), rad, at which a wall ends, between one where it stands and one where it is gone."""
    for _ in range(HALVINGS):
        middle = 0.5 * (wall + gone)
        there = stands(middle)
        wall, gone = np.where(there, middle, wall), np.where(there, gone, middle)
    return wall


def _is_wall(room: Array, least: float) -> Mask:
    """Whether points (n,) that lie so far outside of all other turns, mm, are on a wall."""
    wall: Mask = (room >= least) | (np.abs(room) <= ALIKE)
    return wall
