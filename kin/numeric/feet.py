"""Feet of points on a closed curve: where a function over one turn is greatest, for thousands of points at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from kin.numeric import quadrature
from kin.numeric.angles import TURN
from kin.numeric.distinct import distinct
from kin.numeric.errors import UnsettledError
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from kin.numeric.arrays import Array, Indices

COARSE = 4096  # samples of one turn from which a search starts
WITHIN = 16  # samples of a stretch between two breaks, at least
FINE_STEP = 1e-5  # rad: a Newton step below this leaves the value good to a third power of it
SHARE_OF_STRETCH, FINEST_STEP = 1e-5, 1e-11  # of the shortest stretch, and rad
MOST_STEPS = 60
LONGEST_STEP = 0.2  # rad
CORNER_REACH = 8.0  # depths of a point: farther from a tight corner than this, it has one foot only
CHUNK = 4_000_000  # entries of a matrix of points against samples held at a time


@dataclass(frozen=True, eq=False)
class Feet:
    """The feet of n points on an exact contour.

    parameter (n,)      of the foot, rad
    excess (n,)         distance of the point from the contour, mm, above 0 outside it
    normal (n, 2)       gradient of the excess
    curvature (n,)      of the line of equal excess through the point, 1/mm
    """

    parameter: Array
    excess: Array
    normal: Array
    curvature: Array

    @property
    def rows(self) -> tuple[Array, Array, Array, Array]:
        """Parameter, excess, normal and curvature as a tuple."""
        return self.parameter, self.excess, self.normal, self.curvature


def equal_steps(count: int) -> Array:
    """Angles (count,) at equal steps of a turn from 0 on, rad."""
    steps: Array = np.arange(count, dtype=np.float64) * (TURN / count)
    return steps


def grid(breaks: Array, count: int = COARSE) -> Array:
    """Angles in [0, 2 pi), rising, distinct: `count` equal steps, the breaks, and `WITHIN` parts of short stretches."""
    ends = np.sort(np.mod(breaks, TURN))
    width = np.diff(ends, append=ends[:1] + TURN)
    short = width < WITHIN * TURN / count
    parts = ends[short, None] + width[short, None] * (np.arange(1, WITHIN) / WITHIN)
    return distinct(np.concatenate([np.arange(count) * (TURN / count), ends, np.mod(parts.ravel(), TURN)]))


def climb(
    slopes: Callable[[Array, Indices], tuple[Array, Array, Array]], x: Array, breaks: Array
) -> tuple[Array, Array, Array, Array, Array]:
    """Climb to the maximum nearest uphill from x (n,) by Newton's method, bracketed and with bounded steps.

    `slopes(x, which)` gives f, f' and -f'' at x, `which` being the indices of these starts; `breaks`, in [0, 2 pi), are
    where f'' jumps. Returns x, the step that remains (at most FINE_STEP and across no break; 0 where the bracket closed
    first), and f, f', -f'' at x: (n,) each. Where stretches between breaks are short, the step is small beside the
    shortest, too. Raises UnsettledError where MOST_STEPS steps do not suffice.
    """
    x = x.copy()
    ends = distinct(breaks)
    shortest = float(np.diff(ends, append=ends[:1] + TURN).min(initial=TURN))
    fine = min(FINE_STEP, max(SHARE_OF_STRETCH * shortest, FINEST_STEP))
    f, slope, bend = slopes(x, np.arange(len(x)))
    step = _newton(slope, bend)

    def far(at: Array, by: Array) -> NDArray[np.bool_]:
        large: NDArray[np.bool_] = np.abs(by) > fine
        return large | ((by != 0.0) & across(breaks, at, by)) if len(breaks) else large

    # the sign of the slope narrows the bracket of each point; a step out of the bracket goes to its middle
    todo = np.flatnonzero(far(x, step))
    low, high = np.full(len(x), -np.inf), np.full(len(x), np.inf)
    for _ in range(MOST_STEPS):
        if not len(todo):
            break
        uphill = slope[todo] > 0.0
        low[todo] = np.where(uphill, x[todo], low[todo])
        high[todo] = np.where(uphill, high[todo], x[todo])
        new = x[todo] + step[todo]
        out = ~((new > low[todo]) & (new < high[todo]))
        new[out] = 0.5 * (low[todo] + high[todo])[out]
        x[todo] = new
        f[todo], slope[todo], bend[todo] = slopes(new, todo)
        step[todo] = _newton(slope[todo], bend[todo])
        closed = high[todo] - low[todo] <= 1e-15 * TURN
        step[todo[closed]] = 0.0
        todo = todo[far(x[todo], step[todo])]
    if len(todo):
        left = float(np.abs(step[todo]).max())
        raise UnsettledError(f"{len(todo)} feet were not found in {MOST_STEPS} steps; the last was of {left:.3g} rad")
    return x, step, f, slope, bend


def across(breaks: Array, x: Array, step: Array) -> NDArray[np.bool_]:
    """Whether a break lies between x and x + step (n,); breaks (m,) are in [0, 2 pi), steps below half a turn.

    Derivatives at a break are those behind it, so that a step back from a break leads across it.
    """
    low, high = np.minimum(x, x + step), np.maximum(x, x + step)
    turns = TURN * np.floor(low / TURN)
    ring = np.concatenate([breaks, breaks + TURN])
    return np.searchsorted(ring, low - turns, side="right") < np.searchsorted(ring, high - turns, side="right")


def _newton(slope: Array, bend: Array) -> Array:
    """Newton's step, no longer than LONGEST_STEP; uphill by that much where the function is not bent the right way."""
    most = LONGEST_STEP
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.where(bend > 0.0, slope / bend, np.copysign(most, slope))
    step = np.where(slope == 0.0, 0.0, step)
    return np.clip(step, -most, most)


