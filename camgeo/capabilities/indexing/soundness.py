"""Whether an indexing cam can be made: rollers that meet what they must not, undercut, ribs that vanish."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.tracks import rib_thickness, track
from camgeo.common.rounding import downward
from camgeo.curve.curve import CurveError

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.design import IndexDesign

LAYERS = 5  # in which undercut is sought
SHARP = 1e-3  # of a radius in a remedy
ROLLER = "cam.turret.roller"


def demand_room(design: IndexDesign) -> None:
    """Raise RecipeErrors where rollers do not leave the cam at its ends, or meet it on their way back."""
    recipe = design.recipe

    def shown(value: float) -> str:
        return f"{value / recipe.mm:.6g} {recipe.units}"

    problem = recipe.turret.misled(design.largest, recipe.roller.inner, recipe.layers, recipe.length, shown)
    if problem is not None:
        field, words, remedy = problem
        raise recipe.error(recipe.stated(field), words, None, remedy)


def demand_sound(design: IndexDesign) -> None:
    """Raise RecipeErrors for a flank that is undercut, and where two rollers leave no rib between them."""
    for name in design.flanks:
        try:
            least, at, layer = _least_regular(design, name)
        except CurveError as error:
            raise design.error(ROLLER, f"the {name} flank: {error}", _smaller(design, _all_regular)) from error
        if not least > 0.0:
            mm, units = design.recipe.mm, design.recipe.units
            problem = (
                f"the {name} flank is undercut at {layer / mm:.6g} {units} from the axis of "
                f"{design.recipe.turret.about}, near {math.degrees(at) % 360.0:.6g} degrees"
            )
            remedy = _smaller(design, _all_regular) or "give a longer rise"
            raise design.error(ROLLER, problem, remedy)
    thin, at = rib_thickness(design)
    if not thin > 0.0:
        problem = f"the rollers leave no rib between them, near {math.degrees(at) % 360.0:.6g} degrees"
        raise design.error(ROLLER, problem, _smaller(design, lambda other: rib_thickness(other)[0] > 0.0))


def _least_regular(design: IndexDesign, name: str) -> tuple[float, float, float]:
    """Least D within the cam, mm, of a flank, its shaft angle, rad, and its layer, mm."""
    found = []
    for w in np.linspace(*design.recipe.layers, LAYERS).tolist():
        theta, rows = track(design, name, w)
        low, high = design.recipe.form.ends(w)
        inside = np.flatnonzero((rows.h > low) & (rows.h < high))
        if inside.size:
            i = inside[np.argmin(rows.regular[inside])]
            found.append((float(rows.regular[i]), float(theta[i]), w))
    return min(found, default=(math.inf, 0.0, 0.0))


def _all_regular(design: IndexDesign) -> bool:
    try:
        return all(_least_regular(design, name)[0] > 0.0 for name in design.flanks)
    except CurveError:
        return False


def _smaller(design: IndexDesign, sound: Callable[[IndexDesign], bool]) -> str:
    """Remedy with the largest roller, to a thousandth, of which a cam is sound; empty where none is found."""
    low, high = 0.0, design.recipe.roller.radius
    while high - low > SHARP * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sound(design.resized(middle)) else (low, middle)
    if not low > 0.0:
        return ""
    return (
        f"give a roller radius of at most {downward((1.0 - SHARP) * low / design.recipe.mm, 4)} {design.recipe.units}"
    )
