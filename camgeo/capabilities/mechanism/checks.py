"""The checks of a set, of which each may be limited as a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from camgeo.checks.declared import LIGHTENING, READABLE, Declared

if TYPE_CHECKING:
    from camgeo.checks.declared import Scene

NAME = "mechanism"  # of this capability


def _bodies(scene: Scene) -> bool:
    return any(request.variant == NAME for request in scene.recipe.export.files)


CLEARANCE = Declared("clearance", ("mm",), _bodies, strict_at=(0.0,), after=LIGHTENING.name)
COLLISION = Declared("collision", ("mm",), _bodies, after=LIGHTENING.name)
OUTLINE = Declared("outline", ("mm",), after=READABLE.name)  # of the other bodies, whose files are not foreseen
CHECKS = (CLEARANCE, COLLISION, OUTLINE)
