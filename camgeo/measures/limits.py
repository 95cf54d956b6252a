"""The limits of a recipe's own: each a check, `limit:<figure>`, of the design, of each file or of each run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.checks.declared import LIMIT, Scene, declaration
from camgeo.checks.remedies import Missed, of_limit
from camgeo.measures.figures import of_design, of_file
from camgeo.recipe.figures import FIGURES
from kin.judge.check import Check

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.judge.check import Sense

ROUNDING = 1e-9  # share of a limit by which a figure that just reaches it may miss it


def limit_checks(
    recipe: Recipe,
    design: Design,
    checks: Sequence[Check],
    files: Sequence[FileResult],
    runs: Mapping[str, Mapping[str | None, Measured]] | None = None,
) -> list[Check]:
    """Hold every figure that the recipe limits against its bounds.

    `checks` are all that were made, `runs` figures of runs (`Results`). A figure that cannot be had fails, and says
    why.
    """
    scene = Scene(recipe, design.follower)
    speeds = {limit.figure: limit.rpm for limit in recipe.limits if limit.rpm is not None}
    names = [limit.figure for limit in recipe.limits if FIGURES[limit.figure].at_lift is None]
    measured = of_design(recipe, design, checks, names, speeds)
    found: list[Check] = []
    for limit in recipe.limits:
        name, of = limit.figure, FIGURES[limit.figure].of
        if FIGURES[name].at_lift is not None:
            from camgeo.measures.lobe import figure_at

            found += _held(recipe, limit, figure_at(recipe, design, name, limit.lift))
        elif name in measured:
            found += _held(recipe, limit, measured[name])
        elif runs is not None and name in runs:
            for run, value in runs[name].items():
                found += _held(recipe, limit, value, run)
        elif of == "file":
            declared = declaration(LIMIT + name)
            if declared is None:
                raise KeyError(name)
            closed = declared.between and len(design.discs) > 1
            for file in files:
                if closed and not file.closures:
                    continue  # it stands on the last file of a pair
                if file.body == "cam" and declared.of_file is not None and declared.of_file(scene, file.request):
                    value = of_file(name, file, checks)
                    found += _held(recipe, limit, value, file.path.name, file.tolerance)
    return found


def _held(
    recipe: Recipe, limit: Limit, measured: Measured, file: str | None = None, tolerance: float | None = None
) -> list[Check]:
    """Hold a figure against each bound that is given; `tolerance` is the file's. What fails says what would do."""
    found = []
    bounds: tuple[tuple[Sense, float | None], ...] = (("at_least", limit.at_least), ("at_most", limit.at_most))
    for sense, bound in bounds:
        if bound is None:
            continue
        value, slack = measured.value, ROUNDING * abs(bound)
        ok = value is not None and (value >= bound - slack if sense == "at_least" else value <= bound + slack)
        detail = measured.detail if value is None or math.isinf(value) else ""
        if value is not None and not ok:
            missed = Missed(value, bound, measured.unit, tolerance, measured.surface)
            detail = f"{of_limit(recipe, limit, missed)} would satisfy it"
        if FIGURES[limit.figure].at_lift is not None and value is not None:
            lift = f"at a lift of {limit.lift / recipe.mm:.9g} {'in' if recipe.units == 'inch' else 'mm'}"
            detail = f"{lift}: {detail}" if detail else lift
        name, of = LIMIT + limit.figure, measured.surface
        found.append(Check(name, ok, value, bound, measured.unit, measured.at_deg, sense, file, detail, of))
    return found
