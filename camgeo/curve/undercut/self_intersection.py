"""Where a curve crosses itself: parameters to full precision, also for swallowtails far smaller than rounding.

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
MOST_PAIRS = 200_000  # looked at together
NODES = 12  # of the quadrature of one panel
SHARPER = 0.05  # of the size: paths of less are given better by their integral than by their ends' points
PANEL_SHARPNESS = 1e-10  # of a panel's path: halves that agree with it so far are right to the last digits
PANEL_HALVINGS = (
    8  # at the most; what crossings leave is held against contact at every node (`camgeo.curve.undercut.trim`)
)


def displacement(curve: Curve, start: Array, end: Array) -> Array:
    """Give ``c(end) - c(start)`` (n, 2) for start <= end (n,), exact to the last digits of its own size where short.

    A path about as long as the curve's size, however short in parameter, is the difference of its ends.
    """
    ends = curve.sample(np.concatenate([start, end])).point
    out: Array = ends[start.size :] - ends[: start.size]
    short = np.flatnonzero(end - start <= SHORT * curve.shape.period)
    if short.size:
        knots = _between(
            all_breaks(curve, float(start[short].min()), float(end[short].max())), start[short], end[short]
        )
        which, path = _short_paths(curve, knots)
        out[short[which]] = path
    return out


def _short_paths(curve: Curve, knots: Array) -> tuple[NDArray[np.intp], Array]:
    """Integral of the velocity (m, 2) over the short ones of stretches that `knots` (n, k) divide at breaks, and which.

    Panels are halved until both halves together say what the whole said; what these are off by is far below that.
    """
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
        parts, both = halves.reshape(2, -1, 2), speeds.reshape(2, -1).sum(axis=0)
        # what a parallel's speed loses in the difference that it is
        noise = ROUNDING * curve.size * (high - low + turned.reshape(2, -1).sum(axis=0))
        off = np.abs(parts.sum(axis=0) - whole).max(axis=1, initial=0.0)
        done = (off <= PANEL_SHARPNESS * both + noise) | (level == PANEL_HALVINGS)
        np.add.at(path, owner[done], parts.sum(axis=0)[done])
        if done.all():
            break
        rest = ~done
        whole = np.concatenate([parts[0, rest], parts[1, rest]])
        low, high = np.concatenate([low[rest], middle[rest]]), np.concatenate([middle[rest], high[rest]])
        owner = np.tile(owner[rest], 2)
    which = np.flatnonzero(short)
    return which, path[which]


def _quadrature(curve: Curve, low: Array, high: Array) -> tuple[Array, Array, Array]:
    """Integrals over panels (n,) by one rule each: of the velocity (n, 2), of absolute speed and turn (n,)."""
    node, weight = gauss(NODES)
    half = 0.5 * (high - low)
    at = curve.sample((0.5 * (low + high)[:, None] + half[:, None] * node).ravel())
    share = half[:, None] * weight
    velocity = (at.speed[:, None] * at.tangent).reshape(low.size, NODES, 2)
    speed, turn = (np.abs(a).reshape(low.size, NODES) for a in (at.speed, at.turn))
    return np.einsum("np,npa->na", share, velocity), np.sum(share * speed, axis=1), np.sum(share * turn, axis=1)


def _between(breaks: Array, start: Array, end: Array) -> Array:
    """Start, breaks between and end of each stretch (n, m), as many times the end as others have more breaks."""
    first, after = np.searchsorted(breaks, start, side="right"), np.searchsorted(breaks, end, side="left")
    own = first[:, None] + np.arange(int((after - first).max()))
    inside = np.append(breaks, np.inf)[np.minimum(own, breaks.size)]
    return np.concatenate([start[:, None], np.minimum(inside, end[:, None]), end[:, None]], axis=1)


def all_breaks(curve: Curve, low: float, high: float) -> Array:
    """List the shape's breaks, repeated by its period, strictly between two parameters, rising (m,)."""
    breaks, period = np.asarray(curve.shape.breaks, dtype=np.float64), curve.shape.period
    if breaks.size == 0:
        return breaks
    first = int(np.floor((low - breaks.max()) / period))
    last = int(np.ceil((high - breaks.min()) / period))
    turns: Array = (breaks[None] + period * np.arange(first, last + 1)[:, None]).ravel()
    return turns[(turns > low) & (turns < high)]


