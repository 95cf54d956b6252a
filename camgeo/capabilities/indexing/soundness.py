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
from camgeo.capabilities.indexing.tracks import rib_thickness, track
from camgeo.capabilities.indexing.undercut import demand_regular
from camgeo.common.rounding import downward
from camgeo.curve.curve import CurveError

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.capabilities.indexing.design import IndexDesign

LAYERS = 5  # in which undercut is sought
SHARP = 1e-3  # of a radius in a remedy
CLEAR = 1.01  # radii of a roller in a remedy, between its axis and the flank that its other half passes
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

    size, mm = _largest(abs(recipe.clearance), sound), recipe.mm
    half, name = ("upper", "lower") if sign > 0.0 else ("lower", "upper")
    problem = f"the {half} half of a roller meets the {name} flank, near {math.degrees(at) % 360.0:.6g} degrees"
    remedy = f"give at most {downward(size / mm, 4)} {recipe.units}" if size > 0.0 else "leave it out"
    raise design.error(f"cam.turret.{word}", problem, remedy)


def _demand_proved(design: IndexDesign) -> None:
    """Raise RecipeErrors where the track does not go from end face to end face, or undercut is not proved away."""
    try:
        demand_ends(design.flanks)
    except TrackError as error:
        length = _largest(design.recipe.length, lambda length: _passes(design.shortened(length)))
        mm, units = design.recipe.mm, design.recipe.units
        remedy = error.remedy
        if length > 0.0:
            remedy = f"give at most {downward(length / mm, 4)} {units}, with the turret's axis in its middle"
        where = f"near {math.degrees(error.parameter) % 360.0:.6g} degrees"
        raise design.error("part.length", f"{error}, {where}", remedy) from error
    try:
        for flank in design.flanks.values():
            demand_regular(flank)
    except CurveError as error:
        where = f"near {math.degrees(error.parameter) % 360.0:.6g} degrees"
        raise design.error(ROLLER, f"{error}, {where}", _smaller(design, _proved)) from error


def _passes(design: IndexDesign) -> bool:
    try:
        demand_ends(design.flanks)
    except CurveError:
        return False
    return True


def _proved(design: IndexDesign) -> bool:
    try:
        for flank in design.flanks.values():
            demand_regular(flank)
    except CurveError:
        return False
    return True


def _demand_forward(design: IndexDesign, name: str) -> None:
    """Raise RecipeErrors where a turret takes its roller back as fast as the cam turns: its track would turn back."""
    least, at = _forward(design, name)
    if not least > 0.0:
        problem = (
            f"the turret takes a roller back as fast as the floor turns, near {math.degrees(at) % 360.0:.6g} degrees"
        )

        def sound(length: float) -> bool:
            shorter = design.shortened(length)
            return all(_forward(shorter, each)[0] > 0.0 for each in shorter.flanks) and _all_regular(shorter)

        length = _largest(design.recipe.length, sound)
        mm, units = design.recipe.mm, design.recipe.units
        shorter = f", or a length of at most {downward(length / mm, 4)} {units}, with the turret's axis in its middle"
        raise design.error(
            "cam.motion", problem, f"give a longer rise{shorter if length > 2.0 * design.recipe.roller.radius else ''}"
        )


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


def _all_regular(design: IndexDesign) -> bool:
    try:
        return all(_least_regular(design, name)[0] > 0.0 for name in design.flanks)
    except CurveError:
        return False


def _smaller(design: IndexDesign, sound: Callable[[IndexDesign], bool]) -> str:
    """Remedy with the largest roller, to a thousandth, of which a cam is sound; empty where none is found."""
    mm, units = design.recipe.mm, design.recipe.units
    radius = _largest(design.recipe.roller.radius, lambda radius: sound(design.resized(radius)))
    return f"give a roller radius of at most {downward(radius / mm, 4)} {units}" if radius > 0.0 else ""


def _largest(high: float, sound: Callable[[float], bool]) -> float:
    """A little less than the largest size below `high`, mm, to a thousandth, that is sound; 0 where none is found."""
    low, limit = 0.0, SHARP * high
    while high - low > max(SHARP * high, 0.1 * limit):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sound(middle) else (low, middle)
    return (1.0 - SHARP) * low
