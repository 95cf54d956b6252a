"""A motion from a table: that of least mean square jerk whose distance from each row is at most the row's reading."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from kin.law.programme import IntentError
from kin.law.segment import AffineStretch, Constant, Power
from kin.law.sources.dwells import runs, stretches
from kin.law.sources.least_jerk import Bounds, CrowdedError, LowerLimit, UnsolvedError, curve_through, least
from kin.law.sources.motion import Kept, Motion, TableRemark, joined
from kin.law.sources.ring import SAME_ANGLE, Samples, settled
from kin.law.sources.suspects import ladder, suspect
from kin.law.sources.tabled import BELOW, TableError, advised, demand_rows, tabled
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.law.segment import Stretch
    from kin.law.sources.dwells import MotionBetweenDwells as Moving
    from kin.law.sources.dwells import Run
    from kin.law.sources.least_jerk import Curve, FunctionSpace, Least
    from kin.law.sources.suspects import Suspect
    from kin.law.sources.tabled import Rest, Tabled

Suspects: TypeAlias = Literal["refuse", "keep"]

_LEAST_LOADS = 2
_GAP = 1.5  # of the widest step of a load
_ZERO = 2.0  # readings, within which the least value of a motion is meant to be 0
_SAME = 1e-6  # of a reading
_FAR = 0.01  # of the stroke: a distance of rows above that is remarked on
_PINS = 3  # times that a motion above its least level is brought down to it, where it was lowest
_TOUCHES = 1e-9  # of the stroke: by so much it may stay above
_CALM = 120  # knots of a smooth curve, from which the distances of rows that scatter are taken
_MOST_ADVISED = 0.25  # of the stroke: a reading above that leaves little of a motion
_ABOUT = 0.01  # of a reading: by so much the motion without dwells, which is but compared with, may be too low
_QUARTER = 0.25  # of the angle: rows that cover less were hardly meant to
_NEARLY = 1e-3  # of a last angle
_UNITS_BY_END = {2.0 * math.pi: "radians", 1.0: "turns", 100.0: "percent"}  # last angles, and of what they are


def from_table(
    rows: Samples,
    reading: float,
    total: float = 2 * math.pi,
    *,
    around: int | None = 1,
    rest: Rest | None = None,
    suspects: Suspects = "refuse",
    field: str = "motion.table",
) -> Motion:
    """The motion of least mean square jerk within `reading` of every row: a quintic spline, C4 but at dwells.

    With `around` 1 it repeats after `total` rad, and is nowhere below its least level; what the rows leave out of a
    turn is filled as `rest` has it. With -1 it goes on upside down, and with None it rests at both ends; both begin at
    0. Rows that are equal over 10 degrees are a dwell, exactly level on its inner part. How far the rows are from the
    motion, and what is to be remarked on them, is in its `kept`.

    Raises TableError, with the line, for rows that do not close within their readings, for doubled angles, and, where
    `suspects` are refused, for a row, or two, without which the mean square is less than half. Raises IntentError for
    many rows that scatter far beyond their readings.
    """
    if not (math.isfinite(reading) and reading > 0):
        raise IntentError(f"the reading error must be above 0, not {reading:.6g}", f"{field}.reading")
    layout = tabled(rows, reading, total, around, rest=rest, field=field)
    try:
        return _motion(layout, rows, reading, (total, around), suspects=suspects, field=field)
    except UnsolvedError:
        stroke = layout.tell(layout.stroke)
        problem = f"no motion was found within {layout.tell(reading)} of rows over {stroke}: rounding stands in the way"
        raise IntentError(f"{problem}; give a greater reading, or leave rows out", field) from None
    except CrowdedError:
        raise IntentError(_scatter_advice(layout, reading), field) from None


def _motion(
    layout: Tabled, rows: Samples, reading: float, over: tuple[float, int | None], *, suspects: Suspects, field: str
) -> Motion:
    total, around = over
    plain, raised = ladder(layout)
    if plain is None or not layout.stroke:
        _demand_stroke(layout, reading, field)
        level = float(0.5 * (layout.s.min() + layout.s.max())) if len(layout.s) else 0.0
        level = 0.0 if around != 1 or abs(level) <= reading else level
        return replace(joined([0.0, total], [Constant(level)], around), kept=Kept(0.0, 0, ()))
    remarks = []
    standing = suspect(layout, plain, noisy=raised is not None)
    if standing is not None:
        sentence = _standing(layout, standing)
        if standing.certain and suspects == "refuse":
            line = int(layout.lines[standing.rows[0]])
            raise TableError(f"{sentence}; mend it, or give suspect: keep", field, line)
        remarks.append(TableRemark("table-row", f"line {layout.lines[standing.rows[0]]}: {sentence}"))
    if raised is not None and (standing is None or not standing.certain):
        calm = advised(raised * reading, layout.unit)
        text = (
            f"with reading: {calm} the mean square of the jerk is a tenth: the rows scatter by more than their digits"
        )
        remarks.append(TableRemark("table-noise", text))
    remarks += _angles(rows, total)
    motion = _laid(layout, plain, total, around)
    theta = np.mod(rows.theta, total) if around == 1 else rows.theta
    off = np.abs(motion.derivatives(theta, 0)[0] - rows.s)
    distance = float(off.max())
    worst = int(np.argmax(off >= distance - _SAME * reading))  # the first of those that rounding alone tells apart
    if distance > _FAR * layout.stroke:
        share = 100.0 * distance / layout.stroke
        text = f"the motion leaves its rows by up to {layout.tell(distance, 3)}, {share:.2g} % of the stroke"
        remarks.append(TableRemark("table-distance", f"{text} (line {rows.lines[worst]})"))
    return replace(motion, kept=Kept(distance, int(rows.lines[worst]), tuple(remarks)))


def _laid(layout: Tabled, plain: Least, total: float, around: int | None) -> Motion:
    """The motion with its dwells over [0, total], 0 where the rows have it."""
    level = _least_level(layout, plain) if around == 1 else None
    limit = None if level is None else LowerLimit(level, BELOW * layout.stroke)
    bounds = layout.bounds(1.0, level)
    equal = runs(layout, level)
    for _ in range(_PINS):
        near = plain
        if limit is not None and equal:
            about = max(limit.tolerance, _ABOUT * float(layout.reading.min()))
            near = _solved(layout.space, bounds, plain, LowerLimit(limit.level, about))
        dwells, moving = stretches(layout, equal, near, bounds, limit)
        whole = near if dwells else _solved(layout.space, bounds, near, limit)
        if limit is None or any(run.level == level for run in dwells):
            break
        lows = [part.least.curve.lowest() for part in moving] or [whole.curve.lowest()]
        at, value = min(lows, key=lambda low: low[1])
        if value - limit.level <= _TOUCHES * layout.stroke:
            break
        place = bounds.x[:1] + np.mod(at - bounds.x[0], total)
        touched = Bounds(place, np.array([limit.level]), np.array([limit.level]), bounds.unit[:1], np.array([-1]))
        bounds = bounds.with_more(touched, total)
    if around is None:
        return joined(*_pieces(dwells, moving, 0.0), None).raised(-dwells[0].level)
    turn, curve = layout.period, whole.curve
    begin = curve.starts.tolist()
    knots, functions = _pieces(dwells, moving, turn) if dwells else ([*begin, begin[0] + turn], _functions(curve, 0.0))
    motion = settled(knots, functions, turn, total)
    return motion if around == 1 else Motion(motion.raised(-float(motion.at_start(0)[0])).motion, -1)


def _solved(space: FunctionSpace, bounds: Bounds, near: Least, limit: LowerLimit | None) -> Least:
    """The motion within bounds that is no constant."""
    solution = least(space, bounds, near.touch, limit)
    if solution is None:
        raise UnsolvedError
    return solution


def _least_level(layout: Tabled, plain: Least) -> float | None:
    """Lower limit of a motion over a turn, which it attains, mm or rad; None where the table sets none.

    A table that is lowest in a dwell has that level, or 0 where that is within its reading, as has any other table that
    is 0 within it. So has one whose motion is lowest at about 0, between two rows.
    """
    lowest = int(np.argmin(layout.s))
    level, reading = float(layout.s[lowest]), float(layout.reading[lowest])
    if abs(level) <= reading:
        return 0.0
    if any(run.level == level for run in runs(layout, None)):
        return level
    return 0.0 if level > 0.0 and abs(plain.curve.lowest()[1]) <= _ZERO * reading else None


def _pieces(dwells: Sequence[Run], moving: Sequence[Moving], turn: float) -> tuple[list[float], list[Stretch]]:
    """Knots and functions of dwells and of what is between them: round a turn, or from the first to the last one."""
    knots: list[float] = []
    functions: list[Stretch] = []
    for i, run in enumerate(dwells):
        if run.end > run.begin:
            knots.append(run.begin)
            functions.append(Constant(run.level))
        if i < len(moving):
            curve = moving[i].least.curve
            knots += curve.starts.tolist()
            functions += _functions(curve, dwells[(i + 1) % len(dwells)].level)
    return [*knots, dwells[0].begin + turn if turn else dwells[-1].end], functions


def _functions(curve: Curve, level: float) -> list[Stretch]:
    """Polynomials of a curve's spans as stretches.

    Before a rest at `level` the last one is expanded about its end, so that it is exactly at rest there.
    """
    rows, starts = curve.coefficients.T.tolist(), curve.starts.tolist()
    if not curve.period:
        *_, c3, c4, c5 = rows[-1]
        rows[-1] = [level, 0.0, 0.0, c3 + 4.0 * c4 + 10.0 * c5, c4 + 5.0 * c5, c5]
        starts[-1] += curve.widths[-1]
    spans = zip(rows, starts, curve.widths.tolist(), strict=True)
    return [AffineStretch(Power(tuple(row)), start=start, width=width) for row, start, width in spans]


def _demand_stroke(layout: Tabled, reading: float, field: str) -> None:
    """Refuse a reading within which nothing of a motion is left."""
    if layout.stroke > 1e-9 * float(np.abs(layout.s).max(initial=0.0)):
        small = f"the rows differ by {layout.tell(layout.stroke)} in all, less than their reading error leaves open"
        problem = f"{small}: {layout.tell(reading)} to either side"
        raise IntentError(f"{problem}; give reading: {advised(0.05 * layout.stroke, layout.unit)} or less", field)


def _scatter_advice(layout: Tabled, reading: float) -> str:
    """Say that rows scatter, and with what reading a smooth curve through means of successive rows would do."""
    count = len(layout.x)
    groups = np.array_split(np.arange(count), min(_CALM, count))
    x, s = (np.array([column[group].mean() for group in groups]) for column in (layout.x, layout.s))
    apart = float(layout.off(curve_through(layout.space, x, s)).max())
    problem = f"{count} rows scatter too far beyond their reading, {layout.tell(reading)}, for a motion to follow each"
    if apart > _MOST_ADVISED * layout.stroke:
        remedy = "see that the columns are those meant, or write means of successive rows"
        return f"{problem}, and lie about no smooth curve; {remedy}"
    return f"{problem}; give reading: {advised(apart, layout.unit)}, or fewer rows"


def _standing(layout: Tabled, standing: Suspect) -> str:
    """Say which rows stand out, and what is expected there."""
    (first, *more), (expected, *others) = standing.rows, standing.expected
    digits = 7
    sentence = f"the row stands out: it is {layout.tell(float(layout.s[first]), digits)}, about "
    sentence += layout.tell(expected, 4 if abs(expected) < layout.stroke else digits)
    for place, value in zip(more, others, strict=True):
        sentence += f", and line {layout.lines[place]} is {layout.tell(float(layout.s[place]), digits)}, about "
        sentence += layout.tell(value, 4)
    return f"{sentence} fits the others; without, the mean square of the jerk is {standing.falls:.3g} times less"


def _angles(rows: Samples, total: float) -> list[TableRemark]:
    """Where the angles are hardly degrees, or a part of the turn."""
    over = abs(float(rows.theta[-1] - rows.theta[0]))
    if over >= (1.0 - _NEARLY) * total:
        return []
    last = float(np.degrees(np.abs(rows.theta).max())) * rows.turned
    covered = f"the angles cover {math.degrees(over):.6g} degrees"
    unit = next((word for end, word in _UNITS_BY_END.items() if abs(last - end) <= _NEARLY * end), None)
    if unit is not None:
        return [TableRemark("table-angles", f"{covered} and end at {last:.6g}; give angle: {unit} if they are {unit}")]
    if over >= _QUARTER * total:
        return []
    rest = f"the rest of {math.degrees(total):.6g} is a dwell"
    return [TableRemark("table-angles", f"{covered}, {rest}; see that they are degrees of the cam")]


def straightened(rows: Samples, reading: float) -> Samples:
    """The rows without those that lie within `reading` of straight lines between the others.

    The cone of J. Sklansky and V. Gonzalez (Pattern Recognition 12, 1980): a line goes on while the rows passed let it.
    """
    x, s = rows.theta.tolist(), rows.s.tolist()
    kept, low, high = [0], -math.inf, math.inf
    for i in range(1, len(x)):
        begin = kept[-1]
        step = x[i] - x[begin]
        slope = (s[i] - s[begin]) / step
        if not low <= slope <= high:
            kept.append(i - 1)
            step, low, high = x[i] - x[i - 1], -math.inf, math.inf
            slope = (s[i] - s[i - 1]) / step
        low, high = max(low, slope - reading / step), min(high, slope + reading / step)
    which = np.array([*kept, len(x) - 1] if len(x) > 1 else kept)
    return rows._replace(theta=rows.theta[which], s=rows.s[which], lines=rows.lines[which])


def periodic(rows: Samples, total: float, field: str, unit: str) -> Samples:
    """Rows of a load that repeats itself after `total` rad, without one that closes it; `unit` is for messages.

    TableError, with the line, for angles that do not rise, for a last row a turn later that is not the first one's
    again, and where more is left out behind the last row than between any two, and the ends differ.
    """
    rows = demand_rows(rows, total, field, _LEAST_LOADS, "load")
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
