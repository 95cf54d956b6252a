"""Tables as text: columns by heading or number, decimal points or commas, units as headings or whoever reads say."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from kin.law.programme import IntentError
from kin.law.sources.ring import Samples
from kin.law.sources.tabled import TableError

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

AngleUnit: TypeAlias = Literal["cam", "crank", "radians", "turns", "percent"]
Quantity: TypeAlias = Literal["length", "angle", "force", "moment"]
Column: TypeAlias = str | int

_MM, _DEGREE, _LBF = 1.0, math.pi / 180, 4.4482216152605
UNITS: dict[Quantity, dict[str, float]] = {
    "length": {"mm": _MM, "inch": 25.4, "thou": 0.0254, "cm": 10.0, "m": 1000.0},
    "angle": {"degrees": _DEGREE, "radians": 1.0},
    "force": {"N": 1.0, "kN": 1000.0, "lbf": _LBF},
    "moment": {"Nm": 1.0, "lbf in": _LBF * 0.0254, "lbf ft": _LBF * 0.3048},
}
"""One unit of a column as mm, rad, N or N m."""

_WORDS = (
    {word: word for units in UNITS.values() for word in units if " " not in word}
    | {"in": "inch", "inches": "inch", '"': "inch", "mil": "thou", "mils": "thou", "thous": "thou"}
    | {"deg": "degrees", "degree": "degrees", "°": "degrees", "rad": "radians", "radian": "radians"}
    | {"n": "N", "kn": "kN", "nm": "Nm", "lbs": "lbf", "lb": "lbf", "lbfin": "lbf in", "lbfft": "lbf ft"}
    | {"turn": "turns", "turns": "turns", "rev": "turns", "revs": "turns"}
    | {"%": "percent", "percent": "percent", "pct": "percent"}
)  # units of headings, in small letters but for those that mean something else then
_ANGLE_UNITS = {"degrees": _DEGREE, "radians": 1.0, "turns": 2 * math.pi, "percent": math.pi / 50}
_MEANT: dict[Quantity, str] = {"length": "a length", "angle": "an angle", "force": "a force", "moment": "a moment"}
_JOINED = {"nm", "lbfin", "lbfft"}  # units of two words
_PAIR = 2  # columns of a table that has no others
_ANGLE_NAMES = {"angle", "phi", "theta", "cam", "crank", "shaft", "rotation", "deg", "°", "rad", "degrees", "radians"}
_VALUE_NAMES = {"lift", "s", "displacement", "stroke", "position", "rise", "travel", "swing", "load", "force", "torque"}
_NUMBER = re.compile(r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[+-]?[0-9]+)?|nan|inf(?:inity)?)", re.IGNORECASE)
_SEPARATORS = {";": "semicolons", "\t": "tabs", " ": "blanks", ",": "commas"}
_FEW = 3  # angles
_EXACT = 1e-9  # of the greatest angle: what is less is no rounding of digits


class Sheet(NamedTuple):
    """What a table is to be read as: units and columns that are given, None where the file tells."""

    quantity: Quantity
    columns: tuple[Column, Column] | None = None
    angle: AngleUnit | None = None
    unit: str | None = None  # of the values
    instead: str = "mm"  # their unit where neither says
    scale: float = 1.0
    offset: float = 0.0  # in the values' unit, after the scale


class Cells(NamedTuple):
    """Cells of a text (n rows), the line of each row, and the heading's, None without one."""

    rows: list[list[str]]
    lines: list[int]
    heading: list[str] | None
    separator: str


LENGTHS = Sheet("length")
"""Of cam degrees and mm, where the heading says nothing else."""


def read_table(text: str, sheet: Sheet = LENGTHS, field: str = "motion.table") -> tuple[Samples, float]:
    """Read rows of an angle and a value: angles become radians of the cam, values mm, rad, N or N m.

    Also returns the unit of the last place that any value shows, by the scale. Columns are parted by semicolons, tabs
    or blanks (a comma is then the decimal mark where it is one), or else by commas. Empty lines, lines that start with
    # and one heading are passed over; its units are taken. Raises TableError with the line of what is no row, and
    IntentError for columns that are not there or not one, and units that contradict the heading's.
    """
    cells = _cells(text, field)
    first, second = _columns(cells, sheet, field)
    degree, unit = _units(cells, sheet, (first, second), field)
    columns = [[_plain(row[k]) if k < len(row) else "" for row in cells.rows] for k in (first, second)]
    theta, values = (_numbers(column, cells, sheet, field) for column in columns)
    places, digits = (max(map(_places, column)) for column in (columns[1], columns[0]))
    slack = _rounded(theta, 0.5 * 10.0**-digits) * degree
    size = UNITS[sheet.quantity][unit]
    shown = UNITS["angle"]["degrees"] if sheet.quantity == "angle" else size
    values = (values * sheet.scale + sheet.offset) * size
    lines = np.array(cells.lines, dtype=np.intp)
    samples = Samples(theta * degree, values, lines, shown, slack, _DEGREE / degree)
    return samples, abs(sheet.scale) * size * 10.0**-places


