"""Splines within the reading error of a table's rows: by equal spans, or by sections between joints."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.law.programme import IntentError
from kin.law.segment import Constant
from kin.law.sources.closest import within
from kin.law.sources.peaks import extremes
from kin.law.sources.ring import SAME_ANGLE, Dwelling, Samples, laid
from kin.law.sources.sections import Sections, faded, sections_of
from kin.law.sources.spline import Basis, Ends, Fitting, nearest
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Stretch
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array

_MOST_SPANS = 1000
_UNITS = {1.0: " mm", 25.4: " in", math.radians(1.0): " deg"}  # as recipes may write them
_ONE_BY_ONE = 300_000  # rows times counts that are tried one after another; beyond that the next to hold is halved
_LEAPS = 1.3  # from one count to the next where each is dear
_PLAIN, _FEW = 4, 30  # rows a span, at least, and spans that are not many, where no joint is looked for
_ZERO = 2.0  # readings within which the least displacement of a table is meant to be 0
_PINNED = 0.01  # of the reading, within which the least value is then 0
_SCATTER, _MANY = 100.0, 60  # readings: 8 times the sixth differences of rows that err within the reading; of so many
_CLOSE = 400  # rows of a stretch, which more than these tell well enough with three to a span
_SPACINGS = (6, 4, 3)  # rows a span, where joints are looked for
_MOST_CHECKED = 1200  # rows of a stretch in which faults are looked for: work grows with their cube
_CHECKED = 3  # rows a span, of the spline with which faults are looked for
_BESIDE, _JOINTS = 2.1, 4  # rows to each side; joints beside a fault
_COLUMNS = 12  # jumps, steps and rows at most
_SURE = 0.8  # of what a fault explains, which a joint explains at least where it is taken instead
_CLEAR = 3.0
_FEW_ROWS = 8
_EDGE = 2
_PAD = 4  # rows of a dwell
_MENDED = 2.0  # readings, within which rows without a fault are met
_WINDOW = 8.0  # spans to each side over which a step is compared
_ROUND = 1e-9  # of the squares of a step: what the spline follows
_DIPS = 8  # times that a spline is made again, held up where it was below 0
_MORE = 1.2  # spans from one trial to the next
_WILD = 2.0  # of the acceleration that the rows allow
_LOOKS = 16  # places in a span where it is looked for
_ROUNDING = 1e-9  # of the reading


class TableError(IntentError):
    """A table that is no motion; `line` is the line of the file at fault."""

    def __init__(self, message: str, field: str, line: int, at: float | None = None) -> None:
        super().__init__(f"line {line}: {message}", field, at)
        self.line, self.problem = line, message


class UnmetError(TableError):
    """A table for which no motion within its reading was found."""


class Task(NamedTuple):
    """Rows to smooth, how closely, over which angle."""

    rows: Samples
    reading: float
    total: float
    around: int | None

    def tell(self, value: float, digits: int = 6) -> str:
        """A displacement in the table's own unit, as a message has it."""
        return f"{value / self.rows.unit:.{digits}g}{_UNITS.get(self.rows.unit, '')}"

    def tell_above(self, value: float) -> str:
        """A displacement above the reading, with as many digits, three at least, as show that it is."""
        unit, shown = self.rows.unit, float(f"{self.reading / self.rows.unit:.6g}")
        digits = next((k for k in range(3, 17) if float(f"{value / unit:.{k}g}") > shown), 17)
        return self.tell(value, digits)

    def keeps(self, motion: Motion) -> bool:
        """Whether the motion that is made of this one stays within the reading of every row."""
        base = motion.range[0] if self.around == 1 else 0.0
        if self.around is None or abs(base if self.around == 1 else float(self.rows.s[0])) > _ZERO * self.reading:
            return True  # the table is moved as a whole
        theta = np.mod(self.rows.theta, self.total) if self.around == 1 else self.rows.theta
        off = motion.derivatives(theta, 0)[0] - base - self.rows.s
        return bool(np.abs(off).max() <= self.reading * (1.0 + _ROUNDING))

    def lowest(self, motion: Motion) -> Lowest:
        """Where the displacement is to be 0, by a motion near enough."""
        if self.around == -1:
            return Lowest(0.0, None)
        if any(abs(rest.level) <= self.reading for rest in motion.rests):
            return Lowest(None, 0.0)
        return Lowest(extremes(motion.motion, 0)[1], 0.0)


