"""Reading what a sweep varies and the limits that its designs keep."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.errors import suggestion
from camgeo.recipe.source import Mapping, Sequence, described, entries, join, keys
from camgeo.recipe.spec import MOST_AXES, MOST_VALUES, Field, Kind, either
from camgeo.recipe.table_sweep import FIGURES, RANGE, bounds

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


def read_limits(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read the limits of a sweep by the figures that they bound; lengths in mm, angles in degrees."""
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", described(node), reader.wanted(field))
        return None
    given = entries(node)
    limits = []
    for name, key in keys(node).items():
        below = join(path, name)
        if name not in FIGURES:
            remedy = suggestion(name, FIGURES) or f"the figures are {either(tuple(FIGURES), 'and')}"
            reader.fault(key.mark, below, "no such figure", None, remedy)
            continue
        table = Field("", Kind.TABLE, "", table=bounds(FIGURES[name]))
        found = len(reader.errors)
        values = reader.field(table, given[name], below)
        if values is None or len(reader.errors) > found:
            continue
        if not values:
            reader.fault(given[name].mark, below, "no bound", None, "give at_least, at_most or both")
        factor = reader.mm if reader.unit(FIGURES[name].kind) == reader.units else 1.0
        limits.append({"figure": name, "at": below, **{bound: factor * value for bound, value in values.items()}})
    return limits