def _cells(text: str, field: str) -> Cells:
    lines = text.lstrip("\ufeff").splitlines()
    kept = [(i, line.strip()) for i, line in enumerate(lines, 1)]
    kept = [(i, line) for i, line in kept if line and not line.startswith("#")]
    if not kept:
        raise IntentError("the table is empty", field)
    body = kept if _is_numeric(kept[0][1]) else kept[1:]
    if not body:
        raise IntentError("the table has a heading and no rows", field)
    separator = _separator([line for _, line in body])
    rows = [_split(line, separator) for _, line in body]
    heading = None
    if len(body) < len(kept):
        heading = _heading(kept[0][1], separator, len(rows[0]))
    return Cells(rows, [i for i, _ in body], heading, separator)


def _is_numeric(line: str) -> bool:
    """Whether a line begins with a number that ends there, and is so no heading as `2nd cam` is."""
    return re.match(r'["\s]*[+-]?[.,]?\d[\d.,]*(?:[eE][+-]?\d+)?(?=["\s;,\t]|$)', line) is not None


def _separator(lines: list[str]) -> str:
    """The mark between columns, by the first twenty rows."""
    head = lines[:20]
    for mark in (";", "\t"):
        if sum(mark in line for line in head) * 2 > len(head):
            return mark
    if all(re.search(r",\s", line) for line in head):
        return ","
    parted = sum(bool(re.search(r"\S\s+\S", line)) for line in head)
    return " " if parted * 2 > len(head) else ","


def _split(line: str, separator: str) -> list[str]:
    """Cells of a line, without empty ones at its end."""
    cells = line.split() if separator == " " else line.split(separator)
    while len(cells) > 1 and not cells[-1].strip():
        cells.pop()
    return cells


def _heading(line: str, separator: str, count: int) -> list[str] | None:
    """Names of the columns; None of a line that has not as many."""
    for mark in (separator, ";", "\t", ","):
        names = [cell.strip().strip('"').strip() for cell in _split(line, mark)]
        if len(names) == count:
            return names
    return None


def _columns(cells: Cells, sheet: Sheet, field: str) -> tuple[int, int]:
    """Places of the columns of the angle and of the value."""
    width, names = len(cells.rows[0]), cells.heading
    if sheet.columns is not None:
        first, second = (_place(column, names, width, f"{field}.columns") for column in sheet.columns)
        if first == second:
            raise IntentError(f"column {first + 1} cannot be both the angle and the value", f"{field}.columns")
        return first, second
    if width == 2:
        return 0, 1
    if width < 2:
        raise _unread(cells, 0, sheet, field)
    if names is not None:
        words = [_words(name) for name in names]
        angles = [k for k, name in enumerate(words) if _ANGLE_NAMES.intersection(name)]
        values = [k for k, name in enumerate(words) if _VALUE_NAMES.intersection(name) and k not in angles]
        if len(angles) == len(values) == 1:
            return angles[0], values[0]
        listed, example = ", ".join(names), f"[{names[0]}, {names[1]}]"
    else:
        listed, example = f"{width} without a heading", "[1, 2]"
    comma = cells.separator == "," and names is None
    mark = ": with decimal commas, separate the columns by semicolons" if comma else ""
    told = f"line {cells.lines[0]}: the table's columns are {listed}; give those of the angle and the value, such as"
    raise IntentError(f"{told} columns: {example}{mark}", field)


def _place(column: Column, names: list[str] | None, width: int, field: str) -> int:
    if isinstance(column, int):
        if not 1 <= column <= width:
            raise IntentError(f"the table has columns 1 to {width}, not {column}", field)
        return column - 1
    if names is None:
        raise IntentError(f"the table has no heading with {column!r}; give columns by number, 1 to {width}", field)
    plain = [name.casefold() for name in names]
    wanted = column.strip().casefold()
    found = [k for k, name in enumerate(plain) if name == wanted]
    found = found or [k for k, name in enumerate(names) if wanted in {" ".join(_words(name)), _words(name)[0]}]
    if len(found) != 1:
        many = "stands over several columns" if found else "is no heading of the table"
        raise IntentError(f"{column!r} {many}: they are {', '.join(names)}", field)
    return found[0]


