"""Two flat regions in relative motion: their distance at an angle, and how fast it can change over an interval.

D is the distance between the regions where they are apart. Where they overlap it is negative: D = -d if the deepest
point of one boundary (or of a point kept well inside) lies d deep in the other region. D is continuous, and it is the
least, over such points b of either region, of the signed distance of b from the other.

Rate of D. Where D is attained at b, and a is the point nearest to b on the other boundary, the line ab is a normal n
there, and D changes at the rate n.v, v the velocity of b's body relative to a's at any point of that line: along a line
all points of a rigid body have the same component of velocity. The line passes through the centre of the arc that a
lies on. If b is no corner it is also a normal of the arc of b, and passes through that centre. Where several a are
nearest at once, the derivative is an average of their rates, and the average of their normals is a normal at b no
longer than one (Clarke's rule for a least of greatest values), so the same bounds hold. Each pair of features that may
be the nearest within an interval gives a bound by the normals it has and the velocities at its centre or on it; the
greatest of them bounds the rate of D. So a disc turning about its centre has rate 0, and rolling contact nearly so,
though points pass at speed.

A pair may be the nearest only if its distance at the middle exceeds |D| by no more than both can change meanwhile.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import dot, left, turned
from kin.contour.region import gaps, moved
from kin.numeric.arrays import paired
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from kin.contour.arcs import Arcs
    from kin.contour.region import Gaps, Region
    from kin.mechanism.pose import PoseCourse
    from kin.numeric.arrays import Array, Indices, Mask

__all__ = ["DEPTH_SHARE", "Encounter", "GapSamples", "Pairs", "Relative", "distances", "fastest", "rates", "see"]

ROUNDS = 40  # halvings of a piece searched for its deepest point: parts of 2^-40 of it are below rounding
DEPTH_SHARE = 0.02  # precision of a depth, as a part of it


@dataclass(frozen=True, eq=False)
class Relative:
    """Motion of a body relative to another over m intervals, in the other's axes (`home`), as it is at the middle.

    place (m, 2), angle (m,)  pose of the body at the middle, mm and rad
    drift (m, 2), turn (m,)   velocity of the body at the home's origin, mm/rad, and rate of turning, rad/rad
    stray (m,), twist (m,)    greatest errors of `drift` and `turn` anywhere in the interval, in the home's axes there
    half (m,)                 half the interval, rad
    """

    place: Array
    angle: Array
    drift: Array
    turn: Array
    stray: Array
    twist: Array
    half: Array

    @staticmethod
    def of(home: PoseCourse, body: PoseCourse, half: Array) -> Relative:
        """Work out the motion of `body` seen from `home`, over both courses' intervals of half width `half` (m,)."""
        back = -home.pose[:, 2]
        gap = body.pose[:, :2] - home.pose[:, :2]
        flow = body.rate[:, :2] - home.rate[:, :2]
        loose = np.hypot(*(body.spread + home.spread)[:, :2].T)
        speed = np.hypot(flow[:, 0], flow[:, 1]) + loose
        away = np.hypot(gap[:, 0], gap[:, 1])
        spin, own = (np.abs(c.rate[:, 2]) + c.spread[:, 2] for c in (body, home))
        # seen from the home, a vector fixed in direction turns, and the gap between the origins changes
        change = speed + own * (away + speed * half)
        stray = loose + speed * own * half + body.spread[:, 2] * away + spin * change * half
        return Relative(
            place=turned(gap, back),
            angle=body.pose[:, 2] + back,
            drift=turned(flow - body.rate[:, 2:] * left(gap), back),
            turn=body.rate[:, 2] - home.rate[:, 2],
            stray=stray,
            twist=body.spread[:, 2] + home.spread[:, 2],
            half=half,
        )

    @cached_property
    def spin(self) -> Array:
        """Upper bound (m,) of the relative rate of turning |dangle/dphi|, rad/rad."""
        return np.abs(self.turn) + self.twist

    def at(self, cell: Indices, point: Array) -> tuple[Array, Array]:
        """Velocity (k, 2), mm/rad, of the body at points (k, 2) of the home in intervals `cell` (k,); error (k,)."""
        velocity = self.drift[cell] + self.turn[cell, None] * left(point)
        return velocity, self.stray[cell] + self.twist[cell] * np.hypot(point[:, 0], point[:, 1])

    def along(self, cell: Indices, point: Array) -> tuple[Array, Array]:
        """Velocity (k, 2), mm/rad, of points of the body that are at `point` (k, 2) at the middle, and its error (k,).

        `cell` (k,) are the intervals; the error is a bound over the whole of each. The points move on, and their
        velocity changes by the turning times their way: hence the exponential (Gronwall).
        """
        velocity, off = self.at(cell, point)
        spin, half = self.spin[cell], self.half[cell]
        speed = np.hypot(velocity[:, 0], velocity[:, 1]) + off
        return velocity, off + spin * half * speed * np.exp(spin * half)


