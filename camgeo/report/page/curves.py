"""What a page plots over a turn: motion, angles of force, curvature; with limits and dwells. In the recipe's units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from camgeo.common.units import INCH
from camgeo.curve.support import is_sharp
from camgeo.recipe.figures import ON_RETURN, ON_RISE, PRESSURE_ANGLE
from camgeo.report.page.followers import SHAFT
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from camgeo.recipe.recipe import Recipe
    from camgeo.report.page.linked import Driven
    from camgeo.report.page.outline import Exact, Read
    from camgeo.synthesis.design import Design, SurfaceDesign
    from kin.numeric.arrays import Array

ORDER = 3
DERIVATIVES = ("", "velocity", "acceleration", "jerk")
POWERS = ("/rad", "/rad²", "/rad³")
TIMES = ("/s", "/s²", "/s³")
DEGREES = 180.0 / math.pi
COUNTS = 0.5  # of the longest dwell within a band: shorter ones are not told


@dataclass(frozen=True, eq=False)
class Series:
    """One curve: values (STEPS + 1,) at equal steps of the angle."""

    name: str
    values: Array


@dataclass(frozen=True, eq=False)
class Plot:
    """Curves over one angle; `limits` are lines across (value, name), `note` a remark below."""

    title: str
    unit: str
    series: tuple[Series, ...]
    over: Literal["shaft", "relative"] = "shaft"
    limits: tuple[tuple[float, str], ...] = ()
    dwells: bool = False
    note: str = ""


@dataclass(frozen=True)
class Rest:
    """A dwell over the shaft angle, degrees."""

    start: float
    length: float
    name: str


def derivatives(recipe: Recipe, title: str, unit: str, rows: Array) -> list[Plot]:
    """Return plots of a motion and its derivatives, rows (4, STEPS + 1) by the shaft angle, as `per` has them."""
    found = [Plot(title, unit, (Series(title.lower(), rows[0]),), dwells=True)]
    for order, name in enumerate(DERIVATIVES[1:], start=1):
        factor, power, note = per(recipe, order)
        series = (Series(name, factor * rows[order]),)
        found.append(Plot(name.capitalize(), unit + power, series, dwells=True, note=note))
    return found


def per(recipe: Recipe, order: int) -> tuple[float, str, str]:
    """Return factor, unit and note of a derivative: by radian, or by second where the shaft's speed is given."""
    if recipe.dynamics is None:
        return 1.0, POWERS[order - 1], ""
    rpm = recipe.dynamics.rpm
    return (rpm * TURN / 60.0) ** order, TIMES[order - 1], f"at {rpm:g} rpm"


def motion(recipe: Recipe, design: Design) -> list[Plot]:
    """Return plots of the follower's motion: what the motion table holds, at the page's steps."""
    position = design.motion
    unit = "°" if position.unit == "deg" else length_unit(recipe)
    rows = position.turn(SHAFT, ORDER) * position.shown(recipe.mm)
    return derivatives(recipe, position.title.capitalize(), unit, rows)


def output(recipe: Recipe, driven: Driven) -> list[Plot]:
    """Return plots of a linkage: output and its derivatives, the frame and its velocity, angles of force."""
    mechanism = driven.mechanism
    at, end = mechanism.at(driven.theta[:-1], ORDER), mechanism.at(driven.theta[-1:], ORDER, -1)
    rows = np.concatenate([at.over_shaft(at.output), end.over_shaft(end.output)], axis=1)
    unit, scale = ("°", DEGREES) if mechanism.unit == "deg" else (length_unit(recipe), 1.0 / recipe.mm)
    found = derivatives(recipe, "Output", unit, scale * rows)
    if mechanism.dyads:
        first, scale_1 = mechanism.linkage, DEGREES if mechanism.linkage.unit == "deg" else 1.0 / recipe.mm
        values = scale_1 * np.concatenate([at.outputs[0][0], end.outputs[0][0]])
        name = "°" if first.unit == "deg" else length_unit(recipe)
        found.append(Plot("Output of the first loop", name, (Series("first loop", values),)))
    frame = DEGREES * np.concatenate([at.over_shaft(at.frame[:2]), end.over_shaft(end.frame[:2])], axis=1)
    found.append(Plot("Frame", "°", (Series("angle of the frame", frame[0]),)))
    factor, power, note = per(recipe, 1)
    turning = (Series("velocity of the frame", factor * frame[1]),)
    found.append(Plot("Velocity of the frame", f"°{power}", turning, note=note))
    names = ("transmission angle", "force angle")
    angles = tuple(Series(name, DEGREES * row) for name, row in zip(names, driven.angles(), strict=True))
    note = "force angle: between the force of the frame and the direction in which it does nothing"
    found.append(Plot("Transmission and force angle", "°", angles, limits=((0.0, ""),), note=note))
    return found


