"""The schema of a recipe as a JSON schema (draft 2020-12), for editors that complete and check while one types."""

from __future__ import annotations

from typing import Any, TypeAlias

from camgeo.recipe.model import MATCH
from camgeo.recipe.spec import (
    MOST,
    MOST_AXES,
    MOST_COEFFICIENTS,
    MOST_DYADS,
    MOST_FILES,
    MOST_SEGMENTS,
    MOST_TEXT,
    MOST_VALUES,
    Field,
    Kind,
    Table,
    length,
)
from camgeo.recipe.table_cam import CAMS
from camgeo.recipe.table_figures import FIGURES, bounds
from camgeo.recipe.table_linkage import DYADS, LINKAGES
from camgeo.recipe.table_part import STANDARD
from camgeo.recipe.table_sweep import RANGE
from camgeo.recipe.tables import FILES, RECIPE

Schema: TypeAlias = dict[str, Any]

# Texts that are numbers all the same: 1e-3, which YAML 1.1 takes for a text, fractions and plain arithmetic. What the
# signs mean is for `load` to say.
_NUMBER_TEXT = r"^(?=.*([0-9]|pi))([-+*/(). ]|[0-9]([eE][+-]?[0-9])?|pi)+$"
_NAME = r"^[A-Za-z0-9_][A-Za-z0-9._-]{0,63}$"
_RATIO = r"^[0-9]+(/[0-9]+)?$"


def json_schema() -> Schema:
    """Make the JSON schema of a recipe. What it refuses is refused by `load`; the reverse needs more than a schema."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "camgeo recipe",
        **_table(RECIPE),
    }


def _table(table: Table) -> Schema:
    found: Schema = {
        "type": "object",
        "properties": {field.name: _field(field) for field in table.fields},
        "additionalProperties": False,
    }
    if required := [field.name for field in table.fields if field.required]:
        found["required"] = required
    if table.alternatives:
        found["oneOf"] = [_alternative(table, name) for name, _ in table.alternatives]
    return found


def _alternative(table: Table, chosen: str) -> Schema:
    """One alternative with its companions, and no other alternative's."""
    companions = dict(table.alternatives)
    with_it = (chosen, *companions[chosen])
    others = {name for key, names in companions.items() for name in (key, *names)} - set(with_it)
    return {"required": list(with_it), "properties": dict.fromkeys(sorted(others), False)}


def _field(field: Field) -> Schema:
    about = {"description": field.about} if field.about else {}
    if field.default:
        about["description"] += f" (default: {field.default})"
    return {**about, **_kind(field)}


def _kind(field: Field) -> Schema:
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
            return {"type": "array", "items": _number(), "minItems": 2, "maxItems": 2}
        case Kind.PAIR:
            return {"type": "array", "items": _number(length("", "")), "minItems": 2, "maxItems": 2}
        case Kind.TRUTH:
            return {"type": "boolean"}
        case Kind.NUMBERS:
            return {"type": "array", "items": _number(), "minItems": 1, "maxItems": MOST_COEFFICIENTS}
        case Kind.HARMONICS:
            return {"type": "object", "additionalProperties": _number()}
        case Kind.BORE:
            return {"anyOf": [_number(length("", "")), _table(_below(field))]}
        case Kind.KEYWAY:
            return {"anyOf": [{"const": STANDARD}, _table(_below(field))]}
        case Kind.LAW:
            return {"anyOf": [{"enum": list(_laws())}, _table(_below(field))]}
        case Kind.TABLE:
            return _table(_below(field))
        case Kind.SEGMENTS:
            return {"type": "array", "items": _table(_below(field)), "minItems": 1, "maxItems": MOST_SEGMENTS}
        case Kind.FILES:
            formats = [Field(kind, Kind.TABLE, "", required=True, table=table) for kind, table in FILES.items()]
            items = {"anyOf": [{"enum": list(FILES)}, *(_table(Table((item,))) for item in formats)]}
            return {"type": "array", "items": items, "minItems": 1, "maxItems": MOST_FILES}
        case Kind.CAM:
            return _one_of("cam", CAMS)
        case Kind.LINKAGE:
            return _one_of("linkage", LINKAGES)
        case Kind.DYADS:
            return {"type": "array", "items": _one_of("dyad", DYADS), "minItems": 1, "maxItems": MOST_DYADS}
        case Kind.VARY:
            values = {"type": "array", "items": _number(), "minItems": 1, "maxItems": MOST_VALUES}
            axis = {"anyOf": [_table(RANGE), values]}
            return {"type": "object", "additionalProperties": axis, "minProperties": 1, "maxProperties": MOST_AXES}
        case Kind.LIMITS:
            limits = {name: {**_table(bounds(FIGURES[name])), "minProperties": 1} for name in field.choices}
            return {"type": "object", "properties": limits, "additionalProperties": False}
        case _:
            return _number(field)


def _number(field: Field | None = None) -> Schema:
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
    return {"anyOf": [number, {"type": "string", "pattern": _NUMBER_TEXT}]}


def _one_of(noun: str, tables: dict[str, Table]) -> Schema:
    """Make the schema of a mapping whose `kind` says which of the tables is its own."""
    kinds = []
    for kind, table in tables.items():
        found = _table(table)
        found["properties"] = {"kind": {"const": kind, "description": f"the kind of {noun}"}, **found["properties"]}
        found["required"] = ["kind", *found.get("required", [])]
        kinds.append(found)
    return {"oneOf": kinds}


def _below(field: Field) -> Table:
    if field.table is None:
        raise AssertionError(field.name)
    return field.table


def _laws() -> tuple[str, ...]:
    from kin.motion_sources.laws import NAMES

    return (*NAMES, MATCH)
