"""Clearance between moving flat bodies over one whole turn of the shaft, with a proved lower bound.

Bodies are stacks of slabs: regions with holes, between two heights. Two slabs are held against each other in plan where
their heights overlap. D is the distance between the two regions, below 0 where they overlap (`kin.mechanism.distance`).

The least of D over the turn is found by halving intervals of the shaft angle. Over an interval of half width h about
phi,  D >= D(phi) - L h,  L the bound of the rate of D there. An interval is closed when that bound is no more than the
accuracy below the least D found; other intervals are halved. The least of the bounds of all closed intervals is below D
at every angle, however narrow the window in which two bodies meet: nothing rests on how the turn was sampled. Pairs of
features that cannot be the nearest within an interval are left out in all parts of it.

The bound holds for the motions and contours as stated, up to rounding (about 1e-9 mm) and 1e-5 mm where a contour has
splines; how far a sampled motion may be from the true one is given beside it.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import combinations, product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kin.contour.arcs import turned
from kin.contour.region import Region
from kin.mechanism.distance import DEPTH_SHARE, Encounter, Pairs, rates, see
from kin.mechanism.pose import alike
from kin.numeric.angles import TURN, degrees
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from kin.contour.contour import Contour
    from kin.mechanism.distance import GapSamples
    from kin.mechanism.pose import PlaneMotion
    from kin.numeric.arrays import Array, Mask

__all__ = ["Clearance", "Mover", "Slab", "clearances"]

CELLS = 64  # intervals of a turn to begin with
FIRST = 4  # of these intervals, the most promising, are looked at before the rest
AT_ONCE = 256  # intervals that are worked on together
FINEST = 4  # times that pieces are halved along with the intervals
FEW = 16  # pairs in play for each interval, below which it pays to halve their pieces
MOST = 60_000  # intervals that a pair of bodies may take
SHARE = 1e-3  # accuracy as a part of the clearance
TOUCHING = 1e-9  # mm: an overlap of heights by less is rounding


@dataclass(frozen=True, eq=False)
class Slab:
    """A horizontal slab from z `low` to `high`: an outline with holes in it, in the axes of its body, mm.

    Raises ValueError unless low < high.
    """

    outer: Contour
    holes: tuple[Contour, ...]
    low: float
    high: float

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise ValueError(f"a slab from z = {self.low!r} to {self.high!r} mm has no height")

    @cached_property
    def region(self) -> Region:
        """Plane region of the slab, mm: the inside of the outline less the holes."""
        return Region.of(self.outer, self.holes)


@dataclass(frozen=True, eq=False)
class Mover:
    """A body: its slabs, one at least, and its motion over one turn of the shaft (`kin.mechanism.pose`)."""

    name: str
    slabs: tuple[Slab, ...]
    motion: PlaneMotion

    @property
    def reach(self) -> float:
        """Upper bound, mm, of the distance of any point of the body from its own origin."""
        return max(float(np.hypot(*slab.region.disc[0])) + slab.region.disc[1] for slab in self.slabs)

    @property
    def slack(self) -> float:
        """Greatest distance, mm, of a true point of the body from its stated place, as the motion's slack allows."""
        place, angle = self.motion.slack
        return place + angle * self.reach


@dataclass(frozen=True)
class Clearance:
    """Least clearance over one turn of the bodies named `a` and `b`.

    least         least distance in plan found, mm; where they overlap, minus the depth of the deepest point of
                  either in the other
    at_deg        shaft angle there, degrees in [0, 360)
    place         (x, y) there in the fixed axes, mm: midway between the nearest points, or the deepest point
    proved        lower bound, mm, of the distance at every angle
    slack         sum of the distances, mm, by which the bodies may be off their stated motions; 0 unless sampled
    evaluations   number of angles at which the distance was worked out
    """

    a: str
    b: str
    least: float
    at_deg: float
    place: tuple[float, float]
    proved: float
    slack: float
    evaluations: int

    @property
    def holds(self) -> bool:
        """Whether it is proved that the two bodies never overlap, the slack of sampled motions included."""
        return self.proved - self.slack >= 0.0

    @property
    def collides(self) -> bool:
        """Whether the two bodies overlap for certain at `at_deg`, the slack of sampled motions included."""
        return self.least + self.slack < 0.0


