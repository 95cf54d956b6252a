"""Values of the figures of a design and its files, in mm and degrees, each with the shaft angle of its place."""

from __future__ import annotations

import math
from functools import partial
from itertools import starmap
from typing import TYPE_CHECKING

from camgeo.checks.declared import CHECKS, LAW, PRESSURE, RATIO, STANDS, TRAVEL, WALL
from camgeo.measures.extension import MEASURES
from camgeo.measures.measured import ABRUPT, Measured
from camgeo.recipe import figures
from camgeo.recipe.design_figure import NOTHING
from camgeo.recipe.figures import FIGURES
from camgeo.synthesis.checks import hollow_radius, needed_width
from kin.judge.verdict import UNREAD
from kin.numeric.angles import TURN, degrees

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.measures.balance import Balance
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design, SurfaceDesign
    from camgeo.synthesis.linkage import DesignedLinkage
    from kin.follower.motion_error import Play
    from kin.judge.verdict import SurfaceVerdict
    from kin.linkage.extremes import ExtremePlace
    from kin.numeric.check import Check

_SHARE = 1e-12  # of the greatest value, to which a motion is followed
ORDERS = {"swing": 0, **{name: k for k, name in enumerate(figures.PEAKS, 1)}}
_OF_CHECKS = {check.name for check in (PRESSURE, RATIO, LAW, TRAVEL, WALL)}
NO_CONTOUR = Measured(None, "mm", detail="no contour is made")


def _least(values: Iterable[Measured]) -> Measured:
    """The least figure of several surfaces, `NO_CONTOUR` of none; one without a value comes first."""
    return min(values, key=lambda figure: -math.inf if figure.value is None else figure.value, default=NO_CONTOUR)


def _greatest(values: Iterable[Measured]) -> Measured:
    """The greatest figure of several surfaces, `NO_CONTOUR` of none; one without a value comes first."""
    return max(values, key=lambda figure: math.inf if figure.value is None else figure.value, default=NO_CONTOUR)


def design_figures(
    recipe: Recipe,
    design: Design,
    checks: Sequence[Check],
    names: Iterable[str],
    speeds: Mapping[str, float] | None = None,
) -> dict[str, Measured]:
    """Measure the named figures of the exact cam, its motion and mechanism, by name in the order of `names`.

    `checks` are all checks of the run; a figure that a check measures is left out without that check, but the pressure
    angle is then 0, as of a flat face. `speeds` has the speed, turns a minute, of each figure whose limit states one.
    Names of other figures are passed over. Raises RecipeErrors where a capability cannot measure its figures,
    CurveError where a figure of the contour cannot be proved, KeyError for a name of no figure.
    """
    wanted = [name for name in names if FIGURES[name].of == "design"]
    measured: dict[str, Measured] = {}
    owned: dict[str, list[str]] = {}
    for name in wanted:
        if owner := FIGURES.owner(name):
            owned.setdefault(owner, []).append(name)
    for owner, own in owned.items():
        measured |= MEASURES[owner].measure(recipe, design, own, speeds or {})
    motion = [name for name in wanted if name in ORDERS]
    if design.driven is not None:
        measured |= _linkage_figures(design.driven, wanted)
    elif motion:
        measured |= motion_figures(design, max(ORDERS[name] for name in motion))
    for name in wanted:
        if name in _OF_CHECKS or (FIGURES.owner(name) and name in CHECKS):
            same = [check for check in checks if check.name == name and check.file is None]
            if same:
                measured[name] = figure_of_check(max(same, key=_nearness))
            elif name == PRESSURE.name:
                measured[name] = Measured(0.0, "deg", detail="a flat face is pushed along its normal")
        elif name in _OF_CURVE:
            measured[name] = _OF_CURVE[name](recipe, design)
    return {name: measured[name] for name in wanted if name in measured}


def _nearness(check: Check) -> float:
    """A number that is greater the nearer the value of a check is to its limit; infinite without a value."""
    if check.value is None:
        return math.inf
    return -check.value if check.sense == "at_least" else check.value


def figure_of_check(check: Check) -> Measured:
    """The figure that a check compares with its limit; without a value it has the check's detail as reason."""
    detail = "" if check.value is not None else check.detail
    return Measured(check.value, check.unit, check.at, detail, check.surface, check.at_unit)


