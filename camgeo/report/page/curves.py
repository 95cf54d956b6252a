"""Plots of a page over a turn: motion, pressure angles, curvature; with limits and dwells. In the recipe's units."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeVar

import numpy as np

from camgeo.common.units import INCH
from camgeo.curve.support import is_sharp
from camgeo.measures.units import in_pounds
from camgeo.recipe.figures import (
    BACKLASH,
    FIGURES,
    ON_RETURN,
    ON_RISE,
    PITCH_RADIUS,
    PRELOAD_GREATEST,
    PRELOAD_LEAST,
    PRESSURE_ANGLE,
    RADIUS,
)
from camgeo.report.page.followers import SHAFT
from camgeo.report.plot import Plot, Series
from camgeo.schema.fields import Kind
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from camgeo.recipe.recipe import Recipe
    from camgeo.report.page.linked import SteppedMechanism
    from camgeo.report.page.outline import Exact, FileContours
    from camgeo.synthesis.design import Design, SurfaceDesign
    from kin.numeric.arrays import Array

T = TypeVar("T")
ORDER = 3
DERIVATIVES = ("", "velocity", "acceleration", "jerk")
POWERS = ("/rad", "/rad²", "/rad³")
TIMES = ("/s", "/s²", "/s³")
DEGREES = 180.0 / math.pi
FAR = 3.0  # ranges of a curve: a line that is farther off is not drawn
SAME = 1e-4  # of a curve's range: what is nearer is drawn once
COUNTS = 0.5  # of the longest dwell within a band: shorter ones are not shown


def group_alike(items: Iterable[T], alike: Callable[[T, T], bool]) -> list[list[T]]:
    """Groups of items that are alike, each in the order of the items; groups in the order of their first items."""
    groups: list[list[T]] = []
    for item in items:
        group = next((group for group in groups if alike(group[0], item)), None)
        if group is None:
            groups.append([item])
        else:
            group.append(item)
    return groups


def merge_alike(plots: Sequence[Plot]) -> list[Plot]:
    """Plots without repetitions: of plots with the same curves the first is kept, under the titles of all."""
    return [
        replace(alike[0], title=join_titles([plot.title for plot in alike]), series=_distinct(alike[0].series))
        for alike in group_alike(plots, _same_curves)
    ]


def _distinct(series: Sequence[Series]) -> tuple[Series, ...]:
    """Series without repetitions: of series with the same values the first is kept, under the names of all."""
    groups = group_alike(series, lambda first, row: equal(first.values, row.values))
    return tuple(replace(rows[0], name=join_titles([row.name for row in rows])) for rows in groups)


def _same_curves(plot: Plot, other: Plot) -> bool:
    """Whether two plots have the same curves, within what a picture shows, and the same limits."""
    if (plot.unit, plot.over, plot.limits) != (other.unit, other.over, other.limits):
        return False
    pairs = zip(plot.series, other.series, strict=False)
    return len(plot.series) == len(other.series) and all(equal(a.values, b.values) for a, b in pairs)


def equal(values: Array, other_values: Array) -> bool:
    """Whether two curves (n,) differ by less than a picture shows, `SAME` of the first one's range."""
    span = float(np.ptp(values[np.isfinite(values)])) if np.isfinite(values).any() else 0.0
    return bool(np.allclose(values, other_values, rtol=1e-12, atol=SAME * span, equal_nan=True))


def join_titles(titles: Sequence[str]) -> str:
    """Return titles as one: `Error of a.dxf` and `Error of a.svg` are `Error of a.dxf and a.svg`."""
    first, *other_titles = titles
    head = max((first.rfind(mark) + len(mark) for mark in (" of ", ", ") if mark in first), default=0)
    tails = [title[head:] for title in other_titles if title.startswith(first[:head])]
    whole = tails if len(tails) == len(other_titles) else other_titles
    *before, last = [first, *whole]
    return f"{', '.join(before)} and {last}" if before else last


