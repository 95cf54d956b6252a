"""A motion from a table: the motion of least mean square jerk within the reading of each row."""

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

_LEAST_LOADS = 2  # rows of a load
_GAP = 1.5  # of the widest step of a load: a wider one at its end is a gap
_ZERO = 2.0  # readings: a least value of a motion within them is taken as 0
_SAME = 1e-6  # of a reading: distances that differ by less are equal
_FAR = 0.01  # of the stroke: a greater distance of rows is remarked on
_PINS = 3  # rounds in which a motion above its least level is brought down to it at its lowest place
_TOUCHES = 1e-9  # of the stroke: the height above the level that may stay
_CALM = 120  # knots of the smooth curve from which the distances of scattered rows are taken
_MOST_ADVISED = 0.25  # of the stroke: a greater reading leaves little of a motion
_ABOUT = 0.01  # of a reading: by how much the motion without dwells, used for comparison alone, may be too low
_QUARTER = 0.25  # of the angle: rows that cover less are likely to be in another unit
_NEARLY = 1e-3  # of a last angle: accuracy of its comparison
_UNITS_BY_END = {2.0 * math.pi: "radians", 1.0: "turns", 100.0: "percent"}  # last angles of a turn, and their units


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
    """Motion of least mean square jerk within `reading`, mm or rad, of each row: a quintic spline, C4 except at dwells.

    With `around` 1 it repeats after `total` rad, and is nowhere below its least level; `rest` fills the part of a turn
    that the rows leave out. With -1 it goes on upside down, and with None it rests at both ends; both begin at 0. Rows
    that are equal over 10 degrees are a dwell, exactly level on its inner part. `kept` of the motion has its greatest
    distance from the rows, and remarks on them.

    Raises TableError, with the line, for rows that do not close within their readings, numbers that are not finite,
    angles that do not rise or cover more than `total`, and, with `suspects` "refuse", for one or two rows that only an
    error explains. Raises IntentError for a reading not above 0 or as great as the stroke, too few rows, rows that do
    not fill the angle, a `rest` that does not suit, and rows that scatter far beyond their readings.
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
    worst = int(np.argmax(off >= distance - _SAME * reading))  # the first of those that differ by rounding alone
    if distance > _FAR * layout.stroke:
        share = 100.0 * distance / layout.stroke
        text = f"the motion leaves its rows by up to {layout.tell(distance, 3)}, {share:.2g} % of the stroke"
        remarks.append(TableRemark("table-distance", f"{text} (line {rows.lines[worst]})"))
    return replace(motion, kept=Kept(distance, int(rows.lines[worst]), tuple(remarks)))


def _laid(layout: Tabled, plain: Least, total: float, around: int | None) -> Motion:
    """The motion with its dwells over [0, total], rad; from 0 on unless it repeats."""
    level = _least_level(layout, plain) if around == 1 else None
    limit = None if level is None else LowerLimit(level, BELOW * layout.stroke)
    bounds = layout.bounds(1.0, level)
    equal = runs(layout, level)
    # the lowest place of a motion above its least level becomes a bound at that level
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
    """The motion within bounds; raises UnsolvedError where a constant keeps them."""
    solution = least(space, bounds, near.touch, limit)
    if solution is None:
        raise UnsolvedError
    return solution


def _least_level(layout: Tabled, plain: Least) -> float | None:
    """Lower limit of a motion over a turn, which it attains, mm or rad; None where the table sets none.

    It is 0 where the lowest row is 0 within its reading, else the level of a dwell that is lowest. It is 0 too where
    the lowest row is positive, but the motion is lowest at about 0 between two rows.
    """
    lowest = int(np.argmin(layout.s))
    level, reading = float(layout.s[lowest]), float(layout.reading[lowest])
    if abs(level) <= reading:
        return 0.0
    if any(run.level == level for run in runs(layout, None)):
        return level
    return 0.0 if level > 0.0 and abs(plain.curve.lowest()[1]) <= _ZERO * reading else None


def _pieces(dwells: Sequence[Run], moving: Sequence[Moving], turn: float) -> tuple[list[float], list[Stretch]]:
    """Knots and functions of dwells and of the motions between them: round a `turn`, or from first to last for 0."""
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
    """Polynomials of a curve's pieces as stretches.

    The last one of a curve without a period is expanded about its end, so that it is exactly at rest there, at `level`.
    """
    rows, starts = curve.coefficients.T.tolist(), curve.starts.tolist()
    if not curve.period:
        *_, c3, c4, c5 = rows[-1]
        rows[-1] = [level, 0.0, 0.0, c3 + 4.0 * c4 + 10.0 * c5, c4 + 5.0 * c5, c5]
        starts[-1] += curve.widths[-1]
    spans = zip(rows, starts, curve.widths.tolist(), strict=True)
    return [AffineStretch(Power(tuple(row)), start=start, width=width) for row, start, width in spans]


def _demand_stroke(layout: Tabled, reading: float, field: str) -> None:
    """Raise IntentError for a reading that leaves no motion of rows that differ."""
    if layout.stroke > 1e-9 * float(np.abs(layout.s).max(initial=0.0)):
        small = f"the rows differ by {layout.tell(layout.stroke)} in all, less than their reading error leaves open"
        problem = f"{small}: {layout.tell(reading)} to either side"
        raise IntentError(f"{problem}; give reading: {advised(0.05 * layout.stroke, layout.unit)} or less", field)


def _scatter_advice(layout: Tabled, reading: float) -> str:
    """Words for rows that scatter, with the reading that a smooth curve through means of successive rows needs."""
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
    """Words for the rows that stand out, and the values expected there."""
    (first, *more), (expected, *others) = standing.rows, standing.expected
    digits = 7
    sentence = f"the row stands out: it is {layout.tell(float(layout.s[first]), digits)}, about "
    sentence += layout.tell(expected, 4 if abs(expected) < layout.stroke else digits)
    for place, value in zip(more, others, strict=True):
        sentence += f", and line {layout.lines[place]} is {layout.tell(float(layout.s[place]), digits)}, about "
        sentence += layout.tell(value, 4)
    return f"{sentence} fits the others; without, the mean square of the jerk is {standing.falls:.3g} times less"


def _angles(rows: Samples, total: float) -> list[TableRemark]:
    """Remark on angles that are hardly degrees, or cover little of the turn; [] without one."""
    over = abs(float(rows.theta[-1] - rows.theta[0]))
    if over >= (1.0 - _NEARLY) * total:
        return []
    # greatest angle as the file has it: `turned` is the number of its units of angle in a degree
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
    """The rows without those that lie within `reading`, in their unit, of straight lines between the rows that stay.

    The cone of J. Sklansky and V. Gonzalez (Pattern Recognition 12, 1980): a line goes on while all rows passed allow
    it.
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
    index = np.array([*kept, len(x) - 1] if len(x) > 1 else kept)
    return rows._replace(theta=rows.theta[index], s=rows.s[index], lines=rows.lines[index])


def periodic(rows: Samples, total: float, field: str, unit: str) -> Samples:
    """Rows of a load that repeats after `total` rad, without a last row that closes it; `unit` is for messages.

    They come in rising order, falling ones reversed, and without rows written twice. Raises TableError, with the line,
    for numbers that are not finite, angles that neither rise nor fall or cover more than `total`, a last row a turn
    later that differs from the first, and ends that differ beside a gap over 1.5 times the widest between two rows.
    Raises IntentError for fewer than two rows.
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
