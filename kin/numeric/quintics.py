"""Periodic functions by quintics, from values and two derivatives at both ends of intervals that cover the period.

Over an interval of width h the quintic misses the function by h^6 |f^(6)| / 46080 at most (Hermite's remainder), in
the middle. The caller chooses intervals that are short enough.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.extrema import extremes
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.numeric.arrays import Array, Indices
    from kin.numeric.extrema import Extremes


def coefficients(low: Array, high: Array, width: Array) -> Array:
    """Quintics' coefficients (6, n), lowest first, of powers of the share of the width (n,), from both ends.

    `low` and `high` (3, n) are f, f', f'' at the ends.
    """
    f, slope, bend = low[0], width * low[1], 0.5 * width**2 * low[2]
    rise, more, last = high[0] - f - slope - bend, width * high[1] - slope - 2.0 * bend, 0.5 * width**2 * high[2] - bend
    cubic, quartic = 10.0 * rise - 4.0 * more + last, 7.0 * more - 15.0 * rise - 2.0 * last
    return np.stack([f, slope, bend, cubic, quartic, 6.0 * rise - 3.0 * more + last])


def polynomial(c: Array, width: Array, step: Array, order: int) -> Array:
    """Value and derivatives by x (order + 1, n) at steps (n,) from the beginnings of intervals of a width (n,).

    `c` (k, n) are coefficients, lowest first, of powers of the share of the width; k is above `order`.
    """
    wide = np.where(width > 0.0, width, 1.0)
    share, rows = step / wide, []
    for _ in range(order + 1):
        value = c[-1]
        for row in c[-2::-1]:
            value = value * share + row
        rows.append(value)
        c = c[1:] * np.arange(1.0, len(c))[:, None] / wide
    return np.stack(rows)


@dataclass(frozen=True, eq=False)
class Quintics:
    """A function on m intervals between nodes x (m + 1,), one period long.

    `low` and `high` (3, m) are f, f', f'' at the ends of each interval, seen from within; derivatives may jump from one
    interval to the next.
    """

    x: Array
    low: Array
    high: Array

    def __call__(self, x: Array, order: int, side: int = 1) -> Array:
        """Give f and its derivatives (order + 1, n) at any x (n,), which is taken into the period.

        At a node they are those to the right (side 1) or to the left (side -1).
        """
        return self.within(*self._place(x, side), order)

    def extremes(self, begin: float, end: float, resolution: float) -> Extremes:
        """Extremes from x = `begin` to `end`, less than a period on, to a resolution.

        They are those of the whole period where `end` lies so far on that all intervals are met. Places are in the
        period from x[0] to x[-1]; indices count intervals from the one that holds `begin`. Raises UnsettledError where
        rounding makes the function rougher than the resolution.
        """
        (first, last), (x, y) = self._place(np.array([begin, end]), 1)
        count = len(self.x) - 1
        further = int(last - first) % count
        if further == 0 and y < x:  # a period on, but for less than an interval
            further = count - 1
        interval = (first + np.arange(further + 1)) % count
        low, high = self.x[interval], self.x[interval + 1]
        at_low, at_high = self.low[:, interval], self.high[:, interval]
        if further < count - 1:  # else the whole period: no interval is cut off at `begin` and `end`
            ends = self.within(np.array([first, last]), np.array([x, y]), 2)
            low[0], at_low[:, 0], high[-1], at_high[:, -1] = x, ends[:, 0], y, ends[:, 1]
        return extremes(low, high, at_low, at_high, lambda x, k: self.within(interval[k], x, 2), resolution=resolution)

    def within(self, interval: Indices, x: Array, order: int) -> Array:
        """Value and derivatives by x (order + 1, n) at x (n,) in the given intervals (n,)."""
        width = np.diff(self.x)[interval]
        return polynomial(self._coefficients[:, interval], width, x - self.x[interval], order)

    @cached_property
    def _coefficients(self) -> Array:
        return coefficients(self.low, self.high, np.diff(self.x))

    def _place(self, x: Array, side: int) -> tuple[Indices, Array]:
        """Interval of each x (n,), and x within the period."""
        begin, end = self.x[0], self.x[-1]
        x = np.where((x < begin) | (x > end), begin + np.mod(x - begin, end - begin), x)
        x = np.where(x == (end if side > 0 else begin), begin if side > 0 else end, x)
        interval = np.searchsorted(self.x, x, side="right" if side > 0 else "left") - 1
        return np.clip(interval, 0, len(self.x) - 2), x
