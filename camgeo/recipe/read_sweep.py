"""Reading what a sweep varies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.source import Mapping, Sequence, described, entries, join
from camgeo.recipe.spec import MOST_AXES, MOST_VALUES, Field, Kind
from camgeo.recipe.table_sweep import RANGE

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values
    from camgeo.recipe.source import Node


def read_vary(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read the axes of a sweep as they stand, each with the path of its number and its own place (`at`).

    Whether there is a number at that path shows only when the whole recipe has been read.
    """
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", described(node), reader.wanted(field))
        return None
    given = entries(node)
    if not given:
        reader.fault(node.mark, path, "nothing varies", None, reader.wanted(field))
        return None
    if len(given) > MOST_AXES:
        reader.fault(node.mark, path, f"more than {MOST_AXES} axes", str(len(given)), "leave some out")
        return None
    axes = []
    for name, below in ((name, join(path, name)) for name in given):
        axis = _axis(reader, given[name], below)
        if axis is not None:
            axes.append({"path": name, "at": below, **axis})
    return axes


def _axis(reader: Reader, node: Node, path: str) -> Values | None:
    """Read a range or a list of values."""
    either_way = Field("", Kind.AXIS, "")
    if isinstance(node, Sequence):
        items = reader.items(either_way, node, path, MOST_VALUES)
        part = Field("", Kind.NUMBER, "")
        values = [reader.field(part, item, join(path, i)) for i, item in enumerate(items)]
        return {"values": tuple(values)} if values and None not in values else None
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a range", described(node), reader.wanted(either_way))
        return None
    read = reader.table(RANGE, node, path)
    return read if {"from", "to"} <= read.keys() else None
