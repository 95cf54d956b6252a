"""A motion from a table: the quintic spline of fewest equal spans that stays within the reading error."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from kin.law.programme import IntentError
from kin.law.sources.ring import SAME_ANGLE, Dwelling, Samples, demand_whole, merged
from kin.law.sources.smoothing import Bounded, EqualSpans, TableError, Task, UnmetError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.law.sources.motion import Motion


_LEAST_ROWS = 8
_LEAST_LOADS = 2
_GAP = 1.5  # of the median of the five steps about it
_LEAST_DWELL = math.radians(10)  # equal rows over less than that may be the top of a nose, rounded
_FOOT, _ANKLE = 3.0, 60.0  # readings above a dwell between which the motion's foot is looked for
_TRIALS, _RAISED = 8, 1.3  # of the reading error that a refused table would need
_LEVELLED = 3  # times that a motion is made again, 0 where the last one was lowest
_ENDS = 2  # rows at each end of a dwell between which it may end


@dataclass(frozen=True)
class Smoothed:
    """A motion from a table, how many spans it took, and its greatest distance from the rows, with that row's line."""

    motion: Motion
    spans: int
    residual: float
    line: int


def from_table(
    rows: Samples,
    reading: float,
    total: float = 2 * math.pi,
    *,
    around: int | None = 1,
    dwells: Sequence[tuple[float, float]] | None = None,
    spans: int | None = None,
    field: str = "motion.table",
) -> Smoothed:
    """Smooth rows of a table within `reading`, the bound of |S - table| at every row.

    Between dwells runs the least-squares C4 quintic spline of fewest equal spans that does it, or of `spans`. Where
    that takes a span for less than four rows, joints are looked for at which the acceleration or the jerk jumps, and
    the spline is one that keeps the reading if any over equal spans between them does. The rows bound the motion less
    its least value (`around` 1) or its first (-1), where that is 0 within twice the reading.

    Where a table ends before the turn does, at the displacement it began with, the rest is a dwell; so are rows that
    are equal over 10 degrees, or, where `dwells` (rad) are given, those. A dwell is exact, and S' = 0 at its ends.

    TableError, with the line, for angles that do not rise, gaps, steps, rows that scatter by more than the reading.
    """
    _demand_rows(rows, total, field)
    if not (math.isfinite(reading) and reading > 0):
        raise IntentError(f"the reading error must be above 0, not {reading:.6g}", f"{field}.reading")
    rows, event = _one_turn(rows, Task(rows, reading, total, around), field)
    demand_whole(rows, total, around, field)
    if around is None and abs(rows.s[0]) <= reading:
        rows = rows._replace(s=np.append(0.0, rows.s[1:]))  # where the motion begins
    task = Task(rows, reading, total, around)

    def equal(task: Task) -> tuple[list[Dwelling], EqualSpans, Motion, bool]:
        found = _found(task) if dwells is None else _given(task, dwells, field)
        if event is not None:
            found = merged(sorted([*found, event]), len(rows.s))
        _demand_even(rows, found, field)
        fit = EqualSpans(task, spans, field)
        motion = fit.laid(found)
        return found, fit, motion, fit.residual <= task.reading * (1 + 1e-9) and task.keeps(motion)

    found, fit, motion, kept = equal(task)
    if spans is not None or kept:
        return Smoothed(motion, fit.count, fit.residual, fit.line)
    bounded = Bounded(task, field, fit.faults)
    if dwells is None:
        found = _shortened(found, len(rows.s), around)
    try:
        motion = bounded.laid(found)
        for _ in range(_LEVELLED):
            if not task.keeps(motion):
                lowest = task.lowest(motion)
                motion = bounded.laid([lowest.levelled(dwell, reading) for dwell in found], lowest)
        bounded.demand_supported(motion)
    except UnmetError as error:
        raise TableError(error.problem + _remedy(task, fit.residual, equal), field, error.line) from None
    return Smoothed(motion, bounded.count, bounded.residual, bounded.line)


def _remedy(
    task: Task, reached: float, equal: Callable[[Task], tuple[Sequence[Dwelling], EqualSpans, Motion, bool]]
) -> str:
    """A reading error with which the table is smoothed, tried."""
    for k in range(_TRIALS):
        reading = max(reached, task.reading) * _RAISED**k / task.rows.unit
        digit = 10.0 ** (math.floor(math.log10(reading)) - 1)
        trial = task._replace(reading=math.ceil(reading / digit) * digit * task.rows.unit)
        try:
            if equal(trial)[-1]:
                return f"; mend it, or give reading: {task.tell(trial.reading)}, which a motion keeps"
        except TableError:
            continue
    return "; mend it, or give a greater reading"


