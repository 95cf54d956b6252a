"""Self-crossings of a curve: parameters to full precision, also for swallowtails far smaller than rounding.

A stretch that runs backwards over a parameter length w with the speed -d leaves a swallowtail of the size d w. The
curve's points say nothing of it once that is lost in their rounding; the integral of speed times tangent over the
short stretch still does, and the crossings are solved for with it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.curve.curvature import ROUNDING
from kin.numeric.quadrature import gauss

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve.curve import Curve
    from kin.numeric.arrays import Array

SHORT = 0.02  # of the period: parameter lengths over which points' differences are integrated, not subtracted
STEPS = 40
MOST_PAIRS = 200_000  # pairs in memory together
NODES = 12  # of the quadrature of one panel
SHARPER = 0.05  # of the size: a shorter path has a sharper chord from its integral than from its ends' points
PANEL_SHARPNESS = 1e-10  # of a panel's path: halves that agree with the whole so far are right to the last digits
PANEL_HALVINGS = 8  # at the most; crossings are checked by contact at every node (`camgeo.curve.undercut.trim`)


def displacement(curve: Curve, start: Array, end: Array) -> Array:
    """Chord ``c(end) - c(start)`` (n, 2), mm, for start <= end (n,), exact to its own last digits where it is short.

    Along a longer path it is the difference of the ends.
    """
    ends = curve.sample(np.concatenate([start, end])).point
    difference: Array = ends[start.size :] - ends[: start.size]
    short = np.flatnonzero(end - start <= SHORT * curve.shape.period)
    if short.size:
        knots = _between(
            all_breaks(curve, float(start[short].min()), float(end[short].max())), start[short], end[short]
        )
        rows, path = _short_paths(curve, knots)
        difference[short[rows]] = path
    return difference


def _short_paths(curve: Curve, knots: Array) -> tuple[NDArray[np.intp], Array]:
    """Indices (m,) of the short stretches among n, which `knots` (n, k) divide at breaks, and their chords (m, 2).

    Panels are halved until both halves together agree with the whole; their own error is far below the difference.
    """
    # one panel between neighbouring knots; stretches with short paths are integrated
    count = knots.shape[0]
    low, high = knots[:, :-1].ravel(), knots[:, 1:].ravel()
    owner = np.repeat(np.arange(count), knots.shape[1] - 1)
    whole, length, _ = _quadrature(curve, low, high)
    short = np.bincount(owner, length, count) < SHARPER * curve.size
    panels = short[owner] & (high > low)
    owner, low, high, whole = owner[panels], low[panels], high[panels], whole[panels]
    path = np.zeros((count, 2))
    for level in range(PANEL_HALVINGS + 1):
        middle = 0.5 * (low + high)
        halves, speeds, turned = _quadrature(curve, np.concatenate([low, middle]), np.concatenate([middle, high]))
        parts, way = halves.reshape(2, -1, 2), speeds.reshape(2, -1).sum(axis=0)
        # rounding of a parallel's speed, which is a difference
        noise = ROUNDING * curve.size * (high - low + turned.reshape(2, -1).sum(axis=0))
        off = np.abs(parts.sum(axis=0) - whole).max(axis=1, initial=0.0)
        done = (off <= PANEL_SHARPNESS * way + noise) | (level == PANEL_HALVINGS)
        np.add.at(path, owner[done], parts.sum(axis=0)[done])
        if done.all():
            break
        undecided = ~done
        whole = np.concatenate([parts[0, undecided], parts[1, undecided]])
        low, high = (
            np.concatenate([low[undecided], middle[undecided]]),
            np.concatenate([middle[undecided], high[undecided]]),
        )
        owner = np.tile(owner[undecided], 2)
    indices = np.flatnonzero(short)
    return indices, path[indices]


def _quadrature(curve: Curve, low: Array, high: Array) -> tuple[Array, Array, Array]:
    """Integrals over panels (n,), by one rule each, of the velocity (n, 2) and of absolute speed and turn (n,)."""
    node, weight = gauss(NODES)
    half = 0.5 * (high - low)
    frame = curve.sample((0.5 * (low + high)[:, None] + half[:, None] * node).ravel())
    share = half[:, None] * weight
    velocity = (frame.speed[:, None] * frame.tangent).reshape(low.size, NODES, 2)
    speed, turn = (np.abs(a).reshape(low.size, NODES) for a in (frame.speed, frame.turn))
    return np.einsum("np,npa->na", share, velocity), np.sum(share * speed, axis=1), np.sum(share * turn, axis=1)


def _between(breaks: Array, start: Array, end: Array) -> Array:
    """Start, breaks between and end of each stretch (n, m); a stretch with fewer breaks repeats its end."""
    first, after = np.searchsorted(breaks, start, side="right"), np.searchsorted(breaks, end, side="left")
    own = first[:, None] + np.arange(int((after - first).max()))
    inside = np.append(breaks, np.inf)[np.minimum(own, breaks.size)]
    return np.concatenate([start[:, None], np.minimum(inside, end[:, None]), end[:, None]], axis=1)


def all_breaks(curve: Curve, low: float, high: float) -> Array:
    """The shape's breaks, repeated by its period, strictly between `low` and `high`, rising (m,)."""
    breaks, period = np.asarray(curve.shape.breaks, dtype=np.float64), curve.shape.period
    if breaks.size == 0:
        return breaks
    first = int(np.floor((low - breaks.max()) / period))
    last = int(np.ceil((high - breaks.min()) / period))
    turns: Array = (breaks[None] + period * np.arange(first, last + 1)[:, None]).ravel()
    return turns[(turns > low) & (turns < high)]


