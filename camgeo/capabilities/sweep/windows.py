"""The longest stretch of samples whose values stay within a band: which samples.

A function of period n samples is known by its nodes and by its greatest and least value over each cell, cell i lying
between nodes i and i + 1. A window (start i, c cells) is a run of whole cells within the band that no further cell on
either side fits into. Of all windows the one is taken that reaches farthest along the abscissa, its ends drawn out
into the cells beside it as if the function ran straight there. A straight line and a bent one that begins level leave
a cell at most a fourth of it apart: of windows whose lengths differ by less than half a cell either may be taken.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = ["Samples", "Windows", "longest"]

Array: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]

_TURN = 2 * math.pi
_SLACK = 1e-9  # rad: windows shorter than the best by more than this are left out unmeasured


class Samples(NamedTuple):
    """m functions at n nodes: value (m, n); bounds over the cells, low and high (m, n), which hold their nodes' values.

    `abscissae` (a, m, n) rise, by 2 pi a turn; windows are found over each of them.
    """

    value: Array
    low: Array
    high: Array
    abscissae: Array


class Windows(NamedTuple):
    """For each abscissa and each of m functions the window, (a, m): first node, and whole cells behind it."""

    start: Indices
    cells: Indices


def longest(samples: Samples, band: float) -> Windows:
    """Find the windows by extremes over 1, 2, 4, ... cells from each node.

    Levels that fit tell how long the longest window is at least, and so from which nodes on none can be; from the nodes
    left over the count of cells is put together from powers of two.
    """
    value, low, high, abscissae = samples
    m, n = value.shape
    lows, highs, fits = [low], [high], [high - low <= band]
    while 2 ** len(fits) <= n and fits[-1].any():
        step = 2 ** (len(fits) - 1)
        lows.append(_pairwise(np.minimum, lows[-1], step))
        highs.append(_pairwise(np.maximum, highs[-1], step))
        fits.append(highs[-1] - lows[-1] <= band)
    if not fits[-1].any():
        lows, highs, fits = lows[:-1], highs[:-1], fits[:-1]
    chosen = np.zeros((m, n), dtype=np.bool_)
    for abscissa in abscissae:
        chosen |= _promising(fits, abscissa)
    row, i = np.nonzero(chosen)
    cells = np.zeros(len(row), dtype=np.intp)
    bottom = value[row, i]
    top = bottom.copy()
    flat = row * n
    for level in range(len(fits) - 1, -1, -1):
        at = flat + (i + cells) % n
        least, most = np.minimum(lows[level].ravel()[at], bottom), np.maximum(highs[level].ravel()[at], top)
        fit = (most - least <= band) & (cells + 2**level <= n)
        bottom, top = np.where(fit, least, bottom), np.where(fit, most, top)
        cells += fit * 2**level
    before = flat + (i - 1) % n
    held = np.maximum(top, high.ravel()[before]) - np.minimum(bottom, low.ravel()[before]) <= band
    held &= cells < n  # a window from the node before holds this one
    row, i, cells, bottom, top = row[~held], i[~held], cells[~held], bottom[~held], top[~held]
    first = np.searchsorted(row, np.arange(m))  # every row has at least one
    found = Windows(np.zeros(abscissae.shape[:2], dtype=np.intp), np.zeros(abscissae.shape[:2], dtype=np.intp))
    for k, abscissa in enumerate(abscissae if m else ()):
        reach = _reach((value, abscissa), (row, i, cells), (bottom, top), band)
        # the best of each row, the first of equals
        best = np.maximum.reduceat(reach, first)
        hits = np.flatnonzero(reach == best[row])
        at = hits[np.searchsorted(row[hits], np.arange(m))]
        found.start[k], found.cells[k] = np.where(cells[at] == n, 0, i[at]), cells[at]
    return found


def _pairwise(extreme: np.ufunc, values: Array, step: int) -> Array:
    """Extreme of each value and the one `step` behind it, round the turn."""
    found = np.empty_like(values)
    flat = values.ravel()
    # as one long row, which is faster; what that takes from the next row is then set right
    extreme(flat[:-step], flat[step:], out=found.ravel()[:-step])
    extreme(values[:, -step:], values[:, :step], out=found[:, -step:])
    return found


def _promising(fits: list[NDArray[np.bool_]], abscissa: Array) -> NDArray[np.bool_]:
    """Nodes (m, n) from which a row's longest window may start."""
    m, n = abscissa.shape
    if not fits:
        return np.ones((m, n), dtype=np.bool_)
    widest = np.maximum(np.diff(abscissa, axis=1).max(axis=1), abscissa[:, 0] + _TURN - abscissa[:, -1])  # of a cell
    top = np.sum([fit.any(axis=1) for fit in fits], axis=0) - 1
    least = np.zeros(m)
    for level in range(len(fits)):
        rows = np.flatnonzero(top == level)
        if rows.size:
            x = abscissa[rows]
            span = np.empty((len(x), n))
            step = 2**level % n  # 0 where the window is the whole turn
            np.subtract(x[:, step:], x[:, : n - step], out=span[:, : n - step])
            np.subtract(x[:, :step] + _TURN, x[:, n - step :], out=span[:, n - step :])
            least[rows] = _TURN if step == 0 else np.where(fits[level][rows], span, 0.0).max(axis=1)
    # A window of fewer than 2^k whole cells reaches over less than 2^k + 1 cells.
    counts = 2.0 ** np.arange(len(fits))
    needed = ((widest[:, None] * (counts + 1.0) + _SLACK) < least[:, None]).sum(axis=1) - 1
    chosen = np.ones((m, n), dtype=np.bool_)
    for level, fit in enumerate(fits):
        rows = np.flatnonzero(needed == level)
        chosen[rows] = fit[rows]
    return chosen


def _reach(
    rows: tuple[Array, Array], window: tuple[Indices, Indices, Indices], limits: tuple[Array, Array], band: float
) -> Array:
    """Length of each window with its ends drawn out straight."""
    value, abscissa = rows
    row, i, cells = window
    bottom, top = limits
    n = value.shape[1]
    last = i + cells
    before, j, after = (i - 1) % n, last % n, (last + 1) % n
    x_i, x_before = abscissa[row, i], abscissa[row, before]
    x_j, x_after = abscissa[row, j], abscissa[row, after]
    x_before = np.where(before > i, x_before - _TURN, x_before)
    x_j = np.where(last >= n, x_j + _TURN, x_j)
    x_after = np.where(last + 1 >= n, x_after + _TURN, x_after)
    floor, ceiling = top - band, bottom + band
    left, left_side = _straight(value[row, i], value[row, before], floor, ceiling)
    right, right_side = _straight(value[row, j], value[row, after], floor, ceiling)
    left = left * (x_i - x_before)
    right = right * (x_after - x_j)
    more = np.where(left_side * right_side < 0, np.maximum(left, right), left + right)
    reach: Array = np.where(cells == n, np.inf, (x_j - x_i) + more)
    return reach


def _straight(inside: Array, outside: Array, floor: Array, ceiling: Array) -> tuple[Array, NDArray[np.int8]]:
    """Share of a cell that a straight line from `inside` stays between the limits, and which it leaves by."""
    up, down = outside > ceiling, outside < floor
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(up, (ceiling - inside) / (outside - inside), 1.0)
        share = np.where(down, (inside - floor) / (inside - outside), share)
    return share, np.where(up, 1, np.where(down, -1, 0)).astype(np.int8)