def clearances(
    movers: Sequence[Mover], exempt: Iterable[frozenset[str]] = (), *, axial: float = 0.0, accuracy: float = 1e-3
) -> list[Clearance]:
    """Clearance of each pair of bodies that have slabs at a common height, in the order of the movers.

    `exempt` holds pairs of names to leave out. Slabs count as at one height where they overlap in z or lie less than
    `axial`, mm, apart; with `axial` 0 slabs that only touch do not count. `proved` is below `least` by at most the
    greatest of `accuracy`, mm, 0.1 % of the clearance, and 5 % of the depth of an overlap; by more only where a pair
    takes over 60,000 angles. Raises ValueError for two movers of one name, and for an exempt pair that is not two names
    of movers.
    """
    names = [mover.name for mover in movers]
    if len(set(names)) < len(names):
        raise ValueError("two movers have one name")
    left_out = set(exempt)
    for pair in left_out:
        if len(pair) != 2 or not pair <= set(names):
            raise ValueError(f"unknown pair of bodies: {' and '.join(sorted(pair))}")
    verdicts = []
    for home, body in combinations(movers, 2):
        if {home.name, body.name} in left_out:
            continue
        search = _Search(home, body, accuracy)
        for first, second in product(home.slabs, body.slabs):
            if max(first.low, second.low) - min(first.high, second.high) < axial - TOUCHING:
                search.run((first.region, second.region))
        if search.evaluations:
            verdicts.append(search.clearance())
    return verdicts


class _Cells(NamedTuple):
    """Intervals phi +- half (m,), rad, lower bounds of D there (m,), mm, and the pairs that may be the nearest.

    `pairs` is None before the first look. Its features are those of `regions`, whose pieces have been halved `level`
    times along with the intervals.
    """

    phi: Array
    half: Array
    lower: Array
    regions: tuple[Region, Region]
    level: int = 0
    pairs: Pairs | None = None

    def within(self, mask: Mask) -> _Cells:
        """Intervals for which the mask (m,) holds, with their pairs."""
        pairs = self.pairs and self.pairs.within(mask)
        return self._replace(phi=self.phi[mask], half=self.half[mask], lower=self.lower[mask], pairs=pairs)

    def halved(self) -> _Cells:
        """Both halves of each interval: all first halves, then all second ones."""
        quarter, pairs, regions, level = 0.5 * self.half, self.pairs, self.regions, self.level
        if pairs is not None:
            if level < FINEST and len(pairs.cell) < FEW * len(self.phi):
                first, second = regions
                pairs, regions, level = pairs.finer(first, second), (first.finer, second.finer), level + 1
            after = pairs._replace(cell=pairs.cell + len(self.phi))
            pairs = Pairs(*(np.concatenate(rows) for rows in zip(pairs, after, strict=True)))
        phi = np.concatenate([self.phi - quarter, self.phi + quarter])
        return _Cells(phi, np.tile(quarter, 2), np.tile(self.lower, 2), regions, level, pairs)


