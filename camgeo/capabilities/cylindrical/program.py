"""Programs of a machine that turns the drum under its cutter: X along the drum, A about it, Z towards it, Y beside it.

Each flank has its way, or one way serves both (`camgeo.capabilities.cylindrical.ways`), over all turns after which the
motion repeats. Between blocks all axes move evenly; how far that is off is bounded by the second derivative of the way.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from camgeo.capabilities.cylindrical.angles import parted
from camgeo.capabilities.cylindrical.figures import steepest
from camgeo.capabilities.cylindrical.keys import INVERSE, MOST_PLACES
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
from camgeo.files.gcode import SHARE, comment, feed_text, plain
from camgeo.fit.bound import Bound
from kin.numeric.records import replace
from kin.read.gcode import LARGEST
from kin.turned.checks import Cutting

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from camgeo.capabilities.cylindrical.design import DrumDesign
    from camgeo.recipe.export import FileRequest
    from camgeo.schema.errors import RecipeErrors
    from kin.numeric.arrays import Array

SETTING = 0.4  # of the tolerance, that a smaller cutter may be off by where it is not set
CHORDS = 0.6  # of what the setting and rounding leave of it, for lines between blocks: the judge's proof takes some
OVERLAP = math.radians(5.0)  # by which a pass goes on beyond a turn
ROUNDED = 0.5  # of the tolerance, that words of few decimals may take
FEWEST = 3  # decimals, where a recipe does not ask for a number
CORNER = 1e-7  # mm per rad: a jump of the velocity below this is rounding
DIGITS = 4  # of a half angle in a remedy, degrees
LEAST_ROOM = 0.01  # mm off a flank, below which the cutter goes down on it
BESIDE = 0.5  # of the cutter's radius, off a flank, where it goes down
MOST_PASSES = 2000


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


def cutting_of(design: DrumDesign, request: FileRequest) -> Cutting:
    """How a requested program cuts, in kin's words."""
    own = request.own
    depth = own.get("depth_of_cut", design.recipe.track.depth)
    inverse = own.get("feed_mode", INVERSE) == INVERSE
    return Cutting(0.5 * own["cutter"], own["feed"], inverse, depth, own.get("taper", 0.0))


def write_program(
    design: DrumDesign, request: FileRequest, path: Path, tolerance: float, mm: float
) -> tuple[int, Bound]:
    """Write a program; its number of blocks, and the bound of what it leaves and cuts too deep.

    Raises RecipeErrors for a cutter that does not leave the flanks within the tolerance, too many passes and too few
    decimals; OSError where it cannot be written.
    """
    own = request.own
    count = _places(design, request, tolerance, mm)
    within = tolerance - _rounding(design, request, count, mm)
    plan = _planned(design, request, within)
    written = _Written(design, own, count, mm)
    chords = CHORDS * (within - plan.off.worst)
    passes = [(step, *_points(design, step.way, chords)) for step in plan.steps]
    lines = [*_head(design, request, tolerance, mm), *written.begun()]
    high = (design.recipe.radius + own["safe_height"]) / mm
    if high > LARGEST:
        most = downward((LARGEST * mm - design.recipe.radius) / design.recipe.mm, 4)
        why = "lies higher than a program tells"
        raise design.recipe.error(
            _key(design, request, "safe_height"), why, None, f"give at most {most} {design.recipe.units}"
        )
    for k, (step, points, _) in enumerate(passes, start=1):
        lines.append(f"({comment(f'{step.name}, pass {k} of {len(passes)}')})")
        lines += written.cut(step, points)
    if written.fastest > LARGEST:
        most = downward(own["feed"] * LARGEST / written.fastest / design.recipe.mm, 4)
        why = "makes the inverse time of the shortest block larger than is read"
        remedy = f"give at most {most}, or feed_mode: per-minute"
        raise design.recipe.error(_key(design, request, "feed"), why, None, remedy)
    lines += ["G94", "M5", "M30", ""]
    path.write_bytes("\n".join(lines).encode("ascii"))
    worst = max(off for _, _, off in passes)
    return written.blocks, plan.off.widened(worst + _rounding(design, request, count, mm))


# --- which passes -----------------------------------------------------------------------------------------------------


