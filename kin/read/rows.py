"""Rows of a table as text: headings, the mark between columns, decimal commas, comments.

Columns are parted by semicolons, tabs, blanks or commas; a comma is the decimal mark where it does not part. The first
line is a heading unless it begins with a number or has two; so are lines below it that have none, such as one of units.
"""

from __future__ import annotations

import io
import re
from contextlib import suppress
from itertools import takewhile, zip_longest
from typing import TYPE_CHECKING

import numpy as np

from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Indices

SHOWN = 40  # characters of a line in a message
_LOOKED = 20  # lines from which the mark between columns is found
_NUMBER = re.compile(r"[+-]?(?:(?:\d+[.,]?\d*|[.,]\d+)(?:e[+-]?\d+)?|nan|inf(?:inity)?)", re.IGNORECASE | re.ASCII)
_EXCEL = re.compile(r"sep=.$", re.IGNORECASE)  # its word for the mark between columns
_MARKS = {";": "semicolons", "\t": "tabs", " ": "blanks", ",": "commas"}


class RowError(CamgeoError, ValueError):
    """A text that is no table of numbers; `line` is the number of the line at fault, None for the whole text."""

    def __init__(self, message: str, line: int | None = None) -> None:
        super().__init__(message)
        self.message, self.line = message, line


@dataclass(frozen=True, eq=False)
class Rows:
    """A table as text: its lines of numbers (n), their line numbers from 1, the mark between columns, and the heading.

    Cells of a second line of headings stand in brackets behind the first, as units do: `x (mm)`. `heading` is empty
    where there is none.
    """

    lines: list[str]
    numbers: Indices
    mark: str
    heading: tuple[str, ...] = ()

    @property
    def width(self) -> int:
        """Number of columns of the heading, or without a heading of the first row."""
        return len(self.heading) or self.columns

    @property
    def columns(self) -> int:
        """Number of columns of the first row, trailing empty ones included where the heading names them."""
        line, mark = self.lines[0], None if self.mark == " " else self.mark
        count = len(line.split(mark))
        return count if len(self.heading) == count else len(_cells(line, self.mark))

    def texts(self, column: int) -> list[str]:
        """Cells of a column, counted from 0, as they are written (n); "" where a row has not so many."""
        rows = (_cells(line, self.mark) for line in self.lines)
        return [row[column] if column < len(row) else "" for row in rows]

    def values(self, columns: Sequence[int], *, blanks: bool = False) -> Array:
        """Numbers (n, k) of some columns, counted from 0; with `blanks` an empty cell is nan.

        Raises RowError with the first line that has more columns than the heading, or no number in one of these
        columns.
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
        if len(cells) > self.width or count <= max(columns):
            problem = f"{count} columns, and {self.width} are expected, parted by {_MARKS[self.mark]}: {short(line)!r}"
            wide = self.mark == "," and len(cells) > self.width
            raise RowError(problem + ": with decimal commas, part the columns by semicolons" * wide, number)
        row = []
        for k in columns:
            cell = cells[k] if k < len(cells) else ""
            if not _NUMBER.fullmatch(cell) and (cell or not blanks):
                problem = f"{short(cell)!r} is not a number" if cell else f"column {k + 1} is empty"
                raise RowError(f"{problem}, in {short(line)!r}", number)
            row.append(float(cell.replace(",", ".") or "nan"))
        return row


def read_rows(text: str, comments: tuple[str, ...] = ("#",)) -> Rows:
    """Find the rows of a text; lines that begin with one of `comments` are left out.

    Raises RowError for a text without rows.
    """
    lines = [(i, line.strip()) for i, line in enumerate(text.lstrip("\ufeff").splitlines(), 1)]
    kept = [(i, line) for i, line in lines if line and not line.startswith(comments) and not _EXCEL.match(line)]
    if not kept:
        raise RowError("no row of numbers is among its lines")
    # lines of headings: the first, unless it has numbers, and those without numbers below it
    mark = _mark([line for _, line in kept[1 : _LOOKED + 1] or kept])
    count = 0
    if _is_heading(kept[0][1], mark):
        count = 1 + len(list(takewhile(lambda row: not _numbers(_cells(row[1], mark)), kept[1:])))
    rows = kept[count:]
    if not rows:
        raise RowError("below its heading there is no row")
    # headings with as many cells as the rows have columns; a second one's cells go in brackets behind the first's
    first = rows[0][1]
    widths = {len(_cells(first, mark)), len(first.split(None if mark == " " else mark))}
    headings = [_heading(line, mark, widths) for _, line in kept[:count]]
    fitting = [heading for heading in headings if len(heading) in widths] or headings[-1:]
    heading = tuple(
        " ".join([name, *(f"({word.strip('[()]')})" for word in more if word)]).strip()
        for name, *more in zip_longest(*fitting, fillvalue="")  # a line may leave out its last cells
    )
    return Rows([line for _, line in rows], np.array([i for i, _ in rows], dtype=np.intp), mark, heading)


def short(text: str) -> str:
    """Text, cut to SHOWN characters for a message."""
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."


def _is_heading(line: str, mark: str) -> bool:
    cells = _cells(line, mark)
    return not _NUMBER.fullmatch(cells[0]) and _numbers(cells) < 2


def _numbers(cells: list[str]) -> int:
    return sum(bool(_NUMBER.fullmatch(cell)) for cell in cells)


def _mark(lines: Sequence[str]) -> str:
    """The mark between columns, by these lines."""
    for mark in (";", "\t"):
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
    """Cells of a heading's line, parted by the first mark that gives one of `widths`; the rows' mark is tried first."""
    ways = [_cells(line, parting) for parting in (mark, ";", "\t", ",")]
    return next((names for names in ways if len(names) in widths), ways[0])
