"""Rows of a table that stand out, and noise beyond its digits, by the mean square of the jerk that they cause."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.sources.least_jerk import Touch, least, pulls

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.sources.least_jerk import Least
    from kin.law.sources.tabled import Tabled

_FALLS = 2.0  # least factor by which the mean square falls without a row that is remarked on
# Such factors for a certain row: in short strokes, and in strokes of the third number of rows or more.
_SURE, _SURE_OF_MANY, _MANY = 3.0, 1.1, 16
_LEAST_ROWS, _SURE_OF_FEW = 5, 6.0  # rows of the shortest stroke in which a bad one shows, and the factor there
_OFF = 3.0  # readings: least distance of a certain row from the curve through the others
_ABOUT = 2  # rows to either side that count as about a row
_CALMER = 10.0  # least factor by which the mean square about a certain row falls without it
_SHARP = 0.5  # of the mean square that is left: where more of it lies about a row, the law itself is sharp there
_LIKELY = 0.08  # of the mean square: least fall, with the other rows still touched, of rows that are tried
# Numbers of rows: those of the greatest multipliers, those paired with a neighbour, those solved for.
_MOST_TRIED, _PAIRED, _MOST_SOLVED = 6, 3, 3
_TOGETHER = 2  # rows from one of a pair to the other at most
_LADDER = 4.0  # factor from one reading to the next
_TENFOLD = 10.0  # fall of the mean square that marks noise
_ROUNDING = 1.0 + 1e-9
_COARSEST = 0.02  # of the stroke: the greatest reading that is tried


class Suspect(NamedTuple):
    """Rows that look wrong.

    rows      their indices in the table as laid out
    falls     factor by which the mean square jerk falls without them
    expected  values, mm or rad, of the curve through the other rows at their angles
    certain   whether only an error explains them
    """

    rows: tuple[int, ...]
    falls: float
    expected: tuple[float, ...]
    certain: bool


def ladder(rows: Tabled) -> tuple[Least | None, float | None]:
    """The motion within the rows' readings, None for a constant, and the factor of readings that shows noise.

    With readings greater by that factor, the greatest such power of 4, the mean square of the jerk is a tenth or less
    of that of the power before; None where there is none. The mean square falls from reading to reading: between two
    where it falls less than tenfold there is no such step. Raises UnsolvedError where rounding stands in the way,
    CrowdedError for a search that would take minutes.
    """
    most = _COARSEST * rows.stroke / float(rows.reading.max())
    count = max(0, math.floor(math.log(most, _LADDER))) if most > 1.0 else 0
    steps: dict[int, Least | None] = {}

    def square(k: int, near: int) -> float:
        if k not in steps:
            start = steps.get(near)
            steps[k] = least(rows.space, rows.bounds(_LADDER**k), None if start is None else start.touch)
        step = steps[k]
        return 0.0 if step is None else step.square

    def tenfold(low: int, high: int) -> int:
        """The greatest power up to `high` that is such a step; `low` where none above it is."""
        if square(low, middle := (low + high) // 2) < _TENFOLD * square(high, high):
            return low
        if high - low == 1:
            return high if square(high, high) else low
        square(middle, high)
        step = tenfold(middle, high)
        return step if step > middle else tenfold(low, middle)

    square(count, count)
    square(count // 2, count)  # a start from which fewer steps lead down where rows scatter
    step = tenfold(0, count) if count else 0
    return steps[0], _LADDER**step if step else None


def suspect(rows: Tabled, plain: Least, *, noisy: bool) -> Suspect | None:
    """The row, or two neighbouring rows, without which the mean square jerk falls most; None where no row stands out.

    Without it the mean square must be half or less, or the row must be certain to be wrong. `plain` is the motion
    within the rows' readings. `noisy` tells that the rows scatter more than they are rounded: then any row must show as
    great a fall as one in a short stroke.
    """
    best = None
    for places in _likely(rows, plain):
        if best is not None and best.certain and len({*rows.lines[list(places)].tolist()}) > len(best.rows):
            break
        sure = _sure(rows, places)
        sure = max(sure, _SURE) if noisy else sure
        without = _without(rows, plain, places, min(sure, _FALLS))
        if without is None or not without.square:
            continue
        falls = plain.square / without.square
        certain = falls >= sure and _certain(rows, plain, without, places)
        better = best is None or (certain, falls) > (best.certain, best.falls)
        named = list({int(rows.lines[place]): place for place in reversed(places) if rows.lines[place]}.values())
        if named and (certain or falls >= _FALLS) and better:  # rows that fill a turn have no line
            best = Suspect(tuple(named), falls, tuple(without.curve(rows.x[named]).tolist()), certain)
    return best


def _sure(rows: Tabled, places: Sequence[int]) -> float:
    """Least factor by which the mean square must fall without certain rows; greater in a stroke of few rows."""
    span = min(spanned(rows, place) for place in places)
    if span < _LEAST_ROWS:
        return math.inf
    return _SURE_OF_FEW if span == _LEAST_ROWS else _SURE if span < _MANY else _SURE_OF_MANY


def _certain(rows: Tabled, plain: Least, without: Least, places: Sequence[int]) -> bool:
    """Whether rows at `places` are off by more than their digits, and are no part of a law that is sharp there."""
    index = list(places)
    off = np.abs(rows.s[index] - without.curve(rows.x[index])) / rows.reading[index]
    if off.max() < _OFF:
        return False
    before, after = (max(_about(rows, nearest, place) for place in places) for nearest in (plain, without))
    return before >= _CALMER * after and after <= _SHARP * without.square


def _about(rows: Tabled, nearest: Least, place: int) -> float:
    """Integral of the jerk's square over two rows to either side of a row."""
    n = len(rows.x)
    ends = place - _ABOUT, place + _ABOUT
    if rows.period:
        begin, end = (float(rows.x[i % n]) + rows.period * (i // n) for i in ends)
    else:
        begin, end = (float(rows.x[min(max(i, 0), n - 1)]) for i in ends)
    return nearest.curve.square(begin, end)


def _without(rows: Tabled, plain: Least, places: Sequence[int], falls: float) -> Least | None:
    """The motion without some rows; the search ends once its mean square cannot be `falls` times less."""
    bounds = rows.bounds()
    gone, keep = np.isin(bounds.row, places), ~np.isin(plain.row, places)
    bounds = bounds._replace(lo=np.where(gone, -np.inf, bounds.lo), hi=np.where(gone, np.inf, bounds.hi))
    ample = plain.square / falls * _ROUNDING
    return least(rows.space, bounds, Touch(plain.row[keep], plain.upper[keep]), ample=ample)


def _likely(rows: Tabled, plain: Least) -> list[tuple[int, ...]]:
    """Indices of single rows, then of pairs, by which much of the mean square is caused, the greatest first.

    A motion over two halves has each row twice.
    """
    k = len(plain.row)
    order = np.argsort(-np.abs(plain.pull))[:_MOST_TRIED].tolist()

    def falls(group: Sequence[int]) -> float:
        """Share by which the mean square of the jerk falls without a group of rows, the other rows still touched."""
        left = np.delete(np.arange(k), group)
        return 1.0 - pulls(rows.space, plain.x[left], plain.values[left])[1] / plain.square

    def twins(i: int) -> list[int]:
        line = rows.lines[plain.row[i]]
        return [i] if not line else np.flatnonzero(rows.lines[plain.row] == line).tolist()

    singles = {tuple(twins(i)) for i in order}
    pairs = [(i, (i + way) % k) for i in order[:_PAIRED] for way in (-1, 1)]
    beside = {tuple(sorted({*twins(i), *twins(j)})) for i, j in pairs if _together(rows, plain, i, j)}
    likely = []
    for groups in (singles, beside - singles):
        weighed = sorted(((falls(group), group) for group in groups), reverse=True)[:_MOST_SOLVED]
        likely += [tuple(plain.row[list(group)].tolist()) for share, group in weighed if share >= _LIKELY]
    return likely


def _together(rows: Tabled, plain: Least, i: int, j: int) -> bool:
    """Whether the touched rows i and j have at most one other row between them."""
    n, apart = len(rows.x), abs(int(plain.row[i]) - int(plain.row[j]))
    return 0 < min(apart, n - apart if rows.period else n) <= _TOGETHER


def spanned(rows: Tabled, place: int) -> int:
    """Number of rows in the stroke, a monotone run of values, to which the row of index `place` belongs, with it.

    For a row between two strokes of opposite sense, a peak, it is that of the shorter stroke, the peak left out.
    """
    n = len(rows.s)
    sides = []
    for way in (-1, 1):
        if rows.period:
            s = rows.s[(place + way * np.arange(1, n)) % n]
        else:
            s = rows.s[:place][::-1] if way < 0 else rows.s[place + 1 :]
        signs = np.sign(np.diff(s))
        changes = np.flatnonzero(signs != signs[0]) if len(signs) else signs
        run = int(changes[0]) if len(changes) else len(signs)
        # one row alone, at the end of a table, is of the sense of the other side
        sides.append((min(run + 1, len(s)), way * float(signs[0]) if len(signs) else None))
    (left, rising), (right, later) = sides
    if rising is None or later is None or rising == later:
        return left + right + 1
    if not rising or not later:  # at the foot of a stroke, beside a dwell
        return (left if rising else right) + 1
    return min(left, right)
