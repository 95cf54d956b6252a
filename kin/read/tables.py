"""Tables of motions and loads as text: columns by heading or number, in the units of the headings or of the caller."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from kin.law.normalised import IntentError
from kin.law.sources.ring import Samples
from kin.law.sources.tabled import TableError
from kin.numeric.records import replace
from kin.read.errors import short
from kin.read.rows import RowError, Rows, read_rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array

AngleUnit: TypeAlias = Literal["cam", "crank", "radians", "turns", "percent", "seconds"]
LengthUnit: TypeAlias = Literal["mm", "inch", "thou"]
Quantity: TypeAlias = Literal["length", "angle", "force", "moment", "share"]
Column: TypeAlias = str | int

_MM, _DEGREE, _LBF = 1.0, math.pi / 180, 4.4482216152605
UNITS: dict[Quantity, dict[str, float]] = {
    "length": {"mm": _MM, "inch": 25.4, "thou": 0.0254, "cm": 10.0, "m": 1000.0, "um": 1e-3},
    "angle": {"degrees": _DEGREE, "radians": 1.0},
    "force": {"N": 1.0, "kN": 1000.0, "lbf": _LBF},
    "moment": {"Nm": 1.0, "lbf in": _LBF * 0.0254, "lbf ft": _LBF * 0.3048},
    "share": {"": 1.0},
}
"""One unit of a column as mm, rad, N or N m; shares have none, nor have the angles beside them."""

_WORDS = (
    {word: word for units in UNITS.values() for word in units if word and " " not in word}
    | {"in": "inch", "inches": "inch", '"': "inch", "mil": "thou", "mils": "thou", "thous": "thou"}
    | {"µm": "um", "μm": "um", "micron": "um", "microns": "um"}  # of the micro sign and of the Greek letter
    | {"deg": "degrees", "degree": "degrees", "°": "degrees", "rad": "radians", "radian": "radians"}
    | {"n": "N", "kn": "kN", "nm": "Nm", "lbs": "lbf", "lb": "lbf", "lbfin": "lbf in", "lbfft": "lbf ft"}
    | {"turn": "turns", "turns": "turns", "rev": "turns", "revs": "turns"}
    | {"%": "percent", "percent": "percent", "pct": "percent"}
    | {"sec": "seconds", "secs": "seconds", "second": "seconds", "seconds": "seconds", "ms": "ms"}
)  # units of headings, in small letters but for those that mean something else then
_ANGLE_UNITS = {"degrees": _DEGREE, "radians": 1.0, "turns": 2 * math.pi, "percent": math.pi / 50}
_TIMES = {"seconds": 1.0, "ms": 1e-3}
_QUANTITIES: dict[Quantity, str] = {
    "length": "a length",
    "angle": "an angle",
    "force": "a force",
    "moment": "a moment",
    "share": "a share from 0 to 1 of a law's stroke or of its angle",
}
_JOINED = {"nm", "lbfin", "lbfft"}  # units of two words
_ANGLE_NAMES = {"angle", "phi", "theta", "cam", "crank", "shaft", "rotation", "deg", "°", "rad", "degrees", "radians"}
_ANGLE_NAMES |= {"master", "masterpos", "winkel", "grad", "camangle", "nockenwinkel", "drehwinkel", "nw"}
_TIME_NAMES = {"time", "t", *_TIMES}
_VALUE_NAMES = {"lift", "s", "displacement", "stroke", "position", "rise", "travel", "swing", "load", "force", "torque"}
_VALUE_NAMES |= {"slave", "slavepos", "hub", "weg", "valvelift", "camlift", "ventilhub", "nockenhub"}
_LENGTH_NAMES = {"travel", "length", "distance", "x", "u", "master", "masterpos"}
_CRANK_NAMES = {"crank", "crk", "cra", "crankangle", "crankdeg", "kurbelwinkel", "kw"}
_CRANK_NAMES |= {"atdc", "btdc", "abdc", "bbdc"}  # dead centres are the piston's
_EITHER_NAMES = {"ca", "cad"}  # angle of the crank in simulators, of the cam in a grinder's table
_ANGLE_NAMES |= _CRANK_NAMES | _EITHER_NAMES
_DEGREES_OF = re.compile(r"(?:°|deg|grad)(?=.)")  # of a shaft, as in `°KW` and `degCA`
_CAM_TURN = 360.0 * (1.0 + 1e-9)  # degrees; a table over more is of the crank
_FEW = 3  # angles
_MANY = 12  # different values
_EXACT = 1e-9  # of the greatest angle: what is less is no rounding of digits


class Counted(NamedTuple):
    """A column of values without one of inputs: its rows are `step` apart, in the inputs' unit, the first at 0."""

    column: Column
    step: float


