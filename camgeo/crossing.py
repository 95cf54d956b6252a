"""Where a curve crosses itself: parameters to full precision, also for swallowtails far smaller than rounding.

A stretch that runs backwards over a parameter length w with the speed -d leaves a swallowtail of the size d w. The
curve's points say nothing of it once that is lost in their rounding; the integral of speed times tangent over the
short stretch still does, and the crossings are solved for with it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from camgeo.radius import ROUNDING

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from camgeo.curve import Array, Curve

SHORT = 0.02  # of the period: parameter lengths over which points' differences are integrated, not subtracted
STEPS = 40
MOST_PAIRS = 200_000  # looked at together
NODES = 12  # of the quadrature between two breaks


def displacement(curve: Curve, start: Array, end: Array) -> Array:
    """Give ``c(end) - c(start)`` (n, 2) for start <= end (n,), exact to the last digits of its own size where short."""
    out = np.empty((start.size, 2))
    short = end - start <= SHORT * curve.shape.period
    if (~short).any():
        count = int((~short).sum())
        ends = curve.sample(np.concatenate([start[~short], end[~short]])).point
        out[~short] = ends[count:] - ends[:count]
    if short.any():
        breaks = all_breaks(curve, float(start[short].min()), float(end[short].max()))
        knots = np.clip(breaks[None], start[short, None], end[short, None])
        knots = np.concatenate([start[short, None], knots, end[short, None]], axis=1)
        half = 0.5 * np.diff(knots, axis=1)
        node, weight = np.polynomial.legendre.leggauss(NODES)
        t = 0.5 * (knots[:, 1:] + knots[:, :-1])[..., None] + half[..., None] * node
        at = curve.sample(t.ravel())
        velocity = (at.speed[:, None] * at.tangent).reshape(*t.shape, 2)
        out[short] = np.einsum("npg,npga->na", half[..., None] * weight, velocity)
    return out


def all_breaks(curve: Curve, low: float, high: float) -> Array:
    """List the shape's breaks, repeated by its period, strictly between two parameters, rising (m,)."""
    breaks, period = np.asarray(curve.shape.breaks, dtype=np.float64), curve.shape.period
    if breaks.size == 0:
        return breaks
    first = int(np.floor((low - breaks.max()) / period))
    last = int(np.ceil((high - breaks.min()) / period))
    turns: Array = (breaks[None] + period * np.arange(first, last + 1)[:, None]).ravel()
    return turns[(turns > low) & (turns < high)]


def seen_crossings(t: Array, points: Array, period: float) -> Array:
    """Crossings of the closed polygon with vertices `points` (n, 2) at parameters t (n,): parameters (m, 2).

    Linear along each edge: a beginning for `settled`. Cost grows as n^2.
    """
    count = t.size
    edge = np.roll(points, -1, axis=0) - points
    length = np.diff(np.append(t, t[0] + period))
    parted = np.empty((count, count), dtype=bool)
    for rows in in_parts(count):
        side = _side(edge[rows, None], points[None] - points[rows, None])
        parted[rows] = (side < 0.0) != (np.roll(side, -1, axis=1) < 0.0)
    first, second = np.nonzero(np.triu(parted & parted.T, 2))
    apart = (first != 0) | (second != count - 1)
    first, second = first[apart], second[apart]

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


def in_parts(count: int) -> list[slice]:
    """Rows of a table of `count` by `count` pairs, so many at a time that memory stays small."""
    step = max(1, MOST_PAIRS // max(count, 1))
    return [slice(i, min(i + step, count)) for i in range(0, count, step)]


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
    step = np.full((2, t.size), np.inf)
    for _ in range(STEPS):
        gap = displacement(curve, t, s)
        at = curve.sample(np.concatenate([t, s]))
        one, two = at.tangent[: t.size], at.tangent[t.size :]
        turn = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.stack(
                [
                    (gap[:, 0] * two[:, 1] - gap[:, 1] * two[:, 0]) / (at.speed[: t.size] * turn),
                    (gap[:, 0] * one[:, 1] - gap[:, 1] * one[:, 0]) / (at.speed[t.size :] * turn),
                ]
            )
        most = 0.2 * (s - t)
        step = np.clip(np.where(np.isfinite(step), step, most), -most, most)
        t, s = t + step[0], s + step[1]
        if (np.abs(step) <= 2.0 * np.spacing(np.maximum(np.abs(t), np.abs(s)))).all():
            break
    at = curve.sample(np.concatenate([t, s]))
    forward = (at.speed[: t.size] > 0.0) & (at.speed[t.size :] > 0.0)
    close = np.abs(displacement(curve, t, s)).max(axis=1) <= ROUNDING * size
    still = np.abs(step).max(axis=0) <= 1e-3 * (s - t)
    found = forward & close & still
    return np.column_stack([t[found], s[found]])
