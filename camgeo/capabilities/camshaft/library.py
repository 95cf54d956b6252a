"""Designs of camshafts, exact and without files, and the text of a failed check."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.api import notebook
from camgeo.api.check import Check, Figures
from camgeo.api.design import Design
from camgeo.api.log import stage_reporter
from camgeo.capabilities.camshaft.lobes import lobe_checks, placed
from camgeo.common.arguments import numbers_of, short_repr, whole_of
from camgeo.common.clock import Clock
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.report import failure
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from camgeo.capabilities.camshaft.keys import CamshaftRecipe
    from camgeo.capabilities.camshaft.lobes import PlacedLobe
    from camgeo.checks.declaration import Entry
    from kin.numeric.arrays import Array

MOST_DERIVATIVE = 6  # of a lobe's motion by the shaft angle


@dataclass(frozen=True, eq=False)
class CamshaftDesign:
    """The exact cams of a camshaft, each where it stands on the shaft; no file is made.

    Checks and figures are in the camshaft's own units, each with its unit beside it, and name their lobe.
    """

    recipe: CamshaftRecipe
    _placed: tuple[PlacedLobe, ...] = field(repr=False)

    @cached_property
    def lobes(self) -> Mapping[str, Design]:
        """The design of each lobe by its name, in the order of the recipe; lobes of one recipe share the exact cam."""
        return {lobe.lobe.name: Design(lobe.lobe.recipe, lobe.design) for lobe in self._placed}

    @property
    def angles(self) -> Mapping[str, float]:
        """Shaft angle at which the motion of each lobe begins, rad from 0 to below a turn, by its name."""
        return {lobe.lobe.name: float(np.mod(lobe.zero, 2.0 * np.pi)) for lobe in self._placed}

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The checks that need no file: the checks of each cam, and that each lobe stands out of the shaft.

        Raises RecipeErrors and EventError as `figures` does, for figures that a lobe's recipe limits.
        """
        return tuple(Check.of(self.recipe, check) for check in lobe_checks(self.recipe, self._placed))

    @property
    def ok(self) -> bool:
        """Whether all checks that need no file hold; raises as `checks` does."""
        return all(check.ok for check in self.checks)

    @cached_property
    def figures(self) -> Figures:
        """The figures of each lobe, such as `radius-of-curvature, intake`.

        Raises RecipeErrors where a capability cannot measure its own, as a valve whose table of ratios ends too early,
        EventError where a valve's motion is too rough to follow.
        """
        return Figures(
            {
                f"{name}, {lobe}": figure
                for lobe, design in self.lobes.items()
                for name, figure in design.figures.items()
            }
        )

    def motion(self, theta: ArrayLike, *, derivative: int = 0) -> Array:
        """Positions of all followers at shaft angles theta, rad, or a derivative by the shaft angle, up to the sixth.

        A row for each lobe in the recipe's order, each of the shape of `theta`: lift above the lowest position in mm,
        or rad where the follower swings. Raises CallError for another order, and for angles that are not finite or rows
        of them that differ in length, TypeError for angles that are no numbers.
        """
        angle, order = numbers_of("theta", theta), whole_of("derivative", derivative)
        if not np.isfinite(angle).all():
            raise CallError("shaft angles are finite numbers, in radians")
        if order not in range(MOST_DERIVATIVE + 1):
            raise CallError(f"a derivative is one of order 0 to {MOST_DERIVATIVE}, not {short_repr(order)}")
        return np.array([lobe.rows(angle.ravel(), order)[order].reshape(angle.shape) for lobe in self._placed])

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.recipe.name!r}, {len(self._placed)} lobes)"

    def __str__(self) -> str:
        """Write the verdict on one line, and each check that fails on one more."""
        failed = [f"\n  {check}" for check in self.checks if not check.ok]
        return f"{self.recipe.name}: {'FAILED' if failed else 'ok'}  {len(self._placed)} lobes{''.join(failed)}"

    def _repr_svg_(self) -> str:
        from camgeo.capabilities.camshaft.diagrams import diagram

        return diagram(self.recipe, self._placed, "timing")

    def _repr_html_(self) -> str:
        rows = [(name, str(figure)) for name, figure in self.figures.items()]
        return notebook.notebook_html(
            self._repr_svg_(), self.recipe.name, self.checks, notebook.table(("figure", ""), rows)
        )


def designed(recipe: CamshaftRecipe) -> CamshaftDesign:
    """Design the cams of a camshaft.

    Raises RecipeErrors where a lobe has no such motion or curve, its cam cannot be a lobe, a part is too thin, or a
    lobe that is set by an engine's centres has no event at the engine's lift, EventError where the motion of the
    valve that states the lift is too rough to tell.
    """
    return CamshaftDesign(recipe, placed(recipe, Clock(stage_reporter(recipe))))


def failure_text(check: Entry, recipe: CamshaftRecipe, shown: str | None = None) -> str:
    """Text of a failed check of a report, several lines, with the lobe's place in the recipe of the camshaft.

    A check of a lobe's exact cam has the remedy that its own recipe would have.
    """
    lobes = {lobe.name: (i, lobe) for i, lobe in enumerate(recipe.lobes)}
    field, remedy = "camshaft", ""
    if (named := lobes.get(check.get("surface", ""))) is not None:
        field = f"camshaft.lobes[{named[0]}].recipe"
        own, alone = named[1].recipe, {**check, "surface": ""}
        report = {"checks": [alone], "files": []}
        if "file" not in check and (would_do := failure.remedy(alone, report, own)):
            remedy = f"{would_do}, in {escaped(own.path.name)}"
    return failure.failure_at(check, recipe, field, remedy, shown)
