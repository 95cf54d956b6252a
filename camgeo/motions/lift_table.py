"""Tables of displacements: their file is read with the recipe, which then needs it no more."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from camgeo.schema.fields import Form
from camgeo.schema.file_bytes import bytes_of
from camgeo.schema.scalars import MOST_TEXT, Complaint
from camgeo.schema.yaml_source import Scalar, described
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.schema.fields import Field
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Node
    from kin.law.sources.ring import Samples

Angles: TypeAlias = Literal["cam", "crank"]
Unit: TypeAlias = Literal["mm", "inch", "thou", "degrees", "N"]  # of displacements, or of loads

MAX_BYTES = 16_000_000
MAX_ROWS = 200_000
_FIELD = "table"


@dataclass(frozen=True)
class Rows:
    """Rows of a table: angles of the cam in rad, displacements in mm or rad, and their lines in the file.

    `unit` is one unit of the file's displacements, in mm or rad; angles that were rounded may be off by `slack` rad.
    """

    theta: tuple[float, ...]
    s: tuple[float, ...]
    lines: tuple[int, ...]
    unit: float
    slack: float = 0.0
    turned: float = 1.0

    def samples(self) -> Samples:
        """Give the rows as kin takes them."""
        import numpy as np

        from kin.law.sources.ring import Samples

        columns = np.array(self.theta), np.array(self.s), np.array(self.lines, dtype=np.intp)
        return Samples(*columns, self.unit, self.slack, self.turned)


def read_path(reader: Reader, field: Field, node: Node, path: str) -> str | None:
    """Read the path of a file, as written."""
    if isinstance(node, Scalar) and 0 < len(node.text) <= MOST_TEXT and node.text.isprintable():
        return node.text
    reader.fault(node.mark, path, "not the path of a file", described(node), reader.wanted(field))
    return None


FILE = Form(
    "the path of a file",
    "the path of a CSV file, such as lift.csv",
    read_path,
    lambda _: {"type": "string", "minLength": 1, "maxLength": MOST_TEXT},
)


def read_rows(
    reader: Reader,
    file: str,
    path: str,
    *,
    angles: Angles,
    unit: Unit,
) -> tuple[Rows, float] | None:
    """Read the table of a recipe, and the unit of its last digit; notes what is wrong at the recipe's own field."""
    from kin.law.programme import IntentError

    mark = reader.marks[path]
    try:
        text = _text(bytes_of(Path(reader.source.file).parent / file, MAX_BYTES, "table"))
        return _rows(text, angles, unit)
    except Complaint as complaint:
        remedy = complaint.remedy or "give its path as seen from the recipe's folder"
        reader.fault(mark, path, complaint.problem, repr(file), remedy)
    except IntentError as error:
        reader.fault(mark, path, f"{file}, {error.message}")
    return None


def _text(data: bytes) -> str:
    """The text of a table; raises Complaint for none, and for more than is read."""
    rest = "leave rows out; a row for each hundredth of a degree will do"
    if len(data) > MAX_BYTES:
        raise Complaint(f"larger than {MAX_BYTES} bytes", rest)
    if max(data.count(b"\n"), data.count(b"\r")) > MAX_ROWS:
        raise Complaint(f"more than {MAX_ROWS} rows", rest)
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    if b"\0" in data:
        raise Complaint("not a text", "save the table as CSV")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:  # a degree sign of an older encoding, in a heading
        return data.decode("latin-1")


@lru_cache(maxsize=4)
def _rows(text: str, angles: Angles, unit: Unit) -> tuple[Rows, float]:
    from kin.law.sources.table_text import read_table

    samples, place = read_table(text, angles=angles, unit=unit, field=_FIELD)
    theta, s, lines = (tuple(column.tolist()) for column in (samples.theta, samples.s, samples.lines))
    return Rows(theta, s, lines, samples.unit, samples.slack, samples.turned), place
