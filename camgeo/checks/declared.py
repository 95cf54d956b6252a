"""Declarations of all checks: name, unit, when a check applies, the recipe's field behind it, its remedy.

The list of expected checks (`camgeo.synthesis.expected_checks`), the list of skipped ones (`camgeo.output.skipped`) and
the texts of failures (`camgeo.report.failure`) are made from them, and the functions that make checks take the names
from here. The judge (kin) knows nothing of recipes: the checks of files that it makes are declared by the same names.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, TypeAlias

from camgeo.checks import remedies
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
from camgeo.registry.capability import always
from camgeo.registry.gathered import Gathered
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.cams.follower import Follower
    from camgeo.part.feature import Feature, FeatureCheck
    from camgeo.recipe.export import FileRequest
    from camgeo.recipe.figures import DesignFigure
    from camgeo.recipe.recipe import Recipe

STANDS = "the mechanism does not make a full turn: it has no motion over the shaft angle"
LIMIT = "limit:"  # before the name of the figure that a recipe limits


@dataclass(frozen=True)
class CheckFacts:
    """Facts that decide which checks are made: the recipe and the follower of its motion.

    In a run `trimmed` is whether an undercut of the contour is trimmed, `turns` whether the linkage turns right round,
    True without one.
    """

    recipe: Recipe
    follower: Follower
    trimmed: bool = False
    turns: bool = True

    @property
    def roller(self) -> bool:
        """Whether the follower touches the cam with a radius: a roller or a curved shoe."""
        return self.recipe.cam.touch.radius > 0.0

    @property
    def yoke(self) -> bool:
        """Whether two parallel faces hold the cam."""
        return self.follower.breadth is not None

    @property
    def swings(self) -> bool:
        """Whether the follower swings: its position is an angle, not a length."""
        return self.recipe.cam.arrangement.unit == "deg"

    @property
    def linked(self) -> bool:
        """Whether the recipe has a linkage."""
        return self.recipe.linkage is not None


Exact: TypeAlias = "Callable[[CheckFacts], bool]"
OfFile: TypeAlias = "Callable[[CheckFacts, FileRequest], bool]"


@dataclass(frozen=True)
class Declared:
    """Declaration of one check.

    units      units that it may have, lengths as mm
    exact      whether it is made for the exact cam, its motion and mechanism; None: never
    of_file    whether it is made for a file; None: never
    why_not    reason why it is not made, for the report; empty where it is made or no reason is reported
    field      path of the recipe's field that influences it most; `own_field` replaces it where the recipe has that
    remedy     sentence on a change that would let it hold, empty where none is known; None: there is none, or the
               detail of the check has it
    backlash   whether it concerns the play between contour and follower
    between    whether it is made once for a pair of discs, with the last of their files
    in_frame   whether with a linkage it concerns the cam in its frame, so that its place is the relative angle
    strict     whether a figure equal to its limit fails; `strict_at` are the limits at which it fails in any case
    after      check behind which the check of a capability or of a feature stands
    """

    name: str
    units: tuple[str, ...]
    exact: Exact | None = None
    of_file: OfFile | None = None
    why_not: Callable[[CheckFacts], str] | None = None
    field: str = ""
    own_field: str = ""
    remedy: remedies.Remedy | None = None
    backlash: bool = False
    between: bool = False
    in_frame: bool = False
    strict: bool = False
    strict_at: tuple[float, ...] = ()
    after: str = ""

    def place(self, recipe: Recipe, file: str | None) -> str:
        """Path of the recipe's field that influences the check most.

        `file` is the name of the checked file, None for a check of the exact cam.
        """
        section, _, name = self.own_field.partition(".")
        if name and getattr(getattr(recipe, section), name) is not None:
            return self.own_field
        return self.field or ("export.files" if file else "cam")


# --- conditions -------------------------------------------------------------------------------------------------------


def _named(name: str) -> Exact:
    """Condition that the follower makes a check of this name on its intended motion."""
    return lambda scene: name in scene.follower.checks


def _dwells(scene: CheckFacts) -> bool:
    dwell = scene.recipe.dwell
    return scene.linked and dwell is not None and dwell.at_least is not None


def _contour(_: CheckFacts, file: FileRequest) -> bool:
    return file.format.contour


def _ground_or_drawn(scene: CheckFacts, file: FileRequest) -> bool:
    return file.form.ground or file.form.curve or _contour(scene, file)


def _of_a_drive(_: CheckFacts, file: FileRequest) -> bool:
    return file.as_ == "controller"


def _stated(scene: CheckFacts, file: FileRequest) -> bool:
    return file.form.ground or _of_a_drive(scene, file)


def _drawing(_: CheckFacts, file: FileRequest) -> bool:
    return file.format.contour and not file.format.solid


def _solid(scene: CheckFacts, file: FileRequest) -> bool:
    return _contour(scene, file) and file.format.solid


def _reached(scene: CheckFacts, file: FileRequest) -> bool:
    manufacture = scene.recipe.manufacture
    is_drawn = file.format.path and file.compensation is None and manufacture is not None and manufacture.layer
    return is_drawn or file.format.program


def _ringed(scene: CheckFacts, file: FileRequest) -> bool:
    return scene.recipe.part.outer is not None and _contour(scene, file) and not file.format.program


def _bored(scene: CheckFacts, file: FileRequest) -> bool:
    return scene.recipe.part.bore is not None and _contour(scene, file) and file.format.bored(scene.recipe)


def _drilled(scene: CheckFacts, file: FileRequest) -> bool:
    return _contour(scene, file) and file.format.drilled(scene.recipe)


def _shaped(scene: CheckFacts, file: FileRequest) -> bool:
    return _contour(scene, file) and not file.format.program


def _in_a_yoke(scene: CheckFacts, file: FileRequest) -> bool:
    return scene.yoke and scene.follower.closure != "form-closure" and _contour(scene, file)


def _form_closed(scene: CheckFacts, file: FileRequest) -> bool:
    return scene.follower.closure == "form-closure" and _contour(scene, file)


def _driven(scene: CheckFacts, file: FileRequest) -> bool:
    return scene.linked and _contour(scene, file) and file.compensation is None


def _dwelling(scene: CheckFacts, file: FileRequest) -> bool:
    return _dwells(scene) and _driven(scene, file)


def run_with(scene: CheckFacts, file: FileRequest) -> bool:
    """Whether the motion of a file drives a computed run, as of dynamics.

    It does where the file shows the part itself, uncompensated, and the recipe has no linkage.
    """
    return not scene.linked and file.format.part and file.compensation is None


# --- why a check is not made ------------------------------------------------------------------------------------------


def _no_swing(scene: CheckFacts) -> str:
    return "" if scene.swings else "the follower does not oscillate"


def _no_roller(scene: CheckFacts) -> str:
    return "" if scene.roller else "a flat face is pushed along its normal"


def _one_face(scene: CheckFacts) -> str:
    single = not (scene.yoke or scene.swings or scene.follower.closure)  # the others have a check of their play
    return "the breadth is not constant: a single flat face follows" if single else ""


def _no_dwell(scene: CheckFacts) -> str:
    return "dwell is not given" if scene.linked and scene.turns and scene.recipe.dwell is None else ""


def _output_lost(scene: CheckFacts) -> str:
    if scene.linked and not scene.turns:
        return STANDS
    lost = scene.linked and scene.trimmed and scene.recipe.verify.output_error is None
    return "the contour is trimmed and verify.output_error is not given: reported, not judged" if lost else ""


def _motion_lost(scene: CheckFacts) -> str:
    lost = scene.trimmed and scene.recipe.verify.motion_error is None
    return "the contour is trimmed and verify.motion_error is not given: reported, not judged" if lost else ""


# --- the checks: of the motion and the curve --------------------------------------------------------------------------

CURVATURE = Declared(RADIUS, ("mm",), lambda scene: not scene.roller, remedy=remedies.rounder, strict=True)
PITCH = Declared(PITCH_RADIUS, ("mm",), lambda scene: scene.roller, remedy=remedies.rounder, strict=True)
BENT = frozenset({CURVATURE.name, PITCH.name})  # a cam has either: it checks the curve whose curvature causes undercut
UNDERCUT_LOCAL = Declared("undercut-local", ("mm",), always(True))
UNDERCUT_GLOBAL = Declared(
    "undercut-global",
    ("mm",),
    lambda scene: scene.roller,
    why_not=lambda scene: "" if scene.roller else "a convex profile does not intersect itself",
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
    why_not=lambda scene: "the follower has no plate that moves along its normal" if scene.swings else "",
)
FACE_WIDTH = Declared(WIDTH, ("mm",), _named(WIDTH), field="cam.follower.width", remedy=remedies.wider_face)
WHEEL = Declared(
    "grinding-wheel",
    ("mm",),
    lambda scene: scene.recipe.wheel is not None,
    field="manufacture.wheel",
    remedy=remedies.smaller_wheel,
)
MOBILITY = Declared("mobility", ("mm",), lambda scene: scene.linked, field="linkage", strict_at=(0.0,))
REVERSAL = Declared("reversal", ("",), lambda scene: scene.linked, field="linkage", strict_at=(0.0,))
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
    lambda scene: scene.recipe.part.walled,
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
    why_not=lambda scene: "part.bore is not given" if scene.recipe.part.bore is None else "",
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
    of_file=_of_a_drive,
    field="export.tolerance",
    own_field="verify.motion_error",
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

    def exact(scene: CheckFacts) -> bool:
        return scene.recipe.part.of(feature.kind) is not None

    def of_file(scene: CheckFacts, file: FileRequest) -> bool:
        return condition is not None and condition(scene, file) and exact(scene)

    return Declared(
        check.name,
        (check.unit,),
        exact if check.exact else None,
        None if condition is None else of_file,
        field=f"part.{feature.name}",
        remedy=check.remedy,
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
CHECKS: Gathered[Declared] = Gathered(_CORE, lambda capability: {check.name: check for check in capability.checks()})
"""Every check but the limits of a recipe's own, by name, in the order in which they are foreseen."""


