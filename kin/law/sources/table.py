"""A motion from a table: the motion of least mean square jerk within the reading of each row."""

from __future__ import annotations

import math
from operator import itemgetter
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from kin.law.normalised import IntentError
from kin.law.segment import AffineStretch, Constant, Power
from kin.law.sources.dwells import runs, stretches
from kin.law.sources.least_jerk import Bounds, CrowdedError, LowerLimit, UnsolvedError, curve_through, least
from kin.law.sources.motion import Kept, Motion, TableRemark, joined
from kin.law.sources.ring import SAME_ANGLE, Samples, settled
from kin.law.sources.suspects import nearest, suspects
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

Suspects: TypeAlias = Literal["keep", "drop", "refuse"]

_LEAST_LOADS = 2  # rows of a load
_GAP = 1.5  # of the widest step of a load: a wider one at its end is a gap
_FREE = 2.0  # times the part of a least row beyond its reading: how far from 0 a motion may be at its lowest
_SAME = 1e-6  # of a reading: distances that differ by less are equal
_FAR = 0.01  # of the stroke: a greater distance of rows is remarked on
_PINS = 3  # rounds in which a motion above its least level is brought down to it at its lowest place
_MOVES = 40  # greatest number of moves of that place to where less jerk does
_TOUCHES = 1e-9  # of the stroke: the height above the level that may stay
_CALM = 120  # knots of the smooth curve from which the distances of scattered rows are taken
_MOST_ADVISED = 0.25  # of the stroke: a greater reading leaves little of a motion
_ABOUT = 0.01  # of a reading: by how much the motion without dwells, used for comparison alone, may be too low
_DIGITS = 9  # of a row's value in messages, at most
_NOTHING = 1e6  # times less
_QUARTER = 0.25  # of the angle: rows that cover less are likely to be in another unit
_NEARLY = 1e-3  # of a last angle: accuracy of its comparison
_UNITS_BY_END = {2.0 * math.pi: "radians", 1.0: "turns", 100.0: "percent"}  # last angles of a turn, and their units


def from_table(
    rows: Samples,
    reading: float | None,
    total: float = 2 * math.pi,
    *,
    around: int | None = 1,
    rest: Rest | None = None,
    suspect: Suspects = "keep",
    open_ends: bool = False,
    field: str = "motion.table",
) -> Motion:
    """Motion of least mean square jerk within `reading`, mm or rad, of each row: a quintic spline, C4 except at dwells.

    For None the reading of each row is its own rounding, as written. With `around` 1 it repeats after `total` rad, and
    `rest` fills the part of a turn that the rows leave out. Its least value is 0: it is made so where the least row is
    0 within its reading, else it is lowered or raised as a whole. With -1 it goes on upside down, and with None it
    rests at both ends; both begin at 0. With None and `open_ends` it ends as its rows do, and its least value is 0 as
    that of one that repeats. Rows that are equal over 10 degrees are a dwell, exactly level on its inner
    part. `kept` of the motion has its greatest distance from the rows as given, and remarks on them.

    Rows that stand out are followed, with `suspect` "drop" left out, both with remarks, and with "refuse" a TableError,
    with the line of the first. So are rows that do not close within their readings, numbers that are not finite, and
    angles that do not rise or cover more than `total`. Raises IntentError for a reading not above 0 or as great as the
    stroke, too few rows, rows that do not fill the angle, a `rest` that does not suit, and rows that scatter far beyond
    their readings.
    """
    if reading is not None and not (math.isfinite(reading) and reading > 0):
        raise IntentError(f"the reading error must be above 0, not {reading:.6g}", f"{field}.reading")
    layout = tabled(rows, reading, total, around, rest=rest, field=field, open_ends=open_ends)
    try:
        plain, raised = nearest(layout)
        if plain is None or not layout.stroke:
            _demand_stroke(layout, field)
            return _with_distance(joined([0.0, total], [Constant(0.0)], around), layout, rows)
        standing = suspects(layout, plain, noisy=raised is not None)
        lines = [int(layout.lines[place]) for found in standing for place in found.rows]
        if standing and suspect == "refuse":
            more = "".join(f"; line {layout.lines[found.rows[0]]} stands out too" for found in standing[1:])
            problem = _standing(layout, standing[0]) + more
            raise TableError(f"{problem}; mend it, or give suspect: keep or drop", field, lines[0])
        if standing and suspect == "drop":
            remarks = _row_remarks(layout, standing, "left out, {}")
            others = rows.part(~np.isin(rows.lines, lines))
            made = from_table(others, reading, total, around=around, rest=rest, open_ends=open_ends, field=field)
            return _remarked(made, remarks)
        remarks = _row_remarks(layout, standing, "{}; mend it, or give suspect: drop")
        if raised is not None and not standing:
            calm = advised(raised * float(layout.reading.max()), layout.unit)
            calms = f"with reading: {calm} the mean square of the jerk is a tenth"
            remarks.append(TableRemark("table-noise", f"{calms}: the rows scatter by more than their digits"))
        remarks += _angles(rows, total)
        return _remarked(_with_distance(_laid(layout, plain, total, around), layout, rows), remarks)
    except UnsolvedError:
        stroke, within = layout.tell(layout.stroke), layout.tell(float(layout.reading.max()))
        problem = f"no motion was found within {within} of rows over {stroke}: rounding stands in the way"
        raise IntentError(f"{problem}; give a greater reading, or leave rows out", field) from None
    except CrowdedError:
        raise IntentError(_scatter_advice(layout), field) from None


