"""The pitch curve of a linear cam as a set of points, and how far any point of the plane is from it.

What the rollers leave of the metal is all that is a radius or more away from the pitch curve: so the excess of metal at
a point is the radius less its distance, whatever an undercut cuts off. Beyond the ends the pitch curve runs straight,
along its tangent or level.
"""

from __future__ import annotations

from functools import cached_property, partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs, dot, left
from kin.contour.nearest import nearest
from kin.linear.frame import frame
from kin.numeric.newton import zeros
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.law.piecewise import Side as KnotSide
    from kin.linear.follower import LinearFollower
    from kin.numeric.arrays import Array, Indices

SETTLED = 1e-10  # of the length: accuracy of a foot, which counts by its square
NEAR = 0.01  # of the radius: a point so near may be nearer to the flank than to anything else
FARTHER = 2.0  # times the distance of the chords' middles: allowed for them
BESIDE = 16  # chords from a foot near by, over which Newton's method may go
FREE = 5  # steps of Newton's method before a foot is bracketed
MOST_CHORDS = 64  # from the nearest one, over which a foot is looked for
PARTS = 4  # of a cell: chords that stand for the pitch curve where feet are sought
TOUCHING = 1e-13  # of the size: a point nearer to the pitch curve has the curve's own normal


class Feet(NamedTuple):
    """Feet of n points on the pitch curve.

    input (n,)      mm, beyond the first or last on a straight end
    excess (n,)     of metal at the point, mm: above 0 between flank and roller's centre
    normal (n, 2)   gradient of the excess
    curvature (n,)  of the line of equal excess, 1/mm, as `kin.contour` has it: above 0 where the metal is convex
    """

    input: Array
    excess: Array
    normal: Array
    curvature: Array

    def take(self, index: Indices) -> Feet:
        """The feet chosen by index."""
        return Feet(*(row[index] for row in self))

    def along(self, first: Array, second: Array) -> Array:
        """Excess and two derivatives (3, n) along a curve with derivatives x' and x'' (n, 2) at the points."""
        bend = dot(self.normal, second) + self.curvature * dot(left(self.normal), first) ** 2
        return np.stack([self.excess, dot(self.normal, first), bend])


