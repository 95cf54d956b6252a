"""What the figures of a design are: each measured where it is asked for, in mm and degrees, with its place."""

from __future__ import annotations

import math
from functools import partial
from itertools import starmap
from typing import TYPE_CHECKING

from camgeo.checks.declared import (
    CHECKS,
    LAW,
    PRESSURE,
    RATIO,
    STANDS,
    TRAVEL,
    WALL,
)
from camgeo.measures.measured import ABRUPT, Measured
from camgeo.recipe.figures import (
    BACKLASH,
    BASE_RADIUS,
    CONTOUR_ERROR,
    DURATION,
    DWELL,
    DWELL_ERROR,
    DWELL_RELATIVE,
    ECCENTRICITY,
    FACE_WIDTH,
    FIGURES,
    FORCE_ANGLE,
    HOLLOW_RADIUS,
    INERTIA,
    LIFT_AREA,
    LOBE_CENTRE,
    MARGIN,
    MASS,
    NOTHING,
    OF_DWELL,
    OF_LINKAGE,
    OFFSET,
    ON_RETURN,
    ON_RISE,
    OUTPUT_ERROR,
    PEAKS,
    PIECES,
    PITCH_RADIUS,
    PIVOT,
    PIVOT_CLEARANCE,
    PRELOAD_GREATEST,
    PRELOAD_LEAST,
    RADIUS,
    RAMP_VELOCITY,
    ROLLER_SPEED,
    SHAFT_RATE,
    SIZE,
    TRANSMISSION_ANGLE,
    UNBALANCE,
)
from camgeo.registry import registry
from camgeo.synthesis.checks import hollow_radius, needed_width
from kin.judge.verdict import UNREAD
from kin.numeric.angles import TURN, degrees

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from camgeo.cams.surface import Surface
    from camgeo.curve.curve import Curve
    from camgeo.curve.extremes import Extreme
    from camgeo.measures.balance import Balance
    from camgeo.measures.file_result import FileResult
    from camgeo.recipe.recipe import Recipe
    from camgeo.synthesis.design import Design, SurfaceDesign
    from camgeo.synthesis.linkage import Driven
    from kin.follower.motion_error import Play
    from kin.judge.check import Check
    from kin.judge.verdict import SurfaceVerdict
    from kin.linkage.extremes import Place

_SHARE = 1e-12  # of the greatest value, to which a motion is followed
ORDERS = {"swing": 0, **{name: k for k, name in enumerate(PEAKS, 1)}}
_OF_CHECKS = {one.name: one for one in (PRESSURE, RATIO, LAW, TRAVEL, WALL)}


NO_CONTOUR = Measured(None, "mm", detail="no contour is made")


def _least(figures: Iterable[Measured]) -> Measured:
    """The least of what was measured of each surface, `NO_CONTOUR` of none; one without a value is the least."""
    return min(figures, key=lambda one: -math.inf if one.value is None else one.value, default=NO_CONTOUR)


def _greatest(figures: Iterable[Measured]) -> Measured:
    """The greatest, in the same way."""
    return max(figures, key=lambda one: math.inf if one.value is None else one.value, default=NO_CONTOUR)


def of_design(
    recipe: Recipe,
    design: Design,
    checks: Sequence[Check],
    names: Iterable[str],
    speeds: Mapping[str, float] | None = None,
) -> dict[str, Measured]:
    """Measure figures of the exact cam, its motion and mechanism; one that no check of this run has is left out.

    `checks` are all that were made. `speeds` are those, turns a minute, at which limits are that say so, by figure.
    """
    wanted = [name for name in names if FIGURES[name].of == "design"]
    found: dict[str, Measured] = {}
    owned: dict[str, list[str]] = {}
    for name in wanted:
        if owner := FIGURES.owner(name):
            owned.setdefault(owner, []).append(name)
    for owner, own in owned.items():
        found |= registry.capability(owner).measure(recipe, design, own, speeds or {})
    motion = [name for name in wanted if name in ORDERS]
    if design.driven is not None:
        found |= _of_linkage(design.driven, wanted)
    elif motion:
        found |= of_motion(design, max(ORDERS[name] for name in motion))
    for name in wanted:
        if name in _OF_CHECKS or (FIGURES.owner(name) and name in CHECKS):
            same = [check for check in checks if check.name == name and check.file is None]
            if same:
                found[name] = of_check(max(same, key=_nearness))
            elif name == PRESSURE.name:
                found[name] = Measured(0.0, "deg", detail="a flat face is pushed along its normal")
        elif name in _OF_CURVE:
            found[name] = _OF_CURVE[name](recipe, design)
    return {name: found[name] for name in wanted if name in found}


