"""Tables of displacements: their file is read with the recipe, so that it is not needed later."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from camgeo.schema.fields import MOST, Field, Kind, OwnForm
from camgeo.schema.file_bytes import read_bytes
from camgeo.schema.scalars import MOST_TEXT, Complaint
from camgeo.schema.yaml_source import Scalar, Sequence, describe, join
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node
    from kin.law.sources.ring import Samples
    from kin.read.tables import Column, Quantity, Sheet

MAX_BYTES = 16_000_000
MAX_ROWS = 200_000
MOST_WRITTEN = 3000  # rows in a recipe, which as a text has at most 10,000 parts
_PAIR = 2  # numbers of a row at least
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_FIELD = "table"


class Origin(NamedTuple):
    """Source of a table's rows: the path of a file, or a name and the rows' text where they stand in the recipe.

    `text` is None for a file.
    """

    name: str
    text: str | None = None


@dataclass(frozen=True)
class Rows:
    """Rows of a table: cam angles `theta`, rad, displacements `s`, mm or rad, or loads, and their lines in the file.

    `unit` is the file's unit of displacement in mm or rad; rounding may have moved angles by up to `slack`, rad; one
    degree is `turned` units of the file's angles.
    """

    theta: tuple[float, ...]
    s: tuple[float, ...]
    lines: tuple[int, ...]
    unit: float
    slack: float = 0.0
    turned: float = 1.0

    def samples(self) -> Samples:
        """Rows as arrays (n,), in the form that kin's laws take."""
        import numpy as np

        from kin.law.sources.ring import Samples

        columns = np.array(self.theta), np.array(self.s), np.array(self.lines, dtype=np.intp)
        return Samples(*columns, self.unit, self.slack, self.turned)


def read_path(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Read the path of a file, as written; where it is no path, note the fault and return None."""
    if isinstance(node, Scalar) and 0 < len(node.text) <= MOST_TEXT and node.text.isprintable():
        return node.text
    reader.fault(node.mark, path, "not the path of a file", describe(node), reader.wanted(field))
    return None


def _read_origin(reader: Reader, field: Field, node: Node, path: str) -> Origin | None:
    """Read the path of a file, or rows of two numbers or more in the recipe itself; None after a fault."""
    if not isinstance(node, Sequence):
        name = read_path(reader, field, node, path)
        return None if name is None else Origin(name)
    lines = []
    for i, item in enumerate(reader.items(field, node, path, MOST_WRITTEN)):
        cells = item.items if isinstance(item, Sequence) else ()
        texts = [cell.text for cell in cells if isinstance(cell, Scalar)]
        if len(texts) != len(cells) or len(texts) < _PAIR or not all(map(_NUMBER.fullmatch, texts)):
            reader.fault(item.mark, join(path, i), "not a row", describe(item), "give a list [angle, displacement]")
            return None
        lines.append(";".join(texts))
    return Origin("the rows", "\n".join(lines)) if lines else None


TABLE = OwnForm(
    "the path of a file, or a list of rows",
    "the path of a CSV file, such as lift.csv, or rows such as [[0, 0], [10, 0.2]]",
    _read_origin,
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


def _read_columns(reader: Reader, field: Field, node: Node, path: str) -> tuple[Column, Column] | None:
    """Read two columns, each by its heading or its number; None after a fault."""
    columns: list[Column] = []
    for i, item in enumerate(reader.items(field, node, path, 2)):
        if not isinstance(item, Scalar) or not 0 < len(item.text) <= MOST_TEXT or not item.text.isprintable():
            reader.fault(item.mark, join(path, i), "not a column", describe(item), reader.wanted(field))
            return None
        columns.append(int(item.text) if item.plain and item.text.isdecimal() else item.text)
    if len(columns) == 2:
        return columns[0], columns[1]
    if columns:
        value = describe(node) if isinstance(node, Sequence) else None
        reader.fault(node.mark, path, "not two columns", value, reader.wanted(field))
    return None


_TWO = OwnForm(
    "a list of two columns",
    "a list of the columns of angle and value, by heading or number, such as [crank, intake]",
    _read_columns,
    lambda _: {"type": "array", "items": {"type": ["string", "integer"]}, "minItems": 2, "maxItems": 2},
)
COLUMNS = Field("columns", Kind.OWN, "columns of angle and value", default="the only two, or by heading", form=_TWO)
SHEET = (
    Field(
        "angle",
        Kind.CHOICE,
        "unit of the table's angles: degrees of the cam or the crank, or parts of the cam's turn",
        default="the heading's, else cam",
        choices=("cam", "crank", "radians", "turns", "percent"),
    ),
    COLUMNS,
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
"""Keys beside the file of a table that say how it is read."""


def read_rows(
    reader: Reader, values: Values, path: str, *, quantity: Quantity, instead: str
) -> tuple[Rows, float] | None:
    """Read the rows of a recipe's table, and the size of their last digit, mm or rad, or the unit of another quantity.

    `path` is the field of the table, `values` the keys beside it; `quantity` is what the rows hold, such as length, and
    `instead` its unit where neither the recipe nor a heading states one. None after a fault, which is noted at `path`.
    """
    from kin.law.programme import IntentError
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
        values.get("angle"),
        values.get("units"),
        instead,
        values.get("scale", 1.0),
        values.get("offset", 0.0),
    )
    try:
        text = origin.text
        if text is None:
            text = _text(read_bytes(Path(reader.source.file).parent / origin.name, MAX_BYTES, "table"))
        return _rows(text, sheet)
    except Complaint as complaint:
        remedy = complaint.remedy or "give its path as seen from the recipe's folder"
        reader.fault(mark, path, complaint.problem, repr(origin.name), remedy)
    except IntentError as error:
        reader.fault(mark, path, f"{origin.name}, {error.message}")
    return None


def _text(data: bytes) -> str:
    """Decode the text of a table; raises Complaint for a file that is no text or too large."""
    remedy = "leave rows out; a row for each hundredth of a degree will do"
    if len(data) > MAX_BYTES:
        raise Complaint(f"larger than {MAX_BYTES} bytes", remedy)
    if max(data.count(b"\n"), data.count(b"\r")) > MAX_ROWS:
        raise Complaint(f"more than {MAX_ROWS} rows", remedy)
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    if b"\0" in data:
        raise Complaint("not a text", "save the table as CSV")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:  # a degree sign of an older encoding, in a heading
        return data.decode("latin-1")


@lru_cache(maxsize=4)
def _rows(text: str, sheet: Sheet) -> tuple[Rows, float]:
    """Rows of a table's text, and the unit of its last digit, mm or rad."""
    from kin.read.tables import read_table

    samples, last_digit = read_table(text, sheet, _FIELD)
    theta, s, lines = (tuple(column.tolist()) for column in (samples.theta, samples.s, samples.lines))
    return Rows(theta, s, lines, samples.unit, samples.slack, samples.turned), last_digit
