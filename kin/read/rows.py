"""Rows of a table as text: headings, the mark between columns, decimal commas, comments, units behind numbers.

Columns are parted by semicolons, tabs, bars, blanks or commas; a comma is the decimal mark where it does not part. The
lines above the first row are headings: it begins with a number, or has as many cells as the others and two numbers. Of
several the names and units are taken, and a number of rows that stands alone above them is compared. Cells behind the
first row's that are no numbers are comments.
"""

from __future__ import annotations

import io
import re
from contextlib import suppress
from itertools import compress, islice, zip_longest
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, replace
from kin.read.errors import short

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Indices

_LOOKED = 20  # lines from which the mark between columns is found
_NUMBER = re.compile(
    r"[+-]?(?:(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[ed][+-]?\d+)?|nan|inf(?:inity)?)", re.IGNORECASE | re.ASCII
)
_BEHIND = re.compile(r"\s(?:#|!|//).*")  # comment behind a row
_UNIT = re.compile(
    r"(?<=[\d.,])\s*(degrees?|deg|°|rad|turns?|%|mm|cm|[µμu]m|inch|in|thou|mils?|seconds|sec|ms|s|kN|Nm|N|lbf)(?=[\s;,|]|$)"
)
_QUOTED = re.compile(r'"[^"]*"(?:\s*,\s*"[^"]*")+\s*,?$')
_PARTED = re.compile(r'"\s*,\s*"')
_WIDE = re.compile(r"\s{2,}|\t")
_BEHIND_BRACKET = re.compile(r"(?<=[)\]])")
_COMMENTS = ("#", "!", "%", "//")
ROW = r"[^\s#;%!/$]"  # begin of a line that is neither empty nor a comment
_EXCEL = re.compile(r"sep=.$", re.IGNORECASE)  # its word for the mark between columns
_MARKS = {";": "semicolons", "\t": "tabs", "|": "bars", " ": "blanks", ",": "commas"}


class RowError(CamgeoError, ValueError):
    """A text that is no table of numbers; `line` is the number of the line at fault, None for the whole text."""

    def __init__(self, message: str, line: int | None = None) -> None:
        super().__init__(message)
        self.message, self.line = message, line


@dataclass(frozen=True, eq=False)
class Rows:
    """A table as text: its lines of numbers (n), their line numbers from 1, the mark between columns, and the heading.

    Cells of a second line of headings stand in brackets behind the first, as units do: `x (mm)`. `heading` is empty
    where there is none, `units` where none stand behind the numbers of the first row. `commented` are what comments
    above the rows would be as headings, the last one first.
    """

    lines: list[str]
    numbers: Indices
    mark: str
    heading: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    commented: tuple[tuple[str, ...], ...] = ()

    @property
    def width(self) -> int:
        """Number of columns of the heading, or without a heading of the first row."""
        return len(self.heading) or self.columns

    @property
    def columns(self) -> int:
        """Number of columns of the first row, trailing empty ones included where the heading names them."""
        counts = _counts(self.lines[0], self.mark)
        return max(min(counts), len(self.heading))

    def texts(self, column: int) -> list[str]:
        """Cells of a column, counted from 0, as they are written (n); "" where a row has not so many."""
        rows = (_cells(line, self.mark) for line in self.lines)
        return [row[column] if column < len(row) else "" for row in rows]

    def numbered(self) -> list[int]:
        """Columns, counted from 0, in which a number is among the first rows."""
        looked = [_cells(line, self.mark) for line in self.lines[:_LOOKED]]
        return [k for k in range(self.columns) if any(k < len(row) and _NUMBER.fullmatch(row[k]) for row in looked)]

    def filled(self, columns: Sequence[int]) -> Rows:
        """Those rows that are not empty in all of these columns, as shorter ones beside longer ones are at their end.

        Raises RowError where there is none.
        """
        full = [any(cells) for cells in zip(*map(self.texts, columns), strict=True)]
        if all(full):
            return self
        if not any(full):
            raise RowError("these columns are empty", int(self.numbers[0]))
        return replace(self, lines=[*compress(self.lines, full)], numbers=self.numbers[full])

    def values(self, columns: Sequence[int], *, blanks: bool = False) -> Array:
        """Numbers (n, k) of some columns, counted from 0; with `blanks` an empty cell is nan.

        Raises RowError with the first line that has a number more than the heading has names, or no number in one of
        these columns.
        """
        mark = None if self.mark == " " else self.mark
        body = "\n".join(self.lines if mark == "," else [line.replace(",", ".") for line in self.lines])
        if all(len(line.rstrip(mark).split(mark)) <= self.width for line in self.lines):
            with suppress(ValueError, IndexError):  # the row at fault is found below
                file = io.StringIO(body)
                return np.loadtxt(file, delimiter=mark, usecols=columns, comments=None, ndmin=2, quotechar='"')
        numbered = zip(self.lines, self.numbers.tolist(), strict=True)
        return np.array([self._row(line, number, columns, blanks=blanks) for line, number in numbered])

    def _row(self, line: str, number: int, columns: Sequence[int], *, blanks: bool) -> list[float]:
        cells = _cells(line, self.mark)
        count = len(line.split(None if self.mark == " " else self.mark))
        if _numbers(cells[self.width :]) or count <= max(columns):
            problem = f"{count} columns, and {self.width} are expected, parted by {_MARKS[self.mark]}: {short(line)!r}"
            wide = self.mark == "," and len(cells) > self.width
            raise RowError(problem + ": with decimal commas, part the columns by semicolons" * wide, number)
        row = []
        for k in columns:
            cell = cells[k] if k < len(cells) else ""
            if not _NUMBER.fullmatch(cell) and (cell or not blanks):
                problem = f"{short(cell)!r} is not a number" if cell else f"column {k + 1} is empty"
                raise RowError(f"{problem}, in {short(line)!r}", number)
            row.append(float(cell.replace(",", ".").lower().replace("d", "e") or "nan"))
        return row