def _remarked(motion: Motion, remarks: Sequence[TableRemark]) -> Motion:
    """The motion from a table with more remarks, before its own."""
    kept = motion.kept
    return motion if kept is None else replace(motion, kept=kept._replace(remarks=(*remarks, *kept.remarks)))


def _with_distance(motion: Motion, layout: Tabled, rows: Samples) -> Motion:
    """The motion with its distances from the rows, and a remark on a far row."""
    repeats = motion.around == 1
    if _has_lowest(layout, motion.around) and any(_lowest(layout)):
        motion = motion.from_lowest()
    theta = np.mod(rows.theta, motion.total) if repeats else rows.theta
    above = rows.s - motion.derivatives(theta, 0)[0]
    low, high = float(above.min()), float(above.max())
    distance, lowered, distance_lowered = max(high, -low), 0.5 * (low + high), 0.5 * (high - low)
    # the first of those that differ by rounding alone
    worst = int(np.argmax(np.abs(above) >= distance - _SAME * float(layout.reading.max())))
    remarks: tuple[TableRemark, ...] = ()
    if 0.0 < _FAR * layout.stroke < distance:
        share = 100.0 * distance / layout.stroke
        text = f"the motion leaves its rows by up to {layout.tell(distance, 3)}, {share:.2g} % of the stroke"
        text += f" (line {rows.lines[worst]})"
        if distance_lowered < 0.5 * distance:
            near = f"{layout.tell(distance_lowered, 3)} of its rows lowered by {layout.tell(lowered)}"
            text += f"; it is within {near}; subtract that by offset"
        remarks = (TableRemark("table-distance", text),)
    return replace(motion, kept=Kept(distance, int(rows.lines[worst]), remarks, lowered, distance_lowered))


