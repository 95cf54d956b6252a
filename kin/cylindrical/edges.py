"""Edges of a mesh against a roller, over all shaft angles: proved bounds of what stands out, is missing, and holds.

For a roller at one angle the metal of a triangle is met on its edges: seen along the roller's axis, a triangle is a
polygon, and a circle outside touches its border. Along an edge, with both its ends at their worst angles, F and the
depth of a point within the roller are greatest values over the angle of functions that bend by no more than

    (dy/ds)^2 R^2/(R^2 - y^2)^(3/2)   and   ((dy/ds)^2 + (dz/ds)^2)/R,

so that between two points of an edge they exceed the straight line by an eighth of that (`kin.cylindrical.roller`; of a
roller on an arm, of a cone and beside the axis what `kin.cylindrical.led_gauge` says). What is missing, at any one
angle, is greatest at corners of a polygon, for the distance from a straight axis is convex: triangles are cut into
strips, each with an angle of its own, by straight lines whose ends lie on the edges.

Angles k w, k = 0, 1, ..., make the points of an edge and the strips: the angle of the worst place is laid straight
along the edge between those of its ends, and a point stands where it is k w. Near that angle the point holds the roller
at least as high as F says, so that nothing can fall between two angles unseen.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.cylindrical.grid import FINE, Grid
from kin.cylindrical.within import holding
from kin.numeric.arrays import runs_of
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kin.cylindrical.roller import Gauge, Worst
    from kin.numeric.arrays import Array, Indices, Mask

NODES = 250_000  # points of edges at a time
ON_GRID = 1e-6  # of the grid's step, within which an angle is on the grid
HALVINGS = 40  # of an edge
MOST_OPEN = 300_000  # parts of edges that may stay undecided
TORN = 0.2  # of the tolerance: where angles cannot be laid straight along an edge, since it joins two flanks' parts


class Peak(NamedTuple):
    """A greatest value, mm, its shaft angle, rad, and by how much the true one may lie above it."""

    value: float
    at: float
    remainder: float


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges of a mesh by the numbers of their ends, a and b (n,), among points (v, 3), with what they count for.

    worst    the points at their worst angles, (v,) each; of those that no edge ends at it may be nan
    flank    (n,) whether they belong to triangles of the flank, whose distance from the exact one is measured
    reached  (n,) whether the roller, with its ends, may touch them
    beside   (n,) whether they are of other turns' walls, which must leave the roller without ends room
    corners  (t, 3) triangles that it may touch
    """

    points: Array
    worst: Worst
    a: Indices
    b: Indices
    flank: Mask
    reached: Mask
    beside: Mask
    corners: Indices


class Seen(NamedTuple):
    """What edges show to a roller, with proved bounds.

    out      greatest height of the metal over the exact flank along z, mm, of what the roller reaches
    holds    (n,) for the angles of the grid: the roller stands at least so high over its intended place, mm
    least    (n,) likewise over all angles within half a step of them; -inf where nothing holds it
    proud    greatest distance, mm, of the flank's surface out of the metal, and of that of other turns beside it
    bare     greatest distance, mm, of the flank's surface into the metal, beside triangles along torn edges
    torn     (m,) numbers of edges that join different parts of a flank
    grid     the angles
    """

    out: Peak
    holds: Array
    least: Array
    proud: Peak
    bare: Peak
    torn: Indices
    grid: Grid


class _Parts(NamedTuple):
    """Parts of edges (n,): both ends' places (n, 2, 3), worst angles, heights and distances (n, 2 each).

    `out` and `proud` (n,) bound what stands out along z and along the normal; -inf where a part does not count.
    """

    ends: Array
    theta: Array
    heights: Array
    distances: Array
    out: Array
    proud: Array

    def take(self, which: Mask | Indices) -> _Parts:
        return _Parts(*(rows[which] for rows in self))


def look(gauge: Gauge, edges: Edges, tolerance: float, angles: int) -> Seen:
    """Look at edges from a roller, by a grid of so many angles; bounds are sharp to a share of the tolerance, mm.

    Raises UnsettledError where bounds do not come close to what is reached.
    """
    return _Look(gauge, edges, tolerance, angles).seen()


