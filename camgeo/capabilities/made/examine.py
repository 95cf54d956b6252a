"""What points of earlier runs tell of a recipe's export: the deviations of each, and what corrected files change."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.capabilities.made.correction import LOOKS, runs_made
from camgeo.capabilities.made.judge import follower_motion
from camgeo.capabilities.made.keys import CORRECT, Made
from camgeo.measures.units import UNIT_NAMES
from camgeo.registry.capability import Results
from kin.made.motion import COVERAGE, contact_errors, paired
from kin.made.smooth import Smooth
from kin.numeric.angles import degrees
from kin.numeric.feet import equal_steps

if TYPE_CHECKING:
    from collections.abc import Mapping

    from camgeo.capabilities.made.correction import RunMade
    from camgeo.common.clock import Clock
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design


def examine(recipe: Recipe, design: Design, clock: Clock) -> Results:
    """Give the section `made`; nothing without points. Raises RecipeErrors for points that are none of this part."""
    made = recipe.of(Made)
    if made is None or not made.points or not design.contours:
        return Results()
    if design.trimmed:
        problem = "a contour whose undercut is cut off is not held against points"
        raise recipe.error("made.points", problem, None, "give undercut: refuse")
    with clock.stage("made"):
        runs = runs_made(recipe, design)
    totals = {name: Smooth.total([run.curves[name] for run in runs]) for name in runs[0].curves}
    error = sum(run.error for run in runs)
    entry = {
        "unit": UNIT_NAMES[recipe.units],
        "runs": [_run(recipe, design, run) for run in runs],
        "systematic": [_surface(recipe, design, name, total, error) for name, total in totals.items()],
        "corrections": [
            _correction(recipe, design, totals, error, corrected) for corrected in _corrected_files(recipe).items()
        ],
    }
    return Results({"made": entry})


def _run(recipe: Recipe, design: Design, run: RunMade) -> dict[str, Any]:
    """Give the report of a run: each surface's deviation, and the scatter of several files about their mean."""
    surfaces = []
    for name, curve in run.curves.items():
        entry = {"points": run.points[name], "spans": curve.spans, **_surface(recipe, design, name, curve, run.error)}
        if (scatter := run.scatter[name]) is not None:
            entry["files_differ_by"] = scatter / recipe.mm
        surfaces.append(entry)
    return {"files": list(run.files), "surfaces": surfaces}


def _surface(recipe: Recipe, design: Design, name: str, curve: Smooth, error: float) -> dict[str, Any]:
    """The smoothed deviation of a surface: its greatest, where, its mean size, and expanded uncertainty."""
    t = equal_steps(LOOKS)
    e = curve.rows(t)[0]
    worst = int(np.argmax(np.abs(e)))
    return {
        "name": name,
        "greatest": float(e[worst]) / recipe.mm,
        "at_deg": degrees(float(design.exact.gauges[name].shaft_angle(t[worst : worst + 1])[0])),
        "rms": float(np.sqrt(np.mean(e**2))) / recipe.mm,
        "uncertainty": math.hypot(COVERAGE * float(curve.standard_deviations(t).max()), error) / recipe.mm,
    }


def _corrected_files(recipe: Recipe) -> dict[float, list[str]]:
    """Names of the corrected files, by the share of the deviations that is taken off."""
    files: dict[float, list[str]] = {}
    for request in recipe.export.files:
        for file in request.compensation.altered if request.compensation else ():
            if file.key == CORRECT.name:
                files.setdefault(file.value, []).extend(recipe.filenames(request))
    return files


def _correction(
    recipe: Recipe, design: Design, totals: Mapping[str, Smooth], error: float, corrected: tuple[float, list[str]]
) -> dict[str, Any]:
    """Give the report of a correction: what files have less, and the motion of a part made as these are drawn.

    `error`, mm, is the sum of what is stated for the probes of all runs.
    """
    (share, names), t = corrected, equal_steps(LOOKS)
    shaft = equal_steps(recipe.verify.angles)
    each, greatest, uncertain = {}, 0.0, 0.0
    for surface in design.exact.surfaces:
        gauge, curve = design.exact.gauges[surface.name], totals[surface.name].times(-share)
        each[surface.name] = paired(gauge, contact_errors(gauge, surface.side, curve, shaft))
        e = curve.rows(t)[0]
        greatest = max(greatest, float(e.max()), float(e.min()), key=abs)
        uncertain = max(uncertain, COVERAGE * float(curve.standard_deviations(t).max()))
    motion, _ = follower_motion(design, each)
    swings = design.exact.gauge.unit == "deg"
    scale = math.degrees(1.0) if swings else 1.0 / recipe.mm
    worst = int(np.argmax(np.abs(motion.remaining)))
    return {
        CORRECT.name: share,
        "files": names,
        "greatest": greatest / recipe.mm,
        "uncertainty": math.hypot(uncertain, share * error) / recipe.mm,
        "motion": {
            "unit": "deg" if swings else UNIT_NAMES[recipe.units],
            "offset": scale * motion.offset,
            "change": scale * float(motion.remaining[worst]),
            "at_deg": degrees(float(motion.shaft[worst])),
        },
    }
