"""Dwells of an output that has thousands of breaks, as a polygon gives it: the longest, without looking everywhere.

Blocks of the period are told apart by the least and greatest value at their nodes. Runs of whole blocks that surely
stay within the band say how long the longest window is at least; runs that cannot be excluded and are long enough are
where it must be. Only there the output is followed exactly (`kin.dwell`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.dwell import Dwell, dwells

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.arcs import Array

BLOCKS = 1024
ARCH = 16.0  # ranges of the output by which it is led away where it is not to be looked at
ARCH_SHARE = 0.25  # of the width of what is looked at


class Samples(NamedTuple):
    """An output at nodes x (m + 1,) through one period; between nodes it strays from their range by `slack` at most."""

    x: Array
    value: Array
    slack: float

    @property
    def period(self) -> float:
        """Length of the period."""
        return float(self.x[-1] - self.x[0])


def longest_dwell(f: Callable[[Array], Array], samples: Samples, band: float) -> Dwell:
    """Find the longest window over which f, smooth between the nodes and periodic, stays within the band.

    f(x (n,)) gives (n,), at any x. The window's start is brought to one period from 0.
    """
    x, period = samples.x, samples.period
    found = [_within(f, x, a, b, band) for a, b in _candidates(samples, band) if b - a < period]
    if not found:
        found = [_whole(f, samples, band)]
    best = max(found, key=lambda dwell: dwell.length)
    return Dwell(best.start % period, best.length, best.least, best.greatest)


def _whole(f: Callable[[Array], Array], samples: Samples, band: float) -> Dwell:
    x, period = samples.x, samples.period
    best = dwells(lambda t, _: f(t + x[0])[None], x[1:-1] - x[0], band, period, 1)[0]
    return Dwell(best.start + float(x[0]), best.length, best.least, best.greatest)


def _within(f: Callable[[Array], Array], x: Array, a: float, b: float, band: float) -> Dwell:
    """Find the longest window in [a, b], at whose ends the output is outside of it; b may lie beyond the period's end.

    The rest of the period is cut out, and an arch that quickly leaves the band put in its place.
    """
    period, width = x[-1] - x[0], b - a
    arch = ARCH_SHARE * width
    ends = f(np.array([a, b]))
    nodes = np.concatenate([x[:-1], x[:-1] + period])
    nodes = nodes[(nodes > a) & (nodes < b)]
    high = ARCH * max(float(np.ptp(f(nodes))), band)

    def cut(t: Array, _: int) -> Array:
        value = np.empty_like(t)
        outside = t >= width
        s = (t[outside] - width) / arch
        value[outside] = ends[1] + s * (ends[0] - ends[1]) + high * 4.0 * s * (1.0 - s)
        value[~outside] = f(t[~outside] + a)
        return value[None]

    best = dwells(cut, np.append(nodes - a, width), band, width + arch, 1)[0]
    return Dwell(best.start + a, best.length, best.least, best.greatest)


def _candidates(samples: Samples, band: float) -> list[tuple[float, float]]:
    """Stretches that contain every window that can be the longest, disjoint; from and to, which may be past the end."""
    x, value, slack = samples
    count = min(BLOCKS, len(x) - 1)
    first = np.searchsorted(x, x[0] + samples.period / count * np.arange(count))
    first = np.append(first[first < len(x) - 1], len(x) - 1)
    first = first[np.diff(first, prepend=-1) > 0]
    count = len(first) - 1
    # both ends of a block belong to it
    high = np.maximum(np.maximum.reduceat(value[:-1], first[:-1]), value[first[1:]])
    low = np.minimum(np.minimum.reduceat(value[:-1], first[:-1]), value[first[1:]])
    edge = np.concatenate([x[first[:-1]] - samples.period, x[first[:-1]], x[first] + samples.period])
    sure = _runs(low, high, band - 2.0 * slack)
    least = max((edge[count + i + n] - edge[count + i] for i, n in enumerate(sure)), default=0.0)
    spans: list[tuple[float, float]] = []
    for i, n in enumerate(_runs(low, high, band)):
        # the window may reach into the blocks before and after the run
        a, b = float(edge[count + i - 1]), float(edge[min(count + i + n + 1, len(edge) - 1)])
        if b - a >= least:
            if spans and a <= spans[-1][1]:
                spans[-1] = (spans[-1][0], max(b, spans[-1][1]))
            else:
                spans.append((a, b))
    if len(spans) > 1 and spans[0][0] + samples.period <= spans[-1][1]:  # the last runs on in the first
        spans[-1] = (spans[-1][0], max(spans[-1][1], spans[0][1] + samples.period))
        del spans[0]
    return spans if all(b - a < samples.period for a, b in spans) else []


def _runs(low: Array, high: Array, band: float) -> list[int]:
    """Of each block in a ring (m,) the number of blocks from it on, at most all, whose values stay within the band."""
    count = len(low)
    lows, highs = (np.concatenate([v, v]).tolist() for v in (low, high))
    runs, end = [], 0
    falls: list[
        int
    ] = []  # blocks ahead whose greatest value is greater than all that follow it, and likewise the least
    rises: list[int] = []
    for i in range(count):
        if end <= i:
            end, falls, rises = i, [], []
        while falls and falls[0] < i:
            falls.pop(0)
        while rises and rises[0] < i:
            rises.pop(0)
        while end < i + count:
            most = max(highs[end], highs[falls[0]] if falls else -np.inf)
            least = min(lows[end], lows[rises[0]] if rises else np.inf)
            if most - least > band:
                break
            while falls and highs[falls[-1]] <= highs[end]:
                falls.pop()
            while rises and lows[rises[-1]] >= lows[end]:
                rises.pop()
            falls.append(end)
            rises.append(end)
            end += 1
        runs.append(end - i)
    return runs
