"""Closed plane curves as moving frames: a point that runs along its tangent while the tangent turns.

Every profile is described by the same few numbers at a parameter `t`: the point, the unit tangent, the speed
``sigma`` with which the point moves along the tangent and the rate ``omega`` at which the tangent turns,

    c'(t) = sigma(t) T(t),    T'(t) = omega(t) (left normal of T),    curvature = omega / sigma.

For a support function p the parameter is the direction of the normal, ``omega = 1`` and ``sigma = rho = p + p''``
(AS eqs. 2, 3, 6). The parallel curve at distance e inside has ``sigma - e omega`` for its speed and everything else
unchanged, so offsets, cusps (sigma = 0), dwells and inflections (omega = 0) need no division and no special case.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

import numpy as np

from kin.numeric.errors import CamgeoError
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array
    from kin.numeric.jet import Series

    Side = int | NDArray[np.intp]

CELLS_PER_TURN = 96  # proved bounds are kept for about this many stretches; more cost time, fewer cost sharpness
CELLS_PER_STRETCH = 6  # and for at least this many between two breaks
SHARP_ENOUGH = 4.0  # a cell is halved while its bound is this many times what its own ends and middle show
HALVINGS = 24
MOST_CELLS = 20_000  # of the whole curve, where halving does not help: bounds stay loose, or the curve is refused
SHIFT = 1e-12  # relative and rad: far above the rounding by which parts of a turn are moved onto each other


class CurveError(CamgeoError, ValueError):
    """A curve for which no finite bound can be proved, with the parameter near which the proof fails."""

    def __init__(self, message: str, parameter: float) -> None:
        super().__init__(message)
        self.parameter = parameter


def columns(x: Array, y: Array) -> Array:
    """Coordinates x and y (n,) as points (n, 2): np.column_stack, in a third of its time where n is small."""
    out = np.empty((x.size, 2))
    out[:, 0], out[:, 1] = x, y
    return out


@dataclass(frozen=True)
class Frame:
    """The moving frame at n parameters: point, mm, and unit tangent (n, 2); speed, turn and their derivatives (n,).

    Speed sigma is mm, turn omega rad, per unit of the parameter.
    """

    point: Array
    tangent: Array
    speed: Array
    turn: Array
    speed_slope: Array
    turn_slope: Array

    @property
    def rows(self) -> tuple[Array, ...]:
        """Fields of the record, in their order, (n, 2) or (n,)."""
        return self.point, self.tangent, self.speed, self.turn, self.speed_slope, self.turn_slope

    def split(self, count: int) -> tuple[Frame, Frame]:
        """Frames at the first `count` parameters, and at the others."""
        return Frame(*(row[:count] for row in self.rows)), Frame(*(row[count:] for row in self.rows))

    def part(self, chosen: NDArray[np.bool_]) -> Frame:
        """Frames at the parameters for which `chosen` (n,) is true."""
        return Frame(*(row[chosen] for row in self.rows))

    def joined(self, other: Frame) -> Frame:
        """Frames of this record followed by the frames of the other."""
        return Frame(*(np.concatenate(pair) for pair in zip(self.rows, other.rows, strict=True)))

    @property
    def normal(self) -> Array:
        """Outward unit normal (n, 2): the tangent turned clockwise, the curve running counter-clockwise."""
        return columns(self.tangent[:, 1], -self.tangent[:, 0])

    @property
    def curvature(self) -> Array:
        """Signed curvature (n,), 1/mm, positive where the curve is convex; infinite or nan where the speed is 0."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.turn / self.speed

    @property
    def curvature_slope(self) -> Array:
        """Derivative of the curvature by arc length (n,), 1/mm^2; infinite or nan where the speed is 0."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return (self.turn_slope * self.speed - self.turn * self.speed_slope) / self.speed**3


@dataclass(frozen=True)
class Bounds:
    """Proved bounds of a frame over n parameter intervals; all (n,).

    `speed` and `turn` lie in [low, high]; the others are upper bounds of absolute values: `speed_slope` of sigma',
    `speed_bend` of sigma'', and likewise for the turn.
    """

    speed_low: Array
    speed_high: Array
    turn_low: Array
    turn_high: Array
    speed_slope: Array
    turn_slope: Array
    speed_bend: Array
    turn_bend: Array

    def rows(self) -> Array:
        """Fields of the record as one array (8, n), in their order."""
        ranges = self.speed_low, self.speed_high, self.turn_low, self.turn_high
        return np.stack([*ranges, self.speed_slope, self.turn_slope, self.speed_bend, self.turn_bend])


class Shape(Protocol):
    """A curve as a family of profiles gives it; `Curve` adds the measures that are the same for all families."""

    @property
    def period(self) -> float:
        """Period of the parameter, in its own unit."""
        ...

    @property
    def breaks(self) -> Array:
        """Parameters (m,) in [0, period), rising, at which speed or turn, or their derivatives, jump."""
        ...

    @property
    def repeats(self) -> int:
        """Number of equal parts of the turn, each of which is the part before it turned about the shaft."""
        ...

    @property
    def steady(self) -> Array:
        """Speed, mm, and turn, rad, per unit of the parameter for each stretch between breaks, (m, 2).

        nan on a stretch where they are not exactly constant.
        """
        ...

    @property
    def radii(self) -> Array:
        """Signed radius of curvature, mm, for each stretch between breaks, (m,); nan where not exactly constant."""
        ...

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,); at a break the limit from above (side 1) or from below (side -1).

        The side may differ from one parameter to the next (n,).
        """
        ...

    def series(self, t: Array, order: int, side: Side = 1) -> tuple[Array, Array]:
        """Taylor coefficients (order + 1, n) of speed, mm, and turn, rad, at parameters t (n,).

        At a break they are the limits from above (side 1) or from below (side -1).
        """
        ...

    def bounds(self, low: Array, high: Array) -> Bounds:
        """Proved bounds over the intervals [low, high] (n,), none of which spans a break."""
        ...

    def rates(self, tau: Series, side: Side = 1) -> tuple[Series, Series]:
        """Speed, mm, and turn, rad, as series at jets or ball jets of the parameter, of fewer orders than `tau`."""
        ...


