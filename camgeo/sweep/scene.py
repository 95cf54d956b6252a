"""What is computed of each design of a sweep: plain data that travels to any worker, and is part of the key."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from camgeo.recipe.model import Recipe


@dataclass(frozen=True)
class Scene:
    """A recipe with its sweep, without what has no bearing on a figure, and the names of the figures wanted."""

    recipe: Recipe
    figures: tuple[str, ...]

    @property
    def paths(self) -> tuple[str, ...]:
        """The fields that vary."""
        return tuple(axis.path for axis in self.recipe.sweep.vary) if self.recipe.sweep else ()
