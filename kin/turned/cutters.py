"""What a cutter that follows the passes of a program leaves of a flank: metal cut away, and metal left.

A cutter on an axis square to the drum's, which stands at the angle A, x along the drum and y beside its axis, with its
end at the distance Z, is from a point at the polar angle phi, the radius r and the height z at the distance

    H = (hypot(r sin(phi - A) - y, z - x) - C(X)) cos d,    X = r cos(phi - A),    if X is no less than Z.

C(X) = C + (X - Z) tan d is its radius there, d the half angle of a cutter that tapers.

Between points of a pass A, x and y move evenly. The least H over all positions is D: below 0 the point is cut away by
so much, above 0 so much metal stands on it, as a cutter larger by d leaves a surface d away. D is taken at points
p(theta, rho) of the exact flank, over all angles and the roller's length.

Over a cell of h1 rad by h2 mm D is less than at the least of its corners by no more than (h1^2 M11 + h2^2 M22)/8, with
bounds M of the second derivatives of H: the least of functions bends upwards no faster than they do. Nor is it more
than at the greatest corner by more than that and what the slopes of H at the corners differ by. The nearest position is
sought from the point's own angle on, over neighbouring blocks.

The motion may take several turns, and a pass meets a point on each. What lies within the roller of another turn is
none of the flank's metal, and that turn's cutter may take it: where a cell reaches into that roller, or comes nearer to
it than it is large, another turn counts for what is left alone, and is held against its own flank for what it cuts.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol, TypeVar

import numpy as np

from kin.numeric.angles import TURN
from kin.numeric.arrays import runs_of
from kin.turned.moves import Pass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from kin.law.contacts import Side
    from kin.numeric.arrays import Array, Indices, Mask
    from kin.turned.guide import Axis, Guide

Along = TypeVar("Along", float, "Array")

LOOKS = 720  # parts of a turn over each of which the flank's second derivatives are bounded
STEPPED = 0.1  # of the tolerance, by which D may differ over a step that a pass leaves
ACROSS, ALONG = 0.05, 0.05  # of the tolerance, by which D may differ between angles, and between places of the roller
NEARLY = 0.9  # of the cutter's radius: a point that is nearer to its axis is cut away by more than any tolerance
END = 1e-4  # mm that a cutter's end counts deeper, so that points at its very end are met
NEAR = 10.0  # times the tolerance: a pass that leaves so much more than another decides nothing
LONGEST = 0.02  # rad of a block: Newton's method is at home within
STEPS, CONED, HOPS = 2, 3, 60  # of Newton's method in a block, of a cone, and blocks on the way to the nearest
MOST_POINTS, ROOMY = 4_000_000, 1.1  # of points to begin with, and times as many where cutters are more askew
FINER = 1.02  # of the finest tolerance: as near as it is found
TINY = 1e-9  # mm, for nothing where it divides: a point may lie on the axis of a cutter
ROUNDING = 1e-6  # of a part of a turn
ROOM = 0.01  # rad
TILT, LEAN = 0.4, 1.6  # rad, times the root of the tolerance, mm: how much a cutter is askew on chords, to begin with
ALIKE, SMALLER = 0.01, 0.1  # of the radius: one that is smaller by more leans more, rad
EXACT = 5e-3  # rad: blocks of the roller's own path, by which it is told where another turn's roller is
APART = 1e-3  # mm that this path is off by at most, beside what a cell measures
BINS = 720  # parts of a turn, of each of which it is known how far along the drum a pass goes
BLOCK = 16  # angles, looked at together for another turn's pass
SKIPPED = 2, 4  # rows and angles of a cell, over which a pass is told to take nothing
THIN_ROWS, THIN = 6, 12  # every so many points are looked at, to see that a pass is far off


class Lifts(Protocol):
    """Motion of a track's roller along its guide, over the shaft angle, rad."""

    @property
    def span(self) -> tuple[float, float]:
        """Shaft angles between which the track is asked for."""

    @property
    def breaks(self) -> Array:
        """Angles (k,) of the span at which a derivative may jump."""

    def at(self, theta: Array) -> tuple[Array, Array, Array]:
        """Position, slope and bend (n,) each at angles (n,), rad."""

    def enclosure(self, lower: Array, upper: Array, order: int) -> tuple[Array, Array]:
        """Balls mid +- rad (order + 1, n) of the position and its derivatives between angles (n,), rad, of the span."""

    def repeats(self, turns: int) -> bool:
        """Whether a roller is in the same place after so many whole turns."""


