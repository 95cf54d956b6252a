"""Dwells of a table: runs of equal rows, exactly level on their inner part.

Rounded rows stay equal for a while after a motion has left its dwell. So the ends of a dwell are moved in, first to
where the motion without dwells has little acceleration, until the peak with the dwell is about that without. Where a
dwell over a quarter of a run is still too long, its rows are equal for another reason, such as a slow flank of few
digits, and the run is no dwell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.sources.least_jerk import FunctionSpace, UnsolvedError, least
from kin.law.sources.ring import SAME_ANGLE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.sources.least_jerk import Bounds, Least, LowerLimit
    from kin.law.sources.tabled import Tabled

_LEAST_ROWS = 3  # of a run that may be a dwell
_LEAST_SHARE = 1.0 / 36.0  # of the motion that such a run takes: 10 degrees of a turn
_MOST_RUNS = 24  # the longest runs
_INNER = 0.25  # of a run: the shortest dwell
_PEAK = 1.1  # times the peak acceleration without dwells: the greatest beside a dwell
_SQUARE = 1.3  # times the mean square jerk without dwells, on either half of a stroke: likewise
_SMALL = 0.1  # of the peak acceleration: with less a motion may as well rest
_LOOKS = 49  # places in a run at which the acceleration is looked at
_STEP = 0.02  # of a run: the least first step of an end
_FASTER = 1.5  # factor from one step to the next


class Run(NamedTuple):
    """Equal rows from angle `begin` to `end`, rad, perhaps beyond the turn, at `level`, mm or rad.

    `step`, rad, is the mean angle from row to row; a run without width has 0. A free end is one without a level.
    """

    begin: float
    end: float
    level: float | None
    step: float

    @property
    def limit(self) -> float:
        """Greatest angle, rad, by which each end of the run may be moved in."""
        return 0.5 * (1.0 - _INNER) * (self.end - self.begin)

    def later(self, by: float) -> Run:
        """The run, `by` rad later."""
        return self._replace(begin=self.begin + by, end=self.end + by)


class MotionBetweenDwells(NamedTuple):
    """A motion from the end of one dwell, `begin`, to the beginning of the next, `end`, rad."""

    begin: float
    end: float
    least: Least


def runs(rows: Tabled, least_level: float | None) -> list[Run]:
    """Runs of three or more rows that are equal as written, over 10 degrees of a turn or more, rising; the 24 longest.

    The lowest run, if the motion is lowest there, gets the level `least_level`, mm or rad. A motion that ends has a run
    at each of its ends, of no width without equal rows.
    """
    x, s, rest = rows.x, rows.s, rows.space.rest or (None, None)
    if rest[0] is not None:
        x, s = np.insert(x, 0, rows.space.begin), np.insert(s, 0, rest[0])
    if rest[1] is not None:
        x, s = np.append(x, rows.space.end), np.append(s, rest[1])
    # edges of the runs of rows that are equal to the next one, from a row on that is not
    n = len(x)
    same = np.append(np.diff(s) == 0.0, bool(rows.period and s[-1] == s[0]))
    if same.all():
        return []
    start = int(np.argmin(same)) + 1 if rows.period else 0
    edges = np.diff(np.concatenate([[0], same[(start + np.arange(n)) % n].astype(int), [0]]))
    least_width = _LEAST_SHARE * (rows.space.end - rows.space.begin) - SAME_ANGLE
    level_runs: list[Run] = []
    for a, b in zip(start + np.flatnonzero(edges == 1), start + np.flatnonzero(edges == -1), strict=True):
        begin, end = (float(x[i % n]) + rows.period * (i // n) for i in (int(a), int(b)))
        level = float(s[a % n])
        if b - a + 1 >= _LEAST_ROWS and end - begin >= least_width:
            level_runs.append(Run(begin, end, level, (end - begin) / int(b - a)))
    level_runs = sorted(sorted(level_runs, key=lambda run: run.begin - run.end)[:_MOST_RUNS])
    if least_level is not None and level_runs:
        lowest = min(run.level for run in level_runs if run.level is not None)
        level_runs = [run._replace(level=least_level) if run.level == lowest == s.min() else run for run in level_runs]
    # an end is a run, if of no width
    if rows.space.rest:
        if not level_runs or level_runs[0].begin > rows.space.begin:
            level_runs.insert(0, Run(rows.space.begin, rows.space.begin, rest[0], 0.0))
        if level_runs[-1].end < rows.space.end:
            level_runs.append(Run(rows.space.end, rows.space.end, rest[1], 0.0))
    return level_runs


def stretches(
    rows: Tabled, dwells: Sequence[Run], plain: Least, bounds: Bounds, limit: LowerLimit | None
) -> tuple[list[Run], list[MotionBetweenDwells]]:
    """Runs that are dwells, their ends moved in, and the motions between them; [], [] for no dwell.

    `dwells` are the runs; `plain` is the motion without dwells within the same bounds. Raises UnsolvedError where
    rounding stands in the way of a motion, CrowdedError where it touches too many bounds to be found in seconds.
    """
    kept = list(dwells)
    while kept:
        following = [*kept[1:], kept[0].later(rows.period)] if rows.period else kept[1:]
        between: list[MotionBetweenDwells] = []
        for i, after in enumerate(following):
            stretch, spoilt = _stretch(rows, (kept[i], after), plain, bounds, limit)
            if stretch is None:
                _leave_out(kept, (i + spoilt) % len(kept), rows.space)
                break
            between.append(stretch)
        else:
            return _between_stretches(kept, between, rows.period), between
    return [], []


def _leave_out(kept: list[Run], which: int, space: FunctionSpace) -> None:
    """Drop a run that is no dwell; at an end of the motion it becomes a run without width."""
    run = kept[which]
    if space.rest is not None and which in {0, len(kept) - 1}:
        end, level = (run.end, space.rest[1]) if which else (run.begin, space.rest[0])
        kept[which] = run._replace(begin=end, end=end, level=level)
    else:
        kept.pop(which)


def _between_stretches(kept: Sequence[Run], between: Sequence[MotionBetweenDwells], period: float) -> list[Run]:
    """Runs that begin where the stretch before them ends, and end where the next one begins."""
    moved = []
    for i, run in enumerate(kept):
        begin, end = run.begin, run.end
        if period or i > 0:
            begin = between[i - 1].end - (period if i == 0 else 0.0)
        if i < len(between):
            end = between[i].begin
        moved.append(run._replace(begin=begin, end=end))
    return moved


def _stretch(
    rows: Tabled, pair: tuple[Run, Run], plain: Least, bounds: Bounds, limit: LowerLimit | None
) -> tuple[MotionBetweenDwells | None, int]:
    """The motion between two runs and 0; or None, and the index, 0 or 1, of the run that is no dwell.

    The ends of both runs are moved in until the motion between them is about as calm as the motion without dwells,
    `plain`.
    """
    before, after = pair
    middle = 0.5 * (before.end + after.begin)
    plain_peaks = (
        plain.curve.peak(before.end - before.limit, middle),
        plain.curve.peak(middle, after.begin + after.limit),
    )
    most_moved = before.limit, after.limit
    moved = [_quiet(plain, run, way, small) for run, way, small in zip(pair, (-1, 1), plain_peaks, strict=True)]
    steps = [max(0.5 * run.step, _STEP * (run.end - run.begin)) for run in pair]
    touch = plain.touch
    # a side is wild while the motion is rougher there than `plain`, or cannot be found; its end is moved in further
    while True:
        begin, end = before.end - moved[0], after.begin + moved[1]
        free = [run.begin for run in pair if run.level is None]
        ends = (end_jerk for end_jerk in rows.space.ends if end_jerk.at in free)
        shorter = tuple(jerk._replace(width=min(jerk.width, end - begin)) for jerk in ends)
        space = FunctionSpace(begin, end, (before.level, after.level), shorter)
        try:
            moving = least(space, rows.between(bounds, space), touch, limit)
        except UnsolvedError:
            moving = None
        if moving is not None:
            touch = moving.touch
            peaks = moving.curve.peak(begin, middle), moving.curve.peak(middle, end)
            squares = moving.curve.square(begin, middle), moving.curve.square(middle, end)
            plain_squares = plain.curve.square(begin, middle), plain.curve.square(middle, end)
            wild = [
                side
                for side in (0, 1)
                if most_moved[side] > 0.0
                and (peaks[side] > _PEAK * plain_peaks[side] or squares[side] > _SQUARE * plain_squares[side])
            ]
            if not wild:
                return MotionBetweenDwells(begin, end, moving), 0
        else:
            wild = [side for side in (0, 1) if most_moved[side] > 0.0]
        for side in wild:
            if moved[side] >= most_moved[side]:
                return None, side
            moved[side] = min(most_moved[side], moved[side] + steps[side])
            steps[side] *= _FASTER
        if not wild:
            raise UnsolvedError


def _quiet(plain: Least, run: Run, way: int, peak: float) -> float:
    """Angle, rad, from an end of a run to where the motion without dwells has little acceleration; at most the limit.

    `way` is -1 at the end of the run, 1 at its beginning; `peak` is the acceleration to compare with.
    """
    shares = np.linspace(0.0, run.limit, _LOOKS)
    edge = run.end if way < 0 else run.begin
    quiet = np.abs(plain.curve(edge + way * shares, 2)) <= _SMALL * peak
    return float(shares[int(np.argmax(quiet))]) if quiet.any() else run.limit
