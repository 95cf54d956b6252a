"""Rows of a table laid out over the angle of their motion, each with its reading error, and as bounds of a motion."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from kin.law.normalised import IntentError
from kin.law.sources.least_jerk import Bounds, EndJerk, FunctionSpace, joined_bounds, nearest_polynomial
from kin.law.sources.ring import SAME_ANGLE, Samples, demand_whole
from kin.numeric.angles import TURN
from kin.numeric.lengths import INPUT, input_number, input_words
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.law.sources.least_jerk import Curve
    from kin.numeric.arrays import Array, Indices

Rest: TypeAlias = Literal["dwell", "cycle", "mirror"]

_UNITS = {1.0: " mm", 25.4: " in", 0.0254: " thou", math.radians(1.0): " deg"}  # units of tables
_ADVISED = {0.0254: (25.4, " in")}  # units that recipes do not have, and those that stand for them
_KEPT = 1.0 - 1e-3  # of a reading: the part that a motion may use, so that its zero may move by rounding
LEAST_READING = 1e-7  # of the stroke: of every digit of a computer each row would become a knot
_LEAST_ROWS = 4  # of a motion
_GAP = 1.5  # of the widest step: a wider one at the end is a part of the turn without rows
_LEAST_READING = 1e-6  # of a row's reading: the least one where two rows bound one angle
_WHOLE = 1e-6  # of a cycle: accuracy with which a whole number of cycles must fill the turn
_SAME = 1e-9  # of the stroke: rows that differ by less are equal
# Jerk at open ends: the degree of the polynomial that shows a jerk, the fewest rows that it keeps and the factor to
# more, and the third derivative that one of degree five within 1 may have at an end of [-1, 1]
_DEGREE, _LEAST_KEPT, _LONGER, _MARKOV = 5, 8, 1.2, 840.0
_MOST_FILLED = 400  # rows that fill the rest of a turn
BELOW = 1e-10  # of the stroke: the depth that a motion may have below its least level


class TableError(IntentError):
    """A table that gives no motion; `line` is the faulty line of the file, `problem` the message without it."""

    def __init__(self, message: str, field: str, line: int, at: float | None = None) -> None:
        super().__init__(f"line {line}: {message}", field, at)
        self.line, self.problem = line, message


@dataclass(frozen=True)
class Tabled:
    """Rows of a motion: rising angles x, rad, displacements s and reading errors, mm or rad, and lines, (n,) each.

    `resolution` (n,) is the reading error, or what a row's own digits leave open where that is more. A row with which a
    turn is filled has the line 0. The motion repeats after `period`, or, where that is 0, rests at the ends of `space`.
    `fixed` are the indices of rows that are met exactly. One unit of the file is `unit` mm or rad.
    """

    x: Array
    s: Array
    reading: Array
    lines: Indices
    space: FunctionSpace
    unit: float
    resolution: Array
    fixed: tuple[int, ...] = ()

    @property
    def period(self) -> float:
        """Angle, rad, after which the motion repeats; 0 where it does not."""
        return self.space.period

    @property
    def stroke(self) -> float:
        """Greatest less least value of the rows, mm or rad."""
        ends = self.space.rest or ()
        levels = np.append(self.s, [level for level in ends if level is not None])
        return float(np.ptp(levels))

    def tell(self, value: float, digits: int = 6) -> str:
        """Text of a displacement, mm or rad, in the table's own unit with its name, to so many significant digits."""
        return in_unit(value, self.unit, digits)

    def bounds(self, share: float = 1.0, least_level: float | None = None) -> Bounds:
        """Bounds of a motion with readings `share` times as great, a little narrower than these.

        Lower bounds are no less than `least_level`, mm or rad, but where a row's upper bound is below it.
        """
        within = share * self.reading * _KEPT
        within[list(self.fixed)] = 0.0
        lo, hi = self.s - within, self.s + within
        if least_level is not None:
            lo = np.where(hi >= least_level, np.maximum(lo, least_level), lo)
        return Bounds(self.x, lo, hi, share * self.reading, np.arange(len(self.x)))

    def between(self, bounds: Bounds, space: FunctionSpace) -> Bounds:
        """Those of `bounds` that lie strictly inside `space`, shifted by a period where the space runs over the end."""
        parts = []
        for turn in (-1, 0, 1) if self.period else (0,):
            x = bounds.x + turn * self.period
            parts.append(bounds._replace(x=x).at(np.flatnonzero(space.inside(x))))
        return joined_bounds(parts)

    def off(self, curve: Curve) -> Array:
        """Distance (n,) of each row's value from a curve, mm or rad."""
        return np.abs(curve(self.x) - self.s)


