"""A curve as a cubic B-spline with a continuous tangent, for CAD systems that want few, smooth pieces.

Each span takes points and tangents from the curve; the lengths of its two handles are free and set so that it strays
least. Then the error falls as the sixth power of the span's length, and 1.06 of the fewest spans do that any such
spline needs (`camgeo.fit.cubic`), which whole numbers of spans and places where the nearest cubic ceases to exist
raise to about 1.1. A curve that all cubics miss to one side, such as an ellipse or a Reuleaux polygon, has its joints
on the other side, on a parallel curve that the spans' middles touch as well: that saves the 0.06. Knots are spaced so
that the spline is C1 in its own parameter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.cubic import LEAST, ORDER, contact, spans_wanted
from camgeo.fit.deviation import Chain, chain_deviation
from camgeo.fit.nodes import TRIES, ToleranceError, check_count, check_precision, reshared, rounding
from camgeo.fit.pieces import Bound, BSpline

if TYPE_CHECKING:
    from camgeo.curve import Array, Curve, Frame

HOPELESS = 1.02  # times the aim: spans seen farther off are given up; more than 1/USABLE, so none of them can pass
USABLE = 0.985  # of the tolerance, that errors seen may use; the rest is left to the proof
OFFSET = 0.92  # of the aim, how far joints may lie off the curve: room for middles that do not quite touch
NEAR_CENTRE = 0.25  # of the least radius of curvature, beyond which they lie on the curve instead
ON_CURVE = 604.39  # a span of length h with its ends on the curve errs by c h^6/604.4 (docs/theory.md 3)
PLACES = (0.1, 0.26, 0.5, 0.74, 0.9)  # of a span: least squares there make its error equal to both sides
MOST_LEAN = 0.6  # by which the handles of the first guess differ
LOOKS = 16  # steps of a span at which its error is seen
PROOF_LOOKS = 24  # and at which it is first proved
MOST_LOOKS = 384
SLACK = 0.02  # of the tolerance: how far the proof may exceed what is seen before it is sharpened,
OVER = 0.01  # and how far the tolerance, before that
SHARINGS = 10  # of the nodes before there are more of them,
FULL = 0.97  # mean load above which sharing will not do
GROWTH = 0.01  # by this share of them at least,
FASTER = 1.6  # which itself grows by this factor each time
LAST_TRIES = 8  # are spent on halving spans that fail, wherever they are
DAMPED = 12.0  # power for the error where nodes were shared before, so that they come to rest
HANDLE_STEPS = 20
ENOUGH = 0.001  # of a span's error: handles that would change it by less are settled
STEP = 0.3  # of a handle's logarithm, that one such step may change
FIRST_DAMPING = 1e-3
HUMP = 0.2  # what humps still weigh where they do not count
NEWTON = 5  # steps that settle feet of normals to rounding


def fit_spline(curve: Curve, tolerance: float) -> BSpline:
    """Cubic B-spline within `tolerance` mm of a curve; corners of a trimmed curve stay corners.

    The bound is proved: against arcs that are themselves proved close to the curve, by the Bernstein coefficients of
    each span's distance to them. Their number grows as tolerance^(-1/6). Raises ToleranceError where the tolerance
    is below rounding, needs too many spans, or is not reached.
    """
    size = curve.size
    check_precision(size, tolerance)
    stretches = np.concatenate([run.stretches for run in curve.runs])
    spans = _fit_stretches(curve, stretches, USABLE * tolerance, tolerance - 2.0 * rounding(size))
    groups, first = [], 0
    for run in curve.runs:
        count = len(run.stretches)
        groups.append(np.concatenate([control for control, _, _ in spans[first : first + count]]))
        first += count
    outward, inward = max(out for _, out, _ in spans), max(into for _, _, into in spans)
    spline = _assembled(groups, Bound(outward, inward))
    # joints are no longer given but follow from the knots
    moved = math.sqrt(2.0) * float(np.abs(spline.beziers() - np.concatenate(groups)).max())
    return replace(spline, bound=spline.bound.widened(rounding(size) + moved))


def _assembled(groups: list[Array], bound: Bound) -> BSpline:
    """One closed clamped B-spline from the Bezier spans of each run (n, 4, 2): C1 in a run, corners between runs."""
    control, knots = [groups[0][0, :1]], [np.zeros(4)]
    at = 0.0
    for number, beziers in enumerate(groups):
        leaving, arriving = (np.hypot(*(beziers[:, i + 1] - beziers[:, i]).T) for i in (0, 2))
        # a span's share of the parameter: at a joint both sides run equally fast
        share = np.cumprod(np.append(1.0, leaving[1:] / arriving[:-1]))
        ends = at + np.cumsum(share * leaving[0])
        at = float(ends[-1])
        control.append(beziers[:, 1:3].reshape(-1, 2))
        knots.append(np.repeat(ends[:-1], 2))
        if number < len(groups) - 1:
            control.append(beziers[-1, 3:])
            knots.append(np.full(3, at))
    control.append(groups[0][0, :1])
    knots.append(np.full(4, at))
    spans = sum(len(beziers) for beziers in groups)
    return BSpline(3, np.concatenate(control), np.concatenate(knots), spans, bound)


def _fit_stretches(curve: Curve, stretches: Array, aim: float, limit: float) -> list[tuple[Array, float, float]]:
    """Bezier spans (n, 4, 2) over each smooth stretch, with their outward and inward bound.

    Errors are seen up to `aim` and proved up to `limit`.
    """
    tolerance = min(aim, limit)
    wanted = spans_wanted(curve, stretches)
    out = _beside(curve, wanted.side, tolerance)
    # what a span may leave its joints' parallel, over what it may leave the curve
    room = 1.0 + abs(out) / tolerance
    counts = wanted.totals * (tolerance * (0.5 * room if out else ON_CURVE / LEAST)) ** (-1.0 / ORDER)
    check_count(float(counts.sum()), "spline spans", tolerance, ORDER)
    nodes = [one.nodes(max(1, math.ceil(count))) for one, count in zip(wanted.densities, counts, strict=True)]
    done: dict[int, tuple[Array, float, float]] = {}
    states = [_State()] * len(nodes)
    best = math.inf
    for attempt in range(TRIES):
        todo = [i for i in range(len(nodes)) if i not in done]
        if not todo:
            return [done[i] for i in range(len(nodes))]
        owner = np.repeat(todo, [nodes[i].size - 1 for i in todo])
        check_count(2.0 * owner.size, "spline spans", tolerance, ORDER)
        low = np.concatenate([nodes[i][:-1] for i in todo])
        high = np.concatenate([nodes[i][1:] for i in todo])
        control, worst, load = _handled(curve, low, high, out)
        outer = inner = worst
        passed = [i for i in todo if float(worst[owner == i].max()) <= tolerance]
        if passed:
            mine = np.isin(owner, passed)
            outer, inner = worst.copy(), worst.copy()
            outer[mine], inner[mine] = _spline_range(curve, control[mine], low[mine], high[mine], tolerance)
            worst = np.maximum(outer, inner)
        for i in todo:
            mine = owner == i
            reached = float(worst[mine].max())
            best = min(best, reached)
            if i in passed and reached <= limit:
                done[i] = control[mine], max(float(outer[mine].max()), 0.0), max(float(inner[mine].max()), 0.0)
            else:
                strayed = np.maximum(load[mine] / room, np.where(np.isfinite(worst[mine]), 0.0, np.inf))
                if attempt >= TRIES - LAST_TRIES:
                    strayed[strayed > tolerance] = np.inf
                nodes[i], states[i] = _denser(nodes[i], strayed, tolerance, states[i])
    raise ToleranceError(f"a spline within {tolerance:.3g} mm was not reached; the best was {best:.3g} mm", best)


def _beside(curve: Curve, side: float, tolerance: float) -> float:
    """How far joints lie outside the curve, mm: away from the `side` to which all spans stray, if they all do."""
    if side == 0.0 or not curve.closed:
        return 0.0
    rows = curve.cells.rows
    # speed over turn, the least there may be
    tightest = float(rows[0].min() / np.maximum(np.abs(rows[2]), np.abs(rows[3])).max())
    return -side * OFFSET * tolerance if OFFSET * tolerance < NEAR_CENTRE * tightest else 0.0


@dataclass(frozen=True)
class _State:
    """How often a stretch's nodes were shared since there were more of them, and how often there were more."""

    shared: int = 0
    grown: int = 0


