"""The features there are: a new one is its file and its name here."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from camgeo.part.feature import Boss, Feature
    from camgeo.schema.reader import Values

NAMES = ("keyway", "flat", "hub", "set_screw", "bolts", "dowel", "slot", "chamfer", "mark", "lightening")
"""In the order of the keys, and in that in which they take their place."""
FEATURES: tuple[Feature[Any], ...] = tuple(import_module(f"camgeo.part.{name}").FEATURE for name in NAMES)
RECORDS = {feature.kind: feature for feature in FEATURES}
EDGE_KEYS = tuple(f"part.{feature.name}" for feature in FEATURES if feature.edge is not None)
"""Paths of the keys that chamfer the edges of the contour."""


def with_records(values: Iterable[object]) -> list[tuple[Feature[Any], Any]]:
    """Pairs of a feature's record and its value, in the order of the values; raises KeyError for no feature's value."""
    return [(RECORDS[type(value)], value) for value in values]


def boss_of(values: Iterable[object]) -> Boss | None:
    """Boss of a part with features of these values; None without one."""
    return next((feature.boss(value) for feature, value in with_records(values) if feature.boss is not None), None)


def edge_of(values: Iterable[object]) -> float:
    """Chamfer along both edges of the contour of a part with features of these values, mm; 0 without one."""
    return sum((feature.edge(value) for feature, value in with_records(values) if feature.edge is not None), 0.0)


def built(part: Values) -> tuple[Any, ...]:
    """Values of the features by the keys of `part`, which are without fault, in the order of their names."""
    return tuple(value for feature in FEATURES if (value := feature.build(part)) is not None)


def values_read(part: Values) -> Iterator[object]:
    """Values of the features that make a boss or chamfer edges, from keys of `part` of which faulty ones are missing.

    A feature without one of its required keys is left out.
    """
    for feature in FEATURES:
        if feature.name in part and (feature.boss is not None or feature.edge is not None):
            table = feature.field.table
            if table is None or all(key.name in part[feature.name] for key in table.fields if key.required):
                yield feature.build(part)
