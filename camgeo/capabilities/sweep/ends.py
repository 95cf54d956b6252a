"""What lies between the samples of a periodic function: extremes, and where a dwell begins and ends.

Rows (m, n) hold m functions at n even angles, with their derivatives by the angle. Between two samples the cubic
through both values and slopes stands for the function, wrong by h^4/384 of its fourth derivative.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from kin.numeric.newton import zeros

Array: TypeAlias = NDArray[np.float64]
Indices: TypeAlias = NDArray[np.intp]

_TURN = 2.0 * math.pi
_BISECTIONS = 12  # of a band; about the best one a window's length is flat
_STEPS = 7  # of Newton's method, kept within a bracket
_SETTLED = 1e-9  # of a cell: to this a level is met within it


def greatest(values: Array, smooth: NDArray[np.bool_] | bool = True) -> Array:
    """Greatest value of each row (m,), between the samples by a parabola in the rows that are smooth."""
    return _extreme(values, values.argmax(axis=1), smooth)


def _extreme(values: Array, i: Indices, smooth: NDArray[np.bool_] | bool) -> Array:
    rows = np.arange(len(values))
    middle: Array = values[rows, i]
    before, after = values[rows, i - 1], values[rows, (i + 1) % values.shape[1]]
    # at the extreme of three the bend points one way, or all three are equal
    bend = (middle - before) + (middle - after)
    slope = after - before
    top: Array = middle + np.divide(slope * slope, 8.0 * bend, out=np.zeros_like(middle), where=(bend != 0.0) & smooth)
    return top


def least(values: Array, smooth: NDArray[np.bool_] | bool = True) -> Array:
    """Least value of each row (m,); see `greatest`."""
    return _extreme(values, values.argmin(axis=1), smooth)


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
    h = _TURN / n
    f, g = value[row, i], h * slope[row, i]
    c, d = _bends(f, g, value[row, j], h * slope[row, j])
    x = _turning(g, c, d)[0]
    extreme = f + x * (g + x * (c + x * d))
    extreme = np.where(np.isnan(x), f, extreme)
    low[row, i] = np.minimum(low[row, i], extreme)
    high[row, i] = np.maximum(high[row, i], extreme)
    return low, high


def _bends(f: Array, g: Array, f1: Array, g1: Array) -> tuple[Array, Array]:
    """Coefficients of x^2 and x^3 of the cubic with values f, f1 and slopes g, g1 at x = 0 and 1."""
    rise = f1 - f
    return 3.0 * rise - 2.0 * g - g1, g + g1 - 2.0 * rise


def _turning(g: Array, c: Array, d: Array) -> tuple[Array, Array]:
    """Where in (0, 1) the cubic turns, first and second place; nan where it does not."""
    with np.errstate(divide="ignore", invalid="ignore"):
        q = -(c + np.copysign(np.sqrt(c * c - 3.0 * d * g), c))
        one, two = g / q, q / (3.0 * d)
    one = np.where((one > 0.0) & (one < 1.0), one, np.nan)
    two = np.where((two > 0.0) & (two < 1.0), two, np.nan)
    return np.fmin(one, two), np.where(np.isnan(one) | np.isnan(two), np.nan, np.maximum(one, two))


class Ends(NamedTuple):
    """What decides how long m windows are: a core of whole cells, and two cells on either side of it.

    `low`, `high` (m,) are least and greatest value over the core, `core` (m,) its length along the abscissa. `behind`
    and `ahead` (4, m, 3) lead from the core's two ends outward: value, its slope a cell, distance along the abscissa,
    and its slope a cell. `whole` (m,) tells that the window is the whole turn.
    """

    low: Array
    high: Array
    core: Array
    behind: Array
    ahead: Array
    whole: NDArray[np.bool_]

    @staticmethod
    def joined(parts: list[Ends]) -> Ends:
        """Put those of several blocks behind one another."""
        low, high, core, behind, ahead, whole = zip(*parts, strict=True)
        sides = np.concatenate(behind, axis=1), np.concatenate(ahead, axis=1)
        return Ends(np.concatenate(low), np.concatenate(high), np.concatenate(core), *sides, np.concatenate(whole))

    def part(self, rows: NDArray[np.bool_]) -> Ends:
        """Return some of them."""
        sides = self.behind[:, rows], self.ahead[:, rows]
        return Ends(self.low[rows], self.high[rows], self.core[rows], *sides, self.whole[rows])


def ends(
    window: tuple[Indices, Indices],
    output: tuple[Array, Array],
    abscissa: tuple[Array, Array],
    bounds: tuple[Array, Array],
) -> Ends:
    """Take from the samples what `lengths` needs of each window.

    `window` are first node and whole cells, (m,) each. `output` and `abscissa` are values and slopes by the angle,
    (m, n); the abscissa rises, by 2 pi a turn. `bounds` are those of the output over each cell. The first and the last
    cell of a window are left out of its core, as what is given up at one end may be less than what that gains at the
    other.
    """
    start, cells = window
    n = output[0].shape[1]
    spare = cells >= 2
    first, count = start + spare, cells - 2 * spare
    first, last = first % n, (first + count) % n
    inner = (first[:, None] + np.minimum(np.arange(max(int(count.max(initial=0)), 1)), count[:, None] - 1)) % n
    at_first = _of(output[0], first[:, None])[:, 0]
    # where there is no cell in the core it is a node; else its cells' bounds hold its nodes' values
    low = np.where(count > 0, _of(bounds[0], inner).min(axis=1), at_first)
    high = np.where(count > 0, _of(bounds[1], inner).max(axis=1), at_first)
    sides = []
    for node, step in ((first, -1), (last, 1)):
        nodes = (node[:, None] + step * np.arange(3)) % n
        along = _of(abscissa[0], nodes)
        distance = np.mod((along - along[:, :1]) * step, _TURN)
        h = step * _TURN / n
        slopes = h * _of(output[1], nodes), abs(h) * _of(abscissa[1], nodes)
        sides.append(np.stack([_of(output[0], nodes), slopes[0], distance, slopes[1]]))
    core = _of(abscissa[0], last[:, None])[:, 0] - _of(abscissa[0], first[:, None])[:, 0]
    return Ends(low, high, np.where(core < 0.0, core + _TURN, core), sides[0], sides[1], cells == n)


def _of(values: Array, nodes: Indices) -> Array:
    """Values (m, n) at nodes (m, k) of each row."""
    m, n = values.shape
    found: Array = values.ravel()[nodes + np.arange(0, m * n, n)[:, None]]
    return found


def lengths(ends: Ends, band: float) -> Array:
    """Lengths of m windows, drawn out or in to where the output leaves the best band that holds the core; (m,).

    The band [y, y + band] may lie where it will as long as it holds the core; raising it moves ends that lie on its
    floor inward and ends on its ceiling outward, each by 1/slope. So the best y is the lowest, the highest, or where
    the slopes balance, which is found by bisection.
    """
    best, gain = _length(ends, ends.high - band, band)
    rising = gain > 0.0  # of most windows both ends lie on the floor, and the lowest band is the best
    if rising.any():
        part = ends.part(rising)
        below, above = part.high - band, part.low
        longest, _ = _length(part, above, band)
        longest = np.maximum(longest, best[rising])
        for _ in range(_BISECTIONS):
            y = 0.5 * (below + above)
            length, gain = _length(part, y, band)
            longest = np.maximum(longest, length)
            below, above = np.where(gain > 0.0, y, below), np.where(gain > 0.0, above, y)
        best[rising] = longest
    return np.where(ends.whole, _TURN, np.minimum(best, _TURN))


def _length(ends: Ends, floor: Array, band: float) -> tuple[Array, Array]:
    """Length within [floor, floor + band], and its derivative by the floor."""
    behind, slope_behind = _reach(ends.behind, floor, floor + band)
    ahead, slope_ahead = _reach(ends.ahead, floor, floor + band)
    return ends.core + behind + ahead, slope_behind + slope_ahead


def _reach(side: Array, floor: Array, ceiling: Array) -> tuple[Array, Array]:
    """How far the output keeps within limits, going outward; and by how much more if these are raised."""
    reach, gain, open_ = np.zeros_like(floor), np.zeros_like(floor), np.ones(len(floor), dtype=np.bool_)
    for cell in (0, 1):
        f, g, x, v = side[:, :, cell]
        f1, g1, x1, v1 = side[:, :, cell + 1]
        output = _Cubic(f, g, *_bends(f, g, f1, g1))
        abscissa = _Cubic(x, v, *_bends(x, v, x1, v1))
        t, out = _exit(output, floor, ceiling)
        reach = np.where(open_, abscissa(t), reach)
        with np.errstate(divide="ignore", invalid="ignore"):
            more = np.abs(abscissa.slope(t) / output.slope(t)) * out
        gain = np.where(open_, more, gain)
        open_ &= out == 0
    return reach, gain


class _Cubic(NamedTuple):
    """A cubic over one cell, f + g x + c x^2 + d x^3, 0 <= x <= 1."""

    f: Array
    g: Array
    c: Array
    d: Array

    def __call__(self, x: Array) -> Array:
        return self.f + x * (self.g + x * (self.c + x * self.d))

    def slope(self, x: Array) -> Array:
        return self.g + x * (2.0 * self.c + x * (3.0 * self.d))


def _exit(cell: _Cubic, floor: Array, ceiling: Array) -> tuple[Array, NDArray[np.int8]]:
    """First place where a cubic leaves [floor, ceiling], else 1; and by which, 1 the ceiling, -1 the floor, else 0.

    It is inside, but for rounding, at 0. From there it is monotone to its first turning place, and so on.
    """
    one, two = _turning(cell.g, cell.c, cell.d)
    begin, end = np.zeros_like(cell.f), np.ones_like(cell.f)
    side = np.zeros(len(cell.f), dtype=np.int8)
    open_ = np.ones(len(cell.f), dtype=np.bool_)
    for place in (one, two, end.copy()):
        there = open_ & ~np.isnan(place)
        value = cell(np.where(there, place, 0.0))
        out = np.where(value > ceiling, 1, np.where(value < floor, -1, 0)).astype(np.int8)
        out[~there] = 0
        side = np.where(out != 0, out, side).astype(np.int8)
        end = np.where(out != 0, place, end)
        open_ &= out == 0
        begin = np.where(there & open_, place, begin)
    x = np.ones_like(cell.f)
    rows = np.flatnonzero(side)
    part, sense = _Cubic(*(column[rows] for column in cell)), side[rows]
    level = np.where(sense > 0, ceiling[rows], floor[rows])
    x[rows] = _passed(part, sense, level, begin[rows], end[rows])
    return x, side


def _passed(cell: _Cubic, sense: NDArray[np.int8], level: Array, low: Array, high: Array) -> Array:
    """Where a cubic that is monotone in [low, high] passes a level, upward where `sense` is 1, else downward.

    Found to `_SETTLED` of a cell; the few that some steps of all together leave are looked for alone.
    """
    x, moved = 0.5 * (low + high), np.zeros_like(low)
    for step in range(_STEPS):
        miss = (cell(x) - level) * sense
        low, high = np.where(miss < 0.0, x, low), np.where(miss < 0.0, high, x)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = x - miss / (cell.slope(x) * sense)
        # beyond its bracket it is held at the end, which from a bent side it then leaves for good, or in the middle
        beyond = np.clip(newton, low, high) if step % 2 == 0 else 0.5 * (low + high)
        following = np.where((newton >= low) & (newton <= high), newton, beyond)
        x, moved = following, np.abs(following - x)
    left = np.flatnonzero(~(moved <= _SETTLED))
    if left.size:
        part, at, way = _Cubic(*(column[left] for column in cell)), level[left], sense[left]
        x[left] = zeros(lambda x: ((part(x) - at) * way, part.slope(x) * way), low[left], high[left], x[left], _SETTLED)
    return x
