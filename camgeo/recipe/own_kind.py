"""Reading of a recipe that is none of a disc cam: its text by a table of keys, and its end in a value or in errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from camgeo.recipe.document import Document
from camgeo.recipe.keys import read_units
from camgeo.recipe.recipe import name_by_stem, reader_of_kind
from camgeo.schema.errors import RecipeErrors
from camgeo.schema.fields import Kind
from camgeo.schema.yaml_source import Mapping, entries

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node, Source

RecipeT = TypeVar("RecipeT")


def entry_at(root: Node, *keys: str) -> Node | None:
    """The node at the end of a chain of keys; None where the text does not go so far."""
    node: Node | None = root
    for key in keys:
        node = entries(node).get(key) if isinstance(node, Mapping) else None
    return node


def begin(source: Source, root: str, table: FieldTable, *, swings: bool) -> tuple[Reader, Values]:
    """Reader of a kind that has read a text by its table, and the values; its motion is an angle where it `swings`."""
    reader = reader_of_kind(source, root)
    read_units(reader)
    if swings:
        reader.angular |= {Kind.STROKE, Kind.ERROR, Kind.MOTION}
    return reader, reader.table(table, source.root, "") if isinstance(source.root, Mapping) else {}


def finish(
    reader: Reader,
    values: Values,
    path: Path,
    check: Callable[[Values, Reader], None],
    build: Callable[[Values, Document, Reader], RecipeT],
) -> RecipeT:
    """Recipe of the values in a file, after the faults between its keys; raises RecipeErrors with all faults."""
    name_by_stem(values, reader, path)
    if not reader.errors:
        check(values, reader)
    if reader.errors:
        raise RecipeErrors(reader.errors)
    document = Document(path=path, text=reader.source.text, marks=reader.marks, kinds=reader.kinds)
    return build(values, document, reader)
