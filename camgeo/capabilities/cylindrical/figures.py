"""Figures of a cylindrical cam, each with its shaft angle: of the exact flanks, of the drive in time, of its load."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.cylindrical.crossings import lost_of
from camgeo.capabilities.cylindrical.grid import breaks_of, parts_between
from camgeo.capabilities.cylindrical.shoe import angle_of, play, twist
from camgeo.capabilities.cylindrical.undercut import below
from camgeo.curve.extremes import both
from camgeo.measures.hertz import bearable, line_pressure
from camgeo.measures.placed import Figure
from camgeo.recipe.figures import PRESSURE_ANGLE
from kin.numeric.angles import TURN

if TYPE_CHECKING:
    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.capabilities.cylindrical.flank import Flank, Pose
    from camgeo.curve.curve import Side
    from camgeo.curve.extremes import Extreme
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array

MINUTE = 60.0
CONTACT_PRESSURE = "contact-pressure"
MIDDLE, OUTER = f"{PRESSURE_ANGLE}-middle", f"{PRESSURE_ANGLE}-outer"
ALONG = 9  # places along a line of contact at which a greatest figure is sought
RADII, PLACES = 24, 24  # of Gauss from floor to blank, and in each part of the turn, over which a volume is integrated
PARTS = 12  # of a turn, over each of which places of Gauss are taken
NEWTON = 40  # halvings of the angle at which a flank is touched


def slopes(design: DrumDesign, order: int = 1) -> tuple[Extreme, Extreme]:
    """Least and greatest derivative of S of an order by the radian, mm or rad."""

    def figure(tau: Series, side: Side = 1) -> Series:
        s = design.law.on(tau, side)
        for _ in range(order):
            s = s.derivative()
        return s

    knots = breaks_of(next(iter(design.flanks.values())))
    return both(figure, np.column_stack([knots[:-1], knots[1:]]))


def steepest(design: DrumDesign, order: int = 1) -> tuple[float, float]:
    """Greatest magnitude of a derivative of S by the radian, mm or rad, and its shaft angle, rad."""
    low, high = slopes(design, order)
    worst = high if high.value >= -low.value else low
    return abs(worst.value), worst.at


def outer_end(design: DrumDesign, name: str, theta: Array) -> Array:
    """Distance along the roller (n,), mm, at which contact with a flank ends outside: at its end, or the blank's."""
    return _outer_end(design, name, design.flanks[name].pose(theta))


def _outer_end(design: DrumDesign, name: str, pose: Pose) -> Array:
    """`outer_end` at poses."""
    recipe = design.recipe
    return np.minimum(recipe.roller.outer, design.flanks[name].reached(pose, recipe.radius))


def carried_from(design: DrumDesign, name: str, theta: Array) -> Array:
    """Distance along the roller (n,), mm, from which on a flank carries it: from its inner end, or beyond a cut."""
    flank = design.flanks[name]
    rho = np.full(theta.shape, design.recipe.roller.inner)
    for cut in design.cuts[name]:
        half = 0.5 * design.recipe.period
        offset = np.mod(theta - cut.tip.at + half, 2.0 * half) - half
        r = np.append(cut.r, cut.tip.r)
        for ends, sign in ((cut.first, -1.0), (cut.last, 1.0)):
            # from the tip inwards the ends of what is lost lie farther and farther from it
            away = sign * np.append(ends - cut.tip.at, 0.0)
            within = (sign * offset >= 0.0) & (sign * offset <= away[0])
            depth = np.interp(sign * offset[within], away[::-1], np.sqrt(cut.tip.r - r)[::-1])
            reached = flank.on(theta[within], cut.tip.r - depth * depth).rho
            rho[within] = np.maximum(rho[within], reached)
    return rho


def contact_length(design: DrumDesign, name: str, theta: Array) -> Array:
    """Length (n,), mm, of the line along which a flank carries the roller; below 0 where nothing carries."""
    return outer_end(design, name, theta) - carried_from(design, name, theta)


def figures_of(design: DrumDesign) -> list[Figure]:
    """All figures that a design has, in the order of reports."""
    recipe = design.recipe
    angles = steepest_contacts(design)
    found = [Figure(name, math.degrees(angle), "deg", math.degrees(at)) for name, (angle, at) in angles.items()]
    found += _carrying(design)
    if recipe.swings:
        found.append(_off_radius(design))
    if "play" in recipe.track.figures:
        play, place = design.greatest(lambda theta: play_at(design, theta))
        found.append(_displaced(design, "play", play, "", math.degrees(place)))
    if "rib-thickness" in recipe.track.figures:
        thickness, thin = design.greatest(lambda theta: -rib_thickness(design, theta, recipe.floor))
        found.append(Figure("rib-thickness", -thickness, "mm", math.degrees(thin)))
    found += [*_crossed(design), *_boat(design)]
    steep = angles[PRESSURE_ANGLE]
    return [*found, *_curved(design), *_driven(design), *_loaded(design, steep), *_heavy(design)]


