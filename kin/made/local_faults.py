"""Local faults of a smoothed deviation: places that stand out from what is all round a turn.

A local fault is a dent, a flat, a burr: it takes a small part of the turn, and stands out there both from the noise of
the curve and from the rest of the form. The rest is measured by its median, which no local fault bends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Mask

STANDS_OUT = 4.0  # standard deviations of the curve, and of the rest of the form: a local fault is higher
MAD = 1.4826  # standard deviations of a normal distribution in its median absolute deviation
MOST_SHARE = 1.0 / 3.0  # of the turn: more is no local fault
RINGING = 0.2  # of a fault: what is lower beside it, the other way, is the curve's own swing
COMMON = 0.5  # of the stretch of two faults that may be one, in which both stand
MOST_HIGHER = 2.0  # times: the height of one of them by that of the other
BESIDE = 2.0  # spans: so near is beside


class LocalFault(NamedTuple):
    """Place of the greatest height of a local fault, rad, where it begins and ends, its height and its deviation, mm.

    `begin` < `at` < `end`, of which `begin` may lie below 0 and `end` above a turn. The height is above 0 for too much
    metal; `sd` is its standard deviation.
    """

    at: float
    begin: float
    end: float
    height: float
    sd: float

    def holds(self, t: Array) -> Mask:
        """Whether parameters (n,), rad, lie within the fault."""
        holds: Mask = np.mod(t - self.begin, TURN) <= self.end - self.begin
        return holds

    def alike(self, other: LocalFault) -> bool:
        """Whether two faults may be one, on two parts: they cover one another by half, and are about as high."""
        begin = self.begin + TURN * round((other.begin - self.begin) / TURN)
        end = begin + self.end - self.begin
        common = min(end, other.end) - max(begin, other.begin)
        whole = max(end, other.end) - min(begin, other.begin)
        higher, lower = sorted((self.height / other.height, other.height / self.height), reverse=True)
        return common >= COMMON * whole and lower > 0.0 and higher <= MOST_HIGHER


def within(faults: Sequence[LocalFault], t: Array) -> Mask:
    """Whether parameters t (n,), rad, lie within any of the faults."""
    inside: Mask = np.zeros(len(t), dtype=np.bool_)
    for fault in faults:
        inside |= fault.holds(t)
    return inside


def local_faults(form: Array, sd: Array, spans: int) -> list[LocalFault]:
    """Local faults of a form (n,), mm, at even places of a turn from 0, the highest first.

    `sd` (n,) is the standard deviation of the form, from a curve on so many `spans`. Where what stands out takes more
    than MOST_SHARE of the turn it is no local fault, and none is given.
    """
    count = len(form)
    rest = MAD * float(np.median(np.abs(form - np.median(form))))
    scatter = np.maximum(sd, rest)
    faults: list[LocalFault] = []
    left = np.abs(form)
    taken = np.zeros(count, dtype=np.bool_)
    while True:
        free = np.where(taken, -np.inf, left - STANDS_OUT * scatter)
        worst = int(np.argmax(free))
        if free[worst] <= 0.0:
            break
        sign = np.sign(form[worst])
        back, ahead = (_reach(sign * form, scatter, worst, way) for way in (-1, 1))
        taken[np.arange(worst - back, worst + ahead + 1) % count] = True
        step = TURN / count
        begin, end = (worst - back) * step, (worst + ahead) * step
        faults.append(LocalFault(worst * step, begin, end, float(form[worst]), float(sd[worst])))
    faults = _without_ringing(faults, BESIDE * TURN / spans)
    return faults if sum(fault.end - fault.begin for fault in faults) <= MOST_SHARE * TURN else []


def _reach(height: Array, scatter: Array, top: int, way: int) -> int:
    """Steps from the top of a fault to where it ends, one way.

    It ends where its height is within the scatter, or where another fault of the same sign rises beyond a valley, by
    more than noise and the curve's own swing.
    """
    count = len(height)
    around = (top + way * np.arange(count // 2)) % count
    own, noise = height[around], scatter[around]
    lowest = np.minimum.accumulate(own)
    ends = (own <= noise) | (own > lowest + np.maximum(STANDS_OUT * noise, RINGING * own[0]))
    end = int(np.argmax(ends)) if ends.any() else len(around) - 1
    # beyond a valley: back to its lowest place
    return end if own[end] <= noise[end] else int(np.argmin(own[: end + 1]))


def _without_ringing(faults: Sequence[LocalFault], near: float) -> list[LocalFault]:
    """The faults, the highest first, less what is the swing of the curve beside a much higher one."""
    kept: list[LocalFault] = []
    for fault in sorted(faults, key=lambda own: -abs(own.height)):
        beside = [
            own
            for own in kept
            if min((fault.begin - own.end + near) % TURN, (own.begin - fault.end + near) % TURN) <= 2.0 * near
            and abs(fault.height) < RINGING * abs(own.height)
            and fault.height * own.height < 0.0
        ]
        if not beside:
            kept.append(fault)
    return kept