def _planned(design: DrumDesign, request: FileRequest, within: float) -> _Plan:
    recipe, own = design.recipe, request.own
    beside, cutter = "Y" in own["axes"], Cutter(0.5 * own["cutter"], own.get("taper", 0.0))
    cut = own.get("depth_of_cut", recipe.track.depth)
    flanks = _own_ways(design, cutter, within, beside)
    _demand_known(design, flanks, _key(design, request, "cutter"))
    finish: list[tuple[str, Way]] = []
    left = deep = 0.0
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
            raise _refused(design, request, way, off, max(off) / (SETTING * within))
    steps = _rough(design, request, flanks) if "allowance" in own else []
    if steps:
        steps += [Step(way, way.end, f"{name}, last") for name, way in finish]
    else:
        steps = [Step(way, z, name) for name, way, z in _down(recipe.radius, cut, finish)]
    if len(steps) > MOST_PASSES:
        least = cut * len(steps) / MOST_PASSES / recipe.mm
        remedy = f"give at least {upward(least, 4)} {recipe.units}"
        field = _key(design, request, "depth_of_cut")
        raise recipe.error(field, f"makes more than {MOST_PASSES} passes", None, remedy)
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


def _refused(design: DrumDesign, request: FileRequest, way: Way, off: Off, over: float) -> RecipeErrors:
    """Error of a cutter that is off by `over` times what it may."""
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
        least = flank.radius - 0.95 * way.less / over
        size = recipe.roller.size(recipe.floor) - recipe.roller.radius + least
        if least <= recipe.roller.radius:
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


def _rough(design: DrumDesign, request: FileRequest, flanks: list[tuple[str, Way]]) -> list[Step]:
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
    cut = own.get("depth_of_cut", recipe.track.depth)
    return [Step(way, z, name) for name, way, z in _down(recipe.radius, cut, ways)]


def _down(blank: float, cut: float, ways: list[tuple[str, Way]]) -> list[tuple[str, Way, float]]:
    """Ways with how far out their ends are, mm, in steps of at most `cut` from the blank to the depth of each.

    At a depth the first way of each name goes that reaches down to it.
    """
    floor = min(way.end for _, way in ways)
    depths = sorted({way.end for _, way in ways}, reverse=True)
    levels: list[float] = []
    for z in depths:
        above = levels[-1] if levels else blank
        parts = max(math.ceil((above - z) / cut * (1.0 - 1e-9)), 1)
        levels += [above - (above - z) * k / parts for k in range(1, parts + 1)]
    found = []
    for level in levels:
        for name in dict.fromkeys(name for name, _ in ways):
            own = [way for each, way in ways if each == name]
            way = next((each for each in own if each.end <= level + 1e-9), own[-1])
            found.append((name, way, max(level, floor)))
    return found


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


def _rounding(design: DrumDesign, request: FileRequest, count: int, mm: float) -> float:
    """Greatest error of a flank, mm, by words of so many decimals."""
    recipe, own = design.recipe, request.own
    # turned by so much the cutter moves along its flank as much as that rises
    turned = (
        min(steepest(design)[0], recipe.radius) if recipe.guide.radial and not recipe.roller.taper else recipe.radius
    )
    along = mm + math.radians(1.0) * turned + (mm if "Y" in own["axes"] else 0.0)
    return 0.5 * 10.0**-count * (along + mm * math.tan(own.get("taper", 0.0)))


def _places(design: DrumDesign, request: FileRequest, tolerance: float, mm: float) -> int:
    """Decimals of the words: as the request states, or as few as take a small share of the tolerance."""
    recipe, stated = design.recipe, request.own.get("decimals")
    for count in range(FEWEST if stated is None else stated, MOST_PLACES + 1):
        limit = (SHARE if stated is None else ROUNDED) * tolerance
        if _rounding(design, request, count, mm) <= limit:
            if stated is not None and count > stated:
                problem = f"rounding takes {_rounding(design, request, stated, mm) / recipe.mm:.3g} {recipe.units}"
                field, remedy = _key(design, request, "decimals"), f"give at least {count}"
                raise recipe.error(field, f"{problem} of the tolerance", str(stated), remedy)
            return count
    return MOST_PLACES


