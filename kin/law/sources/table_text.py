"""Lift tables as text: two columns, decimal points or commas, cam or crank degrees, mm, inches or thousandths."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Literal

import numpy as np

from kin.law.programme import IntentError
from kin.law.sources.ring import Samples
from kin.law.sources.tabled import TableError

if TYPE_CHECKING:
    from kin.numeric.arrays import Array

MM_PER_INCH = 25.4
_FEW = 3  # angles
_EXACT = 1e-9  # of the greatest angle: what is less is no rounding of digits

_NUMBER = re.compile(r"[+-]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[+-]?[0-9]+)?|nan|inf(?:inity)?)", re.IGNORECASE)
_SEPARATORS = {";": "semicolons", "\t": "tabs", " ": "blanks", ",": "commas"}


def read_table(
    text: str,
    *,
    angles: Literal["cam", "crank"] = "cam",
    unit: Literal["mm", "inch", "thou", "degrees", "N"] = "mm",
    field: str = "motion.table",
) -> tuple[Samples, float]:
    """Read rows `angle, displacement`: angles become radians of the cam, displacements mm (degrees: radians).

    With the unit N the rows are loads and stay as they are.

    Also returns the unit of the last place that any displacement shows. Columns are parted by semicolons, tabs or
    blanks (a comma is then the decimal mark where it is one), or else by commas. Empty lines, lines that start with #
    and one heading are passed over. Crank degrees are twice the cam's. Raises TableError with the line.
    """
    lines = text.lstrip("\ufeff").splitlines()
    kept = [(i, line.strip()) for i, line in enumerate(lines, 1)]
    kept = [(i, line) for i, line in kept if line and not line.startswith("#")]
    if not kept:
        raise IntentError("the table is empty", field)
    separator = _separator([line for _, line in kept])
    if not re.match(r'["\s]*[+-]?[.,]?\d', kept[0][1]):
        kept = kept[1:]  # a heading
    theta, s, places, digits = np.empty(len(kept)), np.empty(len(kept)), 0, 0
    for row, (i, line) in enumerate(kept):
        cells = _numbers(line, separator)
        if not cells:
            raise _unread(line, separator, i, field, "load" if unit == "N" else "displacement")
        theta[row], s[row] = float(cells[0]), float(cells[1])
        places, digits = max(places, _places(cells[1])), max(digits, _places(cells[0]))
    turned = 2.0 if angles == "crank" else 1.0
    degree = math.pi / 180 / turned
    slack = _rounded(theta, 0.5 * 10.0**-digits) * degree
    theta *= degree
    scale = {"mm": 1.0, "inch": MM_PER_INCH, "thou": MM_PER_INCH / 1000, "degrees": math.pi / 180, "N": 1.0}[unit]
    numbers = np.array([i for i, _ in kept], dtype=np.intp)
    return Samples(theta, s * scale, numbers, scale, slack, turned), scale * 10.0**-places


def _rounded(angles: Array, half: float) -> float:
    """Half of the last digit of angles that are even but for it, as 6.7 and 13.3 are; 0 of others."""
    if len(angles) < _FEW or not np.isfinite(angles).all():
        return 0.0
    off = np.abs(angles - np.linspace(angles[0], angles[-1], len(angles))).max()
    return half if _EXACT * float(np.abs(angles).max()) < off <= 2.0 * half * (1.0 + _EXACT) else 0.0


def _separator(lines: list[str]) -> str:
    """The mark between columns, by the first twenty lines."""
    head = lines[:20]
    for mark in (";", "\t"):
        if sum(mark in line for line in head) * 2 > len(head):
            return mark
    if all(re.search(r",\s", line) for line in head[1:] or head):
        return ","
    parted = sum(bool(re.search(r"\S\s+\S", line)) for line in head[1:] or head)
    return " " if parted * 2 > len(head[1:] or head) else ","


def _numbers(line: str, separator: str) -> tuple[str, str] | None:
    """The two cells of a line as numbers are written in Python, or None where there are not two numbers."""
    cells = line.split() if separator == " " else line.split(separator)
    while len(cells) > 1 and not cells[-1].strip():
        cells.pop()
    if len(cells) != 2:
        return None
    first, second = (cell.strip().strip('"').replace(",", ".") for cell in cells)
    return (first, second) if _NUMBER.fullmatch(first) and _NUMBER.fullmatch(second) else None


def _unread(line: str, separator: str, number: int, field: str, quantity: str) -> TableError:
    shown = line if len(line) <= 40 else f"{line[:37]}..."
    hint = f"an angle and a {quantity} are expected"
    if separator == "," and line.count(",") > 1:
        hint += ": with decimal commas, separate the columns by semicolons"
    return TableError(f"{shown!r} is not a row separated by {_SEPARATORS[separator]}: {hint}", field, number)


def _places(cell: str) -> int:
    """Decimal places that a number shows."""
    mantissa, _, exponent = cell.lower().partition("e")
    return len(mantissa.partition(".")[2]) - int(exponent or 0)
