"""Flanks of a linear cam: where the follower's own contact undercuts them, and what is left of them.

A flank beside a path whose direction turns by less than half a turn in all undercuts nowhere unless it runs backwards
somewhere: turned so that the path is the graph of a function, its slope's sine falls at most as fast as that of the
roller's circle, so that no point of the path comes into a roller that touches it elsewhere. On a stem the path is such
a graph, square to the guide. So freedom from undercut is proved by the speed of the flank alone.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.capabilities.linear.path import Arm
from camgeo.curve.backwards import backwards
from camgeo.curve.curvature import least_radius, reversals
from camgeo.curve.curve import Curve, SmoothRun
from camgeo.curve.extremes import both
from camgeo.curve.parallel import Parallel
from camgeo.curve.rates import cut
from kin.numeric import elementary
from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.capabilities.linear.path import CentrePath
    from camgeo.curve.curve import Side
    from camgeo.curve.extremes import Extreme
    from camgeo.curve.rates import Series
    from kin.numeric.arrays import Array, Mask

NODES = 3000  # of a period, at which an undercut flank is looked at
ABOUT = 2.0  # lengths of a reversal on either side of it that are looked at more closely
BESIDE = 65  # nodes there
STEPS = 40  # of Newton's method
TOGETHER = 64  # nodes in a row that are looked at together
ROUNDING = 1e-11  # of the size: a corner no deeper than that inside a roller stands
ZOOMS = 8  # about the place at which most motion is lost


class FlankError(CamgeoError, ValueError):
    """A flank that cannot be made, with the input at which it fails, mm."""

    def __init__(self, message: str, at: float) -> None:
        super().__init__(message)
        self.at = at


@dataclass(frozen=True)
class Lost:
    """Part of a flank that is lost: inputs from `begin` to `end`, mm, both at the corner (x, y), mm.

    `depth` is by how far the follower comes too low at most, mm or rad, at the input `at`.
    """

    begin: float
    end: float
    corner: tuple[float, float]
    depth: float
    at: float


@dataclass(frozen=True)
class Flank:
    """The flank at a `distance` from a path, mm: above 0 of the flank below the roller, below 0 of the one above it."""

    path: CentrePath
    distance: float
    endless: bool

    @cached_property
    def shape(self) -> Parallel:
        """The flank as a shape over the travel, untrimmed."""
        return Parallel(self.path, self.distance)

    @property
    def sense(self) -> int:
        """1 for a flank below the roller, whose metal lies left of its way, -1 for one above."""
        return 1 if self.distance >= 0.0 else -1

    @cached_property
    def whole(self) -> Curve:
        """The flank over one motion, untrimmed and open, run along the travel."""
        return _open(self.shape)

    @cached_property
    def least_radius(self) -> tuple[float, float]:
        """Largest radius of a roller that does not undercut, mm, infinite for any, and its input, mm."""
        return convex_radius(self.path, self.sense)

    @cached_property
    def backwards(self) -> tuple[tuple[float, float], ...]:
        """Inputs (start, end), mm, between which the flank runs backwards; empty of a sound flank."""
        return tuple((each.start, each.end) for each in reversals(self.whole))

    @cached_property
    def lost(self) -> tuple[Lost, ...]:
        """Parts that are lost to undercut, by rising input, of an endless motion over one period.

        Raises FlankError where an undercut reaches an end, and where its corners are not found.
        """
        return _lost_parts(self) if self.backwards else ()

    def kept(self, low: float, high: float) -> list[tuple[float, float]]:
        """Inputs (start, end), mm, between `low` and `high` that are not lost, rising; those of a plate's flank."""
        period = self.path.period
        shifts = range(math.floor(low / period) - 1, math.ceil(high / period) + 2) if self.endless else (0,)
        lost = sorted((each.begin + k * period, each.end + k * period) for k in shifts for each in self.lost)
        kept, begin = [], low
        for first, last in lost:
            if last <= low or first >= high:
                continue
            if first > begin:
                kept.append((begin, first))
            begin = max(begin, last)
        if begin < high:
            kept.append((begin, high))
        return kept

    def stands(self, u: Array) -> Mask:
        """Whether the contacts at inputs u (n,), mm, rising, are on what is left of the flank (n,)."""
        there = np.zeros(u.size, dtype=bool)
        for low, high in self.kept(float(u[0]), float(u[-1])):
            there |= (u >= low) & (u <= high)
        return there


