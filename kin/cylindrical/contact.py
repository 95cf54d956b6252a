"""A roller with ends set down on triangles at given angles, on edges and on cuts at its ends.

Seen along the roller's axis, the part of a triangle within the roller's length is a polygon, and the roller a circle.
On a side of it F is greatest where the roller says (`kin.cylindrical.roller`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.arrays import runs_of

if TYPE_CHECKING:
    from kin.cylindrical.roller import Gauge
    from kin.numeric.arrays import Array

PAIRS = 200_000  # of a triangle and an angle at a time


def set_down(gauge: Gauge, corners: Array, spans: tuple[Array, Array], theta: Array) -> Array:
    """How far triangles keep a roller from its intended place, mm along z, (n,) at angles theta (n,), rad.

    `corners` (t, 3, 3); `spans` are the least and the greatest angle (t,), rad, at which each triangle counts, the
    greatest above the least by less than the period. The roller stands above 0 where the metal does; -inf where it
    touches nothing.
    """
    period = gauge.lifts.period
    order = np.argsort(theta % period)
    rising = (theta % period)[order]
    best = np.full(len(theta), -np.inf)
    low = spans[0] % period
    for turn in (0.0, -period):  # a span may go on over the end of the period
        first = np.searchsorted(rising, low + turn)
        last = np.searchsorted(rising, low + turn + (spans[1] - spans[0]), side="right")
        count = np.maximum(last - first, 0)
        total, begin = np.cumsum(count), 0
        while begin < len(count):
            done = int(total[begin - 1]) if begin else 0
            end = max(begin + 1, int(np.searchsorted(total, done + PAIRS, side="right")))
            here = count[begin:end]
            own, step = runs_of(here)
            own += begin
            at = first[own] + step
            np.maximum.at(best, at, _gives(gauge, corners[own], rising[at]))
            begin = end
    found = np.empty(len(theta))
    found[order] = best
    return found


def _gives(gauge: Gauge, corners: Array, theta: Array) -> Array:
    """F (n,) of triangles (n, 3, 3), each at its angle (n,), as far as they lie within the roller's length."""
    sine, cosine, lift = np.sin(theta), np.cos(theta), gauge.lifts.at(theta)[0]
    along = corners[..., 0] * cosine[:, None] + corners[..., 1] * sine[:, None]
    best, rows = np.full(len(theta), -np.inf), np.arange(len(theta))
    cuts: dict[float, list[tuple[Array, Array]]] = {gauge.inner: [], gauge.outer: []}

    def greatest(ends: tuple[Array, Array], shares: tuple[Array, Array]) -> Array:
        most: Array = np.maximum(best, gauge.greatest(ends, shares, (lift, sine, cosine)))
        return most

    for j in range(3):
        k = (j + 1) % 3
        low, high = np.zeros(len(theta)), np.ones(len(theta))
        for place, sense in ((gauge.inner, 1.0), (gauge.outer, -1.0)):
            start, last = sense * (along[:, j] - place), sense * (along[:, k] - place)
            with np.errstate(divide="ignore", invalid="ignore"):
                share = start / (start - last)
            crosses = (start < 0.0) != (last < 0.0)
            low = np.where(crosses & (start < 0.0), np.maximum(low, share), low)
            high = np.where(crosses & (last < 0.0), np.minimum(high, share), high)
            high = np.where((start < 0.0) & (last < 0.0), -1.0, high)
            share = np.where(crosses, share, 0.0)[:, None]
            cuts[place].append((crosses, corners[:, j] + share * (corners[:, k] - corners[:, j])))
        best = greatest((corners[:, j], corners[:, k]), (low, high))
    for crossings in cuts.values():
        flags, places = np.stack([flag for flag, _ in crossings]), np.stack([place for _, place in crossings])
        first, last = np.argmax(flags, axis=0), 2 - np.argmax(flags[::-1], axis=0)
        whole = np.zeros(len(theta)), np.where(flags.any(axis=0), 1.0, -1.0)
        best = greatest((places[first, rows], places[last, rows]), whole)
    return best