def _crossed(design: DrumDesign) -> list[Figure]:
    """Number of crossings, the least angle between their tracks, and the longest gap in a wall."""
    if not design.crossings:
        return []
    flat = min(design.crossings, key=lambda each: (angle_of(design, each), each.first))
    gap, back = max(zip(design.gaps, [-each.first for each in design.crossings], strict=True))
    return [
        Figure("crossings", len(design.crossings), "", None),
        Figure("crossing-angle", math.degrees(angle_of(design, flat)), "deg", math.degrees(flat.first)),
        Figure("crossing-gap", gap, "mm", math.degrees(-back)),
    ]


def _boat(design: DrumDesign) -> list[Figure]:
    """Play of a shoe in its crossings, and the play that it needs as its track's slope changes along its pin."""
    if design.recipe.roller.shoe is None:
        return []
    found = []
    if design.crossings:
        value, crossing = play(design)
        found.append(Figure("shoe-play", value, "mm", math.degrees(crossing.first)))
    value, at = twist(design)
    return [*found, Figure("shoe-twist", value, "mm", math.degrees(at))]


def _displaced(design: DrumDesign, name: str, value: float, per: str, at: float | None) -> Figure:
    """Figure of the follower's displacement, mm or rad, or of a derivative of it, `per` such as /s."""
    unit = design.recipe.guide.unit
    return Figure(name, math.degrees(value) if design.recipe.swings else value, f"{unit}{per}", at)


def steepest_contacts(design: DrumDesign) -> dict[str, tuple[float, float]]:
    """Greatest pressure angles, rad, and their shaft angles, rad: of all contacts, half way along, and where they end.

    Along a cylinder tan alpha is a straight line over 1/rho, so that it is greatest at an end.
    """
    roller = design.recipe.roller
    middle = 0.5 * (roller.inner + roller.outer)

    def at(rho: float | None) -> tuple[float, float]:
        def angle(theta: Array, name: str) -> Array:
            flank = design.flanks[name]
            pose = flank.pose(theta)
            ends = _outer_end(design, name, pose) if rho is None else np.full_like(theta, rho)
            return np.asarray(np.abs(flank.steepness(pose, ends)))

        return max(design.greatest(partial(angle, name=name)) for name in design.flanks)

    inner, half, outer = at(roller.inner), at(middle), at(None)
    return {PRESSURE_ANGLE: max(inner, outer), MIDDLE: half, OUTER: outer}


def play_at(design: DrumDesign, theta: Array) -> Array:
    """Play of the roller of a groove at shaft angles (n,), mm or rad, to first order in the clearance.

    It is the clearance over cos alpha where that is least along the line of contact.
    """
    clearance, flank = design.recipe.track.clearance, design.flanks["upper"]
    pose = flank.pose(theta)
    angles = np.abs(flank.steepness(pose, _along(design, "upper", theta, pose)))
    return np.asarray(clearance / np.cos(angles.min(axis=0)) / flank.guide.reach)


def _off_radius(design: DrumDesign) -> Figure:
    """Greatest distance of a roller's axis on an arm from a radius of the drum."""

    def off(theta: Array) -> Array:
        return np.asarray(np.max([np.abs(flank.pose(theta).y) for flank in design.flanks.values()], axis=0))

    value, at = design.greatest(off)
    return Figure("off-radius", value, "mm", math.degrees(at))


def _carrying(design: DrumDesign) -> list[Figure]:
    """Least length of the line of contact and its share, and how far out undercut reaches."""
    least = []
    for name in design.flanks:
        value, at = design.greatest(lambda theta, name=name: -contact_length(design, name, theta))  # type: ignore[misc]
        whole = float(outer_end(design, name, np.array([at]))[0]) - design.recipe.roller.inner
        least.append((-value, max(-value, 0.0) / whole, math.degrees(at)))
    length, share, place = min(least)
    found = [Figure("contact-length", max(length, 0.0), "mm", place), Figure("carrying-share", share, "", place)]
    if design.recipe.shortens:
        ends = design.recipe.floor, design.recipe.radius
        cut = [below(flank, *ends) for name, flank in design.flanks.items() if design.tips[name]]
        reach, beside = max(cut, default=(0.0, math.nan))
        found.append(Figure("undercut-radius", reach, "mm", math.degrees(beside) if cut else None))
    return found


