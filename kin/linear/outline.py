"""The exact outline of a plate, or the exact flanks of a groove, and how far a contour from a file is from them.

The outline is the flank below the follower, its straight or level run beyond both contacts, two ends square to the
travel and the lower edge. A piece of a contour is measured from that part to which it is nearest: on the flank by the
excess of metal (`kin.linear.pitch`), its extremes found piece by piece (`kin.numeric.extrema`). The other way round the
corners and points closely along the exact flank are measured from the contour.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import Arcs, dot, left
from kin.contour.nearest import nearest
from kin.linear.frame import frame
from kin.linear.pitch import Pitch
from kin.linear.undercut import cuts
from kin.numeric.extrema import extremes, resolution
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from kin.contour.contour import Contour
    from kin.linear.follower import LinearFollower
    from kin.linear.intent import Ends
    from kin.linear.pitch import Feet
    from kin.linear.undercut import Cut
    from kin.numeric.arrays import Array, Indices, Mask

LEAST_PARTS = 256  # a contour of fewer pieces is cut into about so many
MOST_TURN = 0.05  # rad; greatest turn of a part
FARTHER = 4.0  # times: so much farther than the metal the pitch curve's straight ends run
HALVINGS = 60  # of a piece, towards the place where it passes an end


class Strayed(NamedTuple):
    """How far a contour is from the exact one.

    outside, inside  greatest excess and greatest want of metal, mm; below 0 where there is none
    at               input, mm, at the worst place; nan where that is not on the flank
    bare             greatest distance of a point of the exact contour from this one, mm
    reach            lengths along x, mm, by which the flank reaches beyond the contacts at the first and the last input
    """

    outside: float
    inside: float
    at: float
    bare: float
    reach: tuple[float, float]

    @property
    def worst(self) -> float:
        """Greatest distance either way, mm."""
        return max(self.outside, self.inside, self.bare)


@dataclass(frozen=True, eq=False)
class Flank:
    """The exact flank below a follower, from `ends` to `ends`; of an endless motion over some periods from x = 0."""

    follower: LinearFollower
    ends: Ends | None = None
    periods: int = 1

    @cached_property
    def cuts(self) -> tuple[Cut, ...]:
        """Parts of the envelope that are cut off; of an endless motion those of one period."""
        if self.ends is None:
            return cuts(self.follower)
        return cuts(self.follower, beyond=self.ends.overrun, tangent=self.ends.tangent)

    @cached_property
    def contacts(self) -> Array:
        """Points (2, 2), mm, touched at the first and the last input by the envelope."""
        first, last = self.span
        rows = frame(self.follower, np.array([first, last]), 1 if self.follower.endless else np.array([1, -1]))
        points: Array = rows.centre - self.follower.radius * rows.normal
        return points

    @cached_property
    def span(self) -> tuple[float, float]:
        """First and last input, mm, over all periods."""
        first, last = self.follower.span
        return first, first + self.periods * (last - first)

    @cached_property
    def reach(self) -> tuple[float, float]:
        """Least and greatest x, mm, of the flank."""
        if self.ends is None:
            return self.span
        before, behind = self.ends.overrun
        return float(self.contacts[0, 0]) - before, float(self.contacts[1, 0]) + behind

    @cached_property
    def pitch(self) -> Pitch:
        """Pitch curve, with straight ends well beyond the metal."""
        switches = tuple((cut.begin, cut.end) for cut in self.cuts)
        if self.ends is None:
            length = self.follower.span[1] - self.follower.span[0]
            copies = range(-self.copies, self.copies + self.periods)
            moved = tuple((a + turn * length, b + turn * length) for turn in copies for a, b in switches)
            return Pitch(self.follower, periods=self.periods, switches=moved, copies=self.copies)
        slopes = np.abs(frame(self.follower, np.array(self.span), np.array([1, -1])).tangent[:, 0])
        least = float(max(slopes.min(), 1e-3))
        beyond = float(np.abs(self.contacts[:, 0] - self.reach).max())  # of a parallel `ends` do not tell
        long = FARTHER * (beyond + self.follower.radius) / least + (self.span[1] - self.span[0])
        return Pitch(self.follower, (long, long), self.ends.tangent, switches=switches)

    @cached_property
    def copies(self) -> int:
        """Periods of an endless motion, either way, whose rollers may touch the plate."""
        first, last = self.follower.span
        shift = np.abs(self.follower.centre(u := self.follower.cells, self._lift(u))[:, 0] - u).max()
        return math.ceil((float(shift) + self.follower.radius) / (last - first)) + 1

    def _lift(self, u: Array) -> Array:
        lift: Array = self.follower.law.derivatives(u, 0)[0]
        return lift

    @cached_property
    def corners(self) -> Array:
        """End points (2, 2), mm, of the flank: at the least x and at the greatest."""
        x = np.array(self.reach)
        if self.ends is None:
            return np.stack([x, self._height(x)], axis=-1)
        rows = frame(self.follower, np.array(self.span), np.array([1, -1]))
        if self.ends.tangent:
            slope = rows.tangent[:, 1] / rows.tangent[:, 0]
            return np.stack([x, self.contacts[:, 1] + slope * (x - self.contacts[:, 0])], axis=-1)
        # an arc of the roller about its last place, and level beyond that
        radius = self.follower.radius
        across = np.clip((x - rows.centre[:, 0]) * np.array([1.0, -1.0]), 0.0, radius)
        return np.stack([x, rows.centre[:, 1] - np.sqrt(radius**2 - across**2)], axis=-1)

    def _height(self, x: Array) -> Array:
        """Height (n,) of the flank at x (n,), mm, by halving: above it metal is in the rollers' way."""
        lift = self._lift(self.follower.cells)
        heights = self.follower.centre(self.follower.cells, lift)[:, 1]
        low = np.full(len(x), heights.min() - 2.0 * self.follower.radius - 1.0)
        high = np.full(len(x), heights.max() + 1.0)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            over = self.pitch.feet(np.stack([x, middle], axis=-1)).excess > 0.0
            low, high = np.where(over, low, middle), np.where(over, middle, high)
        return low

    @cached_property
    def points(self) -> Array:
        """Points (n, 2), mm, closely along the flank, and the corners that cuts leave."""
        u = self.pitch.inputs
        if self.ends is not None:
            before, behind = self.ends.overrun
            u = np.concatenate([[u[0] - 0.5 * before], u, [u[-1] + 0.5 * behind]])
        kept = np.ones(len(u), dtype=np.bool_)
        for begin, end in self.pitch.switches:
            kept &= (u <= begin) | (u >= end)
        points, _ = self.pitch.envelope(u[kept])
        corners = [cut.corner for cut in self.cuts]
        points = np.concatenate([points, np.array(corners).reshape(-1, 2)])
        points = points[(points[:, 0] >= self.reach[0]) & (points[:, 0] <= self.reach[1])]
        return np.concatenate([points, self.corners])

    def inset(self, by: float) -> Flank:
        """The flank's parallel inside the metal at `by`, mm, its ends moved inside too."""
        if not by:
            return self
        ends = self.ends and replace(self.ends, overrun=(0.0, 0.0))
        moved = Flank(self.follower.larger(by), ends, self.periods)
        low, high = self.reach
        moved.__dict__["reach"] = (low + by, high - by)
        return moved


