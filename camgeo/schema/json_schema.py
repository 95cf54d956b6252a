"""The schema of a recipe as a JSON schema (draft 2020-12), for editors that complete and check while one types."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from camgeo.schema.fields import MOST, Field, FieldTable, Kind, length
from camgeo.schema.quantity import ANGLES, FORCES, LENGTHS, MASSES, MOMENTS, PRESSURES, RATES
from camgeo.schema.scalars import MOST_TEXT

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.schema.fields import Schema

# Texts that are numbers: 1e-3, which YAML 1.1 takes for a text, fractions and arithmetic. `load` judges their meaning.
_NUMBER_TEXT = r"(?=.*([0-9]|pi))([-+*/(). ]|[0-9]([eE][+-]?[0-9])?|pi)+"
_LENGTHS = {Kind.LENGTH, Kind.POINT, Kind.PAIR}
_EITHER = {Kind.STROKE, Kind.ERROR, Kind.OUTPUT, Kind.MOTION, Kind.BACKLASH}  # a length or an angle
_CARRIED: dict[Kind | None, tuple[str, ...]] = {
    Kind.FORCE: tuple(FORCES),
    Kind.MOMENT: tuple(MOMENTS),
    Kind.THRUST: (*FORCES, *MOMENTS),
    **dict.fromkeys((Kind.RATE, Kind.GIVING), tuple(RATES)),
    Kind.PRESSURE: tuple(PRESSURES),
    **dict.fromkeys((Kind.MASS, Kind.INERTIA), tuple(MASSES)),
}
_NAME = r"^[A-Za-z0-9_][A-Za-z0-9._-]{0,63}$"
_RATIO = r"^[0-9]+(/[0-9]+)?$"


def json_schema(root: FieldTable) -> Schema:
    """JSON schema of a recipe with these keys; `load` refuses every recipe that the schema refuses, and more."""
    draft = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": draft, "title": "camgeo recipe", **table_schema(root)}


def table_schema(table: FieldTable) -> Schema:
    """JSON schema of a mapping with the keys of a table."""
    schema: Schema = {
        "type": "object",
        "properties": {field.name: _field(field) for field in table.fields},
        "additionalProperties": False,
    }
    if required := [field.name for field in table.fields if field.required]:
        schema["required"] = required
    if table.alternatives:
        names = [name for name, _ in table.alternatives]
        schema["oneOf"] = [_alternative(table, name) for name in names]
        if table.optional:
            schema["oneOf"].append({"required": [], "properties": dict.fromkeys(sorted(names), False)})
    return schema


def _alternative(table: FieldTable, chosen: str) -> Schema:
    """Schema of one alternative with its companions and no other alternative."""
    companions = dict(table.alternatives)
    with_it = (chosen, *companions[chosen])
    all_names = {name for key, names in companions.items() for name in (key, *names)}
    excluded = all_names - set(with_it)
    needed = [name for name in with_it if name == chosen or not table.field(name).default]
    return {"required": needed, "properties": dict.fromkeys(sorted(excluded), False)}


def _field(field: Field) -> Schema:
    about = {"description": field.about} if field.about else {}
    if field.default:
        about["description"] += f" (default: {field.default})"
    return {**about, **_kind(field)}


def _kind(field: Field) -> Schema:
    if field.form is not None:
        return field.form.schema(field)
    match field.kind:
        case Kind.TEXT:
            return {"type": ["string", "number", "boolean"], "maxLength": MOST_TEXT}
        case Kind.NAME:
            return {"type": ["string", "number", "boolean"], "pattern": _NAME}
        case Kind.FORMULA:
            return {"type": ["string", "number"]}
        case Kind.RATIO:
            return {"anyOf": [{"type": "integer", "minimum": 2}, {"type": "string", "pattern": _RATIO}]}
        case Kind.CHOICE:
            return {"enum": list(field.choices)}
        case Kind.POINT:
            return {"type": "array", "items": number_schema(unit=Kind.LENGTH), "minItems": 2, "maxItems": 2}
        case Kind.PAIR:
            return {"type": "array", "items": number_schema(length("", "")), "minItems": 2, "maxItems": 2}
        case Kind.TRUTH:
            return {"type": "boolean"}
        case Kind.NUMBERS:
            items = number_schema(None if field.at_least is None else field.entry)
            return {"type": "array", "items": items, "minItems": 1, "maxItems": field.most}
        case Kind.HARMONICS:
            return {"type": "object", "additionalProperties": number_schema(unit=field.unit)}
        case Kind.TABLE:
            return table_schema(field.inner)
        case _:
            return number_schema(field)


def number_schema(field: Field | None = None, unit: Kind | None = None) -> Schema:
    """JSON schema of a number within the bounds of its field, or of a text with a number and a unit of its kind.

    Without a field, `unit` is the kind of the number, and the bounds only guard against slips.
    """
    number: Schema = {"type": "number"}
    if field is not None:
        bounds = {"exclusiveMinimum": field.above, "minimum": field.at_least, "maximum": field.at_most}
        number.update({key: bound for key, bound in bounds.items() if bound is not None})
        if field.kind is Kind.INTEGER:
            number["type"] = "integer"
            if field.odd:
                number["not"] = {"multipleOf": 2}
    else:
        number["minimum"], number["maximum"] = -(MOST**2), MOST**2
    kind = unit if field is None else field.unit or field.kind
    units = [*(LENGTHS if kind in _LENGTHS | _EITHER else ()), *(ANGLES if kind in _EITHER | {Kind.ANGLE} else ())]
    units += _CARRIED.get(kind, ())
    text = f"^{_NUMBER_TEXT}({'|'.join(map(re.escape, units))})?$" if units else f"^{_NUMBER_TEXT}$"
    return {"anyOf": [number, {"type": "string", "pattern": text}]}


def one_of_schema(noun: str, tables: Mapping[str, FieldTable]) -> Schema:
    """JSON schema of a mapping whose `kind` chooses one of the tables; `noun` is what the mapping describes."""
    kinds = []
    for kind, table in tables.items():
        schema = table_schema(table)
        schema["properties"] = {"kind": {"const": kind, "description": f"the kind of {noun}"}, **schema["properties"]}
        schema["required"] = ["kind", *schema.get("required", [])]
        kinds.append(schema)
    return {"oneOf": kinds}
