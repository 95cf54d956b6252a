"""Figures of a linear cam, each with its place: of the exact flank, of the drive in time, of its load."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.linear.flank import convex_radius, slopes, stretches
from camgeo.curve.extremes import both
from camgeo.curve.parallel import Parallel
from camgeo.measures.hertz import bearable, line_pressure
from camgeo.measures.placed import Figure, greatest_of
from camgeo.recipe.figures import HOLLOW_RADIUS, ON_RETURN, ON_RISE, PITCH_RADIUS, PRESSURE_ANGLE, RADIUS

if TYPE_CHECKING:
    from camgeo.capabilities.linear.design import LinearDesign
    from camgeo.capabilities.linear.keys import CrankDrive
    from camgeo.capabilities.linear.path import CentrePath
    from camgeo.curve.curve import Side
    from camgeo.curve.extremes import Extreme
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array

STEPS = 30  # of Newton's method
MINUTE = 60.0
SAME = 1e-12  # of the travel: a place so near a break is the break


def figures_of(design: LinearDesign) -> list[Figure]:
    """All figures that a design has, in the order of reports."""
    recipe = design.recipe
    least, greatest = slopes(design.path)
    rise, fall = math.degrees(math.atan(greatest.value)), math.degrees(math.atan(least.value))
    steepest = (rise, greatest.at) if rise >= -fall else (-fall, least.at)
    found = [
        Figure(PRESSURE_ANGLE, steepest[0], "deg", steepest[1]),
        Figure(ON_RISE, rise, "deg", greatest.at),
        Figure(ON_RETURN, fall, "deg", least.at),
        *_radii(design),
        Figure("travel", design.total, "mm"),
    ]
    lost = design.lower.lost if recipe.trims else ()
    if recipe.trims:
        worst = max(lost, key=lambda each: each.depth, default=None)
        reach = design.path.guide.reach
        found.append(
            Figure(
                "lost-motion", 0.0 if worst is None else reach * worst.depth, "mm", None if worst is None else worst.at
            )
        )
    if recipe.follower.kind == "shoe":
        used = [recipe.follower.radius * math.sin(math.atan(slope.value)) for slope in (least, greatest)]
        found.append(Figure("shoe-travel", used[1] - used[0], "mm"))
        found.append(Figure("shoe-from", used[0], "mm", least.at))
        found.append(Figure("shoe-to", used[1], "mm", greatest.at))
    if recipe.groove is not None:
        play, at = greatest_of(lambda u: play_at(design, u), design.total)
        found.append(_displaced(design, "play", play, "", at))
    return [*found, *_driven(design), *_loaded(design, steepest)]


def _displaced(design: LinearDesign, name: str, value: float, per: str, at: float | None) -> Figure:
    """Figure of the follower's displacement, mm or rad, or of a derivative of it, `per` such as /s."""
    unit = design.path.guide.unit
    return Figure(name, math.degrees(value) if unit == "deg" else value, f"{unit}{per}", at)


def _radii(design: LinearDesign) -> list[Figure]:
    """Radii of the path and of the flanks where their metal is convex and where it is hollow, mm."""
    found = []
    for name, flank in design.flanks.items():
        suffix = f"-{name}" if name else ""
        size = abs(flank.distance)
        radius, at = flank.least_radius
        hollow, hollow_at = convex_radius(design.path, -flank.sense)
        finite = math.isfinite(radius)
        found.append(Figure(f"{PITCH_RADIUS}{suffix}", radius, "mm", at if finite else None))
        found.append(Figure(f"{RADIUS}{suffix}", radius - size, "mm", at if finite else None))
        there = math.isfinite(hollow)
        found.append(Figure(f"{HOLLOW_RADIUS}{suffix}", hollow + size, "mm", hollow_at if there else None))
    return found


def play_at(design: LinearDesign, u: Array) -> Array:
    """Play of the roller of a groove, mm or rad (n,), from the lower flank to the upper one, at inputs u (n,), mm.

    Touching the upper flank the roller's centre lies on the parallel of its path a clearance farther out.
    """
    groove, path = design.recipe.groove, design.path
    if groove is None:
        return np.zeros_like(u)
    beside = Parallel(path, -groove.clearance)
    s = path.law.derivatives(u, 0)[0]
    tangent = np.tan(path.pressure_angle(u))
    v, play = u.copy(), groove.clearance * np.sqrt(1.0 + tangent * tangent) / path.guide.reach
    for _ in range(STEPS):
        frame = beside.sample(np.clip(v, 0.0, design.total) if not design.recipe.endless else v)
        centre, way = path.guide.place(u, s + play)
        gap = frame.point - np.column_stack([centre.real, centre.imag])
        along = np.column_stack([np.cos(way), np.sin(way)]) * path.guide.reach
        rate = frame.speed[:, None] * frame.tangent
        # rate dv - along dp = -gap
        turn = rate[:, 0] * -along[:, 1] + along[:, 0] * rate[:, 1]
        dv = (-gap[:, 0] * -along[:, 1] + -along[:, 0] * gap[:, 1]) / turn
        dp = (rate[:, 0] * -gap[:, 1] + gap[:, 0] * rate[:, 1]) / turn
        v, play = v + dv, play + dp
        if np.abs(dp).max() <= 1e-16 * (1.0 + np.abs(play).max()):
            break
    return np.asarray(play)


# --- in time ----------------------------------------------------------------------------------------------------------


def _largest(low: Extreme, high: Extreme) -> tuple[float, float]:
    """The extreme of the greater magnitude: its magnitude and place."""
    worst = high if high.value >= -low.value else low
    return abs(worst.value), worst.at


