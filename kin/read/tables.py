"""Tables of motions and loads as text: columns by heading or number, in the units of the headings or of the caller."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from kin.law.programme import IntentError
from kin.law.sources.ring import Samples
from kin.law.sources.tabled import TableError
from kin.numeric.records import replace
from kin.read.rows import RowError, Rows, read_rows

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

AngleUnit: TypeAlias = Literal["cam", "crank", "radians", "turns", "percent"]
Quantity: TypeAlias = Literal["length", "angle", "force", "moment", "share"]
Column: TypeAlias = str | int

_MM, _DEGREE, _LBF = 1.0, math.pi / 180, 4.4482216152605
UNITS: dict[Quantity, dict[str, float]] = {
    "length": {"mm": _MM, "inch": 25.4, "thou": 0.0254, "cm": 10.0, "m": 1000.0},
    "angle": {"degrees": _DEGREE, "radians": 1.0},
    "force": {"N": 1.0, "kN": 1000.0, "lbf": _LBF},
    "moment": {"Nm": 1.0, "lbf in": _LBF * 0.0254, "lbf ft": _LBF * 0.3048},
    "share": {"": 1.0},
}
"""One unit of a column as mm, rad, N or N m; shares have none, nor have the angles beside them."""

_WORDS = (
    {word: word for units in UNITS.values() for word in units if word and " " not in word}
    | {"in": "inch", "inches": "inch", '"': "inch", "mil": "thou", "mils": "thou", "thous": "thou"}
    | {"deg": "degrees", "degree": "degrees", "°": "degrees", "rad": "radians", "radian": "radians"}
    | {"n": "N", "kn": "kN", "nm": "Nm", "lbs": "lbf", "lb": "lbf", "lbfin": "lbf in", "lbfft": "lbf ft"}
    | {"turn": "turns", "turns": "turns", "rev": "turns", "revs": "turns"}
    | {"%": "percent", "percent": "percent", "pct": "percent"}
)  # units of headings, in small letters but for those that mean something else then
_ANGLE_UNITS = {"degrees": _DEGREE, "radians": 1.0, "turns": 2 * math.pi, "percent": math.pi / 50}
_QUANTITIES: dict[Quantity, str] = {
    "length": "a length",
    "angle": "an angle",
    "force": "a force",
    "moment": "a moment",
    "share": "a share from 0 to 1 of a law's stroke or of its angle",
}
_JOINED = {"nm", "lbfin", "lbfft"}  # units of two words
_ANGLE_NAMES = {"angle", "phi", "theta", "cam", "crank", "shaft", "rotation", "deg", "°", "rad", "degrees", "radians"}
_VALUE_NAMES = {"lift", "s", "displacement", "stroke", "position", "rise", "travel", "swing", "load", "force", "torque"}
_FEW = 3  # angles
_EXACT = 1e-9  # of the greatest angle: what is less is no rounding of digits


class Sheet(NamedTuple):
    """How a table is read: its quantity, and what the caller states of columns and units, None where the file does.

    Columns are those of the angle and of the value, by their heading or their number from 1. The angles "cam" and
    "crank" are degrees of that shaft. Units of values are keys of `UNITS` for the quantity; `instead` is the unit where
    neither caller nor heading states one, None for the first of them.
    """

    quantity: Quantity
    columns: tuple[Column, Column] | None = None
    angle: AngleUnit | None = None
    unit: str | None = None  # of the values
    instead: str | None = None
    scale: float = 1.0
    offset: float = 0.0  # in the values' unit, after the scale


LENGTHS = Sheet("length")
"""Sheet of lengths over cam degrees, in mm where the heading says nothing else."""


def read_table(text: str, sheet: Sheet = LENGTHS, field: str = "motion.table") -> tuple[Samples, float]:
    """Read rows of an angle and a value: angles become radians of the cam, values mm, rad, N or N m.

    Also returns the size of one unit in the last decimal that any value shows, after the scale, in the values' unit.
    Empty lines, lines that start with # and headings are passed over; units of headings are taken. `field` names the
    table in errors. Raises TableError, with the line, for a row that is no angle and value; IntentError for a text
    without rows, columns that are missing or ambiguous, and units that contradict the heading or the quantity.
    """
    try:
        rows = read_rows(text)
        if len(rows.heading) != rows.columns:
            rows = replace(rows, heading=())  # a title
        first, second = _columns(rows, sheet, field)
        degree, unit = _units(rows, sheet, (first, second), field)
        theta, values = rows.values([first, second]).T
    except RowError as error:
        if error.line is None:
            raise IntentError(error.message, field) from None
        quantity = "load" if sheet.quantity in {"force", "moment"} else "displacement"
        raise TableError(f"{error.message}; an angle and a {quantity} are expected", field, error.line) from None
    digits, places = (max(map(_places, rows.texts(k))) for k in (first, second))
    slack = _rounded(theta, 0.5 * 10.0**-digits) * degree
    size = UNITS[sheet.quantity][unit]
    shown = UNITS["angle"]["degrees"] if sheet.quantity == "angle" else size
    values = (values * sheet.scale + sheet.offset) * size
    samples = Samples(theta * degree, values, rows.numbers, shown, slack, _DEGREE / degree)
    return samples, abs(sheet.scale) * size * 10.0**-places


def _columns(rows: Rows, sheet: Sheet, field: str) -> tuple[int, int]:
    """Places of the columns of the angle and of the value, from 0."""
    width, names = rows.columns, rows.heading
    if sheet.columns is not None:
        first, second = (_place(column, names, width, f"{field}.columns") for column in sheet.columns)
        if first == second:
            raise IntentError(f"column {first + 1} cannot be both the angle and the value", f"{field}.columns")
        return first, second
    if width == 2:
        return 0, 1
    if width < 2:
        raise RowError("1 column, and 2 are expected", int(rows.numbers[0]))
    if names:
        words = [_words(name) for name in names]
        angles = [k for k, name in enumerate(words) if _ANGLE_NAMES.intersection(name)]
        values = [k for k, name in enumerate(words) if _VALUE_NAMES.intersection(name) and k not in angles]
        if len(angles) == len(values) == 1:
            return angles[0], values[0]
        listed, example = ", ".join(names), f"[{names[0]}, {names[1]}]"
    else:
        listed, example = f"{width} without a heading", "[1, 2]"
    comma = rows.mark == "," and not names and "." not in rows.lines[0]
    mark = ": with decimal commas, separate the columns by semicolons" if comma else ""
    listing = (
        f"line {rows.numbers[0]}: the table's columns are {listed}; give those of the angle and the value, such as"
    )
    raise IntentError(f"{listing} columns: {example}{mark}", field)


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
        raise IntentError(f"{column!r} {many}: they are {', '.join(names)}", field)
    return places[0]


def _words(name: str) -> list[str]:
    """Words of a heading, in small letters, without its unit: `Lift (in)`, `lift_in`."""
    words = [word for word in re.split(r"[\s_()\[\],/]+", name) if word]
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


def _units(rows: Rows, sheet: Sheet, places: tuple[int, int], field: str) -> tuple[float, str]:
    """Radians of the cam in one unit of the column of angles, and the name of the unit of the values.

    Raises IntentError where heading and caller differ, or the heading's unit is another quantity's.
    """
    first, second = (rows.heading[k] for k in places) if rows.heading else ("", "")
    for name in (first, second) if sheet.quantity == "share" else ():
        if (unit := unit_of(name)) is not None:
            remedy = f"{_QUANTITIES[sheet.quantity]} is meant here: name it without a unit, such as u or s"
            raise IntentError(f"the column {name!r} is in {unit}; {remedy}", field)
    heading = unit_of(first)
    kind = heading if heading in _ANGLE_UNITS else None
    crank = "crank" in _words(first)
    if sheet.angle is not None:
        own = "degrees" if sheet.angle in {"cam", "crank"} else sheet.angle
        if kind not in {None, own}:
            raise IntentError(f"the column {first!r} is in {kind}, not in {own}", f"{field}.angle")
        if crank and sheet.angle == "cam":
            raise IntentError(f"the column {first!r} is of the crank, not of the cam", f"{field}.angle")
        kind, crank = own, crank or sheet.angle == "crank"
    unit, known = unit_of(second), UNITS[sheet.quantity]
    if unit is not None and unit not in known:
        if unit in _ANGLE_UNITS or any(unit in units for units in UNITS.values()):
            raise IntentError(f"the column {second!r} is in {unit}; {_QUANTITIES[sheet.quantity]} is meant here", field)
        unit = None
    if unit is not None and sheet.unit not in {None, unit}:
        raise IntentError(f"the column {second!r} is in {unit}, not in {sheet.unit}", f"{field}.units")
    instead = next(iter(known)) if sheet.instead is None else sheet.instead
    return _ANGLE_UNITS[kind or "degrees"] * (0.5 if crank else 1.0), sheet.unit or unit or instead


def _rounded(angles: Array, half: float) -> float:
    """Rounding of angles (n,): `half` a unit of their last digit if they are evenly spaced to within it, else 0.

    So are 0, 6.7, 13.3 and 20. Exact spacing needs no rounding: 0.
    """
    if len(angles) < _FEW or not np.isfinite(angles).all():
        return 0.0
    off = np.abs(angles - np.linspace(angles[0], angles[-1], len(angles))).max()
    return half if _EXACT * float(np.abs(angles).max()) < off <= 2.0 * half * (1.0 + _EXACT) else 0.0


def _places(cell: str) -> int:
    """Decimal places that a number shows, fewer by its exponent: 1 for 1.25e1."""
    mantissa, _, exponent = cell.lower().replace(",", ".").partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)