def _nearness(check: Check) -> float:
    """The more the nearer a check is to its limit."""
    if check.value is None:
        return math.inf
    return -check.value if check.sense == "at_least" else check.value


def of_check(check: Check) -> Measured:
    """Give the figure that a check holds against its limit."""
    detail = "" if check.value is not None else check.detail
    return Measured(check.value, check.unit, check.at_deg, detail, check.surface)


# --- of the curve -----------------------------------------------------------------------------------------------------


def _radius(_: Recipe, design: Design) -> Measured:
    """Of the metal, not of the roller's way, which is bent less by the roller's radius."""

    def metal(surface: SurfaceDesign) -> Measured:
        value = None if surface.bent.value is None else surface.bent.value - surface.surface.radius
        return Measured(value, "mm", surface.bent.at_deg, surface.bent.detail, surface.surface.name)

    return _least(map(metal, design.surfaces))


def _pitch_radius(_: Recipe, design: Design) -> Measured:
    """What the check of that name holds: of the places where the cam may undercut, the hollows of a ring."""
    return _least(of_check(made.bent) for made in design.surfaces)


def _hollow_radius(_: Recipe, design: Design) -> Measured:
    def hollow(surface: Surface, contour: Curve) -> Measured:
        radius, at = hollow_radius(surface.side, contour)
        if math.isinf(radius):
            return Measured(radius, "mm", detail="the contour has no concave part", surface=surface.name)
        return Measured(radius, "mm", design.motion.shaft_deg(at), surface=surface.name)

    return _least(starmap(hollow, design.contours))


def _size(_: Recipe, design: Design) -> Measured:
    from camgeo.curve.measures import farthest

    def reach(surface: Surface, contour: Curve) -> Measured:
        far = farthest(contour)
        return Measured(far.value + far.slack, "mm", design.motion.shaft_deg(far.at), surface=surface.name)

    return _greatest(starmap(reach, design.contours))


def _pivot_clearance(recipe: Recipe, design: Design) -> Measured:
    """Of the circle on which the pivot runs round the standing cam: in a ring from within, round a groove's blank."""
    from camgeo.curve.measures import farthest, nearest

    pivot = design.follower.pivot
    within = all(surface.side < 0 for surface, _ in design.contours)

    def beside(surface: Surface, contour: Curve) -> Measured:
        end = nearest(contour) if within else farthest(contour)
        value = (end.value - pivot if within else pivot - end.value) - end.slack
        return Measured(value, "mm", design.motion.shaft_deg(end.at), surface=surface.name)

    least = _least(starmap(beside, design.contours))
    return least if within or recipe.part.outer is None else Measured(pivot - 0.5 * recipe.part.outer, "mm")


def _extremes(surface: Surface, name: str) -> tuple[Extreme, Extreme]:
    found = surface.extremes(name)
    if found is None:
        raise TypeError(f"no {name} is known of this follower")
    return found


def _steepest(design: Design, surface: Surface) -> list[Measured]:
    """Greatest pressure angles of a surface on the follower's rise and return."""
    steepest = design.exact.steepest(surface)
    if steepest is None:
        raise TypeError("no slope is known of this follower")
    return [
        Measured(math.degrees(math.atan(most.value + most.slack)), "deg", degrees(most.at), surface=surface.name)
        for most in steepest
    ]


def _on_rise(_: Recipe, design: Design) -> Measured:
    def rising(surface: Surface) -> Measured:
        return _steepest(design, surface)[0]

    return _greatest(map(rising, design.exact.surfaces))


def _on_return(_: Recipe, design: Design) -> Measured:
    def falling(surface: Surface) -> Measured:
        return _steepest(design, surface)[1]

    return _greatest(map(falling, design.exact.surfaces))


