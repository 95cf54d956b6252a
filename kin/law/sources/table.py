"""A motion from a table: the quintic spline of fewest equal spans that stays within the reading error."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.programme import IntentError
from kin.law.sources.ring import SAME_ANGLE, Dwelling, Samples, demand_whole, laid, merged
from kin.law.sources.spline import Ends, nearest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Stretch
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array


_LEAST_ROWS = 8
_MOST_SPANS = 1000
_GAP = 1.5  # of the median of the five steps about it
_LEAST_DWELL = math.radians(10)  # equal rows over less than that may be the top of a nose, rounded
_ONE_BY_ONE = 300_000  # rows times counts that are tried one after another; beyond that the next to hold is halved
_LEAPS = 1.3  # from one count to the next where each is dear
_FOOT, _ANKLE = 3.0, 60.0  # readings above a dwell between which the motion's foot is looked for
_ISOLATED = 20  # times the median of the fourth differences


class TableError(IntentError):
    """A table that is no motion; `line` is the line of the file at fault."""

    def __init__(self, message: str, field: str, line: int, at: float | None = None) -> None:
        super().__init__(f"line {line}: {message}", field, at)
        self.line = line


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
    a table ends before the turn does, at the displacement it began with, the rest is a dwell; so are rows that are
    equal over 10 degrees, or, where `dwells` (rad) are given, those. A dwell is exact, and S' = S'' = 0 at its ends.

    TableError, with the line, for angles that do not rise, gaps, steps, rows that scatter by more than the reading.
    """
    _demand_rows(rows, total, field)
    if not (math.isfinite(reading) and reading > 0):
        raise IntentError(f"the reading error must be above 0, not {reading:.6g}", f"{field}.reading")
    rows, event = _one_turn(rows, total, around, reading, field)
    demand_whole(rows, total, around, field)
    task = _Task(rows, reading, total, around)
    found = _found(task) if dwells is None else _given(task, dwells, field)
    if event is not None:
        found = merged(sorted([*found, event]), len(rows.s))
    _demand_even(rows, found, field)
    smoother = _Smoother(reading, spans, field)
    if around == -1:
        smoother.step, smoother.image = 2, (total, float(rows.s[0] + rows.s[-1]))
    motion = laid(rows, found, total, around, smoother)
    return Smoothed(motion, smoother.count, smoother.residual, smoother.line)


class _Task(NamedTuple):
    """Rows to smooth, how closely, over which angle."""

    rows: Samples
    reading: float
    total: float
    around: int | None


def _demand_rows(rows: Samples, total: float, field: str) -> None:
    if len(rows.theta) < _LEAST_ROWS:
        raise IntentError(f"a table has at least {_LEAST_ROWS} rows, not {len(rows.theta)}", field)
    for column, what in ((rows.theta, "the angle"), (rows.s, "the displacement")):
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
        raise TableError(f"the table covers more than {math.degrees(total):.6g} degrees", field, int(rows.lines[i]))


def _one_turn(
    rows: Samples, total: float, around: int | None, reading: float, field: str
) -> tuple[Samples, Dwelling | None]:
    """Rows of a repeating motion without a closing one; and the dwell that the table leaves out."""
    if around != 1:
        return rows, None
    over, step = float(rows.theta[-1] - rows.theta[0]), float(np.median(np.diff(rows.theta)))
    apart, line = abs(float(rows.s[-1] - rows.s[0])), int(rows.lines[-1])
    if over > total - SAME_ANGLE:
        if apart > 2 * reading:
            problem = f"the motion does not close: {apart / rows.unit:.6g} off the first row, a turn later"
            raise TableError(f"{problem}; give this row the displacement of the first one", field, line)
        return rows.part(slice(None, -1)), None
    if total - over <= _GAP * step:
        return rows, None
    if apart > 2 * reading:
        raise TableError(
            f"the table ends after {math.degrees(over):.6g} degrees, {apart / rows.unit:.6g} off its first row: "
            "the rest of the turn can be no dwell; add the rows that are missing",
            field,
            line,
        )
    n = len(rows.s)
    return rows, Dwelling(n - 1, n, 0.5 * float(rows.s[0] + rows.s[-1]))


def _found(task: _Task) -> list[Dwelling]:
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


def _foot(task: _Task, end: int, way: int, middle: int) -> int:
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


def _given(task: _Task, dwells: Sequence[tuple[float, float]], field: str) -> list[Dwelling]:
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
            raise TableError(f"the row is not part of a dwell at {float(np.median(s)) / rows.unit:.6g}", field, line)
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


