"""The shortest travel at which the pressure angle keeps its limit, all lengths of the motion alike."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from camgeo.capabilities.linear.flank import slopes
from camgeo.capabilities.linear.path import Stem

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.linear.keys import LinearRecipe
    from camgeo.capabilities.linear.path import CentrePath

LEAST, MOST = 1e-3, 1e4  # factors of the stated lengths between which the travel is sought
SHARP = 1e-13  # of the factor


def least_travel(recipe: LinearRecipe, path_of: Callable[[float], CentrePath]) -> float:
    """Least factor of all lengths of a motion at which both pressure angles keep `recipe.steepest`.

    On a stem tan a = (S' + sin g)/cos g, and S' falls as 1/factor: so the factor is max(S')/(cos g tan a - sin g), or
    of the return with + sin g. On an arm it is sought by halving. Raises RecipeErrors where no travel serves.
    """
    limit = recipe.steepest
    if limit is None:
        return 1.0
    path = path_of(1.0)
    field = "cam.sizing.pressure-angle.at_most"
    if isinstance(path.guide, Stem):
        sine, cosine = math.sin(path.guide.lean), math.cos(path.guide.lean)
        least, greatest = slopes(path)
        rise, fall = greatest.value * cosine - sine, -(least.value * cosine - sine)
        up, down = cosine * math.tan(limit) - sine, cosine * math.tan(limit) + sine
        if min(up, down) <= 0.0:
            problem = f"the guide itself leans by {math.degrees(abs(path.guide.lean)):.6g} degrees"
            raise recipe.error(field, problem, None, "give more than that, or less lean")
        factor = max(rise / up, fall / down)
        if not factor > 0.0:
            raise recipe.error(field, "any travel keeps it", None, "leave sizing out")
        return factor

    def keeps(factor: float) -> bool:
        least, greatest = slopes(path_of(factor))
        return max(-math.atan(least.value), math.atan(greatest.value)) <= limit

    low, high = LEAST, MOST
    if not keeps(high):
        problem = "the arm itself leans more than that"
        raise recipe.error(field, problem, None, "give more, or a pivot by which the arm lies level in mid swing")
    if keeps(low):
        raise recipe.error(field, "any travel keeps it", None, "leave sizing out")
    while high - low > SHARP * high:
        middle = math.sqrt(low * high) if high > 1.001 * low else 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (low, middle) if keeps(middle) else (middle, high)
    return high
