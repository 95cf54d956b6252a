"""The path of the recipe's cutter along a cam, and whether the cutter reaches everything."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from camgeo.checks.declared import REACH
from camgeo.curve.curve import CurveError
from camgeo.curve.undercut.causes import UndercutError
from camgeo.fit.arcs import fit_arcs
from camgeo.machining.cutter import cutter_path, no_hollow
from camgeo.synthesis.checks import hollow_radius
from kin.judge.check import Check, failed
from kin.numeric.lengths import amount_words

if TYPE_CHECKING:
    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.fit.pieces import ArcSpline
    from camgeo.machining.cutter import CutterPath, Fit
    from camgeo.recipe.machining import Manufacture
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

ALIKE = 1e-9  # share by which hollows of a regular cam differ through rounding: the first of them is reported


def paths_of(recipe: Recipe, design: Design, further: float = 0.0) -> tuple[CutterPath, ...]:
    """Path of the cutter's centre along each surface, or one `further` off the metal; raises as `cutter_path` does."""
    contours, asked = milled(recipe, design)
    return tuple(cutter_path(contour, asked.radius + further) for _, contour in contours)


def milled(recipe: Recipe, design: Design) -> tuple[tuple[tuple[Surface, Curve], ...], Manufacture]:
    """Surfaces that the recipe's cutter goes along, each with its contour; raises ValueError where there are none."""
    if not design.contours or recipe.manufacture is None:
        raise ValueError(f"{recipe.name}: there is nothing to mill")
    return design.contours, recipe.manufacture


def path_arcs(recipe: Recipe, path: CutterPath, tolerance: float, fitted: Fit = fit_arcs) -> ArcSpline:
    """Arcs within a tolerance of the cutter's path; raises RecipeErrors where it stays in a point.

    So it does in a hollow arc of the cutter's own radius.
    """
    try:
        return path.within(tolerance, fitted)
    except CurveError as error:
        given = f"{2.0 * path.radius / recipe.mm:.6g} {recipe.units}"
        remedy = "give one a little larger or smaller"
        raise recipe.error("manufacture.cutter", f"the path of its centre: {error}", given, remedy) from error


def reach_checks(recipe: Recipe, design: Design) -> list[tuple[Check, CutterPath | None]]:
    """Check of each surface how deep metal is left where the cutter does not reach; its path, None of no single one."""
    contours, asked = milled(recipe, design)
    found = []
    for surface, contour in contours:
        check, path = _reached(asked, design, surface, contour)
        found.append((replace(check, surface=surface.name), path))
    return found


def _reached(
    manufacture: Manufacture, design: Design, surface: Surface, contour: Curve
) -> tuple[Check, CutterPath | None]:
    told = "no hollow"
    if not no_hollow(contour):
        radius, at = hollow_radius(surface.side, contour)
        told = f"least hollow radius {amount_words(radius, 'mm')} at {design.motion.shaft_deg(at):.6g} deg"
    try:
        path = cutter_path(contour, manufacture.radius)
    except UndercutError as error:
        return failed(REACH.name, f"{error}; {told}", unit="mm", limit=manufacture.unreached), None
    if not path.lost:
        return Check(REACH.name, True, 0.0, manufacture.unreached, "mm", detail=told), path
    deepest = max(cut.depth for cut in path.lost)
    worst = next(cut for cut in path.lost if cut.depth >= (1.0 - ALIKE) * deepest)
    first, last = design.motion.shaft_deg(worst.start), design.motion.shaft_deg(worst.end)
    free = 2.0 * min(cut.free_at for cut in path.lost)
    would = f"a cutter {amount_words(free, 'mm')} across would reach all"
    detail = f"{told}; not reached from {first:.6g} to {last:.6g} deg; {would}"
    at_deg = design.motion.shaft_deg(worst.at)
    return Check(
        REACH.name,
        worst.depth <= manufacture.unreached,
        worst.depth,
        manufacture.unreached,
        "mm",
        at_deg,
        detail=detail,
    ), path