def rib_thickness(design: DrumDesign, theta: Array, r: float) -> Array:
    """Thickness (n,) of a rib along the axis, mm, on the cylinder r, mm, with its upper roller at theta (n,), rad."""
    upper, lower = design.flanks["lower"], design.flanks["upper"]
    contact = upper.on(theta, r)
    other = at_angle(lower, contact.phi, r, theta)
    return contact.z - lower.on(other, r).z


def at_angle(flank: Flank, phi: Array, r: float, theta: Array) -> Array:
    """Shaft angles (n,), rad, at which a flank on the cylinder r, mm, is touched at polar angles (n,), from a guess."""
    low, high = theta - 0.5 * math.pi, theta + 0.5 * math.pi
    for _ in range(NEWTON):  # on a regular flank the polar angle rises
        middle = 0.5 * (low + high)
        less = flank.polar(middle, r) < phi
        low, high = np.where(less, middle, low), np.where(less, high, middle)
    return 0.5 * (low + high)


def _curved(design: DrumDesign) -> list[Figure]:
    """Least radius of both bodies together across the line of contact, mm; none where a cut leaves a sharp edge."""
    if any(design.tips.values()):
        return []
    worst = [design.greatest(lambda theta, name=name: _sharpest(design, name, theta)) for name in design.flanks]  # type: ignore[misc]
    curvature, at = max(worst)
    return [Figure("mating-radius", 1.0 / curvature if curvature > 0.0 else math.inf, "mm", math.degrees(at))]


def _along(design: DrumDesign, name: str, theta: Array, pose: Pose) -> Array:
    """Distances (ALONG, n) along the line that carries, mm, at shaft angles (n,), rad, and their poses."""
    begin, end = carried_from(design, name, theta), _outer_end(design, name, pose)
    share = np.linspace(0.0, 1.0, ALONG)[:, None]
    return np.minimum(begin, end) * (1.0 - share) + end * share


def _sharpest(design: DrumDesign, name: str, theta: Array) -> Array:
    """Greatest sum of curvatures along the line of contact (n,), 1/mm."""
    pose = design.flanks[name].pose(theta)
    sharpest: Array = _bent(design, name, pose, _along(design, name, theta, pose)).max(axis=0)
    return sharpest


def _bent(design: DrumDesign, name: str, pose: Pose, rho: Array) -> Array:
    """Sums of curvatures (m, n), 1/mm, at poses and distances rho (m, n) along the line of contact, mm."""
    flank, roller = design.flanks[name], design.recipe.roller
    # a shoe's side is bent less than a roller
    less = 1.0 / flank.radius - 1.0 / (roller.side + flank.radius - roller.radius)
    return np.maximum(flank.bent(pose, rho) - less, 0.0)


# --- in time, under load ----------------------------------------------------------------------------------------------


def _driven(design: DrumDesign) -> list[Figure]:
    """Greatest velocity and acceleration of the follower in time."""
    rpm = design.recipe.drive.rpm
    if rpm is None:
        return []
    rate = rpm * TURN / MINUTE
    found = []
    for order, name, per in ((1, "velocity", "/s"), (2, "acceleration", "/s^2")):
        value, at = steepest(design, order)
        found.append(_displaced(design, name, value * rate**order, per, math.degrees(at)))
    return found