def _denser(nodes: Array, load: Array, tolerance: float, state: _State) -> tuple[Array, _State]:
    """Nodes for the next try: shared anew while the mean load allows it, then more of them; halved where infinite.

    `load` (n,) is each span's error, times what of it must be within the tolerance.
    """
    if not math.isfinite(float(load.max())):
        middle = 0.5 * (nodes[:-1] + nodes[1:])
        return np.sort(np.append(nodes, middle[~np.isfinite(load)])), replace(state, shared=0)
    mean = float(np.mean(load ** (1.0 / ORDER))) ** ORDER
    if state.shared < SHARINGS and mean < FULL * tolerance:
        moved = reshared(nodes, load, DAMPED if state.shared else ORDER)
        return moved, replace(state, shared=state.shared + 1)
    count = nodes.size - 1
    if state.shared:
        share, grown = GROWTH * FASTER**state.grown, state.grown + 1
    else:
        share, grown = (mean / tolerance) ** (1.0 / ORDER) - 1.0, state.grown
    more = max(count + 1, math.ceil(count * (1.0 + share)))
    return reshared(nodes, load, ORDER, more), _State(grown=grown)


def _handled(curve: Curve, low: Array, high: Array, out: float) -> tuple[Array, Array, Array]:
    """Cubic spans (n, 4, 2) between points `out` mm outside the curve.

    With them comes how far each is seen to stray from the curve, and from the parallel through its ends (n,). Handles
    are sought from two beginnings, as the equations for them may have more than one solution; the closer span counts.
    """
    a, b = curve.span(low, high)
    start, end = a.point + out * a.normal, b.point + out * b.normal
    chord = np.hypot(*(end - start).T)
    # handles of a circular arc with these ends, and how the nearest cubic's differ
    half_cosine = np.sqrt(np.maximum(0.25 * np.sum((a.tangent + b.tangent) ** 2, axis=1), 1e-12))
    third = chord * 2.0 / (3.0 * (1.0 + half_cosine))
    speed, turn = curve.shape.series(0.5 * (low + high), 4)
    lean = np.clip(np.nan_to_num(contact(speed, turn).lean) * chord, -MOST_LEAN, MOST_LEAN)
    leaning = np.column_stack([third * (1.0 - lean), third * (1.0 + lean)])
    spans = _Spans(*(np.concatenate([x, x]) for x in (low, high, start, a.tangent, end, b.tangent)))
    control = _control(spans, _settled(curve, spans, np.concatenate([leaning, np.column_stack([third, third])]), out))
    gap = _seen(curve, control, spans)
    worst, load = np.abs(gap).max(axis=1), np.abs(gap - out).max(axis=1)
    chosen = np.argmin(load.reshape(2, -1), axis=0) * low.size + np.arange(low.size)
    return control[chosen], worst[chosen], load[chosen]


