"""Reading the fields of the part that take a number or a word as well as a mapping."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.errors import shown
from camgeo.recipe.read_scalar import read_numeric
from camgeo.recipe.source import Scalar
from camgeo.recipe.spec import length
from camgeo.recipe.table_part import STANDARD

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values
    from camgeo.recipe.source import Node
    from camgeo.recipe.spec import Field


def read_bore(reader: Reader, field: Field, node: Node, path: str) -> float | Values | None:
    """Read a diameter in mm, or the mapping of a bore with flats."""
    if isinstance(node, Scalar):
        return read_numeric(reader, length(field.name, field.about), node, path)
    return reader.mapping(field, node, path)


def read_keyway(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    """Read the word for the standard's keyway, or its mapping."""
    if isinstance(node, Scalar):
        if node.text == STANDARD:
            return {"standard": STANDARD}
        reader.fault(node.mark, path, "no such keyway", shown(node.text), reader.wanted(field))
        return None
    return reader.mapping(field, node, path)
