"""Remarks: what an engineer would look at twice, though no check fails."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.checks.declared import CLOSED, LAW, MOTION, PRESSURE
from camgeo.checks.remedies import MORE_HARMONICS
from camgeo.common.rounding import NOISE, downward, upward
from camgeo.curve.support import is_sharp
from camgeo.measures.extension import MEASURES
from camgeo.measures.figures import design_figures
from camgeo.measures.rule_remark import RuleRemark, source_remarks
from camgeo.measures.units import UNIT_NAMES, displacement_unit
from camgeo.part.features import with_records
from camgeo.recipe.figures import ON_RETURN, ON_RISE, PITCH_RADIUS, PIVOT_CLEARANCE, RADIUS
from camgeo.synthesis.checks import hollow_radius
from kin.law.joints import DerivativeJump
from kin.numeric.angles import degrees
from kin.numeric.records import replace
from kin.read.formats import FORMATS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.cams.family import Cam
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design
    from camgeo.synthesis.linkage import DesignedLinkage
    from kin.numeric.check import Check

PRESSURE_RULE = {"oscillating": 45.0, "translating": 30.0}  # degrees: cam handbooks' rule of thumb for rollers
RETURN_RULE = 45.0  # degrees, where a spring holds the follower
SHARE = 0.1  # of the stroke: an error as great as that is no small one
LOOSE = 0.01  # of the stroke, or of the rollers' radius: a limit as great as that says little
THICKEST, THINNEST = 2.0, 0.01  # of the cam's greatest radius
LASTS = 0.95  # of an intended dwell: the least share that a file's dwell lasts without a remark
STILL = 1e-9  # of the cam's size: a stroke below this is no motion
LOOKS = 1440  # places of a turn at which the stroke is sampled
NEAR = 0.05  # of the swing: the greatest error of a series that follows a wanted law without a remark
CLEAR = 0.05  # of the cam's size
SHAFT = 0.02  # of the cam's size: the least radius of a shaft that drives it
HALF = 0.5  # of the least convex radius of the pitch curve: the greatest roller by rule of thumb
INCH, STEP, HALF_MM = 25.4, 64.0, 0.5  # sizes by the inch are whole 64ths, metric ones whole or half mm
_SAME = 1e-6


RemarkName = Literal[
    "acceleration-jump",
    "cam-card",
    "coarse-tolerance",
    "contour",
    "dwell-shorter",
    "joined",
    "large-cutter",
    "large-roller",
    "least-angle",
    "loose-motion-error",
    "loose-output-error",
    "metric-keyway",
    "no-motion",
    "pivot-clearance",
    "no-play",
    "openings",
    "pressure-angle",
    "shaft-outside",
    "sharp-corner",
    "sizing",
    "table-angles",
    "table-distance",
    "table-noise",
    "table-row",
    "thick",
    "thin",
    "wanted-law",
    "wide-dwell-band",
]
"""Names of the core's remarks."""


def remarks_of(
    recipe: Recipe, design: Design, checks: Sequence[Check] = (), files: Sequence[FileResult] = ()
) -> tuple[RuleRemark, ...]:
    """All remarks on a recipe, its design and its files, in the order of the report.

    `checks` are all checks of the run. Remarks on files are left out where `files` is empty.
    """
    remarks: dict[str, Sequence[RuleRemark | None]] = {
        "sizing": [_sizing(recipe, design), _least_angle(recipe)],
        "pressure-angle": [_pressure(recipe, design)],
        "large-roller": [_roller(recipe, design)],
        "sharp-corner": [_corner(recipe, design)],
        "large-cutter": [_cutter(recipe, design)],
        "pivot-clearance": [_pivot(recipe, design)],
        "motion": _motion(recipe, design),
        "table": source_remarks(design.exact.kept),
        "wanted-law": [_law_error(recipe, design)],
        "loose-motion-error": [_implied(recipe, design, checks, files)],
        "no-play": [_stuck(recipe, design, files)],
        "joined": _joined(recipe, checks, files),
        "openings": [_openings(recipe, files)],
        "acceleration-jump": [_acceleration(recipe, design.exact.joints)],
        "output": _output(recipe, design),
        "shaft-outside": [_shaft(recipe, design)],
        "metric-keyway": _metric(recipe),
        "thickness": [_thickness(recipe, design)],
    }
    for answers in MEASURES.of(recipe.uses):
        for after, more in answers.remarks.items():
            remarks[after] = [*remarks[after], *more(recipe, design)]
    return tuple(remark for group in remarks.values() for remark in group if remark is not None)