def _loaded(design: DrumDesign, steep: tuple[float, float]) -> list[Figure]:
    """Forces under the load, N, the torque, N m, and the pressure of the contact, N/mm^2.

    Force and thrust are those of a load that the steepest contact carries alone, its pressure angle and shaft angle in
    rad; for the pressure the load is spread evenly along the line. A line that a cut shortens begins at a sharp edge,
    where no pressure is known: there is that half way along it alone.
    """
    recipe, drive = design.recipe, design.recipe.drive
    if drive.load is None:
        return []
    (rate, at), (angle, place), taper = steepest(design), steep, recipe.roller.taper
    across = drive.load / math.cos(angle)
    reach = max(flank.guide.reach for flank in design.flanks.values())
    found = [
        Figure("contact-force", across / math.cos(taper), "N", math.degrees(place)),
        Figure("side-thrust", drive.load * math.tan(angle), "N", math.degrees(place)),
    ]
    if taper:
        found.append(Figure("axial-thrust", across * math.tan(taper), "N", math.degrees(place)))
    found.append(Figure("torque", 1e-3 * drive.load * rate * reach, "N m", math.degrees(at)))
    if drive.material is None:
        return found
    load, drum, roller = drive.load, drive.material, drive.roller_material or drive.material

    def pressure(theta: Array, name: str, along: slice) -> Array:
        flank = design.flanks[name]
        pose = flank.pose(theta)
        length = _outer_end(design, name, pose) - carried_from(design, name, theta)
        rho = _along(design, name, theta, pose)[along]
        curvature, force = _bent(design, name, pose, rho), load / np.cos(flank.steepness(pose, rho)) / math.cos(taper)
        width = np.where(length > 0.0, length, np.inf)
        found: Array = line_pressure(force * curvature / width, np.ones_like(force), 1.0, drum, roller).max(axis=0)
        return found

    names = {CONTACT_PRESSURE: slice(None), f"{CONTACT_PRESSURE}-middle": slice(ALONG // 2, ALONG // 2 + 1)}
    if any(design.tips.values()):
        del names[CONTACT_PRESSURE]
    for figure, along in names.items():
        value, at = max(design.greatest(partial(pressure, name=name, along=along)) for name in recipe.track.carrying)
        found.append(Figure(figure, value, "N/mm^2", math.degrees(at)))
    return found


def bears(design: DrumDesign) -> float | None:
    """Permissible pressure of the contact, N/mm^2: the lesser of both materials; None where neither states one."""
    drive = design.recipe.drive
    return bearable(drive.material, drive.roller_material)


# --- volume -----------------------------------------------------------------------------------------------------------


def _heavy(design: DrumDesign) -> list[Figure]:
    density = design.recipe.part.density
    return [] if density is None else [Figure("mass", volume(design) * density * 1e-9, "kg")]


def volume(design: DrumDesign) -> float:
    """Volume of the exact drum, mm^3: of its core, and of what stands round it, integrated cylinder by cylinder."""
    recipe = design.recipe
    floor, blank, height = recipe.floor, recipe.radius, recipe.height
    bore = 0.0 if design.bore is None else design.bore.outline.area
    node, weight = np.polynomial.legendre.leggauss(RADII)
    r = floor + 0.5 * (blank - floor) * (node + 1.0)
    flanks = {name: _areas(design, name, r) for name in design.flanks}
    stands = flanks.get("lower", np.zeros_like(r))
    if recipe.track.rising[-1] == "upper":
        stands = stands + TURN * r * height
    stands = stands - flanks.get("upper", 0.0)
    round_it = 0.5 * (blank - floor) * float(np.sum(weight * stands))
    return (math.pi * floor**2 - bore) * height + round_it


def _areas(design: DrumDesign, name: str, r: Array) -> Array:
    """Integrals of z over the turn of a flank on cylinders r (k,), mm^2: from the lower face to the flank."""
    flank = design.flanks[name]
    node, weight = np.polynomial.legendre.leggauss(PLACES)
    kept = [_kept(design, name, radius) for radius in r.tolist()]
    count = np.array([len(stretches) for stretches in kept])
    low, high = np.concatenate([np.array(stretches) for stretches in kept]).T
    half, radius = 0.5 * (high - low), np.repeat(r, count)
    theta = (low + half)[:, None] + half[:, None] * node
    contact = flank.on(theta.ravel(), np.repeat(radius, PLACES))
    parts = (contact.z * flank.sweep(contact, theta.ravel())).reshape(theta.shape) @ weight
    return r * np.add.reduceat(half * parts, np.cumsum(count) - count)


def _kept(design: DrumDesign, name: str, radius: float) -> list[tuple[float, float]]:
    """Stretches of shaft angles, rad, without a break, on which a flank on a cylinder is not cut away."""
    knots = parts_between(breaks_of(design.flanks[name]), PARTS)
    lost: list[tuple[float, float]] = []
    period = design.recipe.period
    for cut in design.cuts[name]:
        if radius < cut.tip.r:
            first, last = cut.at(np.array([radius]))
            lost += [(float(first[0]) + turn, float(last[0]) + turn) for turn in (-period, 0.0, period)]
    for each in lost_of(design.crossings, name):
        begin, end = (float(angle[0]) for angle in each.over(np.array([radius])))
        lost += [(begin + turn, end + turn) for turn in (-2.0 * period, -period, 0.0, period)]
    inside = [each for pair in lost for each in pair if knots[0] < each < knots[-1]]
    ends = np.unique(np.concatenate([knots, inside]))
    return [
        (low, high)
        for low, high in pairwise(ends.tolist())
        if not any(begin < 0.5 * (low + high) < end for begin, end in lost)
    ]
