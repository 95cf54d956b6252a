"""The limits of a recipe's own: each a check, `limit:<figure>`, of the design, of each file or of each run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.checks.declaration import CheckFacts
from camgeo.checks.declared import LIMIT, declaration
from camgeo.checks.remedies import Missed, limit_remedy
from camgeo.measures.figures import design_figures, file_figure
from camgeo.recipe.figures import FIGURES
from kin.numeric.check import Check

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.measures.file_result import FileResult
    from camgeo.measures.measured import Measured
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from kin.numeric.check import Sense

ROUNDING = 1e-9  # share of a limit by which a figure that just reaches it may miss it


def limit_checks(
    recipe: Recipe,
    design: Design,
    checks: Sequence[Check],
    files: Sequence[FileResult],
    runs: Mapping[str, Mapping[str | None, Measured]] | None = None,
) -> list[Check]:
    """Checks of every figure that the recipe limits, one for each bound, and of figures of files one for each file.

    `checks` are all checks of the run; `runs` has figures of runs by name, each by the file that drives it, None for
    the intended motion. A figure without a value fails with its reason; a figure that was not measured has no check.
    Raises RecipeErrors where a capability cannot measure its figures, KeyError for a figure of files whose check is not
    declared.
    """
    scene = CheckFacts(recipe, design.follower)
    speeds = {limit.figure: limit.rpm for limit in recipe.limits if limit.rpm is not None}
    names = [limit.figure for limit in recipe.limits if FIGURES[limit.figure].at_lift is None]
    measured = design_figures(recipe, design, checks, names, speeds)
    results: list[Check] = []
    for limit in recipe.limits:
        name, figure = limit.figure, FIGURES[limit.figure]
        if figure.at_lift is not None:
            from camgeo.measures.lobe import figure_at

            results += _bound_checks(recipe, limit, figure_at(recipe, design, name, limit.lift))
        elif name in measured:
            results += _bound_checks(recipe, limit, measured[name])
        elif runs is not None and name in runs:
            for run, value in runs[name].items():
                results += _bound_checks(recipe, limit, value, run)
        elif figure.of == "file":
            declared = declaration(LIMIT + name)
            if declared is None:
                raise KeyError(name)
            closed = declared.between and len(design.discs) > 1
            for file in files:
                if closed and not file.closures:
                    continue  # it stands on the last file of a pair
                if file.body == "cam" and declared.of_file is not None and declared.of_file(scene, file.request):
                    value = file_figure(name, file, checks)
                    results += _bound_checks(recipe, limit, value, file.path.name, file.tolerance)
    return results


def _bound_checks(
    recipe: Recipe, limit: Limit, measured: Measured, file: str | None = None, tolerance: float | None = None
) -> list[Check]:
    """Checks of a figure against each given bound; a failed check has its remedy as detail.

    `file` is the name of the file, None for the design, and `tolerance` the file's, mm.
    """
    checks = []
    bounds: tuple[tuple[Sense, float | None], ...] = (("at_least", limit.at_least), ("at_most", limit.at_most))
    for sense, bound in bounds:
        if bound is None:
            continue
        value, slack = measured.value, ROUNDING * abs(bound)
        ok = value is not None and (value >= bound - slack if sense == "at_least" else value <= bound + slack)
        detail = measured.detail if value is None or math.isinf(value) else ""
        if value is not None and not ok:
            missed = Missed(value, bound, measured.unit, tolerance, measured.surface)
            detail = f"{limit_remedy(recipe, limit, missed)} would satisfy it"
        if FIGURES[limit.figure].at_lift is not None and value is not None:
            lift = f"at a lift of {limit.lift / recipe.mm:.9g} {'in' if recipe.units == 'inch' else 'mm'}"
            detail = f"{lift}: {detail}" if detail else lift
        name = LIMIT + limit.figure
        unit, place, surface = measured.unit, measured.at, measured.surface
        checks.append(Check(name, ok, value, bound, unit, place, sense, file, detail, surface, measured.at_unit))
    return checks
