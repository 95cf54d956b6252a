"""The longest run of samples whose values stay within a band, as first sample and number of cells.

A function of period n samples is known by its nodes and by its greatest and least value over each cell; cell i lies
between nodes i and i + 1. A window (start i, c cells) is a run of whole cells within the band that cannot be extended
by a whole cell on either side. The window taken is the one that reaches farthest along the abscissa, when its ends are
extended into the cells beside it as if the function were straight there. A straight line and a curve that begins level
differ by at most a fourth of a cell where they leave it: of windows whose lengths differ by less than half a cell
either may be taken.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices, Mask


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
    """Longest windows of m functions over each abscissa, (a, m): first node, and number of whole cells."""

    start: Indices
    cells: Indices


def longest_windows(samples: Samples, band: float) -> Windows:
    """Longest windows in which each function stays within a band, a difference in the unit of its values.

    Extremes over 1, 2, 4, ... cells from each node give a lower bound of the longest window, which excludes most nodes
    as its start; from the others the number of cells is composed of powers of two.
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
    starts = np.zeros((m, n), dtype=np.bool_)
    for abscissa in abscissae:
        starts |= _possible_starts(fits, abscissa)
    row, i = np.nonzero(starts)
    cells = np.zeros(len(row), dtype=np.intp)
    bottom = value[row, i]
    top = bottom.copy()
    flat = row * n
    for level in range(len(fits) - 1, -1, -1):
        node = flat + (i + cells) % n
        least, most = np.minimum(lows[level].ravel()[node], bottom), np.maximum(highs[level].ravel()[node], top)
        fit = (most - least <= band) & (cells + 2**level <= n)
        bottom, top = np.where(fit, least, bottom), np.where(fit, most, top)
        cells += fit * 2**level
    before = flat + (i - 1) % n
    # where the cell before fits too, a window from the node before contains this one
    longer = (np.maximum(top, high.ravel()[before]) - np.minimum(bottom, low.ravel()[before]) <= band) & (cells < n)
    row, i, cells, bottom, top = row[~longer], i[~longer], cells[~longer], bottom[~longer], top[~longer]
    first = np.searchsorted(row, np.arange(m))  # every row has at least one
    windows = Windows(np.zeros(abscissae.shape[:2], dtype=np.intp), np.zeros(abscissae.shape[:2], dtype=np.intp))
    for k, abscissa in enumerate(abscissae if m else ()):
        length = _lengths((value, abscissa), (row, i, cells), (bottom, top), band)
        # the longest of each row, the first of equals
        ties = np.flatnonzero(length == np.maximum.reduceat(length, first)[row])
        chosen = ties[np.searchsorted(row[ties], np.arange(m))]
        windows.start[k], windows.cells[k] = np.where(cells[chosen] == n, 0, i[chosen]), cells[chosen]
    return windows


def _pairwise(extreme: np.ufunc, values: Array, step: int) -> Array:
    """Least or greatest (m, n) of each value and the one `step` nodes on, round the turn."""
    extremes = np.empty_like(values)
    flat = values.ravel()
    # as one long row, which is faster; what that takes from the next row is then set right
    extreme(flat[:-step], flat[step:], out=extremes.ravel()[:-step])
    extreme(values[:, -step:], values[:, :step], out=extremes[:, -step:])
    return extremes


def _possible_starts(fits: list[Mask], abscissa: Array) -> Mask:
    """Nodes (m, n) at which a row's longest window may start; `fits[k]` (m, n) are those with 2^k cells in the band."""
    m, n = abscissa.shape
    if not fits:
        return np.ones((m, n), dtype=np.bool_)
    widest = np.maximum(np.diff(abscissa, axis=1).max(axis=1), abscissa[:, 0] + TURN - abscissa[:, -1])  # of a cell
    top = np.sum([fit.any(axis=1) for fit in fits], axis=0) - 1
    least = np.zeros(m)
    for level in range(len(fits)):
        rows = np.flatnonzero(top == level)
        if rows.size:
            x = abscissa[rows]
            span = np.empty((len(x), n))
            step = 2**level % n  # 0 where the window is the whole turn
            np.subtract(x[:, step:], x[:, : n - step], out=span[:, : n - step])
            np.subtract(x[:, :step] + TURN, x[:, n - step :], out=span[:, n - step :])
            least[rows] = TURN if step == 0 else np.where(fits[level][rows], span, 0.0).max(axis=1)
    # A window of fewer than 2^k whole cells reaches over less than 2^k + 1 cells.
    counts = 2.0 ** np.arange(len(fits))
    needed = ((widest[:, None] * (counts + 1.0) + _SLACK) < least[:, None]).sum(axis=1) - 1
    starts = np.ones((m, n), dtype=np.bool_)
    for level, fit in enumerate(fits):
        rows = np.flatnonzero(needed == level)
        starts[rows] = fit[rows]
    return starts


def _lengths(
    rows: tuple[Array, Array], window: tuple[Indices, Indices, Indices], limits: tuple[Array, Array], band: float
) -> Array:
    """Lengths along the abscissa of windows (row, first node, cells), their ends extended into the next cells straight.

    `limits` are least and greatest value within each window. The whole turn counts as infinite.
    """
    value, abscissa = rows
    row, i, cells = window
    bottom, top = limits
    n = value.shape[1]
    last = i + cells
    before, j, after = (i - 1) % n, last % n, (last + 1) % n
    x_i, x_before = abscissa[row, i], abscissa[row, before]
    x_j, x_after = abscissa[row, j], abscissa[row, after]
    x_before = np.where(before > i, x_before - TURN, x_before)
    x_j = np.where(last >= n, x_j + TURN, x_j)
    x_after = np.where(last + 1 >= n, x_after + TURN, x_after)
    lowest, highest = top - band, bottom + band
    left, left_side = _straight_share(value[row, i], value[row, before], lowest, highest)
    right, right_side = _straight_share(value[row, j], value[row, after], lowest, highest)
    left = left * (x_i - x_before)
    right = right * (x_after - x_j)
    more = np.where(left_side * right_side < 0, np.maximum(left, right), left + right)
    lengths: Array = np.where(cells == n, np.inf, (x_j - x_i) + more)
    return lengths


def _straight_share(inside: Array, outside: Array, lowest: Array, highest: Array) -> tuple[Array, NDArray[np.int8]]:
    """Share of a cell over which a straight line from `inside` keeps limits; 1 where it leaves above, -1 below."""
    up, down = outside > highest, outside < lowest
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(up, (highest - inside) / (outside - inside), 1.0)
        share = np.where(down, (inside - lowest) / (inside - outside), share)
    return share, np.where(up, 1, np.where(down, -1, 0)).astype(np.int8)