class Lowest(NamedTuple):
    """Angle (rad) at which a motion is 0, where that is not in a dwell; and what it nowhere is below, if anything."""

    at: float | None
    floor: float | None

    def levelled(self, dwell: Dwelling, reading: float) -> Dwelling:
        """A dwell, at 0 if it is within the reading of that."""
        return dwell._replace(level=0.0) if self.floor is not None and abs(dwell.level) <= reading else dwell


@dataclass()
class EqualSpans:
    """Least squares with the fewest spans, or a given number; keeps their count and the worst row.

    Where they would take a span for less than four rows, there are so many.
    """

    task: Task
    spans: int | None
    field: str
    count: int = 0
    residual: float = 0.0
    line: int = 0
    faults: list[Fault] = dataclasses.field(default_factory=list)

    def laid(self, dwells: Sequence[Dwelling]) -> Motion:
        """The motion over the whole angle. TableError for rows without which it would keep the reading."""
        motion = laid(self.task.rows, dwells, self.task.total, self.task.around, self)
        proven = [fault for fault in self.faults if fault.proven]
        if proven:
            fault = min(proven, key=lambda fault: fault.line)
            raise TableError(fault.problem, self.field, fault.line)
        return motion

    def __call__(
        self, rows: Samples, ends: Ends | None, between: tuple[float, float], /
    ) -> tuple[Array, Sequence[Stretch]]:
        """Fit one stretch."""
        inside = rows if ends is None else rows.part(slice(1, -1))
        step = 2 if ends is None and self.task.around == -1 else 1
        count = self.spans or self._fewest(inside, ends, between, step)
        basis, coefficients, off = nearest(inside.theta, inside.s, count, ends, between)
        worst = int(np.argmax(np.abs(off))) if len(off) else 0
        if self.spans is None and (not len(off) or abs(off[worst]) > self.task.reading * (1 + _ROUNDING)):
            fault, mended = fault_of(self.task, rows, ends, between)
            if fault is not None and len(mended.s):
                left = nearest(mended.theta, mended.s, count, ends, between)[2]
                foot = (
                    ends is not None and fault.line in {*inside.lines[:2], *inside.lines[-2:]} and len(left) > _FEW_ROWS
                )
                fault = fault._replace(
                    proven=not foot and bool(np.abs(left).max() <= max(_MENDED * self.task.reading, 0.02 * fault.size))
                )
            self.faults += [fault] if fault else []
        if len(off) and abs(off[worst]) > self.residual:
            self.residual, self.line = float(abs(off[worst])), int(inside.lines[worst])
        self.count += count
        return basis.sites, basis.spans(coefficients)

    def _fewest(self, rows: Samples, ends: Ends | None, between: tuple[float, float], step: int) -> int:
        most = max(1, min(max(len(rows.s) // _PLAIN, min(_FEW, len(rows.s) // 2)), _MOST_SPANS) // step)

        def holds(count: int) -> bool:
            off = nearest(rows.theta, rows.s, count * step, ends, between)[2]
            return bool(np.abs(off).max(initial=0.0) <= self.task.reading * (1 + _ROUNDING))

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
        return most * step


class Fault(NamedTuple):
    """A row that stands out, or steps; `proven` if the motion keeps the reading without."""

    line: int
    problem: str
    size: float
    proven: bool = True


def fault_of(
    task: Task, rows: Samples, ends: Ends | None, between: tuple[float, float]
) -> tuple[Fault | None, Samples]:
    """The first row of a stretch that stands out, or steps from the one before; and the rows inside, mended.

    What a spline leaves is explained by jumps of the acceleration and the jerk, by steps and by single rows, one after
    another, each the one that explains most (orthogonal matching pursuit; Y. C. Pati et al., Asilomar 1993). There is a
    fault if without steps and single rows the spline would be _CLEAR times as far from the rows.
    """
    inside = rows if ends is None else rows.part(slice(1, -1))
    if len(rows.s) > _MOST_CHECKED:
        return None, inside
    if ends is not None and not len(inside.s):
        before, here = (_there(task, rows.theta[i], rows.s[i]) for i in (0, 1))
        step = Fault(int(rows.lines[1]), f"the displacement steps from {before} to {here} here", 0.0)
        return (step if abs(ends.end - ends.start) > 2.0 * task.reading else None), inside
    begin, end, real = between[0], between[1], np.arange(len(rows.s))
    if ends is not None:  # some rows of the dwells, in which the motion's foot may lie
        pad = np.arange(1, _PAD + 1) * float(np.median(np.diff(rows.theta)))
        begin, end, real = begin - pad[-1], end + pad[-1], real[1:-1] + _PAD
        rows = Samples(
            np.concatenate([between[0] - pad[::-1], rows.theta, between[1] + pad]),
            np.concatenate([np.full(_PAD, ends.start), rows.s, np.full(_PAD, ends.end)]),
            np.pad(rows.lines, _PAD),
            rows.unit,
        )
    x, s, n = rows.theta, rows.s, len(rows.s)
    count = max(1, n // _CHECKED)
    fitting = Fitting(Basis(np.linspace(begin, end, count + 1), ends is None), x, ends)
    steps = np.append(real[0] - 1, real)
    if ends is None:
        steps = steps[1:-1]
    mids = 0.5 * (x[steps] + x[steps + 1])
    places = np.concatenate([x[_EDGE:-_EDGE], 0.5 * (x[1:] + x[:-1])[_EDGE:-_EDGE]])
    period = between[1] - between[0] if ends is None else math.inf
    window = _WINDOW * (end - begin) / count
    columns = np.concatenate(
        [
            np.eye(n)[:, real],
            faded(x, mids, 0, window, period),
            *(faded(x, places, order, window, period) for order in (2, 3)),
        ],
        axis=1,
    )
    single, faults = len(real), len(real) + len(mids)  # of the columns
    base, _ = np.linalg.qr(fitting.matrix)
    first = s - fitting.values(fitting.nearest(s)), columns - base @ (base.T @ columns)
    least = _ROUND * (columns * columns).sum(axis=0)
    joint = 1.0 if len(real) >= _FEW_ROWS else 0.0
    kind = np.arange(columns.shape[1]) < faults

    def pursued(begun: Sequence[int], weight: Array, most: int) -> tuple[list[int], Array]:
        """Columns that explain the rows, after those that are given; and what is left."""
        chosen: list[int] = []
        off, rest = first
        while len(chosen) < most and (len(chosen) < len(begun) or np.abs(off).max() > task.reading):
            size = (rest * rest).sum(axis=0)
            score = weight * (off @ rest) ** 2 / np.where(size > least, size, np.inf)
            k = begun[len(chosen)] if len(chosen) < len(begun) else int(np.argmax(score))
            chosen.append(k)
            if size[k] > least[k]:
                toward = rest[:, k] / math.sqrt(size[k])
                off, rest = off - toward * (toward @ off), rest - toward[:, None] * (toward @ rest)
        return chosen, off

    chosen, off = pursued([], np.where(kind, _SURE, joint), min(_COLUMNS, n // 3 + 1))
    wrong = [k for k in chosen if kind[k]]
    joints = np.concatenate([base, columns[:, [k for k in chosen if not kind[k]]]], axis=1)
    known = s - fitting.values(np.where(np.isnan(fitting.fixed), 0.0, fitting.fixed))
    before = np.abs(known - joints @ np.linalg.lstsq(joints, known, rcond=None)[0]).max()
    if not wrong or before < _CLEAR * max(np.abs(off).max(), task.reading):
        return None, inside
    # a fault and joints may pass for two faults: of those about the first one, that which joints complete best
    place = np.concatenate([x[real], mids])
    beside = _BESIDE * float(np.median(np.diff(x)))
    far = [k for k in wrong if abs(place[k] - place[wrong[0]]) > beside]
    trials = [
        pursued([int(k), *far], np.where(kind, 0.0, joint), len(far) + 1 + _JOINTS)
        for k in np.flatnonzero(abs(place - place[wrong[0]]) <= beside)
    ]
    chosen, _ = min(trials, key=lambda trial: (len(trial[0]), trial[0][0] != wrong[0], float(trial[1] @ trial[1])))
    wrong = chosen[: len(far) + 1]
    rest = np.concatenate([columns[:, chosen], base], axis=1)
    jumps = np.linalg.lstsq(rest, known, rcond=None)[0][: len(wrong)]
    k, jump = wrong[0], jumps[0]
    if k < single:
        at = int(real[k])
        here, about = (_there(task, x[at], value) for value in (s[at], s[at] - jump))
        problem = f"the row does not lie on a smooth curve with its neighbours: it is {here}, about {about} is expected"
    else:
        at = int(steps[k - single]) + 1
        before, here = (_there(task, x[i], s[i]) for i in (at - 1, at))
        problem = f"the displacement steps from {before} to {here} here"
    kept = np.setdiff1d(real, real[[k for k in wrong if k < single]])
    s = s - sum(jump * columns[:, k] for k, jump in zip(wrong, jumps, strict=True) if k >= single)
    return Fault(int(rows.lines[at]), problem, abs(jump)), Samples(x[kept], s[kept], rows.lines[kept], rows.unit)


def _there(task: Task, angle: float, value: float) -> str:
    """A displacement on the side of the motion on which the table has it."""
    if task.around == -1 and angle % (2 * task.total) >= task.total - SAME_ANGLE:
        value = float(task.rows.s[0] + task.rows.s[-1]) - value
    return task.tell(float(value), 7)


@dataclass()
class Bounded:
    """Splines over sections, each row within its bounds; keeps the count of spans and the worst row."""

    task: Task
    field: str
    faults: Sequence[Fault] = ()
    count: int = 0
    residual: float = 0.0
    line: int = 0
    _lowest: Lowest | None = None
    _sections: dict[tuple[tuple[float, float], int], Sections] = dataclasses.field(default_factory=dict)
    _done: list[tuple[Samples, Basis, Array, Array]] = dataclasses.field(default_factory=list)

    def laid(self, dwells: Sequence[Dwelling], lowest: Lowest | None = None) -> Motion:
        """The motion over the whole angle; with `lowest` it is 0 there, within the hundredth of a reading."""
        self._lowest, self.count, self.residual, self._done = lowest, 0, 0.0, []
        return laid(self.task.rows, dwells, self.task.total, self.task.around, self)

    def __call__(
        self, rows: Samples, ends: Ends | None, between: tuple[float, float], /
    ) -> tuple[Array, Sequence[Stretch]]:
        """Fit one stretch."""
        inside = rows if ends is None else rows.part(slice(1, -1))
        basis, coefficients, off = self._imaged(inside, ends) or self._fitted(rows, inside, ends, between)
        self._done.append((inside, basis, coefficients, off))
        worst = int(np.argmax(np.abs(off))) if len(off) else 0
        if len(off) and abs(off[worst]) > self.residual:
            self.residual, self.line = float(abs(off[worst])), int(inside.lines[worst])
        places = basis.places.tolist()
        spans: list[Stretch] = [*basis.spans(coefficients)]
        self.count += len(spans)
        if ends is not None:  # it rests until it leaves
            if places[0] > between[0]:
                places, spans = [between[0], *places], [Constant(ends.start), *spans]
            if places[-1] < between[1]:
                places, spans = [*places, between[1]], [*spans, Constant(ends.end)]
        return np.array(places), spans

    def _imaged(self, inside: Samples, ends: Ends | None) -> tuple[Basis, Array, Array] | None:
        """What the same rows gave half a turn before, upside down."""
        if self.task.around != -1 or ends is None:
            return None
        s, half = self.task.rows.s, self.task.total
        whole = float(s[0] + s[-1])
        for rows, basis, coefficients, off in self._done:
            by = round(float(inside.theta[0] - rows.theta[0]) / half) * half if len(rows.s) == len(inside.s) else 0.0
            if (
                by
                and (np.abs(inside.theta - rows.theta - by) < SAME_ANGLE).all()
                and (np.abs(inside.s + rows.s - whole) < _ROUNDING * self.task.reading).all()
            ):
                return Basis(basis.sites + by, periodic=False), whole - coefficients, -off
        return None

    def _fitted(
        self, rows: Samples, inside: Samples, ends: Ends | None, between: tuple[float, float]
    ) -> tuple[Basis, Array, Array]:
        """The spline of fewest spans, of counts that grow by a fifth, that keeps every row within the reading."""
        smooth = Sections.of(between, ends, None if ends is None else _feet(rows, ends))
        most = max(1, min(len(inside.s) // 2, _MOST_SPANS))
        suspect = any(fault.line in inside.lines for fault in self.faults)  # so many spans could follow that row
        if len(inside.s) > _MANY and np.median(np.abs(np.diff(inside.s, 6))) > _SCATTER * self.task.reading:
            raise self._unmet(inside, nearest(inside.theta, inside.s, most, ends, between)[2])
        twin = self.task.total if self.task.around == -1 and ends is None else None
        # three rows a span at every spacing before two: jumps are looked for as joints before spans follow them
        shares = (2.0 / 3.0,) if suspect or len(inside.s) > _CLOSE else (2.0 / 3.0, 1.0, 2.0)
        for share in shares:
            for spacing in _SPACINGS:
                if (between, spacing) not in self._sections:
                    self._sections[between, spacing] = sections_of(inside, smooth, self.task.reading, spacing, twin)
                sections = replace(self._sections[between, spacing], ends=ends)  # levels may have been set to 0 since
                found = self._counted(inside, sections, int(most * share))
                if found is not None:
                    return found
        found = self._counted(inside, smooth, most)
        if found is not None:
            return found
        raise self._unmet(inside, nearest(inside.theta, inside.s, most, ends, between)[2])

    def _counted(self, rows: Samples, sections: Sections, most: int) -> tuple[Basis, Array, Array] | None:
        even, count = sections.ends is None and self.task.around == -1, 1
        while count <= most:
            found = self._held(rows, sections, count + (even and count % 2))
            if found is not None:
                return found
            count = max(count + 1, math.ceil(_MORE * count))
        return None

    def _held(self, rows: Samples, sections: Sections, count: int) -> tuple[Basis, Array, Array] | None:
        """A spline of `count` spans within the bounds, if there is one: basis, coefficients and what is left."""
        reading, n = self.task.reading, len(rows.s)
        fitting = sections.fitting(rows.theta, count)
        if self._lowest is None:
            try:
                coefficients = fitting.nearest(rows.s)
            except np.linalg.LinAlgError:
                return None
            off = rows.s - fitting.values(coefficients)
            if np.abs(off).max(initial=0.0) <= reading * (1.0 + _ROUNDING):
                return fitting.basis, coefficients, off
            if off @ off > n * reading**2:  # of any spline one row is farther off than this
                return None
        x, s = rows.theta, rows.s
        bounds = np.full(n, reading * (1.0 + 0.5 * _ROUNDING))
        if self._lowest is not None:
            bounds *= 1.0 - 2.0 * _PINNED
            x, s, bounds = self._pinned(sections, x, s, bounds)
        for _ in range(_DIPS):
            fitting = sections.fitting(x, count)
            closest = within(fitting, s, bounds)
            if closest is None:
                return None
            dips = self._dips(fitting.basis, closest)
            if not len(dips):
                return fitting.basis, closest, rows.s - fitting.values(closest)[:n]
            x, s = np.concatenate([x, dips]), np.concatenate([s, np.full(len(dips), reading)])
            bounds = np.concatenate([bounds, np.full(len(dips), reading)])
        return None

    def _pinned(self, sections: Sections, x: Array, s: Array, bounds: Array) -> tuple[Array, Array, Array]:
        """Rows and bounds, with one that holds the motion at 0 where it is lowest."""
        at = self._lowest.at if self._lowest is not None else None
        if at is None:
            return x, s, bounds
        level, (begin, end) = 0.0, sections.between
        rows, total = self.task.rows.s, self.task.total
        if self.task.around == -1:
            places = [(at + k * total, level if k % 2 == 0 else float(rows[0] + rows[-1]) - level) for k in range(4)]
        else:
            places = [(at + k * total, level) for k in range(-1, 3)]
        inside = [place for place in places if begin <= place[0] <= end]
        return (
            np.concatenate([x, [place[0] for place in inside]]),
            np.concatenate([s, [place[1] for place in inside]]),
            np.concatenate([bounds, np.full(len(inside), _PINNED * self.task.reading)]),
        )

    def _dips(self, basis: Basis, coefficients: Array) -> Array:
        """Angles at which the spline is lowest, where it goes below 0 by more than may be."""
        if self._lowest is None or self._lowest.floor is None:
            return np.empty(0)
        places = basis.places
        x = np.unique((places[:-1, None] + np.diff(places)[:, None] * (np.arange(_LOOKS) / _LOOKS)).ravel())
        values = Fitting(basis, x, None).values(coefficients)
        low = values < self._lowest.floor - _PINNED * self.task.reading
        lowest = (values <= np.roll(values, 1)) & (values <= np.roll(values, -1))
        return x[low & lowest]

    def _unmet(self, rows: Samples, off: Array) -> UnmetError:
        """Say how near the rows a spline of a span for two rows comes, and which of them is least like a motion's."""
        i = int(np.argmax(np.abs(off)))
        worst, reached = int(rows.lines[i]), float(abs(off[i]))
        line = min((fault.line for fault in self.faults if fault.line in rows.lines), default=worst)
        where, least = ("here", "") if line == worst else (f"at line {worst}", "; this row fits its neighbours least")
        nearest = f"the closest one is {self.task.tell_above(reached)} off {where}"
        if reached <= self.task.reading:
            nearest = "only one that bends at every other row is near enough"
        reading = self.task.tell(self.task.reading)
        problem = f"the rows scatter about any smooth curve: {nearest}, the reading error is {reading}{least}"
        return UnmetError(problem, self.field, line)

    def demand_supported(self, motion: Motion) -> None:
        """Refuse a motion that leaves the rows once its least value is off, or accelerates more than they allow."""
        rows, total = self.task.rows, self.task.total
        if not self.task.keeps(motion):
            problem = "no motion that begins at its least value keeps the reading of the rows; this row leaves it first"
            raise UnmetError(problem, self.field, self.line)
        suspect = min((fault.line for fault in self.faults), default=self.line)
        h = np.diff(rows.theta)
        most = np.abs(np.diff(np.diff(rows.s) / h)) + 2.0 * self.task.reading * (1.0 / h[1:] + 1.0 / h[:-1])
        most = (most / (0.5 * (h[1:] + h[:-1]))).max()
        reached = np.abs(motion.derivatives(np.linspace(0.0, total, _LOOKS * len(rows.s)), 2)[2]).max()
        if reached > _WILD * most:
            problem = f"a motion near the rows has {reached / most:.3g} times the acceleration that they support"
            raise UnmetError(problem, self.field, suspect)


def _feet(rows: Samples, ends: Ends) -> tuple[float, float]:
    """Where a stretch leaves and reaches the dwells beside it, whose last rows are its own first ones."""
    away = np.flatnonzero(rows.s != ends.start)
    back = np.flatnonzero(rows.s != ends.end)
    first = min(2, int(away[0]) - 1) if len(away) else 0
    last = min(2, len(rows.s) - 2 - int(back[-1])) if len(back) else 0
    return float(rows.theta[max(first, 0)]), float(rows.theta[len(rows.s) - 1 - max(last, 0)])