# --- of the curve -----------------------------------------------------------------------------------------------------


def _radius(_: Recipe, design: Design) -> Measured:
    """Least radius of the contour: the pitch curve's radius less the roller's."""

    def metal(surface: SurfaceDesign) -> Measured:
        value = None if surface.bent.value is None else surface.bent.value - surface.surface.radius
        return Measured(value, "mm", surface.bent.at_deg, surface.bent.detail, surface.surface.name)

    return _least(map(metal, design.surfaces))


def _pitch_radius(_: Recipe, design: Design) -> Measured:
    """Least radius of the pitch curve where the cam may undercut; in a ring the least radius of its hollows."""
    return _least(figure_of_check(surface.bent) for surface in design.surfaces)


def _hollow_radius(_: Recipe, design: Design) -> Measured:
    def hollow(surface: Surface, contour: Curve) -> Measured:
        radius, place = hollow_radius(surface.side, contour)
        if math.isinf(radius):
            return Measured(radius, "mm", detail="the contour has no concave part", surface=surface.name)
        return Measured(radius, "mm", design.motion.shaft_deg(place), surface=surface.name)

    return _least(starmap(hollow, design.contours))


def _size(_: Recipe, design: Design) -> Measured:
    from camgeo.curve.measures import farthest

    def reach(surface: Surface, contour: Curve) -> Measured:
        far = farthest(contour)
        return Measured(far.value + far.slack, "mm", design.motion.shaft_deg(far.at), surface=surface.name)

    return _greatest(starmap(reach, design.contours))


def _pivot_clearance(recipe: Recipe, design: Design) -> Measured:
    """Distance of the disc from the circle on which the pivot goes round the cam, inside the opening of a ring."""
    from camgeo.curve.measures import farthest, nearest

    pivot = design.follower.pivot
    within = all(surface.side < 0 for surface, _ in design.contours)

    def beside(surface: Surface, contour: Curve) -> Measured:
        end = nearest(contour) if within else farthest(contour)
        value = (end.value - pivot if within else pivot - end.value) - end.slack
        return Measured(value, "mm", design.motion.shaft_deg(end.at), surface=surface.name)

    least = _least(starmap(beside, design.contours))
    # a disc with an outer diameter, as about a groove, ends there and not at its contours
    return least if within or recipe.part.outer is None else Measured(pivot - 0.5 * recipe.part.outer, "mm")


def _flank_pressure(flank: int, _: Recipe, design: Design) -> Measured:
    """Greatest pressure angle on the follower's rise (0) or return (1)."""

    def steepest(surface: Surface) -> Measured:
        flanks = design.exact.steepest(surface)
        if flanks is None:
            raise TypeError("no slope is known of this follower")
        slope = flanks[flank]
        return Measured(math.degrees(math.atan(slope.value + slope.slack)), "deg", degrees(slope.at), "", surface.name)

    return _greatest(map(steepest, design.exact.surfaces))


def _roller_speed(_: Recipe, design: Design) -> Measured:
    def spin(surface: Surface) -> Measured:
        extremes = surface.extremes("spin")
        if extremes is None:
            raise TypeError("no spin is known of this follower")
        fastest = max(extremes, key=lambda extreme: abs(extreme.value))
        return Measured(abs(fastest.value) + fastest.slack, "", degrees(fastest.at), surface=surface.name)

    return _greatest(map(spin, design.exact.surfaces))


def _face_width(_: Recipe, design: Design) -> Measured:
    widths = ((surface.name, *needed_width(surface)) for surface in design.exact.surfaces)
    return _greatest(Measured(value, "mm", at_deg, surface=name) for name, value, at_deg in widths)


def _preload_force(rank: int, _: Recipe, design: Design) -> Measured:
    """Least (`rank` 0) or greatest (1) force of a preload, N; N m for a follower that swings."""
    from camgeo.measures.forces import preload_force
    from kin.numeric.monotone import RoughError

    unit = "N m" if design.motion.unit == "deg" else "N"
    preload = design.exact.preload
    if preload is None or preload.stiffness is None:
        return Measured(None, unit, detail="the preload has no stiffness")
    try:
        value, at_deg = preload_force(design, preload)[rank]
    except RoughError:
        return Measured(None, unit, detail=ABRUPT)
    return Measured(value, unit, at_deg)


