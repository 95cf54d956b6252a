"""Recipes with faults: keys by chance from the JSON schema, and sound recipes of which one value is replaced."""

from __future__ import annotations

import copy
import json
from functools import cache
from typing import TYPE_CHECKING, Any

import yaml

from camgeo.recipe.starter import starter
from camgeo.registry.root import CAM, reading
from camgeo.schema.json_schema import json_schema

if TYPE_CHECKING:
    from collections.abc import Iterator
    from random import Random

    from camgeo.schema.fields import Schema

WRONG: tuple[Any, ...] = ("nought", [], {}, None, -1, 0, 1e300, True, "", ["x"], {"x": 1}, "3 parsec")
"""Values of which every key refuses most."""
BASES = ("disc-roller", "disc-arm", "disc-flat", "disc-groove", "support", "constant-breadth", "four-bar")
"""Starters whose cam stands in the half of the recipes by chance, so that the other keys meet a sound cam."""


@cache
def schema(order: str) -> Schema:
    """The schema of a kind of recipe with the keys of all capabilities."""
    return json_schema(reading(order).table())


def by_schema(rng: Random, order: str = CAM) -> str:
    """A recipe whose keys and values come by chance from the schema: few are sound, and most have several faults."""
    data = _mapping(rng, schema(order), rng.choice([0.0, 0.02, 0.1]))
    if order == CAM and rng.random() < 0.5:
        data["cam"] = _cam(rng.choice(BASES))
    return json.dumps(data)  # a JSON text is a YAML one


@cache
def _cam(name: str) -> dict[str, Any]:
    """The cam of a starter."""
    cam: dict[str, Any] = yaml.safe_load(starter(name))["cam"]
    return cam


def _mapping(rng: Random, about: Schema, wrong: float) -> dict[str, Any]:
    """Keys and values of a mapping; `wrong` is the share of values that the schema refuses, and of keys left out."""
    fields, required = dict(about["properties"]), list(about.get("required", ()))
    if "oneOf" in about and rng.random() >= wrong:
        chosen = rng.choice(about["oneOf"])
        required += chosen.get("required", ())
        for name in chosen.get("properties", ()):
            fields.pop(name, None)
    share = rng.choice([0.05, 0.3, 0.7])
    names = [name for name in fields if (name in required and rng.random() >= wrong) or rng.random() < share]
    return {name: _value(rng, fields[name], wrong) for name in names}


def _value(rng: Random, about: Schema, wrong: float) -> Any:
    if rng.random() < wrong:
        return copy.deepcopy(rng.choice(WRONG))
    if "const" in about:
        return about["const"]
    if "enum" in about:
        return rng.choice(about["enum"])
    if "properties" in about:
        return _mapping(rng, about, wrong)
    for either in ("anyOf", "oneOf"):
        if either in about:
            return _value(rng, rng.choice(about[either]), wrong)
    kinds = about.get("type")
    match rng.choice(kinds) if isinstance(kinds, list) else kinds:
        case "object":
            entries = about.get("additionalProperties")
            below = entries if isinstance(entries, dict) else {}
            return {str(name): _value(rng, below, wrong) for name in rng.sample([1, 2, 3, 5, 7], rng.randrange(1, 3))}
        case "array":
            count = rng.randrange(about.get("minItems", 0), min(4, about.get("maxItems", 4)) + 1)
            return [_value(rng, about.get("items", {}), wrong) for _ in range(count)]
        case "boolean":
            return rng.random() < 0.5
        case "number" | "integer" as kind:
            low = max(about.get("minimum", 0), about.get("exclusiveMinimum", 0))
            high = min(about.get("maximum", 60), 60)
            number = rng.choice([low, high, rng.uniform(low, high), rng.randint(0, 60), 8])
            return int(number) if kind == "integer" else number
    if about.get("pattern", "").startswith("^(?=.*"):  # a number with its unit
        return rng.choice(["12", "1/2", "3 mm", "4deg", "2*pi", "5 N"])
    return rng.choice(["x", "2", "1/2", "t", "H7", "lift.csv"])


def leaves(node: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Paths of all values below a node, mappings and lists among them."""
    entries = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in entries:
        yield (*path, key)
        yield from leaves(value, (*path, key))


def holder(data: Any, path: tuple[Any, ...]) -> Any:
    """The mapping or list that holds the value at a path."""
    for key in path[:-1]:
        data = data[key]
    return data


def one_wrong(text: str, wrong: object) -> Iterator[str]:
    """The recipe once for each of its values, mappings and lists among them, which is replaced by `wrong`."""
    data = yaml.safe_load(text)
    for path in list(leaves(data)):
        spoilt = copy.deepcopy(data)
        holder(spoilt, path)[path[-1]] = wrong
        yield json.dumps(spoilt)