class Track(Protocol):
    """A flank of a track in a turning body, and the roller without ends that leaves it, its axis square to that."""

    @property
    def side(self) -> Side:
        """Side of the roller on which the metal lies."""

    @property
    def radius(self) -> float:
        """Radius of the roller, mm."""

    @property
    def inner(self) -> float:
        """Where the roller begins along its axis, mm."""

    @property
    def outer(self) -> float:
        """Where it ends, mm."""

    @property
    def floor(self) -> float:
        """Radius, mm, down to which the flank reaches."""

    @property
    def reach(self) -> float:
        """Distance, mm, from the plane of the body's axis and the roller's direction, within which it touches."""

    @property
    def spread(self) -> float:
        """How fast the roller's radius grows along its axis."""

    @property
    def ends(self) -> tuple[float, float]:
        """Places along the body's axis, mm, beyond which there is no metal."""

    @property
    def led(self) -> Guide:
        """Guide of the roller's axis: a slide or an arm."""

    @property
    def lifts(self) -> Lifts:
        """Motion along that guide."""

    def size(self, along: Along) -> Along:
        """Radius of the roller, mm, at places along it, mm."""

    def axis(self, theta: Array) -> Array:
        """Place of the roller's axis along that of the body, mm (n,), at shaft angles (n,), rad."""

    def leaning(self, axis: Axis[Array], along: Array) -> tuple[Array, Array, Array]:
        """Sine and cosine of the contact's angle at places along the roller, mm, and h, mm."""


class Left(NamedTuple):
    """Heights of the cut metal over a flank at angles theta (n,), rad, and places rho (m,), mm.

    `off` (m, n) is the height, mm, below 0 where the cutter went too deep, and inf where nothing cuts. `above` and
    `below` (m - 1, n - 1) bound it over the cells between.
    """

    theta: Array
    rho: Array
    off: Array
    above: Array
    below: Array


class _Cutter(NamedTuple):
    """A cutter by its radius at its end, mm, and how fast that grows along its axis."""

    radius: float
    growth: float

    @property
    def upright(self) -> float:
        """Cosine of its half angle."""
        return 1.0 / math.hypot(1.0, self.growth)


class _Points(NamedTuple):
    """Points of a flank (m, n): shaft angle, polar angle, radius, height; derivatives by theta and rho, (3, m, n).

    `before` is by how much a point is before the roller's axis, rad; sine and cosine are those of the contact's angle.
    The components of the derivatives are along the roller, square to it and to the drum's axis, and along that.
    """

    theta: Array
    phi: Array
    before: Array
    r: Array
    z: Array
    sine: Array
    cosine: Array
    by_theta: Array
    by_rho: Array

    def part(self, rows: slice, columns: slice) -> _Points:
        """Those at some of the places and angles."""
        return _Points(*(values[..., rows, columns] for values in self))

    def thinned(self, rows: Indices, columns: Indices) -> _Points:
        """Points at the places `rows` (k,) and the angles `columns` (l,), each place with each angle."""
        return _Points(*(values[..., rows[:, None], columns] for values in self))


class _Met(NamedTuple):
    """How a pass comes to points (m, n): D, mm, how far out, mm, theta less A, rad, and slopes of H (2, m, n).

    `lean` is the angle, rad, between the flank's normal there and the way from the cutter's axis.
    """

    off: Array
    along: Array
    tilt: Array
    lean: Array
    slopes: Array


class _Askew(NamedTuple):
    """How much a cutter's angle differs from the roller's that touches at a point, and its normal there, rad."""

    tilt: float
    lean: float


def left_on(gauge: Track, passes: Sequence[Pass], radius: float, tolerance: float, growth: float = 0.0) -> Left | None:
    """What passes of a cutter leave of a flank; None where it would take too many points.

    The cutter has the `radius`, mm, at its end, and grows by `growth` along its axis. The flank has to be regular, its
    motion without jumps of the velocity, and no pass may turn to and fro. What is
    told of cells beyond the body's ends does not count.
    """
    cutter = _Cutter(radius, growth)
    ways = [_forwards(one) for one in _deepest(passes)]
    askew, shape = _begun(gauge, cutter, tolerance), _Shape.of(gauge)
    if not _is_told(_grid(shape, cutter, askew, tolerance), MOST_POINTS):
        return None
    while True:
        found = _left(shape, ways, cutter, askew, tolerance)
        if found is None:
            return None
        left, widest = found
        if widest.tilt <= askew.tilt and widest.lean <= askew.lean:
            return left
        askew = _Askew(max(askew.tilt, 1.5 * widest.tilt), max(askew.lean, 1.5 * widest.lean))