def _mass_property(value: Callable[[Balance], float], unit: str, recipe: Recipe, design: Design) -> Measured:
    """Greatest value of a mass property over the discs."""
    from camgeo.measures.balance import balances_of

    balances = balances_of(recipe, design)
    if not balances:
        return Measured(None, unit, detail="the part is no single body")
    detail = f"without the {', '.join(balances[0].without)}" if balances[0].without else ""
    return _greatest(Measured(value(disc), unit, detail=detail, surface=disc.surface) for disc in balances)


def _lobe_figure(name: str, recipe: Recipe, design: Design) -> Measured:
    from camgeo.measures.lobe import lobe_figure

    lift = next((limit.lift for limit in recipe.limits if limit.figure == name), FIGURES[name].at_lift or 0.0)
    return lobe_figure(name, design.exact, lift)


_OF_CURVE: dict[str, Callable[[Recipe, Design], Measured]] = {
    figures.RADIUS: _radius,
    figures.PITCH_RADIUS: _pitch_radius,
    figures.HOLLOW_RADIUS: _hollow_radius,
    figures.SIZE: _size,
    figures.BASE_RADIUS: lambda recipe, _: Measured(recipe.cam.circles()[0].radius, "mm"),
    figures.OFFSET: lambda _, design: Measured(design.follower.offset, "mm"),
    figures.PIVOT: lambda _, design: Measured(design.follower.pivot, "mm"),
    figures.ON_RISE: partial(_flank_pressure, 0),
    figures.ON_RETURN: partial(_flank_pressure, 1),
    figures.PIVOT_CLEARANCE: _pivot_clearance,
    figures.ROLLER_SPEED: _roller_speed,
    figures.FACE_WIDTH: _face_width,
    figures.PRELOAD_LEAST: partial(_preload_force, 0),
    figures.PRELOAD_GREATEST: partial(_preload_force, 1),
    figures.MASS: partial(_mass_property, lambda disc: disc.mass, "kg"),
    figures.ECCENTRICITY: partial(_mass_property, lambda disc: disc.eccentricity, "mm"),
    figures.INERTIA: partial(_mass_property, lambda disc: disc.inertia, "kg mm^2"),
    figures.UNBALANCE: partial(_mass_property, lambda disc: disc.unbalance, "kg mm"),
    **{
        name: partial(_lobe_figure, name)
        for name in (figures.DURATION, figures.LOBE_CENTRE, figures.RAMP_VELOCITY, figures.LIFT_AREA)
    },
}


# --- of the motion ----------------------------------------------------------------------------------------------------


def motion_figures(design: Design, order: int) -> dict[str, Measured]:
    """Stroke or swing of the follower, and greatest magnitudes of its derivatives by the shaft angle up to `order`.

    `order` is 0 to 3. Figures are in mm or degrees, per radian of the shaft; they have no value where the motion is too
    abrupt to be resolved.
    """
    from kin.numeric.monotone import RoughError, between, cells, pieces

    position = design.motion
    unit, scale = position.unit, position.factor(1.0)
    names = [name for name, k in ORDERS.items() if k <= order]
    try:
        motion_cells = cells(
            lambda t: position.by_parameter(t, order), between(0.0, TURN, design.exact.breaks.tolist()), share=_SHARE
        )
    except RoughError:
        return {name: Measured(None, unit + FIGURES[name].per, detail=ABRUPT) for name in names}
    measured: dict[str, Measured] = {}
    for name in names:
        row = pieces(motion_cells, ORDERS[name])
        low, high = row.least(), row.greatest()
        if name == "swing":
            measured[name] = Measured(scale * (high[0] - low[0]), unit)
            continue
        value, parameter = max(low, high, key=lambda place: abs(place[0]))
        measured[name] = Measured(scale * abs(value), unit + FIGURES[name].per, position.shaft_deg(parameter % TURN))
    return measured


