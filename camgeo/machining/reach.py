"""The path of the recipe's cutter along a cam, and whether the cutter reaches everything."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from camgeo.checks.declared import REACH
from camgeo.curve.curve import CurveError
from camgeo.curve.undercut.causes import UndercutError
from camgeo.fit.arcs import fit_arcs
from camgeo.machining.cutter import cutter_path, no_hollow
from camgeo.synthesis.checks import hollow_radius
from kin.numeric.check import Check, failed
from kin.numeric.lengths import amount_words

if TYPE_CHECKING:
    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.fit.pieces import ArcSpline
    from camgeo.machining.cutter import CutterPath, Fit
    from camgeo.recipe.machining import Manufacture
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design

ALIKE = 1e-9  # share by which rounding lets equal hollows of a regular cam differ: the first of them is reported


def cutter_paths(recipe: Recipe, design: Design, further: float = 0.0) -> tuple[CutterPath, ...]:
    """Path of the cutter's centre along each surface, with `further` mm of metal left.

    Raises UndercutError where no single path is left, CurveError where it cannot be proved what is reached, ValueError
    without a contour or milling.
    """
    contours, manufacture = milled_contours(recipe, design)
    return tuple(cutter_path(contour, manufacture.radius + further) for _, contour in contours)


def milled_contours(recipe: Recipe, design: Design) -> tuple[tuple[tuple[Surface, Curve], ...], Manufacture]:
    """Surfaces that the cutter goes along, each with its contour, and the milling; ValueError if either is missing."""
    if not design.contours or recipe.manufacture is None:
        raise ValueError(f"{recipe.name}: there is nothing to mill")
    return design.contours, recipe.manufacture


def path_arcs(recipe: Recipe, path: CutterPath, tolerance: float, fit_curve: Fit = fit_arcs) -> ArcSpline:
    """Arcs within `tolerance` mm of the cutter's path.

    Raises RecipeErrors where part of the path shrinks to a point, as in a hollow arc of the cutter's own radius.
    """
    try:
        return path.arcs(tolerance, fit_curve)
    except CurveError as error:
        diameter = f"{2.0 * path.radius / recipe.mm:.6g} {recipe.units}"
        remedy = "give one a little larger or smaller"
        raise recipe.error("manufacture.cutter", f"the path of its centre: {error}", diameter, remedy) from error


def reach_checks(recipe: Recipe, design: Design) -> list[tuple[Check, CutterPath | None]]:
    """Check of each surface on the depth of metal that the cutter leaves, mm, and the path, None where there is none.

    Raises ValueError without a contour or milling, CurveError where it cannot be proved what is reached.
    """
    contours, manufacture = milled_contours(recipe, design)
    checks = []
    for surface, contour in contours:
        check, path = _reach_check(manufacture, design, surface, contour)
        checks.append((replace(check, surface=surface.name), path))
    return checks


def _reach_check(
    manufacture: Manufacture, design: Design, surface: Surface, contour: Curve
) -> tuple[Check, CutterPath | None]:
    hollow, radius = "no hollow", math.inf
    if not no_hollow(contour):
        radius, parameter = hollow_radius(surface.side, contour)
    if math.isfinite(radius):
        hollow = f"least hollow radius {amount_words(radius, 'mm')} at {design.motion.shaft_deg(parameter):.6g} deg"
    try:
        path = cutter_path(contour, manufacture.radius)
    except UndercutError as error:
        return failed(REACH.name, f"{error}; {hollow}", unit="mm", limit=manufacture.unreached), None
    if not path.lost:
        return Check(REACH.name, True, 0.0, manufacture.unreached, "mm", detail=hollow), path
    deepest = max(cut.depth for cut in path.lost)
    worst = next(cut for cut in path.lost if cut.depth >= (1.0 - ALIKE) * deepest)
    first, last = design.motion.shaft_deg(worst.start), design.motion.shaft_deg(worst.end)
    free = 2.0 * min(cut.free_at for cut in path.lost)
    remedy = f"a cutter {amount_words(free, 'mm')} across would reach all"
    detail = f"{hollow}; not reached from {first:.6g} to {last:.6g} deg; {remedy}"
    at_deg = design.motion.shaft_deg(worst.at)
    ok = worst.depth <= manufacture.unreached
    return Check(REACH.name, ok, worst.depth, manufacture.unreached, "mm", at_deg, detail=detail), path
