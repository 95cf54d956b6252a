"""The checks of a set, of which each may be limited as a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declared import LIGHTENING, READABLE, Declared

if TYPE_CHECKING:
    from camgeo.checks.declared import Scene
    from camgeo.checks.remedies import Entry
    from camgeo.recipe.recipe import Recipe

NAME = "mechanism"  # of this capability
IN_PLAN = ("wall", "bar", "pin", "knob")  # sizes on which it hangs whether bodies meet


def _bodies(scene: Scene) -> bool:
    return any(request.variant == NAME for request in scene.recipe.export.files)


def slimmer(recipe: Recipe) -> str:
    """Tell which sizes would keep bodies apart: those that the recipe gives, or that from which the others follow."""
    given = [f"{NAME}.{size}" for size in IN_PLAN if f"{NAME}.{size}" in recipe.marks] or [f"{NAME}.pin"]
    return f"a smaller {given[0]}" if len(given) == 1 else f"smaller {', '.join(given[:-1])} and {given[-1]}"


def _apart(_check: Entry, _report: Entry, recipe: Recipe) -> str:
    return slimmer(recipe)


CLEARANCE = Declared("clearance", ("mm",), _bodies, strict_at=(0.0,), after=LIGHTENING.name)
COLLISION = Declared("collision", ("mm",), _bodies, field=NAME, remedy=_apart, after=LIGHTENING.name)
OUTLINE = Declared("outline", ("mm",), after=READABLE.name)  # of the other bodies, whose files are not foreseen
CHECKS = (CLEARANCE, COLLISION, OUTLINE)