def two_best(score: Callable[[Array], Array], points: Array, count: int) -> tuple[Indices, Indices]:
    """For each point the sample of the highest score, and the best sample well away from it: indices (n,) each.

    `score(points (k, 2))` gives scores (k, count) of `count` samples. Near a corner of a trimmed contour a point has
    two feet, and coarse samples do not show which one is the better.
    """
    first, second = np.empty(len(points), dtype=np.intp), np.empty(len(points), dtype=np.intp)
    away = count // 64
    near = np.arange(-away, away + 1)
    size = max(1, CHUNK // count)
    for begin in range(0, len(points), size):
        part = slice(begin, begin + size)
        value = score(points[part])
        first[part] = value.argmax(axis=1)
        np.put_along_axis(value, (first[part][:, None] + near) % count, -np.inf, axis=1)
        second[part] = value.argmax(axis=1)
    return first, second


class Tight(Protocol):
    """Protocol of a contour that knows its radii of curvature, and so the places where its curvature is tight."""

    def points(self, parameter: Array) -> Array:
        """Points (n, 2), mm, of the contour at parameters (n,), rad."""

    def radii(self) -> tuple[Array, Array]:
        """Parameters (m,) closely round the turn, and radii of curvature there (m,), mm, negative where hollow."""


def searched_again(feet: Feet, points: Array, contour: Tight, search: Callable[[Array], Feet]) -> Feet:
    """Replace, in place, the feet of points that lie deep inside the contour and near one of its tight corners.

    There two feet compete, one on either side of the corner, and `search` finds the nearer one of each point (k, 2).
    Deep is deeper than the least radius of curvature; near is within CORNER_REACH depths along the contour.
    """
    # corners are samples with a radius below the greatest depth; distances to them are lengths along the contour
    parameter, radius = contour.radii()
    deep = np.flatnonzero(feet.excess < -radius[radius >= 0.0].min(initial=np.inf))
    if not len(deep):
        return feet
    corner = (radius >= 0.0) & (radius < -feet.excess[deep].min())
    place = contour.points(parameter)
    step = np.hypot(*(np.roll(place, -1, axis=0) - place).T)
    along = np.concatenate([[0.0], np.cumsum(step)])
    at = np.interp(np.mod(feet.parameter[deep], TURN), np.append(parameter, TURN), along)
    marks = (along[:-1][corner] + along[-1] * np.array([-1.0, 0.0, 1.0])[:, None]).ravel()
    after = np.clip(np.searchsorted(marks, at), 1, len(marks) - 1)
    apart = np.minimum(at - marks[after - 1], marks[after] - at)
    deep = deep[apart <= CORNER_REACH * -feet.excess[deep]]
    nearer = search(points[deep])
    for mine, new in zip(feet.rows, nearer.rows, strict=True):
        mine[deep] = new
    return feet


def better(first: Feet, two: Feet, score_one: Array | None = None, score_two: Array | None = None) -> Feet:
    """For each point the foot of the greater score, `score_one` (n,) or `score_two` (n,), by default the excess."""
    wins = (first.excess if score_one is None else score_one) >= (two.excess if score_two is None else score_two)
    pairs = zip(first.rows, two.rows, strict=True)
    return Feet(*(np.where(wins if a.ndim == 1 else wins[:, None], a, b) for a, b in pairs))


def turn_quadrature(breaks: Array) -> tuple[Array, Array]:
    """Nodes and weights, (m,) each, rad, that integrate over one turn a function smooth between the breaks."""
    ends = grid(breaks, 64)
    ends = np.append(ends, ends[0] + TURN)
    node, weight = quadrature.gauss(16)
    half = 0.5 * np.diff(ends)
    at = (0.5 * (ends[1:] + ends[:-1]))[:, None] + half[:, None] * node
    return at.ravel(), (half[:, None] * weight).ravel()