def _sizing(recipe: Recipe, design: Design) -> RuleRemark | None:
    """The size that `sizing` chose, and the limit that bounds it; None without sizing."""
    sentence = recipe.cam.advice.chosen_size(design.exact, recipe.mm)
    return RuleRemark("sizing", None, None, "", sentence) if sentence else None


def _least_angle(recipe: Recipe) -> RuleRemark | None:
    """The least angle that all limits allow, and the checks that fail below it; None where no angle was open."""
    choice = recipe.settled
    if choice is None:
        return None
    least, rest = choice.least.degrees, choice.rest.degrees
    sentence = f"{choice.kind} over {least:.10g} deg, the least that all limits allow"
    if choice.bound:
        sentence += f": a hundredth less fails {' and '.join(choice.bound)}"
    sentence += f"; the dwell takes {rest:.10g}"
    if choice.again:
        sentence += f"; not all longer ones are allowed, such as {choice.again[0]:.4g} deg"
    return RuleRemark("least-angle", least, None, "deg", sentence)


def _pressure(recipe: Recipe, design: Design) -> RuleRemark | None:
    """A pressure angle of a roller beyond the rule of thumb, with the size that keeps the rule.

    None where the recipe limits that angle itself. On the return a follower held by a spring may be steeper.
    """
    if "roller" not in recipe.cam.arrangement.offers or "cam.sizing.pressure-angle" in recipe.marks:
        return None
    bounded = (limit.figure for limit in recipe.limits if limit.at_most is not None)
    if not {PRESSURE.name, ON_RISE, ON_RETURN}.isdisjoint(bounded):
        return None
    angles = [check for check in design.checks if check.name == PRESSURE.name and check.value is not None]
    steepest = max(angles, key=lambda check: check.value or 0.0, default=None)
    kind = "oscillating" if recipe.cam.arrangement.unit == "deg" else "translating"
    rule = PRESSURE_RULE[kind]
    if steepest is None or steepest.value is None or steepest.value <= rule or not steepest.ok:
        return None
    slopes = [slope for surface in design.exact.surfaces if (slope := surface.extremes("slope")) is not None]
    # rise and return have rules of their own where a spring holds the follower
    return_rule, value, at_deg, where = rule, steepest.value, steepest.at_deg, ""
    if slopes and not design.follower.closure:
        return_rule = RETURN_RULE
        # of each flank: its extreme slope, the sign with which it counts, the rule for it, and words for where it is
        sides = [
            side
            for least, most in slopes
            for side in ((most, 1.0, rule, " on the rise"), (least, -1.0, return_rule, " on the return"))
        ]
        # the same with the pressure angle, degrees, in place of the sign
        flanks = [(side, math.degrees(math.atan(sign * side.value)), most, name) for side, sign, most, name in sides]
        over = [row for row in flanks if row[1] > row[2]]
        if not over:
            return None
        worst, value, rule, where = max(over, key=lambda row: row[1] - row[2])
        at_deg = degrees(worst.at)
    if steepest.surface and not where:
        where = f" on {steepest.surface}"
    sentence = f"the pressure angle reaches {value:.4g} deg{where}; up to {rule:.0f} is the rule for {kind} followers"
    remedy = design.exact.less_pressure(math.radians(PRESSURE_RULE[kind]), math.radians(return_rule), recipe.mm)
    if remedy is not None:
        size, resized = remedy
        against = _against(recipe, resized, design)
        sentence += f"; {size} would keep it, but {against}" if against else f", which {size} keeps"
    return RuleRemark("pressure-angle", value, rule, "deg", sentence, at_deg)


def _against(recipe: Recipe, cam: Cam, design: Design) -> str:
    """Words for what speaks against a cam of another size for the same motion; empty where nothing does."""
    from camgeo.curve.curve import CurveError
    from camgeo.curve.measures import farthest, nearest
    from camgeo.synthesis.design import sound
    from kin.law.normalised import IntentError

    cam = cam.refusing_undercut()
    try:
        exact = cam.exact()
        surfaces = [sound(replace(recipe, cam=cam), exact, surface) for surface in exact.surfaces]
    except (CurveError, IntentError):
        return "its curve cannot be made"
    contours = [surface.contour for surface in surfaces if surface.contour is not None]
    if len(contours) < len(surfaces):
        return f"fails {next(check.name for surface in surfaces for check in surface.checks if not check.ok)}"
    part = recipe.part
    if part.outer is not None:
        reach = 2.0 * max(farthest(contour).value for contour in contours)
        return f"needs a part.outer above {upward(reach / recipe.mm)}" if reach >= part.outer else ""
    shaft = SHAFT * size_of(design) if part.bore is None else 0.5 * part.bore
    return "leaves no metal round the shaft" if min(nearest(contour).value for contour in contours) <= shaft else ""