def _open(shape: Parallel | CentrePath) -> Curve:
    """The curve of a shape over its whole travel, with ends."""
    inner = shape.breaks[shape.breaks > 0.0]
    return Curve(shape, (SmoothRun(0.0, shape.period, tuple(inner.tolist()), closed=False),))


def convex_radius(shape: Parallel | CentrePath, sense: int) -> tuple[float, float]:
    """Least radius, mm, where a curve bends towards its right (sense 1) or left, infinite where nowhere; its input."""
    curve = _open(shape)
    if sense > 0:
        return least_radius(curve)
    radius, at = least_radius(backwards(curve))
    return radius, -at


def stretches(path: CentrePath) -> Array:
    """Inputs (m, 2) of the ends of the stretches between breaks, mm."""
    breaks = path.law.breaks
    return np.column_stack([breaks, np.append(breaks[1:], path.law.total)])


def slopes(path: CentrePath) -> tuple[Extreme, Extreme]:
    """Least and greatest tangent of the pressure angle over all inputs; above 0 where the plate drives a rise."""
    return both(path.slope, stretches(path))


def demand_graph(path: CentrePath) -> None:
    """Raise FlankError where the path of what an arm leads turns by half a turn or more: flanks may meet then."""
    guide = path.guide
    if not isinstance(guide, Arm):
        return

    trails = float(guide.side)

    def heading(tau: Series, side: Side = 1) -> Series:
        s = path.law.on(tau, side)
        b, a, _ = path.guide.frame(s)
        direction: Series = cut(s, a.order) * trails - elementary.atan2(a, cut(b, a.order))
        return direction

    least, greatest = both(heading, stretches(path))
    if greatest.value - least.value + greatest.excess + least.excess >= math.pi:
        raise FlankError("the path of what the arm leads turns by half a turn and meets itself", greatest.at)


# --- what undercut leaves ---------------------------------------------------------------------------------------------


def _lost_parts(flank: Flank) -> tuple[Lost, ...]:
    period, shape = flank.path.period, flank.shape
    low, high = (-period, 2.0 * period) if flank.endless else (0.0, period)
    nodes = _nodes(flank, low, high)
    frame, centre = shape.sample(nodes), flank.path.sample(nodes).point
    stands = _stands(flank, frame.point, centre, nodes) & (frame.speed > 0.0)
    edges = np.flatnonzero(np.diff(stands.astype(np.int8)))
    if not flank.endless and not (stands[0] and stands[-1]):
        at = nodes[0] if not stands[0] else nodes[-1]
        raise FlankError("the undercut reaches the end of the motion, so that no corner ends it", float(at))
    lost = []
    size = float(np.abs(frame.point).max())
    for first, last in pairwise(edges.tolist()):
        if not stands[first] or stands[first + 1]:
            continue
        begin, end = _crossing(flank, float(nodes[first]), float(nodes[last + 1]), size)
        corner = shape.sample(np.array([begin, end])).point.mean(axis=0)
        away = np.hypot(*(centre - corner).T)
        if away.min() < abs(flank.distance) - _slack(nodes, size, flank):
            raise FlankError("the corners of the undercut flank cannot be separated", begin)
        lost.append((begin, end, corner))
    parts = [(b, e, c) for b, e, c in lost if not flank.endless or 0.0 <= 0.5 * (b + e) < period]
    if not parts:
        raise FlankError("the corners of the undercut flank cannot be found", flank.backwards[0][0])
    return tuple(_with_depth(flank, *part) for part in parts)


def _slack(nodes: Array, size: float, flank: Flank) -> float:
    return ROUNDING * max(size, abs(flank.distance)) + 1e-9 * float(np.median(np.diff(nodes)))