@dataclass(frozen=True)
class _Spans:
    """Spans over parameters [low, high] (n,): end points and tangents (n, 2)."""

    low: Array
    high: Array
    start: Array
    leaving: Array
    end: Array
    arriving: Array


def _settled(curve: Curve, spans: _Spans, handles: Array, out: float) -> Array:
    """Handles (n, 2) whose span strays least from the curve, in the mean of squares at `PLACES`.

    Where the ends lie `out` mm outside, it is the parallel there that the span is to keep to, and the humps to both
    sides of its middle, which go as far beyond the curve, hardly count. Levenberg's and Marquardt's steps, of the
    handles' logarithms: near places where the nearest cubic ceases to exist the equations have no solution. Any handles
    will do, the proof takes them as they are.
    """
    u = np.broadcast_to(np.array(PLACES), (len(handles), len(PLACES)))
    t = spans.low[:, None] + (spans.high - spans.low)[:, None] * u
    inner = 3.0 * u * (1.0 - u) ** 2, 3.0 * u**2 * (1.0 - u)

    def looked(handles: Array, t: Array) -> tuple[Array, Array, Array]:
        at = curve.sample(t.ravel())
        gap, moved = _gap(at, t, spans.low, spans.high, _bezier(_control(spans, handles)[:, None], u))
        normal = at.normal.reshape(*t.shape, 2)
        pull_a = inner[0] * np.sum(spans.leaving[:, None] * normal, axis=2)
        pull_b = -inner[1] * np.sum(spans.arriving[:, None] * normal, axis=2)
        gain = np.stack([pull_a, pull_b], axis=2) * handles[:, None]
        if out:
            gap, gain = (gap - out) @ FREED, FREED @ gain
        return gap, gain, moved

    gap, gain, t = looked(handles, looked(handles, t)[2])
    size = np.sum(gap * gap, axis=1)
    damping = np.full(len(handles), FIRST_DAMPING)
    for _ in range(HANDLE_STEPS):
        square = np.einsum("nmi,nmj->nij", gain, gain)
        scale = np.trace(square, axis1=1, axis2=2) + 1e-300
        square = square + (damping * scale)[:, None, None] * np.eye(2)
        change = np.linalg.solve(square, np.einsum("nmi,nm->ni", gain, gap)[:, :, None])[:, :, 0]
        if not (np.sum((gain @ change[:, :, None])[:, :, 0] ** 2, axis=1) > ENOUGH**2 * size).any():
            break
        tried = handles * np.exp(-np.clip(change, -STEP, STEP))
        gap_, gain_, t_ = looked(tried, t)
        size_ = np.sum(gap_ * gap_, axis=1)
        better = size_ < size
        handles = np.where(better[:, None], tried, handles)
        gap, gain = np.where(better[:, None], gap_, gap), np.where(better[:, None, None], gain_, gain)
        t, size = np.where(better[:, None], t_, t), np.where(better, size_, size)
        damping = np.where(better, 0.1 * damping, 10.0 * damping)
    return handles


