"""Least radius of curvature of a curve, and stretches on which it runs backwards, for the whole turn, proved.

Both questions are about ``h = sigma - v omega``: the radius of curvature sigma/omega is at least v on convex stretches
where h >= 0, and the curve runs backwards (it undercuts) where h < 0 for v = 0. Between two points a distance w apart
h lies above the lower of its two values less ``B w^2/8``, B being the proved bound of its second derivative; intervals
are divided until that decides.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from camgeo.curve.curve import SHIFT, CurveError
from kin.numeric.distinct import distinct
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from camgeo.curve.curve import Cells, Curve, Frame
    from kin.numeric.arrays import Array, Mask

ROUNDING = 64.0 * float(np.finfo(np.float64).eps)  # of the curve's size: what sampled speeds and points may be off
SHARPNESS = 1e-12  # of the curve's size, or the radius if larger: how far a proved one may lie below the one found
SPLITS = 8  # parts into which an undecided interval is divided
LOOSE = 1e-9  # of the curve's size: this sharpness for curves that hardly differ from a circle over long stretches
MANY = 2_000  # intervals left undecided by `SHARPNESS` show such a curve
NEAR = 100.0  # times the tolerance: an end with so little more than the least radius counts as a minimum
GROWTH = 1.6  # from part to part away from a minimum already found
LEVELS = 30  # divisions of undecided intervals
MOST_INTERVALS = 100_000  # undecided at a time
FRESH = 1_000  # with so many undecided their bounds are formed anew, not taken over from their cells
_FALSE_POSITIONS = 40  # steps of the rule of false position; then halving alone
_ROOT_STEPS = _FALSE_POSITIONS + 56  # of a bracket: 53 halvings reach the rounding of its ends


@dataclass(frozen=True)
class Reversal:
    """Parameters `start` to `end` over which the curve stands still (`still`), or runs backwards."""

    start: float
    end: float
    still: bool


@dataclass(frozen=True)
class Least:
    """A least radius of curvature, mm, its parameter `at`, and the bound `excess` by which it may be smaller, mm.

    The excess is 0 where the radius is proved to `SHARPNESS` of the curve's size.
    """

    radius: float
    at: float
    excess: float = 0.0


def least_radius(curve: Curve) -> tuple[float, float]:
    """Least radius of curvature of the convex stretches, in mm, and its parameter; negative where it undercuts.

    One-sided limits at breaks count. No radius lies below the result by more than `SHARPNESS` of the curve's size, or
    of a larger radius itself (up to rounding of the samples); where it is proved less sharply, the result is its lower
    bound. A curve without a convex stretch has (inf, its first parameter). Raises CurveError where the proof does not
    end.
    """
    least = enclosed_least_radius(curve)
    return least.radius - least.excess, least.at


def enclosed_least_radius(curve: Curve) -> Least:
    """Least radius of curvature of the convex stretches, mm, and its parameter, with a bound of its error, mm.

    The radius is infinite, at the first parameter, for a curve without a convex stretch. Raises CurveError where the
    proof does not end. Stretches that are circles but for rounding would be divided without end: with many of them,
    and the radius's sign not in doubt, it is proved to `LOOSE` of the curve's size only.
    """
    cells = curve.cells
    possible = _may_hold_least(cells)
    if curve.closed and curve.shape.repeats > 1:  # all parts are alike
        possible &= cells.low < cells.low[0] + curve.shape.period / curve.shape.repeats * (1.0 - SHIFT)
    if not possible.any():
        return Least(math.inf, float(cells.low[0]))
    # circular arcs need no search, and would not end one
    arcs = _arc_radii(curve)
    best, place = _least_arc(curve, arcs, possible)
    possible &= np.isnan(arcs)
    if not possible.any():
        return Least(best, place)
    # rows 6 and 7 of the cells are the bounds of sigma'' and omega''
    state = _Intervals.of(
        curve, cells.low[possible], cells.high[possible], cells.rows[6, possible], cells.rows[7, possible]
    )
    extent = _extent(state.at_low)
    excess, loose = 0.0, LOOSE * curve.size
    # a turn that rounding alone lifts above 0, as where a hollow ends straight, is not convex
    straight = ROUNDING * float(np.abs(cells.rows[2:4]).max())

    def may_be_below(intervals: _Intervals) -> Mask:
        return intervals.floor(best - tolerance) < (-straight if math.isinf(best) else 0.0)

    least, worst = _least_end(state)
    if least < best:
        best, place = least, worst
    for _ in range(LEVELS):
        tolerance = excess or SHARPNESS * (max(extent, best) if math.isfinite(best) else extent)
        # minima inside intervals where the radius falls and rises
        dips = state.part(state.dips & may_be_below(state))
        ends = _radius_slope(dips.at_low), _radius_slope(dips.at_high)
        bottoms = roots(lambda t: _radius_slope(curve.sample(t)), dips.low, dips.high, ends, 1e-7)
        if bottoms.size:
            radius = _radius(curve.sample(bottoms))
            if radius.min() < best:
                best, place = float(radius.min()), float(bottoms[np.argmin(radius)])
        # intervals that may hold a smaller radius; of a near circle they are too many for the full sharpness
        state = state.part(may_be_below(state))
        if not excess and state.low.size > MANY and not 0.0 <= best <= loose:
            tolerance = excess = max(loose, tolerance)
            state = state.part(may_be_below(state))
        if state.low.size == 0:
            return Least(best, place, excess)
        if state.low.size > MOST_INTERVALS:
            break
        # about a minimum found, steps so fine that h cannot leave its ends' values by the tolerance
        grade = 0.5 * math.sqrt(8.0 * tolerance / max(state.bend(best).max(), 1e-300))
        minima = np.empty(0) if excess else np.concatenate([bottoms, state.ends_below(best + NEAR * tolerance)])
        state = state.subdivided(curve, minima, grade, fresh=not excess)
        least, worst = _least_end(state)
        if least < best:
            best, place = least, worst
    raise CurveError(
        f"the least radius of curvature near parameter {place:.9g}, {best:.9g} mm, cannot be proved", place
    )


def _arc_radii(curve: Curve) -> Array:
    """Signed radius of each cell (n,) that lies on a circular arc, else nan."""
    cells = curve.cells
    radii: Array = curve.shape.radii[curve.stretch_of(0.5 * (cells.low + cells.high))]
    return radii


def _least_arc(curve: Curve, radii: Array, possible: Mask) -> tuple[float, float]:
    """Least radius, mm, of the possible cells that are convex circular arcs, and its parameter; else infinite."""
    cells = curve.cells
    arcs = np.flatnonzero(possible & ~np.isnan(radii))
    if arcs.size:
        # a negative radius may be convex too: a pitch curve's arc inside a roller that is too large
        arcs = arcs[curve.sample(0.5 * (cells.low[arcs] + cells.high[arcs])).turn > 0.0]
    if not arcs.size:
        return math.inf, float(cells.low[0])
    least = arcs[np.argmin(radii[arcs])]
    return float(radii[least]), float(cells.low[least])


def reversals(curve: Curve) -> tuple[Reversal, ...]:
    """Stretches over which the speed is negative, their ends exact roots, and stretches over which it is zero.

    They are in order of the parameter; a stretch across the seam of a closed run ends beyond the run. None is missed
    whose speed falls below zero by more than `ROUNDING` of the curve's size. Raises CurveError where the proof does not
    end.
    """
    # rows of the cells, in the order of `Bounds`: 0 is the lower bound of sigma, 6 and 7 bound sigma'' and omega''
    cells = curve.cells
    doubtful = cells.rows[0] <= 0.0
    if not doubtful.any():
        return ()
    state = _Intervals.of(curve, cells.low, cells.high, cells.rows[6], cells.rows[7])
    tolerance = ROUNDING * _extent(state.at_low)
    arcs = _arc_radii(curve)
    stretches = _arcs_below_zero(state, arcs, tolerance)
    state = state.part(doubtful & np.isnan(arcs))
    for _ in range(LEVELS):
        # decided: no speed below 0, all below 0, at most one change of sign, or no more than rounding between the ends
        a, b = state.at_low, state.at_high
        swing = 0.125 * state.speed_bend * (state.high - state.low) ** 2
        least, most = np.minimum(a.speed, b.speed), np.maximum(a.speed, b.speed)
        slope_change = state.speed_bend * (state.high - state.low)
        monotone = (a.speed_slope * b.speed_slope > 0.0) & (
            np.minimum(np.abs(a.speed_slope), np.abs(b.speed_slope)) > slope_change
        )
        decided = (least - swing >= -tolerance) | (most + swing < -tolerance) | monotone | (swing <= 0.25 * tolerance)
        stretches += _below_zero(curve, state.part(decided), tolerance)
        state = state.part(~decided)
        if state.low.size == 0:
            return _join(curve, stretches)
        if state.low.size > MOST_INTERVALS:
            break
        state = state.subdivided(curve, np.empty(0), 0.0, fresh=True)
    place = float(state.low[0])
    raise CurveError(f"whether the curve runs backwards near parameter {place:.9g} cannot be proved", place)


def _may_hold_least(cells: Cells) -> Mask:
    """Whether a cell may be convex and hold the least radius (n,): no other cell's radii are proved to be smaller."""
    # bounds of sigma/omega by the signs of its terms
    speed_low, speed_high, turn_low, turn_high = cells.rows[:4]
    with np.errstate(divide="ignore", invalid="ignore"):
        lowest = speed_low / np.where(speed_low >= 0.0, turn_high, turn_low)
        highest = speed_high / np.where(speed_high >= 0.0, turn_low, turn_high)
    lowest = np.where((speed_low < 0.0) & (turn_low <= 0.0), -np.inf, lowest)
    convex = turn_low > 0.0
    most = float(highest[convex].min(initial=np.inf))
    possible: Mask = (turn_high > 0.0) & (lowest <= most)
    return possible


