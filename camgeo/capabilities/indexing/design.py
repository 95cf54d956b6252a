"""An indexing cam before any file: its motion over all turns, its flanks, and the bore."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from camgeo.capabilities.indexing.flank import Flank
from camgeo.measures.placed import greatest_of
from camgeo.part.body import bore_of
from kin.numeric.angles import TURN
from kin.numeric.lengths import in_unit
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.index_recipe import IndexRecipe
    from camgeo.capabilities.indexing.law import IndexLaw
    from camgeo.part.shapes import Opening
    from camgeo.schema.errors import RecipeErrors
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array


@dataclass(frozen=True, eq=False)
class IndexDesign:
    """An indexing cam before any file: its recipe, the motion of one turn, and the motion over any number of turns.

    All is as for a cam that turns clockwise, seen from +z; `rotation: ccw` mirrors it (y -> -y).
    """

    recipe: IndexRecipe
    motion: Motion
    law: IndexLaw

    @cached_property
    def flanks(self) -> dict[str, Flank]:
        """Flanks by name: `lower` with the metal below, `upper` with the metal above, of its own larger roller."""
        recipe = self.recipe
        sizes = {"lower": recipe.roller.radius, "upper": recipe.roller.radius + recipe.clearance}
        sides = {"lower": -1, "upper": 1}
        return {name: Flank(recipe.form, self.law, recipe.start, sizes[name], sides[name]) for name in sizes}

    def greatest(self, figure: Callable[[Array], Array]) -> tuple[float, float]:
        """Greatest value of a figure over shaft angles (n,), rad, of one turn, and its angle, rad."""
        return greatest_of(figure, TURN)

    @property
    def bore(self) -> Opening | None:
        """The bore with its keyway, as for a cam that is not mirrored; None without one."""
        return next(iter(bore_of(self.recipe.part)), None)

    def error(self, field: str, problem: str, remedy: str = "") -> RecipeErrors:
        """Error at a field of the recipe, or at the nearest one above it that is given, in the recipe's unit."""
        return self.recipe.error(self.recipe.stated(field), in_recipe(self.recipe, problem), None, remedy)


def in_recipe(recipe: IndexRecipe, words: str) -> str:
    """Words with lengths in the recipe's unit."""
    return in_unit(words, recipe.mm, "in" if recipe.units == "inch" else "mm")