def finest_on(gauge: Track, radius: float, growth: float = 0.0) -> float:
    """Least tolerance, mm, to within `FINER`, to which `left_on` tells what a cutter leaves of a flank."""
    cutter, shape = _Cutter(radius, growth), _Shape.of(gauge)

    def told(tolerance: float) -> bool:
        return _is_told(_grid(shape, cutter, _begun(gauge, cutter, tolerance), tolerance), MOST_POINTS)

    high = 1.0
    while told(0.25 * high):
        high *= 0.25
    low = 0.25 * high
    while high > FINER * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if told(middle) else (middle, high)
    return high


def _begun(gauge: Track, cutter: _Cutter, tolerance: float) -> _Askew:
    """How much a cutter is taken to be askew to begin with."""
    sizes = (float(gauge.size(rho)) for rho in (gauge.inner, gauge.outer))
    smaller = max(abs(size - cutter.radius) for size in sizes) / cutter.radius > ALIKE
    return _Askew(TILT * math.sqrt(tolerance), LEAN * math.sqrt(tolerance) + (SMALLER if smaller else 0.0))


def _is_told(grid: tuple[Array, Array], most: float) -> bool:
    """Whether a grid of angles and places has so many points at most."""
    return len(grid[0]) * len(grid[1]) <= most


def _deepest(passes: Sequence[Pass]) -> list[Pass]:
    """Of passes on the same way the deepest."""
    found: list[Pass] = []
    for one in sorted(passes, key=lambda each: each.z):
        if not any(one.same_way(other) for other in found):
            found.append(one)
    return found


def _forwards(one: Pass) -> Pass:
    """A pass with rising angles, its blocks parted so that each is nearly straight as a point sees it."""
    order = slice(None) if one.a[-1] >= one.a[0] else slice(None, None, -1)
    rows = [row[order] for row in (one.a, one.x, one.y)]
    count = np.maximum(np.ceil(np.diff(rows[0]) / LONGEST), 1.0).astype(np.intp)
    at = np.arange(len(count) + 1, dtype=np.float64)
    own, step = runs_of(count)
    share = np.append(own + step / count[own], at[-1])
    return type(one)(one.line, one.z, *(np.interp(share, at, row) for row in rows))