def in_unit(value: float, unit: float, digits: int = 6) -> str:
    """Text of a displacement `value`, mm or rad, in a unit of `unit` mm or rad, with the unit's name if it has one."""
    return f"{value / unit:.{digits}g}{_UNITS.get(unit, '')}"


def advised(reading: float, unit: float) -> str:
    """Text of a reading error of two digits, not below `reading`, mm or rad, in a unit that a recipe may have."""
    unit, word = _ADVISED.get(unit, (unit, _UNITS.get(unit, "")))
    digit = 10.0 ** (math.floor(math.log10(reading / unit)) - 1)
    return f"{math.ceil(reading / unit / digit - 1e-9) * digit:.6g}{word}"


def tabled(
    rows: Samples,
    reading: float | None,
    total: float,
    around: int | None,
    *,
    rest: Rest | None,
    field: str,
    open_ends: bool = False,
) -> Tabled:
    """Lay rows with a reading error, mm or rad, or for None their own rounding, out over [0, total], rad, or a turn.

    With `around` -1 the motion goes on upside down, over twice the angle; with None it rests at both ends, or with
    `open_ends` at none. `rest` fills the part of a turn without rows; it is a dwell where `rest` is None and the ends
    agree. Raises TableError, with the
    line, for numbers that are not finite, angles that do not rise or cover more than `total`, and ends that do not
    agree. Raises IntentError for a `rest` that does not suit, for too few rows and for an angle that they do not fill.
    """
    rows = demand_rows(rows, total, field)
    slack, least = rows.slack * _slopes(rows), LEAST_READING * float(np.ptp(rows.s))
    written = np.maximum(np.broadcast_to(rows.rounding, rows.s.shape), least)
    own = written if reading is None else np.full(len(rows.s), reading)
    within, resolution = own + slack, np.maximum(own, written) + slack
    if around == 1:
        return _turn(rows, (within, resolution), total, rest, field)
    if rest is not None:
        raise IntentError("the rest of a turn is that of a motion that repeats with it", f"{field}.rest")
    if open_ends:
        _demand_begin(rows, field)
    demand_whole(rows, total, None, field)
    if around is None and open_ends:
        x = rows.theta.copy()
        x[0], x[-1] = 0.0, total
        open_rows = Tabled(
            x, rows.s, within, rows.lines, FunctionSpace(0.0, total, (None, None)), rows.unit, resolution
        )
        ends = _end_jerk(open_rows.bounds(), 0.0, 1.0), _end_jerk(open_rows.bounds(), total, -1.0)
        shown = tuple(end for end in ends if end is not None)
        return replace(open_rows, space=open_rows.space._replace(ends=shown))
    s = rows.s.copy()
    if abs(s[0]) <= own[0]:
        s[0] = 0.0  # where the motion begins
    n = len(s) - 1
    if around is None:
        inner = slice(1, -1)
        space = FunctionSpace(0.0, total, (float(s[0]), float(s[-1])))
        return Tabled(
            rows.theta[inner], s[inner], within[inner], rows.lines[inner], space, rows.unit, resolution[inner]
        )
    return Tabled(
        np.concatenate([rows.theta[:-1], rows.theta[:-1] + total]),
        np.concatenate([s[:-1], s[0] + s[-1] - s[:-1]]),
        np.concatenate([within[:-1], within[-1:], within[1:-1]]),
        np.concatenate([rows.lines[:-1], rows.lines[-1:], rows.lines[1:-1]]),
        FunctionSpace(0.0, 2.0 * total),
        rows.unit,
        np.concatenate([resolution[:-1], resolution[-1:], resolution[1:-1]]),
        (0, n),
    )


def _demand_begin(rows: Samples, field: str) -> None:
    """Raise TableError, at the first row, for rows that do not begin at 0."""
    first = float(rows.theta[0])
    if abs(first) > SAME_ANGLE:
        remedy = f"make every {INPUT} {input_words(abs(first))} {'less' if first > 0.0 else 'more'}"
        raise TableError(f"the {INPUT}s begin at {input_number(first)}, not at 0; {remedy}", field, int(rows.lines[0]))