class Sheet(NamedTuple):
    """How a table is read: its quantity, and what the caller states of columns and units, None where the file does.

    Columns are those of the angle and of the value, by their heading or their number from 1, or one that is counted.
    The angles "cam" and "crank" are degrees of that shaft, "seconds" are times at which the cam turns once in `period`
    seconds. Rows over a length have its unit in `length`, where nothing else is stated; None for rows over an angle.
    Units of values are keys of `UNITS` for the quantity; `instead` is the unit where neither caller nor
    heading states one, None for the first of them.
    """

    quantity: Quantity
    columns: tuple[Column, Column] | Counted | None = None
    angle: AngleUnit | LengthUnit | None = None
    unit: str | None = None  # of the values
    instead: str | None = None
    scale: float = 1.0
    offset: float = 0.0  # in the values' unit, after the scale
    period: float | None = None
    length: str | None = None

    @property
    def noun(self) -> str:
        """What the first column holds: angle or length."""
        return "angle" if self.length is None else "length"


LENGTHS = Sheet("length")
"""Sheet of lengths over cam degrees, in mm where the heading says nothing else."""


def read_table(text: str, sheet: Sheet = LENGTHS, field: str = "motion.table") -> Samples:
    """Read rows of an angle or a length and a value: angles become radians of the cam, values mm, rad, N or N m.

    The rounding of a value is half the last digit to which rows of its size are written, in the values' unit, scaled.
    Empty lines, lines that start with #, !, % or //, headings and rows without both are passed over; units of headings
    are taken, and those behind numbers. `field` names the table in errors. Raises TableError, with the line, for a row
    that is no angle and value; IntentError for a text without rows, columns that are missing or ambiguous, and units
    that contradict the heading or the quantity.
    """
    try:
        rows = read_rows(text)
        if len(rows.heading) != rows.columns:
            rows = replace(rows, heading=())  # a title
        if not rows.heading:
            told = (names for names in rows.commented if len(names) == rows.columns and _told(names, sheet))
            rows = replace(rows, heading=next(told, ()))
        places = _columns(rows, sheet, field)
        degree, unit = _units(rows, sheet, places, field)
        rows, columns = _values(rows, [place for place in places if place is not None])
    except RowError as error:
        if error.line is None:
            raise IntentError(error.message, field) from None
        quantity = "load" if sheet.quantity in {"force", "moment"} else "displacement"
        article = "a" if sheet.length else "an"
        expected = f"{article} {sheet.noun} and a {quantity} are expected"
        raise TableError(f"{error.message}; {expected}", field, error.line) from None
    first, second = places
    values, slack = columns[:, -1], 0.0
    if first is None:
        theta = np.arange(len(values), dtype=np.float64) * (
            sheet.columns.step if isinstance(sheet.columns, Counted) else 1.0
        )
    else:
        theta = columns[:, 0]
        slack = _rounded(theta, 0.5 * 10.0 ** -max(map(_places, rows.texts(first)))) * degree
    size = UNITS[sheet.quantity][unit]
    shown = UNITS["angle"]["degrees"] if sheet.quantity == "angle" else size
    rounding: Array = 0.5 * abs(sheet.scale) * size * 10.0 ** -_decimals(rows.texts(second), values)
    values = (values * sheet.scale + sheet.offset) * size
    return Samples(theta * degree, values, rows.numbers, shown, slack, _DEGREE / degree, rounding)


