"""The motion that a contour gives a follower by contact, where none is intended.

Nothing is fitted: at each shaft angle the touch rests on the lines, arcs and splines of the contour, and the
derivatives are those of the piece on which it rests. A polygon gives a velocity that steps from edge to edge. Kinks of
rounded numbers, which the shaft passes in less than a thousandth of a degree, are no corners.
"""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.follower.follower import still_follower
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.contour.contour import Contour
    from kin.law.contacts import Contact, Guide, Side, Touch, Unit
    from kin.numeric.arrays import Array, Mask

LEAST_DWELL = math.radians(10.0)  # a shorter stretch may be the top of a nose
DEEPER = 4.0  # times the depth, at which a nose is twice as wide, and a dwell hardly wider
WIDENS = 1.5  # times as wide at that depth: more is a nose
CLOSER, ROUNDS = 16, 5  # angles on either side of an extreme, and how often they are drawn closer about it
PASSED = 1e-5  # rad of the shaft: a corner that is passed sooner is a kink of a drawing's digits
LEAP = 1e-9  # rad, on either side of an angle at which the contact may leap


class MeasuredDwell(NamedTuple):
    """A stretch without motion: shaft angles from `begin`, 0 to 2 pi, to `end`, rad; level and flatness, mm or rad."""

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
    pressure  pressure angle, rad (n,), counter-clockwise from the normal out of the metal to the way in which the touch
              moves away from the metal
    radius    radius of curvature of the contour where it is touched, mm (n,): 0 at a corner, negative in a hollow
    least     least position, and its shaft angle
    most      greatest position, and its shaft angle
    second    position with contact 2 held in place of contact 1 (n,); None of one contact
    apart     least and greatest of `second` less the position; None of one contact
    travel    least and greatest place of contact on a flat face, mm, from the stem's axis or from the foot of the
              pivot on the face; None of a round touch
    """

    unit: Unit
    phi: Array
    rows: Array
    pressure: Array
    radius: Array
    least: tuple[float, float]
    most: tuple[float, float]
    second: Array | None = None
    apart: tuple[float, float] | None = None
    travel: tuple[float, float] | None = None

    @property
    def lift(self) -> float:
        """Greatest less least position, mm or rad."""
        return self.most[0] - self.least[0]

    def dwells(self, reading: float) -> list[MeasuredDwell]:
        """Stretches of at least 10 degrees that rest within `reading`, mm or rad, of their middle position.

        They come in the order of their beginnings. A stretch that is much longer at four times the depth is the top of
        a nose and no dwell. A dwell ends where the follower leaves its level, the median, by half the reading.
        """
        position, free = self.rows[0], np.ones(len(self.phi), dtype=bool)
        n, step = len(position), TURN / len(position)
        dwells: list[MeasuredDwell] = []
        while True:
            start, count = _longest_flat(position, free, 2.0 * reading)
            if count * step < LEAST_DWELL:
                return sorted(dwells)
            within = np.arange(start, start + count) % n
            free[within] = False
            resting = position[within]
            middle = 0.5 * float(resting.max() + resting.min())
            # a nose is wider at four times the depth, seen from its top one reading above the middle
            near = np.abs(np.roll(position, -(start + count // 2)) - middle) <= (2.0 * DEEPER - 1.0) * reading
            if _ahead(near) + _ahead(near[::-1]) > WIDENS * count and count < n:
                continue
            level = float(np.sort(resting)[count // 2])
            inner = np.flatnonzero(np.abs(resting - level) <= 0.5 * reading)
            low, high = int(inner[0]), int(inner[-1])
            if (high - low) * step < LEAST_DWELL:
                continue
            begin = (start + low) % n
            flatness = float(np.ptp(resting[low : high + 1]))
            dwells.append(MeasuredDwell(begin * step, (begin + high - low) * step, level, flatness))


def measured(
    contour: Contour,
    contacts: Sequence[Contact[Guide, Touch]],
    steps: int,
    side: Side = 1,
    outer: Contour | None = None,
) -> MeasuredMotion:
    """Let a follower of one contact, or of two opposite ones, run on a contour, mm, about the shaft at the origin.

    The motion comes at `steps` equal steps of the turn. The metal lies inside the contour (side 1) or outside (-1).
    `outer` is the outer flank of a groove, whose inner one is `contour`: the roller rests on it as contact 2. Raises
    ContactError where the touch meets nothing, ValueError for contacts for which no follower is known.
    """
    follower = still_follower(contacts, side)
    first, *others = follower.resting(contour)
    if outer is not None:
        others = still_follower(contacts, -1).resting(outer)

    def position(angle: Array) -> Array:
        """Position of contact 1 (n,)."""
        rows: Array = first.rows(angle)[0] / follower.si
        return rows

    def apart(angle: Array) -> Array:
        """Position with contact 2 held less that with contact 1 (n,)."""
        rows: Array = others[0].rows(angle)[0] / follower.si
        return rows - position(angle)

    phi = TURN * np.arange(steps) / steps
    rows = first.rows(phi) / follower.si
    pressure, radius = follower.pressed(contour, phi)
    kinks = np.flatnonzero(radius == 0.0)
    if kinks.size:  # the piece beyond bears there
        beyond = phi[kinks] + PASSED
        further, curved = follower.pressed(contour, beyond)
        passed = curved != 0.0
        kinks, beyond = kinks[passed], beyond[passed]
        rows[1:, kinks] = first.rows(beyond)[1:] / follower.si
        pressure[kinks], radius[kinks] = further[passed], curved[passed]
    # extremes are also looked for beside each angle at which the contact may leap
    leaps = np.concatenate([drive.breaks for drive in (first, *others)])
    finer = np.concatenate([phi, leaps - LEAP, leaps + LEAP])
    step = TURN / steps
    gap = apart(phi) if others else None
    return MeasuredMotion(
        follower.unit,
        phi,
        rows,
        pressure,
        radius,
        least=_extreme(position, finer, step, -1.0),
        most=_extreme(position, finer, step, 1.0),
        second=None if gap is None else rows[0] + gap,
        apart=None if gap is None else (_extreme(apart, finer, step, -1.0)[0], _extreme(apart, finer, step, 1.0)[0]),
        travel=follower.contact_travel(contour),
    )


def positions(contour: Contour, contact: Contact[Guide, Touch], side: Side, phi: Array) -> Array:
    """Positions of a follower of one contact on a contour, mm or rad (n,), at shaft angles phi (n,), rad.

    The metal lies inside the contour (side 1) or outside (-1). Raises ContactError where the touch meets nothing,
    ValueError for a contact for which no follower is known.
    """
    follower = still_follower((contact,), side)
    rows: Array = follower.resting(contour)[0].rows(phi)[0] / follower.si
    return rows


def _extreme(values: Callable[[Array], Array], angles: Array, step: float, sign: float) -> tuple[float, float]:
    """Greatest value (sign 1) or least (-1), and its angle, over shaft angles (n,) and within `step` of the best."""
    heights = sign * values(angles)
    best = int(np.argmax(heights))
    height, place = float(heights[best]), float(angles[best])
    for _ in range(ROUNDS):
        closer = place + step * np.linspace(-1.0, 1.0, 2 * CLOSER + 1)
        heights = sign * values(closer)
        best = int(np.argmax(heights))
        if heights[best] > height:
            height, place = float(heights[best]), float(closer[best])
        step /= CLOSER
    return sign * height, place % TURN


def _ahead(near: Mask) -> int:
    """Number of entries before the first that is False."""
    return len(near) if near.all() else int(np.argmin(near))


def _longest_flat(position: Array, free: Mask, span: float) -> tuple[int, int]:
    """First index and number of the longest run, among the free ones round the turn, that spans `span` at most."""
    # a window slides over two turns; deques of indices hold its least and its greatest value first
    n = len(position)
    best, begin = (0, 0), 0
    low: deque[int] = deque()
    high: deque[int] = deque()
    for end in range(2 * n):
        if not free[end % n]:
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