@dataclass(frozen=True, eq=False)
class Pitch:
    """Pitch curve over an open motion, with straight ends of `beyond` (2,), mm, or `periods` of an endless one.

    tangent  the ends run along the pitch curve's tangents; else level
    copies   periods of an endless motion beyond these, either way, that are looked at
    switches inputs (k, 2) between which the flank is cut off, so that two feet compete
    """

    follower: LinearFollower
    beyond: tuple[float, float] = (0.0, 0.0)
    tangent: bool = True
    periods: int = 1
    copies: int = 1
    switches: tuple[tuple[float, float], ...] = ()

    @cached_property
    def span(self) -> tuple[float, float]:
        """First and last input that a contour is about, mm."""
        first, last = self.follower.span
        return first, first + self.periods * (last - first)

    @cached_property
    def inputs(self) -> Array:
        """Inputs (m,), rising, of the vertices of chords that stand for the curve."""
        cells = self.follower.cells
        parts = np.linspace(cells[:-1], cells[1:], PARTS + 1)[:-1].T.ravel()
        if not self.follower.endless:
            return np.append(parts, cells[-1])
        first, last = self.follower.span
        turns = np.arange(-self.copies, self.periods + self.copies) * (last - first)
        return np.append((turns[:, None] + parts).ravel(), first + (self.periods + self.copies) * (last - first))

    @cached_property
    def chords(self) -> Arcs:
        """Chords of the pitch curve, in order, then its straight ends: the first, the last."""
        points = self.points(self.inputs)
        step = np.diff(points, axis=0)
        length = np.hypot(step[:, 0], step[:, 1])
        chords = Arcs(points[:-1], step / length[:, None], np.zeros(len(step)), length)
        return chords if self.follower.endless else chords.joined(self.ends)

    @cached_property
    def ends(self) -> Arcs:
        """Straight ends: away from the first point, and away from the last."""
        first, last = self.span
        rows = frame(self.follower, np.array([first, last]), np.array([1, -1]))
        away = rows.tangent if self.tangent else np.array([[1.0, 0.0], [1.0, 0.0]])
        return Arcs(rows.centre, np.array([[-1.0], [1.0]]) * away, np.zeros(2), np.array(self.beyond))

    def points(self, u: Array) -> Array:
        """Points (n, 2), mm, of the curve at inputs u (n,) of the motion."""
        return frame(self.follower, u, self._inside(u)).centre

    def _inside(self, u: Array) -> KnotSide:
        return 1 if self.follower.endless else np.where(u < self.span[1], 1, -1)

    def feet(self, points: Array, beside: Array | None = None) -> Feet:
        """Feet of points (n, 2), mm: the nearest, also where an undercut has two.

        `beside` (n,) are inputs, mm, of feet near by, from which a foot is looked for.
        """
        count = len(self.inputs) - 1
        if beside is None:
            chord, _ = nearest(self.chords, points)
            if not self.follower.endless:  # a foot near a straight end is also looked for on the curve
                chord = np.where(chord == count, 0, np.minimum(chord, count - 1))
        else:
            chord = np.clip(np.searchsorted(self.inputs, beside, side="right") - 1, 0, count - 1)
        best = self._near_chord(points, chord, 1 if beside is None else BESIDE)
        return self._of_switches(points, best)

    def feet_within(self, points: Array, distance: Array) -> Feet:
        """Feet of points (n, 2), mm; only roughly of those that lie farther from the flank than a distance (n,), mm."""
        count = len(self.inputs) - 1
        chord, away = nearest(self.chords, points)
        rough = self.follower.radius - away
        near = np.flatnonzero(np.abs(rough) <= distance + self.off)
        inner = np.where(chord == count, 0, np.minimum(chord, count - 1))
        every = Feet(self.inputs[inner], rough, np.zeros((len(points), 2)), np.zeros(len(points)))
        found = self._of_switches(points[near], self._near_chord(points[near], inner[near]))
        for row, exact in zip(every, found, strict=True):
            row[near] = exact
        return every

    @cached_property
    def off(self) -> float:
        """Distance, mm, from the curve within which its chords lie, and some more."""
        middles = 0.5 * (self.inputs[1:] + self.inputs[:-1])
        step = self.points(middles) - self.chords.points(0.5 * self.chords.length)[: len(middles)]
        return FARTHER * float(np.hypot(step[:, 0], step[:, 1]).max()) + self.follower.radius * NEAR

    def _near_chord(self, points: Array, chord: Indices, reach: int = 1) -> Array:
        """Inputs (n,) of the feet of points, some chords away at most from those (n,) near them.

        Newton's method finds nearly all, the others are bracketed.
        """
        knots, count = self.inputs, len(self.inputs) - 1
        low, high = knots[np.maximum(chord - reach, 0)], knots[np.minimum(chord + 1 + reach, count)]
        own = self.chords.take(chord)
        share = np.clip(dot(points - own.start, own.tangent) / own.length, 1.0 - reach, reach)
        u = np.clip(knots[chord] + share * (knots[chord + 1] - knots[chord]), low, high)
        close = SETTLED * max(abs(self.span[0]), abs(self.span[1]))
        for _ in range(FREE):
            slope, rate = self._slope(points, u)
            with np.errstate(divide="ignore", invalid="ignore"):
                following = np.where(rate > 0.0, np.clip(u - slope / rate, low, high), u)
            step, u = np.abs(following - u), following
            if float(step.max(initial=0.0)) <= close:
                break
        # within its bracket, or at an end of the whole curve beyond which the foot would lie
        settled = (step <= close) & (rate > 0.0) & (low < u) & (u < high)
        settled |= ((u == knots[0]) & (slope >= 0.0)) | ((u == knots[-1]) & (slope <= 0.0))
        rest = np.flatnonzero(~settled)
        if rest.size:
            u[rest] = self._on_curve(points[rest], *self._brackets(points[rest], chord[rest]))
        return u

    def _of_switches(self, points: Array, best: Array) -> Feet:
        """Feet at inputs (n,), or at such on the other side of a part that is cut off, where these are nearer."""
        away = self._distance(points, best) if self.switches else best
        limits = (-np.inf, np.inf) if self.follower.endless else self.span
        for begin, end in self.switches:
            wide = end - begin
            near = np.flatnonzero((best > begin - wide) & (best < end + wide))
            for pair in ((begin - wide, begin), (end, end + wide)) if near.size else ():
                one, other = (np.full(near.size, value) for value in np.clip(pair, *limits))
                tried = self._on_curve(points[near], one, other)
                nearer = (gap := self._distance(points[near], tried)) < away[near]
                best[near[nearer]], away[near[nearer]] = tried[nearer], gap[nearer]
        feet = self._about(points, best)
        return feet if self.follower.endless else self._with_ends(points, feet)

    def _brackets(self, points: Array, chord: Indices) -> tuple[Array, Array]:
        """Inputs (n,), (n,) about a chord of each point between which its foot lies: wider where chords are short."""
        knots, count = self.inputs, len(self.inputs) - 1
        ends = []
        for side, first in ((-1, chord), (1, chord + 1)):
            at = np.clip(first + side, 0, count)
            open_, step = np.arange(len(points)), 1
            while open_.size and step <= MOST_CHORDS:
                slope = side * self._slope(points[open_], knots[at[open_]])[0]
                open_ = open_[(slope <= 0.0) & (at[open_] > 0) & (at[open_] < count)]
                step *= 2
                at[open_] = np.clip(at[open_] + side * step, 0, count)
            ends.append(knots[at])
        return ends[0], ends[1]

    def _slope(self, points: Array, u: Array) -> tuple[Array, Array]:
        """Rate (n,) of half the squared distance of points from the curve at u (n,), over the speed, and its rate."""
        rows = frame(self.follower, u, self._inside(u))
        gap = points - rows.centre
        return -dot(gap, rows.tangent), rows.sigma - rows.omega * dot(gap, rows.normal)

    def _distance(self, points: Array, u: Array) -> Array:
        gap = points - self.points(u)
        return np.hypot(gap[:, 0], gap[:, 1])

    def _on_curve(self, points: Array, low: Array, high: Array) -> Array:
        """Inputs (n,) between low and high where the distance from the points is least."""
        # without a change of sign the nearer end is the foot
        at_low, at_high = self._slope(points, low)[0], self._slope(points, high)[0]
        best = np.where(np.abs(at_low) < np.abs(at_high), low, high)
        inside = np.flatnonzero((at_low < 0.0) & (at_high > 0.0))
        if inside.size:
            size = max(abs(self.span[0]), abs(self.span[1]))
            low, high = low[inside], high[inside]
            start = low + (high - low) * at_low[inside] / (at_low - at_high)[inside]
            best[inside] = zeros(partial(self._slope, points[inside]), low, high, start, SETTLED * size)
        return best

    def envelope(self, u: Array) -> tuple[Array, Array]:
        """Points (n, 2), mm, touched at inputs u (n,), mm, and their rates (n, 2) by it, also on the straight ends."""
        first, last = self.span
        inside = u if self.follower.endless else np.clip(u, first, last)
        rows = frame(self.follower, inside, self._inside(inside))
        radius = self.follower.radius
        points = rows.centre - radius * rows.normal
        rates = (rows.sigma + radius * rows.omega)[:, None] * rows.tangent
        if self.follower.endless:
            return points, rates
        for number, beyond in enumerate((u < first, u > last)):
            way = (-1.0, 1.0)[number] * self.ends.tangent[number]
            at = self.ends.start[number] - radius * left(way) + (u - self.span[number])[:, None] * way
            points, rates = np.where(beyond[:, None], at, points), np.where(beyond[:, None], way, rates)
        return points, rates

    def _about(self, points: Array, u: Array) -> Feet:
        """Feet at inputs u (n,); one at a corner or an end of the curve is that of a point."""
        rows = frame(self.follower, u, self._inside(u))
        gap = points - rows.centre
        away, height = np.hypot(gap[:, 0], gap[:, 1]), dot(gap, rows.normal)
        side = np.where(height > 0.0, 1.0, -1.0)
        bend = rows.omega / rows.sigma
        with np.errstate(divide="ignore", invalid="ignore"):
            square = np.abs(dot(gap, rows.tangent)) <= 1e-6 * away
            level = np.where(square, -bend / (1.0 - bend * side * away), side / away)
            pointing = side[:, None] * gap / away[:, None]
        on = away <= TOUCHING * max(abs(self.span[0]), abs(self.span[1]))
        normal = np.where(on[:, None], rows.normal, pointing)
        level = np.where(on, -bend, level)
        return Feet(u, self.follower.radius + side * away, normal, level)

    def _with_ends(self, points: Array, feet: Feet) -> Feet:
        """Feet with those on the straight ends, where these are nearer."""
        radius = self.follower.radius
        columns = [feet.input, feet.excess, feet.normal, feet.curvature]
        for number, sign in ((0, -1.0), (1, 1.0)):
            start, way = self.ends.start[number], self.ends.tangent[number]
            gap = points - start
            s = np.clip(gap @ way, 0.0, self.ends.length[number])
            rest = gap - s[:, None] * way
            away = np.hypot(rest[:, 0], rest[:, 1])
            up = sign * left(way)
            nearer = np.flatnonzero((s > 0.0) & (away < np.abs(columns[1] - radius)))
            side = np.where(rest[nearer] @ up > 0.0, 1.0, -1.0)
            columns[0][nearer] = self.span[number] + sign * s[nearer]
            columns[1][nearer] = radius + side * away[nearer]
            columns[2][nearer] = up
            columns[3][nearer] = 0.0
        return Feet(*columns)