def _left(
    shape: _Shape,
    ways: Sequence[Pass],
    cutter: _Cutter,
    askew: _Askew,
    tolerance: float,
) -> tuple[Left, _Askew] | None:
    """What is left at points of a flank, and how much a cutter that decides there is askew at most.

    The points are as near to one another as one that is `askew` asks for; None where they are too many.
    """
    gauge = shape.gauge
    theta, rho = _grid(shape, cutter, askew, tolerance)
    if not _is_told((theta, rho), ROOMY * MOST_POINTS):
        return None
    points = _points(gauge, theta, rho)
    off = np.full(points.phi.shape, np.inf)
    above, below = (np.full((len(rho) - 1, len(theta) - 1), np.inf) for _ in range(2))
    h1, h2 = 0.25 * np.diff(theta), 0.25 * np.diff(rho)[:, None]
    bend, widest = tolerance * (ACROSS + ALONG), [0.0, 0.0]
    others = _Others(gauge, points)
    inside = corners_of(cells_within(points.z, gauge.ends))

    def far(one: Pass) -> tuple[bool, float]:
        """Passes along the other flank come last, deeper ones behind those that are less deep: they take less."""
        return float(np.mean(one.x - gauge.axis(one.a))) * gauge.side < 0.0, -one.z

    for one in sorted(ways, key=far):
        # a point is met a little nearer to the drum's axis than the roller meets it
        first = int(np.searchsorted(rho, one.z - 0.5 * cutter.radius))
        if first > len(rho) - 2:
            continue
        if _is_clear(points.part(slice(first, None, THIN_ROWS), slice(None, None, THIN)), one, gauge, cutter):
            continue
        for turn, stretch in _turns(one, theta, gauge.reach / gauge.floor + ROOM):
            own_turn = gauge.lifts.repeats(round(turn / TURN))
            for columns in [stretch] if own_turn else others.near(one, turn, stretch, cutter):
                begun = points.part(slice(first, None), columns)

                def come(
                    rows: Indices, places: Indices, begun: _Points = begun, one: Pass = one, turn: float = turn
                ) -> _Met:
                    return _nearest(begun.thinned(rows, places), one, turn, gauge, cutter)

                felt = _felt(off[first:, columns], come, askew, tolerance)
                if felt is None:
                    continue
                rows = slice(first + felt.start, first + felt.stop)
                here = (rows, columns)
                met = _nearest(points.part(*here), one, turn, gauge, cutter)
                taken = None if own_turn else others.takes(here, turn)
                own, apart = met.along >= one.z - END, met.off
                if taken is not None:
                    apart = np.where(taken, np.inf, apart)
                off[here] = np.minimum(off[here], np.where(own, apart, np.inf))
                near = own & inside[here] & (apart <= off[here] + NEAR * tolerance)
                turned = (met.tilt, met.lean)
                widest = [
                    max(most, float(np.abs(row[near]).max(initial=0.0)))
                    for most, row in zip(widest, turned, strict=True)
                ]
                cells = (slice(rows.start, rows.stop - 1), slice(columns.start, columns.stop - 1))
                spread = _over(met.slopes, np.maximum) - _over(met.slopes, np.minimum)
                most = _over(met.off, np.maximum) + spread[0] * h1[cells[1]] + spread[1] * h2[cells[0]] + bend
                above[cells] = np.minimum(above[cells], np.where(_over(own, np.minimum), most, np.inf))
                least = _over(apart, np.minimum) - bend
                held = own if taken is None else own & ~taken
                if taken is not None:
                    least = np.where(_over(taken, np.maximum), np.inf, least)
                below[cells] = np.minimum(below[cells], np.where(_over(held, np.maximum), least, np.inf))
    return Left(theta, rho, off, above, below), _Askew(*widest)


def _felt(own: Array, come: Callable[[Indices, Indices], _Met], askew: _Askew, tolerance: float) -> slice | None:
    """Rows from the first to the last at which a pass may take more than those before it, which leave `own` (m, n).

    Over cells of several of the grid it leaves no less than at their corners, but for what D bends by. `come` says how
    it comes to points at some rows and columns.
    """
    if not np.isfinite(own).any():
        return slice(0, len(own))
    skip, step = SKIPPED
    rows, columns = (
        np.append(np.arange(0, count - 1, by), count - 1) for count, by in zip(own.shape, SKIPPED, strict=True)
    )
    met = come(rows, columns)
    least = _over(met.off, np.minimum) - tolerance * (step**2 * ACROSS + skip**2 * ALONG)
    most = np.maximum(np.maximum.reduceat(own, rows[:-1], axis=0), own[rows[1:]])
    most = np.maximum(np.maximum.reduceat(most, columns[:-1], axis=1), most[:, columns[1:]])
    # what D bends by is known of cutters that are askew by no more than has been taken
    beyond = (np.abs(met.tilt) > askew.tilt) | (np.abs(met.lean) > askew.lean)
    beyond &= met.off <= own[rows[:, None], columns] + NEAR * tolerance
    felt = np.flatnonzero(((least <= most) | _over(beyond, np.maximum)).any(axis=1))
    return slice(int(rows[felt[0]]), int(rows[felt[-1] + 1]) + 1) if len(felt) else None