def speed_extremes(path: CentrePath, order: int) -> tuple[Extreme, Extreme]:
    """Least and greatest derivative of an order of S by the travel."""

    def figure(tau: Series, side: Side = 1) -> Series:
        s = path.law.on(tau, side)
        for _ in range(order):
            s = s.derivative()
        return s

    return both(figure, stretches(path))


def _driven(design: LinearDesign) -> list[Figure]:
    """Greatest velocity and acceleration of the follower in time, under a speed or a crank."""
    drive = design.recipe.drive
    if drive.crank is not None:
        return _cranked(design, drive.crank)
    if drive.forth is None or drive.back is None:
        return []
    fastest = max(drive.forth, drive.back)
    speed, speed_at = _largest(*speed_extremes(design.path, 1))
    bend, bend_at = _largest(*speed_extremes(design.path, 2))
    return [
        _displaced(design, "velocity", speed * fastest, "/s", speed_at),
        _displaced(design, "acceleration", bend * fastest**2, "/s^2", bend_at),
    ]


def crank_angle(crank: CrankDrive, u: Array) -> Array:
    """Angle of the crank from its dead centre at input 0, rad from 0 to pi (n,), at inputs u (n,), mm."""
    x = crank.radius + crank.rod - u
    cosine = (x * x + crank.radius**2 - crank.rod**2) / (2.0 * x * crank.radius)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def crank_travel(crank: CrankDrive, q: Array) -> Array:
    """Input, its first and its second derivative by the crank's angle (3, n), mm, at crank angles q (n,), rad."""
    sine, cosine = np.sin(q), np.cos(q)
    rod = np.sqrt(crank.rod**2 - (crank.radius * sine) ** 2)
    u = crank.radius + crank.rod - (crank.radius * cosine + rod)
    first = crank.radius * sine + crank.radius**2 * sine * cosine / rod
    second = (
        crank.radius * cosine
        + crank.radius**2 * (cosine**2 - sine**2) / rod
        + crank.radius**4 * (sine * cosine) ** 2 / rod**3
    )
    return np.stack([u, first, second])


def motion_under(design: LinearDesign, crank: CrankDrive, q: Array, side: Side = 1) -> Array:
    """S and its first two derivatives by the crank's angle (3, n), mm or rad, at crank angles q (n,), rad."""
    u, first, second = crank_travel(crank, q)
    # rounding may bring an angle at a break to its other side
    knots = np.append(design.path.law.breaks, design.total)
    near = knots[np.abs(u[:, None] - knots).argmin(axis=1)]
    u = np.where(np.abs(u - near) <= SAME * design.total, near, u)
    s, slope, bend = design.path.law.derivatives(u, 2, side)
    return np.stack([s, slope * first, bend * first**2 + slope * second])


def _cranked(design: LinearDesign, crank: CrankDrive) -> list[Figure]:
    """Greatest velocity and acceleration under a crank; its way back is the same backwards."""
    rate = crank.rpm * 2.0 * math.pi / MINUTE
    knots = crank_angle(crank, np.append(design.path.law.breaks, design.total))

    def magnitude(order: int, low: float, high: float, share: Array) -> Array:
        side = np.where(share < 1.0, 1, -1)
        size: Array = np.abs(motion_under(design, crank, low + share * (high - low), side)[order])
        return size

    found = []
    for name, order, unit in (("velocity", 1, "/s"), ("acceleration", 2, "/s^2")):
        peaks = []
        for low, high in pairwise(knots.tolist()):
            value, share = greatest_of(partial(magnitude, order, low, high), 1.0)
            peaks.append((value, low + share * (high - low)))
        best, place = max(peaks)
        travel = float(crank_travel(crank, np.array([place]))[0, 0])
        found.append(_displaced(design, name, best * rate**order, unit, min(max(travel, 0.0), design.total)))
    return found


# --- under load -------------------------------------------------------------------------------------------------------


def _loaded(design: LinearDesign, steepest: tuple[float, float]) -> list[Figure]:
    """Forces under the load of the drive, N, and the pressure of the contact, N/mm^2."""
    drive, recipe = design.recipe.drive, design.recipe
    if drive.load is None:
        return []
    push, push_at = _largest(*speed_extremes(design.path, 1))
    reach = design.path.guide.reach
    found = [
        Figure("contact-force", drive.load / math.cos(math.radians(steepest[0])), "N", steepest[1]),
        Figure("drive-force", drive.load * reach * push, "N", push_at),
    ]
    width = recipe.plate.thickness if drive.width is None else drive.width
    if drive.material is None or width is None or not recipe.follower.radius:
        return found
    plate, roller = drive.material, drive.roller_material or drive.material
    flank = design.lower

    def pressure(u: Array) -> Array:
        frame = flank.shape.sample(u)
        with np.errstate(divide="ignore", invalid="ignore"):
            bend = np.where(frame.speed > 0.0, frame.turn / frame.speed, 0.0)
        tangent = np.tan(design.path.pressure_angle(u))
        force = drive.load * np.sqrt(1.0 + tangent * tangent)
        return line_pressure(force, 1.0 / recipe.follower.radius + bend, width, plate, roller)

    value, at = greatest_of(pressure, design.total)
    return [*found, Figure("contact-pressure", value, "N/mm^2", at)]


def bears(design: LinearDesign) -> float | None:
    """Permissible pressure of the contact, N/mm^2: the lesser of both materials; None where neither states one."""
    drive = design.recipe.drive
    return bearable(drive.material, drive.roller_material)
