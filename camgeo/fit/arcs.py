"""A curve as tangent-continuous arcs (docs/theory.md 3): joints free, or biarcs through points of the curve.

Arcs with free joints are fewer (`camgeo.fit.free_arcs`); biarcs take their place where these are not found, and where a
stretch is so short beside the tolerance that two arcs hold it. Nodes of biarcs take equal shares of the integral of
``(|kappa'| / (40.5 e))^(1/3) ds``, both arcs of a biarc about equally long. A stretch of constant curvature is one arc.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from camgeo.common.rounding import upward
from camgeo.fit import free_arcs
from camgeo.fit.deviation import Chain, Deviation, chain_deviation, foot, sampled_deviation
from camgeo.fit.free_arcs import FittedArcs, cross
from camgeo.fit.monotone_parts import CONSTANT as FREE
from camgeo.fit.monotone_parts import MonotonePart
from camgeo.fit.nodes import TRIES, Density, ToleranceError, check_count, check_precision, reshare, rounding
from camgeo.fit.pieces import ArcSpline, Bound
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from camgeo.curve.curve import Curve, Frame
    from kin.numeric.arrays import Array

CONSTANT = 40.5  # error of a biarc of arcs of length s: |kappa'| s^3 / 40.5
RATIO = math.cbrt(CONSTANT / FREE)  # of arcs with free joints to arcs in biarcs
MOST_FREE = 1.8  # times the arcs in biarcs, up to which arcs with free joints are tried
LOOKS = 8  # steps of an arc at which its error is sampled while nodes are being shared
ROUNDS = 8  # of sharing the nodes anew before nodes are added,
GROWTH = 0.005  # by this share of them at least
DAMPED = 4.0  # power of the length by which nodes are shared anew; the error's own, 3, overshoots
MOST_RATIO = 1.5  # of the tangents' lengths of a biarc
APART = 2.0  # arcs at least between extrema of curvature that are separated
WIDEST = 2.0  # rad that a biarc may turn through
ROUND = 0.5  # arcs foreseen: a stretch with fewer may be a circular arc that its shape does not show as such
HALF_TURN = math.pi * (1.0 + 1e-9)  # that one arc may turn through; more is divided
FLOOR = 4.0  # times the least tolerance of points and distances: below it rounding spoils arcs
SLIP = 1e-5  # of the tolerance: error of a joint's foot along the curve
USABLE = 0.995  # of the tolerance, that sampled errors may use; the rest is left to the proof


def arc_density(frame: Frame) -> Array:
    """Arcs per unit of the parameter at a tolerance of 1 mm (k,): ``(|kappa'|/40.5)^(1/3) ds/dt``, without division."""
    slope = frame.turn_slope * frame.speed - frame.turn * frame.speed_slope
    density: Array = np.cbrt(np.abs(slope) / CONSTANT)
    return density


@dataclass(frozen=True)
class _Biarcs:
    """Both arcs of n biarcs, in order: points where each arc begins (2n, 2), bulges and chain (2n,)."""

    points: Array
    bulges: Array
    chain: Chain


@dataclass(frozen=True)
class _Stretch:
    """A stretch of the curve that is fitted by itself, arcs at its ends touching the curve.

    `parts` lie between the extrema of curvature inside the stretch; empty where it is a circular arc. `biarcs` is the
    number of arcs in biarcs that theory foresees. `whole` is the fit of a stretch that proves to be a circular arc.
    """

    low: float
    high: float
    parts: tuple[MonotonePart, ...] = ()
    biarcs: int = 0
    whole: FittedArcs | None = None


def fit_arcs(curve: Curve, tolerance: float) -> ArcSpline:
    """Tangent-continuous arcs within `tolerance` mm of a curve; corners of a trimmed curve stay corners.

    Each stretch between breaks of the curve, and between extrema of its curvature where arcs enough lie between, takes
    arcs with free joints or biarcs, whichever are fewer. Biarcs are made where arcs with free joints were not found, or
    are more than the expected biarcs. Both touch the curve at the stretch's ends, and the bound of both is proved. Time
    and number of arcs grow as tolerance^(-1/3). Raises ToleranceError where the tolerance is below rounding, needs too
    many arcs, or is not reached; CurveError where the curve runs backwards.
    """
    # arcs with free joints first, then biarcs where those are missing or more than expected
    size = curve.size
    bent = any(curve.radius(stretch) is None for run in curve.runs for stretch in run.stretches)
    check_precision(size, tolerance, FLOOR if bent else 1.0)
    aim, limit = USABLE * tolerance, tolerance - 2.0 * rounding(size)
    stretches = _between_extrema(curve, tolerance, limit)
    fits = _free_fits(curve, stretches, min(aim, limit), limit)
    remaining = [
        i
        for i, (s, fit) in enumerate(zip(stretches, fits, strict=True))
        if fit is None or (s.whole is None and fit.bulges.size > s.biarcs)
    ]
    biarcs = _fit_stretches(curve, [(stretches[i].low, stretches[i].high) for i in remaining], aim, limit)
    for i, biarc in zip(remaining, biarcs, strict=True):
        free = fits[i]
        fits[i] = biarc if free is None or biarc.bulges.size <= free.bulges.size else free
    points, bulges, outward, inward = FittedArcs.join(fit for fit in fits if fit is not None)
    return ArcSpline(points, bulges, Bound(outward, inward).widened(rounding(size)))


def _between_extrema(curve: Curve, tolerance: float, limit: float) -> list[_Stretch]:
    """Smooth stretches of the curve, divided where the curvature is extreme by samples and arcs enough lie between.

    A stretch that proves to be a circular arc is fitted at once, up to `limit`, mm. The errors of biarcs differ on the
    two sides of an extremum, so that the nodes of a biarc across it would not come to rest.
    """
    stretches = [(float(a), float(b)) for run in curve.runs for a, b in run.stretches]
    bent = [stretch for stretch in stretches if curve.radius(stretch) is None]
    densities = Density.of(curve, np.array(bent).reshape(-1, 2), arc_density)
    check_count(RATIO * sum(density.total for density in densities) / math.cbrt(tolerance), "arcs", tolerance, 3.0)
    # the sign of the curvature's slope on all grids at once, by which bent stretches are divided
    frames = curve.sample(np.concatenate([np.zeros(0), *(density.t[1:-1] for density in densities)]))
    slope = frames.turn_slope * frames.speed - frames.turn * frames.speed_slope
    ends = np.cumsum([density.t.size - 2 for density in densities])
    divisions = {}
    for stretch, density, end in zip(bent, densities, ends, strict=True):
        whole, inner = None, slice(end + 2 - density.t.size, end)
        if density.total <= ROUND * math.cbrt(tolerance):
            whole = _unknown_circle(curve, density, frames.tangent[inner], limit)
        if whole is None:
            divisions[stretch] = _split_at_extrema(density, slope[inner], tolerance)
        else:
            divisions[stretch] = [_Stretch(*stretch, whole=whole)]
    return [part for stretch in stretches for part in divisions.get(stretch, [_Stretch(*stretch)])]


def _split_at_extrema(density: Density, slope: Array, tolerance: float) -> list[_Stretch]:
    """A smooth stretch divided at extrema of curvature; `slope` (m - 2,) has the sign of the curvature's slope."""
    extrema = _sign_changes(density.t[1:-1], slope)
    edges = [float(density.t[0]), *extrema, float(density.t[-1])]
    share = np.interp(edges, density.t, density.sum) / math.cbrt(tolerance)
    divided: list[_Stretch] = []
    parts: list[MonotonePart] = []
    begin = 0
    # parts between neighbouring extrema, collected until there are arcs enough on both sides of a division
    for i, (low, high) in enumerate(pairwise(edges)):
        within = (density.t > low) & (density.t < high)
        grid = np.concatenate([[low], density.t[within], [high]])
        rising = 1.0 if float(np.sum(slope[within[1:-1]])) >= 0.0 else -1.0
        parts.append(MonotonePart(grid, np.interp(grid, density.t, RATIO * density.sum), rising))
        last = high == edges[-1]
        if last or (share[i + 1] - share[begin] >= APART and share[-1] - share[i + 1] >= APART):
            biarcs = math.ceil(0.5 * float(share[i + 1] - share[begin]))
            divided.append(_Stretch(edges[begin], high, tuple(parts), 2 * max(1, biarcs)))
            parts, begin = [], i + 1
    return divided


def _sign_changes(t: Array, value: Array) -> list[float]:
    """Parameters at which values (n,) at `t` (n,) change sign, by interpolation; a zero has the sign before it."""
    sign = np.sign(value)
    known = np.maximum.accumulate(np.where(sign != 0.0, np.arange(sign.size), 0))
    sign = sign[known]
    i = np.flatnonzero(sign[1:] * sign[:-1] < 0.0)
    changes: list[float] = (t[i] + (t[i + 1] - t[i]) * value[i] / (value[i] - value[i + 1])).tolist()
    return changes


def _free_fits(curve: Curve, stretches: list[_Stretch], aim: float, limit: float) -> list[FittedArcs | None]:
    """Arcs with free joints of the stretches; None where a part has none, or far more are foreseen than biarcs."""
    tried = [s.whole is None and sum(part.count(aim) for part in s.parts) <= MOST_FREE * s.biarcs for s in stretches]
    parts = [part for s, is_tried in zip(stretches, tried, strict=True) if is_tried for part in s.parts]
    fits = iter(free_arcs.free_arcs(curve, parts, aim, limit))
    results: list[FittedArcs | None] = []
    for stretch, is_tried in zip(stretches, tried, strict=True):
        own = [next(fits) for _ in stretch.parts] if is_tried else []
        whole = [part for part in own if part is not None]
        results.append(FittedArcs.join(whole) if whole and len(whole) == len(own) else stretch.whole)
    return results


def _fit_stretches(curve: Curve, stretches: list[tuple[float, float]], aim: float, limit: float) -> list[FittedArcs]:
    """Circular arcs and biarcs of each stretch: sampled errors up to `aim`, proved ones up to `limit`, mm.

    Raises ToleranceError where rounding takes all of the limit, or the limit is not reached.
    """
    slip = _slip(curve, aim)
    # what rounding and the slip of joints' feet along the curve take; with what is left as limit, the whole tolerance
    cover = 2.0 * (rounding(curve.size) + slip)
    limit -= 2.0 * slip
    if not limit > 0.0:
        raise ToleranceError(
            f"arcs within {limit + cover:.3g} mm are below what double precision holds on this contour: rounding alone "
            f"takes {cover:.3g} mm; at least {upward(2.0 * cover, 3)} mm",
            2.0 * cover,
        )
    tolerance = min(aim, limit)
    done: dict[int, FittedArcs] = {}
    best: dict[int, float] = {}
    for i, stretch in enumerate(stretches):
        radius = curve.radius(stretch)
        if radius is not None:
            done[i] = _circular_arcs(curve, stretch, radius)
    nodes = _first_nodes(curve, {i: stretch for i, stretch in enumerate(stretches) if i not in done}, tolerance)
    settled = dict.fromkeys(nodes, 0)
    # biarcs of all stretches that do not hold yet; each of them is given better nodes until all hold by samples
    for _ in range(TRIES):
        todo = [i for i in nodes if i not in done]
        if not todo:
            return [done[i] for i in range(len(stretches))]
        low = np.concatenate([nodes[i][:-1] for i in todo])
        high = np.concatenate([nodes[i][1:] for i in todo])
        biarcs = _biarcs(curve, low, high, slip)
        worst, deviation = _biarc_errors(curve, biarcs.chain, tolerance)
        # without a deviation, as samples of some stretch fail, nodes of stretches that pass stay and wait for the proof
        first = 0
        for i in todo:
            rows = slice(first, first + nodes[i].size - 1)
            first = rows.stop
            reached = float(worst[rows].max())
            best[i] = min(best.get(i, math.inf), reached)
            if deviation is not None and reached <= limit:
                done[i] = _proved_fit(biarcs, deviation, slice(2 * rows.start, 2 * rows.stop), slip)
            elif deviation is not None or reached > tolerance:
                nodes[i], settled[i] = _denser(nodes[i], worst[rows], tolerance, settled[i])
    least = cover + max(best[i] for i in nodes if i not in done)
    raise ToleranceError(
        f"arcs within {limit + cover:.3g} mm were not reached; the best were seen within {upward(least, 3)} mm, of "
        f"which rounding takes {cover:.2g} mm",
        least,
    )


def _first_nodes(curve: Curve, bent: dict[int, tuple[float, float]], tolerance: float) -> dict[int, Array]:
    """Nodes of each stretch that is no circular arc, by its index, as many as theory foresees."""
    densities = Density.of(curve, np.array(list(bent.values())).reshape(-1, 2), arc_density)
    check_count(sum(density.total for density in densities) / math.cbrt(tolerance), "arcs", tolerance, 3.0)
    return {
        i: density.nodes(
            max(1, math.ceil(0.5 * density.total / math.cbrt(tolerance) - 1e-6), math.ceil(density.turning / WIDEST))
        )
        for i, density in zip(bent, densities, strict=True)
    }


def _biarc_errors(curve: Curve, chain: Chain, tolerance: float) -> tuple[Array, Deviation | None]:
    """Error of each biarc of a chain (n,), mm: as sampled, or as proved where all samples keep the tolerance."""
    worst = sampled_deviation(curve, chain, LOOKS).reshape(-1, 2).max(axis=1)
    if not float(worst.max()) <= tolerance:
        return worst, None
    deviation = chain_deviation(curve, chain, tolerance, 2 * LOOKS)
    return deviation.worst.reshape(-1, 2).max(axis=1), deviation


def _proved_fit(biarcs: _Biarcs, deviation: Deviation, rows: slice, slip: float) -> FittedArcs:
    """The arcs of `rows`, their bounds widened by the slip of feet along the curve, mm."""
    # f is the curve's distance outside the arc: where it is positive the file lies inward
    inward = max(float(deviation.outside[rows].max()), 0.0) + 2.0 * slip
    outward = max(-float(deviation.inside[rows].min()), 0.0) + 2.0 * slip
    return FittedArcs(biarcs.points[rows], biarcs.bulges[rows], outward, inward)


def _denser(nodes: Array, worst: Array, tolerance: float, tried: int) -> tuple[Array, int]:
    """Nodes for the next try, and tries so far: shared anew, then more nodes; halved where errors are infinite."""
    if not np.isfinite(worst).all():
        return np.sort(np.append(nodes, 0.5 * (nodes[:-1] + nodes[1:])[~np.isfinite(worst)])), 0
    mean = float(np.mean(np.cbrt(worst))) ** 3
    if tried < ROUNDS and mean <= tolerance:
        return reshare(nodes, worst, DAMPED), tried + 1
    count = nodes.size - 1
    factor = math.cbrt(max(mean, tolerance) / tolerance)
    more = max(count + 1, math.ceil(count * max(factor, 1.0 + GROWTH)))
    density = np.concatenate([[0.0], np.cumsum(np.cbrt(np.maximum(worst, 1e-6 * worst.max())))])
    spread: Array = np.interp(np.linspace(0.0, density[-1], more + 1), density, nodes)
    spread[0], spread[-1] = nodes[0], nodes[-1]
    return spread, 0


def _circular_arcs(curve: Curve, stretch: tuple[float, float], radius: float) -> FittedArcs:
    """One arc for a stretch that is a circular arc of a signed radius, mm; two for more than a half turn."""
    # the angle from the end tangents is ambiguous by whole turns
    steady = curve.steady(stretch)
    ends = curve.span(np.array([stretch[0]]), np.array([stretch[1]]))
    (cx, cy), (dx, dy) = ends[0].tangent[0], ends[1].tangent[0]
    sweep = math.atan2(cx * dy - cy * dx, cx * dx + cy * dy)
    if steady is not None:
        sweep = steady[1] * (stretch[1] - stretch[0])
    elif sweep * radius < 0.0:
        sweep += math.copysign(2.0 * math.pi, radius)
    count = 1 if abs(sweep) <= HALF_TURN else 2
    points = ends[0].point
    if count > 1:
        half = 0.5 * sweep
        sine, versine = math.sin(half), 1.0 - math.cos(half)
        turned = np.array([cx * sine - cy * versine, cy * sine + cx * versine])
        points = np.vstack([points, points + radius * turned])
    return FittedArcs(points, np.full(count, math.tan(0.25 * sweep / count)), 0.0, 0.0)


def _unknown_circle(curve: Curve, density: Density, inner: Array, limit: float) -> FittedArcs | None:
    """Fewest arcs, of half a turn at most, for a stretch that proves to be a circular arc; else None.

    It is a circular arc if the arcs leave in the curve's direction, arrive in it to within rounding, and are proved up
    to `limit`, mm. `inner` (m - 2, 2) are the curve's tangents on the inner grid.
    """
    # the tangent must turn one way; arcs that turn equally, from the curve's tangent at each node
    first, last = curve.span(density.t[:1], density.t[-1:])
    along = np.concatenate([first.tangent, inner, last.tangent])
    step = np.arctan2(cross(along[:-1], along[1:]), np.sum(along[:-1] * along[1:], axis=1))
    turned = np.append(0.0, np.cumsum(step))
    count = max(1, math.ceil(float(np.abs(turned).max()) / HALF_TURN))
    order = np.sign(turned[-1])
    if not order or not (order * step >= 0.0).all():
        return None
    nodes = np.interp(np.linspace(0.0, order * turned[-1], count + 1), order * turned, density.t)
    nodes[0], nodes[-1] = density.t[0], density.t[-1]
    a, b = (first, last) if count == 1 else curve.span(nodes[:-1], nodes[1:])
    curvature, bulges, arrived = _arc_from(a.point, a.tangent, b.point)
    miss = np.abs(cross(arrived, b.tangent)) / np.abs(curvature)
    if float(miss.max()) > rounding(curve.size):
        return None
    chain = Chain(a.point, a.tangent, curvature, nodes[:-1], nodes[1:])
    deviation = chain_deviation(curve, chain, limit, 2 * LOOKS)
    outward, inward = max(-float(deviation.inside.min()), 0.0), max(float(deviation.outside.max()), 0.0)
    return FittedArcs(a.point, bulges, outward, inward) if max(outward, inward) <= limit else None


def _slip(curve: Curve, tolerance: float) -> float:
    """Permitted slip of a joint's foot along the curve, mm, by which bounds are widened."""
    return max(0.25 * rounding(curve.size), SLIP * tolerance)


def _biarcs(curve: Curve, low: Array, high: Array, slip: float) -> _Biarcs:
    """Biarcs between the ends of each interval (n,), the feet of their joints known to within `slip` mm.

    The ratio of the tangents' lengths is free. It is 1 unless curvature changes faster at one end: then the arcs'
    lengths s make their errors ``|kappa'| s^3`` alike.
    """
    a, b = curve.span(low, high)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = np.abs(b.curvature_slope / a.curvature_slope) ** (1.0 / 6.0)
    ratio = np.where(np.isfinite(ratio), np.clip(ratio, 1.0 / MOST_RATIO, MOST_RATIO), 1.0)
    # tangents of the lengths r d and d, r the ratio, end r d + d apart, and the joint divides that as r to 1: d is the
    # root of a quadratic equation
    chord = b.point - a.point
    along = np.sum(chord * (ratio[:, None] * a.tangent + b.tangent), axis=1)
    square = np.sum(chord * chord, axis=1)
    # |T0 - T1|^2 = 2 (1 - T0.T1), without its cancellation
    spread = ratio * np.sum((a.tangent - b.tangent) ** 2, axis=1)
    length = square / (along + np.sqrt(np.maximum(along**2 + spread * square, 0.0)))
    share = (ratio / (1.0 + ratio))[:, None]
    leave = a.point + (ratio * length)[:, None] * a.tangent
    joint = (1.0 - share) * leave + share * (b.point - length[:, None] * b.tangent)
    k0, bulge0, _ = _arc_from(a.point, a.tangent, joint)
    k1, bulge1, end_tangent = _arc_from(b.point, -b.tangent, joint)
    k1, bulge1 = -k1, -bulge1
    joint_tangent = -end_tangent
    middle, miss = foot(curve, low, high, joint, joint_tangent, enough=slip)
    # where the joint's normal does not meet the curve at `middle`, part of the curve would have no arc beside it
    lost = miss > 2.0 * slip
    k0 = np.where(lost, np.nan, k0)
    chain = Chain(
        _interleave(a.point, b.point),
        _interleave(a.tangent, b.tangent),
        _interleave(k0, k1),
        _interleave(low, middle),
        _interleave(middle, high),
    )
    return _Biarcs(_interleave(a.point, joint), _interleave(bulge0, bulge1), chain)


def _arc_from(start: Array, tangent: Array, end: Array) -> tuple[Array, Array, Array]:
    """Curvature (n,), bulge (n,) and end tangent (n, 2) of arcs that leave `start` along `tangent` and reach `end`."""
    chord = end - start
    square = np.sum(chord * chord, axis=1)
    length = np.sqrt(square)
    cosine = np.sum(tangent * chord, axis=1) / length
    across = cross(tangent, chord)
    curvature = 2.0 * across / square
    bulge = (across / length) / (1.0 + cosine)
    return curvature, bulge, 2.0 * (cosine / length)[:, None] * chord - tangent


def _interleave(a: Array, b: Array) -> Array:
    """Rows of a and b (n, ...) in turn: a0, b0, a1, b1, ... (2n, ...)."""
    return np.stack([a, b], axis=1).reshape(-1, *a.shape[1:])
