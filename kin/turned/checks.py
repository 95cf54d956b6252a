"""How a program goes about its work on a turning body: checks of its cutter, its moves, its feeds and its depths."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.numeric.check import Check, at_most, failed
from kin.numeric.lengths import UNIT, length_words
from kin.numeric.records import dataclass
from kin.read.checks import count_check
from kin.turned.cutters import END

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.numeric.arrays import Array, Mask
    from kin.turned.moves import Pass, TurnedProgram

JOINT = 1e-9  # rad: angles that differ by less are one
FEED = 0.01  # of a feed, by which it may differ: more than words of few digits round by, less than a hand sets
LEAST = 1e-6  # of the cutter's diameter, by which what a program names may differ
LEAST_TAPER = 1e-6  # degrees, by which the half angle of a cutter may differ
_CUTTER = re.compile(r"^cutter: diameter ([0-9.]+)(?: at its end, half angle ([0-9.]+) degrees)?")


@dataclass(frozen=True)
class Cutting:
    """How a program should cut, mm.

    radius        of the cutter, of one that tapers at its end
    feed          mm a minute along the path on the blank's radius
    inverse       whether every block states the inverse of its time, G93
    depth_of_cut  greatest depth of a pass
    taper         half angle of the cutter, rad, thicker away from its end; 0 of a cylinder
    """

    radius: float
    feed: float
    inverse: bool
    depth_of_cut: float
    taper: float = 0.0

    @property
    def growth(self) -> float:
        """How fast the cutter's radius grows along its axis."""
        return math.tan(self.taper)


class Work(NamedTuple):
    """A body that a program cuts: radii of its blank and of its track's floor, mm.

    `period` is the angle, rad, after which the way of a pass is where it was.
    """

    blank: float
    floor: float
    period: float


def astray(program: TurnedProgram, passes: Sequence[Pass], blank: float) -> list[str]:
    """Words on cutters that go down below the blank's radius, mm, while they move aside, and passes to and fro."""
    low = [move for move in program.moves if min(move.start.z, move.end.z) < blank]
    bad = [
        f"line {move.line} goes down while another axis moves"
        for move in low
        if not move.rapid and move.start.z != move.end.z and move.start._replace(z=0.0) != move.end._replace(z=0.0)
    ]
    return bad + [
        f"the body turns to and fro in the pass from line {one.line}"
        for one in passes
        if (np.diff(one.a) < 0.0).any() and (np.diff(one.a) > 0.0).any()
    ]


def cutter_check(program: TurnedProgram, cutting: Cutting) -> Check:
    """Check the diameter of the cutter that the program names at its head, if it names one."""
    named = [(float(found[1]), float(found[2] or 0.0)) for text in program.comments if (found := _CUTTER.match(text))]
    if not named:
        return Check("cutter", True, None, None, "mm", detail="the program names no cutter")
    diameter, expected = named[0][0] * program.units_mm, 2.0 * cutting.radius
    taper = math.degrees(cutting.taper)
    if abs(named[0][1] - taper) > LEAST_TAPER:
        why = f"the program names a half angle of {named[0][1]:.9g} degrees, {taper:.9g} are expected"
        return failed("cutter", why, unit="mm", limit=LEAST * expected)
    names = f"the program names {length_words(diameter, '.9g')} {UNIT} across"
    detail = f"{names}, {length_words(expected, '.9g')} are expected"
    return at_most("cutter", abs(diameter - expected), LEAST * expected, "mm", detail=detail)


def rapid_check(program: TurnedProgram, work: Work) -> Check:
    """Check that nothing moves fast below the blank's radius, but for the cutter that is drawn out."""
    bad = []
    for move in program.moves:
        low = min(move.start.z, move.end.z)
        out = move.end.z > move.start.z and move.start._replace(z=0.0) == move.end._replace(z=0.0)
        if move.rapid and low < work.blank and not out:
            bad.append(f"line {move.line} moves fast at Z {length_words(low)} {UNIT}")
    return count_check("rapid", bad)


def feed_check(program: TurnedProgram, work: Work, cutting: Cutting) -> Check:
    """Check the speed of every cutting block on the blank's radius."""
    worst, line = 0.0, 0
    for move in program.moves:
        start, end = move.start, move.end
        if move.rapid or start.z != end.z or start.z >= work.blank or start == end:
            continue
        if move.inverse != cutting.inverse:
            stated, wanted = ("G93", "G94") if move.inverse else ("G94", "G93")
            return failed("feed", f"line {move.line} moves by {stated}, {wanted} is expected", limit=FEED)
        far = math.hypot(end.x - start.x, end.y - start.y, work.blank * (end.a - start.a))
        off = abs((move.feed * far if move.inverse else move.feed) / cutting.feed - 1.0)
        if off > worst:
            worst, line = off, move.line
    detail = f"line {line}, as a share of the feed" if line else "as a share of the feed"
    return at_most("feed", worst, FEED, "", detail=detail)


