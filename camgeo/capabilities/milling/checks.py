"""The checks of programs for machines: what the machine does on the way."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declaration import Declared
from camgeo.checks.declared import WATERTIGHT
from camgeo.checks.extension import Checks

if TYPE_CHECKING:
    from camgeo.checks.declaration import CheckFacts, Entry
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe


def _program(_: CheckFacts, file: FileRequest) -> bool:
    return file.format.program


def _pocketed(facts: CheckFacts, file: FileRequest) -> bool:
    """Whether a milling program cuts the groove between two surfaces that one touch runs on."""
    follower = facts.follower
    return file.format.program and follower.arrangement.contacts < len(follower.contacts)


def other_entry(check: Entry, _report: Entry, recipe: Recipe) -> str:
    """Remedy in words: another place where the cutter comes to the path.

    Empty for a check without a value, as where the cutter runs into a hub, or a recipe without `manufacture`.
    """
    if check["value"] is None or recipe.manufacture is None:
        return ""
    return "another manufacture.start, or a smaller manufacture.lead_in"


_FIELD, _AFTER = "manufacture.start", WATERTIGHT.name
_CHECKS = (
    Declared("cutter", ("mm",), of_file=_program, after=_AFTER),
    Declared("arcs", ("mm",), of_file=_program, after=_AFTER),
    Declared("rapid", ("", "faults"), of_file=_program, after=_AFTER),
    Declared("depth", ("mm",), of_file=_program, after=_AFTER),
    Declared("floor", ("mm",), of_file=_pocketed, after=_AFTER),
    Declared("direction", ("", "faults"), of_file=_program, after=_AFTER),
    Declared("entry", ("deg",), of_file=_program, field=_FIELD, remedy=other_entry, after=_AFTER),
    Declared("gouge", ("mm",), of_file=_program, field=_FIELD, remedy=other_entry, after=_AFTER),
)
"""All of them, in the order in which they are foreseen."""
ANSWERS = Checks(checks=_CHECKS)