def _roller_speed(_: Recipe, design: Design) -> Measured:
    def spin(surface: Surface) -> Measured:
        fastest = max(_extremes(surface, "spin"), key=lambda one: abs(one.value))
        return Measured(abs(fastest.value) + fastest.slack, "", degrees(fastest.at), surface=surface.name)

    return _greatest(map(spin, design.exact.surfaces))


def _face_width(_: Recipe, design: Design) -> Measured:
    widths = ((surface.name, *needed_width(surface)) for surface in design.exact.surfaces)
    return _greatest(Measured(value, "mm", at, surface=name) for name, value, at in widths)


def _base_radius(recipe: Recipe, _: Design) -> Measured:
    base, *_others = recipe.cam.circles()
    return Measured(base.radius, "mm")


def _offset(_: Recipe, design: Design) -> Measured:
    return Measured(design.follower.offset, "mm")


def _pivot(_: Recipe, design: Design) -> Measured:
    return Measured(design.follower.pivot, "mm")


def _of_preload(rank: int) -> Callable[[Recipe, Design], Measured]:
    """Least (0) or greatest (1) force of a preload."""

    def measured(_: Recipe, design: Design) -> Measured:
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

    return measured


def _of_mass(value: Callable[[Balance], float], unit: str) -> Callable[[Recipe, Design], Measured]:
    """Make the measure of the discs' balance: the greatest of them."""

    def measure(recipe: Recipe, design: Design) -> Measured:
        from camgeo.measures.balance import balances_of

        found = balances_of(recipe, design)
        if not found:
            return Measured(None, unit, detail="the part is no single body")
        detail = f"without the {', '.join(found[0].without)}" if found[0].without else ""
        return _greatest(Measured(value(one), unit, detail=detail, surface=one.surface) for one in found)

    return measure


def _of_lobe(name: str, recipe: Recipe, design: Design) -> Measured:
    from camgeo.measures.lobe import of_lobe

    return of_lobe(name, recipe, design)


_OF_CURVE: dict[str, Callable[[Recipe, Design], Measured]] = {
    RADIUS: _radius,
    PITCH_RADIUS: _pitch_radius,
    HOLLOW_RADIUS: _hollow_radius,
    SIZE: _size,
    BASE_RADIUS: _base_radius,
    OFFSET: _offset,
    PIVOT: _pivot,
    ON_RISE: _on_rise,
    ON_RETURN: _on_return,
    PIVOT_CLEARANCE: _pivot_clearance,
    ROLLER_SPEED: _roller_speed,
    FACE_WIDTH: _face_width,
    PRELOAD_LEAST: _of_preload(0),
    PRELOAD_GREATEST: _of_preload(1),
    MASS: _of_mass(lambda disc: disc.mass, "kg"),
    ECCENTRICITY: _of_mass(lambda disc: disc.eccentricity, "mm"),
    INERTIA: _of_mass(lambda disc: disc.inertia, "kg mm^2"),
    UNBALANCE: _of_mass(lambda disc: disc.unbalance, "kg mm"),
    **{name: partial(_of_lobe, name) for name in (DURATION, LOBE_CENTRE, RAMP_VELOCITY, LIFT_AREA)},
}


# --- of the motion ----------------------------------------------------------------------------------------------------


def of_motion(design: Design, order: int) -> dict[str, Measured]:
    """Stroke or swing of the follower, and the greatest of its derivatives by the shaft angle up to an order."""
    from kin.numeric.monotone import RoughError, between, cells, pieces

    position = design.motion
    unit, scale = position.unit, position.shown(1.0)
    names = [name for name, k in ORDERS.items() if k <= order]
    try:
        made = cells(
            lambda t: position.by_parameter(t, order), between(0.0, TURN, design.exact.breaks.tolist()), share=_SHARE
        )
    except RoughError:
        return {name: Measured(None, unit + FIGURES[name].per, detail=ABRUPT) for name in names}
    found: dict[str, Measured] = {}
    for name in names:
        row = pieces(made, ORDERS[name])
        low, high = row.least(), row.greatest()
        if name == "swing":
            found[name] = Measured(scale * (high[0] - low[0]), unit)
            continue
        value, at = max(low, high, key=lambda place: abs(place[0]))
        found[name] = Measured(scale * abs(value), unit + FIGURES[name].per, position.shaft_deg(at % TURN))
    return found