def _shortened(dwells: Sequence[Dwelling], count: int, around: int | None) -> list[Dwelling]:
    """Dwells without the rows at their ends: where between them one ends is found from the motion beside it.

    None that stands beside a stretch of few rows: with those added it could be anything.
    """
    shorter = []
    for i, dwell in enumerate(dwells):
        before, after = dwells[i - 1], dwells[(i + 1) % len(dwells)]
        beside = dwell.first - before.last, after.first - dwell.last
        least = min(number % count if around == 1 else abs(number) for number in beside) if len(dwells) > 1 else count
        less = min(_ENDS, (dwell.last - dwell.first) // 3) if least > _LEAST_ROWS else 0
        shorter.append(Dwelling(dwell.first + less, dwell.last - less, dwell.level))
    return shorter


def periodic(rows: Samples, total: float, field: str, unit: str) -> Samples:
    """Rows of a load that repeats itself after `total` rad, without one that closes it; `unit` is for messages.

    TableError, with the line, for angles that do not rise, for a last row a turn later that is not the first one's
    again, and where more is left out behind the last row than between any two, and the ends differ.
    """
    _demand_rows(rows, total, field, _LEAST_LOADS, "load")
    over, line = float(rows.theta[-1] - rows.theta[0]), int(rows.lines[-1])
    first, last = float(rows.s[0]), float(rows.s[-1])
    closed = over > total - SAME_ANGLE
    if first != last and closed:
        what = f"the load does not close: {last:.6g} {unit} here, {first:.6g} {unit} in the first row, a turn earlier"
        raise TableError(f"{what}; give this row the load of the first one", field, line)
    if first != last and total - over > _GAP * float(np.diff(rows.theta).max()):
        what = (
            f"the table ends after {math.degrees(over):.6g} degrees with {last:.6g} {unit}, and begins with {first:.6g}"
        )
        raise TableError(f"{what} {unit}; add the rows of the rest of the turn", field, line)
    return rows.part(slice(None, -1)) if closed else rows


def _demand_rows(
    rows: Samples, total: float, field: str, least: int = _LEAST_ROWS, quantity: str = "displacement"
) -> None:
    if len(rows.theta) < least:
        raise IntentError(f"a table has at least {least} rows, not {len(rows.theta)}", field)
    for column, what in ((rows.theta, "the angle"), (rows.s, f"the {quantity}")):
        bad = np.flatnonzero(~np.isfinite(column))
        if len(bad):
            raise TableError(f"{what} is not finite", field, int(rows.lines[bad[0]]))
    falls = np.flatnonzero(np.diff(rows.theta) <= SAME_ANGLE)
    if len(falls):
        i = int(falls[0]) + 1
        before, here = np.degrees(rows.theta[i - 1 : i + 1])
        word = "stands twice" if here == before else f"follows {before:.9g}"
        raise TableError(f"the angles must rise; {here:.9g} {word}", field, int(rows.lines[i]))
    over = float(rows.theta[-1] - rows.theta[0])
    if over > total + SAME_ANGLE:
        i = int(np.argmax(rows.theta - rows.theta[0] > total + SAME_ANGLE))
        crank = quantity == "displacement" and over <= 2.0 * total + SAME_ANGLE
        remedy = "; give angle: crank if its angles are the crank's" if crank else ""
        covered = f"the table covers more than {math.degrees(total):.6g} degrees{remedy}"
        raise TableError(covered, field, int(rows.lines[i]))


def _one_turn(rows: Samples, task: Task, field: str) -> tuple[Samples, Dwelling | None]:
    """Rows of a repeating motion without a closing one; and the dwell that the table leaves out."""
    total, reading = task.total, task.reading
    if task.around != 1:
        return rows, None
    over, step = float(rows.theta[-1] - rows.theta[0]), float(np.median(np.diff(rows.theta)))
    apart, line = abs(float(rows.s[-1] - rows.s[0])), int(rows.lines[-1])
    if over > total - SAME_ANGLE:
        if apart > 2 * reading:
            problem = f"the motion does not close: {task.tell(apart)} off the first row, a turn later"
            raise TableError(f"{problem}; give this row the displacement of the first one", field, line)
        return rows.part(slice(None, -1)), None
    if total - over <= _GAP * step:
        return rows, None
    if apart > 2 * reading:
        raise TableError(
            f"the table ends after {math.degrees(over):.6g} degrees, {task.tell(apart)} off its first row: the rest of "
            "the turn can be no dwell; add the rows that are missing",
            field,
            line,
        )
    n = len(rows.s)
    return rows, Dwelling(n - 1, n, 0.5 * float(rows.s[0] + rows.s[-1]))


def _found(task: Task) -> list[Dwelling]:
    """Dwells where rows are equal over 10 degrees and more."""
    rows, total, around = task.rows, task.total, task.around
    n = len(rows.s)
    whole = around == 1 and rows.theta[0] + total - rows.theta[-1] <= _GAP * float(np.median(np.diff(rows.theta)))
    same = np.append(np.diff(rows.s) == 0, bool(whole and rows.s[0] == rows.s[-1]))
    if same.all():
        return []
    first = int(np.argmin(same)) + 1  # after a step that is none: no run is cut
    index = np.arange(first, first + n)
    edges = np.diff(np.concatenate([[0], same[index % n].astype(int), [0]]))
    found = []
    for a, b in zip(index[0] + np.flatnonzero(edges == 1), index[0] + np.flatnonzero(edges == -1), strict=True):
        begin = rows.theta[a % n] + total * (a // n)
        end = rows.theta[b % n] + total * (b // n)
        if end - begin >= _LEAST_DWELL - SAME_ANGLE:
            turns, middle = int(a) // n, (int(a) + int(b)) // 2
            leave = _foot(task, int(b), 1, middle)
            reach = _foot(task, int(a), -1, middle)
            found.append(Dwelling(reach - turns * n, leave - turns * n, float(rows.s[a % n])))
    return sorted(found)


def _foot(task: Task, end: int, way: int, middle: int) -> int:
    """Row at which the motion leaves a dwell, on the side `way` of its last equal row.

    Rounded rows stay equal for a while after the motion has begun. It begins as a cube, so the cube roots of the first
    displacements lead back to its foot.
    """
    rows, reading, total = task.rows, task.reading, task.total
    n = len(rows.s)
    index = end + way * np.arange(1, n // 2)
    if task.around != 1:
        index = index[(index >= 0) & (index < n)]
    climb = np.abs(rows.s[index % n] - rows.s[end % n])
    chosen = np.flatnonzero(climb >= _FOOT * reading)[:2]
    if len(chosen) < 2:
        return end
    last = int(np.argmax(climb > _ANKLE * reading)) if (climb > _ANKLE * reading).any() else len(climb)
    chosen = np.arange(chosen[0], max(last, chosen[-1] + 1))
    angle = rows.theta[index % n] + total * (index // n)
    root, at = np.cbrt(climb[chosen]), angle[chosen]
    spread = root - root.mean()
    if not np.ptp(root) > 1e-3 * root.max():  # it leaves by a step
        return end
    foot = float(at.mean() - root.mean() * (spread @ at) / (spread @ spread))
    inside = np.arange(end, middle, -way)
    if not len(inside):
        return end
    apart = np.abs(rows.theta[inside % n] + total * (inside // n) - foot)
    return int(inside[int(np.argmin(apart))])


def _given(task: Task, dwells: Sequence[tuple[float, float]], field: str) -> list[Dwelling]:
    """Dwells from a row to a row at given angles; the rows between must be within the reading of their mean."""
    rows, reading, total, around = task.rows, task.reading, task.total, task.around
    n, found = len(rows.s), []
    for begin, end in dwells:
        ends = []
        for angle in (begin, end):
            turns = math.floor((angle - rows.theta[0] + SAME_ANGLE) / total) if around == 1 else 0
            i = int(np.argmin(np.abs(rows.theta - (angle - turns * total))))
            ends.append(i + turns * n)
        index = np.arange(ends[0], ends[1] + 1)
        if len(index) < 2:
            at = [math.degrees(angle) for angle in (begin, end)]
            raise IntentError(f"no two rows lie between {at[0]:.6g} and {at[1]:.6g} degrees", field)
        s = rows.s[index % n]
        level = float(0.5 * (s.min() + s.max()))
        if s.max() - s.min() > 2 * reading:
            line = int(rows.lines[index[int(np.argmax(np.abs(s - np.median(s))))] % n])
            raise TableError(f"the row is not part of a dwell at {task.tell(float(np.median(s)))}", field, line)
        turns = ends[0] // n
        found.append(Dwelling(ends[0] - turns * n, ends[1] - turns * n, level))
    return sorted(found)


def _demand_even(rows: Samples, dwells: Sequence[Dwelling], field: str) -> None:
    """Refuse a step of the angle that is much longer than those about it, outside dwells."""
    step = np.diff(rows.theta)
    padded = np.concatenate([step[2:0:-1], step, step[-2:-4:-1]])
    about = np.median(np.stack([padded[i : i + len(step)] for i in range(5)]), axis=0)
    wide = step > _GAP * about
    n = len(rows.theta)
    for dwell in dwells:
        wide[np.arange(dwell.first, dwell.last) % n % len(step)] = False
    if wide.any():
        i = int(np.argmax(wide)) + 1
        before, here = np.degrees(rows.theta[i - 1 : i + 1])
        raise TableError(
            f"rows are missing between {before:.6g} and {here:.6g} degrees; the steps beside it are "
            f"{math.degrees(about[i - 1]):.6g}",
            field,
            int(rows.lines[i]),
        )