@dataclass(frozen=True)
class _Intervals:
    """Parameter intervals (n,), the frames at both ends taken from inside, bounds of sigma'' and omega'' (n,)."""

    low: Array
    high: Array
    speed_bend: Array
    turn_bend: Array
    at_low: Frame
    at_high: Frame

    @staticmethod
    def of(curve: Curve, low: Array, high: Array, speed_bend: Array, turn_bend: Array) -> _Intervals:
        return _Intervals(low, high, speed_bend, turn_bend, *curve.span(low, high))

    @property
    def dips(self) -> Mask:
        """Whether the radius falls at the beginning and rises at the end (n,)."""
        falls: Mask = (_radius_slope(self.at_low) < 0.0) & (_radius_slope(self.at_high) > 0.0)
        return falls

    def part(self, chosen: Mask) -> _Intervals:
        """The intervals for which `chosen` (n,) is true."""
        ends = self.at_low.part(chosen), self.at_high.part(chosen)
        return _Intervals(self.low[chosen], self.high[chosen], self.speed_bend[chosen], self.turn_bend[chosen], *ends)

    def bend(self, v: float) -> Array:
        """Bound of the second derivative of ``sigma - v omega``, of ``-omega`` for an infinite v (n,)."""
        return self.turn_bend if math.isinf(v) else self.speed_bend + abs(v) * self.turn_bend

    def floor(self, v: float) -> Array:
        """Proved lower bound of ``sigma - v omega``, mm, of ``-omega`` for an infinite v, over each interval (n,)."""
        if math.isinf(v):  # nothing convex has been found yet
            ends = np.minimum(-self.at_low.turn, -self.at_high.turn)
            return ends - 0.125 * self.turn_bend * (self.high - self.low) ** 2
        a = self.at_low.speed - v * self.at_low.turn
        b = self.at_high.speed - v * self.at_high.turn
        return np.minimum(a, b) - 0.125 * self.bend(v) * (self.high - self.low) ** 2

    def ends_below(self, v: float) -> Array:
        """Ends of intervals (m,) at which the radius is at most v, mm."""
        ends = np.concatenate([self.low[_radius(self.at_low) <= v], self.high[_radius(self.at_high) <= v]])
        return distinct(ends)

    def _holding(self, minima: Array) -> Mask:
        """Whether any of the minima (m,) lies in each interval (n,), its ends included."""
        rising = np.append(np.sort(minima), np.inf)
        inside: Mask = rising[np.searchsorted(rising, self.low)] <= self.high
        return inside

    def subdivided(self, curve: Curve, minima: Array, grade: float, *, fresh: bool) -> _Intervals:
        """Divide each interval evenly, or finely about a minimum (m,) found in it, from steps of `grade` upward.

        `fresh` forms the bounds over many intervals anew.
        """
        fine = self._holding(minima) & (self.high - self.low > 2.0 * grade)  # others would come back as they are
        even = np.linspace(self.low[~fine], self.high[~fine], SPLITS + 1)
        lows, highs = [even[:-1].T.ravel()], [even[1:].T.ravel()]
        owner = [np.repeat(np.flatnonzero(~fine), SPLITS)]
        for i in np.flatnonzero(fine).tolist():
            low, high = self.low[i], self.high[i]
            middle = float(minima[(minima >= low) & (minima <= high)][0])
            count = max(1, math.ceil(math.log(max((high - low) / grade, 2.0)) / math.log(GROWTH)))
            away = grade * GROWTH ** np.arange(count)
            knots = np.concatenate([[low, middle, high], middle - away, middle + away])
            knots = distinct(knots[(knots >= low) & (knots <= high)])
            lows.append(knots[:-1])
            highs.append(knots[1:])
            owner.append(np.full(knots.size - 1, i))
        owners = np.concatenate(owner)
        order = np.argsort(owners, kind="stable")
        owners, low, high = owners[order], np.concatenate(lows)[order], np.concatenate(highs)[order]
        speed_bend, turn_bend = self.speed_bend[owners], self.turn_bend[owners]
        if fresh and len(self.low) > FRESH:
            # where terms cancel, as in the formula of a circle, a bound falls with the width
            anew = curve.shape.bounds(low, high)
            speed_bend, turn_bend = np.fmin(speed_bend, anew.speed_bend), np.fmin(turn_bend, anew.turn_bend)
        return _Intervals.of(curve, low, high, speed_bend, turn_bend)


