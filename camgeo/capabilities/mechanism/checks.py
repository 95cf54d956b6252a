"""The checks of printed bodies; clearance and collision are figures too, which recipes may limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.capabilities.mechanism.figures import FIGURES
from camgeo.checks.declaration import Declared
from camgeo.checks.declared import LAST_EXACT, READABLE
from camgeo.checks.extension import Checks

if TYPE_CHECKING:
    from camgeo.checks.declaration import CheckFacts, Entry
    from camgeo.recipe.recipe import Recipe

NAME = "mechanism"  # of this capability
IN_PLAN = ("wall", "bar", "pin", "knob")  # sizes that decide whether bodies meet


def _has_bodies(facts: CheckFacts) -> bool:
    return any(request.variant == NAME for request in facts.recipe.export.files)


def slimmer_sizes(recipe: Recipe) -> str:
    """Remedy for bodies that meet: the sizes in plan that the recipe gives made smaller, or else a smaller pin."""
    fields = [f"{NAME}.{size}" for size in IN_PLAN if f"{NAME}.{size}" in recipe.marks] or [f"{NAME}.pin"]
    return f"a smaller {fields[0]}" if len(fields) == 1 else f"smaller {', '.join(fields[:-1])} and {fields[-1]}"


def _apart(_check: Entry, _report: Entry, recipe: Recipe) -> str:
    return slimmer_sizes(recipe)


def _remedy(recipe: Recipe, figure: str, value: float, bound: float) -> str:
    """Words for a change that brings a figure of bodies to its bound, mm; empty for other figures."""
    if figure not in FIGURES:
        return ""
    if figure == COLLISION.name and value <= 0.0:
        return slimmer_sizes(recipe)
    return f"a {'larger' if value < bound else 'smaller'} mechanism.clearance"


CLEARANCE = Declared("clearance", ("mm",), _has_bodies, strict_at=(0.0,), after=LAST_EXACT)
COLLISION = Declared("collision", ("mm",), _has_bodies, field=NAME, remedy=_apart, after=LAST_EXACT)
OUTLINE = Declared("outline", ("mm",), after=READABLE.name)  # never expected: files of bodies beside the cam follow
ANSWERS = Checks(checks=(CLEARANCE, COLLISION, OUTLINE), remedy=_remedy)
