"""Programs of a machine that turns a barrel under its cutter: X along the barrel, A about it, Z towards it, Y beside.

The rollers' axes are square to the barrel's, as the cutter's is. So a cutter as large as the roller takes its place, at
A = theta, and one way over all turns in which a roller is in the barrel cuts the whole groove:

    y = offset - side l cos psi,    x = H + l sin psi

Where the roller of a flank is larger than the cutter by e, the cutter stands e off that place along the flank's normal
at one distance from the barrel's axis. It lies within the roller, and touches the flank as that does; elsewhere it
leaves at most sqrt((R - e)^2 + 2 R e (1 - cos d)) - (R - e), d being by how much the contact's angle is another there.

Between blocks all axes move evenly; how far that is off is bounded by the second derivative of the way.
"""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.indexing.bends import pose_over
from camgeo.capabilities.indexing.tracks import STEPS, passed
from camgeo.common.rounding import upward
from camgeo.fit.bound import Bound
from camgeo.fit.parted import LOOKS, parted
from camgeo.machining.turned import CHORDS, Cut, TurnedWork, down
from kin.numeric.angles import TURN
from kin.numeric.interval import Ball
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.capabilities.indexing.design import IndexDesign
    from camgeo.capabilities.indexing.flank import Flank
    from camgeo.recipe.export import FileRequest
    from kin.numeric.arrays import Array

SAME = 1e-9  # mm: sizes that differ by less are one
SETTING = 0.4  # of the tolerance, that a smaller cutter may leave where it is not set
PARTS = 24  # of the track's depth, over each of which it is bounded how the contact turns
MOST_DEPTHS = 40  # that a smaller cutter may go in
BELOW = 0.02  # mm that a depth goes below where the next begins
CLEAR = 0.1  # of the cutter's radius, that it stands off an end face where it goes down
BEYOND = 1.05  # radii of a roller beyond an end face, up to which the way goes on


@dataclass(frozen=True, eq=False)
class Way:
    """The way of a cutter of a radius, mm, along a flank.

    at   distance from the barrel's axis, mm, at which it leaves the flank as it is
    end  distance of the cutter's end from that axis, mm
    """

    flank: Flank
    radius: float
    at: float
    end: float

    @property
    def less(self) -> float:
        """By how much the cutter is smaller than the roller, mm; 0 of one as large."""
        less = self.flank.radius - self.radius
        return less if abs(less) > SAME else 0.0

    def places(self, theta: Array) -> tuple[Array, Array]:
        """Places x along the barrel and y beside its axis, mm, (n,) each, at shaft angles (n,), rad."""
        rho, less = np.full_like(theta, self.at), self.flank.side * self.less
        _, y, x = self.flank.form.axis(self.flank.pose(theta), rho)
        if not less:
            return x, y
        angle = self.flank.along(theta, rho).angle
        return x + less * np.cos(angle), y - less * np.sin(angle)

    def bends(self, look: Array) -> Array:
        """Bounds (n,) of the way's second derivative, mm per rad^2, between shaft angles (n + 1,), rad."""
        flank, pose = self.flank, pose_over(self.flank, (look[:-1], look[1:]))
        rho = Ball.between(np.full(len(look) - 1, self.at), np.full(len(look) - 1, self.at))
        speed = flank.form.speed(pose, rho)
        bend: Array = np.hypot(speed.a1.magnitude, speed.b1.magnitude)
        if self.less:
            touch = flank.touch(pose, rho)
            turned = touch.cosine * speed.b11 - touch.sine * speed.a11 - touch.a1 * touch.w1 * 2.0
            bend = bend + abs(self.less) * np.hypot((turned * touch.w**-1).magnitude, touch.a1.magnitude**2)
        return bend


def write_program(
    design: IndexDesign, request: FileRequest, path: Path, tolerance: float, mm: float
) -> tuple[int, Bound]:
    """Write a program of a barrel; its number of blocks, and the bound of what it leaves and cuts too deep.

    Raises RecipeErrors for a cutter that does not leave the flanks within the tolerance, too many passes and too few
    decimals; OSError where it cannot be written.
    """
    form, look = design.recipe.form, _looks(design)
    work = TurnedWork(design.recipe, request, form.blank, form.depth, mm, partial(_rounding, design, look, mm=mm))
    count = work.places(tolerance)
    within = tolerance - work.rounded(count)
    steps, left = _steps(design, work, look, SETTING * within)
    cuts, worst = [], 0.0
    for name, way, z in steps:
        points, off = _points(design, way, look, CHORDS * (within - left))
        cuts.append(Cut(points, z, name))
        worst = max(worst, off)
    blocks = work.write(path, count, _head(design, work, tolerance), cuts)
    return blocks, Bound(left, 0.0).widened(worst + work.rounded(count))