def _extent(frame: Frame) -> float:
    """Greatest coordinate or speed, mm: the scale of rounding."""
    return float(max(np.abs(frame.point).max(), np.abs(frame.speed).max()))


def _radius(frame: Frame) -> Array:
    """Radius of curvature, mm (n,), where the curve is convex, else infinite."""
    radius: Array = np.full(frame.speed.shape, np.inf)
    np.divide(frame.speed, frame.turn, out=radius, where=frame.turn > 0.0)
    return radius


def _radius_slope(frame: Frame) -> Array:
    """Derivative of sigma/omega, times omega^2 (n,)."""
    return frame.speed_slope * frame.turn - frame.speed * frame.turn_slope


def _least_end(state: _Intervals) -> tuple[float, float]:
    """Least radius at the ends of the intervals, mm, and its parameter."""
    radius = np.concatenate([_radius(state.at_low), _radius(state.at_high)])
    worst = int(np.argmin(radius))
    return float(radius[worst]), float(np.concatenate([state.low, state.high])[worst])


def roots(
    function: Callable[[Array], Array], low: Array, high: Array, values: tuple[Array, Array], precision: float
) -> Array:
    """Roots (n,) of a function that changes its sign between `low` and `high` (n,), to `precision` of the interval.

    `function` takes and gives (n,); `values` are its values at `low` and at `high`, (n,) each. The method is the
    Illinois form of the rule of false position, with halvings where it is slow, so that every bracket is closed.
    """
    a, b = low, high
    fa, fb = values
    close = precision * (high - low) + 2.0 * np.spacing(np.maximum(np.abs(low), np.abs(high)))
    closed = np.zeros(low.shape, dtype=bool)
    for step in range(_ROOT_STEPS):
        if closed.all():
            break
        with np.errstate(divide="ignore", invalid="ignore"):
            x = b - fb * (b - a) / (fb - fa)
        # steps are half the precision or more, so that the last one passes the root and closes the bracket
        x = np.where(np.abs(x - b) < 0.5 * close, b + np.copysign(0.5 * close, a - b), x)
        halve = ~((x >= np.minimum(a, b)) & (x <= np.maximum(a, b))) | (step % 8 == 7) | (step >= _FALSE_POSITIONS)
        x = np.where(closed, b, np.where(halve, 0.5 * (a + b), x))
        fx = function(x)
        crossed = (np.sign(fx) != np.sign(fb)) & ~closed
        # the end that stays has its weight halved, so that both ends move
        fa = np.where(crossed, fb, 0.5 * fa)
        a = np.where(crossed, b, a)
        b, fb = x, fx
        closed |= (np.abs(b - a) <= close) | (fb == 0.0)
    return b


