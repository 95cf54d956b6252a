"""Whether a drum can be made: undercut that is refused, motion that is lost, arms that swing far, ends in the flank."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.crossings import lost_of
from camgeo.capabilities.cylindrical.guide import Arm
from camgeo.capabilities.cylindrical.patches import demand_smooth, kept_between
from camgeo.capabilities.cylindrical.shoe import demand_led
from camgeo.capabilities.cylindrical.undercut import SHARP, CutError, largest_regular
from camgeo.common.rounding import downward, upward
from camgeo.curve.curve import CurveError
from kin.numeric.records import replace

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.flank import Flank
    from camgeo.capabilities.cylindrical.undercut import Tip

MOST_SWING = 80.0  # degrees of an arm off the plane across the drum's axis
ROLLER = "cam.follower.radius"


def demand_sound(design: DrumDesign) -> None:
    """Raise RecipeErrors where a drum is not made as its recipe has it, with the changes that serve."""
    _demand_near(design)
    _demand_core(design)
    try:
        found = design.tips
    except CurveError as error:
        raise design.error("cam", f"{error}, near {_degrees(design, error.parameter):.6g} degrees") from error
    if not any(found.values()):
        _demand_tracks(design)
        return
    if not design.recipe.shortens:
        raise _undercut(design)
    try:
        _ = design.cuts
    except CutError as error:
        where = f"near {_degrees(design, error.parameter):.6g} degrees"
        raise design.error("cam.undercut", f"{error} {where}", _smaller(design)) from error
    _demand_carried(design)


def _demand_tracks(design: DrumDesign) -> None:
    """Raise RecipeErrors for tracks that run into one another, and for a follower that does not pass them."""
    remedy = "give more lift a turn, shorter rests, or a narrower follower"
    try:
        _ = design.crossings
        for name in design.flanks:
            for r in (design.recipe.floor, design.recipe.radius):
                kept_between(lost_of(design.crossings, name), r, design.recipe.period)
        remedy = "let segments meet a few degrees earlier or later, or take laws that join without a step"
        demand_smooth(design)
    except CurveError as error:
        problem = f"{error}, near {_degrees(design, error.parameter):.6g} degrees"
        raise design.error("cam.motion", problem, remedy) from error
    demand_led(design)


def _degrees(design: DrumDesign, angle: float) -> float:
    """A shaft angle, rad, in degrees of one period."""
    return math.degrees(angle) % math.degrees(design.recipe.period)


def _undercut(design: DrumDesign) -> Exception:
    """Error of an undercut drum: how far out it reaches, and the roller or the depth without it."""
    recipe, mm, units = design.recipe, design.recipe.mm, design.recipe.units
    name, tip = _outermost(design)
    problem = (
        f"the {name} flank is undercut from the floor out to {tip.r / mm:.6g} {units} from the axis, "
        f"near {_degrees(design, tip.at):.6g} degrees"
    )
    remedies = [_smaller(design)]
    if tip.r < recipe.radius - SHARP * recipe.radius:
        if not recipe.track.closed:
            remedies.append(f"let the roller begin at {upward(tip.r / mm + 0.5 / mm, 5)} {units}")
        else:
            remedies.append(
                f"give a depth of at most {downward((1.0 - SHARP) * (recipe.radius - tip.r) / mm, 4)} {units}"
            )
        if recipe.turns == 1:
            remedies.append("let contact begin farther out: undercut: shorten")
    return design.error(ROLLER, problem, ", or ".join(filter(None, remedies)))


def _outermost(design: DrumDesign) -> tuple[str, Tip]:
    return max(((name, tip) for name, found in design.tips.items() for tip in found), key=lambda each: each[1].r)


def _smaller(design: DrumDesign) -> str:
    """Remedy with the largest roller, to a thousandth, that undercuts no flank; empty where none is found."""
    recipe = design.recipe

    def resized(radius: float) -> list[Flank]:
        roller, more = recipe.roller.resized(radius), radius - recipe.roller.radius
        return [replace(each, radius=each.radius + more, taper=roller.taper) for each in design.flanks.values()]

    most = largest_regular(resized, recipe.roller.radius, (recipe.floor, recipe.radius))
    if most == 0.0:
        return ""
    return f"give a roller radius of at most {downward((1.0 - SHARP) * most / recipe.mm, 4)} {recipe.units}"


def _demand_carried(design: DrumDesign) -> None:
    """Raise RecipeErrors where a shortened line carries nothing at some shaft angle, so that motion is lost."""
    from camgeo.capabilities.cylindrical.figures import contact_length

    for name in design.flanks:

        def missing(theta: np.ndarray, name: str = name) -> np.ndarray:
            return -contact_length(design, name, theta)

        most, at = design.greatest(missing)
        if most >= 0.0:
            problem = f"nothing of the roller's line carries it near {math.degrees(at):.6g} degrees: motion is lost"
            raise design.error("cam.undercut", problem, _smaller(design))


def _demand_near(design: DrumDesign) -> None:
    """Raise RecipeErrors where a roller is led past the floor, or so that its cone ends, or an arm swings too far."""
    recipe, mm, units = design.recipe, design.recipe.mm, design.recipe.units
    for flank in design.flanks.values():
        low, high = design.motion.range
        if recipe.swings:
            ends = [math.degrees(abs(float(flank.guide.lean(np.array([lift]))[0]))) for lift in (low, high)]
            if not max(ends) < MOST_SWING:
                problem = f"the arm swings to {max(ends):.6g} degrees off the plane across the drum's axis"
                remedy = (
                    f"keep it within {MOST_SWING:g}: a smaller swing, or a pivot nearer to the middle of the stroke"
                    + (", or a smaller distance" if recipe.track.distance else "")
                )
                raise design.error("cam.motion", problem, remedy)
        off, at = design.greatest(lambda theta, flank=flank: np.abs(flank.pose(theta).y))  # type: ignore[misc]
        room = recipe.floor - float(flank.size(recipe.floor))
        if not off < room:
            problem = f"the roller's axis stands {off / mm:.6g} {units} off a radius of the drum, past the floor's edge"
            field, remedy = "cam.follower.offset", f"give less than {downward(room / mm, 5)} {units}"
            if isinstance(flank.guide, Arm):
                field, remedy = "cam.follower.arm.offset", _nearer(design, low, high)
            raise design.error(field, f"{problem}, near {math.degrees(at):.6g} degrees", remedy)
        least = math.sqrt(recipe.floor**2 - (off + float(flank.size(recipe.floor))) ** 2)
        if not float(flank.size(least)) > 0.0:
            problem = "the cone ends in its apex before the floor"
            raise design.error("cam.follower.taper", problem, "give a smaller taper, axis, or a larger radius")
        back, at = design.greatest(lambda theta, flank=flank: -flank.pose(theta).y1)  # type: ignore[misc]
        if not back < least:
            problem = f"the arm takes its roller back faster than the floor turns, near {math.degrees(at):.6g} degrees"
            raise design.error("cam.motion", problem, "give a longer motion, or an arm that stands less aslant")


def _nearer(design: DrumDesign, low: float, high: float) -> str:
    """Remedy for an arm that leads its roller, or one of two, too far off a radius between two lifts, rad."""
    recipe = design.recipe
    arms = [(flank, flank.guide) for flank in design.flanks.values() if isinstance(flank.guide, Arm)]
    least, most = zip(*(arm.across(low, high) for _, arm in arms), strict=True)
    room = min(recipe.floor - float(flank.size(recipe.floor)) for flank, _ in arms)
    if 0.5 * (max(most) - min(least)) < room:
        return f"give {0.5 * arms[0][1].side * (min(least) + max(most)) / recipe.mm:.6g} {recipe.units}"
    return "no offset serves: give a smaller swing, or a shorter arm that is level in the middle of it"


def _demand_core(design: DrumDesign) -> None:
    """Raise RecipeErrors for an end cam whose core ends between the lowest and the highest place of its flank."""
    recipe = design.recipe
    if recipe.track.closed:
        return
    ((name, flank),) = design.flanks.items()
    least, most = (flank.resting(lift, recipe.floor) for lift in design.motion.range)
    if name == "lower":
        end, field = recipe.height, "part.length"
        problem = "the drum ends between the lowest and the highest place of its flank"
    else:
        end, field = 0.0, "cam.pitch_height"
        problem = "the lower face lies between the lowest and the highest place of the flank"
    if least < end < most:
        mm, units = recipe.mm, recipe.units
        if name == "lower":
            remedy = f"give more than {most / mm:.6g} {units}, or less than {least / mm:.6g} {units}"
        elif recipe.swings:
            remedy = f"raise it and the arm's pivot by more than {-least / mm:.6g} {units}"
        else:
            remedy = f"give more than {(recipe.level - least) / mm:.6g} {units}"
        raise design.error(field, problem, remedy)