def depth_check(
    program: TurnedProgram, passes: Sequence[Pass], work: Work, cutting: Cutting, tolerance: float
) -> Check:
    """Check that the deepest passes reach the floor, and that none goes too far below those before it."""
    deepest = min(program.moves, key=lambda move: move.end.z)
    if not abs(deepest.end.z - work.floor) <= tolerance:
        ends = f"from line {deepest.line} on the cutter ends at a radius of {length_words(deepest.end.z)} {UNIT}"
        why = f"{ends}, the floor has {length_words(work.floor)} {UNIT}"
        return failed("depth", why, unit="mm", limit=cutting.depth_of_cut)
    worst, line = 0.0, passes[0].line
    ways: list[Pass] = []
    deep: list[float] = []  # how far down each has been gone
    near: dict[tuple[int, int], Mask] = {}
    for one in passes:
        own = next((k for k, way in enumerate(ways) if one.same_way(way)), len(ways))
        if own == len(ways):
            ways.append(one)
            deep.append(work.blank)
            angles = _between(one, passes, work.period)
            near |= {(own, k): _near(one, way, angles, work.period, cutting.radius) for k, way in enumerate(ways)}
            near |= {
                (k, own): _near(way, one, _between(way, passes, work.period), work.period, cutting.radius)
                for k, way in enumerate(ways[:own])
            }
        before = np.min([np.where(near[own, k], z, work.blank) for k, z in enumerate(deep)], axis=0)
        if float(before.max()) - one.z > worst:
            worst, line = float(before.max()) - one.z, one.line
        deep[own] = min(deep[own], one.z)
    return at_most("depth", worst, cutting.depth_of_cut, "mm", detail=f"the pass from line {line}", slack=tolerance)


def cleared_check(passes: Sequence[Pass], work: Work, cutter: float) -> Check:
    """Check that passes at the floor lie so near to one another that nothing stands between."""
    low, period = min(one.z for one in passes), work.period
    ways: list[Pass] = []
    for one in passes:
        if one.z <= low + END and float(np.ptp(one.a)) and not any(one.same_way(way) for way in ways):
            ways.append(one)
    worst = 0.0
    if ways:
        ends = np.array([end for way in ways for end in (way.a.min(), way.a.max())])
        # a way may begin or end between the points of all others
        angles = np.concatenate([*(way.a for way in ways), ends - 2.0 * JOINT, ends + 2.0 * JOINT])
        angles = np.unique(np.mod(angles, period))
        rows = np.array([row for way in ways for row in _met(way, angles, period)])
        order = np.argsort(rows[:, 0], axis=0)  # places that a way does not have come last
        apart = np.hypot(*(np.diff(np.take_along_axis(rows[:, k], order, axis=0), axis=0) for k in (0, 1)))
        worst = float(apart[np.isfinite(apart)].max(initial=0.0))
    detail = "between the centres of neighbouring passes, against the cutter's diameter"
    return at_most("cleared", worst, 2.0 * cutter, "mm", detail=detail)


def _met(way: Pass, angles: Array, period: float) -> list[tuple[Array, Array]]:
    """Places (n,), (n,) of a way at angles, rad, in each period in which it meets any of them; nan at the others."""
    low, high = float(way.a.min()), float(way.a.max())
    first, last = math.floor((low - angles.max()) / period), math.ceil((high - angles.min()) / period)
    found = [_places(way, angles + turn * period) for turn in range(first, last + 1)]
    return [places for places in found if np.isfinite(places[0]).any()]


def _places(way: Pass, angles: Array) -> tuple[Array, Array]:
    """Places (n,), (n,) of a way along the drum and beside its axis, mm, at angles, rad; nan beyond its ends."""
    order = slice(None) if way.a[-1] >= way.a[0] else slice(None, None, -1)
    a = way.a[order]
    beyond = (angles < a[0] - JOINT) | (angles > a[-1] + JOINT)
    x, y = (np.where(beyond, np.nan, np.interp(angles, a, row[order])) for row in (way.x, way.y))
    return x, y


def _between(one: Pass, passes: Sequence[Pass], period: float) -> Array:
    """Angles of a way between its points and the ends of all passes, or the one at which it stands."""
    low, high = float(one.a.min()), float(one.a.max())
    if low == high:
        return np.array([low])
    ends = np.unique([end for each in passes for end in (each.a.min(), each.a.max())])
    turns = np.arange(math.floor((low - ends[-1]) / period), math.ceil((high - ends[0]) / period) + 1)
    ends = (ends + turns[:, None] * period).ravel()
    joints = np.unique(np.concatenate([one.a, ends[(ends > low) & (ends < high)]]))
    return np.asarray(0.5 * (joints[1:] + joints[:-1]))


def _near(one: Pass, other: Pass, angles: Array, period: float, radius: float) -> Mask:
    """Whether another way goes by no farther off than `radius`, mm, at angles (n,) of one, rad."""
    (x, y), near = _places(one, angles), np.zeros(len(angles), dtype=np.bool_)
    for other_x, other_y in _met(other, angles, period):
        near |= np.hypot(other_x - x, other_y - y) <= radius
    return near
