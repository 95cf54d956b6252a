"""Motions of axes for the library, exact and without files; texts of failed checks; expected checks."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from camgeo.api.check import Check, Figure, Figures
from camgeo.api.log import stage_reporter
from camgeo.api.own_kind import KindDesign
from camgeo.capabilities.axis.design import designed, rpm_for
from camgeo.capabilities.axis.keys import ADVANCE, FIGURES
from camgeo.checks.declared import LIMIT, of_a_drive
from camgeo.common.arguments import numbers_of, short_repr, whole_of
from camgeo.common.clock import Clock
from camgeo.common.errors import CallError
from camgeo.measures.units import in_units
from camgeo.report import failure
from camgeo.synthesis.expected_checks import Foreseen
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from camgeo.capabilities.axis.design import AxisDesign
    from camgeo.capabilities.axis.keys import AxisRecipe
    from camgeo.checks.declaration import Entry
    from kin.numeric.arrays import Array

MOST_DERIVATIVE = 6


@dataclass(frozen=True, eq=False)
class Axis(KindDesign):
    """The exact motion of an axis; no file is made. Checks and figures are in the recipe's units."""

    recipe: AxisRecipe
    _design: AxisDesign = field(repr=False)

    @cached_property
    def checks(self) -> tuple[Check, ...]:
        """The checks of limits, which need no file."""
        return tuple(Check.of(self.recipe, check) for check in self._design.limit_checks())

    @cached_property
    def figures(self) -> Figures:
        """The figures of the motion in time by name, each with its place over a turn of the master, degrees."""
        found = {}
        for figure in self._design.figures:
            value, unit = in_units(self.recipe, figure.value, figure.unit)
            finite = value is not None and bool(np.isfinite(value))
            note = "" if finite else "the acceleration jumps"
            found[figure.name] = Figure(value if finite else None, unit, figure.at, note)
        return Figures(found)

    def motion(self, angle: ArrayLike, *, derivative: int = 0) -> Array:
        """Position, mm or rad, at angles of the master, rad, or a derivative by the angle, up to the sixth.

        The result has the shape of `angle`. Raises CallError for another order, and for angles that are not finite or
        outside a turn; TypeError for angles that are no numbers.
        """
        angles, order = numbers_of("angle", angle), whole_of("derivative", derivative)
        if order not in range(MOST_DERIVATIVE + 1):
            raise CallError(f"a derivative is one of order 0 to {MOST_DERIVATIVE}, not {short_repr(order)}")
        if not (np.isfinite(angles).all() and (angles >= 0.0).all() and (angles <= TURN).all()):
            raise CallError("angles of the master are from 0 to a turn, 2 pi")
        rows = self._design.rows(angles.ravel(), order)
        return np.asarray(rows[order].reshape(angles.shape))

    def _repr_svg_(self) -> str:
        from camgeo.capabilities.axis.axis_page import drawing

        return drawing(self._design)

    def _drawing(self) -> str:
        return self._repr_svg_()


def axis_of(recipe: AxisRecipe) -> Axis:
    """Design the motion of an axis; raises RecipeErrors where there is none."""
    return Axis(recipe, designed(recipe, Clock(stage_reporter(recipe))))


def failure_text(check: Entry, recipe: AxisRecipe, shown: str | None = None) -> str:
    """Text of a failed check of a report, several lines, with the field of the recipe that influences it most."""
    name = check["name"]
    place = f"limits.{name.removeprefix(LIMIT)}" if name.startswith(LIMIT) else "export"
    return failure.failure_at(check, recipe, place if place in recipe.marks else "axis", remedy(check, recipe), shown)


def remedy(check: Entry, recipe: AxisRecipe) -> str:
    """Change that would let a check hold; empty where none is known."""
    name = check["name"].removeprefix(LIMIT)
    if name not in FIGURES:
        return ""
    if check.get("value") is None:
        return "laws whose acceleration joins, such as polynomial-4567 or modified-sine"
    return f"an rpm of at most {rpm_for(recipe, name, check['value'], check['limit'])}"


def foreseen(recipe: AxisRecipe) -> tuple[Foreseen, ...]:
    """Checks that the report is sure to have."""
    expected = [Foreseen(f"{LIMIT}{bound.figure}") for bound in recipe.limits]
    for request in recipe.export.files:
        (name,) = recipe.filenames(request)
        names = of_a_drive(request)
        own = (ADVANCE,) if names and recipe.index else ()
        expected += [Foreseen(each, name) for each in (*names, *own)]
    return tuple(expected)