def _nodes(flank: Flank, low: float, high: float) -> Array:
    """Inputs (n,), rising, close together about reversals."""
    period = flank.path.period
    count = round(NODES * (high - low) / period)
    parts = [np.linspace(low, high, count + 1)]
    for start, end in flank.backwards:
        reach = ABOUT * (end - start)
        shifts = (-period, 0.0, period) if flank.endless else (0.0,)
        parts += [np.linspace(start - reach, end + reach, BESIDE) + shift for shift in shifts]
    nodes = np.unique(np.concatenate(parts))
    return nodes[(nodes >= low) & (nodes <= high)]


def _stands(flank: Flank, point: Array, centre: Array, nodes: Array) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether no roller at the nodes cuts a point of the flank away (n,)."""
    radius = abs(flank.distance)
    slack = _slack(nodes, float(np.abs(point).max()), flank)
    # in rows of neighbours, each against the rollers that may reach one of them
    order = np.argsort(centre[:, 0], kind="stable")
    sorted_centre = centre[order]
    stands = np.empty(nodes.size, dtype=bool)
    for begin in range(0, nodes.size, TOGETHER):
        row = point[begin : begin + TOGETHER]
        first = np.searchsorted(sorted_centre[:, 0], row[:, 0].min() - radius)
        last = np.searchsorted(sorted_centre[:, 0], row[:, 0].max() + radius)
        apart = row[:, None] - sorted_centre[None, first:last]
        least = np.einsum("ijk,ijk->ij", apart, apart).min(axis=1, initial=np.inf)
        stands[begin : begin + TOGETHER] = least >= (radius - slack) ** 2
    return stands


def _crossing(flank: Flank, t: float, s: float, size: float) -> tuple[float, float]:
    """Inputs at which the flank crosses itself, from guesses on both sides of a lost part, by Newton's method."""
    for _ in range(STEPS):
        frame = flank.shape.sample(np.array([t, s]))
        gap = frame.point[1] - frame.point[0]
        step = np.linalg.solve(
            np.column_stack([frame.speed[0] * frame.tangent[0], -frame.speed[1] * frame.tangent[1]]), gap
        )
        most = 0.2 * (s - t)
        t, s = t + float(np.clip(step[0], -most, most)), s + float(np.clip(step[1], -most, most))
        if np.abs(step).max() <= 4.0 * np.spacing(max(abs(t), abs(s))):
            break
    frame = flank.shape.sample(np.array([t, s]))
    if not (np.hypot(*(frame.point[1] - frame.point[0])) <= 1e-10 * size and (frame.speed > 0.0).all()):
        raise FlankError("the corner of the undercut flank cannot be found", t)
    return t, s


def _with_depth(flank: Flank, begin: float, end: float, corner: Array) -> Lost:
    """The lost part with the greatest motion that is lost on it."""
    low, high, best, place = begin, end, 0.0, begin
    for _ in range(ZOOMS):
        u = np.linspace(low, high, 66)[1:-1]
        depth = _hanging(flank, u, corner)
        worst = int(np.argmax(depth))
        if depth[worst] > best:
            best, place = float(depth[worst]), float(u[worst])
        step = u[1] - u[0]
        low, high = max(begin, u[worst] - step), min(end, u[worst] + step)
    return Lost(begin, end, (float(corner[0]), float(corner[1])), best, place)


def _hanging(flank: Flank, u: Array, corner: Array) -> Array:
    """Lift (n,), mm or rad, that is lost where the roller rests on a corner (2,), at inputs u (n,)."""
    path, radius, sense = flank.path, abs(flank.distance), flank.sense
    s = path.law.derivatives(u, 0)[0]
    centre, way = path.guide.place(u, s)
    guide = path.guide
    if isinstance(guide, Arm):
        # the roller's centre on its circle about the pivot, at the distance of its radius from the corner
        pivot = -u + 1j * guide.height
        apart = complex(*corner) - pivot
        far = np.abs(apart)
        turn = np.arccos(np.clip((guide.length**2 + far**2 - radius**2) / (2.0 * guide.length * far), -1.0, 1.0))
        psi = np.angle(apart * guide.side) * guide.side
        return np.asarray(sense * (guide.rest + s - (psi + sense * turn)))
    apart = centre - complex(*corner)
    along, across = (apart * np.exp(-1j * way)).real, (apart * np.exp(-1j * way)).imag
    return np.asarray(sense * along - np.sqrt(np.maximum(radius**2 - across**2, 0.0)))