def _roller(recipe: Recipe, design: Design) -> RuleRemark | None:
    """A roller above half the pitch curve's least convex radius, where the recipe limits no radius."""
    if any(limit.figure in {RADIUS, PITCH_RADIUS} and limit.at_least is not None for limit in recipe.limits):
        return None
    solid = [made for made in design.surfaces if made.surface.side > 0]  # metal inside: no ring, no outer flank
    radii = [(made.bent.value, made) for made in solid if made.bent.value is not None]
    if not design.contours or not radii:
        return None
    radius, sharpest = min(radii, key=lambda row: HALF * row[0] - row[1].surface.radius)
    roller, surface = sharpest.surface.radius, sharpest.surface.name
    if not HALF * radius < roller:
        return None
    size = design.exact.rounder_pitch(surface, recipe.mm)
    if recipe.cam.sizes:
        unit = UNIT_NAMES[recipe.units]
        size = recipe.cam.advice.on(surface).rounder(HALF * radius / recipe.mm, roller / recipe.mm, unit)
    if not size:
        return None
    where = f" on {surface}" if sharpest.surface.disc else ""
    sentence = (
        f"the roller's radius{where}, {_length(recipe, roller)}, is {roller / radius:.3g} times the pitch curve's "
        f"least convex radius; up to half is the rule, which {size} keeps"
    )
    return RuleRemark("large-roller", roller, HALF * radius, "mm", sentence, sharpest.bent.at_deg)


def _corner(recipe: Recipe, design: Design) -> RuleRemark | None:
    """Sharp corners that the recipe asks for, where it limits no radius."""
    sharp = [contour for _, contour in design.contours if is_sharp(contour)]
    if not sharp or any(limit.figure == RADIUS and limit.at_least is not None for limit in recipe.limits):
        return None
    runs = sharp[0].runs
    pairs = zip(runs, [*runs[1:], runs[0]], strict=True)
    turns = [(after.low - before.high) % sharp[0].shape.period for before, after in pairs]
    longest = max(range(len(runs)), key=turns.__getitem__)
    sentence = (
        f"the contact stays on a sharp corner for {math.degrees(turns[longest]):.4g} degrees: its edge wears, the "
        "contact pressure has no bound; a reuleaux.rounding above 0 rounds it"
    )
    at_deg = design.motion.shaft_deg(runs[longest].high)
    return RuleRemark("sharp-corner", math.degrees(turns[longest]), 0.0, "deg", sentence, at_deg)


def _cutter(recipe: Recipe, design: Design) -> RuleRemark | None:
    """A hollow that the cutter does not reach into, where no program says so by its checks."""
    manufacture = recipe.manufacture
    if manufacture is None or not design.contours or "roller" not in recipe.cam.arrangement.offers:
        return None
    if manufacture.layer or any(request.format.program for request in recipe.export.files):
        return None
    radius, parameter = min(hollow_radius(surface.side, contour) for surface, contour in design.contours)
    if radius >= manufacture.radius:
        return None
    sentence = (
        f"the contour has a hollow of radius {_length(recipe, radius)}, which a cutter of "
        f"{_length(recipe, manufacture.cutter)} does not reach into; "
        f"a cutter of {downward(2.0 * radius / recipe.mm)} does"
    )
    return RuleRemark("large-cutter", radius, manufacture.radius, "mm", sentence, design.motion.shaft_deg(parameter))


def _pivot(recipe: Recipe, design: Design) -> RuleRemark | None:
    """A disc that passes over its arm's pivot: it can be made, and lies in another plane than the pivot's pin."""
    if "arm" not in recipe.cam.arrangement.offers or not design.contours:
        return None
    if any(limit.figure == PIVOT_CLEARANCE and limit.at_least is not None for limit in recipe.limits):
        return None
    clearance = design_figures(recipe, design, design.checks, [PIVOT_CLEARANCE])[PIVOT_CLEARANCE]
    if clearance.value is None or clearance.value > 0.0:
        return None
    sentence = f"the disc passes over the arm's pivot, by {_length(recipe, -clearance.value)}"
    return RuleRemark("pivot-clearance", clearance.value, 0.0, "mm", sentence, clearance.at_deg)


