"""Piecewise smooth functions cut into polynomials that are monotone, and so are their slopes: nothing is sampled past.

Between breaks each function is interpolated at Chebyshev points, on cells that are halved until the last Chebyshev
coefficients are below the resolution; the polynomial then stands for the function to about the next coefficient. In
Bernstein form its turning points and points of inflection are counted by the signs of the coefficients (variation
diminishing), so none is missed, and the polynomial is cut at them. What is left are pieces on which every question
has one answer: the extremes of a function are at ends of pieces, a level is crossed once or not at all.

Points of a cell are inside it, so one-sided values at a break are never asked for. Where the polynomials of two
neighbours do not meet, or one does not meet the function just inside a break, something between their outermost points
and their ends was missed: they are halved.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from itertools import pairwise
from math import comb
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.bernstein import halves, restrict, rising_root, values
from kin.numeric.distinct import distinct
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from kin.numeric.arrays import Array, Indices, Mask

    Extremes = tuple[tuple[float, float], tuple[float, float]]

DEGREE = 10
FIRST_CELLS = 32
# Cells no wider than this part of the whole are taken as they are: a corner or step nobody declared lies in them.
LEAST_CELL = 2.0**-34
# More unresolved cells than this, and than twice the first ones, are not a corner or two: the function is rough.
MOST_UNRESOLVED = 2048
# Interpolation and the change of basis are good to about this part of the greatest value.
NOISE = 64.0 * 2.0**-52
# What is left of a cell is rounding of the function itself if it is small, a part of the greatest value, and has not
# gone down to a share of what was left some generations ago, in either half of a cell: a corner is in one half alone.
MOST_NOISE = 1e-6
# Where a function is steep, its argument's rounding counts: this part of the whole.
BLUR = 2.0**-43
GENERATIONS = 3
STAGNANT = 0.25
AMPLIFIED = 16.0  # by the change of basis, and from one place to another
# Neighbours meet within so many times what is accepted of either: a polynomial is least known at its ends.
MEETING = 8.0
# Cuts closer than this to an end of a cell, as a share of it, are the end.
END_MARGIN = 1e-9
# A run along a level no longer than this part of the whole is one point.
SAME = 1e-6


class RoughError(CamgeoError, ArithmeticError):
    """A function that no polynomials follow to a `resolution`; `at` is one of the x at which they do not."""

    def __init__(self, place: float, resolution: float) -> None:
        super().__init__(f"the function is too rough to be resolved to {resolution:.3g} near {place:.9g}")
        self.at = place
        self.resolution = resolution


@dataclass(frozen=True, eq=False)
class Cells:
    """Polynomials for r functions on m cells [low, high] (m,), rising: Bernstein `coefficients` (r, m, DEGREE + 1).

    `noise` (r, m) is the greatest error of the coefficients by rounding.
    """

    low: Array
    high: Array
    coefficients: Array
    noise: Array

    def at(self, x: Array) -> Array:
        """Values (r, n) of all r functions at x (n,)."""
        cell = np.clip(np.searchsorted(self.low, x, side="right") - 1, 0, len(self.low) - 1)
        share = (x - self.low[cell]) / (self.high - self.low)[cell]
        return np.stack([values(c[cell], share) for c in self.coefficients])

    def reach(self, level: Array) -> tuple[Indices, Array]:
        """Cells, and shares of their width, (n,) each, where the first function, which rises, has values `level` (n,).

        Raises UnsettledError where a level is not a number.
        """
        rising = self.coefficients[0]
        cell = np.clip(np.searchsorted(rising[:, 0], level, side="right") - 1, 0, len(rising) - 1)
        return cell, rising_root(rising[cell] - level[:, None])


class _Basis(NamedTuple):
    """Chebyshev points in (0, 1) (k,), and matrices that take values there to coefficients.

    These are the Bernstein coefficients (k, k), and the last two Chebyshev coefficients (2, k).
    """

    points: Array
    bernstein: Array
    last: Array


@lru_cache(maxsize=1)
def _basis() -> _Basis:
    n = DEGREE + 1
    angle = np.pi * (2 * np.arange(n) + 1) / (2 * n)
    x = 0.5 - 0.5 * np.cos(angle)
    k = np.arange(n)
    weights = np.array([float(comb(DEGREE, i)) for i in range(n)])
    table = weights * x[:, None] ** k * (1 - x[:, None]) ** (DEGREE - k)
    last = 2.0 / n * np.cos(np.outer([DEGREE - 1, DEGREE], angle))
    return _Basis(x, np.asarray(np.linalg.inv(table), dtype=float), last)


def _evenly(places: Array, counts: Indices) -> tuple[Array, Array]:
    """Low and high ends (n,) of equal cells, `counts` (m,) of them between neighbours of the places (m + 1,)."""
    begin, end = np.repeat(places[:-1], counts), np.repeat(places[1:], counts)
    count = np.repeat(counts, counts)
    number = np.arange(len(count)) - np.repeat(np.cumsum(counts) - counts, counts)
    step = (end - begin) / count
    return number * step + begin, np.where(number + 1 < count, (number + 1) * step + begin, end)


def cells(f: Callable[[Array], Array], places: Array, resolution: float | Array = 0.0, *, share: float = 0.0) -> Cells:
    """Interpolate r functions, f(x (n,)) -> (r, n), between places (m + 1,) that rise, breaks among them.

    Each is resolved to `resolution` ((r,) or one for all), or to a `share` of its greatest absolute value, or to its
    own rounding, whichever is most. Errors that do not fall as cells are halved are rounding. Raises RoughError where
    too many cells are left unresolved.
    """
    basis = _basis()
    widest = (places[-1] - places[0]) / FIRST_CELLS
    counts = np.maximum(np.ceil(np.diff(places) / widest - 1e-9), 1).astype(int)
    low, high = _evenly(places, counts)
    least = LEAST_CELL * (places[-1] - places[0])
    most = max(MOST_UNRESOLVED, 2 * len(low))
    blur = BLUR * (places[-1] - places[0])
    scale = np.zeros(1)
    before = np.full((GENERATIONS, len(low)), np.inf)  # what was left of each cell's forebears, the oldest first
    done: list[_Resolved] = []
    while len(low):
        # the last two Chebyshev coefficients on each cell estimate the error, in units of what is allowed: `excess`
        at = low[:, None] + (high - low)[:, None] * basis.points
        y = f(at.ravel())
        y = y.reshape(len(y), *at.shape)
        scale = np.maximum(scale, np.abs(y).max(axis=(1, 2)))
        allowed = np.maximum(resolution, max(share, 0.25 * NOISE) * scale)[:, None]
        last = np.abs(y @ basis.last.T).max(axis=2)
        allowed = np.maximum(allowed, np.ptp(y, axis=2) * (blur / (high - low)))
        excess = np.divide(last, allowed, out=np.zeros_like(last), where=last > 0).max(axis=0)
        rounding = (excess > STAGNANT * before[0]) & (last <= MOST_NOISE * scale[:, None]).all(axis=0)
        rounding &= np.roll(rounding, len(low) // 2)  # in both halves of a cell
        # cells that are resolved, rounding or too narrow are done, the rest are halved
        narrow = high - low <= least
        unresolved = (excess > 1.0) & ~rounding & ~narrow
        error = allowed + np.where(narrow, np.ptp(y, axis=2), 0.0)
        done.append(_Resolved(low, high, y, last * rounding, error).chosen(~unresolved))
        low, high = low[unresolved], high[unresolved]
        before = np.tile(np.vstack([before[1:, unresolved], excess[unresolved]]), 2)
        if not len(low):  # a corner between the outermost point of a cell and its end shows at that end
            whole = _Resolved.of(done)
            parted = whole.parted(f, places, scale) & (whole.high - whole.low > least)
            done, low, high = [whole.chosen(~parted)], whole.low[parted], whole.high[parted]
            before = np.full((GENERATIONS, 2 * len(low)), np.inf)
        if len(low) > most:
            raise RoughError(float(low[0]), float(allowed.max()))
        middle = 0.5 * (low + high)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    (whole,) = done
    base = whole.y[..., DEGREE // 2, None]  # rounding in the change of basis is then that of the change within the cell
    return Cells(whole.low, whole.high, base + (whole.y - base) @ basis.bernstein.T, whole.noise(scale))


class _Resolved(NamedTuple):
    """Cells [low, high] (m,) that are done, with values `y` (r, m, DEGREE + 1) of r functions at their points.

    `left` (r, m) is what rounding leaves of the last coefficients, `error` (r, m) the greatest error that is accepted.
    """

    low: Array
    high: Array
    y: Array
    left: Array
    error: Array

    @staticmethod
    def of(parts: list[_Resolved]) -> _Resolved:
        """All cells of the parts, rising."""
        columns = zip(*parts, strict=True)
        low, high, *rows = (np.concatenate(column, axis=min(column[0].ndim - 1, 1)) for column in columns)
        order = np.argsort(low)
        return _Resolved(low[order], high[order], *(row[:, order] for row in rows))

    def chosen(self, mask: Mask) -> _Resolved:
        """The cells for which the mask (m,) is true."""
        return _Resolved(self.low[mask], self.high[mask], self.y[:, mask], self.left[:, mask], self.error[:, mask])

    def noise(self, scale: Array) -> Array:
        """Greatest error of coefficients by rounding (r, m); `scale` (r,) is the greatest size of each function."""
        return NOISE * scale[:, None] + AMPLIFIED * self.left

    def parted(self, f: Callable[[Array], Array], places: Array, scale: Array) -> Mask:
        """Mask (m,) of cells that do not meet their neighbours, or beside one of the places (k,) do not meet f."""
        basis, width = _basis(), self.high - self.low
        begins, ends = (self.y @ column for column in basis.bernstein[[0, -1]])
        error = MEETING * self.error + self.noise(scale)
        apart = (np.abs(ends[:, :-1] - begins[:, 1:]) > error[:, :-1] + error[:, 1:]).any(axis=0)
        apart &= ~np.isin(self.low[1:], places)
        parted: Mask = np.append(apart, False) | np.append(False, apart)
        begin, end = np.flatnonzero(np.isin(self.low, places)), np.flatnonzero(np.isin(self.high, places))
        inside = np.minimum(np.maximum(END_MARGIN * width, BLUR * (places[-1] - places[0])), 0.5 * width)
        x = np.concatenate([(self.low + inside)[begin], (self.high - inside)[end]])
        beside = np.concatenate([begin, end])
        t = (x - self.low[beside]) / width[beside]
        own = np.stack([values(row, t) for row in self.y[:, beside] @ basis.bernstein.T])
        parted[beside[(np.abs(f(x) - own) > error[:, beside]).any(axis=0)]] = True
        return parted


@dataclass(frozen=True, eq=False)
class MonotonePieces:
    """A function on n pieces between nodes x (n + 1,), each a polynomial, monotone and with a monotone slope.

    `coefficients` (n, k + 1) are Bernstein coefficients over each piece, `blur` (n,) their greatest error by rounding.
    """

    x: Array
    coefficients: Array
    blur: Array

    @cached_property
    def noise(self) -> float:
        """Greatest error of a value by rounding."""
        return float(self.blur.max())

    @property
    def width(self) -> Array:
        """Width of each piece (n,)."""
        return np.diff(self.x)

    @property
    def values(self) -> Array:
        """Value at each node (n + 1,), by the piece that begins there, or ends at the last node."""
        return np.append(self.coefficients[:, 0], self.coefficients[-1, -1])

    def at(self, piece: Indices, x: Array) -> Array:
        """Values (n,) at x (n,) of the given pieces (n,)."""
        return values(self.coefficients[piece], (x - self.x[piece]) / self.width[piece])

    def slope(self, piece: Indices, x: Array) -> Array:
        """Slopes (n,) at x (n,) of the given pieces (n,)."""
        c = np.diff(self.coefficients[piece], axis=1) * (self.coefficients.shape[1] - 1)
        width = self.width[piece]
        return values(c, (x - self.x[piece]) / width) / width

    def crossing(self, piece: Indices, level: Array) -> Array:
        """Points x (n,) at which the given pieces (n,) reach levels (n,), or the ends nearer to the level.

        An end whose value is the level to rounding is taken as the point, as the piece may be flat there.
        """
        c = self.coefficients[piece]
        rising = np.where(c[:, -1] >= c[:, 0], 1.0, -1.0)
        c = (c - level[:, None]) * rising[:, None]
        begins, ends = (np.abs(c[:, end]) <= self.blur[piece] for end in (0, -1))
        inside = ~(begins | ends)
        t = np.where(begins, 0.0, 1.0)
        t[inside] = rising_root(c[inside])
        return self.x[piece] + np.clip(t, 0.0, 1.0) * self.width[piece]

    def crossings(self, level: float) -> Array:
        """Every x (m,) at which the function passes or touches `level`, rising; of a run along it both ends."""
        value = self.values - level
        zero = np.abs(value) <= np.maximum(np.append(self.blur, 0.0), np.append(0.0, self.blur))
        through = np.flatnonzero((value[:-1] * value[1:] < 0) & ~zero[:-1] & ~zero[1:])
        edge = np.flatnonzero(np.diff(np.concatenate([[0], zero, [0]])))
        begin, end = self.x[edge[::2]], self.x[edge[1::2] - 1]
        short = end - begin <= SAME * (self.x[-1] - self.x[0])
        runs = np.concatenate([0.5 * (begin + end)[short], begin[~short], end[~short]])
        return distinct(np.concatenate([runs, self.crossing(through, np.full(len(through), level))]))

    def crossings_round(self, level: float) -> Array:
        """As `crossings`, of a function that repeats: its last x is its first, and a run over both has no end there."""
        places, first, last = self.crossings(level), self.x[0], self.x[-1]
        same = SAME * (last - first)
        if len(places) < 2 or places[0] - first > same or last - places[-1] > same:
            return places
        # from the node farthest from the level on, round to it again
        away = np.abs(self.values[:-1] - level)
        begin = int(np.argmax(away))
        if away[begin] <= self.noise:
            return np.empty(0)
        x = np.concatenate([self.x[begin:], self.x[1 : begin + 1] + (last - first)])
        turned = MonotonePieces(x, np.roll(self.coefficients, -begin, axis=0), np.roll(self.blur, -begin))
        return np.unique(first + np.mod(turned.crossings(level) - first, last - first))

    def least(self) -> tuple[float, float]:
        """Least value, and the x at which it is reached."""
        ends = self.coefficients[:, [0, -1]]
        k, end = divmod(int(ends.argmin()), 2)
        return float(ends[k, end]), float(self.x[k + end])

    def greatest(self) -> tuple[float, float]:
        """Greatest value, and the x at which it is reached."""
        ends = self.coefficients[:, [0, -1]]
        k, end = divmod(int(ends.argmax()), 2)
        return float(ends[k, end]), float(self.x[k + end])


def pieces(cells: Cells, row: int = 0) -> MonotonePieces:
    """Cut the function of a row into pieces that are monotone and have monotone slopes."""
    least = LEAST_CELL * (cells.high[-1] - cells.low[0])
    of = np.full(len(cells.low), row)
    parts = _single(_Parts(cells.low, cells.high, cells.coefficients[row], cells.noise[row], of), least)
    for order in (1, 2):
        parts = _cut(parts, order)
    parts = parts.chosen(np.argsort(parts.low))
    return MonotonePieces(np.append(parts.low, parts.high.max()), parts.c, parts.noise)


def extremes(cells: Cells, row: int = 0) -> Extremes:
    """Least and greatest value of the function of a row, each with its x; costs less than its `pieces`."""
    return extremes_of_each(Cells(cells.low, cells.high, cells.coefficients[[row]], cells.noise[[row]]))[0]


def extremes_of_each(cells: Cells) -> list[Extremes]:
    """Least and greatest value of each of the r functions, each with its x; costs hardly more than those of one.

    A polynomial lies within the hull of its coefficients, so that only cells are cut whose halves reach beyond a value
    that some cell has; of many cells those are few.
    """
    c = cells.coefficients
    left, right = (half.reshape(c.shape) for half in halves(c.reshape(-1, c.shape[2])))
    ends = np.stack([c[..., 0], left[..., -1], c[..., -1]])
    least, greatest = ends.min(axis=(0, 2)), ends.max(axis=(0, 2))
    chosen = np.maximum(left.max(axis=2), right.max(axis=2)) >= greatest[:, None]
    chosen |= np.minimum(left.min(axis=2), right.min(axis=2)) <= least[:, None]
    row, cell = np.nonzero(chosen)
    parts = _Parts(cells.low[cell], cells.high[cell], c[chosen], cells.noise[chosen], row)
    parts = _cut(_single(parts, LEAST_CELL * (cells.high[-1] - cells.low[0])), 1)
    parts = parts.chosen(np.lexsort((parts.low, parts.row)))
    begins = np.searchsorted(parts.row, np.arange(len(c) + 1)).tolist()
    places, values = np.column_stack([parts.low, parts.high]), parts.c[:, [0, -1]]
    found: list[Extremes] = []
    for begin, end in pairwise(begins):
        x, y = places[begin:end], values[begin:end]
        lowest, highest = int(y.argmin()), int(y.argmax())
        found.append(((float(y.flat[lowest]), float(x.flat[lowest])), (float(y.flat[highest]), float(x.flat[highest]))))
    return found


class _Parts(NamedTuple):
    """Cells [low, high] (m,), each of the function `row` (m,): Bernstein coefficients (m, k + 1), and noise (m,)."""

    low: Array
    high: Array
    c: Array
    noise: Array
    row: Indices

    def chosen(self, which: Mask | Indices) -> _Parts:
        return _Parts(*(column[which] for column in self))

    @staticmethod
    def joined(parts: Iterable[_Parts]) -> _Parts:
        return _Parts(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _single(parts: _Parts, least: float) -> _Parts:
    """Halve cells until each has at most one turning point and one of inflection, or is no wider than `least`."""
    done = []
    while len(parts.low):
        single = (_changes(parts.c, 1, parts.noise) <= 1) & (_changes(parts.c, 2, parts.noise) <= 1)
        single |= parts.high - parts.low <= least
        done.append(parts.chosen(single))
        open_ = parts.chosen(~single)
        middle, (left, right) = 0.5 * (open_.low + open_.high), halves(open_.c)
        parts = _Parts.joined([open_._replace(high=middle, c=left), open_._replace(low=middle, c=right)])
    return _Parts.joined(done)


def _differences(c: Array, order: int, noise: Array) -> Array:
    """Differences of an order of coefficients (n, k + 1); differences that may be rounding are 0."""
    d = np.diff(c, order, axis=1)
    d[np.abs(d) <= 2.0**order * noise[:, None]] = 0.0
    return d


def _changes(c: Array, order: int, noise: Array) -> Indices:
    """How often the differences of each row change sign (n,)."""
    signs = np.sign(_differences(c, order, noise))
    # a zero takes the sign before it
    last = np.maximum.accumulate(np.where(signs != 0, np.arange(signs.shape[1]), 0), axis=1)
    filled = np.take_along_axis(signs, last, axis=1)
    changed: Indices = np.count_nonzero(filled[:, 1:] * filled[:, :-1] < 0, axis=1)
    return changed


def _cut(parts: _Parts, order: int) -> _Parts:
    """Cells cut where the derivative of the given order changes sign, once in a cell at most."""
    turning = np.flatnonzero(_changes(parts.c, order, parts.noise) == 1)
    of = parts.chosen(turning)
    kept = _differences(of.c, order, of.noise)
    first = kept[np.arange(len(kept)), np.argmax(kept != 0, axis=1)]
    t = rising_root(np.diff(of.c, order, axis=1) * -np.sign(first)[:, None])
    inside = (t > END_MARGIN) & (t < 1.0 - END_MARGIN)
    of, t = of.chosen(inside), t[inside]
    at = of.low + t * (of.high - of.low)
    left, right = restrict(of.c, np.zeros_like(t), t), restrict(of.c, t, np.ones_like(t))
    uncut = np.ones(len(parts.low), dtype=np.bool_)
    uncut[turning[inside]] = False
    return _Parts.joined([parts.chosen(uncut), of._replace(high=at, c=left), of._replace(low=at, c=right)])


def between(begin: float, end: float, breaks: Iterable[float]) -> Array:
    """Places (m + 1,), rising, to interpolate between: both ends, and the breaks (any order) that are inside."""
    inside = [x for x in breaks if begin < x < end]
    return distinct(np.array([begin, *inside, end]))