def _laid(layout: Tabled, plain: Least, total: float, around: int | None) -> Motion:
    """The motion with its dwells over [0, total], rad; from 0 on unless it repeats or its ends are open."""
    low, level = _lowest(layout) if _has_lowest(layout, around) else (None, None)
    limit = None if low is None else LowerLimit(low, BELOW * layout.stroke)
    bounds = layout.bounds(1.0, low)
    equal = runs(layout, level)
    # the lowest place of a motion that is nowhere as low as it must be becomes a bound at that level
    for _ in range(_PINS):
        near = plain
        if limit is not None and equal:
            about = max(limit.tolerance, _ABOUT * float(layout.reading.max()))
            near = _solved(layout.space, bounds, plain, LowerLimit(limit.level, about))
        dwells, moving = stretches(layout, equal, near, bounds, limit)
        whole = near if dwells else _solved(layout.space, bounds, near, limit)
        if limit is None or level is None or any(run.level == level for run in dwells):
            break
        lows = [part.least.curve.lowest() for part in moving] or [whole.curve.lowest()]
        at, value = min(lows, key=itemgetter(1))
        if value - level <= _TOUCHES * layout.stroke:
            break
        bounds = _brought_down(layout.space, bounds, near, limit, (at, level))
    if around is None:
        motion = joined(*_pieces(dwells, moving, 0.0), None)
        return motion if layout.space.free else motion.raised(-float(motion.at_start(0)[0]))
    turn, curve = layout.period, whole.curve
    begin = curve.starts.tolist()
    knots, functions = _pieces(dwells, moving, turn) if dwells else ([*begin, begin[0] + turn], _functions(curve, None))
    motion = settled(knots, functions, turn, total)
    return motion if around == 1 else Motion(motion.raised(-float(motion.at_start(0)[0])).motion, -1)


def _solved(space: FunctionSpace, bounds: Bounds, near: Least, limit: LowerLimit | None) -> Least:
    """The motion within bounds; raises UnsolvedError where a constant keeps them."""
    solution = least(space, bounds, near.touch, limit)
    if solution is None:
        raise UnsolvedError
    return solution


def _brought_down(
    space: FunctionSpace, bounds: Bounds, near: Least, limit: LowerLimit, pin: tuple[float, float]
) -> Bounds:
    """Bounds with one that brings a motion down to a level, mm or rad, near the place where that takes least jerk.

    `pin` is the place at first, rad, and the level. A motion through the pin that is lower elsewhere has its pin moved
    there, by which the mean square of the jerk falls.
    """
    at, level = pin
    unit, row = bounds.unit[:1], np.array([-1])
    for _ in range(_MOVES):
        place = bounds.x[:1] + np.mod(at - bounds.x[0], space.period) if space.period else np.array([at])
        pinned = bounds.with_more(Bounds(place, np.array([limit.level]), np.array([level]), unit, row), space.period)
        near = _solved(space, pinned, near, None)
        at, value = near.curve.lowest()
        if level - value <= limit.tolerance:
            break
    return pinned


def _has_lowest(layout: Tabled, around: int | None) -> bool:
    """Whether the least value of the motion is 0, wherever it is."""
    return around == 1 or layout.space.free


def _lowest(layout: Tabled) -> tuple[float, float]:
    """Least and greatest level, mm or rad, at which a motion that is 0 at its lowest may be lowest.

    Both are 0 where the least row is 0 within its reading. The farther it is beyond, the farther they are from 0, to
    either side. A dwell that is lowest has one level: its rows', or the nearest of these.
    """
    bounds, lowest = layout.bounds(), int(np.argmin(layout.s))
    level = float(layout.s[lowest])
    far = _FREE * (abs(level) - float(layout.reading[lowest]))
    apart = max(far, float(bounds.lo[lowest]), -float(bounds.hi.min()), 0.0)
    if any(run.level == level for run in runs(layout, None)):
        level = min(max(level, -apart), apart)
        return level, level
    return -apart, apart


def _pieces(dwells: Sequence[Run], moving: Sequence[Moving], turn: float) -> tuple[list[float], list[Stretch]]:
    """Knots and functions of dwells and of the motions between them: round a `turn`, or from first to last for 0."""
    knots: list[float] = []
    functions: list[Stretch] = []
    for i, run in enumerate(dwells):
        if run.end > run.begin and run.level is not None:
            knots.append(run.begin)
            functions.append(Constant(run.level))
        if i < len(moving):
            curve = moving[i].least.curve
            knots += curve.starts.tolist()
            functions += _functions(curve, dwells[(i + 1) % len(dwells)].level)
    return [*knots, dwells[0].begin + turn if turn else dwells[-1].end], functions