class _Others:
    """Rollers of the other turns beside points of a flank."""

    def __init__(self, gauge: Track, points: _Points) -> None:
        self.gauge, self.points = gauge, points
        self.reach = gauge.reach / gauge.floor + ROOM
        self.low, self.high = points.z.min(axis=0), points.z.max(axis=0)

    def near(self, one: Pass, turn: float, columns: slice, cutter: _Cutter) -> list[slice]:
        """Stretches of angles, within some, at which a pass on another turn may come to points."""
        theta = self.points.theta[0, columns] + turn
        edges = np.arange(np.floor(one.a[0] * BINS / TURN), np.floor(one.a[-1] * BINS / TURN) + 2.0) * (TURN / BINS)
        at = np.interp(edges, one.a, one.x)
        low, high = np.minimum(at[:-1], at[1:]), np.maximum(at[:-1], at[1:])
        place = np.clip(np.searchsorted(edges, one.a, side="right") - 1, 0, len(low) - 1)
        np.minimum.at(low, place, one.x)
        np.maximum.at(high, place, one.x)
        # the lowest and highest place of the pass about each block of angles, and of the points there
        begin = np.arange(0, len(theta), BLOCK)
        end = np.minimum(begin + BLOCK, len(theta) - 1)
        first = np.clip(np.searchsorted(edges, theta[begin] - 2.0 * self.reach) - 1, 0, len(low) - 1)
        last = np.clip(np.searchsorted(edges, theta[end] + 2.0 * self.reach), 1, len(low))
        windows = [np.minimum(first + k, last - 1) for k in range(int((last - first).max()))]
        least = np.minimum.reduce([low[own] for own in windows])
        most = np.maximum.reduce([high[own] for own in windows])
        wide = cutter.radius + cutter.growth * float(self.points.r.max())
        close = least - wide <= np.maximum.reduceat(self.high[columns], begin)
        close &= most + wide >= np.minimum.reduceat(self.low[columns], begin)
        ends = np.flatnonzero(np.diff(np.concatenate([[0], close.astype(np.int8), [0]]))).reshape(-1, 2)
        # with a point beside each stretch, so that no cell is left out
        found = [(max(int(a) * BLOCK - 1, 0), min(int(b) * BLOCK + 1, len(theta))) for a, b in ends]
        return [slice(columns.start + a, columns.start + b) for a, b in found if b - a > 1]

    def takes(self, here: tuple[slice, slice], turn: float) -> Mask:
        """Whether points lie within the roller of another turn, or nearer to it than their cells are large."""
        gauge, points = self.gauge, self.points.part(*here)
        theta = points.theta[0]
        margin = self.reach + ROOM
        count = int(np.ceil((theta[-1] - theta[0] + 2.0 * margin) / EXACT)) + 1
        a = turn + np.linspace(theta[0] - margin, theta[-1] + margin, count)
        axis = gauge.led.axis(*gauge.lifts.at(a))
        path = Pass(0, 0.0, a, axis.z, axis.y)
        roller = _Cutter(float(gauge.size(0.0)), gauge.spread)
        met = _nearest(points, path, turn, gauge, roller)
        places = np.stack([points.r * np.cos(points.phi), points.r * np.sin(points.phi), points.z])
        size = sum(np.sqrt((np.diff(places, axis=axis) ** 2).sum(axis=0)).max(initial=0.0) for axis in (1, 2))
        taken: Mask = met.off <= 1.1 * size + APART
        return taken


def _is_clear(points: _Points, one: Pass, gauge: Track, cutter: _Cutter) -> bool:
    """Whether a pass stands so far from some points of a flank that it does not come to it anywhere between them."""
    theta = points.theta[0]
    far = np.inf
    for turn, columns in _turns(one, theta, gauge.reach / gauge.floor + ROOM):
        far = min(far, float(_nearest(points.part(slice(None), columns), one, turn, gauge, cutter).off.min()))
    places = np.stack([points.r * np.cos(points.phi), points.r * np.sin(points.phi), points.z])
    apart = [np.sqrt((np.diff(places, axis=axis) ** 2).sum(axis=0)).max(initial=0.0) for axis in (1, 2)]
    return bool(far > sum(apart))


def _turns(one: Pass, theta: Array, reach: float) -> list[tuple[float, slice]]:
    """Turns, rad, that a pass is met on, the longest stay first, each with the angles that may meet it on that turn."""
    first = int(np.floor((one.a[0] - theta[-1] - reach) / TURN))
    found = []
    for turn in range(first, int(np.ceil((one.a[-1] + reach) / TURN)) + 1):
        low, high = np.searchsorted(theta + TURN * turn, (one.a[0] - reach, one.a[-1] + reach))
        if high - low > 1:
            found.append((TURN * turn, slice(int(low), int(high))))
    return sorted(found, key=lambda each: each[1].start - each[1].stop)