class _Best:
    """A greatest value so far, its angle, and the greatest bound of all that is settled."""

    def __init__(self, period: float) -> None:
        self.period, self.value, self.at, self.bound = period, -math.inf, math.nan, -math.inf

    def reached(self, values: Array, theta: Array) -> None:
        """Take in values (n,) that are reached at angles (n,)."""
        if len(values):
            k = int(np.argmax(values))
            if values[k] > self.value:
                self.value, self.at = float(values[k]), float(theta[k])

    def settled(self, bounds: Array) -> None:
        """Take in bounds (n,) that need no more work."""
        self.bound = max(self.bound, float(bounds.max(initial=-math.inf)))

    @property
    def peak(self) -> Peak:
        """The value with what the bounds leave open."""
        return Peak(self.value, self.at % self.period, max(self.bound - self.value, 0.0))


class _Look:
    """A look at edges: corners first, then points along them, block by block, then the parts that are left open."""

    def __init__(self, gauge: Gauge, edges: Edges, tolerance: float, angles: int) -> None:
        self.gauge, self.near, period = gauge, FINE * tolerance, gauge.lifts.period
        self.tear = TORN * tolerance
        self.grid = Grid.of(gauge, angles)
        self.holds, self.least = (np.full(len(self.grid), -np.inf) for _ in range(2))
        self.out, self.proud, self.bare = (_Best(period) for _ in range(3))
        self.open: list[_Parts] = []
        self.torn = np.zeros(len(edges.a), dtype=np.bool_)

        self.points, self.worst, a, b = edges.points, edges.worst, edges.a, edges.b
        turned = self.worst.theta[b] - self.worst.theta[a]
        turned -= period * np.round(turned / period)
        back = turned < 0.0
        self.a, self.b, self.turned = np.where(back, b, a), np.where(back, a, b), np.abs(turned)
        self.flank, self.reached, self.corners = edges.flank, edges.reached, edges.corners
        self.walled = edges.flank | edges.beside

    def seen(self) -> Seen:
        """All that the edges show."""
        self._corners(self.reached, self.out, self.worst.height, inside=True)
        self._corners(self.walled, self.proud, -self.worst.distance)
        self._corners(self.flank, self.bare, self.worst.distance)
        start, width = self.worst.theta[self.a], self.grid.width
        # an angle of the grid at which corners stand belongs to all edges there, whatever their rounding
        first = np.ceil(start / width - ON_GRID)
        count = np.maximum(np.floor((start + self.turned) / width + ON_GRID) - first + 1.0, 0.0).astype(np.intp)
        total, begin = np.cumsum(count + 2), 0
        while begin < len(total):
            done = int(total[begin - 1]) if begin else 0
            end = max(begin + 1, int(np.searchsorted(total, done + NODES, side="right")))
            self._block(slice(begin, end), first[begin:end].astype(np.intp), count[begin:end])
            begin = end
        self._within_triangles(tolerance=self.near / FINE)
        self._strips()
        self._refine()
        torn = np.flatnonzero(self.torn)
        return Seen(self.out.peak, self.holds, self.least, self.proud.peak, self.bare.peak, torn, self.grid)

    def _corners(self, which: Mask, best: _Best, values: Array, *, inside: bool = False) -> None:
        """Take in the values (v,) of corners of some edges, where the roller has its length if that counts."""
        chosen = np.zeros(len(self.points), dtype=np.bool_)
        chosen[self.a[which]] = chosen[self.b[which]] = True
        if inside:
            chosen &= self._within(self._along(self.points, self.worst.theta))
        best.reached(values[chosen], self.worst.theta[chosen])

    @staticmethod
    def _along(points: Array, theta: Array) -> Array:
        along: Array = points[..., 0] * np.cos(theta) + points[..., 1] * np.sin(theta)
        return along

    def _within(self, along: Array) -> Mask:
        inside: Mask = (along >= self.gauge.inner) & (along <= self.gauge.outer)
        return inside

    def _block(self, rows: slice, first: Indices, count: Indices) -> None:
        """Points along some edges, of each from its `first` angle of the grid, `count` of them."""
        grid, gauge, width = self.grid, self.gauge, self.grid.width
        a, b, turned = self.a[rows], self.b[rows], self.turned[rows]
        flank, reached, walled = self.flank[rows], self.reached[rows], self.walled[rows]
        start, way = self.points[a], self.points[b] - self.points[a]
        begin = self.worst.theta[a]
        own, step = runs_of(count)
        k = first[own] + step
        theta = width * k.astype(np.float64)
        share = np.clip((theta - begin[own]) / np.maximum(turned[own], 1e-300), 0.0, 1.0)
        points = [start[:, j][own] + share * way[:, j][own] for j in range(3)]
        fall = np.minimum(self.worst.bend[a], self.worst.bend[b])[own]

        k %= len(grid)
        lifted = grid.lift[k], grid.slope[k], grid.bend[k]
        height, rate, distance, along = gauge.near(points, lifted, grid.sine[k], grid.cosine[k])
        with np.errstate(invalid="ignore", divide="ignore"):
            more = rate**2 / (2.0 * fall)
        known = np.isfinite(height) & np.isfinite(more)
        height, more = np.where(known, height, -np.inf), np.where(known, more, np.inf)
        upright = height.copy()

        # what is not higher than the flank is not proud of it either
        needless = known & (height + np.where(known, more, 0.0) <= min(self.out.value, 0.0))
        hard = np.flatnonzero((more > 0.1 * self.near) & (flank[own] | ((reached | walled)[own] & ~needless)))
        if len(hard):
            places = np.stack([column[hard] for column in points], axis=1)
            solved = gauge.worst(places, theta[hard])
            tears = flank[own[hard]] & ~(solved.height <= height[hard] + self.tear)
            self.torn[rows.start + own[hard[tears]]] = True
            height[hard], distance[hard], more[hard] = solved.height, solved.distance, 0.0
            theta[hard], along[hard] = solved.theta, self._along(places, solved.theta)
        within = self._within(along)
        self._midway(k, points, upright, reached[own] & within, flank[own] & ~self.torn[rows][own])
        chosen = reached[own] & within & (more < np.inf)
        self.out.reached(height[chosen], theta[chosen])
        self.proud.reached(-distance[walled[own]], theta[walled[own]])
        self.bare.reached(distance[flank[own]], theta[flank[own]])
        self._between(rows, (own, step, count), (share, theta, height + more, distance))

    def _midway(self, k: Indices, points: Sequence[Array], height: Array, held: Mask, flank: Mask) -> None:
        """Take in how high points hold the roller at angles number k (n,) and half a step to both sides.

        Bounds of what is missing of the flank hold for the two strips that meet at each point.
        """
        which = np.flatnonzero(held | flank)
        k, points, held, flank = k[which], [column[which] for column in points], held[which], flank[which]
        height = np.where(held, height[which], -np.inf)
        least = height
        for number in (k, k - 1):
            gives, away, along = self.gauge.held(points, *self.grid.after[:, number % len(self.grid)])
            self.bare.settled(away[flank])
            least = np.where(
                self._within(along) & (gives < least), gives, np.where(self._within(along), least, -np.inf)
            )
            least = np.where(np.isfinite(gives), least, -np.inf)
        np.maximum.at(self.holds, k, height)
        np.maximum.at(self.least, k, least)

    def _within_triangles(self, tolerance: float) -> None:
        """Look within triangles for what holds the roller where points of edges do not, to a tolerance, mm."""
        open_ = np.flatnonzero(~(self.least >= -tolerance))
        if not len(open_):
            return
        places, theta = self.points[self.corners], self.worst.theta[self.corners]
        for held in holding(self.gauge, self.grid, places, theta, open_):
            points = list(held.points.T)
            k = held.number
            gives = self.gauge.held(points, self.grid.lift[k], self.grid.sine[k], self.grid.cosine[k]).gives
            height = np.where(np.isfinite(gives), gives, -np.inf)
            every = np.ones(len(k), dtype=np.bool_)
            self._midway(k, points, height, every, ~every)

    def _between(
        self,
        rows: slice,
        laid: tuple[Indices, Indices, Indices],
        at: tuple[Array, Array, Array, Array],
    ) -> None:
        """Bounds between neighbours of the points of edges; those far above what is reached are kept to be parted."""
        a, b, turned = self.a[rows], self.b[rows], self.turned[rows]
        start, way = self.points[a], self.points[b] - self.points[a]
        (own, step, count), worst = laid, self.worst
        size = count + 2
        head = np.cumsum(size) - size
        tail, place = head + count + 1, head[own] + 1 + step

        def row(first: Array, between: Array, last: Array) -> Array:
            whole = np.empty(int(size.sum()))
            whole[head], whole[place], whole[tail] = first, between, last
            return whole

        shares = row(np.zeros(len(a)), at[0], np.ones(len(a)))
        thetas = row(worst.theta[a], at[1], worst.theta[a] + turned)
        heights = row(worst.height[a], at[2], worst.height[b])
        distances = row(worst.distance[a], at[3], worst.distance[b])
        edge = np.repeat(np.arange(len(a)), size)
        low = np.ones(len(edge), dtype=np.bool_)
        low[tail] = False
        i = np.flatnonzero(low)
        edge = edge[i]
        # how fast y goes along the edge, at its ends and over the angles between them
        flat = np.hypot(way[:, 0], way[:, 1])
        rate = np.maximum(
            *(np.abs(way[:, 1] * np.cos(t) - way[:, 0] * np.sin(t)) for t in (thetas[head], thetas[tail]))
        )
        rate = np.minimum(rate + flat * (0.125 * turned**2 + self.grid.width), flat)
        part, bend = shares[i + 1] - shares[i], np.abs(thetas[i + 1] - thetas[i])
        bend = np.where(bend > 2.0 * self.grid.width, flat[edge], rate[edge]) * part
        first, last = (heights[i], distances[i]), (heights[i + 1], distances[i + 1])
        bends = self.gauge.bounds(bend, way[:, 2][edge] * part, flat[edge] * part, np.minimum(first[1], last[1]))
        out, proud = peak_between(first[0], last[0], bends[0]), peak_between(-first[1], -last[1], bends[1])
        walled, reached = self.walled[rows][edge], self.reached[rows][edge]
        near = (out <= self.out.value + self.near) | ~reached, (proud <= self.proud.value + self.near) | ~walled
        closed = near[0] & near[1]
        self.out.settled(out[closed & reached])
        self.proud.settled(proud[closed & walled])
        open_ = np.flatnonzero(~closed)
        if len(open_):
            edge, i = edge[open_], i[open_]
            pair = np.stack([i, i + 1], axis=1)
            ends = start[edge][:, None, :] + shares[pair][:, :, None] * way[edge][:, None, :]
            self._sorted(
                self._bounded(ends, thetas[pair], heights[pair], distances[pair], (reached[open_], walled[open_]))
            )

    def _strips(self) -> None:
        """Bounds of corners of the flank within their own strips."""
        chosen = np.zeros(len(self.points), dtype=np.bool_)
        whole = self.flank & ~self.torn
        chosen[self.a[whole]] = chosen[self.b[whole]] = True
        k = np.floor(self.worst.theta[chosen] / self.grid.width).astype(np.intp) % len(self.grid)
        self.bare.settled(self.gauge.held(list(self.points[chosen].T), *self.grid.after[:, k]).away)

    def _bounded(
        self, ends: Array, theta: Array, heights: Array, distances: Array, counts: tuple[Mask, Mask]
    ) -> _Parts:
        """Parts of edges with their bounds; `counts` says which may be reached, and which are walls."""
        way = ends[:, 1] - ends[:, 0]
        flat = np.hypot(way[:, 0], way[:, 1])
        across = np.abs(way[:, None, 1] * np.cos(theta) - way[:, None, 0] * np.sin(theta)).max(axis=1)
        across = np.minimum(across + flat * np.maximum(np.abs(theta[:, 1] - theta[:, 0]), self.grid.width), flat)
        limited = self._limited(ends, theta, heights, flat, counts[0])
        bends = self.gauge.close_bounds(ends, theta, (across, way[:, 2], flat), distances.min(axis=1))
        out = peak_between(*limited, bends[0])
        proud = peak_between(-distances[:, 0], -distances[:, 1], bends[1])
        out, proud = np.where(counts[0], out, -np.inf), np.where(counts[1], proud, -np.inf)
        return _Parts(ends, theta, heights, distances, out, proud)

    def _limited(self, ends: Array, theta: Array, heights: Array, room: Array, reached: Mask) -> tuple[Array, Array]:
        """Upper bounds (n,), (n,) of F at both ends of parts, at angles that bring some point of a part to the roller.

        Points lie within the roller's length where |y| is at most sqrt(r^2 - inner^2) and at least
        sqrt(r^2 - outer^2); along a part of a length `room` seen along z y and r change by no more than that.
        """
        gauge = self.gauge
        along = self._along(ends, theta)
        beyond = np.flatnonzero(reached & ~self._within(along).all(axis=1))
        if not len(beyond):
            return heights[:, 0], heights[:, 1]
        points, more = ends[beyond], room[beyond]
        r = np.hypot(points[..., 0], points[..., 1])
        with np.errstate(invalid="ignore"):
            most = np.sqrt(r.max(axis=1) ** 2 - gauge.inner**2) + more
            least = np.sqrt(np.maximum((r.min(axis=1) - more) ** 2 - gauge.outer**2, 0.0)) - more
        found = heights.copy()
        for k in (0, 1):
            found[beyond, k] = self._at_most(points[:, k], theta[beyond, k], heights[beyond, k], (least, most))
        return found[:, 0], found[:, 1]

    def _at_most(self, points: Array, theta: Array, heights: Array, limits: tuple[Array, Array]) -> Array:
        """Greatest F (n,) of points at angles with |y| between limits (n,), by that at any angle; -inf for none."""
        least, most = limits
        r, phi = np.hypot(points[:, 0], points[:, 1]), self.gauge.polar(points, theta)
        y = points[:, 1] * np.cos(theta) - points[:, 0] * np.sin(theta)
        # nan: nothing of it is within the roller's length; nor is what is too far across
        there = (most >= 0.0) & (least < self.gauge.reach)
        found = np.where(there, heights, -np.inf)
        off = np.flatnonzero(there & ((np.abs(y) > most) | (np.abs(y) < least)))
        if len(off):
            nearest = np.clip(np.abs(y[off]), least[off], most[off])
            both = []
            for sense in (-1.0, 1.0):
                turn = np.arcsin(np.clip(sense * nearest / r[off], -1.0, 1.0))
                gives = self.gauge.stand(points[off], phi[off] - turn).gives
                allowed = (sense * y[off] >= 0.0) | (np.abs(y[off]) < least[off])
                both.append(np.where(allowed, np.where(np.isfinite(gives), gives, heights[off]), -np.inf))
            found[off] = np.minimum(np.maximum(*both), heights[off])
        return found

    def _inside(self, points: Array, worst: Worst) -> Array:
        """Greatest F (n,) of points while they are within the roller's length; -inf where they never are."""
        heights = worst.height.copy()
        beyond = np.flatnonzero(~self._within(self._along(points, worst.theta)))
        if len(beyond):
            r = np.hypot(points[beyond, 0], points[beyond, 1])
            with np.errstate(invalid="ignore"):
                most = np.sqrt(r**2 - self.gauge.inner**2)
            least = np.sqrt(np.maximum(r**2 - self.gauge.outer**2, 0.0))
            heights[beyond] = self._at_most(points[beyond], worst.theta[beyond], heights[beyond], (least, most))
        return heights

    def _sorted(self, parts: _Parts) -> None:
        """Settle the parts whose bounds are close to what is reached, and keep the others."""
        open_ = (parts.out > self.out.value + self.near) | (parts.proud > self.proud.value + self.near)
        self.out.settled(parts.out[~open_])
        self.proud.settled(parts.proud[~open_])
        if open_.any():
            self.open.append(parts.take(open_))

    def _refine(self) -> None:
        """Halve the open parts until their bounds are close to what is reached."""
        for _ in range(HALVINGS):
            if not self.open:
                return
            parts = _Parts(*(np.concatenate(rows) for rows in zip(*self.open, strict=True)))
            self.open = []
            self._sorted(parts)  # more may have been reached since
            if not self.open:
                return
            (parts,) = self.open
            self.open = []
            if len(parts.out) > MOST_OPEN:
                break
            middle = parts.ends.mean(axis=1)
            worst = self.gauge.worst(middle, parts.theta[:, 0])
            counts = parts.out > -np.inf, parts.proud > -np.inf
            self.out.reached(self._inside(middle, worst)[counts[0]], worst.theta[counts[0]])
            self.proud.reached(-worst.distance[counts[1]], worst.theta[counts[1]])
            for half in (0, 1):
                own = [parts.ends[:, half], parts.theta[:, half], parts.heights[:, half], parts.distances[:, half]]
                pairs = [np.stack([one, other], axis=1) for one, other in zip(own, (middle, *worst[:3]), strict=True)]
                self._sorted(self._bounded(pairs[0], pairs[1], pairs[2], pairs[3], counts))
        raise UnsettledError("bounds of the flank's edges do not come close to what is reached")


def peak_between(first: Array, last: Array, bend: Array) -> Array:
    """Greatest value (n,) of parabolas from `first` to `last` (n,) over 0 to 1, their second derivatives -bend (n,)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.abs(last - first)
        between = 0.5 * (first + last) + 0.125 * bend + np.where(bend > 0.0, apart**2 / (2.0 * bend), 0.0)
    simple = (2.0 * apart >= bend) | ((first == -np.inf) & (last == -np.inf))
    return np.where(simple, np.maximum(first, last), between)