def read_rows(text: str, comments: tuple[str, ...] = _COMMENTS) -> Rows:
    """Find the rows of a text; lines that begin with one of `comments` are left out.

    Raises RowError for a text without rows, and for one whose first line states another number of rows.
    """
    lines = [(i, line.strip()) for i, line in enumerate(text.lstrip("\ufeff").replace("\u2212", "-").splitlines(), 1)]
    if any(line.startswith("|") for _, line in lines[:_LOOKED]):
        lines = [(i, line.strip("|").strip()) for i, line in lines]
    kept = [
        (i, line)
        for i, line in lines
        if line.strip(";,|:-+\t ") and not line.startswith(comments) and not _EXCEL.match(line)
    ]
    if not kept:
        raise RowError("no row of numbers is among its lines")
    if all(_QUOTED.match(line) for _, line in kept[:_LOOKED]):  # commas within the quotes are decimal ones
        kept = [(i, _PARTED.sub('";"', line)) for i, line in kept]
    kept = [(i, _BEHIND.sub("", line)) if "#" in line or "!" in line or "//" in line else (i, line) for i, line in kept]
    as_written = dict(kept)
    if any(_NUMBER.match(line) and _UNIT.search(line) for _, line in kept[: _LOOKED + 1]):
        kept = [(i, _UNIT.sub("", line) if _NUMBER.match(line) else line) for i, line in kept]
    mark = _mark([line for _, line in kept[1 : _LOOKED + 1] or kept])
    stated, kept = _stated(kept)
    count = _headings([line for _, line in kept], mark)
    rows = kept[count:]
    if stated is None:
        stated, rows = _stated(rows)
    if not rows:
        raise RowError("below its heading there is no row")
    if stated is not None and stated[1] != len(rows):
        remedy = "add the others, or begin this line with # if it states something else"
        raise RowError(f"{stated[1]} rows are stated, and {len(rows)} follow; {remedy}", stated[0])
    behind = [_UNIT.search(cell) for cell in _cells(as_written[rows[0][0]], mark)]
    units = tuple("" if unit is None else unit[1] for unit in behind)
    # headings with as many cells as the rows have columns; a second one's cells go in brackets behind the first's
    first_row = rows[0][1]
    widths = set(_counts(first_row, mark)) | {max(len(_cells(line, mark)) for _, line in rows[:_LOOKED])}
    headings = [_heading(line, mark, widths) for _, line in kept[:count]]
    fitting = [heading for heading in headings if len(heading) in widths] or headings[-1:]
    heading = tuple(
        " ".join([name, *(f"({word.strip('[()]')})" for word in more if word)]).strip()
        for name, *more in zip_longest(*fitting, fillvalue="")  # a line may leave out its last cells
    )
    above = [line.lstrip("#!%/ \t") for i, line in lines if i < rows[0][0] and line.startswith(comments)]
    commented = tuple(tuple(_heading(line, mark, widths)) for line in reversed(above))
    numbers = np.array([i for i, _ in rows], dtype=np.intp)
    return Rows([line for _, line in rows], numbers, mark, heading, units, commented)


