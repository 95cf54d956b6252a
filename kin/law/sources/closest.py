"""Splines within bounds: the convex programme min t, |S(x_i) - s_i| <= t b_i, stopped as soon as t is 1 or cannot be.

A primal-dual interior-point method (S. Mehrotra, SIAM J. Optimization 2, 1992, without his corrector). Each step is a
weighted least-squares problem, whose weights are the multipliers; those bound t from below.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kin.law.sources.spline import Fitting
    from kin.numeric.arrays import Array

_STEPS = 80
_SHARE = 0.1  # of the complementarity that is aimed at
_INSIDE = 0.97  # of the way to the nearest bound
_SURE = 1e-9  # of the multipliers: by so much at most are they out of balance where they prove a bound


def within(fitting: Fitting, s: Array, bounds: Array) -> Array | None:
    """Coefficients of a spline with |S(x_i) - s_i| <= bounds_i at every x, (n,) each; None where there is none."""
    try:
        coefficients = fitting.nearest(s)
        return _within(fitting, s, bounds, coefficients)
    except np.linalg.LinAlgError:  # spans without rows
        return None


def _within(fitting: Fitting, s: Array, bounds: Array, coefficients: Array) -> Array | None:
    n, free = len(s), fitting.free

    def off(c: Array) -> Array:
        return (fitting.values(c) - s) / bounds

    u = off(coefficients)
    t, above, below = 1.5 * float(np.abs(u).max()), np.full(n, 0.5 / n), np.full(n, 0.5 / n)
    for _ in range(_STEPS):
        if np.abs(u).max() <= 1.0 or not len(free):
            break
        over, under = t - u, t + u
        aim = _SHARE * float(above @ over + below @ under) / (2 * n)
        d, e = above / over + below / under, above / over - below / under
        v, q = fitting.products(e / bounds, aim * (1 / over - 1 / under) / bounds)
        toward = np.linalg.solve(fitting.normal(d / bounds**2), np.stack([v, q], axis=1))
        dt = (1.0 - aim * float((1 / over + 1 / under).sum()) + float(v @ toward[:, 1])) / (
            float(v @ toward[:, 0]) - float(d.sum())
        )
        step = np.zeros(len(coefficients))
        step[free] = toward[:, 0] * dt - toward[:, 1]
        du = fitting.values(step) / bounds
        new_above = (aim - above * (dt - du)) / over
        new_below = (aim - below * (dt + du)) / under
        primal = _reach(np.concatenate([over, under]), np.concatenate([dt - du, dt + du]))
        dual = _reach(np.concatenate([above, below]), np.concatenate([new_above - above, new_below - below]))
        coefficients, t = coefficients + primal * step, t + primal * dt
        above, below = above + dual * (new_above - above), below + dual * (new_below - below)
        u = off(coefficients)
        balance = float(np.abs(fitting.products((above - below) / bounds)[0]).max() * bounds.min())
        size = float((above + below).sum())
        if float((above - below) @ u) > size and balance < _SURE * size:
            return None
    return coefficients if np.abs(u).max() <= 1.0 else None


def _reach(values: Array, steps: Array) -> float:
    """Share of the steps that keeps all values above 0."""
    falls = steps < 0.0
    return min(1.0, _INSIDE * float((values[falls] / -steps[falls]).min())) if falls.any() else 1.0
