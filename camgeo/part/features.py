"""The features there are: a new one is its file and its name here."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable

    from camgeo.part.feature import Feature

NAMES = ("keyway", "flat", "hub", "set_screw", "bolts", "dowel", "slot", "chamfer", "mark", "lightening")
"""In the order of the keys, and in that in which they take their place."""
FEATURES: tuple[Feature[Any], ...] = tuple(import_module(f"camgeo.part.{name}").FEATURE for name in NAMES)
RECORDS = {feature.kind: feature for feature in FEATURES}


def with_records(values: Iterable[object]) -> list[tuple[Feature[Any], Any]]:
    """Pairs of a feature's record and its value, in the order of the values."""
    return [(RECORDS[type(value)], value) for value in values]
