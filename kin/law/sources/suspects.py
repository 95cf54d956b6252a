"""Rows of a table that stand out, and noise beyond its digits.

A row is named for what leaving it out does, measured twice. Polynomials through the rows about it tell how far off each
row is from its neighbours, and they from theirs while it is left out: a corner of the law puts its neighbours off too,
a slip does not. Where that alone does not decide, the motion without the row does, by the mean square of the jerk.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.sources.least_jerk import Touch, UnsolvedError, least

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from numpy.typing import NDArray

    from kin.law.sources.least_jerk import Least
    from kin.law.sources.tabled import Tabled
    from kin.numeric.arrays import Array, Indices

# What a row must show, by corpora of sound and of spoilt tables (tests/support/written_tables.py): readings that it is
# off, times its neighbours' distances, and that times the fall of the jerk. Sound corners come to 5.7, and 244.
_OFF, _CLEAR, _DECIDED = 6.0, 6.0, 260.0
_LOOKED = 1.5  # times its neighbours' distances, and what digits leave open: the least for which it is left out
_ROUNDED = 0.25  # of what digits leave open: the least distance of a neighbour
# A row is alone in its table where it is so many times further off than all that it does not reach: corners are two.
_CLEAR_ALONE, _ALONE, _REACH = 2.0, 7.0, 5
_LEAST_ROWS = 12  # of a table in which a row can stand out: the polynomials span eleven
_GROUPS = ((0,), (0, 1))  # rows that are left out together: one, or two that were swapped
_SIDE, _BESIDE = 3, 2  # rows to either side that a polynomial goes through, and that are asked how far off they are
_ABOUT = 2  # rows to either side that count as about a row
_MOST_TRIED, _MOST_NAMED = 4, 8  # groups for which a motion is made at a time, groups that are named
# Noise: the share of successive rows that are off to alternate sides, the part of what digits leave open that the
# median row is off, and how many times that the greatest is. About a corner few are off, on smooth laws to one side.
_ALTERNATE, _NOISY, _EVEN = 0.25, 0.35, 12.0
_LADDER = 4.0  # factor from one reading to the next
_TENFOLD = 10.0  # fall of the mean square that marks noise
_COARSEST = 0.02  # of the stroke: the greatest reading that is tried


class Suspect(NamedTuple):
    """Rows that look wrong: one, or two side by side.

    rows      their indices in the table as laid out
    expected  values, mm or rad, of the curve through the other rows at their angles
    falls     factor by which the mean square of the jerk about them falls without them
    """

    rows: tuple[int, ...]
    expected: tuple[float, ...]
    falls: float


def nearest(rows: Tabled) -> tuple[Least | None, float | None]:
    """The motion within the rows' readings, None for a constant, and the factor of readings that shows noise.

    With readings greater by that factor, the greatest such power of 4, the mean square of the jerk is a tenth or less
    of that of the power before; None where there is none, or rows do not scatter. Raises UnsolvedError where rounding
    stands in the way, CrowdedError for a search that would take minutes.
    """
    most = _COARSEST * rows.stroke / float(rows.reading.max())
    if most < _LADDER or not _scatter(rows):
        return least(rows.space, rows.bounds()), None
    count = math.floor(math.log(most, _LADDER))
    steps: dict[int, Least | None] = {}

    def square(k: int, near: int) -> float:
        if k not in steps:
            start = steps.get(near)
            steps[k] = least(rows.space, rows.bounds(_LADDER**k), None if start is None else start.touch)
        step = steps[k]
        return 0.0 if step is None else step.square

    def tenfold(low: int, high: int) -> int:
        """The greatest power up to `high` that is such a step; `low` where none above it is.

        The mean square falls from reading to reading: between two where it falls less than tenfold there is none.
        """
        if square(low, middle := (low + high) // 2) < _TENFOLD * square(high, high):
            return low
        if high - low == 1:
            return high if square(high, high) else low
        square(middle, high)
        step = tenfold(middle, high)
        return step if step > middle else tenfold(low, middle)

    square(count, count)
    square(count // 2, count)  # a start from which fewer steps lead down
    step = tenfold(0, count)
    return steps[0], _LADDER**step if step else None


def _scatter(rows: Tabled) -> bool:
    """Whether rows lie about a smooth curve, on either side in turn, by more than their digits leave open."""
    if len(rows.x) < _LEAST_ROWS:
        return False
    off, left = _Line.of(rows, np.arange(len(rows.x))).off(0, (0,))
    moving = off != 0.0  # in a dwell no row is off
    if not moving.any():
        return False
    far = np.abs(off) > _NOISY * left
    alternate = np.count_nonzero(far[1:] & far[:-1] & (off[1:] * off[:-1] < 0.0))
    middle = float(np.median(np.abs(off[moving])))
    noisy = middle > _NOISY * float(np.median(left[moving])) and float(np.abs(off).max()) < _EVEN * middle
    return bool(noisy and alternate >= _ALTERNATE * np.count_nonzero(moving))


def suspects(rows: Tabled, plain: Least, *, noisy: bool = False) -> list[Suspect]:
    """Rows that stand out, those of the greatest distance first, each found among the others that are left.

    `plain` is the motion within the rows' readings. A row is named where it is off the motion through the others by
    many readings, where that is many times what its neighbours are off while it is left out, and where the jerk about
    it falls without it; none in a table of fewer than 12 rows. Of `noisy` rows the first alone decides.
    """
    named: list[Suspect] = []
    gone: set[int] = set()
    while len(named) < _MOST_NAMED and (found := _next(rows, plain, gone, noisy=noisy)) is not None:
        suspect, plain = found
        named.append(suspect)
        gone.update(*(_twins(rows, place) for place in suspect.rows))
    return named


def _next(rows: Tabled, plain: Least, gone: set[int], *, noisy: bool) -> tuple[Suspect, Least] | None:
    """The next row or pair that stands out while those in `gone` are left out, and the motion without it."""
    for ratio, clear, places in _likely(rows, gone):
        out = [twin for place in places for twin in _twins(rows, place)]
        without = _without(rows, plain, [*gone, *out])
        if without is None:
            continue
        expected = without.curve(rows.x[places])
        off = np.abs(rows.s[places] - expected) / rows.resolution[places]
        before, after = (_about(rows, motion, places) for motion in (plain, without))
        falls = before / after if after > 0.0 else math.inf
        if off.min() >= _OFF and falls > 1.0 and (ratio >= clear or (ratio * falls >= _DECIDED and not noisy)):
            return Suspect(tuple(places), tuple(expected.tolist()), falls), without
    return None


def _likely(rows: Tabled, gone: Collection[int]) -> list[tuple[float, float, list[int]]]:
    """Rows, or pairs of neighbours, that are further off than their neighbours are without them.

    Of each how many times, how many times do for certain, and its indices; one of which there is no other does sooner.
    All are measured by polynomials of degree five through the six nearest rows that are left. What is less than their
    readings leave open, or than half of all rows are off, is nothing.
    """
    n = len(rows.x) - len(gone)
    if n < _LEAST_ROWS:
        return []
    line = _Line.of(rows, np.setdiff1d(np.arange(len(rows.x)), list(gone)))
    _, first = np.unique(rows.lines, return_index=True)
    free = (rows.lines[line.which] > 0) & np.isin(line.which, first) & ~np.isin(line.which, rows.fixed)
    single = np.abs(line.off(0, (0,))[0])
    usual = float(np.median(single))
    likely: list[tuple[float, float, list[int]]] = []
    for group in _GROUPS:
        own = [line.off(k, group) for k in group]
        beside = [k for k in range(-_BESIDE, group[-1] + _BESIDE + 1) if k not in group]
        near = np.max([np.abs(line.off(k, group)[0]) for k in beside], axis=0)
        far, left = np.min([np.abs(off) for off, _ in own], axis=0), np.max([left for _, left in own], axis=0)
        ratio = far / np.maximum(np.maximum(near, _ROUNDED * left), usual)
        ratio[far < _LOOKED * left] = 0.0
        for k in group:  # neither what fills a turn or its other half, nor what is met exactly, nor behind the last row
            ratio[~np.roll(free, -k)] = 0.0
        ratio[~line.between(group)] = 0.0
        if not rows.period:
            ratio[n - group[-1] :] = 0.0
        order = np.argsort(-ratio)[:_MOST_TRIED].tolist()
        for i in order:
            if ratio[i] >= _LOOKED:
                away = np.abs(np.arange(n) - i)
                others = single[np.minimum(away, n - away) > _REACH].max(initial=_LOOKED * left[i])
                clear = _CLEAR_ALONE if len(group) == 1 and far[i] >= _ALONE * others else _CLEAR
                likely.append((float(ratio[i]), clear, [int(line.which[(i + k) % n]) for k in group]))
    return sorted(likely, reverse=True)[:_MOST_TRIED]


class _Line(NamedTuple):
    """Rows in a line, with more before and behind: those of a turn earlier and later, the levels of rests, or none.

    `which` are the indices of the n rows between.
    """

    which: Indices
    x: Array
    s: Array
    open: Array  # what each row's digits leave open
    more: int  # rows before the n, and behind them

    @staticmethod
    def of(rows: Tabled, which: Indices) -> _Line:
        """The rows of these indices, in a line."""
        more = _SIDE + _BESIDE + 2
        x, s, left = rows.x[which], rows.s[which], rows.resolution[which]
        if rows.space.free:
            return _Line(which, x, s, left, 0)
        if rows.space.rest is None:
            turn = rows.period
            again_s, again_left = (np.concatenate([column[-more:], column, column[:more]]) for column in (s, left))
            again_x = np.concatenate([x[-more:] - turn, x, x[:more] + turn])
            return _Line(which, again_x, again_s, again_left, more)
        (first, last), away = rows.space.rest, np.arange(more)
        before = rows.space.begin - away[::-1] * (x[0] - rows.space.begin)
        behind = rows.space.end + away * (rows.space.end - x[-1])
        return _Line(
            which,
            np.concatenate([before, x, behind]),
            np.concatenate([np.full(more, first), s, np.full(more, last)]),
            np.pad(left, more, mode="edge"),
            more,
        )

    def between(self, group: Sequence[int]) -> NDArray[np.bool_]:
        """Mask (n,) of rows from which on a group has three rows before and behind it: of free ends not all have."""
        i = np.arange(len(self.which)) + self.more
        mask: NDArray[np.bool_] = (i >= _SIDE) & (i + group[-1] < len(self.x) - _SIDE)
        return mask

    def off(self, at: int, out: Sequence[int]) -> tuple[Array, Array]:
        """How far each row's neighbour `at` is off the rows beside it but for those `out`, and what digits leave open.

        Both (n,); `at` and `out` are counted from the row. A neighbour beyond a free end is off by nothing; near one
        there are more rows on the other side.
        """
        reach, six = 2 * (_SIDE + _BESIDE) + 1, np.arange(2 * _SIDE)
        low, high = ([k for k in range(at - reach, at) if k not in out], range(at + 1, at + reach + 1))
        steps = np.array([*low, *(k for k in high if k not in out)])
        i, last = np.arange(len(self.which)) + self.more, len(self.x) - 1
        begin = np.searchsorted(steps, -i), np.searchsorted(steps, last - i, side="right") - len(six)
        place = i[:, None] + steps[np.clip(len(low) - _SIDE, *begin)[:, None] + six]
        here = np.clip(i + at, 0, last)
        apart = self.x[place] - self.x[here][:, None]
        # weights of the polynomial through the six, at the row
        weights = np.ones_like(apart)
        for a in range(apart.shape[1]):
            for b in range(apart.shape[1]):
                if a != b:
                    weights[:, a] *= apart[:, b] / (apart[:, b] - apart[:, a])
        off: Array = np.where(here == i + at, self.s[here] - (weights * self.s[place]).sum(axis=1), 0.0)
        left: Array = self.open[here] + (np.abs(weights) * self.open[place]).sum(axis=1)
        return off, left


def _twins(rows: Tabled, place: int) -> list[int]:
    """Indices of the rows that stand for one line of the file: two of a motion over two halves."""
    twins: list[int] = np.flatnonzero(rows.lines == rows.lines[place]).tolist()
    return twins


def _without(rows: Tabled, plain: Least, places: Sequence[int]) -> Least | None:
    """The motion without some rows; None where a constant is left, or rounding stands in the way."""
    bounds = rows.bounds()
    gone, keep = np.isin(bounds.row, places), ~np.isin(plain.row, places)
    bounds = bounds._replace(lo=np.where(gone, -np.inf, bounds.lo), hi=np.where(gone, np.inf, bounds.hi))
    try:
        return least(rows.space, bounds, Touch(plain.row[keep], plain.upper[keep]))
    except UnsolvedError:
        return None


def _about(rows: Tabled, motion: Least, places: Sequence[int]) -> float:
    """Integral of the jerk's square from two rows before the first of some neighbours to two rows behind the last."""
    n = len(rows.x)
    ends = places[0] - _ABOUT, places[0] + len(places) - 1 + _ABOUT
    if rows.period:
        begin, end = (float(rows.x[i % n]) + rows.period * (i // n) for i in ends)
    else:
        begin, end = (float(rows.x[min(max(i, 0), n - 1)]) for i in ends)
    return motion.curve.square(begin, end)
