"""Remedies of failed checks: functions that give a change of the recipe as text, empty where none is known.

Each takes the check and the report, both as plain data, and the recipe. Figures are in the recipe's unit, rounded to
the side on which the text is true.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from camgeo.cams.family import SMALLER_SWING
from camgeo.checks.extension import CHECKING
from camgeo.common.rounding import downward, upward
from camgeo.part.features import FEATURES
from camgeo.recipe import figures
from camgeo.registry.slot import always

if TYPE_CHECKING:
    from camgeo.checks.declaration import Entry, Remedy
    from camgeo.recipe.limits import Limit
    from camgeo.recipe.recipe import Recipe

WHOLE = 1e-9  # of the unit written: what would be left of a bore is none
MORE_HARMONICS = "a higher delta.harmonics, up to 31, or the same motion as cam.law"

smaller_swing: Remedy = always(SMALLER_SWING)
"""Remedy for a motion that is too steep."""
more_harmonics: Remedy = always(MORE_HARMONICS)
"""Remedy for a series that is too far from its law: more harmonics, or the cam of the law itself."""


def rounder(check: Entry, _report: Entry, recipe: Recipe) -> str:
    """Remedy for too small a least radius of curvature; empty where the radius or its limit is unknown."""
    value, limit, unit = check["value"], check["limit"], check["unit"]
    if value is None or limit is None:
        return ""
    return recipe.cam.advice.on(check.get("surface", "")).rounder(value, limit, unit)


def smaller_wheel(check: Entry, _report: Entry, _recipe: Recipe) -> str:
    """Remedy for a wheel too large for a hollow: the largest grinding wheel that fits; empty for a sharp hollow."""
    value = check["value"]
    return f"a manufacture.wheel of {downward(2.0 * value)} {check['unit']} or less" if value > 0.0 else ""


def wider_face(check: Entry, _report: Entry, recipe: Recipe) -> str:
    """Remedy for a contact that leaves a flat face: the least width of a face that the contact does not leave.

    The contact runs out by the velocity, of which a lobe by its cam card may have less.
    """
    wider = f"{recipe.cam.advice.wider_face(check['value'], recipe.mm)} {check['unit']} or more"
    marks, lobe = recipe.marks, "cam.motion.lobe"
    by_card = any(f"{side}.duration" in marks for side in (lobe, f"{lobe}.opening", f"{lobe}.closing"))
    return f"{wider}, or {lobe}.least: face" if by_card and f"{lobe}.least" not in marks else wider


def shorter_dwell(check: Entry, report: Entry, _recipe: Recipe) -> str:
    """Remedy for too short a dwell: the angle over which the output dwells in the intended motion and with every file.

    Empty where that is 0 or unknown, as for a linkage that does not make a full turn.
    """
    length = worst(check, report)
    return f"a dwell.at_least of {downward(length)} or less, or a wider dwell.band" if length > 0.0 else ""


def worst(check: Entry, report: Entry) -> float:
    """Least value of all checks of the same name, of the design and of files; nan where any of them has no value."""
    values = [other_check["value"] for other_check in report["checks"] if other_check["name"] == check["name"]]
    return math.nan if None in values else min(values)


def lone_ring(recipe: Recipe) -> bool:
    """Whether the part has a round outline and no holes: its one wall is that between opening and outline."""
    part = recipe.part
    return part.outer is not None and part.bore is None and not part.openings


def smaller_bore(check: Entry, _report: Entry, recipe: Recipe) -> str:
    """Remedy for too thin a wall: a smaller bore, or for a ring too thin about its opening a larger outline.

    Empty for other parts, whose check names the edges, and where the detail has a remedy or no bore would be left.
    """
    value, limit, part = check["value"], check["limit"], recipe.part
    detail = check.get("detail", "")
    # a wall between opening and outline is too thin, and the detail does not end with what would do
    outline = part.outer is not None and "opening and outline: " in detail and not detail.endswith(" would do")
    if value is None or limit is None or not (part.plain or outline or lone_ring(recipe)):
        return ""
    change = upward(2.0 * (limit - value))
    if outline or lone_ring(recipe):
        return f"a part.outer larger by more than {change} {check['unit']}"
    if part.bore is None or not (float(change) + WHOLE) * recipe.mm < part.bore:
        return ""
    return f"a bore smaller by more than {change} {check['unit']}"


def nearer(check: Entry, report: Entry, recipe: Recipe) -> str:
    """Remedy for too great a motion error: a smaller export tolerance, or a greater `verify.motion_error`.

    Empty where the recipe sets no limit of the motion error, or the error is unknown or 0.
    """
    value = check["value"]
    if value is None or check["limit"] is None or recipe.verify.motion_error is None or value <= 0.0:
        return ""
    return f"{_tighter(check, report, recipe)}verify.motion_error above {upward(value)}"


def looser(check: Entry, _report: Entry, recipe: Recipe) -> str:
    """Remedy for too great a play: a greater `verify.motion_error`, to which the limit of the play is proportional.

    The value is in the recipe's unit or degrees. Empty where the recipe does not set `verify.motion_error`.
    """
    motion_error, value, limit = recipe.verify.motion_error, check["value"], check["limit"]
    if motion_error is None or value is None or not limit:
        return ""
    in_recipe_unit = math.degrees(motion_error) if recipe.cam.arrangement.unit == "deg" else motion_error / recipe.mm
    return f"verify.motion_error above {upward(in_recipe_unit * value / limit)}"


def _tighter(check: Entry, report: Entry, recipe: Recipe) -> str:
    """Tolerance that would bring a motion error to its limit, followed by ` or `; empty where none is known."""
    tolerance = next((file["tolerance"] for file in report["files"] if file["path"] == check.get("file")), None)
    finer_tolerance = _tolerance(recipe, check["value"], check["limit"], tolerance)
    return f"{finer_tolerance}, or " if finer_tolerance else ""


def _tolerance(recipe: Recipe, value: float, limit: float, tolerance: float | None) -> str:
    """Tolerance that would bring a motion error to a limit; empty where none is known."""
    if limit <= 0.0:
        return ""
    if recipe.cam.advice.gain == 1.0:  # the follower is off by no more than the contour
        return f"a tolerance of {limit:.6g}"
    return "" if tolerance is None else f"a tolerance of about {tolerance * limit / value:.2g}"


# --- limits of a recipe's own -----------------------------------------------------------------------------------------


class Missed(NamedTuple):
    """A figure's value and the bound that it misses, both in `unit`, lengths in mm and angles in degrees.

    `tolerance` is the tolerance of the file, mm, None for a figure of no file. `surface` names the surface of the
    figure, empty for a cam of one surface.
    """

    value: float
    bound: float
    unit: str
    tolerance: float | None = None
    surface: str = ""


def limit_remedy(recipe: Recipe, limit: Limit, missed: Missed) -> str:
    """Remedy for a missed limit: a change of the cam where one is known, else the limit that the figure keeps.

    Lengths are in the recipe's unit.
    """
    # a change of the cam is the first choice, a change of the limit the last
    divisor = recipe.mm if missed.unit.partition("/")[0] == "mm" else 1.0
    value, bound = missed.value / divisor, missed.bound / divisor
    lower = value > bound
    figure = limit.figure
    geometry = _to_lower(recipe, figure, missed) if lower else _to_raise(recipe, figure, missed)
    owner = figures.FIGURES.owner(figure)
    own_remedy = CHECKING[owner].remedy(recipe, figure, value, bound) if owner else ""
    other_remedies = (own_remedy, _of_preload(figure, value, bound), _of_lobe(recipe, limit, value, bound))
    places = (_of_place(recipe, figure, value, bound), _of_files(recipe, figure, missed))
    if remedy := next(filter(None, (geometry, *other_remedies, *places)), ""):
        return remedy
    return f"{limit.field('at_most' if lower else 'at_least')} of {_outward(value, up=lower)}"


def _to_lower(recipe: Recipe, figure: str, missed: Missed) -> str:
    """Change that would lower a figure to a bound; empty where none is known."""
    if figure == figures.MOTION_ERROR:
        tolerance = None if missed.tolerance is None else missed.tolerance / recipe.mm
        return _tolerance(recipe, missed.value / recipe.mm, missed.bound / recipe.mm, tolerance)
    if missed.bound <= 0.0 or recipe.linkage is not None:
        return ""
    if figure == figures.LAW_ERROR:
        return MORE_HARMONICS
    if figure == figures.ROLLER_SPEED:
        return "a larger roller"
    if figure == figures.ECCENTRICITY:  # metal about the shaft draws the centre of mass to it
        return ", or ".join([*(feature.steadies for feature in FEATURES if feature.steadies), "a smaller bore"])
    if figure in {figures.SIZE, figures.MASS, figures.INERTIA, figures.UNBALANCE}:
        return "a smaller cam" if figure == figures.SIZE else "a thinner or a smaller part"
    eased_by = figures.FIGURES[figure].eased_by
    if not eased_by:
        return ""
    if figure == figures.PRESSURE_ANGLE:
        least = recipe.cam.advice.least_pressure_angle
        if missed.bound <= least:
            return f"a ratio nearer to 1 (at this one no swing, however small, stays below {least:.4g} deg)"
    sizing_path = "cam.sizing.pressure-angle"
    if sizing_path in recipe.marks and figure in {figures.PRESSURE_ANGLE, figures.ON_RISE, figures.ON_RETURN}:
        limits_both = figure == figures.PRESSURE_ANGLE and f"{sizing_path}.on_return" in recipe.marks
        key = "on_return" if figure == figures.ON_RETURN else "at_most and on_return" if limits_both else "at_most"
        return f"{key} of {missed.bound:.6g} under sizing"
    advice = recipe.cam.advice.on(missed.surface)
    # a recipe that leaves its sizes open cannot be told to give a larger one
    if advice.larger and eased_by == "size" and not recipe.cam.sizes:
        return f"{advice.larger}, {advice.less_steep}"
    return advice.less_steep


def _to_raise(recipe: Recipe, figure: str, missed: Missed) -> str:
    """Change that would raise a figure to a bound, lengths in the recipe's unit; empty where none is known."""
    unit, remedy = "in" if recipe.units == "inch" else "mm", ""
    value, bound = missed.value / recipe.mm, missed.bound / recipe.mm
    lack, own_advice = bound - value, recipe.cam.advice
    advice = own_advice.on(missed.surface)
    # sizing makes the contour of disc 1 rounder; that of disc 2, and a ring, are rounder by a smaller roller alone
    if figure == figures.RADIUS and recipe.cam.sizes and advice is own_advice and recipe.cam.side > 0:
        remedy = advice.rounder(value, bound, unit)
    elif figure in {figures.RADIUS, figures.HOLLOW_RADIUS} and advice.radius:
        # the contour is the pitch curve's parallel inside: its convex radii are less by the roller's, hollow ones more
        roller, hollow = advice.radius / recipe.mm, figure == figures.HOLLOW_RADIUS
        # a larger roller widens hollows if the pitch curve keeps a base circle; in a ring the base radius widens them
        may_grow = recipe.cam.side > 0 and roller + lack < advice.most_radius / recipe.mm
        # a hollow needs a roller that may grow; a convex place a smaller one, of which something has to be left
        if may_grow if hollow else lack < roller:
            remedy = f"a {advice.radius_field} of {upward(roller + lack) if hollow else downward(roller - lack)} {unit}"
            remedy += advice.same_pitch(recipe.mm)
    elif figure == figures.RADIUS:
        # a flat face's size grows by the difference of both, 0 to the lack; a knife edge has no words for a radius of 0
        remedy = advice.rounder(0.0, lack, unit)
    elif figure == figures.PITCH_RADIUS:
        remedy = "" if recipe.cam.sizes else ", ".join(filter(None, (advice.larger, advice.less_steep)))
    elif figure in figures.OF_LINKS:
        remedy = "longer links, all in one proportion, about the same cam"
    elif figure in {figures.DWELL, figures.DWELL_RELATIVE}:
        remedy = "a wider dwell.band"
    elif figure == figures.PIVOT_CLEARANCE:
        remedy = "a pivot farther from the shaft"
    elif figure == figures.LEAST_WALL and lone_ring(recipe):
        remedy = f"a part.outer larger by more than {upward(2.0 * lack)} {unit}"
    elif figure == figures.LEAST_WALL and recipe.part.plain and recipe.part.bore is not None:
        remedy = (
            f"a bore smaller by more than {upward(2.0 * lack)} {unit}"
            if 2.0 * lack * recipe.mm < recipe.part.bore
            else ""
        )
    return remedy


