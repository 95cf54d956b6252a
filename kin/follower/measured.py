"""The motion that a contour gives a follower by contact, where none is intended.

Nothing is fitted: each angle has the position of a touch that rests on the contour as it is, with the derivatives of
the piece that it rests on. A polygon so gives a motion of many small steps of the velocity.
"""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.follower.follower import unled
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.contour.contour import Contour
    from kin.follower.base import Follower
    from kin.follower.drive import Excitation
    from kin.law.contacts import Contact, Guide, Touch, Unit
    from kin.numeric.arrays import Array, Mask

LEAST_DWELL = math.radians(10.0)  # a stretch that is shorter may be the top of a nose
WIDENS = 1.5  # a nose is twice as wide at four times the depth, a dwell hardly wider
CLOSER, ROUNDS = 16, 5  # places on either side of the highest and lowest, and how often they are looked at more closely


class Dwell(NamedTuple):
    """A stretch without motion: shaft angles from `begin` to `end`, rad, end > begin; level and flatness, mm or rad."""

    begin: float
    end: float
    level: float
    flatness: float


@dataclass(frozen=True, eq=False)
class MeasuredMotion:
    """A follower's motion over n equal steps of the shaft from 0, mm or radians, derivatives by radian of the shaft.

    phi       shaft angles (n,); the guide stands at these in the axes of the contour
    rows      position of contact 1 and two derivatives (3, n): the distance of its centre or face along the line of
              travel from the foot of the shaft, or the angle at the pivot between the line to the shaft and the arm
    pressure  pressure angle, rad (n,), above 0 where the cam drives a rise
    radius    radius of curvature of the contour where it is touched, mm (n,): 0 at a corner, negative in a hollow
    least     least position, and its shaft angle
    most      greatest position, and its shaft angle
    breadth   least and greatest distance of two opposite contacts, mm; None of one
    """

    unit: Unit
    phi: Array
    rows: Array
    pressure: Array
    radius: Array
    least: tuple[float, float]
    most: tuple[float, float]
    breadth: tuple[float, float] | None = None

    @property
    def lift(self) -> float:
        """Greatest position less the least, mm or rad."""
        return self.most[0] - self.least[0]

    def dwells(self, reading: float) -> list[Dwell]:
        """Stretches of at least 10 degrees that rest within `reading`, mm or rad, of their middle position.

        A stretch that would be much longer for four times the reading is the top of a nose, and none.
        """
        position, left = self.rows[0], np.ones(len(self.phi), dtype=bool)
        found: list[Dwell] = []
        while (dwell := self._longest(position, left, reading)) is not None:
            found.append(dwell)
        return sorted(found)

    def _longest(self, position: Array, left: Mask, reading: float) -> Dwell | None:
        """Longest dwell among the angles that are left, which it takes out; None where there is none."""
        n, step = len(position), TURN / len(position)
        start, count = _longest_flat(position, left, 2.0 * reading)
        if count * step < LEAST_DWELL:
            return None
        wide = _longest_about(position, start + count // 2, 8.0 * reading)
        within = np.arange(start, start + count) % n
        left[within] = False
        if wide > WIDENS * count and count < n:
            return self._longest(position, left, reading)
        level = float(np.median(position[within]))
        near = np.abs(position[within] - level) <= 0.5 * reading
        inner = np.flatnonzero(near)
        low, high = start + int(inner[0]), start + int(inner[-1])
        rest = position[np.arange(low, high + 1) % n]
        flatness = float(np.ptp(rest))
        turns = low // n
        return Dwell((low - turns * n) * step, (high - turns * n) * step, level, flatness)


def measured(contour: Contour, contacts: Sequence[Contact[Guide, Touch]], steps: int) -> MeasuredMotion:
    """Let a follower of one contact, or of two opposite ones, run on a contour about the shaft at the origin, mm.

    The metal lies inside the contour. Raises ContactError where the touch meets nothing, ValueError for contacts that
    `follower_of` does not know.
    """
    follower = unled(contacts)
    phi = TURN * np.arange(steps) / steps
    drives = follower.drives(contour)
    rows = _rows(follower, drives[0], phi)
    pressure, radius = follower.pressed(contour, phi)
    least, most = (_extreme(follower, drives[0], phi, rows[0], sign) for sign in (-1.0, 1.0))
    breadth = None
    if len(drives) > 1:
        apart = np.concatenate([sum(drive.rows(angle)[0] for drive in drives) for angle in (phi, _breaks(drives))])
        breadth = float(apart.min()) / follower.si, float(apart.max()) / follower.si
    return MeasuredMotion(follower.unit, phi, rows, pressure, radius, least, most, breadth)


def _breaks(drives: Sequence[Excitation]) -> Array:
    return np.concatenate([drive.breaks for drive in drives])


def _rows(follower: Follower, drive: Excitation, phi: Array) -> Array:
    """Position of contact 1 from the foot of the shaft, or its angle at the pivot, with two derivatives (3, n)."""
    rows: Array = drive.rows(phi) / follower.si
    return rows


def _extreme(follower: Follower, drive: Excitation, phi: Array, position: Array, sign: float) -> tuple[float, float]:
    """Greatest of sign * position, and its shaft angle: the samples are looked at more closely about the best."""
    at = float(phi[int(np.argmax(sign * position))])
    step = TURN / len(phi)
    value = float((sign * position).max())
    for _ in range(ROUNDS):
        angle = at + step * np.linspace(-1.0, 1.0, 2 * CLOSER + 1)
        there = sign * _rows(follower, drive, angle)[0]
        best = int(np.argmax(there))
        if there[best] > value:
            value, at = float(there[best]), float(angle[best])
        step /= CLOSER
    return sign * value, at % TURN


def _longest_flat(position: Array, left: Mask, span: float) -> tuple[int, int]:
    """First index and number of the longest run round the turn, of what is left, whose positions differ by `span`."""
    n = len(position)
    best, begin = (0, 0), 0
    low: deque[int] = deque()
    high: deque[int] = deque()
    for end in range(2 * n):
        if not left[end % n]:
            low.clear()
            high.clear()
            begin = end + 1
            continue
        value = position[end % n]
        while low and position[low[-1] % n] >= value:
            low.pop()
        while high and position[high[-1] % n] <= value:
            high.pop()
        low.append(end)
        high.append(end)
        while position[high[0] % n] - position[low[0] % n] > span or end - begin >= n:
            begin += 1
            if low[0] < begin:
                low.popleft()
            if high[0] < begin:
                high.popleft()
        if end - begin + 1 > best[1]:
            best = begin, end - begin + 1
    return best


def _longest_about(position: Array, middle: int, span: float) -> int:
    """Number of positions in the longest run through one of them that differ by no more than `span`."""
    n = len(position)
    turned = np.roll(position, -(middle % n))
    ahead, behind = turned, turned[np.r_[0, n - 1 : 0 : -1]]
    low, high = 0, 0
    ups = [np.minimum.accumulate(ahead), np.maximum.accumulate(ahead)]
    downs = [np.minimum.accumulate(behind), np.maximum.accumulate(behind)]
    best = 1
    for low in range(n):
        least, most = downs[0][low], downs[1][low]
        if most - least > span:
            break
        fits = np.maximum(ups[1], most) - np.minimum(ups[0], least) <= span
        high = int(np.argmin(fits)) if not fits.all() else n
        best = max(best, min(low + high, n))
    return best
