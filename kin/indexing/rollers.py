"""How near points and edges come to any roller of the turret, over all angles of the cam, by positions alone.

The excess of a point at an angle is its squared distance from the nearest roller's axis less the squared radius of that
roller; of an edge it is that of its point nearest to the axis. It is computed at equal angles wherever a roller may be
within reach. Between two angles the excess of a point falls below the lesser of both by at most step^2/8 times its
second derivative, which the form bounds. The same holds of an edge. So only steps that may still hold the least are
divided, until next to nothing is left open. Neither a normal nor a flank is needed.

The same steps tell how fast the excess of a point grows. At x beyond CLOSE finest steps from its worst angle it exceeds
its least by at least `growth` times x^2, or the axes are out of reach there. Seen along an axis, the excess of an edge
of the length e is below the lesser of its ends' by at most e^2/4. So an edge is searched only about the worst angles of
its ends. An axis that is nearer to a triangle than to its edges passes through it, so that it is near those too.
"""

from __future__ import annotations

import math
from functools import cached_property, partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.indexing.motion import STEPS, Turning
from kin.numeric.angles import TURN
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from kin.indexing.intent import IndexIntent
    from kin.numeric.arrays import Array, Indices

REACH = 1.25  # of the radius of a roller: an axis farther off is out of reach
FINE = 0.1  # of the tolerance, to which a least distance is known
PARTS = 4  # of a step, into which it is divided
SHALLOW = 0.1  # of the tolerance: edges that reach no deeper than this below their ends are not looked at
NEVER = 1e9  # mm^2: the excess of a point that no roller comes near
CLOSE = 6  # of the finest steps: so near its angle the excess need not grow
PAIRS = 60_000  # of a point and an angle, at a time
MOST_LEVELS = 7


class Met(NamedTuple):
    """Points (n,) each at an angle of the cam, by the roller whose axis is nearest.

    excess  squared distance from its axis less the squared radius of its gauge, mm^2
    s, y    distance from the turret's axis in the turret's plane, and from that plane, mm
    d       polar angle about the turret's axis less the roller's, rad: above 0 the point is above the roller
    x       distance along e_r, mm
    psi     angle of the roller, rad
    """

    excess: Array
    s: Array
    y: Array
    d: Array
    x: Array
    psi: Array


class Worst(NamedTuple):
    """Points or edges (n,) each at the angle theta, rad, at which its excess, mm^2, is least; nan where not asked for.

    open    by how much the excess may be less at an angle between those looked at, mm^2
    growth  how fast the excess grows away from theta, mm^2 per rad^2
    """

    theta: Array
    excess: Array
    open: Array
    growth: Array


