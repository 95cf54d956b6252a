"""Programs of a machine that turns the drum under its cutter: X along the drum, A about it, Z towards it, Y beside it.

Each flank has its way, or one way serves both (`camgeo.capabilities.cylindrical.ways`), over all turns after which the
motion repeats. Between blocks all axes move evenly; how far that is off is bounded by the second derivative of the way.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.figures import steepest
from camgeo.capabilities.cylindrical.ways import (
    ENDS,
    NEAR,
    TAPERS,
    Cutter,
    Off,
    Way,
    set_alike,
    set_beside,
    set_radially,
)
from camgeo.common.rounding import downward, upward
from camgeo.fit.bound import Bound
from camgeo.fit.parted import parted
from camgeo.machining.turned import CHORDS, Cut, TurnedWork, down
from kin.numeric.records import replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.errors import RecipeErrors
    from kin.numeric.arrays import Array

SETTING = 0.4  # of the tolerance, that a smaller cutter may be off by where it is not set
OVERLAP = math.radians(5.0)  # by which a pass goes on beyond a turn
CORNER = 1e-7  # mm per rad: a jump of the velocity below this is rounding
DIGITS = 4  # of a half angle in a remedy, degrees
LEAST_ROOM = 0.01  # mm off a flank, below which the cutter goes down on it
BESIDE = 0.5  # of the cutter's radius, off a flank, where it goes down


class Step(NamedTuple):
    """A pass: the way, how far out its end is, mm, and what it is."""

    way: Way
    z: float
    name: str


class _Plan(NamedTuple):
    """Steps in their order, and the greatest metal, mm, that their ways leave and that they cut too deep."""

    steps: list[Step]
    off: Bound


def _key(design: DrumDesign, request: FileRequest, name: str) -> str:
    """Path of an option of a requested program."""
    return f"{design.recipe.field_of(request)}.{request.kind}.{name}"


def write_program(
    design: DrumDesign, request: FileRequest, path: Path, tolerance: float, mm: float
) -> tuple[int, Bound]:
    """Write a program; its number of blocks, and the bound of what it leaves and cuts too deep.

    Raises RecipeErrors for a cutter that does not leave the flanks within the tolerance, too many passes and too few
    decimals; OSError where it cannot be written.
    """
    recipe = design.recipe
    work = TurnedWork(
        recipe, request, recipe.radius, recipe.track.depth, mm, partial(_rounding, design, request, mm=mm)
    )
    count = work.places(tolerance)
    within = tolerance - work.rounded(count)
    plan = _planned(design, request, work, within)
    chords = CHORDS * (within - plan.off.worst)
    passes = [(step, *_points(design, step.way, chords)) for step in plan.steps]
    cuts = [Cut(points, step.z, step.name) for step, points, _ in passes]
    blocks = work.write(path, count, _head(design, work, tolerance), cuts)
    worst = max(off for _, _, off in passes)
    return blocks, plan.off.widened(worst + work.rounded(count))


# --- which passes -----------------------------------------------------------------------------------------------------


def _planned(design: DrumDesign, request: FileRequest, work: TurnedWork, within: float) -> _Plan:
    recipe, own = design.recipe, request.own
    beside, cutter = work.beside, Cutter(0.5 * own["cutter"], own.get("taper", 0.0))
    flanks = _own_ways(design, cutter, within, beside)
    _demand_known(design, flanks, _key(design, request, "cutter"))
    finish: list[tuple[str, Way]] = []
    left = deep = 0.0
    refused: list[tuple[Way, Off, float]] = []
    ends = recipe.roller.inner, recipe.radius
    for name, way in flanks:
        if way.alike:
            own_way, off = set_alike(way, ends)
            ways = [own_way]
        elif beside:
            ways, off = set_beside(way.flank, cutter, recipe.floor, ends, SETTING * within)
        elif way.flank.radial:
            own_way, off = set_radially(way.flank, cutter, steepest(design)[0], ends)
            ways = [replace(own_way, end=recipe.floor)]
        else:
            raise _needs_beside(design, request, way)
        finish += [(name, each) for each in ways]
        left, deep = max(left, off.left), max(deep, off.deep)
        if max(off) > SETTING * within:
            refused.append((way, off, max(off) / (SETTING * within)))
    if refused:
        raise _refused(design, request, refused)
    steps = _rough(design, request, work, flanks) if "allowance" in own else []
    if steps:
        steps += [Step(way, way.end, f"{name}, last") for name, way in finish]
        work.demand_few(len(steps), flanks, len(finish))
    else:
        steps = [Step(way, z, name) for name, way, z in down(recipe.radius, work.cut, finish)]
        work.demand_few(len(steps), finish)
    return _Plan(steps, Bound(left, deep))


def _own_ways(design: DrumDesign, cutter: Cutter, within: float, beside: bool) -> list[tuple[str, Way]]:
    """Flanks that have a way of their own, each with that of a cutter in its roller's place, on the floor.

    Both of a groove have one if the cutter is as large as their roller. The end of a cutter with the roller's taper may
    stand a share of the tolerance off the floor, so that both cones are one.
    """
    recipe = design.recipe
    end, near = recipe.floor, 0.0
    if cutter.taper:
        apart = recipe.roller.size(end) - cutter.radius
        most, near = ENDS * within, NEAR * within
        end -= min(max(apart / math.tan(cutter.taper), -most), most)
    ways = [
        (f"{name} flank", Way(flank, cutter, recipe.radius, beside, end, near)) for name, flank in design.flanks.items()
    ]
    if not all(way.alike for _, way in ways):  # a smaller one goes down to the floor
        ways = [(name, way if way.alike else replace(way, end=recipe.floor)) for name, way in ways]
    if recipe.track.same_roller and ways[0][1].alike:
        return [(recipe.track.noun, ways[0][1])]
    return ways


def _demand_known(design: DrumDesign, flanks: list[tuple[str, Way]], field: str) -> None:
    """Raise RecipeErrors for a smaller cutter where a flank is cut short, or has a corner."""
    recipe = design.recipe
    cornered = len(design.law.breaks) and np.abs(design.law.jumps(1)[1][1]).max() > CORNER
    if all(way.alike for _, way in flanks) or not (any(design.tips.values()) or cornered):
        return
    why = "a corner of the motion" if cornered else "an undercut"
    if recipe.track.clearance:
        raise design.error("cam.track.groove.clearance", f"with {why}, a program cuts no clearance", "leave it out")
    raise design.error(
        field, f"with {why}, only a cutter as large as the roller leaves the flank", f"give {_like(design)}"
    )


def _like(design: DrumDesign) -> str:
    """Words of the cutter that is as large as the roller."""
    recipe = design.recipe
    size, roller = 2.0 * recipe.roller.size(recipe.floor) / recipe.mm, recipe.roller
    if not roller.taper:
        return f"{size:.9g} {recipe.units}"
    return f"cutter: {downward(size, 7)}, taper: {math.degrees(roller.taper):.{DIGITS}f}"


def _needs_beside(design: DrumDesign, request: FileRequest, way: Way) -> RecipeErrors:
    """Error of a cutter that would have to stand beside the drum's axis."""
    problem = "with its axis through the drum's, only a cutter as large as the roller leaves such a flank"
    remedy = "let the machine move across the drum: axes: [X, Y, A]"
    if way.flank.guide.radial:
        remedy = f"{remedy}, or give {_like(design)}"
    return design.recipe.error(_key(design, request, "axes"), problem, None, remedy)


