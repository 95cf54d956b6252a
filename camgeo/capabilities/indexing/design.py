"""An indexing cam before any file: its motion over all turns, its flanks, and the bore."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

from camgeo.capabilities.indexing.flank import Flank
from camgeo.part.body import bore_of
from kin.numeric.lengths import in_unit
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from camgeo.capabilities.indexing.index_recipe import IndexRecipe
    from camgeo.capabilities.indexing.law import IndexLaw
    from camgeo.part.shapes import Opening
    from camgeo.schema.errors import RecipeErrors
    from kin.law.sources.motion import Motion

ROUNDING = 1e-9  # of a turn


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
        sizes = (recipe.roller.radius, -1), (recipe.roller.radius + recipe.clearance, 1)
        flanks = (Flank(recipe.form, self.law, recipe.start, *each) for each in sizes)
        return {flank.name: flank for flank in flanks}

    def resized(self, radius: float) -> IndexDesign:
        """Design with rollers of another radius, mm."""
        recipe = self.recipe
        return replace(self, recipe=replace(recipe, roller=replace(recipe.roller, radius=radius)))

    def cleared(self, clearance: float) -> IndexDesign:
        """Design with another clearance of the groove, mm; a clearance below 0 is a preload."""
        return replace(self, recipe=replace(self.recipe, clearance=clearance))

    def shortened(self, length: float) -> IndexDesign:
        """Design of another length, mm, with the turret's axis half way up."""
        recipe, turret = self.recipe, self.recipe.turret
        form = replace(turret.form, length=length, height=0.5 * length)
        return replace(self, recipe=replace(recipe, turret=replace(turret, form=form)))

    @property
    def largest(self) -> float:
        """The larger radius of a roller, mm, of those of both flanks."""
        return self.recipe.roller.radius + max(self.recipe.clearance, 0.0)

    @property
    def bearing(self) -> tuple[float, float]:
        """Least and greatest place along a roller, mm, at which it bears and may touch metal."""
        roller, (low, high) = self.recipe.roller, self.recipe.form.reach(self.largest)
        return max(roller.inner, low), min(roller.outer, high)

    def rolled(self, inner: float, outer: float) -> IndexDesign:
        """Design with rollers that bear from `inner` to `outer` along their axes, mm."""
        recipe = self.recipe
        return replace(self, recipe=replace(recipe, roller=replace(recipe.roller, inner=inner, outer=outer)))

    @property
    def spanned(self) -> tuple[float, float]:
        """Angles on the turret, rad, between which a roller of either flank touches the cam."""
        return self.recipe.form.spanned(self.largest)

    @cached_property
    def turns(self) -> range:
        """Whole turns of the cam after which the roller that is at `start` at turn 0 may touch it."""
        (low, high), (least, most) = self.spanned, self.motion.range
        first = math.ceil((low - self.recipe.start - most) / self.recipe.advance - ROUNDING)
        return range(first, math.floor((high - self.recipe.start - least) / self.recipe.advance + ROUNDING) + 1)

    @property
    def bore(self) -> Opening | None:
        """The bore with its keyway, as for a cam that is not mirrored; None without one."""
        return next(iter(bore_of(self.recipe.part)), None)

    def error(self, field: str, problem: str, remedy: str = "") -> RecipeErrors:
        """Error at a field of the recipe, or at its nearest parent that is given; lengths are in the recipe's unit."""
        return self.recipe.error(self.recipe.stated(field), in_recipe(self.recipe, problem), None, remedy)


def in_recipe(recipe: IndexRecipe, words: str) -> str:
    """Words with lengths in the recipe's unit."""
    return in_unit(words, recipe.mm, "in" if recipe.units == "inch" else "mm")