@dataclass(frozen=True)
class DwellBand:
    """A dwell over the shaft angle: where it starts and its length, degrees."""

    start: float
    length: float
    name: str


def derivatives(recipe: Recipe, title: str, unit: str, rows: Array) -> list[Plot]:
    """Return plots of a motion, velocity, acceleration and jerk, with the recipe's limits of each.

    `rows` (4, STEPS + 1) are the motion in `unit` and its derivatives by the shaft angle in rad; they are plotted by
    radian or by second (`per`).
    """
    plots = [Plot(title, unit, (Series(title.lower(), rows[0]),), dwells=True)]
    for order, name in enumerate(DERIVATIVES[1:], start=1):
        factor, power, note = per(recipe, order)
        series = (Series(name, factor * rows[order]),)
        scale = recipe.mm if unit == length_unit(recipe) else 1.0
        lines = limits(recipe, _peaks(recipe, power), series, 1.0 / scale)
        plots.append(Plot(name.capitalize(), unit + power, series, limits=lines, dwells=True, note=note))
    return plots


def _peaks(recipe: Recipe, power: str) -> dict[str, tuple[float, float]]:
    """Return both sides for each limited figure of the motion whose unit has this power of rad or s."""
    limited = {limit.figure: FIGURES[limit.figure] for limit in recipe.limits}
    peaks = {
        name for name, figure in limited.items() if figure.kind is Kind.MOTION and with_powers(figure.per) == power
    }
    return dict.fromkeys(peaks, (1.0, -1.0))


def with_powers(unit: str) -> str:
    """Return a unit with raised digits: `mm²` for `mm^2`."""
    return unit.replace("^2", "²").replace("^3", "³")


def per(recipe: Recipe, order: int) -> tuple[float, str, str]:
    """Return factor, ending of the unit, and note of the derivative of this order by the shaft angle in rad.

    It is by radian, `/rad²`, or by second, `/s²`, where the recipe gives the shaft's speed.
    """
    rpm = recipe.rpm
    if rpm is None:
        return 1.0, POWERS[order - 1], ""
    return (rpm * TURN / 60.0) ** order, TIMES[order - 1], f"at {rpm:g} rpm"


def motion(recipe: Recipe, design: Design) -> list[Plot]:
    """Return plots of the follower's displacement and its derivatives at the page's steps."""
    position = design.motion
    unit = "°" if position.unit == "deg" else length_unit(recipe)
    rows = position.turn(SHAFT, ORDER) * position.factor(recipe.mm)
    return derivatives(recipe, position.title.capitalize(), unit, rows)


def output(recipe: Recipe, driven: SteppedMechanism) -> list[Plot]:
    """Return plots of a linkage: output and its derivatives, frame and its velocity, transmission and force angle."""
    # derivatives may jump where the turn closes: its end has those of the left side
    mechanism = driven.mechanism
    state, end = mechanism.at(driven.theta[:-1], ORDER), mechanism.at(driven.theta[-1:], ORDER, -1)
    rows = np.concatenate([state.over_shaft(state.output), end.over_shaft(end.output)], axis=1)
    unit, scale = ("°", DEGREES) if mechanism.unit == "deg" else (length_unit(recipe), 1.0 / recipe.mm)
    plots = derivatives(recipe, "Output", unit, scale * rows)
    if mechanism.dyads:
        first, scale_1 = mechanism.linkage, DEGREES if mechanism.linkage.unit == "deg" else 1.0 / recipe.mm
        values = scale_1 * np.concatenate([state.outputs[0][0], end.outputs[0][0]])
        name = "°" if first.unit == "deg" else length_unit(recipe)
        plots.append(Plot("Output of the first loop", name, (Series("first loop", values),), axis="output"))
    frame = DEGREES * np.concatenate([state.over_shaft(state.frame[:2]), end.over_shaft(end.frame[:2])], axis=1)
    plots.append(Plot("Frame", "°", (Series("angle of the frame", frame[0]),)))
    factor, power, note = per(recipe, 1)
    turning = (Series("velocity of the frame", factor * frame[1]),)
    plots.append(Plot("Velocity of the frame", f"°{power}", turning, note=note, axis="velocity"))
    names = ("transmission angle", "force angle")
    angles = tuple(Series(name, DEGREES * row) for name, row in zip(names, driven.angles(), strict=True))
    note = "force angle: between the force of the frame and the direction in which it does nothing"
    bounds = limits(recipe, {"transmission-angle": (1.0,), "force-angle": (1.0,)}, angles)
    plots.append(
        Plot("Transmission and force angle", "°", angles, limits=((0.0, ""), *bounds), note=note, axis="angle")
    )
    return plots