def _control(spans: _Spans, handles: Array) -> Array:
    """Bezier points (n, 4, 2) of spans with handles (n, 2)."""
    start, end = spans.start, spans.end
    return np.stack([start, start + handles[:, :1] * spans.leaving, end - handles[:, 1:] * spans.arriving, end], axis=1)


def _bezier(control: Array, u: Array) -> Array:
    """Points (..., 2) of cubic spans (..., 4, 2) at u (...)."""
    return _blossom(control, u, u, u)


def _blossom(control: Array, u: Array, v: Array, w: Array) -> Array:
    """Polar form of cubic spans (..., 4, 2): the point at (u, u, u), sub-spans' control points otherwise."""
    one = control[..., :-1, :] + u[..., None, None] * (control[..., 1:, :] - control[..., :-1, :])
    two = one[..., :-1, :] + v[..., None, None] * (one[..., 1:, :] - one[..., :-1, :])
    point: Array = two[..., 0, :] + w[..., None] * (two[..., 1, :] - two[..., 0, :])
    return point


def _gap(at: Frame, t: Array, low: Array, high: Array, point: Array) -> tuple[Array, Array]:
    """Signed distance outside the curve of points (n, m, 2), by its circle of curvature at t (n, m), and nearer t.

    `at` are the frames at t. The distance is off by the third power of how far t misses the foot of the point's normal.
    """
    offset = point.reshape(-1, 2) - at.point
    along = np.sum(offset * at.tangent, axis=1)
    across = np.sum(offset * at.normal, axis=1)
    curvature = at.curvature
    with np.errstate(invalid="ignore"):  # a cusp: unknown, and so divided
        root = np.hypot(1.0 + curvature * across, curvature * along)
        gap = (2.0 * across + curvature * (across**2 + along**2)) / (1.0 + root)
    step = along / np.maximum(at.speed + at.turn * across, 1e-3 * np.abs(at.speed) + 1e-300)
    return gap.reshape(t.shape), np.clip(t + step.reshape(t.shape), low[:, None], high[:, None])


