"""Tables of displacements over angles or lengths: their file is read with the recipe, and not needed later."""

from __future__ import annotations

import re
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from camgeo.schema.errors import quote
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm
from camgeo.schema.file_bytes import read_bytes
from camgeo.schema.json_schema import table_schema
from camgeo.schema.scalars import MOST_TEXT, Complaint
from camgeo.schema.yaml_source import Mapping, Scalar, Sequence, describe, join
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.sources.ring import Samples
    from kin.read.tables import Column, Counted, Quantity, Sheet

MAX_BYTES = 16_000_000
MAX_ROWS = 200_000
MAX_LINES = 2 * MAX_ROWS  # with headings, comments and empty lines
MOST_WRITTEN = 3000  # rows in a recipe, which as a text has at most 10,000 parts
_PAIR = 2  # numbers of a row at least
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_FIELD = "table"
_FEWER = "leave rows out; a row for each hundredth of a degree or millimetre will do"


class Origin(NamedTuple):
    """Source of a table's rows: the path of a file, or a name and the rows' text where they stand in the recipe.

    `text` is None for a file.
    """

    name: str
    text: str | None = None


@dataclass(frozen=True)
class Rows:
    """Rows of a table: inputs `theta`, rad or mm, displacements `s`, mm or rad, or loads, and their lines in the file.

    `unit` is the file's unit of displacement in mm or rad; rounding may have moved inputs by up to `slack`, and each
    displacement by up to `rounding`, mm or rad; one degree is `turned` units of the file's angles.
    """

    theta: tuple[float, ...]
    s: tuple[float, ...]
    lines: tuple[int, ...]
    rounding: tuple[float, ...]
    unit: float
    slack: float = 0.0
    turned: float = 1.0

    def samples(self) -> Samples:
        """Rows as arrays (n,), in the form that kin's laws take."""
        import numpy as np

        from kin.law.sources.ring import Samples

        columns = np.array(self.theta), np.array(self.s), np.array(self.lines, dtype=np.intp)
        return Samples(*columns, self.unit, self.slack, self.turned, np.array(self.rounding))