def _end_jerk(bounds: Bounds, end: float, way: float) -> EndJerk | None:
    """Jerk at an open end that rows show, `way` 1 for the beginning and -1 for the end; or None.

    The jerk and its slope are those of the polynomial of degree five that keeps the most rows from the end on. A
    jerk that is not above what readings leave open, by Markov's bound, is none.
    """
    n, found = len(bounds.x), None
    count = _LEAST_KEPT
    while count <= n:
        part = bounds.at(np.arange(count) if way > 0.0 else np.arange(n - count, n))
        half = 0.5 * float(part.x[-1] - part.x[0])
        _, polynomial, miss = nearest_polynomial(part, _DEGREE, end + way * half, half)
        if miss > 0.0:
            break
        found = polynomial, half, float(part.unit.max())
        if count == n:
            break
        count = min(n, math.ceil(_LONGER * count))
    if found is None:
        return None
    polynomial, half, reading = found
    # jerk and its slope by the distance from the end, which is at u = -1, or at u = 1 seen backwards
    inwards = polynomial * way ** np.arange(_DEGREE + 1)
    jerk, slope = (float(np.polynomial.Polynomial(inwards).deriv(k)(-1.0)) / half**k for k in (3, 4))
    if abs(jerk) <= _MARKOV * reading / half**3:
        return None
    return EndJerk(end, way, 2.0 * half, jerk, slope)


def _slopes(rows: Samples) -> Array:
    """Greatest absolute slope (n,) beside each row."""
    slope = np.abs(np.diff(rows.s) / np.diff(rows.theta))
    greatest: Array = np.maximum(np.append(slope, slope[-1]), np.append(slope[0], slope))
    return greatest


def _turn(rows: Samples, errors: tuple[Array, Array], total: float, rest: Rest | None, field: str) -> Tabled:
    """Rows of a motion that repeats, without a last row that closes it, and with rows in the rest of the turn.

    `errors` are the reading errors and the resolutions, (n,) each.
    """
    within, resolution = errors
    over, line = float(rows.theta[-1] - rows.theta[0]), int(rows.lines[-1])
    apart, allowed = abs(float(rows.s[-1] - rows.s[0])), float(within[0] + within[-1])
    space = FunctionSpace(float(rows.theta[0]), float(rows.theta[0]) + total)
    if over > total - SAME_ANGLE:
        _demand_no_rest(rest, field)
        if apart > allowed * (1.0 + 1e-9):
            later = f"{in_unit(apart, rows.unit)} off the first row, {input_words(total)} earlier"
            problem = f"the motion does not close: {later}"
            remedy = f"give this row the displacement of the first one, or reading: {advised(0.5 * apart, rows.unit)}"
            raise TableError(f"{problem}; {remedy}", field, line)
        s, readings = rows.s[:-1].copy(), within[:-1].copy()
        if apart:  # both rows bound the motion at one angle
            low, high = (rows.s + sign * within for sign in (-1.0, 1.0))
            least, most = max(low[0], low[-1]), min(high[0], high[-1])
            s[0], readings[0] = 0.5 * (least + most), max(0.5 * (most - least), _LEAST_READING * within[0])
        return Tabled(rows.theta[:-1], s, readings, rows.lines[:-1], space, rows.unit, resolution[:-1])
    if total - over <= _GAP * float(np.diff(rows.theta).max()):
        _demand_no_rest(rest, field)
        return Tabled(rows.theta, rows.s, within, rows.lines, space, rows.unit, resolution)
    if rest is None and apart > allowed:
        ends = f"the table ends after {input_words(over)}, {in_unit(apart, rows.unit)} off its first row"
        remedy = "add the rows that are missing, or give rest: mirror, cycle or dwell"
        raise TableError(f"{ends}: the rest of the turn can be no dwell; {remedy}", field, line)
    x, s, like = _rest(rows, total, rest or "dwell", field)
    return Tabled(
        np.concatenate([rows.theta, x]),
        np.concatenate([rows.s, s]),
        np.concatenate([within, within[like]]),
        np.concatenate([rows.lines, np.zeros(len(x), dtype=np.intp)]),
        space,
        rows.unit,
        np.concatenate([resolution, resolution[like]]),
    )


def _demand_no_rest(rest: Rest | None, field: str) -> None:
    if rest is not None:
        raise IntentError("the rows cover the turn: there is no rest of it; leave it out", f"{field}.rest")


