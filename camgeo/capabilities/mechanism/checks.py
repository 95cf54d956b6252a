"""The checks of printed bodies; clearance and collision are figures too, which recipes may limit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declared import LAST_EXACT, READABLE, Declared

if TYPE_CHECKING:
    from camgeo.checks.declared import CheckFacts
    from camgeo.checks.remedies import Entry
    from camgeo.recipe.recipe import Recipe

NAME = "mechanism"  # of this capability
IN_PLAN = ("wall", "bar", "pin", "knob")  # sizes that decide whether bodies meet


def _has_bodies(scene: CheckFacts) -> bool:
    return any(request.variant == NAME for request in scene.recipe.export.files)


def slimmer_sizes(recipe: Recipe) -> str:
    """Remedy for bodies that meet: the sizes in plan that the recipe gives made smaller, or else a smaller pin."""
    fields = [f"{NAME}.{size}" for size in IN_PLAN if f"{NAME}.{size}" in recipe.marks] or [f"{NAME}.pin"]
    return f"a smaller {fields[0]}" if len(fields) == 1 else f"smaller {', '.join(fields[:-1])} and {fields[-1]}"


def _apart(_check: Entry, _report: Entry, recipe: Recipe) -> str:
    return slimmer_sizes(recipe)


CLEARANCE = Declared("clearance", ("mm",), _has_bodies, strict_at=(0.0,), after=LAST_EXACT)
COLLISION = Declared("collision", ("mm",), _has_bodies, field=NAME, remedy=_apart, after=LAST_EXACT)
OUTLINE = Declared("outline", ("mm",), after=READABLE.name)  # never expected: files of bodies beside the cam follow
CHECKS = (CLEARANCE, COLLISION, OUTLINE)