def _seen(curve: Curve, control: Array, spans: _Spans) -> Array:
    """Distance of each span outside the curve at a few places (n, m): quick, no proof."""
    u = np.broadcast_to(np.linspace(0.0, 1.0, LOOKS + 1)[1:-1], (len(control), LOOKS - 1))
    t = spans.low[:, None] + (spans.high - spans.low)[:, None] * u
    on = _bezier(control[:, None], u)
    for _ in range(2):
        gap, t = _gap(curve.sample(t.ravel()), t, spans.low, spans.high, on)
    return gap


def _spline_range(curve: Curve, control: Array, low: Array, high: Array, tolerance: float) -> tuple[Array, Array]:
    """Proved greatest outward and inward distance of each span from the curve (n,), infinite where unproved."""
    count = low.size
    out, into = np.full(count, np.inf), np.full(count, np.inf)
    todo, looks = np.arange(count), PROOF_LOOKS
    while todo.size and looks <= MOST_LOOKS:
        spans = control[todo], low[todo], high[todo]
        top, bottom, seen_top, seen_bottom = _against_arcs(curve, *spans, looks=looks, tolerance=tolerance)
        out[todo], into[todo] = top, bottom
        loose = np.maximum(top - seen_top, bottom - seen_bottom) > SLACK * tolerance
        loose |= np.maximum(top, bottom) > (1.0 + OVER) * tolerance
        hopeless = np.maximum(seen_top, seen_bottom) > HOPELESS * tolerance
        settled = np.where(hopeless & np.isfinite(seen_top), np.maximum(seen_top, seen_bottom), np.inf)
        out[todo] = np.where(hopeless, np.minimum(settled, out[todo]), out[todo])
        todo = todo[loose & ~hopeless]
        looks *= 2
    return out, into