class Pairs(NamedTuple):
    """Pairs of features that may be the nearest within an interval: indices (k,) of interval, rising, and features."""

    cell: Indices
    first: Indices
    second: Indices

    def take(self, index: Indices | Mask) -> Pairs:
        """Return the pairs chosen."""
        return Pairs(self.cell[index], self.first[index], self.second[index])

    def finer(self, first: Region, second: Region) -> Pairs:
        """Return the pairs of the features' halves, in the finer regions of `first` and `second`."""
        # there piece k is 2 k and 2 k + 1; corners and the point inside stand farther on by the number of pieces
        cell, (i, j) = (
            self.cell,
            (
                feature + np.minimum(feature, region.pieces)
                for feature, region in ((self.first, first), (self.second, second))
            ),
        )
        more_i, more_j = self.first < first.pieces, self.second < second.pieces
        halved = more_i & more_j
        order = np.argsort(rows := np.concatenate([cell, cell[more_i], cell[more_j], cell[halved]]), kind="stable")
        return Pairs(
            rows[order],
            np.concatenate([i, i[more_i] + 1, i[more_j], i[halved] + 1])[order],
            np.concatenate([j, j[more_i], j[more_j] + 1, j[halved] + 1])[order],
        )

    def within(self, mask: Mask) -> Pairs:
        """Return the pairs of the intervals for which the mask (m,) holds, which are numbered anew."""
        chosen = self.take(mask[self.cell])
        return chosen._replace(cell=(np.cumsum(mask) - 1)[chosen.cell])


@dataclass(frozen=True, eq=False)
class Encounter:
    """Two regions over m intervals: the motion of the second seen from the first, and of the first from the second."""

    first: Region
    second: Region
    motion: Relative
    back: Relative

    @staticmethod
    def of(regions: tuple[Region, Region], home: PoseCourse, body: PoseCourse, half: Array) -> Encounter:
        """Make the encounter of regions on the courses `home` and `body`, over intervals of half width `half`, rad."""
        return Encounter(*regions, Relative.of(home, body, half), Relative.of(body, home, half))

    @cached_property
    def fastest(self) -> Array:
        """Upper bound (m,) of the speed, mm/rad, of any point of either region relative to the other."""
        return np.minimum(fastest(self.second, self.motion), fastest(self.first, self.back))

    @cached_property
    def discs_apart(self) -> Array:
        """Lower bound of D at the middles (m,), mm: distance of the discs about both, negative if they overlap."""
        (centre, radius), (second_centre, reach) = self.first.disc, self.second.disc
        gap = _placed(second_centre[None], self.motion)[:, 0] - centre
        return np.hypot(gap[:, 0], gap[:, 1]) - radius - reach

    def near(self, size: Array, half: Array) -> Pairs:
        """Pairs of features that may be the nearest somewhere in each interval, of half width `half` (m,), rad.

        A pair is left out where the discs about its features stay farther apart than D can be. `size` (m,) is a bound
        of |D| at the middles, mm; where it is nan, the distance of the two boundary features whose middles are nearest
        is the bound instead.
        """
        a, b = self.first.middle, self.second.middle
        reach = self.first.reach[:, None] + self.second.reach
        rim = (np.arange(len(a)) < self.first.boundary)[:, None] & (np.arange(len(b)) < self.second.boundary)
        places = _placed(b, self.motion)
        margin = 2.0 * half * self.fastest
        pairs = []
        for cell, (place, bound) in enumerate(zip(places, size, strict=True)):
            gap = np.hypot(a[:, None, 0] - place[:, 0], a[:, None, 1] - place[:, 1])
            limit = gap[rim].min() if np.isnan(bound) else bound
            i, j = np.nonzero(gap - reach <= limit + margin[cell])
            pairs.append(Pairs(np.full(len(i), cell), i, j))
        return Pairs(*(np.concatenate(rows) for rows in zip(*pairs, strict=True)))


def fastest(body: Region, motion: Relative) -> Array:
    """Upper bound (m,) of any point's speed, mm/rad: that of the centre of the body's disc, plus spin times radius."""
    centre, radius = body.disc
    velocity, off = motion.along(np.arange(len(motion.half)), _placed(centre[None], motion)[:, 0])
    speed: Array = np.hypot(velocity[:, 0], velocity[:, 1]) + off + motion.spin * radius
    return speed


