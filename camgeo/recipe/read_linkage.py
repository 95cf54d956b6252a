"""Reading a cam, a linkage and its dyads: mappings whose kind says which keys they have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.source import join
from camgeo.recipe.spec import MOST_DYADS, Field, Kind
from camgeo.recipe.table_cam import CAMS
from camgeo.recipe.table_linkage import DYADS, LINKAGES

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values
    from camgeo.recipe.source import Node


def read_cam(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    """Read the cam by the table of its kind."""
    return reader.one_of(CAMS, field, node, path)


def read_linkage(reader: Reader, field: Field, node: Node, path: str) -> Values | None:
    """Read the linkage by the table of its kind."""
    return reader.one_of(LINKAGES, field, node, path)


def read_dyads(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read the list of dyads, each by the table of its kind, or None where one is faulty."""
    dyad = Field("", Kind.DYAD, "")
    items = reader.items(field, node, path, MOST_DYADS)
    values = [reader.one_of(DYADS, dyad, item, join(path, i)) for i, item in enumerate(items)]
    return [value for value in values if value is not None] if None not in values else None