def _of_preload(figure: str, value: float, bound: float) -> str:
    """Interference that would bring the force of a preload to a bound above 0; empty for other figures."""
    if bound <= 0.0 or value <= 0.0 or figure not in {figures.PRELOAD_LEAST, figures.PRELOAD_GREATEST}:
        return ""
    share = upward(bound / value) if value < bound else downward(bound / value)  # in proportion to it
    return f"a cam.preload.interference {share} times as large"


def _of_place(recipe: Recipe, figure: str, value: float, bound: float) -> str:
    """Size or place of the recipe, in its unit, that would meet a bound; empty for other figures."""
    must_rise, unit = value < bound, "in" if recipe.units == "inch" else "mm"
    if figure == figures.LOBE_CENTRE and "cam.motion.lobe" in recipe.marks:
        nose = f"a cam.motion.lobe.nose {'larger' if must_rise else 'smaller'} by"
        return f"{nose} {upward(abs(bound - value))} deg"
    keys = {
        figures.BASE_RADIUS: "cam.base_radius",
        figures.OFFSET: "cam.follower.offset",
        figures.PIVOT: "cam.follower.arm.pivot",
    }
    if figure not in keys:
        return ""
    if figure == figures.BASE_RADIUS and recipe.cam.sizes:
        angle, limited = figures.PRESSURE_ANGLE, "cam.sizing.pressure-angle" in recipe.marks
        return f"a {'smaller' if must_rise else 'greater'} {angle} under sizing" if limited else ""
    return f"a {keys[figure]} of {bound:.9g} {unit} or {'more' if must_rise else 'less'}"