@dataclass(frozen=True, eq=False)
class Rollers:
    """All rollers of an intended turret; distances from them are found to a share of a tolerance, mm.

    Points have their heights over the turret's centre.
    """

    intent: IndexIntent
    tolerance: float

    @cached_property
    def turning(self) -> Turning:
        """Angle of the turret over that of the cam."""
        return Turning(self.intent.law, self.intent.start)

    @cached_property
    def radii(self) -> Array:
        """Radii of the gauges of the lower and of the upper flank, mm."""
        return np.array([self.intent.radius(-1), self.intent.radius(1)])

    @cached_property
    def farthest(self) -> float:
        """Greatest distance of the blank from the cam's axis, mm."""
        return float(self.intent.form.rims(0.0, np.array(self.intent.ends)).max())

    @cached_property
    def reached(self) -> float:
        """Excess, mm^2, up to which it is computed; above it no roller comes near."""
        return float((REACH**2 - 1.0) * self.radii.max() ** 2)

    @property
    def longest(self) -> float:
        """Greatest length of an edge, mm, at which no axis can reach it and yet be out of reach of both ends."""
        return math.sqrt(4.0 * self.reached)

    def bends(self, step: float) -> Array:
        """Upper bounds (STEPS,) of the second derivative of the excess, in steps of an angle, rad."""
        reach = REACH * float(self.radii.max())
        slope, curve = self.turning.fastest
        return self.intent.form.bends(slope, curve, (reach, step, 1.02 * self.farthest))

    @cached_property
    def levels(self) -> int:
        """How often steps are divided."""
        fine = 2.0 * float(self.radii.min()) * FINE * self.tolerance
        step = math.sqrt(8.0 * fine / float(self.bends(TURN / STEPS).max()))
        return min(MOST_LEVELS, max(1, math.ceil(math.log(TURN / STEPS / step, PARTS))))

    @cached_property
    def finest(self) -> float:
        """The finest step, rad."""
        return TURN / float(STEPS * PARTS**self.levels)

    @cached_property
    def _falls(self) -> list[Array]:
        """By how much the excess may fall within a step, mm^2 (STEPS,), at each level."""
        steps = [TURN / (STEPS * PARTS**level) for level in range(self.levels + 1)]
        return [0.125 * step**2 * self.bends(step) for step in steps]

    @cached_property
    def _table(self) -> Array:
        """Turret's angle, sine and cosine of the cam's (n, 3) at the finest equal angles, over two turns."""
        at = np.arange(2 * STEPS * PARTS**self.levels) * self.finest
        return np.stack([self.turning.at(at)[0], np.sin(at), np.cos(at)], axis=-1)

    def at(self, points: Array, theta: Array) -> Met:
        """Points (n, 3) at angles (n,)."""
        form, pitch = self.intent.form, self.intent.pitch
        sine, cosine = np.sin(theta), np.cos(theta)
        x, y = points[:, 0] * cosine + points[:, 1] * sine, points[:, 1] * cosine - points[:, 0] * sine
        u, v = form.plane(x, y, points[:, 2])
        beta, psi = np.arctan2(v, u), self.turning.at(theta)[0]
        psi = psi + pitch * np.round((beta - psi) / pitch)
        one, other = form.beside(y, u, v, psi)
        d = beta - psi
        radius = np.where(d > 0.0, self.radii[1], self.radii[0])
        return Met(one**2 + other**2 - radius**2, np.hypot(u, v), y, d, x, psi)

    def near(self, points: Array, theta: Array) -> tuple[Array, Array]:
        """Distance (n,) of points (n, 3) from what rollers sweep, mm, at one of the finest angles next to theirs (n,).

        With it comes the angle of the roller, rad.
        """
        nodes = np.remainder(np.rint(theta / self.finest).astype(np.intp), len(self._table) // 2)[:, None]
        y, u, v, psi = self._turned(points, nodes)
        off = np.arctan2(v, u) - psi
        squares = self._squares(off)
        psi += self.intent.pitch * np.rint(off * (1.0 / self.intent.pitch))
        one, other = self.intent.form.beside(y, u, v, psi)
        distance = np.sqrt(one * one + other * other) - np.sqrt(squares)
        return np.asarray(distance[:, 0]), psi[:, 0]

    def own(self, met: Met) -> Array:
        """Radius (n,) of the gauge of the flank that each point would be on, mm."""
        return np.asarray(np.where(met.d > 0.0, self.radii[1], self.radii[0]))

    def distance(self, excess: Array, radius: Array) -> Array:
        """Distance (n,), mm, from what rollers sweep; below 0 it is the depth within it."""
        return np.asarray(np.sqrt(np.maximum(excess + radius**2, 0.0)) - radius)

    def worst(self, points: Array) -> Worst:
        """Points (n, 3), mm, each at its least excess."""
        r, phi = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
        low, high = self.intent.form.window(r, points[:, 2], REACH * float(self.radii.max()))
        return self._least(phi - high, phi - low, 0, lambda own, nodes: self._points(points[own], nodes))

    def edges(self, start: Array, last: Array, worst: tuple[Worst, Worst]) -> Worst:
        """Edges between points (n, 3), (n, 3) that are `worst` at both ends, each at its least excess.

        They are no longer than `longest`. An edge that is not worse than its ends has the worse end's place. Edges that
        cannot be worse than their ends by more than a share of the tolerance are not searched.
        """
        one, other = worst
        way = other.theta - one.theta
        way -= TURN * np.round(way / TURN)
        middle, wide = one.theta + 0.5 * way, 0.5 * np.abs(way)
        psi = self.at(start, middle).psi
        along = last - start
        across = np.sqrt(self.intent.form.across(along, np.sin(middle), np.cos(middle), psi))
        turned = np.linalg.norm(along, axis=1) * self.intent.form.turning(float(self.turning.fastest[0].max()))
        least, opened = np.minimum(one.excess, other.excess), np.maximum(one.open, other.open)
        at = np.where(one.excess <= other.excess, one.theta, other.theta)
        rate = np.sqrt(np.maximum(np.minimum(one.growth, other.growth), 0.0)) - 0.5 * turned
        near = CLOSE * self.finest
        side = 0.5 * (across + turned * (wide + near))
        with np.errstate(divide="ignore", invalid="ignore"):
            beyond = np.where(rate > 0.0, side / np.maximum(rate, 1e-9), TURN)
            # the least of growth x^2 less (side + turned x/2)^2 over all x
            more = 0.25 * turned**2 / np.maximum(rate * (rate + turned), 1e-18)
            deeper = np.where(rate > 0.0, side**2 * (1.0 + more), np.inf)
        wide = np.minimum(wide + near + beyond, 0.25 * TURN)
        shallow = 2.0 * float(self.radii.min()) * SHALLOW * self.tolerance
        asked = np.flatnonzero(deeper > shallow + np.maximum(least - opened, 0.0))
        found = Worst(at, least.copy(), opened + np.where(np.isfinite(deeper), deeper, 0.0), np.zeros_like(at))
        if not len(asked):
            return found
        start, last, middle, wide = start[asked], last[asked], middle[asked], wide[asked]
        level = max(0, min(self.levels, int(math.log(TURN / STEPS / max(float(np.median(wide)), 1e-9), PARTS)) + 1))
        seen = self._least(
            middle - wide, middle + wide, level, lambda own, nodes: self._edges(start[own], last[own], nodes)
        )
        worse = seen.excess < least[asked]
        found.theta[asked] = np.where(worse, seen.theta, at[asked])
        found.excess[asked] = np.minimum(seen.excess, least[asked])
        # what an end leaves open counts where the edge is not seen to be worse
        lowest = np.minimum(seen.excess - seen.open, least[asked] - opened[asked])
        found.open[asked] = found.excess[asked] - lowest
        return found

    def _turned(self, points: Array, nodes: Indices) -> tuple[Array, Array, Array, Array]:
        """Coordinates y, u and v (n, m) of points (n, 3) at numbers of angles (n, m), and the turret's angle."""
        psi, sine, cosine = (self._table[:, k].take(nodes) for k in range(3))
        px, py = points[:, :1], points[:, 1:2]
        y = py * cosine - px * sine
        return y, *self.intent.form.plane(px * cosine + py * sine, y, points[:, 2:]), psi

    def _points(self, points: Array, nodes: Indices) -> Array:
        """Excess (n, m) of points (n, 3) at numbers of angles (n, m)."""
        pitch = self.intent.pitch
        y, u, v, psi = self._turned(points, nodes)
        off = np.arctan2(v, u) - psi
        psi += pitch * np.rint(off * (1.0 / pitch))
        one, other = self.intent.form.beside(y, u, v, psi)
        return np.asarray(one * one + other * other - self._squares(off))

    def _squares(self, off: Array) -> Array | float:
        """Squared radii of the gauges on whose side points are by the angles (n, m) from any roller."""
        if self.radii[0] == self.radii[1]:
            return float(self.radii[0] ** 2)
        pitch = self.intent.pitch
        above = off > pitch * np.rint(off * (1.0 / pitch))
        return np.asarray(np.where(above, self.radii[1] ** 2, self.radii[0] ** 2))

    def _edges(self, start: Array, last: Array, nodes: Indices) -> Array:
        """Excess (n, m) of edges between points (n, 3), (n, 3), at numbers of angles (n, m)."""
        form, pitch = self.intent.form, self.intent.pitch
        y, u, v, psi = self._turned(start, nodes)
        off = np.arctan2(v, u) - psi
        psi += pitch * np.rint(off * (1.0 / pitch))
        a, b = form.beside(y, u, v, psi)
        start_u, start_v = u, v
        y, u, v, _ = self._turned(last, nodes)
        c, d = form.beside(y, u, v, psi)
        c -= a
        d -= b
        length = c * c + d * d
        share = -(a * c + b * d) / np.where(length > 0.0, length, 1.0)

        def square(low: Array | float, high: Array | float) -> Array:
            within = np.clip(share, low, high)
            return np.asarray((a + within * c) ** 2 + (b + within * d) ** 2)

        if self.radii[0] == self.radii[1]:
            return square(0.0, 1.0) - float(self.radii[0] ** 2)
        # an edge that passes from below the roller to above it is held against a gauge on either side
        up, out = np.cos(psi), np.sin(psi)
        begins, ends = start_v * up - start_u * out, v * up - u * out
        passes = begins * ends < 0.0
        part = np.where(passes, begins / np.where(passes, begins - ends, 1.0), 1.0)
        one, other = (np.where(each > 0.0, *np.square(self.radii[::-1])) for each in (begins, ends))
        beyond = np.where(passes, square(part, 1.0) - other, np.inf)
        return np.asarray(np.minimum(square(0.0, part) - one, beyond))

    def _least(self, low: Array, high: Array, level: int, excess: Callable[[Indices, Indices], Array]) -> Worst:
        """Least excess over angles from low to high (n,), from a level on; `excess` gives it by rows and angles."""
        unit = PARTS ** (self.levels - level)
        first = np.floor(low / (unit * self.finest)).astype(np.intp)
        count = np.ceil(high / (unit * self.finest)).astype(np.intp) - first
        found = Worst(0.5 * (low + high), np.full(len(low), NEVER), np.zeros(len(low)), np.full(len(low), NEVER))
        order = np.argsort(count, kind="stable")
        order = order[(count > 0)[order]]
        while len(order):
            size = max(1, PAIRS // int(count[order[-1]] + 1))
            own, order = order[-size:], order[:-size]
            rows = self._searched(first[own] * unit, count[own], level, partial(excess, own))
            for row, values in zip(found, rows, strict=True):
                row[own] = values
        return found

    def _searched(self, start: Indices, count: Indices, level: int, excess: Callable[[Indices], Array]) -> Worst:
        """The same over so many steps (n,) of a level from numbers of the finest angles (n,)."""
        turn, each = len(self._table) // 2, PARTS**self.levels
        rows = np.arange(len(start))
        least, at = np.full(len(start), NEVER), np.zeros(len(start), dtype=np.intp)
        growth, kept = np.full(len(start), NEVER), []
        while True:
            spacing = PARTS ** (self.levels - level)
            columns = np.arange(int(count.max()) + 1)
            nodes = start[:, None] + spacing * columns
            folded = nodes - turn * (start // turn)[:, None]
            values = excess(np.minimum(folded, 2 * turn - 1))
            values[columns > count[:, None]] = NEVER
            column = values.argmin(axis=1)
            better = values[rows, column] < least
            least = np.where(better, values[rows, column], least)
            at = np.where(better, nodes[rows, column], at)
            within = np.minimum(values[:, :-1], values[:, 1:])
            falls = self._falls[level].take(folded[:, :-1] // each % STEPS)
            within -= falls
            beyond = columns[1:] > count[:, None]
            within[beyond] = NEVER
            if level == self.levels:
                break
            may = within <= least[:, None] + falls  # so that the rest tells how the excess grows
            head, tail = may.argmax(axis=1), may.shape[1] - may[:, ::-1].argmax(axis=1)
            kept.append((within, nodes, spacing, (columns[:-1] >= head[:, None]) & (columns[:-1] < tail[:, None])))
            start, count, level = nodes[rows, head], (tail - head) * PARTS, level + 1
        kept.append((within, nodes, spacing, beyond))
        opened = np.maximum(least - within.min(axis=1), 0.0)
        for values, nodes, spacing, inside in kept:
            ahead = nodes[:, :-1] - at[:, None]
            far = np.maximum(np.abs(ahead), np.abs(ahead + spacing)) - CLOSE
            left = inside | (far <= 0) | (values >= self.reached)
            rate = (values - least[:, None]) / np.where(left, 1, far).astype(np.float64) ** 2
            rate[left] = NEVER
            np.minimum(growth, rate.min(axis=1), out=growth)
        return Worst(at * np.float64(self.finest), least, opened, growth / self.finest**2)