def pressure(recipe: Recipe, angles: Mapping[str, Array], note: str = "") -> Plot:
    """Return the plot of pressure angles, rad (STEPS + 1,), by the name of roller or face, with the recipe's limits.

    A limit on the rise bounds angles above 0, one on the return those below.
    """
    series = tuple(Series(name, DEGREES * row) for name, row in angles.items())
    sides = {PRESSURE_ANGLE: (1.0, -1.0), ON_RISE: (1.0,), ON_RETURN: (-1.0,)}  # above 0 a rise, below 0 a return
    lines = limits(recipe, sides, series)
    return Plot("Pressure angle", "°", series, limits=lines, dwells=True, note=note)


def short(value: float) -> str:
    """Return a figure to four significant digits as text, without an exponent where it is large."""
    return f"{float(f'{value:.4g}'):.12g}"


def limits(
    recipe: Recipe, sides: Mapping[str, Sequence[float]], series: Sequence[Series], scale: float = 1.0
) -> tuple[tuple[float, str], ...]:
    """Return the recipe's limits of figures as lines across curves: pairs of a value and a name.

    `sides` has, by figure, the signs 1 and -1 of the values that the limit bounds; a side without curves has no line.
    `scale` converts a limit to the plot's unit. A limit at another speed than the plotted one has no line.
    """
    values = np.concatenate([row.values for row in series])
    rpm = recipe.rpm
    lines = []
    for limit in recipe.limits:
        for side in sides.get(limit.figure, ()) if limit.rpm in {None, rpm} else ():
            bounds = ((limit.at_least, "at least"), (limit.at_most, "limit"))
            lines += [
                (side * scale * bound, f"{word} {short(scale * bound)}")
                for bound, word in bounds
                if bound is not None and np.nanmax(side * values) > 0.0
            ]
    return tuple(lines)


def levers(recipe: Recipe, lengths: tuple[Array, Array]) -> Plot:
    """Return the plot of the levers of a flat pair's contacts about its pivot, mm (STEPS + 1,) for faces A and B."""
    series = tuple(Series(f"face {name}", row / recipe.mm) for name, row in zip("AB", lengths, strict=True))
    note = "a flat face is pushed along its normal; the lever is that of the push about the pivot"
    return Plot("Lever of the contacts", length_unit(recipe), series, dwells=True, note=note, axis="lever")


def shown_unit(recipe: Recipe, si: str) -> tuple[float, str]:
    """Return the factor from an SI unit of force, moment or pressure, such as `N`, to the shown unit, and its name."""
    factor, unit = in_pounds(recipe.units, 1.0, si)
    return factor, with_powers(unit)


