"""A curve as a cubic B-spline with a continuous tangent, for CAD systems that want few, smooth pieces.

Each span takes points and tangents from the curve; the lengths of its two handles are free and set for its least
deviation. Then the error falls as the sixth power of the span's length, and the spans are 1.06 times the fewest that
any such spline needs (`camgeo.fit.cubic`), which whole numbers of spans and places where the nearest cubic ceases to
exist raise to about 1.1. A curve that all cubics miss to one side, such as an ellipse or a Reuleaux polygon, has its
joints on the other side, on a parallel curve that the spans' middles touch as well: that saves the 0.06. Knots are
spaced so that the spline is C1 in its own parameter.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from camgeo.common.rounding import upward
from camgeo.fit.cubic import LEAST, ORDER, span_density
from camgeo.fit.handles import cubic_spans
from camgeo.fit.nodes import ToleranceError, check_count, check_precision, reshare, rounding
from camgeo.fit.pieces import Bound, BSpline
from camgeo.fit.spans import plane, spans_deviation
from kin.numeric.records import dataclass, replace

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from kin.numeric.arrays import Array

FLOOR = 4.0  # times the least tolerance of points and distances: below it a spline's handles are lost in rounding
USABLE = 0.985  # of the limit, that sampled errors may use; the rest is left to the proof
ON_CURVE = 604.39  # the error of a span of length h with its ends on the curve is c h^6/604.4 (docs/theory.md 3)
NOTHING = 4e-9  # of the size: readers of files reject a shorter span
UNEVEN = 1e-7  # of a run's length of parameter: least length of a span


class _Joints(NamedTuple):
    """Offset of the joints from a curve that all cubics miss to one side."""

    share: float = 0.92
    """Share of the tolerance; less than 1 for middles that do not quite touch."""
    near_centre: float = 0.25
    """Share of the least radius of curvature: joints that would lie farther off lie on the curve."""


class _Sharing(NamedTuple):
    """Sharing of the nodes among all spans so that their errors become alike, and when it is of no use any more."""

    most: int = 10
    """Sharings before nodes are added."""
    full: float = 0.97
    """Share of the tolerance; a greater mean error shows that more spans are needed."""
    less: float = 0.95
    """Share of the least of the greatest errors; one above it has not fallen."""
    patience: int = 3
    """Errors in turn that have not fallen, after which more spans are needed."""
    margin: float = 1.05
    """Factor of the errors of spans that fail, once one has not fallen: these spans become shorter."""
    damped: float = 12.0
    """Order taken for the error where nodes were shared before, so that they come to rest."""


class _Adding(NamedTuple):
    """Nodes added where sharing does not do: to all spans in equal parts, or by halving those that fail."""

    tries: int = 40
    """Tries of placing nodes in all."""
    last: int = 8
    """Tries at their end in which all spans that fail are halved."""
    growth: float = 0.01
    """Least share by which the number of spans grows at first."""
    faster: float = 1.6
    """Factor of that share with each growth."""
    grown: int = 4
    """Growths after which spans that fail are halved, as sharing does not settle."""
    settling: int = 2
    """Sharings after which spans that fail are halved if they are few."""
    few: float = 0.02
    """Share of all spans that is few, where the number of spans would not grow by more."""

    def share(self, grown: int) -> float:
        """Least share by which the number of spans grows after so many growths."""
        return self.growth * self.faster**grown


JOINTS, SHARING, ADDING = _Joints(), _Sharing(), _Adding()


def fit_spline(curve: Curve, tolerance: float) -> BSpline:
    """Cubic B-spline within `tolerance` mm of a curve; corners of a trimmed curve stay corners.

    Its bound is proved, by each span's distance along the curve's normals. The number of spans grows as
    tolerance^(-1/6). Raises ToleranceError where the tolerance is below rounding, needs too many spans, or is not
    reached; CurveError where no finite bound of the curve's speed and turn is proved.
    """
    size = curve.size
    check_precision(size, tolerance, FLOOR)
    stretches = np.concatenate([run.stretches for run in curve.runs])
    limit = tolerance - 2.0 * rounding(size)
    spans = _fit_stretches(curve, stretches, USABLE * limit, limit)
    outward, inward = max(out for _, out, _ in spans), max(into for _, _, into in spans)
    # a span shorter than rounding has no direction, and readers reject one hardly longer: both are left out, the longer
    # ones where the tolerance allows for the gap that is closed
    nothing = max(rounding(size), min(NOTHING * size, 0.5 * (limit - max(outward, inward))))
    groups, first, lost = [], 0, 0.0
    for run in curve.runs:
        count = len(run.stretches)
        beziers = np.concatenate([control for control, _, _ in spans[first : first + count]])
        length = np.abs(np.diff(plane(beziers), axis=1)).sum(axis=1)
        short = length <= nothing
        lost = max(lost, float(length[short].max(initial=0.0)))
        ends = np.flatnonzero(np.diff(np.concatenate([[True], short, [True]]).astype(np.int8)))
        groups += [part for low, high in ends.reshape(-1, 2) for part in _split_uneven(beziers[low:high])]
        first += count
    spline = _assemble(groups, Bound(outward, inward))
    # in the spline joints follow from the control points and knots, and are moved by rounding
    moved = math.sqrt(2.0) * float(np.abs(spline.beziers() - np.concatenate(groups)).max())
    return replace(spline, bound=spline.bound.widened(rounding(size) + moved + lost))


def _split_uneven(beziers: Array) -> list[Array]:
    """Runs of spans (n, 4, 2) in which no span's share of the parameter vanishes beside the others'.

    Next to a cusp speeds differ so much from joint to joint that knots would coincide. There a run ends in a threefold
    knot: the curve keeps its tangent, its parameter is not C1.
    """
    steps = _steps(beziers)
    if bool(np.isfinite(steps).all()) and steps.min() >= UNEVEN * steps.sum():
        return [beziers]
    runs, first = [], 0
    for last in range(1, len(beziers)):
        steps = _steps(beziers[first : last + 1])
        if not (np.isfinite(steps).all() and steps.min() >= UNEVEN * steps.sum()):
            runs.append(beziers[first:last])
            first = last
    return [*runs, beziers[first:]]


def _steps(beziers: Array) -> Array:
    """Lengths of parameter (n,) of spans in a run, for equal speeds on both sides of each joint."""
    leaving, arriving = (np.hypot(*(beziers[:, i + 1] - beziers[:, i]).T) for i in (0, 2))
    if len(beziers) == 1:
        return np.array([np.hypot(*np.diff(beziers[0], axis=0).T).sum()])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
        steps: Array = np.cumprod(np.append(1.0, leaving[1:] / arriving[:-1])) * leaving[0]
    return steps


def _assemble(groups: list[Array], bound: Bound) -> BSpline:
    """One closed clamped B-spline from the Bezier spans of each run (n, 4, 2): C1 in a run, continuous between runs."""
    control, knots = [groups[0][0, :1]], [np.zeros(4)]
    end = 0.0
    steps = [_steps(beziers) for beziers in groups]
    least = UNEVEN * sum(float(lengths.sum()) for lengths in steps)
    for number, (beziers, step) in enumerate(zip(groups, steps, strict=True)):
        # a run's speed is free: it is lowered where knots would coincide
        ends = end + np.cumsum(step * max(1.0, least / float(step.sum())))
        end = float(ends[-1])
        control.append(beziers[:, 1:3].reshape(-1, 2))
        knots.append(np.repeat(ends[:-1], 2))
        if number < len(groups) - 1:
            control.append(beziers[-1, 3:])
            knots.append(np.full(3, end))
    control.append(groups[0][0, :1])
    knots.append(np.full(4, end))
    spans = sum(len(beziers) for beziers in groups)
    return BSpline(3, np.concatenate(control), np.concatenate(knots), spans, bound)


def _fit_stretches(curve: Curve, stretches: Array, tolerance: float, limit: float) -> list[tuple[Array, float, float]]:
    """Bezier spans (n, 4, 2) over each smooth stretch, with their outward and inward bound, mm.

    Sampled errors reach up to `tolerance`, proved ones up to `limit`, mm. Raises ToleranceError where that is not
    reached.
    """
    along = span_density(curve, stretches)
    out = _joint_offset(curve, along.side, tolerance)
    # deviation permitted from the joints' parallel, over the deviation permitted from the curve
    allowance = 1.0 + abs(out) / tolerance
    counts = along.totals * (tolerance * (0.5 * allowance if out else ON_CURVE / LEAST)) ** (-1.0 / ORDER)
    check_count(float(counts.sum()), "spline spans", tolerance, ORDER)
    nodes = [density.nodes(max(1, math.ceil(count))) for density, count in zip(along.densities, counts, strict=True)]
    done: dict[int, tuple[Array, float, float]] = {}
    states = [_State()] * len(nodes)
    spans, best = _Spans.none(), math.inf
    # fit and prove all stretches that do not hold yet, then give each of them better nodes
    for attempt in range(ADDING.tries):
        todo = [i for i in range(len(nodes)) if i not in done]
        if not todo:
            return [done[i] for i in range(len(nodes))]
        owner = np.repeat(todo, [nodes[i].size - 1 for i in todo])
        check_count(2.0 * owner.size, "spline spans", tolerance, ORDER)
        low = np.concatenate([nodes[i][:-1] for i in todo])
        high = np.concatenate([nodes[i][1:] for i in todo])
        spans = spans.between(curve, low, high, out, allowance)
        failing = np.bincount(owner[~(spans.load <= tolerance)], minlength=len(nodes))
        spans = spans.prove(curve, failing[owner] == 0, tolerance)
        reached = np.where(np.isnan(spans.worst), spans.load, spans.worst)
        for i in todo:
            own = owner == i
            worst = float(reached[own].max())
            best = min(best, worst)
            if failing[i] == 0 and worst <= limit:
                outward, inward = (float(row[own].max()) for row in (spans.outward, spans.inward))
                done[i] = spans.control[own], max(outward, 0.0), max(inward, 0.0)
            else:
                last = attempt >= ADDING.tries - ADDING.last
                nodes[i], states[i] = _denser(nodes[i], reached[own], tolerance, states[i], last=last)
    raise ToleranceError(f"a spline within {tolerance:.3g} mm was not reached; the best was {upward(best, 3)} mm", best)


def _joint_offset(curve: Curve, side: float, tolerance: float) -> float:
    """Offset of joints outside the curve, mm: away from the `side`, 1 or -1, to which all spans deviate; 0 for 0."""
    if side == 0.0 or not curve.closed:
        return 0.0
    rows = curve.cells.rows
    # lower bound of speed over turn
    tightest = float(rows[0].min() / np.maximum(np.abs(rows[2]), np.abs(rows[3])).max())
    return -side * JOINTS.share * tolerance if JOINTS.share * tolerance < JOINTS.near_centre * tightest else 0.0


@dataclass(frozen=True)
class _Spans:
    """Bezier spans (n, 4, 2) between nodes, over parameters [low, high] (n,).

    `load` (n,) is the sampled deviation, mm, divided so that it may be at most the tolerance; `outward` and `inward`
    (n,) are proved deviations, mm, nan where no proof was tried.
    """

    low: Array
    high: Array
    control: Array
    load: Array
    outward: Array
    inward: Array

    @staticmethod
    def none() -> _Spans:
        """Record of no spans."""
        return _Spans(np.zeros(0), np.zeros(0), np.zeros((0, 4, 2)), np.zeros(0), np.zeros(0), np.zeros(0))

    @property
    def worst(self) -> Array:
        """Greatest proved distance of each from the curve, mm (n,), nan where no proof was tried."""
        return np.maximum(self.outward, self.inward)

    def between(self, curve: Curve, low: Array, high: Array, out: float, allowance: float) -> _Spans:
        """Spans over other intervals (m,): kept where an interval is among the present ones, fitted anew elsewhere.

        Joints lie `out` mm outside the curve; loads are deviations from their parallel over `allowance`.
        """
        place = np.minimum(np.searchsorted(self.low, low), max(0, self.low.size - 1))
        kept = np.zeros(low.size, dtype=bool)
        if self.low.size:
            kept = (self.low[place] == low) & (self.high[place] == high)
        control, load = np.empty((low.size, 4, 2)), np.empty(low.size)
        proved = np.full((2, low.size), np.nan)
        if kept.any():
            old = place[kept]
            control[kept], load[kept] = self.control[old], self.load[old]
            proved[:, kept] = self.outward[old], self.inward[old]
        if not kept.all():
            control[~kept], from_curve, from_parallel = cubic_spans(curve, low[~kept], high[~kept], out)
            load[~kept] = np.where(np.isfinite(from_curve), from_parallel / allowance, np.inf)
        return _Spans(low, high, control, load, *proved)

    def prove(self, curve: Curve, rows: Array, tolerance: float) -> _Spans:
        """Copy in which the spans of the mask `rows` (n,) are proved, if they were not."""
        todo = np.flatnonzero(rows & np.isnan(self.outward))
        if not todo.size:
            return self
        outward, inward = self.outward.copy(), self.inward.copy()
        own = self.control[todo], self.low[todo], self.high[todo]
        outward[todo], inward[todo] = spans_deviation(curve, *own, tolerance)
        return replace(self, outward=outward, inward=inward)


@dataclass(frozen=True)
class _State:
    """History of a stretch's nodes since their number grew last; `grown` counts how often it grew.

    `shared` counts sharings; `least` is the least of the greatest loads, `stalled` how often in turn it did not fall.
    `best` are the fewest nodes of all tries, with the spans that fail halved.
    """

    shared: int = 0
    grown: int = 0
    least: float = math.inf
    stalled: int = 0
    best: Array | None = None


def _denser(nodes: Array, load: Array, tolerance: float, state: _State, *, last: bool) -> tuple[Array, _State]:
    """Nodes for the next try, and their history: shared anew while that helps, then more nodes.

    Spans are halved where their error is infinite, or few of them fail. `load` (n,) is the error of each span, mm, that
    may be at most `tolerance`, mm; `last` allows halving alone.
    """
    count = nodes.size - 1
    failing = ~(load <= tolerance)
    if not math.isfinite(float(load.max())):
        return _halve(nodes, ~np.isfinite(load)), _State(grown=state.grown, best=state.best)
    halved = _halve(nodes, failing)
    best = halved if state.best is None or halved.size < state.best.size else state.best
    growth = ADDING.share(state.grown)
    few = state.shared >= ADDING.settling and np.count_nonzero(failing) <= max(growth, ADDING.few) * count
    if few or last or state.grown >= ADDING.grown:
        return halved, _State(grown=state.grown, best=best)
    moved, after = _reshare(nodes, load, tolerance, state)
    if moved.size > nodes.size and state.shared and (state.grown + 1 >= ADDING.grown or best.size <= moved.size):
        # spans at places where the nearest cubic ceases to exist move about as nodes are shared: take the best nodes
        return best, _State(grown=state.grown + 1)
    return moved, replace(after, best=best)


def _halve(nodes: Array, failing: NDArray[np.bool_]) -> Array:
    """Nodes (n + 1,) with one more in the middle of each span of the mask `failing` (n,)."""
    middle = 0.5 * (nodes[:-1] + nodes[1:])
    return np.sort(np.append(nodes, middle[failing]))


def _reshare(nodes: Array, load: Array, tolerance: float, state: _State) -> tuple[Array, _State]:
    """Nodes shared anew, as many or more, so that spans' errors become alike, and their history."""
    # the load of every span if all were alike
    mean = float(np.mean(load ** (1.0 / ORDER))) ** ORDER
    worst = float(load.max())
    stalled = 0 if worst < SHARING.less * state.least else state.stalled + 1
    if state.shared < SHARING.most and stalled < SHARING.patience and mean < SHARING.full * tolerance:
        if stalled:
            moved = reshare(nodes, np.maximum(SHARING.margin * load, tolerance), ORDER)
        else:
            moved = reshare(nodes, load, SHARING.damped if state.shared else ORDER)
        return moved, _State(state.shared + 1, state.grown, min(worst, state.least), stalled)
    # as many more as that load foresees or, where sharing has been tried in vain, a small share, greater each time
    count = nodes.size - 1
    if state.shared:
        share, grown = ADDING.share(state.grown), state.grown + 1
    else:
        share, grown = (mean / tolerance) ** (1.0 / ORDER) - 1.0, state.grown
    more = max(count + 1, math.ceil(count * (1.0 + share)))
    return reshare(nodes, load, SHARING.damped if state.shared else ORDER, more), _State(grown=grown)