# --- limits -----------------------------------------------------------------------------------------------------------


@cache
def _of_figure(name: str, figure: DesignFigure) -> Declared:
    """Declaration of the limit of a figure, which applies where the recipe gives the limit."""

    def of_design(scene: CheckFacts) -> bool:
        return figure.of != "file" and any(limit.figure == name for limit in scene.recipe.limits)

    def of_file(scene: CheckFacts, file: FileRequest) -> bool:
        if not any(limit.figure == name for limit in scene.recipe.limits):
            return False
        if figure.of == "run":
            return run_with(scene, file)
        if figure.of == "file":
            return _driven(scene, file) if figure.needs is OF_LINKAGE else _contour(scene, file)
        return False

    # without a remedy: the detail of the check has it
    between = name == BACKLASH
    return Declared(LIMIT + name, (), of_design, of_file, field=f"limits.{name}", between=between)


def declaration(name: str) -> Declared | None:
    """Declaration of a check or a limit by its name; None where there is none."""
    if not name.startswith(LIMIT):
        return CHECKS.get(name)
    figure = FIGURES.get(name.removeprefix(LIMIT))
    return None if figure is None else _of_figure(name.removeprefix(LIMIT), figure)


def declarations(recipe: Recipe | None = None) -> list[Declared]:
    """Declarations of the checks of a recipe, then of its limits of figures; without a recipe, of all there are."""
    if recipe is None:
        return [*CHECKS.values(), *(_of_figure(name, figure) for name, figure in FIGURES.items())]
    bounded = {limit.figure for limit in recipe.limits}
    limits = [_of_figure(name, figure) for name, figure in FIGURES.items() if name in bounded] if bounded else []
    return [*CHECKS.among(recipe.uses).values(), *limits]
