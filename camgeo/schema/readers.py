"""Reading functions by kind of field, those of lists and harmonics, and forms whose `kind` chooses their keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.fields import MOST, MOST_HARMONIC, Field, Kind, OwnForm, coordinate, length
from camgeo.schema.json_schema import one_of_schema
from camgeo.schema.read_scalar import read_choice, read_formula, read_numeric, read_text, read_truth
from camgeo.schema.reader import Reader
from camgeo.schema.yaml_source import Mapping, Sequence, describe, entries, join, keys

if TYPE_CHECKING:
    import collections.abc

    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Readers
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
    """Pairs of a harmonic and its coefficient, harmonics rising; None where it is no mapping, with the fault noted.

    Coefficients are in mm or mm^2, as the field's `unit` is LENGTH or AREA, and plain numbers without one. Faulty
    entries are noted and left out.
    """
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


READERS: Readers = {
    Kind.TEXT: read_text,
    Kind.NAME: read_text,
    Kind.CHOICE: read_choice,
    Kind.LENGTH: read_numeric,
    Kind.AREA: read_numeric,
    Kind.ANGLE: read_numeric,
    Kind.NUMBER: read_numeric,
    Kind.RATE: read_numeric,
    Kind.INTEGER: read_numeric,
    Kind.STROKE: read_numeric,
    Kind.ERROR: read_numeric,
    Kind.OUTPUT: read_numeric,
    Kind.MOTION: read_numeric,
    Kind.BACKLASH: read_numeric,
    Kind.TRUTH: read_truth,
    Kind.RATIO: read_text,
    Kind.FORMULA: read_formula,
    Kind.POINT: read_point,
    Kind.PAIR: read_pair,
    Kind.HARMONICS: read_harmonics,
    Kind.NUMBERS: read_numbers,
    Kind.TABLE: Reader.mapping,
}


def form_of_kinds(
    noun: str,
    tables: collections.abc.Mapping[str, FieldTable],
    group: str = "",
    others: str = "",
    elsewhere: tuple[str, ...] = (),
) -> OwnForm[Reader]:
    """Form of a mapping whose `kind` chooses the table of its keys.

    `noun`, without an article, names the mapping in messages. `group` stands before the kind where a message names the
    kind that has a key, `cam of kind` for `cam of kind support`; without it no message does. `others` is the remedy for
    a kind that is none of these, `elsewhere` are kinds of other recipes.
    """
    return OwnForm(
        f"a {noun}",
        f"a mapping with the kind of {noun} and its fields",
        Reader.one_of,
        lambda _: one_of_schema(noun, tables),
        tables=tables,
        group=group,
        others=others,
        elsewhere=elsewhere,
    )