def preload(recipe: Recipe, design: Design) -> list[Plot]:
    """Return plots of a preload's force along the travel, with its limits, and along the normals of both contacts.

    One plot for a follower on a stem; on an arm two, as along the travel there is a moment. Empty without a stiff
    preload.
    """
    preload_force = design.exact.preload
    if preload_force is None or preload_force.stiffness is None:
        return []
    from camgeo.measures.forces import PER_MM, FollowerTurn, elastic_contacts

    turn, rows = FollowerTurn(design), design.motion.travel(SHAFT, 2)
    force = elastic_contacts(turn, preload_force, rows).preload
    factor, unit = shown_unit(recipe, turn.unit)
    travel = (Series("along the travel", factor * (PER_MM if turn.swings else 1.0) * force),)
    lines = limits(recipe, {PRELOAD_LEAST: (1.0,), PRELOAD_GREATEST: (1.0,)}, travel, factor)
    per_newton, newtons = shown_unit(recipe, "N")
    normal = zip(turn.names, (force / line.lever for line in turn.lines(rows)), strict=True)
    contact_series = tuple(Series(name, per_newton * values) for name, values in normal)
    note = "of each contact along its normal, without load"
    if not turn.swings:
        if lines:
            note += "; limits are of the force along the travel"
        return [Plot("Preload", unit, (*travel, *contact_series), limits=lines, note=note, axis="force", holds=(0.0,))]
    return [
        Plot("Preload", unit, travel, limits=lines, note="about the pivot, without load", axis="moment", holds=(0.0,)),
        Plot("Preload of the contacts", newtons, contact_series, note=note, axis="force", holds=(0.0,)),
    ]


def along(recipe: Recipe, places: Mapping[str, Array], width: float | None = None) -> Plot:
    """Return the plot of the places at which flat faces are touched, mm (STEPS + 1,), by the names of the faces.

    The edges of a face of a `width`, mm, are drawn half of it from its axis.
    """
    note = "along the face, from the axis of its stem or the pivot of its arm"
    unit = length_unit(recipe)
    series = tuple(Series(name, place / recipe.mm) for name, place in places.items())
    half = 0.0 if width is None else 0.5 * width / recipe.mm
    edges = () if width is None else ((half, "edge of the face"), (-half, ""))
    return Plot("Contact on the face", unit, series, limits=edges, dwells=True, note=note, axis="place")


def curvature(recipe: Recipe, design: Design, surface_design: SurfaceDesign, exact: Exact) -> Plot:
    """Return the plot that shows undercut: the curvature of a pitch curve, or else the contour's radius of curvature.

    The note has the least radius of curvature and its margin from undercut, but for a ring with a pitch curve.
    `exact` is the surface's contour at the page's steps.
    """
    over: Literal["shaft", "relative"] = "relative" if design.driven is not None else "shaft"
    bend, surface = surface_design.bent, surface_design.surface
    unit, radius = length_unit(recipe), surface.side * surface.radius
    # the margin in words: a contour offset by the roller's radius is undercut where the pitch curve bends more
    margin, name = "", f", {surface.name}" if surface.name else ""
    if bend.value is not None and math.isfinite(bend.value) and radius >= 0.0:
        margin_mm = (bend.value - radius) / recipe.mm
        side = "from" if margin_mm > 0.0 else "beyond"
        margin = f"least radius {bend.value / recipe.mm:.5g} {unit}, {abs(margin_mm):.5g} {unit} {side} undercut"
        if surface_design.contour is not None and is_sharp(surface_design.contour):
            margin = "radius 0 about sharp corners, as the recipe has them"
    # of a pitch curve the curvature, as its radius is infinite at an inflection
    if radius:
        values = close_turn(exact.curvature[:: exact.per]) * recipe.mm
        limit = recipe.mm / radius
        series, touch = (Series("curvature of the pitch curve", values),), design.follower.contacts[0].touch.word
        # what is far from the curve is said by the margin alone
        near = not margin or limit < values.max() + FAR * float(np.ptp(values))
        undercut = [(limit, f"undercut by the {touch}")] if near else []
        grown = {PITCH_RADIUS: 0.0, RADIUS: radius}  # mm by which the pitch curve's radius is greater than the figure's
        lines = [
            (recipe.mm / (bound.at_least + grown[bound.figure]), f"limit of {bound.figure}")
            for bound in recipe.limits
            if bound.figure in grown and bound.at_least is not None and bound.at_least + grown[bound.figure] > 0.0
        ]
        return Plot(
            f"Curvature of the pitch curve{name}",
            f"1/{unit}",
            series,
            over,
            (*undercut, *lines),
            note=margin,
            axis="curvature",
        )
    values = close_turn(exact.radius[:: exact.per]) / recipe.mm
    series = (Series("radius of curvature", values),)
    bounds = limits(recipe, {RADIUS: (1.0,)}, series, 1.0 / recipe.mm)
    return Plot(f"Radius of curvature{name}", unit, series, over, ((0.0, ""), *bounds), note=margin, axis="radius")