def _rest(rows: Samples, total: float, rest: Rest, field: str) -> tuple[Array, Array, Indices]:
    """Angles and displacements (m,) that fill the rest of a turn, and the indices (m,) of rows with their readings.

    Raises IntentError for a `rest` that does not fill the turn.
    """
    first, last = float(rows.theta[0]), float(rows.theta[-1])
    over, n = last - first, len(rows.s)
    left = total - over
    if rest == "dwell":
        step = max(float(np.median(np.diff(rows.theta))), left / _MOST_FILLED)
        count = max(2, math.ceil(left / step - 1e-6))
        x = last + left * np.arange(1, count) / count
        return x, np.full(len(x), rows.s[-1]), np.full(len(x), n - 1)
    if rest == "mirror":
        if abs(left - over) > SAME_ANGLE:
            problem = f"rows that are mirrored cover {input_words(0.5 * total)}, not {input_number(over)}"
            raise IntentError(f"{problem}; add those that are missing, or give rest: dwell", f"{field}.rest")
        back = np.arange(n - 2, 0, -1)
        return 2.0 * last - rows.theta[back], rows.s[back], back
    return _cycle(rows, total, field)


def _cycle(rows: Samples, total: float, field: str) -> tuple[Array, Array, Indices]:
    """The rows repeated; the last one may be the first of the next cycle, or a step before it."""
    over = float(rows.theta[-1] - rows.theta[0])
    lengths = over, over + float(np.median(np.diff(rows.theta)))
    whole = [abs(total / length - round(total / length)) <= _WHOLE for length in lengths]
    closed = whole[0] and abs(float(rows.s[-1] - rows.s[0])) <= _SAME * float(np.ptp(rows.s))
    if not (closed or whole[1]):
        cycles = f"{input_number(lengths[0])} nor {input_words(lengths[1])}"
        problem = f"a cycle of the rows is neither {cycles}, of which a whole number fill the turn"
        raise IntentError(f"{problem}; add rows, or give rest: dwell", f"{field}.rest")
    count = round(total / lengths[0 if closed else 1])
    like = np.tile(np.arange(len(rows.s) - closed), count)
    x = rows.theta[like] + np.repeat(np.arange(count), len(like) // count) * (total / count)
    more = slice(len(rows.s), None)
    return x[more], rows.s[like[more]], like[more]


def demand_rows(
    rows: Samples, total: float, field: str, least: int = _LEAST_ROWS, quantity: str = "displacement"
) -> Samples:
    """Rows in rising order of angles, falling ones reversed, without rows written twice.

    Angles over a turn may begin anew once, at 360 degrees, and end before the first.

    Raises TableError, with the line, for numbers that are not finite, angles that neither rise nor fall, and angles
    over more than `total`, rad; IntentError for fewer than `least` rows. `quantity` is the second column's name in
    messages.
    """
    for column, what in ((rows.theta, f"the {INPUT}"), (rows.s, f"the {quantity}")):
        bad = np.flatnonzero(~np.isfinite(column))
        if len(bad):
            raise TableError(f"{what} is not finite", field, int(rows.lines[bad[0]]))
    # falling angles are turned round, equal rows dropped
    if len(rows.theta) > 1 and (np.diff(rows.theta) < 0.0).all():
        rows = rows.part(slice(None, None, -1))
    twice = (np.diff(rows.theta) == 0.0) & (np.diff(rows.s) == 0.0)
    if twice.any():
        rows = rows.part(np.append(True, ~twice))
    if len(rows.theta) < least:
        raise IntentError(f"a table has at least {least} rows, not {len(rows.theta)}; add rows", field)
    falls = np.flatnonzero(np.diff(rows.theta) <= SAME_ANGLE)
    if len(falls) == 1 and total >= TURN - SAME_ANGLE:
        beyond = rows.theta + np.where(np.arange(len(rows.theta)) > falls[0], TURN, 0.0)
        if beyond[-1] - beyond[0] <= TURN + SAME_ANGLE and (np.diff(beyond) > SAME_ANGLE).all():
            rows, falls = rows._replace(theta=beyond), falls[:0]
    if len(falls):
        i = int(falls[0]) + 1
        before, here = (input_number(value, ".9g") for value in rows.theta[i - 1 : i + 1].tolist())
        same = rows.theta[i] == rows.theta[i - 1]
        word = f"stands twice, with another {quantity}" if same else f"follows {before}"
        raise TableError(f"the {INPUT}s must rise; {here} {word}", field, int(rows.lines[i]))
    over = float(rows.theta[-1] - rows.theta[0])
    if over > total + SAME_ANGLE:
        i = int(np.argmax(rows.theta - rows.theta[0] > total + SAME_ANGLE))
        crank = quantity == "displacement" and over <= 2.0 * total + SAME_ANGLE
        remedy = "; give angle: crank if its angles are the crank's" if crank else ""
        covered = f"the table covers more than {input_words(total)}{remedy}"
        raise TableError(covered, field, int(rows.lines[i]))
    return rows
