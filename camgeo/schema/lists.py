"""Lists of mappings that all have the keys of one table."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from camgeo.schema.fields import Field, FieldTable, Kind, OwnForm
from camgeo.schema.json_schema import table_schema
from camgeo.schema.yaml_source import join

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node


def list_of(name: str, table: FieldTable, about: str, example: str, most: int, *, required: bool = False) -> Field:
    """Field of a list of 1 to `most` mappings, each with the keys of `table`; `example` is one for messages."""
    form: OwnForm[Reader] = OwnForm(
        f"a list of {name}",
        f"a list of {name} such as {example}",
        partial(_rows, (table, most)),
        lambda _: {"type": "array", "items": table_schema(table), "minItems": 1, "maxItems": most},
    )
    return Field(name, Kind.OWN, about, required, default="" if required else "none", form=form)


def _rows(of: tuple[FieldTable, int], reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Rows of a list, at most so many, of mappings with the keys of one table; None where a row is faulty."""
    table, most = of
    row = Field("", Kind.TABLE, field.about, table=table)
    items = enumerate(reader.items(field, node, path, most))
    rows = [reader.mapping(row, item, join(path, i)) for i, item in items]
    whole = [values for values in rows if values is not None]
    return whole if len(whole) == len(rows) else None