def _against_arcs(
    curve: Curve, control: Array, low: Array, high: Array, *, looks: int, tolerance: float
) -> tuple[Array, Array, Array, Array]:
    """Outward and inward range of each span, proved and as seen at the nodes (each (n,)), through `looks` arcs a span.

    Both the curve and the span are compared with the arc that leaves a point of the curve along its tangent and
    returns to the curve at the next; the span meets the normals at the two points.
    """
    count = low.size
    share = np.linspace(0.0, 1.0, looks + 1)
    t = low[:, None] + (high - low)[:, None] * share
    t[:, -1] = high
    side = np.where(share < 1.0, 1, -1)
    at = curve.sample(t.ravel(), np.tile(side, count))
    point, tangent = at.point.reshape(count, -1, 2), at.tangent.reshape(count, -1, 2)
    u = np.broadcast_to(share, t.shape).copy()
    for _ in range(NEWTON):
        gap = np.sum((_bezier(control[:, None], u) - point) * tangent, axis=2)
        one = control[:, None, 1:] - control[:, None, :-1]
        two = one[..., :-1, :] + u[..., None, None] * (one[..., 1:, :] - one[..., :-1, :])
        velocity = 3.0 * (two[..., 0, :] + u[..., None] * (two[..., 1, :] - two[..., 0, :]))
        speed = np.sum(velocity * tangent, axis=2)
        u = np.clip(u - gap / np.where(speed > 0.0, speed, np.inf), 0.0, 1.0)
    u[:, 0], u[:, -1] = 0.0, 1.0
    left = np.abs(np.sum((_bezier(control[:, None], u) - point) * tangent, axis=2))
    chord = point[:, 1:] - point[:, :-1]
    start, along = point[:, :-1], tangent[:, :-1]
    cross = along[..., 0] * chord[..., 1] - along[..., 1] * chord[..., 0]
    k = 2.0 * cross / np.sum(chord * chord, axis=2)
    chain = Chain(start.reshape(-1, 2), along.reshape(-1, 2), k.ravel(), t[:, :-1].ravel(), t[:, 1:].ravel())
    found = chain_deviation(curve, chain, tolerance, 2)
    a, b = u[:, :-1], u[:, 1:]
    whole = control[:, None]
    pieces = np.stack(
        [_blossom(whole, a, a, a), _blossom(whole, a, a, b), _blossom(whole, a, b, b), _blossom(whole, b, b, b)], axis=2
    )
    offset = pieces - start[:, :, None]
    normal = np.stack([along[..., 1], -along[..., 0]], axis=-1)
    linear = np.sum(offset * normal[:, :, None], axis=-1)
    height = 2.0 * (linear @ _RAISE) + k[..., None] * np.einsum(
        "nmia,nmja,ijk->nmk", offset, offset, _PRODUCT, optimize=False
    )
    with np.errstate(invalid="ignore"):
        distance = height / (1.0 + np.sqrt(1.0 + k[..., None] * height))
    # The span runs forward: each leg of its control polygon does at both ends of the arc, and so between them.
    leg = np.diff(pieces, axis=2)
    sweep = np.sum(chord * along, axis=2)[..., None]
    last = 2.0 * sweep * chord / np.sum(chord * chord, axis=2)[..., None] - along
    forward = (np.sum(leg * along[:, :, None], axis=3) > 0.0) & (np.sum(leg * last[:, :, None], axis=3) > 0.0)
    sane = np.isfinite(distance).all(axis=2) & forward.all(axis=2) & (sweep[..., 0] > 0.0)
    # It meets the curve's normal at the arc's end, not the arc's own: its foot there may miss the end by `slip`.
    sine = np.abs(last[..., 0] * tangent[:, 1:, 1] - last[..., 1] * tangent[:, 1:, 0])
    slip = np.abs(distance).max(axis=2) * sine + left[:, 1:] + left[:, :-1]
    outer, inner = np.maximum(distance.max(axis=2), 0.0), np.maximum(-distance.min(axis=2), 0.0)
    top = np.hypot(np.where(sane, outer, np.inf), slip) - found.inside.reshape(count, -1)
    bottom = np.hypot(np.where(sane, inner, np.inf), slip) + found.outside.reshape(count, -1)
    node = distance[..., 0]
    return top.max(axis=1), bottom.max(axis=1), node.max(axis=1), (-node).max(axis=1)


def _bernstein_tables() -> tuple[Array, Array]:
    """Degree elevation from 3 to 6 (4, 7) and the product of two cubics in Bernstein form (4, 4, 7)."""
    product = np.zeros((4, 4, 7))
    for i in range(4):
        for j in range(4):
            product[i, j, i + j] = math.comb(3, i) * math.comb(3, j) / math.comb(6, i + j)
    return product.sum(axis=1), product


_RAISE, _PRODUCT = _bernstein_tables()


def _freed() -> Array:
    """Projection (m, m) of distances at `PLACES` that leaves little of the humps (x (x^2 - 1))^2."""
    x = 2.0 * np.array(PLACES) - 1.0
    hump = (x * (x * x - 1.0)) ** 2
    freed: Array = np.eye(x.size) - (1.0 - HUMP) * hump[:, None] * hump / np.sum(hump * hump)
    return freed


FREED = _freed()