def _refused(design: DrumDesign, request: FileRequest, refused: list[tuple[Way, Off, float]]) -> RecipeErrors:
    """Error of a cutter that is off on flanks, on each by so many times what it may; its remedies serve for all."""
    way, off, over = max(refused, key=lambda each: each[2])
    recipe, flank = design.recipe, way.flank
    remedies = [] if way.beside else ["let the machine move across the drum: axes: [X, Y, A]"]
    tolerance = recipe.tolerance(request) * over / 0.95 / recipe.mm
    if way.alike:
        far = f"{max(off) / recipe.mm:.3g} {recipe.units}"
        problem = f"with its axis through the drum's, and the roller's beside it, the cutter may be off by {far}"
        remedies.append(f"give a tolerance of at least {upward(tolerance, 3)} {recipe.units}")
        return recipe.error(_key(design, request, "axes"), problem, None, ", or ".join(remedies))
    if abs(flank.taper - way.cutter.taper) > TAPERS:
        remedies.append(f"give {_like(design)}")
    else:
        least = max(each.flank.radius - 0.95 * each.less / times for each, _, times in refused)
        size = recipe.roller.size(recipe.floor) - recipe.roller.radius + least
        if least <= recipe.roller.radius - request.own.get("allowance", 0.0):
            remedies.append(f"give a cutter of at least {upward(2.0 * size / recipe.mm, 5)} {recipe.units}")
    remedies.append(
        "give a greater tolerance"  # with more depths the error falls, by no share that is known before
        if way.beside
        else f"give a tolerance of at least {upward(tolerance, 3)} {recipe.units}"
    )
    problem = (
        "in as many depths as are made it still leaves more than the tolerance"
        if way.beside
        else "with its axis through the drum's it is right at one radius alone, and cuts too deep above that"
    )
    value = f"{2.0 * way.cutter.radius / recipe.mm:.9g} {recipe.units}"
    return recipe.error(_key(design, request, "cutter"), problem, value, ", or ".join(remedies))