def _placed(points: Array, motion: Relative) -> Array:
    """Points (n, 2) of the body in the home's axes at the middles of the intervals: (m, n, 2)."""
    c, s = np.cos(motion.angle)[:, None], np.sin(motion.angle)[:, None]
    x, y = points[:, 0], points[:, 1]
    return np.stack([c * x - s * y, s * x + c * y], axis=2) + motion.place[:, None]


class GapSamples(NamedTuple):
    """Distances at the middles of m intervals.

    value (m,)     D, mm, below 0 where the regions overlap
    doubt (m,)     greatest error of `value`, mm
    place (m, 2)   midway between the nearest points, or the deepest point, in the axes of the first region
    gap (k,)       distance of each pair of features, mm, or a lower bound of it
    """

    value: Array
    doubt: Array
    place: Array
    gap: Array


def see(meeting: Encounter, pairs: Pairs, precision: float, *, whole: bool = False) -> GapSamples:
    """Find D at the middle of each interval from the pairs that may be the nearest there, one at least in each.

    The depth of an overlap is found to `precision`, mm, or to 2 % of it if that is more. `whole` looks for the deepest
    point among all features, not only those paired.
    """
    first, second, motion = meeting.first, meeting.second, meeting.motion
    cell, every = pairs.cell, np.arange(len(motion.half))
    heads = np.searchsorted(cell, every)
    rim = (pairs.first < first.boundary) & (pairs.second < second.boundary)
    apart_at_most, gap = _by_discs(meeting, pairs)
    least = np.minimum.reduceat(np.where(rim, apart_at_most, np.inf), heads)
    close = np.flatnonzero(rim & (gap <= least[cell]))
    measured = distances(meeting, pairs.take(close))
    gap[close] = measured.distance
    value = np.minimum.reduceat(np.where(rim, gap, np.inf), heads)
    best = np.flatnonzero(measured.distance == value[cell[close]])
    best = best[np.searchsorted(cell[close[best]], every)]
    nearest = pairs.take(close[best])
    place = 0.5 * (measured.first[best] + measured.second[best])
    # Of two regions whose boundaries do not meet, the nearest points tell whether one reaches into the other.
    in_second = turned(measured.first[best] - motion.place, -motion.angle)
    apart = (first.side(nearest.first, measured.second[best]) > 0.0) & (second.side(nearest.second, in_second) > 0.0)
    overlap = np.flatnonzero((value == 0.0) | ~apart)
    doubt = np.zeros(len(value))
    if len(overlap):
        value[overlap], place[overlap] = _depths(meeting, None if whole else pairs, overlap, precision)
        doubt[overlap] = np.maximum(precision, DEPTH_SHARE * np.abs(value[overlap]))
    return GapSamples(value, doubt, place, gap)


def _by_discs(meeting: Encounter, pairs: Pairs) -> tuple[Array, Array]:
    """Upper and lower bounds of the distance of each pair, (k,) each, by the discs about both features."""
    motion, cell = meeting.motion, pairs.cell
    body = turned(meeting.second.middle[pairs.second], motion.angle[cell]) + motion.place[cell]
    apart = np.hypot(*(meeting.first.middle[pairs.first] - body).T)
    return apart, apart - meeting.first.reach[pairs.first] - meeting.second.reach[pairs.second]


def distances(meeting: Encounter, pairs: Pairs) -> Gaps:
    """Exact distances, mm, and nearest points of each pair at its interval's middle, in the first region's axes."""
    motion, cell = meeting.motion, pairs.cell
    body = moved(meeting.second.arcs.take(pairs.second), motion.place[cell], motion.angle[cell])
    return gaps(meeting.first.arcs.take(pairs.first), body)


def _depths(meeting: Encounter, pairs: Pairs | None, cells: Indices, precision: float) -> tuple[Array, Array]:
    """D (c,) in the intervals `cells` (c,), where the regions overlap, and the deepest point (c, 2).

    It is sought among the features of the pairs, or among all where `pairs` is None.
    """
    motion, back = meeting.motion, meeting.back
    value, place = np.full(len(cells), np.inf), np.zeros((len(cells), 2))
    row = np.full(len(motion.half), -1)
    row[cells] = np.arange(len(cells))
    for own, target, seen, feature in (
        (meeting.second, meeting.first, motion, pairs and pairs.second),
        (meeting.first, meeting.second, back, pairs and pairs.first),
    ):
        if pairs is None or feature is None:
            r, k = np.divmod(np.arange(len(cells) * len(own.reach)), len(own.reach))
        else:
            wanted = row[pairs.cell] >= 0
            codes = paired(row[pairs.cell[wanted]], feature[wanted], len(own.reach))
            r, k = np.divmod(np.unique(codes), len(own.reach))
        arcs = moved(own.arcs.take(k), seen.place[cells[r]], seen.angle[cells[r]])
        depth, point = _deepest(target, arcs, r, value, precision)
        if seen is back:
            point = turned(point, motion.angle[cells]) + motion.place[cells]
        deeper = depth < value
        value[deeper], place[deeper] = depth[deeper], point[deeper]
    return value, place