def _stuck(recipe: Recipe, design: Design, files: Sequence[FileResult]) -> RuleRemark | None:
    """A roller that files within a coarse tolerance leave no play in its groove, though the recipe gives it some."""
    first, *further = design.follower.contacts
    clearance = max((contact.touch.radius - first.touch.radius for contact in further), default=0.0)
    closures = [(closure, file) for file in files for closure in file.closures]
    if not (clearance > 0.0 and closures and design.follower.arrangement.contacts == 1):
        return None
    closure, file = min(closures, key=lambda pair: pair[0].play.least)
    play = closure.play
    if play.least > 0.0:
        return None
    play_words = _length(recipe, play.least) if play.unit == "mm" else f"{play.least:.3g} deg"
    sentence = (
        f"{file.path.name} leaves the roller {play_words} between {closure.pushes} and {closure.stops}: "
        f"it sticks there; a tolerance below {downward(0.5 * clearance / recipe.mm)} leaves it play"
    )
    return RuleRemark("no-play", play.least, 0.0, play.unit, sentence, play.least_at_deg)


def _joined(recipe: Recipe, checks: Sequence[Check], files: Sequence[FileResult]) -> list[RuleRemark]:
    """Remarks on ends of drawings that were joined though they do not quite meet; none where `closed` fails."""
    whole = {check.file for check in checks if check.name == CLOSED.name and check.ok}
    remarks = []
    for file in files:
        if not file.uneven or file.path.name not in whole or FORMATS[file.request.kind].contents != "drawing":
            continue
        counted = "are joined, and that is counted into its errors"
        sentence = f"ends of {file.path.name} up to {_length(recipe, file.uneven)} apart {counted}"
        remarks.append(RuleRemark("joined", None, None, "", sentence))
    return remarks


def _openings(recipe: Recipe, files: Sequence[FileResult]) -> RuleRemark | None:
    """Remark on what of files is not judged, as the recipe asks for; None where all is."""
    if recipe.verify.openings == "judge":
        return None
    names = [file.path.name for file in files if any(len(body) > len(file.surfaces) for body in file.bodies)]
    told = [f"openings of {' and '.join(names)} that the part does not name are not judged"] if names else []
    passed = [(file.path.name, ", ".join(file.passed)) for file in files if file.passed]
    told += [f"what is no part of the cam in {name} is passed over, {words}" for name, words in passed]
    if not told:
        return None
    sentence = f"{'; '.join(told)}, as verify.openings has it"
    return RuleRemark("openings", None, None, "", sentence)


def _motion(recipe: Recipe, design: Design) -> list[RuleRemark | None]:
    """Remarks on a follower that stands still, and on permitted errors that are a good part of its stroke."""
    stroke, arm = _stroke(design)
    length = stroke * arm
    if length <= STILL * size_of(design):
        return [RuleRemark("no-motion", 0.0, None, "mm", "the follower does not move at all")]
    files = [request for request in recipe.export.files if request.format.contour]
    tolerance = max((request.tolerance or recipe.export.tolerance for request in files), default=0.0)
    remarks = [_share(recipe, "coarse-tolerance", ("the tolerance", tolerance), length)]
    error = recipe.verify.motion_error
    if error is not None:
        error *= arm
        remarks.append(_share(recipe, "loose-motion-error", ("verify.motion_error", error), length))
    return remarks


def _law_error(recipe: Recipe, design: Design) -> RuleRemark | None:
    """A swing that is far from the wanted law, where the recipe does not limit its error."""
    check = next((check for check in design.checks if check.name == LAW.name), None)
    if check is None or check.value is None or any(limit.figure == LAW.name for limit in recipe.limits):
        return None
    swing = math.degrees(_stroke(design)[0])
    if not 0.0 < NEAR * swing < check.value:
        return None
    off = f"the swing is off delta.law by up to {check.value:.4g} deg, {check.value / swing:.3g} times the swing"
    sentence = f"{off}; {MORE_HARMONICS} would be nearer"
    return RuleRemark("wanted-law", check.value, NEAR * swing, "deg", sentence, check.at_deg)


