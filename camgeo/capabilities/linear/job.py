"""A plate in the making: its fits, and the files that come of it with kin's verdicts."""

from __future__ import annotations

from functools import cached_property, partial
from typing import TYPE_CHECKING

from camgeo.capabilities.linear.design import in_recipe
from camgeo.fit.cache import Fits, formula_rounding
from camgeo.output.refusals import refusals
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.common.clock import Clock
    from camgeo.recipe.export import FileRequest


@dataclass(frozen=True, eq=False)
class Job:
    """A plate in the making: its design and the fits of its outlines, by how much the metal is drawn larger, mm."""

    design: LinearDesign
    clock: Clock
    kept: dict[tuple[str, float], Fits] = field(default_factory=dict)

    def fits(self, name: str, out: float = 0.0) -> Fits:
        """Fits of the outline, or of the `groove`."""
        if (name, out) not in self.kept:
            curve = self.design.groove if name == "groove" else self.design.grown(out)
            unsure = self.design.motion.motion.rounding * self.design.path.guide.reach
            self.kept[name, out] = Fits(curve, self.clock, formula_rounding(unsure, curve))
        return self.kept[name, out]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the fitted outlines, the outermost first."""
        return ("outline",) if self.design.recipe.groove is None else ("outline", "groove")

    def tolerance(self, request: FileRequest) -> float:
        """Tolerance of a file, mm."""
        return self.design.recipe.tolerance(request)

    def refusals(self, request: FileRequest) -> AbstractContextManager[None]:
        """Context that turns errors of a fit or a writer into those of the recipe."""
        return refusals(self.design.recipe, request, partial(in_recipe, self.design.recipe))