def _of_linkage(driven: Driven, names: Iterable[str]) -> dict[str, Measured]:
    """Figures of a linkage's motion."""
    mobility, unit = driven.mechanism.mobility(), driven.mechanism.unit
    scale = math.degrees(1.0) if unit == "deg" else 1.0
    found = {
        MARGIN: Measured(mobility.margin, "mm"),
        SHAFT_RATE: Measured(None if math.isnan(mobility.least_rate) else mobility.least_rate, "", detail=STANDS),
    }
    if driven.figures is None:
        of = (NOTHING, OF_DWELL, OF_LINKAGE)
        lost = (name for name in names if FIGURES[name].needs in of and name not in {*found, *_OF_CURVE})
        return found | {name: Measured(None, "", detail=STANDS) for name in lost}

    def placed(place: Place, factor: float, unit: str) -> Measured:
        return Measured(abs(place.value) * factor, unit, math.degrees(place.shaft))

    made, turn = driven.figures, math.degrees(1.0)
    found |= {
        "swing": Measured(made.swing * scale, unit),
        PEAKS[0]: placed(made.velocity, scale, f"{unit}/rad"),
        PEAKS[1]: placed(made.acceleration, scale, f"{unit}/rad^2"),
        TRANSMISSION_ANGLE: placed(made.transmission_least, turn, "deg"),
        FORCE_ANGLE: placed(made.force_least, turn, "deg"),
    }
    for name, over in ((DWELL, "shaft"), (DWELL_RELATIVE, "relative")):
        longest = [dwell for key, dwells in driven.dwells.items() if key == over for dwell in dwells[:1]]
        for dwell in longest:
            at = math.degrees(dwell.start) % 360.0 if over == "shaft" else None
            found[name] = Measured(math.degrees(dwell.length), "deg", at)
    return found


# --- of files -------------------------------------------------------------------------------------


def of_file(name: str, file: FileResult, checks: Sequence[Check]) -> Measured:
    """Measure a figure of a file that has a contour; `checks` are all that were made."""
    unread, surfaces = "the file could not be judged", file.surfaces or (UNREAD,)
    if name == CONTOUR_ERROR:
        return _greatest(Measured(one.measured_error, "mm", detail=unread, surface=one.name) for one in surfaces)
    if name == PIECES:
        return Measured(None if file.pieces is None else float(file.pieces), "", detail=unread)
    if name == OUTPUT_ERROR:
        error = None if file.linkage is None else file.linkage.error
        return Measured(None, "", detail=unread) if error is None else Measured(error.max, error.unit, error.at_deg)
    if name == BACKLASH and file.closures:
        return _greatest(_of_play(closure.play) for closure in file.closures)
    if name == BACKLASH and not file.surfaces:
        return Measured(None, "mm", detail=unread)
    if name == BACKLASH:
        held = [
            one for one in checks if one.file == file.path.name and one.name in CHECKS and CHECKS[one.name].backlash
        ]
        lost = "a single flat face has no backlash, and of a trimmed contour it is not judged"
        return of_check(max(held, key=_nearness)) if held else Measured(None, "mm", detail=lost)
    dwell = name == DWELL_ERROR
    return _greatest(_of_motion_error(one, dwell=dwell) for one in surfaces)


def _of_play(play: Play) -> Measured:
    """Greatest play or interference of a follower between two surfaces of a file."""
    if play.most >= -play.least:
        return Measured(play.most, play.unit, play.most_at_deg)
    return Measured(-play.least, play.unit, play.least_at_deg)


def _of_motion_error(surface: SurfaceVerdict, *, dwell: bool) -> Measured:
    """Greatest error of the motion on a surface of a file, or how far its dwells are from flat."""
    motion = surface.motion
    if motion is None:
        return Measured(None, "", detail="the file could not be judged", surface=surface.name)
    if dwell:
        return Measured(motion.dwell_flatness, motion.unit, None, "the motion has no dwell", surface.name)
    return Measured(motion.max, motion.unit, motion.at_deg, surface=surface.name)