def _implied(recipe: Recipe, design: Design, checks: Sequence[Check], files: Sequence[FileResult]) -> RuleRemark | None:
    """A limit of motion error implied by a file's tolerance that is a good part of the stroke or of the rollers."""
    from kin.judge.limits import direct_play, stroke_of
    from kin.numeric.limits import is_loose

    if recipe.verify.motion_error is not None or not files:
        return None
    tolerances = {file.path.name: file.tolerance for file in files}
    follower, loose = design.exact.gauge, []
    closure = follower.closure
    word = "swing" if follower.unit == "deg" else "stroke"
    # limits of play are compared with the roller's radius, limits of motion with the stroke
    for check in checks:
        tolerance = tolerances.get(check.file or "")
        if not tolerance or check.limit is None:
            continue
        # `direct` is what the tolerance permits at a pressure angle of 0
        direct, radius = follower.direct_limit(tolerance), None
        if closure is not None and check.name == closure.name:
            direct = direct_play(closure, follower, tolerance)
            radius = closure.radius
        elif check.name != MOTION.name:
            continue
        size = partial(stroke_of, follower) if radius is None else partial(float, radius)
        if is_loose(check.limit, direct, size, LOOSE):
            reference = word if radius is None else "roller's radius"
            loose.append((check.limit / size(), check.limit, reference, check))
    if not loose:
        return None
    share, limit, reference, check = max(loose, key=lambda row: row[0])
    unit = check.unit
    amount = _length(recipe, limit) if unit == "mm" else f"{limit:.4g} {unit}"
    sentence = (
        f"the limit of {check.name} that follows from the tolerance, {amount}, is {share:.3g} times the {reference}; "
        "verify.motion_error gives one of your own"
    )
    return RuleRemark("loose-motion-error", limit, LOOSE * limit / share, unit, sentence, check.at_deg)


def _stroke(design: Design) -> tuple[float, float]:
    """Stroke in mm and 1, or swing in rad and the length of the arm, mm."""
    t = np.linspace(0.0, 2.0 * math.pi, LOOKS, endpoint=False)
    return design.motion.stroke(np.sort(np.concatenate([t, design.exact.breaks])))


def _acceleration(recipe: Recipe, joints: tuple[DerivativeJump, ...]) -> RuleRemark | None:
    """The greatest jump of acceleration, which makes an impact; jumps of jerk have no remark."""
    jumps = [(abs(b - a), joint) for joint in joints for k, a, b in joint.jumps if k == 2]
    if not jumps:
        return None
    value, worst = max(jumps, key=lambda row: row[0])
    scale, unit = displacement_unit(recipe)
    sentence = DerivativeJump(worst.at, tuple(jump for jump in worst.jumps if jump[0] == 2)).scaled(scale).said(unit)
    if len(jumps) > 1:
        sentence += f", and at {len(jumps) - 1} other joint{'s' if len(jumps) > 2 else ''} by no more"
    if unit == "deg":
        value *= scale
    return RuleRemark(
        "acceleration-jump", value, 0.0, f"{'deg' if unit == 'deg' else 'mm'}/rad^2", sentence, math.degrees(worst.at)
    )


def _share(recipe: Recipe, name: RemarkName, subject: tuple[str, float], length: float) -> RuleRemark | None:
    """Remark `name` on an error, its words and mm, that is a good part of the stroke `length`, mm; else None."""
    (label, value), rule = subject, SHARE * length
    if value <= rule:
        return None
    sentence = (
        f"{label}, {_length(recipe, value)}, is {value / length:.3g} times the stroke of {_length(recipe, length)}"
    )
    return RuleRemark(name, value, rule, "mm", sentence)


def _output(recipe: Recipe, design: Design) -> list[RuleRemark | None]:
    """Limits of a linkage's error and dwell that are a good part of the output's swing."""
    if design.driven is None or design.driven.figures is None:
        return []
    swing, unit = design.driven.figures.swing, design.driven.mechanism.unit
    scale = math.degrees(1.0) if unit == "deg" else 1.0
    band = None if recipe.dwell is None else recipe.dwell.band
    limits: tuple[tuple[RemarkName, str, float | None], ...] = (
        ("loose-output-error", "verify.output_error", recipe.verify.output_error),
        ("wide-dwell-band", "dwell.band", band),
    )
    remarks: list[RuleRemark | None] = []
    for name, field, value in limits:
        if value is not None and value > SHARE * swing:
            sentence = (
                f"{field} is {value / swing:.3g} times the swing of the output" if swing else f"{field}: no swing"
            )
            remarks.append(RuleRemark(name, value * scale, SHARE * swing * scale, unit, sentence))
    return remarks


