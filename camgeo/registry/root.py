"""Kinds of recipes as the core sees them: a recipe of one cam, and those that capabilities read.

A text is a recipe of the kind whose key stands at its top level, or of one cam. The types below stand above this
module: imports upwards are for types alone.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from camgeo.registry import registry
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.api.check import Check
    from camgeo.output.pipeline import Outcome
    from camgeo.recipe.recipe import Order
    from camgeo.registry.capability import FileCall
    from camgeo.schema.fields import FieldTable
    from camgeo.schema.yaml_source import Source
    from camgeo.synthesis.expected_checks import Foreseen

R = TypeVar("R", bound="Order")
CAM = "cam"
_OF_A_CAM = "camgeo.api.cam"  # the module that has the core's own


class Designed(Protocol):
    """Protocol of a design that the library returns for any kind of recipe."""

    @property
    def checks(self) -> tuple[Check, ...]:
        """Checks of the design that need no file."""


@dataclass(frozen=True, kw_only=True)
class Root(Generic[R]):
    """Functions of one kind of recipe for commands and the library; lengths in mm.

    table    table of the recipe's keys
    read     recipe of a parsed text, at a path; raises RecipeErrors with all faults
    design   exact cams, in the form that the library returns
    export   writes and judges files: (recipe, folder, kinds of files or none for all, callback for each stage)
    check    makes and judges all files, and keeps none: (recipe, callback for each stage)
    judge    report on files of any origin: (recipe, paths, tolerance, mm of the unit of files that state none, gap)
    claimed  report on files that a capability judges: (recipe, name of the capability, arguments of `verify`)
    settle   recipe with the values of its motion that it leaves open computed; None: none may be left open
    show     report on files of any origin, and the page that shows them; None where there is no page
    explain  text of several lines on a failed check: (check, report, recipe, name of the recipe's file)
    foresee  checks that a run will make
    instead  remedy for a command that takes recipes of one cam alone
    """

    table: Callable[[], FieldTable]
    read: Callable[[Source, Path], R]
    design: Callable[[R], Designed]
    export: Callable[[R, Path, tuple[str, ...], Callable[[str], None]], Outcome]
    check: Callable[[R, Callable[[str], None]], Outcome]
    judge: Callable[[R, list[Path], float | None, float | None, float | None], dict[str, Any]]
    claimed: Callable[[R, str, FileCall], dict[str, Any]]
    explain: Callable[[dict[str, Any], dict[str, Any], R, str | None], str]
    foresee: Callable[[R], Sequence[Foreseen]]
    show: Callable[[R, list[Path], float | None, float | None, float | None], tuple[dict[str, Any], str]] | None = None
    settle: Callable[[R], R] | None = None
    instead: str = ""


def folders() -> dict[str, str]:
    """Name of the capability that reads recipes of another kind than a cam, by the key of the kind."""
    return {key: name for name, label in registry.labels().items() for key in label.roots}


def root(key: str) -> Root[Any]:
    """Record of a kind of recipe by its key; raises KeyError for a key that no kind of recipe has."""
    if key == CAM:
        record: Root[Any] = import_module(_OF_A_CAM).ROOT
        return record
    return registry.capability(folders()[key]).roots[key]


def root_of(recipe: R) -> Root[R]:
    """Record of a recipe's kind."""
    return root(recipe.root)


def settle(recipe: R) -> R:
    """Recipe with the values of its motion that it leaves open computed; the same recipe where its kind has none.

    Raises RecipeErrors where no such values exist.
    """
    settle_kind = root_of(recipe).settle
    return recipe if settle_kind is None else settle_kind(recipe)
