"""A follower train in flight between two faces, or above one: the first instant at which a face bears.

Contact with a face begins where its spring is pressed in by d > 0 and its force is above 0, d + (c/k) d' > 0. Samples
would pass over a touch that is shorter than they lie apart, so strides are taken instead, each as long as a bound of
the second derivative of either figure allows it to stay below 0.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.dynamics.events import LOWER, UPPER, crossing
from kin.numeric.chebyshev import DERIVATIVE, ORDERS

if TYPE_CHECKING:
    from kin.dynamics.events import Work
    from kin.dynamics.oscillator import Free
    from kin.numeric.arrays import Array


_ROUNDING = 16.0  # times the last bit
_EPS = float(np.finfo(float).eps)
_AHEAD = 2.0  # strides ahead, where a face may bear already


class Depth(NamedTuple):
    """Depth by which one face is pressed in, m or rad, below 0 apart, and two derivatives by radian of shaft."""

    place: float
    rate: float
    bend: float


class Path:
    """A place, m or rad, and its rate on a stretch of half width `half`, rad, by series (2, DEGREE + 1).

    Times count from `ahead`, rad, after the start of the stretch. `size`, `rate`, `bend` and `bend_rate` are bounds of
    the moduli of the place and of three derivatives by radian of shaft.
    """

    def __init__(self, series: Array, half: float, ahead: float = 0.0) -> None:
        rate = series[1]
        bend = rate @ DERIVATIVE.T / half
        self._series = np.stack([series[0], rate, bend])
        self.half, self._ahead = half, ahead
        self.size, self.rate = (float(size) for size in np.abs(series).sum(axis=1))
        self.bend = float(np.abs(bend).sum())
        self.bend_rate = float(np.abs(bend @ DERIVATIVE.T).sum()) / half

    def at(self, time: float) -> Depth:
        """Place and two derivatives by radian of shaft at a time, rad."""
        x = (time + self._ahead) / self.half - 1.0
        place, rate, bend = (self._series @ np.cos(math.acos(min(max(x, -1.0), 1.0)) * ORDERS)).tolist()
        return Depth(place, rate, bend)


class Flight:
    """A train in flight along one stretch; `contact` is k and c of either face, `gap` the distance between the faces.

    k and c are in N/m or N m/rad, c for rates by radian of shaft. `path` and `free` make up z over the lower face. A
    force above -`limit` counts as contact; `limit` is moved down by the rounding of the flight, which is far longer
    than a stiff contact's depth.
    """

    def __init__(self, path: Path, free: Free, contact: tuple[float, float], gap: Path | None, limit: float) -> None:
        self._path, self._free, self._gap = path, free, gap
        k, c = self._contact = contact
        self._lag = c / k
        natural = free.oscillator.natural
        swing = (
            free.oscillator.square * float(free.oscillator.bound(np.array([[free.z], [free.v]]))[0]) if natural else 0.0
        )
        bend, bend_rate = path.bend + swing, path.bend_rate + natural * swing
        bends = (
            [(bend, bend_rate)] if gap is None else [(bend, bend_rate), (bend + gap.bend, bend_rate + gap.bend_rate)]
        )
        self._bends = [(d, d + self._lag * e) for d, e in bends]
        place, rate = path.size + abs(free.z), path.rate + abs(free.v)
        if gap is not None:
            place, rate = place + gap.size, rate + gap.rate
        self._limit = limit - _ROUNDING * _EPS * (k * (place + 2.0 * path.half * abs(free.v)) + c * rate)

    def landed(self, begin: float, end: float, work: Work) -> float | None:
        """First time from `begin` on, rad from the knot, at which a face bears; None if that is not before `end`.

        It is `begin` where a face bears already. Raises SpentError beyond the places that `work` permits.
        """
        if self._level(begin) < self._limit:
            return begin
        now = begin
        least = 4.0 * _EPS * end
        while now < end:
            work.stride()
            stride, single = self._stride(now)
            ahead = min(now + _AHEAD * stride, end)
            if single and self._level(ahead) < self._limit:
                return crossing(self._level, now, ahead, self._limit, work)
            ahead = now + max(stride, least)
            if ahead < end and self._level(ahead) < self._limit:  # but for rounding it cannot be
                return crossing(self._level, now, ahead, self._limit, work)
            now = ahead
        return None

    def face(self, time: float) -> int:
        """Face, LOWER or UPPER, whose contact force is the greater at a time, rad from the knot."""
        depths = self._depths(time)
        return LOWER if len(depths) == 1 or self._force(depths[0]) > self._force(depths[1]) else UPPER

    def _depths(self, time: float) -> list[Depth]:
        driven, (z, v) = self._path.at(time), self._free.after(time)
        # nothing damps the train in flight: z'' = -r^2 z of its free motion
        place, rate, bend = driven.place + z, driven.rate + v, driven.bend - self._free.oscillator.square * z
        lower = Depth(-place, -rate, -bend)
        if self._gap is None:
            return [lower]
        gap = self._gap.at(time)
        return [lower, Depth(place - gap.place, rate - gap.rate, bend - gap.bend)]

    def _force(self, depth: Depth) -> float:
        k, c = self._contact
        return k * depth.place + c * min(depth.rate, 0.0)

    def _level(self, time: float) -> float:
        return -max(self._force(depth) for depth in self._depths(time))

    def _stride(self, time: float) -> tuple[float, bool]:
        """Time, rad, for which no face can bear, and whether the nearest's force only grows in _AHEAD times that."""
        allowed = -self._limit / self._contact[0]
        shortest, single = math.inf, False
        for depth, bends in zip(self._depths(time), self._bends, strict=True):
            pressed = depth.place + self._lag * depth.rate, depth.rate + self._lag * depth.bend
            # that a face bears takes both figures above 0: the one that stays below for longer counts
            stride, rate, bend = max(
                (_below(allowed - place, rate, bend), rate, bend)
                for (place, rate), bend in zip((depth[:2], pressed), bends, strict=True)
            )
            if stride < shortest:
                shortest, single = stride, rate > bend * _AHEAD * stride
        return shortest, single


def _below(room: float, rate: float, bend: float) -> float:
    """Time t up to which rate t + bend t^2/2 stays below `room`: 0 where `room` is below 0, inf where always."""
    if room < 0.0:
        return 0.0
    root = math.sqrt(rate * rate + 2.0 * bend * room)
    if rate > 0.0:
        return 2.0 * room / (rate + root)
    return (root - rate) / bend if bend > 0.0 else math.inf