@dataclass(frozen=True)
class SmoothRun:
    """Part of a curve without corners: parameters from `low` to `high`, and the breaks of curvature inside.

    A closed run is the whole curve, its end its beginning.
    """

    low: float
    high: float
    breaks: tuple[float, ...]
    closed: bool

    @property
    def stretches(self) -> Array:
        """Parameters (m, 2) of the ends of the smooth stretches between breaks, in order."""
        knots = np.array([self.low, *self.breaks, self.high])
        return np.column_stack([knots[:-1], knots[1:]])


@dataclass(frozen=True)
class Curve:
    """A closed counter-clockwise curve: a shape, and the runs that are kept.

    One closed run is the ordinary case. Several open runs are a contour trimmed where it would undercut: they meet in
    corners, the end of each run in the beginning of the next. For a curve run through the other way, `mirror` is the
    curve run forward, whose bounds it takes.
    """

    shape: Shape
    runs: tuple[SmoothRun, ...]
    mirror: Curve | None = field(default=None, repr=False, compare=False)

    @staticmethod
    def whole(shape: Shape) -> Curve:
        """Curve of the whole turn, begun at a break so that no stretch runs across the seam.

        A break where convex meets concave or straight is no place to begin; where all breaks are, the curve begins in
        the middle of a stretch.
        """
        breaks = np.asarray(shape.breaks, dtype=np.float64)
        if not breaks.size:
            return Curve(shape, (SmoothRun(0.0, shape.period, (), closed=True),))
        side = np.repeat([1, -1], breaks.size)
        after, before = shape.sample(np.tile(breaks, 2), side).split(breaks.size)
        alike = after.turn * before.turn > 0.0
        if alike.any():
            first = int(np.argmax(alike))
            low = float(breaks[first])
            inside = np.concatenate([breaks[first + 1 :], breaks[:first] + shape.period])
        else:
            low = 0.5 * float(breaks[-1] - shape.period + breaks[0])
            inside = breaks
        return Curve(shape, (SmoothRun(low, low + shape.period, tuple(float(b) for b in inside), closed=True),))

    @property
    def closed(self) -> bool:
        """True where the curve is one run without a corner."""
        return len(self.runs) == 1 and self.runs[0].closed

    @cached_property
    def size(self) -> float:
        """Greatest distance from the shaft among the ends of the cells, mm.

        With two cells or fewer, as a circle has, their middles count too: the ends may be the shaft itself.
        """
        t = np.append(self.cells.low, self.cells.high[-1])
        if len(t) <= 3:
            t = np.append(t, 0.5 * (self.cells.low + self.cells.high))
        point = self.sample(t).point
        return float(np.hypot(point[:, 0], point[:, 1]).max())

    @cached_property
    def cells(self) -> Cells:
        """Proved bounds over the whole curve, computed on first use; raises CurveError where a bound is not finite."""
        return Cells.of(self) if self.mirror is None else self.mirror.cells.backwards()

    def sample(self, t: Array, side: Side = 1) -> Frame:
        """Frame at parameters t (n,); at a break the limit from above (side 1) or from below (side -1)."""
        return self.shape.sample(t, side)

    def stretch_of(self, t: Array) -> NDArray[np.intp]:
        """Indices (n,) of the shape's stretches in which parameters t (n,) lie; stretch 0 begins at the first break."""
        breaks = np.asarray(self.shape.breaks, dtype=np.float64)
        if breaks.size == 0:
            return np.zeros(t.shape, dtype=np.intp)
        return (np.searchsorted(breaks, t % self.shape.period, side="right") - 1) % breaks.size

    def span(self, low: Array, high: Array) -> tuple[Frame, Frame]:
        """Frames at `low` and at `high` (n,) of intervals that span no break, each the limit from inside."""
        side = np.repeat([1, -1], [low.size, high.size])
        return self.shape.sample(np.concatenate([low, high]), side).split(low.size)

    @cached_property
    def _steady(self) -> Array:
        return self.shape.steady

    @cached_property
    def _radii(self) -> Array:
        return self.shape.radii

    def _index(self, stretch: Sequence[float] | Array) -> int:
        """Index of the shape's stretch that holds this one."""
        return int(self.stretch_of(np.array([0.5 * (stretch[0] + stretch[1])]))[0])

    def steady(self, stretch: Sequence[float] | Array) -> tuple[float, float] | None:
        """Speed, mm, and turn, rad, where both are exactly constant over a stretch (start, end); else None."""
        speed, turn = self._steady[self._index(stretch)]
        return None if np.isnan(speed) else (float(speed), float(turn))

    def radius(self, stretch: Sequence[float] | Array) -> float | None:
        """Signed radius of curvature, mm, where a stretch (start, end) is exactly a circular arc, else None."""
        radius = float(self._radii[self._index(stretch)])
        return None if np.isnan(radius) else radius