def read_path(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Read the path of a file, as written; where it is no path, note the fault and return None."""
    if isinstance(node, Scalar) and 0 < len(node.text) <= MOST_TEXT and node.text.isprintable():
        return node.text
    reader.fault(node.mark, path, "not the path of a file", describe(node), reader.wanted(field))
    return None


def _read_origin(noun: str, reader: Reader, field: Field, node: Node, path: str) -> Origin | None:
    """Read the path of a file, or rows of two numbers or more in the recipe itself; None after a fault."""
    if not isinstance(node, Sequence):
        name = read_path(reader, field, node, path)
        return None if name is None else Origin(name)
    lines = []
    for i, item in enumerate(reader.items(field, node, path, MOST_WRITTEN)):
        cells = item.items if isinstance(item, Sequence) else ()
        texts = [cell.text for cell in cells if isinstance(cell, Scalar)]
        if len(texts) != len(cells) or len(texts) < _PAIR or not all(map(_NUMBER.fullmatch, texts)):
            reader.fault(item.mark, join(path, i), "not a row", describe(item), f"give a list [{noun}, displacement]")
            return None
        lines.append(";".join(texts))
    return Origin("the rows", "\n".join(lines)) if lines else None


def _table(noun: str) -> OwnForm[Reader]:
    """Form of a table whose first column has a noun: angle or length."""
    return OwnForm(
        "the path of a file, or a list of rows",
        "the path of a CSV file, such as lift.csv, or rows such as [[0, 0], [10, 0.2]]",
        partial(_read_origin, noun),
        lambda _: {
            "anyOf": [
                {"type": "string", "minLength": 1, "maxLength": MOST_TEXT},
                {
                    "type": "array",
                    "items": {"type": "array", "items": {"type": "number"}, "minItems": 2},
                    "minItems": 1,
                    "maxItems": MOST_WRITTEN,
                },
            ]
        },
    )


def _read_column(reader: Reader, field: Field, node: Node, path: str) -> Column | None:
    """Read a column by its heading or its number; None after a fault."""
    if not isinstance(node, Scalar) or not 0 < len(node.text) <= MOST_TEXT or not node.text.isprintable():
        reader.fault(node.mark, path, "not a column", describe(node), reader.wanted(field))
        return None
    return int(node.text) if node.plain and node.text.isdecimal() else node.text


_COLUMN = OwnForm("a column", "a column, by heading or number", _read_column, lambda _: {"type": ["string", "integer"]})


def _counted(noun: str, most: float) -> FieldTable:
    """Keys of a column of values without one of inputs, whose unit has the key `noun`."""
    return FieldTable(
        (
            Field("column", Kind.OWN, "column of the values", True, form=_COLUMN),
            Field("step", Kind.NUMBER, f"from row to row, in the unit of `{noun}`", True, above=0, at_most=most),
        )
    )


def _read_columns(
    counted: FieldTable, reader: Reader, field: Field, node: Node, path: str
) -> tuple[Column, Column] | Counted | None:
    """Read two columns, or one that is counted; None after a fault."""
    from kin.read.tables import Counted

    if isinstance(node, Mapping):
        faults = len(reader.errors)
        values = reader.table(counted, node, path)
        return None if len(reader.errors) > faults else Counted(values["column"], values["step"])
    columns: list[Column] = []
    for i, item in enumerate(reader.items(field, node, path, 2)):
        column = _read_column(reader, field, item, join(path, i))
        if column is None:
            return None
        columns.append(column)
    if len(columns) == 2:
        return columns[0], columns[1]
    if columns:
        value = describe(node) if isinstance(node, Sequence) else None
        reader.fault(node.mark, path, "not two columns", value, reader.wanted(field))
    return None


def _columns(noun: str, example: str, most: float) -> Field:
    """Field of the columns of a table whose first one has a noun; rows that are counted are up to `most` apart."""
    counted = _counted(noun, most)
    such = f"[{example}], or {{column: 1, step: 2}}"
    two = OwnForm(
        "a list of two columns",
        f"a list of the columns of {noun} and value, by heading or number, such as {such}",
        partial(_read_columns, counted),
        lambda _: {
            "anyOf": [
                {"type": "array", "items": {"type": ["string", "integer"]}, "minItems": 2, "maxItems": 2},
                table_schema(counted),
            ]
        },
        instead=counted,
    )
    about = f"columns of {noun} and value, or that of the values alone with the step from row to row"
    return Field("columns", Kind.OWN, about, default="the only two, or by heading", form=two)


_VALUES = (
    Field("scale", Kind.NUMBER, "factor of the table's values", default="1", at_least=-MOST, at_most=MOST),
    Field(
        "offset",
        Kind.NUMBER,
        "added to the values after that, in their unit",
        default="0",
        at_least=-MOST,
        at_most=MOST,
    ),
)
TABLE, TABLE_OF_LENGTHS = _table("angle"), _table("length")
COLUMNS = _columns("angle", "crank, intake", 720)
SHEET = (
    Field(
        "angle",
        Kind.CHOICE,
        "unit of the table's angles: degrees of the cam or the crank, parts of the cam's turn, or times",
        default="the heading's, else cam",
        choices=("cam", "crank", "radians", "turns", "percent", "seconds"),
    ),
    Field(
        "period", Kind.NUMBER, "seconds in which the cam turns once, for angles that are times", above=0, at_most=MOST
    ),
    COLUMNS,
    *_VALUES,
)
SHEET_OF_LENGTHS = (
    Field(
        "length",
        Kind.CHOICE,
        "unit of the table's lengths",
        default="the heading's, else the recipe's",
        choices=("mm", "inch", "thou"),
    ),
    _columns("length", "travel, lift", MOST),
    *_VALUES,
)
"""Keys beside the file of a table that say how it is read, over angles and over lengths."""


def read_rows(
    reader: Reader, values: Values, path: str, *, quantity: Quantity, instead: str, length: str | None = None
) -> Rows | None:
    """Read the rows of a recipe's table, mm or rad, or in the unit of another quantity.

    `path` is the field of the table, `values` the keys beside it; `quantity` is what the rows hold, such as length, and
    `instead` its unit where neither the recipe nor a heading states one; `length` is that of the first column where the
    rows are over a length. None after a fault, which is noted at `path`.
    """
    from kin.law.normalised import IntentError
    from kin.read.tables import Sheet

    if values.get("scale") == 0.0:
        place = f"{path.rpartition('.')[0]}.scale"
        reader.fault_at(place, "times 0 no motion is left", "0", "give another number, or leave it out")
        return None
    # how the text is read; the file is read now, so that the recipe needs it no more
    origin, mark = values["table"], reader.marks[path]
    sheet = Sheet(
        quantity,
        values.get("columns"),
        values.get("angle" if length is None else "length"),
        values.get("units"),
        instead,
        values.get("scale", 1.0),
        values.get("offset", 0.0),
        values.get("period"),
        length,
    )
    try:
        text = origin.text
        if text is None:
            text = _text(read_bytes(Path(reader.source.file).parent / origin.name, MAX_BYTES, "table"))
        return _rows(text, sheet)
    except Complaint as complaint:
        remedy = complaint.remedy or "give its path as seen from the recipe's folder"
        reader.fault(mark, path, complaint.problem, quote(origin.name), remedy)
    except IntentError as error:
        reader.fault(mark, path, f"{origin.name}, {error.message}")
    return None


def _text(data: bytes) -> str:
    """Decode the text of a table; raises Complaint for a file that is no text or too large."""
    if len(data) > MAX_BYTES:
        raise Complaint(f"larger than {MAX_BYTES} bytes", _FEWER)
    if max(data.count(b"\n"), data.count(b"\r")) > MAX_LINES:
        raise Complaint(f"more than {MAX_LINES} lines", _FEWER)
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    if b"\0" in data:
        raise Complaint("not a text", "save the table as CSV")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:  # a degree sign of an older encoding, in a heading
        return data.decode("latin-1")


@lru_cache(maxsize=4)
def _rows(text: str, sheet: Sheet) -> Rows:
    """Rows of a table's text; raises Complaint for too many rows."""
    import numpy as np

    from kin.read.tables import read_table

    samples = read_table(text, sheet, _FIELD)
    if len(samples.lines) > MAX_ROWS:
        raise Complaint(f"more than {MAX_ROWS} rows", _FEWER)
    columns = (samples.theta, samples.s, samples.lines, np.asarray(samples.rounding))
    theta, s, lines, rounding = (tuple(column.tolist()) for column in columns)
    return Rows(theta, s, lines, rounding, samples.unit, samples.slack, samples.turned)
