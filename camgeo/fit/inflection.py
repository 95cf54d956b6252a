"""Inflections of a curve, and the one straight edge that runs across each.

Near an inflection the curve is a cubic, and the line that fits a cubic best touches the limits at both ends and twice
between (Chebyshev's polynomial of degree 3): within a tolerance e it reaches a to each side, ``k' a^3 = 24 e``, k' the
slope of the curvature. That is ``sqrt(24)/6 = 0.8165`` shares of the density of a straddling polygon.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from camgeo.fit.nodes import rounding
from kin.numeric.records import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

    from camgeo.curve.curve import Curve, Frame, SmoothRun
    from camgeo.fit.nodes import Density
    from kin.numeric.arrays import Array

REACH = math.sqrt(24.0) / 6.0
_ROOT_STEPS = 4  # of Newton's method at least
_MOST_ROOT_STEPS = 60  # halvings reach rounding by then
_NEAR = 0.15  # of an edge's reach: error of an inflection
_CLEAR = 0.05  # of an edge's reach: least distance of an extreme from the inflection
_STEPS = 16  # of Newton's method for an edge
_CUBIC = 3.0  # times the bend of a cubic: most that a first guess may bend
_PLACES = (0.25, 0.5, 0.75, 1.0)  # of a reach, at which the bend is sampled
_HALVINGS = 60  # of a reach
_SETTLED = 1e-4  # of the tolerance: error of an extreme's height
_MOST_STEP = 0.3  # of an edge's reach, in one step


def inflections(curve: Curve, densities: Sequence[Density], tolerance: float) -> tuple[Array, float]:
    """Parameters (n,), rising, at which the sampled turn changes its sign, and its sign (1 or -1) before the first.

    `densities` give the grid, one for each stretch. Changes lie inside the stretches or at the breaks between them; a
    change where a closed run ends is left out. Their error is to be below `_NEAR` of the reach of an edge across them
    within `tolerance`, mm.
    """
    if float(curve.cells.rows[2].min()) >= 0.0:
        return np.zeros(0), 1.0
    if float(curve.cells.rows[3].max()) <= 0.0:
        return np.zeros(0), -1.0
    t = np.concatenate([density.t for density in densities])
    ends = np.cumsum([density.t.size for density in densities]) - 1
    side = np.ones(t.size, dtype=np.intp)
    side[ends] = -1
    positive = curve.sample(t, side).turn >= 0.0
    change = positive[1:] != positive[:-1]
    at_break = t[ends[:-1]][change[ends[:-1]]]
    change[ends[:-1]] = False
    changes = np.flatnonzero(change)
    # Newton's method, halving where it leaves the bracket
    low, high, sense = t[changes], t[changes + 1], np.where(positive[changes], 1.0, -1.0)
    root = 0.5 * (low + high)
    for step in range(_MOST_ROOT_STEPS if changes.size else 0):
        frame = curve.sample(root)
        with np.errstate(divide="ignore", invalid="ignore"):
            move = frame.turn / frame.turn_slope
        if step >= _ROOT_STEPS and (np.abs(move) <= _NEAR * reach(frame, tolerance)).all():
            break
        is_before = frame.turn * sense >= 0.0
        low, high = np.where(is_before, root, low), np.where(is_before, high, root)
        better = root - move
        # a root that has settled stays where it is, as an end of its bracket
        root = np.where((better >= low) & (better <= high), better, 0.5 * (low + high))
    roots: Array = np.sort(np.concatenate([at_break, root]))
    return roots, 1.0 if positive[0] else -1.0


def reach(frame: Frame, tolerance: float) -> Array:
    """Reach (n,), in the parameter, of edges to each side of inflections, by a cubic within a tolerance, mm.

    `frame` is the curve's at the inflections; infinite where the turn has no slope.
    """
    with np.errstate(divide="ignore"):
        far: Array = np.cbrt(24.0 * tolerance / (np.abs(frame.turn_slope) * frame.speed))
    return far


def reaches(curve: Curve, bends: Array, run: SmoothRun, tolerance: float) -> tuple[Array, Array]:
    """Reach, in the parameter, of edges across inflections `bends` (n,) before them and after them: (n,) each.

    Either side is taken by itself, as the slope of the curvature may jump at a break and be 0 on one side. A reach is
    halved until the curve bends over it no more than `_CUBIC` times as much as a cubic within the tolerance, mm.
    """
    reach_of_sides = []
    for side in (-1, 1):
        far = reach(curve.sample(bends, side), tolerance)
        far = np.minimum(far, bends - run.low if side < 0 else run.high - bends)
        for _ in range(_HALVINGS):
            frame = curve.sample((bends[:, None] + side * far[:, None] * np.array(_PLACES)).ravel())
            bent = np.abs(frame.turn * frame.speed).reshape(far.size, -1).max(axis=1)
            over = bent * far**2 > 24.0 * _CUBIC * tolerance
            if not over.any():
                break
            far = np.where(over, 0.5 * far, far)
        reach_of_sides.append(far)
    return reach_of_sides[0], reach_of_sides[1]


@dataclass(frozen=True)
class Crossings:
    """Edges across inflections: parameters of their ends (n,), where vertices stand off the curve by the tolerance."""

    low: Array
    high: Array


def crossings(curve: Curve, nodes: Array, low: Array, high: Array, tolerance: float) -> Crossings:
    """Longest edges across inflections `nodes` (n,) within a tolerance, mm, from a first guess `low` and `high` (n,).

    Newton's method makes the two extremes between the ends as large as the ends' own distance; each extreme is followed
    as its edge moves. An edge that does not settle is returned as its first guess.
    """
    count = nodes.size
    if not count:
        return Crossings(low, high)
    first_low, first_high = low, high
    # where the curve is farthest from each edge, before the inflection and after it
    near, far = 0.5 * (nodes + low), 0.5 * (nodes + high)
    settled = np.zeros(count, dtype=bool)
    enough = max(_SETTLED * tolerance, rounding(curve.size))
    for _ in range(_STEPS):
        frame = curve.sample(np.concatenate([low, high, near, far]))
        point, tangent = frame.point.reshape(4, count, 2), frame.tangent.reshape(4, count, 2)
        normal, turn = frame.normal.reshape(4, count, 2), np.abs(frame.turn.reshape(4, count))
        speed = frame.speed.reshape(4, count)
        sense = np.where(frame.turn[:count] >= 0.0, 1.0, -1.0)
        away = (sense * tolerance)[:, None]
        begin, end = point[0] + away * normal[0], point[1] - away * normal[1]
        chord = end - begin
        length = np.hypot(chord[:, 0], chord[:, 1])
        along = chord / length[:, None]
        # square to the edge, on the side of its first vertex
        across = np.column_stack([along[:, 1], -along[:, 0]]) * sense[:, None]
        lean = np.sum(tangent * across, axis=2)
        height = np.sum((point[2:] - begin) * across, axis=2) * np.array([[1.0], [-1.0]])
        share = np.sum((point[2:] - begin) * along, axis=2) / length
        with np.errstate(divide="ignore", invalid="ignore"):
            # how far ahead the extremes lie, their heights, and how fast each vertex moves across with its end
            move = lean[2:] * np.array([[1.0], [-1.0]]) / turn[2:]
            top = height + 0.5 * speed[2:] * turn[2:] * move**2
            rise = lean[:2] * (speed[:2] + tolerance * turn[:2])
            # height of the extremes by the ends: the line's own height at each, by the shares of the two ends
            a, b = -(1.0 - share) * rise[0], -share * rise[1]
            a[1], b[1] = -a[1], -b[1]
            miss = tolerance - top
            determinant = a[0] * b[1] - a[1] * b[0]
            step_low = (miss[0] * b[1] - miss[1] * b[0]) / determinant
            step_high = (a[0] * miss[1] - a[1] * miss[0]) / determinant
        settled = (np.abs(miss) <= enough).all(axis=0) & (np.abs(move[0]) < nodes - low)
        if settled.all():
            break
        usable = np.isfinite(step_low) & np.isfinite(step_high) & ~settled
        limit_low, limit_high = _MOST_STEP * (nodes - low), _MOST_STEP * (high - nodes)
        low = low + np.where(usable, np.clip(step_low, -limit_low, limit_low), 0.0)
        high = high + np.where(usable, np.clip(step_high, -limit_high, limit_high), 0.0)
        moved = np.where(np.isfinite(move), move, 0.0)
        # extremes keep clear of the inflection itself, where no bend leads them
        near = np.clip(near + moved[0], low, nodes - _CLEAR * (nodes - low))
        far = np.clip(far + moved[1], nodes + _CLEAR * (high - nodes), high)
    return Crossings(np.where(settled, low, first_low), np.where(settled, high, first_high))