def _steps(
    design: IndexDesign, work: TurnedWork, look: Array, most: float
) -> tuple[list[tuple[str, Way, float]], float]:
    """Passes in their order: what each is, its way, and how far out its end is, mm; and what they leave at most, mm.

    Raises RecipeErrors for a cutter that leaves more than `most`, mm, and for too many passes.
    """
    floor, blank = design.recipe.layers
    radius, middle = 0.5 * work.own["cutter"], 0.5 * (floor + blank)
    ways = [(f"{name} flank", Way(flank, radius, middle, floor)) for name, flank in design.flanks.items()]
    finish, left = [("groove", ways[0][1])], 0.0
    if any(way.less for _, way in ways):
        finish = []
        for name, way in ways:
            own, more = _set(design, way, look, most) if way.less else ([way], 0.0)
            finish += [(name, each) for each in own]
            left = max(left, more)
    if left > most:
        problem = "in as many depths as are made it still leaves more than the tolerance"
        size = upward(2.0 * min(way.flank.radius for _, way in ways) / work.recipe.mm, 5)
        remedy = f"give {size} {work.recipe.units}, as large as the roller, or a greater tolerance"
        shown = f"{2.0 * radius / work.recipe.mm:.9g} {work.recipe.units}"
        raise work.recipe.error(work.key("cutter"), problem, shown, remedy)
    if "allowance" in work.own:
        less = work.own["allowance"]
        rough = [
            (f"{name}, rough", replace(way, flank=replace(way.flank, radius=way.flank.radius - less)))
            for name, way in ways
        ]
        steps = down(work.blank, work.cut, rough) + [(f"{name}, last", way, way.end) for name, way in finish]
        work.demand_few(len(steps), rough, len(finish))
    else:
        steps = down(work.blank, work.cut, finish)
        work.demand_few(len(steps), finish)
    return steps, left


def _set(design: IndexDesign, way: Way, look: Array, most: float) -> tuple[list[Way], float]:
    """Ways of a smaller cutter, the outermost first, each down to its end; and a bound of what they leave, mm.

    They are as few as leave no more than `most`, mm, above the roller's inner end, up to MOST_DEPTHS.
    """
    flank, (floor, blank), inner = way.flank, design.recipe.layers, design.recipe.roller.inner
    pose, parts = pose_over(flank, (look[:-1], look[1:])), np.linspace(floor, blank, PARTS + 1)
    rates = [
        float(flank.touch(pose, Ball.between(*(np.full(len(look) - 1, each) for each in ends))).a2.magnitude.max())
        for ends in pairwise(parts.tolist())
    ]
    turned = np.concatenate([[0.0], np.cumsum(rates * np.diff(parts))])
    for count in range(1, MOST_DEPTHS + 1):
        edges = blank * (inner / blank) ** (np.arange(count + 1) / count)
        ends = np.append(np.maximum(edges[1:-1] - BELOW, floor), floor)
        at = np.sqrt(edges[:-1] * edges[1:])
        places = [np.interp(each, parts, turned) for each in (at, edges[1:], edges[:-1])]
        apart = np.maximum(places[0] - places[1], places[2] - places[0])
        less, own = way.less, flank.radius
        left = np.sqrt((own - less) ** 2 + 2.0 * own * less * (1.0 - np.cos(apart))) - (own - less)
        if left.max() <= most:
            break
    pairs = zip(at.tolist(), ends.tolist(), strict=True)
    return [replace(way, at=place, end=end) for place, end in pairs], float(left.max())


def _looks(design: IndexDesign) -> Array:
    """Shaft angles (n + 1,), rad, over the way of a roller through the barrel; breaks of the motion are among them."""
    inside, _ = passed(design.resized(BEYOND * design.largest))
    begin, end = inside[0] - TURN / STEPS, inside[-1] + TURN / STEPS
    breaks = design.law.breaks_over(math.floor(begin / TURN), math.ceil(end / TURN))
    looks = np.linspace(begin, end, math.ceil((end - begin) / TURN * LOOKS) + 1)
    return np.unique(np.concatenate([looks, breaks[(breaks > begin) & (breaks < end)]]))


def _points(design: IndexDesign, way: Way, look: Array, chords: float) -> tuple[Array, float]:
    """Points (n, 3) of a way: A, rad, X and Y, mm; and how far lines between them are off, mm.

    The cutter goes down and comes out beyond an end face, and climbs along its flank.
    """
    theta, off = parted(look, way.bends(look), chords)
    theta = np.append(theta, look[-1])
    x, y = way.places(theta)
    clear = (1.0 + CLEAR) * way.radius
    ends = min(float(x[0]), -clear), max(float(x[-1]), design.recipe.length + clear)
    points = np.column_stack(
        [
            np.concatenate([theta[:1], theta, theta[-1:]]),
            np.concatenate([ends[:1], x, ends[1:]]),
            np.concatenate([y[:1], y, y[-1:]]),
        ]
    )
    if (way.flank.side > 0) != design.recipe.mirrored:  # metal on the right of a cutter that turns clockwise
        points = points[::-1]
    return points * [design.recipe.sense, 1.0, design.recipe.sense], off


def _rounding(design: IndexDesign, look: Array, count: int, *, mm: float) -> float:
    """Greatest error of a flank, mm, by words of so many decimals."""
    flank = design.flanks["lower"]
    pose = pose_over(flank, (look[:-1], look[1:]))
    fastest = float(pose.rate.magnitude.max()) * flank.form.lever(np.zeros(1))[0]
    return 0.5 * 10.0**-count * (2.0 * mm + math.radians(1.0) * float(fastest))


def _head(design: IndexDesign, work: TurnedWork, tolerance: float) -> list[str]:
    sense = "counter-clockwise" if design.recipe.rotation == "cw" else "clockwise"
    about = [
        "A zero: the radius that faces the turret at shaft angle 0, from which the keyway's angle counts",
        "A goes on over all turns that a roller takes through the barrel",
        f"the turret goes round it {sense}",
    ]
    return work.head(tolerance, "barrel", about)