def parts_of(contour: Contour, within: float | None = None) -> Arcs:
    """The contour's lines and arcs in order, cut into about LEAST_PARTS parts that turn little."""
    chain, _ = contour.as_arcs(within)
    coarse = chain.length.sum() / LEAST_PARTS
    count = np.ceil(np.maximum(chain.length / coarse, np.abs(chain.curvature) * chain.length / MOST_TURN))
    return chain.cut(np.maximum(count, 1.0).astype(np.intp))[0]


def plate_strayed(
    contour: Contour, flank: Flank, tolerance: float, lower: float = 0.0, within: float | None = None
) -> Strayed:
    """Distance of a closed contour from a plate's exact outline, whose lower edge is at y = `lower`, mm.

    The flank reaches as far as metal within `tolerance`, mm, of it does.
    """
    parts = parts_of(contour, within)
    (low, high), ends = flank.reach, flank.corners
    # each part with its start, middle and end, which is the next one's start
    count = len(parts)
    points = np.concatenate([parts.start, parts.points(0.5 * parts.length)])
    away = _from_edges(points, flank, lower)
    feet = flank.pitch.feet_within(points, away.min(axis=0) + tolerance)
    owner, clipped = _owners(np.concatenate([_from_flank(points, feet, flank)[None], away]))
    own = np.flatnonzero(owner == 0)
    known = feet.take(np.concatenate([own, count + own, (own + 1) % count]))
    *of_flank, place = _on_flank(parts.take(own), flank, known)
    straight = ((1, [-1.0, 0.0], -low), (2, [1.0, 0.0], high), (3, [0.0, -1.0], -lower))
    found = [of_flank, *(_on_line(parts.take(owner == k), np.array(n), offset) for k, n, offset in straight)]
    outside, inside = max(row[0] for row in found), max(row[1] for row in found)
    exact = np.concatenate([flank.points, [[low, lower], [high, lower]], ends])
    bare = float(nearest(contour.as_arcs(within)[0], exact)[1].max())
    at = place if max(of_flank) >= max(outside, inside, clipped, bare) else math.nan
    outside = clipped if clipped > max(outside, inside) else outside
    return Strayed(outside, inside, at, bare, _reach(parts.start, feet.excess[:count], flank, tolerance))


