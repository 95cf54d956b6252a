"""The key `valve` of a recipe: the rocker's ratio, constant or over the tappet's lift, and the lash at the valve."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from camgeo.capabilities.valve.train import Valve
from camgeo.motions.lift_table import MAX_BYTES, TABLE, Origin
from camgeo.schema.errors import quote
from camgeo.schema.fields import MOST, Field, FieldTable, Kind, OwnForm, mapping
from camgeo.schema.file_bytes import read_bytes
from camgeo.schema.json_schema import number_schema, table_schema
from camgeo.schema.scalars import Complaint
from camgeo.schema.yaml_source import Mapping, join

if TYPE_CHECKING:
    from camgeo.schema.fields import Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

MOST_ROWS = 1000
LEAST_ROWS = 2
MOST_RATIO = 100.0
_REMEDY = "give rows of a tappet lift and a ratio, such as 0;1.55"
_COLUMNS = ("lift", "ratio")
_NUMBER = Field("ratio", Kind.NUMBER, "", above=0, at_most=MOST_RATIO)
_ROWS = FieldTable(
    (Field("table", Kind.OWN, "file with a row for each tappet lift and the ratio there", True, form=TABLE),)
)


def fields() -> tuple[Field, ...]:
    """The key `valve` of a recipe, with the keys below it."""
    ratio = OwnForm(
        "a ratio",
        "a number above 0, or {table: rocker.csv} with tappet lifts and ratios",
        _read_ratio,
        _ratio_schema,
    )
    return (
        mapping(
            "valve",
            "the valve that the tappet works: its lift is the ratio times the tappet's, less the lash",
            Field("ratio", Kind.OWN, "lift of the valve by lift of the tappet", required=True, table=_ROWS, form=ratio),
            Field("lash", Kind.LENGTH, "clearance at the valve", default="0", at_least=0, at_most=MOST),
        ),
    )


def _ratio_schema(_: Field) -> Schema:
    return {"anyOf": [number_schema(_NUMBER), table_schema(_ROWS)]}


def _read_ratio(reader: Reader, field: Field, node: Node, path: str) -> tuple[tuple[float, float], ...] | None:
    """Rows of a tappet's lift, mm, and the ratio there, a constant ratio as one row at 0; None after a fault."""
    if not isinstance(node, Mapping):
        ratio = reader.readers[Kind.NUMBER](reader, _NUMBER, node, path)
        return None if ratio is None else ((0.0, ratio),)
    values = reader.mapping(Field("", Kind.TABLE, field.about, table=_ROWS), node, path) or {}
    if "table" not in values:
        return None
    origin: Origin = values["table"]
    place = join(path, "table")
    try:
        rows = _rows(origin, reader)
    except Complaint as complaint:
        remedy = complaint.remedy or _REMEDY
        reader.fault_at(place, complaint.problem, quote(origin.name), remedy)
        return None
    return tuple(rows)


def _rows(origin: Origin, reader: Reader) -> list[tuple[float, float]]:
    """Rows of lifts, mm, and ratios; raises Complaint for a table that cannot be read, or with values out of range."""
    from kin.read.rows import RowError, read_rows
    from kin.read.tables import UNITS, unit_of

    text = origin.text
    if text is None:
        data = read_bytes(Path(reader.source.file).parent / origin.name, MAX_BYTES, "table")
        text = data.decode("utf-8-sig", "replace")
    try:
        table = read_rows(text)
        values = table.values([0, 1])
    except RowError as error:
        raise Complaint(error.message if error.line is None else f"line {error.line}: {error.message}") from None
    if table.columns > len(_COLUMNS):
        raise Complaint(f"line {table.numbers[0]}: {table.columns} columns, and 2 are expected")
    # lifts in the unit of the column's heading, else in the recipe's
    unit = unit_of(table.heading[0]) if len(table.heading) == table.columns else None
    if unit is not None and unit not in UNITS["length"]:
        raise Complaint(f"the column {table.heading[0]!r} is in {unit}; a length is meant here", _REMEDY)
    mm = reader.mm if unit is None else UNITS["length"][unit]
    rows = [(lift * mm, ratio) for lift, ratio in values.tolist()]
    for line, (lift, ratio) in zip(table.numbers, rows, strict=True):
        if not abs(lift) <= MOST:
            raise Complaint(f"line {line}: a tappet lifts up to {MOST:g} mm", _REMEDY)
        if not 0.0 < ratio <= MOST_RATIO:
            raise Complaint(f"line {line}: a ratio lies between 0 and {MOST_RATIO:g}")
    if not LEAST_ROWS <= len(rows) <= MOST_ROWS:
        raise Complaint(f"{len(rows)} rows", f"give {LEAST_ROWS} to {MOST_ROWS} rows")
    if rows[0][0] != 0.0 or not all(a < b for (a, _), (b, _) in pairwise(rows)):
        raise Complaint("the tappet lifts do not rise from 0", "let them begin at 0 and rise")
    return rows


def check(values: Values, reader: Reader) -> None:
    """Add a fault for a valve whose follower is no tappet, or whose tappet drives a linkage."""
    if "valve" not in values:
        return
    if reader.offers.isdisjoint({"stem", "stem-face"}):
        remedy = "give a cam of kind disc with a follower on a stem, or leave valve out"
        reader.fault_at("valve", "a valve is worked by a tappet, a follower on a stem", None, remedy)
    elif "linkage" in values:
        reader.fault_at("valve", "the tappet drives a linkage already", None, "leave one of the two out")


def build(values: Values) -> Valve | None:
    """Valve of a recipe without faults; None without the key `valve`."""
    entry = values.get("valve")
    return None if entry is None else Valve(entry["ratio"], entry.get("lash", 0.0))