def cells_within(z: Array, ends: tuple[float, float]) -> Mask:
    """Cells (m - 1, n - 1) between points at heights z (m, n), mm, that are not wholly beyond one of two heights."""
    return np.asarray((_over(z, np.maximum) >= ends[0]) & (_over(z, np.minimum) <= ends[1]))


def corners_of(cells: Mask) -> Mask:
    """Points (m, n) that are corners of any of some cells (m - 1, n - 1)."""
    found = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1), dtype=np.bool_)
    for rows in (slice(1, None), slice(None, -1)):
        for columns in (slice(1, None), slice(None, -1)):
            found[rows, columns] |= cells
    return found


def _over(values: Array | Mask, pick: np.ufunc) -> Array:
    """The greatest or the least of the corners of each cell, (..., m - 1, n - 1) of (..., m, n)."""
    rows = pick(values[..., 1:, :], values[..., :-1, :])
    found: Array = pick(rows[..., 1:], rows[..., :-1])
    return found


def _points(gauge: Track, theta: Array, rho: Array) -> _Points:
    """Where the roller touches, by n = -sin a e_t + cos a k, with derivatives."""
    axis, place, side = gauge.led.axis(*gauge.lifts.at(theta)), rho[:, None], gauge.side
    growth, size = gauge.spread, gauge.size(place)
    sine, cosine, h = gauge.leaning(axis, place)
    by_angle = (side * growth * axis.y1 - sine * axis.y2 + cosine * axis.z2) / h
    by_place, reach = -sine * (1.0 + growth**2) / h, side * size
    y, z = axis.y - reach * sine, axis.z + reach * cosine
    return _Points(
        np.broadcast_to(theta, y.shape),
        theta + np.arctan2(y, place),
        np.arctan2(axis.y - y, place),
        np.hypot(place, y),
        z,
        sine,
        cosine,
        np.stack([-y, place + axis.y1 - reach * cosine * by_angle, axis.z1 - reach * sine * by_angle]),
        np.stack(
            [
                np.ones_like(y),
                -side * growth * sine - reach * cosine * by_place,
                side * growth * cosine - reach * sine * by_place,
            ]
        ),
    )


def _grid(shape: _Shape, cutter: _Cutter, askew: _Askew, tolerance: float) -> tuple[Array, Array]:
    """Angles, rad, and places, mm, between which D changes by no more than the shares of the tolerance.

    All below are bounds of magnitudes over parts of the period, at all places from the roller's inner end to its outer.
    With N the way from the cutter's axis and t square to it, both square to that axis, H has the second derivatives
    (N.p_ii - tan d e_r.p_ii) cos d + (t.p_i)^2 cos d/dist. Beside the flank's normal, a taken for N, these are by theta

        N.p_11 = -sin a (y'' - q) + cos a z'' - side R a_1^2,    t.p_1 = cos a (rho + y') + sin a z' - side R a_1

    and by rho -side R a_2^2 and -side R a_2; what N is askew adds its share of what lies the other way.
    """
    gauge, looks, moved, bent = shape
    nearest, low, high = NEARLY * cutter.radius, gauge.inner, gauge.outer
    growth, size = gauge.spread, float(gauge.size(high))
    tilt, lean = askew
    beside, out = moved.y + size * bent.sine, high + 2.0 * (moved.y1 + size * bent.cosine * bent.first)
    speed = np.hypot(high + moved.y1, moved.z1) + size * bent.first + beside * (tilt + lean * growth)
    bend = bent.sine * (moved.y2 + beside) + bent.cosine * moved.z2 + size * bent.first**2
    bend += lean * (bent.cosine * (moved.y2 + beside) + bent.sine * moved.z2 + size * bent.second)
    second = bend + out * (tilt + cutter.growth)
    count = np.ceil(np.diff(looks) / np.sqrt(8.0 * ACROSS * tolerance / (speed**2 / nearest + second))).astype(np.intp)
    own, step = runs_of(count)
    theta = np.append(looks[own] + step * (np.diff(looks) / count)[own], gauge.lifts.span[1])
    along = (size * bent.along + lean * growth + tilt) ** 2 / nearest + size * bent.along**2
    along += lean * (2.0 * growth * bent.along + size * bent.along_twice)
    rows = int(np.ceil((high - low) * np.sqrt(float(along.max()) / (8.0 * ALONG * tolerance))))
    # a cutter that tapers otherwise leaves steps where its passes end
    steps = int(np.ceil((high - low) * abs(growth - cutter.growth) / (STEPPED * tolerance)))
    return theta, np.linspace(low, high, max(rows, steps, 1) + 1)


