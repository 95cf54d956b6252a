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
    from camgeo.curve import Array, Curve

SHORT = 0.02  # of the period: parameter lengths over which points' differences are integrated, not subtracted
STEPS = 40
_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(12)


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
        t = 0.5 * (knots[:, 1:] + knots[:, :-1])[..., None] + half[..., None] * _GAUSS
        at = curve.sample(t.ravel())
        velocity = (at.speed[:, None] * at.tangent).reshape(*t.shape, 2)
        out[short] = np.einsum("npg,npga->na", half[..., None] * _WEIGHT, velocity)
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
    edge = np.roll(points, -1, axis=0) - points
    length = np.diff(np.append(t, t[0] + period))
    # side[i, j]: on which side of edge i vertex j lies
    side = edge[:, 0, None] * (points[None, :, 1] - points[:, None, 1]) - edge[:, 1, None] * (
        points[None, :, 0] - points[:, None, 0]
    )
    after = np.roll(side, -1, axis=1)
    parted = (side < 0.0) != (after < 0.0)
    first, second = np.nonzero(np.triu(parted & parted.T, 2))
    if t.size > 2:
        whole = (first != 0) | (second != t.size - 1)
        first, second = first[whole], second[whole]
    on_second = side[first, second] / (side[first, second] - after[first, second])
    on_first = side[second, first] / (side[second, first] - after[second, first])
    return np.column_stack([t[first] + on_first * length[first], t[second] + on_second * length[second]])


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
