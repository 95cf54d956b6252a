"""Declarations of all checks: name, unit, when a check applies, the recipe's field behind it, its remedy.

The list of expected checks (`camgeo.synthesis.expected_checks`), the list of skipped ones (`camgeo.output.skipped`) and
the texts of failures (`camgeo.report.failure`) are made from them, and the functions that make checks take the names
from here. The judge (kin) knows nothing of recipes: the checks of files that it makes are declared by the same names.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from camgeo.checks import remedies
from camgeo.checks.declaration import Declared
from camgeo.checks.extension import CHECKING, HOLES_OF, Checks
from camgeo.part.features import FEATURES
from camgeo.recipe.figures import (
    BACKLASH,
    CONTACT_TRAVEL,
    FIGURES,
    LAW_ERROR,
    LEAST_WALL,
    OF_LINKAGE,
    PITCH_RADIUS,
    PRESSURE_ANGLE,
    RADIUS,
    VELOCITY_RATIO,
)
from camgeo.recipe.figures import DWELL as LONGEST_DWELL
from camgeo.recipe.figures import FACE_WIDTH as WIDTH
from camgeo.registry.gathered import Gathered
from camgeo.registry.slot import always

if TYPE_CHECKING:
    from camgeo.checks.declaration import CheckFacts, Entry, Exact, OfFile
    from camgeo.part.feature import Feature, FeatureCheck
    from camgeo.recipe.design_figure import DesignFigure
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.recipe import Recipe

STANDS = "the mechanism does not make a full turn: it has no motion over the shaft angle"
LIMIT = "limit:"  # before the name of the figure that a recipe limits


# --- conditions -------------------------------------------------------------------------------------------------------


def _named(name: str) -> Exact:
    """Condition that the follower makes a check of this name on its intended motion."""
    return lambda facts: name in facts.follower.checks


def _dwells(facts: CheckFacts) -> bool:
    dwell = facts.recipe.dwell
    return facts.linked and dwell is not None and dwell.at_least is not None


def _contour(_: CheckFacts, file: FileRequest) -> bool:
    return file.format.contour


def _ground_or_drawn(facts: CheckFacts, file: FileRequest) -> bool:
    return file.form.ground or file.form.curve or _contour(facts, file)


def of_a_drive(file: FileRequest) -> tuple[str, ...]:
    """Names of the checks of a table for a drive, by what its controller makes of the rows; none of other files."""
    from camgeo.files.controllers import CONTROLLERS

    if not file.form.drive:
        return ()
    controller = CONTROLLERS[file.own["for"]]
    rate = "velocity-step" if controller.join == "line" else "interpolation-acceleration"
    stated = ("stated-error",) if controller.stated else ()
    return ("interpolation", "interpolation-velocity", rate, *stated)


def _of_a_drive(name: str) -> OfFile:
    return lambda _, file: name in of_a_drive(file)


def _stated(_: CheckFacts, file: FileRequest) -> bool:
    return file.form.ground or "stated-error" in of_a_drive(file)


def _drawing(_: CheckFacts, file: FileRequest) -> bool:
    return file.format.contour and not file.format.solid


def _solid(facts: CheckFacts, file: FileRequest) -> bool:
    return _contour(facts, file) and file.format.solid


def _reached(facts: CheckFacts, file: FileRequest) -> bool:
    manufacture = facts.recipe.manufacture
    is_drawn = file.format.path and file.compensation is None and manufacture is not None and manufacture.layer
    return is_drawn or file.format.program


def _ringed(facts: CheckFacts, file: FileRequest) -> bool:
    return facts.recipe.part.outer is not None and _contour(facts, file) and not file.format.program


def _bored(facts: CheckFacts, file: FileRequest) -> bool:
    return facts.recipe.part.bore is not None and _contour(facts, file) and HOLES_OF[file.kind].bored(facts.recipe)


def _drilled(facts: CheckFacts, file: FileRequest) -> bool:
    return _contour(facts, file) and HOLES_OF[file.kind].drilled(facts.recipe)


def _shaped(facts: CheckFacts, file: FileRequest) -> bool:
    return _contour(facts, file) and not file.format.program


def _in_a_yoke(facts: CheckFacts, file: FileRequest) -> bool:
    return facts.yoke and facts.follower.closure != "form-closure" and _contour(facts, file)


def _form_closed(facts: CheckFacts, file: FileRequest) -> bool:
    return facts.follower.closure == "form-closure" and _contour(facts, file)


def _driven(facts: CheckFacts, file: FileRequest) -> bool:
    return facts.linked and _contour(facts, file) and file.compensation is None


def _dwelling(facts: CheckFacts, file: FileRequest) -> bool:
    return _dwells(facts) and _driven(facts, file)


def run_with(facts: CheckFacts, file: FileRequest) -> bool:
    """Whether the motion of a file drives a computed run, as of dynamics.

    It does where the file shows the part itself, uncompensated, and the recipe has no linkage.
    """
    return not facts.linked and file.format.part and file.compensation is None


# --- why a check is not made ------------------------------------------------------------------------------------------


def _no_swing(facts: CheckFacts) -> str:
    return "" if facts.swings else "the follower does not oscillate"


def _no_roller(facts: CheckFacts) -> str:
    return "" if facts.roller else "a flat face is pushed along its normal"


def _one_face(facts: CheckFacts) -> str:
    single = not (facts.yoke or facts.swings or facts.follower.closure)  # the others have a check of their play
    return "the breadth is not constant: a single flat face follows" if single else ""


def _no_dwell(facts: CheckFacts) -> str:
    return "dwell is not given" if facts.linked and facts.turns and facts.recipe.dwell is None else ""


def _output_lost(facts: CheckFacts) -> str:
    if facts.linked and not facts.turns:
        return STANDS
    lost = facts.linked and facts.trimmed and facts.recipe.verify.output_error is None
    return "the contour is trimmed and verify.output_error is not given: reported, not judged" if lost else ""


def _motion_lost(facts: CheckFacts) -> str:
    lost = facts.trimmed and facts.recipe.verify.motion_error is None
    return "the contour is trimmed and verify.motion_error is not given: reported, not judged" if lost else ""


# --- the checks: of the motion and the curve --------------------------------------------------------------------------

CURVATURE = Declared(RADIUS, ("mm",), lambda facts: not facts.roller, remedy=remedies.rounder, strict=True)
PITCH = Declared(PITCH_RADIUS, ("mm",), lambda facts: facts.roller, remedy=remedies.rounder, strict=True)
BENT = frozenset({CURVATURE.name, PITCH.name})  # a cam has either: it checks the curve whose curvature causes undercut
UNDERCUT_LOCAL = Declared("undercut-local", ("mm",), always(True))
UNDERCUT_GLOBAL = Declared(
    "undercut-global",
    ("mm",),
    lambda facts: facts.roller,
    why_not=lambda facts: "" if facts.roller else "a convex profile does not intersect itself",
    field="cam.roller_radius",
)
CLOSING = Declared("closing-equation", ("mm",), _named("closing-equation"), why_not=_no_swing)
RATIO = Declared(
    VELOCITY_RATIO,
    ("",),
    _named(VELOCITY_RATIO),
    why_not=_no_swing,
    remedy=remedies.smaller_swing,
    strict_at=(1.0,),
)
LAW = Declared(LAW_ERROR, ("deg",), _named(LAW_ERROR), field="cam.delta.harmonics", remedy=remedies.more_harmonics)
PRESSURE = Declared(
    PRESSURE_ANGLE,
    ("deg",),
    _named(PRESSURE_ANGLE),
    why_not=_no_roller,
    remedy=remedies.smaller_swing,
    strict_at=(90.0,),
)
BREADTH = Declared(
    "constant-breadth",
    ("mm",),
    _named("constant-breadth"),
    _in_a_yoke,
    why_not=_one_face,
    backlash=True,
    in_frame=True,
)
DIAMETER = Declared("constant-diameter", ("mm",), _named("constant-diameter"))
TRAVEL = Declared(
    CONTACT_TRAVEL,
    ("mm",),
    _named(CONTACT_TRAVEL),
    why_not=lambda facts: "the follower has no plate that moves along its normal" if facts.swings else "",
)
FACE_WIDTH = Declared(WIDTH, ("mm",), _named(WIDTH), field="cam.follower.width", remedy=remedies.wider_face)
WHEEL = Declared(
    "grinding-wheel",
    ("mm",),
    lambda facts: facts.recipe.wheel is not None,
    field="manufacture.wheel",
    remedy=remedies.smaller_wheel,
)
MOBILITY = Declared("mobility", ("mm",), lambda facts: facts.linked, field="linkage", strict_at=(0.0,))
REVERSAL = Declared("reversal", ("",), lambda facts: facts.linked, field="linkage", strict_at=(0.0,))
DWELL = Declared(
    LONGEST_DWELL,
    ("deg",),
    _dwells,
    _dwelling,
    why_not=_no_dwell,
    field="dwell.at_least",
    remedy=remedies.shorter_dwell,
)
WALL = Declared(
    LEAST_WALL,
    ("mm",),
    lambda facts: facts.recipe.part.walled,
    field="part.bore",
    own_field="part.outer",
    remedy=remedies.smaller_bore,
    strict_at=(0.0,),
)

# --- of files ---------------------------------------------------------------------------------------------------------

READABLE = Declared("readable", ("",))  # made only where it fails
REACH = Declared("cutter-reach", ("mm",), of_file=_reached)
UNITS = Declared("units", ("",), of_file=_drawing, field="units")
CLOSED = Declared("closed", ("", "faults"), of_file=_drawing)
WATERTIGHT = Declared("watertight", ("", "faults"), of_file=_solid)
BORE = Declared(
    "bore",
    ("mm",),
    of_file=_bored,
    why_not=lambda facts: "part.bore is not given" if facts.recipe.part.bore is None else "",
    field="part.bore",
)
OUTER = Declared("outer", ("mm",), of_file=_ringed, field="part.outer")
HOLES = Declared("holes", ("mm",), of_file=_drilled, field="part")
THICKNESS = Declared("thickness", ("mm",), of_file=_solid, field="part.thickness")
VOLUME = Declared("volume", ("mm^3",), of_file=_solid)
CONTOUR = Declared("contour", ("mm",), of_file=_ground_or_drawn, field="export.tolerance", in_frame=True)
HEAD = Declared("head", ("faults",), of_file=lambda _, file: file.form.ground)
NORMALS = Declared(
    "normals", ("mm",), of_file=lambda _, file: file.form.ground and "roller" not in file.own, field="export.tolerance"
)
STATED_ERROR = Declared("stated-error", ("mm", "deg"), of_file=_stated)
INTERPOLATION = Declared(
    "interpolation",
    ("mm", "deg"),
    of_file=_of_a_drive("interpolation"),
    field="export.tolerance",
    own_field="verify.motion_error",
)
INTERPOLATED_VELOCITY = Declared(
    "interpolation-velocity",
    ("mm/deg", "deg/deg"),
    of_file=_of_a_drive("interpolation-velocity"),
    field="export.tolerance",
)
INTERPOLATED_ACCELERATION = Declared(
    "interpolation-acceleration",
    ("mm/deg^2", "deg/deg^2"),
    of_file=_of_a_drive("interpolation-acceleration"),
    field="export.tolerance",
)
VELOCITY_STEP = Declared(
    "velocity-step",
    ("mm/deg", "deg/deg"),
    of_file=_of_a_drive("velocity-step"),
    field="export.tolerance",
)
MOTION = Declared(
    "motion",
    ("mm", "deg"),
    of_file=_ground_or_drawn,
    why_not=_motion_lost,
    field="export.tolerance",
    own_field="verify.motion_error",
    remedy=remedies.nearer,
    in_frame=True,
)
BREADTH_MAX = Declared("breadth-max", ("mm",), of_file=_in_a_yoke, backlash=True, in_frame=True)
FORM_CLOSURE = Declared(
    "form-closure",
    ("mm", "deg"),
    of_file=_form_closed,
    field="export.tolerance",
    own_field="verify.motion_error",
    remedy=remedies.looser,
    backlash=True,
    between=True,
)
OUTPUT = Declared(
    "linkage-error",
    ("mm", "deg"),
    of_file=_driven,
    why_not=_output_lost,
    field="export.tolerance",
    own_field="verify.output_error",
)

# by the word for the files in which a feature is checked: condition, and the check behind which its check stands
_FILES: dict[str, tuple[OfFile | None, str]] = {
    "none": (None, WALL.name),
    "all": (_shaped, HOLES.name),
    "solids": (_solid, THICKNESS.name),
}


def _of_feature(feature: Feature[Any], check: FeatureCheck) -> Declared:
    """Declaration of the check of a feature, which is made where the part has the feature."""
    condition, after = _FILES[check.files]

    def exact(facts: CheckFacts) -> bool:
        return facts.recipe.part.of(feature.kind) is not None

    def of_file(facts: CheckFacts, file: FileRequest) -> bool:
        return condition is not None and condition(facts, file) and exact(facts)

    def remedy(entry: Entry, _report: Entry, _recipe: Recipe) -> str:
        return "" if check.remedy is None else check.remedy(entry)

    return Declared(
        check.name,
        (check.unit,),
        exact if check.exact else None,
        None if condition is None else of_file,
        field=f"part.{feature.name}",
        remedy=None if check.remedy is None else remedy,
        strict=check.strict,
        after=after,
    )


OF_FEATURES = tuple(_of_feature(feature, feature.judged) for feature in FEATURES if feature.judged is not None)
_CORE = {
    declared.name: declared
    for own in tuple(globals().values())
    if isinstance(own, Declared)
    for declared in (own, *(check for check in OF_FEATURES if check.after == own.name))
}
LAST_EXACT = list(_CORE)[list(_CORE).index(READABLE.name) - 1]
"""Name of the core's last check of the exact cam."""
CHECKS: Gathered[Checks, Declared] = Gathered(
    _CORE, CHECKING, lambda answers: {check.name: check for check in answers.checks}
)
"""Every check but the limits of a recipe's own, by name, in the order in which they are foreseen."""
OF_OTHERS: Gathered[Checks, Declared] = Gathered(
    {}, CHECKING, lambda answers: {check.name: check for check in answers.others}
)
"""Checks of other kinds of cams, by name."""