def _stated(rows: list[tuple[int, str]]) -> tuple[tuple[int, int] | None, list[tuple[int, str]]]:
    """The line and the number of rows that a first line states alone, or None, and the rows below it.

    Above rows of one number it is that of the rows, or it is one of them.
    """
    if len(rows) > 1 and rows[0][1].isdecimal():
        (line, text), *others = rows
        if int(text) == len(others) or not all(_NUMBER.fullmatch(other) for _, other in others[:_LOOKED]):
            return (line, int(text)), others
    return None, rows


def has_more_rows(text: str, most: int, row: str = ROW) -> bool:
    """Whether more than `most` lines of a text begin with the pattern `row`; they are counted, and none is kept."""
    return next(islice(re.finditer(rf"^[ \t]*{row}", text, re.MULTILINE | re.IGNORECASE), most, None), None) is not None


def _headings(lines: Sequence[str], mark: str) -> int:
    """Number of lines above the first row: up to the last one without numbers, one of a name and a number at least."""
    typical, count = len(_cells(lines[-1], mark)), 0
    for i, line in enumerate(lines):
        cells = _cells(line, mark)
        if (
            _NUMBER.fullmatch(cells[0])
            or (len(cells) == typical and _numbers(cells) >= 2)
            or (not cells[0] and _numbers(cells))
        ):
            break
        if not i or not _numbers(cells):
            count = i + 1
    return count


def _counts(line: str, mark: str) -> tuple[int, int]:
    """Number of cells of a line without and with empty ones at its end."""
    return len(_cells(line, mark)), len(line.split(None if mark == " " else mark))


def _numbers(cells: list[str]) -> int:
    return sum(bool(_NUMBER.fullmatch(cell)) for cell in cells)


def _mark(lines: Sequence[str]) -> str:
    """The mark between columns, by these lines."""
    for mark in (";", "\t", "|"):
        if sum(mark in line for line in lines) * 2 > len(lines):
            return mark
    if all(re.search(r",\s", line) for line in lines):
        return ","
    blanks = sum(bool(re.search(r"\S\s+\S", line)) for line in lines)
    if blanks * 2 <= len(lines):
        return ","
    by_blanks, by_commas = (sum(_numbers(_cells(line, mark)) for line in lines) for mark in (" ", ","))
    return " " if by_blanks >= by_commas else ","  # names beside numbers may have blanks in them


def _cells(line: str, mark: str) -> list[str]:
    """Cells of a line without their quotes, and without empty ones at its end."""
    cells = [cell.strip().strip('"').strip() for cell in (line.split() if mark == " " else line.split(mark))]
    while len(cells) > 1 and not cells[-1]:
        cells.pop()
    return cells


def _heading(line: str, mark: str, widths: set[int]) -> list[str]:
    """Cells of a heading's line, parted by the first mark that gives one of `widths`; the rows' mark is tried first.

    Names of several words stand apart by two blanks, or end with their unit in brackets.
    """
    ways = [_cells(line, parting) for parting in (mark, ";", "\t", ",")]
    ways += [
        [cell.strip('"') for cell in _WIDE.split(line)],
        [cell.strip() for cell in _BEHIND_BRACKET.split(line) if cell.strip()],
    ]
    return next((names for names in ways if len(names) in widths), ways[0])