def _told(names: tuple[str, ...], sheet: Sheet) -> bool:
    """Whether a comment's cells name an angle and a value, as headings do."""
    known = UNITS[sheet.quantity]
    angles = {k for k, name in enumerate(names) if _ANGLE_NAMES & {*_words(name)} or unit_of(name) in _ANGLE_UNITS}
    values = {k for k, name in enumerate(names) if _VALUE_NAMES & {*_words(name)} or unit_of(name) in known}
    return bool(angles and values and len(angles | values) > 1)


def _values(rows: Rows, places: Sequence[int]) -> tuple[Rows, Array]:
    """Rows that are not empty in these columns, and their numbers (n, k)."""
    try:
        return rows, rows.values(places)
    except RowError:
        filled = rows.filled(places)
        if filled is rows:
            raise
        return filled, filled.values(places)


def _columns(rows: Rows, sheet: Sheet, field: str) -> tuple[int | None, int]:
    """Places of the columns of the angle, None for one that is counted, and of the value, from 0."""
    width, names, own_units = rows.columns, rows.heading, UNITS[sheet.quantity]
    if isinstance(sheet.columns, Counted):
        return None, _place(sheet.columns.column, names, width, f"{field}.columns")
    if sheet.columns is not None:
        first, second = (_place(column, names, width, f"{field}.columns") for column in sheet.columns)
        if first == second:
            raise IntentError(f"column {first + 1} cannot be both the {sheet.noun} and the value", f"{field}.columns")
        return first, second
    if width < 2:
        remedy = "for one of displacements alone give columns: {column: 1, step: 2}, the step from row to row"
        raise RowError(f"1 column, and 2 are expected; {remedy}", int(rows.numbers[0]))
    numbered = rows.numbered() if width > 2 else [0, 1]  # of two the numbers are not asked: what is none is told later
    words = [{word.rstrip("0123456789") for word in _words(name)} for name in names]
    known = _LENGTH_NAMES if sheet.length else _ANGLE_NAMES if sheet.period is None else _TIME_NAMES
    angles = [k for k in numbered if names and known & words[k]]
    values = [k for k in numbered if names and _VALUE_NAMES & words[k] and k not in angles]
    if len(numbered) == 2:
        first, second = numbered
        measured = names and (first in values or (sheet.quantity != "angle" and unit_of(names[first]) in own_units))
        return (second, first) if angles == [second] and measured else (first, second)
    if len(angles) == len(values) == 1:
        return angles[0], values[0]
    if names:
        listed, example = ", ".join(map(short, names)), f"[{short(names[0])}, {short(names[1])}]"
    else:
        listed, example = f"{width} without a heading", "[1, 2]"
    comma = rows.mark == "," and not names and "." not in rows.lines[0]
    mark = ": with decimal commas, separate the columns by semicolons" if comma else ""
    problem = f"line {rows.numbers[0]}: the table's columns are {listed}"
    remedy = f"give those of the {sheet.noun} and the value, such as columns: {example}"
    raise IntentError(f"{problem}; {remedy}{mark}", field)


def _place(column: Column, names: tuple[str, ...], width: int, field: str) -> int:
    if isinstance(column, int):
        if not 1 <= column <= width:
            raise IntentError(f"the table has columns 1 to {width}, not {column}", field)
        return column - 1
    if not names:
        raise IntentError(f"the table has no heading with {column!r}; give columns by number, 1 to {width}", field)
    plain = [name.casefold() for name in names]
    wanted = column.strip().casefold()
    places = [k for k, name in enumerate(plain) if name == wanted]
    places = places or [k for k, name in enumerate(names) if wanted in {" ".join(_words(name)), _words(name)[0]}]
    if len(places) != 1:
        many = "stands over several columns" if places else "is no heading of the table"
        raise IntentError(f"{column!r} {many}: they are {', '.join(map(short, names))}", field)
    return places[0]