def _words(name: str) -> list[str]:
    """Words of a heading, in small letters, without its unit: `Lift (in)`, `lift_in`."""
    words = [word for word in re.split(r"[\s_()\[\],/]+", name) if word]
    return (
        [word.casefold() for word in words if word.casefold() not in _WORDS]
        or [word.casefold() for word in words]
        or [""]
    )


def _unit_of(name: str) -> str | None:
    """The unit that a heading ends with, as `lift_in`, `lift [in]` and `load / N m` do."""
    words = [word for word in re.split(r"[\s_()\[\],/*·-]+", name) if word]
    for count in (2, 1):
        tail = "".join(words[-count:]) if len(words) >= count else ""
        for word in (tail, tail.casefold()):
            if word in _WORDS and (count == 1 or word.casefold() in _JOINED):
                return _WORDS[word]
    return None


def _units(cells: Cells, sheet: Sheet, places: tuple[int, int], field: str) -> tuple[float, str]:
    """One unit of the angles in rad of the cam, and the unit of the values.

    IntentError where heading and caller differ, or the heading's unit is another quantity's.
    """
    first, second = ("", "") if cells.heading is None else (cells.heading[k] for k in places)
    said = _unit_of(first)
    kind = said if said in _ANGLE_UNITS else None
    crank = "crank" in _words(first)
    if sheet.angle is not None:
        given = "degrees" if sheet.angle in {"cam", "crank"} else sheet.angle
        if kind not in {None, given}:
            raise IntentError(f"the column {first!r} is in {kind}, not in {given}", f"{field}.angle")
        if crank and sheet.angle == "cam":
            raise IntentError(f"the column {first!r} is of the crank, not of the cam", f"{field}.angle")
        kind, crank = given, crank or sheet.angle == "crank"
    unit, known = _unit_of(second), UNITS[sheet.quantity]
    if unit is not None and unit not in known:
        if unit in _ANGLE_UNITS or any(unit in units for units in UNITS.values()):
            raise IntentError(f"the column {second!r} is in {unit}; {_MEANT[sheet.quantity]} is meant here", field)
        unit = None
    if unit is not None and sheet.unit not in {None, unit}:
        raise IntentError(f"the column {second!r} is in {unit}, not in {sheet.unit}", f"{field}.units")
    return _ANGLE_UNITS[kind or "degrees"] * (0.5 if crank else 1.0), sheet.unit or unit or sheet.instead


def _numbers(column: list[str], cells: Cells, sheet: Sheet, field: str) -> Array:
    """Numbers of a column; TableError with the line of what is none."""
    width = len(cells.rows[0])
    for i, (cell, row) in enumerate(zip(column, cells.rows, strict=True)):
        if not _NUMBER.fullmatch(cell) or (width == _PAIR and len(row) != width):
            raise _unread(cells, i, sheet, field)
    return np.array([float(cell) for cell in column])


def _plain(cell: str) -> str:
    """A number as it is written in Python."""
    return cell.strip().strip('"').strip().replace(",", ".")


def _unread(cells: Cells, i: int, sheet: Sheet, field: str) -> TableError:
    line = {" ": " "}.get(cells.separator, cells.separator).join(cells.rows[i])
    shown = line if len(line) <= 40 else f"{line[:37]}..."
    quantity = "load" if sheet.quantity in {"force", "moment"} else "displacement"
    hint = f"an angle and a {quantity} are expected"
    if cells.separator == "," and line.count(",") > 1:
        hint += ": with decimal commas, separate the columns by semicolons"
    return TableError(
        f"{shown!r} is not a row separated by {_SEPARATORS[cells.separator]}: {hint}", field, cells.lines[i]
    )


def _rounded(angles: Array, half: float) -> float:
    """Half of the last digit of angles that are even but for it, as 6.7 and 13.3 are; 0 of others."""
    if len(angles) < _FEW or not np.isfinite(angles).all():
        return 0.0
    off = np.abs(angles - np.linspace(angles[0], angles[-1], len(angles))).max()
    return half if _EXACT * float(np.abs(angles).max()) < off <= 2.0 * half * (1.0 + _EXACT) else 0.0


def _places(cell: str) -> int:
    """Decimal places that a number shows."""
    mantissa, _, exponent = cell.lower().partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)