def _arcs_below_zero(state: _Intervals, radii: Array, tolerance: float) -> list[tuple[float, float, bool]]:
    """Intervals on circular arcs, their radii (n,) nan elsewhere, that are run along backwards or shrink to a point."""
    with np.errstate(invalid="ignore"):
        still = np.abs(radii) <= tolerance
        backwards = ~still & (radii * state.at_low.turn < 0.0)
    return [(float(state.low[i]), float(state.high[i]), bool(still[i])) for i in np.flatnonzero(still | backwards)]


def _below_zero(curve: Curve, state: _Intervals, tolerance: float) -> list[tuple[float, float, bool]]:
    """Parts of intervals, each with at most one change of sign, over which the speed is below zero."""
    a, b = state.at_low.speed, state.at_high.speed
    first, last = a < -tolerance, b < -tolerance
    begin, end = state.low.copy(), state.high.copy()
    mixed = first != last
    crossing = mixed & (a * b < 0.0)
    ends = a[crossing], b[crossing]
    change = roots(lambda t: curve.sample(t).speed, state.low[crossing], state.high[crossing], ends, 0.0)
    below_at_low = first[crossing]
    end[crossing] = np.where(below_at_low, change, state.high[crossing])
    begin[crossing] = np.where(below_at_low, state.low[crossing], change)
    kept = np.flatnonzero(first | last)
    return [(float(begin[i]), float(end[i]), False) for i in kept if end[i] > begin[i]]


def _join(curve: Curve, pieces: list[tuple[float, float, bool]]) -> tuple[Reversal, ...]:
    """Reversals from pieces (start, end, still): pieces that touch are joined, also across the seam of a closed run."""
    merged: list[list[Any]] = []
    for start, end, still in sorted(pieces):
        if merged and start <= merged[-1][1] and merged[-1][2] == still:
            merged[-1][1] = end
        else:
            merged.append([start, end, still])
    if curve.closed and len(merged) > 1 and merged[0][2] == merged[-1][2]:
        run = curve.runs[0]
        if merged[0][0] == run.low and merged[-1][1] == run.high:
            merged[-1][1] = merged.pop(0)[1] + curve.shape.period
    return tuple(Reversal(start, end, still) for start, end, still in merged)
