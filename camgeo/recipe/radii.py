"""The key that lists the radii of a development: lengths, and words for radii that a cam has of itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.schema.errors import quote
from camgeo.schema.fields import OwnForm, either, length
from camgeo.schema.json_schema import number_schema
from camgeo.schema.read_scalar import read_numeric
from camgeo.schema.yaml_source import Scalar, join
from kin.numeric.records import replace

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.schema.fields import Field, Schema
    from camgeo.schema.reader import Reader, Values
    from camgeo.schema.yaml_source import Node

MOST = 20  # radii of one development
ROUNDED = 1e-9  # mm by which a radius may be rounded beyond the floor or the blank


def radii_form(words: Mapping[str, str]) -> OwnForm[Reader]:
    """Form of a list of radii, read as words and lengths, mm; `words` say what each stands for: `for the blank`."""

    def read(reader: Reader, field: Field, node: Node, path: str) -> tuple[str | float, ...] | None:
        """Read words and radii; None after a fault, which is noted in the reader."""
        found: list[str | float] = []
        faults = len(reader.errors)
        for i, item in enumerate(reader.items(field, node, path, MOST)):
            if isinstance(item, Scalar) and item.text in words:
                found.append(item.text)
                continue
            told = len(reader.errors)
            value = read_numeric(reader, length("at", field.about), item, join(path, i))
            if len(reader.errors) > told:
                last = reader.errors[-1]
                *first, final = [last.remedy, *(f"{word} {what}" for word, what in words.items())]
                reader.errors[-1] = replace(last, remedy=f"{', '.join(first)}, or {final}")
            if value is not None and value not in found:
                found.append(value)
            elif value is not None:
                reader.fault(item.mark, join(path, i), "the same radius twice", quote(str(value)), "leave one out")
        return tuple(found) if len(reader.errors) == faults else None

    def schema(_: Field) -> Schema:
        item = {"anyOf": [{"enum": list(words)}, number_schema(length("", ""))]}
        return {"type": "array", "items": item, "minItems": 1, "maxItems": MOST}

    such = f"a list of {either(tuple(words))} and radii, such as [{', '.join(words)}, 38]"
    return OwnForm("a list of radii", such, read, schema)


def check_radii(values: Values, low: float, high: float, reader: Reader) -> None:
    """Note radii of developments that lie on no flank: below `low` or above `high`, mm."""
    for file in values.get("export", {}).get("files", []):
        for i, radius in enumerate(file.get("at", ())):
            if not isinstance(radius, str) and not low - ROUNDED <= radius <= high + ROUNDED:
                remedy = f"give one from {reader.shown(low)} to {reader.shown(high)}"
                where = f"{file['path']}.{file['kind']}.at[{i}]"
                reader.fault_at(where, "no flank there", reader.shown(radius), remedy)
