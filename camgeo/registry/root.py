"""Kinds of recipes as their reading sees them: a recipe of one cam, and those that capabilities read.

A text is a recipe of the kind whose key stands at its top level or is its `cam.kind`, or of a disc cam.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from camgeo.registry import registry
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from camgeo.schema.fields import FieldTable
    from camgeo.schema.reader import Reader
    from camgeo.schema.yaml_source import Source

R = TypeVar("R")
CAM = "cam"
_OF_A_CAM = "camgeo.recipe.recipe"  # the module that has the core's own
_LEAST_ANGLE = "camgeo.measures.least_angle"  # what a cam leaves open is computed by figures, above recipes


@dataclass(frozen=True, kw_only=True)
class Reading(Generic[R]):
    """Functions that read one kind of recipe.

    table    table of the recipe's keys
    read     recipe of a parsed text, at a path; raises RecipeErrors with all faults
    reader   reader that has read a parsed text: it knows the field and the unit of each value; None where none is given
    noun     what such a recipe is of, without an article: `camshaft`
    instead  the recipe to give in its place where one of a disc cam is needed: `the recipe of a lobe`
    """

    table: Callable[[], FieldTable]
    read: Callable[[Source, Path], R]
    reader: Callable[[Source], Reader] | None = None
    noun: str = "disc cam"
    instead: str = ""


def folders() -> dict[str, str]:
    """Name of the capability that reads recipes of another kind than a disc cam, by the key of the kind."""
    return {key: name for name, label in registry.labels().items() for key in (*label.roots, *label.kinds)}


def top_keys() -> tuple[str, ...]:
    """Keys of the top level that make a text a recipe of another kind than a disc cam."""
    return tuple(key for label in registry.labels().values() for key in label.roots)


def kinds() -> dict[str, str]:
    """Kinds of cams that make a text a recipe of another kind, each with what such cams are made for."""
    return {kind: words for label in registry.labels().values() for kind, words in label.kinds.items()}


def slips() -> dict[str, str]:
    """Words that some write in place of such a kind, each with the kind that is meant."""
    return {word: kind for label in registry.labels().values() for word, kind in label.slips.items()}


def reading(key: str) -> Reading[Any]:
    """Functions that read a kind of recipe, by its key; raises KeyError for a key that no kind of recipe has."""
    module = _OF_A_CAM if key == CAM else f"{registry.PACKAGE}.{folders()[key]}.root"
    functions: Reading[Any] = import_module(module).READING
    return functions


def settle(recipe: R) -> R:
    """Recipe of a cam with the values of its motion that it leaves open computed.

    Raises RecipeErrors where no such values exist.
    """
    compute: Callable[[R], R] = import_module(_LEAST_ANGLE).with_least_angle
    return compute(recipe)