class _Moved(NamedTuple):
    """Bounds of the roller's axis over parts of the period (n,), mm: of |y| and three derivatives, of |z'| on likewise.

    y_low, y_high  of y' itself
    z_low          the least |z'|
    """

    y: Array
    y1: Array
    y2: Array
    y3: Array
    z1: Array
    z2: Array
    z3: Array
    y_low: Array
    y_high: Array
    z_low: Array

    @staticmethod
    def of(gauge: Track, looks: Array) -> _Moved:
        """Bounds between angles (n + 1,): the way T turns by the path's curvature k as the axis goes on by s'.

        Its derivatives are s' T, s'' T + k s'^2 E and (s3 - k^2 s'^3) T + 3 k s' s'' E, with E square to T.
        """
        guide = gauge.led
        mid, rad = gauge.lifts.enclosure(looks[:-1], looks[1:], 3)
        aside, ty, tz = guide.enclosed(mid[0] - rad[0], mid[0] + rad[0])
        lever, k = guide.lever, guide.bend
        _, s1, s2, s3 = lever * (np.abs(mid) + rad)
        low, high = lever * (mid[1] - rad[1]), lever * (mid[1] + rad[1])
        products = [own * each for own in (low, high) for each in ty]
        y, z = (np.maximum(np.abs(own[0]), np.abs(own[1])) for own in (ty, tz))
        return _Moved(
            np.maximum(np.abs(aside[0]), np.abs(aside[1])),
            y * s1,
            y * s2 + k * s1**2 * z,
            y * (s3 + k**2 * s1**3) + 3.0 * k * s1 * s2 * z,
            z * s1,
            z * s2 + k * s1**2 * y,
            z * (s3 + k**2 * s1**3) + 3.0 * k * s1 * s2 * y,
            np.minimum.reduce(products),
            np.maximum.reduce(products),
            np.maximum(tz[0], 0.0) * np.maximum(np.maximum(low, -high), 0.0),
        )


class _Bent(NamedTuple):
    """Bounds of the contact's angle a over parts of the period (n,): sine, cosine, and derivatives by theta and rho."""

    sine: Array
    cosine: Array
    first: Array
    second: Array
    along: Array
    along_twice: Array

    @staticmethod
    def of(gauge: Track, moved: _Moved) -> _Bent:
        """Bounds from those of the axis, from A sin a - z' cos a = side y g differentiated once and twice.

        With h = A cos a + z' sin a, which is no less than h(A, z') of the least of both.
        """
        growth, (low, high) = gauge.spread, (gauge.inner, gauge.outer)
        near = np.maximum(low + gauge.size(low) * growth + moved.y_low, TINY)
        far = high + gauge.size(high) * growth + moved.y_high
        lag = growth * moved.y
        w = np.hypot(near, moved.z_low)
        h = np.sqrt(np.maximum(w**2 - lag**2, TINY))
        sine = np.minimum(moved.z1 / np.hypot(near, moved.z1) + lag / w, 1.0)
        cosine = np.minimum(far / np.hypot(far, moved.z_low) + lag / w, 1.0)
        first = (growth * moved.y1 + sine * moved.y2 + cosine * moved.z2) / h
        lean = cosine * moved.y2 + sine * moved.z2
        second = growth * moved.y2 + sine * moved.y3 + cosine * moved.z3 + 2.0 * first * lean + lag * first**2
        along = sine * (1.0 + growth**2) / h
        twice = (2.0 * along * (1.0 + growth**2) * cosine + lag * along**2) / h
        return _Bent(sine, cosine, first, second / h, along, twice)


class _Shape(NamedTuple):
    """A track, and its period's parts by their ends (n + 1,), rad, with bounds of axis and contact over each."""

    gauge: Track
    looks: Array
    moved: _Moved
    bent: _Bent

    @staticmethod
    def of(gauge: Track) -> _Shape:
        """Bounds of a track, which are the same for every cutter and tolerance."""
        begin, end = gauge.lifts.span
        looks = np.linspace(begin, end, math.ceil((end - begin) / TURN * LOOKS - ROUNDING) + 1)
        looks = np.unique(np.concatenate([looks, gauge.lifts.breaks]))
        moved = _Moved.of(gauge, looks)
        return _Shape(gauge, looks, moved, _Bent.of(gauge, moved))