@dataclass
class _Smoother:
    """Least squares with the fewest spans, a multiple of `step`; keeps their count and the worst row.

    Of rows that are laid a second time, upside down, `image` has the angle of the half and what the two add up to.
    """

    reading: float
    spans: int | None
    field: str
    step: int = 1
    count: int = 0
    residual: float = 0.0
    line: int = 0
    image: tuple[float, float] | None = None

    def __call__(
        self, rows: Samples, ends: Ends | None, between: tuple[float, float], /
    ) -> tuple[Array, Sequence[Stretch]]:
        inside = rows if ends is None else rows.part(slice(1, -1))
        step = self.step if ends is None else 1
        count = self.spans or self._fewest(inside, ends, between, step)
        basis, coefficients, off = nearest(inside.theta, inside.s, count, ends, between)
        worst = int(np.argmax(np.abs(off))) if len(off) else 0
        if len(off) and abs(off[worst]) > self.residual:
            self.residual, self.line = float(abs(off[worst])), int(inside.lines[worst])
        self.count += count
        return basis.sites, basis.spans(coefficients)

    def _fewest(self, rows: Samples, ends: Ends | None, between: tuple[float, float], step: int) -> int:
        most = max(1, min(len(rows.s) // 2, _MOST_SPANS) // step)

        def holds(count: int) -> bool:
            off = nearest(rows.theta, rows.s, count * step, ends, between)[2]
            return bool(np.abs(off).max(initial=0.0) <= self.reading * (1 + 1e-9))

        low = min(most, max(8, _ONE_BY_ONE // max(1, len(rows.s))))
        for count in range(1, low + 1):
            if holds(count):
                return count * step
        while low < most:
            high = min(most, math.ceil(low * _LEAPS))
            if not holds(high):
                low = high
                continue
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (low, middle) if holds(middle) else (middle, high)
            return high * step
        raise self._fault(rows, nearest(rows.theta, rows.s, most * step, ends, between)[2])

    def _fault(self, rows: Samples, off: Array) -> TableError:
        """Say why no spline stays within the reading: a row that stands out, a step, or scatter."""
        s = rows.s
        fourth = np.abs(np.diff(s, 4)) if len(s) > 4 else np.zeros(1)
        peak, usual = int(np.argmax(fourth)), float(np.median(fourth))
        reached = float(np.abs(off).max())
        if len(s) > 8 and fourth[peak] > _ISOLATED * max(usual, self.reading / 4):
            return self._single(rows, peak + 2)
        worst = int(np.argmax(np.abs(off)))
        return TableError(
            f"the rows scatter about any smooth curve: the closest one is {reached / rows.unit:.3g} off here, the "
            f"reading error is {self.reading / rows.unit:.6g}, both in the table's unit; smooth the table, or give a "
            "reading error above that",
            self.field,
            int(rows.lines[worst]),
        )

    def _written(self, theta: float, s: float) -> float:
        """A displacement on the side of the motion on which the table has it."""
        if self.image is None:
            return s
        half, total = self.image
        return total - s if theta % (2 * half) >= half - SAME_ANGLE else s

    def _single(self, rows: Samples, i: int) -> TableError:
        """Say which row stands out, or where the table steps, near row i."""
        s = rows.s

        def there(k: int, value: float) -> float:
            return self._written(float(rows.theta[k]), float(value)) / rows.unit

        near = range(max(i - 2, 2), min(i + 3, len(s) - 2))
        expected = {k: (4 * (s[k - 1] + s[k + 1]) - s[k - 2] - s[k + 2]) / 6 for k in near}
        left = {}
        for k in near:
            mended = s[max(k - 6, 0) : k + 7].copy()
            mended[k - max(k - 6, 0)] = expected[k]
            left[k] = float(np.abs(np.diff(mended, 4)).max())
        best = min(left, key=lambda k: left[k])
        whole = float(np.abs(np.diff(s[max(best - 6, 0) : best + 7], 4)).max())
        if left[best] < 0.2 * whole:
            return TableError(
                f"the row does not lie on a smooth curve with its neighbours: it is {there(best, s[best]):.7g}, about "
                f"{there(best, expected[best]):.7g} is expected",
                self.field,
                int(rows.lines[best]),
            )
        step = np.diff(s)
        local = np.arange(max(i - 3, 1), min(i + 3, len(step) - 1))
        jump = step[local] - 0.5 * (step[local - 1] + step[local + 1])
        k = int(local[np.argmax(np.abs(jump))]) + 1
        return TableError(
            f"the displacement steps from {there(k - 1, s[k - 1]):.7g} to {there(k, s[k]):.7g} here",
            self.field,
            int(rows.lines[k]),
        )