# --- limits -----------------------------------------------------------------------------------------------------------


@cache
def _of_figure(name: str, figure: DesignFigure) -> Declared:
    """Declaration of the limit of a figure, which applies where the recipe gives the limit."""

    def of_design(facts: CheckFacts) -> bool:
        return figure.of != "file" and any(limit.figure == name for limit in facts.recipe.limits)

    def of_file(facts: CheckFacts, file: FileRequest) -> bool:
        if not any(limit.figure == name for limit in facts.recipe.limits):
            return False
        if figure.of == "run":
            return run_with(facts, file)
        if figure.of == "file":
            return _driven(facts, file) if figure.needs is OF_LINKAGE else _contour(facts, file)
        return False

    # without a remedy: the detail of the check has it
    between = name == BACKLASH
    return Declared(LIMIT + name, (), of_design, of_file, field=f"limits.{name}", between=between)


def declaration(name: str) -> Declared | None:
    """Declaration of a check or a limit by its name; None where there is none."""
    if not name.startswith(LIMIT):
        return CHECKS.get(name) or OF_OTHERS.get(name)
    figure = FIGURES.get(name.removeprefix(LIMIT))
    return None if figure is None else _of_figure(name.removeprefix(LIMIT), figure)


def declarations(recipe: Recipe | None = None) -> list[Declared]:
    """Declarations of the checks of a recipe, then of its limits of figures; without a recipe, of all there are."""
    if recipe is None:
        return [*CHECKS.values(), *(_of_figure(name, figure) for name, figure in FIGURES.items())]
    bounded = {limit.figure for limit in recipe.limits}
    limits = [_of_figure(name, figure) for name, figure in FIGURES.items() if name in bounded] if bounded else []
    return [*CHECKS.among(recipe.uses).values(), *limits]