def _from_edges(points: Array, flank: Flank, lower: float) -> Array:
    """Distances (3, n), mm, of points (n, 2) from a plate's two ends and its lower edge."""
    (low, high), corners = flank.reach, flank.corners
    x, y = points.T
    aside, below = np.maximum(np.maximum(low - x, x - high), 0.0), np.maximum(lower - y, 0.0)
    over = [np.maximum(np.maximum(y - corner, 0.0), below) for corner in corners[:, 1]]
    return np.stack([np.hypot(x - low, over[0]), np.hypot(x - high, over[1]), np.hypot(y - lower, aside)])


def _from_flank(points: Array, feet: Feet, flank: Flank) -> Array:
    """Distance (n,), mm, of points (n, 2) with their feet from the flank between its ends."""
    low, high = flank.reach
    x = points[:, 0]
    distance: Array = np.hypot(feet.excess, np.maximum(np.maximum(low - x, x - high), 0.0))
    return distance


def _owners(away: Array) -> tuple[Indices, float]:
    """Exact part (n,) of each piece: 0 flank, 1 and 2 ends, 3 lower edge; and the greatest distance of a start from it.

    `away` (4, 2n) are the distances from these, mm, of the pieces' starts, then of their middles.
    """
    start, middle = np.split(away, 2, axis=1)
    end = np.roll(start, -1, axis=1)
    owner = np.maximum(np.maximum(start, end), middle).argmin(axis=0)
    every = np.arange(len(owner))
    return owner, float(np.maximum(start[owner, every], end[owner, every]).max())


def _reach(points: Array, excess: Array, flank: Flank, tolerance: float) -> tuple[float, float]:
    """Lengths along x, mm, by which points (n, 2) within a tolerance of the flank reach beyond both contacts."""
    x = points[np.abs(excess) <= tolerance, 0]
    if not x.size:
        return -math.inf, -math.inf
    return float(flank.contacts[0, 0] - x.min()), float(x.max() - flank.contacts[1, 0])


def _rows(parts: Arcs, s: Array) -> tuple[Array, Array, Array]:
    """Points and two derivatives by the arc length, (n, 2) each."""
    tangent = parts.tangents(s)
    return parts.points(s), tangent, parts.curvature[:, None] * left(tangent)


