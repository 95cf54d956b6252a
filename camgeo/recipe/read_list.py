"""Reading the fields of a recipe that are made of several entries: points, coefficients, motions, files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.recipe.errors import shown, suggestion
from camgeo.recipe.model import MATCH, SccaLaw
from camgeo.recipe.source import Mapping, Scalar, Sequence, described, entries, is_empty, join, keys
from camgeo.recipe.spec import (
    MOST,
    MOST_COEFFICIENT,
    MOST_COEFFICIENTS,
    MOST_FILES,
    MOST_HARMONIC,
    MOST_SEGMENTS,
    Field,
    Kind,
    coordinate,
    either,
    length,
)
from camgeo.recipe.tables import FILES

if TYPE_CHECKING:
    from camgeo.recipe.reader import Reader, Values
    from camgeo.recipe.source import Node


def read_point(reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    """Read two coordinates."""
    return _two(coordinate("", ""), reader, field, node, path)


def read_pair(reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    """Read two lengths above 0."""
    return _two(length("", ""), reader, field, node, path)


def _two(part: Field, reader: Reader, field: Field, node: Node, path: str) -> tuple[float, float] | None:
    if not isinstance(node, Sequence) or len(node.items) != 2:
        reader.fault(node.mark, path, f"not {field.kind.value}", described(node), reader.wanted(field))
        return None
    x, y = (reader.field(part, item, join(path, i)) for i, item in enumerate(node.items))
    return None if x is None or y is None else (x, y)


def read_numbers(reader: Reader, field: Field, node: Node, path: str) -> tuple[float, ...] | None:
    """Read the coefficients of a polynomial."""
    part = Field("", Kind.NUMBER, "", at_least=-MOST_COEFFICIENT, at_most=MOST_COEFFICIENT)
    items = reader.items(field, node, path, MOST_COEFFICIENTS)
    values = [reader.field(part, item, join(path, i)) for i, item in enumerate(items)]
    return tuple(values) if values and None not in values else None


def read_harmonics(reader: Reader, field: Field, node: Node, path: str) -> tuple[tuple[int, float], ...] | None:
    """Read coefficients by their harmonics, rising."""
    if not isinstance(node, Mapping):
        reader.fault(node.mark, path, "not a mapping", described(node), reader.wanted(field))
        return None
    harmonic = Field("", Kind.INTEGER, "", at_least=1, at_most=MOST_HARMONIC, odd=field.odd)
    bound = MOST**2 if field.unit is Kind.AREA else MOST
    coefficient = Field("", field.unit or Kind.NUMBER, "", at_least=-bound, at_most=bound)
    values = entries(node)
    read: dict[int, float] = {}
    for name, key in keys(node).items():
        below = join(path, name)
        # The harmonic comes first: both have one path, and the number that stands there is the coefficient.
        j = reader.readers[harmonic.kind](reader, harmonic, key, below)
        value = reader.field(coefficient, values[name], below)
        if j in read:
            reader.fault(key.mark, below, "the harmonic stands twice", None, "give each harmonic once")
        elif isinstance(j, int) and value is not None:
            read[j] = value
    return tuple(sorted(read.items()))


def read_law(reader: Reader, field: Field, node: Node, path: str) -> str | tuple[float, ...] | SccaLaw | None:
    """Read the name of a motion law, the coefficients of a polynomial, or the shares of a member of the SCCA family."""
    from kin.law import IntentError, polynomial_law
    from kin.motion_sources.laws import NAMES, scca

    names = (*NAMES, MATCH)
    if isinstance(node, Scalar):
        if node.text in names:
            return node.text
        remedy = suggestion(node.text, names) or f"give {either(names)}, {{polynomial: [...]}} or {{scca: {{...}}}}"
        reader.fault(node.mark, path, "no such motion law", shown(node.text), remedy)
        return None
    values = reader.mapping(field, node, path) or {}
    if "scca" in values:
        shares = SccaLaw(**values["scca"])
        try:
            scca(shares.sine, shares.constant, shares.velocity)
        except IntentError as error:
            remedy = "let `sine` and `constant` together be at most 1, and `velocity` below 1"
            reader.fault(node.mark, join(path, "scca"), error.message, None, remedy)
            return None
        return shares
    coefficients: tuple[float, ...] | None = values.get("polynomial")
    if coefficients is None:
        return None
    try:
        polynomial_law(coefficients)
    except IntentError as error:
        reader.fault(node.mark, path, error.message, None, "let c0 be 0 and the sum of all coefficients 1")
        return None
    return coefficients


def read_segments(reader: Reader, field: Field, node: Node, path: str) -> list[Values] | None:
    """Read a motion programme, or None where a segment is faulty."""
    found = len(reader.errors)
    items = reader.items(field, node, path, MOST_SEGMENTS)
    segment = Field("", Kind.TABLE, "", table=field.table)
    values = [reader.field(segment, item, join(path, i)) for i, item in enumerate(items)]
    return values if len(reader.errors) == found else None


def read_files(reader: Reader, field: Field, node: Node, path: str) -> list[Values]:
    """Read the list of files; each with its `kind`. A faulty one is left out."""
    found = []
    for i, item in enumerate(reader.items(field, node, path, MOST_FILES)):
        below = join(path, i)
        kind, options = _format(item)
        if kind is None:
            remedy = "give a format, or a mapping with one format such as {dxf: {as: spline}}"
            reader.fault(item.mark, below, "not a file", described(item), remedy)
            continue
        if kind.text not in FILES:
            _refuse_format(reader, kind, below)
        elif options is None:
            found.append({"kind": kind.text, "path": below})
        else:
            table = Field("", Kind.TABLE, "", table=FILES[kind.text])
            values = reader.field(table, options, join(below, kind.text))
            if values is not None:
                found.append({"kind": kind.text, "path": below, **values})
    return found


def _refuse_format(reader: Reader, kind: Scalar, path: str) -> None:
    reader.fault(kind.mark, path, "no such file format", shown(kind.text), f"give {either(tuple(FILES))}")


def _format(node: Node) -> tuple[Scalar | None, Node | None]:
    """Take an entry of the list of files apart: `dxf`, or the format and options of `{dxf: {...}}`."""
    if isinstance(node, Scalar):
        return (None if is_empty(node) else node), None
    if isinstance(node, Mapping) and len(node.entries) == 1:
        key, options = node.entries[0]
        return (key if isinstance(key, Scalar) else None), options
    return None, None