def _head(design: DrumDesign, request: FileRequest, tolerance: float, mm: float) -> Iterator[str]:
    recipe, own = design.recipe, request.own
    blank, feed = plain(recipe.radius / mm), plain(own["feed"] / mm)
    sense = "counter-clockwise" if recipe.rotation == "cw" else "clockwise"
    texts = [
        recipe.name,
        recipe.about,
        f"units: {'inch' if mm != 1.0 else 'mm'}, A in degrees",
        f"cutter: diameter {plain(own['cutter'] / mm)}{_cone(own)}, its axis square to the drum's",
        f"tolerance: {plain(tolerance / mm)}",
        "X zero: the lower face; X grows along the drum's axis, towards the upper face",
        "A zero: the roller's place at shaft angle 0, from which the keyway's angle counts",
        "A grows as the cutter goes round the drum counter-clockwise, seen from the upper face",
        f"A goes on over all {recipe.turns} turns of the motion" if recipe.turns > 1 else "",
        f"the follower goes round it {sense}",
        f"Z zero: the drum's axis; blank {blank}, floor {plain(recipe.floor / mm)}",
        "Y zero: over the drum's axis; seen from the cutter Y grows as A does" if "Y" in own["axes"] else "",
        "climb milling along each flank, spindle clockwise",
        f"feed: G93, the inverse of the minutes of a block, {feed} a minute at a radius of {blank}"
        if own.get("feed_mode", INVERSE) == INVERSE
        else f"feed: G94, along the path at a radius of {blank}: the control has to count A at that radius",
    ]
    if recipe.track.unmilled:
        texts.append(f"not milled: the drum {recipe.track.unmilled} farther off the flank than the cutter is wide")
    for text in filter(None, texts):
        yield f"({comment(text)})"


def _cone(own: dict[str, Any]) -> str:
    return f" at its end, half angle {plain(math.degrees(own['taper']))} degrees" if "taper" in own else ""


class _Written:
    """Blocks of passes, in the words of a machine, and how many there are."""

    def __init__(self, design: DrumDesign, own: dict[str, Any], count: int, mm: float) -> None:
        self.own, self.count, self.mm, self.blocks = own, count, mm, 0
        self.fastest = 0.0
        self.blank = design.recipe.radius
        self.safe = design.recipe.radius + own["safe_height"]
        self.inverse = own.get("feed_mode", INVERSE) == INVERSE
        self.beside = "Y" in own["axes"]

    def begun(self) -> list[str]:
        """Units and modes, the cutter drawn out and the spindle on."""
        feed = "G93" if self.inverse else "G94"
        unit = "G20" if self.mm != 1.0 else "G21"
        return [
            unit,
            f"G17 G90 {feed}",
            "G40 G49 G80",
            f"G0 Z{self._text(self.safe / self.mm)}",
            f"S{plain(self.own['spindle'])} M3",
        ]

    def cut(self, step: Step, points: Array) -> Iterator[str]:
        """A pass through points (n, 3) of A, rad, X and Y, mm."""
        scale = np.array([math.degrees(1.0), 1.0 / self.mm, 1.0 / self.mm])
        rounded = np.round(points * scale, self.count) + 0.0
        rows = rounded.tolist()
        yield f"G0 {self._place(rows[0])}"
        low, high = self._text(step.z / self.mm), self._text(self.safe / self.mm)
        yield f"G1 Z{low} F{self._feed(self.own['plunge'], (float(high) - float(low)) * self.mm)}"
        for k, (before, after) in enumerate(pairwise(rows)):
            if before == after:
                continue
            turn, along, beside = (b - a for a, b in zip(before, after, strict=True))
            far = math.hypot(math.radians(turn) * self.blank, along * self.mm, beside * self.mm)
            feed = f" F{self._feed(self.own['feed'], far)}" if self.inverse or k == 0 else ""
            yield f"G1 {self._place(after)}{feed}"
            self.blocks += 1
        yield f"G0 Z{high}"

    def _place(self, row: list[float]) -> str:
        a, x, y = (self._text(value) for value in row)
        return f"X{x} Y{y} A{a}" if self.beside else f"X{x} A{a}"

    def _feed(self, feed: float, far: float) -> str:
        stated = feed / far if self.inverse else feed / self.mm
        self.fastest = max(self.fastest, stated)
        return feed_text(stated)

    def _text(self, value: float) -> str:
        text = f"{value:.{self.count}f}"
        return text[1:] if float(text) == 0.0 and text.startswith("-") else text