def _words(name: str) -> list[str]:
    """Words of a heading, in small letters, without its unit: `Lift (in)`, `lift_in`."""
    words = [word for word in re.split(r"[\s_()\[\],/]+", name) if word]
    words = [word if word.casefold() in _WORDS else _DEGREES_OF.sub("", word.casefold(), 1) for word in words]
    return (
        [word.casefold() for word in words if word.casefold() not in _WORDS]
        or [word.casefold() for word in words]
        or [""]
    )


def unit_of(name: str) -> str | None:
    """The unit that a heading ends with, as `lift_in`, `lift [in]` and `load / N m` do."""
    words = [word for word in re.split(r"[\s_()\[\],/*·-]+", name) if word]
    for count in (2, 1):
        tail = "".join(words[-count:]) if len(words) >= count else ""
        for word in (tail, tail.casefold()):
            if word in _WORDS and (count == 1 or word.casefold() in _JOINED):
                return _WORDS[word]
    return None


def _units(rows: Rows, sheet: Sheet, places: tuple[int | None, int], field: str) -> tuple[float, str]:
    """Radians of the cam in one unit of the column of angles, and the name of the unit of the values.

    Raises IntentError where heading and caller differ, or the heading's unit is another quantity's.
    """
    first, second = ("" if k is None else _named(rows, k) for k in places)
    for name in (first, second) if sheet.quantity == "share" else ():
        if (unit := unit_of(name)) is not None:
            remedy = f"{_QUANTITIES[sheet.quantity]} is meant here: name it without a unit, such as u or s"
            raise IntentError(f"the column {short(name)!r} is in {unit}; {remedy}", field)
    unit, known = unit_of(second), UNITS[sheet.quantity]
    if unit is not None and unit not in known:
        if unit in _ANGLE_UNITS or any(unit in units for units in UNITS.values()):
            raise IntentError(
                f"the column {short(second)!r} is in {unit}; {_QUANTITIES[sheet.quantity]} is meant here", field
            )
        unit = None
    if unit is not None and sheet.unit not in {None, unit}:
        raise IntentError(f"the column {short(second)!r} is in {unit}, not in {sheet.unit}", f"{field}.units")
    instead = next(iter(known)) if sheet.instead is None else sheet.instead
    if sheet.length is not None:
        return _mm(first, sheet.length, sheet.angle, field), sheet.unit or unit or instead
    place = places[0]
    wide = False
    if place is not None and sheet.angle is None and _EITHER_NAMES & {*_words(first)}:
        wide = float(np.ptp(_values(rows, [place])[1])) > _CAM_TURN
    return _radians(first, sheet, field, crank=wide), sheet.unit or unit or instead


def _named(rows: Rows, column: int) -> str:
    """Heading of a column, with the unit behind its numbers where it has none itself."""
    name, unit = (texts[column] if column < len(texts) else "" for texts in (rows.heading, rows.units))
    return f"{name} ({unit})" if unit and unit_of(name) is None else name


def _mm(name: str, instead: str, stated: str | None, field: str) -> float:
    """Mm in one unit of the column of lengths of this heading; raises IntentError as `_units` does."""
    known, unit = UNITS["length"], unit_of(name)
    if unit is not None and unit not in known:
        raise IntentError(f"the column {short(name)!r} is in {unit}; {_QUANTITIES['length']} is meant here", field)
    if unit is not None and stated not in {None, unit}:
        raise IntentError(f"the column {short(name)!r} is in {unit}, not in {stated}", f"{field}.length")
    return known[stated or unit or instead]


