"""A cylindrical cam before any file: motion, flanks, how far they are regular, and the bore."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.crossings import crossings_of
from camgeo.capabilities.cylindrical.flank import Flank
from camgeo.capabilities.cylindrical.sheet import cut_sheet, whole_sheet
from camgeo.capabilities.cylindrical.undercut import cut_at, demand_regular, tips
from camgeo.curve.curve import CurveError
from camgeo.measures.placed import SEEK, greatest_of
from camgeo.part.body import bore_of
from kin.numeric.angles import TURN
from kin.numeric.lengths import in_unit
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.cylindrical.crossings import Crossing
    from camgeo.capabilities.cylindrical.drum_recipe import DrumRecipe
    from camgeo.capabilities.cylindrical.sheet import Sheet
    from camgeo.capabilities.cylindrical.undercut import Cut, Tip
    from camgeo.part.shapes import Opening
    from camgeo.schema.errors import RecipeErrors
    from kin.law.piecewise import Piecewise
    from kin.law.sources.motion import Motion
    from kin.numeric.arrays import Array

CUT_ROWS = 48  # on which what is cut away is known for figures


@dataclass(frozen=True, eq=False)
class DrumDesign:
    """A cylindrical cam before any file: its recipe, its motion over the shaft angle, and the motion with its period.

    All is as for a drum that turns clockwise, seen from +z; `rotation: ccw` mirrors it (y -> -y).
    """

    recipe: DrumRecipe
    motion: Motion
    law: Piecewise

    @cached_property
    def flanks(self) -> dict[str, Flank]:
        """Flanks by name: `lower` with the metal below, `upper` with the metal above."""
        roller = self.recipe.roller
        return self.recipe.track.flanks(Flank(self.law, self.recipe.guide, roller.radius, -1, roller.taper, roller.at))

    @cached_property
    def crossings(self) -> list[Crossing]:
        """Crossings of the tracks of a groove of several turns; raises CrossingError as `crossings_of` does."""
        if self.recipe.turns == 1:
            return []
        return crossings_of(self.flanks, self.recipe.floor, self.recipe.radius)

    @cached_property
    def gaps(self) -> list[float]:
        """Length, mm, over which a track lacks a wall at each crossing, at that end of the shoe where it is longer."""
        return [max(crossing.gap(r) for r in self.recipe.bearing) for crossing in self.crossings]

    @property
    def gap_in_files(self) -> float:
        """Greatest gap, mm, of a solid that is within its tolerance: the judge counts what lies so near as gone."""
        export = self.recipe.export
        solids = [request for request in export.files if request.format.solid]
        within = max((request.tolerance or export.tolerance for request in solids), default=0.0)
        found = (each.gap_within(r, within) for each in self.crossings for r in self.recipe.bearing)
        return max([*self.gaps, *found], default=0.0)

    def greatest(self, figure: Callable[[Array], Array]) -> tuple[float, float]:
        """Greatest value of a figure over shaft angles (n,), rad, of the period, and its angle, rad."""
        begin = 0.0
        if self.recipe.turns > 1:
            places = np.linspace(0.0, self.recipe.period, self.recipe.turns * SEEK + 1)
            begin = TURN * min(int(np.argmax(figure(places))) // SEEK, self.recipe.turns - 1)
        value, at = greatest_of(lambda theta: figure(theta + begin), TURN)
        return value, at + begin

    def sheet(self, name: str, tolerance: float) -> Sheet:
        """Points and grid of a flank within a tolerance, mm; raises ToleranceError where it cannot be held."""
        ends = self.recipe.floor, self.recipe.radius
        if self.tips[name]:
            return cut_sheet(self.flanks[name], *ends, tolerance, self.tips[name])
        return whole_sheet(self.flanks[name], *ends, tolerance)

    @cached_property
    def tips(self) -> dict[str, list[Tip]]:
        """Tips of the undercuts of each flank, none of a flank that is proved regular from floor to blank.

        Raises CurveError where a flank is neither proved regular nor found undercut.
        """
        found: dict[str, list[Tip]] = {}
        for name, flank in self.flanks.items():
            ends = self.recipe.floor, self.recipe.radius
            try:
                demand_regular(flank, *ends)
                found[name] = []
            except CurveError:
                found[name] = tips(flank, *ends)
                if not found[name]:
                    raise
        return found

    @cached_property
    def cuts(self) -> dict[str, list[Cut]]:
        """What other rollers cut away of each flank, from its floor to the tip of each undercut.

        Raises CutError where two undercuts reach into one another.
        """
        found = {}
        for name, flank in self.flanks.items():
            share = (1.0 - np.arange(CUT_ROWS) / CUT_ROWS) ** 2
            rows = [tip.r - (tip.r - self.recipe.floor) * share for tip in self.tips[name]]
            found[name] = [cut_at(flank, tip, r) for tip, r in zip(self.tips[name], rows, strict=True)]
        return found

    @property
    def bore(self) -> Opening | None:
        """The bore with its keyway, as for a drum that is not mirrored; None without one."""
        return next(iter(bore_of(self.recipe.part)), None)

    def error(self, field: str, problem: str, remedy: str = "") -> RecipeErrors:
        """Error at a field of the recipe, or at its nearest parent that is given; lengths are in the recipe's unit."""
        return self.recipe.error(self.recipe.stated(field), in_recipe(self.recipe, problem), None, remedy)


def in_recipe(recipe: DrumRecipe, words: str) -> str:
    """Words with lengths in the recipe's unit."""
    return in_unit(words, recipe.mm, "in" if recipe.units == "inch" else "mm")