@dataclass(frozen=True)
class Cells:
    """Proved bounds on a partition of the curve: `low`, `high` (m,), rising, and `rows` (8, m) of `Bounds`."""

    low: Array
    high: Array
    rows: Array

    @staticmethod
    def of(curve: Curve) -> Cells:
        """Cells of a curve, halved where their bounds are far above the changes between their ends.

        Raises CurveError where no finite bound is found after `HALVINGS` halvings, or with about `MOST_CELLS` cells.
        """
        stretches = [stretch for run in curve.runs for stretch in run.stretches]
        period, repeats = curve.shape.period, curve.shape.repeats
        if repeats > 1 and curve.closed:
            if len(stretches) == 1:
                knots = np.linspace(stretches[0][0], stretches[0][1], repeats + 1)
                stretches = list(pairwise(knots))
            if len(stretches) % repeats == 0:
                part = stretches[: len(stretches) // repeats]
                first = _sharp_cells(curve, part, 2 * CELLS_PER_TURN / period, MOST_CELLS // repeats)
                return _repeat_cells(first, np.array(stretches).reshape(repeats, -1, 2))
        return _sharp_cells(curve, stretches, CELLS_PER_TURN / period, MOST_CELLS)

    def backwards(self) -> Cells:
        """Bounds of the curve run through the other way: its parameter and its turn are negated."""
        order = [0, 1, 3, 2, 4, 5, 6, 7]  # of `Bounds`: the lower bound of the turn is the upper one of its negative
        rows = self.rows[order, ::-1] * np.array([1.0, 1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0])[:, None]
        return Cells(-self.high[::-1], -self.low[::-1], rows)

    def over(self, low: Array, high: Array) -> Bounds:
        """Bounds over intervals from `low` to `high` (n,) between breaks: the worst of the cells that each touches."""
        first = np.clip(np.searchsorted(self.low, low, side="right") - 1, 0, self.low.size - 1)
        last = np.clip(np.searchsorted(self.low, high, side="left") - 1, first, self.low.size - 1)
        worst = self.rows[:, first]
        for step in range(1, int(np.max(last - first, initial=0)) + 1):
            cell = self.rows[:, np.minimum(first + step, last)]
            worst[0:4:2] = np.minimum(worst[0:4:2], cell[0:4:2])
            worst[1:4:2] = np.maximum(worst[1:4:2], cell[1:4:2])
            worst[4:] = np.maximum(worst[4:], cell[4:])
        return Bounds(*worst)


def _sharp_cells(curve: Curve, stretches: Sequence[tuple[float, float] | Array], density: float, most: int) -> Cells:
    """Cells of stretches that join, at first about `density` for each unit of parameter, none halved above `most`.

    A bound that is loose at the end is still a bound: it costs sharpness. Raises CurveError for one that is not finite.
    """
    # even cells of each stretch, a single one where speed and turn are constant
    lows, highs = [], []
    for low, high in stretches:
        count = 1 if curve.steady((low, high)) else max(CELLS_PER_STRETCH, int(np.ceil(density * (high - low))))
        knots = np.unique(np.linspace(low, high, count + 1))  # between neighbours of rounding there is no cell
        lows.append(knots[:-1])
        highs.append(knots[1:])
    low, high = np.concatenate(lows), np.concatenate(highs)
    rows = curve.shape.bounds(low, high).rows()
    # halve the cells with loose bounds, and keep all in order of the parameter
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        loose = _loose(curve, low, high, rows) & (low < middle) & (middle < high)
        if not loose.any() or low.size > most:
            break
        middle = middle[loose]
        new_low = np.concatenate([low[loose], middle])
        new_high = np.concatenate([middle, high[loose]])
        new_rows = curve.shape.bounds(new_low, new_high).rows()
        low = np.concatenate([low[~loose], new_low])
        high = np.concatenate([high[~loose], new_high])
        rows = np.concatenate([rows[:, ~loose], new_rows], axis=1)
        order = np.argsort(low, kind="stable")
        low, high, rows = low[order], high[order], rows[:, order]
    bad = ~np.isfinite(rows).all(axis=0)
    if bad.any():
        where, narrowest = float(low[bad][0]), float((high - low)[bad].min())
        raise CurveError(
            f"no finite bound on the curvature can be proved near parameter {where:.9g}: {int(bad.sum())} of "
            f"{bad.size} intervals have none, though divided down to {narrowest:.3g}",
            where,
        )
    return Cells(low, high, rows)


def _repeat_cells(part: Cells, stretches: Array) -> Cells:
    """Cells of the whole turn from the cells of its first part, and the stretches (parts, m, 2) of all parts."""
    owner = np.searchsorted(stretches[0, :, 0], part.low, side="right") - 1
    low = part.low + (stretches[:, owner, 0] - stretches[0, owner, 0])
    opens = np.flatnonzero(np.diff(owner, prepend=-1))
    low[:, opens] = stretches[:, :, 0]
    # the parts are one function folded, but their parameters are each rounded: bounds are widened as for a small shift.
    # Rows of speed and turn: 0 and 2 are lower bounds, 1 and 3 upper ones, 4 and 5 those of slopes, 6 and 7 of bends
    rows = part.rows.copy()
    rows[6:] *= 1.0 + SHIFT
    rows[4:6] += SHIFT * rows[6:]
    rows[0:4:2] -= SHIFT * rows[4:6]
    rows[1:4:2] += SHIFT * rows[4:6]
    low = low.ravel()
    return Cells(low, np.append(low[1:], stretches[-1, -1, 1]), np.tile(rows, len(stretches)))


def _loose(curve: Curve, low: Array, high: Array, rows: Array) -> NDArray[np.bool_]:
    """Whether a cell's bounds of second derivatives are not finite or far above the changes between ends (n,)."""
    at_low, at_high = curve.span(low, high)
    width = high - low
    bends = rows[6:8]
    seen = np.stack(
        [
            np.abs(at_high.speed_slope - at_low.speed_slope) / width,
            np.abs(at_high.turn_slope - at_low.turn_slope) / width,
        ]
    )
    scale = np.stack([rows[1], np.maximum(np.abs(rows[2]), np.abs(rows[3]))])
    with np.errstate(invalid="ignore"):
        # A bound that moves nothing by more than a thousandth over the cell need not be sharp.
        matters = bends * width**2 > 8e-3 * np.abs(scale)
        around = np.maximum(seen, np.maximum(np.roll(seen, 1, axis=1), np.roll(seen, -1, axis=1)))
        loose: NDArray[np.bool_] = (~np.isfinite(bends) | (matters & (bends > SHARP_ENOUGH * around))).any(axis=0)
    return loose


def cyclic_gap(a: float, b: float, period: float) -> float:
    """Distance of two parameters a and b the shorter way round a period, in the unit of the parameter."""
    gap = abs(a - b) % period
    return min(gap, period - gap)