def backlash(recipe: Recipe, design: Design, files: Sequence[FileContours]) -> list[Plot]:
    """Return plots of the follower's backlash between two contours of files: sides of a groove, or discs of a pair.

    Empty for a cam with one contour, and where the follower loses contact.
    """
    from camgeo.synthesis.intent import closures_between, intents
    from kin.follower.motion_error import ContactError
    from kin.judge.closure import left_over

    intended = {surface.name: surface for intent in intents(recipe, design) for surface in intent.surfaces}
    contours = {name: (intended[name], contour) for file in files for name, contour in file.contours.items()}
    plots = []
    for closure in closures_between(design):
        if not {closure.pushes, closure.stops} <= set(contours):
            continue
        first, last = contours[closure.pushes], contours[closure.stops]
        try:
            values = left_over(first, last, SHAFT)
        except ContactError:
            continue  # a check of the file says where contact is lost
        unit, scale = small_unit(recipe) if recipe.cam.arrangement.unit == "mm" else ("°", 1.0)
        names = " and ".join(file.name for file in files)
        note = f"of the follower between {closure.pushes} and {closure.stops}; below 0 they interfere"
        series = (Series("backlash", scale * values),)
        sides = {BACKLASH: (1.0,)}
        lines = ((0.0, ""), *limits(recipe, sides, series, scale if unit != "°" else 1.0))
        plot = Plot(
            f"Backlash, {names}", unit, series, limits=lines, dwells=True, note=note, axis="backlash", holds=(0.0,)
        )
        plots.append(plot)
    return plots


def close_turn(values: Array) -> Array:
    """Return values (STEPS,) with the first repeated at the end."""
    return np.append(values, values[0])


def rests(recipe: Recipe, design: Design) -> list[DwellBand]:
    """Return the dwells over the shaft angle: exact rests of a follower, or of an output its stays within the band.

    Of those stays only the longest are listed, down to `COUNTS` of the longest.
    """
    if design.driven is not None:
        unit = "°" if design.driven.mechanism.unit == "deg" else f" {length_unit(recipe)}"
        scale = DEGREES if unit == "°" else 1.0 / recipe.mm
        band = "" if recipe.dwell is None else f", within {recipe.dwell.band * scale:.4g}{unit}"
        dwells_of = design.driven.dwells.get("shaft", ())
        counted = [dwell for dwell in dwells_of if dwell.length >= COUNTS * dwells_of[0].length]
        return [_rest(dwell.start, dwell.start + dwell.length, band) for dwell in counted]
    return [_rest(begin, end, "") for begin, end in design.exact.gauge.rests]


def _rest(begin: float, end: float, band: str) -> DwellBand:
    start, length = math.degrees(begin), math.degrees(end - begin)
    return DwellBand(start % 360.0, length, f"dwell of {length:.5g}°{band}")


def small_unit(recipe: Recipe) -> tuple[str, float]:
    """Return the name of the unit of small errors, and how many of it a mm has."""
    return ("µin", 1e6 / INCH) if recipe.units == "inch" else ("µm", 1e3)


def length_unit(recipe: Recipe) -> str:
    """Return the name of the recipe's unit of length."""
    return "in" if recipe.units == "inch" else "mm"