def _of_files(recipe: Recipe, figure: str, missed: Missed) -> str:
    """Tolerance that would bring a figure of a file to its bound: errors are in proportion to it."""
    must_fall = missed.bound < missed.value
    if figure == figures.PIECES:
        return f"a {'larger' if must_fall else 'smaller'} tolerance"
    if not must_fall or missed.bound <= 0.0 or missed.tolerance is None:
        return ""
    if figure == figures.CONTOUR_ERROR:
        return f"a tolerance of {missed.bound / recipe.mm:.6g}"
    if figure in {figures.BACKLASH, figures.DWELL_ERROR, figures.OUTPUT_ERROR}:
        return f"a tolerance of about {missed.tolerance * missed.bound / missed.value / recipe.mm:.2g}"
    return ""


def _of_lobe(recipe: Recipe, limit: Limit, value: float, bound: float) -> str:
    """Change of a lobe's half, or of segments, that would bring duration, area or ramp velocity to a bound."""
    half, must_rise = "cam.motion.lobe.half", value < bound
    if limit.figure not in {figures.DURATION, figures.LIFT_AREA, figures.RAMP_VELOCITY} or bound <= 0.0 or value <= 0.0:
        return ""
    if half not in recipe.marks:
        segments = any(path.startswith("cam.motion[") for path in recipe.marks)
        longer = must_rise if limit.figure != figures.RAMP_VELOCITY else not must_rise
        return f"a rise and a return over {'more' if longer else 'less'} of the turn" if segments else ""
    if limit.figure == figures.RAMP_VELOCITY:
        return "" if must_rise else f"a larger {half}"
    about = "about " if "cam.motion.lobe.ramp" in recipe.marks else ""  # which keeps its length
    return f"a {half} {about}{upward(bound / value) if must_rise else downward(bound / value)} times as large"


def _outward(value: float, *, up: bool) -> str:
    """Text of a limit that the value keeps: rounded to a greater number with `up`, else to a smaller one."""
    if value == 0.0:
        return "0"
    text = upward(abs(value)) if up == (value > 0.0) else downward(abs(value))
    return text if value > 0.0 else f"-{text}"