def _radians(name: str, sheet: Sheet, field: str, *, crank: bool) -> float:
    """Radians of the cam in one unit of the column of angles of this heading; raises IntentError as `_units` does.

    `crank` says that the angles are too wide to be the cam's.
    """
    heading = unit_of(name)
    if heading is None and sheet.period is not None and name.rstrip(")] ").endswith("s"):
        heading = "seconds"
    kind = heading if heading in _ANGLE_UNITS or heading in _TIMES else None
    words = set(_words(name))
    crank = crank or bool(_CRANK_NAMES & words)
    if sheet.angle is None and not crank and _EITHER_NAMES & words:
        problem = f"the column {short(name)!r} may be of the crank or of the cam"
        raise IntentError(f"{problem}; give angle: crank or angle: cam", f"{field}.angle")
    if sheet.angle is not None:
        own = "degrees" if sheet.angle in {"cam", "crank"} else sheet.angle
        if kind not in {None, own} and not (own in _TIMES and kind in _TIMES):
            raise IntentError(f"the column {short(name)!r} is in {kind}, not in {own}", f"{field}.angle")
        if crank and sheet.angle == "cam":
            raise IntentError(f"the column {short(name)!r} is of the crank, not of the cam", f"{field}.angle")
        kind, crank = kind or own, crank or sheet.angle == "crank"
    if kind in _TIMES:
        if sheet.period is None:
            raise IntentError("of times give `period`, the seconds in which the cam turns once", f"{field}.angle")
        return 2.0 * math.pi * _TIMES[kind] / sheet.period
    if sheet.period is not None:
        problem = f"the column {short(name)!r} has angles" if name else "the first column has angles"
        raise IntentError(f"{problem}; give angle: seconds if they are times, or leave it out", f"{field}.period")
    return _ANGLE_UNITS[kind or "degrees"] * (0.5 if crank else 1.0)


def _rounded(angles: Array, half: float) -> float:
    """Rounding of angles (n,): `half` a unit of their last digit if they are evenly spaced to within it, else 0.

    So are 0, 6.7, 13.3 and 20. Exact spacing needs no rounding: 0.
    """
    if len(angles) < _FEW or not np.isfinite(angles).all():
        return 0.0
    off = np.abs(angles - np.linspace(angles[0], angles[-1], len(angles))).max()
    return half if _EXACT * float(np.abs(angles).max()) < off <= 2.0 * half * (1.0 + _EXACT) else 0.0


def _decimals(cells: Sequence[str], values: Array) -> Array:
    """Decimals (n,) to which numbers of each size are written: those of all, or fewer where significant digits end.

    A number may have lost zeros at its end, so it shows no more than what others of its size do. That all have so many
    digits, and not so many decimals, is taken to be where two values more show it.
    """
    shown = np.array([_places(cell) for cell in cells])
    _, first = np.unique(values, return_index=True)
    most = _greatest(shown[first])
    size = np.floor(
        np.log10(np.abs(values), out=np.full(len(values), np.inf), where=(values != 0) & np.isfinite(values))
    )
    real = np.isfinite(size)
    if not real.any():
        return np.full(len(values), most)
    first = first[real[first]]
    digits = _greatest((shown + size)[first])
    either = np.minimum(np.where(real, digits - np.where(real, size, 0.0), most), most)
    ends = np.count_nonzero(shown[first] == either[first]) >= np.count_nonzero(shown[first] == most) + 2
    decimals: Array = np.maximum(either if ends else most, shown)
    return decimals


def _greatest(counts: Array) -> float:
    """Greatest number of digits of different values; of many the second, as one may be a slip."""
    return float(np.sort(counts)[-2 if len(counts) >= _MANY else -1])


def _places(cell: str) -> int:
    """Decimal places that a number shows, fewer by its exponent: 1 for 1.25e1."""
    mantissa, _, exponent = cell.lower().replace(",", ".").replace("d", "e").partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)
