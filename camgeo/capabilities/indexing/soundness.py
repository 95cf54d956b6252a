"""Whether an indexing cam can be made: rollers that meet what they must not, undercut, ribs that vanish.

Samples find a fault and the size that would serve. That no flank is undercut is proved at the end
(`camgeo.capabilities.indexing.undercut`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.pressed import other_half
from camgeo.capabilities.indexing.spans import TrackError, demand_ends
from camgeo.capabilities.indexing.tracks import LAYERS, rib_thickness, track
from camgeo.capabilities.indexing.undercut import demand_regular
from camgeo.common.rounding import downward
from camgeo.curve.curve import CurveError
from camgeo.schema.errors import RecipeErrors

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.index_recipe import IndexRecipe

SHARP = 1e-3  # of a radius in a remedy
CLEAR = 1.01  # radii of a roller in a remedy, between its axis and the flank that its other half passes
TRIED = (
    1.0 - SHARP,
    0.995,
    0.99,
    0.98,
    0.95,
    0.9,
    0.8,
)  # of a greatest size that samples find: those tried for a remedy
CENTRED = "with the turret's axis in its middle"
ROLLER = "cam.turret.roller"


def demand_room(design: IndexDesign) -> None:
    """Raise RecipeErrors where rollers do not leave the cam at its ends, or meet it on their way back."""
    recipe = design.recipe

    def shown(value: float) -> str:
        return f"{value / recipe.mm:.6g} {recipe.units}"

    problem = recipe.turret.fault(design.largest, shown)
    if problem is not None:
        field, words, remedy = problem
        raise recipe.error(recipe.stated(field), words, None, remedy)


def demand_sound(design: IndexDesign) -> None:
    """Raise RecipeErrors for a track that turns back, a flank that is undercut, and rollers that leave no rib."""
    for name in design.flanks:
        _demand_forward(design, name)
        try:
            least, at, layer = _least_regular(design, name)
        except CurveError as error:
            raise design.error(ROLLER, f"the {name} flank: {error}", _smaller(design)) from error
        if not least > 0.0:
            mm, units = design.recipe.mm, design.recipe.units
            problem = (
                f"the {name} flank is undercut at {layer / mm:.6g} {units} from the axis of "
                f"{design.recipe.turret.about}, near {math.degrees(at) % 360.0:.6g} degrees"
            )
            raise design.error(ROLLER, problem, _smaller(design))
    thin, at = rib_thickness(design)
    if not thin > 0.0:
        problem = f"the rollers leave no rib between them, near {math.degrees(at) % 360.0:.6g} degrees"
        raise design.error(ROLLER, problem, _smaller(design))
    _demand_parted(design)
    _demand_proved(design)


def _demand_parted(design: IndexDesign) -> None:
    """Raise RecipeErrors where a clearance or a preload is so large that one half of a roller meets the other flank."""
    recipe = design.recipe
    if recipe.clearance == 0.0:
        return
    off, at = other_half(design)
    if off >= design.largest:
        return
    sign, word = (1.0, "clearance") if recipe.clearance > 0.0 else (-1.0, "preload")

    def sound(size: float) -> bool:
        other = design.cleared(sign * size)
        return other_half(other)[0] >= CLEAR * other.largest

    size = _largest(recipe, abs(recipe.clearance), sound)
    half, name = ("upper", "lower") if sign > 0.0 else ("lower", "upper")
    problem = f"the {half} half of a roller meets the {name} flank, near {math.degrees(at) % 360.0:.6g} degrees"
    remedy = f"give at most {size}" if size else "leave it out"
    raise design.error(f"cam.turret.{word}", problem, remedy)


def _demand_proved(design: IndexDesign) -> None:
    """Raise RecipeErrors where the track does not go from end face to end face, or undercut is not proved away."""
    try:
        _passes(design)
    except TrackError as error:
        length = _largest(design.recipe, design.recipe.length, lambda length: _passes(design.shortened(length)))
        remedy = f"give at most {length}, {CENTRED}" if length else error.remedy
        where = f"near {math.degrees(error.parameter) % 360.0:.6g} degrees"
        raise design.error("part.length", f"{error}, {where}", remedy) from error
    try:
        _proved(design)
    except CurveError as error:
        where = f"near {math.degrees(error.parameter) % 360.0:.6g} degrees"
        raise design.error(ROLLER, f"{error}, {where}", _smaller(design, _proved)) from error


def _passes(design: IndexDesign) -> bool:
    """Whether the track goes from end face to end face; raises TrackError where it does not."""
    demand_ends(design.flanks)
    return True


def _proved(design: IndexDesign) -> bool:
    """Whether no flank is undercut; raises CurveError where that is not proved."""
    for flank in design.flanks.values():
        demand_regular(flank)
    return True


def _demand_forward(design: IndexDesign, name: str) -> None:
    """Raise RecipeErrors where a turret takes its roller back as fast as the cam turns: its track would turn back."""
    least, at = _forward(design, name)
    if not least > 0.0:
        problem = (
            f"the turret takes a roller back as fast as the floor turns, near {math.degrees(at) % 360.0:.6g} degrees"
        )
        least = 2.0 * design.recipe.roller.radius

        def sound(length: float) -> bool:
            return length > least and _sampled(design.shortened(length))

        length = _largest(design.recipe, design.recipe.length, sound)
        shorter = f", or a length of at most {length}, {CENTRED}" if length else ""
        raise design.error("cam.motion", problem, f"give a longer rise{shorter}")


def _forward(design: IndexDesign, name: str) -> tuple[float, float]:
    """Least A, mm, by which a roller moves on against the floor or the blank, across its way; its shaft angle, rad."""
    found, form = [], design.recipe.form
    for w in (form.floor, form.blank):
        try:
            theta, rows = track(design, name, w)
        except CurveError:
            return math.inf, 0.0  # told with the largest roller that serves
        inside = np.flatnonzero((rows.z > 0.0) & (rows.z < form.length))
        if inside.size:
            along = form.speed(design.flanks[name].pose(theta[inside]), rows.rho[inside]).a
            i = int(np.argmin(along))
            found.append((float(along[i]), float(theta[inside][i])))
    return min(found, default=(math.inf, 0.0))


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


def _sampled(design: IndexDesign) -> bool:
    """Whether samples find a track that goes forward, regular flanks, and a rib; raises CurveError and RecipeErrors."""
    forward = all(_forward(design, name)[0] > 0.0 for name in design.flanks)
    regular = forward and all(_least_regular(design, name)[0] > 0.0 for name in design.flanks)
    return regular and rib_thickness(design)[0] > 0.0


def _smaller(design: IndexDesign, proof: Callable[[IndexDesign], bool] = lambda _: True) -> str:
    """Remedy with the largest roller, to a thousandth, of which a cam is sound; another where none is found."""
    recipe = design.recipe

    def sound(radius: float) -> bool:
        return radius >= recipe.form.least_roller and _sampled(design.resized(radius))

    shown = _largest(
        recipe, recipe.roller.radius, sound, lambda radius: sound(radius) and proof(design.resized(radius))
    )
    return f"give a roller radius of at most {shown}" if shown else "give a longer rise or a smaller depth"


def _largest(
    recipe: IndexRecipe, high: float, sound: Callable[[float], bool], proof: Callable[[float], bool] | None = None
) -> str:
    """A little less than the largest size below `high`, mm, to a thousandth, that is sound, in the recipe's unit.

    The size as it is written has passed `proof`, or `sound` where that is None. The text is empty where none is found.
    A size at which one of them raises CurveError or RecipeErrors is not sound.
    """

    def holds(known: Callable[[float], bool], size: float) -> bool:
        try:
            return known(size)
        except (CurveError, RecipeErrors):
            return False

    low, limit = 0.0, SHARP * high
    while high - low > max(SHARP * high, 0.1 * limit):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(sound, middle) else (low, middle)
    # near the bound, samples may find a size sound and a smaller one not, or the proof may be open
    for share in TRIED if low > 0.0 else ():
        shown = downward(share * low / recipe.mm, 4)
        if holds(proof or sound, float(shown) * recipe.mm):
            return f"{shown} {recipe.units}"
    return ""