def shortened_dwells(driven: DesignedLinkage, files: Sequence[FileResult]) -> tuple[RuleRemark, ...]:
    """A remark on each file whose dwell is clearly shorter than the intended one: a ripple crosses the band's edge."""
    remarks = []
    for file in files:
        for dwell in () if file.linkage is None else file.linkage.dwells[:1]:
            intended = math.degrees(driven.dwells[dwell.over][0].length)
            if dwell.length_deg >= LASTS * intended:
                continue
            sentence = (
                f"{file.path.name}: the output dwells for {dwell.length_deg:.5g} deg of the {intended:.5g} intended, "
                "as a ripple fills the band: give a wider dwell.band or a smaller export.tolerance"
            )
            at_deg = dwell.start_deg if dwell.over == "shaft" else None
            remarks.append(RuleRemark("dwell-shorter", dwell.length_deg, LASTS * intended, "deg", sentence, at_deg))
    return tuple(remarks)


def _shaft(recipe: Recipe, design: Design) -> RuleRemark | None:
    """A shaft outside the contour of a part without a bore; with one the wall is a check."""
    if recipe.part.bore is not None or not design.contours:
        return None
    from camgeo.part.walls import Looks, distance_inside, winds

    distances = []
    for surface, contour in design.contours:
        runs = [np.linspace(run.low, run.high, LOOKS) for run in contour.runs]
        points = contour.sample(np.concatenate(runs)).point
        if winds(points) and np.hypot(points[:, 0], points[:, 1]).min() > CLEAR * surface.curve.size:
            continue  # by far; what is nearer is looked at closely
        distances.append(distance_inside(Looks.of(contour), (0.0, 0.0)))
    distance, parameter = min(distances, default=(math.inf, 0.0))
    if distance > 0.0:
        return None
    sentence = f"the shaft lies outside the contour by {_length(recipe, -distance)}"
    if -distance <= NOISE * size_of(design):
        sentence = "the shaft lies on the contour"
    return RuleRemark("shaft-outside", distance, 0.0, "mm", sentence, design.motion.shaft_deg(parameter))


def _metric(recipe: Recipe) -> list[RuleRemark]:
    """A bore by the inch with a feature of metric standard sizes."""
    bore = recipe.part.bore
    if bore is None:
        return []
    by_inch, metric = _is_whole(bore * STEP / INCH), _is_whole(bore / HALF_MM)
    # a bore is by the inch: in a recipe in inches unless it is a size in mm only, in mm if it is one in inches only
    if not (by_inch or not metric if recipe.units == "inch" else by_inch and not metric):
        return []
    features = with_records(recipe.part.features)
    sizes = [feature.metric(value) for feature, value in features if feature.metric is not None]
    sentences = [f"a bore of {_length(recipe, bore)} takes a {size}" for size in sizes if size]
    return [RuleRemark("metric-keyway", bore, None, "mm", sentence) for sentence in sentences]


def _is_whole(value: float) -> bool:
    return abs(value - round(value)) <= _SAME * max(abs(value), 1.0)


def _thickness(recipe: Recipe, design: Design) -> RuleRemark | None:
    """A disc as thick as a bar or as thin as a foil, mostly through a wrong unit."""
    thickness, size = recipe.part.thickness, size_of(design)
    if thickness is None or not size or THINNEST * size <= thickness <= THICKEST * size:
        return None
    thick = thickness > size
    rule = (THICKEST if thick else THINNEST) * size
    sentence = (
        f"part.thickness, {_length(recipe, thickness)}, is {thickness / size:.3g} times the cam's greatest radius"
    )
    return RuleRemark("thick" if thick else "thin", thickness, rule, "mm", sentence)


def size_of(design: Design) -> float:
    """Greatest distance from the shaft over all surfaces of the exact cam, mm, as `Curve.size` samples it."""
    return max(surface.curve.size for surface in design.exact.surfaces)


def _length(recipe: Recipe, value: float) -> str:
    return f"{value / recipe.mm:.4g} {UNIT_NAMES[recipe.units]}"