def _on_flank(parts: Arcs, flank: Flank, known: Feet | None = None) -> tuple[float, float, float]:
    """Greatest excess and want, mm, of n pieces by the flank, and an input near the worse.

    `known` are the feet of all starts, then of the middles, then of the ends, (3n,).
    """
    if not len(parts):
        return -math.inf, -math.inf, math.nan
    thrice = parts.take(np.tile(np.arange(len(parts)), 3))
    s = np.concatenate([np.zeros(len(parts)), 0.5 * parts.length, parts.length])
    points, *rates = _rows(thrice, s)
    feet = flank.pitch.feet(points) if known is None else known
    start, middle, end = np.split(feet.along(*rates), 3, axis=1)
    beside = np.split(feet.input, 3)

    def rows(at: Array, half: Indices) -> Array:
        piece = half % len(parts)
        point, *along = _rows(parts.take(piece), at)
        return flank.pitch.feet(point, beside[1][piece]).along(*along)

    first, half, last = np.split(s, 3)
    low, high = np.concatenate([first, half]), np.concatenate([half, last])
    at_low, at_high = np.concatenate([start, middle], axis=1), np.concatenate([middle, end], axis=1)
    fine = resolution(np.concatenate([parts.start, flank.corners]))
    found = extremes(low, high, at_low, at_high, rows, resolution=fine)
    worse = found.least_index if -found.least > found.greatest else found.greatest_index
    return found.greatest, -found.least, float(beside[1][worse % len(parts)])


def _on_line(parts: Arcs, normal: Array, offset: float) -> tuple[float, float]:
    """Greatest excess and want, mm, of pieces over the line normal.x = offset; arcs by their farthest points."""
    if not len(parts):
        return -math.inf, -math.inf
    over = [dot(points, normal) - offset for points in (parts.start, parts.ends)]
    # an arc is farthest out where its tangent runs along the line
    along, across = dot(parts.tangent, normal), dot(left(parts.tangent), normal)
    k = parts.curvature
    turn = np.arctan2(-along, across) if k.any() else np.zeros(len(parts))
    for by in (0.0, np.pi):
        with np.errstate(divide="ignore", invalid="ignore"):
            angle = np.where(k < 0.0, -turn + by, turn + by) % (2.0 * np.pi)
            s = angle / np.abs(k)
        inside = np.isfinite(s) & (s < parts.length)
        if inside.any():
            arc = parts.take(inside)
            over.append(dot(arc.points(s[inside]), normal) - offset)
    every = np.concatenate(over)
    return float(every.max()), -float(every.min())


def groove_strayed(
    contour: Contour, lower: Flank, upper: Flank, tolerance: float, within: float | None = None
) -> tuple[Strayed, Strayed]:
    """Distance of a groove's closed contour from its two flanks; `upper` is that of the reflected follower.

    What joins the flanks beyond their ends is free. A flank reaches as far as metal within `tolerance`, mm, of it does.
    """
    found = []
    for flank, chain in ((lower, contour), (upper, contour.mirrored())):
        parts = parts_of(chain, within)
        for x in flank.reach:
            parts = _cut_at(parts, x)
        middle = parts.points(0.5 * parts.length)
        feet = flank.pitch.feet(np.concatenate([parts.start, middle]))
        near, below = (middle[:, 0] > flank.reach[0]) & (middle[:, 0] < flank.reach[1]), feet.excess[len(parts) :]
        outside, inside, at = _on_flank(parts.take(near & (below < flank.follower.radius)), flank)
        bare = float(nearest(chain.as_arcs(within)[0], flank.points)[1].max())
        reach = _reach(parts.start, feet.excess[: len(parts)], flank, tolerance)
        found.append(Strayed(outside, inside, at, bare, reach))
    return found[0], found[1]


def _cut_at(parts: Arcs, x: float) -> Arcs:
    """The pieces, those that pass x, mm, cut there."""
    begin, end = parts.start[:, 0] - x, parts.ends[:, 0] - x
    passing: Mask = (begin < 0.0) != (end < 0.0)
    if not passing.any():
        return parts
    whole = parts.take(passing)
    low, high, rising = np.zeros(len(whole)), whole.length.copy(), begin[passing] < 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = (whole.points(middle)[:, 0] < x) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    first = Arcs(whole.start, whole.tangent, whole.curvature, low)
    second = Arcs(whole.points(low), whole.tangents(low), whole.curvature, whole.length - low)
    return parts.take(~passing).joined(first).joined(second)