def pressure(recipe: Recipe, angles: Mapping[str, Array], note: str = "") -> Plot:
    """Return the plot of pressure angles, rad (STEPS + 1,) each, by the name of what touches, and of their limits."""
    series = tuple(Series(name, DEGREES * row) for name, row in angles.items())
    return Plot("Pressure angle", "°", series, limits=_bounds(recipe, series), dwells=True, note=note)


def _bounds(recipe: Recipe, series: Sequence[Series]) -> tuple[tuple[float, str], ...]:
    """Return the limits of a pressure angle on the sides on which it is plotted: above 0 a rise, below 0 a return."""
    values = np.concatenate([one.values for one in series])
    sides = {PRESSURE_ANGLE: (1.0, -1.0), ON_RISE: (1.0,), ON_RETURN: (-1.0,)}
    return tuple(
        (side * limit.at_most, f"limit {limit.at_most:g}°")
        for limit in recipe.limits
        if limit.at_most is not None
        for side in sides.get(limit.figure, ())
        if (side * values).max() > 0.0
    )


def levers(recipe: Recipe, lengths: tuple[Array, Array]) -> Plot:
    """Return the plot of the levers of a flat pair's contacts about its pivot, mm (STEPS + 1,) each."""
    series = tuple(Series(f"face {name}", row / recipe.mm) for name, row in zip("AB", lengths, strict=True))
    note = "a flat face is pushed along its normal; the lever is that of the push about the pivot"
    return Plot("Lever of the contacts", length_unit(recipe), series, dwells=True, note=note)


