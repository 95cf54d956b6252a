"""Reading the fields of a recipe that are made of several entries: points, lists of numbers, harmonics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.fields import MOST, MOST_HARMONIC, Field, Kind, coordinate, length
from camgeo.schema.yaml_source import Mapping, Sequence, describe, entries, join, keys

if TYPE_CHECKING:
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Node


def read_point(reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    """Two coordinates (x, y), mm; None where faulty, with the fault noted."""
    return _two(coordinate("", ""), reader, field, node, path)


def read_pair(reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    """Two lengths above 0, mm; None where faulty, with the fault noted."""
    return _two(length("", ""), reader, field, node, path)


def _two(part: Field, reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    if not isinstance(node, Sequence) or len(node.items) != 2:
        reader.fault(node.mark, path, f"not {field.noun}", describe(node), reader.wanted(field))
        return None
    x, y = (reader.field(part, item, join(path, i)) for i, item in enumerate(node.items))
    return None if x is None or y is None else (x, y)


def read_numbers(reader: Reader, field: Field, node: Node, path: str) -> tuple[float, ...] | None:
    """Numbers of a list, such as the coefficients of a polynomial; None where faulty, with the faults noted."""
    items = reader.items(field, node, path, field.most)
    values = [reader.field(field.entry, item, join(path, i)) for i, item in enumerate(items)]
    return tuple(values) if values and None not in values else None


def read_harmonics(reader: Reader, field: Field, node: Node, path: str) -> tuple[tuple[int, float], ...] | None:
    """Pairs of a harmonic and its coefficient, harmonics rising; faulty entries are noted and left out."""
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", describe(node), reader.wanted(field))
        return None
    harmonic = Field("", Kind.INTEGER, "", at_least=1, at_most=MOST_HARMONIC, odd=field.odd)
    bound = MOST**2 if field.unit is Kind.AREA else MOST
    coefficient = Field("", field.unit or Kind.NUMBER, "", at_least=-bound, at_most=bound)
    values = entries(node)
    coefficients: dict[int, float] = {}
    for name, key in keys(node).items():
        below = join(path, name)
        # The harmonic comes first: both have one path, and the number that stands there is the coefficient.
        j = reader.readers[harmonic.kind](reader, harmonic, key, below)
        value = reader.field(coefficient, values[name], below)
        if j in coefficients:
            reader.fault(key.mark, below, "a duplicate harmonic", None, "give each harmonic once")
        elif isinstance(j, int) and value is not None:
            coefficients[j] = value
    return tuple(sorted(coefficients.items()))