def _rough(design: DrumDesign, request: FileRequest, work: TurnedWork, flanks: list[tuple[str, Way]]) -> list[Step]:
    """Passes that leave the allowance on each flank, down to the floor."""
    recipe, own = design.recipe, request.own
    middle, ways = 0.5 * (recipe.roller.inner + recipe.radius), []
    for name, way in flanks:
        less = own["allowance"] / math.cos(way.flank.taper)
        # a cutter that tapers less than its roller touches that at its end
        at = middle if way.cutter.taper >= way.flank.taper else way.end
        rough = replace(way, flank=replace(way.flank, radius=way.flank.radius - less), at=at)
        if not (way.beside or rough.flank.radial):
            problem = "with its axis through the drum's, no pass leaves any of a roller that is a cone or beside it"
            remedy = "leave it out, or let the machine move across the drum: axes: [X, Y, A]"
            raise recipe.error(_key(design, request, "allowance"), problem, None, remedy)
        ways.append((f"{name}, rough", rough))
    return [Step(way, z, name) for name, way, z in down(recipe.radius, work.cut, ways)]


# --- points and words -------------------------------------------------------------------------------------------------


def _points(design: DrumDesign, way: Way, chords: float) -> tuple[Array, float]:
    """Points (n, 3) of a way over a period and more: A, rad, X and Y, mm; and how far lines between them are off, mm.

    The cutter comes and goes off its flank, and climbs along it.
    """
    look, bend = way.bends(design.recipe.radius)
    theta, off = parted(look, bend, chords)
    end = way.flank.period
    theta = np.concatenate([theta, [end], theta[(theta > 0.0) & (theta < OVERLAP)] + end, [end + OVERLAP]])
    if way.flank.side > 0:  # metal on the right of a cutter that turns clockwise
        theta = theta[::-1]
    if design.recipe.mirrored:
        theta = theta[::-1]
    a, x, y = way.places(theta)
    less = BESIDE * way.cutter.radius if design.recipe.track.unmilled else way.less
    away = -way.flank.side * less
    if less > LEAST_ROOM:
        a, y = (np.concatenate([row[:1], row, row[-1:]]) for row in (a, y))
        x = np.concatenate([[x[0] + away], x, [x[-1] + away]])
    points = np.column_stack([a, x, y])
    if design.recipe.mirrored:
        points *= [-1.0, 1.0, -1.0]
    return points, off


def _rounding(design: DrumDesign, request: FileRequest, count: int, *, mm: float) -> float:
    """Greatest error of a flank, mm, by words of so many decimals."""
    recipe, own = design.recipe, request.own
    # turned by so much the cutter moves along its flank as much as that rises
    turned = (
        min(steepest(design)[0], recipe.radius) if recipe.guide.radial and not recipe.roller.taper else recipe.radius
    )
    along = mm + math.radians(1.0) * turned + (mm if "Y" in own["axes"] else 0.0)
    return 0.5 * 10.0**-count * (along + mm * math.tan(own.get("taper", 0.0)))


def _head(design: DrumDesign, work: TurnedWork, tolerance: float) -> list[str]:
    recipe = design.recipe
    sense = "counter-clockwise" if recipe.rotation == "cw" else "clockwise"
    about = [
        "A zero: the roller's place at shaft angle 0, from which the keyway's angle counts",
        f"A goes on over all {recipe.turns} turns of the motion" if recipe.turns > 1 else "",
        f"the follower goes round it {sense}",
    ]
    left = recipe.track.unmilled
    told = f"not milled: the drum {left} farther off the flank than the cutter is wide" if left else ""
    return [*work.head(tolerance, "drum", about), told]
