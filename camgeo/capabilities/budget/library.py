"""A budget from a program, as `camgeo budget` works it out from a terminal."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from camgeo.capabilities.budget.contact import LostError
from camgeo.capabilities.budget.keys import Budget
from camgeo.capabilities.budget.outcome import motion_unit, outcome
from camgeo.capabilities.budget.section import section
from camgeo.common.arguments import demand_callable
from camgeo.common.errors import CallError
from camgeo.common.terminal import escaped
from camgeo.synthesis.design import designed
from kin.numeric.angles import degrees

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from os import PathLike

    from camgeo.capabilities.budget.outcome import BudgetOutcome
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.contour.contour import Contour


def budget(
    recipe: Recipe, *files: str | PathLike[str], progress: Callable[[str], None] | None = None
) -> dict[str, Any]:
    """The budget of a recipe as plain data, in the recipe's unit and degrees; docs/budget.md names its keys.

    Made parts are simulated with random sizes within the tolerances, on the exact contour or on that of `files`, one of
    each disc; with `runs` 0 the key `parts` is missing. The sums have the error of the files' contours. `ok` is whether
    the budget is kept. `progress` is called with stages such as "2,000 of 10,000 parts". Raises RecipeErrors for a
    recipe without a budget, for a cam that does not exist, for tolerances that leave nothing for a free dimension, and
    for a linkage that does not turn; CallError for files that do not hold all contours of the cam, or on which the
    follower has no motion; TypeError for a `progress` that is no function; ArithmeticError where the search for the
    tolerances of least cost does not end.
    """
    demand_callable("progress", progress)
    stated = recipe.of(Budget)
    if stated is None:
        remedy = "give budget: {permitted: 0.05, tolerances: {profile: 0.01}}"
        raise recipe.error("", "there is no budget", None, remedy)
    design = designed(recipe)
    if design.driven is not None and not design.driven.turns:
        raise recipe.error("linkage", "the mechanism does not turn, and its output has no error", None, "see check")
    if progress is not None:
        progress("sums of errors")
    paths, read = [Path(file) for file in files], None
    if paths:
        from camgeo.capabilities.budget.read_contours import read_contours

        read = read_contours(recipe, design, paths)
    try:
        budgeted = outcome(recipe, design, stated, read)
    except LostError as error:
        shown = ", ".join(escaped(str(path)) for path in paths)
        raise CallError(f"{shown}: {error}; give a file that camgeo verify accepts") from error
    names = [path.name for path in paths]
    entry = section(recipe, budgeted, names)
    if stated.runs:
        entry["parts"] = _parts(recipe, design, budgeted, read, names, progress=progress)
    return {"recipe": recipe.name, "units": recipe.units, "ok": entry["kept"], **entry}


def _parts(
    recipe: Recipe,
    design: Design,
    result: BudgetOutcome,
    read: Mapping[str, Contour] | None,
    files: list[str],
    *,
    progress: Callable[[str], None] | None,
) -> dict[str, Any]:
    """Report entry of the simulation of made parts; where it is not possible `runs` is 0, and `why` the reason.

    The contours `read` are those of `files`.
    """
    from camgeo.capabilities.budget.random_parts import sample_angles, simulate

    shaft = sample_angles([worst.at for worst in result.sums.values()])
    try:
        parts = simulate(recipe, design, result.budget, shaft, read, progress=progress)
    except LostError as error:
        return {"runs": 0, "why": str(error)}
    # statistics in the unit of the report, one row for each contact and angle
    scale, unit = motion_unit(recipe)
    rows: list[dict[str, Any]] = [
        {
            "contact": spread.contact,
            "at_deg": degrees(spread.at),
            "mean": scale * spread.mean,
            "sd": scale * spread.deviation,
            "foreseen": scale * spread.foreseen,
            "error": scale * spread.error,
            "greatest": scale * spread.greatest,
            "agrees": spread.agrees,
        }
        for spread in parts.spreads
    ]
    return {
        "runs": parts.runs,
        "seed": parts.seed,
        "files": files,
        "unit": unit,
        "within": parts.within,
        "greatest": max(row["greatest"] for row in rows),
        "agrees": all(row["agrees"] for row in rows),
        "worst": rows[parts.spreads.index(parts.worst)],
        "spreads": rows,
    }
