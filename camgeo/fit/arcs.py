"""A curve as tangent-continuous arcs: biarcs through points of the curve (THEORY section 3).

Nodes take equal shares of the integral of ``(|kappa'| / (40.5 e))^(1/3) ds``, both arcs of a biarc about equally long.
A stretch of constant curvature is one arc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.deviation import Chain, chain_deviation, foot, seen_deviation
from camgeo.fit.nodes import TRIES, Density, ToleranceError, check_count, check_precision, reshared, rounding
from camgeo.fit.pieces import ArcSpline, Bound

if TYPE_CHECKING:
    from camgeo.curve import Array, Curve, Frame

CONSTANT = 40.5  # error of a biarc of arcs of length s: |kappa'| s^3 / 40.5
LOOKS = 8  # places on an arc at which its error is seen while the nodes are being shared
ROUNDS = 5  # of sharing the nodes anew before there are more of them
WIDEST = 2.0  # radians that a biarc may turn through
USABLE = 0.995  # of the tolerance, left to the fit; the rest covers rounding of the written coordinates


def arc_density(frame: Frame) -> Array:
    """Arcs for each unit of parameter at a tolerance of 1 mm: ``(|kappa'|/40.5)^(1/3) ds/dt``, without a division."""
    slope = frame.turn_slope * frame.speed - frame.turn * frame.speed_slope
    density: Array = np.cbrt(np.abs(slope) / CONSTANT)
    return density


@dataclass(frozen=True)
class _Biarcs:
    """Both arcs of each biarc, in order: points where each begins (2n, 2), bulges and chain (2n,)."""

    points: Array
    bulges: Array
    chain: Chain


def fit_arcs(curve: Curve, tolerance: float) -> ArcSpline:
    """Tangent-continuous arcs within `tolerance` mm of a curve; corners of a trimmed curve stay corners.

    The bound is proved by `chain_deviation`. Cost and number of arcs grow as tolerance^(-1/3). Raises ToleranceError
    where the tolerance is below rounding, needs too many arcs, or is not reached.
    """
    stretches = [(float(a), float(b)) for run in curve.runs for a, b in run.stretches]
    size = curve.size
    check_precision(size, tolerance)
    usable = min(USABLE * tolerance, tolerance - rounding(size))
    fits = _fit_stretches(curve, stretches, usable)
    points = np.concatenate([fit[0] for fit in fits])
    bulges = np.concatenate([fit[1] for fit in fits])
    outward = max(fit[2] for fit in fits)
    inward = max(fit[3] for fit in fits)
    return ArcSpline(points, bulges, Bound(outward, inward).widened(rounding(size)))


def _fit_stretches(
    curve: Curve, stretches: list[tuple[float, float]], tolerance: float
) -> list[tuple[Array, Array, float, float]]:
    """Points, bulges, outward and inward bound of each stretch."""
    done: dict[int, tuple[Array, Array, float, float]] = {}
    nodes: dict[int, Array] = {}
    best = math.inf
    for i, stretch in enumerate(stretches):
        steady = curve.steady(stretch)
        if steady is not None:
            done[i] = _steady_arcs(curve, stretch, steady[1])
            continue
        density = Density.of(curve, np.array([stretch]), arc_density)[0]
        needed = density.total / math.cbrt(tolerance)
        check_count(needed, "arcs", tolerance)
        turning = (stretch[1] - stretch[0]) * float(np.abs(curve.sample(density.t[1:-1]).turn).max())
        nodes[i] = density.nodes(max(1, math.ceil(0.5 * needed - 1e-6), math.ceil(turning / WIDEST)))
    settled = dict.fromkeys(nodes, 0)
    for _ in range(TRIES):
        todo = [i for i in nodes if i not in done]
        if not todo:
            return [done[i] for i in range(len(stretches))]
        low = np.concatenate([nodes[i][:-1] for i in todo])
        high = np.concatenate([nodes[i][1:] for i in todo])
        biarcs = _biarcs(curve, low, high)
        worst = seen_deviation(curve, biarcs.chain, LOOKS).reshape(-1, 2).max(axis=1)
        if float(worst.max()) <= tolerance:
            deviation = chain_deviation(curve, biarcs.chain, tolerance, 2 * LOOKS)
            worst = deviation.worst.reshape(-1, 2).max(axis=1)
        else:
            deviation = None
        first = 0
        for i in todo:
            count = nodes[i].size - 1
            mine = slice(first, first + count)
            both = slice(2 * first, 2 * (first + count))
            first += count
            reached = float(worst[mine].max())
            best = min(best, reached)
            if deviation is not None and reached <= tolerance:
                # f is the curve's distance outside the arc: where it is positive the file lies inward
                inward = max(float(deviation.outside[both].max()), 0.0)
                outward = max(-float(deviation.inside[both].min()), 0.0)
                done[i] = (biarcs.points[both], biarcs.bulges[both], outward, inward)
            elif reached > tolerance:
                nodes[i], settled[i] = _denser(curve, nodes[i], worst[mine], tolerance, settled[i])
    raise ToleranceError(f"arcs within {tolerance:.3g} mm were not reached; the best was {best:.3g} mm", best)


def _denser(curve: Curve, nodes: Array, worst: Array, tolerance: float, tried: int) -> tuple[Array, int]:
    """Nodes for the next try: shared anew twice, then more of them; all intervals halved where errors are unknown."""
    if not np.isfinite(worst).all():
        halved = np.empty(2 * nodes.size - 1)
        halved[::2], halved[1::2] = nodes, 0.5 * (nodes[:-1] + nodes[1:])
        return halved, 0
    mean = float(np.mean(np.cbrt(worst))) ** 3
    if tried < ROUNDS and mean <= tolerance:
        return reshared(nodes, worst, 3.0), tried + 1
    count = nodes.size - 1
    factor = math.cbrt(max(mean, tolerance) / tolerance)
    more = max(count + 1, math.ceil(count * factor))
    density = np.concatenate([[0.0], np.cumsum(np.cbrt(np.maximum(worst, 1e-6 * worst.max())))])
    spread: Array = np.interp(np.linspace(0.0, density[-1], more + 1), density, nodes)
    spread[0], spread[-1] = nodes[0], nodes[-1]
    return spread, 0


def _steady_arcs(curve: Curve, stretch: tuple[float, float], turn: float) -> tuple[Array, Array, float, float]:
    """One arc for a stretch of constant curvature, two for more than a half turn."""
    sweep = turn * (stretch[1] - stretch[0])
    count = 1 if abs(sweep) <= math.pi * (1.0 + 1e-9) else 2
    starts = np.linspace(stretch[0], stretch[1], count + 1)[:-1]
    bulge = math.tan(0.25 * sweep / count)
    return curve.sample(starts, 1).point, np.full(count, bulge), 0.0, 0.0


def _biarcs(curve: Curve, low: Array, high: Array) -> _Biarcs:
    """Biarcs with equal tangent lengths between the ends of each interval (n,)."""
    a, b = curve.span(low, high)
    chord = b.point - a.point
    both = a.tangent + b.tangent
    along = np.sum(chord * both, axis=1)
    square = np.sum(chord * chord, axis=1)
    # |T0 - T1|^2 = 2 (1 - T0.T1), without its cancellation
    spread = np.sum((a.tangent - b.tangent) ** 2, axis=1)
    length = square / (along + np.sqrt(np.maximum(along**2 + spread * square, 0.0)))
    joint = 0.5 * (a.point + b.point) + 0.5 * length[:, None] * (a.tangent - b.tangent)
    k0, bulge0, _ = _arc_from(a.point, a.tangent, joint)
    k1, bulge1, far = _arc_from(b.point, -b.tangent, joint)
    k1, bulge1 = -k1, -bulge1
    joint_tangent = -far
    middle, _ = foot(curve, 0.5 * (low + high), low, high, joint, joint_tangent)
    chain = Chain(
        _interleave(a.point, b.point),
        _interleave(a.tangent, b.tangent),
        _interleave(k0, k1),
        _interleave(low, middle),
        _interleave(middle, high),
    )
    return _Biarcs(_interleave(a.point, joint), _interleave(bulge0, bulge1), chain)


def _arc_from(start: Array, tangent: Array, end: Array) -> tuple[Array, Array, Array]:
    """Curvature, bulge and tangent at the end of the arcs that leave `start` along `tangent` and reach `end`."""
    chord = end - start
    square = np.sum(chord * chord, axis=1)
    length = np.sqrt(square)
    cosine = np.sum(tangent * chord, axis=1) / length
    cross = tangent[:, 0] * chord[:, 1] - tangent[:, 1] * chord[:, 0]
    curvature = 2.0 * cross / square
    bulge = (cross / length) / (1.0 + cosine)
    return curvature, bulge, 2.0 * (cosine / length)[:, None] * chord - tangent


def _interleave(a: Array, b: Array) -> Array:
    """a0, b0, a1, b1, ... (2n, ...)."""
    return np.stack([a, b], axis=1).reshape(-1, *a.shape[1:])