def _functions(curve: Curve, level: float | None) -> list[Stretch]:
    """Polynomials of a curve's pieces as stretches.

    The last one of a curve that rests at its end is expanded about that, so that it is exactly at rest, at `level`.
    """
    rows, starts = curve.coefficients.T.tolist(), curve.starts.tolist()
    if level is not None:
        *_, c3, c4, c5 = rows[-1]
        rows[-1] = [level, 0.0, 0.0, c3 + 4.0 * c4 + 10.0 * c5, c4 + 5.0 * c5, c5]
        starts[-1] += curve.widths[-1]
    spans = zip(rows, starts, curve.widths.tolist(), strict=True)
    return [AffineStretch(Power(tuple(row)), start=start, width=width) for row, start, width in spans]


def _demand_stroke(layout: Tabled, field: str) -> None:
    """Raise IntentError for readings that leave no motion of rows that differ."""
    if layout.stroke > 1e-9 * float(np.abs(layout.s).max(initial=0.0)):
        small = f"the rows differ by {layout.tell(layout.stroke)} in all, less than their reading error leaves open"
        problem = f"{small}: {layout.tell(float(layout.reading.max()))} to either side"
        raise IntentError(f"{problem}; give reading: {advised(0.05 * layout.stroke, layout.unit)} or less", field)


def _scatter_advice(layout: Tabled) -> str:
    """Words for rows that scatter, with the reading that a smooth curve through means of successive rows needs."""
    count = len(layout.x)
    groups = np.array_split(np.arange(count), min(_CALM, count))
    x, s = (np.array([column[group].mean() for group in groups]) for column in (layout.x, layout.s))
    apart = float(layout.off(curve_through(layout.space, x, s)).max())
    within = layout.tell(float(layout.reading.max()))
    problem = f"{count} rows scatter too far beyond their reading, {within}, for a motion to follow each"
    if apart > _MOST_ADVISED * layout.stroke:
        remedy = "see that the columns are those meant, or write means of successive rows"
        return f"{problem}, and lie about no smooth curve; {remedy}"
    return f"{problem}; give reading: {advised(apart, layout.unit)}, or fewer rows"


def _row_remarks(layout: Tabled, standing: Sequence[Suspect], words: str) -> list[TableRemark]:
    """A remark for each of the rows that stand out, or pairs of them; `words` have a place for what is told of it."""
    lines = (layout.lines[found.rows[0]] for found in standing)
    told = (words.format(_standing(layout, found)) for found in standing)
    return [TableRemark("table-row", f"line {line}: {sentence}") for line, sentence in zip(lines, told, strict=True)]


def _standing(layout: Tabled, found: Suspect) -> str:
    """Words for the rows that stand out, and the values expected there, to their digits."""
    told = []
    for place, expected in zip(found.rows, found.expected, strict=True):
        digit = 2.0 * float(layout.resolution[place]) / layout.unit
        fits = round(expected / layout.unit, math.ceil(-math.log10(digit) - _NEARLY)) * layout.unit
        told.append(
            f"{layout.tell(float(layout.s[place]), _DIGITS)}, about {layout.tell(fits, _DIGITS)} fits the others"
        )
    words = f"the row stands out: it is {told[0]}"
    words += "".join(
        f", and line {layout.lines[place]} is {more}" for place, more in zip(found.rows[1:], told[1:], strict=True)
    )
    falls = f"{float(f'{found.falls:.2g}'):.8g} times less" if found.falls < _NOTHING else "next to nothing"
    return f"{words}; without, the mean square of the jerk about there is {falls}"


def _angles(rows: Samples, total: float) -> list[TableRemark]:
    """Remark on angles that are hardly degrees, or cover little of the turn; [] without one."""
    over = float(np.ptp(rows.theta))
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
    return rows.part(index)


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