def _linkage_figures(driven: DesignedLinkage, names: Iterable[str]) -> dict[str, Measured]:
    """Figures of a linkage: its margin and least shaft rate, and figures of its motion where it turns right round.

    Otherwise figures of `names` that a linkage has come without a value.
    """
    mobility, unit = driven.mechanism.mobility(), driven.mechanism.unit
    scale = math.degrees(1.0) if unit == "deg" else 1.0
    measured = {
        figures.MARGIN: Measured(mobility.margin, "mm"),
        figures.SHAFT_RATE: Measured(
            None if math.isnan(mobility.least_rate) else mobility.least_rate, "", detail=STANDS
        ),
    }
    if driven.figures is None:
        needs = (NOTHING, figures.OF_DWELL, figures.OF_LINKAGE)
        standing = (name for name in names if FIGURES[name].needs in needs and name not in {*measured, *_OF_CURVE})
        return measured | {name: Measured(None, "", detail=STANDS) for name in standing}

    def placed(place: ExtremePlace, factor: float, unit: str) -> Measured:
        return Measured(abs(place.value) * factor, unit, math.degrees(place.shaft))

    motion, turn = driven.figures, math.degrees(1.0)
    measured |= {
        "swing": Measured(motion.swing * scale, unit),
        figures.PEAKS[0]: placed(motion.velocity, scale, f"{unit}/rad"),
        figures.PEAKS[1]: placed(motion.acceleration, scale, f"{unit}/rad^2"),
        figures.TRANSMISSION_ANGLE: placed(motion.transmission_least, turn, "deg"),
        figures.FORCE_ANGLE: placed(motion.force_least, turn, "deg"),
    }
    for name, over in ((figures.DWELL, "shaft"), (figures.DWELL_RELATIVE, "relative")):
        longest = [dwell for key, dwells in driven.dwells.items() if key == over for dwell in dwells[:1]]
        for dwell in longest:
            at_deg = math.degrees(dwell.start) % 360.0 if over == "shaft" else None
            measured[name] = Measured(math.degrees(dwell.length), "deg", at_deg)
    return measured


# --- of files -------------------------------------------------------------------------------------


def file_figure(name: str, file: FileResult, checks: Sequence[Check]) -> Measured:
    """Measure a figure of a file that has a contour; `checks` are all checks of the run.

    The figure has no value, with the reason, where the file could not be judged or has no such figure.
    """
    unread, surfaces = "the file could not be judged", file.surfaces or (UNREAD,)
    if name == figures.CONTOUR_ERROR:
        return _greatest(
            Measured(verdict.measured_error, "mm", detail=unread, surface=verdict.name) for verdict in surfaces
        )
    if name == figures.PIECES:
        return Measured(None if file.pieces is None else float(file.pieces), "", detail=unread)
    if name == figures.OUTPUT_ERROR:
        error = None if file.linkage is None else file.linkage.error
        return Measured(None, "", detail=unread) if error is None else Measured(error.max, error.unit, error.at_deg)
    if name == figures.BACKLASH and file.closures:
        return _greatest(_play(closure.play) for closure in file.closures)
    if name == figures.BACKLASH and not file.surfaces:
        return Measured(None, "mm", detail=unread)
    if name == figures.BACKLASH:
        backlashes = [
            check
            for check in checks
            if check.file == file.path.name and check.name in CHECKS and CHECKS[check.name].backlash
        ]
        missing = "a single flat face has no backlash, and of a trimmed contour it is not judged"
        return figure_of_check(max(backlashes, key=_nearness)) if backlashes else Measured(None, "mm", detail=missing)
    return _greatest(_motion_error(verdict, dwell=name == figures.DWELL_ERROR) for verdict in surfaces)


def _play(play: Play) -> Measured:
    """Greatest play or interference of a follower between two surfaces of a file."""
    if play.most >= -play.least:
        return Measured(play.most, play.unit, play.most_at_deg)
    return Measured(-play.least, play.unit, play.least_at_deg)


def _motion_error(surface: SurfaceVerdict, *, dwell: bool) -> Measured:
    """Greatest error of the motion on a surface of a file, or with `dwell` the greatest range over its dwells."""
    motion = surface.motion
    if motion is None:
        return Measured(None, "", detail="the file could not be judged", surface=surface.name)
    if dwell:
        return Measured(motion.dwell_flatness, motion.unit, None, "the motion has no dwell", surface.name)
    return Measured(motion.max, motion.unit, motion.at_deg, surface=surface.name)