class _Search:
    """Search for the least D of two bodies over pairs of slabs: the least value so far, and the bound proved so far."""

    def __init__(self, home: Mover, other: Mover, accuracy: float) -> None:
        self.home, self.other, self.accuracy = home, other, accuracy
        self.slack = home.slack + other.slack
        self.least, self.at, self.place = math.inf, 0.0, (math.nan, math.nan)
        self.proved = math.inf
        self.evaluations = 0

    @property
    def margin(self) -> float:
        """Greatest permitted difference, mm, of `least` and the lower bound: 0 before a distance has been measured."""
        if math.isinf(self.least):
            return 0.0
        return max(self.accuracy, SHARE * abs(self.least), -2.5 * DEPTH_SHARE * self.least)

    def run(self, regions: tuple[Region, Region]) -> None:
        """Search the whole turn for the least D of one pair of slabs' regions; updates `least` and `proved`."""
        stack = self._begin(regions)
        while stack:
            cells = stack.pop()
            cells = cells.within(self._open(cells.lower))
            if self.evaluations >= MOST:
                self.proved = min(self.proved, float(cells.lower.min(initial=math.inf)))
            elif len(cells.phi) > AT_ONCE:
                chosen = _lowest(cells.lower, AT_ONCE)
                stack += [cells.within(~chosen), cells.within(chosen)]
            elif len(cells.phi):
                stack += self._look(cells)

    def _begin(self, regions: tuple[Region, Region]) -> list[_Cells]:
        """Intervals to begin with, the most promising last; a single angle if the bodies move as one."""
        count = 1 if alike(self.home.motion, self.other.motion) else CELLS
        half = np.full(count, TURN / (2 * count) if count > 1 else 0.0)
        phi = (2 * np.arange(count) + 1) * half
        cells = _Cells(phi, half, np.full(count, -math.inf), regions)
        meeting = self._meeting(cells)
        cells = cells._replace(lower=meeting.discs_apart - half * meeting.fastest)
        chosen = _lowest(cells.lower, FIRST)
        return [cells.within(~chosen), cells.within(chosen)]

    def _meeting(self, cells: _Cells) -> Encounter:
        home, body = (mover.motion.over(cells.phi, cells.half) for mover in (self.home, self.other))
        return Encounter.of(cells.regions, home, body, cells.half)

    def _open(self, lower: Array) -> Mask:
        """Mask (m,) of the intervals whose lower bounds `lower` (m,), mm, leave a lesser D possible.

        `proved` becomes the least bound of the others, if that is less.
        """
        open_: Mask = lower < self.least - self.margin
        self.proved = min(self.proved, float(lower[~open_].min(initial=math.inf)))
        return open_

    def _look(self, cells: _Cells) -> list[_Cells]:
        """Work out D at the middle of each interval; the halves of the intervals that are left open."""
        meeting = self._meeting(cells)
        self.evaluations += len(cells.phi)
        if cells.pairs is None:
            return self._first_look(cells, meeting)
        pairs, half, fastest = cells.pairs, cells.half, meeting.fastest
        views = see(meeting, pairs, 0.25 * self.accuracy)
        self._take(cells.phi, views)
        # a pair farther apart than |D| and the changes of both in the interval is out of play
        size = np.abs(views.value) + views.doubt
        reachable = views.gap <= (size + 2.0 * half * fastest)[pairs.cell]
        pairs, gap = pairs.take(reachable), views.gap[reachable]
        rate, speed = rates(meeting, pairs, views.value - views.doubt > half * fastest)
        heads = np.searchsorted(pairs.cell, np.arange(len(half)))
        bound = np.minimum(fastest, np.maximum.reduceat(speed, heads))
        for _ in range(2):
            # a pair is in play only if both it and D can have come so near; fewer pairs in play bound D's rate lower
            in_play = gap <= (size + half * bound)[pairs.cell] + half[pairs.cell] * speed
            bound = np.minimum(bound, np.maximum.reduceat(np.where(in_play, rate, 0.0), heads))
        lower = np.maximum(cells.lower, views.value - views.doubt - half * bound)
        left = cells._replace(lower=lower, pairs=pairs.take(in_play))
        return [left.within(self._open(lower)).halved()]

    def _first_look(self, cells: _Cells, meeting: Encounter) -> list[_Cells]:
        """Find D among all pairs of features; the intervals that the greatest speed leaves open, with their pairs."""
        # no D is known yet: pairs are chosen by the distances of features at the middles
        unknown_size = np.full(len(cells.phi), np.nan)
        views = see(meeting, meeting.near(unknown_size, cells.half * 0.0), 0.25 * self.accuracy, whole=True)
        self._take(cells.phi, views)
        lower = np.maximum(cells.lower, views.value - views.doubt - cells.half * meeting.fastest)
        open_ = self._open(lower)
        left = cells._replace(lower=lower).within(open_)
        if not open_.any():
            return []
        meeting = self._meeting(left)
        size = (np.abs(views.value) + views.doubt)[open_]
        return [left._replace(pairs=meeting.near(size, left.half))]

    def _take(self, phi: Array, samples: GapSamples) -> None:
        k = int(np.argmin(samples.value))
        if samples.value[k] < self.least:
            self.least, self.at = float(samples.value[k]), float(phi[k])
            pose = self.home.motion.over(phi[k : k + 1], np.zeros(1)).pose
            x, y = (turned(samples.place[k : k + 1], pose[:, 2]) + pose[:, :2])[0].tolist()
            self.place = (x, y)

    def clearance(self) -> Clearance:
        """Verdict on the two bodies: their least distance, its place, and the lower bound that is proved."""
        return Clearance(
            a=self.home.name,
            b=self.other.name,
            least=self.least,
            at_deg=degrees(self.at),
            place=self.place,
            proved=min(self.proved, self.least),
            slack=self.slack,
            evaluations=self.evaluations,
        )


def _lowest(values: Array, count: int) -> Mask:
    """Mask (m,) of the `count` lowest of the values (m,)."""
    chosen: Mask = np.isin(np.arange(len(values)), np.argsort(values, kind="stable")[:count])
    return chosen