def _nearest(points: _Points, one: Pass, turn: float, gauge: Track, cutter: _Cutter) -> _Met:
    """How a pass with rising angles comes to points whose angles are `turn`, rad, more."""
    shape = points.phi.shape
    phi, r, z = (points.phi + turn).ravel(), points.r.ravel(), points.z.ravel()
    start = (points.theta + turn).ravel()
    if not one.y.any():
        start = phi + points.before.ravel() * (cutter.radius / gauge.radius)
    block = np.clip(np.searchsorted(one.a, start, side="right") - 1, 0, len(one.a) - 2)
    best, share = _least(one, block, (phi, r, z), cutter)
    open_, way = np.arange(phi.size), np.zeros(phi.size)
    for _ in range(HOPS):
        going = np.where(share[open_] >= 1.0, 1, np.where(share[open_] <= 0.0, -1, 0))
        going[going == -way[open_]] = 0  # back again: it is nearest at their joint
        going[(block[open_] + going < 0) | (block[open_] + going > len(one.a) - 2)] = 0
        open_, going = open_[going != 0], going[going != 0]
        if not len(open_):
            break
        way[open_], block[open_] = going, block[open_] + going
        best[open_], share[open_] = _least(one, block[open_], (phi[open_], r[open_], z[open_]), cutter)
    # where the way bends away from a point there is a nearest place on both sides of the bend
    other = np.clip(block + np.where(share < 0.5, -1, 1), 0, len(one.a) - 2)
    least, part = _least(one, other, (phi, r, z), cutter)
    nearer = least < best
    share, at = np.where(nearer, part, share), np.where(nearer, other, block)
    a, x, beside = (row[at] + share * (row[at + 1] - row[at]) for row in (one.a, one.x, one.y))
    y, v, along = r * np.sin(phi - a) - beside, z - x, r * np.cos(phi - a)
    far = np.hypot(y, v)
    off = (far - cutter.radius - (along - one.z) * cutter.growth) * cutter.upright
    y, v, far, a, off, along = (values.reshape(shape) for values in (y, v, far, a, off, along))
    tilt = np.remainder(points.theta - a + 0.5 * TURN, TURN) - 0.5 * TURN
    sine, cosine, slopes, far = np.sin(tilt), np.cos(tilt), [], np.maximum(far, TINY)
    for outward, across, up in (points.by_theta, points.by_rho):
        moved = (y * (outward * sine + across * cosine) + v * up) / far
        slopes.append((moved - (outward * cosine - across * sine) * cutter.growth) * cutter.upright)
    lean = (y * points.cosine + v * points.sine) / far
    return _Met(off, along, tilt, lean, np.stack(slopes))


def _least(one: Pass, block: Indices, places: tuple[Array, Array, Array], cutter: _Cutter) -> tuple[Array, Array]:
    """Where over a block each points, by polar angle, radius and height, are least far from the cutter.

    Gives how far they are from its axis less what it grows by (n,), mm, and the share of the block.
    """
    phi, r, z = places
    a, x, y = one.a[block], one.x[block], one.y[block]
    da, dx, dy = (row[block + 1] - row[block] for row in (one.a, one.x, one.y))
    share = np.full(len(phi), 0.5)
    for _ in range(STEPS if not cutter.growth else CONED):
        turn = phi - a - share * da
        across, along = r * np.sin(turn), r * np.cos(turn)
        beside, up = across - y - share * dy, z - x - share * dx
        rate, rise = -along * da - dy, -dx
        slope = beside * rate + up * rise
        bend = rate**2 + rise**2 - beside * across * da**2
        if cutter.growth:
            far = np.maximum(np.hypot(beside, up), TINY)
            bend += cutter.growth * far * along * da**2 - (slope / far) ** 2
            slope -= cutter.growth * far * across * da
        share = np.clip(share - slope / np.where(bend > 0.0, bend, 1.0), 0.0, 1.0)
    turn = phi - a - share * da
    beside, up = r * np.sin(turn) - y - share * dy, z - x - share * dx
    far = np.hypot(beside, up)
    return far - cutter.growth * r * np.cos(turn) if cutter.growth else far, share
