"""The budget of a design: the sums of its errors, and what is left for free dimensions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.budget.contact import LostError
from camgeo.capabilities.budget.dimensions import CONTOUR, DIMENSIONS
from camgeo.capabilities.budget.influence import influence
from camgeo.capabilities.budget.inverse import Split, TakenError, left_for, widest
from camgeo.capabilities.budget.keys import Budget
from camgeo.capabilities.budget.random_parts import contour_errors
from camgeo.capabilities.budget.sums import POWERS, Sum, Worst, total, worst
from camgeo.common.rounding import upward
from camgeo.measures.units import report_unit
from camgeo.recipe.linkage import output_slides
from kin.numeric.angles import degrees
from kin.numeric.feet import equal_steps
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.capabilities.budget.influence import Influence, Output
    from camgeo.recipe.recipe import Recipe
    from camgeo.schema.errors import RecipeErrors
    from camgeo.synthesis.design import Design
    from kin.contour.contour import Contour
    from kin.numeric.arrays import Array

ROUNDING = 1e-9  # share of what is permitted by which a sum may exceed it: tolerances that were found just keep it
SUMS: tuple[Sum, ...] = tuple(POWERS)


@dataclass(frozen=True, eq=False)
class BudgetOutcome:
    """Budget of a design at even shaft angles: influences of its dimensions, greatest sums, and free tolerances.

    `budget` has tolerances for all its dimensions, `free` the words of those that were to be found; one that moves
    nothing gets 0. `sums` has the greatest sum by its kind. `left` (n,) is the greatest tolerance of the only free
    dimension at each angle, mm or rad; None where none is free or costs are stated. `splits` has the tolerances of
    least cost by the kind of sum; None without costs. `play` is the least and the greatest play, mm or rad, of a
    follower held from both sides; None for others.
    """

    budget: Budget
    influence: Influence
    sums: dict[Sum, Worst]
    free: tuple[str, ...]
    left: Array | None = None
    splits: dict[Sum, Split] | None = None
    play: tuple[float, float] | None = None

    @property
    def worst_output(self) -> Output:
        """Influences on the position by the contact at which the worst case is greatest."""
        return next(output for output in self.influence.outputs() if output.name == self.sums["worst"].contact)

    @property
    def kept(self) -> bool:
        """Whether the greatest sum, of the kind that the budget states, and the greatest play keep their limits."""
        budget = self.budget
        kept = self.sums[budget.sums].value <= budget.permitted * (1.0 + ROUNDING)
        return kept and (budget.play is None or self.play is None or self.play[1] <= budget.play * (1.0 + ROUNDING))


def outcome_of(recipe: Recipe, design: Design) -> BudgetOutcome | None:
    """The outcome of a recipe's budget; None without a budget, and for a linkage that does not turn.

    Raises what `outcome` does.
    """
    budget = recipe.of(Budget)
    moves = design.driven is None or design.driven.turns
    return outcome(recipe, design, budget) if budget is not None and moves else None


def outcome(recipe: Recipe, design: Design, budget: Budget, read: Mapping[str, Contour] | None = None) -> BudgetOutcome:
    """Work out the budget of a design on its own contours or, by the names of their surfaces, on those `read` of files.

    The sums have the error of contours that are read or trimmed. Raises RecipeErrors where nothing is left for a free
    dimension, and where a trimmed contour gives no motion; LostError where contours that are read give none; PlaceError
    for a linkage that does not turn right round, ArithmeticError where the search for the tolerances of least cost does
    not end.
    """
    try:
        return _outcome(recipe, design, budget, read)
    except TakenError as error:
        raise _taken(recipe, budget, error) from error
    except LostError as error:
        if read is not None:
            raise
        raise recipe.error("budget", str(error), None, "leave it out, or give a cam without undercut") from error


def _outcome(recipe: Recipe, design: Design, budget: Budget, read: Mapping[str, Contour] | None) -> BudgetOutcome:
    free, left, splits = budget.to_be_found, None, None
    shaft = equal_steps(recipe.verify.angles)
    contour = contour_errors(recipe, design, budget, shaft, read)
    rows = influence(recipe, design, budget, shaft, contour)
    if free and not budget.cost:
        left = left_for(rows, budget.permitted, budget.sums)
        chosen = {free[0]: float(left.min())}
    elif free:
        costs = _costs(recipe, budget)
        splits = {kind: widest(rows, budget.permitted, costs, kind, budget.exponent) for kind in SUMS}
        chosen = dict(splits[budget.sums].tolerances)
    if free:
        # a dimension that moves nothing has no bound, and adds nothing
        budget = budget.split([(name, value if math.isfinite(value) else 0.0) for name, value in chosen.items()])
        rows = influence(recipe, design, budget, shaft, contour)
    sums = {kind: worst(rows, kind) for kind in SUMS}
    # where the machine is set moves both contacts alike, and has no part in the play
    between = rows if budget.zero is None else influence(recipe, design, replace(budget, zero=None), shaft)
    return BudgetOutcome(budget, rows, sums, free, left, splits, _play(rows.play, between, budget.sums))


def _costs(recipe: Recipe, budget: Budget) -> dict[str, float]:
    """Costs c of c/tolerance^exponent by the dimension, for tolerances in mm or rad.

    The budget has them for tolerances in the recipe's unit of length and in degrees.
    """
    return {name: cost / size_unit(recipe, name)[0] ** budget.exponent for name, cost in budget.cost}


def _play(intended: Array | None, rows: Influence, kind: Sum) -> tuple[float, float] | None:
    """Least and greatest play over the angles, mm or rad; None for a follower that is not held from both sides.

    `intended` (n,) is the play with all sizes as intended; `rows` are influences that count from no setting.
    """
    between = rows.play_between()
    if between is None or intended is None:
        return None
    sums = total(rows, between, kind)
    return float((intended - sums).min()), float((intended + sums).max())


def _taken(recipe: Recipe, budget: Budget, error: TakenError) -> RecipeErrors:
    """The error of a budget whose stated dimensions leave nothing, at the field of the dimension that takes most."""
    scale, unit = motion_unit(recipe)
    taken, permitted = scale * error.taken, scale * budget.permitted
    place = f"of {permitted:.4g} {unit} at {degrees(error.at):.6g} degrees"
    problem = f"nothing is left for {budget.to_be_found[0]}: {error.name} alone takes {taken:.4g} {place}"
    more = f"permit more than {upward(scale * error.needed)} {unit}"
    if error.name == CONTOUR:
        return recipe.error("budget.permitted", problem, None, f"give a contour nearer the exact one, or {more}")
    # the word may be quoted in the path; a tolerance by a fit has no field of its own
    paths = (f"budget.tolerances.{error.name}", f"budget.tolerances.{error.name!r}")
    elsewhere = "budget.tolerances" if budget.fit is None else "budget.fit"
    path = next((path for path in paths if path in recipe.marks), elsewhere)
    return recipe.error(path, problem, None, f"make it smaller, or {more}")


# --- units of the report ----------------------------------------------------------------------------------------------


def error_unit(recipe: Recipe) -> str:
    """Unit of errors of the motion: deg where follower or output turns, else mm, even for a recipe in inches."""
    if recipe.linkage is not None:
        return "mm" if output_slides(recipe.linkage) else "deg"
    return recipe.cam.arrangement.unit


def motion_unit(recipe: Recipe) -> tuple[float, str]:
    """Factor from mm or rad of an error of the motion to its unit in the report, and that unit: mm, in or deg."""
    return report_unit(recipe, error_unit(recipe))


def size_unit(recipe: Recipe, name: str) -> tuple[float, str]:
    """Factor from mm or rad of a dimension's tolerance to its unit in the report, and that unit: mm, in or deg."""
    return report_unit(recipe, "deg" if DIMENSIONS[name].angle else "mm")
