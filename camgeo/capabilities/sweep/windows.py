"""Between the samples of periodic functions: extremes, and the longest window within a band.

Rows (m, n) hold m functions at n even angles, with their derivatives by the angle. Between two samples the cubic
through both values and slopes stands for the function, wrong by h^4/384 of its fourth derivative.

A function is known by its nodes and by its greatest and least value over each cell; cell i lies between nodes i and
i + 1. A window (start i, c cells) is a run of whole cells within the band that cannot be extended by a whole cell on
either side. The window taken is the one that reaches farthest along the abscissa, when its ends are extended into the
cells beside it as if the function were straight there. A straight line and a curve that begins level differ by at most
a fourth of a cell where they leave it: of windows whose lengths differ by less than half a cell either may be taken.
The ends of the window taken are then computed by the cubics.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.newton import zeros

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices, Mask

_SLACK = 1e-9  # rad: windows shorter than the best by more than this are left out unmeasured
_BISECTIONS = 12  # of a band's place; near the best one a window's length hardly changes
_STEPS = 7  # of Newton's method, kept within a bracket
_PRECISION = 1e-9  # of a cell: error of the place where a level is crossed


def greatest(values: Array, smooth: Mask | bool = True) -> Array:
    """Greatest value (m,) of each row of `values` (m, n), periodic, in their unit.

    In smooth rows, a mask (m,) or all, it is the extreme of the parabola through three samples.
    """
    return _parabola_extreme(values, values.argmax(axis=1), smooth)


def _parabola_extreme(values: Array, i: Indices, smooth: Mask | bool) -> Array:
    """Extreme (m,) of the parabola through samples i - 1, i and i + 1 of each row; sample i where it is not smooth."""
    rows = np.arange(len(values))
    middle: Array = values[rows, i]
    before, after = values[rows, i - 1], values[rows, (i + 1) % values.shape[1]]
    # at the extreme of three the bend points one way, or all three are equal
    bend = (middle - before) + (middle - after)
    slope = after - before
    bent = (bend != 0.0) & smooth
    extreme: Array = middle + np.divide(slope * slope, 8.0 * bend, out=np.zeros_like(middle), where=bent)
    return extreme


def least(values: Array, smooth: Mask | bool = True) -> Array:
    """Least value (m,) of each row of `values` (m, n), periodic, in their unit.

    In smooth rows, a mask (m,) or all, it is the extreme of the parabola through three samples.
    """
    return _parabola_extreme(values, values.argmin(axis=1), smooth)


def cell_bounds(value: Array, slope: Array) -> tuple[Array, Array]:
    """Least and greatest value over each cell, (m, n) each; cell i lies between samples i and i + 1.

    `slope` is the derivative by the angle. Where it changes sign the cubic's extreme counts.
    """
    m, n = value.shape
    after = np.concatenate([value[:, 1:], value[:, :1]], axis=1)
    low, high = np.minimum(value, after), np.maximum(value, after)
    falls = slope < 0.0
    turns = np.empty((m, n), dtype=np.bool_)
    np.not_equal(falls[:, 1:], falls[:, :-1], out=turns[:, :-1])
    np.not_equal(falls[:, :1], falls[:, -1:], out=turns[:, -1:])
    row, i = np.nonzero(turns)
    j = (i + 1) % n
    h = TURN / n
    f, g = value[row, i], h * slope[row, i]
    cubic = _Cubic.between(f, g, value[row, j], h * slope[row, j])
    x = cubic.turns()[0]
    extreme = np.where(np.isnan(x), f, cubic(x))
    low[row, i] = np.minimum(low[row, i], extreme)
    high[row, i] = np.maximum(high[row, i], extreme)
    return low, high


class _Cubic(NamedTuple):
    """A cubic over one cell, f + g x + c x^2 + d x^3, 0 <= x <= 1."""

    f: Array
    g: Array
    c: Array
    d: Array

    @staticmethod
    def between(f: Array, g: Array, f1: Array, g1: Array) -> _Cubic:
        """The cubic with values f, f1 and slopes g, g1 at x = 0 and 1."""
        rise = f1 - f
        return _Cubic(f, g, 3.0 * rise - 2.0 * g - g1, g + g1 - 2.0 * rise)

    def __call__(self, x: Array) -> Array:
        return self.f + x * (self.g + x * (self.c + x * self.d))

    def slope(self, x: Array) -> Array:
        return self.g + x * (2.0 * self.c + x * (3.0 * self.d))

    def turns(self) -> tuple[Array, Array]:
        """Places in (0, 1) at which the slope is 0, the smaller and the greater, nan where there are fewer."""
        g, c, d = self.g, self.c, self.d
        with np.errstate(divide="ignore", invalid="ignore"):
            q = -(c + np.copysign(np.sqrt(c * c - 3.0 * d * g), c))
            roots = g / q, q / (3.0 * d)
        first, second = (np.where((root > 0.0) & (root < 1.0), root, np.nan) for root in roots)
        return np.fmin(first, second), np.where(np.isnan(first) | np.isnan(second), np.nan, np.maximum(first, second))


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
    # bounds over 2^k cells from each node, while such windows fit the band
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
    # from each start the greatest number of cells, its powers of two tried from the largest down
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
        length = _straight_lengths((value, abscissa), (row, i, cells), (bottom, top), band)
        # the longest of each row, the first of equals
        ties = np.flatnonzero(length == np.maximum.reduceat(length, first)[row])
        chosen = ties[np.searchsorted(row[ties], np.arange(m))]
        windows.start[k], windows.cells[k] = np.where(cells[chosen] == n, 0, i[chosen]), cells[chosen]
    return windows


def _pairwise(extreme: np.ufunc, values: Array, step: int) -> Array:
    """Least or greatest (m, n) of each value and the value `step` nodes on, round the turn."""
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


def _straight_lengths(
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
    # ends that leave on opposite sides together exceed the band: the longer one alone is added
    more = np.where(left_side * right_side < 0, np.maximum(left, right), left + right)
    lengths: Array = np.where(cells == n, np.inf, (x_j - x_i) + more)
    return lengths


def _straight_share(inside: Array, outside: Array, lowest: Array, highest: Array) -> tuple[Array, NDArray[np.int8]]:
    """Share of a cell over which a straight line from `inside` to `outside` keeps limits, and where it leaves them.

    The second result is 1 where it leaves above, -1 below, 0 where it stays.
    """
    up, down = outside > highest, outside < lowest
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(up, (highest - inside) / (outside - inside), 1.0)
        share = np.where(down, (inside - lowest) / (inside - outside), share)
    return share, np.where(up, 1, np.where(down, -1, 0)).astype(np.int8)


class Ends(NamedTuple):
    """m windows: a core of whole cells, and the two cells on either side in which the window ends.

    `low`, `high` (m,) are least and greatest value over the core, `core` (m,) its length along the abscissa. `behind`
    and `ahead` (4, m, 3) have the three nodes outward from the core's two ends: value, its slope by the cell, distance
    along the abscissa, its slope by the cell. `whole` (m,) says whether the window is the whole turn.
    """

    low: Array
    high: Array
    core: Array
    behind: Array
    ahead: Array
    whole: Mask

    @staticmethod
    def concatenate(parts: list[Ends]) -> Ends:
        """Windows of several blocks, one block behind another."""
        low, high, core, behind, ahead, whole = zip(*parts, strict=True)
        sides = np.concatenate(behind, axis=1), np.concatenate(ahead, axis=1)
        return Ends(np.concatenate(low), np.concatenate(high), np.concatenate(core), *sides, np.concatenate(whole))

    def part(self, rows: Mask) -> Ends:
        """Windows of some rows (m,)."""
        sides = self.behind[:, rows], self.ahead[:, rows]
        return Ends(self.low[rows], self.high[rows], self.core[rows], *sides, self.whole[rows])


def window_ends(
    window: tuple[Indices, Indices],
    output: tuple[Array, Array],
    abscissa: tuple[Array, Array],
    bounds: tuple[Array, Array],
) -> Ends:
    """Ends of windows, from which `window_lengths` measures them.

    `window` are first node and number of whole cells, (m,) each. `output` and `abscissa` are values and slopes by the
    angle, (m, n); the abscissa rises, by 2 pi a turn. `bounds` are the output's least and greatest value over each
    cell, (m, n). The first and the last cell are no part of the core, as a window may lose less at one end than it
    gains at the other.
    """
    take = np.take_along_axis
    start, cells = window
    n = output[0].shape[1]
    spare = cells >= 2
    first, count = start + spare, cells - 2 * spare
    first, last = first % n, (first + count) % n
    inner = (first[:, None] + np.minimum(np.arange(max(int(count.max(initial=0)), 1)), count[:, None] - 1)) % n
    at_first = take(output[0], first[:, None], axis=1)[:, 0]
    # where there is no cell in the core it is a node; else its cells' bounds hold its nodes' values
    low = np.where(count > 0, take(bounds[0], inner, axis=1).min(axis=1), at_first)
    high = np.where(count > 0, take(bounds[1], inner, axis=1).max(axis=1), at_first)
    # three nodes outward from each end of the core, slopes by the cell
    sides = []
    for node, step in ((first, -1), (last, 1)):
        nodes = (node[:, None] + step * np.arange(3)) % n
        along = take(abscissa[0], nodes, axis=1)
        distance = np.mod((along - along[:, :1]) * step, TURN)
        h = step * TURN / n
        slopes = h * take(output[1], nodes, axis=1), abs(h) * take(abscissa[1], nodes, axis=1)
        sides.append(np.stack([take(output[0], nodes, axis=1), slopes[0], distance, slopes[1]]))
    core = take(abscissa[0], last[:, None], axis=1)[:, 0] - take(abscissa[0], first[:, None], axis=1)[:, 0]
    return Ends(low, high, np.where(core < 0.0, core + TURN, core), sides[0], sides[1], cells == n)


def window_lengths(ends: Ends, band: float) -> Array:
    """Lengths of m windows along the abscissa (m,), each within the band of a height that makes it longest.

    The band [y, y + band] contains the core; raising it moves ends at its lower limit inward and ends at its upper
    limit outward, each by 1/slope. So the best y is the lowest, the highest, or where the two rates balance, which
    bisection finds.
    """
    best, length_rate = _length(ends, ends.high - band, band)
    rising = length_rate > 0.0  # most windows end at the lower limit on both sides, and the lowest band is the best
    if rising.any():
        part = ends.part(rising)
        below, above = part.high - band, part.low
        longest, _ = _length(part, above, band)
        longest = np.maximum(longest, best[rising])
        for _ in range(_BISECTIONS):
            y = 0.5 * (below + above)
            length, length_rate = _length(part, y, band)
            longest = np.maximum(longest, length)
            below, above = np.where(length_rate > 0.0, y, below), np.where(length_rate > 0.0, above, y)
        best[rising] = longest
    return np.where(ends.whole, TURN, np.minimum(best, TURN))


def _length(ends: Ends, low: Array, band: float) -> tuple[Array, Array]:
    """Length within [low, low + band], and its derivative by `low`."""
    behind, rate_behind = _reach(ends.behind, low, low + band)
    ahead, rate_ahead = _reach(ends.ahead, low, low + band)
    return ends.core + behind + ahead, rate_behind + rate_ahead


def _reach(side: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """Distances (m,), rad of the abscissa, outward from an end of each core where the output stays in [low, high].

    Their derivatives (m,) are by a shift of both limits. `side` (4, m, 3) is `behind` or `ahead` of `Ends`, whose two
    cells bound the distances.
    """
    reach, reach_rate, inside = np.zeros_like(low), np.zeros_like(low), np.ones(len(low), dtype=np.bool_)
    for cell in (0, 1):
        # values f and slopes g of the output, x and v of the distance, at both nodes of the cell
        f, g, x, v = side[:, :, cell]
        f1, g1, x1, v1 = side[:, :, cell + 1]
        output, abscissa = _Cubic.between(f, g, f1, g1), _Cubic.between(x, v, x1, v1)
        t, side_left = _first_exit(output, low, high)
        reach = np.where(inside, abscissa(t), reach)
        with np.errstate(divide="ignore", invalid="ignore"):
            more = np.abs(abscissa.slope(t) / output.slope(t)) * side_left
        reach_rate = np.where(inside, more, reach_rate)
        inside &= side_left == 0
    return reach, reach_rate


def _first_exit(cell: _Cubic, lowest: Array, highest: Array) -> tuple[Array, NDArray[np.int8]]:
    """First x where a cubic leaves [lowest, highest], else 1; and 1 where it leaves above, -1 below, else 0.

    At x = 0 it is inside, but for rounding; between its turning places it is monotone.
    """
    begin, end = np.zeros_like(cell.f), np.ones_like(cell.f)
    side = np.zeros(len(cell.f), dtype=np.int8)
    inside = np.ones(len(cell.f), dtype=np.bool_)
    for place in (*cell.turns(), end.copy()):
        there = inside & ~np.isnan(place)
        value = cell(np.where(there, place, 0.0))
        out = np.where(value > highest, 1, np.where(value < lowest, -1, 0)).astype(np.int8)
        out[~there] = 0
        side = np.where(out != 0, out, side).astype(np.int8)
        end = np.where(out != 0, place, end)
        inside &= out == 0
        begin = np.where(there & inside, place, begin)
    x = np.ones_like(cell.f)
    rows = np.flatnonzero(side)
    part, sense = _Cubic(*(column[rows] for column in cell)), side[rows]
    level = np.where(sense > 0, highest[rows], lowest[rows])
    x[rows] = _crossing(part, sense, level, begin[rows], end[rows])
    return x, side


def _crossing(cell: _Cubic, sense: NDArray[np.int8], level: Array, low: Array, high: Array) -> Array:
    """Place in [low, high] at which a monotone cubic crosses a level, (m,); upward where `sense` is 1, else downward.

    Exact to `_PRECISION` of a cell. A few steps are made of all rows together; rows still open are solved alone.
    """
    x, moved = 0.5 * (low + high), np.zeros_like(low)
    for step in range(_STEPS):
        miss = (cell(x) - level) * sense
        low, high = np.where(miss < 0.0, x, low), np.where(miss < 0.0, high, x)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = x - miss / (cell.slope(x) * sense)
        # a step beyond the bracket ends at the bracket's end or, every other time, in its middle
        beyond = np.clip(newton, low, high) if step % 2 == 0 else 0.5 * (low + high)
        following = np.where((newton >= low) & (newton <= high), newton, beyond)
        x, moved = following, np.abs(following - x)
    left = np.flatnonzero(~(moved <= _PRECISION))
    if left.size:
        part, target, way = _Cubic(*(column[left] for column in cell)), level[left], sense[left]
        start = low[left], high[left], x[left]
        x[left] = zeros(lambda x: ((part(x) - target) * way, part.slope(x) * way), *start, _PRECISION)
    return x