def _deepest(region: Region, arcs: Arcs, row: Indices, floor: Array, precision: float) -> tuple[Array, Array]:
    """Least signed distance from the region over the pieces of each row, and its point: (r,), (r, 2).

    `row` are the rows of the pieces `arcs`. Pieces that cannot come below `floor` (r,) are not halved.
    """
    value, place = np.full(len(floor), np.inf), np.zeros((len(floor), 2))
    limit = floor.copy()
    for _ in range(ROUNDS):
        middle = arcs.points(0.5 * arcs.length)
        piece, distance = region.nearest(middle)
        order = np.lexsort((distance, row))
        head = order[np.flatnonzero(np.diff(row[order], prepend=-1))]
        lower = head[distance[head] < value[row[head]]]
        value[row[lower]], place[row[lower]] = distance[lower], middle[lower]
        np.minimum(limit, value, out=limit)
        bound = np.maximum(distance - 0.5 * arcs.length, region.no_deeper(arcs, piece))
        open_ = bound < (limit - np.maximum(precision, DEPTH_SHARE * np.abs(limit)))[row]
        if not open_.any():
            break
        arcs, row = arcs.take(open_), np.repeat(row[open_], 2)
        arcs, _ = arcs.cut(np.full(len(arcs), 2))
    return value, place


def rates(meeting: Encounter, pairs: Pairs, apart: Mask) -> tuple[Array, Array]:
    """Two upper bounds (k,) for each pair over its interval, mm/rad: of |dD/dphi|, and of the rate of its own distance.

    The first holds at the angles at which this pair is the nearest or, of regions that overlap, has the deepest point.
    `apart` (m,) marks the intervals in which D > 0 throughout; there the first bound is sharper.
    """
    cell, i, j = pairs
    first, second, motion, back = meeting.first, meeting.second, meeting.motion, meeting.back
    spin = motion.spin[cell]
    body = turned(second.middle[j], motion.angle[cell]) + motion.place[cell]
    home = turned(first.middle[i], back.angle[cell]) + back.place[cell]
    of_first, of_second = (first.normal[i], first.fan[i]), (second.normal[j], second.fan[j])
    on_first, on_second = spin * first.reach[i], spin * second.reach[j]
    # velocity, and its error, of the middle of the second feature seen from the first region, and the other way round
    passing, passed = motion.along(cell, body), back.along(cell, home)
    # |n.v| with the normals n of either feature, and v at its centre of curvature or at points of either feature
    through = np.minimum(
        _projected(*of_first, *motion.at(cell, first.centre[i])) + _swung(spin, first.off[i]),
        _projected(*of_second, *back.at(cell, second.centre[j])) + _swung(spin, second.off[j]),
    )
    at_second = (
        np.minimum(_projected(*of_first, *passing), _projected(*of_second, *back.at(cell, second.middle[j])))
        + on_second
    )
    at_first = (
        np.minimum(_projected(*of_second, *passed), _projected(*of_first, *motion.at(cell, first.middle[i]))) + on_first
    )
    # of regions that overlap the deepest point may be of either feature
    at_features = np.where(apart[cell], np.minimum(at_first, at_second), np.maximum(at_first, at_second))
    speed = np.minimum(*(np.hypot(*v.T) + off + on for (v, off), on in ((passing, on_second), (passed, on_first))))
    return np.minimum(through, at_features), speed


def _swung(spin: Array, off: Array) -> Array:
    """Speed (k,) at the distance `off` (k,) from a centre; infinite where `off` is, also without spin."""
    centred = np.isfinite(off)
    return np.where(centred, spin * np.where(centred, off, 0.0), np.inf)


def _projected(normal: Array, fan: Array, velocity: Array, off: Array) -> Array:
    """Greatest |n.v| over normals n within `fan` (k,) of `normal` (k, 2), v within `off` (k,) of `velocity` (k, 2)."""
    along = np.abs(dot(normal, velocity))
    square = dot(velocity, velocity)
    across = np.sqrt(np.maximum(square - along * along, 0.0))
    c, s = np.cos(fan), np.sin(fan)
    beyond = (fan < 0.5 * np.pi) & (across * c > along * s)  # no normal has the direction of the velocity
    bound: Array = np.where(beyond, along * c + across * s, np.sqrt(square)) + off
    return bound
