"""A roller held within a triangle, where no edge holds it: a long triangle may reach beyond both ends of the roller.

At one angle of the grid the worst places of a triangle's points make a straight line across it, from edge to edge. What
of it lies within the roller's length holds the roller best at an end or where `kin.cylindrical.contact` says.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.arrays import runs_of

if TYPE_CHECKING:
    from kin.cylindrical.grid import Grid
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array, Indices

PAIRS = 200_000  # of a triangle and an angle at a time


class Holding(NamedTuple):
    """Points (n, 3) that hold a roller at angles of the grid, by their numbers (n,)."""

    number: Indices
    points: Array


def holding(gauge: Gauge, grid: Grid, corners: Array, theta: Array, wanted: Indices) -> list[Holding]:
    """Points within triangles (t, 3, 3) that hold the roller at the wanted angles of the grid, rising.

    `theta` (t, 3) are the worst angles of the corners, rad. Points stay within the roller's length for half a step.
    """
    period = gauge.lifts.period
    own = theta[:, :1] + np.remainder(theta - theta[:, :1] + 0.5 * period, period) - 0.5 * period
    low, high = own.min(axis=1), own.max(axis=1)
    turns = np.floor(low / period) * period
    low, high, own = low - turns, high - turns, own - turns[:, None]
    rising = np.concatenate([wanted, wanted + len(grid)])  # a triangle may go on over the end of the period
    first = np.searchsorted(rising, np.ceil(low / grid.width))
    count = np.maximum(np.searchsorted(rising, np.floor(high / grid.width), side="right") - first, 0)
    total, begin, found = np.cumsum(count), 0, []
    while begin < len(count):
        done = int(total[begin - 1]) if begin else 0
        end = max(begin + 1, int(np.searchsorted(total, done + PAIRS, side="right")))
        here = count[begin:end]
        which, step = runs_of(here)
        which += begin
        number = rising[first[which] + step]
        if len(which):
            found.append(_held(gauge, grid, corners[which], own[which], number))
        begin = end
    return found


def _held(gauge: Gauge, grid: Grid, corners: Array, theta: Array, number: Indices) -> Holding:
    at = grid.width * number.astype(np.float64)
    flags, places = [], []
    for j in range(3):
        k = (j + 1) % 3
        way = theta[:, k] - theta[:, j]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (at - theta[:, j]) / way
        flags.append((share >= 0.0) & (share <= 1.0))
        places.append(corners[:, j] + np.where(flags[-1], share, 0.0)[:, None] * (corners[:, k] - corners[:, j]))
    met, every = np.stack(flags), np.stack(places)
    rows = np.arange(len(at))
    start, last = every[np.argmax(met, axis=0), rows], every[2 - np.argmax(met[::-1], axis=0), rows]
    number %= len(grid)
    sine, cosine = grid.sine[number], grid.cosine[number]
    along = [own[:, 0] * cosine + own[:, 1] * sine for own in (start, last)]
    # while theta goes half a step, X changes by no more than y times that
    room = 0.51 * grid.width * gauge.reach
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = [(place - along[0]) / (along[1] - along[0]) for place in (gauge.inner + room, gauge.outer - room)]
    level = along[1] == along[0]
    inside = (along[0] >= gauge.inner + room) & (along[0] <= gauge.outer - room)
    low = np.where(level, np.where(inside, 0.0, 2.0), np.maximum(np.minimum(*ends), 0.0))
    high = np.where(level, 1.0, np.minimum(np.maximum(*ends), 1.0))
    share, there = gauge.best_within((start, last), (low, high), grid.lift[number], sine, cosine)
    there &= met.any(axis=0)
    points = start + share[:, None] * (last - start)
    return Holding(number[there], points[there])
