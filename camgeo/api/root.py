"""Functions of each kind of recipe for commands and the library."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from camgeo.registry import registry
from camgeo.registry.root import CAM, folders
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from camgeo.api.check import Check
    from camgeo.api.shown import Shown
    from camgeo.output.extension import FileCall
    from camgeo.output.pipeline import Outcome
    from camgeo.recipe.recipe import Order
    from camgeo.synthesis.expected_checks import Foreseen

R = TypeVar("R", bound="Order")
_OF_A_CAM = "camgeo.api.cam"  # the module that has the core's own


class Designed(Protocol):
    """Protocol of a design that the library returns for any kind of recipe."""

    @property
    def checks(self) -> tuple[Check, ...]:
        """Checks of the design that need no file."""


@dataclass(frozen=True, kw_only=True)
class Root(Generic[R]):
    """Functions of one kind of recipe; lengths in mm.

    design   exact cams, in the form that the library returns
    export   writes and judges files: (recipe, folder, kinds of files or none for all, callback for each stage)
    check    makes and judges all files, and keeps none: (recipe, callback for each stage)
    judge    report on files of any origin: (recipe, paths, tolerance, mm of the unit of files that state none, gap)
    claimed  report on files that a capability judges: (recipe, name of the capability, arguments of `verify`)
    show     report on files of any origin, and the page that shows them; None where there is no page
    explain  text of several lines on a failed check: (check, report, recipe, name of the recipe's file)
    foresee  checks that a run will make
    shown    its cam as a page in a browser shows it; None where such a page does not take it
    """

    design: Callable[[R], Designed]
    export: Callable[[R, Path, tuple[str, ...], Callable[[str], None]], Outcome]
    check: Callable[[R, Callable[[str], None]], Outcome]
    judge: Callable[[R, list[Path], float | None, float | None, float | None], dict[str, Any]]
    claimed: Callable[[R, str, FileCall], dict[str, Any]]
    explain: Callable[[dict[str, Any], dict[str, Any], R, str | None], str]
    foresee: Callable[[R], Sequence[Foreseen]]
    show: Callable[[R, list[Path], float | None, float | None, float | None], tuple[dict[str, Any], str]] | None = None
    shown: Callable[[R], Shown] | None = None


def root_of(recipe: R) -> Root[R]:
    """Functions of a recipe's kind."""
    return root_by_key(recipe.root)


def root_by_key(key: str) -> Root[Any]:
    """Functions of a kind of recipe, by its key; raises KeyError for a key that no kind of recipe has."""
    module = _OF_A_CAM if key == CAM else f"{registry.PACKAGE}.{folders()[key]}.root"
    functions: Root[Any] = import_module(module).ROOT
    return functions