def forces(recipe: Recipe, design: Design) -> list[Plot]:
    """Return the plots of forces at the contacts and of the shaft's torque; none but of a rigid train."""
    from camgeo.measures.running_forces import running_of
    from camgeo.measures.units import pounds

    running = None if recipe.dynamics is None else running_of(recipe, design)
    if running is None or running.jam_deg is not None:
        return []
    state, note = running.state(SHAFT), f"at {running.train.rpm:g} rpm, of a rigid follower"

    def noted(unit: str) -> str:
        other = pounds(recipe.units, unit)
        return note if other is None else f"{note}; 1 {unit.replace('^2', '²')} is {other[1]:.6g} {other[0]}"

    def opposite(title: str, unit: str, rows: Array) -> list[Plot]:
        """Return a plot for one contact, or for two that stand opposite each other."""
        series = [Series(name, row) for name, row in zip(running.turn.names, rows, strict=True)]
        step = max(1, len(series) // 2)
        groups = [tuple(series[k::step]) for k in range(step)]
        titles = [title if step == 1 else f"{title}, {' and '.join(one.name for one in group)}" for group in groups]
        return [
            Plot(name, unit.replace("^2", "²"), group, dwells=True, note=noted(unit))
            for name, group in zip(titles, groups, strict=True)
        ]

    plots = opposite("Contact force", "N", state.normal)
    plots.append(Plot("Torque of the shaft", "N m", (Series("torque", state.torque),), dwells=True, note=noted("N m")))
    if recipe.linkage is not None:
        across, along, *joints = (Series(name, row) for name, row in state.reactions.items())
        plots.append(Plot("Forces of the frame", "N", (across, along), dwells=True, note=noted("N")))
        if joints:
            plots.append(Plot("Forces at joint D", "N", tuple(joints), dwells=True, note=noted("N")))
    if state.pressure is not None:
        plots += opposite("Contact pressure", "N/mm^2", state.pressure)
    return plots


def preload(design: Design) -> list[Plot]:
    """Return the plot of the normal forces by which a preload presses both contacts on the cam; none without one."""
    given = design.exact.preload
    if given is None or given.stiffness is None:
        return []
    from camgeo.measures.forces import FollowerTurn, elastic

    turn, rows = FollowerTurn(design), design.motion.travel(SHAFT, 2)
    force = elastic(turn, given, rows).preload
    normal = zip(turn.names, (force / line.lever for line in turn.lines(rows)), strict=True)
    note = "along the normal of each contact, without load"
    return [Plot("Preload", "N", tuple(Series(name, values) for name, values in normal), note=note)]


def along(recipe: Recipe, places: Mapping[str, Array]) -> Plot:
    """Return the plot of where flat faces are touched, mm (STEPS + 1,) each, by their names."""
    note = "along the face, from the axis of its stem or the pivot of its arm"
    unit = length_unit(recipe)
    series = tuple(Series(name, place / recipe.mm) for name, place in places.items())
    return Plot("Contact on the face", unit, series, dwells=True, note=note)


def curvature(recipe: Recipe, design: Design, surface_design: SurfaceDesign, exact: Exact) -> Plot:
    """Return the plot of what undercut hangs on: the contour's radius of curvature, or a pitch curve's curvature.

    Of a ring, which is undercut where it is hollow, no margin is reported.
    """
    over: Literal["shaft", "relative"] = "relative" if design.driven is not None else "shaft"
    found, surface = surface_design.bent, surface_design.surface
    unit, radius = length_unit(recipe), surface.side * surface.radius
    margin, name = "", f", {surface.name}" if surface.name else ""
    if found.value is not None and math.isfinite(found.value) and radius >= 0.0:
        room = (found.value - radius) / recipe.mm
        margin = f"least radius {found.value / recipe.mm:.5g} {unit}, {room:.5g} {unit} from undercut"
        if surface_design.contour is not None and is_sharp(surface_design.contour):
            margin = "radius 0 about sharp corners, as the recipe has them"
    if radius:
        values = closed(exact.curvature[:: exact.per]) * recipe.mm
        limit = recipe.mm / radius
        series, touch = (Series("curvature of the pitch curve", values),), design.follower.contacts[0].touch.word
        return Plot(
            f"Curvature of the pitch curve{name}",
            f"1/{unit}",
            series,
            over,
            ((limit, touch),),
            note=margin,
        )
    values = closed(exact.radius[:: exact.per]) / recipe.mm
    series = (Series("radius of curvature", values),)
    return Plot(f"Radius of curvature{name}", unit, series, over, ((0.0, ""),), note=margin)


def off(recipe: Recipe, name: str, error: tuple[Array, Array]) -> Plot:
    """Return the plot of how far a file's contour lies outside the exact one: least and greatest in each step, mm."""
    rows, (unit, scale) = zip(("least", "greatest"), error, strict=True), small_unit(recipe)
    series = tuple(Series(word, scale * closed(row)) for word, row in rows)
    note = "distance outside the exact contour, negative inside"
    return Plot(f"Error of {name}", unit, series, limits=((0.0, ""),), note=note)


def backlash(recipe: Recipe, design: Design, files: Sequence[Read]) -> list[Plot]:
    """Return plots of what the contours in files, of a groove or of a pair's discs, leave to the follower."""
    from camgeo.synthesis.intent import closures_between, intents
    from kin.follower.motion_error import ContactError
    from kin.judge.closure import left_over

    meant = {surface.name: surface for intent in intents(recipe, design) for surface in intent.surfaces}
    read = {name: (meant[name], contour) for file in files for name, contour in file.contours.items()}
    found = []
    for closure in closures_between(design):
        if not {closure.pushes, closure.stops} <= set(read):
            continue
        first, last = read[closure.pushes], read[closure.stops]
        try:
            values = left_over(first, last, SHAFT)
        except ContactError:
            continue  # a check of the file says where contact is lost
        unit, scale = small_unit(recipe) if recipe.cam.arrangement.unit == "mm" else ("°", 1.0)
        names = " and ".join(file.name for file in files)
        note = f"of the follower between {closure.pushes} and {closure.stops}; below 0 they interfere"
        series = (Series("backlash", scale * values),)
        found.append(Plot(f"Backlash, {names}", unit, series, limits=((0.0, ""),), dwells=True, note=note))
    return found


def closed(values: Array) -> Array:
    """Return values (STEPS,) with the first repeated at the end."""
    return np.append(values, values[0])


def rests(recipe: Recipe, design: Design) -> list[Rest]:
    """Return the dwells: true rests of a follower, or of an output the longest within its band."""
    if design.driven is not None:
        unit = "°" if design.driven.mechanism.unit == "deg" else f" {length_unit(recipe)}"
        scale = DEGREES if unit == "°" else 1.0 / recipe.mm
        band = "" if recipe.dwell is None else f", within {recipe.dwell.band * scale:.4g}{unit}"
        dwells_of = design.driven.dwells.get("shaft", ())
        counted = [dwell for dwell in dwells_of if dwell.length >= COUNTS * dwells_of[0].length]
        return [_rest(dwell.start, dwell.start + dwell.length, band) for dwell in counted]
    return [_rest(begin, end, "") for begin, end in design.exact.gauge.rests]


def _rest(begin: float, end: float, band: str) -> Rest:
    start, length = math.degrees(begin), math.degrees(end - begin)
    return Rest(start % 360.0, length, f"dwell of {length:.5g}°{band}")


def small_unit(recipe: Recipe) -> tuple[str, float]:
    """Return the name of the unit in which errors are told, and how many of it there are in a mm."""
    return ("µin", 1e6 / INCH) if recipe.units == "inch" else ("µm", 1e3)


def length_unit(recipe: Recipe) -> str:
    """Return the name of the recipe's unit of length."""
    return "in" if recipe.units == "inch" else "mm"
