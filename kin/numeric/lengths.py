"""Lengths in the words of a verdict: composed in mm, and shown in the unit of the report.

Words are put together in many places that do not know the unit of the report. So a length stands among them as its
whole value and its form, between two characters of Unicode's private use, and becomes digits at the end.

So is the input of a motion, which the words call an angle, in degrees, unless they are shown for a travel.

Places and turns are composed in the axes of a cam that turns clockwise. Their y and their sense are marked, so that
`mirrored` gives them as a file has them that is drawn mirrored.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from kin.numeric.places import ROUNDING

if TYPE_CHECKING:
    from typing import Self

FIRST, LAST = "\ue000", "\ue001"
UNIT = f"{FIRST}{LAST}"
"""The name of the unit, among words."""
_MARKED = re.compile(f"{FIRST}(?:([^{LAST}]*?):([^{LAST}]*?):([123]|y|turn|at|number|noun))?{LAST}")
_POWERS = {"1": 1, "2": 2, "3": 3, "y": 1, "turn": 0}  # of a length in each kind of mark


def length_words(mm: float, form: str = ".6g", power: int = 1) -> str:
    """Mark a length, mm, or by its power an area or volume, to stand among words in a format without its unit."""
    return _mark(mm, form, str(power))


def _mark(value: float, form: str, kind: str) -> str:
    return f"{FIRST}{float(value)!r}:{form}:{kind}{LAST}"


def input_words(value: float, form: str = ".6g") -> str:
    """Mark an input of a motion, a shaft angle in rad or a travel in mm, to be shown with its unit."""
    return _mark(value, form, "at")


def input_number(value: float, form: str = ".6g") -> str:
    """Mark an input of a motion, rad or mm, to be shown without its unit."""
    return _mark(value, form, "number")


INPUT = f"{FIRST}0:s:noun{LAST}"
"""The noun of the input, among words: `angle` or `length`."""


def amount_words(value: float, unit: str, form: str = ".6g") -> str:
    """Text of a figure with its unit, marked as a length where that is mm."""
    return f"{length_words(value, form)} {UNIT}" if unit == "mm" else f"{value:{form}} {unit}"


def span_words(low: float, high: float, form: str = ".9g") -> str:
    """Text "low to high" of two lengths, mm, marked as lengths."""
    return f"{length_words(low, form)} to {length_words(high, form)} {UNIT}"


def place_words(x: float, y: float, digits: int = 6) -> str:
    """Text of a place, mm, in brackets, marked so that `mirrored` changes the sign of y; a size below ROUNDING is 0."""
    return _place(x, y, digits, "y")


def file_place_words(x: float, y: float, digits: int = 6) -> str:
    """Text of a place, mm, in brackets, in the axes of the file itself: `mirrored` leaves it."""
    return _place(x, y, digits, "1")


def _place(x: float, y: float, digits: int, kind_of_y: str) -> str:
    form, (x, y) = f".{digits}g", (0.0 if abs(c) < ROUNDING else c for c in (x, y))
    return f"({_mark(x, form, '1')}, {_mark(y, form, kind_of_y)})"


def turn_words(degrees: float, form: str = ".9g") -> str:
    """Text of a turn, degrees counter-clockwise, without its unit, marked so that `mirrored` changes its sign."""
    return _mark(degrees, form, "turn")


def mirrored(words: str) -> str:
    """Marked words for a drawing mirrored in the x axis: y of each place, and each turn, have the other sign."""

    def other(mark: re.Match[str]) -> str:
        value, form, kind = mark.groups()
        return _mark(0.0 - float(value), form, kind) if kind in {"y", "turn"} else mark[0]

    return _MARKED.sub(other, words)


class Words(str):
    """Words in mm, which remember their marked lengths."""

    __slots__ = ("marked",)
    marked: str

    def __new__(cls, marked: str) -> Self:
        """Show the lengths of marked words in mm, inputs in degrees."""
        words = super().__new__(cls, shown(marked))
        words.marked = marked
        return words

    def __reduce__(self) -> tuple[type[Words], tuple[str]]:
        """Pickle the marked words."""
        return Words, (self.marked,)


def marked(words: str) -> str:
    """Text with the marks of its lengths, to be put among other words."""
    return words.marked if isinstance(words, Words) else words


def in_unit(words: str, mm: float, unit: str, *, travel: bool = False) -> str:
    """Give words with their lengths in a unit of `mm` mm, named `unit`; words without marks as they are.

    Inputs are angles, in degrees, or with `travel` lengths.
    """
    return shown(marked(words), mm, unit, travel=travel)


def shown(words: str, mm: float = 1.0, unit: str = "mm", *, travel: bool = False) -> str:
    """Show the lengths of marked words in a unit of `mm` mm, and its name `unit`.

    Inputs are angles, in degrees, or with `travel` lengths.
    """

    def digits(mark: re.Match[str]) -> str:
        value, form, kind = mark.groups()
        if value is None:
            return unit
        if kind == "noun":
            return "length" if travel else "angle"
        if kind in {"at", "number"}:
            number = f"{float(value) / mm if travel else math.degrees(float(value)):{form}}"
            return number if kind == "number" else f"{number} {unit if travel else 'degrees'}"
        return f"{float(value) / mm ** _POWERS[kind]:{form}}"

    return _MARKED.sub(digits, words)