def polygon_crossings(t: Array, points: Array, period: float, own: int) -> Array:
    """Parameters (m, 2) of crossings of the closed polygon with vertices `points` (n, 2) at parameters t (n,).

    The first `own` edges are crossed with every edge, and parameters, which repeat by `period`, are interpolated along
    each edge: a beginning for Newton's method. The time grows as own n.
    """
    count = t.size
    edge = np.roll(points, -1, axis=0) - points
    length = np.diff(np.append(t, t[0] + period))
    crossings = []
    # each edge's ends lie on both sides of the other edge
    for rows in in_parts(own, count):
        side = _side(edge[rows, None], points[None] - points[rows, None])
        first_edge, second_edge = np.nonzero((side < 0.0) != (np.roll(side, -1, axis=1) < 0.0))
        first_edge += rows.start
        # each pair once, and no neighbours
        new = (second_edge > first_edge + 1) & ((first_edge > 0) | (second_edge < count - 1))
        first_edge, second_edge = first_edge[new], second_edge[new]
        start, end = (
            _side(edge[second_edge], points[k % count] - points[second_edge]) for k in (first_edge, first_edge + 1)
        )
        crosses = (start < 0.0) != (end < 0.0)
        crossings.append(np.stack([first_edge[crosses], second_edge[crosses]]))
    first, second = np.concatenate(crossings, axis=1) if crossings else np.empty((2, 0), dtype=np.intp)

    def share(cut: NDArray[np.intp], by: NDArray[np.intp]) -> Array:
        """Places at which the lines of other edges cut edges, as shares of their length."""
        start = _side(edge[by], points[cut] - points[by])
        return start / (start - _side(edge[by], points[(cut + 1) % count] - points[by]))

    return np.column_stack(
        [t[first] + share(first, second) * length[first], t[second] + share(second, first) * length[second]]
    )


def _side(edge: Array, point: Array) -> Array:
    """Side of an edge (..., 2) on which a point lies, given from the edge's start (..., 2); left is positive."""
    side: Array = edge[..., 0] * point[..., 1] - edge[..., 1] * point[..., 0]
    return side


def in_parts(rows: int, count: int) -> list[slice]:
    """Slices of the rows of a table of `rows` by `count` pairs, small enough for memory."""
    step = max(1, MOST_PAIRS // max(count, 1))
    return [slice(i, min(i + step, rows)) for i in range(0, rows, step)]


def newton_crossings(curve: Curve, pairs: Array, size: float) -> Array:
    """Self-crossings (m, 2), t < s < t + period, that Newton's method reaches from pairs of parameters (n, 2).

    The shorter way round lies between t and s. A pair counts as a crossing where both points agree within rounding of
    `size`, mm, and the curve runs forward at both.
    """
    # t and s in the order in which the way between them is the shorter one
    period = curve.shape.period
    low, high = pairs.min(axis=1), pairs.max(axis=1)
    wraps = high - low > 0.5 * period
    t, s = np.where(wraps, high, low), np.where(wraps, low + period, high)
    t, s = t[s > t], s[s > t]
    if t.size == 0:
        return np.empty((0, 2))
    # steps of a fifth of the gap at most, so that t and s do not meet; each pair moves until its steps are rounding
    last = np.full(t.size, np.inf)
    moving = np.arange(t.size)
    for _ in range(STEPS):
        first, second = t[moving], s[moving]
        step = np.stack(_newton_steps(curve, first, second))
        largest = 0.2 * (second - first)
        step = np.clip(np.where(np.isfinite(step), step, largest), -largest, largest)
        t[moving], s[moving] = first + step[0], second + step[1]
        last[moving] = np.abs(step).max(axis=0)
        moving = moving[last[moving] > 2.0 * np.spacing(np.maximum(np.abs(t), np.abs(s)))[moving]]
        if moving.size == 0:
            break
    # kept: forward at both, points equal to rounding, and at rest
    frame = curve.sample(np.concatenate([t, s]))
    forward = (frame.speed[: t.size] > 0.0) & (frame.speed[t.size :] > 0.0)
    close = np.abs(displacement(curve, t, s)).max(axis=1) <= ROUNDING * size
    at_rest = last <= 1e-3 * (s - t)
    converged = forward & close & at_rest
    return np.column_stack([t[converged], s[converged]])


def _newton_steps(curve: Curve, t: Array, s: Array) -> tuple[Array, Array]:
    """Newton steps (n,) of parameters t < s (n,) towards equal points; not finite where the tangents are parallel."""
    gap = displacement(curve, t, s)
    first, second = curve.sample(np.concatenate([t, s])).split(t.size)
    turn = _side(first.tangent, second.tangent)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _side(gap, second.tangent) / (first.speed * turn), _side(gap, first.tangent) / (second.speed * turn)