def seen_crossings(t: Array, points: Array, period: float, own: int) -> Array:
    """Crossings of the closed polygon with vertices `points` (n, 2) at parameters t (n,): parameters (m, 2).

    Of one of the first `own` edges with any. Linear along each edge: a beginning for `settled`. Cost grows as own n.
    """
    count = t.size
    edge = np.roll(points, -1, axis=0) - points
    length = np.diff(np.append(t, t[0] + period))
    found = []
    for rows in in_parts(own, count):
        side = _side(edge[rows, None], points[None] - points[rows, None])
        one, other = np.nonzero((side < 0.0) != (np.roll(side, -1, axis=1) < 0.0))
        one += rows.start
        # each pair once, and no neighbours
        new = (other > one + 1) & ((one > 0) | (other < count - 1))
        one, other = one[new], other[new]
        start, end = (_side(edge[other], points[k % count] - points[other]) for k in (one, one + 1))
        both = (start < 0.0) != (end < 0.0)
        found.append(np.stack([one[both], other[both]]))
    first, second = np.concatenate(found, axis=1) if found else np.empty((2, 0), dtype=np.intp)

    def share(cut: NDArray[np.intp], by: NDArray[np.intp]) -> Array:
        """Where edges are cut by the lines of others, as a share of their length."""
        start = _side(edge[by], points[cut] - points[by])
        return start / (start - _side(edge[by], points[(cut + 1) % count] - points[by]))

    return np.column_stack(
        [t[first] + share(first, second) * length[first], t[second] + share(second, first) * length[second]]
    )


def _side(edge: Array, to: Array) -> Array:
    """On which side of an edge (..., 2) a point lies that is `to` (..., 2) away from its start; left is positive."""
    side: Array = edge[..., 0] * to[..., 1] - edge[..., 1] * to[..., 0]
    return side


def in_parts(rows: int, count: int) -> list[slice]:
    """Rows of a table of `rows` by `count` pairs, so many at a time that memory stays small."""
    step = max(1, MOST_PAIRS // max(count, 1))
    return [slice(i, min(i + step, rows)) for i in range(0, rows, step)]


def settled(curve: Curve, pairs: Array, size: float) -> Array:
    """Self-crossings that Newton's method finds from pairs of parameters (n, 2), as pairs t < s (m, 2), s - t < period.

    The shorter way round lies between them. A pair counts as found where both points agree within rounding of `size`,
    the curve runs forward at both, and its directions differ.
    """
    period = curve.shape.period
    low, high = pairs.min(axis=1), pairs.max(axis=1)
    far = high - low > 0.5 * period
    t, s = np.where(far, high, low), np.where(far, low + period, high)
    t, s = t[s > t], s[s > t]
    if t.size == 0:
        return np.empty((0, 2))
    last = np.full(t.size, np.inf)
    moving = np.arange(t.size)
    for _ in range(STEPS):
        one, two = t[moving], s[moving]
        by = np.stack(_towards(curve, one, two))
        most = 0.2 * (two - one)
        by = np.clip(np.where(np.isfinite(by), by, most), -most, most)
        t[moving], s[moving] = one + by[0], two + by[1]
        last[moving] = np.abs(by).max(axis=0)
        moving = moving[last[moving] > 2.0 * np.spacing(np.maximum(np.abs(t), np.abs(s)))[moving]]
        if moving.size == 0:
            break
    at = curve.sample(np.concatenate([t, s]))
    forward = (at.speed[: t.size] > 0.0) & (at.speed[t.size :] > 0.0)
    close = np.abs(displacement(curve, t, s)).max(axis=1) <= ROUNDING * size
    still = last <= 1e-3 * (s - t)
    found = forward & close & still
    return np.column_stack([t[found], s[found]])


def _towards(curve: Curve, t: Array, s: Array) -> tuple[Array, Array]:
    """Newton's steps of parameters t < s (n,) to where both points agree; not finite where both tangents do."""
    gap = displacement(curve, t, s)
    at, to = curve.sample(np.concatenate([t, s])).split(t.size)
    turn = _side(at.tangent, to.tangent)
    with np.errstate(divide="ignore", invalid="ignore"):
        return _side(gap, to.tangent) / (at.speed * turn), _side(gap, at.tangent) / (to.speed * turn)
